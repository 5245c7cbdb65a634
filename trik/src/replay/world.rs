//! The world around the robot of a recording, at the position of its player, for the page.
//!
//! Owns the thread that reads it while somebody looks, and nothing of the file but what is shown. What is in its texts is known to
//! the simulator that made them and to the page, which believes nothing of them; here they are JSON or nothing.

use crate::error::Error;
use crate::limits;
use journal::read::{Event, EventKind, Reader};
use journal::write::Story;
use page::world::{Refused, World};
use recorder::world::ATTACHED;
use serde_json::Value;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// The world of a recording. Dropping it ends its thread.
pub(crate) struct RecordedWorld {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    shown: Mutex<Shown>,
    is_ending: AtomicBool,
}

/// What is there now, as JSON.
#[derive(Clone, Default)]
struct Shown {
    version: u64,
    /// Shared by all looks until it changes: it may be long.
    scene: Arc<str>,
    state: String,
}

impl Shared {
    fn shown(&self) -> MutexGuard<'_, Shown> {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl RecordedWorld {
    /// That of a file, at a position that may be another one at each look; None if nothing of a world is in it.
    ///
    /// # Errors
    /// The file is no recording, or there are no more threads.
    pub(crate) fn open(
        path: &Path,
        position: impl Fn() -> Duration + Send + 'static,
    ) -> Result<Option<Self>, Error> {
        let file = File::open(path).map_err(|error| Error::file(path, error))?;
        let reader = Reader::open(BufReader::new(file)).map_err(|why| Error::file(path, why))?;
        let (counts, _) = reader.counts();
        if !counts.contains_key(Story::World.topic()) {
            return Ok(None);
        }
        let shared = Arc::<Shared>::default();
        let mut tape = Tape::new(reader);
        // What a page asks for first is there.
        let first = tape.go(position(), &mut shared.shown());
        first.map_err(|why| Error::file(path, why))?;
        let ours = shared.clone();
        let thread = std::thread::Builder::new()
            .name("world".to_owned())
            .spawn(move || {
                loop {
                    // Each look of a page ends it once.
                    std::thread::park();
                    if ours.is_ending.load(Ordering::Acquire) {
                        return;
                    }
                    let mut next = ours.shown().clone();
                    // Of a file that is damaged the last good moment stays.
                    if tape.go(position(), &mut next).is_ok() {
                        *ours.shown() = next;
                    }
                }
            })
            .map_err(|why| Error::system("a thread", why))?;
        Ok(Some(Self {
            shared,
            thread: Some(thread),
        }))
    }
}

impl Drop for RecordedWorld {
    fn drop(&mut self) {
        self.shared.is_ending.store(true, Ordering::Release);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // It has failed: there is nothing to wait for.
            let _ = thread.join();
        }
    }
}

impl World for RecordedWorld {
    fn scene(&self) -> (u64, String) {
        let shown = self.shared.shown();
        (shown.version, shown.scene.to_string())
    }

    fn version(&self) -> u64 {
        self.shared.shown().version
    }

    fn state(&self) -> String {
        if let Some(thread) = &self.thread {
            thread.thread().unpark();
        }
        self.shared.shown().state.clone()
    }

    fn order(&self, _: &str) -> Result<(), Refused> {
        Err(Refused(super::words::no_orders()))
    }

    fn takes_orders(&self) -> bool {
        false
    }
}

/// The file, read on where the last look was.
struct Tape {
    reader: Reader<BufReader<File>>,
    /// The moment that was looked at last; None before the first one.
    at_ns: Option<u64>,
    /// What comes next, if something does.
    next: Option<Line>,
    /// The time of the scene.
    scene_ns: Option<u64>,
}

/// What was told at a time.
struct Line {
    unix_ns: u64,
    text: String,
}

impl Tape {
    fn new(reader: Reader<BufReader<File>>) -> Self {
        Self {
            reader,
            at_ns: None,
            next: None,
            scene_ns: None,
        }
    }

    /// Shows what is there at a position.
    fn go(&mut self, position: Duration, shown: &mut Shown) -> Result<(), journal::error::Error> {
        let after = u64::try_from(position.as_nanos()).unwrap_or(u64::MAX);
        let now = self.reader.begin_ns().saturating_add(after);
        let goes_on =
            |at: u64| (at..=at.saturating_add(limits::REPLAY_WORLD_NEAR_NS)).contains(&now);
        if self.at_ns.is_some_and(|at| at == now) {
            return Ok(());
        }
        let is_sought = !self.at_ns.is_some_and(goes_on);
        let last = match is_sought {
            true => self.seek(now)?,
            false => self.until(now)?,
        };
        self.at_ns = Some(now);
        match (last, &self.next) {
            (Some(line), _) => shown.state = line.text,
            // The recorder finds the world a moment after it has begun.
            (None, Some(next)) if is_sought => shown.state.clone_from(&next.text),
            (None, _) => {}
        }
        self.enter(now, shown)
    }

    /// What was told last until a moment, found in steps back that grow: a world in which nothing happens tells nothing.
    fn seek(&mut self, now: u64) -> Result<Option<Line>, journal::error::Error> {
        let begin = self.reader.begin_ns();
        let mut back = limits::REPLAY_WORLD_NEAR_NS;
        loop {
            let from = now.saturating_sub(back).max(begin);
            self.reader.seek_lines(from, Story::World);
            self.next = self.read()?;
            let last = self.until(now)?;
            if last.is_some() || from == begin {
                return Ok(last);
            }
            back = back.saturating_mul(4);
        }
    }

    /// The last of what was told until a moment and not read yet.
    fn until(&mut self, now: u64) -> Result<Option<Line>, journal::error::Error> {
        let mut last = None;
        while self.next.as_ref().is_some_and(|next| next.unix_ns <= now) {
            let next = self.read()?;
            last = std::mem::replace(&mut self.next, next);
        }
        Ok(last)
    }

    fn read(&mut self) -> Result<Option<Line>, journal::error::Error> {
        while let Some(Event { unix_ns, what }) = self.reader.next()? {
            if let EventKind::Line(Story::World, line) = what
                && is_json(line.text.as_bytes())
            {
                let text = line.text;
                return Ok(Some(Line { unix_ns, text }));
            }
        }
        Ok(None)
    }

    /// What stood still at a moment, if that is another one.
    fn enter(&mut self, now: u64, shown: &mut Shown) -> Result<(), journal::error::Error> {
        let time = self.reader.attachment_time(ATTACHED, now);
        if time == self.scene_ns && !shown.scene.is_empty() {
            return Ok(());
        }
        let bytes = match time {
            Some(time) => self.reader.attachment_of(ATTACHED, time)?,
            None => Vec::new(),
        };
        self.scene_ns = time;
        let text = String::from_utf8(bytes).ok();
        let text = text.filter(|text| is_json(text.as_bytes()));
        // The page shows a world without anything.
        shown.scene = text.unwrap_or_else(|| "null".to_owned()).into();
        shown.version += 1;
        Ok(())
    }
}

/// Whether it can stand in JSON, and is not too long for that.
fn is_json(text: &[u8]) -> bool {
    text.len() <= limits::REPLAY_WORLD_BYTES_MAX && serde_json::from_slice::<Value>(text).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::node::Node;
    use journal::standard::{Level, Log};
    use journal::write::Writer;
    use std::sync::atomic::AtomicU32;

    const S: u64 = 1_000_000_000;
    const BEGIN: u64 = 1000 * S;

    /// A sample in each second for a minute, a place in each of the first ten and one at 50 s, two scenes.
    fn recorded(path: &Path, has_world: bool) {
        let mut writer = Writer::new(File::create(path).unwrap(), "test").unwrap();
        let id = writer.add(&Node::sensor("m", "u8 x")).unwrap();
        let place = |writer: &mut Writer<File>, at: u64, text: &str| {
            let line = Log {
                level: Level::Info,
                name: "world".to_owned(),
                text: text.to_owned(),
                errno: 0,
            };
            writer.line(Story::World, BEGIN + at * S, &line).unwrap();
        };
        for at in 0..60 {
            writer.sample(id, BEGIN + at * S, &[7]).unwrap();
            if !has_world {
                continue;
            }
            if (1..10).contains(&at) || at == 50 {
                place(&mut writer, at, &format!("{{\"t\":{at}}}"));
            }
            if at == 20 {
                place(&mut writer, at, "}, {");
            }
        }
        for (at, text) in [(2, "{\"n\":1}"), (40, "{\"n\":2}")] {
            if has_world {
                let kind = "application/json";
                (writer.attach(BEGIN + at * S, ATTACHED, kind, text.as_bytes())).unwrap();
            }
        }
        writer.finish().unwrap();
    }

    #[test]
    fn a_moment_has_what_was_told_last_and_the_scene_of_then() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("run.mcap");
        recorded(&path, true);
        let reader = Reader::open(BufReader::new(File::open(&path).unwrap())).unwrap();
        let mut tape = Tape::new(reader);
        let mut shown = Shown::default();
        let mut at = |seconds: f64| {
            tape.go(Duration::from_secs_f64(seconds), &mut shown)
                .unwrap();
            format!("{} {} {}", shown.state, shown.scene, shown.version)
        };
        assert_eq!(
            at(0.0),
            "{\"t\":1} {\"n\":1} 1",
            "it was found a moment later"
        );
        assert_eq!(at(3.5), "{\"t\":3} {\"n\":1} 1");
        assert_eq!(at(9.0), "{\"t\":9} {\"n\":1} 1");
        assert_eq!(at(45.0), "{\"t\":9} {\"n\":2} 2", "rubbish tells nothing");
        assert_eq!(at(55.0), "{\"t\":50} {\"n\":2} 2");
        assert_eq!(at(4.0), "{\"t\":4} {\"n\":1} 3");
        assert_eq!(at(4.5), "{\"t\":4} {\"n\":1} 3");
        assert_eq!(at(0.5), "{\"t\":1} {\"n\":1} 3");
    }

    #[test]
    fn it_follows_the_player_while_somebody_looks_and_takes_no_orders() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("run.mcap");
        recorded(&path, true);
        let position = Arc::new(AtomicU32::new(1));
        let ours = position.clone();
        let world = RecordedWorld::open(&path, move || {
            Duration::from_secs(u64::from(ours.load(Ordering::Acquire)))
        });
        let world = world.unwrap().unwrap();
        assert_eq!(world.state(), "{\"t\":1}");
        assert_eq!(world.scene(), (1, "{\"n\":1}".to_owned()));
        for at in [7, 50, 2] {
            position.store(at, Ordering::Release);
            let wanted = format!("{{\"t\":{at}}}");
            while world.state() != wanted {
                std::thread::yield_now();
            }
        }
        assert!(!world.takes_orders());
        assert!(world.order("reset").is_err());
    }

    #[test]
    fn a_recording_without_a_world_has_none() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("run.mcap");
        recorded(&path, false);
        let world = RecordedWorld::open(&path, || Duration::ZERO).unwrap();
        assert!(world.is_none());
    }
}
