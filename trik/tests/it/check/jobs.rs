//! How many run at once changes nothing: each recorded task, and what is no task, one after another and eight at a time.

use super::{drive, endless, trik, world};
use crate::diagrams::root;
use harness::Board;
use std::collections::BTreeMap;
use std::fs;
use std::io::{Cursor, Read};
use std::path::Path;

/// A folder of solutions of many kinds; their number.
fn class(board: &Board) -> usize {
    fs::create_dir(board.path("class")).expect("a folder");
    let runs =
        fs::read(root().join("tests/recorded/runs.zip")).expect("they are in the repository");
    let mut runs = zip::ZipArchive::new(Cursor::new(runs)).expect("a zip");
    let mut count = 0;
    for index in 0..runs.len() {
        let mut file = runs.by_index(index).expect("a file");
        let name = file.name().expect("a name").into_owned();
        let Some(name) = name.strip_prefix("projects/") else {
            continue;
        };
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).expect("it is whole");
        board.file(&format!("class/{name}"), bytes);
        count += 1;
    }
    let near = world(100);
    let others = [
        ("long.qrs", drive("3000", Some(&near))),
        ("short.qrs", drive("100", Some(&near))),
        ("endless.qrs", endless(&near)),
        ("rubbish.qrs", b"rubbish".to_vec()),
        ("worldless.qrs", drive("3000", None)),
    ];
    for (name, bytes) in others {
        board.file(&format!("class/zz_{name}"), bytes);
        count += 1;
    }
    count
}

/// What is in the files of a folder.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let all = fs::read_dir(folder).expect("a folder");
    all.map(|entry| {
        let entry = entry.expect("an entry");
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, fs::read(entry.path()).expect("a file"))
    })
    .collect()
}

#[test]
fn verdicts_reports_and_paths_are_the_same_however_many_run_at_once() {
    let board = Board::new();
    let count = class(&board);
    assert!(count > 280, "only {count} tasks");
    let run = |jobs: &str| {
        let (report, path) = (format!("reports{jobs}"), format!("paths{jobs}"));
        let output = trik(
            &board,
            &[
                "check",
                "class",
                "--jobs",
                jobs,
                "--results",
                "-",
                "--explain",
                "--report",
                &report,
                "--trajectory",
                &path,
            ],
        );
        let code = output.code();
        let files = [files(&board.path(&report)), files(&board.path(&path))];
        (code, output.stdout, output.stderr, files)
    };
    let (code, told, complaints, written) = run("1");
    let again = run("8");
    assert_eq!((code, again.0), (2, 2), "{complaints}");
    let mut verdicts = BTreeMap::new();
    for (one, other) in told.lines().zip(again.1.lines()) {
        assert_eq!(one, other);
        let verdict = one.split("\"verdict\":\"").nth(1).expect(one);
        *verdicts
            .entry(verdict.split('"').next().unwrap_or_default())
            .or_insert(0) += 1;
    }
    assert_eq!(told.lines().count(), count);
    assert!(told == again.1, "there are more lines of one");
    // The class is one of many kinds, so that this says something.
    assert!(verdicts.len() >= 4, "{verdicts:?}");
    for (one, other) in written.iter().zip(&again.3) {
        let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(one), names(other));
        for (name, bytes) in one {
            assert!(bytes == &other[name], "{name} differs");
        }
        assert!(one.len() > 250, "only {} files", one.len());
    }
}
