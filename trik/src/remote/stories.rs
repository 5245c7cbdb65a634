//! What programs of a robot do, as it tells it from now on, for those who pass it on.
//!
//! Owns the connection and its thread: a robot that is not there, or goes, is asked again later. One who takes the lines too
//! slowly misses some.

use super::link::ms;
use super::target::Target;
use crate::error::Error;
use crate::limits;
use journal::records::Lines;
use journal::write::Story;
use recorder::entry::Entry;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

/// A pattern that is the path of no node: nodes are seen in the tree.
const NO_NODE: &[u8] = b"//";

/// Lines of a robot.
pub(crate) struct Stories(Receiver<Entry>);

/// Nobody takes them any more.
struct Unheard;

impl Stories {
    /// Begins to hear.
    ///
    /// # Errors
    /// There are no more threads.
    pub(crate) fn hear(target: Target) -> Result<Self, Error> {
        let (give, come) = sync_channel(limits::STORIES);
        std::thread::Builder::new()
            .name("stories".to_owned())
            .spawn(move || while follow(&target, &give).is_ok() {})
            .map_err(|why| Error::system("a thread", why))?;
        Ok(Self(come))
    }

    /// Takes what has come.
    pub(crate) fn take(&self, out: &mut Vec<Entry>) {
        out.extend(self.0.try_iter());
    }
}

/// Hears one connection to its end, and rests a while.
fn follow(target: &Target, give: &SyncSender<Entry>) -> Result<(), Unheard> {
    if let Ok(mut link) = target.connect() {
        link.ask(&[b"stream:", NO_NODE]);
        let mut lines = Lines::default();
        loop {
            let Some(message) = link.next() else {
                match link.turn(ms(limits::TURN_MS), None, true) {
                    Ok(_) => continue,
                    Err(_) => break,
                }
            };
            let Some(piece) = message.piece() else {
                continue;
            };
            let Ok(all) = lines.take(&piece) else { break };
            for (story, at_ns, line) in all {
                pass_on(give, story, Entry::Line(story, at_ns, Arc::new(line)))?;
            }
        }
    }
    std::thread::sleep(Duration::from_millis(limits::STORIES_AGAIN_MS));
    Ok(())
}

/// What the tree itself tells is told by that.
fn pass_on(give: &SyncSender<Entry>, story: Story, line: Entry) -> Result<(), Unheard> {
    match story {
        Story::Log | Story::World => Ok(()),
        Story::Programs | Story::Output | Story::Mail | Story::Diagram => {
            match give.try_send(line) {
                Ok(()) | Err(TrySendError::Full(_)) => Ok(()),
                Err(TrySendError::Disconnected(_)) => Err(Unheard),
            }
        }
    }
}
