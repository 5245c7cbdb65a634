//! What moves in a world of TRIK Studio, for people: robots with what their sensors have said, and things.
//!
//! Owns what a reading looks like to people. Reads nothing anew: one reading more would draw from the noise of sensors, and
//! change a run.

use super::field::{PIXELS_IN_M, place, sensor};
use super::{Moving, Placed, rays};
use crate::arena::{Arena, Robot, Solids, ranges, screen};
use crate::field::{Sensor, SensorKind, Solid};
use crate::geometry::Pose;

/// What a light sensor of the original says of black; of white it says 0.
pub const LIGHT_WHOLE: f64 = 99.0;

/// Everything that moves; time runs as fast as the clock.
pub fn moving(arena: &Arena) -> Moving {
    let robots = arena.robots().iter();
    Moving {
        time_s: f64::from(arena.now()) / 1000.0,
        is_paused: false,
        speed: 1.0,
        robots: robots.map(|robot| placed(robot, arena.solids())).collect(),
        things: arena.field().solids.iter().map(thing).collect(),
    }
}

/// Where the centre of a robot is.
pub fn pose(robot: &Robot) -> Pose {
    let at = place(robot.centre());
    Pose::new(at.x, at.y, -robot.pose().degrees.to_radians())
}

/// How far the lidar of a robot sees at an angle clockwise from ahead.
pub fn range_m(robot: &Robot, solids: &Solids, clockwise_rad: f64) -> Option<f64> {
    let (at, degrees) = robot.sensor_pose(robot.sensor_of(SensorKind::Lidar)?);
    let px = ranges::ray(solids, at, degrees + clockwise_rad.to_degrees())?;
    Some(px / PIXELS_IN_M)
}

fn thing(solid: &Solid) -> Pose {
    let at = place(solid.at);
    Pose::new(at.x, at.y, -solid.rotation.to_radians())
}

fn placed(robot: &Robot, solids: &Solids) -> Placed {
    let description = robot.description();
    let readings = |one: &Sensor| sensor(description, one).map(|_| reading(robot, one));
    let marker = robot.marker();
    Placed {
        pose: pose(robot),
        readings: description.sensors.iter().filter_map(readings).collect(),
        rays_m: match robot.sensor_of(SensorKind::Lidar) {
            Some(_) => rays(|angle| range_m(robot, solids, angle)),
            None => Vec::new(),
        },
        is_stuck: robot.is_stuck(),
        marker: match marker.is_down {
            true => screen::hex(screen::named(&marker.colour)),
            false => String::new(),
        },
    }
}

/// What a sensor that people see has said last.
fn reading(robot: &Robot, sensor: &Sensor) -> Option<f64> {
    let port = sensor.port?;
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
