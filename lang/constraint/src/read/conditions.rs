//! Conditions read.

use super::super::rules::{Comparison, Condition};
use super::super::scene::ObjectPoint;
use super::super::words;
use super::{Reader, is};
use lang_text::xml::Element;

impl Reader {
    /// A condition in whatever tag; true where it cannot be read, and then there is a problem.
    pub(super) fn condition(&mut self, element: &Element<'_>) -> Condition {
        let read = self.inside(element, |reader| reader.condition_inside(element));
        read.unwrap_or(Condition::True)
    }

    fn condition_inside(&mut self, element: &Element<'_>) -> Option<Condition> {
        let tag = element.name.to_ascii_lowercase();
        match tag.as_str() {
            "condition" => {
                self.known(element, &[]);
                let [child] = self.exactly(element)?;
                Some(self.condition(child))
            }
            "conditions" => self.conditions(element),
            "not" => {
                self.known(element, &[]);
                let [child] = self.exactly(element)?;
                Some(Condition::Not(Box::new(self.condition(child))))
            }
            "true" => {
                self.known(element, &[]);
                Some(Condition::True)
            }
            "equals" => self.compare(element, Comparison::Equals),
            "greater" => self.compare(element, Comparison::Greater),
            "less" => self.compare(element, Comparison::Less),
            "notgreater" => self.compare(element, Comparison::NotGreater),
            "notless" => self.compare(element, Comparison::NotLess),
            "inside" => self.inside_region(element),
            "settedup" => self.named(element).map(Condition::SettedUp),
            "dropped" => self.named(element).map(Condition::Dropped),
            "timer" => {
                self.known(element, &["timeout", "forceDropOnTimeout"]);
                let ms = self.whole(element, "timeout");
                let drops = self.yes_or_no(element, "forceDropOnTimeout", true);
                Some(Condition::Timer {
                    ms: ms?,
                    drops,
                    at: element.start,
                })
            }
            "using" => self.using(element),
            _ if tag.starts_with("notequal") => self.compare(element, Comparison::NotEqual),
            _ => {
                self.unknown(&element.name, words::unknown_tag(&element.name));
                None
            }
        }
    }

    fn conditions(&mut self, element: &Element<'_>) -> Option<Condition> {
        self.known(element, &["glue"]);
        let children = self.at_least(element, 1)?;
        let glue = self.filled(element, "glue")?;
        let is_and = match glue.to_ascii_lowercase().as_str() {
            "and" => true,
            "or" => false,
            _ => {
                self.error(words::glue());
                return None;
            }
        };
        if let [child] = children[..]
            && !is(child, "condition")
            && !is(child, "conditions")
        {
            self.warn(words::one_condition());
        }
        let all = children.into_iter().map(|child| self.condition(child));
        let all = all.collect();
        Some(if is_and {
            Condition::All(all)
        } else {
            Condition::Any(all)
        })
    }

    fn compare(&mut self, element: &Element<'_>, comparison: Comparison) -> Option<Condition> {
        let operands = self.operands(element, &[])?;
        Some(Condition::Compare(comparison, Box::new(operands)))
    }

    fn inside_region(&mut self, element: &Element<'_>) -> Option<Condition> {
        self.known(element, &["objectId", "regionId", "objectPoint"]);
        let object = self.filled(element, "objectId")?;
        let region = self.filled(element, "regionId")?;
        let point = match element.attribute("objectPoint") {
            None | Some("center") => ObjectPoint::Center,
            Some("all") => ObjectPoint::All,
            Some("any") => ObjectPoint::Any,
            Some(other) => {
                self.warn(words::object_point(other));
                ObjectPoint::Center
            }
        };
        Some(Condition::Inside {
            object: self.name(object),
            region: self.name(region),
            point,
        })
    }

    fn using(&mut self, element: &Element<'_>) -> Option<Condition> {
        self.known(element, &[]);
        let children = self.at_least(element, 2)?;
        let mut triggers = Vec::new();
        let mut result = None;
        for child in children {
            if !is(child, "return") {
                triggers.push(self.trigger(child));
                continue;
            }
            if result.is_some() {
                self.error(words::two_returns());
                return None;
            }
            let condition = self.inside(child, |reader| {
                reader.known(child, &[]);
                let [inner] = reader.exactly(child)?;
                Some(reader.condition(inner))
            });
            result = Some(condition.unwrap_or(Condition::True));
        }
        let Some(result) = result else {
            self.error(words::no_return());
            return None;
        };
        Some(Condition::Using(triggers.into(), Box::new(result)))
    }
}
