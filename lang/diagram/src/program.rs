//! A project ready to run: blocks as numbered nodes with few kinds of operations, names and texts in tables.
//!
//! Owns plain data, made by `lower` and run by `machine`. Several machines may share one program.

use std::collections::HashMap;
use std::rc::Rc;

use super::blocks::wait::Measure;
use super::blocks::{Act, Copied, Row, Type, Wait};
use super::ports::{Kit, Port};
use lang_text::problem::{Place, Problem};

/// A place in [`Program::nodes`].
pub type Node = u32;

/// A place in [`Program::sources`].
pub type Source = u32;

/// A project ready to run.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// What each block does, diagrams one after another, blocks in the order of the save.
    pub(crate) ops: Box<[Op]>,
    /// Where each block stands.
    pub(crate) spots: Box<[Spot]>,
    /// The first initial node of each diagram.
    pub(crate) entries: Box<[Option<Node>]>,
    /// Ids and names of the diagrams.
    pub(crate) diagrams: Box<[Sheet]>,
    /// Which diagram is run.
    pub(crate) main: Option<u32>,
    /// Texts of expressions.
    pub(crate) sources: Box<[Text]>,
    /// What is told when a faulty block is reached.
    pub(crate) faults: Box<[Problem]>,
    pub(crate) switches: Box<[Switch]>,
    pub(crate) forks: Box<[Fork]>,
    pub(crate) joins: Box<[Join]>,
    pub(crate) calls: Box<[Call]>,
    pub(crate) messages: Box<[Message]>,
    pub(crate) assignments: Box<[Assignment]>,
    pub(crate) copies: Box<[Copying]>,
    pub(crate) actions: Box<[Action]>,
    pub(crate) watches: Box<[Watching]>,
    /// Why nothing of it can run.
    pub(crate) refusal: Option<Problem>,
    /// Whether somebody may have a gamepad.
    pub(crate) has_gamepad: bool,
    /// How many loops with counters there are.
    pub(crate) loops: u32,
    /// Whose blocks these are.
    pub(crate) kit: Kit,
}

/// The id and the name of a diagram.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub id: Box<str>,
    pub name: Rc<str>,
}

/// Where a node stands in the project.
#[derive(Clone, Debug)]
pub(crate) struct Spot {
    /// Id of the graphical object.
    pub id: Box<str>,
    pub diagram: u32,
    /// Nothing for a type that nobody knows.
    pub row: Option<&'static Row>,
}

/// The text of an expression.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub text: Box<str>,
    pub wanted: Type,
    /// The property as the editor shows it; empty for texts that blocks put together.
    pub property: &'static str,
}

/// What a node does. Targets are nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    /// Nothing.
    Pass { next: Node },
    /// Ends the diagram.
    End,
    /// Links or properties are wrong: tells it and ends the thread.
    Fault { fault: u32 },
    /// Statements.
    Run { source: Source, next: Node },
    /// Two branches.
    If { source: Source, yes: Node, no: Node },
    /// A loop with a counter.
    Loop {
        source: Source,
        body: Node,
        next: Node,
        counter: u32,
    },
    /// Many branches.
    Switch { switch: u32 },
    /// Begins threads.
    Fork { fork: u32 },
    /// Threads meet.
    Join { join: u32, next: Node },
    /// Ends a thread.
    Kill { message: u32, next: Node },
    /// Sends to a thread.
    Send { message: u32, next: Node },
    /// Receives from a thread.
    Receive { assignment: u32, next: Node },
    /// Runs a diagram.
    Call { call: u32, next: Node },
    /// Waits for a time.
    Timer { source: Source, next: Node },
    /// Assigns a random number.
    Random { assignment: u32, next: Node },
    /// Asks a person.
    Ask {
        assignment: u32,
        next: Node,
        cancel: Node,
    },
    /// Waits for any button.
    AnyButton { assignment: u32, next: Node },
    /// Waits for a message of another robot.
    Mail { assignment: u32, next: Node },
    /// Copies a sensor into a variable.
    Copy { copy: u32, next: Node },
    /// Tells a device something.
    Act { action: u32, next: Node },
    /// Waits until a device says something.
    Watch { watch: u32, next: Node },
}

impl Op {
    /// Where the flow goes on, if there is one place for that.
    pub(crate) fn next(self) -> Option<Node> {
        match self {
            Self::Pass { next }
            | Self::Run { next, .. }
            | Self::Join { next, .. }
            | Self::Kill { next, .. }
            | Self::Send { next, .. }
            | Self::Receive { next, .. }
            | Self::Call { next, .. }
            | Self::Timer { next, .. }
            | Self::Random { next, .. }
            | Self::Ask { next, .. }
            | Self::AnyButton { next, .. }
            | Self::Mail { next, .. }
            | Self::Copy { next, .. }
            | Self::Act { next, .. }
            | Self::Watch { next, .. } => Some(next),
            Self::End
            | Self::Fault { .. }
            | Self::If { .. }
            | Self::Loop { .. }
            | Self::Switch { .. }
            | Self::Fork { .. } => None,
        }
    }
}

/// No node.
pub(crate) const NOWHERE: Node = Node::MAX;

#[derive(Clone, Debug)]
pub(crate) struct Switch {
    pub source: Source,
    /// Guards in lower case and targets, by guard.
    pub branches: Box<[(Box<str>, Node)]>,
    /// The same with guards as they are written.
    pub exact: Box<[(Box<str>, Node)]>,
    pub other: Node,
}

#[derive(Clone, Debug)]
pub(crate) struct Fork {
    /// Names of threads and their first blocks, by the order of links; no name: a fresh one.
    pub branches: Box<[(Option<Rc<str>>, Node)]>,
}

#[derive(Clone, Debug)]
pub(crate) struct Join {
    /// Who goes on.
    pub survivor: Rc<str>,
    /// How many must come.
    pub incoming: u32,
}

#[derive(Clone, Debug)]
pub(crate) struct Call {
    /// The entered diagram; nothing: there is none, and the flow stays here.
    pub diagram: Option<u32>,
    pub arguments: Box<[Argument]>,
}

#[derive(Clone, Debug)]
pub(crate) struct Argument {
    pub name: Box<str>,
    pub kind: ArgumentKind,
    pub source: Source,
}

/// The type of a parameter.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum ArgumentKind {
    Truth,
    Whole,
    Number,
    Text,
}

#[derive(Clone, Debug)]
pub(crate) struct Message {
    pub thread: Rc<str>,
    pub source: Source,
}

/// A variable that a block assigns, and what else it has.
#[derive(Clone, Debug, Default)]
pub(crate) struct Assignment {
    pub variable: Box<str>,
    /// Whether to wait.
    pub wait: bool,
    /// Bounds of a random number.
    pub bounds: Option<(Source, Source)>,
    pub default: Box<str>,
    pub prompt: Box<str>,
}

/// A sensor that is copied into a variable.
#[derive(Clone, Debug)]
pub(crate) struct Copying {
    pub copied: &'static Copied,
    /// The statement that does it.
    pub source: Source,
}

/// A device command with its texts.
#[derive(Clone, Debug)]
pub(crate) struct Action {
    pub act: &'static Act,
    /// Whether the picture is shown afterwards.
    pub redraws: bool,
    /// Expressions in the order of the row.
    pub sources: Box<[Source]>,
    /// Texts that stand as they are, in the order of the row.
    pub texts: Box<[Box<str>]>,
    /// Plain numbers, in the order of the row.
    pub numbers: Box<[i32]>,
    /// Flags in the order of the row, without `Evaluate` and `Redraw`.
    pub flags: Box<[bool]>,
    /// Ports that are known beforehand; for motors none if the list has to be evaluated.
    pub ports: Box<[Port]>,
}

/// A port that is watched.
#[derive(Clone, Debug)]
pub(crate) struct Watching {
    pub wait: &'static Wait,
    /// The port, or the name that none has.
    pub port: Result<Port, Box<str>>,
    pub measure: Measure,
    pub until: WatchedFor,
}

/// Which readings of a watched port end the wait.
#[derive(Clone, Copy, Debug)]
pub(crate) enum WatchedFor {
    /// Those that stand so to an expression.
    Compared(Sign, Source),
    /// Those above 0.
    Positive,
    /// 0.
    Zero,
}

impl Watching {
    /// The expression with which readings are compared.
    pub(crate) fn source(&self) -> Option<Source> {
        match self.until {
            WatchedFor::Compared(_, source) => Some(source),
            WatchedFor::Positive | WatchedFor::Zero => None,
        }
    }
}

/// How a reading is compared with a value.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Sign {
    Greater,
    Less,
    NotLess,
    NotGreater,
    Equals,
    /// No word that is known: never true.
    Unknown,
}

impl Sign {
    pub(crate) fn holds(self, reading: i32, value: i32) -> bool {
        match self {
            Self::Greater => reading > value,
            Self::Less => reading < value,
            Self::NotLess => reading >= value,
            Self::NotGreater => reading <= value,
            Self::Equals => reading == value,
            Self::Unknown => false,
        }
    }
}

impl Program {
    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.ops.len()
    }

    /// Why it cannot be run at all.
    pub fn refusal(&self) -> Option<&Problem> {
        self.refusal.as_ref()
    }

    /// Whether there is nothing to run.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty()
    }

    /// Id of the graphical object of a node.
    pub fn id(&self, node: Node) -> Option<&str> {
        self.spots.get(node as usize).map(|spot| &*spot.id)
    }

    /// The type of a node, if it is one of ours.
    pub fn row(&self, node: Node) -> Option<&'static Row> {
        self.spots.get(node as usize).and_then(|spot| spot.row)
    }

    /// Name of the diagram of a node.
    pub fn diagram(&self, node: Node) -> Option<&str> {
        let spot = self.spots.get(node as usize)?;
        Some(&self.diagrams.get(spot.diagram as usize)?.name)
    }

    /// The node with the id of a graphical object.
    pub fn node(&self, id: &str) -> Option<Node> {
        let at = self.spots.iter().position(|spot| &*spot.id == id)?;
        Node::try_from(at).ok()
    }

    /// The node to which each expression belongs.
    pub(crate) fn places_of_sources(&self) -> HashMap<Source, Node> {
        let mut found = HashMap::new();
        for node in 0..self.ops.len() as Node {
            super::check::sources(self, node, &mut |source| {
                found.insert(source, node);
            });
        }
        found
    }

    /// The place of a node, for problems.
    pub(crate) fn place(&self, node: Node) -> Place {
        Place {
            diagram: self.diagram(node).map(str::to_owned),
            object: self.id(node).map(str::to_owned),
            block: self.row(node).map(|row| row.shown.to_owned()),
            ..Place::default()
        }
    }
}
