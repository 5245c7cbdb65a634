//! One diagram on a virtual robot in three forms, as it is saved, as JavaScript and as Python: all do the same.

use super::{square, trik};
use crate::programs::Reachable;
use harness::Board;
use std::fs;

#[test]
fn a_diagram_and_the_programs_made_of_it_drive_and_print_alike() {
    let Some(one) = Reachable::new() else { return };
    let board = Board::new();
    board.file("square.qrs", square());
    let mut forms = vec![("square.qrs", square())];
    for (name, language) in [("square.js", "javascript"), ("square.py", "python")] {
        let words = ["gen", "--lang", language, "square.qrs", "-o", name];
        trik(&board, &words).good();
        forms.push((name, fs::read(board.path(name)).expect("a program")));
    }
    for (name, bytes) in forms {
        let before = one.robot.pose();
        let output = one.run(name, bytes);
        assert_eq!(
            (output.code(), &*output.stdout),
            (0, "side 1\nside 2\n"),
            "{name}: {}",
            output.stderr
        );
        // The last side began with 0. How far the wheels run out is the robot's business, not the program's.
        let left = one.robot.number("encoders/E3/value");
        let right = one.robot.number("encoders/E4/value");
        assert!(left >= 400.0, "{name}: {left}, {right}; {}", output.stderr);
        // The other one went the same way forwards, and then backwards: how far each depends on when the program was heard.
        assert!(right < left, "{name}: {left}, {right}");
        assert!(one.rests(), "{name}");
        let after = one.robot.pose();
        let driven = after.away_from(&before);
        assert!(driven > 0.005, "{name}: {driven} m");
    }
}
