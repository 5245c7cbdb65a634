//! The answer of a planner as a picture in SVG: obstacles, goal, the search faintly, the path and the robot along it.
//!
//! Owns the style. x goes to the right and y up, as in the model.

use super::ask::Asked;
use lang_dcml::robot::Robot;
use lang_dcml::system::System;
use lang_plan::obstacles::flat::Point;
use lang_plan::obstacles::{Obstacles, Shape};
use lang_plan::{Outcome, Propagator};
use std::fmt::Write;

/// Pixels of the longer side.
const SIDE: f64 = 900.0;
/// Branches of the search that are drawn: more of them are a grey surface.
const BRANCHES: usize = 5000;
/// Robots along the path.
const ROBOTS: u64 = 40;
/// Obstacles that are drawn.
const SHAPES: usize = 100_000;

/// From the plane to the picture.
struct View {
    left: f64,
    top: f64,
    scale: f64,
}

impl View {
    fn point(&self, [x, y]: Point) -> (f64, f64) {
        ((x - self.left) * self.scale, (self.top - y) * self.scale)
    }

    fn line(&self, text: &mut String, points: impl IntoIterator<Item = Point>) {
        let mut sign = 'M';
        for point in points {
            let (x, y) = self.point(point);
            let _ = write!(text, "{sign}{x:.1} {y:.1}");
            sign = 'L';
        }
    }

    fn circle(&self, text: &mut String, at: Point, radius: f64, style: &str) {
        let (x, y) = self.point(at);
        let radius = radius * self.scale;
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {style}/>"
        );
    }

    fn polygon(&self, text: &mut String, corners: &[Point], style: &str) {
        let _ = write!(text, "<path d=\"");
        self.line(text, corners.iter().copied());
        let _ = writeln!(text, "Z\" {style}/>");
    }
}

/// Draws it.
pub(super) fn draw(
    robot: &mut Robot,
    obstacles: &Obstacles,
    asked: &Asked,
    outcome: &Outcome,
) -> String {
    let [(left, right), (low, high)] = asked.area;
    let margin = asked.size / 40.0;
    let view = View {
        left: left - margin,
        top: high + margin,
        scale: SIDE / (asked.size + 2.0 * margin),
    };
    let width = (right - left + 2.0 * margin) * view.scale;
    let height = (high - low + 2.0 * margin) * view.scale;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         height=\"{height:.0}\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    let space = obstacles.workspace().unwrap_or([left, low, right, high]);
    let [a, b, c, d] = space;
    view.polygon(
        &mut text,
        &[[a, b], [c, b], [c, d], [a, d]],
        "fill=\"none\" stroke=\"#bbb\" stroke-dasharray=\"6 4\"",
    );
    let style = "fill=\"#667\" stroke=\"#667\"";
    for shape in obstacles.shapes().iter().take(SHAPES) {
        match shape {
            Shape::Circle(at, radius) => view.circle(&mut text, *at, *radius, style),
            Shape::Rectangle(..) | Shape::Polygon(_) | Shape::Wall(..) => {
                view.polygon(&mut text, &shape.corners(), style);
            }
        }
    }
    if let ([Some(x), Some(y)], radius) = asked.goal {
        let style = "fill=\"#2a2\" fill-opacity=\"0.25\" stroke=\"#2a2\"";
        view.circle(&mut text, [x, y], radius, style);
    }
    branches(&mut text, &view, robot, asked, outcome);
    path(&mut text, &view, robot, asked, outcome);
    text.push_str("</svg>\n");
    text
}

fn branches(text: &mut String, view: &View, robot: &mut Robot, asked: &Asked, outcome: &Outcome) {
    let states = robot.states();
    let mut propagator = Propagator::new(robot, asked.problem.step);
    let every = outcome.tree.len().div_ceil(BRANCHES).max(1);
    text.push_str("<path fill=\"none\" stroke=\"#58c\" stroke-opacity=\"0.3\" d=\"");
    for (from, action, steps, _) in outcome.tree.branches().step_by(every) {
        let mut place = propagator.place(&from[..states]);
        let mut points = vec![asked.parts.pose(&place).at];
        for step in 1..=steps {
            propagator.advance(&mut place, action);
            if step % 3 == 0 || step == steps {
                points.push(asked.parts.pose(&place).at);
            }
        }
        view.line(text, points);
    }
    text.push_str("\"/>\n");
}

fn path(text: &mut String, view: &View, robot: &mut Robot, asked: &Asked, outcome: &Outcome) {
    let mut draw_robot = |place: &[f64], style: &str| {
        let pose = asked.parts.pose(place);
        let corners = asked.footprint.corners_at(pose);
        if corners.is_empty() {
            view.circle(text, pose.at, asked.footprint.reach(), style);
        } else {
            view.polygon(text, &corners, style);
        }
    };
    let Some(path) = &outcome.path else {
        let start = Propagator::new(robot, asked.problem.step).place(&asked.problem.start);
        draw_robot(&start, "fill=\"none\" stroke=\"#c60\"");
        draw_robot(
            &outcome.nearest,
            "fill=\"none\" stroke=\"#c60\" stroke-dasharray=\"4 3\"",
        );
        return;
    };
    let total = path.steps();
    let every = total.div_ceil(ROBOTS).max(1);
    let mut points = Vec::new();
    let mut at = 0;
    path.replay(robot, 1, |_, place, _| {
        points.push(asked.parts.pose(place).at);
        if at == 0 || at == total {
            draw_robot(place, "fill=\"#fa5\" fill-opacity=\"0.6\" stroke=\"#c60\"");
        } else if at % every == 0 {
            draw_robot(
                place,
                "fill=\"none\" stroke=\"#c60\" stroke-opacity=\"0.5\"",
            );
        }
        at += 1;
    });
    text.push_str("<path fill=\"none\" stroke=\"#c30\" stroke-width=\"2\" d=\"");
    view.line(text, points);
    text.push_str("\"/>\n");
}
