//! `trik dcml plan` as people use it: paths in rooms and in worlds of TRIK Studio, files, refusals.
//!
//! Models, rooms and small worlds are made here; the labyrinth is real data.

use crate::documents::section_of_dcml_holds;
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use std::fs;
use std::process::Command;

const MODELS: &str = "
BEGIN Drive
ACTION: u_l, u_r; PARAM: L, r; CONFIG: x, y, theta;
d(x) = r / 2 * (u_l + u_r) * cos(theta);
d(y) = r / 2 * (u_l + u_r) * sin(theta);
d(theta) = (r / L) * (u_r - u_l);
END;
BEGIN Car
ACTION: v in -0.5 .. 0.5, steer in -0.6 .. 0.6; CONFIG: X, Y, theta in S1;
d(X) = v * cos(theta); d(Y) = v * sin(theta); d(theta) = v / 0.3 * tan(steer);
END;
BEGIN Cart
ACTION: push in -1 .. 1; CONFIG: position, speed;
d(position) = speed; d(speed) = push;
END;
BEGIN Far
ACTION: u in -1 .. 1, w in -2 .. 2; CONFIG: a, b, c in S1, x, y, theta;
d(a) = u * cos(c); d(b) = u * sin(c); d(c) = w; x = 2 * a + 1; y = 2 * b + 1; theta = c + 0;
END;
";

const ROOM: &str =
    "bounds 0 0 4 3\nwall 2 0 2 2.4 0.05 # with a gap above\nrectangle 2.8 0.9 3.2 1.3\n";

fn board() -> Board {
    let board = Board::new();
    board.file("models.dcml", MODELS);
    board.file("room.txt", ROOM);
    board
}

fn plan(board: &Board, model: &str, words: &str) -> Output {
    let mut command = Command::new(TRIK);
    command
        .args(["dcml", "plan", "models.dcml", "--model", model])
        .args(words.split_whitespace())
        .current_dir(board.dir());
    tools::run(&mut command, b"")
}

const DRIVE: &str = "--params L=0.2,r=0.03 --actions u_l=-5..15,u_r=-5..15";

/// Lines of numbers below the first.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(row).collect()
}

#[test]
fn a_path_is_written_drawn_and_told() {
    let board = board();
    let words = format!(
        "{DRIVE} --start x=0.5,y=0.5 --goal x=3.5,y=2.5,theta=0 --obstacles room.txt --json -o path.csv --svg room.svg"
    );
    let output = plan(&board, "Drive", &words);
    assert_eq!((output.code(), output.stderr.as_str()), (0, ""));
    assert!(
        output.stdout.starts_with("{\"found\":true,\"duration\":"),
        "{}",
        output.stdout
    );
    let table = fs::read_to_string(board.path("path.csv")).unwrap();
    assert_eq!(table.lines().next(), Some("t,u_l,u_r,x,y,theta"));
    let rows = rows(&table);
    assert_eq!(rows[0][0], 0.0);
    assert_eq!(&rows[0][3..], [0.5, 0.5, 0.0]);
    let end = rows.last().unwrap();
    assert!((end[3] - 3.5).hypot(end[4] - 2.5) <= 0.1 && end[5].sin().abs() <= 0.2);
    for (before, row) in rows.iter().zip(&rows[1..]) {
        assert!((row[0] - before[0] - 0.05).abs() < 1e-9);
        assert!((-5.0..=15.0).contains(&row[1]) && (-5.0..=15.0).contains(&row[2]));
        // The wall and its gap, with the robot's own radius.
        assert!((row[3] - 2.0).abs() > 0.125 || row[4] > 2.4);
    }
    let picture = fs::read_to_string(board.path("room.svg")).unwrap();
    assert!(picture.starts_with("<svg ") && picture.ends_with("</svg>\n"));
    assert!(picture.matches("<path ").count() >= 5);
    // Files that are there stay; the same seed finds the same path.
    let output = plan(&board, "Drive", &words);
    assert_eq!(output.code(), 2);
    assert!(
        output
            .stderr
            .contains("path.csv is there already: --force replaces it")
    );
    assert_eq!(plan(&board, "Drive", &format!("{words} --force")).code(), 0);
    assert_eq!(fs::read_to_string(board.path("path.csv")).unwrap(), table);
    let output = plan(
        &board,
        "Drive",
        &words.replace("-o path.csv", "-o - --force"),
    );
    assert_eq!(output.stdout, table);
    assert!(output.stderr.starts_with("{\"found\":true"));
}

#[test]
fn a_path_followed_by_the_simulator_ends_in_the_goal() {
    let board = board();
    let words = "--start X=0.5,Y=0.5 --goal X=3.5,Y=2.5 --obstacles room.txt -o path.csv";
    let output = plan(&board, "Car", words);
    assert_eq!(output.code(), 0, "{}", output.stderr);
    let rows_planned = rows(&fs::read_to_string(board.path("path.csv")).unwrap());
    let last = rows_planned.last().unwrap();
    let mut command = Command::new(TRIK);
    command
        .args(["dcml", "sim", "models.dcml", "--model", "Car"])
        .args(["--start", "X=0.5,Y=0.5", "--actions", "path.csv"])
        .args([
            "--t",
            &last[0].to_string(),
            "--solver",
            "rk4",
            "--step",
            "0.05",
        ])
        .current_dir(board.dir());
    let output = tools::run(&mut command, b"");
    assert_eq!(output.code(), 0, "{}", output.stderr);
    let header: Vec<&str> = output.stdout.lines().next().unwrap().split(',').collect();
    let at = |name| header.iter().position(|one| *one == name).unwrap();
    let simulated = rows(&output.stdout);
    let end = simulated.last().unwrap();
    assert!((end[at("X")] - last[3]).abs() < 1e-6, "{end:?} {last:?}");
    assert!((end[at("Y")] - last[4]).abs() < 1e-6, "{end:?} {last:?}");
}

#[test]
fn sst_finds_shorter_paths_the_longer_it_searches() {
    let board = board();
    let durations: Vec<f64> = ["3000", "30000"]
        .map(|iterations| {
            let words = format!(
                "{DRIVE} --start x=0.5,y=0.5 --goal x=3.5,y=2.5 --obstacles room.txt --planner sst --iterations \
                 {iterations} --json"
            );
            let output = plan(&board, "Drive", &words);
            assert_eq!(output.code(), 0, "{}{}", output.stdout, output.stderr);
            let (_, rest) = output.stdout.split_once("\"duration\":").unwrap();
            rest.split(',').next().unwrap().parse().unwrap()
        })
        .into();
    assert!(
        durations[1] < 0.9 * durations[0] && durations[1] < 20.0,
        "{durations:?}"
    );
}

#[test]
fn the_labyrinth_of_trik_is_left() {
    let Some(data) = needs::data() else {
        return;
    };
    let path = data.join("worlds/labyrinth-without-sensors.xml");
    let board = board();
    fs::copy(&path, board.path("labyrinth.xml")).unwrap();
    // Its numbers count as centimetres. From beside the walls to the finish on the other side.
    let words = format!(
        "{DRIVE} --field labyrinth.xml --goal x=5.25,y=3.25 --goal-radius 0.3 --bounds x=-4.5..6,y=-2..4 --svg \
         labyrinth.svg --json --iterations 300000"
    );
    let output = plan(&board, "Drive", &words);
    assert_eq!(output.code(), 0, "{}{}", output.stdout, output.stderr);
    // Behind a wall all around nothing is reached.
    let walls: String = fs::read_to_string(&path).unwrap().replace(
        "<walls>",
        "<walls><wall begin=\"400:-450\" end=\"650:-450\" id=\"\"/><wall begin=\"400:-450\" end=\"400:-200\" id=\"\"/>\
         <wall begin=\"400:-200\" end=\"650:-200\" id=\"\"/><wall begin=\"650:-450\" end=\"650:-200\" id=\"\"/>",
    );
    board.file("closed.xml", walls);
    let words = words
        .replace("labyrinth", "closed")
        .replace("300000", "2000");
    let output = plan(&board, "Drive", &words);
    assert_eq!(output.code(), 1, "{}{}", output.stdout, output.stderr);
    assert!(
        output
            .stdout
            .starts_with("{\"found\":false,\"ended\":\"iterations\"")
    );
}

#[test]
fn a_pose_that_is_computed_is_planned_for() {
    let board = board();
    let words = "--goal x=3,y=2 --obstacles room.txt -o path.csv --hold 0.1..0.5";
    let start = "--start a=-0.25,b=-0.25 ";
    let output = plan(&board, "Far", &format!("{start}{words}"));
    assert_eq!(output.code(), 0, "{}{}", output.stdout, output.stderr);
    let table = fs::read_to_string(board.path("path.csv")).unwrap();
    assert_eq!(table.lines().next(), Some("t,u,w,a,b,c,x,y,theta"));
    let end = rows(&table).pop().unwrap();
    assert!((end[6] - 3.0).hypot(end[7] - 2.0) <= 0.1);
    let output = plan(&board, "Far", &format!("--start x=0.5 {words} --force"));
    assert_eq!(output.code(), 2);
    assert!(
        output
            .stderr
            .contains("x is computed from the state: say --start a=...,b=...,c=...")
    );
}

/// Model, what is said, exit code, and a part of the answer.
const CASES: &[(&str, &str, i32, &str)] = &[
    (
        "Drive",
        "--goal x=1",
        2,
        "the model needs numbers: --params L=...,r=...",
    ),
    (
        "Drive",
        "--params L=0.2,r=0.03 --goal x=1",
        2,
        "actions have no range: say --actions u_l=LOW..HIGH,u_r=LOW..HIGH",
    ),
    (
        "Car",
        "--goal z=1",
        2,
        "--goal: there is no state or output \"z\"; there are X, Y, theta",
    ),
    ("Car", "--goal X=NaN", 2, "NaN is not from"),
    ("Car", "--goal X=1e308", 2, "1e308 is not from"),
    ("Car", "", 2, "--goal"),
    (
        "Car",
        "--goal X=1,Y=1 --obstacles none.txt",
        2,
        "none.txt: ",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --obstacles models.dcml",
        2,
        "is no kind of obstacle",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --field models.dcml",
        2,
        "models.dcml: ",
    ),
    (
        "Car",
        "--goal X=3,Y=1.1 --start X=1,Y=1 --obstacles room.txt",
        2,
        "no place in the goal is free",
    ),
    (
        "Car",
        "--goal X=9,Y=1.1 --start X=1,Y=1 --obstacles room.txt",
        2,
        "no place in the goal is free",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --start X=2,Y=1 --obstacles room.txt",
        2,
        "the start is not free: the robot touches the ",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --start X=9,Y=1 --obstacles room.txt",
        2,
        "the start is not free: X is 9 there, outside of ",
    ),
    (
        "Car",
        "--goal Xx=1,Y=1 --link X,Y,X,Y=0.01",
        2,
        "there is no state or output \"Xx\"",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --link X,Y,X,Y=0.01",
        2,
        "a link joins a point to itself: name two points",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --start X=1,Y=1 --obstacles room.txt",
        0,
        "Path of 0.00 s",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --footprint polygon:0,0,1,0,2,0",
        2,
        "the footprint has no area",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --position X",
        2,
        "--position: write X,Y",
    ),
    (
        "Car",
        "--goal X=1,Y=1 --position X,Y --footprint polygon:0,0,1,0,0,1",
        2,
        "no heading is known",
    ),
    (
        "Car",
        "--goal X=3,Y=1 --actions v=0..0",
        1,
        "No path: all samples are used up.",
    ),
    (
        "Car",
        "--goal X=3,Y=1 --step 1e-9",
        2,
        "an action is held for 1 to",
    ),
    (
        "Car",
        "--goal X=3,Y=1 --goal-bias 2",
        2,
        "is not from 0 to 1",
    ),
    (
        "Cart",
        "--goal position=1",
        2,
        "the model has no x and y: say which of its states",
    ),
    (
        "Cart",
        "--goal position=1,speed=0 --position position,speed --bounds speed=-1..1 --goal-radius 0.1",
        0,
        "Path of ",
    ),
    ("Nobody", "--goal x=1", 2, "there is no model Nobody"),
];

#[test]
fn what_is_missing_or_wrong_is_said() {
    let board = board();
    let mut complaints = Vec::new();
    for (model, words, code, part) in CASES {
        let words = format!("{words} --iterations 20000");
        let output = plan(&board, model, &words);
        let told = format!("{}{}", output.stdout, output.stderr);
        if output.code() != *code || !told.contains(part) {
            complaints.push(format!("{model} {words}\n{}: {told}", output.code()));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn the_time_is_a_limit() {
    let board = board();
    board.file("closed.txt", "bounds 0 0 4 3\nwall 2 -1 2 4 0\n");
    let words = "--start X=1,Y=1 --goal X=3,Y=1 --obstacles closed.txt --time-limit 0.3 --json";
    let output = plan(&board, "Car", words);
    assert_eq!(output.code(), 1, "{}", output.stderr);
    assert!(
        output.stdout.contains("\"ended\":\"time\""),
        "{}",
        output.stdout
    );
}

#[test]
fn sst_ends_with_its_time_and_not_with_its_samples() {
    let board = board();
    let words = "--start X=1,Y=1 --goal X=3,Y=2 --planner sst --time-limit 0.3 --json";
    let output = plan(&board, "Car", words);
    assert!(
        output.stdout.contains("\"ended\":\"time\""),
        "{}{}",
        output.stdout,
        output.stderr
    );
}

#[test]
fn a_model_without_numbers_at_the_start_is_refused() {
    let board = board();
    board.file(
        "root.dcml",
        "BEGIN R ACTION: u in -1 .. 1; CONFIG: x in -9 .. 9, y in -9 .. 9; d(x) = sqrt(-1 - u * u); d(y) = u; END;",
    );
    let words = ["dcml", "plan", "root.dcml", "--goal", "x=1"];
    let mut command = Command::new(TRIK);
    let output = tools::run(command.args(words).current_dir(board.dir()), b"");
    assert_eq!(output.code(), 2, "{}", output.stderr);
    assert!(
        output.stderr.contains("gives no finite numbers"),
        "{}",
        output.stderr
    );
}

#[test]
fn what_the_document_says_of_planning_is_what_really_happens() {
    section_of_dcml_holds("Planning", 5);
}
