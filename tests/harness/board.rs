//! A scratch folder that plays the board: regular files, named pipes and libraries instead of devices.
//!
//! Owns the folder: unique, removed with the board, never while something is mounted in it. Folders that earlier
//! runs left behind (they were killed) are unmounted and removed when the first board is made.

use crate::processes;
use nix::mount::{MntFlags, umount2};
use nix::sys::stat::Mode;
use std::fs::{self, File, OpenOptions};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Once;
use std::sync::atomic::{AtomicU32, Ordering};

const PREFIX: &str = "trikfs-it-";
static NUMBER: AtomicU32 = AtomicU32::new(0);
static SWEEP: Once = Once::new();

/// The folder.
pub struct Board {
    dir: PathBuf,
}

impl Board {
    /// An empty folder of its own, open to other users for looking.
    pub fn new() -> Self {
        SWEEP.call_once(sweep);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let dir = std::env::temp_dir().join(format!("{PREFIX}{}-{number}", std::process::id()));
        let made = fs::DirBuilder::new().mode(0o755).create(&dir);
        made.unwrap_or_else(|error| panic!("{}: {error}", dir.display()));
        Self { dir }
    }

    /// The folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// `text` with `$DIR` replaced by the folder.
    pub fn fill_in(&self, text: &str) -> String {
        text.replace("$DIR", self.dir.to_str().expect("a UTF-8 scratch folder"))
    }

    /// Makes a regular file; `$DIR` is not replaced.
    pub fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        path
    }

    /// Content of a file.
    pub fn content(&self, name: &str) -> Vec<u8> {
        let path = self.path(name);
        fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// Makes a named pipe.
    pub fn fifo(&self, name: &str) -> PathBuf {
        let path = self.path(name);
        nix::unistd::mkfifo(&path, Mode::S_IRUSR | Mode::S_IWUSR).expect("a named pipe");
        path
    }

    /// Makes a named pipe and opens it so that it has a writer until this is dropped, and reading does not wait.
    pub fn pipe(&self, name: &str) -> File {
        self.fifo(name);
        self.feed(name)
    }

    /// Opens a named pipe again; see [`Board::pipe`].
    pub fn feed(&self, name: &str) -> File {
        let mut how = OpenOptions::new();
        how.read(true).write(true).custom_flags(libc::O_NONBLOCK);
        how.open(self.path(name)).expect("the named pipe")
    }

    /// Compiles C source into a shared library of this name.
    pub fn library(&self, name: &str, code: &str) -> PathBuf {
        let source = self.file(&format!("{name}.c"), code);
        let path = self.path(name);
        let fresh = self.path(&format!("{name}.new"));
        let include = concat!(env!("CARGO_MANIFEST_DIR"), "/../converter/include");
        let done = Command::new(crate::tools::c_compiler())
            .args(["-shared", "-fPIC", "-O1", "-I", include, "-o"])
            .arg(&fresh)
            .arg(source)
            .output();
        let done = done.expect("cc runs");
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        fs::rename(fresh, &path).expect("the library");
        path
    }
}

impl Default for Board {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        remove(&self.dir);
    }
}

/// Removes a folder unless something is mounted below it that does not go away.
fn remove(dir: &Path) {
    for mountpoint in mounts_below(dir) {
        let _ = umount2(&mountpoint, MntFlags::MNT_DETACH);
    }
    if mounts_below(dir).is_empty() {
        let _ = fs::remove_dir_all(dir);
    }
}

/// Mount points below a folder, the innermost last. Names of scratch folders need no unescaping.
pub fn mounts_below(dir: &Path) -> Vec<PathBuf> {
    let list = fs::read_to_string("/proc/self/mountinfo").unwrap_or_default();
    let points = list
        .lines()
        .filter_map(|line| line.split(' ').nth(4))
        .map(PathBuf::from);
    points.filter(|point| point.starts_with(dir)).collect()
}

/// Cleans up after runs whose process is gone.
fn sweep() {
    let Ok(entries) = fs::read_dir(std::env::temp_dir()) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let owner = name.to_str().and_then(|name| {
            name.strip_prefix(PREFIX)?
                .split('-')
                .next()?
                .parse::<u32>()
                .ok()
        });
        if owner.is_some_and(|pid| !processes::is_alive(pid)) {
            remove(&entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};

    #[test]
    fn boards_do_not_share_a_folder_and_leave_none_behind() {
        let (one, other) = (Board::new(), Board::new());
        assert_ne!(one.dir(), other.dir());
        let dir = one.dir().to_owned();
        one.file("a", "b");
        drop(one);
        assert!(!dir.exists());
    }

    #[test]
    fn a_pipe_takes_bytes_without_waiting_for_a_reader() {
        let board = Board::new();
        let mut pipe = board.pipe("p");
        pipe.write_all(b"xy").unwrap();
        let mut got = [0; 2];
        board.feed("p").read_exact(&mut got).unwrap();
        assert_eq!(&got, b"xy");
        assert_eq!(
            board.fill_in("$DIR/p"),
            board.path("p").display().to_string()
        );
    }
}
