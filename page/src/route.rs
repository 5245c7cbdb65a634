//! Which address gives what: the page, the socket of a browser, programs, and a plain table for browsers without scripts.
//!
//! Owns the addresses; nothing is given before `gate` has agreed.

use crate::browser;
use crate::diagrams::{self, Change};
use crate::door::Peer;
use crate::error::Error;
use crate::files::File;
use crate::gate::{enter, text};
use crate::shared::Shared;
use crate::{configuration, files, inside, plain, store, studio as drawing};
use axum::Router;
use axum::extract::{ConnectInfo, Path, Query, State, WebSocketUpgrade};
use axum::http::header::{CACHE_CONTROL, CONTENT_ENCODING, CONTENT_TYPE};
use axum::http::{StatusCode, Uri};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::get;
use lang_text::problem::Locale;
use std::collections::HashMap;
use std::sync::Arc;
use tokio::sync::Semaphore;
use tokio::task::JoinError;

/// Paths that give the cookie.
pub const PAGES: &[&str] = &["/", "/plain", "/studio/"];
/// First parts of paths that are of this robot, and not of every page.
pub const DATA: &[&str] = &[
    "socket",
    "programs",
    "program",
    "save",
    "diagram",
    "changed",
    "configuration",
    "converters",
];

/// All addresses.
pub fn router(shared: Arc<Shared>) -> Router {
    Router::new()
        .route("/socket", get(socket))
        .route("/programs", get(programs))
        .route("/program/{*name}", get(program))
        .route("/save/{*name}", get(save))
        .route("/diagram/{*name}", get(diagram))
        .route("/changed/{*name}", get(changed))
        .route("/configuration", get(configured))
        .route("/converters", get(converters))
        .route("/studio", get(async || Redirect::permanent("/studio/")))
        .route("/studio/", get(studio))
        .route("/studio/{*path}", get(studio))
        .route("/plain", get(table))
        .fallback(file)
        .layer(from_fn_with_state(shared.gate.clone(), enter))
        .with_state(shared)
}

async fn file(uri: Uri) -> Response {
    match files::find(uri.path()) {
        Some(file) => given(file),
        None if uri.path() == "/" => {
            (StatusCode::TEMPORARY_REDIRECT, [("location", "/plain")]).into_response()
        }
        None => text(StatusCode::NOT_FOUND, "there is no such file"),
    }
}

/// A file of the page as an answer.
pub fn given(file: &'static File) -> Response {
    let age = if files::is_kept(file.path) {
        "public, max-age=31536000, immutable"
    } else {
        "no-cache"
    };
    let headers = [
        (CONTENT_TYPE, file.kind),
        (CONTENT_ENCODING, "gzip"),
        (CACHE_CONTROL, age),
    ];
    (headers, file.bytes).into_response()
}

async fn socket(
    State(shared): State<Arc<Shared>>,
    ConnectInfo(Peer(address)): ConnectInfo<Peer>,
    Query(query): Query<HashMap<String, String>>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let locale = locale(&query);
    let (guests, served) = (shared.settings.guests.clone(), shared.clone());
    shared
        .admission
        .admit(&*guests, address, upgrade, move |socket, who| {
            browser::serve(served, socket, who, locale)
        })
}

/// Does something with files on another thread, and answers with what came out.
async fn with_files<T: Send + 'static>(
    shared: &Shared,
    locale: Locale,
    work: impl FnOnce() -> Result<T, Error> + Send + 'static,
    answer: impl FnOnce(T) -> Response,
) -> Response {
    match in_turn(shared.large.clone(), work).await {
        Ok(Ok(done)) => answer(done),
        Ok(Err(error @ (Error::Name(_) | Error::File(..)))) => {
            text(StatusCode::NOT_FOUND, error.words().in_locale(locale))
        }
        Ok(Err(error)) => text(
            StatusCode::UNPROCESSABLE_ENTITY,
            error.words().in_locale(locale),
        ),
        Err(_) => text(
            StatusCode::INTERNAL_SERVER_ERROR,
            "the page could not be made",
        ),
    }
}

/// Does one of the large things on another thread. It has its turn until it is done, even if nobody waits for it any more: a
/// browser that goes away and asks again does not get more threads.
async fn in_turn<T: Send + 'static>(
    large: Arc<Semaphore>,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, JoinError> {
    // Nobody closes the semaphore.
    let turn = large.acquire_owned().await;
    let work = move || {
        let _turn = turn;
        work()
    };
    tokio::task::spawn_blocking(work).await
}

fn json(value: serde_json::Value) -> Response {
    let kind = [
        (CONTENT_TYPE, "application/json"),
        (CACHE_CONTROL, "no-store"),
    ];
    (kind, value.to_string()).into_response()
}

async fn programs(State(shared): State<Arc<Shared>>) -> Response {
    // It says nothing in words.
    let locale = Locale::English;
    let seen = shared.clone();
    let work = move || {
        let folder = seen.settings.programs.as_deref();
        Ok(folder.map_or_else(|| serde_json::json!([]), store::list))
    };
    with_files(&shared, locale, work, json).await
}

async fn program(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Query(query): Query<HashMap<String, String>>,
) -> Response {
    let locale = locale(&query);
    let seen = shared.clone();
    let work = move || store::text(folder(&seen, &name)?, &name);
    let kind = [
        (CONTENT_TYPE, "text/plain; charset=utf-8"),
        (CACHE_CONTROL, "no-store"),
    ];
    with_files(&shared, locale, work, |text| (kind, text).into_response()).await
}

/// A program as it is, byte for byte.
async fn save(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Query(query): Query<HashMap<String, String>>,
) -> Response {
    let locale = locale(&query);
    let seen = shared.clone();
    let work = move || store::read(folder(&seen, &name)?, &name);
    let kind = [
        (CONTENT_TYPE, "application/octet-stream"),
        (CACHE_CONTROL, "no-store"),
    ];
    with_files(&shared, locale, work, |bytes| (kind, bytes).into_response()).await
}

/// A file of the studio.
async fn studio(State(shared): State<Arc<Shared>>, path: Option<Path<String>>) -> Response {
    let Some(folder) = shared.settings.studio.clone() else {
        let why = "the studio is not installed here: web/site.sh of the sources builds it, for target/web/site there or \
                   for share/trik/studio of where this program is installed";
        return text(StatusCode::NOT_FOUND, why);
    };
    let path = path.map_or_else(String::new, |Path(path)| path);
    let work = move || Ok(drawing::given(&folder, &path));
    with_files(&shared, Locale::English, work, |answer| answer).await
}

async fn configured(
    State(shared): State<Arc<Shared>>,
    Query(query): Query<HashMap<String, String>>,
) -> Response {
    let locale = locale(&query);
    let seen = shared.clone();
    let work = move || configuration::read(&seen.settings.tree);
    with_files(&shared, locale, work, json).await
}

async fn converters(State(shared): State<Arc<Shared>>) -> Response {
    // It says nothing in words.
    let locale = Locale::English;
    let seen = shared.clone();
    let work = move || Ok(inside::list(&seen.settings.tree));
    with_files(&shared, locale, work, json).await
}

async fn diagram(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Query(query): Query<HashMap<String, String>>,
) -> Response {
    let locale = locale(&query);
    let seen = shared.clone();
    let work = move || diagrams::sheets(folder(&seen, &name)?, &name, locale);
    with_files(&shared, locale, work, json).await
}

/// A diagram with another value in one of its blocks; nothing is written.
async fn changed(
    State(shared): State<Arc<Shared>>,
    Path(name): Path<String>,
    Query(mut query): Query<HashMap<String, String>>,
) -> Response {
    let locale = locale(&query);
    let seen = shared.clone();
    let work = move || {
        let mut take = |key: &str| query.remove(key).unwrap_or_default();
        let change = Change {
            block: take("block"),
            property: take("property"),
            value: take("value"),
        };
        diagrams::changed(folder(&seen, &name)?, &name, &change, locale)
    };
    let kind = [
        (CONTENT_TYPE, "application/octet-stream"),
        (CACHE_CONTROL, "no-store"),
    ];
    with_files(&shared, locale, work, |bytes| (kind, bytes).into_response()).await
}

/// The folder of programs; without one there is no program of this name.
fn folder<'a>(shared: &'a Shared, name: &str) -> Result<&'a std::path::Path, Error> {
    let folder = shared.settings.programs.as_deref();
    folder.ok_or_else(|| Error::Name(name.to_owned()))
}

pub fn locale(query: &HashMap<String, String>) -> Locale {
    match query.get("language").map(String::as_str) {
        Some("ru") => Locale::Russian,
        Some(_) | None => Locale::English,
    }
}

async fn table(State(shared): State<Arc<Shared>>) -> Response {
    let locale = Locale::English;
    let seen = shared.clone();
    let work = move || {
        Ok(plain::table(
            &seen.settings.name,
            &seen.settings.tree,
            files::WHY_NOT,
        ))
    };
    let kind = [
        (CONTENT_TYPE, "text/html; charset=utf-8"),
        (CACHE_CONTROL, "no-store"),
    ];
    with_files(&shared, locale, work, |page| (kind, page).into_response()).await
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::sync::oneshot;

    #[test]
    fn what_nobody_waits_for_has_its_turn_until_it_is_done() {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .build()
            .unwrap();
        runtime.block_on(async {
            let large = Arc::new(Semaphore::new(1));
            let (begins, begun) = oneshot::channel();
            let (end, ends) = oneshot::channel::<()>();
            let work = move || {
                begins.send(()).unwrap();
                ends.blocking_recv().unwrap();
            };
            let asked = tokio::spawn(in_turn(large.clone(), work));
            begun.await.unwrap();
            asked.abort();
            assert!(asked.await.unwrap_err().is_cancelled());
            assert_eq!(large.available_permits(), 0);
            end.send(()).unwrap();
            drop(large.acquire().await.unwrap());
            assert_eq!(in_turn(large, || 7).await.unwrap(), 7);
        });
    }
}
