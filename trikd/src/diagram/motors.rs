//! Motors of a diagram while a debugger holds it: they rest, and come back as they were when it goes on.
//!
//! Owns what each motor was told last, and stands between the program and its robot for that. Knows no files, no debugger
//! and no time: the caller that steps the program says when motors rest.

use lang_diagram::brick::{Answer, Brick, Command, Question};
use lang_diagram::ports::Port;
use lang_text::problem::Problem;
use std::collections::BTreeMap;

/// What a motor does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Setpoint {
    Power(i32),
    Servo(i32),
}

/// What the program wants of its motors.
#[derive(Debug, Default)]
pub(super) struct Motors {
    /// Those that are not off.
    told: BTreeMap<Port, Setpoint>,
    are_at_rest: bool,
}

impl Motors {
    /// The robot as the program sees it. While motors rest, what they are told is kept for later.
    pub(super) fn over<'a>(&'a mut self, robot: &'a mut dyn Brick) -> Driven<'a> {
        Driven {
            motors: self,
            robot,
        }
    }

    /// Brings them to rest, or lets them do again what the program wants; does nothing if that is so already.
    pub(super) fn settle(&mut self, shall_rest: bool, robot: &mut dyn Brick) {
        if shall_rest == self.are_at_rest {
            return;
        }
        self.are_at_rest = shall_rest;
        for (&port, told) in &self.told {
            robot.command(match (shall_rest, *told) {
                (true, _) => Command::Off { port, brake: false },
                (false, Setpoint::Power(percent)) => Command::Power { port, percent },
                (false, Setpoint::Servo(degrees)) => Command::Servo { port, degrees },
            });
        }
    }
}

/// A robot whose motors are noted.
pub(super) struct Driven<'a> {
    motors: &'a mut Motors,
    robot: &'a mut dyn Brick,
}

impl Driven<'_> {
    /// Notes what a motor is told; whether it has to wait for the end of the rest.
    fn note(&mut self, command: Command<'_>) -> bool {
        let Motors { told, are_at_rest } = &mut *self.motors;
        match command {
            Command::Power { port, percent } => {
                told.insert(port, Setpoint::Power(percent));
                *are_at_rest
            }
            Command::Servo { port, degrees } => {
                told.insert(port, Setpoint::Servo(degrees));
                *are_at_rest
            }
            Command::Off { port, .. } => {
                told.remove(&port);
                false
            }
            // The program has ended.
            Command::Rest => {
                told.clear();
                *are_at_rest = false;
                false
            }
            Command::ResetEncoder { .. }
            | Command::Sound { .. }
            | Command::Tone { .. }
            | Command::Say { .. }
            | Command::Led { .. }
            | Command::System { .. }
            | Command::Append { .. }
            | Command::Remove { .. }
            | Command::StartCamera { .. }
            | Command::StopCamera { .. }
            | Command::StartVideo { .. }
            | Command::StopVideo
            | Command::Detect { .. }
            | Command::Send { .. }
            | Command::Join { .. }
            | Command::CalibrateGyroscope
            | Command::Console { .. }
            | Command::PenColor { .. }
            | Command::PenWidth { .. }
            | Command::Background { .. }
            | Command::Draw(_)
            | Command::Label { .. }
            | Command::Smile { .. }
            | Command::ClearScreen
            | Command::Redraw
            | Command::MarkerDown { .. }
            | Command::MarkerUp => false,
        }
    }
}

impl Brick for Driven<'_> {
    fn command(&mut self, command: Command<'_>) {
        if !self.note(command) {
            self.robot.command(command);
        }
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        self.robot.scalar(port)
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        self.robot.vector(port, into)
    }

    fn locked(&mut self, port: Port) -> Option<i32> {
        self.robot.locked(port)
    }

    fn announced(&mut self) -> Option<(Port, i32)> {
        self.robot.announced()
    }

    fn random_of_function(&mut self, low: i32, high: i32) -> i32 {
        self.robot.random_of_function(low, high)
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        self.robot.random(low, high)
    }

    fn mail(&mut self) -> Option<String> {
        self.robot.mail()
    }

    fn ask(&mut self, question: Question<'_>) -> Answer {
        self.robot.ask(question)
    }

    fn may_ask_again(&mut self, question: Question<'_>) -> bool {
        self.robot.may_ask_again(question)
    }

    fn ask_again(&mut self, question: Question<'_>, why: &[Problem]) {
        self.robot.ask_again(question, why);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Notes what it is told.
    #[derive(Default)]
    struct Robot(Vec<String>);

    impl Brick for Robot {
        fn command(&mut self, command: Command<'_>) {
            self.0.push(command.to_string());
        }

        fn scalar(&mut self, _port: Port) -> Option<i32> {
            Some(27)
        }

        fn vector(&mut self, _port: Port, into: &mut Vec<i32>) -> bool {
            into.push(1);
            true
        }

        fn random(&mut self, low: i32, _high: i32) -> i32 {
            low
        }
    }

    fn port(name: &str) -> Port {
        Port::named(name).expect("a port")
    }

    fn power(name: &str, percent: i32) -> Command<'static> {
        let port = port(name);
        Command::Power { port, percent }
    }

    #[test]
    fn motors_rest_at_a_stop_and_come_back_as_they_were() {
        let (mut motors, mut robot) = (Motors::default(), Robot::default());
        let servo = port("E1");
        for command in [
            power("M1", 40),
            power("M2", -5),
            Command::Off {
                port: port("M2"),
                brake: true,
            },
            Command::Servo {
                port: servo,
                degrees: 30,
            },
        ] {
            motors.over(&mut robot).command(command);
        }
        robot.0.clear();
        motors.settle(true, &mut robot);
        motors.settle(true, &mut robot);
        let mut off = std::mem::take(&mut robot.0);
        off.sort();
        assert_eq!(off, ["off E1 float", "off M1 float"]);
        motors.settle(false, &mut robot);
        motors.settle(false, &mut robot);
        let mut again = std::mem::take(&mut robot.0);
        again.sort();
        assert_eq!(again, ["power M1 40", "servo E1 30"]);
    }

    #[test]
    fn what_motors_are_told_at_rest_counts_when_they_go_on_and_readings_go_through() {
        let (mut motors, mut robot) = (Motors::default(), Robot::default());
        motors.over(&mut robot).command(power("M1", 40));
        motors.settle(true, &mut robot);
        robot.0.clear();
        let mut driven = motors.over(&mut robot);
        driven.command(power("M1", 50));
        driven.command(power("M2", 60));
        driven.command(Command::Off {
            port: port("M2"),
            brake: false,
        });
        driven.command(Command::Console { text: "x" });
        assert_eq!(driven.scalar(port("A1")), Some(27));
        let mut numbers = Vec::new();
        assert!(driven.vector(port("A1"), &mut numbers) && numbers == [1]);
        assert_eq!(driven.random(3, 4), 3);
        assert_eq!(robot.0, ["off M2 float", "print \"x\""]);
        motors.settle(false, &mut robot);
        assert_eq!(robot.0[2..], ["power M1 50"]);
        motors.settle(true, &mut robot);
        motors.over(&mut robot).command(Command::Rest);
        robot.0.clear();
        motors.settle(false, &mut robot);
        assert!(robot.0.is_empty(), "nothing turns after the end");
    }
}
