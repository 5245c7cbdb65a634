//! The page of one robot, and what its server is told.
//!
//! Owns what all requests to it share; `serving` has the thread.

use crate::admission::Admission;
use crate::control::Control;
use crate::error::Error;
use crate::gate::Gate;
use crate::limits;
use crate::route;
use crate::serving::Serving;
use crate::shared::{Settings, Shared};
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::sync::{Semaphore, watch};

/// A page that is served. Dropping it ends that.
#[derive(Debug)]
pub struct Page {
    serving: Serving,
    robot: watch::Sender<Option<SocketAddr>>,
}

impl Page {
    /// Serves it from now on.
    ///
    /// # Errors
    /// Nobody can listen there, or there are no more threads.
    pub fn start(settings: Settings) -> Result<Self, Error> {
        let robot = watch::Sender::new(None);
        let (wanted, guests) = (settings.address, settings.guests.clone());
        let told = robot.clone();
        let serving = Serving::start(wanted, guests.clone(), limits::FILE_THREADS, |port| {
            let gate = Gate::new(guests, port, route::PAGES, route::DATA)?;
            Ok(route::router(Arc::new(Shared {
                settings,
                gate: Arc::new(gate),
                robot: told,
                control: Control::default(),
                admission: Admission::default(),
                uploads: Arc::new(Semaphore::new(limits::UPLOADS_BYTES_MAX)),
                large: Arc::new(Semaphore::new(limits::LARGE_MAX)),
                looks: Arc::new(Semaphore::new(limits::LOOKS_MAX)),
            })))
        })?;
        Ok(Self { serving, robot })
    }

    /// Where it is served.
    pub fn address(&self) -> SocketAddr {
        self.serving.address()
    }

    /// Where the robot takes programs from now on.
    pub fn robot_is_at(&self, address: SocketAddr) {
        self.robot
            .send_if_modified(|at| at.replace(address) != Some(address));
    }
}

#[cfg(test)]
mod tests;
