//! The documents: every marked example is run, every table that can be compared is.
//!
//! Marks are the words after a fence: `lua config NAME` loads, `c converter NAME` and `rust converter NAME` compile
//! without a warning and load, `python` is Python, `sh session` is a transcript: lines with `$ ` are run in a mounted
//! hello.lua, the others are what they print; `sh convert NAME` is one without a mount, where robot.lua is the
//! configuration NAME of the same page, and `sh mount NAME` one that mounts it by itself; all of a page share a folder.

use crate::{is_of_the_controller, mount_on, trikfs};
use harness::Board;
use harness::documents::{Example, examples};
use std::path::Path;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Examples whose words begin with `mark`, with the place for messages.
fn marked(mark: &str) -> Vec<(String, Example)> {
    let mut found = Vec::new();
    for path in harness::documents::documents() {
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        for example in examples(&text) {
            if example.info.starts_with(mark) {
                found.push((format!("{}:{}", path.display(), example.line), example));
            }
        }
    }
    assert!(!found.is_empty(), "no example is marked '{mark}'");
    found
}

/// A library of the versioned form with one converter.
const VERSIONED: &str = "
#include \"trikfs_converter.h\"
static int convert(void *s, const uint8_t *a, uint32_t n, uint8_t *b, uint32_t m)
{ (void)s; (void)a; (void)n; (void)b; (void)m; return 0; }
static const trikfs_converter one = { 1, sizeof one, \"NAME\", 0, 0, 0, 0, convert, 0, 0 };
static const trikfs_converter *const all[] = { &one };
static const trikfs_library library = { 1, sizeof library, 1, all };
TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void) { return &library; }
";
/// A library of the plain form.
const PLAIN: &str =
    "int converter(int n, char *a, int m, char *b) { return n == 0 || m == 0 || !a || !b; }";

#[test]
fn every_configuration_in_the_documents_is_good() {
    for (place, example) in marked("lua config ") {
        let board = Board::new();
        let name = example.info.trim_start_matches("lua config ");
        for word in example.text.split('\'') {
            // What the document builds on the way: a library that has the converter is enough here.
            match word.split_once('#') {
                _ if !word.starts_with("libbattery") => {}
                Some((library, name)) => {
                    drop(board.library(library, &VERSIONED.replace("NAME", name)))
                }
                None => drop(board.library(word, PLAIN)),
            }
        }
        board.file("robot.lua", &example.text);
        let output = trikfs(&board, &["check", "--cache", "cache", "robot.lua"], b"");
        if name == "dataflow" && is_of_the_controller() {
            // Its program is a text, which the controller's trikfs says how to bring there.
            assert_eq!(output.code(), 1, "{place}: {name}\n{}", output.stderr);
            assert!(output.stderr.contains("--lang lua"), "{}", output.stderr);
            continue;
        }
        assert_eq!(output.code(), 0, "{place}: {name}\n{}", output.stderr);
        for warning in output.stderr.lines() {
            assert!(
                warning.contains(" does not exist") && warning.ends_with(" will give ENODEV"),
                "{place}: {warning}"
            );
        }
    }
}

#[test]
fn every_c_converter_in_the_documents_compiles_without_a_warning_and_loads() {
    for (place, example) in marked("c converter ") {
        let board = Board::new();
        board.file("x.c", &example.text);
        let mut command = std::process::Command::new(harness::tools::c_compiler());
        let include = root().join("converter/include");
        command
            .args([
                "-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", "-fPIC", "-shared", "-o",
                "libx.so", "x.c", "-I",
            ])
            .arg(include);
        harness::run(command.current_dir(board.dir()), b"").good();
        board.file("robot.lua", "trikfs = { n = { src = '/dev/zero', input_tuple_size = 2, output_tuple_size = 4, converter = 'libx.so' } }");
        let output = trikfs(&board, &["check", "--cache", "cache", "robot.lua"], b"");
        assert_eq!(output.code(), 0, "{place}\n{}", output.stderr);
    }
}

#[test]
fn every_rust_converter_in_the_documents_compiles_without_a_warning_and_loads() {
    if std::env::var_os(crate::UNDER_TEST).is_some() {
        harness::wait::note_skip("cargo builds for this machine, the program may be for another");
        return;
    }
    for (place, example) in marked("rust converter ") {
        let board = Board::new();
        let name = example.info.trim_start_matches("rust converter ");
        let converter = root().join("converter").canonicalize().unwrap();
        std::fs::create_dir(board.path("src")).unwrap();
        board.file("src/lib.rs", &example.text);
        board.file(
            "Cargo.toml",
            format!(
                "[workspace]\n[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\
                 [lib]\ncrate-type = [\"cdylib\"]\n[dependencies]\nconverter = {{ path = {converter:?} }}\n"
            ),
        );
        let mut command = std::process::Command::new(env!("CARGO"));
        command.args(["build", "--offline", "--quiet", "--target-dir", "target"]);
        command
            .env("RUSTFLAGS", "-Dwarnings")
            .current_dir(board.dir());
        let output = harness::tools::run_within(&mut command, b"", harness::wait::LIFE);
        assert_eq!(output.code(), 0, "{place}\n{}", output.stderr);
        let built = board.path(&format!("target/debug/lib{name}.so"));
        std::fs::copy(built, board.path(&format!("lib{name}.so"))).unwrap();
        // The page has a configuration that names this library.
        let users = marked("lua config ");
        let users = users
            .iter()
            .filter(|(_, config)| config.text.contains(&format!("lib{name}.so")));
        assert!(
            users.clone().count() > 0,
            "{place}: no configuration uses lib{name}.so"
        );
        for (user, config) in users {
            board.file("robot.lua", &config.text);
            let output = trikfs(&board, &["check", "--cache", "cache", "robot.lua"], b"");
            assert_eq!(output.code(), 0, "{user}\n{}", output.stderr);
        }
    }
}

/// Runs one transcript and compares what is printed, line by line.
fn replay(run: impl Fn(&str) -> String, place: &str, example: &Example) {
    let mut script = String::new();
    let mut expected = String::new();
    let mut outputs = Vec::new();
    for line in example.text.lines() {
        if let Some(command) = line.strip_prefix("$ ") {
            outputs.push((std::mem::take(&mut script), std::mem::take(&mut expected)));
            script = command.to_owned();
        } else {
            expected.push_str(line);
            expected.push('\n');
        }
    }
    outputs.push((script, expected));
    for (script, expected) in outputs.into_iter().filter(|(script, _)| !script.is_empty()) {
        let printed = run(&script);
        let place = format!("{place}: $ {script}");
        assert_eq!(printed.trim_end(), expected.trim_end(), "{place}");
    }
}

#[test]
fn every_transcript_in_the_documents_is_what_really_happens() {
    let hello = std::fs::read_to_string(root().join("config/lua/hello.lua")).unwrap();
    let Some(mut m) = mount_on(Board::new(), &hello) else {
        return;
    };
    let mut document = String::new();
    for (place, example) in marked("sh session") {
        let this = place
            .rsplit_once(':')
            .map(|(document, _)| document.to_owned())
            .unwrap_or_default();
        if this != document {
            // Each document begins with a fresh tree.
            drop(m);
            let Some(fresh) = mount_on(Board::new(), &hello) else {
                return;
            };
            m = fresh;
            document = this;
        }
        let in_the_mount = |script: &str| m.try_sh(&format!("exec 2>&1\n{script}")).stdout;
        replay(in_the_mount, &place, &example);
    }
}

#[test]
fn every_conversion_in_the_documents_gives_what_the_page_says() {
    for document in harness::documents::documents() {
        let page = std::fs::read_to_string(&document).unwrap();
        let found = examples(&page);
        // What one example of a page leaves behind, the next one finds.
        let board = Board::new();
        for example in &found {
            let place = format!("{}:{}", document.display(), example.line);
            let words: Vec<&str> = example.info.split(' ').collect();
            let ["sh", kind @ ("convert" | "mount"), name] = words[..] else {
                continue;
            };
            if kind == "mount" && !can_mount() {
                continue;
            }
            let config = found
                .iter()
                .find(|config| config.info == format!("lua config {name}"))
                .unwrap_or_else(|| panic!("{place}: the page has no configuration {name}"));
            board.file("robot.lua", &config.text);
            replay(|script| in_a_shell(&board, script), &place, example);
        }
    }
}

/// What a line of shell prints in the folder of the board, where `trikfs` is the program under test.
fn in_a_shell(board: &Board, script: &str) -> String {
    let program = crate::program();
    let script = format!("exec 2>&1\ntrikfs() {{ '{program}' \"$@\"; }}\n{script}");
    let mut command = std::process::Command::new("sh");
    harness::run(command.args(["-c", &script]).current_dir(board.dir()), b"").stdout
}

/// False if nothing can be mounted here, which is said.
fn can_mount() -> bool {
    let obstacle = harness::mount::obstacle();
    obstacle.into_iter().for_each(harness::skip);
    obstacle.is_none()
}

#[test]
fn every_python_program_in_the_documents_is_python() {
    for (place, example) in marked("python") {
        let script = format!("import ast, sys; ast.parse(sys.stdin.read(), {place:?})");
        let mut command = std::process::Command::new(harness::tools::python_program());
        harness::run(command.args(["-c", &script]), example.text.as_bytes()).good();
    }
}

#[test]
fn the_table_of_errors_has_a_row_for_every_error_in_order() {
    let code = std::fs::read_to_string(root().join("trikfs/src/errno.rs")).unwrap();
    let document = std::fs::read_to_string(root().join("docs/user/errors.md")).unwrap();
    let between = |text: &str, start: &str| {
        let text = text
            .split_once(start)
            .map_or("", |(_, rest)| rest)
            .to_owned();
        text.split_once("\n    }\n")
            .map_or(text.clone(), |(body, _)| body.to_owned())
    };
    let numbers = between(&code, "pub fn errno(&self) -> i32 {");
    let expected: Vec<String> = numbers
        .lines()
        .filter_map(|line| line.trim().strip_prefix("Self::"))
        .map(|line| {
            line.split_once("=> libc::").map_or_else(
                || "EIO".to_owned(),
                |(_, name)| name.trim_end_matches(',').to_owned(),
            )
        })
        .collect();
    let variants = between(&code, "pub enum Error {")
        .lines()
        .filter(|line| line.starts_with("    ") && !line.trim().starts_with("///"))
        .count();
    let rows: Vec<Vec<&str>> = document
        .lines()
        .filter(|line| line.starts_with("| E"))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let names: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(names, expected);
    assert!(
        expected.len() > 15 && variants >= expected.len(),
        "{variants} variants, {} numbers",
        expected.len()
    );
    for row in rows {
        assert_eq!(row.len(), 4, "{row:?}");
        assert!(
            ["caller", "device", "converter", "system", "filesystem"].contains(&row[2]),
            "{row:?}"
        );
        assert!(row.iter().all(|cell| !cell.is_empty()), "{row:?}");
    }
}
