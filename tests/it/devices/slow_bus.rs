//! A bus that is slow or dead, with many nodes on it, beside one that is fine.

use crate::mount_on;
use harness::wait::nine_tenths;
use harness::{Board, I2cBus, Mount, eventually};
use std::io::ErrorKind;
use std::time::{Duration, Instant};

/// Twelve sampled nodes and twelve that sample at the read on one bus, two on the other.
const CONFIG: &str = "
    local function slow(register, more)
      local node = { src = i2c{ '$DIR/slow', address = 0x48, register = register, transfer = 'word' }, format = 'u16 raw' }
      for key, value in pairs(more or {}) do node[key] = value end
      return node
    end
    trikfs = {
      good = { src = i2c{ '$DIR/good', address = 0x48, register = 1, transfer = 'word' }, format = 'u16 raw' },
      steady = { src = i2c{ '$DIR/good', address = 0x48, register = 3, transfer = 'word' }, format = 'u16 raw', poll_ms = 20, always = true },
      plain = { src = '/dev/zero', input_tuple_size = 1 },
      slow = {}, late = {},
    }
    for n = 1, 12 do
      trikfs.slow['n' .. n] = slow(2 * n, { poll_ms = 20, timeout_ms = 10000, always = true })
      trikfs.late['n' .. n] = slow(2 * n)
    end";

fn mounted() -> Option<(I2cBus, I2cBus, Mount)> {
    let board = Board::new();
    let good = I2cBus::start(&board.path("good"), 0x48);
    let slow = I2cBus::start(&board.path("slow"), 0x48);
    good.set(0x48, 1, &[5, 0]);
    mount_on(board, CONFIG).map(|m| (good, slow, m))
}

/// Durations of reads of the good bus, sorted.
fn read_times(m: &Mount, count: usize) -> Vec<Duration> {
    use std::os::unix::fs::FileExt;
    let file = m.open("good/value");
    let mut times: Vec<Duration> = (0..count)
        .map(|_| {
            let begin = Instant::now();
            let mut text = [0; 8];
            // A signal may interrupt any read; it was seen on the emulated processor only.
            let size = loop {
                match file.read_at(&mut text, 0) {
                    Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                    read => break read.expect("a read of the good bus"),
                }
            };
            assert_eq!(&text[..size], b"5\n");
            begin.elapsed()
        })
        .collect();
    times.sort_unstable();
    times
}

fn p99(times: &[Duration]) -> Duration {
    times[times.len() * 99 / 100]
}

#[test]
fn a_bus_that_takes_200_ms_for_each_answer_delays_nobody_else() {
    let Some((_good, slow, m)) = mounted() else {
        return;
    };
    // Loaded machines are slower at both, and may be loaded for one alone: what delays reads does so each time.
    eventually("reads that are not delayed, and samples", || {
        slow.behaviour().delay = Duration::ZERO;
        let alone = p99(&read_times(&m, 2000));
        slow.behaviour().delay = Duration::from_millis(200);
        let before = m.stat("steady", "samples");
        let begin = Instant::now();
        let beside = p99(&read_times(&m, 2000));
        while begin.elapsed() < Duration::from_millis(1500) {
            read_times(&m, 100);
        }
        let rate = (m.stat("steady", "samples") - before) / begin.elapsed().as_secs_f64();
        println!(
            "p99 alone {alone:?}, beside the slow bus {beside:?}; the good bus is sampled at {rate} Hz"
        );
        beside < alone + Duration::from_millis(5) && rate > 25.0
    });
    // Sampling has one thread for each bus; a slow bus gets no second one, however late it is.
    let threads = harness::processes::threads_named(m.daemon(), "bus");
    assert_eq!(threads, 2, "threads that sample a bus");
    // The nodes of the slow bus have their turns one after the other.
    let sampled = (1..=12)
        .filter(|n| m.stat(&format!("slow/n{n}"), "samples") > 0.0)
        .count();
    assert!(sampled >= 5, "{sampled} of 12 nodes were ever sampled");
    slow.behaviour().delay = Duration::ZERO;
}

#[test]
fn a_dead_bus_with_many_readers_takes_no_more_than_its_share_of_the_threads() {
    if !crate::late_threads_are_relieved() {
        return;
    }
    let Some((_good, slow, m)) = mounted() else {
        return;
    };
    assert_eq!(m.text("late/n1/value"), "0\n");
    slow.behaviour().is_dead = true;
    let m = &m;
    let over = &std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        let readers: Vec<_> = (0..48)
            .map(|n| {
                scope.spawn(move || {
                    let mut errors = Vec::new();
                    while !over.load(std::sync::atomic::Ordering::Relaxed) {
                        errors.push(m.errno(&format!("late/n{}/value", n % 12 + 1)));
                    }
                    errors
                })
            })
            .collect();
        let begin = Instant::now();
        let mut times = Vec::new();
        while begin.elapsed() < Duration::from_millis(2500) {
            let one = Instant::now();
            assert_eq!(m.errno("plain/value"), 0);
            times.push(one.elapsed());
        }
        over.store(true, std::sync::atomic::Ordering::Relaxed);
        let mut errors: Vec<i32> = readers
            .into_iter()
            .flat_map(|reader| reader.join().unwrap())
            .collect();
        errors.sort_unstable();
        errors.dedup();
        // A busy machine makes a read slow now and then; without a thread for it each one would wait for a second.
        let most = nine_tenths(&mut times);
        assert!(most < Duration::from_millis(900), "reads waited {most:?}");
        let known = [libc::EBUSY, libc::EIO, libc::ETIMEDOUT];
        assert!(
            errors.contains(&libc::ETIMEDOUT) && errors.iter().all(|errno| known.contains(errno)),
            "{errors:?}"
        );
    });
    slow.behaviour().is_dead = false;
    harness::eventually("the bus is used again", || m.errno("late/n3/value") == 0);
}
