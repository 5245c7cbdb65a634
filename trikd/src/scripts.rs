//! The folder of programs: which names are taken, and files that are replaced whole or not at all.
//!
//! Knows nothing of requests and languages.

mod words;

use crate::blame::{Blame, Os};
use crate::limits;
use lang_text::problem::Words;
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

    /// For a person.
    pub fn words(&self) -> Words {
        Words::new(self.to_string(), words::russian(self))
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
    let Some(place) = enter(folder, parent, Missing::Made).map_err(fails)? else {
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

/// What is done about a folder on the way that is not there.
#[derive(Clone, Copy)]
enum Missing {
    /// It is made.
    Made,
    /// That is an error.
    Refused,
}

/// Opens a folder below another one step by step. None: a step is a link. Programs may write here, so a step that is seen to
/// be a folder could be a link a moment later; one that is open cannot.
fn enter(folder: &Path, parent: &Path, missing: Missing) -> io::Result<Option<File>> {
    let make = |path: &Path, with_parents| match missing {
        Missing::Refused => Ok(()),
        Missing::Made => {
            let mut builder = DirBuilder::new();
            match builder.recursive(with_parents).mode(0o755).create(path) {
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => Err(error),
                _ => Ok(()),
            }
        }
    };
    make(folder, true)?;
    let mut place = File::open(folder)?;
    for part in parent.strip_prefix(folder).unwrap_or(Path::new("")) {
        let next = inside(&place).join(part);
        make(&next, false)?;
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
    let Some(place) = enter(folder, parent, Missing::Refused)? else {
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
mod tests;
