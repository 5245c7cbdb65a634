//! Arbitrary bytes as a project that is checked, lowered and run: [`lowering`].
//!
//! Owns the small language of bytes that says blocks, links and diagrams, so that nearly all bytes mean something.

use std::rc::Rc;

use crate::blocks::{self, Row};
use crate::check::check;
use crate::limits;
use crate::lower::{World, lower};
use crate::machine::trace::Deaf;
use crate::machine::{Machine, Options, STEP_MS, Status};
use crate::ports::Port;
use crate::project::{Argument, Block, Diagram, DiagramKind, Link, Project};
use crate::stand_in::{Placing, StandIn};
use lang_expr::Compat;

/// How many steps a program may run.
const STEPS: u32 = 60;
/// How many blocks and links one input may say.
const RECORDS: usize = 2000;
/// Texts that go far in properties and guards.
const TEXTS: &[&str] = &[
    "",
    "x",
    "1",
    "true",
    "false",
    "iteration",
    "main",
    "other",
    "0",
    "-7",
    "x = x + 1",
    "x = 1",
    "x > 0",
    "1 / 0",
    "M3, M4",
    "A1",
    "E3",
    "'x'",
    "\"'x = 1'\"",
    "time()",
    "random(5)",
    "greater",
    "equals",
    "cancel",
    "10",
    "20 * 3",
    "a[2] = x",
    "sensorA1",
    "gyroscope[6]",
    "1 +",
    "Up",
    "x .. x",
    "x = x .. x",
    "encoder3",
    "100000",
    "TRUE",
];

/// Reads numbers and texts out of bytes; nothing is left is 0 and empty.
pub(super) struct Bytes<'a>(pub &'a [u8]);

impl Bytes<'_> {
    pub fn next(&mut self) -> u8 {
        match self.0.split_first() {
            Some((&first, rest)) => {
                self.0 = rest;
                first
            }
            None => 0,
        }
    }

    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.next()) % count.max(1)
    }

    /// A text of the list, or the next bytes as they are.
    pub fn text(&mut self) -> String {
        let which = usize::from(self.next());
        match TEXTS.get(which % (TEXTS.len() + 1)) {
            Some(text) => (*text).to_owned(),
            None => {
                let length = self.below(24).min(self.0.len());
                let (text, rest) = self.0.split_at(length);
                self.0 = rest;
                String::from_utf8_lossy(text).into_owned()
            }
        }
    }
}

/// Bytes as a project. Indices of links may lead nowhere.
pub fn project(bytes: &[u8]) -> Project {
    let mut bytes = Bytes(bytes);
    let rows: Vec<&Row> = blocks::table().collect();
    let mut project = Project {
        main: Some(0),
        ..Project::default()
    };
    project.meta.insert(
        "lastKitId".into(),
        ["trikV62Kit", "trikV6Kit", "ev3Kit"][bytes.below(3)].into(),
    );
    project.diagrams.push(diagram(0, DiagramKind::Main));
    for _ in 0..RECORDS {
        if bytes.0.is_empty() {
            break;
        }
        let number = project.diagrams.len();
        let Some(last) = project.diagrams.last_mut() else {
            break;
        };
        match bytes.next() {
            0..=3 => project
                .diagrams
                .push(diagram(number, DiagramKind::Subprogram)),
            kind @ 4..=119 => {
                let row = rows.get(usize::from(kind - 4)).copied();
                let mut block = block(number, last.blocks.len(), row);
                if let Some(row) = row {
                    for property in row.properties {
                        if bytes.next() & 1 == 1 {
                            block.properties.insert(property.name.into(), bytes.text());
                        }
                    }
                }
                if block.kind == "Subprogram" {
                    block.calls = Some(format!("logical-{}", bytes.below(4)));
                    block.arguments.push(Argument {
                        name: bytes.text(),
                        kind: ["int", "bool", "float", "string"][bytes.below(4)].into(),
                        value: bytes.text(),
                    });
                }
                last.blocks.push(block);
            }
            _ => link(&mut bytes, last),
        }
    }
    project
}

fn diagram(number: usize, kind: DiagramKind) -> Diagram {
    Diagram {
        id: format!("diagram-{number}"),
        logical: format!("logical-{number}"),
        kind,
        name: format!("d{number}"),
        parameters: Vec::new(),
        blocks: vec![block(number, 0, blocks::find("InitialNode"))],
        links: Vec::new(),
    }
}

fn block(diagram: usize, number: usize, row: Option<&Row>) -> Block {
    Block {
        id: format!("block-{diagram}-{number}"),
        kind: row.map_or("Ev3EnginesForward", |row| row.kind).into(),
        name: "call".into(),
        ..Block::default()
    }
}

fn link(bytes: &mut Bytes<'_>, diagram: &mut Diagram) {
    let count = diagram.blocks.len();
    // One past the last block is a loose end.
    let (from, to) = (bytes.below(count), bytes.below(count + 1));
    let index = diagram.links.len();
    diagram.links.push(Link {
        id: format!("link-{index}"),
        guard: bytes.text(),
        from: Some(from),
        to: (to < count + usize::from(bytes.next() == 77)).then_some(to),
        path: Vec::new(),
    });
    diagram.blocks[from].outgoing.push(index);
    if let Some(block) = diagram.blocks.get_mut(to) {
        block.incoming.push(index);
    }
}

/// Bytes as a project that is checked, lowered and run for some steps, twice: both runs must do the same.
pub fn lowering(bytes: &[u8]) {
    let Some((&first, bytes)) = bytes.split_first() else {
        return;
    };
    let project = project(bytes);
    let world = [
        World::default(),
        World::Simulated {
            mailbox: true,
            gamepad: true,
        },
        World::Robot,
        World::Robot,
    ][usize::from(first & 3)];
    let options = Options {
        compat: [Compat::Studio, Compat::Fixed][usize::from(first >> 2 & 1)],
        in_turns: first >> 3 & 1 == 1,
    };
    let problems = check(&project, world);
    assert!(problems.len() <= 5 * lang_text::limits::PROBLEMS);
    for problem in &problems {
        assert!(!problem.to_string().is_empty());
    }
    let Ok(lowered) = lower(&project, world) else {
        return;
    };
    let program = Rc::new(lowered.program);
    let mut logs = Vec::new();
    for _ in 0..2 {
        let mut machine = Machine::new(program.clone(), options);
        let mut robot = StandIn::new(Placing::default());
        robot
            .readings
            .extend(Port::named("A1").map(|port| (port, 7)));
        robot.mail.push_back("mail \" .. x".into());
        robot.answers.push_back("x = 5".into());
        let mut status = Status::Running;
        for step in 0..STEPS {
            robot.tick();
            status = machine.step(step * STEP_MS, &mut robot, &mut Deaf);
            assert!(machine.threads().count() <= limits::THREADS_MAX);
        }
        assert!(machine.errors().len() <= lang_text::limits::PROBLEMS);
        assert_eq!(status == Status::Running, machine.threads().count() > 0);
        machine.stop(&mut robot, &mut Deaf);
        logs.push((robot.log, machine.status()));
    }
    assert_eq!(logs[0], logs[1]);
}
