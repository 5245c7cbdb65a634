//! `trik record`: what the nodes of a mounted tree give, into a recording.
//!
//! Owns the run: which tree, when it ends, and what a person is told. The tree is read from outside, as any program reads it,
//! so nobody who samples or reads is delayed. `nodes` finds the nodes, `watch` looks at their rings, `disk` writes.

pub(crate) mod args;
mod disk;
mod nodes;
mod watch;

use crate::error::Error;
use crate::limits;
use crate::place;
use crate::refusal::Refusal;
use crate::up::session::signals;
use args::RecordArgs;
use disk::Disk;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::io::{self, IsTerminal, Write};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use watch::{Counts, Watch};

/// Where a tree is when nothing is said and no virtual robot runs.
const USUAL: &str = "/trikfs";

/// Records until somebody stops it.
///
/// # Errors
/// There is no tree, or the file cannot be written.
pub(crate) fn run(args: &RecordArgs) -> Result<u8, Refusal> {
    let root = tree(args.mountpoint.as_deref())?;
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let mut watch = Watch::begin(&root, |path| args.wants(path))?;
    let disk = Disk::create(&args.output)?;
    say(&begun(&watch, args))?;
    let is_watched = io::stderr().is_terminal();
    let begin = Instant::now();
    let end = args
        .seconds
        .map(|seconds| begin + Duration::from_secs(seconds.into()));
    let mut shown = begin;
    let why = loop {
        watch.look(&disk);
        let now = Instant::now();
        if let Ok(Some(_)) = signals.read_signal() {
            break "stopped";
        }
        if end.is_some_and(|end| now >= end) {
            break "the time is over";
        }
        if watch.is_gone() {
            break "the tree is gone";
        }
        if disk.has_failed() {
            break "the disk takes no more";
        }
        if is_watched && now >= shown + Duration::from_secs(1) {
            shown = now;
            let line = counted(watch.counts(), begin.elapsed(), disk.size());
            // A terminal that is gone is no reason to stop.
            let _ = write!(io::stderr(), "\r{line}\x1b[K");
        }
        let mut fds = [PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        let _ = poll(&mut fds, PollTimeout::from(limits::RECORD_LOOK_MS));
    };
    watch.end(&disk);
    let counts = watch.counts();
    disk.finish()?;
    if is_watched {
        let _ = write!(io::stderr(), "\r\x1b[K");
    }
    let size = std::fs::metadata(&args.output).map_or(0, |file| file.len());
    let line = counted(counts, begin.elapsed(), size);
    say(&format!("{}: {why}; {line}\n", args.output.display()))?;
    Ok(0)
}

/// A line of the run itself.
fn say(text: &str) -> Result<(), Refusal> {
    crate::output::standard(text.as_bytes())
}

/// What is recorded, and what is not.
fn begun(watch: &Watch, args: &RecordArgs) -> String {
    let (recorded, left_out) = (watch.recorded(), watch.left_out());
    let mut text = format!(
        "recording {recorded} nodes of {} into {}; Ctrl-C ends it\n",
        watch.root().display(),
        args.output.display()
    );
    if !left_out.is_empty() {
        let some: Vec<&str> = left_out.iter().take(4).map(String::as_str).collect();
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
fn tree(named: Option<&Path>) -> Result<PathBuf, Error> {
    let root = match named {
        Some(path) => path.to_owned(),
        None => {
            let base = place::base()?;
            let all = place::running(&base).map_err(|error| Error::file(&base, error))?;
            // Looking makes the directory; nobody needs it if no robot does.
            let _ = std::fs::remove_dir(&base);
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
