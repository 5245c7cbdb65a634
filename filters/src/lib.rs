//! Converters from the textbook, one file each: usable from Rust and exported as the shared library `libtrikfs_filters.so`.
//!
//! Owns the equations. Knows nothing of files, clocks, devices or threads: a filter sees one value after another.
//!
//! Every tuple is an array of little-endian 32-bit values, each of which is filtered on its own: `i32` for the plain names,
//! `f32` for the names that end in `_f32`. A value that is not a finite number is a fault, and so is a result that is none;
//! after a fault the filter begins afresh, so that no later value leans on one that was missing.
//!
//! `config/lua/filters.lua` has the same filters in Lua, equal bit for bit; `tests/golden/filters` holds both to it.

#![forbid(unsafe_code)]

// The frame: values, parameters, one filter for each value of a tuple.
pub mod lanes;
pub mod limits;
pub mod number;
pub mod params;
pub mod vectors;

// The filters.
pub mod dead_band;
pub mod identity;
pub mod inverse;
pub mod low_pass;
pub mod median3;
pub mod moving_average;
pub mod rate;
pub mod scale;

#[cfg(test)]
mod golden;

use lanes::Lanes;

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
}
