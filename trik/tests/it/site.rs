//! `trik site`: a studio copied for a web server, with a task.

use crate::rig::TRIK;
use harness::{Board, Output, tools};
use lang_diagram::sketch::Sketch;
use std::fs;
use std::process::Command;

fn trik(board: &Board, words: &[&str]) -> Output {
    tools::run(Command::new(TRIK).args(words).current_dir(board.dir()), b"")
}

/// A folder with the files that a built studio has, as far as the command looks at them.
fn studio(board: &Board, list: &str) {
    fs::create_dir_all(board.path("studio/assets")).expect("a folder");
    let head = "<head>\n    <meta charset=\"utf-8\" />\n</head>";
    board.file("studio/index.html", head);
    board.file("studio/assets/a.js", "1");
    board.file("studio/licences.txt", "MIT");
    let worker = format!("const CACHE = 'trik-studio-12';\nconst FILES = {list};\n");
    board.file("studio/sw.js", worker);
}

const LIST: &str = r#"["./","assets/a.js","index.html"]"#;

/// A save with this world.
fn task(board: &Board, world: Option<&str>) {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.link(start, end);
    if let Some(world) = world {
        sketch.world(world);
    }
    board.file("<maze>.qrs", sketch.qrs().expect("a save"));
}

#[test]
fn a_site_has_all_files_and_its_task_where_page_and_browser_find_it() {
    let board = Board::new();
    studio(&board, LIST);
    let plain = trik(&board, &["site", "plain", "--studio", "studio"]);
    assert_eq!(plain.code(), 0, "{}", plain.stderr);
    for file in ["index.html", "assets/a.js", "licences.txt", "sw.js"] {
        assert_eq!(
            fs::read(board.path(&format!("plain/{file}"))).expect(file),
            fs::read(board.path(&format!("studio/{file}"))).expect(file),
        );
    }
    task(&board, Some("<root><world/></root>"));
    let words = [
        "site",
        "out/maze",
        "--studio",
        "studio",
        "--task",
        "<maze>.qrs",
    ];
    trik(&board, &words).good();
    let read = |file: &str| fs::read_to_string(board.path(file)).expect(file);
    let tag = "<meta charset=\"utf-8\" />\n    <meta name=\"trik-task\" content=\"task.qrs\" data-name=\"&lt;maze&gt;.qrs\" />";
    assert!(read("out/maze/index.html").contains(tag));
    let worker = read("out/maze/sw.js");
    assert!(worker.contains("[\"task.qrs\",\"./\","), "{worker}");
    assert!(
        worker.starts_with("const CACHE = 'trik-studio-12-"),
        "{worker}"
    );
    assert_eq!(
        fs::read(board.path("out/maze/task.qrs")).expect("the task"),
        fs::read(board.path("<maze>.qrs")).expect("the save")
    );
    // Another task is another version for browsers that have kept the first one.
    task(&board, Some("<root><world/><robots/></root>"));
    let again = trik(&board, &words);
    assert_eq!(again.code(), 1);
    assert!(again.stderr.contains("--force"), "{}", again.stderr);
    trik(&board, &[&words[..], &["--force"]].concat()).good();
    assert_ne!(read("out/maze/sw.js"), worker);
}

#[test]
fn what_is_no_studio_or_no_task_is_refused_and_nothing_is_written() {
    let board = Board::new();
    studio(&board, LIST);
    let refused = |words: &[&str], code: i32, why: &str| {
        let words = [&["site", "out"], words].concat();
        let told = trik(&board, &words);
        assert_eq!(told.code(), code, "{words:?}: {}", told.stdout);
        assert!(told.stderr.contains(why), "{words:?}: {}", told.stderr);
        assert!(!board.path("out").exists(), "{words:?}");
    };
    refused(&["--studio", "nowhere"], 1, "has no built studio");
    task(&board, None);
    let words = ["--studio", "studio", "--task", "<maze>.qrs"];
    refused(&words, 1, "has no world");
    board.file("text.qrs", "no save");
    refused(&["--studio", "studio", "--task", "text.qrs"], 2, "text.qrs");
    for list in [
        r#"["../../etc/passwd"]"#,
        r#"["/etc/passwd"]"#,
        "[]",
        "1",
        r#"["assets/none.js"]"#,
    ] {
        studio(&board, list);
        refused(&["--studio", "studio"], 1, "no whole studio");
    }
}
