//! What tests need of the machine: found, or the test is skipped by name and counted. `random` gives them numbers.
//!
//! Owns the variables that demand a need (a skip is a failure then), and the file in which skips are counted:
//! `TRIK_SKIPS` names it. Knows no test and depends on no other crate.

mod random;

pub use random::Random;

use std::fmt::Display;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Names the file to which each skip adds a line.
const SKIPS: &str = "TRIK_SKIPS";
/// Skips of this process.
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// Something that a machine may lack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// `/dev/fuse` and the right to mount and to be other users; `TRIK_REQUIRE_FUSE=1` demands it.
    Fuse,
    /// Programs and languages that tests start; `TRIK_REQUIRE_TOOLS=1` demands them.
    Tools,
    /// Recorded runs and projects, `../shared/data` beside the checkout; `TRIK_REQUIRE_DATA=1` demands them.
    Data,
    /// The public library python-ev3dev2; `TRIK_REQUIRE_EV3DEV=1` demands it.
    Ev3dev,
    /// What no machine is asked to have: limits of a transport, packages that are too large for each run.
    Extra,
}

impl Need {
    fn variable(self) -> Option<&'static str> {
        match self {
            Self::Fuse => Some("TRIK_REQUIRE_FUSE"),
            Self::Tools => Some("TRIK_REQUIRE_TOOLS"),
            Self::Data => Some("TRIK_REQUIRE_DATA"),
            Self::Ev3dev => Some("TRIK_REQUIRE_EV3DEV"),
            Self::Extra => None,
        }
    }

    /// Says that the running test is skipped, and why; the caller returns then.
    ///
    /// # Panics
    /// If the need is demanded.
    pub fn missing(self, why: impl Display) {
        let name = test_name();
        let is_demanded = self
            .variable()
            .is_some_and(|variable| std::env::var(variable).is_ok_and(|value| value == "1"));
        assert!(!is_demanded, "{name} would be skipped: {why}");
        let count = 1 + COUNT.fetch_add(1, Ordering::Relaxed);
        // `println!` would be kept by the test harness, which shows it of tests that fail alone.
        let _ = std::io::stderr().write_all(told(count, &name, &why).as_bytes());
        if let Some(file) = std::env::var_os(SKIPS) {
            let package = std::env::var("CARGO_PKG_NAME").unwrap_or_default();
            note(Path::new(&file), &format!("{package} {name}: {why}\n"));
        }
    }
}

/// What a skip says: which one of this process it is, so that the last line has the count.
fn told(count: usize, name: &str, why: &dyn Display) -> String {
    format!("skipped ({count}): {name}: {why}\n")
}

/// Name of the running test.
pub fn test_name() -> String {
    std::thread::current().name().unwrap_or("main").to_owned()
}

/// The folder of recorded runs and real projects; none, and a skip, if it is not there.
///
/// # Panics
/// If it is demanded.
pub fn data() -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    if path.is_dir() {
        return Some(path.to_owned());
    }
    Need::Data.missing("no ../shared/data");
    None
}

/// Whether a program can be started; if not, the test is skipped.
///
/// # Panics
/// If tools are demanded.
pub fn tool(name: &str) -> bool {
    let answers = |word| Command::new(name).arg(word).output().is_ok();
    let is_there = answers("--version") || answers("-v");
    if !is_there {
        Need::Tools.missing(format_args!("no {name}"));
    }
    is_there
}

/// Adds one line: in one write, because tests run beside each other.
fn note(file: &Path, line: &str) {
    let opened = std::fs::File::options()
        .append(true)
        .create(true)
        .open(file);
    opened
        .and_then(|mut opened| opened.write_all(line.as_bytes()))
        .unwrap_or_else(|error| panic!("{}: {error}", file.display()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skips_are_lines_of_a_file() {
        // This crate depends on none, so not on `tempfile` either.
        let file = std::env::temp_dir().join(format!("needs-{}", std::process::id()));
        note(&file, "one\n");
        note(&file, "two\n");
        let text = std::fs::read_to_string(&file).unwrap();
        std::fs::remove_file(&file).unwrap();
        assert_eq!(text, "one\ntwo\n");
    }

    #[test]
    fn a_skip_says_which_one_of_the_process_it_is() {
        assert_eq!(
            told(3, "a test", &"no tool"),
            "skipped (3): a test: no tool\n"
        );
    }

    #[test]
    fn a_tool_that_is_there_skips_nothing() {
        assert!(tool("sh"));
        assert_eq!(test_name(), "tests::a_tool_that_is_there_skips_nothing");
    }
}
