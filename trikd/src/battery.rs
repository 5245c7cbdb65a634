//! What the battery had when a client asked last, read from the tree by a thread of its own: an answer never waits for a device.
//!
//! Owns that thread and the newest value. Nothing is read while nobody asks. Knows no requests.

use crate::protocol::news;
use crate::{panics, tree};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// The node of the tree.
const NODE: &str = "battery";

/// When it was read, and the value with its unit; None if there is no battery, or it says nothing.
type Newest = Arc<Mutex<Option<(Instant, String)>>>;

/// The way to the thread.
#[derive(Debug)]
pub struct Battery {
    ask: SyncSender<()>,
    newest: Newest,
}

/// Nothing that holds this lock can fail halfway.
fn held(newest: &Newest) -> MutexGuard<'_, Option<(Instant, String)>> {
    newest.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Battery {
    /// Starts the thread for the tree at `root`; it ends with this.
    ///
    /// # Errors
    /// There can be no more threads.
    pub fn start(root: &Path) -> std::io::Result<Self> {
        let (ask, asked) = sync_channel(1);
        let newest = Newest::default();
        let (root, told): (PathBuf, _) = (root.to_owned(), newest.clone());
        std::thread::Builder::new()
            .name("battery".to_owned())
            .spawn(move || panics::restart_on_panic(|| read(&root, &asked, &told)))?;
        Ok(Self { ask, newest })
    }

    /// A line for the status with what is known, and the next reading begins. Empty: nothing is known.
    pub fn line(&self) -> String {
        // Full: it is asked already.
        let _ = self.ask.try_send(());
        let newest = held(&self.newest);
        let line = newest.as_ref();
        line.map_or_else(String::new, |(at, text)| {
            news::battery(text, at.elapsed().as_secs())
        })
    }
}

fn read(root: &Path, asked: &Receiver<()>, newest: &Newest) {
    while asked.recv().is_ok() {
        let value = tree::value(root, NODE);
        let value = value.map(|value| {
            let unit = tree::unit(root, NODE);
            format!("{} {unit}", value.trim()).trim_end().to_owned()
        });
        *held(newest) = value
            .filter(|text| !text.contains('\n'))
            .map(|text| (Instant::now(), text));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::time::Duration;
    use tempfile::tempdir;

    /// Asks until the line is so.
    fn until(battery: &Battery, is_so: impl Fn(&str) -> bool) {
        let end = Instant::now() + Duration::from_secs(60);
        loop {
            let line = battery.line();
            if is_so(&line) {
                return;
            }
            assert!(Instant::now() < end, "{line:?}");
            std::thread::yield_now();
        }
    }

    #[test]
    fn the_battery_is_told_with_its_unit_and_one_that_is_gone_is_not() {
        let scratch = tempdir().unwrap();
        let node = scratch.path().join(NODE);
        let battery = Battery::start(scratch.path()).unwrap();
        assert_eq!(battery.line(), "");
        fs::create_dir(&node).unwrap();
        fs::write(node.join("value"), "11.87\n").unwrap();
        until(&battery, |line| line == "battery 11.87, 0 s ago\n");
        fs::write(node.join("units"), "V\n").unwrap();
        until(&battery, |line| line == "battery 11.87 V, 0 s ago\n");
        fs::remove_file(node.join("value")).unwrap();
        until(&battery, str::is_empty);
    }
}
