//! The state between the ends of the last step.
//!
//! Owns the polynomials: for order five those of Shampine, Some practical Runge-Kutta formulas (1986), order four; else
//! the cubic through both ends with their derivatives.

use super::{Method, Solver};

/// How much of each slope is in the powers of the part of the step: a row for each slope.
const POWERS: [[f64; 4]; 7] = [
    [
        1.0,
        -8_048_581_381.0 / 2_820_520_608.0,
        8_663_915_743.0 / 2_820_520_608.0,
        -12_715_105_075.0 / 11_282_082_432.0,
    ],
    [0.0; 4],
    [
        0.0,
        131_558_114_200.0 / 32_700_410_799.0,
        -68_118_460_800.0 / 10_900_136_933.0,
        87_487_479_700.0 / 32_700_410_799.0,
    ],
    [
        0.0,
        -1_754_552_775.0 / 470_086_768.0,
        14_199_869_525.0 / 1_410_260_304.0,
        -10_690_763_975.0 / 1_880_347_072.0,
    ],
    [
        0.0,
        127_303_824_393.0 / 49_829_197_408.0,
        -318_862_633_887.0 / 49_829_197_408.0,
        701_980_252_875.0 / 199_316_789_632.0,
    ],
    [
        0.0,
        -282_668_133.0 / 205_662_961.0,
        2_019_193_451.0 / 616_988_883.0,
        -1_453_857_185.0 / 822_651_844.0,
    ],
    [
        0.0,
        40_617_522.0 / 29_380_423.0,
        -110_615_467.0 / 29_380_423.0,
        69_997_945.0 / 29_380_423.0,
    ],
];

/// The state at a time of the last step; the ends themselves for times that are not in it.
pub(super) fn between(solver: &Solver, time: f64, state: &mut [f64]) {
    let whole = solver.size;
    let part = (time - solver.before) / whole;
    let given = state.iter_mut().zip(&solver.ended).zip(&solver.old);
    // Written so that a step of nothing has one state.
    if !(part > 0.0 && part < 1.0) {
        let is_begin = part <= 0.0;
        given.for_each(|((to, new), old)| *to = if is_begin { *old } else { *new });
        return;
    }
    match solver.options.method {
        Method::Rk45 => {
            let square = part * part;
            let powers = [part, square, square * part, square * square];
            let weight = |row: [f64; 4]| -> f64 {
                row.iter().zip(powers).map(|(one, power)| one * power).sum()
            };
            let weights = POWERS.map(weight);
            for (at, ((to, _), old)) in given.enumerate() {
                let slopes = solver.slopes.iter().zip(weights);
                let sum: f64 = slopes.map(|(slope, weight)| slope[at] * weight).sum();
                *to = old + whole * sum;
            }
        }
        _ => {
            let rest = 1.0 - part;
            for (at, ((to, new), old)) in given.enumerate() {
                let (first, last) = (solver.slopes[0][at], solver.slopes[6][at]);
                let bend =
                    rest * (whole * first - (new - old)) - part * (whole * last - (new - old));
                *to = rest * old + part * new + part * rest * bend;
            }
        }
    }
}
