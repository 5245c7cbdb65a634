//! A project as everything after the reader sees it: diagrams, blocks, links, and what else the save carries.
//!
//! Owns plain data and look-ups. Knows neither the save's format nor the meaning of a block type.
//! A block is what the editor keeps as a pair of objects, a graphical one (place, wiring) and a logical one (properties).

use lang_text::problem::Problem;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A whole project.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// All diagrams, in the order of the save.
    pub diagrams: Vec<Diagram>,
    /// Which diagram is run: the first graphical child of the root. `None`: the save has no diagram.
    pub main: Option<usize>,
    /// Keys and values of metaInfo.xml that have no field of their own.
    pub meta: BTreeMap<String, String>,
    /// XML text of the world model.
    pub world: Option<String>,
    /// XML text of embedded images. It can be long, and copies of a project share it.
    pub blobs: Option<Arc<str>>,
    /// Templates of the checker by file name, as XML text.
    pub templates: BTreeMap<String, String>,
}

/// What a diagram is for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum DiagramKind {
    /// `RobotsDiagramNode`.
    Main,
    /// `SubprogramDiagram`.
    Subprogram,
}

/// One diagram: a graph of blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// Id of the graphical object.
    pub id: String,
    /// Id of the logical object: what a call names.
    pub logical: String,
    /// What it is for.
    pub kind: DiagramKind,
    /// Shown name; the name of a subprogram in generated code.
    pub name: String,
    /// Formal parameters, in order.
    pub parameters: Vec<Parameter>,
    /// Blocks in the order of the diagram's `children`.
    pub blocks: Vec<Block>,
    /// Links in the order of the diagram's `children`.
    pub links: Vec<Link>,
}

/// A formal parameter of a subprogram.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Parameter {
    /// Its name, which is a variable's.
    pub name: String,
    /// `int`, `float`, `bool` or `string`.
    pub kind: String,
    /// Value of a call that gives none.
    pub default: String,
}

/// One block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// Id of the graphical object.
    pub id: String,
    /// Id of the logical object.
    pub logical: String,
    /// Type, as `TrikV6EnginesForward`.
    pub kind: String,
    /// The label that the editor shows; in the language of its author.
    pub name: String,
    /// Everything that is text, number or truth in the logical object, as text.
    pub properties: BTreeMap<String, String>,
    /// Outgoing links as indices into [`Diagram::links`], in the order of the block's `links`.
    pub outgoing: Vec<usize>,
    /// Incoming links, likewise.
    pub incoming: Vec<usize>,
    /// Place on the canvas, in px.
    pub position: (f64, f64),
    /// Width and height on the canvas, in px.
    pub size: (f64, f64),
    /// Logical id of the diagram that a call runs.
    pub calls: Option<String>,
    /// Actual arguments of a call, in order.
    pub arguments: Vec<Argument>,
}

/// An actual argument of a call.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Argument {
    /// Name of the parameter.
    pub name: String,
    /// `int`, `float`, `bool` or `string`.
    pub kind: String,
    /// Text of the expression.
    pub value: String,
}

/// One link between blocks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Link {
    /// Id of the graphical object.
    pub id: String,
    /// Its guard as written.
    pub guard: String,
    /// Index of the block where it begins; `None` if it hangs loose there.
    pub from: Option<usize>,
    /// Index of the block where it ends; `None` if it hangs loose there.
    pub to: Option<usize>,
    /// Corners on the canvas, in px.
    pub path: Vec<(f64, f64)>,
}

/// A problem with the place of its block on the sheet, as `Timer (120, 40)`: there may be many of the same type. `blocks` are
/// those that it may be of, by their ids.
pub fn on_sheet<'a>(
    mut problem: Problem,
    mut blocks: impl Iterator<Item = (&'a str, (f64, f64))>,
) -> Problem {
    let object = problem.place.object.as_deref();
    let found = blocks.find(|(id, _)| object == Some(id));
    if let (Some((_, (x, y))), Some(block)) = (found, &mut problem.place.block) {
        let place = format!(" ({x:.0}, {y:.0})");
        // It may have been said already.
        if !block.ends_with(&place) {
            block.push_str(&place);
        }
    }
    problem
}

impl Project {
    /// A problem with the place of its block on the sheet, if it has one.
    pub fn on_sheet(&self, problem: Problem) -> Problem {
        let blocks = self.diagrams.iter().flat_map(|one| &one.blocks);
        on_sheet(problem, blocks.map(|block| (&*block.id, block.position)))
    }

    /// The diagram that a call names by its logical id: the first one, as the editor has it.
    pub fn called(&self, logical: &str) -> Option<usize> {
        self.diagrams
            .iter()
            .position(|diagram| diagram.logical == logical)
    }
}
