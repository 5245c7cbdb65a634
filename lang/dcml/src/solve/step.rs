//! Single steps of the methods.
//!
//! Owns their coefficients: for order five those of Dormand and Prince, A family of embedded Runge-Kutta formulae (1980).
//! A step reads the state and the first slope of a [`Solver`], and leaves the new state in its stage.

use super::{Method, Solver};
use crate::system::System;

/// Where the stages stand in the step; the last two at its end.
const TIMES: [f64; 5] = [1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0];
/// How much of each slope is in the stages two to six, and in the result.
const STAGES: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
/// The difference of the results of order five and four.
const ERRORS: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Puts the state plus `by` times a slope into the stage.
fn ahead(solver: &mut Solver, slope: usize, by: f64) {
    let from = solver.state.iter().zip(&solver.slopes[slope]);
    for (to, (state, slope)) in solver.stage.iter_mut().zip(from) {
        *to = state + by * slope;
    }
}

/// The slope at the stage.
fn ask<S: System + ?Sized>(
    solver: &mut Solver,
    system: &mut S,
    actions: &mut impl FnMut(f64, &mut [f64]),
    time: f64,
    slope: usize,
) {
    actions(time, &mut solver.action);
    system.derivative(&solver.stage, &solver.action, &mut solver.slopes[slope]);
}

/// A step of one of the methods without an error.
pub(super) fn fixed<S: System + ?Sized>(
    solver: &mut Solver,
    system: &mut S,
    actions: &mut impl FnMut(f64, &mut [f64]),
    size: f64,
) {
    let (middle, end) = (solver.time + size / 2.0, (solver.time + size).next_down());
    match solver.options.method {
        Method::Euler => ahead(solver, 0, size),
        Method::Heun => {
            ahead(solver, 0, size);
            ask(solver, system, actions, end, 1);
            let [first, second, ..] = &solver.slopes;
            for (at, to) in solver.stage.iter_mut().enumerate() {
                *to = solver.state[at] + size / 2.0 * (first[at] + second[at]);
            }
        }
        Method::Rk4 | Method::Rk45 => {
            ahead(solver, 0, size / 2.0);
            ask(solver, system, actions, middle, 1);
            ahead(solver, 1, size / 2.0);
            ask(solver, system, actions, middle, 2);
            ahead(solver, 2, size);
            ask(solver, system, actions, end, 3);
            let [k1, k2, k3, k4, ..] = &solver.slopes;
            for (at, to) in solver.stage.iter_mut().enumerate() {
                let sum = k1[at] + 2.0 * (k2[at] + k3[at]) + k4[at];
                *to = solver.state[at] + size / 6.0 * sum;
            }
        }
    }
}

/// A step of order five to `end`; gives its error, where 1 is what is allowed. What is not finite has no finite error.
pub(super) fn dormand_prince<S: System + ?Sized>(
    solver: &mut Solver,
    system: &mut S,
    actions: &mut impl FnMut(f64, &mut [f64]),
    size: f64,
    end: f64,
) -> f64 {
    for (row, parts) in STAGES.iter().enumerate() {
        let slopes = &solver.slopes[..=row];
        for (at, to) in solver.stage.iter_mut().enumerate() {
            let sum: f64 = slopes.iter().zip(parts).map(|(k, part)| k[at] * part).sum();
            *to = solver.state[at] + size * sum;
        }
        let time = match TIMES.get(row) {
            Some(part) if *part < 1.0 => solver.time + size * part,
            _ => end.next_down(),
        };
        ask(solver, system, actions, time, row + 1);
    }
    let count = solver.state.len();
    if count == 0 {
        return 0.0;
    }
    let squares = (0..count).map(|at| (size * error_of(solver, at)).powi(2));
    (squares.sum::<f64>() / count as f64).sqrt()
}

/// The error of one part of the state for a step of 1 s, where 1 is what is allowed.
pub(super) fn error_of(solver: &Solver, at: usize) -> f64 {
    let slopes = solver.slopes.iter().zip(ERRORS);
    let error: f64 = slopes.map(|(slope, part)| slope[at] * part).sum();
    error / allowed(solver, solver.state[at].abs().max(solver.stage[at].abs()))
}

fn allowed(solver: &Solver, size: f64) -> f64 {
    let options = &solver.options;
    // A state of zero without an absolute error would divide by nothing.
    (options.absolute + options.relative * size).max(f64::MIN_POSITIVE)
}

/// The size of the first step: as in Hairer, Norsett, Wanner, II.4, from the first derivative and a guess of the second.
pub(super) fn first<S: System + ?Sized>(
    solver: &mut Solver,
    system: &mut S,
    actions: &mut impl FnMut(f64, &mut [f64]),
    limit: f64,
) -> f64 {
    let most = limit - solver.time;
    let count = solver.state.len().max(1) as f64;
    let size_of = |solver: &Solver, value: &dyn Fn(usize) -> f64| {
        let parts = (0..solver.state.len())
            .map(|at| (value(at) / allowed(solver, solver.state[at].abs())).powi(2));
        (parts.sum::<f64>() / count).sqrt()
    };
    let far = size_of(solver, &|at| solver.state[at]);
    let fast = size_of(solver, &|at| solver.slopes[0][at]);
    let guess = if far < 1e-5 || fast < 1e-5 {
        1e-6
    } else {
        0.01 * far / fast
    };
    let guess = guess.min(most);
    ahead(solver, 0, guess);
    ask(
        solver,
        system,
        actions,
        (solver.time + guess).next_down(),
        1,
    );
    let bend = size_of(solver, &|at| solver.slopes[1][at] - solver.slopes[0][at]) / guess;
    let steepest = fast.max(bend);
    let next = if steepest <= 1e-15 {
        (guess * 1e-3).max(1e-6)
    } else {
        libm::pow(0.01 / steepest, 0.2)
    };
    let first = (100.0 * guess).min(next).min(most);
    // What is not finite is found by the step itself.
    first.max(10.0 * (solver.time.next_up() - solver.time))
}
