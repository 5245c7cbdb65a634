//! A mounted tree and what stands on it, from its start to its end, with a person in front of it.
//!
//! Owns the order of things: the tree, trikd and the view of ev3dev over it, all of it backwards, whatever ends them.
//! Everything that happens is waited for in one poll(2) in the main thread. What is below the tree, a virtual board or the
//! player of a recording, it knows as [`Beneath`] alone.

use super::companion::{Companion, after};
use super::page::Served;
use super::screen::Screen;
use super::tree::Tree;
use super::trikd::{self, Trikd};
use crate::error::Error;
use crate::limits;
use crate::place::Place;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::signal::{SigSet, Signal, kill};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use nix::unistd::getpid;
use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::net::SocketAddr;
use std::os::fd::AsFd;
use std::path::PathBuf;
use std::process::ExitStatus;
use std::time::{Duration, Instant};

/// What ends a session in order; a stop of the terminal is for the view.
const SIGNALS: [Signal; 5] = [
    Signal::SIGTERM,
    Signal::SIGINT,
    Signal::SIGHUP,
    Signal::SIGQUIT,
    Signal::SIGTSTP,
];

/// What is below a tree and feeds it.
pub(crate) trait Beneath {
    /// What it is, for a sentence: "the robot two-wheels".
    fn name(&self) -> String;

    /// What the view shows of it now.
    fn lines(&self) -> Vec<String>;

    /// What has happened since the last call, for a person who sees no view.
    fn news(&self) -> Vec<String>;

    /// Commands to try, each with what it does.
    fn hints(&self) -> Vec<(String, String)>;

    /// Where it is and how it is changed: lines for the welcome.
    fn about(&self) -> String;

    /// What a key of the terminal does; None if keys do nothing.
    fn keys(&self) -> Option<&dyn Fn(u8)> {
        None
    }

    /// It has come to its end, and so has everything over it.
    fn is_over(&self) -> bool {
        false
    }
}

/// The signals that end a robot, kept from all threads.
pub(crate) fn signals() -> nix::Result<SignalFd> {
    let mask: SigSet = SIGNALS.into_iter().collect();
    mask.thread_block()?;
    SignalFd::with_flags(&mask, SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC)
}

/// Lets the signals in again that a process has inherited as kept from it.
///
/// # Errors
/// Those of the system.
pub(crate) fn let_in() -> nix::Result<()> {
    let mask: SigSet = SIGNALS.into_iter().collect();
    mask.thread_unblock()
}

fn start(arguments: &[OsString]) -> Result<Tree, Error> {
    Tree::start("trikfs", arguments).map_err(|error| Error::system("starting the tree", error))
}

/// What stands on the tree.
pub(crate) struct Over {
    /// Before the tree, so that it ends before that.
    pub(super) ev3dev: Option<(Companion, PathBuf)>,
    /// Takes programs.
    pub(super) trikd: Option<Trikd>,
    /// In browsers.
    pub(crate) page: Option<Served>,
    /// A person sees how it is, if there is a terminal.
    pub(crate) has_view: bool,
}

impl Over {
    /// Without a view of ev3dev.
    pub(crate) fn of(trikd: Option<Trikd>, page: Option<Served>, has_view: bool) -> Self {
        Self {
            ev3dev: None,
            trikd,
            page,
            has_view,
        }
    }
}

/// How far things are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// The tree has that long to be there.
    Starting(Instant),
    /// It can be used.
    Ready,
    /// It was asked to end and has that long.
    Stopping(Instant),
    /// The guardian is dead. Its daemon, if it lives, has that long to clean up.
    Orphaned(Instant),
}

/// One run, from the start of the tree to its end.
pub(crate) struct Session<'a> {
    arguments: &'a [OsString],
    beneath: &'a dyn Beneath,
    place: &'a Place,
    screen: Option<Screen>,
    signals: SignalFd,
    /// Before the tree, so that it ends before that.
    ev3dev: Option<(Companion, PathBuf)>,
    trikd: Option<Trikd>,
    page: Option<Served>,
    tree: Tree,
    /// Where trikd takes programs, as other commands were told.
    address: Option<SocketAddr>,
    /// What went wrong beside the tree.
    failure: Option<Error>,
    stage: Stage,
    /// By a signal.
    was_asked: bool,
    was_ready: bool,
    /// How often a tree whose guardian was killed has been started again.
    restarts: usize,
}

impl<'a> Session<'a> {
    /// Starts the tree with this command line of trikfs.
    ///
    /// # Errors
    /// It cannot be started.
    pub(crate) fn start(
        arguments: &'a [OsString],
        beneath: &'a dyn Beneath,
        place: &'a Place,
        signals: SignalFd,
        over: Over,
    ) -> Result<Self, Error> {
        let has_keys = beneath.keys().is_some();
        Ok(Self {
            arguments,
            beneath,
            place,
            screen: if over.has_view {
                Screen::new(has_keys)
            } else {
                None
            },
            signals,
            ev3dev: over.ev3dev,
            trikd: over.trikd,
            page: over.page,
            tree: start(arguments)?,
            address: None,
            failure: None,
            stage: Stage::Starting(after(limits::START_MS)),
            was_asked: false,
            was_ready: false,
            restarts: 0,
        })
    }

    /// Serves until somebody stops it, or what is beneath is over.
    ///
    /// # Errors
    /// How it ended, if not in order.
    pub(crate) fn run(&mut self) -> Result<(), Error> {
        let mut status = None;
        loop {
            self.wait()
                .map_err(|error| Error::system("waiting", error))?;
            self.hear_signals();
            self.hear_tree();
            self.hear_companions();
            self.hear_beneath();
            self.hear_keys();
            if self.tree.said.is_over() && status.is_none() {
                status = Some(
                    self.tree
                        .wait()
                        .map_err(|error| Error::system("the tree", error))?,
                );
                self.stage = Stage::Orphaned(after(limits::ORPHAN_MS));
            }
            if let Some(ended) = status
                && (self.tree.complaints.is_over() || self.is_late())
            {
                if !self.is_worth_another(ended) {
                    if let Some(screen) = &mut self.screen {
                        screen.leave();
                    }
                    self.stop_companions();
                    return match self.failure.take() {
                        Some(failure) => Err(failure),
                        None => self.judge(ended),
                    };
                }
                self.start_again(ended)?;
                status = None;
            }
            if self.is_late() {
                self.hurry();
            }
            self.show();
        }
    }

    /// Waits for a signal, a word of the tree, the next picture or look at the board, or the end of patience.
    fn wait(&self) -> io::Result<()> {
        let picture = (self.stage == Stage::Ready).then_some(PollTimeout::from(limits::VIEW_MS));
        let patience = self.deadline().map(|at| {
            // One more, so that the deadline has passed when the time is up.
            let left = at.saturating_duration_since(Instant::now()) + Duration::from_millis(1);
            left.try_into().unwrap_or(PollTimeout::MAX)
        });
        let mut watched = vec![PollFd::new(self.signals.as_fd(), PollFlags::POLLIN)];
        let input = io::stdin();
        if self.takes_keys() {
            watched.push(PollFd::new(input.as_fd(), PollFlags::POLLIN));
        }
        let pipes = [self.tree.said.fd(), self.tree.complaints.fd()];
        watched.extend(
            pipes
                .into_iter()
                .flatten()
                .chain(self.companions().flat_map(Companion::fds))
                .map(|fd| PollFd::new(fd, PollFlags::POLLIN)),
        );
        match poll(
            &mut watched,
            picture.or(patience).unwrap_or(PollTimeout::NONE),
        ) {
            Err(nix::Error::EINTR) | Ok(_) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn deadline(&self) -> Option<Instant> {
        match self.stage {
            Stage::Starting(at) | Stage::Stopping(at) | Stage::Orphaned(at) => Some(at),
            Stage::Ready => None,
        }
    }

    fn is_late(&self) -> bool {
        self.deadline().is_some_and(|at| Instant::now() >= at)
    }

    fn hear_signals(&mut self) {
        while let Ok(Some(info)) = self.signals.read_signal() {
            let signal = i32::try_from(info.ssi_signo).unwrap_or(0);
            if signal == Signal::SIGTSTP as i32 {
                if let Some(screen) = &mut self.screen {
                    screen.leave();
                }
                let _ = kill(getpid(), Signal::SIGSTOP);
                continue;
            }
            self.was_asked = true;
            match self.stage {
                // Somebody has no patience.
                Stage::Stopping(_) => self.hurry(),
                Stage::Orphaned(_) => self.stage = Stage::Orphaned(Instant::now()),
                Stage::Starting(_) | Stage::Ready => self.stop(),
            }
        }
    }

    /// What stands on the tree, in the order in which it ends: programs of trikd may use the view of ev3dev.
    fn companions(&self) -> impl Iterator<Item = &Companion> {
        let trikd = self.trikd.iter().map(|trikd| &trikd.process);
        trikd.chain(self.ev3dev.iter().map(|(view, _)| view))
    }

    fn stop_companions(&mut self) {
        let signals = &self.signals;
        let hurries = || matches!(signals.read_signal(), Ok(Some(_)));
        if let Some(trikd) = &mut self.trikd {
            trikd.process.stop(hurries);
        }
        if let Some((view, _)) = &mut self.ev3dev {
            view.stop(hurries);
        }
    }

    /// Asks for the end, first of what stands on the tree.
    fn stop(&mut self) {
        self.stop_companions();
        self.tree.terminate();
        self.stage = Stage::Stopping(after(limits::STOP_MS));
    }

    fn hear_companions(&mut self) {
        // At the end their files of the tree fail, which is no news.
        if self.stage != Stage::Ready {
            return;
        }
        let view = self.ev3dev.as_mut().map(|(view, _)| view.hear());
        let trikd = self.trikd.as_mut().map(|trikd| trikd.process.hear());
        for line in view.into_iter().chain(trikd).flatten() {
            self.note(&line);
        }
        self.announce();
    }

    /// Tells other commands where trikd is, when that has changed.
    fn announce(&mut self) {
        let Some(trikd) = &mut self.trikd else { return };
        let address = trikd.take_address();
        if address == self.address || address.is_none() && trikd.process.runs() {
            return;
        }
        self.address = address;
        if let (Some(page), Some(address)) = (&self.page, address) {
            page.robot_is_at(address);
        }
        let page = self.page.as_ref().map(Served::address);
        if let Err(error) = self.place.announce(address, page) {
            self.note(&format!("trik: other commands do not find trikd: {error}"));
        }
    }

    fn hear_tree(&mut self) {
        for line in self.tree.said.hear() {
            let Some(rest) = line.strip_prefix("trikfs: ready on ") else {
                continue;
            };
            if matches!(self.stage, Stage::Starting(_)) {
                self.stage = Stage::Ready;
            }
            if !self.was_ready {
                self.was_ready = true;
                let view = self.ev3dev.as_mut().map(|(view, _)| view.start());
                if let Some(Err(reason)) = view {
                    self.failure = Some(reason);
                    return self.stop();
                }
                // Without it the robot is of use as well.
                if let Some(Err(reason)) = self.trikd.as_mut().map(Trikd::start) {
                    self.note(&format!("trik: {reason}"));
                }
                self.announce();
                self.welcome(rest);
                if let Some(complaint) = self.page.as_mut().and_then(Served::open) {
                    self.note(&complaint);
                }
            }
        }
        for line in self.tree.complaints.hear() {
            self.note(&line);
        }
    }

    /// Tells in lines what happens below where no view shows it.
    fn hear_beneath(&mut self) {
        if self.stage == Stage::Ready && self.beneath.is_over() {
            self.was_asked = true;
            return self.stop();
        }
        if self.screen.is_some() || !self.was_ready {
            return;
        }
        for words in self.beneath.news() {
            let mut out = io::stdout();
            // A reader that has stopped reading must not hold up the end; a line fits where there is room at all.
            let mut room = [PollFd::new(out.as_fd(), PollFlags::POLLOUT)];
            if poll(&mut room, PollTimeout::ZERO).is_ok_and(|ready| ready > 0) {
                let _ = writeln!(out, "{words}").and_then(|()| out.flush());
            }
        }
    }

    /// Whether keys of the terminal do something now.
    fn takes_keys(&self) -> bool {
        self.stage == Stage::Ready
            && self.beneath.keys().is_some()
            && self.screen.as_ref().is_some_and(Screen::is_ours)
    }

    fn hear_keys(&self) {
        let mut input = io::stdin();
        let mut typed = [PollFd::new(input.as_fd(), PollFlags::POLLIN)];
        if !self.takes_keys() || poll(&mut typed, PollTimeout::ZERO) != Ok(1) {
            return;
        }
        let mut bytes = [0; 64];
        let size = input.read(&mut bytes).unwrap_or(0);
        for &byte in &bytes[..size] {
            if let Some(press) = self.beneath.keys() {
                press(byte);
            }
        }
    }

    /// A message for the person.
    fn note(&mut self, line: &str) {
        match &mut self.screen {
            Some(screen) if self.was_ready => screen.note(line),
            _ => {
                let _ = writeln!(io::stderr(), "{line}");
            }
        }
    }

    /// A guardian that somebody has killed left a robot that is well.
    fn is_worth_another(&self, status: ExitStatus) -> bool {
        let was_killed = status.code().is_none();
        was_killed && self.was_ready && !self.was_asked && self.restarts < limits::RESTARTS_MAX
    }

    /// What an init system does for a real robot.
    fn start_again(&mut self, status: ExitStatus) -> Result<(), Error> {
        self.restarts += 1;
        self.note(&format!(
            "trik: the guardian of the tree was ended by {status}; starting it again"
        ));
        self.tree = start(self.arguments)?;
        self.stage = Stage::Starting(after(limits::START_MS));
        Ok(())
    }

    /// The time is up: does by force what was asked for.
    fn hurry(&mut self) {
        match self.stage {
            Stage::Starting(_) => {
                self.tree.terminate();
                self.stage = Stage::Stopping(after(limits::STOP_MS));
            }
            Stage::Stopping(_) => {
                self.tree.kill();
                self.stage = Stage::Stopping(after(limits::STOP_MS));
            }
            Stage::Ready | Stage::Orphaned(_) => {}
        }
    }

    /// Says where the robot is and what to try. `ready` is what trikfs said: a path, and a number of nodes in brackets.
    fn welcome(&self, ready: &str) {
        let nodes = ready
            .rsplit_once(" (")
            .and_then(|(_, rest)| rest.split_once(')'))
            .map_or(String::new(), |(nodes, _)| format!(" ({nodes})"));
        let root = self.place.mountpoint.display();
        let name = self.beneath.name();
        let mut text = format!(
            "trik: {name} is ready on {root}{nodes}\n\nIn a second terminal:\n\n  cd {root}\n"
        );
        for (command, meaning) in self.beneath.hints() {
            text.push_str(&format!("  {command:<54} # {meaning}\n"));
        }
        text.push_str(&self.beneath.about());
        if let (Some(trikd), Some(at)) = (&self.trikd, self.address) {
            let program = std::env::current_exe().ok();
            let path = std::env::var_os("PATH");
            let trik = trikd::own_command(program.as_deref(), path.as_deref());
            text.push_str(&trikd::welcome(at, &trikd.scripts, &trik));
        }
        if let Some(page) = &self.page {
            text.push_str(&page.welcome());
        }
        if let Some((_, at)) = &self.ev3dev {
            let at = at.display();
            text.push_str(&format!(
                "\nAs the classes of ev3dev:\n\n  ls {at}/tacho-motor\n"
            ));
        }
        text.push_str("\nCtrl-C ends it.\n\n");
        let mut out = io::stdout().lock();
        let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    }

    fn show(&mut self) {
        if let (Stage::Ready, Some(screen)) = (self.stage, &mut self.screen) {
            screen.draw(&self.beneath.lines());
        }
    }

    /// What the end of the guardian means.
    fn judge(&self, status: ExitStatus) -> Result<(), Error> {
        match status.code() {
            Some(0) => Ok(()),
            // It has said why.
            Some(_) if !self.was_ready => Err(Error::Reported),
            _ if self.was_asked => Ok(()),
            Some(code) => Err(Error::Process(format!("the tree ended with status {code}"))),
            None => Err(Error::Process(format!(
                "the guardian of the tree was ended by {status}"
            ))),
        }
    }
}
