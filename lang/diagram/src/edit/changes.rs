//! What each change does to the objects of a save.
//!
//! Owns what a change is refused for. How both objects of a pair are kept in step is known to `pen`.

use super::pen::Pen;
use super::route::{self, Side};
use super::{Change, Drawn, KIT_KEY, Piece, piece, words};
use crate::blocks;
use crate::limits;
use crate::objects::{self, Kind, Object, ROOT};
use crate::project::{Argument, DiagramKind, Parameter};
use crate::read;
use crate::save::{is_link, writable};
use lang_text::problem::{Problem, Words};
use lang_text::xml;
use std::collections::{HashMap, HashSet};

/// Makes a change, or a part of it if something is wrong.
pub(super) fn carry_out(pen: &mut Pen<'_>, change: &Change) -> Result<Vec<String>, Problem> {
    match change {
        Change::Add { diagram, piece } => return piece::add(pen, diagram, piece),
        Change::Insert { link, block } => return insert(pen, link, block),
        Change::Remove { ids } => remove(pen, ids)?,
        Change::Move { places } => move_to(pen, places)?,
        Change::Connect { from, to, guard } => {
            return Ok(vec![connect(pen, from, to, guard)?]);
        }
        Change::Reconnect { link, from, to } => reconnect(pen, link, from, to)?,
        Change::Set {
            id,
            property,
            value,
        } => set(pen, id, property, value)?,
        Change::Argument { id, name, value } => argument(pen, id, name, value)?,
        Change::Call { id, diagram } => call(pen, id, diagram)?,
        Change::AddDiagram { kind, name } => {
            named(name)?;
            if *kind == DiagramKind::Subprogram {
                free(pen, "", name)?;
            }
            return Ok(vec![pen.diagram(*kind, name)?]);
        }
        Change::Rename { diagram, name } => rename(pen, diagram, name)?,
        Change::Parameters {
            diagram,
            parameters,
        } => parameters_of(pen, diagram, parameters)?,
        Change::RemoveDiagram { diagram } => remove_diagram(pen, diagram)?,
        Change::World { text } => world(pen, text.as_deref())?,
        Change::Kit { kit } => {
            let keys = &mut pen.meta().keys;
            keys.insert(KIT_KEY.to_owned(), kit.id().into());
        }
    }
    Ok(Vec::new())
}

/// An object of a drawing that is no link and no diagram.
fn block<'a>(pen: &'a Pen<'_>, id: &str) -> Result<&'a Object, Problem> {
    let found = pen.get(id);
    let found = found.filter(|object| object.is_graphical() && !is_link(object));
    let found = found.filter(|object| object.parent != ROOT);
    found.ok_or_else(|| missing(id, words::no_block()))
}

fn link<'a>(pen: &'a Pen<'_>, id: &str) -> Result<&'a Object, Problem> {
    let found = pen.get(id);
    let found = found.filter(|object| object.is_graphical() && is_link(object));
    found.ok_or_else(|| missing(id, words::no_link()))
}

pub(super) fn diagram<'a>(pen: &'a Pen<'_>, id: &str) -> Result<&'a Object, Problem> {
    let found = pen.get(id);
    let found = found.filter(|object| kind_of(object).is_some());
    found.ok_or_else(|| missing(id, words::no_diagram()))
}

/// Which diagram an object is; nothing if it is none of control flow.
pub(super) fn kind_of(object: &Object) -> Option<DiagramKind> {
    let is_diagram = object.is_graphical() && object.parent == ROOT;
    match object.element() {
        "RobotsDiagramNode" if is_diagram => Some(DiagramKind::Main),
        "SubprogramDiagram" if is_diagram => Some(DiagramKind::Subprogram),
        _ => None,
    }
}

pub(super) fn missing(id: &str, words: Words) -> Problem {
    let mut problem = Problem::error(words);
    // Whatever was asked for, a refusal is short.
    problem.place.object = Some(id.chars().take(limits::EDIT_ID_SHOWN).collect());
    problem
}

/// A number of the canvas.
pub(super) fn sane(place: (f64, f64)) -> Result<(f64, f64), Problem> {
    let is_sane = |number: f64| number.abs() <= limits::EDIT_PLACE_MAX;
    match is_sane(place.0) && is_sane(place.1) {
        // No zero with a sign.
        true => Ok((place.0.round() + 0.0, place.1.round() + 0.0)),
        false => Err(Problem::error(words::far_away())),
    }
}

fn named(name: &str) -> Result<(), Problem> {
    carried(name)?;
    match name.trim().is_empty() {
        true => Err(Problem::error(words::no_name())),
        false => Ok(()),
    }
}

/// A text that a save can carry, of a length that people write.
pub(super) fn carried(text: &str) -> Result<(), Problem> {
    if text.len() > limits::EDIT_TEXT_BYTES {
        let most = limits::EDIT_TEXT_BYTES;
        return Err(Problem::error(words::long_text(text.len(), most)));
    }
    writable(text)
}

fn insert(pen: &mut Pen<'_>, id: &str, drawn: &Drawn) -> Result<Vec<String>, Problem> {
    let object = link(pen, id)?;
    let parent = object.parent.clone();
    let end = |key| object.property(key).unwrap_or_default().to_owned();
    let (from, to) = (end("from"), end("to"));
    let piece = Piece {
        blocks: vec![drawn.clone()],
        links: Vec::new(),
    };
    let mut new = piece::add(pen, &parent, &piece)?;
    let Some(middle) = new.first().cloned() else {
        return Ok(new);
    };
    reconnect(pen, id, &from, &middle)?;
    new.push(connect(pen, &middle, &to, "")?);
    Ok(new)
}

/// No other subprogram has this name: a person could not say which one a block calls.
fn free(pen: &Pen<'_>, id: &str, name: &str) -> Result<(), Problem> {
    let own = pen.logical_id(id);
    match subprograms(pen).get(name) {
        Some(other) if Some(other) != own.as_ref() => {
            Err(Problem::error(words::same_subprogram(name)))
        }
        Some(_) | None => Ok(()),
    }
}

fn remove(pen: &mut Pen<'_>, ids: &[String]) -> Result<(), Problem> {
    let mut gone: Vec<String> = Vec::new();
    let mut seen = HashSet::new();
    for id in ids {
        let object = match pen.get(id) {
            Some(object) if is_link(object) => link(pen, id)?,
            Some(_) | None => block(pen, id)?,
        };
        let links = object.list("links").iter();
        let links = links.filter(|link| pen.get(link).is_some());
        for one in std::iter::once(id).chain(links) {
            if seen.insert(one.clone()) {
                gone.push(one.clone());
            }
        }
    }
    pen.remove_pairs(&gone);
    Ok(())
}

const LINK: &str = "ControlFlow";

fn move_to(pen: &mut Pen<'_>, places: &[(String, (f64, f64))]) -> Result<(), Problem> {
    let mut links = HashSet::new();
    for (id, place) in places {
        let (x, y) = sane(*place)?;
        block(pen, id)?;
        let position = format!("{x}, {y}");
        let Some(object) = pen.get_mut(id) else {
            continue;
        };
        object.set(Kind::Shape("QPointF"), "position", &position);
        links.extend(object.list("links").iter().cloned());
    }
    let mut links: Vec<String> = links.into_iter().collect();
    links.sort();
    for link in links {
        route::follow(pen, &link);
    }
    Ok(())
}

pub(super) fn connect(
    pen: &mut Pen<'_>,
    from: &str,
    to: &str,
    guard: &str,
) -> Result<String, Problem> {
    carried(guard)?;
    let parent = block(pen, from)?.parent.clone();
    if block(pen, to)?.parent != parent {
        return Err(missing(to, words::other_diagram()));
    }
    let link = pen.pair(LINK, &parent, words::LINK_NAME)?;
    pen.set_logical(&link, "Guard", guard);
    attach(pen, &link, from, to);
    Ok(link)
}

fn reconnect(pen: &mut Pen<'_>, id: &str, from: &str, to: &str) -> Result<(), Problem> {
    let parent = link(pen, id)?.parent.clone();
    for end in [from, to] {
        if block(pen, end)?.parent != parent {
            return Err(missing(end, words::other_diagram()));
        }
    }
    pen.detach(id);
    attach(pen, id, from, to);
    Ok(())
}

/// Both ends of a link; which side of a block it leaves and enters is seen from where they are.
fn attach(pen: &mut Pen<'_>, link: &str, from: &str, to: &str) {
    pen.attach(link, "from", from);
    pen.attach(link, "to", to);
    route::straight(pen, link, Side::between(pen, from, to));
}

fn set(pen: &mut Pen<'_>, id: &str, property: &str, value: &str) -> Result<(), Problem> {
    carried(value)?;
    let object = match pen.get(id) {
        Some(object) if is_link(object) => link(pen, id)?,
        Some(_) | None => block(pen, id)?,
    };
    let is_known = match is_link(object) {
        true => property == "Guard",
        false => {
            let row = blocks::find(object.element());
            let is_there = |logical: &Object| logical.property(property).is_some();
            row.is_some_and(|row| row.property(property).is_some())
                || !WIRING.contains(&property) && pen.logical(id).is_some_and(is_there)
        }
    };
    if !is_known {
        let shown = property.chars().take(limits::EDIT_ID_SHOWN);
        return Err(missing(id, words::no_property(&shown.collect::<String>())));
    }
    pen.set_logical(id, property, value);
    Ok(())
}

/// Properties that are how an object is kept, and not what a person wrote.
pub(super) const WIRING: [&str; 6] = [
    "from",
    "to",
    "linkShape",
    "name",
    "outgoingExplosion",
    "dynamicProperties",
];

fn argument(pen: &mut Pen<'_>, id: &str, name: &str, value: &str) -> Result<(), Problem> {
    carried(name)?;
    carried(value)?;
    block(pen, id)?;
    let logical = pen.logical(id);
    let text = logical.and_then(|one| one.property("dynamicProperties"));
    let mut all = read::parameters::actual(text.unwrap_or_default()).unwrap_or_default();
    match all.iter_mut().find(|one| one.name == name) {
        Some(argument) => value.clone_into(&mut argument.value),
        None => {
            let callee = logical.and_then(|one| one.property("outgoingExplosion"));
            let formal = callee.and_then(|callee| pen.get(callee)).map(parameters);
            let formal = formal.unwrap_or_default();
            let Some(parameter) = formal.into_iter().find(|one| one.name == name) else {
                let shown = name.chars().take(limits::EDIT_ID_SHOWN);
                return Err(missing(id, words::no_property(&shown.collect::<String>())));
            };
            all.push(Argument {
                name: name.to_owned(),
                kind: parameter.kind,
                value: value.to_owned(),
            });
        }
    }
    pen.set_logical(id, "dynamicProperties", &written_arguments(&all));
    Ok(())
}

fn call(pen: &mut Pen<'_>, id: &str, callee: &str) -> Result<(), Problem> {
    if kind_of(diagram(pen, callee)?) != Some(DiagramKind::Subprogram) {
        return Err(missing(callee, words::no_subprogram()));
    }
    if block(pen, id)?.element() != "Subprogram" {
        return Err(missing(id, words::no_call()));
    }
    let given = pen
        .logical(id)
        .and_then(|one| one.property("dynamicProperties"));
    let given = read::parameters::actual(given.unwrap_or_default()).unwrap_or_default();
    let given: Vec<(String, String)> = given.into_iter().map(|one| (one.name, one.value)).collect();
    if let Some(caller) = pen.logical_id(id) {
        pen.forget_call(&caller);
    }
    match pen.logical_id(callee) {
        Some(callee) => piece::call(pen, id, &callee, &given),
        None => Ok(()),
    }
}

/// The formal parameters of a logical diagram.
pub(super) fn parameters(logical: &Object) -> Vec<Parameter> {
    let labels = logical.property("labels").unwrap_or_default();
    read::parameters::formal(labels).unwrap_or_default()
}

pub(super) fn written_arguments(all: &[Argument]) -> String {
    let mut document = xml::Element::new("properties");
    for argument in all {
        let property = xml::Element::new("property")
            .with("name", argument.name.as_str())
            .with("displayedName", argument.name.as_str())
            .with("type", argument.kind.as_str())
            .with("dynamicPropertyValue", argument.value.as_str());
        document.nodes.push(xml::Node::Element(property));
    }
    xml::write(&document, 0)
}

fn rename(pen: &mut Pen<'_>, id: &str, name: &str) -> Result<(), Problem> {
    named(name)?;
    if kind_of(diagram(pen, id)?) == Some(DiagramKind::Subprogram) {
        free(pen, id, name)?;
    }
    pen.rename(id, name);
    for call in pen.calls_of(id) {
        pen.rename(&call, name);
    }
    Ok(())
}

fn parameters_of(pen: &mut Pen<'_>, id: &str, all: &[Parameter]) -> Result<(), Problem> {
    if kind_of(diagram(pen, id)?) != Some(DiagramKind::Subprogram) {
        return Err(missing(id, words::no_parameters()));
    }
    let mut names = HashSet::new();
    for one in all {
        named(&one.name)?;
        carried(&one.default)?;
        if !TYPES.contains(&&*one.kind) {
            return Err(missing(id, words::no_type()));
        }
        if !names.insert(&*one.name) {
            return Err(missing(id, words::same_parameter(&one.name)));
        }
    }
    let mut document = xml::Element::new("labels");
    for (at, one) in all.iter().enumerate() {
        let label = xml::Element::new("label")
            .with("text", one.name.as_str())
            .with("type", one.kind.as_str())
            .with("value", one.default.as_str())
            .with("index", at.to_string());
        document.nodes.push(xml::Node::Element(label));
    }
    pen.set_logical(id, "labels", &xml::write(&document, 0));
    Ok(())
}

/// Types of parameters.
const TYPES: [&str; 4] = ["int", "float", "bool", "string"];

fn remove_diagram(pen: &mut Pen<'_>, id: &str) -> Result<(), Problem> {
    let kind = kind_of(diagram(pen, id)?);
    let diagrams = pen.diagrams();
    let kinds = diagrams
        .iter()
        .filter_map(|one| pen.get(one).and_then(kind_of));
    let mains = kinds.filter(|one| *one == DiagramKind::Main).count();
    if kind == Some(DiagramKind::Main) && mains == 1 {
        return Err(missing(id, words::last_main()));
    }
    for call in pen.calls_of(id) {
        pen.set_logical_id(&call, "outgoingExplosion", objects::NOTHING);
    }
    let inside = diagram(pen, id)?.children.iter();
    let gone: Vec<String> = inside.chain([&id.to_owned()]).cloned().collect();
    pen.remove_pairs(&gone);
    Ok(())
}

fn world(pen: &mut Pen<'_>, text: Option<&str>) -> Result<(), Problem> {
    if let Some(text) = text {
        let file = |mut problem: Problem| {
            problem.place.file = Some(read::WORLD_FILE.to_owned());
            problem
        };
        if text.len() > limits::ENTRY_BYTES {
            let most = limits::ENTRY_BYTES;
            return Err(file(Problem::error(words::long_text(text.len(), most))));
        }
        writable(text).map_err(file)?;
        xml::parse(text).map_err(file)?;
    }
    pen.meta().world = text.map(str::to_owned);
    Ok(())
}

/// Which objects stand for which: the names of subprograms by their logical ids.
pub(super) fn subprograms(pen: &Pen<'_>) -> HashMap<String, String> {
    let mut all = HashMap::new();
    for id in pen.diagrams() {
        let Some(object) = pen.get(&id) else { continue };
        if kind_of(object) != Some(DiagramKind::Subprogram) {
            continue;
        }
        let logical = object.logical.as_deref().and_then(|id| pen.get(id));
        let name = logical.and_then(|one| one.property("name"));
        if let (Some(name), Some(logical)) = (name, logical) {
            let (name, id) = (name.to_owned(), logical.id.clone());
            all.entry(name).or_insert(id);
        }
    }
    all
}
