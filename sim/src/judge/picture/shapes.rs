//! A field as shapes of SVG, and how far it reaches.
//!
//! Owns how each kind of thing looks. What is too far away for a picture is left out.

use super::is_near;
use crate::arena::floor::colour::Tint;
use crate::field::{Blob, Drawn, Field, Pen, Region, Shape, Solid, SolidKind};
use crate::geometry::Point;
use crate::limits;
use lang_text::svg::{Svg, Tag};

/// Colour of walls.
pub(crate) const WALL: &str = "#6d4c41";

/// Colour of things of a kind.
pub(crate) fn ink(kind: SolidKind) -> &'static str {
    match kind {
        SolidKind::Skittle => "#ef6c00",
        SolidKind::Ball => "#fdd835",
        SolidKind::Cube => "#78909c",
    }
}

/// A rectangle around points.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounds(Option<[f64; 4]>);

impl Bounds {
    pub fn add(&mut self, x: f64, y: f64) {
        if x.abs() > limits::FAR_PX || y.abs() > limits::FAR_PX || x.is_nan() || y.is_nan() {
            return;
        }
        let [left, top, right, bottom] = self.0.unwrap_or([x, y, x, y]);
        self.0 = Some([left.min(x), top.min(y), right.max(x), bottom.max(y)]);
    }

    /// Left, top, width and height, with some room.
    pub fn frame(self) -> [f64; 4] {
        const ROOM: f64 = 20.0;
        let [left, top, right, bottom] = self.0.unwrap_or([0.0, 0.0, 100.0, 100.0]);
        [
            left - ROOM,
            top - ROOM,
            right - left + 2.0 * ROOM,
            bottom - top + 2.0 * ROOM,
        ]
    }
}

/// A colour of a file as one of a page: `#aarrggbb` has its first part last there. What is none becomes `other`.
pub(crate) fn colour(text: &str, other: &str) -> String {
    let text = text.trim();
    // The same names as for sensors, so that nothing is seen by the one and not by the other.
    if Tint::named(text).is_none() {
        return other.to_owned();
    }
    match text.strip_prefix('#') {
        Some(digits) if digits.len() == 8 => format!("#{}{}", &digits[2..], &digits[..2]),
        Some(_) | None => text.to_owned(),
    }
}

/// How far a field reaches.
pub(crate) fn bounds(field: &Field, bounds: &mut Bounds) {
    let mut add = |at: Point| bounds.add(at.x, at.y);
    for wall in &field.walls {
        add(wall.begin);
        add(wall.end);
    }
    for solid in &field.solids {
        let half = solid.size / 2.0;
        add(Point {
            x: solid.at.x - half,
            y: solid.at.y - half,
        });
        add(Point {
            x: solid.at.x + half,
            y: solid.at.y + half,
        });
    }
    for drawn in &field.drawn {
        points(&drawn.shape).for_each(&mut add);
    }
    for image in &field.images {
        add(image.at);
        add(Point {
            x: image.at.x + image.size.x,
            y: image.at.y + image.size.y,
        });
    }
    for region in field.regions.iter().filter(|region| region.visible) {
        let [x, y, width, height] = upright(region.at, region.size);
        add(Point { x, y });
        add(Point {
            x: x + width,
            y: y + height,
        });
    }
}

fn points(shape: &Shape) -> Box<dyn Iterator<Item = Point> + '_> {
    match shape {
        Shape::Line(a, b) | Shape::Rectangle(a, b) | Shape::Ellipse(a, b) => {
            Box::new([*a, *b].into_iter())
        }
        Shape::Curve(a, b, c, d) => Box::new([*a, *b, *c, *d].into_iter()),
        Shape::Stylus(strokes) => {
            Box::new(strokes.iter().flat_map(|stroke| [stroke.begin, stroke.end]))
        }
    }
}

/// Left, top, width and height with no negative size.
pub(crate) fn upright(at: Point, size: Point) -> [f64; 4] {
    let left = at.x.min(at.x + size.x);
    let top = at.y.min(at.y + size.y);
    [left, top, size.x.abs(), size.y.abs()]
}

/// Everything of a field, lowest first.
pub(super) fn field(field: &Field, letters: f64, svg: &mut Svg) {
    let mut bytes = 0;
    for image in &field.images {
        let Some(blob) = field.blobs.get(&image.image) else {
            continue;
        };
        bytes += blob.text.len();
        if bytes > limits::DRAWING_BYTES || !is_near(image.at) || !is_near(image.size) {
            continue;
        }
        if let Some(source) = data(blob) {
            let place = upright(image.at, image.size);
            placed(svg.tag("image"), 1, place)
                .with("preserveAspectRatio", "none")
                .with("href", source)
                .close();
        }
    }
    for one in &field.drawn {
        drawn(one, svg);
    }
    for stroke in &field.trace {
        let ink = colour(&stroke.colour, "#000000");
        line(
            stroke.begin,
            stroke.end,
            &Style::line(&ink, stroke.width),
            svg,
        );
    }
    for one in field.regions.iter().filter(|region| region.visible) {
        region(one, letters, svg);
    }
    for wall in &field.walls {
        line(wall.begin, wall.end, &Style::line(WALL, wall.width), svg);
    }
    for one in &field.solids {
        solid(one, svg);
    }
}

fn placed(tag: Tag<'_>, digits: usize, [x, y, width, height]: [f64; 4]) -> Tag<'_> {
    let sides = [("x", x), ("y", y), ("width", width), ("height", height)];
    tag.numbers(digits, sides)
}

/// Begins a rectangle: left, top, width and height.
pub(super) fn rect(place: [f64; 4], svg: &mut Svg) -> Tag<'_> {
    placed(svg.tag("rect"), 1, place)
}

/// The same on whole pixels.
pub(super) fn whole_rect(place: [f64; 4], svg: &mut Svg) -> Tag<'_> {
    placed(svg.tag("rect"), 0, place)
}

/// A picture as an address that holds it.
pub(crate) fn data(blob: &Blob) -> Option<String> {
    let ending = blob
        .path
        .rsplit('.')
        .next()
        .unwrap_or("")
        .to_ascii_lowercase();
    let kind = match &*ending {
        "jpg" | "jpeg" => "jpeg",
        "bmp" => "bmp",
        "gif" => "gif",
        // The text of an SVG would need another coding.
        "svg" => return None,
        _ => "png",
    };
    let text: String = blob.text.split_ascii_whitespace().collect();
    let is_base64 = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'+' | b'/' | b'=');
    (!text.is_empty() && text.bytes().all(is_base64))
        .then(|| format!("data:image/{kind};base64,{text}"))
}

/// How a line and its inside look.
pub(crate) struct Style {
    /// Colour of the line, or `none`.
    pub stroke: String,
    /// Across the line.
    pub width: f64,
    /// Colour inside, or `none`.
    pub fill: Option<String>,
    /// Lengths of dashes and gaps.
    pub dashes: Vec<f64>,
    /// Of the colour inside.
    pub fill_opacity: Option<&'static str>,
}

impl Style {
    /// A line without an inside.
    fn line(stroke: &str, width: f64) -> Self {
        Self {
            stroke: stroke.to_owned(),
            width,
            fill: None,
            dashes: Vec::new(),
            fill_opacity: None,
        }
    }

    /// That of a pen of a file.
    pub fn of(pen: &Pen) -> Self {
        let width = pen.width.max(1.0);
        let stroke = match &*pen.style {
            "none" => "none".to_owned(),
            _ => colour(&pen.colour, "#000000"),
        };
        let dashes: &[f64] = match &*pen.style {
            "dot" => &[1.0, 2.0],
            "dash" => &[4.0, 2.0],
            "dashdot" => &[4.0, 2.0, 1.0, 2.0],
            "dashdotdot" => &[4.0, 2.0, 1.0, 2.0, 1.0, 2.0],
            _ => &[],
        };
        let fill = match &*pen.fill_style {
            "solid" => colour(&pen.fill, "#000000"),
            _ => "none".to_owned(),
        };
        Self {
            fill: Some(fill),
            dashes: dashes.iter().map(|length| length * width).collect(),
            ..Self::line(&stroke, width)
        }
    }

    /// The border of a region and what it is filled with.
    pub fn region(region: &Region, ink: &str) -> Self {
        Self {
            fill: Some(ink.to_owned()),
            dashes: vec![6.0, 4.0],
            fill_opacity: Some(if region.filled { "0.18" } else { "0" }),
            ..Self::line(ink, 1.5)
        }
    }

    fn put<'a>(&self, tag: Tag<'a>) -> Tag<'a> {
        let mut tag = tag
            .with("stroke", &self.stroke)
            .numbers(1, [("stroke-width", self.width)]);
        if !self.dashes.is_empty() {
            let lengths = self.dashes.iter().map(|length| format!("{length:.1}"));
            tag = tag.with("stroke-dasharray", lengths.collect::<Vec<_>>().join(" "));
        }
        if let Some(fill) = &self.fill {
            tag = tag.with("fill", fill);
        }
        match self.fill_opacity {
            Some(opacity) => tag.with("fill-opacity", opacity),
            None => tag,
        }
    }
}

fn line(begin: Point, end: Point, style: &Style, svg: &mut Svg) {
    if is_near(begin) && is_near(end) {
        let tag = svg
            .tag("line")
            .numbers(1, [("x1", begin.x), ("y1", begin.y)])
            .numbers(1, [("x2", end.x), ("y2", end.y)]);
        style.put(tag).close();
    }
}

fn drawn(drawn: &Drawn, svg: &mut Svg) {
    if !points(&drawn.shape).all(is_near) {
        return;
    }
    let style = Style::of(&drawn.pen);
    let corners = |a: &Point, b: &Point| {
        upright(
            *a,
            Point {
                x: b.x - a.x,
                y: b.y - a.y,
            },
        )
    };
    let at = |point: &Point| (point.x, point.y);
    match &drawn.shape {
        Shape::Line(a, b) => line(*a, *b, &style, svg),
        Shape::Rectangle(a, b) => style.put(rect(corners(a, b), svg)).close(),
        Shape::Ellipse(a, b) => ellipse(corners(a, b), &style, svg),
        Shape::Curve(a, b, c, d) => {
            let steps = [('M', at(a)), ('C', at(b)), (' ', at(c)), (' ', at(d))];
            style.put(svg.tag("path").path(1, steps)).close();
        }
        Shape::Stylus(strokes) => {
            let steps = strokes
                .iter()
                .flat_map(|stroke| [('M', at(&stroke.begin)), ('L', at(&stroke.end))]);
            style.put(svg.tag("path").path(1, steps)).close();
        }
    }
}

fn ellipse([x, y, width, height]: [f64; 4], style: &Style, svg: &mut Svg) {
    let (a, b) = (width / 2.0, height / 2.0);
    let tag = svg
        .tag("ellipse")
        .numbers(1, [("cx", x + a), ("cy", y + b), ("rx", a), ("ry", b)]);
    style.put(tag).close();
}

fn region(region: &Region, letters: f64, svg: &mut Svg) {
    if !is_near(region.at) || !is_near(region.size) {
        return;
    }
    let place = upright(region.at, region.size);
    let ink = colour(&region.colour, "#87cefa");
    let style = Style::region(region, &ink);
    match &*region.kind {
        "ellipse" => ellipse(place, &style, svg),
        "rectangle" => style.put(rect(place, svg)).close(),
        _ => return,
    }
    if !region.text.is_empty() && is_near(region.text_at) {
        let text: String = region.text.chars().take(200).collect();
        // Below the upper border, where the file puts the corner of the text; y is the foot of the letters.
        let (x, y) = (
            place[0] + region.text_at.x + 0.3 * letters,
            place[1] + region.text_at.y + 1.1 * letters,
        );
        svg.tag("text")
            .numbers(1, [("x", x), ("y", y)])
            .with("fill", "#455a64")
            .text(text);
    }
}

fn solid(solid: &Solid, svg: &mut Svg) {
    if !is_near(solid.at) {
        return;
    }
    let Point { x, y } = solid.at;
    let half = solid.size / 2.0;
    let ink = ink(solid.kind);
    let tag = match solid.kind {
        SolidKind::Cube => {
            let turn = format_args!("rotate({:.1} {x:.1} {y:.1})", solid.rotation);
            rect([x - half, y - half, solid.size, solid.size], svg).with("transform", turn)
        }
        SolidKind::Skittle | SolidKind::Ball => svg
            .tag("circle")
            .numbers(1, [("cx", x), ("cy", y), ("r", half)]),
    };
    tag.style(&[("fill", ink), ("stroke", "#37474f")]).close();
}
