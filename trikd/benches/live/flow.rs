//! How late a motor hears of a sensor in a program of data flow: a sensor, a function and a motor over plain files.
//!
//! The kernel tells of each read of the sensor's file and of each write to the motor's one (inotify), and this program asks
//! it again and again, so it needs a processor of its own. A time begins with the last look that found nothing and ends
//! after the one that did: each figure is rather too long than too short.

use crate::{Client, Daemon, LONGEST, quantile};
use lang_dataflow::machine::POLL_MS;
use lang_diagram::machine::STEP_MS;
use nix::errno::Errno;
use nix::sys::inotify::{AddWatchFlags, InitFlags, Inotify};
use rand_core::{Rng as _, SeedableRng as _};
use rand_xoshiro::Xoroshiro64Star;
use std::fs::{File, OpenOptions};
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

const CHANGES: u32 = 500;
/// Between a change that has arrived and the next one: a whole period, from moment to moment of it. Meanwhile the processor
/// is free, as the kernel wants of programs that run above all others.
const PAUSE_US: u32 = POLL_MS * 1000;
/// Between two looks: without a pause, looking holds the kernel's lock against the processes that it looks at.
const LOOK: Duration = Duration::from_micros(2);
const PROGRAM: &str = "diagram \"Latency\"
  sensor: Sensor(VarName = sensorA1)
  same: \"Text programming\"(IO0 = `I0`)
  wheel: Motors
  sensor.OUT -> same.I0
  same.O0 -> wheel.M1
";

/// Both files, and what the kernel tells of them.
struct Wire {
    sensor: File,
    motor: File,
    told: Inotify,
}

/// Milliseconds to the byte at the motor.
struct Late {
    of_change: f64,
    of_sample: f64,
}

impl Wire {
    fn new(tree: &Path) -> Self {
        let (sensor, motor) = (tree.join("sensors/A1/value"), tree.join("motors/M1/value"));
        let told = Inotify::init(InitFlags::IN_NONBLOCK | InitFlags::IN_CLOEXEC).expect("inotify");
        told.add_watch(&sensor, AddWatchFlags::IN_ACCESS)
            .expect("a watch");
        told.add_watch(&motor, AddWatchFlags::IN_MODIFY)
            .expect("a watch");
        let sensor = OpenOptions::new().write(true).open(sensor);
        Self {
            sensor: sensor.expect("a sensor"),
            motor: File::open(motor).expect("a motor"),
            told,
        }
    }

    /// Whether the motor has this power.
    fn has(&self, power: u32) -> bool {
        let mut text = [0; 8];
        let size = self.motor.read_at(&mut text, 0).expect("a motor");
        let text = std::str::from_utf8(&text[..size]).expect("a text");
        let line = text.lines().next().unwrap_or_default();
        line.parse() == Ok(power)
    }

    /// Changes the sensor, and waits until the motor has heard of it.
    fn change(&self, power: u32) -> Late {
        // Readings before this do not count.
        let _ = self.told.read_events();
        let changed = Instant::now();
        // Of one length always, so that no reader sees half of it.
        let reading = format!("{power:03}\n");
        self.sensor
            .write_all_at(reading.as_bytes(), 0)
            .expect("a change");
        let mut sampled = changed;
        let mut looked = changed;
        loop {
            assert!(
                changed.elapsed() < LONGEST,
                "the motor has not heard of {power}"
            );
            let events = match self.told.read_events() {
                Ok(events) => events,
                Err(Errno::EAGAIN) => {
                    looked = Instant::now();
                    while looked.elapsed() < LOOK {
                        std::hint::spin_loop();
                    }
                    continue;
                }
                Err(error) => panic!("inotify: {error}"),
            };
            let now = Instant::now();
            for event in events {
                if event.mask.contains(AddWatchFlags::IN_ACCESS) {
                    sampled = looked;
                } else if self.has(power) {
                    let ms = |since| now.duration_since(since).as_secs_f64() * 1000.0;
                    return Late {
                        of_change: ms(changed),
                        of_sample: ms(sampled),
                    };
                }
            }
        }
    }
}

/// A figure, and how large it is beside what it is measured against.
fn figure(name: &str, mut took: Vec<f64>, (yardstick, unit): (f64, &str), goal: &str) {
    took.sort_by(f64::total_cmp);
    let all = [
        quantile(&took, 0.5),
        quantile(&took, 0.99),
        quantile(&took, 1.0),
    ];
    let [p50, p99, most] = all;
    let shares = all.map(|one| format!("{:.4}", one / yardstick));
    println!(
        "{name}: p50 {p50:.3} ms, p99 {p99:.3} ms, most {most:.3} ms; {} of {unit} of {yardstick} ms{goal}",
        shares.join(", ")
    );
}

/// Changes a sensor at random moments, and prints how late a motor hears of it.
pub fn run(folder: &Path, daemon: &Daemon) {
    let mut client = Client::new(daemon.port);
    client.send(&[b"file:latency.flow:", PROGRAM.as_bytes()].concat());
    client.send(b"run:latency.flow");
    client.until(|text| text.contains("has started"));
    let wire = Wire::new(&folder.join("tree"));
    let mut random = Xoroshiro64Star::seed_from_u64(1);
    // Files are opened at their first use.
    wire.change(99);
    let late = (0..CHANGES).map(|round| {
        let pause = random.next_u32() % PAUSE_US;
        sleep(Duration::from_micros(pause.into()));
        wire.change(round % 98 + 1)
    });
    let late: Vec<Late> = late.collect();
    client.send(b"stop");
    let step = f64::from(STEP_MS);
    let of_sample: Vec<f64> = late.iter().map(|late| late.of_sample).collect();
    let is_met = of_sample.iter().all(|&one| one <= step);
    let word = if is_met { "met" } else { "NOT MET" };
    figure(
        "data flow: sensor read, at the motor",
        of_sample,
        (step, "a step"),
        &format!("; goal 1 step {word}"),
    );
    figure(
        "data flow: sensor changed, at the motor",
        late.iter().map(|late| late.of_change).collect(),
        (f64::from(POLL_MS), "the time between two readings"),
        "",
    );
}
