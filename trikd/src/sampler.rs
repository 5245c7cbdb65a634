//! What the robot senses, read from the tree by a thread of its own, so that a device that hangs stops no client.
//!
//! Owns that thread and the newest snapshot; all clients that ask within [`limits::SNAPSHOT_MS`] share one. Nothing is
//! read while nobody asks. Knows no requests.

use crate::brick::sensors::{Gamepad, KEYS, Keys, NO_ECHO, NOT_PRESSED, Sensor, Vector};
use crate::brick::{Brick, Group};
use crate::limits;
use crate::panics;
use crate::protocol::telemetry::{self, Port, Snapshot};
use crate::tree::{Access, Node};
use frame::encode;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// A snapshot and when it was taken; None before the first. One without a time has the names of ports alone: the first
/// reading takes as long as the slowest device.
type Newest = Option<(Option<Instant>, Arc<Snapshot>)>;

/// A snapshot and the frame that was made of it.
type Answer = (Arc<Snapshot>, Rc<[u8]>);

/// The way to the thread.
#[derive(Debug)]
pub struct Sampler {
    ask: SyncSender<()>,
    newest: watch::Receiver<Newest>,
    /// The answer to `data` that was made last, and of which snapshot.
    answer: RefCell<Option<Answer>>,
}

impl Sampler {
    /// Starts the thread for the tree at `root`; it ends with this.
    ///
    /// # Errors
    /// There can be no more threads.
    pub fn start(root: &Path) -> std::io::Result<Self> {
        let (ask, asked) = sync_channel(1);
        let (publish, newest) = watch::channel(None);
        let root: PathBuf = root.to_owned();
        std::thread::Builder::new()
            .name("sampler".to_owned())
            .spawn(move || panics::restart_on_panic(|| sample(&root, &asked, &publish)))?;
        Ok(Self {
            ask,
            newest,
            answer: RefCell::default(),
        })
    }

    /// What the robot senses now, or did at most [`limits::SNAPSHOT_MS`] ago. If the tree does not answer in time, a
    /// snapshot without values.
    pub async fn snapshot(&self) -> Arc<Snapshot> {
        let fresh = Duration::from_millis(limits::SNAPSHOT_MS);
        let mut newest = self.newest.clone();
        let known = newest.borrow_and_update().clone();
        if let Some((Some(at), snapshot)) = &known
            && at.elapsed() < fresh
        {
            return snapshot.clone();
        }
        // Full: it is asked already.
        let _ = self.ask.try_send(());
        let until = tokio::time::Instant::now() + Duration::from_millis(limits::SNAPSHOT_WAIT_MS);
        while let Ok(Ok(())) = tokio::time::timeout_at(until, newest.changed()).await {
            if let Some((Some(_), snapshot)) = &*newest.borrow_and_update() {
                return snapshot.clone();
            }
        }
        let known = newest.borrow().clone();
        Arc::new(known.map_or_else(Snapshot::default, |(_, snapshot)| without_values(&snapshot)))
    }
}

impl Sampler {
    /// The frame that answers `data`: made once for all who share a snapshot.
    pub async fn all_data(&self) -> Rc<[u8]> {
        let snapshot = self.snapshot().await;
        let mut answer = self.answer.borrow_mut();
        match &*answer {
            Some((of, frame)) if Arc::ptr_eq(of, &snapshot) => frame.clone(),
            _ => {
                let frame: Rc<[u8]> = encode(snapshot.all_data().as_bytes()).into();
                *answer = Some((snapshot, frame.clone()));
                frame
            }
        }
    }
}

fn without_values(snapshot: &Snapshot) -> Snapshot {
    let bare = |ports: &[Port]| {
        let bare = |port: &Port| Port {
            name: port.name.clone(),
            ..Port::default()
        };
        ports.iter().map(bare).collect()
    };
    Snapshot {
        analog: bare(&snapshot.analog),
        digital: bare(&snapshot.digital),
        encoders: bare(&snapshot.encoders),
        ..Snapshot::default()
    }
}

/// Gives clients the names of all ports if they have nothing yet.
fn name_ports(files: &Files, publish: &watch::Sender<Newest>) {
    if publish.borrow().is_none() && !files.ports.is_empty() {
        // Only a daemon that is ending does not take it, and the next snapshot finds that out.
        let _ = publish.send(Some((None, Arc::new(files.names()))));
    }
}

/// Waits for the next question. Without one for `linger`, `close` lets go of the files meanwhile: the tree samples
/// what is open. False: nobody can ask any more.
fn is_asked(asked: &Receiver<()>, linger: Duration, close: impl FnOnce()) -> bool {
    match asked.recv_timeout(linger) {
        Ok(()) => true,
        Err(RecvTimeoutError::Disconnected) => false,
        Err(RecvTimeoutError::Timeout) => {
            close();
            asked.recv().is_ok()
        }
    }
}

fn sample(root: &Path, asked: &Receiver<()>, publish: &watch::Sender<Newest>) {
    let brick = Brick::new(root);
    let mut files = Files::find(&brick);
    let mut raw_at: Option<Instant> = None;
    let linger = Duration::from_millis(limits::SENSORS_LINGER_MS);
    while is_asked(asked, linger, || brick.tree().close()) {
        if files.ports.is_empty() {
            files = Files::find(&brick);
        }
        name_ports(&files, publish);
        let period = Duration::from_millis(limits::RAW_MS);
        let with_raw = raw_at.is_none_or(|at| at.elapsed() >= period);
        if with_raw {
            raw_at = Some(Instant::now());
        }
        let snapshot = Arc::new(files.read(with_raw));
        if publish
            .send(Some((Some(Instant::now()), snapshot)))
            .is_err()
        {
            return;
        }
    }
}

/// One port with its files.
struct Files {
    ports: Vec<PortFiles>,
    accelerometer: Vector,
    gyroscope: Vector,
    gamepad: Gamepad,
    keys: Keys,
}

struct PortFiles {
    name: String,
    sensor: Sensor,
    /// Distances have both numbers in one file.
    raw: Rc<Node>,
    last_raw: Option<i32>,
}

/// The names of connectors; second names of a robot file are not shown twice.
fn is_connector(name: &str) -> bool {
    let mut letters = name.chars();
    letters
        .next()
        .is_some_and(|first| first.is_ascii_uppercase())
        && letters.clone().next().is_some()
        && letters.all(|digit| digit.is_ascii_digit())
}

/// None for what does not fit.
fn whole(number: f64) -> Option<i32> {
    let rounded = number.round();
    let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&rounded);
    // It fits, so nothing is cut off.
    #[allow(clippy::cast_possible_truncation)]
    fits.then_some(rounded as i32)
}

fn all_whole(numbers: &[f64]) -> telemetry::Reading {
    numbers.iter().copied().map(whole).collect()
}

/// The list of a snapshot to which a port belongs.
fn list_of<'a>(snapshot: &'a mut Snapshot, port: &str) -> &'a mut Vec<Port> {
    match port.as_bytes().first() {
        Some(b'D' | b'F') => &mut snapshot.digital,
        Some(b'A') => &mut snapshot.analog,
        _ => &mut snapshot.encoders,
    }
}

impl Files {
    fn find(brick: &Brick) -> Self {
        let tree = brick.tree();
        let mut ports = Vec::new();
        for group in [Group::Sensors, Group::Encoders] {
            for name in brick
                .ports(group)
                .into_iter()
                .filter(|name| is_connector(name))
            {
                let directory = format!("{}/{name}", group.directory());
                if !tree.has(&directory) {
                    continue;
                }
                ports.push(PortFiles {
                    sensor: Sensor::with(tree, &directory, Access::ReadNow),
                    raw: tree.node(&format!("{directory}/raw"), Access::ReadNow),
                    last_raw: None,
                    name,
                });
            }
        }
        Self {
            ports,
            accelerometer: Vector::with(tree, "accelerometer", Access::ReadNow),
            gyroscope: Vector::with(tree, "gyroscope", Access::ReadNow),
            gamepad: brick.gamepad(),
            keys: brick.keys(),
        }
    }

    /// All ports without values.
    fn names(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        for port in &self.ports {
            list_of(&mut snapshot, &port.name).push(Port {
                name: port.name.clone(),
                ..Port::default()
            });
        }
        snapshot
    }

    fn read(&mut self, with_raw: bool) -> Snapshot {
        let mut snapshot = Snapshot::default();
        for port in &mut self.ports {
            if with_raw {
                port.last_raw = port.raw.number().ok().and_then(whole);
            }
            let mut value = port.sensor.read().ok().and_then(whole);
            let is_distance = port.name.starts_with('D');
            if is_distance && value.is_none() && port.last_raw == whole(NO_ECHO) {
                value = port.last_raw;
            }
            list_of(&mut snapshot, &port.name).push(Port {
                name: port.name.clone(),
                value,
                raw: port.last_raw,
            });
        }
        snapshot.accelerometer = self
            .accelerometer
            .read()
            .ok()
            .and_then(|numbers| all_whole(&numbers));
        snapshot.gyroscope = self
            .gyroscope
            .read()
            .ok()
            .and_then(|numbers| all_whole(&numbers));
        snapshot.gamepad = self.gamepad_now();
        let pressed = self.keys.pressed().unwrap_or_default();
        for (key, is_pressed) in KEYS.iter().zip(pressed) {
            if let Some(index) = telemetry::KEYS.iter().position(|name| *name == key.0) {
                snapshot.keys[index] = is_pressed;
            }
        }
        snapshot
    }

    fn gamepad_now(&self) -> telemetry::Gamepad {
        let pad = |number| {
            let (x, y) = self.gamepad.pad(number)?;
            Some((whole(x)?, whole(y)?))
        };
        if !self.gamepad.is_connected() {
            return telemetry::Gamepad::default();
        }
        telemetry::Gamepad {
            is_connected: true,
            buttons: std::array::from_fn(|index| self.gamepad.button(index + 1)),
            wheel: whole(self.gamepad.wheel()).filter(|wheel| f64::from(*wheel) != NOT_PRESSED),
            pads: [pad(1), pad(2)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Tree;
    use harness::put;
    use tempfile::tempdir;

    #[test]
    fn a_snapshot_has_what_can_be_read_and_leaves_empty_what_cannot() {
        let scratch = tempdir().unwrap();
        for (file, content) in [
            ("sensors/A1/value", "27"),
            ("sensors/A1/raw", "281"),
            ("sensors/A2/value", "broken"),
            ("sensors/D1/raw", "-1 0"),
            ("sensors/D1/value", ""),
            ("sensors/front/value", "27"),
            ("encoders/E1/value", "-90.6"),
            ("accelerometer/value", "1 2 1000"),
            ("keys/value", "0 1 0 0 0 0 1"),
        ] {
            put(scratch.path(), file, content);
        }
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .build()
            .unwrap();
        let sampler = Sampler::start(scratch.path()).unwrap();
        let text = runtime.block_on(sampler.snapshot()).all_data();
        let start = "allData:A1:27:281;A2::;D1:-1:-1;E1:-91:;AccelerometerPort:(1,2,1000);GyroscopePort:;GamepadButton1Port:0;";
        assert!(text.starts_with(start), "{text}");
        assert!(
            text.ends_with(";Left:0;Up:1;Down:0;Enter:1;Right:0;Power:0;Esc:0"),
            "{text}"
        );
    }

    /// What is open is sampled: nobody reads it any more.
    #[test]
    fn files_are_closed_when_nobody_has_asked_for_a_while_and_opened_for_the_next_who_does() {
        let scratch = tempdir().unwrap();
        let file = put(scratch.path(), "battery/value", "1");
        let tree = Tree::new(scratch.path());
        let node = tree.node("battery/value", Access::ReadNow);
        let read = || {
            let mut bytes = [0; 8];
            let size = node.bytes(&mut bytes).unwrap();
            bytes[..size].to_vec()
        };
        assert_eq!(read(), b"1");
        // An open file is still the one that was there.
        std::fs::remove_file(&file).unwrap();
        put(scratch.path(), "battery/value", "2");
        assert_eq!(read(), b"1");
        let (ask, asked) = sync_channel(1);
        let mut ask = Some(ask);
        let is_asked = is_asked(&asked, Duration::ZERO, || {
            tree.close();
            ask = None;
        });
        assert!(!is_asked, "nobody is left who could ask");
        assert_eq!(read(), b"2");
    }

    /// A device may take longer than a client waits.
    #[test]
    fn ports_have_names_before_any_device_has_answered() {
        let scratch = tempdir().unwrap();
        for file in ["sensors/A1/value", "sensors/D2/value", "encoders/E1/value"] {
            put(scratch.path(), file, "1");
        }
        let (publish, newest) = watch::channel(None);
        name_ports(&Files::find(&Brick::new(scratch.path())), &publish);
        let (at, snapshot) = newest.borrow().clone().unwrap();
        assert_eq!(at, None);
        assert_eq!(
            snapshot.port_names(),
            "ports:analog:A1;digital:D2;special:;encoders:E1"
        );
    }

    #[test]
    fn a_tree_that_comes_later_is_found() {
        let scratch = tempdir().unwrap();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .build()
            .unwrap();
        let sampler = Sampler::start(scratch.path()).unwrap();
        let names = || runtime.block_on(sampler.snapshot()).port_names();
        assert_eq!(names(), "ports:analog:;digital:;special:;encoders:");
        put(scratch.path(), "sensors/A1/value", "1");
        harness::eventually("the tree is found", || {
            names() == "ports:analog:A1;digital:;special:;encoders:"
        });
    }
}
