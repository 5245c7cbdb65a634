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
    /// A text.
    Text(Rc<str>),
    /// A point.
    Point(Point),
    /// A rectangle.
    Rect(Rect),
    /// A colour, as 0xrrggbb.
    Colour(u32),
    /// Several values.
    List(Rc<[Value]>),
    /// Something with named properties that is no object of the scene, as a figure on a screen.
    Record(Rc<[(&'static str, Value)]>),
    /// An object of the scene.
    Object(Object),
}

/// How far two numbers may lie apart, as parts of the smaller one, and still be equal.
const FUZZY: f64 = 1e-12;

impl Value {
    /// A text.
    pub fn text(text: &str) -> Self {
        Self::Text(text.into())
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
            // Halves go up, also below zero; `as` stops at the ends.
            #[allow(clippy::cast_possible_truncation)]
            Self::Double(number) => (number + 0.5).floor() as i32,
            Self::Text(text) => text.trim().parse().unwrap_or(0),
            Self::Null
            | Self::Point(_)
            | Self::Rect(_)
            | Self::Colour(_)
            | Self::List(_)
            | Self::Record(_)
            | Self::Object(_) => 0,
        }
    }

    /// As a point; a null point for what is none.
    pub fn to_point(&self) -> Point {
        match self {
            Self::Point(point) => *point,
            Self::Null
            | Self::Bool(_)
            | Self::Int(_)
            | Self::Double(_)
            | Self::Text(_)
            | Self::Rect(_)
            | Self::Colour(_)
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
            Self::Colour(rgb) => format!("#{rgb:06x}"),
            Self::Null
            | Self::Point(_)
            | Self::Rect(_)
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
            Self::Text(_) => "QString",
            Self::Point(_) => "QPoint",
            Self::Rect(_) => "QRect",
            Self::Colour(_) => "QColor",
            Self::List(_) => "QVariantList",
            Self::Record(_) | Self::Object(_) => "QObject*",
        }
    }

    fn number(&self) -> Option<f64> {
        match self {
            Self::Bool(yes) => Some(f64::from(u8::from(*yes))),
            Self::Int(number) => Some(f64::from(*number)),
            Self::Double(number) => Some(*number),
            Self::Null
            | Self::Text(_)
            | Self::Point(_)
            | Self::Rect(_)
            | Self::Colour(_)
            | Self::List(_)
            | Self::Record(_)
            | Self::Object(_) => None,
        }
    }

    /// The other value as the type of this one; `None` if it cannot be.
    fn converted(&self, other: &Value) -> Option<Value> {
        match (self, other) {
            (Self::Text(_), Self::Bool(_) | Self::Int(_) | Self::Double(_) | Self::Colour(_)) => {
                Some(Self::text(&other.to_text()))
            }
            (Self::Colour(_), Self::Text(text)) => colour(text).map(Self::Colour),
            (Self::Int(_), Self::Text(text)) => text.trim().parse().ok().map(Self::Int),
            (Self::Double(_), Self::Text(text)) => double(text.trim()).map(Self::Double),
            (Self::Bool(_), Self::Text(text)) => {
                let no = ["", "0", "false"].contains(&text.to_lowercase().as_str());
                Some(Self::Bool(!no))
            }
            _ => None,
        }
    }

    /// Whether two values are equal: numbers as numbers, a text and a number as the type of the left one. Nothing equals
    /// only nothing.
    pub fn equals(&self, other: &Value) -> bool {
        if let (Some(left), Some(right)) = (self.number(), other.number()) {
            return compare_numbers(left, right) == Some(Ordering::Equal);
        }
        match (self, other) {
            (Self::Null, Self::Null) => true,
            (Self::Text(left), Self::Text(right)) => left == right,
            (Self::Point(left), Self::Point(right)) => left == right,
            (Self::Rect(left), Self::Rect(right)) => left == right,
            (Self::Object(left), Self::Object(right)) => left == right,
            (Self::Colour(left), Self::Colour(right)) => left == right,
            (Self::List(left), Self::List(right)) => {
                left.len() == right.len()
                    && left
                        .iter()
                        .zip(right.iter())
                        .all(|(left, right)| left.equals(right))
            }
            (Self::Record(left), Self::Record(right)) => Rc::ptr_eq(left, right),
            (Self::Text(_), _) | (_, Self::Text(_)) => {
                self.converted(other).is_some_and(|same| same.equals(self))
            }
            _ => false,
        }
    }

    /// Which of two values is greater: numbers as numbers, texts by letters whatever their case. Nothing is less than
    /// anything; `None` for what has no order.
    pub fn order(&self, other: &Value) -> Option<Ordering> {
        if let (Some(left), Some(right)) = (self.number(), other.number()) {
            return compare_numbers(left, right);
        }
        if self.equals(other) {
            return Some(Ordering::Equal);
        }
        match (self, other) {
            (Self::Null, _) => Some(Ordering::Less),
            (_, Self::Null) => Some(Ordering::Greater),
            (Self::Text(left), Self::Text(right)) => {
                Some(left.to_lowercase().cmp(&right.to_lowercase()))
            }
            (Self::Text(_), _) => {
                let same = self.converted(other)?;
                self.order(&same)
            }
            (_, Self::Text(_)) => {
                let same = self.converted(other)?;
                self.order(&same)
            }
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
            | Self::Text(_)
            | Self::Colour(_)
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

/// A colour by its name, or as `#rgb`, `#rrggbb` or `#aarrggbb`.
fn colour(text: &str) -> Option<u32> {
    let text = text.trim().to_ascii_lowercase();
    let Some(digits) = text.strip_prefix('#') else {
        let found = COLOURS.iter().find(|(name, _)| *name == text);
        return found.map(|(_, rgb)| *rgb);
    };
    let number = u32::from_str_radix(digits, 16).ok()?;
    match digits.len() {
        3 => Some(((number & 0xf00) << 8 | (number & 0xf0) << 4 | number & 0xf) * 0x11),
        6 | 8 => Some(number & 0xff_ffff),
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
