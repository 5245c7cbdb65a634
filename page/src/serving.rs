//! The thread that serves something to browsers, whatever that is.
//!
//! Owns the thread, its runtime, its end, and that it begins again after a panic. It does nothing while nobody looks, but what
//! the maker of the routes has begun.

use crate::door::{Door, Peer, ROOM};
use crate::error::Error;
use crate::guests::Guests;
use crate::limits;
use crate::seats::Seats;
use axum::Router;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::JoinHandle;
use tokio::sync::oneshot;

/// Something that is served. Dropping it ends that.
#[derive(Debug)]
pub struct Serving {
    address: SocketAddr,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Serving {
    /// Serves from now on what `router` makes for the port. It is called within the runtime, which has so many threads for what
    /// may have to wait.
    ///
    /// # Errors
    /// Nobody can listen there, or there are no more threads.
    pub fn start(
        wanted: SocketAddr,
        guests: Arc<dyn Guests>,
        threads: usize,
        router: impl FnOnce(u16) -> io::Result<Router>,
    ) -> Result<Self, Error> {
        let at = |error| Error::Address(wanted, error);
        let listener = TcpListener::bind(wanted).map_err(at)?;
        listener.set_nonblocking(true).map_err(at)?;
        let address = listener.local_addr().map_err(at)?;
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .max_blocking_threads(threads)
            .thread_keep_alive(limits::FILE_THREAD_IDLE_TIME)
            .build()
            .map_err(Error::Thread)?;
        let router = {
            let _inside = runtime.enter();
            router(address.port()).map_err(Error::Thread)?
        };
        let (end, mut ended) = oneshot::channel();
        let seats = Seats::new(ROOM);
        let thread = std::thread::Builder::new()
            .name("page".to_owned())
            .spawn(move || {
                // True at the end of the page.
                let mut serves = || {
                    runtime.block_on(async {
                        tokio::select! {
                            _ = serve(&listener, &seats, &guests, router.clone()) => false,
                            _ = &mut ended => true,
                        }
                    })
                };
                // Connections are tasks of the runtime: they go on, and what a browser drives comes to rest when it leaves.
                while !catch_unwind(AssertUnwindSafe(&mut serves)).unwrap_or(false) {
                    runtime.block_on(async { tokio::time::sleep(limits::AGAIN_TIME).await });
                }
                // A write to a device may hang, and the end must not.
                runtime.shutdown_timeout(limits::PING_TIME);
            })
            .map_err(Error::Thread)?;
        Ok(Self {
            address,
            end: Some(end),
            thread: Some(thread),
        })
    }

    /// Where it is served.
    pub fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        if let Some(end) = self.end.take() {
            let _ = end.send(());
        }
        if let Some(thread) = self.thread.take() {
            // It has failed: there is nothing to wait for.
            let _ = thread.join();
        }
    }
}

/// Accepts connections until none can come.
async fn serve(
    listener: &TcpListener,
    seats: &Arc<Seats>,
    guests: &Arc<dyn Guests>,
    router: Router,
) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener.try_clone()?)?;
    let door = Door::new(listener, seats.clone(), guests.clone());
    let service = router.into_make_service_with_connect_info::<Peer>();
    axum::serve(door, service).await
}
