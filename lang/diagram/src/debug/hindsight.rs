//! The past of a program, and where somebody stands who looks at it.
//!
//! Owns the way there, within it and back to the present. Knows no machine and no breakpoints but by their traits: it is the
//! same for both languages of blocks.

use super::again::{Again, Begin};
use super::answers::Answers;
use super::history::{History, Position};
use super::past::{self, Back, From, NoBack, Past, Piece, Search};
use super::{Points, Step};

/// The past of a program, if it is kept.
#[derive(Clone, Debug)]
pub struct Hindsight<M: Again> {
    history: Option<History<M>>,
    /// Where somebody stands.
    past: Option<Past<M>>,
    /// A search that goes on.
    search: Option<Search<M>>,
}

impl<M: Again> Default for Hindsight<M> {
    fn default() -> Self {
        Self {
            history: None,
            past: None,
            search: None,
        }
    }
}

/// The program as it is.
#[derive(Debug)]
pub struct Present<'a, M: Again> {
    /// The machine.
    pub machine: &'a M,
    /// How many blocks were entered before the moment at which it is.
    pub at: Position,
    /// Where it is stopped, unless it has ended.
    pub stop: Option<&'a M::Stop>,
}

impl<M: Again> Hindsight<M> {
    /// Keeps the past from now on, in about so many bytes.
    pub fn keep(&mut self, bytes_max: usize) {
        self.history = Some(History::new(bytes_max));
    }

    /// Whether it is kept.
    pub fn is_kept(&self) -> bool {
        self.history.is_some()
    }

    /// When the past begins that is kept, in milliseconds of the program, and how many bytes it takes.
    pub fn kept(&self) -> Option<(u32, usize)> {
        let history = self.history.as_ref()?;
        Some((history.first_ms()?, history.bytes()))
    }

    /// A step begins, or goes on after a stop; what the robot answers in it is to be noted here. Nothing if no past is
    /// kept.
    pub fn begin(&mut self, machine: &M, begin: Begin, next: Position) -> Option<&mut Answers> {
        let history = self.history.as_mut()?;
        Some(history.begin(machine, begin, next))
    }

    /// What was begun has come to an end, or to a stop; before these moments a thread was held alone.
    pub fn end(&mut self, is_done: bool, held: impl IntoIterator<Item = Position>) {
        if let Some(history) = &mut self.history {
            history.end(is_done, held);
        }
    }

    /// A person has changed the program.
    pub fn changed(&mut self) {
        if let Some(history) = &mut self.history {
            history.changed();
        }
    }

    /// The machine that was, and where it stood, if somebody looks at it.
    pub fn shown(&self) -> Option<(&M, &M::Stop)> {
        let past = self.past.as_ref()?;
        Some((&past.machine, &past.stop))
    }

    /// Whether somebody looks at the past.
    pub fn is_past(&self) -> bool {
        self.past.is_some()
    }

    /// Whether a search through the past goes on.
    pub fn is_searching(&self) -> bool {
        self.search.is_some()
    }

    /// Begins to go back; [`Hindsight::search_on`] goes on with it.
    ///
    /// # Errors
    /// [`NoBack`]; then nothing has changed.
    pub fn begin_back(&mut self, how: Back, present: &Present<'_, M>) -> Result<(), NoBack> {
        let history = self.history.as_ref().ok_or(NoBack::NotKept)?;
        let step = match how {
            Back::To(ms) if ms >= present.machine.ms() => return Err(NoBack::NotYet),
            Back::To(ms) => {
                let past = past::at_time(history, ms).ok_or(NoBack::NotKept)?;
                self.search = None;
                self.past = Some(past);
                return Ok(());
            }
            Back::Step(step) => Some(step),
            Back::Continue | Back::Oldest => None,
        };
        let here = self.here(present);
        if past::is_oldest(history, &here) {
            return Err(NoBack::AtOldest);
        }
        if how == Back::Oldest {
            let past = past::oldest(history).ok_or(NoBack::NotKept)?;
            self.search = None;
            self.past = Some(past);
            return Ok(());
        }
        self.search = Some(Search::back(history, here, step));
        Ok(())
    }

    /// Begins to go forth in the past, by a step or to the next breakpoint; [`Hindsight::search_on`] goes on with it.
    pub fn begin_forth(&mut self, step: Option<Step>, present: &Present<'_, M>) {
        if let (Some(history), Some(_)) = (&self.history, &self.past) {
            let here = self.here(present);
            self.search = Some(Search::forth(history, here, present.at, step));
        }
    }

    /// Does a piece of a search through the past, in bounded time; whether there is more to do.
    pub fn search_on(&mut self, points: &Points) -> bool {
        let (Some(history), Some(search)) = (&self.history, &mut self.search) else {
            return false;
        };
        let past = match search.piece(history, points) {
            Piece::More => return true,
            Piece::Found(past) => Some(past),
            Piece::Nothing if search.is_back() => past::oldest(history),
            // What comes next is the present.
            Piece::Nothing => None,
        };
        self.past = past;
        self.search = None;
        false
    }

    /// Ends a search: what is looked at stays where it was begun.
    pub fn give_up_search(&mut self) -> bool {
        self.search.take().is_some()
    }

    /// Leaves the past.
    pub fn to_present(&mut self) {
        self.past = None;
        self.search = None;
    }

    fn here<'a>(&'a self, present: &Present<'a, M>) -> From<'a, M> {
        match &self.past {
            Some(past) => From {
                machine: &past.machine,
                at: past.at,
                thread: M::thread_of(&past.stop),
            },
            None => From {
                machine: present.machine,
                at: present.at,
                thread: present.stop.and_then(M::thread_of),
            },
        }
    }
}
