//! Arbitrary bytes as a program in a debugger, orders to it and new versions of it: [`debugging`].
//!
//! Owns the small language of bytes that says orders, so that nearly all bytes mean something.

use super::{Choices, Count, Robot, project, word};
use crate::check::check;
use crate::debug::Desk;
use crate::machine::Machine;
use crate::machine::patch::Version;
use crate::program::Program;
use crate::project::Project;
use crate::{limits, text};
use lang_diagram::debug::again::Again;
use lang_diagram::debug::order::Order;
use lang_diagram::limits as common;
use lang_diagram::machine::{STEP_MS, Status};
use lang_text::json::is_json;
use lang_text::problem::Locale;
use std::rc::Rc;

/// How much of the past is kept: little, so that some of it is forgotten.
const HISTORY_BYTES: usize = 100_000;
/// Orders of one input.
const ORDERS: u32 = 60;
/// Steps between two orders at most.
const STEPS: usize = 30;
/// The longest answer: four lists that are cut, each with the one item more that has filled it, and what stands beside them.
const LONGEST_ANSWER: usize = 4 * (limits::TOLD_BYTES + limits::TOLD_CHARACTERS_MAX + 4096)
    + common::TOLD_LINES_BYTES
    + 4 * common::ORDER_BYTES_MAX;
/// An order, and what is put into it.
const FORMS: [&str; 40] = [
    "attach",
    "detach",
    "look",
    "pause",
    "continue",
    "step",
    "step into",
    "step out",
    "step over main",
    "until BLOCK",
    "back",
    "back into",
    "back out",
    "back continue",
    "back to TIME",
    "back start",
    "present",
    "hold main",
    "break BLOCK",
    "break BLOCK from 2\nif TEXT",
    "break BLOCK once",
    "break BLOCK disabled",
    "break BLOCK\nif data > TIME\nlog data is {data}, {TEXT}",
    "break BLOCK\nlog x is {TEXT}",
    "watch x",
    "watch n once",
    "watch x from 2\nif TEXT",
    "watch n\nlog n is {n}, {x}",
    "watch TEXT",
    "breakpoints after 1",
    "breakpoints",
    "clear all",
    "clear 1",
    "enable 1",
    "disable 1",
    "motors keep",
    "set n=TEXT",
    "set x=TEXT",
    "evaluate TEXT",
    "TEXT",
];
/// Texts that go far in conditions and expressions.
const TEXTS: [&str; 16] = [
    "n + x",
    "n > 3",
    "x == n",
    "n = 7",
    "x = n + 1; x",
    "data",
    "data % 2 == 1",
    "{n, x}",
    "l[0]",
    "'a' .. n",
    "abs(n) / 0",
    "sensorA1",
    "time()",
    "random(3)",
    "1 +",
    "set x=1",
];
/// Programs in which there is something to see. Projects of bytes alone seldom run.
const PROGRAMS: [&str; 6] = [
    "diagram main
  A: Sensor(VarName = sensorA1)
  V: Variable(variable = `n = 0; x = 2`)
  F: \"Text programming\"(IO0 = `n = n + 1; I0 * x`, IO1 = `l = {n, I0}; l`)
  I: If(condition = `data > 20`)
  M: Motors
  T: \"Text programming\"(IO0 = `k = I0[1]; k`)
  A.OUT -> F.I0
  F.O0 -> I.DATA
  I.TRUE -> M.M3
  I.FALSE -> M.M4
  F.O1 -> T.I0
",
    "diagram main
  L: Loop(start_border = 1, end_border = 8, time = 10)
  V: Variable(variable = `x = 0; n = 0`)
  F: \"Text programming\"(IO0 = `x = x + I0; n = x % 3; x`)
  W: \"Wait and send\"(time = 30, keep = true)
  M: Motors
  L.OUT -> F.I0
  F.O0 -> W.DATA
  W.OUT -> M.M3
",
    "diagram main
  V: Variable(variable = `x = 0; n = 1`)
  R: \"Random generator\"(fromNumber = n, toNumber = 5, repeatedly = true, time = 20)
  C: \"User block\" of sub
  D: \"User block\" of sub
  Z: \"Zip flows\"
  T: \"Text programming\"(IO0 = `l = I0; l[0]`)
  R.OUT -> C.I0
  R.OUT -> D.I0
  C.O0 -> Z.DATA1
  D.O0 -> Z.DATA2
  Z.OUT -> T.I0
subprogram sub
  I: \"Input port\"(identifier = I0)
  F: \"Text programming\"(IO0 = `x = x + 1; I0 + x`)
  O: \"Output port\"(identifier = O0)
  I.OUT -> F.I0
  F.O0 -> O.DATA
",
    "diagram main
  A: Sensor(VarName = sensorA1)
  B: Sensor(VarName = sensorD1)
  V: Variable(variable = `n = 0; x = 0`)
  P: \"Flow replacer\"(time = 50)
  I: If(condition = `data > 0`)
  F: \"Text programming\"(IO0 = `n = I0; 100 / I0`)
  M: Motors
  A.OUT -> P.DATA
  B.OUT -> I.DATA
  I.TRUE -> P.REPLACE_DATA
  P.OUT -> F.I0
  F.O0 -> M.M3
",
    "diagram main
  G: \"Value generator\"(varValue = 0)
  V: Variable(variable = `n = 0; x = 0`)
  F: \"Text programming\"(synch = false, IO0 = `n = n + 1; I0 + 1`)
  I: If(condition = `data < 40`)
  W: \"Wait and send\"(time = 10)
  E: Stop
  G.OUT -> F.I0 latest
  F.O0 -> I.DATA
  I.TRUE -> W.DATA
  W.OUT -> F.I0 latest
  I.FALSE -> E.IN1
",
    "diagram main
  A: Sensor(VarName = sensorA1)
  R: \"Message receiver\"
  V: Variable(variable = `n = 'a'; x = {1, 2}`)
  Z: \"Zip flows\"
  F: \"Text programming\"(IO0 = `n = n .. I0; n`, IO1 = `x`)
  S: Say
  A.OUT -> Z.DATA1 fifo 4
  A.OUT -> F.I0
  R.OUT -> Z.DATA2
  F.O0 -> S.DATA
",
];

/// A program of bytes: one of [`PROGRAMS`], most often with other properties, or all of it made of bytes.
fn program(bytes: &[u8]) -> Option<(Project, Program)> {
    let mut choices = Choices(bytes);
    let Some(text) = PROGRAMS.get(choices.below(PROGRAMS.len() + 2)) else {
        let project = project(choices.0);
        let checked = check(&project);
        return (!checked.has_errors()).then_some((project, checked.program));
    };
    let plain = text::read(text).unwrap_or_else(|problems| panic!("{problems:?}"));
    let mut changed = plain.clone();
    for _ in 0..choices.below(4) {
        let diagrams = changed.diagrams.len();
        let blocks = &mut changed.diagrams[choices.below(diagrams)].blocks;
        let count = blocks.len();
        let block = &mut blocks[choices.below(count)];
        let properties = block.row.map_or(&[][..], |row| row.properties);
        let which = choices.below(properties.len());
        if let Some(property) = properties.get(which) {
            let value = word(&mut choices, property.content).to_owned();
            block.properties.insert(property.name.to_owned(), value);
        }
    }
    let checked = check(&changed);
    if !checked.has_errors() {
        return Some((changed, checked.program));
    }
    let checked = check(&plain);
    assert!(!checked.has_errors(), "{:?}", checked.problems);
    Some((plain, checked.program))
}

/// A program under a debugger, its robot, and what has happened.
struct Debugged<'a> {
    desk: Desk,
    robot: Robot<'a>,
    count: Count,
    /// The caller's clock.
    now: u32,
    /// Whether somebody has changed the program or its variables, or what its robot says.
    is_changed: bool,
}

impl Debugged<'_> {
    /// What a program that is stopped leaves as it is.
    fn seen(&self) -> (u32, u64, u64, [u64; 3]) {
        let machine = self.desk.machine();
        let told = self.robot.told;
        (machine.now(), machine.reached(), told, self.count.all())
    }

    fn step(&mut self) {
        let held = self.desk.is_stopped().then(|| self.seen());
        let before = self.desk.machine().now();
        self.now += STEP_MS;
        self.desk.step(self.now, &mut self.robot, &mut self.count);
        let after = self.desk.machine().now();
        assert!((before..=before + STEP_MS).contains(&after), "{after}");
        if let Some(held) = held {
            assert!(self.desk.is_stopped(), "nobody has let it go on");
            assert_eq!(self.seen(), held, "it is stopped");
        }
    }

    fn order(&mut self, tag: u32, order: &str) {
        let answer = self.desk.order((tag, order));
        tells(&answer);
        assert!(answer.ends_with('}'), "{answer}");
        let is_done = answer.contains(&format!("\"to\":{tag},\"done\":true"));
        let is_refused = answer.contains(&format!("\"to\":{tag},\"done\":false"));
        assert!(is_done || is_refused, "{order}: {answer}");
        let sets = matches!(Order::parse(order), Ok(Order::Set(..)));
        self.is_changed |= is_done && sets;
    }

    /// Another program, or this one, in its place.
    fn patch(&mut self, own: &Project, script: &mut Choices<'_>) {
        let length = script.below(100).min(script.0.len());
        let (bytes, rest) = script.0.split_at(length);
        script.0 = rest;
        let other = match length {
            0 => None,
            _ => program(bytes).map(|(project, _)| project),
        };
        let Ok(version) = Version::of(other.as_ref().unwrap_or(own)) else {
            return;
        };
        let before = self.seen();
        // One that is refused has asked the robot for its sensors, which says something else afterwards.
        self.is_changed = true;
        if self.desk.patch(&version, &mut self.robot).is_err() {
            assert_eq!(self.seen(), before, "it was refused");
        }
    }

    /// What holds at any time.
    fn holds(&mut self) {
        for news in self.desk.news() {
            tells(&news);
        }
        let machine = self.desk.machine();
        assert!(machine.points().all().count() <= common::BREAKPOINTS_MAX);
        if let Some((_, bytes)) = self.desk.kept() {
            // A copy and the answers of some steps may come on top.
            let most = 10 * HISTORY_BYTES + 10 * machine.bytes();
            assert!(bytes < most, "{bytes}");
        }
    }
}

/// What goes out is JSON, and no longer than anybody expects.
fn tells(answer: &str) {
    assert!(answer.starts_with('{') && is_json(answer), "{answer}");
    assert!(answer.len() <= LONGEST_ANSWER, "{} bytes", answer.len());
}

/// Half of the bytes are a program, the rest orders, steps and versions; all of them are what the robot reads.
pub fn debugging(bytes: &[u8]) {
    let (made_of, script) = bytes.split_at(bytes.len() / 2);
    let Some((own, program)) = program(made_of) else {
        return;
    };
    let program = Rc::new(program);
    let machine = Machine::new(program.clone());
    let mut debugged = Debugged {
        desk: Desk::new(machine, Locale::English, HISTORY_BYTES),
        robot: Robot::new(bytes),
        count: Count::default(),
        now: 0,
        is_changed: false,
    };
    let mut script = Choices(script);
    if script.below(4) == 3 {
        debugged.desk.stop_first();
    }
    for tag in 0..ORDERS {
        match script.below(12) {
            0..3 => {
                for _ in 0..script.below(STEPS) {
                    debugged.step();
                }
            }
            3 => debugged.patch(&own, &mut script),
            4 => debugged.desk.left(),
            _ => {
                let order = order(&mut script, debugged.desk.machine().program());
                debugged.order(tag, &order);
            }
        }
        debugged.holds();
    }
    ends_alike(&mut debugged, &program, bytes);
}

fn order(script: &mut Choices<'_>, program: &Program) -> String {
    let form = FORMS[script.below(FORMS.len())];
    let id = |node: &crate::program::Node| node.id.to_string();
    let block = match form.contains("BLOCK") {
        true => program
            .nodes
            .get(script.below(program.nodes.len() + 1))
            .map(id),
        false => None,
    };
    let time = script.below(40) as u32 * STEP_MS;
    let text = match form.contains("TEXT") {
        true => some_text(script),
        false => String::new(),
    };
    form.replace("BLOCK", block.as_deref().unwrap_or("nowhere"))
        .replace("TIME", &time.to_string())
        .replace("TEXT", &text)
}

/// A text of the list, or the next bytes as they are.
fn some_text(script: &mut Choices<'_>) -> String {
    match TEXTS.get(script.below(TEXTS.len() + 4)) {
        Some(text) => (*text).to_owned(),
        None => {
            let length = script.below(40).min(script.0.len());
            let (bytes, rest) = script.0.split_at(length);
            script.0 = rest;
            String::from_utf8_lossy(bytes).into_owned()
        }
    }
}

/// A program that was only looked at has done what it does without a debugger.
fn ends_alike(debugged: &mut Debugged<'_>, program: &Rc<Program>, bytes: &[u8]) {
    if debugged.is_changed {
        return;
    }
    // An instant in which it is stopped comes to its end.
    debugged.desk.order((0, "attach"));
    debugged.desk.order((0, "detach"));
    debugged.step();
    let mut robot = Robot::new(bytes);
    let mut count = Count::default();
    let mut alone = Machine::new(program.clone());
    let until = debugged.desk.machine().now();
    for now in (0..=until).step_by(STEP_MS as usize) {
        alone.step(now, &mut robot, &mut count);
    }
    let machine = debugged.desk.machine();
    assert_eq!(machine.status(), alone.status());
    assert_eq!(debugged.robot.told, robot.told);
    assert_eq!(debugged.count.all(), count.all());
    if let Status::Ended { .. } = alone.status() {
        assert_eq!(machine.errors(), alone.errors());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_its_programs_may_run() {
        for text in PROGRAMS {
            let project = text::read(text).unwrap_or_else(|problems| panic!("{problems:?}"));
            let checked = check(&project);
            assert!(!checked.has_errors(), "{text}: {:?}", checked.problems);
        }
    }
}
