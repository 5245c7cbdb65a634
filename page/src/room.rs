//! The pages of a room of people, of robots and of marks, as one server gives them.
//!
//! Owns the gate before them, and the files of the page, which are the same for both: by its path the page knows which one it is.
//! What is below each path of data is known to `class` and to `marks`.

use crate::error::Error;
use crate::files;
use crate::gate::{Gate, enter, text};
use crate::guests::Guests;
use crate::route::given;
use crate::serving::Serving;
use axum::Router;
use axum::http::{StatusCode, Uri};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use std::net::SocketAddr;
use std::sync::Arc;

/// First parts of paths that need the cookie.
const DATA: &[&str] = &["socket", "replay"];

/// Serves what `routes` makes within the runtime, and the page at these paths, to the first of which the root leads. So many threads
/// are there for what may have to wait.
///
/// # Errors
/// Nobody can listen there, or there are no more threads.
pub fn serve(
    address: SocketAddr,
    guests: Arc<dyn Guests>,
    threads: usize,
    pages: &'static [&'static str],
    routes: impl FnOnce() -> Router,
) -> Result<Serving, Error> {
    Serving::start(address, guests.clone(), threads, |port| {
        let gate = Arc::new(Gate::new(guests, port, pages, DATA)?);
        Ok(routes()
            .fallback(async move |uri: Uri| file(pages, &uri))
            .layer(from_fn_with_state(gate, enter)))
    })
}

fn file(pages: &'static [&'static str], uri: &Uri) -> Response {
    let path = match (uri.path(), pages) {
        (path, _) if pages.contains(&path) => "/",
        ("/", [home, ..]) => {
            return (StatusCode::TEMPORARY_REDIRECT, [("location", *home)]).into_response();
        }
        (other, _) => other,
    };
    files::find_of_class(path).map_or_else(|| match path {
        "/" => text(
            StatusCode::NOT_FOUND,
            "this program was built without the page for browsers: install nodejs and npm, and build again",
        ),
        _ => text(StatusCode::NOT_FOUND, "there is no such file"),
    }, given)
}
