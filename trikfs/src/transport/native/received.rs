//! A descriptor that another process sends over a socket: how `fusermount3` hands over the device it has mounted.
//!
//! Owns the one conversion of a received descriptor number into an owned descriptor. Knows nothing of mounting.

use nix::cmsg_space;
use nix::sys::socket::{ControlMessageOwned, MsgFlags, recvmsg};
use std::io::{self, IoSliceMut};
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd, RawFd};
use std::os::unix::net::UnixStream;

/// Waits for one message with exactly one descriptor. The descriptor is closed on exec.
///
/// # Errors
/// `UnexpectedEof` if the other side closed without sending one; `InvalidData` if it sent several.
pub fn receive_descriptor(socket: &UnixStream) -> io::Result<OwnedFd> {
    let mut byte = [0_u8; 1];
    let mut space = cmsg_space!([RawFd; 4]);
    let mut slices = [IoSliceMut::new(&mut byte)];
    let received = loop {
        let flags = MsgFlags::MSG_CMSG_CLOEXEC;
        match recvmsg::<()>(socket.as_raw_fd(), &mut slices, Some(&mut space), flags) {
            Err(nix::errno::Errno::EINTR) => {}
            other => break other?,
        }
    };
    let mut descriptors = Vec::new();
    for message in received.cmsgs()? {
        if let ControlMessageOwned::ScmRights(numbers) = message {
            for number in numbers {
                // SAFETY: recvmsg has just made this descriptor for us (SCM_RIGHTS) and nobody else knows its number.
                descriptors.push(unsafe { OwnedFd::from_raw_fd(number) });
            }
        }
    }
    match (descriptors.pop(), descriptors.is_empty()) {
        (Some(descriptor), true) => Ok(descriptor),
        (None, _) => Err(io::ErrorKind::UnexpectedEof.into()),
        (Some(_), false) => Err(io::ErrorKind::InvalidData.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nix::sys::socket::{ControlMessage, sendmsg};
    use std::io::{IoSlice, Read, Write};

    fn send(socket: &UnixStream, descriptors: &[RawFd]) {
        let rights = [ControlMessage::ScmRights(descriptors)];
        sendmsg::<()>(
            socket.as_raw_fd(),
            &[IoSlice::new(b"x")],
            &rights,
            MsgFlags::empty(),
            None,
        )
        .unwrap();
    }

    #[test]
    fn a_sent_descriptor_is_the_same_file() {
        let (here, there) = UnixStream::pair().unwrap();
        let (mut payload, sent) = UnixStream::pair().unwrap();
        send(&there, &[sent.as_raw_fd()]);
        let mut received = UnixStream::from(receive_descriptor(&here).unwrap());
        payload.write_all(b"hello").unwrap();
        let mut bytes = [0; 5];
        received.read_exact(&mut bytes).unwrap();
        assert_eq!(&bytes, b"hello");
    }

    #[test]
    fn no_descriptor_and_two_descriptors_are_refused() {
        let (here, there) = UnixStream::pair().unwrap();
        send(&there, &[there.as_raw_fd(), here.as_raw_fd()]);
        assert_eq!(
            receive_descriptor(&here).unwrap_err().kind(),
            io::ErrorKind::InvalidData
        );
        (&there).write_all(b"x").unwrap();
        assert_eq!(
            receive_descriptor(&here).unwrap_err().kind(),
            io::ErrorKind::UnexpectedEof
        );
        drop(there);
        assert_eq!(
            receive_descriptor(&here).unwrap_err().kind(),
            io::ErrorKind::UnexpectedEof
        );
    }
}
