//! What one block says: its properties as statements.
//!
//! Owns the meaning of each operation, which is the machine's; what devices are told is in `commands`.

use super::build::{self, text, truth, whole};
use super::code::{
    Code, Conversion, Element, Function, Kind, Number, Operation, Own, Robot, Statement, Truth,
    Turn, Typed,
};
use super::readings::of as reading;
use super::routines::Lowerer;
use super::texts::Sentence;
use super::words;
use crate::blocks::Row;
use crate::blocks::wait::{Every, Measure};
use crate::machine::STEP_MS;
use crate::program::{ArgumentKind, Node, Op, Program, Sign, Source, WatchedFor, Watching};

pub(super) fn emit(
    out: &mut Vec<Statement>,
    operation: impl Into<Operation>,
    operands: impl Into<Vec<Code>>,
) {
    out.push(Statement::Do(Code::does(operation, operands)));
}

pub(super) fn plain(text: &str) -> Code {
    Code::Text(text.into())
}

impl Lowerer<'_> {
    /// The value of a text; a problem is kept, and nothing given.
    pub(super) fn value(&mut self, node: Node, source: Source) -> Typed {
        match self.texts.value(source) {
            Ok(value) => value,
            Err(wrong) => {
                let problem = self.texts.problem(node, Some(source), wrong);
                self.problems.push(problem);
                Typed {
                    code: Code::Nil,
                    kind: Kind::Any,
                }
            }
        }
    }

    pub(super) fn fail(&mut self, node: Node, words: lang_text::problem::Words) {
        let mut problem = lang_text::problem::Problem::error(words);
        problem.place = self.program.place(node);
        self.problems.push(problem);
    }

    /// Statements of a block with one way out.
    pub(super) fn step(&mut self, node: Node, out: &mut Vec<Statement>) {
        let program: &Program = self.program;
        match program.ops[node as usize] {
            Op::Pass { .. } => self.pass(node, out),
            Op::Run { source, .. } => self.run(node, source, out),
            Op::Copy { copy, .. } => self.run(node, program.copies[copy as usize].source, out),
            Op::Timer { source, .. } => self.timer(node, source, out),
            Op::Random { assignment, .. } => {
                if let Some((low, high)) = program.assignments[assignment as usize].bounds {
                    let low = whole(self.value(node, low));
                    let high = whole(self.value(node, high));
                    let value = Code::does(Function::Random, ordered(low, high));
                    self.assign(node, value, out);
                }
            }
            Op::AnyButton { assignment, .. } => {
                let wait = Code::Bool(program.assignments[assignment as usize].wait);
                self.assign(node, Code::does(Turn::AnyButton, [wait]), out);
            }
            Op::Mail { assignment, .. } => {
                let wait = Code::Bool(program.assignments[assignment as usize].wait);
                self.assign(node, Code::does(Turn::Mail, [wait]), out);
            }
            Op::Receive { assignment, .. } => {
                self.receive(node, program.assignments[assignment as usize].wait, out);
            }
            Op::Kill { message, .. } => {
                let name = &program.messages[message as usize].thread;
                emit(out, Turn::Kill, [plain(name)]);
            }
            Op::Send { message, .. } => {
                let message = &program.messages[message as usize];
                let sent = text(self.value(node, message.source));
                emit(out, Turn::Send, [plain(&message.thread), sent]);
            }
            Op::Fork { .. } => self.fork(node, out),
            Op::Join { .. } => self.join(node, out),
            Op::Call { call, .. } => self.call(node, call, out),
            Op::Act { action, .. } => self.act(node, &program.actions[action as usize], out),
            Op::Watch { watch, .. } => self.watch(node, &program.watches[watch as usize], out),
            // Those end the function or have several ways out: the structure of the graph has them.
            Op::End
            | Op::Fault { .. }
            | Op::If { .. }
            | Op::Loop { .. }
            | Op::Switch { .. }
            | Op::Ask { .. } => {}
        }
    }

    /// A wait for a time. One that another timer has led to counts the step in which it begins.
    fn timer(&mut self, node: Node, source: Source, out: &mut Vec<Statement>) {
        let delay = whole(self.value(node, source));
        if !self.early.contains(&(self.function, node)) {
            emit(out, Turn::Wait, [delay]);
            return;
        }
        let step = i64::from(STEP_MS);
        if let Code::Int(ms) = delay
            && ms <= step
        {
            let done = format!("Timer {ms}: over in the step in which it begins");
            out.push(Statement::Comment(done));
            return;
        }
        let rest = Code::does(Number::Subtract, [delay, Code::Int(step)]);
        emit(out, Turn::Wait, [rest]);
    }

    /// A block that does nothing says so, unless it is there only to be drawn.
    fn pass(&mut self, node: Node, out: &mut Vec<Statement>) {
        let row = self.program.row(node);
        if row.is_some_and(Row::is_mark) {
            return;
        }
        let name = row.map_or("a block that TRIK does not have", |row| row.shown);
        out.push(Statement::Comment(format!("{name}: nothing to do here")));
    }

    fn run(&mut self, node: Node, source: Source, out: &mut Vec<Statement>) {
        let sentences = match self.texts.sentences(source) {
            Ok(sentences) => sentences,
            Err(wrong) => {
                let problem = self.texts.problem(node, Some(source), wrong);
                self.problems.push(problem);
                return;
            }
        };
        for sentence in sentences {
            match sentence {
                Sentence::Assign(variable, path, value) => {
                    let value = self.converted(variable, &path, value);
                    out.push(set(Code::Variable(variable), path, value));
                }
                // What is computed and not kept is not said, unless it does something.
                Sentence::Value(value) => effects(value.code, out),
            }
        }
    }

    /// A value as a variable wants it: tables are copied.
    fn converted(&self, variable: usize, path: &[Code], value: Typed) -> Code {
        let wanted = &self.texts.variables.all[variable].kind;
        let is_shared = match &value.code {
            Code::Variable(_) => matches!(value.kind, Kind::List(_) | Kind::Any),
            Code::Do(Operation::Element(Element::At), _) => matches!(value.kind, Kind::List(_)),
            Code::Int(_)
            | Code::Float(_)
            | Code::Bool(_)
            | Code::Text(_)
            | Code::Nil
            | Code::Port(_)
            | Code::Own(..)
            | Code::Function(_)
            | Code::Do(..)
            | Code::List(_) => false,
        };
        if is_shared {
            return Code::does(Element::Copy, [value.code]);
        }
        if let Code::Port(name) = value.code {
            return Code::Text(name);
        }
        if value.kind == Kind::Int && path.is_empty() && *wanted == Some(Kind::Float) {
            return Code::does(Conversion::FloatOfInt, [value.code]);
        }
        value.code
    }

    /// Gives a value to the variable of a block.
    fn assign(&mut self, node: Node, value: Code, out: &mut Vec<Statement>) {
        match self.texts.target(node) {
            Ok(Some((variable, path, _))) => {
                out.push(set(Code::Variable(variable), path, value));
            }
            Ok(None) => self.fail(node, words::no_target()),
            Err(wrong) => {
                let problem = self.texts.problem(node, None, wrong);
                self.problems.push(problem);
            }
        }
    }

    fn receive(&mut self, node: Node, wait: bool, out: &mut Vec<Statement>) {
        if wait {
            let message = Code::does(Turn::Receive, []);
            self.assign(node, Code::does(Conversion::ValueOf, [message]), out);
            return;
        }
        let place = self.place(Kind::Text);
        let message = Code::does(Turn::ReceiveNow, []);
        out.push(Statement::Set(place.clone(), message));
        let mut body = Vec::new();
        self.assign(
            node,
            Code::does(Conversion::ValueOf, [place.clone()]),
            &mut body,
        );
        let came = Code::does(Truth::NotEqualText, [place, plain("")]);
        out.push(Statement::If(came, body, Vec::new()));
    }

    fn fork(&mut self, node: Node, out: &mut Vec<Statement>) {
        let begun = self.plan.functions[self.function].begun.get(&node).cloned();
        for (name, first) in begun.unwrap_or_default() {
            if let Some(function) = self.plan.thread(&name, first) {
                emit(out, Turn::Start, [plain(&name), Code::Function(function)]);
            }
        }
    }

    /// The survivor waits for all others that come to the block.
    fn join(&mut self, node: Node, out: &mut Vec<Statement>) {
        let own = &self.plan.functions[self.function].threads;
        let mut names = std::collections::BTreeSet::new();
        for function in &self.plan.functions {
            if function.nodes.contains(&node) {
                names.extend(function.threads.difference(own).cloned());
            }
        }
        for name in names {
            emit(out, Turn::Join, [plain(&name)]);
        }
    }

    /// Variables that are parameters of a subprogram's function: nobody else sees them.
    pub(super) fn parameters(&self, diagram: u32) -> Vec<usize> {
        let Some(own) = self.plan.subprogram(diagram) else {
            return Vec::new();
        };
        let mut wanted: Option<Vec<usize>> = None;
        let ops = self.program.ops.iter();
        for op in ops {
            let Op::Call { call, .. } = *op else {
                continue;
            };
            let call = &self.program.calls[call as usize];
            if call.diagram != Some(diagram) {
                continue;
            }
            let numbers = call.arguments.iter();
            let numbers = numbers.filter_map(|argument| self.texts.variables.find(&argument.name));
            let numbers: Vec<usize> = numbers.collect();
            // Calls with different lists of arguments have no common form.
            if wanted.as_ref().is_some_and(|known| *known != numbers) {
                return Vec::new();
            }
            wanted = Some(numbers);
        }
        let wanted = wanted.unwrap_or_default();
        let function = &self.plan.functions[own];
        let begins_threads = !function.begun.is_empty();
        let mut others = self
            .plan
            .functions
            .iter()
            .enumerate()
            .filter(|(index, _)| *index != own);
        let is_seen = others.any(|(_, other)| {
            let mut nodes = other.nodes.iter();
            nodes.any(|&node| {
                self.texts
                    .names(node)
                    .iter()
                    .any(|name| wanted.contains(name))
            })
        });
        let is_other_parameter = self.is_parameter_elsewhere(diagram, &wanted);
        if is_seen || begins_threads || is_other_parameter || self.plan.reenters(diagram) {
            return Vec::new();
        }
        wanted
    }

    fn is_parameter_elsewhere(&self, diagram: u32, names: &[usize]) -> bool {
        let calls = self
            .program
            .calls
            .iter()
            .filter(|call| call.diagram != Some(diagram));
        let arguments = calls.flat_map(|call| call.arguments.iter());
        let mut numbers =
            arguments.filter_map(|argument| self.texts.variables.find(&argument.name));
        numbers.any(|number| names.contains(&number))
    }

    fn call(&mut self, node: Node, call: u32, out: &mut Vec<Statement>) {
        let program = self.program;
        let call = &program.calls[call as usize];
        let Some(diagram) = call.diagram else {
            return;
        };
        let Some(function) = self.plan.subprogram(diagram) else {
            return;
        };
        let mut values = Vec::new();
        for argument in &call.arguments {
            let value = self.value(node, argument.source);
            let value = match argument.kind {
                ArgumentKind::Truth => truth(value),
                ArgumentKind::Whole => whole(value),
                ArgumentKind::Number => build::real(value),
                ArgumentKind::Text => text(value),
            };
            values.push((self.texts.variables.declare(&argument.name), value));
        }
        if !values.is_empty() && self.parameters(diagram).len() == values.len() {
            let arguments = values.into_iter().map(|(_, value)| value).collect();
            out.push(Statement::Call {
                function,
                arguments,
            });
            return;
        }
        let mut kept = Vec::new();
        for &(variable, _) in &values {
            let kind = self.texts.variables.all[variable].kind.clone();
            let place = self.place(kind.unwrap_or(Kind::Any));
            out.push(Statement::Set(place.clone(), Code::Variable(variable)));
            kept.push((variable, place));
        }
        for (variable, value) in values {
            out.push(Statement::Set(Code::Variable(variable), value));
        }
        let arguments = Vec::new();
        out.push(Statement::Call {
            function,
            arguments,
        });
        for (variable, place) in kept {
            out.push(Statement::Set(Code::Variable(variable), place));
        }
    }

    fn watch(&mut self, node: Node, watching: &Watching, out: &mut Vec<Statement>) {
        let port = match &watching.port {
            Ok(port) => *port,
            Err(name) => {
                let words = words::unknown_port(name);
                self.fail(node, words);
                return;
            }
        };
        let said = reading(port).code;
        let element = |at: usize| {
            let at = i64::try_from(at).unwrap_or(i64::MAX);
            Code::does(Element::AtPlain, [said.clone(), Code::Int(at)])
        };
        let reading = match watching.measure {
            Measure::Only => said,
            Measure::At(at) => element(at),
            Measure::ThousandthAt(at) => {
                Code::does(Number::DivideWhole, [element(at), Code::Int(1000)])
            }
            Measure::Length => length(&said),
        };
        let holds = match watching.until {
            WatchedFor::Zero => Code::does(Truth::Equal, [reading, Code::Int(0)]),
            WatchedFor::Positive => Code::does(Truth::Greater, [reading, Code::Int(0)]),
            WatchedFor::Compared(sign, source) => {
                let wanted = whole(self.value(node, source));
                match compared(sign) {
                    Some(what) => Code::does(what, [reading, wanted]),
                    None => Code::Bool(false),
                }
            }
        };
        let interval = match watching.wait.every {
            Every::Step => STEP_MS.into(),
            Every::Ms(ms) => ms.into(),
        };
        let mut body = Vec::new();
        emit(&mut body, Turn::Wait, [Code::Int(interval)]);
        out.push(Statement::While {
            // Nobody leaves it.
            label: usize::MAX,
            when: Code::does(Truth::Not, [holds]),
            body,
        });
    }
}

fn set(target: Code, path: Vec<Code>, value: Code) -> Statement {
    let mut path = path.into_iter().rev();
    let Some(last) = path.next() else {
        return Statement::Set(target, value);
    };
    let table = path.rev().fold(target, |table, index| {
        Code::does(Element::At, [table, index])
    });
    Statement::Do(Code::does(Element::Put, [table, last, value]))
}

/// What a value that nobody keeps does.
fn effects(code: Code, out: &mut Vec<Statement>) {
    match code {
        Code::Do(Operation::Robot(Robot::Print), operands) => emit(out, Robot::Print, operands),
        Code::Do(_, parts) | Code::List(parts) => {
            parts.into_iter().for_each(|part| effects(part, out));
        }
        Code::Int(_)
        | Code::Float(_)
        | Code::Bool(_)
        | Code::Text(_)
        | Code::Nil
        | Code::Port(_)
        | Code::Variable(_)
        | Code::Own(..)
        | Code::Function(_) => {}
    }
}

fn ordered(low: Code, high: Code) -> [Code; 2] {
    match (&low, &high) {
        (Code::Int(one), Code::Int(two)) if one > two => [high, low],
        (Code::Int(_), Code::Int(_)) => [low, high],
        // What is not known before it runs is ordered when it runs.
        _ => [
            Code::does(Function::Min, [low.clone(), high.clone()]),
            Code::does(Function::Max, [low, high]),
        ],
    }
}

fn compared(sign: Sign) -> Option<Truth> {
    Some(match sign {
        Sign::Greater => Truth::Greater,
        Sign::Less => Truth::Less,
        Sign::NotLess => Truth::GreaterEqual,
        Sign::NotGreater => Truth::LessEqual,
        Sign::Equals => Truth::Equal,
        Sign::Unknown => return None,
    })
}

/// How long a vector of three is, cut to a whole number.
fn length(vector: &Code) -> Code {
    let square = |at: i64| {
        let number = Code::does(Element::AtPlain, [vector.clone(), Code::Int(at)]);
        Code::does(Number::Multiply, [number.clone(), number])
    };
    let sum = Code::does(Number::Add, [square(0), square(1)]);
    let sum = Code::does(Number::Add, [sum, square(2)]);
    Code::does(Function::Floor, [Code::does(Function::Sqrt, [sum])])
}

/// A variable of the generator whose use is said by its kind.
pub(super) fn own_name(own: Own) -> &'static str {
    match own {
        Own::Counter => "round",
        Own::State => "place",
        Own::Value => "kept",
    }
}
