//! A diagram as a picture: SVG that needs nothing else.
//!
//! Owns colours and ways of links; where texts stand is in `labels`, and icons are in the rows of blocks. All texts of the
//! project are escaped; numbers that are none or far away are left out.

use super::labels::{self, Area, HALF, Room};
use super::{details, name, shortened};
use crate::blocks::{self, Category};
use crate::limits::{PICTURE_BLOCKS_MAX, PICTURE_CORNERS_MAX};
use crate::project::{Block, Diagram, Link};
use lang_text::problem::Locale;
use lang_text::svg::{Svg, View};

/// Around everything, in px.
const MARGIN: f64 = 20.0;
/// Beside how many parts of a link a place for its guard is looked for.
const GUARD_PARTS: usize = 8;
/// How far from the origin anything may be.
const FAR: f64 = 200_000.0;

/// The picture of a diagram. What is too much for one picture is left out, and said.
pub fn picture(diagram: &Diagram, locale: Locale) -> String {
    let blocks: Vec<&Block> = diagram.blocks.iter().take(PICTURE_BLOCKS_MAX).collect();
    let middles: Vec<(f64, f64)> = blocks.iter().map(|block| middle(block)).collect();
    let mut taken: Vec<Area> = Vec::new();
    let mut all_labels = Vec::new();
    for (at, block) in blocks.iter().enumerate() {
        let label = Label::of(block, locale, labels::room(at, &middles));
        taken.push(Area::around(middles[at], HALF, HALF));
        taken.push(Area::under(middles[at], &label.lines));
        all_labels.push(label);
    }
    let links = diagram.links.iter().take(2 * PICTURE_BLOCKS_MAX);
    let ways: Vec<(&Link, Vec<(f64, f64)>)> = links
        .filter_map(|link| Some((link, way(link, diagram)?)))
        .collect();
    let guards = ways.iter().map(|(link, way)| guard(link, way, &mut taken));
    let guards: Vec<Option<Guard>> = guards.collect();
    let corners = ways.iter().flat_map(|(_, way)| way.iter());
    let corners = corners.map(|&corner| Area::around(corner, 0.0, 0.0));
    let all = taken.iter().copied().chain(corners).reduce(Area::with);
    let all = all.unwrap_or(Area::around((0.0, 0.0), HALF, HALF));
    let (x, y) = (all.low.0 - MARGIN, all.low.1 - MARGIN);
    let mut svg = Svg::new();
    let view = View {
        frame: [x, y, all.high.0 + MARGIN - x, all.high.1 + MARGIN - y],
        digits: 0,
        is_sized: true,
    };
    svg.picture(view).open();
    svg.tag("title").text(shortened(&diagram.name));
    svg.raw(STYLE);
    for (_, way) in &ways {
        svg.tag("polyline")
            .with("class", "l")
            .points(way.iter().copied())
            .with("marker-end", "url(#a)")
            .close();
    }
    for (block, label) in blocks.iter().zip(&all_labels) {
        draw_block(block, label, &mut svg);
    }
    for guard in guards.into_iter().flatten() {
        let x = f64::midpoint(guard.place.low.0, guard.place.high.0);
        svg.tag("text")
            .with("class", "g")
            .numbers(1, [("x", x), ("y", guard.place.high.1 - 2.0)])
            .text(&guard.text);
    }
    let left = diagram.blocks.len() - blocks.len();
    if left > 0 {
        svg.tag("text")
            .numbers(0, [("x", x + MARGIN), ("y", y + MARGIN)])
            .text(format_args!("+ {left}"));
    }
    svg.finish()
}

const STYLE: &str = "<style>text{font:10px sans-serif;text-anchor:middle;fill:#222;paint-order:stroke;stroke:#fff;stroke-width:3}.d{fill:#666}.g{font-weight:bold}\
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

/// Where the way from the middle of a block to another place leaves its box.
fn edge(from: (f64, f64), to: (f64, f64)) -> (f64, f64) {
    let (x, y) = (to.0 - from.0, to.1 - from.1);
    let far = x.abs().max(y.abs());
    if far <= HALF {
        return from;
    }
    (from.0 + x * HALF / far, from.1 + y * HALF / far)
}

/// The corners of a link from the edge of one block to the edge of another.
fn way(link: &Link, diagram: &Diagram) -> Option<Vec<(f64, f64)>> {
    let at = |end: Option<usize>| end.and_then(|end| diagram.blocks.get(end)).map(middle);
    let corners = link.path.iter().take(PICTURE_CORNERS_MAX);
    let corners: Vec<(f64, f64)> = corners.map(|&(x, y)| (sane(x), sane(y))).collect();
    // The inner corners as drawn; the ends at the blocks, which may have moved since.
    let inner = match corners.len() {
        0..=2 => &[][..],
        count => &corners[1..count - 1],
    };
    let from = at(link.from).or_else(|| corners.first().copied())?;
    let to = at(link.to).or_else(|| corners.last().copied())?;
    let first = inner.first().copied().unwrap_or(to);
    let last = inner.last().copied().unwrap_or(from);
    let mut all = vec![edge(from, first)];
    all.extend_from_slice(inner);
    all.push(edge(to, last));
    Some(all)
}

/// The guard of a link.
struct Guard {
    text: String,
    place: Area,
}

/// The guard of a link beside one of its parts, where nothing else is.
fn guard(link: &Link, way: &[(f64, f64)], taken: &mut Vec<Area>) -> Option<Guard> {
    let text = shortened(&link.guard);
    if text.is_empty() {
        return None;
    }
    let (half, high) = (labels::width(&text) / 2.0 + 2.0, labels::LINE / 2.0);
    let mut places = Vec::new();
    for part in [0.5, 0.3, 0.7, 0.15, 0.85] {
        for ends in way.windows(2).take(GUARD_PARTS) {
            let (one, two) = (ends[0], ends[1]);
            let x = one.0 + (two.0 - one.0) * part;
            let y = one.1 + (two.1 - one.1) * part;
            let beside = [
                (0.0, -high - 2.0),
                (0.0, high + 2.0),
                (half, 0.0),
                (-half, 0.0),
            ];
            let around = |(right, down)| Area::around((x + right, y + down), half, high);
            places.extend(beside.map(around));
        }
    }
    let place = labels::free(&places, taken)?;
    Some(Guard { text, place })
}

/// What stands under a block.
struct Label {
    /// The name, then properties.
    lines: Vec<String>,
    /// How many lines the name has.
    named: usize,
    /// All of it.
    whole: String,
}

impl Label {
    fn of(block: &Block, locale: Locale, room: Room) -> Self {
        let (name, details) = (name(block, locale), details(block));
        let (said, details) = (shortened(&name), shortened(&details));
        let mut lines = labels::wrapped(&said, room.width, room.lines);
        let named = lines.len();
        let left = room.lines - named.min(room.lines);
        if left > 0 {
            lines.extend(labels::wrapped(&details, room.width, left));
        }
        Self {
            lines,
            named,
            whole: format!("{said}: {details}"),
        }
    }
}

fn draw_block(block: &Block, label: &Label, svg: &mut Svg) {
    let (x, y) = middle(block);
    let row = blocks::find(&block.kind);
    let color = match row.map(|row| row.category) {
        Some(Category::Algorithms) => "#3572b0",
        Some(Category::Actions) => "#2f9e5a",
        Some(Category::Wait) => "#c98a1b",
        Some(Category::Drawing) => "#8a4fb5",
        None => "#888888",
    };
    svg.tag("g")
        .with("data-id", &block.id)
        .with("transform", format_args!("translate({x:.1} {y:.1})"))
        .open();
    svg.tag("title").text(&label.whole);
    svg.tag("rect")
        .numbers(0, [("x", -25.0), ("y", -25.0)])
        .numbers(0, [("width", 50.0), ("height", 50.0), ("rx", 9.0)])
        .with("fill", color)
        .close();
    svg.raw(row.map_or(UNKNOWN, |row| row.icon));
    svg.raw("\n");
    for (at, line) in label.lines.iter().enumerate() {
        let mut tag = svg.tag("text");
        if at >= label.named {
            tag = tag.with("class", "d");
        }
        let y = labels::FIRST_LINE + labels::LINE * at as f64;
        tag.numbers(0, [("y", y)]).text(line);
    }
    svg.end();
}

/// The sign of a block that nobody knows.
const UNKNOWN: &str = "<path class=\"i\" d=\"M-6 -8a6 6 0 1 1 8 6q-2 1 -2 5M0 10v1\"/>";
