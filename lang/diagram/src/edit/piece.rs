//! Blocks with the links between them, apart from any project: what is drawn, copied and pasted.
//!
//! Owns what of a block goes with it: everything that a person wrote, also in blocks of other kits, and the subprogram of a
//! call by its name.

use super::changes::{self, carried, diagram, parameters, sane, subprograms, written_arguments};
use super::pen::Pen;
use super::route;
use super::words;
use crate::limits;
use crate::objects::Kind;
use crate::project::{Argument, Block};
use crate::save::Save;
use lang_text::problem::Problem;
use std::collections::HashMap;

/// Blocks and links between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// Its blocks.
    pub blocks: Vec<Drawn>,
    /// Links between these.
    pub links: Vec<Wire>,
}

/// A block of a piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Its type, as `TrikV6EnginesForward`.
    pub kind: String,
    /// The name that it is saved with; empty: that of its type.
    pub name: String,
    /// What is written in it; other properties have their defaults.
    pub properties: Vec<(String, String)>,
    /// Its upper left corner, in px.
    pub place: (f64, f64),
    /// Width and height, in px; those of its type if nothing is said.
    pub size: Option<(f64, f64)>,
    /// Of a call the name of its subprogram.
    pub calls: Option<String>,
    /// What a call gives its parameters, by their names.
    pub arguments: Vec<(String, String)>,
}

impl Drawn {
    /// A new block of this type.
    pub fn of(kind: &str, place: (f64, f64)) -> Self {
        Self {
            kind: kind.to_owned(),
            place,
            ..Self::default()
        }
    }
}

/// A link of a piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wire {
    /// Which of its blocks it leaves.
    pub from: usize,
    /// Which of its blocks it enters.
    pub to: usize,
    /// Its guard.
    pub guard: String,
    /// Of a language with ports those of both ends.
    pub ports: Option<(u8, u8)>,
    /// What else is written at it.
    pub properties: Vec<(String, String)>,
}

/// Adds a piece to a diagram: ids of its blocks, then of its links.
pub(super) fn add(pen: &mut Pen<'_>, sheet: &str, piece: &Piece) -> Result<Vec<String>, Problem> {
    diagram(pen, sheet)?;
    let subprograms = subprograms(pen);
    let mut ids = Vec::new();
    for drawn in &piece.blocks {
        ids.push(draw(pen, sheet, drawn, &subprograms)?);
    }
    for wire in &piece.links {
        let (Some(from), Some(to)) = (ids.get(wire.from), ids.get(wire.to)) else {
            return Err(Problem::error(words::no_end()));
        };
        if wire.from.max(wire.to) >= piece.blocks.len() {
            return Err(Problem::error(words::no_end()));
        }
        let (from, to) = (from.clone(), to.clone());
        let link = changes::connect(pen, (&from, &to), &wire.guard, wire.ports)?;
        for (key, value) in &wire.properties {
            changes::set(pen, &link, key, value)?;
        }
        ids.push(link);
    }
    Ok(ids)
}

fn draw(
    pen: &mut Pen<'_>,
    sheet: &str,
    drawn: &Drawn,
    subprograms: &HashMap<String, String>,
) -> Result<String, Problem> {
    let is_name = |kind: &str| {
        !kind.is_empty()
            && kind.len() <= limits::EDIT_ID_SHOWN
            && kind.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
    };
    let elements = pen.notation.elements();
    let kept = [
        "ControlFlow",
        "Edge",
        "RobotsDiagramNode",
        "SubprogramDiagram",
        elements.main,
        elements.subprogram,
    ];
    if !is_name(&drawn.kind) || kept.contains(&&*drawn.kind) {
        return Err(Problem::error(words::no_kind()));
    }
    let (x, y) = sane(drawn.place)?;
    let known = pen.notation.known(&drawn.kind, None);
    if known.is_none() && !pen.notation.takes_unknown() {
        return Err(Problem::error(words::no_kind()));
    }
    carried(&drawn.name)?;
    let name = match (&*drawn.name, &known) {
        ("", Some(known)) => known.shown,
        ("", None) => &drawn.kind,
        (name, _) => name,
    };
    let id = pen.pair(&drawn.kind, sheet, name)?;
    for (key, value) in known.iter().flat_map(|known| &known.properties) {
        pen.set_logical(&id, key, value);
    }
    for (key, value) in &drawn.properties {
        carried(key)?;
        carried(value)?;
        if changes::WIRING.contains(&&**key) || key.is_empty() {
            return Err(Problem::error(words::no_property("")));
        }
        pen.set_logical(&id, key, value);
    }
    let usual = known.map_or((route::SIZE, route::SIZE), |known| known.size);
    let (width, height) = sane(drawn.size.unwrap_or(usual))?;
    let (width, height) = (width.max(1.0), height.max(1.0));
    if let Some(object) = pen.get_mut(&id) {
        let corners = format!("0, 0 : {width}, 0 : {width}, {height} : 0, {height} : ");
        object.set(Kind::Shape("QPointF"), "position", &format!("{x}, {y}"));
        object.set(Kind::Shape("QPolygon"), "configuration", &corners);
    }
    if let Some(callee) = drawn.calls.as_ref().and_then(|name| subprograms.get(name)) {
        call(pen, &id, callee, &drawn.arguments)?;
    }
    Ok(id)
}

/// Makes a block a call; parameters that get nothing get their defaults.
pub(super) fn call(
    pen: &mut Pen<'_>,
    id: &str,
    callee: &str,
    given: &[(String, String)],
) -> Result<(), Problem> {
    let Some(logical) = pen.get(callee) else {
        return Ok(());
    };
    let name = logical.property("name").unwrap_or_default().to_owned();
    let mut arguments = Vec::new();
    for parameter in parameters(logical) {
        let value = given.iter().find(|(name, _)| *name == parameter.name);
        let value = value.map_or(&parameter.default, |(_, value)| value);
        carried(value)?;
        arguments.push(Argument {
            value: value.clone(),
            name: parameter.name,
            kind: parameter.kind,
        });
    }
    pen.rename(id, &name);
    pen.set_logical_id(id, "outgoingExplosion", callee);
    // Also what another subprogram was given before.
    let had = pen
        .logical(id)
        .is_some_and(|one| one.property("dynamicProperties").is_some());
    if had || !arguments.is_empty() {
        pen.set_logical(id, "dynamicProperties", &written_arguments(&arguments));
    }
    let caller = pen.get(id).and_then(|one| one.logical.clone());
    if let (Some(callee), Some(caller)) = (pen.get_mut(callee), caller) {
        callee.list_mut("incomingExplosions").push(caller);
    }
    Ok(())
}

/// Blocks with these ids, and the links between two of them.
pub(super) fn copy(save: &Save, ids: &[String]) -> Piece {
    let (project, _) = save.project();
    let blocks = project.diagrams.iter().flat_map(|one| &one.blocks);
    let by_id: HashMap<&str, &Block> = blocks.map(|block| (&*block.id, block)).collect();
    let mut piece = Piece::default();
    let mut places = HashMap::new();
    for id in ids {
        if let Some(block) = by_id.get(&**id)
            && !places.contains_key(&*block.id)
        {
            places.insert(&*block.id, piece.blocks.len());
            piece.blocks.push(drawn(save, block));
        }
    }
    for diagram in &project.diagrams {
        for link in &diagram.links {
            let at = |end: Option<usize>| places.get(&*diagram.blocks.get(end?)?.id).copied();
            if let (Some(from), Some(to)) = (at(link.from), at(link.to)) {
                let guard = link.guard.clone();
                piece.links.push(Wire {
                    from,
                    to,
                    guard,
                    ..Wire::default()
                });
            }
        }
    }
    piece
}

fn drawn(save: &Save, block: &Block) -> Drawn {
    let callee = block.calls.as_deref().and_then(|id| save.objects.get(id));
    let arguments = block.arguments.iter();
    Drawn {
        kind: block.kind.clone(),
        name: block.name.clone(),
        properties: block.properties.clone().into_iter().collect(),
        place: block.position,
        size: match block.size {
            (width, height) if width > 0.0 && height > 0.0 => Some(block.size),
            _ => None,
        },
        calls: callee
            .and_then(|one| one.property("name"))
            .map(str::to_owned),
        arguments: arguments
            .map(|one| (one.name.clone(), one.value.clone()))
            .collect(),
    }
}
