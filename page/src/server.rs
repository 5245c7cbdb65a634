//! The thread that serves the page, and what it is told.
//!
//! Owns the thread, its end, and that it begins again after a panic. It has a runtime of its own, which does nothing while no
//! browser looks.

use crate::control::Control;
use crate::door::{Door, Peer, ROOM};
use crate::error::Error;
use crate::limits;
use crate::route;
use crate::seats::Seats;
use crate::shared::{Settings, Shared};
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::thread::JoinHandle;
use tokio::sync::{Semaphore, oneshot, watch};

/// A page that is served. Dropping it ends that.
#[derive(Debug)]
pub struct Page {
    address: SocketAddr,
    robot: watch::Sender<Option<SocketAddr>>,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl Page {
    /// Serves it from now on.
    ///
    /// # Errors
    /// Nobody can listen there, or there are no more threads.
    pub fn start(settings: Settings) -> Result<Self, Error> {
        let wanted = settings.address;
        let at = |error| Error::Address(wanted, error);
        let listener = TcpListener::bind(wanted).map_err(at)?;
        listener.set_nonblocking(true).map_err(at)?;
        let address = listener.local_addr().map_err(at)?;
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .max_blocking_threads(limits::FILE_THREADS)
            .thread_keep_alive(limits::FILE_THREAD_IDLE_TIME)
            .build()
            .map_err(Error::Thread)?;
        let robot = watch::Sender::new(None);
        let shared = Arc::new(Shared {
            settings,
            port: address.port(),
            host_name: host_name(),
            token: token().map_err(Error::Thread)?,
            robot: robot.clone(),
            control: Control::default(),
            browsers: Arc::new(Semaphore::new(limits::BROWSERS_MAX)),
            uploads: Arc::new(Semaphore::new(limits::UPLOADS_BYTES_MAX)),
            large: Arc::new(Semaphore::new(limits::LARGE_MAX)),
            looks: Arc::new(Semaphore::new(limits::LOOKS_MAX)),
            number: AtomicUsize::new(0),
        });
        let (end, mut ended) = oneshot::channel();
        let seats = Seats::new(ROOM);
        let thread = std::thread::Builder::new()
            .name("page".to_owned())
            .spawn(move || {
                // True at the end of the page.
                let mut serves = || {
                    runtime.block_on(async {
                        tokio::select! {
                            _ = serve(&listener, &seats, &shared) => false,
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
            robot,
            end: Some(end),
            thread: Some(thread),
        })
    }

    /// Where it is served.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Where the robot takes programs from now on.
    pub fn robot_is_at(&self, address: SocketAddr) {
        self.robot
            .send_if_modified(|at| at.replace(address) != Some(address));
    }
}

impl Drop for Page {
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
async fn serve(listener: &TcpListener, seats: &Arc<Seats>, shared: &Arc<Shared>) -> io::Result<()> {
    let listener = tokio::net::TcpListener::from_std(listener.try_clone()?)?;
    let door = Door::new(listener, seats.clone(), shared.settings.guests.clone());
    let service = route::router(shared.clone()).into_make_service_with_connect_info::<Peer>();
    axum::serve(door, service).await
}

/// The name of this machine; empty if it has none.
fn host_name() -> String {
    let name = rustix::system::uname();
    name.nodename().to_string_lossy().into_owned()
}

/// A word that nobody can guess.
fn token() -> io::Result<String> {
    let mut bytes = [0; 16];
    io::Read::read_exact(&mut std::fs::File::open("/dev/urandom")?, &mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests;
