//! Outlines to coverage: how much of each pixel of a small window lies inside of a polygon.
//!
//! Owns the arithmetic, in whole numbers: signed areas of edges summed from left to right, as in smooth rasterisers of
//! fonts. docs/maintainer/recorded.md says how near it comes to the original's painter, and where not. Where an edge crosses from one row or column to the next is a
//! whole part of a pixel, the one before. Knows no colours and no scene.

use super::stroke::Spot;

/// What counts as inside.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Rule {
    /// Where the outline goes around at all.
    NonZero,
    /// Where it goes around an odd number of times.
    EvenOdd,
}

/// How finely corners are placed and areas are told; the original's painter has two rasterisers.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Grid {
    /// Of paths: corners lie on 64ths of a pixel, edges on 256ths, and a pixel has 256 steps of which the last two are one.
    #[default]
    Path,
    /// Of straight bars: corners lie on 65536ths of a pixel, and a pixel has 255 steps.
    Bar,
}

/// A corner on the grid: column and row in parts of a pixel.
pub type Corner = (i64, i64);

/// Parts of a pixel on which corners of paths lie.
const CORNERS: f64 = 64.0;
/// Control points are at most so far from a curve that is drawn as a line, in 256ths of a pixel.
const STRAIGHT: i64 = 256 / 6;
/// A longer chord is halved whatever it is like.
const CHORD: i64 = 32_767;
/// How often a curve is halved.
const CURVE_DEPTH: usize = 16;
/// Corners farther away are here, in the parts on which they lie.
const FAR: f64 = (1u64 << 28) as f64;

impl Grid {
    /// Parts of a pixel.
    fn one(self) -> i64 {
        match self {
            Self::Path => 256,
            Self::Bar => 65_536,
        }
    }

    /// A number of pixels on the grid.
    pub fn place(self, x: f64) -> i64 {
        match self {
            Self::Path => (x * CORNERS).round().clamp(-FAR, FAR) as i64 * 4,
            Self::Bar => (x * 65_536.0).floor().clamp(-FAR, FAR) as i64,
        }
    }

    /// Twice a covered area in parts of a pixel as 0 to 255.
    fn level(self, area: i64, rule: Rule) -> u8 {
        let steps = match self {
            // An area that is gone around the other way is rounded up.
            Self::Path => (area >> 9).abs(),
            Self::Bar => (area.abs() * 255) >> 33,
        };
        let steps = match rule {
            Rule::NonZero => steps,
            Rule::EvenOdd => {
                let turned = steps & 511;
                if turned > 256 { 512 - turned } else { turned }
            }
        };
        u8::try_from(steps).unwrap_or(u8::MAX)
    }
}

/// What edges do to a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    /// How high they are on the whole, downwards.
    cover: i64,
    /// Twice the area to their left.
    area: i64,
}

/// Coverage of the pixels of a window.
#[derive(Clone, Debug, Default)]
pub struct Coverage {
    grid: Grid,
    width: usize,
    height: usize,
    /// Row by row; each has one cell before its first pixel, for all that is left of it.
    cells: Vec<Cell>,
    /// First and last row with changes.
    rows: Option<(usize, usize)>,
    /// Of each row the last cell with a change, and one more.
    ends: Vec<usize>,
}

impl Coverage {
    /// Nothing covered, in a window of this size.
    pub fn begin(&mut self, grid: Grid, width: usize, height: usize) {
        self.grid = grid;
        let dirty = self.rows.take();
        if (width, height) == (self.width, self.height) {
            // Most areas touch few rows.
            if let Some((first, last)) = dirty {
                self.cells[first * (width + 1)..(last + 1) * (width + 1)].fill(Cell::default());
                self.ends[first..=last].fill(0);
            }
            return;
        }
        (self.width, self.height) = (width, height);
        self.cells.clear();
        self.cells.resize((width + 1) * height, Cell::default());
        self.ends.clear();
        self.ends.resize(height, 0);
    }

    /// A point of the window on its grid.
    pub fn place(&self, at: Spot) -> Corner {
        (self.grid.place(at.0), self.grid.place(at.1))
    }

    /// One edge of a closed outline. What is outside of the window costs nothing.
    pub fn edge(&mut self, from: Corner, to: Corner) {
        let one = self.grid.one();
        let (width, height) = (self.width as i64, self.height as i64);
        let ((x0, y0), (x1, y1)) = (from, to);
        let (top, bottom) = (y0.min(y1), y0.max(y1));
        if top == bottom || bottom <= 0 || top >= height * one || x0.min(x1) >= width * one {
            return;
        }
        let first = (top / one).max(0);
        let last = ((bottom - 1) / one).min(height - 1);
        let (low, high) = (first as usize, last as usize);
        let rows = self.rows.get_or_insert((low, high));
        *rows = (rows.0.min(low), rows.1.max(high));
        let (dx, dy) = (x1 - x0, (y1 - y0).abs());
        let at = |y: i64| match y {
            y if y == y0 => x0,
            y if y == y1 => x1,
            y => x0 + (dx * (y - y0).abs()).div_euclid(dy),
        };
        for row in first..=last {
            let above = top.max(row * one);
            let below = bottom.min((row + 1) * one);
            let (enter, leave) = if y0 < y1 {
                (above, below)
            } else {
                (below, above)
            };
            self.in_row(row as usize, (at(enter), enter), (at(leave), leave));
        }
    }

    /// A cubic curve of a closed outline. It is cut into edges where the original's painter cuts it: as soon as its control
    /// points are within about a sixth of a pixel of a straight line.
    pub fn curve(&mut self, points: [Corner; 4]) {
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
                let [first, second] = halves_on_grid(arc);
                (stack[depth], stack[depth + 1]) = (second, first);
                depth += 1;
            }
        }
    }

    /// Whether of a curve only its ends matter: it is above, below, left or right of the window.
    fn is_aside(&self, arc: &[Corner; 4]) -> bool {
        let one = self.grid.one();
        let (width, height) = (self.width as i64 * one, self.height as i64 * one);
        arc.iter().all(|point| point.1 < 0)
            || arc.iter().all(|point| point.1 >= height)
            || arc.iter().all(|point| point.0 < 0)
            || arc.iter().all(|point| point.0 >= width)
    }

    /// A piece of an edge within one row.
    fn in_row(&mut self, row: usize, (x0, y0): Corner, (x1, y1): Corner) {
        let one = self.grid.one();
        let end = self.width as i64;
        let start = row * (self.width + 1);
        let (first, last) = (x0.div_euclid(one), x1.div_euclid(one));
        if first.min(last) >= end {
            return;
        }
        let reach = (first.max(last).clamp(-1, end - 1) + 2) as usize;
        self.ends[row] = self.ends[row].max(reach);
        if first.max(last) < 0 {
            self.cells[start].cover += y1 - y0;
            return;
        }
        if first == last {
            let cell = &mut self.cells[start + (first + 1) as usize];
            cell.cover += y1 - y0;
            cell.area += (x0 + x1 - 2 * first * one) * (y1 - y0);
            return;
        }
        let (height, length) = (y1 - y0, (x1 - x0).abs());
        let cross = |x: i64| y0 + (height * (x - x0).abs()).div_euclid(length);
        // What a column has, from where the edge comes in to where it goes out, both in parts from the column's left.
        let mut put = |column: i64, x: [i64; 2], y: [i64; 2]| {
            let cell = &mut self.cells[start + (column.clamp(-1, end - 1) + 1) as usize];
            cell.cover += y[1] - y[0];
            cell.area += (x[0] + x[1]) * (y[1] - y[0]);
        };
        let is_right = x0 < x1;
        // Columns that are seen, in the direction of the edge.
        let (low, high) = (first.min(last).max(0), first.max(last).min(end - 1));
        for step in 0..=high - low {
            let column = if is_right { low + step } else { high - step };
            let left = column * one;
            let (near, far) = if is_right { (0, one) } else { (one, 0) };
            let enter = match column == first {
                true => (x0 - left, y0),
                false => (near, cross(left + near)),
            };
            let leave = match column == last {
                true => (x1 - left, y1),
                false => (far, cross(left + far)),
            };
            put(column, [enter.0, leave.0], [enter.1, leave.1]);
        }
        if first.min(last) < 0 {
            let y = cross(0);
            let part = if is_right { y - y0 } else { y1 - y };
            self.cells[start].cover += part;
        }
    }

    /// Calls with row, columns and coverage, 1 to 255, of all that is covered.
    pub fn spans(&self, rule: Rule, mut see: impl FnMut(usize, std::ops::Range<usize>, u8)) {
        let Some((first, last)) = self.rows else {
            return;
        };
        let whole = 2 * self.grid.one();
        for row in first..=last {
            let start = row * (self.width + 1);
            let end = self.ends[row];
            if end == 0 {
                continue;
            }
            let mut cover = self.cells[start].cover;
            let mut from = 0;
            let mut seen = 0;
            for column in 1..end {
                let cell = self.cells[start + column];
                cover += cell.cover;
                let level = self.grid.level(cover * whole - cell.area, rule);
                if level != seen {
                    if seen > 0 {
                        see(row, from..column - 1, seen);
                    }
                    (from, seen) = (column - 1, level);
                }
            }
            let level = self.grid.level(cover * whole, rule);
            let behind = end - 1;
            if level == seen {
                if seen > 0 {
                    see(row, from..self.width, seen);
                }
                continue;
            }
            if seen > 0 {
                see(row, from..behind, seen);
            }
            if level > 0 && behind < self.width {
                see(row, behind..self.width, level);
            }
        }
    }
}

/// Whether a curve is drawn as a line: the measure of FreeType's smooth rasteriser, which the original's painter has.
fn is_straight(arc: &[Corner; 4]) -> bool {
    let way = |index: usize| (arc[index].0 - arc[3].0, arc[index].1 - arc[3].1);
    let (chord, one, other) = (way(0), way(1), way(2));
    let (x, y) = (chord.0.abs(), chord.1.abs());
    // Near the length of the chord, and not above it by more than a fifth.
    let length = x.max(y) + ((3 * x.min(y)) >> 3);
    if length > CHORD {
        return false;
    }
    let limit = length * STRAIGHT;
    let far = |way: Corner| (chord.1 * way.0 - chord.0 * way.1).abs();
    let is_behind = |way: Corner| way.0 * (way.0 - chord.0) + way.1 * (way.1 - chord.1) > 0;
    far(one) <= limit && far(other) <= limit && !is_behind(one) && !is_behind(other)
}

/// Both halves of a curve on the grid.
fn halves_on_grid([p, q, r, s]: [Corner; 4]) -> [[Corner; 4]; 2] {
    let middle = |a: Corner, b: Corner| ((a.0 + b.0) / 2, (a.1 + b.1) / 2);
    let (pq, qr, rs) = (middle(p, q), middle(q, r), middle(r, s));
    let (left, right) = (middle(pq, qr), middle(qr, rs));
    let centre = middle(left, right);
    [[p, pq, left, centre], [centre, right, rs, s]]
}

/// Both halves of a curve.
pub(super) fn halves([p, q, r, s]: [Spot; 4]) -> [[Spot; 4]; 2] {
    let middle = |a: Spot, b: Spot| (f64::midpoint(a.0, b.0), f64::midpoint(a.1, b.1));
    let (pq, qr, rs) = (middle(p, q), middle(q, r), middle(r, s));
    let (left, right) = (middle(pq, qr), middle(qr, rs));
    let centre = middle(left, right);
    [[p, pq, left, centre], [centre, right, rs, s]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(corners: &[Spot], rule: Rule) -> Vec<Vec<u8>> {
        let mut coverage = Coverage::default();
        coverage.begin(Grid::Path, 4, 3);
        let corners: Vec<Corner> = corners.iter().map(|&at| coverage.place(at)).collect();
        for (index, &corner) in corners.iter().enumerate() {
            coverage.edge(corner, corners[(index + 1) % corners.len()]);
        }
        let mut rows = vec![vec![0; 4]; 3];
        coverage.spans(rule, |y, columns, level| rows[y][columns].fill(level));
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
        coverage.begin(Grid::Path, 10, 10);
        let at = |x: f64, y: f64| (Grid::Path.place(x), Grid::Path.place(y));
        let near = 4.0 * 0.5523;
        // A quarter of a disc with a radius of 4, and both straight sides.
        coverage.curve([at(4.0, 0.0), at(4.0, near), at(near, 4.0), at(0.0, 4.0)]);
        coverage.edge(at(0.0, 4.0), at(0.0, 0.0));
        coverage.edge(at(0.0, 0.0), at(4.0, 0.0));
        let mut sum = 0.0;
        coverage.spans(Rule::NonZero, |_, columns, level| {
            sum += columns.len() as f64 * f64::from(level) / 255.0;
        });
        assert!((sum - std::f64::consts::PI * 4.0).abs() < 0.4, "{sum}");
        let mut aside = Coverage::default();
        aside.begin(Grid::Path, 3, 3);
        aside.curve([
            at(-5.0, -9.0),
            at(-90.0, 3.0),
            at(-7.0, 50.0),
            at(-5.0, 12.0),
        ]);
        aside.edge(at(9.0, 12.0), at(9.0, -9.0));
        let mut count = 0;
        aside.spans(Rule::NonZero, |_, columns, level| {
            count += columns.len() * usize::from(level == 255);
        });
        assert_eq!(count, 9);
    }

    /// Each worked out by hand in 256ths: what goes around the other way is rounded up, and where an edge leaves a row or a
    /// column is rounded down.
    #[test]
    fn areas_are_rounded_as_the_original_rounds_them() {
        // A third of a pixel, 21 of 64 parts: 84 of 256 steps either way.
        let thin = [(0.0, 0.0), (0.0, 1.0), (0.328_125, 1.0), (0.328_125, 0.0)];
        assert_eq!(covered(&thin, Rule::NonZero)[0][0], 84);
        // 21/64 * 21/64 of a pixel are 27.5 steps: 27 one way, 28 the other.
        let down = [
            (0.0, 0.0),
            (0.0, 0.328_125),
            (0.328_125, 0.328_125),
            (0.328_125, 0.0),
        ];
        assert_eq!(covered(&down, Rule::NonZero)[0][0], 27);
        let up: Vec<Spot> = down.iter().rev().copied().collect();
        assert_eq!(covered(&up, Rule::NonZero)[0][0], 28);
        // From (0, 0) to (1, 3) rows are left at 85 and 170 256ths, of 85.3 and 170.6.
        let slope = [(0.0, 0.0), (0.0, 3.0), (1.0, 3.0)];
        let rows = covered(&slope, Rule::NonZero);
        // (85 * 256) / 512, (85 + 170) * 256 / 512 and (170 + 256) * 256 / 512 steps.
        assert_eq!([rows[0][0], rows[1][0], rows[2][0]], [42, 127, 213]);
    }

    #[test]
    fn bars_have_255_steps_and_finer_corners() {
        let mut coverage = Coverage::default();
        coverage.begin(Grid::Bar, 4, 3);
        let bar = [(0.7, 0.5), (0.7, 2.0), (2.1, 2.0), (2.1, 0.5)].map(|at| coverage.place(at));
        for (index, &corner) in bar.iter().enumerate() {
            coverage.edge(corner, bar[(index + 1) % 4]);
        }
        let mut rows = vec![vec![0; 4]; 3];
        coverage.spans(Rule::NonZero, |y, columns, level| {
            rows[y][columns].fill(level)
        });
        // 0.3, 1 and 0.1 of 255, a half of them above.
        assert_eq!(rows, [[38, 127, 12, 0], [76, 255, 25, 0], [0; 4]]);
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
