//! Options of a request: an object of JSON, read without trust.
//!
//! Owns how a value is refused. Each request knows its own names, and takes them one after the other; what is left then is
//! a mistake of the code that asks.

use crate::failure::Failure;
use crate::words::Wanted;
use crate::{limits, words};
use lang_dataflow::read::Language;
use lang_text::problem::Locale;
use serde_json::{Map, Value};

/// Options that nobody has taken yet.
#[derive(Clone, Debug, Default)]
pub struct Options(Map<String, Value>);

impl Options {
    /// Reads an object; an empty text is none.
    ///
    /// # Errors
    /// It is no object, or longer than [`limits::OPTIONS_BYTES_MAX`].
    pub fn read(text: &str) -> Result<Self, Failure> {
        if text.len() > limits::OPTIONS_BYTES_MAX {
            let (bytes, most) = (text.len(), limits::OPTIONS_BYTES_MAX);
            return Err(Failure::Request(words::too_long("options", bytes, most)));
        }
        if text.is_empty() {
            return Ok(Self::default());
        }
        match sim::judge::json::read(text) {
            Ok(Value::Object(map)) => Ok(Self(map)),
            Ok(_) | Err(_) => Err(Failure::Request(words::no_options())),
        }
    }

    fn take(&mut self, name: &str) -> Option<Value> {
        self.0.remove(name).filter(|value| !value.is_null())
    }

    fn wrong(name: &str, wanted: Wanted) -> Failure {
        Failure::Request(words::wrong_option(name, wanted))
    }

    /// Yes or no; without the option no.
    ///
    /// # Errors
    /// It is something else.
    pub fn flag(&mut self, name: &str) -> Result<bool, Failure> {
        match self.take(name) {
            None => Ok(false),
            Some(Value::Bool(value)) => Ok(value),
            Some(_) => Err(Self::wrong(name, Wanted::Flag)),
        }
    }

    /// A text.
    ///
    /// # Errors
    /// It is something else.
    pub fn text(&mut self, name: &str) -> Result<Option<String>, Failure> {
        match self.take(name) {
            None => Ok(None),
            Some(Value::String(text)) => Ok(Some(text)),
            Some(_) => Err(Self::wrong(name, Wanted::Text)),
        }
    }

    /// A language of drawings; without the option control flow.
    ///
    /// # Errors
    /// It is something else.
    pub fn language(&mut self) -> Result<Language, Failure> {
        match self.text("language")?.as_deref() {
            None | Some("diagram") => Ok(Language::Diagram),
            Some("dataflow") => Ok(Language::Dataflow),
            Some(_) => Err(Failure::Request(words::no_language())),
        }
    }

    /// Texts.
    ///
    /// # Errors
    /// It is something else, or longer than [`limits::ANSWERS_MAX`].
    pub fn texts(&mut self, name: &str) -> Result<Vec<String>, Failure> {
        let wrong = || Self::wrong(name, Wanted::Texts);
        let all = match self.take(name) {
            None => return Ok(Vec::new()),
            Some(Value::Array(all)) if all.len() <= limits::ANSWERS_MAX => all,
            Some(_) => return Err(wrong()),
        };
        let text = |one| match one {
            Value::String(text) => Ok(text),
            _ => Err(wrong()),
        };
        all.into_iter().map(text).collect()
    }

    /// A number from `least` to `most`.
    ///
    /// # Errors
    /// It is something else.
    pub fn number(&mut self, name: &str, least: f64, most: f64) -> Result<Option<f64>, Failure> {
        let value = self.take(name);
        match value.as_ref().map(Value::as_f64) {
            None => Ok(None),
            Some(Some(number)) if (least..=most).contains(&number) => Ok(Some(number)),
            Some(_) => Err(Self::wrong(name, Wanted::Number(least, most))),
        }
    }

    /// The option `locale`: the language of messages.
    ///
    /// # Errors
    /// There is no such language.
    pub fn locale(&mut self) -> Result<Locale, Failure> {
        let wrong = || Self::wrong("locale", Wanted::Locale);
        match self.text("locale")? {
            None => Ok(Locale::default()),
            Some(name) => Locale::named(&name).ok_or_else(wrong),
        }
    }

    /// That nothing is left.
    ///
    /// # Errors
    /// An option that the request does not have.
    pub fn end(self) -> Result<(), Failure> {
        match self.0.keys().next() {
            None => Ok(()),
            Some(name) => {
                let name: String = name.chars().take(limits::NAME_BYTES_MAX / 64).collect();
                Err(Failure::Request(words::no_option(&name)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_option_is_refused_by_name() {
        let refused = |text: &str, take: &dyn Fn(&mut Options) -> Result<(), Failure>| {
            let why = Options::read(text).and_then(|mut options| {
                take(&mut options)?;
                options.end()
            });
            match why.unwrap_err() {
                Failure::Request(words) => words.english,
                other => panic!("{other:?}"),
            }
        };
        let none = |_: &mut Options| Ok(());
        assert_eq!(
            refused("[]", &none),
            "options are an object with their names"
        );
        assert_eq!(
            refused("{", &none),
            "options are an object with their names"
        );
        assert_eq!(refused(r#"{"x": 1}"#, &none), "there is no option 'x'");
        let flag = |options: &mut Options| options.flag("goto").map(drop);
        assert_eq!(
            refused(r#"{"goto": 1}"#, &flag),
            "the option 'goto' is true or false"
        );
        let number = |options: &mut Options| options.number("seed", 0.0, 5.0).map(drop);
        for text in [r#"{"seed": 6}"#, r#"{"seed": "1"}"#, r#"{"seed": -1e-9}"#] {
            assert_eq!(
                refused(text, &number),
                "the option 'seed' is a number from 0 to 5"
            );
        }
        let texts = |options: &mut Options| options.texts("inputs").map(drop);
        assert_eq!(
            refused(r#"{"inputs": ["a", 1]}"#, &texts),
            "the option 'inputs' is a list of texts"
        );
        let locale = |options: &mut Options| options.locale().map(drop);
        assert_eq!(
            refused(r#"{"locale": "de"}"#, &locale),
            "the option 'locale' is 'en' or 'ru'"
        );
    }
}
