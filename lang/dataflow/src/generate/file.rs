//! A converter as a file: its statements as lines, between the helpers of its language.
//!
//! Owns what both languages have in common; the form of each is in a file of its own, beside its helpers. Knows no blocks.

mod c;
mod lua;

use super::plan::Plan;
use super::step::{Body, Step};
use super::target::Target;
use lang_diagram::generate::Language;
use lang_diagram::generate::row::{Syntax, fill};
use std::fmt::Write;

/// The whole file.
pub(super) fn assemble(plan: &Plan<'_>, body: &Body) -> String {
    match plan.target {
        Target::Lua => lua::assemble(plan, body),
        Target::C => c::assemble(plan, body),
    }
}

/// Names of what the program is told and says, as a person reads them.
fn title(plan: &Plan<'_>) -> String {
    let name = plan.program.instances.first().map_or("", |main| &main.name);
    let name: String = name
        .chars()
        .map(|letter| match letter {
            // Nothing that ends a comment, a line or a text.
            '\\' | '*' | '/' | '\'' | '"' | '?' | '[' | ']' => ' ',
            letter if letter.is_control() || !letter.is_alphanumeric() && !letter.is_ascii() => ' ',
            letter => letter,
        })
        .collect();
    name.trim().to_owned()
}

/// Statements, one in each line.
fn lines(syntax: &Syntax, steps: &[Step], depth: usize, out: &mut String) {
    let mut line = |depth: usize, text: &str| {
        let _ = writeln!(out, "{}{text}", syntax.indent.repeat(depth));
    };
    for step in steps {
        match step {
            Step::Do(text) => line(depth, &fill(syntax.statement, &[text])),
            Step::Set(target, value) => line(depth, &fill(syntax.set, &[target, value])),
            Step::While(when, inner) => {
                line(depth, &fill(syntax.while_, &[when]));
                let mut body = String::new();
                lines(syntax, inner, depth + 1, &mut body);
                line(0, body.trim_end());
                line(depth, syntax.end_loop);
            }
            Step::If(when, yes, no) => {
                line(depth, &fill(syntax.if_, &[when]));
                let mut body = String::new();
                lines(syntax, yes, depth + 1, &mut body);
                if !body.is_empty() {
                    line(0, body.trim_end());
                }
                if !no.is_empty() {
                    line(depth, syntax.else_);
                    let mut body = String::new();
                    lines(syntax, no, depth + 1, &mut body);
                    line(0, body.trim_end());
                }
                line(depth, syntax.end);
            }
        }
    }
}

/// Whether statements keep a value to send it to several ports.
fn makes(steps: &[Step]) -> bool {
    steps.iter().any(|step| match step {
        Step::Do(_) => false,
        Step::Set(target, _) => target == "made",
        Step::While(_, inner) => makes(inner),
        Step::If(_, yes, no) => makes(yes) || makes(no),
    })
}

/// The syntax that statements are written in.
fn syntax(target: Target) -> &'static Syntax {
    match target {
        Target::Lua => Language::Lua.syntax(),
        Target::C => Language::C.syntax(),
    }
}
