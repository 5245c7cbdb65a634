//! The table `trikfs` as plain data: what a configuration program left, before any check.
//!
//! Tables stand in one list and refer to each other by number, in which order they were met. Knows no field of a
//! description.

use crate::place::Place;

/// A value of a configuration.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// `true` or `false`.
    Boolean(bool),
    /// A number; may be infinite or no number at all.
    Number(f64),
    /// A string of any bytes.
    Text(Vec<u8>),
    /// A function, as a number in [`Values::functions`].
    Function(usize),
    /// A table, as a number in [`Values::tables`].
    Table(usize),
    /// Anything else, by Lua's word for its type.
    Other(&'static str),
}

impl Value {
    /// Lua's word for the type, with an article, for messages.
    pub(crate) fn describe(&self) -> &'static str {
        match self {
            Self::Boolean(_) => "a boolean",
            Self::Number(_) => "a number",
            Self::Text(_) => "a string",
            Self::Function(_) => "a function",
            Self::Table(_) => "a table",
            Self::Other(name) => name,
        }
    }
}

/// The key of a table's entry.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Key {
    /// A string of any bytes.
    Text(Vec<u8>),
    /// A number.
    Number(f64),
    /// Anything else, by Lua's word for its type.
    Other(&'static str),
}

/// One table: its entries in an order that does not depend on Lua's hashing.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Table {
    /// Numbers first, then texts, each in order; unique.
    pub(crate) entries: Vec<(Key, Value)>,
}

impl Table {
    /// The value of a text key.
    pub(crate) fn get(&self, name: &str) -> Option<&Value> {
        let found = self
            .entries
            .iter()
            .find(|(key, _)| matches!(key, Key::Text(text) if text == name.as_bytes()));
        found.map(|(_, value)| value)
    }

    /// The values of the keys 1, 2, 3 ... up to the first gap.
    pub(crate) fn list(&self) -> Vec<&Value> {
        let mut list = Vec::new();
        for (key, value) in &self.entries {
            match key {
                Key::Number(number) if *number == (list.len() + 1) as f64 => list.push(value),
                _ => {}
            }
        }
        list
    }

    /// Sorts the entries.
    pub(crate) fn settle(&mut self) {
        self.entries.sort_by(|(a, _), (b, _)| match (a, b) {
            (Key::Number(a), Key::Number(b)) => a.total_cmp(b),
            (Key::Text(a), Key::Text(b)) => a.cmp(b),
            (a, b) => a.rank().cmp(&b.rank()),
        });
    }
}

impl Key {
    fn rank(&self) -> u8 {
        match self {
            Self::Number(_) => 0,
            Self::Text(_) => 1,
            Self::Other(_) => 2,
        }
    }
}

/// What is known of a function.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Function {
    /// Chunk name and line of its definition; line 0 for one that was not written in the configuration.
    pub(crate) place: Place,
    /// Written in Lua; only such functions can be converters.
    pub(crate) lua: bool,
    /// Digest of its code, its upvalues and the globals that it names.
    pub(crate) digest: u128,
}

/// Everything that the program left.
#[derive(Clone, Debug, Default)]
pub(crate) struct Values {
    /// The global `trikfs`; None if there is none.
    pub(crate) root: Option<Value>,
    /// The global `setup`; None if there is none.
    pub(crate) setup: Option<Value>,
    /// All tables.
    pub(crate) tables: Vec<Table>,
    /// All functions.
    pub(crate) functions: Vec<Function>,
}

impl Values {
    /// The table of a value.
    pub(crate) fn table(&self, value: &Value) -> Option<&Table> {
        match value {
            Value::Table(number) => self.tables.get(*number),
            _ => None,
        }
    }
}
