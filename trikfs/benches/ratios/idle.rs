//! What the daemon does while nobody reads: wake-ups of each of its threads, and processor time.
//!
//! The configuration is like a robot's: registers of a bus at 50 Hz, an event source of 100 Hz whose events pass two nodes
//! with converters in Lua, a node that takes their newest sample at 100 Hz, and many nodes that nobody wants. An idle mount
//! without any of these stands beside it: it must not wake up at all.

use super::bus_peer::BusPeer;
use super::measure::{Plan, verdict};
use super::peers::{Mount, Place};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const REGISTERS: usize = 11;
const UNWANTED: usize = 40;
const EVENT_PERIOD: Duration = Duration::from_millis(10);
/// Wake-ups per second of the watchdog, which does no work of its own.
const WATCHDOG: f64 = 120.0;
/// Wake-ups per second of a mount with nothing to do.
const NOTHING: f64 = 1.0;

pub fn run(plan: &Plan) -> Result<(), String> {
    let duration = Duration::from_secs(if plan.rounds > 3 { 10 } else { 3 });
    let unwanted = Mount::start("idle-nothing", &format!("trikfs = {{\n{}}}\n", unwanted()))?;
    println!("\nwake-ups per second of the idle daemon");
    let nothing = tell("nodes that nobody reads", unwanted.daemon()?, duration)?;
    let sum: f64 = nothing.values().sum();
    println!("goal: <= {NOTHING} {}", verdict(sum <= NOTHING));
    drop(unwanted);

    let bus = BusPeer::start("idle", 0)?;
    let place = Place::new("idle-events")?;
    let fifo = place.0.join("events");
    nix::unistd::mkfifo(&fifo, nix::sys::stat::Mode::S_IRWXU).map_err(|error| error.to_string())?;
    let mount = Mount::start("idle", &robot(&bus.path, &fifo))?;
    let over = AtomicBool::new(false);
    let told = std::thread::scope(|scope| {
        scope.spawn(|| feed(&fifo, &over));
        let told = mount
            .daemon()
            .and_then(|daemon| tell("a robot", daemon, duration));
        over.store(true, Ordering::Relaxed);
        told
    });
    let _ = std::fs::remove_file(&fifo);
    let watchdog = told?.get("watchdog").copied().unwrap_or(0.0);
    println!(
        "goal: watchdog <= {WATCHDOG} {}",
        verdict(watchdog <= WATCHDOG)
    );
    Ok(())
}

fn unwanted() -> String {
    let mut text = String::new();
    for n in 0..UNWANTED {
        let _ = writeln!(
            text,
            "u{n} = {{ src = '/dev/zero', input_tuple_size = 4, converter = id_create(4) }},"
        );
    }
    text
}

fn robot(bus: &Path, fifo: &Path) -> String {
    let (bus, fifo) = (bus.display(), fifo.display());
    let mut text =
        "local function same(n, a, m, b) ba.i32(b, 0, ba.i32(a, 0)) end\ntrikfs = {\n".to_owned();
    for n in 0..REGISTERS {
        let _ = writeln!(
            text,
            "r{n} = {{ src = i2c{{ '{bus}', address = 0x48, register = {n}, transfer = 'word' }}, format = 'u16 raw', poll_ms = 20 }},"
        );
    }
    let _ = writeln!(
        text,
        "rate = {{ src = fifo{{ '{fifo}' }}, input_tuple_size = 4, format = 'i32 rate', on_event = true, converter = same }},
         angle = {{ src = 'trikfs:rate', format = 'i32 angle', on_event = true, converter = same }},
         heading = {{ src = {{ 'newest:angle' }}, format = 'i32 heading', poll_ms = 10, converter = same }},"
    );
    text + &unwanted() + "}\n"
}

/// Writes an event each period until it is over.
fn feed(fifo: &Path, over: &AtomicBool) {
    let Ok(mut pipe) = OpenOptions::new().read(true).write(true).open(fifo) else {
        return;
    };
    let mut next = Instant::now();
    while !over.load(Ordering::Relaxed) {
        let _ = pipe.write_all(&[1, 0, 0, 0]);
        next += EVENT_PERIOD;
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
}

/// Measures after a moment of rest and prints; the wake-ups per second by the names of threads.
fn tell(what: &str, daemon: u32, duration: Duration) -> Result<BTreeMap<String, f64>, String> {
    std::thread::sleep(Duration::from_secs(1));
    let (begin, before) = (Instant::now(), threads(daemon)?);
    std::thread::sleep(duration);
    let (seconds, after) = (begin.elapsed().as_secs_f64(), threads(daemon)?);
    let mut rates = BTreeMap::new();
    let mut processor_ns = 0;
    for (thread, now) in &after {
        let then = before.get(thread).cloned().unwrap_or_default();
        let woken = now.switches.saturating_sub(then.switches) as f64 / seconds;
        *rates.entry(now.name.clone()).or_insert(0.0) += woken;
        processor_ns += now.processor_ns.saturating_sub(then.processor_ns);
    }
    let percent = processor_ns as f64 / seconds / 1e7;
    let sum: f64 = rates.values().sum();
    println!("{what:<28} {sum:>8.1}   {percent:.2} % of one core");
    for (name, rate) in rates.iter().filter(|(_, rate)| **rate >= 0.5) {
        println!("  {name:<26} {rate:>8.1}");
    }
    Ok(rates)
}

#[derive(Clone, Default)]
struct Thread {
    name: String,
    /// How often it went to sleep by itself, and so was woken.
    switches: u64,
    processor_ns: u64,
}

fn threads(process: u32) -> Result<BTreeMap<String, Thread>, String> {
    let failed = |error: std::io::Error| format!("process {process}: {error}");
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(format!("/proc/{process}/task")).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        // A thread may end meanwhile.
        let text = |file| std::fs::read_to_string(entry.path().join(file)).unwrap_or_default();
        let status = text("status");
        let field = |name: &str| {
            let line = status.lines().find_map(|line| line.strip_prefix(name));
            line.map(|value| value.trim().to_owned())
                .unwrap_or_default()
        };
        let schedstat = text("schedstat");
        let processor_ns = schedstat.split(' ').next().and_then(|ns| ns.parse().ok());
        let thread = Thread {
            name: field("Name:"),
            switches: field("voluntary_ctxt_switches:").parse().unwrap_or(0),
            processor_ns: processor_ns.unwrap_or(0),
        };
        all.insert(entry.file_name().to_string_lossy().into_owned(), thread);
    }
    Ok(all)
}
