//! Constraints that are broken before a program can do anything.
//!
//! Owns what of a condition is certain at the start: where things are, unless rules move them.

use super::super::rules::{Condition, Event, Kind, Name, Trigger};
use super::{Lint, words};
use lang_text::problem::Severity;

impl<'a> Lint<'a, '_> {
    /// Tells of a constraint that fails every solution at its first check.
    pub(super) fn start(&mut self, event: &'a Event) {
        let (Kind::Constraint, Condition::Not(needed)) = (event.kind, &event.condition) else {
            return;
        };
        if let Some((object, region, is_inside)) = self.broken(needed, true) {
            let words = words::broken_at_start(&object.text, &region.text, is_inside);
            self.report(Severity::Warning, event.at, words);
        }
    }

    /// The object and the region because of which a condition is not as it is wanted at the start, and whether the object
    /// is in the region; none if it is, or if that is not certain.
    fn broken(
        &mut self,
        condition: &'a Condition,
        wanted: bool,
    ) -> Option<(&'a Name, &'a Name, bool)> {
        match condition {
            Condition::All(all) | Condition::Any(all) => {
                let is_and = matches!(condition, Condition::All(_)) == wanted;
                let mut found = None;
                for one in all {
                    match (is_and, self.broken(one, wanted)) {
                        (true, Some(broken)) => return Some(broken),
                        (false, None) => return None,
                        (true, None) => {}
                        (false, broken) => found = found.or(broken),
                    }
                }
                found
            }
            Condition::Not(one) => self.broken(one, !wanted),
            Condition::Inside {
                object,
                region,
                point,
            } => {
                if self.is_moved(&object.text) || self.is_moved(&region.text) {
                    return None;
                }
                let thing = self.scene.find(&object.text)?;
                let place = self.scene.find(&region.text)?;
                let is_inside = self.scene.is_inside(thing, place, *point).ok()?;
                (is_inside != wanted).then_some((object, region, is_inside))
            }
            Condition::True
            | Condition::Compare(..)
            | Condition::Using(..)
            | Condition::SettedUp(_)
            | Condition::Dropped(_)
            | Condition::Timer { .. } => None,
        }
    }

    /// Whether a rule sets a property of an object.
    fn is_moved(&self, name: &str) -> bool {
        let events = self.rules.events.iter();
        let mut triggers: Vec<&Trigger> = events.map(|event| &event.trigger).collect();
        while let Some(trigger) = triggers.pop() {
            match trigger {
                Trigger::All(all) => triggers.extend(all.iter()),
                Trigger::SetState { object, .. } => {
                    if object.parts.first().is_some_and(|part| **part == *name) {
                        return true;
                    }
                }
                Trigger::Fail(_)
                | Trigger::TimeOver
                | Trigger::Success { .. }
                | Trigger::Say(_)
                | Trigger::Log(_)
                | Trigger::SetVariable(..)
                | Trigger::SetUp(_)
                | Trigger::Drop(_) => {}
            }
        }
        false
    }
}
