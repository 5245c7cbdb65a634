//! A robot that is watched: what its program tells display, marker, light and shell becomes records.
//!
//! Owns which command is which change of which device, and the form in which TRIK Studio writes what is on a display; also
//! the way back from such a record to commands. The robot behind it does not notice.

// A command that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]

use super::json::Value;
use super::trajectory::{DeviceChange, Record, Trajectory};
use crate::arena::screen::{Form, Object, Shown, hex};
use crate::arena::{Arena, Change, Handle};
use crate::limits;
use lang_diagram::brick::{Answer, Brick, Command, Figure, Question};
use lang_diagram::ports::Port;
use lang_text::problem::Problem;

const DISPLAY: (&str, &str) = ("display", "DisplayPort");
const MARKER: (&str, &str) = ("marker", "MarkerPort");
const LED: (&str, &str) = ("led", "LedPort");
const SHELL: (&str, &str) = ("shell", "ShellPort");

/// A robot whose commands are recorded.
pub(super) struct Recorder<'a> {
    pub arena: &'a mut Arena,
    pub robot: u16,
    pub ms: u32,
    pub trajectory: &'a mut Trajectory,
}

impl Recorder<'_> {
    fn push(&mut self, (device, port): (&str, &str), property: &str, value: Value) {
        if self.trajectory.records.len() >= limits::RECORDS {
            return;
        }
        let change = Box::new(DeviceChange {
            device: device.to_owned(),
            port: port.to_owned(),
            property: property.to_owned(),
            value,
        });
        self.trajectory.records.push(Record::Device {
            robot: self.robot,
            ms: self.ms,
            change,
        });
    }

    /// Records what a rule has changed.
    pub fn changed(&mut self, change: Change) {
        match change {
            Change::Phrase => {
                let phrase = self.shown().last_phrase.clone().unwrap_or_default();
                self.push(SHELL, "lastPhrase", phrase.into());
            }
            Change::Led => {
                let shown = self.shown();
                let colour = match shown.led_alpha {
                    u8::MAX => hex(shown.led),
                    alpha => format!("#{alpha:02x}{:06x}", shown.led.number()),
                };
                self.push(LED, "color", colour.into());
            }
            Change::Marker => {
                let marker = self.arena.robots()[usize::from(self.robot)].marker();
                let is_down = marker.is_down;
                let colour = Value::from(hex(crate::arena::screen::named(&marker.colour)));
                self.push(MARKER, "isDown", Value::Bool(is_down));
                if is_down {
                    self.push(MARKER, "color", colour);
                }
            }
            Change::Background => {
                let colour = Value::from(hex(self.shown().screen.background()));
                self.push(DISPLAY, "background", colour);
            }
        }
    }

    /// Records what a command has changed.
    fn record(&mut self, command: &Command<'_>) {
        match *command {
            Command::Say { .. } => self.changed(Change::Phrase),
            Command::Led { .. } => self.changed(Change::Led),
            Command::MarkerDown { .. } | Command::MarkerUp => self.changed(Change::Marker),
            Command::Background { .. } => self.changed(Change::Background),
            Command::Smile { .. } | Command::ClearScreen => {
                let screen = &self.shown().screen;
                let (smiles, sad) = (screen.smiles(), screen.sad_smiles());
                self.push(DISPLAY, "smiles", Value::Bool(smiles));
                self.push(DISPLAY, "sadSmiles", Value::Bool(sad));
                if matches!(command, Command::ClearScreen) {
                    self.push(DISPLAY, "objects", Value::Array(Vec::new()));
                }
            }
            Command::Draw(_) | Command::Label { .. } => {
                let objects = self.shown().screen.objects();
                // A list of a crowded display in each record would need too much memory.
                let some = objects.iter().take(limits::OBJECTS_TOLD).map(object);
                let list = Value::Array(some.collect());
                self.push(DISPLAY, "objects", list);
            }
            // What moves is recorded as a trajectory; the rest leaves nothing on a device that can be seen.
            Command::Console { .. }
            | Command::Power { .. }
            | Command::Off { .. }
            | Command::Servo { .. }
            | Command::ResetEncoder { .. }
            | Command::Sound { .. }
            | Command::Tone { .. }
            | Command::System { .. }
            | Command::Append { .. }
            | Command::Remove { .. }
            | Command::StartCamera { .. }
            | Command::StopCamera { .. }
            | Command::StartVideo { .. }
            | Command::StopVideo
            | Command::Detect { .. }
            | Command::Send { .. }
            | Command::Join { .. }
            | Command::CalibrateGyroscope
            | Command::PenColor { .. }
            | Command::PenWidth { .. }
            | Command::Redraw
            | Command::Rest => {}
        }
    }

    fn shown(&self) -> &Shown {
        self.arena.robots()[usize::from(self.robot)].shown()
    }

    fn handle(&mut self) -> Handle<'_> {
        self.arena.robot(usize::from(self.robot))
    }
}

impl Brick for Recorder<'_> {
    fn command(&mut self, command: Command<'_>) {
        self.handle().command(command);
        self.record(&command);
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        self.handle().scalar(port)
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        self.handle().vector(port, into)
    }

    fn locked(&mut self, port: Port) -> Option<i32> {
        self.handle().locked(port)
    }

    fn announced(&mut self) -> Option<(Port, i32)> {
        self.handle().announced()
    }

    fn random_of_function(&mut self, low: i32, high: i32) -> i32 {
        self.handle().random_of_function(low, high)
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        self.handle().random(low, high)
    }

    fn mail(&mut self) -> Option<String> {
        self.handle().mail()
    }

    fn ask(&mut self, question: Question<'_>) -> Answer {
        self.handle().ask(question)
    }

    fn may_ask_again(&mut self, question: Question<'_>) -> bool {
        self.handle().may_ask_again(question)
    }

    fn ask_again(&mut self, question: Question<'_>, why: &[Problem]) {
        self.handle().ask_again(question, why);
    }
}

/// A thing on a display, with names in the order of the alphabet.
fn object(object: &Object) -> Value {
    let colour = ("color", hex(object.colour).into());
    let mut parts: Vec<(&str, Value)> = vec![colour, ("thickness", object.thickness.into())];
    let mut numbers = |names: &[&'static str], values: &[i32]| {
        parts.extend(
            names
                .iter()
                .zip(values)
                .map(|(name, value)| (*name, (*value).into())),
        );
    };
    let kind = match &object.form {
        Form::Point(at) => {
            numbers(&["x", "y"], at);
            "point"
        }
        Form::Line(ends) => {
            numbers(&["x1", "y1", "x2", "y2"], ends);
            "line"
        }
        Form::Rectangle(sides, _) => {
            numbers(&["x", "y", "width", "height"], sides);
            "rectangle"
        }
        Form::Ellipse(sides, _) => {
            numbers(&["x", "y", "a", "b"], sides);
            "ellipse"
        }
        Form::Arc([x, y, width, height, start, span]) => {
            // Centre and half axes, in whole pixels.
            let middle = |from: i32, length: i32| from.saturating_add((length - 1).div_euclid(2));
            let (x, y) = (middle(*x, *width), middle(*y, *height));
            let all = [x, y, width / 2, height / 2, *start, *span];
            numbers(&["x", "y", "a", "b", "startAngle", "spanAngle"], &all);
            "arc"
        }
        Form::Text(at, _, size) => {
            numbers(&["x", "y"], at);
            numbers(&["fontSize"], &[*size]);
            "text"
        }
    };
    parts.push(("type", kind.into()));
    if let Form::Text(_, text, _) = &object.form {
        parts.push(("text", text.as_str().into()));
    }
    parts.into_iter().collect()
}

/// Changes a device again as it was changed.
pub(super) fn replay(brick: &mut dyn Brick, change: &DeviceChange) {
    match (&*change.device, &*change.property, &change.value) {
        (_, "lastPhrase", Value::String(text)) => brick.command(Command::Say { text: Some(text) }),
        ("led", "color", Value::String(color)) => brick.command(Command::Led { color }),
        ("marker", "color", Value::String(color)) => brick.command(Command::MarkerDown { color }),
        (_, "isDown", Value::Bool(true)) => brick.command(Command::MarkerDown { color: "black" }),
        (_, "isDown", Value::Bool(false)) => brick.command(Command::MarkerUp),
        (_, "background", Value::String(color)) => brick.command(Command::Background { color }),
        (_, "smiles", Value::Bool(true)) => brick.command(Command::Smile { sad: false }),
        (_, "sadSmiles", Value::Bool(true)) => brick.command(Command::Smile { sad: true }),
        (_, "objects", Value::Array(objects)) => {
            brick.command(Command::ClearScreen);
            objects.iter().for_each(|object| draw(brick, object));
        }
        _ => {}
    }
}

/// Draws a thing of a record again.
fn draw(brick: &mut dyn Brick, object: &Value) {
    let number = |name: &str| {
        let number = object.get(name).and_then(Value::as_f64);
        number.unwrap_or_default() as i32
    };
    let text = |name: &str| object.get(name).and_then(Value::as_str).unwrap_or_default();
    brick.command(Command::PenColor {
        color: text("color"),
    });
    brick.command(Command::PenWidth {
        width: number("thickness"),
    });
    let (x, y) = (number("x"), number("y"));
    let figure = match text("type") {
        "text" => {
            return brick.command(Command::Label {
                x,
                y,
                size: number("fontSize"),
                text: text("text"),
            });
        }
        "point" => Figure::Pixel([x, y]),
        "line" => Figure::Line(["x1", "y1", "x2", "y2"].map(number)),
        "rectangle" => Figure::Rectangle([x, y, number("width"), number("height")], false),
        "ellipse" => Figure::Ellipse([x, y, number("a"), number("b")], false),
        "arc" => {
            let angles = ["startAngle", "spanAngle"].map(number);
            let [width, height] = ["a", "b"].map(|name| number(name).saturating_mul(2));
            let corner =
                |middle: i32, length: i32| middle.saturating_sub((length - 1).div_euclid(2));
            let (x, y) = (corner(x, width), corner(y, height));
            Figure::Arc([x, y, width, height, angles[0], angles[1]])
        }
        _ => return,
    };
    brick.command(Command::Draw(figure));
}
