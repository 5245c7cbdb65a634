//! Whether a source delivers tuples by itself or is sampled, as far as its description tells.
//!
//! Owns the rule for each kind of source. A plain path is whatever stands there when it is opened; nothing is opened here.

use super::Checker;
use crate::description::SourceDescription;

/// How tuples come out of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Delivery {
    /// By themselves.
    Stream,
    /// Whenever it is sampled.
    State,
    /// The device decides.
    Unknown,
}

impl Checker<'_> {
    /// How tuples come out of a source. The nodes that it reads have been built.
    pub(super) fn delivery(&self, source: &SourceDescription) -> Delivery {
        match source {
            SourceDescription::Fifo(_)
            | SourceDescription::Evdev(_)
            | SourceDescription::Iio(_)
            | SourceDescription::Lines(_)
            | SourceDescription::Packets(_)
            | SourceDescription::Replay(_) => Delivery::Stream,
            SourceDescription::Fake(fake) if fake.period_ms > 0 => Delivery::Stream,
            SourceDescription::Attribute(_)
            | SourceDescription::Pwm(_)
            | SourceDescription::Gpio(_)
            | SourceDescription::Fake(_)
            | SourceDescription::I2c(_)
            | SourceDescription::Newest(_) => Delivery::State,
            SourceDescription::Path(_)
            | SourceDescription::Absent(_)
            | SourceDescription::I2cBus(_)
            | SourceDescription::Program(_) => Delivery::Unknown,
            SourceDescription::Faulty(faulty) => self.delivery(&faulty.source),
            SourceDescription::Node(other) => self.delivery_of_node(other),
            SourceDescription::Several(several) => {
                self.delivery_of_parts(several.parts.iter().map(|part| &part.source))
            }
            SourceDescription::Regulator(regulator) => {
                self.delivery_of_parts(regulator.feedback.parts.iter().map(|part| &part.source))
            }
        }
    }

    /// That of a node was found out when it was built, so that nobody walks through all that it reads.
    fn delivery_of_node(&self, path: &str) -> Delivery {
        let number = self.index.get(path).copied();
        let draft = number.and_then(|number| self.drafts.get(number));
        draft.map_or(Delivery::Unknown, |draft| draft.delivery)
    }

    /// One stream makes a stream of all.
    fn delivery_of_parts<'a>(
        &self,
        parts: impl Iterator<Item = &'a SourceDescription>,
    ) -> Delivery {
        let mut all = Delivery::State;
        for part in parts {
            match self.delivery(part) {
                Delivery::Stream => return Delivery::Stream,
                Delivery::Unknown => all = Delivery::Unknown,
                Delivery::State => {}
            }
        }
        all
    }
}
