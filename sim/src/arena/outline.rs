//! Closed figures with straight sides, and whether two sets of them meet.
//!
//! Owns the geometry of contact as the original's painter paths have it: sides that touch meet, a point is inside when it
//! is inside an odd number of figures, round figures are polylines of its density. Knows no world.

use crate::geometry::{Point, point};

/// A rectangle along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: Point,
    /// Largest coordinates.
    pub high: Point,
}

impl Bounds {
    /// Around nothing.
    pub const NOTHING: Self = Self {
        low: point(f64::INFINITY, f64::INFINITY),
        high: point(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// Around points.
    pub fn of(points: &[Point]) -> Self {
        points.iter().fold(Self::NOTHING, |all, &one| all.with(one))
    }

    /// Around a point too.
    #[must_use]
    pub fn with(self, other: Point) -> Self {
        Self {
            low: point(lower(other.x, self.low.x), lower(other.y, self.low.y)),
            high: point(higher(other.x, self.high.x), higher(other.y, self.high.y)),
        }
    }

    /// Around another one too.
    #[must_use]
    pub fn joined(self, other: Self) -> Self {
        self.with(other.low).with(other.high)
    }

    /// Whether both have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }
}

/// The lower of two, and the second if they cannot be compared: one instruction, where `f64::min`, which need not know
/// which of them is no number, takes five. Each tick of a judge asks for those of all corners of a robot.
fn lower(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

/// The same for the higher.
fn higher(one: f64, other: f64) -> f64 {
    if one > other { one } else { other }
}

/// Closed figures, their corners in one list.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    points: Vec<Point>,
    /// Of each figure: where its corners begin and end, and what is around them.
    figures: Vec<(u32, u32, Bounds)>,
    /// Room for callers that make figures.
    pub(super) spare: Vec<Point>,
}

impl Outline {
    /// Nothing, with the room that it had.
    pub fn clear(&mut self) {
        self.points.clear();
        self.figures.clear();
    }

    /// One figure more.
    pub fn add(&mut self, corners: impl IntoIterator<Item = Point>) {
        let begin = self.points.len();
        self.points.extend(corners);
        let bounds = Bounds::of(&self.points[begin..]);
        self.figures
            .push((begin as u32, self.points.len() as u32, bounds));
    }

    /// A circle as the original makes it: four curves, each a polyline.
    pub fn add_circle(&mut self, centre: Point, radius: f64) {
        let begin = self.points.len();
        let parts = parts_of(radius, radius);
        for quarter in 0..4 {
            for part in 0..parts {
                let (across, along) = quarter_at(f64::from(part) / f64::from(parts));
                let (x, y) = match quarter {
                    0 => (across, along),
                    1 => (-along, across),
                    2 => (-across, -along),
                    _ => (along, -across),
                };
                self.points
                    .push(point(centre.x + radius * x, centre.y + radius * y));
            }
        }
        let bounds = Bounds::of(&self.points[begin..]);
        self.figures
            .push((begin as u32, self.points.len() as u32, bounds));
    }

    /// How many figures there are.
    pub fn len(&self) -> usize {
        self.figures.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.figures.is_empty()
    }

    /// Corners of a figure.
    pub fn corners(&self, figure: usize) -> &[Point] {
        let (begin, end, _) = self.figures[figure];
        &self.points[begin as usize..end as usize]
    }

    /// What is around a figure.
    pub fn bounds_of(&self, figure: usize) -> Bounds {
        self.figures[figure].2
    }

    /// What is around all figures.
    pub fn bounds(&self) -> Bounds {
        self.figures
            .iter()
            .fold(Bounds::NOTHING, |all, (_, _, one)| all.joined(*one))
    }

    /// All figures by their corners.
    pub fn figures(&self) -> impl Iterator<Item = &[Point]> {
        (0..self.len()).map(|figure| self.corners(figure))
    }

    /// Whether a point is inside an odd number of figures.
    pub fn contains(&self, at: Point) -> bool {
        self.figures()
            .filter(|corners| is_inside(corners, at))
            .count()
            % 2
            == 1
    }

    /// Whether a side of a figure crosses or touches a side of any of these.
    pub fn is_crossed_by(&self, corners: &[Point], bounds: &Bounds) -> bool {
        self.figures.iter().any(|(begin, end, mine)| {
            mine.meets(bounds) && is_crossing(&self.points[*begin as usize..*end as usize], corners)
        })
    }
}

/// Whether a point is inside a closed figure.
pub fn is_inside(corners: &[Point], at: Point) -> bool {
    let mut is_in = false;
    for (from, to) in sides(corners) {
        if (from.y > at.y) != (to.y > at.y) {
            let x = from.x + (at.y - from.y) / (to.y - from.y) * (to.x - from.x);
            if at.x < x {
                is_in = !is_in;
            }
        }
    }
    is_in
}

/// The sides of a closed figure.
pub fn sides(corners: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    let last = corners.last().copied();
    last.into_iter()
        .chain(corners.iter().copied())
        .zip(corners.iter().copied())
}

fn is_crossing(first: &[Point], second: &[Point]) -> bool {
    sides(first).any(|one| {
        let around = Bounds::of(&[one.0, one.1]);
        sides(second)
            .any(|other| around.meets(&Bounds::of(&[other.0, other.1])) && are_crossing(one, other))
    })
}

/// Nearer to 0 than this is 0.
const NOTHING: f64 = 1e-12;

fn is_same(one: Point, other: Point) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() * 1e12 <= a.abs().min(b.abs()) || a == b;
    near(one.x, other.x) && near(one.y, other.y)
}

/// Whether two straight lines have a point in common; one that is only a point has none.
fn are_crossing(p: (Point, Point), q: (Point, Point)) -> bool {
    if is_same(p.0, p.1) || is_same(q.0, q.1) {
        return false;
    }
    let begins = is_same(p.0, q.0);
    let ends = is_same(p.1, q.1);
    let crossed = (is_same(p.0, q.1), is_same(p.1, q.0));
    if begins && ends || crossed == (true, true) {
        return true;
    }
    let along_p = p.1.from(p.0);
    let along_q = q.1.from(q.0);
    let between = q.0.from(p.0);
    let cross = along_p.cross(along_q);
    if cross.abs() <= NOTHING {
        let normal = point(-along_p.y, along_p.x);
        if normal.dot(between).abs() > NOTHING {
            return false;
        }
        let within = |t: f64, whole: f64| t > 0.0 && t < whole;
        let whole_p = along_p.dot(along_p);
        let whole_q = along_q.dot(along_q);
        return within(along_p.dot(between), whole_p)
            || within(along_p.dot(q.1.from(p.0)), whole_p)
            || within(along_q.dot(p.0.from(q.0)), whole_q)
            || within(along_q.dot(p.1.from(q.0)), whole_q);
    }
    let on_p = between.cross(along_q) / cross;
    let on_q = between.cross(along_p) / cross;
    (0.0..=1.0).contains(&on_p) && (0.0..=1.0).contains(&on_q)
}

/// How far the control points of a quarter of a circle are from its ends, by the original's account.
pub(super) const KAPPA: f64 = 0.552_284_749_8;

/// The point of a quarter of the unit circle, from (1, 0) to (0, 1), as the cubic curve has it.
pub(super) fn quarter_at(t: f64) -> (f64, f64) {
    let at = |t: f64| {
        let rest = 1.0 - t;
        rest * rest * rest + 3.0 * rest * rest * t + 3.0 * rest * t * t * KAPPA
    };
    (at(t), at(1.0 - t))
}

/// Which way that curve goes there, by its parameter.
pub(super) fn quarter_slope(t: f64) -> (f64, f64) {
    let slope = |t: f64| ((6.0 - 9.0 * KAPPA) * t + 6.0 * (KAPPA - 1.0)) * t;
    (slope(t), -slope(1.0 - t))
}

/// Points of a curve in each pixel around it: a third of pi, as the original has it.
const PARTS_IN_PIXEL: f64 = 314.0 / 300.0;

/// How many straight parts a curve is drawn with, by the width and height around it.
pub(super) fn parts_of(width: f64, height: f64) -> u32 {
    let points = (width.max(height) * PARTS_IN_PIXEL) as f32;
    (points.min(64.0) as u32).max(3) - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Outline {
        let mut outline = Outline::default();
        outline.add([
            point(x, y),
            point(x + side, y),
            point(x + side, y + side),
            point(x, y + side),
        ]);
        outline
    }

    fn crosses(one: &Outline, other: &Outline) -> bool {
        one.is_crossed_by(other.corners(0), &other.bounds_of(0))
    }

    #[test]
    fn figures_that_touch_cross_and_figures_inside_do_not() {
        let one = square(0.0, 0.0, 10.0);
        assert!(crosses(&one, &square(5.0, 5.0, 10.0)));
        assert!(crosses(&one, &square(10.0, 0.0, 10.0)));
        assert!(!crosses(&one, &square(10.001, 0.0, 10.0)));
        assert!(!crosses(&one, &square(2.0, 2.0, 3.0)));
        assert!(one.contains(point(2.0, 2.0)));
        assert!(!one.contains(point(12.0, 2.0)));
    }

    #[test]
    fn two_figures_over_each_other_are_a_hole() {
        let mut one = square(0.0, 0.0, 10.0);
        one.add(square(2.0, 2.0, 4.0).corners(0).to_vec());
        assert!(one.contains(point(1.0, 1.0)));
        assert!(!one.contains(point(3.0, 3.0)));
    }

    #[test]
    fn a_circle_is_as_round_as_the_curves_are() {
        let mut circle = Outline::default();
        circle.add_circle(point(100.0, 50.0), 8.0);
        // 8 px across a quarter give 8 points, so 7 parts.
        assert_eq!(circle.corners(0).len(), 28);
        for corner in circle.corners(0) {
            let radius = corner.from(point(100.0, 50.0)).length();
            assert!((radius - 8.0).abs() < 8.0 * 0.0003, "{radius}");
        }
    }
}
