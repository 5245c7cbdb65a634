//! Any graph as a loop over a variable that says where the program is.
//!
//! Owns which blocks stand together: those that are reached on one way only.

use super::work::{Kind, Work, shared};
use crate::limits::STATES_NESTING_MAX;
use crate::tree::Tree;

struct States<'a> {
    work: &'a Work,
    /// The number of the state that begins at a node, from 1.
    number: Vec<usize>,
    /// Nodes with a number, in their order.
    heads: Vec<usize>,
}

/// The program; its only variable is the first one.
pub(super) fn states(work: &Work) -> Vec<Tree> {
    let mut states = States {
        work,
        number: vec![0; work.len()],
        heads: Vec::new(),
    };
    states.head(0);
    for (node, before) in work.before().iter().enumerate() {
        if before.len() > 1 {
            states.head(node);
        }
    }
    let mut arms = Vec::new();
    while let Some(&head) = states.heads.get(arms.len()) {
        let mut body = Vec::new();
        states.write(head, 0, &mut body);
        arms.push((arms.len() + 1, body));
    }
    let choice = Tree::Choice { variable: 0, arms };
    vec![
        Tree::Set {
            variable: 0,
            value: 1,
        },
        Tree::Loop {
            label: 0,
            body: vec![choice],
        },
    ]
}

impl States<'_> {
    fn head(&mut self, node: usize) -> usize {
        if self.number[node] == 0 {
            self.heads.push(node);
            self.number[node] = self.heads.len();
        }
        self.number[node]
    }

    /// What is done from a node on until another state begins.
    fn write(&mut self, from: usize, depth: usize, out: &mut Vec<Tree>) {
        let work = self.work;
        let mut node = from;
        loop {
            let ways = &work.nodes[node].next;
            match &work.nodes[node].kind {
                Kind::End(block) => {
                    out.push(Tree::End(*block));
                    return;
                }
                Kind::Step(block) => {
                    out.push(Tree::Step(*block));
                    node = ways[0];
                    if self.number[node] != 0 {
                        self.set(node, out);
                        return;
                    }
                }
                Kind::Test(when) => {
                    let yes = self.branch(ways[0], depth);
                    let no = self.branch(ways[1], depth);
                    out.push(Tree::If {
                        when: when.clone(),
                        yes,
                        no,
                    });
                    return;
                }
                Kind::Switch(on) => {
                    let ways = shared(ways).into_iter();
                    let branches = ways
                        .map(|(way, numbers)| (numbers, self.branch(way, depth)))
                        .collect();
                    out.push(Tree::Switch { on: *on, branches });
                    return;
                }
            }
        }
    }

    fn branch(&mut self, node: usize, depth: usize) -> Vec<Tree> {
        let mut out = Vec::new();
        if self.number[node] != 0 || depth >= STATES_NESTING_MAX {
            self.set(node, &mut out);
        } else {
            self.write(node, depth + 1, &mut out);
        }
        out
    }

    fn set(&mut self, node: usize, out: &mut Vec<Tree>) {
        let value = self.head(node);
        out.push(Tree::Set { variable: 0, value });
    }
}
