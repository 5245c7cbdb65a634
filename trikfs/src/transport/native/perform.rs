//! One decoded request to one operation of the filesystem, and its outcome into the reply buffer.
//!
//! Owns the mapping between the two; sends nothing and knows no descriptor, so it is tested without a mount.

use super::decode::{Body, Header, Request};
use super::encode;
use super::negotiate::Features;
use crate::errno::Error;
use crate::transport::{Caller, Operations, Outcome, PollHandle, RequestId, Transfer};

/// What to do about a request whose operation has run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Performed {
    /// So many bytes of the buffer are the answer.
    Reply(usize),
    /// The file was opened; as `Reply`, but if nobody takes the answer the file must be released again.
    Opened {
        /// Bytes of the answer.
        bytes: usize,
        /// What to release.
        fh: u64,
    },
    /// Answer with the errno of this.
    Refuse(Error),
    /// The filesystem answers later.
    Wait,
    /// Nobody waits for an answer.
    Silent,
}

/// Runs the operation of a request. `out` is where the answer goes; it takes any answer of fixed size (128 bytes)
/// and as much of a read as fits. INIT, INTERRUPT and DESTROY are the session's own and not for here.
pub(crate) fn perform(
    operations: &dyn Operations,
    features: &Features,
    request: &Request<'_>,
    out: &mut [u8],
) -> Performed {
    try_perform(operations, features, request, out).unwrap_or_else(Performed::Refuse)
}

fn try_perform(
    operations: &dyn Operations,
    features: &Features,
    request: &Request<'_>,
    out: &mut [u8],
) -> Result<Performed, Error> {
    let header = &request.header;
    let (node, id) = (header.node, RequestId(header.unique));
    Ok(match request.body {
        Body::Read {
            fh,
            offset,
            size,
            flags,
            paged,
        } => {
            let room = out.len().min(size as usize);
            let transfer = Transfer {
                paged,
                ..transfer(header, fh, offset, flags)
            };
            let read = operations.read(&transfer, &mut out[..room])?;
            done(read, room)?
        }
        Body::Write {
            fh,
            offset,
            flags,
            data,
        } => match operations.write(&transfer(header, fh, offset, flags), data)? {
            Outcome::Done(taken) if taken > data.len() => return Err(too_much()),
            Outcome::Done(taken) => reply(out, &encode::number(taken as u32)),
            Outcome::Wait => Performed::Wait,
        },
        Body::Poll { fh, handle, events } => {
            let ready = operations.poll(node, fh, PollHandle(handle), events)?;
            reply(out, &encode::number(ready))
        }
        Body::Lookup { name } => reply(out, &encode::entry(&operations.lookup(node, name)?)),
        Body::GetAttr => reply(out, &encode::attributes(&operations.getattr(node)?)),
        Body::SetAttr { fh, size, other } => {
            let attr = operations.setattr(node, fh, size, other)?;
            reply(out, &encode::attributes(&attr))
        }
        Body::Open { flags } => {
            let opened = operations.open(node, flags.cast_signed(), caller(header))?;
            let body = encode::opened(opened.fh, features.open_flags(&opened));
            reply(out, &body);
            Performed::Opened {
                bytes: body.len(),
                fh: opened.fh,
            }
        }
        Body::Release { fh } => {
            operations.release(node, fh);
            Performed::Reply(0)
        }
        Body::Flush { fh } => done(operations.flush(id, node, fh, caller(header))?, 0)?,
        Body::Fsync { fh } => done(operations.fsync(id, node, fh, caller(header))?, 0)?,
        Body::OpenDir => reply(out, &encode::opened(0, 0)),
        Body::ReadDir { offset, size } => {
            Performed::Reply(read_directory(operations, node, offset, size, out)?)
        }
        Body::Nothing => Performed::Reply(0),
        Body::StatFs => reply(out, &encode::statfs(&operations.statfs())),
        Body::GetXattr { name, size } => attribute(&operations.getxattr(node, name)?, size, out)?,
        Body::ListXattr { size } => attribute(&operations.listxattr(node)?, size, out)?,
        Body::Refused(ref why) => Performed::Refuse(why.clone()),
        Body::Forget
        | Body::NotifyReply
        | Body::Init(_)
        | Body::Interrupt { .. }
        | Body::Destroy => Performed::Silent,
    })
}

fn caller(header: &Header) -> Caller {
    Caller {
        uid: header.uid,
        gid: header.gid,
        pid: header.pid,
    }
}

fn transfer(header: &Header, fh: u64, offset: u64, flags: u32) -> Transfer {
    let flags = flags.cast_signed();
    Transfer {
        id: RequestId(header.unique),
        ino: header.node,
        fh,
        offset,
        nonblocking: flags & libc::O_NONBLOCK != 0,
        append: flags & libc::O_APPEND != 0,
        paged: false,
        caller: caller(header),
    }
}

/// An answer that was written into the buffer already, at most `room` bytes of it. For flush and fsync, whose success
/// has nothing to say, `room` is 0 and so is the answer.
fn done(outcome: Outcome, room: usize) -> Result<Performed, Error> {
    match outcome {
        Outcome::Wait => Ok(Performed::Wait),
        Outcome::Done(_) if room == 0 => Ok(Performed::Reply(0)),
        Outcome::Done(bytes) if bytes <= room => Ok(Performed::Reply(bytes)),
        Outcome::Done(_) => Err(too_much()),
    }
}

fn too_much() -> Error {
    Error::Internal("an operation claims more bytes than it was given".into())
}

/// Copies an answer of fixed size.
fn reply(out: &mut [u8], body: &[u8]) -> Performed {
    match out.get_mut(..body.len()) {
        Some(place) => {
            place.copy_from_slice(body);
            Performed::Reply(body.len())
        }
        None => Performed::Refuse(too_much()),
    }
}

fn read_directory(
    operations: &dyn Operations,
    node: u64,
    from: u64,
    size: u32,
    out: &mut [u8],
) -> Result<usize, Error> {
    let room = out.len().min(size as usize);
    let mut used = 0;
    operations.readdir(node, from, &mut |entry| match encode::directory_entry(
        &mut out[used..room],
        &entry,
    ) {
        Some(bytes) => {
            used += bytes;
            true
        }
        None => false,
    })?;
    Ok(used)
}

/// The value of an extended attribute, or its length when the caller asks with a size of zero.
fn attribute(value: &[u8], size: u32, out: &mut [u8]) -> Result<Performed, Error> {
    if size == 0 {
        return Ok(reply(out, &encode::number(value.len() as u32)));
    }
    if value.len() > size as usize || value.len() > out.len() {
        return Err(Error::BufferTooSmall);
    }
    Ok(reply(out, value))
}
