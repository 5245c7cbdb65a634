//! One run of a solution in a world, judged: program, world and rules, tick by tick, to a verdict.
//!
//! Owns the order of one tick, the limits of a run and what is told of it. Knows neither files nor processes: texts in,
//! an outcome out. What a world does is in [`crate::arena`]; what a task demands is in `lang`.

// A thing, part or record that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]

mod clock;
mod dataflow;
pub mod debugged;
pub mod hands;
pub mod json;
mod lint;
pub mod picture;
pub mod program;
mod recorder;
pub mod replay;
pub mod report;
pub mod run;
mod scene;
pub mod task;
pub mod track;
pub mod trajectory;
pub mod trial;
pub mod witness;
mod words;

pub use clock::Clock;
pub use dataflow::Dataflow;
pub use lint::lint;
pub use picture::{Caption, page, svg};
pub use program::{Diagram, Program, Running, Spot};
pub use replay::{judge_recorded, strange_in_record};
pub use run::{Failure, Outcome, Settings, Verdict, devices};
pub use task::{Task, Texts};
pub use track::Group;
pub use trajectory::Trajectory;
pub use trial::{Progress, Trial, judge};
pub use words::too_slow;
