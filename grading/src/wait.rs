//! Waiting: for results of submissions, and for another state of the queue.
//!
//! Owns how often the server is asked. Results come by themselves, and are asked for as well: some are missing after the connection
//! was lost.

use crate::error::Error;
use crate::limits::{ASKED_MAX, LOOK_TIME, PATIENCE_MAX};
use crate::queue::{Queue, State};
use crate::run::Ends;
use async_nats::Subscriber;
use futures_util::StreamExt;
use std::collections::BTreeSet;
use std::time::Duration;
use tokio::time::{Instant, interval, sleep_until};

/// Hears of results from its beginning on.
pub struct Waiter {
    queue: Queue,
    results: Subscriber,
}

impl Waiter {
    /// To be made before anything is handed in, so that no result is missed.
    ///
    /// # Errors
    /// The connection is closed.
    pub async fn new(queue: &Queue) -> Result<Self, Error> {
        Ok(Self {
            results: queue.results().await?,
            queue: queue.clone(),
        })
    }

    /// Gives the result of each of these to `told`, until there are none left, the time is over or a signal comes. How many are missing.
    ///
    /// # Errors
    /// What `told` says.
    pub async fn wait<E>(
        mut self,
        mut missing: BTreeSet<String>,
        patience: Option<Duration>,
        ends: &mut Ends,
        mut told: impl FnMut(&str) -> Result<(), E>,
    ) -> Result<usize, E> {
        let end = Instant::now() + patience.unwrap_or(PATIENCE_MAX).min(PATIENCE_MAX);
        let mut asks = interval(LOOK_TIME);
        while !missing.is_empty() {
            tokio::select! {
                Some(message) = self.results.next() => {
                    let id = message.subject.rsplit('.').next().unwrap_or_default();
                    if missing.remove(id) {
                        told(&String::from_utf8_lossy(&message.payload))?;
                    }
                }
                _ = asks.tick() => self.ask(&mut missing, &mut told).await?,
                () = sleep_until(end) => break,
                () = ends.came() => break,
            }
        }
        Ok(missing.len())
    }

    /// Asks for some of those that have not come by themselves.
    async fn ask<E>(
        &self,
        missing: &mut BTreeSet<String>,
        told: &mut impl FnMut(&str) -> Result<(), E>,
    ) -> Result<(), E> {
        let ids: Vec<String> = missing.iter().take(ASKED_MAX).cloned().collect();
        for id in ids {
            match self.queue.result(&id).await {
                Ok(Some(result)) => {
                    missing.remove(&id);
                    told(&result)?;
                }
                Ok(None) => {}
                // It is gone, and will be back.
                Err(_) => return Ok(()),
            }
        }
        Ok(())
    }
}

/// Tells the state again and again, until a signal comes; None: the server does not answer.
pub async fn watch(queue: &Queue, ends: &mut Ends, mut tell: impl FnMut(Option<State>)) {
    let mut looks = interval(LOOK_TIME);
    loop {
        tokio::select! {
            _ = looks.tick() => tell(queue.state().await.ok()),
            () = ends.came() => return,
        }
    }
}
