//! Threads of a running program: who lives, where each one is, what it waits for.
//!
//! Owns their table. Knows no operations.

use std::collections::VecDeque;
use std::rc::Rc;

use crate::limits;
use crate::program::Node;
use lang_expr::Value;

/// One thread in one life of its slot.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) struct Handle {
    pub slot: u16,
    pub life: u32,
}

/// What a thread is about to do.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) enum State {
    /// Enter its node.
    Ready,
    /// Run its node, which it has entered before.
    Resumed,
    /// Wait at its node.
    Waiting,
    /// Wait for the next turn, having entered its node.
    Deferred,
    /// Nothing, until it is released; then enter its node.
    Held,
    /// End, after an error at its node that was told.
    Failed,
    /// Begin these threads, the last one first, and then enter its node.
    Starting(Vec<(Rc<str>, Node)>),
}

/// A call that has not returned, and what its parameters were before.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub node: Node,
    pub saved: Vec<(u32, Option<Value>)>,
}

#[derive(Clone, Debug)]
pub(crate) struct Thread {
    pub name: Rc<str>,
    pub node: Node,
    /// Where it came from to its node.
    pub from: Option<Node>,
    pub state: State,
    pub stack: Vec<Frame>,
    pub messages: VecDeque<Rc<str>>,
    /// Blocks since it last gave way.
    pub count: u32,
    /// Grows with each wait, so that threads at one block have an order.
    since: u32,
    life: u32,
}

impl Thread {
    pub fn is_waiting_at(&self, node: Node) -> bool {
        self.node == node && self.state == State::Waiting
    }

    /// Enters a node next.
    pub fn go(&mut self, node: Node) {
        self.from = Some(self.node);
        self.node = node;
        self.state = State::Ready;
    }
}

/// All threads.
#[derive(Clone, Debug, Default)]
pub(crate) struct Threads {
    slots: Vec<Option<Thread>>,
    lives: u32,
    waits: u32,
    fresh: u32,
}

impl Threads {
    /// Begins a thread; `None` if there are too many.
    pub fn spawn(&mut self, name: Rc<str>, node: Node) -> Option<Handle> {
        if self.alive().count() >= limits::THREADS_MAX {
            return None;
        }
        self.lives = self.lives.wrapping_add(1);
        let thread = Thread {
            name,
            node,
            from: None,
            state: State::Ready,
            stack: Vec::new(),
            messages: VecDeque::new(),
            count: 0,
            since: 0,
            life: self.lives,
        };
        let slot = match self.slots.iter().position(Option::is_none) {
            Some(slot) => slot,
            None => {
                self.slots.push(None);
                self.slots.len() - 1
            }
        };
        self.slots[slot] = Some(thread);
        Some(Handle {
            slot: slot as u16,
            life: self.lives,
        })
    }

    /// A name that no thread has.
    pub fn fresh_name(&mut self) -> Rc<str> {
        loop {
            self.fresh = self.fresh.wrapping_add(1);
            let name = format!("thread-{}", self.fresh);
            if self.named(&name).is_none() {
                return name.into();
            }
        }
    }

    pub fn get(&self, handle: Handle) -> Option<&Thread> {
        let thread = self.slots.get(usize::from(handle.slot))?.as_ref()?;
        (thread.life == handle.life).then_some(thread)
    }

    pub fn get_mut(&mut self, handle: Handle) -> Option<&mut Thread> {
        let thread = self.slots.get_mut(usize::from(handle.slot))?.as_mut()?;
        (thread.life == handle.life).then_some(thread)
    }

    pub fn alive(&self) -> impl Iterator<Item = &Thread> {
        self.slots.iter().flatten()
    }

    pub fn alive_mut(&mut self) -> impl Iterator<Item = &mut Thread> {
        self.slots.iter_mut().flatten()
    }

    pub fn name(&self, slot: u16) -> Option<&str> {
        let thread = self.slots.get(usize::from(slot))?.as_ref()?;
        Some(&thread.name)
    }

    pub fn named(&self, name: &str) -> Option<Handle> {
        self.handles()
            .find(|(_, thread)| &*thread.name == name)
            .map(|(handle, _)| handle)
    }

    pub fn handles(&self) -> impl Iterator<Item = (Handle, &Thread)> {
        self.slots.iter().enumerate().filter_map(|(slot, thread)| {
            let thread = thread.as_ref()?;
            let handle = Handle {
                slot: slot as u16,
                life: thread.life,
            };
            Some((handle, thread))
        })
    }

    /// Makes a thread wait at its node.
    pub fn wait(&mut self, handle: Handle, node: Node) {
        self.waits = self.waits.wrapping_add(1);
        let since = self.waits;
        if let Some(thread) = self.get_mut(handle) {
            thread.node = node;
            thread.state = State::Waiting;
            thread.since = since;
        }
    }

    /// Who waits at a node, in the order in which they came.
    pub fn waiting_at(&self, node: Node) -> Vec<Handle> {
        let mut found: Vec<_> = self
            .handles()
            .filter(|(_, thread)| thread.is_waiting_at(node))
            .map(|(handle, thread)| (thread.since, handle))
            .collect();
        found.sort_by_key(|(since, _)| *since);
        found.into_iter().map(|(_, handle)| handle).collect()
    }

    /// Ends a thread; false if it had ended.
    pub fn end(&mut self, handle: Handle) -> bool {
        let is_alive = self.get(handle).is_some();
        if is_alive {
            self.slots[usize::from(handle.slot)] = None;
        }
        is_alive
    }

    /// Ends all; who lived until now.
    pub fn end_all(&mut self) -> Vec<u16> {
        let alive = self.handles().map(|(handle, _)| handle.slot).collect();
        self.slots.clear();
        alive
    }
}
