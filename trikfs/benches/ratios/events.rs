//! From an event at the source to the reader that waited for it, against a relay process between two pipes.
//!
//! Sender, relay or daemon, and reader are processes of their own, as they are on a robot. The event is its own time
//! stamp; the reader tells how old it was when it arrived.

use super::measure::{Plan, Spread, row, spread, table};
use super::peers::{Mount, Peer, Place};
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags, EpollTimeout};
use nix::time::{ClockId, clock_gettime};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::Path;
use std::time::Duration;

/// Nanoseconds of a clock that all processes share.
pub fn now_ns() -> u64 {
    let now = clock_gettime(ClockId::CLOCK_MONOTONIC).expect("the monotonic clock");
    u64::try_from(Duration::from(now).as_nanos()).expect("less than 500 years")
}

/// The reader's process: waits for events in `file`, tells the age of each on standard output.
pub fn read_events(file: &Path, polls: bool) {
    let mut file = File::open(file).expect("open");
    let mut out = std::io::stdout().lock();
    let epoll = polls.then(|| {
        let epoll = Epoll::new(EpollCreateFlags::empty()).expect("epoll");
        let event = EpollEvent::new(EpollFlags::EPOLLIN, 0);
        epoll.add(&file, event).expect("epoll");
        epoll
    });
    out.write_all(&[0; 8]).expect("tell that the file is open");
    out.flush().expect("flush");
    loop {
        if let Some(epoll) = &epoll {
            let mut events = [EpollEvent::empty()];
            while epoll.wait(&mut events, EpollTimeout::NONE).unwrap_or(0) == 0 {}
        }
        let mut stamp = [0; 8];
        if file.read_exact(&mut stamp).is_err() {
            return;
        }
        let age = now_ns() - u64::from_ne_bytes(stamp);
        if out
            .write_all(&age.to_ne_bytes())
            .and_then(|()| out.flush())
            .is_err()
        {
            return;
        }
    }
}

/// Sends events into `source` and collects their ages from a reader, whose mode and place the words say.
pub fn latency(count: usize, source: &File, reader: &[&str]) -> Result<Spread, String> {
    let mut reader = Peer::start("reader", reader)?;
    let mut answer = [0; 8];
    let mut samples = Vec::with_capacity(count);
    let warm_up = 50;
    reader
        .from
        .read_exact(&mut answer)
        .map_err(|error| format!("reader: {error}"))?;
    for index in 0..count + warm_up {
        // Long enough for everybody to be asleep in the kernel again.
        std::thread::sleep(Duration::from_micros(200));
        let mut source = source;
        source
            .write_all(&now_ns().to_ne_bytes())
            .map_err(|error| format!("source: {error}"))?;
        reader
            .from
            .read_exact(&mut answer)
            .map_err(|error| format!("reader: {error}"))?;
        if index >= warm_up {
            samples.push(u64::from_ne_bytes(answer));
        }
    }
    Ok(spread(samples))
}

/// Copies one FIFO to another, as a process between two pipes.
pub fn relay(from: &Path, to: &Path) {
    let mut from = OpenOptions::new()
        .read(true)
        .write(true)
        .open(from)
        .expect("open");
    let mut to = OpenOptions::new()
        .read(true)
        .write(true)
        .open(to)
        .expect("open");
    let mut bytes = [0; 8];
    while from.read_exact(&mut bytes).is_ok() && to.write_all(&bytes).is_ok() {}
}

pub fn run(plan: &Plan) -> Result<(), String> {
    let place = Place::new("fifos")?;
    let fifo = |name: &str| -> Result<_, String> {
        let path = place.0.join(name);
        nix::unistd::mkfifo(&path, nix::sys::stat::Mode::S_IRWXU)
            .map_err(|errno| errno.to_string())?;
        let open = OpenOptions::new().read(true).write(true).open(&path);
        Ok((open.map_err(|error| error.to_string())?, path))
    };
    let (relay_in, relay_in_path) = fifo("relay-in")?;
    let (_keeps_open, relay_out_path) = fifo("relay-out")?;
    let (source, source_path) = fifo("source")?;
    let config = format!(
        "trikfs = {{ event = {{ src = '{}', input_tuple_size = 8 }} }}",
        source_path.display()
    );
    let mount = Mount::start("events", &config)?;
    let device = mount.file("event/device");
    let words = [
        relay_in_path.display().to_string(),
        relay_out_path.display().to_string(),
    ];
    let _relay = Peer::start("relay", &[&words[0], &words[1]])?;
    let count = plan.samples / 4;
    let measure = |source: &File, file: &Path, polls| {
        let mode = if polls { "epoll" } else { "block" };
        let file = file.display().to_string();
        latency(count, source, &[mode, &file]).expect("latency")
    };
    let rows = vec![
        row("relay process, blocking read", 0, None, || {
            measure(&relay_in, &relay_out_path, false)
        }),
        row("relay process, epoll_wait and read", 0, None, || {
            measure(&relay_in, &relay_out_path, true)
        }),
        row("blocking read of device", 0, Some(1.3), || {
            measure(&source, &device, false)
        }),
        row("epoll_wait and read of device", 0, Some(2.2), || {
            measure(&source, &device, true)
        }),
    ];
    table(
        "event to awake reader, ratio to a relay process with two pipes",
        plan.rounds,
        rows,
    );
    for path in [relay_in_path, relay_out_path, source_path] {
        let _ = std::fs::remove_file(path);
    }
    Ok(())
}
