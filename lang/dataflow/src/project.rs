//! A data-flow project as everything after the reader sees it: diagrams, blocks, edges.
//!
//! Owns plain data and look-ups. Knows neither the save's format nor what a block does.

use crate::blocks::Row;
use crate::words;
use lang_diagram::project::on_sheet;
use lang_text::problem::{Problem, Words};
use std::collections::{BTreeMap, HashMap};

/// A whole project.
#[derive(Clone, Debug, Default)]
pub struct Project {
    /// All diagrams of this language, in the order of the save.
    pub diagrams: Vec<Diagram>,
    /// Which diagram is run: the first main one.
    pub main: Option<usize>,
    /// Keys and values of metaInfo.xml.
    pub meta: BTreeMap<String, String>,
    /// XML text of the world model.
    pub world: Option<String>,
}

/// What a diagram is for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum DiagramKind {
    /// `RobotsBehaviourDiagram`.
    Main,
    /// `RobotsBehaviourSubprogram`.
    Subprogram,
}

/// One diagram.
#[derive(Clone, Debug)]
pub struct Diagram {
    /// Id of the graphical object.
    pub id: String,
    /// Id of the logical object: what a call names.
    pub logical: String,
    /// What it is for.
    pub kind: DiagramKind,
    /// Shown name.
    pub name: String,
    /// Blocks in the order of the diagram's `children`.
    pub blocks: Vec<Block>,
    /// Edges: by the block where they begin, in the order of its `links`; then those that begin nowhere.
    pub edges: Vec<Edge>,
}

/// One block.
#[derive(Clone, Debug)]
pub struct Block {
    /// Id of the graphical object.
    pub id: String,
    /// Id of the logical object.
    pub logical: String,
    /// Its row; `None`: nobody here knows the element.
    pub row: Option<&'static Row>,
    /// The element name as it is in the save.
    pub element: String,
    /// The caption.
    pub name: String,
    /// Properties by their names in the save; the others have their defaults.
    pub properties: BTreeMap<String, String>,
    /// Place on the canvas, in pixels.
    pub position: (f64, f64),
    /// Logical id of the diagram that a call runs.
    pub calls: Option<String>,
}

/// One end of an edge.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct End {
    /// Index of the block.
    pub block: usize,
    /// Number of the port as the save has it, rounded; -1 or too large if it is at no port.
    pub port: i32,
}

/// What a queue does when it is full.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Policy {
    /// The oldest token is dropped.
    #[default]
    Fifo,
    /// It has one place, and the newest token wins.
    Latest,
    /// The program ends with an error.
    Error,
}

impl Policy {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fifo, Self::Latest, Self::Error];

    /// Its word in the save.
    pub fn word(self) -> &'static str {
        match self {
            Self::Fifo => "fifo",
            Self::Latest => "latest",
            Self::Error => "error",
        }
    }

    /// The policy of a word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.word() == word)
    }
}

/// One edge.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Id of the graphical object.
    pub id: String,
    /// Where it begins; `None` if it hangs loose there.
    pub from: Option<End>,
    /// Where it ends; `None` if it hangs loose there.
    pub to: Option<End>,
    /// What the queue at its end does, if it says so: our property `Policy`.
    pub policy: Option<Policy>,
    /// How many tokens wait at its end at most, if it says so: our property `Capacity`.
    pub capacity: Option<u16>,
    /// Corners on the canvas, in pixels.
    pub path: Vec<(f64, f64)>,
    /// The port of an old version that a loose end was at, and its block, which has none of that name now.
    pub gone: Option<(&'static str, &'static Row)>,
}

/// Which of some diagrams is the main one of a name.
pub(crate) fn main_named<'a>(
    name: &str,
    diagrams: impl Iterator<Item = (&'a str, DiagramKind)> + Clone,
) -> Result<usize, Words> {
    let is_meant = |(one, kind): &(&str, DiagramKind)| *one == name && *kind == DiagramKind::Main;
    if diagrams.clone().filter(is_meant).count() > 1 {
        return Err(words::several_named(name));
    }
    let found = diagrams.clone().position(|one| is_meant(&one));
    found.ok_or_else(|| match diagrams.clone().any(|(one, _)| one == name) {
        true => words::runs_where_called(name),
        false => {
            let mains = diagrams.filter(|(_, kind)| *kind == DiagramKind::Main);
            words::no_main_named(name, mains.map(|(one, _)| one))
        }
    })
}

impl Project {
    /// A problem with the place of its block on the sheet, if it has one.
    pub fn on_sheet(&self, problem: Problem) -> Problem {
        let blocks = self.diagrams.iter().flat_map(|one| &one.blocks);
        on_sheet(problem, blocks.map(|block| (&*block.id, block.position)))
    }

    /// Has another main diagram run, by its name.
    ///
    /// # Errors
    /// Why there is none. Nothing is changed then.
    pub fn choose(&mut self, name: &str) -> Result<(), Words> {
        let all = self.diagrams.iter();
        let chosen = main_named(name, all.map(|one| (one.name.as_str(), one.kind)))?;
        self.main = Some(chosen);
        Ok(())
    }

    /// The diagram that a call names by its logical id: the first one, as the editor has it.
    pub fn called(&self, logical: &str) -> Option<usize> {
        let mut all = self.diagrams.iter();
        all.position(|diagram| diagram.logical == logical)
    }

    /// Diagrams by their logical ids: the first one of each, as the editor has it.
    pub(crate) fn by_logical(&self) -> HashMap<&str, usize> {
        let mut all = HashMap::new();
        for (at, diagram) in self.diagrams.iter().enumerate() {
            all.entry(diagram.logical.as_str()).or_insert(at);
        }
        all
    }

    /// Which diagrams are run if this one is: itself, those that it calls, and so on.
    pub(crate) fn reached(&self, from: usize) -> Vec<bool> {
        let all = self.by_logical();
        let mut reached = vec![false; self.diagrams.len()];
        let mut waiting = vec![from];
        while let Some(at) = waiting.pop() {
            let Some(diagram) = self.diagrams.get(at) else {
                continue;
            };
            if std::mem::replace(&mut reached[at], true) {
                continue;
            }
            let calls = diagram
                .blocks
                .iter()
                .filter_map(|block| block.calls.as_deref());
            waiting.extend(calls.filter_map(|id| all.get(id)));
        }
        reached
    }
}

impl Diagram {
    /// An edge that ends at a port of a block of this diagram, by the port's name.
    pub fn enters_port(&self, block: &Block, port: &str) -> Option<&Edge> {
        let number = i32::from(block.row?.port(port)?);
        self.edges.iter().find(|edge| {
            edge.to.is_some_and(|end| {
                end.port == number && std::ptr::eq(&self.blocks[end.block], block)
            })
        })
    }
}

impl Block {
    /// The text of a property, or its default.
    pub fn text(&self, name: &str) -> &str {
        match self.properties.get(name) {
            Some(text) => text,
            None => self
                .row
                .and_then(|row| row.property(name))
                .map_or("", |property| property.default),
        }
    }

    /// A flag: everything but nothing, `0` and `false` is true.
    pub fn flag(&self, name: &str) -> bool {
        let text = self.text(name);
        !(text.is_empty() || text == "0" || text.eq_ignore_ascii_case("false"))
    }
}
