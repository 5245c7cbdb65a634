//! How a node's actuator comes to rest: by this process, and by the guardian when this one is dead.
//!
//! Owns the rest as a tuple and as an action of the guardian. When that happens is the business of others.

use super::Node;
use crate::errno::Error;
use crate::events::lock;
use crate::guardian::actions::RestAction;
use config::source::rest::Resting;
use converter::Direction;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Between two attempts to bring an actuator to rest whose device is busy.
const PAUSE: Duration = Duration::from_millis(1);

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

    /// Brings the actuator to rest now. One that this board does not have rests already; a bus that has too many to
    /// serve at the moment is asked again until the node's time limit.
    pub fn rest(self: &Arc<Self>) -> Result<(), Error> {
        if let Some(regulation) = self.regulation() {
            return regulation.rest();
        }
        let Some(tuple) = self.rest_tuple()? else {
            return Ok(());
        };
        if self.description.source.resting() == Resting::Absent {
            return Ok(());
        }
        let deadline = Instant::now() + Duration::from_millis(self.description.timeout_ms.into());
        loop {
            let outcome = self.open_writer(None).and_then(|mut writer| {
                let _turn = self.take_turn();
                writer.write_whole(&tuple, true)
            });
            match outcome {
                Err(Error::Device(libc::EBUSY, _)) if Instant::now() < deadline => {
                    std::thread::sleep(PAUSE);
                }
                outcome => {
                    self.forget_sent();
                    return outcome;
                }
            }
        }
    }

    /// A regulator that drove this node had to give up: `fault` says why until somebody drives the node again.
    pub fn lose(&self, error: &Error) {
        *lock(&self.lost) = Some(error.clone());
    }

    /// Why the regulator of this node, or the one that drives it, gave up.
    pub fn lost(&self) -> Option<Error> {
        match self.regulation() {
            Some(regulation) => regulation.lost(),
            None => lock(&self.lost).clone(),
        }
    }

    /// What the guardian has to do if this process is no longer there; nothing if there is no device to rest.
    pub fn rest_action(self: &Arc<Self>) -> Result<Option<RestAction>, Error> {
        if self.regulation().is_some() {
            // What it drives has a rest of its own.
            return Ok(None);
        }
        match self.rest_tuple()? {
            Some(tuple) => self.action_of(&tuple),
            None => Ok(None),
        }
    }

    /// The action that has the effect of writing this tuple, through all nodes on the way to a device.
    fn action_of(self: &Arc<Self>, tuple: &[u8]) -> Result<Option<RestAction>, Error> {
        let mut converted = vec![0; self.device_tuple_size()];
        let pipeline = self.open_pipeline()?;
        let (_, produced, fault) = self.convert(
            &mut lock(&pipeline),
            Direction::Write,
            tuple,
            &mut converted,
        );
        if let Some(error) = fault {
            return Err(error);
        }
        if produced == 0 {
            return Ok(None);
        }
        let sink = self.description.source.innermost();
        match sink.resting() {
            Resting::Node(path) => {
                let other = self.links.iter().find(|(name, _)| name == path);
                other.map_or(Ok(None), |(_, other)| other.action_of(&converted))
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
