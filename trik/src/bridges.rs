//! `trik bridge`: a mounted tree for tools of other people.
//!
//! Owns the run: which tree, when it ends, and what a person is told. What those tools get is known to the crate `bridge`.

pub(crate) mod args;
mod foxglove;
mod mqtt;

use crate::error::Error;
use crate::record::tree;
use crate::refusal::Refusal;
use crate::remote::target::tree_of;
use crate::up::session::signals;
use ::bridge::follow::{Change, Follow};
use ::bridge::http::{Served, serve};
use ::bridge::prometheus::{MEDIA_TYPE, Numbers};
use args::{Bridge, PrometheusArgs};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::net::SocketAddr;
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The program that looks, with its version.
const PROGRAM: &str = concat!("trik/", env!("CARGO_PKG_VERSION"));

/// Serves until somebody stops it.
///
/// # Errors
/// There is no tree, or nobody can listen there.
pub(crate) fn run(which: &Bridge) -> Result<u8, Refusal> {
    match which {
        Bridge::Prometheus(args) => prometheus(args),
        Bridge::Foxglove(args) => foxglove::serve(args),
        Bridge::Mqtt(args) => mqtt::serve(args),
    }
}

fn prometheus(args: &PrometheusArgs) -> Result<u8, Refusal> {
    let root = root(args.robot.as_deref(), args.mountpoint.as_deref())?;
    // Threads inherit what is blocked.
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let mut follow = Follow::begin(&root, PROGRAM).map_err(refused)?;
    let numbers = Arc::new(Mutex::new(Numbers::default()));
    let with = |numbers: &Mutex<Numbers>, work: &mut dyn FnMut(&mut Numbers)| {
        work(&mut numbers.lock().unwrap_or_else(PoisonError::into_inner));
    };
    with(&numbers, &mut |numbers| {
        numbers.take(&follow.beginning());
        numbers.health(true, 0);
    });
    let (shared, of) = (numbers.clone(), root.clone());
    let text = move || {
        let numbers = shared.lock().unwrap_or_else(PoisonError::into_inner);
        numbers.text(&of)
    };
    let address = SocketAddr::new(args.address, args.port);
    let served = Served {
        path: "/metrics",
        media_type: MEDIA_TYPE,
        text: Arc::new(text),
    };
    let address = serve(address, served).map_err(refused)?;
    say(&format!(
        "{}: http://{address}/metrics; Ctrl-C ends it\n",
        root.display()
    ))?;
    let mut entries = Vec::new();
    loop {
        entries.clear();
        let change = follow.look(&mut entries);
        with(&numbers, &mut |numbers| {
            numbers.take(&entries);
            numbers.health(follow.is_there(), follow.missed());
        });
        match change {
            Change::Same => {}
            Change::Gone => say("the tree is gone; waiting for it\n")?,
            Change::Back => say("the tree is there again\n")?,
        }
        if let Ok(Some(_)) = signals.read_signal() {
            return Ok(0);
        }
        let mut fds = [PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        let _ = poll(&mut fds, PollTimeout::from(recorder::limits::LOOK_MS));
    }
}

/// The tree that is meant.
fn root(robot: Option<&Path>, mountpoint: Option<&Path>) -> Result<PathBuf, Error> {
    let named = robot.map(tree_of).transpose()?;
    tree(named.as_deref().or(mountpoint))
}

/// What cannot be served, for the person.
fn refused(error: ::bridge::error::Error) -> Error {
    Error::Refused(error.to_string())
}

/// A line of the run itself.
fn say(text: &str) -> Result<(), Refusal> {
    crate::output::standard(text.as_bytes())
}
