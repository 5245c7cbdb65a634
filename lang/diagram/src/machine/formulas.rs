//! Expressions of a running program: each text compiled once, all names, all values.
//!
//! Owns the border to the language of expressions. Knows no blocks: a problem has no place but the one in its text.

use super::Options;
use crate::program::{Program, Source as Index};
use lang_expr::reserved::SENSORS;
use lang_expr::{Compat, Names, Outside, Slot, Source, Store, Value, Wanted};
use lang_text::problem::Problem;
use std::collections::{HashMap, HashSet};

/// How often texts are looked at that need each other to know what their names are: as the check before a run does, a few
/// times are enough but for texts that are in the wrong order on purpose.
const ROUNDS: usize = 8;

/// All expressions with their names and values.
#[derive(Clone, Debug)]
pub(super) struct Formulas {
    sources: Vec<Source>,
    names: Names,
    store: Store,
    /// Slots that were written, while they are told.
    scratch: Vec<Slot>,
}

impl Formulas {
    pub fn new(program: &Program, options: Options) -> Self {
        let sources = program.sources.iter();
        let mut names = Names::new(program.kit, options.compat);
        if options.in_turns && options.compat == Compat::Studio {
            // A judge answers as the original does; on a robot no number may become another one.
            names = names.with_low_bits();
        }
        if !program.has_gamepad {
            // The original's simulator has no gamepad, and its names are those of any variable.
            for sensor in SENSORS {
                if sensor.name.starts_with("gamepad") {
                    names.forget_sensor(sensor.name);
                }
            }
        }
        Self {
            sources: sources
                .map(|text| Source::new(&text.text, text.wanted.wanted()))
                .collect(),
            names,
            store: Store::default(),
            scratch: Vec::new(),
        }
    }

    /// The expressions of another version of the program with the names and values of this one.
    pub fn patched(&self, program: &Program) -> Self {
        let known = self.sources.iter();
        let known: HashMap<_, _> = known
            .map(|source| ((source.text(), source.wanted()), source))
            .collect();
        let sources = program.sources.iter().map(|text| {
            let wanted = text.wanted.wanted();
            match known.get(&(&*text.text, wanted)) {
                Some(source) => source.anew(),
                None => Source::new(&text.text, wanted),
            }
        });
        Self {
            sources: sources.collect(),
            names: self.names.clone(),
            store: self.store.clone(),
            scratch: Vec::new(),
        }
    }

    /// What is wrong with these texts once each has taught the names what it knows. The names themselves learn nothing.
    pub fn mistakes(&self, texts: &[Index]) -> Vec<(Index, Vec<Problem>)> {
        let mut found = self.wrong(texts, &mut self.names.clone());
        if found.is_empty() {
            return found;
        }
        // What a name is may be said by a text whose turn has not come yet.
        let these: HashSet<Index> = texts.iter().copied().collect();
        let others = self.sources.iter().zip(0..);
        let others = others.filter(|(_, index)| !these.contains(index));
        let mut others: Vec<_> = others.map(|(source, _)| source.anew()).collect();
        let mut names = self.names.clone();
        for _ in 0..ROUNDS {
            let before = others.len();
            others.retain_mut(|source| lang_expr::analyse(source, &mut names).is_err());
            if others.len() == before {
                break;
            }
            let mut taught = names.clone();
            found = self.wrong(texts, &mut taught);
            if found.is_empty() {
                break;
            }
            // Others may need what these say.
            names = taught;
        }
        found
    }

    /// The same with names that these texts teach.
    fn wrong(&self, texts: &[Index], names: &mut Names) -> Vec<(Index, Vec<Problem>)> {
        let read = texts.iter().filter_map(|&index| {
            let source = self.sources.get(index as usize)?;
            Some((index, source.anew()))
        });
        let mut read: Vec<_> = read.collect();
        // What is wrong by now may be right when all names are known.
        let before: Vec<_> = read
            .iter_mut()
            .map(|(_, source)| lang_expr::analyse(source, names).err())
            .collect();
        let looked = read.iter_mut().zip(before);
        let looked = looked.filter_map(|((index, source), before)| {
            let problems = lang_expr::analyse(source, names).err()?;
            // A variable whose type did not fit has none afterwards, so only the first look could say which it had.
            let has_hint = |problems: &Vec<Problem>| problems.iter().any(|one| one.hint.is_some());
            let before = before.filter(|before| has_hint(before) && !has_hint(&problems));
            Some((*index, before.unwrap_or(problems)))
        });
        looked.collect()
    }

    /// What is known of names.
    pub fn names(&self) -> &Names {
        &self.names
    }

    /// Which sensor variables the texts may name.
    pub fn sensors(&self) -> impl Iterator<Item = usize> {
        let named = |name: &str| {
            self.sources
                .iter()
                .any(|source| source.text().contains(name))
        };
        (0..SENSORS.len()).filter(move |&index| named(SENSORS[index].name))
    }

    fn ready(&mut self, index: Index) -> Result<&Source, Vec<Problem>> {
        let Some(source) = self.sources.get_mut(index as usize) else {
            return Err(Vec::new());
        };
        lang_expr::analyse(source, &mut self.names)?;
        Ok(source)
    }

    /// The value of a text.
    pub fn evaluate(
        &mut self,
        index: Index,
        outside: &mut dyn Outside,
    ) -> Result<Value, Vec<Problem>> {
        self.ready(index)?;
        let source = &self.sources[index as usize];
        lang_expr::evaluate(source, &self.names, &mut self.store, outside)
    }

    /// The truth of a text.
    pub fn truth(&mut self, index: Index, outside: &mut dyn Outside) -> Result<bool, Vec<Problem>> {
        self.ready(index)?;
        let source = &self.sources[index as usize];
        lang_expr::evaluate_bool(source, &self.names, &mut self.store, outside)
    }

    /// The whole number of a text.
    pub fn whole(&mut self, index: Index, outside: &mut dyn Outside) -> Result<i32, Vec<Problem>> {
        self.ready(index)?;
        let source = &self.sources[index as usize];
        lang_expr::evaluate_int(source, &self.names, &mut self.store, outside)
    }

    /// Runs a statement that a block has put together.
    pub fn run_text(
        &mut self,
        statement: &str,
        outside: &mut dyn Outside,
    ) -> Result<(), Vec<Problem>> {
        let mut source = Source::new(statement, Wanted::Statements);
        lang_expr::analyse(&mut source, &mut self.names)?;
        lang_expr::evaluate(&source, &self.names, &mut self.store, outside)?;
        Ok(())
    }

    /// Runs a statement with what a person has typed: what is odd in it is refused.
    pub fn run_typed(
        &mut self,
        statement: &str,
        outside: &mut dyn Outside,
    ) -> Result<(), Vec<Problem>> {
        self.evaluate_text(statement, Wanted::Statements, outside)
            .map(drop)
    }

    /// The value of a text that belongs to no block, but that a person has just typed: what is odd in it is refused.
    pub fn evaluate_text(
        &mut self,
        text: &str,
        wanted: Wanted,
        outside: &mut dyn Outside,
    ) -> Result<Value, Vec<Problem>> {
        let mut source = Source::new(text, wanted);
        lang_expr::analyse(&mut source, &mut self.names)?;
        let odd = source.odd_numbers();
        if !odd.is_empty() {
            return Err(odd);
        }
        lang_expr::evaluate(&source, &self.names, &mut self.store, outside)
    }

    /// Tells each variable that was written since the last time.
    pub fn changed(&mut self, mut tell: impl FnMut(&str, &Value)) {
        self.scratch.extend(self.store.written());
        for &slot in &self.scratch {
            if let Some(value) = self.store.get(slot) {
                tell(self.names.name(slot), value);
            }
        }
        self.scratch.clear();
    }

    /// The slot of a name, which becomes a variable.
    pub fn slot(&mut self, name: &str) -> Option<Slot> {
        self.names.slot(name)
    }

    /// A variable that gets this value from outside.
    pub fn assign(&mut self, name: &str, value: &Value) -> Option<Slot> {
        self.names.declare(name, value)
    }

    pub fn value(&self, slot: Slot) -> Option<Value> {
        self.store.get(slot).cloned()
    }

    /// Sets a value or takes it away.
    pub fn put(&mut self, slot: Slot, value: Option<Value>) {
        match value {
            // One value instead of another one that was there before: the limit was kept then.
            Some(value) => drop(self.store.set(slot, value)),
            None => drop(self.store.remove(slot)),
        }
    }

    pub fn get(&self, name: &str) -> Option<Value> {
        self.value(self.names.find(name)?)
    }

    pub fn variables(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.names
            .variables()
            .filter_map(|(slot, name, _)| Some((name, self.store.get(slot)?)))
    }
}
