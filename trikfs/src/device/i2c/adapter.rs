//! A bus of the kernel's i2c-dev: the ioctls, and the structures that they take.
//!
//! Owns the layout of those structures (linux/i2c-dev.h, linux/i2c.h). The only file of the devices with foreign calls.

use super::super::is_same_file;
use super::bus::Failure;
use super::{Data, Transfer};
use crate::limits::BUS_LOOK_MS;
use config::description::I2cTransfer;
use config::limits::{I2C_BLOCK_BYTES_MAX, I2C_RAW_BYTES_MAX};
use nix::errno::Errno;
use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::AsRawFd;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::time::{Duration, Instant};

const I2C_TIMEOUT: u32 = 0x0702;
const I2C_SLAVE: u32 = 0x0703;
const I2C_RDWR: u32 = 0x0707;
const I2C_SMBUS: u32 = 0x0720;
const I2C_M_RD: u16 = 1;
const I2C_SMBUS_WRITE: u8 = 0;
const I2C_SMBUS_READ: u8 = 1;
const I2C_SMBUS_BYTE_DATA: u32 = 2;
const I2C_SMBUS_WORD_DATA: u32 = 3;
const I2C_SMBUS_I2C_BLOCK_DATA: u32 = 8;

/// `union i2c_smbus_data`: a byte, a word in the order of the processor, or a length and a block.
#[repr(C, align(2))]
#[derive(Clone, Copy)]
struct SmbusData([u8; I2C_BLOCK_BYTES_MAX + 2]);

/// `struct i2c_smbus_ioctl_data`
#[repr(C)]
struct SmbusArguments {
    read_write: u8,
    command: u8,
    size: u32,
    data: *mut SmbusData,
}

/// `struct i2c_msg`
#[repr(C)]
struct Message {
    address: u16,
    flags: u16,
    length: u16,
    bytes: *mut u8,
}

/// `struct i2c_rdwr_ioctl_data`
#[repr(C)]
struct RdwrArguments {
    messages: *mut Message,
    count: u32,
}

/// An open bus.
pub(super) struct Adapter {
    file: File,
    /// Address that the file was told last.
    address: Option<u16>,
    /// When it was last seen that the file still stands at its path.
    seen: Instant,
}

fn outcome(result: libc::c_int) -> Result<(), Failure> {
    if result >= 0 {
        return Ok(());
    }
    let error = io::Error::last_os_error();
    let Some(number) = error.raw_os_error() else {
        return Err(Failure::Gone(error));
    };
    match Errno::from_raw(number) {
        Errno::ENODEV | Errno::EBADF | Errno::ESHUTDOWN => Err(Failure::Gone(error)),
        _ => Err(Failure::Errno(number)),
    }
}

impl Adapter {
    pub(super) fn open(path: &Path, timeout: Duration) -> Result<Self, Failure> {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(libc::O_CLOEXEC | libc::O_NOCTTY | libc::O_NONBLOCK)
            .open(path);
        let file = file.map_err(|error| match error.raw_os_error().map(Errno::from_raw) {
            Some(errno @ (Errno::EACCES | Errno::EPERM | Errno::EBUSY)) => {
                Failure::Errno(errno as i32)
            }
            _ => Failure::Gone(error),
        })?;
        // In units of 10 ms, for the whole adapter, which other drivers use as well: never longer than its usual second.
        let units = (timeout.as_millis() / 10).clamp(1, 100) as libc::c_ulong;
        // SAFETY: I2C_TIMEOUT takes a number and no pointer; the descriptor is open.
        let result = unsafe { libc::ioctl(file.as_raw_fd(), I2C_TIMEOUT as _, units) };
        // Anything else than a bus does not know the number.
        outcome(result)?;
        Ok(Self {
            file,
            address: None,
            seen: Instant::now(),
        })
    }

    /// Whether the kernel has taken the bus away: its node is gone, but transfers may go on, and the kernel waits for the
    /// end of this opening, and with it the removal of the bus. Looks four times a second at most.
    pub(super) fn is_withdrawn(&mut self, path: &Path) -> bool {
        if self.seen.elapsed() < Duration::from_millis(BUS_LOOK_MS) {
            return false;
        }
        self.seen = Instant::now();
        !is_same_file(&self.file, path)
    }

    /// What tells this bus from another one at the same path.
    pub(super) fn identity(&self) -> Option<(u64, u64)> {
        let meta = self.file.metadata().ok()?;
        Some((meta.dev(), meta.ino()))
    }

    pub(super) fn transfer(&mut self, transfer: &mut Transfer<'_>) -> Result<(), Failure> {
        match transfer.kind {
            I2cTransfer::Raw => self.messages(transfer),
            I2cTransfer::Byte | I2cTransfer::Word | I2cTransfer::Block => {
                self.choose(transfer.address)?;
                self.smbus(transfer)
            }
        }
    }

    fn choose(&mut self, address: u16) -> Result<(), Failure> {
        if self.address == Some(address) {
            return Ok(());
        }
        let number = libc::c_ulong::from(address);
        // SAFETY: I2C_SLAVE takes a number and no pointer; the descriptor is open.
        let result = unsafe { libc::ioctl(self.file.as_raw_fd(), I2C_SLAVE as _, number) };
        outcome(result)?;
        self.address = Some(address);
        Ok(())
    }

    fn smbus(&self, transfer: &mut Transfer<'_>) -> Result<(), Failure> {
        let (mut data, size) = prepare(transfer)?;
        let [command] = *transfer.register else {
            return Err(Failure::Unfit);
        };
        let mut arguments = SmbusArguments {
            read_write: match transfer.data {
                Data::Read(_) => I2C_SMBUS_READ,
                Data::Write(_) => I2C_SMBUS_WRITE,
            },
            command,
            size,
            data: &raw mut data,
        };
        // SAFETY: `arguments` has the layout of struct i2c_smbus_ioctl_data (tested below) and lives through the call;
        // its pointer leads to 34 writable bytes, as much as the kernel copies for any size.
        let result =
            unsafe { libc::ioctl(self.file.as_raw_fd(), I2C_SMBUS as _, &raw mut arguments) };
        outcome(result)?;
        take(&data, transfer)
    }

    fn messages(&self, transfer: &mut Transfer<'_>) -> Result<(), Failure> {
        let address = transfer.address;
        let mut out = transfer.register.to_vec();
        let mut messages = Vec::with_capacity(2);
        let read = match &mut transfer.data {
            Data::Read(data) => Some((data.as_mut_ptr(), data.len())),
            Data::Write(data) => {
                out.extend_from_slice(data);
                None
            }
        };
        let length = |bytes: usize| match u16::try_from(bytes) {
            Ok(length) if bytes <= I2C_RAW_BYTES_MAX => Ok(length),
            _ => Err(Failure::Unfit),
        };
        messages.push(Message {
            address,
            flags: 0,
            length: length(out.len())?,
            bytes: out.as_mut_ptr(),
        });
        if let Some((bytes, size)) = read {
            messages.push(Message {
                address,
                flags: I2C_M_RD,
                length: length(size)?,
                bytes,
            });
        }
        let mut arguments = RdwrArguments {
            count: if messages.len() == 2 { 2 } else { 1 },
            messages: messages.as_mut_ptr(),
        };
        // SAFETY: `arguments` has the layout of struct i2c_rdwr_ioctl_data (tested below) and names so many messages of
        // the layout of struct i2c_msg; each names a buffer of its length that is alive and ours alone until the call
        // returns: `out`, and the caller's buffer, which `transfer` borrows mutably.
        let result =
            unsafe { libc::ioctl(self.file.as_raw_fd(), I2C_RDWR as _, &raw mut arguments) };
        outcome(result)
    }
}

/// The union and the size word for an SMBus transfer.
fn prepare(transfer: &Transfer<'_>) -> Result<(SmbusData, u32), Failure> {
    let mut data = SmbusData([0; I2C_BLOCK_BYTES_MAX + 2]);
    let written: &[u8] = match &transfer.data {
        Data::Write(written) => written,
        Data::Read(_) => &[],
    };
    let size = match transfer.kind {
        I2cTransfer::Byte => {
            data.0[0] = written.first().copied().unwrap_or(0);
            I2C_SMBUS_BYTE_DATA
        }
        I2cTransfer::Word => {
            if let Some(word) = written.first_chunk::<2>() {
                // The kernel takes a number and sends its low byte first.
                data.0[..2].copy_from_slice(&u16::from_le_bytes(*word).to_ne_bytes());
            }
            I2C_SMBUS_WORD_DATA
        }
        I2cTransfer::Block | I2cTransfer::Raw => {
            let length = match &transfer.data {
                Data::Read(wanted) => wanted.len(),
                Data::Write(_) => written.len(),
            };
            if !(1..=I2C_BLOCK_BYTES_MAX).contains(&length) {
                return Err(Failure::Unfit);
            }
            data.0[0] = u8::try_from(length).unwrap_or(0);
            data.0[1..=written.len()].copy_from_slice(written);
            I2C_SMBUS_I2C_BLOCK_DATA
        }
    };
    Ok((data, size))
}

/// What was read, out of the union.
fn take(data: &SmbusData, transfer: &mut Transfer<'_>) -> Result<(), Failure> {
    let kind = transfer.kind;
    let Data::Read(out) = &mut transfer.data else {
        return Ok(());
    };
    let word = u16::from_ne_bytes([data.0[0], data.0[1]]).to_le_bytes();
    let found: &[u8] = match kind {
        I2cTransfer::Byte => &data.0[..1],
        I2cTransfer::Word => &word,
        I2cTransfer::Block | I2cTransfer::Raw => {
            let length = usize::from(data.0[0]).min(I2C_BLOCK_BYTES_MAX);
            &data.0[1..=length]
        }
    };
    if found.len() != out.len() {
        let what = format!("the device gave {} of {} bytes", found.len(), out.len());
        return Err(Failure::Garbage(what));
    }
    out.copy_from_slice(found);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{offset_of, size_of};

    fn transfer<'a>(kind: I2cTransfer, data: Data<'a>) -> Transfer<'a> {
        Transfer {
            address: 0x48,
            kind,
            register: &[0x25],
            data,
        }
    }

    #[test]
    fn the_structures_have_the_layout_of_the_kernel() {
        let pointer = size_of::<*mut u8>();
        assert_eq!(size_of::<SmbusData>(), 34);
        assert_eq!(
            [
                offset_of!(SmbusArguments, read_write),
                offset_of!(SmbusArguments, command),
                offset_of!(SmbusArguments, size),
                offset_of!(SmbusArguments, data),
                size_of::<SmbusArguments>(),
            ],
            [0, 1, 4, 8, 8 + pointer]
        );
        assert_eq!(
            [
                offset_of!(Message, address),
                offset_of!(Message, flags),
                offset_of!(Message, length),
                offset_of!(Message, bytes),
                size_of::<Message>(),
            ],
            [0, 2, 4, 8, 8 + pointer]
        );
        assert_eq!(
            [
                offset_of!(RdwrArguments, messages),
                offset_of!(RdwrArguments, count),
                size_of::<RdwrArguments>(),
            ],
            [0, pointer, 2 * pointer]
        );
    }

    #[test]
    fn what_is_written_stands_where_the_kernel_looks_for_it() {
        let union_of = |kind, bytes: &[u8]| {
            let (data, size) = prepare(&transfer(kind, Data::Write(bytes))).expect("fits");
            (data.0[..4].to_vec(), size)
        };
        assert_eq!(
            union_of(I2cTransfer::Byte, &[0x7f]),
            (vec![0x7f, 0, 0, 0], 2)
        );
        let number = 0x1000u16.to_ne_bytes();
        assert_eq!(
            union_of(I2cTransfer::Word, &[0x00, 0x10]),
            (vec![number[0], number[1], 0, 0], 3)
        );
        assert_eq!(
            union_of(I2cTransfer::Block, &[7, 8, 9]),
            (vec![3, 7, 8, 9], 8)
        );
        let mut long = [0; 33];
        let refused = prepare(&transfer(I2cTransfer::Block, Data::Read(&mut long)));
        assert!(matches!(refused, Err(Failure::Unfit)));
    }

    #[test]
    fn what_was_read_comes_out_in_the_order_of_the_wire() {
        let mut union = SmbusData([0; 34]);
        union.0[..2].copy_from_slice(&0x3ffu16.to_ne_bytes());
        let mut word = [0; 2];
        take(
            &union,
            &mut transfer(I2cTransfer::Word, Data::Read(&mut word)),
        )
        .expect("read");
        assert_eq!(word, [0xff, 0x03]);
        union.0[..5].copy_from_slice(&[4, 1, 2, 3, 4]);
        let mut block = [0; 4];
        take(
            &union,
            &mut transfer(I2cTransfer::Block, Data::Read(&mut block)),
        )
        .expect("read");
        assert_eq!(block, [1, 2, 3, 4]);
        union.0[0] = 3;
        let short = take(
            &union,
            &mut transfer(I2cTransfer::Block, Data::Read(&mut block)),
        );
        assert!(matches!(short, Err(Failure::Garbage(_))));
    }

    #[test]
    fn a_device_that_is_no_bus_says_so() {
        let opened = Adapter::open(Path::new("/dev/null"), Duration::from_secs(1));
        assert!(matches!(opened, Err(Failure::Errno(libc::ENOTTY))));
    }
}
