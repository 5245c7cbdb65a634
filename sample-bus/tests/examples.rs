//! The examples, run as a newcomer would run them: each follows a ring that this test publishes.

use sample_bus::layout;
use sample_bus::place::{self, Directory};
use sample_bus::{Rights, Writer};
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

const READABLE: Rights = Rights {
    mode: 0o444,
    group: None,
};

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder that stands for a mount point, with a ring for its node `sensors/A1`.
struct Stage {
    mountpoint: TempDir,
    writer: Option<Writer>,
    _directory: Directory,
}

impl Stage {
    fn new(name: &str) -> Self {
        // A name that has to be escaped in the name of its folder.
        let made = tempfile::Builder::new()
            .prefix(&format!("samples {name}+"))
            .tempdir();
        let mountpoint = made.unwrap();
        let shared_memory = Path::new(place::SHARED_MEMORY);
        let path =
            place::directory(shared_memory, &mountpoint.path().canonicalize().unwrap()).unwrap();
        let directory = Directory::take(&path, 0o755).unwrap();
        let file = path.join(place::file_name("sensors/A1").unwrap());
        Self {
            mountpoint,
            writer: Some(Writer::create(&file, 4, READABLE).unwrap()),
            _directory: directory,
        }
    }

    fn publish(&mut self, time_ns: u64) {
        let writer = self.writer.as_mut().unwrap();
        writer.publish(time_ns, &time_ns.to_be_bytes()[4..]);
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
            stage.mountpoint.path().as_os_str(),
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
        .arg(stage.mountpoint.path())
        .arg("sensors/A2");
    let output = command.output().unwrap();
    assert!(!output.status.success());
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(complaint.contains("No such file"), "{complaint}");
    assert_eq!(complaint.lines().count(), 1, "{complaint}");
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

/// The compiler for C or C++, strict, with the folder of the header.
fn compiler(variable: &str, usual: &str) -> Command {
    let mut compiler = Command::new(std::env::var(variable).unwrap_or_else(|_| usual.to_owned()));
    compiler.args(["-Wall", "-Wextra", "-Werror", "-I"]);
    compiler.arg(folder().join("include"));
    compiler
}

fn compiles(compiler: &mut Command) {
    let output = compiler.output();
    let output = output.unwrap_or_else(|error| panic!("{compiler:?}: {error}"));
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{compiler:?}\n{complaint}");
}

/// Of the standards too that hide POSIX from who does not ask for it.
const STANDARDS: [&str; 4] = ["-std=c99", "-std=c11", "-std=gnu99", "-std=gnu17"];

#[test]
fn c() {
    let scratch = tempfile::tempdir().unwrap();
    let program = scratch.path().join("follow");
    let source = folder().join("examples/follow.c");
    for standard in STANDARDS {
        let mut compiler = compiler("CC", "cc");
        compiler.args([standard, "-pedantic", "-O2", "-o"]);
        compiles(compiler.arg(&program).arg(&source));
    }
    check("c", Command::new(&program));
}

/// Asserts in C that header, manual and layout say the same.
fn comparisons() -> String {
    let mut program = String::new();
    let rings = [
        "header_bytes",
        "slot_bytes",
        "slots",
        "tuple_bytes",
        "stale_ms",
        "state",
        "newest",
        "reserved",
    ];
    let slots = ["begin", "end", "size", "error", "time_ns", "reserved"];
    for (of, fields) in [("ring", &rings[..]), ("slot", &slots[..])] {
        for field in fields {
            program.push_str(&format!(
                "_Static_assert(offsetof(struct trikfs_{of}, {field}) == offsetof(struct manual_{of}, {field}), \"{field}\");\n"
            ));
        }
        program.push_str(&format!(
            "_Static_assert(sizeof(struct trikfs_{of}) == sizeof(struct manual_{of}), \"{of}\");\n"
        ));
    }
    let offsets = [
        ("ring, slot_bytes", layout::AT_SLOT_BYTES),
        ("ring, slots", layout::AT_SLOTS),
        ("ring, tuple_bytes", layout::AT_TUPLE_BYTES),
        ("ring, stale_ms", layout::AT_STALE_MS),
        ("ring, state", layout::AT_STATE),
        ("ring, newest", layout::AT_NEWEST),
        ("slot, end", layout::AT_END),
        ("slot, size", layout::AT_SIZE),
    ];
    for (field, at) in offsets {
        program.push_str(&format!(
            "_Static_assert(offsetof(struct trikfs_{field}) == {at}, \"{field}\");\n"
        ));
    }
    program
}

/// The C of the manual compiles, and its structures are those of the header.
#[test]
fn the_manual() {
    let manual = folder().join("../docs/user/sample-bus.md");
    let manual = std::fs::read_to_string(manual).unwrap();
    let parts = manual.split("```c\n").skip(1);
    let fences: Vec<&str> = parts.filter_map(|part| part.split("```").next()).collect();
    let [first, in_place, layout] = fences.as_slice() else {
        panic!("{} pieces of C", fences.len());
    };
    let first = first.replace("#include \"trikfs_samples.h\"\n", "");
    let layout = layout.replace("struct trikfs_", "struct manual_");
    let mut program = format!(
        "#include \"trikfs_samples.h\"
         {layout}
         #include <stddef.h>
         static unsigned mean_of(const void *at, uint32_t size) {{ return at != NULL && size; }}
         static void use(unsigned number) {{ printf(\"%u\", number); }}
         int main(void) {{ {first} {in_place} return 0; }}\n"
    );
    program.push_str(&comparisons());
    let scratch = tempfile::tempdir().unwrap();
    let source = scratch.path().join("manual.c");
    std::fs::write(&source, &program).unwrap();
    let compiled = compiler("CC", "cc")
        .args(["-std=c11", "-fsyntax-only"])
        .arg(&source)
        .output()
        .unwrap();
    assert!(
        compiled.status.success(),
        "{}\n{program}",
        String::from_utf8_lossy(&compiled.stderr)
    );
}

/// After a header that has hidden POSIX already, the compiler says what to do.
#[test]
fn the_header_behind_others_says_what_to_do() {
    let program =
        "#include <stdio.h>\n#include \"trikfs_samples.h\"\nint main(void) { return 0; }\n";
    let scratch = tempfile::tempdir().unwrap();
    let source = scratch.path().join("behind.c");
    std::fs::write(&source, program).unwrap();
    let check = |option: &str| {
        let mut compiler = compiler("CC", "cc");
        compiler.args(["-std=c99", "-fsyntax-only", option]);
        compiler.arg(&source).output().unwrap()
    };
    let (refused, asked) = (check("-O0"), check("-D_DEFAULT_SOURCE"));
    let complaint = String::from_utf8_lossy(&refused.stderr);
    assert!(!refused.status.success());
    assert!(
        complaint.contains("before all other headers"),
        "{complaint}"
    );
    assert!(asked.status.success());
}

#[test]
fn the_header_is_good_for_cpp() {
    for standard in ["-std=c++11", "-std=gnu++17"] {
        let mut compiler = compiler("CXX", "c++");
        compiler.args([standard, "-x", "c++", "-fsyntax-only"]);
        compiler.arg(folder().join("examples/follow.c"));
        match compiler.stderr(Stdio::piped()).output() {
            Err(error) => needs::Need::Tools.missing(format_args!("no C++ compiler: {error}")),
            Ok(output) => assert!(
                output.status.success(),
                "{}",
                String::from_utf8_lossy(&output.stderr)
            ),
        }
    }
}

#[test]
fn python() {
    let mut command = Command::new("python3");
    command.arg(folder().join("examples/follow.py"));
    check("python", command);
}
