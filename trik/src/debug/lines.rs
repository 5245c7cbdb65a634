//! Lines that are typed at `trik debug`, or come from a file or a pipe.
//!
//! Owns the thread that reads them. In a terminal a command can be edited, with those before it and with names to complete;
//! an answer to a question of the program is a plain line. While nothing is asked for, the terminal is as it was, so that
//! Ctrl-C is a signal. Knows no commands.

use super::complete::{Known, candidates};
use crate::limits;
use nix::sys::termios::{SetArg, Termios, tcgetattr, tcsetattr};
use rustyline::completion::Completer;
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::MemHistory;
use rustyline::validate::Validator;
use rustyline::{
    Cmd, CompletionType, ConditionalEventHandler, Config, Context, Editor, Event, EventContext,
    EventHandler, ExternalPrinter, Helper, KeyCode, KeyEvent, Modifiers, RepeatCount,
};
use std::io::{self, BufRead, Read, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// What stands before a command.
pub(super) const PROMPT: &str = "(trik) ";

/// What has come.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(super) enum Heard {
    Line(String),
    /// One of this many bytes or more, which is left out.
    TooLong(usize),
    /// Ctrl-C where a command was being typed.
    Interrupt,
}

/// What is asked for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Wanted {
    /// A command.
    Command,
    /// An answer to a question of the program.
    Answer,
}

/// The lines, one after the other.
pub(super) struct Lines {
    heard: Receiver<Heard>,
    /// In a terminal that can do it.
    desk: Option<Desk>,
}

/// A terminal in which commands are edited.
struct Desk {
    wanted: Sender<Wanted>,
    /// What is asked for and has not come.
    open: Option<Wanted>,
    printer: Box<dyn ExternalPrinter + Send>,
    known: Arc<Mutex<Known>>,
    /// How the terminal was.
    settings: Termios,
}

impl Lines {
    /// None, ever.
    pub(super) fn none() -> Self {
        Self {
            heard: sync_channel(0).1,
            desk: None,
        }
    }

    /// Begins to read. Signals that somebody else reads are blocked before: the thread here must not have them.
    pub(super) fn begin(is_interactive: bool) -> Self {
        let edited = is_interactive.then(edited).flatten();
        edited.unwrap_or_else(|| {
            let (sender, heard) = sync_channel(1);
            std::thread::spawn(move || while plain(&sender) {});
            Self { heard, desk: None }
        })
    }

    /// Asks for a line, unless one is asked for already; whether the person is shown the prompt of a command by it. From a
    /// file or a pipe lines come by themselves.
    pub(super) fn ask(&mut self, wanted: Wanted) -> bool {
        let Some(desk) = &mut self.desk else {
            return false;
        };
        match desk.open {
            Some(open) => open == Wanted::Command,
            None => {
                desk.open = desk.wanted.send(wanted).is_ok().then_some(wanted);
                wanted == Wanted::Command
            }
        }
    }

    /// The next line, waited for.
    ///
    /// # Errors
    /// None has come in this time, or none will come any more.
    pub(super) fn next(&mut self, wait: Duration) -> Result<Heard, RecvTimeoutError> {
        let heard = self.heard.recv_timeout(wait)?;
        if let Some(desk) = &mut self.desk {
            desk.open = None;
        }
        Ok(heard)
    }

    /// Names to complete from now on.
    pub(super) fn know(&self, known: impl FnOnce() -> Known) {
        if let Some(desk) = &self.desk {
            *desk.known.lock().unwrap_or_else(PoisonError::into_inner) = known();
        }
    }

    /// Shows lines above a command that is being typed; false: none is.
    pub(super) fn show_above(&mut self, text: &str) -> bool {
        match &mut self.desk {
            Some(desk) if desk.open == Some(Wanted::Command) => {
                // A terminal that is gone shows nothing.
                let _ = desk.printer.print(text.to_owned());
                true
            }
            Some(_) | None => false,
        }
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        if self.open == Some(Wanted::Command) {
            // Somebody ends this process while a command is being typed.
            let _ = tcsetattr(io::stdin(), SetArg::TCSADRAIN, &self.settings);
            let _ = writeln!(io::stdout());
        }
    }
}

/// Lines from a terminal; none: it cannot edit.
fn edited() -> Option<Lines> {
    let settings = tcgetattr(io::stdin()).ok()?;
    let known = Arc::new(Mutex::new(Known::default()));
    let config = Config::builder()
        .completion_type(CompletionType::List)
        .max_history_size(limits::DEBUG_HISTORY_LINES)
        .ok()?
        // Lines that are pasted are lines.
        .bracketed_paste(false)
        .build();
    let history = MemHistory::with_config(&config);
    let mut editor = Editor::with_history(config, history).ok()?;
    editor.set_helper(Some(Names(known.clone())));
    editor.bind_sequence(Event::Any, EventHandler::Conditional(Box::new(Bound)));
    let printer = Box::new(editor.create_external_printer().ok()?);
    let (wanted, asked) = channel();
    let (sender, heard) = sync_channel(1);
    std::thread::spawn(move || {
        for wanted in asked {
            let goes_on = match wanted {
                Wanted::Command => command(&mut editor, &sender),
                Wanted::Answer => plain(&sender),
            };
            if !goes_on {
                return;
            }
        }
    });
    let desk = Desk {
        wanted,
        open: None,
        printer,
        known,
        settings,
    };
    Some(Lines {
        heard,
        desk: Some(desk),
    })
}

/// Reads a command that is edited; whether more can come.
fn command(editor: &mut Editor<Names, MemHistory>, sender: &SyncSender<Heard>) -> bool {
    let heard = match editor.readline(PROMPT) {
        Ok(line) if line.len() < limits::DEBUG_TYPED_BYTES => {
            // What cannot be kept is typed again.
            let _ = editor.add_history_entry(line.as_str());
            Heard::Line(line)
        }
        Ok(_) => Heard::TooLong(limits::DEBUG_TYPED_BYTES),
        Err(ReadlineError::Interrupted) => Heard::Interrupt,
        Err(_) => return false,
    };
    sender.send(heard).is_ok()
}

/// Reads a line as it comes; whether more can come.
fn plain(sender: &SyncSender<Heard>) -> bool {
    let mut input = io::stdin().lock();
    let mut line = Vec::new();
    let limit = limits::DEBUG_LINE_BYTES as u64;
    let read = (&mut input).take(limit).read_until(b'\n', &mut line);
    match read {
        Ok(0) | Err(_) => return false,
        Ok(_) => {}
    }
    if line.len() == limits::DEBUG_LINE_BYTES && !line.ends_with(b"\n") {
        // What is left of it is no line of its own.
        let is_at_end = input.skip_until(b'\n').is_err();
        return sender.send(Heard::TooLong(line.len())).is_ok() && !is_at_end;
    }
    let line = String::from_utf8_lossy(&line);
    let line = line.trim_end_matches(['\n', '\r']).to_owned();
    sender.send(Heard::Line(line)).is_ok()
}

/// Ends a line that is being typed where it is too long: each further letter would draw all of it again.
struct Bound;

impl ConditionalEventHandler for Bound {
    fn handle(
        &self,
        event: &Event,
        _: RepeatCount,
        _: bool,
        context: &EventContext<'_>,
    ) -> Option<Cmd> {
        let letter = |key: &KeyEvent| matches!(key, KeyEvent(KeyCode::Char(_), Modifiers::NONE));
        let is_letter = event.get(0).is_some_and(letter);
        (is_letter && context.line().len() >= limits::DEBUG_TYPED_BYTES).then_some(Cmd::Noop)
    }
}

/// Completes names.
struct Names(Arc<Mutex<Known>>);

impl Completer for Names {
    type Candidate = String;

    fn complete(
        &self,
        line: &str,
        at: usize,
        _: &Context<'_>,
    ) -> rustyline::Result<(usize, Vec<String>)> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(candidates(line.get(..at).unwrap_or(line), &known))
    }
}

impl Hinter for Names {
    type Hint = String;
}

impl Highlighter for Names {}
impl Validator for Names {}
impl Helper for Names {}
