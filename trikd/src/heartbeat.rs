//! Notices that the serving thread hangs: then this process ends at once, and the guardian brings everything to rest.
//!
//! Owns one thread and one counter. It counts its own rounds and not the clock, so a machine that slept is no hang.

use crate::{limits, log, panics};
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// Beats as long as its task gets its turn; call it on the serving thread.
///
/// # Errors
/// There can be no more threads.
pub fn start() -> io::Result<()> {
    let beats = Arc::new(AtomicU32::new(0));
    let seen = beats.clone();
    let watch = move || {
        let mut missing = Missing::default();
        loop {
            std::thread::sleep(Duration::from_millis(limits::BEAT_MS));
            if missing.observe(seen.load(Ordering::Relaxed)) >= limits::BEATS_MISSING {
                tracing::error!(target: log::DAEMON, "the serving thread hangs: it is ended");
                std::process::abort();
            }
        }
    };
    std::thread::Builder::new()
        .name("heartbeat".to_owned())
        .spawn(move || panics::restart_on_panic(watch))?;
    tokio::task::spawn_local(async move {
        loop {
            beats.fetch_add(1, Ordering::Relaxed);
            tokio::time::sleep(Duration::from_millis(limits::BEAT_MS)).await;
        }
    });
    Ok(())
}

/// How often in a row nothing has changed.
#[derive(Default)]
struct Missing {
    last: u32,
    rounds: u32,
}

impl Missing {
    fn observe(&mut self, beats: u32) -> u32 {
        self.rounds = if beats == self.last {
            self.rounds + 1
        } else {
            0
        };
        self.last = beats;
        self.rounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_beats_that_stay_away_in_a_row_count() {
        let mut missing = Missing::default();
        let rounds: Vec<u32> = [1, 2, 2, 2, 3, 3]
            .map(|beats| missing.observe(beats))
            .into();
        assert_eq!(rounds, [0, 0, 1, 2, 0, 1]);
    }
}
