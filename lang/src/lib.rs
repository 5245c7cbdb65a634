//! What a user writes for a robot, understood: text to a checked program, to a machine that runs it, to other languages.
//!
//! Pure: bytes and values in, values and [`problem::Problem`]s out. Knows no files, network, threads, clock or device:
//! time is a number that the caller gives, and a robot is a trait that the caller implements.

// Problems are rare, and their size costs nothing where none is.
#![allow(clippy::result_large_err)]

pub mod constraint;
pub mod dcml;
pub mod diagram;
pub mod expr;
pub mod fuzz;
pub mod limits;
pub mod problem;
pub mod xml;
