//! How an editor of drawings draws this language: names of objects, blocks, ports and what fits to what.
//!
//! Owns the answers to `lang_diagram::edit`, which makes the changes. All of them come from the table of blocks.

use crate::blocks::{self, Direction, Former, Row, SHAPE};
use crate::check;
use crate::project::{Block, Diagram, Project};
use crate::read::{self, CAPACITY, EDGE, MAIN, POLICY, SUBPROGRAM};
use lang_diagram::edit::notation::{Elements, Heading, Known, Notation, Port};
use lang_diagram::edit::{Drawn, Piece, Wire};
use lang_diagram::objects::Object;
use lang_diagram::read::{DATAFLOW_VERSION_KEY, Save};
use lang_text::problem::{Locale, Words};
use std::collections::HashMap;

/// This language, to be drawn.
#[derive(Debug)]
pub struct DataFlow;

/// The block that calls a subprogram.
pub const CALL: &str = "DFUserBlock";

const ELEMENTS: Elements = Elements {
    main: MAIN,
    subprogram: SUBPROGRAM,
    link: EDGE,
    call: CALL,
    path: "RobotsDataFlowMetamodel/RobotsDataFlowDiagram",
    version: (DATAFLOW_VERSION_KEY, crate::save::VERSION),
    at_link: &[POLICY, CAPACITY],
    has_parameters: false,
};

/// The row of a type of blocks, also of an old version, with how its ports were numbered then.
fn row(
    kind: &str,
    written: Option<&Object>,
) -> Option<(&'static Row, Option<&'static [&'static str]>)> {
    if let Some(row) = blocks::find(kind) {
        return Some((row, None));
    }
    let shape = written.and_then(|one| one.property(SHAPE));
    let (row, Former { ports, .. }) = blocks::find_former(kind, shape)?;
    Some((row, *ports))
}

impl Notation for DataFlow {
    fn elements(&self) -> &'static Elements {
        &ELEMENTS
    }

    fn known(&self, kind: &str, written: Option<&Object>) -> Option<Known> {
        let (row, _) = row(kind, written)?;
        let (width, height) = row.size;
        let properties = row.properties.iter();
        Some(Known {
            shown: row.shown,
            size: (width.into(), height.into()),
            properties: properties.map(|one| (one.name, one.default)).collect(),
        })
    }

    fn takes_unknown(&self) -> bool {
        false
    }

    fn ports(&self, kind: &str, written: Option<&Object>) -> Option<Vec<Port>> {
        let Some((row, former)) = row(kind, written) else {
            return Some(Vec::new());
        };
        let number = |at: usize, name: &str| match former {
            None => i32::try_from(at).ok(),
            Some(names) => {
                let at = names.iter().position(|one| *one == name);
                at.and_then(|at| i32::try_from(at).ok())
            }
        };
        let port = |(at, one): (usize, &blocks::Port)| Port {
            number: number(at, one.name).unwrap_or(-1),
            at: (one.at.0.into(), one.at.1.into()),
            heading: match one.way {
                Direction::In => Heading::In,
                Direction::Out => Heading::Out,
            },
        };
        Some(row.ports.iter().enumerate().map(port).collect())
    }

    fn refuses(&self, from: (&str, u8), to: (&str, u8)) -> Option<Words> {
        // What a type became has the ports of the present one.
        let port = |(kind, at): (&str, u8)| row(kind, None)?.0.ports.get(usize::from(at));
        check::refuses(port(from)?.of, port(to)?.of)
    }

    fn copy(&self, save: &Save, ids: &[String]) -> Piece {
        let (project, _) = read::project(save);
        let mut piece = Piece::default();
        let mut places = HashMap::new();
        let blocks = project.diagrams.iter().flat_map(|one| &one.blocks);
        let by_id: HashMap<&str, &Block> = blocks.map(|block| (&*block.id, block)).collect();
        for id in ids {
            if let Some(block) = by_id.get(&**id)
                && !places.contains_key(&*block.id)
            {
                places.insert(&*block.id, piece.blocks.len());
                piece.blocks.push(drawn(&project, block));
            }
        }
        for diagram in &project.diagrams {
            piece.links.extend(wires(diagram, &places));
        }
        piece
    }

    fn first(&self, _locale: Locale) -> Piece {
        // A block to which nothing leads starts by itself.
        Piece::default()
    }
}

fn drawn(project: &Project, block: &Block) -> Drawn {
    let callee = block.calls.as_deref().and_then(|id| project.called(id));
    Drawn {
        kind: block.element.clone(),
        name: block.name.clone(),
        properties: block.properties.clone().into_iter().collect(),
        place: block.position,
        calls: callee.map(|at| project.diagrams[at].name.clone()),
        ..Drawn::default()
    }
}

/// Links between blocks of a piece; one at a port that there is not cannot be drawn.
fn wires<'a>(
    diagram: &'a Diagram,
    places: &'a HashMap<&str, usize>,
) -> impl Iterator<Item = Wire> + 'a {
    diagram.edges.iter().filter_map(|edge| {
        let (from, to) = (edge.from?, edge.to?);
        let at = |block: usize| places.get(&*diagram.blocks[block].id).copied();
        let port = |block: usize, port: i32, way: Direction| {
            let port = u8::try_from(port).ok()?;
            let known = diagram.blocks[block].row?.ports.get(usize::from(port))?;
            (known.way == way).then_some((port, known.of))
        };
        let (out, gives) = port(from.block, from.port, Direction::Out)?;
        let (into, takes) = port(to.block, to.port, Direction::In)?;
        let policy = edge
            .policy
            .map(|one| (POLICY.to_owned(), one.word().to_owned()));
        let capacity = edge
            .capacity
            .map(|one| (CAPACITY.to_owned(), one.to_string()));
        check::refuses(gives, takes).is_none().then_some(Wire {
            from: at(from.block)?,
            to: at(to.block)?,
            guard: String::new(),
            ports: Some((out, into)),
            properties: policy.into_iter().chain(capacity).collect(),
        })
    })
}

#[cfg(test)]
mod tests;
