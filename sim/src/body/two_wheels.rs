//! A robot with a ring of sensors: two driven wheels and a castor, or whatever wheels a model of DCML has.
//!
//! Owns where its sensors sit and what they give; which port has what is the table of [`crate::robots`]. How it moves when
//! its wheels turn is `rolling`'s part.

use super::battery::Battery;
use super::motor::Motor;
use super::pace::Pace;
use super::rolling::refusal::Refusal;
use super::rolling::{Actuator, Overrides, Port, Rolling};
use super::{BadOrder, Body, Drive, GRAVITY_MPS2, Order, Senses};
use crate::field::{Field, Locks};
use crate::geometry::{Point, Pose, point};
use crate::show::{self, Moving, Placed, Scene, Sensor, Shape, Wheel};
use crate::world::{self, Colour, World, colour};
use lang_dcml::models;
use lang_diagram::machine::STEP_MS;
use std::f64::consts::FRAC_PI_2;

const WHEEL_RADIUS_M: f64 = 0.028;
const TRACK_M: f64 = 0.155;
/// The shipped model that moves it.
const MODEL: &str = "differential-drive";
const RADIUS_M: f64 = 0.11;
/// Indices of the ports: M3 and E3 left, M4 and E4 right.
const LEFT: usize = 2;
const RIGHT: usize = 3;
/// The light sensors look down here: ahead of the axle, and to each side.
const LIGHT_AHEAD_M: f64 = 0.09;
const LIGHT_BESIDE_M: f64 = 0.03;
const LIGHT_SPOT_M: f64 = 0.006;
/// Half of the beam of an ultrasonic sensor, and how far and near it hears.
const BEAM_RAD: f64 = 0.2;
const ULTRASONIC_MAX_M: f64 = 4.0;
const ULTRASONIC_MIN_M: f64 = 0.02;
const LIDAR_MAX_M: f64 = 8.0;
/// The camera: ahead of the axle, above the floor, looking down, and half of its picture.
const CAMERA_AHEAD_M: f64 = 0.1;
const CAMERA_HEIGHT_M: f64 = 0.1;
const CAMERA_PITCH_RAD: f64 = 0.44;
const CAMERA_HALF_WIDTH_RAD: f64 = 0.49;
const CAMERA_HALF_HEIGHT_RAD: f64 = 0.37;
const WALL_HEIGHT_M: f64 = 0.3;
/// How far people see the infrared sensor look, as the original's.
const SHARP_MAX_M: f64 = 0.8;
/// What people see around the walls, and of a floor without any.
const ROOM_M: f64 = 0.1;
const EMPTY_M: f64 = 2.0;
const SKY: Colour = colour(200, 210, 220);
/// The chip's own filter of accelerations.
const ACCELERATION_LAG_S: f64 = 0.01;

/// The robot, its world, and how it moves.
pub struct TwoWheels {
    world: World,
    /// The world before anything was moved, and where the robot began.
    begun: (World, Pose),
    pace: Pace,
    time_s: f64,
    rolling: Rolling,
    motors: [Motor; 4],
    battery: Battery,
    touches: bool,
    /// Any side of it touches a wall, and how often that began.
    is_at_wall: bool,
    bumps: u32,
    /// Forward and to the left.
    velocity_mps: [f64; 2],
    rate_rad_s: f64,
    acceleration_mps2: [f64; 2],
}

/// The shipped model of a differential drive with the sizes and ports of this robot.
///
/// # Errors
/// The model does not say what it should.
pub fn two_wheels(start: Pose) -> Result<Rolling, Refusal> {
    let text = models::named(MODEL).map_or("", |found| found.text);
    let model = lang_dcml::understand(text).models.pop();
    let model = model.ok_or(Refusal::NotShipped(MODEL))?;
    let number = |name: &str, number: f64| (name.to_owned(), number);
    let motor = |name: &str, index| {
        let port = Port::Motor(index);
        (name.to_owned(), Actuator { port, factor: 1.0 })
    };
    let said = Overrides {
        params: vec![number("r", WHEEL_RADIUS_M), number("L", TRACK_M)],
        drive: vec![motor("u_l", LEFT), motor("u_r", RIGHT)],
        start: Vec::new(),
    };
    Rolling::new(&model, &said, start)
}

impl TwoWheels {
    /// Two wheels that stand still at `pose`.
    ///
    /// # Panics
    /// The shipped model is not that of this robot, which a test excludes.
    pub fn new(world: World, pose: Pose) -> Self {
        Self::on(world, two_wheels(pose).expect("the shipped model"))
    }

    /// Other wheels below the same body.
    pub fn on(world: World, rolling: Rolling) -> Self {
        Self {
            begun: (world.clone(), rolling.pose()),
            pace: Pace::default(),
            time_s: 0.0,
            world,
            rolling,
            motors: [Motor::default(); 4],
            battery: Battery::default(),
            touches: false,
            is_at_wall: false,
            bumps: 0,
            velocity_mps: [0.0; 2],
            rate_rad_s: 0.0,
            acceleration_mps2: [0.0; 2],
        }
    }

    /// Moves as the wheels do, and out of walls.
    fn roll(&mut self, dt_s: f64, turned_rad: [f64; 4], servos_ns: [u32; 6]) {
        let before = self.rolling.pose();
        self.rolling.roll(dt_s, turned_rad, servos_ns);
        let moved = self.rolling.pose();
        let (at, touched) = self.world.pushed_out(moved.at, RADIUS_M);
        if touched {
            self.rolling.push(at);
        }
        self.bumps += u32::from(touched && !self.is_at_wall);
        self.is_at_wall = touched;
        // The bumper is at the front: a wall behind does not press it.
        let push = at.from(moved.at);
        self.touches = touched && push.dot(Point::towards(moved.heading_rad)) < 0.0;
        if dt_s <= 0.0 {
            return;
        }
        let ahead = Point::towards((before.heading_rad + moved.heading_rad) / 2.0);
        let way = at.from(before.at);
        let velocity_mps = [way.dot(ahead) / dt_s, ahead.cross(way) / dt_s];
        self.rate_rad_s = (moved.heading_rad - before.heading_rad) / dt_s;
        let gained = |axis: usize| (velocity_mps[axis] - self.velocity_mps[axis]) / dt_s;
        let felt = [
            gained(0) - velocity_mps[1] * self.rate_rad_s,
            gained(1) + velocity_mps[0] * self.rate_rad_s,
        ];
        self.velocity_mps = velocity_mps;
        let share = (dt_s / ACCELERATION_LAG_S).min(1.0);
        for (kept, new) in self.acceleration_mps2.iter_mut().zip(felt) {
            *kept += (new - *kept) * share;
        }
    }

    /// The echo that a sensor at this place of the body hears.
    fn echo(&self, forward: f64, left: f64, direction_rad: f64) -> Option<f64> {
        let origin = self.rolling.pose().place(forward, left);
        let ray = |part: i32| {
            let angle =
                self.rolling.pose().heading_rad + direction_rad + BEAM_RAD * f64::from(part) / 2.0;
            self.world.ray(origin, Point::towards(angle))
        };
        let nearest = (-2..=2).filter_map(ray).min_by(f64::total_cmp)?;
        (nearest <= ULTRASONIC_MAX_M).then_some(nearest.max(ULTRASONIC_MIN_M))
    }

    fn light(&self, left: f64) -> f64 {
        let at = self.rolling.pose().place(LIGHT_AHEAD_M, left);
        light_raw(self.world.darkness(at, LIGHT_SPOT_M))
    }

    fn sharp(&self) -> f64 {
        let origin = self.rolling.pose().place(RADIUS_M, 0.0);
        let ahead = Point::towards(self.rolling.pose().heading_rad);
        sharp_gp2_raw(self.world.ray(origin, ahead).unwrap_or(10.0) * 100.0)
    }
}

/// What TRIK's Sharp GP2 gives at a distance in centimetres: the inverse of `8697 / raw - 2`; nearer than 8 cm it falls.
pub fn sharp_gp2_raw(cm: f64) -> f64 {
    if cm >= 8.0 {
        8697.0 / (cm + 2.0)
    } else {
        869.7 * (cm / 8.0).max(0.0)
    }
}

/// What TRIK's light sensor gives: 30 would be pure white and 1023 pure black; paper and tape lie between.
fn light_raw(darkness: f64) -> f64 {
    30.0 + 993.0 * (0.05 + 0.85 * darkness)
}

impl TwoWheels {
    /// One step of the room.
    fn go_on(&mut self, dt_s: f64, drive: &Drive) {
        self.time_s += dt_s;
        let battery_v = self.battery.voltage_v();
        let mut turned_rad = [0.0; 4];
        let mut taken_a = 0.0;
        for (index, motor) in self.motors.iter_mut().enumerate() {
            if self.rolling.has_motor(index) {
                let before = motor.angle_deg;
                taken_a += motor.step(dt_s, drive.motors[index], battery_v);
                turned_rad[index] = (motor.angle_deg - before).to_radians();
            }
        }
        self.battery.step(dt_s, taken_a);
        self.roll(dt_s, turned_rad, drive.servos_ns);
    }

    /// A hand puts it there, and out of walls. It feels no push.
    fn put(&mut self, to: Pose) -> Result<(), BadOrder> {
        let is_within = |[left, bottom, right, top]: [f64; 4]| {
            (left..=right).contains(&to.at.x) && (bottom..=top).contains(&to.at.y)
        };
        if !self.world.bounds().is_none_or(is_within) {
            return Err(BadOrder::Outside);
        }
        let (at, _) = self.world.pushed_out(to.at, RADIUS_M);
        self.rolling.put(Pose { at, ..to });
        self.velocity_mps = [0.0; 2];
        Ok(())
    }

    /// What people see of it, in the order of [`Self::readings`].
    fn shape(&self) -> Shape {
        let sensor = |kind, port: &str, at, degrees, reach_m| Sensor {
            kind,
            port: port.to_owned(),
            at,
            degrees,
            reach_m,
            beam_degrees: if kind == "sonar" {
                2.0 * BEAM_RAD.to_degrees()
            } else {
                0.0
            },
        };
        let light = |port, left| sensor("light", port, point(LIGHT_AHEAD_M, left), 0.0, 0.0);
        let front = point(RADIUS_M, 0.0);
        let wheel = |port: &str, side: f64| Wheel {
            port: port.to_owned(),
            at: point(0.0, side * TRACK_M / 2.0),
            radius_m: WHEEL_RADIUS_M,
        };
        Shape {
            size_m: [2.0 * RADIUS_M; 2],
            is_round: true,
            // A model may have none there.
            wheels: [(LEFT, "M3", 1.0), (RIGHT, "M4", -1.0)]
                .into_iter()
                .filter(|(index, ..)| self.rolling.has_motor(*index))
                .map(|(_, port, side)| wheel(port, side))
                .collect(),
            sensors: vec![
                sensor("infrared", "A1", front, 0.0, SHARP_MAX_M),
                sensor("touch", "A3", front, 0.0, 0.0),
                light("A5", LIGHT_BESIDE_M),
                light("A6", -LIGHT_BESIDE_M),
                sensor("sonar", "D1", front, 0.0, ULTRASONIC_MAX_M),
                sensor("sonar", "D2", point(0.0, RADIUS_M), 90.0, ULTRASONIC_MAX_M),
                sensor("camera", "camera", point(CAMERA_AHEAD_M, 0.0), 0.0, 0.0),
                sensor("lidar", "lidar", Point::default(), 0.0, LIDAR_MAX_M),
            ],
        }
    }

    /// What its sensors see now, as people see it.
    fn readings(&self) -> Vec<Option<f64>> {
        let pose = self.rolling.pose();
        let dark = |left| {
            let at = pose.place(LIGHT_AHEAD_M, left);
            Some(self.world.darkness(at, LIGHT_SPOT_M))
        };
        let ahead = Point::towards(pose.heading_rad);
        let sharp_m = self.world.ray(pose.place(RADIUS_M, 0.0), ahead);
        vec![
            sharp_m.filter(|far| *far <= SHARP_MAX_M),
            Some(f64::from(u8::from(self.touches))),
            dark(LIGHT_BESIDE_M),
            dark(-LIGHT_BESIDE_M),
            self.echo(RADIUS_M, 0.0, 0.0),
            self.echo(0.0, RADIUS_M, FRAC_PI_2),
            None,
            None,
        ]
    }
}

impl Body for TwoWheels {
    fn step(&mut self, dt_s: f64, drive: &Drive) {
        let (steps, dt_s) = self.pace.due(dt_s);
        (0..steps).for_each(|_| self.go_on(dt_s, drive));
    }

    fn weaken_battery(&mut self, volts: f64) {
        self.battery.sag_v = volts;
    }

    fn senses(&self) -> Senses {
        let touch = if self.touches { 20.0 } else { 1000.0 };
        let senses = Senses {
            pose: self.rolling.pose(),
            encoders_deg: self.shafts_deg(),
            analog: [
                Some(self.sharp()),
                None,
                Some(touch),
                None,
                Some(self.light(LIGHT_BESIDE_M)),
                Some(self.light(-LIGHT_BESIDE_M)),
            ],
            ultrasonic_m: [
                self.echo(RADIUS_M, 0.0, 0.0),
                self.echo(0.0, RADIUS_M, FRAC_PI_2),
                None,
            ],
            battery_v: self.battery.voltage_v(),
            acceleration_mps2: [
                self.acceleration_mps2[0],
                self.acceleration_mps2[1],
                GRAVITY_MPS2,
            ],
            rate_dps: [0.0, 0.0, self.rate_rad_s.to_degrees()],
            bumps: self.bumps,
        };
        senses.paused(self.pace.is_paused)
    }

    fn shafts_deg(&self) -> [f64; 4] {
        self.motors.map(|motor| motor.angle_deg)
    }

    fn has_infrared_camera(&self) -> bool {
        true
    }

    fn has_lidar(&self) -> bool {
        true
    }

    fn range_m(&self, clockwise_rad: f64) -> Option<f64> {
        let towards = Point::towards(self.rolling.pose().heading_rad - clockwise_rad);
        let distance = self.world.ray(self.rolling.pose().at, towards)?;
        (distance <= LIDAR_MAX_M).then_some(distance)
    }

    fn order(&mut self, words: &str) -> Result<(), BadOrder> {
        match Order::parse(words)? {
            Order::Pause => self.pace.is_paused = true,
            Order::Go => self.pace.is_paused = false,
            Order::Step(ticks) => self
                .pace
                .order(f64::from(ticks) * f64::from(STEP_MS) / 1000.0),
            Order::Speed(speed) => self.pace.speed = speed,
            Order::Field(_) => return Err(BadOrder::OwnRoom),
            Order::Reset => {
                self.world.put_balls_of(&self.begun.0);
                self.put(self.begun.1)?;
            }
            Order::Robot(pose) => self.put(pose)?,
            Order::Thing(number, at) => {
                if !self.world.put_ball(number, at) {
                    return Err(BadOrder::NoThing(number));
                }
            }
        }
        Ok(())
    }

    fn enter(&mut self, _field: &Field, _locks: Locks) -> Result<(), BadOrder> {
        Err(BadOrder::OwnRoom)
    }

    fn scene(&self) -> Option<Scene> {
        let begin = self.begun.1;
        let [left, bottom, right, top] = self.world.bounds().unwrap_or([
            begin.at.x - EMPTY_M,
            begin.at.y - EMPTY_M,
            begin.at.x + EMPTY_M,
            begin.at.y + EMPTY_M,
        ]);
        Some(Scene {
            bounds: [left - ROOM_M, bottom - ROOM_M, right + ROOM_M, top + ROOM_M],
            floor: world::FLOOR.text(),
            items: self.world.items(),
            things: self.world.things(),
            start: begin,
            robots: vec![self.shape()],
            ..Scene::default()
        })
    }

    fn moving(&self) -> Moving {
        Moving {
            time_s: self.time_s,
            is_paused: self.pace.is_paused,
            speed: self.pace.speed,
            robots: vec![Placed {
                pose: self.rolling.pose(),
                readings: self.readings(),
                rays_m: show::rays(|angle| self.range_m(angle)),
                is_stuck: self.is_at_wall,
                marker: String::new(),
            }],
            things: self
                .world
                .balls()
                .iter()
                .map(|ball| Pose {
                    at: ball.at,
                    heading_rad: 0.0,
                })
                .collect(),
        }
    }

    fn pixel(&self, right: f64, down: f64) -> Option<Colour> {
        let beside = -right * libm::tan(CAMERA_HALF_WIDTH_RAD);
        let below = down * libm::tan(CAMERA_HALF_HEIGHT_RAD);
        let (sin, cos) = libm::sincos(CAMERA_PITCH_RAD);
        let (ahead, sinks) = (cos - below * sin, sin + below * cos);
        let origin = self.rolling.pose().place(CAMERA_AHEAD_M, 0.0);
        let flat = self
            .rolling
            .pose()
            .place(CAMERA_AHEAD_M + ahead, beside)
            .from(origin);
        let length = flat.length();
        let towards = point(flat.x / length, flat.y / length);
        // How much the ray sinks for each metre on the map.
        let slope = sinks / length;
        let floor_m = if slope > 0.0 {
            CAMERA_HEIGHT_M / slope
        } else {
            f64::INFINITY
        };
        let wall = self.world.wall_ahead(origin, towards, floor_m);
        let limit = wall.map_or(floor_m, |(distance, _)| distance);
        for ball in self.world.balls() {
            if sees_ball(origin, towards, slope, ball.at, ball.radius_m, limit) {
                return Some(ball.colour);
            }
        }
        let seen = match wall {
            Some((distance, seen)) if CAMERA_HEIGHT_M - distance * slope < WALL_HEIGHT_M => seen,
            Some(_) => SKY,
            None if floor_m.is_finite() => self.world.floor_colour(origin.moved(towards, floor_m)),
            None => SKY,
        };
        Some(seen)
    }
}

/// Whether a sinking ray from the camera meets a ball on the floor before `limit` metres on the map.
fn sees_ball(
    origin: Point,
    towards: Point,
    slope: f64,
    ball: Point,
    radius: f64,
    limit: f64,
) -> bool {
    let centre = ball.from(origin);
    let along = centre.dot(towards);
    if along <= 0.0 || along - radius > limit {
        return false;
    }
    let height = CAMERA_HEIGHT_M - along * slope - radius;
    libm::hypot(centre.cross(towards), height) <= radius
}

#[cfg(test)]
mod tests;
