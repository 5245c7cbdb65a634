//! Names that nothing gives a value: misspelt ones, functions that are none, variables without a beginning.
//!
//! Owns what was probably meant. Knows no types.

use super::fed::input;
use super::found::{Found, property_place};
use super::givers::Variables;
use super::words;
use crate::limits;
use crate::program::{Flow, NodeId, Op, Program, Text};
use crate::sensors;
use lang_expr::names::is_own;
use lang_expr::tree::Node as Part;
use lang_expr::{Names, Source};
use lang_text::near;
use std::collections::{HashMap, HashSet};

/// Names that nothing gives a value.
#[derive(Debug, Default)]
pub(super) struct Unassigned {
    /// How many variables were compared with names that nobody knows.
    compared: usize,
    /// What was probably meant, by such a name and the own names of its block: a name may stand at many places.
    meant: HashMap<(String, &'static [&'static str]), Option<String>>,
}

impl Unassigned {
    /// Tells those of a text; whether there are any.
    pub(super) fn tell(
        &mut self,
        program: &Program,
        text: &Text,
        source: &Source,
        (names, variables): (&Names, &Variables),
        found: &mut Found,
    ) -> bool {
        let mut is_any = false;
        let tree = source.tree();
        let called: HashSet<u32> = tree.nodes.iter().filter_map(called).collect();
        for (id, (part, at)) in (0..).zip(tree.nodes.iter().zip(&tree.places)) {
            let Part::Name(name) = part else {
                continue;
            };
            let slot = names.find(name);
            let kind = slot.and_then(|slot| names.kind(slot));
            let is_variable = matches!(kind, None | Some(lang_expr::Kind::Variable));
            if !is_variable || is_own(name) || variables.are_given(name) {
                continue;
            }
            let words = match called.contains(&id) {
                true => words::no_function(name),
                false => words::never_assigned(name, self.meant(name, text, variables)),
            };
            let place = program.property_place(text.node, text.property, Some(*at));
            // Told once, however many instances the block has.
            found.error(place, words);
            is_any = true;
        }
        is_any
    }

    /// What was probably meant by a name that nobody knows.
    fn meant(&mut self, name: &str, text: &Text, variables: &Variables) -> Option<&str> {
        let key = (name.to_owned(), text.own);
        if !self.meant.contains_key(&key) {
            let near = near::nearest(name, self.comparable(text, variables));
            let near = near.map(str::to_owned);
            self.meant.insert(key.clone(), near);
        }
        self.meant.get(&key)?.as_deref()
    }

    /// What a name may be meant for.
    fn comparable<'a>(&mut self, text: &Text, variables: &'a Variables) -> Vec<&'a str> {
        let left = limits::NAMES_COMPARED_MAX.saturating_sub(self.compared);
        let mut known: Vec<&str> = variables.given().take(left).collect();
        self.compared += known.len();
        known.extend(text.own);
        known.extend(sensors::names().map(|name| -> &str { name }));
        known
    }

    /// Tells blocks *Variable* that give a variable which nothing gives a value.
    pub(super) fn tell_blocks(
        &mut self,
        program: &Program,
        variables: &Variables,
        found: &mut Found,
    ) {
        for (id, node) in (0..).zip(&program.nodes) {
            let Op::Flow(Flow::Variable { names, run: None }) = &node.op else {
                continue;
            };
            let gives = node.row.port("OUT").map(usize::from);
            let gives = gives.is_some_and(|port| !node.outs[port].is_empty());
            let takes = input(node.row).is_some_and(|port| node.is_linked(port));
            if let Some(name) = names.first()
                && gives
                && !takes
                && !variables.are_given(name)
            {
                let place = property_place(program, id as NodeId, "variable");
                found.error(place, words::never_assigned(name, None));
            }
        }
    }
}

/// The name that a part calls as a function.
fn called(part: &Part) -> Option<u32> {
    let Part::Call { function, .. } = part else {
        return None;
    };
    Some(*function)
}
