//! Counters of loops: one for each block as in the original, or one for each thread and call if oddities are mended.
//!
//! Owns the counters, and which blocks are the inside of a loop: those that its body leads to and its exit does not. Who
//! comes from elsewhere enters the loop anew.

use std::collections::{HashMap, HashSet};

use crate::check::successors;
use crate::limits;
use crate::program::{Leads, Node, Program};
use lang_expr::Compat;

/// The counter of a loop.
#[derive(Clone, Copy, Debug, Default)]
struct Counter {
    left: i32,
    /// Whether the number of iterations is known.
    is_set: bool,
}

/// Whose counter it is: loop, life of the thread, calls that it is in.
type Key = (u32, u32, usize);

/// All counters.
#[derive(Clone, Debug)]
pub(super) struct Loops {
    shared: Vec<Counter>,
    /// With oddities mended.
    own: Option<HashMap<Key, Counter>>,
    insides: HashMap<u32, HashSet<Node>>,
    /// How many blocks may still be looked at to find insides.
    looks: usize,
}

/// Where somebody stands who comes to a loop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comer {
    pub node: Node,
    /// Where it comes from, if it is the same diagram.
    pub from: Option<Node>,
    pub life: u32,
    pub depth: usize,
}

impl Loops {
    pub fn new(count: u32, compat: Compat) -> Self {
        let is_fixed = compat == Compat::Fixed;
        Self {
            shared: vec![Counter::default(); if is_fixed { 0 } else { count as usize }],
            own: is_fixed.then(HashMap::new),
            insides: HashMap::new(),
            looks: limits::NODES_MAX,
        }
    }

    fn key(counter: u32, comer: Comer) -> Key {
        (counter, comer.life, comer.depth)
    }

    /// Whether the number of iterations has to be asked for.
    pub fn is_fresh(&mut self, counter: u32, comer: Comer, program: &Program) -> bool {
        if self.own.is_none() {
            return !self.shared[counter as usize].is_set;
        }
        let comes_from_inside = comer
            .from
            .is_some_and(|from| self.inside(counter, comer.node, program).contains(&from));
        let own = self.own.as_ref();
        let is_set = own.is_some_and(|own| own.contains_key(&Self::key(counter, comer)));
        !(is_set && comes_from_inside)
    }

    /// Begins to count down.
    pub fn set(&mut self, counter: u32, comer: Comer, left: i32) {
        let new = Counter { left, is_set: true };
        match &mut self.own {
            None => self.shared[counter as usize] = new,
            Some(own) => drop(own.insert(Self::key(counter, comer), new)),
        }
    }

    /// One round less; false when there is none left.
    pub fn next(&mut self, counter: u32, comer: Comer) -> bool {
        let key = Self::key(counter, comer);
        let found = match &mut self.own {
            None => self.shared.get_mut(counter as usize),
            Some(own) => own.get_mut(&key),
        };
        let Some(found) = found else {
            return false;
        };
        found.left = found.left.saturating_sub(1);
        let goes_on = found.left >= 0;
        found.is_set = goes_on;
        if !goes_on && let Some(own) = &mut self.own {
            own.remove(&key);
        }
        goes_on
    }

    /// A thread has ended, or has come back from a call.
    pub fn forget(&mut self, life: u32, depth: usize) {
        if let Some(own) = &mut self.own
            && !own.is_empty()
        {
            own.retain(|key, _| key.1 != life || key.2 < depth);
        }
    }

    /// Another version of the program: counters are where their loops are now.
    pub fn patch(&mut self, to: &HashMap<u32, u32>, count: u32) {
        let mut shared = vec![
            Counter::default();
            if self.own.is_some() {
                0
            } else {
                count as usize
            }
        ];
        for (before, after) in to {
            if let (Some(old), Some(new)) = (
                self.shared.get(*before as usize),
                shared.get_mut(*after as usize),
            ) {
                *new = *old;
            }
        }
        self.shared = shared;
        if let Some(own) = &mut self.own {
            *own = own
                .drain()
                .filter_map(|(key, counter)| Some(((*to.get(&key.0)?, key.1, key.2), counter)))
                .collect();
        }
        self.insides.clear();
        self.looks = limits::NODES_MAX;
    }

    fn inside(&mut self, counter: u32, node: Node, program: &Program) -> &HashSet<Node> {
        let looks = &mut self.looks;
        self.insides
            .entry(counter)
            .or_insert_with(|| match program.leads(node) {
                Some(Leads::Test(_, body, next)) => {
                    let outside = reach(next, node, program, looks);
                    let mut inside = reach(body, node, program, looks);
                    inside.retain(|inner| !outside.contains(inner));
                    inside
                }
                Some(
                    Leads::End
                    | Leads::Fault(_)
                    | Leads::To(_)
                    | Leads::Switch(_)
                    | Leads::Fork(_)
                    | Leads::Join(..)
                    | Leads::Call(..)
                    | Leads::Ask(..),
                )
                | None => HashSet::new(),
            })
    }
}

/// What a node leads to without passing a head, within the diagram.
fn reach(from: Node, head: Node, program: &Program, looks: &mut usize) -> HashSet<Node> {
    let mut found = HashSet::new();
    let mut open = vec![from];
    while let Some(node) = open.pop() {
        if node == head || *looks == 0 || !found.insert(node) {
            continue;
        }
        *looks -= 1;
        match program.leads(node) {
            Some(Leads::Call(_, next)) => open.push(next),
            Some(
                Leads::End
                | Leads::Fault(_)
                | Leads::To(_)
                | Leads::Switch(_)
                | Leads::Fork(_)
                | Leads::Join(..)
                | Leads::Test(..)
                | Leads::Ask(..),
            )
            | None => successors(program, node, &mut |next| open.push(next)),
        }
    }
    found
}
