//! Attributes of one tag in both directions: from text to values, and back where a value is no longer what the text says.
//!
//! Owns numbers, points, truths and units, and what is wrong with them. Knows no tags.
//! A thing visits its attributes once, with a [`Codec`] that reads or writes: so both are the same list.

use lang_text::problem::{Problem, Severity, keep};
use lang_text::xml::Element;

use super::items::{Material, Pen};
use super::words;
use crate::geometry::{Point, point};
use crate::limits;

/// What is done with the attributes.
pub(super) enum Mode<'p> {
    /// From text to values; what is wrong goes here.
    Read(&'p mut Vec<Problem>),
    /// From text to values once more.
    ReadAgain,
    /// From values to text.
    Write,
    /// Only which attributes are asked for.
    List(&'p mut Names),
}

/// Which attributes a kind of thing asks for.
#[derive(Debug, Default)]
pub(super) struct Names {
    pub all: Vec<String>,
    /// What is answered where it is asked whether an attribute is there.
    pub is_there: bool,
}

/// The attributes of a tag, being read or written.
pub(super) struct Codec<'e, 'p> {
    pub element: &'e mut Element<'static>,
    pub mode: Mode<'p>,
    /// Pixels in a unit of the text.
    pub scale: f64,
    /// Which of its kind it is, from 1, for messages.
    pub ordinal: usize,
}

impl Codec<'_, '_> {
    /// Whether values come from text.
    pub fn is_reading(&self) -> bool {
        matches!(self.mode, Mode::Read(_) | Mode::ReadAgain | Mode::List(_))
    }

    /// The same tag, to be read whatever is done with it; what is wrong has been told before.
    pub fn reading(&mut self) -> Codec<'_, '_> {
        let mode = match &mut self.mode {
            Mode::Read(problems) => Mode::Read(problems),
            Mode::Write | Mode::ReadAgain => Mode::ReadAgain,
            Mode::List(names) => Mode::List(names),
        };
        Codec {
            element: self.element,
            mode,
            scale: self.scale,
            ordinal: self.ordinal,
        }
    }

    /// A tag inside this one.
    pub fn inside<'i>(&'i mut self, element: &'i mut Element<'static>) -> Codec<'i, 'i> {
        let mode = match &mut self.mode {
            Mode::Read(problems) => Mode::Read(problems),
            Mode::ReadAgain => Mode::ReadAgain,
            Mode::Write => Mode::Write,
            Mode::List(names) => Mode::List(names),
        };
        Codec {
            element,
            mode,
            scale: self.scale,
            ordinal: self.ordinal,
        }
    }

    /// Whether the tag has an attribute.
    pub fn has(&mut self, name: &str) -> bool {
        match &mut self.mode {
            Mode::Read(_) | Mode::ReadAgain | Mode::Write => self.element.attribute(name).is_some(),
            Mode::List(names) => names.is_there,
        }
    }

    /// The text of an attribute.
    pub fn attribute(&mut self, name: &str) -> Option<&str> {
        if let Mode::List(names) = &mut self.mode
            && !names.all.iter().any(|one| one == name)
        {
            names.all.push(name.to_owned());
        }
        self.element.attribute(name)
    }

    fn complain(&mut self, severity: Severity, name: &str, text: &str) {
        let id = self.element.attribute("id").unwrap_or_default();
        let words = words::number(&self.element.name, self.ordinal, id, name, text, severity);
        if let Mode::Read(problems) = &mut self.mode {
            let mut problem = Problem::error(words);
            problem.severity = severity;
            if !id.is_empty() {
                problem.place.object = Some(id.to_owned());
            }
            problem.place.offset = Some(self.element.start.0).filter(|&at| at > 0);
            keep(problems, problem);
        }
    }

    /// One number of an attribute's text: as the original reads it, so that no number is 0.
    fn number(&mut self, name: &str, text: &str) -> f64 {
        let Ok(number) = text.trim().parse::<f64>() else {
            self.complain(Severity::Warning, name, text);
            return 0.0;
        };
        if !number.is_finite() || number.abs() > limits::FIELD_NUMBER {
            self.complain(Severity::Error, name, text);
            return 0.0;
        }
        number
    }

    fn numbers<const N: usize>(&mut self, name: &str) -> Option<[f64; N]> {
        let text = self.attribute(name)?.to_owned();
        let parts: Vec<&str> = text.split(':').take(N + 1).collect();
        if parts.len() != N {
            self.complain(Severity::Warning, name, &text);
            return Some([0.0; N]);
        }
        let mut numbers = [0.0; N];
        for (number, part) in numbers.iter_mut().zip(parts) {
            *number = self.number(name, part);
        }
        Some(numbers)
    }

    /// Several numbers with colons between them, each with its scale.
    fn list<const N: usize>(&mut self, name: &str, values: &mut [f64; N], default: [f64; N]) {
        let scale = self.scale;
        let there = self
            .numbers(name)
            .map_or(default, |found| found.map(|number| number * scale));
        if self.is_reading() {
            *values = there;
        } else if *values != there {
            let texts = values.map(|value| format!("{}", value / scale));
            self.element.set(name, &texts.join(":"));
        }
    }

    /// A number that is no length.
    pub fn plain(&mut self, name: &str, value: &mut f64, default: f64) {
        let scale = std::mem::replace(&mut self.scale, 1.0);
        self.length(name, value, default);
        self.scale = scale;
    }

    /// A length; `default` is in pixels.
    pub fn length(&mut self, name: &str, value: &mut f64, default: f64) {
        let mut list = [*value];
        self.list(name, &mut list, [default]);
        *value = list[0];
    }

    /// A length whose text means another one: `meaning` of what stands there, in pixels.
    pub fn length_as(&mut self, name: &str, value: &mut f64, meaning: impl Fn(f64) -> f64) {
        let there = meaning(
            self.numbers(name)
                .map_or(0.0, |[number]| number * self.scale),
        );
        if self.is_reading() {
            *value = there;
        } else if *value != there {
            let text = format!("{}", *value / self.scale);
            self.element.set(name, &text);
        }
    }

    /// A point as `x:y`.
    pub fn point(&mut self, name: &str, value: &mut Point, default: Point) {
        let mut list = [value.x, value.y];
        self.list(name, &mut list, [default.x, default.y]);
        *value = point(list[0], list[1]);
    }

    /// A point in two attributes.
    pub fn pair(&mut self, names: [&str; 2], value: &mut Point, default: Point) {
        self.length(names[0], &mut value.x, default.x);
        self.length(names[1], &mut value.y, default.y);
    }

    /// A point in two attributes, of which one alone says nothing.
    pub fn both(&mut self, names: [&str; 2], value: &mut Point, default: Point) {
        let mut there = default;
        if names.into_iter().all(|name| self.has(name)) {
            self.reading().pair(names, &mut there, default);
        }
        if self.is_reading() {
            *value = there;
        } else if *value != there {
            let scale = self.scale;
            for (name, number) in names.into_iter().zip([value.x, value.y]) {
                self.element.set(name, &format!("{}", number / scale));
            }
        }
    }

    /// A rectangle as `x:y:width:height`.
    pub fn rectangle(&mut self, name: &str, at: &mut Point, size: &mut Point) {
        let mut list = [at.x, at.y, size.x, size.y];
        self.list(name, &mut list, [0.0; 4]);
        let [x, y, width, height] = list;
        (*at, *size) = (point(x, y), point(width, height));
    }

    /// A text.
    pub fn text(&mut self, name: &str, value: &mut String, default: &str) {
        let there = self.attribute(name).unwrap_or(default).to_owned();
        if self.is_reading() {
            *value = there;
        } else if *value != there {
            self.element.set(name, value);
        }
    }

    /// A truth: `true`, and nothing else, is true.
    pub fn flag(&mut self, name: &str, value: &mut bool, default: bool) {
        let text = self.attribute(name);
        let there = text.map_or(default, |text| text == "true");
        if self.is_reading() {
            *value = there;
        } else if *value != there {
            self.element
                .set(name, if *value { "true" } else { "false" });
        }
    }

    /// What a thing is made of.
    pub fn material(&mut self, value: &mut Material, default: Material) {
        self.plain("mass", &mut value.mass, default.mass);
        self.plain("friction", &mut value.friction, default.friction);
        self.plain("restitution", &mut value.restitution, default.restitution);
        self.plain(
            "angularDamping",
            &mut value.angular_damping,
            default.angular_damping,
        );
        self.plain(
            "linearDamping",
            &mut value.linear_damping,
            default.linear_damping,
        );
    }

    /// A pen and its brush.
    pub fn pen(&mut self, pen: &mut Pen) {
        self.text("stroke", &mut pen.colour, "");
        self.length("stroke-width", &mut pen.width, 0.0);
        self.text("stroke-style", &mut pen.style, "");
        self.text("fill", &mut pen.fill, "");
        self.text("fill-style", &mut pen.fill_style, "");
    }
}
