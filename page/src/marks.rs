//! A page for the marks of a class while they come: a row for each pupil, a column for each task, and the replay of each run.
//!
//! Owns what is served at which address. Who judges is another program, which tells each row when it changes. The parts:
//!
//! - `sheet`: the table as that program knows it
//! - `board`: the rows that all viewers are shown
//! - `viewer`, `word`: one browser that looks, and what is said to it
//! - `replay`: the page of a run, as an answer

mod board;
mod replay;
mod sheet;
mod viewer;
mod word;

use crate::admission::Admission;
use crate::class::{self, ClassSettings};
use crate::door::Peer;
use crate::error::Error;
use crate::gate::text;
use crate::guests::{Everybody, Guests};
use crate::limits;
use crate::room;
use crate::route::locale;
use crate::serving::Serving;
use axum::Router;
use axum::extract::{ConnectInfo, Path, Query, State, WebSocketUpgrade};
use axum::http::StatusCode;
use axum::response::Response;
use axum::routing::get;
use board::Board;
use std::collections::HashMap;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::sync::Semaphore;

pub use sheet::{Cell, Column, Mark, MarkTable, Row, Tone};

/// The path of the page, by which it knows that it is this one.
pub(crate) const PATH: &str = "/marks";

/// What all viewers share.
struct Shared {
    board: Arc<Board>,
    guests: Arc<dyn Guests>,
    admission: Admission,
    /// Replays that are read at once.
    replays: Semaphore,
}

/// The page of marks that is served. Dropping it ends that.
pub struct MarksPage {
    serving: Serving,
    board: Arc<Board>,
    path: &'static str,
}

impl MarksPage {
    /// Serves it from now on, with nothing judged. With a class the robots are on the same page, and its guests say who may look and
    /// command; without one anyone who reaches the address may look, and nobody can do more.
    ///
    /// # Errors
    /// Nobody can listen there, or there are no more threads.
    pub fn start(
        address: SocketAddr,
        sheet: MarkTable,
        class: Option<ClassSettings>,
    ) -> Result<Self, Error> {
        let board = Arc::new(Board::new(sheet));
        let shown = board.clone();
        let guests: Arc<dyn Guests> = match &class {
            Some(class) => class.guests.clone(),
            None => Arc::new(Everybody),
        };
        let (path, pages, robots): (_, &[_], _) = match &class {
            Some(_) => (class::PATH, &[class::PATH, PATH], limits::CLASS_ROBOTS_MAX),
            None => (PATH, &[PATH], 0),
        };
        let shared = Shared {
            board: shown,
            guests: guests.clone(),
            admission: Admission::default(),
            replays: Semaphore::new(limits::REPLAYS_AT_ONCE),
        };
        let threads = limits::REPLAYS_AT_ONCE + robots;
        let serving = room::serve(address, guests, threads, pages, || {
            let marks = Router::new()
                .route("/socket/marks", get(socket))
                .route("/replay/{number}", get(replayed))
                .with_state(Arc::new(shared));
            match class {
                Some(class) => marks.merge(class::routes(class, true)),
                None => marks,
            }
        })?;
        Ok(Self {
            serving,
            board,
            path,
        })
    }

    /// Where it is served; the page itself is at [`MarksPage::path`] there.
    pub fn address(&self) -> SocketAddr {
        self.serving.address()
    }

    /// The path of the page.
    pub fn path(&self) -> &'static str {
        self.path
    }

    /// A row is so now; viewers are told if that has made a difference. One that is not in the table is left out.
    pub fn row(&self, pupil: usize, row: Row) {
        self.board.row(pupil, row);
    }

    /// So many runs are judged.
    pub fn done(&self, runs: usize) {
        self.board.progress(|progress| progress.done = runs);
    }

    /// Nothing more comes.
    pub fn over(&self) {
        self.board.progress(|progress| progress.is_over = true);
    }
}

async fn socket(
    State(shared): State<Arc<Shared>>,
    ConnectInfo(Peer(address)): ConnectInfo<Peer>,
    Query(query): Query<HashMap<String, String>>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let locale = locale(&query);
    let (guests, board) = (shared.guests.clone(), shared.board.clone());
    shared
        .admission
        .admit(&*guests, address, upgrade, move |socket, _| {
            viewer::serve(board, socket, locale)
        })
}

async fn replayed(State(shared): State<Arc<Shared>>, Path(number): Path<String>) -> Response {
    let number = number.parse().ok();
    let Some(path) = number.and_then(|number| shared.board.replay(number)) else {
        return text(StatusCode::NOT_FOUND, "there is no replay of such a run");
    };
    // Nobody closes the semaphore.
    let _turn = shared.replays.acquire().await;
    replay::answer(path).await
}

#[cfg(test)]
mod tests;
