//! Programs of the robot: which there are, what is in them, their names and their end.
//!
//! Owns the folder of programs, but for what is written there: that goes over the control port.

use crate::error::Error;
use crate::limits;
use rustix::fs::{
    AtFlags, FileType, Mode, OFlags, RenameFlags, open, openat, renameat_with, statat, unlinkat,
};
use serde_json::{Value, json};
use std::fs;
use std::io::Read;
use std::os::fd::OwnedFd;
use std::path::Path;
use std::time::UNIX_EPOCH;

/// All programs, as JSON: `name`, `bytes`, `changed_s` since 1970; the names in order.
pub fn list(folder: &Path) -> Value {
    let mut found = Vec::new();
    let mut folders = vec![(folder.to_owned(), 0)];
    while let Some((at, depth)) = folders.pop() {
        for entry in fs::read_dir(&at).into_iter().flatten().flatten() {
            let path = entry.path();
            // A link may lead anywhere.
            let Ok(facts) = entry.metadata() else {
                continue;
            };
            let Some(name) = path.strip_prefix(folder).ok().and_then(Path::to_str) else {
                continue;
            };
            let is_hidden = entry.file_name().as_encoded_bytes().first() == Some(&b'.');
            if facts.is_dir() && depth < limits::FOLDERS_MAX && !is_hidden {
                folders.push((path, depth + 1));
            } else if facts.is_file() && !is_hidden && found.len() < limits::PROGRAMS_MAX {
                let changed = facts.modified().ok();
                let since = changed.and_then(|at| at.duration_since(UNIX_EPOCH).ok());
                let changed_s = since.map(|since| since.as_secs());
                found.push((name.to_owned(), facts.len(), changed_s));
            }
        }
    }
    found.sort();
    let row =
        |(name, bytes, changed_s)| json!({"name": name, "bytes": bytes, "changed_s": changed_s});
    found.into_iter().map(row).collect()
}

/// The bytes of a program.
///
/// # Errors
/// There is no such program, it is none, or it is too large to be shown.
pub fn read(folder: &Path, name: &str) -> Result<Vec<u8>, Error> {
    let file = open_program(folder, name)?;
    let failed = |error| Error::File(name.to_owned(), error);
    let most = limits::PROGRAM_BYTES_MAX;
    let size = file.metadata().map_err(failed)?.len();
    let mut bytes = Vec::new();
    let limit = most as u64 + 1;
    file.take(limit).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() > most {
        return Err(Error::Large(name.to_owned(), size.max(limit), most));
    }
    Ok(bytes)
}

/// A program as a text.
///
/// # Errors
/// There is no such program, it is no text, or it is too long to be edited.
pub fn text(folder: &Path, name: &str) -> Result<String, Error> {
    let failed = |error| Error::File(name.to_owned(), error);
    let mut file = open_program(folder, name)?;
    let size = file.metadata().map_err(failed)?.len();
    let most = limits::EDITED_BYTES_MAX;
    let mut bytes = Vec::new();
    let limit = most as u64 + 1;
    (&mut file)
        .take(limit)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() > most {
        return Err(Error::Large(name.to_owned(), size.max(limit), most));
    }
    String::from_utf8(bytes).map_err(|_| Error::Text(name.to_owned()))
}

/// Takes a program away, and the folders that have nothing more in them. One that runs goes on: it has been read.
///
/// # Errors
/// There is no such program, or the folder cannot be changed.
pub fn remove(folder: &Path, name: &str) -> Result<(), Error> {
    let (place, file) = Place::of_program(folder, name)?;
    unlinkat(place.folder(), file, AtFlags::empty()).map_err(|error| failed(name, error))?;
    place.tidy();
    Ok(())
}

/// Gives a program another name, in any folder that there is. Nothing is replaced.
///
/// # Errors
/// There is no such program, the new name is taken or none for a program, or the folder cannot be changed.
pub fn rename(folder: &Path, name: &str, to: &str) -> Result<(), Error> {
    let (place, file) = Place::of_program(folder, name)?;
    let is_strange = |c: char| c.is_control() || matches!(c, ':' | '\\');
    let is_name = to.len() <= limits::NAME_BYTES_MAX && !to.contains(is_strange);
    let no_name = || Error::NewName(to.to_owned());
    let target = is_name.then(|| Place::find(folder, to)).flatten();
    let (target, new) = target.ok_or_else(no_name)?;
    renameat_with(
        place.folder(),
        file,
        target.folder(),
        new,
        RenameFlags::NOREPLACE,
    )
    .map_err(|error| failed(to, error))?;
    place.tidy();
    Ok(())
}

fn open_program(folder: &Path, name: &str) -> Result<fs::File, Error> {
    let (place, file) = Place::of_program(folder, name)?;
    // Nothing waits for the other end of a FIFO that has come meanwhile.
    let opens = OFlags::RDONLY | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let opened = openat(place.folder(), file, opens, Mode::empty());
    opened
        .map(fs::File::from)
        .map_err(|error| failed(name, error))
}

fn failed(name: &str, error: rustix::io::Errno) -> Error {
    Error::File(name.to_owned(), error.into())
}

/// Where a program is: the folder of programs and those below it, each opened from the one above. No link is followed, and none
/// can be put there meanwhile: the folder may belong to a user who writes programs, and this may be root.
struct Place<'a> {
    folders: Vec<OwnedFd>,
    /// The names of all but the first.
    names: Vec<&'a str>,
}

impl<'a> Place<'a> {
    /// The folder that a program of this name is in, and the last part of the name; None if there is no such folder, or the
    /// name leads elsewhere.
    fn find(folder: &Path, name: &'a str) -> Option<(Self, &'a str)> {
        let is_plain =
            |part: &&str| !part.trim().is_empty() && !part.starts_with('.') && !part.contains('\0');
        let mut names: Vec<&str> = name.split('/').collect();
        if !names.iter().all(is_plain) || names.len() > limits::FOLDERS_MAX + 1 {
            return None;
        }
        let file = names.pop()?;
        let opens = OFlags::PATH | OFlags::DIRECTORY | OFlags::CLOEXEC;
        let mut folders = vec![open(folder, opens, Mode::empty()).ok()?];
        for part in &names {
            let above = folders.last()?;
            let below = openat(above, *part, opens | OFlags::NOFOLLOW, Mode::empty());
            folders.push(below.ok()?);
        }
        Some((Self { folders, names }, file))
    }

    /// The same for a program that is there.
    fn of_program(folder: &Path, name: &'a str) -> Result<(Self, &'a str), Error> {
        let found = Self::find(folder, name).filter(|(place, file)| {
            let facts = statat(place.folder(), *file, AtFlags::SYMLINK_NOFOLLOW);
            facts.is_ok_and(|facts| FileType::from_raw_mode(facts.st_mode) == FileType::RegularFile)
        });
        found.ok_or_else(|| Error::Name(name.to_owned()))
    }

    /// The folder that the program is in.
    fn folder(&self) -> &OwnedFd {
        self.folders.last().unwrap_or(&self.folders[0])
    }

    /// Takes away folders in which there is nothing more, from the innermost on.
    fn tidy(&self) {
        for (above, name) in self.folders.iter().zip(&self.names).rev() {
            // One that has something in it stays, and so do those above it.
            if unlinkat(above, *name, AtFlags::REMOVEDIR).is_err() {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_are_listed_and_none_is_outside() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("programs");
        fs::create_dir_all(folder.join("sub")).unwrap();
        fs::write(folder.join("b.js"), "print(1)").unwrap();
        fs::write(folder.join("sub/a.py"), "").unwrap();
        fs::write(folder.join(".hidden"), "").unwrap();
        fs::write(home.path().join("secret"), "x").unwrap();
        std::os::unix::fs::symlink(home.path().join("secret"), folder.join("link")).unwrap();
        let list = list(&folder);
        let names: Vec<_> = list
            .as_array()
            .unwrap()
            .iter()
            .map(|one| &one["name"])
            .collect();
        assert_eq!(names, ["b.js", "sub/a.py"]);
        assert_eq!(read(&folder, "b.js").unwrap(), b"print(1)");
        for bad in [
            "",
            "link",
            "../secret",
            "sub",
            "sub/../b.js",
            "/etc/passwd",
            "none",
            "b.js\0",
        ] {
            assert!(read(&folder, bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn programs_are_renamed_and_removed_and_nothing_else_is() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("programs");
        fs::create_dir_all(folder.join("sub")).unwrap();
        fs::write(folder.join("a.js"), "a").unwrap();
        fs::write(folder.join("sub/b.py"), "b").unwrap();
        fs::write(home.path().join("secret"), "x").unwrap();
        std::os::unix::fs::symlink(home.path(), folder.join("out")).unwrap();
        rename(&folder, "a.js", "sub/c.js").unwrap();
        assert!(matches!(
            rename(&folder, "sub/c.js", "sub/b.py"),
            Err(Error::File(..))
        ));
        assert_eq!(read(&folder, "sub/b.py").unwrap(), b"b");
        for to in [
            "../x",
            ".x",
            "sub/.x",
            "none/x",
            "out/x",
            "a:b",
            "a\\b",
            "a\nb",
            "",
            "/x",
            "sub/",
            &"x".repeat(limits::NAME_BYTES_MAX + 1),
        ] {
            assert!(
                matches!(rename(&folder, "sub/c.js", to), Err(Error::NewName(_))),
                "{to}"
            );
        }
        fs::write(folder.join(".hidden"), "").unwrap();
        std::os::unix::fs::symlink(home.path().join("secret"), folder.join("link")).unwrap();
        for name in [
            "../secret",
            "out/secret",
            "link",
            ".hidden",
            "sub",
            "none",
            "sub/",
            "",
        ] {
            assert!(
                matches!(rename(&folder, name, "x"), Err(Error::Name(_))),
                "{name}"
            );
            assert!(
                matches!(remove(&folder, name), Err(Error::Name(_))),
                "{name}"
            );
        }
        remove(&folder, "sub/b.py").unwrap();
        assert!(folder.join("sub/c.js").exists());
        remove(&folder, "sub/c.js").unwrap();
        assert!(!folder.join("sub").exists(), "an empty folder goes");
        assert!(home.path().join("secret").exists());
    }

    #[test]
    fn what_is_edited_is_a_text_that_is_not_too_long() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path();
        let most = limits::EDITED_BYTES_MAX;
        fs::write(folder.join("whole.py"), "x".repeat(most)).unwrap();
        fs::write(folder.join("long.py"), "x".repeat(most + 1)).unwrap();
        fs::write(folder.join("bytes.py"), [0xff, 0xfe]).unwrap();
        assert_eq!(text(folder, "whole.py").unwrap().len(), most);
        assert!(matches!(text(folder, "long.py"), Err(Error::Large(..))));
        assert!(matches!(text(folder, "bytes.py"), Err(Error::Text(_))));
        assert!(matches!(text(folder, "../x"), Err(Error::Name(_))));
    }
}
