//! What a block does with its properties: texts, numbers, colours, ports and expressions.
//!
//! Owns the reading of property texts. Knows neither edges nor instances.

use super::{At, Lowering, instance_is_first, shared};
use crate::blocks::{Content, Does, EVALUATE, PORT_OF_CALL, SYNCHRONIZED, Shape};
use crate::machine::values;
use crate::program::{Act, Camera, Flow, Formula, Op, Read, Source, Text, Words as Said};
use crate::project::Block;
use crate::sensors;
use crate::words;
use lang_diagram::ports::{Direction, Port, Sort};
use lang_expr::{Value, Wanted};
use lang_text::problem::{Place, Words};
use std::rc::Rc;

/// Names of a function's inputs in its texts.
pub(crate) const INPUTS: &[&str] = &["I0", "I1", "I2", "I3", "I4", "I5"];
/// The name of the token in conditions.
pub(crate) const DATA: &[&str] = &["data"];

/// The port of a call that an input or output port shows, as the table writes it.
pub(super) fn port_of_call(block: &Block) -> Option<&'static str> {
    let property = block.row?.property(PORT_OF_CALL)?;
    if let Content::Choice(choices) = property.content {
        chosen(choices, block.text(PORT_OF_CALL))
    } else {
        None
    }
}

/// Properties of a loop: first, last and step.
const LOOP: [&str; 3] = ["start_border", "end_border", "increment"];

impl<'a> Lowering<'a> {
    /// What a block does. What is wrong is told, and something harmless stands for it.
    pub(super) fn op(&mut self, at: At<'a>) -> Op {
        self.check_flags(at);
        match at.row.does {
            Does::Stop => Flow::Stop.into(),
            Does::Function => self.function(at).into(),
            Does::If => Flow::If(self.formula_of(at, "condition", Wanted::Bool, DATA)).into(),
            Does::Switch => self.switch(at).into(),
            Does::Loop => self.count(at).into(),
            Does::Call => Flow::Call(0).into(),
            Does::InPort => self.port_of_call(at, Flow::InPort),
            Does::OutPort => self.port_of_call(at, Flow::OutPort(None)),
            Does::Value => self.constant(at).into(),
            Does::Variable => self.variable(at).into(),
            Does::Random => self.random(at).into(),
            Does::Filter => self.filter(at).into(),
            Does::Wait => self.wait(at).into(),
            Does::Replace => Flow::Replace(self.number(at, "time")).into(),
            Does::Inhibit => Flow::Inhibit(self.number(at, "time")).into(),
            Does::Zip => Flow::Zip.into(),
            Does::Unzip => Flow::Unzip.into(),
            Does::WritePort => self.written_port(at),
            Does::ReadPort => self.read_port(at),
            Does::Sensor => self.sensor(at),
            Does::Motors => self.drive(at, ["M1", "M2", "M3", "M4"], "Power").into(),
            Does::Servos => self.drive(at, ["S1", "S2", "S3", "S4"], "Angle").into(),
            Does::Encoders => encoders(at).into(),
            Does::Led => Act::Led(self.choice(at, "ledColor")).into(),
            Does::Gamepad => Source::Gamepad.into(),
            Does::Say => Act::Say(self.said(at, "text")).into(),
            Does::Sound => Act::Sound(text(at, "file")).into(),
            Does::System => Act::System {
                command: self.said(at, "Command"),
                code: at.block.flag("IsCode"),
            }
            .into(),
            Does::Stream => Act::Stream.into(),
            Does::StartCamera => Act::StartCamera(self.camera(at)).into(),
            Does::Detect => Source::Detect(self.camera(at)).into(),
            Does::Send => Act::Send {
                number: self.number(at, "robotNum"),
                message: text(at, "message"),
            }
            .into(),
            Does::Receive => Source::Receive.into(),
            Does::WriteFile => Act::WriteFile {
                file: text(at, "fileName"),
                text: text(at, "text"),
            }
            .into(),
            Does::ReadFile => Act::ReadFile {
                file: text(at, "fileName"),
                words: at.block.flag("isbyWords"),
            }
            .into(),
            Does::RemoveFile => Act::RemoveFile(text(at, "fileName")).into(),
            Does::Pen => Act::Pen {
                color: color(self.choice(at, "color")),
                down: at.block.flag("state"),
            }
            .into(),
            Does::Paint => self.paint(at).into(),
            Does::Print => self.print(at).into(),
            Does::Clear => Act::Clear.into(),
            Does::Smile => Act::Smile(at.block.flag("isHappy")).into(),
            Does::Draw(shape) => self.figure(at, shape).into(),
        }
    }

    fn function(&mut self, at: At<'a>) -> Flow {
        let texts = ["IO0", "IO1", "IO2", "IO3", "IO4", "IO5"];
        Flow::Function {
            waits: at.block.flag(SYNCHRONIZED),
            texts: texts.map(|name| self.optional(at, name, Wanted::Any, INPUTS)),
        }
    }

    /// A constant that is a token each time: as large as one may be.
    fn constant(&mut self, at: At<'a>) -> Flow {
        let value = constant(at.block.text("varValue"));
        if !values::fits(&value) {
            self.bad(at, "varValue", words::too_large_token());
        }
        Flow::Constant(value)
    }

    fn count(&mut self, at: At<'a>) -> Flow {
        let bounds = LOOP.map(|name| self.number(at, name));
        let step = at.block.text(LOOP[2]).trim().parse::<f64>();
        let is_still = step.is_ok_and(|step| step.round() == 0.0);
        if is_still && at.diagram.enters_port(at.block, "STEP").is_none() {
            self.bad(at, LOOP[2], words::loop_step());
        }
        Flow::Loop {
            bounds,
            time_ms: self.period(at),
        }
    }

    fn switch(&mut self, at: At<'a>) -> Flow {
        let conditions = ["cond0", "cond1", "cond2", "cond3", "cond4", "cond5"];
        let values = ["O0", "O1", "O2", "O3", "O4", "O5"];
        let arms = std::array::from_fn(|arm| {
            let condition = self.optional(at, conditions[arm], Wanted::Bool, DATA);
            (condition, self.optional(at, values[arm], Wanted::Any, DATA))
        });
        Flow::Switch {
            arms,
            first_only: at.block.flag("sendOnlyFirst"),
        }
    }

    fn variable(&mut self, at: At<'a>) -> Flow {
        let text = at.block.text("variable");
        let is_assignment = text.contains('=');
        let names: Vec<Rc<str>> = match is_assignment {
            true => assigned(text),
            false => {
                let names = text.split([';', '\n']).map(str::trim);
                names.filter(|name| !name.is_empty()).map(shared).collect()
            }
        };
        // What the language of expressions has already is no variable.
        let known = sensors::names_of(self.program.kit);
        let is_variable = |name: &str| is_name(name) && known.find(name).is_none();
        match names.iter().find(|name| !is_variable(name)) {
            Some(bad) => self.bad(at, "variable", words::no_variable(bad)),
            // A text that cannot be read is told where it is.
            None if names.is_empty() && !is_assignment => {
                self.bad(at, "variable", words::no_variable(""));
            }
            None => {}
        }
        let run = is_assignment.then(|| self.formula_of(at, "variable", Wanted::Statements, &[]));
        Flow::Variable {
            run,
            names: names.into(),
        }
    }

    fn port_of_call(&mut self, at: At<'a>, flow: Flow) -> Op {
        self.choice(at, PORT_OF_CALL);
        flow.into()
    }

    fn filter(&mut self, at: At<'a>) -> Flow {
        Flow::Filter {
            quiet_ms: self.pause(at, "preSendTime"),
            condition: self.formula_of(at, "condition", Wanted::Bool, DATA),
            count: self.number(at, "count"),
            pause_ms: self.pause(at, "dispatchTime"),
        }
    }

    fn wait(&mut self, at: At<'a>) -> Flow {
        Flow::Wait {
            ms: self.number(at, "time"),
            keeps: at.block.flag("keep"),
        }
    }

    fn random(&mut self, at: At<'a>) -> Flow {
        let repeats = at.block.flag("repeatedly");
        let bounds = ["fromNumber", "toNumber"];
        Flow::Random {
            bounds: bounds.map(|name| self.formula_of(at, name, Wanted::Int, &[])),
            every_ms: repeats.then(|| self.period(at)),
        }
    }

    fn drive(&mut self, at: At<'a>, names: [&str; 4], property: &str) -> Act {
        Act::Drive {
            waits: at.block.flag(SYNCHRONIZED),
            devices: names.map(|name| {
                let value = self.number(at, &format!("{name}{property}"));
                (known_port(name), value)
            }),
        }
    }

    fn paint(&mut self, at: At<'a>) -> Act {
        let width = self.number(at, "width");
        if width <= 0 {
            self.bad(at, "width", words::bad_width());
        }
        Act::Paint {
            color: color(self.choice(at, "color")),
            width,
            background: color(self.choice(at, "backgroundColor")),
            redraw: at.block.flag("Redraw"),
        }
    }

    fn print(&mut self, at: At<'a>) -> Act {
        Act::Print {
            text: self.said(at, "text"),
            at: ["xcord", "ycord"].map(|name| self.formula_of(at, name, Wanted::Int, &[])),
            redraw: at.block.flag("Redraw"),
            computed: at.block.flag(EVALUATE),
        }
    }

    fn figure(&mut self, at: At<'a>, shape: Shape) -> Act {
        let coordinates = at
            .row
            .properties
            .iter()
            .filter(|one| one.content == Content::Whole);
        let numbers = coordinates
            .map(|one| self.formula_of(at, one.name, Wanted::Int, &[]))
            .collect();
        Act::Draw {
            shape,
            numbers,
            filled: at.block.flag("Filled"),
            redraw: at.block.flag("redraw"),
        }
    }

    /// A text as it stands, or an expression if the block says so.
    fn said(&mut self, at: At<'a>, name: &'static str) -> Said {
        if at.block.flag(EVALUATE) {
            Said::Computed(self.formula_of(at, name, Wanted::Text, &[]))
        } else {
            Said::Plain(shared(at.block.text(name)))
        }
    }

    fn optional(
        &mut self,
        at: At<'a>,
        name: &'static str,
        wanted: Wanted,
        own: &'static [&'static str],
    ) -> Option<Formula> {
        let is_empty = at.block.text(name).trim().is_empty();
        (!is_empty).then(|| self.formula_of(at, name, wanted, own))
    }

    fn formula_of(
        &mut self,
        at: At<'a>,
        name: &str,
        wanted: Wanted,
        own: &'static [&'static str],
    ) -> Formula {
        let property = at.row.property(name).map_or("", |property| property.shown);
        self.formula(Text {
            text: shared(at.block.text(name)),
            wanted,
            property,
            node: at.node,
            own,
        })
    }

    /// A whole number; a float is rounded, halves away from zero.
    fn number(&mut self, at: At<'a>, name: &str) -> i32 {
        let text = at.block.text(name).trim();
        // Words for what is no number are none here.
        let is_written = text.contains(|c: char| c.is_ascii_digit());
        let number: Option<f64> = text.parse().ok().filter(|_| is_written);
        let words = match number.map(f64::round) {
            Some(whole) if whole.abs() <= f64::from(i32::MAX) => return whole as i32,
            Some(_) => words::number_too_large(text),
            None => words::no_number(text),
        };
        self.bad(at, name, words);
        0
    }

    /// The time of a block that works again and again: it must be above 0.
    fn period(&mut self, at: At<'a>) -> u32 {
        let time = self.number(at, "time");
        if time <= 0 {
            self.bad(at, "time", words::bad_period(time));
        }
        time.max(1) as u32
    }

    /// A time that may be 0; one below 0 counts as 0, which is told once for all calls.
    fn pause(&mut self, at: At<'a>, name: &str) -> u32 {
        let time = self.number(at, name);
        let instance = self.chains.len().saturating_sub(1) as u32;
        if time < 0 && instance_is_first(instance, &self.chains, &self.program) {
            self.warn(property_place(at, name), words::negative_time(time));
        }
        time.max(0) as u32
    }

    /// Flags that say neither `true` nor `false`: most words would count as true.
    fn check_flags(&mut self, at: At<'a>) {
        let flags = at.row.properties.iter();
        for flag in flags.filter(|property| property.content == Content::Flag) {
            let text = at.block.text(flag.name);
            let is_plain = ["true", "false", "1", "0", ""]
                .iter()
                .any(|word| text.eq_ignore_ascii_case(word));
            if !is_plain {
                self.bad(at, flag.name, words::no_choice(text, &["true", "false"]));
            }
        }
    }

    /// One of the words that a property may have, as the table writes it.
    fn choice(&mut self, at: At<'a>, name: &str) -> &'static str {
        let property = at.row.property(name);
        let choices = match property.map(|property| property.content) {
            Some(Content::Choice(choices)) => choices,
            Some(
                Content::Expression
                | Content::Truth
                | Content::Whole
                | Content::Variables
                | Content::Evaluated
                | Content::Raw
                | Content::Constant
                | Content::Number
                | Content::Flag
                | Content::Sensor
                | Content::Port,
            )
            | None => &[],
        };
        let text = at.block.text(name);
        match chosen(choices, text) {
            Some(word) => word,
            None => {
                self.bad(at, name, words::no_choice(text, choices));
                choices.first().copied().unwrap_or_default()
            }
        }
    }

    fn camera(&mut self, at: At<'a>) -> Camera {
        Camera::of(self.choice(at, "type")).unwrap_or(Camera::Line)
    }

    fn sensor(&mut self, at: At<'a>) -> Op {
        let name = at.block.text("VarName").trim();
        match sensors::find(name) {
            Some(sensor) => Source::Sensor(sensor).into(),
            None => {
                self.bad(at, "VarName", words::no_sensor(name, sensors::names()));
                Source::Sensor(0).into()
            }
        }
    }

    fn written_port(&mut self, at: At<'a>) -> Op {
        let name = at.block.text("portName").trim();
        let value = self.number(at, "portImpulse");
        // Names of ports are those of the newer kit, whichever a project has.
        let kit = lang_expr::Kit::V62;
        let out = Port::find(kit, name, Direction::Out);
        let encoder =
            Port::find(kit, name, Direction::In).filter(|port| port.sort() == Sort::Encoder);
        let port = match (out.or(encoder), is_readable(name)) {
            (Some(port), _) => return Act::WritePort { port, value }.into(),
            (None, true) => words::write_input(name),
            (None, false) => words::no_device_port(name),
        };
        self.bad(at, "portName", port);
        Flow::Stop.into()
    }

    fn read_port(&mut self, at: At<'a>) -> Op {
        let name = at.block.text("portName").trim();
        if let Some(motor) = Port::named(name).filter(|port| port.sort() == Sort::Motor) {
            return Act::ReadPort(Read::Told(motor)).into();
        }
        if let Some(part) = colour_part(name) {
            return Act::ReadPort(part).into();
        }
        match Port::find(lang_expr::Kit::V62, name, Direction::In) {
            Some(port) => Act::ReadPort(Read::Device(port)).into(),
            None => {
                self.bad(at, "portName", words::no_device_port(name));
                Flow::Stop.into()
            }
        }
    }

    /// Something is wrong with a property.
    fn bad(&mut self, at: At<'a>, name: &str, words: Words) {
        self.error(property_place(at, name), words);
    }
}

/// Where a property is, by its name in the save.
fn property_place(at: At<'_>, name: &str) -> Place {
    let property = at.row.property(name);
    let shown = property.map_or(name, |property| property.shown);
    Place {
        property: Some(shown.to_owned()),
        ..at.place()
    }
}

/// Variables that statements give values, in order.
fn assigned(text: &str) -> Vec<Rc<str>> {
    let source = lang_expr::Source::new(text, Wanted::Statements);
    let tree = source.tree();
    let mut names: Vec<Rc<str>> = Vec::new();
    for statement in tree.statements() {
        let lang_expr::tree::Node::Assign { target, .. } = tree.node(statement) else {
            continue;
        };
        let mut at = *target;
        while let lang_expr::tree::Node::Index { table, .. } = tree.node(at) {
            at = *table;
        }
        if let lang_expr::tree::Node::Name(name) = tree.node(at)
            && !names.contains(name)
        {
            names.push(name.clone());
        }
    }
    names
}

fn text(at: At<'_>, name: &str) -> Rc<str> {
    shared(at.block.text(name))
}

fn encoders(at: At<'_>) -> Source {
    let names = ["E1", "E2", "E3", "E4"];
    Source::Encoders(names.map(|name| {
        let flag = at.block.flag(&format!("{name}Clear"));
        (known_port(name), flag)
    }))
}

/// A number of the colour that the camera sees, as its own port.
fn colour_part(name: &str) -> Option<Read> {
    let parts = ["ColorSensorRPort", "ColorSensorGPort", "ColorSensorBPort"];
    let part = parts.iter().position(|part| *part == name)?;
    Some(Read::Part(Port::named("ColorSensorPort")?, part as u8))
}

fn is_readable(name: &str) -> bool {
    Port::find(lang_expr::Kit::V62, name, Direction::In).is_some() || colour_part(name).is_some()
}

/// A port that the table of ports has.
fn known_port(name: &str) -> Port {
    // The names are those of motors, servos and encoders 1 to 4, which a test looks up.
    Port::named(name).unwrap_or_else(|| unreachable!("{name} is in the table of ports"))
}

/// A choice whatever its case and spaces.
pub(crate) fn chosen(choices: &'static [&'static str], text: &str) -> Option<&'static str> {
    let plain = |text: &str| -> String {
        let letters = text.chars().filter(|c| !c.is_whitespace());
        letters.flat_map(char::to_lowercase).collect()
    };
    let wanted = plain(text);
    choices
        .iter()
        .copied()
        .find(|choice| plain(choice) == wanted)
}

/// A colour as commands name it: `light gray` as `lightGray`.
pub(crate) fn color(choice: &str) -> Rc<str> {
    let mut parts = choice.split(' ');
    let mut name = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (first, rest) = part.split_at(part.len().min(1));
        name.push_str(&first.to_ascii_uppercase());
        name.push_str(rest);
    }
    name.into()
}

/// Whether a text can be the name of a variable.
fn is_name(text: &str) -> bool {
    let mut chars = text.chars();
    let begins = |c: char| c.is_alphabetic() || c == '_';
    chars.next().is_some_and(begins) && chars.all(|c| begins(c) || c.is_numeric())
}

/// The constant that a text stands for: a number, a truth, a text with or without quotes, or a list in brackets.
pub(crate) fn constant(text: &str) -> Value {
    let text = text.trim();
    let inner = text
        .strip_prefix('[')
        .and_then(|text| text.strip_suffix(']'));
    match inner {
        Some(items) if items.trim().is_empty() => list(Vec::new()),
        Some(items) => list(items.split(',').map(single).collect()),
        None => single(text),
    }
}

fn list(items: Vec<Value>) -> Value {
    let list = lang_expr::value::List::new(items).unwrap_or_default();
    Value::List(Rc::new(list))
}

fn single(text: &str) -> Value {
    let text = text.trim();
    match text {
        "true" => return Value::Bool(true),
        "false" => return Value::Bool(false),
        _ => {}
    }
    if let Ok(whole) = text.parse() {
        return Value::Int(whole);
    }
    let is_number = text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    if let Some(number) = text
        .parse()
        .ok()
        .filter(|number: &f64| is_number && number.is_finite())
    {
        return Value::Float(number);
    }
    let quoted = ['"', '\''].into_iter().find_map(|quote| {
        text.strip_prefix(quote)
            .and_then(|text| text.strip_suffix(quote))
    });
    Value::text(quoted.unwrap_or(text))
}
