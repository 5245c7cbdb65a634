//! The fields of one description, with the other nodes in reach.
//!
//! Owns what a source may ask of the nodes that it names. Reading single fields is the business of `crate::fields`.

use super::Checker;
use crate::fields::Fields;
use crate::problem::Problem;
use crate::source::kind::Nodes;
use crate::value::Table;
use std::ops::Deref;

/// A description that is being read.
pub(super) struct NodeFields<'c, 'a> {
    fields: Fields<'a>,
    pub(super) checker: &'c mut Checker<'a>,
    /// Nodes that wait for this one's size.
    depth: usize,
}

impl<'c, 'a> NodeFields<'c, 'a> {
    /// The table of one description, or of what is read like one.
    pub(super) fn new(
        checker: &'c mut Checker<'a>,
        path: String,
        keys: Vec<String>,
        table: &'a Table,
        depth: usize,
    ) -> Self {
        let fields = Fields {
            values: checker.values,
            texts: checker.texts,
            search: checker.search,
            path,
            keys,
            table,
        };
        Self {
            fields,
            checker,
            depth,
        }
    }

    /// The fields, and the other nodes for their sources.
    pub(super) fn split(&mut self) -> (&Fields<'a>, Others<'_, 'a>) {
        let others = Others {
            checker: self.checker,
            depth: self.depth,
        };
        (&self.fields, others)
    }
}

impl<'a> Deref for NodeFields<'_, 'a> {
    type Target = Fields<'a>;

    fn deref(&self) -> &Fields<'a> {
        &self.fields
    }
}

/// The other nodes, for one that is being built.
pub(super) struct Others<'c, 'a> {
    checker: &'c mut Checker<'a>,
    depth: usize,
}

impl Nodes for Others<'_, '_> {
    fn tuple_size(&mut self, path: &str) -> Result<Option<usize>, Problem> {
        self.checker.size_of_node(path, self.depth)
    }

    fn driven_tuple_size(&self, path: &str) -> Result<usize, &'static str> {
        let Some(node) = self.checker.built(path) else {
            return Err("there is no such node");
        };
        let is_linked = node.source.linked_node().is_some();
        if !is_linked && !node.source.takes_writes() {
            Err("it cannot be written")
        } else if node.rest.is_none() {
            Err("it has no rest, so nothing could stop it")
        } else {
            Ok(node.written_tuple_size())
        }
    }

    fn nearest(&self, wrong: &str) -> String {
        self.checker.nearest_node(wrong)
    }
}
