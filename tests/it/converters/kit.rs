//! `trikfs new-converter`: what it writes builds, passes its own tests, mounts, and does so with the printed commands.

use harness::{Board, Output};
use std::process::Command;

/// The program with arguments in the folder of the board.
fn trikfs(board: &Board, arguments: &[&str]) -> Output {
    crate::trikfs(board, arguments, b"")
}

/// A shell in the folder of the board that finds the program under test as `trikfs`, and builds offline.
fn shell(board: &Board, script: &str) -> Output {
    let bin = board.path("bin");
    if !bin.exists() {
        std::fs::create_dir(&bin).unwrap();
        std::os::unix::fs::symlink(crate::program(), bin.join("trikfs")).unwrap();
    }
    let mut command = Command::new("sh");
    command.args(["-c", &format!("exec 2>&1\nset -e\n{script}")]);
    let path = std::env::var("PATH").unwrap_or_default();
    command
        .env("PATH", format!("{}:{path}", bin.display()))
        .env("CARGO_NET_OFFLINE", "true")
        .env_remove("CARGO_TARGET_DIR")
        .env_remove("SEED")
        .current_dir(board.dir());
    harness::tools::run_within(&mut command, b"", harness::wait::LIFE)
}

/// Makes a project and runs what it prints, line after line. Returns the last lines of output.
fn follow(board: &Board, language: &str, name: &str) -> Option<String> {
    if let Some(why) = harness::mount::obstacle() {
        harness::skip(why);
        return None;
    }
    let made = trikfs(board, &["new-converter", "--lang", language, name]).good();
    let (_, next) = made.split_once("next, ").expect("what to do next");
    let commands: Vec<&str> = next
        .lines()
        .filter_map(|line| line.strip_prefix("  "))
        .collect();
    assert!(commands.len() > 5, "{made}");
    let output = shell(board, &commands.join("\n"));
    assert_eq!(output.code(), 0, "{}", output.stdout);
    assert!(output.stdout.ends_with("\n6673\n"), "{}", output.stdout);
    Some(output.stdout)
}

/// Changes one text of a project.
fn change(board: &Board, file: &str, from: &str, to: &str) {
    let text = String::from_utf8(board.content(file)).unwrap();
    assert!(text.contains(from), "{file}: {from}");
    board.file(file, text.replace(from, to));
}

/// True if the program under test can load what the tools of this machine build.
fn builds_for_it() -> bool {
    let is_ours = std::env::var_os(crate::UNDER_TEST).is_none();
    if !is_ours {
        harness::wait::note_skip(
            "make and cargo build for this machine, the program may be for another",
        );
    }
    is_ours
}

#[test]
fn a_project_in_lua_works_as_printed_and_its_tests_see_mistakes() {
    let board = Board::new();
    let Some(said) = follow(&board, "lua", "calm_voltage") else {
        return;
    };
    assert!(said.contains("vectors.txt: 7 vectors hold"), "{said}");
    assert!(
        said.contains("node calm_voltage: 2000 random tuples, seed "),
        "{said}"
    );
    change(
        &board,
        "calm_voltage/robot.lua",
        "13256, 1023",
        "13256, 1024",
    );
    let wrong = shell(&board, "cd calm_voltage; sh test.sh");
    assert_eq!(wrong.code(), 1);
    let line = "trikfs: vectors.txt: line 9: 0202 gives f1190000, not f7190000\n";
    assert!(wrong.stdout.contains(line), "{}", wrong.stdout);
}

#[test]
fn a_project_in_c_works_as_printed_and_its_tests_see_mistakes() {
    let board = Board::new();
    if !builds_for_it() {
        return;
    }
    let Some(said) = follow(&board, "c", "result") else {
        return;
    };
    assert!(
        said.contains("7 vectors hold\n100000 random tuples"),
        "{said}"
    );
    assert!(!said.contains("warning"), "{said}");
    let tests = |from: &str, to: &str| {
        change(&board, "result/result.c", from, to);
        let output = shell(&board, "cd result; make -s test SEED=3");
        change(&board, "result/result.c", to, from);
        output
    };
    for (from, to, complaint) in [
        // A result of another value, a state that all share, a write beside the output, a voltage that cannot be.
        (
            "+ 511u * mean->count)",
            "+ 5111u * mean->count)",
            "FAILED: line 9: gives something else (seed 3)",
        ),
        (
            "mean->taken += 1;",
            "{ static long calls; mean->taken += 1; if (++calls > 150000) mean->sum ^= 1; }",
            "another output after opening again (seed 3)",
        ),
        (
            "  out[3] =",
            "  out[4] = 1;\n  out[3] =",
            "wrote outside its output",
        ),
        (
            "raw & 1023u;",
            "(raw > 0xf000u ? 2000u : raw & 1023u);",
            "more than the greatest voltage",
        ),
    ] {
        let output = tests(from, to);
        assert_eq!(output.code(), 2, "{to}\n{}", output.stdout);
        assert!(output.stdout.contains(complaint), "{to}\n{}", output.stdout);
    }
    assert_eq!(shell(&board, "cd result; make -s test SEED=3").code(), 0);
}

#[test]
fn a_project_in_rust_works_as_printed_without_the_sources_of_trikfs() {
    let board = Board::new();
    if !builds_for_it() {
        return;
    }
    let Some(said) = follow(&board, "rust", "result") else {
        return;
    };
    assert!(said.contains("test result: ok. 3 passed"), "{said}");
    assert!(
        said.contains("node result: 20000 random tuples, seed "),
        "{said}"
    );
    assert!(!said.contains("warning"), "{said}");
    change(&board, "result/src/lib.rs", "self.taken = 0;", "");
    let wrong = shell(&board, "cd result; SEED=3 cargo test");
    assert_eq!(wrong.code(), 101, "{}", wrong.stdout);
    assert!(
        wrong
            .stdout
            .contains("line 11: 0004 gives 00000000, not consumed"),
        "{}",
        wrong.stdout
    );
}

#[test]
fn a_project_may_lie_anywhere_and_is_never_written_over() {
    let board = Board::new();
    let new = |arguments: &[&str]| {
        let mut words = vec!["new-converter", "--lang", "lua"];
        words.extend(arguments);
        trikfs(&board, &words)
    };
    let made = new(&["sonar", "--dir", "it's here"]).good();
    assert!(made.contains("\n  cd 'it'\\''s here'\n"), "{made}");
    assert!(board.path("it's here/robot.lua").is_file());
    board.file("sonar", "mine");
    for (arguments, words) in [
        (&["sonar"][..], "sonar is there already; take another name"),
        (&["other", "--dir", "it's here"], "is there already"),
        (
            &["other", "--dir", "no/such"],
            "make it first with mkdir -p",
        ),
        (&["../other"], "the name '../other' does not do"),
        (&["Sonar"], "; try sonar"),
        (&["end"], "it is a word of Lua; try end_sensor"),
    ] {
        let refused = new(arguments);
        assert_eq!(refused.code(), 1, "{arguments:?}");
        assert!(refused.stderr.contains(words), "{}", refused.stderr);
    }
    assert_eq!(board.content("sonar"), b"mine");
    assert!(!board.path("other").exists());
    assert_eq!(trikfs(&board, &["new-converter", "x"]).code(), 2);
}
