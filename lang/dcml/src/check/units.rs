//! Whether what is added, compared and assigned measures the same, in the same size.
//!
//! Owns the rules. A plain number fits to everything; what has no unit is not known, and nothing is said of what it stands
//! in.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::function::Function;
use super::super::model::SymbolId;
use super::super::parser::shown;
use super::super::syntax::{Domain, ExprText, Node, Operator, Span};
use super::super::unit::Unit;
use super::Checker;

/// What is known of a value.
#[derive(Clone, Copy, Debug)]
enum Quantity {
    /// A number of the text, of whatever unit is wanted.
    Number,
    /// A unit.
    Known(Unit),
    /// Nothing.
    Unknown,
}

use Quantity::{Known, Number, Unknown};

impl Checker<'_, '_> {
    /// Reads all units and checks all equations, if there are any.
    pub(super) fn units(&mut self, targets: &[Option<SymbolId>]) {
        let mut units: Vec<Option<Unit>> = vec![None; self.symbols.len()];
        let mut is_any = false;
        for one in self.text.sections.iter().flat_map(|one| &one.names) {
            let Some(text) = &one.unit else {
                continue;
            };
            let unit = match Unit::read(&text.text) {
                Ok(unit) => unit,
                Err(why) => {
                    let message = format!("`[{}]` is no unit: {why}", shown(&text.text));
                    let found =
                        Diagnostic::new(Code::UnknownUnit, text.span, message, "not a unit");
                    self.findings
                        .add(found.hint("units are those of the SI: `m`, `cm`, `rad`, `deg`, `m/s`, `kg*m^2`; `1` is a number"));
                    continue;
                }
            };
            is_any = true;
            if matches!(one.domain, Some((Domain::Circle, _))) {
                self.fits(
                    text.span,
                    "an angle in S1 is measured in rad",
                    unit,
                    Unit::ONE,
                    &[],
                );
            }
            // A name that is declared twice is told; what it measures is what it is said to at first.
            if let Some(id) = self.ids.get(one.name.text.as_str()) {
                units[*id].get_or_insert(unit);
            }
        }
        if !is_any {
            return;
        }
        let text = self.text;
        for (equation, target) in text.equations.iter().zip(targets) {
            let value = self.quantity(&equation.value, &units);
            let unit = target.and_then(|id| units[id]);
            let unit = if equation.is_derivative {
                unit.and_then(|unit| unit.over(Unit::SECOND))
            } else {
                unit
            };
            if let (Some(unit), Known(value)) = (unit, value) {
                let name = shown(&equation.target.text);
                let what = if equation.is_derivative {
                    format!(
                        "the derivative of `{name}` is in [{unit}], and what it is set to is not"
                    )
                } else {
                    format!("`{name}` is in [{unit}], and what it is set to is not")
                };
                self.fits(
                    equation.value.span,
                    &what,
                    value,
                    unit,
                    &[(equation.target.span, unit)],
                );
            }
        }
    }

    /// Tells if two units differ; whether they do not.
    fn fits(
        &mut self,
        span: Span,
        what: &str,
        unit: Unit,
        wanted: Unit,
        others: &[(Span, Unit)],
    ) -> bool {
        let is_like = unit.is_like(wanted);
        if is_like && unit.is_as_large(wanted) {
            return true;
        }
        let code = if is_like {
            Code::UnitScale
        } else {
            Code::UnitMismatch
        };
        let mut found = Diagnostic::new(code, span, what, format!("[{unit}]"));
        for (span, unit) in others {
            found = found.note(*span, format!("[{unit}]"));
        }
        let hint = if is_like {
            format!(
                "use one unit for both, or convert with a constant: `CONST: m_per_cm [m/cm] = 0.01;`; here one is {} of the other",
                format!("{:.6e}", unit.scale / wanted.scale)
                    .parse::<f64>()
                    .unwrap_or_default()
            )
        } else {
            "look for a factor that is missing, or for a unit that is wrong".to_owned()
        };
        self.findings.add(found.hint(hint));
        false
    }

    /// Two values that are added, compared or chosen from.
    fn same(&mut self, what: &str, left: (Span, Quantity), right: (Span, Quantity)) -> Quantity {
        match (left.1, right.1) {
            (Known(one), Known(other)) => {
                if self.fits(right.0, what, other, one, &[(left.0, one)]) {
                    Known(one)
                } else {
                    Unknown
                }
            }
            (Unknown, _) | (_, Unknown) => Unknown,
            (Known(one), Number) | (Number, Known(one)) => Known(one),
            (Number, Number) => Number,
        }
    }

    fn quantity(&mut self, text: &ExprText, units: &[Option<Unit>]) -> Quantity {
        match &text.node {
            Node::Number(_) => Number,
            Node::Name(name) => match self.ids.get(name.as_str()) {
                Some(id) => units[*id].map_or(Unknown, Known),
                None if matches!(name.as_str(), "pi" | "e") => Known(Unit::ONE),
                None => Unknown,
            },
            Node::Sign(_, inside) => self.quantity(inside, units),
            Node::Binary(operator, left, right) => {
                let one = self.quantity(left, units);
                let other = self.quantity(right, units);
                match operator {
                    Operator::Add => self.same(
                        "these are not of one unit and are added",
                        (left.span, one),
                        (right.span, other),
                    ),
                    Operator::Subtract => self.same(
                        "these are not of one unit and are subtracted",
                        (left.span, one),
                        (right.span, other),
                    ),
                    Operator::Multiply => joined(one, other, Unit::times),
                    Operator::Divide => joined(one, other, Unit::over),
                }
            }
            Node::Compare(_, left, right) => {
                let one = self.quantity(left, units);
                let other = self.quantity(right, units);
                self.same(
                    "these are not of one unit and are compared",
                    (left.span, one),
                    (right.span, other),
                )
            }
            Node::Call(name, arguments) => {
                let values: Vec<_> = arguments
                    .iter()
                    .map(|one| (one.span, self.quantity(one, units)))
                    .collect();
                if name.text == "piecewise" {
                    return self.choice(&values);
                }
                if let ("d", [(_, Known(unit))]) = (name.text.as_str(), values.as_slice()) {
                    return unit.over(Unit::SECOND).map_or(Unknown, Known);
                }
                match (Function::named(&name.text), values.as_slice()) {
                    (Some(function), [x]) => self.of_call(function, *x, *x),
                    (Some(Function::Pow), [x, y]) => self.power(*x, *y, &arguments[1]),
                    (Some(function), [x, y]) => self.of_call(function, *x, *y),
                    _ => Unknown,
                }
            }
            Node::Broken => Unknown,
        }
    }

    /// All values of a `piecewise`, which has conditions at even places but the last.
    fn choice(&mut self, values: &[(Span, Quantity)]) -> Quantity {
        let last = values.len().saturating_sub(1);
        let chosen = values
            .iter()
            .enumerate()
            .filter(|(at, _)| at % 2 == 1 || *at == last);
        let mut all: Option<(Span, Quantity)> = None;
        for (_, value) in chosen {
            all = Some(match all {
                None => *value,
                Some(first) => (
                    first.0,
                    self.same(
                        "these are not of one unit, and one of them is chosen",
                        first,
                        *value,
                    ),
                ),
            });
        }
        all.map_or(Unknown, |(_, quantity)| quantity)
    }

    fn of_call(
        &mut self,
        function: Function,
        x: (Span, Quantity),
        y: (Span, Quantity),
    ) -> Quantity {
        match function {
            Function::Sin | Function::Cos | Function::Tan => {
                self.plain(x, &format!("`{}` is of an angle in rad", function.name()));
                Known(Unit::ONE)
            }
            Function::Asin | Function::Acos | Function::Atan | Function::Exp | Function::Log => {
                self.plain(
                    x,
                    &format!("`{}` is of a number without a unit", function.name()),
                );
                Known(Unit::ONE)
            }
            Function::Atan2 => {
                self.same("these are not of one unit, and `atan2` is of both", x, y);
                Known(Unit::ONE)
            }
            Function::Min | Function::Max => {
                self.same("these are not of one unit and are compared", x, y)
            }
            Function::Abs | Function::Floor => x.1,
            Function::Sign => Known(Unit::ONE),
            Function::Sqrt => match x.1 {
                Known(unit) => unit.power(0.5).map_or(Unknown, Known),
                other => other,
            },
            // It is looked at with its exponent.
            Function::Pow => Unknown,
        }
    }

    fn plain(&mut self, value: (Span, Quantity), what: &str) {
        if let Known(unit) = value.1 {
            self.fits(value.0, what, unit, Unit::ONE, &[]);
        }
    }

    fn power(&mut self, x: (Span, Quantity), y: (Span, Quantity), exponent: &ExprText) -> Quantity {
        self.plain(y, "an exponent is a number without a unit");
        match (x.1, literal(exponent)) {
            (Known(unit), Some(number)) => unit.power(number).map_or(Unknown, Known),
            (Known(unit), None) if unit == Unit::ONE => Known(unit),
            (Number, _) => Number,
            _ => Unknown,
        }
    }
}

fn joined(one: Quantity, other: Quantity, join: fn(Unit, Unit) -> Option<Unit>) -> Quantity {
    let unit = |quantity| match quantity {
        Known(unit) => Some(unit),
        Number => Some(Unit::ONE),
        Unknown => None,
    };
    match (one, other) {
        (Number, Number) => Number,
        _ => match (unit(one), unit(other)) {
            (Some(one), Some(other)) => join(one, other).map_or(Unknown, Known),
            _ => Unknown,
        },
    }
}

/// The number that an expression is, if it is one.
fn literal(text: &ExprText) -> Option<f64> {
    match &text.node {
        Node::Number(number) => Some(*number),
        Node::Sign(minus, inside) => {
            literal(inside).map(|number| if *minus { -number } else { number })
        }
        Node::Binary(Operator::Divide, one, other) => Some(literal(one)? / literal(other)?),
        _ => None,
    }
}
