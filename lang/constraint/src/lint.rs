//! Rules looked at before any run: names that are nobody's, properties that are not there, events that nothing sets up.
//!
//! Owns what is certain without a program; whatever a program may change is left alone. What there is in a world it asks
//! the same [`Scene`] that a run asks, so nothing is known twice.

mod start;
pub(crate) mod words;

use std::collections::{BTreeSet, HashSet};

use super::check::{ON_SUCCESS, SCORE};
use super::operand::head;
use super::rules::{Condition, Event, Named, Operand, Path, Rules, Trigger};
use super::scene::{Missing, Object, ObjectPoint, Scene, Unfit};
use super::value::Value;
use super::words as said;
use crate::limits;
use lang_text::limits::PROBLEMS_KEPT;
use lang_text::near::{did_you_mean, nearest};
use lang_text::problem::{Place, Problem, Severity, Words, keep};
use lang_text::xml::Start;

/// A scene that also says what else it could have been asked for.
pub trait Catalogue: Scene {
    /// Names of all objects that are there.
    fn names(&self) -> Vec<String>;

    /// Names of all properties of an object.
    fn properties(&mut self, object: Object) -> Vec<&'static str>;

    /// All classes that objects can have.
    fn classes(&self) -> &'static [&'static str];

    /// Whether a name that is nobody's may become that of an object when a program runs, as that of an empty port.
    fn may_come(&self, name: &str) -> bool;
}

/// What is wrong with rules in the world of a scene, in the order of events; the scene is of no use for a run afterwards.
pub fn lint(rules: &Rules, scene: &mut dyn Catalogue) -> Vec<Problem> {
    let reached = reached(rules);
    let mut used = Used::default();
    for event in &rules.events {
        used.condition(&event.condition);
        used.trigger(&event.trigger);
    }
    let mut names = scene.names();
    names.truncate(limits::NAMES_COMPARED);
    let mut lint = Lint {
        rules,
        scene,
        names,
        regions: None,
        used: &used,
        problems: Vec::new(),
        event: None,
    };
    lint.task(&reached);
    for (index, event) in rules.events.iter().enumerate() {
        lint.event = Some((event, reached.contains(&index)));
        if !reached.contains(&index) {
            lint.report(Severity::Warning, event.at, words::never_set_up(&event.id));
        }
        lint.condition(&event.condition);
        lint.trigger(&event.trigger);
        lint.start(event);
    }
    lint.event = None;
    let has_score = used.set.iter().any(|(name, _)| *name == SCORE);
    for (name, at) in &used.set {
        if !has_score && is_like_score(name) {
            lint.report(Severity::Warning, *at, words::like_score(name, SCORE));
        } else if !used.read.contains(name) && *name != SCORE {
            lint.report(Severity::Note, *at, words::never_read(name));
        }
    }
    let mut problems = lint.problems;
    problems.dedup();
    problems
}

/// Whether a name is that of the score, but for its spelling.
fn is_like_score(name: &str) -> bool {
    let is_letter = |c: &char| c.is_alphanumeric();
    let bare = |name: &str| -> String {
        let letters = name.chars().filter(is_letter);
        letters.flat_map(char::to_lowercase).collect()
    };
    bare(name) == bare(SCORE) || nearest(name, [SCORE]).is_some()
}

/// Whether a condition can never be true, by itself.
fn is_never(condition: &Condition, limit_ms: u32) -> bool {
    match condition {
        Condition::All(all) => all.iter().any(|one| is_never(one, limit_ms)),
        Condition::Any(any) => any.iter().all(|one| is_never(one, limit_ms)),
        Condition::Not(one) => matches!(**one, Condition::True),
        Condition::Timer { ms, .. } => i64::from(*ms) > i64::from(limit_ms),
        Condition::Using(_, condition) => is_never(condition, limit_ms),
        Condition::True
        | Condition::Compare(..)
        | Condition::Inside { .. }
        | Condition::SettedUp(_)
        | Condition::Dropped(_) => false,
    }
}

/// Events that may be alive at some time: those that are from the start, and those that another one of them sets up.
fn reached(rules: &Rules) -> BTreeSet<usize> {
    let is_first = |event: &Event| event.initially || event.id.starts_with(ON_SUCCESS);
    let mut reached = BTreeSet::new();
    let mut next: Vec<usize> = (0..rules.events.len())
        .filter(|&index| is_first(&rules.events[index]))
        .collect();
    while let Some(index) = next.pop() {
        if !reached.insert(index) {
            continue;
        }
        let event = &rules.events[index];
        let mut used = Used::default();
        used.condition(&event.condition);
        if !is_never(&event.condition, rules.time_limit_ms) {
            used.trigger(&event.trigger);
        }
        next.extend(used.sets_up);
    }
    reached
}

/// What rules name.
#[derive(Default)]
struct Used<'a> {
    sets_up: Vec<usize>,
    /// Variables that get a value, each where it does first.
    set: Vec<(&'a str, Start)>,
    known: HashSet<&'a str>,
    read: HashSet<&'a str>,
    succeeds: bool,
}

impl<'a> Used<'a> {
    fn condition(&mut self, condition: &'a Condition) {
        match condition {
            Condition::All(all) | Condition::Any(all) => {
                all.iter().for_each(|one| self.condition(one));
            }
            Condition::Not(one) => self.condition(one),
            Condition::Compare(_, operands) => operands.iter().for_each(|one| self.operand(one)),
            Condition::Using(triggers, condition) => {
                triggers.iter().for_each(|one| self.trigger(one));
                self.condition(condition);
            }
            Condition::True
            | Condition::Inside { .. }
            | Condition::SettedUp(_)
            | Condition::Dropped(_)
            | Condition::Timer { .. } => {}
        }
    }

    fn trigger(&mut self, trigger: &'a Trigger) {
        match trigger {
            Trigger::All(all) => all.iter().for_each(|one| self.trigger(one)),
            Trigger::Say(message) | Trigger::Log(message) => {
                message.filled.iter().for_each(|(_, one)| self.operand(one));
            }
            Trigger::SetVariable(name, at, value) => {
                self.operand(value);
                if self.known.insert(name) {
                    self.set.push((name, *at));
                }
            }
            Trigger::SetUp(named) => self.sets_up.extend(named.event),
            Trigger::SetState { value, .. } => self.operand(value),
            Trigger::Success { .. } => self.succeeds = true,
            Trigger::Fail(_) | Trigger::TimeOver | Trigger::Drop(_) => {}
        }
    }

    fn operand(&mut self, operand: &'a Operand) {
        match operand {
            Operand::Variable(path) | Operand::Either(path) => {
                self.read.extend(path.parts.first().map(|name| &**name));
            }
            Operand::Unary(_, one) => self.operand(one),
            Operand::Binary(_, both) => both.iter().for_each(|one| self.operand(one)),
            Operand::Constant(_) | Operand::State(_) | Operand::TypeOf(_) => {}
        }
    }
}

struct Lint<'a, 's> {
    rules: &'a Rules,
    scene: &'s mut dyn Catalogue,
    /// Names that may have been meant by others.
    names: Vec<String>,
    /// Those of regions among them, once somebody has asked.
    regions: Option<Vec<String>>,
    used: &'a Used<'a>,
    problems: Vec<Problem>,
    /// The event in which we are, and whether anything sets it up.
    event: Option<(&'a Event, bool)>,
}

/// How far a path could be followed.
enum Followed {
    /// To its end.
    Found(Value),
    /// Beyond what is there before a program runs.
    Later,
    /// It leads nowhere, and that has been told.
    Nowhere,
}

impl<'a> Lint<'a, '_> {
    /// What is wrong with the rules as a whole.
    fn task(&mut self, reached: &BTreeSet<usize>) {
        let limit = self.rules.time_limit_ms;
        let time_over = |event: &&Event| matches!(event.trigger, Trigger::TimeOver);
        let at = self
            .rules
            .events
            .iter()
            .find(time_over)
            .map(|event| event.at);
        if limit < limits::TIME_LIMIT_SHORT_MS {
            let words = words::short_limit(limit);
            self.report(Severity::Warning, at.unwrap_or_default(), words);
        }
        let can_succeed = reached.iter().any(|&index| {
            let event = &self.rules.events[index];
            let mut used = Used::default();
            used.condition(&event.condition);
            if !is_never(&event.condition, limit) {
                used.trigger(&event.trigger);
            }
            used.succeeds
        });
        if !can_succeed {
            self.report(
                Severity::Warning,
                at.unwrap_or_default(),
                words::no_success(),
            );
        }
    }

    fn report(&mut self, severity: Severity, at: Start, words: Words) {
        let is_dead = self.event.is_some_and(|(_, is_reached)| !is_reached);
        let problem = Problem {
            // What is never looked at does no harm.
            severity: if is_dead {
                severity.min(Severity::Warning)
            } else {
                severity
            },
            place: Place {
                block: self.event.map(|(event, _)| event.label.to_string()),
                offset: Some(at.0).filter(|&at| at > 0),
                ..Place::default()
            },
            words,
            hint: None,
        };
        keep(&mut self.problems, problem);
    }

    /// Tells that a name is nobody's, and whose it may be.
    fn unknown(
        &mut self,
        severity: Severity,
        at: Start,
        words: &Words,
        name: &str,
        known: &[String],
    ) {
        let near = did_you_mean(name, known.iter().map(String::as_str));
        self.report(severity, at, words::and(words, &near));
    }

    /// Whether more problems would be kept no longer, and looking for near names would only take time.
    fn is_full(&self) -> bool {
        self.problems.len() >= PROBLEMS_KEPT
    }

    fn condition(&mut self, condition: &'a Condition) {
        if self.is_full() {
            return;
        }
        match condition {
            Condition::All(all) | Condition::Any(all) => {
                all.iter().for_each(|one| self.condition(one));
            }
            Condition::Not(one) => self.condition(one),
            Condition::Compare(_, operands) => {
                self.class(operands);
                operands.iter().for_each(|one| self.operand(one));
            }
            Condition::Inside {
                object,
                region,
                point,
            } => {
                let Some(thing) = self.object(&object.text, object.at) else {
                    return;
                };
                let Some(place) = self.scene.find(&region.text) else {
                    let known = self.regions(thing);
                    let words = said::no_region(&region.text);
                    self.unknown(Severity::Error, region.at, &words, &region.text, &known);
                    return;
                };
                match self.scene.is_inside(thing, place, *point) {
                    Ok(_) => {}
                    Err(Unfit::NoRegion) => {
                        let words = said::not_a_region(&region.text);
                        self.report(Severity::Error, region.at, words);
                    }
                    Err(Unfit::NoPlace) => {
                        let words = said::not_matched(&object.text);
                        self.report(Severity::Error, object.at, words);
                    }
                }
            }
            Condition::Timer { ms, at, .. } => {
                let limit = self.rules.time_limit_ms;
                if i64::from(*ms) > i64::from(limit) {
                    self.report(Severity::Warning, *at, words::late_timer(*ms, limit));
                }
            }
            Condition::Using(triggers, condition) => {
                triggers.iter().for_each(|one| self.trigger(one));
                self.condition(condition);
            }
            // The reader has told events that are not there.
            Condition::True
            | Condition::SettedUp(Named { .. })
            | Condition::Dropped(Named { .. }) => {}
        }
    }

    fn trigger(&mut self, trigger: &'a Trigger) {
        if self.is_full() {
            return;
        }
        match trigger {
            Trigger::All(all) => all.iter().for_each(|one| self.trigger(one)),
            Trigger::Say(message) | Trigger::Log(message) => {
                message.filled.iter().for_each(|(_, one)| self.operand(one));
            }
            Trigger::SetVariable(_, _, value) => self.operand(value),
            Trigger::SetState {
                object,
                property,
                value,
            } => {
                self.operand(value);
                match self.follow(object) {
                    Followed::Found(Value::Object(found)) => self.settable(object, found, property),
                    // What is on a display is there when a program has drawn it.
                    Followed::Found(Value::Record(_)) | Followed::Later | Followed::Nowhere => {}
                    Followed::Found(value) => {
                        let words = said::no_state(value.type_name());
                        self.report(Severity::Error, object.at, words);
                    }
                }
            }
            Trigger::Fail(_)
            | Trigger::TimeOver
            | Trigger::Success { .. }
            | Trigger::SetUp(_)
            | Trigger::Drop(_) => {}
        }
    }

    fn settable(&mut self, path: &Path, object: Object, property: &str) {
        if self.scene.set_property(object, property, &Value::Null) {
            return;
        }
        let known: Vec<String> = self.known_properties(object);
        let words = said::no_settable(&path.text, property);
        self.unknown(Severity::Error, path.at, &words, property, &known);
    }

    fn operand(&mut self, operand: &'a Operand) {
        if self.is_full() {
            return;
        }
        match operand {
            Operand::Constant(_) => {}
            Operand::Variable(path) => {
                let name = path.parts.first().map_or("", |name| name);
                if !self.is_variable(name) {
                    let known = self.variables();
                    let words = words::never_set(name);
                    self.unknown(Severity::Warning, path.at, &words, name, &known);
                }
            }
            Operand::State(path) => {
                let _ = self.follow(path);
            }
            Operand::Either(path) => {
                let name = path.parts.first().map_or("", |name| name);
                if self.is_variable(name) || path.parts.is_empty() {
                    return;
                }
                if self.scene.find(name).is_some() || self.may_come(path) {
                    let _ = self.follow(path);
                    return;
                }
                let mut known = self.variables();
                known.extend(self.names.iter().cloned());
                let words = said::no_name(&path.text);
                self.unknown(Severity::Error, path.at, &words, name, &known);
            }
            Operand::TypeOf(name) => {
                if self.scene.find(&name.text).is_none() && !self.scene.may_come(&name.text) {
                    let known = self.names.clone();
                    let words = said::no_object(&name.text);
                    self.unknown(Severity::Warning, name.at, &words, &name.text, &known);
                }
            }
            Operand::Unary(_, one) => self.operand(one),
            Operand::Binary(_, both) => both.iter().for_each(|one| self.operand(one)),
        }
    }

    /// A class that nothing has.
    fn class(&mut self, operands: &[Operand; 2]) {
        let [left, right] = operands;
        let ((Operand::TypeOf(name), Operand::Constant(Value::Text(class)))
        | (Operand::Constant(Value::Text(class)), Operand::TypeOf(name))) = (left, right)
        else {
            return;
        };
        let known = self.scene.classes();
        if **class == *"undefined" || known.contains(&&**class) {
            return;
        }
        let known: Vec<String> = known.iter().map(|&one| one.to_owned()).collect();
        let words = words::no_class(class);
        self.unknown(Severity::Warning, name.at, &words, class, &known);
    }

    fn is_variable(&self, name: &str) -> bool {
        name == SCORE || self.used.known.contains(name)
    }

    fn variables(&self) -> Vec<String> {
        let known = self.used.set.iter().map(|(name, _)| (*name).to_owned());
        known.chain([SCORE.to_owned()]).collect()
    }

    /// The object of a name that stands alone.
    fn object(&mut self, name: &str, at: Start) -> Option<Object> {
        let found = self.scene.find(name);
        if found.is_none() {
            let known = self.names.clone();
            let (severity, words) = match self.scene.may_come(name) {
                true => (Severity::Warning, words::not_yet(name)),
                false => (Severity::Error, said::no_object(name)),
            };
            self.unknown(severity, at, &words, name, &known);
        }
        found
    }

    /// Names of all regions.
    fn regions(&mut self, thing: Object) -> Vec<String> {
        if let Some(regions) = &self.regions {
            return regions.clone();
        }
        let mut known = self.names.clone();
        known.retain(|name| {
            let place = self.scene.find(name);
            place.is_some_and(|place| {
                let inside = self.scene.is_inside(thing, place, ObjectPoint::Center);
                inside != Err(Unfit::NoRegion)
            })
        });
        self.regions = Some(known.clone());
        known
    }

    fn known_properties(&mut self, object: Object) -> Vec<String> {
        let known = self.scene.properties(object).into_iter();
        known.map(str::to_owned).collect()
    }

    /// Whether the device that a path begins with may be plugged in later.
    fn may_come(&self, path: &Path) -> bool {
        match &path.parts[..] {
            [one, other, ..] => self.scene.may_come(&format!("{one}.{other}")),
            _ => false,
        }
    }

    /// What stands at the end of a path; what is wrong with it is told.
    fn follow(&mut self, path: &Path) -> Followed {
        if path.parts.is_empty() {
            // The reader has told it.
            return Followed::Nowhere;
        }
        let Some((object, own)) = head(self.scene, path) else {
            let name = &path.parts[0];
            let known = self.names.clone();
            let words = said::no_object(name);
            self.unknown(Severity::Error, path.at, &words, name, &known);
            return Followed::Nowhere;
        };
        if own == 1 && self.may_come(path) {
            let name = path.parts[..2].join(".");
            self.report(Severity::Warning, path.at, words::not_yet(&name));
            return Followed::Later;
        }
        let mut value = Value::Object(object);
        for end in own..path.parts.len() {
            let found = self.scene.property(object, &path.parts[own..=end]);
            value = match (found, value) {
                (Ok(found), _) => found,
                // What will be in a list, or where there is nothing yet, only a run can say.
                (Err(_), Value::Null | Value::NoText) => return Followed::Later,
                (Err(_), Value::List(_)) if is_place(&path.parts[end]) => return Followed::Later,
                (Err(missing), before) => {
                    self.missing(path, end, &before, missing);
                    return Followed::Nowhere;
                }
            };
        }
        Followed::Found(value)
    }

    fn missing(&mut self, path: &Path, end: usize, before: &Value, missing: Missing) {
        let name = path.parts[..end].join(".");
        let part = &path.parts[end];
        match missing {
            Missing::Type(_) => self.report(Severity::Error, path.at, said::no_type(&name)),
            Missing::Property(_) => {
                let mut known = Vec::new();
                if let Value::Object(object) = before {
                    known = self.known_properties(*object);
                }
                if let Value::List(_) = before {
                    known.extend(["size", "isEmpty", "first", "last"].map(str::to_owned));
                }
                // A device that is misspelt looks like a property of its robot.
                let inside = format!("{name}.");
                let names = self.names.clone();
                let devices = names.iter().filter_map(|one| one.strip_prefix(&inside));
                known.extend(devices.map(str::to_owned));
                let words = said::no_property(&name, part);
                self.unknown(Severity::Error, path.at, &words, part, &known);
            }
        }
    }
}

/// Whether a name says which one of a list.
fn is_place(name: &str) -> bool {
    matches!(name, "first" | "last") || name.parse::<usize>().is_ok()
}
