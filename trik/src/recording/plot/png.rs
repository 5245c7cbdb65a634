//! Panels of a plot as pixels, for what shows no SVG.
//!
//! Owns how they look: the places and colours of the SVG, twice as large, with letters of fixed width. Texts need no font of
//! the machine. The most panels are a picture of 19 million pixels.

use super::{Line, MARK, panel, size};
use crate::chart::{Panel, short, ticks};
use screen::Pixels;
use screen::colour::{BLACK, Colour, WHITE, colour};
use screen::drawing::{Label, Outline, Shape};
use screen::{letters, paint};

/// Pixels for each px of the SVG.
const SCALE: f64 = 2.0;
/// Height and width of a letter.
const LETTER: u16 = 20;
const LETTER_WIDTH: f64 = 10.0;
const GRID: Colour = colour(0xe8, 0xe8, 0xe8);
const FRAME: Colour = colour(0x80, 0x80, 0x80);
const LINE: Colour = colour(0x00, 0x57, 0xb8);
const FAULT: Colour = colour(0xc0, 0x39, 0x2b);

/// Which edge of a text is at its place.
#[derive(Clone, Copy)]
enum Anchor {
    Begin,
    Middle,
    End,
}

/// The picture as a file.
pub(super) fn picture(lines: &[Line], across: (f64, f64)) -> Vec<u8> {
    let (width, height) = size(lines.len());
    let mut sheet = Canvas(Pixels::new(side(width), side(height), Some(WHITE)));
    for (at, line) in lines.iter().enumerate() {
        let points = line.points(across.1);
        let panel = panel(at, &points, across);
        let is_last = at + 1 == lines.len();
        sheet.frame(&panel, if is_last { "t, s" } else { "" }, &line.title);
        let places = points.iter().map(|(x, y)| {
            let is_number = x.is_finite() && y.is_finite();
            is_number.then(|| panel.point(*x, *y))
        });
        let places: Vec<Option<(f64, f64)>> = places.collect();
        for pair in places.windows(2) {
            if let &[Some(from), Some(to)] = pair {
                sheet.line(from, to, LINE, 3);
            }
        }
        let low = panel.top + panel.size.1;
        for fault in &line.faults {
            let (at, _) = panel.point(*fault, 0.0);
            sheet.line((at, low), (at, low - MARK), FAULT, 4);
        }
    }
    sheet.0.to_png()
}

/// Pixels of a side.
fn side(px: f64) -> u16 {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is positive, and a cast stays within the type"
    )]
    let side = (px * SCALE).ceil() as u16;
    side
}

/// The pixel of a place.
fn pixel((x, y): (f64, f64)) -> [i32; 2] {
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a cast stays within the type"
    )]
    let pixel = [x, y].map(|one| (one * SCALE).round() as i32);
    pixel
}

struct Canvas(Pixels);

impl Canvas {
    fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: Colour, width: u16) {
        let ([x1, y1], [x2, y2]) = (pixel(from), pixel(to));
        let line = Shape {
            outline: Outline::Line([x1, y1, x2, y2]),
            is_filled: false,
            colour,
            width,
        };
        paint::shape(&mut self.0, &line);
    }

    /// A text whose lower edge is a little below its place, as in the SVG.
    fn text(&mut self, (x, y): (f64, f64), anchor: Anchor, text: &str) {
        let count = u32::try_from(text.chars().count()).unwrap_or(0);
        let width = f64::from(count) * LETTER_WIDTH / SCALE;
        let left = match anchor {
            Anchor::Begin => x,
            Anchor::Middle => x - width / 2.0,
            Anchor::End => x - width,
        };
        let [left, top] = pixel((left.max(0.0), y - 8.0));
        let label = Label {
            text: text.to_owned(),
            height: LETTER,
            colour: BLACK,
        };
        letters::paint(&mut self.0, &label, left, top);
    }

    fn frame(&mut self, panel: &Panel, across: &str, upwards: &str) {
        let (left, top, (width, height)) = (panel.left, panel.top, panel.size);
        let (right, low) = (left + width, top + height);
        for x in ticks(panel.across) {
            let (at, _) = panel.point(x, 0.0);
            self.line((at, top), (at, low), GRID, 2);
            self.text((at, low + 14.0), Anchor::Middle, &short(x));
        }
        for y in ticks(panel.upwards) {
            let (_, at) = panel.point(0.0, y);
            self.line((left, at), (right, at), GRID, 2);
            self.text((left - 5.0, at + 4.0), Anchor::End, &short(y));
        }
        let corners = [(left, top), (right, top), (right, low), (left, low)];
        for (at, from) in corners.iter().enumerate() {
            self.line(*from, corners[(at + 1) % 4], FRAME, 2);
        }
        self.text((left, top - 7.0), Anchor::Begin, upwards);
        self.text((right, low + 28.0), Anchor::End, across);
    }
}
