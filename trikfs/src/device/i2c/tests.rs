//! Tests of registers against a virtual bus in this process: every transfer, what is remembered, every failure.

use super::*;
use crate::scratch::Scratch;
use nix::sys::socket::{
    AddressFamily, Backlog, MsgFlags, SockFlag, SockType, UnixAddr, accept, bind, listen, recv,
    send, socket,
};
use std::collections::HashMap;
use std::os::fd::{AsRawFd, RawFd};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

/// How the peer behaves.
const FINE: u32 = 0;
const SILENT: u32 = 1;
const NO_ACKNOWLEDGE: u32 = 2;
const GARBAGE: u32 = 3;
const HANG_UP: u32 = 4;

/// A device at 0x48 with bytes by register number, on a virtual bus.
struct Peer {
    _scratch: Scratch,
    path: PathBuf,
    mood: Arc<AtomicU32>,
    seen: Arc<Mutex<Vec<Vec<u8>>>>,
}

impl Peer {
    fn new() -> Self {
        let scratch = Scratch::new();
        let peer = Self {
            path: scratch.path("i2c-2"),
            _scratch: scratch,
            mood: Arc::default(),
            seen: Arc::default(),
        };
        peer.serve();
        peer
    }

    /// Opens the bus at its path. The socket of before stays with those that are connected.
    fn serve(&self) {
        let _ = std::fs::remove_file(&self.path);
        let listener = socket(
            AddressFamily::Unix,
            SockType::SeqPacket,
            SockFlag::SOCK_CLOEXEC,
            None,
        )
        .expect("a socket");
        bind(
            listener.as_raw_fd(),
            &UnixAddr::new(&self.path).expect("a short path"),
        )
        .expect("bound");
        listen(&listener, Backlog::MAXCONN).expect("listening");
        let (mood, seen) = (self.mood.clone(), self.seen.clone());
        std::thread::spawn(move || {
            let registers = Arc::new(Mutex::new(HashMap::new()));
            while let Ok(client) = accept(listener.as_raw_fd()) {
                let (mood, seen) = (mood.clone(), seen.clone());
                let registers = registers.clone();
                std::thread::spawn(move || {
                    answer_all(client, &mood, &seen, &registers);
                    let _ = nix::unistd::close(client);
                });
            }
        });
    }

    fn register(
        &self,
        register: u16,
        size: usize,
        change: impl FnOnce(&mut I2cDescription),
    ) -> Register {
        self.register_of(&Buses::default(), register, size, change)
    }

    fn register_of(
        &self,
        buses: &Buses,
        register: u16,
        size: usize,
        change: impl FnOnce(&mut I2cDescription),
    ) -> Register {
        let mut description = I2cDescription {
            path: self.path.clone(),
            address: 0x48,
            register,
            register_bytes: 1,
            transfer: I2cTransfer::Raw,
            write_transfer: I2cTransfer::Raw,
            readable: true,
            once: false,
        };
        change(&mut description);
        Register::open(&description, size, 2_000, buses).expect("the bus is there")
    }

    fn seen(&self) -> Vec<Vec<u8>> {
        std::mem::take(&mut self.seen.lock().unwrap())
    }
}

fn answer_all(
    client: RawFd,
    mood: &AtomicU32,
    seen: &Mutex<Vec<Vec<u8>>>,
    registers: &Mutex<HashMap<u8, u8>>,
) {
    let mut packet = [0; 9000];
    while let Ok(size @ 1..) = recv(client, &mut packet, MsgFlags::empty()) {
        let packet = &packet[..size];
        seen.lock().unwrap().push(packet.to_vec());
        let read = usize::from(u16::from_le_bytes([packet[6], packet[7]]));
        let mut answer = vec![0; 4];
        match mood.load(Ordering::SeqCst) {
            SILENT => continue,
            HANG_UP => return,
            NO_ACKNOWLEDGE => answer = libc::ENXIO.to_le_bytes().to_vec(),
            GARBAGE => answer = vec![1, 2],
            _ => {
                let mut registers = registers.lock().unwrap();
                let first = packet[8];
                for (offset, byte) in packet[9..].iter().enumerate() {
                    registers.insert(first.wrapping_add(offset as u8), *byte);
                }
                answer.extend((0..read).map(|offset| {
                    let number = first.wrapping_add(offset as u8);
                    registers.get(&number).copied().unwrap_or(number)
                }));
            }
        }
        let _ = send(client, &answer, MsgFlags::MSG_NOSIGNAL);
    }
}

fn read(register: &mut Register, size: usize) -> Result<Vec<u8>, Error> {
    let mut buf = vec![0; size + 8];
    let got = register.read_at(0, &mut buf)?;
    buf.truncate(got);
    Ok(buf)
}

#[test]
fn each_transfer_sends_and_takes_the_bytes_of_the_wire() {
    let peer = Peer::new();
    let mut word = peer.register(0x25, 2, |d| d.transfer = I2cTransfer::Word);
    assert_eq!(read(&mut word, 2), Ok(vec![0x25, 0x26]));
    assert_eq!(peer.seen(), [[1, 0, 0x48, 0, 1, 0, 2, 0, 0x25]]);
    let mut encoder = peer.register(0x30, 4, |d| {
        d.transfer = I2cTransfer::Block;
        d.write_transfer = I2cTransfer::Byte;
    });
    assert_eq!(encoder.write(&[7, 9, 9, 9], true), Ok(()));
    assert_eq!(peer.seen(), [[1, 0, 0x48, 0, 2, 0, 0, 0, 0x30, 7]]);
    assert_eq!(read(&mut encoder, 4), Ok(vec![7, 0x31, 0x32, 0x33]));
    peer.seen();
    let mut wide = peer.register(0x2400, 3, |d| d.register_bytes = 2);
    assert_eq!(wide.write(&[1, 2, 3], true), Ok(()));
    assert_eq!(peer.seen(), [[1, 0, 0x48, 0, 5, 0, 0, 0, 0x24, 0, 1, 2, 3]]);
}

#[test]
fn reading_on_inside_a_tuple_is_no_new_transfer_and_behind_it_is_the_end() {
    let peer = Peer::new();
    let mut block = peer.register(0x10, 4, |_| {});
    let mut buf = [0; 2];
    assert_eq!(block.read_at(0, &mut buf), Ok(2));
    assert_eq!(block.read_at(2, &mut buf), Ok(2));
    assert_eq!(buf, [0x12, 0x13]);
    assert_eq!(block.read_at(4, &mut buf), Ok(0));
    assert_eq!(peer.seen().len(), 1);
}

#[test]
fn what_cannot_be_read_back_is_what_was_written_last() {
    let (peer, buses) = (Peer::new(), Buses::default());
    let duty = |d: &mut I2cDescription| {
        d.transfer = I2cTransfer::Byte;
        d.write_transfer = I2cTransfer::Byte;
        d.readable = false;
    };
    let mut motor = peer.register_of(&buses, 0x14, 1, duty);
    assert_eq!(read(&mut motor, 1), Ok(vec![0]));
    assert_eq!(
        peer.register_of(&buses, 0x14, 1, duty).write(&[0x9c], true),
        Ok(())
    );
    assert_eq!(read(&mut motor, 1), Ok(vec![0x9c]));
    assert_eq!(peer.seen().len(), 1, "nothing was read from the device");
    peer.mood.store(NO_ACKNOWLEDGE, Ordering::SeqCst);
    assert!(motor.write(&[5], true).is_err());
    assert_eq!(
        read(&mut motor, 1),
        Ok(vec![0x9c]),
        "a failed write is none"
    );
}

#[test]
fn what_is_read_once_is_read_again_after_the_bus_was_opened_anew_or_written() {
    let (peer, buses) = (Peer::new(), Buses::default());
    let mut eeprom = peer.register_of(&buses, 0x40, 2, |d| d.once = true);
    let mut again = peer.register_of(&buses, 0x40, 2, |d| d.once = true);
    assert_eq!(read(&mut eeprom, 2), Ok(vec![0x40, 0x41]));
    assert_eq!(read(&mut again, 2), Ok(vec![0x40, 0x41]));
    assert_eq!(peer.seen().len(), 1);
    assert_eq!(again.write(&[8, 9], true), Ok(()));
    assert_eq!(read(&mut eeprom, 2), Ok(vec![8, 9]));
    assert_eq!(peer.seen().len(), 2);
    peer.mood.store(HANG_UP, Ordering::SeqCst);
    assert!(eeprom.write(&[1, 1], true).is_err());
    peer.mood.store(FINE, Ordering::SeqCst);
    peer.seen();
    assert_eq!(read(&mut eeprom, 2), Ok(vec![8, 9]), "from memory");
    let mut other = peer.register_of(&buses, 0x50, 1, |_| {});
    assert_eq!(read(&mut other, 1), Ok(vec![0x50]));
    assert_eq!(read(&mut eeprom, 2), Ok(vec![8, 9]));
    assert_eq!(peer.seen().len(), 2, "the new opening asked again");
}

#[test]
fn each_failure_has_its_words_and_the_next_transfer_works_again() {
    let peer = Peer::new();
    let path = peer.path.display().to_string();
    let mut register = peer.register(1, 2, |_| {});
    let cases = [
        (
            NO_ACKNOWLEDGE,
            Error::Device(libc::EREMOTEIO, format!("no answer from 0x48 on {path}")),
        ),
        (
            SILENT,
            Error::TimedOut(format!("0x48 on {path} did not answer within 50 ms")),
        ),
        (
            GARBAGE,
            Error::Device(libc::EPROTO, format!("{path}: an answer of 2 bytes")),
        ),
        (
            HANG_UP,
            Error::NoDevice(format!("{path}: the bus was closed inside a transfer")),
        ),
    ];
    for (mood, expected) in cases {
        peer.mood.store(mood, Ordering::SeqCst);
        // Only silence is waited for: on a busy machine the others take a while, too.
        let is_silent = mood == SILENT;
        register.timeout = Duration::from_millis(if is_silent { 50 } else { 60_000 });
        assert_eq!(read(&mut register, 2), Err(expected), "mood {mood}");
        peer.mood.store(FINE, Ordering::SeqCst);
        register.timeout = Duration::from_secs(60);
        assert_eq!(read(&mut register, 2), Ok(vec![1, 2]), "after mood {mood}");
    }
}

#[test]
fn a_bus_that_is_gone_and_comes_back_is_found_again() {
    let peer = Peer::new();
    let mut register = peer.register(3, 1, |_| {});
    assert_eq!(read(&mut register, 1), Ok(vec![3]));
    peer.mood.store(HANG_UP, Ordering::SeqCst);
    assert!(read(&mut register, 1).is_err());
    std::fs::remove_file(&peer.path).unwrap();
    let path = peer.path.display();
    let gone = format!("{path}: No such file or directory (os error 2)");
    assert_eq!(read(&mut register, 1), Err(Error::NoDevice(gone)));
    peer.mood.store(FINE, Ordering::SeqCst);
    peer.serve();
    assert_eq!(read(&mut register, 1), Ok(vec![3]));
}

#[test]
fn a_path_that_cannot_be_a_bus_is_refused_when_it_is_opened() {
    let scratch = Scratch::new();
    let file = scratch.path("i2c-9");
    let description = I2cDescription {
        path: file.clone(),
        address: 0x48,
        register: 0,
        register_bytes: 1,
        transfer: I2cTransfer::Byte,
        write_transfer: I2cTransfer::Byte,
        readable: true,
        once: false,
    };
    let open = || Register::open(&description, 1, 100, &Buses::default()).map(drop);
    let missing = open().unwrap_err();
    assert_eq!(missing.errno(), libc::ENODEV);
    assert!(
        missing.to_string().contains("i2c-9: No such file"),
        "{missing}"
    );
    std::fs::write(&file, "text").unwrap();
    let wrong = open().unwrap_err();
    assert!(
        wrong.to_string().contains("is neither an I2C bus"),
        "{wrong}"
    );
}

#[test]
fn one_bus_serves_many_threads_one_after_the_other() {
    let (peer, buses) = (Peer::new(), Buses::default());
    std::thread::scope(|scope| {
        for number in 0..4u16 {
            let mut register = peer.register_of(&buses, 0x10 * number, 2, |_| {});
            scope.spawn(move || {
                let low = (0x10 * number) as u8;
                for _ in 0..200 {
                    assert_eq!(read(&mut register, 2), Ok(vec![low, low + 1]));
                }
            });
        }
    });
    assert_eq!(peer.seen().len(), 800);
}
