//! What each change does to the objects of a save.
//!
//! Owns what a change is refused for. How both objects of a pair are kept in step is known to `pen`.

use super::notation::{Heading, Port};
use super::pen::Pen;
use super::route::{self, Ends};
use super::{Change, Drawn, KIT_KEY, Piece, piece, words};
use crate::limits;
use crate::objects::{self, Kind, Object, ROOT, element};
use crate::project::{Argument, DiagramKind, Parameter};
use crate::read;
use crate::save::{is_link, writable};
use lang_text::problem::{Problem, Words};
use lang_text::xml;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Makes a change, or a part of it if something is wrong.
pub(super) fn carry_out(pen: &mut Pen<'_>, change: &Change) -> Result<Vec<String>, Problem> {
    match change {
        Change::Add { diagram, piece } => return piece::add(pen, diagram, piece),
        Change::Insert {
            link,
            block,
            guard,
            ports,
        } => return insert(pen, link, block, guard, *ports),
        Change::Remove { ids } => remove(pen, ids)?,
        Change::Move { places } => move_to(pen, places)?,
        Change::Connect {
            from,
            to,
            guard,
            ports,
        } => return Ok(vec![connect(pen, (from, to), guard, *ports)?]),
        Change::Reconnect {
            link,
            from,
            to,
            ports,
        } => reconnect(pen, link, (from, to), *ports)?,
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
        Change::World { text, images } => world(pen, text.as_deref(), images.as_deref())?,
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
    let found = found.filter(|object| pen.kind_of(object).is_some());
    found.ok_or_else(|| missing(id, words::no_diagram()))
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

fn insert(
    pen: &mut Pen<'_>,
    id: &str,
    drawn: &Drawn,
    guard: &str,
    ports: Option<(u8, u8)>,
) -> Result<Vec<String>, Problem> {
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
    let had = route::places(pen, id);
    let (first, second) = match (ports, had) {
        (Some((into, out)), Some((leaves, enters))) => (Some((leaves, into)), Some((out, enters))),
        (Some(_), None) if pen.ports(&from).is_some() => {
            return Err(missing(id, words::no_port()));
        }
        (Some(_), None) | (None, Some(_) | None) => (ports, ports),
    };
    reconnect(pen, id, (&from, &middle), first)?;
    new.push(connect(pen, (&middle, &to), guard, second)?);
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

const GUARD: &str = "Guard";

pub(super) fn connect(
    pen: &mut Pen<'_>,
    (from, to): (&str, &str),
    guard: &str,
    ports: Option<(u8, u8)>,
) -> Result<String, Problem> {
    carried(guard)?;
    let elements = pen.notation.elements();
    let has_guards = elements.at_link.contains(&GUARD);
    if !has_guards && !guard.is_empty() {
        return Err(missing(from, words::no_property(GUARD)));
    }
    let parent = block(pen, from)?.parent.clone();
    if block(pen, to)?.parent != parent {
        return Err(missing(to, words::other_diagram()));
    }
    let ends = ends(pen, (from, to), ports)?;
    let link = pen.pair(elements.link, &parent, words::LINK_NAME)?;
    if has_guards {
        pen.set_logical(&link, GUARD, guard);
    }
    attach(pen, &link, (from, to), ends);
    Ok(link)
}

/// Another end for a link. What it begins at keeps its place among the links there: tokens go in that order.
fn reconnect(
    pen: &mut Pen<'_>,
    id: &str,
    (from, to): (&str, &str),
    ports: Option<(u8, u8)>,
) -> Result<(), Problem> {
    let object = link(pen, id)?;
    let parent = object.parent.clone();
    let had = |key| object.property(key).unwrap_or_default().to_owned();
    let changed: Vec<&str> = [("from", from), ("to", to)]
        .into_iter()
        .filter(|(key, end)| had(key) != **end)
        .map(|(key, _)| key)
        .collect();
    for end in [from, to] {
        if block(pen, end)?.parent != parent {
            return Err(missing(end, words::other_diagram()));
        }
    }
    let ends = ends(pen, (from, to), ports)?;
    pen.detach_ends(id, &changed);
    attach(pen, id, (from, to), ends);
    Ok(())
}

/// Where a link leaves and enters two blocks: at ports, if the language has them, and else at sides that are seen from where
/// they are.
fn ends(pen: &Pen<'_>, (from, to): (&str, &str), ports: Option<(u8, u8)>) -> Result<Ends, Problem> {
    let (Some(leaves), Some(enters)) = (pen.ports(from), pen.ports(to)) else {
        return match ports {
            None => Ok(Ends::between(pen, from, to)),
            Some(_) => Err(missing(from, words::no_ports())),
        };
    };
    let Some((out, into)) = ports else {
        return Err(missing(from, words::which_port()));
    };
    let port = |of: &[Port], at: u8, id: &str| {
        let found = of.get(usize::from(at)).copied();
        let found = found.filter(|one| one.number >= 0);
        found.ok_or_else(|| missing(id, words::no_port()))
    };
    let (first, last) = (port(&leaves, out, from)?, port(&enters, into, to)?);
    if first.heading != Heading::Out {
        return Err(missing(from, words::no_output()));
    }
    if last.heading != Heading::In {
        return Err(missing(to, words::no_input()));
    }
    let refused = pen
        .notation
        .refuses((element(from), out), (element(to), into));
    match refused {
        Some(why) => Err(missing(to, why)),
        None => Ok(Ends::at(first.number, last.number)),
    }
}

/// Both ends of a link.
fn attach(pen: &mut Pen<'_>, link: &str, (from, to): (&str, &str), ends: Ends) {
    pen.attach(link, "from", from);
    pen.attach(link, "to", to);
    route::straight(pen, link, ends);
}

pub(super) fn set(pen: &mut Pen<'_>, id: &str, property: &str, value: &str) -> Result<(), Problem> {
    carried(value)?;
    let object = match pen.get(id) {
        Some(object) if is_link(object) => link(pen, id)?,
        Some(_) | None => block(pen, id)?,
    };
    let at_link = pen.notation.elements().at_link;
    let is_known = match is_link(object) {
        true => at_link.contains(&property),
        false => {
            let known = pen.notation.known(object.element(), pen.logical(id));
            let is_there = |logical: &Object| logical.property(property).is_some();
            known.is_some_and(|one| one.properties.iter().any(|(name, _)| *name == property))
                || !WIRING.contains(&property) && pen.logical(id).is_some_and(is_there)
        }
    };
    if !is_known {
        let shown = property.chars().take(limits::EDIT_ID_SHOWN);
        return Err(missing(id, words::no_property(&shown.collect::<String>())));
    }
    // What a link of data flow does not say has its default; nothing written is no word for it.
    if property != GUARD && at_link.contains(&property) && value.is_empty() {
        pen.clear_logical(id, property);
    } else {
        pen.set_logical(id, property, value);
    }
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
    if !pen.notation.elements().has_parameters {
        return Err(missing(id, words::no_parameters_here()));
    }
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
    if pen.kind_of(diagram(pen, callee)?) != Some(DiagramKind::Subprogram) {
        return Err(missing(callee, words::no_subprogram()));
    }
    if block(pen, id)?.element() != pen.notation.elements().call {
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
    if pen.kind_of(diagram(pen, id)?) == Some(DiagramKind::Subprogram) {
        free(pen, id, name)?;
    }
    pen.rename(id, name);
    for call in pen.calls_of(id) {
        pen.rename(&call, name);
    }
    Ok(())
}

fn parameters_of(pen: &mut Pen<'_>, id: &str, all: &[Parameter]) -> Result<(), Problem> {
    if !pen.notation.elements().has_parameters {
        return Err(missing(id, words::no_parameters_here()));
    }
    if pen.kind_of(diagram(pen, id)?) != Some(DiagramKind::Subprogram) {
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
    let kind = pen.kind_of(diagram(pen, id)?);
    let diagrams = pen.diagrams();
    let kinds = diagrams.iter().filter_map(|one| pen.kind_of(pen.get(one)?));
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

fn world(pen: &mut Pen<'_>, text: Option<&str>, images: Option<&str>) -> Result<(), Problem> {
    if let Some(text) = text {
        entry(read::WORLD_FILE, text)?;
    }
    let images = images.map(|text| (!text.is_empty()).then_some(text));
    if let Some(Some(text)) = images {
        entry(read::BLOBS_FILE, text)?;
    }
    let meta = pen.meta();
    meta.world = text.map(str::to_owned);
    if let Some(images) = images {
        meta.blobs = images.map(Arc::from);
    }
    Ok(())
}

/// A text can be a file in XML of a save.
fn entry(name: &str, text: &str) -> Result<(), Problem> {
    let fits = || {
        if text.len() > limits::ENTRY_BYTES {
            let most = limits::ENTRY_BYTES;
            return Err(Problem::error(words::long_text(text.len(), most)));
        }
        writable(text)?;
        xml::parse(text).map(|_| ())
    };
    fits().map_err(|mut problem| {
        problem.place.file = Some(name.to_owned());
        problem
    })
}

/// Which objects stand for which: the names of subprograms by their logical ids.
pub(super) fn subprograms(pen: &Pen<'_>) -> HashMap<String, String> {
    let mut all = HashMap::new();
    for id in pen.diagrams() {
        let Some(object) = pen.get(&id) else { continue };
        if pen.kind_of(object) != Some(DiagramKind::Subprogram) {
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
