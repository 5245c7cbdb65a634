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
use crate::gate::{Gate, enter, text};
use crate::guests::Guests;
use crate::route::{given, locale};
use crate::serving::Serving;
use crate::{files, limits};
use axum::Router;
use axum::extract::{ConnectInfo, Query, State, WebSocketUpgrade};
use axum::http::{StatusCode, Uri};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
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
const PATH: &str = "/class";
/// Paths that give the cookie.
const PAGES: &[&str] = &[PATH];
/// First parts of paths that need it.
const DATA: &[&str] = &["socket"];

/// What the page of a class is for.
pub struct ClassSettings {
    /// Where it is served; with port 0 at any free one.
    pub address: SocketAddr,
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
    /// Serves it from now on, and looks for the robots.
    ///
    /// # Errors
    /// Nobody can listen there, or there are no more threads.
    pub fn start(settings: ClassSettings) -> Result<Self, Error> {
        let ClassSettings {
            address,
            name,
            mut robots,
            guests,
        } = settings;
        robots.truncate(limits::CLASS_ROBOTS_MAX);
        let threads = limits::CLASS_ROBOTS_MAX;
        let serving = Serving::start(address, guests.clone(), threads, |port| {
            let gate = Arc::new(Gate::new(guests.clone(), port, PAGES, DATA)?);
            let board = Arc::new(Board::new(&robots));
            for (id, member) in robots.iter().enumerate() {
                tokio::spawn(robot::run(board.clone(), id, member.whereabouts.clone()));
            }
            let class = Arc::new(Class {
                name,
                board,
                guests,
                admission: Admission::default(),
                uploads: Arc::new(Semaphore::new(limits::UPLOADS_BYTES_MAX)),
            });
            Ok(Router::new()
                .route("/socket", get(socket))
                .fallback(file)
                .layer(from_fn_with_state(gate, enter))
                .with_state(class))
        })?;
        Ok(Self(serving))
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

async fn file(uri: Uri) -> Response {
    let path = match uri.path() {
        PATH => "/",
        "/" => {
            return (StatusCode::TEMPORARY_REDIRECT, [("location", PATH)]).into_response();
        }
        other => other,
    };
    files::find_of_class(path).map_or_else(|| match path {
        "/" => text(
            StatusCode::NOT_FOUND,
            "this program was built without the page for browsers: install nodejs and npm, and build again",
        ),
        _ => text(StatusCode::NOT_FOUND, "there is no such file"),
    }, given)
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
