//! What one block says: its properties as statements.
//!
//! Owns the meaning of each operation, which is the machine's; what devices are told is in `commands`.

use super::build::{self, reading, text, truth, whole};
use super::code::{Code, Kind, Own, Statement, Typed, What};
use super::routines::Lowerer;
use super::texts::Sentence;
use super::words;
use crate::blocks::Watch;
use crate::program::{ArgumentKind, Axis, Node, Op, Program, Sign, Source, Watching};

/// How often a block looks at its sensor, in milliseconds.
const LOOK_MS: i64 = 20;
/// And at an encoder.
const LOOK_AT_ENCODER_MS: i64 = 10;
/// And at a button of the gamepad.
const LOOK_AT_PAD_MS: i64 = 200;

pub(super) fn tell(out: &mut Vec<Statement>, what: What, operands: impl Into<Vec<Code>>) {
    out.push(Statement::Do(Code::does(what, operands)));
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
            Op::Copy { assignment, .. } => {
                if let Some((source, _)) = program.assignments[assignment as usize].bounds {
                    self.run(node, source, out);
                }
            }
            Op::Timer { source, .. } => {
                let delay = whole(self.value(node, source));
                tell(out, What::Wait, [delay]);
            }
            Op::Random { assignment, .. } => {
                if let Some((low, high)) = program.assignments[assignment as usize].bounds {
                    let low = whole(self.value(node, low));
                    let high = whole(self.value(node, high));
                    let value = Code::does(What::Random, ordered(low, high));
                    self.assign(node, value, out);
                }
            }
            Op::AnyButton { assignment, .. } => {
                let wait = Code::Bool(program.assignments[assignment as usize].wait);
                self.assign(node, Code::does(What::AnyButton, [wait]), out);
            }
            Op::Mail { assignment, .. } => {
                let wait = Code::Bool(program.assignments[assignment as usize].wait);
                self.assign(node, Code::does(What::Mail, [wait]), out);
            }
            Op::Receive { assignment, .. } => {
                self.receive(node, program.assignments[assignment as usize].wait, out);
            }
            Op::Kill { message, .. } => {
                let name = &program.messages[message as usize].thread;
                tell(out, What::KillThread, [plain(name)]);
            }
            Op::Send { message, .. } => {
                let message = &program.messages[message as usize];
                let sent = text(self.value(node, message.source));
                tell(out, What::SendThread, [plain(&message.thread), sent]);
            }
            Op::Fork { .. } => self.fork(node, out),
            Op::Join { .. } => self.join(node, out),
            Op::Call { call, .. } => self.call(node, call, out),
            Op::Act { action, .. } => self.act(node, &program.actions[action as usize], out),
            Op::Watch { watch, .. } => self.watch(node, &program.watches[watch as usize], out),
            _ => {}
        }
    }

    /// A block that does nothing says so, unless it is there only to be drawn.
    fn pass(&mut self, node: Node, out: &mut Vec<Statement>) {
        use crate::blocks::Does;
        let row = self.program.row(node);
        if row.is_some_and(|row| matches!(row.does, Does::Start | Does::Merge | Does::Comment)) {
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
        let is_list = matches!(value.kind, Kind::List(_) | Kind::Any);
        match value.code {
            code @ Code::Variable(_) if is_list => Code::does(What::Copy, [code]),
            code @ Code::Do(What::At, _) if matches!(value.kind, Kind::List(_)) => {
                Code::does(What::Copy, [code])
            }
            Code::Port(name) => Code::Text(name),
            code if value.kind == Kind::Int && path.is_empty() && *wanted == Some(Kind::Float) => {
                Code::does(What::FloatOfInt, [code])
            }
            code => code,
        }
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
            let message = Code::does(What::ReceiveThread, []);
            self.assign(node, Code::does(What::ValueOf, [message]), out);
            return;
        }
        let place = self.place(Kind::Text);
        let message = Code::does(What::ReceiveThreadNow, []);
        out.push(Statement::Set(place.clone(), message));
        let mut body = Vec::new();
        self.assign(node, Code::does(What::ValueOf, [place.clone()]), &mut body);
        let came = Code::does(What::NotEqualText, [place, plain("")]);
        out.push(Statement::If(came, body, Vec::new()));
    }

    fn fork(&mut self, node: Node, out: &mut Vec<Statement>) {
        let begun = self.plan.functions[self.function].begun.get(&node).cloned();
        for (name, first) in begun.unwrap_or_default() {
            if let Some(function) = self.plan.thread(&name, first) {
                tell(
                    out,
                    What::StartThread,
                    [plain(&name), Code::Function(function)],
                );
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
            tell(out, What::JoinThread, [plain(&name)]);
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
        let element =
            |reading: Typed, at: i64| Code::does(What::AtPlain, [reading.code, Code::Int(at)]);
        let reading = match (watching.watch, watching.axis) {
            (Watch::Gyroscope(_), _) => {
                let operands = [element(reading(port), 6), Code::Int(1000)];
                Code::does(What::DivideWhole, operands)
            }
            (Watch::Acceleration(_), Axis::X) => element(reading(port), 0),
            (Watch::Acceleration(_), Axis::Y) => element(reading(port), 1),
            (Watch::Acceleration(_), Axis::Z) => element(reading(port), 2),
            (Watch::Acceleration(_), Axis::Length) => length(&reading(port).code),
            _ => reading(port).code,
        };
        let holds = match (watching.watch, watching.source) {
            (Watch::Disconnected, _) => Code::does(What::Equal, [reading, Code::Int(0)]),
            (_, None) => Code::does(What::Greater, [reading, Code::Int(0)]),
            (_, Some(source)) => {
                let wanted = whole(self.value(node, source));
                match compared(watching.sign) {
                    Some(what) => Code::does(what, [reading, wanted]),
                    None => Code::Bool(false),
                }
            }
        };
        let interval = match watching.watch {
            Watch::Encoder(_) => LOOK_AT_ENCODER_MS,
            Watch::PadButton => LOOK_AT_PAD_MS,
            _ => LOOK_MS,
        };
        let mut body = Vec::new();
        tell(&mut body, What::Wait, [Code::Int(interval)]);
        out.push(Statement::While {
            // Nobody leaves it.
            label: usize::MAX,
            when: Code::does(What::Not, [holds]),
            body,
        });
    }
}

fn set(target: Code, path: Vec<Code>, value: Code) -> Statement {
    let mut path = path.into_iter().rev();
    let Some(last) = path.next() else {
        return Statement::Set(target, value);
    };
    let table = path
        .rev()
        .fold(target, |table, index| Code::does(What::At, [table, index]));
    Statement::Do(Code::does(What::Put, [table, last, value]))
}

/// What a value that nobody keeps does.
fn effects(code: Code, out: &mut Vec<Statement>) {
    match code {
        Code::Do(What::Print, operands) => tell(out, What::Print, operands),
        Code::Do(_, parts) | Code::List(parts) => {
            parts.into_iter().for_each(|part| effects(part, out));
        }
        _ => {}
    }
}

fn ordered(low: Code, high: Code) -> [Code; 2] {
    match (&low, &high) {
        (Code::Int(one), Code::Int(two)) if one > two => [high, low],
        (Code::Int(_), Code::Int(_)) => [low, high],
        _ => [
            Code::does(What::Min, [low.clone(), high.clone()]),
            Code::does(What::Max, [low, high]),
        ],
    }
}

fn compared(sign: Sign) -> Option<What> {
    Some(match sign {
        Sign::Greater => What::Greater,
        Sign::Less => What::Less,
        Sign::NotLess => What::GreaterEqual,
        Sign::NotGreater => What::LessEqual,
        Sign::Equals => What::Equal,
        Sign::Unknown => return None,
    })
}

/// How long a vector of three is, cut to a whole number.
fn length(vector: &Code) -> Code {
    let square = |at: i64| {
        let number = Code::does(What::AtPlain, [vector.clone(), Code::Int(at)]);
        Code::does(What::Multiply, [number.clone(), number])
    };
    let sum = Code::does(What::Add, [square(0), square(1)]);
    let sum = Code::does(What::Add, [sum, square(2)]);
    Code::does(What::Floor, [Code::does(What::Sqrt, [sum])])
}

/// A variable of the generator whose use is said by its kind.
pub(super) fn own_name(own: Own) -> &'static str {
    match own {
        Own::Counter => "round",
        Own::State => "place",
        Own::Value => "kept",
    }
}
