//! What keeps a robot from standing at one place.
//!
//! Owns the words for it. Found once, after a planner has refused a start; searching itself only asks whether.

use crate::obstacles::{Footprint, Obstacles, Pose, Shape};
use crate::space::is_within;
use crate::{Axis, Problem};

/// The first thing that is in the way.
#[derive(Clone, Debug, PartialEq)]
pub enum Hindrance {
    /// A part of the place, by its number, is no finite number.
    NoNumber {
        /// The part.
        part: usize,
    },
    /// A part of the place is outside of its range.
    Range {
        /// The part.
        part: usize,
        /// What it is.
        value: f64,
        /// From where to where it may be.
        range: (f64, f64),
    },
    /// A body leaves the rectangle that a robot must not leave.
    Workspace {
        /// The body; 0 is the robot, the others count from 1.
        body: usize,
    },
    /// A body touches an obstacle, or is nearer to it than the distance that is kept.
    Shape {
        /// As in [`Workspace`](Self::Workspace).
        body: usize,
        /// The obstacle.
        shape: Shape,
        /// The distance that is kept; None if the body touches it.
        kept: Option<f64>,
    },
    /// The surroundings say no more.
    Other,
}

/// Which part of a place is no number or out of its range.
pub(crate) fn of_ranges(problem: &Problem, place: &[f64]) -> Option<Hindrance> {
    if let Some(part) = place.iter().position(|one| !one.is_finite()) {
        return Some(Hindrance::NoNumber { part });
    }
    let outside = |axis: &&Axis| !is_within(axis, place);
    problem.axes.iter().find(outside).map(|axis| {
        let part = axis.part;
        Hindrance::Range {
            part,
            value: place.get(part).copied().unwrap_or(f64::NAN),
            range: (axis.low, axis.high),
        }
    })
}

/// What a body meets at a pose if it keeps a distance of `margin`.
pub(crate) fn of_body(
    obstacles: &Obstacles,
    body: usize,
    footprint: &Footprint,
    pose: Pose,
    margin: f64,
) -> Option<Hindrance> {
    let alone = |shapes, workspace| Obstacles::new(shapes, workspace);
    let border = alone(Vec::new(), obstacles.workspace()).ok()?;
    if border.meets(footprint, pose, margin) {
        return Some(Hindrance::Workspace { body });
    }
    obstacles.shapes().iter().find_map(|shape| {
        let one = alone(vec![shape.clone()], None).ok()?;
        one.meets(footprint, pose, margin)
            .then(|| Hindrance::Shape {
                body,
                shape: shape.clone(),
                kept: (!one.meets(footprint, pose, 0.0)).then_some(margin),
            })
    })
}

impl Hindrance {
    /// What is in the way, for people; `names` are those of the parts of a place.
    pub fn told(&self, names: &[String]) -> String {
        let name = |part: usize| match names.get(part) {
            Some(name) => name.clone(),
            None => format!("part {} of the place", part + 1),
        };
        let who = |body: usize| match body {
            0 => "the robot".to_owned(),
            number => format!("body {number}"),
        };
        match self {
            Self::NoNumber { part } => format!("{} is no finite number there", name(*part)),
            Self::Range { part, value, range } => {
                let (low, high) = range;
                format!(
                    "{} is {value} there, outside of {low} .. {high}",
                    name(*part)
                )
            }
            Self::Workspace { body } => {
                format!("{} leaves the bounds of the obstacles", who(*body))
            }
            Self::Shape { body, shape, kept } => {
                let shape = shape.told();
                match kept {
                    None => format!("{} touches the {shape}", who(*body)),
                    Some(margin) => format!(
                        "{} is nearer than {margin} to the {shape}, half of the resolution",
                        who(*body)
                    ),
                }
            }
            Self::Other => "something is in the way".to_owned(),
        }
    }
}
