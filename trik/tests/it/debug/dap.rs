//! The Debug Adapter Protocol by hand: real frames on the standard streams of the real program, and over TCP.

use super::{counting, counting_by};
use crate::rig::TRIK;
use harness::Board;
use harness::wait::LIFE;
use lang_diagram::sketch::Sketch;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};

/// A client of an adapter.
pub(super) struct Editor {
    process: Child,
    to: Box<dyn Write>,
    from: Receiver<Value>,
    /// Came and was not asked for yet.
    kept: Vec<Value>,
    seq: u64,
}

fn frame(from: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if from.read_line(&mut line).ok()? == 0 {
            return None;
        }
        match line.trim() {
            "" => break,
            line => length = line.strip_prefix("Content-Length: ")?.parse().ok()?,
        }
    }
    let mut body = vec![0; length];
    from.read_exact(&mut body).ok()?;
    serde_json::from_slice(&body).ok()
}

impl Editor {
    fn over(process: Child, to: Box<dyn Write>, from: impl Read + Send + 'static) -> Self {
        let (put, messages) = channel();
        std::thread::spawn(move || {
            let mut from = BufReader::new(from);
            while let Some(message) = frame(&mut from) {
                if put.send(message).is_err() {
                    break;
                }
            }
        });
        Self {
            process,
            to,
            from: messages,
            kept: Vec::new(),
            seq: 0,
        }
    }

    pub(super) fn start() -> Self {
        let mut process = Command::new(TRIK)
            .arg("dap")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the adapter");
        let to = process.stdin.take().expect("its input");
        let from = process.stdout.take().expect("its output");
        Self::over(process, Box::new(to), from)
    }

    fn raw(&mut self, bytes: &[u8]) {
        self.to.write_all(bytes).expect("room");
        self.to.flush().expect("room");
    }

    /// The next message that is one of these; others are kept.
    pub(super) fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        if let Some(at) = self.kept.iter().position(&wanted) {
            return self.kept.remove(at);
        }
        loop {
            let message = self.from.recv_timeout(LIFE).expect("a message");
            if wanted(&message) {
                return message;
            }
            self.kept.push(message);
        }
    }

    pub(super) fn event(&mut self, name: &str) -> Value {
        self.wait(|message| message["event"] == name)["body"].take()
    }

    /// Asks and does not wait; gives the number of the request.
    pub(super) fn post(&mut self, command: &str, arguments: Value) -> u64 {
        self.seq += 1;
        let seq = self.seq;
        let body =
            json!({"seq": seq, "type": "request", "command": command, "arguments": arguments});
        let body = body.to_string();
        self.raw(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
        seq
    }

    /// The whole answer to a request.
    pub(super) fn answer(&mut self, seq: u64) -> Value {
        self.wait(|message| message["request_seq"] == seq)
    }

    pub(super) fn ask(&mut self, command: &str, arguments: Value) -> Value {
        let seq = self.post(command, arguments);
        self.answer(seq)
    }

    pub(super) fn good(&mut self, command: &str, arguments: Value) -> Value {
        let mut answer = self.ask(command, arguments);
        assert_eq!(answer["success"], true, "{command}: {answer}");
        answer["body"].take()
    }

    pub(super) fn bad(&mut self, command: &str, arguments: Value) -> String {
        let answer = self.ask(command, arguments);
        assert_eq!(answer["success"], false, "{command}: {answer}");
        answer["message"].as_str().expect("why").to_owned()
    }

    pub(super) fn launch(&mut self, board: &Board, more: Value) {
        self.launch_file(board, "count.qrs", more);
    }

    pub(super) fn launch_file(&mut self, board: &Board, file: &str, more: Value) {
        self.good("initialize", json!({"adapterID": "trik"}));
        let mut arguments = json!({"program": board.path(file)});
        for (name, value) in more.as_object().expect("members") {
            arguments[name] = value.clone();
        }
        self.good("launch", arguments);
        self.event("initialized");
    }

    /// The line at which it is stopped.
    pub(super) fn line(&mut self, stopped: &Value) -> u64 {
        let thread = stopped["threadId"].as_u64().expect("a thread");
        let stack = self.good("stackTrace", json!({ "threadId": thread }));
        stack["stackFrames"][0]["line"].as_u64().expect("a line")
    }

    pub(super) fn value(&mut self, text: &str) -> String {
        let arguments = json!({"expression": text, "context": "watch"});
        let answer = self.good("evaluate", arguments);
        answer["result"].as_str().expect("a value").to_owned()
    }

    /// Its process.
    pub(super) fn id(&self) -> u32 {
        self.process.id()
    }

    /// As when its computer is switched off.
    pub(super) fn kill(mut self) {
        self.process.kill().expect("an end");
        self.process.wait().expect("an end");
    }

    pub(super) fn end(mut self) {
        self.good("disconnect", json!({}));
        drop(self.to);
        assert!(self.process.wait().expect("an end").success());
    }
}

pub(super) fn board() -> Board {
    let board = Board::new();
    board.file("count.qrs", counting());
    board
}

#[test]
fn an_editor_stops_at_lines_and_steps_both_ways() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch(&board, json!({}));
    let points = json!({"source": {"sourceReference": 1}, "breakpoints": [
        {"line": 4, "condition": "n == 1"}, {"line": 7}, {"line": 4, "logMessage": "n is {n}"},
        {"line": 4, "hitCondition": "often"},
    ]});
    let set = editor.good("setBreakpoints", points);
    let verified: Vec<_> = set["breakpoints"].as_array().expect("all").iter().collect();
    let verified: Vec<bool> = verified.iter().map(|one| one["verified"] == true).collect();
    assert_eq!(verified, [true, false, true, false], "{set}");
    assert!(
        set["breakpoints"][1]["message"]
            .as_str()
            .expect("why")
            .contains("no block")
    );
    editor.good("setExceptionBreakpoints", json!({"filters": ["errors"]}));
    editor.good("configurationDone", json!({}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "breakpoint");
    assert_eq!(stopped["hitBreakpointIds"], json!([1]));
    assert_eq!(editor.line(&stopped), 4);
    assert_eq!(editor.value("n * 10"), "10");
    let told = editor.wait(|message| message["body"]["output"] == "n is 0\n");
    assert_eq!(told["body"]["category"], "console");

    let thread = json!({"threadId": stopped["threadId"]});
    editor.good("next", thread.clone());
    let stopped = editor.event("stopped");
    assert_eq!(editor.line(&stopped), 5);
    editor.good("stepIn", thread.clone());
    let stopped = editor.event("stopped");
    let stack = editor.good("stackTrace", thread.clone());
    assert_eq!(stack["totalFrames"], 2, "{stack}");
    assert_eq!(editor.line(&stopped), 9);
    editor.good("stepOut", thread.clone());
    let stopped = editor.event("stopped");
    assert_eq!(editor.line(&stopped), 6);
    assert_eq!(editor.value("m"), "4");
    editor.good("stepBack", thread.clone());
    let stopped = editor.event("stopped");
    assert_eq!(editor.line(&stopped), 5);
    assert!(
        editor
            .bad(
                "setVariable",
                json!({"variablesReference": 1, "name": "n", "value": "7"})
            )
            .contains("the past")
    );
    editor.end();
}

#[test]
fn an_editor_stops_at_changes_and_hears_what_is_wrong_with_conditions() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch(&board, json!({"stopOnEntry": true}));
    let points = json!({"breakpoints": [
        {"line": 4, "condition": "n +"}, {"line": 4, "condition": "n == 2"},
        {"line": 4, "logMessage": "n is {nn}"},
    ]});
    let set = editor.good("setBreakpoints", points);
    for (at, why) in [(0, "the condition: 1:3 "), (2, "the line: 1:7 ")] {
        let told = set["breakpoints"][at]["message"].as_str().expect("why");
        assert!(told.starts_with(why), "{set}");
        assert_eq!(set["breakpoints"][at]["verified"], false);
    }
    assert_eq!(set["breakpoints"][1]["verified"], true);
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    editor.good("continue", json!({"threadId": 1}));
    editor.event("stopped");
    let ask = json!({"variablesReference": 1, "name": "m"});
    let info = editor.good("dataBreakpointInfo", ask);
    assert_eq!(info["dataId"], "m", "{info}");
    let unknown = editor.good("dataBreakpointInfo", json!({"name": "1 + 1"}));
    assert_eq!(unknown["dataId"], Value::Null);
    let points = json!({"breakpoints": [
        {"dataId": "m", "accessType": "write"}, {"dataId": "nn"}, {"dataId": "m", "condition": "("},
    ]});
    let set = editor.good("setDataBreakpoints", points);
    let verified = set["breakpoints"].as_array().expect("all").iter();
    let verified: Vec<bool> = verified.map(|one| one["verified"] == true).collect();
    assert_eq!(verified, [true, false, false], "{set}");
    editor.good("continue", json!({"threadId": 1}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "data breakpoint");
    assert_eq!(stopped["text"], "m was 4 and is 6", "{stopped}");
    editor.good("reverseContinue", json!({"threadId": 1}));
    assert_eq!(editor.event("stopped")["reason"], "breakpoint");
    editor.good("reverseContinue", json!({"threadId": 1}));
    assert_eq!(editor.event("stopped")["text"], "m was 2 and is 4");
    editor.end();
}

#[test]
fn a_restart_changes_what_runs_and_begins_anew_only_if_it_must() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch(&board, json!({"stopAtEnd": true}));
    let points = json!({"breakpoints": [{"line": 4, "condition": "n == 2"}]});
    editor.good("setBreakpoints", points);
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    board.file("count.qrs", counting_by("n = n + 10\nprint(n)"));
    editor.good("restart", json!({}));
    assert_eq!(editor.event("loadedSource")["reason"], "changed");
    assert_eq!(editor.event("breakpoint")["breakpoint"]["line"], 4);
    assert_eq!(editor.event("stopped")["reason"], "breakpoint");
    assert_eq!(editor.value("n"), "2", "it goes on where it was");
    let text = editor.good("source", json!({"sourceReference": 1}));
    assert!(
        text["content"]
            .as_str()
            .expect("a text")
            .contains("n = n + 10")
    );
    editor.good("next", json!({"threadId": 1}));
    editor.event("stopped");
    assert_eq!(editor.value("n"), "12");
    // Mistakes change nothing.
    board.file("count.qrs", counting_by("n = n +"));
    let why = editor.bad("restart", json!({}));
    assert!(
        why.contains("1:7 ") && why.contains("goes on as it was"),
        "{why}"
    );
    board.file("count.qrs", "rubbish");
    let why = editor.bad("restart", json!({}));
    assert!(why.contains("count.qrs: "), "{why}");
    assert_eq!(editor.value("n"), "12");
    // Another type of a variable, which only a new beginning can have.
    board.file("count.qrs", counting_by("n = 'a'"));
    editor.good("setBreakpoints", json!({"breakpoints": []}));
    let why = editor.ask("restart", json!({}));
    assert_eq!(
        why["success"], false,
        "n is a number in other blocks: {why}"
    );
    // The same file again: the person wants a beginning.
    board.file("count.qrs", counting_by("n = n + 10\nprint(n)"));
    editor.good("restart", json!({}));
    let stopped = editor.event("stopped");
    assert!(
        stopped["text"].as_str().expect("why").contains("has ended"),
        "{stopped}"
    );
    assert_eq!(editor.value("n"), "50");
    // It is over, and begins anew with what is in the file.
    board.file("count.qrs", counting_by("n = n + 100\nprint(n)"));
    editor.good("restart", json!({}));
    let told = editor.wait(|message| {
        let text = message["body"]["output"].as_str();
        text.is_some_and(|text| text.starts_with("the program begins anew: "))
    });
    assert_eq!(told["body"]["category"], "important");
    editor.event("stopped");
    assert_eq!(editor.value("n"), "500");
    editor.end();
}

/// Counts for as long as ten minutes of model time.
fn long() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0")]);
    let count = sketch.block("Function", &[("Body", "n = n + 1")]);
    let wait = sketch.block("Timer", &[("Delay", "10")]);
    sketch.chain(&[start, clear, count, wait, count]);
    sketch.qrs().expect("a save")
}

#[test]
fn a_long_way_back_is_given_up_when_an_editor_pauses() {
    let board = board();
    board.file("count.qrs", long());
    let mut editor = Editor::start();
    editor.launch(&board, json!({"stopAtEnd": true}));
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    let last = editor.value("n");
    let points = json!({"breakpoints": [{"line": 3, "condition": "n < 0"}]});
    editor.good("setBreakpoints", points);
    for end in ["pause", "cancel"] {
        // Both at once, so that the way back is not over before.
        let back = editor.post("reverseContinue", json!({"threadId": 1}));
        let end_of_it = editor.post(end, json!({"threadId": 1}));
        for seq in [back, end_of_it] {
            assert_eq!(editor.answer(seq)["success"], true, "{end}");
        }
        let stopped = editor.event("stopped");
        assert_eq!(stopped["reason"], "pause", "{end}: {stopped}");
        assert_eq!(editor.value("n"), last, "{end}");
    }
    editor.good("reverseContinue", json!({"threadId": 1}));
    editor.event("stopped");
    // Before the first block it has no value.
    let why = editor.bad("evaluate", json!({"expression": "n"}));
    assert!(why.contains("uninitialized variable n"), "{why}");
    editor.end();
}

#[test]
fn what_an_editor_shows_is_read_set_and_completed() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch(&board, json!({}));
    let points = json!({"breakpoints": [{"line": 6, "condition": "n == 2"}]});
    editor.good("setBreakpoints", points);
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    let set = json!({"variablesReference": 1, "name": "n", "value": "n + 1"});
    assert_eq!(editor.good("setVariable", set)["value"], "3");
    let variables = editor.good("variables", json!({"variablesReference": 1}));
    let names: Vec<_> = variables["variables"]
        .as_array()
        .expect("all")
        .iter()
        .collect();
    assert_eq!(
        names.iter().filter(|one| one["name"] == "n").count(),
        1,
        "{variables}"
    );
    let found = editor.good("completions", json!({"text": "2 * n", "column": 6}));
    assert!(
        found["targets"]
            .as_array()
            .expect("all")
            .iter()
            .any(|one| one["label"] == "n")
    );
    let text = editor.good("source", json!({"sourceReference": 1}));
    assert!(
        text["content"]
            .as_str()
            .expect("a text")
            .contains("n = n + 1"),
        "{text}"
    );
    let locations = editor.good("breakpointLocations", json!({"line": 1, "endLine": 100}));
    assert!(
        locations["breakpoints"].as_array().expect("all").len() >= 5,
        "{locations}"
    );
    editor.good("setBreakpoints", json!({"breakpoints": []}));
    editor.good("continue", json!({"threadId": 1}));
    assert_eq!(editor.event("exited")["exitCode"], 0);
    editor.event("terminated");
    editor.end();
}

#[test]
fn a_run_begins_stopped_if_wanted_and_anew_with_its_breakpoints() {
    let board = board();
    let mut editor = Editor::start();
    editor.launch(&board, json!({"stopOnEntry": true, "stopAtEnd": true}));
    let named = json!({"breakpoints": [{"name": "twice"}, {"name": "nothing"}]});
    let set = editor.good("setFunctionBreakpoints", named);
    assert_eq!(set["breakpoints"][0]["verified"], true);
    assert_eq!(set["breakpoints"][1]["verified"], false);
    editor.good("configurationDone", json!({}));
    assert_eq!(editor.event("stopped")["reason"], "entry");
    for round in ["1", "2"] {
        editor.good("continue", json!({"threadId": 1}));
        assert_eq!(editor.event("stopped")["reason"], "breakpoint");
        assert_eq!(editor.value("n"), round);
    }
    editor.good("restart", json!({}));
    assert_eq!(editor.event("stopped")["reason"], "entry");
    editor.good("continue", json!({"threadId": 1}));
    editor.event("stopped");
    assert_eq!(editor.value("n"), "1");
    let stack = editor.good(
        "stackTrace",
        json!({"threadId": 1, "startFrame": 1, "levels": 1}),
    );
    let id = stack["stackFrames"][0]["instructionPointerReference"].clone();
    let ids = json!({"breakpoints": [{"instructionReference": id}, {"instructionReference": "x"}]});
    let set = editor.good("setInstructionBreakpoints", ids);
    assert_eq!(set["breakpoints"][0]["verified"], true, "{set}");
    assert_eq!(set["breakpoints"][1]["verified"], false);
    editor.good("setFunctionBreakpoints", json!({"breakpoints": []}));
    editor.good("setInstructionBreakpoints", json!({"breakpoints": []}));
    editor.good("continue", json!({"threadId": 1}));
    // The run is over, and its past is there.
    let stopped = editor.event("stopped");
    assert!(
        stopped["text"].as_str().expect("why").contains("has ended"),
        "{stopped}"
    );
    editor.good("reverseContinue", json!({"threadId": 1}));
    editor.event("stopped");
    editor.good("terminate", json!({}));
    editor.event("terminated");
    editor.end();
}

#[test]
fn a_program_without_end_is_paused_while_it_runs() {
    let board = board();
    board.file("count.qrs", long());
    let mut editor = Editor::start();
    editor.launch(&board, json!({"speed": 0.5}));
    editor.good("configurationDone", json!({}));
    editor.good("pause", json!({"threadId": 1}));
    assert_eq!(editor.event("stopped")["reason"], "pause");
    editor.end();
}

#[test]
fn rubbish_is_told_and_the_talk_goes_on() {
    let board = board();
    let mut editor = Editor::start();
    editor.raw(b"GET / HTTP/1.1\r\n\r\n");
    editor.raw(b"Content-Length: 99999999999\r\n\r\n");
    editor.raw(b"Content-Length: 3\r\n\r\n[1]");
    editor.raw(b"Content-Length: 2\r\n\r\n{}");
    for _ in 0..4 {
        assert_eq!(editor.event("output")["category"], "important");
    }
    assert!(
        editor
            .bad("threads", json!({}))
            .contains("launch a program first")
    );
    assert!(
        editor
            .bad("launch", json!({}))
            .contains("\"program\" is needed")
    );
    assert!(
        editor
            .bad("launch", json!({"program": "/nowhere.qrs"}))
            .contains("/nowhere.qrs")
    );
    editor.launch(&board, json!({"stopOnEntry": true}));
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    for (command, arguments) in [
        ("fly", json!({})),
        ("evaluate", json!({"expression": "1 +"})),
        ("evaluate", json!({"expression": "print(1)"})),
        ("setVariable", json!({})),
        ("setExpression", json!({"expression": "n", "value": "1; 2"})),
    ] {
        editor.bad(command, arguments);
    }
    let stack = editor.good("stackTrace", json!({"threadId": 99, "levels": u64::MAX}));
    assert_eq!(stack["totalFrames"], 0);
    let many: Vec<Value> = (0..1100).map(|_| json!({"line": 4})).collect();
    let set = editor.good("setBreakpoints", json!({"breakpoints": many}));
    assert_eq!(set["breakpoints"][0]["verified"], true);
    assert_eq!(
        set["breakpoints"][1099]["verified"], false,
        "more than can be"
    );
    editor.end();
}

#[test]
fn clients_come_over_tcp_one_after_the_other() {
    let board = board();
    let mut process = Command::new(TRIK)
        .args(["dap", "--listen", "0"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the adapter");
    let mut line = String::new();
    let mut told = BufReader::new(process.stderr.take().expect("its words"));
    told.read_line(&mut line).expect("a line");
    let port: u16 = line
        .trim()
        .rsplit(':')
        .next()
        .expect("a port")
        .parse()
        .expect("a port");
    for _ in 0..2 {
        let stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
        let input = stream.try_clone().expect("the other way");
        let nobody = Command::new("true").spawn().expect("a process");
        let mut editor = Editor::over(nobody, Box::new(stream), input);
        editor.launch(&board, json!({"stopOnEntry": true}));
        editor.good("configurationDone", json!({}));
        editor.event("stopped");
        editor.end();
    }
    process.kill().expect("its end");
    process.wait().expect("its end");
}
