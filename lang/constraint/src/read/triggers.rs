//! Triggers read.

use std::collections::BTreeMap;

use super::super::rules::{Message, Operand, Trigger};
use super::super::words;
use super::{Reader, is};
use lang_text::xml::Element;

impl Reader {
    /// A trigger in whatever tag; one that does nothing where it cannot be read, and then there is a problem.
    pub(super) fn trigger(&mut self, element: &Element<'_>) -> Trigger {
        let read = self.inside(element, |reader| reader.trigger_inside(element));
        read.unwrap_or(Trigger::All([].into()))
    }

    /// All triggers in a tag.
    pub(super) fn triggers(&mut self, element: &Element<'_>) -> Trigger {
        let children = self.at_least(element, 1).unwrap_or_default();
        Trigger::All(children.into_iter().map(|one| self.trigger(one)).collect())
    }

    fn trigger_inside(&mut self, element: &Element<'_>) -> Option<Trigger> {
        match element.name.to_ascii_lowercase().as_str() {
            "trigger" => {
                self.known(element, &[]);
                let [child] = self.exactly(element)?;
                Some(self.trigger(child))
            }
            "triggers" => {
                self.known(element, &[]);
                Some(self.triggers(element))
            }
            "fail" => {
                self.known(element, &["message"]);
                let message = self.filled(element, "message")?;
                Some(Trigger::Fail(message.into()))
            }
            "success" => {
                self.known(element, &["deferred"]);
                let deferred = self.yes_or_no(element, "deferred", false);
                Some(Trigger::Success { deferred })
            }
            "message" => self.message(element).map(Trigger::Say),
            "log" => self.message(element).map(Trigger::Log),
            "setter" => {
                let name = self.filled(element, "name")?;
                let [value] = self.operands(element, &["name"])?;
                Some(Trigger::SetVariable(name.into(), element.start, value))
            }
            "setup" => self.named(element).map(Trigger::SetUp),
            "drop" => self.named(element).map(Trigger::Drop),
            "setstate" => {
                let object = self.filled(element, "object")?;
                let property = self.filled(element, "property")?;
                let [value] = self.operands(element, &["object", "property"])?;
                Some(Trigger::SetState {
                    object: self.path(object),
                    property: property.into(),
                    value,
                })
            }
            _ => {
                self.unknown(&element.name, words::unknown_tag(&element.name));
                None
            }
        }
    }

    /// A text with `%name%`, which a tag `replace` fills, and `${path}`: first the ones, then the others, each by name.
    fn message(&mut self, element: &Element<'_>) -> Option<Message> {
        self.known(element, &["text"]);
        let text = self.filled(element, "text")?;
        let mut named: BTreeMap<String, Operand> = BTreeMap::new();
        self.stray_text(element);
        for child in element.elements() {
            let read = self.inside(child, |reader| {
                if !is(child, "replace") {
                    reader.unknown(&child.name, words::unknown_tag(&child.name));
                    return None;
                }
                let name = reader.filled(child, "var")?;
                let [value] = reader.operands(child, &["var"])?;
                Some((name, value))
            });
            let (name, value) = read?;
            named.insert(format!("%{name}%"), value);
        }
        let mut inline: BTreeMap<String, Operand> = BTreeMap::new();
        let mut rest = text;
        while let Some((_, after)) = rest.split_once("${") {
            let Some((inside, after)) = after.split_once('}') else {
                break;
            };
            rest = after;
            let path = self.path(inside);
            inline.insert(format!("${{{inside}}}"), Operand::Either(path));
        }
        let filled = named.into_iter().chain(inline);
        Some(Message {
            text: text.into(),
            filled: filled
                .map(|(place, value)| (place.into_boxed_str(), value))
                .collect(),
        })
    }
}
