//! A program as its breakpoints see it: where their blocks are, what its variables hold, and what a text of a person means.
//!
//! Owns what such a text may say. Knows no breakpoints.

use super::aside::Nobody;
use super::formulas::{Formulas, token_name};
use super::words;
use crate::program::{Flow, NodeId, Op, Program};
use lang_diagram::debug::{Spot, Subject};
use lang_expr::names::is_own;
use lang_expr::tree::Node as Part;
use lang_expr::{Kind, Source, Value, Wanted};
use lang_text::problem::{Place, Position, Problem, Words};
use std::collections::BTreeSet;

/// Functions that a text cannot have that is only looked at.
const ACTIVE: [&str; 2] = ["print", "random"];

/// The texts of a program, which change when they are computed.
pub(super) enum Texts<'a> {
    /// Those of the program itself.
    Own(&'a mut Formulas),
    /// Those of one that must not change: copied when the first of them is computed.
    Copied(&'a Formulas, Option<Box<Formulas>>),
}

impl Texts<'_> {
    fn get(&self) -> &Formulas {
        match self {
            Self::Own(formulas) => formulas,
            Self::Copied(formulas, copy) => copy.as_deref().unwrap_or(formulas),
        }
    }

    fn get_mut(&mut self) -> &mut Formulas {
        match self {
            Self::Own(formulas) => formulas,
            Self::Copied(formulas, copy) => copy.get_or_insert_with(|| Box::new(formulas.clone())),
        }
    }
}

/// A program within an instant or between two.
pub struct Here<'a> {
    pub(super) program: &'a Program,
    pub(super) formulas: Texts<'a>,
    pub(super) now: u32,
    /// The token that comes next, which is `data`.
    pub(super) token: Option<&'a Value>,
}

impl Here<'_> {
    fn kind(&self, name: &str) -> Option<&Kind> {
        let names = self.formulas.get().names();
        names.kind(names.find(name)?)
    }

    /// Variables that texts of the program have, and those that its blocks assign.
    fn variables(&self) -> BTreeSet<&str> {
        let is_variable = |name: &&str| match self.kind(name) {
            Some(Kind::Variable) | None => !is_own(name),
            Some(Kind::Function(_) | Kind::Sensor(_) | Kind::Constant(_)) => false,
        };
        let texts = self.formulas.get().sources().iter().flat_map(Source::names);
        let assigned = self.program.nodes.iter().flat_map(|node| match &node.op {
            Op::Flow(Flow::Variable { names, .. }) => &names[..],
            Op::Flow(_) | Op::Source(_) | Op::Act(_) => &[],
        });
        let assigned = assigned.map(|name| &**name);
        texts.chain(assigned).filter(is_variable).collect()
    }

    /// What is wrong with a part of a text.
    fn fault(&self, part: &Part, variables: &BTreeSet<&str>) -> Option<Words> {
        let name = match part {
            Part::Assign { .. } => return Some(words::only_looked_at()),
            Part::Name(name) if is_own(name) => return None,
            Part::Name(name) => name,
            Part::Nil
            | Part::Bool(_)
            | Part::Int(_)
            | Part::Float(_)
            | Part::Text(_)
            | Part::RawText(_)
            | Part::Unary(..)
            | Part::Binary(..)
            | Part::Index { .. }
            | Part::Call { .. }
            | Part::Method { .. }
            | Part::Table { .. }
            | Part::Block(_) => return None,
        };
        match self.kind(name) {
            Some(Kind::Sensor(_)) => Some(words::asks_the_robot()),
            Some(Kind::Function(_)) if ACTIVE.contains(&&**name) => Some(words::asks_the_robot()),
            Some(Kind::Function(_) | Kind::Constant(_)) => None,
            Some(Kind::Variable) | None if variables.contains(&**name) => None,
            Some(Kind::Variable) | None => {
                Some(words::no_such_variable(name, variables.iter().copied()))
            }
        }
    }

    /// The value of a text; nothing while one of its variables has no value.
    fn computed(&mut self, text: &str, wanted: Wanted) -> Result<Option<Value>, Vec<Problem>> {
        let mut nobody = Nobody::at(self.now);
        let formulas = self.formulas.get_mut();
        let found = formulas.look((text, wanted), self.token, &mut nobody)?;
        match nobody.is_asked {
            true => Err(vec![Problem::error(words::asks_the_robot())]),
            false => Ok(found),
        }
    }
}

impl Subject for Here<'_> {
    fn nodes(&self, id: &str) -> Vec<NodeId> {
        let nodes = (0..).zip(&self.program.nodes);
        let here = nodes.filter(|(_, node)| *node.id == *id);
        here.map(|(at, _)| at).collect()
    }

    fn never_stops(&self, node: NodeId) -> Option<Words> {
        let node = self.program.node(node);
        match node.op {
            Op::Source(_) if node.linked == 0 => Some(words::starts_by_itself()),
            Op::Flow(Flow::InPort) => Some(words::only_passes()),
            // Its numbers come when their time is over, not as a reaction: only what starts it anew is one.
            Op::Flow(Flow::Random {
                every_ms: Some(_), ..
            }) if node.linked == 0 => Some(words::repeats_by_itself()),
            Op::Flow(_) | Op::Source(_) | Op::Act(_) => None,
        }
    }

    fn no_variable(&self, name: &str) -> Vec<Problem> {
        let why = match self.kind(name) {
            Some(Kind::Sensor(_)) => words::sensor_gives_tokens(name),
            Some(Kind::Function(_) | Kind::Constant(_)) => words::never_changes(name),
            Some(Kind::Variable) | None => {
                let variables = self.variables();
                if variables.contains(name) {
                    return Vec::new();
                }
                words::no_such_variable(name, variables)
            }
        };
        vec![Problem::error(why)]
    }

    fn mistakes(&self, text: &str, at: &Spot) -> Vec<Problem> {
        let own = |name: &str| match at {
            Spot::Block(_) => token_name(name),
            // Nothing comes to a change.
            Spot::Change(_) => None,
        };
        let mut source = Source::with_own_names(text, Wanted::Any, &own);
        if source.tree().root.is_none() {
            // The grammar alone: types come with values.
            let mut names = self.formulas.get().names().clone();
            return lang_expr::analyse(&mut source, &mut names)
                .err()
                .unwrap_or_default();
        }
        let variables = self.variables();
        let tree = source.tree();
        let parts = (0..).zip(&tree.nodes);
        let faults = parts.filter_map(|(id, part)| {
            let words = self.fault(part, &variables)?;
            Some((tree.place(id), words))
        });
        let mut faults: Vec<(Position, Words)> = faults.collect();
        faults.sort_by_key(|(at, _)| *at);
        faults.truncate(lang_expr::limits::EXPRESSION_PROBLEMS_MAX);
        let problems = faults.into_iter().map(|(at, words)| Problem {
            place: Place {
                position: Some(at),
                ..Place::default()
            },
            ..Problem::error(words)
        });
        problems.collect()
    }

    fn value_of(&self, name: &str) -> Option<Value> {
        self.formulas.get().get(name)
    }

    fn holds(&mut self, condition: &str) -> Result<bool, Vec<Problem>> {
        let found = self.computed(condition, Wanted::Bool)?;
        Ok(found.is_some_and(|value| value.to_bool()))
    }

    fn value(&mut self, text: &str) -> Result<Value, Vec<Problem>> {
        let found = self.computed(text, Wanted::Any)?;
        found.ok_or_else(|| vec![Problem::error(words::no_value_yet())])
    }
}
