//! Which sensors a world model plugs into which ports, and whether the blocks of a project want the same.
//!
//! Owns the rule of the original: before a program starts in the simulator, each block that waits for a sensor is compared
//! with the sensor on its port. An empty port gets the sensor, unless the teacher has locked the sensors; another sensor,
//! or a locked empty port, keeps the program from running. Knows nothing of walls and places.

use std::collections::BTreeMap;

use super::blocks::Does;
use super::ports::{Device, Direction, Kit, Port};
use super::program::{Node, Op, Program};
use super::project::Project;
use super::words;
use lang_text::problem::Problem;
use lang_text::xml;

/// Kinds of sensors that are plugged in, by the last part of their names in world models.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Sensor {
    /// Distance by infrared light.
    Infrared,
    /// Distance by sound.
    Sonar,
    /// Brightness of the floor.
    Light,
    /// A button that touches.
    Touch,
    /// Any other.
    Other,
}

impl Sensor {
    fn named(kind: &str) -> Option<Self> {
        if kind.is_empty() {
            return None;
        }
        Some(match kind.rsplit("::").next().unwrap_or(kind) {
            "TrikInfraredSensor" => Self::Infrared,
            "TrikSonarSensor" => Self::Sonar,
            "TrikLightSensor" => Self::Light,
            "TrikTouchSensor" => Self::Touch,
            _ => Self::Other,
        })
    }
}

/// The sensors of the robot of TRIK in a world model, by port.
pub fn plugged_in(world: &str, kit: Kit) -> BTreeMap<Port, Sensor> {
    let mut sensors = BTreeMap::new();
    let Ok(root) = xml::parse(world) else {
        return sensors;
    };
    let root = match root.name.as_ref() {
        "root" => &root,
        _ => root.child("root").unwrap_or(&root),
    };
    let Some(robots) = root.child("robots") else {
        return sensors;
    };
    let ours = robots.elements().find(|robot| {
        let id = robot.attribute("id").unwrap_or("");
        id.starts_with("trik")
    });
    let Some(list) = ours.and_then(|robot| robot.child("sensors")) else {
        return sensors;
    };
    for sensor in list.elements() {
        let text = sensor.attribute("port").unwrap_or("");
        // A port has exactly four parts; another text is none.
        let parts: Vec<&str> = text.split("###").collect();
        let [name, ..] = parts[..] else {
            continue;
        };
        if parts.len() != 4 {
            continue;
        }
        let kind = Sensor::named(sensor.attribute("type").unwrap_or(""));
        // Names of the first controllers, as JA1, stand beside the present ones and are none of theirs.
        if let (Some(port), Some(kind)) = (Port::find(kit, name, Direction::In), kind) {
            sensors.insert(port, kind);
        }
    }
    sensors
}

/// The sensors that the blocks of a program wait for, by port: what is put onto ports that are empty.
pub fn needed(program: &Program) -> BTreeMap<Port, Sensor> {
    wishes(program)
        .map(|(_, port, sensor)| (port, sensor))
        .collect()
}

/// Sensors that blocks wait for on ports that are empty, in the order of the blocks. The gyroscope is one of them, as
/// [`Sensor::Other`].
pub fn missing(project: &Project, program: &Program) -> Vec<(Port, Sensor)> {
    let world = project.world.as_deref().unwrap_or_default();
    let mut there = plugged_in(world, program.kit);
    let mut missing = Vec::new();
    for (node, op) in (0..).zip(program.ops.iter()) {
        let Op::Watch { watch, .. } = *op else {
            continue;
        };
        let watching = &program.watches[watch as usize];
        let port = watching.port.as_ref().ok().copied();
        let sensor = match port {
            Some(port) if port.device() == Device::Gyroscope => Some(Sensor::Other),
            _ => wanted(program, node),
        };
        if let Some((port, sensor)) = port.zip(sensor)
            && !there.contains_key(&port)
        {
            there.insert(port, sensor);
            missing.push((port, sensor));
        }
    }
    missing
}

/// Each block that waits for a sensor that is plugged in, with its port.
fn wishes(program: &Program) -> impl Iterator<Item = (Node, Port, Sensor)> {
    program.ops.iter().enumerate().filter_map(|(node, op)| {
        let Op::Watch { watch, .. } = *op else {
            return None;
        };
        let node = node as Node;
        let port = program.watches[watch as usize].port.as_ref().ok()?;
        Some((node, *port, wanted(program, node)?))
    })
}

/// The first block that wants another sensor than the world has, as the original tells it.
pub(super) fn mismatch(project: &Project, program: &Program) -> Option<Problem> {
    let mut sensors = plugged_in(project.world.as_deref()?, program.kit);
    let locked = project
        .meta
        .get("twoDModelSensorsReadOnly")
        .is_some_and(|value| value.eq_ignore_ascii_case("true"));
    for (node, port, wanted) in wishes(program) {
        match sensors.get(&port) {
            Some(&there) if there == wanted => {}
            None if !locked => drop(sensors.insert(port, wanted)),
            _ => {
                let mut problem = Problem::error(words::other_sensor(port.name()));
                problem.place = program.place(node);
                return Some(problem);
            }
        }
    }
    None
}

/// The sensor that a block waits for, if it is one that is plugged in.
fn wanted(program: &Program, node: Node) -> Option<Sensor> {
    let row = program.row(node)?;
    let Does::Wait(wait) = row.does else {
        return None;
    };
    Sensor::named(wait.sensor)
}
