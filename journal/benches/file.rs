//! What writing, reading and finding cost in recordings, beside the crate `mcap` itself and, with the Python that
//! `TRIK_MCAP_PYTHON` names, rosbags.
//!
//! `cargo bench -p journal --bench file`; `JOURNAL_MIB` is the size of the large file (1024). Times are those of the
//! processor, the best of several rounds in turns, but for the large file, where a person waits: there they are those of the clock.

use journal::node::Node;
use journal::read::Reader;
use journal::write::Writer;
use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::hint::black_box;
use std::io::{BufReader, BufWriter, Cursor, Write};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

const ROUNDS: u32 = 5;
/// As the virtual robot has, all at 20 ms.
const NODES: u64 = 55;
const PERIOD_NS: u64 = 20_000_000;
const SAMPLES: u64 = 100_000;
const PICTURES: u64 = 1_500;
const PICTURE_BYTES: usize = 48 << 10;
const ZERO: u64 = 1_700_000_000_000_000_000;

/// Seconds of the processor that this thread has had.
fn cpu_s() -> f64 {
    let text = fs::read_to_string("/proc/thread-self/schedstat").expect("Linux");
    let ns = text
        .split_whitespace()
        .next()
        .and_then(|word| word.parse().ok());
    ns.map_or(f64::NAN, |ns: f64| ns / 1e9)
}

fn timed(run: impl FnOnce()) -> f64 {
    let before = cpu_s();
    run();
    cpu_s() - before
}

/// The best times of several ways that take turns.
fn race<const N: usize>(mut ways: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut best = [f64::INFINITY; N];
    for _ in 0..ROUNDS {
        for (way, best) in ways.iter_mut().zip(&mut best) {
            *best = best.min(timed(&mut **way));
        }
    }
    best
}

/// Bytes that nothing makes smaller, as those of a JPEG file.
fn noise(bytes: usize, seed: u32) -> Vec<u8> {
    let mut random = needs::Random::new(seed);
    let words = (0..bytes.div_ceil(4)).flat_map(|_| random.bits().to_le_bytes());
    words.take(bytes).collect()
}

/// Numbers that wander, as those of sensors.
fn tuple(at: u64) -> [u8; 12] {
    let mut out = [0; 12];
    for (part, number) in out.chunks_mut(4).zip([at % 7, at % 1000, 1000 + at % 3]) {
        part.copy_from_slice(&u32::try_from(number).unwrap_or(0).to_le_bytes());
    }
    out
}

fn as_we_write() -> mcap::WriteOptions {
    mcap::WriteOptions::new()
        .profile("ros2")
        .compression(Some(mcap::Compression::Lz4))
        .chunk_size(Some(journal::limits::CHUNK_BYTES))
        .disable_seeking(true)
}

/// Messages that are made already, by the crate alone.
fn plain<W: Write + std::io::Seek>(out: W, topics: u64, messages: u64, data: &[Vec<u8>]) {
    let mut file = as_we_write().create(out).expect("begun");
    let schema = file
        .add_schema("x/msg/X", "ros2msg", b"uint8[] data")
        .expect("a type");
    let ids: Vec<u16> = (0..topics)
        .map(|at| {
            let topic = format!("/sensors/n{at}");
            file.add_channel(schema, &topic, "cdr", &BTreeMap::new())
                .expect("a channel")
        })
        .collect();
    for at in 0..messages {
        let number = usize::try_from(at).unwrap_or(0);
        let header = MessageHeader {
            channel_id: ids[number % ids.len()],
            sequence: 0,
            log_time: ZERO + at,
            publish_time: ZERO + at,
        };
        (file.write_to_known_channel(&header, &data[number % data.len()])).expect("written");
    }
    file.finish().expect("finished");
}

/// Pictures by us.
fn pictures<W: Write + std::io::Seek>(out: W, count: u64, pictures: &[Vec<u8>]) {
    let mut file = Writer::new(out, "bench").expect("begun");
    let node = Node::sensor("camera", &format!("u8 x {PICTURE_BYTES}"));
    let node = file.add(&node).expect("a node");
    for at in 0..count {
        let picture = &pictures[usize::try_from(at).unwrap_or(0) % pictures.len()];
        (file.sample(node, ZERO + at * 33_000_000, picture)).expect("written");
    }
    file.finish().expect("finished");
}

/// Samples of all nodes by us.
fn samples<W: Write + std::io::Seek>(out: W) {
    let mut file = Writer::new(out, "bench").expect("begun");
    let ids: Vec<_> = (0..NODES)
        .map(|at| {
            let node = Node::sensor(&format!("sensors/n{at}"), "i32 x, i32 y, i32 z");
            file.add(&node).expect("a node")
        })
        .collect();
    for at in 0..SAMPLES {
        let id = ids[usize::try_from(at % NODES).unwrap_or(0)];
        (file.sample(id, ZERO + at / NODES * PERIOD_NS + at % NODES, &tuple(at))).expect("written");
    }
    file.finish().expect("finished");
}

fn line(what: &str, measured: f64, unit: &str, ratio: f64, of: &str) {
    println!("{what:<44} {measured:>10.1} {unit:<12} {ratio:>7.2} {of}");
}

fn write_pictures() {
    let all: Vec<Vec<u8>> = (0..8).map(|seed| noise(PICTURE_BYTES, seed + 1)).collect();
    let bytes = PICTURES as f64 * PICTURE_BYTES as f64;
    let room = || Vec::with_capacity(100 << 20);
    let (mut ours, mut theirs) = (room(), room());
    let [our_s, their_s] = race([
        &mut || {
            ours.clear();
            pictures(Cursor::new(&mut ours), PICTURES, &all);
        },
        &mut || {
            theirs.clear();
            plain(Cursor::new(&mut theirs), 1, PICTURES, &all);
        },
    ]);
    let mb_s = |s: f64| bytes / s / 1e6;
    line(
        "pictures written",
        mb_s(our_s),
        "MB/s",
        mb_s(our_s) / 200.0,
        "of 200 MB/s",
    );
    line(
        "  by the crate mcap",
        mb_s(their_s),
        "MB/s",
        their_s / our_s,
        "their time to ours",
    );
}

fn write_and_read_samples(folder: &Path) {
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    samples(Cursor::new(&mut ours));
    let made = messages_of(&ours);
    let [our_s, their_s] = race([
        &mut || {
            ours.clear();
            samples(Cursor::new(&mut ours));
        },
        &mut || {
            theirs.clear();
            plain(Cursor::new(&mut theirs), NODES, SAMPLES, &made);
        },
    ]);
    let per = |s: f64| s / SAMPLES as f64 * 1e9;
    let real_s = (SAMPLES / NODES * PERIOD_NS) as f64 / 1e9;
    line(
        "samples of 55 nodes made and written",
        per(our_s),
        "ns each",
        their_s / our_s,
        "their time to ours, of made messages",
    );
    line(
        "  of a processor, each at 50 Hz",
        our_s / real_s * 100.0,
        "%",
        2.0 / (our_s / real_s * 100.0),
        "times less than 2 %",
    );
    let each = ours.len() as f64 / SAMPLES as f64;
    line(
        "  bytes",
        each,
        "each",
        made[0].len() as f64 / each,
        "bytes of a message to that",
    );
    let our_read_s = read_samples(&ours, real_s);
    let file = folder.join("samples.mcap");
    fs::write(&file, &ours).expect("a file");
    beside_python(&file, our_s, our_read_s);
}

/// Reads the samples of a recording; how long it takes, in seconds. They lasted for `real_s`.
fn read_samples(ours: &[u8], real_s: f64) -> f64 {
    let [our_read_s, their_read_s] = race([
        &mut || {
            let mut reader = Reader::open(Cursor::new(ours)).expect("a recording");
            let mut count = 0;
            while let Some(event) = reader.next().expect("an event") {
                black_box(&event);
                count += 1;
            }
            assert_eq!(count, SAMPLES);
        },
        &mut || {
            let all = mcap::MessageStream::new(ours).expect("a recording");
            let mut count = 0;
            for message in all {
                black_box(message.expect("whole"));
                count += 1;
            }
            assert_eq!(count, SAMPLES);
        },
    ]);
    line(
        "  read",
        our_read_s / SAMPLES as f64 * 1e9,
        "ns each",
        their_read_s / our_read_s,
        "the crate mcap's time to ours",
    );
    line(
        "  real time",
        real_s / our_read_s,
        "times",
        real_s / our_read_s / 100.0,
        "of 100 times",
    );
    our_read_s
}

/// The messages of a recording of samples, ready to be written once more.
fn messages_of(bytes: &[u8]) -> Vec<Vec<u8>> {
    let all = mcap::MessageStream::new(bytes).expect("a recording");
    all.map(|message| message.expect("whole").data.into_owned())
        .collect()
}

/// The same messages written and read by rosbags, and read by the package `mcap`.
fn beside_python(file: &Path, our_write_s: f64, our_read_s: f64) {
    let Some(python) = std::env::var_os("TRIK_MCAP_PYTHON") else {
        println!("TRIK_MCAP_PYTHON names no Python with rosbags and mcap: left out");
        return;
    };
    let peers = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/file_peers.py");
    let output = Command::new(python)
        .arg(peers)
        .arg(file)
        .output()
        .expect("Python");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for told in String::from_utf8_lossy(&output.stdout).lines() {
        let words: Vec<&str> = told.split_whitespace().collect();
        let &[who, what, seconds] = &words[..] else {
            continue;
        };
        let seconds: f64 = seconds.parse().unwrap_or(f64::NAN);
        let ours = if what == "written" {
            our_write_s
        } else {
            our_read_s
        };
        let name = format!("  {what} by {who} in Python");
        line(
            &name,
            seconds / SAMPLES as f64 * 1e9,
            "ns each",
            seconds / ours,
            "their time to ours",
        );
    }
}

/// A file as after a day: opened, and played from the middle on.
fn find_in_a_large_file(folder: &Path) {
    let mib: u64 =
        std::env::var("JOURNAL_MIB").map_or(1024, |text| text.parse().expect("a number"));
    let file = folder.join("large.mcap");
    let all: Vec<Vec<u8>> = (0..8).map(|seed| noise(PICTURE_BYTES, seed + 1)).collect();
    let count = (mib << 20) / PICTURE_BYTES as u64;
    pictures(
        BufWriter::new(File::create(&file).expect("a file")),
        count,
        &all,
    );
    let bytes = fs::metadata(&file).map_or(0, |file| file.len());
    let mut times: Vec<f64> = (0..9)
        .map(|at| {
            let begin = Instant::now();
            let opened = BufReader::new(File::open(&file).expect("a file"));
            let mut reader = Reader::open(opened).expect("a recording");
            let length = reader.end_ns() - reader.begin_ns();
            let moment = reader.begin_ns() + length / 10 * (at + 1);
            black_box(reader.newest(moment).expect("a value"));
            reader.seek(moment);
            black_box(reader.next().expect("an event").expect("not the last"));
            begin.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let [median, slowest] = [times[4], times[8]];
    println!("a file of {:.2} GB, open and seek:", bytes as f64 / 1e9);
    line("  median", median, "ms", median / 100.0, "of 100 ms");
    line(
        "  slowest of 9",
        slowest,
        "ms",
        slowest / 100.0,
        "of 100 ms",
    );
}

fn main() {
    let folder = tempfile::tempdir().expect("a folder");
    write_pictures();
    write_and_read_samples(folder.path());
    find_in_a_large_file(folder.path());
}
