//! `trik grade-worker`, `trik grade-submit` and `trik grade-status`: submissions in a queue, judged by any number of computers.
//!
//! Owns what these commands say. The queue is known to the crate `grading`, which is there with the feature `nats` alone; how one
//! submission is judged to `check`.

pub(crate) mod args;
#[cfg(feature = "nats")]
mod status;
#[cfg(feature = "nats")]
mod submit;
#[cfg(feature = "nats")]
mod way;
#[cfg(feature = "nats")]
mod worker;

use crate::refusal::Refusal;
use args::{StatusArgs, SubmitArgs, WorkerArgs};

/// Judges until somebody ends it.
///
/// # Errors
/// There are no tasks, or the server is not reached.
pub(crate) fn work(args: &WorkerArgs) -> Result<u8, Refusal> {
    #[cfg(feature = "nats")]
    return worker::serve(args);
    #[cfg(not(feature = "nats"))]
    missing(args)
}

/// Hands submissions in.
///
/// # Errors
/// A file cannot be read, or the server is not reached.
pub(crate) fn submit(args: &SubmitArgs) -> Result<u8, Refusal> {
    #[cfg(feature = "nats")]
    return submit::submit(args);
    #[cfg(not(feature = "nats"))]
    missing(args)
}

/// Tells how much is where.
///
/// # Errors
/// The server is not reached.
pub(crate) fn status(args: &StatusArgs) -> Result<u8, Refusal> {
    #[cfg(feature = "nats")]
    return status::status(args);
    #[cfg(not(feature = "nats"))]
    missing(args)
}

/// This program cannot.
#[cfg(not(feature = "nats"))]
fn missing<T>(_: &T) -> Result<u8, Refusal> {
    Err(Refusal::new(
        "this trik was built without queues: cargo build --release -p trik --features nats",
    ))
}
