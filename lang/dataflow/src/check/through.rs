//! Tokens that run through ports of subprograms: what they are where they were made.
//!
//! Owns that a port that gives tokens of several kinds is asked for each of them, as if the subprogram stood in its place.
//! Types of other outputs are those of `types`.

use super::types::Of;
use crate::blocks::Kind;
use crate::limits;
use crate::program::{Flow, NodeId, Op, Program, Target};
use std::collections::HashMap;

/// Tokens of one kind, and the output that makes them.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct Emitted {
    pub(super) of: Of,
    pub(super) by: Target,
}

impl Emitted {
    /// Whether one is told of and the other need not be; each text may be another word.
    fn is_like(&self, other: &Self) -> bool {
        self.of == other.of && (self.of != Of::Text || self.by == other.by)
    }
}

/// What comes out of input ports inside subprograms and of their calls, by node and port.
pub(super) struct Through {
    made: HashMap<(NodeId, u8), Vec<Emitted>>,
    waiting: Vec<((NodeId, u8), Emitted)>,
}

impl Through {
    /// That of a program; `outs`: what each output gives.
    pub(super) fn of(program: &Program, outs: &[Vec<Of>]) -> Self {
        let mut all = Self {
            made: HashMap::new(),
            waiting: Vec::new(),
        };
        for id in 0..program.nodes.len() as NodeId {
            for (port, to) in program.edges(id) {
                let by = Target { node: id, port };
                if !hands_on(program, by) {
                    let of = outs[id as usize][usize::from(port)];
                    all.come(program, to, Emitted { of, by });
                }
            }
        }
        while let Some(((node, port), made)) = all.waiting.pop() {
            let targets = program.node(node).outs.get(usize::from(port));
            for &to in targets.into_iter().flatten() {
                all.come(program, to, made);
            }
        }
        all
    }

    /// What an output gives, one after the other; `of`: all of it together.
    pub(super) fn made(&self, by: Target, of: Of) -> Vec<Emitted> {
        match self.made.get(&(by.node, by.port)) {
            Some(made) => made.clone(),
            None => vec![Emitted { of, by }],
        }
    }

    /// A token comes to a port, and goes on if it is one of a subprogram.
    fn come(&mut self, program: &Program, to: Target, made: Emitted) {
        let Op::Flow(flow) = &program.node(to.node).op else {
            return;
        };
        match flow {
            Flow::Call(instance) => {
                for &(port, input) in &program.instances[*instance as usize].inputs {
                    if port == to.port {
                        self.leave(
                            program,
                            Target {
                                node: input,
                                port: 0,
                            },
                            made,
                        );
                    }
                }
            }
            Flow::OutPort(Some(target)) => self.leave(program, *target, made),
            Flow::Stop
            | Flow::Function { .. }
            | Flow::If(_)
            | Flow::Switch { .. }
            | Flow::Loop { .. }
            | Flow::InPort
            | Flow::OutPort(None)
            | Flow::Constant(_)
            | Flow::Variable { .. }
            | Flow::Random { .. }
            | Flow::Filter { .. }
            | Flow::Wait { .. }
            | Flow::Replace(_)
            | Flow::Inhibit(_)
            | Flow::Zip
            | Flow::Unzip => {}
        }
    }

    fn leave(&mut self, program: &Program, from: Target, made: Emitted) {
        if !hands_on(program, from) {
            return;
        }
        let known = self.made.entry((from.node, from.port)).or_default();
        let is_new = !known.iter().any(|one| one.is_like(&made));
        if is_new && known.len() < limits::KINDS_MAX {
            known.push(made);
            self.waiting.push(((from.node, from.port), made));
        }
    }
}

/// Whether an output gives what came to the port of a subprogram, as it came.
fn hands_on(program: &Program, from: Target) -> bool {
    let node = program.node(from.node);
    let port = node.row.ports.get(usize::from(from.port));
    let is_open = port.is_some_and(|port| port.of == Kind::Any);
    is_open && matches!(node.op, Op::Flow(Flow::Call(_) | Flow::InPort))
}
