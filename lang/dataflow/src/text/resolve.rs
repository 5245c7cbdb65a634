//! A draft to a project: labels, ports and names of diagrams are looked up, and what the text does not say is made.
//!
//! Owns what a line may leave out: captions, ids and places. Knows no grammar.

use super::draft::{
    BlockDraft, Called, DiagramDraft, EdgeDraft, EndDraft, IdsDraft, PortDraft, ProjectDraft,
};
use super::ids::{self, Counts, Inside, Taken};
use super::layout::{self, Graph};
use super::{error_at, tell, words};
use crate::limits;
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Project};
use lang_text::problem::Problem;
use std::collections::HashMap;

/// The project of a draft; with problems, there may be parts of it only.
pub(super) fn project(draft: ProjectDraft<'_>, problems: &mut Vec<Problem>) -> Project {
    let mut resolver = Resolver {
        problems,
        taken: Taken::default(),
        compared: 0,
    };
    resolver.take_all(&draft);
    let mut counts = Counts::new();
    let mut pairs = Vec::with_capacity(draft.diagrams.len());
    for diagram in &draft.diagrams {
        let wanted = ids::diagram(
            diagram.kind,
            &diagram.name,
            counts.next((diagram.kind as u8, &diagram.name)),
        );
        pairs.push(resolver.pair(&diagram.ids, wanted));
    }
    let names = Names::new(&draft, &pairs);
    let main = match draft.is_idle {
        true => None,
        false => {
            let mut all = draft.diagrams.iter();
            let chosen = all.position(|diagram| diagram.is_run);
            chosen.or_else(|| first_main(draft.diagrams.iter().map(|diagram| diagram.kind)))
        }
    };
    let mut diagrams = Vec::with_capacity(pairs.len());
    for (diagram, (id, logical)) in draft.diagrams.into_iter().zip(pairs.iter().cloned()) {
        diagrams.push(resolver.diagram(diagram, id, logical, &names));
    }
    Project {
        diagrams,
        main,
        meta: draft.meta,
        world: None,
    }
}

/// The diagram that is run if nobody says otherwise.
pub(super) fn first_main(mut kinds: impl Iterator<Item = DiagramKind>) -> Option<usize> {
    kinds.position(|kind| kind == DiagramKind::Main)
}

/// What calls name.
struct Names {
    /// The logical id of the diagram of a name; `None` if there are several.
    diagrams: HashMap<String, Option<String>>,
}

impl Names {
    fn new(draft: &ProjectDraft<'_>, pairs: &[(String, String)]) -> Self {
        let mut diagrams: HashMap<String, Option<String>> = HashMap::new();
        for (diagram, (_, logical)) in draft.diagrams.iter().zip(pairs) {
            let found = diagrams.entry(diagram.name.clone());
            found
                .and_modify(|one| *one = None)
                .or_insert_with(|| Some(logical.clone()));
        }
        Self { diagrams }
    }
}

/// How many edges there were between two ports, each by its block and its number.
type EdgeCounts = Counts<[Option<(usize, i32)>; 2]>;

struct Resolver<'a> {
    problems: &'a mut Vec<Problem>,
    taken: Taken,
    /// Names that were compared with those that are not known.
    compared: usize,
}

impl Resolver<'_> {
    /// Takes all ids that the text says, before others are made.
    fn take_all(&mut self, draft: &ProjectDraft<'_>) {
        let mut logical = Vec::new();
        for diagram in &draft.diagrams {
            let blocks = diagram.blocks.iter().map(|block| &block.ids);
            for ids in std::iter::once(&diagram.ids).chain(blocks) {
                logical.extend(&ids.logical);
            }
            let blocks = diagram.blocks.iter().map(|block| &block.ids.graphical);
            let edges = diagram.edges.iter().map(|edge| &edge.id);
            let all = std::iter::once(&diagram.ids.graphical);
            for id in all.chain(blocks).chain(edges).flatten() {
                if !self.taken.take(&id.value) {
                    tell(self.problems, error_at(id.at, words::id_twice(&id.value)));
                }
            }
        }
        // Several blocks may show one logical object.
        for id in logical {
            self.taken.take(id);
        }
    }

    /// How many of some names are compared with one that is not known.
    fn comparable(&mut self, count: usize) -> usize {
        let left = limits::NAMES_COMPARED_MAX - self.compared;
        let count = count.min(left);
        self.compared += count;
        count
    }

    /// The ids of a graphical object and its logical one.
    fn pair(&mut self, said: &IdsDraft, wanted: String) -> (String, String) {
        let logical = ids::logical(&wanted);
        let id = match &said.graphical {
            Some(id) => id.value.clone(),
            None => self.taken.make(wanted),
        };
        let logical = match &said.logical {
            Some(logical) => logical.clone(),
            None => self.taken.make(logical),
        };
        (id, logical)
    }

    fn diagram(
        &mut self,
        mut draft: DiagramDraft<'_>,
        id: String,
        logical: String,
        names: &Names,
    ) -> Diagram {
        let inside = Inside::new(&id);
        let edges = std::mem::take(&mut draft.edges);
        let edges = self.edges(edges, &draft, &inside);
        let rows: Vec<_> = draft.blocks.iter().map(|block| block.row).collect();
        let given: Vec<_> = draft.blocks.iter().map(|block| block.position).collect();
        let pairs = pairs(&edges);
        let graph = Graph {
            rows: &rows,
            edges: &pairs,
        };
        let places = match given.iter().all(Option::is_some) {
            true => given.iter().copied().flatten().collect(),
            false => layout::complete(&graph, &given),
        };
        let mut blocks = Vec::with_capacity(places.len());
        for (block, position) in draft.blocks.into_iter().zip(places) {
            blocks.push(self.block(block, position, &inside, names));
        }
        Diagram {
            id,
            logical,
            kind: draft.kind,
            name: draft.name,
            blocks,
            edges,
        }
    }

    fn block(
        &mut self,
        draft: BlockDraft<'_>,
        position: (f64, f64),
        inside: &Inside,
        names: &Names,
    ) -> Block {
        let wanted = inside.block(&draft.element, draft.label);
        let (id, logical) = self.pair(&draft.ids, wanted);
        let calls = draft.called.and_then(|called| self.called(called, names));
        Block {
            id,
            logical,
            row: draft.row,
            element: draft.element,
            name: draft.caption.unwrap_or_else(|| draft.label.to_owned()),
            properties: draft.properties,
            position,
            calls,
        }
    }

    fn called(&mut self, called: Called, names: &Names) -> Option<String> {
        let name = match called {
            Called::Logical(id) => return Some(id),
            Called::Name(name) => name,
        };
        let problem = match names.diagrams.get(&name.value) {
            Some(Some(logical)) => return Some(logical.clone()),
            Some(None) => words::several_diagrams(&name.value),
            None => {
                // In the order of their names: a map has none that is the same each time.
                let mut known: Vec<&str> = match self.comparable(names.diagrams.len()) {
                    0 => Vec::new(),
                    _ => names.diagrams.keys().map(String::as_str).collect(),
                };
                known.sort_unstable();
                words::unknown_diagram(&name.value, known)
            }
        };
        tell(self.problems, error_at(name.at, problem));
        None
    }

    fn edges(
        &mut self,
        drafts: Vec<EdgeDraft<'_>>,
        draft: &DiagramDraft<'_>,
        inside: &Inside,
    ) -> Vec<Edge> {
        let mut places: HashMap<&str, usize> = HashMap::with_capacity(draft.blocks.len());
        for (at, block) in draft.blocks.iter().enumerate() {
            if places.insert(block.label, at).is_some() {
                tell(
                    self.problems,
                    error_at(block.at, words::label_twice(block.label)),
                );
            }
        }
        let mut counts = Counts::new();
        let mut edges = Vec::with_capacity(drafts.len());
        for edge in drafts {
            let from = edge.from.and_then(|end| self.end(&end, draft, &places));
            let to = edge.to.and_then(|end| self.end(&end, draft, &places));
            edges.push(self.edge(edge, [from, to], draft, (inside, &mut counts)));
        }
        edges
    }

    fn edge(
        &mut self,
        edge: EdgeDraft<'_>,
        ends: [Option<End>; 2],
        draft: &DiagramDraft<'_>,
        (inside, counts): (&Inside, &mut EdgeCounts),
    ) -> Edge {
        let count = counts.next(ends.map(|end| end.map(|end| (end.block, end.port))));
        let id = match edge.id {
            Some(id) => id.value,
            None => {
                let said = ends.map(|end| end.map(|end| (draft.blocks[end.block].label, end.port)));
                self.taken.make(inside.edge(said, count))
            }
        };
        let [from, to] = ends;
        Edge {
            id,
            from,
            to,
            policy: edge.policy,
            capacity: edge.capacity,
            path: edge.path,
            gone: None,
        }
    }

    fn end(
        &mut self,
        end: &EndDraft<'_>,
        draft: &DiagramDraft<'_>,
        places: &HashMap<&str, usize>,
    ) -> Option<End> {
        let Some(&block) = places.get(end.label) else {
            // A block with an error is told once.
            if !draft.broken.contains(&end.label) {
                let known = draft.blocks.iter().map(|block| block.label);
                let known = known.take(self.comparable(draft.blocks.len()));
                let problem = error_at(end.at, words::unknown_label(end.label, known));
                tell(self.problems, problem);
            }
            return None;
        };
        let name = match end.port {
            PortDraft::Number(port) => return Some(End { block, port }),
            PortDraft::Name(name) => name,
        };
        let words = match draft.blocks[block].row {
            None => words::port_without_row(name),
            Some(row) => match row.port(name) {
                Some(port) => {
                    let port = i32::from(port);
                    return Some(End { block, port });
                }
                None => {
                    let ports: Vec<_> = row.ports.iter().map(|port| port.name).collect();
                    words::unknown_port(row.shown, name, &ports)
                }
            },
        };
        tell(self.problems, error_at(end.port_at, words));
        None
    }
}

/// From which block to which block edges lead.
pub(super) fn pairs(edges: &[Edge]) -> Vec<(usize, usize)> {
    let both = |edge: &Edge| Some((edge.from?.block, edge.to?.block));
    edges.iter().filter_map(both).collect()
}
