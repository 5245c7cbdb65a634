//! The sample bus: what publishing costs the sampler, what the newest value costs a subscriber, and how soon one that
//! is awake has a new sample, against the same through files.

use super::events::{latency, now_ns};
use super::measure::{Plan, Spread, median, row, spread, table};
use super::newest::{config, open_when_sampled};
use super::peers::{Mount, Place, pin_to_other_core, resident_kib};
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags, EpollTimeout};
use sample_bus::{Reader, Rights, Writer};
use std::fs::{File, OpenOptions};
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

/// The subscriber's process: gets each sample in its own way, tells on standard output how long ago it was published.
pub fn subscribe(way: &str, mountpoint: &Path, node: &str) {
    // One that never sleeps would keep the daemon waiting on the same core.
    pin_to_other_core();
    let ring = Reader::open(mountpoint, node).expect("a ring");
    let file = File::open(mountpoint.join(node).join("bin_data")).expect("open");
    let epoll = Epoll::new(EpollCreateFlags::empty()).expect("epoll");
    if way == "poll" {
        let event = EpollEvent::new(EpollFlags::EPOLLIN, 0);
        epoll.add(&file, event).expect("epoll");
    }
    let mut out = std::io::stdout().lock();
    let (mut tuple, mut last, mut published) = ([0; 8], [0; 8], Vec::new());
    file.read_exact_at(&mut last, 0).expect("a first sample");
    let mut sequence = ring.newest_sequence();
    let mut tell = |age: u64| out.write_all(&age.to_ne_bytes()).and_then(|()| out.flush());
    tell(0).expect("tell that all is open");
    loop {
        if way == "ring" {
            while ring.newest_sequence() == sequence {
                std::hint::spin_loop();
            }
        } else {
            if way == "poll" {
                while epoll
                    .wait(&mut [EpollEvent::empty()], EpollTimeout::NONE)
                    .unwrap_or(0)
                    == 0
                {}
            }
            if file.read_exact_at(&mut tuple, 0).is_err() {
                return;
            }
            if tuple == last {
                continue;
            }
            last = tuple;
        }
        let Some(event) = ring.newest_event(&mut published) else {
            continue;
        };
        let now = now_ns();
        sequence = event.sequence;
        if tell(now - event.time_ns).is_err() {
            return;
        }
    }
}

pub fn run(plan: &Plan) -> Result<(), String> {
    publish(plan)?;
    newest(plan)?;
    awake(plan)
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
    (&source)
        .write_all(&[1; 8])
        .map_err(|error| error.to_string())?;
    open_when_sampled(&mount, "event/bin_data")?;
    let mountpoint = mount.place.0.display().to_string();
    let count = plan.samples / 4;
    let measure = |way| latency(count, &source, &[way, &mountpoint, "event"]).expect("latency");
    let rows = vec![
        row(
            "bin_data of 8 bytes, pread again and again",
            0,
            None,
            || measure("file"),
        ),
        row("bin_data of 8 bytes, epoll_wait and pread", 0, None, || {
            measure("poll")
        }),
        row(
            "sample bus, newest value again and again",
            0,
            Some(0.5),
            || measure("ring"),
        ),
    ];
    table(
        "from publishing to a subscriber on another core, ratio to one that is awake as well",
        plan.rounds,
        rows,
    );
    let _ = std::fs::remove_file(path);
    Ok(())
}
