//! How a node's actuator comes to rest: by this process, and by the guardian when this one is dead.
//!
//! Owns the rest as a tuple and as an action of the guardian, and what a lease knows of actuators. When they come to rest
//! is the business of others.

use super::Node;
use super::driving::Taken;
use crate::device::kinds;
use crate::errno::Error;
use crate::events::lock;
use crate::guardian::actions::RestAction;
use crate::lease::Actuators;
use crate::limits;
use config::source::rest::Resting;
use converter::Direction;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

impl Node {
    /// The tuple that brings the actuator to rest, as a program would write it.
    pub fn rest_tuple(&self) -> Result<Option<Vec<u8>>, Error> {
        let Some(rest) = &self.description.rest else {
            return Ok(None);
        };
        let text: Vec<String> = rest.iter().map(ToString::to_string).collect();
        let mut tuple = vec![0; self.description.written_tuple_size()];
        crate::text::encode(&self.written_format(), &text.join(" "), &mut tuple)?;
        Ok(Some(tuple))
    }

    /// A program is about to drive the actuator, or has just done it: somebody looks after it from here on.
    pub fn note_driven(&self) {
        if self.description.rest.is_some() {
            self.driving.set_driven(true);
            self.engine.driven();
        }
    }

    /// Brings the actuator to rest now. One that this board does not have rests already; a bus that has too many to
    /// serve at the moment is asked again until the node's time limit.
    pub fn rest(self: &Arc<Self>) -> Result<(), Error> {
        // First, so that a write that comes between is noted.
        self.driving.set_driven(false);
        let rested = self.write_rest();
        if rested.is_err() {
            self.driving.set_driven(true);
        }
        rested
    }

    fn write_rest(self: &Arc<Self>) -> Result<(), Error> {
        if let Some(rested) = self.driving.rest_what_is_held() {
            return rested;
        }
        let Some(tuple) = self.rest_tuple()? else {
            return Ok(());
        };
        if self.description.source.resting() == Resting::Absent {
            return Ok(());
        }
        let deadline = Instant::now() + Duration::from_millis(self.description.timeout_ms.into());
        loop {
            let outcome = match self.known_rest() {
                // Nobody waits for a converter in another process, which may be dead or stopped.
                Some(action) => self.perform(&action, &tuple),
                None => self.open_writer(None).and_then(|mut writer| {
                    let _turn = self.take_turn();
                    writer.write_whole(&tuple, true)
                }),
            };
            match outcome {
                Err(error) if error.is_busy_device() && Instant::now() < deadline => {
                    std::thread::sleep(limits::REST_PAUSE);
                }
                outcome => {
                    self.driving.written.forget_sent();
                    return outcome;
                }
            }
        }
    }

    fn perform(&self, action: &RestAction, tuple: &[u8]) -> Result<(), Error> {
        if self.is_retired() {
            return Err(Error::Stale);
        }
        let sink = kinds::open_sink(&action.sink, &self.source.around);
        let mut sink = sink.inspect_err(|error| self.report(error))?;
        let mut write = || {
            sink.write(&action.tuple, true)?;
            self.went(tuple);
            Ok(())
        };
        let _turn = match self.take_turn_at_once() {
            Ok(turn) => turn,
            Err(Taken) => {
                // The one that has it may hang in a converter. The actuator rests at once, and again if that one writes after all.
                let writes = self.writes();
                write()?;
                let turn = self.take_turn();
                // Ours alone.
                if self.writes() == writes.wrapping_add(1) {
                    return Ok(());
                }
                turn
            }
        };
        write()
    }

    /// The rest as the device gets it, of the params of now.
    fn known_rest(&self) -> Option<RestAction> {
        self.driving.known_rest(self.params_on_the_way())
    }

    /// Another number after each change of a param of this node or one that a write passes on its way to the device.
    pub fn params_on_the_way(&self) -> u32 {
        let own = self.recipe.generation();
        let further = self.written_node().map(|other| other.params_on_the_way());
        own.wrapping_add(further.unwrap_or(0))
    }

    /// The node that takes what comes out of the converters of this one.
    fn written_node(&self) -> Option<&Arc<Self>> {
        match self.description.source.innermost().resting() {
            Resting::Node(path) => {
                let other = self.links.iter().find(|(name, _)| name == path);
                other.map(|(_, other)| other)
            }
            Resting::Device
            | Resting::ReadOnly
            | Resting::Absent
            | Resting::NoDevice
            | Resting::Within => None,
        }
    }

    /// Changes a param, with what follows from it for the rest of this node. `Engine::params_changed` is for that of all others
    /// that write through it.
    ///
    /// # Errors
    /// The reason of a library that refuses the number, or of an isolated converter that makes no rest of it; then
    /// everything is as it was.
    pub fn set_param(self: &Arc<Self>, name: &str, value: f64) -> Result<(), Error> {
        let _turn = lock(&self.driving.params_turn);
        let (former, params) = (self.recipe.param(name), self.params_on_the_way());
        let known = self.driving.known_rest(params);
        self.recipe.set_param(name, value)?;
        // What the number makes of the rest is known before anybody drives with it.
        let renewed = self.renew_rest();
        if let (Err(_), Some(former)) = (&renewed, former) {
            self.recipe.restore_param(name, former);
            if let Some(action) = known {
                // Two changes further it is the same.
                self.driving.keep_rest(&action, params.wrapping_add(2));
            }
        }
        renewed
    }

    /// A param has changed, and the rest may be other bytes from here on.
    fn renew_rest(self: &Arc<Self>) -> Result<(), Error> {
        match self.description.rest.is_some() && self.is_apart() {
            true => self.convert_rest().map(drop),
            false => Ok(()),
        }
    }

    /// What the guardian has to do if this process is no longer there; nothing if there is no device to rest. What is known is
    /// not converted again: a process that is dead or stopped must not take it away.
    pub fn rest_action(self: &Arc<Self>) -> Result<Option<RestAction>, Error> {
        match self.known_rest() {
            Some(action) => Ok(Some(action)),
            None => self.convert_rest(),
        }
    }

    fn convert_rest(self: &Arc<Self>) -> Result<Option<RestAction>, Error> {
        if self.driving.takes_orders() {
            // What it drives has a rest of its own.
            return Ok(None);
        }
        let Some(tuple) = self.rest_tuple()? else {
            return Ok(None);
        };
        // Before: a change meanwhile makes it one of former params.
        let params = self.params_on_the_way();
        let Some(converted) = self.converted(&tuple)? else {
            return Ok(None);
        };
        let action = self.action_of(converted)?;
        if let Some(action) = action.as_ref().filter(|_| self.is_apart()) {
            self.driving.keep_rest(action, params);
        }
        Ok(action)
    }

    /// Whether what is written here passes a converter in another process.
    fn is_apart(&self) -> bool {
        self.description.isolate || self.written_node().is_some_and(|other| other.is_apart())
    }

    /// What the device of this node, or the node that it writes to, gets for a tuple; None: nothing.
    fn converted(&self, tuple: &[u8]) -> Result<Option<Vec<u8>>, Error> {
        let mut converted = vec![0; self.device_tuple_size()];
        let pipeline = self.open_pipeline()?;
        let batch = self.convert(
            &mut lock(&pipeline),
            Direction::Write,
            tuple,
            &mut converted,
        );
        if let Some(error) = batch.fault {
            return Err(error);
        }
        Ok((batch.produced > 0).then_some(converted))
    }

    /// The action that has the effect of what was converted, through all nodes on the way to a device.
    fn action_of(&self, converted: Vec<u8>) -> Result<Option<RestAction>, Error> {
        let sink = self.description.source.innermost();
        match sink.resting() {
            Resting::Node(_) => {
                let Some(other) = self.written_node() else {
                    return Ok(None);
                };
                let further = other.converted(&converted)?;
                further.map_or(Ok(None), |converted| other.action_of(converted))
            }
            Resting::Device => Ok(Some(RestAction {
                sink: sink.clone(),
                tuple: converted,
                timeout_ms: self.description.timeout_ms,
            })),
            Resting::ReadOnly | Resting::Absent | Resting::NoDevice | Resting::Within => Ok(None),
        }
    }
}

/// The actuators of a lease: those of them that are still there.
pub struct LeasedActuators(pub Vec<Weak<Node>>);

impl LeasedActuators {
    fn nodes(&self) -> Vec<Arc<Node>> {
        self.0.iter().filter_map(Weak::upgrade).collect()
    }
}

impl Actuators for LeasedActuators {
    fn write_mode(&self) -> u16 {
        let modes = self.nodes().into_iter();
        modes.fold(0, |mode, node| mode | (node.description.mode & 0o222))
    }

    fn rest(&self) {
        // Each node has noted its failure: its `fault` and the log tell.
        let _ = rest_all(&self.nodes());
    }
}

/// Brings every actuator to rest, slow ones beside each other: one that hangs keeps one thread. All are tried; the
/// first failure is returned.
pub fn rest_all(nodes: &[Arc<Node>]) -> Result<(), Error> {
    let has_rest = |node: &&Arc<Node>| node.description.rest.is_some();
    let actuators: Vec<_> = nodes.iter().filter(has_rest).collect();
    let threads = actuators.len().min(limits::REST_THREADS_MAX);
    let next = AtomicUsize::new(0);
    let failures = Mutex::new(Vec::new());
    // First nobody may drive them any more.
    for node in nodes {
        node.driving.release();
    }
    let work = || {
        while let Some(node) = actuators.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Err(error) = node.rest() {
                node.report(&error);
                lock(&failures).push(error);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            // Without further threads it takes longer.
            let _ = std::thread::Builder::new().spawn_scoped(scope, work);
        }
        work();
    });
    let first = lock(&failures).first().cloned();
    first.map_or(Ok(()), Err)
}
