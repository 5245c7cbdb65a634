//! Breakpoints: at blocks and at changes of variables; what each was asked for, and how often it was hit.
//!
//! Owns the list, which of them may be set, and what those at a moment do. It knows blocks by the ids of the project, so
//! that it survives a new version of the program. Whether the program goes on is decided by the debugger. It serves both
//! languages of blocks: a program is a [`Subject`].

use std::collections::VecDeque;

use super::{Change, Reason};
use crate::check::aside;
use crate::limits;
use crate::machine::Machine;
use crate::program::Node;
use lang_expr::Value;
use lang_text::problem::{Locale, Problem, Words};

/// A program as its breakpoints see it, at the moment at which it is. Looking changes nothing in it.
pub trait Subject {
    /// The nodes of a block, by its id in the project: several, if each call of its diagram has its own.
    fn nodes(&self, id: &str) -> Vec<Node>;

    /// Why the program never stops at a node; nothing, if it may.
    fn never_stops(&self, _node: Node) -> Option<Words> {
        None
    }

    /// Why changes of this name cannot be watched; nothing, if they can.
    fn no_variable(&self, name: &str) -> Vec<Problem>;

    /// What is wrong with an expression at such a breakpoint, whatever the program does.
    fn mistakes(&self, text: &str, at: &Spot) -> Vec<Problem>;

    /// What a variable that is watched holds.
    fn value_of(&self, name: &str) -> Option<Value>;

    /// Whether a condition holds.
    ///
    /// # Errors
    /// It cannot be computed.
    fn holds(&mut self, condition: &str) -> Result<bool, Vec<Problem>>;

    /// The value of an expression.
    ///
    /// # Errors
    /// It cannot be computed.
    fn value(&mut self, text: &str) -> Result<Value, Vec<Problem>>;
}

impl Subject for &Machine {
    fn nodes(&self, id: &str) -> Vec<Node> {
        self.program().node(id).into_iter().collect()
    }

    fn no_variable(&self, name: &str) -> Vec<Problem> {
        Machine::no_variable(self, name)
    }

    fn mistakes(&self, text: &str, _at: &Spot) -> Vec<Problem> {
        self.mistakes_aside(text)
    }

    fn value_of(&self, name: &str) -> Option<Value> {
        Machine::value_of(self, name)
    }

    fn holds(&mut self, condition: &str) -> Result<bool, Vec<Problem>> {
        let value = self.evaluate_aside(condition)?;
        Ok(value.to_bool())
    }

    fn value(&mut self, text: &str) -> Result<Value, Vec<Problem>> {
        self.evaluate_aside(text)
    }
}

/// Where a breakpoint counts.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Spot {
    /// Before the block with this id in the project.
    Block(Box<str>),
    /// After a change of this variable, or of this sensor's variable.
    Change(Box<str>),
}

impl Default for Spot {
    fn default() -> Self {
        Self::Block(Box::default())
    }
}

/// A breakpoint.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Breakpoint {
    /// Where.
    pub at: Spot,
    /// It counts only if this expression is true; empty: always.
    pub condition: Box<str>,
    /// It stops at this time and all later ones; 0 and 1: at each.
    pub from_hit: u32,
    /// It writes this line instead of stopping; `{expression}` stands for a value. Empty: it stops.
    pub log: Box<str>,
    /// It stops once and is gone.
    pub is_once: bool,
    /// It is kept but does nothing.
    pub is_disabled: bool,
}

impl Breakpoint {
    /// One that stops each time before a block.
    pub fn before(block: impl Into<Box<str>>) -> Self {
        Self {
            at: Spot::Block(block.into()),
            ..Self::default()
        }
    }

    /// One that stops each time after a change of a variable.
    pub fn of_changes(variable: impl Into<Box<str>>) -> Self {
        Self {
            at: Spot::Change(variable.into()),
            ..Self::default()
        }
    }
}

/// Why a breakpoint is refused.
#[derive(Clone, Debug, PartialEq)]
pub enum NoBreakpoint {
    /// The program has no such block.
    NoSuchBlock,
    /// The program never stops at this block, for this reason.
    NeverStops(Words),
    /// There are [`limits::BREAKPOINTS_MAX`].
    TooMany,
    /// There are [`limits::WATCHES_MAX`] of those that stop at changes.
    TooManyWatches,
    /// A condition or a line is longer than [`limits::CONDITION_MAX`] bytes.
    TooLong,
    /// What is to be watched is no variable of the program.
    Variable(Vec<Problem>),
    /// The condition can never be computed.
    Condition(Vec<Problem>),
    /// An expression in the line can never be computed.
    Line(Vec<Problem>),
}

impl NoBreakpoint {
    /// For a person, a line for each problem.
    pub fn in_locale(&self, locale: Locale) -> String {
        use super::words;
        match self {
            Self::NoSuchBlock => words::no_such_block().in_locale(locale).to_owned(),
            Self::NeverStops(why) => why.in_locale(locale).to_owned(),
            Self::TooMany => words::too_many_breakpoints(limits::BREAKPOINTS_MAX)
                .in_locale(locale)
                .to_owned(),
            Self::TooManyWatches => words::too_many_watches(limits::WATCHES_MAX)
                .in_locale(locale)
                .to_owned(),
            Self::TooLong => words::condition_too_long(limits::CONDITION_MAX)
                .in_locale(locale)
                .to_owned(),
            Self::Variable(problems) => told(words::watched(), problems, locale),
            Self::Condition(problems) => told(words::condition(), problems, locale),
            Self::Line(problems) => told(words::line(), problems, locale),
        }
    }
}

/// What is wrong with a part of a breakpoint, a line for each problem.
fn told(part: Words, problems: &[Problem], locale: Locale) -> String {
    let lines = problems.iter().map(|problem| {
        let problem = problem.in_locale(locale);
        format!("{}: {problem}", part.in_locale(locale))
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[derive(Clone, Debug)]
struct Kept {
    number: u32,
    point: Breakpoint,
    /// Where its block is in the program that runs.
    nodes: Vec<Node>,
    /// What its variable held when it was last looked at.
    held: Option<Value>,
    hits: u32,
}

/// All breakpoints of a debugger, and the lines that they have written.
#[derive(Clone, Debug, Default)]
pub struct Points {
    all: Vec<Kept>,
    numbers: u32,
    /// By node: whether there is a breakpoint.
    marked: Vec<bool>,
    /// How many stop at changes.
    watches: usize,
    lines: VecDeque<String>,
    lines_lost: u32,
}

impl Points {
    /// None, whose numbers go on after these.
    #[must_use]
    pub fn without_all(&self) -> Self {
        Self {
            numbers: self.numbers,
            ..Self::default()
        }
    }

    /// Adds a breakpoint; its number.
    ///
    /// # Errors
    /// [`NoBreakpoint`].
    pub fn add(&mut self, subject: &impl Subject, point: Breakpoint) -> Result<u32, NoBreakpoint> {
        if self.all.len() >= limits::BREAKPOINTS_MAX {
            return Err(NoBreakpoint::TooMany);
        }
        let longest = point.condition.len().max(point.log.len());
        if longest > limits::CONDITION_MAX {
            return Err(NoBreakpoint::TooLong);
        }
        let nodes = point.nodes(subject);
        match &point.at {
            Spot::Block(_) => {
                let Some(&first) = nodes.first() else {
                    return Err(NoBreakpoint::NoSuchBlock);
                };
                if let Some(why) = subject.never_stops(first) {
                    return Err(NoBreakpoint::NeverStops(why));
                }
            }
            Spot::Change(_) if self.watches >= limits::WATCHES_MAX => {
                return Err(NoBreakpoint::TooManyWatches);
            }
            Spot::Change(name) => refuse(subject.no_variable(name), NoBreakpoint::Variable)?,
        }
        let mistakes = |text: &str| mistakes(subject, text, &point.at);
        refuse(mistakes(&point.condition), NoBreakpoint::Condition)?;
        let of_line = aside::mistakes_of_line(&point.log, mistakes);
        refuse(of_line, NoBreakpoint::Line)?;
        self.numbers = self.numbers.wrapping_add(1);
        self.all.push(Kept {
            number: self.numbers,
            held: point.held(subject),
            point,
            nodes,
            hits: 0,
        });
        self.mark();
        Ok(self.numbers)
    }

    /// Takes one away, or all; false if there is none with this number.
    pub fn clear(&mut self, number: Option<u32>) -> bool {
        let before = self.all.len();
        self.all
            .retain(|kept| number.is_some_and(|number| kept.number != number));
        self.mark();
        number.is_none() || self.all.len() < before
    }

    /// Lets one do something or nothing; false if there is none with this number.
    pub fn enable(&mut self, number: u32, is_enabled: bool) -> bool {
        let mut points = self.all.iter_mut();
        let found = points.find(|kept| kept.number == number);
        found
            .map(|kept| kept.point.is_disabled = !is_enabled)
            .is_some()
    }

    /// All with their numbers, and how often each was hit.
    pub fn all(&self) -> impl Iterator<Item = (u32, &Breakpoint, u32)> {
        let kept = self.all.iter();
        kept.map(|kept| (kept.number, &kept.point, kept.hits))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The program that runs is another one: breakpoints are where their blocks are. Those of blocks that are gone wait
    /// until such a block comes back.
    pub fn bind(&mut self, subject: &impl Subject) {
        for kept in &mut self.all {
            kept.nodes = kept.point.nodes(subject);
        }
        self.mark();
    }

    fn mark(&mut self) {
        self.marked.clear();
        for &node in self.all.iter().flat_map(|kept| &kept.nodes) {
            let at = node as usize;
            if self.marked.len() <= at {
                self.marked.resize(at + 1, false);
            }
            self.marked[at] = true;
        }
        let watches = self.all.iter().filter(|kept| kept.point.is_watch());
        self.watches = watches.count();
    }

    /// Whether any stops at changes.
    pub fn has_watches(&self) -> bool {
        self.watches > 0
    }

    /// Whether one stops at changes of this variable.
    pub(super) fn is_watched(&self, variable: &str) -> bool {
        let watches = |kept: &Kept| match &kept.point.at {
            Spot::Change(name) => **name == *variable,
            Spot::Block(_) => false,
        };
        self.watches > 0 && self.all.iter().any(watches)
    }

    /// Somebody else has changed values: that is no change of the program's.
    pub fn look(&mut self, subject: &impl Subject) {
        for kept in &mut self.all {
            kept.held = kept.point.held(subject);
        }
    }

    /// Whether one is at a node.
    pub fn is_marked(&self, node: Node) -> bool {
        self.marked.get(node as usize).copied().unwrap_or(false)
    }

    /// What the breakpoints at a block do.
    pub fn at_block(&mut self, subject: &mut impl Subject, node: Node) -> Option<Reason> {
        if !self.is_marked(node) {
            return None;
        }
        self.meet(subject, |kept, _| {
            let is_here = kept.nodes.contains(&node);
            is_here.then_some(Reason::Breakpoint(kept.number))
        })
    }

    /// What those do whose variables have changed since they were last looked at; `by` is the block that has assigned
    /// a variable, if that is known.
    pub fn at_changes(
        &mut self,
        subject: &mut impl Subject,
        by: impl Fn(&str) -> Option<Node>,
    ) -> Option<Reason> {
        if self.watches == 0 {
            return None;
        }
        self.meet(subject, |kept, subject| {
            let is = kept.point.held(subject);
            let mut change = changed(kept, is)?;
            change.by = by(&change.variable);
            Some(Reason::Changed(Box::new(change)))
        })
    }

    fn meet<S: Subject>(
        &mut self,
        subject: &mut S,
        mut is_met: impl FnMut(&mut Kept, &S) -> Option<Reason>,
    ) -> Option<Reason> {
        let mut reason = None;
        let mut gone = None;
        for at in 0..self.all.len() {
            let kept = &mut self.all[at];
            let Some(why) = is_met(kept, subject) else {
                continue;
            };
            if kept.point.is_disabled {
                continue;
            }
            if !kept.point.condition.is_empty() {
                match subject.holds(&kept.point.condition) {
                    Ok(false) => continue,
                    Ok(true) => {}
                    Err(problems) => {
                        reason.get_or_insert(Reason::Condition(kept.number, problems));
                        continue;
                    }
                }
            }
            kept.hits = kept.hits.saturating_add(1);
            if kept.hits < kept.point.from_hit {
                continue;
            }
            if kept.point.log.is_empty() {
                if kept.point.is_once {
                    gone = Some(kept.number);
                }
                reason.get_or_insert(why);
            } else {
                let line = filled(&kept.point.log, subject);
                self.line(line);
            }
        }
        if gone.is_some() {
            self.clear(gone);
        }
        reason
    }

    /// The breakpoint that would stop at a block in the past: hits are not counted there, and nothing is logged.
    pub fn stops_at(&self, subject: &mut impl Subject, node: Node) -> Option<Reason> {
        let mut points = self.all.iter();
        let here = points.find(|kept| kept.nodes.contains(&node) && kept.point.would_stop(subject));
        here.map(|kept| Reason::Breakpoint(kept.number))
    }

    /// What variables that are watched hold, in the order of the breakpoints.
    pub fn watched(&self, subject: &impl Subject) -> Vec<Option<Value>> {
        let all = self.all.iter();
        all.map(|kept| kept.point.held(subject)).collect()
    }

    /// The breakpoint that would stop in the past because its variable is another one than `before`, which becomes what it
    /// is now.
    pub fn stops_at_changes(
        &self,
        subject: &mut impl Subject,
        before: &mut Vec<Option<Value>>,
    ) -> Option<Reason> {
        if self.watches == 0 {
            return None;
        }
        let now = self.watched(subject);
        let was = std::mem::replace(before, now);
        let all = self.all.iter().zip(was).zip(before);
        let mut changes = all.filter_map(|((kept, was), is)| {
            let change = Change::of(kept.number, &kept.point, was, is.clone())?;
            kept.point.would_stop(subject).then_some(change)
        });
        changes
            .next()
            .map(|change| Reason::Changed(Box::new(change)))
    }

    fn line(&mut self, line: String) {
        if self.lines.len() >= limits::DEBUG_LINES_MAX {
            self.lines.pop_front();
            self.lines_lost = self.lines_lost.saturating_add(1);
        }
        self.lines.push_back(line);
    }

    /// Lines of breakpoints that log, and how many were lost because nobody took them.
    pub fn take_lines(&mut self) -> (Vec<String>, u32) {
        let lost = std::mem::take(&mut self.lines_lost);
        (self.lines.drain(..).collect(), lost)
    }
}

impl Breakpoint {
    /// Whether it stops at changes.
    fn is_watch(&self) -> bool {
        match self.at {
            Spot::Block(_) => false,
            Spot::Change(_) => true,
        }
    }

    /// Where its block is.
    fn nodes(&self, subject: &impl Subject) -> Vec<Node> {
        match &self.at {
            Spot::Block(block) => subject.nodes(block),
            Spot::Change(_) => Vec::new(),
        }
    }

    /// What its variable holds.
    fn held(&self, subject: &impl Subject) -> Option<Value> {
        match &self.at {
            Spot::Block(_) => None,
            Spot::Change(name) => subject.value_of(name),
        }
    }

    /// Whether it stops where it is met, whatever its hits.
    fn would_stop(&self, subject: &mut impl Subject) -> bool {
        let mut holds = || subject.holds(&self.condition) == Ok(true);
        !self.is_disabled && self.log.is_empty() && (self.condition.is_empty() || holds())
    }
}

fn refuse(
    problems: Vec<Problem>,
    why: impl FnOnce(Vec<Problem>) -> NoBreakpoint,
) -> Result<(), NoBreakpoint> {
    match problems.is_empty() {
        true => Ok(()),
        false => Err(why(problems)),
    }
}

/// What is wrong with an expression whatever the program does; an empty one is none.
fn mistakes(subject: &impl Subject, text: &str, at: &Spot) -> Vec<Problem> {
    match text.trim() {
        "" => Vec::new(),
        _ => subject.mistakes(text, at),
    }
}

/// Whether what is kept of a variable is another value now, which becomes what is kept.
fn changed(kept: &mut Kept, is: Option<Value>) -> Option<Change> {
    let was = std::mem::replace(&mut kept.held, is.clone());
    Change::of(kept.number, &kept.point, was, is)
}

impl Change {
    fn of(number: u32, point: &Breakpoint, was: Option<Value>, is: Option<Value>) -> Option<Self> {
        let Spot::Change(variable) = &point.at else {
            return None;
        };
        let is_same = match (&was, &is) {
            (Some(was), Some(is)) => same(was, is),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        };
        (!is_same).then(|| Self {
            number,
            variable: variable.clone(),
            was,
            is,
            by: None,
        })
    }
}

/// Whether two values are the same; one that is no number is the same as itself.
fn same(one: &Value, other: &Value) -> bool {
    match one {
        Value::Nil => matches!(other, Value::Nil),
        Value::Unset => matches!(other, Value::Unset),
        Value::Bool(one) => matches!(other, Value::Bool(other) if one == other),
        Value::Int(one) => matches!(other, Value::Int(other) if one == other),
        Value::Float(one) => {
            matches!(other, Value::Float(other) if one.to_bits() == other.to_bits())
        }
        Value::Text(one) => matches!(other, Value::Text(other) if one == other),
        Value::List(one) => {
            let Value::List(other) = other else {
                return false;
            };
            let (ones, others) = (one.items(), other.items());
            let mut pairs = ones.iter().zip(others);
            std::rc::Rc::ptr_eq(one, other)
                || ones.len() == others.len() && pairs.all(|(one, other)| same(one, other))
        }
    }
}

/// A line with values instead of each `{expression}`; what cannot be computed says why.
fn filled(line: &str, subject: &mut impl Subject) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some((before, after)) = rest.split_once('{') {
        out.push_str(before);
        let Some((expression, after)) = after.split_once('}') else {
            out.push('{');
            rest = after;
            continue;
        };
        match subject.value(expression) {
            Ok(value) => out.push_str(&value.to_text()),
            Err(problems) => {
                let why = problems.first().map(|problem| &*problem.words.english);
                out.push('<');
                out.push_str(why.unwrap_or("?"));
                out.push('>');
            }
        }
        rest = after;
        if out.len() > limits::DEBUG_LINE_BYTES_MAX {
            break;
        }
    }
    out.push_str(rest);
    let end = out.floor_char_boundary(limits::DEBUG_LINE_BYTES_MAX);
    out.truncate(end);
    out
}
