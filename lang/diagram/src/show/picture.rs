//! A diagram as a picture: SVG that needs nothing else.
//!
//! Owns icons, colours and places. All texts of the project are escaped; numbers that are none or far away are left out.

use std::fmt::Write as _;

use super::{details, name};
use crate::blocks::{self, Category, Does};
use crate::limits::{PICTURE_BLOCKS_MAX, PICTURE_CORNERS_MAX};
use crate::project::{Block, Diagram, Link};
use lang_text::problem::Locale;

/// Half of the side of a block, in px.
const HALF: f64 = 25.0;
/// Around everything, in px.
const MARGIN: f64 = 70.0;
/// How far from the origin anything may be.
const FAR: f64 = 200_000.0;

/// The picture of a diagram. What is too much for one picture is left out, and said.
pub fn picture(diagram: &Diagram, locale: Locale) -> String {
    let blocks: Vec<&Block> = diagram.blocks.iter().take(PICTURE_BLOCKS_MAX).collect();
    let (mut low, mut high) = ((f64::MAX, f64::MAX), (f64::MIN, f64::MIN));
    for block in &blocks {
        let (x, y) = middle(block);
        low = (low.0.min(x), low.1.min(y));
        high = (high.0.max(x), high.1.max(y));
    }
    if blocks.is_empty() {
        (low, high) = ((0.0, 0.0), (0.0, 0.0));
    }
    let (x, y) = (low.0 - MARGIN, low.1 - MARGIN);
    let (width, height) = (high.0 - low.0 + 2.0 * MARGIN, high.1 - low.1 + 2.0 * MARGIN);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{x:.0} {y:.0} {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\">\n"
    );
    let _ = writeln!(out, "<title>{}</title>", escaped(&diagram.name));
    out.push_str(STYLE);
    for link in diagram.links.iter().take(2 * PICTURE_BLOCKS_MAX) {
        draw_link(link, diagram, &mut out);
    }
    for block in &blocks {
        draw_block(block, locale, &mut out);
    }
    let left = diagram.blocks.len() - blocks.len();
    if left > 0 {
        let _ = writeln!(
            out,
            "<text x=\"{x:.0}\" y=\"{:.0}\">+ {left}</text>",
            y + 20.0
        );
    }
    out.push_str("</svg>\n");
    out
}

const STYLE: &str = "<style>text{font:10px sans-serif;text-anchor:middle;fill:#222}.d{fill:#666}.g{font-weight:bold}\
.l{fill:none;stroke:#555;stroke-width:1.5}.i{fill:none;stroke:#fff;stroke-width:3;stroke-linecap:round;stroke-linejoin:round}\
.f{fill:#fff}</style>\n<defs><marker id=\"a\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" \
orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#555\"/></marker></defs>\n";

/// A coordinate that can be drawn.
fn sane(number: f64) -> f64 {
    if number.is_finite() {
        number.clamp(-FAR, FAR)
    } else {
        0.0
    }
}

fn middle(block: &Block) -> (f64, f64) {
    let (x, y) = block.position;
    (sane(x) + HALF, sane(y) + HALF)
}

/// Text that stands between tags.
fn escaped(text: &str) -> String {
    lang_text::escape::escaped(&super::shortened(text))
}

/// Where the way from the middle of a block to another place leaves its box.
fn edge(from: (f64, f64), to: (f64, f64)) -> (f64, f64) {
    let (x, y) = (to.0 - from.0, to.1 - from.1);
    let far = x.abs().max(y.abs());
    if far <= HALF {
        return from;
    }
    (from.0 + x * HALF / far, from.1 + y * HALF / far)
}

fn draw_link(link: &Link, diagram: &Diagram, out: &mut String) {
    let at = |end: Option<usize>| end.and_then(|end| diagram.blocks.get(end)).map(middle);
    let corners = link.path.iter().take(PICTURE_CORNERS_MAX);
    let corners: Vec<(f64, f64)> = corners.map(|&(x, y)| (sane(x), sane(y))).collect();
    // The inner corners as drawn; the ends at the blocks, which may have moved since.
    let inner = match corners.len() {
        0..=2 => &[][..],
        count => &corners[1..count - 1],
    };
    let from = at(link.from).or_else(|| corners.first().copied());
    let to = at(link.to).or_else(|| corners.last().copied());
    let (Some(from), Some(to)) = (from, to) else {
        return;
    };
    let first = inner.first().copied().unwrap_or(to);
    let last = inner.last().copied().unwrap_or(from);
    let mut all = vec![edge(from, first)];
    all.extend_from_slice(inner);
    all.push(edge(to, last));
    let points: Vec<String> = all.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(
        out,
        "<polyline class=\"l\" points=\"{}\" marker-end=\"url(#a)\"/>",
        points.join(" ")
    );
    if !link.guard.is_empty() {
        let half = all.len() / 2;
        let (one, two) = (all[half - 1], all[half]);
        let (x, y) = (
            f64::midpoint(one.0, two.0),
            f64::midpoint(one.1, two.1) - 4.0,
        );
        let guard = escaped(&link.guard);
        let _ = writeln!(
            out,
            "<text class=\"g\" x=\"{x:.1}\" y=\"{y:.1}\">{guard}</text>"
        );
    }
}

fn draw_block(block: &Block, locale: Locale, out: &mut String) {
    let (x, y) = middle(block);
    let row = blocks::find(&block.kind);
    let color = match row.map(|row| row.category) {
        Some(Category::Algorithms) => "#3572b0",
        Some(Category::Actions) => "#2f9e5a",
        Some(Category::Wait) => "#c98a1b",
        Some(Category::Drawing) => "#8a4fb5",
        None => "#888888",
    };
    let said = escaped(&name(block, locale));
    let details = escaped(&details(block));
    let _ = writeln!(
        out,
        "<g transform=\"translate({x:.1} {y:.1})\"><title>{said}: {details}</title>"
    );
    let _ = writeln!(
        out,
        "<rect x=\"-25\" y=\"-25\" width=\"50\" height=\"50\" rx=\"9\" fill=\"{color}\"/>"
    );
    let _ = writeln!(out, "{}", icon(row.map(|row| row.does)));
    let _ = writeln!(out, "<text y=\"36\">{said}</text>");
    if !details.is_empty() {
        let _ = writeln!(out, "<text class=\"d\" y=\"47\">{details}</text>");
    }
    out.push_str("</g>\n");
}

/// A simple sign within a square of 50 px around the origin.
fn icon(does: Option<Does>) -> &'static str {
    let Some(does) = does else {
        return "<path class=\"i\" d=\"M-6 -8a6 6 0 1 1 8 6q-2 1 -2 5M0 10v1\"/>";
    };
    match does {
        Does::Start => "<path class=\"f\" d=\"M-8 -11L12 0L-8 11z\"/>",
        Does::End => "<rect class=\"f\" x=\"-9\" y=\"-9\" width=\"18\" height=\"18\"/>",
        Does::Comment => "<path class=\"i\" d=\"M-12 -8h24M-12 0h24M-12 8h14\"/>",
        Does::Merge => "<path class=\"i\" d=\"M-12 -12L0 2M12 -12L0 2V14\"/>",
        Does::Statements => "<path class=\"i\" d=\"M8 -13q-8 -3 -8 6v14q0 8 -8 6M-8 0h16\"/>",
        Does::Assign => "<path class=\"i\" d=\"M-11 -5h22M-11 5h22\"/>",
        Does::Random => {
            "<rect class=\"i\" x=\"-12\" y=\"-12\" width=\"24\" height=\"24\" rx=\"4\"/><circle class=\"f\" cx=\"-5\" cy=\"-5\" r=\"2.5\"/><circle class=\"f\" cx=\"5\" cy=\"5\" r=\"2.5\"/><circle class=\"f\" r=\"2.5\"/>"
        }
        Does::Ask => "<path class=\"i\" d=\"M-7 -6a7 7 0 1 1 9 7q-2 1 -2 4M0 12v1\"/>",
        Does::If => "<path class=\"i\" d=\"M0 -15L15 0L0 15L-15 0z\"/>",
        Does::Switch => "<path class=\"i\" d=\"M0 -14V-2M0 -2L-13 12M0 -2V12M0 -2L13 12\"/>",
        Does::Loop | Does::While => "<path class=\"i\" d=\"M11 -7a13 13 0 1 0 2 11M13 -14v8h-8\"/>",
        Does::Fork => "<path class=\"i\" d=\"M-14 -4h28M-9 -4v14M9 -4v14M0 -14v10\"/>",
        Does::Join => "<path class=\"i\" d=\"M-14 4h28M-9 4v-14M9 4v-14M0 4v10\"/>",
        Does::Kill => "<path class=\"i\" d=\"M-10 -10L10 10M10 -10L-10 10\"/>",
        Does::Call => {
            "<rect class=\"i\" x=\"-14\" y=\"-10\" width=\"28\" height=\"20\"/><path class=\"i\" d=\"M-9 -10v20M9 -10v20\"/>"
        }
        Does::Timer => "<circle class=\"i\" r=\"13\"/><path class=\"i\" d=\"M0 -8V0L6 4\"/>",
        Does::Send | Does::Receive | Does::Mail => {
            "<rect class=\"i\" x=\"-14\" y=\"-9\" width=\"28\" height=\"19\"/><path class=\"i\" d=\"M-14 -9L0 3L14 -9\"/>"
        }
        Does::AnyButton => "<circle class=\"i\" r=\"13\"/><circle class=\"f\" r=\"6\"/>",
        Does::Copy(_) => "<path class=\"i\" d=\"M-13 0h20M1 -7L8 0L1 7M13 -12v24\"/>",
        Does::Watch(_) => {
            "<path class=\"i\" d=\"M-14 0q14 -15 28 0q-14 15 -28 0z\"/><circle class=\"f\" r=\"4\"/>"
        }
        Does::Act(act) => act.icon,
    }
}
