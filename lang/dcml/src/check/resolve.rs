//! Expressions of names to expressions of symbols.
//!
//! Owns the rules of names, functions, conditions and zeros in them.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::function::Function;
use super::super::model::{Condition, Expr, SymbolId};
use super::super::nearest::nearest;
use super::super::parser::shown;
use super::super::syntax::{ExprText, Kind, Name, Node, Operator};
use super::Checker;

impl<'a> Checker<'a, '_> {
    /// What an expression means; nothing if it has errors, which are told. All symbols that it has are added to `used`.
    pub(super) fn resolve(&mut self, text: &'a ExprText, used: &mut Vec<SymbolId>) -> Option<Expr> {
        match &text.node {
            Node::Number(number) => Some(Expr::Number(*number)),
            Node::Name(name) => self.name(text, name, used),
            Node::Sign(minus, inside) => {
                let inside = self.resolve(inside, used)?;
                Some(if *minus {
                    Expr::Negative(Box::new(inside))
                } else {
                    inside
                })
            }
            Node::Binary(operator, left, right) => {
                // Both sides, so that the errors of both are told.
                let value = self.resolve(left, used);
                let by = self.resolve(right, used);
                if *operator == Operator::Divide {
                    self.zero(right)?;
                }
                Some(Expr::Binary(*operator, Box::new(value?), Box::new(by?)))
            }
            Node::Call(name, arguments) if name.text == "piecewise" => {
                self.piecewise(text, arguments, used)
            }
            Node::Call(name, arguments) if name.text == "d" && !self.ids.contains_key("d") => {
                self.derivative(text, arguments, used)
            }
            Node::Call(name, arguments) => self.call(text, name, arguments, used),
            Node::Compare(_, left, right) => {
                let found = Diagnostic::new(
                    Code::MisplacedComparison,
                    text.span,
                    "a comparison is no value",
                    "not a number",
                );
                let hint = "write `piecewise(condition, value, otherwise)`; it holds where the condition does";
                self.findings.add(found.hint(hint));
                self.resolve(left, used);
                self.resolve(right, used);
                None
            }
            Node::Broken => None,
        }
    }

    fn name(
        &mut self,
        text: &'a ExprText,
        name: &'a str,
        used: &mut Vec<SymbolId>,
    ) -> Option<Expr> {
        if let Some(&id) = self.ids.get(name) {
            used.push(id);
            return Some(Expr::Symbol(id));
        }
        match name {
            "pi" => Some(Expr::Number(std::f64::consts::PI)),
            "e" => Some(Expr::Number(std::f64::consts::E)),
            _ => {
                self.undeclared(name, text.span, "not declared");
                None
            }
        }
    }

    fn call(
        &mut self,
        text: &'a ExprText,
        name: &'a Name,
        arguments: &'a [ExprText],
        used: &mut Vec<SymbolId>,
    ) -> Option<Expr> {
        let mut values = Vec::with_capacity(arguments.len().min(2));
        let mut is_right = true;
        for one in arguments {
            match self.resolve(one, used) {
                Some(value) => values.push(value),
                None => is_right = false,
            }
        }
        let Some(function) = Function::named(&name.text) else {
            self.unknown_function(name);
            return None;
        };
        let wanted = function.arguments();
        if arguments.len() != wanted {
            let plural = if wanted == 1 { "argument" } else { "arguments" };
            let message = format!(
                "`{}` has {wanted} {plural}, not {}",
                name.text,
                arguments.len()
            );
            let found = Diagnostic::new(
                Code::ArgumentCount,
                text.span,
                message,
                format!("{wanted} {plural} expected"),
            );
            let form = if wanted == 1 {
                "(x)"
            } else if function == Function::Atan2 {
                "(y, x)"
            } else {
                "(x, y)"
            };
            self.findings
                .add(found.hint(format!("write `{}{form}`", name.text)));
            return None;
        }
        is_right.then_some(Expr::Call(function, values))
    }

    fn unknown_function(&mut self, name: &'a Name) {
        let word = name.text.as_str();
        let message = format!("there is no function `{}`", shown(word));
        let found = Diagnostic::new(Code::UnknownFunction, name.span, message, "not a function");
        let all = Function::ALL.map(Function::name);
        let hint = if let Some(&id) = self.ids.get(word) {
            self.used[id] = true;
            format!(
                "`{0}` is a value: to multiply write `{0} * (...)`",
                shown(word)
            )
        } else if let Some(known) = known_elsewhere(word) {
            format!("write `{known}`")
        } else if let Some(meant) = nearest(word, all.into_iter().chain(["piecewise"])) {
            format!("did you mean `{meant}`?")
        } else {
            format!("there are {}", all.join(", "))
        };
        self.findings.add(found.hint(hint));
    }

    /// Whether a divisor is surely 0.
    fn zero(&mut self, divisor: &'a ExprText) -> Option<()> {
        let mut inside = divisor;
        while let Node::Sign(_, deeper) = &inside.node {
            inside = deeper;
        }
        match &inside.node {
            Node::Number(number) if *number == 0.0 => {
                let found = Diagnostic::new(
                    Code::DivisionByZero,
                    divisor.span,
                    "a division by 0 has no value",
                    "this is 0",
                );
                self.findings.add(found);
                None
            }
            Node::Name(name) => {
                let symbol = self.ids.get(name.as_str()).map(|id| &self.symbols[*id]);
                if let Some(symbol) =
                    symbol.filter(|one| one.kind == Kind::Const && one.value == 0.0)
                    && !self.text.damage.any
                {
                    let message =
                        format!("a division by `{}`, which is 0, has no value", shown(name));
                    let found =
                        Diagnostic::new(Code::ZeroConstant, divisor.span, message, "this is 0");
                    let found = found.note(symbol.span, "declared here");
                    self.findings.add(found);
                }
                Some(())
            }
            _ => Some(()),
        }
    }

    fn piecewise(
        &mut self,
        text: &'a ExprText,
        arguments: &'a [ExprText],
        used: &mut Vec<SymbolId>,
    ) -> Option<Expr> {
        if arguments.len() < 3 || arguments.len().is_multiple_of(2) {
            let message = format!(
                "`piecewise` has an odd number of arguments, at least 3, not {}",
                arguments.len()
            );
            let found = Diagnostic::new(
                Code::ArgumentCount,
                text.span,
                message,
                "conditions, values and the rest",
            );
            self.findings.add(
                found.hint("write `piecewise(condition, value, condition, value, otherwise)`"),
            );
            return None;
        }
        let mut cases = Vec::with_capacity(arguments.len() / 2);
        let mut is_right = true;
        let (pairs, rest) = arguments.as_chunks::<2>();
        for [condition, value] in pairs {
            let condition = self.condition(condition, used);
            let value = self.resolve(value, used);
            match (condition, value) {
                (Some(condition), Some(value)) => cases.push((condition, value)),
                _ => is_right = false,
            }
        }
        let otherwise = self.resolve(rest.first()?, used)?;
        is_right.then(|| Expr::Piecewise(cases, Box::new(otherwise)))
    }

    fn condition(&mut self, text: &'a ExprText, used: &mut Vec<SymbolId>) -> Option<Condition> {
        let Node::Compare(comparison, left, right) = &text.node else {
            if text.node != Node::Broken {
                let found = Diagnostic::new(
                    Code::NoCondition,
                    text.span,
                    "this is no condition",
                    "a comparison expected",
                );
                self.findings
                    .add(found.hint("compare two values with `<`, `<=`, `>` or `>=`"));
            }
            self.resolve(text, used);
            return None;
        };
        let left = self.resolve(left, used);
        let right = self.resolve(right, used);
        Some(Condition {
            comparison: *comparison,
            left: left?,
            right: right?,
        })
    }
}

/// How something is written here that other languages have.
fn known_elsewhere(word: &str) -> Option<&'static str> {
    Some(match word {
        "ln" => "log(x)",
        "log10" => "log(x) / log(10)",
        "log2" => "log(x) / log(2)",
        "arctan" | "atg" | "arctg" => "atan(x)",
        "arcsin" => "asin(x)",
        "arccos" => "acos(x)",
        "arctan2" => "atan2(y, x)",
        "tg" => "tan(x)",
        "ctg" | "cot" => "1 / tan(x)",
        "fabs" => "abs(x)",
        "sgn" | "signum" => "sign(x)",
        "sqr" | "square" => "pow(x, 2)",
        "cbrt" => "pow(x, 1 / 3)",
        "power" => "pow(x, y)",
        "hypot" => "sqrt(x * x + y * y)",
        "ceil" => "-floor(-x)",
        "round" => "floor(x + 0.5)",
        "mod" | "fmod" => "x - y * floor(x / y)",
        "sinh" => "(exp(x) - exp(-x)) / 2",
        "cosh" => "(exp(x) + exp(-x)) / 2",
        "tanh" => "1 - 2 / (exp(2 * x) + 1)",
        "if" | "ite" | "select" => "piecewise(condition, value, otherwise)",
        _ => return None,
    })
}
