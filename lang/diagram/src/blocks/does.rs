//! What a block can do at all.
//!
//! Owns the list. Which block does what is said by the rows.

use super::act::Act;
use super::{Copied, Wait};

/// What a block does, as far as the table knows.
#[derive(Clone, Copy, Debug)]
pub enum Does {
    /// The program or subprogram begins here.
    Start,
    /// The present diagram ends here.
    End,
    /// A note for people.
    Comment,
    /// Nothing: two branches meet.
    Merge,
    /// Runs statements.
    Statements,
    /// Assigns a value.
    Assign,
    /// Assigns a random number.
    Random,
    /// Asks a person.
    Ask,
    /// Takes one of two branches.
    If,
    /// Takes one of many branches.
    Switch,
    /// A loop with a counter.
    Loop,
    /// A loop with a condition.
    While,
    /// Begins threads.
    Fork,
    /// Threads meet.
    Join,
    /// Ends a thread.
    Kill,
    /// Sends to a thread.
    Send,
    /// Receives from a thread.
    Receive,
    /// Runs another diagram.
    Call,
    /// Waits for some time.
    Timer,
    /// Waits for any button.
    AnyButton,
    /// Waits for a message of another robot.
    Mail,
    /// Copies a sensor into a variable.
    Copy(&'static Copied),
    /// Tells a device something and goes on.
    Act(&'static Act),
    /// Waits until a device says something.
    Wait(&'static Wait),
}

impl Does {
    /// Whether a block is there only to be drawn.
    pub(super) fn is_mark(self) -> bool {
        match self {
            Self::Start | Self::Merge | Self::Comment => true,
            Self::End
            | Self::Statements
            | Self::Assign
            | Self::Random
            | Self::Ask
            | Self::If
            | Self::Switch
            | Self::Loop
            | Self::While
            | Self::Fork
            | Self::Join
            | Self::Kill
            | Self::Send
            | Self::Receive
            | Self::Call
            | Self::Timer
            | Self::AnyButton
            | Self::Mail
            | Self::Copy(_)
            | Self::Act(_)
            | Self::Wait(_) => false,
        }
    }
}
