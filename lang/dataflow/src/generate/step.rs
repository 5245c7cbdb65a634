//! What a converter does, as statements in no language.
//!
//! Owns plain data. Knows no program and no language.

/// A statement.
#[derive(Clone, Debug)]
pub(super) enum Step {
    /// Says something.
    Do(String),
    /// Changes what is on the left.
    Set(String, String),
    /// One of two ways.
    If(String, Vec<Step>, Vec<Step>),
    /// As long as it holds.
    While(String, Vec<Step>),
}

/// One function of the converter.
pub(super) struct Routine {
    /// What a person calls it.
    pub about: String,
    pub steps: Vec<Step>,
}

/// All functions of a converter.
pub(super) struct Body {
    /// By the places of their ports.
    pub reactions: Vec<Routine>,
    /// By the numbers of their timers; the time for which one was set is `due`.
    pub ticks: Vec<Routine>,
    /// What begins.
    pub start: Vec<Step>,
    /// Readings on their way.
    pub poll: Vec<Step>,
}
