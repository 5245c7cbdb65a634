//! The answer of a planner as a table, as JSON and as sentences.
//!
//! Owns the forms. The table has a line for each step: `t`, actions, states, outputs; an action holds from its line to
//! the next, so the last line only says where it ends.

use super::ask::Question;
use lang_dcml::robot::Robot;
use lang_plan::{Counts, End, Outcome, Path};
use std::fmt::Write;

/// The path, step by step.
pub(super) fn table(robot: &mut Robot, path: &Path) -> String {
    let parts = [
        robot.action_parts(),
        robot.state_parts(),
        robot.output_parts(),
    ];
    let mut text = String::from("t");
    for part in parts.into_iter().flatten() {
        text.push(',');
        text.push_str(&part.name);
    }
    text.push('\n');
    path.replay(robot, 1, |seconds, place, action| {
        let _ = write!(text, "{seconds}");
        for number in action.iter().chain(place) {
            let _ = write!(text, ",{number}");
        }
        text.push('\n');
    });
    text
}

/// How long the way of its position is.
fn length(robot: &mut Robot, asked: &Question, path: &Path) -> f64 {
    let mut before: Option<[f64; 2]> = None;
    let mut sum = 0.0;
    path.replay(robot, 1, |_, place, _| {
        let [x, y] = asked.parts.pose(place).at;
        if let Some([from_x, from_y]) = before {
            sum += (x - from_x).hypot(y - from_y);
        }
        before = Some([x, y]);
    });
    sum
}

fn why(end: End) -> &'static str {
    match end {
        End::Found => "found",
        End::Iterations => "all samples are used up",
        End::Nodes => "the memory is full",
        End::Stopped => "the time is over",
    }
}

/// A line for a person who waits.
pub(super) fn progress(counts: &Counts) -> String {
    let best = counts
        .best
        .map(|best| format!(", best path {best:.2} s"))
        .unwrap_or_default();
    format!(
        "{} samples, {} places, {:.2} from the goal{best}",
        counts.iterations, counts.nodes, counts.nearest
    )
}

fn values(asked: &Question, place: &[f64], sign: &str, quoted: bool) -> String {
    let one = |(name, value): (&String, &f64)| {
        if quoted {
            format!("\"{name}\"{sign}{value}")
        } else {
            format!("{name}{sign}{value:.3}")
        }
    };
    let all: Vec<String> = asked.names.iter().zip(place).map(one).collect();
    all.join(", ")
}

/// For a person.
pub(super) fn summary(
    robot: &mut Robot,
    asked: &Question,
    outcome: &Outcome,
    seconds: f64,
) -> String {
    let counts = &outcome.counts;
    let mut text = String::new();
    let _ = match &outcome.path {
        Some(path) => writeln!(
            text,
            "Path of {:.2} s and length {:.2} with {} actions; it ends at {}.",
            path.duration(),
            length(robot, asked, path),
            path.pieces.len(),
            values(asked, path.end(), " = ", false)
        ),
        None => writeln!(
            text,
            "No path: {}. The nearest place that was reached is {}, {:.3} from the goal.",
            why(outcome.end),
            values(asked, &outcome.nearest, " = ", false),
            counts.nearest
        ),
    };
    let _ = writeln!(
        text,
        "{} samples, {} propagations with {} steps, {} collisions, {} places in {seconds:.2} s.",
        counts.iterations, counts.propagations, counts.steps, counts.collisions, counts.nodes
    );
    text
}

/// For a program: one object on one line.
pub(super) fn json(robot: &mut Robot, asked: &Question, outcome: &Outcome, seconds: f64) -> String {
    let counts = &outcome.counts;
    let mut text = format!("{{\"found\":{}", outcome.path.is_some());
    if let Some(path) = &outcome.path {
        let _ = write!(
            text,
            ",\"duration\":{},\"length\":{},\"actions\":{},\"end\":{{{}}}",
            path.duration(),
            length(robot, asked, path),
            path.pieces.len(),
            values(asked, path.end(), ":", true)
        );
    }
    let ended = match outcome.end {
        End::Found => "found",
        End::Iterations => "iterations",
        End::Nodes => "nodes",
        End::Stopped => "time",
    };
    let _ = writeln!(
        text,
        ",\"ended\":\"{ended}\",\"nearest\":{{{}}},\"distance\":{},\"iterations\":{},\"propagations\":{},\"steps\":{},\
         \"collisions\":{},\"nodes\":{},\"seconds\":{seconds:.6}}}",
        values(asked, &outcome.nearest, ":", true),
        counts.nearest,
        counts.iterations,
        counts.propagations,
        counts.steps,
        counts.collisions,
        counts.nodes
    );
    text
}
