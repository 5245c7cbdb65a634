//! One client: the handshake, what it asks, and the way of its queue into its socket.
//!
//! Owns the bounds of what comes from it: time, bytes, mistakes, and from which pages it may come. It is served on a thread of
//! its own, so neither its slowness nor what a robot does for it delays others.

use super::hub::{ClientId, Hub, Next};
use super::protocol::{self, Mistake, Request, SUBPROTOCOLS, Weight};
use super::robot::{self, Robot};
use crate::limits::{
    DEAF_TIME, HANDSHAKE_TIME, MESSAGE_BYTES_MAX, MISTAKES_MAX, PING_TIME, SENT_AT_ONCE, STUCK_TIME,
};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use serde_json::Value;
use std::collections::{BTreeSet, HashMap};
use std::io::{self, Read, Write};
use std::net::{IpAddr, TcpStream};
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tungstenite::handshake::server::{ErrorResponse, Request as Upgrade, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

/// Pages of others that may use a robot: Foxglove's own.
const ORIGINS: [&str; 1] = ["https://app.foxglove.dev"];
/// Bytes that are put together before they go to the socket.
const WRITTEN_AT_ONCE: usize = 16 << 10;
/// Messages that are taken from a client before it is told something.
const READ_AT_ONCE: usize = 64;
/// Why a client that only looks is refused.
const LOOKS_ONLY: &str = "clients of other machines only look here; --control lets them act";
/// The longest sleep.
const SLEEP: Duration = Duration::from_secs(1);

/// Which clients are let in, and what they are told of the server.
#[derive(Clone, Debug)]
pub struct House {
    /// What is served, for people.
    pub name: String,
    /// A word that is another one each time the bridge begins.
    pub session: String,
    /// Pages of others that may come in.
    pub origins: Vec<String>,
    /// Whether clients of other machines may change things.
    pub lets_all_act: bool,
}

/// A socket that fails when its time is over.
struct Timed {
    stream: TcpStream,
    until: Option<Instant>,
    /// When it took something.
    took_at: Instant,
}

impl Timed {
    fn left(&self) -> io::Result<Option<Duration>> {
        let Some(until) = self.until else {
            return Ok(None);
        };
        let left = until.saturating_duration_since(Instant::now());
        match left.is_zero() {
            true => Err(io::ErrorKind::TimedOut.into()),
            false => Ok(Some(left)),
        }
    }
}

impl Read for Timed {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if let Some(left) = self.left()? {
            self.stream.set_read_timeout(Some(left))?;
        }
        self.stream.read(out)
    }
}

impl Write for Timed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Some(left) = self.left()? {
            self.stream.set_write_timeout(Some(left))?;
        }
        let count = self.stream.write(bytes)?;
        self.took_at = Instant::now();
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// Whether a page with this origin may use a robot. Programs have none, or one that is of no web page.
fn may_come(origin: &str, others: &[String]) -> bool {
    if ORIGINS.contains(&origin) || others.iter().any(|other| other == origin) {
        return true;
    }
    let Some((scheme, rest)) = origin.split_once("://") else {
        // That of a page which hides where it is from.
        return false;
    };
    // Extensions of a browser come with any page.
    if scheme.ends_with("-extension") {
        return false;
    }
    if !matches!(scheme, "http" | "https") {
        return true;
    }
    let host = match rest.strip_prefix('[') {
        Some(rest) => rest.split(']').next(),
        None => rest.split(':').next(),
    };
    let host = host.unwrap_or_default();
    let is_here = host
        .parse::<IpAddr>()
        .is_ok_and(|address| address.is_loopback());
    host == "localhost" || is_here
}

/// Whether a client at this address may change things, and not only look and stop.
fn may_act(peer: IpAddr, house: &House) -> bool {
    house.lets_all_act || peer.to_canonical().is_loopback()
}

/// Serves one client until it is gone.
///
/// # Errors
/// How its connection ended.
pub fn serve(stream: TcpStream, house: &House, hub: &Hub, robot: &Robot) -> Result<(), Error> {
    let peer = stream.peer_addr()?;
    stream.set_nodelay(true)?;
    let timed = Timed {
        stream,
        until: Some(Instant::now() + HANDSHAKE_TIME),
        took_at: Instant::now(),
    };
    let config = WebSocketConfig::default()
        .read_buffer_size(8 << 10)
        .write_buffer_size(2 * WRITTEN_AT_ONCE)
        .max_message_size(Some(MESSAGE_BYTES_MAX))
        .max_frame_size(Some(MESSAGE_BYTES_MAX));
    #[allow(clippy::result_large_err, reason = "the answer of the library")]
    let greet = |request: &Upgrade, response: Response| greet(request, response, house);
    let mut socket = accept_hdr_with_config(timed, greet, Some(config))
        .map_err(|_| Error::Io(io::ErrorKind::InvalidData.into()))?;
    socket.get_mut().until = None;
    socket.get_ref().stream.set_nonblocking(true)?;
    let (wake, woken) = UnixStream::pair()?;
    wake.set_nonblocking(true)?;
    woken.set_nonblocking(true)?;
    let may_act = may_act(peer.ip(), house);
    let info = protocol::server_info(&house.name, &house.session);
    let id = hub.enter(&peer.to_string(), info, may_act, wake);
    let mut client = Client {
        socket,
        woken,
        id,
        may_act,
        hub,
        robot,
        mistakes: 0,
        is_pending: false,
        asked_at: Instant::now(),
        heard_at: Instant::now(),
    };
    let ended = client.run();
    hub.leave(id);
    ended
}

/// Answers the request for a WebSocket.
#[allow(clippy::result_large_err, reason = "the answer of the library")]
fn greet(
    request: &Upgrade,
    mut response: Response,
    house: &House,
) -> Result<Response, ErrorResponse> {
    let refuse = |status: StatusCode, why: &str| {
        let mut refused = ErrorResponse::new(Some(format!("{why}\n")));
        *refused.status_mut() = status;
        Err(refused)
    };
    let header = |name: &str| request.headers().get(name).map(HeaderValue::to_str);
    match header("origin") {
        None => {}
        Some(Ok(origin)) if may_come(origin, &house.origins) => {}
        Some(_) => {
            let why = "a page of this origin may not use the robot; --origin lets it in";
            return refuse(StatusCode::FORBIDDEN, why);
        }
    }
    let offered = header("sec-websocket-protocol").and_then(Result::ok);
    let mut offered = offered.unwrap_or_default().split(',').map(str::trim);
    match offered.find(|one| SUBPROTOCOLS.contains(one)) {
        Some(spoken) => {
            let spoken = HeaderValue::from_str(spoken);
            let spoken = spoken.unwrap_or(HeaderValue::from_static(SUBPROTOCOLS[0]));
            response
                .headers_mut()
                .insert("sec-websocket-protocol", spoken);
            Ok(response)
        }
        None => refuse(
            StatusCode::BAD_REQUEST,
            "this server speaks only foxglove.sdk.v1 and foxglove.websocket.v1",
        ),
    }
}

struct Client<'a> {
    socket: WebSocket<Timed>,
    woken: UnixStream,
    id: ClientId,
    may_act: bool,
    hub: &'a Hub,
    robot: &'a Robot,
    mistakes: usize,
    /// The socket takes no more.
    is_pending: bool,
    /// When it was asked whether it is there.
    asked_at: Instant,
    /// When it said something, if only that it is there.
    heard_at: Instant,
}

/// What comes of the silence of a client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Silence {
    /// Nothing.
    Fine,
    /// It is asked whether it is there.
    Ask,
    /// It is let go.
    End,
}

/// For how long a socket that is full (`pending`) has taken nothing, or else the client was not asked, nor heard.
fn silence(pending: Option<Duration>, asked: Duration, heard: Duration) -> Silence {
    match pending {
        // The question would wait behind what waits, and so would the answer.
        Some(stuck) if stuck > STUCK_TIME => Silence::End,
        Some(_) => Silence::Fine,
        None if heard > DEAF_TIME => Silence::End,
        None if asked > PING_TIME => Silence::Ask,
        None => Silence::Fine,
    }
}

/// What nobody has to wait for is no error.
fn unless_blocked<T>(result: Result<T, Error>) -> Result<Option<T>, Error> {
    #[allow(clippy::wildcard_enum_match_arm, reason = "errors of another crate")]
    match result {
        Ok(value) => Ok(Some(value)),
        Err(Error::Io(why)) if why.kind() == io::ErrorKind::WouldBlock => Ok(None),
        Err(why) => Err(why),
    }
}

impl Client<'_> {
    fn run(&mut self) -> Result<(), Error> {
        loop {
            let has_more = self.write()? | self.read()?;
            let took_at = self.socket.get_ref().took_at;
            let pending = self.is_pending.then(|| took_at.elapsed());
            match silence(pending, self.asked_at.elapsed(), self.heard_at.elapsed()) {
                Silence::Fine => {}
                Silence::Ask => {
                    self.asked_at = Instant::now();
                    unless_blocked(self.socket.write(Message::Ping(Vec::new().into())))?;
                    self.flush()?;
                }
                Silence::End => return Err(Error::Io(io::ErrorKind::TimedOut.into())),
            }
            let sleep = if has_more { Duration::ZERO } else { SLEEP };
            self.wait(sleep);
        }
    }

    /// Waits for bytes, for news, or for room.
    fn wait(&mut self, sleep: Duration) {
        let mut events = PollFlags::POLLIN;
        events.set(PollFlags::POLLOUT, self.is_pending);
        let mut fds = vec![PollFd::new(self.socket.get_ref().stream.as_fd(), events)];
        // While there is no room, news have to wait.
        if !self.is_pending {
            fds.push(PollFd::new(self.woken.as_fd(), PollFlags::POLLIN));
        }
        let _ = poll(
            &mut fds,
            PollTimeout::try_from(sleep).unwrap_or(PollTimeout::ZERO),
        );
        let mut bytes = [0; 512];
        while matches!((&self.woken).read(&mut bytes), Ok(count) if count == bytes.len()) {}
    }

    fn flush(&mut self) -> Result<(), Error> {
        let was_pending = self.is_pending;
        self.is_pending = unless_blocked(self.socket.flush())?.is_none();
        let now = Instant::now();
        match (was_pending, self.is_pending) {
            // It may have had nothing to take for long.
            (false, true) => self.socket.get_mut().took_at = now,
            // While it took what waited nobody could ask it.
            (true, false) => self.heard_at = now,
            (false, false) | (true, true) => {}
        }
        Ok(())
    }

    /// Hands over what waits; whether there is more.
    fn write(&mut self) -> Result<bool, Error> {
        if self.is_pending {
            self.flush()?;
        }
        let mut bytes = 0;
        for _ in 0..SENT_AT_ONCE {
            if self.is_pending {
                return Ok(false);
            }
            let next = self
                .hub
                .next(self.id)
                .map_err(|_| Error::ConnectionClosed)?;
            let Some(next) = next else {
                self.flush()?;
                return Ok(false);
            };
            let message = match next {
                Next::Text(text) => Message::Text(text.into()),
                Next::Bytes(bytes) => Message::Binary(bytes.into()),
            };
            bytes += message.len();
            unless_blocked(self.socket.write(message))?;
            if bytes >= WRITTEN_AT_ONCE {
                bytes = 0;
                self.flush()?;
            }
        }
        self.flush()?;
        Ok(true)
    }

    /// Takes what it says; whether there may be more.
    fn read(&mut self) -> Result<bool, Error> {
        for _ in 0..READ_AT_ONCE {
            let Some(message) = unless_blocked(self.socket.read())? else {
                return Ok(false);
            };
            self.heard_at = Instant::now();
            let request = match message {
                Message::Text(text) => protocol::text(text.as_str()),
                Message::Binary(bytes) => protocol::binary(&bytes),
                Message::Ping(_) | Message::Pong(_) | Message::Frame(_) => continue,
                Message::Close(_) => return Err(Error::ConnectionClosed),
            };
            match request {
                Ok(request) => {
                    self.perform(request);
                    // It took as long as the robot wanted, and nobody could ask the client meanwhile.
                    self.heard_at = Instant::now();
                }
                Err(Mistake::Arguments(service, call)) => {
                    let why = Mistake::Arguments(service, call).to_string();
                    self.say(protocol::call_failed(service, call, &why));
                }
                Err(mistake) => {
                    self.mistakes += 1;
                    if self.mistakes > MISTAKES_MAX {
                        return Err(Error::ConnectionClosed);
                    }
                    self.complain(&mistake.to_string());
                }
            }
        }
        Ok(true)
    }

    fn say(&self, text: String) {
        self.hub.say(self.id, Next::Text(text));
    }

    fn complain(&self, why: &str) {
        self.say(protocol::status(Weight::Error, why, None));
    }

    fn perform(&self, request: Request) {
        match request {
            Request::Subscribe(pairs) => self.hub.subscribe(self.id, &pairs),
            Request::Unsubscribe(all) => self.hub.unsubscribe(self.id, &all),
            Request::GetParameters(names, word) => self.tell(&names, word.as_deref()),
            Request::SetParameters(values, word) => self.set(&values, word.as_deref()),
            Request::WatchParameters(names) => self.hub.watch_parameters(self.id, names, true),
            Request::UnwatchParameters(names) => self.hub.watch_parameters(self.id, names, false),
            Request::WatchGraph(wants) => self.hub.watch_graph(self.id, wants),
            Request::Call(service, call, arguments) => self.call(service, call, &arguments),
        }
    }

    /// Tells values of parameters, of all if none is named.
    fn tell(&self, names: &[String], word: Option<&str>) {
        let all = self.robot.parameters();
        self.hub.parameters(&all);
        if names.is_empty() {
            return self.say(protocol::parameter_values(&all, word));
        }
        let values: HashMap<&str, &Option<Value>> = all
            .iter()
            .map(|(name, value)| (name.as_str(), value))
            .collect();
        // Each once, however often it is named.
        let names: BTreeSet<&String> = names.iter().collect();
        let value = |name: &str| (*values.get(name)?).clone();
        let wanted: Vec<(String, Option<Value>)> = names
            .into_iter()
            .map(|name| (name.clone(), value(name)))
            .collect();
        self.say(protocol::parameter_values(&wanted, word));
    }

    fn set(&self, values: &[(String, Value)], word: Option<&str>) {
        if !self.may_act {
            return self.complain(LOOKS_ONLY);
        }
        for why in self.robot.set(values) {
            self.complain(&why.to_string());
        }
        // What was taken, which may be something else than what was wanted.
        let names: Vec<String> = values.iter().map(|(name, _)| name.clone()).collect();
        if !names.is_empty() {
            self.tell(&names, word);
        }
    }

    fn call(&self, service: u32, call: u32, arguments: &Value) {
        let done = match self.may_act || robot::is_for_all(service) {
            true => self
                .robot
                .call(service, arguments)
                .map_err(|why| why.to_string()),
            false => Err(LOOKS_ONLY.to_owned()),
        };
        let next = match done {
            Ok(()) => Next::Bytes(protocol::call_done(service, call)),
            Err(why) => Next::Text(protocol::call_failed(service, call, &why)),
        };
        self.hub.say(self.id, next);
    }
}

/// What all clients share.
#[derive(Clone)]
pub struct Served {
    /// Which clients are let in.
    pub house: Arc<House>,
    /// What is told.
    pub hub: Arc<Hub>,
    /// What can be changed.
    pub robot: Arc<Robot>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use tungstenite::protocol::Role;

    #[test]
    fn pages_of_others_do_not_come_in() {
        let others = ["https://lichtblick.example".to_owned()];
        for origin in [
            "https://app.foxglove.dev",
            "http://localhost:8080",
            "http://127.0.0.1",
            "http://[::1]:80",
            "file://",
            "app://foxglove",
            "https://lichtblick.example",
        ] {
            assert!(may_come(origin, &others), "{origin}");
        }
        for origin in [
            "null",
            "",
            "chrome-extension://abcdef",
            "moz-extension://abcdef",
            "safari-web-extension://abcdef",
            "http://evil.example",
            "https://app.foxglove.dev.evil.example",
            "http://localhost.evil.example",
            "https://127.0.0.1.evil.example",
            "http://192.168.77.1",
        ] {
            assert!(!may_come(origin, &others), "{origin}");
        }
    }

    fn house(lets_all_act: bool) -> House {
        House {
            name: "test".to_owned(),
            session: "1".to_owned(),
            origins: Vec::new(),
            lets_all_act,
        }
    }

    #[test]
    fn clients_of_this_machine_may_act_and_others_if_all_may() {
        for (peer, may) in [
            ("127.0.0.1", true),
            ("127.8.9.1", true),
            ("::1", true),
            ("::ffff:127.0.0.1", true),
            ("192.168.77.2", false),
            ("::ffff:192.168.77.2", false),
            ("fe80::1", false),
            ("0.0.0.0", false),
        ] {
            let address = peer.parse().unwrap();
            assert_eq!(may_act(address, &house(false)), may, "{peer}");
            assert!(may_act(address, &house(true)), "{peer}");
        }
    }

    #[test]
    fn who_takes_or_says_nothing_is_asked_and_then_let_go() {
        let more = Duration::from_secs(1);
        let none = Duration::ZERO;
        for (pending, asked, heard, comes) in [
            (None, none, none, Silence::Fine),
            (None, PING_TIME + more, PING_TIME + more, Silence::Ask),
            (None, none, DEAF_TIME + more, Silence::End),
            (
                Some(none),
                PING_TIME + more,
                DEAF_TIME + more,
                Silence::Fine,
            ),
            (Some(STUCK_TIME + more), none, none, Silence::End),
        ] {
            assert_eq!(silence(pending, asked, heard), comes);
        }
    }

    #[test]
    fn a_client_that_only_looks_may_stop_and_changes_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let node = directory.path().join("a");
        std::fs::create_dir(&node).unwrap();
        for (name, text) in [
            ("format", "u8 x\n"),
            ("bin_data", "\0"),
            ("poll_ms", "20\n"),
        ] {
            std::fs::write(node.join(name), text).unwrap();
        }
        let (hub, robot) = (Hub::default(), Robot::new(directory.path(), None));
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let stream = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let timed = Timed {
            stream,
            until: None,
            took_at: Instant::now(),
        };
        let (wake, woken) = UnixStream::pair().unwrap();
        let mut client = Client {
            socket: WebSocket::from_raw_socket(timed, Role::Server, None),
            woken,
            id: hub.enter("c", String::new(), false, wake),
            may_act: false,
            hub: &hub,
            robot: &robot,
            mistakes: 0,
            is_pending: false,
            asked_at: Instant::now(),
            heard_at: Instant::now(),
        };
        let told = |client: &Client| {
            let all = std::iter::from_fn(|| hub.next(client.id).unwrap());
            all.map(|next| format!("{next:?}")).collect::<String>()
        };
        let offered = told(&client);
        assert!(
            offered.contains("/stop") && !offered.contains("/run"),
            "{offered}"
        );
        let set = || Request::SetParameters(vec![("a/poll_ms".to_owned(), 50.into())], None);
        let run = || Request::Call(2, 1, serde_json::json!({"file": "x"}));
        for request in [set(), run(), Request::Call(0, 1, Value::Null)] {
            client.perform(request);
            let why = told(&client);
            assert!(
                why.contains("only look here") && !why.contains("poll_ms"),
                "{why}"
            );
        }
        let poll = || std::fs::read_to_string(node.join("poll_ms")).unwrap();
        assert_eq!(poll(), "20\n");
        client.perform(Request::Call(1, 1, Value::Null));
        assert!(told(&client).contains("Bytes([3, 1,"));
        let stop = std::fs::read_to_string(directory.path().join("stop"));
        assert_eq!(stop.unwrap(), "1\n");
        // One that may act does both, and is told each value once.
        client.may_act = true;
        client.perform(set());
        assert_eq!(
            (poll().as_str(), told(&client).contains("50")),
            ("50\n", true)
        );
        client.perform(run());
        assert!(told(&client).contains("nobody takes programs"));
        client.perform(Request::GetParameters(
            vec!["a/poll_ms".to_owned(); 9],
            None,
        ));
        assert_eq!(told(&client).matches("poll_ms").count(), 1);
    }
}
