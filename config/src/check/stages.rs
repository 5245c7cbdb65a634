//! Converters of a description: functions, libraries, inline C, and chains of these.
//!
//! Owns which size each stage has when the description does not say.

use crate::description::{Place, StageDescription, StageKind};
use crate::error::Error;
use crate::fields::Fields;
use crate::limits::CHAIN_MAX;
use crate::problem::Problem;
use crate::value::{Table, Value};

/// A stage whose sizes are not known yet, and the digest of its function.
pub(super) struct StageDraft {
    pub(super) kind: StageKind,
    pub(super) place: Place,
    /// `output_tuple_size` of a chain's element.
    pub(super) output_size: Option<usize>,
    /// Of a Lua function, otherwise 0.
    pub(super) digest: u128,
}

/// Gives each stage its sizes: the first takes `input`, the last gives `output`, the others give what they say or keep
/// the size. Refuses a last stage that says something else.
pub(super) fn sized(
    drafts: Vec<StageDraft>,
    input: usize,
    output: usize,
) -> Result<Vec<StageDescription>, Error> {
    let count = drafts.len();
    let mut size = input;
    let mut stages = Vec::with_capacity(count);
    for (number, draft) in drafts.into_iter().enumerate() {
        let input_size = size;
        size = draft.output_size.unwrap_or(size);
        if number + 1 == count {
            if let Some(said) = draft.output_size
                && said != output
            {
                return Err(Error::Text(format!(
                    "the last stage gives {said} bytes, but the tuple has {output}"
                )));
            }
            size = output;
        }
        stages.push(StageDescription {
            kind: draft.kind,
            input_size,
            output_size: size,
            place: draft.place,
        });
    }
    Ok(stages)
}

impl<'a> Fields<'a> {
    /// Reads `converter` or `write_converter`; None if it is not there.
    pub(super) fn stages(&self, field: &str) -> Result<Option<Vec<StageDraft>>, Problem> {
        let Some(value) = self.get(field) else {
            return Ok(None);
        };
        let list = self
            .table_of(value)
            .map(Table::list)
            .filter(|list| !list.is_empty());
        let Some(list) = list else {
            return Ok(Some(vec![self.stage(field, value)?]));
        };
        if self
            .table_of(value)
            .is_some_and(|table| table.entries.len() != list.len())
        {
            return Err(self.problem(field, format!("{field} mixes a list with names")));
        }
        if list.len() > CHAIN_MAX {
            return Err(self.problem(field, format!("{field} has more than {CHAIN_MAX} stages")));
        }
        list.into_iter()
            .map(|value| self.stage(field, value))
            .collect::<Result<_, _>>()
            .map(Some)
    }

    /// One stage, perhaps with the size that it gives.
    fn stage(&self, field: &str, value: &'a Value) -> Result<StageDraft, Problem> {
        if let Some(table) = self.table_of(value)
            && let Some(inner) = table.get("converter")
        {
            self.only(field, table, &["converter", "output_tuple_size"])?;
            let mut draft = self.code(field, inner)?;
            if let Some(size) = table.get("output_tuple_size") {
                draft.output_size =
                    Some(self.at(field, self.tuple_size("output_tuple_size", size))?);
            }
            return Ok(draft);
        }
        self.code(field, value)
    }

    /// The code of a stage.
    fn code(&self, field: &str, value: &'a Value) -> Result<StageDraft, Problem> {
        let draft = |kind, place| StageDraft {
            kind,
            place,
            output_size: None,
            digest: 0,
        };
        match value {
            Value::Function(number) => self.function(field, *number),
            Value::Text(_) => {
                let bytes = self.path_bytes(field, value)?;
                let (path, name) = match bytes.iter().rposition(|byte| *byte == b'#') {
                    Some(at) => (&bytes[..at], Some(&bytes[at + 1..])),
                    None => (bytes, None),
                };
                self.library(field, path, name)
                    .map(|kind| draft(kind, self.place(field)))
            }
            Value::Table(_) => {
                let Some(table) = self.table_of(value) else {
                    return Err(self.wrong_type(field, CONVERTER, value));
                };
                if table.get("code").is_some() {
                    return self
                        .inline_c(field, table)
                        .map(|(kind, place)| draft(kind, place));
                }
                if table.get("library").is_none() {
                    if table.list().is_empty() {
                        let known = ["code", "library", "name", "converter", "output_tuple_size"];
                        self.only(field, table, &known)?;
                    }
                    return Err(self.problem(field, format!("{field} must be {CONVERTER}")));
                }
                self.only(field, table, &["library", "name"])?;
                let path = table
                    .get("library")
                    .map(|value| self.path_bytes(field, value))
                    .transpose()?;
                let name = table
                    .get("name")
                    .map(|value| self.at(field, self.path_bytes("name", value)))
                    .transpose()?;
                self.library(field, path.unwrap_or_default(), name)
                    .map(|kind| draft(kind, self.place(field)))
            }
            _ => Err(self.wrong_type(field, CONVERTER, value)),
        }
    }

    /// A stage whose code is a Lua function of the program's.
    fn function(&self, field: &str, number: usize) -> Result<StageDraft, Problem> {
        let known = &self.values.functions;
        let function = known.get(number).cloned().unwrap_or_default();
        if !function.lua {
            let reason =
                format!("{field} must be a function written in lua, not one of the library");
            return Err(self.problem(field, reason));
        }
        let place = self.texts.of_chunk(&function.place);
        Ok(StageDraft {
            kind: StageKind::Lua,
            place: place.unwrap_or_else(|| self.place(field)),
            output_size: None,
            digest: function.digest,
        })
    }

    fn library(&self, field: &str, path: &[u8], name: Option<&[u8]>) -> Result<StageKind, Problem> {
        let name = match name.map(std::str::from_utf8) {
            None => None,
            Some(Ok(name)) if !name.is_empty() && name.len() <= 64 => Some(name.to_owned()),
            Some(_) => {
                return Err(self.problem(
                    field,
                    "the name of a converter in a library has 1 to 64 letters",
                ));
            }
        };
        if path.is_empty() {
            return Err(self.problem(field, "the path of the library is empty"));
        }
        let path = self
            .search
            .library(path)
            .map_err(|error| self.problem(field, error.to_string()))?;
        Ok(StageKind::Library { path, name })
    }

    fn inline_c(&self, field: &str, table: &'a Table) -> Result<(StageKind, Place), Problem> {
        self.only(field, table, &["code"])?;
        let code = match table.get("code") {
            Some(Value::Text(code)) if code.contains(&0) => {
                return Err(self.problem(field, "code contains a zero byte"));
            }
            Some(Value::Text(code)) if code.iter().all(u8::is_ascii_whitespace) => {
                return Err(self.problem(field, "code is empty"));
            }
            Some(Value::Text(code)) => code,
            Some(value) => {
                return Err(self.problem(
                    field,
                    format!("code must be a string of C, not {}", value.describe()),
                ));
            }
            None => return Err(self.problem(field, "code is missing")),
        };
        let place = self
            .texts
            .of_text(code)
            .unwrap_or_else(|| self.place(field));
        let code = String::from_utf8(code.clone())
            .map_err(|_| self.problem(field, "code is not UTF-8"))?;
        Ok((StageKind::InlineC { code }, place))
    }
}

const CONVERTER: &str =
    "a function, the path of a library, a table with code or library, or a list of these";
