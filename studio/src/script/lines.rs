//! At which lines of its text a program waits and asks the robot, thread by thread, for people who look on.
//!
//! Owns what is kept of it: the last such line of each thread, and when that was. A program that computes afterwards keeps
//! the line at which it waited or asked last. Knows no engine.

use super::words;
use crate::limits;
use lang_text::problem::Locale;
use sim::judge::{Group, Running, Spot};

/// The threads of a program, in the order in which they were seen.
#[derive(Debug, Default)]
pub struct Lines(Vec<Thread>);

#[derive(Debug)]
struct Thread {
    name: String,
    /// Empty for the program's own text.
    file: String,
    line: u32,
    at_ms: u32,
    ended_ms: Option<u32>,
}

impl Lines {
    /// A thread waits or asks there.
    pub fn stand(&mut self, name: &str, file: &str, line: u32, at_ms: u32) {
        let known = self.0.iter_mut().find(|thread| thread.name == name);
        if let Some(thread) = known {
            file.clone_into(&mut thread.file);
            (thread.line, thread.at_ms, thread.ended_ms) = (line, at_ms, None);
        } else if self.0.len() < limits::SCRIPT_LINES {
            self.0.push(Thread {
                name: name.to_owned(),
                file: file.to_owned(),
                line,
                at_ms,
                ended_ms: None,
            });
        }
    }

    /// A thread has ended.
    pub fn end(&mut self, name: &str, ended_ms: u32) {
        let known = self.0.iter_mut().find(|thread| thread.name == name);
        if let Some(thread) = known {
            thread.ended_ms = Some(ended_ms);
        }
    }

    /// Of a program in this file: the threads that live, or those that have ended last.
    pub fn running(&self, program: &str) -> Vec<Running> {
        let lives = self.0.iter().any(|thread| thread.ended_ms.is_none());
        let last = self.0.iter().filter_map(|thread| thread.ended_ms).max();
        let told = self.0.iter().filter(|thread| match lives {
            true => thread.ended_ms.is_none(),
            false => thread.ended_ms == last,
        });
        let running = told.map(|thread| Running {
            thread: thread.name.clone(),
            ended_ms: thread.ended_ms,
            at: Spot::Line {
                file: match &*thread.file {
                    "" => program.to_owned(),
                    file => file.to_owned(),
                },
                line: thread.line,
                at_ms: thread.at_ms,
            },
        });
        running.collect()
    }

    /// The same as values that change.
    pub fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        for thread in self.0.iter().filter(|thread| thread.ended_ms.is_none()) {
            let line = words::line(&thread.file, thread.line, locale);
            tell(Group::Block, &thread.name, &line);
        }
    }
}
