//! Programs that run: the traces and the small cases of the language, on a robot by script.

mod lacking;
mod micro;
mod rules;
mod traces;

use super::fixtures::{diagram, project};
use super::trace::{Deaf, Trace};
use super::*;
use crate::blocks;
use crate::lower::lower;
use crate::project::{DiagramKind, Project};
use std::collections::BTreeSet;
use std::fmt::Write;

/// A robot whose readings a test writes.
#[derive(Default)]
pub(super) struct Script {
    pub readings: BTreeMap<&'static str, Vec<i32>>,
    pub commands: Vec<String>,
    pub mail: VecDeque<(Option<i32>, String)>,
    pub files: BTreeMap<String, String>,
    pub dice: i32,
    /// Ports that were asked.
    pub asked: BTreeSet<&'static str>,
}

impl Brick for Script {
    fn command(&mut self, command: Command<'_>) {
        self.commands.push(command.to_string());
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        self.asked.insert(port.name());
        self.readings.get(port.name())?.first().copied()
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        self.asked.insert(port.name());
        let found = self.readings.get(port.name());
        found.is_some_and(|found| {
            into.extend(found);
            true
        })
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        self.dice += 1;
        low + self.dice.rem_euclid(high - low + 1)
    }

    fn letter(&mut self) -> Option<(Option<i32>, String)> {
        self.mail.pop_front()
    }

    fn contents(&mut self, file: &str) -> Option<String> {
        self.files.get(file).cloned()
    }
}

/// Tokens and commands as lines, one for each instant that has any.
#[derive(Default)]
pub(super) struct Lines {
    pub program: Rc<Program>,
    pub lines: Vec<String>,
    at: Option<u32>,
}

impl Lines {
    fn add(&mut self, now: u32, part: String) {
        if self.at != Some(now) {
            self.at = Some(now);
            self.lines.push(format!("{now}: {part}"));
        } else if let Some(last) = self.lines.last_mut() {
            let _ = write!(last, "; {part}");
        }
    }
}

impl Trace for Lines {
    fn sent(&mut self, now: u32, from: NodeId, port: u8, value: &Value) {
        let node = self.program.node(from);
        let name = match node.port_name(port) {
            "OUT" => node.caption.to_string(),
            other => format!("{}.{other}", node.caption),
        };
        let value = match values::is_unit(value) {
            true => String::new(),
            false => format!(" {}", value.brief()),
        };
        self.add(now, name + &value);
    }

    fn told(&mut self, now: u32, command: &Command<'_>) {
        self.add(now, format!("[{command}]"));
    }

    fn trap(&mut self, now: u32, problem: &Problem) {
        self.add(now, format!("error: {problem}"));
    }
}

/// A machine of a program that has nothing wrong with it.
pub(super) fn machine(project: &Project) -> Machine {
    let lowered = lower(project);
    let told: Vec<String> = lowered.problems.iter().map(ToString::to_string).collect();
    assert!(!lowered.has_errors(), "{told:#?}");
    Machine::new(Rc::new(lowered.program))
}

/// Runs a program for a time, with the readings that a function gives at each moment; what it did, and how it ended.
pub(super) fn run(
    project: &Project,
    until_ms: u32,
    robot: &mut Script,
    mut readings: impl FnMut(u32, &mut Script),
) -> (Vec<String>, Status) {
    let mut machine = machine(project);
    let mut lines = Lines {
        program: machine.program().clone(),
        ..Lines::default()
    };
    let mut status = Status::Running;
    for now in (0..=until_ms).step_by(10) {
        readings(now, robot);
        status = machine.step(now, robot, &mut lines);
        if status != Status::Running {
            break;
        }
    }
    (lines.lines, status)
}

/// What the main diagram does with nobody plugged in.
pub(super) fn simply(text: &str, until_ms: u32) -> (Vec<String>, Status) {
    let main = diagram("main", DiagramKind::Main, text);
    run(
        &project(vec![main]),
        until_ms,
        &mut Script::default(),
        |_, _| {},
    )
}

/// A program that gets a token at each of some times from a sensor: readings by time.
pub(super) fn fed(text: &str, until_ms: u32, feed: &[(u32, i32)]) -> Vec<String> {
    let main = diagram("main", DiagramKind::Main, text);
    let mut robot = Script::default();
    robot.readings.insert("A1", vec![0]);
    let feed: BTreeMap<u32, i32> = feed.iter().copied().collect();
    let (lines, _) = run(&project(vec![main]), until_ms, &mut robot, |now, robot| {
        if let Some(&value) = feed.get(&now) {
            robot.readings.insert("A1", vec![value]);
        }
    });
    lines
}

#[test]
fn ports_of_sources_are_those_of_the_table() {
    let number = |element: &str, port: &str| blocks::find(element).and_then(|row| row.port(port));
    assert_eq!(number("DFSensorVarBlock", "OUT"), Some(sensors::SENSOR_OUT));
    assert_eq!(
        number("DFDetectByVideoBlock", "OUT"),
        Some(sensors::SENSOR_OUT)
    );
    assert_eq!(number("ReceiveMsg", "OUT"), Some(sensors::SENSOR_OUT));
    assert_eq!(
        number("DFEncodersBlock", "E1_OUT"),
        Some(sensors::ENCODER_OUT)
    );
    assert_eq!(number("DFGamepadBlock", "PAD"), Some(sensors::PAD_OUT));
    assert_eq!(
        number("DFGamepadBlock", "BUTTON"),
        Some(sensors::BUTTON_OUT)
    );
    assert_eq!(number("DFGamepadBlock", "WHEEL"), Some(sensors::WHEEL_OUT));
}

#[test]
fn nobody_who_looks_changes_nothing() {
    let main = diagram(
        "main",
        DiagramKind::Main,
        "L Loop {end_border=3}\nW Say\nL.OUT > W.DATA",
    );
    let project = project(vec![main]);
    let mut heard = Script::default();
    let (_, status) = run(&project, 2000, &mut heard, |_, _| {});
    let (mut machine, mut deaf) = (machine(&project), Script::default());
    let mut now = 0;
    while machine.step(now, &mut deaf, &mut Deaf) == Status::Running {
        now += 10;
    }
    assert_eq!(machine.status(), status);
    assert_eq!(deaf.commands, heard.commands);
}
