//! A virtual TRIK controller in a small world, for work without hardware.
//!
//! [`board::Board`] makes a directory with the devices of a controller below it, down to the bytes on its buses; a
//! program that opens them can tell them from the real ones only by their kind of file. Behind the connectors is a
//! [`body::Body`]. This crate knows no filesystem of ours: the devices are the contract.
//!
//! Beside it, without files: [`field`] is a world of TRIK Studio as it is saved, [`arena`] that world while it runs, and
//! [`judge`] runs a program in it by the rules of its task.

pub mod arena;
mod attributes;
pub mod board;
pub mod body;
mod bus;
mod camera;
mod control;
mod display;
mod errno;
pub mod faults;
pub mod field;
pub mod fifo;
mod files;
pub mod fuzz;
pub mod geometry;
mod input;
pub mod judge;
mod lidar;
mod limits;
pub mod machine;
mod mems;
mod mistake;
mod mlx90640;
mod msp430;
mod photo;
mod pose;
mod random;
pub mod robots;
mod root;
mod sensors;
mod shared;
pub mod show;
mod sysfs;
pub mod world;
