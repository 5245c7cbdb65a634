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

use super::battery::Battery;
use super::two_wheels::sharp_gp2_raw;
use super::{BadOrder, Body, Drive, GRAVITY_MPS2, Order, Power, Senses};
use crate::arena::floor::{Window, sensors};
use crate::arena::{Arena, Setup, Timeline, ranges, screen};
use crate::field::{Field, Locks, Sensor, SensorKind};
use crate::geometry::{Point, Pose, point};
use crate::limits;
use crate::show::field::{PIXELS_IN_M, pixels, place};
use crate::show::{self, Moving, Placed, Scene};
use crate::world::{Colour, colour};

/// A tick of the arena in seconds.
const TICK_S: f64 = 0.01;
/// What the converter gives for a touch sensor that is pressed, and one that is not.
const TOUCH_RAW: [f64; 2] = [20.0, 1000.0];
/// What it gives for white, and how much more for black.
const LIGHT_RAW: [f64; 2] = [30.0, 993.0];
/// What a light sensor of the original says of black; of white it says 0.
const LIGHT_WHOLE: f64 = 99.0;
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
        let robot = &self.arena.robots()[0];
        let centre = robot.centre();
        Pose::new(
            centre.x / PIXELS_IN_M,
            -centre.y / PIXELS_IN_M,
            -robot.pose().degrees.to_radians(),
        )
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

    /// What a sensor that people see has said last.
    fn reading(&self, sensor: &Sensor) -> Option<f64> {
        let port = sensor.port?;
        let robot = &self.arena.robots()[0];
        let said = f64::from(robot.readings.last(port));
        let within = |beam: ranges::Beam| {
            let is_near = said < f64::from(beam.reach_cm);
            is_near.then_some(said / 100.0)
        };
        match sensor.kind {
            SensorKind::Infrared => within(ranges::INFRARED),
            SensorKind::Sonar => within(ranges::SONAR),
            SensorKind::Light => Some(said / LIGHT_WHOLE),
            SensorKind::Touch => Some(said),
            SensorKind::Camera | SensorKind::Lidar | SensorKind::Other => None,
        }
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
            .map_or_else(String::new, ToString::to_string);
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
        let (at, degrees) = robot.sensor_pose(robot.sensor_of(SensorKind::Lidar)?);
        let px = ranges::ray(
            self.arena.solids(),
            at,
            degrees + clockwise_rad.to_degrees(),
        )?;
        Some(px / PIXELS_IN_M)
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
        let robot = &self.arena.robots()[0];
        let readings = |sensor: &Sensor| {
            show::field::sensor(robot.description(), sensor).map(|_| self.reading(sensor))
        };
        let thing = |solid: &crate::field::Solid| {
            let at = place(solid.at);
            Pose::new(at.x, at.y, -solid.rotation.to_radians())
        };
        let marker = robot.marker();
        Moving {
            time_s: f64::from(self.arena.now()) / 1000.0,
            is_paused: self.timeline.is_paused(),
            speed: self.timeline.speed(),
            robots: vec![Placed {
                pose: self.senses.pose,
                readings: robot
                    .description()
                    .sensors
                    .iter()
                    .filter_map(readings)
                    .collect(),
                rays_m: match self.has_lidar() {
                    true => show::rays(|angle| self.range_m(angle)),
                    false => Vec::new(),
                },
                is_stuck: robot.is_stuck(),
                marker: match marker.is_down {
                    true => screen::hex(screen::named(&marker.colour)),
                    false => String::new(),
                },
            }],
            things: self.arena.field().solids.iter().map(thing).collect(),
        }
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
mod tests {
    use super::*;
    use crate::field::{Robot, Sensor, Wall};

    fn field() -> Field {
        let mut robot = Robot::default();
        for (port, kind) in [("A1", SensorKind::Infrared), ("D1", SensorKind::Sonar)] {
            let mut sensor = Sensor::new(Port::named(port).unwrap(), kind);
            sensor.at = point(62.0, 25.0);
            robot.sensors.push(sensor);
        }
        let mut field = Field::default();
        field.robots.push(robot);
        field
            .walls
            .push(Wall::new(point(200.0, -100.0), point(200.0, 100.0)));
        field
    }

    fn full(percent: f64) -> Drive {
        let mut drive = Drive::default();
        drive.motors[2] = Power::Duty(percent);
        drive.motors[3] = Power::Duty(percent);
        drive
    }

    #[test]
    fn a_second_straight_is_27_centimetres_and_the_wheels_say_so() {
        let mut body = Studio::new(&Field::default(), 1);
        let before = body.senses().pose;
        for _ in 0..1000 {
            body.step(0.001, &full(100.0));
        }
        let after = body.senses();
        // 76.79 px in a second; the first tick only takes the speed.
        let way = after.pose.at.x - before.at.x;
        assert!((way - 0.2688).abs() < 0.004, "{way}");
        assert_eq!(after.pose.at.y, before.at.y);
        assert!((after.encoders_deg[2] - 550.0).abs() < 6.0);
        assert_eq!(after.encoders_deg[0], 0.0);
    }

    #[test]
    fn sensors_are_what_the_connectors_would_carry() {
        let body = Studio::new(&field(), 1);
        let senses = body.senses();
        assert_eq!(senses.analog[0], Some(sharp_gp2_raw(47.0)));
        assert_eq!(senses.analog[1], None);
        assert_eq!(senses.ultrasonic_m, [Some(0.47), None, None]);
        assert!(!body.has_lidar() && body.range_m(0.0).is_none());
        assert!(senses.battery_v > 11.0);
    }

    #[test]
    fn the_camera_sees_the_floor_before_it() {
        let mut field = field();
        let mut camera = Sensor::new(Port::named("A2").unwrap(), SensorKind::Camera);
        camera.at = point(62.0, 25.0);
        field.robots[0].sensors.push(camera);
        let text = "<root version=\"20251219\"><settings/><world><colorFields><line begin=\"62:-50\" end=\"62:100\" \
                    stroke=\"#ff000000\" stroke-width=\"6\"/></colorFields></world></root>";
        let painted = Field::read(text).unwrap().field;
        field.drawn = painted.drawn;
        let body = Studio::new(&field, 1);
        // The line lies across, in the middle of the picture.
        assert_eq!(body.pixel(0.0, 0.0), Some(colour(0, 0, 0)));
        assert_eq!(body.pixel(-0.9, 0.0), Some(colour(0, 0, 0)));
        assert_eq!(body.pixel(0.0, -0.9), Some(colour(255, 255, 255)));
        let blind = Studio::new(&Field::default(), 1);
        assert_eq!(blind.pixel(0.0, 0.0), None);
    }

    #[test]
    fn a_person_orders_time_and_walls() {
        let mut body = Studio::new(&field(), 1);
        let run = |body: &mut Studio| {
            let before = body.senses().pose.at.x;
            for _ in 0..500 {
                body.step(0.001, &full(100.0));
            }
            body.senses().pose.at.x - before
        };
        let usual = run(&mut body);
        assert!((usual - 0.134).abs() < 0.004, "{usual}");
        body.order("pause").unwrap();
        assert_eq!(run(&mut body), 0.0);
        body.order("step 25").unwrap();
        let stepped = run(&mut body);
        assert!((stepped - usual / 2.0).abs() < 0.004, "{stepped}");
        assert_eq!(run(&mut body), 0.0);
        body.order("speed 0.5").unwrap();
        body.order("go").unwrap();
        let slow = run(&mut body);
        assert!((slow - usual / 2.0).abs() < 0.004, "{slow}");
        for words in [
            "",
            "fly",
            "step 0",
            "step 1e9",
            "speed nan",
            "speed 0",
            "field",
            "field /nowhere",
        ] {
            assert!(body.order(words).is_err(), "{words}");
        }
        let mut locked = Studio::new(&field(), 1).locked(Locks {
            world: true,
            ..Locks::default()
        });
        let refused = locked.order("field x.xml").unwrap_err();
        assert_eq!(refused, BadOrder::Locked);
        locked.order("pause").unwrap();
        // The wall is gone in another field.
        let before = body.senses().analog[0];
        assert!(before > Some(sharp_gp2_raw(47.0)));
        let file = std::env::temp_dir().join(format!("trik-field-{}.xml", std::process::id()));
        std::fs::write(
            &file,
            "<root version=\"20251219\"><settings/><world/></root>",
        )
        .unwrap();
        body.order(&format!("field {}", file.display())).unwrap();
        std::fs::remove_file(&file).unwrap();
        assert_eq!(body.senses().analog[0], Some(sharp_gp2_raw(80.0)));
    }

    #[test]
    fn a_hand_carries_the_robot_and_things_and_reset_puts_them_back() {
        let mut field = field();
        let ball = crate::field::Solid::new(crate::field::SolidKind::Ball, point(0.0, 200.0));
        field.solids.push(ball);
        let mut body = Studio::new(&field, 1);
        let begun = body.moving();
        let far = body.senses().ultrasonic_m[0];
        body.order("robot 0.4 0.1 90").unwrap();
        let pose = body.senses().pose;
        assert!((pose.at.x - 0.4).abs() < 1e-9 && (pose.at.y - 0.1).abs() < 1e-9);
        assert!((pose.heading_rad.to_degrees() - 90.0).abs() < 1e-9);
        assert_ne!(body.senses().ultrasonic_m[0], far);
        assert_eq!(body.senses().rate_dps, [0.0; 3], "nobody felt a push");
        body.order("thing 0 0.4 0.45").unwrap();
        let near = body.senses().ultrasonic_m[0].unwrap();
        assert!((0.15..0.2).contains(&near), "{near}");
        assert_eq!(body.order("thing 1 0 0"), Err(BadOrder::NoThing(1)));
        let shown = body.moving();
        assert_eq!(shown.robots[0].readings[1], Some(near));
        for _ in 0..100 {
            body.step(0.001, &full(100.0));
        }
        let turned = body.shafts_deg();
        body.order("reset").unwrap();
        assert_eq!(body.moving().things, begun.things);
        assert_eq!(body.senses().pose, begun.robots[0].pose);
        assert_eq!(body.shafts_deg(), turned, "a hand turns no wheel");
        assert_eq!(body.version(), 0);
    }

    #[test]
    fn another_world_brings_its_own_start() {
        let mut body = Studio::new(&field(), 1);
        let mut other = Field::default();
        other.robots.push(Robot {
            position: point(100.0, 200.0),
            direction: 90.0,
            ..Robot::default()
        });
        let locks = Locks {
            robot_position: true,
            ..Locks::default()
        };
        body.enter(&other, locks).unwrap();
        let scene = body.scene().unwrap();
        assert!(scene.items.is_empty() && scene.locks.robot_position);
        let pose = body.senses().pose;
        assert!((pose.at.x - 125.0 / PIXELS_IN_M).abs() < 1e-9, "{pose:?}");
        assert!((pose.at.y + 225.0 / PIXELS_IN_M).abs() < 1e-9, "{pose:?}");
        assert_eq!(body.version(), 1);
        assert_eq!(body.order("robot 0 0 0"), Err(BadOrder::RobotLocked));
        body.order("reset").unwrap();
        assert_eq!(body.senses().pose, pose);
        let mut locked = Studio::new(&field(), 1).locked(Locks {
            world: true,
            ..Locks::default()
        });
        assert_eq!(locked.enter(&other, locks), Err(BadOrder::Locked));
        assert_eq!(locked.order("thing 0 0 0"), Err(BadOrder::Locked));
        assert!(!locked.scene().unwrap().takes_fields);
    }

    #[test]
    fn the_configuration_has_what_the_world_has() {
        let text = configuration(&field());
        for line in [
            "{ port = 'M4', type = 'powerMotor', name = 'left', encoder = 'E4' },",
            "{ port = 'A1', type = 'sharpGP2', name = 'infrared1' },",
            "{ port = 'D1', type = 'ultrasonic', name = 'sonar1' },",
        ] {
            assert!(text.contains(line), "{line} in {text}");
        }
        assert!(!text.contains("A2") && !text.contains("lidar"));
    }
}
