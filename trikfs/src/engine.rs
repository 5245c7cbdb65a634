//! What all nodes and open files share: the kernel's side, events, the log, the requests that wait.
//!
//! Owns these services for one mount; there are no globals. Knows no node.

use crate::device::i2c::bus::Buses;
use crate::errno::Error;

use crate::events::{Poller, Schedule, lock};
use crate::limits;
use crate::log::Log;
use crate::panics::Panics;
use crate::programs::Programs;
use crate::sample_bus::{Readers, SampleBus};
use crate::transport::{Answer, Kernel, PollHandle, RequestId};
use std::collections::{HashMap, HashSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

/// The services of one mount.
pub struct Engine {
    /// Descriptors that wake somebody.
    pub poller: Arc<Poller>,
    /// Times at which somebody acts.
    pub schedule: Arc<Schedule>,
    /// The `log` file.
    pub log: Arc<Log>,
    /// Programs that sensors need.
    pub programs: Arc<Programs>,
    /// The I2C buses.
    pub buses: Arc<Buses>,
    /// Samples in shared memory, once the mount has a place for them.
    pub samples: SampleBus,
    /// Times of sampling on one bus each, by the path of the bus.
    bus_schedules: Mutex<HashMap<PathBuf, Arc<Schedule>>>,
    kernel: OnceLock<Arc<dyn Kernel>>,
    /// Of all threads of the process.
    pub panics: Arc<Panics>,
    /// Called before and after an actuator is driven.
    on_driven: OnceLock<Box<dyn Fn() + Send + Sync>>,
    /// Called after a param was changed.
    on_params: OnceLock<Box<dyn Fn() + Send + Sync>>,
    parked: Mutex<HashSet<RequestId>>,
}

impl Engine {
    /// Starts the event threads.
    pub fn start() -> io::Result<Arc<Self>> {
        let log = Arc::new(Log::new());
        Ok(Arc::new(Self {
            poller: Poller::start()?,
            schedule: Schedule::start()?,
            programs: Programs::new(log.clone()),
            log,
            buses: Arc::default(),
            samples: Default::default(),
            bus_schedules: Mutex::default(),
            kernel: OnceLock::new(),
            panics: Arc::default(),
            on_driven: OnceLock::new(),
            on_params: OnceLock::new(),
            parked: Mutex::default(),
        }))
    }

    /// Where background samples from a bus are scheduled: with a thread of its own for each bus, so that a slow one
    /// delays nobody else's samples. When there are too many buses or no thread can be made, where all others are.
    pub fn schedule_of(&self, bus: &Path) -> Arc<Schedule> {
        let mut schedules = lock(&self.bus_schedules);
        if let Some(schedule) = schedules.get(bus) {
            return schedule.clone();
        }
        if schedules.len() < limits::BUS_THREADS_MAX
            && let Ok(schedule) = Schedule::start_crew("bus", 1)
        {
            schedules.insert(bus.to_owned(), schedule.clone());
            return schedule;
        }
        self.schedule.clone()
    }

    /// What is called when an actuator is driven; the first one counts.
    pub fn on_driven(&self, call: Box<dyn Fn() + Send + Sync>) {
        let _ = self.on_driven.set(call);
    }

    /// An actuator is driven.
    pub fn driven(&self) {
        if let Some(call) = self.on_driven.get() {
            call();
        }
    }

    /// What is called when a param was changed; the first one counts.
    pub fn on_params(&self, call: Box<dyn Fn() + Send + Sync>) {
        let _ = self.on_params.set(call);
    }

    /// A param was changed, with no lock held.
    pub fn params_changed(&self) {
        if let Some(call) = self.on_params.get() {
            call();
        }
    }

    /// Takes a place in shared memory for the samples, if there are to be any; a failure is told and disturbs nobody.
    pub fn open_sample_bus(&self, mountpoint: &Path, readers: Option<Readers>) {
        if let Some(readers) = readers
            && let Err(error) = self.samples.open(mountpoint, readers)
        {
            self.log.line(&error.to_string());
        }
    }

    /// The mount is live; later calls are ignored.
    pub fn connect(&self, kernel: Arc<dyn Kernel>) {
        let _ = self.kernel.set(kernel);
    }

    /// The kernel's side, once there is one.
    pub fn kernel(&self) -> Option<&Arc<dyn Kernel>> {
        self.kernel.get()
    }

    /// Notes that a request waits for an answer.
    pub fn park(&self, id: RequestId) {
        lock(&self.parked).insert(id);
    }

    /// Whether a request still waits.
    pub fn is_parked(&self, id: RequestId) -> bool {
        lock(&self.parked).contains(&id)
    }

    /// Takes the right and duty to answer a waiting request; only one caller gets it.
    pub fn claim(&self, id: RequestId) -> bool {
        lock(&self.parked).remove(&id)
    }

    /// Answers a claimed request.
    pub fn answer(&self, id: RequestId, result: Result<Answer<'_>, Error>) {
        if let Some(kernel) = self.kernel() {
            kernel.answer(id, result);
        }
    }

    /// Answers a waiting request with an error, if it still waits.
    pub fn refuse(&self, id: RequestId, error: Error) -> bool {
        let claimed = self.claim(id);
        if claimed {
            self.answer(id, Err(error));
        }
        claimed
    }

    /// Answers all requests that wait, before the end.
    pub fn refuse_all(&self, error: &Error) {
        let all: Vec<_> = lock(&self.parked).drain().collect();
        for id in all {
            self.answer(id, Err(error.clone()));
        }
    }

    /// Wakes the programs that poll an open file.
    pub fn notify(&self, handle: Option<PollHandle>) {
        if let (Some(kernel), Some(handle)) = (self.kernel(), handle) {
            kernel.notify_poll(handle);
        }
    }

    /// Ends the event threads and the programs that are up.
    pub fn stop(&self) {
        self.programs
            .stop_all(Duration::from_millis(limits::PROGRAM_END_MS));
        self.programs.groups.kill_all();
        self.poller.stop();
        self.schedule.stop();
        for schedule in lock(&self.bus_schedules).values() {
            schedule.stop();
        }
    }
}
