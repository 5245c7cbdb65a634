//! Figures to outlines: lines with pens, and filled insides.
//!
//! Owns what a pen of the original does: square ends and cut corners where nothing else is said, dashes in widths of the
//! pen, a pen without width as a line of one pixel. Knows neither colours nor the field.

use usvg::tiny_skia_path as skia;

use super::raster::{Coverage, Grid, Rule};
use super::stroke::{self, Spot, Step};
use crate::geometry::{Point, point};
use crate::limits;

/// Control points of a quarter of an ellipse are so far from its ends, in its half axes.
const QUARTER: f32 = 0.552_284_8;
/// How finely dashes are measured, in parts of a pixel.
const FINE: f32 = 8.0;

/// How the ends of lines look.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Cap {
    /// Half the width beyond the end, with corners.
    Square,
    /// Half the width beyond the end, round.
    Round,
    /// No further than the line.
    Flat,
}

/// A pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nib<'a> {
    /// Across, in pixels; 0 is as thin as a pixel.
    pub width: f64,
    /// `solid`, `dot`, `dash`, `dashdot`, `dashdotdot` or `none`; anything else is solid.
    pub style: &'a str,
    /// Its ends.
    pub cap: Cap,
}

/// A closed outline in pixels of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    steps: Vec<Step>,
    rule: Rule,
    grid: Grid,
    bounds: Bounds,
}

/// A rectangle around something: left, top, right, bottom.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds(pub [f64; 4]);

impl Bounds {
    /// Around nothing.
    pub const NOTHING: Self = Self([
        f64::INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NEG_INFINITY,
    ]);

    /// Grows around a point.
    pub fn add(&mut self, x: f64, y: f64) {
        let [left, top, right, bottom] = &mut self.0;
        (*left, *top) = (left.min(x), top.min(y));
        (*right, *bottom) = (right.max(x), bottom.max(y));
    }

    /// Whether both share a point.
    pub fn meets(&self, other: &Self) -> bool {
        let ([l, t, r, b], [left, top, right, bottom]) = (self.0, other.0);
        l <= right && left <= r && t <= bottom && top <= b
    }
}

/// From the coordinates of a picture to those of the scene: `x = a * x + c * y + e`, `y = b * x + d * y + f`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine(pub [f64; 6]);

impl Affine {
    /// Nothing changes.
    pub const SAME: Self = Self([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);

    /// A point where it goes.
    pub fn apply(&self, x: f64, y: f64) -> (f64, f64) {
        let [a, b, c, d, e, f] = self.0;
        (a * x + c * y + e, b * x + d * y + f)
    }

    /// First `self`, then `other`.
    pub fn then(&self, other: &Self) -> Self {
        let [a, b, c, d, e, f] = self.0;
        let [oa, ob, oc, od, ..] = other.0;
        let (x, y) = other.apply(e, f);
        Self([
            oa * a + oc * b,
            ob * a + od * b,
            oa * c + oc * d,
            ob * c + od * d,
            x,
            y,
        ])
    }

    /// The way back, if there is one.
    pub fn inverse(&self) -> Option<Self> {
        let [a, b, c, d, e, f] = self.0;
        let area = a * d - b * c;
        if !area.is_normal() {
            return None;
        }
        let back = Self([d / area, -b / area, -c / area, a / area, 0.0, 0.0]);
        let (x, y) = back.apply(e, f);
        let [a, b, c, d, ..] = back.0;
        let back = [a, b, c, d, -x, -y];
        back.iter()
            .all(|part| part.is_finite())
            .then_some(Self(back))
    }

    /// Around how many times it enlarges.
    pub fn scale(&self) -> f64 {
        let [a, b, c, d, ..] = self.0;
        (a * d - b * c).abs().sqrt()
    }
}

impl Outline {
    /// The inside of a path; nothing if it has none or too many corners.
    pub fn inside(path: &skia::Path, place: &Affine, rule: Rule) -> Option<Self> {
        Self::of(stroke::steps(path), place, rule)
    }

    fn of(mut steps: Vec<Step>, place: &Affine, rule: Rule) -> Option<Self> {
        if steps.is_empty() || steps.len() > limits::OUTLINE_STEPS {
            return None;
        }
        let mut bounds = Bounds::NOTHING;
        let mut is_finite = true;
        let mut put = |spot: &mut Spot| {
            *spot = place.apply(spot.0, spot.1);
            is_finite &= spot.0.is_finite() && spot.1.is_finite();
            bounds.add(spot.0, spot.1);
        };
        for step in &mut steps {
            match step {
                Step::Move(to) | Step::Line(to) => put(to),
                Step::Curve(spots) => spots.iter_mut().for_each(&mut put),
            }
        }
        is_finite.then_some(Self {
            steps,
            rule,
            grid: Grid::Path,
            bounds,
        })
    }

    /// A straight bar around a line, as the original's painter makes it of lines and of insides of rectangles; nothing if it
    /// has no length, no width or is far away. With a square cap it is longer by half its width at each end.
    pub fn bar(begin: Point, end: Point, width: f64, cap: Cap) -> Option<Self> {
        let (x, y) = (end.x - begin.x, end.y - begin.y);
        let length = libm::hypot(x, y);
        short(length)?;
        if length <= 0.0 || width <= 0.0 || width.is_nan() {
            return None;
        }
        let (along, across) = (width / 2.0 * x / length, width / 2.0 * y / length);
        let more = if cap == Cap::Square { 1.0 } else { 0.0 };
        let (ahead, up) = (along * more, across * more);
        let steps = vec![
            Step::Move((begin.x - ahead + across, begin.y - up - along)),
            Step::Line((end.x + ahead + across, end.y + up - along)),
            Step::Line((end.x + ahead - across, end.y + up + along)),
            Step::Line((begin.x - ahead - across, begin.y - up + along)),
        ];
        let mut bar = Self::of(steps, &Affine::SAME, Rule::NonZero)?;
        bar.grid = Grid::Bar;
        Some(bar)
    }

    /// What a pen leaves that goes along a path; nothing if it leaves nothing. `dashes` are lengths of dashes and gaps in
    /// turn.
    pub fn along(
        path: &skia::Path,
        place: &Affine,
        stroke: &skia::Stroke,
        dashes: &[f32],
    ) -> Option<Self> {
        let fine = FINE * (place.scale() as f32).clamp(1e-3, 1e3);
        let mut steps = stroke::steps(path);
        // A line of very many dashes is as good as a whole one.
        if let Some(dash) = stroke.dash.as_ref().filter(|_| {
            let every: f64 = dashes.iter().copied().map(f64::from).sum();
            stroke::length(&steps) < limits::DASHES * every
        }) {
            steps = stroke::steps(&path.dash(dash, fine)?);
        }
        Self::of(stroke::stroked(&steps, stroke), place, Rule::NonZero)
    }

    /// What a pen of the original leaves along a path.
    pub fn drawn(path: &skia::Path, nib: Nib<'_>) -> Option<Self> {
        if nib.style == "none" {
            return None;
        }
        let width = pen_width(nib.width) as f32;
        let dashes = pattern(nib.style);
        let lengths: Vec<f32> = dashes.iter().map(|length| length * width).collect();
        let stroke = skia::Stroke {
            width,
            line_cap: match nib.cap {
                Cap::Square => skia::LineCap::Square,
                Cap::Round => skia::LineCap::Round,
                Cap::Flat => skia::LineCap::Butt,
            },
            line_join: skia::LineJoin::Bevel,
            dash: skia::StrokeDash::new(lengths.clone(), 0.0),
            ..skia::Stroke::default()
        };
        Self::along(path, &Affine::SAME, &stroke, &lengths)
    }

    /// How many lines and curves it has.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// The rectangle around it.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// How it goes around itself.
    pub fn rule(&self) -> Rule {
        self.rule
    }

    /// Which of both rasterisers of the original draws it.
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Its edges into a window whose corner is at (`left`, `top`), `ratio` times as large as the scene.
    pub fn cover(&self, coverage: &mut Coverage, left: f64, top: f64, ratio: f64) {
        let grid = self.grid;
        let put = |spot: Spot| {
            (
                grid.place((spot.0 - left) * ratio),
                grid.place((spot.1 - top) * ratio),
            )
        };
        let (mut begin, mut here) = ((0, 0), (0, 0));
        for step in &self.steps {
            match *step {
                Step::Move(to) => {
                    coverage.edge(here, begin);
                    (begin, here) = (put(to), put(to));
                }
                Step::Line(to) => {
                    let to = put(to);
                    coverage.edge(here, to);
                    here = to;
                }
                Step::Curve(spots) => {
                    let [one, other, to] = spots.map(put);
                    coverage.curve([here, one, other, to]);
                    here = to;
                }
            }
        }
        coverage.edge(here, begin);
    }
}

/// How wide a pen is.
pub fn pen_width(width: f64) -> f64 {
    if width > 0.0 { width } else { 1.0 }
}

/// Dashes and gaps of a style in turn, in widths of the pen; none for a whole line.
fn pattern(style: &str) -> &'static [f32] {
    match style {
        "dot" => &[1.0, 2.0],
        "dash" => &[4.0, 2.0],
        "dashdot" => &[4.0, 2.0, 1.0, 2.0],
        "dashdotdot" => &[4.0, 2.0, 1.0, 2.0, 1.0, 2.0],
        _ => &[],
    }
}

/// The pieces that a pen of some width and style draws of a straight line; a line of very many is as good as a whole one.
pub fn dashes(begin: Point, end: Point, width: f64, style: &str) -> Vec<(Point, Point)> {
    if style == "none" {
        return Vec::new();
    }
    let width = pen_width(width);
    let pattern = pattern(style);
    let (x, y) = (end.x - begin.x, end.y - begin.y);
    let length = libm::hypot(x, y);
    let every: f64 = pattern.iter().map(|&part| f64::from(part) * width).sum();
    if every <= 0.0 || length.is_nan() || length >= limits::DASHES * every {
        return vec![(begin, end)];
    }
    let at = |far: f64| point(begin.x + x * far / length, begin.y + y * far / length);
    let (mut pieces, mut far) = (Vec::new(), 0.0);
    for (index, &part) in pattern.iter().enumerate().cycle() {
        if far >= length {
            break;
        }
        let to = (far + f64::from(part) * width).min(length);
        if index % 2 == 0 {
            pieces.push((at(far), at(to)));
        }
        far = to;
    }
    pieces
}

/// A number as paths hold it; nothing if it is none or far beyond every field.
fn short(number: f64) -> Option<f32> {
    let is_near = number.abs() <= limits::SCENE_EDGE;
    is_near.then_some(number as f32)
}

fn place(at: Point) -> Option<(f32, f32)> {
    Some((short(at.x)?, short(at.y)?))
}

/// A straight line.
pub fn line(begin: Point, end: Point) -> Option<skia::Path> {
    let ((x, y), (x_end, y_end)) = (place(begin)?, place(end)?);
    let mut path = skia::PathBuilder::new();
    path.move_to(x, y);
    path.line_to(x_end, y_end);
    path.finish()
}

/// A closed figure with straight sides.
pub fn polygon(corners: &[Point]) -> Option<skia::Path> {
    let mut path = skia::PathBuilder::new();
    for (index, &corner) in corners.iter().enumerate() {
        let (x, y) = place(corner)?;
        if index == 0 {
            path.move_to(x, y);
        } else {
            path.line_to(x, y);
        }
    }
    path.close();
    path.finish()
}

/// A cubic curve.
pub fn curve([begin, one, other, end]: [Point; 4]) -> Option<skia::Path> {
    let (begin, one, other, end) = (place(begin)?, place(one)?, place(other)?, place(end)?);
    let mut path = skia::PathBuilder::new();
    path.move_to(begin.0, begin.1);
    path.cubic_to(one.0, one.1, other.0, other.1, end.0, end.1);
    path.finish()
}

fn upright(one: Point, other: Point) -> Option<skia::Rect> {
    let ((x, y), (x_end, y_end)) = (place(one)?, place(other)?);
    skia::Rect::from_ltrb(x.min(x_end), y.min(y_end), x.max(x_end), y.max(y_end))
}

/// A rectangle by two opposite corners.
pub fn rectangle(one: Point, other: Point) -> Option<skia::Path> {
    Some(skia::PathBuilder::from_rect(upright(one, other)?))
}

/// The ellipse in such a rectangle, of four curves as the original's painter has it.
pub fn ellipse(one: Point, other: Point) -> Option<skia::Path> {
    let round = upright(one, other)?;
    let (x, y) = (
        f32::midpoint(round.left(), round.right()),
        f32::midpoint(round.top(), round.bottom()),
    );
    let (a, b) = (round.width() / 2.0, round.height() / 2.0);
    let (near_a, near_b) = (a * QUARTER, b * QUARTER);
    let mut path = skia::PathBuilder::new();
    path.move_to(x + a, y);
    path.cubic_to(x + a, y + near_b, x + near_a, y + b, x, y + b);
    path.cubic_to(x - near_a, y + b, x - a, y + near_b, x - a, y);
    path.cubic_to(x - a, y - near_b, x - near_a, y - b, x, y - b);
    path.cubic_to(x + near_a, y - b, x + a, y - near_b, x + a, y);
    path.close();
    path.finish()
}
