//! The folder of programs: which names are taken, and files that are replaced whole or not at all.
//!
//! Knows nothing of requests and languages.

use crate::limits;
use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::{self, Write};
use std::os::fd::AsRawFd;
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

static NUMBER: AtomicU32 = AtomicU32::new(0);

/// The path of a program below the folder.
///
/// # Errors
/// In words: the name is not UTF-8, empty, too long, absolute, leads out of the folder or is hidden.
pub fn locate(folder: &Path, name: &[u8]) -> Result<PathBuf, String> {
    let shown = crate::log::printable(&String::from_utf8_lossy(name));
    let refused = |why: &str| Err(format!("'{shown}' cannot be the name of a program: {why}"));
    let Ok(name) = std::str::from_utf8(name) else {
        return refused("it is not UTF-8");
    };
    if name.is_empty() {
        return refused("it is empty");
    }
    if name.len() > limits::NAME_BYTES {
        return refused("it is too long");
    }
    if name.chars().any(char::is_control) {
        return refused("it has control characters");
    }
    let path = Path::new(name);
    for (depth, component) in path.components().enumerate() {
        match component {
            Component::Normal(_) if depth >= limits::NAME_DEPTH => {
                return refused("it has too many folders");
            }
            Component::Normal(part) if part.as_encoded_bytes().starts_with(b".") => {
                return refused("a part of it begins with a dot");
            }
            Component::Normal(_) => {}
            Component::CurDir => return refused("it has '.' in it"),
            Component::ParentDir => return refused("it leads out of the folder of programs"),
            Component::RootDir | Component::Prefix(_) => return refused("it is absolute"),
        }
    }
    if name.ends_with('/') {
        return refused("it is a folder");
    }
    Ok(folder.join(path))
}

/// Whether nothing on the way from the folder to the file is a link, which could lead out of it.
fn is_inside(folder: &Path, path: &Path) -> bool {
    let mut place = folder.to_owned();
    let Ok(rest) = path.strip_prefix(folder) else {
        return false;
    };
    rest.components().all(|part| {
        place.push(part);
        fs::symlink_metadata(&place).is_ok_and(|data| !data.is_symlink())
    })
}

/// Keeps an upload: makes the folders that its name has, then replaces the file whole.
///
/// # Errors
/// In words, with the name and what to do.
pub fn keep(folder: &Path, name: &[u8], content: &[u8]) -> Result<PathBuf, String> {
    let path = locate(folder, name)?;
    let shown = String::from_utf8_lossy(name);
    let refused = |why: &str| Err(format!("'{shown}' was not kept: {why}"));
    let fails = |error: io::Error| {
        let hint = match error.raw_os_error() {
            Some(libc::ENOSPC | libc::EDQUOT) => {
                "; the disk is full: delete something on the robot"
            }
            Some(libc::EROFS) => "; the disk is read-only",
            _ => "",
        };
        format!("'{shown}' was not kept: {error}{hint}")
    };
    let parent = path.parent().unwrap_or(folder);
    let Some(place) = enter(folder, parent).map_err(fails)? else {
        return refused("a folder in it is a link");
    };
    let last = inside(&place).join(path.file_name().unwrap_or_default());
    if fs::symlink_metadata(&last).is_ok_and(|found| found.is_dir()) {
        return refused("there is a folder of this name");
    }
    let mode = if is_executable(content) { 0o755 } else { 0o644 };
    replace(&last, content, mode).map_err(fails)?;
    Ok(path)
}

/// Names in an open folder, wherever it is and whatever has happened to its path meanwhile.
fn inside(place: &File) -> PathBuf {
    Path::new("/proc/self/fd").join(place.as_raw_fd().to_string())
}

/// Opens a folder below another one step by step, and makes what is missing. None: a step is a link. Programs may
/// write here, so a step that is seen to be a folder could be a link a moment later; one that is open cannot.
fn enter(folder: &Path, parent: &Path) -> io::Result<Option<File>> {
    let make = |path: &Path| match DirBuilder::new().mode(0o755).create(path) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => Err(error),
        _ => Ok(()),
    };
    DirBuilder::new()
        .recursive(true)
        .mode(0o755)
        .create(folder)?;
    let mut place = File::open(folder)?;
    for part in parent.strip_prefix(folder).unwrap_or(Path::new("")) {
        let next = inside(&place).join(part);
        make(&next)?;
        let opened = OpenOptions::new()
            .read(true)
            .custom_flags(libc::O_NOFOLLOW | libc::O_DIRECTORY)
            .open(&next);
        place = match opened {
            Err(_) if fs::symlink_metadata(&next).is_ok_and(|found| found.is_symlink()) => {
                return Ok(None);
            }
            opened => opened?,
        };
    }
    Ok(Some(place))
}

/// Whether content says by itself that it can be executed.
pub fn is_executable(content: &[u8]) -> bool {
    content.starts_with(b"\x7fELF") || content.starts_with(b"#!")
}

/// The program of this name, if it is there.
///
/// # Errors
/// In words.
pub fn find(folder: &Path, name: &[u8]) -> Result<PathBuf, String> {
    let path = locate(folder, name)?;
    let shown = String::from_utf8_lossy(name);
    if !path.is_file() {
        return Err(format!(
            "there is no program '{shown}' in {}: upload it first",
            folder.display()
        ));
    }
    if !is_inside(folder, &path) {
        return Err(format!(
            "'{shown}' is a link: only programs in {} are run",
            folder.display()
        ));
    }
    Ok(path)
}

/// Replaces a file: whoever reads it finds the old content or the new one, also after a power cut.
///
/// # Errors
/// Those of the file system; the old file is as it was.
pub fn replace(path: &Path, content: &[u8], mode: u32) -> io::Result<()> {
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    let name = format!(".trikd-{}-{number}", std::process::id());
    let fresh = path.with_file_name(name);
    let written = write(&fresh, content, mode).and_then(|()| fs::rename(&fresh, path));
    if written.is_err() {
        let _ = fs::remove_file(&fresh);
    }
    written?;
    match path.parent() {
        Some(parent) => File::open(parent)?.sync_all(),
        None => Ok(()),
    }
}

fn write(path: &Path, content: &[u8], mode: u32) -> io::Result<()> {
    let mut file = OpenOptions::new()
        .write(true)
        .create_new(true)
        .mode(mode)
        .open(path)?;
    file.write_all(content)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn names_that_lead_elsewhere_are_refused_with_a_reason() {
        let folder = Path::new("/scripts");
        for (name, why) in [
            ("", "is empty"),
            ("../x", "leads out"),
            ("a/../../x", "leads out"),
            ("/etc/passwd", "absolute"),
            ("./x", "'.'"),
            (".hidden", "dot"),
            ("a/.b/c", "dot"),
            ("a/", "folder"),
            ("a\0b", "control"),
            ("a\nb", "control"),
            ("1/2/3/4/5/6/7/8/9/x", "too many"),
            (&"x".repeat(300), "too long"),
        ] {
            let refusal = locate(folder, name.as_bytes()).unwrap_err();
            assert!(refusal.contains(why), "{name}: {refusal}");
        }
        assert!(locate(folder, b"\xff").unwrap_err().contains("UTF-8"));
        assert_eq!(
            locate(folder, b"a/b c.js").unwrap(),
            Path::new("/scripts/a/b c.js")
        );
    }

    #[test]
    fn uploads_are_whole_binary_and_in_folders_that_are_made() {
        let scratch = Scratch::new("scripts");
        let folder = scratch.path().join("new/scripts");
        let path = keep(&folder, b"a/b.bin", b"x\0\xff").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"x\0\xff");
        keep(&folder, b"a/b.bin", b"#!/bin/sh\n").unwrap();
        let mode =
            std::os::unix::fs::PermissionsExt::mode(&fs::metadata(&path).unwrap().permissions());
        assert_eq!(mode & 0o111, 0o111);
        assert_eq!(fs::read_dir(folder.join("a")).unwrap().count(), 1);
        assert_eq!(find(&folder, b"a/b.bin").unwrap(), path);
        assert!(
            find(&folder, b"none.js")
                .unwrap_err()
                .contains("there is no program 'none.js'")
        );
        assert!(
            keep(&folder, b"a", b"")
                .unwrap_err()
                .contains("folder of this name")
        );
        assert!(
            keep(&folder, b"a/b.bin/c", b"")
                .unwrap_err()
                .contains("was not kept")
        );
    }

    #[test]
    fn links_lead_nowhere() {
        let scratch = Scratch::new("scripts");
        let folder = scratch.path().join("scripts");
        scratch.file("outside/x.js", "");
        fs::create_dir_all(&folder).unwrap();
        std::os::unix::fs::symlink(scratch.path().join("outside"), folder.join("l")).unwrap();
        assert!(keep(&folder, b"l/y.js", b"").unwrap_err().contains("link"));
        assert!(find(&folder, b"l/x.js").unwrap_err().contains("link"));
        assert!(!scratch.path().join("outside/y.js").exists());
        assert!(
            keep(&folder, b"l/new/y.js", b"")
                .unwrap_err()
                .contains("link")
        );
        assert!(
            !scratch.path().join("outside/new").exists(),
            "no folder is made behind a link"
        );
        std::os::unix::fs::symlink(scratch.path().join("outside/x.js"), folder.join("x.js"))
            .unwrap();
        keep(&folder, b"x.js", b"new").unwrap();
        assert_eq!(fs::read(scratch.path().join("outside/x.js")).unwrap(), b"");
        assert_eq!(fs::read(folder.join("x.js")).unwrap(), b"new");
    }

    #[test]
    fn a_folder_that_becomes_a_link_while_an_upload_comes_leads_nowhere() {
        use std::sync::atomic::AtomicBool;
        let scratch = Scratch::new("scripts");
        let (folder, outside) = (
            scratch.path().join("scripts"),
            scratch.path().join("outside"),
        );
        fs::create_dir_all(folder.join("f")).unwrap();
        fs::create_dir_all(&outside).unwrap();
        let link = scratch.path().join("link");
        std::os::unix::fs::symlink(&outside, &link).unwrap();
        let is_over = AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !is_over.load(Ordering::Relaxed) {
                    // What a program does that wants a file of the daemon elsewhere.
                    nix::fcntl::renameat2(
                        nix::fcntl::AT_FDCWD,
                        &link,
                        nix::fcntl::AT_FDCWD,
                        &folder.join("f"),
                        nix::fcntl::RenameFlags::RENAME_EXCHANGE,
                    )
                    .unwrap();
                }
            });
            for _ in 0..300 {
                let _ = keep(&folder, b"f/deep/x.js", b"");
            }
            is_over.store(true, Ordering::Relaxed);
        });
        assert_eq!(fs::read_dir(&outside).unwrap().count(), 0);
    }

    #[test]
    fn a_file_that_cannot_be_replaced_stays_as_it_was() {
        let scratch = Scratch::new("scripts");
        scratch.file("d/keep", "old");
        assert!(replace(&scratch.path().join("d"), b"new", 0o644).is_err());
        assert!(replace(&scratch.path().join("none/x"), b"new", 0o644).is_err());
        assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 1);
    }
}
