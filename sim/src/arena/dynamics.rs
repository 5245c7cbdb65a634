//! Realistic physics: masses, friction and impulses, for robots and what they push.
//!
//! Owns the order of one tick and of the start, and how wheels drive a robot. The solver is crate `box2d-rust`, a Rust
//! version of the original's Box2D that computes its own sines, so a run is the same on every processor. Knows no programs
//! and no rules.
//!
//! Facts are those of the original, found by repeating its recorded runs bit for bit. Each wheel is a body of its own on a
//! hinge that does not turn. In each tick it loses all speed across and gets the impulse that its own mass needs to roll as
//! fast as its motor turns, first the left one, then the right one: so the robot gains speed over some 60 ms, and drifts
//! aside a little on an empty field. A robot whose wheels both stand is stopped dead. The pose of a robot is the sum of
//! what its body has moved, and not the place of the body.
//!
//! The original's solver is of June 2025 and ours a year younger: without contacts both give the same bits, with contacts
//! places differ by some tenths of a pixel after seconds. Tests hold how much.

mod parts;
mod units;

use box2d_rust::body::{
    body_apply_force_to_center, body_apply_linear_impulse_to_center, body_get_linear_velocity,
    body_get_mass, body_get_position, body_get_rotation, body_get_world_vector, body_is_awake,
    body_set_angular_velocity, body_set_linear_velocity, body_set_transform,
};
use box2d_rust::id::BodyId;
use box2d_rust::math_functions::{Pos, Rot, VEC2_ZERO, Vec2, dot, mul_sv, rot_get_angle, sub};
use box2d_rust::types::WorldDef;
use box2d_rust::world::{World, world_set_contact_recycle_distance, world_step};

use lang_diagram::machine::STEP_MS;
use lang_diagram::stand_in::{Motion, Pose, rim_speed};

use self::parts::{Chassis, placed};
use super::robot::Robot;
use crate::field::{Field, Solid, SolidKind};
use crate::geometry::Point;

/// Steps of the solver in one tick.
const STEPS: i32 = 10;
/// Slower collisions do not bounce, in the solver's metres per second.
const BOUNCE_MIN: f32 = 0.05;
/// The push at each change of a wheel's speed.
const PUSH: f32 = 0.1;
/// Speeds that are nearer than this are the same.
const SAME: f64 = 1e-10;
/// The order in which things are made.
const KINDS: [SolidKind; 3] = [SolidKind::Skittle, SolidKind::Ball, SolidKind::Cube];

/// Bodies of a field.
pub(super) struct Dynamics {
    world: World,
    robots: Vec<Driven>,
    /// Bodies of things that can be pushed, as [`Field::solids`] has them.
    pushed: Vec<Option<BodyId>>,
}

/// A robot's bodies, and what is remembered of them.
struct Driven {
    chassis: Chassis,
    /// The last speeds that were asked of the wheels; a stop is not remembered.
    asked: [f64; 2],
    /// Where the last tick has left the robot in the scene: elsewhere means that a hand has put it there.
    left: Pose,
}

impl std::fmt::Debug for Dynamics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (robots, pushed) = (self.robots.len(), self.pushed.len());
        write!(f, "Dynamics of {robots} robots and {pushed} things")
    }
}

impl Dynamics {
    /// All bodies of a field and its robots.
    ///
    /// The first robot is made and taken away twice before everything else, and once after it, as in the original: so its
    /// bodies get the same numbers, which decide what is solved first.
    pub(super) fn new(field: &Field, robots: &[Robot]) -> Self {
        let mut world = World::new(&WorldDef {
            gravity: VEC2_ZERO,
            restitution_threshold: BOUNCE_MIN,
            ..WorldDef::default()
        });
        world_set_contact_recycle_distance(&mut world, 0.0);
        let first = robots.first().map(Robot::description);
        let mut early = None;
        if let Some(robot) = first {
            let origin = Point::default();
            let mut made = Chassis::new(&mut world, robot, origin, 0.0);
            made.add_sensors(&mut world, robot, origin, 0.0, false);
            made.remove(&mut world);
            let made = Chassis::new(&mut world, robot, origin, 0.0);
            made.turn_to(&mut world, 0.0);
            made.turn_to(&mut world, 0.0);
            made.remove(&mut world);
            let made = Chassis::new(&mut world, robot, origin, 0.0);
            made.turn_to(&mut world, 0.0);
            early = Some(made);
        }
        for wall in &field.walls {
            parts::add_wall(&mut world, wall);
        }
        let mut pushed = vec![None; field.solids.len()];
        for kind in KINDS {
            for (body, solid) in pushed.iter_mut().zip(&field.solids) {
                if solid.kind == kind {
                    *body = parts::add_solid(&mut world, solid);
                }
            }
        }
        if let Some(early) = early {
            early.remove(&mut world);
        }
        let robots = robots
            .iter()
            .map(|robot| Driven::new(&mut world, robot))
            .collect();
        for (body, solid) in pushed.iter().zip(&field.solids) {
            if let &Some(body) = body {
                settle(&mut world, body, solid);
            }
        }
        Self {
            world,
            robots,
            pushed,
        }
    }

    /// One tick: what it moves each robot, in their order.
    pub(super) fn tick(&mut self, robots: &mut [Robot]) {
        for (driven, robot) in self.robots.iter_mut().zip(robots.iter()) {
            driven.follow(&mut self.world, robot);
            driven.drive(&mut self.world, robot.chosen);
        }
        let before: Vec<(Pos, Rot)> = self
            .robots
            .iter()
            .map(|driven| self.place(driven.chassis.body))
            .collect();
        world_step(&mut self.world, STEP_MS as f32 / 1000.0, STEPS);
        let moved = self.robots.iter().zip(before).map(|(driven, before)| {
            let now = self.place(driven.chassis.body);
            Motion {
                shift: units::pixels(sub(now.0, before.0)),
                turn: units::turn(before.1, now.1),
            }
        });
        let moved: Vec<Motion> = moved.collect();
        for ((driven, robot), motion) in self.robots.iter_mut().zip(robots).zip(moved) {
            robot.is_stuck = false;
            robot.motion = motion;
            driven.left = Pose {
                x: robot.pose.x + f64::from(motion.shift.0),
                y: robot.pose.y + f64::from(motion.shift.1),
                degrees: robot.pose.degrees + motion.turn,
            };
        }
    }

    fn place(&self, body: BodyId) -> (Pos, Rot) {
        (
            body_get_position(&self.world, body),
            body_get_rotation(&self.world, body),
        )
    }

    /// Reads back where things are that were pushed since the last time.
    pub(super) fn read_back(&self, field: &mut Field, mut moved: impl FnMut(usize, &Solid)) {
        for (index, (body, solid)) in self.pushed.iter().zip(&mut field.solids).enumerate() {
            let &Some(body) = body else {
                continue;
            };
            if !body_is_awake(&self.world, body) {
                continue;
            }
            let (position, rotation) = self.place(body);
            let at = units::scene(position);
            let degrees = units::degrees(rot_get_angle(rotation));
            if at != solid.at || degrees != solid.rotation {
                (solid.at, solid.rotation) = (at, degrees);
                moved(index, solid);
            }
        }
    }
}

/// A thing that does not stand exactly where the solver's 32 bits have it is put there.
fn settle(world: &mut World, body: BodyId, solid: &Solid) {
    if solid.material.mass <= 0.0 {
        return;
    }
    let at = units::scene(body_get_position(world, body));
    if (at.x - solid.at.x).abs() > 1e-12 || (at.y - solid.at.y).abs() > 1e-12 {
        let position = units::vector(at);
        body_set_transform(world, body, position, units::rotation(solid.rotation));
    }
}

impl Driven {
    fn new(world: &mut World, robot: &Robot) -> Self {
        let description = robot.description();
        let (centre, degrees) = placed(robot.pose());
        let mut chassis = Chassis::new(world, description, centre, degrees);
        chassis.turn_to(world, degrees);
        chassis.add_sensors(world, description, centre, degrees, true);
        Self {
            chassis,
            asked: [0.0; 2],
            left: robot.pose(),
        }
    }

    /// Goes where a hand has put the robot: all bodies move by the same, and keep their speed.
    fn follow(&mut self, world: &mut World, robot: &Robot) {
        let pose = robot.pose();
        if pose == self.left {
            return;
        }
        let (old, _) = placed(self.left);
        let (new, _) = placed(pose);
        let shift = units::vector(new.from(old));
        for body in self.chassis.bodies() {
            let from = body_get_position(world, body);
            let rotation = body_get_rotation(world, body);
            let to = Vec2::new(from.x + shift.x, from.y + shift.y);
            body_set_transform(world, body, to, rotation);
        }
        if pose.degrees != self.left.degrees && pose.degrees.is_finite() {
            self.chassis.turn_to(world, pose.degrees);
        }
        self.left = pose;
    }

    /// Gives the wheels what their motors do in a tick.
    fn drive(&mut self, world: &mut World, powers: [i32; 2]) {
        let wanted = powers.map(speed);
        if wanted[0].abs() + wanted[1].abs() < f64::from(f32::EPSILON) {
            stop(world, self.chassis.body);
            for wheel in self.chassis.wheels {
                stop(world, wheel.body);
            }
            return;
        }
        for (side, wanted) in wanted.into_iter().enumerate() {
            let wheel = self.chassis.wheels[side].body;
            let mass = body_get_mass(world, wheel);
            let ahead = body_get_world_vector(world, wheel, Vec2::new(1.0, 0.0));
            let across = body_get_world_vector(world, wheel, Vec2::new(0.0, 1.0));
            if (wanted - self.asked[side]).abs() > f64::from(f32::EPSILON) {
                let push = mul_sv(if wanted > 0.0 { PUSH } else { -PUSH }, ahead);
                body_apply_force_to_center(world, self.chassis.body, push, true);
                self.asked[side] = wanted;
            }
            let slip = dot(across, body_get_linear_velocity(world, wheel));
            let impulse = mul_sv(-mass, mul_sv(slip, across));
            body_apply_linear_impulse_to_center(world, wheel, impulse, true);
            let now = f64::from(dot(ahead, body_get_linear_velocity(world, wheel)));
            if (now - wanted).abs() < SAME {
                continue;
            }
            if (wanted - now).abs() < f64::from(f32::EPSILON) {
                stop(world, wheel);
                continue;
            }
            let impulse = mul_sv((wanted as f32 - now as f32) * mass, ahead);
            body_apply_linear_impulse_to_center(world, wheel, impulse, true);
        }
    }
}

/// The speed of a wheel's rim at a power, in the solver's metres per second.
fn speed(percent: i32) -> f64 {
    f64::from(units::metres(rim_speed(percent))) / (f64::from(STEP_MS) / 1000.0) * 10.0
}

fn stop(world: &mut World, body: BodyId) {
    body_set_linear_velocity(world, body, VEC2_ZERO);
    body_set_angular_velocity(world, body, 0.0);
}

#[cfg(test)]
mod tests;
