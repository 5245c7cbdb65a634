//! Reading the fields of one table with their types and limits, each refusal at the field's own line.
//!
//! Owns the words of those refusals. Knows no field by name, and no other node.

use crate::limits::TUPLE_BYTES_MAX;
use crate::nearest::suggestion;
use crate::place::Place;
use crate::problem::Problem;
use crate::search::{Search, path_of};
use crate::texts::Texts;
use crate::value::{Key, Table, Value, Values};
use std::path::PathBuf;

/// The keys and one more.
pub(crate) fn extended(keys: &[String], name: &str) -> Vec<String> {
    let mut keys = keys.to_vec();
    keys.push(name.to_owned());
    keys
}

/// A table that is being read: a description, or what a constructor was given.
pub(crate) struct Fields<'a> {
    pub(crate) values: &'a Values,
    pub(crate) texts: &'a Texts,
    pub(crate) search: &'a Search,
    /// Path of the node, which begins every reason.
    pub(crate) path: String,
    /// Keys in the text that lead to the description.
    pub(crate) keys: Vec<String>,
    pub(crate) table: &'a Table,
}

impl<'a> Fields<'a> {
    /// Another table of the same description.
    pub(crate) fn inner(&self, table: &'a Table) -> Self {
        Self {
            path: self.path.clone(),
            keys: self.keys.clone(),
            table,
            ..*self
        }
    }

    /// A refusal at the line of a field.
    pub(crate) fn problem(&self, field: &str, reason: impl AsRef<str>) -> Problem {
        let place = self.place(field);
        let reason = format!("{}: {}", self.path, reason.as_ref());
        Problem::new(place.file, place.line, reason)
    }

    /// The place of a field.
    pub(crate) fn place(&self, field: &str) -> Place {
        let keys = extended(&self.keys, field);
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        self.texts.place(&keys)
    }

    /// The same refusal at the line of another field: keys inside a field's table are found by that field.
    pub(crate) fn at<T>(&self, field: &str, result: Result<T, Problem>) -> Result<T, Problem> {
        result.map_err(|problem| {
            let place = self.place(field);
            Problem::new(place.file, place.line, problem.reason)
        })
    }

    /// A refusal of a value of the wrong type.
    pub(crate) fn wrong_type(&self, field: &str, wanted: &str, value: &Value) -> Problem {
        self.problem(
            field,
            format!("{field} must be {wanted}, not {}", value.describe()),
        )
    }

    pub(crate) fn get(&self, field: &str) -> Option<&'a Value> {
        self.table.get(field)
    }

    /// The table of a value.
    pub(crate) fn table_of(&self, value: &Value) -> Option<&'a Table> {
        self.values.table(value)
    }

    /// A whole number within limits.
    pub(crate) fn whole(&self, field: &str, min: u32, max: u32) -> Result<Option<u32>, Problem> {
        self.get(field)
            .map(|value| self.whole_value(field, value, min, max))
            .transpose()
    }

    /// A value that must be a whole number within limits.
    pub(crate) fn whole_value(
        &self,
        field: &str,
        value: &Value,
        min: u32,
        max: u32,
    ) -> Result<u32, Problem> {
        let Value::Number(number) = value else {
            return Err(self.wrong_type(field, "a number", value));
        };
        if number.fract() == 0.0 && *number >= f64::from(min) && *number <= f64::from(max) {
            return Ok(*number as u32);
        }
        Err(self.problem(
            field,
            format!("{field} must be a whole number from {min} to {max}, not {number}"),
        ))
    }

    /// A size in bytes.
    pub(crate) fn tuple_size(&self, field: &str, value: &Value) -> Result<usize, Problem> {
        let max = u32::try_from(TUPLE_BYTES_MAX).unwrap_or(u32::MAX);
        let size = self.whole_value(field, value, 1, max)?;
        Ok(usize::try_from(size).unwrap_or(TUPLE_BYTES_MAX))
    }

    /// A finite number.
    pub(crate) fn finite_value(&self, field: &str, value: &Value) -> Result<f64, Problem> {
        match value {
            Value::Number(number) if number.is_finite() => Ok(*number),
            Value::Number(number) => {
                Err(self.problem(field, format!("{field} must be finite, not {number}")))
            }
            _ => Err(self.wrong_type(field, "a number", value)),
        }
    }

    pub(crate) fn boolean(&self, field: &str) -> Result<Option<bool>, Problem> {
        match self.get(field) {
            None => Ok(None),
            Some(Value::Boolean(value)) => Ok(Some(*value)),
            Some(value) => Err(self.wrong_type(field, "true or false", value)),
        }
    }

    /// A string of UTF-8 without control characters.
    pub(crate) fn text(&self, field: &str, bytes_max: usize) -> Result<Option<&'a str>, Problem> {
        match self.get(field) {
            None => Ok(None),
            Some(Value::Text(bytes)) => {
                let text = std::str::from_utf8(bytes)
                    .map_err(|_| self.problem(field, format!("{field} is not UTF-8")))?;
                if text.len() > bytes_max {
                    return Err(
                        self.problem(field, format!("{field} has more than {bytes_max} bytes"))
                    );
                }
                if text.chars().any(char::is_control) {
                    return Err(
                        self.problem(field, format!("{field} contains a control character"))
                    );
                }
                Ok(Some(text))
            }
            Some(value) => Err(self.wrong_type(field, "a string", value)),
        }
    }

    /// A path for the system: not empty, no zero byte.
    pub(crate) fn path_bytes(&self, field: &str, value: &'a Value) -> Result<&'a [u8], Problem> {
        match value {
            Value::Text(bytes) if bytes.is_empty() => {
                Err(self.problem(field, format!("{field} is empty")))
            }
            Value::Text(bytes) if bytes.contains(&0) => {
                Err(self.problem(field, format!("{field} contains a zero byte")))
            }
            Value::Text(bytes) if bytes.len() > 4095 => {
                Err(self.problem(field, format!("{field} is longer than a path can be")))
            }
            Value::Text(bytes) => Ok(bytes),
            _ => Err(self.wrong_type(field, "a path", value)),
        }
    }

    /// A path of the system, which never depends on the working directory.
    pub(crate) fn absolute(&self, field: &str, value: &'a Value) -> Result<PathBuf, Problem> {
        let path = self.path_bytes(field, value)?;
        if path.first() == Some(&b'/') {
            return Ok(path_of(path));
        }
        let shown = String::from_utf8_lossy(path);
        Err(self.problem("src", format!("the path '{shown}' must begin with a slash")))
    }

    /// The `path` of a constructor.
    pub(crate) fn own_path(&self, kind: &str) -> Result<PathBuf, Problem> {
        match self.get("path") {
            Some(value) => self.absolute("path", value),
            None => Err(self.problem("src", format!("{kind}: path is missing"))),
        }
    }

    /// One of a few words.
    pub(crate) fn choice<T: Copy>(
        &self,
        kind: &str,
        field: &str,
        known: &[(&str, T)],
    ) -> Result<Option<T>, Problem> {
        let Some(word) = self.text(field, 64)? else {
            return Ok(None);
        };
        let found = known.iter().find(|(name, _)| *name == word);
        found.map(|(_, value)| Some(*value)).ok_or_else(|| {
            let names: Vec<_> = known.iter().map(|(name, _)| format!("'{name}'")).collect();
            let hint = suggestion(word, known.iter().map(|(name, _)| *name));
            let names = names.join(", ");
            self.problem(
                "src",
                format!("{kind}: {field} is one of {names}, not '{word}'{hint}"),
            )
        })
    }

    /// Refuses keys of a table that are not known.
    pub(crate) fn only(&self, field: &str, table: &Table, known: &[&str]) -> Result<(), Problem> {
        for (key, value) in &table.entries {
            let within = if field.is_empty() {
                String::new()
            } else {
                format!("{field}: ")
            };
            match key {
                Key::Text(text) => {
                    let name = String::from_utf8_lossy(text);
                    if known.contains(&name.as_ref()) {
                        continue;
                    }
                    let shown: String =
                        name.chars().take(64).flat_map(char::escape_debug).collect();
                    let place = if field.is_empty() { &*name } else { field };
                    if field.is_empty()
                        && self
                            .table_of(value)
                            .is_some_and(|table| table.get("src").is_some())
                    {
                        let reason = format!(
                            "'{shown}' looks like a node, but this table is a node itself because it has 'src'; further files of a node stand in 'attributes'"
                        );
                        return Err(self.problem(place, reason));
                    }
                    let hint = suggestion(&name, known.iter().copied());
                    return Err(self.problem(place, format!("{within}unknown key '{shown}'{hint}")));
                }
                Key::Number(number) => {
                    let reason = format!(
                        "{within}there is an entry with the number {number}, but keys are names here"
                    );
                    return Err(self.problem(field, reason));
                }
                Key::Other(kind) => {
                    return Err(self.problem(
                        field,
                        format!("{within}a key is a {kind}, but keys are names here"),
                    ));
                }
            }
        }
        Ok(())
    }
}
