//! A robot that is watched: what its program tells display, marker, light and shell becomes records.
//!
//! Owns which command is which change of which device, and the form in which TRIK Studio writes what is on a display; also
//! the way back from such a record to commands. The robot behind it does not notice.

use super::json::Value;
use super::trajectory::{Record, Told, Trajectory};
use crate::arena::screen::{Form, Object, Shown, hex};
use crate::arena::{Arena, Handle};
use crate::limits;
use lang_diagram::brick::{Answer, Brick, Command, Figure, Question};
use lang_diagram::ports::Port;

/// A robot whose commands are recorded.
pub(super) struct Recorder<'a> {
    pub arena: &'a mut Arena,
    pub robot: u16,
    pub ms: u32,
    pub trajectory: &'a mut Trajectory,
}

impl Recorder<'_> {
    fn told(&mut self, (device, port): (&str, &str), property: &str, value: Value) {
        if self.trajectory.records.len() >= limits::RECORDS {
            return;
        }
        let told = Box::new(Told {
            device: device.to_owned(),
            port: port.to_owned(),
            property: property.to_owned(),
            value,
        });
        self.trajectory.records.push(Record::Told {
            robot: self.robot,
            ms: self.ms,
            told,
        });
    }

    /// Records what a command has changed.
    fn record(&mut self, command: &Command<'_>) {
        const DISPLAY: (&str, &str) = ("display", "DisplayPort");
        const MARKER: (&str, &str) = ("marker", "MarkerPort");
        const LED: (&str, &str) = ("led", "LedPort");
        const SHELL: (&str, &str) = ("shell", "ShellPort");
        match *command {
            Command::Say { .. } | Command::Console { .. } => {
                let phrase = self.shown().last_phrase.clone();
                self.told(SHELL, "lastPhrase", phrase.into());
            }
            Command::Led { .. } => {
                let colour = Value::from(hex(self.shown().led));
                self.told(LED, "color", colour);
            }
            Command::MarkerDown { color } => {
                let colour = Value::from(hex(crate::arena::screen::named(color)));
                self.told(MARKER, "isDown", Value::Bool(true));
                self.told(MARKER, "color", colour);
            }
            Command::MarkerUp => self.told(MARKER, "isDown", Value::Bool(false)),
            Command::Background { .. } => {
                let colour = Value::from(hex(self.shown().screen.background()));
                self.told(DISPLAY, "background", colour);
            }
            Command::Smile { .. } | Command::ClearScreen => {
                let screen = &self.shown().screen;
                let (smiles, sad) = (screen.smiles(), screen.sad_smiles());
                self.told(DISPLAY, "smiles", Value::Bool(smiles));
                self.told(DISPLAY, "sadSmiles", Value::Bool(sad));
                if matches!(command, Command::ClearScreen) {
                    self.told(DISPLAY, "objects", Value::Array(Vec::new()));
                }
            }
            Command::Draw(_) | Command::Label { .. } => {
                let objects = self.shown().screen.objects();
                // A list of a crowded display in each record would need too much memory.
                let some = objects.iter().take(limits::OBJECTS_TOLD).map(object);
                let list = Value::Array(some.collect());
                self.told(DISPLAY, "objects", list);
            }
            // What moves is recorded as a trajectory; the rest leaves nothing on a device that can be seen.
            Command::Power { .. }
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
    fn tell(&mut self, command: Command<'_>) {
        self.handle().tell(command);
        self.record(&command);
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        self.handle().scalar(port)
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        self.handle().vector(port, into)
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
        Form::Arc(all) => {
            numbers(&["x", "y", "a", "b", "startAngle", "spanAngle"], all);
            "arc"
        }
        Form::Text(at, _, size) => {
            numbers(&["x", "y"], at);
            numbers(&["fontSize"], &[*size]);
            "text"
        }
    };
    parts.push(("type", kind.into()));
    match &object.form {
        Form::Text(_, text, _) => parts.push(("text", text.as_str().into())),
        Form::Rectangle(_, true) | Form::Ellipse(_, true) => {
            parts.push(("filled", true.into()));
        }
        _ => {}
    }
    parts.into_iter().collect()
}

/// Tells a device again what it was told.
pub(super) fn replay(brick: &mut dyn Brick, told: &Told) {
    match (&*told.device, &*told.property, &told.value) {
        (_, "lastPhrase", Value::String(text)) => brick.tell(Command::Say { text }),
        ("led", "color", Value::String(color)) => brick.tell(Command::Led { color }),
        ("marker", "color", Value::String(color)) => brick.tell(Command::MarkerDown { color }),
        (_, "isDown", Value::Bool(true)) => brick.tell(Command::MarkerDown { color: "black" }),
        (_, "isDown", Value::Bool(false)) => brick.tell(Command::MarkerUp),
        (_, "background", Value::String(color)) => brick.tell(Command::Background { color }),
        (_, "smiles", Value::Bool(true)) => brick.tell(Command::Smile { sad: false }),
        (_, "sadSmiles", Value::Bool(true)) => brick.tell(Command::Smile { sad: true }),
        (_, "objects", Value::Array(objects)) => {
            brick.tell(Command::ClearScreen);
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
    let is_filled = object.get("filled") == Some(&Value::Bool(true));
    brick.tell(Command::PenColor {
        color: text("color"),
    });
    brick.tell(Command::PenWidth {
        width: number("thickness"),
    });
    let (x, y) = (number("x"), number("y"));
    let figure = match text("type") {
        "text" => {
            return brick.tell(Command::Label {
                x,
                y,
                size: number("fontSize"),
                text: text("text"),
            });
        }
        "point" => Figure::Pixel([x, y]),
        "line" => Figure::Line(["x1", "y1", "x2", "y2"].map(number)),
        "rectangle" => Figure::Rectangle([x, y, number("width"), number("height")], is_filled),
        "ellipse" => Figure::Ellipse([x, y, number("a"), number("b")], is_filled),
        "arc" => {
            let angles = ["startAngle", "spanAngle"].map(number);
            Figure::Arc([x, y, number("a"), number("b"), angles[0], angles[1]])
        }
        _ => return,
    };
    brick.tell(Command::Draw(figure));
}
