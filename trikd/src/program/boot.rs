//! The program that runs by itself after the start, unless somebody or experience says no.
//!
//! Owns the count of starts that did not go well: a program that takes the robot down, with its power or with trikd, is
//! not run again and again.

use super::{Command, Programs};
use crate::sampler::Sampler;
use crate::{limits, log, scripts};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;
use tokio::time::sleep;

/// Names of such a program, the first that is there counts.
const NAMES: [&str; 3] = ["autorun.js", "autorun.py", "autorun"];
/// A file of this name in the folder of programs keeps them from running.
const SKIP: &str = "no-autorun";

/// Starts that were begun and have not turned out well.
fn begun(file: &Path) -> u32 {
    std::fs::read_to_string(file)
        .ok()
        .and_then(|text| text.trim().parse().ok())
        .unwrap_or(0)
}

/// The program to run, or why none is run; None: there is none.
fn choose(folder: &Path, count: u32, restarts: u32) -> Option<Result<PathBuf, String>> {
    let path = NAMES
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.is_file())?;
    let why = if folder.join(SKIP).exists() {
        format!("there is a file {SKIP} in {}", folder.display())
    } else if restarts > 0 {
        "trikd has been started again after a crash".to_owned()
    } else if count >= limits::AUTORUN_TRIES {
        format!("the last {count} starts with it did not last: run it by hand to have it run again")
    } else {
        return Some(Ok(path));
    };
    Some(Err(format!("{} is not run: {why}", path.display())))
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
    /// Whoever runs programs.
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
    parts.programs.send(Command::Run(path)).await;
    // The robot has survived this long, so the program is not what takes it down.
    sleep(Duration::from_millis(limits::AUTORUN_PROOF_MS)).await;
    note(0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn a_program_that_took_the_robot_down_is_not_run_for_ever() {
        let scratch = Scratch::new("boot");
        let folder = scratch.path();
        assert!(choose(folder, 0, 0).is_none());
        let path = scratch.file("autorun.py", "");
        assert_eq!(choose(folder, limits::AUTORUN_TRIES - 1, 0), Some(Ok(path)));
        let why = |count, restarts| choose(folder, count, restarts).unwrap().unwrap_err();
        assert!(why(limits::AUTORUN_TRIES, 0).contains("did not last"));
        assert!(why(0, 1).contains("after a crash"));
        scratch.file(SKIP, "");
        assert!(why(0, 0).contains(SKIP));
        assert_eq!(begun(&scratch.file("count", "2\n")), 2);
        assert_eq!(begun(&scratch.file("count", "many")), 0);
    }
}
