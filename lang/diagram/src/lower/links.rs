//! Which links go out of a block and where they lead: the rules of each kind of block, in the order of the original.
//!
//! Owns those rules. Knows no properties.

use std::rc::Rc;

use super::{At, Node, name, words};
use crate::program::NOWHERE;
use crate::project::{Block, Diagram, Link};
use lang_text::problem::Words;

/// The links out of a block that exist.
fn outgoing<'a>(diagram: &'a Diagram, block: &'a Block) -> impl Iterator<Item = &'a Link> {
    block
        .outgoing
        .iter()
        .filter_map(|&link| diagram.links.get(link))
}

fn target(link: &Link, diagram: &Diagram, base: Node) -> Result<Node, Words> {
    match link.to {
        Some(to) if to < diagram.blocks.len() => Ok(base + to as Node),
        _ => Err(words::loose_link()),
    }
}

/// Exactly one link.
pub(super) fn single(diagram: &Diagram, block: &Block, base: Node) -> Result<Node, Words> {
    let mut links = outgoing(diagram, block);
    match (links.next(), links.next()) {
        (None, _) => Err(words::no_links()),
        (Some(_), Some(_)) => Err(words::too_many_links()),
        (Some(link), None) => target(link, diagram, base),
    }
}

/// A link for true and one for false; one of them may be blank, or marked with anything else.
pub(super) fn two_branches(at: At<'_>) -> Result<(Node, Node), Words> {
    let (mut yes, mut no, mut blank) = (None, None, None);
    if outgoing(at.diagram, at.block).count() != 2 {
        return Err(words::two_links());
    }
    for link in outgoing(at.diagram, at.block) {
        let to = Some(target(link, at.diagram, at.base)?);
        let guard = link.guard.to_lowercase();
        let (role, twice) = match guard.as_str() {
            "true" => (&mut yes, words::guard_twice("true")),
            "false" => (&mut no, words::guard_twice("false")),
            _ => (&mut blank, words::no_true_or_false()),
        };
        if role.is_some() {
            return Err(twice);
        }
        *role = to;
    }
    // Two links in different roles: at most one of the three is missing.
    match (yes.or(blank), no.or(blank)) {
        (Some(yes), Some(no)) => Ok((yes, no)),
        _ => Err(words::no_true_or_false()),
    }
}

/// Where a loop goes.
pub(super) struct LoopLinks {
    pub body: Node,
    pub exit: Node,
    /// Guards of links that the original does not look at.
    pub ignored: Vec<String>,
}

/// A link marked `iteration` and a blank one.
pub(super) fn body_and_exit(at: At<'_>) -> Result<LoopLinks, Words> {
    let (mut body, mut exit, mut ignored) = (None, None, Vec::new());
    for link in outgoing(at.diagram, at.block) {
        let to = target(link, at.diagram, at.base)?;
        if link.guard.to_lowercase() == "iteration" {
            if body.replace(to).is_some() {
                return Err(words::two_bodies());
            }
        } else if link.guard.is_empty() {
            if exit.replace(to).is_some() {
                return Err(words::no_body());
            }
        } else {
            ignored.push(link.guard.clone());
        }
    }
    let body = body.ok_or_else(words::no_body)?;
    let exit = exit.ok_or_else(words::no_way_out)?;
    Ok(LoopLinks {
        body,
        exit,
        ignored,
    })
}

/// Guards as they are written with targets, and where the blank link leads.
type Branches = (Vec<(Box<str>, Node)>, Node);

/// Links with different guards and exactly one blank one.
pub(super) fn many_branches(at: At<'_>) -> Result<Branches, Words> {
    if outgoing(at.diagram, at.block).count() < 2 {
        return Err(words::switch_needs_two());
    }
    let mut branches = Vec::new();
    let mut seen = std::collections::HashSet::new();
    let mut other = None;
    for link in outgoing(at.diagram, at.block) {
        let to = target(link, at.diagram, at.base)?;
        let guard = link.guard.to_lowercase();
        if guard.is_empty() {
            if other.replace(to).is_some() {
                return Err(words::two_defaults());
            }
        } else if seen.insert(guard.clone()) {
            branches.push((link.guard.as_str().into(), to));
        } else {
            return Err(words::branch_twice(&guard));
        }
    }
    let other = other.ok_or_else(words::no_default)?;
    Ok((branches, other))
}

/// The name of a thread, if it has one, and its first block.
type Thread = (Option<Rc<str>>, Node);

/// Threads with their first blocks.
pub(super) fn threads(at: At<'_>) -> Result<Vec<Thread>, Words> {
    if outgoing(at.diagram, at.block).count() < 2 {
        return Err(words::fork_needs_two());
    }
    let mut threads = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for link in outgoing(at.diagram, at.block) {
        let to = target(link, at.diagram, at.base)?;
        let guard = link.guard.as_str();
        if !guard.is_empty() && !seen.insert(guard) {
            return Err(words::thread_twice(guard));
        }
        threads.push(((!guard.is_empty()).then(|| name(guard)), to));
    }
    Ok(threads)
}

/// A link for the answer and perhaps one for none.
pub(super) fn question(at: At<'_>) -> Result<(Node, Node), Words> {
    match outgoing(at.diagram, at.block).count() {
        0 => return Err(words::no_links()),
        1 | 2 => {}
        _ => return Err(words::too_many_input_links()),
    }
    let (mut next, mut cancel) = (None, None);
    for link in outgoing(at.diagram, at.block) {
        let to = target(link, at.diagram, at.base)?;
        let (role, twice) = match words::is_cancel(&link.guard) {
            true => (&mut cancel, words::cancel_twice()),
            false => (&mut next, words::no_cancel()),
        };
        if role.replace(to).is_some() {
            return Err(twice);
        }
    }
    let next = next.ok_or_else(words::no_next)?;
    Ok((next, cancel.unwrap_or(NOWHERE)))
}
