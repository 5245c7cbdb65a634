//! What follows a loop.
//!
//! Owns the choice among the places that a loop is left to: the others are written inside of it, before a break.

use super::flow::Flow;
use super::work::{Kind, Work};

/// What writing a place twice may cost before it is put after the loop rather than what comes next anyway.
const COST_OF_COPIES: usize = 8;

/// Where a loop is left to.
struct Exits {
    /// Each target once, in the order found.
    targets: Vec<usize>,
    /// Places outside that several ways out of the loop meet in and only they lead to.
    joins: Vec<usize>,
}

fn exits(work: &Work, flow: &Flow, head: usize) -> Exits {
    let mut members = vec![head];
    let mut found = Exits {
        targets: Vec::new(),
        joins: Vec::new(),
    };
    let mut done = 0;
    while let Some(&node) = members.get(done) {
        done += 1;
        for &next in &work.nodes[node].next {
            if !flow.is_in(next, head) && !found.targets.contains(&next) {
                found.targets.push(next);
            }
        }
        for &other in &flow.dominated[node] {
            if flow.is_in(other, head) {
                members.push(other);
            } else if flow.arrivals[other] > 1 {
                found.joins.push(other);
            }
        }
    }
    found.joins.sort_by_key(|&node| flow.place[node]);
    found
}

/// Places that are not written with the loop and that it, or what only it leads to, leads to.
fn frontier(work: &Work, flow: &Flow, head: usize, targets: &[usize]) -> Vec<usize> {
    let is_own = |node: usize| {
        let mut at = node;
        while flow.place[at] > flow.place[head] {
            at = flow.dominator[at];
        }
        at == head
    };
    let mut own = Vec::new();
    let mut found = Vec::new();
    let mut seen = vec![false; work.len()];
    for &target in targets {
        let list = if is_own(target) { &mut own } else { &mut found };
        seen[target] = true;
        list.push(target);
    }
    let mut done = 0;
    while let Some(&node) = own.get(done) {
        done += 1;
        for &next in &work.nodes[node].next {
            if !seen[next] && !flow.is_in(next, head) {
                seen[next] = true;
                if is_own(next) {
                    own.push(next);
                } else {
                    found.push(next);
                }
            }
        }
    }
    found
}

/// The place after a loop that comes before `next`.
pub(super) fn follow(work: &Work, flow: &Flow, head: usize, next: Option<usize>) -> Option<usize> {
    let exits = exits(work, flow, head);
    if exits.targets.len() <= 1 {
        return exits.targets.first().copied();
    }
    let cost = |&&node: &&usize| (flow.arrivals[node] - 1) * flow.weight[node];
    let best = exits.joins.iter().max_by_key(cost);
    let frontier = frontier(work, flow, head, &exits.targets);
    let is_dear = best.is_some_and(|node| cost(&node) > COST_OF_COPIES);
    if let Some(next) = next.filter(|next| frontier.contains(next) && !is_dear) {
        return Some(next);
    }
    if let Some(&best) = best {
        return Some(best);
    }
    if let Some(&other) = frontier.iter().min_by_key(|&&node| flow.place[node]) {
        return Some(other);
    }
    let is_end = |node: usize| matches!(work.nodes[node].kind, Kind::End(_));
    let targets = exits.targets.iter().copied();
    targets.max_by_key(|&node| (!is_end(node), flow.weight[node]))
}

/// All places after a loop that several ways out meet in, first to last: for languages that can jump.
pub(super) fn all(work: &Work, flow: &Flow, head: usize) -> Vec<usize> {
    exits(work, flow, head).joins
}
