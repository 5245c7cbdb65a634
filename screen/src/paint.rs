//! From the list to pixels.
//!
//! Owns how wide lines and round things look: a line is as wide as the pen, and an outline lies half inside and half
//! outside of its place. Time is bounded: coordinates, pens and lists have limits, and only rows that are seen are
//! looked at.

use crate::colour::Colour;
use crate::drawing::{Drawing, Outline, Shape};
use crate::letters;
use crate::pixels::Pixels;

/// Degrees between two corners of the chain of lines that an arc becomes.
const ARC_STEP: i32 = 3;

impl Drawing {
    /// What is seen.
    pub fn paint(&self) -> Pixels {
        let (width, height) = self.size();
        let mut pixels = Pixels::new(width, height, Some(self.background()));
        if let Some(picture) = self.picture() {
            let middle = |all: u16, own: u16| i32::from(all.saturating_sub(own)) / 2;
            let (x, y) = (
                middle(width, picture.width()),
                middle(height, picture.height()),
            );
            pixels.put(picture, x, y);
        }
        if let Some(old) = self.old() {
            pixels.put(old, 0, 0);
        }
        for one in self.shapes() {
            shape(&mut pixels, one);
        }
        for ((x, y), label) in self.labels() {
            letters::paint(&mut pixels, label, x, y);
        }
        pixels
    }
}

/// Paints one shape.
pub fn shape(pixels: &mut Pixels, shape: &Shape) {
    let mut brush = Brush {
        pixels,
        colour: shape.colour,
        width: shape.width.into(),
    };
    match shape.outline {
        Outline::Line([x1, y1, x2, y2]) => brush.line([x1, y1], [x2, y2]),
        Outline::Point([x, y]) => {
            let (left, top) = (x - brush.width / 2, y - brush.width / 2);
            for row in 0..brush.width {
                brush.row(top + row, left, left + brush.width - 1);
            }
        }
        Outline::Rectangle(place) => brush.ring(place, shape.is_filled, |_, place| {
            Some((place[0], place[0] + place[2] - 1))
        }),
        Outline::Ellipse(place) => brush.ring(place, shape.is_filled, ellipse_row),
        Outline::Arc(place, from, span) => brush.arc(place, from, span),
    }
}

/// First and last column of an ellipse in a row.
fn ellipse_row(row: i32, [x, y, width, height]: [i32; 4]) -> Option<(i32, i32)> {
    let (half_width, half_height) = (f64::from(width) / 2.0, f64::from(height) / 2.0);
    // Rows and columns are looked at in their middle.
    let above = (f64::from(row - y) + 0.5 - half_height) / half_height;
    let beside = half_width * (1.0 - above * above).max(0.0).sqrt();
    let middle = f64::from(x) + half_width - 0.5;
    let (first, last) = ((middle - beside).ceil(), (middle + beside).floor());
    (first <= last).then_some((first as i32, last as i32))
}

/// A pen over pixels.
struct Brush<'a> {
    pixels: &'a mut Pixels,
    colour: Colour,
    width: i32,
}

impl Brush<'_> {
    fn row(&mut self, y: i32, from: i32, to: i32) {
        self.pixels.fill_row(y, from, to, self.colour);
    }

    /// Rows that are seen between two others, both among them.
    fn rows(&self, from: i32, to: i32) -> std::ops::RangeInclusive<i32> {
        from.max(0)..=to.min(i32::from(self.pixels.height()) - 1)
    }

    /// A closed outline, or all of its inside. `columns` says where a row of such a figure begins and ends.
    fn ring(
        &mut self,
        [x, y, width, height]: [i32; 4],
        is_filled: bool,
        columns: impl Fn(i32, [i32; 4]) -> Option<(i32, i32)>,
    ) {
        let (more, less) = (self.width / 2, self.width);
        let outer = [x - more, y - more, width + 2 * more, height + 2 * more];
        let inner = [
            outer[0] + less,
            outer[1] + less,
            outer[2] - 2 * less,
            outer[3] - 2 * less,
        ];
        let has_hole = !is_filled && inner[2] > 0 && inner[3] > 0;
        for row in self.rows(outer[1], outer[1] + outer[3] - 1) {
            let Some((first, last)) = columns(row, outer) else {
                continue;
            };
            let is_beside = has_hole && (inner[1]..inner[1] + inner[3]).contains(&row);
            match columns(row, inner).filter(|_| is_beside) {
                Some((hole_first, hole_last)) => {
                    self.row(row, first, hole_first - 1);
                    self.row(row, hole_last + 1, last);
                }
                None => self.row(row, first, last),
            }
        }
    }

    fn line(&mut self, from: [i32; 2], to: [i32; 2]) {
        if self.width > 1 {
            self.bar(from, to);
            return;
        }
        let (along, down) = (to[0] - from[0], to[1] - from[1]);
        let steps = along.abs().max(down.abs()).max(1);
        for step in 0..=steps {
            // Rounded to the nearest; the greatest product is within 32 bits, as coordinates are cut.
            let part = |way: i32| (2 * way * step + steps).div_euclid(2 * steps);
            self.pixels
                .set(from[0] + part(along), from[1] + part(down), self.colour);
        }
    }

    /// A wide line: the rectangle around it, row by row.
    fn bar(&mut self, from: [i32; 2], to: [i32; 2]) {
        let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(f64::from);
        let (along, down) = (x2 - x1, y2 - y1);
        let length = libm::hypot(along, down);
        let (along, down) = if length > 0.0 {
            (along / length, down / length)
        } else {
            (1.0, 0.0)
        };
        let half = f64::from(self.width) / 2.0;
        // Half a pixel beyond both ends, as a thin line has it, in coordinates of the middles of pixels.
        let (left, up) = (half * down, half * along);
        let even = if self.width % 2 == 0 { -0.5 } else { 0.0 };
        let (shift_x, shift_y) = (even * down.abs(), even * along.abs());
        let corner = |x: f64, y: f64, end: f64, side: f64| {
            (
                x + shift_x + end * along / 2.0 + side * left,
                y + shift_y + end * down / 2.0 - side * up,
            )
        };
        let corners = [
            corner(x1, y1, -1.0, 1.0),
            corner(x2, y2, 1.0, 1.0),
            corner(x2, y2, 1.0, -1.0),
            corner(x1, y1, -1.0, -1.0),
        ];
        let top = corners
            .iter()
            .map(|corner| corner.1)
            .fold(f64::INFINITY, f64::min);
        let bottom = corners
            .iter()
            .map(|corner| corner.1)
            .fold(f64::NEG_INFINITY, f64::max);
        for row in self.rows(top.ceil() as i32, bottom.floor() as i32) {
            let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
            for (index, &(x, y)) in corners.iter().enumerate() {
                let (next_x, next_y) = corners[(index + 1) % 4];
                let (low, high) = (y.min(next_y), y.max(next_y));
                let level = f64::from(row);
                if level < low || level > high {
                    continue;
                }
                for met in if high > low {
                    let met = x + (next_x - x) * (level - y) / (next_y - y);
                    [met, met]
                } else {
                    [x, next_x]
                } {
                    (first, last) = (first.min(met), last.max(met));
                }
            }
            // The right edge belongs to the next pixel, as the lower one does.
            self.row(row, first.ceil() as i32, last.ceil() as i32 - 1);
        }
    }

    fn arc(&mut self, [x, y, width, height]: [i32; 4], from: i32, span: i32) {
        let (half_width, half_height) = (f64::from(width) / 2.0, f64::from(height) / 2.0);
        let place = |degrees: i32| {
            let angle = f64::from(degrees).to_radians();
            let (up, right) = libm::sincos(angle);
            let (right, up) = (right * half_width, up * half_height);
            [
                (f64::from(x) + half_width + right).round() as i32,
                (f64::from(y) + half_height - up).round() as i32,
            ]
        };
        let steps = (span.abs() / ARC_STEP).max(1);
        let mut before = place(from);
        for step in 1..=steps {
            let next = place(from + span * step / steps);
            self.line(before, next);
            before = next;
        }
    }
}
