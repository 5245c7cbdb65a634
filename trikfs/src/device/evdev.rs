//! Linux input devices decoded: the newest value of each watched code, one tuple per SYN_REPORT; or every event as it is.
//!
//! Owns the layout of `struct input_event` (linux/input.h: two time fields, u16 type, u16 code, s32 value) for
//! 32- and 64-bit times and the rule for SYN_DROPPED: everything up to the next SYN_REPORT is thrown away. A real
//! device is asked for its present values when it is opened and after such a gap; no event means the same value.

mod present;

use super::{Device, Got, Kind, Patience, Stream, Surroundings, chardev, fifo};
use crate::errno::Error;
use config::description::{EvdevDescription, EvdevLayout};
use std::os::fd::BorrowedFd;
use std::os::unix::fs::FileTypeExt;
use std::time::{Duration, Instant};

const EV_SYN: u16 = 0;
const SYN_REPORT: u16 = 0;
const SYN_DROPPED: u16 = 3;

impl Kind for EvdevDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Ok(Device::Stream(Box::new(Evdev::open(self)?)))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(true)
    }
}

/// A decoder in front of the device's bytes.
pub struct Evdev {
    bytes: Box<dyn Stream>,
    decoder: Decoder,
    raw: Vec<u8>,
}

impl Evdev {
    /// Opens the device, or a FIFO of recorded events.
    pub fn open(description: &EvdevDescription) -> Result<Self, Error> {
        let path = &description.path;
        let meta = std::fs::metadata(path).map_err(|error| super::device_error(path, &error))?;
        let bytes: Box<dyn Stream> = if meta.file_type().is_fifo() {
            Box::new(fifo::Fifo::open(path)?)
        } else {
            Box::new(chardev::CharDevice::open(path)?)
        };
        let mut evdev = Self {
            bytes,
            decoder: Decoder::new(description),
            raw: vec![0; 64 * 24],
        };
        evdev.ask();
        Ok(evdev)
    }

    /// Makes a report of the present values, if the device can be asked. A FIFO of events cannot.
    fn ask(&mut self) {
        let Some(fd) = self.bytes.fd() else { return };
        let decoder = &mut self.decoder;
        let mut is_answered = false;
        for (value, (kind, code)) in decoder.values.iter_mut().zip(&decoder.codes) {
            if let Some(present) = present::present_value(fd, *kind, *code) {
                *value = present;
                is_answered = true;
            }
        }
        if is_answered {
            decoder.report();
        }
    }
}

impl Stream for Evdev {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        loop {
            let given = self.decoder.take(buf);
            if given > 0 {
                return Ok(Got::Bytes(given));
            }
            match self.bytes.read(&mut self.raw)? {
                Got::Bytes(n) => {
                    self.decoder.feed(&self.raw[..n]);
                    if std::mem::take(&mut self.decoder.has_lost) {
                        self.ask();
                    }
                }
                other => return Ok(other),
            }
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        self.bytes.fd()
    }

    /// The answer to a question comes without an event.
    fn wake_at(&self) -> Option<Instant> {
        (!self.decoder.ready.is_empty()).then(Instant::now)
    }

    /// A device that was asked has answered; all else that comes is somebody's doing.
    fn is_silent(&self, open: Duration, _patience: Patience) -> bool {
        self.decoder.ready.is_empty() && open >= Patience::WITH_NOBODY
    }

    /// With every event as a tuple, each is news of its own.
    fn tells_changes_only(&self) -> bool {
        !self.decoder.codes.is_empty()
    }

    fn is_still_there(&self) -> bool {
        self.bytes.is_still_there()
    }
}

/// Events in, tuples out.
struct Decoder {
    /// None: every event is a tuple.
    codes: Vec<(u16, u16)>,
    event_size: usize,
    values: Vec<i32>,
    partial: Vec<u8>,
    ready: Vec<u8>,
    dropping: bool,
    /// Events were lost, so the values may be old.
    has_lost: bool,
}

impl Decoder {
    fn new(description: &EvdevDescription) -> Self {
        let event_size = match description.layout {
            EvdevLayout::Bits32 => 16,
            EvdevLayout::Bits64 => 24,
            EvdevLayout::Native => 2 * size_of::<libc::c_long>() + 8,
        };
        Self {
            codes: description.codes.clone(),
            event_size,
            values: vec![0; description.codes.len()],
            partial: Vec::with_capacity(event_size),
            ready: Vec::new(),
            dropping: false,
            has_lost: false,
        }
    }

    fn feed(&mut self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let missing = self.event_size - self.partial.len();
            let taken = missing.min(bytes.len());
            self.partial.extend_from_slice(&bytes[..taken]);
            bytes = &bytes[taken..];
            if self.partial.len() == self.event_size {
                let (time, tail) = self.partial.split_at(self.event_size - 8);
                let time_us = time_us(time);
                let kind = u16::from_ne_bytes([tail[0], tail[1]]);
                let code = u16::from_ne_bytes([tail[2], tail[3]]);
                let value = i32::from_ne_bytes([tail[4], tail[5], tail[6], tail[7]]);
                self.partial.clear();
                if self.codes.is_empty() {
                    self.ready.extend_from_slice(&kind.to_le_bytes());
                    self.ready.extend_from_slice(&code.to_le_bytes());
                    self.ready.extend_from_slice(&value.to_le_bytes());
                    self.ready.extend_from_slice(&time_us.to_le_bytes());
                } else {
                    self.event(kind, code, value);
                }
            }
        }
    }

    fn event(&mut self, kind: u16, code: u16, value: i32) {
        match (kind, code) {
            (EV_SYN, SYN_DROPPED) => self.dropping = true,
            (EV_SYN, SYN_REPORT) if self.dropping => {
                self.dropping = false;
                self.has_lost = true;
            }
            (EV_SYN, SYN_REPORT) => self.report(),
            _ if self.dropping => {}
            _ => {
                if let Some(at) = self
                    .codes
                    .iter()
                    .position(|&watched| watched == (kind, code))
                {
                    self.values[at] = value;
                }
            }
        }
    }

    fn report(&mut self) {
        for value in &self.values {
            self.ready.extend_from_slice(&value.to_le_bytes());
        }
    }

    fn take(&mut self, buf: &mut [u8]) -> usize {
        let n = self.ready.len().min(buf.len());
        buf[..n].copy_from_slice(&self.ready[..n]);
        self.ready.drain(..n);
        n
    }
}

/// Seconds and microseconds, each half of the bytes.
fn time_us(time: &[u8]) -> i64 {
    let (seconds, us) = time.split_at(time.len() / 2);
    let number = |bytes: &[u8]| match bytes {
        [a, b, c, d] => i32::from_ne_bytes([*a, *b, *c, *d]).into(),
        _ => bytes.first_chunk().copied().map_or(0, i64::from_ne_bytes),
    };
    number(seconds)
        .saturating_mul(1_000_000)
        .saturating_add(number(us))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(times: usize, kind: u16, code: u16, value: i32) -> Vec<u8> {
        let mut bytes = vec![0xaa; times];
        bytes.extend_from_slice(&kind.to_ne_bytes());
        bytes.extend_from_slice(&code.to_ne_bytes());
        bytes.extend_from_slice(&value.to_ne_bytes());
        bytes
    }

    fn decode(layout: EvdevLayout, times: usize, split: usize) -> Vec<u8> {
        let codes = vec![(3, 0), (1, 28)];
        let mut decoder = Decoder::new(&EvdevDescription {
            path: "x".into(),
            codes,
            layout,
        });
        let mut bytes = Vec::new();
        bytes.extend(event(times, 3, 0, -5)); // ABS_X
        bytes.extend(event(times, 3, 1, 99)); // ABS_Y is not watched
        bytes.extend(event(times, 0, 0, 0)); // SYN_REPORT: (-5, 0)
        bytes.extend(event(times, 0, 3, 0)); // SYN_DROPPED
        bytes.extend(event(times, 3, 0, 1000)); // lost with the rest of its report
        bytes.extend(event(times, 0, 0, 0));
        bytes.extend(event(times, 1, 28, 1)); // KEY_ENTER
        bytes.extend(event(times, 0, 0, 0)); // (-5, 1)
        for part in bytes.chunks(split) {
            decoder.feed(part);
        }
        let mut out = [0; 64];
        let n = decoder.take(&mut out);
        out[..n].to_vec()
    }

    #[test]
    fn each_report_gives_one_tuple_in_both_layouts_however_the_bytes_are_cut() {
        let mut expected = Vec::new();
        for value in [-5i32, 0, -5, 1] {
            expected.extend_from_slice(&value.to_le_bytes());
        }
        for split in [1, 7, 16, 24, 1000] {
            assert_eq!(decode(EvdevLayout::Bits32, 8, split), expected);
            assert_eq!(decode(EvdevLayout::Bits64, 16, split), expected);
        }
    }

    #[test]
    fn every_event_can_be_a_tuple() {
        let mut decoder = Decoder::new(&EvdevDescription {
            path: "x".into(),
            codes: Vec::new(),
            layout: EvdevLayout::Bits32,
        });
        for (kind, code, value) in [(1, 28, 1), (0, 0, 0), (0, 3, 0), (3, 0, -5)] {
            let mut bytes = event(0, kind, code, value);
            bytes.splice(
                0..0,
                [7i32.to_ne_bytes(), 250_000i32.to_ne_bytes()].concat(),
            );
            decoder.feed(&bytes);
        }
        let mut out = [0; 128];
        assert_eq!(decoder.take(&mut out), 64);
        for (tuple, (kind, code, value)) in out.chunks(EvdevDescription::EVENT_BYTES).zip([
            (1u16, 28u16, 1i32),
            (0, 0, 0),
            (0, 3, 0),
            (3, 0, -5),
        ]) {
            assert_eq!(tuple[..2], kind.to_le_bytes());
            assert_eq!(tuple[2..4], code.to_le_bytes());
            assert_eq!(tuple[4..8], value.to_le_bytes());
            assert_eq!(tuple[8..], 7_250_000i64.to_le_bytes());
        }
    }
}
