//! Values of the language of constraints, with the conversions and comparisons that the original takes from Qt.
//!
//! Owns [`Value`]: how it compares, what it is as a whole number and as text, and the properties of values that are no
//! objects. Knows no scene.

use std::cmp::Ordering;
use std::rc::Rc;

use super::scene::{Missing, Object};

/// A point, in whole pixels as the original keeps it.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Point {
    /// To the right.
    pub x: i32,
    /// Down.
    pub y: i32,
}

/// A rectangle, in whole pixels as the original keeps it.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Rect {
    /// Its left side.
    pub x: i32,
    /// Its upper side.
    pub y: i32,
    /// To the right.
    pub width: i32,
    /// Down.
    pub height: i32,
}

/// A value.
#[derive(Clone, Debug, Default)]
pub enum Value {
    /// Nothing: a variable that was never set.
    #[default]
    Null,
    /// Yes or no.
    Bool(bool),
    /// A whole number.
    Int(i32),
    /// A number.
    Double(f64),
    /// A text that was never set: it is empty, and asking for it by `${}` is an error.
    NoText,
    /// A text.
    Text(Rc<str>),
    /// A point.
    Point(Point),
    /// A place that is not rounded.
    Place([f64; 2]),
    /// A rectangle.
    Rect(Rect),
    /// A colour, as 0xaarrggbb.
    Colour(u32),
    /// Something that is there but cannot be shown, compared or looked into, as the readings of a gyroscope.
    Opaque,
    /// Several values.
    List(Rc<[Value]>),
    /// Something with named properties that is no object of the scene, as a figure on a screen.
    Record(Rc<[(&'static str, Value)]>),
    /// An object of the scene.
    Object(Object),
}

/// The alpha of a colour that hides what is below it.
const OPAQUE: u32 = 0xff00_0000;
/// How far two numbers may lie apart, as parts of the smaller one, and still be equal.
const FUZZY: f64 = 1e-12;

impl Value {
    /// A text.
    pub fn text(text: &str) -> Self {
        Self::Text(text.into())
    }

    /// A colour that hides what is below it, of 0xrrggbb.
    pub fn colour(rgb: u32) -> Self {
        Self::Colour(OPAQUE | rgb)
    }

    /// Several values.
    pub fn list(items: impl IntoIterator<Item = Value>) -> Self {
        Self::List(items.into_iter().collect())
    }

    /// What an attribute means that may be anything: true or false, a whole number, a number, else text.
    pub fn guess(text: &str) -> Self {
        let trimmed = text.trim();
        match trimmed {
            "true" => Self::Bool(true),
            "false" => Self::Bool(false),
            _ => match (trimmed.parse(), double(trimmed)) {
                (Ok(whole), _) => Self::Int(whole),
                (_, Some(number)) => Self::Double(number),
                _ => Self::text(text),
            },
        }
    }

    /// As a whole number: rounded, 1 for true, the number that a text is; 0 for everything else.
    pub fn to_int(&self) -> i32 {
        match self {
            Self::Bool(yes) => i32::from(*yes),
            Self::Int(number) => *number,
            Self::Double(number) => rounded(*number),
            Self::Text(text) => text.trim().parse().unwrap_or(0),
            Self::Null
            | Self::Point(_)
            | Self::Place(_)
            | Self::NoText
            | Self::Rect(_)
            | Self::Colour(_)
            | Self::Opaque
            | Self::List(_)
            | Self::Record(_)
            | Self::Object(_) => 0,
        }
    }

    /// As a point; a null point for what is none.
    pub fn to_point(&self) -> Point {
        match self {
            Self::Point(point) => *point,
            Self::Place([x, y]) => Point {
                x: rounded(*x),
                y: rounded(*y),
            },
            Self::Null
            | Self::Bool(_)
            | Self::Int(_)
            | Self::Double(_)
            | Self::Text(_)
            | Self::NoText
            | Self::Rect(_)
            | Self::Colour(_)
            | Self::Opaque
            | Self::List(_)
            | Self::Record(_)
            | Self::Object(_) => Point::default(),
        }
    }

    /// As text; empty for what has none.
    pub fn to_text(&self) -> String {
        match self {
            Self::Bool(yes) => yes.to_string(),
            Self::Int(number) => number.to_string(),
            Self::Double(number) => shown(*number),
            Self::Text(text) => text.to_string(),
            Self::Colour(argb) if argb & OPAQUE == OPAQUE => {
                format!("#{:06x}", argb & !OPAQUE)
            }
            Self::Colour(argb) => format!("#{argb:08x}"),
            Self::Null
            | Self::Point(_)
            | Self::NoText
            | Self::Place(_)
            | Self::Rect(_)
            | Self::Opaque
            | Self::List(_)
            | Self::Record(_)
            | Self::Object(_) => String::new(),
        }
    }

    /// Its type, as the original names it.
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::Null => "",
            Self::Bool(_) => "bool",
            Self::Int(_) => "int",
            Self::Double(_) => "double",
            Self::Text(_) | Self::NoText => "QString",
            Self::Point(_) => "QPoint",
            Self::Place(_) => "QPointF",
            Self::Rect(_) => "QRect",
            Self::Colour(_) => "QColor",
            Self::Opaque => "QVector<int>",
            Self::List(_) => "QVariantList",
            Self::Record(_) | Self::Object(_) => "QObject*",
        }
    }

    /// As a number, if it is one.
    fn number(&self) -> Option<f64> {
        match self {
            Self::Int(number) => Some(f64::from(*number)),
            Self::Double(number) => Some(*number),
            Self::Null
            | Self::Bool(_)
            | Self::Text(_)
            | Self::Point(_)
            | Self::Place(_)
            | Self::NoText
            | Self::Rect(_)
            | Self::Colour(_)
            | Self::Opaque
            | Self::List(_)
            | Self::Record(_)
            | Self::Object(_) => None,
        }
    }

    /// As true or false beside a value that is that: any text but those that say no, any number but 0.
    fn truth(&self) -> Option<bool> {
        match self {
            Self::Bool(yes) => Some(*yes),
            Self::Int(number) => Some(*number != 0),
            Self::Text(text) => Some(!["", "0", "false"].contains(&text.to_lowercase().as_str())),
            Self::Null
            | Self::Double(_)
            | Self::Point(_)
            | Self::Place(_)
            | Self::NoText
            | Self::Rect(_)
            | Self::Colour(_)
            | Self::Opaque
            | Self::List(_)
            | Self::Record(_)
            | Self::Object(_) => None,
        }
    }

    /// Whether two values are equal, by the rules of [`Value::order`].
    pub fn equals(&self, other: &Value) -> bool {
        match (self, other) {
            (Self::Point(left), Self::Point(right)) => left == right,
            (Self::Place(left), Self::Place(right)) => left == right,
            (Self::Rect(left), Self::Rect(right)) => left == right,
            (Self::Object(left), Self::Object(right)) => left == right,
            (Self::Colour(left), Self::Colour(right)) => left == right,
            (Self::Colour(one), Self::Text(text)) => colour(text) == Some(*one),
            (Self::Text(text), Self::Colour(_)) => **text == *other.to_text(),
            (Self::List(left), Self::List(right)) => {
                let mut pairs = left.iter().zip(right.iter());
                left.len() == right.len() && pairs.all(|(left, right)| left.equals(right))
            }
            (Self::Record(left), Self::Record(right)) => Rc::ptr_eq(left, right),
            (
                Self::Null
                | Self::Bool(_)
                | Self::Int(_)
                | Self::Double(_)
                | Self::NoText
                | Self::Text(_)
                | Self::Point(_)
                | Self::Place(_)
                | Self::Rect(_)
                | Self::Colour(_)
                | Self::Opaque
                | Self::List(_)
                | Self::Record(_)
                | Self::Object(_),
                _,
            ) => self.order(other) == Some(Ordering::Equal),
        }
    }

    /// Which of two values is greater; `None` for what has no order.
    ///
    /// Nothing is less than anything and equal to nothing alone. Two texts compare letter by letter as UTF-16 has them,
    /// also if both look like numbers. Beside true or false a whole number or a text is true or false too. A number and a
    /// text that is one compare as numbers, with any other text as texts.
    pub fn order(&self, other: &Value) -> Option<Ordering> {
        match (self, other) {
            (Self::NoText, _) => return Self::text("").order(other),
            (_, Self::NoText) => return self.order(&Self::text("")),
            (Self::Null, Self::Null) => return Some(Ordering::Equal),
            (Self::Null, _) => return Some(Ordering::Less),
            (_, Self::Null) => return Some(Ordering::Greater),
            (Self::Text(left), Self::Text(right)) => return Some(by_code(left, right)),
            (Self::Bool(yes), Self::Double(number)) => {
                return compare_numbers(f64::from(u8::from(*yes)), *number);
            }
            (Self::Double(number), Self::Bool(yes)) => {
                return compare_numbers(*number, f64::from(u8::from(*yes)));
            }
            (Self::Bool(_), _) | (_, Self::Bool(_)) => {
                return Some(self.truth()?.cmp(&other.truth()?));
            }
            // Numbers, and what `number` says to be none.
            _ => {}
        }
        match (self.number(), other.number(), self, other) {
            (Some(left), Some(right), ..) => compare_numbers(left, right),
            (Some(left), None, _, Self::Text(text)) => match double(text.trim()) {
                Some(right) => compare_numbers(left, right),
                None => Some(by_code(&self.to_text(), text)),
            },
            (None, Some(right), Self::Text(text), _) => match double(text.trim()) {
                Some(left) => compare_numbers(left, right),
                None => Some(by_code(text, &other.to_text())),
            },
            // Without a number and a text there is no order.
            _ => None,
        }
    }

    /// What stands at the end of a chain of properties, from the link `at` on.
    ///
    /// # Errors
    /// [`Missing`], with the index of the link that has no value.
    pub fn descend(self, chain: &[Box<str>], at: usize) -> Result<Value, Missing> {
        let mut value = self;
        for (index, name) in chain.iter().enumerate().skip(at) {
            value = match value.own_property(name) {
                Some(found) => found.ok_or(Missing::Property(index))?,
                None => return Err(Missing::Type(index)),
            };
        }
        Ok(value)
    }

    /// A property of a value that is no object: nothing if its type has none, `Some(None)` if it has not this one.
    fn own_property(&self, name: &str) -> Option<Option<Value>> {
        Some(match self {
            Self::Point(point) => match name {
                "x" => Some(Self::Int(point.x)),
                "y" => Some(Self::Int(point.y)),
                _ => None,
            },
            Self::Place([x, y]) => match name {
                "x" => Some(Self::Double(*x)),
                "y" => Some(Self::Double(*y)),
                _ => None,
            },
            Self::Rect(rect) => match name {
                "x" => Some(Self::Int(rect.x)),
                "y" => Some(Self::Int(rect.y)),
                "width" => Some(Self::Int(rect.width)),
                "height" => Some(Self::Int(rect.height)),
                _ => None,
            },
            Self::List(items) => match name {
                "size" => Some(Self::Int(i32::try_from(items.len()).unwrap_or(i32::MAX))),
                "isEmpty" => Some(Self::Bool(items.is_empty())),
                "first" => items.first().cloned(),
                "last" => items.last().cloned(),
                _ => {
                    let index = name.parse::<usize>().ok();
                    index.and_then(|index| items.get(index)).cloned()
                }
            },
            Self::Record(fields) => fields
                .iter()
                .find(|(field, _)| *field == name)
                .map(|(_, value)| value.clone()),
            Self::Null
            | Self::Bool(_)
            | Self::Int(_)
            | Self::Double(_)
            | Self::NoText
            | Self::Text(_)
            | Self::Colour(_)
            | Self::Opaque
            | Self::Object(_) => return None,
        })
    }
}

/// Names of colours that programs and fields use.
const COLOURS: [(&str, u32); 20] = [
    ("black", 0),
    ("blue", 0x0000ff),
    ("cyan", 0x00ffff),
    ("darkblue", 0x00008b),
    ("darkcyan", 0x008b8b),
    ("darkgray", 0xa9a9a9),
    ("darkgreen", 0x006400),
    ("darkmagenta", 0x8b008b),
    ("darkred", 0x8b0000),
    ("gray", 0x808080),
    ("green", 0x008000),
    ("grey", 0x808080),
    ("lightgray", 0xd3d3d3),
    ("lime", 0x00ff00),
    ("magenta", 0xff00ff),
    ("orange", 0xffa500),
    ("pink", 0xffc0cb),
    ("red", 0xff0000),
    ("white", 0xffffff),
    ("yellow", 0xffff00),
];

/// To the nearest whole number: halves go up, also below zero; beyond the ends there are the ends.
#[allow(clippy::cast_possible_truncation)]
fn rounded(number: f64) -> i32 {
    (number + 0.5).floor() as i32
}

/// A colour by its name, or as `#rgb`, `#rrggbb` or `#aarrggbb`.
fn colour(text: &str) -> Option<u32> {
    let text = text.trim().to_ascii_lowercase();
    let Some(digits) = text.strip_prefix('#') else {
        let found = COLOURS.iter().find(|(name, _)| *name == text);
        return found.map(|(_, rgb)| OPAQUE | *rgb);
    };
    let number = u32::from_str_radix(digits, 16).ok()?;
    match digits.len() {
        3 => {
            let spread = ((number & 0xf00) << 8) | ((number & 0xf0) << 4) | (number & 0xf);
            Some(OPAQUE | (spread * 0x11))
        }
        6 => Some(OPAQUE | number),
        8 => Some(number),
        _ => None,
    }
}

fn compare_numbers(left: f64, right: f64) -> Option<Ordering> {
    let fuzzy = (left - right).abs() <= FUZZY * left.abs().min(right.abs());
    if fuzzy {
        return Some(Ordering::Equal);
    }
    left.partial_cmp(&right)
}

/// Which text comes first by the codes of UTF-16.
fn by_code(left: &str, right: &str) -> Ordering {
    left.encode_utf16().cmp(right.encode_utf16())
}

/// A number as Qt reads it, which knows no infinity.
pub(super) fn double(text: &str) -> Option<f64> {
    text.parse()
        .ok()
        .filter(|number: &f64| number.is_finite() && !text.is_empty())
}

/// A number as Qt shows it: as few digits as tell it from others, and whichever of the two forms is shorter.
pub(super) fn shown(number: f64) -> String {
    if !number.is_finite() {
        return format!("{number}").to_lowercase();
    }
    let text = format!("{number:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let count = digits.bytes().filter(u8::is_ascii_digit).count();
    let count = i32::try_from(count).unwrap_or(i32::MAX);
    // Where the point stands in the digits; a whole number that ends with its digits has no use for an exponent.
    let point = exponent + 1;
    if point != count && (point <= -4 || point > count.saturating_add(5)) {
        let sign = if exponent < 0 { '-' } else { '+' };
        return format!("{digits}e{sign}{:02}", exponent.abs());
    }
    format!("{number}")
}
