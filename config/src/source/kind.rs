//! What every kind of source says of itself, and what it may ask of the other nodes.
//!
//! Owns the questions; the answers of one kind stand in its file. Knows no kind.

use super::rest::Rest;
use crate::fields::Fields;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// A kind of source.
pub(crate) trait Kind: Sized + 'static {
    /// The words of the sandbox that make such a source; none for those that are written as a text or a table.
    const CONSTRUCTORS: &'static [Constructor<Self>];

    /// What takes the writes, and so what brings it to rest.
    const REST: Rest<Self>;

    /// Shows every path of a device or of its program, so that it can be taken below a folder. Recordings and other
    /// files of the configuration are not among them.
    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf));

    /// What must be there for it to work, the device itself first.
    fn needed_paths(&self) -> Vec<&Path>;

    /// How tuples come out of it; `nodes` tells that of the nodes that it names.
    fn delivery(&self, nodes: &dyn Fn(&str) -> Delivery) -> Delivery;

    /// Whether a node writes to it without being asked to. Kinds whose sources differ, and those that stand for another
    /// source, say more than their [`Rest`].
    fn takes_writes(&self) -> bool {
        !matches!(Self::REST, Rest::ReadOnly)
    }

    /// A read gives what was written last, so that both can be compared.
    fn keeps_what_is_written(&self) -> bool {
        false
    }

    /// False if it only takes writes.
    fn gives_tuples(&self) -> bool {
        true
    }

    /// Bytes of one tuple, if the source knows.
    fn known_tuple_size(
        &self,
        _fields: &Fields<'_>,
        _nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        Ok(None)
    }

    /// Refuses a size of tuples that the source cannot have.
    fn check_tuple_size(&self, _size: usize, _fields: &Fields<'_>) -> Result<(), Problem> {
        Ok(())
    }

    /// Paths of the nodes that it names.
    fn nodes(&self) -> Vec<&str> {
        Vec::new()
    }

    /// The node that a write to it goes to.
    fn written_node(&self) -> Option<&str> {
        None
    }

    /// The node whose tuples it hands on, each of them.
    fn linked_node(&self) -> Option<&str> {
        None
    }

    /// The node whose newest sample it hands on.
    fn sampled_node(&self) -> Option<&str> {
        None
    }

    /// Bytes of one tuple of the node that it drives, if its write converter is a control law.
    fn law_output_size(&self) -> Option<usize> {
        None
    }

    /// How the line begins that is kept for readers who come later.
    fn kept_answer(&self) -> Option<&str> {
        None
    }
}

/// A word of the sandbox: a function that gives a source.
pub(crate) struct Constructor<T> {
    /// The word.
    pub(crate) word: &'static str,
    /// The keys of its table.
    pub(crate) keys: &'static [&'static str],
    /// Reads them.
    pub(crate) read: fn(&Fields<'_>, &mut dyn Nodes) -> Result<T, Problem>,
}

/// How tuples come out of a source, as far as its description tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Delivery {
    /// By themselves.
    Stream,
    /// Whenever it is sampled.
    State,
    /// The device decides.
    Unknown,
}

/// The other nodes of a configuration, for the sources that name them.
pub(crate) trait Nodes {
    /// Bytes of one converted tuple; None if there is no such node.
    fn tuple_size(&mut self, path: &str) -> Result<Option<usize>, Problem>;

    /// Bytes of one tuple that a regulator writes to a node, or why it cannot drive it. `tuple_size` has found it.
    fn driven_tuple_size(&self, path: &str) -> Result<usize, &'static str>;

    /// The existing path that a wrong one was probably meant to be, to append to a reason.
    fn nearest(&self, wrong: &str) -> String;
}

/// Bytes of one tuple of a node that a source names.
pub(crate) fn size_of_node(
    path: &str,
    fields: &Fields<'_>,
    nodes: &mut dyn Nodes,
) -> Result<usize, Problem> {
    nodes.tuple_size(path)?.ok_or_else(|| {
        let hint = nodes.nearest(path);
        fields.problem("src", format!("there is no node '{path}'{hint}"))
    })
}
