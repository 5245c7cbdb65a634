//! Expressions in the words of a language: each part is asked for what its user needs, as [`lang_expr`] runs it.
//!
//! Owns what an expression is in another language. Conversions that can fail are calls of helpers, which know the words
//! of the failure. Knows no language: its words are a table of [`super::language`].

mod demands;
mod lists;
mod operators;

use super::language::{Word, row};
use super::plan::Plan;
use super::step::Step;
use super::words;
use crate::limits;
use crate::program::{Formula, Text};
use lang_diagram::generate::row::{ATOM, fill};
use lang_expr::reserved::Function;
use lang_expr::tree::{Binary, Id, Node, Unary};
use lang_expr::{Compat, Kind, Names, Source, Value, literal};
use lang_text::problem::Words;
use operators::{arithmetic, of_wholes};
use std::rc::Rc;

/// Words that stand for a value, and how strongly they bind.
#[derive(Clone, Debug)]
pub(super) struct Phrase {
    pub text: String,
    binds: u8,
}

impl Phrase {
    /// A name, or anything else that nothing takes apart.
    pub(super) fn atom(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            binds: ATOM,
        }
    }
}

/// A text that cannot be written.
struct Refused {
    words: Words,
    id: Id,
}

/// One text while it is written.
struct Writer<'a, 'p> {
    plan: &'a mut Plan<'p>,
    names: Names,
    source: Source,
    text: &'a Text,
}

/// The statements of a text, and its value if it has one.
pub(super) fn text(plan: &mut Plan<'_>, formula: Formula) -> (Vec<Step>, Option<Phrase>) {
    written(plan, formula, |writer, id| writer.value(id, 0))
}

/// The statements of a text before its last one, and that as a truth.
pub(super) fn truth(plan: &mut Plan<'_>, formula: Formula) -> (Vec<Step>, Phrase) {
    let (steps, said) = written(plan, formula, |writer, id| writer.truth(id, 0));
    let never = row(plan.target, Word::No).text;
    (steps, said.unwrap_or_else(|| Phrase::atom(never)))
}

fn written(
    plan: &mut Plan<'_>,
    formula: Formula,
    last: impl Fn(&mut Writer<'_, '_>, Id) -> Result<Phrase, Refused>,
) -> (Vec<Step>, Option<Phrase>) {
    let program = plan.program;
    let text = &program.formulas[formula as usize];
    let mut writer = Writer {
        names: crate::sensors::names_of(program.kit),
        source: Source::new(&text.text, text.wanted),
        plan,
        text,
    };
    let mut steps = writer.needs();
    match writer.statements(&mut steps, last) {
        Ok(value) => (steps, value),
        Err(refused) => {
            let at = writer.source.tree().place(refused.id);
            let place = program.property_place(text.node, text.property, Some(at));
            writer.plan.problem(place, refused.words);
            (steps, None)
        }
    }
}

/// Names of a node's own, as fields.
fn own(name: &str) -> &'static str {
    let all = crate::lower::INPUTS.iter().chain(crate::lower::DATA);
    let mut all = all.filter(|one| **one == name);
    all.next().copied().unwrap_or("data")
}

impl Writer<'_, '_> {
    /// Own names must have values before a text runs; where it may leave a side of `and` or `or` out, that is asked first.
    fn needs(&mut self) -> Vec<Step> {
        let tree = self.source.tree();
        let leaves_out = tree
            .nodes
            .iter()
            .any(|node| matches!(node, Node::Binary(Binary::And | Binary::Or, ..)));
        let read: Vec<&str> = match leaves_out {
            true => self.text.own.to_vec(),
            false => Vec::new(),
        };
        let is_read = |name: &&str| self.source.names().any(|one| one == *name);
        let read: Vec<&str> = read.into_iter().filter(is_read).collect();
        let asked = read.into_iter().map(|name| {
            let field = self.plan.value_of(self.text.node, own(name));
            let needed = self.say(Word::NeedsValue, &[self.field(field)]);
            Step::Do(self.say(Word::Ignore, &[needed]).text)
        });
        let mut steps: Vec<Step> = asked.collect();
        steps.extend(self.demands(leaves_out));
        steps
    }

    /// Whether a name is one of a token or of a variable.
    fn is_changing(&self, name: &str) -> bool {
        let slot = self.names.find(name);
        let kind = slot.and_then(|slot| self.names.kind(slot));
        self.text.own.contains(&name) || matches!(kind, None | Some(Kind::Variable))
    }

    fn statements(
        &mut self,
        steps: &mut Vec<Step>,
        last: impl Fn(&mut Self, Id) -> Result<Phrase, Refused>,
    ) -> Result<Option<Phrase>, Refused> {
        let all = self.source.tree().statements();
        let Some((&end, others)) = all.split_last() else {
            return Ok(None);
        };
        for &statement in others {
            if let Some(value) = self.statement(statement, steps)? {
                steps.push(Step::Do(self.say(Word::Ignore, &[value]).text));
            }
        }
        match self.source.tree().node(end) {
            Node::Assign { .. } => self.statement(end, steps),
            Node::Nil
            | Node::Bool(_)
            | Node::Int(_)
            | Node::Float(_)
            | Node::Text(_)
            | Node::RawText(_)
            | Node::Name(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Index { .. }
            | Node::Call { .. }
            | Node::Method { .. }
            | Node::Table { .. }
            | Node::Block(_) => last(self, end).map(Some),
        }
    }

    /// An assignment, or the value of what is none.
    fn statement(&mut self, id: Id, steps: &mut Vec<Step>) -> Result<Option<Phrase>, Refused> {
        let Node::Assign { target, value } = self.source.tree().node(id).clone() else {
            return self.value(id, 0).map(Some);
        };
        let value = self.value(value, 0)?;
        match self.source.tree().node(target).clone() {
            Node::Name(name) => {
                let field = self.target(&name);
                steps.push(Step::Set(field.text, value.text));
            }
            Node::Index { table, index } => {
                let Node::Name(name) = self.source.tree().node(table).clone() else {
                    return Err(self.refuse(table, words::no_nested_lists()));
                };
                self.makes_room(index);
                let index = self.index(index, 0)?;
                let field = self.target(&name);
                let put = self.say(Word::Put, &[field.clone(), index, value]);
                steps.push(Step::Set(field.text, put.text));
            }
            Node::Nil
            | Node::Bool(_)
            | Node::Int(_)
            | Node::Float(_)
            | Node::Text(_)
            | Node::RawText(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Call { .. }
            | Node::Method { .. }
            | Node::Table { .. }
            | Node::Assign { .. }
            | Node::Block(_) => return Err(self.refuse(target, words::no_such_text())),
        }
        Ok(None)
    }

    fn refuse(&self, id: Id, words: Words) -> Refused {
        Refused { words, id }
    }

    /// An operation with its operands.
    fn say(&self, word: Word, operands: &[Phrase]) -> Phrase {
        let row = row(self.plan.target, word);
        if let ("$1", [same]) = (row.text, operands) {
            return same.clone();
        }
        let said = operands.iter().enumerate().map(|(at, operand)| {
            match operand.binds < row.needs.get(at).copied().unwrap_or(0) {
                true => format!("({})", operand.text),
                false => operand.text.clone(),
            }
        });
        let said: Vec<String> = said.collect();
        let said: Vec<&str> = said.iter().map(String::as_str).collect();
        Phrase {
            text: fill(row.text, &said),
            binds: row.binds,
        }
    }

    /// A field by its name.
    fn field(&self, name: String) -> Phrase {
        self.say(Word::Field, &[Phrase::atom(name)])
    }

    /// What an assignment to a name changes: an own name of the block is nobody else's.
    fn target(&mut self, name: &Rc<str>) -> Phrase {
        match self.text.own.contains(&&**name) {
            true => {
                let field = self.plan.value_of(self.text.node, own(name));
                self.field(field)
            }
            false => self.variable(name),
        }
    }

    fn variable(&mut self, name: &Rc<str>) -> Phrase {
        let name = self.plan.variable(name);
        self.field(name)
    }

    fn literal(&self, value: &Value) -> Phrase {
        let number = super::language::number(self.plan.target, value);
        let is_negative = number.starts_with('-');
        Phrase {
            text: number,
            binds: if is_negative { 0 } else { ATOM },
        }
    }

    /// As a number.
    fn number(&mut self, id: Id, depth: usize) -> Result<Phrase, Refused> {
        let depth = self.deeper(id, depth)?;
        Ok(match self.source.tree().node(id).clone() {
            Node::Int(text) => self.literal(&literal::whole(&text, Compat::Fixed)),
            Node::Float(text) => self.literal(&Value::Float(literal::float(&text, Compat::Fixed))),
            Node::Unary(Unary::Minus, operand) => {
                let operand = self.number(operand, depth)?;
                self.say(Word::Minus, &[operand])
            }
            Node::Unary(Unary::Not, _) => {
                let truth = self.truth(id, depth)?;
                self.say(Word::NumberOfTruth, &[truth])
            }
            Node::Unary(Unary::BitNot, _) => self.whole(id, depth)?,
            Node::Binary(operator, left, right) => match arithmetic(operator) {
                Some(word) => {
                    // A long sum nests nothing: its left side needs no brackets.
                    let operands = [self.number(left, depth - 1)?, self.number(right, depth)?];
                    self.say(word, &operands)
                }
                None if of_wholes(operator).is_some() => self.whole(id, depth)?,
                None => {
                    let truth = self.truth(id, depth)?;
                    self.say(Word::NumberOfTruth, &[truth])
                }
            },
            Node::Call {
                function,
                arguments,
            } => self.call(id, function, &arguments, depth)?,
            Node::Nil
            | Node::Bool(_)
            | Node::Text(_)
            | Node::RawText(_)
            | Node::Unary(Unary::Length, _)
            | Node::Method { .. }
            | Node::Table { .. }
            | Node::Assign { .. }
            | Node::Block(_) => {
                let value = self.value(id, depth)?;
                self.say(Word::Number, &[value])
            }
            Node::Index { table, index } => {
                self.item(id, (table, index), Word::NumberOfItem, depth)?
            }
            Node::Name(name) => match self.constant(id) {
                Some(number) => self.literal(&number),
                None => {
                    let value = self.name(id, &name)?;
                    self.say(Word::Number, &[value])
                }
            },
        })
    }

    /// The number that a name always stands for.
    fn constant(&self, id: Id) -> Option<Value> {
        let Node::Name(name) = self.source.tree().node(id) else {
            return None;
        };
        let slot = self.names.find(name)?;
        match self.names.kind(slot)? {
            Kind::Constant(value @ (Value::Int(_) | Value::Float(_))) => Some(value.clone()),
            Kind::Constant(_) | Kind::Variable | Kind::Sensor(_) | Kind::Function(_) => None,
        }
    }

    /// As a whole number.
    fn whole(&mut self, id: Id, depth: usize) -> Result<Phrase, Refused> {
        let depth = self.deeper(id, depth)?;
        Ok(match self.source.tree().node(id).clone() {
            Node::Int(text) => {
                let number = literal::whole(&text, Compat::Fixed).to_int();
                self.literal(&Value::Int(number))
            }
            Node::Unary(Unary::BitNot, operand) => {
                let operand = self.whole(operand, depth)?;
                self.say(Word::BitNot, &[operand])
            }
            Node::Binary(operator, left, right) if let Some(word) = of_wholes(operator) => {
                let operands = [self.whole(left, depth)?, self.whole(right, depth)?];
                self.say(word, &operands)
            }
            Node::Nil
            | Node::Bool(_)
            | Node::Float(_)
            | Node::Text(_)
            | Node::RawText(_)
            | Node::Name(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Index { .. }
            | Node::Call { .. }
            | Node::Method { .. }
            | Node::Table { .. }
            | Node::Assign { .. }
            | Node::Block(_) => {
                let number = self.number(id, depth)?;
                self.say(Word::Whole, &[number])
            }
        })
    }

    /// As a truth.
    fn truth(&mut self, id: Id, depth: usize) -> Result<Phrase, Refused> {
        let depth = self.deeper(id, depth)?;
        let (operator, left, right) = match self.source.tree().node(id).clone() {
            Node::Bool(truth) => {
                let word = if truth { Word::Yes } else { Word::No };
                return Ok(self.say(word, &[]));
            }
            Node::Unary(Unary::Not, operand) => {
                let operand = self.truth(operand, depth)?;
                return Ok(self.say(Word::Not, &[operand]));
            }
            Node::Binary(operator, left, right) => (operator, left, right),
            Node::Nil
            | Node::Int(_)
            | Node::Float(_)
            | Node::Text(_)
            | Node::RawText(_)
            | Node::Name(_)
            | Node::Unary(..)
            | Node::Index { .. }
            | Node::Call { .. }
            | Node::Method { .. }
            | Node::Table { .. }
            | Node::Assign { .. }
            | Node::Block(_) => return self.truth_of_value(id, depth),
        };
        let order = match operator {
            Binary::And => return self.both(Word::And, left, right, depth),
            Binary::Or => return self.both(Word::Or, left, right, depth),
            Binary::Equal => return self.same(left, right, depth),
            Binary::NotEqual => {
                let same = self.same(left, right, depth)?;
                return Ok(self.say(Word::Not, &[same]));
            }
            Binary::Less => Word::Less,
            Binary::Greater => Word::Greater,
            Binary::LessEqual => Word::LessEqual,
            Binary::GreaterEqual => Word::GreaterEqual,
            Binary::BitOr
            | Binary::BitXor
            | Binary::BitAnd
            | Binary::ShiftLeft
            | Binary::ShiftRight
            | Binary::Join
            | Binary::Add
            | Binary::Subtract
            | Binary::Multiply
            | Binary::Divide
            | Binary::DivideWhole
            | Binary::Modulo
            | Binary::Power => return self.truth_of_value(id, depth),
        };
        let sides = [self.number(left, depth)?, self.number(right, depth)?];
        Ok(self.say(order, &sides))
    }

    fn both(&mut self, word: Word, left: Id, right: Id, depth: usize) -> Result<Phrase, Refused> {
        let sides = [self.truth(left, depth)?, self.truth(right, depth)?];
        Ok(self.say(word, &sides))
    }

    fn same(&mut self, left: Id, right: Id, depth: usize) -> Result<Phrase, Refused> {
        let sides = [self.value(left, depth)?, self.value(right, depth)?];
        Ok(self.say(Word::Same, &sides))
    }

    fn truth_of_value(&mut self, id: Id, depth: usize) -> Result<Phrase, Refused> {
        let value = self.value(id, depth)?;
        Ok(self.say(Word::Truth, &[value]))
    }

    /// As it is.
    fn value(&mut self, id: Id, depth: usize) -> Result<Phrase, Refused> {
        let depth = self.deeper(id, depth)?;
        Ok(match self.source.tree().node(id).clone() {
            Node::Nil => self.say(Word::Unit, &[]),
            Node::Bool(_) | Node::Unary(Unary::Not, _) => {
                let truth = self.truth(id, depth)?;
                self.say(Word::ValueOfTruth, &[truth])
            }
            Node::Text(_) | Node::RawText(_) => return Err(self.refuse(id, words::no_texts())),
            Node::Name(name) => {
                // One that has no value yet is a mistake also where nothing computes with it.
                let value = self.name(id, &name)?;
                match self.constant(id) {
                    Some(_) => value,
                    None => self.say(Word::NeedsValue, &[value]),
                }
            }
            Node::Unary(Unary::Length, operand) => {
                let operand = self.value(operand, depth)?;
                let length = self.say(Word::Length, &[operand]);
                self.say(Word::ValueOfNumber, &[length])
            }
            Node::Int(_)
            | Node::Float(_)
            | Node::Unary(Unary::Minus | Unary::BitNot, _)
            | Node::Call { .. } => {
                let number = self.number(id, depth)?;
                self.say(Word::ValueOfNumber, &[number])
            }
            Node::Binary(Binary::Join, ..) => return Err(self.refuse(id, words::no_texts())),
            Node::Binary(operator, ..)
                if arithmetic(operator).is_some() || of_wholes(operator).is_some() =>
            {
                let number = self.number(id, depth)?;
                self.say(Word::ValueOfNumber, &[number])
            }
            Node::Binary(..) => {
                let truth = self.truth(id, depth)?;
                self.say(Word::ValueOfTruth, &[truth])
            }
            Node::Index { table, index } => self.item(id, (table, index), Word::Item, depth)?,
            Node::Table { fields, .. } => self.table(id, &fields, depth)?,
            Node::Method { .. } | Node::Assign { .. } | Node::Block(_) => {
                return Err(self.refuse(id, words::no_such_text()));
            }
        })
    }

    fn name(&mut self, id: Id, name: &Rc<str>) -> Result<Phrase, Refused> {
        if self.text.own.contains(&&**name) {
            return Ok(self.target(name));
        }
        let slot = self.names.find(name);
        match slot.and_then(|slot| self.names.kind(slot)).cloned() {
            None | Some(Kind::Variable) => Ok(self.variable(name)),
            Some(Kind::Sensor(sensor)) => {
                self.plan.needs(sensor);
                Ok(self.field(self.plan.reading(sensor)))
            }
            Some(Kind::Constant(value @ (Value::Int(_) | Value::Float(_)))) => {
                let number = self.literal(&value);
                Ok(self.say(Word::ValueOfNumber, &[number]))
            }
            Some(Kind::Constant(_)) => Err(self.refuse(id, words::no_texts())),
            Some(Kind::Function(_)) => Err(self.refuse(id, words::no_such_text())),
        }
    }

    /// What a function gives, as a number.
    fn call(
        &mut self,
        id: Id,
        function: Id,
        arguments: &[Id],
        depth: usize,
    ) -> Result<Phrase, Refused> {
        let Node::Name(name) = self.source.tree().node(function) else {
            return Err(self.refuse(id, words::no_such_text()));
        };
        let kind = self.names.find(name).and_then(|slot| self.names.kind(slot));
        let Some(Kind::Function(function)) = kind.cloned() else {
            return Err(self.refuse(id, words::no_such_text()));
        };
        match function {
            Function::Random => return Err(self.refuse(id, words::no_chance())),
            Function::Print | Function::Sensor => return Err(self.refuse(id, words::no_texts())),
            Function::Time
            | Function::Sin
            | Function::Cos
            | Function::Ln
            | Function::Exp
            | Function::Asin
            | Function::Acos
            | Function::Atan
            | Function::Sgn
            | Function::Sqrt
            | Function::Abs
            | Function::Ceil
            | Function::Floor
            | Function::Min
            | Function::Max
            | Function::Atan2 => {}
        }
        let mut operands = Vec::with_capacity(2);
        for &argument in arguments {
            operands.push(self.number(argument, depth)?);
        }
        Ok(self.say(Word::Math(function), &operands))
    }

    fn deeper(&self, id: Id, depth: usize) -> Result<usize, Refused> {
        match depth < limits::GENERATED_DEPTH_MAX {
            true => Ok(depth + 1),
            false => Err(self.refuse(id, words::too_deep(limits::GENERATED_DEPTH_MAX))),
        }
    }
}
