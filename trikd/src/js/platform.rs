//! What an engine runs on: the robot, time, streams, and what is around the program.
//!
//! Owns the border between the functions of our scripts and where a program runs: on a robot, or under a judge in time
//! that passes only when programs wait. [`Mounted`] is the robot; the rest implements [`Platform`].

use super::events::{Record, Streams};
use super::files::{Unread, read_text};
use super::machine::Job;
use super::shared::{Shared, Slot};
use crate::brick::Brick;
use crate::display::Unshown;
use crate::engine::NoThread;
use crate::pictures::{self, NoPicture};
use screen::Pixels;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Something for the display.
#[derive(Clone, Copy, Debug)]
pub enum Shown<'a> {
    /// One order of [`screen::order`].
    Order(&'a str),
    /// A picture in a file, named as the program names it.
    File(&'a str),
    /// Pixels that the program has computed: numbers, width, height, format.
    Numbers(&'a [i32], i32, i32, &'a str),
}

/// What one engine runs on. Files are named as the program names them, relative to its folder.
pub trait Platform {
    /// The robot, for this engine alone.
    fn brick(&self) -> Brick;

    /// Milliseconds since the beginning of the engine, or of the run.
    fn clock_ms(&self) -> f64;

    /// Asked now and then while a program computes: whether the engine is to end.
    fn stops(&self, slot: &Slot) -> bool {
        slot.stops()
    }

    /// Waits until the bell of the slot rings or a stream has something, at most until then; infinity: for ever. Returns
    /// whether there is a reason to look.
    ///
    /// # Errors
    /// Nothing can be waited for.
    fn wait(&self, slot: &Slot, until_ms: f64) -> io::Result<bool>;

    /// Opens a stream, as [`Streams::listen`].
    ///
    /// # Errors
    /// Those of the tree.
    fn listen(&self, brick: &Brick, path: &str, numbers: usize) -> io::Result<()>;

    /// All that has come from one stream, without waiting.
    fn drain(&self, path: &str) -> Vec<Record>;

    /// Closes a stream, where streams are open.
    fn forget(&self, _path: &str) {}

    /// The oldest record of any stream.
    fn next(&self) -> Option<(String, Record)>;

    /// Starts another thread of the program.
    ///
    /// # Errors
    /// Why there is none.
    fn start(&self, shared: &Arc<Shared>, job: Job) -> Result<(), NoThread> {
        shared.start(job)
    }

    /// Something has changed that other threads wait for.
    fn give_way(&self) {}

    /// Whether somebody wants to know at which lines the program waits and asks the robot.
    fn is_watched(&self) -> bool {
        false
    }

    /// It does so at this line of a file that it has included, or of its own text, whose name is empty.
    fn stand(&self, _slot: &Slot, _file: &str, _line: u32) {}

    /// The program has printed something.
    fn has_spoken(&self) {}

    /// Asks the mailbox.
    ///
    /// # Errors
    /// Those of the connection.
    fn mailbox(&self, shared: &Shared, words: String) -> io::Result<String> {
        let answer = shared.ask(words).recv();
        answer.unwrap_or_else(|_| Err(io::Error::other("the program ends")))
    }

    /// Shows something.
    ///
    /// # Errors
    /// Why it is not shown.
    fn show(&self, shared: &Shared, shown: Shown<'_>) -> Result<(), Unshown> {
        let mut display = shared.display();
        match shown {
            Shown::Order(line) => display.order(line),
            Shown::File(file) => display.show_file(&shared.folder.join(file)),
            Shown::Numbers(numbers, width, height, format) => {
                display.show_numbers(numbers, width, height, format)
            }
        }
    }

    /// A picture of the camera.
    ///
    /// # Errors
    /// Why there is none.
    fn photo(&self, shared: &Shared) -> Result<Pixels, NoPicture> {
        pictures::photo(&shared.root)
    }

    /// The text of a file that the program includes.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn include(&self, shared: &Shared, file: &str) -> Result<String, Unread> {
        read_text(&shared.folder.join(file))
    }

    /// The text of a file that the program reads.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn read_file(&self, shared: &Shared, file: &str) -> Result<String, Unread> {
        read_text(&shared.folder.join(file))
    }

    /// Appends to what is in a file.
    ///
    /// # Errors
    /// Those of the file.
    fn append(&self, shared: &Shared, file: &str, bytes: &[u8]) -> io::Result<()> {
        let path = shared.folder.join(file);
        let mut file = OpenOptions::new().append(true).create(true).open(path)?;
        file.write_all(bytes)
    }

    /// Removes a file. That it is not there is what was wanted.
    ///
    /// # Errors
    /// Those of the file.
    fn remove(&self, shared: &Shared, file: &str) -> io::Result<()> {
        match std::fs::remove_file(shared.folder.join(file)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }

    /// Runs a command of the system; its exit code if it is waited for.
    ///
    /// # Errors
    /// It cannot be started.
    fn system(&self, shared: &Shared, command: &str, waits: bool) -> io::Result<i32> {
        let mut shell = Command::new("sh");
        shell.arg("-c").arg(command);
        // What helpers say is not what the program says.
        shell.stdin(Stdio::null());
        shell.stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = shell.current_dir(&shared.folder).spawn()?;
        if waits {
            return Ok(child.wait()?.code().unwrap_or(-1));
        }
        // Without a thread it stays a zombie until the program ends, which is no harm.
        let _ = std::thread::Builder::new()
            .name("system".to_owned())
            .stack_size(64 << 10)
            .spawn(move || child.wait());
        Ok(0)
    }

    /// A random whole number, both bounds included, where chance and the calendar belong to somebody else.
    fn random(&self, _low: i32, _high: i32) -> Option<i32> {
        None
    }

    /// The time of day in milliseconds, where chance and the calendar belong to somebody else.
    fn date_ms(&self) -> Option<f64> {
        None
    }
}

/// The robot below a mounted tree.
pub struct Mounted {
    root: std::path::PathBuf,
    streams: Streams,
    began: Instant,
}

impl Mounted {
    /// The tree at `root`; the clock begins now.
    pub fn new(root: &std::path::Path) -> Self {
        Self {
            root: root.to_owned(),
            streams: Streams::default(),
            began: Instant::now(),
        }
    }

    /// None: for ever.
    fn instant(&self, at_ms: f64) -> Option<Instant> {
        let seconds = Duration::try_from_secs_f64(at_ms / 1000.0).ok()?;
        self.began.checked_add(seconds)
    }
}

impl Platform for Mounted {
    fn brick(&self) -> Brick {
        Brick::new(&self.root)
    }

    fn clock_ms(&self) -> f64 {
        self.began.elapsed().as_secs_f64() * 1000.0
    }

    fn wait(&self, slot: &Slot, until_ms: f64) -> io::Result<bool> {
        self.streams.wait(slot, self.instant(until_ms))
    }

    fn listen(&self, brick: &Brick, path: &str, numbers: usize) -> io::Result<()> {
        self.streams.listen(brick, path, numbers)
    }

    fn drain(&self, path: &str) -> Vec<Record> {
        self.streams.drain(path)
    }

    fn forget(&self, path: &str) {
        self.streams.forget(path);
    }

    fn next(&self) -> Option<(String, Record)> {
        self.streams.next()
    }
}
