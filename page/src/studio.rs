//! The studio, in which diagrams are drawn: the files of a folder that `web/site.sh` has made, with the robot named in its page.
//!
//! Owns where a built studio is found, what of a folder is given, and how. What the studio asks of the robot goes the ways of every
//! page; `trik site` copies the same folder.

use crate::gate::text;
use crate::limits;
use axum::body::{Body, Bytes};
use axum::http::header::{CACHE_CONTROL, CONTENT_ENCODING, CONTENT_LENGTH, CONTENT_TYPE};
use axum::http::{HeaderName, HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use futures_util::stream::unfold;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// The page of a studio.
pub const PAGE: &str = "index.html";
/// The file that names all others, which the browser keeps.
pub const WORKER: &str = "sw.js";
/// After which line of the page a server says something of itself.
pub const HEAD: &str = "<meta charset=\"utf-8\" />";
/// Which robot has given the page: the one at the root of the same address.
const ROBOT: &str = "<meta name=\"trik-robot\" content=\"/\" />";
/// What it may load: its own files, and WebAssembly. Workers have the policy of their own file, so all files have it.
const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; style-src 'self'; \
     img-src 'self' data: blob:; connect-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; \
     frame-ancestors 'none'";

/// The studio that belongs to this program: in share/trik/studio of its installation, or in target/web/site of the sources.
pub fn find() -> Option<PathBuf> {
    let program = std::env::current_exe().and_then(fs::canonicalize).ok()?;
    let above = program.parent()?.parent()?;
    let places = [above.join("share/trik/studio"), above.join("web/site")];
    places.into_iter().find(|folder| is_one(folder))
}

/// Whether a folder has a built studio.
pub fn is_one(folder: &Path) -> bool {
    folder.join(WORKER).is_file() && folder.join(PAGE).is_file()
}

/// A page with a tag in its head.
pub fn with_tag(page: &str, tag: &str) -> String {
    page.replacen(HEAD, &format!("{HEAD}\n    {tag}"), 1)
}

/// A file of the studio in this folder, by its path below it; the folder itself is the page. Files are opened here, so this is no work
/// for a thread that serves.
pub fn given(folder: &Path, path: &str) -> Response {
    let name = if path.is_empty() { PAGE } else { path };
    let is_inside = Path::new(name)
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    let found = if is_inside { open(folder, name) } else { None };
    let Some(found) = found else {
        return text(StatusCode::NOT_FOUND, "the studio has no such file");
    };
    let answer = match (name, found) {
        (
            PAGE,
            Found {
                file,
                is_packed: false,
                ..
            },
        ) => page(file),
        (_, found) => streamed(name, found),
    };
    let mut answer = answer.unwrap_or_else(|error| {
        text(
            StatusCode::INTERNAL_SERVER_ERROR,
            format!("{name} of the studio: {error}"),
        )
    });
    answer.headers_mut().insert(
        HeaderName::from_static("content-security-policy"),
        HeaderValue::from_static(POLICY),
    );
    answer
}

/// A file that is there.
struct Found {
    file: File,
    bytes: u64,
    is_packed: bool,
}

/// In gzip, as `NAME.gz`, if the folder has that: every browser takes it. The page itself is changed, so it is not packed.
fn open(folder: &Path, name: &str) -> Option<Found> {
    let both = [(format!("{name}.gz"), true), (name.to_owned(), false)];
    both.into_iter()
        .filter(|(_, is_packed)| name != PAGE || !is_packed)
        .find_map(|(name, is_packed)| {
            let file = File::open(folder.join(name)).ok()?;
            let facts = file.metadata().ok()?;
            facts.is_file().then(|| Found {
                file,
                bytes: facts.len(),
                is_packed,
            })
        })
}

/// The page, with the robot named in it.
fn page(file: File) -> io::Result<Response> {
    let mut text = String::new();
    file.take(limits::STUDIO_PAGE_BYTES_MAX)
        .read_to_string(&mut text)?;
    let headers = [(CONTENT_TYPE, kind(PAGE)), (CACHE_CONTROL, "no-cache")];
    Ok((headers, with_tag(&text, ROBOT)).into_response())
}

/// A file piece by piece: the module has megabytes, and a browser that reads slowly must not keep them in memory.
fn streamed(name: &str, found: Found) -> io::Result<Response> {
    let Found {
        file,
        bytes,
        is_packed,
    } = found;
    let pieces = unfold(Some(file), |file| async move {
        let piece = tokio::task::spawn_blocking(move || piece(file?)).await;
        match piece {
            Ok(Some(Ok((piece, file)))) => Some((Ok(piece), Some(file))),
            Ok(Some(Err(error))) => Some((Err(error), None)),
            Ok(None) | Err(_) => None,
        }
    });
    let age = if name.starts_with("assets/") {
        "public, max-age=31536000, immutable"
    } else {
        "no-cache"
    };
    let headers = [(CONTENT_TYPE, kind(name)), (CACHE_CONTROL, age)];
    let mut answer = (headers, Body::from_stream(pieces)).into_response();
    answer.headers_mut().insert(CONTENT_LENGTH, bytes.into());
    if is_packed {
        answer
            .headers_mut()
            .insert(CONTENT_ENCODING, HeaderValue::from_static("gzip"));
    }
    Ok(answer)
}

/// The next piece; None at the end.
fn piece(mut file: File) -> Option<io::Result<(Bytes, File)>> {
    let mut piece = vec![0; limits::STUDIO_PIECE_BYTES];
    match file.read(&mut piece) {
        Ok(0) => None,
        Ok(count) => {
            piece.truncate(count);
            Some(Ok((piece.into(), file)))
        }
        Err(error) => Some(Err(error)),
    }
}

/// The type of a file, by its name.
fn kind(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "txt" => "text/plain; charset=utf-8",
        "webmanifest" => "application/manifest+json",
        "json" => "application/json",
        _ => "application/octet-stream",
    }
}
