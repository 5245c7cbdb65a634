//! What a person beside the robot hears and sees of programs: a beep when one has come, the green light when one is
//! over, as on the original robots (trikRuntime: 2500 Hz for 150 ms; green at the reset after each program).
//!
//! Owns a thread, because neither a loudspeaker nor a light may delay anything, and what stands in their files. What
//! cannot be shown is left out.

use crate::tree::{Access, Tree};
use crate::{limits, log, panics};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

/// Something to show.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Moment {
    /// A program was uploaded.
    Uploaded,
    /// A program is over, in whatever way.
    Ended,
}

/// What is written: files of the tree and texts.
fn writes(moment: Moment) -> &'static [(&'static str, &'static str)] {
    match moment {
        Moment::Uploaded => &[("sound/tone/value", "2500 150\n")],
        Moment::Ended => &[("led/red/value", "0\n"), ("led/green/value", "1\n")],
    }
}

/// The way to the thread; nothing is shown without one.
#[derive(Debug, Default)]
pub struct Feedback {
    show: Option<SyncSender<Moment>>,
}

impl Feedback {
    /// Starts the thread for the tree at `root`; it ends with this.
    ///
    /// # Errors
    /// There can be no more threads.
    pub fn start(root: &Path) -> io::Result<Self> {
        let (show, shown) = sync_channel(limits::FEEDBACK_WAITS);
        let root: PathBuf = root.to_owned();
        std::thread::Builder::new()
            .name("feedback".to_owned())
            .spawn(move || panics::restart_on_panic(|| serve(&root, &shown)))?;
        Ok(Self { show: Some(show) })
    }

    /// Shows a moment soon, or not at all if too many wait already.
    pub fn show(&self, moment: Moment) {
        if let Some(show) = &self.show {
            let _ = show.try_send(moment);
        }
    }
}

fn serve(root: &Path, shown: &Receiver<Moment>) {
    let tree = Tree::new(root);
    for moment in shown {
        for (file, text) in writes(moment) {
            if let Err(error) = tree.node(file, Access::Write).write(text) {
                tracing::debug!(target: log::TREE, "{moment:?} is not shown: {file}: {error}");
            }
        }
        // Moments are rare, and what is open is held by somebody.
        tree.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::put;
    use tempfile::tempdir;

    #[test]
    fn moments_are_shown_in_order_and_what_is_missing_stops_nothing() {
        let scratch = tempdir().unwrap();
        let green = put(scratch.path(), "led/green/value", "0\n");
        let (show, shown) = sync_channel(2);
        show.send(Moment::Uploaded).unwrap();
        show.send(Moment::Ended).unwrap();
        drop(show);
        serve(scratch.path(), &shown);
        assert_eq!(std::fs::read_to_string(green).unwrap(), "1\n");
        Feedback::default().show(Moment::Ended);
    }
}
