//! What was read of constraints: a compact tree of events, conditions, triggers and operands.
//!
//! Owns the shapes. Paths are split and numbers converted already; objects stand by their names, and each name that is
//! looked up has a number of its own, under which a checker remembers what it found.

use super::scene::ObjectPoint;
use super::value::Value;
use lang_text::problem::Problem;
use lang_text::xml::Start;

/// Constraints, ready to be checked as often as wanted.
#[derive(Debug)]
pub struct Rules {
    /// Events in the order in which they are checked.
    pub(super) events: Vec<Event>,
    /// Objects that the rules may ask for: the first names of paths, one and two of them.
    pub(super) objects: Vec<Box<str>>,
    /// How many names are looked up.
    pub(super) slots: usize,
    /// What works, but perhaps not as meant.
    pub(super) warnings: Vec<Problem>,
    /// What is wrong with templates that nothing else needs.
    pub(super) faults: Vec<Problem>,
    /// Milliseconds that a program may work.
    pub(super) time_limit_ms: u32,
}

impl Rules {
    /// What works, but perhaps not as meant.
    pub fn warnings(&self) -> &[Problem] {
        &self.warnings
    }

    /// What is wrong with templates of the save although the rules are read: the original tells it and goes on.
    pub fn faults(&self) -> &[Problem] {
        &self.faults
    }

    /// How many events there are, constraints and the time limit among them.
    pub fn events(&self) -> usize {
        self.events.len()
    }

    /// Milliseconds of model time that a program may work.
    pub fn time_limit_ms(&self) -> u32 {
        self.time_limit_ms
    }
}

/// The index of an event.
pub(super) type EventIndex = usize;

/// Which tag a rule is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Kind {
    /// `event`.
    Event,
    /// `constraint`.
    Constraint,
    /// `timelimit`.
    TimeLimit,
    /// `init`.
    Init,
}

/// Something that is watched.
#[derive(Debug)]
pub(super) struct Event {
    pub kind: Kind,
    /// Its place among the tags of its kind, from 1.
    pub number: usize,
    /// Its id, empty for none.
    pub id: Box<str>,
    /// Its tag and id, for people.
    pub label: Box<str>,
    /// Where it stands.
    pub at: Start,
    /// Whether it is there from the start.
    pub initially: bool,
    /// Whether it is gone when it has fired.
    pub drops: bool,
    pub condition: Condition,
    pub trigger: Trigger,
}

/// An object by its name.
#[derive(Clone, Debug)]
pub(super) struct Name {
    pub text: Box<str>,
    /// Where a checker keeps what it found.
    pub slot: usize,
    /// Where it stands.
    pub at: Start,
}

/// A property by the names on the way to it, the first of which are those of an object.
#[derive(Debug)]
pub(super) struct Path {
    /// As it is written.
    pub text: Box<str>,
    /// Its names; none if nothing but dots is written.
    pub parts: Box<[Box<str>]>,
    /// Where a checker keeps what it found.
    pub slot: usize,
    /// Where it stands.
    pub at: Start,
}

/// An event that is named; it need not be there.
#[derive(Debug)]
pub(super) struct Named {
    pub id: Box<str>,
    pub event: Option<EventIndex>,
}

/// How two values are compared.
#[derive(Clone, Copy, Debug)]
pub(super) enum Comparison {
    Equals,
    NotEqual,
    Greater,
    Less,
    NotGreater,
    NotLess,
}

/// Something that is true or not.
#[derive(Debug)]
pub(super) enum Condition {
    True,
    All(Box<[Condition]>),
    Any(Box<[Condition]>),
    Not(Box<Condition>),
    Compare(Comparison, Box<[Operand; 2]>),
    Inside {
        object: Name,
        region: Name,
        point: ObjectPoint,
    },
    SettedUp(Named),
    Dropped(Named),
    Timer {
        ms: i32,
        drops: bool,
        at: Start,
    },
    Using(Box<[Trigger]>, Box<Condition>),
}

/// One value of one value.
#[derive(Clone, Copy, Debug)]
pub(super) enum Unary {
    Minus,
    Abs,
    BoundingRect,
}

/// One value of two.
#[derive(Clone, Copy, Debug)]
pub(super) enum Binary {
    Sum,
    Difference,
    Mul,
    Min,
    Max,
    Distance,
}

/// Something that has a value.
#[derive(Debug)]
pub(super) enum Operand {
    Constant(Value),
    Variable(Path),
    State(Path),
    /// A variable, or if there is none, the state of an object.
    Either(Path),
    TypeOf(Name),
    Unary(Unary, Box<Operand>),
    Binary(Binary, Box<[Operand; 2]>),
}

/// A text with places that are filled in when it is said, in this order.
#[derive(Debug)]
pub(super) struct Message {
    pub text: Box<str>,
    pub filled: Box<[(Box<str>, Operand)]>,
}

/// Something that is done.
#[derive(Debug)]
pub(super) enum Trigger {
    All(Box<[Trigger]>),
    Fail(Box<str>),
    TimeOver,
    Success {
        deferred: bool,
    },
    Say(Message),
    Log(Message),
    /// With the place where it stands.
    SetVariable(Box<str>, Start, Operand),
    SetUp(Named),
    Drop(Named),
    SetState {
        object: Path,
        property: Box<str>,
        value: Operand,
    },
}
