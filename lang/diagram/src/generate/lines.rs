//! Statements as lines: indentation, branches, loops and what leaves them.
//!
//! Owns which loops need a name. All words come from the dialect.

use super::code::{Code, Conversion, Operation, Own, Statement, Truth};
use super::origins;
use super::print::{Printer, fill, own_name};

impl Printer<'_> {
    fn line(&self, depth: usize, text: &str, out: &mut String) {
        for line in text.lines() {
            for _ in 0..depth {
                out.push_str(self.dialect.syntax.indent);
            }
            out.push_str(line);
            origins::mark(out, &self.from);
            out.push('\n');
        }
    }

    fn block(&mut self, list: &[Statement], depth: usize, out: &mut String) {
        // What the language has no words for is left out.
        let is_empty = list.iter().all(|statement| {
            matches!(statement, Statement::Comment(_) | Statement::From(_))
                || matches!(statement, Statement::Do(code) if self.code(code, 0).is_empty())
        });
        if is_empty && !self.dialect.syntax.empty.is_empty() {
            self.line(depth, self.dialect.syntax.empty, out);
        }
        self.list(list, depth, out);
    }

    pub(super) fn list(&mut self, list: &[Statement], depth: usize, out: &mut String) {
        let before = std::mem::take(&mut self.from);
        for statement in list {
            self.statement(statement, depth, out);
        }
        self.from = before;
    }

    fn end(&self, text: &str, depth: usize, out: &mut String) {
        if !text.is_empty() {
            self.line(depth, text, out);
        }
    }

    /// A return says no block: what ended the program stands before it.
    fn leave(&mut self, depth: usize, out: &mut String) {
        self.from.clear();
        self.end(self.dialect.syntax.return_, depth, out);
    }

    fn statement(&mut self, statement: &Statement, depth: usize, out: &mut String) {
        let syntax = self.dialect.syntax;
        match statement {
            Statement::From(nodes) => self.from.clone_from(nodes),
            Statement::Comment(text) => self.line(depth, &self.comment(text), out),
            Statement::Do(code) => {
                let said = self.code(code, 0);
                if !said.is_empty() {
                    self.line(depth, &fill(syntax.statement, &[&said]), out);
                }
            }
            Statement::Set(target, value) => {
                let (target, value) = (self.code(target, 0), self.code(value, 0));
                self.line(depth, &fill(syntax.set, &[&target, &value]), out);
            }
            Statement::Call {
                function,
                arguments,
            } => {
                let arguments: Vec<_> = arguments.iter().map(|code| self.code(code, 0)).collect();
                let name = &self.functions[*function];
                let said = fill(syntax.call, &[name, &arguments.join(", ")]);
                self.line(depth, &fill(syntax.statement, &[&said]), out);
            }
            Statement::If(when, yes, no) => {
                self.chain(&[(self.code(when, 0), &yes[..])], no, depth, out);
            }
            Statement::Switch {
                on,
                branches,
                other,
            } => {
                self.chain(&self.branches(on, branches), other, depth, out);
            }
            Statement::Choice { on, arms } => {
                self.chain(&self.arms(on, arms), &[], depth, out);
            }
            Statement::Loop { label, body } => {
                self.looped(*label, syntax.forever, body, depth, out);
            }
            Statement::While { label, when, body } => {
                let head = fill(syntax.while_, &[&self.code(when, 0)]);
                self.looped(*label, &head, body, depth, out);
            }
            Statement::DoWhile { label, body, when } => {
                self.do_while(*label, body, when, depth, out);
            }
            Statement::Repeat {
                label,
                counter,
                times,
                body,
            } => {
                let head = self.repeat(*counter, times);
                self.looped(*label, &head, body, depth, out);
            }
            Statement::Break(label) => {
                self.jump(*label, syntax.break_, syntax.break_to, depth, out);
            }
            Statement::Continue(label) => {
                self.jump(*label, syntax.continue_, syntax.continue_to, depth, out);
            }
            Statement::Return => self.leave(depth, out),
            Statement::Goto(label) => {
                self.line(depth, &fill(syntax.goto, &[&format!("place{label}")]), out);
            }
            Statement::Label(label) => {
                self.line(depth, &fill(syntax.label, &[&format!("place{label}")]), out);
            }
        }
    }

    /// The head of a loop that runs so many times.
    fn repeat(&self, counter: usize, times: &Code) -> String {
        let syntax = self.dialect.syntax;
        let template = if matches!(times, Code::Int(_)) {
            syntax.repeat_plain
        } else {
            syntax.repeat
        };
        let counter = own_name(Own::Counter, counter);
        let count = format!("{counter}Times");
        fill(template, &[&self.code(times, 0), &counter, &count])
    }

    /// The tests of a choice with what each leads to.
    fn arms<'b>(
        &self,
        on: &Code,
        arms: &'b [(usize, Vec<Statement>)],
    ) -> Vec<(String, &'b [Statement])> {
        let tests = arms.iter().map(|(value, body)| {
            let value = Code::Int(i64::try_from(*value).unwrap_or(0));
            let test = Code::does(Truth::Equal, [on.clone(), value]);
            (self.code(&test, 0), &body[..])
        });
        tests.collect()
    }

    /// The tests of a switch with what each leads to.
    fn branches<'b>(
        &self,
        on: &Code,
        branches: &'b [(Vec<std::rc::Rc<str>>, Vec<Statement>)],
    ) -> Vec<(String, &'b [Statement])> {
        let tests = branches.iter().map(|(guards, body)| {
            let test = one_of(on, guards);
            (self.code(&test, 0), &body[..])
        });
        tests.collect()
    }

    /// Branches one after the other, the first that holds.
    fn chain(
        &mut self,
        tests: &[(String, &[Statement])],
        other: &[Statement],
        depth: usize,
        out: &mut String,
    ) {
        let syntax = self.dialect.syntax;
        if tests.is_empty() {
            self.list(other, depth, out);
            return;
        }
        for (index, (test, body)) in tests.iter().enumerate() {
            let head = if index == 0 {
                syntax.if_
            } else {
                syntax.else_if
            };
            self.line(depth, &fill(head, &[test]), out);
            self.block(body, depth + 1, out);
        }
        // A condition after `else` needs no depth of its own.
        if let [Statement::From(nodes), Statement::If(when, yes, no)] = other {
            let before = std::mem::replace(&mut self.from, nodes.clone());
            self.line(depth, &fill(syntax.else_if, &[&self.code(when, 0)]), out);
            self.from = before;
            self.block(yes, depth + 1, out);
            if !no.is_empty() {
                self.line(depth, syntax.else_, out);
                self.block(no, depth + 1, out);
            }
        } else if !other.is_empty() {
            self.line(depth, syntax.else_, out);
            self.block(other, depth + 1, out);
        }
        self.end(syntax.end, depth, out);
    }

    fn looped(
        &mut self,
        label: usize,
        head: &str,
        body: &[Statement],
        depth: usize,
        out: &mut String,
    ) {
        let syntax = self.dialect.syntax;
        if self.named.contains(&label) {
            let name = fill(syntax.name_loop, &[&loop_name(label)]);
            self.line(depth, &format!("{name}{head}"), out);
        } else {
            self.line(depth, head, out);
        }
        self.around.push(label);
        self.block(body, depth + 1, out);
        self.around.pop();
        if !syntax.continue_label.is_empty() && goes_on(body, label) {
            self.line(
                depth + 1,
                &fill(syntax.continue_label, &[&loop_name(label)]),
                out,
            );
        }
        self.end(syntax.end_loop, depth, out);
    }

    fn do_while(
        &mut self,
        label: usize,
        body: &[Statement],
        when: &Code,
        depth: usize,
        out: &mut String,
    ) {
        let syntax = self.dialect.syntax;
        let Some((head, foot)) = syntax.do_while else {
            let leave = vec![Statement::Break(label)];
            let not = Code::does(Truth::Not, [when.clone()]);
            let mut body = body.to_vec();
            body.push(Statement::If(not, leave, Vec::new()));
            self.looped(label, syntax.forever, &body, depth, out);
            return;
        };
        if self.named.contains(&label) {
            let name = fill(syntax.name_loop, &[&loop_name(label)]);
            self.line(depth, &format!("{name}{head}"), out);
        } else {
            self.line(depth, head, out);
        }
        self.around.push(label);
        self.block(body, depth + 1, out);
        self.around.pop();
        self.line(depth, &fill(foot, &[&self.code(when, 0)]), out);
    }

    fn jump(&self, label: usize, near: &str, far: &str, depth: usize, out: &mut String) {
        if self.around.last() == Some(&label) && !near.is_empty() {
            self.line(depth, near, out);
        } else {
            self.line(depth, &fill(far, &[&loop_name(label)]), out);
        }
    }
}

/// The text is one of these.
fn one_of(on: &Code, guards: &[std::rc::Rc<str>]) -> Code {
    let number = |guard: &str| {
        guard
            .parse::<i64>()
            .ok()
            .filter(|number| number.to_string() == guard)
    };
    let test = |guard: &std::rc::Rc<str>| {
        if let Code::Do(Operation::Conversion(Conversion::TextOfInt), inner) = on
            && let Some(number) = number(guard)
        {
            return Code::does(Truth::Equal, [inner[0].clone(), Code::Int(number)]);
        }
        Code::does(Truth::EqualText, [on.clone(), Code::Text(guard.clone())])
    };
    let tests = guards.iter().map(test);
    let either = |one, other| Code::does(Truth::Or, [one, other]);
    tests.reduce(either).unwrap_or(Code::Bool(false))
}

fn loop_name(label: usize) -> String {
    format!("loop{}", label.wrapping_add(1))
}

/// Whether a loop is begun anew from the middle of its body.
fn goes_on(body: &[Statement], label: usize) -> bool {
    body.iter().any(|statement| {
        *statement == Statement::Continue(label)
            || statement
                .parts()
                .into_iter()
                .any(|part| goes_on(part, label))
    })
}

/// Loops that a jump inside of an inner loop names.
pub(super) fn find_named(list: &[Statement], around: &mut Vec<usize>, named: &mut Vec<usize>) {
    for statement in list {
        match statement {
            Statement::Break(label) | Statement::Continue(label) => {
                if around.last() != Some(label) {
                    named.push(*label);
                }
            }
            Statement::Loop { label, .. }
            | Statement::While { label, .. }
            | Statement::DoWhile { label, .. }
            | Statement::Repeat { label, .. } => {
                around.push(*label);
                statement
                    .parts()
                    .into_iter()
                    .for_each(|part| find_named(part, around, named));
                around.pop();
            }
            Statement::From(_)
            | Statement::Comment(_)
            | Statement::Do(_)
            | Statement::Set(..)
            | Statement::Call { .. }
            | Statement::If(..)
            | Statement::Switch { .. }
            | Statement::Choice { .. }
            | Statement::Return
            | Statement::Goto(_)
            | Statement::Label(_) => statement
                .parts()
                .into_iter()
                .for_each(|part| find_named(part, around, named)),
        }
    }
}
