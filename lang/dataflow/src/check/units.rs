//! Control tokens that come from a text whose last statement assigns: which outputs they leave, and which text it is.
//!
//! Owns that the text is found from where its token is of no use. Knows no types.

use crate::program::{Flow, Formula, NodeId, Op, Program, Target};
use lang_expr::Source;
use lang_expr::tree::{Id, Node as Part};
use std::collections::{HashMap, HashSet};

/// Texts by the outputs at which their control tokens leave.
pub(super) struct Units {
    texts: HashMap<(NodeId, u8), Formula>,
}

/// The last statement of a text, if it assigns and so gives no value: what it assigns to.
pub(super) fn assigned_last(source: &Source) -> Option<Id> {
    let tree = source.tree();
    let last = tree.statements().last().copied()?;
    let Part::Assign { target, .. } = tree.node(last) else {
        return None;
    };
    Some(*target)
}

impl Units {
    /// Those of a program.
    pub(super) fn of(program: &Program) -> Self {
        let mut all = Self {
            texts: HashMap::new(),
        };
        let mut waiting = Vec::new();
        for (id, node) in (0..).zip(&program.nodes) {
            let Op::Flow(Flow::Function { texts, .. }) = &node.op else {
                continue;
            };
            for (port, text) in (3..).step_by(2).zip(texts) {
                let has_edges = !node.outs[usize::from(port)].is_empty();
                let Some(formula) = text.filter(|_| has_edges) else {
                    continue;
                };
                let text = &program.formulas[formula as usize];
                if assigned_last(&Source::new(&text.text, text.wanted)).is_some() {
                    all.texts.insert((id, port), formula);
                    waiting.push((id, port));
                }
            }
        }
        let mut entered = HashSet::new();
        while let Some((id, port)) = waiting.pop() {
            let Some(&formula) = all.texts.get(&(id, port)) else {
                continue;
            };
            let targets = program.node(id).outs.get(usize::from(port));
            for &to in targets.into_iter().flatten() {
                // A subprogram may have many input ports.
                if !entered.insert((to.node, to.port)) {
                    continue;
                }
                for out in hands_on(program, to) {
                    all.texts.entry(out).or_insert_with(|| {
                        waiting.push(out);
                        formula
                    });
                }
            }
        }
        all
    }

    /// The text whose assignment made the control tokens of an output.
    pub(super) fn text(&self, id: NodeId, port: u8) -> Option<Formula> {
        self.texts.get(&(id, port)).copied()
    }
}

/// Outputs at which a token goes on as it came.
fn hands_on(program: &Program, to: Target) -> Vec<(NodeId, u8)> {
    let Op::Flow(flow) = &program.node(to.node).op else {
        return Vec::new();
    };
    match (flow, to.port) {
        (Flow::If(_), 1) => vec![(to.node, 2), (to.node, 3)],
        (Flow::Wait { .. }, 2) | (Flow::Filter { .. }, 4) => vec![(to.node, 3)],
        (Flow::Replace(_), 0 | 1) | (Flow::Inhibit(_), 1) => vec![(to.node, 2)],
        (Flow::OutPort(Some(Target { node, port })), _) => vec![(*node, *port)],
        (Flow::Call(instance), port) => {
            let inputs = &program.instances[*instance as usize].inputs;
            let fed = inputs.iter().filter(|(one, _)| *one == port);
            fed.map(|&(_, input)| (input, 0)).collect()
        }
        (
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
            | Flow::Unzip,
            _,
        ) => Vec::new(),
    }
}
