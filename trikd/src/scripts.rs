//! The folder of programs: which names are taken, and files that are replaced whole or not at all.
//!
//! Knows nothing of requests and languages.

use crate::blame::{Blame, Os};
use crate::limits;
use std::ffi::OsStr;
use std::fmt;
use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::{self, Write};
use std::os::fd::AsRawFd;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Why a name is none of a program.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum BadName {
    /// Bytes that are no text.
    NoUtf8,
    /// No letters.
    Empty,
    /// More than [`limits::NAME_BYTES`].
    Long,
    /// Characters that no terminal shows.
    Control,
    /// More than [`limits::NAME_DEPTH`] folders.
    Deep,
    /// A hidden part.
    Dot,
    /// A part `.`.
    Here,
    /// A part `..`.
    Outside,
    /// It begins at the root.
    Absolute,
    /// It ends with a slash.
    Folder,
}

/// Why a program is not kept or not run, with its name.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Refusal {
    /// The name is none.
    Name(String, BadName),
    /// A folder of its name is a link, which could lead anywhere.
    LinkedFolder(String),
    /// A folder has its name.
    Folder(String),
    /// The disk.
    Disk(String, Os),
    /// There is none in the folder.
    Missing(String, PathBuf),
    /// It is a link.
    Linked(String, PathBuf),
}

impl Refusal {
    /// Who can change something about it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Name(..)
            | Self::LinkedFolder(_)
            | Self::Folder(_)
            | Self::Missing(..)
            | Self::Linked(..) => Blame::Client,
            Self::Disk(..) => Blame::System,
        }
    }
}

impl fmt::Display for BadName {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::NoUtf8 => "it is not UTF-8",
            Self::Empty => "it is empty",
            Self::Long => "it is too long",
            Self::Control => "it has control characters",
            Self::Deep => "it has too many folders",
            Self::Dot => "a part of it begins with a dot",
            Self::Here => "it has '.' in it",
            Self::Outside => "it leads out of the folder of programs",
            Self::Absolute => "it is absolute",
            Self::Folder => "it is a folder",
        })
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name(name, why) => {
                write!(out, "'{name}' cannot be the name of a program: {why}")
            }
            Self::LinkedFolder(name) => {
                write!(out, "'{name}' was not kept: a folder in it is a link")
            }
            Self::Folder(name) => {
                write!(out, "'{name}' was not kept: there is a folder of this name")
            }
            Self::Disk(name, os) => {
                let hint = match os.errno {
                    Some(libc::ENOSPC | libc::EDQUOT) => {
                        "; the disk is full: delete something on the robot"
                    }
                    Some(libc::EROFS) => "; the disk is read-only",
                    Some(_) | None => "",
                };
                write!(out, "'{name}' was not kept: {os}{hint}")
            }
            Self::Missing(name, folder) => write!(
                out,
                "there is no program '{name}' in {}: upload it first",
                folder.display()
            ),
            Self::Linked(name, folder) => write!(
                out,
                "'{name}' is a link: only programs in {} are run",
                folder.display()
            ),
        }
    }
}

impl std::error::Error for Refusal {}

/// For callers whose own errors are texts.
impl From<Refusal> for String {
    fn from(refusal: Refusal) -> Self {
        refusal.to_string()
    }
}

static NUMBER: AtomicU32 = AtomicU32::new(0);

/// The path of a program below the folder.
///
/// # Errors
/// The name is not UTF-8, empty, too long, absolute, leads out of the folder or is hidden.
pub fn locate(folder: &Path, name: &[u8]) -> Result<PathBuf, Refusal> {
    let shown = crate::log::printable(&String::from_utf8_lossy(name));
    let refused = |why: BadName| Err(Refusal::Name(shown.clone(), why));
    let Ok(name) = std::str::from_utf8(name) else {
        return refused(BadName::NoUtf8);
    };
    if name.is_empty() {
        return refused(BadName::Empty);
    }
    if name.len() > limits::NAME_BYTES {
        return refused(BadName::Long);
    }
    if name.chars().any(char::is_control) {
        return refused(BadName::Control);
    }
    let path = Path::new(name);
    for (depth, component) in path.components().enumerate() {
        match component {
            Component::Normal(_) if depth >= limits::NAME_DEPTH => {
                return refused(BadName::Deep);
            }
            Component::Normal(part) if part.as_encoded_bytes().starts_with(b".") => {
                return refused(BadName::Dot);
            }
            Component::Normal(_) => {}
            Component::CurDir => return refused(BadName::Here),
            Component::ParentDir => return refused(BadName::Outside),
            Component::RootDir | Component::Prefix(_) => return refused(BadName::Absolute),
        }
    }
    if name.ends_with('/') {
        return refused(BadName::Folder);
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
/// The name is none, a folder is in the way, or the disk refuses.
pub fn store(folder: &Path, name: &[u8], content: &[u8]) -> Result<PathBuf, Refusal> {
    let path = locate(folder, name)?;
    let shown = || String::from_utf8_lossy(name).into_owned();
    let fails = |error: io::Error| Refusal::Disk(shown(), error.into());
    let parent = path.parent().unwrap_or(folder);
    let Some(place) = enter(folder, parent).map_err(fails)? else {
        return Err(Refusal::LinkedFolder(shown()));
    };
    let last = inside(&place).join(path.file_name().unwrap_or_default());
    if fs::symlink_metadata(&last).is_ok_and(|found| found.is_dir()) {
        return Err(Refusal::Folder(shown()));
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

/// The ending of a name in small letters, which says what the program is written in; empty if there is none.
pub fn ending(path: &Path) -> String {
    let ending = path.extension().and_then(OsStr::to_str);
    ending.unwrap_or_default().to_ascii_lowercase()
}

/// Whether content says by itself that it can be executed.
pub fn is_executable(content: &[u8]) -> bool {
    content.starts_with(b"\x7fELF") || content.starts_with(b"#!")
}

/// The program of this name, if it is there.
///
/// # Errors
/// There is none, or it is not in the folder.
pub fn find(folder: &Path, name: &[u8]) -> Result<PathBuf, Refusal> {
    let path = locate(folder, name)?;
    let shown = || String::from_utf8_lossy(name).into_owned();
    if !path.is_file() {
        return Err(Refusal::Missing(shown(), folder.to_owned()));
    }
    if !is_inside(folder, &path) {
        return Err(Refusal::Linked(shown(), folder.to_owned()));
    }
    Ok(path)
}

/// Opens a program below the folder to be read. None: it is no file, or a step to it is a link.
///
/// # Errors
/// Those of the file system.
pub fn open(folder: &Path, path: &Path) -> io::Result<Option<File>> {
    let (Ok(_), Some(parent), Some(name)) =
        (path.strip_prefix(folder), path.parent(), path.file_name())
    else {
        return Ok(None);
    };
    let Some(place) = enter(folder, parent)? else {
        return Ok(None);
    };
    // A pipe would be waited for.
    let opened = OpenOptions::new()
        .read(true)
        .custom_flags(libc::O_NOFOLLOW | libc::O_NONBLOCK)
        .open(inside(&place).join(name));
    let file = match opened {
        Err(error) if error.raw_os_error() == Some(libc::ELOOP) => return Ok(None),
        opened => opened?,
    };
    let found = file.metadata()?;
    // A file with a second name may be one of somebody else that a program has given a name here.
    Ok((found.is_file() && found.nlink() == 1).then_some(file))
}

/// Replaces a file: a reader finds the old content or the new one, also after a power cut.
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
    use harness::put;
    use tempfile::tempdir;

    #[test]
    fn an_ending_is_the_same_in_capital_letters() {
        let given = ["a.FLOW", "b/A.Qrs", "a", ".js"].map(|name| ending(Path::new(name)));
        assert_eq!(given, ["flow", "qrs", "", ""]);
    }

    #[test]
    fn only_files_that_are_really_in_the_folder_are_opened_to_be_read() {
        let home = tempdir().unwrap();
        let folder = home.path().join("scripts");
        fs::create_dir_all(folder.join("sub")).unwrap();
        put(home.path(), "secret", "x");
        put(&folder.join("sub"), "a.js", "1");
        let is_open = |name: &str| {
            let opened = open(&folder, &folder.join(name));
            opened.is_ok_and(|file| file.is_some())
        };
        assert!(is_open("sub/a.js"));
        std::os::unix::fs::symlink("../secret", folder.join("link.js")).unwrap();
        std::os::unix::fs::symlink("..", folder.join("up")).unwrap();
        fs::hard_link(home.path().join("secret"), folder.join("second.js")).unwrap();
        nix::unistd::mkfifo(&folder.join("pipe.js"), nix::sys::stat::Mode::S_IRWXU).unwrap();
        for name in [
            "link.js",
            "up/secret",
            "second.js",
            "pipe.js",
            "sub",
            "none.js",
        ] {
            assert!(!is_open(name), "{name}");
        }
        assert!(open(&folder, &home.path().join("secret")).is_ok_and(|file| file.is_none()));
    }

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
            assert!(refusal.to_string().contains(why), "{name}: {refusal}");
        }
        assert!(
            locate(folder, b"\xff")
                .unwrap_err()
                .to_string()
                .contains("UTF-8")
        );
        assert_eq!(
            locate(folder, b"a/b c.js").unwrap(),
            Path::new("/scripts/a/b c.js")
        );
    }

    #[test]
    fn uploads_are_whole_binary_and_in_folders_that_are_made() {
        let scratch = tempdir().unwrap();
        let folder = scratch.path().join("new/scripts");
        let path = store(&folder, b"a/b.bin", b"x\0\xff").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"x\0\xff");
        store(&folder, b"a/b.bin", b"#!/bin/sh\n").unwrap();
        let mode =
            std::os::unix::fs::PermissionsExt::mode(&fs::metadata(&path).unwrap().permissions());
        assert_eq!(mode & 0o111, 0o111);
        assert_eq!(fs::read_dir(folder.join("a")).unwrap().count(), 1);
        assert_eq!(find(&folder, b"a/b.bin").unwrap(), path);
        assert!(
            find(&folder, b"none.js")
                .unwrap_err()
                .to_string()
                .contains("there is no program 'none.js'")
        );
        assert!(
            store(&folder, b"a", b"")
                .unwrap_err()
                .to_string()
                .contains("folder of this name")
        );
        assert!(
            store(&folder, b"a/b.bin/c", b"")
                .unwrap_err()
                .to_string()
                .contains("was not kept")
        );
    }

    #[test]
    fn links_lead_nowhere() {
        let scratch = tempdir().unwrap();
        let folder = scratch.path().join("scripts");
        put(scratch.path(), "outside/x.js", "");
        fs::create_dir_all(&folder).unwrap();
        std::os::unix::fs::symlink(scratch.path().join("outside"), folder.join("l")).unwrap();
        assert!(
            store(&folder, b"l/y.js", b"")
                .unwrap_err()
                .to_string()
                .contains("link")
        );
        assert!(
            find(&folder, b"l/x.js")
                .unwrap_err()
                .to_string()
                .contains("link")
        );
        assert!(!scratch.path().join("outside/y.js").exists());
        assert!(
            store(&folder, b"l/new/y.js", b"")
                .unwrap_err()
                .to_string()
                .contains("link")
        );
        assert!(
            !scratch.path().join("outside/new").exists(),
            "no folder is made through a link"
        );
        std::os::unix::fs::symlink(scratch.path().join("outside/x.js"), folder.join("x.js"))
            .unwrap();
        store(&folder, b"x.js", b"new").unwrap();
        assert_eq!(fs::read(scratch.path().join("outside/x.js")).unwrap(), b"");
        assert_eq!(fs::read(folder.join("x.js")).unwrap(), b"new");
    }

    #[test]
    fn a_folder_that_becomes_a_link_while_an_upload_comes_leads_nowhere() {
        use std::sync::atomic::AtomicBool;
        let scratch = tempdir().unwrap();
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
                let _ = store(&folder, b"f/deep/x.js", b"");
            }
            is_over.store(true, Ordering::Relaxed);
        });
        assert_eq!(fs::read_dir(&outside).unwrap().count(), 0);
    }

    #[test]
    fn a_file_that_cannot_be_replaced_stays_as_it_was() {
        let scratch = tempdir().unwrap();
        put(scratch.path(), "d/keep", "old");
        assert!(replace(&scratch.path().join("d"), b"new", 0o644).is_err());
        assert!(replace(&scratch.path().join("none/x"), b"new", 0o644).is_err());
        assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 1);
    }
}
