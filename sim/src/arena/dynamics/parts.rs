//! Bodies of the solver: a robot with its wheels and sensors, walls, and things that are pushed.
//!
//! Owns their shapes, masses and joints, and the order in which they are made, which gives them their numbers. Knows no
//! time.
//!
//! Facts are those of the original (see `dynamics`). Its solver is older than ours in two points that are set from here:
//! joints have no damping of their own, and the inertia of a polygon is summed about the origin of its body.

use crate::limits;
use box2d_rust::body::{
    body_get_joints, body_get_local_center, body_get_local_point, body_get_position,
    body_get_transform, body_get_world_center, body_get_world_point, body_set_mass_data,
    body_set_transform, create_body, destroy_body,
};
use box2d_rust::collision::{Circle, MassData, Polygon};
use box2d_rust::geometry::make_polygon;
use box2d_rust::hull::compute_hull;
use box2d_rust::id::{BodyId, JointId};
use box2d_rust::joint::{
    create_filter_joint, create_revolute_joint, create_weld_joint, destroy_joint,
    joint_get_local_frame_b,
};
use box2d_rust::math_functions::{
    Pos, ROT_IDENTITY, Rot, Transform, VEC2_ZERO, Vec2, add, cross, dot, mul_add, mul_sv, sub,
    transform_point,
};
use box2d_rust::shape::{create_circle_shape, create_polygon_shape};
use box2d_rust::types::{
    BodyDef, BodyType, FilterJointDef, JointDef, RevoluteJointDef, ShapeDef, WeldJointDef,
};
use box2d_rust::world::World;

use lang_diagram::stand_in::Pose;

use super::units::{metres, rotation, square_metres, vector};
use crate::arena::robot::body_of as body_of_sensor;
use crate::arena::solids;
use crate::field::{self, Material, ROBOT_SIZE, Sensor, Solid, SolidKind, Wall};
use crate::geometry::{Point, point};

/// The robot's body in a box of 50 by 50.
const BODY: [(f64, f64); 6] = [
    (1.0, 10.0),
    (47.0, 10.0),
    (49.0, 20.0),
    (49.0, 30.0),
    (47.0, 40.0),
    (1.0, 40.0),
];
/// Middles of the left and the right wheel there.
const WHEELS: [(f64, f64); 2] = [(10.0, 3.0), (10.0, 47.0)];
/// Diameter of a wheel there.
const WHEEL: f64 = 16.0;
/// Across that box.
const BOX: f64 = 50.0;
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
/// What a sensor runs into things with, whatever it is.
const SENSOR_RADIUS: f64 = 7.5;
const SENSOR: Material = Material {
    mass: 0.01,
    friction: 0.0,
    restitution: 0.8,
    angular_damping: 0.0,
    linear_damping: 0.0,
};
/// Where every sensor is made, before it goes to its place.
const SENSOR_AT: Point = Point { x: 75.0, y: 25.0 };
/// By how much the outline of a thing is within what is drawn of it.
const MARGIN: f64 = 1.0;

/// A robot's bodies.
pub(super) struct Chassis {
    /// The robot without its wheels.
    pub body: BodyId,
    /// Left and right.
    pub wheels: [Wheel; 2],
    /// In the order of the field.
    pub sensors: Vec<BodyId>,
}

/// A wheel and what holds it.
#[derive(Clone, Copy)]
pub(super) struct Wheel {
    pub body: BodyId,
    joint: JointId,
}

/// A number of a save within what the solver can bear.
fn sane(value: f64, least: f64, most: f64) -> f64 {
    if value.is_nan() {
        least
    } else {
        value.clamp(least, most)
    }
}

fn is_place(at: Point) -> bool {
    at.x.abs() <= limits::PLACE_MAX && at.y.abs() <= limits::PLACE_MAX
}

fn shape_of(material: &Material, density: f32) -> ShapeDef {
    let mut shape = ShapeDef::default();
    shape.material.friction = sane(material.friction, 0.0, limits::MATERIAL_MAX) as f32;
    shape.material.restitution = sane(material.restitution, 0.0, 1.0) as f32;
    shape.density = density;
    shape
}

fn body_of(material: &Material, position: Pos, rotation: Rot) -> BodyDef {
    BodyDef {
        type_: if material.mass > 0.0 {
            BodyType::Dynamic
        } else {
            BodyType::Static
        },
        position,
        rotation,
        linear_damping: sane(material.linear_damping, 0.0, limits::MATERIAL_MAX) as f32,
        angular_damping: sane(material.angular_damping, 0.0, limits::MATERIAL_MAX) as f32,
        ..BodyDef::default()
    }
}

/// The mass of what can be pushed, in kilograms.
pub(super) fn mass(material: &Material) -> f32 {
    sane(material.mass, limits::MASS_MIN, limits::MATERIAL_MAX) as f32
}

/// Twice the area of a closed figure halved: in square pixels, whichever way round it goes.
fn area(corners: &[Point]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let twice: f64 = corners
        .iter()
        .zip(next)
        .map(|(one, two)| one.cross(*two))
        .sum();
    (twice / 2.0).abs()
}

/// Adds a polygon to a body; `weighed` has the area whose weight the mass is. Nothing for one without an area.
fn add_polygon(
    world: &mut World,
    body: BodyId,
    corners: &[Point],
    material: &Material,
    weighed: f64,
) -> Option<()> {
    if !weighed.is_finite() || weighed < limits::AREA_MIN || area(corners) < limits::AREA_MIN {
        return None;
    }
    let points: Vec<Vec2> = corners.iter().map(|&corner| vector(corner)).collect();
    let hull = compute_hull(&points);
    if hull.count < 3 {
        return None;
    }
    let polygon = make_polygon(&hull, 0.0);
    let density = mass(material) / square_metres(weighed);
    create_polygon_shape(world, body, &shape_of(material, density), &polygon);
    if material.mass > 0.0 {
        body_set_mass_data(world, body, older_mass(&polygon, density));
    }
    Some(())
}

/// Mass, centre and inertia of a body of one polygon, as Box2D computed them before May 2026: triangles from the first
/// corner, the inertia summed about the body's origin and then moved to the centre.
fn older_mass(polygon: &Polygon, density: f32) -> MassData {
    const THIRD: f32 = 1.0 / 3.0;
    let count = usize::try_from(polygon.count).unwrap_or(0);
    let corners = &polygon.vertices[..count];
    let origin = corners[0];
    let (mut centre, mut area, mut inertia) = (VEC2_ZERO, 0.0_f32, 0.0_f32);
    for pair in corners[1..].windows(2) {
        let (one, two) = (sub(pair[0], origin), sub(pair[1], origin));
        let twice = cross(one, two);
        area += 0.5 * twice;
        centre = mul_add(centre, 0.5 * twice * THIRD, add(one, two));
        let along = one.x * one.x + two.x * one.x + two.x * two.x;
        let across = one.y * one.y + two.y * one.y + two.y * two.y;
        inertia += (0.25 * THIRD * twice) * (along + across);
    }
    let mass = density * area;
    let from_first = mul_sv(1.0 / area, centre);
    let from_origin = add(origin, from_first);
    let mut inertia = density * inertia;
    inertia += mass * (dot(from_origin, from_origin) - dot(from_first, from_first));
    let center = mul_sv(1.0 / mass, mul_sv(mass, from_origin));
    MassData {
        mass,
        center,
        rotational_inertia: (inertia - mass * dot(center, center)).max(0.0),
    }
}

/// Adds a circle to a body.
fn add_circle(world: &mut World, body: BodyId, radius_px: f64, material: &Material) {
    let radius = metres(radius_px);
    let area = std::f32::consts::PI * radius * radius;
    let shape = shape_of(material, mass(material) / area);
    let circle = Circle {
        center: VEC2_ZERO,
        radius,
    };
    create_circle_shape(world, body, &shape, &circle);
}

/// A wall stands for ever.
pub(super) fn add_wall(world: &mut World, wall: &Wall) {
    let stands = Material {
        mass: 0.0,
        ..wall.material
    };
    let corners = solids::wall(wall);
    if !corners.iter().all(|&corner| is_place(corner)) {
        return;
    }
    let middle = |of: fn(&Point) -> f64| {
        let low = corners.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = corners.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        f64::midpoint(low, high)
    };
    let middle = point(middle(|at| at.x), middle(|at| at.y));
    let corners = corners.map(|corner| corner.from(middle));
    let body = create_body(world, &body_of(&stands, vector(middle), ROT_IDENTITY));
    if add_polygon(world, body, &corners, &stands, area(&corners)).is_none() {
        destroy_body(world, body);
    }
}

/// A ball, a skittle or a cube; nothing if it is not whole.
pub(super) fn add_solid(world: &mut World, solid: &Solid) -> Option<BodyId> {
    let half = solid.size / 2.0 - MARGIN;
    let is_whole = half > 0.0 && half <= limits::PLACE_MAX && solid.rotation.is_finite();
    if !is_whole || !is_place(solid.at) {
        return None;
    }
    let position = vector(solid.at);
    let body = create_body(
        world,
        &body_of(&solid.material, position, rotation(solid.rotation)),
    );
    match solid.kind {
        SolidKind::Cube => {
            let corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
                .map(|(x, y)| point(x, y));
            add_polygon(world, body, &corners, &solid.material, area(&corners));
        }
        SolidKind::Ball | SolidKind::Skittle => {
            add_circle(world, body, half, &solid.material);
        }
    }
    Some(body)
}

/// Joints of the original have no damping of their own.
fn joint(a: BodyId, b: BodyId) -> JointDef {
    let mut joint = FilterJointDef::default().base;
    (joint.body_id_a, joint.body_id_b) = (a, b);
    joint.constraint_damping_ratio = 0.0;
    joint
}

/// A place of a body as an unturned frame.
fn frame(p: Vec2) -> Transform {
    Transform { p, q: ROT_IDENTITY }
}

impl Chassis {
    /// The body and both wheels, without sensors.
    pub(super) fn new(
        world: &mut World,
        robot: &field::Robot,
        centre: Point,
        degrees: f64,
    ) -> Self {
        let scale = ROBOT_SIZE / BOX;
        let material = Material {
            mass: f64::from(mass(&robot.material)),
            ..robot.material
        };
        let turned = rotation(degrees);
        let body = create_body(world, &body_of(&material, vector(centre), turned));
        // The middle of the outline is taken, not that of the robot.
        let corners = BODY.map(|(x, y)| point((x - 25.0) * scale, (y - 25.0) * scale));
        add_polygon(world, body, &corners, &material, area(&corners));
        let wheels = WHEELS.map(|(x, y)| {
            let (x, y) = (x / BOX * ROBOT_SIZE, y / BOX * ROBOT_SIZE);
            let at = point(x - ROBOT_SIZE / 2.0, y - ROBOT_SIZE / 2.0);
            Wheel::new(world, body, &robot.wheels, vector(at), turned)
        });
        Self {
            body,
            wheels,
            sensors: Vec::new(),
        }
    }

    /// Takes all bodies away: the robot, sensors from the last on, the left and the right wheel.
    pub(super) fn remove(self, world: &mut World) {
        destroy_body(world, self.body);
        for sensor in self.sensors.into_iter().rev() {
            destroy_body(world, sensor);
        }
        for wheel in self.wheels {
            destroy_body(world, wheel.body);
        }
    }

    /// Turns the robot; each wheel goes to where its joint is on it.
    pub(super) fn turn_to(&self, world: &mut World, degrees: f64) {
        let turned = rotation(degrees);
        let position = body_get_position(world, self.body);
        body_set_transform(world, self.body, position, turned);
        for wheel in self.wheels {
            let anchor = joint_get_local_frame_b(world, wheel.joint).p;
            let position = body_get_world_point(world, self.body, anchor);
            body_set_transform(world, wheel.body, position, turned);
        }
    }

    /// Adds the sensors of a robot whose centre is there: each is made at one place, and goes to its own from there.
    pub(super) fn add_sensors(
        &mut self,
        world: &mut World,
        robot: &field::Robot,
        centre: Point,
        degrees: f64,
        is_placed: bool,
    ) {
        let is_body = |sensor: &&Sensor| body_of_sensor(sensor).is_some() && is_place(sensor.at);
        for sensor in robot.sensors.iter().filter(is_body) {
            let body = self.sensor_body(world, centre, degrees);
            self.sensors.push(body);
            if is_placed && sensor.at != SENSOR_AT {
                self.move_sensor(world, body, sensor.at, centre, degrees);
            }
        }
    }

    fn sensor_body(&self, world: &mut World, centre: Point, degrees: f64) -> BodyId {
        let at = sensor_at(SENSOR_AT, centre, degrees);
        let body = create_body(world, &body_of(&SENSOR, vector(at), rotation(degrees)));
        add_circle(world, body, SENSOR_RADIUS, &SENSOR);
        let others = self.wheels.iter().map(|wheel| wheel.body);
        for other in others.chain(self.sensors.iter().rev().copied()) {
            let base = joint(body, other);
            let filter = FilterJointDef {
                base,
                ..FilterJointDef::default()
            };
            create_filter_joint(world, &filter);
        }
        self.weld(world, body);
        body
    }

    /// Holds a sensor where it is.
    fn weld(&self, world: &mut World, sensor: BodyId) -> JointId {
        let centre = body_get_world_center(world, self.body);
        let base = JointDef {
            local_frame_a: frame(body_get_local_center(world, self.body)),
            local_frame_b: frame(body_get_local_point(world, sensor, centre)),
            ..joint(self.body, sensor)
        };
        let weld = WeldJointDef {
            base,
            linear_damping_ratio: 1.0,
            angular_damping_ratio: 1.0,
            ..WeldJointDef::default()
        };
        create_weld_joint(world, &weld)
    }

    fn move_sensor(&self, world: &mut World, body: BodyId, at: Point, centre: Point, degrees: f64) {
        let joints = body_get_joints(world, body, self.sensors.len() + 3);
        // The weld was made last, so it is the first.
        if let Some(&weld) = joints.first() {
            destroy_joint(world, weld, false);
        }
        let at = vector(sensor_at(at, centre, degrees));
        body_set_transform(world, body, at, rotation(degrees));
        self.weld(world, body);
    }

    /// All bodies, the robot's first.
    pub(super) fn bodies(&self) -> impl Iterator<Item = BodyId> {
        let wheels = self.wheels.iter().map(|wheel| wheel.body);
        std::iter::once(self.body)
            .chain(wheels)
            .chain(self.sensors.iter().copied())
    }
}

/// Where a sensor's body is, with the half pixel that the original's drawing of it is off.
fn sensor_at(at: Point, centre: Point, degrees: f64) -> Point {
    let half = ROBOT_SIZE / 2.0;
    let (sine, cosine) = libm::sincos(degrees.to_radians());
    let (x, y) = (at.x - half, at.y - half);
    point(
        centre.x + x * cosine - y * sine - 0.5,
        centre.y + x * sine + y * cosine - 0.5,
    )
}

impl Wheel {
    /// A wheel at a place of the robot, held by a hinge that does not turn.
    fn new(world: &mut World, robot: BodyId, material: &Material, at: Vec2, turned: Rot) -> Self {
        let material = Material {
            mass: f64::from(mass(material)),
            linear_damping: 0.0,
            angular_damping: 0.0,
            ..*material
        };
        let length = WHEEL / BOX * ROBOT_SIZE;
        let width = length / 2.0;
        let position = transform_point(body_get_transform(world, robot), at);
        let body = create_body(world, &body_of(&material, position, turned));
        let corners = WHEEL_CORNERS.map(|(along, across)| {
            let (x, y) = (along * length, across * width);
            point(x - length / 2.0, y - width / 2.0)
        });
        add_polygon(world, body, &corners, &material, length * width);
        let pivot = body_get_world_center(world, body);
        let base = JointDef {
            local_frame_a: frame(body_get_local_center(world, body)),
            local_frame_b: frame(body_get_local_point(world, robot, pivot)),
            collide_connected: false,
            ..joint(body, robot)
        };
        let hinge = RevoluteJointDef {
            base,
            enable_limit: true,
            lower_angle: 0.0,
            upper_angle: 0.0,
            ..RevoluteJointDef::default()
        };
        let joint = create_revolute_joint(world, &hinge);
        Self { body, joint }
    }
}

/// The pose of a robot as its centre and degrees, within what the solver can bear.
pub(super) fn placed(pose: Pose) -> (Point, f64) {
    let half = ROBOT_SIZE / 2.0;
    let degrees = if pose.degrees.is_finite() {
        pose.degrees
    } else {
        0.0
    };
    (
        point(
            sane(pose.x + half, -limits::PLACE_MAX, limits::PLACE_MAX),
            sane(pose.y + half, -limits::PLACE_MAX, limits::PLACE_MAX),
        ),
        degrees,
    )
}
