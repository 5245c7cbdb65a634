//! The metric: places to points, samples, and how far it is to the goal.
//!
//! Owns scaling, circles and bounds. Knows no system and no obstacle.

use super::obstacles::flat::wrapped;
use super::random::Random;
use super::{Axis, Problem};
use std::f64::consts::TAU;

/// The weighted axes of a problem as coordinates.
pub(super) struct Space {
    axes: Vec<Axis>,
    /// Place among all axes of the problem, value: what the goal wants of weighted axes.
    wanted: Vec<Option<f64>>,
}

impl Space {
    pub(super) fn new(problem: &Problem) -> Self {
        let mut wanted = vec![None; problem.axes.len()];
        for (axis, value) in problem.goal.iter().flat_map(|goal| &goal.wanted) {
            wanted[*axis] = Some(*value);
        }
        let weighted = |(axis, _): &(&Axis, Option<f64>)| axis.weight > 0.0;
        let (axes, wanted) = problem
            .axes
            .iter()
            .zip(wanted)
            .filter(weighted)
            .map(|(axis, value)| (*axis, value))
            .unzip();
        Self { axes, wanted }
    }

    /// For [`super::nearest::Nearest`].
    pub(super) fn periods(&self) -> Vec<f64> {
        let period = |axis: &Axis| {
            if axis.is_angle {
                TAU * axis.weight
            } else {
                f64::INFINITY
            }
        };
        self.axes.iter().map(period).collect()
    }

    /// The point of a place.
    pub(super) fn project(&self, place: &[f64], point: &mut Vec<f64>) {
        point.clear();
        point.extend(self.axes.iter().map(|axis| scaled(axis, place[axis.part])));
    }

    /// Any point; where the goal wants something, that if it is aimed at.
    pub(super) fn sample(&self, random: &mut Random, aims: bool, point: &mut Vec<f64>) {
        point.clear();
        for (axis, wanted) in self.axes.iter().zip(&self.wanted) {
            let any = random.between(axis.low, axis.high);
            let value = wanted.filter(|_| aims).unwrap_or(any);
            point.push(scaled(axis, value));
        }
    }

    /// The squared distance of two points.
    pub(super) fn square(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut sum = 0.0;
        for ((a, b), axis) in a.iter().zip(b).zip(&self.axes) {
            let mut gap = (a - b).abs();
            if axis.is_angle {
                gap = gap.min((TAU * axis.weight - gap).abs());
            }
            sum += gap * gap;
        }
        sum
    }
}

fn scaled(axis: &Axis, value: f64) -> f64 {
    let value = if axis.is_angle { wrapped(value) } else { value };
    value * axis.weight
}

/// Whether a place is a number everywhere and within the bounds of its axes.
pub(super) fn is_inside(axes: &[Axis], place: &[f64]) -> bool {
    place.iter().all(|one| one.is_finite()) && axes.iter().all(|axis| is_within(axis, place))
}

/// Whether a place is within the bounds of one axis; an angle has none.
pub(super) fn is_within(axis: &Axis, place: &[f64]) -> bool {
    axis.is_angle || (axis.low..=axis.high).contains(&place[axis.part])
}

fn difference(axis: &Axis, value: f64, wanted: f64) -> f64 {
    let gap = value - wanted;
    if axis.is_angle { wrapped(gap) } else { gap }
}

/// Whether a place is in the goal.
pub(super) fn is_in_goal(problem: &Problem, place: &[f64]) -> bool {
    problem.goal.iter().all(|goal| {
        let square = |(axis, wanted): &(usize, f64)| {
            let axis = &problem.axes[*axis];
            let gap = difference(axis, place[axis.part], *wanted);
            gap * gap
        };
        goal.wanted.iter().map(square).sum::<f64>() <= goal.tolerance * goal.tolerance
    })
}

/// How far a place is from the goal in the metric; an axis without a weight counts as it is.
pub(super) fn to_goal(problem: &Problem, place: &[f64]) -> f64 {
    let wanted = problem.goal.iter().flat_map(|goal| &goal.wanted);
    let square = |(axis, wanted): &(usize, f64)| {
        let axis = &problem.axes[*axis];
        let weight = if axis.weight > 0.0 { axis.weight } else { 1.0 };
        let gap = weight * difference(axis, place[axis.part], *wanted);
        gap * gap
    };
    wanted.map(square).sum::<f64>().sqrt()
}

/// Whether something of the goal is within the bounds of the axes.
pub(super) fn goal_is_inside(problem: &Problem) -> bool {
    problem.goal.iter().all(|goal| {
        goal.wanted.iter().all(|(axis, wanted)| {
            let axis = &problem.axes[*axis];
            let tolerance = goal.tolerance;
            axis.is_angle || (axis.low - tolerance..=axis.high + tolerance).contains(wanted)
        })
    })
}
