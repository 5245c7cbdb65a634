//! What a change of a running diagram, a debugger and watchers cost on a robot: a daemon with a tree of plain files, and
//! clients of its control port. And how late a motor hears of a sensor in a program of data flow.
//!
//! `cargo bench -p trikd --bench live [-- changes|flow]`; both if none is named. Prints each figure beside its goal. A
//! machine that does other things says more about those.

mod live {
    pub mod flow;
}

use frame::encode;
use lang_diagram::sketch::Sketch;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::tempdir;

const PATCHES: u32 = 300;
const MANY: u32 = 10_000;
const STEPS: usize = 1000;
const WATCHERS: usize = 20;
const WATCHED: Duration = Duration::from_secs(10);
const LONGEST: Duration = Duration::from_secs(60);

/// The daemon, which is asked to end.
struct Daemon {
    child: Child,
    port: u16,
}

impl Drop for Daemon {
    fn drop(&mut self) {
        let pid = nix::unistd::Pid::from_raw(i32::try_from(self.child.id()).unwrap_or(0));
        let _ = nix::sys::signal::kill(pid, nix::sys::signal::Signal::SIGTERM);
        let _ = self.child.wait();
    }
}

fn tree(folder: &Path) {
    for name in ["tree/motors/M1", "tree/sensors/A1", "tree/keys"] {
        fs::create_dir_all(folder.join(name)).expect("a folder");
    }
    for (file, content) in [
        ("tree/motors/M1/value", "0\n"),
        ("tree/sensors/A1/value", "27\n"),
        ("tree/sensors/A1/raw", "281\n"),
        ("tree/keys/value", "0 0 0 0 0 0 0\n"),
        ("tree/stop", ""),
    ] {
        fs::write(folder.join(file), content).expect("a file");
    }
}

fn daemon(folder: &Path) -> Daemon {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trikd"));
    command.args(["serve", "--address", "127.0.0.1", "--without", "discovery"]);
    command.args(["--log", "error"]);
    for (option, name) in [
        ("--tree", "tree"),
        ("--scripts", "s"),
        ("--state", "st"),
        ("--run", "r"),
        ("--gamepad-fifo", "f"),
    ] {
        command.arg(option).arg(folder.join(name));
    }
    for port in [
        "control",
        "telemetry",
        "mailbox",
        "gamepad",
        "video",
        "variables",
    ] {
        command.args([format!("--{port}-port"), "0".to_owned()]);
    }
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .expect("trikd");
    let mut ready = String::new();
    let mut lines = BufReader::new(child.stdout.take().expect("a pipe"));
    lines.read_line(&mut ready).expect("a ready line");
    std::thread::spawn(move || for _ in lines.lines() {});
    let words: Vec<&str> = ready.split([' ', ',']).collect();
    let at = words.iter().position(|word| *word == "control");
    let port = words[at.expect("a port") + 1].trim().parse();
    Daemon {
        child,
        port: port.expect("a number"),
    }
}

/// A client that hears what begins with one of some texts.
struct Client {
    stream: TcpStream,
    buffer: Vec<u8>,
}

impl Client {
    fn new(port: u16) -> Self {
        let stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
        stream.set_nodelay(true).expect("an option");
        stream.set_read_timeout(Some(LONGEST)).expect("an option");
        Self {
            stream,
            buffer: Vec::new(),
        }
    }

    fn send(&mut self, payload: &[u8]) {
        // What is not sent is not answered, which is seen.
        let _ = self.stream.write_all(&encode(payload));
    }

    fn next(&mut self) -> String {
        self.try_next().expect("an answer")
    }

    /// None: the connection has ended.
    fn try_next(&mut self) -> Option<String> {
        loop {
            if let Some(colon) = self.buffer.iter().position(|byte| *byte == b':') {
                let count = std::str::from_utf8(&self.buffer[..colon]).expect("a count");
                let end = colon + 1 + count.parse::<usize>().expect("a count");
                if self.buffer.len() >= end {
                    let text = String::from_utf8_lossy(&self.buffer[colon + 1..end]).into_owned();
                    self.buffer.drain(..end);
                    if text == "keepalive" {
                        self.send(b"keepalive");
                        continue;
                    }
                    return Some(text);
                }
            }
            let mut piece = [0; 65536];
            let size = self.stream.read(&mut piece).ok().filter(|size| *size > 0)?;
            self.buffer.extend_from_slice(&piece[..size]);
        }
    }

    fn until(&mut self, wanted: impl Fn(&str) -> bool) -> String {
        loop {
            let text = self.next();
            if wanted(&text) {
                return text;
            }
        }
    }

    fn upload(&mut self, bytes: &[u8]) {
        self.send(&[b"file:d.qrs:", bytes].concat());
    }

    /// Whether the new version is in force.
    fn patch(&mut self, bytes: &[u8]) -> bool {
        self.upload(bytes);
        self.send(b"patch:refuse:d.qrs");
        let said = self.until(|text| text.contains("d.qrs is "));
        said.contains("is changed: ")
    }

    fn order(&mut self, tag: u32, text: &str) -> String {
        self.send(format!("debug:{tag} {text}").as_bytes());
        let to = format!("\"to\":{tag},");
        self.until(|text| text.starts_with("debug: ") && text.contains(&to))
    }
}

/// A motor with this power in each round of a step, and two threads that count.
fn save(power: &str) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "a = 0; b = 0")]);
    let fork = sketch.block("Fork", &[]);
    sketch.chain(&[start, clear, fork]);
    let drive = [("Ports", "M1"), ("Power", power)];
    let drive = sketch.block("TrikV6EnginesForward", &drive);
    let count = sketch.block("Function", &[("Body", "a = a + 1")]);
    let wait = sketch.block("Timer", &[("Delay", "10")]);
    sketch.chain(&[drive, count, wait, drive]);
    sketch.guarded(fork, drive, "main");
    let other = sketch.block("Function", &[("Body", "b = b + 1")]);
    let wait = sketch.block("Timer", &[("Delay", "10")]);
    sketch.chain(&[other, wait, other]);
    sketch.guarded(fork, other, "other");
    sketch.qrs().expect("a save")
}

/// Of sorted numbers the one that this share of them does not exceed.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share) as usize]
}

fn figure(name: &str, mut took: Vec<f64>, goal: Option<f64>) {
    took.sort_by(f64::total_cmp);
    let (p50, p95, p99) = (
        quantile(&took, 0.5),
        quantile(&took, 0.95),
        quantile(&took, 0.99),
    );
    let goal = goal.map_or_else(String::new, |goal| {
        let word = if p99 <= goal { "met" } else { "NOT MET" };
        format!("; goal p99 {goal} ms {word}")
    });
    println!("{name}: p50 {p50:.2} ms, p95 {p95:.2} ms, p99 {p99:.2} ms{goal}");
}

fn ms(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1000.0
}

/// From the request to the answer that it is in force, and to the motor of a loop that waits 10 ms in each round. The file is
/// there before: how long that takes is a matter of the disk, and is told apart.
fn patches(folder: &Path, client: &mut Client) {
    let motor = folder.join("tree/motors/M1/value");
    let (mut kept, mut in_force, mut seen) = (Vec::new(), Vec::new(), Vec::new());
    for round in 0..PATCHES {
        let power = (round % 98 + 1).to_string();
        let bytes = save(&power);
        let began = Instant::now();
        client.upload(&bytes);
        client.send(b"version");
        client.until(|text| text.starts_with("version: "));
        kept.push(ms(began));
        let began = Instant::now();
        client.send(b"patch:refuse:d.qrs");
        let said = client.until(|text| text.contains("d.qrs is "));
        assert!(said.contains("is changed: "), "{said}");
        in_force.push(ms(began));
        while fs::read_to_string(&motor).is_ok_and(|text| text.trim() != power) {
            assert!(
                began.elapsed() < LONGEST,
                "the motor has not heard of {power}"
            );
            std::thread::yield_now();
        }
        seen.push(ms(began));
    }
    figure("file sent, kept on the disk", kept, None);
    figure("patch sent, in force", in_force, Some(10.0));
    figure(
        "patch sent, at a motor that is told every 10 ms",
        seen,
        None,
    );
}

fn pid_of_program(folder: &Path) -> Option<u32> {
    let wanted = folder.join("s/d.qrs");
    let entries = fs::read_dir("/proc").ok()?;
    let pids = entries.filter_map(|entry| entry.ok()?.file_name().to_str()?.parse::<u32>().ok());
    pids.filter(|pid| {
        let line = fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default();
        let environment = fs::read(format!("/proc/{pid}/environ")).unwrap_or_default();
        let is_daemon = line.windows(6).any(|part| part == b"daemon");
        let folder = wanted.parent().and_then(Path::to_str).unwrap_or_default();
        let names = |bytes: &[u8]| {
            bytes
                .windows(folder.len())
                .any(|part| part == folder.as_bytes())
        };
        !is_daemon && line.windows(5).any(|part| part == b"trikd") && names(&environment)
    })
    .last()
}

fn resident_kb(pid: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let number = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
    number.unwrap_or_default()
}

/// Good and broken versions, one after the other; a counter of each thread has to go on.
fn many(folder: &Path, client: &mut Client) {
    let mut before = [0, 0];
    let (mut good, mut bad) = (0, 0);
    let broken = save("1 +");
    let pid = pid_of_program(folder);
    let mut resident = [0, 0];
    let began = Instant::now();
    for round in 0..MANY {
        let is_good = round % 3 != 0;
        let bytes = match is_good {
            true => save(&(round % 98 + 1).to_string()),
            false if round % 2 == 0 => broken.clone(),
            false => b"rubbish".to_vec(),
        };
        assert_eq!(client.patch(&bytes), is_good, "version {round}");
        if is_good {
            good += 1
        } else {
            bad += 1
        }
        if round % 500 == 499 {
            let now = ["a", "b"].map(|name| {
                let told = client.order(round, &format!("evaluate {name}"));
                let value = told.split("\"value\":\"").nth(1).expect("a value");
                value
                    .split('"')
                    .next()
                    .expect("a value")
                    .parse::<u64>()
                    .expect("a number")
            });
            assert!(
                now[0] > before[0] && now[1] > before[1],
                "{before:?}, {now:?}"
            );
            before = now;
        }
        if let Some(pid) = pid {
            let at = usize::from(round > MANY / 10);
            resident[at] = resident[at].max(resident_kb(pid));
        }
    }
    let seconds = began.elapsed().as_secs_f64();
    println!(
        "{good} good and {bad} broken versions in {seconds:.1} s: none lost, both threads go on"
    );
    match pid {
        Some(_) => println!(
            "resident memory of the program: at most {} KiB in the first tenth, {} KiB after it",
            resident[0], resident[1]
        ),
        None => println!("the process of the program was not found: its memory is not measured"),
    }
}

fn steps(client: &mut Client) {
    client.order(1, "attach");
    client.order(2, "pause");
    client.until(|text| text.contains("\"state\":\"stopped\""));
    let took = (0..STEPS as u32).map(|round| {
        let began = Instant::now();
        let told = client.order(10 + round, "step over");
        if told.contains("\"state\":\"running\"") {
            client.until(|text| text.contains("\"state\":\"stopped\""));
        }
        ms(began)
    });
    let took = took.collect();
    figure(
        "step over, stopped again (waits of 10 ms included)",
        took,
        Some(20.0),
    );
    client.order(5, "detach");
}

/// Seconds of processor time of a process.
fn processor(pid: u32) -> f64 {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    let rest = stat.rsplit(')').next().unwrap_or_default();
    let ticks: u64 = rest
        .split_whitespace()
        .skip(11)
        .take(2)
        .filter_map(|word| word.parse::<u64>().ok())
        .sum();
    ticks as f64 / 100.0
}

fn children(pid: u32) -> Vec<u32> {
    let path = format!("/proc/{pid}/task/{pid}/children");
    let text = fs::read_to_string(path).unwrap_or_default();
    text.split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect()
}

/// Of the daemon, its guardian and what it has started.
fn all_processor(daemon: &Daemon) -> f64 {
    let mut left = vec![daemon.child.id()];
    let mut sum = 0.0;
    while let Some(pid) = left.pop() {
        sum += processor(pid);
        left.extend(children(pid));
    }
    sum
}

fn watchers(daemon: &Daemon) {
    let measure = || {
        let before = all_processor(daemon);
        std::thread::sleep(WATCHED);
        (all_processor(daemon) - before) / WATCHED.as_secs_f64() * 100.0
    };
    let alone = measure();
    for _ in 0..WATCHERS {
        let mut watcher = Client::new(daemon.port);
        watcher.send(b"watch");
        std::thread::spawn(move || {
            // Until the daemon ends.
            while watcher.try_next().is_some() {}
        });
    }
    let watched = measure();
    let more = watched - alone;
    let word = if more <= 3.0 { "met" } else { "NOT MET" };
    println!(
        "a diagram of 100 rounds a second: {alone:.1} % of a core alone, {watched:.1} % with {WATCHERS} watchers; \
         goal 3 % more {word}"
    );
}

/// All figures of a diagram that runs.
fn changes(folder: &Path, daemon: &Daemon) {
    let mut client = Client::new(daemon.port);
    client.upload(&save("1"));
    client.send(b"run:d.qrs");
    client.until(|text| text.contains("has started"));
    patches(folder, &mut client);
    steps(&mut client);
    many(folder, &mut client);
    watchers(daemon);
    client.send(b"stop");
}

/// A part of this benchmark, with the folder of scripts and the daemon.
type Section = fn(&Path, &Daemon);

fn main() {
    let named: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with('-'))
        .collect();
    let wanted = |name: &str| named.is_empty() || named.iter().any(|word| word == name);
    let sections: [(&str, Section); 2] = [("changes", changes), ("flow", live::flow::run)];
    for (name, run) in sections {
        if wanted(name) {
            let folder = tempdir().expect("a folder");
            tree(folder.path());
            let daemon = daemon(folder.path());
            run(folder.path(), &daemon);
        }
    }
}
