//! I2C: what sampling costs (beside it that of attributes), what a slow or dead bus does to others, how soon a written
//! byte is at the device, and how much of a bus of 100 kHz the inputs of the controller take.
//!
//! The bus is virtual and another process serves it (`serve`), which also counts the bits that the wire would carry.

use super::bus_peer::BusPeer;
use super::measure::{Plan, Spread, median, row, spread, table, time, verdict};
use super::peers::{Mount, Place, on_all_cores};
use nix::time::{ClockId, clock_getcpuclockid, clock_gettime};
use nix::unistd::Pid;
use std::fs::File;
use std::os::unix::fs::FileExt;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Bits per second of the controller's buses.
const WIRE_HZ: f64 = 100_000.0;

pub fn run(plan: &Plan) -> Result<(), String> {
    let seconds = if plan.rounds > 3 { 10 } else { 2 };
    sampling(Duration::from_secs(seconds))?;
    wire(Duration::from_secs(seconds))?;
    beside_a_slow_bus(plan)?;
    to_the_device(plan, "client, daemon and bus on one core")?;
    on_all_cores(|| to_the_device(plan, "client, daemon and bus where they like"))
}

fn processor_time(pid: u32) -> Result<Duration, String> {
    let clock = clock_getcpuclockid(Pid::from_raw(pid.cast_signed()));
    let time = clock.and_then(clock_gettime);
    time.map(Duration::from)
        .map_err(|errno| format!("process {pid}: {errno}"))
}

/// Text of a register that is read as a word.
fn word(bus: &BusPeer, register: usize, more: &str) -> String {
    let path = bus.path.display();
    format!(
        "{{ src = i2c{{ '{path}', address = 0x48, register = {register}, transfer = 'word' }}, format = 'u16 raw', {more} }}"
    )
}

/// Nodes that are sampled at 100 Hz.
const SAMPLED: usize = 40;

/// 40 words at 100 Hz: processor time of the daemon and of the other side of the bus. And of as many attributes, whose
/// reading is a system call without any waiting.
fn sampling(duration: Duration) -> Result<(), String> {
    let mut bus = BusPeer::start("sampling", 0)?;
    let words = |number| word(&bus, number, "poll_ms = 10, always = true");
    let mount = Mount::start("bus-sampling", &sampled_nodes(words))?;
    std::thread::sleep(Duration::from_millis(300));
    let begin = Instant::now();
    let bus_before = bus.count()?;
    let (rate, share) = sampling_cost(&mount, duration)?;
    let (bus_after, elapsed) = (bus.count()?, begin.elapsed().as_secs_f64());
    let transfers = (bus_after.transfers - bus_before.transfers) as f64 / elapsed;
    let bus_share = (bus_after.processor_ns - bus_before.processor_ns) as f64 / elapsed / 1e7;
    println!(
        "\nsampling {SAMPLED} registers at 100 Hz ({rate:.0} samples and {transfers:.0} transfers per second)"
    );
    tell_share(share);
    println!("the other side of the bus {bus_share:>7.2} %");
    drop(mount);

    let place = Place::new("attributes")?;
    let paths: Vec<PathBuf> = (0..SAMPLED)
        .map(|number| place.0.join(format!("in_voltage{number}_raw")))
        .collect();
    for path in &paths {
        std::fs::write(path, "1234\n").map_err(|error| error.to_string())?;
    }
    let attribute = |number: usize| {
        let path = paths[number].display();
        format!(
            "{{ src = attribute{{ '{path}' }}, input_tuple_size = 16, poll_ms = 10, always = true }}"
        )
    };
    let mount = Mount::start("attribute-sampling", &sampled_nodes(attribute))?;
    std::thread::sleep(Duration::from_millis(300));
    let cost = sampling_cost(&mount, duration);
    for path in &paths {
        let _ = std::fs::remove_file(path);
    }
    let (rate, share) = cost?;
    println!("\nsampling {SAMPLED} attributes at 100 Hz ({rate:.0} samples per second)");
    tell_share(share);
    Ok(())
}

fn tell_share(share: f64) {
    println!(
        "daemon {share:>26.2} % of one core   goal <= 3 % {}",
        verdict(share <= 3.0)
    );
}

fn sampled_nodes(node: impl Fn(usize) -> String) -> String {
    let mut text = "trikfs = {\n".to_owned();
    for number in 0..SAMPLED {
        text.push_str(&format!("n{number} = {},\n", node(number)));
    }
    text + "}\n"
}

/// Samples per second of all nodes, and the share of a core that the daemon takes for them, in percent.
fn sampling_cost(mount: &Mount, duration: Duration) -> Result<(f64, f64), String> {
    let daemon = mount.daemon()?;
    let samples = || -> Result<f64, String> {
        let text = std::fs::read_to_string(mount.file("n0/stats"));
        let text = text.map_err(|error| format!("stats: {error}"))?;
        let count = text.lines().find_map(|line| line.strip_prefix("samples "));
        let count: Option<f64> = count.and_then(|count| count.trim().parse().ok());
        count.ok_or_else(|| "stats: no samples".to_owned())
    };
    let (begin, count, before) = (Instant::now(), samples()?, processor_time(daemon)?);
    std::thread::sleep(duration);
    let after = processor_time(daemon)?;
    let elapsed = begin.elapsed().as_secs_f64();
    let rate = (samples()? - count) / elapsed * SAMPLED as f64;
    if rate < 3_600.0 {
        return Err(format!("only {rate:.0} samples per second instead of 4000"));
    }
    Ok((rate, (after - before).as_secs_f64() / elapsed * 100.0))
}

/// All inputs of the controller's coprocessor at 50 Hz, in bits of the wire as they were really asked for.
fn wire(duration: Duration) -> Result<(), String> {
    let mut bus = BusPeer::start("wire", 0)?;
    let path = bus.path.display().to_string();
    let mut text = "trikfs = {\n".to_owned();
    for register in 0x20..=0x26 {
        text.push_str(&format!(
            "w{register} = {},\n",
            word(&bus, register, "poll_ms = 20, always = true")
        ));
    }
    for register in 0x30..=0x33 {
        text.push_str(&format!(
            "e{register} = {{ src = i2c{{ '{path}', address = 0x48, register = {register}, transfer = 'block' }}, format = 'i32 ticks', poll_ms = 20, always = true }},\n"
        ));
    }
    let _mount = Mount::start("bus-wire", &(text + "}\n"))?;
    std::thread::sleep(Duration::from_millis(300));
    let (begin, before) = (Instant::now(), bus.count()?);
    std::thread::sleep(duration);
    let (after, elapsed) = (bus.count()?, begin.elapsed().as_secs_f64());
    let rounds = (after.transfers - before.transfers) as f64 / 11.0 / elapsed;
    let share = (after.bits - before.bits) as f64 / elapsed / WIRE_HZ * 100.0;
    println!(
        "\n6 analog inputs, the battery and 4 encoders, each sampled {rounds:.1} times per second"
    );
    println!(
        "share of a bus of 100 kHz {share:>7.1} %   goal < 100 % at >= 50 Hz {}",
        verdict(share < 100.0 && rounds >= 49.0)
    );
    Ok(())
}

/// A read of one bus while another one is fast, slow and dead, with sampled nodes and waiting readers on it.
fn beside_a_slow_bus(plan: &Plan) -> Result<(), String> {
    let good = BusPeer::start("good", 0)?;
    println!("\nread(2) of a register while another bus has 12 sampled nodes and 4 readers");
    println!("{:<44} {:>9} {:>9}", "", "p50 us", "p99 us");
    let mut alone = None;
    for (name, others, delay_ms) in [
        ("alone", 0, 0),
        ("the other bus answers at once", 12, 0),
        ("the other bus answers after 200 ms", 12, 200),
        ("the other bus never answers", 12, u32::MAX),
    ] {
        let other = BusPeer::start("other", delay_ms)?;
        let mut text = format!("trikfs = {{ good = {},\n", word(&good, 1, ""));
        for number in 0..others {
            text.push_str(&format!(
                "n{number} = {},\n",
                word(&other, 2 * number, "poll_ms = 20, always = true")
            ));
            text.push_str(&format!("r{number} = {},\n", word(&other, 2 * number, "")));
        }
        let mount = Mount::start("bus-slow", &(text + "}\n"))?;
        let seen = reads_beside(&mount, plan, others > 0)?;
        println!("{name:<44} {:>9.2} {:>9.2}", seen.p50 / 1e3, seen.p99 / 1e3);
        match alone {
            None => alone = Some(seen.p99),
            Some(alone) => {
                let more_ms = (seen.p99 - alone) / 1e6;
                println!(
                    "  at p99 {more_ms:>6.3} ms more   goal <= 1 ms {}",
                    verdict(more_ms <= 1.0)
                );
            }
        }
    }
    Ok(())
}

fn reads_beside(mount: &Mount, plan: &Plan, with_others: bool) -> Result<Spread, String> {
    let good = mount.open("good/value")?;
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        for number in 0..if with_others { 4 } else { 0 } {
            let (file, over) = (mount.file(&format!("r{number}/value")), &over);
            scope.spawn(move || {
                while !over.load(Ordering::Relaxed) {
                    // Errors are what a dead bus gives.
                    let _ = std::fs::read(&file);
                    std::thread::sleep(Duration::from_millis(1));
                }
            });
        }
        let seen = (0..plan.rounds).map(|_| {
            time(plan.samples, || {
                good.read_at(&mut [0; 16], 0).expect("read");
            })
        });
        let seen: Vec<Spread> = seen.collect();
        over.store(true, Ordering::Relaxed);
        Ok(Spread {
            p50: median(seen.iter().map(|one| one.p50).collect()),
            p99: median(seen.iter().map(|one| one.p99).collect()),
        })
    })
}

/// From write(2) to the byte at the device, against a packet that is sent to the bus directly.
fn to_the_device(plan: &Plan, where_: &str) -> Result<(), String> {
    let direct = BusPeer::start("direct", 0)?;
    let behind = BusPeer::start("behind", 0)?;
    let path = behind.path.display();
    let mount = Mount::start(
        "bus-write",
        &format!(
            "trikfs = {{ motor = {{ src = i2c{{ '{path}', address = 0x48, register = 0x14, transfer = 'byte', readable = false }}, format = 'i8 power', rest = 0 }} }}"
        ),
    )?;
    let bytes = open_writing(&mount, "motor/bin_data")?;
    let text = open_writing(&mount, "motor/value")?;
    let socket = direct.connect()?;
    let samples = plan.samples / 4;
    let arrivals = |bus: &BusPeer, send: &mut dyn FnMut()| {
        let mut ages = Vec::with_capacity(samples);
        for number in 0..samples + 50 {
            // Long enough for everybody to be asleep in the kernel again.
            std::thread::sleep(Duration::from_micros(200));
            let begin = now_ns();
            send();
            let age = bus
                .arrival()
                .expect("the bus is there")
                .saturating_sub(begin);
            if number >= 50 {
                ages.push(age);
            }
        }
        spread(ages)
    };
    // The motor was brought to rest before the tree was there.
    behind.arrival()?;
    let rows = vec![
        row("packet to the bus, without trikfs", 0, None, || {
            arrivals(&direct, &mut || direct.write_byte(&socket))
        }),
        row(
            "write(2) of bin_data (goal: p99 <= 200 us)",
            0,
            None,
            || {
                arrivals(&behind, &mut || {
                    bytes.write_at(&[50], 0).expect("write");
                })
            },
        ),
        row("write(2) of value as text", 0, None, || {
            arrivals(&behind, &mut || {
                text.write_at(b"50", 0).expect("write");
            })
        }),
    ];
    let title = format!("from write(2) of a motor to the byte at the device; {where_}");
    table(&title, plan.rounds, rows);
    Ok(())
}

fn open_writing(mount: &Mount, name: &str) -> Result<File, String> {
    let file = File::options().write(true).open(mount.file(name));
    file.map_err(|error| format!("{name}: {error}"))
}

/// Nanoseconds of a clock that all processes share.
pub(super) fn now_ns() -> u64 {
    let now = clock_gettime(ClockId::CLOCK_MONOTONIC).expect("the monotonic clock");
    u64::try_from(Duration::from(now).as_nanos()).expect("less than 500 years")
}
