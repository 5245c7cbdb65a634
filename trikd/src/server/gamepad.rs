//! Port 4444: gamepads. Their lines go into the pipe that the tree reads.
//!
//! Owns the clocks of each gamepad: a button that nobody releases is released, and what a gamepad held is let go of
//! when it leaves or falls silent. Every line winds the clock, and any number of gamepads may be there.

use super::Guest;
use crate::access::Access;
use crate::clients::{Client, Clients};
use crate::outbox::Outbox;
use crate::protocol::gamepad::{Line, Lines};
use crate::{limits, log};
use std::cell::RefCell;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::AsyncReadExt;
use tokio::time::{Instant, sleep_until};

/// The pipe to the tree.
#[derive(Debug)]
pub struct Pipe {
    path: PathBuf,
    file: RefCell<Option<File>>,
}

impl Pipe {
    /// The pipe at `path`; it is made if nothing is there, and opened when there is something to write.
    pub fn new(path: &Path) -> Self {
        if !path.exists() {
            // Its directory may be missing as well: then there is nobody to read it.
            let _ = nix::unistd::mkfifo(path, nix::sys::stat::Mode::from_bits_truncate(0o600));
        }
        Self {
            path: path.to_owned(),
            file: RefCell::default(),
        }
    }

    /// Writes a line. Without a reader, or with one that hangs, the line is lost: a gamepad is of use at once or never.
    ///
    /// # Errors
    /// Those of the pipe.
    pub fn line(&self, text: &str) -> io::Result<()> {
        let mut file = self.file.borrow_mut();
        let open = match &mut *file {
            Some(open) => open,
            none => none.insert(
                OpenOptions::new()
                    .write(true)
                    .custom_flags(libc::O_NONBLOCK)
                    .open(&self.path)?,
            ),
        };
        let done = open.write_all(format!("{text}\n").as_bytes());
        if done
            .as_ref()
            .is_err_and(|error| error.kind() != io::ErrorKind::WouldBlock)
        {
            *file = None;
        }
        done
    }
}

/// What this port works with.
#[derive(Debug)]
pub struct Gamepads {
    /// Who is paired.
    pub access: Arc<Access>,
    /// The register of connections.
    pub clients: Rc<Clients>,
    /// Where the lines go.
    pub pipe: Pipe,
}

/// What one gamepad does and holds.
struct Gamepad {
    gamepads: Rc<Gamepads>,
    client: Rc<Client>,
    /// When each button is released.
    buttons: [Option<Instant>; 5],
    pads: [bool; 2],
    /// How long it may be silent, and since when it is.
    patience: Option<Duration>,
    heard: Instant,
    complained: bool,
    /// Lines in this second, and when it began.
    window: (Instant, u32),
}

impl Gamepad {
    fn pass(&mut self, text: &str) {
        if let Err(error) = self.gamepads.pipe.line(text)
            && !self.complained
        {
            self.complained = true;
            let path = self.gamepads.pipe.path.display();
            let hint = if error.raw_os_error() == Some(libc::ENXIO) {
                ": nobody reads it; is the tree mounted?"
            } else {
                ""
            };
            tracing::warn!(target: log::CLIENTS, "gamepad: {path}: {error}{hint}");
        }
    }

    fn is_flood(&mut self) -> bool {
        let now = Instant::now();
        if now - self.window.0 > Duration::from_secs(1) {
            self.window = (now, 0);
        }
        self.window.1 = self.window.1.saturating_add(1);
        self.window.1 > limits::GAMEPAD_LINES_PER_SECOND
    }

    /// Does what a line asks for; whether it is one that gamepads send.
    fn line(&mut self, line: &[u8]) -> bool {
        self.client.count();
        self.heard = Instant::now();
        let line = Line::parse(line);
        let is_known = !matches!(line, Line::Nonsense(_));
        // What lets go passes in any case.
        let lets_go = matches!(&line, Line::Command(text) if text.ends_with("up"));
        if self.is_flood() && !lets_go {
            return is_known;
        }
        match line {
            Line::Keepalive(wait_ms) => {
                let wait = Duration::from_millis(u64::from(wait_ms));
                self.patience = (wait_ms > 0).then_some(wait);
            }
            Line::Command(text) => {
                self.note(&text);
                self.pass(&text);
            }
            Line::Nonsense(why) => {
                if !std::mem::replace(&mut self.complained, true) {
                    tracing::warn!(target: log::CLIENTS, "gamepad: {}: {why}", self.client.peer);
                }
            }
        }
        is_known
    }

    /// Remembers what is held.
    fn note(&mut self, text: &str) {
        let words: Vec<&str> = text.split(' ').collect();
        let index = words
            .get(1)
            .and_then(|word| word.parse::<usize>().ok())
            .and_then(|number| number.checked_sub(1));
        let is_up = words.get(2) == Some(&"up");
        match (words.first(), index) {
            (Some(&"pad"), Some(index)) if index < 2 => self.pads[index] = !is_up,
            (Some(&"btn"), Some(index)) if index < 5 => {
                let release = Instant::now() + Duration::from_millis(limits::BUTTON_MS);
                self.buttons[index] = (!is_up).then_some(release);
            }
            _ => {}
        }
    }

    /// The next moment at which something has to be done.
    fn next(&self) -> Option<Instant> {
        let silence = self.patience.map(|patience| self.heard + patience);
        self.buttons.iter().flatten().copied().chain(silence).min()
    }

    fn tick(&mut self) {
        let now = Instant::now();
        for index in 0..self.buttons.len() {
            if self.buttons[index].is_some_and(|release| release <= now) {
                self.buttons[index] = None;
                self.pass(&format!("btn {} up", index + 1));
            }
        }
        if self
            .patience
            .is_some_and(|patience| self.heard + patience <= now)
        {
            self.patience = None;
            tracing::warn!(target: log::CLIENTS, "gamepad: {} is silent: it lets go of everything", self.client.peer);
            self.let_go();
        }
    }

    fn let_go(&mut self) {
        for index in 0..self.pads.len() {
            if std::mem::take(&mut self.pads[index]) {
                self.pass(&format!("pad {} up", index + 1));
            }
        }
        for index in 0..self.buttons.len() {
            if self.buttons[index].take().is_some() {
                self.pass(&format!("btn {} up", index + 1));
            }
        }
    }
}

/// Serves one gamepad.
pub async fn serve(gamepads: Rc<Gamepads>, guest: Guest) {
    let Guest {
        mut stream,
        peer,
        mut seat,
        ..
    } = guest;
    let place = seat.place();
    // Driving is control.
    if !gamepads.access.may_control(peer.ip()) {
        tracing::warn!(
            target: log::CLIENTS,
            "gamepad: {peer} is not paired: press Enter on the robot, then connect again"
        );
        return;
    }
    let client = gamepads
        .clients
        .add("gamepad", peer, Rc::new(Outbox::new(0)));
    tracing::info!(target: log::CLIENTS, "gamepad: {peer} has come");
    let now = Instant::now();
    let mut gamepad = Gamepad {
        gamepads: gamepads.clone(),
        client,
        buttons: [None; 5],
        pads: [false; 2],
        patience: None,
        heard: now,
        complained: false,
        window: (now, 0),
    };
    let mut lines = Lines::new(limits::GAMEPAD_LINE_BYTES);
    let mut buffer = [0; 1024];
    loop {
        // A day stands for never.
        let next = gamepad
            .next()
            .unwrap_or_else(|| Instant::now() + Duration::from_secs(86_400));
        tokio::select! {
            read = stream.read(&mut buffer) => match read {
                // A reset is how telephones say goodbye.
                Ok(0) | Err(_) => break,
                Ok(size) => {
                    let mut is_whole = false;
                    lines.feed(&buffer[..size], |line| is_whole |= gamepad.line(line));
                    place.hears(size, is_whole, buffer[size - 1] != b'\n');
                }
            },
            // What it holds is let go of below.
            () = seat.lost() => break,
            () = sleep_until(next) => gamepad.tick(),
        }
    }
    gamepad.let_go();
    tracing::info!(target: log::CLIENTS, "gamepad: {peer} has left");
    drop(seat);
}
