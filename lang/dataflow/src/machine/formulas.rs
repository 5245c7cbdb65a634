//! Expressions of a running program: names, values, and which names are whose own.
//!
//! Owns the border to the language of expressions. A name that is a block's own has the type of the value that it got
//! last, so tokens of a port may change their type; a variable of the project has one type.

use super::state::State;
use super::words;
use crate::lower::DATA;
use crate::program::{Formula, NodeId, Program, Text};
use crate::sensors;
use lang_expr::names::{is_own, own_name};
use lang_expr::reserved::SensorIndex;
use lang_expr::tree::Node as Part;
use lang_expr::{Kind, Names, Outside, Slot, Source, Store, Type, Value, Wanted};
use lang_text::problem::{Problem, Words};
use std::rc::Rc;

/// All expressions with their names and values.
#[derive(Clone, Debug)]
pub(super) struct Formulas {
    sources: Vec<Source>,
    /// The node of each text: what is looked up for each token stands close together.
    nodes: Vec<NodeId>,
    /// Own names that each text reads, as bits in the order of [`crate::program::Text::own`].
    reads: Vec<u8>,
    names: Names,
    store: Store,
    /// Own names of each node that has any, by their places; those that no text reads have none.
    own: Vec<Option<Box<[Option<Slot>]>>>,
    /// Texts of each node: the first one, and how many.
    of_node: Vec<(Formula, u32)>,
    /// Whether there was no room for a name.
    is_full: bool,
    /// Names for conditions, so that these narrow no type of the program, and for which state of its types they are.
    aside: Option<Box<(u32, Names)>>,
}

/// Why a text has no value.
#[derive(Debug)]
pub(super) enum Reason {
    /// An own name has no value yet.
    Unbound(&'static str),
    /// An own name got a unit.
    Unit(&'static str),
    /// The language of expressions says so.
    Problems(Vec<Problem>),
}

/// Why a text that came from outside is not run.
#[derive(Debug)]
pub(super) enum Refused {
    /// It would change variables.
    Assigns,
    /// The program has no variable of this name.
    Unknown(String),
    /// The language of expressions says so.
    Problems(Vec<Problem>),
}

impl Formulas {
    pub fn new(program: &Program) -> Self {
        let names = sensors::names_of(program.kit).strict();
        Self::with(program, names, Store::default())
    }

    /// Those of a new version of the program: variables keep values and types, and own names have none.
    pub fn after(program: &Program, old: &Self) -> Self {
        let (names, mut store) = (old.names.clone(), old.store.clone());
        for (slot, name, _) in names.variables() {
            if is_own(name) {
                store.remove(slot);
            }
        }
        Self::with(program, names, store)
    }

    fn with(program: &Program, names: Names, store: Store) -> Self {
        let mut formulas = Self {
            sources: Vec::with_capacity(program.formulas.len()),
            nodes: program.formulas.iter().map(|text| text.node).collect(),
            reads: Vec::with_capacity(program.formulas.len()),
            names,
            store,
            own: vec![None; program.nodes.len()],
            of_node: vec![(0, 0); program.nodes.len()],
            is_full: false,
            aside: None,
        };
        for (index, text) in (0..).zip(&program.formulas) {
            formulas.add(index, text);
        }
        formulas
    }

    fn add(&mut self, index: Formula, text: &Text) {
        let rename = |name: &str| {
            let is_own = text.own.contains(&name);
            is_own.then(|| own_name(name, text.node))
        };
        let source = Source::with_own_names(&text.text, text.wanted, &rename);
        let mut bits = 0;
        let node = text.node as usize;
        let slots = self.own[node].get_or_insert_with(|| vec![None; text.own.len()].into());
        for (at, name) in text.own.iter().enumerate() {
            let own = own_name(name, text.node);
            if source.names().any(|one| *one == *own) {
                bits |= 1 << at;
                slots[at] = self.names.slot(&own);
                self.is_full |= slots[at].is_none();
            }
        }
        let (first, count) = &mut self.of_node[node];
        if *count == 0 {
            *first = index;
        }
        *count = index + 1 - *first;
        self.reads.push(bits);
        self.sources.push(source);
    }

    /// Sensor variables that texts read, each with the first text that does.
    pub fn sensors(&self) -> Vec<(Formula, SensorIndex)> {
        let mut found: Vec<(Formula, SensorIndex)> = Vec::new();
        for (index, source) in (0..).zip(&self.sources) {
            for sensor in source.names().filter_map(sensors::find) {
                if found.iter().all(|(_, one)| *one != sensor) {
                    found.push((index, sensor));
                }
            }
        }
        found
    }

    /// The node of a text.
    pub fn node(&self, index: Formula) -> NodeId {
        self.nodes[index as usize]
    }

    /// Whether the program has more names than there is room for.
    pub fn has_too_many_names(&self) -> bool {
        self.is_full
    }

    /// The slot of an own name, if some text reads it.
    fn slot(&self, id: NodeId, at: usize) -> Option<Slot> {
        let slots = self.own[id as usize].as_ref()?;
        slots.get(at).copied().flatten()
    }

    /// The value of an own name, if it has one.
    pub fn own(&self, id: NodeId, at: usize, state: &State) -> Option<Value> {
        let is_there = state.bound & !state.units & (1 << at) != 0;
        let slot = self.slot(id, at).filter(|_| is_there)?;
        self.store.get(slot).cloned()
    }

    /// Gives an own name of a node, by its place among them, the value of a token.
    pub fn bind(&mut self, id: NodeId, at: usize, value: &Value, state: &mut State) {
        let Some(slot) = self.slot(id, at) else {
            return;
        };
        let bit = 1 << at;
        state.bound |= bit;
        if super::values::is_unit(value) {
            state.units |= bit;
            self.store.remove(slot);
            return;
        }
        state.units &= !bit;
        // Then nothing has to be inferred anew.
        if self.store.set_like(slot, value) {
            return;
        }
        if !self.keeps_type(slot, value) && self.names.retype(slot, value) {
            // What the texts have learned of the former type is void.
            let (first, count) = self.of_node[id as usize];
            for source in &mut self.sources[first as usize..(first + count) as usize] {
                source.reread();
            }
        }
        if self.store.set(slot, value.clone()).is_err() {
            // All values together are too many; the text that reads it says that there is none.
            state.bound &= !bit;
        }
    }

    /// Whether a slot has a text and gets one: then nothing has to be inferred anew either.
    fn keeps_type(&self, slot: Slot, value: &Value) -> bool {
        matches!(
            (self.store.get(slot), value),
            (Some(Value::Text(_)), Value::Text(_))
        )
    }

    /// Writes the value of a text, once its own names are bound.
    pub fn evaluate(
        &mut self,
        program: &Program,
        index: Formula,
        state: &State,
        outside: &mut dyn Outside,
        into: &mut Value,
    ) -> Result<(), Reason> {
        self.ready(program, index, state)?;
        let source = &self.sources[index as usize];
        lang_expr::evaluate_to(source, &self.names, &mut self.store, outside, into)
            .map_err(Reason::Problems)
    }

    /// The truth of a text.
    pub fn truth(
        &mut self,
        program: &Program,
        index: Formula,
        state: &State,
        outside: &mut dyn Outside,
    ) -> Result<bool, Reason> {
        self.ready(program, index, state)?;
        let source = &self.sources[index as usize];
        lang_expr::evaluate_bool(source, &self.names, &mut self.store, outside)
            .map_err(Reason::Problems)
    }

    fn ready(&mut self, program: &Program, index: Formula, state: &State) -> Result<(), Reason> {
        let reads = self.reads[index as usize];
        let missing = reads & !(state.bound & !state.units);
        if missing != 0 {
            let at = missing.trailing_zeros() as usize;
            let name = program.formulas[index as usize].own[at];
            let is_unit = state.units & (1 << at) != 0;
            return Err(match is_unit {
                true => Reason::Unit(name),
                false => Reason::Unbound(name),
            });
        }
        let source = &mut self.sources[index as usize];
        lang_expr::analyse(source, &mut self.names).map_err(Reason::Problems)
    }

    /// The value of a text that came as a token, or from a person. No type of the program is narrowed by it.
    pub fn evaluate_text(
        &mut self,
        text: &str,
        wanted: Wanted,
        outside: &mut dyn Outside,
    ) -> Result<Value, Refused> {
        let mut source = Source::new(text, wanted);
        if assigns(&source) {
            return Err(Refused::Assigns);
        }
        let is_new = |name: &&str| self.names.find(name).is_none();
        if let Some(name) = source.names().find(is_new) {
            return Err(Refused::Unknown(name.to_owned()));
        }
        let mut names = self.names.clone();
        lang_expr::analyse(&mut source, &mut names)
            .and_then(|()| lang_expr::evaluate(&source, &names, &mut self.store, outside))
            .map_err(Refused::Problems)
    }

    /// All texts of the program.
    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// All names of the program.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// The value of a text of a breakpoint, which sees a token as `data`; nothing while one of its variables has no value.
    pub fn look(
        &mut self,
        (text, wanted): (&str, Wanted),
        token: Option<&Value>,
        outside: &mut dyn Outside,
    ) -> Result<Option<Value>, Vec<Problem>> {
        let own = |name: &str| token.and_then(|_| token_name(name));
        let mut source = Source::with_own_names(text, wanted, &own);
        let is_there = |name: &str| is_own(name) || self.names.find(name).is_some();
        if !source.names().all(is_there) {
            return Ok(None);
        }
        let epoch = self.names.epoch();
        let is_new = self.aside.as_ref().is_none_or(|aside| aside.0 != epoch);
        if is_new {
            self.aside = Some(Box::new((epoch, self.names.clone())));
        }
        let Some((_, names)) = self.aside.as_deref_mut() else {
            return Ok(None);
        };
        let own = source
            .names()
            .find(|name| is_own(name))
            .map(Rc::<str>::from);
        let slot = match (own, token) {
            (Some(_), Some(token)) if super::values::is_unit(token) => {
                return Err(vec![Problem::error(words::unit())]);
            }
            (Some(own), Some(token)) => names.slot(&own).map(|slot| (slot, token)),
            (Some(_) | None, _) => None,
        };
        if let Some((slot, token)) = slot {
            names.retype(slot, token);
            if self.store.set(slot, token.clone()).is_err() {
                return Err(vec![Problem::error(words::too_many_variables())]);
            }
        }
        let value = lang_expr::analyse(&mut source, names)
            .and_then(|()| lang_expr::evaluate(&source, names, &mut self.store, outside));
        if let Some((slot, _)) = slot {
            self.store.remove(slot);
        }
        value.map(Some)
    }

    /// Whether all texts whose names have values can be understood with the types that those have; of the others nobody
    /// can know it before something gives their variables values.
    ///
    /// # Errors
    /// The mistakes of the first one that cannot, with their places.
    pub fn check_all(&self, program: &Program, states: &[State]) -> Result<(), Vec<Problem>> {
        let mut names = self.names.clone();
        for ((source, reads), text) in self.sources.iter().zip(&self.reads).zip(&program.formulas) {
            let state = &states[text.node as usize];
            let has_value = |name: &str| match names.find(name).map(|slot| (slot, names.kind(slot)))
            {
                Some((slot, Some(Kind::Variable))) => self.store.get(slot).is_some(),
                Some((_, Some(Kind::Function(_) | Kind::Sensor(_) | Kind::Constant(_)))) => true,
                Some((_, None)) | None => false,
            };
            let is_missing = reads & !(state.bound & !state.units) != 0;
            if is_missing || !source.names().all(has_value) {
                continue;
            }
            let mut source = source.clone();
            source.reread();
            if let Err(problems) = lang_expr::analyse(&mut source, &mut names) {
                // The version is good by itself, so these types are the reason.
                let kept = kept_types(&source, &self.names);
                let placed = problems.into_iter().map(|problem| Problem {
                    place: program.property_place(text.node, text.property, problem.place.position),
                    words: match kept.is_empty() || problem.hint.is_some() {
                        true => problem.words,
                        false => words::kept_types(&problem.words, &kept),
                    },
                    ..problem
                });
                return Err(placed.collect());
            }
        }
        Ok(())
    }

    /// Gives a variable of the project a value.
    pub fn assign(&mut self, name: &str, value: Value) -> Result<(), Words> {
        let Some(slot) = self.names.declare(name, &value) else {
            return Err(words::too_many_variables());
        };
        let of = self.names.type_of(slot);
        if let (Type::Int, Value::Float(_)) = (of, &value) {
            self.names.retype(slot, &value);
        } else if !is_of(of, &value) {
            return Err(lang_expr::refused(&mut self.names, slot, &value));
        }
        let set = self.store.set(slot, value);
        set.map_err(|_| words::too_many_variables())
    }

    /// The value of a variable of the project.
    pub fn get(&self, name: &str) -> Option<Value> {
        self.store.get(self.names.find(name)?).cloned()
    }

    /// What all values weigh, those of blocks' own names among them.
    pub fn cells(&self) -> u32 {
        self.store.cells()
    }

    /// Variables of the project that have values.
    pub fn variables(&self) -> impl Iterator<Item = (&str, &Value)> {
        let all = self.names.variables();
        all.filter(|(_, name, _)| !is_own(name))
            .filter_map(|(slot, name, _)| Some((name, self.store.get(slot)?)))
    }
}

/// Variables of the project that a text names, each once, and their types.
fn kept_types(source: &Source, names: &Names) -> Vec<(String, String)> {
    let mut kept: Vec<(String, String)> = Vec::new();
    for name in source.names() {
        let slot = names.find(name);
        let kind = slot.and_then(|slot| names.kind(slot));
        if let (Some(slot), Some(Kind::Variable), false) = (slot, kind, is_own(name))
            && !matches!(names.type_of(slot), Type::Any | Type::Open)
            && kept.iter().all(|(had, _)| had != name)
        {
            kept.push((name.to_owned(), names.type_name(names.type_of(slot))));
        }
    }
    kept
}

/// Whether a text assigns something.
pub(super) fn assigns(source: &Source) -> bool {
    let nodes = &source.tree().nodes;
    nodes.iter().any(|part| matches!(part, Part::Assign { .. }))
}

/// The name that stands for `data` in a text of a breakpoint.
pub(super) fn token_name(name: &str) -> Option<Rc<str>> {
    DATA.contains(&name).then(|| own_name(name, NodeId::MAX))
}

/// Whether a value has a type; what is not known has every type.
fn is_of(of: Type, value: &Value) -> bool {
    match of {
        Type::Any | Type::Open => true,
        Type::Bool => matches!(value, Value::Bool(_)),
        Type::Int => matches!(value, Value::Int(_)),
        // A whole number stands where a number may stand.
        Type::Float => matches!(value, Value::Float(_) | Value::Int(_)),
        Type::Text => matches!(value, Value::Text(_) | Value::Unset),
        Type::Nil => matches!(value, Value::Nil),
        Type::Function => false,
        Type::Table(_) => matches!(value, Value::List(_)),
    }
}
