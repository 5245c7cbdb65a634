//! The robot as programs see it: ports with the names of the controller, over the files of the tree.
//!
//! A facade for engines and telemetry: it opens each file once, and a method is one pread(2) or pwrite(2). Owns which
//! files stand for which port. Times, signals and what a language calls things belong to the engines.

pub mod actuators;
pub mod sensors;

use crate::tree::{Access, Answers, Tree, is_name};
use actuators::{Led, Motor, Sound};
use sensors::{Battery, Camera, Encoder, Gamepad, Keys, Sensor, Vector};
use std::fs::{File, OpenOptions};
use std::io;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::rc::Rc;

/// Port names are unique only within one of these groups of the tree.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Group {
    /// Power motors, M1 to M4.
    Motors,
    /// Servos, S1 to S6.
    Servos,
    /// Analog inputs A1 to A6 and distances D1 to D3.
    Sensors,
    /// E1 to E4.
    Encoders,
}

impl Group {
    /// Its directory.
    pub fn directory(self) -> &'static str {
        match self {
            Self::Motors => "motors",
            Self::Servos => "servos",
            Self::Sensors => "sensors",
            Self::Encoders => "encoders",
        }
    }
}

/// Whether a name is that of a connector, as `M1`: one or two capital letters, then one or two digits.
fn is_connector(name: &str) -> bool {
    let number = name.trim_start_matches(|letter: char| letter.is_ascii_uppercase());
    let letters = name.len() - number.len();
    (1..=2).contains(&letters)
        && (1..=2).contains(&number.len())
        && number.bytes().all(|digit| digit.is_ascii_digit())
}

/// All peripherals of one robot.
#[derive(Debug)]
pub struct Brick {
    tree: Tree,
}

impl Brick {
    /// The robot whose tree is mounted at `root`.
    pub fn new(root: &Path) -> Self {
        Self {
            tree: Tree::new(root),
        }
    }

    /// The robot of a tree that is mounted nowhere.
    pub fn answered(answers: Rc<dyn Answers>) -> Self {
        Self {
            tree: Tree::answered(answers),
        }
    }

    /// Its files.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The directory of a port, if the tree has it and something is plugged in.
    fn directory(&self, group: Group, port: &str) -> Option<String> {
        let directory = format!("{}/{port}", group.directory());
        (is_name(port) && self.tree.has(&directory)).then_some(directory)
    }

    /// A power motor, else a servo; None if there is no such port.
    pub fn motor(&self, port: &str) -> Option<Motor> {
        if let Some(directory) = self.directory(Group::Motors, port) {
            return Some(Motor::power_motor(&self.tree, &directory));
        }
        let directory = self.directory(Group::Servos, port)?;
        Some(Motor::servo(&self.tree, &directory))
    }

    /// An analog or distance sensor; None if there is no such port.
    pub fn sensor(&self, port: &str) -> Option<Sensor> {
        let directory = self.directory(Group::Sensors, port)?;
        Some(Sensor::new(&self.tree, &directory))
    }

    /// An encoder; None if there is no such port.
    pub fn encoder(&self, port: &str) -> Option<Encoder> {
        let directory = self.directory(Group::Encoders, port)?;
        Some(Encoder::new(&self.tree, &directory))
    }

    /// The keys of the controller.
    pub fn keys(&self) -> Keys {
        Keys::new(&self.tree)
    }

    /// The two lights.
    pub fn led(&self) -> Led {
        Led::new(&self.tree)
    }

    /// The battery.
    pub fn battery(&self) -> Battery {
        Battery::new(&self.tree)
    }

    /// The loudspeaker.
    pub fn sound(&self) -> Sound {
        Sound::new(&self.tree)
    }

    /// The accelerometer; None if the robot has none.
    pub fn accelerometer(&self) -> Option<Vector> {
        self.tree
            .has("accelerometer")
            .then(|| Vector::accelerometer(&self.tree))
    }

    /// The gyroscope; None if the robot has none.
    pub fn gyroscope(&self) -> Option<Vector> {
        self.tree
            .has("gyroscope")
            .then(|| Vector::gyroscope(&self.tree))
    }

    /// The camera as a sensor of `line`, `object` or `color`, or the microphones as one of `sound`; None if there is
    /// none.
    pub fn camera(&self, sensor: &str) -> Option<Camera> {
        let directory = match sensor {
            "line" | "object" | "color" => format!("camera/{sensor}"),
            "sound" => "microphones".to_owned(),
            _ => return None,
        };
        let is_there = self.tree.is_directory(&directory);
        is_there.then(|| Camera::new(&self.tree, &directory))
    }

    /// The gamepad, connected or not.
    pub fn gamepad(&self) -> Gamepad {
        Gamepad::new(&self.tree)
    }

    /// Distances in mm in each direction, one for each degree.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn lidar(&self, distances: &mut [f64]) -> io::Result<usize> {
        self.tree
            .node("lidar/value", Access::Read)
            .numbers(distances)
    }

    /// Names of the ports of a group, sorted. The second names that a robot file gives them count only where a group has
    /// no others.
    pub fn ports(&self, group: Group) -> Vec<String> {
        let mut names = self.tree.names(group.directory());
        names.retain(|name| is_name(name));
        if names.iter().any(|name| is_connector(name)) {
            names.retain(|name| is_connector(name));
        }
        names
    }

    /// Brings all actuators to rest.
    ///
    /// # Errors
    /// The first failure, after all have been tried.
    pub fn stop(&self) -> io::Result<()> {
        self.tree.node("stop", Access::Write).write("1\n")
    }

    /// A stream of the tree for an engine that polls: opened anew, non-blocking, with a queue of its own.
    /// `keys/device` gives seven native `i32` for each event, in the order of [`sensors::KEYS`]; `gamepad/text/device`
    /// gives lines, filled up with zero bytes.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn stream(&self, path: &str) -> io::Result<File> {
        let mut how = OpenOptions::new();
        how.read(true).custom_flags(libc::O_NONBLOCK);
        how.open(self.tree.root().join(path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::put;
    use std::cell::RefCell;
    use tempfile::tempdir;

    #[test]
    fn ports_without_a_device_are_none_and_power_motors_come_before_servos() {
        let scratch = tempdir().unwrap();
        for port in ["motors/M1", "servos/M1", "servos/S1"] {
            put(scratch.path(), &format!("{port}/value"), "0\n");
            put(scratch.path(), &format!("{port}/units"), "deg\n");
        }
        let brick = Brick::new(scratch.path());
        assert!(!brick.motor("M1").unwrap().is_servo());
        assert!(brick.motor("S1").unwrap().is_servo());
        for bad in ["M2", "", "..", "M1/../M1", "../motors/M1"] {
            assert!(brick.motor(bad).is_none(), "{bad}");
        }
        assert_eq!(brick.ports(Group::Servos), ["M1", "S1"]);
    }

    #[test]
    fn power_is_cut_to_what_the_motor_can_do() {
        let scratch = tempdir().unwrap();
        let motor = put(scratch.path(), "motors/M1/value", "");
        let servo = put(scratch.path(), "servos/S1/value", "");
        put(scratch.path(), "servos/S1/units", "deg\n");
        let brick = Brick::new(scratch.path());
        let told = |path: &Path| std::fs::read_to_string(path).unwrap();
        brick.motor("M1").unwrap().set_power(250.0).unwrap();
        assert_eq!(told(&motor), "100\n");
        brick.motor("S1").unwrap().set_power(-250.0).unwrap();
        assert_eq!(told(&servo), "-90\n");
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            put(scratch.path(), "motors/M1/value", "7\n");
            brick.motor("M1").unwrap().set_power(wrong).unwrap();
            brick.motor("S1").unwrap().set_power(wrong).unwrap();
            assert_eq!((told(&motor), told(&servo)), ("0\n".into(), "-90\n".into()));
        }
    }

    /// A servo that has nothing below the middle.
    #[derive(Debug, Default)]
    struct Gripper(RefCell<String>);

    impl Answers for Gripper {
        fn has(&self, directory: &str) -> bool {
            directory == "servos/S6"
        }

        fn is_file(&self, _path: &str) -> bool {
            false
        }

        fn names(&self, _directory: &str) -> Vec<String> {
            ["S6", "arm", "S12x", "s6"].map(str::to_owned).to_vec()
        }

        fn read(&self, _path: &str) -> io::Result<String> {
            Ok("%".to_owned())
        }

        fn write(&self, _path: &str, text: &str) -> io::Result<()> {
            match text.trim().parse::<i32>().unwrap() {
                0..=100 => *self.0.borrow_mut() = text.to_owned(),
                _ => return Err(io::Error::from_raw_os_error(libc::ERANGE)),
            }
            Ok(())
        }

        fn now_us(&self) -> u128 {
            0
        }
    }

    #[test]
    fn a_servo_goes_to_its_end_and_ports_have_no_second_names() {
        let gripper = Rc::new(Gripper::default());
        let brick = Brick::answered(gripper.clone());
        let servo = brick.motor("S6").unwrap();
        for (power, wanted) in [(50.4, "50\n"), (-50.0, "0\n"), (400.0, "100\n")] {
            servo.set_power(power).unwrap();
            assert_eq!(*gripper.0.borrow(), wanted);
        }
        assert_eq!(brick.ports(Group::Servos), ["S6"]);
    }
}
