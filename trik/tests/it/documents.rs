//! What documents show of a robot: transcripts in fences `sh robot` are run on a fresh one.
//!
//! Lines with `$ ` are run in order in the tree, the others are what they print. The view of ev3dev is beside the tree,
//! and trikd takes programs.

use crate::rig::{loopback, robot};
use harness::documents::examples;
use std::path::Path;

#[test]
fn every_transcript_of_a_robot_is_what_really_happens() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let mut count = 0;
    for document in [
        "README.md",
        "docs/user/start.md",
        "docs/user/simulator.md",
        "docs/user/trik.md",
        "docs/user/ev3dev.md",
        "docs/user/run.md",
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
