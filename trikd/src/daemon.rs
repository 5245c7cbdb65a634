//! The serving process: its services, what they share, and the order in which things come and go.
//!
//! Owns the start, which is whole or does not happen, and the end. One thread runs all tasks, so what they share needs
//! no locks; the threads beside it read the tree, stop motors and wait for keys. What a service works with stands in a
//! struct of its own, which is filled in here.

use crate::access::Access;
use crate::battery::Battery;
use crate::clients::Clients;
use crate::connection::Held;
use crate::error::{BadUser, Error};
use crate::feedback::Feedback;
use crate::pace::Pace;
use crate::panics::{self, Panics};
use crate::pictures::Pictures;
use crate::priority::{self, Rank};
use crate::program::boot::Autorun;
use crate::program::child::Owner;
use crate::program::reaper::Reaper;
use crate::program::rest::Rest;
use crate::program::{self, Command, Programs, Supervisor, boot};
use crate::record::Record;
use crate::sampler::Sampler;
use crate::server::control::Control;
use crate::server::datagrams::Datagrams;
use crate::server::discovery::{self, About};
use crate::server::gamepad::{Gamepads, Pipe};
use crate::server::mailbox::{self, Mailbox};
use crate::server::recordings::Recordings;
use crate::server::telemetry::Telemetry;
use crate::server::variables::Variables;
use crate::server::video::Video;
use crate::server::{self, Admission, Port};
use crate::settings::{BoxKey, Service, Settings, StopKey};
use crate::status::{self, Socket, Status};
use crate::{diagram, limits, log};
use crate::{heartbeat, keys, standstill};
use nix::unistd::{User, chown, geteuid, getppid};
use page::seats::Seats;
use recorder::kept::SaveReason;
use std::fmt::Write as _;
use std::io::Write;
use std::net::{IpAddr, Ipv4Addr};
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::{mpsc, oneshot};
use tokio::task::{LocalSet, spawn_local};

/// All ports; those that are not wanted are absent.
struct Ports {
    control: Port,
    telemetry: Port,
    mailbox: Option<Port>,
    gamepad: Option<Port>,
    video: Option<Port>,
    variables: Option<Port>,
}

fn mailbox_port(settings: &Settings) -> Result<Port, Error> {
    let first = settings.mailbox_port;
    let bound = (first..=first.saturating_add(limits::MAILBOX_PORTS))
        .find_map(|port| Port::bind("mailbox", &settings.address, port).ok());
    // All are taken: the message is about the first.
    bound.map_or_else(|| Port::bind("mailbox", &settings.address, first), Ok)
}

impl Ports {
    fn bind(settings: &Settings) -> Result<Self, Error> {
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
fn directory(path: &Path, option: &'static str) -> Result<(), Error> {
    std::fs::create_dir_all(path).map_err(|error| unusable(path, error, option))
}

/// Why nothing can be put there, and what to do.
fn unusable(path: &Path, error: std::io::Error, option: &'static str) -> Error {
    Error::Directory(path.to_owned(), error.into(), option)
}

/// The user of programs, and whether they may write into their folder.
fn owner(settings: &Settings) -> Result<Option<Owner>, Error> {
    let Some(name) = &settings.user else {
        return Ok(None);
    };
    let bad = |why| Error::User(name.clone(), why);
    let found = User::from_name(name).map_err(|error| bad(BadUser::Unknown(error.into())))?;
    let user = found.ok_or_else(|| bad(BadUser::Missing))?;
    if user.uid == geteuid() {
        return Ok(None);
    }
    if !geteuid().is_root() {
        return Err(bad(BadUser::WithoutRoot));
    }
    if user.uid.is_root() {
        return Err(bad(BadUser::Root));
    }
    let folder = &settings.scripts;
    chown(folder, Some(user.uid), Some(user.gid))
        .map_err(|error| bad(BadUser::Folder(folder.clone(), error.into())))?;
    Ok(Some(Owner { user }))
}

/// Everything that has one owner here and several users: services take from it what they name.
struct Parts {
    settings: Rc<Settings>,
    owner: Option<Owner>,
    access: Arc<Access>,
    clients: Rc<Clients>,
    seats: Arc<Seats>,
    panics: Arc<Panics>,
    held: Rc<Held>,
    sampler: Rc<Sampler>,
    battery: Rc<Battery>,
    rest: Rc<Rest>,
    feedback: Rc<Feedback>,
    reaper: Rc<Reaper>,
    programs: Rc<Programs>,
    mailbox: Rc<Mailbox>,
    gamepads: Rc<Gamepads>,
    record: Rc<Record>,
}

impl Parts {
    fn new(settings: Settings, owner: Option<Owner>, panics: Arc<Panics>) -> Result<Self, Error> {
        let access = Access::new(
            settings.allow.clone(),
            settings.pair,
            &settings.state.join("paired"),
        );
        let clients = Rc::<Clients>::default();
        let seats = server::seats(settings.connections.into());
        let held = Rc::<Held>::default();
        let programs = Rc::<Programs>::default();
        let mailbox = Mailbox::new(
            &settings.state.join("mailbox"),
            mailbox::Surroundings {
                clients: clients.clone(),
                held: held.clone(),
                seats: seats.clone(),
                programs: programs.clone(),
                addresses: settings.address.clone(),
            },
        );
        let feedback = match settings.has(Service::Feedback) {
            true => Feedback::start(&settings.tree).map_err(Error::thread)?,
            false => Feedback::default(),
        };
        let access = access.map_err(|error| Error::Os(error.into()))?;
        let access = Arc::new(match settings.page_port {
            Some(_) => access.with_page(),
            None => access,
        });
        Ok(Self {
            owner,
            gamepads: Rc::new(Gamepads {
                access: access.clone(),
                clients: clients.clone(),
                // The tree may read it also when nobody serves gamepads here.
                pipe: Pipe::new(&settings.gamepad_fifo),
            }),
            access,
            clients,
            seats,
            panics,
            held,
            sampler: Rc::new(Sampler::start(&settings.tree).map_err(Error::thread)?),
            battery: Rc::new(Battery::start(&settings.tree).map_err(Error::thread)?),
            rest: Rc::new(Rest::start(&settings.tree).map_err(Error::thread)?),
            feedback: Rc::new(feedback),
            reaper: Rc::default(),
            programs,
            mailbox: Rc::new(mailbox),
            record: Rc::new(Record::start(&settings)?),
            settings: Rc::new(settings),
        })
    }

    fn supervisor(&self) -> Supervisor {
        Supervisor::new(program::Surroundings {
            settings: self.settings.clone(),
            owner: self.owner.clone(),
            programs: self.programs.clone(),
            clients: self.clients.clone(),
            mailbox: self.mailbox.clone(),
            rest: self.rest.clone(),
            reaper: self.reaper.clone(),
            feedback: self.feedback.clone(),
            record: self.record.clone(),
        })
    }

    fn status(&self, ports: String) -> Status {
        Status {
            started: Instant::now(),
            ports,
            tree: self.settings.tree.clone(),
            access: self.access.clone(),
            owner: self.owner.clone(),
            memory_mib: self.settings.memory_mib,
            processes: self.settings.processes,
            programs: self.programs.clone(),
            mailbox: self.mailbox.clone(),
            seats: self.seats.clone(),
            panics: self.panics.clone(),
            clients: self.clients.clone(),
        }
    }

    fn autorun(&self) -> Autorun {
        Autorun {
            scripts: self.settings.scripts.clone(),
            state: self.settings.state.clone(),
            sampler: self.sampler.clone(),
            programs: self.programs.clone(),
        }
    }

    /// Warns if programs are root and --user was not given.
    fn warn_of_root(&self) {
        if self.settings.user.is_none() && geteuid().is_root() {
            tracing::warn!(
                target: log::PROGRAMS,
                "programs run as root: name a user for them with --user"
            );
        }
    }

    /// Says so if the user of programs cannot drive.
    fn warn_of_rights(&self) {
        if let Some(owner) = &self.owner
            && let Some(file) = owner.lacks(&self.settings.tree)
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
    fn open(&self, ports: Ports) {
        let admission = Rc::new(Admission::new(
            self.access.clone(),
            self.clients.clone(),
            self.seats.clone(),
        ));
        let control_port = ports.control.number();
        let recordings = Rc::new(Recordings {
            access: self.access.clone(),
            record: self.record.clone(),
        });
        let control = Rc::new(self.control(recordings.clone()));
        ports
            .control
            .serve(&admission, &control, server::control::serve);
        let telemetry = Rc::new(Telemetry {
            clients: self.clients.clone(),
            held: self.held.clone(),
            sampler: self.sampler.clone(),
            recordings: recordings.clone(),
            tree: self.settings.tree.clone(),
        });
        ports
            .telemetry
            .serve(&admission, &telemetry, server::telemetry::serve);
        if let Some(port) = ports.mailbox {
            let number = port.number();
            port.serve(&admission, &self.mailbox, server::mailbox::serve);
            self.mailbox.open(number);
        }
        if let Some(port) = ports.gamepad {
            port.serve(&admission, &self.gamepads, server::gamepad::serve);
        }
        if let Some(port) = ports.video {
            let video = Rc::new(Video {
                clients: self.clients.clone(),
                pictures: Pictures::new(&self.settings.tree),
            });
            port.serve(&admission, &video, server::video::serve);
        }
        if let Some(port) = ports.variables {
            let variables = Rc::new(Variables {
                clients: self.clients.clone(),
                programs: self.programs.clone(),
            });
            port.serve(&admission, &variables, server::variables::serve);
        }
        self.open_datagrams(control_port);
    }

    fn control(&self, recordings: Rc<Recordings>) -> Control {
        Control {
            recordings,
            battery: self.battery.clone(),
            access: self.access.clone(),
            clients: self.clients.clone(),
            held: self.held.clone(),
            programs: self.programs.clone(),
            feedback: self.feedback.clone(),
            scripts: self.settings.scripts.clone(),
            upload_bytes: usize::from(self.settings.upload_mib) << 20,
            config_version: self.settings.config_version.clone(),
            locale: diagram::locale(&self.settings.language),
        }
    }

    /// Begins what goes by datagrams; without it everything else works.
    fn open_datagrams(&self, control_port: u16) {
        let report = |what: &'static str, task: std::io::Result<()>| {
            if let Err(error) = task {
                tracing::warn!(target: log::DAEMON, "{what} is off: {error}");
            }
        };
        if self.settings.has(Service::Discovery) {
            let about = About {
                name: self.settings.name.clone(),
                config_version: self.settings.config_version.clone(),
                port: control_port,
                // One that the system has chosen is told by the page itself.
                page: self.settings.page_port.filter(|port| *port > 0),
            };
            spawn_local(async move { report("discovery", discovery::answer(about).await) });
        }
        if let Some(to) = self.settings.udp_telemetry {
            let (sampler, period_ms) = (self.sampler.clone(), self.settings.udp_period_ms);
            spawn_local(async move {
                let sent = server::datagrams::send(sampler, to, period_ms).await;
                report("telemetry by datagrams", sent);
            });
            match Datagrams::to(to, period_ms) {
                Ok(all) => self.record.listen(Box::new(all)),
                Err(error) => report("telemetry of all nodes by datagrams", Err(error)),
            }
        }
    }

    /// Begins to answer requests for the status, and to look after the guardian.
    fn look_after(&self, ports: String, socket: Socket) {
        let (status, socket) = (Rc::new(self.status(ports)), Rc::new(socket));
        let answer = move || status::serve(status.clone(), socket.clone());
        spawn_local(panics::restart_task_on_panic("status", answer));
        let (guardian, programs) = (getppid(), self.programs.clone());
        let watch = move || standstill::watch(guardian, programs.clone());
        spawn_local(panics::restart_task_on_panic("standstill", watch));
    }

    fn keys(&self) -> Rc<Keys> {
        Rc::new(Keys {
            stop_key: self.settings.stop_key,
            box_key: self.settings.box_key,
            record: self.record.clone(),
            access: self.access.clone(),
            programs: self.programs.clone(),
        })
    }
}

/// Serves until a signal ends it. `restarts`: how often that has been tried after crashes.
///
/// # Errors
/// Before anything was served.
pub fn run(settings: Settings, restarts: u32) -> Result<(), Error> {
    let pace = Pace::default();
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .on_thread_park(move || pace.rest())
        .max_blocking_threads(limits::BLOCKING_THREADS)
        .thread_keep_alive(Duration::from_millis(limits::BLOCKING_IDLE_MS))
        .build()
        .map_err(|error| Error::EventLoop(error.into()))?;
    runtime.block_on(LocalSet::new().run_until(serve(settings, restarts)))
}

async fn serve(mut settings: Settings, restarts: u32) -> Result<(), Error> {
    let panics = Panics::watch();
    settings.make_absolute()?;
    let ports = Ports::bind(&settings)?;
    directory(&settings.scripts, "--scripts")?;
    directory(&settings.state, "--state")?;
    directory(&settings.run, "--run")?;
    let python = settings.run.join("python");
    let unusable = |path: &Path, error| unusable(path, error, "--run");
    program::child::install(&settings.run).map_err(|error| unusable(&settings.run, error))?;
    program::python::install(&python).map_err(|error| unusable(&python, error))?;
    let socket = Socket::make(&settings.run).map_err(|error| unusable(&settings.run, error))?;
    let owner = owner(&settings)?;
    // A process that loses its parent becomes a child of this process, and cannot outlive its program.
    program::kill::adopt_orphans()?;
    let listen = |kind| signal(kind).map_err(|error| Error::Signals(error.into()));
    let mut terminate = listen(SignalKind::terminate())?;
    let mut interrupt = listen(SignalKind::interrupt())?;
    let mut hang_up = listen(SignalKind::hangup())?;
    // A terminal stops whatever runs in it (Ctrl-Z), and motors would go on: with this it does not.
    let _unstoppable = listen(SignalKind::from_raw(libc::SIGTSTP))?;
    let pressed = keys::watch(&settings.tree).map_err(Error::thread)?;
    let mut words = ports.describe();
    let control_port = ports.control.number();
    let parts = Parts::new(settings, owner, panics)?;
    let page = server::page::start(&parts.settings, &parts.access, control_port)?;
    if let Some(page) = &page {
        let _ = write!(words, ", page {}", page.address().port());
    }
    parts.warn_of_root();
    let reaper = spawn_local({
        let reaper = parts.reaper.clone();
        async move { reaper.run().await }
    });
    heartbeat::start().map_err(Error::thread)?;
    // Behind the start of the threads that shall not have it.
    priority::set(Rank::Serving);
    let supervisor = spawn_local(parts.supervisor().run());
    match parts.rest.now(limits::REST_LAST_MS).await {
        Err(why) => tracing::warn!(target: log::TREE, "at the start: {why}"),
        // The tree answers, so it does not hang.
        Ok(()) => parts.warn_of_rights(),
    }
    parts.open(ports);
    parts.look_after(words.clone(), socket);
    spawn_local(parts.keys().hear(pressed));
    if !parts.settings.no_autorun {
        spawn_local(boot::autorun(parts.autorun(), restarts));
    }
    tracing::info!(target: log::DAEMON, "serves {words}");
    // The process that started this may not listen.
    let _ = writeln!(std::io::stdout(), "trikd: ready: {words}");
    tokio::select! {
        _ = terminate.recv() => {}
        _ = interrupt.recv() => {}
        _ = hang_up.recv() => {}
        // Without them no program would be stopped: the guardian does that, and starts anew.
        _ = supervisor => std::process::abort(),
        _ = reaper => std::process::abort(),
    }
    tracing::info!(target: log::DAEMON, "ends");
    // Browsers go before what they look at.
    drop(page);
    let (done, ended) = oneshot::channel();
    parts.programs.send(Command::Quit(done)).await;
    let _ = ended.await;
    parts.mailbox.rest().await;
    Ok(())
}

/// What the keys of the robot act on.
struct Keys {
    stop_key: StopKey,
    box_key: BoxKey,
    record: Rc<Record>,
    access: Arc<Access>,
    programs: Rc<Programs>,
}

impl Keys {
    /// Does what keys ask for until there are no more. One that fails does not keep the next from being heard.
    async fn hear(self: Rc<Self>, mut pressed: mpsc::Receiver<&'static str>) {
        while let Some(key) = pressed.recv().await {
            let keys = self.clone();
            // A panic is told by its hook.
            let _ = spawn_local(async move { keys.act(key).await }).await;
        }
    }

    /// The stop key ends the program; Enter pairs who has asked.
    async fn act(&self, key: &'static str) {
        let stop = match self.stop_key {
            StopKey::Power => "Power",
            StopKey::Esc => "Esc",
            StopKey::None => "",
        };
        let freeze = match self.box_key {
            BoxKey::Up => "Up",
            BoxKey::Down => "Down",
            BoxKey::Left => "Left",
            BoxKey::Right => "Right",
            BoxKey::None => "",
        };
        if key == freeze {
            self.record.freeze(SaveReason::Key);
        }
        if key == stop && self.programs.runs() {
            self.programs.send(Command::Stop("the stop key")).await;
        } else if key == "Enter" && self.access.pairs() {
            match self.access.pair_last() {
                Ok(Some(ip)) => tracing::info!(target: log::CLIENTS, "{ip} is paired"),
                Ok(None) => {}
                Err(error) => tracing::warn!(target: log::CLIENTS, "pairing: {error}"),
            }
        }
    }
}
