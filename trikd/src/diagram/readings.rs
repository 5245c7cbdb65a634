//! Sensors of the tree as a running diagram reads them: whole numbers, by what stands at a port.
//!
//! Owns the open files of the sensors that were read, and the heading that counts as 0. A reading that fails is none.

use super::parts::Parts;
use super::robot::Trouble;
use crate::brick::Brick;
use crate::brick::sensors::{Camera, Encoder, Gamepad, KEYS, Keys, NOT_PRESSED, Sensor, Vector};
use crate::limits;
use lang_diagram::ports::{Device, GamepadPart, ObjectPart, Port};
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// Where the heading stands in the numbers of a gyroscope, in millidegrees.
const HEADING: usize = 6;
/// Millidegrees of a whole turn.
const TURN: i32 = 360_000;
/// Directions of a lidar.
const DIRECTIONS: usize = 360;
/// Millimetres in a centimetre, the unit of programs.
const MM_IN_CM: f64 = 10.0;

/// What one port is read from.
enum From {
    Sensor(Sensor),
    Encoder(Encoder),
    Gyroscope(Vector),
    Accelerometer(Vector),
    Line,
    Colour,
    /// Object: x, y or size.
    Object(usize),
    Lidar,
    Key(usize),
    Pad(usize),
    PadPressed(usize),
    Wheel,
    Button(usize),
    Connected,
    Nothing,
}

/// All sensors.
pub struct Readings<'a> {
    brick: &'a Brick,
    ports: Parts<From>,
    cameras: HashMap<String, Camera>,
    keys: Keys,
    gamepad: Gamepad,
    /// What is taken from the heading.
    zero: i32,
    /// A sensor of the camera that has not heard that it shall detect, and until when that is tried.
    unheard: Option<(String, Instant)>,
}

/// The nearest whole number; what does not fit is cut.
fn whole(number: f64) -> i32 {
    number.round() as i32
}

/// Millidegrees from -180000 to 180000.
fn wrapped(angle: i32) -> i32 {
    let turned = angle.rem_euclid(TURN);
    if turned > TURN / 2 {
        turned - TURN
    } else {
        turned
    }
}

impl<'a> Readings<'a> {
    pub(super) fn new(brick: &'a Brick) -> Self {
        Self {
            brick,
            ports: Parts::new(),
            cameras: HashMap::new(),
            keys: brick.keys(),
            gamepad: brick.gamepad(),
            zero: 0,
            unheard: None,
        }
    }

    fn find(brick: &Brick, port: Port) -> Option<From> {
        match port.device() {
            Device::Motor | Device::Servo => None,
            Device::Encoder => brick.encoder(port.name()).map(From::Encoder),
            Device::Plugged => brick.sensor(port.name()).map(From::Sensor),
            Device::Gyroscope => brick.gyroscope().map(From::Gyroscope),
            Device::Accelerometer => brick.accelerometer().map(From::Accelerometer),
            Device::LineSensor => Some(From::Line),
            Device::ColorSensor => Some(From::Colour),
            Device::ObjectSensor(ObjectPart::X) => Some(From::Object(0)),
            Device::ObjectSensor(ObjectPart::Y) => Some(From::Object(1)),
            Device::ObjectSensor(ObjectPart::Size) => Some(From::Object(2)),
            Device::Lidar => brick.tree().has("lidar").then_some(From::Lidar),
            Device::Button(code) => {
                let key = KEYS.iter().position(|key| i32::from(key.1) == code);
                key.map(From::Key)
            }
            Device::Gamepad(GamepadPart::Place(pad)) => Some(From::Pad(pad.number())),
            Device::Gamepad(GamepadPart::Pressed(pad)) => Some(From::PadPressed(pad.number())),
            Device::Gamepad(GamepadPart::Wheel) => Some(From::Wheel),
            Device::Gamepad(GamepadPart::Button(number)) => Some(From::Button(number.into())),
            Device::Gamepad(GamepadPart::Connected) => Some(From::Connected),
        }
    }

    fn camera(&mut self, mode: &str) -> Option<&Camera> {
        if !self.cameras.contains_key(mode) {
            let camera = self.brick.camera(mode)?;
            self.cameras.insert(mode.to_owned(), camera);
        }
        self.cameras.get(mode)
    }

    pub(super) fn start_camera(&mut self, mode: &str, shows: bool) -> Result<(), Trouble> {
        match self.camera(mode) {
            Some(camera) => Ok(camera.start(shows)?),
            None => Err(Trouble::NoCamera),
        }
    }

    pub(super) fn stop_camera(&mut self, mode: &str) {
        if let Some(camera) = self.cameras.get(mode) {
            camera.stop();
        }
    }

    /// Looks for what is in the middle of the picture, now or as soon as the sensor hears.
    pub(super) fn detect(&mut self, mode: &str) -> Result<(), Trouble> {
        let until = Instant::now() + Duration::from_millis(limits::DETECT_MS);
        self.unheard = Some((mode.to_owned(), until));
        self.detect_again()
    }

    /// A sensor that was started a moment ago does not hear yet.
    pub(super) fn detect_again(&mut self) -> Result<(), Trouble> {
        let Some((mode, until)) = self.unheard.take() else {
            return Ok(());
        };
        match self.camera(&mode) {
            None => Err(Trouble::NoCamera),
            Some(camera) if camera.detect()? => Ok(()),
            Some(_) if Instant::now() < until => {
                self.unheard = Some((mode, until));
                Ok(())
            }
            Some(_) => Err(Trouble::NoDetector),
        }
    }

    /// The encoder begins at 0 again.
    pub(super) fn reset(&mut self, port: Port) -> Result<(), Trouble> {
        if let From::Encoder(encoder) = self.from(port) {
            Ok(encoder.reset()?)
        } else {
            Err(Trouble::NoEncoder)
        }
    }

    /// The present heading is 0 from now on.
    pub(super) fn calibrate(&mut self) {
        self.zero = 0;
        let mut numbers = Vec::new();
        let Some(port) = Port::of(Device::Gyroscope) else {
            return;
        };
        if self.vector(port, &mut numbers) {
            self.zero = numbers.get(HEADING).copied().unwrap_or(0);
        }
    }

    fn from(&mut self, port: Port) -> &From {
        let brick = self.brick;
        let found = self.ports.get(port, || Self::find(brick, port));
        found.unwrap_or(&From::Nothing)
    }

    pub(super) fn scalar(&mut self, port: Port) -> Option<i32> {
        let read = match *self.from(port) {
            From::Sensor(ref sensor) => sensor.read().ok(),
            From::Encoder(ref encoder) => encoder.read().ok().map(f64::trunc),
            From::Object(index) => {
                let numbers = self.camera("object").and_then(|camera| camera.read().ok());
                numbers.and_then(|numbers| numbers.get(index).copied())
            }
            From::Key(index) => {
                let pressed = self.keys.pressed().unwrap_or_default();
                Some(f64::from(pressed[index]))
            }
            From::PadPressed(number) => Some(f64::from(self.gamepad.pad(number).is_some())),
            From::Wheel => Some(self.gamepad.wheel()),
            From::Button(number) => Some(f64::from(self.gamepad.button(number))),
            From::Connected => Some(f64::from(self.gamepad.is_connected())),
            From::Gyroscope(_)
            | From::Accelerometer(_)
            | From::Line
            | From::Colour
            | From::Lidar
            | From::Pad(_)
            | From::Nothing => None,
        };
        read.map(whole)
    }

    pub(super) fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        let zero = self.zero;
        let numbers = match *self.from(port) {
            From::Gyroscope(ref gyroscope) => gyroscope.read().ok().map(|mut numbers| {
                if let Some(heading) = numbers.get_mut(HEADING) {
                    *heading = wrapped(whole(*heading).saturating_sub(zero)).into();
                }
                numbers
            }),
            From::Accelerometer(ref accelerometer) => accelerometer.read().ok(),
            From::Colour => self
                .camera("color")
                .and_then(|camera| camera.read().ok())
                .map(|cells| middle_colour(&cells)),
            From::Line => self.camera("line").and_then(|camera| camera.read().ok()),
            From::Lidar => {
                let mut distances = [0.0; DIRECTIONS];
                let read = self.brick.lidar(&mut distances).ok();
                read.map(|count| distances[..count].iter().map(|mm| mm / MM_IN_CM).collect())
            }
            From::Pad(number) => {
                let (x, y) = self
                    .gamepad
                    .pad(number)
                    .unwrap_or((NOT_PRESSED, NOT_PRESSED));
                Some(vec![x, y])
            }
            From::Sensor(_)
            | From::Encoder(_)
            | From::Object(_)
            | From::Key(_)
            | From::PadPressed(_)
            | From::Wheel
            | From::Button(_)
            | From::Connected
            | From::Nothing => None,
        };
        match numbers {
            Some(numbers) => {
                into.extend(numbers.into_iter().map(whole));
                true
            }
            None => false,
        }
    }
}

/// Red, green and blue of the cell in the middle of a square grid of `0xRRGGBB`.
fn middle_colour(cells: &[f64]) -> Vec<f64> {
    let cell = cells.get(cells.len() / 2).copied().unwrap_or(0.0);
    let [_, red, green, blue] = (cell as u32).to_be_bytes();
    [red, green, blue].map(f64::from).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_stay_within_half_a_turn() {
        for (angle, expected) in [
            (0, 0),
            (180_000, 180_000),
            (180_001, -179_999),
            (-180_000, 180_000),
            (-1, -1),
            (725_000, 5_000),
        ] {
            assert_eq!(wrapped(angle), expected, "{angle}");
        }
    }

    #[test]
    fn the_colour_is_that_of_the_cell_in_the_middle() {
        let cells = [
            0.0,
            0.0,
            0.0,
            0.0,
            f64::from(0x10_20_30),
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        assert_eq!(middle_colour(&cells), [16.0, 32.0, 48.0]);
        assert_eq!(middle_colour(&[]), [0.0, 0.0, 0.0]);
    }
}
