//! Converters from the textbook, one file each: usable from Rust and exported as the shared library `libtrikfs_filters.so`.
//!
//! Owns the equations. Knows nothing of files, clocks, devices or threads: a filter sees one value after another.
//!
//! Every tuple is an array of little-endian 32-bit values: `i32` for the plain names, `f32` for the names that end in `_f32`.
//! Most filters work on each value of a tuple on its own (`lanes`); those that fuse several values into others (`fused`) say
//! which values they take, and get the time between two tuples from `clock`. A value that is not a finite number is a fault,
//! and so is a result that is none; after a fault the filter starts over, so that no later value leans on a missing one.
//!
//! `config/lua/filters.lua` has the same filters in Lua, equal bit for bit, but for [`LIBRARY_ONLY`];
//! `tests/golden/filters` holds both to it.

#![forbid(unsafe_code)]

// The frame: values, parameters, one filter for each value of a tuple.
pub mod clock;
pub mod fused;
pub mod lanes;
pub mod limits;
pub mod number;
pub mod params;

// What filters of orientation are made of.
pub mod inertial;
pub mod trig;
pub mod vector;

// The filters.
pub mod complementary;
pub mod dead_band;
pub mod debounce;
pub mod heading;
pub mod hysteresis;
pub mod identity;
pub mod inverse;
pub mod kalman;
pub mod kalman_linear;
pub mod low_pass;
pub mod madgwick;
pub mod mahony;
pub mod median3;
pub mod moving_average;
pub mod odometry;
pub mod pid;
pub mod rate;
pub mod scale;
pub mod speed_hold;

#[cfg(test)]
mod golden;

use fused::Fused;
use lanes::Lanes;

/// Filters that have no form in Lua: their arithmetic is too much for it, or is in f32, which Lua does not have.
pub const LIBRARY_ONLY: [&str; 6] = [
    "heading",
    "kalman_linear",
    "kalman_linear_f32",
    "madgwick",
    "mahony",
    "odometry",
];

converter::export_converters! {
    "identity" => identity::Identity,
    "median3" => Lanes<median3::Median3<i32>>,
    "median3_f32" => Lanes<median3::Median3<f32>>,
    "moving_average" => Lanes<moving_average::MovingAverage<i32>>,
    "moving_average_f32" => Lanes<moving_average::MovingAverage<f32>>,
    "low_pass" => Lanes<low_pass::LowPass<i32>>,
    "low_pass_f32" => Lanes<low_pass::LowPass<f32>>,
    "scale" => Lanes<scale::Scale<i32>>,
    "scale_f32" => Lanes<scale::Scale<f32>>,
    "inverse" => Lanes<inverse::Inverse<i32>>,
    "inverse_f32" => Lanes<inverse::Inverse<f32>>,
    "dead_band" => Lanes<dead_band::DeadBand<i32>>,
    "dead_band_f32" => Lanes<dead_band::DeadBand<f32>>,
    "rate" => Lanes<rate::Rate<i32>>,
    "rate_f32" => Lanes<rate::Rate<f32>>,
    "debounce" => Lanes<debounce::Debounce<i32>>,
    "debounce_f32" => Lanes<debounce::Debounce<f32>>,
    "hysteresis" => Lanes<hysteresis::Hysteresis<i32>>,
    "hysteresis_f32" => Lanes<hysteresis::Hysteresis<f32>>,
    "kalman" => Lanes<kalman::Kalman<i32>>,
    "kalman_f32" => Lanes<kalman::Kalman<f32>>,
    "kalman_linear" => Fused<kalman_linear::KalmanLinear<i32>>,
    "kalman_linear_f32" => Fused<kalman_linear::KalmanLinear<f32>>,
    "complementary" => Fused<complementary::Complementary<i32>>,
    "complementary_f32" => Fused<complementary::Complementary<f32>>,
    "pid" => Fused<pid::Pid<i32>>,
    "pid_f32" => Fused<pid::Pid<f32>>,
    "speed_hold" => Fused<speed_hold::SpeedHold>,
    "odometry" => Fused<odometry::Odometry>,
    "heading" => Fused<heading::Heading>,
    "madgwick" => Fused<madgwick::Madgwick>,
    "mahony" => Fused<mahony::Mahony>,
}
