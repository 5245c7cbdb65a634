//! The directory of a board: made, marked as ours, locked, and removed at the end.
//!
//! Nothing that somebody else made is touched: a directory is taken if it is new, empty, or left over by a board that
//! has ended.

use nix::fcntl::{Flock, FlockArg};
use std::fs::{DirBuilder, File};
use std::io::{self, ErrorKind};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

/// Says that a directory is a board's; locked while the board lives.
const MARK: &str = ".virtual-board";

/// The directory, for as long as this lives.
pub struct Root {
    path: PathBuf,
    was_there: bool,
    _lock: Flock<File>,
}

impl Root {
    /// Makes the directory or takes an empty one.
    pub fn take(path: &Path) -> io::Result<Self> {
        let was_there = match DirBuilder::new().mode(0o755).create(path) {
            Ok(()) => false,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => true,
            Err(error) => return Err(told(&error, path, "the directory cannot be made")),
        };
        let path = std::fs::canonicalize(path)?;
        let mark = path.join(MARK);
        if was_there && !mark.exists() && std::fs::read_dir(&path)?.next().is_some() {
            let reason = format!(
                "{}: is not empty and not the directory of a board; name a new or an empty one",
                path.display()
            );
            return Err(io::Error::new(ErrorKind::AlreadyExists, reason));
        }
        let file = File::options()
            .create(true)
            .truncate(false)
            .write(true)
            .mode(0o644)
            .custom_flags(libc::O_NOFOLLOW)
            .open(&mark)
            .map_err(|error| told(&error, &mark, "cannot be written"))?;
        let lock = Flock::lock(file, FlockArg::LockExclusiveNonblock).map_err(|_| {
            let reason = format!(
                "{}: another board runs here; name another directory or end that board",
                path.display()
            );
            io::Error::new(ErrorKind::ResourceBusy, reason)
        })?;
        let root = Self {
            path,
            was_there,
            _lock: lock,
        };
        root.clear()?;
        Ok(root)
    }

    /// The directory, without links.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes everything but the mark.
    fn clear(&self) -> io::Result<()> {
        for entry in std::fs::read_dir(&self.path)? {
            let entry = entry?;
            if entry.file_name() == MARK {
                continue;
            }
            if entry.file_type()?.is_dir() {
                std::fs::remove_dir_all(entry.path())?;
            } else {
                std::fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }
}

impl Drop for Root {
    fn drop(&mut self) {
        let _ = self.clear();
        let _ = std::fs::remove_file(self.path.join(MARK));
        if !self.was_there {
            let _ = std::fs::remove_dir(&self.path);
        }
    }
}

fn told(error: &io::Error, path: &Path, what: &str) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {what}: {error}", path.display()))
}
