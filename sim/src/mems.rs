//! Accelerometer and gyroscope as IIO devices: attributes, and samples with the bytes of the real drivers.
//!
//! MMA8451 (`mma8451`): s14 in the high bits of 16, high byte first, 4096 counts per g, 50 Hz. L3GD20 (`l3gd20`): s16, low byte first,
//! 8.75 mdps per count, 95 Hz; its axes are turned: the body's x is -y of the chip, y is -x, z is z.
//! A scan has the enabled elements in the order of their indices, each aligned to its size, padded to the largest.
//! Samples flow while somebody reads and the buffer is enabled.

use crate::attributes::Attributes;
use crate::body::Senses;
use crate::faults::{self, Fault};
use crate::fifo::{Out, Reader};
use crate::files::Part;
use crate::limits::MAX_CATCH_UP_S;
use crate::random::Random;
use crate::shared::Shared;
use std::io;

const STANDARD_GRAVITY_MPS2: f64 = 9.806_65;
const COUNTS_PER_G: f64 = 4096.0;
const DPS_PER_COUNT: f64 = 0.008_75;
/// x, y and z, then the time.
const ELEMENTS: usize = 4;

/// What differs between the two.
struct Kind {
    device: &'static str,
    name: &'static str,
    /// `accel` or `anglvel`.
    channel: &'static str,
    element_type: &'static str,
    scale: &'static str,
    rates_hz: &'static [&'static str],
    rate_hz: f64,
    fault: usize,
    /// Deviation of a sample, and largest offset that a chip of this kind has, in counts.
    noise: f64,
    bias: f64,
    limit: f64,
    counts: fn(&Senses) -> [f64; 3],
    bytes: fn(i16) -> [u8; 2],
}

const ACCELEROMETER: Kind = Kind {
    device: "iio:device0",
    name: "mma8451",
    channel: "accel",
    element_type: "be:s14/16>>2",
    scale: "0.002394",
    rates_hz: &["800", "400", "200", "100", "50", "12.5", "6.25", "1.56"],
    rate_hz: 50.0,
    fault: faults::ACCELEROMETER,
    noise: 3.0,
    bias: 60.0,
    limit: 8191.0,
    counts: acceleration_counts,
    bytes: |value| (value << 2).to_be_bytes(),
};

const GYROSCOPE: Kind = Kind {
    device: "iio:device1",
    name: "l3gd20",
    channel: "anglvel",
    element_type: "le:s16/16>>0",
    scale: "0.000152716",
    rates_hz: &["95", "190", "380", "760"],
    rate_hz: 95.0,
    fault: faults::GYROSCOPE,
    noise: 12.0,
    bias: 200.0,
    limit: 32767.0,
    counts: rate_counts,
    bytes: i16::to_le_bytes,
};

/// Forward, left and up are x, y and z of the chip.
fn acceleration_counts(senses: &Senses) -> [f64; 3] {
    senses
        .acceleration_mps2
        .map(|value| value / STANDARD_GRAVITY_MPS2 * COUNTS_PER_G)
}

/// From the axes of the body to those of the chip.
fn rate_counts(senses: &Senses) -> [f64; 3] {
    let [x, y, z] = senses.rate_dps.map(|value| value / DPS_PER_COUNT);
    [-y, -x, z]
}

/// One of the two chips.
pub struct Mems {
    kind: &'static Kind,
    out: Out,
    is_enabled: bool,
    elements: [bool; ELEMENTS],
    period_s: f64,
    due_s: f64,
    bias: [f64; 3],
    last: [i16; 3],
}

impl Mems {
    /// Both chips with their files.
    pub fn make(attributes: &mut Attributes, seed: u64) -> io::Result<[Self; 2]> {
        let mut random = Random::new(seed);
        Ok([
            Self::one(&ACCELEROMETER, attributes, &mut random)?,
            Self::one(&GYROSCOPE, attributes, &mut random)?,
        ])
    }

    fn one(
        kind: &'static Kind,
        attributes: &mut Attributes,
        random: &mut Random,
    ) -> io::Result<Self> {
        let folder = format!("sys/bus/iio/devices/{}", kind.device);
        let rates = kind.rates_hz.join(" ");
        let rate = kind.rate_hz.to_string();
        for (name, text) in [
            ("name", kind.name),
            ("sampling_frequency", rate.as_str()),
            ("sampling_frequency_available", rates.as_str()),
            ("buffer/enable", "0"),
            ("buffer/length", "2"),
        ] {
            attributes.make(&format!("{folder}/{name}"), text)?;
        }
        attributes.make(&format!("{folder}/in_{}_scale", kind.channel), kind.scale)?;
        for index in 0..ELEMENTS {
            let path = format!("{folder}/scan_elements/{}", element(kind, index));
            let is_time = index == ELEMENTS - 1;
            attributes.make(&format!("{path}_en"), "0")?;
            attributes.make(&format!("{path}_index"), &index.to_string())?;
            let element_type = if is_time {
                "le:s64/64>>0"
            } else {
                kind.element_type
            };
            attributes.make(&format!("{path}_type"), element_type)?;
        }
        let path = attributes.root().join("dev").join(kind.device);
        Ok(Self {
            kind,
            out: Out::make(path)?,
            is_enabled: false,
            elements: [false; ELEMENTS],
            period_s: 1.0 / kind.rate_hz,
            due_s: 0.0,
            bias: std::array::from_fn(|_| random.within(kind.bias)),
            last: [0; 3],
        })
    }

    fn sample(&mut self, senses: &Senses, fault: Fault, random: &mut Random) -> [i16; 3] {
        if fault.stuck {
            return self.last;
        }
        let counts = (self.kind.counts)(senses);
        for (axis, value) in counts.into_iter().enumerate() {
            let noise = random.normal() * self.kind.noise + random.within(fault.noise);
            let limit = self.kind.limit;
            let value = (value + self.bias[axis] + noise).round();
            self.last[axis] = value.clamp(-limit - 1.0, limit) as i16;
        }
        self.last
    }

    /// One sample at this time, if its fault lets it out.
    fn send(&mut self, shared: &Shared) -> f64 {
        let mut machine = shared.machine();
        let fault = machine.faults[self.kind.fault];
        let senses = machine.senses();
        let time_ns = machine.real_time_ns_at(self.due_s);
        let random = &mut machine.random;
        let values = self.sample(&senses, fault, random);
        let mut scan = scan(values.map(self.kind.bytes), time_ns, self.elements);
        if fault.garbage {
            random.fill(&mut scan);
        }
        if !random.chance(fault.drop) && !scan.is_empty() {
            self.out.send(&scan);
        }
        f64::from(fault.slow_ms) / 1000.0
    }
}

/// The name of an element's files, without their ending.
fn element(kind: &Kind, index: usize) -> String {
    match index {
        3 => "in_timestamp".to_owned(),
        _ => format!("in_{}_{}", kind.channel, ["x", "y", "z"][index]),
    }
}

/// The enabled elements, aligned and padded.
fn scan(values: [[u8; 2]; 3], time_ns: i64, enabled: [bool; ELEMENTS]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(16);
    let mut largest = 1;
    let chosen = values.iter().zip(enabled).filter(|(_, enabled)| *enabled);
    for (value, _) in chosen {
        bytes.extend_from_slice(value);
        largest = 2;
    }
    if enabled[3] {
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes.extend_from_slice(&time_ns.to_le_bytes());
        largest = 8;
    }
    bytes.resize(bytes.len().next_multiple_of(largest), 0);
    bytes
}

impl Part for Mems {
    fn run(&mut self, shared: &Shared) -> f64 {
        let (now_s, fault) = {
            let machine = shared.machine();
            (machine.time_s(), machine.faults[self.kind.fault])
        };
        self.out.set_there(!fault.unplug);
        let reader = self.out.reader();
        if reader == Reader::None || !self.is_enabled {
            self.due_s = now_s;
            return f64::INFINITY;
        }
        // Late samples are made up for, as far as the FIFO goes.
        self.due_s = self.due_s.max(now_s - MAX_CATCH_UP_S);
        while self.due_s <= now_s {
            let slower_s = self.send(shared);
            self.due_s += self.period_s + slower_s;
        }
        self.due_s
    }

    fn changed(&mut self, name: &str, attributes: &Attributes) {
        let folder = format!("sys/bus/iio/devices/{}/", self.kind.device);
        let Some(name_here) = name.strip_prefix(&folder) else {
            return;
        };
        let Some(text) = attributes.line(name) else {
            return;
        };
        match name_here {
            "buffer/enable" => self.is_enabled = text == "1",
            "sampling_frequency" => {
                let known = self.kind.rates_hz.iter().find(|rate| **rate == text);
                if let Some(rate) = known.and_then(|rate| rate.parse::<f64>().ok()) {
                    self.period_s = 1.0 / rate;
                } else {
                    // What the driver refuses does not stand in the attribute.
                    let rate = (1000.0 / self.period_s).round() / 1000.0;
                    let _ = attributes.write(name, &rate.to_string());
                }
            }
            _ => {
                let is_it = |index: &usize| {
                    name_here == format!("scan_elements/{}_en", element(self.kind, *index))
                };
                if let Some(index) = (0..ELEMENTS).find(is_it) {
                    self.elements[index] = text == "1";
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 g is 4096 counts: 4096 << 2 = 0x4000; -1 << 2 = 0xFFFC; two bytes of padding before the time.
    #[test]
    fn a_scan_of_the_accelerometer_has_its_real_bytes() {
        let values = [0, -1, 4096].map(ACCELEROMETER.bytes);
        let time_ns = 0x0102_0304_0506_0708;
        assert_eq!(
            scan(values, time_ns, [true; 4]),
            [0, 0, 0xFF, 0xFC, 0x40, 0, 0, 0, 8, 7, 6, 5, 4, 3, 2, 1]
        );
        let x_and_z = [true, false, true, false];
        assert_eq!(scan(values, time_ns, x_and_z), [0, 0, 0x40, 0]);
        assert!(scan(values, time_ns, [false; 4]).is_empty());
        let only_time = [false, false, false, true];
        assert_eq!(scan(values, time_ns, only_time).len(), 8);
    }

    /// 87.5 degrees per second are 10000 counts.
    #[test]
    fn a_turn_to_the_left_is_plus_z_and_the_other_axes_are_turned() {
        let senses = Senses {
            rate_dps: [8.75, -17.5, 87.5],
            ..Senses::default()
        };
        let counts = rate_counts(&senses);
        for (count, expected) in counts.into_iter().zip([2000.0, -1000.0, 10_000.0]) {
            assert!((count - expected).abs() < 1e-6, "{counts:?}");
        }
        assert_eq!((GYROSCOPE.bytes)(10_000), [0x10, 0x27]);
    }

    #[test]
    fn at_rest_one_g_points_up() {
        let senses = Senses {
            acceleration_mps2: [0.0, 0.0, STANDARD_GRAVITY_MPS2],
            ..Senses::default()
        };
        assert_eq!(acceleration_counts(&senses), [0.0, 0.0, 4096.0]);
    }
}
