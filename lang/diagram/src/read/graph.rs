//! Objects to diagrams: what is reached from the root, and how it is wired.

use super::meta::Meta;
use super::{parameters, words};
use crate::objects::{self, Kind, Object, Objects};
use crate::project::{Block, Diagram, DiagramKind, Link, Project};
use crate::save::is_link;
use lang_text::problem::{Problem, Severity, Words, keep};
use std::collections::{HashMap, HashSet};

/// Type of the one kind of links.
const LINK: &str = "ControlFlow";

/// The project that objects describe.
pub(crate) fn project(objects: &Objects, meta: &Meta, problems: &mut Vec<Problem>) -> Project {
    let mut graph = Graph {
        objects,
        problems,
        reached: HashSet::new(),
    };
    let diagrams = graph.diagrams();
    graph.report_orphans();
    Project {
        main: (!diagrams.is_empty()).then_some(0),
        diagrams,
        meta: meta.keys.clone(),
        world: meta.world.clone(),
        blobs: meta.blobs.clone(),
        templates: meta.templates.clone(),
    }
}

struct Graph<'a> {
    objects: &'a Objects,
    problems: &'a mut Vec<Problem>,
    /// Graphical objects that are in a diagram, and diagrams.
    reached: HashSet<&'a str>,
}

impl<'a> Graph<'a> {
    fn diagrams(&mut self) -> Vec<Diagram> {
        let objects = self.objects;
        let Some(root) = objects.get(objects::ROOT) else {
            return Vec::new();
        };
        let mut diagrams = Vec::new();
        for id in &root.children {
            // Logical objects stand in this list too, and are reached through graphical ones.
            let Some(object) = objects.get(id).filter(|object| object.is_graphical()) else {
                continue;
            };
            let kind = match object.element() {
                "RobotsDiagramNode" => DiagramKind::Main,
                "SubprogramDiagram" => DiagramKind::Subprogram,
                // Diagrams of data flow stand beside these; `lang-dataflow` reads them.
                "RobotsBehaviourDiagram" | "RobotsBehaviourSubprogram" => {
                    self.pass_by(object);
                    continue;
                }
                other => {
                    self.warn(object, None, words::no_diagram(other));
                    continue;
                }
            };
            if self.reached.insert(&object.id) {
                diagrams.push(self.diagram(object, kind));
            }
        }
        diagrams
    }

    /// A diagram of another language: its blocks are no orphans.
    fn pass_by(&mut self, object: &'a Object) {
        self.reached.insert(&object.id);
        self.reached
            .extend(object.children.iter().map(String::as_str));
    }

    fn diagram(&mut self, object: &'a Object, kind: DiagramKind) -> Diagram {
        let logical = self.logical(object);
        let name = logical
            .and_then(|logical| logical.property("name"))
            .or_else(|| object.property("name"));
        let mut diagram = Diagram {
            id: object.id.clone(),
            logical: object.logical.clone().unwrap_or_default(),
            kind,
            name: name.unwrap_or_default().to_owned(),
            parameters: Vec::new(),
            blocks: Vec::new(),
            links: Vec::new(),
        };
        if logical.is_none() {
            self.warn(object, Some(&diagram.name), words::no_logical());
        }
        let labels = logical.and_then(|logical| logical.property("labels"));
        match parameters::formal(labels.unwrap_or_default()) {
            Ok(parameters) => diagram.parameters = parameters,
            Err(problem) => self.inside(object, &diagram.name, "labels", problem),
        }
        let (blocks, links) = self.children(object, &diagram.name);
        let place = |list: &[&'a Object]| -> HashMap<&'a str, usize> {
            let places = list.iter().enumerate();
            places.map(|(at, one)| (one.id.as_str(), at)).collect()
        };
        let (block_places, link_places) = (place(&blocks), place(&links));
        for object in &links {
            let link = self.link(object, &diagram.name, &block_places);
            diagram.links.push(link);
        }
        // The last block whose list had the link, in each direction: lists may name a link many times.
        let mut left = vec![usize::MAX; links.len()];
        let mut entered = left.clone();
        for (at, object) in blocks.iter().enumerate() {
            let mut block = self.block(object, &diagram.name);
            for id in object.list("links") {
                let Some(&place) = link_places.get(id.as_str()) else {
                    // The editor leaves such names behind; the interpreter does not see them either.
                    self.note(object, &diagram.name, words::lost_link());
                    continue;
                };
                let link = &diagram.links[place];
                if link.from == Some(at) && std::mem::replace(&mut left[place], at) != at {
                    block.outgoing.push(place);
                }
                if link.to == Some(at) && std::mem::replace(&mut entered[place], at) != at {
                    block.incoming.push(place);
                }
            }
            diagram.blocks.push(block);
        }
        self.report_invisible(&diagram, &links);
        diagram
    }

    /// Blocks and links that a diagram lists.
    fn children(&mut self, object: &'a Object, name: &str) -> (Vec<&'a Object>, Vec<&'a Object>) {
        let (mut blocks, mut links) = (Vec::new(), Vec::new());
        for id in &object.children {
            let Some(child) = self.objects.get(id) else {
                let element = objects::element(id);
                let words = words::lost_child(element);
                keep(
                    self.problems,
                    about_id(id, element.to_owned(), Some(name), words),
                );
                continue;
            };
            if !child.is_graphical() {
                self.warn(child, Some(name), words::not_graphical());
            } else if !self.reached.insert(&child.id) {
                self.warn(child, Some(name), words::in_two_diagrams());
            } else if child.element() == LINK {
                links.push(child);
            } else {
                blocks.push(child);
            }
        }
        (blocks, links)
    }

    fn logical(&self, object: &'a Object) -> Option<&'a Object> {
        self.objects.get(object.logical.as_deref()?)
    }

    fn block(&mut self, object: &'a Object, diagram: &str) -> Block {
        let (position, corners) = (point(object, "position"), points(object, "configuration"));
        let extent = |pick: fn(&(f64, f64)) -> f64| {
            let most = corners.iter().map(pick).fold(f64::NEG_INFINITY, f64::max);
            let least = corners.iter().map(pick).fold(f64::INFINITY, f64::min);
            (most - least).max(0.0)
        };
        let mut block = Block {
            id: object.id.clone(),
            logical: object.logical.clone().unwrap_or_default(),
            kind: object.element().to_owned(),
            name: object.property("name").unwrap_or_default().to_owned(),
            position,
            size: (extent(|corner| corner.0), extent(|corner| corner.1)),
            ..Block::default()
        };
        let Some(logical) = self.logical(object) else {
            self.warn(object, Some(diagram), words::no_logical());
            return block;
        };
        if let Some(name) = logical.property("name") {
            name.clone_into(&mut block.name);
        }
        for property in &logical.properties {
            let is_plain = !matches!(property.kind, Kind::Id | Kind::Shape(_));
            let is_wiring = ["name", "linkShape", "dynamicProperties"].contains(&&*property.key);
            if is_plain && !is_wiring {
                let (key, value) = (property.key.clone(), property.value.clone());
                block.properties.insert(key, value);
            }
        }
        let calls = logical.property("outgoingExplosion");
        block.calls = calls.filter(|id| objects::is_object(id)).map(str::to_owned);
        let arguments = logical.property("dynamicProperties");
        match parameters::actual(arguments.unwrap_or_default()) {
            Ok(arguments) => block.arguments = arguments,
            Err(problem) => self.inside(object, diagram, "dynamicProperties", problem),
        }
        block
    }

    fn link(&mut self, object: &'a Object, diagram: &str, blocks: &HashMap<&str, usize>) -> Link {
        let guard = self
            .logical(object)
            .and_then(|logical| logical.property("Guard"));
        let (x, y) = point(object, "position");
        let corners = points(object, "configuration");
        let mut end = |key| {
            let id = object.property(key).filter(|id| objects::is_object(id))?;
            let place = blocks.get(id).copied();
            if place.is_none() {
                let words = words::lost_end(objects::element(id));
                self.warn(object, Some(diagram), words);
            }
            place
        };
        Link {
            id: object.id.clone(),
            from: end("from"),
            to: end("to"),
            guard: guard.unwrap_or_default().to_owned(),
            path: corners
                .iter()
                .map(|corner| (corner.0 + x, corner.1 + y))
                .collect(),
        }
    }

    /// Links that the interpreter does not see, because a block at their end does not list them.
    fn report_invisible(&mut self, diagram: &Diagram, links: &[&'a Object]) {
        let mut seen = HashSet::new();
        for (at, block) in diagram.blocks.iter().enumerate() {
            seen.extend(block.outgoing.iter().map(|&link| (at, link, true)));
            seen.extend(block.incoming.iter().map(|&link| (at, link, false)));
        }
        for (at, link) in diagram.links.iter().enumerate() {
            let unseen =
                |end: Option<usize>, out| end.filter(|&end| !seen.contains(&(end, at, out)));
            let end = unseen(link.from, true).or_else(|| unseen(link.to, false));
            if let Some(block) = end.map(|end| &diagram.blocks[end]) {
                let words = words::invisible(&label(&block.name, &block.kind));
                self.warn(links[at], Some(&diagram.name), words);
            }
        }
    }

    /// Objects that no diagram lists: deleted in the editor, but still in the save.
    fn report_orphans(&mut self) {
        let orphans: Vec<&Object> = self
            .objects
            .iter()
            .filter(|object| object.is_graphical() && !self.reached.contains(&*object.id))
            .collect();
        let Some(first) = orphans.first() else {
            return;
        };
        let links = orphans.iter().filter(|one| is_link(one)).count();
        let words = words::orphans(orphans.len() - links, links);
        // It is about all of them, so only the id names one.
        let mut problem = Problem::warning(words);
        problem.place.object = Some(first.id.clone());
        keep(self.problems, problem);
    }

    /// Something that is wrong inside of the text of a property.
    fn inside(&mut self, object: &Object, diagram: &str, property: &str, inner: Problem) {
        let mut problem = about(object, Some(diagram), inner.words);
        problem.place.property = Some(property.to_owned());
        problem.place.position = inner.place.position;
        keep(self.problems, problem);
    }

    fn note(&mut self, object: &Object, diagram: &str, words: Words) {
        let mut problem = about(object, Some(diagram), words);
        problem.severity = Severity::Note;
        keep(self.problems, problem);
    }

    fn warn(&mut self, object: &Object, diagram: Option<&str>, words: Words) {
        keep(self.problems, about(object, diagram, words));
    }
}

/// A warning about an object.
fn about(object: &Object, diagram: Option<&str>, words: Words) -> Problem {
    let name = object.property("name").unwrap_or_default();
    about_id(&object.id, label(name, object.element()), diagram, words)
}

fn about_id(id: &str, block: String, diagram: Option<&str>, words: Words) -> Problem {
    let mut problem = Problem::warning(words);
    problem.place.diagram = diagram.map(str::to_owned);
    problem.place.object = Some(id.to_owned());
    problem.place.block = Some(block);
    problem
}

/// A block for people: its label and, if that says something else, its type.
fn label(name: &str, kind: &str) -> String {
    if name.is_empty() {
        kind.to_owned()
    } else {
        format!("{name} ({kind})")
    }
}

/// A point of a property; the origin without it.
pub(crate) fn point(object: &Object, key: &str) -> (f64, f64) {
    points(object, key).first().copied().unwrap_or_default()
}

/// Points of a property, `x, y : x, y : `; what is no finite number is left out.
pub(crate) fn points(object: &Object, key: &str) -> Vec<(f64, f64)> {
    let text = object.property(key).unwrap_or_default();
    let finite = |text: &str| {
        text.trim()
            .parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
    };
    text.split(':')
        .filter_map(|point| {
            let (x, y) = point.split_once(',')?;
            Some((finite(x)?, finite(y)?))
        })
        .collect()
}
