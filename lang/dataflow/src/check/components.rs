//! Strongly connected components: blocks that lead to each other (Tarjan 1972, without recursion).
//!
//! Owns the walk. What an edge means is known to the caller.

use crate::program::NodeId;

const UNSEEN: u32 = u32::MAX;

/// The components of a graph that are cycles, as indices of nodes; nodes for which `skips` holds are not there.
pub(super) fn cycles(next: &[Vec<NodeId>], skips: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
    let count = next.len();
    let mut cycles = Vec::new();
    let (mut order, mut low) = (vec![UNSEEN; count], vec![0u32; count]);
    let (mut stack, mut on_stack) = (Vec::new(), vec![false; count]);
    let mut clock = 0;
    for root in 0..count {
        let mut calls: Vec<(usize, usize)> = Vec::new();
        if order[root] == UNSEEN && !skips(root) {
            calls.push((root, 0));
        }
        while let Some((id, at)) = calls.pop() {
            if at == 0 {
                (order[id], low[id]) = (clock, clock);
                clock += 1;
                stack.push(id);
                on_stack[id] = true;
            }
            let all = next[id].iter().enumerate().skip(at);
            let mut all = all.map(|(at, &to)| (at, to as usize));
            let open = all.find(|&(_, to)| {
                let is_open = order[to] == UNSEEN && !skips(to);
                if on_stack[to] {
                    low[id] = low[id].min(order[to]);
                }
                is_open
            });
            if let Some((at, to)) = open {
                calls.push((id, at + 1));
                calls.push((to, 0));
                continue;
            }
            if let Some(&(parent, _)) = calls.last() {
                low[parent] = low[parent].min(low[id]);
            }
            if low[id] == order[id] {
                let begin = stack.iter().rposition(|&one| one == id).unwrap_or(0);
                let component = stack.split_off(begin);
                component.iter().for_each(|&one| on_stack[one] = false);
                if component.len() > 1 || next[id].contains(&(id as NodeId)) {
                    cycles.push(component);
                }
            }
        }
    }
    cycles
}
