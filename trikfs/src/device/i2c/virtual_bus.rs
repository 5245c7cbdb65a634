//! A bus as a Unix socket: each transaction is one packet there and one back, with the bytes of the wire.
//!
//! Owns the packets. Request: version 1, flags 0, address u16, length of what is written u16, length of what is read
//! u16, then the written bytes. Answer: errno i32 (0 is fine), then the bytes read. All numbers are little-endian.

use super::bus::{Failure, Time};
use super::{Data, Transfer};
use crate::limits;
use nix::sys::socket::{
    AddressFamily, MsgFlags, SockFlag, SockType, UnixAddr, connect, recv, send, setsockopt, socket,
    sockopt,
};
use nix::sys::time::{TimeVal, TimeValLike};
use std::os::fd::{AsFd, AsRawFd, OwnedFd};
use std::path::Path;
use std::time::{Duration, Instant};

const VERSION: u8 = 1;
const REQUEST_BYTES: usize = 8;
const ANSWER_BYTES: usize = 4;

pub(super) struct VirtualBus {
    socket: OwnedFd,
    /// What the kernel was told.
    timeout: Duration,
    request: Vec<u8>,
    answer: Vec<u8>,
}

fn io(errno: nix::Error) -> std::io::Error {
    std::io::Error::from(errno)
}

impl VirtualBus {
    pub(super) fn open(path: &Path, timeout: Duration) -> Result<Self, Failure> {
        let gone = |errno| Failure::Gone(io(errno));
        let socket = socket(
            AddressFamily::Unix,
            SockType::SeqPacket,
            SockFlag::SOCK_CLOEXEC,
            None,
        )
        .map_err(gone)?;
        let mut bus = Self {
            socket,
            timeout: Duration::ZERO,
            request: Vec::new(),
            answer: Vec::new(),
        };
        // The time limit holds for connect(2) as well, when the other side takes nobody in.
        bus.limit(timeout).map_err(gone)?;
        let address = UnixAddr::new(path).map_err(gone)?;
        match connect(bus.socket.as_raw_fd(), &address) {
            Ok(()) => Ok(bus),
            Err(nix::Error::EAGAIN | nix::Error::EINTR) => Err(Failure::Silent),
            Err(errno) => Err(gone(errno)),
        }
    }

    fn limit(&mut self, timeout: Duration) -> nix::Result<()> {
        // Zero would mean no limit. A coarse value is told to the kernel once and not at every transfer.
        let timeout = Duration::from_millis(
            u64::try_from(timeout.as_millis())
                .unwrap_or(u64::MAX)
                .max(1),
        );
        if timeout == self.timeout {
            return Ok(());
        }
        // The fields of the two kernels' structures differ in size; limits of a configuration fit both.
        let value = TimeVal::microseconds(i64::try_from(timeout.as_micros()).unwrap_or(i64::MAX));
        setsockopt(&self.socket.as_fd(), sockopt::SendTimeout, &value)?;
        setsockopt(&self.socket.as_fd(), sockopt::ReceiveTimeout, &value)?;
        self.timeout = timeout;
        Ok(())
    }

    pub(super) fn transfer(
        &mut self,
        transfer: &mut Transfer<'_>,
        time: Time,
    ) -> Result<(), Failure> {
        self.limit(time.limit)
            .map_err(|errno| Failure::Errno(errno as i32))?;
        let read_len = encode(transfer, &mut self.request)?;
        // An answer that nobody waits for would be taken for that of this request, and all others for that of the next.
        let stray = recv(
            self.socket.as_raw_fd(),
            &mut [0],
            MsgFlags::MSG_DONTWAIT | MsgFlags::MSG_PEEK,
        );
        if stray.is_ok() {
            return Err(Failure::Lost);
        }
        self.send(time.deadline)?;
        self.answer.resize(ANSWER_BYTES + read_len + 1, 0);
        let size = loop {
            match recv(self.socket.as_raw_fd(), &mut self.answer, MsgFlags::empty()) {
                Ok(0) => return Err(Failure::Lost),
                Ok(size) => break size,
                Err(nix::Error::EINTR) if Instant::now() < time.deadline => {}
                Err(nix::Error::EINTR | nix::Error::EAGAIN) => return Err(Failure::Silent),
                Err(_) => return Err(Failure::Lost),
            }
        };
        let answer = self.answer.get(..size).unwrap_or_default();
        decode(answer, transfer)
    }

    fn send(&self, deadline: Instant) -> Result<(), Failure> {
        loop {
            match send(
                self.socket.as_raw_fd(),
                &self.request,
                MsgFlags::MSG_NOSIGNAL,
            ) {
                Ok(_) => return Ok(()),
                Err(nix::Error::EINTR) if Instant::now() < deadline => {}
                Err(nix::Error::EINTR | nix::Error::EAGAIN) => return Err(Failure::Silent),
                Err(errno) => return Err(Failure::Gone(io(errno))),
            }
        }
    }
}

/// The packet of a request; gives the number of bytes that are to come back.
fn encode(transfer: &Transfer<'_>, packet: &mut Vec<u8>) -> Result<usize, Failure> {
    let (written, read): (&[u8], usize) = match &transfer.data {
        Data::Read(data) => (&[], data.len()),
        Data::Write(data) => (data, 0),
    };
    let length = |bytes: usize| u16::try_from(bytes).map_err(|_| Failure::Unfit);
    packet.clear();
    packet.extend_from_slice(&[VERSION, 0]);
    packet.extend_from_slice(&transfer.address.to_le_bytes());
    packet.extend_from_slice(&length(transfer.register.len() + written.len())?.to_le_bytes());
    packet.extend_from_slice(&length(read)?.to_le_bytes());
    debug_assert_eq!(packet.len(), REQUEST_BYTES);
    packet.extend_from_slice(transfer.register);
    packet.extend_from_slice(written);
    Ok(read)
}

fn decode(answer: &[u8], transfer: &mut Transfer<'_>) -> Result<(), Failure> {
    let Some((errno, bytes)) = answer.split_first_chunk::<ANSWER_BYTES>() else {
        return Err(Failure::Garbage(format!(
            "an answer of {} bytes",
            answer.len()
        )));
    };
    match i32::from_le_bytes(*errno) {
        0 => {}
        errno @ 1..=limits::ERRNO_MAX => return Err(Failure::Errno(errno)),
        other => return Err(Failure::Garbage(format!("an answer with errno {other}"))),
    }
    let wanted = match &transfer.data {
        Data::Read(data) => data.len(),
        Data::Write(_) => 0,
    };
    if bytes.len() != wanted {
        return Err(Failure::Garbage(format!(
            "an answer with other than {wanted} bytes of data"
        )));
    }
    if let Data::Read(data) = &mut transfer.data {
        data.copy_from_slice(bytes);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::description::I2cTransfer;

    fn transfer<'a>(register: &'a [u8], data: Data<'a>) -> Transfer<'a> {
        Transfer {
            address: 0x48,
            kind: I2cTransfer::Word,
            register,
            data,
        }
    }

    #[test]
    fn a_request_is_laid_out_as_agreed() {
        let mut packet = Vec::new();
        let mut buf = [0; 2];
        let read = encode(&transfer(&[0x25], Data::Read(&mut buf)), &mut packet);
        assert_eq!(read.ok(), Some(2));
        assert_eq!(packet, [1, 0, 0x48, 0, 1, 0, 2, 0, 0x25]);
        let read = encode(&transfer(&[0x24, 0], Data::Write(&[7, 8])), &mut packet);
        assert_eq!(read.ok(), Some(0));
        assert_eq!(packet, [1, 0, 0x48, 0, 4, 0, 0, 0, 0x24, 0, 7, 8]);
        let long = vec![0; 65_535];
        let refused = encode(&transfer(&[1], Data::Write(&long)), &mut packet);
        assert!(matches!(refused, Err(Failure::Unfit)));
    }

    #[test]
    fn an_answer_that_means_nothing_is_no_sample() {
        let answers: [&[u8]; 6] = [
            &[],
            &[0, 0, 0],
            &[0, 0, 0, 0, 1],
            &[0, 0, 0, 0, 1, 2, 3],
            &[0xff, 0xff, 0xff, 0xff],
            &[0, 0x10, 0, 0],
        ];
        for answer in answers {
            let mut buf = [9; 2];
            let result = decode(answer, &mut transfer(&[1], Data::Read(&mut buf)));
            assert!(matches!(result, Err(Failure::Garbage(_))), "{answer:?}");
            assert_eq!(buf, [9, 9], "{answer:?}");
        }
        let mut buf = [0; 2];
        let nack = decode(&[6, 0, 0, 0], &mut transfer(&[1], Data::Read(&mut buf)));
        assert!(matches!(nack, Err(Failure::Errno(libc::ENXIO))));
        let good = decode(
            &[0, 0, 0, 0, 1, 2],
            &mut transfer(&[1], Data::Read(&mut buf)),
        );
        assert!(good.is_ok() && buf == [1, 2]);
    }
}
