//! Why a request is not answered, by who has to act, as a value.
//!
//! Owns the kinds and their names in JSON.

use crate::limits;
use lang_dcml::generate::Target;
use serde_json::{Value, json};

/// Why a request is not answered.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// The code that asks has a mistake: an argument or an option, and what it should be.
    Request(String),
    /// There is no such language.
    Language(String),
    /// The text has several models, and none is named: their names.
    Several(Vec<String>),
    /// The text has no model of this name: those that it has.
    NoModel(String, Vec<String>),
    /// The model has mistakes; diagnostics tell them.
    Mistakes,
    /// It cannot be done with this model, name or text, and why.
    Refused(String),
    /// The solution ends before its time, and why.
    Solution(String),
}

impl Failure {
    /// Its name.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Request(_) | Self::Language(_) => "request",
            Self::Several(_) | Self::NoModel(..) => "model",
            Self::Mistakes => "mistakes",
            Self::Refused(_) => "refused",
            Self::Solution(_) => "solution",
        }
    }

    /// In a sentence.
    pub fn sentence(&self) -> String {
        let listed = |names: &[String]| {
            let shown = names.iter().take(limits::NAMES_MAX).cloned();
            shown.collect::<Vec<_>>().join(", ")
        };
        match self {
            Self::Request(why) | Self::Refused(why) | Self::Solution(why) => why.clone(),
            Self::Language(name) => {
                let all = Target::ALL.map(Target::name).join(", ");
                format!("there is no language {name:?}; there are {all}")
            }
            Self::Several(names) => {
                format!(
                    "there are several models, name one of them: {}",
                    listed(names)
                )
            }
            Self::NoModel(name, names) if names.is_empty() => {
                format!("there is no model {name}, and no other one that can be read")
            }
            Self::NoModel(name, names) => {
                format!("there is no model {name}; there are {}", listed(names))
            }
            Self::Mistakes => "the model has mistakes".to_owned(),
        }
    }

    /// As a value.
    pub fn json(&self) -> Value {
        json!({"kind": self.kind(), "message": self.sentence()})
    }
}
