//! `src = 'trikfs:other'`: the converted tuples of another node.
//!
//! Writing through another node has to be asked for: the node says when.

use super::kind::{Constructor, Delivery, Kind, Nodes, size_of_node};
use super::rest::Rest;
use crate::fields::Fields;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// `src = 'trikfs:motors/M1'`
#[derive(Clone, Debug, PartialEq)]
pub struct LinkDescription {
    /// Path of the other node.
    pub path: String,
}

impl From<&str> for LinkDescription {
    fn from(path: &str) -> Self {
        let path = path.to_owned();
        Self { path }
    }
}

impl Kind for LinkDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[];
    const REST: Rest<Self> = Rest::Node(|source| &source.path);

    fn delivery(&self, nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        nodes(&self.path)
    }

    fn takes_writes(&self) -> bool {
        false
    }

    fn keeps_what_is_written(&self) -> bool {
        true
    }

    fn written_node(&self) -> Option<&str> {
        Some(&self.path)
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

    fn linked_node(&self) -> Option<&str> {
        Some(&self.path)
    }
}
