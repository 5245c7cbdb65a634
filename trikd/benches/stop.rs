//! How long motors turn after a stop was sent: a virtual board, its tree and the daemon, and programs that do different
//! things at that moment. Prints, and judges nothing.
//!
//! The board is `trik up` of the same build, which must be there: `cargo build --profile bench -p trik`. At rest is when the
//! register of the coprocessor is zero, as the tree reads it.

use frame::encode;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::tempdir;

const STOPS: usize = 40;
const START: &str = "brick.motor(M3).setPower(60)\nbrick.motor(M4).setPower(60)\n";

/// A process that is asked to end, and waited for.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        let pid = nix::unistd::Pid::from_raw(i32::try_from(self.0.id()).unwrap_or(0));
        let _ = nix::sys::signal::kill(pid, nix::sys::signal::Signal::SIGTERM);
        let _ = self.0.wait();
    }
}

/// Starts it and returns the first line with this in it.
fn start(command: &mut Command, sign: &str) -> (Ends, String) {
    let mut child = command.stdout(Stdio::piped()).spawn().expect("a process");
    let mut lines = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    let line = lines
        .by_ref()
        .map_while(Result::ok)
        .find(|line| line.contains(sign));
    std::thread::spawn(move || for _ in lines {});
    (Ends(child), line.expect("a ready line"))
}

fn board(folder: &Path) -> Option<Ends> {
    let trik = Path::new(env!("CARGO_BIN_EXE_trikd")).with_file_name("trik");
    if !trik.exists() || !Path::new("/dev/fuse").exists() {
        println!("skipped: no virtual board: `cargo build --profile bench -p trik`, and /dev/fuse");
        return None;
    }
    let mut command = Command::new(trik);
    command
        .args(["up", "--no-view", "--cache"])
        .arg(folder.join("cache"));
    command
        .arg(folder.join("tree"))
        .env("XDG_RUNTIME_DIR", folder)
        .stdin(Stdio::null());
    Some(start(&mut command, "Ctrl-C ends it.").0)
}

fn daemon(folder: &Path) -> (Ends, u16) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trikd"));
    command.args([
        "serve",
        "--address",
        "127.0.0.1",
        "--without",
        "discovery",
        "--log",
        "error",
    ]);
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
        command.args([&format!("--{port}-port"), "0"]);
    }
    let (ends, ready) = start(&mut command, "trikd: ready");
    let words: Vec<&str> = ready.split([' ', ',']).collect();
    let index = words.iter().position(|word| *word == "control");
    let port = index.and_then(|index| words[index + 1].parse().ok());
    (ends, port.expect("a port"))
}

struct Client {
    stream: TcpStream,
    reader: BufReader<TcpStream>,
}

impl Client {
    fn send(&mut self, text: &str) {
        self.stream
            .write_all(&encode(text.as_bytes()))
            .expect("to send");
    }

    fn until(&mut self, part: &str) {
        let (mut text, mut byte) = (Vec::new(), [0]);
        while !text.ends_with(part.as_bytes()) {
            self.reader.read_exact(&mut byte).expect("a byte");
            text.push(byte[0]);
        }
    }
}

fn turns(raw: &Path) -> bool {
    fs::read_to_string(raw).is_ok_and(|text| text.trim() != "0")
}

fn percentile(times: &mut [Duration], part: usize) -> Duration {
    times.sort();
    times[(times.len() - 1) * part / 1000]
}

fn measure(client: &mut Client, raw: &[PathBuf], name: &str) {
    let (mut rests, mut ends) = (Vec::new(), Vec::new());
    for _ in 0..STOPS {
        client.send(&format!("run:{name}"));
        client.until("print: go\n");
        while !raw.iter().all(|raw| turns(raw)) {
            std::thread::sleep(Duration::from_millis(1));
        }
        let asked = Instant::now();
        client.send("stop");
        while raw.iter().any(|raw| turns(raw)) {
            std::thread::sleep(Duration::from_micros(200));
        }
        rests.push(asked.elapsed());
        client.until(" was stopped by a client after ");
        ends.push(asked.elapsed());
    }
    println!(
        "{name}: at rest after median {:?}, p99 {:?}, most {:?}; all over after median {:?}, p99 {:?}",
        percentile(&mut rests, 500),
        percentile(&mut rests, 990),
        percentile(&mut rests, 1000),
        percentile(&mut ends, 500),
        percentile(&mut ends, 990)
    );
}

fn main() {
    // Cargo asks so when it only checks that this runs.
    if std::env::args().any(|word| word == "--test") {
        return;
    }
    let scratch = tempdir().unwrap();
    let Some(_board) = board(scratch.path()) else {
        return;
    };
    let (_daemon, port) = daemon(scratch.path());
    let stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
    stream.set_nodelay(true).expect("an option");
    let reader = BufReader::new(stream.try_clone().expect("a clone"));
    let mut client = Client { stream, reader };
    let tree = scratch.path().join("tree");
    let raw = ["M3", "M4"].map(|motor| tree.join(format!("motors/{motor}/raw")));
    let log = tree.join("log");
    for (name, text) in [
        ("wait.py", format!("{START}print('go')\nscript.wait(60000)")),
        ("loop.py", format!("{START}print('go')\nwhile True: pass")),
        ("drive.py", format!("{START}print('go')\nwhile True: brick.motor(M3).setPower(60)")),
        ("read.py", format!("{START}print('go')\nopen('{}').read()", log.display())),
        ("loop.js", format!("{START}print('go')\nwhile (true) {{}}")),
        ("child", "#!/bin/sh\nfor m in M3 M4; do echo 60 > $TRIK_TREE/motors/$m/value; done\n(setsid sh -c 'while :; do echo 60 > $TRIK_TREE/motors/M3/value; done' &)\necho go\nsleep 1000\n".to_owned()),
    ] {
        client.send(&format!("file:{name}:{text}"));
        measure(&mut client, &raw, name);
    }
}
