//! A lidar on the serial line, as bytes: 16 packets for each turn, 230400 baud.
//!
//! Packet, high bytes first: AA, u16 length, version 01, type 61, AD, u16 length of the data (length - 8), u8 speed
//! (0.05 turns per second), u16 offset of zero, u16 first angle in 0.01 degree, then for each probe u8 signal and u16
//! distance in quarters of a millimetre (0: no echo), and the u16 sum of all bytes before it.
//! Angle 0 is straight ahead and angles grow clockwise, seen from above.

use crate::attributes::Attributes;
use crate::faults;
use crate::fifo::{Out, Reader};
use crate::files::Part;
use crate::shared::Shared;
use std::io;

const PACKETS_PER_TURN: u16 = 16;
/// 22.5 degrees.
const ANGLE_PER_PACKET: u16 = 2250;
const PROBES: usize = 32;
const TURNS_PER_S: f64 = 6.0;
const SIGNAL: u8 = 60;
/// Deviation of a distance.
const NOISE_MM: f64 = 3.0;

/// One packet; distances in millimetres, 0 is no echo.
fn packet(start_angle: u16, distances_mm: &[f64]) -> Vec<u8> {
    let data = 5 + 3 * distances_mm.len();
    let length = data + 8;
    let mut bytes = vec![0xAA];
    bytes.extend((length as u16).to_be_bytes());
    bytes.extend([0x01, 0x61, 0xAD]);
    bytes.extend((data as u16).to_be_bytes());
    bytes.push((TURNS_PER_S / 0.05) as u8);
    bytes.extend(0u16.to_be_bytes());
    bytes.extend(start_angle.to_be_bytes());
    for distance_mm in distances_mm {
        let raw = (distance_mm * 4.0).round().clamp(0.0, 65535.0) as u16;
        bytes.push(if raw == 0 { 0 } else { SIGNAL });
        bytes.extend(raw.to_be_bytes());
    }
    let sum = bytes
        .iter()
        .fold(0u16, |sum, &byte| sum.wrapping_add(u16::from(byte)));
    bytes.extend(sum.to_be_bytes());
    bytes
}

/// The lidar and its line.
pub struct Lidar {
    out: Out,
    /// Number of the next packet within its turn.
    next: u16,
    due_s: f64,
    last: Vec<u8>,
}

impl Lidar {
    /// The serial line.
    pub fn make(attributes: &Attributes) -> io::Result<Self> {
        Ok(Self {
            out: Out::make(attributes.root().join("dev/ttyS1"))?,
            next: 0,
            due_s: 0.0,
            last: Vec::new(),
        })
    }

    /// Looks around within one packet, and sends it; how much longer its fault makes it take.
    fn send(&mut self, shared: &Shared) -> f64 {
        let start_angle = self.next * ANGLE_PER_PACKET;
        self.next = (self.next + 1) % PACKETS_PER_TURN;
        let mut machine = shared.machine();
        let fault = machine.faults[faults::LIDAR];
        if fault.unplug || !machine.body().has_lidar() {
            return 0.0;
        }
        let mut distances_mm = [0.0; PROBES];
        for (index, distance_mm) in distances_mm.iter_mut().enumerate() {
            let hundredths =
                f64::from(start_angle) + f64::from(ANGLE_PER_PACKET) * index as f64 / PROBES as f64;
            let range_m = machine.body().range_m((hundredths / 100.0).to_radians());
            let noise_mm = machine.random.normal() * NOISE_MM + machine.random.within(fault.noise);
            *distance_mm = range_m.map_or(0.0, |metres| metres * 1000.0 + noise_mm);
        }
        let mut bytes = packet(start_angle, &distances_mm);
        if fault.stuck && !self.last.is_empty() {
            bytes.clone_from(&self.last);
        }
        self.last.clone_from(&bytes);
        if fault.garbage {
            // Some bytes of the packet are wrong, as on a bad line.
            for _ in 0..4 {
                let at = (machine.random.unit() * bytes.len() as f64) as usize;
                bytes[at] = machine.random.bits() as u8;
            }
        }
        if !machine.random.chance(fault.drop) {
            self.out.send(&bytes);
        }
        f64::from(fault.slow_ms) / 1000.0
    }
}

impl Part for Lidar {
    fn run(&mut self, shared: &Shared) -> f64 {
        let now_s = shared.machine().time_s();
        if self.out.reader() == Reader::None {
            self.due_s = now_s;
            return f64::INFINITY;
        }
        let period_s = 1.0 / TURNS_PER_S / f64::from(PACKETS_PER_TURN);
        // At most one turn is made up for.
        self.due_s = self.due_s.max(now_s - 1.0 / TURNS_PER_S);
        while self.due_s <= now_s {
            self.due_s += period_s + self.send(shared);
        }
        self.due_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One probe at 1000 mm: 4000 = 0x0FA0; length 16, data 8.
    #[test]
    fn a_packet_has_the_bytes_of_the_protocol() {
        let bytes = packet(2250, &[1000.0]);
        let expected = [
            0xAA, 0x00, 0x10, 0x01, 0x61, 0xAD, 0x00, 0x08, 120, 0x00, 0x00, 0x08, 0xCA, 60, 0x0F,
            0xA0,
        ];
        assert_eq!(bytes[..16], expected);
        // AA+10+01+61+AD = 1C9; +08 = 1D1; +78 = 249; +08+CA = 31B; +3C+0F+A0 = 406.
        assert_eq!(bytes[16..], [0x04, 0x06]);
        assert_eq!(bytes.len(), 16 + 2, "length and two bytes");
    }

    #[test]
    fn no_echo_is_a_distance_and_a_signal_of_0() {
        let bytes = packet(0, &[0.0, 99_999.0]);
        assert_eq!(bytes[13..16], [0, 0, 0]);
        assert_eq!(bytes[16..19], [60, 0xFF, 0xFF]);
    }
}
