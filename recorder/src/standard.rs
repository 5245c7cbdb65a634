//! Nodes of a tree as messages that other people's tools know, beside the messages of the nodes themselves.
//!
//! Owns the topics of one recording, and which messages are made of several nodes. What does not fit gives no message: a unit
//! that is not known, a number that cannot be. Which node is which message is told by `rows`. Knows no ports.

mod gather;
mod make;
mod pose;
pub(crate) mod rows;
mod units;

use crate::entry::Known;
use crate::limits::IMU_APART_NS;
use gather::Gathered;
use journal::error::Error;
use journal::layout::{Layout, Number};
use journal::standard::robot::{
    BatteryState, CompressedImage, Imu, JointState, Joy, LaserScan, Message, Odometry, Range,
    Transforms,
};
use journal::write::{Id, Topic, Writer};
use pose::{Place, Track};
use rows::Role;
pub use rows::place_units;
use std::collections::HashMap;
use std::io::{Seek, Write};
use std::sync::Arc;

/// What the topics here begin with.
const PREFIX: &str = "/ros/";
/// The topic of all transforms, by the name that tools know.
const TRANSFORMS: &str = "/tf";

/// Topics with messages of one type, by their names. A recording has each from its first message on.
struct Sinks<M>(HashMap<String, Topic<M>>);

impl<M> Default for Sinks<M> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<M: Message> Sinks<M> {
    fn publish<W: Write + Seek>(
        &mut self,
        file: &mut Writer<W>,
        name: &str,
        unix_ns: u64,
        message: &M,
    ) -> Result<(), Error> {
        let topic = match self.0.get_mut(name) {
            Some(topic) => topic,
            None => {
                let topic = file.topic(name)?;
                self.0.entry(name.to_owned()).or_insert(topic)
            }
        };
        file.publish(topic, unix_ns, message)
    }
}

/// A node that is a standard message, or a part of one.
struct Part {
    path: String,
    /// It in the recording, which has the form of its tuples.
    id: Id,
    role: Role,
    /// The numbers that bring it to rest; empty for what needs none.
    rest: Vec<f64>,
}

impl Part {
    /// The group of the node, with a `/` after it; empty for a node of the root.
    fn group(&self) -> &str {
        self.path.rfind('/').map_or("", |end| &self.path[..=end])
    }

    fn topic(&self) -> String {
        format!("{PREFIX}{}", self.path)
    }

    /// It is at rest by numbers that are no measure: a servo that is off.
    fn is_off(&self, numbers: &[f64]) -> bool {
        self.rest == numbers && self.rest.iter().any(|number| *number != 0.0)
    }

    /// The numbers of a tuple; None if one of them is none.
    fn numbers<W: Write + Seek>(&self, file: &Writer<W>, tuple: &[u8]) -> Option<Vec<f64>> {
        let numbers = file.layout(self.id).numbers(tuple);
        let numbers: Vec<f64> = numbers.into_iter().map(Number::to_f64).collect();
        let are_good = !numbers.is_empty() && numbers.iter().all(|number| number.is_finite());
        are_good.then_some(numbers)
    }
}

/// The two sensors of one `Imu`.
#[derive(Default)]
struct Halves {
    /// Those that are known: with two of a kind nobody knows which belong together.
    turning: Vec<u32>,
    acceleration: Vec<u32>,
    /// The last acceleration, in m/s^2, and its moment.
    last: Option<(u64, [f64; 3])>,
}

/// All standard messages of one recording.
#[derive(Default)]
pub(crate) struct Standard {
    /// By the numbers of the nodes; None for one that is no standard message.
    parts: HashMap<u32, Option<Arc<Part>>>,
    /// The number that a path has now.
    numbers: HashMap<String, u32>,
    ranges: Sinks<Range>,
    batteries: Sinks<BatteryState>,
    scans: Sinks<LaserScan>,
    pictures: Sinks<CompressedImage>,
    odometry: Sinks<Odometry>,
    transforms: Sinks<Transforms>,
    imus: Sinks<Imu>,
    joints: Sinks<JointState>,
    gamepads: Sinks<Joy>,
    ways: HashMap<u32, Track>,
    /// By their groups.
    halves: HashMap<String, Halves>,
    positions: Gathered,
    speeds: Gathered,
    /// By their groups.
    pads: HashMap<String, Gathered>,
}

impl Standard {
    /// Learns what a node is; all nodes of a group should be known before the first sample of one of them.
    pub(crate) fn meet<W: Write + Seek>(&mut self, known: &Known, id: Id, file: &Writer<W>) {
        if self.parts.contains_key(&known.number) {
            return;
        }
        let path = known.node.path.clone();
        if let Some(before) = self.numbers.insert(path, known.number) {
            // Its format has changed: it may be something else now.
            self.forget(before);
        }
        let found = part(known, id, file.layout(id));
        if let Some(part) = &found {
            self.join(known.number, part);
        }
        self.parts.insert(known.number, found);
    }

    fn join(&mut self, number: u32, part: &Part) {
        let (group, stays) = (part.group().to_owned(), !part.rest.is_empty());
        match &part.role {
            Role::Turning(_) => self.halves.entry(group).or_default().turning.push(number),
            Role::Acceleration(_) => {
                (self.halves.entry(group).or_default().acceleration).push(number);
            }
            Role::Position(_) => self.positions.join(&part.path, stays),
            Role::Speed(_) => self.speeds.join(&part.path, stays),
            Role::Pad(_) => self.pads.entry(group).or_default().join(&part.path, true),
            Role::Range(..)
            | Role::Voltage(_)
            | Role::Scan(_)
            | Role::Picture
            | Role::Place(..) => {}
        }
    }

    fn forget(&mut self, number: u32) {
        let Some(Some(part)) = self.parts.insert(number, None) else {
            return;
        };
        if let Some(halves) = self.halves.get_mut(part.group()) {
            halves.turning.retain(|one| *one != number);
            halves.acceleration.retain(|one| *one != number);
            halves.last = None;
        }
        self.positions.leave(&part.path);
        self.speeds.leave(&part.path);
        if let Some(pad) = self.pads.get_mut(part.group()) {
            pad.leave(&part.path);
        }
        self.ways.remove(&number);
    }

    /// A node has no value: it is in no message.
    pub(crate) fn fault(&mut self, known: &Known) {
        let Some(Some(part)) = self.parts.get(&known.number) else {
            return;
        };
        match part.role {
            Role::Acceleration(_) => {
                if let Some(halves) = self.halves.get_mut(part.group()) {
                    halves.last = None;
                }
            }
            Role::Position(_) => self.positions.set(&part.path, None),
            Role::Speed(_) => self.speeds.set(&part.path, None),
            Role::Pad(_) => {
                if let Some(pad) = self.pads.get_mut(part.group()) {
                    pad.set(&part.path, None);
                }
            }
            Role::Place(..) => drop(self.ways.remove(&known.number)),
            Role::Range(..)
            | Role::Voltage(_)
            | Role::Turning(_)
            | Role::Scan(_)
            | Role::Picture => {}
        }
    }

    /// A sample of a node: the message that it is, or a part of one that `settle` writes.
    ///
    /// # Errors
    /// The file takes nothing more.
    pub(crate) fn sample<W: Write + Seek>(
        &mut self,
        file: &mut Writer<W>,
        known: &Known,
        unix_ns: u64,
        tuple: &[u8],
    ) -> Result<(), Error> {
        let Some(Some(part)) = self.parts.get(&known.number) else {
            return Ok(());
        };
        let part = part.clone();
        if part.role == Role::Picture {
            return match make::picture(&part.path, tuple) {
                Some(picture) => (self.pictures).publish(file, &part.topic(), unix_ns, &picture),
                None => Ok(()),
            };
        }
        let Some(numbers) = part.numbers(file, tuple) else {
            self.fault(known);
            return Ok(());
        };
        match &part.role {
            Role::Place(length, angle) => {
                let place = Place::new(&numbers, *length, *angle);
                self.go(file, known.number, &part, unix_ns, place)
            }
            Role::Turning(unit) => self.turn(file, &part, unix_ns, &in_si(&numbers, *unit)),
            Role::Range(..) | Role::Voltage(_) | Role::Scan(_) => {
                self.single(file, &part, unix_ns, &numbers)
            }
            Role::Acceleration(_)
            | Role::Position(_)
            | Role::Speed(_)
            | Role::Pad(_)
            | Role::Picture => {
                self.gather(&part, unix_ns, &numbers);
                Ok(())
            }
        }
    }

    /// A message of one sample.
    fn single<W: Write + Seek>(
        &mut self,
        file: &mut Writer<W>,
        part: &Part,
        unix_ns: u64,
        numbers: &[f64],
    ) -> Result<(), Error> {
        let (path, topic) = (&part.path, part.topic());
        let first = numbers.first().copied().unwrap_or(f64::NAN);
        if let Role::Range(unit, radiation) = &part.role
            && let Some(range) = make::range(path, first * unit, *radiation)
        {
            return self.ranges.publish(file, &topic, unix_ns, &range);
        }
        if let Role::Voltage(unit) = &part.role
            && let Some(battery) = make::battery(path, first * unit)
        {
            return self.batteries.publish(file, &topic, unix_ns, &battery);
        }
        if let Role::Scan(unit) = &part.role {
            let scan = make::scan(path, &in_si(numbers, *unit));
            return self.scans.publish(file, &topic, unix_ns, &scan);
        }
        Ok(())
    }

    /// The robot is somewhere.
    fn go<W: Write + Seek>(
        &mut self,
        file: &mut Writer<W>,
        number: u32,
        part: &Part,
        unix_ns: u64,
        place: Place,
    ) -> Result<(), Error> {
        let way = self.ways.entry(number).or_default();
        let (odometry, transform) = way.go(&part.path, unix_ns, place);
        let transforms = Transforms(vec![transform]);
        (self.transforms).publish(file, TRANSFORMS, unix_ns, &transforms)?;
        match odometry {
            Some(odometry) => (self.odometry).publish(file, &part.topic(), unix_ns, &odometry),
            None => Ok(()),
        }
    }

    /// The robot turns, which is a message with the acceleration that it has.
    fn turn<W: Write + Seek>(
        &mut self,
        file: &mut Writer<W>,
        part: &Part,
        unix_ns: u64,
        rates: &[f64],
    ) -> Result<(), Error> {
        let group = part.group();
        let halves = self.halves.get(group);
        let other = halves.and_then(|halves| halves.acceleration_at(unix_ns));
        let (Some(linear_acceleration), &[x, y, z]) = (other, rates) else {
            return Ok(());
        };
        let imu = Imu {
            frame: format!("{group}imu"),
            orientation: None,
            angular_velocity: [x, y, z],
            linear_acceleration,
        };
        (self.imus).publish(file, &format!("{PREFIX}{group}imu"), unix_ns, &imu)
    }

    /// A part of a message of several.
    fn gather(&mut self, part: &Part, unix_ns: u64, numbers: &[f64]) {
        let path = &part.path;
        let is_on = !part.is_off(numbers);
        let value = |unit: f64| is_on.then(|| (unix_ns, in_si(numbers, unit)));
        match &part.role {
            Role::Acceleration(unit) => {
                let halves = self.halves.get_mut(part.group());
                if let (Some(halves), &[x, y, z]) = (halves, &in_si(numbers, *unit)[..]) {
                    halves.last = Some((unix_ns, [x, y, z]));
                }
            }
            Role::Position(unit) => self.positions.set(path, value(*unit)),
            Role::Speed(unit) => self.speeds.set(path, value(*unit)),
            Role::Pad(buttons) => {
                let good = make::are_of_a_gamepad(buttons, numbers);
                if let Some(pad) = self.pads.get_mut(part.group()) {
                    pad.set(path, good.then(|| (unix_ns, numbers.to_vec())));
                }
            }
            Role::Range(..)
            | Role::Voltage(_)
            | Role::Turning(_)
            | Role::Scan(_)
            | Role::Picture
            | Role::Place(..) => {}
        }
    }

    /// All samples of one look have come: writes what is made of several. Without `is_end` some of it may wait for the next.
    ///
    /// # Errors
    /// The file takes nothing more.
    pub(crate) fn settle<W: Write + Seek>(
        &mut self,
        file: &mut Writer<W>,
        is_end: bool,
    ) -> Result<(), Error> {
        for (gathered, name, are_speeds) in [
            (&mut self.positions, "joint_states", false),
            (&mut self.speeds, "joint_speeds", true),
        ] {
            let Some(unix_ns) = gathered.due(is_end) else {
                continue;
            };
            if let Some(joints) = make::joints(gathered.values(unix_ns), are_speeds) {
                (self.joints).publish(file, &format!("{PREFIX}{name}"), unix_ns, &joints)?;
            }
        }
        for (group, gathered) in &mut self.pads {
            let Some(unix_ns) = gathered.due(is_end) else {
                continue;
            };
            let group = group.trim_end_matches('/');
            let buttons = |path: &str| {
                let part = self.parts.get(self.numbers.get(path)?)?.as_ref()?;
                part.role.buttons()
            };
            if let Some(joy) = make::gamepad(group, gathered, unix_ns, buttons) {
                (self.gamepads).publish(file, &format!("{PREFIX}{group}"), unix_ns, &joy)?;
            }
        }
        Ok(())
    }
}

impl Halves {
    /// The acceleration that belongs to this moment.
    fn acceleration_at(&self, unix_ns: u64) -> Option<[f64; 3]> {
        let (at_ns, acceleration) = self.last?;
        let is_one_pair = self.turning.len() == 1 && self.acceleration.len() == 1;
        (is_one_pair && unix_ns.abs_diff(at_ns) <= IMU_APART_NS).then_some(acceleration)
    }
}

fn part(known: &Known, id: Id, layout: &Layout) -> Option<Arc<Part>> {
    let node = &known.node;
    let role = rows::role(node, layout)?;
    let rest = node.rest.split_whitespace().map(str::parse);
    Some(Arc::new(Part {
        path: node.path.clone(),
        rest: rest.collect::<Result<_, _>>().unwrap_or_default(),
        id,
        role,
    }))
}

fn in_si(numbers: &[f64], unit: f64) -> Vec<f64> {
    numbers.iter().map(|number| number * unit).collect()
}

#[cfg(test)]
mod tests;
