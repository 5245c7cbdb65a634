//! How fast planners of DCML are: steps of the solver and whole propagations per second, and the time until a path is
//! found, beside the bare solver and beside RRT of OMPL.
//!
//! `cargo bench -p lang-plan --bench plan`. OMPL takes part if its headers and its library are there (Debian:
//! libompl-dev), or where OMPL_ROOT points to; its program is compiled with -O2 and run between the rounds of ours, so
//! that both have the same machine. Same robot (a unicycle, RK4), room, gap, ranges, goal bias, one action for a sample.

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use lang_dcml::robot::Robot;
use lang_dcml::understand;
use lang_plan::obstacles::{Footprint, Obstacles, Shape};
use lang_plan::room::{Parts, Room};
use lang_plan::{
    Anywhere, Axis, Goal, Method, Options, Outcome, Problem, Propagator, Surroundings, plan,
};

const SEEDS: u64 = 40;
const ROUNDS: usize = 5;
const MODEL: &str = "BEGIN Unicycle ACTION: v, w; CONFIG: x, y, theta in S1;
    d(x) = v * cos(theta); d(y) = v * sin(theta); d(theta) = w; END;";

fn robot() -> Robot {
    let understood = understand(MODEL);
    assert_eq!(understood.models.len(), 1, "{:?}", understood.diagnostics);
    Robot::new(&understood.models[0], &[]).unwrap()
}

fn problem() -> Problem {
    let line = |part, high| Axis {
        part,
        weight: 1.0,
        low: 0.0,
        high,
        is_angle: false,
    };
    let heading = Axis {
        part: 2,
        weight: 0.2,
        low: -std::f64::consts::PI,
        high: std::f64::consts::PI,
        is_angle: true,
    };
    Problem {
        start: vec![0.5, 0.5, 0.0],
        axes: vec![line(0, 4.0), line(1, 3.0), heading],
        goal: vec![Goal {
            wanted: vec![(0, 3.5), (1, 2.5)],
            tolerance: 0.1,
        }],
        actions: vec![(0.0, 1.0), (-2.0, 2.0)],
        step: 0.05,
        hold: (2, 20),
        links: Vec::new(),
    }
}

fn options(seed: u64, method: Method, attempts: u32) -> Options {
    Options {
        method,
        seed,
        attempts,
        iterations: if method == Method::Rrt {
            2_000_000
        } else {
            50_000
        },
        ..Options::default()
    }
}

/// Seconds and what came out.
fn timed(room: &mut impl Surroundings, options: &Options) -> (f64, Outcome) {
    let mut robot = robot();
    let problem = problem();
    let begun = Instant::now();
    let outcome = plan(&mut robot, room, &problem, options, &mut |_| true).unwrap();
    (begun.elapsed().as_secs_f64(), outcome)
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Ten steps of the solver for each propagation, one after the other: the most that a planner could do.
fn bare() -> f64 {
    const CALLS: u32 = 100_000;
    let mut robot = robot();
    let mut propagator = Propagator::new(&mut robot, 0.05);
    let from = propagator.place(&[1.0, 1.0, 0.0]);
    let mut place = from.clone();
    let begun = Instant::now();
    for _ in 0..CALLS {
        place.copy_from_slice(&from);
        for _ in 0..10 {
            propagator.advance(&mut place, black_box(&[0.5, 0.3]));
        }
        black_box(&place);
    }
    f64::from(CALLS) / begun.elapsed().as_secs_f64()
}

/// What one planner did over all seeds.
#[derive(Default)]
struct Runs {
    seconds: Vec<f64>,
    rates: Vec<f64>,
    durations: Vec<f64>,
    failed: usize,
}

impl Runs {
    fn add(&mut self, seconds: f64, steps: f64, duration: Option<f64>) {
        self.seconds.push(seconds);
        self.rates.push(steps / seconds);
        match duration {
            Some(duration) => self.durations.push(duration),
            None => self.failed += 1,
        }
    }

    fn print(&mut self, name: &str) -> f64 {
        let mean = self.seconds.iter().sum::<f64>() / self.seconds.len() as f64;
        let middle = median(&mut self.seconds);
        let length = if self.durations.is_empty() {
            f64::NAN
        } else {
            median(&mut self.durations)
        };
        println!(
            "{name:<34} {:>9.0} steps/s, median {:.2} ms, mean {:.2} ms, path {length:.2} s, {} without a path",
            median(&mut self.rates),
            middle * 1e3,
            mean * 1e3,
            self.failed
        );
        middle
    }
}

fn ours(room: &mut impl Surroundings, method: Method, attempts: u32, seeds: u64) -> Runs {
    let mut runs = Runs::default();
    for seed in 1..=seeds {
        let (seconds, outcome) = timed(room, &options(seed, method, attempts));
        let duration = outcome.path.map(|path| path.duration());
        runs.add(seconds, outcome.counts.steps as f64, duration);
    }
    runs
}

/// The program of OMPL and where its libraries are, if it can be built.
fn ompl() -> Result<(PathBuf, PathBuf), String> {
    let root = std::env::var_os("OMPL_ROOT").map_or_else(|| PathBuf::from("/"), PathBuf::from);
    let headers = [
        "usr/include/ompl-1.5",
        "usr/include/ompl-1.6",
        "usr/include",
    ]
    .map(|path| root.join(path))
    .into_iter()
    .find(|path| path.join("ompl/control/SimpleSetup.h").exists())
    .ok_or("no headers of OMPL (libompl-dev)")?;
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/ompl/rrt.cpp");
    let program = std::env::temp_dir().join(format!("trik-ompl-rrt-{}", std::process::id()));
    let lib = root.join("usr/lib/x86_64-linux-gnu");
    let built = Command::new("g++")
        .args(["-std=c++17", "-O2", "-w", "-DNDEBUG", "-I"])
        .arg(&headers)
        .arg("-I")
        .arg(root.join("usr/include/eigen3"))
        .arg("-I")
        .arg(root.join("usr/include"))
        .arg(&source)
        .arg("-o")
        .arg(&program)
        .arg("-L")
        .arg(&lib)
        .args([
            "-Wl,--allow-shlib-undefined",
            "-lompl",
            "-lboost_serialization",
        ])
        .output()
        .map_err(|error| format!("g++: {error}"))?;
    if built.status.success() {
        Ok((program, lib))
    } else {
        let told = String::from_utf8_lossy(&built.stderr).into_owned();
        Err(told.lines().take(5).collect::<Vec<_>>().join("\n"))
    }
}

/// One round of OMPL: its runs, and propagations per second.
fn theirs(program: &Path, lib: &Path) -> (Runs, f64) {
    let output = Command::new(program)
        .arg(SEEDS.to_string())
        .env("LD_LIBRARY_PATH", lib)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut runs = Runs::default();
    let mut rate = f64::NAN;
    for line in text.lines() {
        let numbers: Vec<f64> = line
            .split(' ')
            .skip(1)
            .map(|word| word.parse().unwrap())
            .collect();
        match numbers.as_slice() {
            [seconds, steps, found, duration] => {
                runs.add(*seconds, *steps, (*found == 1.0).then_some(*duration));
            }
            [propagations] => rate = *propagations,
            _ => panic!("{line}"),
        }
    }
    (runs, rate)
}

fn main() {
    let wall = Shape::Wall([2.0, 0.0], [2.0, 2.4], 0.05);
    let obstacles = Obstacles::new(vec![wall], Some([0.0, 0.0, 4.0, 3.0])).unwrap();
    let footprint = Footprint::circle(0.15).unwrap();
    let parts = Parts {
        x: 0,
        y: 1,
        heading: Some(2),
    };
    let mut room = Room::new(&obstacles, &footprint, parts, 0.02).unwrap();
    let sst = Method::Sst {
        selection: 0.3,
        pruning: 0.1,
    };
    let program = ompl();
    if let Err(why) = &program {
        println!("OMPL does not take part: {why}");
    }
    let (mut bares, mut bare_ratios, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    for round in 1..=ROUNDS {
        println!("round {round}");
        let bare = bare();
        bares.push(bare);
        println!(
            "{:<34} {bare:>9.0} propagations of 10 steps per second",
            "solver alone"
        );
        let mine = ours(&mut room, Method::Rrt, 1, SEEDS).print("RRT, one action for a sample");
        if let Ok((program, lib)) = &program {
            let (mut runs, rate) = theirs(program, lib);
            println!(
                "{:<34} {rate:>9.0} propagations of 10 steps per second",
                "ODEBasicSolver of OMPL alone"
            );
            let middle = runs.print("RRT of OMPL");
            bare_ratios.push(bare / rate);
            ratios.push(middle / mine);
        }
        ours(&mut room, Method::Rrt, 4, SEEDS).print("RRT, best of 4 actions");
        ours(&mut Anywhere, Method::Rrt, 1, SEEDS).print("RRT, nothing in the way");
        ours(&mut room, sst, 1, 5).print("SST, 50000 samples");
    }
    println!(
        "solver alone, median: {:.0} propagations/s",
        median(&mut bares)
    );
    if !ratios.is_empty() {
        println!(
            "against OMPL, median of the rounds: propagation {:.1} times as fast, a path {:.1} times as soon",
            median(&mut bare_ratios),
            median(&mut ratios)
        );
    }
    if let Ok((program, _)) = program {
        let _ = std::fs::remove_file(program);
    }
}
