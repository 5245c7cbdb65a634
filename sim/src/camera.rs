//! What the camera sensors make of a picture: line, object and colours. Pure: a picture in, numbers out.
//!
//! Hue is 0 to 359, saturation and value are 0 to 100. A range of hues may go over 0.

use crate::world::{Colour, colour};

/// Size of a picture: enough to follow a line, small enough for thirty in a second.
pub const WIDTH: usize = 32;
/// See [`WIDTH`].
pub const HEIGHT: usize = 24;
/// A row that is filled less than this is no crossing.
const CROSSING: f64 = 0.4;

/// Rows from top to bottom.
#[derive(Debug, Clone)]
pub struct Picture(pub Vec<[Colour; WIDTH]>);

/// Ranges of hue, saturation and value: from and to of each.
pub type Hsv = [i32; 6];

/// Where the line is: x from -100 to 100, crossing and mass from 0 to 100.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// 0 is the middle, 100 the right edge.
    pub x: i32,
    /// How much a row of it is filled.
    pub crossing: i32,
    /// How much of the picture is line.
    pub mass: i32,
}

/// Hue, saturation and value of a colour.
fn hsv(seen: Colour) -> [i32; 3] {
    let [red, green, blue] = [seen.red, seen.green, seen.blue].map(f64::from);
    let most = red.max(green).max(blue);
    let spread = most - red.min(green).min(blue);
    let hue = if spread == 0.0 {
        0.0
    } else if most == red {
        60.0 * (green - blue) / spread
    } else if most == green {
        60.0 * (blue - red) / spread + 120.0
    } else {
        60.0 * (red - green) / spread + 240.0
    };
    let saturation = if most == 0.0 {
        0.0
    } else {
        spread / most * 100.0
    };
    [
        hue.rem_euclid(360.0) as i32,
        saturation as i32,
        (most / 2.55) as i32,
    ]
}

fn is_within(seen: Colour, ranges: &Hsv) -> bool {
    let [hue, saturation, value] = hsv(seen);
    let is_hue = if ranges[0] <= ranges[1] {
        (ranges[0]..=ranges[1]).contains(&hue)
    } else {
        hue >= ranges[0] || hue <= ranges[1]
    };
    is_hue
        && (ranges[2]..=ranges[3]).contains(&saturation)
        && (ranges[4]..=ranges[5]).contains(&value)
}

/// From a column or row to -100..100.
fn centred(place: f64, size: usize) -> i32 {
    let half = (size as f64 - 1.0) / 2.0;
    ((place - half) / half * 100.0).round() as i32
}

impl Picture {
    /// Columns and rows of everything with a colour in these ranges.
    fn found(&self, ranges: &Hsv, from_row: usize) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        for (row, pixels) in self.0.iter().enumerate().skip(from_row) {
            for (column, seen) in pixels.iter().enumerate() {
                if is_within(*seen, ranges) {
                    found.push((column, row));
                }
            }
        }
        found
    }

    /// The line in the lower half.
    pub fn line(&self, ranges: &Hsv) -> Line {
        let top = HEIGHT / 2;
        let found = self.found(ranges, top);
        if found.is_empty() {
            return Line {
                x: 0,
                crossing: 0,
                mass: 0,
            };
        }
        let count = found.len() as f64;
        let middle = found.iter().map(|place| place.0 as f64).sum::<f64>() / count;
        let in_row = |row| found.iter().filter(|place| place.1 == row).count();
        let widest = (top..HEIGHT).map(in_row).max().unwrap_or(0) as f64 / WIDTH as f64;
        let crossing = ((widest - CROSSING) / (1.0 - CROSSING)).max(0.0);
        Line {
            x: centred(middle, WIDTH),
            crossing: (crossing * 100.0).round() as i32,
            mass: (count / (WIDTH * (HEIGHT - top)) as f64 * 100.0).round() as i32,
        }
    }

    /// Where an object is and how large: x, y (down is positive) and size, which is 0 if there is none.
    pub fn object(&self, ranges: &Hsv) -> (i32, i32, i32) {
        let found = self.found(ranges, 0);
        if found.is_empty() {
            return (0, 0, 0);
        }
        let count = found.len() as f64;
        let column = found.iter().map(|place| place.0 as f64).sum::<f64>() / count;
        let row = found.iter().map(|place| place.1 as f64).sum::<f64>() / count;
        let size = (count / (WIDTH * HEIGHT) as f64).sqrt() * 100.0;
        (
            centred(column, WIDTH),
            centred(row, HEIGHT),
            size.round() as i32,
        )
    }

    /// The mean colours of a grid, row after row.
    pub fn colours(&self, rows: usize, columns: usize) -> Vec<u32> {
        let mut means = Vec::with_capacity(rows * columns);
        for row in 0..rows {
            for column in 0..columns {
                let mean = self.mean(
                    row * HEIGHT / rows..(row + 1) * HEIGHT / rows,
                    column * WIDTH / columns..(column + 1) * WIDTH / columns,
                );
                means.push(u32::from_be_bytes([0, mean.red, mean.green, mean.blue]));
            }
        }
        means
    }

    /// Ranges around what is in the middle.
    pub fn detect(&self) -> Hsv {
        let rows = HEIGHT * 2 / 5..HEIGHT * 3 / 5;
        let [hue, saturation, value] = hsv(self.mean(rows, WIDTH * 2 / 5..WIDTH * 3 / 5));
        // What is grey or dark has no hue.
        let (from, to) = if saturation < 15 || value < 15 {
            (0, 359)
        } else {
            ((hue - 15).rem_euclid(360), (hue + 15).rem_euclid(360))
        };
        let around = |middle: i32| ((middle - 20).max(0), (middle + 20).min(100));
        let ((low, high), (dark, bright)) = (around(saturation), around(value));
        // Nor has what is dark a saturation.
        let (low, high) = if value < 15 { (0, 100) } else { (low, high) };
        [from, to, low, high, dark, bright]
    }

    fn mean(&self, rows: std::ops::Range<usize>, columns: std::ops::Range<usize>) -> Colour {
        let mut sums = [0u32; 3];
        let mut count = 0;
        for pixels in &self.0[rows] {
            for seen in &pixels[columns.clone()] {
                for (sum, part) in sums.iter_mut().zip([seen.red, seen.green, seen.blue]) {
                    *sum += u32::from(part);
                }
                count += 1;
            }
        }
        let [red, green, blue] = sums.map(|sum| (sum / count.max(1)) as u8);
        colour(red, green, blue)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLACK: Hsv = [0, 359, 0, 100, 0, 20];

    /// White, with a black column at `column`.
    fn column(column: usize) -> Picture {
        let mut row = [colour(255, 255, 255); WIDTH];
        row[column] = colour(0, 0, 0);
        Picture(vec![row; HEIGHT])
    }

    #[test]
    fn colours_have_the_hues_of_the_circle() {
        assert_eq!(hsv(colour(255, 0, 0)), [0, 100, 100]);
        assert_eq!(hsv(colour(0, 255, 0)), [120, 100, 100]);
        assert_eq!(hsv(colour(0, 0, 127)), [240, 100, 49]);
        assert_eq!(hsv(colour(255, 0, 255)), [300, 100, 100]);
        assert_eq!(hsv(colour(0, 0, 0)), [0, 0, 0]);
    }

    #[test]
    fn a_line_at_the_right_edge_is_at_100() {
        let expected = Line {
            x: 100,
            crossing: 0,
            mass: 3,
        };
        assert_eq!(column(WIDTH - 1).line(&BLACK), expected);
        assert_eq!(column(0).line(&BLACK).x, -100);
        let mut crossing = column(16);
        crossing.0[20] = [colour(0, 0, 0); WIDTH];
        assert_eq!(crossing.line(&BLACK).crossing, 100);
    }

    #[test]
    fn an_object_has_a_place_and_a_size() {
        let mut picture = Picture(vec![[colour(255, 255, 255); WIDTH]; HEIGHT]);
        assert_eq!(picture.object(&[340, 20, 50, 100, 20, 100]), (0, 0, 0));
        for row in &mut picture.0[12..] {
            row[..16].fill(colour(250, 0, 20));
        }
        // A quarter of the picture, at the lower left.
        assert_eq!(picture.object(&[340, 20, 50, 100, 20, 100]), (-52, 52, 50));
    }

    #[test]
    fn a_grid_has_the_mean_of_each_cell_and_detect_finds_what_it_saw() {
        let mut picture = column(0);
        picture.0[..12].fill([colour(0, 0, 255); WIDTH]);
        assert_eq!(picture.colours(2, 1)[0], 0x00_00FF);
        assert_eq!(picture.colours(2, 2)[3], 0xFF_FFFF);
        let blue = Picture(vec![[colour(10, 10, 200); WIDTH]; HEIGHT]);
        let ranges = blue.detect();
        assert_eq!(blue.object(&ranges).2, 100);
        assert_eq!(column(0).object(&ranges).2, 0);
    }
}
