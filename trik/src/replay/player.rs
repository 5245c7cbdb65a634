//! The player: one thread that has the clock, gives each node of a replayed tree what was recorded when its time comes, and
//! hears what programs write.
//!
//! Owns the socket that `played` sources connect to, and the control file. What comes is bounded: a reader without room loses
//! the event, and is told the newest value again when the recording is turned. Knows no file format: see `recording`.

use super::clock::Clock;
use super::order::{BadOrder, Order, Wanted};
use super::outputs::Output;
use super::peer::{Peer, Wish, wish};
use super::recording::{Event, Reading, Recording};
use crate::error::Error;
use crate::limits;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::eventfd::{EfdFlags, EventFd};
use nix::sys::socket::{
    AddressFamily, Backlog, MsgFlags, SockFlag, SockType, UnixAddr, bind, listen, recv, send,
    socket,
};
use rustix::net::{SocketFlags, accept_with};
use sim::fifo::In;
use std::os::fd::{AsFd, AsRawFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// What a player tells of itself.
#[derive(Clone, Debug, Default)]
pub(crate) struct State {
    pub(crate) position: Duration,
    pub(crate) length: Duration,
    pub(crate) speed: f64,
    pub(crate) runs: bool,
    pub(crate) is_loop: bool,
    /// Events that were given out.
    pub(crate) given: u64,
    /// Events for which a reader had no room.
    pub(crate) dropped: u64,
    /// Changes that programs have made as recorded.
    pub(crate) same: u32,
    /// Where actuators leave the recording, as lines.
    pub(crate) differences: Vec<String>,
    /// The end was reached and nothing follows.
    pub(crate) is_at_end: bool,
    /// Why it went no further than this.
    pub(crate) failure: Option<String>,
}

/// What both threads have.
#[derive(Default)]
struct Shared {
    state: State,
    orders: Vec<Order>,
    /// For a person who sees no view.
    news: Vec<String>,
    is_ending: bool,
}

/// A running player. Dropping it ends it.
pub(crate) struct Player {
    shared: Arc<Mutex<Shared>>,
    wake: Arc<EventFd>,
    thread: Option<JoinHandle<()>>,
}

/// How a replay begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Begin {
    pub(crate) at: Duration,
    pub(crate) speed: f64,
    pub(crate) is_paused: bool,
    pub(crate) is_loop: bool,
}

impl Player {
    /// Serves a recording at a socket, and takes orders from a FIFO; both are made in the folder.
    ///
    /// # Errors
    /// The socket, the FIFO or the recording cannot be had.
    pub(crate) fn start(
        recording: Box<dyn Recording + Send>,
        folder: &Path,
        begin: Begin,
    ) -> Result<Self, Error> {
        let path = folder.join(SOCKET);
        let fail = |error: nix::Error| Error::file(&path, error.desc());
        let flags = SockFlag::SOCK_CLOEXEC | SockFlag::SOCK_NONBLOCK;
        let listener =
            socket(AddressFamily::Unix, SockType::SeqPacket, flags, None).map_err(fail)?;
        let address = UnixAddr::new(&path).map_err(fail)?;
        bind(listener.as_raw_fd(), &address).map_err(fail)?;
        listen(&listener, Backlog::MAXCONN).map_err(fail)?;
        let control = folder.join(CONTROL);
        let control_in = In::make(control.clone()).map_err(|why| Error::file(&control, why))?;
        let wake = EventFd::from_flags(EfdFlags::EFD_CLOEXEC | EfdFlags::EFD_NONBLOCK)
            .map_err(|why| Error::system("eventfd", why))?;
        let wake = Arc::new(wake);
        let shared = Arc::<Mutex<Shared>>::default();
        let mut scene = Scene {
            clock: Clock::new(
                Instant::now(),
                recording.length(),
                begin.speed,
                !begin.is_paused,
            ),
            newest: vec![None; recording.channels().len()],
            is_told: vec![false; recording.channels().len()],
            outputs: vec![Output::new(); recording.channels().len()],
            recording,
            listener,
            control: control_in,
            complaint: folder.join(format!("{CONTROL}.error")),
            wake: wake.clone(),
            shared: shared.clone(),
            peers: Vec::new(),
            next: None,
            steps: 0,
            is_loop: begin.is_loop,
            was_at_end: false,
            message: vec![0; limits::REPLAY_MESSAGE_BYTES],
        };
        scene.learn_outputs()?;
        scene.seek(begin.at)?;
        scene.publish_state();
        let thread = std::thread::Builder::new()
            .name("player".to_owned())
            .spawn(move || scene.run())
            .map_err(|why| Error::system("a thread", why))?;
        Ok(Self {
            shared,
            wake,
            thread: Some(thread),
        })
    }

    /// Asks for something about the clock.
    pub(crate) fn order(&self, order: Order) {
        let mut shared = lock(&self.shared);
        if shared.orders.len() < limits::REPLAY_ORDERS_MAX {
            shared.orders.push(order);
        }
        drop(shared);
        // A counter that is full wakes as well.
        let _ = self.wake.write(1);
    }

    /// How it is.
    pub(crate) fn state(&self) -> State {
        lock(&self.shared).state.clone()
    }

    /// What has happened since the last call.
    pub(crate) fn take_news(&self) -> Vec<String> {
        std::mem::take(&mut lock(&self.shared).news)
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        lock(&self.shared).is_ending = true;
        let _ = self.wake.write(1);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The socket in the folder of a player.
pub(crate) const SOCKET: &str = "player.sock";
/// The FIFO that takes orders.
pub(crate) const CONTROL: &str = "replay";

/// A panic elsewhere has left whole values here.
fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Everything that the thread has.
struct Scene {
    recording: Box<dyn Recording + Send>,
    clock: Clock,
    /// What each channel has at the position.
    newest: Vec<Option<Reading>>,
    /// Which channels have had their next event already, at the beginning.
    is_told: Vec<bool>,
    outputs: Vec<Output>,
    listener: OwnedFd,
    control: In,
    /// Where a bad order is told.
    complaint: PathBuf,
    wake: Arc<EventFd>,
    shared: Arc<Mutex<Shared>>,
    peers: Vec<Peer>,
    /// What comes next; None at the end.
    next: Option<Event>,
    /// Events to give while the clock stands.
    steps: u32,
    is_loop: bool,
    was_at_end: bool,
    /// Room for what a peer says.
    message: Vec<u8>,
}

impl Scene {
    fn run(&mut self) {
        loop {
            if lock(&self.shared).is_ending {
                return;
            }
            if let Err(error) = self.play() {
                self.next = None;
                self.was_at_end = true;
                self.clock.run(Instant::now(), false);
                self.fail(&error.to_string());
            }
            self.publish_state();
            match self.wait() {
                Ok(speaking) => self.hear(&speaking),
                Err(error) => return self.fail(&format!("poll: {error}")),
            }
        }
    }

    /// The rows of changes of all that can be written.
    fn learn_outputs(&mut self) -> Result<(), Error> {
        let channels = self.recording.channels().iter().enumerate();
        let written = channels.filter(|(_, channel)| channel.is_written);
        let written: Vec<usize> = written.map(|(at, _)| at).collect();
        if written.is_empty() {
            return Ok(());
        }
        self.recording.seek_among(Duration::ZERO, &written)?;
        while let Some(event) = self.recording.next()? {
            if let Reading::Sample(tuple) = &event.what {
                self.outputs[event.channel].record(event.at, tuple, limits::REPLAY_CHANGES_MAX);
            }
        }
        Ok(())
    }

    /// Until when somebody is waited for who has come and has not said yet what it reads.
    fn shy_until(&self, now: Instant) -> Option<Instant> {
        let peers = self.peers.iter();
        peers.filter_map(|peer| peer.shy_until(now)).max()
    }

    /// Gives out all that is due, a bounded number at once.
    fn play(&mut self) -> Result<(), Error> {
        if self.shy_until(Instant::now()).is_some() {
            return Ok(());
        }
        for _ in 0..limits::REPLAY_BATCH {
            let Some(next) = &self.next else {
                return self.end();
            };
            let now = Instant::now();
            // What has waited for a machine that stalled would come at once, and overrun the rings of nodes.
            self.clock.hold(now, next.at, LATE);
            if self.steps > 0 {
                self.steps -= 1;
                let at = next.at;
                self.clock.jump(now, at);
            } else if next.at > self.clock.position(now) {
                return Ok(());
            }
            let Some(event) = self.next.take() else {
                return Ok(());
            };
            if !std::mem::take(&mut self.is_told[event.channel]) {
                self.newest[event.channel] = Some(event.what);
                self.give(event.channel);
            }
            lock(&self.shared).state.given += 1;
            self.next = self.recording.next()?;
        }
        Ok(())
    }

    /// Nothing follows: begins again when the clock is at the end, if that is wanted.
    fn end(&mut self) -> Result<(), Error> {
        self.steps = 0;
        let now = Instant::now();
        let is_at_end = self.clock.position(now) >= self.clock.length();
        if is_at_end && self.is_loop && self.clock.length() > Duration::ZERO {
            // What each node had at the end stays until its next sample: nobody went anywhere.
            let newest = self.newest.clone();
            self.is_told.fill(false);
            return self.turn_to(Duration::ZERO, Duration::ZERO, newest);
        }
        if is_at_end && !std::mem::replace(&mut self.was_at_end, true) {
            self.news("the recording is at its end".to_owned());
        }
        Ok(())
    }

    /// Tells the newest of a channel to its readers.
    fn give(&mut self, channel: usize) {
        let Some(what) = &self.newest[channel] else {
            return;
        };
        let message = message(what);
        let mut dropped = 0;
        for peer in &mut self.peers {
            if peer.wish == Wish::Read(channel) {
                match send(peer.socket.as_raw_fd(), &message, QUIET) {
                    Ok(_) => {}
                    Err(nix::Error::EAGAIN) => dropped += 1,
                    Err(_) => peer.wish = Wish::Gone,
                }
            }
        }
        lock(&self.shared).state.dropped += dropped;
    }

    /// Goes to a position: every reader gets what its node had there.
    fn seek(&mut self, position: Duration) -> Result<(), Error> {
        let position = position.min(self.clock.length());
        // With what happened at this very moment: at the beginning there is nothing before it.
        let after = position.saturating_add(Duration::from_nanos(1));
        let mut newest = self.recording.newest(after)?;
        self.is_told.fill(false);
        if position < BEGINNING {
            self.learn_first(after, &mut newest)?;
        }
        for (newest, before) in newest.iter_mut().zip(&self.newest) {
            if newest.is_none() && before.is_some() {
                // Readers have a value that is not of this moment.
                *newest = Some(Reading::Failure(
                    nix::Error::ETIMEDOUT as i32,
                    "nothing was recorded before this moment".to_owned(),
                ));
            }
        }
        self.turn_to(position, after, newest)?;
        for channel in 0..self.newest.len() {
            self.give(channel);
        }
        Ok(())
    }

    /// A node of which nothing was recorded yet has what the recorder found of it when it began.
    fn learn_first(&mut self, after: Duration, found: &mut [Option<Reading>]) -> Result<(), Error> {
        self.recording.seek(after)?;
        while let Some(event) = self.recording.next()?
            && event.at <= BEGINNING
        {
            if found[event.channel].is_none() {
                found[event.channel] = Some(event.what);
                self.is_told[event.channel] = true;
            }
        }
        Ok(())
    }

    /// Goes to a position at which nodes have this, and gives what happened from `next` on.
    fn turn_to(
        &mut self,
        position: Duration,
        next: Duration,
        newest: Vec<Option<Reading>>,
    ) -> Result<(), Error> {
        self.clock.jump(Instant::now(), position);
        self.newest = newest;
        self.recording.seek(next)?;
        self.next = self.recording.next()?;
        self.was_at_end = false;
        for output in &mut self.outputs {
            output.seek(position);
        }
        lock(&self.shared).state.differences.clear();
        Ok(())
    }

    /// When there is something to do without anybody asking.
    fn due(&self, now: Instant) -> Option<Instant> {
        match &self.next {
            _ if self.shy_until(now).is_some() => self.shy_until(now),
            Some(_) if self.steps > 0 => Some(now),
            Some(next) => self.clock.due(next.at),
            // Its end, once.
            None if self.was_at_end => None,
            None => self.clock.due(self.clock.length()),
        }
    }

    /// Waits for that, for orders, and for peers; gives those that have something to say.
    fn wait(&self) -> nix::Result<Vec<usize>> {
        let now = Instant::now();
        let most = Duration::from_millis(limits::VIEW_MS.into());
        let left = (self.due(now)).map_or(most, |at| at.saturating_duration_since(now));
        let left = PollTimeout::try_from(left.min(most)).unwrap_or(PollTimeout::MAX);
        let ours = [self.listener.as_fd(), self.control.fd(), self.wake.as_fd()];
        let peers = self.peers.iter().map(|peer| peer.socket.as_fd());
        let all = ours.into_iter().chain(peers);
        let mut fds: Vec<_> = all.map(|fd| PollFd::new(fd, PollFlags::POLLIN)).collect();
        match poll(&mut fds, left) {
            Err(nix::Error::EINTR) => Ok(Vec::new()),
            Err(error) => Err(error),
            Ok(_) => {
                let peers = fds[ours.len()..].iter().enumerate();
                let speaks = |fd: &PollFd<'_>| fd.any().unwrap_or(true);
                Ok(peers
                    .filter_map(|(at, fd)| speaks(fd).then_some(at))
                    .collect())
            }
        }
    }

    fn hear(&mut self, speaking: &[usize]) {
        let _ = self.wake.read();
        // One buffer for all; it is too large to be made anew for each.
        let mut bytes = std::mem::take(&mut self.message);
        for &at in speaking {
            self.hear_peer(at, &mut bytes);
        }
        self.message = bytes;
        self.peers.retain(|peer| peer.wish != Wish::Gone);
        self.admit();
        for line in self.control.lines() {
            let order = Order::read(&line);
            self.complain(order.as_ref().err());
            if let Ok(order) = order {
                self.obey(order);
            }
        }
        if self.control.take_left_out() > 0 {
            self.complain(Some(&BadOrder::Argument(Wanted::Printable)));
        }
        let orders = std::mem::take(&mut lock(&self.shared).orders);
        for order in orders {
            self.obey(order);
        }
        self.miss();
    }

    /// The last bad order is in a file until the next good one.
    fn complain(&self, bad: Option<&BadOrder>) {
        // If nobody can be told, the folder is gone.
        let _ = match bad {
            None => std::fs::remove_file(&self.complaint),
            Some(bad) => std::fs::write(&self.complaint, format!("{bad}\n")),
        };
    }

    fn admit(&mut self) {
        let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
        while let Ok(socket) = accept_with(&self.listener, flags) {
            if self.peers.len() < limits::REPLAY_PEERS_MAX {
                self.peers.push(Peer::new(socket, Instant::now()));
            }
        }
    }

    fn hear_peer(&mut self, at: usize, bytes: &mut [u8]) {
        for _ in 0..limits::REPLAY_BATCH {
            let peer = &mut self.peers[at];
            let size = match recv(peer.socket.as_raw_fd(), bytes, MsgFlags::empty()) {
                Ok(0) => 0,
                Ok(size) => size,
                Err(nix::Error::EAGAIN | nix::Error::EINTR) => return,
                Err(_) => 0,
            };
            let said = &bytes[..size];
            match peer.wish {
                _ if size == 0 => peer.wish = Wish::Gone,
                Wish::Unknown => {
                    peer.wish = wish(&*self.recording, said);
                    if let Wish::Read(channel) = peer.wish {
                        let newest = self.newest[channel].as_ref().map(message);
                        let sent = newest.map(|it| send(peer.socket.as_raw_fd(), &it, QUIET));
                        if sent.is_some_and(|sent| sent.is_err()) {
                            peer.wish = Wish::Gone;
                        }
                    }
                }
                Wish::Write(channel) => self.wrote(channel, said),
                // A reader has nothing to say.
                Wish::Read(_) | Wish::Gone => peer.wish = Wish::Gone,
            }
        }
    }

    /// A program has written to an actuator: nothing moves, and readers see what was recorded.
    fn wrote(&mut self, channel: usize, tuple: &[u8]) {
        let position = self.clock.position(Instant::now());
        let described = &self.recording.channels()[channel];
        if tuple.len() != described.bytes {
            return;
        }
        let output = &mut self.outputs[channel];
        let is_rest = described.layout.show(tuple) == described.rest;
        let differs = match is_rest {
            true => output.rest(position, tuple),
            false => output.write(position, tuple),
        };
        if differs {
            self.differs(channel);
        }
    }

    fn miss(&mut self) {
        let (position, speed) = (self.clock.position(Instant::now()), self.clock.speed());
        for channel in 0..self.outputs.len() {
            if self.outputs[channel].miss(position, speed) {
                self.differs(channel);
            }
        }
    }

    fn differs(&self, channel: usize) {
        let described = &self.recording.channels()[channel];
        let Some(difference) = self.outputs[channel].difference() else {
            return;
        };
        let line = super::words::difference(described, difference);
        self.news(line.clone());
        let mut shared = lock(&self.shared);
        if shared.state.differences.len() < limits::REPLAY_NEWS_MAX {
            shared.state.differences.push(line);
        }
    }

    /// It goes no further, and a person has to know why.
    fn fail(&self, why: &str) {
        self.news(format!("the replay ends here: {why}"));
        lock(&self.shared).state.failure = Some(why.to_owned());
    }

    fn obey(&mut self, order: Order) {
        let now = Instant::now();
        match order {
            Order::Pause => self.clock.run(now, false),
            Order::Toggle if self.clock.runs(now) => self.clock.run(now, false),
            Order::Go | Order::Toggle => self.go(now),
            Order::Step(count) => {
                self.clock.run(now, false);
                self.steps = count;
            }
            Order::Speed(speed) => self.clock.set_speed(now, speed),
            Order::Double(up) => self.clock.double(now, up),
            Order::Loop(is_loop) => self.is_loop = is_loop,
            Order::Seek(seek) => self.go_to(seek.from(self.clock.position(now))),
        }
    }

    /// Runs; at the end, where nothing follows, from the beginning.
    fn go(&mut self, now: Instant) {
        if self.next.is_none() && self.clock.position(now) >= self.clock.length() {
            self.go_to(Duration::ZERO);
        }
        self.clock.run(Instant::now(), true);
    }

    fn go_to(&mut self, position: Duration) {
        if let Err(error) = self.seek(position) {
            self.news(format!("no way to that position: {error}"));
        }
    }

    fn news(&self, line: String) {
        let mut shared = lock(&self.shared);
        if shared.news.len() < limits::REPLAY_NEWS_MAX {
            shared.news.push(line);
        }
    }

    fn publish_state(&self) {
        let now = Instant::now();
        let mut shared = lock(&self.shared);
        let state = &mut shared.state;
        state.position = self.clock.position(now);
        state.length = self.clock.length();
        state.speed = self.clock.speed();
        state.runs = self.clock.runs(now);
        state.is_loop = self.is_loop;
        state.same = self.outputs.iter().map(Output::same).sum();
        state.is_at_end = self.next.is_none() && !state.runs && !self.is_loop;
    }
}

/// A recorder looks at all nodes one after another when it begins; this is longer than it takes.
const BEGINNING: Duration = Duration::from_millis(limits::REPLAY_BEGINNING_MS);

/// How late an event may come before the clock waits for it.
const LATE: Duration = Duration::from_millis(limits::REPLAY_LATE_MS);

const QUIET: MsgFlags = MsgFlags::MSG_NOSIGNAL;

/// What a reader gets: see `device/played.rs` of trikfs.
fn message(what: &Reading) -> Vec<u8> {
    let (errno, body) = match what {
        Reading::Sample(tuple) => (0, tuple.as_slice()),
        Reading::Failure(errno, reason) => (*errno, reason.as_bytes()),
    };
    let mut message = errno.to_le_bytes().to_vec();
    message.extend_from_slice(body);
    message
}
