//! Bytes of one request to a typed request, borrowing names and data from them.
//!
//! Pure: no system call, no allocation. The kernel is trusted no more than any other input: every length is checked.

use super::abi::{self, fattr, op};

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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    Refused(i32),
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
fn refusal(opcode: u32) -> i32 {
    match opcode {
        op::MKDIR
        | op::MKNOD
        | op::UNLINK
        | op::RMDIR
        | op::RENAME
        | op::RENAME2
        | op::LINK
        | op::SYMLINK
        | op::CREATE => libc::EPERM,
        op::SETXATTR | op::REMOVEXATTR => libc::EOPNOTSUPP,
        // What a regular file answers; kernels before 6.0 would show the program an ENOSYS.
        op::IOCTL => libc::ENOTTY,
        _ => libc::ENOSYS,
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
    fields.skip::<12>()?;
    let flags = fields.u32()?;
    Ok(Body::Read {
        fh,
        offset,
        size,
        flags,
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
mod tests {
    use super::*;

    /// A message with the right length in its header.
    fn message(opcode: u32, body: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        bytes.extend(
            u32::try_from(abi::IN_HEADER + body.len())
                .unwrap()
                .to_ne_bytes(),
        );
        bytes.extend(opcode.to_ne_bytes());
        bytes.extend(7_u64.to_ne_bytes());
        bytes.extend(2_u64.to_ne_bytes());
        for word in [1000_u32, 100, 4242, 0] {
            bytes.extend(word.to_ne_bytes());
        }
        bytes.extend(body);
        bytes
    }

    fn words(values: &[u32]) -> Vec<u8> {
        values.iter().flat_map(|v| v.to_ne_bytes()).collect()
    }

    fn reason(bytes: &[u8]) -> &'static str {
        decode(bytes).unwrap_err().reason
    }

    #[test]
    fn the_header_is_read() {
        let bytes = message(op::GETATTR, &[0; 16]);
        let request = decode(&bytes).unwrap();
        let header = Header {
            opcode: op::GETATTR,
            unique: 7,
            node: 2,
            uid: 1000,
            gid: 100,
            pid: 4242,
        };
        assert_eq!(
            request,
            Request {
                header,
                body: Body::GetAttr
            }
        );
    }

    #[test]
    fn a_read_carries_position_size_and_open_flags() {
        let mut body = Vec::new();
        body.extend(9_u64.to_ne_bytes());
        body.extend(4096_u64.to_ne_bytes());
        body.extend(words(&[64, 0, 0, 0, 0o4000, 0]));
        let bytes = message(op::READ, &body);
        let expected = Body::Read {
            fh: 9,
            offset: 4096,
            size: 64,
            flags: 0o4000,
        };
        assert_eq!(decode(&bytes).unwrap().body, expected);
        let bytes = message(op::READDIR, &body);
        assert_eq!(
            decode(&bytes).unwrap().body,
            Body::ReadDir {
                offset: 4096,
                size: 64
            }
        );
    }

    #[test]
    fn a_write_must_be_as_long_as_it_says() {
        let mut body = vec![0; 16];
        body.extend(words(&[3, 0, 0, 0, 0, 0]));
        body.extend(b"abc");
        let bytes = message(op::WRITE, &body);
        assert!(matches!(
            decode(&bytes).unwrap().body,
            Body::Write { data: b"abc", .. }
        ));
        body.push(0);
        let bytes = message(op::WRITE, &body);
        assert_eq!(reason(&bytes), "a write whose size is not that of its data");
    }

    #[test]
    fn old_and_new_kernels_introduce_themselves() {
        let bytes = message(op::INIT, &words(&[7, 26, 131_072, 0x1f_ffff]));
        let old = KernelInit {
            major: 7,
            minor: 26,
            max_readahead: 131_072,
            flags: 0x1f_ffff,
        };
        assert_eq!(decode(&bytes).unwrap().body, Body::Init(old));

        let mut new = vec![7, 45, 131_072, 1 << 30 | 1, 0x3f];
        new.extend([0; 11]);
        let bytes = message(op::INIT, &words(&new));
        let Body::Init(new) = decode(&bytes).unwrap().body else {
            panic!()
        };
        assert_eq!(new.flags, 0x3f_4000_0001);

        let bytes = message(op::INIT, &words(&[8, 0]));
        assert!(matches!(
            decode(&bytes).unwrap().body,
            Body::Init(KernelInit { major: 8, .. })
        ));
        assert_eq!(
            reason(&message(op::INIT, &words(&[7, 36, 0, 1 << 30]))),
            "shorter than its structure"
        );
    }

    #[test]
    fn names_must_end_and_not_be_empty() {
        let bytes = message(op::LOOKUP, b"mouse\0");
        assert_eq!(
            decode(&bytes).unwrap().body,
            Body::Lookup { name: b"mouse" }
        );
        assert_eq!(
            reason(&message(op::LOOKUP, b"mouse")),
            "a name without an end"
        );
        assert_eq!(reason(&message(op::LOOKUP, b"\0")), "an empty name");
        let bytes = message(op::GETXATTR, b"\x40\0\0\0\0\0\0\0user.a\0");
        let expected = Body::GetXattr {
            name: b"user.a",
            size: u32::from_ne_bytes([0x40, 0, 0, 0]),
        };
        assert_eq!(decode(&bytes).unwrap().body, expected);
    }

    #[test]
    fn truncate_is_told_from_chmod_and_touch() {
        let set = |valid: u32| {
            let mut body = words(&[valid, 0]);
            body.extend([0; 80]);
            let bytes = message(op::SETATTR, &body);
            match decode(&bytes).unwrap().body {
                Body::SetAttr { size, other, .. } => (size.is_some(), other),
                other => panic!("{other:?}"),
            }
        };
        let (mtime_now, ctime) = (1 << 8, 1 << 10);
        assert_eq!(set(fattr::SIZE), (true, false));
        assert_eq!(
            set(fattr::SIZE | fattr::MTIME | mtime_now | ctime),
            (true, false)
        );
        assert_eq!(set(fattr::MODE), (false, true));
        assert_eq!(set(fattr::SIZE | fattr::UID), (true, true));
        assert_eq!(set(fattr::ATIME | fattr::MTIME | mtime_now), (false, true));
    }

    #[test]
    fn operations_that_change_names_are_not_permitted() {
        for opcode in [
            op::MKDIR,
            op::MKNOD,
            op::UNLINK,
            op::RMDIR,
            op::RENAME,
            op::RENAME2,
            op::LINK,
            op::SYMLINK,
            op::CREATE,
        ] {
            let bytes = message(opcode, b"x\0");
            assert_eq!(decode(&bytes).unwrap().body, Body::Refused(libc::EPERM));
        }
        for (opcode, errno) in [
            (op::SETXATTR, libc::EOPNOTSUPP),
            (op::IOCTL, libc::ENOTTY),
            (46, libc::ENOSYS),
            (9999, libc::ENOSYS),
        ] {
            let bytes = message(opcode, &[]);
            assert_eq!(decode(&bytes).unwrap().body, Body::Refused(errno));
        }
    }

    #[test]
    fn every_cut_of_a_message_is_refused_with_its_number() {
        let whole = message(op::SETATTR, &[0; 88]);
        for length in 0..whole.len() {
            let mut cut = whole[..length].to_vec();
            let unique = decode(&cut).unwrap_err().unique;
            assert_eq!(
                unique,
                (length >= abi::IN_HEADER).then_some(7),
                "{length} bytes"
            );
            if length >= abi::IN_HEADER {
                // With an honest length only the fields that are used have to be there.
                cut[..4].copy_from_slice(&u32::try_from(length).unwrap().to_ne_bytes());
                assert_eq!(
                    decode(&cut).is_ok(),
                    length >= abi::IN_HEADER + 24,
                    "{length} bytes"
                );
            }
        }
    }
}
