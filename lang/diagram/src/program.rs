//! A project ready to run: blocks as numbered nodes with few kinds of operations, names and texts in tables.
//!
//! Owns plain data, made by `lower` and run by `machine`, and what each operation is to everybody who only looks at
//! programs: where it leads, its texts, its variable, what it waits for. Several machines may share one program.

use super::blocks::act::Effect;
use super::blocks::wait::Measure;
use super::blocks::{Act, Copied, Row, Type, Wait};
use super::ports::{Kit, Port};
use lang_text::problem::{Place, Problem};
use std::collections::HashMap;
use std::rc::Rc;

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
    pub(crate) diagrams: Box<[DiagramName]>,
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
pub(crate) struct DiagramName {
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
    /// Where it is drawn on the sheet.
    pub position: (f64, f64),
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

/// How the flow leaves a node.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Leads<'a> {
    /// It does not: the diagram ends here.
    End,
    /// The thread ends with this fault.
    Fault(u32),
    /// To one place.
    To(Node),
    /// To the first place if the test holds, else to the second.
    Test(Test, Node, Node),
    /// To one of many.
    Switch(&'a Switch),
    /// To all branches, each with a thread of its own.
    Fork(&'a Fork),
    /// To one place, for the thread that survives.
    Join(&'a Join, Node),
    /// Through another diagram, if it is there, to one place.
    Call(&'a Call, Node),
    /// To the first place after an answer; to the second, if there is one, without.
    Ask(Node, Node),
}

/// What decides between two ways.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Test {
    /// Whether this is true.
    Truth(Source),
    /// Whether the flow came here no more often than this says.
    Count(Source),
}

/// What makes a thread go on after a node.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Wakes {
    /// Nothing has to: it does not wait.
    AtOnce,
    /// The clock of the node itself.
    ByItsClock,
    /// Something that comes after all clocks have counted, or another thread.
    Later,
}

/// What a node gives its variable.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum AssignedKind {
    Whole,
    Text,
    /// Anything.
    Any,
    /// What a person answers.
    Answer,
}

/// What a node remembers between two visits; the number is its place in the machine's table of that.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Memory {
    Nothing,
    /// How many rounds of a loop are left.
    Rounds(u32),
    /// How many threads have come to a join.
    Arrivals(u32),
    /// Names of threads and where they begin, of a fork.
    Names(u32),
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
    /// A problem with the place of its block on the sheet, if it has one.
    pub fn on_sheet(&self, problem: Problem) -> Problem {
        let spots = self.spots.iter().map(|one| (&*one.id, one.position));
        super::project::on_sheet(problem, spots)
    }

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

    /// How the flow leaves a node.
    pub(crate) fn leads(&self, node: Node) -> Option<Leads<'_>> {
        Some(match *self.ops.get(node as usize)? {
            Op::End => Leads::End,
            Op::Fault { fault } => Leads::Fault(fault),
            Op::If { source, yes, no } => Leads::Test(Test::Truth(source), yes, no),
            Op::Loop {
                source, body, next, ..
            } => Leads::Test(Test::Count(source), body, next),
            Op::Switch { switch } => Leads::Switch(&self.switches[switch as usize]),
            Op::Fork { fork } => Leads::Fork(&self.forks[fork as usize]),
            Op::Join { join, next } => Leads::Join(&self.joins[join as usize], next),
            Op::Call { call, next } => Leads::Call(&self.calls[call as usize], next),
            Op::Ask { next, cancel, .. } => Leads::Ask(next, cancel),
            Op::Pass { next }
            | Op::Run { next, .. }
            | Op::Kill { next, .. }
            | Op::Send { next, .. }
            | Op::Receive { next, .. }
            | Op::Timer { next, .. }
            | Op::Random { next, .. }
            | Op::AnyButton { next, .. }
            | Op::Mail { next, .. }
            | Op::Copy { next, .. }
            | Op::Act { next, .. }
            | Op::Watch { next, .. } => Leads::To(next),
        })
    }

    /// Where the flow goes on after a node, if there is one place for that.
    pub(crate) fn next(&self, node: Node) -> Option<Node> {
        match self.leads(node)? {
            Leads::To(next) | Leads::Join(_, next) | Leads::Call(_, next) | Leads::Ask(next, _) => {
                Some(next)
            }
            Leads::End | Leads::Fault(_) | Leads::Test(..) | Leads::Switch(_) | Leads::Fork(_) => {
                None
            }
        }
    }

    /// What decides between the two ways out of a node, if it has two.
    pub(crate) fn test(&self, node: Node) -> Option<Test> {
        match self.leads(node)? {
            Leads::Test(test, ..) => Some(test),
            Leads::End
            | Leads::Fault(_)
            | Leads::To(_)
            | Leads::Switch(_)
            | Leads::Fork(_)
            | Leads::Join(..)
            | Leads::Call(..)
            | Leads::Ask(..) => None,
        }
    }

    /// Texts of a node, in the order in which it evaluates them.
    pub(crate) fn texts(&self, node: Node) -> Vec<Source> {
        let Some(op) = self.ops.get(node as usize) else {
            return Vec::new();
        };
        match *op {
            Op::Run { source, .. }
            | Op::If { source, .. }
            | Op::Loop { source, .. }
            | Op::Timer { source, .. } => vec![source],
            Op::Switch { switch } => vec![self.switches[switch as usize].source],
            Op::Send { message, .. } => vec![self.messages[message as usize].source],
            Op::Random { assignment, .. } => match self.assignments[assignment as usize].bounds {
                Some((low, high)) => vec![low, high],
                None => Vec::new(),
            },
            Op::Copy { copy, .. } => vec![self.copies[copy as usize].source],
            Op::Call { call, .. } => {
                let arguments = self.calls[call as usize].arguments.iter();
                arguments.map(|argument| argument.source).collect()
            }
            Op::Act { action, .. } => self.actions[action as usize].sources.to_vec(),
            Op::Watch { watch, .. } => Vec::from_iter(self.watches[watch as usize].source()),
            Op::Pass { .. }
            | Op::End
            | Op::Fault { .. }
            | Op::Fork { .. }
            | Op::Join { .. }
            | Op::Kill { .. }
            | Op::Receive { .. }
            | Op::Ask { .. }
            | Op::AnyButton { .. }
            | Op::Mail { .. } => Vec::new(),
        }
    }

    /// The variable that a node assigns by itself, not by one of its texts, and what that gets.
    pub(crate) fn given(&self, node: Node) -> Option<(&Assignment, AssignedKind)> {
        let (assignment, given) = match *self.ops.get(node as usize)? {
            Op::Random { assignment, .. } | Op::AnyButton { assignment, .. } => {
                (assignment, AssignedKind::Whole)
            }
            Op::Mail { assignment, .. } => (assignment, AssignedKind::Text),
            Op::Receive { assignment, .. } => (assignment, AssignedKind::Any),
            Op::Ask { assignment, .. } => (assignment, AssignedKind::Answer),
            Op::Pass { .. }
            | Op::End
            | Op::Fault { .. }
            | Op::Run { .. }
            | Op::If { .. }
            | Op::Loop { .. }
            | Op::Switch { .. }
            | Op::Fork { .. }
            | Op::Join { .. }
            | Op::Kill { .. }
            | Op::Send { .. }
            | Op::Call { .. }
            | Op::Timer { .. }
            | Op::Copy { .. }
            | Op::Act { .. }
            | Op::Watch { .. } => return None,
        };
        Some((&self.assignments[assignment as usize], given))
    }

    /// What makes a thread go on after a node, which may be within a diagram that it calls.
    pub(crate) fn wakes(&self, node: Node) -> Wakes {
        match self.ops[node as usize] {
            Op::Timer { .. } | Op::AnyButton { .. } | Op::Mail { .. } => Wakes::ByItsClock,
            Op::Watch { .. } | Op::Ask { .. } | Op::Join { .. } => Wakes::Later,
            Op::Receive { assignment, .. } if self.assignments[assignment as usize].wait => {
                Wakes::Later
            }
            Op::Act { action, .. } => match self.actions[action as usize].act.effect {
                Effect::ResetEncoders => Wakes::Later,
                Effect::Drive(_) | Effect::Stop | Effect::Command(_) => Wakes::AtOnce,
            },
            Op::Pass { .. }
            | Op::End
            | Op::Fault { .. }
            | Op::Run { .. }
            | Op::If { .. }
            | Op::Loop { .. }
            | Op::Switch { .. }
            | Op::Fork { .. }
            | Op::Kill { .. }
            | Op::Send { .. }
            | Op::Receive { .. }
            | Op::Call { .. }
            | Op::Random { .. }
            | Op::Copy { .. } => Wakes::AtOnce,
        }
    }

    /// Names of the threads that it may begin, but for those that are named when they begin.
    pub fn thread_names(&self) -> impl Iterator<Item = &str> {
        let branches = self.forks.iter().flat_map(|fork| &fork.branches);
        let named = branches.filter_map(|(name, _)| name.as_deref());
        std::iter::once("main").chain(named)
    }

    /// What a node remembers.
    pub(crate) fn remembers(&self, node: Node) -> Memory {
        match self.ops[node as usize] {
            Op::Loop { counter, .. } => Memory::Rounds(counter),
            Op::Join { join, .. } => Memory::Arrivals(join),
            Op::Fork { fork } => Memory::Names(fork),
            Op::Pass { .. }
            | Op::End
            | Op::Fault { .. }
            | Op::Run { .. }
            | Op::If { .. }
            | Op::Switch { .. }
            | Op::Kill { .. }
            | Op::Send { .. }
            | Op::Receive { .. }
            | Op::Call { .. }
            | Op::Timer { .. }
            | Op::Random { .. }
            | Op::Ask { .. }
            | Op::AnyButton { .. }
            | Op::Mail { .. }
            | Op::Copy { .. }
            | Op::Act { .. }
            | Op::Watch { .. } => Memory::Nothing,
        }
    }

    /// The node to which each expression belongs.
    pub(crate) fn places_of_texts(&self) -> HashMap<Source, Node> {
        let nodes = 0..self.ops.len() as Node;
        nodes
            .flat_map(|node| self.texts(node).into_iter().map(move |text| (text, node)))
            .collect()
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
