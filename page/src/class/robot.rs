//! The connection to one robot of a class: it comes back by itself, later and later while nobody is there.
//!
//! Owns the connection and what a robot's words mean for its card. A stop overtakes all that was not sent yet; files have
//! connections of their own, so that none is in its way.

use super::board::{Battery, Board, Card, Commander, Reach, Stage, Stop};
use super::member::{Found, Whereabouts};
use super::words::Why;
use crate::error::plain;
use crate::limits;
use frame::{Decoder, encode};
use futures_util::FutureExt;
use std::io;
use std::net::SocketAddr;
use std::panic::AssertUnwindSafe;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::{Notify, mpsc};
use tokio::time::{Instant, MissedTickBehavior, Sleep, interval, sleep, timeout};

/// How errors begin that say why not everything rests; others are those of a program.
pub const EXPLAINED: [&str; 4] = [
    "there is no tree at ",
    "the tree at ",
    "not everything is at rest: ",
    "the tree has not brought the motors to rest ",
];
/// What a robot says of a program that has started, after its name.
pub const STARTED: &str = " has started";

/// How the line of a status begins that tells of the battery.
pub const BATTERY: &str = "battery ";
/// That of who commands.
pub const COMMANDER: &str = "control ";
/// That of who debugs.
pub const DEBUGGER: &str = "debugger ";

/// Keeps the connection for ever, also after a panic of this program.
pub async fn run(board: Arc<Board>, id: usize, whereabouts: Arc<dyn Whereabouts>) {
    let Some(mut runs) = board.take_runs(id) else {
        return;
    };
    loop {
        let kept = AssertUnwindSafe(keep(&board, id, &whereabouts, &mut runs));
        // It ends by a panic alone, which the terminal has.
        let _ = kept.catch_unwind().await;
        board.change(id, |card| lose(card, Why::Failed));
        sleep(limits::CLASS_LATEST_TIME).await;
    }
}

async fn keep(
    board: &Board,
    id: usize,
    whereabouts: &Arc<dyn Whereabouts>,
    runs: &mut mpsc::Receiver<String>,
) {
    let mut wait = limits::CLASS_SOONEST_TIME;
    loop {
        let why = match connect(whereabouts).await {
            Ok((stream, found, at)) => {
                board.change(id, |card| {
                    card.reach = Reach::There(at);
                    card.page = found.page;
                });
                let own = stream.local_addr().ok();
                let talk = Talk::new(board, id, own);
                let why = talk.run(stream, runs).await;
                // One that lets people in and says nothing is not asked more often for that.
                if talk.has_answered() {
                    wait = limits::CLASS_SOONEST_TIME;
                }
                why
            }
            Err(why) => why,
        };
        board.change(id, |card| lose(card, why));
        // An order that was not answered stays for the next connection.
        keep_stop(board, id);
        tokio::select! {
            () = sleep(wait) => wait = (wait * 2).min(limits::CLASS_LATEST_TIME),
            // A stop does not wait for that.
            () = stopped(board, id) => if keep_stop(board, id) {
                sleep(limits::CLASS_SOONEST_TIME).await;
            },
        }
    }
}

async fn stopped(board: &Board, id: usize) {
    match board.commands(id) {
        Some(told) => told.stop.notified().await,
        None => std::future::pending().await,
    }
}

/// Whether a stop is still to be given; if so, the sender of the connection is told.
fn keep_stop(board: &Board, id: usize) -> bool {
    let told = board
        .commands(id)
        .filter(|_| board.wanted_stop(id).is_some());
    if let Some(told) = told {
        told.stop.notify_one();
    }
    told.is_some()
}

/// What is not known any more of a robot that is gone.
fn lose(card: &mut Card, why: Why) {
    card.reach = Reach::Absent(why);
    card.runs = None;
    card.commander = None;
    card.debugger = None;
    if let Some(sending) = &mut card.sending
        && matches!(sending.stage, Stage::Starts)
    {
        sending.stage = Stage::Failed(Why::Away);
    }
}

/// Where it is, and a connection to it.
async fn connect(
    whereabouts: &Arc<dyn Whereabouts>,
) -> Result<(TcpStream, Found, SocketAddr), Why> {
    let asked = whereabouts.clone();
    let found = match tokio::task::spawn_blocking(move || asked.find()).await {
        Ok(found) => found.map_err(Why::Nowhere)?,
        Err(_) => return Err(Why::Failed),
    };
    let mut why = Why::Failed;
    for &at in &found.addresses {
        match open(at).await {
            Ok(stream) => return Ok((stream, found, at)),
            Err(error) => why = error,
        }
    }
    Err(why)
}

/// A connection to an address.
///
/// # Errors
/// Nobody takes programs there.
pub async fn open(at: SocketAddr) -> Result<TcpStream, Why> {
    match timeout(limits::CLASS_CONNECT_TIME, TcpStream::connect(at)).await {
        Ok(Ok(stream)) => {
            stream
                .set_nodelay(true)
                .map_err(|error| Why::of(at, &error))?;
            Ok(stream)
        }
        Ok(Err(error)) => Err(Why::of(at, &error)),
        Err(_) => Err(Why::NoAnswer(at)),
    }
}

/// How far a conversation is. Requests are answered in their order, so what was asked for before a `status` is done when that
/// is answered.
#[derive(Debug, Default)]
struct Progress {
    /// How many `status` were asked and answered.
    asked: u64,
    answered: u64,
    /// The one after a stop, and when that was ordered.
    stop: Option<(u64, Instant)>,
    /// The one after a start, and of which program.
    start: Option<(u64, String)>,
    /// Why not everything rests, said since the stop.
    unrest: Option<String>,
}

/// A conversation with a robot that is there.
struct Talk<'a> {
    board: &'a Board,
    id: usize,
    /// This end of the connection, as the robot calls it.
    own: Option<SocketAddr>,
    progress: Mutex<Progress>,
    /// Something has happened of which the status tells.
    news: Notify,
}

impl<'a> Talk<'a> {
    fn new(board: &'a Board, id: usize, own: Option<SocketAddr>) -> Self {
        Self {
            board,
            id,
            own,
            progress: Mutex::default(),
            news: Notify::new(),
        }
    }

    fn progress(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Talks until the connection is lost, and says why it is.
    async fn run(&self, stream: TcpStream, runs: &mut mpsc::Receiver<String>) -> Why {
        // What was to be started before it was gone is old.
        while runs.try_recv().is_ok() {}
        let (read, write) = stream.into_split();
        tokio::select! {
            why = self.receive(read) => why,
            error = self.send(write, runs) => Why::System(plain(&error)),
        }
    }

    /// Sends what is wanted until that fails, and gives the failure.
    async fn send(
        &self,
        mut write: OwnedWriteHalf,
        runs: &mut mpsc::Receiver<String>,
    ) -> io::Error {
        let Some(told) = self.board.commands(self.id) else {
            return io::ErrorKind::NotFound.into();
        };
        let mut keepalives = interval(limits::KEEPALIVE_TIME);
        keepalives.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut looks = interval(limits::CLASS_LOOK_TIME);
        looks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        // A robot that was not asked before has not looked at its battery: it tells of it when it is asked again.
        let mut soon = Some(Box::pin(sleep(limits::CLASS_AGAIN_TIME)));
        loop {
            let request = tokio::select! {
                biased;
                () = told.stop.notified() => {
                    while runs.try_recv().is_ok() {}
                    match self.board.wanted_stop(self.id) {
                        Some(ordered) => self.stop(ordered),
                        None => continue,
                    }
                }
                Some(name) = runs.recv() => self.start(name),
                () = self.news.notified() => self.status(),
                // News that the robot has left out are found so.
                _ = looks.tick() => self.status(),
                () = again(&mut soon) => self.status(),
                _ = keepalives.tick() => encode(b"keepalive"),
            };
            if let Err(error) = write.write_all(&request).await {
                return error;
            }
        }
    }

    fn status(&self) -> Vec<u8> {
        self.progress().asked += 1;
        encode(b"status")
    }

    fn stop(&self, ordered: Instant) -> Vec<u8> {
        let request = [encode(b"stop"), self.status()].concat();
        let mut progress = self.progress();
        progress.stop = Some((progress.asked, ordered));
        progress.start = None;
        progress.unrest = None;
        request
    }

    fn start(&self, name: String) -> Vec<u8> {
        let run = encode(format!("run:{name}").as_bytes());
        let request = [run, self.status()].concat();
        let mut progress = self.progress();
        progress.start = Some((progress.asked, name));
        request
    }

    /// Hears the robot until the connection is lost.
    async fn receive(&self, mut read: OwnedReadHalf) -> Why {
        let mut decoder = Decoder::new(limits::CLASS_MESSAGE_BYTES_MAX);
        let mut buffer = vec![0; limits::READ_BYTES];
        loop {
            let size = match timeout(limits::CLASS_SILENCE_TIME, read.read(&mut buffer)).await {
                Ok(Ok(0)) => return Why::Closed,
                Ok(Ok(size)) => size,
                Ok(Err(error)) => return Why::System(plain(&error)),
                Err(_) => return Why::Silent,
            };
            decoder.feed(&buffer[..size]);
            loop {
                match decoder.next() {
                    Ok(Some(frame)) => self.hear(frame),
                    Ok(None) => break,
                    Err(violation) => return Why::NoRobot(violation.to_string()),
                }
            }
        }
    }

    fn hear(&self, frame: &[u8]) {
        let says = |word: &[u8]| -> Option<String> {
            let text = frame.strip_prefix(word)?;
            Some(String::from_utf8_lossy(text).into_owned())
        };
        if let Some(text) = says(b"status: ") {
            self.told(&text);
        } else if let Some(text) = says(b"info: ") {
            if text.contains(STARTED) {
                self.board.change(self.id, |card| card.error = None);
            }
            self.news.notify_one();
        } else if let Some(text) = says(b"error: ") {
            let text = short(&text);
            if EXPLAINED.iter().any(|start| text.starts_with(start)) {
                self.progress().unrest = Some(text.clone());
            }
            self.board.change(self.id, |card| card.error = Some(text));
        }
    }

    /// The answer to a `status`.
    fn told(&self, text: &str) {
        let line = |word: &str| text.lines().find_map(|line| line.strip_prefix(word));
        let runs = line("program ").filter(|name| *name != "none").map(name_of);
        let battery = line(BATTERY).and_then(battery);
        let commander = line(COMMANDER).map(|who| self.commander(who));
        let debugger = line(DEBUGGER).map(address);
        let (mut stopped, mut started) = (None, None);
        {
            let mut progress = self.progress();
            progress.answered += 1;
            let answered = progress.answered;
            if let Some((due, ordered)) = progress.stop
                && due <= answered
            {
                progress.stop = None;
                stopped = Some((progress.unrest.take(), ordered));
            }
            if progress
                .start
                .as_ref()
                .is_some_and(|(due, _)| *due <= answered)
            {
                started = progress.start.take().map(|(_, name)| name);
            }
        }
        self.board.change(self.id, |card| {
            // One that was ordered again meanwhile is still to be given.
            if let (Some((unrest, ordered)), Some(Stop::Asked(since))) = (stopped, &card.stop)
                && ordered == *since
            {
                let ms = u64::try_from(since.elapsed().as_millis()).unwrap_or(u64::MAX);
                card.stop = Some(unrest.map_or(Stop::Rests(ms), Stop::Failed));
            }
            card.last = line("last ").map(short);
            card.battery = battery;
            card.commander = commander;
            card.debugger = debugger;
            let is_it = |name: &String| runs.as_deref() == Some(name.as_str());
            if let (Some(name), Some(sending)) = (&started, &mut card.sending)
                && sending.name == *name
                && sending.stage == Stage::Starts
            {
                let has_run = card
                    .last
                    .as_ref()
                    .is_some_and(|last| last.starts_with(name.as_str()));
                sending.stage = match is_it(name) || (has_run && card.error.is_none()) {
                    true => Stage::Runs,
                    false => Stage::Failed(Why::Said(card.error.clone().unwrap_or_default())),
                };
            }
            if runs.is_some() && card.runs != runs {
                // It moves again.
                card.stop = card
                    .stop
                    .take()
                    .filter(|stop| matches!(stop, Stop::Asked(_)));
            }
            card.runs = runs;
        });
    }

    /// Who commands, in the words of a status.
    fn commander(&self, who: &str) -> Commander {
        let is_own = self.own.is_some_and(|own| who.trim() == own.to_string());
        match is_own {
            true => Commander::Own,
            false => Commander::Other(address(who)),
        }
    }

    /// The robot has said what nothing else says.
    fn has_answered(&self) -> bool {
        self.progress().answered > 0
    }
}

/// Waits for the time once.
async fn again(once: &mut Option<Pin<Box<Sleep>>>) {
    match once {
        Some(time) => {
            time.await;
            *once = None;
        }
        None => std::future::pending().await,
    }
}

/// What a status says of the battery, as `11.8 V, 3 s ago`.
fn battery(text: &str) -> Option<Battery> {
    let (value, age) = text.trim().rsplit_once(", ")?;
    let seconds: u64 = age.strip_suffix(" s ago")?.parse().ok()?;
    let text = short(value);
    let at = Instant::now().checked_sub(Duration::from_secs(seconds))?;
    (!text.is_empty()).then_some(Battery { text, at })
}

/// The computer of `ADDRESS:PORT`, with or without words behind it: its port says nothing to people.
fn address(text: &str) -> String {
    let first = text.split_whitespace().next().unwrap_or_default();
    let at: Option<SocketAddr> = first.parse().ok();
    at.map_or_else(|| short(first), |at| at.ip().to_canonical().to_string())
}

/// The name of a program in the words of a status, as `a.js (JavaScript) for 3 s`.
fn name_of(text: &str) -> String {
    short(text.rsplit_once(" (").map_or(text, |(name, _)| name))
}

/// What a card shows of a text: one line without what commands a screen.
fn short(text: &str) -> String {
    let line = text.trim_end().lines().next_back().unwrap_or_default();
    let shown = line.chars().filter(|letter| !letter.is_control());
    shown.take(limits::CLASS_LETTERS_MAX).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_robot_says_is_one_line_of_bounded_length() {
        assert_eq!(name_of("a (b).js (JavaScript) for 3 s"), "a (b).js");
        assert_eq!(name_of("x"), "x");
        assert_eq!(short("first\n\u{1b}[2Jlast\n"), "[2Jlast");
        assert_eq!(short(&"x".repeat(100_000)).len(), limits::CLASS_LETTERS_MAX);
        assert_eq!(short(""), "");
    }

    #[test]
    fn a_battery_and_an_address_are_read_and_rubbish_is_none() {
        let told = battery("11.87 V, 3 s ago").unwrap();
        assert_eq!(told.text, "11.87 V");
        assert!(told.at.elapsed() >= Duration::from_secs(3));
        for text in ["", "11.87 V", "11 V, x s ago", ", 3 s ago", "1 V, -1 s ago"] {
            assert_eq!(battery(text), None, "{text}");
        }
        assert_eq!(battery(&format!("1 V, {} s ago", u64::MAX)), None);
        assert_eq!(address("[::ffff:10.0.0.1]:5"), "10.0.0.1");
        assert_eq!(address("10.0.0.1:5 is in control"), "10.0.0.1");
        assert_eq!(address("a\u{1b}b"), "ab");
        assert_eq!(address(""), "");
    }

    struct Nowhere;

    impl Whereabouts for Nowhere {
        fn find(&self) -> Result<Found, lang_text::problem::Words> {
            Err(lang_text::problem::Words::new("nowhere", "nowhere"))
        }
    }

    #[test]
    fn the_answer_to_a_stop_is_none_to_a_later_one() {
        let board = Board::new(&[super::super::Member {
            name: "r".to_owned(),
            group: String::new(),
            at: String::new(),
            whereabouts: Arc::new(Nowhere),
        }]);
        let talk = Talk::new(&board, 0, None);
        let is_asked = || board.with(0, |card| matches!(card.stop, Some(Stop::Asked(_))));
        board.stop(0);
        talk.stop(board.wanted_stop(0).unwrap());
        // The first is answered when the second was ordered and not sent.
        board.stop(0);
        talk.told("program none\n");
        assert_eq!(is_asked(), Some(true));
        talk.stop(board.wanted_stop(0).unwrap());
        talk.told("program none\n");
        assert_eq!(is_asked(), Some(false));
    }
}
