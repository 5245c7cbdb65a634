//! Large programs of blocks: versions that take long to read and to check, what is strange about them, and a program for
//! which there is no memory.

use crate::diagrams::{count, counting, counting_by, printed, upload};
use crate::rig::robot;
use lang_diagram::sketch::Sketch;

/// How something strange is told.
const STRANGE: &str = "info: warning: ";

/// A counter with a thread of many blocks beside it, which take a while to read and to check.
fn counting_beside_many() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0; m = 0")]);
    // The first blocks are those of the counter, so that they have its ids.
    let forward = sketch.block("TrikV6EnginesForward", &[("Ports", "M1"), ("Power", "40")]);
    let count = sketch.block("Function", &[("Body", "n = n + 1\nprint(n)")]);
    let wait = sketch.block("Timer", &[("Delay", "30")]);
    let fork = sketch.block("Fork", &[]);
    sketch.chain(&[start, clear, forward, fork]);
    sketch.chain(&[count, wait, count]);
    sketch.guarded(fork, count, "main");
    let many: Vec<_> = (0..3000)
        .map(|at| sketch.block("Function", &[("Body", &format!("m = m * 2 + {at}"))]))
        .collect();
    let end = sketch.block("FinalNode", &[]);
    sketch.guarded(fork, many[0], "other");
    sketch.chain(&many);
    sketch.link(many[2999], end);
    sketch.qrs().expect("a save")
}

#[test]
fn a_large_version_is_prepared_beside_the_program() {
    // Before there is a client, which may not be silent for so long.
    let many = counting_beside_many();
    let robot = robot(&[]);
    let mut client = robot.client("control");
    count(&mut client);
    upload(&mut client, "count.qrs", &many);
    // What it has printed so far does not count.
    client.sync();
    client.send("patch:end:count.qrs");
    // What is asked for later is done later, though it would be quicker.
    client.send("set:n=7");
    let mut rounds = 0;
    loop {
        let heard = client.next().expect("an answer");
        if heard.starts_with("info: count.qrs is changed: ") {
            break;
        }
        assert!(heard.starts_with("print: "), "{heard}");
        rounds += 1;
    }
    assert!(rounds > 0, "it stood still meanwhile");
    client.until("info: n is changed: n = 7");
    client.send("stop");
    client.until("info: count.qrs was stopped by a client");
}

/// A program that counts, beside blocks that make each version of it take a while.
fn long_flow(step: u32, blocks: u32) -> String {
    let mut text = format!(
        "diagram main\n  tick: Loop(start_border = 0, end_border = 100000, time = 10)\n  \
         count: \"Text programming\"(IO0 = `n = I0 * {step}; print(\"n \" .. n); n`)\n  tick.OUT -> count.I0\n"
    );
    for at in 0..blocks {
        text += &format!(
            "  f{at}: \"Text programming\"(IO0 = `I0 + {at}`)\n  tick.CF_OUT -> f{at}.I0\n"
        );
    }
    text
}

#[test]
fn many_versions_at_once_do_not_hold_what_runs() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "long.flow", long_flow(0, 1000).as_bytes());
    client.send("run:long.flow");
    client.until("print: n 0");
    const VERSIONS: u32 = 8;
    for step in 1..=VERSIONS {
        upload(&mut client, "long.flow", long_flow(step, 1000).as_bytes());
        client.send("patch:end:long.flow");
    }
    let (mut changes, mut held, mut was_change) = (0, 0, false);
    while changes < VERSIONS {
        let told = client.next().expect("an answer");
        let is_change = told.starts_with("info: long.flow is changed");
        assert!(is_change || told.starts_with("print: n "), "{told}");
        held += u32::from(is_change && was_change);
        changes += u32::from(is_change);
        was_change = is_change;
    }
    // Several that take little time may come before one step.
    assert!(held < VERSIONS - 1, "nothing came between the versions");
    client.send("stop");
}

#[test]
fn a_large_version_of_data_flow_is_prepared_beside_the_program() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "long.flow", long_flow(0, 1).as_bytes());
    client.send("run:long.flow");
    client.until("print: n 0");
    upload(&mut client, "long.flow", long_flow(1, 3000).as_bytes());
    client.sync();
    client.send("patch:end:long.flow");
    let mut rounds = 0;
    loop {
        let heard = client.next().expect("an answer");
        if heard.starts_with("info: long.flow is changed: ") {
            break;
        }
        let is_warning = heard.starts_with(STRANGE);
        assert!(is_warning || heard.starts_with("print: n 0"), "{heard}");
        rounds += u32::from(!is_warning);
    }
    assert!(rounds > 0, "it stood still meanwhile");
    client.send("stop");
    client.until("info: long.flow was stopped by a client");
}

#[test]
fn what_is_strange_about_a_version_is_told_once() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    count(&mut client);
    let mut told = |body: &str| {
        upload(&mut client, "count.qrs", &counting_by(body));
        client.send("patch:end:count.qrs");
        let mut warnings = Vec::new();
        loop {
            let heard = client.next().expect("an answer");
            if let Some(warning) = heard.strip_prefix(STRANGE) {
                warnings.push(warning.to_owned());
            } else if heard.starts_with("info: count.qrs is changed: ") {
                return warnings;
            }
            assert!(!heard.starts_with("error: "), "{heard}");
        }
    };
    let first = told("n = n + 99999999999");
    let [one] = &first[..] else {
        panic!("{first:?}");
    };
    assert!(one.contains("99999999999"), "{one}");
    assert_eq!(told("n = n + 99999999999\n"), [""; 0]);
    assert_eq!(told("n = n + 1"), [""; 0]);
    assert_eq!(told("n = n + 99999999999"), first);
}

#[test]
fn a_version_that_would_take_all_memory_is_refused_and_the_program_goes_on() {
    let mut sketch = Sketch::new();
    let long = "m = m + 1\n".repeat(6000);
    let blocks: Vec<_> = (0..25)
        .map(|_| sketch.block("Function", &[("Body", &long)]))
        .collect();
    sketch.chain(&blocks);
    let save = sketch.qrs().expect("a save");
    assert!(save.len() < 200_000, "it is packed well");
    let robot = robot(&[]);
    let mut client = robot.client("control");
    count(&mut client);
    upload(&mut client, "count.qrs", &save);
    client.send("patch:end:count.qrs");
    let told = client.until("error: count.qrs is not changed: ");
    assert!(told.contains("640 KiB can be prepared"), "{told}");
    let before = printed(&mut client);
    while printed(&mut client) < before + 3 {}
    client.send("stop");
}

#[test]
fn a_diagram_that_is_too_large_for_the_memory_of_a_program_ends_with_that_reason() {
    let robot = robot(&["--memory-mib", "80"]);
    let mut client = robot.client("control");
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let body = "n = n + 1\n".repeat(500);
    let blocks = (0..300).map(|_| sketch.block("Function", &[("Body", &body)]));
    let chain: Vec<_> = std::iter::once(start).chain(blocks).collect();
    sketch.chain(&chain);
    upload(&mut client, "large.qrs", &sketch.qrs().expect("a save"));
    upload(&mut client, "count.qrs", &counting());
    client.send("run:large.qrs");
    let told = client.until("error: large.qrs was killed");
    let why = ": perhaps it is too large for the memory of a program, 80 MiB";
    assert!(told.ends_with(why), "{told}");
    client.send("run:count.qrs");
    client.until("print: 1\n");
}
