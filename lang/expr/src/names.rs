//! All names of a project: what each one is, its inferred type, and a number that changes when a type does.
//!
//! Variables are global to a project, as in the real program. Knows no texts and no values but constants.

use super::reserved::{self, Function, Kit, SENSORS, SensorIndex, Shape};
use super::types::{Element, Possible, Type, Types, Variable};
use super::value::{Compat, Value};
use crate::limits;
use std::collections::HashMap;
use std::rc::Rc;

/// A name by its number: the place of its value in a store.
pub type Slot = u32;

/// What a name is.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A variable of the program.
    Variable,
    /// A variable that the robot refreshes.
    Sensor(SensorIndex),
    /// A port, a button, pi.
    Constant(Value),
    /// A function.
    Function(Function),
}

/// Who saw a name first: a reading of a text, and the node in it.
pub(super) type Declaration = (u32, u32);

#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) name: Rc<str>,
    pub(super) kind: Kind,
    pub(super) variable: Variable,
    /// `None`: not yet seen by the types.
    pub(super) declared: Option<Declaration>,
}

/// What divides a name from whose own it is; no text has it in a name.
const OWNER: char = '@';

/// The name that stands for `name` where it belongs to the owner of this number alone.
pub fn own_name(name: &str, owner: u32) -> Rc<str> {
    format!("{name}{OWNER}{owner}").into()
}

/// A name as the text has it.
pub fn written(name: &str) -> &str {
    name.split(OWNER).next().unwrap_or(name)
}

/// Whether a name is somebody's own.
pub fn is_own(name: &str) -> bool {
    name.contains(OWNER)
}

/// All names of a project.
#[derive(Clone, Debug)]
pub struct Names {
    slots: HashMap<Rc<str>, Slot>,
    pub(super) entries: Vec<Entry>,
    pub(super) types: Types,
    compat: Compat,
    /// Whether what is no number is an error where a number is needed, instead of 0.
    pub(super) is_strict: bool,
    /// Whether a block gets the low bits of a number beyond 32 bits, instead of the end of the range.
    pub(super) keeps_low_bits: bool,
    /// Whether an integer variable becomes a float one by an assignment; not in the mode of static languages.
    pub(super) widens: bool,
    epoch: u32,
    readings: u32,
}

/// What robots of a kit have, declared by nobody's text.
const ROBOT: Declaration = (0, 0);

impl Names {
    /// The names of a kit.
    pub fn new(kit: Kit, compat: Compat) -> Self {
        let mut names = Self {
            slots: HashMap::new(),
            entries: Vec::new(),
            types: Types::new(compat == Compat::Fixed),
            compat,
            is_strict: false,
            keeps_low_bits: false,
            widens: true,
            epoch: 0,
            readings: 0,
        };
        for &(name, function, ..) in &reserved::FUNCTIONS {
            names.reserve(name, Kind::Function(function), Type::Function);
        }
        let pi = Kind::Constant(Value::Float(std::f64::consts::PI));
        names.reserve("pi", pi, Type::Float);
        for port in reserved::PORTS.iter().chain(reserved::ports_of(kit)) {
            names.reserve(port, Kind::Constant(Value::text(*port)), Type::Text);
        }
        for (name, port) in reserved::look_alikes(kit) {
            names.reserve(&name, Kind::Constant(Value::text(port)), Type::Text);
        }
        for (name, code) in reserved::BUTTONS {
            names.reserve(name, Kind::Constant(Value::Int(code)), Type::Int);
        }
        for (index, sensor) in (0..).zip(&SENSORS) {
            let of = match sensor.shape {
                Shape::Number => Type::Int,
                Shape::Numbers(_) => names.types.table(Element::Settled(Type::Int)),
            };
            names.reserve(sensor.name, Kind::Sensor(index), of);
        }
        names
    }

    /// The same, where an element of a table that is no number is an error instead of 0, if a number is needed.
    #[must_use]
    pub fn strict(self) -> Self {
        Self {
            is_strict: true,
            ..self
        }
    }

    /// The same, where a block gets the low bits of a number beyond 32 bits, as the real program's cast gives them.
    #[must_use]
    pub fn with_low_bits(self) -> Self {
        Self {
            keeps_low_bits: true,
            ..self
        }
    }

    /// Makes a sensor variable a name that nobody knows yet, because the robot has no such sensor.
    pub fn forget_sensor(&mut self, name: &str) {
        let Some(slot) = self.find(name) else {
            return;
        };
        let variable = self.types.variable(Possible::one(Type::Any));
        let entry = &mut self.entries[slot as usize];
        if matches!(entry.kind, Kind::Sensor(_)) {
            entry.kind = Kind::Variable;
            entry.variable = variable;
            entry.declared = None;
        }
    }

    /// Makes a name that nobody has said yet the variable of one more sensor, which gives whole numbers; its number is what
    /// [`super::Outside`] is asked for.
    pub fn add_sensor(&mut self, name: &str, sensor: SensorIndex) {
        self.reserve(name, Kind::Sensor(sensor), Type::Int);
    }

    /// The names of a kit for the generators of static languages: an assignment that would widen a variable is told as
    /// a warning and leaves the variable's type alone.
    pub fn with_static_types(kit: Kit, compat: Compat) -> Self {
        Self {
            widens: false,
            ..Self::new(kit, compat)
        }
    }

    fn reserve(&mut self, name: &str, kind: Kind, of: Type) {
        let variable = self.types.variable(Possible::one(of));
        let slot = Slot::try_from(self.entries.len()).unwrap_or(Slot::MAX);
        let name: Rc<str> = name.into();
        self.slots.insert(name.clone(), slot);
        self.entries.push(Entry {
            name,
            kind,
            variable,
            declared: Some(ROBOT),
        });
    }

    /// How exactly the oddities are kept.
    pub fn compat(&self) -> Compat {
        self.compat
    }

    /// The slot of a name that is known.
    pub fn find(&self, name: &str) -> Option<Slot> {
        self.slots.get(name).copied()
    }

    /// The slot of a name, which becomes a variable if it is new; `None` if there are too many.
    pub fn slot(&mut self, name: &str) -> Option<Slot> {
        if let Some(&slot) = self.slots.get(name) {
            return Some(slot);
        }
        if self.entries.len() >= limits::NAMES_MAX {
            return None;
        }
        self.reserve(name, Kind::Variable, Type::Any);
        let slot = Slot::try_from(self.entries.len() - 1).unwrap_or(Slot::MAX);
        self.entries[slot as usize].declared = None;
        Some(slot)
    }

    /// How many names there are; slots are below this.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Never: functions are always there.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The name of a slot.
    pub fn name(&self, slot: Slot) -> &str {
        self.entries
            .get(slot as usize)
            .map_or("", |entry| &entry.name)
    }

    /// What a slot's name is.
    pub fn kind(&self, slot: Slot) -> Option<&Kind> {
        self.entries.get(slot as usize).map(|entry| &entry.kind)
    }

    /// What is known of a slot's type: a settled type, or [`Type::Any`].
    pub fn type_of(&self, slot: Slot) -> Type {
        let Some(entry) = self.entries.get(slot as usize) else {
            return Type::Any;
        };
        let possible = self.types.get(entry.variable);
        if possible.is_settled() {
            possible.first()
        } else {
            Type::Any
        }
    }

    /// The settled type of the elements of a table, or [`Type::Any`].
    pub fn element_of(&self, table: Type) -> Type {
        match self.types.element(table) {
            Some(Element::Settled(one)) => one,
            Some(Element::Variable(variable)) => {
                let possible = self.types.get(variable);
                if possible.is_settled() {
                    possible.first()
                } else {
                    Type::Any
                }
            }
            None => Type::Any,
        }
    }

    /// The name of a type in messages.
    pub fn type_name(&self, of: Type) -> String {
        self.types.name(of)
    }

    /// The program's own variables: slot, name, type, in the order in which they were first seen.
    pub fn variables(&self) -> impl Iterator<Item = (Slot, &str, Type)> {
        (0..)
            .zip(&self.entries)
            .filter(|(_, entry)| matches!(entry.kind, Kind::Variable))
            .map(|(slot, entry)| (slot, &*entry.name, self.type_of(slot)))
    }

    /// Changes whenever a type does; texts that were analysed at this number are still right.
    pub fn epoch(&self) -> u32 {
        self.epoch
    }

    pub(super) fn changed(&mut self) {
        self.epoch = self.epoch.wrapping_add(1);
    }

    /// A number for one reading of a text, never 0.
    pub(super) fn reading(&mut self) -> u32 {
        self.readings = self.readings.wrapping_add(1).max(1);
        self.readings
    }

    /// Declares a variable that gets a value from outside: an actual parameter, a loaded value. What is known of its
    /// type stays; a new one takes the value's type.
    pub fn declare(&mut self, name: &str, value: &Value) -> Option<Slot> {
        let slot = self.slot(name)?;
        if self.entries[slot as usize].declared.is_none() {
            let of = self.type_of_value(value, 0);
            let entry = &mut self.entries[slot as usize];
            entry.declared = Some(ROBOT);
            self.types.set(entry.variable, Possible::one(of));
            self.changed();
        }
        Some(slot)
    }

    /// Gives a variable the type of a value, whatever it was before: of a name that is somebody's own, and gets values from
    /// outside. A variable of floats stays one when a whole number comes. Tells whether that changed anything.
    pub fn retype(&mut self, slot: Slot, value: &Value) -> bool {
        let of = self.type_of_value(value, 0);
        let Some(entry) = self.entries.get_mut(slot as usize) else {
            return false;
        };
        let had = self.types.get(entry.variable);
        let is_same =
            had == Possible::one(of) || (had == Possible::one(Type::Float) && of == Type::Int);
        if entry.declared.is_some() && is_same {
            return false;
        }
        entry.declared = Some(ROBOT);
        self.types.set(entry.variable, Possible::one(of));
        self.changed();
        true
    }

    pub(super) fn type_of_value(&mut self, value: &Value, depth: u16) -> Type {
        match value {
            Value::Nil => Type::Nil,
            Value::Bool(_) => Type::Bool,
            Value::Int(_) => Type::Int,
            Value::Float(_) => Type::Float,
            Value::Text(_) | Value::Unset => Type::Text,
            Value::List(list) => {
                let element = match list.items().first() {
                    Some(first) if depth < limits::LIST_DEPTH_MAX => {
                        self.type_of_value(&first.clone(), depth + 1)
                    }
                    _ => Type::Any,
                };
                self.types.table(Element::Settled(element))
            }
        }
    }
}
