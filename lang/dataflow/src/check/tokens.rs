//! Variables that get their values by tokens: which type they have, as far as that is certain.
//!
//! Owns tokens that their variable cannot take; which variables these are is in `fed`. What runs along edges
//! is known to `types`.

use super::fed::input;
use super::found::{Found, port_place};
use super::types::Of;
use super::words;
use crate::program::{Flow, NodeId, Op, Program, Target};
use std::collections::HashMap;

/// What a variable gets of a token: the token, or an item of it.
pub(super) fn taken(of: Of, item: Option<usize>) -> Of {
    match (item, of) {
        (None, of) => of,
        (Some(_), Of::Never) => Of::Never,
        (Some(_), Of::Wholes(_)) => Of::Whole,
        (
            Some(_),
            Of::Unit
            | Of::Truth
            | Of::Whole
            | Of::Number
            | Of::Digits
            | Of::Text
            | Of::Computed
            | Of::List(_)
            | Of::Any,
        ) => Of::Any,
    }
}

/// Values of one kind: a variable that has one of them takes the others too.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Alike {
    Truth,
    Number,
    Text,
    List,
}

impl Alike {
    fn of(of: Of) -> Option<Self> {
        match of {
            Of::Never | Of::Unit | Of::Any => None,
            Of::Truth => Some(Self::Truth),
            Of::Whole | Of::Number => Some(Self::Number),
            Of::Digits | Of::Text | Of::Computed => Some(Self::Text),
            Of::List(_) | Of::Wholes(_) => Some(Self::List),
        }
    }
}

/// Tells tokens that a block *Variable* cannot take: what is no list for several variables, lists that are too short, and
/// what is of another kind than the variable is, which keeps its kind while the program runs. `of_variable`: what
/// expressions make of a variable.
pub(super) fn tell(
    program: &Program,
    outs: &[Vec<Of>],
    of_variable: impl Fn(&str) -> Of,
    found: &mut Found,
) {
    let mut kinds: HashMap<&str, Of> = HashMap::new();
    for id in 0..program.nodes.len() as NodeId {
        for (port, to) in program.edges(id) {
            let node = program.node(to.node);
            let Op::Flow(Flow::Variable { names, run }) = &node.op else {
                continue;
            };
            if input(node.row) != Some(to.port) {
                continue;
            }
            let of = outs[id as usize][usize::from(port)];
            if names.len() > 1 && tell_list(program, to, (of, names.len()), found) {
                continue;
            }
            // Nothing starts the assignments of such a block, so what they make of its variables does not count.
            let is_started = run.is_none()
                || node
                    .row
                    .port("CF_IN")
                    .is_some_and(|port| node.is_linked(port));
            if !is_started {
                continue;
            }
            for (at, name) in names.iter().enumerate() {
                let comes = taken(of, (names.len() > 1).then_some(at));
                let is = kinds.entry(name).or_insert_with(|| of_variable(name));
                match (Alike::of(comes), Alike::of(*is)) {
                    (Some(one), Some(other)) if one != other => {
                        let place = port_place(program, to.node, to.port);
                        found.warn(place, words::other_kind(name, comes.words(), is.words()));
                    }
                    (Some(_), None) => *is = comes,
                    (None | Some(_), _) => {}
                }
            }
        }
    }
}

/// Tells a token of which several variables cannot get their items; whether it is one.
fn tell_list(program: &Program, to: Target, (of, count): (Of, usize), found: &mut Found) -> bool {
    let place = || port_place(program, to.node, to.port);
    match of {
        Of::Truth | Of::Whole | Of::Number | Of::Digits | Of::Text | Of::Computed => {
            found.error(place(), words::no_list_for(of.words(), count));
            true
        }
        Of::List(has) | Of::Wholes(has) if has > 0 && usize::from(has) < count => {
            found.error(place(), words::short_list(has, count));
            true
        }
        Of::Never | Of::Unit | Of::Any | Of::List(_) | Of::Wholes(_) => false,
    }
}
