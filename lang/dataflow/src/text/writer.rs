//! A project to its text.
//!
//! Owns what a line says and what it leaves to the reader. The words of the grammar are read in [`super::parser`].

use super::ids::{self, Counts, Inside};
use super::labels::labels;
use super::layout::{self, Graph};
use super::lexer::{coordinate, is_word, named, quoted, value};
use super::parser::{KIT, NOWHERE};
use super::resolve::{first_main, pairs};
use crate::blocks::Content;
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Project};
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

/// Characters after which properties stand in lines of their own.
const WIDE: usize = 70;

pub(super) fn write(project: &Project) -> String {
    let plans = plans(project);
    let mut writer = Writer {
        project,
        names: names(project),
        kept: Kept::new(project, &plans),
        out: String::new(),
    };
    writer.head();
    for (diagram, plan) in project.diagrams.iter().zip(&plans) {
        writer.diagram(diagram, plan);
    }
    writer.out
}

/// Names of diagrams by the logical ids that calls have: of those that nothing else is called.
fn names(project: &Project) -> HashMap<&str, &str> {
    let mut counts = Counts::new();
    for diagram in &project.diagrams {
        counts.next(diagram.name.as_str());
    }
    let mut names = HashMap::new();
    for diagram in &project.diagrams {
        if counts.of(diagram.name.as_str()) == 1 {
            names
                .entry(diagram.logical.as_str())
                .or_insert(diagram.name.as_str());
        }
    }
    names
}

/// What a reader would make of one diagram.
struct Plan {
    id: String,
    labels: Vec<String>,
    /// Ids of blocks.
    blocks: Vec<String>,
    edges: Vec<String>,
    /// Whether blocks stand where a reader would place them.
    is_placed: bool,
}

fn plans(project: &Project) -> Vec<Plan> {
    let mut counts = Counts::new();
    let mut plans = Vec::with_capacity(project.diagrams.len());
    for diagram in &project.diagrams {
        let count = counts.next((diagram.kind as u8, diagram.name.as_str()));
        let inside = Inside::new(&diagram.id);
        let labels = labels(diagram, &inside);
        let blocks = diagram.blocks.iter().zip(&labels);
        let blocks = blocks.map(|(block, label)| inside.block(&block.element, label));
        let blocks = blocks.collect();
        let mut edges = Vec::with_capacity(diagram.edges.len());
        let mut edge_counts = Counts::new();
        for edge in &diagram.edges {
            let ends = [edge.from, edge.to]
                .map(|end| end.and_then(|end| Some((labels.get(end.block)?.as_str(), end.port))));
            edges.push(inside.edge(ends, edge_counts.next(ends)));
        }
        plans.push(Plan {
            id: ids::diagram(diagram.kind, &diagram.name, count),
            blocks,
            edges,
            is_placed: is_placed(diagram),
            labels,
        });
    }
    plans
}

fn is_placed(diagram: &Diagram) -> bool {
    let rows: Vec<_> = diagram.blocks.iter().map(|block| block.row).collect();
    let mut edges = pairs(&diagram.edges);
    edges.retain(|&(from, to)| from < rows.len() && to < rows.len());
    let graph = Graph {
        rows: &rows,
        edges: &edges,
    };
    let places = layout::places(&graph);
    let bits = |(x, y): (f64, f64)| (x.to_bits(), y.to_bits());
    let mut all = diagram.blocks.iter().zip(places);
    all.all(|(block, place)| bits(block.position) == bits(place))
}

/// How often ids are there, and how often a reader would make them.
struct Kept<'a> {
    ids: Counts<&'a str>,
    made: Counts<String>,
    /// Graphical ids that are written, or left to the reader.
    seen: HashSet<&'a str>,
    /// Whether there are ids that cannot stay; then the reader makes those only.
    is_odd: bool,
}

impl<'a> Kept<'a> {
    fn new(project: &'a Project, plans: &[Plan]) -> Self {
        let mut kept = Self {
            ids: Counts::new(),
            made: Counts::new(),
            seen: HashSet::new(),
            is_odd: false,
        };
        let mut seen: HashSet<&str> = HashSet::new();
        for (diagram, plan) in project.diagrams.iter().zip(plans) {
            let blocks = diagram.blocks.iter();
            let logical = blocks.clone().map(|block| block.logical.as_str());
            let graphical = blocks.map(|block| block.id.as_str());
            let edges = diagram.edges.iter().map(|edge| edge.id.as_str());
            for id in std::iter::once(diagram.id.as_str())
                .chain(graphical)
                .chain(edges)
            {
                kept.ids.next(id);
                kept.is_odd |= !seen.insert(id) || !ids::can_be(id);
            }
            for id in std::iter::once(diagram.logical.as_str()).chain(logical) {
                kept.ids.next(id);
            }
            for id in std::iter::once(&plan.id).chain(&plan.blocks) {
                kept.made.next(id.clone());
                kept.made.next(ids::logical(id));
            }
            for id in &plan.edges {
                kept.made.next(id.clone());
            }
        }
        kept
    }

    /// Whether a reader would make an id, and nothing else could have it.
    fn is_made(&self, id: &str, made: &str) -> bool {
        !self.is_odd && id == made && self.ids.of(id) == 1 && self.made.of(made) == 1
    }

    /// What a line says of a graphical id; what cannot be one or is that of something else already is left out.
    fn graphical(&mut self, id: &'a str, made: &str) -> String {
        let is_new = self.seen.insert(id);
        match is_new && ids::can_be(id) && !self.is_made(id, made) {
            true => format!(" id {}", quoted(id)),
            false => String::new(),
        }
    }

    /// What a line says of the id of a logical object.
    fn logical(&self, id: &str, made: &str) -> String {
        let can_be = id.is_empty() || ids::can_be(id);
        match can_be && !self.is_made(id, &ids::logical(made)) {
            true => format!(" logical {}", quoted(id)),
            false => String::new(),
        }
    }
}

struct Writer<'a> {
    project: &'a Project,
    /// Names of diagrams by their logical ids, where the name leads to that one only.
    names: HashMap<&'a str, &'a str>,
    kept: Kept<'a>,
    out: String,
}

impl<'a> Writer<'a> {
    fn line(&mut self, line: &str) {
        self.out.push_str(line);
        self.out.push('\n');
    }

    /// The diagram that is run, if there is one.
    fn main(&self) -> Option<usize> {
        let count = self.project.diagrams.len();
        self.project.main.filter(|&main| main < count)
    }

    fn head(&mut self) {
        let (kit, others): (Vec<_>, Vec<_>) =
            self.project.meta.iter().partition(|(key, _)| *key == KIT);
        for (_, text) in kit {
            self.line(&format!("kit {}", value(text, false)));
        }
        for (key, text) in others {
            self.line(&format!("meta {} = {}", named(key), value(text, false)));
        }
        let usual = first_main(self.project.diagrams.iter().map(|diagram| diagram.kind));
        if self.main().is_none() && usual.is_some() {
            self.line("run nothing");
        }
    }

    fn diagram(&mut self, diagram: &'a Diagram, plan: &Plan) {
        if !self.out.is_empty() {
            self.line("");
        }
        let mut line = match diagram.kind {
            DiagramKind::Main => "diagram ",
            DiagramKind::Subprogram => "subprogram ",
        }
        .to_owned();
        line += &quoted(&diagram.name);
        let usual = first_main(self.project.diagrams.iter().map(|diagram| diagram.kind));
        let main = self.main().filter(|main| Some(*main) != usual);
        let main = main.and_then(|main| self.project.diagrams.get(main));
        if main.is_some_and(|main| std::ptr::eq(main, diagram)) {
            line += " run";
        }
        line += &self.kept.graphical(&diagram.id, &plan.id);
        line += &self.kept.logical(&diagram.logical, &plan.id);
        self.line(&line);
        for (at, block) in diagram.blocks.iter().enumerate() {
            self.block(block, plan, at);
        }
        for (at, edge) in diagram.edges.iter().enumerate() {
            self.edge(edge, diagram, plan, at);
        }
    }

    fn block(&mut self, block: &'a Block, plan: &Plan, at: usize) {
        let (label, made) = (&plan.labels[at], &plan.blocks[at]);
        let mut line = format!("  {label}: ");
        line += &match block.row {
            Some(row) => named(row.shown),
            None => format!("unknown {}", quoted(&block.element)),
        };
        line += &properties(block);
        if let Some(logical) = &block.calls {
            line += &self.called(logical);
        }
        if block.name != *label {
            let _ = write!(line, " named {}", quoted(&block.name));
        }
        if !plan.is_placed {
            let (x, y) = block.position;
            let _ = write!(line, " at {}, {}", coordinate(x), coordinate(y));
        }
        if block.row.is_some_and(|row| row.element != block.element) {
            let _ = write!(line, " element {}", quoted(&block.element));
        }
        line += &self.kept.graphical(&block.id, made);
        line += &self.kept.logical(&block.logical, made);
        self.line(&line);
    }

    fn called(&self, logical: &str) -> String {
        match self.names.get(logical) {
            Some(name) => format!(" of {}", quoted(name)),
            None => format!(" of id {}", quoted(logical)),
        }
    }

    fn edge(&mut self, edge: &'a Edge, diagram: &Diagram, plan: &Plan, at: usize) {
        let (from, to) = (end(edge.from, diagram, plan), end(edge.to, diagram, plan));
        let mut line = format!("  {from} -> {to}");
        if let Some(policy) = edge.policy {
            let _ = write!(line, " {}", policy.word());
        }
        if let Some(capacity) = edge.capacity {
            let word = if edge.policy.is_none() {
                " capacity"
            } else {
                ""
            };
            let _ = write!(line, "{word} {capacity}");
        }
        for (at, &(x, y)) in edge.path.iter().enumerate() {
            let before = if at == 0 { " via" } else { ";" };
            let _ = write!(line, "{before} {}, {}", coordinate(x), coordinate(y));
        }
        line += &self.kept.graphical(&edge.id, &plan.edges[at]);
        self.line(&line);
    }
}

fn end(end: Option<End>, diagram: &Diagram, plan: &Plan) -> String {
    let found = end.and_then(|end| Some((end, diagram.blocks.get(end.block)?)));
    let Some((end, block)) = found else {
        return NOWHERE.to_owned();
    };
    let label = &plan.labels[end.block];
    let port = usize::try_from(end.port).ok();
    let port = port.and_then(|at| block.row?.ports.get(at));
    // Only a name that leads back to this port.
    let port = port.filter(|port| {
        block.row.and_then(|row| row.port(port.name)).map(i32::from) == Some(end.port)
    });
    match port {
        Some(port) => format!("{label}.{}", port.name),
        None => format!("{label}.{}", end.port),
    }
}

/// The properties that a block says, in the order of its row; then those that it does not know.
fn properties(block: &Block) -> String {
    let mut all = Vec::with_capacity(block.properties.len());
    let known = block.row.map_or(&[][..], |row| row.properties);
    for property in known {
        if let Some(text) = block.properties.get(property.name) {
            all.push(format!(
                "{} = {}",
                property.name,
                value(text, is_code(property.content))
            ));
        }
    }
    for (name, text) in &block.properties {
        if known.iter().all(|property| property.name != name) {
            let name = match block.row.is_none() && is_word(name) {
                true => name.clone(),
                false => quoted(name),
            };
            all.push(format!("{name} = {}", value(text, false)));
        }
    }
    if all.is_empty() {
        return String::new();
    }
    let width: usize = all.iter().map(|one| one.chars().count() + 2).sum();
    match width > WIDE || all.iter().any(|one| one.contains('\n')) {
        true => format!("(\n    {},\n  )", all.join(",\n    ")),
        false => format!("({})", all.join(", ")),
    }
}

/// Whether texts of a kind are programs.
fn is_code(content: Content) -> bool {
    match content {
        Content::Expression | Content::Truth | Content::Whole | Content::Variables => true,
        Content::Evaluated
        | Content::Raw
        | Content::Constant
        | Content::Number
        | Content::Flag
        | Content::Choice(_)
        | Content::Sensor
        | Content::Port => false,
    }
}
