//! Names of a program: whether there are more than the language of expressions has room for.
//!
//! Owns their number. A block whose expressions read tokens has names of its own for them, each call counted.

use super::found::Found;
use crate::program::{NodeId, Program};
use crate::sensors;
use crate::words;
use lang_expr::Source;
use lang_expr::limits::NAMES_MAX;
use lang_expr::names::own_name;
use std::collections::HashMap;

/// Names as the machine gives them room: own ones first, in the order of texts, then variables.
pub(super) fn look(program: &Program, found: &mut Found) {
    let mut names = sensors::names_of(program.kit);
    // There are no more of them than characters: then nothing has to be read.
    let bytes: usize = program.formulas.iter().map(|text| text.text.len()).sum();
    if names.len() + bytes <= NAMES_MAX {
        return;
    }
    let mut others: HashMap<String, NodeId> = HashMap::new();
    for text in &program.formulas {
        let source = Source::new(&text.text, text.wanted);
        for name in source.names() {
            let is_own = text.own.contains(&name);
            if !is_own {
                if others.len() <= NAMES_MAX && !others.contains_key(name) {
                    others.insert(name.to_owned(), text.node);
                }
            } else if names.slot(&own_name(name, text.node)).is_none() {
                let place = program.place(text.node);
                found.error(place, words::too_many_names(NAMES_MAX));
                return;
            }
        }
    }
    let mut others: Vec<(String, NodeId)> = others.into_iter().collect();
    others.sort_by(|(one, first), (other, second)| (first, one).cmp(&(second, other)));
    for (name, node) in others {
        if names.slot(&name).is_none() {
            let place = program.place(node);
            found.error(place, words::too_many_names(NAMES_MAX));
            return;
        }
    }
}
