//! Diagrams: uploaded, run, watched, refused.

use crate::rig::{Client, Robot, robot};
use harness::eventually;
use harness::wait::SOON;
use lang_diagram::sketch::Sketch;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;

/// M1 at 40 percent, a variable that counts, a wait, and on.
pub fn counting() -> Vec<u8> {
    counting_by("n = n + 1")
}

pub fn counting_by(body: &str) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0")]);
    let forward = sketch.block(
        "TrikV6EnginesForward",
        &[("Ports", "M1"), ("Power", "20 * 2")],
    );
    let count = sketch.block("Function", &[("Body", &format!("{body}\nprint(n)"))]);
    let wait = sketch.block("Timer", &[("Delay", "30")]);
    sketch.chain(&[start, clear, forward, count, wait, count]);
    sketch.qrs().expect("a save")
}

/// Sends a save to a robot: at once, so that nothing of a client that is kept alive comes between.
pub fn upload(client: &mut Client, name: &str, save: &[u8]) {
    let head = format!("file:{name}:");
    let head = format!("{}:{head}", head.len() + save.len());
    client.raw([head.as_bytes(), save].concat());
}

/// What is told of a diagram from now on, a line each.
fn diagram_lines(robot: &Robot) -> impl Iterator<Item = String> {
    let mut stream = TcpStream::connect(("127.0.0.1", robot.port("variables"))).unwrap();
    stream.set_read_timeout(Some(SOON)).unwrap();
    stream.write_all(b"GET /diagram HTTP/1.0\r\n\r\n").unwrap();
    let mut lines = BufReader::new(stream).lines().map(Result::unwrap);
    assert_eq!(lines.next().as_deref(), Some("HTTP/1.0 200 OK"));
    lines
}

fn motor(robot: &Robot) -> String {
    let value = std::fs::read_to_string(robot.tree.join("motors/M1/value")).expect("a value");
    value.trim().to_owned()
}

#[test]
fn a_diagram_drives_prints_and_is_stopped_like_any_program() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "count.qrs", &counting());
    client.send("run:count.qrs");
    client.expect("info: count.qrs has started");
    client.expect("print: 1\n");
    client.expect("print: 2\n");
    assert_eq!(motor(&robot), "40");
    robot.forget_rest();
    client.send("stop");
    let told = client.until("info: ");
    assert!(
        told.starts_with("info: count.qrs was stopped by a client"),
        "{told}"
    );
    assert!(robot.has_rested());
}

#[test]
fn an_ending_in_capital_letters_says_the_same() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "COUNT.QRS", &counting());
    client.send("run:COUNT.QRS");
    client.expect("info: COUNT.QRS has started");
    client.expect("print: 1\n");
    client.send("stop");
    client.until("info: COUNT.QRS was stopped by a client");
    // A block that reacts to nothing is at its end at once.
    let text = b"diagram \"First\"\n  say: Say(text = hello)\n";
    upload(&mut client, "FIRST.FLOW", text);
    client.send("run:FIRST.FLOW");
    client.expect("info: FIRST.FLOW has started");
    client.until("info: FIRST.FLOW has ended");
}

#[test]
fn who_asks_sees_the_block_and_the_variables_and_who_does_not_is_left_alone() {
    let robot = robot(&[]);
    let mut stream = TcpStream::connect(("127.0.0.1", robot.port("variables"))).unwrap();
    stream.set_read_timeout(Some(SOON)).unwrap();
    stream.write_all(b"GET /diagram HTTP/1.0\r\n\r\n").unwrap();
    let mut curious = robot.client("control");
    curious.send("watch");
    upload(&mut curious, "count.qrs", &counting());
    curious.send("run:count.qrs");
    curious.until("info: main: ");
    let line = curious.until("info: main: Timer; n = ");
    assert!(line.len() < 60, "{line}");
    let mut lines = BufReader::new(stream).lines().map(Result::unwrap);
    assert_eq!(lines.next().as_deref(), Some("HTTP/1.0 200 OK"));
    let object = lines
        .find(|line| line.contains("\"variables\":{\"n\":"))
        .unwrap();
    assert!(
        object.starts_with("{\"ms\":")
            && object.contains("\"threads\":[{\"name\":\"main\",")
            && object.contains("\"block\":\"Timer\"}]"),
        "{object}"
    );
    // All variables, for web pages.
    let mut web = robot.client("variables");
    web.raw("GET /web/ HTTP/1.0\r\n\r\n");
    let answer = web.exactly(4096);
    let answer = String::from_utf8_lossy(&answer);
    assert!(answer.contains("\r\n\r\n{\"n\":"), "{answer}");
    let mut quiet = robot.client("control");
    quiet.until("print: ");
    quiet.send("stop");
    loop {
        let told = quiet.next().expect("a message");
        assert!(!told.starts_with("info: main"), "{told}");
        if told.starts_with("info: count.qrs was stopped") {
            break;
        }
    }
}

#[test]
fn a_client_sees_the_blocks_of_a_data_flow_program_that_react_and_their_tokens() {
    let robot = robot(&[]);
    let mut lines = diagram_lines(&robot);
    let mut client = robot.client("control");
    let text = b"diagram \"Count\"\n  hello: Say(text = hello)\n  L: Loop(start_border = 1, end_border = 3, time = 100)\n  F: \"Text programming\"(IO0 = `n = I0 * 2; n`)\n  S: Say\n  L.OUT -> F.I0\n  F.O0 -> S.DATA\n";
    upload(&mut client, "count.flow", text);
    client.send("run:count.flow");
    client.expect("info: count.flow has started");
    // From its first instant on, and up to the last one.
    let first = lines.find(|line| line.contains("\"ms\"")).unwrap();
    assert!(
        first.contains(",\"anew\":true,\"blocks\":[{\"id\":")
            && first.contains("\"block\":\"DFSayBlock\",\"caption\":\"hello\",\"reacted\":1}"),
        "{first}"
    );
    let last = lines
        .find(|line| line.contains(",\"count\":3}"))
        .expect("the last token");
    assert!(
        last.contains("\"variables\":{\"n\":6}")
            && last.contains("\"reacted\":3,\"ports\":[{\"port\":\"O0\",")
            && last.contains("\"value\":\"6\",\"count\":3}")
            && !last.contains("\"anew\""),
        "{last}"
    );
    client.until("info: count.flow has ended");
}

#[test]
fn long_variables_and_the_blocks_of_a_data_flow_program_take_turns() {
    let robot = robot(&[]);
    let mut lines = diagram_lines(&robot);
    let mut client = robot.client("control");
    let long = "x".repeat(1000);
    let text = format!(
        "diagram \"Long\"\n  L: Loop(end_border = 1000000, time = 50)\n  F: \"Text programming\"(IO0 = `a = '{long}'; b = a; c = a; 1`)\n  S: Say\n  L.OUT -> F.I0\n  F.O0 -> S.DATA\n"
    );
    upload(&mut client, "long.flow", text.as_bytes());
    client.send("run:long.flow");
    client.expect("info: long.flow has started");
    for _ in 0..2 {
        let is_of_blocks =
            |line: &String| line.contains("\"variables\":{},") && line.contains("\"port\":\"O0\"");
        lines.find(is_of_blocks).expect("blocks alone");
        let variables = lines.next().unwrap();
        assert!(
            variables.contains("\"a\":\"xxx") && !variables.contains("\"blocks\""),
            "{variables}"
        );
    }
    client.send("stop");
    client.until("info: long.flow was stopped by a client");
}

#[test]
fn each_recording_begins_with_all_that_blocks_did_since_one_was_made() {
    const HELLO: &str = "\"caption\":\"hello\",\"reacted\":1}";
    let robot = robot(&[]);
    let begin = || {
        let mut recorder = robot.client("control");
        recorder.send("stream:");
        recorder.keep_alive();
        let beginning = recorder.exactly(64);
        assert_eq!(beginning.len(), 64);
        recorder
    };
    let has = |recorder: &mut Client, text: &str| {
        let mut seen = String::new();
        while seen.len() < 100_000 && !seen.contains(text) {
            seen += &String::from_utf8_lossy(&recorder.exactly(64));
        }
        assert!(seen.len() < 100_000, "nothing of {text}");
    };
    let mut first = begin();
    let mut client = robot.client("control");
    let text = b"diagram \"Go\"\n  hello: Say(text = hello)\n  L: Loop(end_border = 1000000, time = 50)\n  S: Say\n  L.OUT -> S.DATA\n";
    upload(&mut client, "go.flow", text);
    client.send("run:go.flow");
    client.expect("info: go.flow has started");
    client.keep_alive();
    has(&mut first, HELLO);
    // The second one comes while the first one records.
    let mut second = begin();
    has(&mut second, HELLO);
    // What is told of a new version is a new beginning.
    upload(&mut client, "go.flow", text);
    client.send("patch:end:go.flow");
    client.until("info: go.flow is changed");
    has(&mut second, "\"anew\":true,\"blocks\":[");
    client.send("stop");
    client.until("info: go.flow was stopped by a client");
}

#[test]
fn errors_name_the_block_and_stay_with_the_diagram() {
    let robot = robot(&["--language", "ru_RU.UTF-8"]);
    let mut client = robot.client("control");
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wrong = sketch.block("Function", &[("Body", "x = 1 / 0")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, wrong, end]);
    upload(&mut client, "wrong.qrs", &sketch.qrs().unwrap());
    client.send("run:wrong.qrs");
    let told = client.until("error: ");
    // In Russian, as that was asked for.
    assert!(!told.is_ascii() && told.contains("1:"), "{told}");
    assert!(client.until("info: wrong.qrs has failed").contains("after"));
    let cut = &counting()[..100];
    for (name, save) in [
        ("cut.qrs", cut),
        ("empty.qrs", b""),
        ("noise.qrs", b"PK\x03\x04 nonsense"),
    ] {
        upload(&mut client, name, save);
        client.send(&format!("run:{name}"));
        let told = client.until("error: ");
        assert!(told.starts_with(&format!("error: {name}: ")), "{told}");
        client.until(&format!("info: {name} has failed"));
    }
    client.send("version");
    client.until("version: 3.1.4");
}

#[test]
fn a_client_hears_the_language_that_it_asks_for_or_that_of_the_robot() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wrong = sketch.block("Function", &[("Body", "x = 1 / 0")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, wrong, end]);
    for (robots, asked) in [
        (
            "en",
            [("", false), ("language:ru", true), ("language:en", false)],
        ),
        (
            "ru",
            [("", true), ("language:en", false), ("language:ru", true)],
        ),
    ] {
        let robot = robot(&["--language", robots]);
        let mut client = robot.client("control");
        upload(&mut client, "wrong.qrs", &sketch.qrs().unwrap());
        upload(&mut client, "count.qrs", &counting());
        speaks(&mut client, asked);
    }
}

/// What a client hears after each of these requests is in Russian, or is not.
fn speaks(client: &mut Client, asked: [(&str, bool); 3]) {
    let is_russian = |text: &str| text.chars().any(|c| ('\u{430}'..='\u{44f}').contains(&c));
    for (asks, is_wanted) in asked {
        client.send(asks);
        let mut hear = |request: &str, answer: &str| {
            client.send(request);
            client.until(answer)
        };
        let mut told = vec![
            hear("run:wrong.qrs", "error: main: "),
            hear("run:none.py", "error: "),
        ];
        hear("run:count.qrs", "info: count.qrs has started");
        told.extend([
            hear("set:n=", "error: n is not changed: "),
            hear("debug:1 step", "debug: {\"why\":"),
            hear("debug:2 break", "debug: {\"why\":"),
        ]);
        for told in told {
            assert_eq!(is_russian(&told), is_wanted, "{asks}: {told}");
        }
        client.send("debug:3 leave");
        client.until("debug: {\"to\":3");
        client.send("stop");
        client.until("info: count.qrs was stopped");
    }
}

#[test]
fn each_mistake_of_a_diagram_is_told_once_with_its_block_and_place() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let motor = sketch.block("TrikV6EnginesForward", &[("Ports", "M1"), ("Power", "4 *")]);
    // Nothing leads to this one, and the first one ends its thread.
    let odd = sketch.block("Function", &[("Body", "n = 1\nprint(n +)")]);
    let fork = sketch.block("Fork", &[]);
    let other = sketch.block("Loop", &[("Iterations", "3")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, fork, motor, end]);
    sketch.chain(&[fork, other, end]);
    sketch.chain(&[odd, end]);
    let save = sketch.qrs().expect("a save");
    for language in ["en_US.UTF-8", "ru_RU.UTF-8"] {
        let robot = robot(&["--language", language]);
        let mut client = robot.client("control");
        // Nothing of the first run keeps the second one from telling.
        for _ in 0..2 {
            upload(&mut client, "odd.qrs", &save);
            client.send("run:odd.qrs");
            client.until("info: odd.qrs has started");
            let mut told = Vec::new();
            loop {
                let line = client.next().expect("a message");
                if line.starts_with("info: odd.qrs has failed") {
                    break;
                }
                told.push(line);
            }
            // Found at load, and when its block is reached: what nothing leads to is not looked at.
            assert_eq!(told.len(), 2, "{told:#?}");
            assert!(told[0].starts_with("info: "), "{told:#?}");
            assert!(told[1].starts_with("error: main: "), "{told:#?}");
            assert!(told[1].contains(" (100, 0): "), "{told:#?}");
            assert!(told[1].contains(" 1:3 "), "{told:#?}");
            let loops = told.iter().filter(|line| line.contains(" Loop ("));
            assert_eq!(loops.count(), 1, "{told:#?}");
            assert!(told[0].contains(": main: "), "{told:#?}");
        }
    }
}

#[test]
fn a_diagram_reads_what_the_tree_has_and_says_what_it_has_not() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let show = sketch.block(
        "Function",
        &[("Body", "print(sensorA1 .. ' ' .. encoder1)")],
    );
    let note = sketch.block(
        "TrikWriteToFile",
        &[("File", "notes/n.txt"), ("Text", "'x'")],
    );
    let missing = sketch.block("TrikV6EnginesForward", &[("Ports", "M2"), ("Power", "1")]);
    let shell = sketch.block(
        "TrikSystem",
        &[("Command", "echo from the shell > made.txt")],
    );
    // A command goes on beside the program and ends with it, at the latest.
    let pause = sketch.block("Timer", &[("Delay", "600000")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, show, note, missing, shell, pause, end]);
    upload(&mut client, "read.qrs", &sketch.qrs().unwrap());
    client.send("run:read.qrs");
    client.until("print: 27 90\n");
    client.until("info: notes/n.txt: ");
    client.until("info: M2: the robot has no such motor");
    eventually("what the command wrote", || {
        robot.home.path("scripts/made.txt").exists()
    });
}

#[test]
fn the_oddities_of_the_original_are_kept_or_mended_as_the_robot_is_told() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let show = sketch.block("Function", &[("Body", "print(-16777217)")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, show, end]);
    let save = sketch.qrs().expect("a save");
    for (rules, shown) in [("studio", "-16777216"), ("fixed", "-16777217")] {
        let robot = robot(&["--compat", rules]);
        let mut client = robot.client("control");
        upload(&mut client, "odd.qrs", &save);
        client.send("run:odd.qrs");
        assert_eq!(client.until("print: "), format!("print: {shown}\n"));
    }
}

/// Runs the counter until it counts.
pub fn count(client: &mut Client) {
    upload(client, "count.qrs", &counting());
    client.send("run:count.qrs");
    while printed(client) < 2 {}
}

/// The number of the next line that the program prints.
pub fn printed(client: &mut Client) -> i64 {
    let line = client.until("print: ");
    let number = line.trim_start_matches("print: ").trim();
    number.parse().expect("a number")
}

#[test]
fn a_new_version_takes_over_what_runs_and_motors_do_not_stop() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "count.qrs", &counting());
    client.send("run:count.qrs");
    while printed(&mut client) < 3 {}
    robot.forget_rest();
    upload(&mut client, "count.qrs", &counting_by("n = n + 1000"));
    client.send("patch:refuse:count.qrs");
    let told = client.until("info: count.qrs is changed: ");
    assert_eq!(
        told,
        "info: count.qrs is changed: 5 blocks kept, 0 new, 0 gone"
    );
    let first = printed(&mut client);
    assert!(
        (1003..2000).contains(&first),
        "n began anew, or kept its step: {first}"
    );
    assert_eq!(printed(&mut client), first + 1000);
    assert_eq!(motor(&robot), "40");
    assert!(!robot.has_rested());
    client.send("set:n=7");
    client.until("info: n is changed: n = 7");
    assert_eq!(printed(&mut client), 1007);
    client.send("stop");
    client.until("info: count.qrs was stopped by a client");
}

#[test]
fn what_is_wrong_changes_nothing_and_says_where() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.send("patch:end:count.qrs");
    client.until("error: there is no program 'count.qrs'");
    upload(&mut client, "count.qrs", &counting());
    client.send("patch:end:count.qrs");
    client.until("error: count.qrs is not changed: no diagram runs");
    client.send("set:n=7");
    client.until("error: n is not changed: no diagram runs");
    client.send("run:count.qrs");
    client.expect("info: count.qrs has started");
    while printed(&mut client) < 2 {}
    upload(&mut client, "count.qrs", &counting_by("n = n +"));
    client.send("patch:end:count.qrs");
    let told = client.until("error: count.qrs is not changed: ");
    assert!(
        told.contains("main: Function (300, 0): 'Expression', 1:"),
        "{told}"
    );
    // A client that has not asked sees what the program says, and nothing else.
    let mut other = robot.client("control");
    other.sync();
    // It may wait for longer than a client may be silent.
    other.keep_alive();
    upload(&mut client, "count.qrs", &counting_by("n = 'text'"));
    client.send("patch:end:count.qrs");
    client.until("error: count.qrs is not changed: ");
    upload(&mut client, "count.qrs", b"PK\x03\x04 nonsense");
    client.send("patch:end:count.qrs");
    client.until("error: count.qrs is not changed: ");
    upload(&mut client, "other.qrs", &counting());
    client.send("patch:end:other.qrs");
    let told = client.until("error: other.qrs is not changed: ");
    assert!(told.contains("count.qrs runs"), "{told}");
    for wrong in [
        "set:n='text'",
        "set:n=1 / 0",
        "set:n=1; x = 2",
        "set:n; x=1",
        "set:=",
        "set:n=",
        "set:n=99999999999999999999",
        "set:m=1",
    ] {
        client.send(wrong);
        client.until("error: ");
    }
    client.send("set:N=1");
    let told = client.until("error: N is not changed: ");
    assert!(told.ends_with("it has: n; did you mean 'n'?"), "{told}");
    for unknown in ["patch:count.qrs", "patch:maybe:count.qrs", "patch:"] {
        client.send(unknown);
        client.until("error: this request is written patch:end:NAME or patch:refuse:NAME");
    }
    let before = printed(&mut client);
    assert_eq!(printed(&mut client), before + 1);
    other.send("version");
    let mut heard = other.next().expect("it is still connected");
    while !heard.starts_with("version: ") {
        assert!(heard.starts_with("print: "), "{heard}");
        heard = other.next().expect("it is still connected");
    }
    client.send("stop");
    client.until("info: count.qrs was stopped by a client");
}

#[test]
fn a_thread_without_its_block_ends_with_an_error() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    count(&mut client);
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, end]);
    upload(&mut client, "count.qrs", &sketch.qrs().unwrap());
    client.send("patch:refuse:count.qrs");
    let told = client.until("error: count.qrs is not changed: ");
    assert!(told.contains("thread main is"), "{told}");
    printed(&mut client);
    robot.forget_rest();
    client.send("patch:end:count.qrs");
    client.until("info: count.qrs has failed");
    assert!(robot.has_rested());
}

/// Asks twice: with a default, and without.
fn asking() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let many = [("variable", "n"), ("prompt", "How many?"), ("default", "7")];
    let first = sketch.block("Input", &many);
    let second = sketch.block("Input", &[("variable", "m"), ("prompt", "And?")]);
    let said = sketch.block("Function", &[("Body", "print(n * 10)\nprint(m)")]);
    let none = sketch.block("Function", &[("Body", "print(n)")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, first, second, said, end]);
    sketch.guarded(second, none, "cancel");
    sketch.link(none, end);
    sketch.qrs().expect("a save")
}

#[test]
fn a_diagram_asks_a_person_and_goes_on_if_nobody_is_there() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "ask.qrs", &asking());
    client.send("run:ask.qrs");
    client.expect("info: ask.qrs has started");
    client.expect(
        "info: ask.qrs asks a person, and nobody is there: trik run ask.qrs in a terminal would answer",
    );
    client.until("print: 7\n");
    client.until("info: ask.qrs has ended");

    let mut person = robot.client("control");
    person.send("questions");
    person.send("run:ask.qrs");
    person.expect("info: ask.qrs has started");
    person.expect(
        "question: {\"number\":1,\"variable\":\"n\",\"question\":\"How many?\",\"default\":\"7\",\"seconds\":120}",
    );
    // Answers to other questions, and of nobody, count for nothing.
    person.send("answer:9:1");
    person.send("answer:x:1");
    person.until("error: this request is written answer:");
    person.send("answer:1:2 + 1");
    person.expect(
        "question: {\"number\":2,\"variable\":\"m\",\"question\":\"And?\",\"default\":\"\",\"seconds\":120}",
    );
    person.send("answer:2:'a:b'");
    person.expect("print: 30\n");
    person.expect("print: a:b\n");
    person.until("info: ask.qrs has ended");
    person.send("run:ask.qrs");
    person.expect("info: ask.qrs has started");
    person.until("question: {\"number\":1,");
    for (number, answer) in [(1, "nonsense"), (2, "2 +"), (3, "'text'")] {
        person.send(&format!("answer:{number}:{answer}"));
        let next = format!("question: {{\"number\":{},\"variable\":\"n\",", number + 1);
        let asked = person.until(&next);
        assert!(asked.contains("\"wrong\":\""), "{asked}");
    }
    person.send("answer:4");
    person.send("noquestions");
    person.until("print: 7\n");
}
