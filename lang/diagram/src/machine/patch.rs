//! A new version of a program takes the place of the one that runs, which goes on where it is.
//!
//! Owns what is kept and what is not. Blocks are the same if the object in the project has the same id and the same type:
//! they keep loops, waits, calls and threads. Variables keep their values and types. Everything is checked before
//! anything changes, and nothing is told to a device.

use std::collections::{BTreeMap, HashMap, HashSet, VecDeque};
use std::fmt;
use std::mem::discriminant;
use std::rc::Rc;

use super::agenda::Work;
use super::formulas::Formulas;
use super::threads::{Handle, State, Thread};
use super::trace::Trace;
use super::{Deferred, Env, Machine, words};
use crate::brick::Brick;
use crate::check::check;
use crate::lower::{Lowered, World, lower};
use crate::program::{Memory, Node, Program};
use crate::project::Project;
use lang_text::problem::{Problem, Severity};

/// What becomes of threads at blocks that the new version does not have.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum WhenGone {
    /// They end, each with an error that names the block.
    #[default]
    End,
    /// The new version is refused.
    Refuse,
}

impl WhenGone {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::End, Self::Refuse];

    /// Its word on command lines and in messages.
    pub fn word(self) -> &'static str {
        match self {
            Self::End => "end",
            Self::Refuse => "refuse",
        }
    }

    /// The one with this word.
    pub fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.word() == word)
    }
}

/// Why a new version is refused. Nothing has changed then.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Refused {
    /// The program has ended.
    Ended,
    /// It has mistakes, each with its diagram, block and property.
    Mistakes(Vec<Problem>),
    /// Threads are at blocks that it does not have.
    Occupied(Vec<Problem>),
}

/// What a new version has changed.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Patched {
    /// Blocks that both versions have.
    pub kept: usize,
    /// Blocks that only the new one has.
    pub added: usize,
    /// Blocks that only the old one had.
    pub gone: usize,
    /// Threads that have ended because their block is gone.
    pub ended: Vec<Problem>,
}

impl fmt::Display for Patched {
    /// For a person, without the threads by name: those were told as errors.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            kept,
            added,
            gone,
            ended,
        } = self;
        write!(f, "{kept} blocks kept, {added} new, {gone} gone")?;
        match ended.len() {
            0 => Ok(()),
            some => write!(f, ", {some} threads ended"),
        }
    }
}

impl Refused {
    /// The problems, of which an ended program has none.
    pub fn problems(&self) -> &[Problem] {
        match self {
            Self::Ended => &[],
            Self::Mistakes(problems) | Self::Occupied(problems) => problems,
        }
    }
}

/// A new version that is good as far as it can be known without the program that runs.
#[derive(Clone, Debug)]
pub struct Version {
    program: Rc<Program>,
}

impl Version {
    /// Checks a project like `trik lint` does.
    ///
    /// # Errors
    /// All mistakes, if there is an error among them.
    pub fn of(project: &Project, world: World) -> Result<Self, Refused> {
        Self::mistakes(project, world)?;
        Self::of_checked(project, world)
    }

    /// The version of a project that [`Version::mistakes`] has found good, which takes a small part of the time.
    ///
    /// # Errors
    /// The project cannot be run at all.
    pub fn of_checked(project: &Project, world: World) -> Result<Self, Refused> {
        let lowered = lower(project, world).map_err(|problem| Refused::Mistakes(vec![problem]))?;
        Ok(Self {
            program: Rc::new(lowered.program),
        })
    }

    /// What is wrong with a project whatever runs; another thread may look for it. The answer are the warnings.
    ///
    /// # Errors
    /// All mistakes, if there is an error among them.
    pub fn mistakes(project: &Project, world: World) -> Result<Vec<Problem>, Refused> {
        let Lowered { program, .. } =
            lower(project, world).map_err(|problem| Refused::Mistakes(vec![problem]))?;
        let (mut errors, mut warnings) = (Vec::new(), Vec::new());
        for problem in check(project, world) {
            match problem.severity {
                Severity::Error => errors.push(problem),
                Severity::Warning => warnings.push(problem),
                Severity::Note => {}
            }
        }
        // In some worlds it is a warning that is not among them.
        let refusal = program.refusal.clone();
        errors.extend(refusal.filter(|refusal| !errors.contains(refusal)));
        match errors.is_empty() {
            true => Ok(warnings),
            false => {
                let errors = errors.into_iter();
                let errors = errors.map(|problem| program.on_sheet(problem));
                Err(Refused::Mistakes(errors.collect()))
            }
        }
    }
}

#[cfg(test)]
impl Version {
    /// A program that nobody has checked.
    pub(crate) fn unchecked(program: Rc<Program>) -> Self {
        Self { program }
    }
}

/// Where the blocks of the old version are in the new one.
struct Moves {
    to: Vec<Option<Node>>,
    kept: usize,
}

impl Moves {
    fn of(old: &Program, new: &Program) -> Self {
        let by_id: HashMap<&str, Node> = (0u32..)
            .zip(new.spots.iter())
            .map(|(node, spot)| (&*spot.id, node))
            .collect();
        let to: Vec<_> = (0u32..)
            .zip(old.spots.iter())
            .map(|(node, spot)| {
                let there = *by_id.get(&*spot.id)?;
                let same_type = match (spot.row, new.row(there)) {
                    (Some(one), Some(other)) => std::ptr::eq(one, other),
                    (None, None) => true,
                    (Some(_), None) | (None, Some(_)) => false,
                };
                let before = old.ops.get(node as usize)?;
                let after = new.ops.get(there as usize)?;
                (same_type && discriminant(before) == discriminant(after)).then_some(there)
            })
            .collect();
        let kept = to.iter().flatten().count();
        Self { to, kept }
    }

    fn get(&self, node: Node) -> Option<Node> {
        self.to.get(node as usize).copied().flatten()
    }

    fn keep_order(&self) -> bool {
        let mut kept = self.to.iter().flatten();
        let mut before = kept.next();
        kept.all(|node| before.replace(node) < Some(node))
    }

    /// The last block up to this one that there still is.
    fn last_until(&self, node: Node) -> Option<Node> {
        let until = self.to.iter().take(node as usize + 1);
        until.rev().flatten().next().copied()
    }

    fn all(&self, nodes: impl IntoIterator<Item = Node>) -> VecDeque<Node> {
        nodes
            .into_iter()
            .filter_map(|node| self.get(node))
            .collect()
    }

    /// The block without which a thread cannot go on: its own, or a call that it is in.
    fn missed_by(&self, thread: &Thread) -> Option<Node> {
        let calls = thread.stack.iter().map(|frame| frame.node);
        let begun = match &thread.state {
            State::Starting(begun) => begun.iter().map(|(_, node)| *node).collect(),
            State::Ready
            | State::Resumed
            | State::Waiting
            | State::Deferred
            | State::Held
            | State::Failed => Vec::new(),
        };
        std::iter::once(thread.node)
            .chain(calls)
            .chain(begun)
            .find(|&node| self.get(node).is_none())
    }
}

impl Machine {
    /// Replaces this version by a new one, between two steps or while the machine is held.
    ///
    /// What an expression or a property says counts when it is next evaluated, a link when it is next followed: a wait that
    /// has begun ends when it would have. With the last thread the program ends, and motors rest.
    ///
    /// # Errors
    /// [`Refused`]; nothing has changed then.
    pub fn patch(
        &mut self,
        version: &Version,
        when_gone: WhenGone,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<Patched, Refused> {
        if self.ended.is_some() {
            return Err(Refused::Ended);
        }
        let old = self.program.clone();
        let new = version.program.clone();
        if old.kit != new.kit {
            return Err(Refused::Mistakes(vec![Problem::error(
                words::kit_of_patch(),
            )]));
        }
        let moves = Moves::of(&old, &new);
        let formulas = self.formulas.patched(&new);
        let mistakes = conflicts(&formulas, &old, &new);
        if !mistakes.is_empty() {
            return Err(Refused::Mistakes(mistakes));
        }
        let lost = self.lost(&old, &moves);
        if when_gone == WhenGone::Refuse && !lost.is_empty() {
            let problems = lost.into_iter().map(|(_, problem)| problem).collect();
            return Err(Refused::Occupied(problems));
        }
        let env = &mut Env { brick, trace };
        let mut ended = Vec::new();
        for (handle, problem) in lost {
            ended.push(problem.clone());
            self.report(problem, env);
            self.end_thread(handle, env);
        }
        self.formulas = formulas;
        self.move_to(&old, new, &moves);
        Ok(Patched {
            kept: moves.kept,
            added: self.program.len() - moves.kept,
            gone: old.len() - moves.kept,
            ended,
        })
    }

    fn lost(&self, old: &Program, moves: &Moves) -> Vec<(Handle, Problem)> {
        let found = self.threads.handles().filter_map(|(handle, thread)| {
            let node = moves.missed_by(thread)?;
            let mut problem = Problem::error(words::block_gone(&thread.name));
            problem.place = old.place(node);
            Some((handle, old.on_sheet(problem)))
        });
        found.collect()
    }

    fn move_to(&mut self, old: &Program, new: Rc<Program>, moves: &Moves) {
        let mut counters = HashMap::new();
        let mut tokens = vec![0; new.joins.len()];
        let mut forks = vec![BTreeMap::new(); new.forks.len()];
        for (node, there) in (0..).zip(&moves.to) {
            let Some(there) = *there else { continue };
            match (old.remembers(node), new.remembers(there)) {
                (Memory::Rounds(before), Memory::Rounds(after)) => {
                    counters.insert(before, after);
                }
                (Memory::Arrivals(before), Memory::Arrivals(after)) => {
                    tokens[after as usize] = self.tokens[before as usize];
                }
                (Memory::Names(before), Memory::Names(after)) => {
                    forks[after as usize] = std::mem::take(&mut self.forks[before as usize])
                        .into_iter()
                        .filter_map(|(name, node)| Some((name, moves.get(node)?)))
                        .collect();
                }
                // Kept blocks have the same operation in both versions.
                (
                    Memory::Nothing | Memory::Rounds(_) | Memory::Arrivals(_) | Memory::Names(_),
                    _,
                ) => {}
            }
        }
        self.loops.patch(&counters, new.loops);
        self.tokens = tokens;
        self.forks = forks;
        let agenda = std::mem::take(&mut self.agenda);
        self.agenda = agenda
            .into_iter()
            .filter_map(|work| self.moved(work, moves, &new))
            .collect();
        self.clocks.retain_mut(|clock| {
            moves
                .get(clock.node)
                .map(|node| clock.node = node)
                .is_some()
        });
        self.clocks.sort_by_key(|clock| clock.node);
        self.posted = moves.all(std::mem::take(&mut self.posted));
        self.deferred.retain_mut(|deferred| match deferred {
            Deferred::Block(node) => moves.get(*node).map(|there| *node = there).is_some(),
            Deferred::Thread(_) | Deferred::Released(_) => true,
        });
        for thread in self.threads.alive_mut() {
            move_thread(thread, moves);
        }
        self.program = new;
    }

    /// A piece of the step with the blocks of the new version; a thread that was about to be led on goes where the new
    /// link leads.
    fn moved(&self, work: Work, moves: &Moves, new: &Program) -> Option<Work> {
        Some(match work {
            // As long as blocks keep their order, new ones fall in.
            Work::Clocks { after, elapsed } if moves.keep_order() => Work::Clocks {
                after: after.and_then(|after| moves.last_until(after)),
                elapsed,
            },
            Work::Clocks { after, elapsed } => {
                let rest = self.clocks.iter().map(|clock| clock.node);
                let rest = rest.filter(|node| after.is_none_or(|after| *node > after));
                Work::Listed {
                    nodes: moves.all(rest),
                    elapsed,
                }
            }
            Work::Listed { nodes, elapsed } => Work::Listed {
                nodes: moves.all(nodes),
                elapsed,
            },
            Work::Follow { blocks } => Work::Follow {
                blocks: moves.all(blocks),
            },
            Work::Followed { blocks, before } => Work::Followed {
                blocks: moves.all(blocks),
                before,
            },
            Work::Lead {
                node,
                next,
                handles,
            } => {
                let node = moves.get(node)?;
                let linked = new.next(node);
                Work::Lead {
                    node,
                    next: linked.or_else(|| moves.get(next))?,
                    handles,
                }
            }
            work @ (Work::Tick { .. }
            | Work::Sensors { .. }
            | Work::Beginning
            | Work::Begun
            | Work::Events
            | Work::Posted
            | Work::Due { .. }
            | Work::Turn { .. }
            | Work::Soon) => work,
        })
    }
}

fn move_thread(thread: &mut Thread, moves: &Moves) {
    if let Some(node) = moves.get(thread.node) {
        thread.node = node;
    }
    thread.from = thread.from.and_then(|node| moves.get(node));
    for frame in &mut thread.stack {
        if let Some(node) = moves.get(frame.node) {
            frame.node = node;
        }
    }
    if let State::Starting(begun) = &mut thread.state {
        begun.retain_mut(|(_, node)| moves.get(*node).map(|there| *node = there).is_some());
    }
}

/// Expressions that the old version did not have and that fight with the types that variables have by now.
fn conflicts(formulas: &Formulas, old: &Program, new: &Program) -> Vec<Problem> {
    let known: HashSet<&str> = old.sources.iter().map(|text| &*text.text).collect();
    let is_new = |source: &u32| {
        let text = new.sources.get(*source as usize);
        text.is_some_and(|text| !known.contains(&*text.text))
    };
    let mut found = Vec::new();
    let places = new.places_of_texts();
    let changed: Vec<u32> = (0..new.sources.len() as u32).filter(is_new).collect();
    for (source, problems) in formulas.mistakes(&changed) {
        let text = &new.sources[source as usize];
        for mut problem in problems {
            let position = problem.place.position;
            if let Some(node) = places.get(&source) {
                problem.place = new.place(*node);
            }
            problem.place.property = Some(text.property.to_owned());
            problem.place.position = position;
            found.push(new.on_sheet(problem));
        }
    }
    found.truncate(lang_text::limits::PROBLEMS);
    found
}
