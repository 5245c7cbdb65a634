//! A tree for Foxglove, Lichtblick, PlotJuggler and other programs that speak Foxglove's protocol over WebSocket.
//!
//! Owns the threads: one that lets clients in, one for each of them, and one that looks for changes of parameters while
//! anybody wants to hear of them. `protocol` has the bytes, `hub` what is told, `client` one connection, `robot` what clients
//! may change. The SDK of Foxglove is not used: it takes any number of clients, and does not speak the protocol's former name,
//! under which some of these tools ask.

pub mod client;
pub mod hub;
pub mod protocol;
pub mod robot;

use crate::error::Error;
use crate::limits::{BEAT_TIME, CLIENTS_MAX, PARAMETERS_TIME};
use client::{House, Served};
use hub::Hub;
use recorder::clock::now_ns;
use recorder::entry::Entry;
use recorder::live::Live;
use robot::{Robot, SERVICES};
use std::io::Write;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// What one is told for whom there is no room.
const FULL: &[u8] =
    b"HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Length: 5\r\n\r\nbusy\n";

/// A server with what it serves.
pub struct Server {
    hub: Arc<Hub>,
    live: Live,
    program: String,
    address: SocketAddr,
    beat_at: Instant,
}

/// What a thread does.
type Work = Box<dyn FnOnce() + Send>;

/// Serves until the process ends; `program` is what serves, with its version.
///
/// # Errors
/// Nobody can listen there.
pub fn serve(
    address: SocketAddr,
    house: House,
    robot: Robot,
    program: &str,
) -> Result<Server, Error> {
    let refused = |why: std::io::Error| Error::Address(address, why.to_string());
    let listener = TcpListener::bind(address).map_err(refused)?;
    let address = listener.local_addr().map_err(refused)?;
    let hub = Arc::new(Hub::default());
    hub.offer(&SERVICES.map(|(name, _)| name));
    let served = Served {
        house: Arc::new(house),
        hub: hub.clone(),
        robot: Arc::new(robot),
    };
    // Threads do not end: they begin when nothing else can fail.
    let live = begun(program)?;
    let looking = served.clone();
    let threads: [(&str, Work); 2] = [
        ("parameters", Box::new(move || look(&looking))),
        ("foxglove", Box::new(move || accept(&listener, &served))),
    ];
    for (name, work) in threads {
        let thread = thread::Builder::new().name(name.to_owned()).spawn(work);
        thread.map_err(|why| Error::Thread(why.to_string()))?;
    }
    Ok(Server {
        hub,
        live,
        program: program.to_owned(),
        address,
        beat_at: Instant::now(),
    })
}

fn begun(program: &str) -> Result<Live, Error> {
    Live::begin(program).map_err(Error::Message)
}

impl Server {
    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Takes what came in one look at the tree. Clients are told if something of it cannot be passed on.
    pub fn take(&mut self, entries: &[Entry]) {
        let (records, failure) = self.live.take(entries);
        self.hub.take_faults(entries);
        self.hub.take(records);
        if let Some(why) = failure {
            self.hub.failed(&Error::Message(why).to_string());
        }
        let now = Instant::now();
        if now >= self.beat_at {
            self.beat_at = now + BEAT_TIME;
            self.hub.beat(now_ns());
        }
    }

    /// The tree is gone.
    ///
    /// # Errors
    /// None is seen.
    pub fn gone(&mut self) -> Result<(), Error> {
        self.hub.gone();
        // What comes next is another tree.
        self.live = begun(&self.program)?;
        Ok(())
    }

    /// It, or another one, is there again.
    pub fn back(&self) {
        self.hub.back();
    }
}

fn accept(listener: &TcpListener, served: &Served) {
    let count = Arc::new(AtomicUsize::new(0));
    loop {
        let Ok((client, _)) = listener.accept() else {
            // No more descriptors: others must end first.
            thread::sleep(Duration::from_millis(50));
            continue;
        };
        let place = Place(count.clone());
        if count.fetch_add(1, Ordering::AcqRel) >= CLIENTS_MAX {
            refuse(client);
            continue;
        }
        let served = served.clone();
        let work = move || {
            let _place = place;
            let Served { house, hub, robot } = &served;
            // However a client has gone, nobody else has to know.
            let _ = client::serve(client, house, hub, robot);
        };
        // Without a thread the connection is closed.
        let _ = thread::Builder::new().name("client".to_owned()).spawn(work);
    }
}

/// Says that there is no room. It fits into an empty buffer; one who does not take it has lost nothing.
fn refuse(mut client: TcpStream) {
    let _ = client.set_nonblocking(true);
    let _ = client.write(FULL);
}

/// A place of a client, free again when it is dropped.
struct Place(Arc<AtomicUsize>);

impl Drop for Place {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Looks for changes of parameters while anybody wants to hear of them.
fn look(served: &Served) {
    loop {
        thread::sleep(PARAMETERS_TIME);
        match served.hub.has_watchers() {
            true => served.hub.parameters(&served.robot.parameters()),
            false => served.robot.rest(),
        }
    }
}

#[cfg(test)]
mod tests;
