//! Why a run ended as it did: which rule decided, what its conditions saw last, and how near rules came that never fired.
//!
//! Owns what is watched while a run is checked, and what is told of it afterwards. It only looks: nothing that it asks for
//! changes a variable, an event or a scene. A checker that was not told to explain has none of this.

use std::collections::BTreeSet;

use super::operand::Context;
use super::rules::{Comparison, Condition, Event, EventIndex, Kind, Named, Rules, Trigger};
use super::scene::{Object, Scene};
use super::spell;
use super::value::Value;
use crate::limits;
use lang_text::problem::Locale;

/// What a checker knows beyond its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The rule that decided, if one did; and if the time was over or the program ended, the rules that would have made it a
    /// success, or would have set up one that does, and never fired.
    pub rules: Vec<Explained>,
    /// Such rules that are left out.
    pub more: usize,
}

/// A rule after a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Explained {
    /// What it is.
    pub kind: Kind,
    /// Its id; empty for none.
    pub id: String,
    /// Its place among the rules of its kind in `constraints`, with templates put in, from 1.
    pub number: usize,
    /// Whether it decided the run.
    pub decided: bool,
    /// When it fired first, in milliseconds of model time.
    pub fired_ms: Option<u64>,
    /// How it stands at the end.
    pub state: Standing,
    /// Rules that set it up, by kind, id and number.
    pub set_up_by: Vec<(Kind, String, usize)>,
    /// Its conditions, as they were when it was looked at last.
    pub conditions: Vec<Seen>,
    /// Conditions that are left out.
    pub more: usize,
}

/// How a rule stands.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Standing {
    /// It is looked at in each tick.
    Alive,
    /// It was never set up.
    NeverSetUp,
    /// It was set up, and is gone.
    Dropped,
}

/// A condition, or the head of several.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// How deep it stands in others.
    pub depth: usize,
    /// As `robot1 inside finish` or `robot1.x > 100`.
    pub text: String,
    /// Whether it stands below a `not`, so that the rule needs it to be false.
    pub negated: bool,
    /// Whether it was true; none for a head, and for what could not be asked.
    pub holds: Option<bool>,
    /// The values that were compared, left and right.
    pub values: Vec<String>,
    /// How near it came to what the rule needs.
    pub nearest: Option<Near>,
}

/// The nearest approach of a condition to what its rule needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// How far it was, 0 if it was there.
    pub gap: f64,
    /// In what.
    pub unit: Unit,
    /// When, in milliseconds of model time: the first time that it was as near.
    pub at_ms: u64,
}

/// What a gap is measured in.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Unit {
    /// That of the compared values.
    Value,
    /// Pixels of the scene.
    Pixels,
    /// Milliseconds of model time.
    Milliseconds,
}

/// What is kept while a run is checked.
#[derive(Debug)]
pub(super) struct Watch {
    events: Vec<Watched>,
    /// Objects that were found, apart from those of the checker.
    found: Vec<Option<(Object, usize)>>,
}

#[derive(Clone, Debug, Default)]
struct Watched {
    fired_ms: Option<u64>,
    was_set_up: bool,
    leaves: Vec<Leaf>,
}

/// The last look at a condition.
#[derive(Clone, Debug, Default)]
struct Leaf {
    holds: Option<bool>,
    values: Vec<Value>,
    nearest: Option<Near>,
}

/// What a look at conditions needs.
struct Look<'a, 'b> {
    context: Context<'b>,
    rules: &'a Rules,
    is_alive: &'a dyn Fn(EventIndex) -> bool,
    /// Since when the event is set up.
    passed_ms: u64,
    now_ms: u64,
}

impl Watch {
    pub fn new(rules: &Rules) -> Self {
        let events = rules.events.iter().map(|event| Watched {
            was_set_up: event.initially,
            ..Watched::default()
        });
        Self {
            events: events.collect(),
            found: vec![None; rules.slots],
        }
    }

    pub fn fired(&mut self, event: EventIndex, now_ms: u64) {
        self.events[event].fired_ms.get_or_insert(now_ms);
    }

    pub fn was_set_up(&mut self, event: EventIndex) {
        self.events[event].was_set_up = true;
    }

    /// Looks at the conditions of an event, before it is checked.
    pub fn observe(
        &mut self,
        event: EventIndex,
        rules: &Rules,
        scene: &mut dyn Scene,
        variables: &mut std::collections::HashMap<Box<str>, Value>,
        is_alive: &dyn Fn(EventIndex) -> bool,
        times: [u64; 2],
    ) {
        let [now_ms, since_ms] = times;
        let mut look = Look {
            context: Context {
                scene,
                variables,
                found: &mut self.found,
                complaints: Vec::new(),
            },
            rules,
            is_alive,
            passed_ms: now_ms.saturating_sub(since_ms),
            now_ms,
        };
        let event_rules = &look.rules.events[event];
        let leaves = &mut self.events[event].leaves;
        let mut next = 0;
        look.condition(shown_condition(event_rules), false, leaves, &mut next);
    }

    /// What is told in the end.
    pub fn explain(
        &self,
        rules: &Rules,
        decider: Option<EventIndex>,
        is_open: bool,
        is_alive: &dyn Fn(EventIndex) -> bool,
        locale: Locale,
    ) -> Explanation {
        let mut wanted: Vec<EventIndex> = decider.into_iter().collect();
        if is_open {
            wanted.extend(
                self.unfired(rules)
                    .into_iter()
                    .filter(|one| Some(*one) != decider),
            );
        }
        let more = wanted.len().saturating_sub(limits::EXPLAINED_RULES_MAX);
        wanted.truncate(limits::EXPLAINED_RULES_MAX);
        let told = wanted.into_iter().map(|event| {
            let watched = &self.events[event];
            let mut conditions = Vec::new();
            let mut next = 0;
            let shown = shown_condition(&rules.events[event]);
            let into = (&mut next, &mut conditions);
            describe(shown, 0, false, &watched.leaves, into, locale);
            let more = conditions
                .len()
                .saturating_sub(limits::EXPLAINED_CONDITIONS_MAX);
            conditions.truncate(limits::EXPLAINED_CONDITIONS_MAX);
            let setters = set_up_by(rules, event);
            let name = |&one: &EventIndex| {
                let event = &rules.events[one];
                (event.kind, spell::cut(event.id.to_string()), event.number)
            };
            Explained {
                kind: rules.events[event].kind,
                id: spell::cut(rules.events[event].id.to_string()),
                number: rules.events[event].number,
                decided: Some(event) == decider,
                fired_ms: watched.fired_ms,
                state: match (is_alive(event), watched.was_set_up) {
                    (true, _) => Standing::Alive,
                    (false, true) => Standing::Dropped,
                    (false, false) => Standing::NeverSetUp,
                },
                set_up_by: setters
                    .iter()
                    .take(limits::EXPLAINED_RULES_MAX)
                    .map(name)
                    .collect(),
                conditions,
                more,
            }
        });
        Explanation {
            rules: told.collect(),
            more,
        }
    }

    /// Rules that would have made a success, and those that would have set them up, as far as they have not fired.
    fn unfired(&self, rules: &Rules) -> Vec<EventIndex> {
        let is_success = |trigger: &Trigger| matches!(trigger, Trigger::Success { .. });
        let all = 0..rules.events.len();
        let mut wanted: Vec<EventIndex> = all
            .filter(|&event| any(&rules.events[event].trigger, &is_success))
            .filter(|&event| self.events[event].fired_ms.is_none())
            .collect();
        let mut known: BTreeSet<EventIndex> = wanted.iter().copied().collect();
        let mut next = 0;
        while let Some(&event) = wanted.get(next) {
            next += 1;
            if self.events[event].was_set_up {
                continue;
            }
            for setter in set_up_by(rules, event) {
                if self.events[setter].fired_ms.is_none() && known.insert(setter) {
                    wanted.push(setter);
                }
            }
        }
        // What could have fired comes first.
        wanted.sort_by_key(|&event| !self.events[event].was_set_up);
        wanted
    }
}

/// The condition of an event as its author wrote it: that of a constraint without the `not` that makes it an event.
fn shown_condition(event: &Event) -> &Condition {
    match (&event.condition, event.kind) {
        (Condition::Not(inner), Kind::Constraint) => inner,
        (condition, _) => condition,
    }
}

/// Rules that set up another one.
fn set_up_by(rules: &Rules, wanted: EventIndex) -> Vec<EventIndex> {
    let is_it =
        |trigger: &Trigger| matches!(trigger, Trigger::SetUp(named) if named.event == Some(wanted));
    let all = 0..rules.events.len();
    all.filter(|&event| any(&rules.events[event].trigger, &is_it))
        .collect()
}

fn any(trigger: &Trigger, is_it: &dyn Fn(&Trigger) -> bool) -> bool {
    match trigger {
        Trigger::All(all) => all.iter().any(|one| any(one, is_it)),
        Trigger::Fail(_)
        | Trigger::TimeOver
        | Trigger::Success { .. }
        | Trigger::Say(_)
        | Trigger::Log(_)
        | Trigger::SetVariable(..)
        | Trigger::SetUp(_)
        | Trigger::Drop(_)
        | Trigger::SetState { .. } => is_it(trigger),
    }
}

/// Whether a condition says nothing: one that is always true, and the timer of a constraint that is checked once.
fn is_mute(condition: &Condition) -> bool {
    matches!(
        condition,
        Condition::True | Condition::Timer { ms: ..=0, .. }
    )
}

impl Look<'_, '_> {
    /// Looks at all conditions in one, in the order in which [`tell`] tells them.
    fn condition(
        &mut self,
        condition: &Condition,
        negated: bool,
        leaves: &mut Vec<Leaf>,
        next: &mut usize,
    ) {
        let leaf = match condition {
            _ if is_mute(condition) => return,
            Condition::True => return,
            Condition::All(all) | Condition::Any(all) => {
                for one in all {
                    self.condition(one, negated, leaves, next);
                }
                return;
            }
            Condition::Not(one) => return self.condition(one, !negated, leaves, next),
            // Its triggers are not carried out here: values are those before them.
            Condition::Using(_, one) => return self.condition(one, negated, leaves, next),
            Condition::Compare(comparison, operands) => {
                let [left, right] = &**operands;
                let holds = self.context.compare(*comparison, operands);
                let values = vec![self.context.value(left), self.context.value(right)];
                let gap = gap(*comparison, &values[0], &values[1], negated);
                (Some(holds), values, gap, Unit::Value)
            }
            Condition::Inside {
                object,
                region,
                point,
            } => {
                let (thing, place) = (self.context.object(object), self.context.object(region));
                let found = thing.zip(place);
                let holds = found.and_then(|(thing, place)| {
                    self.context.scene.is_inside(thing, place, *point).ok()
                });
                let gap = match (holds, negated) {
                    (Some(holds), negated) if holds != negated => Some(0.0),
                    (Some(false), false) => found.and_then(|(thing, place)| {
                        self.context.scene.distance(thing, place, *point)
                    }),
                    (Some(_) | None, _) => None,
                };
                (holds, Vec::new(), gap, Unit::Pixels)
            }
            Condition::SettedUp(named) => (self.alive(named, true), Vec::new(), None, Unit::Value),
            Condition::Dropped(named) => (self.alive(named, false), Vec::new(), None, Unit::Value),
            Condition::Timer { ms, .. } => {
                let passed = i32::try_from(self.passed_ms).unwrap_or(i32::MAX);
                let left = f64::from(ms.saturating_sub(passed).max(0));
                let gap = (!negated).then_some(left);
                let values = vec![Value::Int(passed), Value::Int(*ms)];
                (Some(passed >= *ms), values, gap, Unit::Milliseconds)
            }
        };
        let (holds, values, gap, unit) = leaf;
        if leaves.len() <= *next {
            leaves.push(Leaf::default());
        }
        let leaf = &mut leaves[*next];
        *next += 1;
        (leaf.holds, leaf.values) = (holds, values);
        let near = gap.filter(|gap| gap.is_finite()).map(|gap| Near {
            gap,
            unit,
            at_ms: self.now_ms,
        });
        if let Some(near) = near
            && leaf.nearest.is_none_or(|old| near.gap < old.gap)
        {
            leaf.nearest = Some(near);
        }
    }

    fn alive(&self, named: &Named, wanted: bool) -> Option<bool> {
        named.event.map(|event| (self.is_alive)(event) == wanted)
    }
}

/// How far two values are from comparing as a rule needs it; none where there is no distance.
fn gap(comparison: Comparison, left: &Value, right: &Value, negated: bool) -> Option<f64> {
    let (left, right) = (number(left)?, number(right)?);
    let (below, above) = ((right - left).max(0.0), (left - right).max(0.0));
    match (comparison, negated) {
        (Comparison::Equals, false) | (Comparison::NotEqual, true) => Some((left - right).abs()),
        (Comparison::Equals, true) | (Comparison::NotEqual, false) => None,
        (Comparison::Greater | Comparison::NotLess, false) => Some(below),
        (Comparison::Less | Comparison::NotGreater, false) => Some(above),
        (Comparison::Greater | Comparison::NotLess, true) => Some(above),
        (Comparison::Less | Comparison::NotGreater, true) => Some(below),
    }
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Int(number) => Some(f64::from(*number)),
        Value::Double(number) => Some(*number),
        Value::Null
        | Value::Bool(_)
        | Value::NoText
        | Value::Text(_)
        | Value::Point(_)
        | Value::Place(_)
        | Value::Rect(_)
        | Value::Colour(_)
        | Value::Opaque
        | Value::List(_)
        | Value::Record(_)
        | Value::Object(_) => None,
    }
}

/// Describes conditions with what was seen of them.
fn describe(
    condition: &Condition,
    depth: usize,
    negated: bool,
    leaves: &[Leaf],
    (next, into): (&mut usize, &mut Vec<Seen>),
    locale: Locale,
) {
    match condition {
        _ if is_mute(condition) => {}
        Condition::True => {}
        Condition::All(all) | Condition::Any(all) => {
            // What stands below a `not` is told with the `not` at each condition, so that "and" and "or" change places.
            let is_or = matches!(condition, Condition::Any(_)) != negated;
            let shown = all.iter().filter(|one| !is_mute(one)).count();
            // At the top it goes without saying that all are needed.
            let needs_head = shown > 1 && (depth > 0 || is_or);
            if needs_head {
                into.push(Seen {
                    depth,
                    text: if is_or { "or" } else { "and" }.to_owned(),
                    negated: false,
                    holds: None,
                    values: Vec::new(),
                    nearest: None,
                });
            }
            for one in all {
                let depth = depth + usize::from(needs_head);
                describe(one, depth, negated, leaves, (next, into), locale);
            }
        }
        Condition::Not(one) => describe(one, depth, !negated, leaves, (next, into), locale),
        Condition::Using(_, one) => describe(one, depth, negated, leaves, (next, into), locale),
        Condition::Compare(..)
        | Condition::Inside { .. }
        | Condition::SettedUp(_)
        | Condition::Dropped(_)
        | Condition::Timer { .. } => {
            let seen = leaves.get(*next).cloned().unwrap_or_default();
            *next += 1;
            into.push(Seen {
                depth,
                text: spell::condition(condition, locale),
                negated,
                holds: seen.holds,
                values: seen
                    .values
                    .iter()
                    .map(|value| spell::value(value, locale))
                    .collect(),
                nearest: seen.nearest,
            });
        }
    }
}
