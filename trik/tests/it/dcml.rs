//! Models on the command line: what docs/dcml.md shows, files and exit codes.
//!
//! Fences `dcml NAME` are files; lines with `$ ` in fences `sh dcml` are run in their folder, the others are what they print.

use crate::diagrams::root;
use crate::rig::TRIK;
use harness::documents::examples;
use harness::{Board, tools};
use std::fs;
use std::path::Path;
use std::process::Command;

const GOOD: &str = "BEGIN M\n  ACTION: u;\n  CONFIG: x;\n  d(x) = u;\nEND;\n";

/// What a line of a shell prints in a folder, in which `trik` is known.
fn sh(board: &Board, script: &str) -> String {
    let programs = Path::new(TRIK).parent().expect("a directory").display();
    let path = std::env::var("PATH").unwrap_or_default();
    let mut command = tools::shell(format!("exec 2>&1\n{script}"));
    command
        .current_dir(board.dir())
        .env("PATH", format!("{programs}:{path}"));
    tools::run(&mut command, b"").stdout
}

#[test]
fn what_the_document_shows_is_what_really_happens() {
    let path = root().join("docs/dcml.md");
    let mut text = fs::read_to_string(&path).expect("the document");
    let board = Board::new();
    for one in examples(&text) {
        if let Some(name) = one.info.strip_prefix("dcml ") {
            board.file(name, one.text);
        }
    }
    let is_written = std::env::var_os("TRIK_WRITE_DOCS").is_some();
    let mut count = 0;
    for one in examples(&text.clone()) {
        if one.info != "sh dcml" {
            continue;
        }
        let mut shown = String::new();
        for step in one.text.split("$ ").skip(1) {
            let (script, expected) = step.split_once('\n').unwrap_or((step, ""));
            let printed = sh(&board, script);
            if !is_written {
                let place = format!("docs/dcml.md:{}: $ {script}", one.line);
                assert_eq!(printed.trim_end(), expected.trim_end(), "{place}");
            }
            shown.push_str(&format!("$ {script}\n{printed}"));
            count += 1;
        }
        if is_written {
            text = text.replacen(
                &format!("```sh dcml\n{}```", one.text),
                &format!("```sh dcml\n{shown}```"),
                1,
            );
        }
    }
    if is_written {
        fs::write(path, text).expect("written");
    }
    assert!(count > 4, "only {count} examples");
}

#[test]
fn exit_codes_tell_good_models_wrong_ones_and_files_that_cannot_be_read() {
    let board = Board::new();
    board.file("good.dcml", GOOD);
    board.file("wrong.dcml", GOOD.replace("= u", "= w"));
    board.file("bytes.dcml", b"BEGIN \xff");
    let code = |words: &[&str]| {
        let mut command = Command::new(TRIK);
        let output = command
            .arg("dcml")
            .args(words)
            .current_dir(board.dir())
            .output();
        let output = output.expect("it runs");
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    assert_eq!(code(&["lint", "good.dcml"]), (Some(0), String::new()));
    let (status, told) = code(&["lint", "good.dcml", "wrong.dcml"]);
    assert_eq!(status, Some(1));
    assert!(
        told.contains("wrong.dcml:4:10") && told.is_ascii(),
        "{told}"
    );
    let (status, told) = code(&["lint", "wrong.dcml", "none.dcml", "bytes.dcml"]);
    assert_eq!(status, Some(2));
    assert!(
        told.contains("trik: none.dcml: there is no such file"),
        "{told}"
    );
    assert!(
        told.contains("trik: bytes.dcml:1:7: the byte 0xff is no text in UTF-8"),
        "{told}"
    );
    assert_eq!(code(&["lint", "--paper", "good.dcml"]).0, Some(0));
    assert_eq!(code(&["lint", "."]).0, Some(2));
    assert_eq!(code(&["doc", "good.dcml"]).0, Some(0));
}

#[test]
fn a_layout_is_written_in_place_and_checked_without_writing() {
    let board = Board::new();
    let rough = GOOD.replace("\n  ", " ");
    board.file("rough.dcml", &rough);
    board.file("broken.dcml", "BEGIN M");
    board.file(
        "long.dcml",
        format!(
            "BEGIN M ACTION: u; CONFIG: x; d(x) = {} w; END;",
            "u * ".repeat(400)
        ),
    );
    assert_eq!(
        sh(&board, "trik dcml fmt --check rough.dcml; echo $?"),
        "trik: rough.dcml:1: not in the layout: trik dcml fmt changes it\n1\n"
    );
    assert_eq!(sh(&board, "cat rough.dcml"), rough);
    assert_eq!(
        sh(
            &board,
            "chmod 600 rough.dcml; trik dcml fmt rough.dcml; echo $?; cat rough.dcml"
        ),
        format!("0\n{GOOD}")
    );
    assert_eq!(
        sh(
            &board,
            "trik dcml fmt --check rough.dcml; echo $?; stat -c %a rough.dcml"
        ),
        "0\n600\n"
    );
    let told = sh(
        &board,
        "trik dcml fmt broken.dcml rough.dcml; echo $?; cat broken.dcml",
    );
    assert!(
        told.contains("broken.dcml: not changed") && told.ends_with("1\nBEGIN M"),
        "{told}"
    );
    // Models that come with the program are no files.
    assert_eq!(
        sh(
            &board,
            "trik dcml fmt bicycle; echo $?; ls bicycle 2>&1 | wc -l"
        ),
        "trik: bicycle: there is no such file\n2\n1\n"
    );
    // A line that no screen can show is told in part.
    let told = sh(&board, "trik dcml lint long.dcml");
    assert!(
        told.contains("long.dcml:1:1639: not declared") && told.len() < 1000,
        "{told}"
    );
}
