//! The walk along dominators that writes the program.
//!
//! Owns loops, joins, and how a jump is said. A node is written where it is reached; a join is written behind the
//! branches that meet there, and a jump that is no fall-through is a break, a continue, a goto, or the node once more.

use super::flow::Flow;
use super::work::{Kind, Work, shared};
use super::{Jumps, follow};
use crate::limits::{COPIES_FREE, COPIES_PER_BLOCK, LOOPS_NESTING_MAX, NESTING_MAX};
use crate::tree::{Condition, Tree, leave};

/// A loop around the place that is written.
struct Around {
    head: usize,
    label: usize,
    follow: Option<usize>,
    /// Its follower and other places after it, when it has been closed.
    behind: Vec<usize>,
    /// Where it is left to, other than to its follower: the variable has the place in this list, from 1.
    exits: Vec<usize>,
    variable: Option<usize>,
    /// Whether there is a goto to its head.
    needs_label: bool,
}

struct Emitter<'a> {
    work: &'a Work,
    flow: &'a Flow,
    jumps: Jumps,
    loops: Vec<Around>,
    /// Joins that will be written, and how many loops are around them.
    pending: Vec<(usize, usize)>,
    /// Joins that a goto leads to.
    targets: Vec<usize>,
    labels: usize,
    variables: usize,
    depth: usize,
    budget: usize,
}

/// Statements of a reducible graph and how many variables they use; `None` if they would be too many or too deep.
pub(super) fn emit(work: &Work, flow: &Flow, jumps: Jumps) -> Option<(Vec<Tree>, usize)> {
    let mut emitter = Emitter {
        work,
        flow,
        jumps,
        loops: Vec::new(),
        pending: Vec::new(),
        targets: Vec::new(),
        labels: 0,
        variables: 0,
        depth: 0,
        budget: work.len() * COPIES_PER_BLOCK + COPIES_FREE,
    };
    let body = emitter.list(Some(0), None)?;
    Some((body, emitter.variables))
}

impl Emitter<'_> {
    /// What is done from a node on until `next` is reached.
    fn list(&mut self, at: Option<usize>, next: Option<usize>) -> Option<Vec<Tree>> {
        self.depth += 1;
        if self.depth > NESTING_MAX {
            return None;
        }
        let mut out = Vec::new();
        let mut at = at;
        while let Some(node) = at {
            if at == next {
                break;
            }
            if let Some(jump) = self.jump(node) {
                out.extend(jump);
                break;
            }
            if self.targets.contains(&node) && self.jumps == Jumps::Goto {
                self.targets.retain(|&other| other != node);
                out.push(Tree::Label(node));
            }
            let is_open = self.loops.iter().any(|around| around.head == node);
            at = if self.flow.heads[node] && !is_open {
                self.looped(node, next, &mut out)?
            } else {
                self.place(node, next, &mut out)?
            };
        }
        self.depth -= 1;
        Some(out)
    }

    /// How to get to a node that is not written here; `None` if it is.
    fn jump(&mut self, node: usize) -> Option<Vec<Tree>> {
        let Some(innermost) = self.loops.len().checked_sub(1) else {
            return self.goto(node);
        };
        let here = &self.loops[innermost];
        if here.head == node {
            return Some(vec![Tree::Continue(here.label)]);
        }
        if here.follow == Some(node) {
            return Some(vec![Tree::Break(here.label)]);
        }
        if let Some(jump) = self.goto(node) {
            return Some(jump);
        }
        let is_outer = self.loops[..innermost]
            .iter()
            .any(|around| around.head == node || around.follow == Some(node));
        let is_behind = self
            .pending
            .iter()
            .any(|&(join, loops)| join == node && loops <= innermost);
        if !is_outer && !is_behind {
            return None;
        }
        if let Kind::End(block) = self.work.nodes[node].kind {
            return Some(vec![Tree::End(block)]);
        }
        if self.jumps == Jumps::Labelled {
            for around in &self.loops {
                if around.head == node {
                    return Some(vec![Tree::Continue(around.label)]);
                }
                if around.follow == Some(node) {
                    return Some(vec![Tree::Break(around.label)]);
                }
            }
        }
        // Out of this loop with a note where to go on.
        let variables = &mut self.variables;
        let here = &mut self.loops[innermost];
        let variable = *here.variable.get_or_insert_with(|| {
            *variables += 1;
            *variables - 1
        });
        let known = here.exits.iter().position(|&exit| exit == node);
        let value = known.unwrap_or_else(|| {
            here.exits.push(node);
            here.exits.len() - 1
        }) + 1;
        let label = here.label;
        Some(vec![Tree::Set { variable, value }, Tree::Break(label)])
    }

    fn goto(&mut self, node: usize) -> Option<Vec<Tree>> {
        if self.jumps != Jumps::Goto || matches!(self.work.nodes[node].kind, Kind::End(_)) {
            return None;
        }
        if let Some(around) = self.loops.iter_mut().find(|around| around.head == node) {
            around.needs_label = true;
            return Some(vec![Tree::Goto(node)]);
        }
        let is_follow = self.loops.iter().any(|around| around.follow == Some(node));
        if is_follow || self.pending.iter().any(|&(join, _)| join == node) {
            if !self.targets.contains(&node) {
                self.targets.push(node);
            }
            return Some(vec![Tree::Goto(node)]);
        }
        None
    }

    /// Writes a loop; gives what follows it.
    fn looped(
        &mut self,
        head: usize,
        next: Option<usize>,
        out: &mut Vec<Tree>,
    ) -> Option<Option<usize>> {
        if self.loops.len() >= LOOPS_NESTING_MAX {
            return None;
        }
        let behind = if self.jumps == Jumps::Goto {
            follow::all(self.work, self.flow, head)
        } else {
            Vec::new()
        };
        let chosen = follow::follow(self.work, self.flow, head, next);
        let behind = if behind.is_empty() {
            Vec::from_iter(chosen)
        } else {
            behind
        };
        let follow = behind.first().copied();
        let pending = self.pending.len();
        for &place in behind.iter().skip(1).rev() {
            self.pending.push((place, self.loops.len()));
        }
        let label = self.labels;
        self.labels += 1;
        self.loops.push(Around {
            head,
            label,
            follow,
            behind,
            exits: Vec::new(),
            variable: None,
            needs_label: false,
        });
        let body = self.body(head)?;
        let around = self.loops.pop()?;
        let body = if around.needs_label {
            let mut whole = vec![Tree::Label(head)];
            whole.extend(body);
            whole
        } else {
            body
        };
        let written = Tree::Loop { label, body };
        let Some(variable) = around.variable else {
            out.push(written);
            return self.rest(&around.behind, pending, next, out);
        };
        out.push(Tree::Set { variable, value: 0 });
        out.push(written);
        let mut arms = Vec::new();
        for (index, &exit) in around.exits.iter().enumerate() {
            arms.push((index + 1, self.list(Some(exit), next)?));
        }
        if arms.iter().all(|(_, arm)| leave(arm)) {
            out.push(Tree::Choice { variable, arms });
            return Some(around.follow);
        }
        arms.push((0, self.list(around.follow, next)?));
        out.push(Tree::Choice { variable, arms });
        Some(None)
    }

    /// The body of a loop that has just been opened: its head is written, not jumped to.
    fn body(&mut self, head: usize) -> Option<Vec<Tree>> {
        self.depth += 1;
        if self.depth > NESTING_MAX {
            return None;
        }
        let mut out = Vec::new();
        let after = self.place(head, Some(head), &mut out)?;
        out.extend(self.list(after, Some(head))?);
        self.depth -= 1;
        Some(out)
    }

    /// Writes joins one after the other, each falling into the next; gives the last one, after which the caller goes on.
    fn rest(
        &mut self,
        places: &[usize],
        pending: usize,
        next: Option<usize>,
        out: &mut Vec<Tree>,
    ) -> Option<Option<usize>> {
        let Some((last, first)) = places.split_last() else {
            return Some(next);
        };
        for (&place, &behind) in first.iter().zip(&places[1..]) {
            // It is written now: no longer a place to jump to.
            let at = self.pending.iter().rposition(|&(join, _)| join == place);
            if let Some(at) = at.filter(|&at| at >= pending) {
                self.pending.remove(at);
            }
            out.extend(self.list(Some(place), Some(behind))?);
        }
        self.pending.truncate(pending);
        Some(Some(*last))
    }

    /// Writes one node and its branches; gives what follows it.
    fn place(
        &mut self,
        node: usize,
        next: Option<usize>,
        out: &mut Vec<Tree>,
    ) -> Option<Option<usize>> {
        self.budget = self.budget.checked_sub(1)?;
        let ways = &self.work.nodes[node].next;
        match &self.work.nodes[node].kind {
            Kind::End(block) => {
                out.push(Tree::End(*block));
                Some(None)
            }
            Kind::Step(block) => {
                out.push(Tree::Step(*block));
                Some(ways.first().copied())
            }
            Kind::Test(when) if ways[0] == ways[1] => {
                out.push(Tree::If {
                    when: when.clone(),
                    yes: Vec::new(),
                    no: Vec::new(),
                });
                Some(Some(ways[0]))
            }
            Kind::Test(when) => self.test(node, when, next, out),
            Kind::Switch(block) => self.switch(node, *block, next, out),
        }
    }

    /// Where the ways of a node meet, first to last.
    fn joins(&self, node: usize) -> Vec<usize> {
        if self.jumps == Jumps::Goto {
            let inside = self.flow.innermost(node);
            let all = self.flow.dominated[node].iter().copied();
            all.filter(|&other| self.flow.is_join(other, inside))
                .collect()
        } else {
            Vec::from_iter(self.flow.join(node))
        }
    }

    fn test(
        &mut self,
        node: usize,
        when: &Condition,
        next: Option<usize>,
        out: &mut Vec<Tree>,
    ) -> Option<Option<usize>> {
        let ways = &self.work.nodes[node].next;
        let (yes, no) = (ways[0], ways[1]);
        let joins = self.joins(node);
        if let Some(&join) = joins.first() {
            let pending = self.wait_for(&joins);
            let yes = self.list(Some(yes), Some(join))?;
            let no = self.list(Some(no), Some(join))?;
            out.push(Tree::If {
                when: when.clone(),
                yes,
                no,
            });
            return self.rest(&joins, pending, next, out);
        }
        // Without a join at most one way goes on; the other one is written first if it leaves.
        let swap = self.leaves_first(no, next) > self.leaves_first(yes, next);
        let (first, second) = if swap { (no, yes) } else { (yes, no) };
        let mut early = self.list(Some(first), next)?;
        let when = if swap {
            when.clone().negated()
        } else {
            when.clone()
        };
        if leave(&early) {
            out.push(Tree::If {
                when,
                yes: early,
                no: Vec::new(),
            });
            return Some(Some(second));
        }
        let mut late = self.list(Some(second), next)?;
        if leave(&late) {
            std::mem::swap(&mut early, &mut late);
            let rest = late;
            out.push(Tree::If {
                when: when.negated(),
                yes: early,
                no: Vec::new(),
            });
            out.extend(rest);
            return Some(next);
        }
        out.push(Tree::If {
            when,
            yes: early,
            no: late,
        });
        Some(next)
    }

    /// How much a way should be the short one.
    fn leaves_first(
        &self,
        way: usize,
        next: Option<usize>,
    ) -> (bool, bool, std::cmp::Reverse<usize>) {
        let out_of_loop = self
            .loops
            .last()
            .is_some_and(|around| around.follow == Some(way) || !self.flow.is_in(way, around.head));
        let ends = matches!(self.work.nodes[way].kind, Kind::End(_)) && Some(way) != next;
        (out_of_loop, ends, std::cmp::Reverse(self.flow.weight[way]))
    }

    fn wait_for(&mut self, joins: &[usize]) -> usize {
        let pending = self.pending.len();
        for &join in joins {
            self.pending.push((join, self.loops.len()));
        }
        pending
    }

    fn switch(
        &mut self,
        node: usize,
        on: usize,
        next: Option<usize>,
        out: &mut Vec<Tree>,
    ) -> Option<Option<usize>> {
        let ways = self.work.nodes[node].next.clone();
        let joins = self.joins(node);
        let after = joins.first().copied().or(next);
        let pending = self.wait_for(&joins);
        let mut branches = Vec::new();
        for (way, numbers) in shared(&ways) {
            branches.push((numbers, self.list(Some(way), after)?));
        }
        out.push(Tree::Switch { on, branches });
        if joins.is_empty() {
            return Some(next);
        }
        self.rest(&joins, pending, next, out)
    }
}
