//! What all parts of the server of one robot share, and what it is for.
//!
//! Owns nothing that happens. The robot is where the server was told last.

use crate::admission::Admission;
use crate::control::Control;
use crate::gate::Gate;
use crate::guests::Guests;
use crate::playback::Playback;
use crate::world::World;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use tokio::sync::{Semaphore, watch};

/// What a page is for.
pub struct Settings {
    /// Where it is served; with port 0 at any free one. `[::]` is every address, of IPv4 too.
    pub address: SocketAddr,
    /// The robot, as a title.
    pub name: String,
    /// Where the tree is mounted.
    pub tree: PathBuf,
    /// The folder of programs, if it is on this machine.
    pub programs: Option<PathBuf>,
    /// The folder of a built studio, in which diagrams are drawn, if there is one.
    pub studio: Option<PathBuf>,
    /// What is around the robot, if that is virtual.
    pub world: Option<Arc<dyn World>>,
    /// What is played below the tree, if that is a recording.
    pub playback: Option<Arc<dyn Playback>>,
    /// A browser that is in control may replace the configuration of the tree, and so run any code as its filesystem does.
    pub configures: bool,
    /// Which computers may do what.
    pub guests: Arc<dyn Guests>,
}

/// What all requests share.
pub struct Shared {
    pub settings: Settings,
    /// What requests pass first.
    pub gate: Arc<Gate>,
    /// Where the robot takes programs.
    pub robot: watch::Sender<Option<SocketAddr>>,
    pub control: Control,
    pub admission: Admission,
    /// Bytes of uploads that may wait for the robot.
    pub uploads: Arc<Semaphore>,
    /// Large things that are read or made at once: they leave threads for what moves.
    pub large: Arc<Semaphore>,
    /// Looks into nodes at once: a device may make them wait.
    pub looks: Arc<Semaphore>,
}
