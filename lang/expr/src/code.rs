//! The tree of a text for the machine: one operation for each node, names as slots, literals as values.
//!
//! Made anew when types change, because a few constructs are only allowed for known types. Knows no values of
//! variables.

use super::analyse::Analysis;
use super::escape;
use super::literal;
use super::names::{Kind, Slot};
use super::reserved::{Function, SensorIndex};
use super::tree::{Binary, Id, Node, Unary};
use super::types::Type;
use super::value::{Compat, Value};
use super::words::Reason;
use crate::limits;
use lang_text::problem::Position;

/// What has elements.
#[derive(Clone, Copy, Debug)]
pub(super) enum Base {
    Variable(Slot),
    Sensor(SensorIndex),
    /// A text or a number: it has none.
    Constant,
}

/// One operation; operands are operations by index.
#[derive(Clone, Copy, Debug)]
pub(super) enum Op {
    Nil,
    Bool(bool),
    Int(i32),
    Float(f64),
    /// Index into the constants.
    Constant(u32),
    Variable(Slot),
    Sensor(SensorIndex),
    Minus(Id),
    /// Through a 32-bit float.
    MinusNarrow(Id),
    Not(Id),
    TextLength(Id),
    Length(Id),
    BitNot(Id),
    Binary(Binary, Id, Id),
    /// What has elements, one index.
    Element(Base, Id),
    /// What has elements, several indices in the operands.
    Elements(Base, Span),
    Call(Function, Span),
    /// Pairs of key (or itself, if there is none) and value in the operands.
    Table(Span),
    Block(Span),
    Assign(Slot, Id),
    /// Base, indices and, after them in the operands, the value.
    AssignElement(Base, Span),
    /// Arithmetic: steps that stand for this part and what is below it.
    Steps(Span),
    /// Index into the faults: told when it runs.
    Broken(u32),
}

/// Some operands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) from: u32,
    pub(super) count: u32,
}

/// What one step does to the number on top of the stack. The part that it is of stands beside it, for faults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// A number comes onto the stack.
    Number(f64),
    /// The value of a variable does; its part is asked if that is not simply a number.
    Variable(Slot),
    /// The number of any other part does.
    Part,
    /// The two numbers on top become one.
    Both(Operator),
    /// The number on top and this one become one.
    With(Operator, f64),
    /// This number and the one on top become one.
    Of(f64, Operator),
    /// It changes its sign; 0 has none.
    Minus,
    /// It leaves the stack and becomes the value of a variable.
    Set(Slot),
}

/// How two numbers become one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Min,
    Max,
}

impl Operator {
    /// What the two give, if nothing has to be told.
    pub(super) fn of(self, one: f64, other: f64) -> Option<f64> {
        Some(match self {
            Self::Add => one + other,
            Self::Subtract => one - other,
            Self::Multiply => one * other,
            Self::Divide if other == 0.0 => return None,
            Self::Divide => one / other,
            Self::Power => libm::pow(one, other),
            Self::Min if one < other => one,
            Self::Max if one < other => other,
            Self::Min => other,
            Self::Max => one,
        })
    }
}

/// A text for the machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Code {
    pub(super) ops: Vec<Op>,
    pub(super) places: Vec<Position>,
    pub(super) operands: Vec<Id>,
    pub(super) steps: Vec<Step>,
    /// The part that each step is of.
    pub(super) step_parts: Vec<Id>,
    pub(super) constants: Vec<Value>,
    pub(super) faults: Vec<Reason>,
    pub(super) root: Id,
}

impl Code {
    pub(super) fn operands(&self, span: Span) -> &[Id] {
        let from = span.from as usize;
        self.operands
            .get(from..from + span.count as usize)
            .unwrap_or_default()
    }
}

/// Compiles what an analysis found good.
pub(super) fn compile(analysis: &Analysis<'_>) -> Code {
    let mut compiler = Compiler {
        analysis,
        code: Code::default(),
        is_fixed: analysis.names.compat() == Compat::Fixed,
    };
    for (id, node) in (0..).zip(&analysis.tree.nodes) {
        let op = compiler.op(id, node);
        compiler.code.ops.push(op);
    }
    let mut code = compiler.code;
    code.places.clone_from(&analysis.tree.places);
    code.root = analysis.tree.root.unwrap_or_default();
    code
}

struct Compiler<'a> {
    analysis: &'a Analysis<'a>,
    code: Code,
    is_fixed: bool,
}

impl Compiler<'_> {
    fn constant(&mut self, value: Value) -> Op {
        match value {
            Value::Nil => Op::Nil,
            Value::Bool(truth) => Op::Bool(truth),
            Value::Int(number) => Op::Int(number),
            Value::Float(number) => Op::Float(number),
            value @ (Value::Text(_) | Value::Unset | Value::List(_)) => {
                self.code.constants.push(value);
                Op::Constant(index(self.code.constants.len() - 1))
            }
        }
    }

    fn broken(&mut self, reason: Reason) -> Op {
        self.code.faults.push(reason);
        Op::Broken(index(self.code.faults.len() - 1))
    }

    fn span(&mut self, ids: impl IntoIterator<Item = Id>) -> Span {
        let from = index(self.code.operands.len());
        self.code.operands.extend(ids);
        Span {
            from,
            count: index(self.code.operands.len()) - from,
        }
    }

    fn op(&mut self, id: Id, node: &Node) -> Op {
        let compat = self.analysis.names.compat();
        match node {
            Node::Nil => Op::Nil,
            Node::Bool(truth) => Op::Bool(*truth),
            Node::Int(text) => self.constant(literal::whole(text, compat)),
            Node::Float(text) => Op::Float(literal::float(text, compat)),
            Node::Text(text) => self.constant(Value::Text(text.clone())),
            Node::RawText(text) if self.is_fixed => {
                self.constant(Value::text(escape::unquote(text)))
            }
            Node::RawText(text) => self.constant(Value::Text(text.clone())),
            Node::Name(name) => self.name(name),
            Node::Unary(operator, operand) => self.unary(*operator, *operand),
            Node::Binary(operator, left, right) => Op::Binary(*operator, *left, *right),
            Node::Index { .. } => match self.path(id) {
                Ok((base, path)) if path.len() == 1 => Op::Element(base, path[0]),
                Ok((base, path)) => Op::Elements(base, self.span(path)),
                Err(reason) => self.broken(reason),
            },
            Node::Call {
                function,
                arguments,
            } => {
                let Node::Name(name) = self.analysis.tree.node(*function) else {
                    return self.broken(Reason::IndirectCall);
                };
                let Some((_, Kind::Function(function))) = self.kind(name) else {
                    return self.broken(Reason::UnknownFunction);
                };
                Op::Call(function, self.span(arguments.iter().copied()))
            }
            Node::Method { .. } => self.broken(Reason::NotInterpreted),
            Node::Table { fields, .. } => self.table(fields),
            Node::Assign { target, value } => self.assign(*target, *value),
            Node::Block(statements) => Op::Block(self.span(statements.iter().copied())),
        }
    }

    fn kind(&self, name: &str) -> Option<(Slot, Kind)> {
        let slot = self.analysis.names.find(name)?;
        Some((slot, self.analysis.names.kind(slot)?.clone()))
    }

    fn name(&mut self, name: &str) -> Op {
        match self.kind(name) {
            Some((slot, Kind::Variable)) => Op::Variable(slot),
            Some((_, Kind::Sensor(sensor))) => Op::Sensor(sensor),
            Some((_, Kind::Constant(value))) => self.constant(value),
            // The function's own name in a call: never run.
            Some((_, Kind::Function(_))) | None => Op::Nil,
        }
    }

    fn unary(&self, operator: Unary, operand: Id) -> Op {
        match operator {
            Unary::Minus if self.is_fixed => Op::Minus(operand),
            Unary::Minus => Op::MinusNarrow(operand),
            Unary::Not => Op::Not(operand),
            Unary::Length if self.is_fixed => Op::Length(operand),
            Unary::Length if self.analysis.type_of(operand) == Type::Text => {
                Op::TextLength(operand)
            }
            Unary::Length => Op::Nil,
            Unary::BitNot => Op::BitNot(operand),
        }
    }

    fn is_number(&self, id: Id) -> bool {
        self.is_fixed || matches!(self.analysis.type_of(id), Type::Int | Type::Float)
    }

    /// What an index expression belongs to, and its indices from the first.
    fn path(&self, id: Id) -> Result<(Base, Vec<Id>), Reason> {
        let mut path = Vec::new();
        let mut at = id;
        loop {
            match self.analysis.tree.node(at) {
                Node::Index { table, index } => {
                    if path.len() >= usize::from(limits::LIST_DEPTH_MAX) {
                        return Err(Reason::ValueTooDeep);
                    }
                    path.push(*index);
                    at = *table;
                }
                Node::Name(name) => {
                    if !path.iter().all(|&index| self.is_number(index)) {
                        return Err(Reason::IndexNotNumber);
                    }
                    path.reverse();
                    let base = match self.kind(name) {
                        Some((slot, Kind::Variable)) => Base::Variable(slot),
                        Some((_, Kind::Sensor(sensor))) => Base::Sensor(sensor),
                        Some((_, Kind::Constant(_) | Kind::Function(_))) | None => Base::Constant,
                    };
                    return Ok((base, path));
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
                | Node::Block(_) => return Err(Reason::IndexOfValue),
            }
        }
    }

    fn table(&mut self, fields: &[super::tree::Field]) -> Op {
        for field in fields {
            if let Some(key) = field.key
                && !self.is_number(key)
            {
                return self.broken(Reason::KeyNotNumber);
            }
        }
        let pairs = fields
            .iter()
            .flat_map(|field| [field.key.unwrap_or(field.value), field.value]);
        Op::Table(self.span(pairs))
    }

    fn assign(&mut self, target: Id, value: Id) -> Op {
        match self.analysis.tree.node(target) {
            Node::Name(name) => match self.kind(name) {
                Some((slot, Kind::Variable)) => Op::Assign(slot, value),
                Some((_, Kind::Sensor(_) | Kind::Constant(_) | Kind::Function(_))) | None => {
                    self.broken(Reason::ReadOnly(name.to_string()))
                }
            },
            Node::Index { .. } => match self.path(target) {
                Ok((Base::Variable(slot), path)) => {
                    let span = self.span(path.into_iter().chain([value]));
                    Op::AssignElement(Base::Variable(slot), span)
                }
                Ok(_) => self.broken(Reason::ReadOnly(String::new())),
                Err(reason) => self.broken(reason),
            },
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
            | Node::Block(_) => self.broken(Reason::NotInterpreted),
        }
    }
}

fn index(position: usize) -> u32 {
    u32::try_from(position).unwrap_or(u32::MAX)
}
