//! Motors: the attributes of the classes tacho-motor and dc-motor over one [`Driver`].
//!
//! Owns which attributes there are and what texts they take. `command` has what can be said to a motor, `control` decides
//! what it does, by its `shaft`, and `driver` does it.

pub mod command;
pub mod control;
pub mod driver;
mod shaft;

use crate::device::{
    Attribute, Changes, Device, KernelSlot, Shown, line, no_such_word, number_within, read,
    read_write, whole_number, write,
};
use crate::limits::{DC_RAMP_MS_MAX, RAMP_MS_MAX};
use crate::tree::Tree;
use command::{Command, Gains, Polarity, StopAction};
use control::Control;
use driver::{Driver, Paths};
use std::sync::Arc;
use trikfs::errno::Error;

/// What a dc-motor counts as its greatest speed: percent.
const DC_MAX_SPEED: i32 = 100;
/// Counts of a turn: encoders of the tree are in degrees.
const COUNT_PER_ROT: i32 = 360;

const TACHO: [Attribute; 27] = [
    read("address"),
    write("command"),
    read("commands"),
    read("count_per_rot"),
    read("driver_name"),
    read("duty_cycle"),
    read_write("duty_cycle_sp"),
    read_write("hold_pid/Kd"),
    read_write("hold_pid/Ki"),
    read_write("hold_pid/Kp"),
    read("max_speed"),
    read_write("polarity"),
    read_write("position"),
    read_write("position_sp"),
    read_write("ramp_down_sp"),
    read_write("ramp_up_sp"),
    read("speed"),
    read_write("speed_pid/Kd"),
    read_write("speed_pid/Ki"),
    read_write("speed_pid/Kp"),
    read_write("speed_sp"),
    read("state"),
    read_write("stop_action"),
    read("stop_actions"),
    read_write("time_sp"),
    read("fault"),
    read_write("encoder_polarity"),
];

const DC: [Attribute; 14] = [
    read("address"),
    write("command"),
    read("commands"),
    read("driver_name"),
    read("duty_cycle"),
    read_write("duty_cycle_sp"),
    read_write("polarity"),
    read_write("ramp_down_sp"),
    read_write("ramp_up_sp"),
    read("state"),
    read_write("stop_action"),
    read("stop_actions"),
    read_write("time_sp"),
    read("fault"),
];

const TACHO_COMMANDS: [(&str, Command); 7] = [
    ("run-forever", Command::RunForever),
    ("run-to-abs-pos", Command::RunToAbsPos),
    ("run-to-rel-pos", Command::RunToRelPos),
    ("run-timed", Command::RunTimed),
    ("run-direct", Command::RunDirect),
    ("stop", Command::Stop),
    ("reset", Command::Reset),
];

const DC_COMMANDS: [(&str, Command); 4] = [
    ("run-forever", Command::RunForever),
    ("run-timed", Command::RunTimed),
    ("run-direct", Command::RunDirect),
    ("stop", Command::Stop),
];

const STOP_ACTIONS: [(&str, StopAction); 3] = [
    ("coast", StopAction::Coast),
    ("brake", StopAction::Brake),
    ("hold", StopAction::Hold),
];

const POLARITIES: [(&str, Polarity); 2] = [
    ("normal", Polarity::Normal),
    ("inversed", Polarity::Inversed),
];

/// A motor of the tree, with its encoder or without one.
pub struct Motor {
    address: String,
    has_encoder: bool,
    max_speed: i32,
    driver: Arc<Driver>,
}

impl Motor {
    /// A motor that stands on this port. With an encoder it is a tacho-motor, else a dc-motor; `max_speed` is of the former.
    pub fn new(
        tree: Tree,
        address: String,
        paths: Paths,
        max_speed: i32,
        kernel: KernelSlot,
    ) -> Self {
        let has_encoder = paths.encoder.is_some();
        let max_speed = if has_encoder { max_speed } else { DC_MAX_SPEED };
        let control = Control::new(has_encoder, max_speed);
        Self {
            address,
            has_encoder,
            max_speed,
            driver: Driver::new(tree, paths, control, Changes::new(kernel)),
        }
    }

    fn commands(&self) -> &'static [(&'static str, Command)] {
        if self.has_encoder {
            &TACHO_COMMANDS
        } else {
            &DC_COMMANDS
        }
    }

    fn stop_actions(&self) -> &'static [(&'static str, StopAction)] {
        let without_hold = STOP_ACTIONS.len() - 1;
        if self.has_encoder {
            &STOP_ACTIONS
        } else {
            &STOP_ACTIONS[..without_hold]
        }
    }

    fn ramp(&self, attribute: &str, text: &str) -> Result<i32, Error> {
        let longest = if self.has_encoder {
            RAMP_MS_MAX
        } else {
            DC_RAMP_MS_MAX
        };
        number_within(attribute, text, 0, longest)
    }

    /// Changes what the next command, or a power that is direct, takes.
    fn set(&self, change: impl FnOnce(&mut Control)) -> Result<(), Error> {
        change(&mut self.driver.control());
        Ok(())
    }

    fn set_gain(&self, attribute: &str, text: &str) -> Result<(), Error> {
        let value = number_within(attribute, text, 0, i32::MAX)?;
        self.set(|control| *gain(gains(control, attribute), attribute) = value)
    }
}

/// The gains of an attribute `speed_pid/...` or `hold_pid/...`.
fn gains<'a>(control: &'a mut Control, attribute: &str) -> &'a mut Gains {
    if attribute.starts_with("hold") {
        &mut control.hold_gains
    } else {
        &mut control.speed_gains
    }
}

fn gain<'a>(gains: &'a mut Gains, attribute: &str) -> &'a mut i32 {
    match attribute.rsplit('/').next() {
        Some("Kp") => &mut gains.kp,
        Some("Ki") => &mut gains.ki,
        _ => &mut gains.kd,
    }
}

/// The value of a word in a list of them.
fn meaning<T: Copy>(words: &[(&str, T)], attribute: &str, text: &str) -> Result<T, Error> {
    words
        .iter()
        .find(|(word, _)| *word == text)
        .map(|(_, value)| *value)
        .ok_or_else(|| no_such_word(attribute, text))
}

/// The word of a value.
fn word<T: Copy + PartialEq>(words: &[(&'static str, T)], value: T) -> &'static str {
    words
        .iter()
        .find(|(_, other)| *other == value)
        .map_or("", |(word, _)| word)
}

/// All words, with one space between.
fn list<T>(words: &[(&str, T)]) -> String {
    words
        .iter()
        .map(|(word, _)| *word)
        .collect::<Vec<_>>()
        .join(" ")
}

impl Device for Motor {
    fn attributes(&self) -> &'static [Attribute] {
        if self.has_encoder { &TACHO } else { &DC }
    }

    fn show(&self, attribute: &str) -> Result<Shown, Error> {
        let setpoints = self.driver.control().setpoints;
        match attribute {
            "address" => line(&self.address),
            "commands" => line(list(self.commands())),
            "count_per_rot" => line(COUNT_PER_ROT),
            // What python-ev3dev2 and others look for: a motor that counts degrees.
            "driver_name" if self.has_encoder => line("lego-ev3-l-motor"),
            "driver_name" => line("trik-dc-motor"),
            "duty_cycle" => line(self.driver.control().duty_cycle()),
            "duty_cycle_sp" => line(setpoints.duty_cycle),
            "encoder_polarity" => Err(Error::Unsupported),
            "fault" => line(self.driver.fault()),
            "max_speed" => line(self.max_speed),
            "polarity" => line(word(&POLARITIES, setpoints.polarity)),
            "position" => self.driver.position().and_then(line),
            "position_sp" => line(setpoints.position),
            "ramp_down_sp" => line(setpoints.ramp_down),
            "ramp_up_sp" => line(setpoints.ramp_up),
            "speed" => self.driver.speed().and_then(line),
            "speed_sp" => line(setpoints.speed),
            "state" => line(self.driver.control().flags().text()),
            "stop_action" => line(word(&STOP_ACTIONS, setpoints.stop_action)),
            "stop_actions" => line(list(self.stop_actions())),
            "time_sp" => line(setpoints.time),
            _ if attribute.contains('/') => {
                let mut control = self.driver.control();
                line(*gain(gains(&mut control, attribute), attribute))
            }
            _ => Err(Error::NotFound),
        }
    }

    fn store(&self, attribute: &str, text: &str) -> Result<(), Error> {
        let name = attribute;
        match name {
            "command" => self.driver.command(meaning(self.commands(), name, text)?),
            "duty_cycle_sp" => {
                let percent = number_within(name, text, -100, 100)?;
                self.set(|control| control.setpoints.duty_cycle = percent)?;
                self.driver.hurry();
                Ok(())
            }
            "encoder_polarity" => Err(Error::Unsupported),
            "polarity" => {
                let polarity = meaning(&POLARITIES, name, text)?;
                self.set(|control| control.setpoints.polarity = polarity)
            }
            "position" => self.driver.set_position(whole_number(name, text)?),
            "position_sp" => {
                let position = whole_number(name, text)?;
                self.set(|control| control.setpoints.position = position)
            }
            "ramp_down_sp" => {
                let ms = self.ramp(name, text)?;
                self.set(|control| control.setpoints.ramp_down = ms)
            }
            "ramp_up_sp" => {
                let ms = self.ramp(name, text)?;
                self.set(|control| control.setpoints.ramp_up = ms)
            }
            "speed_sp" => {
                let speed = number_within(name, text, -self.max_speed, self.max_speed)?;
                self.set(|control| control.setpoints.speed = speed)
            }
            "stop_action" => {
                let action = meaning(self.stop_actions(), name, text)?;
                self.set(|control| control.setpoints.stop_action = action)
            }
            "time_sp" => {
                let ms = number_within(name, text, 0, i32::MAX)?;
                self.set(|control| control.setpoints.time = ms)
            }
            _ if name.contains('/') => self.set_gain(name, text),
            _ => Err(Error::AccessDenied),
        }
    }

    fn rest(&self, why: &str) -> bool {
        self.driver.rest(why)
    }

    fn changes(&self, attribute: &str) -> Option<&Arc<Changes>> {
        (attribute == "state").then(|| self.driver.changes())
    }
}

impl Drop for Motor {
    fn drop(&mut self) {
        self.driver.retire();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motor(has_encoder: bool) -> Motor {
        let paths = Paths {
            power: "motors/M1/value".to_owned(),
            encoder: has_encoder.then(|| "encoders/E1".to_owned()),
        };
        let tree = Tree::new("/nowhere".into());
        Motor::new(
            tree,
            "outA:M1".to_owned(),
            paths,
            1000,
            KernelSlot::default(),
        )
    }

    fn shown(motor: &Motor, attribute: &str) -> String {
        let bytes = motor.show(attribute).map(Shown::into_bytes);
        String::from_utf8(bytes.expect(attribute)).expect("a text")
    }

    #[test]
    fn what_is_stored_is_shown_and_what_cannot_be_changes_nothing() {
        let motor = motor(true);
        for (attribute, good, bad) in [
            ("duty_cycle_sp", "-100", ["-101", "1.5", ""]),
            ("speed_sp", "1000", ["1001", "fast", "1 2"]),
            ("position_sp", "-720", ["x", "0x7", "2147483648"]),
            ("time_sp", "1500", ["-1", "1s", "+"]),
            ("ramp_up_sp", "60000", ["60001", "-1", " 1"]),
            ("ramp_down_sp", "0", ["60001", "-1", "0 "]),
            ("polarity", "inversed", ["Normal", "", "inverse"]),
            ("stop_action", "hold", ["holds", "coast brake", "1"]),
            ("speed_pid/Kp", "7", ["-1", "1.0", "p"]),
            ("hold_pid/Kd", "8", ["-1", "1.0", "d"]),
        ] {
            motor.store(attribute, good).expect(attribute);
            for text in bad {
                let error = motor.store(attribute, text).expect_err(text);
                assert!([libc::EINVAL, libc::ERANGE].contains(&error.errno()));
            }
            assert_eq!(shown(&motor, attribute), format!("{good}\n"), "{attribute}");
        }
        assert_eq!(
            motor.store("command", "go").unwrap_err().errno(),
            libc::EINVAL
        );
        assert_eq!(shown(&motor, "state"), "\n");
    }

    #[test]
    fn a_command_without_a_tree_is_refused_and_nothing_runs() {
        for motor in [motor(true), motor(false)] {
            let error = motor.store("command", "run-forever").unwrap_err();
            assert_eq!(error.errno(), libc::ENODEV);
            assert_eq!(shown(&motor, "state"), "\n");
        }
    }

    #[test]
    fn a_motor_without_encoder_has_what_it_can_do() {
        let motor = motor(false);
        assert_eq!(
            shown(&motor, "commands"),
            "run-forever run-timed run-direct stop\n"
        );
        assert_eq!(shown(&motor, "stop_actions"), "coast brake\n");
        assert!(motor.store("stop_action", "hold").is_err());
        assert!(motor.store("command", "reset").is_err());
        assert!(
            motor
                .attributes()
                .iter()
                .all(|attribute| attribute.name != "position")
        );
    }

    #[test]
    fn everything_that_can_be_read_is_shown() {
        for motor in [motor(true), motor(false)] {
            for attribute in motor.attributes() {
                if attribute.access == crate::device::Access::Write {
                    continue;
                }
                let needs_tree = ["position", "speed"].contains(&attribute.name);
                match motor.show(attribute.name) {
                    Ok(_) => assert!(!needs_tree, "{}", attribute.name),
                    Err(Error::NoDevice(_)) => assert!(needs_tree, "{}", attribute.name),
                    Err(Error::Unsupported) => assert_eq!(attribute.name, "encoder_polarity"),
                    Err(error) => panic!("{}: {error}", attribute.name),
                }
            }
        }
    }
}
