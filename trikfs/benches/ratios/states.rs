//! What an open file with a Lua converter costs when the configuration has more and more nodes.

use super::measure::{Plan, Spread, median, spread, verdict};
use super::peers::{Mount, NullMount, resident_kib};
use std::fmt::Write as _;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::{Duration, Instant};

const NODES: [usize; 4] = [10, 100, 1000, 4096];
/// Files that are open together, as evenly over the nodes as there are nodes.
const HANDLES: usize = 900;
/// Goals of the controller: KiB of an open file, its first opening against the null filesystem's, and the slowest of 100.
const EACH_KIB: f64 = 40.0;
const RATIO: f64 = 2.0;
const P99_US: f64 = 100.0;

fn config(nodes: usize) -> String {
    let mut text = "trikfs = {\n".to_owned();
    for n in 0..nodes {
        let _ = writeln!(
            text,
            "n{n} = {{ src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, converter = function(a_s, a, b_s, b) for i = 0, 3 do ba.set(b, i, ba.get(a, i) + {}) end end }},",
            n % 200
        );
    }
    text + "}\n"
}

/// Opens and reads the files one after the other, one per millisecond.
fn opened(paths: impl Iterator<Item = std::path::PathBuf>) -> Result<(Vec<File>, Spread), String> {
    let mut files = Vec::new();
    let mut times = Vec::new();
    for path in paths {
        std::thread::sleep(Duration::from_millis(1));
        let start = Instant::now();
        let mut file = File::open(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let read = file.read_exact(&mut [0; 4]);
        read.map_err(|error| format!("{}: {error}", path.display()))?;
        times.push(u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX));
        files.push(file);
    }
    Ok((files, spread(times)))
}

fn null_times(path: &Path) -> Result<Spread, String> {
    Ok(opened(std::iter::repeat_n(path.to_owned(), HANDLES))?.1)
}

pub fn run(plan: &Plan) -> Result<(), String> {
    println!(
        "\n{HANDLES} open files with a Lua converter, each read once, by the nodes of the configuration"
    );
    println!(
        "{:>5} {:>9} {:>14} {:>9} {:>8} {:>11} {:>11} {:>16}",
        "nodes",
        "idle KiB",
        "each open KiB",
        "p50 us",
        "ratio",
        "p99 us",
        "null p99 us",
        "back after 1 s"
    );
    let null = NullMount::start()?;
    let null_path = null.place.0.join("device");
    let mut is_met = true;
    for nodes in NODES {
        let mount = Mount::start("states", &config(nodes))?;
        let daemon = mount.daemon()?;
        let (mut each, mut back) = (Vec::new(), Vec::new());
        let (mut ratios, mut p50, mut p99, mut null_p99) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut idle = 0;
        for round in 0..plan.rounds.min(5) {
            let before = resident_kib(daemon);
            if round == 0 {
                idle = before;
            }
            let paths = (0..HANDLES).map(|n| mount.file(&format!("n{}/device", n % nodes)));
            let (files, times) = opened(paths)?;
            let open = resident_kib(daemon);
            let reference = null_times(&null_path)?;
            drop(files);
            std::thread::sleep(Duration::from_secs(1));
            let after = resident_kib(daemon);
            // The first round has what is made once: the caches, and the memory that the daemon's threads keep.
            if round > 0 {
                let grown = open.saturating_sub(before) as f64;
                each.push(grown / HANDLES as f64);
                back.push(100.0 * open.saturating_sub(after) as f64 / grown.max(1.0));
                ratios.push(times.p50 / reference.p50);
                p50.push(times.p50 / 1000.0);
                p99.push(times.p99 / 1000.0);
                null_p99.push(reference.p99 / 1000.0);
            }
        }
        let (each, back, ratio, p99) = (median(each), median(back), median(ratios), median(p99));
        println!(
            "{nodes:>5} {idle:>9} {each:>14.1} {:>9.2} {ratio:>7.2}x {p99:>11.1} {:>11.1} {back:>14.0} %",
            median(p50),
            median(null_p99)
        );
        is_met &= each <= EACH_KIB && back >= 90.0 && ratio <= RATIO && p99 <= P99_US;
    }
    println!(
        "goal: <= {EACH_KIB} KiB, 90 % back, <= {RATIO:.2}x, p99 <= {P99_US} us at every size {}",
        verdict(is_met)
    );
    Ok(())
}
