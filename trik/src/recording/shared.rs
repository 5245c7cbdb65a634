//! What commands for recordings share: the way to an open file, moments of it, and what a long work says.
//!
//! Owns these. What a recording is, is known to `journal`.

use crate::error::Error;
use crate::limits;
use journal::read::Reader;
use std::fs::File;
use std::io::{self, BufReader, IsTerminal, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// An open recording.
pub(crate) type Opened = Reader<BufReader<File>>;

/// A regular file that the person named.
fn file(path: &Path) -> Result<File, Error> {
    let file = File::open(path).map_err(|error| Error::file(path, error))?;
    match file.metadata() {
        Ok(there) if there.is_file() => Ok(file),
        Ok(_) => Err(Error::file(path, "a recording is a regular file")),
        Err(error) => Err(Error::file(path, error)),
    }
}

/// The recording in it.
pub(crate) fn open(path: &Path) -> Result<Opened, Error> {
    Reader::open(BufReader::new(file(path)?)).map_err(|why| Error::file(path, why))
}

/// Whether the name of a file ends so, which says its form; in small letters or capital ones.
pub(crate) fn has_ending(path: &Path, ending: &str) -> bool {
    let own = path.extension();
    own.is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// A moment as seconds from the beginning, in ns.
pub(crate) fn moment(text: &str) -> Result<u64, Error> {
    let seconds: Option<f64> = text.parse().ok();
    let fits = |one: &f64| (0.0..=limits::RECORDING_SECONDS_MAX).contains(one);
    match seconds.filter(fits) {
        Some(seconds) => {
            let exact = Duration::from_secs_f64(seconds).as_nanos();
            Ok(u64::try_from(exact).unwrap_or(u64::MAX))
        }
        None => Err(Error::Refused(
            "not a number of seconds from the beginning of the recording".to_owned(),
        )),
    }
}

/// Seconds with all digits that they have, at least one after the point.
pub(crate) fn seconds(ns: u64) -> String {
    let text = format!("{}.{:09}", ns / 1_000_000_000, ns % 1_000_000_000);
    let end = text.trim_end_matches('0');
    let zero = if end.ends_with('.') { "0" } else { "" };
    format!("{end}{zero}")
}

/// Says in a terminal how far a long work is.
pub(crate) struct Progress {
    is_shown: bool,
    next: Instant,
}

impl Progress {
    pub(crate) fn new() -> Self {
        Self {
            is_shown: io::stderr().is_terminal(),
            next: Instant::now() + limits::PROGRESS,
        }
    }

    /// So much of the whole is done.
    pub(crate) fn at(&mut self, done: u64, whole: u64) {
        if !self.is_shown {
            return;
        }
        let now = Instant::now();
        if now >= self.next {
            self.next = now + limits::PROGRESS;
            let percent = u128::from(done) * 100 / u128::from(whole.max(1));
            // A terminal that is gone is no reason to stop.
            let _ = write!(io::stderr(), "\r{} %\x1b[K", percent.min(100));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.is_shown {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

/// A file that is read from its beginning to its end, and says how far it is.
pub(crate) struct Watched {
    file: BufReader<File>,
    done: u64,
    whole: u64,
    progress: Progress,
}

impl Watched {
    pub(crate) fn open(path: &Path) -> Result<Self, Error> {
        let file = file(path)?;
        let whole = file.metadata().map_or(0, |there| there.len());
        Ok(Self {
            file: BufReader::new(file),
            done: 0,
            whole,
            progress: Progress::new(),
        })
    }
}

impl Read for Watched {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(out)?;
        self.done += read as u64;
        self.progress.at(self.done, self.whole);
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_form_of_a_file_is_the_ending_of_its_name() {
        for name in ["a.csv", "b/a.CSV", "a.mcap.csv"] {
            assert!(has_ending(Path::new(name), "csv"), "{name}");
        }
        for name in ["a", "csv", ".csv", "a.csv.gz", "a.csv/b"] {
            assert!(!has_ending(Path::new(name), "csv"), "{name}");
        }
    }

    #[test]
    fn moments_are_seconds_and_keep_their_digits() {
        for (text, ns) in [("0", 0), ("1.5", 1_500_000_000), ("0.001", 1_000_000)] {
            assert_eq!(moment(text), Ok(ns));
        }
        for text in ["-1", "nan", "inf", "", "1e300", "1:30"] {
            assert!(moment(text).is_err(), "{text}");
        }
        assert_eq!(seconds(1_500_000_000), "1.5");
        assert_eq!(seconds(0), "0.0");
        assert_eq!(seconds(1), "0.000000001");
    }
}
