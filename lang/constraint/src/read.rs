//! Constraints read: the element `constraints` to [`Rules`].
//!
//! Owns what events, constraints and the time limit are, and in which order events are checked. Conditions, triggers and
//! values are read by its parts. Names of tags may be written in any case, names of attributes not, as in the original;
//! where that fails without a word, here is a problem with its place.

mod conditions;
mod triggers;
mod values;

use std::cmp::Reverse;
use std::collections::HashMap;

use super::expand::{self, Expanded};
use super::lint::words as near;
use super::rules::{Condition, Event, EventIndex, Kind, Named, Rules, Trigger};
use super::words;
use crate::limits;
use lang_text::limits::PROBLEMS_KEPT;
use lang_text::near::{did_you_mean, nearest};
use lang_text::problem::{Place, Problem, Severity, Words, keep};
use lang_text::xml::{Element, Node, Start};

/// Reads constraints; templates stand in an element `templates` in them, if anywhere.
///
/// # Errors
/// All that is wrong, as far as one reading finds it: unknown tags, missing, empty and unreadable attributes, wrong numbers
/// of children (a comment counts as a child where the original counts it), ids that stand twice, no time limit or two,
/// templates that are unknown, recursive or no XML, and anything above the limits. Problems of severity warning are with
/// them.
pub fn read(constraints: &Element<'_>) -> Result<Rules, Vec<Problem>> {
    read_with_templates(constraints, &[])
}

/// Reads constraints that may use the templates which the texts of a save declare. What is wrong with one of those is among
/// [`Rules::faults`] and keeps nothing else from working.
///
/// # Errors
/// As those of [`read()`].
pub fn read_with_templates(
    constraints: &Element<'_>,
    templates: &[&str],
) -> Result<Rules, Vec<Problem>> {
    if !is(constraints, "constraints") {
        let words = words::in_rules(&words::not_constraints());
        return Err(vec![Problem::error(words)]);
    }
    let Expanded {
        constraints: expanded,
        faults,
    } = expand::expand(constraints, templates)?;
    match Reader::default().constraints(expanded.as_ref().unwrap_or(constraints)) {
        Ok(rules) => Ok(Rules { faults, ..rules }),
        Err(problems) => Err(faults.into_iter().chain(problems).collect()),
    }
}

/// Whether a tag has a name, in whatever case.
fn is(element: &Element<'_>, name: &str) -> bool {
    element.name.eq_ignore_ascii_case(name)
}

/// Where an event stands in the order of checks, before its place in the text: ids descend by UTF-16.
fn order(element: &Element<'_>) -> Reverse<Vec<u16>> {
    let id = if is_init(element) {
        ""
    } else {
        match element.attribute("id") {
            None | Some("") => "{",
            Some(id) => id,
        }
    };
    Reverse(id.encode_utf16().collect())
}

fn is_init(element: &Element<'_>) -> bool {
    is(element, "init") || is(element, "initialization")
}

#[derive(Default)]
struct Reader {
    problems: Vec<Problem>,
    /// Tags on the way to where we are.
    path: Vec<String>,
    /// Where the tag stands in which we are.
    at: Start,
    /// Events by their ids.
    ids: HashMap<String, EventIndex>,
    objects: Vec<Box<str>>,
    slots: usize,
    tags: usize,
    time_limit_ms: Option<u32>,
    has_init: bool,
}

impl Reader {
    fn constraints(mut self, element: &Element<'_>) -> Result<Rules, Vec<Problem>> {
        let tops: Vec<_> = element.elements().collect();
        if tops.len() > limits::CONSTRAINT_EVENTS_MAX {
            self.error(words::too_many_events());
            return Err(self.problems);
        }
        let mut sorted: Vec<_> = (0..tops.len()).collect();
        sorted.sort_by_cached_key(|&top| order(tops[top]));
        let mut places = vec![0; tops.len()];
        for (index, &top) in sorted.iter().enumerate() {
            places[top] = index;
        }
        for (top, element) in tops.iter().enumerate() {
            let id = element.attribute("id").unwrap_or_default();
            if !id.is_empty()
                && !is_init(element)
                && self.ids.insert(id.to_owned(), places[top]).is_some()
            {
                self.at = element.start;
                let before = self.problems.len();
                self.error(words::duplicate(id));
                if self.problems.len() > before
                    && let Some(told) = self.problems.last_mut()
                {
                    told.hint = Some(near::rename());
                }
            }
        }
        let mut events: Vec<Option<Event>> = Vec::new();
        events.resize_with(tops.len(), || None);
        let mut counts: HashMap<String, usize> = HashMap::new();
        for (top, element) in tops.iter().enumerate() {
            let id = element.attribute("id").unwrap_or_default();
            let number = counts.entry(element.name.to_ascii_lowercase()).or_default();
            *number += 1;
            let number = *number;
            self.at = element.start;
            self.path.push(if id.is_empty() {
                format!("{} ({})", element.name, top + 1)
            } else {
                format!("{} '{id}'", element.name)
            });
            events[places[top]] = self.top(element, number);
            self.path.pop();
        }
        self.at = element.start;
        self.stray_text(element);
        if self.time_limit_ms.is_none() && !self.has_error() {
            self.error(words::no_time_limit());
        }
        if self.has_error() {
            return Err(self.problems);
        }
        Ok(Rules {
            events: events.into_iter().flatten().collect(),
            objects: self.objects,
            slots: self.slots,
            warnings: self.problems,
            faults: Vec::new(),
            time_limit_ms: self.time_limit_ms.unwrap_or_default(),
        })
    }

    fn has_error(&self) -> bool {
        let mut problems = self.problems.iter();
        problems.any(|problem| problem.severity == Severity::Error)
    }

    fn top(&mut self, element: &Element<'_>, number: usize) -> Option<Event> {
        self.count();
        match element.name.to_ascii_lowercase().as_str() {
            "event" => self.event(element, number),
            "constraint" => self.constraint(element, number),
            "timelimit" => self.time_limit(element, number),
            "init" | "initialization" => {
                if std::mem::replace(&mut self.has_init, true) {
                    self.error(words::two_inits());
                }
                self.known(element, &[]);
                let trigger = self.triggers(element);
                Some(Event {
                    kind: Kind::Init,
                    number,
                    id: "".into(),
                    label: self.label(),
                    at: element.start,
                    initially: true,
                    drops: true,
                    condition: Condition::True,
                    trigger,
                })
            }
            _ => {
                self.unknown(&element.name, words::unknown_tag(&element.name));
                None
            }
        }
    }

    /// The tag and id of the event in which we are.
    fn label(&self) -> Box<str> {
        self.path.first().map_or("", |label| label).into()
    }

    fn event(&mut self, element: &Element<'_>, number: usize) -> Option<Event> {
        self.known(element, &["id", "settedUpInitially", "dropsOnFire"]);
        let [first, second] = self.exactly(element)?;
        let is_condition = |one: &Element<'_>| is(one, "condition") || is(one, "conditions");
        let (condition, trigger) = if is_condition(first) {
            (first, second)
        } else {
            (second, first)
        };
        if !is_condition(condition) {
            self.error(words::no_condition(&condition.name));
            return None;
        }
        if !is(trigger, "trigger") && !is(trigger, "triggers") {
            self.error(words::no_trigger(&trigger.name));
            return None;
        }
        let initially = self.yes_or_no(element, "settedUpInitially", false);
        let drops = self.yes_or_no(element, "dropsOnFire", true);
        // What is wrong with triggers is told before what is wrong with the condition, as there.
        let trigger = self.trigger(trigger);
        let condition = self.condition(condition);
        Some(Event {
            kind: Kind::Event,
            number,
            id: element.attribute("id").unwrap_or_default().into(),
            label: self.label(),
            at: element.start,
            initially,
            drops,
            condition,
            trigger,
        })
    }

    /// A constraint is an event that fails the task when its condition is not true.
    fn constraint(&mut self, element: &Element<'_>, number: usize) -> Option<Event> {
        self.known(element, &["id", "failMessage", "checkOnce"]);
        let [child] = self.exactly(element)?;
        let message: Box<str> = self.filled(element, "failMessage")?.into();
        let condition = self.condition(child);
        let once = element.attribute("checkOnce").unwrap_or("false");
        if !once.eq_ignore_ascii_case("true") && !once.eq_ignore_ascii_case("false") {
            self.warn(words::check_once(once));
        }
        let condition = if once.eq_ignore_ascii_case("true") {
            // A timer of nothing drops the event at its first check, which may fire all the same.
            let timer = Condition::Timer {
                ms: 0,
                drops: true,
                at: element.start,
            };
            Condition::All([timer, condition].into())
        } else {
            condition
        };
        Some(Event {
            kind: Kind::Constraint,
            number,
            id: element.attribute("id").unwrap_or_default().into(),
            label: self.label(),
            at: element.start,
            initially: true,
            drops: true,
            condition: Condition::Not(Box::new(condition)),
            trigger: Trigger::Fail(message),
        })
    }

    fn time_limit(&mut self, element: &Element<'_>, number: usize) -> Option<Event> {
        self.known(element, &["id", "value"]);
        let ms = self.whole(element, "value")?;
        let Ok(limit) = u32::try_from(ms) else {
            self.error(words::negative(ms));
            return None;
        };
        if self.time_limit_ms.replace(limit).is_some() {
            self.error(words::two_time_limits());
        }
        Some(Event {
            kind: Kind::TimeLimit,
            number,
            id: element.attribute("id").unwrap_or_default().into(),
            label: self.label(),
            at: element.start,
            initially: true,
            drops: true,
            condition: Condition::Timer {
                ms,
                drops: true,
                at: element.start,
            },
            trigger: Trigger::TimeOver,
        })
    }

    /// The event that an attribute `id` names.
    fn named(&mut self, element: &Element<'_>) -> Option<Named> {
        self.known(element, &["id"]);
        let id = self.filled(element, "id")?;
        let event = self.ids.get(id).copied();
        if event.is_none() {
            // Looking for a near name takes time, and more problems are kept no longer.
            let known = self.ids.keys().map(String::as_str);
            let is_full = self.problems.len() >= PROBLEMS_KEPT;
            let near = did_you_mean(
                id,
                known.take(if is_full { 0 } else { limits::NAMES_COMPARED }),
            );
            self.warn(near::and(&words::no_event(id), &near));
        }
        Some(Named {
            id: id.into(),
            event,
        })
    }

    // What is the same for all tags.

    fn problem(&mut self, severity: Severity, words: Words) {
        let problem = Problem {
            severity,
            place: Place {
                block: (!self.path.is_empty()).then(|| self.path.join(" > ")),
                offset: Some(self.at.0).filter(|&at| at > 0),
                ..Place::default()
            },
            words,
            hint: None,
        };
        keep(&mut self.problems, problem);
    }

    fn error(&mut self, words: Words) {
        self.problem(Severity::Error, words::in_rules(&words));
    }

    /// A tag that means nothing here, and what it may have been meant to be.
    fn unknown(&mut self, tag: &str, words: Words) {
        let before = self.problems.len();
        self.error(words);
        if self.problems.len() > before
            && let Some(known) = nearest(&tag.to_ascii_lowercase(), expand::LANGUAGE)
            && let Some(told) = self.problems.last_mut()
        {
            told.hint = Some(near::meant(known));
        }
    }

    fn warn(&mut self, words: Words) {
        self.problem(Severity::Warning, words);
    }

    /// Counts one more tag; false if there are too many.
    fn count(&mut self) -> bool {
        self.tags += 1;
        if self.tags == limits::CONSTRAINT_TAGS_MAX + 1 {
            self.error(words::too_many_tags());
        }
        self.tags <= limits::CONSTRAINT_TAGS_MAX
    }

    /// Does something one tag deeper, unless that is too deep or too much.
    fn inside<T>(
        &mut self,
        element: &Element<'_>,
        read: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T> {
        if !self.count() {
            return None;
        }
        if self.path.len() >= limits::CONSTRAINT_DEPTH_MAX {
            self.error(words::too_deep());
            return None;
        }
        self.path.push(element.name.to_string());
        let outside = std::mem::replace(&mut self.at, element.start);
        let found = read(self);
        self.at = outside;
        self.path.pop();
        found
    }

    /// The children of a tag that must have so many; comments and text count, as in the original.
    fn exactly<'e, 'x, const N: usize>(
        &mut self,
        element: &'e Element<'x>,
    ) -> Option<[&'e Element<'x>; N]> {
        let found: Vec<_> = element.elements().collect();
        let nodes = element.nodes.len();
        match <[_; N]>::try_from(found) {
            Ok(found) if nodes == N => Some(found),
            _ => {
                self.error(words::children(&element.name, N));
                let any = |kind: fn(&Node<'_>) -> bool| element.nodes.iter().any(kind);
                if any(|node| matches!(node, Node::Comment(_))) {
                    self.warn(words::comment_counts(&element.name));
                }
                if any(|node| matches!(node, Node::Text(_))) {
                    self.warn(words::stray(&element.name));
                }
                None
            }
        }
    }

    /// The children of a tag that must have at least so many.
    fn at_least<'e, 'x>(
        &mut self,
        element: &'e Element<'x>,
        count: usize,
    ) -> Option<Vec<&'e Element<'x>>> {
        self.stray_text(element);
        let found: Vec<_> = element.elements().collect();
        if found.len() < count {
            self.error(words::more_children(&element.name, count));
            return None;
        }
        Some(found)
    }

    fn stray_text(&mut self, element: &Element<'_>) {
        let mut nodes = element.nodes.iter();
        if nodes.any(|node| matches!(node, Node::Text(_))) {
            self.warn(words::stray(&element.name));
        }
    }

    /// Warns of attributes that a tag does not know.
    fn known(&mut self, element: &Element<'_>, known: &[&str]) {
        for (name, _) in &element.attributes {
            if known.contains(&&**name) {
                continue;
            }
            let near = known.iter().find(|known| is_near(known, name));
            let words = words::strange_attribute(&element.name, name, near.copied());
            self.warn(words);
        }
    }

    /// An attribute that must be there.
    fn present<'e>(&mut self, element: &'e Element<'_>, name: &str) -> Option<&'e str> {
        let value = element.attribute(name);
        if value.is_none() {
            self.error(words::no_attribute(&element.name, name));
        }
        value
    }

    /// An attribute that must be there and not be empty.
    fn filled<'e>(&mut self, element: &'e Element<'_>, name: &str) -> Option<&'e str> {
        let value = self.present(element, name)?;
        if value.is_empty() {
            self.error(words::empty_attribute(&element.name, name));
            return None;
        }
        Some(value)
    }

    fn whole(&mut self, element: &Element<'_>, name: &str) -> Option<i32> {
        let text = self.filled(element, name)?;
        let number = text.trim().parse().ok();
        if number.is_none() {
            self.error(words::not_whole(text));
        }
        number
    }

    fn yes_or_no(&mut self, element: &Element<'_>, name: &str, default: bool) -> bool {
        match element.attribute(name) {
            None => default,
            Some(text) if text.eq_ignore_ascii_case("true") => true,
            Some(text) if text.eq_ignore_ascii_case("false") => false,
            Some(text) => {
                self.error(words::not_yes_or_no(text));
                default
            }
        }
    }
}

/// Whether one name may be meant by another: the same in another case, or with one letter more, less or other.
fn is_near(known: &str, found: &str) -> bool {
    if known.eq_ignore_ascii_case(found) {
        return true;
    }
    let (known, found) = (known.as_bytes(), found.as_bytes());
    let head = known.iter().zip(found).take_while(|(a, b)| a == b).count();
    let (known, found) = (&known[head..], &found[head..]);
    let tails = known.iter().rev().zip(found.iter().rev());
    let tail = tails.take_while(|(a, b)| a == b).count();
    known.len() - tail <= 1 && found.len() - tail <= 1
}
