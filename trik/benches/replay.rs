//! How fast a recording is replayed when nobody waits for the clock: the whole of `trik replay`, with the tree that it mounts.
//!
//! `cargo bench -p trik --bench replay` on a machine with FUSE; `REPLAY_SECONDS` is how long the recording lasts (600). A
//! recording of a moment is replayed too: what both take longer than that is start and end.

use journal::node::Node;
use journal::write::Writer;
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeValLike;
use std::fs::{self, File};
use std::io::BufWriter;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

const TRIK: &str = env!("CARGO_BIN_EXE_trik");
/// As the virtual robot: of its nodes these many change all the time, with 1000 samples a second together.
const NODES: u64 = 55;
const BUSY: u64 = 20;
const PERIOD_NS: u64 = 20_000_000;
const ZERO: u64 = 1_700_000_000_000_000_000;
const ROUNDS: usize = 3;

/// A recording that lasts so long; how many samples it has.
fn record(path: &Path, length_ns: u64) -> u64 {
    let file = BufWriter::new(File::create_new(path).expect("a new file"));
    let mut out = Writer::new(file, "bench").expect("begun");
    let ids: Vec<_> = (0..NODES)
        .map(|at| {
            let node = Node::sensor(&format!("sensors/n{at}"), "i32 x, i32 y, i32 z");
            out.add(&node).expect("a node")
        })
        .collect();
    let mut samples = 0;
    for turn in 0..=length_ns / PERIOD_NS {
        let nodes = if turn == 0 { NODES } else { BUSY };
        for (at, id) in (0..nodes).zip(&ids) {
            let numbers = [turn % 7, turn % 1000, at];
            let tuple = numbers.map(|number| i32::try_from(number).unwrap_or(0).to_le_bytes());
            let unix_ns = ZERO + turn * PERIOD_NS + at;
            (out.sample(*id, unix_ns, &tuple.concat())).expect("written");
            samples += 1;
        }
    }
    out.finish().expect("finished");
    samples
}

/// Seconds of the clock and of the processor, those of the tree too, that a replay takes.
fn replay(folder: &Path, file: &Path) -> (f64, f64) {
    let cpu_s = || {
        let usage = getrusage(UsageWho::RUSAGE_CHILDREN).expect("Linux");
        let us = usage.user_time().num_microseconds() + usage.system_time().num_microseconds();
        us as f64 / 1e6
    };
    let (begin, before_s) = (Instant::now(), cpu_s());
    let output = Command::new(TRIK)
        .args([
            "replay",
            "--speed",
            "1000",
            "--exit",
            "--no-view",
            "--no-trikd",
        ])
        .arg(file)
        .env("XDG_RUNTIME_DIR", folder)
        .stdin(Stdio::null())
        .output()
        .expect("trik");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    (begin.elapsed().as_secs_f64(), cpu_s() - before_s)
}

fn main() {
    if !Path::new("/dev/fuse").exists() {
        println!("there is no /dev/fuse: nothing is measured");
        return;
    }
    let seconds = std::env::var("REPLAY_SECONDS");
    let length_s: u64 = seconds.map_or(600, |text| text.parse().expect("a number"));
    let folder = tempfile::tempdir().expect("a folder");
    // As a folder of a user is.
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o700)).expect("ours");
    let [long, short] = ["long.mcap", "short.mcap"].map(|name| folder.path().join(name));
    let samples = record(&long, length_s * 1_000_000_000);
    record(&short, PERIOD_NS);
    let mut ratios = Vec::new();
    println!("{samples} samples of {NODES} nodes in {length_s} s, replayed with --speed 1000");
    for _ in 0..ROUNDS {
        let (all_s, all_cpu_s) = replay(folder.path(), &long);
        let (start_s, start_cpu_s) = replay(folder.path(), &short);
        let (took_s, cpu_s) = (all_s - start_s, all_cpu_s - start_cpu_s);
        println!(
            "  {took_s:.2} s beside {start_s:.2} s of start and end; processor {cpu_s:.2} s, {:.1} us a sample",
            cpu_s / samples as f64 * 1e6
        );
        ratios.push(length_s as f64 / took_s);
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ROUNDS / 2];
    println!(
        "real time {median:>25.0} times {:>12.2} of 100 times",
        median / 100.0
    );
}
