//! Where a program of blocks runs that somebody debugs: a simulated robot in this process, or a robot elsewhere.
//!
//! Owns the border. Front ends (the terminal, an editor) know no more of a robot than this.

/// What a robot answers to clients, in English and Russian.
pub(crate) mod words;

use super::asking::{Asked, Listener};
use super::stops::words as stops;
use crate::diagrams::flow::{Flow, Program};
use crate::error::Error;
use lang_diagram::debug::order::Order;
use lang_diagram::lower::World;
use lang_diagram::machine::patch::{Refused, Version};
use lang_diagram::project::Project;
use lang_text::problem::{Locale, Problem, Words};
use serde_json::Value;
use std::path::Path;
use std::time::Duration;

/// A program with its debugger.
pub(crate) trait Target {
    /// Gives an order and waits for its answer, a JSON object.
    ///
    /// # Errors
    /// The robot does not answer. A refusal is an answer.
    fn order(&mut self, order: &Order) -> Result<Value, Error>;

    /// Lets the program run for about so long, or waits for something to happen; what has happened.
    ///
    /// # Errors
    /// The robot is gone.
    fn turn(&mut self, wait: Duration) -> Result<Vec<Event>, Error>;

    /// Replaces the program that runs by the one of a file, which goes on where it is with what it has. `diagram` is the
    /// main diagram of the file that `version` begins with, if it is not the first one.
    ///
    /// # Errors
    /// The robot does not answer.
    fn change(
        &mut self,
        file: &Path,
        diagram: Option<&str>,
        version: Written<'_>,
    ) -> Result<Changed, Error>;

    /// Who answers questions of the program from now on; nobody does before.
    fn attend(&mut self, _listener: Listener) {}

    /// What a person says to the question that was told last.
    fn answer(&mut self, _text: &str) {}

    /// Ends the program: motors rest.
    fn end(&mut self);

    /// The talk is over: a program that was started for it is ended.
    fn close(&mut self);

    /// Whether a program that has ended can still be looked at.
    fn keeps_past(&self) -> bool;

    /// What the world looks like at a time of the program, in a line; none if nobody knows.
    fn scene(&self, ms: u64) -> Option<Words>;
}

/// A program as its file has it.
#[derive(Clone, Copy)]
pub(crate) enum Written<'a> {
    /// A diagram of control flow.
    Diagram(&'a Project),
    /// A data-flow program.
    Flow(&'a Flow),
}

impl<'a> Written<'a> {
    /// What a file has.
    pub(crate) fn of(program: &'a Program) -> Self {
        match program {
            Program::Diagram(opened) => Self::Diagram(&opened.project),
            Program::Flow(flow, _) | Program::Text(flow) => Self::Flow(flow),
        }
    }
}

impl Written<'_> {
    /// Why it would be refused by whichever robot, a line for each mistake; none: it has none.
    pub(crate) fn mistakes(self, file: &Path, locale: Locale) -> Option<String> {
        match self {
            Self::Diagram(project) => {
                let version = Version::of(project, World::Robot);
                version.err().map(|why| problems(&why, locale))
            }
            Self::Flow(flow) => {
                let mistakes = flow.ready().err();
                mistakes.map(|wrong| flow.lines(file, &wrong, locale).join("\n"))
            }
        }
    }
}

/// What has become of a new version of a program.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Changed {
    /// It runs, and this is what it has changed.
    InForce(String),
    /// It has mistakes; what ran goes on.
    Wrong(String),
    /// It cannot take the place of what runs, for this reason: it would have to begin anew.
    CannotBe(String),
}

/// Something that has happened.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Event {
    /// The debugger has told something, a JSON object.
    Report(Value),
    /// The program, or somebody about it, has said something.
    Said(Channel, String),
    /// The program asks a person, who is there.
    Asked(Asked),
    /// The run is over, and why.
    Over(String),
}

/// By which way something was said.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Channel {
    /// The program has printed it.
    Output,
    /// It is an error or a message of rules.
    Message,
}

/// Why a version is refused, a line for each problem.
pub(crate) fn problems(why: &Refused, locale: Locale) -> String {
    match why {
        Refused::Ended => stops::in_locale(locale, stops::has_ended()),
        Refused::Mistakes(_) | Refused::Occupied(_) => lines(why.problems(), locale),
    }
}

/// A line for each problem.
pub(crate) fn lines(problems: &[Problem], locale: Locale) -> String {
    let lines = problems.iter().map(|problem| problem.in_locale(locale));
    lines.collect::<Vec<_>>().join("\n")
}

/// The lines of breakpoints in what a debugger has told; none if it has told something else.
pub(crate) fn log_lines(told: &Value) -> impl Iterator<Item = &str> {
    let lines = told.get("log").and_then(Value::as_array);
    lines.into_iter().flatten().filter_map(Value::as_str)
}

/// Why an answer says that the order was not carried out; none: it was.
pub(crate) fn why_not(answer: &Value) -> Option<String> {
    match answer.get("done").and_then(Value::as_bool) {
        Some(true) => None,
        Some(false) | None => {
            let why = answer.get("why").and_then(Value::as_str);
            Some(why.unwrap_or("the robot has not understood it").to_owned())
        }
    }
}
