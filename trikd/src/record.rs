//! The black box of a robot, and what is told of its programs to it and to live streams.
//!
//! Owns when the last minutes are saved and what the log says of it. `recorder` looks at the tree and writes the files; what a
//! client hears is known to `server/telemetry`.

use crate::error::Error;
use crate::limits;
use crate::log;
use crate::program::child::Language;
use crate::scripts;
use crate::settings::Settings;
use journal::standard::Level;
use journal::write::Story;
use recorder::desk::{Desk, Listener};
use recorder::kept::{self, SaveReason};
use std::cell::Cell;
use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tokio::sync::oneshot;

/// What records, with its version.
pub const LIBRARY: &str = concat!("trikd/", env!("CARGO_PKG_VERSION"));

/// Looks at the tree for everything that wants to see it.
pub struct Record {
    desk: Desk,
    /// Somebody has begun to hear who does not know yet where a diagram is.
    has_newcomer: Cell<bool>,
}

impl fmt::Debug for Record {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("Record")
    }
}

impl Record {
    /// Looks at nothing yet, unless a black box is wanted.
    ///
    /// # Errors
    /// The folder of the black box cannot be used, or there can be no more threads.
    pub fn start(settings: &Settings) -> Result<Self, Error> {
        let kept = settings.box_minutes.map(|minutes| kept::Settings {
            directory: settings.box_directory(),
            span: Duration::from_secs(60 * u64::from(minutes)),
            bytes: u64::from(settings.box_mib) << 20,
        });
        let desk = Desk::start(
            recorder::desk::Settings {
                root: settings.tree.clone(),
                library: LIBRARY.to_owned(),
                kept,
                world: settings.world.clone(),
            },
            |saved| tell(&saved),
        );
        let desk = desk.map_err(Error::Recorder)?;
        Ok(Self {
            desk,
            has_newcomer: Cell::new(false),
        })
    }

    /// Whether anybody hears what is told here.
    pub fn is_heard(&self) -> bool {
        self.desk.is_heard()
    }

    /// Something that a program, a diagram or another robot says.
    pub fn line(&self, story: Story, name: &str, text: &str) {
        self.level(story, Level::Info, name, text);
    }

    /// The same, and how bad it is.
    pub fn level(&self, story: Story, level: Level, name: &str, text: &str) {
        if self.is_heard() {
            self.desk.line(story, name, level, text);
        }
    }

    /// A program in this file of the folder of programs starts. One that is too large for a recording is left out, and so is
    /// one that cannot be read, of which its start says more. Programs may write to the folder, and this is read with the
    /// rights of the daemon.
    pub fn program(&self, folder: &Path, path: &Path, language: Language) {
        let (Some(name), Ok(Some(file))) = (path.file_name(), scripts::open(folder, path)) else {
            return;
        };
        let mut bytes = Vec::new();
        let most = limits::RECORDED_PROGRAM_BYTES;
        let read = file.take(most + 1).read_to_end(&mut bytes);
        if read.is_err() || bytes.len() as u64 > most {
            return;
        }
        let name = format!("programs/{}", name.to_string_lossy());
        self.desk.program(&name, media_type(language), &bytes);
    }

    /// Something has happened after which somebody may want to know what was before. Without a black box it is nothing.
    pub fn freeze(&self, why: SaveReason) {
        if self.desk.keeps() {
            self.desk.save(why, Box::new(|saved| tell(&saved)));
        }
    }

    /// Saves the last minutes for a client. Gives the file, or why there is none.
    ///
    /// # Errors
    /// No black box is kept, it has nothing yet, or the disk is full.
    pub async fn save(&self) -> Result<PathBuf, recorder::error::Error> {
        let (tell_client, told) = oneshot::channel();
        self.desk.save(
            SaveReason::Asked,
            Box::new(move |saved| {
                tell(&saved);
                // The client may have gone.
                let _ = tell_client.send(saved);
            }),
        );
        let lost = || Err(recorder::error::Error::Thread("it could not start".into()));
        told.await.unwrap_or_else(|_| lost())
    }

    /// Somebody hears everything from now on.
    pub fn listen(&self, listener: Box<dyn Listener>) {
        self.desk.listen(listener);
        self.has_newcomer.set(true);
    }

    /// Whether somebody has begun to hear since this was asked last.
    pub fn take_newcomer(&self) -> bool {
        self.has_newcomer.take()
    }
}

/// What kind of file a program is.
fn media_type(language: Language) -> &'static str {
    match language {
        Language::JavaScript => "text/javascript",
        Language::Python => "text/x-python",
        Language::Lua => "text/x-lua",
        Language::Diagram | Language::Native => "application/octet-stream",
    }
}

fn tell(saved: &Result<PathBuf, recorder::error::Error>) {
    match saved {
        Ok(path) => {
            tracing::info!(target: log::DAEMON, "the black box is saved: {}", path.display());
        }
        Err(error) => tracing::warn!(target: log::DAEMON, "the black box is not saved: {error}"),
    }
}
