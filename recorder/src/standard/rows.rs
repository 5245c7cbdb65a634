//! Which node is which standard message: one row for each kind.
//!
//! Owns the rows. They look at the names of the numbers, at the unit, and at the path only where nothing else tells.

use super::units::{Quantity, factor};
use crate::limits::SCAN_NUMBERS_MIN;
use journal::layout::Layout;
use journal::node::Node;
use journal::standard::robot::Radiation;

/// A node as the rows see it.
pub(super) struct Shape<'a> {
    node: &'a Node,
    layout: &'a Layout,
    /// Names of its numbers.
    names: Vec<&'a str>,
}

/// What a node is; numbers are what one of its unit is in that of SI.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Role {
    Range(f64, Radiation),
    Voltage(f64),
    Turning(f64),
    Acceleration(f64),
    Position(f64),
    Speed(f64),
    /// A part of a gamepad: which of its numbers are buttons; the others are axes.
    Pad(Vec<bool>),
    Scan(f64),
    Picture,
    /// A place on the plane: the unit of its lengths, and that of its angle.
    Place(f64, f64),
}

impl Role {
    /// Which numbers of a gamepad are buttons; None for anything else.
    pub(super) fn buttons(&self) -> Option<&[bool]> {
        if let Self::Pad(buttons) = self {
            return Some(buttons);
        }
        None
    }
}

/// A kind of standard message.
pub(crate) struct Row {
    /// Its type, and where it is.
    #[cfg(test)]
    pub(crate) message: &'static str,
    #[cfg(test)]
    pub(crate) topic: &'static str,
    fits: fn(&Shape<'_>) -> Option<Role>,
}

macro_rules! row {
    ($message:literal, $topic:literal, $fits:expr) => {
        Row {
            #[cfg(test)]
            message: $message,
            #[cfg(test)]
            topic: $topic,
            fits: $fits,
        }
    };
}

/// All of them; the first that fits counts.
pub(crate) const ROWS: [Row; 10] = [
    row!("Range", "/ros/NODE", |shape| {
        let factor = shape.one(&["distance", "range"], Quantity::Length)?;
        Some(Role::Range(factor, shape.radiation()))
    }),
    row!("BatteryState", "/ros/NODE", |shape| {
        (shape.one(&["voltage"], Quantity::Voltage)).map(Role::Voltage)
    }),
    row!("Imu", "/ros/GROUP/imu", |shape| {
        (shape.vector(Quantity::AngularSpeed)).map(Role::Turning)
    }),
    row!("Imu", "/ros/GROUP/imu", |shape| {
        (shape.vector(Quantity::Acceleration)).map(Role::Acceleration)
    }),
    row!("JointState", "/ros/joint_states", |shape| {
        (shape.one(&["position", "angle"], Quantity::Angle)).map(Role::Position)
    }),
    row!("JointState", "/ros/joint_speeds", |shape| {
        (shape.one(&["speed", "velocity"], Quantity::AngularSpeed)).map(Role::Speed)
    }),
    row!("Joy", "/ros/GROUP", pad),
    row!("LaserScan", "/ros/NODE", scan),
    row!("CompressedImage", "/ros/NODE", |shape| {
        let is_bytes = matches!(shape.layout, Layout::Bytes(_));
        (is_bytes && !shape.node.is_written).then_some(Role::Picture)
    }),
    row!("Odometry", "/ros/NODE", place),
];

/// What a node is; None if it is no standard message.
pub(super) fn role(node: &Node, layout: &Layout) -> Option<Role> {
    let names = match layout {
        Layout::Fields(fields) => fields.iter().map(|field| field.name.as_str()).collect(),
        Layout::Bytes(_) | Layout::Text(_) => Vec::new(),
    };
    let shape = Shape {
        node,
        layout,
        names,
    };
    ROWS.iter().find_map(|row| (row.fits)(&shape))
}

impl Shape<'_> {
    /// One number with one of these names that measures this.
    fn one(&self, names: &[&str], quantity: Quantity) -> Option<f64> {
        let [name] = self.names[..] else { return None };
        (names.contains(&name)).then(|| factor(quantity, &self.node.units))?
    }

    /// Numbers along x, y and z.
    fn vector(&self, quantity: Quantity) -> Option<f64> {
        (self.names == ["x", "y", "z"]).then(|| factor(quantity, &self.node.units))?
    }

    /// By light if a name says so: neither formats nor units do.
    fn radiation(&self) -> Radiation {
        let names = self.node.aliases.iter().chain([&self.node.path]);
        let mut words = names.flat_map(|name| name.split(|c: char| !c.is_ascii_alphabetic()));
        let is_light =
            |word: &str| ["infrared", "ir", "sharp", "laser", "tof", "lidar"].contains(&word);
        match words.any(|word| is_light(&word.to_ascii_lowercase())) {
            true => Radiation::Infrared,
            false => Radiation::Ultrasound,
        }
    }
}

/// A node in a group that is called so: numbers without a unit, of which those of buttons are 0 or 1.
fn pad(shape: &Shape<'_>) -> Option<Role> {
    let (group, _) = shape.node.path.rsplit_once('/')?;
    let is_gamepad = group.rsplit('/').next() == Some("gamepad");
    let is_plain = shape.node.units.is_empty() && !shape.names.is_empty();
    let is_button = |name: &&str| {
        let number = name.strip_prefix('b').map(str::parse::<u8>);
        *name == "touched" || matches!(number, Some(Ok(_)))
    };
    let is_axis = |name: &&str| ["x", "y", "wheel"].contains(name);
    let is_known = shape
        .names
        .iter()
        .all(|name| is_button(name) || is_axis(name));
    (is_gamepad && is_plain && is_known)
        .then(|| Role::Pad(shape.names.iter().map(is_button).collect()))
}

/// Distances in so many directions, of which the first is ahead, and the others follow clockwise: `d0`, `d1` and so on.
fn scan(shape: &Shape<'_>) -> Option<Role> {
    let all = &shape.names;
    let is_row =
        (all.iter().enumerate()).all(|(at, name)| name.strip_prefix('d') == Some(&at.to_string()));
    (is_row && all.len() >= SCAN_NUMBERS_MIN)
        .then(|| factor(Quantity::Length, &shape.node.units))?
        .map(Role::Scan)
}

/// Where a robot is: units are `mm, deg`; without any, those of the node that the controller's own configuration has.
fn place(shape: &Shape<'_>) -> Option<Role> {
    place_units(shape.node, shape.layout).map(|(length, angle)| Role::Place(length, angle))
}

/// In which units, in m and rad, a node says where a robot is: its first numbers are x, y and the direction. None if it says
/// something else.
pub fn place_units(node: &Node, layout: &Layout) -> Option<(f64, f64)> {
    let Layout::Fields(fields) = layout else {
        return None;
    };
    let names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
    if !matches!(names[..], ["x", "y", "heading" | "theta"]) {
        return None;
    }
    let units = node.units.as_str();
    let is_ours = node.path == "odometry" && names[2] == "heading" && units.is_empty();
    let units = if is_ours { "mm, deg" } else { units };
    let (length, angle) = units.split_once(',')?;
    let length = factor(Quantity::Length, length)?;
    Some((length, factor(Quantity::Angle, angle)?))
}
