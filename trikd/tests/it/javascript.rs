//! JavaScript programs, one file each in `trikd/tests/js`, with what they must say after them.
//!
//! Lines at the end of a program: `//<` is a file of the tree and its text, `//>` a line of output, `//!` a line of
//! standard error, `//=` a file of the tree and what it must have at the end. FOLDER stands for the program's directory, TREE for
//! that of the tree.

use harness::put;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;
use tempfile::{TempDir, tempdir};

/// Only against hanging.
const LONG: Duration = Duration::from_secs(120);

/// A plain directory instead of the tree.
pub fn tree(scratch: &TempDir) {
    fill(scratch.path());
}

/// Files of a tree with all that a robot can have.
pub fn fill(folder: &Path) {
    let files = [
        ("status", ""),
        ("sensors/A1/value", "42\n"),
        ("sensors/A1/raw", "172\n"),
        ("sensors/A2/value", "1\n"),
        ("sensors/D1/value", "30\n"),
        ("sensors/D1/raw", "30 1700\n"),
        ("encoders/E1/value", "90\n"),
        ("encoders/E1/raw", "300\n"),
        ("encoders/E3/value", "5\n"),
        ("servos/S1/value", ""),
        ("servos/S1/units", "deg\n"),
        ("servos/S1/power", ""),
        ("servos/S3/duty_cycle", "7\n"),
        ("servos/S3/raw", "50 50 51\n"),
        ("display/device", ""),
        ("battery/value", "7.4\n"),
        ("battery/raw", "500\n"),
        ("accelerometer/value", "1 2 1000\n"),
        ("gyroscope/value", "10 20 30\n"),
        ("gyroscope/tilt", "1 2\n"),
        ("gyroscope/heading", "170000\n"),
        ("ir_camera/value", "1 2 3 4 5 6 0 1 2\n"),
        ("keys/value", "0 1 0 0 0 0 0\n"),
        ("led/green/value", ""),
        ("led/red/value", ""),
        ("sound/play/value", ""),
        ("sound/say/value", ""),
        ("sound/tone/value", ""),
        ("camera/line/value", "5 10 20\n"),
        ("camera/line/hsv", "1 2 3 4 5 6\n"),
        ("camera/line/detect", ""),
        ("camera/line/video_out", ""),
        ("camera/color/value", "1 2 3 4 5 66051 7 8 9\n"),
        ("camera/color/hsv", ""),
        ("camera/color/video_out", ""),
        ("gamepad/pad1/value", "10 -20 1\n"),
        ("gamepad/pad2/value", "0 0 0\n"),
        ("gamepad/wheel/value", "30\n"),
        ("gamepad/buttons/value", "0 1 0 0 0\n"),
        (
            "gamepad/text/device",
            "pad 1 10 -20\nbtn 3 down\nkeepalive 4000\n",
        ),
    ];
    for (name, text) in files {
        put(folder, name, text);
    }
    for port in ["M1", "M3", "M4"] {
        put(folder, &format!("motors/{port}/value"), "");
        put(folder, &format!("motors/{port}/brake"), "");
    }
    put(folder, "lidar/value", "7 ".repeat(360));
}

/// The lines of the program that begin with a mark.
fn marked<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines()
        .filter_map(move |line| line.strip_prefix(mark))
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
}

/// A program in a process of its own.
pub fn run(tree: &Path, program: &Path) -> Output {
    let mut child = Command::new(crate::rig::trikd())
        .arg("js")
        .arg("--tree")
        .arg(tree)
        .arg(program)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let (mut out, mut err) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
    let gather = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        err.read_to_end(&mut bytes).map(|_| bytes).unwrap()
    });
    let id = nix::unistd::Pid::from_raw(i32::try_from(child.id()).unwrap());
    let (done, wait) = std::sync::mpsc::channel::<()>();
    let guard = std::thread::spawn(move || {
        if wait.recv_timeout(LONG) == Err(std::sync::mpsc::RecvTimeoutError::Timeout) {
            let _ = nix::sys::signal::kill(id, nix::sys::signal::Signal::SIGKILL);
        }
    });
    let mut stdout = Vec::new();
    out.read_to_end(&mut stdout).unwrap();
    let stderr = gather.join().unwrap();
    let status = child.wait().unwrap();
    drop(done);
    guard.join().unwrap();
    Output {
        status,
        stdout,
        stderr,
    }
}

/// What is wrong with one program.
fn complaints(path: &Path) -> Vec<String> {
    let name = path.file_stem().unwrap().to_string_lossy();
    let text = fs::read_to_string(path).unwrap();
    let scratch = tempdir().unwrap();
    tree(&scratch);
    for line in marked(&text, "//<") {
        let (file, content) = line.split_once(' ').unwrap_or((line, ""));
        put(scratch.path(), file, format!("{content}\n"));
    }
    let own = text.lines().take_while(|line| {
        !["//<", "//>", "//!", "//="]
            .iter()
            .any(|mark| line.starts_with(mark))
    });
    let own: Vec<_> = own.collect();
    let program = put(
        scratch.path(),
        &format!("scripts/{name}.js"),
        own.join("\n") + "\n",
    );
    let folder = program.parent().unwrap().to_str().unwrap().to_owned();
    let output = run(scratch.path(), &program);
    let tree = scratch.path().to_str().unwrap().to_owned();
    let said = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes).replace(&folder, "FOLDER");
        text.replace(&tree, "TREE")
    };
    let wanted = |mark| {
        marked(&text, mark)
            .map(|line| format!("{line}\n"))
            .collect::<String>()
    };
    let mut complaints = Vec::new();
    let mut check = |what: &str, wanted: &str, found: &str| {
        if wanted.trim_end() != found.trim_end() {
            complaints.push(format!("{name}: {what}:\n{found}--- instead of\n{wanted}"));
        }
    };
    check("output", &wanted("//>"), &said(&output.stdout));
    let errors = said(&output.stderr).replace("trikd: ", "");
    check("errors", &wanted("//!"), &errors);
    let fails = marked(&text, "//!").any(|line| !line.starts_with("info: "));
    check(
        "success",
        &(!fails).to_string(),
        &output.status.success().to_string(),
    );
    for line in marked(&text, "//=") {
        let (file, content) = line.split_once(' ').unwrap_or((line, ""));
        let found = fs::read_to_string(scratch.path().join(file)).unwrap_or_default();
        // A plain file keeps what was longer before.
        let found = found.lines().next().unwrap_or_default();
        check(file, content, found);
    }
    complaints
}

#[test]
fn programs_say_and_do_what_stands_behind_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/js");
    let mut programs: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    programs.sort();
    assert!(programs.len() >= 40, "only {} programs", programs.len());
    let found: Vec<_> = programs.iter().flat_map(|path| complaints(path)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}
