//! The peer's frames and the link's against packets that another library (pymavlink 2.4.50) wrote.

use crate::wire;
use ground_station::link::frames::{Decoder, frame};

/// One packet a line, in hexadecimal, after the name of its message; made by `tests/scripts/record_packets.py`.
const PACKETS: &str = include_str!("../data/pymavlink_packets.txt");

fn packets() -> Vec<(String, Vec<u8>)> {
    let byte = |pair: &[u8]| {
        std::str::from_utf8(pair).ok().and_then(|pair| u8::from_str_radix(pair, 16).ok()).unwrap_or_default()
    };
    let lines = PACKETS.lines().filter_map(|line| line.split_once(' '));
    lines.map(|(name, hex)| (name.to_owned(), hex.as_bytes().chunks(2).map(byte).collect())).collect()
}

#[test]
fn the_peer_reads_and_writes_what_pymavlink_writes() {
    assert!(packets().len() >= 14);
    for (name, bytes) in packets() {
        let Some((number, payload)) = wire::read(&bytes) else { panic!("{name} is not read") };
        // Sender and sequence are the same in all packets.
        assert_eq!(wire::frame(bytes[5], bytes[4], number, &payload)[..6], bytes[..6], "{name}");
        let (head, rest) = (&bytes[..10], &bytes[10..]);
        let again = wire::frame(bytes[5], bytes[4], number, &payload);
        if bytes[6] == 1 {
            assert_eq!((&again[..10], &again[10..]), (head, rest), "{name}");
        }
    }
}

#[test]
fn the_link_reads_and_writes_what_pymavlink_writes() {
    for (name, bytes) in packets() {
        let found = Decoder::default().push(&bytes);
        assert_eq!(found.len(), 1, "{name}");
        assert_eq!(found[0].frame, bytes);
        assert_eq!(frame(bytes[5], bytes[6], bytes[4], &found[0].message), bytes, "{name}");
    }
}
