//! What a program senses.

use crate::tree::{Access, Node, Tree};
use std::cell::Cell;
use std::io;
use std::rc::Rc;

/// Names and key codes (linux/input-event-codes.h) in the order of `keys/value`.
pub const KEYS: [(&str, u16); 7] = [
    ("Power", 116),
    ("Up", 103),
    ("Esc", 1),
    ("Left", 105),
    ("Right", 106),
    ("Down", 108),
    ("Enter", 28),
];
/// What TRIK programs get for a pad or wheel that nobody touches.
pub const NOT_PRESSED: f64 = -101.0;
/// What TRIK programs get for a distance without an echo.
pub const NO_ECHO: f64 = -1.0;

/// An analog or distance sensor.
#[derive(Clone, Debug)]
pub struct Sensor {
    value: Rc<Node>,
    raw: Rc<Node>,
}

impl Sensor {
    pub(super) fn new(tree: &Tree, directory: &str) -> Self {
        Self::with(tree, directory, Access::Read)
    }

    /// The same with another way of opening: telemetry does not wait.
    pub fn with(tree: &Tree, directory: &str, access: Access) -> Self {
        Self {
            value: tree.node(&format!("{directory}/value"), access),
            raw: tree.node(&format!("{directory}/raw"), access),
        }
    }

    /// The reading in the unit of the sensor: percent, cm.
    ///
    /// # Errors
    /// Those of the tree; a distance without an echo is one, and programs of old get [`NO_ECHO`] for it.
    pub fn read(&self) -> io::Result<f64> {
        self.value.number()
    }

    /// The reading as the device tells it.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn read_raw(&self) -> io::Result<f64> {
        self.raw.number()
    }
}

/// An encoder.
#[derive(Clone, Debug)]
pub struct Encoder {
    value: Rc<Node>,
    raw: Rc<Node>,
    zero: Rc<Node>,
}

impl Encoder {
    pub(super) fn new(tree: &Tree, directory: &str) -> Self {
        let value = format!("{directory}/value");
        Self {
            value: tree.node(&value, Access::Read),
            raw: tree.node(&format!("{directory}/raw"), Access::Read),
            zero: tree.node(&value, Access::Write),
        }
    }

    /// Degrees.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn read(&self) -> io::Result<f64> {
        self.value.number()
    }

    /// Ticks.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn read_raw(&self) -> io::Result<f64> {
        self.raw.number()
    }

    /// Begins at zero again.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn reset(&self) -> io::Result<()> {
        self.zero.write("0\n")
    }
}

/// The keys of the controller.
#[derive(Clone, Debug)]
pub struct Keys {
    value: Rc<Node>,
}

impl Keys {
    pub(super) fn new(tree: &Tree) -> Self {
        Self {
            value: tree.node("keys/value", Access::ReadNow),
        }
    }

    /// Which keys are pressed, in the order of [`KEYS`]. Presses that a program must not miss come from the stream
    /// `keys/device`.
    ///
    /// # Errors
    /// Those of the tree; EAGAIN before the first event.
    pub fn pressed(&self) -> io::Result<[bool; KEYS.len()]> {
        let mut numbers = [0.0; KEYS.len()];
        self.value.numbers(&mut numbers)?;
        Ok(numbers.map(|number| number != 0.0))
    }
}

/// The battery.
#[derive(Clone, Debug)]
pub struct Battery {
    value: Rc<Node>,
    raw: Rc<Node>,
}

impl Battery {
    pub(super) fn new(tree: &Tree) -> Self {
        Self {
            value: tree.node("battery/value", Access::Read),
            raw: tree.node("battery/raw", Access::Read),
        }
    }

    /// Volts.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn voltage(&self) -> io::Result<f64> {
        self.value.number()
    }

    /// The reading of the converter.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn raw(&self) -> io::Result<f64> {
        self.raw.number()
    }
}

/// Accelerometer or gyroscope.
#[derive(Clone, Debug)]
pub struct Vector {
    value: Rc<Node>,
    raw: Rc<Node>,
    /// Tilt and heading of a gyroscope.
    angles: Option<(Rc<Node>, Rc<Node>)>,
}

impl Vector {
    pub(super) fn accelerometer(tree: &Tree) -> Self {
        Self::with(tree, "accelerometer", Access::Read)
    }

    pub(super) fn gyroscope(tree: &Tree) -> Self {
        Self::with(tree, "gyroscope", Access::Read)
    }

    /// One of both, with its way of opening: telemetry does not wait.
    pub fn with(tree: &Tree, directory: &str, access: Access) -> Self {
        let node = |name: &str| tree.node(&format!("{directory}/{name}"), access);
        Self {
            value: node("value"),
            raw: node("raw"),
            angles: (directory == "gyroscope").then(|| (node("tilt"), node("heading"))),
        }
    }

    /// Accelerometer: x, y, z in mg. Gyroscope, as TRIK programs know it: rates around x, y, z in millidegrees per
    /// second, time in microseconds modulo 2^31, tilt around x and y and the heading in millidegrees.
    ///
    /// # Errors
    /// Those of the tree; a gyroscope that is not calibrated yet has no value.
    pub fn read(&self) -> io::Result<Vec<f64>> {
        let mut numbers = vec![0.0; 3];
        self.value.numbers(&mut numbers)?;
        if let Some((tilt, heading)) = &self.angles {
            let mut angles = [0.0; 2];
            tilt.numbers(&mut angles)?;
            let time_us = self.value.now_us() % (1 << 31);
            // Below 2^31, so that every float of 64 bits holds it.
            numbers.push(f64::from(u32::try_from(time_us).unwrap_or(0)));
            numbers.extend(angles);
            numbers.push(heading.number()?);
        }
        Ok(numbers)
    }

    /// Counts of the chip; the gyroscope has the kind of chip first. The time is last.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn read_raw(&self) -> io::Result<Vec<f64>> {
        let mut numbers = vec![0.0; 8];
        let count = self.raw.numbers(&mut numbers)?;
        numbers.truncate(count);
        Ok(numbers)
    }
}

/// One sensor of the camera. It runs while its `value` is open, so [`Camera::start`] comes first.
#[derive(Clone, Debug)]
pub struct Camera {
    value: Rc<Node>,
    detect: Rc<Node>,
    hsv_read: Rc<Node>,
    hsv_write: Rc<Node>,
    video_out: Rc<Node>,
    /// Whether the picture shall be shown, until the sensor has been told.
    unsent: Rc<Cell<Option<bool>>>,
}

/// The program of the sensor takes no lines: it was not started, or it has no pipe yet.
fn is_absent(error: &io::Error) -> bool {
    error.raw_os_error() == Some(libc::ENODEV)
}

impl Camera {
    pub(super) fn new(tree: &Tree, directory: &str) -> Self {
        let node = |name: &str, access| tree.node(&format!("{directory}/{name}"), access);
        Self {
            value: node("value", Access::ReadNow),
            detect: node("detect", Access::Write),
            hsv_read: node("hsv", Access::ReadNow),
            hsv_write: node("hsv", Access::Write),
            video_out: node("video_out", Access::Write),
            unsent: Rc::default(),
        }
    }

    /// Starts the sensor; its first sample takes up to 20 s, and lines for it as long.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn start(&self, shows: bool) -> io::Result<()> {
        // The opening starts it; that there is no sample yet is no failure.
        match self.value.bytes(&mut [0; 1]) {
            Err(error) if error.kind() != io::ErrorKind::WouldBlock => return Err(error),
            _ => {}
        }
        let _ = self.hsv_read.bytes(&mut [0; 1]);
        self.unsent.set(Some(shows));
        self.send_video_out()
    }

    /// Says whether to show the picture, if the sensor can hear it by now.
    fn send_video_out(&self) -> io::Result<()> {
        let Some(shows) = self.unsent.get() else {
            return Ok(());
        };
        match self.video_out.write(if shows { "1\n" } else { "0\n" }) {
            Err(error) if is_absent(&error) => Ok(()),
            done => {
                self.unsent.set(None);
                done
            }
        }
    }

    /// Measures the colour in the middle of the picture and looks for it. False: the sensor does not run yet.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn detect(&self) -> io::Result<bool> {
        match self.detect.write("1\n") {
            Err(error) if is_absent(&error) => Ok(false),
            done => done.map(|()| true),
        }
    }

    /// Hue, saturation and value that were measured, each followed by its tolerance.
    ///
    /// # Errors
    /// Those of the tree; EAGAIN before the answer.
    pub fn detected(&self) -> io::Result<Vec<f64>> {
        let mut numbers = vec![0.0; 6];
        self.hsv_read.numbers(&mut numbers)?;
        Ok(numbers)
    }

    /// Looks for a colour with the numbers of [`Camera::detected`].
    ///
    /// # Errors
    /// Those of the tree.
    pub fn look_for(&self, numbers: &[f64]) -> io::Result<()> {
        let words: Vec<_> = numbers
            .iter()
            .map(|number| format!("{number:.0}"))
            .collect();
        self.hsv_write.write(&format!("{}\n", words.join(" ")))
    }

    /// The newest numbers: line x, crossroads, mass; object x, y, size; sound angle, left, right; colours cell by cell
    /// as 0xRRGGBB.
    ///
    /// # Errors
    /// Those of the tree; EAGAIN before the first picture.
    pub fn read(&self) -> io::Result<Vec<f64>> {
        self.send_video_out()?;
        let mut numbers = vec![0.0; 9];
        let count = self.value.numbers(&mut numbers)?;
        numbers.truncate(count);
        Ok(numbers)
    }

    /// Stops the sensor.
    pub fn stop(&self) {
        self.unsent.set(None);
        for node in [&self.value, &self.hsv_read] {
            node.close();
        }
    }
}

/// The gamepad.
#[derive(Clone, Debug)]
pub struct Gamepad {
    pads: [Rc<Node>; 2],
    wheel: Rc<Node>,
    buttons: Rc<Node>,
    presses: Rc<Node>,
}

impl Gamepad {
    pub(super) fn new(tree: &Tree) -> Self {
        let node = |name: &str| tree.node(&format!("gamepad/{name}"), Access::ReadNow);
        Self {
            pads: [node("pad1/value"), node("pad2/value")],
            wheel: node("wheel/value"),
            buttons: node("buttons/value"),
            presses: node("buttons/presses"),
        }
    }

    /// x and y of pad 1 or 2 while it is touched, each -100 to 100.
    pub fn pad(&self, number: usize) -> Option<(f64, f64)> {
        let mut numbers = [0.0; 3];
        let node = self.pads.get(number.checked_sub(1)?)?;
        match node.numbers(&mut numbers) {
            Ok(3) if numbers[2] != 0.0 => Some((numbers[0], numbers[1])),
            _ => None,
        }
    }

    /// The steering wheel, -100 to 100; [`NOT_PRESSED`] without a gamepad.
    pub fn wheel(&self) -> f64 {
        self.wheel.number().unwrap_or(NOT_PRESSED)
    }

    /// Whether button 1 to 5 is down.
    pub fn button(&self, number: usize) -> bool {
        let mut numbers = [0.0; 5];
        let known = self.buttons.numbers(&mut numbers).is_ok();
        let index = number.wrapping_sub(1);
        known && numbers.get(index).is_some_and(|number| *number != 0.0)
    }

    /// How often each button was pressed since the start; None without a gamepad.
    pub fn presses(&self) -> Option<[f64; 5]> {
        let mut numbers = [0.0; 5];
        self.presses.numbers(&mut numbers).ok()?;
        Some(numbers)
    }

    /// Whether anything came from a gamepad lately.
    pub fn is_connected(&self) -> bool {
        self.buttons.bytes(&mut [0; 32]).is_ok()
    }
}
