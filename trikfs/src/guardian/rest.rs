//! Brings actuators to rest when nobody serves them any more.
//!
//! Owns the order and the patience: actions run one after the other, but one that hangs in its driver delays the
//! others only for a moment, and all of them together have a deadline. The devices are opened like those of the daemon.
//! Knows nothing of the tree.

use super::actions::RestAction;
use crate::device::i2c::bus::Buses;
use crate::device::{Surroundings, kinds};
use crate::errno::Error;
use crate::limits;
use std::collections::VecDeque;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

type Queue = Arc<Mutex<VecDeque<(usize, RestAction)>>>;

/// Carries out all actions and gives a line for each that failed or did not end within three seconds.
pub fn bring_to_rest(actions: &[RestAction]) -> Vec<String> {
    bring_to_rest_within(actions, Duration::from_millis(limits::REST_MS_MAX.into()))
}

pub(super) fn bring_to_rest_within(actions: &[RestAction], limit: Duration) -> Vec<String> {
    let deadline = Instant::now() + limit;
    let queue: Queue = Arc::new(Mutex::new(actions.iter().cloned().enumerate().collect()));
    let mut open: Vec<bool> = vec![true; actions.len()];
    let buses = Arc::default();
    let mut complaints = Vec::new();
    let (sender, results) = mpsc::channel();
    let mut workers = 0;
    while open.contains(&true) {
        let now = Instant::now();
        if now >= deadline {
            break;
        }
        if workers == 0 {
            workers += usize::from(start_worker(&queue, &buses, &sender));
        }
        let patience = if workers < limits::REST_THREADS_MAX {
            limits::REST_PATIENCE
        } else {
            limit
        };
        match results.recv_timeout(patience.min(deadline - now)) {
            Ok((index, result)) => {
                open[index] = false;
                if let Err(error) = result {
                    complaints.push(format!("rest of {}: {error}", shown(&actions[index])));
                }
            }
            Err(RecvTimeoutError::Timeout) if workers < limits::REST_THREADS_MAX => {
                workers += usize::from(start_worker(&queue, &buses, &sender));
            }
            Err(_) => {}
        }
    }
    let late = actions.iter().zip(&open).filter(|(_, open)| **open);
    complaints
        .extend(late.map(|(action, _)| format!("rest of {}: not done in time", shown(action))));
    complaints
}

/// A thread that works through the queue. One that hangs is left behind: the process is about to end, or to
/// start a daemon that finds the device busy and says so.
fn start_worker(
    queue: &Queue,
    buses: &Arc<Buses>,
    results: &Sender<(usize, Result<(), Error>)>,
) -> bool {
    let (queue, buses) = (Arc::clone(queue), Arc::clone(buses));
    let results = results.clone();
    let work = move || {
        loop {
            let next = queue
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .pop_front();
            let Some((index, action)) = next else { return };
            if results.send((index, perform(&action, &buses))).is_err() {
                return;
            }
        }
    };
    std::thread::Builder::new()
        .name("rest".to_owned())
        .spawn(work)
        .is_ok()
}

fn perform(action: &RestAction, buses: &Arc<Buses>) -> Result<(), Error> {
    let around = Surroundings::alone(action.timeout_ms.min(limits::REST_MS_MAX), buses);
    kinds::open_sink(&action.sink, &around)?.write(&action.tuple, true)
}

/// The path of the device.
fn shown(action: &RestAction) -> String {
    let paths = action.sink.needed_paths();
    let path = paths.first().map(|path| path.display().to_string());
    path.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;
    use config::description::SourceDescription;
    use nix::sys::stat::Mode;
    use std::fs::{self, File};
    use std::io::Read;
    use std::path::PathBuf;

    fn action(path: PathBuf, bytes: &[u8]) -> RestAction {
        RestAction {
            sink: SourceDescription::Path(path.as_path().into()),
            tuple: bytes.to_vec(),
            timeout_ms: 1000,
        }
    }

    #[test]
    fn every_actuator_gets_its_bytes_in_order() {
        let scratch = Scratch::new();
        let fifo = scratch.path("fifo");
        nix::unistd::mkfifo(&fifo, Mode::S_IRWXU).expect("fifo");
        let mut reader = File::options()
            .read(true)
            .write(true)
            .open(&fifo)
            .expect("opens");
        let file = scratch.path("motor");
        fs::write(&file, "100").expect("written");
        let actions = [
            action(fifo.clone(), b"one"),
            action(file.clone(), b"0"),
            action(fifo, b"two"),
        ];
        assert_eq!(bring_to_rest(&actions), Vec::<String>::new());
        let mut got = [0; 6];
        reader.read_exact(&mut got).expect("read");
        assert_eq!(&got, b"onetwo");
        assert_eq!(fs::read(file).expect("read"), b"000");
    }

    #[test]
    fn one_that_fails_does_not_keep_the_others_from_resting() {
        let scratch = Scratch::new();
        let alone = scratch.path("alone");
        nix::unistd::mkfifo(&alone, Mode::S_IRWXU).expect("fifo");
        let file = scratch.path("motor");
        fs::write(&file, "1").expect("written");
        let actions = [
            action(scratch.path("absent"), b"0"),
            action(alone, b"0"),
            action("/dev/full".into(), b"0"),
            action(file.clone(), b"0"),
        ];
        let mut complaints = bring_to_rest(&actions);
        complaints.sort();
        assert_eq!(complaints.len(), 3, "{complaints:?}");
        assert!(
            complaints[0].ends_with("/dev/full: No space left on device (os error 28)"),
            "{complaints:?}"
        );
        assert!(!scratch.path("absent").exists());
        assert_eq!(fs::read(file).expect("read"), b"0");
    }

    #[test]
    fn no_action_ends_at_once_and_a_passed_deadline_is_reported() {
        assert!(bring_to_rest(&[]).is_empty());
        let late = bring_to_rest_within(&[action("/dev/null".into(), b"0")], Duration::ZERO);
        assert_eq!(late, ["rest of /dev/null: not done in time"]);
    }
}
