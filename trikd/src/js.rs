//! JavaScript: QuickJS, one engine for each thread of a program, and the robot as its objects.
//!
//! Owns what TRIK programs know: the names, the old dialect's texts of errors, the rule about `main`. The scripts in
//! `trikd/js` are the objects; `natives` is what they stand on. `session` is the process, `machine` one engine.

pub mod events;
pub mod failure;

pub mod machine;
pub mod natives;
pub mod outside;
pub mod platform;
pub mod session;
pub mod shared;
pub mod source;
pub mod wording;

use crate::brick::Brick;
use crate::engine::{Engine, Outcome, Start};
use crate::host::Host;
use crate::limits;
use outside::{Alone, Daemon, Terminal};
use std::io::Read;
use std::path::Path;

/// Runs JavaScript.
#[derive(Debug, Default)]
pub struct JavaScript;

impl Engine for JavaScript {
    fn run(&mut self, start: Start, brick: &Brick, host: &Host) -> Outcome {
        let daemon = Daemon::new(host);
        let output = daemon
            .output()
            .map_err(|error| format!("no way to the daemon: {error}"))?;
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
/// The text of the failure, as a daemon would show it behind `error: `.
pub fn run_alone(file: &Path, tree: &Path) -> Outcome {
    let file = std::path::absolute(file)
        .map_err(|error| format!("{}: where is it? {error}", file.display()))?;
    let outcome = session::run(
        Start::File(file),
        tree,
        &Alone::default(),
        Box::new(Terminal),
    );
    let brick = Brick::new(tree);
    if brick.tree().root().join("stop").exists() {
        let rested = brick.stop().map_err(|error| {
            format!(
                "{}/stop: the motors may still turn: {error}",
                tree.display()
            )
        });
        outcome.and(rested)
    } else {
        outcome
    }
}

/// Runs one line beside another program: nothing is brought to rest at its end.
///
/// # Errors
/// The text of the failure.
pub fn run_line(line: String, tree: &Path) -> Outcome {
    session::run(
        Start::Script(line),
        tree,
        &Alone::default(),
        Box::new(Terminal),
    )
}

/// The text of a program or of a file that it includes.
///
/// # Errors
/// Why it cannot be read, with its place.
pub fn read_text(path: &Path) -> Result<String, String> {
    let place = path.display();
    let file =
        std::fs::File::open(path).map_err(|error| format!("{place}: cannot be opened: {error}"))?;
    let mut bytes = Vec::new();
    file.take(limits::JS_FILE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| format!("{place}: cannot be read: {error}"))?;
    if bytes.len() as u64 > limits::JS_FILE_BYTES {
        return Err(format!(
            "{place}: longer than {} MiB",
            limits::JS_FILE_BYTES >> 20
        ));
    }
    // Editors of Windows put a mark in front.
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned())
}
