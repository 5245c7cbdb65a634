//! `trik dcml sim` and `trik dcml models` as people use them: tables, pictures, refusals with their places.

use crate::documents::section_of_dcml_holds;
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use std::fs;
use std::process::Command;

fn dcml(board: &Board, words: &[&str]) -> Output {
    let mut command = Command::new(TRIK);
    command.arg("dcml").args(words).current_dir(board.dir());
    tools::run(&mut command, b"")
}

/// A drive with wheels of 0.1 m, 0.4 m apart, and what else is said.
fn drive(board: &Board, words: &[&str]) -> Output {
    let mut all = vec!["sim", "differential-drive", "--params", "L=0.4,r=0.1"];
    all.extend(words);
    dcml(board, &all)
}

/// Lines of numbers below the first.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(row).collect()
}

#[test]
fn constant_actions_give_an_arc_by_every_solver() {
    let board = Board::new();
    for (solver, allowed) in [
        ("rk45", 1e-5),
        ("rk4", 1e-9),
        ("heun", 1e-4),
        ("euler", 1e-2),
    ] {
        let words = [
            "--actions",
            "u_l = 1; u_r = 3",
            "--t",
            "4",
            "--solver",
            solver,
        ];
        let output = drive(&board, &words);
        assert_eq!((output.code(), &*output.stderr), (0, ""), "{solver}");
        assert!(output.stdout.starts_with("t,x,y,theta,u_l,u_r\n"));
        let rows = rows(&output.stdout);
        assert_eq!(rows.len(), 201);
        for row in rows {
            // 0.2 m/s and 0.5 rad/s: a circle of 0.4 m.
            let angle = 0.5 * row[0];
            let expected = [
                0.4 * angle.sin(),
                0.4 * (1.0 - angle.cos()),
                angle,
                1.0,
                3.0,
            ];
            for (found, expected) in row[1..].iter().zip(expected) {
                assert!((found - expected).abs() < allowed, "{solver}: {row:?}");
            }
        }
    }
}

#[test]
fn tables_hold_their_actions_and_starts_are_kept() {
    let board = Board::new();
    board.file("ride.csv", "u_r,t,u_l\n1,0,1\n-1,1,-1\n0,3,0\n");
    let start = [
        "--start",
        "x=5,theta=0",
        "--actions",
        "ride.csv",
        "--t",
        "4",
        "--every",
        "1",
    ];
    let output = drive(&board, &start);
    assert_eq!(output.code(), 0, "{}", output.stderr);
    let x: Vec<f64> = rows(&output.stdout).iter().map(|row| row[1]).collect();
    for (found, expected) in x.iter().zip([5.0, 5.1, 5.0, 4.9, 4.9]) {
        assert!((found - expected).abs() < 1e-9, "{x:?}");
    }
    assert_eq!(x.len(), 5);
}

#[test]
fn angles_wrap_where_they_are_shown_and_actions_stay_in_their_range() {
    let board = Board::new();
    let words = [
        "sim",
        "dubins",
        "--params",
        "speed=1,radius=1",
        "--actions",
        "turn = 7",
        "--t",
        "6",
        "--every",
        "1",
    ];
    let output = dcml(&board, &words);
    assert_eq!(output.code(), 0);
    assert!(
        output.stderr.contains("turn would leave its range -1 .. 1"),
        "{}",
        output.stderr
    );
    let theta: Vec<f64> = rows(&output.stdout).iter().map(|row| row[3]).collect();
    for (found, expected) in theta
        .iter()
        .zip([0.0, 1.0, 2.0, 3.0, 4.0 - std::f64::consts::TAU])
    {
        assert!((found - expected).abs() < 1e-6, "{theta:?}");
    }
}

#[test]
fn a_picture_is_a_new_file_and_replaces_none() {
    let board = Board::new();
    let words = [
        "--actions",
        "u_l = 1 + sin(t); u_r = 2",
        "--t",
        "9",
        "--svg",
        "path.svg",
    ];
    let output = drive(&board, &words);
    assert_eq!(
        (output.code(), &*output.stdout),
        (0, ""),
        "{}",
        output.stderr
    );
    let picture = fs::read_to_string(board.dir().join("path.svg")).expect("the picture");
    assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
    assert_eq!(
        picture.matches("class=\"l\"").count(),
        6,
        "a path, three states, two actions"
    );
    let again = drive(&board, &words);
    assert_eq!(again.code(), 1);
    assert!(
        again.stderr.contains("is there already"),
        "{}",
        again.stderr
    );
}

#[test]
fn a_picture_may_stand_beside_a_table_and_is_asked_for_in_two_ways() {
    let board = Board::new();
    let words = ["--actions", "u_l = 1; u_r = 2", "--t", "2"];
    let read = |name: &str| fs::read_to_string(board.dir().join(name)).expect(name);
    let both = [&words[..], &["--svg", "a.svg", "-o", "a.csv"]].concat();
    assert_eq!(drive(&board, &both).code(), 0);
    assert!(read("a.csv").starts_with("t,x,y,theta,u_l,u_r\n"));
    let old = [&words[..], &["--out", "svg", "-o", "b.svg"]].concat();
    assert_eq!(drive(&board, &old).code(), 0);
    assert_eq!(read("a.svg"), read("b.svg"));
    let table = [&words[..], &["--out", "csv"]].concat();
    assert_eq!(drive(&board, &table).stdout, read("a.csv"));
    let same = [&words[..], &["--svg", "c", "-o", "c"]].concat();
    let refused = drive(&board, &same);
    assert_eq!(refused.code(), 1);
    assert!(refused.stderr.contains("is needed for something else"));
}

#[test]
fn what_cannot_be_simulated_is_told_with_its_place() {
    let board = Board::new();
    board.file("late.csv", "t,u_l,u_r\n1,0,0\n0,1,1\n");
    board.file("word.csv", "t,u_l,u_r\n0, one,0\n");
    board.file("noise.csv", b"t,u_l\xff".as_slice());
    for (words, code, told) in [
        (
            ["--actions", "late.csv", "--t", "1"],
            1,
            "late.csv:3:1: the time 0 s",
        ),
        (
            ["--actions", "word.csv", "--t", "1"],
            1,
            "word.csv:2:4: \"one\" is no number",
        ),
        (["--actions", "noise.csv", "--t", "1"], 2, "noise.csv:1:6: "),
        (
            ["--actions", "none.csv", "--t", "1"],
            2,
            "there is no such table of actions",
        ),
        (
            ["--actions", "u_l = 1", "--t", "1"],
            1,
            "no formula for u_r",
        ),
        (
            ["--actions", "u_l = 1; u_r = t +", "--t", "1"],
            1,
            "--actions:1:",
        ),
        (
            ["--actions", "u_l = 1; u_r = q", "--t", "1"],
            1,
            "--actions:1:16",
        ),
        (
            ["--actions", "u_l = 1; u_r = 1", "--t", "-1"],
            1,
            "--t: give a time",
        ),
        (
            ["--actions", "u_l = 1; u_r = 1", "--t", "nan"],
            1,
            "--t: give a time",
        ),
        (
            ["--actions", "u_l = 1; u_r = 1 / (t - t)", "--t", "1"],
            1,
            "at 0 s x or its",
        ),
    ] {
        let output = drive(&board, &words);
        assert_eq!(output.code(), code, "{words:?}: {}", output.stderr);
        assert!(output.stderr.contains(told), "{words:?}: {}", output.stderr);
    }
}

#[test]
fn a_table_with_outputs_that_are_no_numbers_is_given_as_it_is() {
    let board = Board::new();
    board.file(
        "log.dcml",
        "BEGIN L ACTION: u; CONFIG: x, o; d(x) = u; o = log(x - 0.5); END;",
    );
    let made = "sim log.dcml --actions u=1 --t 1 --every 0.25 -o table.csv";
    let output = dcml(&board, &made.split(' ').collect::<Vec<_>>());
    assert_eq!(output.code(), 0, "{}", output.stderr);
    let words = "sim log.dcml --actions table.csv --t 1 --every 0.25";
    let again = dcml(&board, &words.split(' ').collect::<Vec<_>>());
    assert_eq!(again.code(), 0, "{}", again.stderr);
    assert!(again.stdout.contains("NaN"), "{}", again.stdout);
    // What is read is not replaced.
    let over = format!("{words} -o table.csv --force");
    let refused = dcml(&board, &over.split(' ').collect::<Vec<_>>());
    assert_eq!(refused.code(), 1, "{}", refused.stderr);
    assert!(
        refused.stderr.contains("name another file"),
        "{}",
        refused.stderr
    );
}

#[test]
fn parameters_that_are_missing_are_named() {
    let board = Board::new();
    let missing = [
        "sim",
        "bicycle",
        "--actions",
        "speed = 1; steer = 0",
        "--t",
        "1",
    ];
    let output = dcml(&board, &missing);
    assert_eq!(output.code(), 1);
    assert!(
        output
            .stderr
            .contains("the model needs numbers: --params L=..."),
        "{}",
        output.stderr
    );
}

#[test]
fn a_solution_that_ends_early_is_told_and_shown_so_far() {
    let board = Board::new();
    board.file(
        "pole.dcml",
        "BEGIN Pole\nACTION: u;\nCONFIG: h;\nd(h) = u * h * h;\nEND;\n",
    );
    let words = [
        "sim",
        "pole.dcml",
        "--start",
        "h=1",
        "--actions",
        "u = 1",
        "--t",
        "2",
    ];
    let output = dcml(&board, &words);
    assert_eq!(output.code(), 1);
    assert!(output.stderr.contains(" s h "), "{}", output.stderr);
    let rows = rows(&output.stdout);
    let last = rows.last().expect("lines");
    assert!(last[0] > 0.9 && last[0] < 1.01, "{last:?}");
    let calm = rows.iter().rfind(|row| row[0] < 0.95).expect("lines");
    assert!((calm[1] * (1.0 - calm[0]) - 1.0).abs() < 1e-3, "{calm:?}");
}

#[test]
fn shipped_models_are_listed_and_printed_and_are_files_for_other_commands() {
    let board = Board::new();
    let output = dcml(&board, &["models"]);
    assert_eq!(output.code(), 0);
    let names: Vec<&str> = output
        .stdout
        .lines()
        .filter_map(|line| line.split(' ').next())
        .collect();
    assert!(names.contains(&"bart") && names.len() >= 9, "{names:?}");
    for name in names {
        let printed = dcml(&board, &["models", name]);
        assert!(printed.stdout.contains("BEGIN "), "{name}");
        assert_eq!(dcml(&board, &["lint", name]).code(), 0, "{name}");
    }
    let none = dcml(&board, &["models", "tank"]);
    assert_eq!(none.code(), 1);
    assert!(
        none.stderr
            .contains("there is no model tank; shipped models are differential-drive")
    );
}

#[test]
fn what_the_document_says_of_simulation_is_what_really_happens() {
    section_of_dcml_holds("Simulation", 3);
}
