//! `trik dcml lsp`: what editors know of models, over standard input and output.
//!
//! Owns the two threads: one reads and sees what is not wanted any more, one answers. Standard output belongs to the
//! protocol; what a person may want to know goes to standard error.

pub mod answers;
pub mod document;
pub mod inbox;
pub mod message;
pub mod params;
pub mod session;

use crate::limits;
use crate::wire::{self, Frame, Frames};
use inbox::{Inbox, Taken};
use message::{INVALID_REQUEST, Message, Refusal};
use serde_json::Value;
use session::Session;
use std::io::{self, BufRead, BufReader, Write};
use std::sync::Arc;
use std::time::Duration;

/// Serves until the editor says `exit` or is gone.
pub(super) fn serve() -> u8 {
    let inbox = Arc::new(Inbox::default());
    let filled = Arc::clone(&inbox);
    // It ends with the process: nobody can wake it while it reads.
    std::thread::spawn(move || {
        if let Err(error) = fill(BufReader::new(io::stdin()), &filled) {
            log(&format!("standard input: {error}"));
        }
        filled.end();
    });
    let mut out = io::BufWriter::new(io::stdout().lock());
    match answer(&inbox, &mut out, &mut |line| log(line)) {
        Ok(status) => status,
        // Nobody is there to be told.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => 1,
        Err(error) => {
            log(&format!("standard output: {error}"));
            1
        }
    }
}

fn log(line: &str) {
    let _ = writeln!(io::stderr(), "trik dcml lsp: {line}");
}

/// Reads messages until none comes any more.
fn fill(from: impl BufRead, inbox: &Inbox) -> io::Result<()> {
    let mut frames = Frames::of(from);
    while let Some(frame) = frames.next()? {
        put(frame, inbox);
    }
    Ok(())
}

fn put(frame: Frame, inbox: &Inbox) {
    match frame {
        Frame::Body(body) => {
            let message = Message::read(&body);
            let bytes = body.len();
            drop(body);
            inbox.put(message, bytes);
        }
        Frame::Bad(why) => inbox.put(
            Message::Bad(Value::Null, Refusal::new(INVALID_REQUEST, why.to_string())),
            0,
        ),
    }
}

/// Answers messages until the talk is over; gives the exit status.
fn answer(inbox: &Inbox, to: &mut impl Write, log: &mut dyn FnMut(&str)) -> io::Result<u8> {
    let mut session = Session::default();
    loop {
        match inbox.take(Duration::from_millis(limits::LSP_PARENT_MS)) {
            Taken::End => return Ok(session.exit_status()),
            Taken::Nothing if session.parent().is_some_and(is_gone) => {
                log("the editor is gone");
                return Ok(session.exit_status());
            }
            Taken::Nothing => {}
            Taken::Message(message, is_cancelled) => {
                if step(&mut session, message, is_cancelled, inbox, to, log)? {
                    return Ok(session.exit_status());
                }
            }
        }
    }
}

/// One message; true if it was the last one.
fn step(
    session: &mut Session,
    message: Message,
    is_cancelled: bool,
    inbox: &Inbox,
    to: &mut impl Write,
    log: &mut dyn FnMut(&str),
) -> io::Result<bool> {
    let will_change = |uri: &str| inbox.will_change(uri);
    let (mut out, mut lines) = (Vec::new(), Vec::new());
    let is_over = session.receive(message, is_cancelled, &will_change, &mut out, &mut lines);
    if !is_over {
        session.settle(&will_change, &mut out);
    }
    for message in &out {
        wire::write(to, message)?;
    }
    for line in lines {
        log(&line);
    }
    Ok(is_over)
}

/// Whether a process has ended.
fn is_gone(process: i32) -> bool {
    let process = nix::unistd::Pid::from_raw(process);
    nix::sys::signal::kill(process, None) == Err(nix::errno::Errno::ESRCH)
}

/// Any bytes as what an editor sends: all of a talk in memory, no thread. The bytes are read up to as many messages as may
/// wait, then answered, and so on.
pub fn fuzz(bytes: &[u8]) {
    let inbox = Inbox::default();
    let mut frames = Frames::of(bytes);
    let mut session = Session::default();
    let mut sent = Vec::new();
    loop {
        let mut has_more = true;
        for _ in 0..limits::LSP_WAITING / 2 {
            match frames.next() {
                Ok(Some(frame)) => put(frame, &inbox),
                _ => {
                    has_more = false;
                    break;
                }
            }
        }
        while let Taken::Message(message, is_cancelled) = inbox.take(Duration::ZERO) {
            sent.clear();
            let is_over = step(
                &mut session,
                message,
                is_cancelled,
                &inbox,
                &mut sent,
                &mut |_| {},
            );
            let mut answers = Frames::of(sent.as_slice());
            while let Ok(Some(frame)) = answers.next() {
                let is_message = |body: &[u8]| {
                    serde_json::from_slice::<Value>(body).is_ok_and(|one| one.is_object())
                };
                assert!(matches!(frame, Frame::Body(body) if is_message(&body)));
            }
            if is_over.unwrap_or(true) {
                return;
            }
        }
        if !has_more {
            return;
        }
    }
}
