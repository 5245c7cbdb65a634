//! Questions of a program of blocks to the person who debugs it in a simulated world.
//!
//! Owns which question is open: model time stands still until it has an answer. Knows no terminal.

use lang_diagram::brick::{Answer, Question};
use lang_text::problem::{Locale, Problem};
use sim::arena::Person;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// A question.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub(crate) struct Asked {
    pub variable: String,
    /// Its words, if it has some.
    pub prompt: String,
    /// What it proposes.
    pub default: String,
    /// What was wrong with the last answer, in the language of the person; empty for the first one.
    pub wrong: String,
    /// Until when there can be an answer; None: for ever.
    pub until: Option<Instant>,
}

impl Asked {
    fn of(question: Question<'_>) -> Self {
        Self {
            variable: question.variable.to_owned(),
            prompt: question.prompt.to_owned(),
            default: question.default.to_owned(),
            ..Self::default()
        }
    }

    /// Whether this is the same question, whatever was answered before.
    fn is_of(&self, other: &Self) -> bool {
        let key = |asked: &Self| {
            (
                asked.variable.clone(),
                asked.prompt.clone(),
                asked.default.clone(),
            )
        };
        key(self) == key(other)
    }

    /// Whether nobody waits for an answer any more.
    pub fn is_over(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
    }
}

/// Whether somebody is there to answer.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(crate) enum Listener {
    /// Nobody, from the beginning: a question has no answer, as in a run that is judged.
    #[default]
    Nobody,
    /// A person.
    Person,
    /// Nobody any more: what a question proposes counts.
    Gone,
}

/// The questions of a run, for both the run and who has it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Asking(Arc<Mutex<Inner>>);

#[derive(Debug, Default)]
struct Inner {
    listener: Listener,
    open: Option<Open>,
    /// What the person has just answered.
    answered: Option<Asked>,
    /// In which reasons are told.
    locale: Locale,
    /// The program is to be stopped first.
    is_put_off: bool,
    ticks: u64,
    /// The first question that nobody heard.
    missed: Option<Asked>,
    has_missed: bool,
}

#[derive(Debug)]
struct Open {
    asked: Asked,
    answer: Option<String>,
    is_told: bool,
    /// The last tick at which the program has asked it.
    seen: u64,
}

impl Asking {
    fn inner(&self) -> MutexGuard<'_, Inner> {
        // Each change of it is whole.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reasons are told in this language.
    pub(super) fn speak(&self, locale: Locale) {
        self.inner().locale = locale;
    }

    /// Who answers from now on.
    pub(super) fn attend(&self, listener: Listener) {
        let mut inner = self.inner();
        inner.listener = listener;
        if listener != Listener::Person {
            inner.open = None;
        }
    }

    /// A tick of the world has passed.
    pub(super) fn tick(&self) {
        self.inner().ticks += 1;
    }

    /// The program is to be stopped, and a question can wait; or it cannot any more.
    pub(super) fn put_off(&self, is_put_off: bool) {
        self.inner().is_put_off = is_put_off;
    }

    /// Whether the world has to stand still.
    pub(super) fn is_waiting(&self) -> bool {
        let inner = self.inner();
        let is_open = inner
            .open
            .as_ref()
            .is_some_and(|open| open.answer.is_none());
        is_open && !inner.is_put_off
    }

    /// A question that nobody has been told of.
    pub(super) fn news(&self) -> Option<Asked> {
        let mut inner = self.inner();
        let open = inner.open.as_mut().filter(|open| !open.is_told)?;
        open.is_told = true;
        Some(open.asked.clone())
    }

    /// The first question that nobody heard, once.
    pub(super) fn missed(&self) -> Option<Asked> {
        self.inner().missed.take()
    }

    /// What the person says.
    pub(super) fn answer(&self, text: &str) {
        if let Some(open) = &mut self.inner().open {
            open.answer = Some(text.to_owned());
        }
    }
}

impl Inner {
    fn ask(&mut self, asked: Asked) -> Answer {
        match self.listener {
            Listener::Person => self.ask_person(asked),
            Listener::Nobody => {
                if !std::mem::replace(&mut self.has_missed, true) {
                    self.missed = Some(asked);
                }
                Answer::Cancelled
            }
            Listener::Gone if asked.default.is_empty() => Answer::Cancelled,
            Listener::Gone => Answer::Text(asked.default),
        }
    }

    fn ask_person(&mut self, asked: Asked) -> Answer {
        let ticks = self.ticks;
        // One that is not asked any more is forgotten; another one that is comes first.
        let is_old = |open: &Open| !open.asked.is_of(&asked) && open.seen + 1 < ticks;
        if self.open.as_ref().is_some_and(is_old) {
            self.open = None;
        }
        let open = self.open.get_or_insert_with(|| Open {
            asked: asked.clone(),
            answer: None,
            is_told: false,
            seen: ticks,
        });
        if !open.asked.is_of(&asked) {
            return Answer::Waiting;
        }
        open.seen = ticks;
        match open.answer.take() {
            Some(answer) => {
                self.open = None;
                self.answered = Some(asked);
                Answer::Text(answer)
            }
            None => Answer::Waiting,
        }
    }
}

impl Person for Asking {
    fn ask(&mut self, question: Question<'_>) -> Answer {
        self.inner().ask(Asked::of(question))
    }

    fn may_ask_again(&mut self, question: Question<'_>) -> bool {
        let inner = self.inner();
        let answered = inner.answered.as_ref();
        inner.listener == Listener::Person
            && answered.is_some_and(|answered| answered.is_of(&Asked::of(question)))
    }

    fn ask_again(&mut self, question: Question<'_>, why: &[Problem]) {
        let mut inner = self.inner();
        let said = why.iter().map(|one| one.said(inner.locale));
        let wrong = said.collect::<Vec<_>>().join("\n");
        let seen = inner.ticks;
        inner.answered = None;
        inner.open = Some(Open {
            asked: Asked {
                wrong,
                ..Asked::of(question)
            },
            answer: None,
            is_told: false,
            seen,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lang_text::problem::Words;

    fn ask(asking: &mut Asking, variable: &str) -> Answer {
        asking.tick();
        asking.ask(Question {
            variable,
            prompt: "How many?",
            default: if variable == "n" { "1" } else { "" },
        })
    }

    fn text(text: &str) -> Answer {
        Answer::Text(text.to_owned())
    }

    #[test]
    fn one_question_is_told_once_and_holds_the_world_until_it_is_answered() {
        let mut asking = Asking::default();
        asking.attend(Listener::Person);
        assert_eq!(ask(&mut asking, "n"), Answer::Waiting);
        assert!(asking.is_waiting());
        let told = asking.news().expect("a question");
        assert_eq!((told.variable.as_str(), told.default.as_str()), ("n", "1"));
        assert_eq!(asking.news(), None);
        // Another thread waits for its turn.
        assert_eq!(ask(&mut asking, "m"), Answer::Waiting);
        assert_eq!(asking.news(), None);
        asking.put_off(true);
        assert!(!asking.is_waiting());
        asking.put_off(false);
        asking.answer("5");
        assert!(!asking.is_waiting());
        assert_eq!(ask(&mut asking, "n"), text("5"));
        assert_eq!(ask(&mut asking, "m"), Answer::Waiting);
        assert_eq!(asking.news().expect("a question").variable, "m");
        // Its block is gone.
        asking.answer("6");
        asking.tick();
        assert_eq!(ask(&mut asking, "n"), Answer::Waiting);
        assert_eq!(asking.news().expect("a question").variable, "n");
        assert_eq!(asking.missed(), None);
    }

    #[test]
    fn a_wrong_answer_is_asked_for_once_more_with_the_reason() {
        let mut asking = Asking::default();
        let question = Question {
            variable: "n",
            prompt: "How many?",
            default: "1",
        };
        assert!(!asking.may_ask_again(question), "nothing was answered");
        asking.attend(Listener::Person);
        assert_eq!(ask(&mut asking, "n"), Answer::Waiting);
        asking.answer("x");
        assert_eq!(ask(&mut asking, "n"), text("x"));
        assert!(asking.may_ask_again(question));
        asking.ask_again(question, &[Problem::error(Words::new("no x", "x"))]);
        let told = asking.news().expect("the question");
        assert_eq!((told.variable.as_str(), told.wrong.as_str()), ("n", "no x"));
        assert_eq!(ask(&mut asking, "n"), Answer::Waiting);
        asking.answer("2");
        assert_eq!(ask(&mut asking, "n"), text("2"));
    }

    #[test]
    fn without_a_person_a_question_has_no_answer_or_what_it_proposes() {
        let mut asking = Asking::default();
        assert_eq!(ask(&mut asking, "n"), Answer::Cancelled);
        assert_eq!(asking.missed().expect("a question").variable, "n");
        assert_eq!(ask(&mut asking, "n"), Answer::Cancelled);
        assert_eq!(asking.missed(), None, "once");
        asking.attend(Listener::Person);
        assert_eq!(ask(&mut asking, "n"), Answer::Waiting);
        asking.attend(Listener::Gone);
        assert!(!asking.is_waiting());
        assert_eq!(ask(&mut asking, "n"), text("1"));
        assert_eq!(ask(&mut asking, "m"), Answer::Cancelled);
    }
}
