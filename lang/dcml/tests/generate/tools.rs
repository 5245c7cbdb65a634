//! The tools of other languages: found, or skipped by name; run with their complaints shown.

use needs::Need;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Whether a file that comes with a tool is there; if not, the test is skipped.
pub fn has_file(path: &str) -> bool {
    is_there(path, Path::new(path).exists())
}

fn is_there(what: &str, is_there: bool) -> bool {
    if !is_there {
        Need::Tools.missing(format_args!("no {what}"));
    }
    is_there
}

/// A new empty folder for the files of one test.
pub fn scratch(test: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("dcml-{test}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Runs a command in a folder; its standard output. Whatever it complains of fails the test.
pub fn run(folder: &Path, words: &[&str]) -> String {
    let output = Command::new(words[0])
        .args(&words[1..])
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap_or_else(|error| panic!("{words:?}: {error}"));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && told.is_empty(),
        "in {}: {words:?}: {}\n{told}{}",
        folder.display(),
        output.status,
        String::from_utf8_lossy(&output.stdout)
            .chars()
            .take(2000)
            .collect::<String>()
    );
    String::from_utf8(output.stdout).unwrap()
}

/// A Python that has NumPy: the one of `.ci/run`, or the system's.
pub fn python() -> Option<String> {
    let python = std::env::var("TRIK_NUMPY_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut command = Command::new(&python);
    let has_numpy = command.args(["-c", "import numpy, scipy"]).output();
    let is_good = has_numpy.is_ok_and(|output| output.status.success());
    is_there("python3 with numpy and scipy", is_good).then_some(python)
}
