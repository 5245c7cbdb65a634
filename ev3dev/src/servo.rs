//! Servos: the class servo-motor over a servo of the tree.
//!
//! Owns the scale from percent to the unit of the tree. A servo that runs has its file open, so that the tree switches it
//! off if this process dies.

use crate::device::{
    Attribute, Device, Shown, line, lock, no_such_word, number_within, read, read_write, write,
};
use crate::tree::{Tree, TreeFile};
use std::sync::Mutex;
use trikfs::errno::Error;

const ATTRIBUTES: [Attribute; 11] = [
    read("address"),
    write("command"),
    read("commands"),
    read("driver_name"),
    read_write("max_pulse_sp"),
    read_write("mid_pulse_sp"),
    read_write("min_pulse_sp"),
    read_write("polarity"),
    read_write("position_sp"),
    read_write("rate_sp"),
    read("state"),
];

/// Degrees of a servo at 100 percent.
const DEGREES_MAX: i32 = 90;

/// A servo of the tree.
pub struct Servo {
    tree: Tree,
    address: String,
    /// Its node, for example `servos/S1`.
    node: String,
    /// The tree takes degrees; else it takes percent.
    in_degrees: bool,
    work: Mutex<Work>,
}

#[derive(Default)]
struct Work {
    position: i32,
    is_inversed: bool,
    /// Open while it runs.
    value: Option<TreeFile>,
}

impl Servo {
    /// A servo that is not driven yet.
    pub fn new(tree: Tree, address: String, node: String, in_degrees: bool) -> Self {
        Self {
            tree,
            address,
            node,
            in_degrees,
            work: Mutex::default(),
        }
    }

    /// What the tree takes for a position in percent.
    fn scaled(&self, work: &Work) -> i32 {
        let percent = if work.is_inversed {
            -work.position
        } else {
            work.position
        };
        if self.in_degrees {
            percent * DEGREES_MAX / 100
        } else {
            percent
        }
    }

    /// Sends the position; opens the file if it was not, and again if the tree was away.
    fn run(&self, work: &mut Work) -> Result<(), Error> {
        let text = self.scaled(work).to_string();
        if let Some(value) = &work.value {
            match value.write(&text) {
                Err(Error::NoDevice(_)) => work.value = None,
                result => return result.map_err(out_of_reach),
            }
        }
        let value = self.tree.open_to_write(&format!("{}/value", self.node))?;
        value.write(&text).map_err(out_of_reach)?;
        work.value = Some(value);
        Ok(())
    }
}

/// A servo from 0 to 100 has no place for less than 0.
fn out_of_reach(error: Error) -> Error {
    if let Error::OutOfRange(what) = error {
        Error::Invalid(what)
    } else {
        error
    }
}

impl Device for Servo {
    fn rest(&self, _why: &str) -> bool {
        let mut work = lock(&self.work);
        let is_driven = work.value.is_some();
        let rests = || self.tree.write(&format!("{}/power", self.node), "0");
        let is_at_rest = is_driven && rests().is_ok();
        if is_at_rest {
            // One that did not rest does so when this process ends, while its file is open.
            work.value = None;
        }
        is_at_rest
    }

    fn attributes(&self) -> &'static [Attribute] {
        &ATTRIBUTES
    }

    fn show(&self, attribute: &str) -> Result<Shown, Error> {
        match attribute {
            "address" => line(&self.address),
            "commands" => line("run float"),
            "driver_name" => line("trik-servo"),
            "polarity" => line(if lock(&self.work).is_inversed {
                "inversed"
            } else {
                "normal"
            }),
            "position_sp" => line(lock(&self.work).position),
            "state" => {
                let power = self.tree.text(&format!("{}/power", self.node))?;
                line(if power == "1" { "running" } else { "" })
            }
            // The tree makes the pulses from its own type of the servo.
            "max_pulse_sp" | "mid_pulse_sp" | "min_pulse_sp" | "rate_sp" => Err(Error::Unsupported),
            _ => Err(Error::NotFound),
        }
    }

    fn store(&self, attribute: &str, text: &str) -> Result<(), Error> {
        let mut work = lock(&self.work);
        match (attribute, text) {
            ("command", "run") => self.run(&mut work),
            ("command", "float") => {
                self.tree.write(&format!("{}/power", self.node), "0")?;
                work.value = None;
                Ok(())
            }
            ("polarity", "normal") => {
                work.is_inversed = false;
                Ok(())
            }
            ("polarity", "inversed") => {
                work.is_inversed = true;
                Ok(())
            }
            ("command" | "polarity", _) => Err(no_such_word(attribute, text)),
            ("position_sp", _) => {
                let before = work.position;
                work.position = number_within(attribute, text, -100, 100)?;
                if work.value.is_none() {
                    return Ok(());
                }
                let result = self.run(&mut work);
                if result.is_err() {
                    work.position = before;
                }
                result
            }
            ("max_pulse_sp" | "mid_pulse_sp" | "min_pulse_sp" | "rate_sp", _) => {
                Err(Error::Unsupported)
            }
            _ => Err(Error::AccessDenied),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_become_what_the_tree_takes() {
        let servo = |in_degrees| {
            Servo::new(
                Tree::new("/nowhere".into()),
                String::new(),
                String::new(),
                in_degrees,
            )
        };
        let work = |position, is_inversed| Work {
            position,
            is_inversed,
            value: None,
        };
        for (in_degrees, position, is_inversed, sent) in [
            (true, 100, false, 90),
            (true, -50, false, -45),
            (true, 50, true, -45),
            (false, 70, false, 70),
            (false, 70, true, -70),
        ] {
            assert_eq!(servo(in_degrees).scaled(&work(position, is_inversed)), sent);
        }
        let servo = servo(true);
        assert_eq!(servo.store("position_sp", "55"), Ok(()));
        assert_eq!(servo.show("position_sp"), line(55));
        for (attribute, text) in [
            ("position_sp", "101"),
            ("command", "stop"),
            ("polarity", "x"),
        ] {
            assert_eq!(
                servo.store(attribute, text).unwrap_err().errno(),
                libc::EINVAL
            );
        }
        assert_eq!(
            servo.store("command", "run").unwrap_err().errno(),
            libc::ENODEV
        );
        assert_eq!(servo.show("rate_sp").unwrap_err().errno(), libc::EOPNOTSUPP);
    }
}
