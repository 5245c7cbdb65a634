//! The shortest way between two places by lines beside blocks, with few corners.
//!
//! Owns the search, A* by length and corners, and which of two equal ways is taken: that which was found first.

use super::{CLEAR, Place, Seen, Ways};
use crate::limits::ROUTE_STEPS_MAX;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// What a corner costs, in px.
const CORNER: u64 = 40;
/// What a piece costs that runs through words.
const WORDS: u64 = 60;

/// A crossing of two lines, by their numbers, and whether the way came there level.
type Node = (usize, usize, bool);

/// The way, from the first place to the second; none if there is none, or it takes too long to find one.
pub(super) fn search(
    ways: &mut Ways<'_>,
    near: &[usize],
    [from, to]: [Place; 2],
    beside: f64,
) -> Option<Vec<Place>> {
    let mut lines = Lines::new(ways, near, [from, to], beside);
    let start = (lines.xs.number(from.0)?, lines.ys.number(from.1)?);
    let goal = (lines.xs.number(to.0)?, lines.ys.number(to.1)?);
    let mut open = BinaryHeap::new();
    let mut best: HashMap<Node, (u64, Option<Node>)> = HashMap::new();
    let mut order = 0_u64;
    for is_level in [true, false] {
        let node = (start.0, start.1, is_level);
        best.insert(node, (0, None));
        open.push(Reverse((lines.rest(node, to), order, node)));
        order += 1;
    }
    for _ in 0..ROUTE_STEPS_MAX {
        let Reverse((_, _, node)) = open.pop()?;
        if (node.0, node.1) == goal {
            return Some(lines.way(node, &best));
        }
        let (cost, _) = best[&node];
        for next in lines.beside(node) {
            let corner = if next.2 == node.2 { 0 } else { CORNER };
            let words = match lines.look(ways, node, next) {
                Seen::Block => continue,
                Seen::Words => WORDS,
                Seen::Nothing => 0,
            };
            let all = cost + lines.long(node, next) + corner + words;
            let is_better = best.get(&next).is_none_or(|(had, _)| all < *had);
            if is_better {
                best.insert(next, (all, Some(node)));
                open.push(Reverse((all + lines.rest(next, to), order, next)));
                order += 1;
            }
        }
        if ways.looks.left == 0 {
            return None;
        }
    }
    None
}

/// Places of parallel lines, in order.
struct Row(Vec<f64>);

impl Row {
    fn new(mut all: Vec<f64>) -> Self {
        all.sort_by(f64::total_cmp);
        all.dedup();
        Self(all)
    }

    fn number(&self, place: f64) -> Option<usize> {
        self.0.binary_search_by(|one| one.total_cmp(&place)).ok()
    }
}

/// Lines on which a way may run.
struct Lines {
    xs: Row,
    ys: Row,
    /// What was seen between two crossings: to the right of one, and below it.
    seen: HashMap<Node, Seen>,
}

impl Lines {
    fn new(ways: &Ways<'_>, near: &[usize], ends: [Place; 2], beside: f64) -> Self {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for (x, y) in ends {
            xs.push(x);
            ys.push(y);
        }
        for block in near.iter().map(|index| &ways.blocks[*index]) {
            xs.extend([block.low.0 - beside, block.high.0 + beside]);
            let below = block.high.1 + beside;
            ys.extend([block.low.1 - beside, below, below + block.words]);
        }
        Self {
            xs: Row::new(xs),
            ys: Row::new(ys),
            seen: HashMap::new(),
        }
    }

    fn place(&self, node: Node) -> Place {
        (self.xs.0[node.0], self.ys.0[node.1])
    }

    fn long(&self, one: Node, other: Node) -> u64 {
        self.rest(one, self.place(other))
    }

    fn rest(&self, node: Node, to: Place) -> u64 {
        let (x, y) = self.place(node);
        ((x - to.0).abs() + (y - to.1).abs()).round() as u64
    }

    /// The crossings beside one.
    fn beside(&self, (x, y, _): Node) -> impl Iterator<Item = Node> + use<> {
        let is_there = [
            x + 1 < self.xs.0.len(),
            x > 0,
            y + 1 < self.ys.0.len(),
            y > 0,
        ];
        let all = [
            (x + 1, y, true),
            (x.wrapping_sub(1), y, true),
            (x, y + 1, false),
            (x, y.wrapping_sub(1), false),
        ];
        let both = is_there.into_iter().zip(all);
        both.filter_map(|(is_there, node)| is_there.then_some(node))
    }

    /// What is between two crossings that are beside each other.
    fn look(&mut self, ways: &mut Ways<'_>, one: Node, other: Node) -> Seen {
        let first = (one.0.min(other.0), one.1.min(other.1), other.2);
        if let Some(seen) = self.seen.get(&first) {
            return *seen;
        }
        let seen = ways.look(self.place(one), self.place(other), &|_| Some(CLEAR));
        self.seen.insert(first, seen);
        seen
    }

    /// All places to a node.
    fn way(&self, last: Node, best: &HashMap<Node, (u64, Option<Node>)>) -> Vec<Place> {
        let before = |node: &Node| best.get(node).and_then(|(_, before)| *before);
        let mut way: Vec<Place> = std::iter::successors(Some(last), before)
            .map(|node| self.place(node))
            .collect();
        way.reverse();
        way
    }
}
