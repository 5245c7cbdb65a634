//! `params`: numbers for the converters, with the ranges in which they may be changed while the node runs.
//!
//! Owns their names and limits.

use crate::fields::Fields;
use crate::limits::PARAMS_MAX;
use crate::problem::Problem;
use crate::value::{Key, Value};
use std::collections::BTreeMap;

/// Params by name, and the least and the greatest value of those that have a range.
pub(super) type Params = (BTreeMap<String, f64>, BTreeMap<String, (f64, f64)>);

impl Fields<'_> {
    /// `params = { gain = 3, alpha = { 0.5, min = 0, max = 1 } }`
    pub(super) fn params(&self) -> Result<Params, Problem> {
        let mut params = BTreeMap::new();
        let mut ranges = BTreeMap::new();
        let Some(value) = self.get("params") else {
            return Ok((params, ranges));
        };
        let Some(table) = self.table_of(value) else {
            return Err(self.wrong_type("params", "a table of numbers", value));
        };
        if table.entries.len() > PARAMS_MAX {
            return Err(self.problem(
                "params",
                format!("params has more than {PARAMS_MAX} numbers"),
            ));
        }
        for (key, value) in &table.entries {
            let name = match key {
                Key::Text(text) => std::str::from_utf8(text)
                    .ok()
                    .filter(|name| is_param_name(name)),
                _ => None,
            };
            let Some(name) = name else {
                return Err(self.problem(
                    "params",
                    "the name of a param is a word of letters, digits and '_'",
                ));
            };
            let number = match self.table_of(value) {
                None => self.param(name, value)?,
                Some(_) => {
                    let (number, range) = self.ranged(name, value)?;
                    ranges.insert(name.to_owned(), range);
                    number
                }
            };
            params.insert(name.to_owned(), number);
        }
        Ok((params, ranges))
    }

    fn param(&self, name: &str, value: &Value) -> Result<f64, Problem> {
        let Value::Number(number) = value else {
            return Err(self.problem(
                "params",
                format!(
                    "params: '{name}' must be a number, not {}",
                    value.describe()
                ),
            ));
        };
        if !number.is_finite() {
            return Err(self.problem(
                "params",
                format!("params: '{name}' must be finite, not {number}"),
            ));
        }
        Ok(*number)
    }

    /// `{ 0.5, min = 0, max = 1 }`; either bound may be missing.
    fn ranged(&self, name: &str, value: &Value) -> Result<(f64, (f64, f64)), Problem> {
        let (mut number, mut min, mut max) = (None, f64::MIN, f64::MAX);
        let entries = self.table_of(value).map(|table| table.entries.iter());
        for (key, value) in entries.into_iter().flatten() {
            match key {
                Key::Text(text) if text == b"min" => {
                    min = self.param(&format!("{name}.min"), value)?
                }
                Key::Text(text) if text == b"max" => {
                    max = self.param(&format!("{name}.max"), value)?
                }
                Key::Number(at) if *at == 1.0 => number = Some(self.param(name, value)?),
                _ => {
                    let reason = format!(
                        "params: '{name}' is a number or {{ NUMBER, min = NUMBER, max = NUMBER }}"
                    );
                    return Err(self.problem("params", reason));
                }
            }
        }
        let Some(number) = number else {
            let reason =
                format!("params: '{name}' has no value: {{ VALUE, min = ..., max = ... }}");
            return Err(self.problem("params", reason));
        };
        if min > max {
            let reason = format!("params: '{name}': min, {min}, is above max, {max}");
            return Err(self.problem("params", reason));
        }
        if !(min..=max).contains(&number) {
            let reason = format!("params: '{name}' is {number}, outside of {min} to {max}");
            return Err(self.problem("params", reason));
        }
        Ok((number, (min, max)))
    }
}

fn is_param_name(name: &str) -> bool {
    !name.is_empty()
        && name.len() <= 64
        && name
            .bytes()
            .all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

#[cfg(test)]
mod tests {
    use crate::load::Loader;

    fn load(params: &str) -> Result<crate::description::NodeDescription, String> {
        let source =
            format!("trikfs = {{ x = {{ src = '/x', input_tuple_size = 1, params = {params} }} }}");
        let loaded = Loader::default().load("robot.lua", None, source.as_bytes());
        let mut nodes = loaded.map_err(|problem| problem.to_string())?.config.nodes;
        Ok(nodes.remove(0))
    }

    #[test]
    fn a_param_is_a_number_or_a_number_with_a_range() {
        let node = load("{ a = 3, b = { 0.5, min = 0, max = 1 }, c = { -2, max = 0 } }").unwrap();
        let params: Vec<_> = node.params.iter().map(|(k, v)| (k.as_str(), *v)).collect();
        assert_eq!(params, [("a", 3.0), ("b", 0.5), ("c", -2.0)]);
        let ranges: Vec<_> = node
            .param_ranges
            .iter()
            .map(|(k, v)| (k.as_str(), *v))
            .collect();
        assert_eq!(ranges, [("b", (0.0, 1.0)), ("c", (f64::MIN, 0.0))]);
    }

    #[test]
    fn wrong_params_are_refused_with_their_reason() {
        let cases = [
            (
                "{ a = {} }",
                "params: 'a' has no value: { VALUE, min = ..., max = ... }",
            ),
            (
                "{ a = { 5, min = 9, max = 1 } }",
                "params: 'a': min, 9, is above max, 1",
            ),
            (
                "{ a = { 2, max = 1 } }",
                "params: 'a' is 2, outside of -17976931348623157",
            ),
            (
                "{ a = { 1, step = 1 } }",
                "params: 'a' is a number or { NUMBER, min = NUMBER, max = NUMBER }",
            ),
            (
                "{ a = { 1, 2 } }",
                "params: 'a' is a number or { NUMBER, min = NUMBER, max = NUMBER }",
            ),
            (
                "{ a = { 1, min = 'x' } }",
                "params: 'a.min' must be a number, not a string",
            ),
            ("{ a = 1/0 }", "params: 'a' must be finite, not inf"),
            ("{ a = { 0/0 } }", "params: 'a' must be finite, not NaN"),
        ];
        for (params, expected) in cases {
            let problem = load(params).unwrap_err();
            assert!(
                problem.starts_with(&format!("robot.lua:1: x: {expected}")),
                "{params}: {problem}"
            );
        }
    }
}
