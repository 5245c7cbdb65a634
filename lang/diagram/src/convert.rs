//! Saves of old versions, brought to the present one step after another.
//!
//! Owns which step a version needs and what the step does, as the editor has it. A step is taken if it begins at the
//! save's version or later, so a save from between two versions gets the later steps only.

use super::objects::{self, Kind, Object, Objects};
use super::read::{DATAFLOW_VERSION_KEY, Meta, VERSION, VERSION_KEY};
use super::version::Version;
use lang_text::problem::{Problem, Severity};
use lang_text::xml::{self, Element, Node};
use std::collections::{HashMap, HashSet};

mod rules;
mod words;

/// Saves before this one cannot be opened by any version of today.
const OLDEST: Version = Version::release(3, 0, 0).alpha(1);

/// Changes a save to the next version; whether it changed anything.
type Apply = fn(&mut Objects, &mut Meta, &mut Vec<Problem>) -> bool;

/// All steps, oldest first, each with the version at which it begins.
const STEPS: [(Version, Apply); 10] = [
    (Version::release(3, 0, 0).alpha(4), ports_lose_their_j),
    (
        Version::release(3, 0, 0).beta(2),
        spoken_texts_become_expressions,
    ),
    (Version::release(3, 0, 0), buttons_get_new_names),
    (Version::release(3, 0, 1), commands_become_expressions),
    (Version::release(3, 0, 2), world_moves_out_of_the_diagram),
    (Version::release(3, 1, 2), vectors_get_indices),
    (Version::release(3, 2, 0), robot_gets_one_name),
    (Version::release(3, 3, 0), line_sensor_becomes_a_camera),
    (Version::release(2020, 4, 0), printed_text_gets_a_size),
    (Version::release(2020, 5, 0), robot_moves_into_the_world),
];

/// Brings a save to the present version.
///
/// # Errors
/// A version that is newer than the present one, or older than the oldest that can be opened.
pub(super) fn convert(
    objects: &mut Objects,
    meta: &mut Meta,
    problems: &mut Vec<Problem>,
) -> Result<(), Problem> {
    let Some(text) = meta.keys.get(VERSION_KEY).cloned() else {
        if meta.keys.contains_key(DATAFLOW_VERSION_KEY) {
            // A save with diagrams of data flow alone, of which there is one version.
            return Ok(());
        }
        problems.push(in_meta(Problem::warning(words::no_version())));
        return Ok(());
    };
    let Some(saved) = Version::parse(&text) else {
        problems.push(in_meta(Problem::warning(words::strange_version(&text))));
        return Ok(());
    };
    if Some(saved) > Version::parse(VERSION) {
        return Err(in_meta(Problem::error(words::newer(&text, VERSION))));
    }
    if saved < OLDEST {
        return Err(in_meta(Problem::error(words::too_old(&text))));
    }
    let mut is_changed = false;
    for (from, apply) in STEPS {
        if from >= saved {
            is_changed |= apply(objects, meta, problems);
        }
    }
    if is_changed {
        let mut problem = in_meta(Problem::warning(words::converted(&text, VERSION)));
        problem.severity = Severity::Note;
        problems.push(problem);
    }
    meta.keys.insert(VERSION_KEY.to_owned(), VERSION.to_owned());
    Ok(())
}

fn in_meta(mut problem: Problem) -> Problem {
    problem.place.file = Some("metaInfo.xml".to_owned());
    problem
}

/// Logical objects of the language.
fn logical(objects: &mut Objects) -> impl Iterator<Item = &mut Object> {
    objects.iter_mut().filter(|object| {
        !object.is_graphical() && object.id.starts_with("qrm:/RobotsMetamodel/RobotsDiagram/")
    })
}

/// Replaces words in a text, one rule after another; whether there were any.
fn replace(text: &mut String, rules: &[(&str, &str)]) -> bool {
    let mut is_changed = false;
    for (old, new) in rules {
        if text.contains(old) {
            *text = text.replace(old, new);
            is_changed = true;
        }
    }
    is_changed
}

/// Replaces words in all texts of an object.
fn replace_in(object: &mut Object, rules: &[(&str, &str)]) -> bool {
    let texts = object.properties.iter_mut();
    let texts = texts.filter(|one| matches!(one.kind, Kind::Text | Kind::Texts));
    texts.fold(false, |is_changed, one| {
        replace(&mut one.value, rules) | is_changed
    })
}

/// 3.0.0-a5: `JA1` is called `A1`, and variables of sensors like their ports.
fn ports_lose_their_j(objects: &mut Objects, _: &mut Meta, _: &mut Vec<Problem>) -> bool {
    let trik = logical(objects).filter(|object| object.element().starts_with("Trik"));
    trik.fold(false, |changed, object| {
        replace_in(object, &rules::PORTS) | changed
    })
}

/// 3.0.0-rc1: what is said or printed was text and became an expression.
fn spoken_texts_become_expressions(
    objects: &mut Objects,
    _: &mut Meta,
    _: &mut Vec<Problem>,
) -> bool {
    quote(objects, "TrikSay", "Text") | quote(objects, "PrintText", "PrintText")
}

/// 3.0.2: the same for commands of the system.
fn commands_become_expressions(objects: &mut Objects, _: &mut Meta, _: &mut Vec<Problem>) -> bool {
    quote(objects, "TrikSystem", "Command")
}

fn quote(objects: &mut Objects, element: &str, key: &str) -> bool {
    let mut is_changed = false;
    for object in logical(objects).filter(|object| object.element() == element) {
        let old = object.property(key).unwrap_or_default();
        if !old.starts_with('"') {
            let quoted = format!("\"{old}\"");
            object.set(Kind::Text, key, &quoted);
            is_changed = true;
        }
    }
    is_changed
}

/// 3.0.1: variables of buttons have new names, and waits for single buttons are gone.
fn buttons_get_new_names(objects: &mut Objects, _: &mut Meta, _: &mut Vec<Problem>) -> bool {
    let mut is_changed = false;
    for object in logical(objects) {
        is_changed |= replace_in(object, &rules::BUTTONS);
        if object.element().starts_with("Trik") {
            is_changed |= replace_in(object, &[("buttonEscape", "buttonEsc")]);
        }
    }
    let gone: HashSet<String> = objects
        .iter()
        .filter(|object| rules::REMOVED.contains(&object.element()))
        .map(|object| object.id.clone())
        .collect();
    if !gone.is_empty() {
        objects.retain(|object| !gone.contains(&object.id));
        objects.replace_ids(|id| gone.contains(id).then_some(objects::ROOT));
        for object in objects.iter_mut() {
            object.children.retain(|id| id != objects::ROOT);
            for (_, ids) in &mut object.lists {
                ids.retain(|id| id != objects::ROOT);
            }
        }
    }
    is_changed || !gone.is_empty()
}

/// 3.1.0: classes of devices have new names, the line sensor is a vector, and the world belongs to the project.
fn world_moves_out_of_the_diagram(
    objects: &mut Objects,
    meta: &mut Meta,
    _: &mut Vec<Problem>,
) -> bool {
    let mut is_changed = false;
    for object in logical(objects) {
        is_changed |= replace_in(object, &rules::CLASSES);
        let is_main = object.element() == "RobotsDiagramNode";
        let world = object.property("worldModel").filter(|_| is_main);
        if let Some(world) = world.filter(|world| !world.is_empty()) {
            meta.world = Some(world.to_owned());
            is_changed = true;
        }
    }
    is_changed
}

/// 3.1.3: `gyroscopeX` is `gyroscope[0]`, and so on.
fn vectors_get_indices(objects: &mut Objects, _: &mut Meta, _: &mut Vec<Problem>) -> bool {
    logical(objects).fold(false, |changed, object| {
        replace_in(object, &rules::VECTORS) | changed
    })
}

/// 3.3.0: the robot of both kits is one.
fn robot_gets_one_name(_: &mut Objects, meta: &mut Meta, _: &mut Vec<Problem>) -> bool {
    let world = meta.world.as_mut();
    world.is_some_and(|world| replace(world, &[("trikV62KitRobot", "trikKitRobot")]))
}

/// 2020.4: line, object and colour sensors are one camera at a port of its own.
fn line_sensor_becomes_a_camera(_: &mut Objects, meta: &mut Meta, _: &mut Vec<Problem>) -> bool {
    let Some(world) = &mut meta.world else {
        return false;
    };
    let is_old = rules::OLD_SENSORS.iter().any(|name| world.contains(name));
    is_old && replace(world, &rules::SENSORS)
}

/// 2020.4.1: TRIK prints by a block of its own, which knows how large letters are.
fn printed_text_gets_a_size(objects: &mut Objects, meta: &mut Meta, _: &mut Vec<Problem>) -> bool {
    let kit = meta.keys.get("lastKitId").map(|kit| kit.to_lowercase());
    if !kit.is_some_and(|kit| kit.contains("trik")) {
        return false;
    }
    let printing = objects.iter().filter(|one| one.element() == "PrintText");
    let names: HashMap<String, String> = printing
        .map(|one| {
            (
                one.id.clone(),
                one.id.replace("/PrintText/", "/TrikPrintText/"),
            )
        })
        .collect();
    if names.is_empty() {
        return false;
    }
    objects.replace_ids(|id| names.get(id).map(String::as_str));
    for object in logical(objects).filter(|one| one.element() == "TrikPrintText") {
        if object.property("FontSize").is_none() {
            object.set(Kind::Text, "FontSize", "20");
        }
    }
    true
}

/// 2022.2: where the robot is belongs to the world and not to the robot.
fn robot_moves_into_the_world(
    _: &mut Objects,
    meta: &mut Meta,
    problems: &mut Vec<Problem>,
) -> bool {
    let Some(world) = &meta.world else {
        return false;
    };
    match modern_world(world) {
        Ok(Some(modern)) => {
            meta.world = Some(modern);
            true
        }
        Ok(None) => false,
        Err(mut problem) => {
            problem.severity = Severity::Warning;
            problem.place.file = Some("worldModel.xml".to_owned());
            problems.push(problem);
            false
        }
    }
}

/// A world model, also one from a file of its own, with the robot's place where it belongs since 2022; `None` if it is
/// there already.
///
/// # Errors
/// Text that is no XML.
pub fn modern_world(world: &str) -> Result<Option<String>, Problem> {
    if world.trim().is_empty() {
        return Ok(None);
    }
    let mut root = xml::parse(world)?;
    let old = root
        .elements_mut()
        .find(|one| one.name == "robots")
        .and_then(|robots| robots.elements_mut().find(|one| one.name == "robot"));
    let Some(old) = old else {
        return Ok(None);
    };
    let (position, direction) = (old.take("position"), old.take("direction"));
    let is_start =
        |node: &Node<'_>| matches!(node, Node::Element(one) if one.name == "startPosition");
    let start = old.nodes.iter().position(is_start);
    if position.is_none() && direction.is_none() && start.is_none() {
        return Ok(None);
    }
    let start = start.map(|at| old.nodes.remove(at));
    let mut robot = Element::new("robot")
        .with("position", position.unwrap_or_else(|| "0:0".to_owned()))
        .with("direction", direction.unwrap_or_else(|| "0".to_owned()));
    robot.nodes.extend(start);
    root.child_mut("world").nodes.push(Node::Element(robot));
    Ok(Some(xml::write(&root, 4)))
}

#[cfg(test)]
mod tests;
