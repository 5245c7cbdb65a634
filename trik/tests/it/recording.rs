//! What people do with a recording: cut it, make a table and a picture of it.
//!
//! Owns the recording of a made-up robot that these tests and the document use.

use crate::documents::transcripts;
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use journal::node::Node;
use journal::standard::{Level, Log};
use journal::write::{ABOUT, Writer};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::process::Command;

const MS: u64 = 1_000_000;
/// 2023-11-14 22:13:20 UTC.
const ZERO: u64 = 1_700_000_000_000 * MS;

fn trik(board: &Board, words: &[&str]) -> Output {
    let mut command = Command::new(TRIK);
    command.args(words).current_dir(board.dir());
    tools::run(&mut command, b"")
}

/// What is told of a command that is refused.
fn why_not(board: &Board, words: &[&str]) -> String {
    let output = trik(board, words);
    assert_eq!(output.status.code(), Some(1), "{}", output.stderr);
    output.stderr
}

/// 10 s: a distance sensor at 50 Hz that is unplugged for 2 s, a motor that is told three powers, a text.
fn record(path: &Path) {
    let file = BufWriter::new(File::create_new(path).expect("a new file"));
    let mut out = Writer::new(file, "test 1").expect("begun");
    let facts = BTreeMap::from([("robot".to_owned(), "two-wheels".to_owned())]);
    out.facts(ABOUT, facts).expect("facts");
    out.attach(ZERO, "config.lua", "text/x-lua", b"trikfs = {}")
        .expect("a file");
    let mut distance = Node::sensor("sensors/D1", "u16 distance");
    distance.units = "cm".to_owned();
    let mut motor = Node::sensor("motors/M1", "i32 power");
    (motor.units, motor.is_written, motor.rest) = ("%".to_owned(), true, "0".to_owned());
    let [distance, motor] = [distance, motor].map(|node| out.add(&node).expect("a node"));
    let code = out.add(&Node::sensor("code", "text 16")).expect("a node");
    for step in 0..=500_u32 {
        let at = ZERO + u64::from(step) * 20 * MS;
        match step {
            200 => out.fault(distance, at, 19, "device: unplugged"),
            201..300 => Ok(()),
            _ => {
                let centimetres = u16::try_from(80 - (step % 100) / 2).expect("fits");
                out.sample(distance, at, &centimetres.to_le_bytes())
            }
        }
        .expect("written");
        let power: i32 = match step {
            50 => 60,
            250 => -60,
            450 => 0,
            _ => continue,
        };
        out.sample(motor, at, &power.to_le_bytes())
            .expect("written");
    }
    let text = b"=1+1, \"red\"\0\0\0\0\0";
    out.sample(code, ZERO + 10_000 * MS, text).expect("written");
    let line = Log {
        level: Level::Warn,
        name: "trikfs".to_owned(),
        text: "a line".to_owned(),
        errno: 0,
    };
    out.log(ZERO, &line).expect("written");
    out.finish().expect("finished");
}

fn recorded() -> Board {
    let board = Board::new();
    record(&board.dir().join("run.mcap"));
    board
}

#[test]
fn the_document_of_recordings_is_what_really_happens() {
    let document = "docs/user/journal.md";
    let text = fs::read_to_string(crate::diagrams::root().join(document)).expect(document);
    let board = recorded();
    let (count, complaints) = transcripts(&board, document, &text, "sh check");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(count >= 5, "only {count} examples");
}

#[test]
fn a_file_that_goes_with_a_recording_goes_where_the_person_says() {
    let board = Board::new();
    let file = File::create_new(board.dir().join("run.mcap")).expect("a new file");
    let mut out = Writer::new(BufWriter::new(file), "test 1").expect("begun");
    let hostile = "../../tmp/\u{1b}[2J/etc/passwd";
    for (name, bytes) in [
        ("config.lua", "old"),
        (hostile, "harm"),
        ("config.lua", "trikfs = {}"),
    ] {
        out.attach(ZERO, name, "text/x-lua", bytes.as_bytes())
            .expect("a file");
    }
    out.finish().expect("finished");
    let info = trik(&board, &["info", "run.mcap"]).good();
    assert!(info.contains("file      config.lua (11 bytes)"), "{info}");
    assert!(!info.contains('\u{1b}'), "{info}");
    let words = ["info", "run.mcap", "--attachment", "config.lua"];
    assert_eq!(trik(&board, &words).good(), "trikfs = {}");
    // Its name is no path.
    let words = ["info", "run.mcap", "--attachment", hostile, "-o", "taken"];
    trik(&board, &words).good();
    let taken = fs::read_to_string(board.dir().join("taken")).expect("a file");
    assert_eq!(taken, "harm");
    let refused = why_not(&board, &words);
    assert!(refused.contains("taken is there already"), "{refused}");
    let onto = [
        "info",
        "run.mcap",
        "--attachment",
        "config.lua",
        "-o",
        "run.mcap",
        "--force",
    ];
    assert_eq!(trik(&board, &onto).status.code(), Some(1));
    let refused = why_not(&board, &["info", "run.mcap", "--attachment", "x.py"]);
    assert!(
        refused.contains("no file x.py goes with it; there are config.lua, ../"),
        "{refused}"
    );
    assert!(!refused.contains('\u{1b}'), "{refused}");
}

#[test]
fn a_table_has_each_number_in_its_column_and_no_formula() {
    let board = recorded();
    let table = trik(&board, &["export", "run.mcap", "-o", "run.csv"]).good();
    assert_eq!(table, "");
    let table = fs::read_to_string(board.dir().join("run.csv")).expect("a table");
    let lines: Vec<&str> = table.split('\n').collect();
    assert_eq!(
        lines[0],
        "time_s,sensors/D1.distance,motors/M1.power,code,fault"
    );
    assert_eq!(lines[1], "0.0,80,,,");
    assert!(lines.contains(&"1.0,,60,,"), "{table}");
    let fault = "4.0,,,,sensors/D1: errno 19: device: unplugged";
    assert!(lines.contains(&fault), "{table}");
    let code = "10.0,,,\"'=1+1, \"\"red\"\"\",";
    assert!(lines.contains(&code), "{table}");
    // 401 distances, 3 powers, a text, a failure; the names; nothing after the last line end.
    assert_eq!(lines.len(), 401 + 3 + 1 + 1 + 1 + 1);
    let words = [
        "export", "run.mcap", "--only", "motors", "--from", "2", "--to", "5",
    ];
    let some = trik(&board, &words).good();
    assert_eq!(some, "time_s,motors/M1.power,fault\n5.0,-60,\n");
    let words = ["export", "run.mcap", "-o", "run.ods"];
    let refused = why_not(&board, &words);
    assert!(
        refused.contains("its name ends with .csv or .parquet"),
        "{refused}"
    );
    // The older spelling of the ending.
    trik(&board, &["export", "run.mcap", "--csv", "-o", "table"]).good();
    let old = fs::read_to_string(board.dir().join("table")).expect("a table");
    assert_eq!(old, table);
}

#[test]
fn a_piece_is_a_recording_with_everything_that_explains_it() {
    let board = recorded();
    let words = [
        "cut",
        "run.mcap",
        "--from",
        "4",
        "--to",
        "6",
        "--only",
        "sensors",
        "--only",
        "faults",
        "-o",
        "piece.mcap",
    ];
    let told = trik(&board, &words).good();
    assert_eq!(told, "piece.mcap: 2 messages\n");
    let told = trik(&board, &["info", "piece.mcap"]).good();
    for part in [
        "piece.mcap: 2.0 s, 2 messages",
        "config.lua (11 bytes)",
        "u16 distance",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    let again = why_not(&board, &words);
    assert!(again.contains("piece.mcap is there already"), "{again}");
    let words = ["cut", "run.mcap", "-o", "run.mcap", "--force"];
    let over = why_not(&board, &words);
    assert!(over.contains("is the file that is read"), "{over}");
    let words = ["cut", "run.mcap", "--from", "11", "-o", "none.mcap"];
    let late = why_not(&board, &words);
    assert!(late.contains("is 10.0 s long"), "{late}");
    let left: Vec<_> = fs::read_dir(board.dir())
        .expect("a folder")
        .flatten()
        .collect();
    let is_new = |name: &str| name.ends_with(".new") || name == "none.mcap";
    assert!(
        !left
            .iter()
            .any(|one| is_new(&one.file_name().to_string_lossy())),
        "{left:?}"
    );
}

#[test]
fn a_picture_has_a_panel_for_each_number_and_marks_failures() {
    let board = recorded();
    let words = [
        "plot",
        "run.mcap",
        "sensors/D1.distance",
        "motors",
        "-o",
        "run.svg",
    ];
    assert_eq!(trik(&board, &words).good(), "");
    let picture = fs::read_to_string(board.dir().join("run.svg")).expect("a picture");
    for part in [
        ">sensors/D1.distance, cm<",
        ">motors/M1.power, %<",
        "#c0392b",
    ] {
        assert!(picture.contains(part), "{part}");
    }
    assert_eq!(picture.matches("class=\"l\"").count(), 2);
    for (words, why) in [
        (
            ["plot", "run.mcap", "nobody", "-o", "x.svg"],
            "no node with numbers is nobody",
        ),
        (
            ["plot", "run.mcap", "code", "-o", "x.svg"],
            "no node with numbers is code",
        ),
        (
            ["plot", "run.mcap", "motors", "-o", "x.jpeg"],
            "its name ends with .svg or .png",
        ),
        (
            ["plot", "run.mcap", "motors", "-o", "run.svg"],
            "is there already",
        ),
    ] {
        let refused = why_not(&board, &words);
        assert!(refused.contains(why), "{refused}");
    }
}

#[test]
fn a_picture_of_pixels_has_the_same_panels_lines_and_marks() {
    let board = recorded();
    let words = [
        "plot",
        "run.mcap",
        "sensors/D1.distance",
        "motors",
        "-o",
        "run.png",
    ];
    assert_eq!(trik(&board, &words).good(), "");
    let file = fs::read(board.dir().join("run.png")).expect("a picture");
    let pixels = screen::picture::decode(&file).expect("a picture");
    assert_eq!((pixels.width(), pixels.height()), (2 * 660, 2 * 362));
    let count = |colour: u32, rows: std::ops::Range<i32>| {
        rows.flat_map(|y| (0..1320).map(move |x| (x, y)))
            .filter(|(x, y)| pixels.at(*x, *y).map(|one| one.number()) == Some(colour))
            .count()
    };
    let (first, second) = (0..362, 362..724);
    let (line, mark) = (0x0057b8, 0xc0392b);
    assert!(count(line, first.clone()) > 1500 && count(line, second.clone()) > 1500);
    assert_eq!(count(mark, first), 4 * 17);
    assert_eq!(count(mark, second), 0);
}

#[test]
fn files_that_are_no_recordings_are_refused_by_every_command() {
    let board = Board::new();
    board.file("no.mcap", "no recording");
    for words in [
        &["cut", "no.mcap", "-o", "x"] as &[&str],
        &["export", "no.mcap"],
        &["plot", "no.mcap", "a", "-o", "x.svg"],
    ] {
        let refused = why_not(&board, words);
        assert!(refused.contains("no recording"), "{words:?}: {refused}");
    }
    let refused = why_not(&board, &["plot", "/dev/zero", "a", "-o", "x.svg"]);
    assert!(refused.contains("a regular file"), "{refused}");
}
