//! What a pen leaves along a path, as the original's painter makes it.
//!
//! Owns offsets of lines and curves, ends and corners. What is beside a curve is a few curves again, made from offsets of
//! control polygons: that is a little off a true offset, on purpose, because the original's is. Knows no colours and no
//! scene.

use usvg::tiny_skia_path as skia;

/// A point in any plane.
pub type Spot = (f64, f64);

/// One step of an outline. Each part of it begins with a move and is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A new part begins here.
    Move(Spot),
    /// Straight to a point.
    Line(Spot),
    /// Along a cubic curve: control points and end.
    Curve([Spot; 3]),
}

/// Control points of a quarter of a circle are so far from its ends, in radii.
const QUARTER: f64 = 0.552_284_749_8;
/// How often a curve is halved until what is beside it is near enough.
const SPLITS: u32 = 6;
/// How near at most: distances may be off by this part of half the pen, and squares of distances by this part of its
/// square. For wide pens it is one part in their width.
const NEAR: f64 = 0.25;
/// The same for pens of any width.
const LEAST_NEAR: f64 = 0.00025;

/// The steps of a path, quadratic curves as cubic ones. Parts that were not closed are not closed here either.
pub fn steps(path: &skia::Path) -> Vec<Step> {
    let spot = |point: skia::Point| (f64::from(point.x), f64::from(point.y));
    let mut steps = Vec::with_capacity(path.len());
    let (mut begin, mut here) = ((0.0, 0.0), (0.0, 0.0));
    for segment in path.segments() {
        match segment {
            skia::PathSegment::MoveTo(to) => {
                (begin, here) = (spot(to), spot(to));
                steps.push(Step::Move(here));
            }
            skia::PathSegment::LineTo(to) => {
                here = spot(to);
                steps.push(Step::Line(here));
            }
            skia::PathSegment::QuadTo(control, to) => {
                let (control, to) = (spot(control), spot(to));
                let toward = |end: Spot| {
                    let part = |end: f64, control: f64| end + (control - end) * 2.0 / 3.0;
                    (part(end.0, control.0), part(end.1, control.1))
                };
                steps.push(Step::Curve([toward(here), toward(to), to]));
                here = to;
            }
            skia::PathSegment::CubicTo(one, other, to) => {
                here = spot(to);
                steps.push(Step::Curve([spot(one), spot(other), here]));
            }
            skia::PathSegment::Close => {
                if here != begin {
                    steps.push(Step::Line(begin));
                    here = begin;
                }
            }
        }
    }
    steps
}

/// About how long steps are, and not less.
pub fn length(steps: &[Step]) -> f64 {
    let (mut sum, mut here) = (0.0, (0.0, 0.0));
    let mut go = |to: Spot, is_drawn: bool| {
        let (x, y): Spot = (to.0 - here.0, to.1 - here.1);
        if is_drawn {
            sum += libm::hypot(x, y);
        }
        here = to;
    };
    for step in steps {
        match *step {
            Step::Move(to) => go(to, false),
            Step::Line(to) => go(to, true),
            Step::Curve(spots) => spots.into_iter().for_each(|spot| go(spot, true)),
        }
    }
    sum
}

/// A line of two points, or a curve of four.
#[derive(Clone, Copy, Debug)]
struct Piece {
    points: [Spot; 4],
    is_curve: bool,
}

fn unit(from: Spot, to: Spot) -> Option<Spot> {
    let (x, y) = (to.0 - from.0, to.1 - from.1);
    let length = libm::hypot(x, y);
    (length > 0.0 && length.is_finite()).then(|| (x / length, y / length))
}

/// `far` to the left of a direction of length 1, where y points down.
fn beside(at: Spot, direction: Spot, far: f64) -> Spot {
    (at.0 + direction.1 * far, at.1 - direction.0 * far)
}

fn ahead(at: Spot, direction: Spot, far: f64) -> Spot {
    (at.0 + direction.0 * far, at.1 + direction.1 * far)
}

impl Piece {
    /// Directions at both ends; nothing if it has no length.
    fn directions(&self) -> Option<(Spot, Spot)> {
        let mut pairs = self.points.windows(2);
        let first = pairs.clone().find_map(|pair| unit(pair[0], pair[1]))?;
        let last = pairs.rfind(|pair| unit(pair[0], pair[1]).is_some())?;
        Some((first, unit(last[0], last[1])?))
    }

    fn reversed(mut self) -> Self {
        self.points.reverse();
        self
    }

    /// The same, `far` to the left.
    fn offset(&self, far: f64) -> [Spot; 4] {
        let mut moved = self.points;
        // Directions around each control point; equal neighbours have none between them.
        let direction = |index: usize| unit(self.points[index], self.points[index + 1]);
        for (index, spot) in moved.iter_mut().enumerate() {
            let before = (0..index).rev().find_map(direction);
            let after = (index..3).find_map(direction);
            let (Some(one), Some(other)) = (before.or(after), after.or(before)) else {
                continue;
            };
            let together = 1.0 + one.0 * other.0 + one.1 * other.1;
            *spot = if together.abs() < 1e-12 {
                beside(*spot, one, far)
            } else {
                beside(*spot, (one.0 + other.0, one.1 + other.1), far / together)
            };
        }
        moved
    }
}

/// A point of a curve, and the direction across it.
fn at(points: &[Spot; 4], t: f64) -> (Spot, Spot) {
    let u = 1.0 - t;
    let [p, q, r, s] = *points;
    let sum = |weights: [f64; 4]| {
        let part = |p: f64, q: f64, r: f64, s: f64| {
            p * weights[0] + q * weights[1] + r * weights[2] + s * weights[3]
        };
        (part(p.0, q.0, r.0, s.0), part(p.1, q.1, r.1, s.1))
    };
    let place = sum([u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t]);
    let (a, b, c) = (u * u, 2.0 * u * t, t * t);
    let along = sum([-a, a - b, b - c, c]);
    (place, (along.1, -along.0))
}

/// Whether a curve beside another one is as far from it as it should be, by the measure of the original.
fn is_good(curve: &[Spot; 4], beside: &[Spot; 4], far: f64) -> bool {
    let near = (0.5 / far.abs()).clamp(LEAST_NEAR, NEAR);
    [0.25, 0.5, 0.75].into_iter().all(|t| {
        let (from, across) = at(curve, t);
        let (to, _) = at(beside, t);
        let (x, y) = (from.0 - to.0, from.1 - to.1);
        let length = across.0.abs() + across.1.abs();
        let is_far = (x * x + y * y - far * far).abs() > near * far * far;
        let is_aside =
            length > 0.0 && (across.0 * y - across.1 * x).abs() / length > near * far.abs();
        !is_far && !is_aside
    })
}

/// A pen on its way.
struct Pen<'a> {
    stroke: &'a skia::Stroke,
    half: f64,
    out: Vec<Step>,
}

/// The outline of what a pen leaves along steps, without its dashes.
pub fn stroked(steps: &[Step], stroke: &skia::Stroke) -> Vec<Step> {
    let mut pen = Pen {
        stroke,
        half: f64::from(stroke.width) / 2.0,
        out: Vec::with_capacity(4 * steps.len() + 8),
    };
    let mut begin = 0;
    for end in 1..=steps.len() {
        if end == steps.len() || matches!(steps[end], Step::Move(_)) {
            pen.part(&steps[begin..end]);
            begin = end;
        }
    }
    pen.out
}

impl Pen<'_> {
    /// One part of a path, both sides.
    fn part(&mut self, steps: &[Step]) {
        let Some(&Step::Move(begin)) = steps.first() else {
            return;
        };
        let mut here = begin;
        let mut pieces = Vec::with_capacity(steps.len());
        for step in &steps[1..] {
            let (points, is_curve) = match *step {
                Step::Move(_) => continue,
                Step::Line(to) => ([here, here, to, to], false),
                Step::Curve([one, other, to]) => ([here, one, other, to], true),
            };
            here = points[3];
            let piece = Piece { points, is_curve };
            if piece.directions().is_some() {
                pieces.push(piece);
            }
        }
        if pieces.is_empty() {
            return self.dot(begin);
        }
        let is_closed = here == begin;
        let first = self.side(&pieces, None);
        if let Some(first) = first.filter(|_| is_closed) {
            let last = pieces[pieces.len() - 1].directions().unwrap_or_default().1;
            self.join(begin, last, first);
        }
        let back: Vec<Piece> = pieces.iter().rev().map(|piece| piece.reversed()).collect();
        let cap = (!is_closed).then_some(here);
        let start = self.side(&back, cap);
        if let Some(start) = start {
            let last = back[back.len() - 1].directions().unwrap_or_default().1;
            if is_closed {
                self.join(begin, last, start);
            } else {
                self.cap(begin, last);
            }
        }
    }

    /// The left side of pieces, after an end around `cap` or as a part of its own; where its first piece goes.
    fn side(&mut self, pieces: &[Piece], cap: Option<Spot>) -> Option<Spot> {
        let mut before: Option<Spot> = None;
        let mut first = None;
        for piece in pieces {
            let (begin, end) = piece.directions()?;
            let moved = piece.offset(self.half);
            match (before, cap) {
                (Some(before), _) => self.join(piece.points[0], before, begin),
                (None, Some(at)) => self.cap(at, (-begin.0, -begin.1)),
                (None, None) => self.out.push(Step::Move(moved[0])),
            }
            first = first.or(Some(begin));
            if before.is_none() && cap.is_some() {
                self.out.push(Step::Line(moved[0]));
            }
            if piece.is_curve {
                self.beside_curve(piece, moved, 0);
            } else {
                self.out.push(Step::Line(moved[3]));
            }
            before = Some(end);
        }
        first
    }

    /// The left side of a curve, in as many curves as it needs.
    fn beside_curve(&mut self, piece: &Piece, moved: [Spot; 4], depth: u32) {
        if depth >= SPLITS || is_good(&piece.points, &moved, self.half) {
            let [_, one, other, to] = moved;
            return self.out.push(Step::Curve([one, other, to]));
        }
        for points in super::raster::halves(piece.points) {
            let half = Piece {
                points,
                is_curve: true,
            };
            self.beside_curve(&half, half.offset(self.half), depth + 1);
        }
    }

    /// Around an end: from the left of the direction there to its right.
    fn cap(&mut self, at: Spot, direction: Spot) {
        let half = self.half;
        let (left, right) = (beside(at, direction, half), beside(at, direction, -half));
        match self.stroke.line_cap {
            skia::LineCap::Butt => {}
            skia::LineCap::Square => {
                self.out.push(Step::Line(ahead(left, direction, half)));
                self.out.push(Step::Line(ahead(right, direction, half)));
            }
            skia::LineCap::Round => {
                let (tip, near) = (ahead(at, direction, half), QUARTER * half);
                self.out.push(Step::Curve([
                    ahead(left, direction, near),
                    beside(tip, direction, near),
                    tip,
                ]));
                self.out.push(Step::Curve([
                    beside(tip, direction, -near),
                    ahead(right, direction, near),
                    right,
                ]));
                return;
            }
        }
        self.out.push(Step::Line(right));
    }

    /// A corner at `at`, on the left side, between two directions.
    fn join(&mut self, at: Spot, before: Spot, after: Spot) {
        let half = self.half;
        let cross = before.0 * after.1 - before.1 * after.0;
        let dot = before.0 * after.0 + before.1 * after.1;
        let next = beside(at, after, half);
        if cross.abs() < 1e-9 && dot > 0.0 {
            return self.out.push(Step::Line(next));
        }
        if cross < 0.0 {
            // Inside of the corner.
            self.out.push(Step::Line(at));
            return self.out.push(Step::Line(next));
        }
        match self.stroke.line_join {
            skia::LineJoin::Bevel => {}
            skia::LineJoin::Miter | skia::LineJoin::MiterClip => {
                // From the corner to the tip, in halves of the pen, is 1 / cos of half the turn.
                let squared = 2.0 / (1.0 + dot).max(1e-12);
                let limit = f64::from(self.stroke.miter_limit);
                if squared <= limit * limit {
                    let sum = (before.0 + after.0, before.1 + after.1);
                    let tip = beside(at, sum, half / (1.0 + dot));
                    self.out.push(Step::Line(tip));
                }
            }
            skia::LineJoin::Round => {
                let turn = libm::atan2(cross, dot);
                let count = (turn / std::f64::consts::FRAC_PI_2).ceil().max(1.0);
                let part = turn / count;
                let near = 4.0 / 3.0 * libm::tan(part / 4.0) * half;
                let mut from = before;
                for _ in 0..count as u32 {
                    let (sine, cosine) = libm::sincos(part);
                    let to = (
                        from.0 * cosine - from.1 * sine,
                        from.0 * sine + from.1 * cosine,
                    );
                    let (left, right) = (beside(at, from, half), beside(at, to, half));
                    self.out.push(Step::Curve([
                        ahead(left, from, near),
                        ahead(right, to, -near),
                        right,
                    ]));
                    from = to;
                }
            }
        }
        self.out.push(Step::Line(next));
    }

    /// A pen that does not move.
    fn dot(&mut self, at: Spot) {
        if self.stroke.line_cap == skia::LineCap::Butt {
            return;
        }
        let right = (1.0, 0.0);
        self.out.push(Step::Move(beside(at, right, self.half)));
        self.cap(at, right);
        self.cap(at, (-1.0, 0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pen(cap: skia::LineCap, join: skia::LineJoin) -> skia::Stroke {
        skia::Stroke {
            width: 2.0,
            line_cap: cap,
            line_join: join,
            ..skia::Stroke::default()
        }
    }

    #[test]
    fn a_line_has_two_sides_and_two_ends() {
        let line = [Step::Move((0.0, 0.0)), Step::Line((10.0, 0.0))];
        let outline = stroked(&line, &pen(skia::LineCap::Square, skia::LineJoin::Bevel));
        let spots: Vec<Spot> = outline
            .iter()
            .map(|step| match step {
                Step::Move(to) | Step::Line(to) | Step::Curve([_, _, to]) => *to,
            })
            .collect();
        for corner in [(-1.0, -1.0), (11.0, -1.0), (11.0, 1.0), (-1.0, 1.0)] {
            assert!(spots.contains(&corner), "{corner:?} of {spots:?}");
        }
        assert!(
            spots
                .iter()
                .all(|spot| spot.0.abs() <= 11.0 && spot.1.abs() <= 1.0)
        );
    }

    #[test]
    fn corners_are_cut_pointed_or_round() {
        let corner = [
            Step::Move((0.0, 0.0)),
            Step::Line((10.0, 0.0)),
            Step::Line((10.0, 10.0)),
        ];
        let has = |join, spot: Spot| {
            stroked(&corner, &pen(skia::LineCap::Butt, join))
                .iter()
                .any(|step| {
                    let (Step::Move(to) | Step::Line(to) | Step::Curve([_, _, to])) = step;
                    libm::hypot(to.0 - spot.0, to.1 - spot.1) < 1e-9
                })
        };
        assert!(has(skia::LineJoin::Miter, (11.0, -1.0)));
        assert!(!has(skia::LineJoin::Bevel, (11.0, -1.0)));
        let round = stroked(&corner, &pen(skia::LineCap::Butt, skia::LineJoin::Round));
        assert!(round.iter().any(|step| matches!(step, Step::Curve(_))));
    }

    #[test]
    fn the_offset_of_a_quarter_is_a_quarter() {
        let near = 10.0 * QUARTER;
        let piece = Piece {
            points: [(10.0, 0.0), (10.0, near), (near, 10.0), (0.0, 10.0)],
            is_curve: true,
        };
        let moved = piece.offset(1.0);
        assert!(
            (moved[0].0 - 11.0).abs() < 1e-9 && moved[0].1.abs() < 1e-9,
            "{moved:?}"
        );
        assert!(
            (moved[3].1 - 11.0).abs() < 1e-9 && moved[3].0.abs() < 1e-9,
            "{moved:?}"
        );
    }

    #[test]
    fn pens_without_a_way_leave_dots() {
        let dot = [Step::Move((3.0, 3.0)), Step::Line((3.0, 3.0))];
        assert!(!stroked(&dot, &pen(skia::LineCap::Round, skia::LineJoin::Bevel)).is_empty());
        assert!(stroked(&dot, &pen(skia::LineCap::Butt, skia::LineJoin::Bevel)).is_empty());
        let strange = [
            Step::Move((f64::NAN, 0.0)),
            Step::Line((1e308, -1e308)),
            Step::Line((-1e308, 0.0)),
        ];
        stroked(&strange, &pen(skia::LineCap::Round, skia::LineJoin::Round));
    }
}
