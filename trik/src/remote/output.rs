//! Where the output of a program goes: a thread of its own writes it, because the reader may take its time, and the
//! connection to the robot must not wait for that.
//!
//! Owns that thread and what waits for it, which is bounded; and lines for the person, without what a terminal would obey.

use crate::limits;
use std::io::Write;
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;

/// The way to a writer.
#[derive(Debug)]
pub(super) struct Output {
    queue: SyncSender<Vec<u8>>,
    writer: JoinHandle<()>,
    waiting: Option<Vec<u8>>,
    is_closed: bool,
}

impl Output {
    /// To this writer.
    pub(super) fn to(mut out: impl Write + Send + 'static) -> Self {
        let (queue, pieces) = sync_channel::<Vec<u8>>(limits::OUTPUT_PIECES);
        let writer = std::thread::spawn(move || {
            for piece in pieces {
                if out.write_all(&piece).and_then(|()| out.flush()).is_err() {
                    return;
                }
            }
        });
        Self {
            queue,
            writer,
            waiting: None,
            is_closed: false,
        }
    }

    /// Passes a piece on. Only when there is room.
    pub(super) fn put(&mut self, piece: Vec<u8>) {
        match self.queue.try_send(piece) {
            Ok(()) => {}
            Err(TrySendError::Full(piece)) => self.waiting = Some(piece),
            Err(TrySendError::Disconnected(_)) => self.is_closed = true,
        }
    }

    /// Whether it takes a piece.
    pub(super) fn has_room(&mut self) -> bool {
        if let Some(piece) = self.waiting.take() {
            self.put(piece);
        }
        self.waiting.is_none()
    }

    /// Whether nobody reads any more.
    pub(super) fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Waits until all is written, or somebody gives that up.
    pub(super) fn finish(mut self, mut gives_up: impl FnMut() -> bool) {
        while !self.has_room() {
            if gives_up() {
                return;
            }
        }
        drop(self.queue);
        while !self.writer.is_finished() {
            if gives_up() {
                return;
            }
        }
    }
}

/// A line for the person; nobody may be there.
pub(super) fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "trik: {}", harmless(text).trim_end());
}

/// Text of a robot that cannot command a terminal.
pub(super) fn harmless(text: &str) -> String {
    let fits = |c: &char| matches!(c, '\n' | '\t') || !c.is_control();
    text.chars().filter(fits).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{self, Read};
    use std::time::Duration;

    #[test]
    fn a_slow_reader_gets_all_of_it_and_holds_up_nobody() {
        let (mut reader, writer) = io::pipe().expect("a pipe");
        let mut output = Output::to(writer);
        let mut count = 0;
        while output.has_room() {
            output.put(vec![b'x'; 4096]);
            count += 1;
        }
        assert!(count > limits::OUTPUT_PIECES);
        let mut looks = 0;
        let taken = std::thread::spawn(move || {
            let mut all = Vec::new();
            reader.read_to_end(&mut all).map(|_| all.len())
        });
        output.finish(|| {
            std::thread::sleep(Duration::from_millis(5));
            looks += 1;
            looks > 5000
        });
        let taken = taken.join().expect("a thread").expect("all of it");
        assert_eq!(taken, count * 4096);
    }

    #[test]
    fn a_reader_that_is_gone_is_noticed() {
        let (reader, writer) = io::pipe().expect("a pipe");
        drop(reader);
        let mut output = Output::to(writer);
        while !output.is_closed() {
            if output.has_room() {
                output.put(vec![b'x']);
            }
        }
    }
}
