//! What optical sensors make of a window of the floor.
//!
//! Owns the formulas of the original's light, colour and line sensors, and their noise. Knows no ports and no robots.

use super::Window;
use crate::random::Random;

/// Side of a light sensor's picture, in pixels.
pub const LIGHT_SIDE: u16 = 12;
/// Side of the camera's picture.
pub const CAMERA_SIDE: u16 = 18;
/// Part of the camera's picture whose mean is the colour of the colour sensor.
pub const COLOUR_PART: f64 = 0.3;
/// The same of the colour that a line sensor learns.
pub const DETECT_PART: f64 = 0.2;
/// Part of the camera's picture in which the line is looked for.
pub const LINE_PART: f64 = 2.0;

/// What the real light sensor has at most.
const LIGHT_MAX: f64 = 1023.0;
/// A dark floor is a large number on TRIK.
const DARKEST: i32 = 99;
/// Variance of the noise of light.
const LIGHT_VARIANCE: f64 = 1.0;
/// Noise beyond it makes a pixel black or white.
const LIGHT_LIMIT: f64 = 0.8;
/// Variance of the noise of colours.
const COLOUR_VARIANCE: f64 = 2.0;
/// Channels of a pixel of the line differ from its colour by less.
const NEAR: u8 = 10;
/// Part of the rows in which crossing lines are counted.
const CROSS_PART: f64 = 0.2;

/// Noise of a variance, as the original makes it: the sum of twelve uniform numbers.
///
/// Its deviation is a little more than the root of the variance, because it counts with 0.083 instead of 1/12.
pub fn noise(random: &mut Random, variance: f64) -> f64 {
    random.normal() * (variance / (12.0 * 0.083)).sqrt()
}

/// A light sensor: 0 on white, 99 on black. With `random` there is noise.
pub fn light(window: &Window, mut random: Option<&mut Random>) -> i32 {
    if window.pixels.is_empty() {
        return DARKEST;
    }
    let mut sum = 0u32;
    for pixel in &window.pixels {
        let [red, green, blue] = match random.as_deref_mut() {
            None => *pixel,
            Some(random) => match noise(random, LIGHT_VARIANCE) {
                more if more > LIGHT_LIMIT => [u8::MAX; 3],
                less if less < -LIGHT_LIMIT => [0; 3],
                _ => *pixel,
            },
        };
        let bright = 0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue);
        sum += 4 * bright as u32;
    }
    let mean = f64::from(sum) / window.pixels.len() as f64;
    DARKEST - (mean * 100.0 / LIGHT_MAX) as i32
}

/// The mean colour of a window: red, green, blue. With `random` there is noise, the same in all channels.
pub fn colour(window: &Window, random: Option<&mut Random>) -> [u8; 3] {
    let count = window.pixels.len().max(1) as f64;
    let noise = random.map_or(0.0, |random| noise(random, COLOUR_VARIANCE));
    let mean = |channel: usize| {
        let sum: u32 = window
            .pixels
            .iter()
            .map(|pixel| u32::from(pixel[channel]))
            .sum();
        (f64::from(sum) / count + noise).round().clamp(0.0, 255.0) as u8
    };
    std::array::from_fn(mean)
}

/// The colour that a line sensor learns from a window.
pub fn learned(window: &Window) -> [u8; 3] {
    let count = u32::try_from(window.pixels.len().max(1)).unwrap_or(u32::MAX);
    std::array::from_fn(|channel| {
        let sum: u32 = window
            .pixels
            .iter()
            .map(|pixel| u32::from(pixel[channel]))
            .sum();
        u8::try_from(sum / count).unwrap_or(u8::MAX)
    })
}

/// A line sensor that looks for a colour: where the line is, from -100 at the left to 100 at the right and 0 without a
/// line; how much of the rows in the middle it fills, in percent; how many pixels of it a row has.
pub fn line(window: &Window, wanted: [u8; 3]) -> [i32; 3] {
    let side = window.side;
    if side == 0 {
        return [0; 3];
    }
    let half = side as f64 / 2.0;
    let cross_rows = (side as f64 * CROSS_PART) as usize;
    let [red, green, blue] = wanted;
    // Without a branch: this is half of what a reading costs.
    let is_near = |pixel: &[u8; 3]| {
        (pixel[0].abs_diff(red) < NEAR)
            & (pixel[1].abs_diff(green) < NEAR)
            & (pixel[2].abs_diff(blue) < NEAR)
    };
    let (mut place, mut count, mut crossing, mut rows) = (0.0, 0usize, 0usize, 0u32);
    for (index, row) in window.pixels.chunks_exact(side).enumerate() {
        let (mut in_row, mut columns) = (0usize, 0usize);
        for (column, pixel) in row.iter().enumerate() {
            let near = usize::from(is_near(pixel));
            in_row += near;
            columns += near * column;
        }
        // Halves and whole numbers: the sum of the differences from the middle is exact.
        let sum = columns as f64 - in_row as f64 * half;
        if in_row > 0 {
            place += sum * 100.0 / half / in_row as f64;
            rows += 1;
        }
        count += in_row;
        // Both bounds are whole numbers there.
        if (side - cross_rows) / 2 < index && index < usize::midpoint(side, cross_rows) {
            crossing += in_row;
        }
    }
    let place = if rows > 0 {
        place / f64::from(rows)
    } else {
        0.0
    };
    let crossing = crossing as f64 * 100.0 / (side * cross_rows).max(1) as f64;
    [
        rounded(place),
        rounded(crossing),
        i32::try_from(count / side).unwrap_or(i32::MAX),
    ]
}

/// To the nearest whole number; halves go up, as in the original.
fn rounded(value: f64) -> i32 {
    (value + 0.5).floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(side: usize, rgb: [u8; 3]) -> Window {
        Window {
            side,
            pixels: vec![rgb; side * side],
        }
    }

    /// What the real program says on floors of one colour.
    #[test]
    fn light_is_what_the_original_says() {
        let cases = [
            ([255, 255, 255], 0),
            ([0, 0, 0], 99),
            ([255, 0, 0], 78),
            ([0, 255, 0], 28),
            ([128, 128, 128], 49),
        ];
        for (rgb, expected) in cases {
            assert_eq!(light(&plain(11, rgb), None), expected, "{rgb:?}");
        }
    }

    #[test]
    fn noise_of_light_makes_some_pixels_black_or_white() {
        let mut random = Random::new(7);
        let grey = plain(11, [128; 3]);
        let readings: Vec<i32> = (0..200).map(|_| light(&grey, Some(&mut random))).collect();
        let mean = f64::from(readings.iter().sum::<i32>()) / 200.0;
        assert!((mean - 49.0).abs() < 1.5, "{mean}");
        assert!(readings.iter().any(|reading| *reading != readings[0]));
        let again: Vec<i32> = {
            let mut random = Random::new(7);
            (0..200).map(|_| light(&grey, Some(&mut random))).collect()
        };
        assert_eq!(readings, again);
    }

    #[test]
    fn the_noise_has_the_dispersion_of_the_original() {
        let mut random = Random::new(3);
        let count = 20_000;
        let square: f64 = (0..count).map(|_| noise(&mut random, 1.5).powi(2)).sum();
        let variance = square / f64::from(count);
        assert!((variance - 1.5 / (12.0 * 0.083)).abs() < 0.05, "{variance}");
    }

    #[test]
    fn colours_are_means() {
        let mut window = plain(5, [10, 20, 30]);
        window.pixels[0] = [35, 20, 30];
        assert_eq!(colour(&window, None), [11, 20, 30]);
        assert_eq!(learned(&window), [11, 20, 30]);
        let noisy = colour(&window, Some(&mut Random::new(1)));
        let apart: Vec<i32> = noisy
            .iter()
            .zip([11, 20, 30])
            .map(|(one, other)| i32::from(*one) - other)
            .collect();
        assert!(
            apart
                .iter()
                .all(|difference| (difference - apart[0]).abs() <= 1),
            "{apart:?}"
        );
    }

    #[test]
    fn a_line_has_a_place_a_crossing_and_a_width() {
        let mut window = plain(35, [255; 3]);
        assert_eq!(line(&window, [0; 3]), [0; 3]);
        for row in 0..35 {
            for column in 30..33 {
                window.pixels[row * 35 + column] = [5, 0, 9];
            }
        }
        // Columns 30, 31, 32 around 31 - 17.5 of 17.5; 3 of 35 in 6 of the 7 rows that are counted.
        assert_eq!(line(&window, [0; 3]), [77, 7, 3]);
        assert_eq!(line(&window, [0, 0, 20]), [0; 3]);
    }
}
