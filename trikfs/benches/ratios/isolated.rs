//! A library converter in a process of its own, against the same one in the daemon: one tuple at a time, many at once, and
//! samples that are taken in the background.

use super::measure::{Plan, median, row, table, time, verdict};
use super::peers::Mount;
use std::fs::File;
use std::io::Read;
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::time::{Duration, Instant};

const CONFIG: &str = r"
local code = [[
int converter(int in_s, char *in, int out_s, char *out) {
  for (int i = 0; i < in_s && i < out_s; i++) out[i] = in[i] + i;
  return 0;
}]]
local function node(size, isolate, poll_ms)
  return { src = '/dev/zero', input_tuple_size = size, output_tuple_size = size,
           converter = { code = code }, isolate = isolate, poll_ms = poll_ms, always = poll_ms and true }
end
trikfs = {
  within = node(4, false), apart = node(4, true),
  many_within = node(8, false), many_apart = node(8, true),
  paced_within = node(4, false, 20), paced_apart = node(4, true, 20),
}";

/// Of one tuple, of many, and of samples in the background: how many times the time of the converter in the daemon.
const ONE: f64 = 1.9;
const MANY: f64 = 1.1;
const PACED: f64 = 1.1;
/// Nodes that are sampled in each of the two mounts whose processor time is compared, and how often.
const NODES: usize = 10;
const PERIOD_MS: usize = 2;

pub fn run(plan: &Plan) -> Result<(), String> {
    let mount = Mount::start("isolated", CONFIG)?;
    one(plan, &mount)?;
    many(plan, &mount)?;
    paced(plan)
}

fn one(plan: &Plan, mount: &Mount) -> Result<(), String> {
    let samples = plan.samples;
    let mut within = mount.open("within/device")?;
    let mut apart = mount.open("apart/device")?;
    let newest_within = mount.open("paced_within/value")?;
    let newest_apart = mount.open("paced_apart/value")?;
    let read = move |file: &mut File| {
        let mut tuple = [0; 4];
        time(samples, || file.read_exact(&mut tuple).expect("read"))
    };
    let newest = move |file: &File| {
        let mut text = [0; 64];
        time(samples, || {
            file.read_at(&mut text, 0).expect("read");
        })
    };
    let rows = vec![
        row("device, converter in the daemon", 0, None, || {
            read(&mut within)
        }),
        row(
            "device, converter in a process of its own",
            0,
            Some(ONE),
            || read(&mut apart),
        ),
        row("newest value, converter in the daemon", 2, None, || {
            newest(&newest_within)
        }),
        row(
            "newest value, in a process of its own",
            2,
            Some(PACED),
            || newest(&newest_apart),
        ),
    ];
    table("isolated: reads of one tuple of 4 bytes", plan.rounds, rows);
    Ok(())
}

fn many(plan: &Plan, mount: &Mount) -> Result<(), String> {
    let mut bytes = vec![0; 128 << 10];
    let mut within = mount.open("many_within/device")?;
    let mut apart = mount.open("many_apart/device")?;
    let mut took = |file: &mut File| {
        let rounds = plan.samples / 40;
        let start = Instant::now();
        for _ in 0..rounds {
            file.read_exact(&mut bytes).expect("read");
        }
        start.elapsed().as_secs_f64()
    };
    let ratios = (0..plan.rounds).map(|_| {
        let base = took(&mut within);
        took(&mut apart) / base
    });
    let ratio = median(ratios.collect());
    let met = verdict(ratio <= MANY);
    println!("many tuples of 8 bytes in one read(2) of 128 KiB: {ratio:.2}x  <= {MANY:.2} {met}");
    Ok(())
}

/// Processor time of the daemon and its processes, which no reader sees.
fn paced(plan: &Plan) -> Result<(), String> {
    let duration = Duration::from_secs(if plan.rounds > 3 { 5 } else { 1 });
    let mut used = Vec::new();
    for isolate in [false, true] {
        let nodes = (0..NODES).map(|n| format!("n{n} = node({isolate}),\n"));
        let config = format!(
            "local function node(isolate) return {{ src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, poll_ms = {PERIOD_MS}, always = true, \
             isolate = isolate, converter = {{ code = [[\nint converter(int n, char *in, int m, char *out) {{\n\
             for (int i = 0; i < 4; i++) out[i] = in[i] + i; return 0; }}]] }} }} end\ntrikfs = {{\n{}}}\n",
            nodes.collect::<String>()
        );
        let mount = Mount::start("isolated-paced", &config)?;
        let daemon = mount.daemon()?;
        let before = processor_us(daemon);
        std::thread::sleep(duration);
        let us = processor_us(daemon) - before;
        let samples = duration.as_millis() as f64 / PERIOD_MS as f64 * NODES as f64;
        used.push(us / samples);
    }
    println!(
        "one sample in the background, of {NODES} nodes each {PERIOD_MS} ms: {:.1} us of the processor, {:.1} in processes of their own: {:.2}x",
        used[0],
        used[1],
        used[1] / used[0]
    );
    Ok(())
}

/// Time that a process and those that it has started have used.
fn processor_us(process: u32) -> f64 {
    let children = std::fs::read_dir(format!("/proc/{process}/task"));
    let threads = children.into_iter().flatten().flatten();
    let texts =
        threads.filter_map(|thread| std::fs::read_to_string(thread.path().join("children")).ok());
    let children: Vec<u32> = texts
        .flat_map(|text| {
            text.split_whitespace()
                .filter_map(|pid| pid.parse().ok())
                .collect::<Vec<_>>()
        })
        .collect();
    let own = scheduled_us(Path::new(&format!("/proc/{process}")));
    own + children.into_iter().map(processor_us).sum::<f64>()
}

fn scheduled_us(process: &Path) -> f64 {
    let threads = std::fs::read_dir(process.join("task"))
        .into_iter()
        .flatten()
        .flatten();
    let texts =
        threads.filter_map(|thread| std::fs::read_to_string(thread.path().join("schedstat")).ok());
    let nanoseconds = texts.filter_map(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.sum::<f64>() / 1000.0
}
