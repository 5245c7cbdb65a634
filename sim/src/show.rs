//! A world as people see it from above: what stands still, and what moves.
//!
//! Owns the plain data, in metres with x to the right, y up and angles counter-clockwise, whatever the world counts in. `text`
//! makes JSON of it, `field` a scene of a world of TRIK Studio, and [`Watcher`] serves people who look at a running board.

pub(crate) mod field;
pub(crate) mod moving;
pub mod seen;
mod text;
#[cfg(feature = "board")]
mod watcher;

#[cfg(feature = "board")]
pub use watcher::Watcher;

use crate::field::Locks;
use crate::geometry::{Point, Pose};
use crate::limits;

/// What stands still.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    /// Left, bottom, right and top of everything.
    pub bounds: [f64; 4],
    /// Colour of the floor.
    pub floor: String,
    /// What lies and stands there, the lowest first.
    pub items: Vec<Item>,
    /// What markers have left so far.
    pub marks: Vec<Mark>,
    /// Things that can be moved, by their numbers.
    pub things: Vec<Movable>,
    /// Where the robot begins.
    pub start: Pose,
    /// All robots; the first one is that of the board.
    pub robots: Vec<Shape>,
    /// What the author of the project keeps from people.
    pub locks: Locks,
    /// Whether other worlds can be put around the robot.
    pub takes_fields: bool,
}

/// What an item is, which says what its points are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Straight pieces from point to point.
    Line,
    /// Straight pieces between two points each.
    Strokes,
    /// A curve: begin, both control points, end.
    Curve,
    /// Two opposite corners.
    Rectangle,
    /// Two opposite corners of what is around it.
    Ellipse,
    /// A wall from one point to another.
    Wall,
    /// Upper left corner of a text.
    Text,
    /// A picture by two opposite corners.
    Image,
}

impl Kind {
    /// Its word.
    fn word(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Strokes => "strokes",
            Self::Curve => "curve",
            Self::Rectangle => "rect",
            Self::Ellipse => "ellipse",
            Self::Wall => "wall",
            Self::Text => "text",
            Self::Image => "image",
        }
    }
}

/// Something that stands still.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// What it is.
    pub kind: Kind,
    /// Where it is.
    pub points: Vec<Point>,
    /// Colour of the line; empty: none.
    pub stroke: String,
    /// Across the line.
    pub width_m: f64,
    /// Lengths of dashes and gaps.
    pub dashes_m: Vec<f64>,
    /// Colour inside; empty: none.
    pub fill: String,
    /// Of the colour inside.
    pub opacity: f64,
    /// Of a text the text, of a picture its address, which holds it.
    pub text: String,
}

impl Item {
    /// A line of a colour and a width.
    pub fn line(kind: Kind, points: Vec<Point>, stroke: &str, width_m: f64) -> Self {
        Self {
            kind,
            points,
            stroke: stroke.to_owned(),
            width_m,
            dashes_m: Vec::new(),
            fill: String::new(),
            opacity: 1.0,
            text: String::new(),
        }
    }
}

/// What a marker has left in one piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// One end.
    pub begin: Point,
    /// The other end.
    pub end: Point,
    /// Its colour.
    pub rgb: [u8; 3],
}

/// Something that can be moved.
#[derive(Debug, Clone, PartialEq)]
pub struct Movable {
    /// `ball`, `skittle` or `cube`.
    pub kind: &'static str,
    /// Across.
    pub size_m: f64,
    /// Its colour.
    pub colour: String,
}

/// A robot as it is built.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shape {
    /// Length and width.
    pub size_m: [f64; 2],
    /// Whether its body is a circle.
    pub is_round: bool,
    /// Its driven wheels.
    pub wheels: Vec<Wheel>,
    /// Its sensors.
    pub sensors: Vec<Sensor>,
}

/// A wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// The motor that turns it.
    pub port: String,
    /// Ahead of the centre and to the left.
    pub at: Point,
    /// Its radius.
    pub radius_m: f64,
}

/// A sensor on a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// `infrared`, `sonar`, `light`, `touch`, `camera` or `lidar`.
    pub kind: &'static str,
    /// Where it is plugged in.
    pub port: String,
    /// Ahead of the centre and to the left.
    pub at: Point,
    /// Where it looks, counter-clockwise from ahead.
    pub degrees: f64,
    /// How far it looks; 0 if it measures no distance.
    pub reach_m: f64,
    /// Across its beam.
    pub beam_degrees: f64,
}

/// What moves.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moving {
    /// Seconds of the world.
    pub time_s: f64,
    /// Whether time stands still.
    pub is_paused: bool,
    /// How many times as fast as the clock of the board.
    pub speed: f64,
    /// All robots.
    pub robots: Vec<Placed>,
    /// Where things are, by their numbers.
    pub things: Vec<Pose>,
}

/// A robot where it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placed {
    /// Where.
    pub pose: Pose,
    /// Of each sensor the newest reading: metres, a share of dark, 1 for pressed. Nothing: nothing is in reach.
    pub readings: Vec<Option<f64>>,
    /// What a lidar sees, counter-clockwise from ahead; empty without one.
    pub rays_m: Vec<Option<f64>>,
    /// Whether it touches a wall or a thing.
    pub is_stuck: bool,
    /// The colour of a marker that draws; empty if none does.
    pub marker: String,
}

/// What a lidar shows people: `range_m` takes an angle clockwise from ahead.
pub(crate) fn rays(range_m: impl Fn(f64) -> Option<f64>) -> Vec<Option<f64>> {
    let turn = std::f64::consts::TAU / f64::from(limits::RAYS_SHOWN);
    (0..limits::RAYS_SHOWN)
        .map(|ray| range_m(-f64::from(ray) * turn))
        .collect()
}
