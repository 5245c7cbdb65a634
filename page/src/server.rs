//! The thread that serves the page, and what it is told.
//!
//! Owns the thread and its end. It has a runtime of its own, which does nothing while no browser looks.

use crate::control::Control;
use crate::error::Error;
use crate::limits;
use crate::route;
use crate::world::World;
use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use std::io;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::thread::JoinHandle;
use tokio::net::TcpStream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot, watch};

/// Which computers may do what.
pub trait Guests: Send + Sync {
    /// It may look.
    fn may_look(&self, ip: IpAddr) -> bool;

    /// It may do things. Asked often; a person at the robot may say yes meanwhile.
    fn may_drive(&self, ip: IpAddr) -> bool;
}

/// Every computer may do everything.
#[derive(Clone, Copy, Debug)]
pub struct Everybody;

impl Guests for Everybody {
    fn may_look(&self, _: IpAddr) -> bool {
        true
    }

    fn may_drive(&self, _: IpAddr) -> bool {
        true
    }
}

/// What a page is for.
pub struct Settings {
    /// Where it is served; with port 0 at any free one.
    pub address: SocketAddr,
    /// The robot, as a title.
    pub name: String,
    /// Where the tree is mounted.
    pub tree: PathBuf,
    /// The folder of programs, if it is on this machine.
    pub programs: Option<PathBuf>,
    /// What is around the robot, if that is virtual.
    pub world: Option<Arc<dyn World>>,
    /// Which computers may do what.
    pub guests: Arc<dyn Guests>,
}

/// What all requests share.
pub struct Shared {
    pub settings: Settings,
    /// The port where it is really served.
    pub port: u16,
    /// Of this machine.
    pub host_name: String,
    /// The value of the cookie.
    pub token: String,
    /// Where the robot takes programs.
    pub robot: watch::Sender<Option<SocketAddr>>,
    pub control: Control,
    pub browsers: Arc<Semaphore>,
    /// Of the newest browser.
    pub number: AtomicUsize,
}

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
            number: AtomicUsize::new(0),
        });
        let (end, ended) = oneshot::channel();
        let work = async move {
            let Ok(listener) = tokio::net::TcpListener::from_std(listener) else {
                return;
            };
            let connections = Arc::new(Semaphore::new(limits::CONNECTIONS_MAX));
            let door = Door {
                listener,
                connections,
            };
            let service = route::router(shared).into_make_service_with_connect_info::<Peer>();
            tokio::select! {
                _ = axum::serve(door, service) => {}
                _ = ended => {}
            }
        };
        let thread = std::thread::Builder::new()
            .name("page".to_owned())
            .spawn(move || {
                runtime.block_on(work);
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

/// The other end of a connection.
#[derive(Clone, Copy, Debug)]
pub struct Peer(pub SocketAddr);

/// Where connections come in; there are never too many of them.
struct Door {
    listener: tokio::net::TcpListener,
    connections: Arc<Semaphore>,
}

impl Listener for Door {
    type Io = Guest;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Guest, SocketAddr) {
        loop {
            // Nobody closes the semaphore.
            let Ok(seat) = self.connections.clone().acquire_owned().await else {
                continue;
            };
            match self.listener.accept().await {
                Ok((stream, address)) => {
                    let _ = stream.set_nodelay(true);
                    return (
                        Guest {
                            stream,
                            _seat: seat,
                        },
                        address,
                    );
                }
                // No more descriptors: somebody has to leave first.
                Err(_) => tokio::time::sleep(limits::RETURN_TIME).await,
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A connection, with its place among all.
struct Guest {
    stream: TcpStream,
    _seat: OwnedSemaphorePermit,
}

impl tokio::io::AsyncRead for Guest {
    fn poll_read(
        mut self: std::pin::Pin<&mut Self>,
        cx: &mut std::task::Context<'_>,
        buf: &mut tokio::io::ReadBuf<'_>,
    ) -> std::task::Poll<io::Result<()>> {
        std::pin::Pin::new(&mut self.stream).poll_read(cx, buf)
    }
}

impl tokio::io::AsyncWrite for Guest {
    fn poll_write(
        mut self: std::pin::Pin<&mut Self>,
        cx: &mut std::task::Context<'_>,
        buf: &[u8],
    ) -> std::task::Poll<io::Result<usize>> {
        std::pin::Pin::new(&mut self.stream).poll_write(cx, buf)
    }

    fn poll_flush(
        mut self: std::pin::Pin<&mut Self>,
        cx: &mut std::task::Context<'_>,
    ) -> std::task::Poll<io::Result<()>> {
        std::pin::Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(
        mut self: std::pin::Pin<&mut Self>,
        cx: &mut std::task::Context<'_>,
    ) -> std::task::Poll<io::Result<()>> {
        std::pin::Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}

impl Connected<IncomingStream<'_, Door>> for Peer {
    fn connect_info(stream: IncomingStream<'_, Door>) -> Self {
        let SocketAddr::V6(six) = *stream.remote_addr() else {
            return Self(*stream.remote_addr());
        };
        // An address of IPv4 on a socket of both kinds.
        Self(SocketAddr::new(six.ip().to_canonical(), six.port()))
    }
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
