//! The operations of the mount: names of the table, and open attributes with the rules of sysfs.
//!
//! A read at offset 0 makes the text again, a read beyond goes on in it. One write(2) is one text, wherever it is written.
//! poll reports POLLPRI and POLLERR of an attribute that changes when it has changed since it was last read, as
//! sysfs_notify does; all files can always be read and written.
//! Knows no device; looks through the tree for new ones when names are looked up.

use crate::device::{Access, Attribute, Changes, Device, KernelSlot, lock};
use crate::limits::{NAME_TTL_MS, OPEN_MAX, SCAN_MS, WRITE_BYTES_MAX};
use crate::scan::{Options, scan};
use crate::table::{Node, ROOT, Table};
use crate::tree::Tree;
use nix::unistd::{getgid, getuid};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant, SystemTime};
use trikfs::errno::Error;
use trikfs::transport::{
    self, Attr, Caller, DirEntry, FileKind, Kernel, Opened, Operations, Outcome, PollHandle,
    RequestId, StatFs, Transfer,
};

/// Size that `stat` shows, as in sysfs.
const SIZE: u64 = 4096;
const NAME_MAX: u32 = 255;

/// The filesystem.
pub struct View {
    tree: Tree,
    options: Options,
    kernel: KernelSlot,
    table: Mutex<Table>,
    /// When the tree was last looked through.
    scanned: Mutex<Option<Instant>>,
    open: Mutex<OpenFiles>,
    since: SystemTime,
}

#[derive(Default)]
struct OpenFiles {
    next: u64,
    files: BTreeMap<u64, Arc<OpenFile>>,
}

/// An open attribute.
struct OpenFile {
    device: Arc<dyn Device>,
    attribute: Attribute,
    content: Mutex<Content>,
}

#[derive(Default)]
struct Content {
    bytes: Vec<u8>,
    /// Changes of the attribute when the bytes were made.
    seen: Option<u32>,
}

impl OpenFile {
    fn changes(&self) -> Option<&Arc<Changes>> {
        self.device.changes(self.attribute.name)
    }
}

impl View {
    /// A view of this tree, with what it has now.
    pub fn new(tree: Tree, options: Options) -> Self {
        let view = Self {
            tree,
            options,
            kernel: KernelSlot::default(),
            table: Mutex::default(),
            scanned: Mutex::default(),
            open: Mutex::default(),
            since: SystemTime::now(),
        };
        view.refresh();
        view
    }

    /// How many devices there are.
    pub fn devices(&self) -> usize {
        lock(&self.table).count()
    }

    /// Brings everything to rest that programs drive through this view; whether there was something.
    pub fn rest(&self, why: &str) -> bool {
        let devices = lock(&self.table).devices();
        let driven = devices.iter().filter(|device| device.rest(why));
        driven.count() > 0
    }

    /// Looks through the tree if that was not done just now. Without a tree everything stays as it was.
    fn refresh(&self) {
        let Ok(mut scanned) = self.scanned.try_lock() else {
            // Somebody is at it.
            return;
        };
        if scanned.is_some_and(|at| at.elapsed() < Duration::from_millis(SCAN_MS)) {
            return;
        }
        let found = scan(&self.tree, &self.options);
        *scanned = Some(Instant::now());
        if let Some(found) = found {
            lock(&self.table).update(&found, |one| {
                one.make(&self.tree, &self.options, &self.kernel)
            });
        }
    }

    fn node(&self, ino: u64) -> Result<Node, Error> {
        lock(&self.table).node(ino).cloned().ok_or_else(gone)
    }

    fn file(&self, fh: u64) -> Result<Arc<OpenFile>, Error> {
        lock(&self.open).files.get(&fh).cloned().ok_or(Error::Stale)
    }

    fn attr(&self, ino: u64, node: &Node) -> Attr {
        let (kind, size, mode) = match node {
            Node::Directory | Node::Device(_) => (FileKind::Directory, 0, 0o755),
            Node::Attribute(_, attribute) => (FileKind::File, SIZE, attribute.access.mode()),
        };
        let ttl = Duration::from_millis(NAME_TTL_MS);
        Attr {
            ino,
            kind,
            size,
            mode,
            uid: getuid().as_raw(),
            gid: getgid().as_raw(),
            modified: self.since,
            attr_ttl: ttl,
            entry_ttl: ttl,
        }
    }
}

fn gone() -> Error {
    Error::NoDevice("the device is not there any more".to_owned())
}

/// The text of a write: as in sysfs a line break at the end is not part of it.
fn text_of(data: &[u8]) -> Result<&str, Error> {
    if data.len() > WRITE_BYTES_MAX {
        return Err(Error::Invalid(format!("{} bytes at once", data.len())));
    }
    let text = std::str::from_utf8(data)
        .map_err(|_| Error::Invalid("the text is not UTF-8".to_owned()))?;
    Ok(text.strip_suffix('\n').unwrap_or(text))
}

impl Operations for View {
    fn start(&self, kernel: Arc<dyn Kernel>) {
        // A second start of one mount does not come.
        let _ = self.kernel.set(kernel);
    }

    fn lookup(&self, parent: u64, name: &[u8]) -> Result<Attr, Error> {
        let name = std::str::from_utf8(name).map_err(|_| Error::NotFound)?;
        if matches!(self.node(parent)?, Node::Directory) {
            self.refresh();
        }
        let table = lock(&self.table);
        let ino = table.find(parent, name).ok_or(Error::NotFound)?;
        let node = table.node(ino).ok_or(Error::NotFound)?;
        Ok(self.attr(ino, node))
    }

    fn getattr(&self, ino: u64) -> Result<Attr, Error> {
        self.node(ino).map(|node| self.attr(ino, &node))
    }

    fn setattr(
        &self,
        ino: u64,
        _fh: Option<u64>,
        _size: Option<u64>,
        other: bool,
    ) -> Result<Attr, Error> {
        if other {
            Err(Error::NotPermitted)
        } else {
            self.getattr(ino)
        }
    }

    fn readdir(
        &self,
        ino: u64,
        from: u64,
        add: &mut dyn FnMut(DirEntry<'_>) -> bool,
    ) -> Result<(), Error> {
        match self.node(ino)? {
            Node::Attribute(..) => return Err(Error::NotADirectory),
            Node::Directory if from == 0 => self.refresh(),
            Node::Directory | Node::Device(_) => {}
        }
        let table = lock(&self.table);
        let dots = [(ino, "."), (table.parent(ino), "..")];
        let dots = dots.map(|(ino, name)| (ino, name, FileKind::Directory));
        let entries = table.list(ino).map(|(ino, name, node)| {
            let kind = match node {
                Node::Attribute(..) => FileKind::File,
                Node::Directory | Node::Device(_) => FileKind::Directory,
            };
            (ino, name, kind)
        });
        // Names are only added, so a position stays the same; the dots come first.
        for (number, (ino, name, kind)) in dots.into_iter().chain(entries).enumerate() {
            let next = if number < 2 {
                number as u64 + 1
            } else {
                ino + 2
            };
            if next > from
                && !add(DirEntry {
                    ino,
                    kind,
                    name,
                    next,
                })
            {
                break;
            }
        }
        Ok(())
    }

    fn open(&self, ino: u64, flags: i32, _caller: Caller) -> Result<Opened, Error> {
        let Node::Attribute(device, attribute) = self.node(ino)? else {
            return Err(Error::IsADirectory);
        };
        let (reads, writes) = match flags & libc::O_ACCMODE {
            libc::O_RDONLY => (true, false),
            libc::O_WRONLY => (false, true),
            _ => (true, true),
        };
        // As in sysfs this holds for root too, whom the kernel does not stop.
        let refuses = reads && attribute.access == Access::Write
            || writes && attribute.access == Access::Read;
        if refuses {
            return Err(Error::AccessDenied);
        }
        let mut open = lock(&self.open);
        if open.files.len() >= OPEN_MAX {
            return Err(Error::TooManyOpen(format!("{OPEN_MAX} in the view")));
        }
        open.next += 1;
        let fh = open.next;
        let file = OpenFile {
            device: Arc::clone(&device),
            attribute,
            content: Mutex::default(),
        };
        open.files.insert(fh, Arc::new(file));
        drop(open);
        device.opened();
        Ok(Opened {
            fh,
            access: transport::Access::Direct,
            flush: false,
        })
    }

    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        let file = self.file(request.fh)?;
        if request.offset == 0 {
            self.node(request.ino)?;
            // Counted before it is made, so that a change in between is told once more.
            let seen = file.changes().map(|changes| changes.count());
            let bytes = file.device.show(file.attribute.name)?.into_bytes();
            *lock(&file.content) = Content { bytes, seen };
        }
        let content = lock(&file.content);
        let length = content.bytes.len();
        let from = usize::try_from(request.offset).map_or(length, |at| at.min(length));
        let bytes = &content.bytes[from..];
        let count = out.len().min(bytes.len());
        out[..count].copy_from_slice(&bytes[..count]);
        Ok(Outcome::Done(count))
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        let file = self.file(request.fh)?;
        self.node(request.ino)?;
        file.device.store(file.attribute.name, text_of(data)?)?;
        Ok(Outcome::Done(data.len()))
    }

    fn poll(&self, _ino: u64, fh: u64, handle: PollHandle, events: u32) -> Result<u32, Error> {
        let file = self.file(fh)?;
        let bits = |bits: i16| u32::from(bits.cast_unsigned());
        let mut ready =
            bits(libc::POLLIN | libc::POLLRDNORM | libc::POLLOUT | libc::POLLWRNORM) & events;
        if let Some(changes) = file.changes() {
            // First, so that no change is missed.
            changes.watch(fh, handle);
            if lock(&file.content).seen != Some(changes.count()) {
                ready |= bits(libc::POLLPRI) & events | bits(libc::POLLERR);
            }
        }
        Ok(ready)
    }

    fn flush(&self, _id: RequestId, _ino: u64, _fh: u64, _by: Caller) -> Result<Outcome, Error> {
        Ok(Outcome::Done(0))
    }

    fn fsync(&self, _id: RequestId, _ino: u64, _fh: u64, _by: Caller) -> Result<Outcome, Error> {
        Ok(Outcome::Done(0))
    }

    fn release(&self, _ino: u64, fh: u64) {
        let file = lock(&self.open).files.remove(&fh);
        if let Some(file) = file {
            if let Some(changes) = file.changes() {
                changes.forget(fh);
            }
            file.device.closed();
        }
    }

    fn interrupt(&self, _id: RequestId) -> bool {
        // No request is kept here.
        false
    }

    fn getxattr(&self, ino: u64, _name: &[u8]) -> Result<Vec<u8>, Error> {
        self.node(ino).and(Err(Error::NoAttribute))
    }

    fn listxattr(&self, ino: u64) -> Result<Vec<u8>, Error> {
        self.node(ino).map(|_| Vec::new())
    }

    fn statfs(&self) -> StatFs {
        StatFs {
            files: lock(&self.table).len() as u64,
            name_max: NAME_MAX,
        }
    }

    fn stop(&self) {}
}

/// The top of the view is a directory whatever the tree has.
const _: () = assert!(ROOT == 1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_ends_before_its_line_break() {
        assert_eq!(text_of(b"stop\n"), Ok("stop"));
        assert_eq!(text_of(b"stop"), Ok("stop"));
        assert_eq!(text_of(b"\n\n"), Ok("\n"));
        assert!(text_of(b"\xff").is_err() && text_of(&[b'x'; 4097]).is_err());
    }
}
