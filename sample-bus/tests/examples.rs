//! The examples, run as a newcomer would run them: each follows a ring that this test publishes.

use sample_bus::place::{self, Directory};
use sample_bus::{Event, Writer};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder that stands for a mount point, with a ring for its node `sensors/A1`.
struct Stage {
    mountpoint: PathBuf,
    writer: Option<Writer>,
    _directory: Directory,
}

impl Stage {
    fn new(name: &str) -> Self {
        let mountpoint =
            std::env::temp_dir().join(format!("samples {name}+{}", std::process::id()));
        std::fs::create_dir(&mountpoint).unwrap();
        let shared_memory = Path::new(place::SHARED_MEMORY);
        let path = place::directory(shared_memory, &mountpoint.canonicalize().unwrap()).unwrap();
        let directory = Directory::take(&path, 0o755).unwrap();
        let file = path.join(place::file_name("sensors/A1").unwrap());
        Self {
            mountpoint,
            writer: Some(Writer::create(&file, 4, 0o444).unwrap()),
            _directory: directory,
        }
    }

    fn publish(&mut self, time_ns: u64) {
        let writer = self.writer.as_mut().unwrap();
        writer.publish(time_ns, &time_ns.to_be_bytes()[4..]);
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir(&self.mountpoint);
    }
}

/// All followers print the same, so that one check is enough for all languages.
fn check(name: &str, mut command: Command) {
    let mut stage = Stage::new(name);
    for time_ns in 1..=20 {
        stage.publish(time_ns);
    }
    let writer = stage.writer.as_mut().unwrap();
    writer.fail(21, libc::ENODEV);
    stage.publish(22);
    let mut follow = |count: &str| {
        let words = [
            stage.mountpoint.as_os_str(),
            "sensors/A1".as_ref(),
            count.as_ref(),
        ];
        let output = command.args(words).output();
        let output = output.unwrap_or_else(|error| panic!("{command:?}: {error}"));
        let text = String::from_utf8(output.stdout).unwrap();
        let complaint = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{text}{complaint}");
        text
    };
    let text = follow("15");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 15, "{text}");
    assert_eq!(lines.first(), Some(&"8 8 00000008"), "{text}");
    assert!(
        lines[13].starts_with("21 ") && lines[13].contains("error No such device"),
        "{text}"
    );
    assert_eq!(lines[14], "22 22 00000016");
    assert_no_node(&stage, command);
}

/// A node that is not there is an error with its name, and one that goes is told.
fn assert_no_node(stage: &Stage, mut command: Command) {
    let program = command.get_program().to_owned();
    let first = command.get_args().next().map(ToOwned::to_owned);
    let script = first.filter(|word| word.to_string_lossy().ends_with(".py"));
    command = Command::new(program);
    command
        .args(script)
        .arg(&stage.mountpoint)
        .arg("sensors/A2");
    let output = command.output().unwrap();
    assert!(!output.status.success());
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(complaint.contains("No such file"), "{complaint}");
}

#[test]
fn rust() {
    // Examples stand beside the folder of the tests.
    let mut path = std::env::current_exe().unwrap();
    path.pop();
    path.pop();
    path.push("examples/follow");
    assert!(
        path.exists(),
        "{}: build it with `cargo build -p sample-bus --examples`",
        path.display()
    );
    check("rust", Command::new(path));
}

#[test]
fn c() {
    let cc = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let program = std::env::temp_dir().join(format!("follow-{}", std::process::id()));
    let mut compiler = Command::new(cc);
    compiler.args([
        "-std=c99",
        "-D_GNU_SOURCE",
        "-O2",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-o",
    ]);
    compiler
        .arg(&program)
        .arg("-I")
        .arg(folder().join("include"));
    let compiled = compiler
        .arg(folder().join("examples/follow.c"))
        .output()
        .unwrap();
    assert!(
        compiled.status.success(),
        "{}",
        String::from_utf8_lossy(&compiled.stderr)
    );
    check("c", Command::new(&program));
    std::fs::remove_file(program).unwrap();
}

#[test]
fn the_header_is_good_for_cpp() {
    let mut compiler = Command::new(std::env::var("CXX").unwrap_or_else(|_| "c++".to_owned()));
    compiler.args([
        "-x",
        "c++",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-fsyntax-only",
        "-I",
    ]);
    compiler
        .arg(folder().join("include"))
        .arg(folder().join("examples/follow.c"));
    match compiler.stderr(Stdio::piped()).output() {
        Err(error) => println!("skipped: the_header_is_good_for_cpp: no C++ compiler: {error}"),
        Ok(output) => assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        ),
    }
}

#[test]
fn python() {
    let mut command = Command::new("python3");
    command.arg(folder().join("examples/follow.py"));
    check("python", command);
}

#[test]
fn the_c_header_has_the_sizes_of_the_layout() {
    let header = std::fs::read_to_string(folder().join("include/trikfs_samples.h")).unwrap();
    let field = |name: &str| {
        header
            .find(&format!(" {name};"))
            .unwrap_or_else(|| panic!("no {name}"))
    };
    // In the order of their offsets.
    let ring = [
        "header_bytes",
        "slot_bytes",
        "slots",
        "tuple_bytes",
        "stale_ms",
        "state",
        "newest",
    ];
    assert!(ring.windows(2).all(|pair| field(pair[0]) < field(pair[1])));
    assert!(header.contains(std::str::from_utf8(&sample_bus::layout::MAGIC).unwrap()));
    let event = Event {
        sequence: 0,
        time_ns: u64::MAX,
        errno: 0,
    };
    assert_eq!(event.age_ns(), 0);
}
