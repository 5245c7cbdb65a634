//! New versions of a diagram that take long to read and to check.

use crate::diagrams::{counting, printed, upload};
use crate::rig::robot;
use lang_diagram::sketch::Sketch;

/// A counter with a thread of many blocks beside it, which take a while to read and to check.
fn counting_beside_many() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0; m = 0")]);
    let fork = sketch.block("Fork", &[]);
    sketch.chain(&[start, clear, fork]);
    let count = sketch.block("Function", &[("Body", "n = n + 1\nprint(n)")]);
    let wait = sketch.block("Timer", &[("Delay", "30")]);
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
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "count.qrs", &counting());
    client.send("run:count.qrs");
    while printed(&mut client) < 2 {}
    upload(&mut client, "count.qrs", &counting_beside_many());
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
