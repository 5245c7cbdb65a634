//! What waits to be sent to one client: bounded, so that a client that does not read costs nobody but itself.
//!
//! Owns the queue and the choice of what is dropped. Knows no sockets.

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;
use tokio::sync::Notify;

/// The queue of one client.
#[derive(Debug)]
pub struct Outbox {
    queue: RefCell<VecDeque<Rc<[u8]>>>,
    bytes: Cell<usize>,
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
            limit,
            dropped: Cell::new(0),
            closes: Cell::new(false),
            filled: Notify::new(),
            drained: Notify::new(),
        }
    }

    /// Adds a frame that is encoded already; drops it if there is no room.
    pub fn push(&self, frame: Rc<[u8]>) {
        if self.bytes.get() + frame.len() > self.limit {
            self.dropped.set(self.dropped.get().saturating_add(1));
            return;
        }
        self.bytes.set(self.bytes.get() + frame.len());
        self.queue.borrow_mut().push_back(frame);
        self.filled.notify_one();
    }

    /// Adds the frame of a payload.
    pub fn send(&self, payload: &[u8]) {
        self.push(crate::protocol::frame::encode(payload).into());
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
            if let Some(frame) = self.queue.borrow_mut().pop_front() {
                self.bytes.set(self.bytes.get() - frame.len());
                self.drained.notify_one();
                return Some(frame);
            }
            if self.closes.get() {
                return None;
            }
            self.filled.notified().await;
        }
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
        (dropped > 0 && self.queue.borrow().is_empty()).then(|| self.dropped.replace(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
