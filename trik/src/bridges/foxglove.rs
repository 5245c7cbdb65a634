//! `trik bridge foxglove`: the run, from its beginning to Ctrl-C.
//!
//! Owns which robot is served, and what a person is told. What clients get is known to the crate `bridge`.

use super::args::FoxgloveArgs;
use super::{PROGRAM, refused, root, say};
use crate::error::Error;
use crate::refusal::Refusal;
use crate::remote::bridged::Programs;
use crate::remote::stories::Stories;
use crate::remote::target::target;
use crate::up::session::signals;
use ::bridge::follow::{Change, Follow};
use ::bridge::foxglove::client::House;
use ::bridge::foxglove::robot::{self, Robot};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use recorder::clock::now_ns;
use std::net::SocketAddr;
use std::os::fd::AsFd;

/// Serves until somebody stops it.
///
/// # Errors
/// There is no tree, or nobody can listen there.
pub(super) fn serve(args: &FoxgloveArgs) -> Result<u8, Refusal> {
    let root = root(args.robot.as_deref(), args.mountpoint.as_deref())?;
    // Threads inherit what is blocked.
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let mut follow = Follow::begin(&root, PROGRAM).map_err(refused)?;
    let shown = root.display().to_string();
    // Without a robot that takes programs there is its tree.
    let programs = args
        .programs
        .clone()
        .or_else(|| target(&format!("{shown}/")).ok());
    let stories = programs.clone().map(Stories::hear).transpose()?;
    let programs = programs.map(|at| Box::new(Programs::new(at)) as Box<dyn robot::Programs>);
    let house = House {
        name: shown.clone(),
        session: format!("{:x}-{:x}", now_ns(), std::process::id()),
        origins: args.origin.clone(),
        lets_all_act: args.control,
    };
    let address = SocketAddr::new(args.address, args.port);
    let robot = Robot::new(&root, programs);
    let mut server = ::bridge::foxglove::serve(address, house, robot, PROGRAM).map_err(refused)?;
    server.take(&follow.beginning());
    say(&format!(
        "{shown}: ws://{}; Ctrl-C ends it\n",
        server.address()
    ))?;
    let mut entries = Vec::new();
    loop {
        entries.clear();
        if let Some(stories) = &stories {
            stories.take(&mut entries);
        }
        match follow.look(&mut entries) {
            Change::Same => server.take(&entries),
            Change::Gone => {
                server.gone().map_err(refused)?;
                say("the tree is gone; waiting for it\n")?;
            }
            Change::Back => {
                server.back();
                server.take(&follow.beginning());
                say("the tree is there again\n")?;
            }
        }
        if let Ok(Some(_)) = signals.read_signal() {
            return Ok(0);
        }
        let mut fds = [PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        let _ = poll(&mut fds, PollTimeout::from(recorder::limits::LOOK_MS));
    }
}
