//! Properties of a block: texts, numbers, flags, ports and expressions, as operations need them.
//!
//! Owns defaults and the reading of plain values. Knows no links.

use super::{
    Act, Action, Assignment, At, Copying, Direction, Lowering, Port, Sign, Source, Text, Wait,
    WatchedFor, Watching, words,
};
use crate::blocks::wait::Until;
use crate::blocks::{Content, Copied, EVALUATE, REDRAW, Type};

/// The text of a property, or its default.
pub(super) fn text<'a>(at: At<'a>, name: &str) -> &'a str {
    match at.block.properties.get(name) {
        Some(text) => text,
        None => at
            .row
            .property(name)
            .map_or("", |property| property.default),
    }
}

/// A flag: everything but nothing, `0` and `false` is true.
pub(super) fn flag(at: At<'_>, name: &str) -> bool {
    let text = text(at, name);
    !(text.is_empty() || text == "0" || text.eq_ignore_ascii_case("false"))
}

/// A plain number; what is none is 0.
pub(super) fn number(at: At<'_>, name: &str) -> i32 {
    text(at, name).trim().parse().unwrap_or(0)
}

impl<'a> Lowering<'a> {
    /// Warns of words that a property may not have.
    pub(super) fn look_at_properties(&mut self, at: At<'a>) {
        for property in at.row.properties {
            if let Content::Choice(choices) = property.content {
                let value = text(at, property.name);
                if !choices.contains(&value) {
                    self.warn(words::unknown_choice(value), Some(property.shown));
                }
            }
        }
    }

    fn source(
        &mut self,
        text: impl Into<Box<str>>,
        wanted: Type,
        property: &'static str,
    ) -> Source {
        self.sources.push(Text {
            text: text.into(),
            wanted,
            property,
        });
        self.sources.len() as Source - 1
    }

    /// The expression in a property.
    pub(super) fn expression(&mut self, at: At<'a>, name: &str) -> Source {
        let property = at.row.property(name);
        let wanted = match property.map(|property| property.content) {
            Some(Content::Expression(wanted)) => wanted,
            Some(
                Content::Evaluated
                | Content::Raw
                | Content::Variable
                | Content::Ports
                | Content::Number
                | Content::Flag
                | Content::Choice(_)
                | Content::Port(_),
            )
            | None => Type::Text,
        };
        let shown = property.map_or("", |property| property.shown);
        self.source(text(at, name), wanted, shown)
    }

    /// The statement that a block makes of its variable and a value.
    pub(super) fn spliced(&mut self, at: At<'a>, value: &str) -> Source {
        let statement = format!("{} = {value}", variable(at));
        self.source(statement, Type::Statements, "")
    }

    /// The variable of a block and what belongs to it.
    pub(super) fn assignment(&mut self, at: At<'a>) -> u32 {
        let bounds = at.row.property("LowerBound").is_some();
        let bounds = bounds.then(|| {
            let low = self.expression(at, "LowerBound");
            (low, self.expression(at, "UpperBound"))
        });
        let wait = match at.row.property("Wait") {
            Some(_) => flag(at, "Wait"),
            None => flag(at, "Synchronized"),
        };
        self.assignments.push(Assignment {
            variable: variable(at).into(),
            wait,
            bounds,
            default: text(at, "default").into(),
            prompt: text(at, "prompt").into(),
        });
        self.assignments.len() as u32 - 1
    }

    /// What is copied into the variable of a block.
    pub(super) fn copied(&mut self, at: At<'a>, copied: &'static Copied) -> u32 {
        let source = self.spliced(at, copied.value);
        self.copies.push(Copying { copied, source });
        self.copies.len() as u32 - 1
    }

    /// A command with everything that the row says it has.
    pub(super) fn action(&mut self, at: At<'a>, act: &'static Act) -> u32 {
        let mut action = Action {
            act,
            redraws: at.row.property(REDRAW.name).is_some() && flag(at, REDRAW.name),
            sources: Box::default(),
            texts: Box::default(),
            numbers: Box::default(),
            flags: Box::default(),
            ports: Box::default(),
        };
        let (mut sources, mut texts) = (Vec::new(), Vec::new());
        let (mut numbers, mut flags) = (Vec::new(), Vec::new());
        for property in at.row.properties {
            let value = text(at, property.name);
            match property.content {
                Content::Expression(_) if act.is_optional && value.trim().is_empty() => {}
                Content::Expression(wanted) => {
                    if wanted == Type::List {
                        action.ports = motors(value);
                    }
                    sources.push(self.source(value, wanted, property.shown));
                }
                Content::Evaluated if flag(at, EVALUATE.name) => {
                    sources.push(self.source(value, Type::Printed, property.shown));
                }
                Content::Evaluated | Content::Raw | Content::Choice(_) => texts.push(value.into()),
                Content::Number => numbers.push(number(at, property.name)),
                Content::Flag if ![EVALUATE.name, REDRAW.name].contains(&property.name) => {
                    flags.push(flag(at, property.name))
                }
                Content::Flag | Content::Variable | Content::Port(_) => {}
                Content::Ports => action.ports = self.ports(value, property.shown),
            }
        }
        action.sources = sources.into();
        action.texts = texts.into();
        action.numbers = numbers.into();
        action.flags = flags.into();
        self.actions.push(action);
        self.actions.len() as u32 - 1
    }

    fn ports(&mut self, list: &str, shown: &'static str) -> Box<[Port]> {
        let mut ports = Vec::new();
        for name in list.split(',').filter(|name| !name.is_empty()) {
            match Port::find(self.kit, name, Direction::In) {
                // The original repeats as well, but nobody sees a difference.
                Some(port) if ports.contains(&port) => {}
                Some(port) => ports.push(port),
                None => self.warn(words::unknown_port(name.trim()), Some(shown)),
            }
        }
        ports.into()
    }

    /// What is waited for.
    pub(super) fn watch(&mut self, at: At<'a>, wait: &'static Wait) -> u32 {
        let until = match wait.until {
            Until::Compared(property) => {
                WatchedFor::Compared(sign(text(at, "Sign")), self.expression(at, property))
            }
            Until::Positive => WatchedFor::Positive,
            Until::Zero => WatchedFor::Zero,
        };
        let port = wait.port.name(
            |property| text(at, property),
            |property| number(at, property),
        );
        let found = Port::find(self.kit, unquoted(port), Direction::In);
        if found.is_none() {
            self.warn(words::unknown_port(port), None);
        }
        self.watches.push(Watching {
            wait,
            port: found.ok_or_else(|| port.into()),
            measure: wait.reading.measure(|property| text(at, property)),
            until,
        });
        self.watches.len() as u32 - 1
    }
}

/// The name of the variable that a block assigns to.
fn variable<'a>(at: At<'a>) -> &'a str {
    let mut properties = at.row.properties.iter();
    let property = properties.find(|property| property.content == Content::Variable);
    property.map_or("", |property| text(at, property.name))
}

fn sign(word: &str) -> Sign {
    match word {
        "greater" => Sign::Greater,
        "less" => Sign::Less,
        "notLess" => Sign::NotLess,
        "notGreater" => Sign::NotGreater,
        "equals" => Sign::Equals,
        _ => Sign::Unknown,
    }
}

/// Ports of a list that holds nothing but names of motors: what the expression would give, because these names are
/// constants.
fn motors(list: &str) -> Box<[Port]> {
    let motor = |name: &str| match name.trim() {
        name @ ("M1" | "M2" | "M3" | "M4") => Port::named(name),
        _ => None,
    };
    list.split(',')
        .map(motor)
        .collect::<Option<_>>()
        .unwrap_or_default()
}

/// The original evaluates the name of a port, so quotes around it are harmless.
fn unquoted(text: &str) -> &str {
    let text = text.trim();
    let inner = text
        .strip_prefix(['"', '\''])
        .and_then(|text| text.strip_suffix(['"', '\'']));
    inner.unwrap_or(text)
}
