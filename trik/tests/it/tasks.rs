//! Worlds without solutions: `trik lint` on worlds and on saves with one, and `trik new-task`.

use crate::documents::transcripts;
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use lang_diagram::sketch::Sketch;
use std::fs;
use std::process::Command;

fn trik(board: &Board, words: &[&str]) -> Output {
    tools::run(Command::new(TRIK).args(words).current_dir(board.dir()), b"")
}

/// A world as `trik new-task` makes it.
fn made(board: &Board) -> String {
    trik(board, &["new-task", "one"]).good();
    fs::read_to_string(board.path("one/world.xml")).expect("a world")
}

#[test]
fn mistakes_in_rules_are_told_with_place_and_what_was_meant() {
    let board = Board::new();
    let world = made(&board);
    let wrong = world.replacen("regionId=\"finish\"", "regionId=\"finnish\"", 1);
    board.file("wrong.xml", &wrong);
    let told = trik(&board, &["lint", "wrong.xml"]);
    assert_eq!(told.code(), 1, "{}", told.stdout);
    let line = 1 + wrong[..wrong.find("finnish").expect("the mistake")]
        .matches('\n')
        .count();
    let wanted = format!(
        "wrong.xml: error: event 'done': {line}:17: No such region: finnish; did you mean 'finish'?\n"
    );
    assert!(told.stdout.contains(&wanted), "{}", told.stdout);
    let russian = trik(&board, &["lint", "wrong.xml", "--language", "ru"]);
    let wanted = "\u{41d}\u{435}\u{442} \u{442}\u{430}\u{43a}\u{43e}\u{433}\u{43e} \u{440}\u{435}\u{433}\u{438}\u{43e}\u{43d}\u{430}: finnish; \u{43c}\u{43e}\u{436}\u{435}\u{442} \u{431}\u{44b}\u{442}\u{44c}, 'finish'?";
    assert!(russian.stdout.contains(wanted), "{}", russian.stdout);
}

#[test]
fn programs_are_told_the_same_in_lines_of_json() {
    let board = Board::new();
    let wrong = made(&board).replacen("regionId=\"finish\"", "regionId=\"finnish\"", 1);
    board.file(
        "wrong.xml",
        wrong.replacen("sizeUnit=\"cm\"", "sizeUnit=\"CM\"", 1),
    );
    let told = trik(&board, &["lint", "--json", "wrong.xml", "nowhere.xml"]);
    assert_eq!(told.code(), 2, "{}", told.stderr);
    let lines: Vec<serde_json::Value> = told
        .stdout
        .lines()
        .map(|line| serde_json::from_str(line).expect(line))
        .collect();
    let first = &lines[0];
    assert_eq!(
        (&first["file"], &first["level"]),
        (&"wrong.xml".into(), &"error".into())
    );
    assert_eq!(
        (&first["block"], &first["column"]),
        (&"event 'done'".into(), &17.into())
    );
    assert_eq!(
        first["message"],
        "No such region: finnish; did you mean 'finish'?"
    );
    assert!(
        lines
            .iter()
            .any(|one| one["level"] == "warning" && one["line"] == 3),
        "{}",
        told.stdout
    );
    let last = lines.last().expect("a line");
    assert_eq!(
        (&last["file"], &last["line"]),
        (&"nowhere.xml".into(), &serde_json::Value::Null)
    );
}

#[test]
fn a_save_is_looked_at_with_the_world_in_it() {
    let board = Board::new();
    let world = made(&board).replacen("objectId=\"robot1\"", "objectId=\"robot7\"", 1);
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, end]);
    sketch.world(&world);
    board.file("task.qrs", sketch.qrs().expect("a save"));
    let told = trik(&board, &["lint", "task.qrs"]);
    assert_eq!(told.code(), 1, "{}", told.stdout);
    let wanted = "No such object: robot7; did you mean 'robot1'?";
    assert!(
        told.stdout
            .contains("task.qrs: error: worldModel: constraint")
            && told.stdout.contains(wanted),
        "{}",
        told.stdout
    );
}

#[test]
fn what_is_no_world_is_told_and_never_a_crash() {
    let board = Board::new();
    for (name, text, code) in [
        ("empty.xml", "", 2),
        ("half.xml", "<root><world>", 1),
        ("other.xml", "<html/>", 1),
        ("bytes.xml", "<root \u{fffd}/>", 1),
    ] {
        board.file(name, text);
        let told = trik(&board, &["lint", name]);
        assert_eq!(told.code(), code, "{name}: {}", told.stdout);
        assert!(told.stdout.starts_with(name), "{}", told.stdout);
    }
    board.file("raw.xml", b"<root a='\xff'/>");
    let told = trik(&board, &["lint", "raw.xml"]);
    assert_eq!(told.code(), 2, "{}", told.stdout);
    assert!(
        told.stdout.contains("byte 9 is not UTF-8"),
        "{}",
        told.stdout
    );
    let wide: Vec<u8> = "\u{feff}<root/>"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    board.file("wide.xml", wide);
    board.file("solution.js", "brick.stop();");
    let mut fifo = tools::shell("mkfifo silent.xml");
    tools::run(fifo.current_dir(board.dir()), b"").good();
    for (name, said) in [
        (
            "wide.xml",
            "this is a text in UTF-16; save it again in UTF-8",
        ),
        ("solution.js", "this is a program, and only diagrams"),
        ("silent.xml", "nothing comes out of this FIFO"),
        ("nowhere.xml", "there is no such file"),
    ] {
        let told = trik(&board, &["lint", name]);
        assert_eq!(told.code(), 2, "{}", told.stdout);
        assert!(told.stdout.contains(said), "{}", told.stdout);
        let russian = trik(&board, &["lint", name, "--language=ru"]);
        assert!(!russian.stdout.contains("this"), "{}", russian.stdout);
    }
    // One that somebody writes into is read as any file.
    let mut piped =
        tools::shell("printf '<root><world/></root>' > silent.xml & exec \"$0\" lint silent.xml");
    let told = tools::run(piped.arg(TRIK).current_dir(board.dir()), b"");
    assert!(
        told.stdout.contains("1 file: 0 errors"),
        "{}{}",
        told.stdout,
        told.stderr
    );
    board.file("world.xml", "<root><world/></root>");
    let refused = trik(&board, &["lint", "world.xml", "--recover", "x.qrs"]);
    assert_eq!(refused.code(), 1);
    assert!(
        refused.stderr.contains("--recover is for diagrams"),
        "{}",
        refused.stderr
    );
}

/// Runs the commands that a new task prints; what each of them ends with.
fn judged(board: &Board, words: &[&str]) -> Vec<(i32, String)> {
    let output = trik(board, words);
    assert_eq!(output.code(), 0, "{}", output.stderr);
    let commands = output
        .stdout
        .lines()
        .filter_map(|line| line.strip_prefix("  trik "));
    commands
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let told = trik(board, &words);
            (told.code(), told.stdout)
        })
        .collect()
}

#[test]
fn a_new_task_is_without_mistakes_and_its_commands_work_as_printed() {
    let board = Board::new();
    for words in [
        &["new-task", "js"] as &[&str],
        &["new-task", "folder/py", "--lang", "python", "--language=ru"],
    ] {
        let told = judged(&board, words);
        let [lint, good, bad] = &told[..] else {
            panic!("{told:?}")
        };
        assert_eq!(lint.0, 0, "{}", lint.1);
        assert!(
            lint.1.contains("0") && !lint.1.contains("world.xml"),
            "{}",
            lint.1
        );
        assert_eq!(good.0, 0, "{}", good.1);
        assert!(good.1.contains("100"), "{}", good.1);
        assert_eq!(bad.0, 1, "{}", bad.1);
        let said = [
            "The robot has left the road",
            "\u{420}\u{43e}\u{431}\u{43e}\u{442} \u{43f}\u{43e}\u{43a}\u{438}\u{43d}\u{443}\u{43b} \u{434}\u{43e}\u{440}\u{43e}\u{433}\u{443}",
        ];
        assert!(said.iter().any(|text| bad.1.contains(text)), "{}", bad.1);
    }
    let readme = fs::read_to_string(board.path("js/README.md")).expect("a text");
    assert!(!readme.contains('{'), "{readme}");
    for line in readme.lines().filter(|line| line.starts_with("trik ")) {
        let words: Vec<&str> = line.split(' ').skip(1).collect();
        let mut command = Command::new(TRIK);
        let told = tools::run(command.args(&words).current_dir(board.path("js")), b"");
        assert_eq!(
            told.code(),
            i32::from(line.contains("wrong")),
            "{line}: {}",
            told.stderr
        );
    }
}

#[test]
fn a_task_that_is_there_is_replaced_only_by_force_and_names_are_plain() {
    let board = Board::new();
    trik(&board, &["new-task", "mine"]).good();
    board.file("mine/world.xml", "mine");
    let refused = trik(&board, &["new-task", "mine"]);
    assert_eq!(
        (refused.code(), &*refused.stderr),
        (
            1,
            "trik: mine/world.xml is there already: --force replaces it\n"
        )
    );
    let text = || fs::read_to_string(board.path("mine/world.xml")).expect("a world");
    assert_eq!(text(), "mine");
    trik(&board, &["new-task", "mine", "--force"]).good();
    assert!(text().starts_with("<root"));
    for name in ["a b", "x;rm", "..", "a\u{202e}b", "$(x)"] {
        let refused = trik(&board, &["new-task", name]);
        assert_eq!(refused.code(), 1, "{name}");
        assert!(
            refused.stderr.contains("is no name for a task"),
            "{}",
            refused.stderr
        );
    }
}

#[test]
fn what_the_page_of_worlds_says_is_what_really_happens() {
    let board = Board::new();
    let text = fs::read_to_string(crate::diagrams::root().join("docs/teacher/world.md"));
    let text = text.expect("docs/teacher/world.md");
    let mut count = 0;
    for (index, example) in harness::documents::examples(&text).iter().enumerate() {
        if example.info != "xml world" {
            continue;
        }
        let name = format!("example{index}.xml");
        board.file(&name, &example.text);
        let told = trik(&board, &["lint", &name]);
        let place = format!("docs/teacher/world.md:{}", example.line);
        assert!(
            told.code() == 0
                && told
                    .stdout
                    .starts_with("1 file: 0 errors, 0 warnings, 0 notes"),
            "{place}\n{}",
            told.stdout
        );
        count += 1;
    }
    assert!(count >= 5, "only {count} examples");
    let (steps, wrong) = transcripts(&board, "docs/teacher/world.md", &text, "sh task");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(steps >= 2, "only {steps}");
}

#[test]
fn a_page_has_what_robot_and_program_did_and_making_it_changes_no_verdict() {
    let board = Board::new();
    let world = made(&board).replacen("realisticSensors=\"false\"", "realisticSensors=\"true\"", 1);
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let body = "x = 1; name = 'a'; far = sensorD1; list = {1, 2, 3}";
    let set = sketch.block("Function", &[("Body", body)]);
    let ahead = [("Ports", "M3, M4"), ("Power", "60")];
    let ahead = sketch.block("TrikV6EnginesForward", &ahead);
    let wait = sketch.block("Timer", &[("Delay", "1000")]);
    let again = sketch.block("Function", &[("Body", "far = sensorD1; x = x + 1")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, set, ahead, wait, again, end]);
    sketch.world(&world);
    board.file("task.qrs", sketch.qrs().expect("a save"));
    let plain = trik(&board, &["check", "task.qrs", "--trajectory", "one.json"]);
    let words = [
        "check",
        "task.qrs",
        "--html",
        "run.html",
        "--trajectory",
        "two.json",
    ];
    let shown = trik(&board, &words);
    assert_eq!((plain.code(), &plain.stdout), (shown.code(), &shown.stdout));
    let read = |name: &str| fs::read_to_string(board.path(name)).expect(name);
    assert!(
        read("one.json") == read("two.json"),
        "the way is another one"
    );
    let page = read("run.html");
    for part in [
        "[\"Blocks and lines\",[\"main\",",
        "\"Timer\"",
        "[\"Motors\",[\"M3\",",
        "[\"x\",",
        "[\"list\",",
        "\"[1, 2, 3]\"",
        "[\"D1\",",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
    assert!(
        !page.contains("[\"sensorD1\","),
        "a reading has its own place"
    );
    // Nothing comes from outside, and nothing could.
    assert!(page.contains("default-src 'none'") && page.matches("://").count() == 1);
    let words = ["check", "task.qrs", "--html", "ru.html", "--language", "ru"];
    trik(&board, &words);
    assert!(read("ru.html").contains("[\"\u{41c}\u{43e}\u{442}\u{43e}\u{440}\u{44b}\",[\"M3\","));
}

#[test]
fn a_new_task_in_russian_has_no_english_comment_and_follows_no_link() {
    let board = Board::new();
    trik(&board, &["new-task", "one", "--language", "ru"]).good();
    for file in ["world.xml", "solution.js", "wrong.js"] {
        let text = fs::read_to_string(board.path("one").join(file)).expect("a file");
        let comments = text
            .lines()
            .filter(|line| line.contains("<!--") || line.starts_with("//"));
        for line in comments {
            let is_russian = line.chars().any(|c| ('\u{410}'..='\u{44f}').contains(&c));
            assert!(is_russian, "{file}: {line}");
        }
        let marks = text.replace("${total_score}", "");
        assert!(file != "world.xml" || !marks.contains('{'), "{text}");
    }
    fs::remove_file(board.path("one/world.xml")).expect("a file");
    board.file("precious", "kept");
    std::os::unix::fs::symlink(board.path("precious"), board.path("one/world.xml"))
        .expect("a link");
    let told = trik(&board, &["new-task", "one", "--force"]);
    assert_eq!(told.code(), 1, "{}", told.stdout);
    assert!(
        told.stderr.contains("one/world.xml is a link"),
        "{}",
        told.stderr
    );
    assert_eq!(fs::read(board.path("precious")).expect("a file"), b"kept");
}
