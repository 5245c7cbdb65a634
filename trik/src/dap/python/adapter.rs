//! The adapter of debugpy as a process: requests to it, what it says, and the way to it for a program.
//!
//! Owns the process and its end, and that no other process of this computer is taken for the program. Knows no request.

use super::super::client::Refused;
use crate::limits;
use crate::wire::{self, Frame, Frames};
use rustix::net::{
    AddressFamily, SocketFlags, SocketType, bind, connect, getsockname, socket_with,
};
use serde_json::Value;
use std::io::{self, BufReader};
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, TcpStream};
use std::os::fd::OwnedFd;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

/// What comes next.
pub(super) enum AdapterSays {
    Message(Value),
    Nothing,
    End,
}

/// debugpy on this computer.
pub(super) struct Adapter {
    process: Child,
    to: ChildStdin,
    from: Receiver<Value>,
    way: Option<OwnPort>,
}

/// A way to the adapter, from a port that is ours before the adapter is there, and that no other process can come from.
struct OwnPort {
    socket: OwnedFd,
    port: u16,
}

impl OwnPort {
    fn new() -> io::Result<Self> {
        // Without SO_REUSEADDR no other socket gets this port, bound or not (socket(7)).
        let flags = SocketFlags::CLOEXEC;
        let socket = socket_with(AddressFamily::INET, SocketType::STREAM, flags, None)?;
        bind(&socket, &SocketAddrV4::new(Ipv4Addr::LOCALHOST, 0))?;
        let own = SocketAddr::try_from(getsockname(&socket)?)?;
        let port = own.port();
        Ok(Self { socket, port })
    }

    fn to(self, port: u16) -> io::Result<TcpStream> {
        connect(&self.socket, &SocketAddrV4::new(Ipv4Addr::LOCALHOST, port))?;
        let stream = TcpStream::from(self.socket);
        stream.set_nodelay(true)?;
        Ok(stream)
    }
}

/// The adapter, which takes no connection but that of its one argument: it waits for a program at a port of this computer, and
/// would take the first process of whichever user for it.
const ADAPTER: &str = "\
import runpy, socket
own = int(sys.argv.pop())
accept = socket.socket.accept
def accept_own(self):
    while True:
        peer, address = accept(self)
        if address == ('127.0.0.1', own):
            return peer, address
        peer.close()
socket.socket.accept = accept_own
runpy.run_module('debugpy.adapter', run_name='__main__', alter_sys=True)
";

/// Before all else: modules of the current directory are not found, where a file json.py beside a program would run on this
/// computer.
const SAFE_PATH: &str =
    "import sys; sys.path = [place for place in sys.path if place not in ('', '.')]\n";

/// The same for what it starts itself. Pythons before 3.11 do not know the variable.
const SAFE: (&str, &str) = ("PYTHONSAFEPATH", "1");

/// Whether this Python has debugpy, and what to type if it has not.
fn must_have(python: &str) -> Result<(), Refused> {
    let asked = Command::new(python)
        .args(["-c", &format!("{SAFE_PATH}import debugpy")])
        .env(SAFE.0, SAFE.1)
        .stdin(Stdio::null())
        .output();
    match asked {
        Ok(answer) if answer.status.success() => Ok(()),
        Ok(_) => Err(Refused::new(format!(
            "debugpy is needed to debug Python, and {python} on this computer has none: type\n    {python} -m pip install debugpy\nor say with \"python\" which Python has it"
        ))),
        Err(why) => Err(Refused::new(format!(
            "{python} cannot be started: {why}; say with \"python\" which Python of this computer has debugpy"
        ))),
    }
}

impl Adapter {
    /// Starts it with this Python.
    ///
    /// # Errors
    /// There is none, and what to do.
    pub fn start(python: &str) -> Result<Self, Refused> {
        must_have(python)?;
        let no = |why: std::io::Error| Refused::new(format!("debugpy cannot be started: {why}"));
        let way = OwnPort::new().map_err(no)?;
        let mut process = Command::new(python)
            .args([
                "-c",
                &format!("{SAFE_PATH}{ADAPTER}"),
                &way.port.to_string(),
            ])
            .env(SAFE.0, SAFE.1)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(no)?;
        let (Some(to), Some(from)) = (process.stdin.take(), process.stdout.take()) else {
            return Err(Refused::new("debugpy has no streams"));
        };
        let (sender, receiver) = sync_channel(limits::DAP_WAITING);
        std::thread::spawn(move || {
            let mut frames = Frames::of(BufReader::new(from));
            while let Ok(Some(frame)) = frames.next() {
                // It is a program like ours: what is no message is none for anybody.
                if let Frame::Body(body) = frame
                    && let Ok(message) = serde_json::from_slice(&body)
                    && sender.send(message).is_err()
                {
                    return;
                }
            }
        });
        Ok(Self {
            process,
            to,
            from: receiver,
            way: Some(way),
        })
    }

    /// Gives it a message; one that is gone is heard of by its end.
    pub fn send(&mut self, message: &Value) {
        let _ = wire::write(&mut self.to, message);
    }

    /// A connection to where it waits for a program.
    ///
    /// # Errors
    /// There is one already, or nobody waits.
    pub fn connect(&mut self, port: u16) -> io::Result<TcpStream> {
        let way = self.way.take();
        way.ok_or(io::ErrorKind::AlreadyExists)?.to(port)
    }

    /// What it says next, waiting at most so long.
    pub fn next(&self, wait: Duration) -> AdapterSays {
        match self.from.recv_timeout(wait) {
            Ok(message) => AdapterSays::Message(message),
            Err(RecvTimeoutError::Timeout) => AdapterSays::Nothing,
            Err(RecvTimeoutError::Disconnected) => AdapterSays::End,
        }
    }
}

impl Drop for Adapter {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
