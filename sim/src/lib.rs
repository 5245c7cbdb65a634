//! A virtual TRIK controller in a small world, for work without hardware.
//!
//! [`board::Board`] makes a directory with the devices of a controller below it, down to the bytes on its buses; whoever
//! opens them cannot tell them from the real ones but by their kind of file. Behind the connectors is a
//! [`body::Body`]. This crate knows no filesystem of ours and no configuration: the devices are the contract.

pub mod body;
pub mod geometry;
pub mod limits;
pub mod random;
pub mod robots;
pub mod world;
