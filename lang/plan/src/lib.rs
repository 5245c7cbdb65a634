//! Sampling-based planners for robots with differential constraints: RRT (LaValle, Kuffner) and SST (Li, Littlefield,
//! Bekris) over any [`System`].
//!
//! Owns the question and the answer, and checks the first. Knows a robot through [`System`] and what is in its way
//! through [`Surroundings`] only; [`room`] puts both together for robots on a plane with [`obstacles`]. No clock: a caller that
//! wants a limit of time looks at its own in the report of progress. The same question with the same seed has the same
//! answer: the planner itself uses only operations that are exact on every processor, so answers differ between machines
//! only as far as the functions of the system do.

pub mod fault;
pub mod hindrance;
pub mod limits;
pub mod link;
mod motion;
pub mod nearest;
pub mod obstacles;
pub mod path;
pub mod random;
pub mod room;
mod search;
mod space;
pub mod tree;

use std::fmt;

pub use fault::Fault;
pub use hindrance::Hindrance;
pub use link::Link;
pub use motion::Propagator;
pub use path::Path;

use self::search::Search;
use self::tree::Tree;
use crate::limits::{
    PLAN_AXES_MAX, PLAN_HOLD_MAX, PLAN_ITERATIONS_MAX, PLAN_NODES_MAX, PLAN_NUMBERS_MAX,
};
use lang_dcml::system::System;

/// What may be asked. A *place* is a state followed by the outputs of the system.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The state in which the robot is.
    pub start: Vec<f64>,
    /// In which parts of the place distances are measured, and where they may be. At least one has a weight.
    pub axes: Vec<Axis>,
    /// All of it must hold at the end.
    pub goal: Vec<Goal>,
    /// From where to where each action may be.
    pub actions: Vec<(f64, f64)>,
    /// Seconds of one step of the solver.
    pub step: f64,
    /// An action is held for so many steps, at least and at most.
    pub hold: (u32, u32),
    /// Points whose distance stays what it is at the start.
    pub links: Vec<Link>,
}

/// A part of the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Its number in the place.
    pub part: usize,
    /// How much a difference of 1 counts.
    pub weight: f64,
    /// Where it is sampled; unless it is an angle the robot must not leave this.
    pub low: f64,
    /// The other end.
    pub high: f64,
    /// An angle: distances are measured the short way round.
    pub is_angle: bool,
}

/// Axes that must be near to values, together: the root of the sum of the squared differences is at most the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Number of the axis, and the value.
    pub wanted: Vec<(usize, f64)>,
    /// How near.
    pub tolerance: f64,
}

/// How it is searched.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Which planner.
    pub method: Method,
    /// Of all random numbers.
    pub seed: u64,
    /// How often the goal is aimed at, from 0 to 1.
    pub goal_bias: f64,
    /// Actions that are tried from one place before the best is taken; SST takes the first.
    pub attempts: u32,
    /// After so many samples it ends.
    pub iterations: u64,
    /// So many places are kept in memory; RRT ends when they are full, SST no longer grows.
    pub nodes: usize,
}

/// The planners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Rapidly exploring random tree: ends with the first path.
    Rrt,
    /// Stable sparse RRT: goes on for shorter times until a limit. Distances in the metric of the axes.
    Sst {
        /// Among places so near to a sample the one that is reached soonest is gone on from.
        selection: f64,
        /// Of places so near to each other only the one that is reached soonest is kept.
        pruning: f64,
    },
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Rrt,
            seed: 1,
            goal_bias: 0.05,
            attempts: 4,
            iterations: 1_000_000,
            nodes: PLAN_NODES_MAX,
        }
    }
}

/// Where a robot may be.
pub trait Surroundings {
    /// Whether it may be at this place.
    fn allows(&mut self, place: &[f64]) -> bool;

    /// Whether it may go from a place where it may be to one a step of the solver further.
    fn allows_way(&mut self, from: &[f64], to: &[f64]) -> bool;

    /// What is in the way at a place where it may not be.
    fn hindrance(&mut self, _place: &[f64]) -> Hindrance {
        Hindrance::Other
    }

    /// Whether there may be a place in the goal at all; where this cannot be said it may.
    fn allows_goal(&mut self, _problem: &Problem) -> bool {
        true
    }
}

/// Nothing is in the way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Anywhere;

impl Surroundings for Anywhere {
    fn allows(&mut self, _: &[f64]) -> bool {
        true
    }

    fn allows_way(&mut self, _: &[f64], _: &[f64]) -> bool {
        true
    }
}

/// How far it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Samples.
    pub iterations: u64,
    /// Actions that were tried.
    pub propagations: u64,
    /// Steps of the solver.
    pub steps: u64,
    /// Steps that met something, left the bounds or were no numbers.
    pub collisions: u64,
    /// Places in memory.
    pub nodes: usize,
    /// The least distance to the goal so far, in the metric of the axes that the goal names.
    pub nearest: f64,
    /// Seconds of the best path so far.
    pub best: Option<f64>,
}

/// Why it ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum End {
    /// RRT has a path.
    Found,
    /// All samples are used up.
    Iterations,
    /// The memory is full.
    Nodes,
    /// The caller wanted it.
    Stopped,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The best path, if there is one.
    pub path: Option<Path>,
    /// Why it ended.
    pub end: End,
    /// What it took.
    pub counts: Counts,
    /// The place nearest to the goal that was reached.
    pub nearest: Vec<f64>,
    /// All places at the end.
    pub tree: Tree,
}

/// Why a problem cannot be searched.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The system has no states.
    NoStates,
    /// The system has no actions.
    NoActions,
    /// A part of the question means nothing.
    Wrong(String),
    /// The robot cannot stand where it is to start.
    Start(Hindrance),
    /// No place of the goal is free.
    Goal,
    /// Whatever is done at the start, what comes of it is no number.
    NoNumbers,
}

impl Refusal {
    /// Why, for people; `names` are those of the parts of a place.
    pub fn told(&self, names: &[String]) -> String {
        let text = match self {
            Self::NoStates => "the model has no states: nothing moves",
            Self::NoActions => "the model has no actions: nothing can be chosen",
            Self::Wrong(reason) => reason,
            Self::Start(hindrance) => {
                return format!("the start is not free: {}", hindrance.told(names));
            }
            Self::Goal => "no place in the goal is free: it is out of bounds or in an obstacle",
            Self::NoNumbers => {
                "at the start the model gives no finite numbers: check parameters and start"
            }
        };
        text.to_owned()
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.told(&[]))
    }
}

/// Searches. `report` is asked every few samples and ends the search when it says no.
///
/// # Errors
/// The problem cannot be searched.
pub fn plan<S, W, R>(
    system: &mut S,
    surroundings: &mut W,
    problem: &Problem,
    options: &Options,
    report: &mut R,
) -> Result<Outcome, Refusal>
where
    S: System + ?Sized,
    W: Surroundings + ?Sized,
    R: FnMut(&Counts) -> bool + ?Sized,
{
    check(system, problem)?;
    check_options(options)?;
    let mut propagator = Propagator::new(system, problem.step);
    let place = propagator.place(&problem.start);
    if let Some(hindrance) = hindrance::of_ranges(problem, &place) {
        return Err(Refusal::Start(hindrance));
    }
    if !surroundings.allows(&place) {
        return Err(Refusal::Start(surroundings.hindrance(&place)));
    }
    if !moves_from(&mut propagator, &place, &problem.actions) {
        return Err(Refusal::NoNumbers);
    }
    if !space::goal_is_inside(problem) || !surroundings.allows_goal(problem) {
        return Err(Refusal::Goal);
    }
    Ok(Search::new(propagator, surroundings, problem, options, &place).run(report))
}

/// Whether any of the least, middle and greatest actions leads from a place to one that is a place.
fn moves_from<S: System + ?Sized>(
    propagator: &mut Propagator<'_, S>,
    place: &[f64],
    ranges: &[(f64, f64)],
) -> bool {
    [0.0, 0.5, 1.0].into_iter().any(|share| {
        let within = |(low, high): &(f64, f64)| low + share * (high - low);
        let action: Vec<f64> = ranges.iter().map(within).collect();
        let mut next = place.to_vec();
        propagator.advance(&mut next, &action);
        next.iter().all(|number| number.is_finite())
    })
}

fn check<S: System + ?Sized>(system: &S, problem: &Problem) -> Result<(), Refusal> {
    let (states, actions) = (system.states(), system.actions());
    if states == 0 {
        return Err(Refusal::NoStates);
    }
    if actions == 0 {
        return Err(Refusal::NoActions);
    }
    let wrong = |reason: String| Err(Refusal::Wrong(reason));
    let parts = states + system.outputs();
    if parts + actions > PLAN_NUMBERS_MAX {
        return wrong(format!(
            "{} states, outputs and actions are more than {PLAN_NUMBERS_MAX}",
            parts + actions
        ));
    }
    if problem.start.len() != states || problem.start.iter().any(|one| !one.is_finite()) {
        return wrong(format!("a start has {states} finite numbers"));
    }
    if problem.actions.len() != actions {
        return wrong(format!("there are {actions} ranges of actions"));
    }
    for (at, (low, high)) in problem.actions.iter().enumerate() {
        if !is_range(*low, *high) {
            return wrong(format!("action {}: {low} .. {high} is no range", at + 1));
        }
    }
    if !(problem.step > 0.0 && problem.step.is_finite()) {
        return wrong(format!("{} is no step of time", problem.step));
    }
    let (least, most) = problem.hold;
    if least == 0 || least > most || most > PLAN_HOLD_MAX {
        return wrong(format!(
            "an action is held for 1 to {PLAN_HOLD_MAX} steps, not for {least} to {most}"
        ));
    }
    link::check(problem, parts)?;
    check_axes(problem, parts)
}

fn is_range(low: f64, high: f64) -> bool {
    low.is_finite() && high.is_finite() && low <= high && (high - low).is_finite()
}

fn check_axes(problem: &Problem, parts: usize) -> Result<(), Refusal> {
    let wrong = |reason: String| Err(Refusal::Wrong(reason));
    let axes = &problem.axes;
    if axes.len() > PLAN_AXES_MAX {
        return wrong(format!("{} axes are more than {PLAN_AXES_MAX}", axes.len()));
    }
    for (at, axis) in axes.iter().enumerate() {
        let is_weight = axis.weight.is_finite() && (0.0..=1e9).contains(&axis.weight);
        if axis.part >= parts || !is_weight || !is_range(axis.low, axis.high) {
            return wrong(format!(
                "axis {}: weight {}, {} .. {} means nothing",
                at + 1,
                axis.weight,
                axis.low,
                axis.high
            ));
        }
    }
    if axes.iter().all(|axis| axis.weight == 0.0) {
        return wrong("no axis has a weight: there are no distances".to_owned());
    }
    if problem.goal.iter().all(|goal| goal.wanted.is_empty()) {
        return wrong("there is no goal".to_owned());
    }
    for goal in &problem.goal {
        let is_known = |(axis, value): &(usize, f64)| *axis < axes.len() && value.is_finite();
        if !goal.wanted.iter().all(is_known) || goal.wanted.len() > PLAN_AXES_MAX {
            return wrong("the goal is no value of an axis".to_owned());
        }
        if !(goal.tolerance > 0.0 && goal.tolerance.is_finite()) {
            return wrong(format!(
                "{} is no tolerance of a goal: it is above 0",
                goal.tolerance
            ));
        }
    }
    Ok(())
}

fn check_options(options: &Options) -> Result<(), Refusal> {
    let wrong = |reason: String| Err(Refusal::Wrong(reason));
    if !(0.0..=1.0).contains(&options.goal_bias) {
        return wrong(format!(
            "a share of {} for the goal is not from 0 to 1",
            options.goal_bias
        ));
    }
    if !(1..=1000).contains(&options.attempts) {
        return wrong(format!("{} attempts are not 1 to 1000", options.attempts));
    }
    if options.iterations > PLAN_ITERATIONS_MAX {
        return wrong(format!(
            "{} iterations are more than {PLAN_ITERATIONS_MAX}",
            options.iterations
        ));
    }
    if !(1..=PLAN_NODES_MAX).contains(&options.nodes) {
        return wrong(format!(
            "{} nodes are not 1 to {PLAN_NODES_MAX}",
            options.nodes
        ));
    }
    if let Method::Sst { selection, pruning } = options.method
        && !(selection > 0.0 && selection.is_finite() && pruning > 0.0 && pruning.is_finite())
    {
        return wrong(format!(
            "radii of SST are above 0, not {selection} and {pruning}"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod whole;
