//! Robots that speak the control port and do nothing else, and a viewer of the page of their class, for its tests and for
//! the benchmark `class`.
//!
//! Owns both ends of a page that is served.

use crate::Guests;
use crate::class::{ClassPage, ClassSettings, Found, Member, OwnPage, Whereabouts};
use crate::client::{Socket, get};
use frame::{Decoder, encode};
use lang_text::problem::Words;
use serde_json::Value;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// A robot that runs what it is told to, in words alone.
pub struct Fake {
    pub at: SocketAddr,
    pub state: Arc<FakeState>,
}

#[derive(Default)]
pub struct FakeState {
    runs: Mutex<String>,
    /// What came, without keepalives and questions.
    heard: Mutex<Vec<String>>,
    /// It takes connections and answers nothing.
    pub is_deaf: AtomicBool,
    /// What it says of a stop; empty: everything rests.
    pub unrest: Mutex<String>,
    /// Further lines of its status.
    pub more: Mutex<String>,
    connections: Mutex<Vec<TcpStream>>,
}

impl Fake {
    pub fn new() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let at = listener.local_addr().unwrap();
        let state = Arc::<FakeState>::default();
        let told = state.clone();
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                told.connections
                    .lock()
                    .unwrap()
                    .push(stream.try_clone().unwrap());
                let told = told.clone();
                std::thread::spawn(move || told.serve(stream));
            }
        });
        Self { at, state }
    }

    /// Ends its connections, as a robot that is switched off and on again.
    pub fn hang_up(&self) {
        for stream in self.state.connections.lock().unwrap().drain(..) {
            let _ = stream.shutdown(std::net::Shutdown::Both);
        }
    }

    pub fn heard(&self) -> Vec<String> {
        self.state.heard.lock().unwrap().clone()
    }
}

impl FakeState {
    fn serve(&self, mut stream: TcpStream) {
        // As robots do; else a second message waits for the first one.
        stream.set_nodelay(true).unwrap();
        let mut decoder = Decoder::new(1 << 24);
        let mut buffer = vec![0; 1 << 16];
        while let Ok(size @ 1..) = stream.read(&mut buffer) {
            decoder.feed(&buffer[..size]);
            while let Ok(Some(frame)) = decoder.next() {
                let text = String::from_utf8_lossy(frame).into_owned();
                for answer in self.answer(&text) {
                    if stream.write_all(&encode(answer.as_bytes())).is_err() {
                        return;
                    }
                }
            }
        }
    }

    fn answer(&self, text: &str) -> Vec<String> {
        if self.is_deaf.load(Ordering::Relaxed) || text == "keepalive" {
            return Vec::new();
        }
        let mut runs = self.runs.lock().unwrap();
        if text != "status" && text != "version" {
            let head: Vec<_> = text.splitn(3, ':').take(2).collect();
            self.heard.lock().unwrap().push(head.join(":"));
        }
        if text == "status" {
            let line = match runs.is_empty() {
                true => "none".to_owned(),
                false => format!("{runs} (JavaScript) for 1 s"),
            };
            let more = self.more.lock().unwrap();
            return vec![format!(
                "status: program {line}\nprograms 1 started\n{more}"
            )];
        }
        if text == "version" {
            return vec!["version: 3.1.4".to_owned()];
        }
        let unrest = self.unrest.lock().unwrap().clone();
        if text == "stop" && !unrest.is_empty() {
            return vec![format!("error: {unrest}")];
        }
        if text == "stop" {
            let ended = std::mem::take(&mut *runs);
            return match ended.is_empty() {
                true => Vec::new(),
                false => vec![format!("info: {ended} was stopped by a client after 1.0 s")],
            };
        }
        match text.strip_prefix("run:") {
            Some("bad.js") => vec!["error: bad.js cannot be started: it is bad".to_owned()],
            Some(name) => {
                name.clone_into(&mut *runs);
                vec![format!("info: {name} has started")]
            }
            None if text.starts_with("file:full.js:") => {
                vec!["error: the upload failed: the disk is full".to_owned()]
            }
            None => Vec::new(),
        }
    }
}

/// Where a fake is, or nobody.
pub struct At(Option<SocketAddr>);

impl Whereabouts for At {
    fn find(&self) -> Result<Found, Words> {
        let address = self.0.ok_or_else(|| Words::new("nowhere", "nowhere"))?;
        Ok(Found {
            addresses: vec![address],
            page: Some(OwnPage::Port(8000)),
        })
    }
}

pub fn page(robots: &[Option<SocketAddr>], guests: Arc<dyn Guests>) -> ClassPage {
    let member = |(id, at): (usize, &Option<SocketAddr>)| Member {
        name: format!("r{id}"),
        group: String::new(),
        at: "there".to_owned(),
        whereabouts: Arc::new(At(*at)),
    };
    let settings = ClassSettings {
        name: "room".to_owned(),
        robots: robots.iter().enumerate().map(member).collect(),
        guests,
    };
    ClassPage::start("127.0.0.1:0".parse().unwrap(), settings).unwrap()
}

/// A viewer, and what it knows of each robot.
pub struct Viewer {
    pub socket: Socket,
    pub cards: Vec<Value>,
}

impl Viewer {
    pub fn of(page: &ClassPage) -> Self {
        let (head, mut socket) = Self::knock(page);
        assert!(head.starts_with("HTTP/1.1 101 "), "{head}");
        let hello: Value = serde_json::from_str(&socket.until("\"hello\"")).unwrap();
        let count = hello["robots"].as_array().unwrap().len();
        Self {
            socket,
            cards: vec![Value::Null; count],
        }
    }

    /// The beginning of the answer to a browser that wants to look, and its connection.
    pub fn knock(page: &ClassPage) -> (String, Socket) {
        let at = page.address();
        let answer = get(at, ClassPage::path(), "");
        let line = answer
            .lines()
            .find_map(|line| line.strip_prefix("set-cookie: "));
        let cookie = line.unwrap().split(';').next().unwrap();
        let mut stream = TcpStream::connect(at).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        let request = format!(
            "GET /socket/class HTTP/1.1\r\nHost: {at}\r\nCookie: {cookie}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut socket = Socket { stream };
        (socket.head(), socket)
    }

    /// Reads until these cards are so.
    pub fn until(&mut self, what: &str, holds: impl Fn(&[Value]) -> bool) {
        let end = Instant::now() + Duration::from_secs(60);
        while !holds(&self.cards) {
            assert!(Instant::now() < end, "{what}: {:?}", self.cards);
            let (_, text) = self
                .socket
                .next()
                .unwrap_or_else(|| panic!("{what}: the end"));
            let news: Value = serde_json::from_str(&text).unwrap();
            if news["is"] == "robot" {
                let id = usize::try_from(news["id"].as_u64().unwrap()).unwrap();
                self.cards[id] = news;
            }
        }
    }

    pub fn send(&mut self, robots: &str, name: &str, run: bool) {
        let head = format!("{{\"robots\":{robots},\"name\":\"{name}\",\"run\":{run}}}\nprint(1)");
        self.socket.send(2, head.as_bytes());
    }
}

pub fn all(cards: &[Value], holds: impl Fn(&Value) -> bool) -> bool {
    cards.iter().all(holds)
}
