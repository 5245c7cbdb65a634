//! A virtual TRIK controller in a small world, for work without hardware.
//!
//! [`board::Board`] makes a directory with the devices of a controller below it, down to the bytes on its buses; a
//! program that opens them can tell them from the real ones only by their kind of file. Behind the connectors is a
//! [`body::Body`]. This crate knows no filesystem of ours: the devices are the contract.
//!
//! Beside it, without files: [`field`] is a world of TRIK Studio as it is saved, [`arena`] that world while it runs, and
//! [`judge`] runs a program in it by the rules of its task. That half needs no system, and is all that there is without the
//! feature `board`: in a browser.

pub mod arena;
#[cfg(feature = "board")]
mod attributes;
#[cfg(feature = "board")]
pub mod board;
#[cfg(feature = "board")]
pub mod body;
#[cfg(feature = "board")]
mod bus;
#[cfg(feature = "board")]
mod camera;
#[cfg(feature = "board")]
mod control;
#[cfg(feature = "board")]
mod display;
#[cfg(feature = "board")]
mod errno;
#[cfg(feature = "board")]
pub mod faults;
pub mod field;
#[cfg(feature = "board")]
pub mod fifo;
#[cfg(feature = "board")]
mod files;
pub mod fuzz;
pub mod geometry;
#[cfg(feature = "board")]
mod input;
pub mod judge;
#[cfg(feature = "board")]
mod lidar;
#[cfg_attr(
    not(feature = "board"),
    allow(dead_code, reason = "most are those of the board")
)]
mod limits;
#[cfg(feature = "board")]
pub mod machine;
#[cfg(feature = "board")]
mod mems;
#[cfg(feature = "board")]
mod mistake;
#[cfg(feature = "board")]
mod mlx90640;
#[cfg(feature = "board")]
mod msp430;
#[cfg(feature = "board")]
mod photo;
#[cfg(feature = "board")]
mod pose;
mod random;
#[cfg(feature = "board")]
pub mod robots;
#[cfg(feature = "board")]
mod root;
#[cfg(feature = "board")]
mod sensors;
#[cfg(feature = "board")]
mod shared;
pub mod show;
#[cfg(feature = "board")]
mod sysfs;
#[cfg(feature = "board")]
pub mod world;
