//! `lines{ ... }` and `pictures{ ... }`: lines of text of a sensor program, or its pictures.
//!
//! Owns the keys of both, and which of them a rest needs: the program is not started for it.

use super::command::{CommandDescription, command};
use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::{Form, Rest, put_path};
use crate::fields::Fields;
use crate::limits::ANSWER_BYTES_MAX;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// `lines{ path = ..., input = ..., start = {...}, stop = {...} }`: lines of text from a program's named pipe.
///
/// A tuple is one line without its end, filled up with zero bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct LinesDescription {
    /// The pipe that the program writes to.
    pub path: PathBuf,
    /// The pipe that it reads from.
    pub input: Option<PathBuf>,
    /// Starts the program: an absolute path and arguments.
    pub start: Option<CommandDescription>,
    /// Stops it.
    pub stop: Option<CommandDescription>,
    /// What is kept for those who come later.
    pub answer: Option<AnswerDescription>,
    /// `pictures{ ... }`: the pipe gives JPEG pictures, one after the other, and no lines.
    pub are_pictures: bool,
}

/// A line to a sensor program that asks for one line from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswerDescription {
    /// The line that asks.
    pub question: String,
    /// What the line that answers begins with.
    pub answer: String,
}

impl Kind for LinesDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[
        Constructor {
            word: "lines",
            keys: &["path", "input", "start", "stop", "question", "answer"],
            read: lines,
        },
        Constructor {
            word: "pictures",
            keys: &["path", "start", "stop"],
            read: pictures,
        },
    ];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 7,
        put: |lines, out| {
            put_path(&lines.path, out)?;
            put_path(lines.input.as_ref()?, out)
        },
        take: |bytes| {
            Some(Self {
                path: bytes.path()?,
                input: Some(bytes.path()?),
                start: None,
                stop: None,
                answer: None,
                are_pictures: false,
            })
        },
    });

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.path);
        self.input.iter_mut().for_each(&mut *take);
        for command in self.start.iter_mut().chain(&mut self.stop) {
            take(&mut command.program);
        }
    }

    fn needed_paths(&self) -> Vec<&Path> {
        // The program makes its pipes when it is started.
        match &self.start {
            Some(start) => vec![&start.program],
            None => vec![&self.path],
        }
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Stream
    }

    fn takes_writes(&self) -> bool {
        self.input.is_some()
    }

    fn kept_answer(&self) -> Option<&str> {
        self.answer.as_ref().map(|kept| kept.answer.as_str())
    }
}

/// `lines{ path = ..., input = ..., start = { '/etc/init.d/x', 'start' }, stop = {...} }`
fn lines(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<LinesDescription, Problem> {
    let path = fields.own_path("lines")?;
    let input = fields
        .get("input")
        .map(|value| fields.absolute("input", value))
        .transpose()?;
    let start = command(fields, "lines", "start")?;
    let stop = command(fields, "lines", "stop")?;
    if stop.is_some() && start.is_none() {
        return Err(fields.problem("src", "lines: stop makes no sense without start"));
    }
    let answer = answer(fields, input.is_some())?;
    Ok(LinesDescription {
        path,
        input,
        start,
        stop,
        answer,
        are_pictures: false,
    })
}

/// `pictures{ path = ..., start = { '/etc/init.d/x', 'start' }, stop = {...} }`
fn pictures(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<LinesDescription, Problem> {
    let path = fields.own_path("pictures")?;
    let start = command(fields, "pictures", "start")?;
    let stop = command(fields, "pictures", "stop")?;
    if stop.is_some() && start.is_none() {
        return Err(fields.problem("src", "pictures: stop makes no sense without start"));
    }
    Ok(LinesDescription {
        path,
        input: None,
        start,
        stop,
        answer: None,
        are_pictures: true,
    })
}

/// The line that asks, and how the line that answers begins.
fn answer(fields: &Fields<'_>, has_input: bool) -> Result<Option<AnswerDescription>, Problem> {
    let word = |field| fields.text(field, ANSWER_BYTES_MAX);
    let (question, answer) = match (word("question")?, word("answer")?) {
        (None, None) => return Ok(None),
        (Some(question), Some(answer)) if !question.is_empty() && !answer.is_empty() => {
            (question.to_owned(), answer.to_owned())
        }
        _ => {
            let reason = "lines: question and answer belong together, for example question = 'detect', answer = 'hsv:'";
            return Err(fields.problem("src", reason));
        }
    };
    if !has_input {
        let reason = "lines: question makes no sense without input";
        return Err(fields.problem("src", reason));
    }
    Ok(Some(AnswerDescription { question, answer }))
}
