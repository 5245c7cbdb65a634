//! An I2C bus as a socket: one packet for each transaction, one answer for each packet.
//!
//! Request: u8 version = 1, u8 flags, u16 address, u16 bytes to write, u16 bytes to read, the bytes to write.
//! Flags: 0 is a transaction; 1 is a look with a probe at the register that is written (one byte), for tests and judges:
//! it takes no time on the bus, meets no fault, and sees registers that the bus cannot read back.
//! Answer: i32 Linux error number (0: fine), the bytes that were read. All numbers have the low byte first.
//! Owns connections and their time; what answers is the [`Machine`](crate::machine::Machine).
//! A client can harm only itself: packets have a limit, and one that does not take its answers is cut off.

use crate::errno;
use crate::limits::{MAX_CONNECTIONS, MAX_TRANSFER_BYTES};
use crate::machine::Outcome;
use crate::msp430;
use crate::shared::Shared;
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::eventfd::{EfdFlags, EventFd};
use nix::sys::socket::{
    AddressFamily, Backlog, MsgFlags, SockFlag, SockType, UnixAddr, bind, listen, recv, send,
    socket,
};
use std::fs::File;
use std::io;
use std::os::fd::{AsFd, AsRawFd};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

const VERSION: u8 = 1;
const PROBE: u8 = 1;
const HEADER_BYTES: usize = 8;
/// A fault that makes the bus slow may end while it waits.
const SLOW_SLICE_MS: u64 = 5;

/// One bus and its thread.
pub struct Bus {
    shared: Arc<Shared>,
    wake: Arc<EventFd>,
    thread: Option<JoinHandle<()>>,
}

impl Bus {
    /// Opens bus `number` at `path`; with `bits_per_second` a transaction takes the time of the real bus.
    pub fn start(
        number: u8,
        path: &Path,
        shared: Arc<Shared>,
        bits_per_second: Option<u32>,
    ) -> io::Result<Self> {
        let wake = EventFd::from_flags(EfdFlags::EFD_CLOEXEC | EfdFlags::EFD_NONBLOCK)?;
        let wake = Arc::new(wake);
        let mut line = Line {
            shared: Arc::clone(&shared),
            number,
            path: path.to_owned(),
            listener: Some(listen_at(path)?),
            clients: Vec::new(),
            wake: Arc::clone(&wake),
            bits_per_second,
        };
        let thread = std::thread::Builder::new()
            .name(format!("sim-i2c-{number}"))
            .spawn(move || line.run())?;
        Ok(Self {
            shared,
            wake,
            thread: Some(thread),
        })
    }

    /// Faults have changed, or the end has come.
    pub fn wake(&self) {
        let _ = self.wake.write(1);
    }
}

impl Drop for Bus {
    fn drop(&mut self) {
        self.shared.stop();
        self.wake();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// A socket at any path: sockets have room for 107 bytes of it, so it is named through its directory.
fn listen_at(path: &Path) -> io::Result<UnixListener> {
    let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else {
        return Err(io::ErrorKind::InvalidInput.into());
    };
    let folder = File::open(folder)?;
    let short = PathBuf::from(format!("/proc/self/fd/{}", folder.as_raw_fd())).join(name);
    let flags = SockFlag::SOCK_CLOEXEC | SockFlag::SOCK_NONBLOCK;
    let socket = socket(AddressFamily::Unix, SockType::SeqPacket, flags, None)?;
    bind(socket.as_raw_fd(), &UnixAddr::new(&short)?)?;
    listen(&socket, Backlog::new(64)?)?;
    Ok(UnixListener::from(socket))
}

/// What the thread works on.
struct Line {
    number: u8,
    path: PathBuf,
    listener: Option<UnixListener>,
    clients: Vec<UnixStream>,
    shared: Arc<Shared>,
    wake: Arc<EventFd>,
    bits_per_second: Option<u32>,
}

impl Line {
    fn run(&mut self) {
        let mut packet = vec![0; HEADER_BYTES + MAX_TRANSFER_BYTES];
        let mut answer = vec![0; 4 + MAX_TRANSFER_BYTES];
        while !self.shared.is_stopping() {
            self.plug();
            let ready = self.wait();
            // From the end, because those that leave are removed.
            for index in (0..self.clients.len()).rev() {
                let is_ready = ready.get(index).copied().unwrap_or(false);
                if is_ready && !self.serve(index, &mut packet, &mut answer) {
                    self.clients.swap_remove(index);
                }
            }
            self.accept();
        }
        let _ = std::fs::remove_file(&self.path);
    }

    /// Takes the bus away or brings it back, as its faults want it.
    fn plug(&mut self) {
        let is_unplugged = self.shared.machine().is_bus_unplugged(self.number);
        if is_unplugged && self.listener.is_some() {
            self.listener = None;
            self.clients.clear();
            let _ = std::fs::remove_file(&self.path);
        } else if !is_unplugged && self.listener.is_none() {
            // If somebody else took the name, the bus stays away.
            self.listener = listen_at(&self.path).ok();
        }
    }

    /// Sleeps until something happens; says which clients have sent something.
    fn wait(&self) -> Vec<bool> {
        let mut fds = Vec::with_capacity(self.clients.len() + 2);
        let watch = |fd| PollFd::new(fd, PollFlags::POLLIN);
        fds.extend(self.clients.iter().map(|client| watch(client.as_fd())));
        fds.push(watch(self.wake.as_fd()));
        fds.extend(self.listener.iter().map(|fd| watch(fd.as_fd())));
        let _ = poll(&mut fds, PollTimeout::NONE);
        let _ = self.wake.read();
        let clients = &fds[..self.clients.len()];
        clients.iter().map(|fd| fd.any() == Some(true)).collect()
    }

    fn accept(&mut self) {
        let Some(listener) = &self.listener else {
            return;
        };
        // Who finds the table full is closed at once and sees the end of the connection.
        while let Ok((client, _)) = listener.accept() {
            if self.clients.len() < MAX_CONNECTIONS && client.set_nonblocking(true).is_ok() {
                self.clients.push(client);
            }
        }
    }

    /// One packet of one client; false when the client is to go.
    fn serve(&mut self, index: usize, packet: &mut [u8], answer: &mut [u8]) -> bool {
        let fd = self.clients[index].as_raw_fd();
        let length = match recv(fd, packet, MsgFlags::MSG_TRUNC) {
            Ok(0) => return false,
            Ok(length) => length,
            Err(Errno::EAGAIN | Errno::EINTR) => return true,
            Err(_) => return false,
        };
        let length = match self.answer(packet, length, answer) {
            Some(length) => length,
            None => return true,
        };
        let flags = MsgFlags::MSG_DONTWAIT | MsgFlags::MSG_NOSIGNAL;
        send(self.clients[index].as_raw_fd(), &answer[..length], flags).is_ok()
    }

    /// Bytes of the answer, if there is one.
    fn answer(&self, packet: &[u8], length: usize, answer: &mut [u8]) -> Option<usize> {
        let request = match Request::parse(packet, length) {
            Ok(request) => request,
            Err(error) => {
                answer[..4].copy_from_slice(&error.to_le_bytes());
                return Some(4);
            }
        };
        if request.is_probe {
            return Some(self.probe(&request, answer));
        }
        let began = Instant::now();
        self.be_slow(request.address);
        let read = &mut answer[4..4 + request.read];
        let (outcome, bits) = {
            let mut machine = self.shared.machine();
            let before = machine.bits(self.number);
            let outcome = machine.transact(self.number, request.address, request.written, read);
            (outcome, machine.bits(self.number) - before)
        };
        if let Some(rate) = self.bits_per_second {
            let takes = Duration::from_secs_f64(bits as f64 / f64::from(rate.max(1)));
            std::thread::sleep(takes.saturating_sub(began.elapsed()));
        }
        let error = match outcome {
            Outcome::Done => 0,
            Outcome::Failed(error) => error,
            Outcome::Silence => return None,
        };
        answer[..4].copy_from_slice(&error.to_le_bytes());
        Some(if error == 0 { 4 + request.read } else { 4 })
    }

    /// What somebody with a probe at the chip sees: no transaction, so no time, no count and no faults.
    fn probe(&self, request: &Request<'_>, answer: &mut [u8]) -> usize {
        let read = &mut answer[4..4 + request.read];
        let &[register] = request.written else {
            answer[..4].copy_from_slice(&errno::MALFORMED.to_le_bytes());
            return 4;
        };
        let machine = self.shared.machine();
        let is_there = self.number == 2 && request.address == msp430::ADDRESS;
        let known = is_there && machine.msp430.probe(register, read);
        let error = if known { 0 } else { errno::NACK };
        answer[..4].copy_from_slice(&error.to_le_bytes());
        if known { 4 + request.read } else { 4 }
    }

    /// Waits as long as the faults say, while they say it.
    fn be_slow(&self, address: u16) {
        let began = Instant::now();
        loop {
            let slow_ms = self.shared.machine().slow_ms(self.number, address);
            let left = Duration::from_millis(u64::from(slow_ms)).saturating_sub(began.elapsed());
            if left.is_zero() || self.shared.is_stopping() {
                return;
            }
            std::thread::sleep(left.min(Duration::from_millis(SLOW_SLICE_MS)));
        }
    }
}

/// A packet that makes sense.
struct Request<'a> {
    is_probe: bool,
    address: u16,
    written: &'a [u8],
    read: usize,
}

impl<'a> Request<'a> {
    /// `length` is that of the packet as it was sent, which may be more than what came into `packet`.
    fn parse(packet: &'a [u8], length: usize) -> Result<Self, i32> {
        let whole = packet.get(..length).ok_or(errno::TOO_LONG)?;
        let Some((header, written)) = whole.split_at_checked(HEADER_BYTES) else {
            return Err(errno::MALFORMED);
        };
        if header[0] != VERSION || header[1] & !PROBE != 0 {
            return Err(errno::OTHER_VERSION);
        }
        let word = |at: usize| u16::from_le_bytes([header[at], header[at + 1]]);
        let read = usize::from(word(6));
        if usize::from(word(4)) != written.len() {
            return Err(errno::MALFORMED);
        }
        if read > MAX_TRANSFER_BYTES {
            return Err(errno::TOO_LONG);
        }
        Ok(Self {
            is_probe: header[1] & PROBE != 0,
            address: word(2),
            written,
            read,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packet_is_taken_or_its_mistake_is_told() {
        let fine = [1, 0, 0x48, 0, 1, 0, 2, 0, 0x26];
        let request = Request::parse(&fine, 9).unwrap();
        assert_eq!((request.address, request.read), (0x48, 2));
        assert_eq!(request.written, [0x26]);
        let fault = |packet: &[u8], length| Request::parse(packet, length).err();
        assert_eq!(fault(&fine, 10), Some(errno::TOO_LONG), "cut off");
        assert_eq!(
            fault(&fine[..7], 7),
            Some(errno::MALFORMED),
            "half a header"
        );
        assert_eq!(
            fault(&fine[..8], 8),
            Some(errno::MALFORMED),
            "a byte is missing"
        );
        let mut probe = fine;
        probe[1] = PROBE;
        assert!(Request::parse(&probe, 9).unwrap().is_probe && !request.is_probe);
        probe[1] = 2;
        assert_eq!(fault(&probe, 9), Some(errno::OTHER_VERSION));
        let mut other = fine;
        other[0] = 2;
        assert_eq!(fault(&other, 9), Some(errno::OTHER_VERSION));
        let mut long = fine;
        long[7] = 0xFF;
        assert_eq!(fault(&long, 9), Some(errno::TOO_LONG));
    }
}
