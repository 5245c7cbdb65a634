//! A robot on a plane among obstacles: which parts of its place say where it is, and what it covers.
//!
//! Owns the way from places to poses. Knows no planner.

use super::hindrance::{self, Hindrance};
use super::obstacles::flat::{Point, wrapped};
use super::obstacles::{Footprint, Obstacles, Pose};
use super::{Fault, Problem, Surroundings};
use crate::limits::{PLAN_BODIES_MAX, PLAN_GOAL_TRIES};

/// Which parts of a place are a pose.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Parts {
    /// To the right.
    pub x: usize,
    /// Up.
    pub y: usize,
    /// The heading in radians; without one the footprint never turns.
    pub heading: Option<usize>,
}

impl Parts {
    /// The pose of a place.
    pub fn pose(self, place: &[f64]) -> Pose {
        let part = |at: usize| place.get(at).copied().unwrap_or(f64::NAN);
        Pose {
            at: [part(self.x), part(self.y)],
            heading: self.heading.map_or(0.0, part),
        }
    }
}

/// One more body of a robot, such as a trailer or a steered block.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Where it is.
    pub parts: Parts,
    /// What it covers, seen from there.
    pub footprint: Footprint,
}

/// A robot among obstacles.
#[derive(Clone, Debug)]
pub struct Room<'a> {
    obstacles: &'a Obstacles,
    footprint: &'a Footprint,
    parts: Parts,
    /// Other bodies of the robot.
    bodies: &'a [Body],
    resolution: f64,
    corners: Vec<Point>,
}

impl<'a> Room<'a> {
    /// A robot is kept half a `resolution` away from obstacles.
    ///
    /// # Errors
    /// The resolution is none.
    pub fn new(
        obstacles: &'a Obstacles,
        footprint: &'a Footprint,
        parts: Parts,
        resolution: f64,
    ) -> Result<Self, Fault> {
        if !(resolution > 0.0 && resolution.is_finite()) {
            return Err(Fault::Resolution(resolution));
        }
        Ok(Self {
            obstacles,
            footprint,
            parts,
            bodies: &[],
            resolution,
            corners: Vec::new(),
        })
    }

    /// The same robot with more bodies: none of them may meet an obstacle.
    ///
    /// # Errors
    /// There are too many.
    pub fn with_bodies(self, bodies: &'a [Body]) -> Result<Self, Fault> {
        if bodies.len() > PLAN_BODIES_MAX {
            return Err(Fault::Bodies(bodies.len()));
        }
        Ok(Self { bodies, ..self })
    }
}

impl Surroundings for Room<'_> {
    fn allows(&mut self, place: &[f64]) -> bool {
        let (obstacles, margin) = (self.obstacles, self.resolution / 2.0);
        let is_free = |footprint: &Footprint, parts: Parts| {
            !obstacles.meets(footprint, parts.pose(place), margin)
        };
        is_free(self.footprint, self.parts)
            && self
                .bodies
                .iter()
                .all(|body| is_free(&body.footprint, body.parts))
    }

    fn allows_way(&mut self, from: &[f64], to: &[f64]) -> bool {
        let (obstacles, resolution) = (self.obstacles, self.resolution);
        let corners = &mut self.corners;
        let mut is_free = |footprint: &Footprint, parts: Parts| {
            let (from, to) = (parts.pose(from), parts.pose(to));
            !obstacles.meets_between(footprint, from, to, resolution, corners)
        };
        is_free(self.footprint, self.parts)
            && self
                .bodies
                .iter()
                .all(|body| is_free(&body.footprint, body.parts))
    }

    fn hindrance(&mut self, place: &[f64]) -> Hindrance {
        let bodies = self.bodies.iter().map(|body| (&body.footprint, body.parts));
        let mut all = std::iter::once((self.footprint, self.parts))
            .chain(bodies)
            .enumerate();
        let margin = self.resolution / 2.0;
        let found = all.find_map(|(body, (footprint, parts))| {
            hindrance::of_body(self.obstacles, body, footprint, parts.pose(place), margin)
        });
        found.unwrap_or(Hindrance::Other)
    }

    /// Looks at poses all over the goal.
    fn allows_goal(&mut self, problem: &Problem) -> bool {
        let wanted = |part: usize| {
            let axis = problem.axes.iter().position(|axis| axis.part == part)?;
            problem.goal.iter().find_map(|goal| {
                let (_, value) = goal.wanted.iter().find(|(one, _)| *one == axis)?;
                Some((*value, goal.tolerance))
            })
        };
        let (Some((x, far_x)), Some((y, far_y))) = (wanted(self.parts.x), wanted(self.parts.y))
        else {
            return true;
        };
        let (heading, turn) = self
            .parts
            .heading
            .and_then(wanted)
            .unwrap_or((0.0, std::f64::consts::PI));
        // Rings around the middle, the middle first: half way out, then further.
        let golden = 2.399_963_229_728_653;
        (0..PLAN_GOAL_TRIES).any(|at| {
            let share = f64::from(at) / f64::from(PLAN_GOAL_TRIES);
            let (sine, cosine) =
                super::obstacles::flat::sine_and_cosine(wrapped(golden * f64::from(at)));
            let out = share.sqrt();
            // Headings go through their range many times on the way out.
            let around = f64::from((at * 7) % 32) / 31.0 * 2.0 - 1.0;
            let pose = Pose {
                at: [x + far_x * out * cosine, y + far_y * out * sine],
                heading: heading
                    + if at == 0 {
                        0.0
                    } else {
                        turn.min(std::f64::consts::PI) * around
                    },
            };
            !self.obstacles.meets(self.footprint, pose, 0.0)
        })
    }
}
