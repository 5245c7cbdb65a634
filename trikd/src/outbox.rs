//! What waits to be sent to one client: bounded, so that a client that does not read costs nobody but itself.
//!
//! Owns the queue and the choice of what is dropped. Knows no sockets.

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;
use tokio::sync::Notify;

/// What makes older ones of its kind pointless: the newest is never dropped.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Latest {
    /// Who is in control of the debugger.
    Control,
    /// What a diagram in a debugger is doing.
    State,
    /// Where the diagram is.
    Place,
}

/// The queue of one client.
#[derive(Debug)]
pub struct Outbox {
    queue: RefCell<VecDeque<Rc<[u8]>>>,
    bytes: Cell<usize>,
    /// Found no room in the queue, and comes after it; one of each kind.
    latest: RefCell<Vec<(Latest, Rc<[u8]>)>>,
    limit: usize,
    dropped: Cell<u32>,
    closes: Cell<bool>,
    filled: Notify,
    drained: Notify,
}

impl Outbox {
    /// Holds at most `limit` bytes.
    pub fn new(limit: usize) -> Self {
        Self {
            queue: RefCell::default(),
            bytes: Cell::new(0),
            latest: RefCell::default(),
            limit,
            dropped: Cell::new(0),
            closes: Cell::new(false),
            filled: Notify::new(),
            drained: Notify::new(),
        }
    }

    /// Adds a frame that is encoded already; drops it if there is no room.
    pub fn push(&self, frame: Rc<[u8]>) {
        let mut latest = self.latest.borrow_mut();
        // What came before it stays before it.
        let before = latest.iter().map(|(_, frame)| frame.len()).sum::<usize>();
        if self.bytes.get() + before + frame.len() > self.limit {
            self.drops();
            return;
        }
        for (_, frame) in latest.drain(..) {
            self.add(frame);
        }
        self.add(frame);
    }

    /// Adds a frame that makes older ones of its kind pointless. False: there was no room, and it comes after all others.
    pub fn push_latest(&self, kind: Latest, frame: Rc<[u8]>) -> bool {
        let mut latest = self.latest.borrow_mut();
        if latest.is_empty() && self.bytes.get() + frame.len() <= self.limit {
            self.add(frame);
            return true;
        }
        if let Some(older) = latest.iter().position(|(other, _)| *other == kind) {
            latest.remove(older);
            self.drops();
        }
        latest.push((kind, frame));
        self.filled.notify_one();
        false
    }

    fn add(&self, frame: Rc<[u8]>) {
        self.bytes.set(self.bytes.get() + frame.len());
        self.queue.borrow_mut().push_back(frame);
        self.filled.notify_one();
    }

    fn drops(&self) {
        self.dropped.set(self.dropped.get().saturating_add(1));
    }

    /// Whether nothing waits.
    pub fn is_empty(&self) -> bool {
        self.queue.borrow().is_empty() && self.latest.borrow().is_empty()
    }

    /// Adds the frame of a payload.
    pub fn send(&self, payload: &[u8]) {
        self.push(frame::encode(payload).into());
    }

    /// Ends the connection when all before is sent.
    pub fn close(&self) {
        self.closes.set(true);
        self.filled.notify_one();
    }

    /// Whether [`Outbox::close`] was called.
    pub fn closes(&self) -> bool {
        self.closes.get()
    }

    /// The next frame; waits for one. None: the connection shall end.
    pub async fn next(&self) -> Option<Rc<[u8]>> {
        loop {
            if let Some(frame) = self.take() {
                return Some(frame);
            }
            if self.closes.get() {
                return None;
            }
            self.filled.notified().await;
        }
    }

    fn take(&self) -> Option<Rc<[u8]>> {
        if let Some(frame) = self.queue.borrow_mut().pop_front() {
            self.bytes.set(self.bytes.get() - frame.len());
            self.drained.notify_one();
            return Some(frame);
        }
        let mut latest = self.latest.borrow_mut();
        (!latest.is_empty()).then(|| latest.remove(0).1)
    }

    /// Waits until at least half of the room is free.
    pub async fn room(&self) {
        while self.bytes.get() > self.limit / 2 {
            self.drained.notified().await;
        }
    }

    /// How many frames were dropped since the last call, if all others have been taken.
    pub fn take_dropped(&self) -> Option<u32> {
        let dropped = self.dropped.get();
        (dropped > 0 && self.is_empty()).then(|| self.dropped.replace(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_of_a_kind_comes_in_the_end_whatever_was_dropped() {
        let outbox = Outbox::new(8);
        let state = |text: &str| outbox.push_latest(Latest::State, text.as_bytes().into());
        assert!(state("1234"));
        assert!(!state("56789"));
        assert!(!outbox.push_latest(Latest::Control, b"who".as_slice().into()));
        outbox.push(b"x".as_slice().into());
        assert!(!state("a state that is longer than all"));
        assert!(!outbox.is_empty());
        let runtime = tokio::runtime::Builder::new_current_thread()
            .build()
            .unwrap();
        let next = || {
            let frame = runtime.block_on(outbox.next()).unwrap();
            String::from_utf8(frame.to_vec()).unwrap()
        };
        assert_eq!(next(), "1234");
        assert_eq!(next(), "who");
        assert_eq!(outbox.take_dropped(), None);
        assert_eq!(next(), "a state that is longer than all");
        assert_eq!(outbox.take_dropped(), Some(2));
        assert!(state("12") && outbox.push_latest(Latest::State, b"345678".as_slice().into()));
        assert!(!state("9"));
        assert_eq!(next(), "12");
        outbox.push(b"x".as_slice().into());
        let order: Vec<_> = (0..3).map(|_| next()).collect();
        assert_eq!(order, ["345678", "9", "x"], "what came before stays before");
    }

    #[test]
    fn a_client_that_does_not_read_loses_the_newest_and_learns_how_many() {
        let outbox = Outbox::new(8);
        for payload in [b"ab", b"cd", b"ef"] {
            outbox.send(payload);
        }
        assert_eq!(outbox.take_dropped(), None);
        let runtime = tokio::runtime::Builder::new_current_thread()
            .build()
            .unwrap();
        runtime.block_on(async {
            assert_eq!(outbox.next().await.as_deref(), Some(&b"2:ab"[..]));
            assert_eq!(outbox.next().await.as_deref(), Some(&b"2:cd"[..]));
            assert_eq!(outbox.take_dropped(), Some(1));
            outbox.send(b"gh");
            outbox.close();
            assert_eq!(outbox.next().await.as_deref(), Some(&b"2:gh"[..]));
            assert_eq!(outbox.next().await, None);
        });
    }
}
