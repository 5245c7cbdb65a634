//! The other side of a virtual I2C bus, as a process of its own that counts what it is asked.
//!
//! Owns its socket. On its standard input a byte asks for the counts; on its standard output stand the time of arrival
//! of each written byte (8 bytes), or the counts (24 bytes): transfers, bits of the wire, processor time.

use super::bus::now_ns;
use super::peers::{Peer, Place};
use nix::sys::socket::{
    AddressFamily, Backlog, MsgFlags, SockFlag, SockType, UnixAddr, accept, bind, connect, listen,
    recv, send, socket,
};
use nix::time::{ClockId, clock_gettime};
use std::cell::RefCell;
use std::io::{Read, Write};
use std::os::fd::{AsRawFd, OwnedFd, RawFd};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::Duration;

/// What the other side has seen since its start.
pub struct Counts {
    pub transfers: u64,
    pub bits: u64,
    pub processor_ns: u64,
}

/// The other side of a bus.
pub struct BusPeer {
    pub path: PathBuf,
    peer: RefCell<Peer>,
    _place: Place,
}

fn packet_socket() -> Result<OwnedFd, String> {
    let flags = SockFlag::SOCK_CLOEXEC;
    socket(AddressFamily::Unix, SockType::SeqPacket, flags, None).map_err(|errno| errno.to_string())
}

impl BusPeer {
    /// Starts it; `delay_ms` before each answer, `u32::MAX` for none at all.
    pub fn start(name: &str, delay_ms: u32) -> Result<Self, String> {
        let place = Place::new(&format!("i2c-{name}"))?;
        let path = place.0.join("i2c");
        let _ = std::fs::remove_file(&path);
        let words = [path.display().to_string(), delay_ms.to_string()];
        let mut peer = Peer::start("i2c", &[&words[0], &words[1]])?;
        let mut ready = [0; 8];
        peer.from
            .read_exact(&mut ready)
            .map_err(|error| format!("the bus did not start: {error}"))?;
        Ok(Self {
            path,
            peer: RefCell::new(peer),
            _place: place,
        })
    }

    pub fn count(&mut self) -> Result<Counts, String> {
        let peer = self.peer.get_mut();
        let mut bytes = [0; 24];
        peer.to
            .write_all(&[1])
            .and_then(|()| peer.from.read_exact(&mut bytes))
            .map_err(|error| format!("the bus is gone: {error}"))?;
        let number = |at: usize| {
            let part = bytes[at..].first_chunk().copied();
            u64::from_ne_bytes(part.unwrap_or_default())
        };
        Ok(Counts {
            transfers: number(0),
            bits: number(8),
            processor_ns: number(16),
        })
    }

    /// When the next written byte arrived, or did already.
    pub fn arrival(&self) -> Result<u64, String> {
        let mut bytes = [0; 8];
        let read = self.peer.borrow_mut().from.read_exact(&mut bytes);
        read.map_err(|error| format!("the bus is gone: {error}"))?;
        Ok(u64::from_ne_bytes(bytes))
    }

    pub fn connect(&self) -> Result<OwnedFd, String> {
        let client = packet_socket()?;
        let address = UnixAddr::new(&self.path).map_err(|errno| errno.to_string())?;
        connect(client.as_raw_fd(), &address).map_err(|errno| errno.to_string())?;
        Ok(client)
    }

    /// The same packet that trikfs sends for a byte, and the wait for its answer.
    pub fn write_byte(&self, client: &OwnedFd) {
        let packet = [1, 0, 0x48, 0, 2, 0, 0, 0, 0x14, 50];
        send(client.as_raw_fd(), &packet, MsgFlags::empty()).expect("the bus is there");
        recv(client.as_raw_fd(), &mut [0; 8], MsgFlags::empty()).expect("an answer");
    }
}

impl Drop for BusPeer {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

static TRANSFERS: AtomicUsize = AtomicUsize::new(0);
static BITS: AtomicUsize = AtomicUsize::new(0);

/// The process: serves the bus until its standard input ends.
pub fn serve(path: &Path, delay_ms: u32) {
    let listener = packet_socket().expect("a socket");
    let address = UnixAddr::new(path).expect("a short path");
    bind(listener.as_raw_fd(), &address).expect("a free path");
    listen(&listener, Backlog::MAXCONN).expect("listening");
    std::thread::spawn(move || {
        while let Ok(client) = accept(listener.as_raw_fd()) {
            std::thread::spawn(move || answer_all(client, delay_ms));
        }
    });
    send_bytes(&[0; 8]);
    let mut asked = [0];
    while std::io::stdin().read_exact(&mut asked).is_ok() {
        let time = clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID).expect("a clock");
        let processor_ns = Duration::from(time).as_nanos() as u64;
        let mut bytes = Vec::new();
        for number in [
            TRANSFERS.load(Relaxed) as u64,
            BITS.load(Relaxed) as u64,
            processor_ns,
        ] {
            bytes.extend_from_slice(&number.to_ne_bytes());
        }
        send_bytes(&bytes);
    }
}

fn send_bytes(bytes: &[u8]) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(bytes).and_then(|()| out.flush());
}

fn answer_all(client: RawFd, delay_ms: u32) {
    let mut packet = [0; 64];
    let mut answer = [0; 64];
    while let Ok(size @ 9..) = recv(client, &mut packet, MsgFlags::empty()) {
        let arrived = now_ns();
        let (written, read) = (size - 8, usize::from(packet[6]).min(60));
        TRANSFERS.fetch_add(1, Relaxed);
        BITS.fetch_add(wire_bits(written, read), Relaxed);
        if delay_ms == u32::MAX {
            continue;
        }
        if delay_ms > 0 {
            std::thread::sleep(Duration::from_millis(delay_ms.into()));
        }
        if send(client, &answer[..4 + read], MsgFlags::MSG_NOSIGNAL).is_err() {
            return;
        }
        answer[4] = answer[4].wrapping_add(1);
        if read == 0 {
            send_bytes(&arrived.to_ne_bytes());
        }
    }
}

/// Start, address and written bytes with an acknowledge each, repeated start, address and read bytes, stop.
fn wire_bits(written: usize, read: usize) -> usize {
    let second = if read > 0 { 1 + 9 * (1 + read) } else { 0 };
    1 + 9 * (1 + written) + second + 1
}
