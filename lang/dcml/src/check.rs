//! A tree to a model: every name means one thing, every value can be computed.
//!
//! Owns the rules of names, declarations and equations. `resolve` has those of expressions, `rates` those of derivatives in
//! them, `order` finds what needs what.
//! A rule is silent where what it complains of may be missing because it could not be read.

mod order;
mod rates;
mod resolve;
mod units;

use super::diagnostic::{Code, Diagnostic, Findings, Severity};
use super::function::Function;
use super::model::{Equation, Expr, Model, Symbol, SymbolId};
use super::nearest::nearest;
use super::parser::shown;
use super::syntax::{Document, Domain, EquationText, Kind, ModelText, Node, Span};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Checks all models; gives those without errors.
pub(super) fn check(document: &Document, findings: &mut Findings) -> Vec<Model> {
    let mut names: HashMap<&str, Span> = HashMap::new();
    let mut models = Vec::new();
    for text in &document.models {
        let before = findings.errors();
        let name = text.name.text.as_str();
        if let Some(first) = names.get(name).filter(|_| !name.is_empty()) {
            let message = format!("there are two models `{}`", shown(name));
            let found = Diagnostic::new(
                Code::DuplicateModel,
                text.name.span,
                message,
                "the second one",
            );
            findings.add(found.note(*first, "the first one is here"));
        } else {
            names.insert(name, text.name.span);
        }
        let model = Checker::new(text, findings).model();
        if !text.damage.any && findings.errors() == before {
            models.push(model);
        }
    }
    models
}

struct Checker<'a, 'f> {
    text: &'a ModelText,
    findings: &'f mut Findings,
    symbols: Vec<Symbol>,
    ids: HashMap<&'a str, SymbolId>,
    /// Whether an expression has the symbol.
    used: Vec<bool>,
    /// The equation of each symbol.
    equation_of: Vec<Option<usize>>,
    /// The variable that holds the derivative of a symbol, if an expression has it.
    rates: BTreeMap<SymbolId, SymbolId>,
    /// The names of these variables.
    rate_names: HashSet<String>,
    /// Names that are not declared, and where they are told.
    undeclared: HashMap<&'a str, Option<usize>>,
}

impl<'a, 'f> Checker<'a, 'f> {
    fn new(text: &'a ModelText, findings: &'f mut Findings) -> Self {
        Self {
            text,
            findings,
            symbols: Vec::new(),
            ids: HashMap::new(),
            used: Vec::new(),
            equation_of: Vec::new(),
            rates: BTreeMap::new(),
            rate_names: HashSet::new(),
            undeclared: HashMap::new(),
        }
    }

    fn model(mut self) -> Model {
        self.declarations();
        let equations = self.text.equations.iter().enumerate();
        let targets: Vec<_> = equations.map(|(at, one)| self.target(at, one)).collect();
        let mut uses: Vec<Vec<SymbolId>> = Vec::with_capacity(targets.len());
        let mut values: Vec<Option<Expr>> = Vec::with_capacity(targets.len());
        for one in &self.text.equations {
            let mut used = Vec::new();
            values.push(self.resolve(&one.value, &mut used));
            for id in &used {
                self.used[*id] = true;
            }
            used.sort_unstable();
            used.dedup();
            uses.push(used);
        }
        self.rate_equations();
        self.missing_sections();
        self.missing_equations();
        let order = self.order(&targets, &uses);
        self.units(&targets);
        self.unused();
        let equations = order.into_iter().filter_map(|at| {
            let text = &self.text.equations[at];
            let target = targets[at]?;
            // Where an expression has the derivative its equation comes twice: first as that of the variable.
            let rate = self
                .rates
                .get(&target)
                .filter(|_| text.is_derivative)
                .copied();
            let (target, is_derivative, value) = match (values[at].take(), rate) {
                (Some(value), Some(rate)) => (rate, false, value),
                (Some(value), None) => (target, text.is_derivative, value),
                (None, Some(rate)) => (target, true, Expr::Symbol(rate)),
                (None, None) => return None,
            };
            Some(Equation {
                target,
                is_derivative,
                value,
                span: text.span,
            })
        });
        Model {
            name: self.text.name.text.clone(),
            package: self.text.package.as_ref().map(|one| one.text.clone()),
            doc: self.text.doc.clone(),
            equations: equations.collect(),
            symbols: self.symbols,
        }
    }

    fn declarations(&mut self) {
        for section in &self.text.sections {
            for one in &section.names {
                let name = one.name.text.as_str();
                if let Some(first) = self.ids.get(name) {
                    let first = self.symbols[*first].span;
                    let message = format!("`{}` is declared twice", shown(name));
                    let found = Diagnostic::new(
                        Code::DuplicateName,
                        one.name.span,
                        message,
                        "the second time",
                    );
                    let found = found.note(first, "the first time");
                    self.findings
                        .add(found.hint("give one of them another name"));
                    continue;
                }
                self.shadowing(name, one.name.span);
                self.value(section.kind, one);
                self.domain(section.kind, one);
                self.ids.insert(name, self.symbols.len());
                self.symbols.push(Symbol {
                    name: name.to_owned(),
                    span: one.name.span,
                    kind: section.kind,
                    doc: one.doc.clone(),
                    unit: one.unit.as_ref().map(|unit| unit.text.clone()),
                    domain: one.domain.map(|(domain, _)| domain),
                    value: one.value.map_or(0.0, |(value, _)| value),
                });
            }
        }
        self.used = vec![false; self.symbols.len()];
        self.equation_of = vec![None; self.symbols.len()];
    }

    fn shadowing(&mut self, name: &str, span: Span) {
        let what = match name {
            "pi" | "e" => format!("this `{name}` hides the number `{name}`"),
            _ if Function::named(name).is_some() || name == "piecewise" => {
                format!("`{name}` is the name of a function too")
            }
            _ => return,
        };
        let found = Diagnostic::new(Code::Shadowing, span, what, "declared here");
        self.findings
            .add(found.hint("another name is easier to understand"));
    }

    fn value(&mut self, kind: Kind, one: &super::syntax::Declaration) {
        let name = shown(&one.name.text);
        let found = match (kind, one.value) {
            (Kind::Const, None) if !self.text.damage.any => {
                let message = format!("the constant `{name}` has no value");
                Diagnostic::new(
                    Code::MissingValue,
                    one.name.span,
                    message,
                    "`= NUMBER` expected after it",
                )
                .hint("what is known only later is a `PARAM`")
            }
            (Kind::Const, _) | (_, None) => return,
            (_, Some((_, span))) => {
                let message = format!("`{name}` is no constant and has no value here");
                let hint = match kind {
                    Kind::Var | Kind::Config => {
                        "write an equation for it, or declare it in `CONST`"
                    }
                    _ => "declare it in `CONST`, or give its value when the model is used",
                };
                Diagnostic::new(Code::UnexpectedValue, span, message, "a value").hint(hint)
            }
        };
        self.findings.add(found);
    }

    fn domain(&mut self, kind: Kind, one: &super::syntax::Declaration) {
        let Some((domain, span)) = one.domain else {
            return;
        };
        let name = shown(&one.name.text);
        let found = match (domain, kind, one.value) {
            (Domain::Circle, Kind::Config, _) => return,
            (Domain::Circle, ..) => {
                let message = format!("`{name}` is no `CONFIG` and cannot be an angle that wraps");
                Diagnostic::new(Code::MisplacedDomain, span, message, "only for `CONFIG`")
                    .hint("remove `in S1`")
            }
            (Domain::Range(..), Kind::Var, _) => {
                let message =
                    format!("the variable `{name}` has no range: its equation says what it is");
                Diagnostic::new(Code::MisplacedDomain, span, message, "not for `VAR`")
                    .hint("limit it with `min` and `max`")
            }
            (Domain::Range(from, to), _, _) if from > to => {
                let message =
                    format!("nothing is in the range of `{name}`: {from} is larger than {to}");
                Diagnostic::new(Code::BadRange, span, message, "empty")
                    .hint(format!("write `in {to} .. {from}`"))
            }
            (Domain::Range(from, to), Kind::Const, Some((value, _)))
                if !(from..=to).contains(&value) =>
            {
                let message =
                    format!("the constant `{name}` is {value}, which is not in its range");
                Diagnostic::new(Code::BadRange, span, message, "its range")
            }
            _ => return,
        };
        self.findings.add(found);
    }

    /// Whose equation it is, if it may have one and has no other.
    fn target(&mut self, at: usize, one: &'a EquationText) -> Option<SymbolId> {
        let name = one.target.text.as_str();
        let Some(&id) = self.ids.get(name) else {
            self.undeclared(
                name,
                one.target.span,
                "an equation for what is not declared",
            );
            return None;
        };
        let symbol = &self.symbols[id];
        let (kind, declared) = (symbol.kind, symbol.span);
        let name = shown(name);
        let found = match kind {
            Kind::Action | Kind::Param | Kind::Const => {
                let what = match kind {
                    Kind::Action => "an action, which comes from outside",
                    Kind::Param => "a parameter, which is fixed for one robot",
                    _ => "a constant, which has its number",
                };
                let message = format!("`{name}` is {what}, and has no equation");
                let found = Diagnostic::new(
                    Code::NotAssignable,
                    one.target.span,
                    message,
                    "may have no equation",
                );
                let hint = format!(
                    "move `{name}` to `CONFIG` or `VAR`, or give the equation to another name"
                );
                Some(found.note(declared, "declared here").hint(hint))
            }
            Kind::Var if one.is_derivative => {
                let message =
                    format!("`{name}` is a variable, and only a `CONFIG` has a derivative");
                let found =
                    Diagnostic::new(Code::NotDerivable, one.target.span, message, "no `CONFIG`");
                let hint = format!("move `{name}` to `CONFIG`, or write `{name} = ...`");
                Some(found.note(declared, "declared here").hint(hint))
            }
            Kind::Var | Kind::Config => None,
        };
        if let Some(found) = found {
            self.findings.add(found);
            // Nobody shall hear also that it has no equation.
            self.equation_of[id].get_or_insert(usize::MAX);
            return None;
        }
        match self.equation_of[id] {
            Some(first) => {
                self.duplicate_equation(one, first, &name);
                None
            }
            None => {
                self.equation_of[id] = Some(at);
                Some(id)
            }
        }
    }

    fn duplicate_equation(&mut self, one: &EquationText, first: usize, name: &str) {
        let Some(first) = self.text.equations.get(first) else {
            return;
        };
        let message = if first.is_derivative == one.is_derivative {
            format!("`{name}` has two equations")
        } else {
            format!("`{name}` has an equation for its value and one for its derivative")
        };
        let found = Diagnostic::new(
            Code::DuplicateEquation,
            one.target.span,
            message,
            "the second one",
        );
        let found = found.note(first.target.span, "the first one is here");
        self.findings.add(found.hint("remove one of them"));
    }

    fn undeclared(&mut self, name: &'a str, span: Span, label: &str) {
        if self.text.damage.names {
            return;
        }
        if let Some(&told) = self.undeclared.get(name) {
            self.findings.also(told, span, "and here");
            return;
        }
        let message = format!("`{}` is not declared", shown(name));
        let found = Diagnostic::new(Code::UndeclaredName, span, message, label);
        let meant = if self.findings.is_full() {
            None
        } else {
            nearest(name, self.symbols.iter().map(|one| one.name.as_str()))
        };
        let hint = if let Some(meant) = meant {
            format!("did you mean `{meant}`?")
        } else if let Some(function) = Function::named(name) {
            let more = if function.arguments() == 2 {
                ", ..."
            } else {
                ""
            };
            format!("`{name}` is a function: write `{name}(...{more})`")
        } else if matches!(name, "pi" | "e") {
            format!(
                "`{name}` is a number that every model has; a name of your own is declared in `VAR`"
            )
        } else {
            "declare it in ACTION, PARAM, CONST, CONFIG or VAR".to_owned()
        };
        // It was meant, and so it is used.
        if let Some(id) = meant.and_then(|meant| self.ids.get(meant)) {
            self.used[*id] = true;
        }
        let told = self.findings.add(found.hint(hint));
        self.undeclared.insert(name, told);
    }

    fn missing_sections(&mut self) {
        let text = self.text;
        let has = |kind: Kind| text.sections.iter().any(|one| one.kind == kind);
        let name = shown(&text.name.text);
        let mut missing = Vec::new();
        for (kind, what) in [(Kind::Action, "inputs"), (Kind::Config, "state")] {
            let keyword = kind.keyword();
            if !has(kind) && !text.damage.names {
                missing.push((
                    format!("the model `{name}` has no section `{keyword}`"),
                    format!("declare its {what}: `{keyword}: ...;`"),
                ));
            }
        }
        if text.equations.is_empty() && !text.damage.equations {
            missing.push((
                format!("the model `{name}` has no equation"),
                "write `d(x) = ...;` for each name of `CONFIG`".to_owned(),
            ));
        }
        for (message, hint) in missing {
            let found =
                Diagnostic::new(Code::MissingSection, text.name.span, message, "this model");
            self.findings.add(found.hint(hint));
        }
    }

    fn missing_equations(&mut self) {
        // Without any equation that is what is told.
        if self.text.damage.equations || self.text.equations.is_empty() {
            return;
        }
        for (symbol, equation) in self.symbols.iter().zip(&self.equation_of) {
            let is_computed = matches!(symbol.kind, Kind::Config | Kind::Var);
            if !is_computed || equation.is_some() || !self.findings.wants(Severity::Error) {
                continue;
            }
            let name = shown(&symbol.name);
            let (what, hint) = match symbol.kind {
                Kind::Config => ("", format!("write `d({name}) = ...;` or `{name} = ...;`")),
                _ => ("the variable ", format!("write `{name} = ...;`")),
            };
            let message = format!("{what}`{name}` has no equation");
            let found = Diagnostic::new(
                Code::MissingEquation,
                symbol.span,
                message,
                "nothing gives its value",
            );
            self.findings.add(found.hint(hint));
        }
    }

    fn unused(&mut self) {
        let damage = self.text.damage;
        let is_broken = |one: &EquationText| one.value.node == Node::Broken;
        if damage.names || damage.equations || self.text.equations.iter().any(is_broken) {
            return;
        }
        for (symbol, is_used) in self.symbols.iter().zip(&self.used) {
            let what = match symbol.kind {
                _ if *is_used => continue,
                Kind::Config => continue,
                Kind::Action => "the action",
                Kind::Param => "the parameter",
                Kind::Const => "the constant",
                Kind::Var => "the variable",
            };
            if !self.findings.wants(Severity::Warning) {
                continue;
            }
            let message = format!("{what} `{}` is not used", shown(&symbol.name));
            let found = Diagnostic::new(Code::Unused, symbol.span, message, "no equation has it");
            self.findings.add(found.hint("remove it, or use it"));
        }
    }
}
