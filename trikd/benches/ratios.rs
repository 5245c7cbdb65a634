//! Costs of the daemon, each beside a peer that is measured in the same run. Prints, and judges nothing.
//!
//! Frames against memcpy, answers to many clients against the processor's time, a stop against the way of the bytes
//! alone, memory. Needs no tree: a plain directory stands for it.

use frame::{Decoder, encode};
use harness::put;
use std::fs;
use std::hint::black_box;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::{TempDir, tempdir};

const CLIENTS: usize = 100;
const PERIOD: Duration = Duration::from_millis(20);
const SECONDS: u32 = 5;
const STOPS: usize = 200;

/// Bytes in a second.
fn rate(bytes: usize, start: Instant) -> f64 {
    f64::from(u32::try_from(bytes >> 10).unwrap_or(u32::MAX)) * 1024.0
        / start.elapsed().as_secs_f64()
        / 1e9
}

fn frames() {
    for size in [20, 1000, 60_000] {
        let frame = encode(&vec![b'x'; size]);
        let stream: Vec<u8> = frame
            .iter()
            .copied()
            .cycle()
            .take((8 << 20) / frame.len() * frame.len())
            .collect();
        let mut target = stream.clone();
        let start = Instant::now();
        for _ in 0..8 {
            target.copy_from_slice(black_box(&stream));
            black_box(&target);
        }
        let copy = rate(8 * stream.len(), start);
        let start = Instant::now();
        let mut count = 0usize;
        for _ in 0..8 {
            let mut decoder = Decoder::new(1 << 20);
            for piece in stream.chunks(8192) {
                decoder.feed(piece);
                while let Ok(Some(frame)) = decoder.next() {
                    count += black_box(frame).len().min(1);
                }
            }
        }
        let decoded = rate(8 * stream.len(), start);
        println!(
            "frames of {size} bytes: {decoded:.2} GB/s, {:.0} % of memcpy, {count} frames",
            100.0 * decoded / copy
        );
    }
}

/// A daemon over a plain directory.
struct Robot {
    scratch: TempDir,
    process: Child,
    ready: String,
}

impl Robot {
    fn start() -> Self {
        let scratch = tempdir().unwrap();
        for port in ["A1", "A2", "A3", "A4", "A5", "A6"] {
            put(
                scratch.path(),
                &format!("tree/sensors/{port}/value"),
                "27\n",
            );
            put(scratch.path(), &format!("tree/sensors/{port}/raw"), "281\n");
        }
        for port in ["E1", "E2", "E3", "E4"] {
            put(
                scratch.path(),
                &format!("tree/encoders/{port}/value"),
                "90\n",
            );
            put(
                scratch.path(),
                &format!("tree/encoders/{port}/raw"),
                "384\n",
            );
        }
        put(scratch.path(), "tree/stop", "");
        let mut command = Command::new(env!("CARGO_BIN_EXE_trikd"));
        command
            .arg("serve")
            .args(["--address", "127.0.0.1", "--without", "discovery"]);
        for (option, name) in [
            ("--tree", "tree"),
            ("--scripts", "s"),
            ("--state", "st"),
            ("--run", "r"),
            ("--gamepad-fifo", "f"),
        ] {
            command.arg(option).arg(scratch.path().join(name));
        }
        for port in [
            "control",
            "telemetry",
            "mailbox",
            "gamepad",
            "video",
            "variables",
        ] {
            command.args([&format!("--{port}-port"), "0"]);
        }
        let mut process = command
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("trikd");
        let mut ready = String::new();
        BufReader::new(process.stdout.take().expect("a pipe"))
            .read_line(&mut ready)
            .expect("a line");
        Self {
            scratch,
            process,
            ready,
        }
    }

    fn client(&self, port: &str) -> TcpStream {
        let words: Vec<&str> = self.ready.split([' ', ',']).collect();
        let index = words.iter().position(|word| *word == port).expect("a port");
        let number: u16 = words[index + 1].trim().parse().expect("a number");
        let stream = TcpStream::connect(("127.0.0.1", number)).expect("a connection");
        stream.set_nodelay(true).expect("an option");
        stream
    }

    /// The serving process.
    fn daemon(&self) -> PathBuf {
        let own = self.process.id().to_string();
        let entries = fs::read_dir("/proc").expect("/proc").flatten();
        let is_child = |path: &Path| {
            let stat = fs::read_to_string(path.join("stat")).unwrap_or_default();
            stat.rsplit(')')
                .next()
                .and_then(|rest| rest.split(' ').nth(2))
                == Some(own.as_str())
        };
        entries
            .map(|entry| entry.path())
            .find(|path| is_child(path))
            .expect("a serving process")
    }

    /// Seconds of a processor that it has used (proc(5): 14 and 15, in hundredths).
    fn used(&self) -> f64 {
        let stat = fs::read_to_string(self.daemon().join("stat")).expect("stat");
        let fields: Vec<&str> = stat
            .rsplit(')')
            .next()
            .unwrap_or_default()
            .split(' ')
            .collect();
        [12, 13]
            .iter()
            .map(|index| fields[*index].parse::<f64>().unwrap_or(0.0))
            .sum::<f64>()
            / 100.0
    }

    fn resident_kib(&self, path: &Path) -> u64 {
        let status = fs::read_to_string(path.join("status")).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        line.and_then(|line| line.split_whitespace().next()?.parse().ok())
            .unwrap_or(0)
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        let pid = nix::unistd::Pid::from_raw(i32::try_from(self.process.id()).unwrap_or(0));
        let _ = nix::sys::signal::kill(pid, nix::sys::signal::Signal::SIGTERM);
        let _ = self.process.wait();
    }
}

fn percentile(times: &mut [Duration], part: usize) -> Duration {
    times.sort();
    times[(times.len() - 1) * part / 1000]
}

fn polls(robot: &Robot) {
    let used = robot.used();
    let start = Instant::now();
    let work = |index: u32| {
        let mut stream = robot.client("telemetry");
        let mut times = Vec::new();
        let mut buffer = vec![0; 4096];
        let mut next = Instant::now() + PERIOD * index / u32::try_from(CLIENTS).unwrap_or(1);
        while start.elapsed() < Duration::from_secs(u64::from(SECONDS)) {
            std::thread::sleep(next.saturating_duration_since(Instant::now()));
            next += PERIOD;
            let asked = Instant::now();
            stream.write_all(b"4:data").expect("to send");
            let mut got = stream.read(&mut buffer).expect("an answer");
            let head = buffer
                .iter()
                .position(|byte| *byte == b':')
                .expect("a colon");
            let size: usize = std::str::from_utf8(&buffer[..head])
                .expect("a count")
                .parse()
                .expect("a count");
            while got < head + 1 + size {
                got += stream.read(&mut buffer[got..]).expect("the rest");
            }
            times.push(asked.elapsed());
        }
        times
    };
    let mut times: Vec<Duration> = std::thread::scope(|scope| {
        let all: Vec<_> = (0..u32::try_from(CLIENTS).unwrap_or(1))
            .map(|index| scope.spawn(move || work(index)))
            .collect();
        all.into_iter()
            .flat_map(|one| one.join().expect("a client"))
            .collect()
    });
    let share = 100.0 * (robot.used() - used) / start.elapsed().as_secs_f64();
    println!(
        "{CLIENTS} clients at 50 Hz: {} answers, {share:.1} % of a processor, median {:?}, p99 {:?}",
        times.len(),
        percentile(&mut times, 500),
        percentile(&mut times, 990)
    );
}

fn stops(robot: &Robot) {
    let mut stream = robot.client("control");
    let mut reader = BufReader::new(stream.try_clone().expect("a clone"));
    let frame = |text: &str| encode(text.as_bytes());
    let mut until = |part: &str| {
        let mut text = Vec::new();
        let mut byte = [0];
        while !text.ends_with(part.as_bytes()) {
            reader.read_exact(&mut byte).expect("a byte");
            text.push(byte[0]);
        }
    };
    stream
        .write_all(&frame("file:x:#!/bin/sh\necho go\nwhile :; do :; done\n"))
        .expect("to send");
    let stop = robot.scratch.path().join("tree/stop");
    let (mut rests, mut ends, mut echoes, mut starts) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for _ in 0..STOPS {
        let asked = Instant::now();
        stream.write_all(&frame("version")).expect("to send");
        until("version: 3.1.4");
        echoes.push(asked.elapsed());
        let asked = Instant::now();
        stream.write_all(&frame("run:x")).expect("to send");
        until("print: go\n");
        starts.push(asked.elapsed());
        fs::write(&stop, "").expect("a file");
        let asked = Instant::now();
        stream.write_all(&frame("stop")).expect("to send");
        while fs::metadata(&stop).expect("a file").len() == 0 {
            std::hint::spin_loop();
        }
        rests.push(asked.elapsed());
        until("was stopped by a client after ");
        ends.push(asked.elapsed());
        stream.write_all(&frame("keepalive")).expect("to send");
    }
    for (what, times) in [
        ("version to answer", &mut echoes),
        ("run to first line of sh", &mut starts),
        ("stop to rest", &mut rests),
        ("stop to the end of all", &mut ends),
    ] {
        println!(
            "{what}: median {:?}, p99 {:?}",
            percentile(times, 500),
            percentile(times, 990)
        );
    }
}

fn main() {
    // Cargo asks so when it only checks that this runs.
    if std::env::args().any(|word| word == "--test") {
        return;
    }
    frames();
    let robot = Robot::start();
    std::thread::sleep(Duration::from_millis(1500));
    let guardian = PathBuf::from(format!("/proc/{}", robot.process.id()));
    println!(
        "resident, idle: {} KiB, and {} KiB its guardian",
        robot.resident_kib(&robot.daemon()),
        robot.resident_kib(&guardian)
    );
    polls(&robot);
    stops(&robot);
    println!(
        "resident, after that: {} KiB",
        robot.resident_kib(&robot.daemon())
    );
}
