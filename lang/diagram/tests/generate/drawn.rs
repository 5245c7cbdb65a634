//! Projects drawn here for what the real ones do not have: crossing arrows, threads, parameters, odd arithmetic.

use lang_diagram::project::Project;
use lang_diagram::sketch::{Sketch, Spot};

fn text(sketch: &mut Sketch, body: &str) -> Spot {
    sketch.block("Function", &[("Body", body)])
}

fn when(sketch: &mut Sketch, condition: &str) -> Spot {
    sketch.block("IfBlock", &[("Condition", condition)])
}

/// All of them with names.
pub fn projects() -> Vec<(String, Project)> {
    let all = [
        ("expressions", expressions()),
        ("shared target", shared_target()),
        ("two entries", two_entries()),
        ("left half way", left_half_way()),
        ("parameters", parameters()),
        ("threads", threads()),
        ("guards", guards()),
        ("killed main", killed_main()),
        ("killed itself", killed_itself()),
    ];
    all.map(|(name, project)| (name.to_owned(), project)).into()
}

/// The first thread is killed while it waits; what kills it goes on.
fn killed_main() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let fork = sketch.block("Fork", &[]);
    let long = sketch.block("Timer", &[("Delay", "1000")]);
    let never = text(&mut sketch, "print('never')");
    let end = sketch.block("FinalNode", &[]);
    let short = sketch.block("Timer", &[("Delay", "200")]);
    let kill = sketch.block("KillThread", &[("Thread", "main")]);
    let after = text(&mut sketch, "print('after')");
    let done = sketch.block("FinalNode", &[]);
    sketch.link(start, fork);
    sketch.guarded(fork, long, "main");
    sketch.guarded(fork, short, "other");
    sketch.chain(&[long, never, end]);
    sketch.chain(&[short, kill, after, done]);
    sketch.project()
}

/// The only thread kills itself between two texts.
fn killed_itself() -> Project {
    let mut sketch = Sketch::new();
    let blocks = [
        sketch.block("InitialNode", &[]),
        text(&mut sketch, "print('before')"),
        sketch.block("KillThread", &[("Thread", "main")]),
        text(&mut sketch, "print('never')"),
        sketch.block("FinalNode", &[]),
    ];
    sketch.chain(&blocks);
    sketch.project()
}

fn chain(bodies: &[&str]) -> Project {
    let mut sketch = Sketch::new();
    let mut blocks = vec![sketch.block("InitialNode", &[])];
    for body in bodies {
        blocks.push(text(&mut sketch, body));
    }
    blocks.push(sketch.block("FinalNode", &[]));
    sketch.chain(&blocks);
    sketch.project()
}

/// Results of operators, as the console shows them.
fn expressions() -> Project {
    chain(&[
        "print(7/2); print(7//2); print(-7//2); print(-7%2); print(7%3)",
        "print(2^3^2); print(-2^2); print(1234*1000); print(1 << 40); print(5 >> 1)",
        "print(3==3.0); print(\"3\"==3); print(\"a\"<\"b\"); print(\"2\"<\"10\")",
        "print(0.4 and 1); print(\"abc\" and true); print(not 0); print(not 1==2)",
        "print(1 .. 2); print(1+2 .. 3*4); print(~5); print(5 ~ 3); print(0x1F)",
        "a = {1,2,3}; print(a[0]); a[1] = 2.5; print(a[1]); b = a; b[0] = 7; print(a[0]); print(b[0])",
        "x = 1; x = 2.5; print(x); y = -x; print(y); z = -0.1; print(z); w = -z; print(w)",
        "i = 5; j = -i; k = i // 2 + j % 3; print(k); print(i / j); print((i + j) / 4)",
        "f = 0.5; print(f + f); print(f * 3); print(max(i, f)); print(abs(j)); print(floor(2.7) .. ceil(2.1))",
        "t = \"line\"; u = t .. \" \" .. i .. f; print(u); print(t == \"line\"); print(t == u)",
        "n = 0; n = n + 1; n = n * 10 - 3; print(n); print(n > 5 and n < 9); print(n == 7 or t == u)",
    ])
}

/// An `or` of two diamonds in an endless loop with an exit.
fn shared_target() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let begin = text(&mut sketch, "n = 0");
    let next = text(&mut sketch, "n = n + 1");
    let small = when(&mut sketch, "n < 3");
    let even = when(&mut sketch, "n % 2 == 0");
    let shared = text(&mut sketch, "print('shared ' .. n)");
    let other = text(&mut sketch, "print('other ' .. n)");
    let enough = when(&mut sketch, "n > 9");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, begin, next, small]);
    sketch.guarded(small, shared, "true");
    sketch.guarded(small, even, "false");
    sketch.guarded(even, shared, "true");
    sketch.guarded(even, other, "false");
    sketch.link(shared, enough);
    sketch.link(other, enough);
    sketch.guarded(enough, end, "true");
    sketch.guarded(enough, next, "false");
    sketch.project()
}

fn two_entries() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let begin = text(&mut sketch, "n = 1");
    let which = when(&mut sketch, "n == 0");
    let first = text(&mut sketch, "print('first ' .. n)");
    let second = text(&mut sketch, "n = n + 1; print('second ' .. n)");
    let more = when(&mut sketch, "n < 5");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, begin, which]);
    sketch.guarded(which, first, "true");
    sketch.guarded(which, second, "false");
    sketch.link(first, second);
    sketch.link(second, more);
    sketch.guarded(more, first, "true");
    sketch.guarded(more, end, "false");
    sketch.project()
}

/// A counter that is half way when the loop is entered again.
fn left_half_way() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let begin = text(&mut sketch, "n = 0; m = 0");
    let repeat = sketch.block("Loop", &[("Iterations", "2.5")]);
    let body = text(&mut sketch, "n = n + 1; print('round ' .. n)");
    let leave = when(&mut sketch, "n == 1");
    let left = text(&mut sketch, "m = m + 1; print('left ' .. m)");
    let done = when(&mut sketch, "m >= 2");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, begin, repeat]);
    sketch.guarded(repeat, body, "iteration");
    sketch.link(repeat, left);
    sketch.link(body, leave);
    sketch.guarded(leave, left, "true");
    sketch.guarded(leave, repeat, "false");
    sketch.link(left, done);
    sketch.guarded(done, end, "true");
    sketch.guarded(done, repeat, "false");
    sketch.project()
}

/// A parameter that another subprogram sees while the first one runs.
fn parameters() -> Project {
    let mut sketch = Sketch::new();
    let inner = sketch.subprogram("inner", &[]);
    let outer = sketch.subprogram("outer", &[("p", "int", "1"), ("q", "float", "1")]);
    let alone = sketch.subprogram("alone", &[("only", "int", "1")]);
    sketch.draw_on(inner);
    let blocks = [
        sketch.block("InitialNode", &[]),
        text(&mut sketch, "print('inner ' .. p); p = p + 1"),
        sketch.block("FinalNode", &[]),
    ];
    sketch.chain(&blocks);
    sketch.draw_on(outer);
    let blocks = [
        sketch.block("InitialNode", &[]),
        sketch.call(inner, &[]),
        text(&mut sketch, "print('outer ' .. p .. ' ' .. q)"),
        sketch.block("FinalNode", &[]),
    ];
    sketch.chain(&blocks);
    sketch.draw_on(alone);
    let blocks = [
        sketch.block("InitialNode", &[]),
        text(&mut sketch, "only = only * 2; print('alone ' .. only)"),
        sketch.block("FinalNode", &[]),
    ];
    sketch.chain(&blocks);
    let main = sketch.main();
    sketch.draw_on(main);
    let blocks = [
        sketch.block("InitialNode", &[]),
        text(&mut sketch, "p = 100; q = 0.5"),
        sketch.call(outer, &["p // 7", "q / 2"]),
        sketch.call(alone, &["p + 2.5"]),
        text(&mut sketch, "print('main ' .. p .. ' ' .. q)"),
        sketch.block("FinalNode", &[]),
    ];
    sketch.chain(&blocks);
    sketch.project()
}

/// Two threads that meet, and a message between them.
fn threads() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let fork = sketch.block("Fork", &[]);
    let send = sketch.block(
        "SendMessageThreads",
        &[("Thread", "main"), ("Message", "'42'")],
    );
    let slow = sketch.block("Timer", &[("Delay", "300")]);
    let red = sketch.block("TrikLed", &[("Color", "red")]);
    let wait = sketch.block("ReceiveMessageThreads", &[("Variable", "got")]);
    let show = text(&mut sketch, "print('got ' .. got)");
    let join = sketch.block("Join", &[]);
    let last = sketch.block("TrikLed", &[("Color", "off")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, fork]);
    sketch.guarded(fork, slow, "helper");
    sketch.guarded(fork, wait, "main");
    sketch.chain(&[slow, send, red, join]);
    sketch.chain(&[wait, show, join]);
    sketch.guarded(join, last, "main");
    sketch.link(last, end);
    sketch.project()
}

fn guards() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let begin = text(&mut sketch, "n = 0; t = 'A'");
    let next = text(&mut sketch, "n = n + 1");
    let switch = sketch.block("SwitchBlock", &[("Expression", "n")]);
    let one = text(&mut sketch, "print('one')");
    let two = text(&mut sketch, "print('two or three')");
    let other = sketch.block("SwitchBlock", &[("Expression", "t")]);
    let never = text(&mut sketch, "print('never')");
    let default = text(&mut sketch, "print('default ' .. n)");
    let more = sketch.block("PreconditionalLoop", &[("Condition", "n < 5")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, begin, more]);
    sketch.guarded(more, next, "iteration");
    sketch.link(more, end);
    sketch.link(next, switch);
    sketch.guarded(switch, one, "1");
    sketch.guarded(switch, two, "2");
    sketch.link(switch, other);
    sketch.guarded(other, never, "A");
    sketch.link(other, default);
    for block in [one, two, never, default] {
        sketch.link(block, more);
    }
    sketch.project()
}
