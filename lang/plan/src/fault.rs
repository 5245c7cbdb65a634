//! What is wrong with obstacles, a footprint or a room.
//!
//! Owns the reasons and their words. The blame is always the caller's: with the text, if there is a line, else with the
//! numbers.

use crate::limits::{PLAN_BODIES_MAX, PLAN_COORDINATE_MAX, PLAN_CORNERS_MAX, PLAN_OBSTACLES_MAX};
use std::fmt;

/// One reason.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// A polygon with so many corners.
    Corners(usize),
    /// A thickness or a radius of an obstacle that is below 0.
    Length(f64),
    /// A radius of a footprint that is below 0.
    Radius(f64),
    /// A number that is out of reach.
    Coordinate(f64),
    /// A distance between poses that is not above 0.
    Resolution(f64),
    /// A footprint that covers nothing.
    NoArea,
    /// A footprint that is not convex.
    NotConvex,
    /// A workspace that covers nothing.
    NoWorkspace,
    /// So many obstacles.
    Obstacles(usize),
    /// So many bodies of one robot.
    Bodies(usize),
    /// More obstacles than [`PLAN_OBSTACLES_MAX`], and how many is not known.
    TooManyObstacles,
    /// More corners than [`PLAN_CORNERS_MAX`].
    TooManyCorners,
    /// One of several obstacles, by its number from 1.
    Obstacle(usize, Box<Fault>),
    /// A text of so many bytes, and how many there may be.
    TextBytes(usize, usize),
    /// A line of a text, by its number from 1.
    Line(usize, Box<Fault>),
    /// A second line that gives the workspace.
    SecondWorkspace,
    /// A word that is no number.
    Number(String),
    /// A word that is no kind of obstacle, and the kinds.
    Kind(String, &'static [&'static str]),
    /// Not the numbers that a kind of obstacle has: its name, which they are, how many are there.
    Numbers(&'static str, &'static str, usize),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Corners(count) => {
                write!(f, "a polygon needs three corners or more, not {count}")
            }
            Self::Length(length) => write!(f, "{length} is no thickness or radius"),
            Self::Radius(radius) => write!(f, "{radius} is no radius"),
            Self::Coordinate(number) => write!(
                f,
                "{number} is no coordinate: they go from -{PLAN_COORDINATE_MAX:e} to {PLAN_COORDINATE_MAX:e}"
            ),
            Self::Resolution(resolution) => {
                write!(f, "{resolution} is no resolution: it is above 0")
            }
            Self::NoArea => f.write_str("the footprint has no area"),
            Self::NotConvex => f.write_str("the footprint is not convex: give its convex hull"),
            Self::NoWorkspace => f.write_str("the bounds of the workspace have no area"),
            Self::Obstacles(count) => {
                write!(f, "{count} obstacles are more than {PLAN_OBSTACLES_MAX}")
            }
            Self::Bodies(count) => write!(f, "{count} bodies are more than {PLAN_BODIES_MAX}"),
            Self::TooManyObstacles => write!(f, "more than {PLAN_OBSTACLES_MAX} obstacles"),
            Self::TooManyCorners => write!(f, "more than {PLAN_CORNERS_MAX} corners"),
            Self::Obstacle(number, fault) => write!(f, "obstacle {number}: {fault}"),
            Self::TextBytes(bytes, most) => {
                write!(f, "the text has {bytes} bytes, more than {most}")
            }
            Self::Line(number, fault) => write!(f, "line {number}: {fault}"),
            Self::SecondWorkspace => f.write_str("a second `bounds`"),
            Self::Number(word) => write!(f, "{} is no number", shown(word)),
            Self::Kind(word, kinds) => {
                let kinds = kinds.join(", ");
                write!(f, "{} is no kind of obstacle: {kinds}", shown(word))
            }
            Self::Numbers(kind, form, count) => {
                write!(f, "`{kind}` needs {form}; here are {count}")
            }
        }
    }
}

impl std::error::Error for Fault {}

/// A word as a message shows it.
fn shown(word: &str) -> String {
    const MOST: usize = 40;
    let short: String = word.chars().take(MOST).collect();
    format!("{short:?}")
}
