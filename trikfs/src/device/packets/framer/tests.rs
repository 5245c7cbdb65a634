//! Tests of the search for packets: bytes made by hand, cuts at every place, and any bytes at all against a plain
//! search over the whole stream.

use super::super::super::cutter::{Cutter, Pieces};
use super::*;
use crate::stats::Counter;
use config::description::LengthField;
use proptest::prelude::*;
use std::sync::Arc;

/// The packets of a lidar: AA, length (big endian, without the checksum), ..., 16-bit sum.
fn lidar() -> PacketsDescription {
    PacketsDescription {
        path: "/dev/ttyS1".into(),
        baud: None,
        start: vec![0xaa],
        length: LengthField {
            at: 1,
            bytes: 2,
            add: 2,
        },
        order: ByteOrder::Big,
        checksum: Checksum::Sum16,
    }
}

/// A packet of the lidar with this content.
fn packet(content: &[u8]) -> Vec<u8> {
    let length = u16::try_from(content.len() + 3).unwrap();
    let mut bytes = vec![0xaa];
    bytes.extend(length.to_be_bytes());
    bytes.extend(content);
    let sum = bytes.iter().fold(0u16, |sum, byte| sum + u16::from(*byte));
    bytes.extend(sum.to_be_bytes());
    bytes
}

/// All tuples of these bytes, and how many packets were damaged.
fn all(
    description: &PacketsDescription,
    tuple_size: usize,
    bytes: &[u8],
    piece: usize,
) -> (Vec<Vec<u8>>, u64) {
    let damaged = Arc::<Counter>::default();
    let framer = Framer::new(description, tuple_size);
    let mut cutter = Cutter::new(framer, tuple_size, 64, damaged.clone());
    let tuples = Pieces::of(bytes, piece).drain(&mut cutter, tuple_size);
    assert_eq!(tuples.len() % tuple_size, 0);
    let tuples = tuples.chunks(tuple_size).map(<[u8]>::to_vec).collect();
    (tuples, damaged.get())
}

fn padded(packet: &[u8], size: usize) -> Vec<u8> {
    let mut tuple = packet.to_vec();
    tuple.resize(size, 0);
    tuple
}

#[test]
fn a_packet_made_by_hand_is_found_in_every_kind() {
    // AA + 00 + 05 + 11 + 22 = 0xe2
    let big = [0xaa, 0x00, 0x05, 0x11, 0x22, 0x00, 0xe2];
    assert_eq!(packet(&[0x11, 0x22]), big);
    assert_eq!(all(&lidar(), 8, &big, 1).0, [padded(&big, 8)]);
    let mut other = lidar();
    other.order = ByteOrder::Little;
    let little = [0xaa, 0x05, 0x00, 0x11, 0x22, 0xe2, 0x00];
    assert_eq!(all(&other, 7, &little, 7).0, [little.to_vec()]);
    other.checksum = Checksum::Sum8;
    other.length.add = 1;
    let short = [0xaa, 0x05, 0x00, 0x11, 0x99, 0x59]; // 0x159
    assert_eq!(all(&other, 6, &short, 2).0, [short.to_vec()]);
    other.checksum = Checksum::Xor8;
    let xor = [0xaa, 0x05, 0x00, 0x11, 0x99, 0x27];
    assert_eq!(all(&other, 6, &xor, 2).0, [xor.to_vec()]);
    other.checksum = Checksum::None;
    other.length = LengthField {
        at: 2,
        bytes: 1,
        add: -1,
    };
    other.start = vec![0xaa, 0xbb];
    let bare = [0xaa, 0xaa, 0xbb, 5, 9];
    assert_eq!(all(&other, 4, &bare, 1).0, [vec![0xaa, 0xbb, 5, 9]]);
}

#[test]
fn packets_are_the_same_wherever_the_bytes_are_cut() {
    let good = [packet(&[1, 2, 0xaa, 0, 6]), packet(&[]), packet(&[0xaa; 9])];
    let mut bytes = vec![1, 2, 3];
    bytes.extend(&good[0]);
    bytes.extend([0xaa, 0xff, 0xff]); // too long for the tuple
    bytes.extend(&good[1]);
    bytes.extend([0xaa, 0, 4, 7, 0xbb]); // a wrong sum, over the next packet
    bytes.extend(&good[2]);
    bytes.extend(&good[0][..4]); // cut off by the end
    let wanted: Vec<_> = good.iter().map(|packet| padded(packet, 20)).collect();
    let (_, damaged) = all(&lidar(), 20, &bytes, bytes.len());
    assert!(damaged >= 3, "{damaged}");
    for piece in 1..=bytes.len() {
        assert_eq!(all(&lidar(), 20, &bytes, piece), (wanted.clone(), damaged));
    }
}

#[test]
fn a_packet_inside_a_damaged_one_is_found() {
    let inner = packet(&[3, 1, 4]);
    let mut outer = packet(&inner);
    let last = outer.len() - 1;
    outer[last] ^= 1;
    let (tuples, damaged) = all(&lidar(), 32, &outer, 3);
    assert_eq!(tuples, [padded(&inner, 32)]);
    assert_eq!(damaged, 1);
}

#[test]
fn an_endless_row_of_starts_costs_each_byte_once() {
    // Each byte begins a packet of 43692 bytes whose sum is wrong.
    let bytes = vec![0xaa; 400_000];
    let began = std::time::Instant::now();
    let (tuples, damaged) = all(&lidar(), 1 << 16, &bytes, 4096);
    assert_eq!((tuples.len(), damaged), (0, 400_000));
    assert!(began.elapsed().as_secs() < 60);
}

/// The rule in its plainest form.
fn plain(description: &PacketsDescription, tuple_size: usize, bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut tuples = Vec::new();
    let mut at = 0;
    'next: while at < bytes.len() {
        for size in description.size_min()..=tuple_size.min(bytes.len() - at) {
            let here = &bytes[at..at + size];
            let told = u16::from_be_bytes([here[1], here[2]]);
            let (content, sum) = here.split_at(size - 2);
            let right = content.iter().map(|byte| u32::from(*byte)).sum::<u32>() & 0xffff;
            let given = u32::from(u16::from_be_bytes([sum[0], sum[1]]));
            if here[0] == 0xaa && usize::from(told) + 2 == size && right == given {
                tuples.push(padded(here, tuple_size));
                at += size;
                continue 'next;
            }
        }
        at += 1;
    }
    tuples
}

/// Garbage that likes to look like packets.
fn garbage() -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![Just(0xaa), Just(0), 0u8..12, any::<u8>()];
    prop::collection::vec(byte, 0..40)
}

proptest! {
    #[test]
    fn any_bytes_give_what_a_plain_search_gives(
        parts in prop::collection::vec((garbage(), prop::collection::vec(any::<u8>(), 0..12)), 0..12),
        piece in 1usize..50,
    ) {
        let mut bytes = Vec::new();
        for (noise, content) in &parts {
            bytes.extend(noise);
            bytes.extend(packet(content));
        }
        prop_assert_eq!(all(&lidar(), 24, &bytes, piece).0, plain(&lidar(), 24, &bytes));
    }

    #[test]
    fn every_packet_between_garbage_without_a_start_is_given(
        parts in prop::collection::vec(
            (prop::collection::vec(0u8..0xaa, 0..40), prop::collection::vec(any::<u8>(), 0..12)), 0..12),
        piece in 1usize..50,
    ) {
        let mut bytes = Vec::new();
        let mut wanted = Vec::new();
        for (noise, content) in &parts {
            bytes.extend(noise);
            bytes.extend(packet(content));
            wanted.push(padded(&packet(content), 24));
        }
        let (tuples, damaged) = all(&lidar(), 24, &bytes, piece);
        prop_assert_eq!(tuples, wanted);
        prop_assert_eq!(damaged, 0);
    }
}
