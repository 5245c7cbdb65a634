//! The debugger of diagrams on a robot: orders of several clients, motors at a stop, and what is lost with whom.

use crate::rig::{Client, Robot, frame, robot};
use harness::{eventually, processes};
use lang_diagram::sketch::Sketch;
use nix::sys::signal::Signal;
use nix::sys::socket::{setsockopt, sockopt::RcvBuf};

/// A save, and the ids of its blocks in the order in which they were drawn.
struct Save {
    bytes: Vec<u8>,
    ids: Vec<String>,
}

fn save(sketch: &Sketch) -> Save {
    let diagrams = sketch.project().diagrams;
    let blocks = diagrams.iter().flat_map(|sheet| &sheet.blocks);
    Save {
        ids: blocks.map(|block| block.id.clone()).collect(),
        bytes: sketch.qrs().expect("a save"),
    }
}

/// Blocks of [`counting`].
const MOTOR: usize = 2;
const COUNT: usize = 3;
const WAIT: usize = 4;

/// M1 at 40 percent, a variable that counts every 30 ms.
fn counting(body: &str) -> Save {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0")]);
    let motor = [("Ports", "M1"), ("Power", "40")];
    let motor = sketch.block("TrikV6EnginesForward", &motor);
    let count = sketch.block("Function", &[("Body", body)]);
    let wait = sketch.block("Timer", &[("Delay", "30")]);
    sketch.chain(&[start, clear, motor, count, wait, count]);
    save(&sketch)
}

fn upload(client: &mut Client, name: &str, save: &Save) {
    crate::diagrams::upload(client, name, &save.bytes);
}

/// What M1 was told last.
fn motor(robot: &Robot) -> String {
    let value = std::fs::read_to_string(robot.tree.join("motors/M1/value")).expect("a value");
    value.trim().to_owned()
}

/// The answer to an order.
fn ask(client: &mut Client, tag: u32, order: &str) -> String {
    client.send(&format!("debug:{tag} {order}"));
    answer(client, tag)
}

fn answer(client: &mut Client, tag: u32) -> String {
    loop {
        let told = client.until("debug: ");
        if told.contains(&format!("\"to\":{tag},\"done\":")) {
            return told;
        }
    }
}

fn expect(client: &mut Client, tag: u32, order: &str, part: &str) {
    let told = ask(client, tag, order);
    assert!(told.contains(part), "{order}: {told}");
}

fn until_state(client: &mut Client, word: &str) -> String {
    client.until(&format!("debug: {{\"state\":\"{word}\""))
}

/// A robot that runs [`counting`], and a client.
fn counts(body: &str) -> (Robot, Client, Save) {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let save = counting(body);
    upload(&mut client, "count.qrs", &save);
    client.send("run:count.qrs");
    client.until("print: 2\n");
    (robot, client, save)
}

const COUNTING: &str = "n = n + 1\nprint(n)";

#[test]
fn a_diagram_begins_stopped_and_its_motors_rest_at_each_stop_and_come_back() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let save = counting(COUNTING);
    upload(&mut client, "count.qrs", &save);
    client.send("debug:1 run count.qrs");
    client.until("debug: {\"control\":\"127.0.0.1:");
    client.until("info: count.qrs has started");
    client.until("debug: {\"to\":1,\"done\":true}");
    let state = until_state(&mut client, "stopped");
    let begin =
        "debug: {\"state\":\"stopped\",\"ms\":0,\"attached\":true,\"stop\":{\"reason\":\"pause\"}";
    assert!(state.starts_with(begin), "{state}");
    assert!(state.contains("\"variables\":[]"), "{state}");
    let at = |id: &str| format!("\"id\":\"{id}\"");
    expect(
        &mut client,
        2,
        &format!("until {}", save.ids[MOTOR]),
        "true",
    );
    let state = until_state(&mut client, "stopped");
    assert!(state.contains(&at(&save.ids[MOTOR])), "{state}");
    let stepped = ask(&mut client, 3, "step");
    assert!(stepped.contains(&at(&save.ids[COUNT])), "{stepped}");
    assert_eq!(
        motor(&robot),
        "0",
        "it was told 40 in this step, and it is over"
    );
    // It counts beyond the breakpoint for as long as the motor is looked at.
    expect(&mut client, 4, "set n=100", "\"value\":\"100\"");
    let order = format!("break {}\nif n == 3", save.ids[WAIT]);
    expect(
        &mut client,
        5,
        &order,
        "{\"number\":2,\"to\":5,\"done\":true}",
    );
    expect(&mut client, 6, "continue", "\"state\":\"running\"");
    assert_eq!(motor(&robot), "40");
    expect(&mut client, 7, "set n=1", "\"value\":\"1\"");
    let state = until_state(&mut client, "stopped");
    assert!(
        state.contains("\"reason\":\"breakpoint\",\"number\":2"),
        "{state}"
    );
    assert_eq!(motor(&robot), "0");
    expect(&mut client, 8, "evaluate n * 100", "\"value\":\"300\"");
    expect(&mut client, 9, "back", "\"state\":\"past\"");
    expect(&mut client, 10, "evaluate n", "\"value\":\"2\"");
    expect(&mut client, 11, "set n=50", "a debugger looks at the past");
    expect(&mut client, 12, "present", "\"state\":\"stopped\"");
    expect(&mut client, 13, "set n=50", "\"value\":\"50\"");
    assert_eq!(motor(&robot), "0", "being in the past moves nothing");
    expect(&mut client, 14, "motors keep", "true");
    assert_eq!(motor(&robot), "40");
    expect(&mut client, 15, "motors rest", "true");
    assert_eq!(motor(&robot), "0");
    client.send("debug:16 detach");
    answer(&mut client, 16);
    client.until("print: 51\n");
    assert_eq!(motor(&robot), "40");
    expect(&mut client, 17, "attach", "\"state\":\"running\"");
    robot.forget_rest();
    client.send("stop");
    until_state(&mut client, "gone");
    client.until("info: count.qrs was stopped by a client");
    assert!(robot.has_rested());
}

/// M1 at 40 percent and a variable that counts every 30 ms, as a data-flow program.
const FLOW: &str = "
diagram \"Counter\"
  numbers: Loop(start_border = 1, end_border = 1000, increment = 1, time = 30)
  sum: \"Text programming\"(IO0 = `n = I0; 40`)
  wheels: Motors
  numbers.OUT -> sum.I0
  sum.O0 -> wheels.M1
";

#[test]
fn a_data_flow_program_stops_at_changes_and_its_lines_reach_all_who_debug() {
    let robot = robot(&[]);
    let (mut client, mut other) = (robot.client("control"), robot.client("control"));
    other.keep_alive();
    client.send(&format!("file:count.flow:{FLOW}"));
    client.send("debug:1 run count.flow");
    client.until("info: count.flow has started");
    let state = until_state(&mut client, "stopped");
    assert!(state.contains("\"reason\":\"pause\""), "{state}");
    expect(&mut other, 2, "look", "\"state\":\"stopped\"");
    expect(&mut client, 3, "watch nn", "no variable 'nn'");
    expect(
        &mut client,
        4,
        "watch n\nif n > 5",
        "{\"number\":1,\"to\":4,\"done\":true}",
    );
    expect(
        &mut client,
        5,
        "watch n\nlog n is {n}",
        "{\"number\":2,\"to\":5,\"done\":true}",
    );
    expect(&mut client, 6, "continue", "\"state\":\"running\"");
    other.until("debug: {\"log\":[\"n is 1\"");
    let state = until_state(&mut client, "stopped");
    let why =
        "\"reason\":\"change\",\"number\":1,\"variable\":\"n\",\"was\":\"5\",\"is\":\"6\",\"by\":{";
    assert!(state.contains(why), "{state}");
    assert_eq!(motor(&robot), "0", "motors rest at a stop");
    expect(&mut client, 7, "clear all", "\"done\":true");
    expect(&mut client, 8, "continue", "\"state\":\"running\"");
    eventually("it drives on", || motor(&robot) == "40");
}

#[test]
fn one_client_is_in_control_and_the_others_see_who_and_what() {
    let (robot, mut one, save) = counts(COUNTING);
    let mut two = robot.client("control");
    let mut quiet = robot.client("control");
    // Each may be silent while others are asked.
    for client in [&one, &two, &quiet] {
        client.keep_alive();
    }
    let seen = ask(&mut two, 1, "look");
    assert!(
        seen.contains("\"state\":\"running\"") && seen.contains(&save.ids[WAIT]),
        "{seen}"
    );
    expect(&mut one, 1, "attach", "\"attached\":true");
    let control = two.until("debug: {\"control\":\"127.0.0.1:");
    let who = one.stream.local_addr().unwrap();
    assert_eq!(control, format!("debug: {{\"control\":\"{who}\"}}"));
    let refused = format!("debug: {{\"why\":\"{who} is in control\",\"to\":2,\"done\":false}}");
    for order in [
        "attach",
        "pause",
        "detach",
        "set n=1",
        "run count.qrs",
        "break x",
    ] {
        assert_eq!(ask(&mut two, 2, order), refused, "{order}");
    }
    expect(&mut one, 2, "pause", "true");
    until_state(&mut two, "stopped");
    expect(&mut two, 3, "evaluate n > 0", "true");
    expect(&mut two, 4, "breakpoints", "\"breakpoints\":[]");
    expect(&mut one, 3, "leave", "{\"to\":3,\"done\":true}");
    two.until("debug: {\"control\":null}");
    expect(&mut two, 5, "look", "\"state\":\"stopped\"");
    assert_eq!(motor(&robot), "0");
    expect(&mut two, 6, "continue", "\"state\":\"running\"");
    assert_eq!(motor(&robot), "40");
    // A client that has left hears nothing more, and one that has never asked never did.
    for client in [&mut one, &mut quiet] {
        client.send("version");
        loop {
            let told = client.next().expect("a message");
            assert!(!told.starts_with("debug: {\"state\":\"running\""), "{told}");
            if told.starts_with("version") {
                break;
            }
        }
    }
    let late = robot.client("control");
    let mut late = late;
    late.send("debug:1 look");
    late.until("debug: {\"control\":");
}

#[test]
fn a_program_whose_controller_is_lost_stays_stopped_or_runs_on_without_its_breakpoints() {
    let (robot, mut one, save) = counts(COUNTING);
    let mut two = robot.client("control");
    two.keep_alive();
    expect(&mut two, 1, "look", "true");
    expect(&mut one, 1, "attach", "true");
    expect(&mut one, 2, "pause", "true");
    until_state(&mut two, "stopped");
    // Whatever was asked for: nobody looks at the robot any more.
    expect(&mut one, 3, "motors keep", "true");
    assert_eq!(motor(&robot), "40");
    drop(one);
    two.until("debug: {\"control\":null}");
    expect(&mut two, 2, "look", "\"state\":\"stopped\"");
    assert_eq!(motor(&robot), "0");
    expect(&mut two, 3, "continue", "\"state\":\"running\"");
    assert_eq!(motor(&robot), "40");
    let order = format!("break {}\nif n > 1000", save.ids[WAIT]);
    expect(&mut two, 4, &order, "true");
    let mut three = robot.client("control");
    expect(&mut three, 1, "look", "\"attached\":true");
    drop(two);
    three.until("debug: {\"control\":null}");
    expect(&mut three, 2, "look", "\"attached\":false");
    expect(&mut three, 3, "breakpoints", "\"breakpoints\":[]");
    three.until("print: ");
    assert_eq!(motor(&robot), "40");
}

#[test]
fn a_client_that_never_reads_slows_nobody_and_gets_the_last_state() {
    let (robot, mut client, save) = counts(COUNTING);
    let mut slow = robot.client("control");
    setsockopt(&slow.stream, RcvBuf, &4096).expect("an option");
    slow.keep_alive();
    slow.send("watch");
    slow.send("debug:1 look");
    expect(&mut client, 1, "attach", "true");
    let order = format!("break {}\nlog {}", save.ids[COUNT], "x".repeat(900));
    for _ in 0..30 {
        ask(&mut client, 2, &order);
    }
    // What waits for it has no more room.
    let missed = |client: &mut Client| {
        let log = client.until("debug: {\"log\":[");
        log.len()
    };
    let mut bytes = 0;
    while bytes < 2 << 20 {
        bytes += missed(&mut client);
    }
    expect(&mut client, 3, "clear all", "true");
    expect(&mut client, 4, "pause", "true");
    let state = until_state(&mut client, "stopped");
    expect(&mut client, 5, "set n=123456", "true");
    // Now it reads.
    let (mut has_lost, mut is_last, mut knows) = (false, false, false);
    while !(has_lost && is_last && knows) {
        let seen = slow.next().expect("a message");
        has_lost |= seen.contains("messages were left out");
        knows |= seen.starts_with("info: main: ") && seen.contains("n = 123456");
        is_last = seen == state || is_last && !seen.starts_with("debug: {\"state\"");
    }
}

#[test]
fn rubbish_changes_nothing_and_each_order_is_answered_once() {
    let (robot, mut client, save) = counts(COUNTING);
    client.send("debug:look");
    client.until("debug: {\"why\":\"a request to debug is a number, a blank and an order\",\"to\":null,\"done\":false}");
    for (order, why) in [
        ("", "'' is no order"),
        ("fly", "'fly' is no order"),
        ("pause", "attach the debugger first"),
        ("run ../x.qrs", "it leads out of the folder of programs"),
        ("run none.qrs", "there is no program 'none.qrs'"),
        ("evaluate 1 +", "\"done\":false"),
        ("evaluate \u{0}\u{1b}", "\"done\":false"),
        ("break \u{43f}\nif\nif", "\"done\":false"),
        ("until nowhere", "attach the debugger first"),
    ] {
        expect(&mut client, 7, order, why);
    }
    let long = format!("evaluate {}", "1+".repeat(100_000));
    expect(&mut client, 8, &long, "an order has at most 16384 bytes");
    // Conditions that are as deep as they may be, and deeper.
    expect(&mut client, 9, "attach", "true");
    for (condition, told) in [
        ("1 + ".repeat(150) + "1 < 0", "\"number\":1,"),
        (
            "1 + ".repeat(1000) + "1 < 0",
            "\"why\":\"the condition: 1:1 The expression is nested too deeply",
        ),
        (
            "(".repeat(2000) + "0" + &")".repeat(2000),
            "\"why\":\"the condition: 1:",
        ),
        ("n +".to_owned(), "\"why\":\"the condition: 1:3 "),
    ] {
        let order = format!("break {}\nif {condition}", save.ids[WAIT]);
        expect(&mut client, 10, &order, told);
    }
    expect(
        &mut client,
        10,
        "watch nobody",
        "this cannot be watched: 1:1 ",
    );
    expect(&mut client, 11, "clear all", "true");
    expect(
        &mut client,
        12,
        &format!("break {}\nif n / 0 > 1", save.ids[WAIT]),
        "true",
    );
    // A condition before may have stopped it.
    ask(&mut client, 13, "continue");
    eventually("a stop", || {
        ask(&mut client, 14, "look").contains("\"reason\":\"condition\",\"number\":2")
    });
    assert_eq!(motor(&robot), "0");
    expect(&mut client, 15, "detach", "true");
    client.until("print: ");
    client.sync();
}

#[test]
fn more_breakpoints_than_can_be_are_refused_however_many_come_at_once() {
    let (_robot, mut client, save) = counts(COUNTING);
    expect(&mut client, 0, "attach", "true");
    let order = format!("break {} from 1000000", save.ids[WAIT]);
    let (mut made, mut refused) = (0, 0);
    for batch in 0..50 {
        let tags = batch * 200..(batch + 1) * 200;
        for tag in tags.clone() {
            client.send(&format!("debug:{tag} {order}"));
        }
        for tag in tags {
            let told = answer(&mut client, tag);
            made += usize::from(told.contains("\"number\":"));
            refused += usize::from(told.contains("there are 1000 breakpoints already"));
        }
    }
    assert_eq!((made, refused), (1000, 9000));
    let told = ask(&mut client, 1, "breakpoints");
    assert!(
        told.len() < 128 << 10 && told.contains("\"breakpoints_left_out\":"),
        "{}",
        told.len()
    );
    expect(&mut client, 2, "clear all", "true");
    client.until("print: ");
}

#[test]
fn other_programs_have_no_debugger() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    expect(&mut client, 1, "look", "\"why\":\"no diagram runs\"");
    client.send("file:a.py:print(1)\nwhile True:\n    pass\n");
    client.send("run:a.py");
    client.until("print: 1");
    for order in ["look", "attach", "pause", "detach", "break x"] {
        expect(&mut client, 2, order, "\"why\":\"no diagram runs\"");
    }
    expect(
        &mut client,
        3,
        "run a.py",
        "only diagrams and JavaScript programs have this debugger",
    );
    client.send("status");
    let status = client.until("status: ");
    assert!(status.contains("program a.py"), "{status}");
    client.send("stop");
    client.until("info: a.py was stopped by a client");
}

#[test]
fn an_error_stops_where_it_is_before_its_thread_ends() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let save = counting("n = n + 1\nm = 1 / (3 - n)");
    upload(&mut client, "wrong.qrs", &save);
    client.send("debug:1 run wrong.qrs");
    until_state(&mut client, "stopped");
    expect(&mut client, 2, "errors stop", "true");
    expect(&mut client, 3, "continue", "true");
    let state = until_state(&mut client, "stopped");
    assert!(state.contains("\"reason\":\"error\",\"text\":"), "{state}");
    assert!(
        state.contains(&format!("\"id\":\"{}\"", save.ids[COUNT])),
        "{state}"
    );
    assert_eq!(motor(&robot), "0");
    expect(&mut client, 4, "evaluate n", "\"value\":\"3\"");
    client.send("debug:5 continue");
    answer(&mut client, 5);
    let state = until_state(&mut client, "ended");
    assert!(state.contains("\"with_errors\":true"), "{state}");
    until_state(&mut client, "gone");
    client.until("info: wrong.qrs has failed");
    expect(&mut client, 6, "look", "no diagram runs");
}

#[test]
fn a_stopped_program_takes_a_new_version_and_goes_on_with_it() {
    let (robot, mut client, save) = counts(COUNTING);
    expect(&mut client, 1, "attach", "true");
    expect(&mut client, 2, &format!("break {}", save.ids[WAIT]), "true");
    until_state(&mut client, "stopped");
    upload(
        &mut client,
        "count.qrs",
        &counting("n = n + 1000\nprint(n)"),
    );
    client.send("patch:refuse:count.qrs");
    client.until("info: count.qrs is changed: ");
    assert_eq!(motor(&robot), "0");
    expect(&mut client, 3, "continue", "true");
    let state = until_state(&mut client, "stopped");
    assert!(state.contains("\"value\":\"100"), "{state}");
    expect(&mut client, 4, "detach", "true");
    client.until("print: 2");
    assert_eq!(motor(&robot), "40");
}

#[test]
fn motors_rest_when_anybody_is_killed_while_a_program_is_stopped() {
    let (robot, mut client, _) = counts(COUNTING);
    let stopped = |client: &mut Client| {
        expect(client, 1, "attach", "true");
        expect(client, 2, "pause", "true");
        until_state(client, "stopped");
        assert_eq!(motor(&robot), "0");
        robot.forget_rest();
    };
    stopped(&mut client);
    let program = processes::children(robot.daemon());
    client.send("debug:4 evaluate n");
    processes::signal(program[0], Signal::SIGKILL);
    answer(&mut client, 4);
    until_state(&mut client, "gone");
    // Somebody else did that, and not the system for want of memory.
    client.until("error: count.qrs was killed by signal 9 (SIGKILL) from outside after ");
    assert!(robot.has_rested());
    client.send("run:count.qrs");
    client.until("print: 2\n");
    stopped(&mut client);
    let daemon = robot.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("rest", || robot.has_rested());
    eventually("no program", || {
        program.iter().all(|pid| !processes::is_alive(*pid)) && robot.daemon() != daemon
    });
    assert_eq!(motor(&robot), "0");
}

#[test]
fn who_leaves_is_answered_when_the_stop_before_it_is_done() {
    let (robot, mut client, _) = counts(COUNTING);
    expect(&mut client, 1, "attach", "true");
    robot.forget_rest();
    client.raw([frame("stop"), frame("debug:2 leave")].concat());
    let mut has_stopped = false;
    loop {
        let told = client.next().expect("an answer");
        has_stopped |= told.starts_with("info: count.qrs was stopped by a client");
        if told.contains("\"to\":2,") {
            assert!(told.contains("\"done\":true"), "{told}");
            break;
        }
    }
    assert!(has_stopped && robot.has_rested());
}

#[test]
fn a_computer_that_is_not_paired_may_look_and_no_more() {
    let robot = robot(&["--pair"]);
    let mut client = robot.client("control");
    expect(&mut client, 1, "look", "no diagram runs");
    for order in ["attach", "pause", "run count.qrs", "set n=1"] {
        expect(&mut client, 2, order, "this computer is not paired");
    }
    expect(&mut client, 3, "evaluate 1", "no diagram runs");
}
