//! Programs that lie, never end or leave something behind; what is told of mistakes; recorded runs.

use super::{folder, trik, world};
use crate::rig::TRIK;
use harness::{Board, tools};
use std::fs;
use std::process::Command;

const FORGER: &str = r#"
import os
line = ('{"solution":"class/%s.py","field":"far.xml","verdict":"accomplished","ms":10,"total_score":100,'
        '"last_number":null,"messages":[],"more":0}\n')
try:
    out = open("/proc/%d/fd/1" % os.getppid(), "wb", buffering=0)
    for text in (line % "1", line % "2", "\n \n"):
        out.write(text.encode())
    out.write(b"\xff\xfe\n{half")
except PermissionError:
    pass
"#;

#[test]
fn a_program_cannot_tell_its_own_verdict_or_that_of_others() {
    let board = Board::new();
    board.file("far.xml", world(300));
    fs::create_dir(board.path("class")).expect("a folder");
    board.file("class/1.py", FORGER);
    board.file("class/2.py", "x = 1\n");
    board.file("class/3.py", "x = 1\n");
    let words = [
        "check",
        "class",
        "--field",
        "far.xml",
        "--jobs",
        "1",
        "--results",
        "-",
    ];
    let output = trik(&board, &words);
    let lines: Vec<&str> = output.stdout.lines().collect();
    assert_eq!(lines.len(), 3, "{}{}", output.stdout, output.stderr);
    for (line, number) in lines.iter().zip(1..) {
        let start = format!("{{\"solution\":\"class/{number}.py\"");
        assert!(line.starts_with(&start), "{line}");
        assert!(line.contains("\"verdict\":\"failed\""), "{line}");
    }
}

#[test]
fn a_program_that_takes_too_much_real_time_is_not_failed_but_broken() {
    let board = Board::new();
    board.file("far.xml", world(300));
    board.file("slow.py", "sum(range(10 ** 12))");
    let words = [
        "check",
        "slow.py",
        "--field",
        "far.xml",
        "--wall-limit",
        "1",
        "--results",
        "-",
    ];
    let output = trik(&board, &words);
    assert_eq!(output.code(), 2, "{}{}", output.stdout, output.stderr);
    assert!(
        output.stdout.contains("\"verdict\":\"broken\""),
        "{}",
        output.stdout
    );
    assert!(output.stdout.contains("does not wait"), "{}", output.stdout);
}

#[test]
fn a_single_call_that_never_returns_is_ended_and_reported() {
    let board = Board::new();
    board.file("far.xml", world(300));
    board.file(
        "search.js",
        "var s = 'a'.repeat(20000000); while (true) s.indexOf('b' + s);",
    );
    let words = "check search.js --field far.xml --wall-limit 1 --report r.json";
    let output = trik(&board, &words.split(' ').collect::<Vec<_>>());
    assert_eq!(output.code(), 2, "{}{}", output.stdout, output.stderr);
    let why = "The run took more than 1 s of real time";
    assert!(output.stdout.contains(why), "{}", output.stdout);
    let report = fs::read_to_string(board.path("r.json")).expect("a report");
    assert!(report.contains(why), "{report}");
}

/// The engine looks up in the middle of a search, so that takes time of the model and ends at the task's limit.
#[test]
fn a_search_that_takes_for_ever_ends_with_the_time_of_the_task() {
    let board = Board::new();
    board.file("far.xml", world(300));
    board.file("call.js", "/(a+)+$/.test('a'.repeat(60) + 'b');");
    let words = ["check", "call.js", "--field", "far.xml"];
    let output = trik(&board, &words);
    assert_eq!(output.code(), 1, "{}{}", output.stdout, output.stderr);
    assert!(output.stdout.contains("too long time"), "{}", output.stdout);
}

#[test]
fn a_python_program_is_confined() {
    let board = Board::new();
    board.file("far.xml", world(300));
    let program = "import os, resource
print(os.readlink('/proc/self/ns/net'))
for what in (resource.RLIMIT_NPROC, resource.RLIMIT_FSIZE, resource.RLIMIT_CPU, resource.RLIMIT_AS):
    print(resource.getrlimit(what)[1] != resource.RLIM_INFINITY)
print(open('/proc/self/status').read().split('NoNewPrivs:')[1].split()[0])
";
    board.file("a.py", program);
    let output = trik(&board, &["check", "a.py", "--field", "far.xml"]);
    let printed = output
        .stdout
        .lines()
        .filter_map(|line| line.strip_prefix("print: "));
    let printed: Vec<&str> = printed.collect();
    assert_eq!(
        printed[1..],
        ["True", "True", "True", "True", "1"],
        "{}",
        output.stdout
    );
    let flag = if nix::unistd::Uid::effective().is_root() {
        "-n"
    } else {
        "-Un"
    };
    let can_leave = Command::new("unshare").args([flag, "true"]).status();
    let own = fs::read_link("/proc/self/ns/net").expect("a namespace");
    if can_leave.is_ok_and(|status| status.success()) {
        assert_ne!(printed[0], own.to_string_lossy());
    } else {
        needs::Need::Extra.missing("no unshare, so the network is not looked at");
    }
}

#[test]
fn what_was_left_out_or_mixed_up_is_told() {
    let board = folder();
    board.file("class/left.py", "print(1)");
    board.file("stop.js", "script.wait(50);");
    let cases: [(&[&str], &str); 5] = [
        (
            &["check", "class"],
            "programs *.js and *.py are left out, 1 here",
        ),
        (
            &["check", "fields/near.xml"],
            "this is a world and no solution: run one in it with --field",
        ),
        (
            &["check", "short.qrs", "--script", "stop.js"],
            "\nstop.js: not accomplished",
        ),
        (
            &["up", "--field", "nope.xml"],
            "nope.xml: there is no such file\n",
        ),
        (
            &["2d-model", "line.qrs", "--speed", "NaN"],
            "not a whole number from 0 on",
        ),
    ];
    for (words, said) in cases {
        let output = trik(&board, words);
        let all = format!("{}{}", output.stdout, output.stderr);
        assert!(all.contains(said), "{words:?}: {all}");
    }
    let copy = board.path("copied");
    fs::copy(TRIK, &copy).expect("a copy");
    let output = tools::run(Command::new(&copy).arg("up").current_dir(board.dir()), b"");
    assert!(output.stderr.contains("config/lua"), "{}", output.stderr);
}

#[test]
fn records_are_judged_without_a_save_and_strangers_in_them_are_told() {
    let board = folder();
    let made = trik(&board, &["check", "line.qrs", "--trajectory", "t.json"]);
    assert_eq!(made.code(), 0, "{}{}", made.stdout, made.stderr);
    let fields = ["check", "--log", "t.json", "--field", "fields"];
    let alone = trik(&board, &fields);
    assert_eq!(alone.code(), 1, "{}{}", alone.stdout, alone.stderr);
    assert!(
        alone
            .stdout
            .contains("t.json    fields/near.xml  accomplished"),
        "{}",
        alone.stdout
    );
    let stranger = fs::read_to_string(board.path("t.json"))
        .expect("a record")
        .replacen("trikKitRobot", "stranger", 1);
    fs::create_dir(board.path("strange")).expect("a folder");
    board.file("strange/t.json", stranger);
    let told = trik(
        &board,
        &["check", "--log", "strange", "--field", "fields/near.xml"],
    );
    let why = "strange/t.json: the record has a robot 'stranger' that is not in this world";
    assert!(told.stdout.contains(why), "{}{}", told.stdout, told.stderr);
    for wrong in [&["--log", "t.json"][..], &["class", "--log", "t.json"]] {
        let refused = trik(&board, &[&["check"], wrong].concat());
        assert_eq!(refused.code(), 2, "{wrong:?}");
        assert!(refused.stderr.contains("rules"), "{}", refused.stderr);
    }
}
