//! What blocks remember between tokens.
//!
//! Owns plain data. Knows no time but as numbers.

use crate::program::{Act, Flow, Node, Op, Source, Words};
use lang_expr::Value;
use std::collections::VecDeque;
use std::rc::Rc;

/// What one block remembers.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// Own names that have a value, as bits.
    pub bound: u8,
    /// Own names that got a unit, which has none.
    pub units: u8,
    /// The key of its timer, if it has set one that is not due yet.
    pub timer: Option<(u32, u32)>,
    /// The rest.
    pub memory: Memory,
}

/// What a wait holds.
#[derive(Clone, Debug)]
pub(super) enum Held {
    /// That it was started.
    Start,
    /// A token.
    Token(Value),
}

/// What one kind of block remembers.
#[derive(Clone, Debug)]
pub(super) enum Memory {
    /// Nothing.
    None,
    /// A loop: first, last, step, and the number that comes next while it runs.
    Count { bounds: [i32; 3], next: Option<i32> },
    /// A wait.
    Hold {
        /// Its time.
        ms: i32,
        /// What it holds.
        held: Option<Held>,
        /// What waits its turn, the oldest first, each with its port.
        kept: VecDeque<(u8, Value)>,
    },
    /// The time of a window, and when it was opened last.
    Window { ms: i32, since: Option<u32> },
    /// A gate.
    Gate {
        /// Shortest time between two that pass.
        pause_ms: i32,
        /// How many still pass; below 0: all.
        count: i32,
        /// When one passed last.
        last: Option<u32>,
    },
    /// Whether it was told that a reading failed.
    Readings { has_failed: bool },
    /// What is added to the encoders whose readings are given, and whether it was told that one failed.
    Offsets([Option<i32>; 4], bool),
    /// The gamepad as it was: pads touched, and the wheel.
    Pads {
        pressed: [bool; 2],
        wheel: Option<i32>,
    },
    /// Whether a call has begun.
    Begun(bool),
    /// A text that a token has replaced.
    Text(Rc<str>),
    /// A file and a text that tokens have replaced.
    File(Rc<str>, Rc<str>),
    /// A number that a token has replaced.
    Number(i32),
    /// A truth that a token has replaced.
    Truth(bool),
}

impl State {
    pub fn new(node: &Node) -> Self {
        Self {
            bound: 0,
            units: 0,
            timer: None,
            memory: Memory::of(&node.op),
        }
    }
}

impl Memory {
    fn of(op: &Op) -> Self {
        match op {
            Op::Flow(flow) => Self::of_flow(flow),
            Op::Source(source) => match source {
                Source::Sensor(_) | Source::Detect(_) | Source::Receive => {
                    Self::Readings { has_failed: false }
                }
                Source::Encoders(_) => Self::Offsets([None; 4], false),
                Source::Gamepad => Self::Pads {
                    pressed: [false; 2],
                    wheel: None,
                },
            },
            Op::Act(act) => Self::of_act(act),
        }
    }

    fn of_flow(flow: &Flow) -> Self {
        match flow {
            Flow::Loop { bounds, .. } => Self::Count {
                bounds: *bounds,
                next: None,
            },
            Flow::Call(_) => Self::Begun(false),
            Flow::Filter {
                count, pause_ms, ..
            } => Self::Gate {
                pause_ms: i32::try_from(*pause_ms).unwrap_or(i32::MAX),
                count: *count,
                last: None,
            },
            Flow::Wait { ms, .. } => Self::Hold {
                ms: *ms,
                held: None,
                kept: VecDeque::new(),
            },
            Flow::Replace(ms) | Flow::Inhibit(ms) => Self::Window {
                ms: *ms,
                since: None,
            },
            Flow::Stop
            | Flow::Function { .. }
            | Flow::If(_)
            | Flow::Switch { .. }
            | Flow::InPort
            | Flow::OutPort(_)
            | Flow::Constant(_)
            | Flow::Variable { .. }
            | Flow::Random { .. }
            | Flow::Zip
            | Flow::Unzip => Self::None,
        }
    }

    fn of_act(act: &Act) -> Self {
        match act {
            Act::Send { number, .. } => Self::Number(*number),
            Act::WriteFile { file, text } => Self::File(file.clone(), text.clone()),
            Act::ReadFile { file, .. } => Self::Text(file.clone()),
            Act::Pen { color, .. } => Self::Text(color.clone()),
            Act::Print { text, .. } => match text {
                Words::Plain(text) => Self::Text(text.clone()),
                Words::Computed(_) => Self::None,
            },
            Act::Smile(happy) => Self::Truth(*happy),
            Act::WritePort { .. }
            | Act::ReadPort(_)
            | Act::Drive { .. }
            | Act::Led(_)
            | Act::Say(_)
            | Act::Sound(_)
            | Act::System { .. }
            | Act::Stream
            | Act::StartCamera(_)
            | Act::RemoveFile(_)
            | Act::Paint { .. }
            | Act::Clear
            | Act::Draw { .. } => Self::None,
        }
    }

    /// The tokens that wait their turn at a wait, each with its port.
    pub fn kept(&self) -> impl Iterator<Item = &(u8, Value)> {
        let kept = if let Self::Hold { kept, .. } = self {
            Some(kept)
        } else {
            None
        };
        kept.into_iter().flatten()
    }

    /// How much memory the texts and the token take that it holds, about; tokens that wait their turn are counted where they
    /// come.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Text(text) => text.len(),
            Self::File(file, text) => file.len() + text.len(),
            Self::Hold {
                held: Some(Held::Token(token)),
                ..
            } => token.cells() as usize * size_of::<Value>(),
            Self::Hold {
                held: Some(Held::Start) | None,
                ..
            }
            | Self::None
            | Self::Count { .. }
            | Self::Window { .. }
            | Self::Gate { .. }
            | Self::Readings { .. }
            | Self::Offsets(..)
            | Self::Pads { .. }
            | Self::Begun(_)
            | Self::Number(_)
            | Self::Truth(_) => 0,
        }
    }

    /// Drops those of them whose port is not open any more.
    pub fn keep_of(&mut self, is_open: impl Fn(u8) -> bool) {
        if let Self::Hold { kept, .. } = self {
            kept.retain(|(port, _)| is_open(*port));
        }
    }

    /// The text that a token has replaced, if there is one.
    pub fn text(&self) -> Option<Rc<str>> {
        if let Self::Text(text) = self {
            Some(text.clone())
        } else {
            None
        }
    }

    /// The number that a token has replaced, if there is one.
    pub fn number(&self) -> Option<i32> {
        if let Self::Number(number) = self {
            Some(*number)
        } else {
            None
        }
    }
}
