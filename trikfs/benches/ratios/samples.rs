//! The sample bus: what publishing costs the sampler, what the newest value costs a subscriber, and how soon one that
//! is awake has a new sample, against the same through files.

use super::events::{latency, now_ns};
use super::measure::{Plan, Spread, median, row, spread, table};
use super::newest::{config, open_when_sampled};
use super::peers::{Mount, Place, on_all_cores, resident_kib};
use sample_bus::{Reader, Rights, Step, Writer};
use std::fs::OpenOptions;
use std::hint::black_box;
use std::io::Write;
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::time::Instant;

/// Calls between two looks at the clock, which costs as much as what is measured.
const BATCH: u32 = 100;

/// Largest cost of the newest value.
const NEWEST_GOAL_NS: f64 = 100.0;

/// Nanoseconds of one call.
fn batches(count: usize, mut call: impl FnMut()) -> Spread {
    let mut batch = || {
        let start = Instant::now();
        for _ in 0..BATCH {
            call();
        }
        u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX) / u64::from(BATCH)
    };
    batch();
    spread((0..count).map(|_| batch()).collect())
}

/// The subscriber's process: looks for events without a pause, tells the age of each on standard output.
pub fn read_ring(mountpoint: &Path, node: &str) {
    let mut reader = Reader::open(mountpoint, node).expect("a ring");
    let mut out = std::io::stdout().lock();
    out.write_all(&[0; 8]).expect("tell that the ring is open");
    out.flush().expect("flush");
    let mut tuple = Vec::new();
    loop {
        if !matches!(reader.next_event(&mut tuple), Step::Event(_)) {
            std::hint::spin_loop();
            continue;
        }
        let stamp: [u8; 8] = tuple.as_slice().try_into().expect("a time stamp");
        let age = now_ns() - u64::from_ne_bytes(stamp);
        let told = out.write_all(&age.to_ne_bytes()).and_then(|()| out.flush());
        if told.is_err() {
            return;
        }
    }
}

pub fn run(plan: &Plan) -> Result<(), String> {
    publish(plan)?;
    newest(plan)?;
    on_all_cores(|| awake(plan))
}

fn publish(plan: &Plan) -> Result<(), String> {
    let place = Place::new("rings")?;
    let sizes = [4, 24, 100 << 10];
    let mut rings = Vec::new();
    for size in sizes {
        let ring = Writer::create(
            &place.0.join(size.to_string()),
            size,
            Rights {
                mode: 0o400,
                group: None,
            },
        );
        rings.push(ring.map_err(|error| error.to_string())?);
    }
    let [small, middle, large] = rings.as_mut_slice() else {
        return Err("three rings".to_owned());
    };
    let tuple = vec![7; 100 << 10];
    let mut latch = vec![0; 100 << 10];
    let (few, many) = (plan.samples / 50, plan.samples);
    let copied = |latch: &mut [u8], size: usize| {
        latch[..size].copy_from_slice(black_box(&tuple[..size]));
        black_box(latch);
    };
    let write = |ring: &mut Writer, size: usize| ring.publish(1, black_box(&tuple[..size]));
    let rows = vec![
        row("clock_gettime", 0, None, || {
            batches(many, || {
                black_box(now_ns());
            })
        }),
        row("publish of 4 bytes", 0, None, || {
            batches(many, || write(small, 4))
        }),
        row("publish of 24 bytes", 0, None, || {
            batches(many, || write(middle, 24))
        }),
        row("memcpy of 100 KiB", 3, None, || {
            batches(few, || copied(&mut latch, 100 << 10))
        }),
        row("publish of 100 KiB", 3, None, || {
            batches(few, || write(large, 100 << 10))
        }),
    ];
    table(
        "cost of the sample bus for the sampler, ratio to reading the clock and to a copy",
        plan.rounds,
        rows,
    );
    drop(rings);
    Ok(())
}

fn newest(plan: &Plan) -> Result<(), String> {
    let mount = Mount::start("samples", &config(&[4, 24]))?;
    let open =
        |node| Reader::open(&mount.place.0, node).map_err(|error| format!("{node}: {error}"));
    let cached = open_when_sampled(&mount, "n4/bin_data")?;
    let (small, large) = (open("n4")?, open("n24")?);
    let mut tuple = Vec::new();
    let samples = plan.samples;
    let mut seen = Vec::new();
    let mut subscribe = |reader: &Reader, seen: &mut Vec<f64>| {
        let found = batches(samples, || {
            black_box(reader.newest(&mut tuple).expect("a sample"));
        });
        seen.push(found.p50);
        found
    };
    let subscribe = std::cell::RefCell::new(&mut subscribe);
    let mut ignored = Vec::new();
    let rows = vec![
        row("bin_data of 4 bytes, page cache", 0, None, || {
            let mut bytes = [0; 4];
            batches(samples, || {
                assert!(cached.read_at(&mut bytes, 0).expect("read") == 4)
            })
        }),
        row("newest value of 4 bytes, sample bus", 0, Some(0.5), || {
            subscribe.borrow_mut()(&small, &mut seen)
        }),
        row("newest value of 24 bytes, sample bus", 0, Some(0.5), || {
            subscribe.borrow_mut()(&large, &mut ignored)
        }),
    ];
    table(
        "the newest value at 1 kHz, ratio to the page cache",
        plan.rounds,
        rows,
    );
    let ns = median(seen);
    let met = if ns <= NEWEST_GOAL_NS {
        "met"
    } else {
        "NOT MET"
    };
    println!("newest value of 4 bytes: {ns:.0} ns   goal <= {NEWEST_GOAL_NS:.0} ns {met}");
    let with = resident_kib(mount.daemon()?);
    println!("daemon with two rings: {with} KiB");
    Ok(())
}

fn awake(plan: &Plan) -> Result<(), String> {
    let place = Place::new("ring-fifo")?;
    let path = place.0.join("source");
    nix::unistd::mkfifo(&path, nix::sys::stat::Mode::S_IRWXU).map_err(|errno| errno.to_string())?;
    let open = OpenOptions::new().read(true).write(true).open(&path);
    let source = open.map_err(|error| error.to_string())?;
    let config = format!(
        "trikfs = {{ event = {{ src = '{}', input_tuple_size = 8, on_event = true }} }}",
        path.display()
    );
    let mount = Mount::start("ring-events", &config)?;
    let device = mount.file("event/device").display().to_string();
    let mountpoint = mount.place.0.display().to_string();
    let count = plan.samples / 4;
    let measure = |words: &[&str]| latency(count, &source, words).expect("latency");
    let rows = vec![
        row("blocking read of device", 0, None, || {
            measure(&["block", &device])
        }),
        row("sample bus, subscriber awake", 0, Some(0.5), || {
            measure(&["ring", &mountpoint, "event"])
        }),
    ];
    table(
        "event to reader on any core, ratio to a blocking read",
        plan.rounds,
        rows,
    );
    let _ = std::fs::remove_file(path);
    Ok(())
}
