//! Variables that are read before they have a value, because only those who read them first give them one.
//!
//! Owns the order in which texts of one block are computed. Knows no types.

use super::fed::input;
use super::found::Found;
use super::givers::{assigned, gives, surely_reads};
use super::words;
use crate::program::{Flow, Op, Program};
use lang_expr::Source;
use lang_expr::tree::{Id, Node as Part, Tree};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Tells of them, and gives their names.
pub(super) fn look(program: &Program, found: &mut Found) -> HashSet<Rc<str>> {
    let mut begun = given_by_tokens(program);
    // Variables that a block reads and gives afterwards: where it reads them.
    let mut late: Vec<(Rc<str>, usize)> = Vec::new();
    let mut at = 0;
    while at < program.formulas.len() {
        let count = together(program, at);
        one_after_another(program, at..at + count, &mut begun, &mut late);
        at += count;
    }
    late.sort_by(|one, other| (one.1, &one.0).cmp(&(other.1, &other.0)));
    let mut names = HashSet::new();
    for (name, index) in late {
        if begun.contains(&name) || !names.insert(name.clone()) {
            continue;
        }
        let text = &program.formulas[index];
        let source = Source::new(&text.text, text.wanted);
        let tree = source.tree();
        let spot = read_at(tree, &name).map(|id| tree.place(id));
        let place = program.property_place(text.node, text.property, spot);
        found.error(place, words::read_first(&name));
    }
    names
}

/// Variables that get values by tokens.
fn given_by_tokens(program: &Program) -> HashSet<Rc<str>> {
    let mut given = HashSet::new();
    for node in &program.nodes {
        if let Op::Flow(Flow::Variable { names, .. }) = &node.op
            && input(node.row).is_some_and(|port| node.is_linked(port))
        {
            given.extend(names.iter().cloned());
        }
    }
    given
}

/// How many texts from this one on are always computed one after another.
fn together(program: &Program, first: usize) -> usize {
    let id = program.formulas[first].node;
    let node = program.node(id);
    match node.op {
        Op::Flow(Flow::Function { waits, .. }) if waits || node.data == 0 => {
            let texts = program.formulas[first..].iter();
            texts.take_while(|text| text.node == id).count()
        }
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => 1,
    }
}

/// Looks which variables some texts give first, and which they read before.
fn one_after_another(
    program: &Program,
    texts: std::ops::Range<usize>,
    begun: &mut HashSet<Rc<str>>,
    late: &mut Vec<(Rc<str>, usize)>,
) {
    let mut read: HashMap<Rc<str>, usize> = HashMap::new();
    let mut given: HashSet<Rc<str>> = HashSet::new();
    for index in texts {
        let text = &program.formulas[index];
        let source = Source::new(&text.text, text.wanted);
        begun.extend(given_elements(source.tree()));
        for name in surely_reads(source.tree()) {
            if !text.own.contains(&&*name) && !given.contains(&name) {
                read.entry(name).or_insert(index);
            }
        }
        given.extend(gives(source.tree()));
    }
    for name in given {
        match read.get(&name) {
            Some(&index) => late.push((name, index)),
            None => {
                begun.insert(name);
            }
        }
    }
}

/// Where a text reads a variable first.
fn read_at(tree: &Tree, name: &str) -> Option<Id> {
    let mut written = HashSet::new();
    for part in &tree.nodes {
        if let Part::Assign { target, .. } = part {
            written.insert(*target);
        }
    }
    let mut all = (0..).zip(&tree.nodes);
    let found = all.find(|(id, part)| {
        matches!(part, Part::Name(one) if **one == *name) && !written.contains(id)
    });
    found.map(|(id, _)| id)
}

/// Variables whose elements a text gives values: what they are before that is not known here.
fn given_elements(tree: &Tree) -> impl Iterator<Item = Rc<str>> {
    tree.nodes.iter().filter_map(|part| {
        let Part::Assign { target, .. } = part else {
            return None;
        };
        let is_element = matches!(tree.node(*target), Part::Index { .. });
        assigned(tree, *target).filter(|_| is_element).cloned()
    })
}
