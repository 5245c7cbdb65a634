//! The picture of a comparison: what was recorded in grey, and over it what comes now in blue.
//!
//! Owns which numbers share a panel, and the colours. Places are those of `trik plot`.

use super::compare::{Wishes, had_of};
use super::{Anew, Had, Run, Step};
use crate::chart;
use crate::error::Error;
use crate::limits;
use crate::recording::plot::{Line, marks, panel, size};
use crate::terminal::{harmless, named};
use journal::layout::Layout;
use lang_text::svg::Svg;

/// The line below.
const STYLE: &str = "<style>.b{stroke:#b0b0b0;stroke-width:4;fill:none}</style>\n";
/// Height of the words above all panels.
const HEAD: f64 = 16.0;

/// One number in both.
struct Pair {
    node: usize,
    name: String,
    before: Line,
    now: Line,
}

/// Draws those of the nodes that are wanted, as many numbers as a picture has.
///
/// # Errors
/// What the run says.
pub(super) fn draw(wishes: &Wishes<'_>, is_wanted: &[bool]) -> Result<String, Error> {
    let mut run = Run::open(&wishes.of)?;
    let (begin, length) = (run.begin_ns(), run.end_ns().saturating_sub(run.begin_ns()));
    let (mut pairs, is_all) = pairs(&run, is_wanted);
    if pairs.is_empty() {
        let why = "what differs are no numbers, so there is nothing to draw";
        return Err(Error::file(wishes.of.file, why));
    }
    let step_of = |at: u64| {
        let passed = u128::from(at.saturating_sub(begin)) * limits::PLOT_STEPS as u128;
        let step = usize::try_from(passed / u128::from(length.max(1))).unwrap_or(usize::MAX);
        (step, at.saturating_sub(begin) as f64 / 1e9)
    };
    run.walk(|plain, nodes, step| {
        match step {
            Step::Given(node, at, Some(had)) => {
                let layout = &nodes[node].layout;
                let of_node = pairs.iter_mut().filter(|pair| pair.node == node);
                for pair in of_node {
                    take(&mut pair.now, &pair.name, layout, &had, step_of(at));
                }
            }
            Step::Given(_, _, None) => {}
            Step::Recorded(event) => {
                if event.node().is_none() {
                    return Ok(());
                }
                let (layout, had) = had_of(plain, event);
                let is_of = |pair: &&mut Pair| nodes[pair.node].recorded == event.node();
                for pair in pairs.iter_mut().filter(is_of) {
                    let layout = layout.unwrap_or(&nodes[pair.node].layout);
                    take(
                        &mut pair.before,
                        &pair.name,
                        layout,
                        &had,
                        step_of(event.unix_ns),
                    );
                }
            }
        }
        Ok(())
    })?;
    Ok(svg(wishes, &pairs, is_all, length as f64 / 1e9))
}

/// The numbers that are drawn, and whether they are all.
fn pairs(run: &Run, is_wanted: &[bool]) -> (Vec<Pair>, bool) {
    let (mut pairs, mut is_all) = (Vec::new(), true);
    for (node, anew) in run
        .nodes
        .iter()
        .enumerate()
        .filter(|(node, _)| is_wanted[*node])
    {
        let names = numbers(run, anew);
        is_all &= names.len() <= limits::DIFF_PANELS_MAX;
        for (name, unit) in names.into_iter().take(limits::DIFF_PANELS_MAX) {
            if pairs.len() == limits::PLOT_PANELS_MAX {
                return (pairs, false);
            }
            let unit = match unit {
                "" => String::new(),
                unit => format!(", {}", harmless(unit)),
            };
            let title = format!("{}.{}{unit}", harmless(&anew.path), harmless(&name));
            let line = || Line::new(node, name.clone(), title.clone());
            pairs.push(Pair {
                node,
                before: line(),
                now: line(),
                name,
            });
        }
    }
    (pairs, is_all)
}

/// The numbers of a node with their units: those that it has now, and then those that it had alone.
fn numbers<'a>(run: &'a Run, anew: &'a Anew) -> Vec<(String, &'a str)> {
    let names_of = |layout: &Layout| match layout {
        Layout::Fields(_) => layout.names(),
        Layout::Bytes(_) | Layout::Text(_) => Vec::new(),
    };
    let now = names_of(&anew.layout);
    let recorded = anew.recorded.and_then(|node| run.plain.layout(node));
    let mut before = recorded.map(names_of).unwrap_or_default();
    before.retain(|name| !now.contains(name));
    let unit = anew.recorded.map(|node| &*run.plain.nodes()[node].units);
    let before = before
        .into_iter()
        .map(|name| (name, unit.unwrap_or_default()));
    let now = now.into_iter().map(|name| (name, &*anew.trial.units));
    now.chain(before).collect()
}

fn take(line: &mut Line, name: &str, layout: &Layout, had: &Had, (step, at): (usize, f64)) {
    let tuple = match had {
        Ok(tuple) => tuple,
        Err(_) => return line.fail(at),
    };
    let found = layout.names().iter().position(|other| other == name);
    if let Some(number) = found.and_then(|found| layout.numbers(tuple).get(found).copied()) {
        line.take(step, at, number.to_f64());
    }
}

fn svg(wishes: &Wishes<'_>, pairs: &[Pair], is_all: bool, end: f64) -> String {
    let across = chart::range([0.0, end].into_iter(), 1.0);
    let (width, height) = size(pairs.len());
    let mut svg: Svg = chart::sheet(&named(wishes.of.file), width, height + HEAD);
    svg.raw(STYLE);
    let more = if is_all {
        ""
    } else {
        "; not all numbers that differ"
    };
    let head = format!("grey: recorded; blue: by {}{more}", named(wishes.of.config));
    svg.tag("text")
        .numbers(1, [("x", 80.0), ("y", HEAD)])
        .text(&head);
    for (at, pair) in pairs.iter().enumerate() {
        let (before, now) = (pair.before.points(across.1), pair.now.points(across.1));
        let both: Vec<(f64, f64)> = before.iter().chain(&now).copied().collect();
        let mut panel = panel(at, &both, across);
        panel.top += HEAD;
        let is_last = at + 1 == pairs.len();
        panel.frame(&mut svg, if is_last { "t, s" } else { "" }, &pair.now.title);
        // A number that only one of the two has is a line alone.
        if !before.is_empty() {
            panel.line_before(&mut svg, before.into_iter());
        }
        if !now.is_empty() {
            panel.line(&mut svg, now.into_iter(), false);
        }
        marks(&mut svg, &panel, &pair.now);
    }
    svg.finish()
}
