//! Outlines to coverage: how much of each pixel of a small window lies inside of a polygon.
//!
//! Owns the arithmetic: signed areas of edges, summed from left to right, as in smooth rasterisers of fonts; 256 levels,
//! corners on a grid of 1/64 pixel, because the original's painter has both. Knows no colours and no scene.

use super::stroke::Spot;

/// What counts as inside.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Rule {
    /// Where the outline goes around at all.
    NonZero,
    /// Where it goes around an odd number of times.
    EvenOdd,
}

/// Parts of a pixel that corners lie on.
const GRID: f64 = 64.0;
/// Control points are at most so far from a curve that is drawn as a line, in pixels.
const STRAIGHT: f64 = 42.0 / 256.0;
/// How often a curve is halved.
const CURVE_DEPTH: usize = 16;

/// Coverage of the pixels of a window.
#[derive(Clone, Debug, Default)]
pub struct Coverage {
    width: usize,
    height: usize,
    /// Changes of the covered area from pixel to pixel; one more column than pixels.
    changes: Vec<f64>,
    /// First and last row with changes.
    rows: Option<(usize, usize)>,
}

impl Coverage {
    /// Nothing covered, in a window of this size.
    pub fn begin(&mut self, width: usize, height: usize) {
        let dirty = self.rows.take();
        if (width, height) == (self.width, self.height) {
            // Most areas touch few rows.
            if let Some((first, last)) = dirty {
                self.changes[first * (width + 2)..(last + 1) * (width + 2)].fill(0.0);
            }
            return;
        }
        (self.width, self.height) = (width, height);
        self.changes.clear();
        self.changes.resize((width + 2) * height, 0.0);
    }

    /// A point on the grid of corners.
    pub fn on_grid(x: f64) -> f64 {
        (x * GRID).round() / GRID
    }

    /// One edge of a closed outline, in pixels of the window. What is outside costs nothing.
    pub fn edge(&mut self, from: Spot, to: Spot) {
        let (width, height) = (self.width as f64, self.height as f64);
        let ((mut x0, mut y0), (mut x1, mut y1)) = (from, to);
        let mut sign = 1.0;
        if y0 > y1 {
            (x0, y0, x1, y1) = (x1, y1, x0, y0);
            sign = -1.0;
        }
        let is_finite = x0.is_finite() && x1.is_finite() && y0.is_finite() && y1.is_finite();
        if !is_finite || y1 <= 0.0 || y0 >= height || y0 == y1 {
            return;
        }
        let slope = (x1 - x0) / (y1 - y0);
        if y0 < 0.0 {
            x0 -= slope * y0;
            y0 = 0.0;
        }
        if y1 > height {
            x1 = x0 + slope * (height - y0);
            y1 = height;
        }
        // Left of the window an edge covers whole rows; right of it, nothing.
        let cut = |limit: f64| y0 + (limit - x0) / slope;
        let mut ends = [(x0, y0); 4];
        let mut count = 1;
        let (first, last) = if x0 < x1 { (0.0, width) } else { (width, 0.0) };
        for limit in [first, last] {
            if (x0 < limit) != (x1 < limit) && slope != 0.0 {
                let y = cut(limit).clamp(y0, y1);
                ends[count] = (limit, y);
                count += 1;
            }
        }
        ends[count] = (x1, y1);
        for pair in ends[..=count].windows(2) {
            let (one, other) = (pair[0], pair[1]);
            let middle = f64::midpoint(one.0, other.0);
            if middle < width {
                let inside = |x: f64| x.clamp(0.0, width);
                self.piece((inside(one.0), one.1), (inside(other.0), other.1), sign);
            }
        }
    }

    /// A cubic curve of a closed outline. It is cut into edges where the original's painter cuts it: as soon as its control
    /// points are within about a sixth of a pixel of a straight line.
    pub fn curve(&mut self, points: [Spot; 4]) {
        let mut stack = [points; CURVE_DEPTH + 1];
        let mut depth = 0;
        loop {
            let arc = stack[depth];
            if depth == CURVE_DEPTH || self.is_aside(&arc) || is_straight(&arc) {
                self.edge(arc[0], arc[3]);
                if depth == 0 {
                    return;
                }
                depth -= 1;
            } else {
                let [first, second] = halves(arc);
                (stack[depth], stack[depth + 1]) = (second, first);
                depth += 1;
            }
        }
    }

    /// Whether of a curve only its ends matter: it is above, below, left or right of the window.
    fn is_aside(&self, arc: &[Spot; 4]) -> bool {
        let (width, height) = (self.width as f64, self.height as f64);
        arc.iter().all(|point| point.1 <= 0.0)
            || arc.iter().all(|point| point.1 >= height)
            || arc.iter().all(|point| point.0 <= 0.0)
            || arc.iter().all(|point| point.0 >= width)
    }

    /// A piece of an edge within the window, downwards.
    fn piece(&mut self, (x0, y0): Spot, (x1, y1): Spot, sign: f64) {
        if y1 <= y0 {
            return;
        }
        let slope = (x1 - x0) / (y1 - y0);
        let first = y0 as usize;
        let last = (y1.ceil() as usize).min(self.height).saturating_sub(1);
        let rows = self.rows.get_or_insert((first, last));
        *rows = (rows.0.min(first), rows.1.max(last));
        let (mut x, mut y) = (x0, y0);
        for row in first..=last {
            let below = y1.min((row + 1) as f64);
            let next = if row == last {
                x1
            } else {
                x0 + slope * (below - y0)
            };
            self.in_row(row, x, next, (below - y) * sign);
            (x, y) = (next, below);
        }
    }

    /// A piece of an edge within one row, from `x0` to `x1`, `height` high.
    fn in_row(&mut self, row: usize, x0: f64, x1: f64, height: f64) {
        let start = row * (self.width + 2);
        let (left, right) = if x0 < x1 { (x0, x1) } else { (x1, x0) };
        let (first, last) = (left as usize, (right as usize).min(self.width));
        if first >= last {
            let beside = f64::midpoint(left, right) - first as f64;
            self.changes[start + first] += height * (1.0 - beside);
            self.changes[start + first + 1] += height * beside;
            return;
        }
        let per_pixel = height / (right - left);
        let mut from = left;
        for column in first..=last {
            let to = right.min((column + 1) as f64);
            let part = per_pixel * (to - from);
            let beside = f64::midpoint(from, to) - column as f64;
            self.changes[start + column] += part * (1.0 - beside);
            self.changes[start + column + 1] += part * beside;
            from = to;
        }
    }

    /// Calls with column, row and coverage, 1 to 255, of each pixel that is covered.
    pub fn pixels(&self, rule: Rule, mut see: impl FnMut(usize, usize, u8)) {
        let Some((first, last)) = self.rows else {
            return;
        };
        for row in first..=last {
            let start = row * (self.width + 2);
            let mut area = 0.0;
            for column in 0..self.width {
                area += self.changes[start + column];
                let level = level(area, rule);
                if level > 0 {
                    see(column, row, level);
                }
            }
        }
    }
}

/// Whether a curve is drawn as a line: the measure of FreeType's smooth rasteriser, which the original's painter has.
fn is_straight(arc: &[Spot; 4]) -> bool {
    let way = |index: usize| (arc[index].0 - arc[0].0, arc[index].1 - arc[0].1);
    let (chord, one, other) = (way(3), way(1), way(2));
    let (x, y) = (chord.0.abs(), chord.1.abs());
    // Near the length of the chord, and not above it by more than a fifth.
    let length = x.max(y) + x.min(y) * 3.0 / 8.0;
    let limit = length * STRAIGHT;
    let far = |way: Spot| (chord.1 * way.0 - chord.0 * way.1).abs();
    let is_behind = |way: Spot| way.0 * (way.0 - chord.0) + way.1 * (way.1 - chord.1) > 0.0;
    far(one) <= limit && far(other) <= limit && !is_behind(one) && !is_behind(other)
}

/// Both halves of a curve.
pub(super) fn halves([p, q, r, s]: [Spot; 4]) -> [[Spot; 4]; 2] {
    let middle = |a: Spot, b: Spot| (f64::midpoint(a.0, b.0), f64::midpoint(a.1, b.1));
    let (pq, qr, rs) = (middle(p, q), middle(q, r), middle(r, s));
    let (left, right) = (middle(pq, qr), middle(qr, rs));
    let centre = middle(left, right);
    [[p, pq, left, centre], [centre, right, rs, s]]
}

/// A covered area in 256 steps.
fn level(area: f64, rule: Rule) -> u8 {
    // Sums of exact parts may miss a whole number by the last bit.
    let steps = (area.abs() * 256.0 + 1e-7) as u64;
    let steps = match rule {
        Rule::NonZero => steps,
        Rule::EvenOdd => {
            let turned = steps % 512;
            if turned > 256 { 512 - turned } else { turned }
        }
    };
    u8::try_from(steps).unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(corners: &[Spot], rule: Rule) -> Vec<Vec<u8>> {
        let mut coverage = Coverage::default();
        coverage.begin(4, 3);
        for (index, &corner) in corners.iter().enumerate() {
            coverage.edge(corner, corners[(index + 1) % corners.len()]);
        }
        let mut rows = vec![vec![0; 4]; 3];
        coverage.pixels(rule, |x, y, level| rows[y][x] = level);
        rows
    }

    #[test]
    fn parts_of_pixels_are_counted() {
        let square = [(0.5, 0.0), (2.25, 0.0), (2.25, 1.5), (0.5, 1.5)];
        let rows = covered(&square, Rule::NonZero);
        assert_eq!(rows, [[128, 255, 64, 0], [64, 128, 32, 0], [0, 0, 0, 0]]);
    }

    #[test]
    fn a_slope_covers_by_area() {
        let triangle = [(0.0, 0.0), (4.0, 0.0), (0.0, 2.0)];
        let rows = covered(&triangle, Rule::NonZero);
        // Half of the first 2 x 1 pixels of each step.
        assert_eq!(rows, [[255, 255, 192, 64], [192, 64, 0, 0], [0, 0, 0, 0]]);
    }

    #[test]
    fn what_is_around_the_window_covers_all_of_it() {
        let around = [(-1e6, -1e6), (1e6, -2e6), (3e6, 1e6), (-2e6, 3e6)];
        assert_eq!(covered(&around, Rule::NonZero), vec![vec![255; 4]; 3]);
        let beside = [(4.0, -9.0), (90.0, -9.0), (90.0, 9.0), (4.0, 9.0)];
        assert_eq!(covered(&beside, Rule::NonZero), vec![vec![0; 4]; 3]);
        let crossing = [(-2.0, 1.0), (6.0, 1.0), (6.0, 1.5), (-2.0, 1.5)];
        assert_eq!(covered(&crossing, Rule::NonZero)[1], [128; 4]);
    }

    #[test]
    fn rules_differ_where_an_outline_goes_around_twice() {
        let twice: Vec<_> = [(1.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0)].repeat(2);
        assert_eq!(covered(&twice, Rule::NonZero)[0], [0, 255, 255, 0]);
        assert_eq!(covered(&twice, Rule::EvenOdd)[0], [0; 4]);
    }

    #[test]
    fn a_curve_covers_what_is_inside_of_it() {
        let mut coverage = Coverage::default();
        coverage.begin(10, 10);
        let near = 4.0 * 0.5523;
        // A quarter of a disc with a radius of 4, and both straight sides.
        coverage.curve([(4.0, 0.0), (4.0, near), (near, 4.0), (0.0, 4.0)]);
        coverage.edge((0.0, 4.0), (0.0, 0.0));
        coverage.edge((0.0, 0.0), (4.0, 0.0));
        let mut sum = 0.0;
        coverage.pixels(Rule::NonZero, |_, _, level| sum += f64::from(level) / 255.0);
        assert!((sum - std::f64::consts::PI * 4.0).abs() < 0.4, "{sum}");
        let mut aside = Coverage::default();
        aside.begin(3, 3);
        aside.curve([(-5.0, -9.0), (-90.0, 3.0), (-7.0, 50.0), (-5.0, 12.0)]);
        aside.edge((9.0, 12.0), (9.0, -9.0));
        let mut count = 0;
        aside.pixels(Rule::NonZero, |_, _, level| {
            count += usize::from(level == 255)
        });
        assert_eq!(count, 9);
    }

    #[test]
    fn numbers_that_are_none_are_left_out() {
        let strange = [
            (f64::NAN, 0.0),
            (1.0, f64::INFINITY),
            (1e308, -1e308),
            (-1e308, 1e308),
        ];
        // Any answer, no panic, within the window.
        assert_eq!(covered(&strange, Rule::NonZero).len(), 3);
    }
}
