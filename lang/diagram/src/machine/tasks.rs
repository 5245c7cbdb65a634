//! Threads and subprograms: fork and join, messages, calls and returns.
//!
//! Owns what these operations do to threads and variables; `flow` runs the threads that they wake or begin.

use super::flow::Flow;
use super::threads::{Frame, Handle, State};
use super::{Env, Machine, words};
use crate::blocks::Type;
use crate::limits;
use crate::program::{ArgumentKind, NOWHERE, Node, Op, Program};
use lang_expr::{Compat, Value};

impl Machine {
    /// The end of a diagram: back to the call, or the end of the thread.
    pub(super) fn end_diagram(
        &mut self,
        program: &Program,
        handle: Handle,
        env: &mut Env<'_>,
    ) -> Flow {
        let Some(thread) = self.threads.get_mut(handle) else {
            return Flow::Leave;
        };
        let depth = thread.stack.len();
        let Some(Frame { node, saved }) = thread.stack.pop() else {
            self.end_thread(handle, env);
            return Flow::Leave;
        };
        thread.node = node;
        self.loops.forget(handle.life, depth);
        for (slot, value) in saved {
            let value = match (value, self.options.compat) {
                // As the original has it: what was nothing is an empty text now.
                (None, Compat::Studio) => Some(Value::text("")),
                (value, _) => value,
            };
            self.formulas.put(slot, value);
        }
        match program.ops.get(node as usize) {
            Some(Op::Call { next, .. }) => Flow::Next(*next),
            // Only calls leave a frame, so anything else is a mistake of ours.
            _ => Flow::Failed,
        }
    }

    pub(super) fn call(
        &mut self,
        program: &Program,
        handle: Handle,
        node: Node,
        call: usize,
        env: &mut Env<'_>,
    ) -> Flow {
        let call = &program.calls[call];
        let mut saved = Vec::with_capacity(call.arguments.len());
        for argument in &call.arguments {
            if let Some(slot) = self.formulas.slot(&argument.name) {
                saved.push((slot, self.formulas.value(slot)));
            }
        }
        for argument in &call.arguments {
            let wanted = match argument.kind {
                ArgumentKind::Truth => Type::Truth,
                ArgumentKind::Whole => Type::Whole,
                ArgumentKind::Number => Type::Number,
                ArgumentKind::Text => Type::Text,
            };
            let Some(value) = self.evaluate(node, argument.source, wanted, env) else {
                return Flow::Failed;
            };
            let value = match argument.kind {
                ArgumentKind::Truth => Value::Bool(value.to_bool()),
                ArgumentKind::Whole => Value::Int(value.to_int()),
                ArgumentKind::Number => Value::Float(value.to_float()),
                ArgumentKind::Text => Value::Text(value.to_text()),
            };
            if let Some(slot) = self.formulas.assign(&argument.name, &value) {
                env.trace
                    .changed(self.now, handle.slot, &argument.name, &value);
                self.formulas.put(slot, Some(value));
            }
        }
        let Some(diagram) = call.diagram else {
            return self.wait(handle, node);
        };
        let Some(entry) = program.entries.get(diagram as usize).copied().flatten() else {
            let sheet = program.diagrams.get(diagram as usize);
            let mut problem = lang_text::problem::Problem::error(words::no_entry());
            problem.place.diagram = sheet.map(|sheet| sheet.name.to_string());
            problem.place.object = sheet.map(|sheet| sheet.id.to_string());
            self.report(problem, env);
            return Flow::Failed;
        };
        let Some(thread) = self.threads.get_mut(handle) else {
            return Flow::Leave;
        };
        thread.stack.push(Frame { node, saved });
        if thread.stack.len() >= limits::STACK_MAX {
            self.error_at(node, words::stack_overflow(), env);
            return Flow::Failed;
        }
        Flow::Next(entry)
    }

    pub(super) fn fork(
        &mut self,
        program: &Program,
        handle: Handle,
        node: Node,
        fork: usize,
        env: &mut Env<'_>,
    ) -> Flow {
        if self.options.compat == Compat::Fixed {
            self.forks[fork].clear();
        }
        let mut first_fresh = None;
        for (name, target) in &program.forks[fork].branches {
            let name = match name {
                Some(name) => name.clone(),
                None => {
                    let name = self.threads.fresh_name();
                    first_fresh.get_or_insert(name.clone());
                    name
                }
            };
            if self.forks[fork].len() >= limits::FORK_NAMES_MAX {
                self.error_at(node, words::too_many_threads(limits::THREADS_MAX), env);
                return Flow::Failed;
            }
            if self.forks[fork].contains_key(&name) {
                self.error_at(node, words::thread_twice(&name), env);
                return Flow::Failed;
            }
            self.forks[fork].insert(name, *target);
        }
        let Some(thread) = self.threads.get(handle) else {
            return Flow::Leave;
        };
        let me = thread.name.clone();
        let mine = match self.forks[fork].remove(&me) {
            Some(mine) => Some(mine),
            None => first_fresh.and_then(|name| self.forks[fork].remove(&name)),
        };
        let Some(mine) = mine else {
            self.error_at(node, words::fork_without_me(&me), env);
            return Flow::Failed;
        };
        let begun = self.forks[fork].iter().rev();
        let begun = begun.map(|(name, node)| (name.clone(), *node)).collect();
        if let Some(thread) = self.threads.get_mut(handle) {
            thread.node = mine;
            thread.state = State::Starting(begun);
        }
        Flow::Leave
    }

    pub(super) fn join(
        &mut self,
        program: &Program,
        handle: Handle,
        node: Node,
        join: usize,
        env: &mut Env<'_>,
    ) -> Flow {
        let plan = &program.joins[join];
        let is_survivor = self
            .threads
            .get(handle)
            .is_some_and(|thread| thread.name == plan.survivor);
        if is_survivor {
            self.threads.wait(handle, node);
        } else {
            self.end_thread(handle, env);
        }
        self.tokens[join] = self.tokens[join].saturating_add(1);
        if self.tokens[join] == plan.incoming && self.ended.is_none() {
            if self.options.compat == Compat::Fixed {
                self.tokens[join] = 0;
            }
            let next = self.next_of(node).unwrap_or(NOWHERE);
            for waiting in self.threads.waiting_at(node).into_iter().rev() {
                if let Some(thread) = self.threads.get_mut(waiting) {
                    thread.go(next);
                }
                if waiting != handle {
                    self.active.push(waiting);
                }
            }
        }
        Flow::Leave
    }

    /// The statement that assigns a message of another thread. In the original the message is an expression of its own; if
    /// oddities are mended, a number is a number and everything else a text, with its quotes or without.
    pub(super) fn received(&self, variable: &str, message: &str) -> String {
        if self.options.compat == Compat::Studio || message.trim().parse::<i32>().is_ok() {
            return format!("{variable} = {message}");
        }
        if let Ok(number) = message.trim().parse::<f64>()
            && number.is_finite()
        {
            return format!("{variable} = {number:?}");
        }
        let quoted = ['\'', '"']
            .into_iter()
            .find_map(|quote| message.strip_prefix(quote)?.strip_suffix(quote));
        format!(
            "{variable} = \"{}\"",
            lang_expr::escape(quoted.unwrap_or(message))
        )
    }

    pub(super) fn send(
        &mut self,
        program: &Program,
        handle: Handle,
        (node, next): (Node, Node),
        message: u32,
        env: &mut Env<'_>,
    ) -> Flow {
        let message = &program.messages[message as usize];
        let Some(value) = self.evaluate(node, message.source, Type::Text, env) else {
            return Flow::Failed;
        };
        let text = value.to_text();
        let Some(other) = self.threads.named(&message.thread) else {
            return Flow::Next(next);
        };
        env.trace.sent(self.now, handle.slot, other.slot, &text);
        let Some(thread) = self.threads.get_mut(other) else {
            return Flow::Next(next);
        };
        let at = thread.node;
        let receives = match program.ops.get(at as usize) {
            Some(Op::Receive { assignment, next })
                if thread.state == State::Waiting
                    && thread.messages.is_empty()
                    && other != handle =>
            {
                Some((&program.assignments[*assignment as usize], *next))
            }
            // A message that is received by nothing at once is kept, whatever the thread does.
            _ => None,
        };
        match receives {
            None if thread.messages.len() >= limits::MESSAGES_MAX => {
                let words = words::mailbox_full(&message.thread, limits::MESSAGES_MAX);
                self.error_at(node, words, env);
                Flow::Failed
            }
            None => {
                thread.messages.push_back(text);
                Flow::Next(next)
            }
            Some((assignment, their_next)) => {
                let statement = self.received(&assignment.variable, &text);
                if self.run_text(at, other.slot, &statement, env) {
                    if let Some(thread) = self.threads.get_mut(handle) {
                        thread.go(next);
                    }
                    if let Some(thread) = self.threads.get_mut(other) {
                        thread.go(their_next);
                    }
                    self.active.push(other);
                    return Flow::Leave;
                }
                self.end_thread(other, env);
                self.continue_with(handle, next)
            }
        }
    }
}
