//! Conditions drawn with several diamonds that share a target: two nodes become one with `and` or `or`.
//!
//! Owns when that is done: only where nested branches would not do, so that a program keeps the shape of its diagram.

use super::flow::Flow;
use super::work::{Kind, Work};
use crate::limits::CONDITION_TESTS_MAX;
use crate::tree::Condition;

/// How many nodes are looked at to find out whether one reaches another.
const NODES_LOOKED_AT: usize = 256;

/// Puts nodes together as long as there are any to be put together.
pub(super) fn merge(work: &mut Work, flow: &Flow) {
    let mut before = work.before();
    let mut order: Vec<usize> = (0..work.len()).collect();
    order.sort_by_key(|&node| std::cmp::Reverse(flow.place[node]));
    for first in order {
        while let Some((second, way)) = candidate(work, flow, &before, first) {
            put_together(work, &mut before, first, second, way);
        }
    }
    work.prune();
}

/// A condition after `first` that shares a target with it, and the way of `first` that leads there.
fn candidate(
    work: &Work,
    flow: &Flow,
    before: &[Vec<usize>],
    first: usize,
) -> Option<(usize, usize)> {
    let Kind::Test(left) = &work.nodes[first].kind else {
        return None;
    };
    [0, 1].into_iter().find_map(|way| {
        let second = work.nodes[first].next[way];
        let shared = work.nodes[first].next[1 - way];
        let Kind::Test(right) = &work.nodes[second].kind else {
            return None;
        };
        let ways = &work.nodes[second].next;
        let fits = second != first
            && second != 0
            && second != shared
            && before[second] == [first]
            && ways.contains(&shared)
            && ways[0] != ways[1]
            && left.size() + right.size() <= CONDITION_TESTS_MAX;
        let other = if ways[0] == shared { ways[1] } else { ways[0] };
        (fits && !reaches(work, flow, other, shared)).then_some((second, way))
    })
}

/// Whether a node is reached from another one, the back edges into it counted, others not.
fn reaches(work: &Work, flow: &Flow, from: usize, to: usize) -> bool {
    let mut seen = vec![from];
    let mut done = 0;
    while let Some(&at) = seen.get(done) {
        done += 1;
        if at == to || done > NODES_LOOKED_AT {
            return true;
        }
        for &next in &work.nodes[at].next {
            let goes_on = next == to || flow.place[next] > flow.place[at];
            if goes_on && !seen.contains(&next) {
                seen.push(next);
            }
        }
    }
    false
}

fn put_together(
    work: &mut Work,
    before: &mut [Vec<usize>],
    first: usize,
    second: usize,
    way: usize,
) {
    let ways = work.nodes[second].next.clone();
    let shared = work.nodes[first].next[1 - way];
    let shared_at = usize::from(ways[1] == shared);
    let other = ways[1 - shared_at];
    let (Kind::Test(left), Kind::Test(right)) = (
        work.nodes[first].kind.clone(),
        work.nodes[second].kind.clone(),
    ) else {
        return;
    };
    // The first asks the second if it holds (way 0) or if not (way 1); the second goes to the shared target if not
    // (1) or if it holds (0).
    let (kind, next) = if way == 0 {
        let right = if shared_at == 1 {
            right
        } else {
            right.negated()
        };
        let both = Condition::And(Box::new(left), Box::new(right));
        (both, vec![other, shared])
    } else {
        let right = if shared_at == 0 {
            right
        } else {
            right.negated()
        };
        let one = Condition::Or(Box::new(left), Box::new(right));
        (one, vec![shared, other])
    };
    work.nodes[first].kind = Kind::Test(kind);
    work.nodes[first].next = next;
    work.nodes[second].next = vec![second, second];
    before[second].clear();
    for target in [shared, other] {
        before[target].retain(|&from| from != second && from != first);
        before[target].push(first);
    }
}
