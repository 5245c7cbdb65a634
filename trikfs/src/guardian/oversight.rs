//! The daemon's eye on its guardian: one that is stopped could bring nothing to rest if the daemon died.
//!
//! Owns when it looks (only while an actuator may be driven, so that an idle robot wakes for nobody) and what it does then.
//! The kernel tells nobody that a parent was stopped, so this is one of the few things that are asked by the clock.

use crate::engine::Engine;
use crate::events::Due;
use crate::limits::GUARDIAN_LOOK_MS;
use crate::node::{Node, rest_all};
use crate::process::is_stopped;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Weak};
use std::time::{Duration, Instant};

/// Gives the nodes in force.
type Nodes = Box<dyn Fn() -> Vec<Arc<Node>> + Send + Sync>;

/// Looks whether the guardian goes on, for as long as an actuator is driven.
pub struct Oversight {
    guardian: u32,
    engine: Weak<Engine>,
    nodes: Nodes,
    is_looking: AtomicBool,
    me: Weak<Self>,
}

impl Oversight {
    /// Looks at this process from the first [`driven`](Self::driven) on.
    pub fn new(guardian: u32, engine: &Arc<Engine>, nodes: Nodes) -> Arc<Self> {
        Arc::new_cyclic(|me| Self {
            guardian,
            engine: Arc::downgrade(engine),
            nodes,
            is_looking: AtomicBool::new(false),
            me: me.clone(),
        })
    }

    /// An actuator is about to be driven.
    pub fn driven(&self) {
        if !self.is_looking.load(Ordering::Relaxed)
            && !self.is_looking.swap(true, Ordering::SeqCst)
            && let Some(engine) = self.engine.upgrade()
        {
            engine.schedule.at(next_look(), self.me.clone());
        }
    }

    /// Does what the guardian could not do, and has it go on.
    fn stand_in(&self, engine: &Engine) {
        // Each node has noted its failure.
        let _ = rest_all(&(self.nodes)());
        engine.log.line(&format!(
            "the guardian (process {}) was stopped: actuators were brought to rest, and it was told to go on",
            self.guardian
        ));
        if let Ok(guardian) = i32::try_from(self.guardian) {
            // It may have ended; then the kernel has told this process.
            let _ = kill(Pid::from_raw(guardian), Signal::SIGCONT);
        }
    }
}

fn next_look() -> Instant {
    Instant::now() + Duration::from_millis(GUARDIAN_LOOK_MS)
}

impl Due for Oversight {
    fn due(&self) -> Option<Instant> {
        let engine = self.engine.upgrade()?;
        if is_stopped(self.guardian) {
            self.stand_in(&engine);
        }
        // First this, so that a write from here on asks for a look of its own.
        self.is_looking.store(false, Ordering::SeqCst);
        let is_driven = (self.nodes)().iter().any(|node| node.driving.is_driven());
        (is_driven && !self.is_looking.swap(true, Ordering::SeqCst)).then(next_look)
    }
}
