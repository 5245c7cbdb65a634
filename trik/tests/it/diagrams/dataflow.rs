//! Programs of data flow on this computer: `trik lint`, `show` and `check`, and the programs that the document has.

use super::{root, trik};
use harness::Board;
use lang_dataflow::{save, text};
use lang_diagram::read::{Save, read};
use std::fs;

/// The programs in the fences of the document, with the names of their diagrams.
fn documented() -> Vec<String> {
    let page = fs::read_to_string(root().join("docs/user/dataflow.md")).expect("the document");
    let fences = page.split("```text\n").skip(1);
    let programs = fences.filter_map(|rest| rest.split("```").next());
    programs
        .map(str::to_owned)
        .filter(|text| text.starts_with("diagram"))
        .collect()
}

/// The one with two behaviours.
fn wall_follower() -> String {
    documented().swap_remove(3)
}

#[test]
fn programs_of_the_document_have_nothing_wrong_and_do_what_it_says() {
    let programs = documented();
    assert_eq!(programs.len(), 5);
    let board = Board::new();
    for (at, program) in programs.iter().enumerate() {
        let name = format!("p{at}.flow");
        board.file(&name, program);
        let found = trik(&board, &["lint", &name]);
        assert_eq!(
            (found.code(), &*found.stdout),
            (0, "1 file: 0 errors, 0 warnings, 0 notes\n")
        );
    }
    let first = trik(&board, &["check", "p0.flow"]);
    assert_eq!(
        (first.code(), &*first.stdout),
        (0, "p0.flow: ended (no rules), 0.00 s\n")
    );
    let second = trik(&board, &["check", "p1.flow"]);
    assert_eq!(
        (second.code(), &*second.stdout),
        (0, "p1.flow: ended (no rules), 1.50 s\n")
    );
    // An empty world has no sensors.
    let third = trik(&board, &["check", "p2.flow"]);
    assert_eq!(third.code(), 1);
    let told = "Sensor 'wall': the robot has no such device";
    assert!(third.stdout.contains(told), "{}", third.stdout);
}

#[test]
fn saves_and_texts_are_shown_and_become_each_other() {
    let board = Board::new();
    let program = wall_follower();
    board.file("wall.flow", &program);
    let project = text::read(&program).expect("a program");
    board.file("wall.qrs", save::save(&project).write().expect("a save"));
    let sentences = trik(&board, &["show", "wall.flow"]);
    assert_eq!(sentences.code(), 0, "{}", sentences.stderr);
    assert!(
        sentences.stdout.contains("C.TRUE -> E.I0"),
        "{}",
        sentences.stdout
    );
    assert_eq!(trik(&board, &["show", "wall.qrs"]).stdout, sentences.stdout);
    let all = trik(&board, &["show", "wall.flow", "--all"]);
    assert_eq!(all.code(), 0, "{}", all.stderr);
    for (said, is_said) in [(&all, true), (&sentences, false)] {
        let default = "M - Motors: synchronized = no, M1 = 0";
        assert_eq!(said.stdout.contains(default), is_said, "{}", said.stdout);
    }
    let russian = trik(&board, &["show", "wall.flow", "--language", "ru"]);
    let is_russian = |letter: char| ('\u{410}'..='\u{44f}').contains(&letter);
    assert!(russian.stdout.contains(is_russian), "{}", russian.stdout);
    let source = trik(&board, &["show", "wall.qrs", "--source"]);
    board.file("again.flow", &source.stdout);
    let again = trik(&board, &["show", "again.flow", "--source"]);
    assert_eq!(again.stdout, source.stdout);
    let saved = trik(&board, &["show", "again.flow", "--save", "again.qrs"]);
    assert_eq!(saved.code(), 0, "{}", saved.stderr);
    let back = trik(&board, &["show", "again.qrs", "--source"]);
    assert_eq!(back.stdout, source.stdout);
    for (file, why) in [
        ("again.flow", "again.qrs is there already"),
        ("wall.qrs", "this is a save"),
    ] {
        let refused = trik(&board, &["show", file, "--save", "again.qrs"]);
        assert_eq!(refused.code(), 1, "{}", refused.stderr);
        assert!(refused.stderr.contains(why), "{}", refused.stderr);
    }
    let picture = trik(&board, &["show", "wall.qrs", "--svg", "wall.svg"]);
    assert_eq!(picture.code(), 0, "{}", picture.stderr);
    let svg = fs::read_to_string(board.path("wall.svg")).expect("a picture");
    assert!(svg.starts_with("<svg") && svg.contains("REPLACE_DATA"));
    let found = trik(&board, &["lint", "wall.qrs"]);
    assert_eq!(found.code(), 0, "{}", found.stdout);
    let debugged = trik(&board, &["check", "--debug", "wall.qrs"]);
    assert_eq!(debugged.code(), 0, "{}", debugged.stderr);
    assert!(
        debugged.stdout.contains("the program has failed"),
        "an empty world has no sensor: {}",
        debugged.stdout
    );
    board.file("control.qrs", super::square());
    for option in ["--source", "--all"] {
        let control = trik(&board, &["show", "control.qrs", option]);
        assert_eq!(control.code(), 1);
        let why = format!("{option} is for data-flow programs");
        assert!(control.stderr.contains(&why), "{}", control.stderr);
    }
}

#[test]
fn rubbish_is_refused_with_its_place() {
    let board = Board::new();
    board.file("bytes.flow", [0xff, 0xfe, 0x00]);
    board.file("empty.flow", "");
    board.file("words.flow", "diagram \"A\"\n  x Sensor\n");
    board.file(
        "near.flow",
        "diagram \"A\"\n  x: Sensr\n  y: Sensor(VarNam = sensorA1)\n",
    );
    for (name, words) in [
        ("bytes.flow", "UTF-8"),
        ("empty.flow", "no data-flow diagram"),
        ("words.flow", "2:"),
        ("near.flow", "did you mean 'Sensor'"),
    ] {
        for command in ["lint", "check"] {
            let output = trik(&board, &[command, name]);
            assert!(output.code() != 0, "{command} {name}");
            let all = format!("{}{}", output.stdout, output.stderr);
            assert!(all.contains(words), "{command} {name}: {all}");
        }
    }
}

#[test]
fn an_editor_can_go_to_what_is_wrong_in_a_text() {
    let board = Board::new();
    let text = "diagram \"A\"\n  x: Sensor(VarName = sensorA9)\n  F: \"Text programming\"(\n    IO0 = `1;\n      2 +`)\n\nsubprogram \"B\"\n  s: Say\n";
    board.file("wrong.flow", text);
    board.file("torn.flow", "diagram \"A\"\n  x Sensor\n");
    let told = trik(&board, &["lint", "wrong.flow", "torn.flow"]).stdout;
    for start in [
        "wrong.flow:2:23: error: A: Sensor 'x': 'Sensor': there is no sensor 'sensorA9'",
        "torn.flow:2:3: error: ",
    ] {
        assert!(told.lines().any(|line| line.starts_with(start)), "{told}");
    }
    board.file("wrong.flow", text.replace("sensorA9", "sensorA1"));
    let told = trik(&board, &["lint", "wrong.flow"]).stdout;
    for start in [
        "wrong.flow:5:9: error: A: Text programming 'F': 'IO0' 2:9: ",
        "wrong.flow:7:1: warning: B: nothing that runs calls it",
    ] {
        assert!(told.lines().any(|line| line.starts_with(start)), "{told}");
    }
    // So does what keeps it from running.
    for (command, name, start) in [
        (
            "check",
            "wrong.flow",
            "error: wrong.flow:5:9: A: Text programming 'F': 'IO0', 2:9 ",
        ),
        (
            "debug",
            "wrong.flow",
            "trik: wrong.flow:5:9: A: Text programming 'F': 'IO0', 2:9 ",
        ),
        (
            "check",
            "torn.flow",
            "error: torn.flow:2:3: a line begins with a label",
        ),
        (
            "debug",
            "torn.flow",
            "trik: torn.flow:2:3: a line begins with a label",
        ),
    ] {
        let output = trik(&board, &[command, name]);
        assert!(output.code() != 0, "{command} {name}");
        let all = format!("{}{}", output.stdout, output.stderr);
        let is_told = all.lines().any(|line| line.starts_with(start));
        assert!(is_told, "{command} {name}: {all}");
    }
    let told = trik(&board, &["lint", "--json", "wrong.flow"]).stdout;
    assert!(told.contains("\"fileColumn\":1,\"fileLine\":7,"), "{told}");
    // What is shown of one diagram is what it calls.
    let one = trik(&board, &["show", "wrong.flow", "--diagram", "B"]).stdout;
    assert_eq!(one, "Subprogram \"B\" (not called):\n  s - Say\n");
}

#[test]
fn lost_blocks_of_a_save_are_put_back_and_its_world_is_replaced() {
    let board = Board::new();
    let program = wall_follower();
    board.file("wall.flow", &program);
    let whole = save::save(&text::read(&program).expect("a program"));
    let mut objects = whole.objects().clone();
    for object in objects.iter_mut() {
        object
            .children
            .retain(|id| !id.contains("/DFSupressorBlock/"));
    }
    let lost = Save::made(objects, whole.meta().clone());
    board.file("lost.qrs", lost.write().expect("a save"));
    let output = trik(&board, &["lint", "lost.qrs", "--recover", "found.qrs"]);
    let start = "found.qrs: written, with ";
    assert!(output.stdout.starts_with(start), "{}", output.stdout);
    assert_eq!(output.code(), 0, "{}", output.stdout);
    let text = trik(&board, &["lint", "wall.flow", "--recover", "x.qrs"]);
    let why = "this is a text, and --recover is for diagrams";
    assert!(text.stderr.contains(why), "{}", text.stderr);
    // The robot has its sensors in the world that is put in.
    fs::copy(
        root().join("examples/dataflow/walls.xml"),
        board.path("walls.xml"),
    )
    .expect("a world");
    let patched = trik(&board, &["patcher", "found.qrs", "-f", "walls.xml"]);
    assert_eq!(patched.code(), 0, "{}", patched.stderr);
    let saved = fs::read(board.path("found.qrs")).expect("a save");
    let world = read(&saved).expect("a save").project.world;
    assert!(world.is_some_and(|world| world.contains("<root")));
    let none = trik(&board, &["patcher", "wall.flow", "-f", "walls.xml"]);
    assert_eq!(none.code(), 1);
}

#[test]
fn what_is_strange_in_a_run_is_told_and_ends_nothing() {
    let board = Board::new();
    let source = "diagram \"Late\"\n  L: Loop(end_border = 5, time = 10)\n  W: \"Wait and send\"(time = 100)\n  S: Say\n  L.OUT -> W.DATA\n  W.OUT -> S.CF_IN\n";
    board.file("late.flow", source);
    let run = trik(&board, &["check", "late.flow"]);
    assert_eq!(run.code(), 0, "{}", run.stdout);
    let warnings = run
        .stdout
        .matches("warning: Late: Wait and send 'W'")
        .count();
    // Each port tells the first time.
    assert_eq!(warnings, 1, "{}", run.stdout);
}

#[test]
fn programs_become_converters_in_lua_and_c_and_in_nothing_else() {
    let board = Board::new();
    let program = wall_follower();
    board.file("wall.flow", &program);
    let project = text::read(&program).expect("a program");
    board.file("wall.qrs", save::save(&project).write().expect("a save"));
    for (lang, has) in [("lua", "name = 'sensorD1'"), ("c", "trikfs_library_entry")] {
        let said = trik(&board, &["gen", "wall.flow", "--lang", lang]);
        assert_eq!(said.code(), 0, "{}", said.stderr);
        assert!(said.stdout.contains(has), "{}", said.stdout);
        // The save has the same program; only its name may differ.
        let saved = trik(&board, &["gen", "wall.qrs", "--lang", lang]);
        assert_eq!(saved.stdout, said.stdout);
    }
    let file = ["gen", "wall.flow", "--lang", "lua", "-o", "wall.lua"];
    assert_eq!(trik(&board, &file).code(), 0);
    // What is there is not overwritten.
    assert_ne!(trik(&board, &file).code(), 0);
    let python = trik(&board, &["gen", "wall.flow", "--lang", "python"]);
    let told = "becomes a converter of trikfs, in lua or c";
    assert_eq!(python.code(), 2);
    assert!(python.stderr.contains(told), "{}", python.stderr);
    let goto = trik(&board, &["gen", "wall.flow", "--lang", "c", "--goto"]);
    assert_eq!(goto.code(), 2);
    board.file("say.flow", "diagram \"Says\"\n  hello: Say(text = hello)\n");
    let says = trik(&board, &["gen", "say.flow", "--lang", "lua"]);
    assert_eq!(says.code(), 1);
    let told = "say.flow:2:3: error: Says: Say 'hello': 'Say' does something beside computing";
    assert!(says.stderr.contains(told), "{}", says.stderr);
    assert!(says.stderr.contains("trik: no program was written"));
}
