//! One robot while it runs: pose, motors, encoders, gyroscope, accelerometer, and what a person presses.
//!
//! Owns what changes with each tick. Knows no walls and no other robots.

use std::collections::VecDeque;

use lang_diagram::machine::STEP_MS;
use lang_diagram::ports::{Port, Sort};
use lang_diagram::stand_in::{Motion, Pose, Rolling, wheel_turn};

use super::floor::sensors::noise;
use super::outline::Outline;
use super::readings::Readings;
use super::screen::Shown;
use crate::field::{self, Sensor, SensorKind, Settings};
use crate::geometry::{Point, point};
use crate::random::Random;

/// Ticks over which acceleration is taken.
const STAMPS: usize = 50;
/// What the original multiplies differences of places with.
const ACCELERATION_SCALE: f64 = 30_000.0;
/// What it calls the fall of things.
const GRAVITY: i32 = 4065;
/// Variance of a real motor's speed, as a share of it.
const MOTOR_NOISE: f64 = 0.0125;
/// Thousandths of a degree all around.
const TURN: i32 = 360_000;

/// One pad of a gamepad.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Pad {
    /// From -100 to 100, to the right.
    pub x: i32,
    /// From -100 to 100, up.
    pub y: i32,
    /// Whether a finger is on it.
    pub is_pressed: bool,
}

/// A gamepad that is connected.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Gamepad {
    /// Both pads.
    pub pads: [Pad; 2],
    /// The wheel, in percent.
    pub wheel: i32,
    /// Which of the five buttons are pressed.
    pub buttons: [bool; 5],
    /// Whether it has gone away; then nothing on it is touched.
    pub is_away: bool,
}

/// The marker that draws behind a robot.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Marker {
    /// Whether it draws.
    pub is_down: bool,
    /// In which colour.
    pub colour: String,
}

/// Where random numbers of a program come from.
#[derive(Clone, Debug)]
pub struct Dice {
    /// What comes instead of all of them, if a rule says so.
    pub fixed: Option<i32>,
    /// How often it was asked.
    pub calls: u32,
    /// What it gave last.
    pub last: i32,
    random: Random,
}

impl Dice {
    fn roll(&mut self, low: i32, high: i32) -> i32 {
        self.calls = self.calls.saturating_add(1);
        let number = self.throw(low, high);
        self.last = self.fixed.unwrap_or(number);
        self.last
    }

    /// A random number of which nobody keeps count.
    pub(super) fn throw(&mut self, low: i32, high: i32) -> i32 {
        let count = i64::from(high) - i64::from(low) + 1;
        let number = i64::from(low) + ((self.random.unit() * count as f64) as i64).min(count - 1);
        i32::try_from(number).unwrap_or(low)
    }
}

/// A robot that runs.
#[derive(Clone, Debug)]
pub struct Robot {
    /// How it was put onto the field: its sensors and wheels.
    pub(crate) placed: field::Robot,
    pub(crate) pose: Pose,
    /// Power of M1 to M4 in percent, as told; a rule may tell more than a motor can do.
    powers: [i32; 4],
    /// Angles of S1 to S6 in degrees, as told.
    servos: [i32; 6],
    /// Motors of the left and right wheel, as indices.
    wheels: [Option<usize>; 2],
    /// Sizes of its wheels.
    pub(super) rolling: Rolling,
    /// What its sensors have said.
    pub readings: Readings,
    /// Powers of both wheels that the physics of the next tick takes.
    pub(super) chosen: [i32; 2],
    /// What the last tick moved it.
    pub(super) motion: Motion,
    pub(super) is_stuck: bool,
    /// Degrees of E1 to E4.
    encoders: [f64; 4],
    previous_degrees: Option<f64>,
    /// Degrees in a second.
    rate: f64,
    calibrated: f64,
    /// Places of the last ticks, a ring; how many there are, and where the next one goes.
    stamps: ([Point; STAMPS], usize, usize),
    /// Square and sensors in its own coordinates.
    outline: Outline,
    /// Keys that are pressed, by their codes.
    keys: Vec<i32>,
    gamepad: Option<Gamepad>,
    /// Random numbers of its program.
    pub dice: Dice,
    noise: Random,
    pub(crate) marker: Marker,
    pub(crate) shown: Shown,
    /// Colour that the line sensor looks for.
    pub(super) line_colour: [u8; 3],
    pub(super) mail: VecDeque<String>,
    pub(super) hull: i32,
}

/// The digit after a port's letter, from 0.
fn digit(port: Port) -> usize {
    let digit = port.name().as_bytes().get(1).copied().unwrap_or(b'1');
    usize::from(digit.saturating_sub(b'1'))
}

impl Robot {
    pub(super) fn new(placed: field::Robot, index: usize, seed: u64) -> Self {
        let wheels = [placed.left, placed.right]
            .map(|motor| motor.filter(|motor| motor.sort() == Sort::Motor).map(digit));
        let seed = seed ^ (index as u64).wrapping_mul(0x9E37_79B9);
        let mut robot = Self {
            pose: Pose {
                x: placed.position.x,
                y: placed.position.y,
                degrees: placed.direction,
            },
            rolling: Rolling::of_size(placed.size.x, placed.size.y),
            readings: Readings::default(),
            powers: [0; 4],
            servos: [0; 6],
            wheels,
            chosen: [0; 2],
            motion: Motion::default(),
            is_stuck: false,
            encoders: [0.0; 4],
            previous_degrees: None,
            rate: 0.0,
            calibrated: 0.0,
            stamps: ([Point::default(); STAMPS], 0, 0),
            outline: Outline::default(),
            keys: Vec::new(),
            gamepad: None,
            dice: Dice {
                fixed: None,
                calls: 0,
                last: 0,
                random: Random::new(seed),
            },
            noise: Random::new(!seed),
            marker: Marker::default(),
            shown: Shown::default(),
            line_colour: [0; 3],
            mail: VecDeque::new(),
            hull: index as i32 + 1,
            placed,
        };
        robot.outline = robot.own_outline();
        robot
    }

    /// Square and sensors, unturned, from the centre.
    fn own_outline(&self) -> Outline {
        let mut outline = Outline::default();
        let half = self.half();
        outline.add(square_of(half));
        for sensor in &self.placed.sensors {
            let is_last = sensor
                .port
                .is_some_and(|port| self.placed.sensor(port).is_some_and(|one| one == sensor));
            if let Some(corners) = body_of(sensor).filter(|_| is_last) {
                outline.add(corners.map(|one| one.from(half)));
            }
        }
        outline
    }

    /// The square and the sensors as they stand on the field.
    pub fn outline_into(&self, into: &mut Outline) {
        into.clear();
        let (sin, cos) = libm::sincos(self.pose.degrees.to_radians());
        let centre = self.centre();
        for corners in self.outline.figures() {
            into.add(corners.iter().map(|corner| {
                point(
                    centre.x + corner.x * cos - corner.y * sin,
                    centre.y + corner.x * sin + corner.y * cos,
                )
            }));
        }
    }

    /// The square alone, without sensors: corners in order.
    pub fn square(&self) -> [Point; 4] {
        square_of(self.half()).map(|Point { x, y }| {
            let (sin, cos) = libm::sincos(self.pose.degrees.to_radians());
            let centre = self.centre();
            point(centre.x + x * cos - y * sin, centre.y + x * sin + y * cos)
        })
    }

    /// Corners of a sensor on the field; nothing if it has no body.
    pub fn sensor_corners(&self, sensor: &Sensor) -> Option<[Point; 4]> {
        let half = self.half();
        let centre = self.centre();
        let (sin, cos) = libm::sincos(self.pose.degrees.to_radians());
        Some(body_of(sensor)?.map(|one| {
            let (x, y) = (one.x - half.x, one.y - half.y);
            point(centre.x + x * cos - y * sin, centre.y + x * sin + y * cos)
        }))
    }

    /// Where a sensor is and which way it looks, in degrees.
    pub fn sensor_pose(&self, sensor: &Sensor) -> (Point, f64) {
        let half = self.half();
        // The original turns the way from the centre in 32 bits.
        let x = f64::from((sensor.at.x - half.x) as f32);
        let y = f64::from((sensor.at.y - half.y) as f32);
        let (sin, cos) = libm::sincos(self.pose.degrees.to_radians());
        let turned_x = (x * cos - y * sin) as f32;
        let turned_y = (x * sin + y * cos) as f32;
        let centre = self.centre();
        (
            point(
                centre.x + f64::from(turned_x),
                centre.y + f64::from(turned_y),
            ),
            sensor.direction + self.pose.degrees,
        )
    }

    /// What follows the physics of a tick: noise, pose, gyroscope, acceleration, encoders.
    pub(super) fn advance(&mut self, settings: &Settings) {
        for (side, motor) in self.wheels.into_iter().enumerate() {
            let power = motor.map_or(0, |motor| self.powers[motor]);
            self.chosen[side] = if settings.realistic_motors {
                let share = 1.0 + noise(&mut self.noise, MOTOR_NOISE);
                (f64::from(power) * share).round().clamp(-100.0, 100.0) as i32
            } else {
                power.clamp(-100, 100)
            };
        }
        self.shown.tick(STEP_MS);
        self.pose.x += f64::from(self.motion.shift.0);
        self.pose.y += f64::from(self.motion.shift.1);
        self.pose.degrees += self.motion.turn;
        if let Some(previous) = self.previous_degrees.replace(self.pose.degrees) {
            self.rate = (self.pose.degrees - previous) * 100.0;
        }
        let (stamps, count, next) = &mut self.stamps;
        stamps[*next] = point(self.pose.x, self.pose.y);
        *next = (*next + 1) % STAMPS;
        *count = (*count + 1).min(STAMPS);
        let sign = if self.is_stuck { -1.0 } else { 1.0 };
        let is_one = self.wheels[0] == self.wheels[1];
        for (side, motor) in self.wheels.into_iter().enumerate() {
            if let Some(motor) = motor.filter(|_| side == 0 || !is_one) {
                self.encoders[motor] += sign * wheel_turn(self.chosen[side]);
            }
        }
    }

    /// Where it is: the upper left corner of the unturned square, and degrees clockwise.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Puts it elsewhere, as a hand does.
    pub fn put(&mut self, pose: Pose) {
        self.pose = pose;
        self.motion = Motion::default();
    }

    /// Its centre.
    pub fn centre(&self) -> Point {
        let half = self.half();
        point(self.pose.x + half.x, self.pose.y + half.y)
    }

    /// From its corner to its centre.
    fn half(&self) -> Point {
        let size = self.placed.size;
        point(size.x / 2.0, size.y / 2.0)
    }

    /// Its sensors, wheels and the rest of its description.
    pub fn description(&self) -> &field::Robot {
        &self.placed
    }

    /// The sensor on a port.
    pub fn sensor(&self, port: Port) -> Option<&Sensor> {
        self.placed.sensor(port)
    }

    /// The first sensor of a kind.
    pub fn sensor_of(&self, kind: SensorKind) -> Option<&Sensor> {
        self.placed.sensors.iter().find(|one| one.kind == kind)
    }

    /// Power of a motor in percent; 0 of what is no motor.
    pub fn power(&self, port: Port) -> i32 {
        if port.sort() == Sort::Motor {
            self.powers[digit(port)]
        } else {
            0
        }
    }

    pub(crate) fn set_power(&mut self, port: Port, percent: i32) {
        if port.sort() == Sort::Motor {
            self.powers[digit(port)] = percent;
        }
    }

    /// Angle of a servo in degrees, as told.
    pub fn servo(&self, port: Port) -> i32 {
        if port.sort() == Sort::Servo {
            self.servos[digit(port)]
        } else {
            0
        }
    }

    pub(crate) fn set_servo(&mut self, port: Port, degrees: i32) {
        if port.sort() == Sort::Servo {
            self.servos[digit(port)] = degrees;
        }
    }

    pub(super) fn rest(&mut self) {
        self.powers = [0; 4];
    }

    /// Whether any motor is on.
    pub fn is_riding(&self) -> bool {
        self.powers.iter().any(|&power| power != 0)
    }

    /// Whether it touched something at the last tick. Realistic physics never says so.
    pub fn is_stuck(&self) -> bool {
        self.is_stuck
    }

    /// Degrees of an encoder, not rounded; 0 of what is none.
    pub fn encoder(&self, port: Port) -> f64 {
        if port.sort() == Sort::Encoder {
            self.encoders[digit(port)]
        } else {
            0.0
        }
    }

    pub(super) fn reset_encoder(&mut self, port: Port) {
        if port.sort() == Sort::Encoder {
            self.encoders[digit(port)] = 0.0;
        }
    }

    /// The present heading becomes 0.
    pub(super) fn calibrate(&mut self) {
        self.calibrated = self.pose.degrees;
    }

    /// Rate in thousandths of a degree a second, and angle in thousandths of a degree from -180000 on.
    pub fn gyroscope(&self) -> (i32, i32) {
        let angle = ((self.pose.degrees - self.calibrated) * 1000.0) as i32;
        let angle = angle.wrapping_add(TURN / 2).rem_euclid(TURN) - TURN / 2;
        ((self.rate * 1000.0) as i32, angle)
    }

    /// What the accelerometer says: how it moved in the oldest of the last 50 ticks, the other way round, and the fall of
    /// things. The original's formula wants more, but two of its terms are the same place.
    pub fn accelerometer(&self) -> [i32; 3] {
        let (stamps, count, next) = &self.stamps;
        let at = |age: usize| stamps[(next + STAMPS - 1 - age) % STAMPS];
        let difference = match *count {
            0 | 1 => Point::default(),
            2 | 3 => at(0).from(at(count - 1)),
            _ => at(count - 1).from(at(count - 2)),
        };
        let count = (*count).max(1) as f64;
        [
            (difference.x / count * ACCELERATION_SCALE) as i32,
            (difference.y / count * ACCELERATION_SCALE) as i32,
            GRAVITY,
        ]
    }

    /// Presses a key or lets it go, by its code.
    pub fn press(&mut self, code: i32, is_pressed: bool) {
        self.keys.retain(|&one| one != code);
        if is_pressed {
            self.keys.push(code);
        }
    }

    /// Whether a key is pressed.
    pub fn is_pressed(&self, code: i32) -> bool {
        self.keys.contains(&code)
    }

    /// Connects a gamepad, changes what it says, or takes it away.
    pub fn set_gamepad(&mut self, gamepad: Option<Gamepad>) {
        self.gamepad = gamepad;
    }

    /// The gamepad, if one is connected.
    pub fn gamepad(&self) -> Option<&Gamepad> {
        self.gamepad.as_ref()
    }

    /// Its display, light and loudspeaker, and what it said.
    pub fn shown(&self) -> &Shown {
        &self.shown
    }

    /// The marker.
    pub fn marker(&self) -> &Marker {
        &self.marker
    }

    /// Its number among robots, for messages.
    pub fn hull(&self) -> i32 {
        self.hull
    }

    /// A random number for its program.
    pub(super) fn roll(&mut self, low: i32, high: i32) -> i32 {
        self.dice.roll(low, high)
    }

    /// Where noise of its sensors comes from.
    pub(crate) fn noise_mut(&mut self) -> &mut Random {
        &mut self.noise
    }
}

/// The corners of a rectangle around (0, 0).
fn square_of(half: Point) -> [Point; 4] {
    let (x, y) = (half.x, half.y);
    [point(-x, -y), point(x, -y), point(x, y), point(-x, y)]
}

/// Width and height of a sensor as it is drawn.
fn size_of(kind: SensorKind) -> Option<(f64, f64)> {
    match kind {
        SensorKind::Touch => Some((25.0, 10.0)),
        SensorKind::Light => Some((12.0, 12.0)),
        SensorKind::Infrared | SensorKind::Sonar | SensorKind::Lidar => Some((36.0, 36.0)),
        SensorKind::Camera => Some((18.0, 18.0)),
        SensorKind::Other => None,
    }
}

/// What of a sensor is solid, in the robot's coordinates; of one that measures distance only the half behind.
pub(super) fn body_of(sensor: &Sensor) -> Option<[Point; 4]> {
    let (width, height) = size_of(sensor.kind)?;
    let right = match sensor.kind {
        SensorKind::Infrared | SensorKind::Sonar => 0.0,
        SensorKind::Light
        | SensorKind::Touch
        | SensorKind::Camera
        | SensorKind::Lidar
        | SensorKind::Other => width / 2.0,
    };
    let (left, half) = (-width / 2.0, height / 2.0);
    let (sin, cos) = libm::sincos(sensor.direction.to_radians());
    let corners = [(left, -half), (right, -half), (right, half), (left, half)];
    Some(corners.map(|(x, y)| {
        point(
            sensor.at.x + x * cos - y * sin,
            sensor.at.y + x * sin + y * cos,
        )
    }))
}
