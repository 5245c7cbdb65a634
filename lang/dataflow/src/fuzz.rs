//! Arbitrary bytes as data-flow programs: nothing but time and memory within limits may go.
//!
//! Run by tests with random bytes, and by any fuzzer.

use crate::blocks::{self, Content};
use crate::check::check;
use crate::generate::{Target, generate};
use crate::machine::Machine;
use crate::machine::trace::{Deaf, Trace};
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Policy, Project};
use crate::{read, save, show, text};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::Status;
use lang_diagram::ports::Port;
use lang_text::problem::Locale;
use std::rc::Rc;

mod debugging;
mod edits;

pub use debugging::debugging;
pub use edits::{edits, edits_of};

/// Instants that a program runs here.
const INSTANTS: u32 = 60;
/// Words that properties are made of: numbers, expressions, names, and what is none of these.
const WORDS: [&str; 32] = [
    "",
    "0",
    "1",
    "-1",
    "10",
    "20",
    "100",
    "1e9",
    "-2147483648",
    "0.5",
    "true",
    "false",
    "[1, 2]",
    "I0",
    "I0 + I1",
    "data > 0",
    "data*2",
    "{I0, 1}",
    "I0[0]",
    "x = I0",
    "x",
    "x = x + 1",
    "1/0",
    "sensorA1",
    "sensorD1",
    "lineSensor",
    "M3",
    "E3",
    "red",
    "line",
    "'a' .. 'b'",
    "random(3)",
];

/// Bytes that become choices, 0 when they are used up.
struct Choices<'a>(&'a [u8]);

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        match self.0.split_first() {
            Some((&first, rest)) => {
                self.0 = rest;
                first
            }
            None => 0,
        }
    }

    fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count.max(1)
    }
}

/// A project made of bytes: blocks of all rows, edges between ports that are there and some that are not.
pub fn project(bytes: &[u8]) -> Project {
    let mut choices = Choices(bytes);
    let rows: Vec<_> = blocks::table().collect();
    let diagrams = 1 + choices.below(3);
    let diagrams = (0..diagrams).map(|at| {
        let count = choices.below(12);
        let blocks: Vec<Block> = (0..count)
            .map(|place| block(&mut choices, &rows, (at, place), diagrams))
            .collect();
        let edges = choices.below(24);
        let edges = (0..edges)
            .map(|place| edge(&mut choices, &blocks, (at, place)))
            .collect();
        Diagram {
            id: id(element(at), at, 0),
            logical: called(at),
            kind: match at {
                0 => DiagramKind::Main,
                _ => DiagramKind::Subprogram,
            },
            name: format!("d{at}"),
            blocks,
            edges,
        }
    });
    Project {
        diagrams: diagrams.collect(),
        main: Some(0),
        ..Project::default()
    }
}

fn id(element: &str, diagram: usize, place: usize) -> String {
    format!("qrm:/RobotsDataFlowMetamodel/RobotsDataFlowDiagram/{element}/{diagram}-{place}")
}

fn element(diagram: usize) -> &'static str {
    match diagram {
        0 => read::MAIN,
        _ => read::SUBPROGRAM,
    }
}

/// Logical id of a diagram.
fn called(diagram: usize) -> String {
    format!("{}-logical", id(element(diagram), diagram, 0))
}

fn block(
    choices: &mut Choices<'_>,
    rows: &[&'static blocks::Row],
    (at, place): (usize, usize),
    diagrams: usize,
) -> Block {
    let row = rows[choices.below(rows.len())];
    let mut properties = std::collections::BTreeMap::new();
    for property in row.properties {
        if choices.byte() & 1 == 1 {
            let word = word(choices, property.content);
            properties.insert(property.name.to_owned(), word.to_owned());
        }
    }
    let target = choices.below(diagrams);
    Block {
        id: id(row.element, at, place),
        logical: format!("{}-logical", id(row.element, at, place)),
        row: Some(row),
        element: row.element.to_owned(),
        name: format!("b{place}"),
        properties,
        position: (f64::from(choices.byte()), f64::from(choices.byte())),
        calls: (row.does == blocks::Does::Call).then(|| called(target)),
    }
}

/// The text of a property: most often one that it may have.
fn word(choices: &mut Choices<'_>, content: Content) -> &'static str {
    if choices.byte() == 255 {
        return WORDS[choices.below(WORDS.len())];
    }
    let fitting: &[&'static str] = match content {
        Content::Expression => &[
            "I0", "1", "{1, 2}", "x = 1; x", "data", "I0 * 2", "'a'", "0.5",
        ],
        Content::Truth => &["true", "false", "data > 0", "data == 3", ""],
        Content::Whole => &["0", "10", "x = 4; x", "random(5)"],
        Content::Variables => &["x = 1", "x", "x; y", "x = x + 1"],
        Content::Evaluated | Content::Raw => &["", "1 + 1", "text", "line"],
        Content::Constant => &[
            "1",
            "-3",
            "2.5",
            "true",
            "[1, 2]",
            "[1, 2, 3, 4]",
            "word",
            "",
        ],
        Content::Number => &["0", "1", "10", "30", "100", "-1", "2.6"],
        Content::Flag => &["true", "false"],
        Content::Choice(choices) => choices,
        Content::Sensor => &[
            "sensorA1",
            "sensorD2",
            "lineSensor",
            "gyroscope",
            "encoder3",
        ],
        Content::Port => &["M1", "M4", "E3", "A1", "LineSensorPort"],
    };
    fitting[choices.below(fitting.len())]
}

fn edge(choices: &mut Choices<'_>, blocks: &[Block], (at, place): (usize, usize)) -> Edge {
    let mut end = |way: blocks::Direction| {
        let block = choices.below(blocks.len());
        let row = blocks.get(block)?.row?;
        let ports = (0..).zip(row.ports).filter(|(_, port)| port.way == way);
        let ports: Vec<i32> = ports.map(|(port, _)| port).collect();
        let strange = choices.byte() == 255;
        let port = match ports.get(choices.below(ports.len())) {
            Some(&port) if !strange => port,
            _ => i32::from(choices.byte()) - 3,
        };
        Some(End { block, port })
    };
    let (from, to) = (end(blocks::Direction::Out), end(blocks::Direction::In));
    let policy = Policy::ALL.get(choices.below(8)).copied();
    Edge {
        id: id("Edge", at, place),
        from,
        to,
        policy,
        capacity: policy.map(|_| u16::from(choices.byte())),
        path: Vec::new(),
        gone: None,
    }
}

/// A robot that says what bytes say, and holds what it is told against the bounds of devices.
struct Robot<'a> {
    choices: Choices<'a>,
    told: u64,
}

impl<'a> Robot<'a> {
    fn new(readings: &'a [u8]) -> Self {
        Self {
            choices: Choices(readings),
            told: 0,
        }
    }
}

impl Brick for Robot<'_> {
    fn command(&mut self, command: Command<'_>) {
        self.told = self
            .told
            .wrapping_mul(31)
            .wrapping_add(command.to_string().len() as u64);
        if let Command::Power { percent, .. } = command {
            assert!((-100..=100).contains(&percent), "a power of {percent}");
        }
    }

    fn scalar(&mut self, _port: Port) -> Option<i32> {
        let byte = self.choices.byte();
        (byte != 254).then(|| i32::from(byte) - 100)
    }

    fn vector(&mut self, _port: Port, into: &mut Vec<i32>) -> bool {
        into.extend([1, 2, 3]);
        true
    }

    fn random(&mut self, low: i32, _high: i32) -> i32 {
        low
    }

    fn contents(&mut self, _file: &str) -> Option<String> {
        Some("one two\nthree".to_owned())
    }
}

/// Counts what happens, so that two runs can be compared.
#[derive(Default)]
struct Count {
    sent: u64,
    fired: u64,
    lost: u64,
}

impl Count {
    fn all(&self) -> [u64; 3] {
        [self.sent, self.fired, self.lost]
    }
}

impl Trace for Count {
    fn sent(&mut self, now: u32, from: u32, port: u8, value: &lang_expr::Value) {
        let text = value.brief();
        let seen = u64::from(now) ^ u64::from(from) << 8 ^ u64::from(port) ^ text.len() as u64;
        self.sent = self.sent.wrapping_mul(31).wrapping_add(seen);
    }

    fn fired(&mut self, _now: u32, node: u32) {
        self.fired = self.fired.wrapping_mul(31).wrapping_add(u64::from(node));
    }

    fn dropped(&mut self, _now: u32, _at: crate::program::Target) {
        self.lost += 1;
    }
}

fn outcome(program: &Rc<crate::program::Program>, readings: &[u8]) -> (Status, u64, [u64; 3]) {
    let mut robot = Robot::new(readings);
    let mut count = Count::default();
    let mut machine = Machine::new(program.clone());
    for step in 0..INSTANTS {
        machine.step(step * 10, &mut robot, &mut count);
    }
    let status = machine.status();
    machine.stop(&mut robot, &mut Deaf);
    (status, robot.told, count.all())
}

/// A program becomes a converter in both languages, or is refused with reasons; a list may be too long for C alone.
fn written(program: &crate::program::Program) {
    let both = Target::ALL.map(|target| generate(program, target));
    let [lua, c] = &both;
    assert!(lua.is_ok() || c.is_err());
    for text in both.iter().flatten() {
        assert!(text.ends_with('\n'));
    }
    for problems in both.iter().filter_map(|one| one.as_ref().err()) {
        assert!(!problems.is_empty());
    }
}

/// A project of bytes is checked, written in both forms and read again, and runs twice alike if it may run; whether it may.
pub fn program(bytes: &[u8]) -> bool {
    let project = project(bytes);
    let checked = check(&project);
    let again = text::read(&text::write(&project));
    if let Ok(again) = &again {
        assert_eq!(text::write(again), text::write(&project));
    }
    for locale in [Locale::English, Locale::Russian] {
        show::sentences(&project, show::Extent::default(), locale);
    }
    if checked.has_errors() {
        return false;
    }
    let program = Rc::new(checked.program);
    written(&program);
    let one = outcome(&program, bytes);
    assert_eq!(
        one,
        outcome(&program, bytes),
        "a program does the same twice"
    );
    // What was written and read again does the same as well.
    if let Ok(again) = again {
        let other = check(&again);
        assert!(!other.has_errors(), "{:?}", other.problems);
        assert_eq!(one, outcome(&Rc::new(other.program), bytes));
    }
    true
}

/// Bytes as a program in its textual form.
pub fn source(bytes: &[u8]) {
    if let Ok(source) = std::str::from_utf8(bytes)
        && let Ok(project) = text::read(source)
    {
        let written = text::write(&project);
        let again = text::read(&written).map(|again| text::write(&again));
        assert_eq!(again.as_deref(), Ok(written.as_str()));
        check(&project);
    }
}

/// Bytes as a save.
pub fn reader(bytes: &[u8]) {
    let Ok(opened) = lang_diagram::read::read(bytes) else {
        return;
    };
    let (project, _) = read::project(&opened.save);
    check(&project);
    let _ = save::save(&project).write();
}

#[cfg(test)]
mod tests;
