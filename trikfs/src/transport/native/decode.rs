//! Bytes of one request to a typed request, borrowing names and data from them.
//!
//! Pure: no system call, no allocation. The kernel is trusted no more than any other input: every length is checked.

use super::abi::{self, fattr, op};
use crate::errno::Error;

/// What is common to all requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Header {
    /// Which request; needed to answer it.
    pub(crate) opcode: u32,
    /// Number of the request.
    pub(crate) unique: u64,
    /// The file it is about.
    pub(crate) node: u64,
    /// Effective user of the caller.
    pub(crate) uid: u32,
    /// Effective group of the caller.
    pub(crate) gid: u32,
    /// Thread of the caller, 0 if it is not visible from here.
    pub(crate) pid: u32,
}

/// A decoded request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Request<'a> {
    pub(crate) header: Header,
    pub(crate) body: Body<'a>,
}

/// What the kernel says of itself in INIT.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct KernelInit {
    pub(crate) major: u32,
    pub(crate) minor: u32,
    pub(crate) max_readahead: u32,
    /// Features on offer; `flags2` in the upper half.
    pub(crate) flags: u64,
}

/// The parts of each request that are used here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Body<'a> {
    Init(KernelInit),
    Lookup {
        name: &'a [u8],
    },
    Forget,
    GetAttr,
    SetAttr {
        fh: Option<u64>,
        size: Option<u64>,
        other: bool,
    },
    Open {
        flags: u32,
    },
    Read {
        fh: u64,
        offset: u64,
        size: u32,
        flags: u32,
        /// For the page cache.
        paged: bool,
    },
    Write {
        fh: u64,
        offset: u64,
        flags: u32,
        data: &'a [u8],
    },
    Poll {
        fh: u64,
        handle: u64,
        events: u32,
    },
    Interrupt {
        unique: u64,
    },
    Release {
        fh: u64,
    },
    Flush {
        fh: u64,
    },
    Fsync {
        fh: u64,
    },
    OpenDir,
    ReadDir {
        offset: u64,
        size: u32,
    },
    /// RELEASEDIR and FSYNCDIR: nothing to do.
    Nothing,
    StatFs,
    GetXattr {
        name: &'a [u8],
        size: u32,
    },
    ListXattr {
        size: u32,
    },
    /// Answer to a notification: the message that wakes the reader when the session is to end.
    NotifyReply,
    Destroy,
    /// An operation that this filesystem does not have, with the answer to it.
    Refused(Error),
}

/// A request that means nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Malformed {
    /// The request to answer with an error, if that much could be read.
    pub(crate) unique: Option<u64>,
    /// What is wrong: lower case, no trailing stop.
    pub(crate) reason: &'static str,
}

/// A cursor over fields in the machine's byte order.
struct Fields<'a> {
    rest: &'a [u8],
}

type Decoded<T> = Result<T, &'static str>;

impl<'a> Fields<'a> {
    fn take<const N: usize>(&mut self) -> Decoded<[u8; N]> {
        let (first, rest) = self
            .rest
            .split_first_chunk::<N>()
            .ok_or("shorter than its structure")?;
        self.rest = rest;
        Ok(*first)
    }

    fn u32(&mut self) -> Decoded<u32> {
        self.take().map(u32::from_ne_bytes)
    }

    fn u64(&mut self) -> Decoded<u64> {
        self.take().map(u64::from_ne_bytes)
    }

    fn skip<const N: usize>(&mut self) -> Decoded<()> {
        self.take::<N>().map(drop)
    }

    /// A name ended by a zero byte.
    fn name(&mut self) -> Decoded<&'a [u8]> {
        let end = self
            .rest
            .iter()
            .position(|&b| b == 0)
            .ok_or("a name without an end")?;
        let (name, rest) = self.rest.split_at(end);
        self.rest = rest.get(1..).unwrap_or_default();
        if name.is_empty() {
            Err("an empty name")
        } else {
            Ok(name)
        }
    }
}

/// Decodes the bytes of one read from the device.
pub(crate) fn decode(bytes: &[u8]) -> Result<Request<'_>, Malformed> {
    let mut fields = Fields { rest: bytes };
    let (header, length) = header(&mut fields).map_err(|reason| Malformed {
        unique: None,
        reason,
    })?;
    let of_this_request = |reason| Malformed {
        unique: Some(header.unique),
        reason,
    };
    if usize::try_from(length) != Ok(bytes.len()) {
        return Err(of_this_request(
            "the length in the header is not that of the message",
        ));
    }
    let body = body(header.opcode, &mut fields).map_err(of_this_request)?;
    Ok(Request { header, body })
}

/// `fuse_in_header`: len, opcode, unique, nodeid, uid, gid, pid, total_extlen and padding.
fn header(fields: &mut Fields<'_>) -> Decoded<(Header, u32)> {
    let length = fields.u32()?;
    let header = Header {
        opcode: fields.u32()?,
        unique: fields.u64()?,
        node: fields.u64()?,
        uid: fields.u32()?,
        gid: fields.u32()?,
        pid: fields.u32()?,
    };
    fields.skip::<4>()?;
    Ok((header, length))
}

fn body<'a>(opcode: u32, fields: &mut Fields<'a>) -> Decoded<Body<'a>> {
    Ok(match opcode {
        op::READ => read(fields)?,
        op::WRITE => write(fields)?,
        op::POLL => poll(fields)?,
        op::LOOKUP => Body::Lookup {
            name: fields.name()?,
        },
        op::FORGET | op::BATCH_FORGET => Body::Forget,
        op::GETATTR => Body::GetAttr,
        op::SETATTR => set_attr(fields)?,
        // fuse_open_in: flags, open_flags.
        op::OPEN => Body::Open {
            flags: fields.u32()?,
        },
        op::INTERRUPT => Body::Interrupt {
            unique: fields.u64()?,
        },
        // fuse_release_in, fuse_flush_in, fuse_fsync_in: fh first.
        op::RELEASE => Body::Release { fh: fields.u64()? },
        op::FLUSH => Body::Flush { fh: fields.u64()? },
        op::FSYNC => Body::Fsync { fh: fields.u64()? },
        op::OPENDIR => Body::OpenDir,
        op::READDIR => match read(fields)? {
            Body::Read { offset, size, .. } => Body::ReadDir { offset, size },
            other => other,
        },
        op::RELEASEDIR | op::FSYNCDIR => Body::Nothing,
        op::STATFS => Body::StatFs,
        op::GETXATTR => {
            let size = fields.u32()?;
            fields.skip::<4>()?;
            Body::GetXattr {
                size,
                name: fields.name()?,
            }
        }
        op::LISTXATTR => Body::ListXattr {
            size: fields.u32()?,
        },
        op::INIT => Body::Init(init(fields)?),
        op::NOTIFY_REPLY => Body::NotifyReply,
        op::DESTROY => Body::Destroy,
        _ => Body::Refused(refusal(opcode)),
    })
}

/// The answer to an operation that this filesystem does not have. ENOSYS tells the kernel not to ask again,
/// and to do without (SEEK_HOLE, copy_file_range, access under default_permissions).
fn refusal(opcode: u32) -> Error {
    match opcode {
        op::MKDIR
        | op::MKNOD
        | op::UNLINK
        | op::RMDIR
        | op::RENAME
        | op::RENAME2
        | op::LINK
        | op::SYMLINK
        | op::CREATE => Error::NotPermitted,
        op::SETXATTR | op::REMOVEXATTR => Error::Unsupported,
        op::IOCTL => Error::NoControl,
        _ => Error::NotNeeded,
    }
}

/// `fuse_init_in`: major, minor, max_readahead, flags; since 7.36 flags2 and eleven unused words.
/// A kernel of another major version is only promised to have the first two.
fn init(fields: &mut Fields<'_>) -> Decoded<KernelInit> {
    let (major, minor) = (fields.u32()?, fields.u32()?);
    if major != abi::MAJOR {
        return Ok(KernelInit {
            major,
            minor,
            ..KernelInit::default()
        });
    }
    let (max_readahead, low) = (fields.u32()?, u64::from(fields.u32()?));
    let high = if low & abi::init::INIT_EXT != 0 {
        fields.u32()?
    } else {
        0
    };
    Ok(KernelInit {
        major,
        minor,
        max_readahead,
        flags: low | u64::from(high) << 32,
    })
}

/// `fuse_read_in`: fh, offset, size, read_flags, lock_owner, flags, padding.
fn read<'a>(fields: &mut Fields<'a>) -> Decoded<Body<'a>> {
    let (fh, offset, size) = (fields.u64()?, fields.u64()?, fields.u32()?);
    let read_flags = fields.u32()?;
    fields.skip::<8>()?;
    let flags = fields.u32()?;
    Ok(Body::Read {
        fh,
        offset,
        size,
        flags,
        // The page cache has no owner; a read(2) always has one.
        paged: read_flags & abi::READ_LOCKOWNER == 0,
    })
}

/// `fuse_write_in`: fh, offset, size, write_flags, lock_owner, flags, padding; then the data.
fn write<'a>(fields: &mut Fields<'a>) -> Decoded<Body<'a>> {
    let (fh, offset, size) = (fields.u64()?, fields.u64()?, fields.u32()?);
    fields.skip::<12>()?;
    let flags = fields.u32()?;
    fields.skip::<4>()?;
    if usize::try_from(size) != Ok(fields.rest.len()) {
        return Err("a write whose size is not that of its data");
    }
    Ok(Body::Write {
        fh,
        offset,
        flags,
        data: fields.rest,
    })
}

/// `fuse_poll_in`: fh, kh, flags, events. Whether somebody waits (SCHEDULE_NOTIFY) is of no use: an edge-triggered
/// epoll does not ask again after a positive answer, so every change is notified.
fn poll<'a>(fields: &mut Fields<'a>) -> Decoded<Body<'a>> {
    let (fh, handle) = (fields.u64()?, fields.u64()?);
    fields.skip::<4>()?;
    Ok(Body::Poll {
        fh,
        handle,
        events: fields.u32()?,
    })
}

/// `fuse_setattr_in`: valid, padding, fh, size, ...
/// truncate(2) brings times along; they follow from it and ask for nothing of their own.
fn set_attr<'a>(fields: &mut Fields<'a>) -> Decoded<Body<'a>> {
    let valid = fields.u32()?;
    fields.skip::<4>()?;
    let (fh, size) = (fields.u64()?, fields.u64()?);
    let has = |bits: u32| valid & bits != 0;
    Ok(Body::SetAttr {
        fh: has(fattr::FH).then_some(fh),
        size: has(fattr::SIZE).then_some(size),
        other: has(fattr::MODE | fattr::UID | fattr::GID)
            || has(fattr::ATIME | fattr::MTIME) && !has(fattr::SIZE),
    })
}

#[cfg(test)]
mod tests;
