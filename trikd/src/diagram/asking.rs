//! Questions of a diagram to a person, one at a time.
//!
//! Owns which question is open and how long it waits. Which person is asked, and how, is the daemon's matter; what
//! becomes of the answer, the diagram's.

use crate::limits;
use lang_diagram::brick::{Answer, Question};
use lang_text::json::Object;
use std::time::{Duration, Instant};

/// A question that was asked.
#[derive(Debug)]
struct Open {
    /// Another question waits until this one is done.
    key: (String, String),
    number: u32,
    until: Instant,
    answer: Option<Answer>,
    /// What it comes to without an answer.
    default: Answer,
}

/// The questions of a diagram.
#[derive(Debug)]
pub(super) struct Asking {
    /// How long one waits.
    patience: Duration,
    open: Option<Open>,
    count: u32,
    /// A block that got no answer may ask at once again, and has to wait until then.
    rests: Option<Instant>,
    /// The question that a person has answered last, and until when it could be: the answer may be no good.
    answered: Option<((String, String), Instant)>,
}

impl Asking {
    /// Each question waits for so long.
    pub(super) fn new(patience: Duration) -> Self {
        Self {
            patience,
            open: None,
            count: 0,
            rests: None,
            answered: None,
        }
    }

    /// What was answered. A question that is new is told, with its number.
    pub(super) fn ask(
        &mut self,
        question: Question<'_>,
        now: Instant,
        tell: &mut dyn FnMut(u32, &str),
    ) -> Answer {
        let key = (question.variable.to_owned(), question.prompt.to_owned());
        let Some(open) = &mut self.open else {
            if self.rests.is_some_and(|until| now < until) {
                return Answer::Waiting;
            }
            self.open(question, None, (now, now + self.patience), tell);
            return Answer::Waiting;
        };
        if open.key != key {
            return Answer::Waiting;
        }
        let answer = match open.answer.take() {
            None if now < open.until => return Answer::Waiting,
            None | Some(Answer::Cancelled) => open.default.clone(),
            Some(answer) => {
                self.answered = Some((key, open.until));
                answer
            }
        };
        self.open = None;
        self.rests = None;
        if answer == Answer::Cancelled {
            self.rests = Some(now + Duration::from_millis(limits::QUESTION_REST_MS));
        }
        answer
    }

    /// Whether this is what a person has just answered, and there is time for another answer.
    pub(super) fn may_again(&self, question: Question<'_>, now: Instant) -> bool {
        let asked = (question.variable, question.prompt);
        self.answered
            .as_ref()
            .is_some_and(|((variable, prompt), until)| {
                (variable.as_str(), prompt.as_str()) == asked && now < *until
            })
    }

    /// Asks that once more, with what was wrong, within the time that is left.
    pub(super) fn again(
        &mut self,
        question: Question<'_>,
        wrong: &str,
        now: Instant,
        tell: &mut dyn FnMut(u32, &str),
    ) {
        if let Some((_, until)) = self.answered.take() {
            self.open(question, Some(wrong), (now, until), tell);
        }
    }

    fn open(
        &mut self,
        question: Question<'_>,
        wrong: Option<&str>,
        (now, until): (Instant, Instant),
        tell: &mut dyn FnMut(u32, &str),
    ) {
        self.count = self.count.wrapping_add(1);
        let told = Object::new(limits::QUESTION_CHARACTERS)
            .plain("number", self.count)
            .text("variable", question.variable)
            .text("question", question.prompt)
            .text("default", question.default)
            .plain("seconds", (until - now).as_secs());
        let told = match wrong {
            Some(why) => told.text("wrong", why),
            None => told,
        };
        tell(self.count, &told.done());
        self.open = Some(Open {
            key: (question.variable.to_owned(), question.prompt.to_owned()),
            number: self.count,
            until,
            answer: None,
            default: match question.default {
                "" => Answer::Cancelled,
                text => Answer::Text(text.to_owned()),
            },
        });
    }

    /// What a person says to the question with this number; nothing: no answer will come.
    pub(super) fn hear(&mut self, number: u32, text: Option<String>) {
        if let Some(open) = self.open.as_mut().filter(|open| open.number == number) {
            open.answer = Some(text.map_or(Answer::Cancelled, Answer::Text));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn question(variable: &str) -> Question<'_> {
        Question {
            variable,
            prompt: "How many?",
            default: if variable == "n" { "1" } else { "" },
        }
    }

    #[test]
    fn one_question_waits_for_its_answer_and_the_next_one_for_its_turn() {
        let patience = Duration::from_secs(120);
        let mut asking = Asking::new(patience);
        let now = Instant::now();
        let mut told = Vec::new();
        let mut ask = |asking: &mut Asking, variable, now| {
            asking.ask(question(variable), now, &mut |number, json| {
                told.push((number, json.to_owned()));
            })
        };
        assert_eq!(ask(&mut asking, "n", now), Answer::Waiting);
        assert_eq!(ask(&mut asking, "m", now), Answer::Waiting);
        asking.hear(7, Some("x".into()));
        assert_eq!(ask(&mut asking, "n", now), Answer::Waiting);
        asking.hear(1, Some("5".into()));
        assert_eq!(ask(&mut asking, "m", now), Answer::Waiting);
        assert_eq!(ask(&mut asking, "n", now), Answer::Text("5".into()));
        assert_eq!(ask(&mut asking, "m", now), Answer::Waiting);
        asking.hear(2, None);
        assert_eq!(ask(&mut asking, "m", now), Answer::Cancelled);
        // A block that gets no answer does not ask again at once.
        let rested = now + Duration::from_millis(limits::QUESTION_REST_MS);
        assert_eq!(ask(&mut asking, "m", now), Answer::Waiting);
        assert_eq!(ask(&mut asking, "n", rested), Answer::Waiting);
        let late = rested + patience;
        assert_eq!(ask(&mut asking, "n", late), Answer::Text("1".into()));
        assert_eq!(told.len(), 3);
        let first = "{\"number\":1,\"variable\":\"n\",\"question\":\"How many?\",\"default\":\"1\",\"seconds\":120}";
        assert_eq!(told[0], (1, first.to_owned()));
    }

    #[test]
    fn a_wrong_answer_has_another_chance_within_the_same_time() {
        let patience = Duration::from_secs(120);
        let mut asking = Asking::new(patience);
        let now = Instant::now();
        let mut told = Vec::new();
        let mut tell = |_: u32, json: &str| told.push(json.to_owned());
        let asked = |asking: &mut Asking, now, tell: &mut dyn FnMut(u32, &str)| {
            asking.ask(question("m"), now, tell)
        };
        assert_eq!(asked(&mut asking, now, &mut tell), Answer::Waiting);
        assert!(!asking.may_again(question("m"), now));
        asking.hear(1, Some("x".into()));
        assert_eq!(asked(&mut asking, now, &mut tell), Answer::Text("x".into()));
        let later = now + Duration::from_secs(100);
        assert!(!asking.may_again(question("n"), later));
        assert!(asking.may_again(question("m"), later));
        asking.again(question("m"), "no 'x'", later, &mut tell);
        assert_eq!(asked(&mut asking, later, &mut tell), Answer::Waiting);
        // Nobody answers any more, and so nobody is asked once more.
        let late = now + patience;
        assert_eq!(asked(&mut asking, late, &mut tell), Answer::Cancelled);
        assert!(!asking.may_again(question("m"), late));
        let second = "{\"number\":2,\"variable\":\"m\",\"question\":\"How many?\",\"default\":\"\",\"seconds\":20,\"wrong\":\"no 'x'\"}";
        assert_eq!(told.get(1).map(String::as_str), Some(second));
    }
}
