//! Readings that are renewed every 20 ms, as the sensor variables of a diagram are.
//!
//! Owns what was read last. A program with text and the diagram that it was written from see the same numbers then; an
//! encoder that was just cleared is read anew.

use lang_diagram::brick::{Answer, Brick, Command, Question};
use lang_diagram::ports::Port;
use std::collections::BTreeMap;

/// How often readings are renewed, in milliseconds of model time.
const REFRESH_MS: u32 = 20;

/// What was read last, of each port that somebody has asked for.
#[derive(Debug, Default)]
pub struct Readings {
    scalars: BTreeMap<Port, Option<i32>>,
    vectors: BTreeMap<Port, Option<Vec<i32>>>,
}

/// A robot whose readings are as old as they are for a diagram.
pub struct Refreshed<'a> {
    robot: &'a mut dyn Brick,
    readings: &'a mut Readings,
}

fn read_vector(robot: &mut dyn Brick, port: Port) -> Option<Vec<i32>> {
    let mut numbers = Vec::new();
    robot.vector(port, &mut numbers).then_some(numbers)
}

impl Readings {
    /// The robot at a moment, in milliseconds since the first step of the program.
    pub fn of<'a>(&'a mut self, robot: &'a mut dyn Brick, now_ms: u32) -> Refreshed<'a> {
        if now_ms.is_multiple_of(REFRESH_MS) {
            for (port, reading) in &mut self.scalars {
                *reading = robot.scalar(*port);
            }
            for (port, reading) in &mut self.vectors {
                *reading = read_vector(robot, *port);
            }
        }
        self.again(robot)
    }

    /// The robot once more at the moment of the last [`Readings::of`].
    pub fn again<'a>(&'a mut self, robot: &'a mut dyn Brick) -> Refreshed<'a> {
        Refreshed {
            robot,
            readings: self,
        }
    }
}

impl Brick for Refreshed<'_> {
    fn command(&mut self, command: Command<'_>) {
        match command {
            Command::ResetEncoder { port } => {
                self.readings.scalars.remove(&port);
            }
            Command::Detect { .. } => self.readings.vectors.clear(),
            // No reading is another one at once after these.
            Command::Power { .. }
            | Command::Off { .. }
            | Command::Servo { .. }
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
            | Command::MarkerUp
            | Command::Rest => {}
        }
        self.robot.command(command);
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        let robot = &mut *self.robot;
        let scalars = &mut self.readings.scalars;
        *scalars.entry(port).or_insert_with(|| robot.scalar(port))
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        let robot = &mut *self.robot;
        let vectors = &mut self.readings.vectors;
        let reading = vectors
            .entry(port)
            .or_insert_with(|| read_vector(robot, port));
        into.extend(reading.iter().flatten());
        reading.is_some()
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
}
