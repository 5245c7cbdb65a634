//! A channel of a player: a Unix socket that gives out what was recorded when the player's clock comes to it.
//!
//! Owns the messages. One connection is one direction of one channel. The first message comes from here: `read NAME` or
//! `write NAME`. To a reader the player sends an errno as i32 and after it, if that is 0, one whole tuple, else a reason as
//! text; from a writer it gets one tuple in each message. Numbers are little-endian. Knows no recording and no clock.

use super::{Device, Got, Kind, Patience, Sink, Stream, Surroundings, device_error};
use crate::errno::Error;
use crate::limits;
use config::description::PlayedDescription;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::socket::{
    AddressFamily, MsgFlags, SockFlag, SockType, UnixAddr, connect, recv, send, socket,
};
use std::os::fd::{AsFd, AsRawFd, BorrowedFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What stands before a tuple or a reason.
const HEAD_BYTES: usize = 4;

impl Kind for PlayedDescription {
    fn open(&self, tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Ok(Device::Stream(Box::new(Played::open(self, tuple_size)?)))
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Ok(Box::new(PlayedSink {
            socket: join(&self.path, "write", &self.channel)?,
            path: self.path.clone(),
            timeout: Duration::from_millis(around.timeout_ms.into()),
        }))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(true)
    }
}

/// Connects to one direction of a channel, without waiting for anything later.
fn join(path: &Path, direction: &str, channel: &str) -> Result<OwnedFd, Error> {
    let failed = |errno: nix::Error| device_error(path, &errno.into());
    let socket = socket(
        AddressFamily::Unix,
        SockType::SeqPacket,
        SockFlag::SOCK_CLOEXEC | SockFlag::SOCK_NONBLOCK,
        None,
    )
    .map_err(failed)?;
    let address = UnixAddr::new(path).map_err(failed)?;
    connect(socket.as_raw_fd(), &address).map_err(failed)?;
    let hello = format!("{direction} {channel}");
    send(socket.as_raw_fd(), hello.as_bytes(), MsgFlags::MSG_NOSIGNAL).map_err(failed)?;
    Ok(socket)
}

/// A channel that is read.
pub struct Played {
    socket: OwnedFd,
    path: PathBuf,
    /// Room for one message, and for one byte more, which shows that it is too long.
    message: Vec<u8>,
    tuple_size: usize,
    /// What of the last tuple has not been taken yet.
    rest: std::ops::Range<usize>,
}

impl Played {
    fn open(description: &PlayedDescription, tuple_size: usize) -> Result<Self, Error> {
        let socket = join(&description.path, "read", &description.channel)?;
        Ok(Self::over(socket, description.path.clone(), tuple_size))
    }

    /// `path` is for messages.
    fn over(socket: OwnedFd, path: PathBuf, tuple_size: usize) -> Self {
        let room = HEAD_BYTES + tuple_size.max(limits::REASON_BYTES_MAX) + 1;
        Self {
            socket,
            path,
            message: vec![0; room],
            tuple_size,
            rest: 0..0,
        }
    }

    fn malformed(&self, what: &str) -> Error {
        Error::Malformed(format!("{}: {what}", self.path.display()))
    }

    /// Takes one message; None at the moment.
    fn receive(&mut self) -> Result<Option<Got>, Error> {
        let got = recv(
            self.socket.as_raw_fd(),
            &mut self.message,
            MsgFlags::empty(),
        );
        let size = match got {
            Ok(0) | Err(nix::Error::ECONNRESET) => return Ok(Some(Got::End)),
            Ok(size) => size,
            Err(nix::Error::EAGAIN) => return Ok(Some(Got::Nothing)),
            Err(nix::Error::EINTR) => return Ok(None),
            Err(errno) => return Err(device_error(&self.path, &errno.into())),
        };
        let Some((head, body)) = self.message[..size].split_first_chunk::<HEAD_BYTES>() else {
            return Err(self.malformed("the player sent a message without an errno"));
        };
        match i32::from_le_bytes(*head) {
            0 if body.len() == self.tuple_size => {
                self.rest = HEAD_BYTES..size;
                Ok(None)
            }
            0 => {
                let what = format!(
                    "the player sent {} bytes, a tuple has {}",
                    body.len(),
                    self.tuple_size
                );
                Err(self.malformed(&what))
            }
            errno @ 1..=limits::ERRNO_MAX => {
                let shown = &body[..body.len().min(limits::REASON_BYTES_MAX)];
                let reason: String = String::from_utf8_lossy(shown)
                    .chars()
                    .filter(|c| !c.is_control())
                    .collect();
                Err(Error::Recorded(errno, reason))
            }
            other => Err(self.malformed(&format!("the player sent the errno {other}"))),
        }
    }
}

impl Stream for Played {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        while self.rest.is_empty() {
            if let Some(got) = self.receive()? {
                return Ok(got);
            }
        }
        let n = self.rest.len().min(buf.len());
        buf[..n].copy_from_slice(&self.message[self.rest.start..self.rest.start + n]);
        self.rest.start += n;
        Ok(Got::Bytes(n))
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.socket.as_fd())
    }

    /// The player answers a new reader at once with what it has.
    fn is_silent(&self, open: Duration, _patience: Patience) -> bool {
        open >= Patience::WITH_NOBODY
    }

    /// A sampler that failed comes back while others have the channel open, and must not wait for the next change.
    fn tells_changes_only(&self) -> bool {
        true
    }
}

/// A channel that is written: the player hears what a program would have told an actuator.
struct PlayedSink {
    socket: OwnedFd,
    path: PathBuf,
    timeout: Duration,
}

impl Sink for PlayedSink {
    fn write(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error> {
        let deadline = Instant::now() + self.timeout;
        loop {
            match send(self.socket.as_raw_fd(), tuple, MsgFlags::MSG_NOSIGNAL) {
                Ok(_) => return Ok(()),
                Err(nix::Error::EINTR) => {}
                Err(nix::Error::EAGAIN) if !waits => return Err(Error::WouldBlock),
                Err(nix::Error::EAGAIN) => {
                    let left = deadline.saturating_duration_since(Instant::now());
                    if left.is_zero() {
                        return Err(Error::TimedOut(format!(
                            "{}: the player took nothing in {} ms",
                            self.path.display(),
                            self.timeout.as_millis()
                        )));
                    }
                    let wait = PollTimeout::try_from(left + Duration::from_millis(1))
                        .unwrap_or(PollTimeout::MAX);
                    // Interrupted or not, the loop looks again.
                    let _ = poll(
                        &mut [PollFd::new(self.socket.as_fd(), PollFlags::POLLOUT)],
                        wait,
                    );
                }
                Err(errno) => return Err(device_error(&self.path, &errno.into())),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nix::sys::socket::{Shutdown, shutdown, socketpair};

    /// Both ends of one channel.
    struct Scene {
        player: OwnedFd,
        source: Played,
    }

    fn scene(tuple_size: usize) -> Scene {
        let flags = SockFlag::SOCK_CLOEXEC | SockFlag::SOCK_NONBLOCK;
        let (player, ours) =
            socketpair(AddressFamily::Unix, SockType::SeqPacket, None, flags).unwrap();
        Scene {
            player,
            source: Played::over(ours, PathBuf::from("player"), tuple_size),
        }
    }

    fn say(scene: &Scene, errno: i32, body: &[u8]) {
        let mut message = errno.to_le_bytes().to_vec();
        message.extend_from_slice(body);
        send(scene.player.as_raw_fd(), &message, MsgFlags::empty()).unwrap();
    }

    #[test]
    fn tuples_come_whole_and_failures_with_their_number_and_reason() {
        let mut scene = scene(2);
        let mut buf = [0; 8];
        assert_eq!(scene.source.read(&mut buf), Ok(Got::Nothing));
        say(&scene, 0, &[1, 2]);
        say(&scene, libc::EIO, b"the bus\n does not answer");
        say(&scene, 0, &[3, 4]);
        assert_eq!(scene.source.read(&mut buf[..1]), Ok(Got::Bytes(1)));
        assert_eq!(scene.source.read(&mut buf[1..]), Ok(Got::Bytes(1)));
        assert_eq!(buf[..2], [1, 2]);
        assert_eq!(
            scene.source.read(&mut buf),
            Err(Error::Recorded(
                libc::EIO,
                "the bus does not answer".to_owned()
            ))
        );
        assert_eq!(scene.source.read(&mut buf), Ok(Got::Bytes(2)));
        assert_eq!(buf[..2], [3, 4]);
    }

    #[test]
    fn a_player_that_leaves_is_the_end() {
        let mut scene = scene(1);
        let Scene { player, source, .. } = &mut scene;
        shutdown(player.as_raw_fd(), Shutdown::Both).unwrap();
        assert_eq!(source.read(&mut [0]), Ok(Got::End));
    }

    #[test]
    fn messages_that_are_no_tuples_are_refused() {
        for (errno, body) in [
            (0, &[1_u8, 2, 3][..]),
            (0, &[]),
            (0, &[0; 4000]),
            (-1, &[]),
            (4096, &[]),
        ] {
            let mut scene = scene(2);
            say(&scene, errno, body);
            let got = scene.source.read(&mut [0; 8]);
            assert!(matches!(got, Err(Error::Malformed(_))), "{errno} {got:?}");
        }
        let mut scene = scene(2);
        send(scene.player.as_raw_fd(), &[1, 2], MsgFlags::empty()).unwrap();
        assert!(matches!(
            scene.source.read(&mut [0; 8]),
            Err(Error::Malformed(_))
        ));
    }
}
