//! `trik dcml gen` as people use it: the text, files that are not overwritten, refusals.

use crate::documents::section_of_dcml_holds;
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use std::fs;
use std::process::Command;

const TWO: &str = "BEGIN A ACTION: u; CONFIG: x; d(x) = u; END;\nBEGIN B ACTION: u; CONFIG: x; d(x) = 2 * u; END;\n";

fn generated(board: &Board, words: &[&str]) -> Output {
    let mut command = Command::new(TRIK);
    command
        .args(["dcml", "gen"])
        .args(words)
        .current_dir(board.dir());
    tools::run(&mut command, b"")
}

#[test]
fn a_text_goes_to_standard_output_or_to_a_new_file() {
    let board = Board::new();
    board.file("two.dcml", TWO);
    let shown = generated(&board, &["--lang", "c", "--model", "B", "two.dcml"]);
    assert_eq!(shown.code(), 0, "{}", shown.stderr);
    assert!(
        shown.stdout.contains("derivative[0] = 2.0 * u;"),
        "{}",
        shown.stdout
    );
    assert!(!shown.stdout.contains("jacobian"));
    let words = ["--lang", "c", "--model", "B", "two.dcml", "-o", "b.h"];
    assert_eq!(generated(&board, &words).code(), 0);
    let written = fs::read_to_string(board.dir().join("b.h")).unwrap();
    assert_eq!(written, shown.stdout);
    let again = generated(&board, &words);
    assert_eq!(again.code(), 1);
    assert!(again.stderr.contains("b.h is there already: --force"));
    let mut forced = words.to_vec();
    forced.extend(["--force", "--jacobian"]);
    assert_eq!(generated(&board, &forced).code(), 0);
    let written = fs::read_to_string(board.dir().join("b.h")).unwrap();
    assert!(written.contains("B_action_jacobian"));
    let words = [
        "--lang", "c", "--model", "B", "two.dcml", "-o", "two.dcml", "--force",
    ];
    assert!(
        generated(&board, &words)
            .stderr
            .contains("is the file that is read")
    );
    assert_eq!(
        fs::read_to_string(board.dir().join("two.dcml")).unwrap(),
        TWO
    );
}

#[test]
fn what_cannot_be_written_is_told() {
    let board = Board::new();
    board.file("two.dcml", TWO);
    for (words, code, part) in [
        (
            &["--lang", "fortran", "two.dcml"] as &[&str],
            2,
            "there are rust, c, java",
        ),
        (&["two.dcml"], 2, "--lang"),
        (
            &["--lang", "c", "two.dcml"],
            1,
            "name one with --model: A, B",
        ),
        (&["--lang", "c", "no.dcml"], 2, "no.dcml"),
    ] {
        let output = generated(&board, words);
        assert_eq!(output.code(), code, "{words:?}: {}", output.stderr);
        assert!(output.stderr.contains(part), "{words:?}: {}", output.stderr);
        assert_eq!(output.stdout, "");
    }
    let mut long = "BEGIN Long ACTION: u; CONFIG: x; d(x) = u".to_owned();
    for number in 0..400 {
        long.push_str(&format!("*(1.{number:04}+u)"));
    }
    let more: String = (0..9)
        .map(|at| {
            format!("CONFIG: x{at}; d(x{at}) = x")
                + &(0..400)
                    .map(|number| format!("-{at}.{number:04}1*x"))
                    .collect::<String>()
                + ";"
        })
        .collect();
    board.file("long.dcml", format!("{long}; {more} END;"));
    let output = generated(&board, &["--lang", "java", "long.dcml"]);
    assert_eq!(output.code(), 1, "{}", output.stderr);
    assert!(
        output.stderr.contains("a function in java holds 3000"),
        "{}",
        output.stderr
    );
    assert_eq!(generated(&board, &["--lang", "lua", "long.dcml"]).code(), 0);
}

#[test]
fn what_the_document_says_of_other_languages_is_what_really_happens() {
    section_of_dcml_holds("Other languages", 1);
}
