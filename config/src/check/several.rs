//! Several sources of one node: their names, sizes and times, and the format that follows from other nodes'.
//!
//! Owns the layout of the input of the one converter behind them; each single source is read by `source`.

use super::fields::NodeFields;
use crate::description::{PartDescription, SeveralDescription, SourceDescription};
use crate::format::Format;
use crate::limits::{NAME_BYTES_MAX, SOURCES_MAX};
use crate::problem::Problem;
use crate::source::kind::Delivery;
use crate::value::{Key, Table, Value};

impl<'a> NodeFields<'_, 'a> {
    /// A list or a named table of sources, with `trigger`, `ages` and `interval`.
    pub(super) fn several(&mut self, table: &'a Table) -> Result<SeveralDescription, Problem> {
        if table.entries.is_empty() {
            return Err(self.problem("src", "src is an empty table"));
        }
        if table.entries.len() > SOURCES_MAX {
            return Err(self.problem("src", format!("src has more than {SOURCES_MAX} sources")));
        }
        let list = table.list();
        if !list.is_empty() && list.len() != table.entries.len() {
            return Err(self.problem("src", "src mixes a list with names"));
        }
        let mut parts = self.parts(table)?;
        self.triggers(&mut parts)?;
        Ok(SeveralDescription {
            parts,
            ages: self.boolean("ages")?.unwrap_or(false),
            interval: self.boolean("interval")?.unwrap_or(false),
        })
    }

    fn parts(&mut self, table: &'a Table) -> Result<Vec<PartDescription>, Problem> {
        let sizes = self.get("input_tuple_size");
        let sizes_table = sizes.and_then(|value| self.table_of(value));
        if let (Some(value), None) = (sizes, sizes_table) {
            let reason = format!(
                "input_tuple_size of several sources is a table with a size for each, not {}",
                value.describe()
            );
            return Err(self.problem("input_tuple_size", reason));
        }
        let mut parts = Vec::new();
        for (key, value) in &table.entries {
            let name = self.part_name(key)?;
            let source = self.single(value)?;
            let given =
                sizes_table.and_then(|sizes| sizes.entries.iter().find(|(other, _)| other == key));
            let given = given
                .map(|(_, value)| self.tuple_size("input_tuple_size", value))
                .transpose()?;
            let known = self.size_of(&source)?;
            let tuple_size = match (known, given) {
                (Some(known), Some(given)) if known != given => {
                    let reason = format!(
                        "input_tuple_size of '{name}' is {given}, but the source gives tuples of {known} bytes"
                    );
                    return Err(self.problem("input_tuple_size", reason));
                }
                (Some(size), _) | (None, Some(size)) => size,
                (None, None) => {
                    return Err(self.problem(
                        "input_tuple_size",
                        format!("input_tuple_size of '{name}' is missing"),
                    ));
                }
            };
            source.check_tuple_size(tuple_size, self)?;
            parts.push(PartDescription {
                name,
                source,
                tuple_size,
                is_trigger: true,
            });
        }
        if let Some(sizes) = sizes_table {
            let stray = sizes
                .entries
                .iter()
                .find(|(key, _)| !table.entries.iter().any(|(other, _)| other == key));
            if let Some((key, _)) = stray {
                let name = self.part_name(key)?;
                return Err(self.problem(
                    "input_tuple_size",
                    format!("input_tuple_size has '{name}', but src has not"),
                ));
            }
        }
        Ok(parts)
    }

    fn part_name(&self, key: &Key) -> Result<String, Problem> {
        match key {
            Key::Text(text) => match std::str::from_utf8(text) {
                Ok(name)
                    if !name.is_empty()
                        && name.len() <= NAME_BYTES_MAX
                        && !name.chars().any(char::is_control) =>
                {
                    Ok(name.to_owned())
                }
                _ => Err(self.problem("src", "the name of a source is not a short text")),
            },
            Key::Number(number) => Ok(number.to_string()),
            Key::Other(kind) => {
                Err(self.problem("src", format!("the name of a source is a {kind}")))
            }
        }
    }

    /// `trigger = 'gyro'` or a list: the sources whose tuples make one; without it all that deliver do.
    fn triggers(&self, parts: &mut [PartDescription]) -> Result<(), Problem> {
        let Some(value) = self.get("trigger") else {
            return Ok(());
        };
        let single = [value];
        let list = self.table_of(value).map(Table::list);
        let wanted: &[&Value] = list.as_deref().unwrap_or(&single);
        if wanted.is_empty() {
            return Err(self.problem("trigger", "trigger is an empty list"));
        }
        for part in &mut *parts {
            part.is_trigger = false;
        }
        for value in wanted {
            let name = match value {
                Value::Text(text) => String::from_utf8_lossy(text).into_owned(),
                Value::Number(number) => number.to_string(),
                _ => {
                    return Err(self.wrong_type(
                        "trigger",
                        "the name of a source or a list",
                        value,
                    ));
                }
            };
            let Some(part) = parts.iter_mut().find(|part| part.name == name) else {
                let names = parts.iter().map(|part| part.name.as_str());
                let hint = crate::nearest::suggestion(&name, names);
                let shown: String = name.chars().take(64).flat_map(char::escape_debug).collect();
                return Err(self.problem(
                    "trigger",
                    format!("trigger: there is no source '{shown}'{hint}"),
                ));
            };
            if let Some(reason) = self.cannot_trigger(part) {
                return Err(self.problem("trigger", format!("trigger: {reason}")));
            }
            part.is_trigger = true;
        }
        Ok(())
    }

    /// Why the tuples of a source make none of the node, and what to do, as far as it can be known here.
    fn cannot_trigger(&self, part: &PartDescription) -> Option<String> {
        const INSTEAD: &str =
            "name a stream, or leave out trigger and let poll_ms say when to sample";
        if let Some(other) = part.source.sampled_node() {
            return Some(match self.checker.delivery_of_node(other) {
                Delivery::Stream => format!(
                    "'newest:{other}' has no events of its own; 'trikfs:{other}' delivers each tuple"
                ),
                Delivery::State => format!(
                    "'newest:{other}' has no events of its own, and '{other}' is a state, which has none either; {INSTEAD}"
                ),
                Delivery::Unknown => format!(
                    "'newest:{other}' has no events of its own; 'trikfs:{other}' has if the source of '{other}' is a stream"
                ),
            });
        }
        (self.checker.delivery(&part.source) == Delivery::State).then(|| {
            let name = &part.name;
            format!("source '{name}' is a state, which has no events of its own; {INSTEAD}")
        })
    }

    /// `input_format = 'i32 left, f32 right'`: what the converter takes several sources for. Other nodes say what they give;
    /// of what has no format only the size can be compared.
    pub(super) fn check_input_format(
        &mut self,
        source: &SourceDescription,
        size: usize,
    ) -> Result<(), Problem> {
        let Some(text) = self.text("input_format", 64 << 10)? else {
            return Ok(());
        };
        let wanted =
            Format::parse(text).map_err(|error| self.problem("input_format", error.to_string()))?;
        let kinds = |format: &Format| -> Vec<_> {
            let all = format.fields().iter();
            all.map(|field| (field.kind, field.big_endian)).collect()
        };
        let reason = match self.joined_format(source) {
            Some(given) if kinds(&given) != kinds(&wanted) => {
                format!("the converter takes '{wanted}', but the sources give '{given}'")
            }
            None if wanted.size() != size => format!(
                "the converter takes '{wanted}', {} bytes, but the sources give {size}",
                wanted.size()
            ),
            _ => return Ok(()),
        };
        Err(self.problem("src", reason))
    }

    /// The format of nodes side by side without a converter: each number named after its source and itself.
    /// None if a source is no node with a format, or the names would not be unique words.
    pub(super) fn joined_format(&mut self, source: &SourceDescription) -> Option<Format> {
        let several = source.several()?;
        let mut fields = Vec::new();
        for part in &several.parts {
            let linked = part.source.linked_node();
            let other = linked.or(part.source.sampled_node())?;
            let is_numbered = part.name.bytes().all(|byte| byte.is_ascii_digit());
            let name = word(if is_numbered { other } else { &part.name });
            let format = self.checker.format_of_node(other)?;
            if format.fields().is_empty() {
                return None;
            }
            for field in format.fields() {
                let order = if field.big_endian { ">" } else { "" };
                let kind = field.kind.word();
                fields.push(if format.len() == 1 {
                    format!("{order}{kind} {name}")
                } else {
                    format!("{order}{kind} {name}_{}", field.name)
                });
            }
        }
        let ages = several.parts.iter().filter(|_| several.ages);
        for (position, part) in ages.enumerate() {
            let is_numbered = part.name.bytes().all(|byte| byte.is_ascii_digit());
            fields.push(if is_numbered {
                format!("u32 age{}_us", position + 1)
            } else {
                format!("u32 age_{}_us", word(&part.name))
            });
        }
        if several.interval {
            fields.push("u32 interval_us".to_owned());
        }
        Format::parse(&fields.join(", ")).ok()
    }
}

/// A path or name as a word of a format, with '_' for what a word cannot hold.
fn word(name: &str) -> String {
    let word: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .collect();
    if word.starts_with(|c: char| c.is_ascii_digit()) {
        format!("_{word}")
    } else {
        word
    }
}

#[cfg(test)]
mod tests;
