//! A run as a picture: the field from above, what stands and is drawn on it, and the way of each robot.
//!
//! Owns the drawing in SVG: colours of files become colours of pages, and no text of a file can be taken for a tag. Knows
//! no simulation: it draws a field and a trajectory.

mod page;
mod shapes;

pub use page::{Caption, page};

use super::json::Value;
use super::trajectory::{Record, Trajectory};
use crate::field::{Field, ROBOT_SIZE};
use crate::geometry::Point;
use shapes::{Bounds, colour};
use std::fmt::Write as _;

/// Half a robot.
const HALF: f64 = ROBOT_SIZE / 2.0;
/// Points of a way that are nearer than this are one, in pixels.
const NEAR: f64 = 0.5;
/// Colours of the ways of robots.
const WAYS: [&str; 4] = ["#c2185b", "#1565c0", "#2e7d32", "#6a1b9a"];
/// How many marks of time a way has at most.
const MARKS_MAX: usize = 40;

/// The picture of a run: robots where they began and where they ended.
pub fn svg(field: &Field, trajectory: &Trajectory) -> String {
    let mut out = head(field, trajectory);
    shapes::field(field, &mut out);
    marker(trajectory, &mut out);
    for robot in 0..trajectory.robots.len() {
        way(trajectory, robot, &mut out);
    }
    for robot in 0..trajectory.robots.len() {
        let poses = || trajectory.poses(robot as u16);
        if let Some(first) = poses().next() {
            robot_at(first, robot, 0.35, &mut out);
        }
        if let Some(last) = poses().last() {
            robot_at(last, robot, 0.9, &mut out);
        }
    }
    out.push_str("</svg>\n");
    out
}

/// The first tag, around everything that there is.
fn head(field: &Field, trajectory: &Trajectory) -> String {
    let mut bounds = Bounds::default();
    shapes::bounds(field, &mut bounds);
    for record in &trajectory.records {
        if let Record::Pose { x, y, .. } = *record {
            bounds.add(x - HALF / 2.0, y - HALF / 2.0);
            bounds.add(x + ROBOT_SIZE + HALF / 2.0, y + ROBOT_SIZE + HALF / 2.0);
        }
    }
    let [x, y, width, height] = bounds.frame();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{x:.1} {y:.1} {width:.1} {height:.1}\" \
         font-family=\"sans-serif\" font-size=\"14\">\n\
         <rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{}\"/>\n",
        colour(&field.settings.background, "#ffffff")
    )
}

/// What markers of robots have drawn: their devices tell when they were down.
fn marker(trajectory: &Trajectory, out: &mut String) {
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
                Record::Told {
                    robot: of, told, ..
                } if usize::from(*of) == robot && told.device == "marker" => {
                    polyline(&stroke, &ink, 6.0, 1.0, out);
                    stroke.clear();
                    match (&*told.property, &told.value) {
                        ("isDown", Value::Bool(down)) => is_down = *down,
                        ("color", Value::String(text)) => ink = colour(text, "#000000"),
                        _ => {}
                    }
                    if is_down {
                        stroke.extend(at);
                    }
                }
                _ => {}
            }
        }
        polyline(&stroke, &ink, 6.0, 1.0, out);
    }
}

/// The way of a robot's centre, with marks of time.
fn way(trajectory: &Trajectory, robot: usize, out: &mut String) {
    let ink = WAYS[robot % WAYS.len()];
    let points: Vec<(f64, f64)> = trajectory
        .poses(robot as u16)
        .map(|[_, x, y, _]| (x + HALF, y + HALF))
        .collect();
    polyline(&points, ink, 2.0, 0.9, out);
    let end = trajectory.poses(robot as u16).last();
    let end = end.map_or(0.0, |pose| pose[0]);
    let every = [1e3, 2e3, 5e3, 1e4, 3e4, 6e4, 6e5]
        .into_iter()
        .find(|every| end / every <= MARKS_MAX as f64)
        .unwrap_or(6e5);
    let mut next = every;
    let mut before: Option<(f64, f64)> = None;
    for [ms, x, y, _] in trajectory.poses(robot as u16) {
        if ms < next {
            continue;
        }
        next += every;
        let (x, y) = (x + HALF, y + HALF);
        // A robot that stands has one mark.
        if before.is_some_and(|before| (before.0 - x).hypot(before.1 - y) < 12.0) {
            continue;
        }
        before = Some((x, y));
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{ink}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"10\" fill=\"{ink}\">{:.0} s</text>",
            x + 4.0,
            y - 4.0,
            ms / 1000.0
        );
    }
}

fn polyline(points: &[(f64, f64)], ink: &str, width: f64, opacity: f64, out: &mut String) {
    if points.len() < 2 {
        return;
    }
    let _ = write!(
        out,
        "<polyline fill=\"none\" stroke=\"{ink}\" stroke-width=\"{width}\" opacity=\"{opacity}\" \
         stroke-linejoin=\"round\" points=\""
    );
    let mut before: Option<(f64, f64)> = None;
    for (index, &(x, y)) in points.iter().enumerate() {
        let is_last = index + 1 == points.len();
        if !is_last && before.is_some_and(|at| (at.0 - x).hypot(at.1 - y) < NEAR) {
            continue;
        }
        before = Some((x, y));
        let _ = write!(out, "{x:.1},{y:.1} ");
    }
    out.push_str("\"/>\n");
}

/// A robot by its pose: its outline and an arrow ahead.
fn robot_at([_, x, y, degrees]: [f64; 4], robot: usize, opacity: f64, out: &mut String) {
    let (x, y) = (x + HALF, y + HALF);
    let _ = writeln!(
        out,
        "<g transform=\"translate({x:.2} {y:.2}) rotate({degrees:.2})\" opacity=\"{opacity}\">{}</g>",
        body(robot)
    );
}

/// A robot around its centre, looking to the right.
fn body(robot: usize) -> String {
    let ink = WAYS[robot % WAYS.len()];
    format!(
        "<rect x=\"-25\" y=\"-25\" width=\"50\" height=\"50\" rx=\"6\" fill=\"#eceff1\" stroke=\"{ink}\" stroke-width=\"2\"/>\
         <rect x=\"-23\" y=\"-25\" width=\"16\" height=\"6\" fill=\"#455a64\"/>\
         <rect x=\"-23\" y=\"19\" width=\"16\" height=\"6\" fill=\"#455a64\"/>\
         <path d=\"M6 -9 L20 0 L6 9 Z\" fill=\"{ink}\"/>"
    )
}

/// Whether a point can be drawn.
fn is_near(at: Point) -> bool {
    at.x.abs() < crate::limits::FAR_PX && at.y.abs() < crate::limits::FAR_PX
}

#[cfg(test)]
mod tests;
