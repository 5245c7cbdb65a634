//! What the threads of one board share: the machine, and the word that the end has come.

use crate::machine::Machine;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Shared by the threads of one board.
pub struct Shared {
    machine: Mutex<Machine>,
    stopping: AtomicBool,
}

impl Shared {
    /// Around a new machine.
    pub fn new(machine: Machine) -> Self {
        Self {
            machine: Mutex::new(machine),
            stopping: AtomicBool::new(false),
        }
    }

    /// The machine, for a short time: nothing that waits is done while it is held.
    pub fn machine(&self) -> MutexGuard<'_, Machine> {
        self.machine.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the threads shall end.
    pub fn is_stopping(&self) -> bool {
        self.stopping.load(Ordering::Acquire)
    }

    /// Tells the threads to end; they have to be woken as well.
    pub fn stop(&self) {
        self.stopping.store(true, Ordering::Release);
    }
}
