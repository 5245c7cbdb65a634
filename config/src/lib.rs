//! The Lua configuration of a robot's tree: sandbox, checks, typed result.
//!
//! In reading order: `load` runs and checks a configuration, `description` is what comes out, `program` gives the
//! private Lua states in which converters run, `format` turns tuples into text and back, `error` says what is wrong,
//! `problem` what and where, `limits` holds every limit, `watchdog` ends what lasts too long.
//! Knows nothing of files that are mounted, and opens no device.

mod check;
mod dataflow;
mod dcml;
pub mod description;
mod device_root;
pub mod error;
mod evdev_codes;
mod fields;
pub mod format;
pub mod fuzz;
pub mod limits;
mod lines;
pub mod load;
pub mod nearest;
mod place;
pub mod problem;
pub mod program;
mod search;
pub mod source;
mod texts;
mod value;
mod vm;
pub mod watchdog;
