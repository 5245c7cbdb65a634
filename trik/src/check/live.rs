//! The page of marks while a class is judged, and after that.
//!
//! Owns where it is served, replays that nobody has named a folder for, and their end: they go with the command, whatever ends
//! it. What the page shows is known to the crate `page`, what a cell is worth to `grades`.

use super::args::CheckArgs;
use super::grades::Grades;
use super::row::Row;
use super::words;
use crate::class::page::settings;
use crate::error::Error;
use crate::limits;
use crate::refusal::{Refusal, say};
use crate::terminal::named;
use crate::up::page::browse;
use crate::up::session::signals;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::signal::{SigSet, Signal, raise};
use nix::sys::signalfd::SignalFd;
use page::marks::MarksPage;
use std::net::{Ipv4Addr, SocketAddr};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use tempfile::TempDir;

/// The port of the page, unless another one is wanted or it is taken. That of a class is 8100.
const PORT: u16 = 8200;

/// What the end of the command needs to know.
#[derive(Debug, Default)]
struct End {
    /// All is judged: a signal ends the page and not the work.
    is_judged: bool,
    /// Replays that go with the command.
    folder: Option<TempDir>,
}

/// A folder for replays, if nobody has named one. Dropping it removes it.
#[derive(Default)]
pub(super) struct Replays(Arc<Mutex<End>>);

impl Replays {
    /// Makes one for what shall be judged with these options, if the page needs it, and names it there.
    ///
    /// # Errors
    /// There is no place for it.
    pub fn settle(args: &mut CheckArgs) -> Result<Self, Refusal> {
        let replays = Self::default();
        if args.marks.is_served && args.html.is_none() {
            let folder = tempfile::Builder::new().prefix("trik-marks-").tempdir();
            let folder = folder.map_err(|error| Error::system("a folder for replays", error))?;
            args.html = Some(folder.path().to_owned());
            end(&replays.0).folder = Some(folder);
        }
        Ok(replays)
    }
}

/// Nothing that holds this lock can fail halfway.
fn end(of: &Mutex<End>) -> MutexGuard<'_, End> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The page that is served.
pub(super) struct Live {
    page: MarksPage,
    grades: Grades,
    /// Runs of each cell that are not judged.
    waiting: Vec<usize>,
    done: usize,
    replays: Arc<Mutex<End>>,
    /// Waits for the person who ends it.
    ending: Option<JoinHandle<()>>,
    link: String,
}

impl Live {
    /// Serves it from now on, and tells where.
    ///
    /// # Errors
    /// There are too many marks for a page, or the address cannot be had.
    pub fn start(args: &CheckArgs, grades: Grades, replays: Replays) -> Result<Self, Refusal> {
        let waiting = grades.runs_of_cells();
        let count = waiting.len().max(waiting.iter().sum());
        if count > limits::MARKS_MAX {
            return Err(Refusal::new(words::too_many_marks(count, args.language)));
        }
        // Threads inherit what is blocked; processes that judge let them in again.
        let signals = signals().map_err(|error| Error::system("signals", error))?;
        let sheet = || grades.sheet(name(args), &waiting);
        let start = |port: u16| {
            let at = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
            MarksPage::start(at, sheet(), args.marks.class.as_ref().map(settings))
        };
        let wanted = args.marks.port;
        let page = match (start(wanted.unwrap_or(PORT)), wanted) {
            // Another class is judged, or another program has it.
            (Err(page::error::Error::Address(..)), None) => start(0),
            (page, _) => page,
        };
        let page = page
            .map_err(|error| Error::Refused(format!("{error}; --page-port names another port")))?;
        let link = format!("http://{}{}", page.address(), page.path());
        say(&[words::page_is_served(&link, args.language)]);
        if let Some(complaint) = args.marks.opens.then(|| browse(&link)).flatten() {
            say(&[complaint]);
        }
        let told = replays.0.clone();
        let ending = thread::Builder::new()
            .name("ending".to_owned())
            .spawn(move || wait(&signals, &told))
            .map_err(|error| Error::system("threads", error))?;
        Ok(Self {
            page,
            grades,
            waiting,
            done: 0,
            replays: replays.0,
            ending: Some(ending),
            link,
        })
    }

    /// A run is judged.
    pub fn add(&mut self, index: usize, row: &Row, replay: Option<PathBuf>) {
        let Some((pupil, cell)) = self.grades.place(index) else {
            return;
        };
        self.grades.add(index, row, replay);
        let others_change = self.grades.settle();
        if let Some(waiting) = self.waiting.get_mut(cell) {
            *waiting = waiting.saturating_sub(1);
        }
        let rows = match others_change {
            true => 0..self.grades.pupil_count(),
            false => pupil..pupil + 1,
        };
        for pupil in rows {
            let row = self.grades.shown(pupil, &self.waiting);
            self.page.row(pupil, row);
        }
        self.done += 1;
        self.page.done(self.done);
    }

    /// All is judged: the page stays until the person ends it.
    pub fn stay(mut self, args: &CheckArgs) {
        self.page.over();
        say(&[words::page_stays(&self.link, args.language)]);
        end(&self.replays).is_judged = true;
        if let Some(ending) = self.ending.take() {
            // It has failed: then nobody would wait.
            let _ = ending.join();
        }
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        // The thread that waits for the end knows of it too.
        end(&self.replays).folder = None;
    }
}

/// Waits for a signal. One that comes while runs are judged ends the command, as it would without a page.
fn wait(signals: &SignalFd, told: &Mutex<End>) {
    let came = loop {
        if let Ok(Some(came)) = signals.read_signal() {
            break came;
        }
        let mut fds = [PollFd::new(signals.as_fd(), PollFlags::POLLIN)];
        // A signal that interrupts this is read above.
        let _ = poll(&mut fds, PollTimeout::NONE);
    };
    let mut end = end(told);
    if end.is_judged {
        return;
    }
    end.folder = None;
    let came = i32::try_from(came.ssi_signo).ok();
    let signal = came.and_then(|number| Signal::try_from(number).ok());
    let signal = signal.unwrap_or(Signal::SIGTERM);
    let mut own = SigSet::empty();
    own.add(signal);
    let _ = own.thread_unblock();
    let _ = raise(signal);
}

/// What is judged, as a title.
fn name(args: &CheckArgs) -> String {
    match &args.paths[..] {
        [path] => {
            let whole = path.canonicalize();
            let whole = whole.as_deref().unwrap_or(path);
            whole
                .file_name()
                .map_or_else(|| named(path), |name| named(Path::new(name)))
        }
        _ => String::new(),
    }
}
