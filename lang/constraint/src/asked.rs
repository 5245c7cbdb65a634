//! What rules ask a scene for, all of it, told before any run.
//!
//! Owns the walk over rules. A scene that can say only some of its things, as one behind a recording, is held against this
//! list, so that nothing is judged by a value that nobody knows. Objects are found as a run finds them.

use super::operand::head;
use super::rules::{Condition, Name, Operand, Path, Rules, Trigger, Unary};
use super::scene::{Object, Scene};

/// What rules want of an object.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Wish {
    /// To know a property.
    Property,
    /// To know where it is.
    Place,
    /// To change a property.
    Change,
}

/// Something that rules ask for.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Asked {
    /// Tag and id of the rule.
    pub rule: String,
    /// As it is written.
    pub text: String,
    /// Whose it is.
    pub object: Object,
    /// The names after those of the object; none if the object itself is meant.
    pub chain: Vec<Box<str>>,
    /// What of it.
    pub wish: Wish,
}

/// All that rules ask for, in the order of events; what no object of the scene is meant by is left out, as it is by a run.
pub fn asked(rules: &Rules, scene: &mut dyn Scene) -> Vec<Asked> {
    let mut walk = Walk {
        scene,
        rule: "",
        found: Vec::new(),
    };
    for event in &rules.events {
        walk.rule = &event.label;
        walk.condition(&event.condition);
        walk.trigger(&event.trigger);
    }
    walk.found
}

struct Walk<'a, 's> {
    scene: &'s mut dyn Scene,
    rule: &'a str,
    found: Vec<Asked>,
}

impl<'a> Walk<'a, '_> {
    fn condition(&mut self, condition: &'a Condition) {
        match condition {
            Condition::All(all) | Condition::Any(all) => {
                all.iter().for_each(|one| self.condition(one));
            }
            Condition::Not(one) => self.condition(one),
            Condition::Compare(_, operands) => operands.iter().for_each(|one| self.operand(one)),
            Condition::Inside { object, region, .. } => {
                self.place(object);
                self.place(region);
            }
            Condition::Using(triggers, condition) => {
                triggers.iter().for_each(|one| self.trigger(one));
                self.condition(condition);
            }
            Condition::True
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
            Trigger::SetVariable(_, _, value) => self.operand(value),
            Trigger::SetState {
                object,
                property,
                value,
            } => {
                self.operand(value);
                self.path(object, Some(property));
            }
            Trigger::Fail(_)
            | Trigger::TimeOver
            | Trigger::Success { .. }
            | Trigger::SetUp(_)
            | Trigger::Drop(_) => {}
        }
    }

    fn operand(&mut self, operand: &'a Operand) {
        match operand {
            Operand::State(path) | Operand::Either(path) => self.path(path, None),
            Operand::Unary(Unary::BoundingRect, one) => match &**one {
                Operand::State(path) | Operand::Either(path) => {
                    if let Some((object, _)) = head(self.scene, path) {
                        self.add(&path.text, object, &[], Wish::Place);
                    }
                }
                other @ (Operand::Constant(_)
                | Operand::Variable(_)
                | Operand::TypeOf(_)
                | Operand::Unary(..)
                | Operand::Binary(..)) => self.operand(other),
            },
            Operand::Unary(Unary::Minus | Unary::Abs, one) => self.operand(one),
            Operand::Binary(_, both) => both.iter().for_each(|one| self.operand(one)),
            // The world says which class an object has.
            Operand::Constant(_) | Operand::Variable(_) | Operand::TypeOf(_) => {}
        }
    }

    fn place(&mut self, name: &'a Name) {
        if let Some(object) = self.scene.find(&name.text) {
            self.add(&name.text, object, &[], Wish::Place);
        }
    }

    fn path(&mut self, path: &'a Path, changed: Option<&str>) {
        let Some((object, own)) = head(self.scene, path) else {
            return;
        };
        let chain = path.parts.get(own..).unwrap_or_default();
        match changed {
            None => self.add(&path.text, object, chain, Wish::Property),
            Some(property) => {
                let text = format!("{}.{property}", path.text);
                let chain = [chain, &[property.into()]].concat();
                self.add(&text, object, &chain, Wish::Change);
            }
        }
    }

    fn add(&mut self, text: &str, object: Object, chain: &[Box<str>], wish: Wish) {
        self.found.push(Asked {
            rule: self.rule.to_owned(),
            text: text.to_owned(),
            object,
            chain: chain.to_vec(),
            wish,
        });
    }
}
