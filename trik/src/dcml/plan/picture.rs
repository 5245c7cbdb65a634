//! The answer of a planner as a picture in SVG: obstacles, goal, the search faintly, the path and the robot along it.
//!
//! Owns the style. x goes to the right and y up, as in the model.

use super::ask::Question;
use lang_dcml::robot::Robot;
use lang_dcml::system::System;
use lang_plan::obstacles::flat::Point;
use lang_plan::obstacles::{Obstacles, Shape};
use lang_plan::{Outcome, Propagator};
use lang_text::svg::{Svg, View};

/// Pixels of the longer side.
const SIDE: f64 = 900.0;
/// Branches of the search that are drawn: more of them are a grey surface.
const BRANCHES: usize = 5000;
/// Robots along the path.
const ROBOTS: u64 = 40;
/// Obstacles that are drawn.
const SHAPES: usize = 100_000;

/// What a pen does next, and where.
type Step = (char, (f64, f64));
/// Names and values of a style.
type Style = [(&'static str, &'static str)];

/// From the plane to the picture.
struct Plane {
    left: f64,
    top: f64,
    scale: f64,
}

impl Plane {
    fn point(&self, [x, y]: Point) -> (f64, f64) {
        ((x - self.left) * self.scale, (self.top - y) * self.scale)
    }

    /// The steps of a pen along points.
    fn line(&self, points: impl IntoIterator<Item = Point>) -> impl Iterator<Item = Step> {
        let mut sign = 'M';
        points.into_iter().map(move |point| {
            let step = (sign, self.point(point));
            sign = 'L';
            step
        })
    }

    fn circle(&self, svg: &mut Svg, at: Point, radius: f64, style: &Style) {
        let (x, y) = self.point(at);
        svg.tag("circle")
            .numbers(1, [("cx", x), ("cy", y), ("r", radius * self.scale)])
            .style(style)
            .close();
    }

    fn polygon(&self, svg: &mut Svg, corners: &[Point], style: &Style) {
        svg.tag("path")
            .outline(1, corners.iter().map(|corner| self.point(*corner)))
            .style(style)
            .close();
    }
}

/// Draws it.
pub(super) fn draw(
    robot: &mut Robot,
    obstacles: &Obstacles,
    asked: &Question,
    outcome: &Outcome,
) -> String {
    let [(left, right), (low, high)] = asked.area;
    let margin = asked.size / 40.0;
    let plane = Plane {
        left: left - margin,
        top: high + margin,
        scale: SIDE / (asked.size + 2.0 * margin),
    };
    let width = (right - left + 2.0 * margin) * plane.scale;
    let height = (high - low + 2.0 * margin) * plane.scale;
    let mut svg = Svg::new();
    let view = View {
        frame: [0.0, 0.0, width, height],
        digits: 0,
        is_sized: true,
    };
    svg.picture(view).open();
    svg.tag("rect")
        .style(&[("width", "100%"), ("height", "100%"), ("fill", "white")])
        .close();
    let space = obstacles.workspace().unwrap_or([left, low, right, high]);
    let [a, b, c, d] = space;
    let style = [
        ("fill", "none"),
        ("stroke", "#bbb"),
        ("stroke-dasharray", "6 4"),
    ];
    plane.polygon(&mut svg, &[[a, b], [c, b], [c, d], [a, d]], &style);
    let style = [("fill", "#667"), ("stroke", "#667")];
    for shape in obstacles.shapes().iter().take(SHAPES) {
        match shape {
            Shape::Circle(at, radius) => plane.circle(&mut svg, *at, *radius, &style),
            Shape::Rectangle(..) | Shape::Polygon(_) | Shape::Wall(..) => {
                plane.polygon(&mut svg, &shape.corners(), &style);
            }
        }
    }
    if let ([Some(x), Some(y)], radius) = asked.goal {
        let style = [
            ("fill", "#2a2"),
            ("fill-opacity", "0.25"),
            ("stroke", "#2a2"),
        ];
        plane.circle(&mut svg, [x, y], radius, &style);
    }
    branches(&mut svg, &plane, robot, asked, outcome);
    path(&mut svg, &plane, robot, asked, outcome);
    svg.finish()
}

fn branches(svg: &mut Svg, plane: &Plane, robot: &mut Robot, asked: &Question, outcome: &Outcome) {
    let states = robot.states();
    let mut propagator = Propagator::new(robot, asked.problem.step);
    let every = outcome.tree.len().div_ceil(BRANCHES).max(1);
    let branches = outcome.tree.branches().step_by(every);
    let lines = branches.flat_map(|(from, action, steps, _)| {
        let mut place = propagator.place(&from[..states]);
        let mut points = vec![asked.parts.pose(&place).at];
        for step in 1..=steps {
            propagator.advance(&mut place, action);
            if step % 3 == 0 || step == steps {
                points.push(asked.parts.pose(&place).at);
            }
        }
        plane.line(points)
    });
    svg.tag("path")
        .style(&[
            ("fill", "none"),
            ("stroke", "#58c"),
            ("stroke-opacity", "0.3"),
        ])
        .path(1, lines)
        .close();
}

fn path(svg: &mut Svg, plane: &Plane, robot: &mut Robot, asked: &Question, outcome: &Outcome) {
    let mut draw_robot = |place: &[f64], style: &Style| {
        let others = asked.bodies.iter().map(|one| (&one.footprint, one.parts));
        for (footprint, parts) in others.chain([(&asked.footprint, asked.parts)]) {
            let pose = parts.pose(place);
            let corners = footprint.corners_at(pose);
            if corners.is_empty() {
                plane.circle(svg, pose.at, footprint.reach(), style);
            } else {
                plane.polygon(svg, &corners, style);
            }
        }
    };
    let Some(path) = &outcome.path else {
        let start = Propagator::new(robot, asked.problem.step).place(&asked.problem.start);
        draw_robot(&start, &[("fill", "none"), ("stroke", "#c60")]);
        let dashes = ("stroke-dasharray", "4 3");
        let style = [("fill", "none"), ("stroke", "#c60"), dashes];
        draw_robot(&outcome.nearest, &style);
        return;
    };
    let at_the_ends = [
        ("fill", "#fa5"),
        ("fill-opacity", "0.6"),
        ("stroke", "#c60"),
    ];
    let on_the_way = [
        ("fill", "none"),
        ("stroke", "#c60"),
        ("stroke-opacity", "0.5"),
    ];
    let total = path.steps();
    let every = total.div_ceil(ROBOTS).max(1);
    let mut points = Vec::new();
    let mut at = 0;
    path.replay(robot, 1, |_, place, _| {
        points.push(asked.parts.pose(place).at);
        if at == 0 || at == total {
            draw_robot(place, &at_the_ends);
        } else if at % every == 0 {
            draw_robot(place, &on_the_way);
        }
        at += 1;
    });
    svg.tag("path")
        .style(&[("fill", "none"), ("stroke", "#c30"), ("stroke-width", "2")])
        .path(1, plane.line(points))
        .close();
}
