//! The keys of the robot that mean something to trikd itself, heard by a thread that waits for them.
//!
//! Owns that thread. What a key does is decided elsewhere.

use crate::brick::sensors::KEYS;
use crate::panics;
use crate::priority::{self, Rank};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::time::Duration;
use tokio::sync::mpsc::{Receiver, channel};

/// Milliseconds until a tree that is not there, or is gone, is tried again.
const RETRY_MS: u64 = 500;
/// One event: seven numbers of 32 bits.
const EVENT_BYTES: usize = 4 * KEYS.len();

/// Names of keys that are pressed from now on, as in [`KEYS`].
///
/// # Errors
/// There can be no more threads.
pub fn watch(tree: &Path) -> io::Result<Receiver<&'static str>> {
    let (tell, told) = channel(16);
    let path = tree.join("keys/device");
    let work = move || {
        priority::set(Rank::Rest);
        while !tell.is_closed() {
            // Errors and ends alike: the tree may come, or come back.
            let _ = File::open(&path)
                .and_then(|mut stream| follow(&mut stream, |key| tell.blocking_send(key).is_ok()));
            std::thread::sleep(Duration::from_millis(RETRY_MS));
        }
    };
    std::thread::Builder::new()
        .name("keys".to_owned())
        .spawn(move || panics::restart_on_panic(work))?;
    Ok(told)
}

/// Tells of each key that goes down until nobody wants to know.
fn follow(stream: &mut impl Read, mut tell: impl FnMut(&'static str) -> bool) -> io::Result<()> {
    let mut before = [0; EVENT_BYTES];
    let mut event = [0; EVENT_BYTES];
    loop {
        stream.read_exact(&mut event)?;
        for (index, (name, _)) in KEYS.iter().enumerate() {
            let number = 4 * index..4 * index + 4;
            let went_down = event[number.clone()].iter().any(|byte| *byte != 0)
                && before[number].iter().all(|byte| *byte == 0);
            if went_down && !tell(name) {
                return Ok(());
            }
        }
        before = event;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_told_when_it_goes_down_and_not_while_it_is_down() {
        let mut bytes = Vec::new();
        for keys in [
            [1, 0, 0, 0, 0, 0, 0],
            [1, 1, 0, 0, 0, 0, 0],
            [0, 1, 0, 0, 0, 0, 0],
            [1, 1, 0, 0, 0, 0, 0i32],
        ] {
            bytes.extend(keys.iter().flat_map(|key| key.to_ne_bytes()));
        }
        let mut told = Vec::new();
        let end = follow(&mut bytes.as_slice(), |key| {
            told.push(key);
            true
        });
        assert!(end.is_err());
        assert_eq!(told, ["Power", "Up", "Power"]);
    }
}
