//! What a step of 1 ms of the virtual robot costs: its movement by the model, beside the same movement by hand, and the
//! whole body with its motors, battery and walls.
//!
//! `cargo bench -p sim --bench body`; the best of several runs counts.

use sim::body::two_wheels::{TwoWheels, two_wheels};
use sim::body::{Body, Drive, Power};
use sim::geometry::{Pose, point};
use sim::world::World;
use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

const STEPS: u32 = 1_000_000;
const RUNS: u32 = 7;
const STEP_S: f64 = 0.001;
/// What both wheels turn in a step, in radians.
const TURNED: [f64; 4] = [0.0, 0.0, 0.012, 0.013];

/// Nanoseconds of one of [`STEPS`] steps, in the best run.
fn best(mut run: impl FnMut()) -> f64 {
    let times = (0..RUNS).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min) / f64::from(STEPS) * 1e9
}

/// The arc of constant wheel speeds, as a person would write it.
fn by_hand(from: Pose, left_m: f64, right_m: f64) -> Pose {
    let turn = (right_m - left_m) / 0.155;
    let radius = (left_m + right_m) / 2.0 / turn;
    let heading_rad = from.heading_rad + turn;
    let (start, end) = (from.heading_rad, heading_rad);
    let at = point(
        from.at.x + radius * (end.sin() - start.sin()),
        from.at.y - radius * (end.cos() - start.cos()),
    );
    Pose { at, heading_rad }
}

fn main() {
    let mut arc = Pose::default();
    let hand_ns = best(|| {
        arc = Pose::default();
        for _ in 0..STEPS {
            let [_, _, left, right] = black_box(TURNED);
            arc = by_hand(arc, left * 0.028, right * 0.028);
        }
    });
    let mut end = Pose::default();
    let model_ns = best(|| {
        let mut rolling = two_wheels(Pose::default()).expect("the shipped model");
        for _ in 0..STEPS {
            rolling.roll(STEP_S, black_box(TURNED), [0; 6]);
        }
        end = rolling.pose();
    });
    let apart = end.at.from(arc.at).length();
    println!("by hand      {hand_ns:8.1} ns a step");
    println!(
        "by the model {model_ns:8.1} ns a step, {:.1} times",
        model_ns / hand_ns
    );
    println!(
        "apart after {} s and {:.0} turns: {apart:.1e} m",
        f64::from(STEPS) * STEP_S,
        (end.heading_rad / PI / 2.0).abs()
    );
    let mut drive = Drive::default();
    drive.motors[2] = Power::Duty(60.0);
    drive.motors[3] = Power::Duty(61.0);
    let body_ns = best(|| {
        let mut robot = TwoWheels::new(World::room(), Pose::new(0.8, 1.0, 0.0));
        for _ in 0..STEPS {
            robot.step(STEP_S, &drive);
        }
        black_box(robot.senses());
    });
    println!(
        "whole body   {body_ns:8.1} ns a step: {:.3} % of a processor in real time",
        body_ns / 1e6 * 100.0
    );
}
