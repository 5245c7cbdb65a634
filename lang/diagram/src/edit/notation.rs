//! What an editor has to know of the language that is drawn: names of its objects, its blocks, and where their ports are.
//!
//! Owns the question, and the answer for diagrams of control flow, whose links have no ports: they are at a side of a block.
//! Data flow answers in its own crate.

use super::piece::{self, Piece};
use crate::blocks;
use crate::objects::Object;
use crate::read::{VERSION, VERSION_KEY};
use crate::save::Save;
use lang_text::problem::{Locale, Words};
use std::fmt::Debug;

/// What the objects of a language are called in a save.
#[derive(Debug)]
pub struct Elements {
    /// A main diagram.
    pub main: &'static str,
    /// A subprogram.
    pub subprogram: &'static str,
    /// A link.
    pub link: &'static str,
    /// A block that calls a subprogram.
    pub call: &'static str,
    /// What ids begin with after `qrm:/`: the editor and its kind of diagrams.
    pub path: &'static str,
    /// The key of the version in a new save, with its value.
    pub version: (&'static str, &'static str),
    /// What is written at a link.
    pub at_link: &'static [&'static str],
    /// Whether subprograms have parameters with names.
    pub has_parameters: bool,
}

/// What is known of a type of blocks.
#[derive(Clone, Debug)]
pub struct Known {
    /// The name that the editor shows.
    pub shown: &'static str,
    /// Width and height of a new one, in px.
    pub size: (f64, f64),
    /// Names of its properties, with their texts in a new one.
    pub properties: Vec<(&'static str, &'static str)>,
}

/// Which way a port goes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Heading {
    /// Links end there.
    In,
    /// Links begin there.
    Out,
}

/// A port of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port {
    /// Its number in the save, which of blocks of old versions is another one than its place in the list; -1: they have none.
    pub number: i32,
    /// Its place on the block, in px from the upper left corner.
    pub at: (f64, f64),
    /// Which way it goes.
    pub heading: Heading,
}

/// A language that can be drawn. Blocks are told by their type, and by what is written in them where there are some.
pub trait Notation: Debug + Sync {
    /// What its objects are called.
    fn elements(&self) -> &'static Elements;
    /// A type of its blocks, also of an old version; nothing if it has none of this name.
    fn known(&self, kind: &str, written: Option<&Object>) -> Option<Known>;
    /// Whether blocks of types that nobody knows can be put into a diagram: those of other kits.
    fn takes_unknown(&self) -> bool;
    /// The ports of a block; nothing if links of this language are at blocks and not at ports.
    fn ports(&self, kind: &str, written: Option<&Object>) -> Option<Vec<Port>>;
    /// Why a link cannot lead from an output of one block to an input of another one, by their types and places in
    /// [`Self::ports`].
    fn refuses(&self, from: (&str, u8), to: (&str, u8)) -> Option<Words>;
    /// Blocks with these ids, and the links between two of them.
    fn copy(&self, save: &Save, ids: &[String]) -> Piece;
    /// What stands in the main diagram of a new project.
    fn first(&self, locale: Locale) -> Piece;
}

/// Diagrams of control flow.
#[derive(Debug)]
pub struct ControlFlow;

const ELEMENTS: Elements = Elements {
    main: "RobotsDiagramNode",
    subprogram: "SubprogramDiagram",
    link: "ControlFlow",
    call: "Subprogram",
    path: "RobotsMetamodel/RobotsDiagram",
    version: (VERSION_KEY, VERSION),
    at_link: &["Guard"],
    has_parameters: true,
};

impl Notation for ControlFlow {
    fn elements(&self) -> &'static Elements {
        &ELEMENTS
    }

    fn known(&self, kind: &str, _written: Option<&Object>) -> Option<Known> {
        let row = blocks::find(kind)?;
        let properties = row.properties.iter();
        Some(Known {
            shown: row.shown,
            size: (super::route::SIZE, super::route::SIZE),
            properties: properties.map(|one| (one.name, one.default)).collect(),
        })
    }

    fn takes_unknown(&self) -> bool {
        true
    }

    fn ports(&self, _kind: &str, _written: Option<&Object>) -> Option<Vec<Port>> {
        None
    }

    fn refuses(&self, _from: (&str, u8), _to: (&str, u8)) -> Option<Words> {
        None
    }

    fn copy(&self, save: &Save, ids: &[String]) -> Piece {
        piece::copy(save, ids)
    }

    fn first(&self, locale: Locale) -> Piece {
        let block = |kind: &str, x: f64| piece::Drawn {
            name: blocks::find(kind)
                .map_or("", |row| row.shown_in(locale))
                .to_owned(),
            ..piece::Drawn::of(kind, (x, 200.0))
        };
        Piece {
            blocks: vec![block("InitialNode", 100.0), block("FinalNode", 400.0)],
            links: Vec::new(),
        }
    }
}
