//! Programs in languages with text under a judge: what answers their questions about the robot and time.
//!
//! Model time passes only while a program waits, so the same program in the same world does the same each time. Knows no engine
//! and no process: `trik` runs programs in its own, a page in that of the browser. `tree` is the robot as files, `drawing` its
//! display, `input` its keys and gamepad, `refresh` how old readings are, `lines` where threads stand, `post` the mailbox,
//! `failure` how a failure reads; `asked` answers one question after the other.

pub mod asked;
pub mod drawing;
pub mod failure;
pub mod input;
pub mod lines;
pub mod post;
pub mod refresh;
pub mod tree;
mod words;
