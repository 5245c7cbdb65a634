//! Where in a text the objects of its project stand, so that what is wrong with them can be told by line and column.
//!
//! Owns which place a problem has: that of the value of its property, or inside of it, of the edge to its port, of its
//! object, or of its diagram.

use super::draft::DiagramDraft;
use super::parser;
use crate::project::{Block, Diagram, Project};
use lang_text::problem::{Place, Position, Problem, locate};
use std::collections::HashMap;

/// Places of the objects of a project in its text.
#[derive(Debug)]
pub struct Places<'a> {
    text: &'a str,
    /// Of diagrams, by their names; of several with one name the first one.
    diagrams: HashMap<String, usize>,
    /// Of blocks and edges, by their ids.
    objects: HashMap<String, usize>,
    /// Of values of properties, and of the first edge to each port, by the id of the block and the name that is shown.
    parts: HashMap<(String, String), usize>,
}

impl<'a> Places<'a> {
    /// Those of a project that was read from this text.
    pub fn of(text: &'a str, project: &Project) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let draft = parser::parse(text, &mut Vec::new());
        let mut places = Self {
            text,
            diagrams: HashMap::new(),
            objects: HashMap::new(),
            parts: HashMap::new(),
        };
        for (diagram, draft) in project.diagrams.iter().zip(&draft.diagrams) {
            places.add(diagram, draft);
        }
        places
    }

    fn add(&mut self, diagram: &Diagram, draft: &DiagramDraft<'_>) {
        let name = diagram.name.clone();
        self.diagrams.entry(name).or_insert(draft.at);
        for (block, draft) in diagram.blocks.iter().zip(&draft.blocks) {
            self.objects.insert(block.id.clone(), draft.at);
            for (name, at) in &draft.values {
                self.parts
                    .insert((block.id.clone(), shown(block, name)), *at);
            }
        }
        for (edge, draft) in diagram.edges.iter().zip(&draft.edges) {
            let ends = [(edge.from, &draft.from), (edge.to, &draft.to)];
            for (end, draft) in ends {
                let Some(draft) = draft else {
                    continue;
                };
                self.objects.entry(edge.id.clone()).or_insert(draft.at);
                let port = end.and_then(|end| {
                    let block = diagram.blocks.get(end.block)?;
                    let number = usize::try_from(end.port).ok()?;
                    Some((
                        block.id.clone(),
                        block.row?.ports.get(number)?.name.to_owned(),
                    ))
                });
                if let Some(port) = port {
                    self.parts.entry(port).or_insert(draft.at);
                }
            }
        }
    }

    /// Where each of these is in the text, as far as it is known.
    pub fn locate(&self, problems: &[Problem]) -> Vec<Option<Position>> {
        let offset = |problem: &Problem| {
            let mut place = Place::default();
            let at = self.offset(&problem.place);
            place.offset = at.and_then(|at| u32::try_from(at).ok());
            Problem {
                place,
                ..Problem::error(problem.words.clone())
            }
        };
        let mut all: Vec<Problem> = problems.iter().map(offset).collect();
        locate(&mut all, self.text);
        all.into_iter().map(|one| one.place.position).collect()
    }

    fn offset(&self, place: &Place) -> Option<usize> {
        let Some(object) = &place.object else {
            return self.diagrams.get(place.diagram.as_deref()?).copied();
        };
        let part = place.property.as_ref().and_then(|property| {
            let at = *self.parts.get(&(object.clone(), property.clone()))?;
            Some(self.inside(at, place.position))
        });
        part.or_else(|| self.objects.get(object).copied())
    }

    /// The place in a value that begins here; its beginning if signs of it are not written as they are.
    fn inside(&self, at: usize, position: Option<Position>) -> usize {
        let (Some(position), Some(value)) = (position, self.text.get(at..)) else {
            return at;
        };
        let Some(value) = value.strip_prefix('`') else {
            return at;
        };
        let mut start = at + 1;
        let mut lines = value.split_inclusive('\n');
        for line in lines
            .by_ref()
            .take(position.line.saturating_sub(1) as usize)
        {
            start += line.len();
        }
        let line = lines.next().unwrap_or_default();
        let before = line
            .chars()
            .take(position.column.saturating_sub(1) as usize);
        start + before.map(char::len_utf8).sum::<usize>()
    }
}

/// The name of a property that problems have.
fn shown(block: &Block, name: &str) -> String {
    let property = block.row.and_then(|row| row.property(name));
    property.map_or(name, |property| property.shown).to_owned()
}
