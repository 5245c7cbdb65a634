//! Files that commands write: never over another one by mistake, and whole or not at all.
//!
//! Owns the choice between standard output, a new file and one that is replaced. Knows nothing of what is written.

pub(crate) mod csv;
mod words;

use crate::refusal::Refusal;
use crate::terminal::named;
use lang_text::problem::{Locale, Words};
use std::fs::{self, File, Metadata};
use std::io::{self, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// Where a result goes.
pub(crate) struct Output<'a> {
    /// `None` and `-` are standard output.
    pub path: Option<&'a Path>,
    /// Whether a file that is there may be replaced.
    pub force: bool,
    /// The file that was read, which is never replaced.
    pub source: &'a Path,
    /// The language in which a refusal is told.
    pub locale: Locale,
}

impl<'a> Output<'a> {
    /// A recording of what happens meanwhile: no file is read for it.
    pub fn recording(path: &'a Path, force: bool) -> Self {
        Self {
            path: Some(path),
            force,
            source: Path::new(""),
            locale: Locale::English,
        }
    }

    fn refusal(&self, words: Words) -> Refusal {
        Refusal::new(words.in_locale(self.locale))
    }

    /// The file, or `None` for standard output.
    fn file(&self) -> Option<&Path> {
        self.path.filter(|path| *path != Path::new("-"))
    }

    /// Whether it goes to standard output.
    pub fn is_standard(&self) -> bool {
        self.file().is_none()
    }

    /// Refuses what must not be replaced: better before the work than after it.
    ///
    /// # Errors
    /// It is the file that was read; it is there and `force` is not given.
    pub fn refuse_present(&self) -> Result<(), Refusal> {
        let Some(path) = self.file() else {
            return Ok(());
        };
        let name = named(path);
        if is_same(path, self.source) {
            return Err(self.refusal(words::is_source(&name)));
        }
        if !self.force && path.symlink_metadata().is_ok() {
            return Err(self.refusal(words::is_there(&name)));
        }
        Ok(())
    }

    /// Refuses standard output, directories, devices and pipes, for what only a file can hold. A link is what it leads to.
    ///
    /// # Errors
    /// It is one of them.
    pub fn refuse_no_file(&self) -> Result<(), Refusal> {
        let Some(path) = self.file() else {
            return Err(self.refusal(words::needs_file()));
        };
        match path.metadata() {
            Ok(there) if !there.is_file() => Err(self.refusal(words::is_no_file(&named(path)))),
            Ok(_) | Err(_) => Ok(()),
        }
    }

    /// Takes away what may be replaced, for a file that is seen while it grows, and gives its place. A program that still reads
    /// the old one reads that to its end.
    ///
    /// # Errors
    /// As [`Self::refuse_present`] and [`Self::refuse_no_file`]; what is there stays.
    pub fn make_room(&self) -> Result<PathBuf, Refusal> {
        self.refuse_no_file()?;
        self.refuse_present()?;
        let path = self.path.unwrap_or(Path::new("-"));
        if path.symlink_metadata().is_err() {
            return Ok(path.to_owned());
        }
        // Behind a link is the file that is meant; one that leads nowhere is replaced itself.
        let place = settled(path);
        match fs::remove_file(&place) {
            Ok(()) => Ok(place),
            Err(error) => Err(self.refusal(words::unwritten(&named(path), error))),
        }
    }

    /// Refuses to replace other files that are read, and files that are written beside it.
    ///
    /// # Errors
    /// It is one of them.
    pub fn spare(&self, others: &[&Path]) -> Result<(), Refusal> {
        let Some(path) = self.file() else {
            return Ok(());
        };
        let own = settled(path);
        let is_used = |other: &&&Path| own == settled(other) || is_same(path, other);
        match others.iter().find(is_used) {
            Some(_) => Err(self.refusal(words::is_taken(&named(path)))),
            None => Ok(()),
        }
    }

    /// Writes it. A reader of standard output that has seen enough is no failure.
    ///
    /// # Errors
    /// As [`Self::refuse_present`], and what the system says.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Refusal> {
        self.refuse_present()?;
        let Some(path) = self.file() else {
            return standard(bytes);
        };
        let written = match fs::metadata(path) {
            // A device or a pipe takes bytes and cannot be replaced.
            Ok(there) if !there.is_file() => File::options()
                .write(true)
                .open(path)
                .and_then(|mut file| file.write_all(bytes)),
            Ok(there) => replace(path, Some(&there), bytes),
            Err(_) if self.force => replace(path, None, bytes),
            Err(_) => create(path, bytes),
        };
        written.map_err(|error| {
            let name = named(path);
            self.refusal(if error.kind() == io::ErrorKind::AlreadyExists {
                words::is_there(&name)
            } else if error.kind() == io::ErrorKind::NotFound {
                words::no_folder(&name)
            } else {
                words::unwritten(&name, error)
            })
        })
    }
}

/// Bytes to standard output.
pub(crate) fn standard(bytes: &[u8]) -> Result<(), Refusal> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Refusal::new(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// One name for a file that may not be there yet, however it was named: `./x` and `x` are the same.
pub(crate) fn settled(path: &Path) -> PathBuf {
    if let Ok(there) = path.canonicalize() {
        return there;
    }
    match (path.parent(), path.file_name()) {
        (Some(folder), Some(name)) if folder.as_os_str().is_empty() => {
            settled(Path::new(".")).join(name)
        }
        (Some(folder), Some(name)) => settled(folder).join(name),
        (None, _) | (_, None) => path.to_owned(),
    }
}

/// Whether two names are one file.
fn is_same(one: &Path, other: &Path) -> bool {
    let id = |path: &Path| fs::metadata(path).map(|file| (file.dev(), file.ino())).ok();
    id(one).is_some_and(|one| Some(one) == id(other))
}

/// A new file; what could not be finished is taken away again.
fn create(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    let written = file.write_all(bytes);
    if written.is_err() {
        let _ = fs::remove_file(path);
    }
    written
}

/// Puts a new file into the place of another at one stroke, with its rights.
pub(crate) fn replace(path: &Path, there: Option<&Metadata>, bytes: &[u8]) -> io::Result<()> {
    // Behind a link is the file that is meant.
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let mut fresh = path.clone().into_os_string();
    fresh.push(format!(".{}.new", std::process::id()));
    let fresh = PathBuf::from(fresh);
    create(&fresh, bytes)?;
    let rights = there.map_or(Ok(()), |there| {
        fs::set_permissions(&fresh, there.permissions())
    });
    let placed = rights.and_then(|()| fs::rename(&fresh, &path));
    if placed.is_err() {
        let _ = fs::remove_file(&fresh);
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is told of a place that is not given.
    fn told(path: &Path, force: bool) -> String {
        let refusal = Output::recording(path, force).make_room();
        refusal.expect_err("refused").lines.join("\n")
    }

    #[test]
    fn room_is_made_where_a_file_is_and_force_is_given() {
        let dir = tempfile::tempdir().expect("a directory");
        let path = dir.path().join("run.mcap");
        let made = |force| Output::recording(&path, force).make_room();
        assert_eq!(made(false).as_deref(), Ok(path.as_path()));
        fs::write(&path, "old").expect("a file");
        assert!(told(&path, false).contains("is there already: --force replaces it"));
        assert!(path.exists());
        let place = path.canonicalize().expect("a path");
        let link = dir.path().join("link");
        std::os::unix::fs::symlink(&path, &link).expect("a link");
        let behind = Output::recording(&link, true).make_room();
        assert_eq!(behind.as_deref(), Ok(place.as_path()));
        assert!(!path.exists() && link.is_symlink());
    }

    #[test]
    fn no_room_is_made_of_what_is_no_file() {
        let dir = tempfile::tempdir().expect("a directory");
        let (pipe, link) = (dir.path().join("pipe"), dir.path().join("link"));
        nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::S_IRWXU).expect("a pipe");
        // Such as /dev/stdout, behind which is no path at all.
        let (_read, write) = io::pipe().expect("a pipe");
        let number = std::os::fd::AsRawFd::as_raw_fd(&write);
        std::os::unix::fs::symlink(format!("/proc/self/fd/{number}"), &link).expect("a link");
        for path in [dir.path(), Path::new("/dev/null"), &pipe, &link] {
            for force in [false, true] {
                assert!(told(path, force).contains("is no file"), "{path:?}");
                assert!(path.symlink_metadata().is_ok(), "{path:?}");
            }
        }
        assert!(told(Path::new("-"), true).contains("standard output"));
    }
}
