//! What all parts of the server share: what it is for, and who may do what.
//!
//! Owns nothing that happens. The robot is where the server was told last.

use crate::control::Control;
use crate::playback::Playback;
use crate::world::World;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use tokio::sync::{Semaphore, watch};

/// Which computers may do what.
pub trait Guests: Send + Sync {
    /// It connects; what it may is asked later.
    fn comes(&self, _: IpAddr) {}

    /// It may look.
    fn may_look(&self, ip: IpAddr) -> bool;

    /// It may do things. Asked often; a person at the robot may say yes meanwhile.
    fn may_drive(&self, ip: IpAddr) -> bool;

    /// It wants to do something and may not: a person at the robot may say yes now.
    fn asks(&self, ip: IpAddr);
}

/// Every computer may do everything.
#[derive(Clone, Copy, Debug)]
pub struct Everybody;

impl Guests for Everybody {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        true
    }

    fn asks(&self, _: IpAddr) {}
}

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
    /// The port where it is really served.
    pub port: u16,
    /// Of this machine.
    pub host_name: String,
    /// The value of the cookie.
    pub token: String,
    /// Where the robot takes programs.
    pub robot: watch::Sender<Option<SocketAddr>>,
    pub control: Control,
    pub browsers: Arc<Semaphore>,
    /// Bytes of uploads that may wait for the robot.
    pub uploads: Arc<Semaphore>,
    /// Large things that are read or made at once: they leave threads for what moves.
    pub large: Arc<Semaphore>,
    /// Looks into nodes at once: a device may make them wait.
    pub looks: Arc<Semaphore>,
    /// Of the newest browser.
    pub number: AtomicUsize,
}
