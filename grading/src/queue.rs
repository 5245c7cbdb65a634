//! The server: its streams, what is put into them, and what can be asked.
//!
//! Owns the connection, which comes back by itself, and that nothing is in a stream twice: each message is the first of its subject,
//! or the server refuses it. What a stream keeps is read by `kept` alone.

use crate::error::Error;
use crate::kept::{Kept, Which, fields, kept};
use crate::limits::{ACK_TIME, ANSWER_TIME, REACH_TIME, SHOWN_MAX, TAKEN_MAX};
use crate::names::{
    DEAD, DEAD_LETTERS, FILE, RESULT, RESULTS, SUBMISSIONS, SUBMIT, TASK, WHY, WORKERS,
};
use crate::outcome::Outcome;
use crate::submission::Submission;
use async_nats::jetstream::consumer::{AckPolicy, PullConsumer, pull};
use async_nats::jetstream::context::PublishErrorKind;
use async_nats::jetstream::message::PublishMessage;
use async_nats::jetstream::stream::{Config, DiscardPolicy, RetentionPolicy, Stream};
use async_nats::jetstream::{Context, context};
use async_nats::{Client, ConnectOptions, Event, HeaderMap, Subscriber};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::watch;

/// Where the server is, and who asks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Its address: `HOST`, `HOST:PORT`, `nats://...` or `tls://...`; several with commas between them are one cluster.
    pub server: String,
    /// Name and password.
    pub login: Option<(String, String)>,
    /// Certificates of those who vouch for the server, as PEM; None: those whom this computer trusts.
    pub authority: Option<PathBuf>,
    /// What the server calls this connection, for those who look there.
    pub name: String,
}

/// How much is where.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    /// Submissions that no worker has.
    pub waiting: u64,
    /// Submissions that a worker has.
    pub taken: u64,
    /// Submissions that were judged.
    pub judged: u64,
    /// Submissions that nobody could judge.
    pub dead: u64,
}

/// What became of a submission that was handed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Receipt {
    /// It waits.
    Taken,
    /// It was there already, and waits.
    Waits,
    /// Something that is not this submission is in its place; a worker puts that aside.
    Blocked,
    /// It was judged before.
    Judged,
}

/// A submission that was put aside, for a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeadLetter {
    /// Its id.
    pub id: String,
    /// The task and the file; None: it was no submission.
    pub what: Option<(String, String)>,
    /// Why nobody could judge it.
    pub why: String,
}

/// Which submissions workers have been given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Progress {
    /// All up to this one are done.
    pub done: u64,
    /// None after this one was given to anybody.
    pub last: u64,
}

/// The way to a server.
#[derive(Clone)]
pub struct Queue {
    client: Client,
    context: Context,
    submissions: Stream,
    results: Stream,
    dead: Stream,
    losses: watch::Receiver<u32>,
}

impl Queue {
    /// Connects, and makes the streams if they are not there. `tell` hears when the connection is lost and is back.
    ///
    /// # Errors
    /// The server is not reached, does not let us in, or keeps no streams.
    pub async fn open(
        settings: &Settings,
        tell: impl Fn(bool) + Send + Sync + 'static,
    ) -> Result<Self, Error> {
        let (client, losses) = connect(settings, tell).await?;
        let context = context::ContextBuilder::new()
            .timeout(ANSWER_TIME)
            .ack_timeout(ANSWER_TIME)
            .build(client.clone());
        let stream = async |name: &'static str, subject: &str, retention| {
            let config = Config {
                name: name.to_owned(),
                subjects: vec![format!("{subject}*")],
                retention,
                max_messages_per_subject: 1,
                discard: DiscardPolicy::New,
                discard_new_per_subject: true,
                ..Config::default()
            };
            let stream = context.get_or_create_stream(config).await;
            let stream = stream.map_err(|why| Error::Streams(why.to_string()))?;
            // One that somebody else has made would give things twice, or keep what is done.
            let has = &stream.cached_info().config;
            let is_ours = has.retention == retention
                && has.discard == DiscardPolicy::New
                && has.discard_new_per_subject
                && has.max_messages_per_subject == 1
                && has.subjects == [format!("{subject}*")];
            match is_ours {
                true => Ok(stream),
                false => Err(Error::Foreign(name)),
            }
        };
        Ok(Self {
            submissions: stream(SUBMISSIONS, SUBMIT, RetentionPolicy::WorkQueue).await?,
            results: stream(RESULTS, RESULT, RetentionPolicy::Limits).await?,
            dead: stream(DEAD_LETTERS, DEAD, RetentionPolicy::Limits).await?,
            client,
            context,
            losses,
        })
    }

    /// How often the connection was lost.
    pub(crate) fn losses(&self) -> watch::Receiver<u32> {
        self.losses.clone()
    }

    /// Hands a submission in; one that was put aside is judged anew.
    ///
    /// # Errors
    /// It is too large for the server, or that does not answer.
    pub async fn submit(&self, submission: &Submission) -> Result<Receipt, Error> {
        let id = submission.id();
        match self.result(&id).await? {
            Some(Ok(result)) if result.dead().is_none() => return Ok(Receipt::Judged),
            // Nobody could judge it, and somebody wants to know whether that is still so. Or it is no result at all.
            Some(_) => {
                self.forget(&self.dead, &format!("{DEAD}{id}")).await?;
                self.forget_result(&id).await?;
            }
            None => {}
        }
        if self.put_submission(submission).await? {
            return Ok(Receipt::Taken);
        }
        let newest = format!("{SUBMIT}{id}");
        let there = kept(&self.context, SUBMISSIONS, Which::Newest(&newest)).await?;
        Ok(match there.map(|there| Submission::kept(&there)) {
            Some(Err(_)) => Receipt::Blocked,
            // Without one it was judged meanwhile.
            Some(Ok(_)) | None => Receipt::Waits,
        })
    }

    /// Hands a submission in. False: its place is not free.
    pub(crate) async fn put_submission(&self, submission: &Submission) -> Result<bool, Error> {
        let (id, bytes) = (submission.id(), submission.bytes().to_vec());
        self.put(SUBMIT, &id, submission.headers(), bytes).await
    }

    /// What stands as the result of a submission, if there is something: its result, or why it is none.
    ///
    /// # Errors
    /// The server does not answer.
    pub async fn result(&self, id: &str) -> Result<Option<Result<Outcome, Error>>, Error> {
        let subject = format!("{RESULT}{id}");
        let there = kept(&self.context, RESULTS, Which::Newest(&subject)).await?;
        Ok(there.map(|there| Outcome::read(id, &there.bytes)))
    }

    /// Takes away what stands as the result of a submission.
    pub(crate) async fn forget_result(&self, id: &str) -> Result<(), Error> {
        self.forget(&self.results, &format!("{RESULT}{id}")).await
    }

    /// Results as they come. Some are missing after the connection was lost: [`Queue::result`] has them.
    ///
    /// # Errors
    /// The connection is closed.
    pub async fn results(&self) -> Result<Subscriber, Error> {
        let all = self.client.subscribe(format!("{RESULT}*")).await;
        all.map_err(|why| Error::asked("results", why))
    }

    /// How much is where.
    ///
    /// # Errors
    /// The server does not answer.
    pub async fn state(&self) -> Result<State, Error> {
        let all = count(&self.submissions).await?;
        let info = self.submissions.consumer_info(WORKERS).await;
        let (waiting, taken) = match info {
            Ok(info) => (info.num_pending, info.num_ack_pending as u64),
            // There never was a worker, so nobody has one.
            Err(_) => (all, 0),
        };
        let dead = count(&self.dead).await?;
        Ok(State {
            waiting,
            taken,
            judged: count(&self.results).await?.saturating_sub(dead),
            dead,
        })
    }

    /// Submissions that were put aside: the oldest ones.
    ///
    /// # Errors
    /// The server does not answer.
    pub async fn dead_letters(&self) -> Result<Vec<DeadLetter>, Error> {
        let (mut all, mut from) = (Vec::new(), 1);
        while all.len() < SHOWN_MAX {
            let next = kept(&self.context, DEAD_LETTERS, Which::From(from, DEAD)).await?;
            let Some(there) = next else { break };
            from = there.sequence + 1;
            let fields = fields(&there.header).unwrap_or_default();
            let of = |name| {
                let found = fields.iter().find(|(other, _)| *other == name);
                found.map(|(_, value)| (*value).to_owned())
            };
            all.push(DeadLetter {
                id: there.subject.trim_start_matches(DEAD).to_owned(),
                what: of(TASK).zip(of(FILE)),
                why: of(WHY).unwrap_or_default(),
            });
        }
        Ok(all)
    }

    /// Which submissions workers have been given.
    pub(crate) async fn given(&self) -> Result<Progress, Error> {
        let info = self.submissions.consumer_info(WORKERS).await;
        let info = info.map_err(|why| Error::asked("the state", why))?;
        Ok(Progress {
            done: info.ack_floor.stream_sequence,
            last: info.delivered.stream_sequence,
        })
    }

    /// The first submission from this place on.
    pub(crate) async fn submission_from(&self, sequence: u64) -> Result<Option<Kept>, Error> {
        kept(&self.context, SUBMISSIONS, Which::From(sequence, SUBMIT)).await
    }

    /// Takes a message away from submissions, whatever it is. Another worker may have done so.
    pub(crate) async fn drop_submission(&self, sequence: u64) -> Result<(), Error> {
        match self.submissions.delete_message(sequence).await {
            Ok(_) => Ok(()),
            Err(_) if !self.is_submission(sequence).await? => Ok(()),
            Err(why) => Err(Error::asked("what is no submission", why)),
        }
    }

    async fn is_submission(&self, sequence: u64) -> Result<bool, Error> {
        let there = self.submission_from(sequence).await?;
        Ok(there.is_some_and(|there| there.sequence == sequence))
    }

    /// Whether submissions are there that the server gives to nobody: one that was killed can keep a submission and forget that it has
    /// to be given out.
    pub(crate) async fn has_forgotten(&self) -> Result<bool, Error> {
        let all = count(&self.submissions).await?;
        let info = self.submissions.consumer_info(WORKERS).await;
        let info = info.map_err(|why| Error::asked("the state", why))?;
        Ok(all > 0 && info.num_pending == 0 && info.num_ack_pending == 0)
    }

    /// All that is there is given out anew. What is judged is known by its result.
    pub(crate) async fn begin_anew(&self) -> Result<PullConsumer, Error> {
        // Another worker may have done so.
        let _ = self.submissions.delete_consumer(WORKERS).await;
        self.consumer().await
    }

    /// What all workers take submissions from.
    pub(crate) async fn consumer(&self) -> Result<PullConsumer, Error> {
        let config = pull::Config {
            durable_name: Some(WORKERS.to_owned()),
            ack_policy: AckPolicy::Explicit,
            ack_wait: ACK_TIME,
            max_ack_pending: TAKEN_MAX,
            ..pull::Config::default()
        };
        let consumer = self.submissions.get_or_create_consumer(WORKERS, config);
        let consumer: PullConsumer = consumer
            .await
            .map_err(|why| Error::asked("submissions", why))?;
        // One that somebody else has made would forget submissions, or give them to two.
        let has = &consumer.cached_info().config;
        let is_ours = has.ack_policy == AckPolicy::Explicit
            && has.ack_wait == ACK_TIME
            && has.max_deliver <= 0
            && has.filter_subject.is_empty()
            && !has.headers_only;
        is_ours.then_some(consumer).ok_or(Error::Foreign(WORKERS))
    }

    /// Bytes that the server takes as a result.
    pub(crate) fn result_bytes_max(&self) -> usize {
        /// A header is counted too.
        const HEADER_BYTES: usize = 1 << 10;
        let most = self.client.server_info().max_payload;
        most.saturating_sub(HEADER_BYTES)
    }

    /// Tells a result. False: there was one.
    pub(crate) async fn tell(&self, id: &str, result: &str) -> Result<bool, Error> {
        let result = result.as_bytes().to_vec();
        self.put(RESULT, id, HeaderMap::new(), result).await
    }

    /// Puts something aside that nobody can judge. Of its header only what is ours goes on: the server would do as the rest says.
    pub(crate) async fn bury(
        &self,
        id: &str,
        submission: Option<&Submission>,
        bytes: Vec<u8>,
        why: &str,
    ) -> Result<bool, Error> {
        let mut headers = submission.map_or_else(HeaderMap::new, Submission::headers);
        // A header is one line.
        let why: String = why
            .chars()
            .map(|letter| if letter.is_control() { ' ' } else { letter })
            .collect();
        headers.insert(WHY, why.as_str());
        self.put(DEAD, id, headers, bytes).await
    }

    /// Takes what a stream has of a subject away, if there is something.
    async fn forget(&self, stream: &Stream, subject: &str) -> Result<(), Error> {
        let name = &stream.cached_info().config.name;
        let Some(there) = kept(&self.context, name, Which::Newest(subject)).await? else {
            return Ok(());
        };
        let gone = stream.delete_message(there.sequence).await;
        gone.map(drop)
            .map_err(|why| Error::asked("what was put aside", why))
    }

    /// Puts the first message of a subject. False: there was one.
    async fn put(
        &self,
        subject: &str,
        id: &str,
        headers: HeaderMap,
        bytes: Vec<u8>,
    ) -> Result<bool, Error> {
        let (size, most) = (bytes.len(), self.client.server_info().max_payload);
        let message = PublishMessage::build()
            .payload(bytes.into())
            .headers(headers)
            .expected_last_subject_sequence(0);
        let sent = self.context.send_publish(format!("{subject}{id}"), message);
        let answer = match sent.await {
            Ok(answer) => answer.await,
            Err(why) => Err(why),
        };
        match answer {
            Ok(_) => Ok(true),
            Err(why) => match why.kind() {
                PublishErrorKind::WrongLastSequence => Ok(false),
                PublishErrorKind::MaxPayloadExceeded => Err(Error::TooLarge(size, most)),
                PublishErrorKind::StreamNotFound
                | PublishErrorKind::WrongLastMessageId
                | PublishErrorKind::TimedOut
                | PublishErrorKind::BrokenPipe
                | PublishErrorKind::MaxAckPending
                | PublishErrorKind::Other => Err(Error::asked("a message", why)),
            },
        }
    }
}

/// Connects, and counts how often the connection is lost.
async fn connect(
    settings: &Settings,
    tell: impl Fn(bool) + Send + Sync + 'static,
) -> Result<(Client, watch::Receiver<u32>), Error> {
    let tell = Arc::new(tell);
    let (lost, losses) = watch::channel(0);
    let lost = Arc::new(lost);
    let mut options = ConnectOptions::new()
        .name(&settings.name)
        .request_timeout(Some(ANSWER_TIME))
        // The first attempt waits for nothing.
        .reconnect_delay_callback(|attempts| match attempts {
            0 | 1 => Duration::ZERO,
            _ => REACH_TIME,
        })
        .event_callback(move |event| {
            let is_there = match event {
                Event::Connected => Some(true),
                Event::Disconnected => Some(false),
                Event::LameDuckMode
                | Event::Draining
                | Event::Closed
                | Event::SlowConsumer(_)
                | Event::ServerError(_)
                | Event::ClientError(_) => None,
            };
            let (tell, lost) = (tell.clone(), lost.clone());
            async move {
                if let Some(is_there) = is_there {
                    tell(is_there);
                }
                if is_there == Some(false) {
                    lost.send_modify(|count: &mut u32| *count = count.wrapping_add(1));
                }
            }
        });
    if let Some((user, password)) = &settings.login {
        options = options.user_and_password(user.clone(), password.clone());
    }
    if let Some(path) = &settings.authority {
        options = options.add_root_certificates(path.clone());
    }
    let servers: Vec<&str> = settings.server.split(',').map(str::trim).collect();
    let client = options.connect(&servers[..]).await;
    let client = client.map_err(|why| Error::Reach(settings.server.clone(), why.to_string()))?;
    Ok((client, losses))
}

/// How much a stream has.
async fn count(stream: &Stream) -> Result<u64, Error> {
    let info = stream.get_info().await;
    info.map(|info| info.state.messages)
        .map_err(|why| Error::asked("the state", why))
}
