//! Packets of a serial line: one good packet is one tuple.
//!
//! Owns where the bytes come from (a terminal set to raw at its speed, a FIFO, or a file that is read once). What a
//! packet is, `framer` knows.

mod framer;

use super::cutter::Cutter;
use super::{Device, Got, Kind, Patience, Stream, Surroundings, chardev, device_error, fifo};
use crate::errno::Error;
use crate::limits;
use crate::stats::Counter;
use config::description::PacketsDescription;
use framer::Framer;
use nix::sys::termios::{self, BaudRate, SetArg};
use std::fs::File;
use std::io::Read;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

impl Kind for PacketsDescription {
    fn open(&self, tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        let packets = Packets::open(self, tuple_size, around.damaged.clone())?;
        Ok(Device::Stream(Box::new(packets)))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(true)
    }
}

/// A framer in front of the bytes of a line.
pub struct Packets {
    bytes: Box<dyn Stream>,
    cutter: Cutter<Framer>,
    is_file: bool,
}

impl Packets {
    /// Opens the line; a terminal gets its speed.
    pub fn open(
        description: &PacketsDescription,
        tuple_size: usize,
        damaged: Arc<Counter>,
    ) -> Result<Self, Error> {
        let path = &description.path;
        let meta = std::fs::metadata(path).map_err(|error| device_error(path, &error))?;
        let is_file = meta.is_file();
        let bytes: Box<dyn Stream> = if meta.file_type().is_fifo() {
            Box::new(fifo::Fifo::open(path)?)
        } else if is_file {
            Box::new(Recorded::open(path)?)
        } else {
            let device = chardev::CharDevice::open(path)?;
            if let (Some(baud), Some(fd)) = (description.baud, device.fd()) {
                set_speed(fd, baud, path)?;
            }
            Box::new(device)
        };
        let framer = Framer::new(description, tuple_size);
        Ok(Self {
            bytes,
            cutter: Cutter::new(framer, tuple_size, limits::PORT_READ_BYTES, damaged),
            is_file,
        })
    }
}

impl Stream for Packets {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        self.cutter.read(self.bytes.as_mut(), buf)
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        self.bytes.fd()
    }

    fn wake_at(&self) -> Option<Instant> {
        self.bytes.wake_at().or(self.cutter.wake_at())
    }

    fn is_silent(&self, open: Duration, patience: Patience) -> bool {
        self.wake_at().is_none() && self.bytes.is_silent(open, patience)
    }

    fn is_still_there(&self) -> bool {
        self.bytes.is_still_there()
    }

    fn begins_anew(&self) -> bool {
        !self.is_file
    }
}

/// What is no terminal has no speed.
fn set_speed(fd: BorrowedFd<'_>, baud: u32, path: &Path) -> Result<(), Error> {
    let failed = |errno: nix::Error| {
        let what = format!("{}: {baud} bits per second", path.display());
        Error::Device(errno as i32, what)
    };
    let mut settings = match termios::tcgetattr(fd) {
        Ok(settings) => settings,
        Err(nix::Error::ENOTTY | nix::Error::EINVAL) => return Ok(()),
        Err(errno) => return Err(failed(errno)),
    };
    let Some((_, speed)) = SPEEDS.iter().find(|(known, _)| *known == baud) else {
        return Err(failed(nix::Error::EINVAL));
    };
    termios::cfsetspeed(&mut settings, *speed).map_err(failed)?;
    termios::tcsetattr(fd, SetArg::TCSANOW, &settings).map_err(failed)
}

/// The speeds of `config::limits::BAUD_RATES`, as the terminal's settings name them.
const SPEEDS: [(u32, BaudRate); 19] = [
    (1_200, BaudRate::B1200),
    (2_400, BaudRate::B2400),
    (4_800, BaudRate::B4800),
    (9_600, BaudRate::B9600),
    (19_200, BaudRate::B19200),
    (38_400, BaudRate::B38400),
    (57_600, BaudRate::B57600),
    (115_200, BaudRate::B115200),
    (230_400, BaudRate::B230400),
    (460_800, BaudRate::B460800),
    (500_000, BaudRate::B500000),
    (576_000, BaudRate::B576000),
    (921_600, BaudRate::B921600),
    (1_000_000, BaudRate::B1000000),
    (1_152_000, BaudRate::B1152000),
    (1_500_000, BaudRate::B1500000),
    (2_000_000, BaudRate::B2000000),
    (2_500_000, BaudRate::B2500000),
    (3_000_000, BaudRate::B3000000),
];

/// A file of bytes that were kept: read once from its beginning, without waiting.
struct Recorded {
    file: File,
    path: PathBuf,
}

impl Recorded {
    fn open(path: &Path) -> Result<Self, Error> {
        let file = File::open(path).map_err(|error| device_error(path, &error))?;
        Ok(Self {
            file,
            path: path.to_owned(),
        })
    }
}

impl Stream for Recorded {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        match self.file.read(buf) {
            Ok(0) => Ok(Got::End),
            Ok(n) => Ok(Got::Bytes(n)),
            Err(error) => Err(device_error(&self.path, &error)),
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.file.as_fd())
    }

    fn wake_at(&self) -> Option<Instant> {
        Some(Instant::now())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;
    use config::description::{ByteOrder, Checksum, LengthField};
    use nix::pty::openpty;
    use std::os::fd::AsRawFd;

    fn description(path: PathBuf) -> PacketsDescription {
        PacketsDescription {
            path,
            baud: Some(230_400),
            start: vec![0xaa],
            length: LengthField {
                at: 1,
                bytes: 1,
                add: 0,
            },
            order: ByteOrder::Big,
            checksum: Checksum::Sum8,
        }
    }

    #[test]
    fn every_speed_of_a_configuration_is_known() {
        let known: Vec<u32> = SPEEDS.iter().map(|(baud, _)| *baud).collect();
        assert_eq!(known, config::limits::BAUD_RATES);
    }

    #[test]
    fn a_terminal_gets_its_speed_and_passes_bytes_unchanged() {
        let pty = openpty(None, None).unwrap();
        let path = format!("/proc/self/fd/{}", pty.slave.as_raw_fd());
        let path = std::fs::read_link(path).unwrap();
        let damaged = Arc::<Counter>::default();
        let mut packets = Packets::open(&description(path), 5, damaged).unwrap();
        let settings = termios::tcgetattr(&pty.slave).unwrap();
        assert_eq!(termios::cfgetospeed(&settings), BaudRate::B230400);
        let packet = [0xaa, 5, 0x0d, 0x03, 0xbf];
        nix::unistd::write(&pty.master, &packet).unwrap();
        let mut buf = [0; 5];
        assert_eq!((packets.read(&mut buf), buf), (Ok(Got::Bytes(5)), packet));
        assert_eq!(packets.read(&mut buf), Ok(Got::Nothing));
    }

    #[test]
    fn a_file_is_read_once() {
        let scratch = Scratch::new();
        let path = scratch.path("kept");
        std::fs::write(&path, [0xaa, 3, 0xad, 0xaa, 3]).unwrap();
        let damaged = Arc::<Counter>::default();
        let mut packets = Packets::open(&description(path), 4, damaged.clone()).unwrap();
        let mut buf = [9; 4];
        assert_eq!(packets.read(&mut buf), Ok(Got::Bytes(4)));
        assert_eq!(buf, [0xaa, 3, 0xad, 0]);
        assert_eq!(packets.read(&mut buf), Ok(Got::End));
        assert!(!packets.begins_anew());
        assert_eq!(damaged.get(), 1);
    }
}
