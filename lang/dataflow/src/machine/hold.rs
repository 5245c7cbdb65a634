//! The block that holds a token for a time, and what comes to it meanwhile.
//!
//! Owns what is kept and what is lost. When its time is over is known to the machine.

use super::state::{Held, Memory};
use super::{Env, Halt, Machine, words};
use crate::limits;
use crate::program::{NodeId, Target};
use lang_expr::Value;

// Its ports are CF_IN, CF_OUT, DATA, OUT and TIME.
const CONTROL: u8 = 0;
const OUT: u8 = 3;
const TIME: u8 = 4;

impl Machine {
    /// A token comes to a wait.
    pub(super) fn hold(
        &mut self,
        to: Target,
        value: Value,
        keeps: bool,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        match (self.is_holding(to.node), keeps) {
            (false, _) => return self.take_up(to, value, env),
            (true, true) => self.keep(to, value, env),
            (true, false) => self.lose(to, words::busy(), env),
        }
        Ok(())
    }

    fn is_holding(&self, id: NodeId) -> bool {
        let memory = &self.states[id as usize].memory;
        matches!(memory, Memory::Hold { held: Some(_), .. })
    }

    /// A token waits its turn; without room for it the oldest ones are lost, or it itself if their going would not be enough.
    fn keep(&mut self, to: Target, value: Value, env: &mut Env<'_>) {
        let Memory::Hold { kept, .. } = &self.states[to.node as usize].memory else {
            return;
        };
        if self.queued.saturating_add(value.cells()) > limits::QUEUED_CELLS_MAX {
            let own: u32 = kept.iter().map(|(_, value)| value.cells()).sum();
            let others = self.queued.saturating_sub(own);
            if others.saturating_add(value.cells()) > limits::QUEUED_CELLS_MAX {
                self.lose(to, words::kept_too_heavy(), env);
                return;
            }
        }
        loop {
            let Memory::Hold { kept, .. } = &mut self.states[to.node as usize].memory else {
                return;
            };
            let is_crowded = kept.len() >= limits::QUEUE_MAX;
            let queued = self.queued.saturating_add(value.cells());
            if !is_crowded && queued <= limits::QUEUED_CELLS_MAX {
                kept.push_back((to.port, value));
                self.queued = queued;
                return;
            }
            let Some((port, oldest)) = kept.pop_front() else {
                return;
            };
            self.queued = self.queued.saturating_sub(oldest.cells());
            let why = match is_crowded {
                true => words::kept_overflow(limits::QUEUE_MAX),
                false => words::kept_too_heavy(),
            };
            self.lose(Target { port, ..to }, why, env);
        }
    }

    /// The time of a wait is over.
    pub(super) fn end_hold(&mut self, id: NodeId, env: &mut Env<'_>) -> Result<(), Halt> {
        if let Memory::Hold { held, .. } = &mut self.states[id as usize].memory
            && let Some(Held::Token(token)) = held.take()
        {
            self.send(id, OUT, &token, env)?;
        }
        self.done(id, env)?;
        self.take_kept(id, env)
    }

    /// What was kept while a token was held, up to the next one that is held itself.
    fn take_kept(&mut self, id: NodeId, env: &mut Env<'_>) -> Result<(), Halt> {
        while !self.is_holding(id) {
            let Memory::Hold { kept, .. } = &mut self.states[id as usize].memory else {
                return Ok(());
            };
            let Some((port, value)) = kept.pop_front() else {
                return Ok(());
            };
            self.queued = self.queued.saturating_sub(value.cells());
            self.take_up(Target { node: id, port }, value, env)?;
        }
        Ok(())
    }

    /// A token comes to a wait that holds none.
    fn take_up(&mut self, to: Target, value: Value, env: &mut Env<'_>) -> Result<(), Halt> {
        if to.port == TIME {
            let time = self.whole(to, &value, env)?;
            if let Memory::Hold { ms, .. } = &mut self.states[to.node as usize].memory {
                *ms = time;
            }
            return Ok(());
        }
        let Memory::Hold { ms, held, .. } = &mut self.states[to.node as usize].memory else {
            return Ok(());
        };
        let due = self.now.saturating_add(Self::steps(*ms));
        *held = Some(if to.port == CONTROL {
            Held::Start
        } else {
            Held::Token(value)
        });
        self.set_timer(to.node, due);
        Ok(())
    }
}
