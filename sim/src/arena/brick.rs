//! A robot of an arena as its program sees it: commands in, readings out.
//!
//! Owns which command goes to which part and which sensor answers for which port. Knows no programs.

// A command that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]

use lang_diagram::brick::{Answer, Brick, Command, Question};
use lang_diagram::ports::{Device, GamepadPart, Pad, Port};
use lang_text::problem::Problem;

use super::floor::sensors;
use super::ranges;
use super::{Arena, laid};
use crate::field::SensorKind;
use crate::geometry::Point;
use crate::limits;

/// Variance of a distance sensor's noise, in square centimetres.
const RANGE_NOISE: f64 = 1.5;
/// What a noisy distance sensor says at most.
const RANGE_NOISE_MAX: f64 = 255.0;

/// Where a pad is in the list of them.
fn place(pad: Pad) -> usize {
    match pad {
        Pad::One => 0,
        Pad::Two => 1,
    }
}

/// One robot of an arena.
#[derive(Debug)]
pub struct Handle<'a> {
    pub(super) arena: &'a mut Arena,
    pub(super) index: usize,
}

impl Handle<'_> {
    /// What a sensor that looks at solid things says.
    fn range(&mut self, port: Port) -> Option<i32> {
        let arena = &mut *self.arena;
        let robot = &mut arena.robots[self.index];
        let sensor = robot.sensor(port)?;
        let (at, degrees) = robot.sensor_pose(sensor);
        let beam = match sensor.kind {
            SensorKind::Infrared => ranges::INFRARED,
            SensorKind::Sonar => ranges::SONAR,
            SensorKind::Touch => {
                let is_touching =
                    ranges::is_touching(&arena.solids, at, degrees, &mut arena.scratch);
                return Some(i32::from(is_touching));
            }
            SensorKind::Light => return self.light(port),
            SensorKind::Camera | SensorKind::Lidar | SensorKind::Other => {
                return None;
            }
        };
        let cm = ranges::distance(&arena.solids, at, degrees, beam, &mut arena.scratch);
        if !arena.field.settings.realistic_sensors {
            return Some(cm);
        }
        let noisy = f64::from(cm) + sensors::noise(robot.noise_mut(), RANGE_NOISE);
        Some(noisy.round().clamp(0.0, RANGE_NOISE_MAX) as i32)
    }

    /// Looks at the floor through a sensor that stands somewhere and looks somewhere.
    fn view_floor(&mut self, (at, degrees): (Point, f64), side: u16, part: f64) {
        let arena = &mut *self.arena;
        let floor = laid(&mut arena.floor, &arena.field);
        floor.view(at, degrees, side, part, &mut arena.window);
    }

    /// What a light sensor says.
    fn light(&mut self, port: Port) -> Option<i32> {
        let robot = &self.arena.robots[self.index];
        let place = robot.sensor_pose(robot.sensor(port)?);
        self.view_floor(place, sensors::LIGHT_SIDE, 1.0);
        let arena = &mut *self.arena;
        let is_noisy = arena.field.settings.realistic_sensors;
        let noise = is_noisy.then_some(arena.robots[self.index].noise_mut());
        Some(sensors::light(&arena.window, noise))
    }

    /// Looks at the floor through the camera; false without one.
    fn look_ahead(&mut self, part: f64) -> bool {
        let robot = &self.arena.robots[self.index];
        let camera = robot.sensor_of(SensorKind::Camera);
        let place = camera.map(|camera| robot.sensor_pose(camera));
        if let Some(place) = place {
            self.view_floor(place, sensors::CAMERA_SIDE, part);
        }
        place.is_some()
    }

    /// The line sensor learns the colour in the middle of the camera's picture.
    fn learn(&mut self) {
        if self.look_ahead(sensors::DETECT_PART) {
            let learned = sensors::learned(&self.arena.window);
            self.arena.robots[self.index].line_colour = learned;
        }
    }

    fn gamepad(&self, part: GamepadPart) -> Option<i32> {
        let gamepad = self.arena.robots[self.index].gamepad();
        match part {
            GamepadPart::Connected => Some(i32::from(gamepad.is_some_and(|one| !one.is_away))),
            GamepadPart::Pressed(pad) => Some(i32::from(gamepad?.pads[place(pad)].is_pressed)),
            GamepadPart::Wheel => Some(gamepad?.wheel),
            GamepadPart::Button(number) => {
                let button = gamepad?.buttons.get(usize::from(number).checked_sub(1)?)?;
                Some(i32::from(*button))
            }
            GamepadPart::Place(_) => None,
        }
    }

    fn see_line(&mut self, into: &mut Vec<i32>) -> bool {
        let is_there = self.look_ahead(sensors::LINE_PART);
        if is_there {
            let wanted = self.arena.robots[self.index].line_colour;
            into.extend_from_slice(&sensors::line(&self.arena.window, wanted));
        }
        is_there
    }

    fn see_colour(&mut self, into: &mut Vec<i32>) -> bool {
        let is_there = self.look_ahead(sensors::COLOUR_PART);
        if is_there {
            let arena = &mut *self.arena;
            let is_noisy = arena.field.settings.realistic_sensors;
            let noise = is_noisy.then_some(arena.robots[self.index].noise_mut());
            let colour = sensors::colour(&arena.window, noise);
            into.extend(colour.map(i32::from));
        }
        is_there
    }

    /// Puts a message into the boxes of other robots.
    fn send(&mut self, message: &str, hull: Option<i32>) {
        for (index, robot) in self.arena.robots.iter_mut().enumerate() {
            let is_meant = hull.is_none_or(|hull| hull == robot.hull);
            if index != self.index && is_meant && robot.mail.len() < limits::MAIL_MAX {
                robot.mail.push_back(message.to_owned());
            }
        }
    }
}

impl Brick for Handle<'_> {
    fn command(&mut self, command: Command<'_>) {
        let robot = &mut self.arena.robots[self.index];
        match command {
            Command::Power { port, percent } => robot.set_power(port, percent),
            Command::Off { port, .. } => robot.set_power(port, 0),
            Command::Servo { port, degrees } => robot.set_servo(port, degrees),
            Command::ResetEncoder { port } => {
                robot.reset_encoder(port);
                robot.readings.note(port, 0, self.arena.now);
            }
            Command::CalibrateGyroscope => robot.calibrate(),
            Command::Rest => {
                robot.rest();
                robot.shown.command(&command);
            }
            Command::MarkerDown { color } => {
                robot.marker.is_down = true;
                color.clone_into(&mut robot.marker.colour);
            }
            Command::MarkerUp => robot.marker.is_down = false,
            Command::Join { hull, .. } => robot.hull = hull,
            Command::Send { message, hull } => self.send(message, hull),
            Command::Detect { mode: "line" } => self.learn(),
            // `Shown` has those that a person sees or hears; the others do nothing in a simulator.
            Command::Sound { .. }
            | Command::Tone { .. }
            | Command::Say { .. }
            | Command::Led { .. }
            | Command::System { .. }
            | Command::Append { .. }
            | Command::Remove { .. }
            | Command::StartCamera { .. }
            | Command::StopCamera { .. }
            | Command::StartVideo { .. }
            | Command::StopVideo
            | Command::Detect { .. }
            | Command::Console { .. }
            | Command::PenColor { .. }
            | Command::PenWidth { .. }
            | Command::Background { .. }
            | Command::Draw(_)
            | Command::Label { .. }
            | Command::Smile { .. }
            | Command::ClearScreen
            | Command::Redraw => robot.shown.command(&command),
        }
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        let robot = &self.arena.robots[self.index];
        let reading = match port.device() {
            Device::Encoder => Some(robot.encoder(port) as i32),
            Device::Button(code) => Some(i32::from(robot.is_pressed(code))),
            Device::Gamepad(part) => self.gamepad(part),
            Device::Plugged | Device::ObjectSensor(_) => self.range(port),
            Device::Motor
            | Device::Servo
            | Device::Gyroscope
            | Device::Accelerometer
            | Device::LineSensor
            | Device::ColorSensor
            | Device::Lidar => None,
        };
        if let Some(reading) = reading {
            let now = self.arena.now;
            let robot = &mut self.arena.robots[self.index];
            robot.readings.note(port, reading, now);
        }
        reading
    }

    fn locked(&mut self, port: Port) -> Option<i32> {
        let readings = &self.arena.robots[self.index].readings;
        readings.is_locked(port).then(|| readings.last(port))
    }

    fn announced(&mut self) -> Option<(Port, i32)> {
        self.arena.robots[self.index].readings.announced()
    }

    fn random_of_function(&mut self, low: i32, high: i32) -> i32 {
        self.arena.robots[self.index].dice.throw(low, high)
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        let robot = &self.arena.robots[self.index];
        match port.device() {
            Device::LineSensor => self.see_line(into),
            Device::ColorSensor => self.see_colour(into),
            Device::Gyroscope => {
                let (rate, angle) = robot.gyroscope();
                let now = i32::try_from(self.arena.now).unwrap_or(i32::MAX);
                into.extend_from_slice(&[0, 0, rate, now, 0, 0, angle]);
                true
            }
            Device::Accelerometer => {
                into.extend_from_slice(&robot.accelerometer());
                true
            }
            Device::Lidar => {
                let Some(sensor) = robot.sensor_of(SensorKind::Lidar) else {
                    return false;
                };
                let (at, degrees) = robot.sensor_pose(sensor);
                let arena = &mut *self.arena;
                ranges::lidar(&arena.solids, at, degrees, &mut arena.scratch, into);
                true
            }
            Device::Gamepad(GamepadPart::Place(pad)) => robot.gamepad().is_some_and(|gamepad| {
                let pad = &gamepad.pads[place(pad)];
                into.extend_from_slice(&[pad.x, pad.y]);
                true
            }),
            Device::Motor
            | Device::Servo
            | Device::Encoder
            | Device::Plugged
            | Device::ObjectSensor(_)
            | Device::Button(_)
            | Device::Gamepad(
                GamepadPart::Pressed(_)
                | GamepadPart::Wheel
                | GamepadPart::Button(_)
                | GamepadPart::Connected,
            ) => false,
        }
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        self.arena.robots[self.index].roll(low, high)
    }

    fn mail(&mut self) -> Option<String> {
        self.arena.robots[self.index].mail.pop_front()
    }

    fn ask(&mut self, question: Question<'_>) -> Answer {
        match (self.arena.answers.pop_front(), &mut self.arena.person) {
            (Some(text), _) => Answer::Text(text),
            (None, Some(person)) => person.ask(question),
            (None, None) => Answer::Cancelled,
        }
    }

    fn may_ask_again(&mut self, question: Question<'_>) -> bool {
        let person = self.arena.person.as_mut();
        person.is_some_and(|person| person.may_ask_again(question))
    }

    fn ask_again(&mut self, question: Question<'_>, why: &[Problem]) {
        if let Some(person) = &mut self.arena.person {
            person.ask_again(question, why);
        }
    }
}
