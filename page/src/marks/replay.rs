//! The page of a run, as the program that judges has written it, as an answer.
//!
//! Owns how much of a file is given, and what its page may do: its script runs in a place of its own (`sandbox`), from where it
//! reaches neither this server nor its cookie.

use crate::gate::text;
use crate::limits;
use axum::http::StatusCode;
use axum::http::header::{CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// What a replay may do: run what is in it, and nothing else.
const POLICY: &str = concat!(
    "sandbox allow-scripts; default-src 'none'; script-src '",
    "unsafe-inline'; style-src '",
    "unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
);

/// The page at a path.
pub async fn answer(path: PathBuf) -> Response {
    match tokio::task::spawn_blocking(move || read(&path)).await {
        Ok(Ok(Some(page))) => {
            let headers = [
                (CONTENT_TYPE, "text/html; charset=utf-8"),
                (CACHE_CONTROL, "no-store"),
                (CONTENT_SECURITY_POLICY, POLICY),
            ];
            // A browser shows no sandboxed page that is kept apart from those that have opened it.
            let apart = [("cross-origin-opener-policy", "unsafe-none")];
            (headers, apart, page).into_response()
        }
        Ok(Ok(None)) => text(
            StatusCode::UNPROCESSABLE_ENTITY,
            "the replay is too large to be shown here: open its file",
        ),
        Ok(Err(_)) => text(StatusCode::NOT_FOUND, "the file of the replay is gone"),
        Err(_) => text(
            StatusCode::INTERNAL_SERVER_ERROR,
            "the replay could not be read",
        ),
    }
}

/// The bytes of a file; None if there are too many.
fn read(path: &Path) -> io::Result<Option<Vec<u8>>> {
    let most = limits::REPLAY_BYTES_MAX;
    let mut page = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut page)?;
    Ok((page.len() as u64 <= most).then_some(page))
}
