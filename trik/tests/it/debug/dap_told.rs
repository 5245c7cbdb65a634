//! What an editor is told: of its breakpoints over a restart, of those that mean nothing, and of its launch.

use super::dap::{Editor, board};
use serde_json::{Value, json};

/// The ids that an answer tells of, with the lines.
fn ids_and_lines(answer: &Value) -> Vec<(u64, u64)> {
    let all = answer["breakpoints"].as_array().expect("all").iter();
    let all = all.map(|one| {
        assert_eq!(one["verified"], true, "{answer}");
        let number = |name: &str| one[name].as_u64().expect("a number");
        (number("id"), number("line"))
    });
    all.collect()
}

#[test]
fn a_restart_keeps_the_ids_of_breakpoints_and_tells_where_they_are_now() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch(&board, json!({"stopOnEntry": true, "stopAtEnd": true}));
    // Another one before them, so that ids are not by chance what the program counts.
    editor.good("setBreakpoints", json!({"breakpoints": [{"line": 5}]}));
    let named = json!({"breakpoints": [{"name": "twice"}]});
    let twice = editor.good("setFunctionBreakpoints", named);
    let set = json!({"breakpoints": [{"line": 4}, {"line": 6}]});
    let mut known = ids_and_lines(&editor.good("setBreakpoints", set));
    let counts = known[0].0;
    known.extend(ids_and_lines(&twice));
    known.sort_unstable();
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    let told = |editor: &mut Editor| {
        let told = (0..3).map(|_| editor.event("breakpoint"));
        let all: Vec<Value> = told.map(|mut told| told["breakpoint"].take()).collect();
        let mut all = ids_and_lines(&json!({ "breakpoints": all }));
        all.sort_unstable();
        all
    };
    // The same file: the program begins anew.
    editor.good("restart", json!({}));
    assert_eq!(told(&mut editor), known);
    assert_eq!(editor.event("stopped")["reason"], "entry");
    editor.good("continue", json!({"threadId": 1}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["hitBreakpointIds"], json!([counts]), "{stopped}");
    // Another one, in which all lines are further down by one.
    board.file("count.qrs", super::counting_after("k = 1"));
    editor.good("restart", json!({}));
    let moved: Vec<(u64, u64)> = known.iter().map(|(id, line)| (*id, line + 1)).collect();
    assert_eq!(told(&mut editor), moved);
    editor.event("stopped");
    editor.good("continue", json!({"threadId": 1}));
    let stopped = editor.event("stopped");
    let below = twice["breakpoints"][0]["line"].as_u64().expect("a line") + 1;
    assert_eq!(editor.line(&stopped), below, "in the subprogram");
    assert_eq!(
        stopped["hitBreakpointIds"][0], twice["breakpoints"][0]["id"],
        "{stopped}"
    );
    editor.end();
}

#[test]
fn a_question_that_no_editor_shows_is_told() {
    let board = board();
    board.file("ask.qrs", super::asking("1"));
    let mut editor = Editor::start();
    editor.launch_file(&board, "ask.qrs", json!({"timeLimit": 1}));
    editor.good("configurationDone", json!({}));
    editor.wait(|message| {
        let text = message["body"]["output"].as_str();
        text.is_some_and(|text| text.starts_with("n is asked for, and nobody is there to answer"))
    });
    editor.event("terminated");
    editor.end();
}

#[test]
fn a_breakpoint_by_name_takes_what_a_person_sees() {
    let board = board();
    let walls = include_str!("../../../../examples/dataflow/walls.flow");
    board.file("walls.flow", walls);
    let set = |file: &str, names: &[&str]| {
        let mut editor = Editor::start();
        editor.launch_file(&board, file, json!({"stopOnEntry": true}));
        let names: Vec<Value> = names.iter().map(|name| json!({"name": name})).collect();
        let set = editor.good("setFunctionBreakpoints", json!({"breakpoints": names}));
        editor.end();
        set["breakpoints"].clone()
    };
    let told = set("count.qrs", &["Timer", "Initial Node", "Tmier"]);
    assert_eq!(told[0]["verified"], true, "{told}");
    let why = told[1]["message"].as_str().expect("why");
    let which = "'Initial Node' means several blocks; give the line of one: 1 (";
    assert!(why.starts_with(which), "{told}");
    let near = "there is no subprogram and no block of this name; did you mean 'Timer'?";
    assert_eq!(told[2]["message"], near, "{told}");
    let names = ["Turn away", "Keep to the wall/turn", "turn", "trun"];
    let told = set("walls.flow", &names);
    for at in 0..3 {
        assert_eq!(told[at]["verified"], true, "{told}");
    }
    assert_eq!(told[1]["line"], told[2]["line"], "{told}");
    assert_ne!(told[0]["line"], told[1]["line"], "{told}");
    assert!(
        told[3]["message"]
            .as_str()
            .expect("why")
            .ends_with("mean 'turn'?")
    );
}

#[test]
fn breakpoints_that_mean_nothing_are_not_set() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch(&board, json!({"stopOnEntry": true}));
    let points = json!({"breakpoints": [
        {"line": 4, "hitCondition": "0"}, {"line": 4, "hitCondition": ">= 0"}, {"line": 4, "condition": "  "},
        {"line": 4, "logMessage": "n is {n"}, {"line": 4, "logMessage": "n is {}"},
        {"line": 4, "hitCondition": "> 0", "condition": "", "logMessage": ""},
    ]});
    let set = editor.good("setBreakpoints", points);
    for (at, why) in [
        (0, "a number of hits from 1 on"),
        (1, "a number of hits from 1 on"),
        (2, "the condition is blank"),
        (3, "the line: 1:6 This brace is not closed: write }"),
        (4, "the line: 1:6 There is nothing between these braces"),
    ] {
        let told = set["breakpoints"][at]["message"].as_str().expect("why");
        assert!(told.starts_with(why), "{set}");
        assert_eq!(set["breakpoints"][at]["verified"], false);
    }
    assert_eq!(set["breakpoints"][5]["verified"], true, "{set}");
    editor.end();
}

#[test]
fn keys_that_are_misspelt_or_hold_something_else_are_refused() {
    let board = board();
    let mut editor = Editor::start();
    editor.good("initialize", json!({"adapterID": "trik"}));
    let count = board.path("count.qrs");
    for (more, value, why) in [
        ("seed", json!(-1), "\"seed\" is -1, and a whole number"),
        ("speed", json!("x"), "\"speed\" is \"x\", and a number"),
        ("stopOnEntyr", json!(true), "did you mean 'stopOnEntry'?"),
        ("program", json!(5), "\"program\" is 5, and a text belongs"),
        ("language", json!("xx"), "\"language\" is \"xx\""),
    ] {
        let mut arguments = json!({ "program": count });
        arguments[more] = value;
        let told = editor.bad("launch", arguments);
        assert!(told.contains(why), "{told}");
    }
    let on_robot = json!({"program": count, "robot": "127.0.0.9:9", "field": "x.xml"});
    let told = editor.bad("launch", on_robot);
    assert!(
        told.contains("\"field\" is for a simulated world"),
        "{told}"
    );
    editor.launch(
        &board,
        json!({"stopOnEntry": true, "args": ["x"], "__sessionId": "1"}),
    );
    let told = editor.wait(|message| {
        let text = message["body"]["output"].as_str();
        text.is_some_and(|text| text.contains("these keys mean nothing here: \"args\"; keys are"))
    });
    assert_eq!(told["body"]["category"], "important");
    editor.end();
}
