//! How a source comes to rest when nobody serves it any more, and the form of its device in bytes for that moment.
//!
//! Owns the form's numbers and texts, which never leave the machine. The bytes come from a process that may have died of
//! anything: reading believes nothing. All numbers are little endian; a text is its length as u16 and its bytes.

use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

/// What takes the writes of a kind of source, and so what brings it to rest. Each kind has to choose: one that can be
/// written and moves something is a [`Rest::Device`], and has no such value without its form.
pub(crate) enum Rest<T> {
    /// Nothing can be written.
    ReadOnly,
    /// It takes writes, and there is nothing that could move.
    Absent,
    /// It takes writes, but has no device of its own that a tuple could bring to rest.
    NoDevice,
    /// The node that it names.
    Node(fn(&T) -> &str),
    /// What the source within does.
    Within,
    /// A device of its own.
    Device(Form<T>),
}

impl<T> Rest<T> {
    /// The number of its form.
    pub(crate) const fn tag(&self) -> Option<u8> {
        match self {
            Self::Device(form) => Some(form.tag),
            Self::ReadOnly | Self::Absent | Self::NoDevice | Self::Node(_) | Self::Within => None,
        }
    }
}

/// A device as bytes: as much of its description as opening it for writing needs.
pub(crate) struct Form<T> {
    /// The number of this form, unlike all others.
    pub(crate) tag: u8,
    /// Appends the fields; None if they do not fit, or this one cannot be written.
    pub(crate) put: fn(&T, &mut Vec<u8>) -> Option<()>,
    /// Takes the fields; None if they are not within the limits of a configuration.
    pub(crate) take: fn(&mut Bytes<'_>) -> Option<T>,
}

/// How an actuator behind a source is brought to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resting<'a> {
    /// Not at all: nothing can be written to the source.
    ReadOnly,
    /// It always rests: this board does not have it.
    Absent,
    /// By a write like any other; when nobody serves it, there is nothing left to do.
    NoDevice,
    /// With the node of this path.
    Node(&'a str),
    /// As the source within it, `innermost` in the end.
    Within,
    /// By a tuple to its device, from any sender.
    Device,
}

/// True if no number stands twice.
pub(crate) const fn are_different(tags: &[Option<u8>]) -> bool {
    let mut seen = [false; 256];
    let mut at = 0;
    while at < tags.len() {
        if let Some(tag) = tags[at] {
            if seen[tag as usize] {
                return false;
            }
            seen[tag as usize] = true;
        }
        at += 1;
    }
    true
}

/// Appends a path; None if it is too long.
pub(super) fn put_path(path: &Path, out: &mut Vec<u8>) -> Option<()> {
    let bytes = path.as_os_str().as_bytes();
    out.extend_from_slice(&u16::try_from(bytes.len()).ok()?.to_le_bytes());
    out.extend_from_slice(bytes);
    Some(())
}

/// The number of a word among a few.
pub(super) fn position<T: PartialEq>(all: &[T], one: &T) -> Option<u8> {
    all.iter()
        .position(|known| known == one)
        .and_then(|at| u8::try_from(at).ok())
}

/// Bytes that are taken from the front.
pub struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*first)
    }

    /// One byte.
    pub fn u8(&mut self) -> Option<u8> {
        self.array().map(|[byte]| byte)
    }

    /// Two bytes.
    pub fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    /// Four bytes; None beyond `max`.
    pub fn u32(&mut self, max: u32) -> Option<u32> {
        let number = self.array().map(u32::from_le_bytes)?;
        (number <= max).then_some(number)
    }

    /// A byte that is 0 or 1.
    pub fn boolean(&mut self) -> Option<bool> {
        match self.u8()? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }

    /// A path that the system could have.
    pub fn path(&mut self) -> Option<PathBuf> {
        let length = usize::from(self.u16()?);
        let (path, rest): (&'a [u8], _) = self.0.split_at_checked(length)?;
        self.0 = rest;
        let fits = !path.is_empty() && path.len() < libc::PATH_MAX as usize && !path.contains(&0);
        fits.then(|| PathBuf::from(OsStr::from_bytes(path)))
    }
}
