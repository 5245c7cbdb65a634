//! How many submissions of a queue workers judge, beside `trik check` with as many processes and the same files.
//!
//! `cargo bench -p trik --features nats --bench queue` where `nats-server` is installed; `QUEUE_COUNT` is how many submissions each
//! round has (1000). If you are root and `ip` is there, each worker has a network namespace of its own, as on a computer of its own,
//! behind one bridge; else all share this one. The server and the commands that hand in and look have to share the processors with the workers, so two workers
//! on two cores say what such a computer does, and not what a worker is worth on its own.

use std::fs;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const TRIK: &str = env!("CARGO_BIN_EXE_trik");
const SERVER: &str = "nats-server";
/// How many workers, each with one process.
const WORKERS: [usize; 3] = [1, 2, 4];
const LOOK_TIME: Duration = Duration::from_millis(100);
/// The least share of `trik check` that each worker shall have.
const GOAL: f64 = 0.9;

/// A process that is killed with the round.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Namespaces of workers behind a bridge; they go with it.
struct Network;

impl Network {
    const BRIDGE: &str = "trikqueue";
    const SERVER: &str = "10.203.0.1";

    fn name(worker: usize) -> String {
        format!("{}{worker}", Self::BRIDGE)
    }

    fn ip(line: &str) -> bool {
        let mut command = Command::new("ip");
        command.args(line.split(' ')).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    }

    /// None: the system does not let us.
    fn new() -> Option<Self> {
        let bridge = Self::BRIDGE;
        let network = Self::ip(&format!("link add {bridge} type bridge")).then_some(Self)?;
        let mut lines = vec![
            format!("addr add {}/24 dev {bridge}", Self::SERVER),
            format!("link set {bridge} up"),
        ];
        for worker in 0..WORKERS.into_iter().max().unwrap_or_default() {
            let (name, end) = (Self::name(worker), format!("trikq{worker}"));
            lines.extend([
                format!("netns add {name}"),
                format!("link add {end} type veth peer name eth0 netns {name}"),
                format!("link set {end} master {bridge} up"),
                format!("-n {name} addr add 10.203.0.{}/24 dev eth0", worker + 10),
                format!("-n {name} link set eth0 up"),
            ]);
        }
        lines.iter().all(|line| Self::ip(line)).then_some(network)
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        for worker in 0..WORKERS.into_iter().max().unwrap_or_default() {
            Self::ip(&format!("netns del {}", Self::name(worker)));
        }
        Self::ip(&format!("link del {}", Self::BRIDGE));
    }
}

/// A folder with a task, a server and its address.
struct Place {
    folder: PathBuf,
    address: String,
    network: Option<Network>,
    _server: Running,
}

impl Place {
    fn command(&self, words: &[&str]) -> Command {
        self.set_up(Command::new(TRIK), words)
    }

    /// A worker, on a computer of its own if that can be.
    fn worker(&self, number: usize) -> Running {
        let command = match self.network {
            Some(_) => {
                let mut command = Command::new("ip");
                command.args(["netns", "exec", &Network::name(number), TRIK]);
                command
            }
            None => Command::new(TRIK),
        };
        let words = ["grade-worker", "--tasks", "tasks", "--jobs", "1"];
        Running(self.set_up(command, &words).spawn().expect("trik"))
    }

    fn set_up(&self, mut command: Command, words: &[&str]) -> Command {
        command.current_dir(&self.folder).args(words);
        command.stdin(Stdio::null()).stdout(Stdio::null());
        command.stderr(Stdio::null());
        if words[0].starts_with("grade-") {
            command.args(["--server", &self.address]);
        }
        command
    }

    /// Programs that are like no others, in a folder of their own.
    fn files(&self, round: usize, count: usize) -> Vec<String> {
        let text = fs::read_to_string(self.folder.join("made/solution.js")).expect("a program");
        let folder = format!("round{round}");
        fs::create_dir(self.folder.join(&folder)).expect("a folder");
        let file = |number: usize| {
            let name = format!("{folder}/{number}.js");
            let text = format!("{text}\n// {round} {number}\n");
            fs::write(self.folder.join(&name), text).expect("written");
            name
        };
        (0..count).map(file).collect()
    }

    /// How many are judged.
    fn judged(&self) -> usize {
        let mut command = self.command(&["grade-status"]);
        let output = command.stdout(Stdio::piped()).output().expect("trik");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let line = text.lines().find(|line| line.starts_with("judged"));
        let count = line.and_then(|line| line.rsplit(' ').next()?.parse().ok());
        count.expect("a count")
    }
}

fn place(folder: &Path) -> Option<Place> {
    let network = Network::new();
    let ip = network.as_ref().map_or("127.0.0.1", |_| Network::SERVER);
    let free = TcpListener::bind((ip, 0)).and_then(|socket| socket.local_addr());
    let port = free.expect("a port").port();
    let server = Command::new(SERVER)
        .args(["--jetstream", "--store_dir", "kept", "-a", ip])
        .args(["-p", &port.to_string()])
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let server = Running(server);
    let address = format!("{ip}:{port}");
    while TcpStream::connect(&address).is_err() {
        std::thread::sleep(LOOK_TIME);
    }
    let place = Place {
        folder: folder.to_owned(),
        address,
        network,
        _server: server,
    };
    let made = place.command(&["new-task", "made"]).status();
    assert!(made.expect("trik").success());
    fs::create_dir(folder.join("tasks")).expect("a folder");
    fs::copy(folder.join("made/world.xml"), folder.join("tasks/road.xml")).expect("a task");
    Some(place)
}

fn main() {
    let count = std::env::var("QUEUE_COUNT").ok();
    let count = count.map_or(1000, |text| text.parse().expect("QUEUE_COUNT is a number"));
    let folder = tempfile::tempdir().expect("a folder");
    let Some(place) = place(folder.path()) else {
        println!("there is no {SERVER}: nothing is measured");
        return;
    };
    println!(
        "workers {}",
        match place.network {
            Some(_) => "in namespaces of their own",
            None => "in this namespace: you are not root, or there is no ip",
        }
    );
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    for (round, workers) in WORKERS.into_iter().enumerate() {
        let files = place.files(round, count);
        let jobs = workers.min(cores).to_string();
        let begin = Instant::now();
        let words = [
            &format!("round{round}"),
            "--field",
            "tasks/road.xml",
            "--jobs",
            &jobs,
        ];
        let done = place.command(&[&["check"], &words[..]].concat()).status();
        assert!(done.expect("trik").success());
        let alone_s = begin.elapsed().as_secs_f64();

        let words = ["grade-submit", "--task", "road"];
        let files: Vec<&str> = files.iter().map(String::as_str).collect();
        let (begin, before) = (Instant::now(), place.judged());
        let sent = place.command(&[&words[..], &files].concat()).status();
        assert!(sent.expect("trik").success());
        let sent_s = begin.elapsed().as_secs_f64();
        let begin = Instant::now();
        let running: Vec<Running> = (0..workers).map(|number| place.worker(number)).collect();
        while place.judged() < before + count {
            std::thread::sleep(LOOK_TIME);
        }
        let queue_s = begin.elapsed().as_secs_f64();
        drop(running);
        let rate = |seconds: f64| count as f64 / seconds;
        println!(
            "{workers} workers: {:.0} a second, {:.2} of trik check --jobs {jobs} ({:.0} a second), goal {GOAL}; handed in {:.0} a second",
            rate(queue_s),
            alone_s / queue_s,
            rate(alone_s),
            rate(sent_s),
        );
    }
}
