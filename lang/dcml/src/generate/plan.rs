//! Values to lines: which of them get a name and a line of their own, and what their text is.
//!
//! Owns that decision, parentheses, and the names of one generated text. How a language writes an operation is known to
//! its [`Dialect`]. Nothing here recurses: a model of any depth is printed in its order.

use super::graph::{Scene, operands};
use super::names::Names;
use crate::function::Function;
use crate::limits;
use crate::model::Symbol;
use crate::syntax::{Comparison, Kind, Operator};
use crate::tape::{Input, Operation, ValueId};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::f64::consts::PI;

/// How tightly a text holds together.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Ord, PartialOrd)]
pub(super) enum Level {
    /// A choice between two values.
    Choice,
    /// A sum or a difference.
    Sum,
    /// A product or a quotient.
    Product,
    /// A sign before something.
    Sign,
    /// A power, where it has an operator.
    Power,
    /// A name, a number, a call.
    Whole,
}

/// A piece of source text.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub text: String,
    pub level: Level,
    /// Whether it is a number that is written down.
    pub is_number: bool,
}

impl Text {
    pub fn new(text: impl Into<String>, level: Level) -> Self {
        Self {
            text: text.into(),
            level,
            is_number: false,
        }
    }

    /// A number that is written down, with its sign.
    pub fn number(text: impl Into<String>) -> Self {
        let text = text.into();
        Self {
            level: if text.starts_with('-') {
                Level::Sign
            } else {
                Level::Whole
            },
            text,
            is_number: true,
        }
    }

    /// A simple part of pi, by the name that pi has; what it computes has the bits of the number.
    pub fn of_pi(number: f64, name: &str) -> Option<Self> {
        let divided = |by: f64, text: &str| (number == PI / by).then(|| format!("{name} / {text}"));
        if number == PI {
            return Some(Self::whole(name));
        }
        let text = divided(2.0, "2.0").or_else(|| divided(4.0, "4.0"));
        text.map(|text| Self::new(text, Level::Product))
    }

    /// A name or a call.
    pub fn whole(text: impl Into<String>) -> Self {
        Self::new(text, Level::Whole)
    }

    /// With parentheses, unless it holds together so tightly.
    pub fn at_least(self, level: Level) -> String {
        if self.level < level {
            format!("({})", self.text)
        } else {
            self.text
        }
    }
}

/// How a language writes an operation.
pub(super) trait Dialect {
    /// A number that reads back to the same bits; never one that is not finite.
    fn number(&self, number: f64) -> Text;

    /// What comes from outside and has this name.
    fn input(&self, input: Input, name: &str) -> String;

    /// A function.
    fn call(&self, function: Function, x: Text, y: Text) -> Text;

    /// The third if the first two compare so, else the fourth.
    fn select(&self, comparison: Comparison, values: [Text; 4]) -> Text;

    /// The opposite.
    fn negative(&self, value: Text) -> Text {
        Text::new(format!("-{}", value.at_least(Level::Whole)), Level::Sign)
    }

    /// Two values: to the left without parentheses, as all languages group.
    fn binary(&self, operator: Operator, left: Text, right: Text) -> Text {
        let (sign, level, tighter) = match operator {
            Operator::Add => ("+", Level::Sum, Level::Product),
            Operator::Subtract => ("-", Level::Sum, Level::Product),
            Operator::Multiply => ("*", Level::Product, Level::Whole),
            Operator::Divide => ("/", Level::Product, Level::Whole),
        };
        let has_sign = right.text.starts_with('-');
        let right = right.at_least(if has_sign { Level::Whole } else { tighter });
        Text::new(format!("{} {sign} {right}", left.at_least(level)), level)
    }

    /// A name of a line where its value is used.
    fn reference(&self, name: &str) -> String {
        name.to_owned()
    }

    /// Whether values have no names but places, because the language has too few names.
    fn place(&self, _value: ValueId) -> Option<String> {
        None
    }
}

/// How a comparison is written everywhere.
pub(super) const fn sign(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Less => "<",
        Comparison::LessOrEqual => "<=",
        Comparison::Greater => ">",
        Comparison::GreaterOrEqual => ">=",
    }
}

/// The shortest digits that read back to the same bits, with a dot or an exponent.
pub(super) fn digits(number: f64) -> String {
    format!("{number:?}")
}

/// One function's code.
pub(super) struct Body {
    /// Names with their texts, in order.
    pub lines: Vec<(String, String)>,
    /// Texts of the results.
    pub results: Vec<String>,
    /// What is needed from outside, in order, with names.
    pub inputs: Vec<(Input, String)>,
}

impl Body {
    /// How many rows the results fill.
    pub fn rows(&self, columns: usize) -> usize {
        self.results.len().checked_div(columns).unwrap_or(0)
    }

    /// Whether the state is looked at.
    pub fn uses_state(&self) -> bool {
        self.uses(|input| matches!(input, Input::State(_)))
    }

    /// Whether the action is looked at.
    pub fn uses_action(&self) -> bool {
        self.uses(|input| matches!(input, Input::Action(_)))
    }

    /// Whether the parameters are looked at.
    pub fn uses_params(&self) -> bool {
        self.uses(|input| matches!(input, Input::Param(_)))
    }

    fn uses(&self, is_it: impl Fn(Input) -> bool) -> bool {
        self.inputs.iter().any(|(input, _)| is_it(*input))
    }
}

/// Makes the functions of one text: the same value has the same name in all of them.
pub(super) struct Planner<'s, 'm> {
    pub scene: &'s Scene<'m>,
    names: Names,
    symbols: HashMap<&'m str, String>,
    temporaries: HashMap<ValueId, String>,
    /// Functions that were used.
    pub functions: BTreeSet<Function>,
}

impl<'s, 'm> Planner<'s, 'm> {
    /// All symbols of the model have names after this; `taken` are lists of words that mean something else.
    pub fn new(scene: &'s Scene<'m>, taken: &[&str]) -> Self {
        let mut names = Names::new(taken);
        let mut symbols = HashMap::new();
        for symbol in &scene.model.symbols {
            symbols.insert(symbol.name.as_str(), names.take(&symbol.name));
        }
        Self {
            scene,
            names,
            symbols,
            temporaries: HashMap::new(),
            functions: BTreeSet::new(),
        }
    }

    /// What a symbol is called here.
    pub fn symbol(&self, symbol: &Symbol) -> &str {
        self.symbols
            .get(symbol.name.as_str())
            .map_or("", String::as_str)
    }

    /// A free name for something else.
    pub fn take(&mut self, wanted: &str) -> String {
        self.names.take(wanted)
    }

    /// The code that computes these values.
    pub fn body(&mut self, roots: &[ValueId], dialect: &dyn Dialect) -> Body {
        let scene = self.scene;
        let uses = uses(scene, roots);
        let results: HashSet<ValueId> = roots.iter().copied().collect();
        let mut texts: HashMap<ValueId, Text> = HashMap::new();
        let mut body = Body {
            lines: Vec::new(),
            results: Vec::new(),
            inputs: Vec::new(),
        };
        for (id, operation) in (0..).zip(&scene.graph.operations) {
            let count = uses.get(id as usize).copied().unwrap_or(0);
            if count == 0 {
                continue;
            }
            let text = self.text(*operation, &mut texts, dialect, &mut body);
            // A result may be as long as it is.
            let is_short = text.text.len() <= limits::DCML_INLINE_BYTES || results.contains(&id);
            let text = if self.stands_alone(id, *operation, count, is_short) {
                let name = self.name(id, *operation, dialect);
                body.lines.push((name.clone(), text.text));
                Text::whole(dialect.reference(&name))
            } else {
                text
            };
            texts.insert(id, text);
        }
        let result = |id: &ValueId| {
            texts
                .get(id)
                .map_or_else(String::new, |one| one.text.clone())
        };
        body.results = roots.iter().map(result).collect();
        body.inputs.sort_by_key(|(input, _)| match *input {
            Input::State(at) => (0, at),
            Input::Action(at) => (1, at),
            Input::Param(at) => (2, at),
        });
        body
    }

    fn text(
        &mut self,
        operation: Operation,
        texts: &mut HashMap<ValueId, Text>,
        dialect: &dyn Dialect,
        body: &mut Body,
    ) -> Text {
        // What has no line of its own is used once, but for names and numbers, which are short.
        let of = |id: ValueId| texts.get(&id).cloned().unwrap_or_else(|| Text::whole("0"));
        match operation {
            Operation::Constant(number) => dialect.number(number),
            Operation::Input(input) => {
                let symbol = self.scene.input(input);
                let name = symbol.map_or("", |one| self.symbol(one)).to_owned();
                let text = Text::whole(dialect.input(input, &name));
                body.inputs.push((input, name));
                text
            }
            Operation::Negative(value) => dialect.negative(of(value)),
            Operation::Binary(operator, left, right) => {
                let left = of(left);
                dialect.binary(operator, left, of(right))
            }
            Operation::Call(function, x, y) => {
                self.functions.insert(function);
                let x = of(x);
                dialect.call(function, x, of(y))
            }
            Operation::Select(comparison, values) => dialect.select(comparison, values.map(of)),
        }
    }

    fn stands_alone(&self, id: ValueId, operation: Operation, count: u32, is_short: bool) -> bool {
        let kind = self.scene.named.get(&id).map(|symbol| symbol.kind);
        match (operation, kind) {
            (Operation::Input(_), _) => false,
            (_, Some(Kind::Var | Kind::Const)) => true,
            (Operation::Constant(_), _) => false,
            _ => count > 1 || !is_short,
        }
    }

    /// The name of a value that has a line of its own.
    fn name(&mut self, id: ValueId, operation: Operation, dialect: &dyn Dialect) -> String {
        if let Some(place) = dialect.place(id) {
            return place;
        }
        if let Some(symbol) = self.scene.named.get(&id) {
            return self.symbol(symbol).to_owned();
        }
        if let Some(name) = self.temporaries.get(&id) {
            return name.clone();
        }
        let wanted = match operation {
            Operation::Call(function, x, _) if function.arguments() == 1 => {
                let argument = self.short_name(x);
                argument.map(|argument| format!("{}_{argument}", function.name()))
            }
            Operation::Constant(_)
            | Operation::Input(_)
            | Operation::Negative(_)
            | Operation::Binary(..)
            | Operation::Call(..)
            | Operation::Select(..) => None,
        };
        let wanted = wanted.unwrap_or_else(|| format!("t{}", self.temporaries.len() + 1));
        let name = self.names.take(&wanted);
        self.temporaries.insert(id, name.clone());
        name
    }

    /// The name of a symbol whose value this is.
    fn short_name(&self, id: ValueId) -> Option<&str> {
        let symbol = match self.scene.graph.operations.get(id as usize)? {
            Operation::Input(input) => self.scene.input(*input),
            Operation::Constant(_)
            | Operation::Negative(_)
            | Operation::Binary(..)
            | Operation::Call(..)
            | Operation::Select(..) => self.scene.named.get(&id).copied(),
        };
        symbol.map(|symbol| self.symbol(symbol))
    }
}

/// How often each value is used by what these results need, and by the results.
fn uses(scene: &Scene<'_>, roots: &[ValueId]) -> Vec<u32> {
    let operations = &scene.graph.operations;
    let mut uses = vec![0_u32; operations.len()];
    let seen = |id: ValueId, uses: &mut Vec<u32>| {
        if let Some(count) = uses.get_mut(id as usize) {
            *count = count.saturating_add(1);
        }
    };
    for root in roots {
        seen(*root, &mut uses);
    }
    for (id, operation) in operations.iter().enumerate().rev() {
        if uses.get(id).is_some_and(|count| *count > 0) {
            for operand in operands(*operation) {
                seen(operand, &mut uses);
            }
        }
    }
    uses
}
