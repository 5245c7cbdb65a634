//! A save to a data-flow project: diagrams of this language, their blocks, and edges between ports.
//!
//! Owns which objects belong to the language, former names and former numbers of ports. Knows neither containers nor XML,
//! which `lang_diagram` has read, nor what a block does.

use crate::blocks::{self, Former, Row};
use crate::limits;
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Policy, Project, main_named};
use crate::words;
use lang_diagram::objects::{self, Kind, Object, Objects};
use lang_diagram::read::{Meta, Save};
use lang_text::problem::{Problem, Severity, Words, keep};
use std::collections::{HashMap, HashSet};

/// Element of a main diagram.
pub const MAIN: &str = "RobotsBehaviourDiagram";
/// Element of a subprogram.
pub const SUBPROGRAM: &str = "RobotsBehaviourSubprogram";
/// Element of the one kind of edges.
pub const EDGE: &str = "Edge";
/// Our property of an edge: what its queue does when it is full.
pub const POLICY: &str = "Policy";
/// Our property of an edge: how many tokens wait at its end.
pub const CAPACITY: &str = "Capacity";

/// Which language of a save is run: that of the first main diagram that its root lists.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Language {
    /// Diagrams of control flow, or no diagram at all.
    Diagram,
    /// This one.
    Dataflow,
}

/// Which language of a save is run.
pub fn language(save: &Save) -> Language {
    let mut diagrams = diagrams(save);
    match diagrams.find(|(_, kind)| *kind == DiagramKind::Main) {
        Some((object, _)) if object.element() == MAIN => Language::Dataflow,
        _ => Language::Diagram,
    }
}

/// Has another main diagram of a save run, of either language, by its name.
///
/// # Errors
/// Why there is none. Nothing is changed then.
pub fn choose(save: &mut Save, name: &str) -> Result<(), Words> {
    let objects = save.objects();
    let all: Vec<_> = diagrams(save)
        .map(|(object, kind)| (object, name_of(objects, object), kind))
        .collect();
    let at = main_named(name, all.iter().map(|(_, name, kind)| (*name, *kind)))?;
    let id = all[at].0.id.clone();
    save.put_first(&id);
    Ok(())
}

/// Diagrams of either language in the order of the root.
fn diagrams(save: &Save) -> impl Iterator<Item = (&Object, DiagramKind)> {
    let objects = save.objects();
    let children = objects.get(objects::ROOT).map(|root| &root.children);
    let listed = children.into_iter().flatten();
    let listed = listed.filter_map(|id| objects.get(id));
    listed
        .filter(|object| object.is_graphical())
        .filter_map(|object| {
            let kind = match object.element() {
                MAIN | "RobotsDiagramNode" => DiagramKind::Main,
                SUBPROGRAM | "SubprogramDiagram" => DiagramKind::Subprogram,
                _ => return None,
            };
            Some((object, kind))
        })
}

/// The shown name of a diagram.
fn name_of<'a>(objects: &'a Objects, object: &'a Object) -> &'a str {
    let logical = object.logical.as_deref().and_then(|id| objects.get(id));
    logical
        .and_then(|logical| logical.property("name"))
        .or_else(|| object.property("name"))
        .unwrap_or_default()
}

/// The data-flow project of a save, with what is strange about it.
pub fn project(save: &Save) -> (Project, Vec<Problem>) {
    let mut problems = Vec::new();
    let mut reader = Reader {
        objects: save.objects(),
        problems: &mut problems,
        reached: HashSet::new(),
        former: HashSet::new(),
    };
    let diagrams = reader.diagrams();
    let Meta { keys, world, .. } = save.meta();
    let is_main = |diagram: &Diagram| diagram.kind == DiagramKind::Main;
    let project = Project {
        main: diagrams.iter().position(is_main),
        diagrams,
        meta: keys.clone(),
        world: world.clone(),
    };
    (project, problems)
}

struct Reader<'a> {
    objects: &'a Objects,
    problems: &'a mut Vec<Problem>,
    /// Graphical objects that are in a diagram, and diagrams.
    reached: HashSet<&'a str>,
    /// Former names that were told already.
    former: HashSet<(&'static str, &'static str)>,
}

/// How the ports of a block are numbered in this save.
type Numbering = Option<&'static Former>;

impl<'a> Reader<'a> {
    fn diagrams(&mut self) -> Vec<Diagram> {
        let objects = self.objects;
        let Some(root) = objects.get(objects::ROOT) else {
            return Vec::new();
        };
        let mut diagrams = Vec::new();
        for id in &root.children {
            let Some(object) = objects.get(id).filter(|object| object.is_graphical()) else {
                continue;
            };
            let kind = match object.element() {
                MAIN => DiagramKind::Main,
                SUBPROGRAM => DiagramKind::Subprogram,
                _ => continue,
            };
            if self.reached.insert(&object.id) {
                diagrams.push(self.diagram(object, kind));
            }
        }
        diagrams
    }

    fn diagram(&mut self, object: &'a Object, kind: DiagramKind) -> Diagram {
        let name = name_of(self.objects, object);
        let (listed, edges) = self.children(object, name);
        let mut numbering = Vec::with_capacity(listed.len());
        let mut blocks = Vec::with_capacity(listed.len());
        for one in &listed {
            let (block, former) = self.block(one, name);
            blocks.push(block);
            numbering.push(former);
        }
        let places: HashMap<&str, usize> = listed
            .iter()
            .enumerate()
            .map(|(at, one)| (one.id.as_str(), at))
            .collect();
        let mut waiting: HashMap<&str, &'a Object> =
            edges.iter().map(|edge| (edge.id.as_str(), *edge)).collect();
        // In the order in which the blocks where they begin list them: tokens are delivered so.
        let mut ordered = Vec::with_capacity(edges.len());
        for one in &listed {
            for id in one.list("links") {
                let begins = waiting
                    .get(id.as_str())
                    .is_some_and(|edge| edge.property("from") == Some(one.id.as_str()));
                if begins && let Some(edge) = waiting.remove(id.as_str()) {
                    ordered.push(edge);
                }
            }
        }
        let rest = edges
            .iter()
            .filter(|edge| waiting.contains_key(edge.id.as_str()));
        ordered.extend(rest.copied());
        let edges = ordered
            .into_iter()
            .map(|edge| self.edge(edge, name, &places, &blocks, &numbering))
            .collect();
        Diagram {
            id: object.id.clone(),
            logical: object.logical.clone().unwrap_or_default(),
            kind,
            name: name.to_owned(),
            blocks,
            edges,
        }
    }

    /// Blocks and edges that a diagram lists.
    fn children(&mut self, object: &'a Object, name: &str) -> (Vec<&'a Object>, Vec<&'a Object>) {
        let (mut blocks, mut edges) = (Vec::new(), Vec::new());
        for id in &object.children {
            let Some(child) = self.objects.get(id) else {
                let mut problem = Problem::warning(words::lost_child(objects::element(id)));
                problem.place.diagram = Some(name.to_owned());
                problem.place.object = Some(id.clone());
                keep(self.problems, problem);
                continue;
            };
            if !child.is_graphical() {
                self.warn(child, name, words::not_graphical());
            } else if !self.reached.insert(&child.id) {
                self.warn(child, name, words::listed_twice());
            } else if child.element() == EDGE {
                edges.push(child);
            } else {
                blocks.push(child);
            }
        }
        (blocks, edges)
    }

    fn logical(&self, object: &'a Object) -> Option<&'a Object> {
        self.objects.get(object.logical.as_deref()?)
    }

    fn row(&mut self, object: &Object, diagram: &str) -> (Option<&'static Row>, Numbering) {
        let element = object.element();
        if let Some(row) = blocks::find(element) {
            return (Some(row), None);
        }
        let logical = self.logical(object);
        let shape = logical.and_then(|logical| logical.property(blocks::SHAPE));
        let Some((row, former)) = blocks::find_former(element, shape) else {
            return (None, None);
        };
        if self.former.insert((former.element, former.now)) {
            let words = words::former_name(element, row.element);
            self.report(object, diagram, Severity::Note, words);
        }
        (Some(row), Some(former))
    }

    fn block(&mut self, object: &'a Object, diagram: &str) -> (Block, Numbering) {
        let (row, former) = self.row(object, diagram);
        let mut block = Block {
            id: object.id.clone(),
            logical: object.logical.clone().unwrap_or_default(),
            row,
            element: object.element().to_owned(),
            name: object.property("name").unwrap_or_default().to_owned(),
            properties: Default::default(),
            position: points(object, "position")
                .first()
                .copied()
                .unwrap_or_default(),
            calls: None,
        };
        let Some(logical) = self.logical(object) else {
            // With its defaults it would drive, which nobody has said.
            self.report(object, diagram, Severity::Error, words::no_logical());
            return (block, former);
        };
        if let Some(name) = logical.property("name") {
            name.clone_into(&mut block.name);
        }
        for property in &logical.properties {
            let is_plain = !matches!(property.kind, Kind::Id | Kind::Shape(_));
            if is_plain && !["name", "linkShape"].contains(&&*property.key) {
                let (key, value) = (property.key.clone(), property.value.clone());
                block.properties.insert(key, value);
            }
        }
        let calls = logical.property("outgoingExplosion");
        block.calls = calls.filter(|id| objects::is_object(id)).map(str::to_owned);
        (block, former)
    }

    fn edge(
        &mut self,
        object: &'a Object,
        diagram: &str,
        places_of: &HashMap<&str, usize>,
        blocks: &[Block],
        numbering: &[Numbering],
    ) -> Edge {
        let ends = [("from", "fromPort"), ("to", "toPort")].into_iter();
        let mut lost = ends.filter_map(|(key, port)| {
            let block = *places_of.get(object.property(key)?)?;
            let number = number(object.property(port).unwrap_or_default());
            gone(blocks[block].row, numbering[block], number)
        });
        let end = |key, port| {
            let id = object.property(key).filter(|id| objects::is_object(id))?;
            let block = *places_of.get(id)?;
            let number = number(object.property(port).unwrap_or_default());
            let port = present(blocks[block].row, numbering[block], number);
            (port != DETACHED).then_some(End { block, port })
        };
        let (x, y) = points(object, "position")
            .first()
            .copied()
            .unwrap_or_default();
        let path = points(object, "configuration");
        let logical = self.logical(object);
        let text = |key| logical.and_then(|logical| logical.property(key));
        let policy = text(POLICY).and_then(Policy::of);
        let places = text(CAPACITY).and_then(|text| text.trim().parse().ok());
        let capacity =
            places.filter(|places| (1..=limits::QUEUE_MAX).contains(&usize::from(*places)));
        let edge = Edge {
            id: object.id.clone(),
            from: end("from", "fromPort"),
            to: end("to", "toPort"),
            policy,
            capacity,
            path: path
                .iter()
                .map(|corner| (corner.0 + x, corner.1 + y))
                .collect(),
            gone: lost.next(),
        };
        if let Some(word) = text(POLICY).filter(|_| policy.is_none()) {
            self.warn(object, diagram, words::unknown_policy(word));
        }
        if let Some(word) = text(CAPACITY).filter(|_| capacity.is_none()) {
            self.warn(object, diagram, words::unknown_capacity(word));
        }
        edge
    }

    fn warn(&mut self, object: &Object, diagram: &str, words: Words) {
        self.report(object, diagram, Severity::Warning, words);
    }

    fn report(&mut self, object: &Object, diagram: &str, severity: Severity, words: Words) {
        let name = object.property("name").unwrap_or_default();
        let mut problem = Problem::warning(words);
        problem.severity = severity;
        problem.place.diagram = Some(diagram.to_owned());
        problem.place.object = Some(object.id.clone());
        problem.place.block = Some(match name {
            "" => object.element().to_owned(),
            name => format!("{name} ({})", object.element()),
        });
        keep(self.problems, problem);
    }
}

/// The number that an unattached end has.
const DETACHED: i32 = -1;

/// The number of a port as a save writes it: rounded, halves away from zero; what is no number is at no port.
fn number(text: &str) -> i32 {
    let number: f64 = text.trim().parse().unwrap_or(f64::NAN);
    // From floats as cast: too large becomes the largest, not-a-number becomes 0, which would be a port.
    if number.is_nan() {
        DETACHED
    } else {
        number.round() as i32
    }
}

/// The present number of a port that may have been numbered otherwise.
fn present(row: Option<&'static Row>, former: Numbering, number: i32) -> i32 {
    let Some(names) = former.and_then(|former| former.ports) else {
        return number;
    };
    let name = usize::try_from(number).ok().and_then(|at| names.get(at));
    match (name, row) {
        (Some(name), Some(row)) => row.port(name).map_or(DETACHED, i32::from),
        // A number beyond the former ports must stay out of the present ones.
        _ if number == DETACHED => DETACHED,
        _ => i32::MAX,
    }
}

/// A former port that the block has no more, by its name.
fn gone(
    row: Option<&'static Row>,
    former: Numbering,
    number: i32,
) -> Option<(&'static str, &'static Row)> {
    let (row, names) = (row?, former?.ports?);
    let name = *names.get(usize::try_from(number).ok()?)?;
    row.port(name).is_none().then_some((name, row))
}

/// Points of a property, `x, y : x, y : `; what is no finite number is left out.
fn points(object: &Object, key: &str) -> Vec<(f64, f64)> {
    let text = object.property(key).unwrap_or_default();
    let finite = |text: &str| {
        let value: f64 = text.trim().parse().ok()?;
        value.is_finite().then_some(value)
    };
    text.split(':')
        .filter_map(|point| {
            let (x, y) = point.split_once(',')?;
            Some((finite(x)?, finite(y)?))
        })
        .collect()
}

#[cfg(test)]
mod tests;
