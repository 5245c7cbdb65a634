//! What the bench runs on: a tree with known values and a trikd above it.
//!
//! Owns the processes, their places and the configurations. Knows no load.

use harness::{Board, Mount, Setting, processes};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;

/// What the motor's device has at rest.
pub const REST: [u8; 2] = [0, 7];
/// What it has when it is driven.
pub const DRIVEN: [u8; 2] = [100, 1];
/// The same as a program writes it.
pub const DRIVE: &str = "100 1\n";

/// Files with values that never change, and what they say.
pub const KNOWN: [(&str, &[u8]); 5] = [
    ("paced/bin_data", &[5]),
    ("paced/value", b"5\n"),
    ("lua/value", b"6\n"),
    ("library/value", b"7\n"),
    ("lua/device", &[6]),
];

/// A configuration; `extra` is the name of a node that comes and goes.
pub fn config(extra: &str) -> String {
    format!(
        "trikfs = {{
  motor = {{ src = '$DIR/motor', input_tuple_size = 2, format = 'i8 speed, u8 mode', rest = {{ 0, 7 }} }},
  paced = {{ src = '$DIR/in', input_tuple_size = 1, poll_ms = 10 }},
  lua = {{ src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1,
          converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) + 1) end }},
  library = {{ src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = 'plus.so' }},
  apart = {{ src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, isolate = true, converter = 'crash.so' }},
  stream = {{ src = fake{{ data = 'abcd', period_ms = 5, loop = true }}, input_tuple_size = 1 }},
  {extra} = {{ src = '/dev/zero', input_tuple_size = 1 }},
}}"
    )
}

/// What `apart` gives when its converter does not crash.
pub const APART: [u8; 1] = [8];
/// Crashes again and again, in its own process, and not so often that most reads are in the pauses after that.
const CRASH: &str = "int converter(int in_s, char *in, int out_s, char *out) { static int n; if (++n % 1000 == 0) __builtin_trap(); out[0] = in[0] + 3; return 0; }";
const PLUS_TWO: &str = "int converter(int in_s, char *in, int out_s, char *out) { out[0] = in[0] + 2; return in_s != out_s; }";

/// A mounted tree and its daemon of clients.
pub struct Robot {
    /// The tree.
    pub mount: Mount,
    trikd: Mutex<Child>,
    /// Port of programs.
    pub control: u16,
    /// Port of sensor values.
    pub telemetry: u16,
}

/// A program of the same build.
fn beside(name: &str) -> PathBuf {
    let me = std::env::current_exe().unwrap_or_default();
    me.with_file_name(name)
}

/// Ports of trikd; the first two are used here.
const PORTS: [&str; 6] = [
    "control",
    "telemetry",
    "mailbox",
    "gamepad",
    "video",
    "variables",
];

/// Ports that are free at the moment.
fn free_ports(count: usize) -> std::io::Result<Vec<u16>> {
    let held: Vec<TcpListener> = (0..count)
        .map(|_| TcpListener::bind(("127.0.0.1", 0)))
        .collect::<std::io::Result<_>>()?;
    held.iter()
        .map(|listener| Ok(listener.local_addr()?.port()))
        .collect()
}

impl Robot {
    /// Starts both. None, with the reason on standard error, where they cannot be.
    pub fn start() -> Option<Self> {
        let (trikfs, trikd) = (beside("trikfs"), beside("trikd"));
        for program in [&trikfs, &trikd] {
            if !program.exists() {
                let shown = program.display();
                eprintln!(
                    "soak: there is no {shown}: build all programs with cargo build --workspace"
                );
                return None;
            }
        }
        let board = Board::new();
        board.file("motor", REST);
        board.file("in", [5]);
        board.library("plus.so", PLUS_TWO);
        board.library("crash.so", CRASH);
        let mount = Mount::new(Setting {
            program: trikfs.to_str()?,
            board,
            config: &config("extra"),
            options: &[],
            launcher: &[],
        })?;
        let home = mount.board().path("trikd");
        let mut command = Command::new(trikd);
        command.arg("serve").arg("--tree").arg(mount.root());
        for option in ["--scripts", "--state", "--run"] {
            command.arg(option).arg(home.join(&option[2..]));
        }
        command
            .arg("--gamepad-fifo")
            .arg(home.join("gamepad.fifo"))
            .args(["--address", "127.0.0.1", "--without", "discovery"]);
        // Not 0: a daemon that takes the place of a dead one shall serve where that one did.
        let ports = free_ports(PORTS.len()).inspect_err(|error| eprintln!("soak: ports: {error}"));
        let ports = ports.ok()?;
        for (name, port) in PORTS.iter().zip(&ports) {
            command.args([format!("--{name}-port"), port.to_string()]);
        }
        let mut trikd = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(File::create(mount.board().path("trikd.log")).ok()?)
            .spawn()
            .inspect_err(|error| eprintln!("soak: {command:?}: {error}"))
            .ok()?;
        let mut line = String::new();
        let read = trikd
            .stdout
            .take()
            .map(|out| BufReader::new(out).read_line(&mut line));
        if read.is_none_or(|read| read.is_err()) || !line.contains("ready") {
            eprintln!("soak: trikd is not ready: {line}");
            let _ = trikd.kill();
            return None;
        }
        Some(Self {
            mount,
            trikd: Mutex::new(trikd),
            control: ports[0],
            telemetry: ports[1],
        })
    }

    /// The last lines that both have said, for the reader of a finding.
    pub fn words(&self) -> String {
        let trikd = self.mount.board().content("trikd.log");
        let trikd = String::from_utf8_lossy(&trikd).into_owned();
        let last = |text: &str| {
            let lines: Vec<&str> = text.lines().collect();
            let from = lines.len().saturating_sub(12);
            lines[from..].join("\n")
        };
        format!("{}\n{}", last(&self.mount.complaints()), last(&trikd))
    }

    /// The guardian of trikd.
    pub fn trikd_guardian(&self) -> u32 {
        self.trikd
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
            .id()
    }

    /// The serving process of trikd, while there is one.
    pub fn trikd(&self) -> Option<u32> {
        processes::children(self.trikd_guardian()).first().copied()
    }

    /// The serving process of the tree, while there is one.
    pub fn daemon(&self) -> Option<u32> {
        processes::children(self.mount.guardian()).first().copied()
    }

    /// What the motor's device has.
    pub fn motor(&self) -> Vec<u8> {
        self.mount.board().content("motor")
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        processes::signal(self.trikd_guardian(), nix::sys::signal::Signal::SIGTERM);
        if let Ok(trikd) = self.trikd.get_mut() {
            let _ = trikd.wait();
        }
    }
}
