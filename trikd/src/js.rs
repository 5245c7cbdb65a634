//! JavaScript: QuickJS, one engine for each thread of a program, and the robot as its objects.
//!
//! Owns what TRIK programs know: the names, the old dialect's texts of errors. The scripts in
//! `trikd/js` are the objects; `natives` is what they stand on. `session` is the process, `machine` one engine, `debug` what
//! a debugger can do with them.

pub mod debug;
pub mod events;
pub mod failure;
pub mod files;
pub mod machine;
pub mod natives;
pub mod outside;
pub mod platform;
pub mod session;
pub mod shared;
pub mod wording;

use crate::brick::Brick;
use crate::engine::{Engine, Failure, Outcome, Start};
use crate::host::Host;
use outside::{Alone, Daemon, Terminal};
use std::path::Path;

/// Runs JavaScript.
#[derive(Debug, Default)]
pub struct JavaScript;

impl Engine for JavaScript {
    fn run(&mut self, start: Start, brick: &Brick, host: &Host) -> Outcome {
        let daemon = Daemon::new(host);
        let output = daemon
            .output()
            .map_err(|error| Failure::NoWay(error.into()))?;
        session::run(start, brick.tree().root(), &daemon, Box::new(output))
    }
}

/// The engine of this build.
pub fn engine() -> impl Engine {
    JavaScript
}

/// Runs a program without a daemon: output goes to the terminal, and the mailbox knows only this robot.
///
/// # Errors
/// The failure, whose text a daemon would show after `error: `.
pub fn run_alone(file: &Path, tree: &Path) -> Outcome {
    let file = std::path::absolute(file)
        .map_err(|error| Failure::Nowhere(file.to_owned(), error.into()))?;
    let outcome = session::run(
        Start::File(file),
        tree,
        &Alone::default(),
        Box::new(Terminal),
    );
    let brick = Brick::new(tree);
    if brick.tree().root().join("stop").exists() {
        let rested = brick.stop();
        outcome.and(rested.map_err(|error| Failure::Stop(tree.to_owned(), error.into())))
    } else {
        outcome
    }
}

/// Runs one line beside another program: nothing is brought to rest at its end.
///
/// # Errors
/// The failure of the program.
pub fn run_line(line: String, tree: &Path) -> Outcome {
    session::run(
        Start::Script(line),
        tree,
        &Alone::default(),
        Box::new(Terminal),
    )
}
