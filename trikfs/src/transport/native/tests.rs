//! The transports against the real kernel: one body for both, and what only the native one can do.

pub(crate) mod bodies;
pub(crate) mod rig;

mod failing;
mod only_native;

use super::*;
use needs::Random;
use std::time::{SystemTime, UNIX_EPOCH};

bodies::instantiate!(super::serve);

/// Arbitrary numbers; the seed is printed, and `TRIK_SEED` repeats a run.
fn arbitrary() -> Random {
    let given = std::env::var("TRIK_SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    let seed = given.unwrap_or_else(|| {
        SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap()
            .subsec_nanos()
    });
    println!("TRIK_SEED={seed}");
    Random::new(seed)
}

/// A message with an honest length, so that arbitrary bodies get as far as their opcode.
fn message(opcode: u32, body: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend(
        u32::try_from(abi::IN_HEADER + body.len())
            .unwrap()
            .to_ne_bytes(),
    );
    bytes.extend(opcode.to_ne_bytes());
    bytes.extend([0; abi::IN_HEADER - 8]);
    bytes.extend(body);
    bytes
}

#[test]
fn arbitrary_and_mutated_bytes_never_panic() {
    let mut arbitrary = arbitrary();
    for _ in 0..200_000 {
        let length = arbitrary.below(160);
        let body: Vec<u8> = (0..length).map(|_| arbitrary.bits() as u8).collect();
        fuzz_decode(&body);
        let mut bytes = message(arbitrary.bits() % 60, &body);
        fuzz_decode(&bytes);
        let at = arbitrary.below(bytes.len());
        bytes[at] = arbitrary.bits() as u8;
        bytes.truncate(arbitrary.below(bytes.len() + 1));
        fuzz_decode(&bytes);
    }
}

#[test]
fn extreme_sizes_never_panic() {
    for opcode in 0..60 {
        fuzz_decode(&message(opcode, &[0xff; 128]));
        fuzz_decode(&message(opcode, &[0; 128]));
    }
}

#[test]
fn the_request_buffer_starts_on_a_page_and_holds_the_largest_write() {
    let mut buffer = AlignedBuffer::new();
    let bytes = buffer.bytes_mut();
    assert_eq!(bytes.as_ptr().align_offset(PAGE_BYTES), 0);
    assert_eq!(bytes.len(), REQUEST_BYTES);
}

#[test]
fn only_one_of_two_takes_a_request_out_of_its_slot() {
    let slot = Slot(Mutex::new(Some(7)));
    assert!(!slot.take(8));
    assert!(slot.take(7));
    assert!(!slot.take(7));
}
