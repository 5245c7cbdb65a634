//! Realistic physics: masses, friction and impulses, for robots and what they push.
//!
//! Owns the bodies of a field and how wheels drive one. The solver is that of crate `rapier2d-f64`, which follows the same
//! paper as the original's Box2D 3; its unit is the original's, so its tolerances are the same. Numbers are near those of
//! the original and not equal; tests hold how near. Knows no programs and no sensors.
//!
//! Facts are those of the original. A wheel is welded to the robot; in each tick it loses all speed across and
//! gets the impulse that its own mass needs to roll as fast as its motor turns, so the robot gains speed over some 60 ms.
//! A robot whose wheels both stand is stopped dead. Wheels and body are one body here: the original's joints are without
//! play. A small push at each change of speed is left out; it is below 0.01 pixels a second.

use rapier2d_f64::prelude::{
    CoefficientCombineRule, ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
    Vector,
};

use lang_diagram::machine::STEP_MS;
use lang_diagram::stand_in::{Motion, PIXELS_IN_CM, Pose, rim_speed};

use super::robot::Robot;
use super::solids;
use crate::field::{Field, Material, ROBOT_SIZE, Sensor, Solid, SolidKind};
use crate::geometry::{Point, point};

/// Units of the solver in a pixel.
const SCALE: f64 = 10.0 / PIXELS_IN_CM;
/// Steps of the solver in one tick.
const STEPS: usize = 10;
/// The robot's body from its upper left corner.
const BODY: [(f64, f64); 6] = [
    (1.0, 10.0),
    (47.0, 10.0),
    (49.0, 20.0),
    (49.0, 30.0),
    (47.0, 40.0),
    (1.0, 40.0),
];
/// Left and right wheel from there.
const WHEELS: [(f64, f64); 2] = [(10.0, 3.0), (10.0, 47.0)];
/// Length and width of a wheel.
const WHEEL: (f64, f64) = (16.0, 8.0);
/// Parts of length and width at which the corners of a wheel are.
const WHEEL_CORNERS: [(f64, f64); 8] = [
    (0.2, 1.0),
    (0.8, 1.0),
    (1.0, 0.6),
    (1.0, 0.4),
    (0.8, 0.0),
    (0.2, 0.0),
    (0.0, 0.4),
    (0.0, 0.6),
];
/// The original takes the density of a wheel from the rectangle around it, so without its corners it is lighter.
const WHEEL_SHARE: f64 = 0.84;
/// Radius of what a sensor runs into things with.
const SENSOR_RADIUS: f64 = 5.0;
/// Largest of what materials have, and least mass of what can be pushed.
const MATERIAL_MAX: f64 = 1e4;
const MASS_MIN: f64 = 1e-6;

/// Bodies of a field.
pub(super) struct Dynamics {
    world: PhysicsWorld,
    robots: Vec<Driven>,
    /// Bodies of things that can be pushed, as [`Field::solids`] has them.
    pushed: Vec<Option<RigidBodyHandle>>,
}

/// A robot's body.
struct Driven {
    body: RigidBodyHandle,
    /// Where the last tick has left it.
    left: Pose,
    wheel_mass: f64,
}

impl std::fmt::Debug for Dynamics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (robots, pushed) = (self.robots.len(), self.pushed.len());
        write!(f, "Dynamics of {robots} robots and {pushed} things")
    }
}

fn vector(at: Point) -> Vector {
    Vector::new(at.x * SCALE, at.y * SCALE)
}

fn scene(at: Vector) -> Point {
    point(at.x / SCALE, at.y / SCALE)
}

/// A body of a material; one without mass stands for ever.
fn body(material: &Material, at: Point, degrees: f64) -> RigidBodyBuilder {
    let body = if material.mass > 0.0 {
        RigidBodyBuilder::dynamic()
    } else {
        RigidBodyBuilder::fixed()
    };
    body.translation(vector(at))
        .rotation(degrees.to_radians())
        .linear_damping(material.linear_damping.clamp(0.0, MATERIAL_MAX))
        .angular_damping(material.angular_damping.clamp(0.0, MATERIAL_MAX))
}

fn of_material(collider: ColliderBuilder, material: &Material) -> ColliderBuilder {
    collider
        .mass(material.mass.clamp(MASS_MIN, MATERIAL_MAX))
        .friction(material.friction.clamp(0.0, MATERIAL_MAX))
        .restitution(material.restitution.clamp(0.0, 1.0))
        .friction_combine_rule(CoefficientCombineRule::GeometricMean)
        .restitution_combine_rule(CoefficientCombineRule::Max)
}

fn hull(corners: impl IntoIterator<Item = Point>) -> Option<ColliderBuilder> {
    let corners: Vec<Vector> = corners.into_iter().map(vector).collect();
    ColliderBuilder::convex_hull(&corners)
}

/// A point of the robot from its centre.
fn from_centre((x, y): (f64, f64)) -> Point {
    point(x - ROBOT_SIZE / 2.0, y - ROBOT_SIZE / 2.0)
}

fn centre(pose: Pose) -> Point {
    point(pose.x + ROBOT_SIZE / 2.0, pose.y + ROBOT_SIZE / 2.0)
}

impl Dynamics {
    /// All bodies of a field and its robots.
    pub(super) fn new(field: &Field, robots: &[Robot]) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0);
        world.integration_parameters.dt = f64::from(STEP_MS) / 1000.0;
        world.integration_parameters.num_solver_iterations = STEPS;
        let mut dynamics = Self {
            world,
            robots: Vec::new(),
            pushed: Vec::new(),
        };
        for wall in &field.walls {
            // Corners around the middle: small numbers in shapes.
            let corners = solids::wall(wall);
            let middle = point(
                f64::midpoint(wall.begin.x, wall.end.x),
                f64::midpoint(wall.begin.y, wall.end.y),
            );
            if let Some(shape) = hull(corners.map(|corner| corner.from(middle))) {
                let stands = Material {
                    mass: 0.0,
                    ..wall.material
                };
                let shape = of_material(shape, &stands);
                dynamics.world.insert(body(&stands, middle, 0.0), shape);
            }
        }
        dynamics.pushed = field
            .solids
            .iter()
            .map(|solid| dynamics.add_solid(solid))
            .collect();
        for robot in robots {
            dynamics.add_robot(robot);
        }
        dynamics
    }

    fn add_solid(&mut self, solid: &Solid) -> Option<RigidBodyHandle> {
        let half = solid.size / 2.0;
        if half <= 0.0 || !half.is_finite() {
            return None;
        }
        let shape = match solid.kind {
            SolidKind::Cube => ColliderBuilder::cuboid(half * SCALE, half * SCALE),
            SolidKind::Ball | SolidKind::Skittle => ColliderBuilder::ball(half * SCALE),
        };
        let shape = of_material(shape, &solid.material);
        let body = body(&solid.material, solid.at, solid.rotation);
        Some(self.world.insert(body, shape).0)
    }

    fn add_robot(&mut self, robot: &Robot) {
        let placed = robot.description();
        let pose = robot.pose();
        let wheel = &placed.wheels;
        let wheel_mass = wheel.mass.clamp(MASS_MIN, MATERIAL_MAX) * WHEEL_SHARE;
        // Only the body of the original is damped, its wheels are not.
        let mass = placed.material.mass.clamp(MASS_MIN, MATERIAL_MAX);
        let share = mass / (mass + 2.0 * wheel_mass);
        let material = Material {
            mass,
            linear_damping: placed.material.linear_damping * share,
            angular_damping: placed.material.angular_damping * share,
            ..placed.material
        };
        let builder = body(&material, centre(pose), pose.degrees).can_sleep(false);
        let body = self.world.insert_body(builder);
        let mut shapes = Vec::new();
        shapes.extend(hull(BODY.map(from_centre)).map(|shape| of_material(shape, &material)));
        for middle in WHEELS {
            let corners = WHEEL_CORNERS.map(|(along, across)| {
                let x = middle.0 + (along - 0.5) * WHEEL.0;
                from_centre((x, middle.1 + (across - 0.5) * WHEEL.1))
            });
            let shape = hull(corners).map(|shape| of_material(shape, wheel).mass(wheel_mass));
            shapes.extend(shape);
        }
        let is_body = |sensor: &&Sensor| super::robot::body_of(sensor).is_some();
        for sensor in placed.sensors.iter().filter(is_body) {
            let at = from_centre((sensor.at.x, sensor.at.y));
            let ball = ColliderBuilder::ball(SENSOR_RADIUS * SCALE).translation(vector(at));
            shapes.push(of_material(ball, &material).mass(0.0));
        }
        for shape in shapes {
            self.world.insert_collider(shape, Some(body));
        }
        self.robots.push(Driven {
            body,
            left: pose,
            wheel_mass,
        });
    }

    /// One tick: what it moves each robot, in their order, and new places of things that were pushed.
    pub(super) fn tick(
        &mut self,
        robots: &mut [Robot],
        field: &mut Field,
        mut moved: impl FnMut(usize, &Solid),
    ) {
        for (driven, robot) in self.robots.iter_mut().zip(robots.iter()) {
            drive(&mut self.world, driven, robot);
        }
        self.world.step();
        for (driven, robot) in self.robots.iter_mut().zip(robots) {
            let Some(body) = self.world.bodies.get(driven.body) else {
                continue;
            };
            let at = scene(body.translation());
            let old = centre(driven.left);
            let turn = body.rotation().angle().to_degrees() - driven.left.degrees;
            let turn = turn - 360.0 * (turn / 360.0).round();
            robot.is_stuck = false;
            robot.motion = Motion {
                shift: ((at.x - old.x) as f32, (at.y - old.y) as f32),
                turn,
            };
            driven.left = Pose {
                x: robot.pose.x + f64::from(robot.motion.shift.0),
                y: robot.pose.y + f64::from(robot.motion.shift.1),
                degrees: robot.pose.degrees + turn,
            };
        }
        for (index, handle) in self.pushed.iter().enumerate() {
            let body = handle.and_then(|handle| self.world.bodies.get(handle));
            let (Some(body), Some(solid)) = (body, field.solids.get_mut(index)) else {
                continue;
            };
            if body.is_sleeping() || !body.is_dynamic() {
                continue;
            }
            let (at, degrees) = (
                scene(body.translation()),
                body.rotation().angle().to_degrees(),
            );
            if at != solid.at || degrees != solid.rotation {
                (solid.at, solid.rotation) = (at, degrees);
                moved(index, solid);
            }
        }
    }
}

/// Gives a robot's body what its wheels do in a tick.
fn drive(world: &mut PhysicsWorld, driven: &mut Driven, robot: &Robot) {
    let Some(body) = world.bodies.get_mut(driven.body) else {
        return;
    };
    let pose = robot.pose();
    // Places of the scene pass through 32 bits; who is farther off was put there by hand.
    let off = (pose.x - driven.left.x).abs() + (pose.y - driven.left.y).abs();
    if off > 1e-3 || (pose.degrees - driven.left.degrees).abs() > 1e-3 {
        body.set_translation(vector(centre(pose)), true);
        body.set_rotation(
            rapier2d_f64::prelude::Rotation::new(pose.degrees.to_radians()),
            true,
        );
        body.set_linvel(Vector::new(0.0, 0.0), true);
        body.set_angvel(0.0, true);
        driven.left = pose;
    }
    if robot.chosen == [0, 0] {
        body.set_linvel(Vector::new(0.0, 0.0), true);
        body.set_angvel(0.0, true);
        return;
    }
    let (sine, cosine) = body.rotation().angle().sin_cos();
    let (ahead, across) = (Vector::new(cosine, sine), Vector::new(-sine, cosine));
    // Both wheels are looked at before either pushes.
    let pushes: [(Vector, Vector); 2] = std::array::from_fn(|side| {
        let place = from_centre(WHEELS[side]);
        let place = body.translation() + (ahead * place.x + across * place.y) * SCALE;
        let speed = body.velocity_at_point(place);
        let wanted = rim_speed(robot.chosen[side]) * 1000.0 * SCALE;
        let change = ahead * (wanted - speed.dot(ahead)) - across * speed.dot(across);
        (change * driven.wheel_mass, place)
    });
    for (impulse, place) in pushes {
        body.apply_impulse_at_point(impulse, place, true);
    }
}

#[cfg(test)]
mod tests;
