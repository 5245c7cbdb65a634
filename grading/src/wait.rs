//! Waiting: for results of submissions, and for another state of the queue.
//!
//! Owns how often the server is asked. Results come by themselves, and are asked for as well: some are missing after the connection
//! was lost.

use crate::error::Error;
use crate::limits::{ASKED_MAX, LOOK_TIME, PATIENCE_MAX, PUT_AGAIN_TIME};
use crate::outcome::Outcome;
use crate::queue::{DeadLetter, Queue, State};
use crate::run::Ends;
use crate::submission::Submission;
use async_nats::Subscriber;
use futures_util::StreamExt;
use std::collections::BTreeMap;
use std::time::Duration;
use tokio::time::{Instant, interval, interval_at, sleep_until};

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

    /// Gives the result of each of these to `told`, or why what stands for it is none, until there are none left, the time is over or a
    /// signal comes. How many are missing. What waits long is handed in once more, should the server have lost it or something else
    /// have stood in its place.
    ///
    /// # Errors
    /// What `told` says.
    pub async fn wait<E>(
        mut self,
        mut missing: BTreeMap<String, &Submission>,
        patience: Option<Duration>,
        ends: &mut Ends,
        mut told: impl FnMut(&str, Result<Outcome, Error>) -> Result<(), E>,
    ) -> Result<usize, E> {
        let end = Instant::now() + patience.unwrap_or(PATIENCE_MAX).min(PATIENCE_MAX);
        let mut asks = interval(LOOK_TIME);
        let mut puts = interval_at(Instant::now() + PUT_AGAIN_TIME, PUT_AGAIN_TIME);
        while !missing.is_empty() {
            tokio::select! {
                Some(message) = self.results.next() => {
                    let id = message.subject.rsplit('.').next().unwrap_or_default();
                    if missing.remove(id).is_some() {
                        told(id, Outcome::read(id, &message.payload))?;
                    }
                }
                _ = asks.tick() => self.ask(&mut missing, &mut told).await?,
                _ = puts.tick() => self.put_again(&missing).await,
                () = sleep_until(end) => break,
                () = ends.came() => break,
            }
        }
        Ok(missing.len())
    }

    /// Asks for some of those that have not come by themselves.
    async fn ask<E>(
        &self,
        missing: &mut BTreeMap<String, &Submission>,
        told: &mut impl FnMut(&str, Result<Outcome, Error>) -> Result<(), E>,
    ) -> Result<(), E> {
        let ids: Vec<String> = missing.keys().take(ASKED_MAX).cloned().collect();
        for id in ids {
            match self.queue.result(&id).await {
                Ok(Some(result)) => {
                    missing.remove(&id);
                    told(&id, result)?;
                }
                Ok(None) => {}
                // It is gone, and will be back.
                Err(_) => return Ok(()),
            }
        }
        Ok(())
    }

    /// Hands some in once more. The server refuses those that it has, and a worker drops those that are judged.
    async fn put_again(&self, missing: &BTreeMap<String, &Submission>) {
        for submission in missing.values().take(ASKED_MAX) {
            if self.queue.put_submission(submission).await.is_err() {
                return;
            }
        }
    }
}

/// How the queue is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Look {
    /// How much is where.
    pub state: State,
    /// The oldest ones that were put aside.
    pub dead: Vec<DeadLetter>,
}

impl Look {
    /// As it is now.
    ///
    /// # Errors
    /// The server does not answer.
    pub async fn at(queue: &Queue) -> Result<Self, Error> {
        Ok(Self {
            state: queue.state().await?,
            dead: queue.dead_letters().await?,
        })
    }
}

/// Tells how the queue is again and again, until a signal comes; None: the server does not answer.
pub async fn watch(queue: &Queue, ends: &mut Ends, mut tell: impl FnMut(Option<Look>)) {
    let mut looks = interval(LOOK_TIME);
    loop {
        tokio::select! {
            _ = looks.tick() => tell(Look::at(queue).await.ok()),
            () = ends.came() => return,
        }
    }
}
