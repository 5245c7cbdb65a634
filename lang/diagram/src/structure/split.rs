//! Loops with several entries get one: the part that is entered beside the head is copied for those who enter there.
//!
//! Owns which part is copied and when it is too much. Knows no trees.

use super::work::Work;
use crate::limits::{COPIES_FREE, COPIES_PER_BLOCK};
use std::collections::{HashMap, HashSet};

/// How many entries of a loop are tried as its head.
const HEADS_TRIED: usize = 8;
/// How many loops in loops a search may take on average.
const NESTING_SEARCHED: usize = 64;

/// Makes all loops have one entry; `None` if that would take too many copies for a graph that had `whole` nodes.
pub(super) fn split(work: &mut Work, whole: usize) -> Option<()> {
    let limit = whole * COPIES_PER_BLOCK + COPIES_FREE;
    let mut sets = vec![(0..work.len()).collect::<Vec<usize>>()];
    let mut before = work.before();
    let mut search = Search::default();
    // Each set costs its size; nested loops are looked at again for each loop around.
    let mut effort = limit * NESTING_SEARCHED;
    while let Some(set) = sets.pop() {
        effort = effort.checked_sub(set.len())?;
        for part in search.circles(work, &set) {
            let inside: HashSet<usize> = part.iter().copied().collect();
            let is_entry = |&node: &usize| before[node].iter().any(|from| !inside.contains(from));
            let entries: Vec<usize> = part.iter().copied().filter(is_entry).collect();
            let head = match entries[..] {
                // What begins in a loop begins at its head.
                _ if inside.contains(&0) => 0,
                [] => part[0],
                [one] => one,
                _ => cheapest(work, &inside, &entries),
            };
            let others: Vec<usize> = entries.into_iter().filter(|&node| node != head).collect();
            if !others.is_empty() {
                let copied = behind(work, &inside, head, &others);
                if work.len() + copied.len() > limit {
                    return None;
                }
                sets.push(copy(work, &inside, &copied));
                before = work.before();
                effort = effort.checked_sub(work.len())?;
            }
            sets.push(part.into_iter().filter(|&node| node != head).collect());
        }
    }
    work.prune();
    Some(())
}

/// Tarjan's search for strongly connected parts; its tables are kept from set to set.
#[derive(Default)]
struct Search {
    /// When a node was found, 0 for those that are not in the set, 1 for those not found yet.
    index: Vec<usize>,
    low: Vec<usize>,
    on_stack: Vec<bool>,
    stack: Vec<usize>,
}

impl Search {
    /// The strongly connected parts of a set that are circles.
    fn circles(&mut self, work: &Work, set: &[usize]) -> Vec<Vec<usize>> {
        self.index.resize(work.len(), 0);
        self.low.resize(work.len(), 0);
        self.on_stack.resize(work.len(), false);
        for &node in set {
            self.index[node] = 1;
        }
        let mut found = Vec::new();
        let mut count = 1;
        for &root in set.iter() {
            if self.index[root] == 1 {
                self.from(work, root, &mut count, &mut found);
            }
        }
        for &node in set {
            self.index[node] = 0;
        }
        found
    }

    fn from(&mut self, work: &Work, root: usize, count: &mut usize, found: &mut Vec<Vec<usize>>) {
        let mut calls = Vec::new();
        self.enter(root, count, &mut calls);
        while let Some((node, way)) = calls.last_mut() {
            let node = *node;
            if let Some(&next) = work.nodes[node].next.get(*way) {
                *way += 1;
                if self.index[next] == 1 {
                    self.enter(next, count, &mut calls);
                } else if self.index[next] > 1 && self.on_stack[next] {
                    self.low[node] = self.low[node].min(self.index[next]);
                }
                continue;
            }
            calls.pop();
            if let Some((parent, _)) = calls.last() {
                self.low[*parent] = self.low[*parent].min(self.low[node]);
            }
            if self.low[node] == self.index[node] {
                let at = self.stack.iter().rposition(|&other| other == node);
                let part = self.stack.split_off(at.unwrap_or(0));
                for &other in &part {
                    self.on_stack[other] = false;
                }
                if part.len() > 1 || work.nodes[node].next.contains(&node) {
                    found.push(part);
                }
            }
        }
    }

    fn enter(&mut self, node: usize, count: &mut usize, calls: &mut Vec<(usize, usize)>) {
        *count += 1;
        self.index[node] = *count;
        self.low[node] = *count;
        self.on_stack[node] = true;
        self.stack.push(node);
        calls.push((node, 0));
    }
}

/// The entry that takes the fewest copies as a head.
fn cheapest(work: &Work, inside: &HashSet<usize>, entries: &[usize]) -> usize {
    let copies = |&&head: &&usize| {
        let others: Vec<usize> = entries
            .iter()
            .copied()
            .filter(|&node| node != head)
            .collect();
        behind(work, inside, head, &others).len()
    };
    let tried = entries.iter().take(HEADS_TRIED);
    tried.min_by_key(copies).copied().unwrap_or(entries[0])
}

/// The nodes of a circle that are reached from these entries without passing its head.
fn behind(work: &Work, inside: &HashSet<usize>, head: usize, entries: &[usize]) -> Vec<usize> {
    let mut list = entries.to_vec();
    let mut seen: HashSet<usize> = list.iter().copied().collect();
    let mut done = 0;
    while let Some(&at) = list.get(done) {
        done += 1;
        for &next in &work.nodes[at].next {
            if next != head && inside.contains(&next) && seen.insert(next) {
                list.push(next);
            }
        }
    }
    list
}

/// Copies nodes of a circle; who comes from outside goes to the copies.
fn copy(work: &mut Work, inside: &HashSet<usize>, copied: &[usize]) -> Vec<usize> {
    let old = work.len();
    let twin: HashMap<usize, usize> = copied
        .iter()
        .enumerate()
        .map(|(index, &node)| (node, old + index))
        .collect();
    let to_twins = |ways: &mut Vec<usize>| {
        for way in ways {
            *way = twin.get(way).copied().unwrap_or(*way);
        }
    };
    for &node in copied {
        let mut new = work.nodes[node].clone();
        to_twins(&mut new.next);
        work.nodes.push(new);
    }
    for node in (0..old).filter(|node| !inside.contains(node)) {
        to_twins(&mut work.nodes[node].next);
    }
    (old..work.len()).collect()
}
