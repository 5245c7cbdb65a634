//! Sines and cosines of many angles at a time.
//!
//! Owns the way: the nearest quarter turn is taken off in three parts (Cody and Waite), the rest is summed by the series
//! of both functions, and all is without branches, so that a compiler makes it wide. Results differ from those of the
//! standard library by less than 1e-15, and at angles near multiples of half a turn by less than 1e-12 of themselves.
//! Angles that are far from zero, or no numbers, are left to the standard library.

use super::batch::LANES;

/// Up to here quarter turns are taken off without loss, in rad.
const REACH: f64 = 1e5;
/// Half of the numbers between this and its double are whole: adding it rounds.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// A quarter turn: its first 33 bits, the next 33, and the rest.
const QUARTER: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];
/// 1/3!, 1/5! ... with the signs of the sine's series.
const SINE: [f64; 8] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
];
/// 1/4!, 1/6! ... with the signs of the cosine's.
const COSINE: [f64; 7] = [
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];

/// A series of powers, by Horner.
#[inline(always)]
fn series<const N: usize>(parts: &[f64; N], power: f64) -> f64 {
    let mut sum = parts[N - 1];
    for at in (0..N - 1).rev() {
        sum = parts[at] + power * sum;
    }
    sum
}

/// Both functions of each angle.
pub(super) fn sin_cos(angles: &[f64; LANES], sines: &mut [f64; LANES], cosines: &mut [f64; LANES]) {
    let mut is_far = false;
    for ((angle, sine), cosine) in angles.iter().zip(sines.iter_mut()).zip(cosines.iter_mut()) {
        let rounded = angle * std::f64::consts::FRAC_2_PI + ROUND;
        let quarters = rounded - ROUND;
        let rest = angle - quarters * QUARTER[0];
        let rest = rest - quarters * QUARTER[1];
        let rest = rest - quarters * QUARTER[2];
        let square = rest * rest;
        let own = (rest + rest * square * series(&SINE, square)).to_bits();
        let other = (1.0 - 0.5 * square + square * square * series(&COSINE, square)).to_bits();
        // The low bits count the quarters: odd ones change the functions, the second bit the signs.
        let count = rounded.to_bits();
        let odd = (count & 1).wrapping_neg();
        let changed = (own ^ other) & odd;
        *sine = f64::from_bits(own ^ changed ^ ((count & 2) << 62));
        *cosine = f64::from_bits(other ^ changed ^ ((count.wrapping_add(1) & 2) << 62));
        is_far |= (angle.abs() > REACH) | angle.is_nan();
    }
    if is_far {
        far(angles, sines, cosines);
    }
}

#[cold]
fn far(angles: &[f64; LANES], sines: &mut [f64; LANES], cosines: &mut [f64; LANES]) {
    for ((angle, sine), cosine) in angles.iter().zip(sines).zip(cosines) {
        // What is no number is far too.
        if angle.is_nan() || angle.abs() > REACH {
            (*sine, *cosine) = libm::sincos(*angle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sketch::numbers;
    use std::f64::consts::FRAC_PI_2;

    #[track_caller]
    fn compare(angles: &[f64; LANES]) {
        let (mut sines, mut cosines) = ([0.0; LANES], [0.0; LANES]);
        sin_cos(angles, &mut sines, &mut cosines);
        for (angle, found) in angles.iter().zip(sines.iter().zip(&cosines)) {
            let expected = angle.sin_cos();
            for (found, expected) in [(*found.0, expected.0), (*found.1, expected.1)] {
                let error = (found - expected).abs();
                let is_near = error < 1e-15 && error <= 1e-12 * expected.abs();
                let is_same = found.is_nan() && expected.is_nan();
                assert!(is_near || is_same, "{angle}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn both_are_those_of_the_library() {
        for scale in [1e-9, 1e-3, 1.0, 4.0, 100.0, 1e4, 1e5, 1e9, 1e300] {
            let mut random = numbers(21);
            for _ in 0..200 {
                let mut angles = [0.0; LANES];
                angles.fill_with(|| random.next().unwrap_or_default() * scale);
                compare(&angles);
            }
        }
    }

    #[test]
    fn quarter_turns_and_strange_numbers_are_right_too() {
        let mut angles = [0.0; LANES];
        for (at, angle) in angles.iter_mut().enumerate() {
            *angle = (at as f64 - 30.0) * FRAC_PI_2;
        }
        compare(&angles);
        angles.iter_mut().for_each(|one| *one *= 997.0);
        compare(&angles);
        let strange = [
            f64::NAN,
            f64::INFINITY,
            -f64::INFINITY,
            1e5,
            -1e5,
            1e-310,
            0.0,
            f64::MAX,
        ];
        angles[..8].copy_from_slice(&strange);
        compare(&angles);
    }
}
