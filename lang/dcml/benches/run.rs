//! How fast models of DCML run, beside C by hand, SciPy and OMPL: one state at a time, many, and whole propagations.
//!
//! `cargo bench -p lang-dcml --bench run`. Needs `cc`; TRIK_NUMPY_PYTHON names an interpreter that has scipy and ompl, and what it
//! does not have is left out. All figures are ratios of times of the processor in one run; above 1 we are faster.

use lang_dcml::robot::Robot;
use lang_dcml::solve::propagate::Propagator;
use lang_dcml::system::System;
use lang_dcml::{models, understand};
use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

const STATES: usize = 1024;
/// So many that ticks of the clock of the processor do not matter.
const PASSES: u32 = 4000;
const ROUNDS: u32 = 3;

type Times = BTreeMap<String, f64>;

/// How long this thread has had a processor; wall time where Linux does not tell, so that others' work counts too.
fn now(begin: Instant) -> Duration {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ran = told.split(' ').next().and_then(|text| text.parse().ok());
    ran.map_or_else(|| begin.elapsed(), Duration::from_nanos)
}

/// Keeps the best time of a piece of work, in ns for each of its parts.
fn measure(times: &mut Times, name: &str, parts: u32, mut work: impl FnMut()) {
    let origin = Instant::now();
    let begin = now(origin);
    work();
    let taken = (now(origin) - begin).as_secs_f64() * 1e9 / f64::from(parts);
    keep(times, name, taken);
}

fn keep(times: &mut Times, name: &str, taken: f64) {
    let best = times.entry(name.to_owned()).or_insert(f64::INFINITY);
    *best = best.min(taken);
}

/// Runs a program that prints names and times.
fn ask(times: &mut Times, command: &mut Command) {
    match command.output() {
        Ok(output) => {
            for line in String::from_utf8_lossy(&output.stdout).lines() {
                if let Some((name, Ok(taken))) = line.split_once(' ').map(|(a, b)| (a, b.parse())) {
                    keep(times, name, taken);
                }
            }
            if times.is_empty() {
                println!("{}", String::from_utf8_lossy(&output.stderr));
            }
        }
        Err(error) => println!("{command:?}: {error}"),
    }
}

fn robot(name: &str, params: &[f64]) -> Option<Robot> {
    let text = models::named(name)?.text;
    Robot::new(understand(text).models.first()?, params).ok()
}

/// Rows of numbers, as many as there are states.
fn rows(count: usize, scale: f64) -> Vec<f64> {
    (0..count * STATES)
        .map(|at| (at as f64).sin() * scale)
        .collect()
}

fn derivatives(times: &mut Times, name: &str, mut robot: Robot) {
    let (n, m) = (robot.states(), robot.actions());
    let (states, actions) = (rows(n, 3.0), rows(m, 1.0));
    let mut rates = vec![0.0; n * STATES];
    let parts = PASSES * STATES as u32;
    measure(times, &format!("our-{name}"), parts, || {
        for _ in 0..PASSES {
            let given = states.chunks_exact(n).zip(actions.chunks_exact(m));
            for ((state, action), rate) in given.zip(rates.chunks_exact_mut(n)) {
                robot.derivative(state, action, rate);
            }
            black_box(&mut rates);
        }
    });
    let Ok(mut batch) = robot.batch() else { return };
    measure(times, &format!("our-{name}-batch"), parts, || {
        for _ in 0..PASSES {
            batch.run(STATES, &states, &actions, &mut rates);
            black_box(&mut rates);
        }
    });
}

fn propagations(times: &mut Times, mut robot: Robot) {
    let (mut states, actions) = (rows(3, 3.0), rows(2, 1.0));
    let passes = PASSES / 40;
    let parts = passes * STATES as u32;
    let mut propagator = Propagator::new();
    measure(times, "our-propagation", parts, || {
        for _ in 0..passes {
            for (state, action) in states.chunks_exact_mut(3).zip(actions.chunks_exact(2)) {
                black_box(propagator.run(&mut robot, state, action, 1.0, 10));
            }
        }
    });
    let Ok(mut batch) = robot.batch() else { return };
    measure(times, "our-propagation-batch", parts, || {
        for _ in 0..passes {
            black_box(propagator.batch(&mut batch, STATES, &mut states, &actions, 1.0, 10));
        }
    });
}

fn main() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches");
    let program = std::env::temp_dir().join(format!("dcml-run.{}", std::process::id()));
    let mut compiler = Command::new("cc");
    compiler
        .args(["-O2", "-o"])
        .arg(&program)
        .arg(here.join("run.c"))
        .arg("-lm");
    if !compiler.status().is_ok_and(|status| status.success()) {
        println!("skipped: no cc");
        return;
    }
    let mut times = Times::new();
    for _ in 0..ROUNDS {
        ask(&mut times, &mut Command::new(&program));
        for (name, model, params) in [
            ("drive", "differential-drive", &[0.4, 0.1][..]),
            ("bart", "bart", &[0.2, 0.1, 0.05]),
        ] {
            if let Some(robot) = robot(model, params) {
                derivatives(&mut times, name, robot);
            }
        }
        if let Some(robot) = robot("differential-drive", &[0.4, 0.1]) {
            propagations(&mut times, robot);
        }
    }
    let _ = std::fs::remove_file(&program);
    let python = std::env::var_os("TRIK_NUMPY_PYTHON").unwrap_or_else(|| "python3".into());
    ask(
        &mut times,
        Command::new(python).arg(here.join("run_peers.py")),
    );
    println!("{:<24}{:<24}{:>8}", "we", "they", "ratio");
    for (ours, theirs) in [
        ("our-drive", "drive"),
        ("our-bart", "bart"),
        ("our-drive-batch", "drive"),
        ("our-bart-batch", "bart"),
        ("our-propagation", "propagation"),
        ("our-propagation-batch", "propagation"),
        ("our-propagation", "scipy-odeint"),
        ("our-propagation", "scipy-rk45"),
        ("our-propagation", "ompl-basic"),
    ] {
        match (times.get(ours), times.get(theirs)) {
            (Some(our), Some(their)) => println!("{ours:<24}{theirs:<24}{:>8.2}", their / our),
            _ => println!("{ours:<24}{theirs:<24} skipped"),
        }
    }
    if let Some(one) = times.get("our-propagation") {
        println!("propagations of one robot in a second: {:.0}", 1e9 / one);
    }
}
