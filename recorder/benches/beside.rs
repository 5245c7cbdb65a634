//! What a recorder costs beside a robot: processor, memory, bytes, and how long reads of others take with it and without.
//!
//! `RECORDER_TREE=DIR cargo bench -p recorder --bench beside` with the tree of a robot mounted there, such as that of
//! `trik up`. Windows with and without a recorder take turns, so that other work of the machine meets both. Memory is that of
//! a process of its own, from before the tree is looked at to the most that it ever has: in one that has recorded before,
//! what was freed would be taken again and not seen.

use recorder::entry::{Batch, events};
use recorder::file::Disk;
use recorder::limits::{LOOK_MS, WAITING_BYTES};
use recorder::watch::{Watch, Wish};
use std::fs::{self, File};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

const WINDOW: Duration = Duration::from_secs(2);
const PAIRS: usize = 10;
/// In the environment of the process that measures memory: whether it writes messages of standard types.
const MEMORY_OF: &str = "RECORDER_MEMORY_OF";
/// How long that one records: several chunks, and most of what is ever allocated.
const MEMORY_WINDOW: Duration = Duration::from_secs(10);
/// What programs read while they drive.
const READ: [&str; 3] = ["sensors/A1/value", "encoders/E3/value", "gyroscope/value"];

/// Seconds of the processor that a thread has had, by its folder in /proc.
fn cpu_s(task: &Path) -> f64 {
    let text = fs::read_to_string(task.join("schedstat")).unwrap_or_default();
    let ns = text
        .split_whitespace()
        .next()
        .and_then(|word| word.parse::<f64>().ok());
    ns.unwrap_or(0.0) / 1e9
}

/// Those of the thread that writes.
fn writer_cpu_s() -> f64 {
    let tasks = fs::read_dir("/proc/self/task").expect("Linux").flatten();
    let is_writer = |task: &PathBuf| {
        fs::read_to_string(task.join("comm")).is_ok_and(|name| name.trim() == "disk")
    };
    tasks
        .map(|task| task.path())
        .filter(is_writer)
        .map(|task| cpu_s(&task))
        .sum()
}

/// Bytes of memory that this process has for itself: rings and programs are shared.
fn memory() -> f64 {
    let text = fs::read_to_string("/proc/self/statm").expect("Linux");
    let mut pages = (text.split_whitespace().skip(1)).map(|word| word.parse().unwrap_or(0.0));
    let (all, shared): (Option<f64>, Option<f64>) = (pages.next(), pages.next());
    (all.unwrap_or(0.0) - shared.unwrap_or(0.0)) * 4096.0
}

/// What a recorder has done in its window.
#[derive(Clone, Copy, Default)]
struct Done {
    nodes: usize,
    events: u64,
    cpu_s: f64,
    bytes: f64,
    lost: u64,
}

struct Recorder {
    stop: Arc<AtomicBool>,
    thread: JoinHandle<Done>,
}

impl Recorder {
    /// Begins as `trik record` does, and is well under way when it comes back.
    fn start(root: &Path, file: PathBuf, is_standard: bool) -> Self {
        let stop = Arc::<AtomicBool>::default();
        let (ends, root) = (stop.clone(), root.to_owned());
        let wants = Box::new(|_: &str| Some(Wish::Samples));
        let watch = Watch::begin(&root, "bench", wants).expect("a tree");
        let create = if is_standard {
            Disk::create_with_standard
        } else {
            Disk::create
        };
        let disk = create(&file, "bench", WAITING_BYTES).expect("a file");
        let thread = thread::spawn(move || record(watch, disk, &ends));
        Self { stop, thread }
    }

    fn end(self) -> Done {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.join().expect("an end")
    }
}

fn record(mut watch: Watch, disk: Disk, ends: &AtomicBool) -> Done {
    disk.put(&watch.beginning().into());
    let mut done = Done::default();
    while !ends.load(Ordering::Relaxed) {
        let mut entries = Vec::new();
        watch.look(&mut entries);
        let batch: Batch = entries.into();
        match disk.put(&batch) {
            true => done.events += events(&batch),
            false => done.lost += events(&batch),
        }
        thread::sleep(Duration::from_millis(LOOK_MS.into()));
    }
    done.nodes = watch.recorded();
    done.lost += watch.missed();
    done.cpu_s = cpu_s(Path::new("/proc/thread-self")) + writer_cpu_s();
    let path = disk.path().to_owned();
    disk.finish().expect("written");
    done.bytes = fs::metadata(&path).map_or(0.0, |file| file.len() as f64);
    fs::remove_file(&path).expect("it was there");
    done
}

/// Bytes that a recorder takes at most, measured in a process that does nothing else.
fn memory_of_one(root: &Path, is_standard: bool) -> f64 {
    let program = std::env::current_exe().expect("this program");
    let output = Command::new(program)
        .env("RECORDER_TREE", root)
        .env(MEMORY_OF, is_standard.to_string())
        .output()
        .expect("this program once more");
    let text = String::from_utf8_lossy(&output.stdout);
    text.trim().parse().unwrap_or(f64::NAN)
}

/// What that process does, and prints.
fn measure_memory(root: &Path, folder: &Path, is_standard: bool) {
    let before = memory();
    let recorder = Recorder::start(root, folder.join("memory.mcap"), is_standard);
    let (begin, mut most) = (Instant::now(), 0.0_f64);
    while begin.elapsed() < MEMORY_WINDOW {
        most = most.max(memory() - before);
        thread::sleep(Duration::from_millis(1));
    }
    recorder.end();
    println!("{most}");
}

/// The median time of a read in one window, in us.
fn read_us(files: &[File]) -> f64 {
    let (begin, mut times) = (Instant::now(), Vec::new());
    let mut text = [0; 256];
    while begin.elapsed() < WINDOW {
        for file in files {
            let at = Instant::now();
            // A sensor may have nothing for a moment; that is an answer too.
            let _ = file.read_at(&mut text, 0);
            times.push(at.elapsed().as_secs_f64() * 1e6);
        }
        // As a loop of a program does: what sleeps wakes the processor up.
        thread::sleep(Duration::from_millis(1));
    }
    median(&mut times)
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn line(what: &str, measured: f64, unit: &str, limit: f64) {
    println!(
        "{what:<36} {measured:>9.2} {unit:<10} {:>6.2} of {limit} {unit}",
        measured / limit
    );
}

fn main() {
    let Some(root) = std::env::var_os("RECORDER_TREE").map(PathBuf::from) else {
        println!("RECORDER_TREE names no mounted tree: nothing is measured");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    if let Ok(is_standard) = std::env::var(MEMORY_OF) {
        return measure_memory(&root, folder.path(), is_standard == "true");
    }
    let open = |name: &&str| File::open(root.join(name)).expect("a node of the robot");
    let files: Vec<File> = READ.iter().map(open).collect();
    for is_standard in [true, false] {
        measure(&root, folder.path(), &files, is_standard);
    }
}

/// All figures of one sort of messages.
fn measure(root: &Path, folder: &Path, files: &[File], is_standard: bool) {
    let (mut alone, mut beside, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let mut done = Vec::new();
    let begin = Instant::now();
    // What every recording begins with: types, channels, configuration, the newest of each node.
    let first = Recorder::start(root, folder.join("first.mcap"), is_standard).end();
    for turn in 0..PAIRS {
        let recorder =
            |turn: usize| Recorder::start(root, folder.join(format!("{turn}.mcap")), is_standard);
        // Which comes first changes, so that a trend meets both.
        let (without, with) = if turn % 2 == 0 {
            let without = read_us(files);
            let recorder = recorder(turn);
            let with = read_us(files);
            done.push(recorder.end());
            (without, with)
        } else {
            let recorder = recorder(turn);
            let with = read_us(files);
            done.push(recorder.end());
            (read_us(files), with)
        };
        alone.push(without);
        beside.push(with);
        ratios.push(with / without);
    }
    let all_s = WINDOW.as_secs_f64() * done.len() as f64;
    let sum = |of: fn(&Done) -> f64| done.iter().map(of).sum::<f64>();
    let lost: u64 = done.iter().map(|done| done.lost).sum();
    let nodes = done.iter().map(|done| done.nodes).max().unwrap_or(0);
    let events = sum(|done| done.events as f64) / all_s;
    let what = match is_standard {
        true => "with messages of standard types",
        false => "with those of nodes alone",
    };
    let took_s = begin.elapsed().as_secs_f64();
    println!("{nodes} nodes, {events:.0} events/s, {lost} lost, {what}, {took_s:.0} s in all");
    line(
        "  processor",
        sum(|done| done.cpu_s) / all_s * 100.0,
        "%",
        2.0,
    );
    line(
        "  file",
        (sum(|done| done.bytes) - first.bytes * done.len() as f64) / all_s / 1e3,
        "KB/s",
        60.0,
    );
    let most = memory_of_one(root, is_standard);
    line("  memory at most", most / 1e6, "MB", 1.0);
    println!(
        "  a read takes {:.1} us alone, {:.1} us beside it",
        median(&mut alone),
        median(&mut beside)
    );
    line("  that is", median(&mut ratios), "times", 1.05);
}
