//! Bytes to messages and back (MAVLink 1 and 2, the common message set).

use mavlink::dialects::common::MavMessage;
use mavlink::{MavHeader, MavlinkVersion, Message, calculate_crc};

/// A message and who sent it.
#[derive(Debug, Clone, PartialEq)]
pub struct Received {
    /// System of the sender.
    pub system: u8,
    /// Component of the sender.
    pub component: u8,
    /// What it says.
    pub message: MavMessage,
    /// The frame as it came.
    pub frame: Vec<u8>,
}

/// First byte of a frame, the bytes around its payload, and where the message's number stands.
const VERSION_1: u8 = 0xFE;
const VERSION_2: u8 = 0xFD;
const AROUND_1: usize = 8;
const AROUND_2: usize = 12;
const SIGNATURE: usize = 13;
/// Flag of a MAVLink 2 frame that carries a signature.
const SIGNED: u8 = 1;

/// The frame of a message, MAVLink 2, unsigned.
#[must_use]
pub fn frame(system: u8, component: u8, sequence: u8, message: &MavMessage) -> Vec<u8> {
    let header = MavHeader { system_id: u32::from(system), component_id: component, sequence };
    let mut raw = mavlink::MAVLinkV2MessageRaw::new();
    raw.serialize_message(header, message);
    raw.raw_bytes().to_vec()
}

/// Finds frames in a stream of bytes; what is no frame, is damaged or is not in the message set is passed over.
#[derive(Debug, Clone, Default)]
pub struct Decoder {
    bytes: Vec<u8>,
}

impl Decoder {
    /// Takes what arrived; returns the messages that are complete.
    pub fn push(&mut self, bytes: &[u8]) -> Vec<Received> {
        self.bytes.extend_from_slice(bytes);
        let mut received = Vec::new();
        let mut place = 0;
        while let Some(length) = frame_length(&self.bytes[place..]) {
            match length {
                Length::Unknown => break,
                Length::NoFrame => place += 1,
                Length::Of(length) if self.bytes.len() - place < length => break,
                Length::Of(length) => match read(&self.bytes[place..place + length]) {
                    Reading::Message(message) => {
                        received.push(*message);
                        place += length;
                    }
                    Reading::Foreign => place += length,
                    // A start byte inside of rubbish: what follows it may hold a frame.
                    Reading::Damaged => place += 1,
                },
            }
        }
        self.bytes.drain(..place);
        received
    }
}

enum Length {
    /// More bytes are needed.
    Unknown,
    NoFrame,
    Of(usize),
}

/// `None` at the end of the bytes.
fn frame_length(bytes: &[u8]) -> Option<Length> {
    let payload = |bytes: &[u8]| bytes.get(1).map(|&length| usize::from(length));
    Some(match (bytes.first()?, payload(bytes), bytes.get(2)) {
        (&VERSION_1, Some(payload), _) => Length::Of(AROUND_1 + payload),
        (&VERSION_2, Some(payload), Some(&flags)) if flags & !SIGNED == 0 => {
            Length::Of(AROUND_2 + payload + if flags & SIGNED == 0 { 0 } else { SIGNATURE })
        }
        (&VERSION_2, Some(_), Some(_)) => Length::NoFrame,
        (&VERSION_1 | &VERSION_2, _, _) => Length::Unknown,
        _ => Length::NoFrame,
    })
}

enum Reading {
    Message(Box<Received>),
    /// A message that the common set does not have.
    Foreign,
    Damaged,
}

fn read(frame: &[u8]) -> Reading {
    let is_first = frame[0] == VERSION_1;
    let payload = usize::from(frame[1]);
    let (version, head, system) =
        if is_first { (MavlinkVersion::V1, 6, 3) } else { (MavlinkVersion::V2, 10, 5) };
    let number = match version {
        MavlinkVersion::V1 => u32::from(frame[5]),
        MavlinkVersion::V2 => u32::from_le_bytes([frame[7], frame[8], frame[9], 0]),
    };
    if MavMessage::default_message_from_id(number).is_none() {
        return Reading::Foreign;
    }
    let end = head + payload;
    let sum = calculate_crc(&frame[1..end], MavMessage::extra_crc(number));
    if sum.to_le_bytes() != frame[end..end + 2] {
        return Reading::Damaged;
    }
    match MavMessage::parse(version, number, &frame[head..end]) {
        Ok(message) => Reading::Message(Box::new(Received {
            system: frame[system],
            component: frame[system + 1],
            message,
            frame: frame.to_vec(),
        })),
        // A word that the message set does not have, from a newer autopilot.
        Err(_) => Reading::Foreign,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavlink::dialects::common::{HEARTBEAT_DATA, MISSION_COUNT_DATA};
    use proptest::prelude::*;

    fn messages() -> Vec<MavMessage> {
        vec![
            MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()),
            MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
                count: 17,
                target_system: 3,
                target_component: 1,
            }),
        ]
    }

    #[test]
    fn rubbish_between_frames_is_passed_over() {
        let mut stream = vec![0, 0xFD, 0xFE, 0xFD, 0xFF];
        for message in messages() {
            stream.extend(frame(7, 1, 2, &message));
            stream.extend([0xFE, 3, 9]);
        }
        // A start byte in rubbish may announce a long frame: only so many bytes later is it known to be none.
        for _ in 0..20 {
            stream.extend(frame(7, 1, 2, &messages()[0]));
        }
        let mut decoder = Decoder::default();
        // Byte by byte, as a stream may come.
        let found: Vec<Received> = stream.iter().flat_map(|&byte| decoder.push(&[byte])).collect();
        assert!(found.len() >= 20, "{found:?}");
        assert!(found.iter().all(|received| (received.system, received.component) == (7, 1)));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// Frames with one damaged byte give other frames only if that byte repairs nothing: never a panic, never more.
        #[test]
        fn damage_never_panics_and_never_multiplies(place in 0usize..60, bit in 0u8..8, cut in 0usize..60, noise in proptest::collection::vec(any::<u8>(), 0..80)) {
            let mut stream: Vec<u8> = messages().iter().flat_map(|message| frame(1, 1, 0, message)).collect();
            let length = stream.len();
            stream[place % length] ^= 1 << bit;
            stream.truncate(length - cut % length);
            stream.extend(noise);
            let mut decoder = Decoder::default();
            prop_assert!(decoder.push(&stream).len() <= 2);
            // However long the rubbish, frames are found again after it.
            let mut found = 0;
            for _ in 0..300 {
                found += decoder.push(&frame(1, 1, 0, &messages()[0])).len();
            }
            prop_assert!(found > 250);
        }
    }
}
