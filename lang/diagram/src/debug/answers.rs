//! What a robot has answered in a step, kept so that the step can be run again without the robot.
//!
//! Owns the two stand-ins for a robot: one that notes what the real one answers, and one that answers from notes and is
//! told nothing. Knows no machine and no time.

use crate::brick::{Answer, Brick, Command, Question};
use crate::ports::Port;
use lang_text::problem::Problem;

/// One answer of a robot.
#[derive(Clone, Debug, Eq, PartialEq)]
enum Answered {
    Scalar(Option<i32>),
    Vector(Option<Box<[i32]>>),
    Locked(Option<i32>),
    Announced(Option<(Port, i32)>),
    Random(i32),
    Mail(Option<Box<str>>),
    Letter(Option<(Option<i32>, Box<str>)>),
    Contents(Option<Box<str>>),
    Person(Box<Answer>),
    Again(bool),
}

/// The answers of a step in their order.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Answers(Vec<Answered>);

impl Answers {
    /// How much memory they take, about.
    pub(super) fn bytes(&self) -> usize {
        let apart = self.0.iter().map(|answered| match answered {
            Answered::Vector(Some(numbers)) => numbers.len() * size_of::<i32>(),
            Answered::Mail(Some(text))
            | Answered::Letter(Some((_, text)))
            | Answered::Contents(Some(text)) => text.len(),
            Answered::Person(answer) => match &**answer {
                Answer::Text(text) => size_of::<Answer>() + text.len(),
                Answer::Waiting | Answer::Cancelled => size_of::<Answer>(),
            },
            Answered::Scalar(_)
            | Answered::Vector(None)
            | Answered::Locked(_)
            | Answered::Announced(_)
            | Answered::Random(_)
            | Answered::Mail(None)
            | Answered::Letter(None)
            | Answered::Contents(None)
            | Answered::Again(_) => 0,
        });
        self.0.len() * size_of::<Answered>() + apart.sum::<usize>()
    }
}

/// A robot whose answers are noted.
pub struct Noting<'a> {
    /// The robot.
    pub robot: &'a mut dyn Brick,
    /// What it answers.
    pub notes: &'a mut Answers,
}

impl Noting<'_> {
    fn note(&mut self, answered: Answered) {
        self.notes.0.push(answered);
    }
}

impl Brick for Noting<'_> {
    fn command(&mut self, command: Command<'_>) {
        self.robot.command(command);
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        let value = self.robot.scalar(port);
        self.note(Answered::Scalar(value));
        value
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        let before = into.len();
        let is_there = self.robot.vector(port, into);
        let numbers = is_there.then(|| into.get(before..).unwrap_or_default().into());
        self.note(Answered::Vector(numbers));
        is_there
    }

    fn locked(&mut self, port: Port) -> Option<i32> {
        let value = self.robot.locked(port);
        self.note(Answered::Locked(value));
        value
    }

    fn announced(&mut self) -> Option<(Port, i32)> {
        let reading = self.robot.announced();
        self.note(Answered::Announced(reading));
        reading
    }

    fn random_of_function(&mut self, low: i32, high: i32) -> i32 {
        let number = self.robot.random_of_function(low, high);
        self.note(Answered::Random(number));
        number
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        let number = self.robot.random(low, high);
        self.note(Answered::Random(number));
        number
    }

    fn mail(&mut self) -> Option<String> {
        let text = self.robot.mail();
        self.note(Answered::Mail(text.as_deref().map(Into::into)));
        text
    }

    fn letter(&mut self) -> Option<(Option<i32>, String)> {
        let letter = self.robot.letter();
        let noted = letter.as_ref();
        self.note(Answered::Letter(
            noted.map(|(sender, text)| (*sender, text.as_str().into())),
        ));
        letter
    }

    fn contents(&mut self, file: &str) -> Option<String> {
        let text = self.robot.contents(file);
        self.note(Answered::Contents(text.as_deref().map(Into::into)));
        text
    }

    fn ask(&mut self, question: Question<'_>) -> Answer {
        let answer = self.robot.ask(question);
        self.note(Answered::Person(Box::new(answer.clone())));
        answer
    }

    fn may_ask_again(&mut self, question: Question<'_>) -> bool {
        let may = self.robot.may_ask_again(question);
        self.note(Answered::Again(may));
        may
    }

    fn ask_again(&mut self, question: Question<'_>, why: &[Problem]) {
        self.robot.ask_again(question, why);
    }
}

/// A robot that answers from notes. It moves nothing.
pub(super) struct Remembering<'a> {
    notes: std::slice::Iter<'a, Answered>,
    all: usize,
    /// Whether it was asked something else than what was noted: then this is not what has happened.
    pub(super) is_astray: bool,
}

impl<'a> Remembering<'a> {
    pub(super) fn new(notes: &'a Answers) -> Self {
        Self::after(notes, 0)
    }

    /// One that has given so many answers already.
    pub(super) fn after(notes: &'a Answers, given: usize) -> Self {
        Self {
            notes: notes.0.get(given..).unwrap_or_default().iter(),
            all: notes.0.len(),
            is_astray: false,
        }
    }

    /// How many answers it has given.
    pub(super) fn given(&self) -> usize {
        self.all - self.notes.len()
    }

    fn next<T>(&mut self, expected: impl Fn(&'a Answered) -> Option<T>) -> Option<T> {
        let found = self.notes.next().and_then(expected);
        self.is_astray |= found.is_none();
        found
    }
}

impl Brick for Remembering<'_> {
    fn command(&mut self, _command: Command<'_>) {}

    fn scalar(&mut self, _port: Port) -> Option<i32> {
        self.next(|answered| {
            if let Answered::Scalar(value) = answered {
                Some(*value)
            } else {
                None
            }
        })
        .flatten()
    }

    fn vector(&mut self, _port: Port, into: &mut Vec<i32>) -> bool {
        let numbers = self.next(|answered| {
            if let Answered::Vector(numbers) = answered {
                Some(numbers.as_deref())
            } else {
                None
            }
        });
        let numbers = numbers.flatten();
        into.extend_from_slice(numbers.unwrap_or_default());
        numbers.is_some()
    }

    fn locked(&mut self, _port: Port) -> Option<i32> {
        self.next(|answered| {
            if let Answered::Locked(value) = answered {
                Some(*value)
            } else {
                None
            }
        })
        .flatten()
    }

    fn announced(&mut self) -> Option<(Port, i32)> {
        self.next(|answered| {
            if let Answered::Announced(reading) = answered {
                Some(*reading)
            } else {
                None
            }
        })
        .flatten()
    }

    fn random_of_function(&mut self, low: i32, high: i32) -> i32 {
        self.random(low, high)
    }

    fn random(&mut self, low: i32, _high: i32) -> i32 {
        let number = self.next(|answered| {
            if let Answered::Random(number) = answered {
                Some(*number)
            } else {
                None
            }
        });
        number.unwrap_or(low)
    }

    fn mail(&mut self) -> Option<String> {
        let text = self.next(|answered| {
            if let Answered::Mail(text) = answered {
                Some(text.as_deref())
            } else {
                None
            }
        });
        text.flatten().map(str::to_owned)
    }

    fn letter(&mut self) -> Option<(Option<i32>, String)> {
        let letter = self.next(|answered| {
            if let Answered::Letter(letter) = answered {
                Some(letter.as_ref())
            } else {
                None
            }
        });
        let (sender, text) = letter.flatten()?;
        Some((*sender, text.to_string()))
    }

    fn contents(&mut self, _file: &str) -> Option<String> {
        let text = self.next(|answered| {
            if let Answered::Contents(text) = answered {
                Some(text.as_deref())
            } else {
                None
            }
        });
        text.flatten().map(str::to_owned)
    }

    fn ask(&mut self, _question: Question<'_>) -> Answer {
        let answer = self.next(|answered| {
            if let Answered::Person(answer) = answered {
                Some((**answer).clone())
            } else {
                None
            }
        });
        answer.unwrap_or(Answer::Waiting)
    }

    fn may_ask_again(&mut self, _question: Question<'_>) -> bool {
        let may = self.next(|answered| {
            if let Answered::Again(may) = answered {
                Some(*may)
            } else {
                None
            }
        });
        may.unwrap_or(false)
    }
}
