//! One program as a child process: how each language is started, its pipes, its channel, its end.
//!
//! Owns the descriptors of one child. What its messages lead to is not known here.

use super::memory::Kills;
use super::output::Lines;
use super::python;
use super::queue::Heard;
use super::reaper::{Ended, Reaper};
use crate::limits;
use crate::protocol::program::ToProgram;
use crate::scripts;
use crate::settings::Settings;
use frame::{Decoder, encode};
use nix::unistd::{Pid, User};
use std::ffi::{OsStr, OsString};
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::fs::MetadataExt;
use std::os::unix::net::UnixStream as StdStream;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tokio::io::AsyncReadExt;
use tokio::net::UnixStream;
use tokio::net::unix::pipe;
use tokio::sync::oneshot;

/// What a program is written in.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Language {
    /// A child of our own with an engine inside.
    JavaScript,
    /// CPython with the module `trik`.
    Python,
    /// A child of our own with the machine of diagrams inside.
    Diagram,
    /// Lua on the files of the tree, by an interpreter of the machine.
    Lua,
    /// Anything that can be executed.
    Native,
}

impl Language {
    /// The language of a file: by its ending, else by its first bytes, else JavaScript as on the original robots.
    pub fn of(path: &Path) -> Self {
        match scripts::ending(path).as_str() {
            "py" => Self::Python,
            "js" | "qts" => Self::JavaScript,
            "qrs" | "flow" => Self::Diagram,
            // One that names its interpreter runs on that.
            "lua" if !begins_as_executable(path) => Self::Lua,
            _ if begins_as_executable(path) => Self::Native,
            _ => Self::JavaScript,
        }
    }

    /// Whether programs in it take orders of a debugger.
    pub fn has_debugger(self) -> bool {
        match self {
            Self::Diagram | Self::JavaScript => true,
            Self::Python | Self::Lua | Self::Native => false,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::JavaScript => "JavaScript",
            Self::Python => "Python",
            Self::Diagram => "diagram",
            Self::Lua => "Lua",
            Self::Native => "native",
        }
    }
}

fn begins_as_executable(path: &Path) -> bool {
    let mut first = [0; 4];
    let read = std::fs::File::open(path).and_then(|mut file| io::Read::read(&mut file, &mut first));
    read.is_ok_and(|size| scripts::is_executable(&first[..size]))
}

/// Interpreters of Lua, the first that is there counts.
const LUA: [&str; 3] = ["luajit", "lua5.1", "lua"];

/// An interpreter of Lua in one of these directories.
fn lua(path: &OsStr) -> io::Result<PathBuf> {
    let found = LUA.iter().find_map(|name| {
        std::env::split_paths(path)
            .map(|directory| directory.join(name))
            .find(|file| file.is_file())
    });
    found.ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::NotFound,
            "this robot has no luajit, which runs Lua: install luajit on it, or generate the program in Python or JavaScript",
        )
    })
}

/// Whose rights programs have.
#[derive(Clone, Debug)]
pub struct Owner {
    /// Its name, uid and gid.
    pub user: User,
}

impl Owner {
    /// A motor of the tree that programs may not drive, if there is one: as the modes of its files say (path_resolution(7)).
    pub fn lacks(&self, tree: &Path) -> Option<PathBuf> {
        let motors = std::fs::read_dir(tree.join("motors")).ok()?.flatten();
        let mut files = motors.map(|motor| motor.path().join("value"));
        files.find(|file| {
            std::fs::metadata(file)
                .is_ok_and(|found| !self.may_write(found.mode(), found.uid(), found.gid()))
        })
    }

    fn may_write(&self, mode: u32, uid: u32, gid: u32) -> bool {
        let bit = if uid == self.user.uid.as_raw() {
            0o200
        } else if gid == self.user.gid.as_raw() {
            0o020
        } else {
            0o002
        };
        mode & bit != 0
    }
}

/// This program, whatever has happened to its file since it was started.
pub const SELF: &str = "/proc/self/exe";
/// The name that it is started under: it may be part of a program that has several.
pub const NAME: &str = "trikd";

/// Makes a file in `run` that starts this program under its name, for programs that draw.
///
/// # Errors
/// Those of the file system.
pub fn install(run: &Path) -> io::Result<()> {
    let path = run.join(NAME);
    match std::fs::remove_file(&path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    std::os::unix::fs::symlink(std::env::current_exe()?, path)
}

/// Puts back what a program needs of `run`, if somebody has removed it, as cleaners of temporary files do. Gives where modules
/// of Python are.
fn restore(run: &Path, language: Language) -> io::Result<PathBuf> {
    if run.join(NAME).symlink_metadata().is_err() {
        // Only programs that draw need it, and they say so.
        let _ = std::fs::create_dir_all(run).and_then(|()| install(run));
    }
    let modules = run.join("python");
    if language == Language::Python {
        python::restore(&modules)?;
    }
    Ok(modules)
}

/// The command that starts this program once more.
pub fn this_program() -> Command {
    let mut command = Command::new(SELF);
    command.arg0(NAME);
    command
}

/// Something that a child did.
#[derive(Debug)]
pub enum Event {
    /// A line of output.
    Line(String),
    /// A frame on its channel.
    Frame(String),
    /// The process has ended; its pipes may still hold something.
    Ended(Ended),
}

#[derive(Debug)]
struct Pipe {
    end: Option<pipe::Receiver>,
    lines: Lines,
}

/// A running program.
#[derive(Debug)]
pub struct Child {
    /// Its process, which leads its session and group.
    pub pid: Pid,
    /// How often the system had killed for want of memory when it began.
    pub(super) kills: Kills,
    stdout: Pipe,
    stderr: Pipe,
    channel: Option<UnixStream>,
    decoder: Decoder,
    /// Frames that the child has not taken yet.
    unsent: Vec<u8>,
    end: Option<oneshot::Receiver<Ended>>,
    /// What has happened and was not taken yet.
    events: std::collections::VecDeque<Event>,
}

/// Words of the command that becomes the program, which is looked for in these directories.
fn words(
    settings: &Settings,
    directories: &OsStr,
    language: Language,
    path: Option<&Path>,
) -> io::Result<Vec<OsString>> {
    Ok(match (language, path) {
        (Language::Native, Some(path)) => vec![path.into()],
        (Language::Lua, path) => {
            let program = path.map(OsString::from);
            let words = std::iter::once(lua(directories)?.into()).chain(program);
            words.collect()
        }
        (Language::Python, _) => {
            vec![
                settings.python.clone().into(),
                "-u".into(),
                "-c".into(),
                "import trik; trik._main()".into(),
            ]
        }
        (Language::Diagram, _) => vec![SELF.into(), "diagram".into()],
        (Language::JavaScript, _) | (Language::Native, None) => vec![SELF.into(), "js".into()],
    })
}

/// The command that starts what is in its further words within the limits of programs, as their owner.
fn within_limits(settings: &Settings, owner: Option<&Owner>) -> Command {
    let mut command = this_program();
    command
        .arg("launch")
        .arg("--parent")
        .arg(std::process::id().to_string());
    command
        .arg("--memory-mib")
        .arg(settings.memory_mib.to_string());
    command
        .arg("--processes")
        .arg(settings.processes.to_string());
    if let Some(Owner { user }) = owner {
        command
            .arg("--uid")
            .arg(user.uid.to_string())
            .arg("--gid")
            .arg(user.gid.to_string());
    }
    command
}

/// Starts a program within its limits, in the folder of programs. It leads a session of its own, and says what it says by
/// itself in this language.
///
/// # Errors
/// There can be no more processes or descriptors.
pub fn start(
    settings: &Settings,
    owner: Option<&Owner>,
    (language, heard): (Language, Heard),
    path: Option<&Path>,
    reaper: &Reaper,
) -> io::Result<Child> {
    let mut command = within_limits(settings, owner);
    let directories =
        std::env::var_os("PATH").unwrap_or_else(|| "/usr/local/bin:/usr/bin:/bin".into());
    let words = words(settings, &directories, language, path)?;
    command.arg("--").args(words);
    let modules = restore(&settings.run, language)?;
    command
        .env_clear()
        .env("PATH", directories)
        .env("HOME", &settings.scripts)
        .env("LANG", "C.UTF-8")
        .env("TRIK_TREE", &settings.tree)
        .env(
            "TRIK_LANGUAGE",
            heard.map_or(settings.language.as_str(), |locale| locale.name()),
        )
        .env("TRIK_COMPAT", settings.compat.name())
        .env("TRIK_ANSWER_S", settings.answer_s.to_string())
        // With it programs in all languages draw.
        .env("TRIKD", settings.run.join(NAME))
        // Each further heap of a thread would take 64 MiB of the address space that a program may have.
        .env("MALLOC_ARENA_MAX", "1")
        .env("PYTHONPATH", modules)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .current_dir(&settings.scripts)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let channel = if matches!(language, Language::Native | Language::Lua) {
        command.stdin(Stdio::null());
        None
    } else {
        let (ours, theirs) = StdStream::pair()?;
        ours.set_nonblocking(true)?;
        command.stdin(Stdio::from(OwnedFd::from(theirs)));
        Some(UnixStream::from_std(ours)?)
    };
    let kills = Kills::now();
    let mut process = command.spawn()?;
    let pid = Pid::from_raw(i32::try_from(process.id()).map_err(io::Error::other)?);
    let end = reaper.watch(pid);
    let pipe = |end: Option<OwnedFd>| -> io::Result<Pipe> {
        let end = end.map(pipe::Receiver::from_owned_fd).transpose()?;
        Ok(Pipe {
            end,
            lines: Lines::default(),
        })
    };
    Ok(Child {
        pid,
        kills,
        stdout: pipe(process.stdout.take().map(OwnedFd::from))?,
        stderr: pipe(process.stderr.take().map(OwnedFd::from))?,
        channel,
        decoder: Decoder::new(limits::CHANNEL_FRAME_BYTES),
        unsent: Vec::new(),
        end: Some(end),
        events: std::collections::VecDeque::new(),
    })
}

async fn from_pipe(pipe: &mut Pipe) -> (Vec<u8>, bool) {
    let mut buffer = [0; limits::READ_BYTES];
    match &mut pipe.end {
        None => std::future::pending().await,
        Some(end) => match end.read(&mut buffer).await {
            Ok(size) if size > 0 => (buffer[..size].to_vec(), false),
            _ => {
                pipe.end = None;
                (Vec::new(), true)
            }
        },
    }
}

impl Pipe {
    fn hear(
        &mut self,
        (bytes, is_over): (Vec<u8>, bool),
        events: &mut std::collections::VecDeque<Event>,
    ) {
        let mut take = |line: &str| events.push_back(Event::Line(line.to_owned()));
        self.lines.feed(&bytes, &mut take);
        if is_over {
            self.lines.finish(&mut take);
        }
    }
}

/// Something to read or room to write; takes nothing, so it can be given up at any point.
async fn moved(channel: Option<&UnixStream>, writes: bool) {
    let Some(channel) = channel else {
        return std::future::pending().await;
    };
    let interest = if writes {
        tokio::io::Interest::READABLE | tokio::io::Interest::WRITABLE
    } else {
        tokio::io::Interest::READABLE
    };
    // An error is found by the read that follows.
    let _ = channel.ready(interest).await;
}

async fn ended(end: &mut Option<oneshot::Receiver<Ended>>) -> Ended {
    match end {
        None => std::future::pending().await,
        Some(receiver) => {
            let ended = receiver.await.unwrap_or(Ended::Signal(libc::SIGKILL));
            *end = None;
            ended
        }
    }
}

impl Child {
    /// Sends a message when the child has room for it. False: it has not read for so long that this one is dropped.
    pub fn send(&mut self, message: ToProgram<'_>) -> bool {
        let payload = message.encode();
        if self.channel.is_none() || self.unsent.len() + payload.len() > limits::CHANNEL_FRAME_BYTES
        {
            return false;
        }
        self.unsent.extend_from_slice(&encode(&payload));
        self.flush();
        true
    }

    /// Whether the process still runs.
    pub fn runs(&self) -> bool {
        self.end.is_some()
    }

    /// Whether it has a channel.
    pub fn has_channel(&self) -> bool {
        self.channel.is_some()
    }

    /// Whether nothing more can be heard.
    pub fn is_silent(&self) -> bool {
        self.stdout.end.is_none()
            && self.stderr.end.is_none()
            && self.channel.is_none()
            && self.events.is_empty()
    }

    fn flush(&mut self) {
        let Some(channel) = &self.channel else { return };
        while !self.unsent.is_empty() {
            match channel.try_write(&self.unsent) {
                Ok(size) => drop(self.unsent.drain(..size)),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                // Nobody will take it any more; what came before its end can still be read.
                Err(_) => self.unsent = Vec::new(),
            }
        }
    }

    /// Takes what has come on the channel.
    fn hear_channel(&mut self) {
        self.flush();
        let mut buffer = [0; limits::READ_BYTES];
        let Some(channel) = &self.channel else { return };
        match channel.try_read(&mut buffer) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Ok(size) if size > 0 => {
                self.decoder.feed(&buffer[..size]);
                loop {
                    match self.decoder.next() {
                        Ok(Some(frame)) => self
                            .events
                            .push_back(Event::Frame(String::from_utf8_lossy(frame).into_owned())),
                        Ok(None) => return,
                        Err(_) => break,
                    }
                }
                self.channel = None;
            }
            _ => self.channel = None,
        }
    }

    /// The next thing that the child does. Can be given up at any point without loss.
    pub async fn next_event(&mut self) -> Event {
        // Who says much in one breath leaves others their turn.
        tokio::task::coop::consume_budget().await;
        loop {
            if let Some(event) = self.events.pop_front() {
                return event;
            }
            let Self {
                stdout,
                stderr,
                channel,
                end,
                unsent,
                ..
            } = self;
            tokio::select! {
                biased;
                got = from_pipe(stdout) => stdout.hear(got, &mut self.events),
                got = from_pipe(stderr) => stderr.hear(got, &mut self.events),
                () = moved(channel.as_ref(), !unsent.is_empty()) => self.hear_channel(),
                ended = ended(end) => return Event::Ended(ended),
            }
        }
    }
}
