//! Timers that begin within a step whose time they count: those that another timer has led the flow to.
//!
//! Owns the flow of clocks through functions, subprograms and threads. In a step the clocks of blocks count in the order
//! of blocks (`machine/clocks`), so a clock that is set by one before it counts that step already, and a program as text
//! waits one step less. Where ways with different answers meet, the timer waits in full.

use crate::limits;
use std::collections::BTreeSet;

use super::plan::{Owner, Plan};
use crate::program::{Leads, Node, Op, Program, Wakes};
use crate::structure::Exit;

/// What has led the flow to a block within a step.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
struct Led {
    /// The last of the blocks whose clocks may have.
    clock: Option<Node>,
    /// Whether it may have been something else, or nobody knows.
    otherwise: bool,
}

const OTHERWISE: Led = Led {
    clock: None,
    otherwise: true,
};

impl Led {
    fn by(node: Node) -> Self {
        Self {
            clock: Some(node),
            otherwise: false,
        }
    }

    /// Takes in another way; whether that changes anything.
    fn join(&mut self, other: Self) -> bool {
        let joined = Self {
            clock: self.clock.max(other.clock),
            otherwise: self.otherwise || other.otherwise,
        };
        let changed = joined != *self;
        *self = joined;
        changed
    }

    /// Whether a clock that is set here counts the present step.
    fn counts_for(self, node: Node) -> bool {
        !self.otherwise && self.clock.is_some_and(|clock| clock < node)
    }
}

struct Flow<'a> {
    program: &'a Program,
    plan: &'a Plan,
    /// For each function how its blocks are reached.
    blocks: Vec<Vec<Led>>,
    /// How each function is left.
    exits: Vec<Led>,
    changed: bool,
}

/// Timers that count the step in which they begin, by their function.
pub(super) fn early(program: &Program, plan: &Plan) -> BTreeSet<(usize, Node)> {
    let functions = &plan.functions;
    let reached = |function: &super::plan::Function| vec![Led::default(); function.nodes.len()];
    let mut flow = Flow {
        program,
        plan,
        blocks: functions.iter().map(reached).collect(),
        exits: vec![Led::default(); functions.len()],
        changed: true,
    };
    for (index, function) in functions.iter().enumerate() {
        if function.owner == Owner::Main {
            flow.enter(index, OTHERWISE);
        }
    }
    let mut rounds = 0;
    while std::mem::take(&mut flow.changed) {
        rounds += 1;
        if rounds > limits::GENERATED_ROUNDS_MAX {
            return BTreeSet::new();
        }
        for function in 0..functions.len() {
            flow.walk(function);
        }
    }
    let mut early = BTreeSet::new();
    for (index, function) in functions.iter().enumerate() {
        for (&node, led) in function.nodes.iter().zip(&flow.blocks[index]) {
            let is_timer = matches!(program.ops[node as usize], Op::Timer { .. });
            if is_timer && led.counts_for(node) {
                early.insert((index, node));
            }
        }
    }
    early
}

impl Flow<'_> {
    fn enter(&mut self, function: usize, led: Led) {
        let entry = self.plan.functions[function].graph.entry;
        if let Some(known) = self.blocks[function].get_mut(entry) {
            self.changed |= known.join(led);
        }
    }

    fn walk(&mut self, index: usize) {
        let plan = self.plan;
        let function = &plan.functions[index];
        for (block, &node) in function.nodes.iter().enumerate() {
            let led = self.blocks[index][block];
            if led == Led::default() {
                continue;
            }
            if let Some(begun) = function.begun.get(&node) {
                for (name, first) in begun {
                    if let Some(thread) = plan.thread(name, *first) {
                        self.enter(thread, led);
                    }
                }
            }
            let after = self.after(node, led);
            let mut reach = |next: usize| {
                let known = &mut self.blocks[index][next];
                self.changed |= known.join(after);
            };
            match &function.graph.ways[block] {
                Exit::End => self.changed |= self.exits[index].join(after),
                Exit::Step(next) => reach(*next),
                Exit::Test(yes, no) => {
                    reach(*yes);
                    reach(*no);
                }
                Exit::Switch(all) => all.iter().for_each(|next| reach(*next)),
            }
        }
    }

    /// What leads on from a block.
    fn after(&mut self, node: Node, led: Led) -> Led {
        if let Some(Leads::Call(call, _)) = self.program.leads(node) {
            let callee = call
                .diagram
                .and_then(|diagram| self.plan.subprogram(diagram));
            let Some(callee) = callee else {
                return led;
            };
            self.enter(callee, led);
            return self.exits[callee];
        }
        match self.program.wakes(node) {
            Wakes::ByItsClock => Led::by(node),
            // Those go on when all clocks have counted, or because of another thread.
            Wakes::Later => OTHERWISE,
            Wakes::AtOnce => led,
        }
    }
}
