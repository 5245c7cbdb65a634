//! A running `trik up` with a private place of its own, and its virtual board from the other side.
//!
//! Owns the process from its ready line to its end; dropping it insists that nothing is left behind. A robot that lives
//! too long is killed, so that a hang becomes a failure.

use harness::wait::{LIFE, SOON, eventually, skip};
use harness::{Board, Output, board, processes, tools};
use nix::sys::signal::Signal;
use nix::sys::socket::{
    AddressFamily, MsgFlags, SockFlag, SockType, UnixAddr, connect, recv, send, setsockopt, socket,
    sockopt::ReceiveTimeout,
};
use nix::sys::time::TimeVal;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::fd::AsRawFd;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The program under test.
pub const TRIK: &str = env!("CARGO_BIN_EXE_trik");
/// The last line of what a robot says when it is ready.
const LAST_LINE: &str = "Ctrl-C ends it.";

/// A directory for everything, and in it that of the robots.
pub struct Home(pub Board);

impl Home {
    /// None if nothing can be mounted here, which has been said by name.
    pub fn new() -> Option<Self> {
        match harness::mount::obstacle() {
            Some(why) => {
                skip(why);
                None
            }
            None => Some(Self(Board::new())),
        }
    }

    /// `trik` with these words, in this home.
    pub fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(TRIK);
        command
            .args(words)
            .env("XDG_RUNTIME_DIR", self.0.dir())
            .current_dir(self.0.dir());
        command
    }

    /// Runs `trik` to its end.
    pub fn run(&self, words: &[&str]) -> Output {
        tools::run(&mut self.command(words), b"")
    }

    /// Where robots live.
    pub fn base(&self) -> PathBuf {
        self.0.path("trik")
    }
}

/// A robot.
pub struct Robot {
    pub home: Arc<Home>,
    process: Option<Child>,
    pub root: PathBuf,
    /// Its devices.
    pub devices: PathBuf,
    said: String,
    complaints: Arc<Mutex<String>>,
    /// Lines after that.
    lines: Receiver<String>,
    /// Dropping it tells the one who kills late robots that all is well.
    _alive: Sender<()>,
}

/// What the board's file `pose` says.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pose {
    pub x_m: f64,
    pub y_m: f64,
    pub heading_deg: f64,
    pub time_s: f64,
    /// How often it has run into a wall.
    pub bumps: f64,
}

impl Pose {
    /// Metres between two places.
    pub fn away_from(&self, other: &Self) -> f64 {
        (self.x_m - other.x_m).hypot(self.y_m - other.y_m)
    }
}

/// An address of this machine that no other test has, so that every robot can have the ports that clients know.
pub fn loopback() -> String {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let number = std::process::id().wrapping_mul(64).wrapping_add(count);
    let [_, b, c, d] = number.to_be_bytes();
    format!("127.{}.{c}.{d}", 64 + b % 64)
}

/// A robot in a home of its own; None if nothing can be mounted here.
pub fn robot(words: &[&str]) -> Option<Robot> {
    Some(Robot::start(Arc::new(Home::new()?), words))
}

impl Robot {
    /// Starts it and waits until it is ready.
    pub fn start(home: Arc<Home>, words: &[&str]) -> Self {
        let cache = home.0.path("cache");
        let mut command = home.command(&["up", "--cache"]);
        command.arg(cache);
        Self::begin(home, command, words)
    }

    /// The same, whose programs find what is in this directory first.
    pub fn start_with(home: Arc<Home>, words: &[&str], bin: &Path) -> Self {
        let cache = home.0.path("cache");
        let mut command = home.command(&["up", "--cache"]);
        let path = std::env::var("PATH").unwrap_or_default();
        command.arg(cache);
        command.env("PATH", format!("{}:{path}", bin.display()));
        Self::begin(home, command, words)
    }

    /// The tree of a recording of this home; `devices` is the folder of its player.
    pub fn replay(home: Arc<Home>, recording: &str, words: &[&str]) -> Self {
        let command = home.command(&["replay", recording]);
        Self::begin(home, command, words)
    }

    fn begin(home: Arc<Home>, mut command: Command, words: &[&str]) -> Self {
        command.args(words);
        if !words.iter().any(|word| word.starts_with("--trikd")) {
            // Tests run side by side, and there is one set of ports that clients know.
            command.arg("--no-trikd");
        }
        command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut process = command.spawn().expect("trik");
        let complaints = Arc::new(Mutex::new(String::new()));
        let (stdout, stderr) = (process.stdout.take(), process.stderr.take());
        collect(stderr, &complaints);
        let (say, lines) = channel();
        std::thread::spawn(move || {
            for line in stdout
                .into_iter()
                .flat_map(|pipe| BufReader::new(pipe).lines())
            {
                let _ = say.send(line.unwrap_or_default());
            }
        });
        let (alive, life) = channel::<()>();
        let pid = process.id();
        std::thread::spawn(move || {
            if life.recv_timeout(LIFE) == Err(RecvTimeoutError::Timeout) {
                eprintln!("the robot of process {pid} lives for more than {LIFE:?}: it is killed");
                processes::signal(pid, Signal::SIGKILL);
            }
        });
        let mut robot = Self {
            home,
            process: Some(process),
            root: PathBuf::new(),
            devices: PathBuf::new(),
            said: String::new(),
            complaints,
            lines,
            _alive: alive,
        };
        while !robot.said.contains(LAST_LINE) {
            match robot.lines.recv_timeout(SOON) {
                Ok(line) => robot.said.push_str(&format!("{line}\n")),
                Err(_) => panic!("not ready:\n{}{}", robot.said, robot.complaints()),
            }
        }
        let cd = robot
            .said
            .lines()
            .find_map(|line| line.strip_prefix("  cd "));
        robot.root = PathBuf::from(cd.expect("where it is"));
        // The boards of one home, and which of them is ours: its record names our mount point.
        for entry in fs::read_dir(robot.home.base()).expect("robots").flatten() {
            let lock = entry.path();
            if lock.extension().is_some_and(|ending| ending == "lock")
                && fs::read_to_string(&lock).is_ok_and(|text| {
                    text.lines().next().map(Path::new) == Some(robot.root.as_path())
                })
            {
                robot.devices = lock.with_extension("board");
            }
        }
        robot
    }

    /// What it said to the person in front of it.
    pub fn said(&self) -> &str {
        &self.said
    }

    /// The next line that it says, after those of [`Robot::said`].
    pub fn next_line(&self) -> String {
        let line = self.lines.recv_timeout(SOON);
        line.unwrap_or_else(|_| panic!("nothing more was said:\n{}", self.complaints()))
    }

    /// What it has written to standard error so far.
    pub fn complaints(&self) -> String {
        self.complaints
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Waits until this is written to standard error: it comes through a pipe and a thread, later than what the tree shows.
    pub fn complains(&self, part: &str) {
        eventually(part, || self.complaints().contains(part));
    }

    /// The process that a person started.
    pub fn pid(&self) -> u32 {
        self.process.as_ref().expect("a process").id()
    }

    /// The process that guards the tree.
    pub fn guardian(&self) -> u32 {
        only_child(self.pid())
    }

    /// The process that serves the tree.
    pub fn daemon(&self) -> u32 {
        only_child(self.guardian())
    }

    /// A path in the tree.
    pub fn path(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// Text of a file of the tree.
    pub fn read(&self, name: &str) -> io::Result<String> {
        let mut text = String::new();
        File::open(self.path(name))?.read_to_string(&mut text)?;
        Ok(text.trim_end().to_owned())
    }

    /// The errno of reading a file of the tree, 0 if it can be read.
    pub fn errno(&self, name: &str) -> i32 {
        self.read(name)
            .err()
            .map_or(0, |error| error.raw_os_error().unwrap_or(-1))
    }

    /// The numbers of a file of the tree.
    pub fn numbers(&self, name: &str) -> Vec<f64> {
        let text = self.read(name).unwrap_or_else(|error| {
            let fault = self.read(&name.replace("value", "fault"));
            panic!("{name}: {error} {fault:?}\n{}", self.complaints())
        });
        text.split_whitespace()
            .map(|word| word.parse().unwrap_or_else(|_| panic!("{name}: {text}")))
            .collect()
    }

    /// What `log` has so far.
    pub fn log(&self) -> String {
        let path = self.path("log");
        let mut file = File::options()
            .read(true)
            .custom_flags(nix::libc::O_NONBLOCK)
            .open(path)
            .expect("log");
        let mut bytes = Vec::new();
        // It ends with EAGAIN, and what came before is there.
        let _ = file.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    }

    /// The first number of a file of the tree.
    pub fn number(&self, name: &str) -> f64 {
        self.numbers(name)[0]
    }

    /// Writes text to a file of the tree with one write(2).
    pub fn write(&self, name: &str, text: &str) -> io::Result<()> {
        let mut file = File::options().write(true).open(self.path(name))?;
        file.write_all(text.as_bytes())
    }

    /// Both wheels, in percent.
    pub fn drive(&self, left: i32, right: i32) {
        self.write("motors/M3/value", &left.to_string())
            .expect("M3");
        self.write("motors/M4/value", &right.to_string())
            .expect("M4");
    }

    /// Runs a shell script in the tree.
    pub fn sh(&self, script: &str) -> Output {
        let mut command = tools::shell(script);
        let home = self.home.0.dir();
        let tools = Path::new(TRIK).parent().expect("a directory").display();
        let path = format!("{tools}:{}", std::env::var("PATH").unwrap_or_default());
        command
            .current_dir(&self.root)
            .env("XDG_RUNTIME_DIR", home)
            .env("PATH", path);
        tools::run(&mut command, b"")
    }

    /// `trik fault` with these words, which must succeed.
    pub fn fault(&self, words: &[&str]) -> String {
        let mut all = vec!["fault", "--robot", self.root.to_str().expect("UTF-8")];
        all.extend(words);
        self.home.run(&all).good()
    }

    /// The byte with which the coprocessor drives a motor, with a probe at the chip: the bus cannot read it back.
    pub fn duty(&self, motor: u8) -> io::Result<i8> {
        let bus = self.devices.join("dev/i2c-2");
        loop {
            match probe(&bus, 0x48, &[0x13 + motor], 1) {
                // Children of a test end at any time.
                Err(why) if why.kind() == io::ErrorKind::Interrupted => {}
                read => return Ok(i8::from_le_bytes([read?[0]])),
            }
        }
    }

    /// Where the robot truly is.
    pub fn pose(&self) -> Pose {
        let mut pose = Pose::default();
        eventually("a pose", || {
            let text = fs::read_to_string(self.devices.join("pose")).unwrap_or_default();
            let numbers: Vec<f64> = text
                .split_whitespace()
                .filter_map(|word| word.parse().ok())
                .collect();
            if let [x_m, y_m, heading_deg, time_s, bumps] = numbers[..] {
                pose = Pose {
                    x_m,
                    y_m,
                    heading_deg,
                    time_s,
                    bumps,
                };
            }
            numbers.len() == 5
        });
        pose
    }

    /// Degrees that a wheel on E3 or E4 has turned, with a probe at the chip.
    pub fn turned_deg(&self, encoder: u8) -> f64 {
        let (register, sign) = if encoder == 3 {
            (0x33, -1.0)
        } else {
            (0x32, 1.0)
        };
        let bytes = probe(&self.devices.join("dev/i2c-2"), 0x48, &[register], 4).expect("the bus");
        let bytes = bytes.try_into().expect("four bytes");
        sign * f64::from(i32::from_le_bytes(bytes)) * 100.0 / 157.0
    }

    /// Sends a signal and waits for the end.
    pub fn end(&mut self, signal: Signal) -> ExitStatus {
        processes::signal(self.pid(), signal);
        self.wait()
    }

    /// Waits for the end.
    pub fn wait(&mut self) -> ExitStatus {
        let mut process = self.process.take().expect("a process");
        let deadline = Instant::now() + SOON;
        loop {
            if let Some(status) = process.try_wait().expect("a child") {
                return status;
            }
            if Instant::now() > deadline {
                eprint!("{}", processes::describe(process.id()));
                let _ = process.kill();
                let _ = process.wait();
                panic!("trik did not end:\n{}", self.complaints());
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Waits until mount, devices and record are gone.
    pub fn leaves_nothing(&self) {
        eventually("the end of the mount", || {
            board::mounts_below(&self.root).is_empty()
        });
        for path in [
            &self.root,
            &self.devices,
            &self.devices.with_extension("lock"),
            &self.devices.with_extension("trikd"),
            &self.devices.with_extension("ev3dev"),
        ] {
            assert!(!path.exists(), "{} is left", path.display());
        }
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        if self.process.is_none() {
            return;
        }
        if std::thread::panicking() {
            if let Some(mut process) = self.process.take() {
                processes::signal(process.id(), Signal::SIGTERM);
                let _ = process.wait();
            }
            eprintln!("standard error of the robot:\n{}", self.complaints());
            return;
        }
        let status = self.end(Signal::SIGINT);
        assert_eq!(status.code(), Some(0), "{}", self.complaints());
        self.leaves_nothing();
    }
}

/// Gathers the lines of a pipe in the background.
fn collect(pipe: Option<impl Read + Send + 'static>, into: &Arc<Mutex<String>>) {
    let heard = into.clone();
    std::thread::spawn(move || {
        for line in pipe
            .into_iter()
            .flat_map(|pipe| BufReader::new(pipe).lines())
        {
            let mut all = heard.lock().unwrap_or_else(PoisonError::into_inner);
            all.push_str(&line.unwrap_or_default());
            all.push('\n');
        }
    });
}

fn only_child(pid: u32) -> u32 {
    let mut found = None;
    eventually("a child", || {
        found = processes::children(pid).first().copied();
        found.is_some()
    });
    found.unwrap_or(0)
}

/// What a probe sees at a chip of a virtual bus.
fn probe(bus: &Path, address: u16, out: &[u8], read: u16) -> io::Result<Vec<u8>> {
    let client = socket(
        AddressFamily::Unix,
        SockType::SeqPacket,
        SockFlag::SOCK_CLOEXEC,
        None,
    )?;
    connect(client.as_raw_fd(), &UnixAddr::new(bus)?)?;
    setsockopt(&client, ReceiveTimeout, &TimeVal::new(5, 0))?;
    let length = u16::try_from(out.len()).expect("short");
    // Version 1, and the flag of a probe.
    let mut packet = vec![1, 1];
    for number in [address, length, read] {
        packet.extend(number.to_le_bytes());
    }
    packet.extend(out);
    send(client.as_raw_fd(), &packet, MsgFlags::MSG_NOSIGNAL)?;
    let mut answer = vec![0; 4 + usize::from(read)];
    let size = recv(client.as_raw_fd(), &mut answer, MsgFlags::empty())?;
    if size < 4 {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    let errno = i32::from_le_bytes([answer[0], answer[1], answer[2], answer[3]]);
    match errno {
        0 if size == answer.len() => Ok(answer.split_off(4)),
        0 => Err(io::ErrorKind::UnexpectedEof.into()),
        errno => Err(io::Error::from_raw_os_error(errno)),
    }
}
