//! What commands above the queue run in: one thread that waits for the server and for the person.
//!
//! Owns the runtime, and the signals that end a command.

use crate::error::Error;
use std::future::Future;
use tokio::runtime::Builder;
use tokio::signal::unix::{Signal, SignalKind, signal};

/// Does something that waits for a server.
///
/// # Errors
/// There is no runtime, or what `work` says.
pub fn run<T, E: From<Error>>(work: impl Future<Output = Result<T, E>>) -> Result<T, E> {
    let runtime = Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|why| Error::Machine(why.to_string()))?;
    runtime.block_on(work)
}

/// Ctrl-C and what else ends a command. Within [`run`] alone.
#[derive(Debug)]
pub struct Ends(Signal, Signal);

impl Ends {
    /// From now on.
    ///
    /// # Errors
    /// The system gives no signals.
    pub fn new() -> Result<Self, Error> {
        let of = |kind| signal(kind).map_err(|why| Error::Machine(format!("signals: {why}")));
        Ok(Self(
            of(SignalKind::interrupt())?,
            of(SignalKind::terminate())?,
        ))
    }

    /// When the next one has come.
    pub async fn came(&mut self) {
        tokio::select! {
            _ = self.0.recv() => {}
            _ = self.1.recv() => {}
        }
    }
}
