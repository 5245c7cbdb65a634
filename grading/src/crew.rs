//! What all submissions of a worker share: its judges, and how results are told.
//!
//! Owns the threads of judges, and that a result is told however long the server is gone. Knows nothing of where submissions come from.

use crate::error::{Blame, Error};
use crate::limits::REACH_TIME;
use crate::outcome::Draft;
use crate::queue::Queue;
use crate::submission::Submission;
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use tokio::sync::{Semaphore, oneshot};
use tokio::time::sleep;

/// What judges one submission at a time, and may take long.
pub trait Judge: Send + 'static {
    /// Judges it.
    fn judge(&mut self, submission: &Submission) -> Judged;
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub enum Judged {
    /// A JSON object for each run.
    Done(Vec<Value>),
    /// It was kept from being judged, and another worker, or another time, may do better: why, and what is known of its runs.
    Failed(String, Vec<Value>),
}

/// What a worker tells of a submission.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum News {
    /// Its result is told.
    Judged(Submission),
    /// Its result was there.
    Again(String),
    /// It could not be judged, and will be taken again.
    Failed(Submission, String),
    /// Nobody can judge it: its id, what it is unless it is no submission, and why.
    Dead(String, Option<Submission>, String),
    /// No more are taken; those that are being judged are waited for.
    Ends,
    /// The server does not answer as it should; it is asked again.
    Server(Error),
}

/// What all submissions of a worker share.
pub(crate) struct Crew {
    pub queue: Queue,
    /// Those that have nothing to do.
    judges: Mutex<Vec<Sender<Case>>>,
    /// One for each of them.
    free: Semaphore,
    /// Hears what happens.
    pub news: Box<dyn Fn(News) + Send + Sync>,
    /// Who tells results.
    name: String,
}

/// A submission for a judge, and the way back.
type Case = (Submission, oneshot::Sender<Judged>);

/// A judge on a thread of its own for as long as the worker: processes that a judge has started may end with their thread.
fn seated(mut judge: Box<dyn Judge>) -> Result<Sender<Case>, Error> {
    let (sender, cases) = channel::<Case>();
    let work = move || {
        for (submission, answer) in cases {
            let judged = catch_unwind(AssertUnwindSafe(|| judge.judge(&submission)));
            let defect = |_| Judged::Failed("the judge has a defect".to_owned(), Vec::new());
            // Nobody waits any more: the submission comes again.
            let _ = answer.send(judged.unwrap_or_else(defect));
        }
    };
    let thread = thread::Builder::new().name("judge".to_owned()).spawn(work);
    thread.map_err(|why| Error::Machine(why.to_string()))?;
    Ok(sender)
}

impl Crew {
    /// Judges that have nothing to do yet.
    ///
    /// # Errors
    /// There are no threads.
    pub fn new(
        queue: Queue,
        judges: Vec<Box<dyn Judge>>,
        name: &str,
        news: impl Fn(News) + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        Ok(Self {
            queue,
            free: Semaphore::new(judges.len()),
            judges: Mutex::new(judges.into_iter().map(seated).collect::<Result<_, _>>()?),
            news: Box::new(news),
            name: name.to_owned(),
        })
    }

    /// Has it judged, when a judge is free.
    ///
    /// # Errors
    /// There is no judge any more.
    pub async fn judged(&self, submission: &Submission) -> Result<Judged, Error> {
        // Nobody closes the semaphore.
        let _turn = self.free.acquire().await;
        let judges = || self.judges.lock().unwrap_or_else(PoisonError::into_inner);
        let missing = || Error::Machine("there is no judge".to_owned());
        let judge = judges().pop().ok_or_else(missing)?;
        let (answer, judged) = oneshot::channel();
        let given = judge.send((submission.clone(), answer));
        let judged = match given {
            Ok(()) => judged.await.map_err(|_| missing()),
            Err(_) => Err(missing()),
        };
        judges().push(judge);
        judged
    }

    /// Keeps it as a dead letter, and tells that as its result.
    ///
    /// # Errors
    /// The server does not answer.
    pub async fn tell_dead(
        &self,
        id: &str,
        submission: Option<&Submission>,
        bytes: Vec<u8>,
        why: &str,
        runs: &[Value],
    ) -> Result<(), Error> {
        let kept = self.queue.bury(id, submission, bytes, why).await;
        let kept = match kept {
            // The server took it with its header, and not with one more: that it was there is kept.
            Err(error) if error.blame() == Blame::Caller => {
                self.queue.bury(id, submission, Vec::new(), why).await
            }
            kept => kept,
        };
        kept?;
        self.tell(id, submission, runs, Some(why)).await;
        Ok(())
    }

    /// Tells a result, however long the server is gone: it was work to have it.
    pub async fn tell(
        &self,
        id: &str,
        submission: Option<&Submission>,
        runs: &[Value],
        dead: Option<&str>,
    ) {
        let draft = Draft {
            id,
            submission,
            worker: &self.name,
            runs,
            dead,
        };
        loop {
            let text = draft.text(self.queue.result_bytes_max());
            let Err(why) = self.queue.tell(draft.id, &text).await else {
                return;
            };
            let is_refused = why.blame() == Blame::Caller;
            (self.news)(News::Server(why));
            if is_refused {
                return;
            }
            sleep(REACH_TIME).await;
        }
    }
}
