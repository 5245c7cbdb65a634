//! Properties of a block: texts, numbers, flags, ports and expressions, as operations need them.
//!
//! Owns defaults and the reading of plain values. Knows no links.

use super::{
    Act, Action, Assignment, At, Axis, Copied, Lowering, Port, Sign, Source, Text, Watching, Way,
    words,
};
use crate::blocks::{Content, EVALUATE, REDRAW, Type, Watch};

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
            _ => Type::Text,
        };
        let shown = property.map_or("", |property| property.shown);
        self.source(text(at, name), wanted, shown)
    }

    /// The statement that a block makes of a variable and a value.
    pub(super) fn spliced(&mut self, at: At<'a>) -> Source {
        let statement = format!("{} = {}", text(at, "variable"), text(at, "value"));
        self.source(statement, Type::Statements, "")
    }

    /// The variable of a block and what belongs to it.
    pub(super) fn assignment(&mut self, at: At<'a>) -> u32 {
        let variable = if at.row.property("Variable").is_some() {
            "Variable"
        } else {
            "variable"
        };
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
            variable: text(at, variable).into(),
            wait,
            bounds,
            default: text(at, "default").into(),
            prompt: text(at, "prompt").into(),
        });
        self.assignments.len() as u32 - 1
    }

    /// The statement that copies a sensor's variable, in the place of the bounds.
    pub(super) fn copied(&mut self, at: At<'a>, copied: Copied) -> u32 {
        let index = self.assignment(at);
        let sensor = match copied {
            Copied::Line => "lineSensor[0]",
            Copied::Lidar => "lidar",
        };
        let variable = self.assignments[index as usize].variable.clone();
        let source = self.source(format!("{variable} = {sensor}"), Type::Statements, "");
        self.assignments[index as usize].bounds = Some((source, source));
        index
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
            match Port::find(self.kit, name, Way::In) {
                // The original repeats as well, but nobody sees a difference.
                Some(port) if ports.contains(&port) => {}
                Some(port) => ports.push(port),
                None => self.warn(words::unknown_port(name.trim()), Some(shown)),
            }
        }
        ports.into()
    }

    /// What is waited for.
    pub(super) fn watch(&mut self, at: At<'a>, watch: Watch) -> u32 {
        let value = match watch {
            Watch::Sensor(name)
            | Watch::Encoder(name)
            | Watch::Gyroscope(name)
            | Watch::Acceleration(name)
            | Watch::Wheel(name) => Some(self.expression(at, name)),
            Watch::Touch
            | Watch::Motion
            | Watch::Button
            | Watch::PadButton
            | Watch::Pad
            | Watch::Connected
            | Watch::Disconnected => None,
        };
        let port = match watch {
            Watch::Button => text(at, "Button"),
            Watch::Gyroscope(_) => "GyroscopePort",
            Watch::Acceleration(_) => "AccelerometerPort",
            Watch::Motion => "F1",
            Watch::Wheel(_) => "GamepadWheelPort",
            Watch::Connected | Watch::Disconnected => "GamepadConnectionIndicatorPort",
            Watch::PadButton => match number(at, "Button") {
                1 => "GamepadButton1Port",
                2 => "GamepadButton2Port",
                3 => "GamepadButton3Port",
                4 => "GamepadButton4Port",
                5 => "GamepadButton5Port",
                _ => "GamepadButtonPort",
            },
            Watch::Pad => match number(at, "Pad") {
                1 => "GamepadPad1PressedPort",
                2 => "GamepadPad2PressedPort",
                _ => "GamepadPadPressedPort",
            },
            Watch::Sensor(_) | Watch::Encoder(_) | Watch::Touch => text(at, "Port"),
        };
        let found = Port::find(self.kit, unquoted(port), Way::In);
        if found.is_none() {
            self.warn(words::unknown_port(port), None);
        }
        let sign = match text(at, "Sign") {
            "greater" => Sign::Greater,
            "less" => Sign::Less,
            "notLess" => Sign::NotLess,
            "notGreater" => Sign::NotGreater,
            "equals" => Sign::Equals,
            _ => Sign::Unknown,
        };
        let axis = match text(at, "AccelerationAxis") {
            "yAxis" => Axis::Y,
            "zAxis" => Axis::Z,
            "normal" => Axis::Length,
            _ => Axis::X,
        };
        self.watches.push(Watching {
            watch,
            port: found.ok_or_else(|| port.into()),
            source: value,
            sign,
            axis,
        });
        self.watches.len() as u32 - 1
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
