//! Programs in short, for the tests of this crate.

use crate::blocks;
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Project};

/// A diagram in short: blocks `label Shown name {property=value | property=value}` and edges `A.OUT > F.I0`, one on each
/// line.
pub(crate) fn diagram(name: &str, kind: DiagramKind, text: &str) -> Diagram {
    let mut diagram = Diagram {
        id: format!("qrm:/diagram/{name}"),
        logical: format!("qrm:/logical/{name}"),
        kind,
        name: name.to_owned(),
        blocks: Vec::new(),
        edges: Vec::new(),
    };
    let mut edges = Vec::new();
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
        if let Some((from, to)) = line.split_once(" > ").filter(|_| !line.contains('{')) {
            edges.push((from, to));
            continue;
        }
        let (label, rest) = line.split_once(' ').expect(line);
        let (shown, properties) = rest.split_once(" {").unwrap_or((rest, "}"));
        let (shown, calls) = shown.split_once(" of ").unwrap_or((shown, ""));
        let row = blocks::table().find(|row| row.shown == shown.trim());
        let row = row.unwrap_or_else(|| panic!("no block {shown}"));
        let properties = properties
            .strip_suffix('}')
            .unwrap_or(properties)
            .split(" | ");
        let pairs = properties.filter_map(|pair| pair.split_once('='));
        diagram.blocks.push(Block {
            id: format!("qrm:/{name}/{label}"),
            logical: String::new(),
            row: Some(row),
            element: row.element.to_owned(),
            name: label.to_owned(),
            properties: pairs
                .map(|(key, value)| (key.to_owned(), value.to_owned()))
                .collect(),
            position: (0.0, 0.0),
            calls: (!calls.is_empty()).then(|| format!("qrm:/logical/{calls}")),
        });
    }
    for (from, to) in edges {
        let end = |text: &str| {
            let (label, port) = text.trim().split_once('.').expect(text);
            let block = diagram.blocks.iter().position(|block| block.name == label);
            let block = block.unwrap_or_else(|| panic!("no block {label}"));
            let row = diagram.blocks[block].row.expect("a row");
            let port = row.port(port).unwrap_or_else(|| panic!("no port {text}"));
            End {
                block,
                port: i32::from(port),
            }
        };
        let edge = Edge {
            id: format!("qrm:/{name}/{from}/{to}"),
            from: Some(end(from)),
            to: Some(end(to)),
            policy: None,
            capacity: None,
            path: Vec::new(),
            gone: None,
        };
        diagram.edges.push(edge);
    }
    // As a save has them: by the block where they begin.
    diagram
        .edges
        .sort_by_key(|edge| edge.from.map(|end| end.block));
    diagram
}

pub(crate) fn project(diagrams: Vec<Diagram>) -> Project {
    Project {
        main: Some(0),
        diagrams,
        ..Project::default()
    }
}
