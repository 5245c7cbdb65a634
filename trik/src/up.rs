//! `trik up`: a virtual board in this process, the tree over it in child processes, and the person in front of them.
//!
//! Owns the order of things: place, board, tree, and all three backwards, whatever ends them. Everything that happens
//! is waited for in one poll(2) in the main thread. `tree` is the child, `companion` others beside it, of which there are
//! `trikd` and `ev3dev`, `world` reads worlds of
//! TRIK Studio, `model` makes a robot of a model, `view` says how the robot is, `screen` draws it, `hints` says what to try.

pub(crate) mod args;
mod companion;
mod ev3dev;
mod hints;
mod model;
mod screen;
pub(crate) mod tree;
mod trikd;
mod view;
pub(crate) mod world;

use crate::error::Error;
use crate::limits;
use crate::place::{self, Place};
use crate::refusal::Refusal;
use args::{UpArgs, absolute};
use companion::{Companion, after};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::signal::{SigSet, Signal, kill};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use nix::unistd::getpid;
use screen::Screen;
use sim::board::{Board, Options};
use sim::body::Body;
use sim::body::studio::{self, Studio};
use sim::field::{Field, Locks};
use std::ffi::OsString;
use std::io::{self, Write};
use std::net::SocketAddr;
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::time::{Duration, Instant};
use tree::Tree;
use trikd::Trikd;

/// What ends `trik up` in order; a stop of the terminal is for the view.
const SIGNALS: [Signal; 5] = [
    Signal::SIGTERM,
    Signal::SIGINT,
    Signal::SIGHUP,
    Signal::SIGQUIT,
    Signal::SIGTSTP,
];

/// Runs a virtual robot until somebody stops it.
///
/// # Errors
/// Why it does not run, or how it ended.
pub(crate) fn run(args: UpArgs) -> Result<u8, Refusal> {
    simulate(args)?;
    Ok(0)
}

fn simulate(args: UpArgs) -> Result<(), Error> {
    let world = args.world.as_deref().map(world::read).transpose()?;
    let platform = match &world {
        Some((field, locks)) => Platform::world(field, *locks, args.seed),
        None => Platform::robot(&args)?,
    };
    let config = match (&args.config, &platform.configuration) {
        // The configuration is made here, and includes this one.
        (None, Some(_)) => shipped(Path::new("trik.lua"), &args).map(|_| None)?,
        _ => Some(configuration(&args)?),
    };
    // Before the board has threads, so that these come to the main thread alone.
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let mountpoint = args.mountpoint.as_deref().map(absolute).transpose()?;
    let mut place = Place::claim(&place::base()?, mountpoint.as_deref())?;
    let ev3dev = match &args.ev3dev {
        Some(wanted) => {
            let wanted = wanted.as_deref().map(absolute).transpose()?;
            let at = place.make_view(wanted.as_deref())?;
            Some((ev3dev::of(&place.mountpoint, &at), at))
        }
        None => None,
    };
    let trikd = match args.no_trikd {
        true => None,
        false => Some(Trikd::of(&args, &place)?),
    };
    let options = Options {
        speed: args.speed,
        seed: args.seed,
        ..Options::default()
    };
    let config = match (config, platform.configuration) {
        (None, Some(text)) => write(&text, &place.world)?,
        (config, _) => config.unwrap_or_default(),
    };
    let board = Board::start(&place.board, platform.body, options).map_err(|error| {
        let what = format!("the virtual board in {}", place.board.display());
        Error::system(what, error)
    })?;
    let arguments = arguments(&args, &config, &place);
    let tree = start(&arguments)?;
    let mut session = Session {
        arguments: &arguments,
        robot: if world.is_some() {
            "in the world"
        } else {
            &args.robot
        },
        world: world.as_ref().map(|(field, _)| field),
        speed: args.speed,
        place: &place,
        board: &board,
        screen: if args.no_view { None } else { Screen::new() },
        signals,
        ev3dev,
        trikd,
        tree,
        address: None,
        failure: None,
        stage: Stage::Starting(after(limits::START_MS)),
        was_asked: false,
        was_ready: false,
        restarts: 0,
    };
    let end = session.run();
    drop(session);
    // Actuators have come to rest, so the board is not needed any more; then its place is free.
    drop(board);
    drop(place);
    end
}

/// What a virtual robot stands on: a body, and the configuration that goes with it if it is in no file.
struct Platform {
    body: Box<dyn Body>,
    configuration: Option<String>,
}

impl Platform {
    /// The robot of a world.
    fn world(field: &Field, locks: Locks, seed: u64) -> Self {
        Self {
            body: Box::new(Studio::new(field, seed).locked(locks)),
            configuration: Some(studio::configuration(field)),
        }
    }

    /// The robot of a name.
    fn robot(args: &UpArgs) -> Result<Self, Error> {
        if let Some(robot) = sim::robots::by_name(&args.robot) {
            if let Some(option) = model::stray(args) {
                return Err(Error::Refused(format!(
                    "{option} is for a model: --robot FILE.dcml; '{}' has its own",
                    args.robot
                )));
            }
            return Ok(Self {
                body: robot.body(),
                configuration: None,
            });
        }
        let (body, configuration) = model::robot(args)?;
        Ok(Self {
            body,
            configuration: Some(configuration),
        })
    }
}

/// Writes a configuration into a file, and gives its name back.
fn write(text: &str, into: &Path) -> Result<PathBuf, Error> {
    std::fs::write(into, text).map_err(|error| Error::file(into, error))?;
    Ok(into.to_owned())
}

/// The signals that end a robot, kept from all threads.
fn signals() -> nix::Result<SignalFd> {
    let mask: SigSet = SIGNALS.into_iter().collect();
    mask.thread_block()?;
    SignalFd::with_flags(&mask, SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC)
}

/// What the tree is to be made of.
fn configuration(args: &UpArgs) -> Result<PathBuf, Error> {
    match &args.config {
        Some(path) if path.is_file() => absolute(path),
        Some(path) => Err(Error::file(path, "no such configuration")),
        None => {
            let name = PathBuf::from(format!("robots/{}.lua", args.robot));
            shipped(&name, args)
        }
    }
}

/// A file that comes with this program.
fn shipped(name: &Path, args: &UpArgs) -> Result<PathBuf, Error> {
    let include: Result<_, Error> = args.include.iter().map(|dir| absolute(dir)).collect();
    trikfs::cli::find_shipped(name, include?).map_err(|why| {
        Error::Refused(format!(
            "{why}; --include names another directory: that of the source is config/lua"
        ))
    })
}

/// The command line of trikfs.
fn arguments(args: &UpArgs, config: &Path, place: &Place) -> Vec<OsString> {
    let mut list: Vec<OsString> = vec!["mount".into()];
    let mut option = |name: &str, value: &Path| {
        // In one word, so that a path that begins with a dash stays a value.
        let mut argument = OsString::from(name);
        argument.push("=");
        argument.push(value);
        list.push(argument);
    };
    option("--config", config);
    option("--device-root", &place.board);
    for dir in &args.include {
        option("--include", dir);
    }
    if let Some(cache) = &args.cache {
        option("--cache", cache);
    }
    if let Some(group) = &args.group {
        option("--group", Path::new(group));
        list.push("--allow-other".into());
    }
    list.push("--".into());
    list.push(place.mountpoint.clone().into());
    list
}

fn start(arguments: &[OsString]) -> Result<Tree, Error> {
    Tree::start("trikfs", arguments).map_err(|error| Error::system("starting the tree", error))
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
struct Session<'a> {
    arguments: &'a [OsString],
    robot: &'a str,
    /// The world of TRIK Studio around it.
    world: Option<&'a Field>,
    speed: f64,
    place: &'a Place,
    board: &'a Board,
    screen: Option<Screen>,
    signals: SignalFd,
    /// Before the tree, so that it ends before that.
    ev3dev: Option<(Companion, PathBuf)>,
    trikd: Option<Trikd>,
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

impl Session<'_> {
    fn run(&mut self) -> Result<(), Error> {
        let mut status = None;
        loop {
            self.wait()
                .map_err(|error| Error::system("waiting", error))?;
            self.hear_signals();
            self.hear_tree();
            self.hear_companions();
            self.hear_loudspeaker();
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
        if let Err(error) = self.place.announce(address) {
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
            }
        }
        for line in self.tree.complaints.hear() {
            self.note(&line);
        }
    }

    /// Tells in lines what the robot gives to the ear, where no view shows it.
    fn hear_loudspeaker(&self) {
        if self.screen.is_some() || !self.was_ready {
            return;
        }
        for words in self.board.take_said() {
            let mut out = io::stdout();
            // Who has stopped reading must not hold up the end; a line fits where there is room at all.
            let mut room = [PollFd::new(out.as_fd(), PollFlags::POLLOUT)];
            if poll(&mut room, PollTimeout::ZERO).is_ok_and(|ready| ready > 0) {
                let _ = writeln!(out, "{}", view::sound(&words)).and_then(|()| out.flush());
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
        let mut text = format!(
            "trik: the robot {} is ready on {root}{nodes}\n\nIn a second terminal:\n\n  cd {root}\n",
            self.robot
        );
        for (command, meaning) in hints::of(self.robot, self.world) {
            text.push_str(&format!("  {command:<54} # {meaning}\n"));
        }
        let board = self.place.board.display();
        text.push_str(&format!(
            "\nIts virtual board, with pose, control/keys and faults, is {board}\n"
        ));
        if let (Some(trikd), Some(at)) = (&self.trikd, self.address) {
            let program = std::env::current_exe().ok();
            let path = std::env::var_os("PATH");
            let trik = trikd::own_command(program.as_deref(), path.as_deref());
            text.push_str(&trikd::welcome(at, &trikd.scripts, &trik));
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
            screen.draw(&view::lines(&self.board.view(), self.robot, self.speed));
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
