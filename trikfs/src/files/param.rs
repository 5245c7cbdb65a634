//! `params/NAME`: a number of the node's converters, to be read and changed while the node runs.
//!
//! Owns its text and the range it may be in. What a change means to open files belongs to `convert`.

use super::OpenFile;
use super::control::TextFile;
use super::ownership::Ownership;
use crate::errno::Error;
use crate::node::Node;
use crate::text;
use crate::transport::{Outcome, Transfer};
use std::sync::Arc;

/// One param of one node.
pub struct ParamFile {
    node: Arc<Node>,
    name: Arc<str>,
    text: TextFile,
}

impl ParamFile {
    /// The param of this name, which the description has.
    pub fn new(node: &Arc<Node>, name: &Arc<str>) -> Self {
        let (shown, key) = (node.clone(), name.clone());
        let make = move || {
            let value = shown.recipe.param(&key);
            value.map_or_else(String::new, |value| format!("{value}\n"))
        };
        Self {
            node: node.clone(),
            name: name.clone(),
            text: TextFile::new(make),
        }
    }
}

impl ParamFile {
    /// What was written, as a number in the range of the param.
    fn number(&self, data: &[u8]) -> Result<f64, Error> {
        let name = &self.name;
        let range = self.node.description.param_ranges.get(name.as_ref());
        let wanted = match range {
            Some((min, max)) if *min == f64::MIN => format!("a number up to {max}"),
            Some((min, max)) if *max == f64::MAX => format!("a number from {min} on"),
            Some((min, max)) => format!("a number from {min} to {max}"),
            None => "a finite number".to_owned(),
        };
        let refused = |what: &str| format!("params/{name} is {wanted}, not {what}");
        let text = match text::from_bytes(data) {
            Ok(text) => text,
            Err(Error::Invalid(what)) => {
                return Err(Error::Invalid(format!("params/{name} is {wanted}: {what}")));
            }
            Err(other) => return Err(other),
        };
        let value: f64 = text
            .parse()
            .map_err(|_| Error::Invalid(refused(&format!("'{}'", shown(text)))))?;
        let is_inside = range.is_none_or(|(min, max)| (*min..=*max).contains(&value));
        if !value.is_finite() || !is_inside {
            return Err(Error::OutOfRange(refused(&shown(text))));
        }
        Ok(value)
    }
}

/// The beginning of a text, for a line of the log.
fn shown(text: &str) -> String {
    text.chars().take(32).flat_map(char::escape_debug).collect()
}

impl OpenFile for ParamFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        self.text.read(request, out)
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let name = &self.name;
        let value = self.number(data);
        let value = value.inspect_err(|error| self.node.report(error))?;
        let inside = self.node.quarantine.enter()?;
        // It changes what writes mean.
        let _admitted = Ownership::default().admit(&self.node, request.caller)?;
        let changed = self.node.set_param(name, value);
        // The converters of other nodes may take long for their rests, and this node is not late because of that.
        drop(inside);
        self.node.engine.params_changed();
        if let Err(error) = &changed {
            self.node.engine.log.line(&format!(
                "{}: params/{name} stays as it is: {error}",
                self.node.path()
            ));
        }
        changed.map(|()| Outcome::Done(data.len()))
    }
}
