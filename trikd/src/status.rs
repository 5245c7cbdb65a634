//! What `trikd status` shows and `trikd pair` asks for, over a socket in the file system.
//!
//! Owns that socket: a user who may open it may look and pair.

use crate::access::Access;
use crate::blame::Os;
use crate::clients::Clients;
use crate::limits;
use crate::panics::Panics;
use crate::program::Programs;
use crate::program::child::Owner;
use crate::server::mailbox::Mailbox;
use page::seats::Seats;
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
use tokio::time::timeout;

const NAME: &str = "status.sock";

/// The socket in the directory `run`; what an earlier trikd left is replaced.
///
/// # Errors
/// Those of the file system.
pub fn listen(run: &Path) -> io::Result<UnixListener> {
    let path = run.join(NAME);
    let _ = std::fs::remove_file(&path);
    let listener = UnixListener::bind(&path)?;
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o600))?;
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
pub async fn serve(status: Rc<Status>, listener: Rc<UnixListener>) {
    loop {
        match listener.accept().await {
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
