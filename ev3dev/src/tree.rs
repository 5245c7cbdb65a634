//! Files of the tree: opened when they are needed, opened again after the tree was away.
//!
//! Owns the files that are kept open. Knows no class of ev3dev, and leaves what an errno of the tree means to `errno`.

use crate::errno;
use crate::limits::TREE_TEXT_BYTES_MAX;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use trikfs::errno::Error;

/// Where a tree is mounted.
#[derive(Clone, Debug)]
pub struct Tree {
    root: PathBuf,
}

impl Tree {
    /// The tree at this mount point, which need not be there yet.
    pub fn new(root: PathBuf) -> Self {
        Self { root }
    }

    /// Where it is.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// True if it is served: every tree has a `status`.
    pub fn is_there(&self) -> bool {
        self.root.join("status").metadata().is_ok()
    }

    /// A file of the tree.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// Opens a file for reading.
    ///
    /// # Errors
    /// As the tree has it; see [`errno::of_tree`].
    pub fn open(&self, name: &str) -> Result<TreeFile, Error> {
        TreeFile::new(File::open(self.path(name)), name)
    }

    /// Opens a file for writing.
    ///
    /// # Errors
    /// As the tree has it; see [`errno::of_tree`].
    pub fn open_to_write(&self, name: &str) -> Result<TreeFile, Error> {
        TreeFile::new(File::options().write(true).open(self.path(name)), name)
    }

    /// The text of a file.
    ///
    /// # Errors
    /// As the tree has it.
    pub fn text(&self, name: &str) -> Result<String, Error> {
        self.open(name)?.text()
    }

    /// Writes a text to a file that is closed afterwards.
    ///
    /// # Errors
    /// As the tree has it.
    pub fn write(&self, name: &str, text: &str) -> Result<(), Error> {
        self.open_to_write(name)?.write(text)
    }
}

/// An open file of the tree.
#[derive(Debug)]
pub struct TreeFile {
    file: File,
    name: String,
}

impl TreeFile {
    fn new(file: io::Result<File>, name: &str) -> Result<Self, Error> {
        match file {
            Ok(file) => Ok(Self {
                file,
                name: name.to_owned(),
            }),
            Err(error) => Err(errno::of_tree(&error, name)),
        }
    }

    /// The newest text, without the space around it.
    ///
    /// # Errors
    /// As the tree has it; text that is not UTF-8 is a failed device.
    pub fn text(&self) -> Result<String, Error> {
        let mut bytes = [0; TREE_TEXT_BYTES_MAX];
        let mut length = 0;
        while length < bytes.len() {
            match self.file.read_at(&mut bytes[length..], length as u64) {
                Ok(0) => break,
                Ok(count) => length += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(errno::of_tree(&error, &self.name)),
            }
        }
        match std::str::from_utf8(&bytes[..length]) {
            Ok(text) => Ok(text.trim().to_owned()),
            Err(_) => Err(errno::no_answer(format!("{}: not a text", self.name))),
        }
    }

    /// The newest numbers.
    ///
    /// # Errors
    /// As [`text`](Self::text); what is no number is a failed device.
    pub fn numbers(&self) -> Result<Vec<f64>, Error> {
        let text = self.text()?;
        let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite());
        let numbers: Option<Vec<f64>> = text.split_ascii_whitespace().map(number).collect();
        numbers
            .filter(|numbers| !numbers.is_empty())
            .ok_or_else(|| errno::no_answer(format!("{}: no numbers: {text:?}", self.name)))
    }

    /// The first of the newest numbers.
    ///
    /// # Errors
    /// As [`numbers`](Self::numbers).
    pub fn number(&self) -> Result<f64, Error> {
        self.numbers().map(|numbers| numbers[0])
    }

    /// Writes a text with one write(2).
    ///
    /// # Errors
    /// As the tree has it.
    pub fn write(&self, text: &str) -> Result<(), Error> {
        loop {
            return match self.file.write_at(text.as_bytes(), 0) {
                Ok(count) if count == text.len() => Ok(()),
                Ok(_) => Err(errno::no_answer(format!("{}: took only a part", self.name))),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => Err(errno::of_tree(&error, &self.name)),
            };
        }
    }
}

/// A file of the tree that is kept open and opened again when its node or the tree has changed.
#[derive(Debug)]
pub struct KeptFile {
    tree: Tree,
    name: String,
    file: Option<TreeFile>,
}

impl KeptFile {
    /// Nothing is opened yet.
    pub fn new(tree: Tree, name: String) -> Self {
        Self {
            tree,
            name,
            file: None,
        }
    }

    /// The newest numbers.
    ///
    /// # Errors
    /// As the tree has it.
    pub fn numbers(&mut self) -> Result<Vec<f64>, Error> {
        self.with(TreeFile::numbers)
    }

    /// The first of the newest numbers.
    ///
    /// # Errors
    /// As the tree has it.
    pub fn number(&mut self) -> Result<f64, Error> {
        self.with(TreeFile::number)
    }

    /// Closes it until the next use.
    pub fn close(&mut self) {
        self.file = None;
    }

    /// Uses the open file; if that is of a tree or node that is gone, opens it again, once.
    fn with<R>(&mut self, mut call: impl FnMut(&TreeFile) -> Result<R, Error>) -> Result<R, Error> {
        if let Some(file) = &self.file {
            match call(file) {
                Err(Error::NoDevice(_)) => self.file = None,
                result => return result,
            }
        }
        let file = self.tree.open(&self.name)?;
        let result = call(&file);
        if !matches!(result, Err(Error::NoDevice(_))) {
            self.file = Some(file);
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, Tree) {
        let folder = tempfile::tempdir().unwrap();
        let tree = Tree::new(folder.path().to_owned());
        (folder, tree)
    }

    #[test]
    fn numbers_are_read_and_rubbish_is_a_failed_device() {
        let (folder, tree) = folder();
        let root = folder.path();
        std::fs::write(root.join("value"), "1 -2.5\n").unwrap();
        assert_eq!(tree.open("value").unwrap().numbers(), Ok(vec![1.0, -2.5]));
        for rubbish in ["", "\n", "1 x", "nan", "inf"] {
            std::fs::write(root.join("value"), rubbish).unwrap();
            let error = tree.open("value").unwrap().numbers().unwrap_err();
            assert_eq!(error.errno(), libc::EIO, "{rubbish:?}");
        }
        std::fs::write(root.join("value"), [0xff, 0xfe]).unwrap();
        assert_eq!(tree.text("value").unwrap_err().errno(), libc::EIO);
    }

    #[test]
    fn a_file_that_is_not_there_is_a_device_that_is_not_there() {
        let (folder, tree) = folder();
        let root = folder.path();
        assert!(!tree.is_there());
        let error = tree.text("motors/M1/value").unwrap_err();
        assert_eq!(error.errno(), libc::ENODEV);
        assert!(
            error.to_string().starts_with("motors/M1/value: "),
            "{error}"
        );
        let mut kept = KeptFile::new(tree.clone(), "late".to_owned());
        assert_eq!(kept.number().unwrap_err().errno(), libc::ENODEV);
        std::fs::write(root.join("late"), "7").unwrap();
        assert_eq!(kept.number(), Ok(7.0));
    }
}
