//! A data-flow program that runs: tokens on their way, queues, timers and polls over a [`Brick`].
//!
//! Owns everything that changes while a program runs, and the order of events: an instant is all causes that are due at
//! one time (timers by the time at which they are due, then readings of sensors in the order of blocks, then messages),
//! run until no token is on its way; what it told motors is done once at its end. Knows no robot and no clock: the caller
//! gives both. The same program with the same readings does the same.

mod act;
mod again;
mod aside;
mod deliveries;
mod draw;
mod evaluate;
mod fire;
mod formulas;
mod hold;
pub mod patch;
mod sensors;
mod state;
pub mod stops;
mod subject;
pub mod trace;
pub mod values;
mod words;

#[cfg(test)]
pub(crate) mod fixtures;
#[cfg(test)]
mod tests;

use crate::check::shape::on_cycles;
use crate::limits;
use crate::program::{Node, NodeId, Program, Target};
use crate::project::Policy;
use deliveries::Deliveries;
use formulas::Formulas;
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::{STEP_MS, Status};
use lang_diagram::ports::{Port, Sort};
use lang_expr::Value;
use lang_expr::limits::NAMES_MAX;
use lang_text::problem::{Place, Problem, Words};
use sensors::Readings;
use state::State;
use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;
use stops::Stops;
use trace::Trace;

/// How often sensors are read, in milliseconds of model time.
pub const POLL_MS: u32 = 20;
/// The furthest that a servo is sent; each clamps to what it can do.
pub(crate) const SERVO_DEGREES: i32 = 360;

/// A program that runs.
#[derive(Clone, Debug)]
pub struct Machine {
    program: Rc<Program>,
    formulas: Formulas,
    states: Vec<State>,
    /// Tokens that wait, of nodes that wait for several.
    queues: Vec<Box<[VecDeque<Value>]>>,
    /// What those weigh, and those that waits keep.
    queued: u32,
    /// Tokens on their way.
    deliveries: Deliveries,
    /// By the time at which they are due and the order in which they were set.
    timers: BTreeMap<(u32, u32), NodeId>,
    set: u32,
    /// Nodes that give readings, in order.
    subscribed: Vec<NodeId>,
    next_poll: u32,
    readings: Readings,
    /// What devices are told at the end of the instant.
    writes: BTreeMap<Port, Write>,
    /// What motors were told last.
    told: BTreeMap<Port, i32>,
    began: Option<u32>,
    /// The moment of the last step, of the caller's clock.
    asked: u32,
    now: u32,
    /// Whether it is stopped within an instant, or goes on in one.
    is_amid: bool,
    /// Whether it was stopped after the last step: then the time until the next one is none of its time.
    was_stopped: bool,
    stops: Stops,
    firings: u32,
    /// The last blocks before the limit, each as often as it has reacted.
    suspects: Vec<NodeId>,
    /// How many tokens each port has lost.
    dropped: BTreeMap<(NodeId, u8), u32>,
    warnings: Vec<Problem>,
    errors: Vec<Problem>,
    ended: Option<u32>,
}

/// What a device is told.
#[derive(Clone, Copy, Debug)]
enum Write {
    /// Percent or degrees.
    Number(i32),
    /// An encoder becomes 0.
    Reset,
}

/// Why a reaction ends everything.
#[derive(Clone, Debug)]
enum Halt {
    /// The program has said so.
    Stop,
    /// An error.
    Error(Box<Problem>),
    /// Nothing ends, and somebody wants to look: the instant goes on later.
    Stopped,
}

/// What a reaction works with.
struct Env<'a> {
    program: &'a Program,
    brick: &'a mut dyn Brick,
    trace: &'a mut dyn Trace,
}

impl Machine {
    /// A program before its first step.
    pub fn new(program: Rc<Program>) -> Self {
        Self {
            formulas: Formulas::new(&program),
            states: program.nodes.iter().map(State::new).collect(),
            queues: program.nodes.iter().map(empty_queues).collect(),
            program,
            queued: 0,
            deliveries: Deliveries::default(),
            timers: BTreeMap::new(),
            set: 0,
            subscribed: Vec::new(),
            next_poll: POLL_MS,
            readings: Readings::default(),
            writes: BTreeMap::new(),
            told: BTreeMap::new(),
            began: None,
            asked: 0,
            now: 0,
            is_amid: false,
            was_stopped: false,
            stops: Stops::default(),
            firings: 0,
            suspects: Vec::new(),
            dropped: BTreeMap::new(),
            warnings: Vec::new(),
            errors: Vec::new(),
            ended: None,
        }
    }

    /// Runs the instant of a moment, in milliseconds that never go back. The first one is the beginning; then one is due
    /// every [`STEP_MS`]. A later one makes up for timers, but not for readings that were left out. While the program is
    /// stopped, its time stands still.
    pub fn step(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Status {
        let passed = now.saturating_sub(std::mem::replace(&mut self.asked, now));
        if self.was_stopped {
            self.began = self.began.map(|began| began.saturating_add(passed));
        }
        if !self.is_amid && self.ended.is_none() {
            self.stops.pause_now();
        }
        if self.stopped().is_none() && self.ended.is_none() {
            let program = self.program.clone();
            let env = &mut Env {
                program: &program,
                brick,
                trace,
            };
            let outcome = match std::mem::take(&mut self.is_amid) {
                true => self.tokens(env),
                false => self.instant(now, env),
            };
            self.conclude(outcome, env);
        }
        self.was_stopped = self.stopped().is_some();
        self.status()
    }

    fn instant(&mut self, now: u32, env: &mut Env<'_>) -> Result<(), Halt> {
        self.firings = 0;
        self.suspects.clear();
        self.readings.begin();
        match self.began {
            None => {
                self.began = Some(now);
                if self.formulas.has_too_many_names() {
                    let words = words::too_many_names(NAMES_MAX);
                    return Err(self.fault_at(Place::default(), words));
                }
                self.tell_lacking(env);
                self.tell_unreadable(env);
                if let Some(main) = env.program.instances.first() {
                    let starts = main.starts.iter().map(|&start| (start, Value::Nil));
                    self.deliveries.extend(starts);
                }
            }
            Some(began) => self.now = now.saturating_sub(began).max(self.now),
        }
        self.fire_timers(env)?;
        if self.now >= self.next_poll {
            self.next_poll = (self.now / POLL_MS)
                .saturating_add(1)
                .saturating_mul(POLL_MS);
            self.poll(env)?;
        }
        self.receive(env)?;
        self.tokens(env)
    }

    /// Delivers tokens until none is on its way.
    fn tokens(&mut self, env: &mut Env<'_>) -> Result<(), Halt> {
        loop {
            if self.stops.is_armed() && self.stops_here(env.trace) {
                return Err(Halt::Stopped);
            }
            if let Some((target, number)) = self.deliveries.pop_number() {
                self.deliver(target, Value::Float(number), env)?;
            } else if let Some((target, value)) = self.deliveries.pop() {
                self.deliver(target, value, env)?;
            } else {
                return Ok(());
            }
        }
    }

    /// The end of an instant: devices are told, and the program may be over.
    fn conclude(&mut self, outcome: Result<(), Halt>, env: &mut Env<'_>) {
        match outcome {
            Ok(()) => {
                self.commit(env);
                let is_over = self.timers.is_empty() && self.subscribed.is_empty();
                if is_over {
                    self.end(env);
                }
            }
            Err(Halt::Stop) => {
                self.commit(env);
                self.end(env);
            }
            Err(Halt::Error(problem)) => {
                env.trace.trap(self.now, &problem);
                self.errors.push(*problem);
                self.end(env);
            }
            Err(Halt::Stopped) => self.is_amid = true,
        }
    }

    fn commit(&mut self, env: &mut Env<'_>) {
        for (port, write) in std::mem::take(&mut self.writes) {
            let command = match (write, port.sort()) {
                (Write::Reset, _) => Command::ResetEncoder { port },
                (Write::Number(degrees), Sort::Servo) => {
                    let degrees = degrees.clamp(-SERVO_DEGREES, SERVO_DEGREES);
                    Command::Servo { port, degrees }
                }
                (Write::Number(percent), _) => {
                    let percent = percent.clamp(-100, 100);
                    self.told.insert(port, percent);
                    Command::Power { port, percent }
                }
            };
            self.tell(command, env);
        }
    }

    /// Tells a device something at once.
    fn tell(&mut self, command: Command<'_>, env: &mut Env<'_>) {
        env.trace.told(self.now, &command);
        env.brick.command(command);
    }

    fn end(&mut self, env: &mut Env<'_>) {
        self.ended = Some(self.now);
        self.stops.forget();
        self.deliveries.clear();
        self.queues = self.program.nodes.iter().map(empty_queues).collect();
        for state in &mut self.states {
            state.memory.keep_of(|_| false);
        }
        self.queued = 0;
        self.timers.clear();
        self.subscribed.clear();
        self.writes.clear();
        env.brick.command(Command::Rest);
    }

    /// Ends it from outside: motors off, nothing runs any more.
    pub fn stop(&mut self, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        if self.ended.is_none() {
            let program = self.program.clone();
            self.end(&mut Env {
                program: &program,
                brick,
                trace,
            });
        }
    }

    /// What it is doing.
    pub fn status(&self) -> Status {
        match self.ended {
            None => Status::Running,
            Some(at) => Status::Ended {
                at,
                with_errors: !self.errors.is_empty(),
            },
        }
    }

    /// What went wrong: the error that has ended it.
    pub fn errors(&self) -> &[Problem] {
        &self.errors
    }

    /// What is strange but goes on: lost tokens and readings.
    pub fn warnings(&self) -> &[Problem] {
        &self.warnings
    }

    /// What runs.
    pub fn program(&self) -> &Rc<Program> {
        &self.program
    }

    /// Milliseconds since the first step.
    pub fn now(&self) -> u32 {
        self.now
    }

    /// The program's variables that have values.
    pub fn variables(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.formulas.variables()
    }

    /// The value of a variable, if it has one; at a stop `data` is the token that comes next.
    pub fn value_of(&self, name: &str) -> Option<Value> {
        match self.next_token(name) {
            Some(token) => Some(token.clone()),
            None => self.formulas.get(name),
        }
    }

    /// How many tokens wait at a port.
    pub fn waiting_at(&self, target: Target) -> usize {
        let queues = self.queues.get(target.node as usize);
        let queue = queues.and_then(|queues| queues.get(usize::from(target.port)));
        let kept = self.states.get(target.node as usize).map_or(0, |state| {
            let kept = state.memory.kept();
            kept.filter(|(port, _)| *port == target.port).count()
        });
        queue.map_or(0, VecDeque::len) + kept
    }

    /// Ports that have lost tokens, and how many.
    pub fn dropped(&self) -> impl Iterator<Item = (Target, u32)> {
        let all = self.dropped.iter();
        all.map(|(&(node, port), &count)| (Target { node, port }, count))
    }

    /// Sends a token on a port of a node.
    fn send(
        &mut self,
        from: NodeId,
        port: u8,
        value: &Value,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let targets = env.program.node(from).outs.get(usize::from(port));
        let targets: &[Target] = targets.map_or(&[], |targets| targets);
        if targets.is_empty() {
            return Ok(());
        }
        if self.deliveries.len() + targets.len() > limits::DELIVERIES_MAX {
            let words = words::too_many_tokens(limits::DELIVERIES_MAX);
            return Err(self.fault(from, words, env));
        }
        env.trace.sent(self.now, from, port, value);
        for &target in targets {
            self.deliveries.push(target, value);
        }
        Ok(())
    }

    /// Sends a unit on the port that says that a block is done, if it has one.
    fn done(&mut self, id: NodeId, env: &mut Env<'_>) -> Result<(), Halt> {
        match env.program.node(id).done {
            Some(port) => self.send(id, port, &Value::Nil, env),
            None => Ok(()),
        }
    }

    fn deliver(&mut self, to: Target, value: Value, env: &mut Env<'_>) -> Result<(), Halt> {
        let node = env.program.node(to.node);
        let port = 1 << to.port;
        let waits = !node.queues.is_empty() && node.data & port != 0;
        if !waits {
            self.count(to.node, env)?;
            return self.react(to, value, env);
        }
        // It is all that the block waits for: most blocks have one input, and no use of a queue.
        let is_alone = node.data == port;
        if is_alone && !self.has_queued(to) {
            self.count(to.node, env)?;
            return self.react_to_one(to, &value, env);
        }
        self.queue(node, to, value, env)?;
        while self.is_complete(node, to.node) {
            self.count(to.node, env)?;
            self.react_to_all(to.node, env)?;
        }
        Ok(())
    }

    /// Puts a token into the queue of a port.
    fn queue(
        &mut self,
        node: &Node,
        to: Target,
        value: Value,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let queues = &mut self.queues[to.node as usize];
        let place = usize::from(to.port);
        let (queue, rule) = (&mut queues[place], node.queues[place]);
        let has_room = queue.len() < usize::from(rule.capacity);
        if has_room && self.queued.saturating_add(value.cells()) <= limits::QUEUED_CELLS_MAX {
            self.queued += value.cells();
            queue.push_back(value);
            return Ok(());
        }
        let oldest = match rule.policy {
            Policy::Error => None,
            Policy::Latest | Policy::Fifo => queue.pop_front(),
        };
        if let Some(oldest) = &oldest {
            self.queued = self.queued.saturating_sub(oldest.cells()) + value.cells();
            queue.push_back(value);
        }
        match rule.policy {
            Policy::Error => {
                let words = words::queue_full(rule.capacity);
                Err(self.fault_at_port(to, words, env))
            }
            Policy::Latest if oldest.is_some() => Ok(()),
            Policy::Latest | Policy::Fifo => {
                self.lose(to, words::queue_overflows(rule.capacity), env);
                Ok(())
            }
        }
    }

    /// Whether tokens wait at a port, as they may after a change of the program. Most often none does anywhere.
    fn has_queued(&self, at: Target) -> bool {
        self.queued != 0 && !self.queues[at.node as usize][usize::from(at.port)].is_empty()
    }

    /// Whether each linked data input has a token.
    fn is_complete(&self, node: &Node, id: NodeId) -> bool {
        let queues = (0..).zip(&self.queues[id as usize]);
        queues
            .into_iter()
            .all(|(port, queue)| node.data & (1 << port) == 0 || !queue.is_empty())
    }

    /// Takes the oldest token that waits at an input.
    fn take(&mut self, id: NodeId, port: usize) -> Option<Value> {
        let value = self.queues[id as usize].get_mut(port)?.pop_front()?;
        self.queued = self.queued.saturating_sub(value.cells());
        Some(value)
    }

    /// A token is lost; each port tells the first time.
    fn lose(&mut self, at: Target, words: Words, env: &mut Env<'_>) {
        let count = self.dropped.entry((at.node, at.port)).or_insert(0);
        *count = count.saturating_add(1);
        let is_first = *count == 1;
        env.trace.dropped(self.now, at);
        if is_first && self.warnings.len() < lang_text::limits::PROBLEMS {
            let name = env.program.node(at.node).port_name(at.port);
            let place = env.program.property_place(at.node, name, None);
            let problem = Problem::warning(words);
            self.warnings.push(Problem { place, ..problem });
        }
    }

    /// Counts a reaction, so that a cycle without waiting ends.
    #[inline]
    fn count(&mut self, id: NodeId, env: &mut Env<'_>) -> Result<(), Halt> {
        self.firings += 1;
        env.trace.fired(self.now, id);
        if self.firings + limits::REMEMBERED_MAX > limits::FIRINGS_MAX {
            return self.suspect(id, env);
        }
        Ok(())
    }

    /// Remembers who reacts near the limit.
    #[cold]
    fn suspect(&mut self, id: NodeId, env: &Env<'_>) -> Result<(), Halt> {
        self.suspects.push(id);
        if self.firings > limits::FIRINGS_MAX {
            return Err(self.runaway(env));
        }
        Ok(())
    }

    /// Too many reactions in one instant: of a cycle, or of a program that has so many blocks.
    fn runaway(&self, env: &Env<'_>) -> Halt {
        let mut again: Vec<NodeId> = Vec::new();
        for (at, id) in self.suspects.iter().enumerate() {
            if self.suspects[..at].contains(id) && !again.contains(id) {
                again.push(*id);
            }
        }
        // One that many others send tokens to reacts again without a cycle; a long cycle is longer than what is remembered.
        let cycles = on_cycles(env.program);
        let is_long = again.is_empty() && self.suspects.iter().all(|id| cycles.contains(id));
        if is_long {
            again.clone_from(&self.suspects);
        }
        again.retain(|id| cycles.contains(id));
        let most = limits::FIRINGS_MAX;
        let Some(&first) = again.first() else {
            let last = self.suspects.last();
            let place = last.map(|&id| env.program.place(id)).unwrap_or_default();
            return self.fault_at(place, words::busy_instant(most));
        };
        let named = again.iter().take(limits::NAMED_MAX);
        let names: Vec<String> = named.map(|&id| env.program.node(id).label()).collect();
        self.fault(first, words::runaway(most, &names), env)
    }

    /// Sets a timer of a node instead of the one that it may have.
    fn set_timer(&mut self, id: NodeId, due: u32) {
        self.cancel_timer(id);
        self.set = self.set.wrapping_add(1);
        self.timers.insert((due, self.set), id);
        self.states[id as usize].timer = Some((due, self.set));
    }

    fn cancel_timer(&mut self, id: NodeId) {
        if let Some(key) = self.states[id as usize].timer.take() {
            self.timers.remove(&key);
        }
    }

    /// A time of a block as timers keep it: at least one step, rounded up to steps.
    fn steps(ms: i32) -> u32 {
        let ms = u32::try_from(ms).unwrap_or(0).max(1);
        ms.div_ceil(STEP_MS).saturating_mul(STEP_MS)
    }

    fn fire_timers(&mut self, env: &mut Env<'_>) -> Result<(), Halt> {
        // What is set meanwhile is due later: a timer fires once in an instant.
        let later = self.timers.split_off(&(self.now.saturating_add(1), 0));
        let due = std::mem::replace(&mut self.timers, later);
        for (key, id) in due {
            // One that is due at the same time may have set it anew.
            if self.states[id as usize].timer == Some(key) {
                self.states[id as usize].timer = None;
                self.count(id, env)?;
                self.timer(id, key.0, env)?;
            }
        }
        Ok(())
    }

    /// Fails at a node.
    fn fault(&self, id: NodeId, words: Words, env: &Env<'_>) -> Halt {
        self.fault_at(env.program.place(id), words)
    }

    fn fault_at_port(&self, at: Target, words: Words, env: &Env<'_>) -> Halt {
        let name = env.program.node(at.node).port_name(at.port);
        self.fault_at(env.program.property_place(at.node, name, None), words)
    }

    fn fault_at(&self, place: Place, words: Words) -> Halt {
        let problem = Problem::error(words);
        Halt::Error(Box::new(Problem { place, ..problem }))
    }

    /// Whether it waits for something: a timer, a reading, a message.
    pub fn is_waiting(&self) -> bool {
        !self.timers.is_empty() || !self.subscribed.is_empty()
    }
}

/// Queues of a node that waits for several tokens; none of any other.
fn empty_queues(node: &Node) -> Box<[VecDeque<Value>]> {
    node.queues.iter().map(|_| VecDeque::new()).collect()
}
