//! A result as others read it: a JSON object that says of which submission it is.
//!
//! Owns its form, and that it fits into a message. What a run says is known to the judge.

use crate::error::Error;
use crate::limits::RESULT_BYTES_MAX;
use crate::submission::Submission;
use serde_json::{Value, json};

/// What became of a submission.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome(Value);

impl Outcome {
    /// What stands under the subject of a result, if it is one of this submission.
    ///
    /// # Errors
    /// It is none: somebody else has published it.
    pub fn read(id: &str, bytes: &[u8]) -> Result<Self, Error> {
        let value: Value = serde_json::from_slice(bytes).map_err(|_| Error::NoResult)?;
        let is_text = |name: &str| value[name].is_null() || value[name].is_string();
        let has_runs = |runs: &Vec<Value>| runs.iter().all(Value::is_object);
        let is_one = value["id"] == id
            && ["task", "file", "worker", "dead"].into_iter().all(is_text)
            && value["runs"].as_array().is_some_and(has_runs);
        is_one.then_some(Self(value)).ok_or(Error::NoResult)
    }

    /// Why it was put aside; None: it was judged.
    pub fn dead(&self) -> Option<&str> {
        self.0["dead"].as_str()
    }

    /// A JSON object for each run.
    pub fn runs(&self) -> &[Value] {
        self.0["runs"].as_array().map_or(&[], Vec::as_slice)
    }

    /// As a JSON object.
    pub fn into_value(self) -> Value {
        self.0
    }
}

/// A result before it is told.
#[derive(Clone, Copy, Debug)]
pub struct Draft<'a> {
    /// Of which submission.
    pub id: &'a str,
    /// The submission; None of a message that is none.
    pub submission: Option<&'a Submission>,
    /// Who has judged it.
    pub worker: &'a str,
    /// A JSON object for each run.
    pub runs: &'a [Value],
    /// Why it is put aside.
    pub dead: Option<&'a str>,
}

impl Draft<'_> {
    /// As a text of so many bytes at most. What was said goes first, verdicts and points if nothing else helps.
    pub fn text(&self, bytes_max: usize) -> String {
        let most = bytes_max.min(RESULT_BYTES_MAX);
        let whole = self.of(self.runs);
        if whole.len() <= most {
            return whole;
        }
        let mut short = self.runs.to_vec();
        for field in short.iter_mut().filter_map(Value::as_object_mut) {
            for name in ["messages", "printed", "explain", "report"] {
                field.remove(name);
            }
            field.insert("shortened".to_owned(), Value::Bool(true));
        }
        let short = self.of(&short);
        if short.len() <= most {
            return short;
        }
        let size = short.len();
        let why = format!("its result has {size} bytes, and the server takes {most}");
        let dead = Some(self.dead.unwrap_or(&why));
        Draft { dead, ..*self }.of(&[])
    }

    fn of(&self, runs: &[Value]) -> String {
        json!({
            "id": self.id,
            "task": self.submission.map(Submission::task),
            "file": self.submission.map(Submission::file),
            "worker": self.worker,
            "dead": self.dead,
            "runs": runs,
        })
        .to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_read_back_and_what_is_none_is_refused() {
        let runs = [json!({"verdict": "failed"})];
        let draft = Draft {
            id: "ab",
            submission: None,
            worker: "here",
            runs: &runs,
            dead: Some("why"),
        };
        let text = draft.text(usize::MAX);
        let outcome = Outcome::read("ab", text.as_bytes()).unwrap();
        assert_eq!((outcome.dead(), outcome.runs()), (Some("why"), &runs[..]));
        let id = text.replace("\"ab\"", "7");
        let dead = text.replace("\"why\"", "7");
        let runs = text.replace("[{", "[7,{");
        for wrong in [
            "",
            "\x1b[2J",
            "[]",
            "{}",
            "{\"id\":\"ab\"}",
            &id,
            &dead,
            &runs,
        ] {
            let read = Outcome::read("ab", wrong.as_bytes());
            assert_eq!(read, Err(Error::NoResult), "{wrong}");
        }
        assert_eq!(Outcome::read("cd", text.as_bytes()), Err(Error::NoResult));
    }

    #[test]
    fn a_result_that_does_not_fit_says_less() {
        let runs = [json!({"verdict": "failed", "messages": "m".repeat(1000)})];
        let draft = |runs| Draft {
            id: "ab",
            submission: None,
            worker: "here",
            runs,
            dead: None,
        };
        let short = draft(&runs).text(500);
        let short = Outcome::read("ab", short.as_bytes()).unwrap();
        assert_eq!(
            short.runs(),
            [json!({"verdict": "failed", "shortened": true})]
        );
        let many = vec![runs[0].clone(); 100];
        let none = Outcome::read("ab", draft(&many).text(500).as_bytes()).unwrap();
        assert!(none.runs().is_empty());
        assert!(none.dead().unwrap().ends_with("and the server takes 500"));
    }
}
