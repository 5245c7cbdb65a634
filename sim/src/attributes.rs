//! Plain files instead of sysfs attributes, and the news when one is written.
//!
//! Owns files, their watches (inotify) and the reading of short texts; what a text means is for others.
//! A file is no attribute: it keeps what was there after a shorter text, so only the first line counts, and a writer
//! that does not truncate has to end its line.

use crate::limits::MAX_TEXT_BYTES;
use nix::sys::inotify::{AddWatchFlags, InitFlags, Inotify, WatchDescriptor};
use std::collections::{BTreeSet, HashMap};
use std::fs::File;
use std::io::{self, Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

/// The files below one directory.
pub struct Attributes {
    root: PathBuf,
    inotify: Inotify,
    folders: HashMap<WatchDescriptor, String>,
    /// Files that are watched by themselves.
    files: HashMap<WatchDescriptor, String>,
}

impl Attributes {
    /// No files yet.
    pub fn new(root: &Path) -> io::Result<Self> {
        let flags = InitFlags::IN_CLOEXEC | InitFlags::IN_NONBLOCK;
        Ok(Self {
            root: root.to_owned(),
            inotify: Inotify::init(flags)?,
            folders: HashMap::new(),
            files: HashMap::new(),
        })
    }

    /// The directory above all.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Makes a watched directory.
    pub fn folder(&mut self, name: &str) -> io::Result<()> {
        let flags = AddWatchFlags::IN_MODIFY
            | AddWatchFlags::IN_CLOSE_WRITE
            | AddWatchFlags::IN_MOVED_FROM
            | AddWatchFlags::IN_MOVED_TO
            | AddWatchFlags::IN_DELETE
            | AddWatchFlags::IN_DELETE_SELF
            | AddWatchFlags::IN_MOVE_SELF;
        self.watched(name, flags)
    }

    /// Makes a directory for FIFOs: here it is news that a reader has left.
    pub fn device_folder(&mut self, name: &str) -> io::Result<()> {
        self.watched(name, AddWatchFlags::IN_CLOSE_NOWRITE)
    }

    fn watched(&mut self, name: &str, flags: AddWatchFlags) -> io::Result<()> {
        let path = self.root.join(name);
        std::fs::create_dir_all(&path)?;
        let watch = self.inotify.add_watch(&path, flags)?;
        self.folders.insert(watch, name.to_owned());
        Ok(())
    }

    /// Watches one file that is there, and not its neighbours.
    pub fn file(&mut self, name: &str) -> io::Result<()> {
        let path = self.root.join(name);
        let watch = self.inotify.add_watch(&path, AddWatchFlags::IN_MODIFY)?;
        self.files.insert(watch, name.to_owned());
        Ok(())
    }

    /// Makes an attribute with its first text, in a watched directory.
    pub fn make(&mut self, name: &str, text: &str) -> io::Result<()> {
        if let Some((folder, _)) = name.rsplit_once('/')
            && !self.folders.values().any(|other| other == folder)
        {
            self.folder(folder)?;
        }
        self.appear(name, text)
    }

    /// Makes or replaces a file in one moment: who sees it sees its text.
    pub fn appear(&self, name: &str, text: &str) -> io::Result<()> {
        appear(&self.root, name, text)
    }

    /// Writes a text, with the newline that attributes have. Its first line is whole at any moment.
    pub fn write(&self, name: &str, text: &str) -> io::Result<()> {
        let line = format!("{text}\n");
        let mut file = File::options().write(true).open(self.root.join(name))?;
        file.write_all(line.as_bytes())?;
        file.set_len(line.len() as u64)
    }

    /// Removes a file, if it is there.
    pub fn remove(&self, name: &str) {
        let _ = std::fs::remove_file(self.root.join(name));
    }

    /// The text of a file; nothing if there is none or if it is no plain short text.
    pub fn text(&self, name: &str) -> Option<String> {
        let file = File::options()
            .read(true)
            .custom_flags(libc::O_NONBLOCK | libc::O_NOFOLLOW)
            .open(self.root.join(name))
            .ok()?;
        if !file.metadata().ok()?.is_file() {
            return None;
        }
        let mut text = String::new();
        file.take(MAX_TEXT_BYTES as u64)
            .read_to_string(&mut text)
            .ok()?;
        Some(text)
    }

    /// The first line of a file, if there is something in it.
    pub fn line(&self, name: &str) -> Option<String> {
        let text = self.text(name)?;
        let line = text.lines().next()?.trim();
        (!line.is_empty()).then(|| line.to_owned())
    }

    /// To wait for.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.inotify.as_fd()
    }

    /// Which files were written, made or removed since the last call, each once. A watched folder that somebody removed
    /// or moved away is made again, and its own name stands for all that may have been in it.
    pub fn changed(&mut self) -> BTreeSet<String> {
        let mut names = BTreeSet::new();
        let Ok(events) = self.inotify.read_events() else {
            return names;
        };
        for event in events {
            let is_gone = AddWatchFlags::IN_DELETE_SELF | AddWatchFlags::IN_MOVE_SELF;
            if event.mask.intersects(is_gone) {
                if let Some(folder) = self.folders.remove(&event.wd) {
                    let _ = self.inotify.rm_watch(event.wd);
                    // Where it cannot be made again, nobody can write to it either.
                    let _ = self.folder(&folder);
                    names.extend(self.names(&folder));
                    names.insert(folder);
                }
                continue;
            }
            names.extend(self.files.get(&event.wd).cloned());
            if event.mask.contains(AddWatchFlags::IN_Q_OVERFLOW) {
                // Something was lost: everything may have changed.
                names.extend(self.files.values().cloned());
                names.extend(self.folders.values().flat_map(|folder| self.names(folder)));
            }
            if let (Some(folder), Some(name)) = (self.folders.get(&event.wd), event.name)
                && let Some(name) = name.to_str()
            {
                names.insert(format!("{folder}/{name}"));
            }
        }
        names
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.root.join(folder));
        let names = entries.into_iter().flatten().flatten().take(1000);
        names
            .filter_map(|entry| {
                let name = entry.file_name().into_string().ok()?;
                Some(format!("{folder}/{name}"))
            })
            .collect()
    }
}

/// Makes or replaces a file below `root` in one moment: who sees it sees its text.
pub fn appear(root: &Path, name: &str, text: &str) -> io::Result<()> {
    let fresh = root.join(".fresh");
    std::fs::write(&fresh, format!("{text}\n"))?;
    std::fs::rename(fresh, root.join(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn a_written_attribute_is_news_once() {
        let scratch = tempdir().unwrap();
        let mut attributes = Attributes::new(scratch.path()).unwrap();
        attributes.make("class/led/brightness", "0").unwrap();
        attributes.changed();
        assert!(attributes.changed().is_empty());
        std::fs::write(scratch.path().join("class/led/brightness"), "1").unwrap();
        let names = attributes.changed();
        assert_eq!(names.iter().collect::<Vec<_>>(), ["class/led/brightness"]);
        assert_eq!(attributes.line("class/led/brightness").unwrap(), "1");
        std::fs::remove_file(scratch.path().join("class/led/brightness")).unwrap();
        assert_eq!(attributes.changed().len(), 1);
        assert_eq!(attributes.line("class/led/brightness"), None);
    }

    #[test]
    fn what_is_no_short_text_is_no_text() {
        let scratch = tempdir().unwrap();
        let attributes = Attributes::new(scratch.path()).unwrap();
        std::fs::create_dir(scratch.path().join("folder")).unwrap();
        std::fs::write(scratch.path().join("bytes"), [0xFF, 0xFE]).unwrap();
        std::fs::write(scratch.path().join("empty"), "\n").unwrap();
        std::os::unix::fs::symlink("/proc/self/status", scratch.path().join("link")).unwrap();
        for name in ["folder", "bytes", "empty", "link", "missing"] {
            assert_eq!(attributes.line(name), None, "{name}");
        }
    }

    #[test]
    fn a_folder_that_is_removed_or_moved_is_there_again_and_watched() {
        let scratch = tempdir().unwrap();
        let mut attributes = Attributes::new(scratch.path()).unwrap();
        attributes.folder("faults").unwrap();
        let (folder, aside) = (scratch.path().join("faults"), scratch.path().join("aside"));
        for removed in [true, false] {
            if removed {
                std::fs::remove_dir(&folder).unwrap();
            } else {
                std::fs::rename(&folder, &aside).unwrap();
            }
            assert!(attributes.changed().contains("faults"));
            std::fs::write(folder.join("A1"), "stuck").unwrap();
            assert!(attributes.changed().contains("faults/A1"));
            std::fs::remove_file(folder.join("A1")).unwrap();
            attributes.changed();
        }
        std::fs::write(aside.join("A1"), "stuck").unwrap();
        assert!(
            attributes.changed().is_empty(),
            "that one is somebody else's now"
        );
    }
}
