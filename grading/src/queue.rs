//! The server: its streams, what is put into them, and what can be asked.
//!
//! Owns the connection, which comes back by itself, and that nothing is in a stream twice: each message is the first of its subject,
//! or the server refuses it.

use crate::error::Error;
use crate::limits::{ACK_TIME, ANSWER_TIME, REACH_TIME, TAKEN_MAX};
use crate::names::{DEAD, DEAD_LETTERS, RESULT, RESULTS, SUBMISSIONS, SUBMIT, WHY, WORKERS};
use crate::submission::Submission;
use async_nats::jetstream::consumer::{AckPolicy, PullConsumer, pull};
use async_nats::jetstream::context::PublishErrorKind;
use async_nats::jetstream::message::PublishMessage;
use async_nats::jetstream::stream::{
    Config, DiscardPolicy, LastRawMessageErrorKind, RetentionPolicy, Stream,
};
use async_nats::jetstream::{Context, context};
use async_nats::{Client, ConnectOptions, Event, HeaderMap, Subscriber};
use std::fmt::Display;
use std::path::PathBuf;
use std::sync::Arc;

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
    /// It was judged before.
    Judged,
}

/// The way to a server.
#[derive(Clone)]
pub struct Queue {
    client: Client,
    context: Context,
    submissions: Stream,
    results: Stream,
    dead: Stream,
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
        let tell = Arc::new(tell);
        let mut options = ConnectOptions::new()
            .name(&settings.name)
            .request_timeout(Some(ANSWER_TIME))
            .reconnect_delay_callback(|_| REACH_TIME)
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
                let tell = tell.clone();
                async move {
                    if let Some(is_there) = is_there {
                        tell(is_there);
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
        let client =
            client.map_err(|why| Error::Reach(settings.server.clone(), why.to_string()))?;
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
            let is_ours = has.retention == retention && has.discard_new_per_subject;
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
        })
    }

    /// Hands a submission in; one that was put aside is judged anew.
    ///
    /// # Errors
    /// It is too large for the server, or that does not answer.
    pub async fn submit(&self, submission: &Submission) -> Result<Receipt, Error> {
        let id = submission.id();
        if let Some(result) = self.result(&id).await? {
            if !is_dead(&result) {
                return Ok(Receipt::Judged);
            }
            // Nobody could judge it, and somebody wants to know whether that is still so.
            forget(&self.dead, &format!("{DEAD}{id}")).await?;
            forget(&self.results, &format!("{RESULT}{id}")).await?;
        }
        let bytes = submission.bytes().to_vec();
        let is_new = self.put(SUBMIT, &id, submission.headers(), bytes).await?;
        Ok(match is_new {
            true => Receipt::Taken,
            false => Receipt::Waits,
        })
    }

    /// The result of a submission, if it is there.
    ///
    /// # Errors
    /// The server does not answer.
    pub async fn result(&self, id: &str) -> Result<Option<String>, Error> {
        let subject = format!("{RESULT}{id}");
        match self.results.get_last_raw_message_by_subject(&subject).await {
            Ok(message) => Ok(Some(String::from_utf8_lossy(&message.payload).into_owned())),
            Err(why) if why.kind() == LastRawMessageErrorKind::NoMessageFound => Ok(None),
            Err(why) => Err(asked("the result", why)),
        }
    }

    /// Results as they come. Some are missing after the connection was lost: [`Queue::result`] has them.
    ///
    /// # Errors
    /// The connection is closed.
    pub async fn results(&self) -> Result<Subscriber, Error> {
        let all = self.client.subscribe(format!("{RESULT}*")).await;
        all.map_err(|why| asked("results", why))
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

    /// Whether submissions are there that the server gives to nobody: one that was killed can keep a submission and forget that it has
    /// to be given out.
    pub(crate) async fn has_forgotten(&self) -> Result<bool, Error> {
        let all = count(&self.submissions).await?;
        let info = self.submissions.consumer_info(WORKERS).await;
        let info = info.map_err(|why| asked("the state", why))?;
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
        consumer.await.map_err(|why| asked("submissions", why))
    }

    /// Tells a result. False: there was one.
    pub(crate) async fn tell(&self, id: &str, result: &str) -> Result<bool, Error> {
        let result = result.as_bytes().to_vec();
        self.put(RESULT, id, HeaderMap::new(), result).await
    }

    /// Puts a submission aside that nobody can judge.
    pub(crate) async fn bury(
        &self,
        id: &str,
        mut headers: HeaderMap,
        bytes: Vec<u8>,
        why: &str,
    ) -> Result<bool, Error> {
        // A header is one line.
        let why: String = why
            .chars()
            .map(|letter| if letter.is_control() { ' ' } else { letter })
            .collect();
        headers.insert(WHY, why.as_str());
        self.put(DEAD, id, headers, bytes).await
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
                | PublishErrorKind::Other => Err(asked("a message", why)),
            },
        }
    }
}

/// Whether a result is that of a submission which was put aside.
fn is_dead(result: &str) -> bool {
    let result = serde_json::from_str::<serde_json::Value>(result);
    result.is_ok_and(|result| !result["dead"].is_null())
}

/// Takes what a stream has of a subject away, if there is something.
async fn forget(stream: &Stream, subject: &str) -> Result<(), Error> {
    match stream.get_last_raw_message_by_subject(subject).await {
        Ok(message) => {
            let gone = stream.delete_message(message.sequence).await;
            gone.map(drop)
                .map_err(|why| asked("what was put aside", why))
        }
        Err(why) if why.kind() == LastRawMessageErrorKind::NoMessageFound => Ok(()),
        Err(why) => Err(asked("what was put aside", why)),
    }
}

/// How much a stream has.
async fn count(stream: &Stream) -> Result<u64, Error> {
    let info = stream.get_info().await;
    info.map(|info| info.state.messages)
        .map_err(|why| asked("the state", why))
}

/// What the server says, as an error.
pub(crate) fn asked(what: &'static str, why: impl Display) -> Error {
    Error::Asked(what, why.to_string())
}
