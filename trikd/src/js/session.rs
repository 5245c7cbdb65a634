//! The process of one program: its threads, and the way outside.
//!
//! The thread that calls [`run`] has no engine: it brings in what comes from outside and carries questions out, so
//! that engines may loop as they like.

use super::debug::Orders;
use super::files::read_text;
use super::machine::{Job, Kind};
use super::outside::{Output, Outside};
use super::shared::{Event, MAIN, Shared};
use crate::brick::Brick;
use crate::engine::{Failure, Outcome, Start};
use crate::host::Incoming;
use crate::limits;
use crate::protocol::program::ALL;
use lang_text::javascript::with_call_of_main;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Runs a program from its beginning to the end of its last thread.
///
/// # Errors
/// The first failure.
pub fn run(start: Start, root: &Path, outside: &dyn Outside, output: Box<dyn Output>) -> Outcome {
    let here = || std::env::current_dir().unwrap_or_else(|_| PathBuf::from("/"));
    let is_debugged = matches!(start, Start::Debugged(_));
    let (folder, text, kind) = match start {
        Start::File(path) | Start::Debugged(path) => {
            let folder = path.parent().map_or_else(here, Path::to_owned);
            (
                folder,
                read_text(&path).map_err(Failure::Unread)?,
                Kind::Program,
            )
        }
        Start::Script(text) => (here(), text, Kind::Program),
        Start::Direct => (here(), String::new(), Kind::Direct),
    };
    let shared = Shared::new(root.to_owned(), folder, output)
        .map_err(|error| Failure::Start(error.into()))?;
    let shared = Arc::new(shared);
    if is_debugged {
        shared.debugger.begin();
    }
    let job = Job {
        name: MAIN.to_owned(),
        text: with_call_of_main(text).into(),
        kind,
    };
    shared.start(job).map_err(Failure::Thread)?;
    let served = serve(&shared, outside);
    shared.quit(None);
    wait_for_threads(&shared);
    if let Err(error) = served {
        return Err(Failure::Deaf(error.into()));
    }
    shared.failure().map_or(Ok(()), Err)
}

/// Until all threads have ended, or the program must.
fn serve(shared: &Shared, outside: &dyn Outside) -> io::Result<()> {
    let mut orders = Orders::new(Brick::new(&shared.root));
    while shared.runs(None) && !shared.quits() {
        while let Some(message) = outside.receive()? {
            match message {
                Incoming::Direct(text) => shared.deliver(Some(MAIN), &Event::Direct(text)),
                Incoming::Mail(hull, text) => shared.post(hull, text),
                Incoming::Web => shared.deliver(Some(MAIN), &Event::Web),
                Incoming::Debug {
                    client,
                    tag,
                    locale,
                    order,
                } => {
                    let answer = orders.order(&shared.debugger, (tag, &order), locale);
                    shared.say(|output| output.debug(client, &answer));
                }
                Incoming::DebugLeft => orders.left(&shared.debugger),
                // A program in a language of text has no blocks, and the daemon patches diagrams only.
                Incoming::Watch(_)
                | Incoming::Patch(..)
                | Incoming::Set(..)
                | Incoming::Reply(..) => {}
                Incoming::Gone => return Ok(()),
            }
        }
        if let Some((words, answer)) = shared.question() {
            // An engine that was ended meanwhile wants no answer.
            let _ = answer.send(shared.quietly(|| outside.mailbox(&words)));
            continue;
        }
        let (news, soon) = orders.news(&shared.debugger);
        if let Some(text) = orders.warning() {
            shared.say(|output| output.info(&text));
        }
        if let Some(state) = news {
            shared.say(|output| output.debug(ALL, &state));
        }
        let mut awaited = vec![PollFd::new(shared.bell.fd(), PollFlags::POLLIN)];
        awaited.extend(outside.fd().map(|fd| PollFd::new(fd, PollFlags::POLLIN)));
        let soon = soon.and_then(|soon| PollTimeout::try_from(soon).ok());
        match poll(&mut awaited, soon.unwrap_or(PollTimeout::NONE)) {
            Ok(_) | Err(nix::errno::Errno::EINTR) => {}
            Err(error) => return Err(error.into()),
        }
        shared.bell.hush();
    }
    Ok(())
}

/// Who sits in a call of the system that does not return ends with the process.
fn wait_for_threads(shared: &Shared) {
    let end = Instant::now() + Duration::from_millis(limits::JS_END_MS);
    while shared.runs(None) && Instant::now() < end {
        let left = end.saturating_duration_since(Instant::now());
        let left = u16::try_from(left.as_millis()).unwrap_or(0);
        let mut awaited = [PollFd::new(shared.bell.fd(), PollFlags::POLLIN)];
        let _ = poll(&mut awaited, left);
        shared.bell.hush();
        // Questions that nobody answers any more.
        while shared.question().is_some() {}
    }
}
