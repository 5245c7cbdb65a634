//! Files of the mounted tree, each opened once and then read and written at its beginning.
//!
//! Owns the open files and the rule when one is opened again. Knows no ports and no units, and never links what serves
//! the tree: what can be read here, `cat` can read as well.

use crate::limits;
use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::{FileExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::{SystemTime, UNIX_EPOCH};

/// How a file is opened.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Access {
    /// For reading; waits at most as long as the tree itself waits for a first sample.
    Read,
    /// For reading without waiting: EAGAIN while there is no sample.
    ReadNow,
    /// For writing.
    Write,
}

/// A tree that is not mounted: its files are what somebody answers. Paths are relative to the root.
pub trait Answers: fmt::Debug {
    /// Whether this directory is there, and something is plugged in.
    fn has(&self, directory: &str) -> bool;

    /// Whether this file is there.
    fn is_file(&self, path: &str) -> bool;

    /// Names in a directory, sorted.
    fn names(&self, directory: &str) -> Vec<String>;

    /// The newest text.
    ///
    /// # Errors
    /// As a mounted tree would fail.
    fn read(&self, path: &str) -> io::Result<String>;

    /// Takes one text.
    ///
    /// # Errors
    /// As a mounted tree would fail.
    fn write(&self, path: &str, text: &str) -> io::Result<()>;

    /// Its time of day, in microseconds of the epoch.
    fn now_us(&self) -> u128;
}

/// One file of the tree.
#[derive(Debug)]
pub struct Node {
    path: PathBuf,
    access: Access,
    file: RefCell<Option<File>>,
    /// What answers instead of a file, and the path that it knows.
    answers: Option<(Rc<dyn Answers>, String)>,
}

/// The files of one tree that somebody has asked for.
#[derive(Debug)]
pub struct Tree {
    root: PathBuf,
    nodes: RefCell<HashMap<(String, Access), Rc<Node>>>,
    answers: Option<Rc<dyn Answers>>,
}

/// The file's server has died or was told to let go of it: another opening may help.
fn is_stale(error: &io::Error) -> bool {
    let stale = [
        libc::ENOTCONN,
        libc::ENODEV,
        libc::ESTALE,
        libc::ECONNABORTED,
    ];
    error
        .raw_os_error()
        .is_some_and(|code| stale.contains(&code))
}

/// A name of one directory entry, as ports have it.
pub fn is_name(text: &str) -> bool {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-';
    !text.is_empty() && text.len() <= limits::PORT_NAME_BYTES && text.bytes().all(plain)
}

impl Tree {
    /// The tree that is mounted, or will be mounted, at `root`.
    pub fn new(root: &Path) -> Self {
        Self {
            root: root.to_owned(),
            nodes: RefCell::default(),
            answers: None,
        }
    }

    /// A tree that is mounted nowhere.
    pub fn answered(answers: Rc<dyn Answers>) -> Self {
        Self {
            root: PathBuf::new(),
            nodes: RefCell::default(),
            answers: Some(answers),
        }
    }

    /// Where it is mounted.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The file at `path`, which is relative to the root; nothing is opened before it is used.
    pub fn node(&self, path: &str, access: Access) -> Rc<Node> {
        let mut nodes = self.nodes.borrow_mut();
        let made = nodes.entry((path.to_owned(), access)).or_insert_with(|| {
            Rc::new(Node {
                path: self.root.join(path),
                access,
                file: RefCell::default(),
                answers: self
                    .answers
                    .as_ref()
                    .map(|answers| (answers.clone(), path.to_owned())),
            })
        });
        made.clone()
    }

    /// Closes all files. The next use of each opens it again.
    pub fn close(&self) {
        for node in self.nodes.borrow().values() {
            *node.file.borrow_mut() = None;
        }
    }

    /// Whether the tree has this directory, and something is plugged in there.
    pub fn has(&self, directory: &str) -> bool {
        if let Some(answers) = &self.answers {
            return answers.has(directory);
        }
        let path = self.root.join(directory);
        path.is_dir()
            && File::open(path.join("value"))
                .err()
                .is_none_or(|error| error.raw_os_error() != Some(libc::ENODEV))
    }

    /// Whether the tree is mounted somewhere, or will be.
    pub fn is_mounted(&self) -> bool {
        self.answers.is_none()
    }

    /// Whether the tree has this file.
    pub fn is_file(&self, path: &str) -> bool {
        match &self.answers {
            Some(answers) => answers.is_file(path),
            None => self.root.join(path).is_file(),
        }
    }

    /// Whether the tree has this directory, whatever is plugged in there.
    pub fn is_directory(&self, path: &str) -> bool {
        match &self.answers {
            Some(answers) => answers.has(path),
            None => self.root.join(path).is_dir(),
        }
    }

    /// Names in a directory, sorted; empty if there is none.
    pub fn names(&self, directory: &str) -> Vec<String> {
        if let Some(answers) = &self.answers {
            return answers.names(directory);
        }
        let Ok(entries) = std::fs::read_dir(self.root.join(directory)) else {
            return Vec::new();
        };
        let names = entries
            .flatten()
            .filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    }
}

/// What the node at a path below the tree has now, as text; None if there is no such node, or it has nothing.
pub fn value(tree: &Path, path: &str) -> Option<String> {
    // A path does not lead out of the tree.
    let is_inside = |part: &str| !part.is_empty() && part != "." && part != "..";
    if !path.split('/').all(is_inside) {
        return None;
    }
    let mut how = OpenOptions::new();
    how.read(true).custom_flags(libc::O_NONBLOCK);
    let file = how.open(tree.join(path).join("value")).ok()?;
    let mut text = String::new();
    let most = limits::VALUE_BYTES as u64;
    file.take(most).read_to_string(&mut text).ok()?;
    (!text.trim().is_empty()).then_some(text)
}

/// The unit of the node at a path below the tree; empty if it has none.
pub fn unit(tree: &Path, path: &str) -> String {
    let mut text = String::new();
    let most = limits::VALUE_BYTES as u64;
    // One that cannot be read is none.
    if let Ok(file) = File::open(tree.join(path).join("units")) {
        let _ = file.take(most).read_to_string(&mut text);
    }
    text.trim().to_owned()
}

impl Node {
    /// Where the file is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn open(&self) -> io::Result<File> {
        let mut how = OpenOptions::new();
        match self.access {
            Access::Read => how.read(true),
            Access::ReadNow => how.read(true).custom_flags(libc::O_NONBLOCK),
            Access::Write => how.write(true),
        };
        how.open(&self.path)
    }

    fn with<T>(&self, mut work: impl FnMut(&File) -> io::Result<T>) -> io::Result<T> {
        let mut file = self.file.borrow_mut();
        if let Some(open) = &*file {
            match work(open) {
                Err(error) if is_stale(&error) => *file = None,
                done => return done,
            }
        }
        let done = work(file.insert(self.open()?));
        if done.as_ref().is_err_and(is_stale) {
            *file = None;
        }
        done
    }

    /// The newest bytes, as many as fit. One pread(2).
    ///
    /// # Errors
    /// Those of the tree: `fault` beside the file says more.
    pub fn bytes(&self, buffer: &mut [u8]) -> io::Result<usize> {
        if let Some((answers, path)) = &self.answers {
            let text = answers.read(path)?;
            let size = text.len().min(buffer.len());
            buffer[..size].copy_from_slice(&text.as_bytes()[..size]);
            return Ok(size);
        }
        self.with(|file| file.read_at(buffer, 0))
    }

    /// Bytes from a position on, for files in which it means something: only mounted trees have such.
    ///
    /// # Errors
    /// As [`Node::bytes`].
    pub fn bytes_at(&self, buffer: &mut [u8], position: u64) -> io::Result<usize> {
        self.mounted()?;
        self.with(|file| file.read_at(buffer, position))
    }

    /// The newest text without the newline.
    ///
    /// # Errors
    /// As [`Node::bytes`]; `InvalidData` if it is no UTF-8.
    pub fn text(&self) -> io::Result<String> {
        let mut buffer = [0; limits::VALUE_BYTES];
        let size = self.bytes(&mut buffer)?;
        let text = std::str::from_utf8(&buffer[..size]).map_err(io::Error::other)?;
        Ok(text.trim_end().to_owned())
    }

    /// The first number.
    ///
    /// # Errors
    /// As [`Node::bytes`]; `InvalidData` if there is none.
    pub fn number(&self) -> io::Result<f64> {
        let mut numbers = [0.0];
        match self.numbers(&mut numbers)? {
            0 => Err(io::ErrorKind::InvalidData.into()),
            _ => Ok(numbers[0]),
        }
    }

    /// The numbers of one sample, as many as fit; returns how many there are.
    ///
    /// # Errors
    /// As [`Node::bytes`]; `InvalidData` for text that is no number.
    pub fn numbers(&self, numbers: &mut [f64]) -> io::Result<usize> {
        let mut buffer = [0; limits::VALUE_BYTES];
        let size = self.bytes(&mut buffer)?;
        let invalid = || io::Error::from(io::ErrorKind::InvalidData);
        let text = std::str::from_utf8(&buffer[..size]).map_err(|_| invalid())?;
        let mut count = 0;
        for (word, number) in text.split_ascii_whitespace().zip(numbers) {
            *number = word.parse().map_err(|_| invalid())?;
            count += 1;
        }
        Ok(count)
    }

    /// Writes one text. One pwrite(2).
    ///
    /// # Errors
    /// Those of the tree.
    pub fn write(&self, text: &str) -> io::Result<()> {
        if let Some((answers, path)) = &self.answers {
            return answers.write(path, text);
        }
        self.write_at(text.as_bytes(), 0)
    }

    fn mounted(&self) -> io::Result<()> {
        match self.answers {
            Some(_) => Err(io::ErrorKind::Unsupported.into()),
            None => Ok(()),
        }
    }

    /// Writes bytes at a position, as [`Node::bytes_at`] reads them.
    ///
    /// # Errors
    /// As [`Node::write`].
    pub fn write_at(&self, bytes: &[u8], position: u64) -> io::Result<()> {
        self.mounted()?;
        let written = self.with(|file| file.write_at(bytes, position))?;
        if written == bytes.len() {
            Ok(())
        } else {
            Err(io::ErrorKind::WriteZero.into())
        }
    }

    /// The time of day of the reader of the tree, in microseconds of the epoch.
    pub fn now_us(&self) -> u128 {
        match &self.answers {
            Some((answers, _)) => answers.now_us(),
            None => SystemTime::now()
                .duration_since(UNIX_EPOCH)
                .map_or(0, |time| time.as_micros()),
        }
    }

    /// Closes the file. An actuator that was written keeps what was written.
    pub fn close(&self) {
        *self.file.borrow_mut() = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::put;
    use tempfile::tempdir;

    #[test]
    fn numbers_come_fresh_from_a_file_that_stays_open() {
        let scratch = tempdir().unwrap();
        let file = put(scratch.path(), "g/n/value", "1 -2.5 3\n");
        let tree = Tree::new(scratch.path());
        let node = tree.node("g/n/value", Access::Read);
        let mut numbers = [0.0; 8];
        assert_eq!(node.numbers(&mut numbers).unwrap(), 3);
        assert_eq!(numbers[..3], [1.0, -2.5, 3.0]);
        std::fs::write(file, "7\n").unwrap();
        assert_eq!(node.number().unwrap(), 7.0);
        assert!(Rc::ptr_eq(&node, &tree.node("g/n/value", Access::Read)));
        assert!(tree.has("g/n") && !tree.has("g/m"));
        assert_eq!(tree.names("g"), ["n"]);
    }

    #[test]
    fn what_is_no_number_is_an_error_and_no_zero() {
        let scratch = tempdir().unwrap();
        put(scratch.path(), "value", "fast\n");
        put(scratch.path(), "empty", "");
        let tree = Tree::new(scratch.path());
        assert!(tree.node("value", Access::Read).number().is_err());
        assert!(tree.node("empty", Access::Read).number().is_err());
        assert!(tree.node("none", Access::Read).number().is_err());
    }

    #[test]
    fn a_port_is_one_plain_name() {
        assert!(is_name("A1") && is_name("left-wheel_2"));
        for bad in ["", ".", "..", "a/b", "a b", "\u{e9}", &"x".repeat(100)] {
            assert!(!is_name(bad), "{bad}");
        }
    }
}
