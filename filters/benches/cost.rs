//! What a sample costs in each filter, as a ratio to the identity filter through the same C interface in the same run.
//!
//! `cargo bench -p filters --bench cost [-- NAME...]` prints nanoseconds and ratios; `--quick` makes few rounds.
//! `... --bench cost -- --count NAME SAMPLES` only converts so many samples, for a tool that counts instructions: the
//! difference of two counts is free of everything else, and does not depend on what else the machine does.
//! Method and results are in docs/maintainer/performance.md.

use converter::abi::{Instance, descriptors};
use converter::{Direction, OpenInfo};
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

/// A filter with the numbers of values of its tuples.
type Case = (&'static str, usize, usize);

/// The least tuples that mean something; one value for filters on single values.
const CASES: [Case; 30] = [
    ("identity", 1, 1),
    ("median3", 1, 1),
    ("moving_average", 1, 1),
    ("moving_average_f32", 1, 1),
    ("low_pass", 1, 1),
    ("low_pass_f32", 1, 1),
    ("scale", 1, 1),
    ("inverse", 1, 1),
    ("dead_band", 1, 1),
    ("rate", 1, 1),
    ("debounce", 1, 1),
    ("hysteresis", 1, 1),
    ("kalman", 1, 1),
    ("kalman_f32", 1, 1),
    ("kalman_linear", 1, 2),
    ("complementary", 2, 1),
    ("complementary_f32", 2, 1),
    ("pid", 2, 1),
    ("pid_f32", 2, 1),
    ("speed_hold", 2, 3),
    ("odometry", 2, 3),
    ("heading", 6, 1),
    ("madgwick", 6, 4),
    ("madgwick", 9, 4),
    ("mahony", 6, 4),
    ("mahony", 9, 4),
    ("madgwick", 6, 7),
    ("madgwick", 9, 7),
    ("mahony", 6, 7),
    ("mahony", 9, 7),
];

/// Filters of orientation, and the most that a sample may cost in them on a PC, the C interface included.
const QUATERNIONS: [&str; 2] = ["madgwick", "mahony"];
const GOAL_NS: f64 = 300.0;

/// Rounds, of which the median counts, and samples in each: short, so that most are not interrupted.
const ROUNDS: usize = 501;
const SAMPLES: u32 = 1_000;

/// Opens a filter and makes tuples for it: whole numbers that change a little, as a sensor's do.
fn open((name, inputs, outputs): Case) -> (Instance, Vec<Vec<u8>>, Vec<u8>) {
    let params = [
        ("period_ms", 10.0),
        ("wheel_diameter_mm", 56.0),
        ("track_mm", 150.0),
    ];
    let params = params.map(|(name, value)| (name.to_owned(), value)).into();
    let info = OpenInfo {
        direction: Direction::Read,
        input_size: 4 * inputs,
        output_size: 4 * outputs,
        node: name,
        params: &params,
        log: &|_| (),
    };
    let library = descriptors(trikfs_filters::trikfs_library_entry()).expect("our own library");
    let descriptor = library
        .iter()
        .find(|d| d.name() == name)
        .expect("a filter of ours");
    let instance = descriptor
        .open(&info)
        .unwrap_or_else(|fault| panic!("{fault}"));
    let value = |n: usize, lane: usize| {
        let number = (100 * lane + 500 + (n * 37 + lane * 11) % 23) as i32;
        if name.ends_with("_f32") {
            (number as f32).to_le_bytes()
        } else {
            number.to_le_bytes()
        }
    };
    let tuple = |n| (0..inputs).flat_map(|lane| value(n, lane)).collect();
    (instance, (0..64).map(tuple).collect(), vec![0; 4 * outputs])
}

/// Converts so many samples.
fn convert(opened: &mut (Instance, Vec<Vec<u8>>, Vec<u8>), samples: u32) {
    let (instance, tuples, output) = opened;
    for n in 0..samples {
        let tuple = black_box(&tuples[n as usize % tuples.len()]);
        // A fault would be cheaper than a result: it must not pass unseen.
        instance
            .convert(tuple, output)
            .unwrap_or_else(|fault| panic!("{fault}"));
        black_box(&output);
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    if let [flag, name, samples] = words.as_slice()
        && flag == "--count"
    {
        let (name, size) = name.split_once(':').unwrap_or((name, ""));
        let fits = |case: &&Case| {
            case.0 == name && (size.is_empty() || size == format!("{}-{}", case.1, case.2))
        };
        let (Some(case), Ok(samples)) = (CASES.iter().find(fits), samples.parse()) else {
            eprintln!("no such filter, or no number of samples");
            return ExitCode::FAILURE;
        };
        convert(&mut open(*case), samples);
        return ExitCode::SUCCESS;
    }
    let rounds = if words.iter().any(|word| word == "--quick") {
        51
    } else {
        ROUNDS
    };
    let named: Vec<&str> = words
        .iter()
        .map(String::as_str)
        .filter(|word| !word.starts_with('-'))
        .collect();
    let wanted = |case: &&Case| named.is_empty() || case.0 == "identity" || named.contains(&case.0);
    let cases: Vec<Case> = CASES.iter().filter(wanted).copied().collect();
    let mut opened: Vec<_> = cases.iter().map(|case| open(*case)).collect();
    let mut times = vec![Vec::new(); cases.len()];
    for _ in 0..rounds {
        for (case, times) in opened.iter_mut().zip(&mut times) {
            let start = Instant::now();
            convert(case, SAMPLES);
            times.push(start.elapsed().as_secs_f64() * 1e9 / f64::from(SAMPLES));
        }
    }
    println!("{rounds} rounds of {SAMPLES} samples; ratio to identity in the same round");
    println!("{:<22}{:>8}{:>10}{:>9}", "filter", "values", "ns", "ratio");
    let identity = times[0].clone();
    for ((name, inputs, outputs), times) in cases.iter().zip(times) {
        let ratios = times
            .iter()
            .zip(&identity)
            .map(|(time, base)| time / base)
            .collect();
        let sizes = format!("{inputs} to {outputs}");
        let ns = median(times);
        let goal = if QUATERNIONS.contains(name) {
            let verdict = if ns <= GOAL_NS { "met" } else { "NOT MET" };
            format!("  goal <= {GOAL_NS} ns {verdict}")
        } else {
            String::new()
        };
        println!(
            "{name:<22}{sizes:>8}{ns:>10.1}{:>8.2}x{goal}",
            median(ratios)
        );
    }
    ExitCode::SUCCESS
}
