//! Bytes as a document of DCML: understood, laid out, lowered and run.

use crate::lexer::{self, slice};
use crate::lines::Lines;
use crate::lower::equations;
use crate::manual;
use crate::model::Model;
use crate::robot::Robot;
use crate::syntax::{Kind, Span};
use crate::system::System;
use crate::{Understood, decode, format::format, understand, understand_paper};

/// All that can be done with a document: each place is one of the text, layout changes nothing but layout and is the same
/// the second time, what the published language has means the same in the whole one, and each model runs.
pub fn dcml(bytes: &[u8]) {
    let Ok(text) = decode(bytes.to_vec()) else {
        return;
    };
    let all = understand(&text);
    places(&text, &all);
    let paper = understand_paper(&text);
    places(&text, &paper);
    if paper.diagnostics.is_empty() {
        assert!(all.diagnostics.is_empty() && all.models == paper.models);
    }
    if let Ok(once) = format(&text) {
        assert_eq!(format(&once).as_deref(), Ok(once.as_str()));
        assert_eq!(words(&text), words(&once));
        let again = understand(&once);
        assert_eq!(names(&all), names(&again));
        assert!(all.models.len() == again.models.len());
        for (one, other) in all.models.iter().zip(&again.models) {
            same(one, other);
        }
        manual::markdown(&text).expect("what is read has documentation");
    }
    for model in &all.models {
        run(model);
    }
}

fn places(text: &str, all: &Understood) {
    let lines = Lines::of(text);
    let check = |span: Span| {
        assert!(span.start <= span.end);
        assert!(text.get(span.start as usize..span.end as usize).is_some());
        let (line, unit) = lines.utf16(span.start);
        assert_eq!(lines.utf16(lines.offset(line, unit)), (line, unit));
        assert!(lines.place(span.start) <= lines.place(span.end));
    };
    for one in &all.diagnostics {
        check(one.span);
        one.notes.iter().for_each(|(span, _)| check(*span));
        assert!(!one.message.is_empty() && !one.message.contains('\n'));
    }
    for model in &all.document.models {
        check(model.span);
        for section in &model.sections {
            check(section.span);
            for one in &section.names {
                check(one.name.span);
                assert_eq!(slice(text, one.name.span), one.name.text);
            }
        }
        for one in &model.equations {
            check(one.span);
            check(one.value.span);
        }
    }
}

/// All tokens that are no comments, in order, and all comments without white space, in any order.
fn words(text: &str) -> (Vec<&str>, Vec<String>) {
    let (comments, words): (Vec<_>, Vec<_>) =
        lexer::tokens(text).partition(|one| one.kind.is_comment());
    let plain = |one: &lexer::Token| slice(text, one.span).split_whitespace().collect::<String>();
    let mut comments: Vec<String> = comments.iter().map(plain).collect();
    comments.sort();
    // Spaces in units stay or go at their ends only, so words are compared as they are.
    (
        words.iter().map(|one| slice(text, one.span)).collect(),
        comments,
    )
}

/// All names with what is said of them.
fn names(all: &Understood) -> Vec<(String, Option<String>)> {
    let mut found = Vec::new();
    for model in &all.document.models {
        let doc = model.doc.as_ref().map(|doc| doc.text.clone());
        found.push((model.name.text.clone(), doc));
        for one in model.sections.iter().flat_map(|one| &one.names) {
            let doc = one.doc.as_ref().map(|doc| doc.text.clone());
            found.push((one.name.text.clone(), doc));
        }
    }
    found
}

fn same(one: &Model, other: &Model) {
    assert_eq!(one.equations.len(), other.equations.len());
    for (one, other) in one.equations.iter().zip(&other.equations) {
        assert_eq!(
            (one.target, one.is_derivative),
            (other.target, other.is_derivative)
        );
        assert_eq!(one.value, other.value);
    }
}

/// The machine and the reference give the same, whatever that is.
fn run(model: &Model) {
    let numbers = |count: usize| (0..count).map(|at| 0.5 + at as f64).collect::<Vec<f64>>();
    let params = numbers(model.of_kind(Kind::Param).count());
    let Ok(mut robot) = Robot::new(model, &params) else {
        return;
    };
    let code = equations(model).expect("a robot has code");
    let (state, action) = (numbers(robot.states()), numbers(robot.actions()));
    let mut derivative = vec![0.0; robot.states()];
    robot.derivative(&state, &action, &mut derivative);
    let expected = code.derivative.reference(&state, &action, &params);
    assert_eq!(derivative.len(), expected.len());
    for (one, other) in derivative.iter().zip(&expected) {
        let is_same =
            one.to_bits() == other.to_bits() || (one.is_nan() && other.is_nan()) || one == other;
        assert!(is_same, "{one} and {other}");
    }
}
