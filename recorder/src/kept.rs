//! The black box: the last minutes, as a ring of files.
//!
//! Owns the folder. The minutes are in parts, each a whole recording, of which the oldest goes when there are too many bytes or
//! it is too old; so a process that is killed loses what the last second has brought and no more. Saving puts the parts into
//! one file, which stays. Whether the folder is on a disk or in memory is the business of the one who names it.

use crate::clock::now_ns;
use crate::entry::{Batch, Entry};
use crate::error::Error;
use crate::file::{Disk, Writing};
use crate::limits;
use std::collections::VecDeque;
use std::fs::{self, File};
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// What the minutes are kept for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SaveReason {
    /// A person wants them.
    Asked,
    /// A key of the robot was pressed.
    Key,
    /// Everything was stopped.
    Stop,
    /// A program ended by a mistake.
    Crash,
    /// A node has no value any more.
    Fault,
    /// The process before this one left them.
    Restart,
}

impl SaveReason {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Asked,
        Self::Key,
        Self::Stop,
        Self::Crash,
        Self::Fault,
        Self::Restart,
    ];

    /// Its name, as names of files have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Asked => "asked",
            Self::Key => "key",
            Self::Stop => "stop",
            Self::Crash => "crash",
            Self::Fault => "fault",
            Self::Restart => "restart",
        }
    }
}

/// How much is kept, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The folder, which is made if it is not there.
    pub directory: PathBuf,
    /// What is older goes.
    pub span: Duration,
    /// Bytes of all parts together.
    pub bytes: u64,
}

/// One part that is not written any more.
struct Part {
    path: PathBuf,
    /// When the next one began.
    ended: Instant,
    bytes: u64,
    /// Until its end is written.
    writing: Option<Writing>,
}

/// Beginnings of names in the folder.
const PART: &str = "part-";
const SAVED: &str = "saved-";

/// The last minutes.
pub struct BlackBox {
    settings: Settings,
    library: String,
    parts: VecDeque<Part>,
    disk: Option<(Disk, Instant)>,
    looks_at: Instant,
    /// Number of the next part.
    next: u64,
    saved_at: Option<Instant>,
    /// One at a time is saved, on this thread.
    is_saving: Arc<AtomicBool>,
    saving: Option<JoinHandle<()>>,
}

/// What is told when minutes are saved: the file, or why there is none.
pub type OnSaved = Box<dyn FnOnce(Result<PathBuf, Error>) + Send>;

impl BlackBox {
    /// Takes the folder. What a process that was killed has left there is saved first, and `told` hears of it; `library` is the
    /// program that records, with its version.
    ///
    /// # Errors
    /// The folder cannot be used.
    pub fn open(settings: Settings, library: &str, told: OnSaved) -> Result<Self, Error> {
        let directory = &settings.directory;
        fs::create_dir_all(directory).map_err(|error| Error::io(directory, error))?;
        let left = named(directory, PART)?;
        let after_left = left.last().map_or(0, |path| number_after(path, PART));
        let mut kept = Self {
            library: library.to_owned(),
            parts: VecDeque::new(),
            disk: None,
            looks_at: Instant::now(),
            // Those that are left are removed by their names while new parts are written.
            next: after_left.max(now_ns() / 1_000_000),
            saved_at: None,
            is_saving: Arc::default(),
            saving: None,
            settings,
        };
        let left: Vec<Source> = left.into_iter().filter_map(Source::left).collect();
        if !left.is_empty() {
            kept.save_parts(left, SaveReason::Restart, told);
        }
        Ok(kept)
    }

    /// Keeps what has come. `beginning` gives what a part must have first.
    pub fn put(&mut self, batch: &Batch, beginning: impl FnOnce() -> Vec<Entry>) {
        let now = Instant::now();
        if now >= self.looks_at {
            self.looks_at = now + Duration::from_secs(1);
            let most = self.part_bytes();
            let span = self.settings.span / u32::try_from(limits::BOX_PARTS).unwrap_or(1);
            let is_over = self.disk.as_ref().is_some_and(|(disk, begun)| {
                let is_full = disk.size() >= most || begun.elapsed() >= span;
                // What is written to a file that somebody has removed is never saved.
                is_full || disk.has_failed() || !disk.path().exists()
            });
            if is_over {
                self.end_part();
            }
            self.forget(now);
        }
        if self.disk.is_none() {
            let path = (self.settings.directory).join(format!("{PART}{:016}.mcap", self.next));
            self.next += 1;
            // It may be the oldest that is left: what a node has had for long must not make the minutes longer.
            let times = batch.iter().filter_map(Entry::unix_ns);
            let begin_ns = times.min().unwrap_or_else(now_ns);
            let library = &self.library;
            let create = || Disk::create_at(begin_ns, &path, library, limits::BOX_WAITING_BYTES);
            let disk = create().or_else(|error| {
                // Somebody may have removed the folder.
                fs::create_dir_all(&self.settings.directory).map_err(|_| error)?;
                create()
            });
            let Ok(disk) = disk else {
                // The disk is full or read-only; the next second may be better.
                return;
            };
            // What has just come is not also before it.
            let has_come = |one: &Entry| batch.iter().any(|entry| entry.replaces(one));
            let mut first = beginning();
            first.retain(|entry| !has_come(entry));
            disk.put(&first.into());
            self.disk = Some((disk, now));
        }
        if let Some((disk, _)) = &self.disk {
            // A disk that is too slow loses this and not the robot.
            disk.put(batch);
        }
    }

    fn part_bytes(&self) -> u64 {
        (self.settings.bytes / limits::BOX_PARTS).max(limits::BOX_PART_BYTES_MIN)
    }

    fn end_part(&mut self) {
        if let Some((disk, _)) = self.disk.take() {
            self.parts.push_back(Part {
                path: disk.path().to_owned(),
                ended: Instant::now(),
                bytes: disk.size(),
                writing: Some(disk.end()),
            });
        }
    }

    /// Throws away what is too old or too much.
    fn forget(&mut self, now: Instant) {
        let room = self.settings.bytes.saturating_sub(self.part_bytes());
        while let Some(oldest) = self.parts.front() {
            let all: u64 = self.parts.iter().map(|part| part.bytes).sum();
            if all <= room && now.duration_since(oldest.ended) < self.settings.span {
                return;
            }
            if let Some(part) = self.parts.pop_front() {
                // Somebody may have taken it away.
                let _ = fs::remove_file(&part.path);
            }
        }
    }

    /// Whether it is time to save the minutes for this: what no person has asked for is not saved again and again.
    pub fn is_due(&self, why: SaveReason) -> bool {
        let again_ms = match why {
            SaveReason::Asked | SaveReason::Restart => return true,
            SaveReason::Key | SaveReason::Stop | SaveReason::Crash => limits::BOX_AGAIN_MS,
            SaveReason::Fault => limits::BOX_FAULT_AGAIN_MS,
        };
        let again = Duration::from_millis(again_ms);
        self.saved_at.is_none_or(|at| at.elapsed() >= again)
    }

    /// Saves the last minutes on a thread of its own, while the next ones are kept. `told` hears where, or why not; if there
    /// are no more threads, it is dropped.
    pub fn save(&mut self, why: SaveReason, told: OnSaved) {
        if self.is_saving.load(Ordering::Relaxed) {
            return told(Err(Error::Saving));
        }
        self.end_part();
        self.saved_at = Some(Instant::now());
        let parts = self.parts.iter_mut().filter_map(|part| {
            Some(Source {
                // From now on it may be thrown away, and is still read.
                file: File::open(&part.path).ok()?,
                writing: part.writing.take(),
                remove: None,
            })
        });
        let parts: Vec<Source> = parts.collect();
        if parts.is_empty() {
            let error = journal::error::Error::Absent("events in the black box yet".to_owned());
            told(Err(Error::File(self.settings.directory.clone(), error)));
            return;
        }
        self.save_parts(parts, why, told);
    }

    fn save_parts(&mut self, parts: Vec<Source>, why: SaveReason, told: OnSaved) {
        let directory = self.settings.directory.clone();
        // The newest has the greatest number also if the clock was set back, and none is written over.
        let newest = named(&directory, SAVED).unwrap_or_default().pop();
        let after_newest = newest.map_or(0, |path| number_after(&path, SAVED));
        let seconds = after_newest.max(now_ns() / 1_000_000_000);
        let path = directory.join(format!("{SAVED}{seconds}-{}.mcap", why.name()));
        let is_saving = self.is_saving.clone();
        is_saving.store(true, Ordering::Relaxed);
        let work = move || {
            let saved = join(parts, &path);
            // What is too much now goes with the next one.
            let _ = prune(&directory);
            is_saving.store(false, Ordering::Relaxed);
            told(saved.map(|()| path));
        };
        let thread = std::thread::Builder::new().name("box".to_owned());
        self.saving = thread.spawn(work).ok();
        if self.saving.is_none() {
            self.is_saving.store(false, Ordering::Relaxed);
        }
    }

    /// Ends it: nothing has happened that anybody wants to know of, so the parts go. Waits for what is being saved.
    pub fn close(mut self) {
        self.end_part();
        if let Some(saving) = self.saving.take() {
            // It has failed, and its file is no recording.
            let _ = saving.join();
        }
        for part in self.parts {
            if let Some(writing) = part.writing {
                // It goes anyway.
                let _ = writing.join();
            }
            let _ = fs::remove_file(&part.path);
        }
    }
}

/// A part that is put into one file with others.
struct Source {
    file: File,
    writing: Option<Writing>,
    /// It goes when the file is there.
    remove: Option<PathBuf>,
}

impl Source {
    /// One that an earlier process has left; None if it cannot be read.
    fn left(path: PathBuf) -> Option<Self> {
        Some(Self {
            file: File::open(&path).ok()?,
            writing: None,
            remove: Some(path),
        })
    }
}

/// Puts parts into one file, which is whole when it has its name.
fn join(parts: Vec<Source>, path: &Path) -> Result<(), Error> {
    let failed = |error| Error::File(path.to_owned(), error);
    let begun = path.with_extension("begun");
    let to = File::create(&begun).map_err(|error| Error::io(&begun, error))?;
    let mut files = Vec::new();
    let mut remove = Vec::new();
    for part in parts {
        if let Some(writing) = part.writing {
            // A part without its end is cut, and what is whole of it is taken.
            let _ = writing.join();
        }
        files.push(BufReader::new(part.file));
        remove.extend(part.remove);
    }
    let synced = to.try_clone().map_err(|error| Error::io(&begun, error))?;
    let joined = journal::mend::join(files, BufWriter::new(to));
    let is_saved = joined.map_err(failed).and_then(|_| {
        synced.sync_all().map_err(|error| Error::io(path, error))?;
        fs::rename(&begun, path).map_err(|error| Error::io(path, error))
    });
    if is_saved.is_err() {
        let _ = fs::remove_file(&begun);
    }
    for path in remove {
        // What cannot be read will not be read the next time either.
        let _ = fs::remove_file(path);
    }
    is_saved
}

/// Throws away the oldest saved files. Those that a person has asked for and fetched do not push out what was saved by itself.
fn prune(directory: &Path) -> Result<(), Error> {
    let mut saved = named(directory, SAVED)?;
    let asked = format!("-{}.mcap", SaveReason::Asked.name());
    let is_asked = |path: &PathBuf| path.to_string_lossy().ends_with(&asked);
    let (asked, other): (Vec<_>, Vec<_>) = saved.drain(..).partition(is_asked);
    let old_asked = asked.iter().rev().skip(limits::BOX_ASKED);
    let others = limits::BOX_SAVED - asked.len().min(limits::BOX_ASKED);
    for path in old_asked.chain(other.iter().rev().skip(others)) {
        // The next saving tries it again.
        let _ = fs::remove_file(path);
    }
    Ok(())
}

/// The saved files of a folder, from the oldest to the newest.
///
/// # Errors
/// The folder cannot be read.
pub fn saved(directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut all = named(directory, SAVED)?;
    all.retain(|path| path.extension().is_some_and(|end| end == "mcap"));
    Ok(all)
}

/// Files of a folder whose names begin so, in the order of their numbers, which follow.
fn named(directory: &Path, begin: &str) -> Result<Vec<PathBuf>, Error> {
    let entries = fs::read_dir(directory).map_err(|error| Error::io(directory, error))?;
    let mut all: Vec<PathBuf> = entries
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().starts_with(begin))
        .map(|entry| entry.path())
        .collect();
    all.sort_by_cached_key(|path| (number(path, begin), path.clone()));
    Ok(all)
}

/// The number after the beginning of the name of a file; 0 if there is none.
fn number(path: &Path, begin: &str) -> u64 {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let after = name.strip_prefix(begin).unwrap_or_default();
    let end = after.find(|c: char| !c.is_ascii_digit());
    after[..end.unwrap_or(after.len())].parse().unwrap_or(0)
}

/// The one for a file that comes after this.
fn number_after(path: &Path, begin: &str) -> u64 {
    number(path, begin).saturating_add(1)
}

#[cfg(test)]
mod tests;
