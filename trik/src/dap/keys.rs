//! The keys of `launch` and `attach`: which there are, and what each of them holds.
//!
//! Owns what a person hears who has misspelt one, or has written something else there than belongs. What a key does is known
//! where a program is begun.

use super::client::{Refused, Request};
use lang_text::near::{did_you_mean, nearest};
use serde_json::Value;

/// What a key holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Holds {
    Text,
    Truth,
    /// A whole number that is no less than 0 and no more than this.
    Whole(u32),
    /// A number from one to another.
    Number(f64, f64),
    /// One of these texts.
    OneOf(&'static [&'static str]),
}

/// A key, and what it holds.
pub(super) type Key = (&'static str, Holds);

const LANGUAGE: Key = ("language", Holds::OneOf(&["en", "ru"]));

/// Those of programs of blocks.
pub(super) const OF_BLOCKS: [Key; 14] = [
    ("program", Holds::Text),
    ("diagram", Holds::Text),
    ("field", Holds::Text),
    ("task", Holds::Text),
    ("inputs", Holds::Text),
    ("gamepad", Holds::Text),
    ("seed", Holds::Whole(u32::MAX)),
    LANGUAGE,
    ("speed", Holds::Number(0.01, 1000.0)),
    ("timeLimit", Holds::Number(0.01, 3600.0)),
    ("stopOnEntry", Holds::Truth),
    ("stopAtEnd", Holds::Truth),
    ("noDebug", Holds::Truth),
    ("robot", Holds::Text),
];

/// Those of programs in JavaScript.
pub(super) const OF_JAVASCRIPT: [Key; 5] = [
    ("program", Holds::Text),
    ("robot", Holds::Text),
    LANGUAGE,
    ("stopOnEntry", Holds::Truth),
    ("noDebug", Holds::Truth),
];

/// Those of programs in Python beside the keys of debugpy.
pub(super) const OF_PYTHON: [Key; 7] = [
    ("program", Holds::Text),
    ("robot", Holds::Text),
    LANGUAGE,
    ("stopOnEntry", Holds::Truth),
    ("noDebug", Holds::Truth),
    ("python", Holds::Text),
    ("motors", Holds::OneOf(&["rest", "keep"])),
];

/// What editors write there for themselves, and all that begins with two strokes.
const OF_EDITORS: [&str; 15] = [
    "name",
    "type",
    "request",
    "restart",
    "preLaunchTask",
    "postDebugTask",
    "internalConsoleOptions",
    "presentation",
    "debugServer",
    "serverReadyAction",
    "suppressMultipleSessionWarning",
    "windows",
    "linux",
    "osx",
    "order",
];

impl Holds {
    fn fits(self, value: &Value) -> bool {
        match self {
            Self::Text => value.is_string(),
            Self::Truth => value.is_boolean(),
            Self::Whole(most) => value.as_u64().is_some_and(|found| found <= u64::from(most)),
            Self::Number(least, most) => {
                let found = value.as_f64();
                found.is_some_and(|found| (least..=most).contains(&found))
            }
            Self::OneOf(words) => {
                let found = value.as_str();
                found.is_some_and(|found| words.contains(&found))
            }
        }
    }

    fn words(self) -> String {
        match self {
            Self::Text => "a text".to_owned(),
            Self::Truth => "true or false".to_owned(),
            Self::Whole(most) => format!("a whole number from 0 to {most}"),
            Self::Number(least, most) => format!("a number from {least} to {most}"),
            Self::OneOf(words) => {
                let words: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
                words.join(" or ")
            }
        }
    }
}

/// Keys that are none of these, nor near to one, nor an editor's.
///
/// # Errors
/// The first key that holds something else than belongs there, or that is near to one of these.
pub(super) fn strangers(request: &Request, keys: &[Key]) -> Result<Vec<String>, Refused> {
    let Some(given) = request.arguments.as_object() else {
        return Ok(Vec::new());
    };
    let names = || keys.iter().map(|(name, _)| *name);
    let mut strangers = Vec::new();
    for (name, value) in given {
        if let Some((_, holds)) = keys.iter().find(|(known, _)| known == name) {
            if !value.is_null() && !holds.fits(value) {
                let value: String = value.to_string().chars().take(60).collect();
                let belongs = holds.words();
                return Err(Refused(format!(
                    "\"{name}\" is {value}, and {belongs} belongs there"
                )));
            }
            continue;
        }
        if OF_EDITORS.contains(&name.as_str()) || name.starts_with("__") {
            continue;
        }
        if nearest(name, names()).is_some() {
            let meant = did_you_mean(name, names()).english;
            return Err(Refused(format!("there is no key \"{name}\"{meant}")));
        }
        strangers.push(name.chars().take(60).collect());
    }
    Ok(strangers)
}

/// What a person is told of such keys; none if there are none.
pub(super) fn of_strangers(strangers: &[String], keys: &[Key]) -> Option<String> {
    if strangers.is_empty() {
        return None;
    }
    let quoted = |name: &str| format!("\"{name}\"");
    let named: Vec<_> = strangers.iter().take(8).map(|name| quoted(name)).collect();
    let known: Vec<_> = keys.iter().map(|(name, _)| quoted(name)).collect();
    Some(format!(
        "these keys mean nothing here: {}; keys are {}",
        named.join(", "),
        known.join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn told(arguments: Value) -> Result<Vec<String>, String> {
        let request = Request::of("launch", arguments);
        strangers(&request, &OF_BLOCKS).map_err(|Refused(why)| why)
    }

    #[test]
    fn a_key_that_is_near_to_one_or_holds_something_else_is_refused() {
        for (arguments, why) in [
            (
                json!({"stopOnEntyr": true}),
                "there is no key \"stopOnEntyr\"; did you mean 'stopOnEntry'?",
            ),
            (
                json!({"Program": "x"}),
                "there is no key \"Program\"; did you mean 'program'?",
            ),
            (
                json!({"program": 7}),
                "\"program\" is 7, and a text belongs there",
            ),
            (
                json!({"stopOnEntry": "yes"}),
                "\"stopOnEntry\" is \"yes\", and true or false belongs there",
            ),
            (
                json!({"seed": -1}),
                "\"seed\" is -1, and a whole number from 0 to 4294967295 belongs there",
            ),
            (
                json!({"speed": "x"}),
                "\"speed\" is \"x\", and a number from 0.01 to 1000 belongs there",
            ),
            (
                json!({"timeLimit": 4000}),
                "\"timeLimit\" is 4000, and a number from 0.01 to 3600 belongs there",
            ),
            (
                json!({"language": "de"}),
                "\"language\" is \"de\", and \"en\" or \"ru\" belongs there",
            ),
        ] {
            assert_eq!(told(arguments), Err(why.to_owned()));
        }
    }

    #[test]
    fn what_editors_send_is_fine_and_all_else_is_named() {
        let editors = json!({
            "type": "trik", "request": "launch", "name": "x", "__sessionId": "1", "noDebug": false, "restart": true,
            "__configurationTarget": 6, "internalConsoleOptions": "neverOpen", "preLaunchTask": "build",
            "program": "a.qrs", "seed": 3, "speed": 1, "stopAtEnd": true, "field": null,
        });
        assert_eq!(told(editors), Ok(Vec::new()));
        assert_eq!(told(json!([1])), Ok(Vec::new()));
        let found = told(json!({"args": ["x"], "program": "a.qrs"}));
        assert_eq!(found, Ok(vec!["args".to_owned()]));
        let all = of_strangers(&["args".to_owned()], &OF_BLOCKS).expect("a sentence");
        assert!(
            all.starts_with("these keys mean nothing here: \"args\"; keys are \"program\", "),
            "{all}"
        );
        assert_eq!(of_strangers(&[], &OF_BLOCKS), None);
    }
}
