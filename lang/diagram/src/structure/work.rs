//! The graph that the analysis changes: reachable nodes only, conditions of several blocks, copies.
//!
//! Owns nodes and their ways. Knows no order and no loops.

use super::{Exit, Graph};
use crate::tree::Condition;

/// What a node is.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// The end at this block.
    End(usize),
    /// This block.
    Step(usize),
    /// A condition over blocks.
    Test(Condition),
    /// This block.
    Switch(usize),
}

/// One node.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) kind: Kind,
    pub(super) next: Vec<usize>,
}

/// The nodes; the first one is the entry.
#[derive(Clone, Debug)]
pub(super) struct Work {
    pub(super) nodes: Vec<Node>,
}

/// Places that ways lead to, in their order, each with the numbers of its ways: ways to one place share a branch.
pub(super) fn shared(ways: &[usize]) -> Vec<(usize, Vec<usize>)> {
    let mut places: Vec<(usize, Vec<usize>)> = Vec::new();
    for (number, &way) in ways.iter().enumerate() {
        match places.iter_mut().find(|(place, _)| *place == way) {
            Some((_, numbers)) => numbers.push(number),
            None => places.push((way, vec![number])),
        }
    }
    places
}

/// The ways of a block that exist.
pub(super) fn ways(graph: &Graph, block: usize) -> &[usize] {
    match &graph.ways[block] {
        Exit::End => &[],
        Exit::Step(next) => std::slice::from_ref(next),
        Exit::Test(..) => &[],
        Exit::Switch(all) => all,
    }
}

impl Work {
    /// What is reachable, in the order in which it is found; `None` without an entry. A way out of the graph leads to
    /// an end of its own.
    pub(super) fn new(graph: &Graph) -> Option<Self> {
        graph.ways.get(graph.entry)?;
        let mut number = vec![usize::MAX; graph.ways.len()];
        let mut order = vec![graph.entry];
        number[graph.entry] = 0;
        let mut nodes = Vec::new();
        let mut done = 0;
        let mut lost = false;
        while let Some(&block) = order.get(done) {
            done += 1;
            let pair;
            let (kind, ways) = match &graph.ways[block] {
                Exit::Test(yes, no) => {
                    pair = [*yes, *no];
                    (Kind::Test(Condition::Test(block)), &pair[..])
                }
                Exit::End => (Kind::End(block), ways(graph, block)),
                Exit::Step(_) => (Kind::Step(block), ways(graph, block)),
                Exit::Switch(_) => (Kind::Switch(block), ways(graph, block)),
            };
            let mut next = Vec::with_capacity(ways.len());
            for &way in ways {
                match number.get(way) {
                    None => {
                        lost = true;
                        next.push(usize::MAX);
                    }
                    Some(&usize::MAX) => {
                        number[way] = order.len();
                        next.push(order.len());
                        order.push(way);
                    }
                    Some(&known) => next.push(known),
                }
            }
            nodes.push(Node { kind, next });
        }
        if lost {
            let end = nodes.len();
            for node in &mut nodes {
                for way in &mut node.next {
                    if *way == usize::MAX {
                        *way = end;
                    }
                }
            }
            nodes.push(Node {
                kind: Kind::End(graph.ways.len()),
                next: Vec::new(),
            });
        }
        Some(Self { nodes })
    }

    /// How many nodes.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// For each node those that lead to it, each as often as it does.
    pub(super) fn before(&self) -> Vec<Vec<usize>> {
        let mut before = vec![Vec::new(); self.len()];
        for (number, node) in self.nodes.iter().enumerate() {
            for &next in &node.next {
                before[next].push(number);
            }
        }
        before
    }

    /// Leaves out what is no longer reached.
    pub(super) fn prune(&mut self) {
        let mut number = vec![usize::MAX; self.len()];
        let mut order = vec![0];
        number[0] = 0;
        let mut done = 0;
        while let Some(&at) = order.get(done) {
            done += 1;
            for &next in &self.nodes[at].next {
                if number[next] == usize::MAX {
                    number[next] = order.len();
                    order.push(next);
                }
            }
        }
        let take = |&old: &usize| Node {
            kind: self.nodes[old].kind.clone(),
            next: self.nodes[old]
                .next
                .iter()
                .map(|&way| number[way])
                .collect(),
        };
        self.nodes = order.iter().map(take).collect();
    }
}
