//! MAVLink 2 by hand: just enough for a vehicle. Shares nothing with the program's own link.

/// Numbers of messages with their seeds of the checksum, as the standard lists them.
const SEEDS: [(u32, u8); 18] = [
    (0, 50),
    (1, 124),
    (32, 185),
    (33, 104),
    (40, 230),
    (42, 28),
    (43, 132),
    (44, 221),
    (47, 153),
    (51, 196),
    (73, 38),
    (75, 158),
    (76, 152),
    (77, 143),
    (84, 143),
    (242, 104),
    (253, 83),
    (11, 89),
];

fn checksum(bytes: &[u8], seed: u8) -> u16 {
    bytes.iter().chain([&seed]).fold(0xFFFF, |sum: u16, &byte| {
        let mut low = byte ^ (sum & 0xFF) as u8;
        low ^= low << 4;
        (sum >> 8) ^ (u16::from(low) << 8) ^ (u16::from(low) << 3) ^ (u16::from(low) >> 4)
    })
}

fn seed_of(number: u32) -> Option<u8> {
    SEEDS.iter().find(|(known, _)| *known == number).map(|&(_, seed)| seed)
}

/// A frame of a message whose payload is given in full.
pub fn frame(system: u8, sequence: u8, number: u32, payload: &[u8]) -> Vec<u8> {
    // MAVLink 2 leaves out zeros at the end, but for the first byte.
    let length = payload.iter().rposition(|&byte| byte != 0).map_or(1, |last| last + 1);
    let [a, b, c, _] = number.to_le_bytes();
    let mut bytes = vec![0xFD, length as u8, 0, 0, sequence, system, 1, a, b, c];
    bytes.extend(&payload[..length]);
    let sum = checksum(&bytes[1..], seed_of(number).unwrap_or(0));
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// Number and payload of a frame, zeros put back; `None` if it is no whole and right frame.
pub fn read(bytes: &[u8]) -> Option<(u32, Vec<u8>)> {
    let length = usize::from(*bytes.get(1)?);
    if bytes[0] != 0xFD || bytes.len() != length + 12 {
        return None;
    }
    let number = u32::from_le_bytes([bytes[7], bytes[8], bytes[9], 0]);
    let sum = checksum(&bytes[1..10 + length], seed_of(number)?);
    if sum.to_le_bytes() != bytes[10 + length..] {
        return None;
    }
    let mut payload = bytes[10..10 + length].to_vec();
    payload.resize(64, 0);
    Some((number, payload))
}

/// Writes fields in the order of the wire.
#[derive(Default)]
pub struct Fields(pub Vec<u8>);

impl Fields {
    pub fn f32s(mut self, values: &[f64]) -> Self {
        values.iter().for_each(|&value| self.0.extend((value as f32).to_le_bytes()));
        self
    }
    pub fn u32s(mut self, values: &[u32]) -> Self {
        values.iter().for_each(|value| self.0.extend(value.to_le_bytes()));
        self
    }
    pub fn i32s(mut self, values: &[i32]) -> Self {
        values.iter().for_each(|value| self.0.extend(value.to_le_bytes()));
        self
    }
    pub fn u16s(mut self, values: &[u16]) -> Self {
        values.iter().for_each(|value| self.0.extend(value.to_le_bytes()));
        self
    }
    pub fn u8s(mut self, values: &[u8]) -> Self {
        self.0.extend(values);
        self
    }
}

pub fn f32_at(payload: &[u8], place: usize) -> f64 {
    f64::from(f32::from_le_bytes([
        payload[place],
        payload[place + 1],
        payload[place + 2],
        payload[place + 3],
    ]))
}

pub fn i32_at(payload: &[u8], place: usize) -> i32 {
    i32::from_le_bytes([payload[place], payload[place + 1], payload[place + 2], payload[place + 3]])
}

pub fn u16_at(payload: &[u8], place: usize) -> u16 {
    u16::from_le_bytes([payload[place], payload[place + 1]])
}
