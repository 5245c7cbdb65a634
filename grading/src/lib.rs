//! Submissions in a queue, which any number of workers judge: on NATS JetStream, which keeps them.
//!
//! Nothing of a queue is written here: who has which submission, until when, and what is kept on a disk is known to the server. Here
//! is what goes in and comes out, and in which order a worker says so, so that a worker or a server that is killed loses nothing and
//! doubles nothing. It knows no robot: what judges is a [`Judge`].
//!
//! - `names`: streams and subjects
//! - `submission`: what somebody hands in, and by what it is known
//! - `outcome`: a result
//! - `kept`: what a stream has, without being harmed by it
//! - `queue`: the connection, and what can be asked of the server
//! - `worker`: takes submissions, and decides what becomes of each
//! - `crew`: judges, and how results are told
//! - `sweep`: puts aside what no worker can be given
//! - `wait`: for results, and for another state
//! - `run`: the runtime and the signals of commands
//! - `error`, `limits`

#![forbid(unsafe_code)]
#![deny(clippy::wildcard_enum_match_arm)]

mod crew;
pub mod error;
mod kept;
pub mod limits;
mod names;
pub mod outcome;
pub mod queue;
pub mod run;
pub mod submission;
mod sweep;
pub mod wait;
pub mod worker;

pub use crew::{Judge, Judged, News};
pub use error::Error;
pub use outcome::Outcome;
pub use queue::{DeadLetter, Queue, Settings, State};
pub use run::{Ends, run};
pub use submission::Submission;
pub use wait::{Look, Waiter, watch};
