//! The first instant of a program: whether more blocks react in it than one instant has room for.
//!
//! Owns what certainly happens then, without any condition: constants and actions that follow each other.

use super::found::Found;
use super::words;
use crate::limits;
use crate::program::{Flow, Node, Op, Program, Target};
use std::collections::VecDeque;

/// Where tokens certainly go on from a block to whose port one has come.
fn onward(node: &Node, port: u8) -> &[Target] {
    let out = match node.op {
        Op::Flow(Flow::Constant(_)) => node.row.port("OUT"),
        Op::Act(_) if node.row.control() == Some(port) => node.done,
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => None,
    };
    match out {
        Some(out) => &node.outs[usize::from(out)],
        None => &[],
    }
}

/// Reactions of a program without a cycle that certainly happen at its start. They are counted before they wait for their
/// turn, so what waits is never more than what there is room for.
pub(super) fn look(program: &Program, found: &mut Found) {
    let Some(main) = program.instances.first() else {
        return;
    };
    let mut waiting: VecDeque<Target> = VecDeque::new();
    let mut targets: &[Target] = &main.starts;
    let (mut count, mut looks) = (0, 0);
    loop {
        for to in targets {
            looks += 1;
            if looks > limits::INSTANT_LOOKS_MAX {
                return;
            }
            let node = program.node(to.node);
            // One that waits for several tokens may wait for ever.
            if !node.queues.is_empty() && node.data & (1 << to.port) != 0 {
                continue;
            }
            count += 1;
            if count > limits::FIRINGS_MAX {
                let place = program.place(to.node);
                found.warn(place, words::busy_instant(limits::FIRINGS_MAX));
                return;
            }
            waiting.push_back(*to);
        }
        let Some(to) = waiting.pop_front() else {
            return;
        };
        targets = onward(program.node(to.node), to.port);
    }
}
