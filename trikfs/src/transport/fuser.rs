//! The portable transport: the same operations over the `fuser` crate. The second opinion on the native one.
//!
//! Each method unpacks its arguments, calls the operation of the same name and replies. Owns the replies of requests
//! that wait. Knows no node and no device.
//!
//! What it cannot do, compared with the native transport (fuser 0.18):
//! * a waiting reader cannot be interrupted or killed before its data comes: FUSE_INTERRUPT is answered ENOSYS;
//! * nobody takes over from an operation that lasts: as many as [`FUSER_THREADS`] late ones stop the mount;
//! * ASYNC_READ cannot be switched off, and the version of the protocol cannot be held down;
//! * a store into a file that the kernel does not know is reported as done;
//! * a session ends only when the mount does.

mod link;

use super::native::Features;
use super::{
    Answer, Attr, Caller, FileKind, Opened, Operations, Outcome, PollHandle, StatFs, Transfer,
};
use crate::errno::Error;
use crate::limits::{BACKGROUND_MAX, FUSER_THREADS, TRANSFER_BYTES_MAX};
use crate::transport::RequestId;
use fuser::{
    BsdFileFlags, Config, FileAttr, FileHandle, FileType, Filesystem, FopenFlags, Generation,
    INodeNo, InitFlags, IoctlFlags, KernelConfig, LockOwner, OpenFlags, PollEvents, PollFlags,
    PollNotifier, RenameFlags, ReplyAttr, ReplyCreate, ReplyData, ReplyDirectory, ReplyEmpty,
    ReplyEntry, ReplyIoctl, ReplyOpen, ReplyPoll, ReplyStatfs, ReplyWrite, ReplyXattr, Request,
    SessionACL, TimeOrNow, WriteFlags,
};
use link::{Link, Reply, fenced, number};
use std::ffi::OsStr;
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

/// Serves a mount until it is gone, then tells the filesystem.
///
/// # Errors
/// If the device cannot be read, or the kernel and the crate have no version in common.
pub fn serve(device: OwnedFd, operations: Arc<dyn Operations>) -> io::Result<()> {
    let link = Arc::new(Link::default());
    let adapter = Adapter {
        operations: Arc::clone(&operations),
        link: Arc::clone(&link),
        features: Features::of_version(0),
    };
    let mut config = Config::default();
    config.n_threads = Some(FUSER_THREADS);
    // The mount itself says who may enter.
    let session = fuser::Session::from_fd(adapter, device, SessionACL::All, config)?;
    link.notifier.get_or_init(|| session.notifier());
    operations.start(link);
    let served = session.run();
    operations.stop();
    match served {
        // As in the native transport: the kernel says either of the two when the mount is gone.
        Err(error) if error.kind() == io::ErrorKind::ConnectionAborted => Ok(()),
        served => served,
    }
}

fn caller(request: &Request) -> Caller {
    Caller {
        uid: request.uid(),
        gid: request.gid(),
        pid: request.pid(),
    }
}

fn id(request: &Request) -> RequestId {
    RequestId(request.unique().0)
}

fn transfer(
    request: &Request,
    ino: INodeNo,
    fh: FileHandle,
    offset: u64,
    flags: OpenFlags,
) -> Transfer {
    Transfer {
        id: id(request),
        ino: ino.0,
        fh: fh.0,
        offset,
        nonblocking: flags.0 & libc::O_NONBLOCK != 0,
        append: flags.0 & libc::O_APPEND != 0,
        paged: false,
        caller: caller(request),
    }
}

fn file_type(kind: FileKind) -> FileType {
    match kind {
        FileKind::Directory => FileType::Directory,
        FileKind::File => FileType::RegularFile,
    }
}

fn file_attr(attr: &Attr) -> FileAttr {
    FileAttr {
        ino: INodeNo(attr.ino),
        size: attr.size,
        blocks: attr.size.div_ceil(512),
        atime: attr.modified,
        mtime: attr.modified,
        ctime: attr.modified,
        crtime: attr.modified,
        kind: file_type(attr.kind),
        perm: attr.mode & 0o7777,
        nlink: if attr.kind == FileKind::Directory {
            2
        } else {
            1
        },
        uid: attr.uid,
        gid: attr.gid,
        rdev: 0,
        blksize: 4096,
        flags: 0,
    }
}

fn give_attr(result: Result<Attr, Error>, reply: ReplyAttr) {
    match result {
        Ok(attr) => reply.attr(&attr.attr_ttl, &file_attr(&attr)),
        Err(error) => reply.error(number(&error)),
    }
}

fn give_attribute(result: Result<Vec<u8>, Error>, size: u32, reply: ReplyXattr) {
    match result {
        Ok(value) if size == 0 => reply.size(u32::try_from(value.len()).unwrap_or(u32::MAX)),
        Ok(value) if value.len() <= size as usize => reply.data(&value),
        Ok(_) => reply.error(number(&Error::BufferTooSmall)),
        Err(error) => reply.error(number(&error)),
    }
}

/// What the crate calls.
struct Adapter {
    operations: Arc<dyn Operations>,
    link: Arc<Link>,
    features: Features,
}

impl Filesystem for Adapter {
    fn init(&mut self, _request: &Request, config: &mut KernelConfig) -> io::Result<()> {
        self.features = Features::of_version(config.kernel_abi().1);
        for wanted in [
            InitFlags::FUSE_ATOMIC_O_TRUNC,
            InitFlags::FUSE_PARALLEL_DIROPS,
        ] {
            // Not offered: the kernel does without.
            let _ = config.add_capabilities(wanted);
        }
        let _ = config.set_max_write(TRANSFER_BYTES_MAX as u32);
        let _ = config.set_max_background(BACKGROUND_MAX);
        Ok(())
    }

    fn lookup(&self, _request: &Request, parent: INodeNo, name: &OsStr, reply: ReplyEntry) {
        match fenced(|| self.operations.lookup(parent.0, name.as_bytes())) {
            Ok(attr) => reply.entry_with_ttls(
                &attr.attr_ttl,
                &attr.entry_ttl,
                &file_attr(&attr),
                Generation(0),
            ),
            Err(error) => reply.error(number(&error)),
        }
    }

    fn getattr(&self, _request: &Request, ino: INodeNo, _fh: Option<FileHandle>, reply: ReplyAttr) {
        give_attr(fenced(|| self.operations.getattr(ino.0)), reply);
    }

    fn setattr(
        &self,
        _request: &Request,
        ino: INodeNo,
        mode: Option<u32>,
        uid: Option<u32>,
        gid: Option<u32>,
        size: Option<u64>,
        atime: Option<TimeOrNow>,
        mtime: Option<TimeOrNow>,
        _ctime: Option<SystemTime>,
        fh: Option<FileHandle>,
        _crtime: Option<SystemTime>,
        _chgtime: Option<SystemTime>,
        _bkuptime: Option<SystemTime>,
        _flags: Option<BsdFileFlags>,
        reply: ReplyAttr,
    ) {
        // truncate(2) brings times along; they ask for nothing of their own.
        let times = (atime.is_some() || mtime.is_some()) && size.is_none();
        let other = mode.is_some() || uid.is_some() || gid.is_some() || times;
        let result = fenced(|| {
            self.operations
                .setattr(ino.0, fh.map(|fh| fh.0), size, other)
        });
        give_attr(result, reply);
    }

    fn mknod(
        &self,
        _r: &Request,
        _p: INodeNo,
        _n: &OsStr,
        _m: u32,
        _u: u32,
        _d: u32,
        reply: ReplyEntry,
    ) {
        reply.error(number(&Error::NotPermitted));
    }

    fn mkdir(&self, _r: &Request, _p: INodeNo, _n: &OsStr, _m: u32, _u: u32, reply: ReplyEntry) {
        reply.error(number(&Error::NotPermitted));
    }

    fn unlink(&self, _r: &Request, _p: INodeNo, _n: &OsStr, reply: ReplyEmpty) {
        reply.error(number(&Error::NotPermitted));
    }

    fn rmdir(&self, _r: &Request, _p: INodeNo, _n: &OsStr, reply: ReplyEmpty) {
        reply.error(number(&Error::NotPermitted));
    }

    fn symlink(&self, _r: &Request, _p: INodeNo, _n: &OsStr, _t: &Path, reply: ReplyEntry) {
        reply.error(number(&Error::NotPermitted));
    }

    fn rename(
        &self,
        _r: &Request,
        _p: INodeNo,
        _n: &OsStr,
        _to: INodeNo,
        _new: &OsStr,
        _flags: RenameFlags,
        reply: ReplyEmpty,
    ) {
        reply.error(number(&Error::NotPermitted));
    }

    fn link(&self, _r: &Request, _i: INodeNo, _p: INodeNo, _n: &OsStr, reply: ReplyEntry) {
        reply.error(number(&Error::NotPermitted));
    }

    fn create(
        &self,
        _r: &Request,
        _p: INodeNo,
        _n: &OsStr,
        _m: u32,
        _u: u32,
        _f: i32,
        reply: ReplyCreate,
    ) {
        reply.error(number(&Error::NotPermitted));
    }

    fn open(&self, request: &Request, ino: INodeNo, flags: OpenFlags, reply: ReplyOpen) {
        match fenced(|| self.operations.open(ino.0, flags.0, caller(request))) {
            Ok(opened) => {
                let Opened { fh, .. } = opened;
                let flags = FopenFlags::from_bits_truncate(self.features.open_flags(&opened));
                reply.opened(FileHandle(fh), flags);
            }
            Err(error) => reply.error(number(&error)),
        }
    }

    fn read(
        &self,
        request: &Request,
        ino: INodeNo,
        fh: FileHandle,
        offset: u64,
        size: u32,
        flags: OpenFlags,
        owner: Option<LockOwner>,
        reply: ReplyData,
    ) {
        let transfer = Transfer {
            // The page cache has no owner; a read(2) always has one.
            paged: owner.is_none(),
            ..transfer(request, ino, fh, offset, flags)
        };
        let mut buffer = vec![0; TRANSFER_BYTES_MAX.min(size as usize)];
        let out = buffer.as_mut_slice();
        self.link.perform(transfer.id, Reply::Data(reply), move || {
            let outcome = self.operations.read(&transfer, out)?;
            let answer = match outcome {
                Outcome::Done(count) => out.get(..count).map(Answer::Data),
                Outcome::Wait => None,
            };
            Ok((outcome, answer))
        });
    }

    fn write(
        &self,
        request: &Request,
        ino: INodeNo,
        fh: FileHandle,
        offset: u64,
        data: &[u8],
        _write_flags: WriteFlags,
        flags: OpenFlags,
        _owner: Option<LockOwner>,
        reply: ReplyWrite,
    ) {
        let transfer = transfer(request, ino, fh, offset, flags);
        self.link.perform(transfer.id, Reply::Write(reply), || {
            let outcome = self.operations.write(&transfer, data)?;
            let answer = match outcome {
                Outcome::Done(count) if count <= data.len() => Some(Answer::Written(count)),
                _ => None,
            };
            Ok((outcome, answer))
        });
    }

    fn flush(
        &self,
        request: &Request,
        ino: INodeNo,
        fh: FileHandle,
        _owner: LockOwner,
        reply: ReplyEmpty,
    ) {
        self.link.perform(id(request), Reply::Empty(reply), || {
            let outcome = self
                .operations
                .flush(id(request), ino.0, fh.0, caller(request))?;
            Ok((outcome, Some(Answer::Empty)))
        });
    }

    fn fsync(
        &self,
        request: &Request,
        ino: INodeNo,
        fh: FileHandle,
        _datasync: bool,
        reply: ReplyEmpty,
    ) {
        self.link.perform(id(request), Reply::Empty(reply), || {
            let outcome = self
                .operations
                .fsync(id(request), ino.0, fh.0, caller(request))?;
            Ok((outcome, Some(Answer::Empty)))
        });
    }

    fn release(
        &self,
        _request: &Request,
        ino: INodeNo,
        fh: FileHandle,
        _flags: OpenFlags,
        _owner: Option<LockOwner>,
        _flush: bool,
        reply: ReplyEmpty,
    ) {
        let _ = fenced(|| {
            self.operations.release(ino.0, fh.0);
            Ok(())
        });
        reply.ok();
    }

    fn readdir(
        &self,
        _request: &Request,
        ino: INodeNo,
        _fh: FileHandle,
        offset: u64,
        mut reply: ReplyDirectory,
    ) {
        let listed = fenced(|| {
            self.operations.readdir(ino.0, offset, &mut |entry| {
                !reply.add(
                    INodeNo(entry.ino),
                    entry.next,
                    file_type(entry.kind),
                    entry.name,
                )
            })
        });
        match listed {
            Ok(()) => reply.ok(),
            Err(error) => reply.error(number(&error)),
        }
    }

    fn fsyncdir(
        &self,
        _request: &Request,
        _ino: INodeNo,
        _fh: FileHandle,
        _datasync: bool,
        reply: ReplyEmpty,
    ) {
        reply.ok();
    }

    fn statfs(&self, _request: &Request, _ino: INodeNo, reply: ReplyStatfs) {
        match fenced(|| Ok(self.operations.statfs())) {
            Ok(StatFs { files, name_max }) => reply.statfs(0, 0, 0, files, 0, 4096, name_max, 4096),
            Err(error) => reply.error(number(&error)),
        }
    }

    fn setxattr(
        &self,
        _request: &Request,
        _ino: INodeNo,
        _name: &OsStr,
        _value: &[u8],
        _flags: i32,
        _position: u32,
        reply: ReplyEmpty,
    ) {
        reply.error(number(&Error::Unsupported));
    }

    fn getxattr(
        &self,
        _request: &Request,
        ino: INodeNo,
        name: &OsStr,
        size: u32,
        reply: ReplyXattr,
    ) {
        give_attribute(
            fenced(|| self.operations.getxattr(ino.0, name.as_bytes())),
            size,
            reply,
        );
    }

    fn listxattr(&self, _request: &Request, ino: INodeNo, size: u32, reply: ReplyXattr) {
        give_attribute(fenced(|| self.operations.listxattr(ino.0)), size, reply);
    }

    fn removexattr(&self, _request: &Request, _ino: INodeNo, _name: &OsStr, reply: ReplyEmpty) {
        reply.error(number(&Error::Unsupported));
    }

    fn ioctl(
        &self,
        _request: &Request,
        _ino: INodeNo,
        _fh: FileHandle,
        _flags: IoctlFlags,
        _cmd: u32,
        _data: &[u8],
        _out_size: u32,
        reply: ReplyIoctl,
    ) {
        reply.error(number(&Error::NoControl));
    }

    fn poll(
        &self,
        _request: &Request,
        ino: INodeNo,
        fh: FileHandle,
        notifier: PollNotifier,
        events: PollEvents,
        _flags: PollFlags,
        reply: ReplyPoll,
    ) {
        let handle = PollHandle(notifier.handle().0);
        match fenced(|| self.operations.poll(ino.0, fh.0, handle, events.bits())) {
            Ok(ready) => reply.poll(PollEvents::from_bits_retain(ready)),
            Err(error) => reply.error(number(&error)),
        }
    }
}

#[cfg(test)]
mod tests {
    crate::transport::native::tests::bodies::instantiate!(super::serve);
}
