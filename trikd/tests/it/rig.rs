//! A running `trikd` with everything in a folder of its own, and clients that speak raw bytes.
//!
//! Owns the process from its ready line to its end; dropping it insists that no process is left. One that lives too
//! long is killed, so that a hang becomes a failure.

use harness::wait::{LIFE, SOON, eventually};
use harness::{Board, processes};
use nix::sys::signal::Signal;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// The program under test: the one built with the tests, or an installed one that `TRIKD_UNDER_TEST` names.
pub fn trikd() -> &'static str {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    PROGRAM.get_or_init(|| std::env::var("TRIKD_UNDER_TEST").unwrap_or_else(|_| BUILT.to_owned()))
}

/// The one built with the tests.
pub const BUILT: &str = env!("CARGO_BIN_EXE_trikd");

/// A running trikd.
pub struct Robot {
    pub home: Board,
    pub tree: PathBuf,
    guardian: Option<Child>,
    ready: String,
    complaints: Arc<Mutex<String>>,
    _alive: Sender<()>,
}

/// A folder with a small tree: one motor, an analog and a distance sensor.
pub fn small_tree() -> Board {
    let home = Board::new();
    for directory in [
        "tree/motors/M1",
        "tree/sensors/A1",
        "tree/sensors/D1",
        "tree/encoders/E1",
        "tree/keys",
    ] {
        fs::create_dir_all(home.path(directory)).expect("a directory");
    }
    for (file, content) in [
        ("tree/motors/M1/value", "0\n"),
        ("tree/sensors/A1/value", "27\n"),
        ("tree/sensors/A1/raw", "281\n"),
        ("tree/sensors/D1/value", ""),
        ("tree/sensors/D1/raw", "-1 0\n"),
        ("tree/encoders/E1/value", "90\n"),
        ("tree/encoders/E1/raw", "-384\n"),
        ("tree/keys/value", "0 0 0 0 0 0 0\n"),
        ("tree/stop", ""),
    ] {
        home.file(file, content);
    }
    home
}

/// The command that serves in this folder with free ports.
pub fn command(home: &Board, tree: &std::path::Path, words: &[&str]) -> Command {
    let mut command = Command::new(trikd());
    command.arg("serve").arg("--tree").arg(tree);
    for (option, name) in [
        ("--scripts", "scripts"),
        ("--state", "state"),
        ("--run", "run"),
        ("--gamepad-fifo", "gamepad.fifo"),
    ] {
        command.arg(option).arg(home.path(name));
    }
    for port in [
        "control",
        "telemetry",
        "mailbox",
        "gamepad",
        "video",
        "variables",
    ] {
        let option = format!("--{port}-port");
        if !words.contains(&option.as_str()) {
            command.args([option.as_str(), "0"]);
        }
    }
    if !words.contains(&"--address") {
        command.args(["--address", "127.0.0.1"]);
    }
    if !words.contains(&"--name") {
        // Several robots in one network would answer each other's questions.
        command.args(["--without", "discovery"]);
    }
    command.args(words);
    command
}

/// A robot with a small tree.
pub fn robot(words: &[&str]) -> Robot {
    let home = small_tree();
    let tree = home.path("tree");
    Robot::start(home, tree, words)
}

fn lines_of(pipe: impl Read + Send + 'static) -> Receiver<String> {
    let (say, lines) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(pipe).lines().map_while(Result::ok) {
            let _ = say.send(line);
        }
    });
    lines
}

impl Robot {
    /// Starts it and waits until it is ready.
    pub fn start(home: Board, tree: PathBuf, words: &[&str]) -> Self {
        Self::start_with(home, tree, words, &[])
    }

    /// The same with these variables of the environment.
    pub fn start_with(
        home: Board,
        tree: PathBuf,
        words: &[&str],
        variables: &[(&str, &str)],
    ) -> Self {
        let mut command = command(&home, &tree, words);
        command.envs(variables.iter().copied());
        command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut guardian = command.spawn().expect("trikd");
        let complaints = Arc::new(Mutex::new(String::new()));
        let heard = complaints.clone();
        let stderr = lines_of(guardian.stderr.take().expect("a pipe"));
        std::thread::spawn(move || {
            for line in stderr {
                let mut all = heard.lock().unwrap_or_else(PoisonError::into_inner);
                all.push_str(&line);
                all.push('\n');
            }
        });
        let (alive, life) = channel::<()>();
        let soak = std::env::var("TRIKD_SOAK_S")
            .ok()
            .and_then(|text| text.parse().ok());
        let limit = LIFE + Duration::from_secs(soak.unwrap_or(0));
        let pid = guardian.id();
        std::thread::spawn(move || {
            if life.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                eprintln!("the trikd of process {pid} lives for more than {limit:?}: it is ended");
                processes::signal(pid, Signal::SIGTERM);
            }
        });
        let lines = lines_of(guardian.stdout.take().expect("a pipe"));
        let mut robot = Self {
            home,
            tree,
            guardian: Some(guardian),
            ready: String::new(),
            complaints,
            _alive: alive,
        };
        match lines.recv_timeout(SOON) {
            Ok(ready) => robot.ready = ready,
            Err(error) => panic!("not ready: {error}\n{}", robot.log()),
        }
        // Later ready lines are those of a new serving process.
        std::thread::spawn(move || for _ in lines {});
        robot
    }

    /// What it has written to standard error.
    pub fn log(&self) -> String {
        self.complaints
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Waits until it has written a line with this to standard error: lines come through a pipe and a thread, later than
    /// what a client sees.
    pub fn expect_log(&self, part: &str) {
        eventually(part, || self.log().contains(part));
    }

    /// The number of a port by its name.
    pub fn port(&self, name: &str) -> u16 {
        let words: Vec<&str> = self.ready.split([' ', ',']).collect();
        let index = words
            .iter()
            .position(|word| *word == name)
            .unwrap_or_else(|| panic!("no port {name}: {}", self.ready));
        words[index + 1].parse().expect("a number")
    }

    /// A new connection to a port.
    pub fn client(&self, port: &str) -> Client {
        Client::new(self.port(port))
    }

    /// The guardian.
    pub fn guardian(&self) -> u32 {
        self.guardian.as_ref().map_or(0, Child::id)
    }

    /// The serving process.
    pub fn daemon(&self) -> u32 {
        let mut found = None;
        eventually("a serving process", || {
            found = processes::children(self.guardian()).first().copied();
            found.is_some()
        });
        found.expect("a process")
    }

    /// What `trikd status` says.
    pub fn status(&self) -> String {
        let output = Command::new(trikd())
            .arg("status")
            .arg("--run")
            .arg(self.home.path("run"))
            .output()
            .expect("trikd");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// How often something was brought to rest, as the plain file shows it: it is emptied here, and written there.
    pub fn has_rested(&self) -> bool {
        self.home.content("tree/stop") == b"1\n"
    }

    /// Forgets that something was brought to rest.
    pub fn forget_rest(&self) {
        fs::write(self.tree.join("stop"), "").expect("a file");
    }

    /// Ends it in order and returns its exit code.
    pub fn end(mut self) -> Option<i32> {
        self.finish()
    }

    fn finish(&mut self) -> Option<i32> {
        let mut guardian = self.guardian.take()?;
        processes::signal(guardian.id(), Signal::SIGTERM);
        let deadline = Instant::now() + SOON;
        loop {
            match guardian.try_wait().expect("a child") {
                Some(status) => return status.code(),
                None if Instant::now() > deadline => {
                    let _ = guardian.kill();
                    let _ = guardian.wait();
                    assert!(
                        std::thread::panicking(),
                        "trikd does not end\n{}",
                        self.log()
                    );
                    return None;
                }
                None => std::thread::sleep(Duration::from_millis(2)),
            }
        }
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        self.finish();
        if std::thread::panicking() {
            eprintln!("{}\n{}", self.ready, self.log());
        }
    }
}

/// A connection.
pub struct Client {
    pub stream: TcpStream,
    buffer: Vec<u8>,
    sent: Instant,
    kept_alive: Arc<()>,
}

/// A frame of a payload.
pub fn frame(payload: &str) -> Vec<u8> {
    format!("{}:{payload}", payload.len()).into_bytes()
}

impl Client {
    /// To a port of this machine.
    pub fn new(port: u16) -> Self {
        Self::over(TcpStream::connect(("127.0.0.1", port)).expect("a connection"))
    }

    /// Over a connection that is there.
    pub fn over(stream: TcpStream) -> Self {
        stream.set_read_timeout(Some(SOON)).expect("a timeout");
        stream.set_nodelay(true).expect("an option");
        Self {
            stream,
            buffer: Vec::new(),
            sent: Instant::now(),
            kept_alive: Arc::new(()),
        }
    }

    /// From now on it is not silent, whatever else the test does; a test that calls this sends small frames only.
    pub fn keep_alive(&self) {
        let mut stream = self.stream.try_clone().expect("a descriptor");
        let lives = Arc::downgrade(&self.kept_alive);
        std::thread::spawn(move || {
            while lives.strong_count() > 0 && stream.write_all(&frame("keepalive")).is_ok() {
                std::thread::sleep(Duration::from_millis(500));
            }
        });
    }

    /// Sends bytes as they are.
    pub fn raw(&mut self, bytes: impl AsRef<[u8]>) {
        self.sent = Instant::now();
        self.stream.write_all(bytes.as_ref()).expect("to send");
    }

    /// Sends a frame.
    pub fn send(&mut self, payload: &str) {
        self.raw(frame(payload));
    }

    /// The next frame as it came; keepalives are left out. None: the connection has ended.
    pub fn next(&mut self) -> Option<String> {
        loop {
            if self.sent.elapsed() > Duration::from_secs(1)
                && self.stream.write_all(&frame("keepalive")).is_ok()
            {
                self.sent = Instant::now();
            }
            if let Some(colon) = self.buffer.iter().position(|byte| *byte == b':') {
                let count = std::str::from_utf8(&self.buffer[..colon]).expect("a count");
                let size: usize = count
                    .parse()
                    .unwrap_or_else(|_| panic!("no count: {count}"));
                if self.buffer.len() > colon + size {
                    let payload = String::from_utf8(self.buffer[colon + 1..=colon + size].to_vec())
                        .expect("UTF-8");
                    self.buffer.drain(..=colon + size);
                    if payload == "keepalive" {
                        self.send("keepalive");
                        continue;
                    }
                    return Some(payload);
                }
            }
            let mut piece = [0; 65536];
            match self.stream.read(&mut piece) {
                Ok(0) => return None,
                Ok(size) => self.buffer.extend_from_slice(&piece[..size]),
                // A wait with a timeout is not taken up again by the kernel when somebody stops and continues us.
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == std::io::ErrorKind::ConnectionReset => return None,
                Err(error) => panic!("nothing came: {error}"),
            }
        }
    }

    /// Exactly so many bytes, or those before the end.
    pub fn exactly(&mut self, count: usize) -> Vec<u8> {
        let mut piece = [0; 4096];
        while self.buffer.len() < count {
            match self.stream.read(&mut piece) {
                Ok(size) if size > 0 => self.buffer.extend_from_slice(&piece[..size]),
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                _ => break,
            }
        }
        let count = count.min(self.buffer.len());
        self.buffer.drain(..count).collect()
    }

    /// The next frame must be this one.
    pub fn expect(&mut self, payload: &str) {
        assert_eq!(self.next().as_deref(), Some(payload));
    }

    /// Reads on until a frame begins so, and returns it.
    pub fn until(&mut self, start: &str) -> String {
        let mut others = Vec::new();
        loop {
            match self.next() {
                Some(payload) if payload.starts_with(start) => return payload,
                Some(other) => others.push(other.chars().take(200).collect::<String>()),
                None => panic!(
                    "no '{start}' but {} others, first {:?}",
                    others.len(),
                    &others[..others.len().min(20)]
                ),
            }
        }
    }

    /// Asks for the version, which is answered after everything else that this client asked for directly.
    pub fn sync(&mut self) {
        self.send("version");
        self.until("version: ");
    }
}
