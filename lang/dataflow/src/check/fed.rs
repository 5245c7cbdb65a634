//! Variables that nothing but tokens gives values, and the blocks that do.
//!
//! Owns which these are. Knows no types.

use crate::blocks::Row;
use crate::program::{Flow, NodeId, Op, Program};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// A variable that nothing but tokens gives values.
#[derive(Debug)]
pub(super) struct Fed {
    /// Its name.
    pub(super) name: Rc<str>,
    /// The blocks *Variable* with an edge, and which item of their lists it takes; `None`: the token itself.
    pub(super) by: Vec<(NodeId, Option<usize>)>,
    /// Whether it has had a type.
    pub(super) is_typed: bool,
}

/// The port of a block *Variable* that takes values.
pub(super) fn input(row: &Row) -> Option<u8> {
    row.port("IN")
}

/// The variables that nothing but tokens gives values, but for those that an expression gives some too, and those in
/// `unsure`.
pub(super) fn fed(
    program: &Program,
    is_given: impl Fn(&str) -> bool,
    unsure: &HashSet<Rc<str>>,
) -> Vec<Fed> {
    let mut all: Vec<Fed> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for (id, node) in (0..).zip(&program.nodes) {
        let Op::Flow(Flow::Variable { names, run: None }) = &node.op else {
            continue;
        };
        if !input(node.row).is_some_and(|port| node.is_linked(port)) {
            continue;
        }
        for (at, name) in names.iter().enumerate() {
            if is_given(name) || unsure.contains(name) {
                continue;
            }
            let item = (names.len() > 1).then_some(at);
            let place = *places.entry(name).or_insert_with(|| {
                all.push(Fed {
                    name: name.clone(),
                    by: Vec::new(),
                    is_typed: false,
                });
                all.len() - 1
            });
            all[place].by.push((id, item));
        }
    }
    all
}
