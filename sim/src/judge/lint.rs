//! A world and its rules looked at before any solution: `trik lint`.
//!
//! Owns what can be said of the tags of a world and of things on its field without a run. What tags mean is in
//! [`crate::field`], what rules name is asked in an arena that is made of the field and thrown away.

mod values;
mod words;

use super::scene::places;
use super::task::{Task, Texts};
use super::{Settings, scene};
use crate::arena::{Arena, Setup};
use crate::field::{Field, KINDS, Kind, Sensor, SensorKind};
use lang_text::near::{did_you_mean, nearest};
use lang_text::problem::{Problem, Severity, Words, keep, locate};
use lang_text::xml::{self, Element, Start};
use std::collections::{BTreeMap, BTreeSet};

/// Everything that is wrong or strange in a world and its rules, in the order of the text, with lines and columns of the
/// world model.
pub fn lint(texts: Texts<'_>) -> Vec<Problem> {
    let mut problems = match Task::read(texts) {
        Err(problems) => problems,
        Ok((task, mut problems)) => {
            problems.extend(of_task(&task));
            problems
        }
    };
    // A world that is no XML has been told of.
    if let Ok(document) = xml::parse(texts.world) {
        let root = match &*document.name {
            "root" => &document,
            _ => document.child("root").unwrap_or(&document),
        };
        if let Some(world) = root.child("world") {
            tags(root, "", &mut problems);
            regions(world, &mut problems);
        }
    }
    locate(&mut problems, texts.world);
    problems.sort_by_key(|problem| problem.place.position);
    problems.dedup();
    problems
}

/// What is strange in a task that can be judged.
fn of_task(task: &Task) -> Vec<Problem> {
    let mut problems = Vec::new();
    things(&task.field, &mut problems);
    if let Some(rules) = &task.rules {
        let own = task.field.robot().or_else(|| task.field.robots.first());
        let is_other = |robot: &&_| own.is_some_and(|own| !std::ptr::eq(own, *robot));
        let others = task.field.robots.iter().filter(is_other).cloned();
        let setup = Setup {
            others: others.collect(),
            ..Setup::default()
        };
        let mut arena = Arena::new(&task.field, setup);
        problems.extend(lang_constraint::lint(rules, &mut arena));
        let longest = Settings::default().longest_ms;
        if rules.time_limit_ms() > longest {
            let at = task.field.constraints.as_ref().and_then(|all| {
                let mut inside = all.elements();
                inside.find(|one| one.name.eq_ignore_ascii_case("timelimit"))
            });
            let at = at.map_or(Start(0), |one| one.start);
            let words = words::long_limit(rules.time_limit_ms(), longest);
            told(Severity::Note, at, words, &mut problems);
        }
    }
    problems
}

fn told(severity: Severity, at: Start, words: Words, problems: &mut Vec<Problem>) {
    let mut problem = Problem::warning(words);
    problem.severity = severity;
    problem.place.offset = Some(at.0).filter(|&at| at > 0);
    keep(problems, problem);
}

fn warn(at: Start, words: Words, problems: &mut Vec<Problem>) {
    told(Severity::Warning, at, words, problems);
}

/// What is strange of things on a field.
fn things(field: &Field, problems: &mut Vec<Problem>) {
    for region in &field.regions {
        let at = region.source.start;
        let is_there = |id: &str| field.drawn.iter().any(|one| one.id == id);
        if region.is_bound() && !is_there(&region.bound) {
            let near = nearest(&region.bound, field.drawn.iter().map(|one| &*one.id));
            if let Some(near) = near {
                warn(at, words::meant(&region.bound, near), problems);
            }
        } else if places::is_nowhere(region, field) {
            warn(at, words::nowhere(&region.id, region.is_bound()), problems);
        }
    }
    // In the order in which rules look for a name.
    let mut taken: BTreeMap<&str, &'static str> = BTreeMap::new();
    let mut take = |id, family, at| {
        if scene::is_taken(id) {
            warn(at, words::taken(id), problems);
        } else if id.is_empty() {
        } else if let Some(other) = taken.get(id) {
            if *other != family {
                warn(at, words::same_name(id, other), problems);
            }
        } else {
            taken.insert(id, family);
        }
    };
    for one in &field.regions {
        take(&*one.id, "region", one.source.start);
    }
    for one in &field.solids {
        take(&*one.id, one.kind.tag(), one.source.start);
    }
    for one in &field.walls {
        take(&*one.id, "wall", one.source.start);
    }
    for one in &field.drawn {
        take(&*one.id, "colorFields", one.source.start);
    }
    if field.robot().is_none() {
        warn(Start(0), words::other_kit(), problems);
    }
    for robot in field.robots.iter().filter(|robot| robot.is_trik()) {
        let mut ports = BTreeSet::new();
        for one in &robot.sensors {
            sensor(one, problems);
            // Encoders stand there too, and as often as anybody has opened the settings.
            if let Some(port) = one.port
                && one.kind != SensorKind::Other
                && !ports.insert(port.name())
            {
                warn(one.source.start, words::port_twice(port.name()), problems);
            }
        }
    }
}

fn sensor(sensor: &Sensor, problems: &mut Vec<Problem>) {
    let at = sensor.source.start;
    if sensor.port.is_none() {
        let text = sensor.source.attribute("port").unwrap_or_default();
        warn(at, words::no_port(text), problems);
    }
    if sensor.kind == SensorKind::Other {
        let name = sensor.type_name.rsplit("::").next().unwrap_or_default();
        let known = SensorKind::TYPES.iter().map(|(known, _)| *known);
        if let Some(near) = nearest(name, known) {
            warn(at, words::sensor_type(name, near), problems);
        }
    }
}

/// What is strange of a tag and of those inside it.
fn tags(element: &Element<'_>, outside: &str, problems: &mut Vec<Problem>) {
    let Some(kind) = kind(&element.name, outside) else {
        let known = KINDS.iter().filter(|one| stands_in(one, outside));
        let near = did_you_mean(&element.name, known.map(Kind::tag));
        let words = words::unknown_tag(&element.name, outside, &near);
        warn(element.start, words, problems);
        return;
    };
    values::check(element, kind, problems);
    let known = kind.attributes();
    for (name, _) in &element.attributes {
        if known.iter().any(|one| one == name) || kind.idle.contains(&&**name) {
            continue;
        }
        let near = nearest(name, known.iter().map(String::as_str));
        let severity = match near {
            Some(_) => Severity::Warning,
            None => Severity::Note,
        };
        let words = words::unknown_attribute(&element.name, name, near);
        told(severity, element.start, words, problems);
    }
    let is_other = [
        "constraints",
        "configurators",
        "comment",
        "image",
        "background",
    ];
    if !is_other.contains(&&*element.name) {
        for inside in element.elements() {
            tags(inside, &element.name, problems);
        }
    }
}

/// Regions of which a later one takes the place: the field has the last one alone.
fn regions(world: &Element<'_>, problems: &mut Vec<Problem>) {
    let mut ids = BTreeSet::new();
    for region in world
        .child("regions")
        .into_iter()
        .flat_map(Element::elements)
    {
        let id = region.attribute("id").unwrap_or_default();
        if region.name == "region" && !id.is_empty() && !ids.insert(id) {
            warn(region.start, words::region_twice(id), problems);
        }
    }
}

/// Whether a kind of tag may stand in another tag.
fn stands_in(kind: &Kind, outside: &str) -> bool {
    let is_list = |tag: &str| {
        KINDS
            .iter()
            .any(|one| one.is_thing() && one.outside() == tag)
    };
    kind.outside() == outside || kind.is_thing() && is_list(outside)
}

fn kind(tag: &str, outside: &str) -> Option<&'static Kind> {
    KINDS
        .iter()
        .find(|one| one.tag() == tag && stands_in(one, outside))
}

#[cfg(test)]
mod tests;
