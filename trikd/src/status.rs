//! What `trikd status` shows and `trikd pair` asks for, over a socket in the file system.
//!
//! Owns that socket: a user who may open it may look and pair.

use crate::access::Access;
use crate::blame::Os;
use crate::clients::Clients;
use crate::panics::Panics;
use crate::program::Programs;
use crate::program::child::Owner;
use crate::server::mailbox::Mailbox;
use crate::{limits, log};
use page::seats::Seats;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::io::{self, Read, Write};
use std::net::IpAddr;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{UnixListener, UnixStream};
use tokio::time::{MissedTickBehavior, interval, timeout};

const NAME: &str = "status.sock";
/// The question for a pairing code.
pub const CODE: &str = "code";

/// The socket in a directory.
#[derive(Debug)]
pub struct Socket {
    run: PathBuf,
    listener: RefCell<Rc<UnixListener>>,
    /// Somebody has been told why there is none.
    is_told: Cell<bool>,
}

impl Socket {
    /// What an earlier trikd left is replaced.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn make(run: &Path) -> io::Result<Self> {
        Ok(Self {
            run: run.to_owned(),
            listener: RefCell::new(Rc::new(listen(run)?)),
            is_told: Cell::default(),
        })
    }

    /// Makes it again if somebody has removed it, as cleaners of temporary files do. One of another trikd stays.
    fn restore(&self) {
        let found = self.run.join(NAME).symlink_metadata();
        let gone = [io::ErrorKind::NotFound, io::ErrorKind::NotADirectory];
        if !found.is_err_and(|error| gone.contains(&error.kind())) {
            return;
        }
        match std::fs::create_dir_all(&self.run).and_then(|()| listen(&self.run)) {
            Ok(listener) => {
                *self.listener.borrow_mut() = Rc::new(listener);
                self.is_told.set(false);
            }
            Err(error) if !self.is_told.replace(true) => tracing::warn!(
                target: log::DAEMON,
                "{}: `trikd status` has no answer, since this was removed: {error}",
                self.run.join(NAME).display()
            ),
            // The next look tries again.
            Err(_) => {}
        }
    }
}

fn listen(run: &Path) -> io::Result<UnixListener> {
    let path = run.join(NAME);
    let _ = std::fs::remove_file(&path);
    let listener = UnixListener::bind(&path)?;
    if let Err(error) = std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o600)) {
        // One that is there is not made again.
        let _ = std::fs::remove_file(&path);
        return Err(error);
    }
    Ok(listener)
}

/// What is shown, and who pairs.
#[derive(Debug)]
pub struct Status {
    /// Since when trikd serves.
    pub started: Instant,
    /// Names and numbers of all ports.
    pub ports: String,
    /// Where the tree is mounted.
    pub tree: PathBuf,
    /// Who may do what.
    pub access: Arc<Access>,
    /// Whose rights programs have; None: those of trikd.
    pub owner: Option<Owner>,
    /// Memory of one program.
    pub memory_mib: u64,
    /// Processes of one program.
    pub processes: u64,
    /// The part that runs programs.
    pub programs: Rc<Programs>,
    /// Messages between robots.
    pub mailbox: Rc<Mailbox>,
    /// Connections on all ports.
    pub seats: Arc<Seats>,
    /// Mistakes of trikd itself.
    pub panics: Arc<Panics>,
    /// Who is connected.
    pub clients: Rc<Clients>,
}

impl Status {
    /// What `trikd status` shows.
    pub fn describe(&self) -> String {
        let state = if self.tree.join("stop").exists() {
            "mounted"
        } else {
            "NOT MOUNTED"
        };
        let user = self
            .owner
            .as_ref()
            .map_or("the user of trikd", |owner| owner.user.name.as_str());
        format!(
            "trikd {} for {} s\nports {}\ntree {} {state}\naccess {}\nprograms run as {user}, with {} MiB and {} processes\n{}{}{}{}{}",
            env!("CARGO_PKG_VERSION"),
            self.started.elapsed().as_secs(),
            self.ports,
            self.tree.display(),
            self.access.describe(),
            self.memory_mib,
            self.processes,
            self.programs.describe(),
            self.mailbox.describe(),
            self.seats.describe(),
            self.panics.describe(),
            self.clients.describe()
        )
    }
}

/// Answers for ever.
pub async fn serve(status: Rc<Status>, socket: Rc<Socket>) {
    let mut looks = interval(Duration::from_millis(limits::SOCKET_LOOK_MS));
    looks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        let listener = socket.listener.borrow().clone();
        let came = tokio::select! {
            came = listener.accept() => came,
            _ = looks.tick() => {
                socket.restore();
                continue;
            }
        };
        match came {
            Ok((stream, _)) => {
                let wait = Duration::from_millis(limits::FAREWELL_MS);
                let _ = timeout(wait, answer(&status, stream)).await;
            }
            Err(_) => tokio::time::sleep(Duration::from_millis(100)).await,
        }
    }
}

async fn answer(status: &Status, mut stream: UnixStream) -> io::Result<()> {
    let mut words = [0; 256];
    let size = stream.read(&mut words).await?;
    let words = String::from_utf8_lossy(&words[..size]).trim().to_owned();
    let text = match words.strip_prefix("pair ") {
        Some(ip) => match ip.parse::<IpAddr>() {
            Ok(ip) => status.access.pair(ip).map_or_else(
                |error| format!("refused: {error}\n"),
                |()| format!("paired {ip}\n"),
            ),
            Err(_) => format!("refused: '{ip}' is no address\n"),
        },
        None if words == CODE => match status.access.new_code() {
            Ok(code) => format!("{code}\n"),
            Err(error) => format!("refused: {error}\n"),
        },
        None => status.describe(),
    };
    stream.write_all(text.as_bytes()).await
}

/// Why a question has no answer; the caller is to blame.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Unanswered {
    /// The socket of the running trikd.
    Socket(PathBuf, Os),
    /// It refuses, in its words.
    Refused(String),
}

impl fmt::Display for Unanswered {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Socket(path, os) => {
                let hint = match os.kind {
                    io::ErrorKind::NotFound | io::ErrorKind::ConnectionRefused => {
                        ": trikd does not run, or its --run is another directory"
                    }
                    io::ErrorKind::PermissionDenied => ": only the user of trikd may ask",
                    _ => "",
                };
                write!(out, "{}: {os}{hint}", path.display())
            }
            Self::Refused(why) => out.write_str(why),
        }
    }
}

/// Asks the trikd whose directory is `run`.
///
/// # Errors
/// It does not run, or refuses.
pub fn ask(run: &Path, words: &str) -> Result<String, Unanswered> {
    let path = run.join(NAME);
    let fails = |error: io::Error| Unanswered::Socket(path.clone(), error.into());
    let mut stream = std::os::unix::net::UnixStream::connect(&path).map_err(fails)?;
    stream
        .set_read_timeout(Some(Duration::from_secs(5)))
        .map_err(fails)?;
    stream
        .write_all(format!("{words}\n").as_bytes())
        .map_err(fails)?;
    let mut text = String::new();
    stream.read_to_string(&mut text).map_err(fails)?;
    match text.strip_prefix("refused: ") {
        Some(why) => Err(Unanswered::Refused(why.trim().to_owned())),
        None => Ok(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::MetadataExt;

    #[test]
    fn what_was_removed_is_made_again_and_what_another_trikd_has_put_there_stays() {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .build()
            .unwrap();
        let _inside = runtime.enter();
        let folder = tempfile::tempdir().unwrap();
        let run = folder.path().join("run");
        std::fs::create_dir(&run).unwrap();
        let socket = Socket::make(&run).unwrap();
        let path = run.join(NAME);
        let number = || std::fs::metadata(&path).unwrap().ino();
        std::fs::remove_file(&path).unwrap();
        let other = std::os::unix::net::UnixListener::bind(&path).unwrap();
        let of_other = number();
        socket.restore();
        assert_eq!(number(), of_other);
        drop(other);
        std::fs::remove_dir_all(&run).unwrap();
        socket.restore();
        let mine = number();
        socket.restore();
        assert_eq!(number(), mine);
        assert!(std::os::unix::net::UnixStream::connect(&path).is_ok());
    }
}
