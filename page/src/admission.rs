//! Browsers that are let in to a socket.
//!
//! Owns their places and their numbers: those that only look take no place from one that may do things. Knows nothing of what is
//! said.

use crate::control::Browser;
use crate::gate::text;
use crate::guests::Guests;
use crate::limits;
use axum::extract::WebSocketUpgrade;
use axum::extract::ws::WebSocket;
use axum::http::StatusCode;
use axum::response::Response;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tokio::sync::Semaphore;

/// The places of one server.
pub struct Admission {
    /// Of browsers that only look.
    lookers: Arc<Semaphore>,
    /// Of those that may do things.
    drivers: Arc<Semaphore>,
    /// Of the next browser.
    number: AtomicUsize,
}

impl Default for Admission {
    fn default() -> Self {
        let places = || Arc::new(Semaphore::new(limits::BROWSERS_MAX));
        Self {
            lookers: places(),
            drivers: places(),
            number: AtomicUsize::new(0),
        }
    }
}

impl Admission {
    /// Lets a browser in, which is served until it leaves, or says that there is no place.
    pub fn admit<Served: Future<Output = ()> + Send>(
        &self,
        guests: &dyn Guests,
        address: SocketAddr,
        upgrade: WebSocketUpgrade,
        serve: impl FnOnce(WebSocket, Browser) -> Served + Send + 'static,
    ) -> Response {
        // A computer that may only look sends nothing large.
        let (places, largest) = match guests.may_drive(address.ip()) {
            true => (&self.drivers, limits::MESSAGE_BYTES_MAX),
            false => (&self.lookers, limits::WORDS_BYTES_MAX),
        };
        let Ok(place) = places.clone().try_acquire_owned() else {
            let most = limits::BROWSERS_MAX;
            let why = format!(
                "{most} browsers with the same rights are here already: close some, or wait"
            );
            return text(StatusCode::SERVICE_UNAVAILABLE, why);
        };
        let number = self.number.fetch_add(1, Ordering::Relaxed);
        upgrade
            .max_message_size(largest)
            .max_frame_size(largest)
            .max_write_buffer_size(limits::UNSENT_BYTES_MAX)
            .read_buffer_size(limits::READ_BYTES)
            .on_upgrade(move |socket| async move {
                serve(socket, Browser { number, address }).await;
                drop(place);
            })
    }
}
