//! The data-flow language: programs of blocks that exchange tokens, and what can be done with them.
//!
//! Owns reading, checking, running and writing of these programs. Knows no robot: that is the trait `Brick` of
//! `lang_diagram`. Pure: no files, clocks or threads.

// A kind of block, token or port that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]
// Problems are rare, and their size costs nothing where none is.
#![allow(clippy::result_large_err)]

pub mod blocks;
pub mod check;
pub mod debug;
pub mod diary;
pub mod edit;
pub mod fuzz;
pub mod generate;
pub mod limits;
pub mod lower;
pub mod machine;
pub mod program;
pub mod project;
pub mod read;
pub mod save;
mod sensors;
pub mod show;
pub mod text;
mod words;
