//! Values of the language and how they become each other: numbers, truths, texts, lists.
//!
//! The conversions are those of TRIK Studio's variants, as its expressions show them: a text that is no number counts
//! as 0, a float becomes an integer by rounding halves up, a list is no text.

use crate::limits;
use std::rc::Rc;

/// How exactly the oddities of TRIK Studio are kept.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Compat {
    /// As the real program has it.
    #[default]
    Studio,
    /// As a user would expect; docs/user/expressions.md lists the differences.
    Fixed,
}

/// A value.
#[derive(Clone, Debug, Default)]
pub enum Value {
    /// Nothing: what a table has where nothing was written.
    #[default]
    Nil,
    /// A truth.
    Bool(bool),
    /// A whole number.
    Int(i32),
    /// Any other number.
    Float(f64),
    /// A text.
    Text(Rc<str>),
    /// A text that nobody has set: an empty one to all that reads it, and still unset to what only hands it on.
    Unset,
    /// A table: dense, from 0.
    List(Rc<List>),
}

/// The elements of a table; knows how much it holds.
#[derive(Clone, Debug, Default)]
pub struct List {
    items: Vec<Value>,
    /// Cells of all items, shared ones counted each time.
    cells: u32,
    /// 1 for a list without lists in it.
    depth: u16,
}

/// Why a list cannot be made or changed.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum ListError {
    /// An index below 0.
    Negative,
    /// More elements or cells than the limits allow.
    TooLong,
    /// More lists in lists than the limits allow.
    TooDeep,
}

impl List {
    /// A list of these elements, if the limits allow it.
    pub fn new(items: Vec<Value>) -> Result<Self, ListError> {
        let mut list = Self {
            items: Vec::new(),
            cells: 0,
            depth: 1,
        };
        if items.len() > limits::LIST_MAX {
            return Err(ListError::TooLong);
        }
        for item in &items {
            list.account(0, item)?;
        }
        list.items = items;
        Ok(list)
    }

    /// The elements.
    pub fn items(&self) -> &[Value] {
        &self.items
    }

    /// What this list weighs.
    pub fn cells(&self) -> u32 {
        self.cells
    }

    /// Counts a new item instead of `old` cells.
    fn account(&mut self, old: u32, item: &Value) -> Result<(), ListError> {
        let depth = 1 + item.depth();
        if depth > limits::LIST_DEPTH_MAX {
            return Err(ListError::TooDeep);
        }
        let cells = self.cells.saturating_sub(old).saturating_add(item.cells());
        if cells > limits::VALUE_CELLS_MAX {
            return Err(ListError::TooLong);
        }
        self.depth = self.depth.max(depth);
        self.cells = cells;
        Ok(())
    }

    /// Makes it at least `length` long.
    fn pad(&mut self, length: usize, with: &Value) -> Result<(), ListError> {
        if length > limits::LIST_MAX {
            return Err(ListError::TooLong);
        }
        while self.items.len() < length {
            self.account(0, with)?;
            self.items.push(with.clone());
        }
        Ok(())
    }

    /// Writes one element; what was missing before it becomes `with`.
    pub fn put(&mut self, index: i32, value: Value, with: &Value) -> Result<(), ListError> {
        let index = usize::try_from(index).map_err(|_| ListError::Negative)?;
        let length = index.checked_add(1).ok_or(ListError::TooLong)?;
        self.pad(length, with)?;
        let old = self.items[index].cells();
        self.account(old, &value)?;
        self.items[index] = value;
        Ok(())
    }

    /// Writes an element of a list in a list; what is no list on the way becomes one.
    pub fn put_at(&mut self, path: &[i32], value: Value) -> Result<(), ListError> {
        let Some((&first, rest)) = path.split_first() else {
            return Ok(());
        };
        if rest.is_empty() {
            return self.put(first, value, &Value::Nil);
        }
        let index = usize::try_from(first).map_err(|_| ListError::Negative)?;
        self.pad(index.checked_add(1).ok_or(ListError::TooLong)?, &Value::Nil)?;
        let old = self.items[index].cells();
        let had = std::mem::take(&mut self.items[index]).into_list();
        let mut inner = had.unwrap_or_default();
        let outcome = Rc::make_mut(&mut inner).put_at(rest, value);
        let inner = Value::List(inner);
        let counted = self.account(old, &inner);
        self.items[index] = inner;
        outcome.and(counted)
    }
}

impl Value {
    /// A text.
    pub fn text(text: impl Into<Rc<str>>) -> Self {
        Self::Text(text.into())
    }

    /// A list of whole numbers, cut at the limit.
    pub fn ints(numbers: &[i32]) -> Self {
        let items = numbers
            .iter()
            .take(limits::LIST_MAX)
            .map(|&number| Self::Int(number))
            .collect();
        Self::List(Rc::new(List::new(items).unwrap_or_default()))
    }

    /// The list, if it is one.
    pub(crate) fn list(&self) -> Option<&Rc<List>> {
        match self {
            Self::List(list) => Some(list),
            Self::Nil
            | Self::Bool(_)
            | Self::Int(_)
            | Self::Float(_)
            | Self::Text(_)
            | Self::Unset => None,
        }
    }

    /// The list, if it is one.
    pub(crate) fn into_list(self) -> Option<Rc<List>> {
        match self {
            Self::List(list) => Some(list),
            Self::Nil
            | Self::Bool(_)
            | Self::Int(_)
            | Self::Float(_)
            | Self::Text(_)
            | Self::Unset => None,
        }
    }

    /// What it weighs: 1, and what is in it.
    pub fn cells(&self) -> u32 {
        match self {
            Self::Text(text) => 1 + u32::try_from(text.len() / 16).unwrap_or(u32::MAX - 1),
            Self::List(list) => list.cells.saturating_add(1),
            Self::Nil | Self::Bool(_) | Self::Int(_) | Self::Float(_) | Self::Unset => 1,
        }
    }

    fn depth(&self) -> u16 {
        self.list().map_or(0, |list| list.depth.max(1))
    }

    /// As a number: a text that is none, and everything else that is none, is 0.
    pub fn to_float(&self) -> f64 {
        match self {
            Self::Float(number) => *number,
            Self::Int(number) => f64::from(*number),
            Self::Bool(truth) => f64::from(u8::from(*truth)),
            Self::Text(text) => number_of(text).unwrap_or(0.0),
            Self::Nil | Self::Unset | Self::List(_) => 0.0,
        }
    }

    /// As a whole number: floats are rounded with halves up, and what is above 32 bits is cut off.
    pub fn to_int(&self) -> i32 {
        match self {
            Self::Int(number) => *number,
            Self::Float(number) => round(*number),
            Self::Bool(truth) => i32::from(*truth),
            Self::Text(text) => whole_of(text).unwrap_or(0),
            Self::Nil | Self::Unset | Self::List(_) => 0,
        }
    }

    /// The same, where what is beyond 32 bits stays at the end of the range.
    pub fn to_bounded_int(&self) -> i32 {
        let wide = match self {
            // What `round_wide` does not reach is beyond any range; not-a-number is 0.
            Self::Float(number) if number.abs() >= f64::from(u32::MAX) => {
                return *number as i32;
            }
            Self::Float(number) => round_wide(*number),
            Self::Text(text) if text.len() <= limits::NUMBER_TEXT_MAX => {
                text.trim().parse::<i64>().unwrap_or(0)
            }
            Self::Nil
            | Self::Bool(_)
            | Self::Int(_)
            | Self::Text(_)
            | Self::Unset
            | Self::List(_) => i64::from(self.to_int()),
        };
        wide.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
    }

    /// As a truth, as a condition or `not` sees it: a float is rounded first; a text is false when it is empty, `0` or
    /// `false`.
    pub fn to_bool(&self) -> bool {
        match self {
            Self::Bool(truth) => *truth,
            Self::Int(number) => *number != 0,
            Self::Float(number) => round_wide(*number) != 0,
            Self::Text(text) => {
                !(text.is_empty() || &**text == "0" || text.eq_ignore_ascii_case("false"))
            }
            Self::Nil | Self::Unset | Self::List(_) => false,
        }
    }

    /// As text, as `..` joins it: nothing and lists are empty.
    pub fn to_text(&self) -> Rc<str> {
        match self {
            Self::Text(text) => text.clone(),
            Self::Bool(true) => "true".into(),
            Self::Bool(false) => "false".into(),
            Self::Int(number) => number.to_string().into(),
            Self::Float(number) => float_text(*number).into(),
            Self::Nil | Self::Unset | Self::List(_) => "".into(),
        }
    }

    /// As a text; one that nobody has set stays so.
    pub(crate) fn into_text(self) -> Self {
        match self {
            Self::Text(_) | Self::Unset => self,
            Self::Nil | Self::Bool(_) | Self::Int(_) | Self::Float(_) | Self::List(_) => {
                Self::Text(self.to_text())
            }
        }
    }

    /// As a person sees it who looks on: a table by its first eight elements, nothing as nothing.
    pub fn brief(&self) -> String {
        let Self::List(list) = self else {
            return self.to_text().to_string();
        };
        let some = list.items.iter().take(8);
        let mut texts: Vec<String> = some
            .map(|item| match item {
                Self::List(_) => "[...]".to_owned(),
                Self::Nil
                | Self::Bool(_)
                | Self::Int(_)
                | Self::Float(_)
                | Self::Text(_)
                | Self::Unset => item.to_text().to_string(),
            })
            .collect();
        if list.items.len() > texts.len() {
            texts.push("...".to_owned());
        }
        format!("[{}]", texts.join(", "))
    }

    /// As text in the list that a block asks for (ports): a single text is a list of one.
    pub fn to_texts(&self) -> Vec<Rc<str>> {
        match self {
            Self::List(list) => list.items.iter().map(Self::to_text).collect(),
            Self::Text(text) => vec![text.clone()],
            Self::Unset => vec!["".into()],
            Self::Nil | Self::Bool(_) | Self::Int(_) | Self::Float(_) => Vec::new(),
        }
    }

    /// As an evaluating Print Text shows it: numbers with at most 6 decimals and no zeros at the end.
    pub fn printed(&self) -> Rc<str> {
        let text = self.to_text();
        match number_of(&text) {
            Some(number) if number.is_finite() => six_decimals(number).into(),
            _ => text,
        }
    }

    /// Whether the language calls them equal: numbers by value, otherwise the right one is made like the left one.
    pub fn equals(&self, other: &Self) -> bool {
        use Value::{Bool, Float, Int, List, Nil, Text, Unset};
        match (self, other) {
            (Unset, other) => Self::text("").equals(other),
            (one, Unset) => one.equals(&Self::text("")),
            (Int(one), Int(two)) => one == two,
            (Bool(_) | Int(_) | Float(_), Bool(_) | Int(_) | Float(_)) => {
                self.to_float() == other.to_float()
            }
            (Text(one), Text(two)) => one == two,
            (Text(one), Bool(_) | Int(_) | Float(_)) => *one == other.to_text(),
            (Bool(one), Text(_)) => *one == other.to_bool(),
            (Int(one), Text(two)) => whole_of(two) == Some(*one),
            (Float(one), Text(two)) => number_of(two) == Some(*one),
            (List(one), List(two)) => {
                Rc::ptr_eq(one, two)
                    || one.items.len() == two.items.len()
                        && one.items.iter().zip(&two.items).all(|(a, b)| a.equals(b))
            }
            (Nil, Nil) => true,
            (Nil | List(_), _) | (_, Nil | List(_)) => false,
        }
    }
}

/// Rounds halves up, also below zero (a recorded run takes -19.5 as -19), and keeps the low 32 bits; what has no 64-bit
/// value is 0.
pub fn round(number: f64) -> i32 {
    let wide = round_wide(number);
    // The low half, as the real program's cast has it.
    wide as i32
}

fn round_wide(number: f64) -> i64 {
    if number.abs() < 9.2e18 {
        let down = number.floor();
        // Adding a half would lose it in the numbers just below one.
        (if number - down < 0.5 {
            down
        } else {
            down + 1.0
        }) as i64
    } else {
        0
    }
}

/// The number that a text is, spaces around it allowed; a text beyond `limits::NUMBER_TEXT_MAX` is none.
pub fn number_of(text: &str) -> Option<f64> {
    if text.len() > limits::NUMBER_TEXT_MAX {
        return None;
    }
    let text = text.trim();
    // Rust knows "infinity", Qt does not.
    if text.ends_with(['y', 'Y']) {
        return None;
    }
    text.parse().ok()
}

/// The whole number that a text is.
fn whole_of(text: &str) -> Option<i32> {
    if text.len() > limits::NUMBER_TEXT_MAX {
        return None;
    }
    text.trim().parse::<i64>().ok().map(|number| number as i32)
}

/// The shortest text that reads back, in the form that is shorter: with an exponent or without.
pub fn float_text(number: f64) -> String {
    if number.is_nan() {
        return "nan".into();
    }
    if number.is_infinite() {
        return if number > 0.0 { "inf" } else { "-inf" }.into();
    }
    let scientific = format!("{number:e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let digits = mantissa.bytes().filter(u8::is_ascii_digit).count() as i32;
    let point = exponent + 1;
    let mut cutoff = 6;
    if point > 0 {
        cutoff = digits + 4;
        cutoff += if point <= 10 || point <= 100 { 1 } else { 2 };
        if digits > point {
            cutoff += 1;
        }
    }
    if point != digits && (point <= -4 || point > cutoff) {
        let sign = if exponent < 0 { '-' } else { '+' };
        format!("{mantissa}e{sign}{:02}", exponent.abs())
    } else {
        format!("{number}")
    }
}

/// At most 6 decimals, no zeros after the last one that counts.
fn six_decimals(number: f64) -> String {
    let mut text = format!("{number:.6}");
    let kept = text.trim_end_matches('0').trim_end_matches('.').len();
    text.truncate(kept);
    text
}

/// The shortest text that reads back, without an exponent where that is not very long.
pub(super) fn plain_text(number: f64) -> String {
    if number.abs() < 1e15 && number.abs() >= 1e-6 || number == 0.0 {
        format!("{}", number + 0.0)
    } else {
        float_text(number)
    }
}
