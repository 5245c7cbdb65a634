//! A robot in a world of TRIK Studio as the body of a virtual board: pixels become metres, down becomes up.
//!
//! Owns the clock between the steps of the board and the ticks of the arena, and what the arena's sensors look like at the
//! connectors. Knows no physics: the arena has it.

use std::cell::Cell;
use std::fs::File;
use std::io::Read;

use lang_diagram::brick::{Brick, Command};
use lang_diagram::ports::Port;
use lang_diagram::stand_in;
use lang_text::problem::{Problem, Words};

use super::battery::Battery;
use super::two_wheels::sharp_gp2_raw;
use super::{BadOrder, Body, Drive, GRAVITY_MPS2, Order, Power, Senses};
use crate::arena::floor::{Window, sensors};
use crate::arena::{Arena, Setup, Timeline, ranges};
use crate::field::{Field, Locks, SensorKind};
use crate::geometry::{Point, Pose, point};
use crate::limits;
use crate::show::field::{pixels, place};
use crate::show::moving::LIGHT_WHOLE;
use crate::show::{self, Moving, Scene};
use crate::world::{Colour, colour};

/// A tick of the arena in seconds.
const TICK_S: f64 = 0.01;
/// What the converter gives for a touch sensor that is pressed, and one that is not.
const TOUCH_RAW: [f64; 2] = [20.0, 1000.0];
/// What it gives for white, and how much more for black.
const LIGHT_RAW: [f64; 2] = [30.0, 993.0];
/// How much of its picture the camera shows: as much as the line sensor of the original sees.
const CAMERA_PART: f64 = 2.0;

/// The type and the name in configurations of what a kind of sensor is on an analog port.
fn analog_type(kind: SensorKind) -> Option<(&'static str, &'static str)> {
    match kind {
        SensorKind::Infrared => Some(("sharpGP2", "infrared")),
        SensorKind::Touch => Some(("touch", "touch")),
        SensorKind::Light => Some(("light", "light")),
        SensorKind::Sonar | SensorKind::Camera | SensorKind::Lidar | SensorKind::Other => None,
    }
}

fn named(letter: char, index: usize) -> Option<Port> {
    Port::named(&format!("{letter}{}", index + 1))
}

/// The robot of a field, with the port of each device in a configuration of trikfs.
pub fn configuration(field: &Field) -> String {
    let robot = field.robot().cloned().unwrap_or_default();
    let mut text = String::from(
        "-- What the world has plugged in.\nlocal trik = include 'trik.lua'\n\ntrikfs = trik.robot {\n",
    );
    let digit = |port: Option<Port>| port.and_then(|port| port.name().get(1..)).unwrap_or("");
    let [left, right] = [robot.left, robot.right].map(digit);
    // The motors of a world are linear; the table of a real motor would bend what they are told.
    for (side, number) in [("left", left), ("right", right)] {
        if !number.is_empty() && (side == "left" || left != right) {
            text += &format!(
                "  {{ port = 'M{number}', type = 'powerMotor', name = '{side}', encoder = 'E{number}' }},\n  {{ port = 'E{number}', type = 'encoder95', name = '{side}' }},\n"
            );
        }
    }
    for index in 0..6 {
        let sensor = named('A', index).and_then(|port| robot.sensor(port));
        if let Some((kind, name)) = sensor.and_then(|sensor| analog_type(sensor.kind)) {
            let number = index + 1;
            text +=
                &format!("  {{ port = 'A{number}', type = '{kind}', name = '{name}{number}' }},\n");
        }
    }
    for index in 0..2 {
        let sensor = named('D', index).and_then(|port| robot.sensor(port));
        if sensor.is_some_and(|sensor| sensor.kind == SensorKind::Sonar) {
            let number = index + 1;
            text += &format!(
                "  {{ port = 'D{number}', type = 'ultrasonic', name = 'sonar{number}' }},\n"
            );
        }
    }
    if robot
        .sensors
        .iter()
        .any(|one| one.kind == SensorKind::Lidar)
    {
        text += "  { port = 'lidar' },\n";
    }
    if !left.is_empty() && !right.is_empty() && left != right {
        text += &format!(
            "  {{ port = 'odometry', left = 'E{left}', right = 'E{right}', wheel_diameter_mm = 56, track_mm = 154 }},\n"
        );
    }
    text + "}\n"
}

/// A robot in a world of TRIK Studio.
pub struct Studio {
    arena: Arena,
    timeline: Timeline,
    battery: Battery,
    senses: Senses,
    velocity_mps: Point,
    was_stuck: bool,
    /// The floor below the camera; without pixels where there is none.
    seen: Window,
    /// Whether anybody has looked since.
    is_looked_at: Cell<bool>,
    /// What a teacher has locked.
    locks: Locks,
    /// The field as it was before anything moved, and where the robot begins.
    begun: Field,
    start: Pose,
    /// Of what stands still.
    version: u32,
}

impl Studio {
    /// The robot of a field, where the field has it.
    pub fn new(field: &Field, seed: u64) -> Self {
        let setup = Setup {
            seed,
            is_watched: true,
            ..Setup::default()
        };
        let mut studio = Self {
            arena: Arena::new(field, setup),
            timeline: Timeline::new(1.0),
            battery: Battery::default(),
            senses: Senses::default(),
            velocity_mps: Point::default(),
            was_stuck: false,
            seen: Window::default(),
            is_looked_at: Cell::new(true),
            locks: Locks::default(),
            begun: field.clone(),
            start: Pose::default(),
            version: 0,
        };
        studio.senses.pose = studio.pose();
        studio.start = studio.senses.pose;
        if let Some(start) = field.robot().and_then(start_of) {
            studio.start = start;
        }
        studio.read_sensors();
        studio
    }

    /// The same, with what a teacher has locked: nobody puts other walls around the robot.
    pub fn locked(mut self, locks: Locks) -> Self {
        self.locks = locks;
        self
    }

    fn pose(&self) -> Pose {
        show::moving::pose(&self.arena.robots()[0])
    }

    /// What the connectors carry after a tick.
    fn read_sensors(&mut self) {
        let before = self.senses.pose;
        let pose = self.pose();
        let moved = pose.at.from(before.at);
        let velocity = point(moved.x / TICK_S, moved.y / TICK_S);
        let gained = velocity.from(self.velocity_mps);
        self.velocity_mps = velocity;
        let ahead = Point::towards(pose.heading_rad);
        let turned = (pose.heading_rad - before.heading_rad).to_degrees();
        let mut analog = [None; 6];
        for (index, place) in analog.iter_mut().enumerate() {
            *place = self.analog(index);
        }
        let mut ultrasonic_m = [None; 3];
        for (index, place) in ultrasonic_m.iter_mut().take(2).enumerate() {
            let cm = named('D', index).and_then(|port| self.arena.robot(0).scalar(port));
            *place = cm
                .filter(|&cm| cm < ranges::SONAR.reach_cm)
                .map(|cm| f64::from(cm) / 100.0);
        }
        let is_stuck = self.arena.robots()[0].is_stuck();
        self.senses = Senses {
            pose,
            encoders_deg: self.shafts_deg(),
            analog,
            ultrasonic_m,
            battery_v: self.battery.voltage_v(),
            acceleration_mps2: [
                gained.dot(ahead) / TICK_S,
                ahead.cross(gained) / TICK_S,
                GRAVITY_MPS2,
            ],
            rate_dps: [0.0, 0.0, turned / TICK_S],
            bumps: self.senses.bumps + u32::from(is_stuck && !self.was_stuck),
        };
        self.was_stuck = is_stuck;
        // Pictures cost more than everything else here.
        if self.is_looked_at.replace(false) {
            let robot = &self.arena.robots()[0];
            if let Some(camera) = robot.sensor_of(SensorKind::Camera) {
                let (at, degrees) = robot.sensor_pose(camera);
                let floor = self.arena.floor();
                floor.view(
                    at,
                    degrees,
                    sensors::CAMERA_SIDE,
                    CAMERA_PART,
                    &mut self.seen,
                );
            }
        }
    }

    /// Another world around the robot, which stays where it is.
    fn change(&mut self, to: &Field) {
        self.arena.edit(|field| {
            field.walls.clone_from(&to.walls);
            field.solids.clone_from(&to.solids);
            field.drawn.clone_from(&to.drawn);
            field.images.clone_from(&to.images);
            field.blobs.clone_from(&to.blobs);
            field.regions.clone_from(&to.regions);
            field
                .settings
                .background
                .clone_from(&to.settings.background);
        });
        self.begun.solids.clone_from(&to.solids);
        self.version = self.version.wrapping_add(1);
        self.read_sensors();
    }

    /// A hand puts the robot there. It feels no push.
    fn put(&mut self, to: Pose) {
        let at = pixels(to.at);
        if let Some(robot) = self.arena.robot_mut(0) {
            let size = robot.description().size;
            robot.put(stand_in::Pose {
                x: at.x - size.x / 2.0,
                y: at.y - size.y / 2.0,
                degrees: -to.heading_rad.to_degrees(),
            });
        }
        self.senses.pose = self.pose();
        self.velocity_mps = Point::default();
        self.read_sensors();
    }

    /// Does what a person orders time and things.
    fn obey(&mut self, order: Order<'_>) -> Result<(), BadOrder> {
        match order {
            Order::Pause => self.timeline.pause(true),
            Order::Go => self.timeline.pause(false),
            Order::Step(ticks) => {
                self.timeline.pause(true);
                (0..ticks).for_each(|_| self.timeline.step());
            }
            Order::Speed(speed) => self.timeline.set_speed(speed),
            Order::Field(_) if self.locks.world => return Err(BadOrder::Locked),
            Order::Field(file) => self.change(&read(file)?),
            Order::Reset => {
                self.arena.put_solids_of(&self.begun);
                if !self.arena.trace().is_empty() {
                    self.arena.wipe();
                    self.version = self.version.wrapping_add(1);
                }
                self.put(self.start);
            }
            Order::Robot(_) if self.locks.robot_position => return Err(BadOrder::RobotLocked),
            Order::Robot(pose) => self.put(pose),
            Order::Thing(..) if self.locks.world => return Err(BadOrder::Locked),
            Order::Thing(number, at) => {
                if !self.arena.put_solid(number, pixels(at)) {
                    return Err(BadOrder::NoThing(number));
                }
                self.read_sensors();
            }
        }
        Ok(())
    }

    fn analog(&mut self, index: usize) -> Option<f64> {
        let port = named('A', index)?;
        let kind = self.arena.robots()[0].sensor(port)?.kind;
        let reading = f64::from(self.arena.robot(0).scalar(port)?);
        match kind {
            SensorKind::Infrared => Some(sharp_gp2_raw(reading)),
            SensorKind::Touch => Some(TOUCH_RAW[usize::from(reading == 0.0)]),
            SensorKind::Light => Some(LIGHT_RAW[0] + LIGHT_RAW[1] * reading / LIGHT_WHOLE),
            SensorKind::Sonar | SensorKind::Camera | SensorKind::Lidar | SensorKind::Other => None,
        }
    }
}

/// Where the author of a world has a robot put back to, if that is said.
fn start_of(robot: &crate::field::Robot) -> Option<Pose> {
    let start = robot.start.as_ref()?;
    let at = place(start.at);
    Some(Pose::new(at.x, at.y, -start.direction.to_radians()))
}

/// A world model in a file.
fn read(file: &str) -> Result<Field, BadOrder> {
    let unread = |error: std::io::Error| BadOrder::Unread(file.to_owned(), error.to_string());
    let mut text = String::new();
    let opened = File::open(file).map_err(unread)?;
    let read = opened.take(limits::FIELD_BYTES).read_to_string(&mut text);
    read.map_err(unread)?;
    let opened = Field::read(&text).map_err(|problems| {
        let first = problems
            .first()
            .map_or_else(|| Words::new("", ""), Problem::in_both);
        BadOrder::Field(file.to_owned(), first)
    })?;
    Ok(opened.field)
}

impl Body for Studio {
    fn step(&mut self, dt_s: f64, drive: &Drive) {
        self.battery.step(dt_s, 0.0);
        for _ in 0..self.timeline.due(dt_s) {
            for (index, power) in drive.motors.iter().enumerate() {
                let percent = match power {
                    Power::Duty(percent) => percent.round().clamp(-100.0, 100.0) as i32,
                    Power::Brake | Power::Open | Power::Blocked => 0,
                };
                if let Some(port) = named('M', index) {
                    self.arena
                        .robot(0)
                        .command(Command::Power { port, percent });
                }
            }
            self.arena.tick();
            self.read_sensors();
        }
    }

    fn weaken_battery(&mut self, volts: f64) {
        self.battery.sag_v = volts;
    }

    fn senses(&self) -> Senses {
        let senses = Senses {
            battery_v: self.battery.voltage_v(),
            ..self.senses
        };
        senses.paused(self.timeline.is_paused())
    }

    fn shafts_deg(&self) -> [f64; 4] {
        let robot = &self.arena.robots()[0];
        std::array::from_fn(|index| named('E', index).map_or(0.0, |port| robot.encoder(port)))
    }

    fn has_lidar(&self) -> bool {
        self.arena.robots()[0]
            .sensor_of(SensorKind::Lidar)
            .is_some()
    }

    fn range_m(&self, clockwise_rad: f64) -> Option<f64> {
        let robot = &self.arena.robots()[0];
        show::moving::range_m(robot, self.arena.solids(), clockwise_rad)
    }

    fn has_infrared_camera(&self) -> bool {
        false
    }

    fn order(&mut self, words: &str) -> Result<(), BadOrder> {
        self.obey(Order::parse(words)?)
    }

    fn enter(&mut self, field: &Field, locks: Locks) -> Result<(), BadOrder> {
        if self.locks.world {
            return Err(BadOrder::Locked);
        }
        self.arena.wipe();
        self.arena
            .edit(|now| now.settings.clone_from(&field.settings));
        self.change(field);
        self.locks = locks;
        if let Some(robot) = field.robot().or(field.robots.first()) {
            let half = point(robot.size.x / 2.0, robot.size.y / 2.0);
            let centre = point(robot.position.x + half.x, robot.position.y + half.y);
            let at = place(centre);
            let there = Pose::new(at.x, at.y, -robot.direction.to_radians());
            self.start = start_of(robot).unwrap_or(there);
            self.put(there);
        }
        Ok(())
    }

    fn scene(&self) -> Option<Scene> {
        Some(Scene {
            locks: self.locks,
            takes_fields: !self.locks.world,
            ..show::field::scene(&self.arena, self.start)
        })
    }

    fn version(&self) -> u32 {
        self.version
    }

    fn moving(&self) -> Moving {
        let mut moving = Moving {
            is_paused: self.timeline.is_paused(),
            speed: self.timeline.speed(),
            ..show::moving::moving(&self.arena)
        };
        // As the connectors have it.
        moving.robots[0].pose = self.senses.pose;
        moving
    }

    /// Of the picture of the last tick.
    fn pixel(&self, right: f64, down: f64) -> Option<Colour> {
        self.is_looked_at.set(true);
        let side = self.seen.side;
        let index = |place: f64| {
            let share = (place + 1.0) / 2.0;
            ((share * side as f64) as usize).min(side.saturating_sub(1))
        };
        let pixel = self.seen.pixels.get(index(down) * side + index(right))?;
        let [red, green, blue] = *pixel;
        Some(colour(red, green, blue))
    }
}

#[cfg(test)]
mod tests;
