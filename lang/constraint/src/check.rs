//! One run held against rules: which events are alive, what fires, and what the verdict is.
//!
//! Owns the order of a pass and the entries of the report. Knows no clock: the time of the model is an argument.

use std::collections::HashMap;
use std::rc::Rc;

use super::explain::{Explanation, Watch};
use super::operand::Context;
use super::report::{Entry, Failure, Level, Verdict, json, seconds};
use super::rules::{Condition, EventIndex, Message, Named, Operand, Path, Rules, Trigger};
use super::scene::{Object, Scene, Unfit};
use super::value::Value;
use super::words;
use crate::limits;
use lang_text::problem::{Locale, Words};

/// The variable that every set of rules has.
pub(super) const SCORE: &str = "total_score";
/// Events whose ids begin so are checked when the task is done, before that is told.
pub(super) const ON_SUCCESS: &str = "on_success";

#[derive(Clone, Copy, Debug, Default)]
struct State {
    is_alive: bool,
    /// When it was set up last; 0 before that, and then nobody asks.
    since_ms: u64,
}

/// What a run has been told so far.
#[derive(Clone, Copy, Debug, Default)]
struct Outcome {
    success: bool,
    deferred: bool,
    failed: bool,
    /// Why it failed first.
    failure: Option<Failure>,
    /// The event that has said so first: of a success that waits for the end, of a success, and of a failure.
    deferred_by: Option<EventIndex>,
    succeeded_by: Option<EventIndex>,
    failed_by: Option<EventIndex>,
    /// Nothing more can come: success, or the time is over, or a failure that is not to be gone on after.
    decided: bool,
}

/// Rules and one run.
#[derive(Debug)]
pub struct Checker {
    rules: Rc<Rules>,
    locale: Locale,
    start_ms: u64,
    continues: bool,
    states: Vec<State>,
    /// Events of the pass that goes on, kept to save memory from being asked for in every tick.
    pass: Vec<EventIndex>,
    variables: HashMap<Box<str>, Value>,
    found: Vec<Option<(Object, usize)>>,
    /// Whether the scene has been asked for all objects of the rules.
    has_looked: bool,
    /// Entries, counted with those that were left out.
    told: usize,
    /// Bytes of them.
    told_bytes: usize,
    /// Whether it was said that entries are left out.
    is_full: bool,
    outcome: Outcome,
    verdict: Verdict,
    /// What is kept for an explanation, if one is wanted.
    watch: Option<Box<Watch>>,
}

impl Checker {
    /// A run that starts at 0 ms, whose own messages are in a language; messages of the rules are as their author wrote
    /// them.
    pub fn new(rules: Rc<Rules>, locale: Locale) -> Self {
        let states = rules.events.iter().map(|event| State {
            is_alive: event.initially,
            since_ms: 0,
        });
        Self {
            states: states.collect(),
            locale,
            start_ms: 0,
            continues: false,
            pass: Vec::with_capacity(rules.events.len()),
            variables: HashMap::from([(SCORE.into(), Value::Int(0))]),
            found: vec![None; rules.slots],
            has_looked: false,
            told: 0,
            told_bytes: 0,
            is_full: false,
            outcome: Outcome::default(),
            verdict: Verdict::Open,
            watch: None,
            rules,
        }
    }

    /// The same for a run that starts later.
    #[must_use]
    pub fn starting_at(mut self, ms: u64) -> Self {
        self.start_ms = ms;
        for state in &mut self.states {
            state.since_ms = ms;
        }
        self
    }

    /// The same, going on after failures until the time is over, the task is done or the program ends, so that all
    /// failures are told. The verdict is that of the first.
    #[must_use]
    pub fn continuing(mut self) -> Self {
        self.continues = true;
        self
    }

    /// The same, keeping what [`Self::explain`] tells. It changes nothing else.
    #[must_use]
    pub fn explaining(mut self) -> Self {
        self.watch = Some(Box::new(Watch::new(&self.rules)));
        self
    }

    /// Why the run has come to what it has; none if it was not asked to explain.
    pub fn explain(&self) -> Option<Explanation> {
        let watch = self.watch.as_ref()?;
        let (decider, is_open) = match (self.verdict, self.outcome.failure) {
            (Verdict::Accomplished { .. }, _) => (self.outcome.succeeded_by, false),
            (Verdict::Failed { .. }, Some(Failure::Rule)) => (self.outcome.failed_by, false),
            (Verdict::Failed { .. } | Verdict::Open, _) => (self.outcome.failed_by, true),
        };
        let is_alive = |event: EventIndex| self.states[event].is_alive;
        Some(watch.explain(&self.rules, decider, is_open, &is_alive, self.locale))
    }

    /// The verdict so far.
    pub fn verdict(&self) -> Verdict {
        self.verdict
    }

    /// Why the task is failed, if it is: the first reason.
    pub fn failure(&self) -> Option<Failure> {
        self.outcome.failure
    }

    /// The value of a variable of the rules.
    pub fn variable(&self, name: &str) -> Option<&Value> {
        self.variables.get(name)
    }

    /// One pass over all events that are alive, once in each tick. When it decides the run, the pass before stopping is
    /// made too. After that nothing happens any more.
    pub fn check(
        &mut self,
        now_ms: u64,
        scene: &mut dyn Scene,
        entries: &mut Vec<Entry>,
    ) -> Verdict {
        if self.verdict != Verdict::Open {
            return self.verdict;
        }
        self.pass(now_ms, scene, entries);
        if self.outcome.decided {
            self.pass(now_ms, scene, entries);
            if self.continues {
                self.run(now_ms, scene, entries).dump();
            }
            self.decide(now_ms);
        }
        self.verdict
    }

    /// The program has ended by itself, or was stopped by an error or a person: the last pass, and a verdict.
    pub fn program_ended(
        &mut self,
        now_ms: u64,
        with_errors: bool,
        scene: &mut dyn Scene,
        entries: &mut Vec<Entry>,
    ) -> Verdict {
        if self.verdict != Verdict::Open {
            return self.verdict;
        }
        self.pass(now_ms, scene, entries);
        let outcome = self.outcome;
        if !outcome.success && !outcome.failed {
            let mut run = self.run(now_ms, scene, entries);
            if outcome.deferred && !with_errors {
                run.accomplish();
            } else {
                run.fail(Failure::Unfinished, None);
            }
        }
        if self.continues {
            self.run(now_ms, scene, entries).dump();
        }
        self.decide(now_ms);
        self.verdict
    }

    fn decide(&mut self, now_ms: u64) {
        let after_ms = now_ms.saturating_sub(self.start_ms);
        self.verdict = if self.outcome.failed {
            Verdict::Failed { after_ms }
        } else {
            Verdict::Accomplished { after_ms }
        };
    }

    fn pass(&mut self, now_ms: u64, scene: &mut dyn Scene, entries: &mut Vec<Entry>) {
        // Events that are set up during the pass wait for the next one.
        let mut pass = std::mem::take(&mut self.pass);
        pass.clear();
        pass.extend((0..self.states.len()).filter(|&event| self.states[event].is_alive));
        if !std::mem::replace(&mut self.has_looked, true) {
            // What a rule may ask for later is to be known to the scene from the beginning.
            for name in &self.rules.objects {
                let _ = scene.find(name);
            }
        }
        let mut run = self.run(now_ms, scene, entries);
        for &event in &pass {
            run.check(event);
        }
        run.flush();
        self.pass = pass;
    }

    fn run<'a>(
        &'a mut self,
        now_ms: u64,
        scene: &'a mut dyn Scene,
        entries: &'a mut Vec<Entry>,
    ) -> Run<'a> {
        Run {
            now_ms,
            start_ms: self.start_ms,
            locale: self.locale,
            continues: self.continues,
            rules: &self.rules,
            states: &mut self.states,
            told: &mut self.told,
            told_bytes: &mut self.told_bytes,
            is_full: &mut self.is_full,
            outcome: &mut self.outcome,
            entries,
            is_succeeding: false,
            current: None,
            watch: self.watch.as_deref_mut(),
            context: Context {
                scene,
                variables: &mut self.variables,
                found: &mut self.found,
                complaints: Vec::new(),
            },
        }
    }
}

/// A pass: the checker's parts, borrowed one by one, and the world.
struct Run<'a> {
    now_ms: u64,
    start_ms: u64,
    locale: Locale,
    continues: bool,
    rules: &'a Rules,
    states: &'a mut [State],
    told: &'a mut usize,
    told_bytes: &'a mut usize,
    is_full: &'a mut bool,
    outcome: &'a mut Outcome,
    entries: &'a mut Vec<Entry>,
    /// Whether events are checked that come before success is told.
    is_succeeding: bool,
    /// The event that is looked at; none at the end of the program.
    current: Option<EventIndex>,
    watch: Option<&'a mut Watch>,
    context: Context<'a>,
}

impl Run<'_> {
    fn set_up(&mut self, event: EventIndex) {
        self.states[event] = State {
            is_alive: true,
            since_ms: self.now_ms,
        };
        if let Some(watch) = &mut self.watch {
            watch.was_set_up(event);
        }
    }

    /// Looks at the conditions of an event, for an explanation.
    fn watch(&mut self, index: EventIndex) {
        let states = &*self.states;
        if let Some(watch) = &mut self.watch
            && states[index].is_alive
        {
            let is_alive = |event: EventIndex| states[event].is_alive;
            let times = [self.now_ms, states[index].since_ms];
            let context = &mut self.context;
            let (scene, variables) = (&mut *context.scene, &mut *context.variables);
            watch.observe(index, self.rules, scene, variables, &is_alive, times);
        }
    }

    fn check(&mut self, index: EventIndex) {
        let rules = self.rules;
        let event = &rules.events[index];
        if self.watch.is_some() {
            self.watch(index);
        }
        if !self.states[index].is_alive || !self.holds(&event.condition, index) {
            return;
        }
        if let Some(watch) = &mut self.watch {
            watch.fired(index, self.now_ms);
        }
        let outer = self.current.replace(index);
        self.fire(&event.trigger);
        self.current = outer;
        if event.drops {
            self.states[index].is_alive = false;
        }
    }

    fn holds(&mut self, condition: &Condition, event: EventIndex) -> bool {
        match condition {
            Condition::True => true,
            Condition::All(all) => all.iter().all(|one| self.holds(one, event)),
            Condition::Any(any) => any.iter().any(|one| self.holds(one, event)),
            Condition::Not(one) => !self.holds(one, event),
            Condition::Compare(comparison, operands) => self.context.compare(*comparison, operands),
            Condition::Inside {
                object,
                region,
                point,
            } => {
                let Some(thing) = self.context.object(object) else {
                    return self.complain(words::no_object(&object.text));
                };
                let Some(place) = self.context.object(region) else {
                    return self.complain(words::no_region(&region.text));
                };
                match self.context.scene.is_inside(thing, place, *point) {
                    Ok(inside) => inside,
                    Err(Unfit::NoRegion) => self.complain(words::not_a_region(&region.text)),
                    Err(Unfit::NoPlace) => self.complain(words::not_matched(&object.text)),
                }
            }
            Condition::SettedUp(named) => match self.event(named) {
                Some(other) => self.states[other].is_alive,
                None => false,
            },
            Condition::Dropped(named) => match self.event(named) {
                Some(other) => !self.states[other].is_alive,
                None => true,
            },
            Condition::Timer { ms, drops, .. } => {
                let passed = self.now_ms.saturating_sub(self.states[event].since_ms);
                let over = i64::try_from(passed).unwrap_or(i64::MAX) >= i64::from(*ms);
                if over && *drops {
                    // The event may fire all the same, because it was alive when its turn came.
                    self.states[event].is_alive = false;
                }
                over
            }
            Condition::Using(triggers, condition) => {
                for trigger in triggers {
                    self.fire(trigger);
                }
                self.holds(condition, event)
            }
        }
    }

    fn fire(&mut self, trigger: &Trigger) {
        match trigger {
            Trigger::All(all) => {
                for one in all {
                    self.fire(one);
                }
            }
            Trigger::Fail(message) => self.fail(Failure::Rule, Some(message)),
            Trigger::TimeOver => {
                let message = words::too_long();
                self.fail(Failure::TimeOver, Some(message.in_locale(self.locale)));
                self.outcome.decided = true;
            }
            Trigger::Success { deferred: true } => {
                self.outcome.deferred = true;
                self.outcome.deferred_by = self.outcome.deferred_by.or(self.current);
            }
            Trigger::Success { deferred: false } => self.accomplish(),
            Trigger::Say(message) => {
                let text = self.filled(message);
                self.report(Level::Info, text, false);
            }
            Trigger::Log(message) => {
                let text = self.filled(message);
                self.report(Level::Log, text, false);
            }
            Trigger::SetVariable(name, _, operand) => {
                let value = self.context.value(operand);
                match self.context.variables.get_mut(name) {
                    Some(old) => *old = value,
                    None => {
                        self.context.variables.insert(name.clone(), value);
                    }
                }
            }
            Trigger::SetUp(named) => {
                if let Some(event) = self.event(named) {
                    self.set_up(event);
                }
            }
            Trigger::Drop(named) => {
                if let Some(event) = self.event(named) {
                    self.states[event].is_alive = false;
                }
            }
            Trigger::SetState {
                object,
                property,
                value,
            } => self.set_state(object, property, value),
        }
    }

    /// Gives a property of an object, or of what stands in one, a value.
    fn set_state(&mut self, object: &Path, property: &str, value: &Operand) {
        let target = self.context.state(object, true);
        let is_set = if let Value::Object(found) = target {
            let value = self.context.value(value);
            self.context.scene.set_property(found, property, &value)
        } else if let Value::Record(_) = target {
            let value = self.context.value(value);
            self.context.set_within(object, property, &value)
        } else {
            self.complain(words::no_state(target.type_name()));
            return;
        };
        if !is_set {
            self.complain(words::no_settable(target.type_name(), property));
        }
    }

    /// A text with its places filled.
    fn filled(&mut self, message: &Message) -> String {
        let mut text = message.text.to_string();
        for (place, operand) in &message.filled {
            let value = self.context.value(operand).to_text();
            if !text.contains(&**place) {
                continue;
            }
            let places = text.matches(&**place).count();
            let grown = places.saturating_mul(value.len());
            if text.len().saturating_add(grown) > limits::CONSTRAINT_MESSAGE_BYTES {
                self.complain(words::message_too_long());
                break;
            }
            text = text.replace(&**place, &value);
        }
        text
    }

    /// The event of a name, or a complaint.
    fn event(&mut self, named: &Named) -> Option<EventIndex> {
        if named.event.is_none() {
            self.complain(words::no_event(&named.id));
        }
        named.event
    }

    /// Keeps an error of the rules; the condition that has it is false.
    fn complain(&mut self, words: Words) -> bool {
        if self.context.complaints.len() < limits::CONSTRAINT_COMPLAINTS_MAX {
            self.context.complaints.push(words);
        }
        self.flush();
        false
    }

    /// Tells what evaluation has complained of.
    fn flush(&mut self) {
        for words in std::mem::take(&mut self.context.complaints) {
            let words = words::in_checker(&words);
            let text = words.in_locale(self.locale).to_owned();
            self.report(Level::Critical, text, false);
        }
    }

    /// The task is failed; without a message, because the program has ended before it was done.
    fn fail(&mut self, failure: Failure, message: Option<&str>) {
        let is_first = !self.outcome.failed;
        self.outcome.failed = true;
        if is_first {
            self.outcome.failure = Some(failure);
            self.outcome.failed_by = self.current;
        }
        let unfinished = words::unfinished();
        let message = message.unwrap_or(unfinished.in_locale(self.locale));
        self.report(Level::Error, message.to_owned(), is_first);
        if !self.continues {
            self.outcome.decided = true;
            self.dump();
        }
    }

    /// The task is done, unless something that was gone on after has failed it.
    fn accomplish(&mut self) {
        if self.is_succeeding {
            return;
        }
        self.is_succeeding = true;
        let rules = self.rules;
        // Events stand in descending order of their ids, and these are checked in ascending order.
        for (index, event) in rules.events.iter().enumerate().rev() {
            if event.id.starts_with(ON_SUCCESS) {
                self.set_up(index);
                self.check(index);
            }
        }
        self.is_succeeding = false;
        let is_first = !self.outcome.success;
        self.outcome.success = true;
        if is_first {
            self.outcome.succeeded_by = self.current.or(self.outcome.deferred_by);
        }
        self.outcome.decided = true;
        if self.continues && self.outcome.failed {
            return;
        }
        let words = words::accomplished(&seconds(self.now_ms.saturating_sub(self.start_ms)));
        let text = words.in_locale(self.locale).to_owned();
        self.report(Level::Info, text, is_first);
        if !self.continues {
            self.dump();
        }
    }

    /// Tells the variables.
    fn dump(&mut self) {
        let score = self.context.variables.get(SCORE);
        let value = score.map_or_else(|| "null".to_owned(), json);
        let text = format!(r#"{{"variables":[{{"name":"{SCORE}","value":{value}}}]}}"#);
        self.report(Level::Variables, text, true);
    }

    /// Adds an entry; one that must be is told however much was told before.
    fn report(&mut self, level: Level, text: String, must: bool) {
        if level != Level::Critical {
            self.flush();
        }
        *self.told = self.told.saturating_add(1);
        let bytes = self.told_bytes.saturating_add(text.len());
        let is_long = bytes > limits::CONSTRAINT_ENTRIES_BYTES;
        if (is_long || *self.told > limits::CONSTRAINT_ENTRIES_MAX) && !must {
            if *self.is_full {
                return;
            }
            *self.is_full = true;
            let words = words::too_many_messages();
            self.push(Level::Critical, words.in_locale(self.locale).to_owned());
            return;
        }
        *self.told_bytes = bytes;
        self.push(level, text);
    }

    fn push(&mut self, level: Level, text: String) {
        self.entries.push(Entry {
            level,
            at_ms: self.now_ms,
            place: String::new(),
            text,
        });
    }
}
