//! The page of a class as viewers see it, over robots that are sockets of these tests and speak the control port.

use super::*;
use crate::client::{Socket, get};
use crate::guests::Everybody;
use frame::{Decoder, encode};
use lang_text::problem::Words;
use serde_json::Value;
use std::io::{Read, Write};
use std::net::{IpAddr, TcpListener, TcpStream};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A robot that runs what it is told to, in words alone.
struct Fake {
    at: SocketAddr,
    state: Arc<FakeState>,
}

#[derive(Default)]
struct FakeState {
    runs: Mutex<String>,
    /// What came, without keepalives and questions.
    heard: Mutex<Vec<String>>,
    /// It takes connections and answers nothing.
    is_deaf: AtomicBool,
    /// What it says of a stop; empty: everything rests.
    unrest: Mutex<String>,
    connections: Mutex<Vec<TcpStream>>,
}

impl Fake {
    fn new() -> Self {
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
    fn hang_up(&self) {
        for stream in self.state.connections.lock().unwrap().drain(..) {
            let _ = stream.shutdown(std::net::Shutdown::Both);
        }
    }

    fn heard(&self) -> Vec<String> {
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
            return vec![format!("status: program {line}\nprograms 1 started\n")];
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
struct At(Option<SocketAddr>);

impl Whereabouts for At {
    fn find(&self) -> Result<Found, Words> {
        let address = self.0.ok_or_else(|| Words::new("nowhere", "nowhere"))?;
        Ok(Found {
            addresses: vec![address],
            page: Some(OwnPage::Port(8000)),
        })
    }
}

fn page(robots: &[Option<SocketAddr>], guests: Arc<dyn Guests>) -> ClassPage {
    let member = |(id, at): (usize, &Option<SocketAddr>)| Member {
        name: format!("r{id}"),
        group: String::new(),
        at: "there".to_owned(),
        whereabouts: Arc::new(At(*at)),
    };
    ClassPage::start(ClassSettings {
        address: "127.0.0.1:0".parse().unwrap(),
        name: "room".to_owned(),
        robots: robots.iter().enumerate().map(member).collect(),
        guests,
    })
    .unwrap()
}

/// A viewer, and what it knows of each robot.
struct Viewer {
    socket: Socket,
    cards: Vec<Value>,
}

impl Viewer {
    fn of(page: &ClassPage) -> Self {
        let at = page.address();
        let answer = get(at, ClassPage::path(), "");
        let line = answer
            .lines()
            .find_map(|line| line.strip_prefix("set-cookie: "));
        let cookie = line.unwrap().split(';').next().unwrap();
        let mut stream = TcpStream::connect(at).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(10)))
            .unwrap();
        let request = format!(
            "GET /socket HTTP/1.1\r\nHost: {at}\r\nCookie: {cookie}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut socket = Socket { stream };
        assert!(socket.head().starts_with("HTTP/1.1 101 "));
        let hello: Value = serde_json::from_str(&socket.until("\"hello\"")).unwrap();
        let count = hello["robots"].as_array().unwrap().len();
        Self {
            socket,
            cards: vec![Value::Null; count],
        }
    }

    /// Reads until these cards are so.
    fn until(&mut self, what: &str, holds: impl Fn(&[Value]) -> bool) {
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

    fn send(&mut self, robots: &str, name: &str, run: bool) {
        let head = format!("{{\"robots\":{robots},\"name\":\"{name}\",\"run\":{run}}}\nprint(1)");
        self.socket.send(2, head.as_bytes());
    }
}

fn all(cards: &[Value], holds: impl Fn(&Value) -> bool) -> bool {
    cards.iter().all(holds)
}

#[test]
fn each_robot_has_a_card_that_says_what_it_does_or_why_it_is_not_there() {
    let robot = Fake::new();
    let gone = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let page = page(&[Some(robot.at), Some(gone), None], Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("all are known", |cards| {
        cards[0]["reach"] == "there"
            && cards[1]["reach"] == "absent"
            && cards[2]["reach"] == "absent"
    });
    let why = viewer.cards[1]["why"].as_str().unwrap();
    assert!(why.starts_with("nothing takes programs at "), "{why}");
    assert_eq!(viewer.cards[2]["why"], "nowhere");
    assert_eq!(viewer.cards[0]["page"], "http://127.0.0.1:8000/");
    robot.hang_up();
    viewer.until("it is gone", |cards| cards[0]["reach"] == "absent");
    viewer.until("it is back", |cards| cards[0]["reach"] == "there");
    // Who comes later is told the same.
    let mut other = Viewer::of(&page);
    other.until("all are known", |cards| {
        all(cards, |card| card["reach"].is_string())
    });
}

#[test]
fn a_file_goes_to_the_chosen_ones_and_what_becomes_of_it_is_told_for_each() {
    let robots = [Fake::new(), Fake::new(), Fake::new()];
    let ways: Vec<_> = robots.iter().map(|robot| Some(robot.at)).collect();
    let page = page(&[&ways[..], &[None]].concat(), Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("they are there", |cards| {
        all(&cards[..3], |card| card["reach"] == "there")
    });
    viewer.send("[0,2,3]", "a.js", true);
    viewer.until("two run it", |cards| {
        cards[0]["runs"] == "a.js"
            && cards[2]["runs"] == "a.js"
            && cards[3]["sending"]["is"] == "failed"
    });
    assert_eq!(viewer.cards[0]["sending"]["is"], "runs");
    assert_eq!(
        viewer.cards[3]["sending"]["why"],
        "the robot is not reached"
    );
    assert_eq!(robots[0].heard(), ["file:a.js", "run:a.js"]);
    assert!(robots[1].heard().is_empty());
    viewer.send("[1]", "full.js", true);
    viewer.until("it is refused", |cards| {
        cards[1]["sending"]["is"] == "failed"
    });
    assert_eq!(
        viewer.cards[1]["sending"]["why"],
        "the upload failed: the disk is full"
    );
    viewer.send("[1]", "b.js", false);
    viewer.until("it is there", |cards| cards[1]["sending"]["is"] == "sent");
    viewer
        .socket
        .order(r#"{"do":"run","robots":[1],"name":"bad.js"}"#);
    viewer.until("it does not run", |cards| {
        cards[1]["sending"]["name"] == "bad.js" && cards[1]["sending"]["is"] == "failed"
    });
    let why = viewer.cards[1]["sending"]["why"].as_str().unwrap();
    assert!(why.contains("it is bad"), "{why}");
}

#[test]
fn a_stop_reaches_all_and_waits_for_one_that_is_gone() {
    let robots = [Fake::new(), Fake::new()];
    let page = page(
        &[Some(robots[0].at), Some(robots[1].at)],
        Arc::new(Everybody),
    );
    let mut viewer = Viewer::of(&page);
    viewer.until("they are there", |cards| {
        all(cards, |card| card["reach"] == "there")
    });
    viewer
        .socket
        .order(r#"{"do":"run","robots":[0,1],"name":"a.js"}"#);
    viewer.until("both run", |cards| {
        all(cards, |card| card["runs"] == "a.js")
    });
    // One hangs: it is connected and answers nothing, which delays nobody.
    robots[1].state.is_deaf.store(true, Ordering::Relaxed);
    viewer.socket.order(r#"{"do":"stop","robots":[0,1]}"#);
    viewer.until("one rests", |cards| {
        cards[0]["stop"]["is"] == "rests" && cards[0]["runs"].is_null()
    });
    assert_eq!(viewer.cards[1]["stop"]["is"], "asked");
    robots[1].hang_up();
    viewer.until("it is gone", |cards| cards[1]["reach"] == "absent");
    assert_eq!(viewer.cards[1]["stop"]["is"], "asked");
    robots[1].state.is_deaf.store(false, Ordering::Relaxed);
    viewer.until("it is back and rests", |cards| {
        cards[1]["stop"]["is"] == "rests"
    });
    assert!(robots[1].heard().contains(&"stop".to_owned()));
    // What begins again is not at rest.
    viewer
        .socket
        .order(r#"{"do":"run","robots":[0],"name":"a.js"}"#);
    viewer.until("it runs", |cards| cards[0]["runs"] == "a.js");
    assert!(viewer.cards[0]["stop"].is_null());
}

#[test]
fn a_robot_that_says_that_something_does_not_rest_is_not_at_rest() {
    let robot = Fake::new();
    let page = page(&[Some(robot.at)], Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("it is there", |cards| cards[0]["reach"] == "there");
    for start in EXPLAINED {
        let why = format!("{start}x");
        robot.state.unrest.lock().unwrap().clone_from(&why);
        viewer.socket.order(r#"{"do":"stop","robots":[0]}"#);
        viewer.until(&why, |cards| {
            cards[0]["stop"]["is"] == "failed" && cards[0]["stop"]["why"] == why
        });
    }
    robot.state.unrest.lock().unwrap().clear();
    viewer.socket.order(r#"{"do":"stop","robots":[0]}"#);
    viewer.until("it rests", |cards| cards[0]["stop"]["is"] == "rests");
}

#[test]
fn a_file_that_is_on_its_way_is_not_run_before_it_is_there() {
    let robot = Fake::new();
    let page = page(&[Some(robot.at)], Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("it is there", |cards| cards[0]["reach"] == "there");
    robot.state.is_deaf.store(true, Ordering::Relaxed);
    viewer.send("[0]", "a.js", false);
    viewer.until("it is on its way", |cards| {
        cards[0]["sending"]["is"] == "sending"
    });
    let run = r#"{"do":"run","robots":[0],"name":"a.js"}"#;
    viewer.socket.order(run);
    let why = viewer.socket.until("\"refused\"");
    assert!(why.contains("files are on their way"), "{why}");
}

/// Others look; whether this computer may do something is told.
struct Sometimes(AtomicBool);

impl Guests for Sometimes {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn asks(&self, _: IpAddr) {}
}

#[test]
fn those_who_only_look_take_no_place_from_who_commands() {
    let guests = Arc::new(Sometimes(AtomicBool::new(false)));
    let page = page(&[None], guests.clone());
    let all: Vec<_> = (0..limits::BROWSERS_MAX)
        .map(|_| Viewer::of(&page))
        .collect();
    let refused = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| Viewer::of(&page)));
    assert!(refused.is_err(), "there is no more place to look");
    guests.0.store(true, Ordering::Relaxed);
    drop(Viewer::of(&page));
    drop(all);
}

/// Others look, and may do nothing.
struct Looks;

impl Guests for Looks {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        false
    }

    fn asks(&self, _: IpAddr) {}
}

#[test]
fn a_computer_that_may_only_look_commands_nothing() {
    let robot = Fake::new();
    let page = page(&[Some(robot.at)], Arc::new(Looks));
    let mut viewer = Viewer::of(&page);
    viewer.until("it is there", |cards| cards[0]["reach"] == "there");
    viewer.socket.order(r#"{"do":"stop","robots":[0]}"#);
    let why = viewer.socket.until("\"refused\"");
    assert!(why.contains("this computer may only look"), "{why}");
    viewer.send("[0]", "a.js", true);
    viewer.socket.until("\"refused\"");
    assert!(robot.heard().is_empty());
}

#[test]
fn nothing_is_given_to_pages_of_others() {
    let page = page(&[None], Arc::new(Everybody));
    let at = page.address();
    assert!(get(at, "/", "").starts_with("HTTP/1.1 307 "));
    for (path, headers) in [
        ("/socket", ""),
        ("/socket", "Cookie: trik=guessed\r\n"),
        ("/class", "Origin: http://evil.example\r\n"),
    ] {
        let answer = get(at, path, headers);
        assert!(answer.starts_with("HTTP/1.1 403 "), "{path}: {answer}");
        assert!(!answer.contains("set-cookie"), "{answer}");
    }
    let answer = get(at, "/class", "");
    assert!(
        answer.contains("content-security-policy: default-src 'none'"),
        "{answer}"
    );
    // Those of one robot are not here.
    assert!(get(at, "/programs", "").starts_with("HTTP/1.1 404 "));
}

/// `cargo test -p page --release -- --ignored --nocapture thirty` measures.
#[test]
#[ignore = "measures"]
fn thirty_robots_are_told_to_stop_at_once() {
    let robots: Vec<_> = (0..30).map(|_| Fake::new()).collect();
    let ways: Vec<_> = robots.iter().map(|robot| Some(robot.at)).collect();
    let page = page(&ways, Arc::new(Everybody));
    let mut viewer = Viewer::of(&page);
    viewer.until("they are there", |cards| {
        all(cards, |card| card["reach"] == "there")
    });
    let everybody = format!("{:?}", (0..30).collect::<Vec<_>>());
    let mut took = Vec::new();
    for _ in 0..100 {
        let run = format!("{{\"do\":\"run\",\"robots\":{everybody},\"name\":\"a.js\"}}");
        viewer.socket.order(&run);
        viewer.until("all run", |cards| all(cards, |card| card["runs"] == "a.js"));
        let begun = Instant::now();
        viewer
            .socket
            .order(&format!("{{\"do\":\"stop\",\"robots\":{everybody}}}"));
        viewer.until("all rest", |cards| {
            all(cards, |card| card["stop"]["is"] == "rests")
        });
        took.push(begun.elapsed());
    }
    took.sort_unstable();
    println!(
        "all at rest, as a viewer sees it: median {:?}, p99 {:?}, most {:?}",
        took[50], took[98], took[99]
    );
}
