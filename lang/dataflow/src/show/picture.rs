//! A diagram as a picture: SVG that needs nothing else.
//!
//! Owns colours, ends of edges and where texts stand. Sizes of blocks and places of ports are in their rows. All texts of
//! the project are escaped; numbers that are none or far away are left out.

use super::ways::{Looks, Obstacle, Stop, Ways};
use super::{changed, kind, shortened};
use crate::blocks::{Direction, Does, Kind, Port, Row};
use crate::limits::{
    PICTURE_BLOCKS_MAX, PICTURE_CORNERS_MAX, PICTURE_EDGES_MAX, PICTURE_PROPERTY_MAX,
};
use crate::project::{Block, Edge, End, Policy, Project};
use lang_text::problem::Locale;
use lang_text::svg::{Svg, View};

/// Around everything, in px.
const MARGIN: f64 = 20.0;
/// How far from the origin anything may be.
const FAR: f64 = 200_000.0;
/// Width and height of a block that no row knows.
const UNKNOWN: (u16, u16) = (100, 100);
/// Between two lines of text.
const LINE: f64 = 12.0;
/// Lines below a block: its caption, what it is, and properties; one more says that there are others.
const LINES: usize = 5;
/// About the width of a letter.
const LETTER: f64 = 5.6;
/// The same in the name of a port.
const PORT_LETTER: f64 = 4.8;
/// How far texts below a block may stand out on each side.
const OUT: f64 = 30.0;

/// The picture of one diagram; of none if there is no such diagram. What is too much for one picture is left out, and said.
/// Who draws several has the same `looks` for all.
pub fn picture(project: &Project, diagram: usize, locale: Locale, looks: &mut Looks) -> String {
    let mut svg = Svg::new();
    let Some(diagram) = project.diagrams.get(diagram) else {
        svg.picture(view((0.0, 0.0), (0.0, 0.0))).open();
        return svg.finish();
    };
    let blocks = &diagram.blocks[..diagram.blocks.len().min(PICTURE_BLOCKS_MAX)];
    let boxes: Vec<Frame> = blocks
        .iter()
        .map(|block| Frame::of(block, project, locale))
        .collect();
    let ways = ways(&diagram.edges, blocks, &boxes, looks);
    let (mut low, mut high) = ((f64::MAX, f64::MAX), (f64::MIN, f64::MIN));
    let all_boxes = boxes.iter().flat_map(Frame::corners);
    let all = all_boxes.chain(ways.iter().flat_map(|(_, way)| way.iter().copied()));
    for (x, y) in all {
        low = (x.min(low.0), y.min(low.1));
        high = (x.max(high.0), y.max(high.1));
    }
    if low.0 > high.0 {
        (low, high) = ((0.0, 0.0), (100.0, 100.0));
    }
    svg.picture(view(low, high)).open();
    svg.tag("title")
        .text(shortened(&diagram.name, PICTURE_PROPERTY_MAX));
    svg.raw(STYLE);
    // Ports are inside of their boxes, so edges are above these; names are above both.
    for (block, frame) in blocks.iter().zip(&boxes) {
        draw_box(block, frame, &mut svg);
    }
    for (edge, way) in &ways {
        draw_edge(edge, way, blocks, &mut svg);
    }
    for (block, frame) in blocks.iter().zip(&boxes) {
        draw_words(block, frame, &mut svg);
    }
    let left = diagram.blocks.len() - blocks.len();
    if left > 0 {
        svg.tag("text")
            .numbers(0, [("x", low.0), ("y", low.1)])
            .text(format_args!("+ {left}"));
    }
    svg.finish()
}

fn view(low: (f64, f64), high: (f64, f64)) -> View {
    let (x, y) = (low.0 - MARGIN, low.1 - MARGIN);
    View {
        frame: [x, y, high.0 + MARGIN - x, high.1 + MARGIN - y],
        digits: 0,
        is_sized: true,
    }
}

const STYLE: &str = "<style>text{font:10px sans-serif;text-anchor:middle;fill:#222;paint-order:stroke;stroke:#fff;stroke-width:3}\
.c{font-weight:bold}.d{fill:#666}.i{font:9px monospace;stroke:none}.p{font-size:8px;fill:#555;stroke:#f7f7f4;stroke-width:2}.l{text-anchor:start}.r{text-anchor:end}\
.b{fill:#f7f7f4;stroke:#777;stroke-width:1.5}.u{stroke:#c00;stroke-dasharray:5 3}.e{fill:none;stroke-width:1.5}</style>\n";

/// The colour of tokens of a kind.
fn color(kind: Kind) -> &'static str {
    match kind {
        Kind::Unit => "#777777",
        Kind::Truth => "#2f9e5a",
        Kind::Whole => "#3572b0",
        Kind::Text => "#b5489a",
        Kind::List | Kind::Items(_) => "#c9701b",
        Kind::Any => "#222222",
    }
}

/// A coordinate that can be drawn.
fn sane(number: f64) -> f64 {
    if number.is_finite() {
        number.clamp(-FAR, FAR)
    } else {
        0.0
    }
}

fn corner(block: &Block) -> (f64, f64) {
    (sane(block.position.0), sane(block.position.1))
}

fn size(row: Option<&Row>) -> (f64, f64) {
    let (width, height) = row.map_or(UNKNOWN, |row| row.size);
    (f64::from(width), f64::from(height))
}

fn port_of(block: &Block, port: i32) -> Option<&'static Port> {
    block.row?.ports.get(usize::try_from(port).ok()?)
}

/// Where an end of an edge is: at its port, or in the middle of its block if it has none.
fn place(end: End, blocks: &[Block]) -> Option<(f64, f64)> {
    let block = blocks.get(end.block)?;
    let (x, y) = corner(block);
    Some(match port_of(block, end.port) {
        Some(port) => (x + f64::from(port.at.0), y + f64::from(port.at.1)),
        None => {
            let (width, height) = size(block.row);
            (x + width / 2.0, y + height / 2.0)
        }
    })
}

/// The corners of an edge from port to port: the inner ones as drawn, the ends at the blocks, which may have moved since.
fn corners(edge: &Edge, blocks: &[Block]) -> Option<Vec<(f64, f64)>> {
    let drawn: Vec<(f64, f64)> = edge
        .path
        .iter()
        .take(PICTURE_CORNERS_MAX)
        .map(|&(x, y)| (sane(x), sane(y)))
        .collect();
    let inner = match drawn.len() {
        0..=2 => &[][..],
        count => &drawn[1..count - 1],
    };
    let at = |end: Option<End>| end.and_then(|end| place(end, blocks));
    let from = at(edge.from).or_else(|| drawn.first().copied())?;
    let to = at(edge.to).or_else(|| drawn.last().copied())?;
    let mut all = vec![from];
    all.extend_from_slice(inner);
    all.push(to);
    Some(all)
}

/// The edges that are drawn with their ways, which run around blocks.
fn ways<'a>(
    edges: &'a [Edge],
    blocks: &[Block],
    boxes: &[Frame],
    looks: &mut Looks,
) -> Vec<(&'a Edge, Vec<(f64, f64)>)> {
    let mut ways = Ways::new(boxes.iter().map(Frame::obstacle).collect(), looks);
    let mut all = Vec::new();
    for edge in edges.iter().take(PICTURE_EDGES_MAX) {
        let Some(drawn) = corners(edge, blocks) else {
            continue;
        };
        let (Some(&first), Some(&last)) = (drawn.first(), drawn.last()) else {
            continue;
        };
        let stop = |end: Option<End>, at| {
            let block = end.filter(|end| end.block < blocks.len());
            Stop {
                at,
                block: block.map(|end| end.block),
                is_port: block.is_some_and(|end| port_of(&blocks[end.block], end.port).is_some()),
            }
        };
        let ends = [stop(edge.from, first), stop(edge.to, last)];
        let from = edge.from.map(|from| (from.block, from.port));
        all.push((edge, ways.way(drawn, ends, from)));
    }
    all
}

fn draw_edge(edge: &Edge, way: &[(f64, f64)], blocks: &[Block], svg: &mut Svg) {
    let kind = |end: Option<End>| {
        let end = end?;
        Some(port_of(blocks.get(end.block)?, end.port)?.of)
    };
    // What is known of one end is known of its tokens.
    let (from, to) = (kind(edge.from), kind(edge.to));
    let kind = match from {
        None | Some(Kind::Any) => to.or(from),
        Some(Kind::Unit | Kind::Truth | Kind::Whole | Kind::Text | Kind::List | Kind::Items(_)) => {
            from
        }
    };
    let color = kind.map_or("#cc0000", color);
    svg.tag("polyline")
        .with("class", "e")
        .with("data-id", &edge.id)
        .with("stroke", color)
        .points(way.iter().copied())
        .close();
    if let [.., before, last] = way {
        let (x, y) = (last.0 - before.0, last.1 - before.1);
        let long = libm::hypot(x, y);
        if long > 1.0 {
            let (x, y) = (x / long * 9.0, y / long * 9.0);
            let foot = (last.0 - x, last.1 - y);
            let sides = [
                (foot.0 - y * 0.4, foot.1 + x * 0.4),
                (foot.0 + y * 0.4, foot.1 - x * 0.4),
            ];
            svg.tag("path")
                .outline(1, [*last, sides[0], sides[1]])
                .with("fill", color)
                .close();
        }
    }
    let said = queue(edge);
    let long = |line: &&[(f64, f64)]| libm::hypot(line[1].0 - line[0].0, line[1].1 - line[0].1);
    // Of equally long parts the first one.
    let longest = way
        .windows(2)
        .rev()
        .max_by(|one, other| long(one).total_cmp(&long(other)));
    if let Some([first, second]) = longest
        && !said.is_empty()
    {
        let (x, y) = (
            f64::midpoint(first.0, second.0),
            f64::midpoint(first.1, second.1),
        );
        svg.tag("text")
            .with("class", "d")
            .numbers(1, [("x", x), ("y", y - 4.0)])
            .text(said);
    }
}

/// What an edge says of its queue.
fn queue(edge: &Edge) -> String {
    let policy = edge.policy.map(Policy::word);
    let capacity = edge.capacity.map(|capacity| capacity.to_string());
    let parts: Vec<String> = policy
        .map(str::to_owned)
        .into_iter()
        .chain(capacity)
        .collect();
    parts.join(" ")
}

/// A block with its texts.
struct Frame {
    at: (f64, f64),
    size: (f64, f64),
    title: String,
    /// Below it: the caption, what it is, and properties.
    lines: Vec<(&'static str, String)>,
    /// Inside of it, by the height at which they stand.
    inner: Vec<(f64, String)>,
}

impl Frame {
    fn of(block: &Block, project: &Project, locale: Locale) -> Self {
        let size = size(block.row);
        let room = ((size.0 + 2.0 * OUT) / LETTER) as usize;
        let kind = kind(block, locale);
        let mut lines = Vec::new();
        let caption = block.name.trim();
        if !caption.is_empty() && caption != kind {
            lines.push(("c", shortened(caption, room)));
        }
        lines.push(("d", shortened(&kind, room)));
        let mut title = format!("{}: {kind}", shortened(caption, PICTURE_PROPERTY_MAX));
        if let Some(logical) = &block.calls {
            let called = project
                .called(logical)
                .and_then(|at| project.diagrams.get(at));
            let name = called.map_or("?", |diagram| diagram.name.as_str());
            lines.push(("d", shortened(name, room)));
        }
        let inner = inner(block, size);
        let mut is_cut = false;
        for one in changed(block) {
            let text = format!(
                "{} = {}",
                one.name,
                shortened(one.text, PICTURE_PROPERTY_MAX)
            );
            title.push('\n');
            title.push_str(&text);
            let is_inside = !inner.is_empty() && is_inner(block, one.name);
            if !is_inside && lines.len() < LINES {
                lines.push(("d", shortened(&text, room)));
            } else {
                is_cut |= !is_inside;
            }
        }
        if is_cut {
            // The title has them all.
            lines.push(("d", "...".to_owned()));
        }
        Self {
            at: corner(block),
            size,
            title,
            lines,
            inner,
        }
    }

    /// How far its words reach below it.
    fn below(&self) -> f64 {
        LINE * (self.lines.len() as f64 + 0.5)
    }

    /// The corners of what it takes.
    fn corners(&self) -> [(f64, f64); 2] {
        let (x, y) = self.at;
        [
            (x - OUT, y),
            (x + self.size.0 + OUT, y + self.size.1 + self.below()),
        ]
    }

    /// What of it is in the way of edges.
    fn obstacle(&self) -> Obstacle {
        let (x, y) = self.at;
        Obstacle {
            low: self.at,
            high: (x + self.size.0, y + self.size.1),
            words: self.below(),
        }
    }
}

/// Names of the properties that belong to the output with a number.
fn of_output(number: usize) -> [String; 3] {
    [
        format!("IO{number}"),
        format!("cond{number}"),
        format!("O{number}"),
    ]
}

fn is_inner(block: &Block, name: &str) -> bool {
    let is_of = |number| of_output(number).iter().any(|one| one == name);
    computes(block) && (0..6).any(is_of)
}

/// Whether a block has a text for each of its outputs.
fn computes(block: &Block) -> bool {
    block
        .row
        .is_some_and(|row| matches!(row.does, Does::Function | Does::Switch))
}

/// Texts inside of a block: what leaves on each of its outputs.
fn inner(block: &Block, size: (f64, f64)) -> Vec<(f64, String)> {
    let Some(row) = block.row.filter(|_| computes(block)) else {
        return Vec::new();
    };
    let room = ((size.0 - 60.0) / LETTER) as usize;
    let mut all = Vec::new();
    for number in 0..6 {
        let name = format!("O{number}");
        let Some(port) = row.ports.iter().find(|port| port.name == name) else {
            continue;
        };
        let names = of_output(number);
        let texts = names.iter().filter(|name| row.property(name).is_some());
        let texts = texts
            .map(|name| block.text(name))
            .filter(|text| !text.is_empty());
        let text: Vec<&str> = texts.collect();
        if !text.is_empty() {
            let text = shortened(&text.join(": "), room);
            all.push((f64::from(port.at.1) + 3.0, text));
        }
    }
    all
}

fn draw_box(block: &Block, frame: &Frame, svg: &mut Svg) {
    let ((x, y), (width, height)) = (frame.at, frame.size);
    svg.tag("g").with("data-id", &block.id).open();
    svg.tag("title").text(&frame.title);
    let class = if block.row.is_some() { "b" } else { "b u" };
    svg.tag("rect")
        .with("class", class)
        .numbers(1, [("x", x), ("y", y)])
        .numbers(0, [("width", width), ("height", height), ("rx", 8.0)])
        .close();
    svg.end();
}

/// Ports and texts of a block.
fn draw_words(block: &Block, frame: &Frame, svg: &mut Svg) {
    let ((x, y), (width, height)) = (frame.at, frame.size);
    svg.tag("g")
        .with("transform", format_args!("translate({x:.1} {y:.1})"))
        .open();
    let ports = block.row.map_or(&[][..], |row| row.ports);
    for port in ports {
        draw_port(port, ports, (width, height), svg);
    }
    for (y, text) in &frame.inner {
        svg.tag("text")
            .with("class", "i")
            .numbers(0, [("x", width / 2.0), ("y", *y)])
            .text(text);
    }
    for (at, (class, line)) in frame.lines.iter().enumerate() {
        let y = height + LINE * (at as f64 + 1.0);
        svg.tag("text")
            .with("class", class)
            .numbers(0, [("x", width / 2.0), ("y", y)])
            .text(line);
    }
    svg.end();
}

fn draw_port(port: &Port, all: &[Port], (width, height): (f64, f64), svg: &mut Svg) {
    let (x, y) = (f64::from(port.at.0), f64::from(port.at.1));
    let tag = svg
        .tag("circle")
        .numbers(0, [("cx", x), ("cy", y), ("r", 4.0)]);
    // What comes in is hollow.
    match port.way {
        Direction::In => tag
            .with("fill", "#fff")
            .with("stroke", color(port.of))
            .with("stroke-width", 2),
        Direction::Out => tag.with("fill", color(port.of)),
    }
    .close();
    let is_at_side = x < 20.0 || x > width - 20.0;
    let (class, text_x, text_y) = match () {
        () if y < 8.0 => ("p", x.clamp(16.0, width - 16.0), y + 14.0),
        () if y > height - 10.0 && !is_at_side => ("p", x, y - 8.0),
        () if x < width / 2.0 => ("p l", x + 7.0, y + 3.0),
        () => ("p r", x - 7.0, y + 3.0),
    };
    // Two long names do not fit beside each other.
    let is_tight = |other: &Port| {
        let letters = (port.name.len() + other.name.len()) as f64;
        let is_beside = other.way != port.way && (other.at.1 - port.at.1).abs() < 8;
        is_beside && letters * PORT_LETTER + 22.0 > width
    };
    let is_lower = port.way == Direction::Out && all.iter().any(is_tight);
    let text_y = if is_lower { text_y + 10.0 } else { text_y };
    svg.tag("text")
        .with("class", class)
        .numbers(0, [("x", text_x), ("y", text_y)])
        .text(port.name);
}
