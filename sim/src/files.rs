//! The thread that looks after all files of a board: attributes, FIFOs and faults.
//!
//! Owns when things are done; each kind of file is a [`Part`] that does what is due and never waits.

use crate::attributes::Attributes;
use crate::bus::Bus;
use crate::control::Control;
use crate::display::Display;
use crate::faults::{self, Refusal};
use crate::input::{Keys, Ultrasonic};
use crate::lidar::Lidar;
use crate::limits::TICK_MS;
use crate::mems::Mems;
use crate::pose::PoseFile;
use crate::sensors::Camera;
use crate::shared::Shared;
use crate::sysfs;
use nix::poll::{PollFd, PollFlags, ppoll};
use nix::sys::eventfd::{EfdFlags, EventFd};
use nix::sys::time::TimeSpec;
use std::fs::Permissions;
use std::io;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

const FAULTS: &str = "faults";

/// A kind of device behind files.
pub trait Part: Send {
    /// Does what is due; the simulated time at which there is something to do again.
    fn run(&mut self, shared: &Shared) -> f64;

    /// An attribute of this part was written.
    fn changed(&mut self, _name: &str, _attributes: &Attributes) {}

    /// What to wait for.
    fn inputs(&self) -> Vec<BorrowedFd<'_>> {
        Vec::new()
    }
}

/// The thread.
pub struct Files {
    shared: Arc<Shared>,
    wake: Arc<EventFd>,
    thread: Option<JoinHandle<()>>,
}

impl Files {
    /// Makes all files below `root`; `buses` are told when faults change.
    pub fn start(root: &Path, shared: Arc<Shared>, buses: Vec<Bus>, seed: u64) -> io::Result<Self> {
        let flags = EfdFlags::EFD_CLOEXEC | EfdFlags::EFD_NONBLOCK;
        let wake = Arc::new(EventFd::from_flags(flags)?);
        let mut attributes = Attributes::new(root)?;
        sysfs::make(&mut attributes)?;
        attributes.folder(FAULTS)?;
        let parts = parts(&mut attributes, seed)?;
        let mut work = Work {
            shared: Arc::clone(&shared),
            wake: Arc::clone(&wake),
            attributes,
            buses,
            parts,
        };
        let thread = std::thread::Builder::new()
            .name("sim-files".to_owned())
            .spawn(move || work.run())?;
        Ok(Self {
            shared,
            wake,
            thread: Some(thread),
        })
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        self.shared.stop();
        let _ = self.wake.write(1);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Every kind of device that is not on a bus.
fn parts(attributes: &mut Attributes, seed: u64) -> io::Result<Vec<Box<dyn Part>>> {
    let mut parts: Vec<Box<dyn Part>> = Vec::new();
    for chip in Mems::make(attributes, seed)? {
        parts.push(Box::new(chip));
    }
    for sensor in Ultrasonic::make(attributes)? {
        parts.push(Box::new(sensor));
    }
    parts.push(Box::new(Keys::make(attributes)?));
    parts.push(Box::new(Lidar::make(attributes)?));
    parts.push(Box::new(Camera::make(attributes)?));
    parts.push(Box::new(Control::make(attributes)?));
    parts.push(Box::new(PoseFile::make(attributes)?));
    parts.push(Box::new(Display::make(attributes)?));
    Ok(parts)
}

/// Makes a shell script below the root, which it finds again wherever that is mounted.
pub fn script(root: &Path, name: &str, body: &str) -> io::Result<()> {
    let path = root.join(name);
    let up = "/..".repeat(name.matches('/').count());
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let head = "#!/bin/sh\n# Made by the virtual board.\n";
    let find = format!("root=$(cd \"$(dirname \"$0\"){up}\" && pwd) || exit 1\n");
    std::fs::write(&path, format!("{head}{find}{body}"))?;
    std::fs::set_permissions(&path, Permissions::from_mode(0o755))
}

struct Work {
    shared: Arc<Shared>,
    wake: Arc<EventFd>,
    attributes: Attributes,
    buses: Vec<Bus>,
    parts: Vec<Box<dyn Part>>,
}

impl Work {
    fn run(&mut self) {
        while !self.shared.is_stopping() {
            for name in self.attributes.changed() {
                self.changed(&name);
            }
            self.shared.machine().advance();
            let mut due_s = f64::INFINITY;
            for part in &mut self.parts {
                due_s = due_s.min(part.run(&self.shared));
            }
            self.wait(due_s);
        }
    }

    fn changed(&mut self, name: &str) {
        if name == FAULTS {
            // The folder is a new one.
            for (device, _) in faults::devices() {
                self.fault(device);
            }
            return;
        }
        if let Some(device) = name.strip_prefix("faults/") {
            self.fault(device);
            return;
        }
        let is_ours = sysfs::changed(&mut self.attributes, name, &mut self.shared.machine());
        if !is_ours {
            for part in &mut self.parts {
                part.changed(name, &self.attributes);
            }
        }
    }

    /// Takes the faults of a device over; what is wrong with the text stands in a file beside it.
    fn fault(&mut self, device: &str) {
        if device.ends_with(".error") {
            return;
        }
        let complaint = format!("{FAULTS}/{device}.error");
        let path = format!("{FAULTS}/{device}");
        let is_there = self.attributes.root().join(&path).exists();
        let text = self.attributes.text(&path);
        let result = match text {
            Some(text) => self.shared.machine().faults.set(device, &text),
            None if is_there => Err(Refusal::NoText),
            // A file of another name has gone: nothing is wrong any more.
            None => self.shared.machine().faults.set(device, "").or(Ok(())),
        };
        match result {
            Ok(()) => self.attributes.remove(&complaint),
            Err(reason) => {
                let _ = self.attributes.appear(&complaint, &reason.to_string());
            }
        }
        for bus in &self.buses {
            bus.wake();
        }
    }

    /// Sleeps until something is written or due.
    fn wait(&self, due_s: f64) {
        let until = self.shared.machine().wall_time_until(due_s);
        let most = Duration::from_millis(u64::from(TICK_MS));
        let mut fds = vec![self.wake.as_fd(), self.attributes.fd()];
        for part in &self.parts {
            fds.extend(part.inputs());
        }
        let mut fds: Vec<PollFd> = fds
            .into_iter()
            .map(|fd| PollFd::new(fd, PollFlags::POLLIN))
            .collect();
        let _ = ppoll(
            &mut fds,
            Some(TimeSpec::from_duration(until.min(most))),
            None,
        );
        let _ = self.wake.read();
    }
}
