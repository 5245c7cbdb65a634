//! What the languages share: what is wrong with a text and where, in two languages, XML as a tree,
//! the signs of markup, JSON, pictures in SVG, and the rule about `main` in JavaScript.
//!
//! Pure: bytes in, values and [`problem::Problem`]s out. Knows no language, no files, network, threads or clock.

// Problems are rare, and their size costs nothing where none is.
#![allow(clippy::result_large_err)]

pub mod escape;
pub mod javascript;
pub mod json;
pub mod limits;
pub mod near;
pub mod problem;
pub mod svg;
mod words;
pub mod xml;
