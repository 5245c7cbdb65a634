//! Texts for programs that are run once for each: one after the other, without anybody waiting.
//!
//! Owns the queue of each program. Its thread ends with its last text.

use super::Programs;
use crate::command::{self, Limits};
use crate::errno::Error;
use crate::events::lock;
use crate::limits;
use config::description::CommandDescription;
use std::collections::VecDeque;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// A program and the texts that wait for it; the one that it is busy with is not among them.
pub(super) struct TextQueue {
    command: CommandDescription,
    texts: VecDeque<String>,
}

impl Programs {
    /// Runs a program with a text as its last argument, after those that it was given before before.
    ///
    /// # Errors
    /// EBUSY while as many wait as the limit allows; EAGAIN if there is no thread for it.
    pub fn enqueue(
        self: &Arc<Self>,
        command: &CommandDescription,
        text: &str,
    ) -> Result<(), Error> {
        let mut all = lock(&self.text_queues);
        if let Some(queue) = all.iter_mut().find(|queue| queue.command == *command) {
            if queue.texts.len() >= limits::PROGRAM_TEXTS_MAX {
                let what = format!(
                    "{} texts wait for {} already",
                    queue.texts.len(),
                    command.program.display()
                );
                return Err(Error::Busy(what));
            }
            queue.texts.push_back(text.to_owned());
            return Ok(());
        }
        let (programs, own) = (self.clone(), command.clone());
        let thread = std::thread::Builder::new().name("program-text".to_owned());
        let started = thread.spawn(move || {
            while let Some(text) = programs.next_text(&own) {
                programs.run_with(&own, &text);
            }
        });
        if let Err(error) = started {
            return Err(Error::of_system(format!("no thread: {error}"), &error));
        }
        all.push(TextQueue {
            command: command.clone(),
            texts: VecDeque::from([text.to_owned()]),
        });
        Ok(())
    }

    fn next_text(&self, command: &CommandDescription) -> Option<String> {
        let mut all = lock(&self.text_queues);
        let at = all.iter().position(|queue| queue.command == *command)?;
        let text = all[at].texts.pop_front();
        if text.is_none() {
            all.remove(at);
        }
        text
    }

    fn run_with(&self, description: &CommandDescription, text: &str) {
        let is_over = || self.is_ending.load(Ordering::Relaxed);
        if is_over() {
            return;
        }
        let mut command = Command::new(&description.program);
        command
            .args(&description.arguments)
            .arg(text)
            .current_dir("/");
        let limits = Limits {
            groups: Some(self.groups.clone()),
            time: Duration::from_millis(limits::PROGRAM_TEXT_MS_MAX.into()),
            output_bytes: limits::PROGRAM_OUTPUT_BYTES_MAX,
        };
        let shown = description.program.display();
        match command::run_unless(command, &limits, &is_over) {
            Err(error) => self.log.line(&format!("{shown} cannot be run: {error}")),
            Ok(ended) => {
                for line in ended.output.lines() {
                    self.log.line(&format!("{shown}: {line}"));
                }
                match ended.status {
                    Some(status) if status.success() => {}
                    Some(status) => self.log.line(&format!("{shown} ended with {status}")),
                    None => self
                        .log
                        .line(&format!("{shown} took too long and was ended")),
                }
                super::drain(ended);
            }
        }
    }
}
