//! Submissions in a queue, which any number of workers judge: on NATS JetStream, which keeps them.
//!
//! Nothing of a queue is written here: who has which submission, until when, and what is kept on a disk is known to the server. Here
//! is what goes in and comes out, and in which order a worker says so, so that a worker or a server that is killed loses nothing and
//! doubles nothing. It knows no robot: what judges is a [`Judge`].
//!
//! - `names`: streams and subjects
//! - `submission`: what somebody hands in, and by what it is known
//! - `queue`: the connection, and what can be asked of the server
//! - `worker`: takes submissions, has them judged, and tells results
//! - `wait`: for results, and for another state
//! - `run`: the runtime and the signals of commands
//! - `error`, `limits`

#![forbid(unsafe_code)]
#![deny(clippy::wildcard_enum_match_arm)]

pub mod error;
pub mod limits;
mod names;
pub mod queue;
pub mod run;
pub mod submission;
pub mod wait;
pub mod worker;

pub use error::Error;
pub use queue::{Queue, Settings, State};
pub use run::{Ends, run};
pub use submission::Submission;
pub use wait::{Waiter, watch};
pub use worker::{Judge, Judged, News};
