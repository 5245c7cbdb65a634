//! A virtual I2C bus: a socket at a path, devices with registers behind it, and everything that it was asked.
//!
//! Owns its threads until it is dropped. Each byte of a device is a register, found by number; a register number of two
//! bytes is told from data by the length that a device declares.

use crate::wait::eventually;
use nix::sys::socket::{
    AddressFamily, Backlog, MsgFlags, Shutdown, SockFlag, SockType, UnixAddr, accept, bind, listen,
    recv, send, shutdown, socket,
};
use std::collections::BTreeMap;
use std::os::fd::{AsRawFd, OwnedFd, RawFd};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// One request as it came.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transaction {
    /// 7 bits.
    pub address: u16,
    /// Register bytes, then data.
    pub written: Vec<u8>,
    /// Bytes that were to be read.
    pub read: usize,
}

/// How the bus behaves, to be changed at any time.
#[derive(Default)]
pub struct Behaviour {
    /// Registers by address and number.
    pub registers: BTreeMap<(u16, u16), u8>,
    /// Addresses that answer; others give no acknowledge.
    pub present: Vec<u16>,
    /// Bytes of a register number, by address, if not one.
    pub register_bytes: BTreeMap<u16, usize>,
    /// How long each transaction takes.
    pub delay: Duration,
    /// Requests are taken and never answered.
    pub is_dead: bool,
    /// What it was asked.
    pub seen: Vec<Transaction>,
    clients: Vec<RawFd>,
}

/// A bus that is being served.
pub struct I2cBus {
    path: PathBuf,
    behaviour: Arc<Mutex<Behaviour>>,
    listener: Option<(Arc<OwnedFd>, JoinHandle<()>)>,
}

impl I2cBus {
    /// A bus with one device whose registers are all 0.
    ///
    /// # Panics
    /// The socket cannot be made.
    pub fn start(path: &Path, address: u16) -> Self {
        let behaviour = Behaviour {
            present: vec![address],
            ..Behaviour::default()
        };
        let mut bus = Self {
            path: path.to_owned(),
            behaviour: Arc::new(Mutex::new(behaviour)),
            listener: None,
        };
        bus.plug_in();
        bus
    }

    /// Changes how it behaves, or looks at what it has seen.
    pub fn behaviour(&self) -> MutexGuard<'_, Behaviour> {
        lock(&self.behaviour)
    }

    /// Sets registers from one on.
    pub fn set(&self, address: u16, first: u16, bytes: &[u8]) {
        let mut behaviour = self.behaviour();
        for (register, byte) in (first..).zip(bytes) {
            behaviour.registers.insert((address, register), *byte);
        }
    }

    /// What was asked since the last call.
    pub fn seen(&self) -> Vec<Transaction> {
        std::mem::take(&mut self.behaviour().seen)
    }

    /// Makes the socket.
    ///
    /// # Panics
    /// It cannot be made.
    pub fn plug_in(&mut self) {
        let listener = socket(
            AddressFamily::Unix,
            SockType::SeqPacket,
            SockFlag::SOCK_CLOEXEC,
            None,
        )
        .expect("a socket");
        let address = UnixAddr::new(&self.path).expect("a short path");
        bind(listener.as_raw_fd(), &address).expect("a free path");
        listen(&listener, Backlog::MAXCONN).expect("a listening socket");
        let listener = Arc::new(listener);
        let (listening, behaviour) = (listener.clone(), self.behaviour.clone());
        let thread = std::thread::spawn(move || {
            while let Ok(client) = accept(listening.as_raw_fd()) {
                lock(&behaviour).clients.push(client);
                let behaviour = behaviour.clone();
                std::thread::spawn(move || {
                    serve(client, &behaviour);
                    lock(&behaviour).clients.retain(|other| *other != client);
                    let _ = nix::unistd::close(client);
                });
            }
        });
        self.listener = Some((listener, thread));
    }

    /// Takes the socket and all connections away.
    pub fn unplug(&mut self) {
        let _ = std::fs::remove_file(&self.path);
        if let Some((listener, thread)) = self.listener.take() {
            let _ = shutdown(listener.as_raw_fd(), Shutdown::Both);
            let _ = thread.join();
        }
        for client in &self.behaviour().clients {
            let _ = shutdown(*client, Shutdown::Both);
        }
        eventually("the end of all connections", || {
            self.behaviour().clients.is_empty()
        });
    }
}

impl Drop for I2cBus {
    fn drop(&mut self) {
        self.behaviour().delay = Duration::ZERO;
        self.unplug();
    }
}

fn lock(behaviour: &Mutex<Behaviour>) -> MutexGuard<'_, Behaviour> {
    behaviour.lock().unwrap_or_else(PoisonError::into_inner)
}

fn serve(client: RawFd, behaviour: &Mutex<Behaviour>) {
    let mut packet = vec![0; 20_000];
    while let Ok(size @ 1..) = recv(client, &mut packet, MsgFlags::empty()) {
        let delay = lock(behaviour).delay;
        // A slow bus is slow; nobody is waited for here.
        if !delay.is_zero() {
            std::thread::sleep(delay);
        }
        let Some(answer) = answer(&packet[..size], &mut lock(behaviour)) else {
            continue;
        };
        if send(client, &answer, MsgFlags::MSG_NOSIGNAL).is_err() {
            return;
        }
    }
}

fn answer(packet: &[u8], behaviour: &mut Behaviour) -> Option<Vec<u8>> {
    let (head, written) = packet.split_at_checked(8).expect("a whole request");
    assert_eq!(&head[..2], [1, 0], "version and flags");
    let number = |at: usize| u16::from_le_bytes([head[at], head[at + 1]]);
    let (address, read) = (number(2), usize::from(number(6)));
    assert_eq!(
        usize::from(number(4)),
        written.len(),
        "the length of what is written"
    );
    behaviour.seen.push(Transaction {
        address,
        written: written.to_vec(),
        read,
    });
    if behaviour.is_dead {
        return None;
    }
    if !behaviour.present.contains(&address) {
        return Some(libc::ENXIO.to_le_bytes().to_vec());
    }
    let register_bytes = behaviour.register_bytes.get(&address).copied().unwrap_or(1);
    let (register, data) = written.split_at(register_bytes);
    let first = register
        .iter()
        .fold(0, |number, byte| number << 8 | u16::from(*byte));
    for (register, byte) in (first..).zip(data) {
        behaviour.registers.insert((address, register), *byte);
    }
    let mut out = 0i32.to_le_bytes().to_vec();
    out.extend((first..).take(read).map(|register| {
        let found = behaviour.registers.get(&(address, register));
        found.copied().unwrap_or(0)
    }));
    Some(out)
}
