//! LaTeX: the equations as their author wrote them, for people; Jacobians as matrices.
//!
//! Owns how mathematics is set: Greek letters, indices, fractions. The text is a fragment that needs amsmath.

use super::about;
use super::graph::Scene;
use super::names::letters;
use super::plan::{Body, Dialect, Level, Planner, Text, digits};
use super::row::Row;
use crate::function::Function;
use crate::limits;
use crate::model::{Condition, Expr, Symbol};
use crate::syntax::{Comparison, Kind, Operator};
use crate::tape::{Input, ValueId};
use std::collections::{HashMap, HashSet};
use std::f64::consts::{E, PI};

pub(super) const ROW: Row = Row {
    name: "latex",
    ending: "tex",
    values_max: usize::MAX,
    print,
};

const GREEK: &str = "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon \
    phi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega";

struct Latex<'m> {
    /// What a name of the planner is set as.
    names: HashMap<String, String>,
    symbols: &'m [Symbol],
}

/// A name as a symbol with indices.
fn set(name: &str) -> String {
    let name = letters(name, limits::DCML_SYMBOL_BYTES);
    let mut parts = name.split('_').filter(|part| !part.is_empty());
    let first = parts.next().unwrap_or("x");
    let mut indices: Vec<String> = Vec::new();
    let stem = first.trim_end_matches(|last: char| last.is_ascii_digit());
    let is_greek = |word: &str| GREEK.split_whitespace().any(|one| one == word);
    let mut out = if is_greek(stem) || stem.len() == 1 {
        if stem.len() < first.len() {
            indices.push(first[stem.len()..].to_owned());
        }
        word(stem)
    } else {
        word(first)
    };
    indices.extend(parts.map(word));
    if !indices.is_empty() {
        out.push_str(&format!("_{{{}}}", indices.join(",")));
    }
    out
}

/// A word alone.
fn word(word: &str) -> String {
    if GREEK.split_whitespace().any(|one| one == word) {
        return format!("\\{word}").replace("\\epsilon", "\\varepsilon");
    }
    match word.len() {
        0 | 1 => word.to_owned(),
        _ if word.chars().all(|one| one.is_ascii_digit()) => word.to_owned(),
        _ => format!("\\mathrm{{{word}}}"),
    }
}

/// A name that is set like no other one.
fn exact(name: &str) -> String {
    let name = letters(name, limits::DCML_SYMBOL_BYTES).replace('_', "\\_");
    format!("\\mathtt{{{name}}}")
}

fn in_parentheses(text: &str) -> String {
    format!("\\left({text}\\right)")
}

fn tight(text: Text, level: Level) -> String {
    if text.level < level {
        in_parentheses(&text.text)
    } else {
        text.text
    }
}

impl Dialect for Latex<'_> {
    fn number(&self, number: f64) -> Text {
        for (value, name) in [
            (PI, "\\pi"),
            (PI / 2.0, "\\tfrac{\\pi}{2}"),
            (PI / 4.0, "\\tfrac{\\pi}{4}"),
            (E, "\\mathrm{e}"),
        ] {
            if number == value {
                return Text::whole(name);
            }
        }
        let digits = digits(number);
        let digits = digits.strip_suffix(".0").unwrap_or(&digits);
        let text = match digits.split_once('e') {
            Some((digits, exponent)) => {
                format!("{} \\cdot 10^{{{exponent}}}", digits.trim_end_matches(".0"))
            }
            None => digits.to_owned(),
        };
        Text {
            level: match (text.starts_with('-'), digits.contains('e')) {
                (true, _) => Level::Sum,
                (_, true) => Level::Product,
                _ => Level::Whole,
            },
            ..Text::number(text)
        }
    }

    fn input(&self, _: Input, name: &str) -> String {
        self.set(name)
    }

    fn reference(&self, name: &str) -> String {
        self.set(name)
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        let arguments = match function.arguments() {
            1 => in_parentheses(&x.text),
            _ => in_parentheses(&format!("{}, {}", x.text, y.text)),
        };
        let name = match function {
            Function::Sqrt => return Text::whole(format!("\\sqrt{{{}}}", x.text)),
            Function::Abs => return Text::whole(format!("\\left|{}\\right|", x.text)),
            Function::Floor => {
                return Text::whole(format!("\\left\\lfloor {}\\right\\rfloor ", x.text));
            }
            Function::Exp => {
                return Text::new(format!("\\mathrm{{e}}^{{{}}}", x.text), Level::Power);
            }
            Function::Pow => {
                let x = tight(x, Level::Whole);
                return Text::new(format!("{{{x}}}^{{{}}}", y.text), Level::Power);
            }
            Function::Asin => "\\arcsin",
            Function::Acos => "\\arccos",
            Function::Atan => "\\arctan",
            Function::Atan2 => "\\operatorname{atan2}",
            Function::Log => "\\ln",
            Function::Sign => "\\operatorname{sign}",
            Function::Sin | Function::Cos | Function::Tan | Function::Min | Function::Max => {
                &format!("\\{}", function.name())
            }
        };
        Text::whole(format!("{name}{arguments}"))
    }

    fn select(&self, comparison: Comparison, [left, right, yes, no]: [Text; 4]) -> Text {
        let (left, right) = (left.text, right.text);
        let sign = relation(comparison);
        Text::whole(format!(
            "\\begin{{cases}} {} & \\text{{if }} {left} {sign} {right} \\\\ {} & \\text{{otherwise}} \\end{{cases}}",
            yes.text, no.text
        ))
    }

    fn negative(&self, value: Text) -> Text {
        Text::new(format!("-{}", tight(value, Level::Product)), Level::Sum)
    }

    fn binary(&self, operator: Operator, left: Text, right: Text) -> Text {
        let has_sign = right.text.starts_with('-');
        let right_level = if has_sign {
            Level::Whole
        } else {
            Level::Product
        };
        match operator {
            Operator::Add => {
                let text = format!("{} + {}", left.text, tight(right, right_level));
                Text::new(text, Level::Sum)
            }
            Operator::Subtract => {
                let text = format!("{} - {}", left.text, tight(right, right_level));
                Text::new(text, Level::Sum)
            }
            Operator::Multiply => {
                let digit = right.text.starts_with(|first: char| first.is_ascii_digit());
                let sign = if digit || right.is_number {
                    "\\cdot "
                } else {
                    "\\,"
                };
                let (left, right) = (tight(left, Level::Product), tight(right, Level::Product));
                Text::new(format!("{left} {sign}{right}"), Level::Product)
            }
            Operator::Divide => Text::new(
                format!("\\frac{{{}}}{{{}}}", left.text, right.text),
                Level::Product,
            ),
        }
    }
}

const fn relation(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Less => "<",
        Comparison::LessOrEqual => "\\le",
        Comparison::Greater => ">",
        Comparison::GreaterOrEqual => "\\ge",
    }
}

impl Latex<'_> {
    /// A name of the planner. Its temporaries stand as they are.
    fn set(&self, name: &str) -> String {
        self.names.get(name).cloned().unwrap_or_else(|| set(name))
    }

    /// An expression as it was written.
    fn expr(&self, expr: &Expr, planner: &Planner<'_, '_>) -> Text {
        match expr {
            Expr::Number(number) => self.number(*number),
            Expr::Symbol(id) => {
                let name = self.symbols.get(*id).map_or("", |one| planner.symbol(one));
                Text::whole(self.set(name))
            }
            Expr::Negative(value) => self.negative(self.expr(value, planner)),
            Expr::Binary(operator, left, right) => self.binary(
                *operator,
                self.expr(left, planner),
                self.expr(right, planner),
            ),
            Expr::Call(function, arguments) => {
                let mut all = arguments.iter().map(|one| self.expr(one, planner));
                let x = all.next().unwrap_or_else(|| Text::whole(""));
                let y = all.next().unwrap_or_else(|| Text::whole(""));
                self.call(*function, x, y)
            }
            Expr::Piecewise(cases, otherwise) => self.cases(cases, otherwise, planner),
        }
    }

    fn cases(
        &self,
        cases: &[(Condition, Expr)],
        otherwise: &Expr,
        planner: &Planner<'_, '_>,
    ) -> Text {
        let mut out = "\\begin{cases} ".to_owned();
        for (condition, value) in cases {
            out.push_str(&format!(
                "{} & \\text{{if }} {} {} {} \\\\ ",
                self.expr(value, planner).text,
                self.expr(&condition.left, planner).text,
                relation(condition.comparison),
                self.expr(&condition.right, planner).text
            ));
        }
        let last = self.expr(otherwise, planner).text;
        out.push_str(&format!("{last} & \\text{{otherwise}} \\end{{cases}}"));
        Text::whole(out)
    }
}

/// How all names of the model are set; those that would look like another one stand letter by letter.
fn names(planner: &Planner<'_, '_>) -> HashMap<String, String> {
    let symbols = &planner.scene.model.symbols;
    let mut seen: HashMap<String, u32> = HashMap::new();
    for symbol in symbols {
        *seen.entry(set(&symbol.name)).or_default() += 1;
    }
    let mut used = HashSet::new();
    let mut names = HashMap::new();
    for symbol in symbols {
        let own = planner.symbol(symbol).to_owned();
        let nice = set(&symbol.name);
        let is_alone =
            seen.get(&nice) == Some(&1) && symbol.name.len() <= limits::DCML_SYMBOL_BYTES;
        let mut text = if is_alone { nice } else { exact(&own) };
        if !used.insert(text.clone()) {
            text = exact(&own);
            used.insert(text.clone());
        }
        names.insert(own, text);
    }
    names
}

/// The whole fragment.
fn print(scene: &Scene<'_>) -> String {
    let mut planner = Planner::new(scene, &[]);
    let dialect = Latex {
        names: names(&planner),
        symbols: &scene.model.symbols,
    };
    let element = |array: &str, at: usize| format!("{array}[{at}]");
    let header = about::header(&planner, element, &|at, _| format!("params[{at}]"));
    let mut out = about::each("%", &header);
    out.push_str("% In a document that uses the package amsmath.\n\\begin{align}\n");
    let mut lines = Vec::new();
    for symbol in scene.model.of_kind(Kind::Const) {
        let name = dialect.set(planner.symbol(symbol));
        lines.push(format!("  {name} &= {}", dialect.number(symbol.value).text));
    }
    for equation in &scene.model.equations {
        let symbol = scene.model.symbols.get(equation.target);
        let name = dialect.set(symbol.map_or("", |one| planner.symbol(one)));
        let name = if equation.is_derivative {
            dotted(&name)
        } else {
            name
        };
        let value = dialect.expr(&equation.value, &planner).text;
        lines.push(format!("  {name} &= {value}"));
    }
    out.push_str(&lines.join(" \\\\\n"));
    out.push_str("\n\\end{align}\n");
    if scene.jacobian {
        let (states, actions) = (scene.states.len(), scene.actions.len());
        for (by, columns, roots) in [
            ("x", states, &scene.state_jacobian),
            ("u", actions, &scene.action_jacobian),
        ] {
            if columns > 0 && states > 0 {
                out.push_str(&matrix(&mut planner, &dialect, by, columns, roots));
            }
        }
    }
    out
}

/// The derivative of a symbol: the dot stands above it and not above its indices.
fn dotted(name: &str) -> String {
    match name.split_once("_{") {
        Some((stem, indices)) if !name.starts_with("\\mathtt") => {
            format!("\\dot{{{stem}}}_{{{indices}")
        }
        _ => format!("\\dot{{{name}}}"),
    }
}

fn matrix(
    planner: &mut Planner<'_, '_>,
    dialect: &Latex<'_>,
    by: &str,
    columns: usize,
    roots: &[ValueId],
) -> String {
    let body: Body = planner.body(roots, dialect);
    let mut out = String::new();
    // What the equations above define already is not repeated.
    let symbols: HashSet<&str> = planner
        .scene
        .model
        .symbols
        .iter()
        .map(|one| planner.symbol(one))
        .collect();
    let fresh: Vec<String> = body
        .lines
        .iter()
        .filter(|(name, _)| !symbols.contains(name.as_str()))
        .map(|(name, text)| format!("  {} &= {text}", dialect.set(name)))
        .collect();
    if !fresh.is_empty() {
        let lines = fresh.join(" \\\\\n");
        out.push_str(&format!("\\begin{{align}}\n{lines}\n\\end{{align}}\n"));
    }
    out.push_str(&format!(
        "\\begin{{equation}}\n  \\setcounter{{MaxMatrixCols}}{{{}}}\n  \\frac{{\\partial f}}{{\\partial {by}}} = \
         \\begin{{bmatrix}}\n",
        columns.max(10)
    ));
    for row in body.results.chunks(columns) {
        out.push_str(&format!("    {} \\\\\n", row.join(" & ")));
    }
    out.push_str("  \\end{bmatrix}\n\\end{equation}\n");
    out
}
