//! Rigid links: two points of a robot whose distance the equations of the model do not keep by themselves, only the choice
//! of actions does, as in a robot of two steered blocks below one body.
//!
//! Owns how far a place is from its links, and how an action is bent until it keeps them. Knows no obstacle.

use super::motion::Propagator;
use super::{Problem, Refusal};
use crate::limits::{PLAN_LINK_ROUNDS, PLAN_LINKS_MAX};
use lang_dcml::system::System;

/// Two points of the place whose distance at the start stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// x and y of one point, as numbers of parts of the place.
    pub from: [usize; 2],
    /// The same of the other.
    pub to: [usize; 2],
    /// The distance may differ by so much from that at the start, in the unit of the model.
    pub tolerance: f64,
}

impl Link {
    /// How far the points are apart.
    pub fn length(&self, place: &[f64]) -> f64 {
        let part = |at: usize| place.get(at).copied().unwrap_or(f64::NAN);
        let along = |axis: usize| part(self.to[axis]) - part(self.from[axis]);
        let (x, y) = (along(0), along(1));
        // A root is exact on every processor, and `hypot` is not.
        (x * x + y * y).sqrt()
    }
}

/// Whether the links of a problem mean something.
pub(super) fn check(problem: &Problem, parts: usize) -> Result<(), Refusal> {
    let links = &problem.links;
    if links.len() > PLAN_LINKS_MAX {
        let count = links.len();
        let why = format!("{count} links are more than {PLAN_LINKS_MAX}");
        return Err(Refusal::Wrong(why));
    }
    for link in links {
        let all = link.from.iter().chain(&link.to);
        if all.into_iter().any(|part| *part >= parts) {
            let why = "a link names a part of the place that is not there";
            return Err(Refusal::Wrong(why.to_owned()));
        }
        if link.from == link.to {
            let why = "a link joins a point to itself: name two points";
            return Err(Refusal::Wrong(why.to_owned()));
        }
        if !(link.tolerance > 0.0 && link.tolerance.is_finite()) {
            let why = format!(
                "{} is no tolerance of a link: it is above 0",
                link.tolerance
            );
            return Err(Refusal::Wrong(why));
        }
    }
    Ok(())
}

/// The links of one search with their lengths.
pub(super) struct Links {
    all: Vec<(Link, f64)>,
    /// Room for a place on its way, for the action that is tried, and for how each number of it counts.
    place: Vec<f64>,
    action: Vec<f64>,
    slope: Vec<f64>,
}

impl Links {
    pub(super) fn new(problem: &Problem, root: &[f64]) -> Self {
        let all = problem.links.iter();
        Self {
            all: all.map(|link| (*link, link.length(root))).collect(),
            place: Vec::new(),
            action: Vec::new(),
            slope: Vec::new(),
        }
    }

    /// Whether a place keeps all of them.
    pub(super) fn hold(&self, place: &[f64]) -> bool {
        let holds = |(link, length): &(Link, f64)| {
            let gap = link.length(place) - length;
            gap.abs() <= link.tolerance
        };
        self.all.iter().all(holds)
    }

    /// Bends an action that is held for some steps from a place so that the links have their lengths at the end: Newton's
    /// method, of whose steps each is the least change in shares of the ranges. What is still wrong then is found by
    /// [`Self::hold`], as is what lies between.
    pub(super) fn bend<S: System + ?Sized>(
        &mut self,
        propagator: &mut Propagator<'_, S>,
        problem: &Problem,
        from: &[f64],
        steps: u32,
        action: &mut [f64],
    ) {
        if self.all.is_empty() {
            return;
        }
        for _ in 0..PLAN_LINK_ROUNDS {
            for at in 0..self.all.len() {
                let now = self.after(propagator, at, from, steps, action);
                self.slope.clear();
                let mut sum = 0.0;
                for (one, (low, high)) in problem.actions.iter().enumerate() {
                    let range = high - low;
                    let little = range * 1e-4;
                    let mut slope = 0.0;
                    if little > 0.0 {
                        let kept = action[one];
                        action[one] = kept + little;
                        let then = self.after(propagator, at, from, steps, action);
                        action[one] = kept;
                        slope = (then - now) / little * range;
                    }
                    sum += slope * slope;
                    self.slope.push(slope * range);
                }
                let (_, length) = self.all[at];
                let wanted = (length - now) / sum;
                if sum > 0.0 && wanted.is_finite() {
                    for (value, slope) in action.iter_mut().zip(&self.slope) {
                        *value += slope * wanted;
                    }
                }
            }
            into_range(action, &problem.actions);
        }
    }

    /// The length of a link after an action was held for some steps.
    fn after<S: System + ?Sized>(
        &mut self,
        propagator: &mut Propagator<'_, S>,
        link: usize,
        from: &[f64],
        steps: u32,
        action: &[f64],
    ) -> f64 {
        self.place.clear();
        self.place.extend_from_slice(from);
        self.action.clear();
        self.action.extend_from_slice(action);
        for _ in 0..steps {
            propagator.advance(&mut self.place, &self.action);
        }
        self.all[link].0.length(&self.place)
    }
}

/// Brings an action into its ranges: slower as a whole where that is possible, since what keeps a link at one speed keeps
/// it at another.
fn into_range(action: &mut [f64], ranges: &[(f64, f64)]) {
    let mut share: f64 = 1.0;
    for (value, (low, high)) in action.iter().zip(ranges) {
        let end = if *value > 0.0 { *high } else { *low };
        if value.abs() > end.abs() && value * end >= 0.0 {
            share = share.min(end / value);
        }
    }
    for (value, (low, high)) in action.iter_mut().zip(ranges) {
        *value = (*value * share).clamp(*low, *high);
        if value.is_nan() {
            *value = *low;
        }
    }
}
