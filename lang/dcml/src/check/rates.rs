//! Derivatives in expressions: `d(x)` on the right side of an equation.
//!
//! Owns which may stand there, and the variables that hold them: the derivative is computed once, before what needs it, and
//! all that comes after the check sees one more `VAR`.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::model::{Expr, Symbol, SymbolId};
use super::super::parser::shown;
use super::super::syntax::{ExprText, Kind, Node};
use super::Checker;

impl<'a> Checker<'a, '_> {
    /// What `d(...)` in an expression means; nothing if it has errors, which are told.
    pub(super) fn derivative(
        &mut self,
        text: &'a ExprText,
        arguments: &'a [ExprText],
        used: &mut Vec<SymbolId>,
    ) -> Option<Expr> {
        let [
            ExprText {
                node: Node::Name(name),
                span,
            },
        ] = arguments
        else {
            for one in arguments {
                self.resolve(one, used);
            }
            let found = Diagnostic::new(
                Code::NotDerivable,
                text.span,
                "only a name of `CONFIG` has a derivative",
                "one name expected",
            );
            self.findings.add(
                found.hint("write `d(x)`; of a whole expression write the derivative by hand"),
            );
            return None;
        };
        let Some(&id) = self.ids.get(name.as_str()) else {
            self.undeclared(name, *span, "not declared");
            return None;
        };
        used.push(id);
        let (kind, declared) = (self.symbols[id].kind, self.symbols[id].span);
        if kind != Kind::Config {
            let name = shown(name);
            let message = format!("`{name}` is no `CONFIG`, and only those have a derivative");
            let found = Diagnostic::new(Code::NotDerivable, *span, message, "no `CONFIG`");
            let hint = format!("move `{name}` to `CONFIG` and write `d({name}) = ...;`");
            self.findings
                .add(found.note(declared, "declared here").hint(hint));
            return None;
        }
        let equation = self.equation_of[id].and_then(|at| self.text.equations.get(at));
        if let Some(equation) = equation.filter(|one| !one.is_derivative) {
            let name = shown(name);
            let message =
                format!("`{name}` is computed from other values, and its derivative is not known");
            let found = Diagnostic::new(Code::NotDerivable, *span, message, "no state");
            let hint = format!(
                "give `{name}` an equation `d({name}) = ...;`, or write its derivative by hand"
            );
            self.findings.add(
                found
                    .note(equation.target.span, "its equation is here")
                    .hint(hint),
            );
            return None;
        }
        let rate = self.rate(id);
        used.push(rate);
        Some(Expr::Symbol(rate))
    }

    /// The variable that holds the derivative of a symbol.
    fn rate(&mut self, id: SymbolId) -> SymbolId {
        if let Some(&rate) = self.rates.get(&id) {
            return rate;
        }
        let mut name = format!("d_{}", self.symbols[id].name);
        while self.ids.contains_key(name.as_str()) || !self.rate_names.insert(name.clone()) {
            name.push('_');
        }
        let rate = self.symbols.len();
        self.symbols.push(Symbol {
            name,
            span: self.symbols[id].span,
            kind: Kind::Var,
            doc: None,
            unit: None,
            domain: None,
            value: 0.0,
        });
        self.used.push(true);
        self.equation_of.push(None);
        self.rates.insert(id, rate);
        rate
    }

    /// Gives each of these variables the equation of the derivative.
    pub(super) fn rate_equations(&mut self) {
        for (&id, &rate) in &self.rates {
            // Without one it is told of the state itself.
            self.equation_of[rate] = self.equation_of[id].or(Some(usize::MAX));
        }
    }

    /// Whether a symbol is one of these variables: they come after all that is declared.
    pub(super) fn is_rate(&self, id: SymbolId) -> bool {
        id >= self.symbols.len() - self.rates.len()
    }
}
