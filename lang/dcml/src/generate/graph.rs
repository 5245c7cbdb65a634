//! All values of a model in one numbering, with the names that its author gave them.
//!
//! Owns what is the same value in several tapes, and which value has which name. Knows no language.

use crate::model::{Expr, Model, Symbol};
use crate::syntax::{Kind, Operator};
use crate::tape::{Input, Lowered, Operation, Tape, ValueId};
use std::collections::{HashMap, HashSet};

/// Numbers that mean something else in every other place.
const PLAIN: [f64; 8] = [0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 0.5, -0.5];

/// Values of several tapes, each once, each after what it needs.
#[derive(Default)]
pub(super) struct Graph {
    pub operations: Vec<Operation>,
    known: HashMap<Key, ValueId>,
}

/// An operation with the bits of its numbers.
#[derive(Eq, PartialEq, Hash)]
enum Key {
    Constant(u64),
    Other([u32; 4], Shape),
}

#[derive(Eq, PartialEq, Hash)]
enum Shape {
    Input(Input),
    Negative,
    Binary(Operator),
    Call(crate::function::Function),
    Select(crate::syntax::Comparison),
}

impl Graph {
    /// Adds the values of a tape, and gives the numbers of its results.
    pub fn add(&mut self, tape: &Tape) -> Vec<ValueId> {
        let mut places: Vec<ValueId> = Vec::with_capacity(tape.operations.len());
        for operation in &tape.operations {
            let of = |id: ValueId| places.get(id as usize).copied().unwrap_or(0);
            let operation = match *operation {
                Operation::Negative(value) => Operation::Negative(of(value)),
                Operation::Binary(operator, left, right) => {
                    Operation::Binary(operator, of(left), of(right))
                }
                Operation::Call(function, x, y) => Operation::Call(function, of(x), of(y)),
                Operation::Select(comparison, values) => {
                    Operation::Select(comparison, values.map(of))
                }
                leaf @ (Operation::Constant(_) | Operation::Input(_)) => leaf,
            };
            places.push(self.put(operation));
        }
        let place = |id: &ValueId| places.get(*id as usize).copied();
        tape.results.iter().filter_map(place).collect()
    }

    fn put(&mut self, operation: Operation) -> ValueId {
        let next = ValueId::try_from(self.operations.len()).unwrap_or(ValueId::MAX);
        let place = *self.known.entry(key(operation)).or_insert(next);
        if place == next {
            self.operations.push(operation);
        }
        place
    }
}

fn key(operation: Operation) -> Key {
    match operation {
        Operation::Constant(number) => Key::Constant(number.to_bits()),
        Operation::Input(input) => Key::Other([0; 4], Shape::Input(input)),
        Operation::Negative(value) => Key::Other([value, 0, 0, 0], Shape::Negative),
        // Sums and products are the same the other way round.
        Operation::Binary(operator @ (Operator::Add | Operator::Multiply), left, right) => {
            let ends = [left.min(right), left.max(right), 0, 0];
            Key::Other(ends, Shape::Binary(operator))
        }
        Operation::Binary(operator, left, right) => {
            Key::Other([left, right, 0, 0], Shape::Binary(operator))
        }
        Operation::Call(function, x, y) => Key::Other([x, y, 0, 0], Shape::Call(function)),
        Operation::Select(comparison, values) => Key::Other(values, Shape::Select(comparison)),
    }
}

/// What operations an operation needs.
pub(super) fn operands(operation: Operation) -> impl Iterator<Item = ValueId> {
    let (values, count) = match operation {
        Operation::Constant(_) | Operation::Input(_) => ([0; 4], 0),
        Operation::Negative(value) => ([value, 0, 0, 0], 1),
        Operation::Binary(_, left, right) => ([left, right, 0, 0], 2),
        Operation::Call(function, x, y) => ([x, y, 0, 0], function.arguments()),
        Operation::Select(_, values) => (values, 4),
    };
    values.into_iter().take(count)
}

/// Everything that a printer looks at.
pub(super) struct Scene<'a> {
    pub model: &'a Model,
    pub states: Vec<&'a Symbol>,
    pub actions: Vec<&'a Symbol>,
    pub params: Vec<&'a Symbol>,
    pub outputs: Vec<&'a Symbol>,
    pub graph: Graph,
    /// The symbol whose value it is, for variables, outputs and constants.
    pub named: HashMap<ValueId, &'a Symbol>,
    /// Results: derivatives, outputs, and both Jacobians row after row, which are empty unless they are asked for.
    pub derivative: Vec<ValueId>,
    pub output_values: Vec<ValueId>,
    pub state_jacobian: Vec<ValueId>,
    pub action_jacobian: Vec<ValueId>,
    /// Whether there are to be Jacobians.
    pub jacobian: bool,
}

impl<'a> Scene<'a> {
    pub fn new(model: &'a Model, lowered: &Lowered, named: &Tape, jacobian: bool) -> Self {
        let mut graph = Graph::default();
        let derivative = graph.add(&lowered.derivative);
        let output_values = graph.add(&lowered.outputs);
        let (mut state_jacobian, mut action_jacobian) = (Vec::new(), Vec::new());
        if jacobian {
            state_jacobian = graph.add(&lowered.state_jacobian);
            action_jacobian = graph.add(&lowered.action_jacobian);
        }
        let outputs: Vec<_> = model.outputs().collect();
        let is_output = |one: &Symbol| outputs.iter().any(|other| other.name == one.name);
        let with_values = model
            .symbols
            .iter()
            .filter(|one| one.kind == Kind::Var || is_output(one));
        let mut names = HashMap::new();
        for (symbol, value) in with_values.zip(graph.add(named)) {
            let operation = graph.operations.get(value as usize).copied();
            if !matches!(
                operation,
                None | Some(Operation::Constant(_) | Operation::Input(_))
            ) {
                names.entry(value).or_insert(symbol);
            }
        }
        for (value, symbol) in constants(model, &graph) {
            names.insert(value, symbol);
        }
        Self {
            model,
            states: model.states().collect(),
            actions: model.of_kind(Kind::Action).collect(),
            params: model.of_kind(Kind::Param).collect(),
            outputs,
            graph,
            named: names,
            derivative,
            output_values,
            state_jacobian,
            action_jacobian,
            jacobian,
        }
    }

    /// How many results there are.
    pub fn results(&self) -> usize {
        let jacobians = self.state_jacobian.len() + self.action_jacobian.len();
        self.derivative.len() + self.output_values.len() + jacobians
    }

    /// The symbol of an input.
    pub fn input(&self, input: Input) -> Option<&'a Symbol> {
        let (all, at) = match input {
            Input::State(at) => (&self.states, at),
            Input::Action(at) => (&self.actions, at),
            Input::Param(at) => (&self.params, at),
        };
        all.get(at as usize).copied()
    }
}

/// Values that can only be those of one named constant: no other has the number, and it is written nowhere.
fn constants<'a>(model: &'a Model, graph: &Graph) -> Vec<(ValueId, &'a Symbol)> {
    let mut written: HashSet<u64> = PLAIN.map(f64::to_bits).into();
    let mut rest: Vec<&Expr> = model.equations.iter().map(|one| &one.value).collect();
    while let Some(expr) = rest.pop() {
        match expr {
            Expr::Number(number) => drop(written.insert(number.to_bits())),
            Expr::Symbol(_) => {}
            Expr::Negative(value) => rest.push(value),
            Expr::Binary(_, left, right) => rest.extend([&**left, &**right]),
            Expr::Call(_, arguments) => rest.extend(arguments),
            Expr::Piecewise(cases, otherwise) => {
                for (condition, value) in cases {
                    rest.extend([&condition.left, &condition.right, value]);
                }
                rest.push(otherwise);
            }
        }
    }
    let mut by_bits: HashMap<u64, Option<&Symbol>> = HashMap::new();
    for symbol in model.of_kind(Kind::Const) {
        let bits = symbol.value.to_bits();
        by_bits
            .entry(bits)
            .and_modify(|one| *one = None)
            .or_insert(Some(symbol));
    }
    let mut found = Vec::new();
    for (id, operation) in (0..).zip(&graph.operations) {
        if let Operation::Constant(number) = operation
            && !written.contains(&number.to_bits())
            && let Some(Some(symbol)) = by_bits.get(&number.to_bits())
        {
            found.push((id, *symbol));
        }
    }
    found
}
