//! A program and its arguments, as the constructors of sensor programs take them.
//!
//! Owns what a word of a command may be. Runs nothing.

use crate::fields::Fields;
use crate::limits::{COMMAND_WORD_BYTES_MAX, COMMAND_WORDS_MAX};
use crate::problem::Problem;
use crate::value::Value;
use std::path::PathBuf;

/// A program to run, without a shell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommandDescription {
    /// The program.
    pub program: PathBuf,
    /// What follows it.
    pub arguments: Vec<String>,
}

/// Reads a program and its arguments; None if the field is not there.
pub(super) fn command(
    fields: &Fields<'_>,
    kind: &str,
    field: &str,
) -> Result<Option<CommandDescription>, Problem> {
    let Some(value) = fields.get(field) else {
        return Ok(None);
    };
    let wanted = "a list of a program and its arguments";
    let list = fields
        .table_of(value)
        .ok_or_else(|| fields.wrong_type(field, wanted, value))?;
    let words = list.list();
    let Some((program, arguments)) = words.split_first() else {
        return Err(fields.problem("src", format!("{kind}: {field} must be {wanted}")));
    };
    if words.len() != list.entries.len() {
        return Err(fields.problem("src", format!("{kind}: {field} must be {wanted}")));
    }
    if words.len() > COMMAND_WORDS_MAX {
        let reason = format!("{kind}: {field} has more than {COMMAND_WORDS_MAX} words");
        return Err(fields.problem("src", reason));
    }
    let program = fields.absolute(field, program)?;
    let mut texts = Vec::new();
    for value in arguments {
        let Value::Text(bytes) = value else {
            return Err(fields.wrong_type(field, wanted, value));
        };
        let text = std::str::from_utf8(bytes).ok().filter(|text| {
            text.len() <= COMMAND_WORD_BYTES_MAX && !text.chars().any(char::is_control)
        });
        let Some(text) = text else {
            let reason = format!(
                "{kind}: an argument of {field} is not UTF-8 of at most {COMMAND_WORD_BYTES_MAX} bytes without control characters"
            );
            return Err(fields.problem("src", reason));
        };
        texts.push(text.to_owned());
    }
    Ok(Some(CommandDescription {
        program,
        arguments: texts,
    }))
}
