//! The serving process: everything that its tasks share, and the order in which things come and go.
//!
//! Owns the start, which is whole or does not happen, and the end. One thread runs all tasks, so what they share needs
//! no locks; the threads beside it read the tree, stop motors and wait for keys.

use crate::access::Access;
use crate::clients::Clients;
use crate::connection::Held;
use crate::feedback::Feedback;
use crate::pace::Pace;
use crate::pictures::Pictures;
use crate::priority::{self, Rank};
use crate::program::child::Owner;
use crate::program::reaper::Reaper;
use crate::program::rest::Rest;
use crate::program::{self, Command, Programs, Supervisor, boot};
use crate::sampler::Sampler;
use crate::server::gamepad::Pipe;
use crate::server::mailbox::Mailbox;
use crate::server::{self, Port, Seats};
use crate::settings::{Service, Settings, StopKey};
use crate::{heartbeat, keys, status};
use crate::{limits, log};
use nix::unistd::{User, chown, geteuid};
use std::io::Write;
use std::net::{IpAddr, Ipv4Addr};
use std::path::Path;
use std::rc::Rc;
use std::time::Instant;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::{mpsc, oneshot};
use tokio::task::{LocalSet, spawn_local};

/// What all tasks share.
#[derive(Debug)]
pub struct Daemon {
    /// The command line.
    pub settings: Settings,
    /// Who may do what.
    pub access: Access,
    /// Who is connected.
    pub clients: Clients,
    /// Connections on all ports.
    pub seats: Rc<Seats>,
    /// Bytes of half frames.
    pub held: Held,
    /// What the robot senses.
    pub sampler: Sampler,
    /// The way to bring motors to rest.
    pub rest: Rest,
    /// What a person beside the robot hears and sees.
    pub feedback: Feedback,
    /// Who hears of ends of processes.
    pub reaper: Reaper,
    /// Whose rights programs have; None: those of trikd.
    pub owner: Option<Owner>,
    /// The way to whoever runs programs.
    pub programs: Programs,
    /// What the camera sees.
    pub pictures: Pictures,
    /// Messages between robots.
    pub mailbox: Mailbox,
    /// Where lines of gamepads go.
    pub gamepad_pipe: Pipe,
    started: Instant,
    ports: String,
}

/// All ports; those that are not wanted are absent.
struct Ports {
    control: Port,
    telemetry: Port,
    mailbox: Option<Port>,
    gamepad: Option<Port>,
    video: Option<Port>,
    variables: Option<Port>,
}

fn mailbox_port(settings: &Settings) -> Result<Port, String> {
    let first = settings.mailbox_port;
    let bound = (first..=first.saturating_add(limits::MAILBOX_PORTS))
        .find_map(|port| Port::bind("mailbox", &settings.address, port).ok());
    // All are taken: the message is about the first.
    bound.map_or_else(|| Port::bind("mailbox", &settings.address, first), Ok)
}

impl Ports {
    fn bind(settings: &Settings) -> Result<Self, String> {
        let all = &settings.address;
        // A robot that is for this machine alone has them where it has the rest, so that several can be side by side.
        let is_local = !all.is_empty() && all.iter().all(IpAddr::is_loopback);
        let own: &[IpAddr] = if is_local {
            all
        } else {
            &[IpAddr::V4(Ipv4Addr::LOCALHOST)]
        };
        let wanted = |service, name, addresses: &[IpAddr], port| {
            settings
                .has(service)
                .then(|| Port::bind(name, addresses, port))
                .transpose()
        };
        Ok(Self {
            control: Port::bind("control", all, settings.control_port)?,
            telemetry: Port::bind("telemetry", all, settings.telemetry_port)?,
            mailbox: settings
                .has(Service::Mailbox)
                .then(|| mailbox_port(settings))
                .transpose()?,
            gamepad: wanted(Service::Gamepad, "gamepad", all, settings.gamepad_port)?,
            video: wanted(Service::Video, "video", all, settings.video_port)?,
            variables: wanted(
                Service::Variables,
                "variables",
                own,
                settings.variables_port,
            )?,
        })
    }

    /// Names and numbers, as the ready line and the status show them.
    fn describe(&self) -> String {
        let others = [&self.mailbox, &self.gamepad, &self.video, &self.variables];
        let all = [&self.control, &self.telemetry]
            .into_iter()
            .chain(others.into_iter().flatten());
        let words: Vec<_> = all
            .map(|port| format!("{} {}", port.name, port.number()))
            .collect();
        words.join(", ")
    }
}

/// Makes a directory that is missing.
fn directory(path: &Path, option: &str) -> Result<(), String> {
    std::fs::create_dir_all(path).map_err(|error| unusable(path, &error, option))
}

/// Why nothing can be put there, and what to do.
fn unusable(path: &Path, error: &std::io::Error, option: &str) -> String {
    format!(
        "{}: {error}: name another directory with {option}",
        path.display()
    )
}

/// The user of programs, and whether they may write into their folder.
fn owner(settings: &Settings) -> Result<Option<Owner>, String> {
    let Some(name) = &settings.user else {
        return Ok(None);
    };
    let found = User::from_name(name).map_err(|error| format!("--user {name}: {error}"))?;
    let user = found.ok_or_else(|| {
        format!("--user {name}: there is no such user: `useradd --system {name}` makes one")
    })?;
    if user.uid == geteuid() {
        return Ok(None);
    }
    if !geteuid().is_root() {
        return Err(format!(
            "--user {name}: only root can start programs as another user"
        ));
    }
    if user.uid.is_root() {
        return Err(format!(
            "--user {name}: this is root: leave --user out to run programs as root"
        ));
    }
    chown(&settings.scripts, Some(user.uid), Some(user.gid))
        .map_err(|error| format!("{}: {error}", settings.scripts.display()))?;
    Ok(Some(Owner { user }))
}

impl Daemon {
    fn new(settings: Settings, owner: Option<Owner>, ports: String) -> Result<Self, String> {
        let threads = |error| format!("a thread cannot be started: {error}");
        let access = Access::new(
            settings.allow.clone(),
            settings.pair,
            &settings.state.join("paired"),
        );
        Ok(Self {
            access: access.map_err(|error| error.to_string())?,
            clients: Clients::default(),
            seats: Rc::default(),
            held: Held::default(),
            sampler: Sampler::start(&settings.tree).map_err(threads)?,
            rest: Rest::start(&settings.tree).map_err(threads)?,
            feedback: match settings.has(Service::Feedback) {
                true => Feedback::start(&settings.tree).map_err(threads)?,
                false => Feedback::default(),
            },
            reaper: Reaper::default(),
            owner,
            programs: Programs::default(),
            pictures: Pictures::new(&settings.tree),
            mailbox: Mailbox::new(&settings.state.join("mailbox")),
            gamepad_pipe: Pipe::new(&settings.gamepad_fifo),
            started: Instant::now(),
            ports,
            settings,
        })
    }

    /// What `trikd status` shows.
    pub fn describe(&self) -> String {
        let tree = &self.settings.tree;
        let state = if tree.join("stop").exists() {
            "mounted"
        } else {
            "NOT MOUNTED"
        };
        let user = self
            .owner
            .as_ref()
            .map_or("the user of trikd", |owner| owner.user.name.as_str());
        format!(
            "trikd {} for {} s\nports {}\ntree {} {state}\naccess {}\nprograms run as {user}, with {} MiB and {} processes\n{}{}connections {} of {}\n{}",
            env!("CARGO_PKG_VERSION"),
            self.started.elapsed().as_secs(),
            self.ports,
            tree.display(),
            self.access.describe(),
            self.settings.memory_mib,
            self.settings.processes,
            self.programs.describe(),
            self.mailbox.describe(),
            self.seats.taken(),
            self.settings.connections,
            self.clients.describe()
        )
    }
}

/// Serves until a signal ends it. `restarts`: how often that has been tried after crashes.
///
/// # Errors
/// In words, before anything was served.
pub fn run(settings: Settings, restarts: u32) -> Result<(), String> {
    let pace = Pace::default();
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .on_thread_park(move || pace.rest())
        .max_blocking_threads(limits::BLOCKING_THREADS)
        .build()
        .map_err(|error| format!("no event loop: {error}"))?;
    runtime.block_on(LocalSet::new().run_until(serve(settings, restarts)))
}

async fn serve(mut settings: Settings, restarts: u32) -> Result<(), String> {
    settings.make_absolute()?;
    let ports = Ports::bind(&settings)?;
    directory(&settings.scripts, "--scripts")?;
    directory(&settings.state, "--state")?;
    directory(&settings.run, "--run")?;
    let python = settings.run.join("python");
    let unusable = |path: &Path, error| unusable(path, &error, "--run");
    program::child::install(&settings.run).map_err(|error| unusable(&settings.run, error))?;
    program::python::install(&python).map_err(|error| unusable(&python, error))?;
    let listener = status::listen(&settings.run).map_err(|error| unusable(&settings.run, error))?;
    let owner = owner(&settings)?;
    // Whoever loses its parent becomes a child of this process, and cannot outlive its program.
    program::kill::adopt_orphans()?;
    let mut ends = Vec::new();
    for kind in [
        SignalKind::terminate(),
        SignalKind::interrupt(),
        SignalKind::hangup(),
    ] {
        ends.push(signal(kind).map_err(|error| format!("signals: {error}"))?);
    }
    let pressed = keys::watch(&settings.tree)
        .map_err(|error| format!("a thread cannot be started: {error}"))?;
    let words = ports.describe();
    let daemon = Rc::new(Daemon::new(settings, owner, words.clone())?);
    // Who has named root knows it.
    if daemon.settings.user.is_none() && geteuid().is_root() {
        tracing::warn!(
            target: log::PROGRAMS,
            "programs run as root: name a user for them with --user"
        );
    }
    let reaper = spawn_local({
        let daemon = daemon.clone();
        async move { daemon.reaper.run().await }
    });
    heartbeat::start().map_err(|error| format!("a thread cannot be started: {error}"))?;
    // Behind the start of the threads that shall not have it.
    priority::take(Rank::Serving);
    let supervisor = spawn_local(Supervisor::new(daemon.clone()).run());
    match daemon.rest.now(limits::REST_LAST_MS).await {
        Err(why) => tracing::warn!(target: log::TREE, "at the start: {why}"),
        // The tree answers, so it does not hang.
        Ok(()) => warn_of_rights(&daemon),
    }
    open(&daemon, ports);
    spawn_local(status::serve(daemon.clone(), listener));
    spawn_local(hear_keys(daemon.clone(), pressed));
    if !daemon.settings.no_autorun {
        spawn_local(boot::autorun(daemon.clone(), restarts));
    }
    tracing::info!(target: log::DAEMON, "serves {words}");
    // Whoever started this may not listen.
    let _ = writeln!(std::io::stdout(), "trikd: ready: {words}");
    let [first, second, third] = &mut ends[..] else {
        return Err("signals".to_owned());
    };
    tokio::select! {
        _ = first.recv() => {}
        _ = second.recv() => {}
        _ = third.recv() => {}
        // Without them no program would be stopped: the guardian does that, and starts anew.
        _ = supervisor => std::process::abort(),
        _ = reaper => std::process::abort(),
    }
    tracing::info!(target: log::DAEMON, "ends");
    let (done, ended) = oneshot::channel();
    daemon.programs.send(Command::Quit(done)).await;
    let _ = ended.await;
    daemon.mailbox.rest().await;
    Ok(())
}

/// Says so if the user of programs cannot drive.
fn warn_of_rights(daemon: &Daemon) {
    if let Some(owner) = &daemon.owner
        && let Some(file) = owner.lacks(&daemon.settings.tree)
    {
        let name = &owner.user.name;
        tracing::warn!(
            target: log::PROGRAMS,
            "programs run as {name}, who may not write {}: mount with --allow-other --group and the group of {name}",
            file.display()
        );
    }
}

/// Begins to accept on all ports.
fn open(daemon: &Rc<Daemon>, ports: Ports) {
    let control = ports.control.number();
    ports.control.serve(daemon, server::control::serve);
    ports.telemetry.serve(daemon, server::telemetry::serve);
    if let Some(port) = ports.mailbox {
        let number = port.number();
        port.serve(daemon, server::mailbox::serve);
        daemon.mailbox.open(daemon, number);
    }
    if let Some(port) = ports.gamepad {
        port.serve(daemon, server::gamepad::serve);
    }
    if let Some(port) = ports.video {
        port.serve(daemon, server::video::serve);
    }
    if let Some(port) = ports.variables {
        port.serve(daemon, server::variables::serve);
    }
    let told = |what: &'static str, task: std::io::Result<()>| {
        if let Err(error) = task {
            tracing::warn!(target: log::DAEMON, "{what} is off: {error}");
        }
    };
    if daemon.settings.has(Service::Discovery) {
        let daemon = daemon.clone();
        spawn_local(async move {
            told(
                "discovery",
                server::discovery::answer(daemon, control).await,
            )
        });
    }
    if let Some(to) = daemon.settings.udp_telemetry {
        let daemon = daemon.clone();
        spawn_local(async move {
            told(
                "telemetry by datagrams",
                server::datagrams::send(daemon, to).await,
            )
        });
    }
}

/// The stop key ends the program; Enter pairs who has asked.
async fn hear_keys(daemon: Rc<Daemon>, mut pressed: mpsc::Receiver<&'static str>) {
    let stop = match daemon.settings.stop_key {
        StopKey::Power => "Power",
        StopKey::Esc => "Esc",
        StopKey::None => "",
    };
    while let Some(key) = pressed.recv().await {
        if key == stop && daemon.programs.runs() {
            daemon.programs.send(Command::Stop("the stop key")).await;
        } else if key == "Enter" && daemon.access.pairs() {
            match daemon.access.pair_last() {
                Ok(Some(ip)) => tracing::info!(target: log::CLIENTS, "{ip} is paired"),
                Ok(None) => {}
                Err(error) => tracing::warn!(target: log::CLIENTS, "pairing: {error}"),
            }
        }
    }
}
