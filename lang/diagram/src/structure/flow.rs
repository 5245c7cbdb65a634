//! Orders of a graph: reverse postorder, dominators, natural loops.
//!
//! Owns what is computed once for the walk. Knows no trees.

use super::work::Work;

/// Facts about a reducible graph.
pub(super) struct Flow {
    /// Place in reverse postorder.
    pub(super) place: Vec<usize>,
    /// The nearest dominator; the entry has itself.
    pub(super) dominator: Vec<usize>,
    /// Nodes whose nearest dominator this is, in reverse postorder.
    pub(super) dominated: Vec<Vec<usize>>,
    /// How many nodes it dominates, itself counted.
    pub(super) weight: Vec<usize>,
    /// How many edges come in that are not back edges.
    pub(super) arrivals: Vec<usize>,
    /// Whether it heads a loop.
    pub(super) heads: Vec<bool>,
    /// The head of the innermost loop around, for a head the loop around its own loop.
    around: Vec<Option<usize>>,
}

/// Nodes in reverse postorder.
pub(super) fn order(work: &Work) -> Vec<usize> {
    let mut seen = vec![false; work.len()];
    let mut order = Vec::with_capacity(work.len());
    let mut stack = vec![(0, 0)];
    seen[0] = true;
    while let Some((node, way)) = stack.last_mut() {
        let ways = &work.nodes[*node].next;
        // From the last way on, so that the first way stands first in reverse postorder.
        if *way < ways.len() {
            *way += 1;
            let next = ways[ways.len() - *way];
            if !seen[next] {
                seen[next] = true;
                stack.push((next, 0));
            }
        } else {
            order.push(*node);
            stack.pop();
        }
    }
    order.reverse();
    order
}

/// Nearest dominators by the iterative method of Cooper, Harvey and Kennedy.
fn dominators(before: &[Vec<usize>], order: &[usize], place: &[usize]) -> Vec<usize> {
    let mut dominator = vec![usize::MAX; place.len()];
    dominator[0] = 0;
    let mut changed = true;
    while changed {
        changed = false;
        for &node in &order[1..] {
            let mut found = usize::MAX;
            for &from in &before[node] {
                if dominator[from] == usize::MAX {
                    continue;
                }
                if found == usize::MAX {
                    found = from;
                    continue;
                }
                let (mut a, mut b) = (found, from);
                while a != b {
                    while place[a] > place[b] {
                        a = dominator[a];
                    }
                    while place[b] > place[a] {
                        b = dominator[b];
                    }
                }
                found = a;
            }
            if dominator[node] != found {
                dominator[node] = found;
                changed = true;
            }
        }
    }
    dominator
}

impl Flow {
    /// All facts; `None` if a loop has two entries.
    pub(super) fn new(work: &Work) -> Option<Self> {
        let order = order(work);
        let mut place = vec![0; work.len()];
        for (index, &node) in order.iter().enumerate() {
            place[node] = index;
        }
        let before = work.before();
        let dominator = dominators(&before, &order, &place);
        let mut dominated = vec![Vec::new(); work.len()];
        for &node in &order[1..] {
            dominated[dominator[node]].push(node);
        }
        let mut weight = vec![1; work.len()];
        for &node in order[1..].iter().rev() {
            weight[dominator[node]] += weight[node];
        }
        let mut flow = Self {
            place,
            dominator,
            dominated,
            weight,
            arrivals: vec![0; work.len()],
            heads: vec![false; work.len()],
            around: vec![None; work.len()],
        };
        let spans = flow.spans(&order);
        let mut tails = vec![Vec::new(); work.len()];
        for (node, from) in before.iter().enumerate() {
            for &from in from {
                if flow.place[from] < flow.place[node] {
                    flow.arrivals[node] += 1;
                } else if spans[node].0 <= spans[from].0 && spans[from].0 < spans[node].1 {
                    flow.heads[node] = true;
                    tails[node].push(from);
                } else {
                    return None;
                }
            }
        }
        flow.loops(&order, &before, &tails);
        Some(flow)
    }

    /// For each node the range that its subtree of dominators has in a walk of that tree.
    fn spans(&self, order: &[usize]) -> Vec<(usize, usize)> {
        let mut spans = vec![(0, 0); order.len()];
        let mut next = vec![0; order.len()];
        // Children take ranges one after the other in the range of their parent.
        for &node in order {
            let start = if node == order[0] {
                0
            } else {
                let parent = self.dominator[node];
                let start = spans[parent].0 + 1 + next[parent];
                next[parent] += self.weight[node];
                start
            };
            spans[node] = (start, start + self.weight[node]);
        }
        spans
    }

    /// Who is in which loop: inner loops first, each found backwards from its tails.
    fn loops(&mut self, order: &[usize], before: &[Vec<usize>], tails: &[Vec<usize>]) {
        // The outermost loop found so far that a node is in, to leap over inner loops.
        let mut outermost: Vec<usize> = (0..order.len()).collect();
        for &head in order.iter().rev().filter(|&&node| self.heads[node]) {
            let mut stack = tails[head].clone();
            while let Some(node) = stack.pop() {
                let mut top = node;
                while outermost[top] != top {
                    outermost[top] = outermost[outermost[top]];
                    top = outermost[top];
                }
                if top == head {
                    continue;
                }
                outermost[top] = head;
                self.around[top] = Some(head);
                stack.extend(before[top].iter().copied());
            }
        }
    }

    /// The head of the innermost loop that a node is in; a head is in its own.
    pub(super) fn innermost(&self, node: usize) -> Option<usize> {
        if self.heads[node] {
            Some(node)
        } else {
            self.around[node]
        }
    }

    /// Whether a node is in the loop of a head.
    pub(super) fn is_in(&self, node: usize, head: usize) -> bool {
        let mut at = self.innermost(node);
        while let Some(known) = at {
            if known == head {
                return true;
            }
            at = self.around[known];
        }
        false
    }

    /// Where the two or more ways of a node meet again in the loop that it is in: what would cost most to be written
    /// twice.
    pub(super) fn join(&self, node: usize) -> Option<usize> {
        let inside = self.innermost(node);
        let cost = |&&other: &&usize| (self.arrivals[other] - 1) * self.weight[other];
        let joins = self.dominated[node]
            .iter()
            .filter(|&&other| self.is_join(other, inside));
        joins.max_by_key(cost).copied()
    }

    /// Whether several ways meet in a node, in this loop.
    pub(super) fn is_join(&self, node: usize, inside: Option<usize>) -> bool {
        self.arrivals[node] > 1 && inside.is_none_or(|head| self.is_in(node, head))
    }
}
