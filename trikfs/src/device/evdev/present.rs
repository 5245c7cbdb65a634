//! The present values of an input device, as it tells them when it is asked.
//!
//! Owns the requests EVIOCGABS, EVIOCGKEY, EVIOCGLED and EVIOCGSW of linux/input.h. The kernel sends an event only when
//! a value changes, so without asking, what has not changed since long would not be known. Knows no tuple.

use std::os::fd::{AsRawFd, BorrowedFd};

const EV_KEY: u16 = 1;
const EV_ABS: u16 = 3;
const EV_SW: u16 = 5;
const EV_LED: u16 = 0x11;
/// Letter of all requests to input devices.
const LETTER: u8 = b'E';
/// Bytes that hold one bit for each code of a type: KEY_MAX is 0x2ff.
const BITS_BYTES: usize = 0x300 / 8;

/// Asks for one value. None: the device has no such code, or is none that can be asked.
pub(super) fn present_value(fd: BorrowedFd<'_>, kind: u16, code: u16) -> Option<i32> {
    let number = match kind {
        EV_ABS if code <= 0x3f => {
            // struct input_absinfo: six s32, the first of which is the value.
            let mut info = [0; 24];
            ask(fd, 0x40 + u8::try_from(code).ok()?, &mut info)?;
            return Some(i32::from_ne_bytes(*info.first_chunk()?));
        }
        EV_KEY => 0x18,
        EV_LED => 0x19,
        EV_SW => 0x1b,
        _ => return None,
    };
    let mut bits = [0; BITS_BYTES];
    ask(fd, number, &mut bits)?;
    bit(&bits, code)
}

/// One bit of those that the kernel stores in machine words.
fn bit(bits: &[u8], code: u16) -> Option<i32> {
    let (byte, bit) = (usize::from(code / 8), code % 8);
    // In a machine word of a big-endian processor the first bits are in the last byte.
    let byte = if cfg!(target_endian = "big") {
        byte ^ (size_of::<libc::c_ulong>() - 1)
    } else {
        byte
    };
    Some(i32::from(bits.get(byte)? >> bit & 1))
}

/// The number of a request that reads, as asm-generic/ioctl.h composes it: direction, size, letter, number.
fn read_request(number: u8, size: u8) -> libc::Ioctl {
    let direction_read = 2 << 30;
    direction_read
        | libc::Ioctl::from(size) << 16
        | libc::Ioctl::from(LETTER) << 8
        | libc::Ioctl::from(number)
}

/// One request that fills a buffer.
fn ask(fd: BorrowedFd<'_>, number: u8, buf: &mut [u8]) -> Option<()> {
    let request = read_request(number, u8::try_from(buf.len()).ok()?);
    // SAFETY: `read_request` has put the size of `buf` into the request; the kernel writes at most so many bytes, and
    // `buf` is borrowed mutably for as long as the call takes.
    let outcome = unsafe { libc::ioctl(fd.as_raw_fd(), request, buf.as_mut_ptr()) };
    (outcome >= 0).then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::fd::AsFd;

    #[test]
    fn requests_have_the_numbers_of_the_kernel() {
        // EVIOCGABS(ABS_DISTANCE) and EVIOCGKEY(96) as a C compiler gives them for this machine's ioctl encoding.
        assert_eq!(read_request(0x40 + 0x19, 24), 0x8018_4559);
        assert_eq!(read_request(0x18, 96), 0x8060_4518);
    }

    #[test]
    fn bits_are_counted_from_the_lowest_of_the_first_byte() {
        let mut bits = [0; BITS_BYTES];
        bits[3] = 0b0001_0000;
        if cfg!(target_endian = "little") {
            assert_eq!((bit(&bits, 28), bit(&bits, 27)), (Some(1), Some(0)));
        }
        assert_eq!(bit(&bits, 0x2ff), Some(0));
        assert_eq!(bit(&bits, 0x300), None);
    }

    #[test]
    fn what_is_no_input_device_has_no_values() {
        let null = std::fs::File::open("/dev/null").unwrap();
        for (kind, code) in [
            (EV_ABS, 0),
            (EV_KEY, 28),
            (EV_LED, 0),
            (EV_SW, 0),
            (2, 0),
            (EV_ABS, 0x40),
        ] {
            assert_eq!(present_value(null.as_fd(), kind, code), None);
        }
    }
}
