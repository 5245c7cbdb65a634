//! Texts of the language of expressions as code: types are found, and each operation becomes the plainest one that does
//! the same.
//!
//! Owns where plain operators of other languages would do something else: texts as numbers, truths by rounding, minus
//! through a small float. Knows no language.

use std::collections::HashMap;
use std::rc::Rc;

use super::code::{
    Code, Conversion, Element, Function, Kind, Number, Operation, Robot, Truth, Typed,
};
use super::{readings, words};
use crate::limits;
use crate::ports::{Direction, Kit, Port};
use lang_expr::tree::{Binary, Field, Id, Node, Tree, Unary};
use lang_expr::value::{Compat, round};
use lang_text::problem::{Position, Words};

/// A variable of the program.
#[derive(Clone, Debug)]
pub(super) struct Variable {
    pub(super) name: Rc<str>,
    /// Nothing: no value was seen yet.
    pub(super) kind: Option<Kind>,
}

/// All variables; kinds grow until nothing changes.
#[derive(Clone, Debug, Default)]
pub(super) struct Variables {
    pub(super) all: Vec<Variable>,
    numbers: HashMap<Rc<str>, usize>,
    pub(super) changed: bool,
}

/// What is wrong, and where in the text.
pub(super) struct Wrong {
    pub(super) words: Words,
    pub(super) at: Position,
}

/// What is needed to understand a text.
pub(super) struct Builder<'a> {
    pub(super) tree: &'a Tree,
    pub(super) variables: &'a mut Variables,
    pub(super) kit: Kit,
    pub(super) compat: Compat,
}

impl Variables {
    /// The number of a name that has a value somewhere.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.numbers.get(name).copied()
    }

    /// The number of a name that gets a value.
    pub(super) fn declare(&mut self, name: &str) -> usize {
        if let Some(number) = self.find(name) {
            return number;
        }
        let name: Rc<str> = name.into();
        self.numbers.insert(name.clone(), self.all.len());
        self.all.push(Variable { name, kind: None });
        self.changed = true;
        self.all.len() - 1
    }

    /// A variable may have values of this kind.
    pub(super) fn takes(&mut self, number: usize, kind: &Kind) {
        let known = &mut self.all[number].kind;
        let new = known
            .as_ref()
            .map_or_else(|| kind.clone(), |known| known.or(kind));
        if known.as_ref() != Some(&new) {
            *known = Some(new);
            self.changed = true;
        }
    }

    fn kind(&self, number: usize) -> Kind {
        self.all[number].kind.clone().unwrap_or(Kind::Any)
    }
}

fn typed(code: Code, kind: Kind) -> Typed {
    Typed { code, kind }
}

fn int(operation: impl Into<Operation>, operands: impl Into<Vec<Code>>) -> Typed {
    typed(Code::does(operation, operands), Kind::Int)
}

fn float(operation: impl Into<Operation>, operands: impl Into<Vec<Code>>) -> Typed {
    typed(Code::does(operation, operands), Kind::Float)
}

fn truth_of(operation: Truth, operands: impl Into<Vec<Code>>) -> Typed {
    typed(Code::does(operation, operands), Kind::Bool)
}

/// A value as a number.
pub(super) fn number(value: Typed) -> Code {
    if value.code == Code::Nil {
        return Code::Int(0);
    }
    match value.kind {
        Kind::Int | Kind::Float => value.code,
        Kind::Bool => Code::does(Conversion::WholeOfBool, [value.code]),
        Kind::Any | Kind::Text | Kind::List(_) => Code::does(Conversion::NumberOfAny, [value.code]),
    }
}

/// A value as a number that may have a fraction.
pub(super) fn real(value: Typed) -> Code {
    if value.kind == Kind::Float {
        return value.code;
    }
    Code::does(Conversion::FloatOfInt, [number(value)])
}

/// A value as a whole number.
pub(super) fn whole(value: Typed) -> Code {
    match (value.kind, value.code) {
        (Kind::Int, code) => code,
        (_, Code::Float(number)) => Code::Int(round(number).into()),
        (_, Code::Nil) => Code::Int(0),
        (Kind::Float, code) => Code::does(Conversion::WholeOfFloat, [code]),
        (Kind::Bool, code) => Code::does(Conversion::WholeOfBool, [code]),
        (_, code) => Code::does(Conversion::WholeOfAny, [code]),
    }
}

/// A value as a truth, as a condition sees it.
pub(super) fn truth(value: Typed) -> Code {
    if value.code == Code::Nil {
        return Code::Bool(false);
    }
    match value.kind {
        Kind::Bool => value.code,
        Kind::Int => Code::does(Truth::NotEqual, [value.code, Code::Int(0)]),
        Kind::Float => Code::does(Truth::NotEqual, [whole(value), Code::Int(0)]),
        Kind::Any | Kind::Text | Kind::List(_) => Code::does(Conversion::TruthOfAny, [value.code]),
    }
}

/// A value as a text.
pub(super) fn text(value: Typed) -> Code {
    match (value.kind, value.code) {
        (_, Code::Int(number)) => Code::Text(number.to_string().into()),
        (_, Code::Port(name)) => Code::Text(name),
        (_, Code::Nil) => Code::Text("".into()),
        (Kind::Text, code) => code,
        // An element that is not there has no digits.
        (_, code @ Code::Do(Operation::Element(Element::At | Element::AtWhole), _)) => {
            Code::does(Conversion::TextOfAny, [code])
        }
        (Kind::Int, code) => Code::does(Conversion::TextOfInt, [code]),
        (Kind::Float, code) => Code::does(Conversion::TextOfFloat, [code]),
        (Kind::Bool, code) => Code::does(Conversion::TextOfBool, [code]),
        (_, code) => Code::does(Conversion::TextOfAny, [code]),
    }
}

impl Builder<'_> {
    fn wrong<T>(&self, id: Id, words: Words) -> Result<T, Wrong> {
        Err(Wrong {
            words,
            at: self.tree.place(id),
        })
    }

    /// What an expression gives.
    pub(super) fn value(&mut self, id: Id) -> Result<Typed, Wrong> {
        self.within(id, 0)
    }

    fn within(&mut self, id: Id, depth: usize) -> Result<Typed, Wrong> {
        if depth > limits::GENERATED_DEPTH_MAX {
            return self.wrong(id, words::too_deep());
        }
        let depth = depth + 1;
        Ok(match self.tree.node(id) {
            Node::Nil => typed(Code::Nil, Kind::Any),
            Node::Bool(truth) => typed(Code::Bool(*truth), Kind::Bool),
            Node::Int(text) => literal(text),
            Node::Float(text) => match float_of(text) {
                Some(number) => typed(Code::Float(number), Kind::Float),
                None => return self.wrong(id, words::bad_number(text)),
            },
            Node::Text(text) | Node::RawText(text) => typed(Code::Text(text.clone()), Kind::Text),
            Node::Name(name) => {
                let name = name.clone();
                self.name(id, &name)?
            }
            Node::Unary(operator, operand) => {
                let (operator, operand) = (*operator, *operand);
                let value = self.within(operand, depth)?;
                self.unary(operator, value)
            }
            Node::Binary(operator, left, right) => {
                let (operator, left, right) = (*operator, *left, *right);
                let left = self.within(left, depth)?;
                let right = self.within(right, depth)?;
                self.binary(operator, left, right)
            }
            Node::Index { table, index } => {
                let (table, index) = (*table, *index);
                let table = self.within(table, depth)?;
                let index = self.within(index, depth)?;
                element(table, whole(index))
            }
            Node::Call {
                function,
                arguments,
            } => self.call(id, *function, arguments, depth)?,
            Node::Table { fields, .. } => self.table(fields, depth)?,
            Node::Method { .. } | Node::Assign { .. } | Node::Block(_) => {
                return self.wrong(id, words::no_value());
            }
        })
    }

    fn name(&mut self, id: Id, name: &str) -> Result<Typed, Wrong> {
        if let Some(number) = self.variables.find(name) {
            return Ok(typed(Code::Variable(number), self.variables.kind(number)));
        }
        if let Some(port) = Port::shown_by(name) {
            return Ok(readings::of(port));
        }
        if name == "pi" {
            return Ok(float(Function::Pi, []));
        }
        let button = lang_expr::reserved::BUTTONS
            .iter()
            .find(|(known, _)| *known == name);
        if let Some((_, code)) = button {
            return Ok(typed(Code::Int((*code).into()), Kind::Int));
        }
        let way = [Direction::Out, Direction::In];
        let port = way
            .into_iter()
            .find_map(|way| Port::find(self.kit, name, way));
        if let Some(port) = port {
            return Ok(typed(Code::Port(port.name().into()), Kind::Text));
        }
        if name.ends_with("Port") || name == "MAll" {
            return Ok(typed(Code::Text(name.into()), Kind::Text));
        }
        self.wrong(id, words::no_value_ever(name))
    }

    fn unary(&self, operator: Unary, value: Typed) -> Typed {
        match operator {
            Unary::Minus => self.minus(value),
            Unary::Not => {
                let value = truth(value);
                if let Code::Do(Operation::Truth(Truth::Not), inner) = &value
                    && let [inner] = &inner[..]
                {
                    return typed(inner.clone(), Kind::Bool);
                }
                truth_of(Truth::Not, [value])
            }
            Unary::Length => int(Conversion::Length, [text(value)]),
            Unary::BitNot => int(Number::BitNot, [whole(value)]),
        }
    }

    fn minus(&self, value: Typed) -> Typed {
        const EXACT: i64 = 1 << 24;
        let is_exact = self.compat == Compat::Fixed;
        let kind = if value.kind == Kind::Int {
            Kind::Int
        } else {
            Kind::Float
        };
        let code = match number(value) {
            Code::Int(whole) if is_exact || whole.abs() <= EXACT => Code::Int(-whole),
            #[expect(
                clippy::cast_precision_loss,
                reason = "that is what the original loses"
            )]
            Code::Int(whole) => Code::Float(f64::from(-(whole as f32))),
            Code::Float(number) if is_exact => Code::Float(-number),
            #[expect(
                clippy::cast_possible_truncation,
                reason = "that is what the original loses"
            )]
            Code::Float(number) => Code::Float(f64::from(-(number as f32))),
            code @ (Code::Bool(_)
            | Code::Text(_)
            | Code::Nil
            | Code::Port(_)
            | Code::Variable(_)
            | Code::Own(..)
            | Code::Function(_)
            | Code::Do(..)
            | Code::List(_)) => {
                let is_plain = is_exact || kind == Kind::Int;
                let minus = if is_plain {
                    Number::Negate
                } else {
                    Number::NegateSingle
                };
                Code::does(minus, [code])
            }
        };
        typed(code, kind)
    }

    fn binary(&self, operator: Binary, left: Typed, right: Typed) -> Typed {
        let arithmetic = |what| {
            let is_whole = left.kind == Kind::Int && right.kind == Kind::Int;
            if is_whole {
                return int(what, [left.code.clone(), right.code.clone()]);
            }
            float(what, [real(left.clone()), real(right.clone())])
        };
        let bits = |what| int(what, [whole(left.clone()), whole(right.clone())]);
        let order = |what| {
            let is_real = left.kind == Kind::Float || right.kind == Kind::Float;
            let as_wanted = if is_real { real } else { number };
            truth_of(what, [as_wanted(left.clone()), as_wanted(right.clone())])
        };
        // By way of whole numbers, as the original has it.
        let by_whole = |value: &Typed| {
            if value.kind == Kind::Bool {
                return value.code.clone();
            }
            Code::does(Truth::NotEqual, [whole(value.clone()), Code::Int(0)])
        };
        let both = |what| truth_of(what, [by_whole(&left), by_whole(&right)]);
        match operator {
            Binary::Or => both(Truth::Or),
            Binary::And => both(Truth::And),
            Binary::Less => order(Truth::Less),
            Binary::Greater => order(Truth::Greater),
            Binary::LessEqual => order(Truth::LessEqual),
            Binary::GreaterEqual => order(Truth::GreaterEqual),
            Binary::Equal => equal(
                left,
                right,
                [Truth::Equal, Truth::EqualText, Truth::EqualAny],
            ),
            Binary::NotEqual => equal(
                left,
                right,
                [Truth::NotEqual, Truth::NotEqualText, Truth::NotEqualAny],
            ),
            Binary::BitOr => bits(Number::BitOr),
            Binary::BitXor => bits(Number::BitXor),
            Binary::BitAnd => bits(Number::BitAnd),
            Binary::ShiftLeft => bits(Number::ShiftLeft),
            Binary::ShiftRight => bits(Number::ShiftRight),
            Binary::Join => typed(
                Code::does(Conversion::Join, [text(left), text(right)]),
                Kind::Text,
            ),
            Binary::Add => arithmetic(Number::Add),
            Binary::Subtract => arithmetic(Number::Subtract),
            Binary::Multiply => arithmetic(Number::Multiply),
            Binary::Divide => {
                let right = number(right.clone());
                let is_plain = matches!(right, Code::Int(number) if number != 0)
                    || matches!(right, Code::Float(number) if number != 0.0);
                let what = if is_plain {
                    Number::DividePlain
                } else {
                    Number::Divide
                };
                float(what, [real(left), real_literal(right)])
            }
            Binary::DivideWhole => bits(Number::DivideWhole),
            Binary::Modulo => bits(Number::Modulo),
            Binary::Power => float(Number::Power, [real(left), real(right)]),
        }
    }

    fn table(&mut self, fields: &[Field], depth: usize) -> Result<Typed, Wrong> {
        let mut kind: Option<Kind> = None;
        let mut codes = Vec::with_capacity(fields.len());
        for field in fields {
            let value = self.within(field.value, depth)?;
            // The original keeps the text of what has an index.
            let value = if field.key.is_some() {
                typed(text(value), Kind::Text)
            } else {
                value
            };
            kind = Some(kind.map_or_else(|| value.kind.clone(), |kind| kind.or(&value.kind)));
            codes.push(value.code);
        }
        let kind = Kind::List(Box::new(kind.unwrap_or(Kind::Any)));
        Ok(typed(Code::List(codes), kind))
    }

    fn call(
        &mut self,
        id: Id,
        function: Id,
        arguments: &[Id],
        depth: usize,
    ) -> Result<Typed, Wrong> {
        let Node::Name(name) = self.tree.node(function) else {
            return self.wrong(id, words::no_value());
        };
        let name = name.clone();
        let known = lang_expr::reserved::FUNCTIONS
            .iter()
            .find(|(known, ..)| **known == *name);
        let Some((_, _, wanted, _)) = known else {
            return self.wrong(id, words::unknown_function(&name));
        };
        if wanted.len() != arguments.len() {
            return self.wrong(id, words::wrong_count(&name, wanted.len()));
        }
        let mut values = Vec::new();
        for &argument in arguments {
            values.push(self.within(argument, depth)?);
        }
        let mut values = values.into_iter();
        let mut next = || values.next().unwrap_or(typed(Code::Nil, Kind::Any));
        let unary = match &*name {
            "time" => return Ok(int(Function::Time, [])),
            "print" => return Ok(typed(Code::does(Robot::Print, [text(next())]), Kind::Any)),
            "random" => {
                let count = whole(next());
                let below = if let Code::Int(count) = count {
                    Code::Int(count - 1)
                } else {
                    Code::does(Number::Subtract, [count, Code::Int(1)])
                };
                return Ok(int(Function::Random, [Code::Int(0), below]));
            }
            "sensor" => return self.sensor(id, next()),
            "sgn" => return Ok(int(Function::Sgn, [real(next())])),
            "ceil" => return Ok(int(Function::Ceil, [real(next())])),
            "floor" => return Ok(int(Function::Floor, [real(next())])),
            "min" => return Ok(float(Function::Min, [real(next()), real(next())])),
            "max" => return Ok(float(Function::Max, [real(next()), real(next())])),
            "atan2" => return Ok(float(Function::Atan2, [real(next()), real(next())])),
            "sin" => Function::Sin,
            "cos" => Function::Cos,
            "ln" => Function::Ln,
            "exp" => Function::Exp,
            "asin" => Function::Asin,
            "acos" => Function::Acos,
            "atan" => Function::Atan,
            "sqrt" => Function::Sqrt,
            "abs" => Function::Abs,
            _ => return self.wrong(id, words::unknown_function(&name)),
        };
        Ok(float(unary, [real(next())]))
    }

    fn sensor(&self, id: Id, port: Typed) -> Result<Typed, Wrong> {
        let (Code::Text(name) | Code::Port(name)) = &port.code else {
            return self.wrong(id, words::port_must_be_plain());
        };
        match Port::find(self.kit, name, Direction::In) {
            Some(port) => Ok(readings::of(port)),
            None => self.wrong(id, words::unknown_port(name)),
        }
    }

    /// The variable and the indices of what is assigned to.
    pub(super) fn target(&mut self, id: Id) -> Result<(Rc<str>, Vec<Code>), Wrong> {
        if let Node::Name(name) = self.tree.node(id) {
            return Ok((name.clone(), Vec::new()));
        }
        let Node::Index { table, index } = self.tree.node(id) else {
            return self.wrong(id, words::no_target());
        };
        let (table, index) = (*table, *index);
        let (name, mut path) = self.target(table)?;
        path.push(whole(self.value(index)?));
        Ok((name, path))
    }
}

fn equal(left: Typed, right: Typed, operations: [Truth; 3]) -> Typed {
    let is_number = |kind: &Kind| matches!(kind, Kind::Int | Kind::Float | Kind::Bool);
    let (numbers, texts, any) = (operations[0], operations[1], operations[2]);
    let operands = match (&left.kind, &right.kind) {
        (Kind::Bool, Kind::Bool) => return truth_of(numbers, [left.code, right.code]),
        (one, other) if is_number(one) && is_number(other) => {
            let is_real = *one == Kind::Float || *other == Kind::Float;
            let as_wanted = if is_real { real } else { number };
            return truth_of(numbers, [as_wanted(left), as_wanted(right)]);
        }
        (Kind::Text, Kind::Text) => return truth_of(texts, [text(left), text(right)]),
        (Kind::Text, other) if is_number(other) => {
            return truth_of(texts, [left.code, text(right)]);
        }
        // What compares any two values is right for these, and for what is not known.
        _ => [left.code, right.code],
    };
    truth_of(any, operands)
}

/// A divisor as a number that may have a fraction.
fn real_literal(code: Code) -> Code {
    let is_real = matches!(
        code,
        Code::Float(_) | Code::Do(Operation::Conversion(Conversion::FloatOfInt), _)
    );
    if is_real {
        return code;
    }
    Code::does(Conversion::FloatOfInt, [code])
}

fn element(table: Typed, index: Code) -> Typed {
    let kind = match &table.kind {
        Kind::List(element) => (**element).clone(),
        Kind::Any | Kind::Bool | Kind::Int | Kind::Float | Kind::Text => Kind::Any,
    };
    let count = if let Code::Do(Operation::Read(reading), _) = &table.code {
        reading.count()
    } else {
        0
    };
    let pad = match (&table.code, &index) {
        (Code::List(parts), Code::Int(at)) if readings::is_pair(parts) => usize::try_from(*at)
            .ok()
            .and_then(|at| parts.get(at).cloned()),
        // Read as a whole, which is right for every table.
        _ => None,
    };
    if let Some(code) = pad {
        return typed(code, Kind::Int);
    }
    let is_there = matches!(index, Code::Int(at) if (0..count).contains(&at));
    let what = match kind {
        _ if is_there => Element::AtPlain,
        Kind::Int => Element::AtWhole,
        Kind::Any | Kind::Bool | Kind::Float | Kind::Text | Kind::List(_) => Element::At,
    };
    typed(Code::does(what, [table.code, index]), kind)
}

fn literal(text: &str) -> Typed {
    let digits = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"));
    let whole = match digits {
        Some(digits) => i64::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    };
    match whole {
        Some(whole) if whole.unsigned_abs() < 1 << 53 => typed(Code::Int(whole), Kind::Int),
        _ => typed(Code::Float(text.parse().unwrap_or(0.0)), Kind::Float),
    }
}

/// A float, also in hexadecimal.
fn float_of(text: &str) -> Option<f64> {
    let Some(rest) = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) else {
        return text.parse().ok().filter(|number: &f64| number.is_finite());
    };
    let (digits, exponent) = match rest.split_once(['p', 'P']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i32>().ok()?),
        None => (rest, 0),
    };
    let (before, behind) = digits.split_once('.').unwrap_or((digits, ""));
    let mut number = 0.0;
    for digit in before.chars().chain(behind.chars()) {
        number = number * 16.0 + f64::from(digit.to_digit(16)?);
    }
    let places = i32::try_from(behind.len()).ok()?.checked_mul(4)?;
    let number = number * 2.0_f64.powi(exponent.checked_sub(places)?);
    number.is_finite().then_some(number)
}
