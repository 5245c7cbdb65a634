//! What JavaScript costs: the start of a program, and a read of a sensor against pread(2) of the same file.
//!
//! Run by `cargo bench -p trikd --bench javascript`. With TREE=DIR the reads are of a mounted tree, else of a plain
//! directory. Each round measures both sides once, the ratio is taken inside the round, and the median is printed.

use harness::put;
use std::fs::File;
use std::hint::black_box;
use std::io::{self, Read};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::Instant;
use tempfile::tempdir;
use trikd::engine::Start;
use trikd::js::outside::{Alone, Output};
use trikd::js::session;

const ROUNDS: usize = 15;
const READS: u32 = 20_000;
const STARTS: usize = 30;

/// Keeps what is printed.
struct Kept(Arc<Mutex<String>>);

impl Output for Kept {
    fn print(&self, text: &str) -> io::Result<()> {
        self.0.lock().unwrap().push_str(text);
        Ok(())
    }
    fn error(&self, text: &str) -> io::Result<()> {
        panic!("{text}")
    }
    fn info(&self, _text: &str) -> io::Result<()> {
        Ok(())
    }
    fn events(&self) -> io::Result<()> {
        Ok(())
    }
    fn web(&self, _json: &str) -> io::Result<()> {
        Ok(())
    }
}

/// The number that a program prints.
fn printed(tree: &Path, text: &str) -> f64 {
    let kept = Arc::new(Mutex::new(String::new()));
    session::run(
        Start::Script(text.to_owned()),
        tree,
        &Alone::default(),
        Box::new(Kept(kept.clone())),
    )
    .unwrap();
    let text = kept.lock().unwrap();
    text.trim().parse().unwrap()
}

/// Nanoseconds of one call from JavaScript.
fn call_ns(tree: &Path, call: &str) -> f64 {
    let text = format!(
        "var sensor = brick.sensor(A1); function nothing() {{}}\n\
         function run(n) {{ for (var i = 0; i < n; i++) {call}; }}\n\
         run(1000); var began = Date.now(); run({READS}); print(Date.now() - began);"
    );
    printed(tree, &text) * 1e6 / f64::from(READS)
}

/// Nanoseconds of one pread(2).
fn pread_ns(file: &Path) -> f64 {
    let file = File::open(file).unwrap();
    let mut bytes = [0; 64];
    let began = Instant::now();
    for _ in 0..READS {
        black_box(file.read_at(&mut bytes, 0).unwrap());
    }
    began.elapsed().as_nanos() as f64 / f64::from(READS)
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Milliseconds from the start of the process to its first output.
fn start_ms(tree: &Path, program: &Path) -> f64 {
    let began = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_trikd"))
        .arg("js")
        .arg("--tree")
        .arg(tree)
        .arg(program)
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = child.stdout.take().unwrap();
    out.read_exact(&mut [0; 1]).unwrap();
    let took = began.elapsed();
    child.wait().unwrap();
    took.as_secs_f64() * 1e3
}

fn main() {
    let scratch = tempdir().unwrap();
    put(scratch.path(), "sensors/A1/value", "42\n");
    let mounted = std::env::var_os("TREE").map(PathBuf::from);
    let tree = mounted.as_deref().unwrap_or(scratch.path());
    let file = tree.join("sensors/A1/value");
    println!("a read of {}", file.display());
    println!("{:<44}{:>10}{:>9}", "", "ns", "ratio");
    for call in ["brick.sensor(A1).read()", "sensor.read()", "nothing()"] {
        let rounds: Vec<_> = (0..ROUNDS)
            .map(|_| {
                let bare = pread_ns(&file);
                let script = call_ns(tree, call);
                (bare, script, script / bare)
            })
            .collect();
        if call.starts_with("brick") {
            let bare = median(rounds.iter().map(|round| round.0).collect());
            println!("{:<44}{bare:>10.0}{:>8.2}x", "pread(2)", 1.0);
        }
        let script = median(rounds.iter().map(|round| round.1).collect());
        let ratio = median(rounds.iter().map(|round| round.2).collect());
        println!("{call:<44}{script:>10.0}{ratio:>8.2}x");
    }
    let program = put(scratch.path(), "first.js", "print(1)");
    let starts = (0..STARTS).map(|_| start_ms(tree, &program)).collect();
    println!(
        "from the start of the process to its first statement, median of {STARTS}: {:.2} ms (goal <= 30 ms)",
        median(starts)
    );
}
