//! Native converters in a process of their own (`isolate = true`): whatever they do costs their own node an error.
//!
//! Owns the life of one node's process: what it has loaded, when another one is started in its place, and which states of open
//! files are in it. `process` is one such process, `stage` a converter opened in it, `words` what is said to it, `memory` the way
//! there; `inner` is what runs in it, held to few system calls by `calls`.
//!
//! All open files of a node share its process and take turns. A process that has died takes the states of all of them along:
//! each begins anew at its next tuple, in another process. The first one is started at once, further ones after growing pauses.

mod calls;
pub mod inner;
mod memory;
mod process;
pub mod room;
mod stage;
mod words;

pub use process::COMMAND;
pub use stage::IsolatedStage;

use super::shared::{INLINE, LibraryError, Wrong, label, shown};
use crate::events::lock;
use crate::failure::Blame;
use crate::limits::{
    ISOLATED_CALM, ISOLATED_CLOSE_PATIENCE, ISOLATED_LOAD_PATIENCE, ISOLATED_NODES_NAMED,
    ISOLATED_PATIENCE, ISOLATED_PAUSE, ISOLATED_PAUSE_MAX,
};
use memory::Shared;
use process::{Lost, Running};
use std::fs::File;
use std::os::fd::AsRawFd;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use words::{Answer, Begun, Closed, Load, Loaded, Request, Sealed};

/// The process of one node's native converters, through the deaths of it.
pub struct Isolated {
    node: String,
    /// How long one tuple may take.
    patience: Duration,
    life: Mutex<Life>,
    /// States whose file was closed while another one was busy.
    left: Mutex<Vec<Place>>,
    /// The node has left the tree: no process is started for it any more.
    is_over: AtomicBool,
}

/// Where the state of an open file is: in which of the processes, and its number there.
type Place = (u32, u32);

struct Life {
    /// What was loaded, with the files open: their names in the cache may go.
    loads: Vec<(Load, Option<File>)>,
    is_sealed: bool,
    /// The kernel held the first one to its list of system calls, so it has to hold all others.
    is_confined: bool,
    running: Option<Running>,
    /// How many were started.
    generation: u32,
    /// Why the last one is gone; then nothing is started until so long after that.
    lost: Option<(Blame, String, Instant)>,
    pause: Duration,
    message: Vec<u8>,
    answer: Vec<u8>,
}

/// One converter of a library that is loaded there; cheap to clone.
#[derive(Clone)]
pub struct Apart {
    process: Arc<Isolated>,
    library: u32,
    label: Arc<str>,
}

impl Isolated {
    /// Nothing is started yet. `budget` is added to the time that each tuple may take.
    pub fn new(node: &str, budget: Duration) -> Arc<Self> {
        Arc::new(Self {
            node: node.to_owned(),
            patience: ISOLATED_PATIENCE + budget,
            life: Mutex::new(Life {
                loads: Vec::new(),
                is_sealed: false,
                is_confined: false,
                running: None,
                generation: 0,
                lost: None,
                pause: Duration::ZERO,
                message: Vec::new(),
                answer: process::room(),
            }),
            left: Mutex::default(),
            is_over: AtomicBool::new(false),
        })
    }

    /// As `Library::load_copy_of`, there.
    ///
    /// # Errors
    /// What is wrong with it, or what has become of the process meanwhile.
    pub fn load_copy_of(
        self: &Arc<Self>,
        path: &Path,
        copy: &Path,
        name: Option<&str>,
    ) -> Result<Apart, LibraryError> {
        let (shown, short) = shown(path);
        self.load(copy, shown, short, name)
    }

    /// Loads what was compiled of inline C, there.
    ///
    /// # Errors
    /// As of [`load_copy_of`](Self::load_copy_of).
    pub fn load_inline(self: &Arc<Self>, compiled: &Path) -> Result<Apart, LibraryError> {
        let inline = INLINE.to_owned();
        self.load(compiled, inline.clone(), inline, None)
    }

    fn load(
        self: &Arc<Self>,
        file: &Path,
        shown: String,
        short: String,
        name: Option<&str>,
    ) -> Result<Apart, LibraryError> {
        let wrong = |why| LibraryError::Library {
            shown: shown.clone(),
            why,
        };
        let load = Load {
            file: file.to_string_lossy().into_owned(),
            shown: shown.clone(),
            short: short.clone(),
            name: name.map(str::to_owned),
        };
        let mut life = lock(&self.life);
        let refused = |refused: Refused| wrong(Wrong::Told(refused.blame, refused.to_string()));
        life.start().map_err(refused)?;
        if let Err(refusal) = life.load(&load) {
            return Err(wrong(match refusal {
                LoadRefusal::Wrong(why) => why,
                LoadRefusal::Lost(lost) => {
                    life.forget(&lost);
                    Wrong::Told(lost.blame(), lost.to_string())
                }
            }));
        }
        let file = File::open(&load.file).ok();
        life.loads.push((load, file));
        Ok(Apart {
            process: Arc::clone(self),
            library: u32::try_from(life.loads.len() - 1).unwrap_or(u32::MAX),
            label: label(&short, name),
        })
    }

    /// Everything is loaded: from here on the process has no right to open files.
    ///
    /// Gives whether the kernel holds it to its few system calls.
    ///
    /// # Errors
    /// What has become of the process.
    pub fn seal(&self) -> Result<bool, LibraryError> {
        let mut life = lock(&self.life);
        life.is_sealed = true;
        let is_confined = life.seal().map_err(|lost| LibraryError::Library {
            shown: "the isolated converter".to_owned(),
            why: Wrong::Told(lost.blame(), lost.to_string()),
        })?;
        life.is_confined = is_confined;
        Ok(is_confined)
    }

    /// Ends the process for good, also if a program still has files of the node open. One that is busy ends when it has answered,
    /// or with the last of these files.
    fn retire(&self) {
        self.is_over.store(true, Ordering::SeqCst);
        if let Ok(mut life) = self.life.try_lock() {
            life.running = None;
        }
    }

    /// The end of a process that was busy when its node left the tree.
    fn end_if_over(&self, life: &mut Life) {
        if self.is_over.load(Ordering::SeqCst) {
            life.running = None;
        }
    }
}

impl Apart {
    /// Whether there is a process at the moment.
    pub fn has_process(&self) -> bool {
        lock(&self.process.life).running.is_some()
    }

    /// The node has left the tree.
    pub fn retire(&self) {
        self.process.retire();
    }
}

impl Isolated {
    /// Closes the states of files that are closed, as many as a short time is enough for.
    fn leave(&self, life: &mut Life) {
        let mut left = std::mem::take(&mut *lock(&self.left));
        let until = Instant::now() + ISOLATED_CLOSE_PATIENCE;
        while let Some((generation, instance)) = left.pop() {
            if generation != life.generation || life.running.is_none() {
                continue;
            }
            match life.ask(&Request::Close { instance }, self.patience, false) {
                Ok(Closed) => {}
                Err(lost) => life.forget(&lost),
            }
            if Instant::now() > until {
                break;
            }
        }
        if !left.is_empty() {
            lock(&self.left).append(&mut left);
        }
    }
}

impl Life {
    /// There is a process with everything loaded, or the pause until there may be another one is not over.
    fn start(&mut self) -> Result<(), Refused> {
        // It has not died of a tuple, so nobody loses one, and the next process is not late.
        if self.running.as_mut().is_some_and(Running::is_gone) {
            self.running = None;
            self.lost = None;
        }
        if self.running.is_some() {
            return Ok(());
        }
        let now = Instant::now();
        if let Some((blame, why, not_before)) = &self.lost
            && now < *not_before
        {
            return Err(Refused {
                blame: *blame,
                why: why.clone(),
                is_pause: true,
            });
        }
        let ready = self.begin().and_then(|()| self.fill());
        ready.map_err(|lost| {
            self.forget(&lost);
            Refused {
                blame: lost.blame(),
                why: lost.to_string(),
                is_pause: false,
            }
        })
    }

    /// A new process, in which nothing of a converter has run: what it dies of is not the converter's fault.
    fn begin(&mut self) -> Result<(), Lost> {
        self.running = Some(Running::start().map_err(Lost::NotStarted)?);
        self.generation = self.generation.wrapping_add(1);
        let begun = self.ask(&Request::Begin, ISOLATED_LOAD_PATIENCE, false);
        let Begun = begun.map_err(|lost| Lost::NotBegun(Box::new(lost)))?;
        Ok(())
    }

    /// Loads into a new process what the one before had.
    fn fill(&mut self) -> Result<(), Lost> {
        let loads = self
            .loads
            .iter()
            .map(|(load, file)| present(load, file.as_ref()));
        for load in loads.collect::<Vec<_>>() {
            self.load(&load).map_err(|refusal| match refusal {
                LoadRefusal::Wrong(why) => Lost::NotLoaded(load.shown.clone(), why.to_string()),
                LoadRefusal::Lost(lost) => lost,
            })?;
        }
        if self.is_sealed && !self.seal()? && self.is_confined {
            return Err(Lost::Unconfined);
        }
        Ok(())
    }

    fn load(&mut self, load: &Load) -> Result<(), LoadRefusal> {
        let request = Request::Load(load.clone());
        match self.ask(&request, ISOLATED_LOAD_PATIENCE, false) {
            Ok(Loaded::Done) => Ok(()),
            Ok(Loaded::Refused { blame, why }) => {
                Err(LoadRefusal::Wrong(Wrong::Told(blame_of(blame), why)))
            }
            Err(lost) => Err(LoadRefusal::Lost(lost)),
        }
    }

    fn seal(&mut self) -> Result<bool, Lost> {
        let Sealed {
            is_confined,
            is_resisted,
        } = self.ask(&Request::Seal, ISOLATED_LOAD_PATIENCE, false)?;
        let running = self.running.as_ref();
        let is_ours = running.is_some_and(Running::has_our_filters);
        if is_resisted || (is_confined && !is_ours) {
            return Err(Lost::Resists);
        }
        Ok(is_confined)
    }

    /// A question and its answer.
    fn ask<'a, A: Answer<'a>>(
        &'a mut self,
        request: &Request<'_>,
        patience: Duration,
        is_batch: bool,
    ) -> Result<A, Lost> {
        let running = self.running.as_mut().ok_or(Lost::Absent)?;
        self.message.clear();
        request.write(&mut self.message);
        let answer = running.ask(&self.message, &mut self.answer, patience, is_batch)?;
        A::read(answer).ok_or(Lost::Rubbish)
    }

    fn take_output(&self, output: &mut [u8]) {
        if let Some(shared) = self.shared() {
            shared.take_output(output);
        }
    }

    fn shared(&self) -> Option<&Shared> {
        self.running.as_ref().map(|running| &running.shared)
    }

    /// The process is gone, or there was none.
    fn forget(&mut self, lost: &Lost) {
        let running = self.running.take();
        let lived = running.map_or(Duration::ZERO, |running| running.since.elapsed());
        if lived > ISOLATED_CALM {
            self.pause = Duration::ZERO;
        }
        self.lost = Some((lost.blame(), lost.to_string(), Instant::now() + self.pause));
        self.pause = (self.pause * 2).clamp(ISOLATED_PAUSE, ISOLATED_PAUSE_MAX);
    }
}

/// The same, by what this process has open if somebody has removed the file from the cache.
fn present(load: &Load, file: Option<&File>) -> Load {
    let mut load = load.clone();
    if let Some(file) = file.filter(|_| !Path::new(&load.file).exists()) {
        load.file = format!("/proc/{}/fd/{}", std::process::id(), file.as_raw_fd());
    }
    load
}

/// Why a library is not loaded there.
enum LoadRefusal {
    Wrong(Wrong),
    Lost(Lost),
}

/// Why there is no process.
struct Refused {
    blame: Blame,
    why: String,
    /// Another one is tried after a pause.
    is_pause: bool,
}

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.why)?;
        // Without a time: each other text would be another line of the log.
        match self.is_pause {
            true => f.write_str("; another one is started soon"),
            false => Ok(()),
        }
    }
}

/// What is to be told of nodes whose converters the kernel holds to no list of system calls; None: there are none.
pub fn unconfined_line(nodes: &[String]) -> Option<String> {
    let (named, more) = nodes.split_at(nodes.len().min(ISOLATED_NODES_NAMED));
    let whose = match (nodes.len(), more.len()) {
        (0, _) => return None,
        (1, _) => format!("node {}", named.concat()),
        (_, 0) => format!("nodes {}", named.join(", ")),
        (_, more) => format!("nodes {} and {more} more", named.join(", ")),
    };
    Some(format!(
        "{whose}: this kernel has no filters of system calls (seccomp): the isolated converter is held by limits of memory and the user's rights alone, so it could open files, start processes and send signals"
    ))
}

/// Blames by their numbers in a message.
const BLAMES: [Blame; 5] = [
    Blame::Person,
    Blame::Configuration,
    Blame::Converter,
    Blame::Machine,
    Blame::Ours,
];

fn blame_number(blame: Blame) -> u8 {
    match blame {
        Blame::Person => 0,
        Blame::Configuration => 1,
        Blame::Converter => 2,
        Blame::Machine => 3,
        Blame::Ours => 4,
    }
}

/// A number that is none comes from a converter.
fn blame_of(number: u8) -> Blame {
    *BLAMES.get(usize::from(number)).unwrap_or(&Blame::Converter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_kernel_lacks_is_told_with_the_first_nodes_by_name() {
        let line = |count: usize| {
            let nodes: Vec<_> = (0..count).map(|number| format!("n{number}")).collect();
            unconfined_line(&nodes)
        };
        assert_eq!(line(0), None);
        let starts = |count, start: &str| line(count).is_some_and(|line| line.starts_with(start));
        assert!(starts(1, "node n0: this kernel has no filters"));
        assert!(starts(2, "nodes n0, n1: this kernel"));
        assert!(starts(8, "nodes n0, n1, n2, n3, n4, n5, n6, n7: this"));
        assert!(starts(
            11,
            "nodes n0, n1, n2, n3, n4, n5, n6, n7 and 3 more: this"
        ));
    }

    #[test]
    fn blames_come_back_as_they_went() {
        for blame in BLAMES {
            assert_eq!(blame_of(blame_number(blame)), blame);
        }
        assert_eq!(blame_of(200), Blame::Converter);
    }
}
