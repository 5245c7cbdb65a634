//! The `src` of a description and the size of its tuples. Several sources stand in `several`.
//!
//! Owns what has to be said of the size; each kind of source reads itself.

use super::fields::NodeFields;
use crate::description::SourceDescription;
use crate::limits::TUPLE_BYTES_MAX;
use crate::problem::Problem;
use crate::value::Value;

impl<'a> NodeFields<'_, 'a> {
    /// Reads `src` and `input_tuple_size`, which belong together: several sources have a size each.
    pub(super) fn source(&mut self) -> Result<(SourceDescription, Option<usize>), Problem> {
        let Some(value) = self.get("src") else {
            return Err(self.problem("src", "'src' is missing"));
        };
        if let Some(table) = self.table_of(value)
            && table.get("").is_none()
        {
            let several = self.several(table)?;
            let size = several.tuple_size();
            if size > TUPLE_BYTES_MAX {
                let reason = format!(
                    "the tuples of all sources have {size} bytes, more than {TUPLE_BYTES_MAX}"
                );
                return Err(self.problem("src", reason));
            }
            return Ok((SourceDescription::Several(several), Some(size)));
        }
        if let Some(field) = ["ages", "interval", "trigger"]
            .into_iter()
            .find(|field| self.get(field).is_some())
        {
            let reason = format!("{field} is for several sources: src = {{ a = ..., b = ... }}");
            return Err(self.problem(field, reason));
        }
        let source = self.single(value)?;
        let known = self.size_of(&source)?;
        let given = match self.get("input_tuple_size") {
            None => None,
            Some(value) => Some(self.tuple_size("input_tuple_size", value)?),
        };
        if let (Some(known), Some(given)) = (known, given)
            && known != given
        {
            let reason = format!(
                "input_tuple_size is {given}, but the source gives tuples of {known} bytes"
            );
            return Err(self.problem("input_tuple_size", reason));
        }
        let size = given.or(known);
        if let Some(size) = size {
            source.check_tuple_size(size, self)?;
        }
        Ok((source, size))
    }

    /// One source.
    pub(super) fn single(&mut self, value: &'a Value) -> Result<SourceDescription, Problem> {
        let (fields, mut others) = self.split();
        SourceDescription::read(value, fields, &mut others)
    }

    /// Bytes of one tuple, if the source knows.
    pub(super) fn size_of(&mut self, source: &SourceDescription) -> Result<Option<usize>, Problem> {
        let (fields, mut others) = self.split();
        source.known_tuple_size(fields, &mut others)
    }
}
