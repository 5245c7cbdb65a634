//! Where the rings of a mounted tree are: a directory in shared memory, named after the mount point.
//!
//! Owns the names, and the directory of one publisher: that it is the only one, that no other user put it there, that
//! what a killed publisher left is removed. Knows nothing of what is in a ring.

use crate::limits;
use nix::unistd::geteuid;
use std::collections::{HashMap, HashSet};
use std::fs::{File, Metadata, Permissions, TryLockError};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};

/// Where shared memory is.
pub const SHARED_MEMORY: &str = "/dev/shm";
/// What the names of all directories begin with.
const PREFIX: &str = "trikfs";

/// The directory of the tree at a mount point, which is absolute and without links: `/mnt/robot` is
/// `trikfs+mnt+robot`.
///
/// # Errors
/// The name would be too long.
pub fn directory(shared_memory: &Path, mountpoint: &Path) -> io::Result<PathBuf> {
    let mut name = PREFIX.to_owned();
    escape(mountpoint.as_os_str().as_bytes(), &mut name);
    fitting(name).map(|name| shared_memory.join(name))
}

/// The file of a node in that directory: `sensors/A1` is `sensors+A1`.
///
/// # Errors
/// The name would be too long, or is none.
pub fn file_name(node: &str) -> io::Result<String> {
    let mut name = String::new();
    escape(node.as_bytes(), &mut name);
    if name.is_empty() || name.starts_with('.') {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "not the path of a node",
        ));
    }
    fitting(name)
}

/// The file of what is written to an actuator: `motors/M3` is `motors+M3%w`, which is no name of a node's own ring.
///
/// # Errors
/// As of [`file_name`].
pub fn written_file_name(node: &str) -> io::Result<String> {
    fitting(file_name(node)? + "%w")
}

/// The file of what a node's source gave before it was converted: `sensors/A1` is `sensors+A1%r`.
///
/// # Errors
/// As of [`file_name`].
pub fn raw_file_name(node: &str) -> io::Result<String> {
    fitting(file_name(node)? + "%r")
}

fn fitting(name: String) -> io::Result<String> {
    if name.len() > limits::NAME_BYTES_MAX {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            format!(
                "the path is too long: its name in shared memory would have {} bytes",
                name.len()
            ),
        ));
    }
    Ok(name)
}

/// `/` becomes `+`; all but letters, digits, `.`, `_` and `-` becomes `%` and two hexadecimal digits.
fn escape(path: &[u8], name: &mut String) {
    for &byte in path {
        match byte {
            b'/' => name.push('+'),
            b'.' | b'_' | b'-' => name.push(char::from(byte)),
            _ if byte.is_ascii_alphanumeric() => name.push(char::from(byte)),
            _ => name.push_str(&format!("%{byte:02X}")),
        }
    }
}

/// The directory of one publisher. Dropping it removes it with all that is in it, unless another one is in its place.
#[derive(Debug)]
pub struct Directory {
    path: PathBuf,
    /// Holds the lock that keeps others out for as long as this process lives.
    lock: File,
}

impl Directory {
    /// Takes the directory with the given rights; makes it or removes what a killed publisher left in it.
    ///
    /// # Errors
    /// There is no shared memory, another user's directory is there, or another publisher of this mount point lives.
    pub fn take(path: &Path, mode: u32) -> io::Result<Self> {
        let mut busy = None;
        for _ in 0..limits::DIRECTORY_ATTEMPTS {
            match std::fs::DirBuilder::new().mode(0o700).create(path) {
                Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
                _ => {}
            }
            let lock = match lock(path) {
                Ok(Some(lock)) => lock,
                // Somebody else has just removed it.
                Ok(None) => continue,
                // Perhaps only by a process that cleans up.
                Err(error) if error.kind() == io::ErrorKind::ResourceBusy => {
                    busy = Some(error);
                    std::thread::sleep(limits::DIRECTORY_PAUSE);
                    continue;
                }
                Err(error) => return Err(error),
            };
            let taken = Self {
                path: path.to_owned(),
                lock,
            };
            taken.empty()?;
            std::fs::set_permissions(path, Permissions::from_mode(mode))?;
            return Ok(taken);
        }
        Err(busy.unwrap_or_else(|| io::Error::other("others make and remove it all the time")))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it still is where it is: it can be removed, and made again by others.
    pub fn is_there(&self) -> bool {
        self.lock
            .metadata()
            .is_ok_and(|meta| is_at(&self.path, &meta))
    }

    /// Makes second names of rings: exactly these links, from their names to names of rings, which need not be there
    /// yet. Those that lead where they should are left alone.
    ///
    /// # Errors
    /// The name of the first link that could not be made or removed; the others are as they should be.
    pub fn set_links(&self, links: &HashMap<String, String>) -> Result<(), (String, io::Error)> {
        let entries = match std::fs::read_dir(&self.path) {
            Ok(entries) => entries,
            Err(error) => {
                // It was removed: without second names that is not noticed here.
                let why = format!("{}: {error}", self.path.display());
                let why = io::Error::new(error.kind(), why);
                return (links.keys().min()).map_or(Ok(()), |name| Err((name.clone(), why)));
            }
        };
        let mut failed = None;
        let mut kept = HashSet::new();
        for entry in entries.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let Ok(target) = std::fs::read_link(entry.path()) else {
                continue;
            };
            if links
                .get(&name)
                .is_some_and(|ring| target == Path::new(ring))
            {
                kept.insert(name);
            } else if let Err(error) = std::fs::remove_file(entry.path()) {
                failed.get_or_insert((name, error));
            }
        }
        for (name, ring) in links.iter().filter(|(name, _)| !kept.contains(*name)) {
            if let Err(error) = symlink(ring, self.path.join(name)) {
                failed.get_or_insert((name.clone(), error));
            }
        }
        failed.map_or(Ok(()), Err)
    }

    fn empty(&self) -> io::Result<()> {
        for entry in std::fs::read_dir(&self.path)? {
            let entry = entry?;
            // No publisher makes one, but what is there must not stay in the way forever.
            if entry.file_type()?.is_dir() {
                std::fs::remove_dir_all(entry.path())?;
            } else {
                std::fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        if self.is_there() {
            // What cannot be removed is removed by the next one.
            let _ = self.empty().and_then(|()| std::fs::remove_dir(&self.path));
        }
    }
}

/// Removes what killed publishers of this user left anywhere in shared memory, as far as it can be removed.
pub fn sweep(shared_memory: &Path) {
    let entries = std::fs::read_dir(shared_memory).into_iter().flatten();
    for entry in entries.flatten() {
        let path = entry.path();
        // An empty one may be that of a publisher that is just starting.
        let has_rings = || std::fs::read_dir(&path).is_ok_and(|mut rings| rings.next().is_some());
        if entry.file_name().as_bytes().starts_with(b"trikfs+") && has_rings() {
            remove_left(&path);
        }
    }
}

/// Removes what a killed publisher left. False: there is nothing, or it is not ours, or its publisher lives.
pub fn remove_left(path: &Path) -> bool {
    if !path.exists() {
        return false;
    }
    match lock(path) {
        Ok(Some(lock)) => {
            drop(Directory {
                path: path.to_owned(),
                lock,
            });
            !path.exists()
        }
        _ => false,
    }
}

/// Opens a directory that is ours and locks it. None: it is gone, or another one is in its place.
fn lock(path: &Path) -> io::Result<Option<File>> {
    let flags = libc::O_DIRECTORY | libc::O_NOFOLLOW | libc::O_CLOEXEC;
    let file = match File::options().read(true).custom_flags(flags).open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        result => result?,
    };
    let meta = file.metadata()?;
    if meta.uid() != geteuid().as_raw() {
        let owner = meta.uid();
        return Err(io::Error::new(
            io::ErrorKind::PermissionDenied,
            format!("it belongs to user {owner}; remove it"),
        ));
    }
    match file.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            return Err(io::Error::new(
                io::ErrorKind::ResourceBusy,
                "another daemon publishes there: a tree is mounted on top of another",
            ));
        }
        Err(TryLockError::Error(error)) => return Err(error),
    }
    Ok(is_at(path, &meta).then_some(file))
}

/// Whether what this is known of is at this path.
fn is_at(path: &Path, meta: &Metadata) -> bool {
    let same = |found: Metadata| (found.dev(), found.ino()) == (meta.dev(), meta.ino());
    path.symlink_metadata().is_ok_and(same)
}
