//! The connection to a broker: it comes back by itself, and says what has become of it.
//!
//! Owns the thread that serves the connection, and when it tries again. The last will of the robot is left with the broker, so
//! that everybody hears when it is gone. A bridge leaves its mark with the broker as well: one that comes back and finds the mark
//! of another one there has lost its name to it, and ends, for not every broker says why it has closed a connection. What is said
//! is made elsewhere.

use super::Message;
use super::hands::answer;
use super::inbox::{self, Inbox};
use super::topics::Topics;
use crate::error::Error;
use crate::limits::{
    AGAIN_TIME_MAX, AGAIN_TIME_MIN, KEEP_ALIVE, PACKET_BYTES_MAX, QUEUE_MAX, WORD_TIME_S,
};
use recorder::clock::now_ns;
use rumqttc::v5::mqttbytes::QoS;
use rumqttc::v5::mqttbytes::v5::{
    ConnectProperties, ConnectReturnCode, DisconnectReasonCode, Filter, LastWill, Packet, Publish,
    PublishProperties, RetainForwardRule, SubscribeReasonCode,
};
use rumqttc::v5::{self, Connection, ConnectionError, Event, MqttOptions, StateError};
use std::fmt;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

/// What a robot says when it is there.
const ONLINE: &str = "online";
/// And when it is not.
const OFFLINE: &str = "offline";

/// Where the broker is, and who asks.
#[derive(Clone)]
pub struct Settings {
    /// Its name or address.
    pub host: String,
    /// Its TCP port.
    pub port: u16,
    /// Name and password.
    pub login: Option<(String, String)>,
    /// How the connection is kept from strangers, if it is.
    pub tls: Option<Tls>,
}

/// Certificates, as PEM.
#[derive(Clone)]
pub struct Tls {
    /// Of those who vouch for the broker; None: those whom this computer trusts.
    pub authority: Option<Vec<u8>>,
    /// Our own certificate and its key.
    pub own: Option<(Vec<u8>, Vec<u8>)>,
}

/// What became of the connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum News {
    /// It is there, and another one than before.
    Connected,
    /// It is not there; it is tried again.
    Lost(String),
    /// The broker gives the bridge no right: to commands, or to publish.
    Forbidden(&'static str),
    /// It is given up.
    Over(Gone),
}

/// Why a connection is given up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Gone {
    /// The broker does not let us in.
    Refused(String),
    /// Another bridge has our name.
    TakenOver(String),
}

impl fmt::Display for Gone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(why) => write!(
                f,
                "the broker does not let the bridge in: {why}; --user and --password-file say who it is"
            ),
            Self::TakenOver(id) => write!(
                f,
                "another bridge has come to the broker as {id}, and only one robot of a class can have a name: --name gives this one another"
            ),
        }
    }
}

/// A connection that is served by a thread of its own.
pub struct Client {
    client: v5::Client,
    news: Receiver<News>,
    topics: Topics,
}

/// Publishes from another thread.
#[derive(Clone)]
pub struct Voice(v5::Client);

impl Voice {
    /// False: there is no room at the moment, or no connection any more.
    pub fn say(&self, message: Message) -> bool {
        let Message {
            topic,
            payload,
            is_retained,
            correlation,
        } = message;
        let properties = PublishProperties {
            correlation_data: correlation.map(Into::into),
            ..PublishProperties::default()
        };
        let quality = QoS::AtMostOnce;
        self.0
            .try_publish_with_properties(topic, quality, is_retained, payload, properties)
            .is_ok()
    }
}

impl Client {
    /// Begins; a broker that is not there is waited for. Commands go to `inbox`.
    ///
    /// # Errors
    /// The certificates are none, this program was built without TLS, or there are no more threads.
    pub fn begin(settings: Settings, topics: &Topics, inbox: Arc<Inbox>) -> Result<Self, Error> {
        let (client, connection) = v5::Client::new(options(settings, topics)?, QUEUE_MAX);
        let (tell, news) = channel();
        let serving = Serving {
            client: client.clone(),
            topics: topics.clone(),
            inbox,
            tell,
            mark: format!("{:x}-{:x}", now_ns(), std::process::id()),
            is_marked: false,
            must_subscribe: false,
        };
        thread::Builder::new()
            .name("mqtt".to_owned())
            .spawn(move || serving.serve(connection))
            .map_err(|why| Error::Thread(why.to_string()))?;
        Ok(Self {
            client,
            news,
            topics: topics.clone(),
        })
    }

    /// What has become of it since the last time.
    pub fn news(&self) -> Option<News> {
        self.news.try_recv().ok()
    }

    /// For other threads.
    pub fn voice(&self) -> Voice {
        Voice(self.client.clone())
    }

    /// Says that the robot is there, or that it is not. It arrives for certain.
    pub fn life(&self, is_there: bool) {
        let said = if is_there { ONLINE } else { OFFLINE };
        let topic = self.topics.life();
        // Without room there is no connection, and the will of the last one has said it.
        let _ = self.client.try_publish(topic, QoS::AtLeastOnce, true, said);
    }

    /// Ends it. The broker hears first that the robot is not there: a good end takes the last will away.
    pub fn end(&self) {
        self.life(false);
        let _ = self.client.try_disconnect();
        let until = std::time::Instant::now() + Duration::from_secs(WORD_TIME_S);
        while std::time::Instant::now() < until {
            match self.news.recv_timeout(Duration::from_millis(50)) {
                Ok(News::Lost(_) | News::Over(_)) => return,
                Ok(News::Connected | News::Forbidden(_)) | Err(_) => {}
            }
        }
    }
}

fn options(settings: Settings, topics: &Topics) -> Result<MqttOptions, Error> {
    let Settings {
        host,
        port,
        login,
        tls,
    } = settings;
    let mut options = MqttOptions::new(topics.client_id(), host, port);
    options.set_keep_alive(KEEP_ALIVE);
    // Commands of a time when the bridge was away must not move anything.
    options.set_clean_start(true);
    options.set_connect_properties(ConnectProperties {
        max_packet_size: Some(PACKET_BYTES_MAX),
        session_expiry_interval: Some(0),
        ..ConnectProperties::new()
    });
    options.set_connection_timeout(WORD_TIME_S);
    let quality = QoS::AtLeastOnce;
    options.set_last_will(LastWill::new(topics.life(), OFFLINE, quality, true, None));
    if let Some((user, password)) = login {
        options.set_credentials(user, password);
    }
    if let Some(tls) = tls {
        secure(&mut options, tls)?;
    }
    Ok(options)
}

#[cfg(feature = "tls")]
fn secure(options: &mut MqttOptions, tls: Tls) -> Result<(), Error> {
    let _ = rustls::crypto::ring::default_provider().install_default();
    options.set_transport(match tls.authority {
        Some(authority) => rumqttc::Transport::tls(authority, tls.own, None),
        None => rumqttc::Transport::tls_with_default_config(),
    });
    Ok(())
}

#[cfg(not(feature = "tls"))]
fn secure(_: &mut MqttOptions, _: Tls) -> Result<(), Error> {
    Err(Error::NoTls)
}

/// What the thread has.
struct Serving {
    client: v5::Client,
    topics: Topics,
    inbox: Arc<Inbox>,
    tell: Sender<News>,
    /// What tells this bridge from all others.
    mark: String,
    /// It was left with the broker that is there.
    is_marked: bool,
    /// The broker was not asked yet for what is for us.
    must_subscribe: bool,
}

impl Serving {
    fn serve(mut self, mut connection: Connection) {
        let (mut pause, mut was_there, mut is_told) = (AGAIN_TIME_MIN, false, false);
        for event in connection.iter() {
            match event {
                Ok(Event::Incoming(packet)) => {
                    if matches!(packet, Packet::ConnAck(_)) {
                        // One that comes back looks first.
                        if !was_there {
                            self.leave_mark();
                        }
                        (pause, was_there, is_told) = (AGAIN_TIME_MIN, true, false);
                    }
                    if let Some(gone) = self.take(packet) {
                        let _ = self.client.try_disconnect();
                        let _ = self.tell.send(News::Over(gone));
                        return;
                    }
                    self.subscribe();
                }
                Ok(Event::Outgoing(_)) => self.subscribe(),
                Err(why) => {
                    self.must_subscribe = false;
                    self.is_marked = false;
                    if let Some(gone) = self.gone(&why, was_there) {
                        let _ = self.tell.send(News::Over(gone));
                        return;
                    }
                    // Once for each time that it is away.
                    if !is_told {
                        is_told = true;
                        let _ = self.tell.send(News::Lost(words(&why)));
                    }
                    thread::sleep(pause);
                    pause = (pause * 2).min(AGAIN_TIME_MAX);
                }
            }
        }
    }

    /// Asks for commands, and for the mark. What is left of the last connection may fill the queue: then it is tried again.
    fn subscribe(&mut self) {
        if !self.must_subscribe {
            return;
        }
        let mut filter = Filter::new(self.topics.commands(), QoS::AtLeastOnce);
        // What is kept is old, and moves nothing.
        filter.retain_forward_rule = RetainForwardRule::Never;
        // One that would be kept is told from one that is not.
        filter.preserve_retain = true;
        let mut mark = Filter::new(self.topics.bridge(), QoS::AtLeastOnce);
        mark.nolocal = true;
        let asked = self.client.try_subscribe_many([filter, mark]);
        self.must_subscribe = asked.is_err();
    }

    fn leave_mark(&mut self) {
        let mark = Message::retained(self.topics.bridge(), &*self.mark);
        self.is_marked = Voice(self.client.clone()).say(mark);
    }

    /// Takes a packet; if it says that we are not wanted any more, why.
    fn take(&mut self, packet: Packet) -> Option<Gone> {
        let news = match packet {
            Packet::ConnAck(_) => {
                self.must_subscribe = true;
                None
            }
            Packet::Publish(publish) if *publish.topic == *self.topics.bridge().as_bytes() => {
                let is_ours = *publish.payload == *self.mark.as_bytes();
                // Only what the broker has kept: others can say anything.
                if publish.retain && !is_ours && !publish.payload.is_empty() && !self.is_marked {
                    return Some(Gone::TakenOver(self.topics.client_id()));
                }
                None
            }
            Packet::Publish(publish) => {
                self.command(&publish);
                None
            }
            Packet::SubAck(ack) => {
                let is_good =
                    |code: &SubscribeReasonCode| matches!(code, SubscribeReasonCode::Success(_));
                if !ack.return_codes.iter().all(is_good) {
                    let _ = self.tell.send(News::Forbidden("commands do not reach it"));
                }
                // From now on a command arrives.
                Some(News::Connected)
            }
            Packet::PubAck(ack) => {
                let is_refused = ack.reason == v5::mqttbytes::v5::PubAckReason::NotAuthorized;
                is_refused.then_some(News::Forbidden("what it says is thrown away"))
            }
            // Nobody else's mark has come since: the broker has none, or ours.
            Packet::PingResp(_) => {
                if !self.is_marked {
                    self.leave_mark();
                }
                None
            }
            Packet::Connect(..)
            | Packet::PingReq(_)
            | Packet::Subscribe(_)
            | Packet::PubRec(_)
            | Packet::PubRel(_)
            | Packet::PubComp(_)
            | Packet::Unsubscribe(_)
            | Packet::UnsubAck(_)
            | Packet::Disconnect(_)
            | Packet::Auth(_) => None,
        };
        if let Some(news) = news {
            let _ = self.tell.send(news);
        }
        None
    }

    fn command(&self, publish: &Publish) {
        let ticket = publish.properties.as_ref();
        let ticket = ticket.and_then(|with| with.correlation_data.as_ref());
        let ticket = ticket.map(|bytes| bytes.to_vec());
        let taken = inbox::take(
            &self.inbox,
            &self.topics,
            &publish.topic,
            &publish.payload,
            publish.retain,
            ticket.clone(),
        );
        if let Some((words, Err(why))) = taken {
            let answer = answer(&self.topics, &words, Err(&why), ticket);
            Voice(self.client.clone()).say(answer);
        }
    }

    /// Whether it makes no sense to try again.
    fn gone(&self, why: &ConnectionError, was_there: bool) -> Option<Gone> {
        if let ConnectionError::MqttState(StateError::ServerDisconnect { reason_code, .. }) = why
            && *reason_code == DisconnectReasonCode::SessionTakenOver
        {
            return Some(Gone::TakenOver(self.topics.client_id()));
        }
        // The enum has other variants with other features.
        let (ConnectionError::ConnectionRefused(code)
        | ConnectionError::MqttState(StateError::ConnFail { reason: code })) = why
        else {
            return None;
        };
        let is_final = matches!(
            code,
            ConnectReturnCode::BadUserNamePassword
                | ConnectReturnCode::NotAuthorized
                | ConnectReturnCode::ClientIdentifierNotValid
                | ConnectReturnCode::Banned
                | ConnectReturnCode::BadAuthenticationMethod
        );
        // A broker that has let us in is being changed by somebody.
        (is_final && !was_there).then(|| Gone::Refused(format!("{code:?}")))
    }
}

/// Why there is no connection, for a person.
fn words(why: &ConnectionError) -> String {
    // The enum has other variants with other features.
    if let ConnectionError::Io(why) = why {
        return why.to_string();
    }
    match matches!(why, ConnectionError::Timeout(_)) {
        true => "it does not answer".to_owned(),
        false => why.to_string(),
    }
}
