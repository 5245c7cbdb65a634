//! Who goes first when the processor is short: what stops motors, then what serves, then programs.
//!
//! Owns the numbers, as nice(2) has them. A controller has one core, and a program that loops must not keep a stop
//! waiting for its turn.

use crate::{limits, log};

/// What a thread or process does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Rank {
    /// Brings motors to rest or waits for the stop key, and does nothing else.
    Rest,
    /// Serves clients.
    Serving,
    /// Is a program.
    Program,
}

/// Gives the calling thread, and what it starts from now on, its rank. Only root can go before others: everybody else
/// keeps what they have, and programs go behind them all the same.
pub fn set(rank: Rank) {
    let nice = match rank {
        Rank::Rest => limits::NICE_REST,
        Rank::Serving => limits::NICE_SERVING,
        Rank::Program => limits::NICE_PROGRAM,
    };
    // None: the calling thread (setpriority(2), Linux).
    if let Err(error) = rustix::process::setpriority_process(None, nice) {
        tracing::debug!(target: log::DAEMON, "{rank:?} keeps its priority: {error}");
    }
    if rank == Rank::Program {
        // Where each session has a share of its own (sched(7), autogroup), this is the number that counts.
        let _ = std::fs::write("/proc/self/autogroup", nice.to_string());
    }
}
