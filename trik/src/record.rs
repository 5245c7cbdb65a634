//! `trik record`: what the nodes of a mounted tree give, into a recording.
//!
//! Owns the run: which tree, when it ends, and what a person is told. What is seen and how it gets into a file is `recorder`'s.

pub(crate) mod args;

use crate::error::Error;
use crate::output::Output;
use crate::place;
use crate::refusal::Refusal;
use crate::remote::recorded;
use crate::up::session::signals;
use crate::up::telling;
use args::{RecordArgs, Recorded};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use recorder::entry::{Batch, Entry, events};
use recorder::file::Disk;
use recorder::watch::{Watch, Wish};
use std::io::{self, IsTerminal, Write};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The program that records, with its version.
const LIBRARY: &str = concat!("trik/", env!("CARGO_PKG_VERSION"));
/// Where a tree is when nothing is said and no virtual robot runs.
const USUAL: &str = "/trikfs";

/// Why there is nothing of `--raw`.
pub(crate) const NO_RAW: &str = "no node gives what it has before it is converted: give nodes raw = true in the \
     configuration, or start the tree with trik up --raw or trikfs mount --raw";

/// Records until somebody stops it.
///
/// # Errors
/// There is no tree, or the file cannot be written.
pub(crate) fn run(args: &RecordArgs) -> Result<u8, Refusal> {
    let output = Output::recording(&args.output, args.force);
    output.refuse_no_file()?;
    output.refuse_present()?;
    let named = match &args.robot {
        Some(Recorded::Network(_)) if args.raw && args.hz.is_some() => {
            let why = "--raw records all that devices give: leave --hz out";
            return Err(Refusal::new(why));
        }
        Some(Recorded::Network(robot)) => return recorded::record(args, robot),
        Some(Recorded::Tree(_)) if args.hz.is_some() => {
            let why =
                "--hz is for a robot in the network: of a mounted tree all samples are recorded";
            return Err(Refusal::new(why));
        }
        Some(Recorded::Tree(path)) => Some(path),
        None => args.mountpoint.as_ref(),
    };
    let root = tree(named.map(PathBuf::as_path))?;
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let watch = watched(args, &root)?;
    let create = match args.no_standard {
        false => Disk::create_with_standard,
        true => Disk::create,
    };
    let place = output.make_room()?;
    let disk = create(&place, LIBRARY, recorder::limits::WAITING_BYTES);
    let disk = disk.map_err(refused)?;
    let mut tape = Tape::begin(watch, disk);
    // What is written as soon as the person reads that it has begun does not count as what was there before.
    tape.look();
    say(&begun(&tape.watch, args))?;
    let is_watched = io::stderr().is_terminal();
    let begin = Instant::now();
    let end = args
        .seconds
        .map(|seconds| begin + Duration::from_secs(seconds.into()));
    let mut shown = begin;
    let why = loop {
        tape.look();
        let now = Instant::now();
        if let Ok(Some(_)) = signals.read_signal() {
            break "stopped";
        }
        if end.is_some_and(|end| now >= end) {
            break "the time is over";
        }
        if tape.watch.is_gone() {
            break "the tree is gone";
        }
        if tape.disk.has_failed() {
            break "the disk takes no more";
        }
        if is_watched && now >= shown + Duration::from_secs(1) {
            shown = now;
            let line = counted(tape.counts(), begin.elapsed(), tape.disk.size());
            // A terminal that is gone is no reason to stop.
            let _ = write!(io::stderr(), "\r{line}\x1b[K");
        }
        let mut fds = [PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        let _ = poll(&mut fds, PollTimeout::from(recorder::limits::LOOK_MS));
    };
    let counts = tape.end().map_err(refused)?;
    if is_watched {
        let _ = write!(io::stderr(), "\r\x1b[K");
    }
    let size = std::fs::metadata(&args.output).map_or(0, |file| file.len());
    let line = counted(counts, begin.elapsed(), size);
    say(&format!("{}: {why}; {line}\n", args.output.display()))?;
    Ok(0)
}

/// The tree, as it is to be looked at.
fn watched(args: &RecordArgs, root: &Path) -> Result<Watch, Error> {
    let wanted = args.clone();
    let wants = Box::new(move |path: &str| wanted.wants(path).then_some(Wish::Samples));
    let watch = Watch::begin(root, LIBRARY, wants).map_err(refused)?;
    let watch = watch.with_world(world(root).as_deref()).with_raw(args.raw);
    if args.raw && watch.raws() == 0 {
        return Err(Error::file(root, NO_RAW));
    }
    Ok(watch)
}

/// Where the world around the virtual robot of this tree is told; None if it is none of this user.
fn world(root: &Path) -> Option<PathBuf> {
    let all = place::running().ok()?;
    let is_it = |robot: &place::Running| robot.mountpoint.canonicalize().is_ok_and(|at| at == root);
    let robot = all.into_iter().find(is_it)?;
    Some(telling::folder(&robot.board))
}

/// What has come, and what has not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Counts {
    events: u64,
    /// Overwritten in their rings before they were looked at.
    missed: u64,
    /// The disk was too slow.
    dropped: u64,
}

/// A tree that is looked at, and the file that has what it does.
struct Tape {
    watch: Watch,
    disk: Disk,
    counts: Counts,
}

impl Tape {
    fn begin(watch: Watch, disk: Disk) -> Self {
        // An empty queue takes it.
        disk.put(&watch.beginning().into());
        Self {
            watch,
            disk,
            counts: Counts::default(),
        }
    }

    fn counts(&self) -> Counts {
        Counts {
            missed: self.watch.missed(),
            ..self.counts
        }
    }

    /// Takes what has come since the last look.
    fn look(&mut self) {
        let mut entries = Vec::new();
        self.watch.look(&mut entries);
        if entries.is_empty() {
            return;
        }
        let batch: Batch = entries.into();
        match self.disk.put(&batch) {
            true => self.counts.events += events(&batch),
            false => {
                self.counts.dropped += events(&batch);
                self.watch.tell_again();
            }
        }
    }

    /// Says what is missing, and writes the end.
    fn end(mut self) -> Result<Counts, recorder::error::Error> {
        self.look();
        let counts = self.counts();
        let facts = [
            ("events", counts.events),
            ("missed", counts.missed),
            ("dropped", counts.dropped),
        ];
        let facts = facts.map(|(key, count)| (key.to_owned(), count.to_string()));
        // Without room the end of the file is all that is left to write.
        let _ = (self.disk).put(&vec![Entry::Facts("counts", Arc::new(facts.into()))].into());
        self.disk.finish()?;
        Ok(counts)
    }
}

/// What cannot be recorded, for the person.
fn refused(error: recorder::error::Error) -> Error {
    Error::Refused(error.to_string())
}

/// A line of the run itself.
fn say(text: &str) -> Result<(), Refusal> {
    crate::output::standard(text.as_bytes())
}

/// What is recorded, and what is not.
fn begun(watch: &Watch, args: &RecordArgs) -> String {
    let recorded = watch.recorded();
    let left_out: Vec<&str> = watch.left_out().collect();
    let raw = match watch.raws() {
        0 => String::new(),
        count => format!(", and the bytes of {count} before they are converted,"),
    };
    let mut text = format!(
        "recording {recorded} nodes{raw} of {} into {}; Ctrl-C ends it\n",
        watch.root().display(),
        args.output.display()
    );
    if !left_out.is_empty() {
        let some = &left_out[..left_out.len().min(4)];
        let more = if left_out.len() > some.len() {
            ", ..."
        } else {
            ""
        };
        text.push_str(&format!(
            "not recorded, because nothing samples them in the background: {} ({}{more})\n",
            left_out.len(),
            some.join(", ")
        ));
    }
    text
}

/// How far it is.
fn counted(counts: Counts, elapsed: Duration, bytes: u64) -> String {
    let Counts {
        events,
        missed,
        dropped,
    } = counts;
    let mut text = format!(
        "{:.1} s, {events} events, {} KiB",
        elapsed.as_secs_f64(),
        bytes / 1024
    );
    if missed > 0 {
        text.push_str(&format!(", {missed} missed"));
    }
    if dropped > 0 {
        text.push_str(&format!(", {dropped} dropped because the disk is slow"));
    }
    text
}

/// The tree that is meant.
///
/// # Errors
/// There is none, or there are several.
pub(crate) fn tree(named: Option<&Path>) -> Result<PathBuf, Error> {
    let root = match named {
        Some(path) => path.to_owned(),
        None => {
            let all = place::running()?;
            match &all[..] {
                [one] => one.mountpoint.clone(),
                [] if Path::new(USUAL).join("config").exists() => PathBuf::from(USUAL),
                [] => {
                    return Err(Error::Refused(
                        "there is no tree: start a robot with trik up, or name a mount point"
                            .to_owned(),
                    ));
                }
                several => {
                    let points = several
                        .iter()
                        .map(|robot| robot.mountpoint.display().to_string());
                    return Err(Error::Refused(format!(
                        "several robots run: name one of {}",
                        points.collect::<Vec<_>>().join(", ")
                    )));
                }
            }
        }
    };
    let root = root.canonicalize().map_err(|why| Error::file(&root, why))?;
    match root.join("config").exists() && root.join("status").exists() {
        true => Ok(root),
        false => Err(Error::file(&root, "no tree of trikfs is mounted there")),
    }
}
