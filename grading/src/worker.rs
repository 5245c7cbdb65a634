//! A worker: takes submissions from the queue, has them judged, and tells results.
//!
//! Owns the order in which it does so. A result is told before its submission is given back as done, and the server takes one result
//! for each, so one that is killed between the two loses nothing and doubles nothing: the submission comes again, its result is there,
//! and it is done. One that cannot be judged comes again after a pause, and is a dead letter after [`ATTEMPTS_MAX`] times.

use crate::error::{Blame, Error};
use crate::limits::{
    AGAIN_TIME, ATTEMPTS_MAX, BEAT_TIME, FETCH_TIME, REACH_TIME, RESULT_BYTES_MAX,
};
use crate::queue::{Queue, asked};
use crate::run::Ends;
use crate::submission::{Submission, id_of_rubbish};
use async_nats::jetstream::consumer::PullConsumer;
use async_nats::jetstream::{AckKind, Message};
use futures_util::StreamExt;
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use tokio::sync::{Semaphore, oneshot};
use tokio::time::{sleep, timeout};

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
    /// Nobody can judge it: its id, and why.
    Dead(String, String),
    /// No more are taken; those that are being judged are waited for.
    Ends,
    /// The server does not answer as it should; it is asked again.
    Server(Error),
}

/// What all submissions of a worker share.
struct Crew {
    queue: Queue,
    /// Those that have nothing to do.
    judges: Mutex<Vec<Sender<Case>>>,
    /// One for each of them.
    free: Semaphore,
    tell: Box<dyn Fn(News) + Send + Sync>,
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

/// Takes submissions until a signal comes, and ends when those that it has are judged, or at once with a second signal.
///
/// # Errors
/// The server does not let it take submissions, or there are no threads.
pub async fn serve(
    queue: Queue,
    judges: Vec<Box<dyn Judge>>,
    name: &str,
    tell: impl Fn(News) + Send + Sync + 'static,
    ends: &mut Ends,
) -> Result<(), Error> {
    let mut consumer = queue.consumer().await?;
    // While one is judged the next one is on its way.
    let most = judges.len() * 2;
    let crew = Arc::new(Crew {
        queue,
        free: Semaphore::new(judges.len()),
        judges: Mutex::new(judges.into_iter().map(seated).collect::<Result<_, _>>()?),
        tell: Box::new(tell),
        name: name.to_owned(),
    });
    let places = Arc::new(Semaphore::new(most));
    loop {
        let round = round(&crew, &consumer, &places);
        let came = tokio::select! {
            came = round => came,
            // What has come and is not taken goes to somebody else.
            () = ends.came() => break,
        };
        match came {
            Ok(0) => match renewed(&crew).await {
                Ok(Some(anew)) => consumer = anew,
                Ok(None) => {}
                Err(why) => (crew.tell)(News::Server(why)),
            },
            Ok(_) => {}
            Err(why) => {
                (crew.tell)(News::Server(why));
                sleep(REACH_TIME).await;
                // It may be gone with what the server kept.
                if let Ok(again) = crew.queue.consumer().await {
                    consumer = again;
                }
            }
        }
    }
    (crew.tell)(News::Ends);
    let all = u32::try_from(most).unwrap_or(u32::MAX);
    tokio::select! {
        _ = places.acquire_many(all) => {}
        // What it has comes again.
        () = ends.came() => {}
    }
    Ok(())
}

/// Takes as many submissions as there are free places, and says how many have come.
async fn round(
    crew: &Arc<Crew>,
    consumer: &PullConsumer,
    places: &Arc<Semaphore>,
) -> Result<usize, Error> {
    // Nobody closes the semaphore.
    let mut place = places.clone().acquire_owned().await.ok();
    let wanted = 1 + places.available_permits();
    let batch = consumer.fetch().max_messages(wanted).expires(FETCH_TIME);
    // A server that is gone answers nothing, and nobody says so.
    let Ok(batch) = timeout(FETCH_TIME * 2, batch.messages()).await else {
        return Ok(0);
    };
    let mut batch = batch.map_err(|why| asked("submissions", why))?;
    let mut count = 0;
    while let Ok(Some(message)) = timeout(FETCH_TIME * 2, batch.next()).await {
        let message = message.map_err(|why| asked("submissions", why))?;
        let own = match place.take() {
            Some(place) => Some(place),
            None => places.clone().acquire_owned().await.ok(),
        };
        let crew = crew.clone();
        tokio::spawn(async move {
            let _place = own;
            take(&crew, &message).await;
        });
        count += 1;
    }
    Ok(count)
}

/// A beginning of all that is there, if the server has forgotten to give it out.
async fn renewed(crew: &Crew) -> Result<Option<PullConsumer>, Error> {
    if !crew.queue.has_forgotten().await? {
        return Ok(None);
    }
    crew.queue.begin_anew().await.map(Some)
}

/// Takes one submission, and says meanwhile that it is still at work.
async fn take(crew: &Crew, message: &Message) {
    let work = async {
        // The server does not hear from it any more, and gives the submission to somebody.
        if let Err(why) = dispose(crew, message).await {
            (crew.tell)(News::Server(why));
            sleep(REACH_TIME).await;
        }
    };
    let beat = async {
        loop {
            sleep(BEAT_TIME).await;
            // If the server is gone it gives the submission to another one, and takes one result.
            let _ = message.ack_with(AckKind::Progress).await;
        }
    };
    tokio::select! {
        () = work => {}
        () = beat => {}
    }
}

/// Does with a submission what has to be done.
///
/// # Errors
/// The server does not answer: the submission comes again, and what was told of it is there then.
async fn dispose(crew: &Crew, message: &Message) -> Result<(), Error> {
    let submission = match Submission::read(message) {
        Ok(submission) => submission,
        Err(why) => return bury(crew, message, None, &why.to_string(), &[]).await,
    };
    let id = submission.id();
    if crew.queue.result(&id).await?.is_some() {
        done(message).await?;
        (crew.tell)(News::Again(id));
        return Ok(());
    }
    // Each worker that has taken it was killed before it said what became of it.
    let attempt = message.info().map_or(1, |info| info.delivered);
    if attempt > ATTEMPTS_MAX {
        let why =
            format!("{ATTEMPTS_MAX} workers have taken it, and none has said what became of it");
        return bury(crew, message, Some(&submission), &why, &[]).await;
    }
    match judged(crew, &submission).await? {
        Judged::Done(runs) => {
            let result = result(crew, Some(&submission), &id, &runs, None);
            tell(crew, &id, &result).await;
            (crew.tell)(News::Judged(submission));
            done(message).await?;
        }
        Judged::Failed(why, _) if attempt < ATTEMPTS_MAX => {
            let pause = AGAIN_TIME * u32::try_from(attempt).unwrap_or(1);
            let sent = message.ack_with(AckKind::Nak(Some(pause))).await;
            sent.map_err(|why| asked("a submission", why))?;
            (crew.tell)(News::Failed(submission, why));
        }
        Judged::Failed(why, runs) => bury(crew, message, Some(&submission), &why, &runs).await?,
    }
    Ok(())
}

/// Has it judged, when a judge is free.
async fn judged(crew: &Crew, submission: &Submission) -> Result<Judged, Error> {
    // Nobody closes the semaphore.
    let _turn = crew.free.acquire().await;
    let judges = || crew.judges.lock().unwrap_or_else(PoisonError::into_inner);
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

/// Makes a dead letter of it, and tells that as its result, so that the person who has handed it in hears of it.
async fn bury(
    crew: &Crew,
    message: &Message,
    submission: Option<&Submission>,
    why: &str,
    runs: &[Value],
) -> Result<(), Error> {
    // What is no submission is known by the hash of its payload.
    let id = match submission {
        Some(submission) => submission.id(),
        None => id_of_rubbish(message),
    };
    let headers = message.headers.clone().unwrap_or_default();
    let bytes = message.payload.to_vec();
    let result = result(crew, submission, &id, runs, Some(why));
    match crew.queue.bury(&id, headers, bytes, why).await {
        Ok(_) => {}
        // The server took it with these headers, and not with one more.
        Err(error) if error.blame() == Blame::Caller => {
            (crew.tell)(News::Server(error));
        }
        Err(error) => return Err(error),
    }
    tell(crew, &id, &result).await;
    (crew.tell)(News::Dead(id, why.to_owned()));
    done(message).await
}

/// Tells a result, however long the server is gone: it was work to have it.
async fn tell(crew: &Crew, id: &str, result: &str) {
    while let Err(why) = crew.queue.tell(id, result).await {
        let is_refused = why.blame() == Blame::Caller;
        (crew.tell)(News::Server(why));
        if is_refused {
            return;
        }
        sleep(REACH_TIME).await;
    }
}

/// It is done, and the server has heard of it.
async fn done(message: &Message) -> Result<(), Error> {
    let sent = message.double_ack().await;
    sent.map_err(|why| asked("a submission that is done", why))
}

/// A result as a text: a JSON object.
fn result(
    crew: &Crew,
    submission: Option<&Submission>,
    id: &str,
    runs: &[Value],
    dead: Option<&str>,
) -> String {
    let of = |runs: &[Value]| {
        json!({
            "id": id,
            "task": submission.map(Submission::task),
            "file": submission.map(Submission::file),
            "worker": crew.name,
            "dead": dead,
            "runs": runs,
        })
        .to_string()
    };
    let whole = of(runs);
    if whole.len() <= RESULT_BYTES_MAX {
        return whole;
    }
    // The server would refuse it: verdicts and points stay, what was said goes.
    let mut short = runs.to_vec();
    for field in short.iter_mut().filter_map(Value::as_object_mut) {
        for name in ["messages", "printed", "explain"] {
            field.remove(name);
        }
        field.insert("shortened".to_owned(), Value::Bool(true));
    }
    of(&short)
}
