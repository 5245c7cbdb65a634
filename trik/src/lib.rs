//! The tool for a person at a PC: a whole virtual robot in one command.
//!
//! `cli` lists the commands. `up` starts the virtual board and the tree over it, `fault` breaks devices of a running board,
//! `place` knows where the robots of a user are, `remote` brings programs to robots, `diagrams` shows, checks and translates
//! diagrams without a robot, `dcml` does the same with models of robots, `check` runs and judges solutions of tasks,
//! `script` runs programs with text for it, `sandbox` confines those in Python, `debug` stops diagrams and goes back in them, `dap` does so for editors,
//! `record` writes what a tree gives into a file, `replay` makes a tree of it, `recording` looks into such files,
//! `bridges` serves a tree for tools of other people, `class` shows all robots of a class. All of them stand on `error`, `refusal`, `input`, `output`,
//! `terminal`, `language`, `pattern` and `chart`, which know no command. Nothing of this runs on the controller.

#![deny(clippy::wildcard_enum_match_arm)]

mod bridges;
mod chart;
mod check;
mod class;
pub mod cli;
mod dap;
mod dcml;
mod debug;
mod diagrams;
pub mod error;
mod fault;
pub mod fuzz;
mod grade;
mod input;
mod language;
pub mod limits;
mod output;
pub mod place;
mod record;
mod recording;
mod refusal;
mod remote;
mod replay;
pub mod sandbox;
pub mod script;
mod site;
mod task;
mod terminal;
mod up;
mod wire;
