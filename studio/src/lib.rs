//! What commands of `trik` and the package for browsers both do with projects of TRIK Studio: read programs and worlds, find
//! all that is wrong with them, answer the questions of programs with text that are judged, and say how a judged run ended and
//! why.
//!
//! Owns which bytes are a program or a world, which findings there are and in which order, and the names of verdicts. Pure:
//! bytes and values in, values and problems out; no files, network, threads or clock. What a diagram means is known in
//! `lang`, what a task demands in `sim`.

pub mod explain;
pub mod findings;
pub mod limits;
pub mod lint;
pub mod program;
pub mod script;
pub mod verdict;
mod words;
