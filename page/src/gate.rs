//! What all requests to one server pass first: `guard` decides, and each answer has its headers.
//!
//! Owns what a server knows of itself for that: its port, the names of this machine, the cookie, and which paths are what.

use crate::door::Peer;
use crate::guard;
use crate::guests::Guests;
use axum::extract::{ConnectInfo, Request, State};
use axum::http::header::{CONTENT_TYPE, COOKIE, HOST, ORIGIN, SET_COOKIE};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, Uri};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;

/// The gate of one server.
pub struct Gate {
    /// Which computers may do what.
    pub guests: Arc<dyn Guests>,
    /// The port where it is really served.
    port: u16,
    /// Of this machine; empty if it has none.
    host_name: String,
    /// The value of the cookie.
    token: String,
    /// Paths that give the cookie.
    pages: &'static [&'static str],
    /// First parts of paths that need it: what is of a robot, and not of every page.
    data: &'static [&'static str],
}

impl Gate {
    /// With a cookie that nobody can guess.
    ///
    /// # Errors
    /// Those of the system, which gives random bytes.
    pub fn new(
        guests: Arc<dyn Guests>,
        port: u16,
        pages: &'static [&'static str],
        data: &'static [&'static str],
    ) -> io::Result<Self> {
        let name = rustix::system::uname();
        Ok(Self {
            guests,
            port,
            host_name: name.nodename().to_string_lossy().into_owned(),
            token: token()?,
            pages,
            data,
        })
    }

    /// Why a request may not come in; None if it may.
    fn refusal(&self, peer: SocketAddr, uri: &Uri, headers: &HeaderMap) -> Option<&'static str> {
        let header = |name: HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
        let host = header(HOST).unwrap_or_default();
        let first = uri.path().split('/').nth(1).unwrap_or_default();
        let is_data = self.data.contains(&first);
        if !self.guests.may_look(peer.ip()) {
            Some("this computer is not among those that may use the robot")
        } else if !guard::is_ours(host, &self.host_name) {
            Some("open the page by the address of the robot: this name could be anybody's")
        } else if !guard::is_same_origin(header(ORIGIN), host) {
            Some("another page in this browser has asked")
        } else if is_data && !guard::has_cookie(header(COOKIE), &self.token) {
            Some("open the page first: the cookie that it sets is missing")
        } else {
            None
        }
    }
}

/// Lets a request in, or says why not.
pub async fn enter(
    State(gate): State<Arc<Gate>>,
    ConnectInfo(Peer(peer)): ConnectInfo<Peer>,
    request: Request,
    next: Next,
) -> Response {
    let is_page = gate.pages.contains(&request.uri().path());
    let refused = gate.refusal(peer, request.uri(), request.headers());
    let mut answer = match refused {
        Some(why) => text(StatusCode::FORBIDDEN, why),
        None => next.run(request).await,
    };
    let headers = answer.headers_mut();
    for (name, value) in guard::HEADERS {
        // What an answer says of itself counts: the page of a replay has a policy of its own.
        let name = HeaderName::from_static(name);
        headers
            .entry(name)
            .or_insert(HeaderValue::from_static(value));
    }
    if is_page && refused.is_none() {
        let cookie = guard::cookie(&gate.token, gate.port);
        if let Ok(cookie) = HeaderValue::from_str(&cookie) {
            headers.insert(SET_COOKIE, cookie);
        }
    }
    answer
}

/// A sentence as an answer.
pub fn text(status: StatusCode, text: impl Into<String>) -> Response {
    let mut text: String = text.into();
    text.push('\n');
    (status, [(CONTENT_TYPE, "text/plain; charset=utf-8")], text).into_response()
}

/// A word that nobody can guess.
fn token() -> io::Result<String> {
    let mut bytes = [0; 16];
    io::Read::read_exact(&mut std::fs::File::open("/dev/urandom")?, &mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
