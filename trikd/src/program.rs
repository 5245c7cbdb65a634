//! The program that runs: one at a time, of any language, always in child processes, and one way out of all of them.
//!
//! Owns what the running program may do next, and its end. `queue` is what is asked for, `child` is one process with its
//! pipes, `launch` gives it its limits, `kill` ends all that it started, `rest` brings the motors to rest, `reaper`
//! hears of ends, `output` measures what it says, `says` shows it, `live` changes a diagram that runs and watches it, `memory` whether that was short, `boot`
//! runs a program at the start.

// A request, a message or a command that is forgotten must not pass in silence.
#![deny(clippy::wildcard_enum_match_arm)]

pub mod boot;
pub mod child;
pub mod kill;
pub mod launch;
mod live;
mod memory;
pub mod output;
pub mod python;
pub mod queue;
pub mod reaper;
pub mod rest;
mod says;

use crate::clients::Clients;
use crate::clients::debugging::OrderId;
use crate::feedback::{Feedback, Moment};
use crate::protocol::news::{self, End};
use crate::protocol::program::{FromProgram, ToProgram};
use crate::record::Record;
use crate::server::mailbox::Mailbox;
use crate::settings::Settings;
use crate::{limits, log};
use child::{Child, Event, Language, Owner};
use journal::standard::Level;
use journal::write::Story;
use kill::{freeze, group, sweep};
use nix::sys::signal::Signal;
use nix::unistd::Pid;
use output::{Manner, Meter};
pub use queue::{Command, Heard, Meeting, Programs, Wish};
use reaper::{Ended, Reaper};
use recorder::kept::SaveReason;
use rest::Rest;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::rc::Rc;
use std::time::{Duration, Instant};
use tokio::sync::oneshot;

/// The running program.
struct Current {
    child: Child,
    name: String,
    since: Instant,
    /// It has no text of its own, or has become event-driven: direct texts go to it.
    takes_direct: bool,
    /// Nobody wants to hear that it began and ended.
    is_quiet: bool,
    has_reported_error: bool,
    /// It has asked a person while nobody was there, which was told.
    has_asked_nobody: bool,
    /// It knows that somebody wants to see where it is.
    is_watched: bool,
    /// It is a Python program that somebody debugs.
    is_under_debugpy: bool,
    /// The log has that it does not reach that.
    has_missed_debugger: bool,
    /// A process of it that stood still, and at how many looks in a row.
    still: (Option<Pid>, u32),
    meter: Meter,
    web: Vec<oneshot::Sender<String>>,
    /// Orders to its debugger that it has not answered yet.
    orders: VecDeque<OrderId>,
    /// Changes that it has not answered yet: the client that asked for each, and what is changed.
    changes: VecDeque<(u32, String)>,
    ended: Option<(Ended, Instant)>,
}

/// Why a program is ended.
enum Cause {
    /// By itself.
    Exited(Ended),
    /// By somebody, or for another program.
    Ordered(&'static str),
    /// It did what it may not.
    Greedy(String),
}

/// What programs are run with.
#[derive(Debug)]
pub struct Surroundings {
    /// Folders and limits of programs.
    pub settings: Rc<Settings>,
    /// Whose rights programs have; None: those of trikd.
    pub owner: Option<Owner>,
    /// What is asked for, and what the status shows.
    pub programs: Rc<Programs>,
    /// Who hears what programs say.
    pub clients: Rc<Clients>,
    /// Messages between robots.
    pub mailbox: Rc<Mailbox>,
    /// What brings motors to rest.
    pub rest: Rc<Rest>,
    /// Who hears of ends of processes.
    pub reaper: Rc<Reaper>,
    /// What a person beside the robot sees.
    pub feedback: Rc<Feedback>,
    /// What is remembered of what programs do.
    pub record: Rc<Record>,
}

/// Runs programs until it is told to quit.
pub struct Supervisor {
    around: Surroundings,
    current: Option<Current>,
    last: Language,
}

impl Supervisor {
    /// Nothing runs yet.
    pub fn new(around: Surroundings) -> Self {
        Self {
            around,
            current: None,
            last: Language::JavaScript,
        }
    }

    /// Serves for ever.
    pub async fn run(mut self) {
        let programs = self.around.programs.clone();
        let mut period = tokio::time::interval(Duration::from_millis(limits::PROCESSES_MS));
        period.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
        loop {
            let drains = self.current.as_ref().and_then(|current| current.ended);
            tokio::select! {
                biased;
                command = programs.next() => {
                    if let Command::Quit(done) = command {
                        self.end(Cause::Ordered("the end of trikd")).await;
                        let _ = done.send(());
                        return;
                    }
                    self.perform(command).await;
                }
                event = next_event(&mut self.current) => self.hear(event).await,
                () = drained(drains) => {
                    if let Some((ended, _)) = drains {
                        self.end(Cause::Exited(ended)).await;
                    }
                }
                _ = period.tick(), if self.current.is_some() => {
                    self.send_watch();
                    self.show_held();
                    self.count_processes().await;
                }
            }
        }
    }

    async fn perform(&mut self, command: Command) {
        match command {
            Command::Run(path, heard) => {
                self.end(Cause::Ordered("another program")).await;
                let language = Language::of(&path);
                let name = self.name_of(&path);
                let file = path.display().to_string();
                let first = ToProgram::File(&file);
                self.start(language, name, Some(path), (first, heard));
            }
            Command::Script(code) => {
                self.end(Cause::Ordered("another program")).await;
                self.start(
                    Language::JavaScript,
                    "script".to_owned(),
                    None,
                    (ToProgram::Script(&code), None),
                );
            }
            Command::Direct(code) => self.direct(&code).await,
            Command::Patch(client, when_gone, path, heard) => {
                self.patch(client, when_gone, &path, heard);
            }
            Command::Set(client, text, heard) => self.set(client, &text, heard),
            Command::Reply(number, text) => self.reply(number, text.as_deref()),
            Command::Debug(asked, wish) => self.debug(asked, wish).await,
            Command::DebugLeft => self.debugger_left().await,
            Command::Stop(who) => {
                let ran = self.current.is_some();
                self.end(Cause::Ordered(who)).await;
                if ran {
                    self.around.record.freeze(SaveReason::Stop);
                }
                // Also what came while nothing ran: after a stop everything begins anew.
                self.around.mailbox.forget_kept();
            }
            Command::Mail(hull, text) => {
                (self.around.record).line(Story::Mail, &format!("robot {hull}"), &text);
                let heard = self
                    .current
                    .as_ref()
                    .is_some_and(|current| current.child.has_channel());
                if heard {
                    self.send(ToProgram::Mail { hull, text: &text });
                } else {
                    self.around.mailbox.keep(hull, text);
                }
            }
            Command::Web(answer) => {
                if let Some(current) = &mut self.current
                    && current.web.len() < limits::COMMANDS
                    && current.child.send(ToProgram::Web)
                {
                    current.web.push(answer);
                }
            }
            Command::Ask(answer) => {
                // Who asked may have left.
                let _ = answer.send(self.around.programs.describe());
            }
            Command::Quit(_) => {}
        }
    }

    /// A file as people name it.
    fn name_of(&self, path: &Path) -> String {
        let folder = &self.around.settings.scripts;
        let name = path.strip_prefix(folder).unwrap_or(path);
        name.display().to_string()
    }

    async fn direct(&mut self, code: &str) {
        let takes = self
            .current
            .as_ref()
            .is_some_and(|current| current.takes_direct && current.child.runs());
        if !takes {
            self.end(Cause::Ordered("a direct command")).await;
            let language = match self.last {
                Language::Python => Language::Python,
                Language::JavaScript | Language::Diagram | Language::Lua | Language::Native => {
                    Language::JavaScript
                }
            };
            self.start(
                language,
                "direct commands".to_owned(),
                None,
                (ToProgram::Start, None),
            );
            match &mut self.current {
                Some(current) => current.takes_direct = true,
                None => return,
            }
        }
        if !self.send(ToProgram::Direct(code)) {
            self.broadcast("error: the direct command is lost: the ones before it are not done yet. Stop, then try again");
        }
    }

    fn send(&mut self, message: ToProgram<'_>) -> bool {
        self.current
            .as_mut()
            .is_some_and(|current| current.child.send(message))
    }

    /// Starts a child with the first message of its channel, and the language of what it says by itself; a program in a file
    /// has its path.
    fn start(
        &mut self,
        language: Language,
        name: String,
        path: Option<PathBuf>,
        (first, heard): (ToProgram<'_>, Heard),
    ) {
        let around = &self.around;
        let started = child::start(
            &around.settings,
            around.owner.as_ref(),
            (language, heard),
            path.as_deref(),
            &around.reaper,
        );
        let mut child = match started {
            Ok(child) => child,
            Err(error) => {
                tracing::error!(target: log::PROGRAMS, "{name} cannot be started: {error}");
                self.broadcast(&format!("error: {name} cannot be started: {error}"));
                return;
            }
        };
        if child.send(first) {
            for (hull, text) in around.mailbox.take_kept() {
                child.send(ToProgram::Mail { hull, text: &text });
            }
        }
        if let Some(path) = &path {
            around
                .record
                .program(&around.settings.scripts, path, language);
        }
        let is_quiet = path.is_none();
        self.last = language;
        let mut shown = around.programs.shown.borrow_mut();
        shown.started = shown.started.saturating_add(1);
        shown.text = Some((
            format!("{name} ({}, process {})", language.name(), child.pid),
            Instant::now(),
        ));
        drop(shown);
        tracing::info!(target: log::PROGRAMS, "{name} starts as process {}", child.pid);
        around.record.line(
            Story::Programs,
            &name,
            &format!("{} as {}", news::started(&name), language.name()),
        );
        if !is_quiet {
            self.broadcast(&format!("info: {}", news::started(&name)));
        }
        self.current = Some(Current {
            child,
            name,
            since: Instant::now(),
            takes_direct: false,
            is_quiet,
            has_reported_error: false,
            has_asked_nobody: false,
            is_watched: false,
            is_under_debugpy: false,
            has_missed_debugger: false,
            still: (None, 0),
            meter: Meter::default(),
            web: Vec::new(),
            orders: VecDeque::new(),
            changes: VecDeque::new(),
            ended: None,
        });
        // Together with its beginning, so that a recording has that.
        self.send_watch();
    }

    fn broadcast(&self, text: &str) {
        self.around.clients.broadcast(text.as_bytes());
    }

    async fn hear(&mut self, event: Event) {
        match event {
            Event::Line(text) => self.show(Manner::Print, &text),
            Event::Frame(text) => self.hear_frame(&text),
            Event::Ended(ended) => {
                if let Some(current) = &mut self.current {
                    current.ended = Some((ended, Instant::now()));
                }
            }
        }
        let Some(current) = &self.current else { return };
        if let Some((ended, _)) = current.ended
            && current.child.is_silent()
        {
            self.end(Cause::Exited(ended)).await;
        }
    }

    fn hear_frame(&mut self, frame: &str) {
        let Some(message) = FromProgram::parse(frame) else {
            return;
        };
        match message {
            FromProgram::Print(text) => self.show(Manner::Print, text),
            FromProgram::Info(text) => {
                self.note_debugger(text);
                self.show(Manner::Info, text);
            }
            FromProgram::Error(text) => {
                self.note_debugger(text);
                if let Some(current) = &mut self.current {
                    current.has_reported_error = true;
                }
                // One without a text was told before.
                if !text.is_empty() {
                    self.show(Manner::Error, text);
                }
            }
            FromProgram::Events => {
                if let Some(current) = &mut self.current {
                    current.takes_direct = true;
                }
            }
            FromProgram::Mailbox(question) => {
                let answer = self.around.mailbox.answer(question);
                self.send(ToProgram::Answer(&answer));
            }
            FromProgram::Web(json) => {
                let web = self
                    .current
                    .as_mut()
                    .map(|current| std::mem::take(&mut current.web));
                for answer in web.into_iter().flatten() {
                    let _ = answer.send(json.to_owned());
                }
            }
            FromProgram::Watch { line, json } => {
                self.around.clients.send_to_watchers(line, json);
                self.around.record.line(Story::Diagram, "diagram", json);
            }
            FromProgram::Changed { is_changed, text } => self.hear_change(is_changed, text),
            FromProgram::Debug { client, json } => self.hear_debugger(client, json),
            FromProgram::DebugLog(json) => self.around.clients.tell_log(json),
            FromProgram::Question { number, json } => self.question(number, json),
            FromProgram::Stopped(place) => self.note_place(place),
        }
    }

    /// A program that has too many processes ends: as root it would have no other limit. So does one that somebody has
    /// stopped and not continued (SIGSTOP): what it has set going would go on.
    async fn count_processes(&mut self) {
        let Some(current) = &mut self.current else {
            return;
        };
        let (all, still) = kill::below_and_still(Pid::this());
        let count = u64::try_from(all.len()).unwrap_or(u64::MAX);
        let limit = self.around.settings.processes;
        let before = match current.still {
            (before, looks) if before == still => looks,
            _ => 0,
        };
        current.still = (still, before.saturating_add(1));
        let why = match still {
            _ if count > limit => format!("it had {count} processes, and {limit} are allowed"),
            Some(pid) if current.still.1 >= limits::STILL_LOOKS => {
                format!("its process {pid} stood still (SIGSTOP)")
            }
            _ => return,
        };
        self.end(Cause::Greedy(why)).await;
    }

    /// The one way out. First the motors, then the processes, then the motors once more, because until its last moment
    /// a program may have set them going; then everybody is told.
    async fn end(&mut self, cause: Cause) {
        let began = Instant::now();
        // Whatever it is about to write waits until it is dead. The number of one that is dead may be another's already.
        if let Some(current) = self.current.as_ref().filter(|current| current.child.runs()) {
            group(current.child.pid, Signal::SIGSTOP);
        }
        // A tree that is slow is still on its way to rest; the program must not live so long.
        let mut rested = self.around.rest.now(limits::REST_WAIT_MS).await;
        let leader = self.current.as_ref().map(|current| current.child.pid);
        // Processes that have left the group may have written since; from here on they stand still.
        if leader.is_some_and(|leader| freeze(Pid::this(), leader)) {
            rested = self.around.rest.now(limits::REST_WAIT_MS).await;
        }
        let rest_us = began.elapsed().as_micros();
        let Some(mut current) = self.current.take() else {
            let last = match rested {
                Ok(()) => Ok(()),
                Err(_) => self.around.rest.now(limits::REST_LAST_MS).await,
            };
            self.report_rest(last, rest_us);
            return;
        };
        if current.child.runs() {
            group(current.child.pid, Signal::SIGKILL);
        }
        self.kill_all(&mut current).await;
        let last = self.around.rest.now(limits::REST_LAST_MS).await;
        self.report_rest(last, rest_us);
        self.around.feedback.show(Moment::Ended);
        self.end_debugger(&mut current);
        self.report_end(&mut current, &cause);
        self.around.programs.shown.borrow_mut().text = None;
        self.note_place(None);
        self.around.mailbox.forget_kept();
    }

    /// Kills until nobody is left, and takes what was said before.
    async fn kill_all(&mut self, current: &mut Current) {
        let deadline = Instant::now() + Duration::from_millis(limits::KILL_MS);
        let mut spared = Vec::new();
        let mut rounds = 0;
        let mut pause = Duration::from_millis(1);
        loop {
            self.around.reaper.reap();
            let left = sweep(Pid::this(), &spared);
            if left == 0 || Instant::now() > deadline {
                if left > 0 {
                    tracing::error!(
                        target: log::PROGRAMS,
                        "{left} processes of {} cannot be killed",
                        current.name
                    );
                }
                break;
            }
            rounds += 1;
            if rounds == limits::KILL_ROUNDS {
                spared.extend(self.kill_user());
            }
            tokio::time::sleep(pause).await;
            pause = (pause * 2).min(Duration::from_millis(10));
        }
        // What stands in the pipes of the dead comes without waiting.
        let drain = Duration::from_millis(limits::DRAIN_MS);
        let _ = tokio::time::timeout(drain, async {
            while !current.child.is_silent() {
                match current.child.next_event().await {
                    Event::Ended(ended) => {
                        current.ended.get_or_insert((ended, Instant::now()));
                    }
                    Event::Line(text) => self.show_last(current, Manner::Print, &text),
                    Event::Frame(frame) => self.hear_last(current, &frame),
                }
            }
        })
        .await;
    }

    /// Starts the process that kills all others of the user of programs.
    fn kill_user(&self) -> Option<Pid> {
        let user = &self.around.owner.as_ref()?.user;
        let mut command = child::this_program();
        command.arg("kill-user").stdin(Stdio::null());
        std::os::unix::process::CommandExt::uid(&mut command, user.uid.as_raw());
        std::os::unix::process::CommandExt::gid(&mut command, user.gid.as_raw());
        let process = command.spawn().ok()?;
        Some(Pid::from_raw(i32::try_from(process.id()).ok()?))
    }

    fn report_end(&self, current: &mut Current, cause: &Cause) {
        let now = Instant::now();
        self.report_dropped(current.meter.take_dropped(now, true));
        while let Some(said) = current.meter.release(now, true) {
            self.report_output(&said, &current.name);
        }
        let name = &current.name;
        let seconds = current.since.elapsed().as_secs_f64();
        let end = match cause {
            Cause::Exited(Ended::Code(0)) if current.has_reported_error => End::Failed,
            Cause::Exited(Ended::Code(0)) => End::Well,
            Cause::Exited(Ended::Code(code)) => End::Code(*code),
            Cause::Exited(Ended::Signal(libc::SIGKILL)) if current.child.kills.have_grown() => {
                End::Starved
            }
            // Memory that it does not get and a stack that is too deep end it so.
            Cause::Exited(Ended::Signal(libc::SIGABRT)) if self.last == Language::Diagram => {
                End::Short(self.around.settings.memory_mib)
            }
            Cause::Exited(Ended::Signal(signal)) => {
                End::Killed(Signal::try_from(*signal).map_or("a signal", Signal::as_str))
            }
            Cause::Ordered(who) => End::Stopped(who),
            Cause::Greedy(why) => End::Greedy(why),
        };
        let (text, failed) = (end.describe(name, seconds), end.is_failure());
        match failed {
            true => tracing::warn!(target: log::PROGRAMS, "{text}"),
            false => tracing::info!(target: log::PROGRAMS, "{text}"),
        }
        let level = if failed { Level::Error } else { Level::Info };
        (self.around.record).level(Story::Programs, level, name, &text);
        if failed {
            self.around.record.freeze(SaveReason::Crash);
        }
        let is_news = failed && !current.has_reported_error;
        if is_news {
            self.broadcast(&format!("error: {text}"));
        } else if !current.is_quiet {
            self.broadcast(&format!("info: {text}"));
        }
        let mut shown = self.around.programs.shown.borrow_mut();
        shown.failed = shown.failed.saturating_add(u32::from(failed));
        shown.last_end = text;
    }
}

async fn next_event(current: &mut Option<Current>) -> Event {
    match current {
        Some(current) => current.child.next_event().await,
        None => std::future::pending().await,
    }
}

/// A while after the end of the process: somebody that it started may hold its pipes open for ever.
async fn drained(ended: Option<(Ended, Instant)>) {
    match ended {
        Some((_, at)) => {
            tokio::time::sleep_until((at + Duration::from_millis(limits::DRAIN_MS)).into()).await
        }
        None => std::future::pending().await,
    }
}
