//! Runs a fuzz target for a moment on random, mutated and truncated bytes.
//!
//! The seed is printed; `TRIK_FUZZ_SEED` repeats a run, `TRIK_FUZZ_MS` makes it longer. A target is a plain function
//! that must neither panic nor take long, whatever the bytes. Knows no target.

use needs::Random;
use std::time::{Duration, Instant};

fn seed() -> u32 {
    let given = std::env::var("TRIK_FUZZ_SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    given.unwrap_or_else(|| {
        let now = std::time::SystemTime::now()
            .duration_since(std::time::UNIX_EPOCH)
            .unwrap_or_default();
        now.subsec_nanos() ^ std::process::id()
    })
}

/// Changes some bytes, cuts, repeats or joins pieces of the samples.
fn mutated(random: &mut Random, samples: &[&[u8]]) -> Vec<u8> {
    let mut bytes = samples[random.below(samples.len())].to_vec();
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len());
        match random.below(7) {
            0 => bytes.truncate(at),
            1 => bytes.insert(at, random.byte()),
            2 if !bytes.is_empty() => bytes[at] = random.byte(),
            3 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            4 => {
                let piece = bytes[at..bytes.len().min(at + random.below(40))].to_vec();
                bytes.splice(at..at, piece);
            }
            5 => {
                let other = samples[random.below(samples.len())];
                bytes.extend_from_slice(&other[random.below(other.len())..]);
            }
            _ => bytes = (0..random.below(200)).map(|_| random.byte()).collect(),
        }
    }
    bytes
}

/// Calls the target with each sample, then with bytes made from them until the time is over.
///
/// # Panics
/// The target panics or takes ten seconds; the bytes are printed.
pub fn run(name: &str, target: impl Fn(&[u8]), samples: &[&[u8]]) {
    let seed = seed().max(1);
    println!("fuzz {name}: TRIK_FUZZ_SEED={seed}");
    let limit = std::env::var("TRIK_FUZZ_MS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(1500);
    let end = Instant::now() + Duration::from_millis(limit);
    let mut random = Random::new(seed);
    for sample in samples {
        target(sample);
    }
    while Instant::now() < end {
        let bytes = mutated(&mut random, samples);
        let start = Instant::now();
        if let Err(panic) =
            std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| target(&bytes)))
        {
            eprintln!("fuzz {name} failed on {}", bytes.escape_ascii());
            std::panic::resume_unwind(panic);
        }
        assert!(
            start.elapsed() < Duration::from_secs(10),
            "{name} took {:?} for {}",
            start.elapsed(),
            bytes.escape_ascii()
        );
    }
}
