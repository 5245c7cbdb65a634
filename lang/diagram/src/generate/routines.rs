//! Functions of a program as statements: the structured graph of each with what its blocks say.
//!
//! Owns parameters of subprograms, loops with counters, and what is kept where. Knows no language.

use std::collections::{BTreeMap, BTreeSet};

use super::build::{Variables, truth, whole};
use super::code::{Code, Element, Kind, Operation, Own, Robot, Statement, Truth, Wholeness};
use super::plan::{Function, Owner, Plan};
use super::texts::Texts;
use crate::program::{Leads, Node, Op, Program, Test};
use crate::structure::{Jumps, Manner, Structured, structure};
use crate::tree::{Condition, Tree};
use lang_text::problem::Problem;

/// One function, ready to be printed.
#[derive(Clone, Debug)]
pub(super) struct Routine {
    pub(super) owner: Owner,
    /// Variables of the program that are parameters here.
    pub(super) parameters: Vec<usize>,
    /// Variables of the generator.
    pub(super) locals: BTreeMap<(u8, usize), (Own, Kind)>,
    pub(super) body: Vec<Statement>,
    pub(super) manner: Manner,
    /// Variables of the program that get values here.
    pub(super) assigned: BTreeSet<usize>,
}

/// Everything that is printed.
#[derive(Clone, Debug)]
pub(super) struct Script {
    pub(super) routines: Vec<Routine>,
    pub(super) variables: Variables,
    pub(super) has_threads: bool,
    /// Whether threads are begun, ended or written to, if only the one that the program begins with.
    pub(super) names_threads: bool,
}

/// What the target language can do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Abilities {
    pub(super) jumps: Jumps,
    /// Whether a loop can be left and a function ended anywhere.
    pub(super) leaves: bool,
}

pub(super) struct Lowerer<'a> {
    pub(super) program: &'a Program,
    pub(super) plan: &'a Plan,
    pub(super) texts: Texts<'a>,
    /// How often the block of a loop stands in the whole program.
    loops: BTreeMap<Node, usize>,
    /// Timers that count the step in which they begin, by their function.
    pub(super) early: BTreeSet<(usize, Node)>,
    /// Whether threads are ended from outside.
    kills: bool,
    counters: BTreeMap<Node, usize>,
    /// Of the present routine.
    pub(super) function: usize,
    pub(super) locals: BTreeMap<(u8, usize), (Own, Kind)>,
    pub(super) problems: Vec<Problem>,
}

/// The routines of a program.
pub(super) fn routines(
    program: &Program,
    plan: &Plan,
    texts: Texts<'_>,
    abilities: Abilities,
) -> Result<Script, Vec<Problem>> {
    let structured: Vec<Structured> = plan
        .functions
        .iter()
        .map(|function| arranged(function, abilities))
        .collect();
    let mut lowerer = Lowerer {
        program,
        plan,
        texts,
        loops: BTreeMap::new(),
        early: super::ticks::early(program, plan),
        kills: program.ops.iter().any(|op| matches!(op, Op::Kill { .. })),
        counters: BTreeMap::new(),
        function: 0,
        locals: BTreeMap::new(),
        problems: Vec::new(),
    };
    for (function, structured) in plan.functions.iter().zip(&structured) {
        lowerer.count_loops(function, &structured.body);
    }
    let mut routines = Vec::new();
    for (index, structured) in structured.iter().enumerate() {
        lowerer.function = index;
        lowerer.locals.clear();
        let body = lowerer.list(&structured.body);
        let owner = plan.functions[index].owner.clone();
        let parameters = match owner {
            Owner::Subprogram(diagram) => lowerer.parameters(diagram),
            Owner::Main | Owner::Thread(..) => Vec::new(),
        };
        let mut assigned = BTreeSet::new();
        assigns(&body, &mut assigned);
        routines.push(Routine {
            owner,
            parameters,
            locals: std::mem::take(&mut lowerer.locals),
            body,
            manner: structured.manner,
            assigned,
        });
    }
    if !lowerer.problems.is_empty() {
        return Err(lowerer.problems);
    }
    Ok(Script {
        routines,
        variables: lowerer.texts.variables,
        has_threads: plan.has_threads(),
        names_threads: plan.has_threads() || plan.names_threads(program),
    })
}

/// The structured graph; without breaks and returns if the language has none.
fn arranged(function: &Function, abilities: Abilities) -> Structured {
    let structured = structure(&function.graph, abilities.jumps);
    if abilities.leaves || is_calm(&structured.body, true) {
        structured
    } else {
        crate::structure::by_states(&function.graph)
    }
}

/// Whether nothing is left but at its end.
fn is_calm(list: &[Tree], at_end: bool) -> bool {
    list.iter().enumerate().all(|(place, tree)| {
        let at_end = at_end && place + 1 == list.len();
        match tree {
            Tree::Break(_) | Tree::Continue(_) | Tree::Goto(_) | Tree::Label(_) => false,
            Tree::End(_) => at_end,
            Tree::If { .. } | Tree::Switch { .. } | Tree::Choice { .. } => {
                tree.parts().into_iter().all(|part| is_calm(part, at_end))
            }
            Tree::Step(_)
            | Tree::Loop { .. }
            | Tree::While { .. }
            | Tree::DoWhile { .. }
            | Tree::Set { .. } => tree.parts().into_iter().all(|part| is_calm(part, false)),
        }
    })
}

/// Variables that get values in a list.
fn assigns(list: &[Statement], found: &mut BTreeSet<usize>) {
    for statement in list {
        if let Statement::Set(Code::Variable(variable), _) = statement {
            found.insert(*variable);
        }
        if let Statement::Do(Code::Do(Operation::Element(Element::Put), operands)) = statement
            && let Some(Code::Variable(variable)) = operands.first()
        {
            found.insert(*variable);
        }
        for part in statement.parts() {
            assigns(part, found);
        }
    }
}

impl Statement {
    /// The lists inside.
    pub(super) fn parts(&self) -> Vec<&[Statement]> {
        match self {
            Self::If(_, yes, no) => vec![yes, no],
            Self::Switch {
                branches, other, ..
            } => {
                let branches = branches.iter().map(|(_, body)| &body[..]);
                branches.chain([&other[..]]).collect()
            }
            Self::Choice { arms, .. } => arms.iter().map(|(_, body)| &body[..]).collect(),
            Self::Loop { body, .. }
            | Self::While { body, .. }
            | Self::DoWhile { body, .. }
            | Self::Repeat { body, .. } => vec![body],
            Self::From(_)
            | Self::Comment(_)
            | Self::Do(_)
            | Self::Set(..)
            | Self::Call { .. }
            | Self::Break(_)
            | Self::Continue(_)
            | Self::Return
            | Self::Goto(_)
            | Self::Label(_) => Vec::new(),
        }
    }
}

impl Lowerer<'_> {
    pub(super) fn node(&self, block: usize) -> Option<Node> {
        self.plan.functions[self.function].nodes.get(block).copied()
    }

    fn count_loops(&mut self, function: &Function, list: &[Tree]) {
        for tree in list {
            if let Tree::If { when, .. } | Tree::While { when, .. } | Tree::DoWhile { when, .. } =
                tree
            {
                when.tests(&mut |block| {
                    if let Some(&node) = function.nodes.get(block) {
                        *self.loops.entry(node).or_default() += 1;
                    }
                });
            }
            for part in tree.parts() {
                self.count_loops(function, part);
            }
        }
    }

    pub(super) fn list(&mut self, list: &[Tree]) -> Vec<Statement> {
        let mut out = Vec::new();
        for tree in list {
            let at = out.len();
            self.tree(tree, &mut out);
            // A list of nothing else would be no empty one.
            if out.len() > at {
                out.insert(at, Statement::From(self.blocks(tree)));
            }
        }
        out
    }

    /// The blocks that a statement says; of one with others in it those of its head.
    fn blocks(&self, tree: &Tree) -> Vec<Node> {
        let mut all = Vec::new();
        let mut add = |block| all.extend(self.node(block));
        match tree {
            Tree::Step(block) | Tree::Switch { on: block, .. } | Tree::End(block) => add(*block),
            Tree::If { when, .. } | Tree::While { when, .. } | Tree::DoWhile { when, .. } => {
                when.tests(&mut add);
            }
            Tree::Loop { .. }
            | Tree::Break(_)
            | Tree::Continue(_)
            | Tree::Set { .. }
            | Tree::Choice { .. }
            | Tree::Goto(_)
            | Tree::Label(_) => {}
        }
        all
    }

    fn tree(&mut self, tree: &Tree, out: &mut Vec<Statement>) {
        match tree {
            Tree::Step(block) => {
                if let Some(node) = self.node(*block) {
                    self.step(node, out);
                }
            }
            Tree::If { when, yes, no } => {
                let when = self.condition(when);
                let (yes, no) = (self.list(yes), self.list(no));
                if !(yes.is_empty() && no.is_empty()) || when.is_fickle() || is_counting(&when) {
                    out.push(Statement::If(when, yes, no));
                }
            }
            Tree::Switch { on, branches } => self.switch(*on, branches, out),
            Tree::Loop { label, body } => {
                let (label, body) = (*label, self.list(body));
                out.push(Statement::Loop { label, body });
            }
            Tree::While { label, when, body } => {
                if let Some(times) = self.clean_loop(*label, when, body) {
                    let statement = Statement::Repeat {
                        label: *label,
                        counter: *label,
                        times,
                        body: self.list(body),
                    };
                    self.local(Own::Counter, *label, Kind::Int);
                    out.push(statement);
                    return;
                }
                let when = self.condition(when);
                let (label, body) = (*label, self.list(body));
                out.push(Statement::While { label, when, body });
            }
            Tree::DoWhile { label, body, when } => {
                let (label, body) = (*label, self.list(body));
                let when = self.condition(when);
                out.push(Statement::DoWhile { label, body, when });
            }
            Tree::Break(label) => out.push(Statement::Break(*label)),
            Tree::Continue(label) => out.push(Statement::Continue(*label)),
            Tree::End(_) => {
                let owner = &self.plan.functions[self.function].owner;
                if *owner == Owner::Main && !self.plan.has_threads() {
                    out.push(Statement::Do(Code::does(Robot::Finish, [])));
                }
                out.push(Statement::Return);
            }
            Tree::Set { variable, value } => {
                self.local(Own::State, *variable, Kind::Int);
                let value = Code::Int(i64::try_from(*value).unwrap_or(0));
                out.push(Statement::Set(Code::Own(Own::State, *variable), value));
            }
            Tree::Choice { variable, arms } => {
                self.local(Own::State, *variable, Kind::Int);
                let arms = arms.iter().map(|(value, body)| (*value, self.list(body)));
                let arms = arms.collect();
                let on = Code::Own(Own::State, *variable);
                out.push(Statement::Choice { on, arms });
            }
            Tree::Goto(label) => out.push(Statement::Goto(*label)),
            Tree::Label(label) => out.push(Statement::Label(*label)),
        }
    }

    /// A variable of the generator in the present routine.
    pub(super) fn local(&mut self, own: Own, number: usize, kind: Kind) -> Code {
        self.locals.insert((own as u8, number), (own, kind));
        Code::Own(own, number)
    }

    /// A new place for a value.
    pub(super) fn place(&mut self, kind: Kind) -> Code {
        let used = self.locals.values().filter(|(own, _)| *own == Own::Value);
        let number = used.count();
        self.local(Own::Value, number, kind)
    }

    fn condition(&mut self, when: &Condition) -> Code {
        match when {
            Condition::Test(block) => self.test(*block),
            Condition::Not(inner) => {
                let inner = self.condition(inner);
                self.negated(inner)
            }
            Condition::And(left, right) => {
                let left = self.condition(left);
                Code::does(Truth::And, [left, self.condition(right)])
            }
            Condition::Or(left, right) => {
                let left = self.condition(left);
                Code::does(Truth::Or, [left, self.condition(right)])
            }
        }
    }

    fn test(&mut self, block: usize) -> Code {
        let Some(node) = self.node(block) else {
            return Code::Bool(false);
        };
        match self.program.test(node) {
            Some(Test::Truth(source)) => truth(self.value(node, source)),
            Some(Test::Count(source)) => {
                let times = whole(self.value(node, source));
                let new = self.counters.len();
                let counter = *self.counters.entry(node).or_insert(new);
                let counter = Code::Int(i64::try_from(counter).unwrap_or(0));
                Code::does(Truth::Again, [counter, times])
            }
            None => Code::Bool(false),
        }
    }

    fn negated(&self, code: Code) -> Code {
        let Code::Do(Operation::Truth(truth), operands) = code else {
            return Code::does(Truth::Not, [code]);
        };
        if truth == Truth::Not {
            return operands.into_iter().next().unwrap_or(Code::Bool(true));
        }
        let is_whole = operands.iter().all(|operand| self.is_whole(operand));
        match truth.opposite(is_whole) {
            Some(opposite) => Code::does(opposite, operands),
            None => Code::does(Truth::Not, [Code::does(truth, operands)]),
        }
    }

    /// Whether a number is surely whole, so that its comparisons have opposites.
    fn is_whole(&self, code: &Code) -> bool {
        match code {
            Code::Int(_) => true,
            Code::Variable(number) => self.texts.variables.all[*number].kind == Some(Kind::Int),
            Code::Do(operation, parts) => match operation.wholeness() {
                Wholeness::Whole => true,
                Wholeness::LikeOperands => parts.iter().all(|part| self.is_whole(part)),
                Wholeness::Unknown => false,
            },
            Code::Float(_)
            | Code::Bool(_)
            | Code::Text(_)
            | Code::Nil
            | Code::Port(_)
            | Code::Own(..)
            | Code::Function(_)
            | Code::List(_) => false,
        }
    }

    /// How often a counted loop runs, if nobody can see its counter half way.
    fn clean_loop(&mut self, label: usize, when: &Condition, body: &[Tree]) -> Option<Code> {
        let Condition::Test(block) = when else {
            return None;
        };
        let node = self.node(*block)?;
        let source = match self.program.test(node)? {
            Test::Count(source) => source,
            Test::Truth(_) => return None,
        };
        let function = &self.plan.functions[self.function];
        let (is_main, is_safe) = match &function.owner {
            Owner::Main => (true, true),
            Owner::Subprogram(diagram) => {
                let is_once = function.threads.len() == 1 && !self.plan.reenters(*diagram);
                (false, is_once && !self.kills)
            }
            Owner::Thread(..) => (false, !self.kills),
        };
        let stays = |tree: &Tree| {
            let mut inner = Vec::new();
            stays_inside(tree, is_main, label, &mut inner)
        };
        let is_clean = is_safe && self.loops.get(&node) == Some(&1) && body.iter().all(stays);
        is_clean.then(|| whole(self.value(node, source)))
    }

    fn switch(
        &mut self,
        on: usize,
        branches: &[(Vec<usize>, Vec<Tree>)],
        out: &mut Vec<Statement>,
    ) {
        let Some(node) = self.node(on) else {
            return;
        };
        let program = self.program;
        let Some(Leads::Switch(switch)) = program.leads(node) else {
            return;
        };
        let on = super::build::text(self.value(node, switch.source));
        let mut other = Vec::new();
        let mut named = Vec::new();
        for (ways, body) in branches {
            let body = self.list(body);
            let guards: Vec<_> = ways
                .iter()
                .filter_map(|&way| switch.branches.get(way))
                .map(|(guard, _)| (**guard).into())
                .collect();
            if ways.contains(&switch.branches.len()) {
                // Guards that lead where all others lead need no branch.
                other = body;
            } else {
                named.push((guards, body));
            }
        }
        out.push(Statement::Switch {
            on,
            branches: named,
            other,
        });
    }
}

fn is_counting(code: &Code) -> bool {
    code.has(&mut |part| matches!(part, Code::Do(Operation::Truth(Truth::Again), _)))
}

/// Whether control stays in the loop that a statement is in until its head is reached again.
fn stays_inside(tree: &Tree, may_end: bool, own: usize, inner: &mut Vec<usize>) -> bool {
    match tree {
        Tree::End(_) => may_end,
        Tree::Goto(_) => false,
        Tree::Break(label) => inner.contains(label),
        Tree::Continue(label) => *label == own || inner.contains(label),
        Tree::Loop { label, .. } | Tree::While { label, .. } | Tree::DoWhile { label, .. } => {
            inner.push(*label);
            let parts = tree.parts();
            let stays = parts
                .into_iter()
                .flatten()
                .all(|part| stays_inside(part, may_end, own, inner));
            inner.pop();
            stays
        }
        Tree::Step(_)
        | Tree::If { .. }
        | Tree::Switch { .. }
        | Tree::Set { .. }
        | Tree::Choice { .. }
        | Tree::Label(_) => {
            let parts = tree.parts();
            parts
                .into_iter()
                .flatten()
                .all(|part| stays_inside(part, may_end, own, inner))
        }
    }
}
