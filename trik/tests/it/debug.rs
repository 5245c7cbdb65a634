//! `trik debug` and `trik dap` as people and editors use them.

/// A coefficient that changes while the robot drives.
mod coefficient;
/// Frames that an editor sends, and some that none does.
mod dap;
/// Its breakpoints over a restart, and what it writes into its launch.
mod dap_told;
/// Data-flow programs in a simulated world.
mod flow;
/// Programs in Python under debugpy.
mod python;
/// Their restart, and other processes at the door.
mod python_again;
/// Another version of what runs on a robot, from an editor.
mod restart;
/// Programs in JavaScript.
mod script;
/// Lines that a person edits.
mod typed;
/// Who debugs, for others, and in which language they hear of it.
mod who;

use crate::programs::Reachable;
use crate::rig::TRIK;
use harness::{Board, Output, eventually, tools};
use lang_diagram::sketch::Sketch;
use std::process::Command;

/// Counts to 5 with a call in each round: lines 1 to 6 are the program, from 8 on the subprogram.
pub(super) fn counting() -> Vec<u8> {
    counting_by("n = n + 1\nprint(n)")
}

/// The same blocks with another body of the one that counts.
pub(super) fn counting_by(body: &str) -> Vec<u8> {
    counting_with(body, None)
}

/// The same after one more block, which moves all others down by a line.
pub(super) fn counting_after(first: &str) -> Vec<u8> {
    counting_with("n = n + 1\nprint(n)", Some(first))
}

fn counting_with(body: &str, first: Option<&str>) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let twice = sketch.subprogram("twice", &[]);
    sketch.draw_on(twice);
    let begin = sketch.block("InitialNode", &[]);
    let double = sketch.block("Function", &[("Body", "m = n * 2")]);
    let back = sketch.block("FinalNode", &[]);
    sketch.chain(&[begin, double, back]);
    let main = sketch.main();
    sketch.draw_on(main);
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0")]);
    let head = sketch.block("Loop", &[("Iterations", "5")]);
    let count = sketch.block("Function", &[("Body", body)]);
    let call = sketch.call(twice, &[]);
    let wait = sketch.block("Timer", &[("Delay", "100")]);
    let end = sketch.block("FinalNode", &[]);
    // The last one drawn, so that all others have the ids that they have without it.
    let first = first.map(|first| sketch.block("Function", &[("Body", first)]));
    let begin: Vec<_> = [Some(start), first, Some(clear), Some(head)]
        .into_iter()
        .flatten()
        .collect();
    sketch.chain(&begin);
    sketch.guarded(head, count, "iteration");
    sketch.chain(&[count, call, wait, head]);
    sketch.link(head, end);
    sketch.qrs().expect("a save")
}

fn debug(board: &Board, words: &[&str], typed: &str) -> Output {
    let mut command = Command::new(TRIK);
    command.args(words).current_dir(board.dir());
    tools::run(&mut command, typed.as_bytes())
}

#[test]
fn a_diagram_is_stopped_stepped_and_taken_back() {
    let board = Board::new();
    board.file("count.qrs", counting());
    let typed = "list 1\nbreak 4 if n == 3\nc\np n * 10\nn\ns\nbt\nrn\nrc\nstart\nprint n\npresent\n\
        set n=7\np n\ninfo variables\nd\nc\nrn\nwhere\nq\n";
    let told = debug(&board, &["debug", "count.qrs"], typed).good();
    insta::assert_snapshot!(told);
}

#[test]
fn a_variable_is_watched_forwards_and_backwards() {
    let board = Board::new();
    board.file("count.qrs", counting());
    let typed = "watch nn\nwatch n if n >\nwatch n if n > 2\nbreak 4 if n = 3\ndprintf 4 n is {n +}\nc\nc\n\
        info breakpoints\nrc\nrc\np n\nq\n";
    let told = debug(&board, &["debug", "count.qrs"], typed).good();
    insta::assert_snapshot!(told);
}

/// Asks for a number and prints ten times of it.
fn asking(default: &str) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let question = [
        ("variable", "n"),
        ("prompt", "How many?"),
        ("default", default),
    ];
    let ask = sketch.block("Input", &question);
    let said = sketch.block("Function", &[("Body", "print(n * 10)")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, ask, said, end]);
    sketch.qrs().expect("a save")
}

#[test]
fn a_block_that_asks_is_answered_by_the_next_line() {
    let board = Board::new();
    board.file("ask.qrs", asking("1"));
    board.file("bare.qrs", asking(""));
    board.file("answers.txt", "7\n");
    let words = ["debug", "ask.qrs"];
    let said = |words: &[&str], typed: &str| debug(&board, words, typed).good();
    for (typed, heard) in [
        ("c\n2 + 2\nq\n", "(trik) c\nHow many? [1] 2 + 2\n40\n"),
        ("c\n\nq\n", "(trik) c\nHow many? [1]\n10\n"),
        // A line of the debugger is one again afterwards.
        ("break 3\nc\n6\np n + 1\nrn\nq\n", "How many? [1] 6\n"),
        ("break 3\nc\n6\np n + 1\nrn\nq\n", "(trik) p n + 1\n7\n"),
    ] {
        let told = said(&words, typed);
        assert!(told.contains(heard), "{typed}: {told}");
        assert!(!told.contains("nobody"), "{told}");
    }
    let told = said(&words, "c\n");
    let nobody = "How many? [1]\nnobody is there to answer any more: ";
    assert!(told.contains(nobody) && told.contains("\n10\n"), "{told}");
    assert_eq!(told.matches("nobody").count(), 1, "{told}");
    let told = said(&["debug", "bare.qrs", "--inputs", "answers.txt"], "c\nq\n");
    assert!(told.contains("(trik) c\n70\n"), "{told}");
    assert!(!told.contains("How many?"), "{told}");
    let limit = ["debug", "bare.qrs", "--time-limit", "1", "--language", "ru"];
    let told = said(&limit, "c\n");
    let nobody = "\u{43e}\u{442}\u{432}\u{435}\u{447}\u{430}\u{442}\u{44c} ";
    assert_eq!(told.matches(nobody).count(), 1, "{told}");
}

#[test]
fn all_breakpoints_are_listed() {
    let board = Board::new();
    board.file("count.qrs", counting());
    let mut typed: String = (0..999)
        .map(|number| format!("dprintf 4 {number} {}\n", "x".repeat(300)))
        .collect();
    typed.push_str("i b\nq\n");
    let told = debug(&board, &["debug", "count.qrs"], &typed).good();
    let listed = told.split("(trik) i b\n").nth(1).expect("a list");
    assert_eq!(listed.matches(", hits: 0, writes ").count(), 999);
}

#[test]
fn a_block_is_named_by_its_caption_and_a_subprogram_by_its_name() {
    let board = Board::new();
    board.file("count.qrs", counting());
    let typed = "break twice\nbreak Timer if n > 3\nbreak Function\nbreak Tmier\nlist twice\nc\nbreak n\nd 1\nc\np n\nq\n";
    let told = debug(&board, &["debug", "count.qrs"], typed).good();
    for line in [
        "(trik) break twice\nbreakpoint 1 at line 9: ",
        "(trik) break Timer if n > 3\nbreakpoint 2 at line 6: Timer: 100\n",
        "(trik) break Function\n'Function' means several blocks; give the line of one: ",
        ", 4 (Function: n = n + 1; print(n))",
        "nor a subprogram; list shows the lines; did you mean 'Timer'?\n",
        "thread main: breakpoint 1\n>   9 ",
        "; n is a variable: watch n stops after it changes\n",
        "thread main: breakpoint 2\n>   6 ",
        "(trik) p n\n4\n",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
}

#[test]
fn a_file_is_taken_again_and_the_program_goes_on() {
    let board = Board::new();
    board.file("count.qrs", counting());
    let typed = "reload now\nbreak 4 if n == 2\nc\nreload\nprint n\nd\nc\nreload\nq\n";
    let told = debug(&board, &["debug", "count.qrs"], typed).good();
    for line in [
        "nothing can follow this command",
        "(trik) reload\nchanged: 10 blocks kept, 0 new, 0 gone\n0.23 s, thread main: breakpoint 1\n>   4 ",
        "(trik) print n\n2\n",
        "(trik) reload\nthe program has ended\nnothing is changed; quit and start again to begin anew",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
}

#[test]
fn an_empty_condition_is_refused_before_a_robot_is_asked() {
    let board = Board::new();
    board.file("count.qrs", counting());
    for condition in ["", " "] {
        let words = ["break", "4", "--if", condition, "--file", "count.qrs"];
        let refused = debug(&board, &words, "");
        assert_eq!(refused.code(), 2, "{}", refused.stderr);
        let why = "--if needs a condition, such as --if 'n > 3'";
        assert!(refused.stderr.contains(why), "{}", refused.stderr);
    }
}

/// Places of a program that drives which are none, and what is said of each.
fn not_there(file: &str) -> Vec<(Vec<&str>, &str)> {
    vec![
        (
            vec!["break", "5"],
            "lines, labels and captions are those of --file",
        ),
        (
            vec!["break", "drive"],
            "lines, labels and captions are those of --file",
        ),
        (
            vec!["break", "n"],
            "of --file FILE; n is a variable: trik break n --change stops when it has changed\n",
        ),
        (
            vec!["break", "n", "--file", file],
            "no such block; n is a variable: trik break n --change stops",
        ),
        (
            vec!["break", "Tmier", "--file", file],
            "no such block; did you mean 'Timer'?\n",
        ),
        (
            vec!["break", "Function", "--file", file],
            "'Function' means several blocks; give the line of one: 2 (Function: n = 0), 5 (Function: n = n + 1)\n",
        ),
        (vec!["break", "99", "--file", file], "no such line"),
        (vec!["break", "{nobody}"], "the program has no such block"),
        (
            vec!["break", "5", "--if", "n >", "--file", file],
            "the condition: 1:3 ",
        ),
    ]
}

#[test]
fn a_robot_is_stopped_stepped_and_let_go_from_the_shell() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let file = home.0.file("drive.qrs", driving());
    let file = file.to_str().expect("UTF-8").to_owned();
    let trik = |words: &[&str]| home.run(&[words, &["--robot", robot.ip()]].concat());
    let nothing = trik(&["step"]);
    assert_eq!(nothing.code(), 2, "{}", nothing.stdout);
    assert!(
        nothing.stderr.contains("no diagram runs"),
        "{}",
        nothing.stderr
    );
    let running = robot.spawn_file(&file);
    let drives = || robot.robot.duty(3).is_ok_and(|duty| duty != 0);
    eventually("a robot that drives", drives);
    let said = trik(&["break", "5", "--if", "n > 5", "--file", &file]).good();
    assert!(
        said.contains("thread main: breakpoint 1\n>   5     Function: n = n + 1"),
        "{said}"
    );
    assert_eq!(robot.robot.duty(3).expect("a motor"), 0);
    let said = trik(&["step", "--file", &file]).good();
    assert!(
        said.contains("thread main: step\n>   6     Timer: 50"),
        "{said}"
    );
    let said = trik(&["step", "back", "--file", &file]).good();
    assert!(said.contains("past, "), "{said}");
    let said = trik(&["break", "n", "--change"]).good();
    assert!(said.contains(": n was "), "{said}");
    for (words, why) in not_there(&file) {
        let refused = trik(&words);
        assert_ne!(refused.code(), 0, "{words:?}");
        assert!(
            refused.stderr.contains(why),
            "{words:?}: {}",
            refused.stderr
        );
        assert_eq!(robot.robot.duty(3).expect("a motor"), 0);
    }
    trik(&["continue"]).good();
    eventually("a robot that drives again", drives);
    let waited = trik(&[
        "break",
        "5",
        "--if",
        "n < 0",
        "--file",
        &file,
        "--seconds",
        "0.3",
    ]);
    assert_eq!(waited.code(), 1, "{}", waited.stdout);
    eventually("a robot that goes on", drives);
    drop(running);
}

#[test]
fn the_debugger_speaks_russian_where_the_diagram_does() {
    let board = Board::new();
    board.file("count.qrs", counting());
    let typed = "help\nfly\nback noon\nwatch n if n > 3\nbreak 4 if n = 3\ndelete 7\nc\nrc\npresent\ni b\nrelease x\ni t\nwhere\nreload\nd\nc\ni t\nq\n";
    let words = ["debug", "count.qrs", "--language", "ru"];
    let told = debug(&board, &words, typed).good();
    insta::assert_snapshot!(told);
}

#[test]
fn what_cannot_be_done_is_told_and_changes_nothing() {
    let board = Board::new();
    board.file("count.qrs", counting());
    let typed = "fly\nbreak 99\nbreak 4 when n\nback noon\nprint 1 +\nset n\ndelete 7\nrn\nhold nobody\nrelease nobody\n\
        errors maybe\ninfo weather\nlist x\nuntil\n\nc\n";
    let told = debug(&board, &["debug", "count.qrs"], typed).good();
    insta::assert_snapshot!(told);
}

#[test]
fn what_cannot_be_debugged_says_why() {
    let board = Board::new();
    board.file("broken.qrs", "rubbish");
    board.file("text.js", "print(1)");
    for (words, why) in [
        (&["debug", "broken.qrs"][..], "broken.qrs: "),
        (&["debug", "nowhere.qrs"], "nowhere.qrs: "),
        (&["debug", "text.js"], "only diagrams have blocks"),
        (
            &["debug", "broken.qrs", "--speed", "0"],
            "a number from 0.01",
        ),
        (
            &["check", "--debug", "broken.qrs", "broken.qrs"],
            "one diagram in one world",
        ),
    ] {
        let told = debug(&board, words, "");
        assert_eq!(told.code(), 2, "{words:?}: {}", told.stderr);
        assert!(told.stderr.contains(why), "{words:?}: {}", told.stderr);
    }
}

#[test]
fn a_failed_run_is_looked_at_where_it_failed() {
    let board = Board::new();
    debug(&board, &["new-task", "one"], "").good();
    board.file("count.qrs", counting());
    let words = ["check", "--debug", "count.qrs", "--field", "one/world.xml"];
    let told = debug(&board, &words, "rn\nprint n\nwhere\nq\n").good();
    assert!(told.contains("the task is not accomplished"), "{}", told);
    assert!(told.contains("past, "), "{}", told);
    assert!(told.contains("\n(trik) print n\n5\n"), "{}", told);
    assert!(told.contains("the robot is at x "), "{}", told);
}

/// Drives, and counts forever.
fn driving() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0")]);
    let power = [("Ports", "M3"), ("Power", "40")];
    let drive = sketch.block("TrikV6EnginesForward", &power);
    let count = sketch.block("Function", &[("Body", "n = n + 1")]);
    let wait = sketch.block("Timer", &[("Delay", "50")]);
    sketch.chain(&[start, clear, drive, count, wait, count]);
    sketch.qrs().expect("a save")
}

#[test]
fn a_robot_is_debugged_over_the_network_and_its_motors_rest_at_stops() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let file = home.0.file("drive.qrs", driving());
    let file = file.to_str().expect("UTF-8").to_owned();
    let words = ["debug", &file, "--robot", robot.ip()];
    let told = |words: &[&str], typed: &str| {
        let mut command = home.command(words);
        tools::run(&mut command, typed.as_bytes())
    };
    let typed = "break 5 if n == 3\nc\nreload\nprint n\nrn\nset n=7\npresent\nset n=10\nn\ninfo variables\nq\n";
    let said = told(&words, typed).good();
    for line in [
        "0.00 s: before the first block\n>   1 Program:",
        "thread main: breakpoint 1\n>   5     Function: n = n + 1",
        "(trik) reload\nchanged: 5 blocks kept, 0 new, 0 gone\n",
        "(trik) print n\n3\n",
        "a debugger looks at the past: come back to the present first, by `present` or by going on",
        "(trik) info variables\nn = 11\n",
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
    // It was started for the talk, and is ended with it.
    assert_eq!(robot.robot.duty(3).expect("a motor"), 0);

    let running = robot.spawn_file(&file);
    eventually("a robot that drives", || {
        robot.robot.duty(3).is_ok_and(|duty| duty != 0)
    });
    let words = [&words[..], &["--attach"]].concat();
    let said = told(&words, "print n > 0\nq\n").good();
    assert!(said.contains("(trik) print n > 0\ntrue\n"), "{said}");
    // It ran before the talk, and goes on after it.
    eventually("a robot that drives again", || {
        robot.robot.duty(3).is_ok_and(|duty| duty != 0)
    });
    // One that somebody has stopped already is joined where it is.
    told(&["break", "5", "--file", &file, "--robot", robot.ip()], "").good();
    let said = told(&words, "print n > 0\nn\nq\n").good();
    assert!(said.contains("(trik) print n > 0\ntrue\n"), "{said}");
    assert!(said.contains("thread main: step"), "{said}");
    // Another one is put in its place: the end of that is not its own.
    let said = told(&words[..4], "n\nquit\n").good();
    assert!(!said.contains("has ended"), "{said}");
    assert!(said.contains("thread main: step"), "{said}");
    assert_eq!(robot.robot.duty(3).expect("a motor"), 0);
    drop(running);
    let refused = told(&["debug", &file, "--robot", "127.0.0.9:9"], "");
    assert_eq!(refused.code(), 2, "{}", refused.stderr);
    let why = "nothing takes programs at 127.0.0.9";
    assert!(refused.stderr.contains(why), "{}", refused.stderr);
}

#[test]
fn a_person_is_asked_and_a_program_is_watched() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let file = home.0.file("ask.qrs", asking(""));
    let mut command = home.command(&["run", file.to_str().expect("UTF-8"), "--robot", robot.ip()]);
    let said = tools::run(&mut command, b"2 + 2\n");
    assert_eq!(
        (said.code(), said.stdout.as_str()),
        (0, "40\n"),
        "{}",
        said.stderr
    );
    assert!(said.stderr.contains("How many? "), "{}", said.stderr);

    // The person at a debugger is asked too.
    let mut command = home.command(&[
        "debug",
        file.to_str().expect("UTF-8"),
        "--robot",
        robot.ip(),
    ]);
    let said = tools::run(&mut command, b"c\n5\nq\n").good();
    assert!(said.contains("How many? 5\n50\n"), "{said}");

    let nothing = home.run(&["watch", "--robot", robot.ip()]);
    assert_eq!(nothing.code(), 1, "{}", nothing.stdout);
    assert!(
        nothing.stderr.contains("no diagram runs"),
        "{}",
        nothing.stderr
    );
    // Its letters are not in this file.
    let russian = home.run(&["watch", "--language", "ru", "--robot", robot.ip()]);
    assert_eq!(russian.code(), 1, "{}", russian.stdout);
    assert!(!russian.stderr.is_ascii(), "{}", russian.stderr);
    assert!(!russian.stderr.contains("diagram"), "{}", russian.stderr);
    let file = home.0.file("drive.qrs", driving());
    let file = file.to_str().expect("UTF-8").to_owned();
    let running = robot.spawn_file(&file);
    eventually("a robot that drives", || {
        robot.robot.duty(3).is_ok_and(|duty| duty != 0)
    });
    let words = ["watch", &file, "--seconds", "1", "--robot", robot.ip()];
    let watched = home.run(&words).good();
    let last = watched.lines().last().expect("a line");
    assert!(last.contains(" s  main: 6: Timer: 50; n = "), "{watched}");
    drop(running);
}
