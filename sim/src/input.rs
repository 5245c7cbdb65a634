//! Ultrasonic sensors and keys as input devices: packets of `struct input_event`, as evdev gives them.
//!
//! HC-SR04 on D1 to D3: ABS_DISTANCE in cm and ABS_MISC in us, measured every 100 ms while somebody reads; -1 without an
//! echo. Keys come from lines in `control/keys`: `press NAME`, `release NAME` or `click NAME`; `control/keys.error` says
//! what was wrong with the last ones.
//! A FIFO cannot be asked for present values, so they are sent when a reader comes; then only changes, as the input core
//! does it.

use crate::attributes::{Attributes, appear};
use crate::faults::{self, Fault};
use crate::fifo::{In, Out, Reader};
use crate::files::Part;
use crate::mistake::Mistake;
use crate::random::Random;
use crate::shared::Shared;
use std::io;
use std::os::fd::BorrowedFd;
use std::path::PathBuf;

const EV_SYN: u16 = 0;
const EV_KEY: u16 = 1;
const EV_ABS: u16 = 3;
const ABS_DISTANCE: u16 = 0x19;
const ABS_MISC: u16 = 0x28;
const PERIOD_S: f64 = 0.1;
/// Time of flight for one metre there and back, at 343 m/s.
const ECHO_US_PER_M: f64 = 2e6 / 343.0;
const PORTS: [&str; 3] = ["trik_jd1", "trik_jd2", "trik_jf1"];
const KEY_DEVICE: &str = "soc@1c00000:gpio-keys";
const CONTROL: &str = "control/keys";
const FOLDER: &str = "dev/input/by-path";
const KEYS: [(&str, u16); 7] = [
    ("power", 116),
    ("up", 103),
    ("esc", 1),
    ("left", 105),
    ("right", 106),
    ("down", 108),
    ("enter", 28),
];

/// One event as the kernel of this machine writes it: two time fields, u16 type, u16 code, s32 value.
fn event(time_ns: i64, kind: u16, code: u16, value: i32) -> Vec<u8> {
    let seconds = (time_ns / 1_000_000_000) as libc::c_long;
    let microseconds = (time_ns % 1_000_000_000 / 1000) as libc::c_long;
    let mut bytes = Vec::with_capacity(24);
    bytes.extend_from_slice(&seconds.to_ne_bytes());
    bytes.extend_from_slice(&microseconds.to_ne_bytes());
    bytes.extend_from_slice(&kind.to_ne_bytes());
    bytes.extend_from_slice(&code.to_ne_bytes());
    bytes.extend_from_slice(&value.to_ne_bytes());
    bytes
}

/// A packet: some events and the report that ends it.
fn packet(time_ns: i64, kind: u16, values: &[(u16, i32)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for &(code, value) in values {
        bytes.extend(event(time_ns, kind, code, value));
    }
    bytes.extend(event(time_ns, EV_SYN, 0, 0));
    bytes
}

/// Where an input device is, below the root.
fn path(name: &str) -> String {
    format!("{FOLDER}/platform-{name}-event")
}

/// One ultrasonic sensor.
pub struct Ultrasonic {
    port: usize,
    out: Out,
    due_s: f64,
    /// Centimetres and microseconds as they were sent last.
    sent: [i32; 2],
    /// The last three measurements, for the driver's median.
    window: [i32; 3],
}

impl Ultrasonic {
    /// The three ports.
    pub fn make(attributes: &mut Attributes) -> io::Result<Vec<Self>> {
        attributes.device_folder(FOLDER)?;
        let one = |port: usize| {
            Ok(Self {
                port,
                out: Out::make(attributes.root().join(path(PORTS[port])))?,
                due_s: 0.0,
                sent: [-1, 0],
                window: [-1; 3],
            })
        };
        (0..PORTS.len()).map(one).collect()
    }

    /// One measurement: centimetres after the driver's median filter, and microseconds.
    fn measure(&mut self, distance_m: Option<f64>, fault: Fault, random: &mut Random) -> [i32; 2] {
        let noise_m = random.within(fault.noise) / 100.0 + random.normal() * 0.001;
        let echo_us = distance_m.map(|metres| ((metres + noise_m).max(0.0) * ECHO_US_PER_M) as i32);
        let cm = echo_us.map_or(-1, |us| (us << 4) / 931);
        self.window.rotate_left(1);
        self.window[2] = cm;
        let mut sorted = self.window;
        sorted.sort_unstable();
        [sorted[1], echo_us.unwrap_or(0)]
    }

    fn send(&mut self, shared: &Shared, is_new_reader: bool) -> f64 {
        let mut machine = shared.machine();
        let fault = machine.faults[faults::DIGITAL + self.port];
        let time_ns = machine.real_time_ns();
        let distance_m = machine.senses().ultrasonic_m[self.port];
        let random = &mut machine.random;
        if is_new_reader {
            // The median begins with what is there now.
            for _ in 0..3 {
                self.sent = self.measure(distance_m, fault, random);
            }
            let values = [(ABS_DISTANCE, self.sent[0]), (ABS_MISC, self.sent[1])];
            self.out.send(&packet(time_ns, EV_ABS, &values));
        } else if !fault.stuck && !random.chance(fault.drop) {
            let now = self.measure(distance_m, fault, random);
            let mut values = vec![(ABS_DISTANCE, now[0]), (ABS_MISC, now[1])];
            let before = self.sent;
            values.retain(|&(code, value)| value != before[usize::from(code == ABS_MISC)]);
            self.sent = now;
            let mut bytes = packet(time_ns, EV_ABS, &values);
            if fault.garbage {
                random.fill(&mut bytes);
            }
            if !values.is_empty() {
                self.out.send(&bytes);
            }
        }
        f64::from(fault.slow_ms) / 1000.0
    }
}

impl Part for Ultrasonic {
    fn run(&mut self, shared: &Shared) -> f64 {
        let (now_s, fault) = {
            let machine = shared.machine();
            (
                machine.time_s(),
                machine.faults[faults::DIGITAL + self.port],
            )
        };
        self.out.set_there(!fault.unplug);
        let reader = self.out.reader();
        if reader == Reader::None {
            return f64::INFINITY;
        }
        if reader == Reader::New || self.due_s <= now_s {
            let slower_s = self.send(shared, reader == Reader::New);
            self.due_s = now_s + PERIOD_S + slower_s;
        }
        self.due_s
    }

    fn changed(&mut self, name: &str, _attributes: &Attributes) {
        if name == path(PORTS[self.port]) {
            self.out.reader_left();
        }
    }
}

/// A key, and what it is after each other, from a line.
fn order(line: &str) -> Result<(usize, &'static [bool]), Mistake> {
    let mut words = line.split_whitespace();
    let (verb, name) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
    let states: &[bool] = match verb {
        "press" => &[true],
        "release" => &[false],
        "click" => &[true, false],
        _ => {
            return Err(Mistake::Verb(line.to_owned()));
        }
    };
    let key = KEYS.iter().position(|key| key.0 == name);
    match (key, words.next()) {
        (Some(key), None) => Ok((key, states)),
        _ => {
            let names = KEYS.iter().map(|key| key.0).collect();
            Err(Mistake::Key(line.to_owned(), names))
        }
    }
}

/// The seven keys.
pub struct Keys {
    out: Out,
    control: In,
    root: PathBuf,
    is_pressed: [bool; KEYS.len()],
}

impl Keys {
    /// The input device and its control.
    pub fn make(attributes: &Attributes) -> io::Result<Self> {
        Ok(Self {
            out: Out::make(attributes.root().join(path(KEY_DEVICE)))?,
            control: In::make(attributes.root().join(CONTROL))?,
            root: attributes.root().to_owned(),
            is_pressed: [false; KEYS.len()],
        })
    }

    fn set(&mut self, key: usize, is_pressed: bool, time_ns: i64) {
        if self.is_pressed[key] != is_pressed {
            self.is_pressed[key] = is_pressed;
            let value = [(KEYS[key].1, i32::from(is_pressed))];
            self.out.send(&packet(time_ns, EV_KEY, &value));
        }
    }
}

impl Part for Keys {
    fn run(&mut self, shared: &Shared) -> f64 {
        let time_ns = shared.machine().real_time_ns();
        if self.out.reader() == Reader::New {
            let pressed = KEYS.iter().zip(self.is_pressed);
            let values: Vec<_> = pressed
                .map(|(key, is_pressed)| (key.1, i32::from(is_pressed)))
                .collect();
            self.out.send(&packet(time_ns, EV_KEY, &values));
        }
        let (mut good, mut complaint) = (0, None);
        for line in self.control.lines() {
            match order(&line) {
                Ok((key, states)) => {
                    good += 1;
                    for state in states {
                        self.set(key, *state, time_ns);
                    }
                }
                Err(reason) => complaint = Some(reason),
            }
        }
        if self.control.take_left_out() > 0 {
            complaint = Some(Mistake::Unprintable);
        }
        let name = format!("{CONTROL}.error");
        match complaint {
            // If this cannot be told, the folder of the board is lost.
            Some(reason) => drop(appear(&self.root, &name, &reason.to_string())),
            None if good > 0 => drop(std::fs::remove_file(self.root.join(name))),
            None => {}
        }
        f64::INFINITY
    }

    fn changed(&mut self, name: &str, _attributes: &Attributes) {
        if name == path(KEY_DEVICE) {
            self.out.reader_left();
        }
    }

    fn inputs(&self) -> Vec<BorrowedFd<'_>> {
        vec![self.control.fd()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    #[cfg(target_pointer_width = "64")]
    fn an_event_has_the_kernel_s_layout() {
        let bytes = event(5_000_007_000, EV_ABS, ABS_DISTANCE, -1);
        assert_eq!(bytes.len(), 24);
        assert_eq!(bytes[..8], 5i64.to_ne_bytes());
        assert_eq!(bytes[8..16], 7i64.to_ne_bytes());
        assert_eq!(bytes[16..20], [3, 0, 0x19, 0]);
        assert_eq!(bytes[20..], [0xFF; 4]);
    }

    /// 1 m: 5830 us there and back; 5830 * 16 / 931 = 100.
    #[test]
    fn a_metre_is_100_cm_and_no_echo_is_minus_1() {
        let scratch = tempdir().unwrap();
        let mut attributes = Attributes::new(scratch.path()).unwrap();
        let mut sensor = Ultrasonic::make(&mut attributes).unwrap().remove(0);
        let mut random = Random::new(3);
        let fault = Fault::default();
        for _ in 0..3 {
            sensor.measure(Some(1.0), fault, &mut random);
        }
        let [cm, us] = sensor.measure(Some(1.0), fault, &mut random);
        assert!(
            (99..=100).contains(&cm) && (5800..5860).contains(&us),
            "{cm} {us}"
        );
        let [cm, _] = sensor.measure(Some(3.0), fault, &mut random);
        assert!(cm < 102, "one outlier is filtered: {cm}");
        for _ in 0..3 {
            sensor.measure(None, fault, &mut random);
        }
        assert_eq!(sensor.measure(None, fault, &mut random), [-1, 0]);
    }
}
