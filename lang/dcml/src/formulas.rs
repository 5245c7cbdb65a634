//! Actions as formulas of time: `u_l = 2 + sin(t); u_r = 3`.
//!
//! Owns the small model that such a text becomes a part of, and the way of its findings back to the text. The language of
//! the formulas is that of models.

use super::diagnostic::{Code, Diagnostic, Severity};
use super::robot::Robot;
use super::syntax::Span;
use super::system::System;
use super::{Understood, understand};

/// Formulas that can be asked for their values.
#[derive(Clone, Debug)]
pub struct Formulas {
    /// A robot without states, with time as its action.
    robot: Robot,
}

/// Why there are none.
#[derive(Clone, Debug, PartialEq)]
pub enum Wrong {
    /// What is wrong with the text, with places in it.
    Text(Vec<Diagnostic>),
    /// A name without a formula.
    Missing(String),
    /// What else is wrong, as a sentence.
    Other(String),
}

impl Formulas {
    /// One formula of `t` for each of these names, whose order is that of the values.
    ///
    /// # Errors
    ///
    /// [`Wrong`]
    pub fn new(text: &str, names: &[&str]) -> Result<Self, Wrong> {
        let other = |why: &str| Wrong::Other(why.into());
        if names.is_empty() {
            return Err(other("there is nothing that a formula could give"));
        }
        if names.contains(&"t") {
            return Err(other(
                "an action is called t, which is time in formulas: give a table of actions",
            ));
        }
        let before = format!("BEGIN Actions\nACTION: t;\nCONFIG: {};\n", names.join(", "));
        let whole = |end: &str| format!("{before}{text}\n{end}\nEND;\n");
        // The last semicolon may be left out.
        let [left, right] = ["", ";"].map(|end| understand(&whole(end)));
        let mut understood = if errors(&left).count() <= errors(&right).count() {
            left
        } else {
            right
        };
        let own = before.len()..before.len() + text.len();
        let errors: Vec<&Diagnostic> = errors(&understood).collect();
        if let Some(missing) = errors.iter().find_map(|one| missing(&before, one)) {
            return Err(Wrong::Missing(missing));
        }
        if !errors.is_empty() {
            let shifted = |one: &&Diagnostic| shifted(one, &own);
            return Err(Wrong::Text(errors.iter().map(shifted).collect()));
        }
        let only = understood
            .models
            .pop()
            .filter(|_| understood.models.is_empty());
        let model = only.ok_or_else(|| other("write formulas alone: NAME = FORMULA; ..."))?;
        if model.symbols.len() != names.len() + 1 || model.states().next().is_some() {
            return Err(other(
                "write formulas alone, without sections and derivatives: NAME = FORMULA; ...",
            ));
        }
        let robot = Robot::new(&model, &[]).map_err(|refused| Wrong::Other(refused.to_string()))?;
        Ok(Self { robot })
    }

    /// The values at a time in s, as many as there are names.
    pub fn at(&mut self, time: f64, values: &mut [f64]) {
        debug_assert_eq!(self.robot.states(), 0);
        self.robot.output(&[], &[time], values);
    }
}

fn errors(understood: &Understood) -> impl Iterator<Item = &Diagnostic> {
    let all = understood.diagnostics.iter();
    all.filter(|one| one.severity == Severity::Error)
}

/// The name that has no formula, if it is that: an error at a name of the first lines.
fn missing(before: &str, one: &Diagnostic) -> Option<String> {
    let name = before.get(one.span.start as usize..one.span.end as usize)?;
    (one.code == Code::MissingEquation).then(|| name.to_owned())
}

/// A finding with places in the text itself.
fn shifted(one: &Diagnostic, own: &std::ops::Range<usize>) -> Diagnostic {
    let shift = |span: Span| {
        let inside = |at: u32| ((at as usize).clamp(own.start, own.end) - own.start) as u32;
        Span {
            start: inside(span.start),
            end: inside(span.end),
        }
    };
    let is_inside = |span: &Span| own.contains(&(span.start as usize));
    let mut one = one.clone();
    one.notes.retain(|(span, _)| is_inside(span));
    for (span, _) in &mut one.notes {
        *span = shift(*span);
    }
    one.span = shift(one.span);
    if one.code == Code::UndeclaredName {
        one.hint = Some("a formula can use the time t, pi, e and the functions".into());
    }
    one
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_of_time_are_values() {
        let names = ["u_l", "u_r"];
        for text in [
            "u_l = 2 + sin(t); u_r = 3",
            "u_r = 3;\nu_l = 2 + sin(t); // wheels",
            " u_r=3; u_l=piecewise(t < 10, 2 + sin(t), 0) ;",
        ] {
            let mut formulas = Formulas::new(text, &names).unwrap_or_else(|why| panic!("{why:?}"));
            let mut values = [0.0; 2];
            formulas.at(0.5, &mut values);
            assert_eq!(values, [2.0 + 0.5_f64.sin(), 3.0], "{text}");
        }
    }

    #[test]
    fn findings_have_places_in_the_text() {
        let text = "u = 2 + sin(tt)";
        let Err(Wrong::Text(found)) = Formulas::new(text, &["u"]) else {
            panic!("tt is nothing");
        };
        let span = found[0].span;
        assert_eq!(&text[span.start as usize..span.end as usize], "tt");
        assert_eq!(
            Formulas::new("u = t", &["u", "v"]).err(),
            Some(Wrong::Missing("v".into()))
        );
    }

    #[test]
    fn what_is_no_formula_is_refused() {
        for text in [
            "",
            ";",
            "u",
            "u = ",
            "u = t; END; BEGIN Other ACTION: a; CONFIG: b; b = a",
            "u = t; VAR: k; k = u",
            "d(u) = t",
            "u = w; w = t",
            "u = u",
            "u = \u{0}",
            "u = 1 /*",
            "u = t; u = t",
        ] {
            assert!(Formulas::new(text, &["u"]).is_err(), "{text}");
        }
        assert!(matches!(
            Formulas::new("t = 1", &["t"]),
            Err(Wrong::Other(_))
        ));
        assert!(Formulas::new("u = t", &[]).is_err());
    }
}
