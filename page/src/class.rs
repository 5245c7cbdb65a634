//! A page for a whole class: what many robots do, a stop for all of them, and programs to those that are chosen.
//!
//! Owns what is served at which address. The parts:
//!
//! - `member`: a robot as a class names it, and where it is
//! - `board`: the card of each robot, which all viewers are shown; `shared`: what all viewers share
//! - `robot`: the connection to one robot, which comes back by itself; `upload`: a file on its way to one
//! - `viewer`, `word`: one browser that looks, and what is said to it; `words`: why something is not so, in two languages

mod board;
mod member;
mod robot;
mod shared;
mod upload;
mod viewer;
mod word;
mod words;

use crate::admission::Admission;
use crate::door::Peer;
use crate::error::Error;
use crate::guests::Guests;
use crate::limits;
use crate::room;
use crate::route::locale;
use crate::serving::Serving;
use axum::Router;
use axum::extract::{ConnectInfo, Query, State, WebSocketUpgrade};
use axum::response::Response;
use axum::routing::get;
use board::Board;
use shared::Class;
use std::collections::HashMap;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::sync::Semaphore;

pub use member::{Found, Member, OwnPage, Whereabouts};
pub use robot::{BATTERY, COMMANDER, DEBUGGER, EXPLAINED, STARTED};
pub use upload::REFUSALS;

/// The path of the page, by which it knows that it is this one.
pub(crate) const PATH: &str = "/class";

/// What the page of a class is for.
pub struct ClassSettings {
    /// The class, as a title.
    pub name: String,
    /// At most [`limits::CLASS_ROBOTS_MAX`]; others are left out.
    pub robots: Vec<Member>,
    /// Which computers may do what. Those that may only look can stop nothing either.
    pub guests: Arc<dyn Guests>,
}

/// The page of a class that is served. Dropping it ends that.
#[derive(Debug)]
pub struct ClassPage(Serving);

impl ClassPage {
    /// Serves it from now on, with port 0 at any free one, and looks for the robots.
    ///
    /// # Errors
    /// Nobody can listen there, or there are no more threads.
    pub fn start(address: SocketAddr, settings: ClassSettings) -> Result<Self, Error> {
        let guests = settings.guests.clone();
        room::serve(address, guests, limits::CLASS_ROBOTS_MAX, &[PATH], || {
            routes(settings, false)
        })
        .map(Self)
    }

    /// Where it is served; the page itself is at [`ClassPage::path`] there.
    pub fn address(&self) -> SocketAddr {
        self.0.address()
    }

    /// The path of the page.
    pub fn path() -> &'static str {
        PATH
    }
}

/// What is the class' own of what is served, of which marks may be another part. Looks for the robots from now on; has to be called
/// within a runtime.
pub(crate) fn routes(settings: ClassSettings, has_marks: bool) -> Router {
    let ClassSettings {
        name,
        mut robots,
        guests,
    } = settings;
    robots.truncate(limits::CLASS_ROBOTS_MAX);
    let board = Arc::new(Board::new(&robots));
    for (id, member) in robots.iter().enumerate() {
        tokio::spawn(robot::run(board.clone(), id, member.whereabouts.clone()));
    }
    let class = Class {
        name,
        has_marks,
        board,
        guests,
        admission: Admission::default(),
        uploads: Arc::new(Semaphore::new(limits::UPLOADS_BYTES_MAX)),
    };
    Router::new()
        .route("/socket/class", get(socket))
        .with_state(Arc::new(class))
}

async fn socket(
    State(class): State<Arc<Class>>,
    ConnectInfo(Peer(address)): ConnectInfo<Peer>,
    Query(query): Query<HashMap<String, String>>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let locale = locale(&query);
    let (guests, served) = (class.guests.clone(), class.clone());
    class
        .admission
        .admit(&*guests, address, upgrade, move |socket, who| {
            viewer::serve(served, socket, who, locale)
        })
}

#[cfg(test)]
mod tests;
