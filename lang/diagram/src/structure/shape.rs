//! The last touch: loops with their condition at the head or foot, branches without empty halves.
//!
//! Owns which shapes are plainer. What is done, and in which order, stays the same.

use crate::tree::{Tree, leave, size};

/// How long a branch that leaves may be to stand before the other one, which then needs no indentation.
const SHORT: usize = 3;

/// The program in plainer shape.
pub(super) fn shape(list: Vec<Tree>) -> Vec<Tree> {
    let mut shaped: Vec<Tree> = Vec::with_capacity(list.len());
    for tree in list {
        if shaped.last().is_some_and(Tree::leaves) && !matches!(tree, Tree::Label(_)) {
            continue;
        }
        match tree {
            Tree::If { when, yes, no } => {
                let (mut when, mut yes, mut no) = (when, shape(yes), shape(no));
                let early = !leave(&yes) && leave(&no) && size(&no) < SHORT;
                if yes.is_empty() && !no.is_empty() || early {
                    when = when.negated();
                    std::mem::swap(&mut yes, &mut no);
                }
                let rest = if leave(&yes) {
                    std::mem::take(&mut no)
                } else {
                    Vec::new()
                };
                shaped.push(Tree::If { when, yes, no });
                shaped.extend(rest);
            }
            Tree::Switch { on, branches } => {
                let branches = branches.into_iter().map(|(ways, body)| (ways, shape(body)));
                shaped.push(Tree::Switch {
                    on,
                    branches: branches.collect(),
                });
            }
            Tree::Choice { variable, arms } => {
                let arms = arms.into_iter().map(|(value, body)| (value, shape(body)));
                shaped.push(Tree::Choice {
                    variable,
                    arms: arms.collect(),
                });
            }
            Tree::Loop { label, body } => shaped.push(looped(label, shape(body))),
            other @ (Tree::Step(_)
            | Tree::While { .. }
            | Tree::DoWhile { .. }
            | Tree::Break(_)
            | Tree::Continue(_)
            | Tree::End(_)
            | Tree::Set { .. }
            | Tree::Goto(_)
            | Tree::Label(_)) => shaped.push(other),
        }
    }
    shaped
}

fn looped(label: usize, mut body: Vec<Tree>) -> Tree {
    strip(&mut body, label);
    let leaves_loop = |tree: &Tree| match tree {
        Tree::If { yes, no, .. } => yes[..] == [Tree::Break(label)] && no.is_empty(),
        Tree::Step(_)
        | Tree::Switch { .. }
        | Tree::Loop { .. }
        | Tree::While { .. }
        | Tree::DoWhile { .. }
        | Tree::Break(_)
        | Tree::Continue(_)
        | Tree::End(_)
        | Tree::Set { .. }
        | Tree::Choice { .. }
        | Tree::Goto(_)
        | Tree::Label(_) => false,
    };
    if body.first().is_some_and(leaves_loop)
        && let Tree::If { when, .. } = body.remove(0)
    {
        return Tree::While {
            label,
            when: when.negated(),
            body,
        };
    }
    let again = Tree::Continue(label);
    let is_free = !body
        .iter()
        .any(|tree| *tree == again || tree.has(&mut |part| *part == again));
    if is_free
        && body.last().is_some_and(leaves_loop)
        && let Some(Tree::If { when, .. }) = body.pop()
    {
        return Tree::DoWhile {
            label,
            body,
            when: when.negated(),
        };
    }
    Tree::Loop { label, body }
}

/// Takes away jumps to where control goes anyway.
fn strip(list: &mut Vec<Tree>, label: usize) {
    match list.last_mut() {
        Some(Tree::Continue(known)) if *known == label => {
            list.pop();
            strip(list, label);
        }
        Some(Tree::If { yes, no, .. }) => {
            strip(yes, label);
            strip(no, label);
        }
        Some(Tree::Switch { branches, .. }) => {
            branches.iter_mut().for_each(|(_, body)| strip(body, label));
        }
        Some(Tree::Choice { arms, .. }) => {
            arms.iter_mut().for_each(|(_, body)| strip(body, label));
        }
        _ => {}
    }
}

/// Whether a block is written more than once.
pub(super) fn has_copies(list: &[Tree]) -> bool {
    let mut seen = std::collections::HashSet::new();
    let mut twice = false;
    each_block(list, &mut |block| twice |= !seen.insert(block));
    twice
}

fn each_block(list: &[Tree], seen: &mut dyn FnMut(usize)) {
    for tree in list {
        match tree {
            Tree::Step(block) => seen(*block),
            Tree::If { when, .. } | Tree::While { when, .. } | Tree::DoWhile { when, .. } => {
                when.tests(seen);
            }
            Tree::Switch { on, .. } => seen(*on),
            Tree::Loop { .. }
            | Tree::Break(_)
            | Tree::Continue(_)
            | Tree::End(_)
            | Tree::Set { .. }
            | Tree::Choice { .. }
            | Tree::Goto(_)
            | Tree::Label(_) => {}
        }
        for part in tree.parts() {
            each_block(part, seen);
        }
    }
}
