//! A worker: takes submissions from the queue, has them judged, and tells results.
//!
//! Owns the order in which it does so. A result is told before its submission is given back as done, and the server takes one result
//! for each, so one that is killed between the two loses nothing and doubles nothing: the submission comes again, its result is there,
//! and it is done. One that cannot be judged comes again after a pause, and is a dead letter after [`ATTEMPTS_MAX`] times.

use crate::crew::{Crew, Judge, Judged, News};
use crate::error::Error;
use crate::limits::{AGAIN_TIME, ATTEMPTS_MAX, BEAT_TIME, FETCH_TIME, LOSSES_MAX, REACH_TIME};
use crate::queue::Queue;
use crate::run::Ends;
use crate::submission::{Submission, id_of_rubbish};
use crate::sweep::Sweep;
use async_nats::jetstream::consumer::PullConsumer;
use async_nats::jetstream::{AckKind, Message};
use futures_util::StreamExt;
use serde_json::Value;
use std::sync::Arc;
use tokio::sync::{Semaphore, watch};
use tokio::time::{sleep, timeout};

/// Takes submissions until a signal comes, and ends when those that it has are judged, or at once with a second signal.
///
/// # Errors
/// The server does not let it take submissions, or there are no threads.
pub async fn serve(
    queue: Queue,
    judges: Vec<Box<dyn Judge>>,
    name: &str,
    news: impl Fn(News) + Send + Sync + 'static,
    ends: &mut Ends,
) -> Result<(), Error> {
    let mut consumer = queue.consumer().await?;
    // While one is judged the next one is on its way.
    let most = judges.len() * 2;
    let crew = Arc::new(Crew::new(queue, judges, name, news)?);
    let places = Arc::new(Semaphore::new(most));
    let mut losses = crew.queue.losses();
    let mut sweep = Sweep::default();
    loop {
        let work = async {
            let came = round(&crew, &consumer, &places, &mut losses).await;
            next(&crew, came, &mut sweep).await
        };
        tokio::select! {
            anew = work => if let Some(anew) = anew { consumer = anew },
            // What has come and is not taken goes to somebody else.
            () = ends.came() => break,
        }
    }
    (crew.news)(News::Ends);
    let all = u32::try_from(most).unwrap_or(u32::MAX);
    tokio::select! {
        _ = places.acquire_many(all) => {}
        // What it has comes again.
        () = ends.came() => {}
    }
    Ok(())
}

/// What came of asking for submissions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Came {
    /// As many as there were places for.
    All,
    /// Fewer, and so many.
    Fewer(usize),
    /// The connection was lost: by the server, or by a message that harms it.
    Lost,
}

/// What follows a round: a look for what harms, and another consumer, if the one before is no use any more.
async fn next(crew: &Crew, came: Result<Came, Error>, sweep: &mut Sweep) -> Option<PullConsumer> {
    let done = async {
        let (was_lost, is_idle, failed) = match came {
            Ok(Came::All) => return Ok(None),
            Ok(Came::Fewer(count)) => (false, count == 0, None),
            Ok(Came::Lost) => (true, false, None),
            Err(why) => (false, false, Some(why)),
        };
        // A message can look as if the server had refused.
        if sweep.run(crew, was_lost).await? {
            return Ok(None);
        }
        match failed {
            Some(why) => Err(why),
            None if is_idle => renewed(crew).await,
            None => Ok(None),
        }
    };
    match done.await {
        Ok(anew) => anew,
        Err(why) => {
            (crew.news)(News::Server(why));
            sleep(REACH_TIME).await;
            // It may be gone with what the server kept.
            crew.queue.consumer().await.ok()
        }
    }
}

/// Takes as many submissions as there are free places.
async fn round(
    crew: &Arc<Crew>,
    consumer: &PullConsumer,
    places: &Arc<Semaphore>,
    losses: &mut watch::Receiver<u32>,
) -> Result<Came, Error> {
    // Nobody closes the semaphore.
    let mut place = places.clone().acquire_owned().await.ok();
    let wanted = 1 + places.available_permits();
    let batch = consumer.fetch().max_messages(wanted).expires(FETCH_TIME);
    // A server that is gone answers nothing, and nobody says so.
    let Ok(batch) = timeout(FETCH_TIME * 2, batch.messages()).await else {
        return Ok(Came::Fewer(0));
    };
    let mut batch = batch.map_err(|why| Error::asked("submissions", why))?;
    let mut count = 0;
    loop {
        let message = tokio::select! {
            biased;
            message = timeout(FETCH_TIME * 2, batch.next()) => message,
            // Nobody closes the channel.
            _ = losses.changed() => return Ok(Came::Lost),
        };
        let Ok(Some(message)) = message else { break };
        let message = message.map_err(|why| Error::asked("submissions", why))?;
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
    Ok(match count == wanted {
        true => Came::All,
        false => Came::Fewer(count),
    })
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
            (crew.news)(News::Server(why));
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
    match crew.queue.result(&id).await? {
        Some(Ok(_)) => {
            done(message).await?;
            (crew.news)(News::Again(id));
            return Ok(());
        }
        Some(Err(why)) => {
            (crew.news)(News::Server(why));
            crew.queue.forget_result(&id).await?;
        }
        None => {}
    }
    // Each worker that has taken it was killed before it said what became of it.
    let attempt = message.info().map_or(1, |info| info.delivered);
    if attempt > LOSSES_MAX {
        let why =
            format!("{LOSSES_MAX} workers have taken it, and none has said what became of it");
        return bury(crew, message, Some(&submission), &why, &[]).await;
    }
    match crew.judged(&submission).await? {
        Judged::Done(runs) => {
            crew.tell(&id, Some(&submission), &runs, None).await;
            (crew.news)(News::Judged(submission));
            done(message).await?;
        }
        Judged::Failed(why, _) if attempt < ATTEMPTS_MAX => {
            let pause = AGAIN_TIME * u32::try_from(attempt).unwrap_or(1);
            let sent = message.ack_with(AckKind::Nak(Some(pause))).await;
            sent.map_err(|why| Error::asked("a submission", why))?;
            (crew.news)(News::Failed(submission, why));
        }
        Judged::Failed(why, runs) => bury(crew, message, Some(&submission), &why, &runs).await?,
    }
    Ok(())
}

/// Makes a dead letter of it, and tells that as its result, so that the person who has handed it in hears of it.
async fn bury(
    crew: &Crew,
    message: &Message,
    submission: Option<&Submission>,
    why: &str,
    runs: &[Value],
) -> Result<(), Error> {
    let id = match submission {
        Some(submission) => submission.id(),
        None => id_of_rubbish(&message.subject, &message.payload),
    };
    let bytes = message.payload.to_vec();
    crew.tell_dead(&id, submission, bytes, why, runs).await?;
    (crew.news)(News::Dead(id, submission.cloned(), why.to_owned()));
    done(message).await
}

/// It is done, and the server has heard of it.
async fn done(message: &Message) -> Result<(), Error> {
    let sent = message.double_ack().await;
    sent.map_err(|why| Error::asked("a submission that is done", why))
}
