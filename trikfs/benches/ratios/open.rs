//! Opening and the first read, and what open files cost in memory.

use super::measure::{Plan, Spread, row, spread, table, verdict};
use super::peers::{Mount, NullMount, resident_kib};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::{Duration, Instant};

const CONFIG: &str = r"
trikfs = {
  plain = { src = '/dev/zero', input_tuple_size = 4 },
  lua = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4,
          converter = function(a_s, a, b_s, b)
            for i = 0, a_s - 1 do ba.set(b, i, ba.get(a, i) % 10 + i + 33) end
          end },
}";

const HANDLES: u64 = 1000;

/// Opens and reads `count` times, after a pause each time: states are prepared ahead while nobody asks.
fn open_and_read(path: &Path, count: usize, pause: Duration) -> Spread {
    let mut samples = Vec::with_capacity(count);
    for _ in 0..count {
        if !pause.is_zero() {
            std::thread::sleep(pause);
        }
        let start = Instant::now();
        let mut file = File::open(path).expect("open");
        file.read_exact(&mut [0; 4]).expect("read");
        samples.push(u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX));
    }
    spread(samples)
}

pub fn run(plan: &Plan) -> Result<(), String> {
    let null = NullMount::start()?;
    let mount = Mount::start("open", CONFIG)?;
    let null_path = null.place.0.join("device");
    let (plain, lua) = (mount.file("plain/device"), mount.file("lua/device"));
    let count = plan.samples / 4;
    let idle_kib = resident_kib(mount.daemon()?);
    let (now, later) = (Duration::ZERO, Duration::from_millis(1));
    let rows = vec![
        row("null filesystem, one open per ms", 0, None, || {
            open_and_read(&null_path, count, later)
        }),
        row("no converter, one open per ms", 0, None, || {
            open_and_read(&plain, count, later)
        }),
        row(
            "Lua, a state of its own, one open per ms",
            0,
            Some(3.0),
            || open_and_read(&lua, count, later),
        ),
        row("null filesystem, back to back", 3, None, || {
            open_and_read(&null_path, count, now)
        }),
        row("no converter, back to back", 3, None, || {
            open_and_read(&plain, count, now)
        }),
        row(
            "Lua, a state of its own, back to back",
            3,
            Some(3.0),
            || open_and_read(&lua, count, now),
        ),
    ];
    table(
        "open(2) and the first read(2), ratio to the null filesystem",
        plan.rounds,
        rows,
    );

    let daemon = mount.daemon()?;
    let before_kib = resident_kib(daemon);
    let mut files = Vec::new();
    for _ in 0..HANDLES {
        files.push(mount.open("lua/device")?);
    }
    for file in &mut files {
        for _ in 0..1000 {
            file.read_exact(&mut [0; 4])
                .map_err(|error| error.to_string())?;
        }
    }
    let each_kib = (resident_kib(daemon) - before_kib) as f64 / HANDLES as f64;
    println!("\nmemory of the daemon");
    println!(
        "idle, after the mount {idle_kib:>26} KiB         goal <= 6144 KiB {}",
        verdict(idle_kib <= 6144)
    );
    println!(
        "per open Lua file, {HANDLES} open, 1000 reads each {each_kib:>7.1} KiB   goal <= 60 KiB {}",
        verdict(each_kib <= 60.0)
    );
    Ok(())
}
