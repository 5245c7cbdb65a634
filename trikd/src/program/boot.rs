//! The program that runs by itself after the start, unless somebody or experience says no.
//!
//! Owns the count of starts that did not go well: a program that takes the robot down, with its power or with trikd, is
//! not run again and again.

use super::{Command, Programs};
use crate::sampler::Sampler;
use crate::{limits, log, scripts};
use std::fmt;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;
use tokio::time::sleep;

/// Names of such a program, the first that is there counts.
const NAMES: [&str; 4] = ["autorun.js", "autorun.py", "autorun.qrs", "autorun"];
/// A file of this name in the folder of programs keeps them from running.
const SKIP: &str = "no-autorun";

/// Why a program that is there is not run; the person who looks after the robot can change that.
#[derive(Clone, Debug, Eq, PartialEq)]
enum Reason {
    /// A file in this folder says no.
    Skip(PathBuf),
    /// trikd has crashed.
    Crash,
    /// So many starts with it did not last.
    Starts(u32),
}

/// A program that is not run, and why.
#[derive(Clone, Debug, Eq, PartialEq)]
struct NotRun(PathBuf, Reason);

impl fmt::Display for NotRun {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} is not run: ", self.0.display())?;
        match &self.1 {
            Reason::Skip(folder) => {
                write!(out, "there is a file {SKIP} in {}", folder.display())
            }
            Reason::Crash => out.write_str("trikd has been started again after a crash"),
            Reason::Starts(count) => write!(
                out,
                "the last {count} starts with it did not last: run it by hand to have it run again"
            ),
        }
    }
}

/// Starts that were begun and have not turned out well.
fn begun(file: &Path) -> u32 {
    std::fs::read_to_string(file)
        .ok()
        .and_then(|text| text.trim().parse().ok())
        .unwrap_or(0)
}

/// The program to run, or why none is run; None: there is none.
fn choose(folder: &Path, count: u32, restarts: u32) -> Option<Result<PathBuf, NotRun>> {
    let path = NAMES
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file())?;
    let why = if folder.join(SKIP).exists() {
        Reason::Skip(folder.to_owned())
    } else if restarts > 0 {
        Reason::Crash
    } else if count >= limits::AUTORUN_TRIES {
        Reason::Starts(count)
    } else {
        return Some(Ok(path));
    };
    Some(Err(NotRun(path, why)))
}

/// What the start works with.
#[derive(Debug)]
pub struct Autorun {
    /// The folder of programs.
    pub scripts: PathBuf,
    /// Where starts are counted.
    pub state: PathBuf,
    /// What the robot senses: a key that is held down.
    pub sampler: Rc<Sampler>,
    /// The part that runs programs.
    pub programs: Rc<Programs>,
}

/// Runs the program some time after the start. `restarts`: how often trikd was started again after crashes.
pub async fn autorun(parts: Autorun, restarts: u32) {
    let file = parts.state.join("autorun-starts");
    sleep(Duration::from_millis(limits::AUTORUN_MS)).await;
    let count = begun(&file);
    let path = match choose(&parts.scripts, count, restarts) {
        None => return,
        Some(Ok(path)) => path,
        Some(Err(why)) => return tracing::warn!(target: log::PROGRAMS, "{why}"),
    };
    if parts.sampler.snapshot().await.keys.contains(&true) {
        return tracing::warn!(
            target: log::PROGRAMS,
            "{} is not run: a key is held down",
            path.display()
        );
    }
    if parts.programs.runs() {
        return tracing::warn!(
            target: log::PROGRAMS,
            "{} is not run: another program runs already",
            path.display()
        );
    }
    let note = |count: u32| {
        if let Err(error) = scripts::replace(&file, format!("{count}\n").as_bytes(), 0o600) {
            tracing::warn!(target: log::DAEMON, "{}: {error}", file.display());
        }
    };
    note(count + 1);
    parts.programs.send(Command::Run(path, None)).await;
    // The robot has survived this long, so the program is not what takes it down.
    sleep(Duration::from_millis(limits::AUTORUN_PROOF_MS)).await;
    note(0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::put;
    use tempfile::tempdir;

    #[test]
    fn a_program_that_took_the_robot_down_is_not_run_for_ever() {
        let scratch = tempdir().unwrap();
        let folder = scratch.path();
        assert!(choose(folder, 0, 0).is_none());
        let path = put(scratch.path(), "autorun.py", "");
        assert_eq!(choose(folder, limits::AUTORUN_TRIES - 1, 0), Some(Ok(path)));
        let why = |count, restarts| choose(folder, count, restarts).unwrap().unwrap_err();
        let told = why(limits::AUTORUN_TRIES, 0);
        assert!(told.to_string().contains("did not last"), "{told}");
        assert!(why(0, 1).to_string().contains("after a crash"));
        put(scratch.path(), SKIP, "");
        assert!(why(0, 0).to_string().contains(SKIP));
        assert_eq!(begun(&put(scratch.path(), "count", "2\n")), 2);
        assert_eq!(begun(&put(scratch.path(), "count", "many")), 0);
    }
}
