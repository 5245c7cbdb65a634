//! Programs of users (a shell, Python, the program under test itself) with a deadline.
//!
//! Owns their process groups: one that hangs is killed with everything it started, and the test fails.

use crate::processes;
use crate::wait::SOON;
use nix::sys::signal::Signal;
use std::ffi::OsStr;
use std::io::Write;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::Duration;

/// Writes a file below a folder, with the folders that it needs; its path.
///
/// # Panics
/// It cannot be written.
pub fn put(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
    std::fs::write(&path, content).expect("a file");
    path
}

/// What a program said and how it ended.
#[derive(Debug)]
pub struct Output {
    /// How it ended.
    pub status: ExitStatus,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Output {
    /// Exit code; a signal counts as 128 and its number, as in a shell.
    pub fn code(&self) -> i32 {
        let signal = self.status.signal().map(|number| 128 + number);
        self.status.code().or(signal).unwrap_or(-1)
    }

    /// Standard output of a program that succeeded.
    ///
    /// # Panics
    /// It did not.
    pub fn good(self) -> String {
        assert!(
            self.status.success(),
            "ended with {}:\n{}{}",
            self.status,
            self.stdout,
            self.stderr
        );
        self.stdout
    }
}

/// The C compiler whose code the program under test can load: `$CC`, else `cc`.
pub fn c_compiler() -> String {
    std::env::var("CC").unwrap_or_else(|_| "cc".to_owned())
}

/// Runs a command to its end with `input` on standard input.
///
/// # Panics
/// It does not start, or does not end within the suite's limit for one program.
pub fn run(command: &mut Command, input: &[u8]) -> Output {
    run_within(command, input, SOON)
}

/// The same with another limit.
///
/// # Panics
/// As [`run`].
pub fn run_within(command: &mut Command, input: &[u8], limit: Duration) -> Output {
    command
        .process_group(0)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command
        .spawn()
        .unwrap_or_else(|error| panic!("{}: {error}", shown(command)));
    let pid = child.id();
    let stdin = child.stdin.take();
    let (ended, end) = channel();
    let input = input.to_vec();
    std::thread::spawn(move || {
        // A program that does not want its input is no failure.
        let _ = stdin.map(|mut stdin| stdin.write_all(&input));
    });
    std::thread::spawn(move || ended.send(child.wait_with_output()));
    let (late, output) = match end.recv_timeout(limit) {
        Ok(output) => (false, output),
        Err(_) => {
            processes::signal_group(pid, Signal::SIGKILL);
            let output = end.recv_timeout(SOON);
            (
                true,
                output.unwrap_or_else(|_| panic!("{}: cannot be killed", shown(command))),
            )
        }
    };
    let output = output.unwrap_or_else(|error| panic!("{}: {error}", shown(command)));
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    assert!(
        !late,
        "{} did not end within {limit:?}:\n{stdout}{stderr}",
        shown(command)
    );
    Output {
        status: output.status,
        stdout,
        stderr,
    }
}

/// Variable with the script that `prelude.py` runs.
const SCRIPT: &str = "TRIK_SCRIPT";

/// A command as a failure shows it: the script, or the words.
fn shown(command: &Command) -> String {
    let script = command.get_envs().find(|(name, _)| *name == SCRIPT);
    if let Some((_, Some(script))) = script {
        return format!("python:\n{}\n", script.to_string_lossy());
    }
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    words.join(" ")
}

/// The real interpreter: a launcher script in front of it would cost every test a tenth of a second.
pub fn python_program() -> &'static Path {
    static FOUND: OnceLock<PathBuf> = OnceLock::new();
    FOUND.get_or_init(|| {
        let asked = Command::new("python3")
            .args(["-c", "import sys; print(sys.executable)"])
            .output();
        let asked = asked.expect("python3, which many tests are written for");
        PathBuf::from(String::from_utf8_lossy(&asked.stdout).trim())
    })
}

/// A shell that runs a script.
pub fn shell(script: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new("/bin/sh");
    command.arg("-c").arg(script);
    command
}

/// Python with the helpers of `prelude.py` that runs a script.
pub fn python(script: &str) -> Command {
    let mut command = Command::new(python_program());
    command.args(["-S", "-E", "-c", include_str!("prelude.py")]);
    command.env(SCRIPT, script);
    command
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn input_output_and_code_pass_through() {
        let output = run(&mut shell("cat; echo problem >&2; exit 3"), b"words");
        assert_eq!(
            (
                output.stdout.as_str(),
                output.stderr.as_str(),
                output.code()
            ),
            ("words", "problem\n", 3)
        );
        assert_eq!(run(&mut shell("kill -9 $$"), b"").code(), 137);
    }

    #[test]
    #[should_panic(expected = "did not end within")]
    fn a_program_that_hangs_is_killed_with_its_children() {
        run_within(
            &mut shell("sleep 1000 & sleep 1000"),
            b"",
            Duration::from_millis(50),
        );
    }
}
