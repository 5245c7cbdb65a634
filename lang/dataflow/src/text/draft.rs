//! A program as its text says it, before labels and names of diagrams are looked up.
//!
//! Owns plain data. Offsets are bytes of the text.

use crate::blocks::Row;
use crate::project::{DiagramKind, Policy};
use std::collections::BTreeMap;

/// A value with where it stands.
#[derive(Clone, Debug)]
pub(super) struct Placed<T> {
    pub at: usize,
    pub value: T,
}

#[derive(Debug, Default)]
pub(super) struct ProjectDraft<'a> {
    pub meta: BTreeMap<String, String>,
    /// Whether it says that nothing is run.
    pub is_idle: bool,
    pub diagrams: Vec<DiagramDraft<'a>>,
}

/// Ids that a line says.
#[derive(Debug, Default)]
pub(super) struct IdsDraft {
    pub graphical: Option<Placed<String>>,
    pub logical: Option<String>,
}

#[derive(Debug)]
pub(super) struct DiagramDraft<'a> {
    pub at: usize,
    pub kind: DiagramKind,
    pub name: String,
    pub ids: IdsDraft,
    /// Whether it is the one that is run.
    pub is_run: bool,
    pub blocks: Vec<BlockDraft<'a>>,
    pub edges: Vec<EdgeDraft<'a>>,
    /// Labels of blocks that have errors.
    pub broken: Vec<&'a str>,
}

impl DiagramDraft<'_> {
    /// Without a name, blocks and edges.
    pub fn new(at: usize, kind: DiagramKind) -> Self {
        Self {
            at,
            kind,
            name: String::new(),
            ids: IdsDraft::default(),
            is_run: false,
            blocks: Vec::new(),
            edges: Vec::new(),
            broken: Vec::new(),
        }
    }
}

/// What a block calls.
#[derive(Debug)]
pub(super) enum Called {
    Name(Placed<String>),
    Logical(String),
}

#[derive(Debug)]
pub(super) struct BlockDraft<'a> {
    pub at: usize,
    pub label: &'a str,
    pub row: Option<&'static Row>,
    pub element: String,
    pub properties: BTreeMap<String, String>,
    /// Where the values of the properties begin.
    pub values: Vec<(String, usize)>,
    pub caption: Option<String>,
    pub position: Option<(f64, f64)>,
    pub called: Option<Called>,
    pub ids: IdsDraft,
}

/// A port as an end says it.
#[derive(Clone, Copy, Debug)]
pub(super) enum PortDraft<'a> {
    Name(&'a str),
    Number(i32),
}

#[derive(Clone, Copy, Debug)]
pub(super) struct EndDraft<'a> {
    pub at: usize,
    pub label: &'a str,
    pub port_at: usize,
    pub port: PortDraft<'a>,
}

#[derive(Debug)]
pub(super) struct EdgeDraft<'a> {
    pub from: Option<EndDraft<'a>>,
    pub to: Option<EndDraft<'a>>,
    pub policy: Option<Policy>,
    pub capacity: Option<u16>,
    pub path: Vec<(f64, f64)>,
    pub id: Option<Placed<String>>,
}
