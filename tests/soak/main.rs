//! The bench of reliability: everything at once for some minutes, on real mounts, and the figures of it.
//!
//! usage: `soak [--minutes N] [--seed N]`; see docs/maintainer/reliability.md for what the figures mean.
//!
//! One tree with known values, one trikd above it. Readers compare what they read, programs drive a motor, configurations
//! come and go, clients say rubbish, and every few seconds something is killed, stopped or made to fail. The motor must come
//! to rest, each caller must be answered, and nothing may grow.
//!
//! Owns the order and the verdict. Needs FUSE, the programs of the same build beside it, and `strace` for errors in the
//! place of system calls, which it does without.

mod faults;
mod figures;
mod load;
mod robot;

use figures::{Figures, Footprint};
use robot::Robot;
use std::fmt;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often it is said how far it is.
const REPORT: Duration = Duration::from_secs(10);
/// Time for threads, states and caches to be made before anything is compared.
const WARM_UP: Duration = Duration::from_secs(5);

struct Arguments {
    minutes: u64,
    seed: u32,
}

/// What is wrong with the command line.
enum Usage {
    Unknown(String),
    /// The option wants a number from 1 to this one.
    Number(String, u32),
}

impl fmt::Display for Usage {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(word) => {
                write!(out, "usage: soak [--minutes N] [--seed N], not {word}")
            }
            Self::Number(option, most) => write!(out, "{option} wants a number from 1 to {most}"),
        }
    }
}

impl Arguments {
    fn read() -> Result<Self, Usage> {
        let mut arguments = Self {
            minutes: 1,
            seed: std::process::id(),
        };
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let value = words.next();
            let number = |most: u32| {
                let value = value.as_deref().and_then(|text| text.parse().ok());
                value
                    .filter(|number| (1..=most).contains(number))
                    .ok_or_else(|| Usage::Number(word.clone(), most))
            };
            match word.as_str() {
                "--minutes" => arguments.minutes = number(24 * 60)?.into(),
                "--seed" => arguments.seed = number(u32::MAX)?,
                _ => return Err(Usage::Unknown(word)),
            }
        }
        Ok(arguments)
    }
}

fn main() -> ExitCode {
    let arguments = match Arguments::read() {
        Ok(arguments) => arguments,
        Err(why) => {
            eprintln!("soak: {why}");
            return ExitCode::from(2);
        }
    };
    println!("soak: {} min, --seed {}", arguments.minutes, arguments.seed);
    let Some(robot) = Robot::start() else {
        return ExitCode::from(2);
    };
    let robot = Arc::new(robot);
    let figures = run(&robot, &arguments);
    print!("{}", figures.table());
    match figures.verdict() {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("soak: {why}; the robot said last:\n{}", robot.words());
            ExitCode::FAILURE
        }
    }
}

fn run(robot: &Arc<Robot>, arguments: &Arguments) -> Arc<Figures> {
    let figures = Arc::new(Figures::new());
    let length = Duration::from_secs(60 * arguments.minutes);
    // Of the end, some time too.
    robot.mount.lasts(2 * length + Duration::from_secs(60));
    let mut threads = load::start(robot, &figures, arguments.seed);
    threads.push(faults::start(robot, &figures, arguments.seed));
    let begun = Instant::now();
    figures.pause(WARM_UP);
    figures.note_begin(Footprint::of(robot));
    while begun.elapsed() < length && !figures.is_over() {
        figures.pause(REPORT.min(length.saturating_sub(begun.elapsed())));
        println!("{:5} s: {}", begun.elapsed().as_secs(), figures.progress());
    }
    figures.end();
    for thread in threads {
        // A thread that panicked has said why, and found something.
        if thread.join().is_err() {
            figures.wrong("a thread of the bench panicked".to_owned());
        }
    }
    // What was opened is given back: a moment without anything.
    std::thread::park_timeout(Duration::from_secs(2));
    figures.note_end(Footprint::of(robot), begun.elapsed());
    figures
}
