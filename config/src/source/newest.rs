//! `src = 'newest:other'`: the newest sample of another node, which is taken by that node alone.
//!
//! Nothing can be written this way, and it has no events of its own.

use super::kind::{Constructor, Delivery, Kind, Nodes, size_of_node};
use super::rest::Rest;
use crate::fields::Fields;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// `src = 'newest:sensors/A1'`
#[derive(Clone, Debug, PartialEq)]
pub struct NewestDescription {
    /// Path of the other node.
    pub path: String,
}

impl From<&str> for NewestDescription {
    fn from(path: &str) -> Self {
        let path = path.to_owned();
        Self { path }
    }
}

impl Kind for NewestDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[];
    const REST: Rest<Self> = Rest::ReadOnly;

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::State
    }

    fn each_path(&mut self, _take: &mut dyn FnMut(&mut PathBuf)) {}

    fn needed_paths(&self) -> Vec<&Path> {
        Vec::new()
    }

    fn known_tuple_size(
        &self,
        fields: &Fields<'_>,
        nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        size_of_node(&self.path, fields, nodes).map(Some)
    }

    fn nodes(&self) -> Vec<&str> {
        vec![&self.path]
    }

    fn sampled_node(&self) -> Option<&str> {
        Some(&self.path)
    }
}
