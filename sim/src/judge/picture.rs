//! A run as a picture: the field from above, what stands and is drawn on it, and the way of each robot.
//!
//! Owns the drawing in SVG: colours of files become colours of pages, and no text of a file can be taken for a tag. Knows
//! no simulation: it draws a field and a trajectory.

mod page;
pub(crate) mod shapes;

pub use page::{Caption, page};

use super::json::Value;
use super::trajectory::{Record, Trajectory};
use super::words;
use crate::field::{Field, ROBOT_SIZE};
use crate::geometry::Point;
use crate::limits;
use lang_text::problem::Locale;
use lang_text::svg::{Svg, View};
use shapes::{Bounds, colour};

/// Half a robot.
const HALF: f64 = ROBOT_SIZE / 2.0;
/// Points of a way that are nearer than this are one, in pixels.
const NEAR: f64 = 0.5;
/// Colours of the ways of robots.
const WAYS: [&str; 4] = ["#c2185b", "#1565c0", "#2e7d32", "#6a1b9a"];
/// The least height of letters, in pixels of the field.
const LETTERS_MIN: f64 = 4.0;

/// The picture of a run: robots where they began and where they ended.
pub fn svg(field: &Field, trajectory: &Trajectory, locale: Locale) -> String {
    let mut svg = ground(field, trajectory, locale);
    for robot in 0..trajectory.robots.len() {
        let poses = || trajectory.poses(robot as u16);
        if let Some(first) = poses().next() {
            robot_at(first, robot, 0.35, &mut svg);
        }
        if let Some(last) = poses().last() {
            robot_at(last, robot, 0.9, &mut svg);
        }
    }
    svg.finish()
}

/// All that lies below the robots: the field, what was drawn, and the ways.
fn ground(field: &Field, trajectory: &Trajectory, locale: Locale) -> Svg {
    let mut svg = Svg::new();
    let letters = head(field, trajectory, &mut svg);
    shapes::field(field, letters, &mut svg);
    marker(trajectory, &mut svg);
    for robot in 0..trajectory.robots.len() {
        way(trajectory, robot, (letters, locale), &mut svg);
    }
    svg
}

/// The first tag, around everything that there is.
fn head(field: &Field, trajectory: &Trajectory, svg: &mut Svg) -> f64 {
    let mut bounds = Bounds::default();
    shapes::bounds(field, &mut bounds);
    for record in &trajectory.records {
        if let Record::Pose { x, y, .. } = *record {
            bounds.add(x - HALF / 2.0, y - HALF / 2.0);
            bounds.add(x + ROBOT_SIZE + HALF / 2.0, y + ROBOT_SIZE + HALF / 2.0);
        }
    }
    let frame = bounds.frame();
    let letters = letters(frame);
    let view = View {
        frame,
        digits: 1,
        is_sized: false,
    };
    svg.picture(view)
        .style(&[("font-family", "sans-serif")])
        .numbers(1, [("font-size", letters)])
        .open();
    shapes::rect(frame, svg)
        .with("fill", colour(&field.settings.background, "#ffffff"))
        .close();
    letters
}

/// The height of letters that are as easy to read in a picture of a small field as in one of a large field: a part of the
/// picture, whatever it is of.
fn letters([_, _, width, height]: [f64; 4]) -> f64 {
    (width.max(height) / 55.0).max(LETTERS_MIN)
}

/// What markers of robots have drawn: their devices tell when they were down.
fn marker(trajectory: &Trajectory, svg: &mut Svg) {
    for robot in 0..trajectory.robots.len() {
        let (mut is_down, mut ink) = (false, "#000000".to_owned());
        let mut stroke: Vec<(f64, f64)> = Vec::new();
        let mut at = None;
        for record in &trajectory.records {
            match record {
                Record::Pose {
                    robot: of, x, y, ..
                } if usize::from(*of) == robot => {
                    at = Some((x + HALF, y + HALF));
                    if is_down {
                        stroke.extend(at);
                    }
                }
                Record::Device {
                    robot: of, change, ..
                } if usize::from(*of) == robot && change.device == "marker" => {
                    polyline(&stroke, &ink, 6.0, 1.0, svg);
                    stroke.clear();
                    match (&*change.property, &change.value) {
                        ("isDown", Value::Bool(down)) => is_down = *down,
                        ("color", Value::String(text)) => ink = colour(text, "#000000"),
                        _ => {}
                    }
                    if is_down {
                        stroke.extend(at);
                    }
                }
                // Of other robots, or of other devices.
                Record::Pose { .. } | Record::Device { .. } => {}
            }
        }
        polyline(&stroke, &ink, 6.0, 1.0, svg);
    }
}

/// The way of a robot's centre, with marks of time.
fn way(trajectory: &Trajectory, robot: usize, (letters, locale): (f64, Locale), svg: &mut Svg) {
    let mark = letters / 5.0;
    let ink = WAYS[robot % WAYS.len()];
    let points: Vec<(f64, f64)> = trajectory
        .poses(robot as u16)
        .map(|[_, x, y, _]| (x + HALF, y + HALF))
        .collect();
    polyline(&points, ink, 2.0, 0.9, svg);
    let end = trajectory.poses(robot as u16).last();
    let end = end.map_or(0.0, |pose| pose[0]);
    let every = [1e3, 2e3, 5e3, 1e4, 3e4, 6e4, 6e5]
        .into_iter()
        .find(|every| end / every <= limits::MARKS_MAX as f64)
        .unwrap_or(6e5);
    let second = words::second(locale);
    let mut next = every;
    let mut before: Option<(f64, f64)> = None;
    for [ms, x, y, _] in trajectory.poses(robot as u16) {
        if ms < next {
            continue;
        }
        next += every;
        let (x, y) = (x + HALF, y + HALF);
        // A robot that stands has one mark.
        if before.is_some_and(|before| libm::hypot(before.0 - x, before.1 - y) < 12.0) {
            continue;
        }
        before = Some((x, y));
        svg.tag("circle")
            .numbers(1, [("cx", x), ("cy", y), ("r", mark)])
            .with("fill", ink)
            .close();
        svg.tag("text")
            .numbers(
                1,
                [
                    ("x", x + 1.3 * mark),
                    ("y", y - 1.3 * mark),
                    ("font-size", 0.75 * letters),
                ],
            )
            .with("fill", ink)
            .text(format_args!("{:.0} {second}", ms / 1000.0));
    }
}

fn polyline(points: &[(f64, f64)], ink: &str, width: f64, opacity: f64, svg: &mut Svg) {
    if points.len() < 2 {
        return;
    }
    let mut before: Option<(f64, f64)> = None;
    let far = points.iter().enumerate().filter(|&(index, &(x, y))| {
        let is_last = index + 1 == points.len();
        let is_near = before.is_some_and(|at| libm::hypot(at.0 - x, at.1 - y) < NEAR);
        if is_last || !is_near {
            before = Some((x, y));
        }
        is_last || !is_near
    });
    svg.tag("polyline")
        .style(&[("fill", "none"), ("stroke", ink)])
        .with("stroke-width", width)
        .with("opacity", opacity)
        .with("stroke-linejoin", "round")
        .points(far.map(|(_, &point)| point))
        .close();
}

/// A robot by its pose: its outline and an arrow ahead.
fn robot_at([_, x, y, degrees]: [f64; 4], robot: usize, opacity: f64, svg: &mut Svg) {
    let (x, y) = (x + HALF, y + HALF);
    let place = format_args!("translate({x:.2} {y:.2}) rotate({degrees:.2})");
    svg.tag("g")
        .with("transform", place)
        .with("opacity", opacity)
        .open();
    body(robot, svg);
    svg.end();
}

/// A robot around its centre, looking to the right.
fn body(robot: usize, svg: &mut Svg) {
    let ink = WAYS[robot % WAYS.len()];
    shapes::whole_rect([-25.0, -25.0, 50.0, 50.0], svg)
        .style(&[("rx", "6"), ("fill", "#eceff1"), ("stroke", ink)])
        .with("stroke-width", 2)
        .close();
    for top in [-25.0, 19.0] {
        shapes::whole_rect([-23.0, top, 16.0, 6.0], svg)
            .with("fill", "#455a64")
            .close();
    }
    svg.tag("path")
        .style(&[("d", "M6 -9 L20 0 L6 9 Z"), ("fill", ink)])
        .close();
}

/// Whether a point can be drawn.
pub(crate) fn is_near(at: Point) -> bool {
    at.x.abs() < crate::limits::FAR_PX && at.y.abs() < crate::limits::FAR_PX
}

#[cfg(test)]
mod tests;
