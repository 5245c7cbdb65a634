//! A field as shapes of SVG, and how far it reaches.
//!
//! Owns how each kind of thing looks. What is too far away for a picture is left out.

use super::is_near;
use crate::field::{Blob, Drawn, Field, Pen, Region, Shape, Solid, SolidKind};
use crate::geometry::Point;
use crate::limits;
use lang_text::escape::escaped;
use std::fmt::Write as _;

/// A rectangle around points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bounds(Option<[f64; 4]>);

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
pub(super) fn colour(text: &str, other: &str) -> String {
    let digits = text.strip_prefix('#').unwrap_or("");
    let are_hex = digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    match digits.len() {
        8 if are_hex => format!("#{}{}", &digits[2..], &digits[..2]),
        3 | 6 if are_hex => text.to_owned(),
        _ if !text.is_empty()
            && text.len() < 24
            && text.bytes().all(|letter| letter.is_ascii_alphabetic()) =>
        {
            text.to_owned()
        }
        _ => other.to_owned(),
    }
}

/// How far a field reaches.
pub(super) fn bounds(field: &Field, bounds: &mut Bounds) {
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
fn upright(at: Point, size: Point) -> [f64; 4] {
    let left = at.x.min(at.x + size.x);
    let top = at.y.min(at.y + size.y);
    [left, top, size.x.abs(), size.y.abs()]
}

/// Everything of a field, lowest first.
pub(super) fn field(field: &Field, out: &mut String) {
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
            let [x, y, width, height] = upright(image.at, image.size);
            let _ = writeln!(
                out,
                "<image x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
                 preserveAspectRatio=\"none\" href=\"{source}\"/>"
            );
        }
    }
    for one in &field.drawn {
        drawn(one, out);
    }
    for stroke in &field.trace {
        let ink = colour(&stroke.colour, "#000000");
        line(
            stroke.begin,
            stroke.end,
            &format!("stroke=\"{ink}\" stroke-width=\"{:.1}\"", stroke.width),
            out,
        );
    }
    for one in field.regions.iter().filter(|region| region.visible) {
        region(one, out);
    }
    for wall in &field.walls {
        let style = format!("stroke=\"#6d4c41\" stroke-width=\"{:.1}\"", wall.width);
        line(wall.begin, wall.end, &style, out);
    }
    for one in &field.solids {
        solid(one, out);
    }
}

/// A picture as an address that holds it.
fn data(blob: &Blob) -> Option<String> {
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

fn line(begin: Point, end: Point, style: &str, out: &mut String) {
    if is_near(begin) && is_near(end) {
        let _ = writeln!(
            out,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" {style}/>",
            begin.x, begin.y, end.x, end.y
        );
    }
}

fn style(pen: &Pen) -> String {
    let width = pen.width.max(1.0);
    let stroke = match &*pen.style {
        "none" => "none".to_owned(),
        _ => colour(&pen.colour, "#000000"),
    };
    let dashes = match &*pen.style {
        "dot" => "1 2",
        "dash" => "4 2",
        "dashdot" => "4 2 1 2",
        "dashdotdot" => "4 2 1 2 1 2",
        _ => "",
    };
    let fill = match &*pen.fill_style {
        "solid" => colour(&pen.fill, "none"),
        _ => "none".to_owned(),
    };
    let mut style = format!("stroke=\"{stroke}\" stroke-width=\"{width:.1}\" fill=\"{fill}\"");
    if !dashes.is_empty() {
        let lengths: Vec<String> = dashes
            .split(' ')
            .filter_map(|length| length.parse::<f64>().ok())
            .map(|length| format!("{:.1}", length * width))
            .collect();
        let _ = write!(style, " stroke-dasharray=\"{}\"", lengths.join(" "));
    }
    style
}

fn drawn(drawn: &Drawn, out: &mut String) {
    if !points(&drawn.shape).all(is_near) {
        return;
    }
    let style = style(&drawn.pen);
    let corners = |a: &Point, b: &Point| {
        upright(
            *a,
            Point {
                x: b.x - a.x,
                y: b.y - a.y,
            },
        )
    };
    match &drawn.shape {
        Shape::Line(a, b) => line(*a, *b, &style, out),
        Shape::Rectangle(a, b) => {
            let [x, y, width, height] = corners(a, b);
            let _ = writeln!(
                out,
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" {style}/>"
            );
        }
        Shape::Ellipse(a, b) => ellipse(corners(a, b), &style, out),
        Shape::Curve(a, b, c, d) => {
            let _ = writeln!(
                out,
                "<path d=\"M{:.1} {:.1} C{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}\" {style}/>",
                a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y
            );
        }
        Shape::Stylus(strokes) => {
            out.push_str("<path d=\"");
            for stroke in strokes {
                let _ = write!(
                    out,
                    "M{:.1} {:.1}L{:.1} {:.1}",
                    stroke.begin.x, stroke.begin.y, stroke.end.x, stroke.end.y
                );
            }
            let _ = writeln!(out, "\" {style}/>");
        }
    }
}

fn ellipse([x, y, width, height]: [f64; 4], style: &str, out: &mut String) {
    let (a, b) = (width / 2.0, height / 2.0);
    let _ = writeln!(
        out,
        "<ellipse cx=\"{:.1}\" cy=\"{:.1}\" rx=\"{a:.1}\" ry=\"{b:.1}\" {style}/>",
        x + a,
        y + b
    );
}

fn region(region: &Region, out: &mut String) {
    if !is_near(region.at) || !is_near(region.size) {
        return;
    }
    let [x, y, width, height] = upright(region.at, region.size);
    let ink = colour(&region.colour, "#87cefa");
    let fill = if region.filled { "0.18" } else { "0" };
    let style = format!(
        "stroke=\"{ink}\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\" fill=\"{ink}\" fill-opacity=\"{fill}\""
    );
    match &*region.kind {
        "ellipse" => ellipse([x, y, width, height], &style, out),
        "rectangle" => {
            let _ = writeln!(
                out,
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" {style}/>"
            );
        }
        _ => return,
    }
    if !region.text.is_empty() && is_near(region.text_at) {
        let text: String = region.text.chars().take(200).collect();
        let _ = writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"#455a64\">{}</text>",
            region.at.x + region.text_at.x,
            region.at.y + region.text_at.y,
            escaped(&text)
        );
    }
}

fn solid(solid: &Solid, out: &mut String) {
    if !is_near(solid.at) {
        return;
    }
    let Point { x, y } = solid.at;
    let half = solid.size / 2.0;
    let ink = match solid.kind {
        SolidKind::Skittle => "#ef6c00",
        SolidKind::Ball => "#fdd835",
        SolidKind::Cube => "#78909c",
    };
    let _ = match solid.kind {
        SolidKind::Cube => writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" \
             transform=\"rotate({:.1} {x:.1} {y:.1})\" fill=\"{ink}\" stroke=\"#37474f\"/>",
            x - half,
            y - half,
            solid.size,
            solid.size,
            solid.rotation
        ),
        SolidKind::Skittle | SolidKind::Ball => writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{half:.1}\" fill=\"{ink}\" stroke=\"#37474f\"/>"
        ),
    };
}
