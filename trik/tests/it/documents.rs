//! What documents show: lines with `$ ` are run in order, the others are what they print.
//!
//! Owns how transcripts are run: those in fences `sh robot` in the tree of a fresh robot, with the view of ev3dev beside it
//! and with trikd; others in a directory. Which documents have those is known to the tests of each command.

use crate::rig::{TRIK, loopback, robot};
use harness::documents::examples;
use harness::{Board, tools};
use std::path::Path;

/// Runs the transcripts of these fences in a directory; how many steps there were, and what was not as it is written.
pub(crate) fn transcripts(
    board: &Board,
    document: &str,
    text: &str,
    fence: &str,
) -> (usize, Vec<String>) {
    let tools_dir = Path::new(TRIK).parent().expect("a directory").display();
    let path = std::env::var("PATH").unwrap_or_default();
    let (mut count, mut complaints) = (0, Vec::new());
    for example in examples(text).iter().filter(|one| one.info == fence) {
        for step in example.text.split("$ ").skip(1) {
            let (script, expected) = step.split_once('\n').unwrap_or((step, ""));
            let mut command = tools::shell(format!("exec 2>&1\n{script}"));
            command
                .current_dir(board.dir())
                .env("PATH", format!("{tools_dir}:{path}"));
            let output = tools::run(&mut command, b"");
            let (said, wanted) = (output.stdout.trim_end(), expected.trim_end());
            if said != wanted {
                let place = format!("{document}:{}: $ {script}", example.line);
                complaints.push(format!("{place}\nsaid:\n{said}\nnot:\n{wanted}\n"));
            }
            count += 1;
        }
    }
    (count, complaints)
}

/// Runs the transcripts `sh check` of a section of the page of DCML, of which there are at least so many steps.
pub(crate) fn section_of_dcml_holds(title: &str, least: usize) {
    let document = "docs/dcml.md";
    let text = std::fs::read_to_string(crate::diagrams::root().join(document)).expect(document);
    let mut sections = text.split("\n## ");
    let section = sections.find(|one| one.starts_with(title));
    let place = format!("{document} ({title})");
    let (count, complaints) = transcripts(&Board::new(), &place, section.expect(title), "sh check");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(count >= least, "only {count} examples");
}

#[test]
fn every_transcript_of_a_robot_is_what_really_happens() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let mut count = 0;
    for document in [
        "README.md",
        "docs/user/start.md",
        "docs/ru/start.md",
        "docs/user/simulator.md",
        "docs/user/trik.md",
        "docs/user/ev3dev.md",
        "docs/user/run.md",
        "docs/ru/run.md",
        "docs/user/drive.md",
    ] {
        let Ok(text) = std::fs::read_to_string(root.join(document)) else {
            continue;
        };
        for example in examples(&text) {
            if example.info != "sh robot" {
                continue;
            }
            let Some(robot) = robot(&["--ev3dev", "--trikd-address", &loopback()]) else {
                return;
            };
            count += 1;
            for step in example.text.split("$ ").skip(1) {
                let (script, expected) = step.split_once('\n').unwrap_or((step, ""));
                let output = robot.sh(&format!("exec 2>&1\n{script}"));
                let place = format!("{document}:{}: $ {script}", example.line);
                assert_eq!(output.stdout.trim_end(), expected.trim_end(), "{place}");
            }
        }
    }
    assert!(count > 0, "no document shows a robot");
}
