//! What a program moves, lights and sounds.

use crate::tree::{Access, Node, Tree};
use std::io;
use std::rc::Rc;

/// Percent of a power motor.
const POWER_MAX: f64 = 100.0;
/// Degrees of a servo that turns to an angle.
const ANGLE_MAX: f64 = 90.0;

/// A power motor or a servo.
#[derive(Clone, Debug)]
pub struct Motor {
    power: Rc<Node>,
    shown: Rc<Node>,
    /// `brake` of a power motor, `power` of a servo.
    switch: Rc<Node>,
    is_servo: bool,
    greatest: f64,
}

impl Motor {
    pub(super) fn power_motor(tree: &Tree, directory: &str) -> Self {
        Self::new(tree, directory, "brake", POWER_MAX)
    }

    pub(super) fn servo(tree: &Tree, directory: &str) -> Self {
        let units = tree
            .node(&format!("{directory}/units"), Access::Read)
            .text();
        let turns_on = units.is_ok_and(|units| units == "%");
        let mut servo = Self::new(
            tree,
            directory,
            "power",
            if turns_on { POWER_MAX } else { ANGLE_MAX },
        );
        servo.is_servo = true;
        servo
    }

    fn new(tree: &Tree, directory: &str, switch: &str, greatest: f64) -> Self {
        let value = format!("{directory}/value");
        Self {
            power: tree.node(&value, Access::Write),
            shown: tree.node(&value, Access::Read),
            switch: tree.node(&format!("{directory}/{switch}"), Access::Write),
            is_servo: false,
            greatest,
        }
    }

    /// Whether it is a servo.
    pub fn is_servo(&self) -> bool {
        self.is_servo
    }

    /// Percent of a power motor or of a servo that turns on, degrees of other servos; cut to what is possible and
    /// rounded to a whole number. What is no number moves nothing: a power motor stands still, a servo stays where it is.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn set_power(&self, power: f64) -> io::Result<()> {
        if !power.is_finite() {
            return if self.is_servo {
                Ok(())
            } else {
                self.power.write("0\n")
            };
        }
        let wanted = power.clamp(-self.greatest, self.greatest).round();
        let done = self.power.write(&format!("{wanted:.0}\n"));
        match &done {
            // Some servos have nothing below the middle: as far as they go.
            Err(error) if self.is_servo && error.raw_os_error() == Some(libc::ERANGE) => {
                let end = if wanted < 0.0 { 0.0 } else { self.greatest };
                self.power.write(&format!("{end:.0}\n"))
            }
            Ok(()) | Err(_) => done,
        }
    }

    /// What was set last.
    ///
    /// # Errors
    /// Those of the tree; a servo that is off has no position.
    pub fn power(&self) -> io::Result<f64> {
        self.shown.number()
    }

    /// Lets a motor run out, switches a servo off.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn power_off(&self) -> io::Result<()> {
        if self.is_servo {
            self.switch.write("0\n")
        } else {
            self.power.write("0\n")
        }
    }

    /// Brakes until the next power; a servo is switched off.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn brake(&self) -> io::Result<()> {
        self.switch.write(if self.is_servo { "0\n" } else { "1\n" })
    }
}

/// The green and the red light.
#[derive(Clone, Debug)]
pub struct Led {
    green: Rc<Node>,
    red: Rc<Node>,
}

impl Led {
    pub(super) fn new(tree: &Tree) -> Self {
        Self {
            green: tree.node("led/green/value", Access::Write),
            red: tree.node("led/red/value", Access::Write),
        }
    }

    /// Switches both; together they are orange.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn set(&self, green: bool, red: bool) -> io::Result<()> {
        self.green.write(if green { "1\n" } else { "0\n" })?;
        self.red.write(if red { "1\n" } else { "0\n" })
    }
}

/// The loudspeaker.
#[derive(Clone, Debug)]
pub struct Sound {
    play: Rc<Node>,
    say: Rc<Node>,
    tone: Rc<Node>,
}

impl Sound {
    pub(super) fn new(tree: &Tree) -> Self {
        Self {
            play: tree.node("sound/play/value", Access::Write),
            say: tree.node("sound/say/value", Access::Write),
            tone: tree.node("sound/tone/value", Access::Write),
        }
    }

    /// Plays a file in the background.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn play(&self, path: &str) -> io::Result<()> {
        self.play.write(path)
    }

    /// Speaks a text in the background.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn say(&self, text: &str) -> io::Result<()> {
        self.say.write(text)
    }

    /// A tone in the background: Hz and milliseconds.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn tone(&self, hz: i32, ms: i32) -> io::Result<()> {
        self.tone.write(&format!("{hz} {ms}\n"))
    }
}
