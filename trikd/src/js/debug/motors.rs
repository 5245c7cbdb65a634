//! Motors of a program in JavaScript while it is stopped: they rest, and come back as they were.
//!
//! Owns what they were told.

use crate::brick::actuators::Motor;
use crate::brick::{Brick, Group};
use crate::tree::Access;
use std::fmt;
use std::io;

/// Motors that rest for a stop.
#[derive(Debug, Default)]
pub(super) struct Resting(Vec<(String, f64)>);

/// One that may still move.
#[derive(Debug)]
pub(super) struct Moving {
    port: String,
    why: io::Error,
}

impl fmt::Display for Moving {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { port, why } = self;
        write!(
            out,
            "{port} does not rest at a stop, and is told again to: {why}"
        )
    }
}

/// What it does if it moves or holds something.
fn told(brick: &Brick, motor: &Motor, port: &str) -> io::Result<Option<f64>> {
    if motor.is_servo() {
        // One that is off has no position, and a port that measures pulses has no switch.
        let switch = format!("{}/{port}/power", Group::Servos.directory());
        match brick.tree().node(&switch, Access::Read).number() {
            Ok(0.0) => return Ok(None),
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error),
        }
    }
    let power = motor.power()?;
    Ok((power != 0.0 || motor.is_servo()).then_some(power))
}

impl Resting {
    /// Brings to rest what moves; again and again, as long as threads may still tell motors something.
    ///
    /// # Errors
    /// The first one that may still move and why, after all have been tried.
    pub fn hold(&mut self, brick: &Brick) -> Result<(), Moving> {
        let mut done = Ok(());
        let ports = [Group::Motors, Group::Servos].map(|group| brick.ports(group));
        for port in ports.into_iter().flatten() {
            if let Err(why) = self.hold_one(brick, &port) {
                done = done.and(Err(Moving { port, why }));
            }
        }
        done
    }

    fn hold_one(&mut self, brick: &Brick, port: &str) -> io::Result<()> {
        let Some(motor) = brick.motor(port) else {
            return Ok(());
        };
        let Some(power) = told(brick, &motor, port)? else {
            return Ok(());
        };
        motor.power_off()?;
        self.0.retain(|(other, _)| other != port);
        self.0.push((port.to_owned(), power));
        Ok(())
    }

    /// They do again what they did, but for those that were told something in between.
    pub fn go_on(&mut self, brick: &Brick) {
        for (port, power) in self.0.drain(..) {
            let Some(motor) = brick.motor(&port) else {
                continue;
            };
            let is_off = motor.is_servo() || motor.power().is_ok_and(|now| now == 0.0);
            if is_off {
                // It says so itself when the program uses it.
                let _ = motor.set_power(power);
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::tree::Answers;
    use std::cell::{Cell, RefCell};
    use std::collections::BTreeMap;
    use std::rc::Rc;

    /// Two motors and two servos, one of which measures pulses; M3 fails now and then.
    #[derive(Debug, Default)]
    pub struct Robot {
        pub fails: Cell<bool>,
        pub files: RefCell<BTreeMap<String, String>>,
    }

    impl Robot {
        pub fn new() -> Rc<Self> {
            let robot = Self::default();
            for (path, value) in [
                ("motors/M3/value", "40"),
                ("motors/M4/value", "-60"),
                ("servos/S1/value", "30"),
                ("servos/S1/power", "1"),
                ("servos/S1/units", "deg"),
                ("servos/S2/value", "5"),
            ] {
                let mut files = robot.files.borrow_mut();
                files.insert(path.to_owned(), value.to_owned());
            }
            Rc::new(robot)
        }

        pub fn value(&self, path: &str) -> String {
            self.files.borrow()[path].trim().to_owned()
        }
    }

    impl Answers for Robot {
        fn has(&self, directory: &str) -> bool {
            self.is_file(&format!("{directory}/value"))
        }

        fn is_file(&self, path: &str) -> bool {
            self.files.borrow().contains_key(path)
        }

        fn names(&self, directory: &str) -> Vec<String> {
            match directory {
                "motors" => ["M3", "M4"].map(str::to_owned).to_vec(),
                _ => ["S1", "S2"].map(str::to_owned).to_vec(),
            }
        }

        fn read(&self, path: &str) -> io::Result<String> {
            let files = self.files.borrow();
            let value = files.get(path).cloned();
            value.ok_or_else(|| io::ErrorKind::NotFound.into())
        }

        fn write(&self, path: &str, text: &str) -> io::Result<()> {
            if self.fails.get() && path == "motors/M3/value" {
                return Err(io::Error::from_raw_os_error(libc::EIO));
            }
            let mut files = self.files.borrow_mut();
            files.insert(path.to_owned(), text.to_owned());
            Ok(())
        }

        fn now_us(&self) -> u128 {
            0
        }
    }

    #[test]
    fn one_that_fails_keeps_no_other_from_its_rest_and_rests_later() {
        let robot = Robot::new();
        let brick = Brick::answered(robot.clone());
        let mut resting = Resting::default();
        robot.fails.set(true);
        let moving = resting.hold(&brick).unwrap_err();
        assert!(moving.to_string().starts_with("M3 does not"), "{moving}");
        let values = ["motors/M3/value", "motors/M4/value", "servos/S1/power"];
        assert_eq!(values.map(|path| robot.value(path)), ["40", "0", "0"]);
        robot.fails.set(false);
        resting.hold(&brick).unwrap();
        assert_eq!(robot.value("motors/M3/value"), "0");
        robot
            .files
            .borrow_mut()
            .insert("motors/M4/value".to_owned(), "7".to_owned());
        resting.go_on(&brick);
        let values = ["motors/M3/value", "motors/M4/value", "servos/S1/value"];
        assert_eq!(values.map(|path| robot.value(path)), ["40", "7", "30"]);
    }
}
