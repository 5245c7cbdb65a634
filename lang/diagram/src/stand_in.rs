//! A stand-in for a robot: two wheels on an empty floor, motors, encoders, and readings by script.
//!
//! Owns the kinematics of the original's simulator without walls and without a floor to see: ideal motors, exact rolling,
//! the order of one tick. Sensors say what [`StandIn::readings`] holds. Lengths are pixels of the scene, x to the right, y
//! down, angles in degrees clockwise; the pose is that of the upper left corner of the unturned robot.
//!
//! Facts are those of the original: wheels of 8 px radius, 44 px apart, their axle 15 px behind the centre, 5.5 degrees
//! of a wheel per tick at full power; shifts pass through 32-bit floats there, so they do here.

use crate::limits;
use std::collections::BTreeMap;

use super::brick::{Answer, Brick, Command, Question};
use super::machine::STEP_MS;
use super::ports::{Device, Direction, Port, Sort};
use lang_expr::Kit;
use lang_text::problem::Problem;
use lang_text::xml::{self, Element};

/// Pixels in a centimetre.
pub const PIXELS_IN_CM: f64 = 16.0 / 5.6;
/// Degrees of a wheel in a millisecond at one percent.
const DEGREES_PER_PERCENT: f64 = 0.0055;
const WHEEL_RADIUS: f64 = 8.0;
const TRACK: f64 = 44.0;
/// From the centre of the robot to the middle of its axle.
const AXLE: f64 = -15.0;
/// Length and width of a robot of usual size.
const SIZE: f64 = 50.0;
/// Speeds that are nearer than this are the same.
const SAME: f64 = 1e-8;

/// Where a robot stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Pixels to the right.
    pub x: f64,
    /// Pixels down.
    pub y: f64,
    /// Degrees clockwise; 0 looks to the right.
    pub degrees: f64,
}

/// How a robot is put into the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Where it stands at first.
    pub pose: Pose,
    /// The motor of the left wheel.
    pub left: Option<Port>,
    /// The motor of the right wheel.
    pub right: Option<Port>,
}

impl Default for Placing {
    fn default() -> Self {
        Self {
            pose: Pose::default(),
            left: Port::named("M3"),
            right: Port::named("M4"),
        }
    }
}

impl Placing {
    /// Where a world model has put its robot of TRIK; at the origin if it says nothing.
    pub fn of_world(text: &str) -> Self {
        // A world that says nothing has them so, other than robots without a world here.
        let mut placing = Self {
            left: Port::named("M4"),
            right: Port::named("M3"),
            ..Self::default()
        };
        let Ok(root) = xml::parse(text) else {
            return placing;
        };
        let root = match root.name.as_ref() {
            "root" => &root,
            _ => root.child("root").unwrap_or(&root),
        };
        let scale = match root.child("settings") {
            None if root.attribute("version").is_none() => 1.0,
            None => PIXELS_IN_CM,
            Some(settings) => match settings.attribute("sizeUnit") {
                Some("cm") => PIXELS_IN_CM,
                Some("mm") => PIXELS_IN_CM / 10.0,
                Some("m") => PIXELS_IN_CM * 100.0,
                _ => 1.0,
            },
        };
        let robots = root.child("robots");
        let is_ours = |robot: &&Element<'_>| {
            let id = robot.attribute("id").unwrap_or("");
            id.starts_with("trik") && robot.name == "robot"
        };
        let robot = robots.and_then(|robots| robots.elements().find(is_ours));
        let in_world = root.child("world").and_then(|world| world.child("robot"));
        // Older worlds keep the place with the robot's devices.
        for place in [robot, in_world].into_iter().flatten() {
            if let Some((x, y)) = place.attribute("position").and_then(point) {
                placing.pose.x = x * scale;
                placing.pose.y = y * scale;
            }
            if let Some(degrees) = place.attribute("direction").and_then(number) {
                placing.pose.degrees = degrees;
            }
        }
        if let Some(wheels) = robot.and_then(|robot| robot.child("wheels")) {
            for (side, wheel) in [("left", &mut placing.left), ("right", &mut placing.right)] {
                if let Some(text) = wheels.attribute(side) {
                    let name = text.split("###").next().unwrap_or("");
                    *wheel = Port::find(Kit::V62, name, Direction::Out);
                }
            }
        }
        placing
    }
}

fn number(text: &str) -> Option<f64> {
    text.trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
}

fn point(text: &str) -> Option<(f64, f64)> {
    let (x, y) = text.split_once(':')?;
    Some((number(x)?, number(y)?))
}

/// One wheel.
#[derive(Clone, Copy, Debug, Default)]
struct Wheel {
    motor: Option<Port>,
    /// Power that the physics of the next tick takes.
    chosen: i32,
}

/// A robot on an empty floor.
#[derive(Clone, Debug, Default)]
pub struct StandIn {
    /// Where it is.
    pub pose: Pose,
    /// What sensors with one number say; a port that is missing has no sensor. Encoders need not be here.
    pub readings: BTreeMap<Port, i32>,
    /// What sensors with several numbers say. The gyroscope need not be here.
    pub vectors: BTreeMap<Port, Vec<i32>>,
    /// Messages of other robots that have not been fetched.
    pub mail: std::collections::VecDeque<String>,
    /// Answers of a person; after them there is none.
    pub answers: std::collections::VecDeque<String>,
    /// How often a person is asked once more after an answer that is no good.
    pub second_chances: u32,
    /// Random numbers that come first, if they are within the bounds; later ones come by rule.
    pub randoms: std::collections::VecDeque<i32>,
    /// When something was told, and what.
    pub log: Vec<(u32, String)>,
    /// Whether commands are logged.
    pub is_logging: bool,
    now: u32,
    wheels: [Wheel; 2],
    powers: BTreeMap<Port, i32>,
    encoders: BTreeMap<Port, f64>,
    calibrated: f64,
    previous_degrees: Option<f64>,
    rate: f64,
    random: u32,
}

impl StandIn {
    /// A robot that stands.
    pub fn new(placing: Placing) -> Self {
        let wheel = |motor| Wheel { motor, chosen: 0 };
        let mut buttons = BTreeMap::new();
        for port in Port::all() {
            if matches!(port.sort(), Sort::Button(_)) {
                buttons.insert(port, 0);
            }
        }
        Self {
            pose: placing.pose,
            wheels: [wheel(placing.left), wheel(placing.right)],
            readings: buttons,
            is_logging: true,
            random: 0x2545_f491,
            ..Self::default()
        }
    }

    /// The scene's clock, in milliseconds.
    pub fn now(&self) -> u32 {
        self.now
    }

    /// Power of a motor.
    pub fn power(&self, port: Port) -> i32 {
        self.powers.get(&port).copied().unwrap_or(0)
    }

    /// One tick of the world, before the step of the program at the same time.
    pub fn tick(&mut self) {
        self.now = self.now.saturating_add(STEP_MS);
        let powers = self.wheels.map(|wheel| wheel.chosen);
        let Motion { shift, turn } = motion(&Rolling::default(), powers, self.pose.degrees);
        for wheel in &mut self.wheels {
            let power = wheel.motor.and_then(|motor| self.powers.get(&motor));
            wheel.chosen = power.copied().unwrap_or(0);
        }
        self.pose.x += f64::from(shift.0);
        self.pose.y += f64::from(shift.1);
        self.pose.degrees += turn;
        let previous = self.previous_degrees.replace(self.pose.degrees);
        self.rate = previous.map_or(self.rate, |previous| {
            (self.pose.degrees - previous) * 1000.0 / f64::from(STEP_MS)
        });
        for wheel in self.wheels {
            if let Some(encoder) = wheel.motor.and_then(encoder_of) {
                *self.encoders.entry(encoder).or_default() += wheel_turn(wheel.chosen);
            }
        }
    }
}

/// What one tick moves a robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Pixels to the right and down.
    pub shift: (f32, f32),
    /// Degrees clockwise.
    pub turn: f64,
}

/// Sizes of a robot that rolls, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolling {
    /// Radius of its wheels.
    pub radius: f64,
    /// From wheel to wheel.
    pub track: f64,
    /// From its centre ahead to the middle of its axle.
    pub axle: f64,
}

impl Default for Rolling {
    fn default() -> Self {
        Self {
            radius: WHEEL_RADIUS,
            track: TRACK,
            axle: AXLE,
        }
    }
}

impl Rolling {
    /// Of a robot so many pixels long and wide: its wheels keep their places, and their radius is whole.
    pub fn of_size(length: f64, width: f64) -> Self {
        Self {
            radius: (WHEEL_RADIUS * length / SIZE).floor(),
            track: TRACK * width / SIZE,
            axle: AXLE * length / SIZE,
        }
    }

    /// Speed of a wheel's rim in pixels in a millisecond, at a power in percent.
    pub fn rim_speed(&self, percent: i32) -> f64 {
        f64::from(percent) * 2.0 * std::f64::consts::PI * self.radius * DEGREES_PER_PERCENT / 360.0
    }
}

/// Speed of a wheel's rim in pixels in a millisecond, at a power in percent, of a robot of usual size.
pub fn rim_speed(percent: i32) -> f64 {
    Rolling::default().rim_speed(percent)
}

/// Degrees that a wheel turns in one tick, at a power in percent.
pub fn wheel_turn(percent: i32) -> f64 {
    f64::from(STEP_MS) * f64::from(percent) * DEGREES_PER_PERCENT
}

/// What one tick of exact rolling moves a robot of these sizes whose left and right wheel have these powers in percent and which looks
/// this many degrees clockwise from the right.
pub fn motion(rolling: &Rolling, powers: [i32; 2], degrees: f64) -> Motion {
    let [left, right] = powers.map(|percent| rolling.rim_speed(percent));
    let mean = f64::midpoint(left, right);
    let time = f64::from(STEP_MS);
    let heading = degrees.to_radians();
    if (left - right).abs() < SAME {
        let way = (mean * time) as f32;
        let direction = (libm::cos(heading) as f32, libm::sin(heading) as f32);
        return Motion {
            shift: (way * direction.0, way * direction.1),
            turn: 0.0,
        };
    }
    let turn = (left - right) * time / rolling.track;
    let radius = mean / (turn / time);
    // The centre of the robot around the point beside its axle, in the robot's own directions.
    let (x, y) = (-rolling.axle, -radius);
    let x_turned = x * libm::cos(turn) - y * libm::sin(turn) + rolling.axle;
    let y_turned = x * libm::sin(turn) + y * libm::cos(turn) + radius;
    let shift_x = x_turned * libm::cos(heading) - y_turned * libm::sin(heading);
    let shift_y = x_turned * libm::sin(heading) + y_turned * libm::cos(heading);
    Motion {
        shift: (shift_x as f32, shift_y as f32),
        turn: turn * 180.0 / std::f64::consts::PI,
    }
}

fn encoder_of(motor: Port) -> Option<Port> {
    Port::find(Kit::V62, motor.name(), Direction::In)
}

impl Brick for StandIn {
    fn command(&mut self, command: Command<'_>) {
        if self.is_logging && self.log.len() < limits::LOG_LINES_MAX {
            self.log.push((self.now, command.to_string()));
        }
        match command {
            Command::Power { port, percent } => {
                self.powers.insert(port, percent.clamp(-100, 100));
            }
            Command::Off { port, .. } => {
                self.powers.insert(port, 0);
            }
            Command::ResetEncoder { port } => {
                self.encoders.insert(port, 0.0);
            }
            Command::CalibrateGyroscope => self.calibrated = self.pose.degrees,
            Command::Rest => self.powers.clear(),
            // All else can only be read in the log.
            Command::Servo { .. }
            | Command::Sound { .. }
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
            | Command::Send { .. }
            | Command::Join { .. }
            | Command::Console { .. }
            | Command::PenColor { .. }
            | Command::PenWidth { .. }
            | Command::Background { .. }
            | Command::Draw(_)
            | Command::Label { .. }
            | Command::Smile { .. }
            | Command::ClearScreen
            | Command::Redraw
            | Command::MarkerDown { .. }
            | Command::MarkerUp => {}
        }
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        if let Some(&reading) = self.readings.get(&port) {
            return Some(reading);
        }
        let degrees = || self.encoders.get(&port).copied().unwrap_or(0.0);
        (port.sort() == Sort::Encoder).then(|| degrees() as i32)
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        if let Some(numbers) = self.vectors.get(&port) {
            into.extend_from_slice(numbers);
            return true;
        }
        let is_gyroscope = port.device() == Device::Gyroscope;
        if is_gyroscope {
            let mut angle = ((self.pose.degrees - self.calibrated) * 1000.0) as i32 % 360_000;
            if angle > 180_000 {
                angle -= 360_000;
            } else if angle < -180_000 {
                angle += 360_000;
            }
            into.extend_from_slice(&[0, 0, (self.rate * 1000.0) as i32, 0, 0, 0, angle]);
        }
        is_gyroscope
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        if let Some(number) = self
            .randoms
            .pop_front()
            .filter(|number| (low..=high).contains(number))
        {
            return number;
        }
        // Xorshift of 32 bits: the same numbers in each run, which documents and snapshots hold. Three lines are less than a
        // crate that this one, the trials of `converter` and nothing else would share.
        self.random ^= self.random << 13;
        self.random ^= self.random >> 17;
        self.random ^= self.random << 5;
        let count = i64::from(high) - i64::from(low) + 1;
        let number = i64::from(low) + i64::from(self.random) % count.max(1);
        i32::try_from(number).unwrap_or(low)
    }

    fn mail(&mut self) -> Option<String> {
        self.mail.pop_front()
    }

    fn ask(&mut self, _question: Question<'_>) -> Answer {
        self.answers
            .pop_front()
            .map_or(Answer::Waiting, Answer::Text)
    }

    fn may_ask_again(&mut self, _question: Question<'_>) -> bool {
        self.second_chances > 0
    }

    fn ask_again(&mut self, _question: Question<'_>, _why: &[Problem]) {
        self.second_chances = self.second_chances.saturating_sub(1);
    }
}
