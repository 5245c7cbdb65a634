//! What the tree has: its motors, sensors and lights as devices of ev3dev, with the address of each.
//!
//! Owns the map from ports of the controller to addresses, and which encoder belongs to which motor. Looks at names,
//! `format` and `units` of the tree; opens nothing that moves or measures.

use crate::device::{Device, KernelSlot};
use crate::fixed::{Battery, BoardInfo, Led};
use crate::motor::Motor;
use crate::motor::driver::Paths;
use crate::sensor::{Kind, Sensor};
use crate::servo::Servo;
use crate::tree::Tree;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Directories of the view.
pub const CLASSES: [&str; 7] = [
    "board-info",
    "dc-motor",
    "lego-sensor",
    "leds",
    "power_supply",
    "servo-motor",
    "tacho-motor",
];

/// Ports with motors, and their names on an EV3.
const MOTORS: [(&str, &str); 4] = [
    ("M1", "outA"),
    ("M2", "outB"),
    ("M3", "outC"),
    ("M4", "outD"),
];
/// Ports with sensors. No number has two digits, because programs look for a part of the address.
const SENSORS: [(&str, &str); 9] = [
    ("A1", "in1"),
    ("A2", "in2"),
    ("A3", "in3"),
    ("A4", "in4"),
    ("A5", "in5"),
    ("A6", "in6"),
    ("D1", "in7"),
    ("D2", "in8"),
    ("D3", "in9"),
];
const SERVOS: [(&str, &str); 6] = [
    ("S1", "sv1"),
    ("S2", "sv2"),
    ("S3", "sv3"),
    ("S4", "sv4"),
    ("S5", "sv5"),
    ("S6", "sv6"),
];
/// Lights, under the names of both sides of an EV3: there is one of each colour.
const LIGHTS: [(&str, &str); 4] = [
    ("led0:green:brick-status", "led/green/value"),
    ("led0:red:brick-status", "led/red/value"),
    ("led1:green:brick-status", "led/green/value"),
    ("led1:red:brick-status", "led/red/value"),
];

/// What a person has said about the motors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Greatest speed of motors with encoders, in degrees per second.
    pub max_speed: i32,
    /// Encoders of ports, where they are not those with the same number; empty for a motor that has none.
    pub encoders: BTreeMap<String, String>,
}

/// A device that is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// One of [`CLASSES`].
    pub class: &'static str,
    /// What it is in the tree; one device for each in a class.
    pub key: String,
    /// How its directory is called.
    pub name: Name,
    hardware: Hardware,
}

/// How the directory of a device is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Name {
    /// By this name.
    Exact(&'static str),
    /// By this name and a number that no device of the class had before.
    Numbered(&'static str),
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Hardware {
    Motor(String, Paths),
    Servo(String, bool),
    Sensor(String, String, Kind),
    Led(&'static str),
    Battery,
    Board,
}

impl Found {
    /// Makes the device. Touches no file.
    pub fn make(&self, tree: &Tree, options: &Options, kernel: &KernelSlot) -> Arc<dyn Device> {
        let tree = tree.clone();
        match &self.hardware {
            Hardware::Motor(address, paths) => Arc::new(Motor::new(
                tree,
                address.clone(),
                paths.clone(),
                options.max_speed,
                Arc::clone(kernel),
            )),
            Hardware::Servo(address, in_degrees) => Arc::new(Servo::new(
                tree,
                address.clone(),
                self.key.clone(),
                *in_degrees,
            )),
            Hardware::Sensor(address, node, kind) => {
                Arc::new(Sensor::new(&tree, address.clone(), node, *kind))
            }
            Hardware::Led(file) => Arc::new(Led::new(tree, (*file).to_owned())),
            Hardware::Battery => Arc::new(Battery::new(tree)),
            Hardware::Board => Arc::new(BoardInfo),
        }
    }
}

/// All devices of the tree; nothing if there is no tree now.
pub fn scan(tree: &Tree, options: &Options) -> Option<Vec<Found>> {
    if !tree.is_there() {
        return None;
    }
    let mut found = vec![Found {
        class: "board-info",
        key: String::new(),
        name: Name::Exact("board0"),
        hardware: Hardware::Board,
    }];
    add_motors(tree, options, &mut found);
    add_sensors(tree, &mut found);
    for (port, name) in SERVOS {
        let node = format!("servos/{port}");
        if has(tree, &node) {
            let in_degrees = tree.text(&format!("{node}/units")).as_deref() == Ok("deg");
            let hardware = Hardware::Servo(address(name, port), in_degrees);
            found.push(numbered("servo-motor", &node, "motor", hardware));
        }
    }
    for (name, file) in LIGHTS {
        if has(tree, file) {
            found.push(Found {
                class: "leds",
                key: name.to_owned(),
                name: Name::Exact(name),
                hardware: Hardware::Led(file),
            });
        }
    }
    if has(tree, "battery") {
        found.push(Found {
            class: "power_supply",
            key: "battery".to_owned(),
            name: Name::Exact("trik-battery"),
            hardware: Hardware::Battery,
        });
    }
    // The tree may have gone meanwhile, and what it seemed to lack then says nothing.
    tree.is_there().then_some(found)
}

fn numbered(class: &'static str, node: &str, prefix: &'static str, hardware: Hardware) -> Found {
    Found {
        class,
        key: node.to_owned(),
        name: Name::Numbered(prefix),
        hardware,
    }
}

/// As on an EV3, followed by the name of the controller's port.
fn address(name: &str, port: &str) -> String {
    format!("ev3-ports:{name}:{port}")
}

fn has(tree: &Tree, name: &str) -> bool {
    tree.path(name).metadata().is_ok()
}

fn add_motors(tree: &Tree, options: &Options, found: &mut Vec<Found>) {
    for (port, name) in MOTORS {
        let node = format!("motors/{port}");
        if !has(tree, &node) {
            continue;
        }
        let usual = port.replace('M', "E");
        let encoder = options.encoders.get(port).unwrap_or(&usual);
        let encoder = format!("encoders/{encoder}");
        // Without a name it is the group itself, which has no values.
        let encoder = has(tree, &format!("{encoder}/value0")).then_some(encoder);
        let class = if encoder.is_some() {
            "tacho-motor"
        } else {
            "dc-motor"
        };
        let paths = Paths {
            power: format!("{node}/value"),
            encoder,
        };
        let hardware = Hardware::Motor(address(name, port), paths);
        found.push(numbered(class, &node, "motor", hardware));
    }
}

fn add_sensors(tree: &Tree, found: &mut Vec<Found>) {
    for (port, name) in SENSORS {
        let node = format!("sensors/{port}");
        if !has(tree, &node) {
            continue;
        }
        let kind = if port.starts_with('D') {
            Kind::Ultrasonic
        } else {
            Kind::of_format(&tree.text(&format!("{node}/format")).unwrap_or_default())
        };
        let hardware = Hardware::Sensor(address(name, port), node.clone(), kind);
        found.push(numbered("lego-sensor", &node, "sensor", hardware));
    }
    for (node, kind) in [
        ("gyroscope", Kind::Gyroscope),
        ("accelerometer", Kind::Accelerometer),
    ] {
        if has(tree, node) {
            let hardware = Hardware::Sensor(format!("trik:{node}"), node.to_owned(), kind);
            found.push(numbered("lego-sensor", node, "sensor", hardware));
        }
    }
}

/// Why a motor gets no encoder; told to those who have written the option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoEncoder {
    /// There is no motor of this name.
    Motor(String),
    /// There is no encoder of this name.
    Encoder(String),
}

impl fmt::Display for NoEncoder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ports = MOTORS.map(|(port, _)| port);
        match self {
            Self::Motor(name) => {
                let motors = ports.join(", ");
                write!(f, "there is no motor {name:?}; there are {motors}")
            }
            Self::Encoder(name) => {
                let encoders = ports.map(encoder_beside).join(", ");
                write!(
                    f,
                    "there is no encoder {name:?}; there are {encoders}, and none"
                )
            }
        }
    }
}

impl std::error::Error for NoEncoder {}

/// The encoder with the number of a motor.
fn encoder_beside(motor: &str) -> String {
    motor.replace('M', "E")
}

/// Reads `PORT=ENCODER`, or `PORT=none`.
///
/// # Errors
/// There is no such port, or no such encoder.
pub fn encoder_of(text: &str) -> Result<(String, String), NoEncoder> {
    let (port, encoder) = text.split_once('=').unwrap_or((text, ""));
    let mut ports = MOTORS.iter().map(|(port, _)| *port);
    if !ports.clone().any(|known| known == port) {
        return Err(NoEncoder::Motor(port.to_owned()));
    }
    match encoder {
        "none" => Ok((port.to_owned(), String::new())),
        _ if ports.any(|port| encoder_beside(port) == encoder) => {
            Ok((port.to_owned(), encoder.to_owned()))
        }
        _ => Err(NoEncoder::Encoder(encoder.to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(encoders: &[&str]) -> Options {
        let encoders = encoders.iter().map(|text| encoder_of(text).unwrap());
        Options {
            max_speed: 1000,
            encoders: encoders.collect(),
        }
    }

    #[test]
    fn a_motor_has_the_encoder_of_its_number_or_the_one_that_was_said_or_none() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for node in [
            "motors/M1",
            "motors/M2",
            "motors/M3",
            "encoders/E1",
            "encoders/E4",
        ] {
            std::fs::create_dir_all(root.join(node)).unwrap();
            std::fs::write(root.join(node).join("value0"), "").unwrap();
        }
        std::fs::write(root.join("status"), "").unwrap();
        let pairs = |said: &[&str]| -> Vec<_> {
            let found = scan(&Tree::new(root.to_owned()), &options(said)).unwrap();
            let of = |one: Found| {
                let Hardware::Motor(_, paths) = one.hardware else {
                    return None;
                };
                Some((one.class, paths.encoder.unwrap_or_default()))
            };
            found.into_iter().filter_map(of).collect()
        };
        let dc = ("dc-motor", String::new());
        let tacho = |encoder: &str| ("tacho-motor", format!("encoders/{encoder}"));
        assert_eq!(pairs(&[]), [tacho("E1"), dc.clone(), dc.clone()]);
        let said = ["M1=none", "M3=E4"];
        assert_eq!(pairs(&said), [dc.clone(), dc, tacho("E4")]);
        for text in ["M5=E1", "M1", "M1=", "M1=M1", "=E1", "left=E1"] {
            assert!(encoder_of(text).is_err(), "{text}");
        }
    }

    #[test]
    fn addresses_are_found_by_any_of_their_names_and_by_one_only() {
        let all = MOTORS.iter().chain(&SENSORS).chain(&SERVOS);
        let addresses: Vec<String> = all
            .clone()
            .map(|(port, name)| address(name, port))
            .collect();
        for (port, name) in all {
            for wanted in [
                (*port).to_owned(),
                (*name).to_owned(),
                format!("ev3-ports:{name}"),
            ] {
                let count = addresses
                    .iter()
                    .filter(|address| address.contains(&wanted))
                    .count();
                assert_eq!(count, 1, "{wanted}");
            }
        }
    }

    #[test]
    fn what_is_no_tree_has_no_devices() {
        for root in ["/nowhere", "/"] {
            assert_eq!(scan(&Tree::new(root.into()), &options(&[])), None);
        }
    }
}
