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
            let value = shown.recipe().param(&key);
            value.map_or_else(String::new, |value| format!("{value}\n"))
        };
        Self {
            node: node.clone(),
            name: name.clone(),
            text: TextFile::new(make),
        }
    }
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
        let text = text::from_bytes(data)?;
        let value: f64 = text
            .parse()
            .map_err(|_| Error::Invalid(format!("{name} is a number")))?;
        if !value.is_finite() {
            return Err(Error::OutOfRange(format!("{name} is a finite number")));
        }
        let range = self.node.description.param_ranges.get(name.as_ref());
        if let Some((min, max)) = range
            && !(*min..=*max).contains(&value)
        {
            return Err(Error::OutOfRange(format!("{name} is {min} to {max}")));
        }
        let _inside = self.node.enter()?;
        // It changes what writes mean.
        let _admitted = Ownership::default().admit(&self.node, request.caller)?;
        let changed = self.node.recipe().set_param(name, value);
        if let Err(error) = &changed {
            self.node.engine.log.line(&format!(
                "{}: params/{name} stays as it is: {error}",
                self.node.path()
            ));
        }
        changed.map(|()| Outcome::Done(data.len()))
    }
}
