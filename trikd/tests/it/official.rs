//! The table of what the controller's own runtime has: each row is called, in both languages, on a tree of files.

use crate::rig::{Robot, small_tree};
use harness::put;
use std::fmt::Write;
use std::path::Path;

/// A row: the call, and what the document says of it in JavaScript and in Python.
type Row = [String; 3];

fn rows() -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/user/official.md");
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    let rows = rows.map(|line| {
        let mut cells = line.trim_matches('|').split('|').map(str::trim);
        let mut cell = || cells.next().unwrap().trim_matches('`').to_owned();
        [cell(), cell(), cell()]
    });
    rows.collect()
}

/// What is wrong with the rows of one language, which prints what comes of each.
fn complaints(name: &str, text: &str, rows: &[Row], language: usize) -> Vec<String> {
    let home = small_tree();
    crate::javascript::fill(&home.path("tree"));
    for (file, content) in [
        ("camera/object/value", "1 2 3\n"),
        ("camera/object/hsv", "1 2 3 4 5 6\n"),
        ("camera/object/video_out", ""),
        ("accelerometer/raw", "1 2 3\n"),
        ("gyroscope/raw", "1 2 3\n"),
        ("gamepad/text/value", "pad 1 up\n"),
        ("keys/device", ""),
        ("gamepad/buttons/presses", "0 1 0 0 0\n"),
        ("microphones/value", "1 2 3\n"),
        ("i2c/bus1/device", ""),
        ("input/event0/value", ""),
        ("input/event0/device", ""),
    ] {
        put(&home.path("tree"), file, content);
    }
    let tree = home.path("tree");
    let robot = Robot::start(home, tree, &[]);
    let mut client = robot.client("control");
    client.send(&format!("file:{name}:{text}"));
    client.send(&format!("run:{name}"));
    let mut found = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let told = client.until(&format!("print: ROW {index} "));
        let works = told.contains(" works");
        let is_there = !row[language].starts_with("absent: ");
        if works != is_there {
            found.push(format!("{name}: {}: {} but {told}", row[0], row[language]));
        }
    }
    found
}

#[test]
fn the_table_says_what_is_there() {
    let rows = rows();
    assert!(rows.len() > 200, "{}", rows.len());
    for row in &rows {
        for cell in &row[1..] {
            let says_why = ["differs: ", "absent: "]
                .iter()
                .any(|word| cell.starts_with(word));
            assert!(cell == "there" || says_why, "{row:?}");
        }
    }
    let mut javascript = String::from(
        "function row(n, f) { var t; try { var v = f(); t = v === undefined && !/[)]$/.test(f.text) ? 'is undefined' : 'works'; } \
         catch (e) { t = 'fails: ' + e; } print('ROW ' + n + ' ' + t); }\nvar f;\n",
    );
    let mut python = String::from(
        "true, false = True, False\n\
         def row(n, f):\n\
         \x20   try:\n        f()\n        told = 'works'\n\
         \x20   except Exception as error:\n        told = 'fails: %s: %s' % (type(error).__name__, error)\n\
         \x20   print('ROW', n, told)\n",
    );
    for (index, [call, ..]) in rows.iter().enumerate() {
        let _ = writeln!(
            javascript,
            "f = function() {{ return {call}; }}; f.text = {call:?}; row({index}, f);"
        );
        let _ = writeln!(python, "row({index}, lambda: {call})");
    }
    javascript.push_str("script.quit();\n");
    let mut found = complaints("official.js", &javascript, &rows, 1);
    found.extend(complaints("official.py", &python, &rows, 2));
    assert!(found.is_empty(), "{}", found.join("\n"));
}
