//! A robot as a class names it, and the border to the program that knows where it is.
//!
//! Owns neither: addresses and names are those of that program, which serves the page.

use lang_text::problem::Words;
use std::net::SocketAddr;
use std::sync::Arc;

/// Where a robot is at the moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Where it takes programs: tried one after the other.
    pub addresses: Vec<SocketAddr>,
    /// Where its own page is, if that is known.
    pub page: Option<OwnPage>,
}

/// Where the page of a robot is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OwnPage {
    /// There.
    At(SocketAddr),
    /// At this port of the address where it takes programs.
    Port(u16),
}

/// Where a robot is. It is asked before each connection, on a thread that may wait.
pub trait Whereabouts: Send + Sync {
    /// Looks for it.
    ///
    /// # Errors
    /// A sentence: there is no such robot now.
    fn find(&self) -> Result<Found, Words>;
}

/// A robot of the class.
pub struct Member {
    /// What people call it.
    pub name: String,
    /// Those that are together; empty: it is in none.
    pub group: String,
    /// Where it is, as people write it.
    pub at: String,
    /// Where it is in the network.
    pub whereabouts: Arc<dyn Whereabouts>,
}
