//! `trik plot`: numbers of a recording over time, as a picture.
//!
//! Owns which numbers are drawn, and where. What is left of a long recording is known to `line`; axes are the business of
//! `chart`.

mod line;
mod png;

use super::shared::{Opened, Progress, has_ending, moment, open};
use crate::chart::{self, Panel};
use crate::error::Error;
use crate::limits;
use crate::output::Output;
use crate::refusal::Refusal;
use crate::terminal::{harmless, named};
use clap::Args;
use journal::layout::Layout;
use journal::read::{Event, EventKind};
use lang_text::problem::Locale;
use lang_text::svg::Svg;
pub(crate) use line::Line;
use recorder::pattern::matches;
use std::path::PathBuf;

/// Size of a panel, and what is around it, in px.
pub(crate) const PANEL: (f64, f64) = (560.0, 110.0);
const LEFT: f64 = 80.0;
const TOP: f64 = 30.0;
const RIGHT: f64 = 20.0;
const BOTTOM: f64 = 36.0;
/// Height of the mark of a failure.
pub(crate) const MARK: f64 = 8.0;

/// The options of `trik plot`.
#[derive(Args, Clone, Debug)]
pub(crate) struct PlotArgs {
    /// The recording.
    pub file: PathBuf,
    /// What to draw: a node, a group, a pattern with * for anything, or one number, NODE.NAME.
    #[arg(required = true, value_name = "NODE[.NUMBER]")]
    pub channels: Vec<String>,
    /// From this moment on, in seconds from the beginning [default: from the beginning].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub from: Option<u64>,
    /// Up to this moment and with it [default: to the end].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub to: Option<u64>,
    /// The picture as SVG, a new file; - is standard output.
    #[arg(long, value_name = "OUT.svg", required_unless_present = "output")]
    pub svg: Option<PathBuf>,
    /// The picture as SVG or PNG, by the ending of a new file; - is SVG on standard output.
    #[arg(long, short, value_name = "OUT.svg|OUT.png", conflicts_with = "svg")]
    pub output: Option<PathBuf>,
    /// Overwrite the picture if it exists.
    #[arg(long)]
    pub force: bool,
}

/// Draws it.
///
/// # Errors
/// It is no whole recording, has no such numbers or too many, or the picture cannot be written.
pub(crate) fn run(args: &PlotArgs) -> Result<u8, Refusal> {
    let path = args.svg.as_deref().or(args.output.as_deref());
    let output = Output {
        path,
        force: args.force,
        source: &args.file,
        locale: Locale::English,
    };
    let ends = |with: &str| path.is_some_and(|path| has_ending(path, with));
    let is_png = args.svg.is_none() && ends("png");
    if args.svg.is_none() && !ends("svg") && !is_png && !output.is_standard() {
        let why = "the picture is SVG or PNG: its name ends with .svg or .png";
        return Err(Refusal::new(why));
    }
    output.refuse_present()?;
    let mut opened = open(&args.file)?;
    let mut lines = lines(&opened, args)?;
    let begin = opened.begin_ns();
    let first = begin.saturating_add(args.from.unwrap_or(0));
    let last = args.to.map_or(u64::MAX, |to| begin.saturating_add(to));
    let last = last.min(opened.end_ns());
    if last < first {
        return Err(Error::file(&args.file, "nothing happens in this time").into());
    }
    opened.seek(first);
    read(&mut opened, &mut lines, (begin, first, last))
        .map_err(|why| Error::file(&args.file, why))?;
    if lines.iter().all(Line::is_empty) {
        return Err(Error::file(&args.file, "nothing happens in this time").into());
    }
    let second = |at: u64| (at - begin) as f64 / 1e9;
    let across = chart::range([second(first), second(last)].into_iter(), 1.0);
    let picture = match is_png {
        true => png::picture(&lines, across),
        false => picture(&named(&args.file), &lines, across).into_bytes(),
    };
    output.write(&picture)?;
    Ok(0)
}

/// The numbers that are meant, in the order of the nodes.
fn lines(opened: &Opened, args: &PlotArgs) -> Result<Vec<Line>, Error> {
    let mut lines = Vec::new();
    let mut is_used = vec![false; args.channels.len()];
    for (node, about) in opened.nodes().iter().enumerate() {
        let names = match opened.layout(node) {
            Some(layout @ Layout::Fields(_)) => layout.names(),
            Some(Layout::Bytes(_) | Layout::Text(_)) | None => continue,
        };
        for name in names {
            let channel = format!("{}.{name}", about.path);
            let mut is_wanted = false;
            for (used, pattern) in is_used.iter_mut().zip(&args.channels) {
                if matches(pattern, &about.path) || matches(pattern, &channel) {
                    (*used, is_wanted) = (true, true);
                }
            }
            if !is_wanted {
                continue;
            }
            if lines.len() == limits::PLOT_PANELS_MAX {
                let most = limits::PLOT_PANELS_MAX;
                let why = format!("these are more than {most} numbers: name fewer");
                return Err(Error::file(&args.file, why));
            }
            let unit = match about.units.as_str() {
                "" => String::new(),
                unit => format!(", {}", harmless(unit)),
            };
            lines.push(Line::new(
                node,
                name,
                format!("{}{unit}", harmless(&channel)),
            ));
        }
    }
    match is_used.iter().position(|used| !used) {
        None => Ok(lines),
        Some(at) => {
            let channel = harmless(&args.channels[at]);
            let why = format!("no node with numbers is {channel}: trik info lists the nodes");
            Err(Error::file(&args.file, why))
        }
    }
}

/// Fills the lines from the first moment to the last.
fn read(
    opened: &mut Opened,
    lines: &mut [Line],
    (begin, first, last): (u64, u64, u64),
) -> Result<(), journal::error::Error> {
    let mut progress = Progress::new();
    let length = (last - first).max(1);
    // What a node had before holds until it gives something else.
    for event in opened.newest(first)?.into_iter().flatten() {
        take(opened, lines, &event, 0, (first - begin) as f64 / 1e9);
    }
    while let Some(event) = opened.next()? {
        if event.unix_ns > last {
            break;
        }
        let passed = event.unix_ns - first;
        progress.at(passed, length);
        let step = u128::from(passed) * limits::PLOT_STEPS as u128 / u128::from(length);
        let step = usize::try_from(step).unwrap_or(usize::MAX);
        take(
            opened,
            lines,
            &event,
            step,
            (event.unix_ns - begin) as f64 / 1e9,
        );
    }
    Ok(())
}

fn take(opened: &Opened, lines: &mut [Line], event: &Event, step: usize, at: f64) {
    match &event.what {
        EventKind::Sample {
            node,
            layout,
            tuple,
            ..
        } => {
            let layout = &opened.layouts()[*layout];
            let mut of_node = lines
                .iter_mut()
                .filter(|line| line.node == *node)
                .peekable();
            if of_node.peek().is_none() {
                return;
            }
            let (names, numbers) = (layout.names(), layout.numbers(tuple));
            for line in of_node {
                // Before its format changed a node may have had other numbers.
                let found = names.iter().position(|name| *name == line.name);
                if let Some(number) = found.and_then(|found| numbers.get(found)) {
                    line.take(step, at, number.to_f64());
                }
            }
        }
        EventKind::Fault { node, .. } => {
            for line in lines.iter_mut().filter(|line| line.node == *node) {
                line.fail(at);
            }
        }
        EventKind::Line(..) => {}
    }
}

/// Width and height of the picture with so many panels, in px.
pub(crate) fn size(panels: usize) -> (f64, f64) {
    let each = PANEL.1 + BOTTOM + TOP;
    (LEFT + PANEL.0 + RIGHT, 10.0 + each * panels as f64)
}

/// The panel with this number.
pub(crate) fn panel(at: usize, points: &[(f64, f64)], across: (f64, f64)) -> Panel {
    let each = PANEL.1 + BOTTOM + TOP;
    Panel {
        left: LEFT,
        top: 10.0 + TOP + each * at as f64 - 8.0,
        size: PANEL,
        across,
        upwards: chart::range(points.iter().map(|point| point.1), 1.05),
    }
}

fn picture(name: &str, lines: &[Line], across: (f64, f64)) -> String {
    let (width, height) = size(lines.len());
    let mut svg = chart::sheet(name, width, height);
    for (at, line) in lines.iter().enumerate() {
        let points = line.points(across.1);
        let panel = panel(at, &points, across);
        let is_last = at + 1 == lines.len();
        panel.frame(&mut svg, if is_last { "t, s" } else { "" }, &line.title);
        panel.line(&mut svg, points.into_iter(), false);
        marks(&mut svg, &panel, line);
    }
    svg.finish()
}

/// Where it failed.
pub(crate) fn marks(svg: &mut Svg, panel: &Panel, line: &Line) {
    let low = panel.top + PANEL.1;
    let marks = line.faults.iter().flat_map(|fault| {
        let (at, _) = panel.point(*fault, 0.0);
        [('M', (at, low)), ('L', (at, low - MARK))]
    });
    if !line.faults.is_empty() {
        svg.tag("path")
            .with("stroke", "#c0392b")
            .with("stroke-width", "2")
            .path(1, marks)
            .close();
    }
}
