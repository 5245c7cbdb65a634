//! Random programs that use all that can interleave: threads, messages, calls, loops, waits, turns.

use crate::project::Project;
use crate::sketch::{DiagramId, Sketch, Spot};
use needs::Random;

/// Choices from a seed.
pub struct Dice(Random);

impl Dice {
    pub fn new(seed: u32) -> Self {
        Self(Random::new(seed))
    }

    pub fn below(&mut self, count: u32) -> u32 {
        self.0.bits() % count
    }

    fn of<'a>(&mut self, texts: &[&'a str]) -> &'a str {
        texts[self.below(texts.len() as u32) as usize]
    }
}

/// A program that mostly works.
pub fn project(dice: &mut Dice) -> Project {
    let mut sketch = Sketch::new();
    let sub = sketch.subprogram("sub", &[]);
    sketch.draw_on(sub);
    body(&mut sketch, dice, 2, sub, false);
    let main = sketch.main();
    sketch.draw_on(main);
    body(&mut sketch, dice, 3, sub, true);
    sketch.project()
}

fn body(sketch: &mut Sketch, dice: &mut Dice, depth: u32, sub: DiagramId, is_main: bool) {
    let start = sketch.block("InitialNode", &[]);
    let set = match is_main {
        true => sketch.block("Function", &[("Body", "x = 1; y = 2")]),
        false => sketch.block("Function", &[("Body", "y = y + 1")]),
    };
    sketch.link(start, set);
    let last = statements(sketch, dice, (set, ""), depth, sub);
    let end = sketch.block("FinalNode", &[]);
    match dice.below(3) {
        0 if is_main => join(sketch, last, set),
        _ => join(sketch, last, end),
    }
}

/// Where the flow is: a block, and the guard of its next link.
type Open<'a> = (Spot, &'a str);

fn join(sketch: &mut Sketch, (from, guard): Open<'_>, to: Spot) {
    sketch.guarded(from, to, guard);
}

fn statements<'a>(
    sketch: &mut Sketch,
    dice: &mut Dice,
    mut open: Open<'a>,
    depth: u32,
    sub: DiagramId,
) -> Open<'a> {
    for _ in 0..=dice.below(4) {
        open = statement(sketch, dice, open, depth, sub);
    }
    open
}

fn statement<'a>(
    sketch: &mut Sketch,
    dice: &mut Dice,
    open: Open<'a>,
    depth: u32,
    sub: DiagramId,
) -> Open<'a> {
    let choice = dice.below(if depth > 0 { 16 } else { 11 });
    let (kind, properties): (&str, Vec<(&str, &str)>) = match choice {
        0 | 1 => {
            let texts = [
                "x = x + 1",
                "y = x * 2",
                "x = x - y",
                "z = 5 / x",
                "x = time()",
            ];
            ("Function", vec![("Body", dice.of(&texts))])
        }
        2 | 3 => (
            "Timer",
            vec![("Delay", dice.of(&["10", "x", "35", "0", "60"]))],
        ),
        4 => (
            "TrikV6EnginesForward",
            vec![("Power", dice.of(&["x", "50", "y"]))],
        ),
        5 => ("TrikV62ClearEncoder", vec![]),
        6 => (
            "TrikV62WaitForEncoder",
            vec![("TachoLimit", dice.of(&["-1", "30"]))],
        ),
        7 => {
            let to = dice.of(&["main", "a", "b"]);
            (
                "SendMessageThreads",
                vec![("Thread", to), ("Message", dice.of(&["x", "7"]))],
            )
        }
        8 => {
            let wait = dice.of(&["true", "false"]);
            (
                "ReceiveMessageThreads",
                vec![("Variable", "y"), ("Synchronized", wait)],
            )
        }
        9 => ("TrikSay", vec![("Text", "x"), ("Evaluate", "true")]),
        10 => ("TrikV62WaitGamepadConnect", vec![]),
        _ => return nested(sketch, dice, open, depth - 1, sub),
    };
    let block = sketch.block(kind, &properties);
    join(sketch, open, block);
    (block, "")
}

fn nested<'a>(
    sketch: &mut Sketch,
    dice: &mut Dice,
    open: Open<'a>,
    depth: u32,
    sub: DiagramId,
) -> Open<'a> {
    match dice.below(4) {
        0 => {
            let test = sketch.block("IfBlock", &[("Condition", dice.of(&["x > y", "x < 9"]))]);
            join(sketch, open, test);
            let yes = statements(sketch, dice, (test, "true"), depth, sub);
            let after = sketch.block("FiBlock", &[]);
            join(sketch, yes, after);
            sketch.guarded(test, after, "false");
            (after, "")
        }
        1 => {
            let rounds = dice.of(&["2", "x", "150"]);
            let head = sketch.block("Loop", &[("Iterations", rounds)]);
            join(sketch, open, head);
            let inside = statements(sketch, dice, (head, "iteration"), depth, sub);
            join(sketch, inside, head);
            (head, "")
        }
        2 => {
            let call = sketch.call(sub, &[]);
            join(sketch, open, call);
            (call, "")
        }
        _ => {
            let fork = sketch.block("Fork", &[]);
            join(sketch, open, fork);
            let other = dice.of(&["a", "b", ""]);
            let one = statements(sketch, dice, (fork, "main"), depth, sub);
            let two = statements(sketch, dice, (fork, other), depth, sub);
            let both = sketch.block("Join", &[]);
            join(sketch, one, both);
            join(sketch, two, both);
            (both, "main")
        }
    }
}
