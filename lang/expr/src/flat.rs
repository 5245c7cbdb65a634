//! Arithmetic as a list of steps over a stack of numbers, which runs several times as fast as its tree.
//!
//! Owns which parts of a text become steps, and what a step does. A part that is no arithmetic is asked for its number by
//! `run`, and so are faults told there: a list of steps gives what its tree gives, to the bit, in the same order.

use super::code::{Code, Op, Operator, Span, Step};
use super::names::Slot;
use super::reserved::Function;
use super::run::Run;
use super::tree::{Binary, Id};
use super::value::Value;
use super::words::Reason;
use crate::limits::STEPS_HEIGHT_MAX;

/// What a part computes, if it is arithmetic.
enum Arithmetic {
    Both(Operator, Id, Id),
    Minus(Id),
}

fn arithmetic(code: &Code, id: Id) -> Option<Arithmetic> {
    match code.ops[id as usize] {
        Op::Binary(operator, one, other) => {
            of_binary(operator).map(|operator| Arithmetic::Both(operator, one, other))
        }
        Op::Minus(operand) => Some(Arithmetic::Minus(operand)),
        Op::Call(function, span) => match code.operands(span) {
            &[one, other] => {
                of_function(function).map(|operator| Arithmetic::Both(operator, one, other))
            }
            _ => None,
        },
        Op::Nil
        | Op::Bool(_)
        | Op::Int(_)
        | Op::Float(_)
        | Op::Constant(_)
        | Op::Variable(_)
        | Op::Sensor(_)
        | Op::MinusNarrow(_)
        | Op::Not(_)
        | Op::TextLength(_)
        | Op::Length(_)
        | Op::BitNot(_)
        | Op::Element(..)
        | Op::Elements(..)
        | Op::Table(_)
        | Op::Block(_)
        | Op::Assign(..)
        | Op::AssignElement(..)
        | Op::Steps(_)
        | Op::Broken(_) => None,
    }
}

fn of_binary(operator: Binary) -> Option<Operator> {
    match operator {
        Binary::Add => Some(Operator::Add),
        Binary::Subtract => Some(Operator::Subtract),
        Binary::Multiply => Some(Operator::Multiply),
        Binary::Divide => Some(Operator::Divide),
        Binary::Power => Some(Operator::Power),
        Binary::Or
        | Binary::And
        | Binary::Less
        | Binary::Greater
        | Binary::LessEqual
        | Binary::GreaterEqual
        | Binary::NotEqual
        | Binary::Equal
        | Binary::BitOr
        | Binary::BitXor
        | Binary::BitAnd
        | Binary::ShiftLeft
        | Binary::ShiftRight
        | Binary::Join
        | Binary::DivideWhole
        | Binary::Modulo => None,
    }
}

fn of_function(function: Function) -> Option<Operator> {
    match function {
        Function::Min => Some(Operator::Min),
        Function::Max => Some(Operator::Max),
        Function::Print
        | Function::Time
        | Function::Sensor
        | Function::Sgn
        | Function::Ceil
        | Function::Floor
        | Function::Sin
        | Function::Cos
        | Function::Ln
        | Function::Exp
        | Function::Asin
        | Function::Acos
        | Function::Atan
        | Function::Sqrt
        | Function::Abs
        | Function::Random
        | Function::Atan2 => None,
    }
}

/// Whether a part is arithmetic, or assigns arithmetic to variables and then is.
fn is_list(code: &Code, id: Id) -> bool {
    let is_arithmetic = |id: Id| arithmetic(code, id).is_some();
    let Op::Block(statements) = code.ops[id as usize] else {
        return is_arithmetic(id);
    };
    let assigns =
        |&id: &Id| matches!(code.ops[id as usize], Op::Assign(_, value) if is_arithmetic(value));
    match code.operands(statements).split_last() {
        Some((&last, before)) => is_arithmetic(last) && before.iter().all(assigns),
        None => false,
    }
}

/// Makes steps of the arithmetic of a text.
pub(super) fn flatten(code: &mut Code) {
    let mut is_within = vec![false; code.ops.len()];
    let mut roots = Vec::new();
    // A part stands behind its operands, so what uses it is seen before it.
    for id in (0..code.ops.len() as Id).rev() {
        if is_within[id as usize] || !is_list(code, id) {
            continue;
        }
        let mut steps = Steps {
            code,
            within: Vec::new(),
            steps: Vec::new(),
            parts: Vec::new(),
            height: 0,
        };
        if steps.all(id).is_some() {
            for part in steps.within {
                is_within[part as usize] = true;
            }
            let (steps, parts) = (steps.steps, steps.parts);
            let from = code.steps.len() as u32;
            let count = steps.len() as u32;
            code.steps.extend(steps);
            code.step_parts.extend(parts);
            roots.push((id, Span { from, count }));
        }
    }
    for (id, span) in roots {
        code.ops[id as usize] = Op::Steps(span);
    }
}

struct Steps<'a> {
    code: &'a Code,
    /// Parts that these steps stand for.
    within: Vec<Id>,
    steps: Vec<Step>,
    /// The part of each.
    parts: Vec<Id>,
    /// Of the stack after the steps so far.
    height: usize,
}

impl Steps<'_> {
    /// Adds the steps of what is a list.
    fn all(&mut self, id: Id) -> Option<()> {
        let Op::Block(statements) = self.code.ops[id as usize] else {
            return self.part(id);
        };
        for &statement in self.code.operands(statements) {
            if let Op::Assign(slot, value) = self.code.ops[statement as usize] {
                self.part(value)?;
                self.height -= 1;
                self.add(Step::Set(slot), statement);
            } else {
                self.part(statement)?;
            }
        }
        Some(())
    }

    /// Adds the steps of a part, after which its number is on top; nothing if the stack is too low for it.
    fn part(&mut self, id: Id) -> Option<()> {
        match (arithmetic(self.code, id), self.code.ops[id as usize]) {
            (Some(Arithmetic::Both(operator, one, other)), _) => {
                let begin = self.steps.len();
                self.part(one)?;
                let one = self.take_number(begin);
                let begin = self.steps.len();
                self.part(other)?;
                let other = self.take_number(begin);
                self.within.push(id);
                self.join(operator, [one, other], id)?;
            }
            (Some(Arithmetic::Minus(operand)), _) => {
                self.part(operand)?;
                self.within.push(id);
                match self.steps.last_mut() {
                    // It is all that there is of the operand.
                    Some(Step::Number(number)) => *number = minus(*number),
                    Some(
                        Step::Variable(_)
                        | Step::Part
                        | Step::Both(_)
                        | Step::With(..)
                        | Step::Of(..)
                        | Step::Minus
                        | Step::Set(_),
                    )
                    | None => {
                        self.add(Step::Minus, id);
                    }
                }
            }
            (None, Op::Int(number)) => self.push(Step::Number(f64::from(number)), id)?,
            (None, Op::Float(number)) => self.push(Step::Number(number), id)?,
            (None, Op::Variable(slot)) => self.push(Step::Variable(slot), id)?,
            (None, _) => self.push(Step::Part, id)?,
        }
        Some(())
    }

    fn add(&mut self, step: Step, part: Id) {
        self.steps.push(step);
        self.parts.push(part);
    }

    /// Adds a step after which there is one number more.
    fn push(&mut self, step: Step, part: Id) -> Option<()> {
        self.height += 1;
        self.add(step, part);
        (self.height <= STEPS_HEIGHT_MAX).then_some(())
    }

    /// The number that the steps since then make, if it is known: then they are taken back.
    fn take_number(&mut self, begin: usize) -> Option<f64> {
        let &[Step::Number(number)] = self.steps.get(begin..)? else {
            return None;
        };
        self.steps.pop();
        self.parts.pop();
        self.height -= 1;
        Some(number)
    }

    /// Adds the step that makes one number of two, of which those that are known have no steps.
    fn join(&mut self, operator: Operator, two: [Option<f64>; 2], id: Id) -> Option<()> {
        match two {
            [Some(one), Some(other)] => match operator.of(one, other) {
                Some(known) => self.push(Step::Number(known), id)?,
                None => {
                    self.push(Step::Number(one), id)?;
                    self.add(Step::With(operator, other), id);
                }
            },
            [None, Some(other)] => self.add(Step::With(operator, other), id),
            [Some(one), None] => self.add(Step::Of(one, operator), id),
            [None, None] => {
                self.height -= 1;
                self.add(Step::Both(operator), id);
            }
        }
        Some(())
    }
}

fn minus(number: f64) -> f64 {
    if number == 0.0 { 0.0 } else { -number }
}

impl Run<'_> {
    /// The number of a part that is arithmetic; nothing if it is something else.
    #[inline]
    pub(super) fn number_alone(&mut self, id: Id) -> Option<f64> {
        if let Op::Steps(span) = self.code.ops[id as usize] {
            Some(self.steps(span))
        } else {
            None
        }
    }

    /// The number that these steps make.
    pub(super) fn steps(&mut self, span: Span) -> f64 {
        let code = self.code;
        let from = span.from as usize;
        let steps = code.steps.get(from..from + span.count as usize);
        let mut below = [0.0; STEPS_HEIGHT_MAX];
        // How many numbers there are, the one on top not counted.
        let mut height = 0;
        let mut top = 0.0;
        for (at, step) in (from..).zip(steps.unwrap_or_default()) {
            match *step {
                Step::Both(operator) => {
                    height -= 1;
                    top = self.apply(operator, below[height % STEPS_HEIGHT_MAX], top, at);
                }
                Step::With(operator, number) => top = self.apply(operator, top, number, at),
                Step::Of(number, operator) => top = self.apply(operator, number, top, at),
                Step::Minus => top = minus(top),
                Step::Set(slot) => {
                    self.set_number(slot, top, at);
                    height -= 1;
                    top = below[height % STEPS_HEIGHT_MAX];
                }
                Step::Number(_) | Step::Variable(_) | Step::Part => {
                    below[height % STEPS_HEIGHT_MAX] = top;
                    height += 1;
                    top = self.pushed(*step, at);
                }
            }
        }
        top
    }

    #[inline]
    fn set_number(&mut self, slot: Slot, number: f64, at: usize) {
        // Most often it is a number already.
        let number = Value::Float(number);
        if !self.store.set_like(slot, &number) && self.store.set(slot, number).is_err() {
            self.fault(Reason::StoreFull, self.code.step_parts[at]);
        }
    }

    /// The number that a step puts onto the stack.
    #[inline]
    fn pushed(&mut self, step: Step, at: usize) -> f64 {
        if let Step::Number(number) = step {
            return number;
        }
        if let Step::Variable(slot) = step {
            match self.store.get(slot) {
                Some(Value::Float(number)) => return *number,
                Some(Value::Int(number)) => return f64::from(*number),
                Some(
                    Value::Nil | Value::Bool(_) | Value::Text(_) | Value::Unset | Value::List(_),
                )
                | None => {}
            }
        }
        self.number(self.code.step_parts[at])
    }

    #[inline]
    fn apply(&mut self, operator: Operator, one: f64, other: f64, at: usize) -> f64 {
        operator.of(one, other).unwrap_or_else(|| {
            self.fault(Reason::DivisionByZero, self.code.step_parts[at]);
            0.0
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analyse::Analysis;
    use crate::{Compat, Kit, Names, Outside, Source, Store, Wanted, analyse, code};
    use proptest::prelude::*;

    /// Each question has another answer, so that an order is seen.
    #[derive(Default)]
    struct Asked(i32);

    impl Asked {
        fn next(&mut self) -> i32 {
            self.0 += 1;
            self.0
        }
    }

    impl Outside for Asked {
        fn sensor(&mut self, _: u16) -> Value {
            Value::Int(self.next())
        }

        fn time(&mut self) -> i32 {
            self.next()
        }

        fn print(&mut self, _: &str) {}

        fn random(&mut self, below: i32) -> i32 {
            self.next() % below
        }
    }

    /// Variables as they are before a text; `unset` has a type and no value.
    fn variables() -> [(&'static str, Value); 4] {
        [
            ("i", Value::Int(7)),
            ("f", Value::Float(-0.5)),
            ("z", Value::Int(0)),
            ("unset", Value::Float(1.0)),
        ]
    }

    /// What a text gives, what is told of it, and what its variables are then.
    fn run(code: &Code, names: &Names) -> String {
        let mut store = Store::default();
        for (name, value) in &variables()[..3] {
            let slot = names.find(name).expect("a name");
            store.set(slot, value.clone()).expect("room");
        }
        let mut asked = Asked::default();
        let mut run = Run::new(code, names, &mut store, &mut asked);
        let value = run.value(code.root);
        let faults: Vec<_> = run.faults.iter().map(|fault| fault.problem()).collect();
        let variables: Vec<_> = (names.variables())
            .map(|(slot, name, _)| (name, store.get(slot)))
            .collect();
        format!("{value:?} {faults:?} {variables:?} {}", asked.0)
    }

    fn leaf() -> impl Strategy<Value = String> {
        let leaves = [
            "0",
            "1",
            "2.5",
            "1e300",
            "i",
            "f",
            "z",
            "unset",
            "sensorA1",
            "time()",
            "random(9)",
            "pi",
            "7 // 2",
            "sqrt(f)",
        ];
        proptest::sample::select(leaves.to_vec()).prop_map(str::to_owned)
    }

    fn part() -> impl Strategy<Value = String> {
        leaf().prop_recursive(6, 60, 2, |part| {
            let two = (part.clone(), part.clone());
            let operators = ["+", "-", "*", "/", "^", "//", "%"];
            prop_oneof![
                (two.clone(), proptest::sample::select(operators.to_vec()))
                    .prop_map(|((one, other), operator)| format!("({one} {operator} {other})")),
                (two, proptest::sample::select(vec!["min", "max", "atan2"]))
                    .prop_map(|((one, other), name)| format!("{name}({one}, {other})")),
                part.prop_map(|one| format!("(-{one})")),
            ]
        })
    }

    /// Both ways of running a text.
    fn both(text: &str, compat: Compat) -> Option<(String, String, usize)> {
        let mut names = Names::new(Kit::V62, compat);
        for (name, value) in variables() {
            names.declare(name, &value).expect("room");
        }
        let mut source = Source::new(text, Wanted::Any);
        analyse(&mut source, &mut names).ok()?;
        let mut parts = source.parts.clone();
        let mut copy = names.clone();
        let mut analysis = Analysis::new(&source.tree, &mut parts, &mut copy, source.reading);
        analysis.run();
        let tree = code::compile(&analysis);
        assert!(tree.steps.is_empty());
        let count = source.code.steps.len();
        Some((run(&source.code, &names), run(&tree, &names), count))
    }

    #[test]
    fn a_body_of_arithmetic_is_one_list_of_few_steps() {
        let text = "u = 0.5 * (f - 3); max(0 - 50, min(50, u + 3))";
        let (steps, tree, count) = both(text, Compat::Fixed).expect("good");
        assert_eq!(steps, tree);
        assert_eq!(count, 8);
    }

    #[test]
    fn what_needs_too_many_places_stays_a_tree_and_its_parts_are_lists() {
        let deep = (0..40).fold("1".to_owned(), |text, _| format!("(f + {text} * f)"));
        let (steps, tree, count) = both(&deep, Compat::Fixed).expect("good");
        assert_eq!(steps, tree);
        let long = format!("(f * 2 + i * 3) + {deep}");
        let (steps, tree, with_more) = both(&long, Compat::Fixed).expect("good");
        assert_eq!(steps, tree);
        assert_eq!(with_more, count + 5);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(600))]

        #[test]
        fn steps_give_what_their_tree_gives(
            parts in proptest::collection::vec(part(), 1..4),
            is_fixed: bool,
        ) {
            let compat = if is_fixed { Compat::Fixed } else { Compat::Studio };
            let (last, before) = parts.split_last().expect("one");
            let mut text: String = before.iter().map(|one| format!("u = {one}; ")).collect();
            text.push_str(last);
            let outcome = both(&text, compat);
            // Types that do not go together are no matter of how it runs.
            prop_assume!(outcome.is_some());
            let (steps, tree, _) = outcome.expect("good");
            prop_assert_eq!(steps, tree, "{}", text);
        }
    }
}
