//! What stands in the way of a robot on the plane, and whether a robot that is moved from one place to another meets it.
//!
//! Owns shapes, footprints and the index over them; lengths have the unit of the model, metres as a rule. Knows no model
//! and no planner. [`text`] reads obstacles from a file's text.

pub mod flat;
mod index;
pub mod text;

use self::flat::{
    Point, between_segments, cross, is_inside, is_inside_convex, minus, sine_and_cosine,
    to_segment, wrapped,
};
use self::index::{Bounds, Index};
use crate::fault::Fault;
use crate::limits::{
    PLAN_COORDINATE_MAX, PLAN_CORNERS_MAX, PLAN_OBSTACLES_MAX, PLAN_SWEEP_STEPS_MAX,
};

/// Where a robot is and where it looks, in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Where.
    pub at: Point,
    /// Counter-clockwise from the x axis.
    pub heading: f64,
}

/// One obstacle.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box along the axes, between any two opposite corners.
    Rectangle(Point, Point),
    /// A polygon, convex or not, without holes.
    Polygon(Vec<Point>),
    /// A straight bar of some thickness, 0 too.
    Wall(Point, Point, f64),
    /// A disc: centre and radius.
    Circle(Point, f64),
}

impl Shape {
    /// Its corners; none for a disc.
    pub fn corners(&self) -> Vec<Point> {
        match self {
            Self::Rectangle(a, b) => vec![*a, [b[0], a[1]], *b, [a[0], b[1]]],
            Self::Polygon(corners) => corners.clone(),
            Self::Wall(from, to, thickness) => {
                let along = minus(*to, *from);
                let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
                // A wall without length is as thick as it is wide.
                let unit = if length > 0.0 {
                    [along[0] / length, along[1] / length]
                } else {
                    [1.0, 0.0]
                };
                let half = thickness / 2.0;
                let out = [-unit[1] * half, unit[0] * half];
                vec![
                    minus(*from, out),
                    minus(*to, out),
                    [to[0] + out[0], to[1] + out[1]],
                    [from[0] + out[0], from[1] + out[1]],
                ]
            }
            Self::Circle(..) => Vec::new(),
        }
    }

    /// What it is and where, as a line of [`text`] has it; of a polygon the first corner.
    pub fn told(&self) -> String {
        match self {
            Self::Rectangle([a, b], [c, d]) => format!("rectangle {a} {b} {c} {d}"),
            Self::Polygon(corners) => match corners.first() {
                Some([x, y]) => format!("polygon {x} {y} ..."),
                None => "polygon".to_owned(),
            },
            Self::Wall([a, b], [c, d], thickness) => format!("wall {a} {b} {c} {d} {thickness}"),
            Self::Circle([x, y], radius) => format!("circle {x} {y} {radius}"),
        }
    }

    fn check(&self) -> Result<(), Fault> {
        let (points, lengths): (&[Point], &[f64]) = match self {
            Self::Rectangle(a, b) => (&[*a, *b], &[]),
            Self::Polygon(corners) if corners.len() < 3 => {
                return Err(Fault::Corners(corners.len()));
            }
            Self::Polygon(corners) => (corners, &[]),
            Self::Wall(from, to, thickness) => (&[*from, *to], &[*thickness]),
            Self::Circle(at, radius) => (&[*at], &[*radius]),
        };
        for number in points.iter().flatten().chain(lengths) {
            within_reach(*number)?;
        }
        match lengths.iter().find(|length| **length < 0.0) {
            Some(length) => Err(Fault::Length(*length)),
            None => Ok(()),
        }
    }
}

fn within_reach(number: f64) -> Result<(), Fault> {
    if number.abs() <= PLAN_COORDINATE_MAX {
        return Ok(());
    }
    Err(Fault::Coordinate(number))
}

/// What of the plane a robot covers, seen from its own position and heading.
#[derive(Clone, Debug, PartialEq)]
pub struct Footprint {
    /// Counter-clockwise; none for a disc.
    corners: Vec<Point>,
    /// Of the disc, or of the farthest corner.
    reach: f64,
}

impl Footprint {
    /// A disc; with radius 0 a point.
    ///
    /// # Errors
    /// The radius is none.
    pub fn circle(radius: f64) -> Result<Self, Fault> {
        within_reach(radius)?;
        if radius < 0.0 {
            return Err(Fault::Radius(radius));
        }
        Ok(Self {
            corners: Vec::new(),
            reach: radius,
        })
    }

    /// A convex polygon, its corners in either order.
    ///
    /// # Errors
    /// It has no area or is not convex.
    pub fn polygon(mut corners: Vec<Point>) -> Result<Self, Fault> {
        Shape::Polygon(corners.clone()).check()?;
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        let count = corners.len();
        let turn = |at: usize| {
            let (a, b, c) = (
                corners[at],
                corners[(at + 1) % count],
                corners[(at + 2) % count],
            );
            cross(minus(b, a), minus(c, b))
        };
        let turns: Vec<f64> = (0..count).map(turn).collect();
        let area: f64 = (0..count)
            .map(|at| cross(corners[at], corners[(at + 1) % count]))
            .sum();
        if count < 3 || area == 0.0 {
            return Err(Fault::NoArea);
        }
        // A star turns to one side too, but around more than once.
        let is_left = area > 0.0;
        let turns_back = turns
            .iter()
            .any(|&turn| turn != 0.0 && (turn > 0.0) != is_left);
        if turns_back || winds_more_than_once(&corners) {
            return Err(Fault::NotConvex);
        }
        if !is_left {
            corners.reverse();
        }
        let square = |corner: &Point| corner[0] * corner[0] + corner[1] * corner[1];
        Ok(Self {
            reach: corners.iter().map(square).fold(0.0, f64::max).sqrt(),
            corners,
        })
    }

    /// How far its farthest part is from the position.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Its corners at a pose; none for a disc.
    pub fn corners_at(&self, pose: Pose) -> Vec<Point> {
        let mut corners = Vec::new();
        self.place(pose, &mut corners);
        corners
    }

    fn place(&self, pose: Pose, corners: &mut Vec<Point>) {
        corners.clear();
        if !self.corners.is_empty() {
            let (sine, cosine) = sine_and_cosine(wrapped(pose.heading));
            corners.extend(self.corners.iter().map(|[x, y]| {
                [
                    pose.at[0] + cosine * x - sine * y,
                    pose.at[1] + sine * x + cosine * y,
                ]
            }));
        }
    }

    /// How far any part of it moves at most between two poses.
    fn travel(&self, from: Pose, to: Pose) -> f64 {
        let way = minus(to.at, from.at);
        let turned = if self.corners.is_empty() {
            0.0
        } else {
            wrapped(to.heading - from.heading).abs() * self.reach
        };
        (way[0] * way[0] + way[1] * way[1]).sqrt() + turned
    }
}

/// Whether the corners of a polygon that turns to one side only go around more than once: the x of a convex one rises
/// once and falls once.
fn winds_more_than_once(corners: &[Point]) -> bool {
    let count = corners.len();
    let rises = |at: usize| {
        let step = corners[(at + 1) % count][0] - corners[at % count][0];
        (step != 0.0).then_some(step > 0.0)
    };
    let directions: Vec<bool> = (0..count).filter_map(rises).collect();
    let changes = (0..directions.len())
        .filter(|&at| directions[at] != directions[(at + 1) % directions.len()])
        .count();
    changes > 2
}

/// A segment with a radius around it: an edge of a polygon, or a disc.
#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [Point; 2],
    radius: f64,
}

/// All obstacles, ready to be asked.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    shapes: Vec<Shape>,
    edges: Vec<Edge>,
    by_edge: Index,
    /// Of each polygon its corners, and an index over their boxes.
    bodies: Vec<Vec<Point>>,
    by_body: Index,
    workspace: Option<Bounds>,
}

impl Obstacles {
    /// These obstacles, and the rectangle that a robot must not leave, from its lowest x and y to its highest.
    ///
    /// # Errors
    /// What is no shape, with its number from 1, or there are too many.
    pub fn new(shapes: Vec<Shape>, workspace: Option<Bounds>) -> Result<Self, Fault> {
        if shapes.len() > PLAN_OBSTACLES_MAX {
            return Err(Fault::Obstacles(shapes.len()));
        }
        if let Some(bounds) = workspace {
            bounds.into_iter().try_for_each(within_reach)?;
            if bounds[0] >= bounds[2] || bounds[1] >= bounds[3] {
                return Err(Fault::NoWorkspace);
            }
        }
        let mut edges = Vec::new();
        let mut bodies = Vec::new();
        for (at, shape) in shapes.iter().enumerate() {
            shape
                .check()
                .map_err(|fault| Fault::Obstacle(at + 1, Box::new(fault)))?;
            if let Shape::Circle(centre, radius) = shape {
                edges.push(Edge {
                    ends: [*centre; 2],
                    radius: *radius,
                });
                continue;
            }
            let corners = shape.corners();
            edges.extend((0..corners.len()).map(|at| Edge {
                ends: [corners[at], corners[(at + 1) % corners.len()]],
                radius: 0.0,
            }));
            bodies.push(corners);
            if edges.len() > PLAN_CORNERS_MAX {
                return Err(Fault::TooManyCorners);
            }
        }
        let boxes: Vec<Bounds> = edges
            .iter()
            .map(|edge| grown(around(&edge.ends), edge.radius))
            .collect();
        let around_bodies: Vec<Bounds> = bodies.iter().map(|body| around(body)).collect();
        Ok(Self {
            shapes,
            by_edge: Index::new(&boxes),
            edges,
            by_body: Index::new(&around_bodies),
            bodies,
            workspace,
        })
    }

    /// The obstacles.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The rectangle that a robot must not leave.
    pub fn workspace(&self) -> Option<Bounds> {
        self.workspace
    }

    /// The rectangle around all obstacles.
    pub fn bounds(&self) -> Option<Bounds> {
        self.by_edge.bounds()
    }

    /// Whether a robot there touches an obstacle, comes nearer to one than `margin`, or leaves the workspace. A pose that
    /// is no number does.
    pub fn meets(&self, footprint: &Footprint, pose: Pose, margin: f64) -> bool {
        let mut corners = Vec::new();
        self.meets_with(footprint, pose, margin, &mut corners) || self.holds(&corners, pose)
    }

    /// Whether a robot that goes straight from one pose to the other, the short way round, meets anything. The start must
    /// not be nearer to an obstacle than half the resolution; what lies between is looked at in steps of at most the
    /// resolution with a margin of half of it, so that nothing is jumped over, however thin.
    pub fn meets_between(
        &self,
        footprint: &Footprint,
        from: Pose,
        to: Pose,
        resolution: f64,
        corners: &mut Vec<Point>,
    ) -> bool {
        let steps = (footprint.travel(from, to) / resolution).ceil().max(1.0);
        if steps.is_nan() || steps > f64::from(PLAN_SWEEP_STEPS_MAX) {
            return true;
        }
        let way = minus(to.at, from.at);
        let turn = wrapped(to.heading - from.heading);
        // A robot that came here without touching a border is not inside of anything.
        (1..=steps as u32).any(|step| {
            let share = f64::from(step) / steps;
            let pose = Pose {
                at: [from.at[0] + share * way[0], from.at[1] + share * way[1]],
                heading: from.heading + share * turn,
            };
            self.meets_with(footprint, pose, resolution / 2.0, corners)
        })
    }

    /// Whether a border is met. Leaves the corners of the footprint.
    fn meets_with(
        &self,
        footprint: &Footprint,
        pose: Pose,
        margin: f64,
        corners: &mut Vec<Point>,
    ) -> bool {
        let numbers = [pose.at[0], pose.at[1]];
        let is_near = |number: f64| number.abs() <= 2.0 * PLAN_COORDINATE_MAX;
        if !numbers.into_iter().all(is_near) || !pose.heading.is_finite() {
            return true;
        }
        footprint.place(pose, corners);
        let body = if corners.is_empty() {
            grown(around(&[pose.at]), footprint.reach)
        } else {
            around(corners)
        };
        let needed = grown(body, margin);
        if let Some(space) = self.workspace
            && (needed[0] < space[0]
                || needed[1] < space[1]
                || needed[2] > space[2]
                || needed[3] > space[3])
        {
            return true;
        }
        self.by_edge.any(needed, &mut |number| {
            let edge = self.edges[number as usize];
            let own = if corners.is_empty() {
                footprint.reach
            } else {
                0.0
            };
            let least = edge.radius + margin + own;
            gap_to(corners, pose.at, edge.ends) <= least * least
        })
    }

    /// Whether a robot that touches no border is inside of a body.
    fn holds(&self, corners: &[Point], pose: Pose) -> bool {
        let at = corners.first().copied().unwrap_or(pose.at);
        self.by_body
            .any([at[0], at[1], at[0], at[1]], &mut |number| {
                is_inside(at, &self.bodies[number as usize])
            })
    }
}

/// Squared distance of a segment to a convex polygon, or to a point if there are no corners.
fn gap_to(corners: &[Point], at: Point, ends: [Point; 2]) -> f64 {
    if corners.is_empty() {
        return to_segment(at, ends[0], ends[1]);
    }
    if is_inside_convex(ends[0], corners) {
        return 0.0;
    }
    let mut before = corners[corners.len() - 1];
    let mut least = f64::INFINITY;
    for &corner in corners {
        least = least.min(between_segments([before, corner], ends));
        before = corner;
    }
    least
}

fn around(points: &[Point]) -> Bounds {
    let mut bounds = [
        f64::INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NEG_INFINITY,
    ];
    for [x, y] in points {
        bounds[0] = bounds[0].min(*x);
        bounds[1] = bounds[1].min(*y);
        bounds[2] = bounds[2].max(*x);
        bounds[3] = bounds[3].max(*y);
    }
    bounds
}

fn grown(bounds: Bounds, by: f64) -> Bounds {
    [
        bounds[0] - by,
        bounds[1] - by,
        bounds[2] + by,
        bounds[3] + by,
    ]
}

#[cfg(test)]
mod tests;
