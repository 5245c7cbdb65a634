//! The flow from block to block: who runs, what each operation does, where it leads.
//!
//! Owns the order in which threads run: one until it waits, and the threads that it wakes or begins before it. Device commands are
//! in `perform`, waits in `waits`.

use std::rc::Rc;

use super::clocks::Purpose;
use super::loops::Comer;
use super::threads::{Handle, State};
use super::{Deferred, Env, Machine, TURN_MS, words};
use crate::blocks::Type;
use crate::limits;
use crate::ports::Port;
use crate::program::{Copying, Node, Op, Program};
use lang_expr::Compat;

/// How many blocks a thread enters before others get a turn.
const BLOCKS_IN_A_TURN: u32 = 100;

/// What an operation leads to.
pub(super) enum Flow {
    /// The next block, at once.
    Next(Node),
    /// Nothing more now: the thread waits, has ended, or somebody else runs first.
    Leave,
    /// An error that was told; the thread ends.
    Failed,
}

impl Machine {
    /// Lets the thread on top run until none is left, one is held, or the beginning is kept for a while.
    pub(super) fn drive(&mut self, env: &mut Env<'_>) {
        while let Some(&handle) = self.active.last() {
            if self.held.is_some() {
                return;
            }
            let state = match self.threads.get_mut(handle) {
                None => {
                    self.active.pop();
                    continue;
                }
                Some(thread) => &mut thread.state,
            };
            match state {
                State::Ready => self.run_blocks(handle, true, env),
                State::Resumed => self.run_blocks(handle, false, env),
                State::Starting(threads) => match threads.pop() {
                    None => *state = State::Ready,
                    Some((name, node)) => {
                        self.begin_thread(name, node, env);
                        if self.is_beginning && self.options.in_turns && self.ended.is_none() {
                            let chain = std::mem::take(&mut self.active);
                            self.kept = Some((chain, self.now.saturating_add(TURN_MS)));
                            return;
                        }
                    }
                },
                State::Waiting | State::Deferred | State::Held => {
                    self.active.pop();
                }
                State::Failed => self.end_thread(handle, env),
            }
        }
    }

    fn begin_thread(&mut self, name: Rc<str>, node: Node, env: &mut Env<'_>) {
        if self.threads.named(&name).is_some() {
            self.tell_nowhere(words::thread_is_there(&name), env);
            self.end_all(env);
            return;
        }
        match self.threads.spawn(name.clone(), node) {
            Some(handle) => {
                env.trace.thread_started(self.now, handle.slot, &name);
                self.active.push(handle);
            }
            None => {
                self.tell_nowhere(words::too_many_threads(limits::THREADS_MAX), env);
                self.end_all(env);
            }
        }
    }

    fn tell_nowhere(&mut self, words: lang_text::problem::Words, env: &mut Env<'_>) {
        self.report(lang_text::problem::Problem::error(words), env);
    }

    /// Runs blocks of a thread until it leaves. The loop exists twice, so that a machine without a guard pays nothing.
    fn run_blocks(&mut self, handle: Handle, is_entered: bool, env: &mut Env<'_>) {
        match self.is_guarded {
            true => self.execute::<true>(handle, is_entered, env),
            false => self.execute::<false>(handle, is_entered, env),
        }
    }

    /// See [`Machine::run_blocks`].
    fn execute<const GUARDED: bool>(
        &mut self,
        handle: Handle,
        mut is_entered: bool,
        env: &mut Env<'_>,
    ) {
        let program = self.program.clone();
        let Some(thread) = self.threads.get(handle) else {
            return;
        };
        let (mut node, mut count) = (thread.node, thread.count);
        let (mut from, mut depth) = (thread.from, thread.stack.len());
        loop {
            if is_entered {
                if GUARDED && self.holds(handle, (from, node), count, env) {
                    return;
                }
                env.trace.entered(self.now, handle.slot, node);
                count += 1;
                if count > BLOCKS_IN_A_TURN {
                    self.save(handle, (from, node), 0, State::Deferred);
                    self.deferred.push_back(Deferred::Thread(handle));
                    return;
                }
            }
            is_entered = true;
            let Some(op) = program.ops.get(node as usize) else {
                return;
            };
            // The commonest ones need nothing of the thread. The others go on to `special` and `device`, which name all.
            #[expect(clippy::wildcard_enum_match_arm)]
            let flow = match *op {
                Op::Pass { next } => Flow::Next(next),
                Op::Loop {
                    source,
                    body,
                    next,
                    counter,
                } => {
                    let comer = Comer {
                        node,
                        from,
                        life: handle.life,
                        depth,
                    };
                    self.count_down(&program, comer, (source, counter), (body, next), env)
                }
                Op::If { source, yes, no } => match self.evaluate(node, source, Type::Truth, env) {
                    Some(value) => Flow::Next(if value.to_bool() { yes } else { no }),
                    None => Flow::Failed,
                },
                Op::Run { source, next } => self.run(handle, node, (source, next), env),
                ref op => {
                    self.save(handle, (from, node), count, State::Waiting);
                    let flow = self.special(&program, handle, node, op, env);
                    if let Some(thread) = self.threads.get(handle) {
                        // Behind a return this is the call.
                        node = thread.node;
                        depth = thread.stack.len();
                    }
                    flow
                }
            };
            match flow {
                Flow::Next(next) => {
                    from = Some(node);
                    node = next;
                }
                Flow::Leave => {
                    if GUARDED {
                        self.report_wait(handle, env);
                    }
                    return;
                }
                Flow::Failed => return self.fail(handle, (from, node), count, env),
            }
        }
    }

    pub(super) fn save(
        &mut self,
        handle: Handle,
        (from, node): (Option<Node>, Node),
        count: u32,
        state: State,
    ) {
        if let Some(thread) = self.threads.get_mut(handle) {
            thread.from = from;
            thread.node = node;
            thread.count = count;
            thread.state = state;
        }
    }

    fn run(&mut self, handle: Handle, node: Node, to: (u32, Node), env: &mut Env<'_>) -> Flow {
        if self.evaluate(node, to.0, Type::Statements, env).is_none() {
            return Flow::Failed;
        }
        let now = self.now;
        self.formulas.changed(|name, value| {
            env.trace.changed(now, handle.slot, name, value);
        });
        Flow::Next(to.1)
    }

    fn count_down(
        &mut self,
        program: &Program,
        comer: Comer,
        (source, counter): (u32, u32),
        (body, next): (Node, Node),
        env: &mut Env<'_>,
    ) -> Flow {
        if self.loops.is_fresh(counter, comer, program) {
            let Some(value) = self.evaluate(comer.node, source, Type::Whole, env) else {
                return Flow::Failed;
            };
            self.loops.set(counter, comer, value.to_int());
        }
        match self.loops.next(counter, comer) {
            true => Flow::Next(body),
            false => Flow::Next(next),
        }
    }

    /// Operations that wait, or touch threads. The thread stands at the node as a waiting one.
    fn special(
        &mut self,
        program: &Program,
        handle: Handle,
        node: Node,
        op: &Op,
        env: &mut Env<'_>,
    ) -> Flow {
        match *op {
            Op::End => self.end_diagram(program, handle, env),
            Op::Fault { fault } => {
                if let Some(problem) = program.faults.get(fault as usize) {
                    self.report(problem.clone(), env);
                }
                Flow::Failed
            }
            Op::Switch { switch } => {
                let switch = &program.switches[switch as usize];
                let Some(value) = self.evaluate(node, switch.source, Type::Text, env) else {
                    return Flow::Failed;
                };
                let text = value.to_text();
                let branches = match self.options.compat {
                    Compat::Studio => &switch.branches,
                    Compat::Fixed => &switch.exact,
                };
                let found = branches.binary_search_by(|(guard, _)| (**guard).cmp(&*text));
                Flow::Next(found.map_or(switch.other, |at| branches[at].1))
            }
            Op::Fork { fork } => self.fork(program, handle, node, fork as usize, env),
            Op::Join { join, .. } => self.join(program, handle, node, join as usize, env),
            Op::Kill { message, next } => {
                let name = &program.messages[message as usize].thread;
                match self.threads.named(name) {
                    Some(other) => self.end_thread(other, env),
                    None => self.error_at(node, words::no_such_thread(name), env),
                }
                self.continue_with(handle, next)
            }
            Op::Send { message, next } => self.send(program, handle, (node, next), message, env),
            Op::Receive { assignment, next } => {
                let assignment = &program.assignments[assignment as usize];
                let thread = self.threads.get_mut(handle);
                match thread.and_then(|thread| thread.messages.pop_front()) {
                    Some(message) => {
                        let statement = self.received(&assignment.variable, &message);
                        self.splice(handle, node, &statement, next, env)
                    }
                    None if !assignment.wait => Flow::Next(next),
                    None => self.wait(handle, node),
                }
            }
            Op::Call { call, .. } => self.call(program, handle, node, call as usize, env),
            ref op @ (Op::Pass { .. }
            | Op::Run { .. }
            | Op::If { .. }
            | Op::Loop { .. }
            | Op::Timer { .. }
            | Op::Random { .. }
            | Op::Ask { .. }
            | Op::AnyButton { .. }
            | Op::Mail { .. }
            | Op::Copy { .. }
            | Op::Act { .. }
            | Op::Watch { .. }) => self.device(program, handle, node, op, env),
        }
    }

    /// Operations on devices, and those that wait.
    fn device(
        &mut self,
        program: &Program,
        handle: Handle,
        node: Node,
        op: &Op,
        env: &mut Env<'_>,
    ) -> Flow {
        match *op {
            Op::Timer { source, .. } => {
                let Some(value) = self.evaluate(node, source, Type::Whole, env) else {
                    return Flow::Failed;
                };
                self.wait_for(handle, node, Purpose::Timer, value.to_int())
            }
            Op::Random { assignment, next } => {
                let assignment = &program.assignments[assignment as usize];
                let Some((low, high)) = assignment.bounds else {
                    return Flow::Next(next);
                };
                let Some(low) = self.evaluate(node, low, Type::Whole, env) else {
                    return Flow::Failed;
                };
                let Some(high) = self.evaluate(node, high, Type::Whole, env) else {
                    return Flow::Failed;
                };
                let (low, high) = (low.to_int(), high.to_int());
                let number = env.brick.random(low.min(high), low.max(high));
                let statement = format!("{} = {number}", assignment.variable);
                self.splice(handle, node, &statement, next, env)
            }
            Op::Copy { copy, next } => {
                let copying = &program.copies[copy as usize];
                self.copy(handle, (node, next), copying, env)
            }
            Op::Act { action, next } => {
                match self.perform(node, &program.actions[action as usize], env) {
                    None => Flow::Failed,
                    Some(false) => Flow::Next(next),
                    Some(true) => {
                        self.deferred.push_back(Deferred::Block(node));
                        self.wait(handle, node)
                    }
                }
            }
            Op::Mail { assignment, next } if !program.assignments[assignment as usize].wait => {
                let message = env.brick.mail().unwrap_or_default();
                let statement = super::waits::mail(program, assignment, &message);
                self.splice(handle, node, &statement, next, env)
            }
            Op::Mail { .. } => self.wait_for(handle, node, Purpose::Mail, 100),
            Op::AnyButton { .. } => self.wait_for(handle, node, Purpose::AnyButton, 20),
            Op::Ask { .. } => self.wait_for(handle, node, Purpose::Ask, 1),
            Op::Watch { watch, .. } => {
                self.watch(handle, node, &program.watches[watch as usize], env)
            }
            // They are done above.
            Op::Pass { .. }
            | Op::End
            | Op::Fault { .. }
            | Op::Run { .. }
            | Op::If { .. }
            | Op::Loop { .. }
            | Op::Switch { .. }
            | Op::Fork { .. }
            | Op::Join { .. }
            | Op::Kill { .. }
            | Op::Send { .. }
            | Op::Receive { .. }
            | Op::Call { .. } => self.wait(handle, node),
        }
    }

    pub(super) fn wait(&mut self, handle: Handle, node: Node) -> Flow {
        self.threads.wait(handle, node);
        Flow::Leave
    }

    /// Goes on if the thread still lives.
    pub(super) fn continue_with(&mut self, handle: Handle, next: Node) -> Flow {
        match self.threads.get(handle) {
            Some(_) => Flow::Next(next),
            None => Flow::Leave,
        }
    }

    /// Runs a statement that a block has put together.
    fn splice(
        &mut self,
        handle: Handle,
        node: Node,
        statement: &str,
        next: Node,
        env: &mut Env<'_>,
    ) -> Flow {
        match self.run_text(node, handle.slot, statement, env) {
            true => Flow::Next(next),
            false => Flow::Failed,
        }
    }

    fn copy(
        &mut self,
        handle: Handle,
        (node, next): (Node, Node),
        copying: &Copying,
        env: &mut Env<'_>,
    ) -> Flow {
        if let Some(needed) = copying.copied.device
            && !Port::named(needed.port).is_some_and(|port| self.answers(port, env))
        {
            self.error_at(node, (needed.absent)(), env);
            return Flow::Failed;
        }
        self.run(handle, node, (copying.source, next), env)
    }
}
