//! What needs what: an order of equations, or the circles that leave none.
//!
//! Owns the search, which is as deep as models are long and so keeps its own stack.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::model::SymbolId;
use super::super::parser::shown;
use super::Checker;
use crate::limits::DCML_SHOWN;

/// How far the search is with an equation.
#[derive(Clone, Copy, Eq, PartialEq)]
enum Mark {
    New,
    Open,
    Done,
}

impl Checker<'_, '_> {
    /// Equations of values, each after what it needs and else in the order of the text; then those of derivatives in the
    /// order of declaration. Circles are told.
    pub(super) fn order(
        &mut self,
        targets: &[Option<SymbolId>],
        uses: &[Vec<SymbolId>],
    ) -> Vec<usize> {
        // A derivative that an expression has is a value too.
        let is_value = |at: usize| {
            targets[at].is_some_and(|id| {
                !self.text.equations[at].is_derivative || self.rates.contains_key(&id)
            })
        };
        let value_of = |id: SymbolId| {
            let at = self.equation_of[id].filter(|at| *at < targets.len() && is_value(*at))?;
            // The state itself is given, whatever its derivative needs.
            (!self.text.equations[at].is_derivative || self.is_rate(id)).then_some(at)
        };
        let mut marks = vec![Mark::New; targets.len()];
        let mut circles: Vec<Vec<usize>> = Vec::new();
        let mut in_circle = vec![false; targets.len()];
        let mut order = Vec::with_capacity(targets.len());
        let mut path: Vec<(usize, usize)> = Vec::new();
        for root in (0..targets.len()).filter(|at| is_value(*at)) {
            if marks[root] == Mark::New {
                marks[root] = Mark::Open;
                path.push((root, 0));
            }
            while let Some((at, next)) = path.last_mut() {
                let at = *at;
                let Some(needed) = uses[at].get(*next).map(|id| value_of(*id)) else {
                    marks[at] = Mark::Done;
                    order.push(at);
                    path.pop();
                    continue;
                };
                *next += 1;
                match needed.map(|needed| (needed, marks[needed])) {
                    Some((needed, Mark::New)) => {
                        marks[needed] = Mark::Open;
                        path.push((needed, 0));
                    }
                    // Of circles that touch each other one is told: the next is seen when that is mended.
                    Some((needed, Mark::Open)) if !in_circle[at] && !in_circle[needed] => {
                        let from = path.iter().rposition(|(one, _)| *one == needed);
                        let circle = path[from.unwrap_or_default()..].iter().map(|(one, _)| *one);
                        let circle: Vec<usize> = circle.collect();
                        circle.iter().for_each(|one| in_circle[*one] = true);
                        circles.push(circle);
                    }
                    _ => {}
                }
            }
        }
        for circle in circles {
            self.circle(&circle);
        }
        let of_states = self.equation_of.iter().enumerate();
        let of_states = of_states.filter(|(id, _)| !self.is_rate(*id));
        let derivatives = of_states.filter_map(|(_, at)| *at);
        order.extend(derivatives.filter(|at| {
            let equation = self.text.equations.get(*at);
            equation.is_some_and(|one| one.is_derivative)
        }));
        order
    }

    fn circle(&mut self, circle: &[usize]) {
        let Some(first) = circle.first() else {
            return;
        };
        let name = |at: &usize| {
            let equation = &self.text.equations[*at];
            let name = shown(&equation.target.text);
            if equation.is_derivative {
                format!("d({name})")
            } else {
                name
            }
        };
        let mut names: Vec<String> = circle.iter().take(DCML_SHOWN).map(name).collect();
        if circle.len() > DCML_SHOWN {
            names.push(format!("({} more)", circle.len() - DCML_SHOWN));
        }
        names.push(name(first));
        let message = format!("values need each other in a circle: {}", names.join(" -> "));
        let label = if circle.len() == 1 {
            "needs itself".to_owned()
        } else {
            format!("needs `{}`", names[1])
        };
        let mut found = Diagnostic::new(
            Code::AlgebraicLoop,
            self.text.equations[*first].target.span,
            message,
            label,
        );
        for (place, at) in circle.iter().enumerate().skip(1).take(7) {
            let next = circle.get(place + 1).unwrap_or(first);
            let text = format!("needs `{}`", name(next));
            found = found.note(self.text.equations[*at].target.span, text);
        }
        let is_of_rates = circle
            .iter()
            .any(|at| self.text.equations[*at].is_derivative);
        let hint = if is_of_rates {
            "solve these equations for one of the derivatives by hand, and write that without the others"
        } else {
            "write one of them without the others, or make it a state with an equation `d(...)`"
        };
        self.findings.add(found.hint(hint));
    }
}
