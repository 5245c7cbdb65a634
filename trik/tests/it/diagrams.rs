//! Diagrams on this computer: `trik gen`, `show` and `lint`, and the same diagram on a robot in three languages.
//!
//! Saves are made here.

mod behaviours;
mod dataflow;
mod together;

use crate::documents::transcripts;
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use lang_diagram::read;
use lang_diagram::sketch::Sketch;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Two sides of something like a square: drives, turns, counts and prints.
pub fn square() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let begin = sketch.block("Function", &[("Body", "side = 0")]);
    let sides = sketch.block("Loop", &[("Iterations", "2")]);
    let clear = sketch.block("TrikV62ClearEncoder", &[("Ports", "E3, E4")]);
    let both = |sketch: &mut Sketch, kind: &str, ports: &str| {
        sketch.block(kind, &[("Ports", ports), ("Power", "60")])
    };
    let until = |sketch: &mut Sketch, limit: &str| {
        let kind = "TrikV62WaitForEncoder";
        sketch.block(kind, &[("TachoLimit", limit), ("Sign", "greater")])
    };
    let forward = both(&mut sketch, "TrikV6EnginesForward", "M3, M4");
    let far = until(&mut sketch, "200");
    let turn = both(&mut sketch, "TrikV6EnginesBackward", "M4");
    let turned = until(&mut sketch, "400");
    let stop = sketch.block("TrikV6EnginesStop", &[("Ports", "M3, M4")]);
    let count = "side = side + 1; print('side ' .. side)";
    let count = sketch.block("Function", &[("Body", count)]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, begin, sides]);
    sketch.guarded(sides, clear, "iteration");
    sketch.chain(&[clear, forward, far, turn, turned, stop, count, sides]);
    sketch.link(sides, end);
    sketch.qrs().expect("a save")
}

/// A diagram with mistakes: an expression, a variable, a block that nothing leads to.
pub fn wrong() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let forward = sketch.block(
        "TrikV6EnginesForward",
        &[("Ports", "M3, M4"), ("Power", "50 +")],
    );
    let wait = sketch.block("Timer", &[("Delay", "pause")]);
    let end = sketch.block("FinalNode", &[]);
    let lost = sketch.block("TrikSay", &[("Text", "never")]);
    sketch.chain(&[start, forward, wait, end]);
    sketch.link(lost, end);
    sketch.qrs().expect("a save")
}

/// A folder with both.
fn folder() -> Board {
    let board = Board::new();
    board.file("square.qrs", square());
    board.file("wrong.qrs", wrong());
    board
}

fn trik(board: &Board, words: &[&str]) -> Output {
    tools::run(Command::new(TRIK).args(words).current_dir(board.dir()), b"")
}

#[test]
fn what_documents_say_of_diagrams_is_what_really_happens() {
    let mut count = 0;
    for document in ["docs/user/diagrams.md", "docs/user/generators.md"] {
        let Ok(text) = fs::read_to_string(root().join(document)) else {
            continue;
        };
        let (steps, wrong) = transcripts(&folder(), document, &text, "sh diagrams");
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        count += steps;
    }
    assert!(count > 5, "only {count} examples");
}

#[test]
fn a_program_goes_to_standard_output_or_into_a_new_file_and_never_over_another() {
    let board = folder();
    let printed = trik(&board, &["gen", "--lang", "python", "square.qrs"]);
    assert_eq!((printed.code(), &*printed.stderr), (0, ""));
    assert!(printed.stdout.contains("brick.motor('M3').setPower(60)"));
    let words = ["gen", "--lang=py", "square.qrs", "-o", "square.py"];
    let written = trik(&board, &words);
    assert_eq!((written.code(), &*written.stdout), (0, ""));
    let text = || fs::read_to_string(board.path("square.py")).expect("a program");
    assert_eq!(text(), printed.stdout);
    board.file("square.py", "mine");
    let refused = trik(&board, &words);
    assert_eq!(
        (refused.code(), &*refused.stderr),
        (1, "trik: square.py is there already: --force replaces it\n")
    );
    assert_eq!(text(), "mine");
    let forced = trik(&board, &[&words[..], &["--force"]].concat());
    assert_eq!(forced.code(), 0, "{}", forced.stderr);
    assert_eq!(text(), printed.stdout);
    // The diagram itself is never replaced, by whatever name.
    std::os::unix::fs::symlink("square.qrs", board.path("link")).expect("a link");
    for name in ["square.qrs", "./square.qrs", "link"] {
        let words = ["gen", "--lang=c", "square.qrs", "-o", name, "--force"];
        let refused = trik(&board, &words);
        assert_eq!(refused.code(), 1);
        assert!(refused.stderr.contains("is the file that is read"));
    }
    assert_eq!(fs::read(board.path("square.qrs")).unwrap(), square());
    let nowhere = ["gen", "--lang=c", "square.qrs", "-o", "no/where.c"];
    let refused = trik(&board, &nowhere);
    assert_eq!(
        (refused.code(), &*refused.stderr),
        (1, "trik: no/where.c: there is no such directory\n")
    );
    // Nothing is left beside them.
    let mut names: Vec<_> = fs::read_dir(board.dir())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["link", "square.py", "square.qrs", "wrong.qrs"]);
}

#[test]
fn every_language_is_written_and_goto_only_where_it_is() {
    let board = folder();
    let marks = [
        ("python", "brick.motor('M3').setPower(60)"),
        ("javascript", "brick.motor(M3).setPower(60)"),
        ("lua", "setPower(\"M3\", 60)"),
        ("c", "#include <stdio.h>"),
        ("pascal", "begin"),
        ("fsharp", "let "),
    ];
    for (language, mark) in marks {
        let output = trik(&board, &["gen", "--lang", language, "square.qrs"]);
        assert_eq!(output.code(), 0, "{language}: {}", output.stderr);
        assert!(
            output.stdout.contains(mark),
            "{language}: {}",
            output.stdout
        );
    }
    for (language, code) in [("lua", 0), ("c", 0), ("python", 2), ("javascript", 2)] {
        let words = ["gen", "--goto", "--lang", language, "square.qrs"];
        let output = trik(&board, &words);
        assert_eq!(output.code(), code, "{language}: {}", output.stderr);
        assert_eq!(code == 2, output.stderr.contains("--goto is for Lua and C"));
    }
    let output = trik(&board, &["gen", "--lang", "cobol", "square.qrs"]);
    assert_eq!(output.code(), 2);
    assert!(
        output
            .stderr
            .contains("python, javascript, lua, c, pascal and fsharp")
    );
    let output = trik(&board, &["gen", "--lang", "python", "wrong.qrs"]);
    assert_eq!((output.code(), &*output.stdout), (1, ""));
    assert!(
        output.stderr.contains("wrong.qrs: error: main: ")
            && output.stderr.contains("trik lint wrong.qrs tells all"),
        "{}",
        output.stderr
    );
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let tone = sketch.block("TrikPlayToneHz", &[]);
    let clear = sketch.block("ClearScreen", &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, tone, clear, end]);
    board.file("tone.qrs", sketch.qrs().expect("a save"));
    let output = trik(&board, &["gen", "--lang", "pascal", "tone.qrs"]);
    assert_eq!(
        (output.code(), &*output.stderr),
        (
            1,
            "tone.qrs: error: Programs in PascalABC.NET cannot do what the block Play Tone does. Choose another language.\n\
             trik: no program was written\n"
        )
    );
    let output = trik(&board, &["gen", "--lang", "lua", "tone.qrs"]);
    assert_eq!(
        (output.code(), &*output.stderr),
        (
            0,
            "tone.qrs: warning: the block Clear Screen is left out: programs in Lua cannot do it.\n"
        )
    );
}

#[test]
fn a_diagram_is_shown_as_sentences_and_as_a_picture() {
    let board = Board::new();
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let sheet = sketch.subprogram("pause", &[]);
    let inner = sketch.block("InitialNode", &[]);
    let wait = sketch.block("Timer", &[("Delay", "1234")]);
    let done = sketch.block("FinalNode", &[]);
    sketch.chain(&[inner, wait, done]);
    sketch.draw_on(sketch.main());
    let say = sketch.block("TrikSay", &[("Text", "<&\u{9b}2J")]);
    let call = sketch.call(sheet, &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, say, call, end]);
    board.file("two.qrs", sketch.qrs().expect("a save"));
    let text = trik(&board, &["show", "two.qrs"]);
    assert_eq!(text.code(), 0, "{}", text.stderr);
    assert!(text.stdout.contains("1234") && text.stdout.contains("Say"));
    assert!(!text.stdout.contains('\u{9b}'), "{}", text.stdout);
    assert_eq!(
        trik(&board, &["show", "--text", "two.qrs"]).stdout,
        text.stdout
    );
    let part = trik(&board, &["show", "two.qrs", "--diagram", "pause"]);
    assert!(part.stdout.contains("1234") && !part.stdout.contains("Say"));
    assert!(
        part.stdout.starts_with("Subprogram pause:\n") && text.stdout.starts_with("Program:\n"),
        "{}",
        part.stdout
    );
    let russian = trik(&board, &["show", "two.qrs", "--language", "ru"]);
    assert!(!russian.stdout.is_ascii());
    let picture = trik(&board, &["show", "two.qrs", "--svg", "two.svg"]);
    assert_eq!((picture.code(), &*picture.stdout), (0, ""));
    let svg = fs::read_to_string(board.path("two.svg")).expect("a picture");
    lang_text::xml::parse(&svg).expect("XML");
    assert!(svg.contains("<svg") && svg.contains("Say"), "{svg}");
    let words = ["show", "two.qrs", "--svg", "-", "--diagram", "pause"];
    let other = trik(&board, &words).good();
    assert!(other.contains("1234") && !other.contains("Say"), "{other}");
    let again = trik(&board, &["show", "two.qrs", "--svg", "two.svg"]);
    assert_eq!(again.code(), 1);
    assert!(again.stderr.contains("--force replaces it"));
    let unknown = trik(&board, &["show", "two.qrs", "--diagram", "turn"]);
    assert_eq!(
        (unknown.code(), &*unknown.stderr),
        (
            1,
            "trik: there is no diagram 'turn' in this project; there are: main, pause\n"
        )
    );
}

#[test]
fn lint_tells_all_at_their_blocks_and_the_code_is_that_of_the_worst() {
    let board = folder();
    let clean = trik(&board, &["lint", "square.qrs"]);
    assert_eq!(
        (clean.code(), &*clean.stdout, &*clean.stderr),
        (0, "1 file: 0 errors, 0 warnings, 0 notes\n", "")
    );
    let bad = trik(&board, &["lint", "square.qrs", "wrong.qrs"]);
    assert_eq!(bad.code(), 1);
    let lines: Vec<_> = bad.stdout.lines().collect();
    let place = "wrong.qrs: error: main: Motors Forward (100, 0): 'Power (%)' 1:";
    assert!(lines[0].starts_with(place), "{}", bad.stdout);
    assert!(
        lines[1].starts_with("wrong.qrs: error: main: Timer (200, 0): 'Delay (ms)' 1:1: "),
        "{}",
        bad.stdout
    );
    assert!(bad.stdout.contains("wrong.qrs: note: main: Say (400, 0): "));
    let last = lines.last().copied();
    assert_eq!(last, Some("2 files: 2 errors, 0 warnings, 1 note"));
    let russian = trik(&board, &["lint", "wrong.qrs", "--language=ru"]);
    assert_eq!(russian.code(), 1);
    assert!(!russian.stdout.lines().all(str::is_ascii));
    board.file("noise.qrs", b"PK\x03\x04 nonsense");
    board.file("empty.qrs", b"");
    board.file("cut.qrs", &square()[..200]);
    fs::create_dir(board.path("folder.qrs")).unwrap();
    for name in [
        "noise.qrs",
        "empty.qrs",
        "cut.qrs",
        "folder.qrs",
        "none.qrs",
    ] {
        let output = trik(&board, &["lint", name, "square.qrs"]);
        assert_eq!(output.code(), 2, "{name}: {}", output.stdout);
        let start = format!("{name}: error: ");
        assert!(output.stdout.starts_with(&start), "{}", output.stdout);
        assert!(output.stdout.contains("2 files (1 unreadable): "));
        for words in [&["show", name][..], &["gen", "--lang=c", name]] {
            let output = trik(&board, words);
            assert_eq!((output.code(), &*output.stdout), (2, ""), "{words:?}");
            assert!(output.stderr.contains(name), "{}", output.stderr);
        }
    }
}

#[test]
fn files_without_end_and_names_that_a_terminal_would_obey_do_no_harm() {
    let board = folder();
    let endless = trik(&board, &["lint", "/dev/zero"]);
    assert_eq!(endless.code(), 2);
    let expected = "/dev/zero: error: longer than 32 MiB\n";
    assert!(endless.stdout.starts_with(expected), "{}", endless.stdout);
    let name = "\u{1b}[31m\nred.qrs";
    fs::write(board.path(name), wrong()).unwrap();
    for words in [
        &["lint", name][..],
        &["show", name, "--diagram", "\u{1b}[31m"],
        &["gen", "--lang=c", name],
        &["show", "\u{1b}[2J.qrs"],
    ] {
        let output = trik(&board, words);
        let all = format!("{}{}", output.stdout, output.stderr);
        assert!(!all.contains('\x1b') && !all.is_empty(), "{words:?}: {all}");
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let board = folder();
    for (words, code) in [
        (&["gen", "--lang=c", "square.qrs"][..], 0),
        (&["show", "square.qrs"], 0),
        (&["show", "square.qrs", "--svg", "-"], 0),
        (&["lint", "square.qrs"], 0),
        (&["lint", "wrong.qrs"], 1),
    ] {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let mut command = Command::new(TRIK);
        command.args(words).current_dir(board.dir()).stdout(writer);
        let output = command.stderr(Stdio::piped()).output().expect("trik");
        assert_eq!(output.status.code(), Some(code), "{words:?}");
        assert_eq!(output.stderr, b"", "{words:?}");
    }
    let full = Path::new("/dev/full");
    if full.exists() {
        let mut command = Command::new(TRIK);
        command
            .args(["show", "square.qrs"])
            .current_dir(board.dir());
        let sink = fs::File::options().write(true).open(full).expect("full");
        let output = command.stdout(sink).output().expect("trik");
        assert_eq!(output.status.code(), Some(1));
        assert!(String::from_utf8_lossy(&output.stderr).starts_with("trik: standard output: "));
    }
}

/// A project whose blocks an earlier editor has lost.
fn lost() -> Option<PathBuf> {
    let path = needs::data()?;
    let mut found: Option<(usize, PathBuf)> = None;
    for entry in fs::read_dir(path.join("examples")).expect("projects") {
        let path = entry.expect("a file").path();
        let bytes = fs::read(&path).unwrap_or_default();
        let count = read::read(&bytes).map_or(0, |opened| opened.save.orphans().len());
        if count > found.as_ref().map_or(0, |(most, _)| *most) {
            found = Some((count, path));
        }
    }
    Some(found.expect("a project with lost blocks").1)
}

#[test]
fn lost_blocks_are_put_back() {
    let board = folder();
    let none = ["lint", "square.qrs", "--recover", "none.qrs"];
    let none = trik(&board, &none);
    assert_eq!(none.code(), 0, "{}{}", none.stdout, none.stderr);
    assert!(none.stdout.contains("nothing is lost in it"));
    assert!(!board.path("none.qrs").exists());
    let two = ["lint", "a.qrs", "b.qrs", "--recover", "c.qrs"];
    assert_eq!(trik(&board, &two).code(), 2);
    let Some(path) = lost() else { return };
    let path = path.to_str().expect("UTF-8");
    let words = ["lint", path, "--recover", "found.qrs"];
    let output = trik(&board, &words);
    assert!(
        output.stdout.starts_with("found.qrs: written, with "),
        "{}{}",
        output.stdout,
        output.stderr
    );
    let save = fs::read(board.path("found.qrs")).expect("a save");
    assert!(read::read(&save).expect("a save").save.orphans().is_empty());
    assert_eq!(trik(&board, &words).code(), 1, "it is there now");
}
