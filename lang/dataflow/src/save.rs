//! A data-flow project to a save that the editor of the language opens.
//!
//! Owns the pairs of objects, as the editor makes them. Knows no container: `lang_diagram` writes the files.

use crate::project::{Block, Diagram, DiagramKind, Edge, End, Project};
use crate::read::{CAPACITY, POLICY};
use lang_diagram::objects::{Kind, NOTHING, Object, Objects, ROOT};
use lang_diagram::read::{DATAFLOW_VERSION_KEY, Meta, Save};

/// The one version of the language.
pub(crate) const VERSION: &str = "1.0.0";

/// The save of a project. Objects whose ids are not new are left out: a project that was read has none. The diagram that is
/// run comes first, because in a save the first main diagram is run.
pub fn save(project: &Project) -> Save {
    let mut objects = Objects::default();
    let mut roots = Vec::new();
    let mut diagrams = project.diagrams.iter();
    let usual = diagrams.position(|one| one.kind == DiagramKind::Main);
    let moved = project.main.filter(|main| Some(*main) != usual);
    let others = (0..project.diagrams.len()).filter(|at| Some(*at) != moved);
    for diagram in moved.into_iter().chain(others) {
        let Some(diagram) = project.diagrams.get(diagram) else {
            continue;
        };
        roots.push(logical_id(&diagram.id, &diagram.logical));
        roots.push(diagram.id.clone());
    }
    add(
        &mut objects,
        Object {
            id: ROOT.to_owned(),
            parent: NOTHING.to_owned(),
            children: roots,
            ..Object::default()
        },
    );
    for diagram in &project.diagrams {
        add_diagram(&mut objects, diagram);
    }
    let mut keys = project.meta.clone();
    let version = keys.entry(DATAFLOW_VERSION_KEY.to_owned());
    version.or_insert_with(|| VERSION.to_owned());
    let meta = Meta {
        keys,
        world: project.world.clone(),
        ..Meta::default()
    };
    Save::made(objects, meta)
}

fn add(objects: &mut Objects, object: Object) {
    // The first one of an id stays.
    let _ = objects.add(object);
}

fn add_diagram(objects: &mut Objects, diagram: &Diagram) {
    let blocks = diagram.blocks.iter().map(|block| &block.id);
    let edges = diagram.edges.iter().map(|edge| &edge.id);
    let logical_id = logical_id(&diagram.id, &diagram.logical);
    let mut logical = Object {
        id: logical_id.clone(),
        parent: ROOT.to_owned(),
        ..Object::default()
    };
    logical.set(Kind::Text, "name", &diagram.name);
    let graphical = Object {
        id: diagram.id.clone(),
        parent: ROOT.to_owned(),
        logical: Some(logical_id),
        children: blocks.chain(edges).cloned().collect(),
        ..Object::default()
    };
    add(objects, logical);
    add(objects, graphical);
    for (block, links) in diagram.blocks.iter().zip(links_of(diagram)) {
        add_block(objects, diagram, block, links);
    }
    for edge in &diagram.edges {
        add_edge(objects, diagram, edge);
    }
}

/// Id of the logical object of one that may have none.
fn logical_id(id: &str, logical: &str) -> String {
    match logical {
        "" => format!("{id}-logical"),
        logical => logical.to_owned(),
    }
}

/// Ids of the edges of each block: first those that begin there.
fn links_of(diagram: &Diagram) -> Vec<Vec<String>> {
    let mut links = vec![Vec::new(); diagram.blocks.len()];
    for edge in &diagram.edges {
        if let Some(from) = edge.from {
            links[from.block].push(edge.id.clone());
        }
    }
    for edge in &diagram.edges {
        let begins = edge.from.map(|from| from.block);
        if let Some(to) = edge.to.filter(|to| Some(to.block) != begins) {
            links[to.block].push(edge.id.clone());
        }
    }
    links
}

fn add_block(objects: &mut Objects, diagram: &Diagram, block: &Block, links: Vec<String>) {
    let logical_id = logical_id(&block.id, &block.logical);
    let mut logical = Object {
        id: logical_id.clone(),
        parent: diagram.logical.clone(),
        ..Object::default()
    };
    logical.set(Kind::Text, "name", &block.name);
    for (key, value) in &block.properties {
        logical.set(Kind::Text, key, value);
    }
    if let Some(called) = &block.calls {
        logical.set(Kind::Id, "outgoingExplosion", called);
    }
    let mut graphical = Object {
        id: block.id.clone(),
        parent: diagram.id.clone(),
        logical: Some(logical_id),
        lists: vec![("links".to_owned(), links)],
        ..Object::default()
    };
    let (x, y) = block.position;
    graphical.set(Kind::Shape("QPointF"), "position", &format!("{x}, {y}"));
    let (width, height) = block.row.map_or((100, 100), |row| row.size);
    let corners = format!("0, 0 : {width}, 0 : {width}, {height} : 0, {height} : ");
    graphical.set(Kind::Shape("QPolygon"), "configuration", &corners);
    add(objects, logical);
    add(objects, graphical);
}

fn add_edge(objects: &mut Objects, diagram: &Diagram, edge: &Edge) {
    let logical_id = logical_id(&edge.id, "");
    let mut logical = Object {
        id: logical_id.clone(),
        parent: diagram.logical.clone(),
        ..Object::default()
    };
    if let Some(policy) = edge.policy {
        logical.set(Kind::Text, POLICY, policy.word());
    }
    if let Some(capacity) = edge.capacity {
        logical.set(Kind::Text, CAPACITY, &capacity.to_string());
    }
    let mut graphical = Object {
        id: edge.id.clone(),
        parent: diagram.id.clone(),
        logical: Some(logical_id),
        ..Object::default()
    };
    let mut attach = |end: Option<End>, key: &str, port: &str| {
        let (id, number) = match end {
            Some(end) => (diagram.blocks[end.block].id.as_str(), end.port),
            None => (ROOT, -1),
        };
        graphical.set(Kind::Id, key, id);
        graphical.set(Kind::Number("double"), port, &number.to_string());
    };
    attach(edge.from, "from", "fromPort");
    attach(edge.to, "to", "toPort");
    graphical.set(Kind::Shape("QPointF"), "position", "0, 0");
    let corner = |(x, y): &(f64, f64)| format!("{x}, {y} : ");
    let corners: String = edge.path.iter().map(corner).collect();
    graphical.set(Kind::Shape("QPolygon"), "configuration", &corners);
    add(objects, logical);
    add(objects, graphical);
}
