//! `trik debug` and `trik dap` with data-flow programs, in a simulated world.

use super::dap::Editor;
use super::debug;
use harness::Board;
use serde_json::json;

/// Counts to 40, by ones, ten times in a second, and then stops.
const COUNTER: &str = "
diagram \"Counter\"
  numbers: Loop(start_border = 1, end_border = 40, increment = 1, time = 100)
  sum: \"Text programming\"(IO0 = `sum = gain * I0; sum`)
  gain: Variable(variable = \"gain = 2\")
  wheels: Motors
  numbers.OUT -> sum.I0
  sum.O0 -> wheels.M3
";

pub(super) fn board() -> Board {
    let board = Board::new();
    board.file("count.flow", COUNTER);
    board
}

#[test]
fn a_data_flow_program_is_stopped_stepped_changed_and_ends() {
    let board = board();
    let typed = "list\nbreak wheels if data > 6\nc\np sum\ns\nset gain=3\nc\nrn\nreload\ninfo variables\nd\nc\n\
        where\nq\n";
    let told = debug(&board, &["debug", "count.flow"], typed).good();
    insta::assert_snapshot!(told);
}

#[test]
fn a_change_of_a_variable_stops_it_and_lines_of_breakpoints_do_not() {
    let board = board();
    let typed = "watch sum if sum > 6\ndprintf wheels {sum} goes to the wheels, {data} by {gain}\nwatch smu\n\
        watch sum if data > 3\ndprintf wheels {sum + x}\nc\nc\ninfo breakpoints\nd\nbreak wheels if gain = 3\nq\n";
    let told = debug(&board, &["debug", "count.flow"], typed).good();
    for part in [
        "breakpoint 1 watches sum\n",
        "(trik) watch smu\nthis cannot be watched: the program has no variable 'smu'; did you mean 'sum'?\n",
        "(trik) watch sum if data > 3\nthe condition: 1:1 the program has no variable 'data'\n",
        "the line: 1:8 the program has no variable 'x'\n",
        "6 goes to the wheels, 6 by 2\n",
        "breakpoint 1: sum was 6 and is 8, by line 4\n>   7   wheels - Motors\n      wheels.M3 gets 8\n",
        "8 goes to the wheels, 8 by 2\n",
        "breakpoint 1: sum was 8 and is 10, by line 4\n",
        "the condition: 1:1 an expression that is only looked at cannot assign; == compares\n",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
}

#[test]
fn the_past_of_a_data_flow_program_is_looked_at_and_stays_when_it_has_ended() {
    let board = board();
    let typed = "watch sum if sum == 20\nc\nrn\nrs\np sum\nback 450\np sum\nset gain=5\nn\nstart\npresent\n\
        delete\nbreak wheels if data == 50\nc\ndelete\nc\nrn\np sum\npresent\nq\n";
    let told = debug(&board, &["debug", "count.flow"], typed).good();
    for part in [
        "breakpoint 1: sum was 18 and is 20, by line 4\n",
        "(trik) rn\npast, 1.00 s: step\n>   4   sum - Text programming: IO0 = sum = gain * I0; sum\n      sum.I0 gets 10\n",
        "(trik) rs\npast, 0.90 s: step\n>   7   wheels - Motors\n      wheels.M3 gets 18\n(trik) p sum\n18\n",
        "(trik) p sum\n8\n(trik) set gain=5\na debugger looks at the past: come back to the present first, by `present` or by going on\n",
        "(trik) n\npast, 0.50 s: step\n>   4   sum",
        "(trik) start\npast, 0.00 s: before the first block\n",
        "(trik) c\n2.50 s: breakpoint 2\n",
        "the program has ended at 4.00 s of model time\n",
        "(trik) rn\npast, 4.00 s: step\n",
        "(trik) p sum\n80\n",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
}

#[test]
fn what_means_no_block_is_told_with_all_that_may_be_given_and_the_nearest_label() {
    let board = board();
    let typed = "break whels\nbreak 99\nuntil gian\nlist weels\nlist wheels\nq\n";
    let told = debug(&board, &["debug", "count.flow"], typed).good();
    let may = "is neither a line that has a block, nor the label of a block, its SUBPROGRAM/LABEL or its id, nor a \
        subprogram; list shows lines and labels";
    for line in [
        format!("(trik) break whels\n'whels' {may}; did you mean 'wheels'?\n"),
        format!("(trik) break 99\n'99' {may}\n"),
        format!("(trik) until gian\n'gian' {may}; did you mean 'gain'?\n"),
        format!("(trik) list weels\n'weels' {may}; did you mean 'wheels'?\n"),
        "(trik) list wheels\n    2   numbers - Loop:".to_owned(),
    ] {
        assert!(told.contains(&line), "{line}: {told}");
    }
    let words = ["debug", "count.flow", "--language", "ru"];
    let told = debug(&board, &words, "break whels\nq\n").good();
    let line = "\u{43c}\u{435}\u{442}\u{43a}\u{438} \u{43f}\u{43e}\u{43a}\u{430}\u{437}\u{44b}\u{432}\u{430}\u{435}\u{442} list; \u{43c}\u{43e}\u{436}\u{435}\u{442} \u{431}\u{44b}\u{442}\u{44c}, 'wheels'?\n";
    assert!(told.contains(line), "{told}");
}

#[test]
fn a_label_with_spaces_is_a_place() {
    let board = Board::new();
    let walls = include_str!("../../../../examples/dataflow/walls.flow");
    board.file("walls.flow", walls);
    let typed = "break Keep to the wall/turn\nbreak Keep to the wall/turn if 1 > 2\nbreak Keep to the wall/trun\nq\n";
    let told = debug(&board, &["debug", "walls.flow"], typed).good();
    for line in [
        "breakpoint 1 at line ",
        "breakpoint 2 at line ",
        "mean 'Keep to the wall/turn'?",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
}

#[test]
fn what_a_debugger_does_not_change_is_what_it_would_be_alone() {
    let board = board();
    let alone = debug(&board, &["check", "count.flow"], "").good();
    let told = debug(
        &board,
        &["debug", "count.flow"],
        "break wheels\nc\nc\nd\nc\nq\n",
    )
    .good();
    let seconds = alone
        .split(" s")
        .next()
        .and_then(|text| text.rsplit(' ').next());
    let seconds = seconds.expect("a time");
    assert!(told.contains(seconds), "{seconds}: {told}");
}

#[test]
fn a_broken_program_is_refused_with_its_place() {
    let board = board();
    board.file("broken.flow", "diagram \"Counter\"\n  wheels: Wheels\n");
    let refused = debug(&board, &["debug", "broken.flow"], "c\nq\n");
    assert_eq!(refused.code(), 2, "{}", refused.stderr);
    assert!(
        refused.stderr.contains("broken.flow:2:11: "),
        "{}",
        refused.stderr
    );
}

#[test]
fn an_editor_stops_at_blocks_of_a_data_flow_program() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch_file(&board, "count.flow", json!({}));
    // Editors ask for it by themselves; no is no error.
    let told = editor.good("setExceptionBreakpoints", json!({"filters": ["errors"]}));
    assert_eq!(told["breakpoints"][0]["verified"], false, "{told}");
    let points =
        json!({"breakpoints": [{"name": "wheels", "condition": "data > 5"}, {"name": "nothing"}]});
    let set = editor.good("setFunctionBreakpoints", points);
    assert_eq!(set["breakpoints"][0]["verified"], true, "{set}");
    assert_eq!(set["breakpoints"][1]["verified"], false, "{set}");
    editor.good("configurationDone", json!({}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "breakpoint");
    assert_eq!(stopped["text"], "wheels.M3 gets 6");
    let threads = editor.good("threads", json!({}));
    assert_eq!(threads["threads"], json!([{"id": 1, "name": "flow"}]));
    let line = editor.line(&stopped);
    let source = editor.good("source", json!({"sourceReference": 1}));
    let text = source["content"].as_str().expect("a text");
    let shown = text.lines().nth(line as usize - 1).expect("the line");
    assert!(shown.contains("wheels"), "{shown}");
    assert_eq!(editor.value("sum * 10"), "60");
    let ports = editor.good("variables", json!({"variablesReference": 3}));
    let ports: Vec<&str> = ports["variables"]
        .as_array()
        .expect("all")
        .iter()
        .filter_map(|one| one["name"].as_str())
        .collect();
    assert_eq!(ports, ["numbers.OUT", "sum.O0"]);
    board.file(
        "count.flow",
        COUNTER.replace("gain * I0", "gain * I0 + 100"),
    );
    editor.good("restart", json!({}));
    editor.event("loadedSource");
    editor.event("stopped");
    editor.good("continue", json!({"threadId": 1}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["text"], "wheels.M3 gets 108");
    editor.good("next", json!({"threadId": 1}));
    editor.event("stopped");
    // Each step goes back, and the run back to where it was stopped before.
    editor.good("stepBack", json!({"threadId": 1}));
    assert_eq!(editor.event("stopped")["text"], "wheels.M3 gets 108");
    assert_eq!(editor.value("sum"), "108");
    editor.good("stepBack", json!({"threadId": 1}));
    assert_eq!(editor.event("stopped")["text"], "sum.I0 gets 4");
    assert_eq!(editor.value("sum"), "6");
    editor.good("reverseContinue", json!({"threadId": 1}));
    let stopped = editor.event("stopped");
    assert_eq!(
        (&stopped["reason"], &stopped["text"]),
        (&json!("breakpoint"), &json!("wheels.M3 gets 6"))
    );
    assert_eq!(editor.line(&stopped), 7);
    editor.end();
}

#[test]
fn an_editor_stops_at_changes_of_variables_and_gets_lines() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch_file(&board, "count.flow", json!({"stopOnEntry": true}));
    let points = json!({"source": {"sourceReference": 1}, "breakpoints": [
        {"line": 7, "logMessage": "{data} to the wheels", "condition": "data > 4"},
        {"line": 7, "logMessage": "{data} of {gian}"},
    ]});
    let set = editor.good("setBreakpoints", points);
    assert_eq!(set["breakpoints"][0]["verified"], true, "{set}");
    let why = set["breakpoints"][1]["message"].as_str().expect("why");
    let wanted = "the line: 1:12 the program has no variable 'gian'; did you mean 'gain'?";
    assert_eq!(why, wanted);
    let points = json!({"breakpoints": [
        {"dataId": "sum", "accessType": "write", "condition": "sum > 7"},
        {"dataId": "smu"}, {"dataId": "gain", "hitCondition": ">= 2"},
    ]});
    let set = editor.good("setDataBreakpoints", points);
    let verified = set["breakpoints"].as_array().expect("all").iter();
    let verified: Vec<bool> = verified.map(|one| one["verified"] == true).collect();
    assert_eq!(verified, [true, false, true], "{set}");
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    editor.good("continue", json!({"threadId": 1}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "data breakpoint");
    assert_eq!(stopped["text"], "sum was 6 and is 8", "{stopped}");
    // Before the token that goes to the wheels, whose line was written for the one before.
    assert_eq!(editor.line(&stopped), 7);
    assert_eq!(editor.event("output")["output"], "6 to the wheels\n");
    let info = editor.good(
        "dataBreakpointInfo",
        json!({"variablesReference": 1, "name": "sum"}),
    );
    assert_eq!(info["dataId"], "sum", "{info}");
    editor.end();
}

#[test]
fn a_diagram_does_not_take_the_place_of_a_data_flow_program() {
    let board = Board::new();
    let project = lang_dataflow::text::read(COUNTER).expect("a program");
    let save = lang_dataflow::save::save(&project).write().expect("a save");
    board.file("count.qrs", save);
    let mut editor = Editor::start();
    editor.launch_file(&board, "count.qrs", json!({"stopOnEntry": true}));
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    board.file("count.qrs", super::counting());
    editor.good("restart", json!({}));
    let told = editor.event("output");
    let text = told["output"].as_str().expect("a text");
    assert!(text.starts_with("the program begins anew: "), "{text}");
    assert!(text.contains("the other language of blocks"), "{text}");
    editor.event("stopped");
    let threads = editor.good("threads", json!({}));
    assert_eq!(threads["threads"][0]["name"], "main");
    editor.end();
}

#[test]
fn another_main_diagram_is_checked_debugged_and_written_as_a_converter() {
    let board = Board::new();
    let both = format!("diagram \"Says\"\n  hello: Say(text = hello)\n{COUNTER}");
    board.file("both.flow", &both);
    let project = lang_dataflow::text::read(&both).expect("a program");
    let save = lang_dataflow::save::save(&project).write().expect("a save");
    board.file("both.qrs", save);
    for file in ["both.flow", "both.qrs"] {
        let first = debug(&board, &["check", file], "").good();
        assert!(first.contains(": ended (no rules), 0.00 s"), "{first}");
        let other = debug(&board, &["check", file, "--diagram", "Counter"], "").good();
        assert!(other.contains(": ended (no rules), 4.00 s"), "{other}");
        let typed = "break wheels if data > 6\nc\nreload\nq\n";
        let told = debug(&board, &["debug", file, "--diagram", "Counter"], typed).good();
        for part in ["wheels.M3 gets 8", "changed: 4 blocks kept, 0 new, 0 gone"] {
            assert!(told.contains(part), "{part}: {told}");
        }
        let refused = debug(&board, &["check", file, "--diagram", "counter"], "");
        let why = "there are: Says, Counter; did you mean 'Counter'?";
        assert!(refused.stdout.contains(why), "{}", refused.stdout);
    }
    let other = debug(&board, &["run", "x.py", "--diagram", "Counter"], "");
    let why = "--diagram is for diagrams (NAME.qrs, NAME.flow), and this is another program";
    board.file("x.py", "print(1)");
    for words in [["run", "x.py"], ["check", "x.py"]] {
        let other = debug(&board, &[words[0], words[1], "--diagram", "Counter"], "");
        let told = other.stdout + &other.stderr;
        assert!(told.contains(why), "{told}");
    }
    assert!(
        other.stderr.contains("there is no such file"),
        "{}",
        other.stderr
    );
    let large = format!("{both}{}", " ".repeat(16 << 20));
    board.file("large.flow", large);
    let large = debug(&board, &["run", "large.flow"], "");
    assert!(
        large
            .stderr
            .contains("and a robot takes at most 16776192 in one message"),
        "{}",
        large.stderr
    );
    let mut editor = Editor::start();
    let options = json!({"stopOnEntry": true, "diagram": "Counter"});
    editor.launch_file(&board, "both.qrs", options);
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    let source = editor.good("source", json!({"sourceReference": 1}));
    let text = source["content"].as_str().expect("a text");
    assert!(text.starts_with("Program \"Counter\""), "{text}");
    editor.end();
}
