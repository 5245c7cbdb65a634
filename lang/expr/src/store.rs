//! The values of a project's variables, by slot, and which of them were written lately.

use super::names::Slot;
use super::value::Value;
use crate::limits;

/// How many writes are remembered for a watcher.
const REMEMBERED: usize = 64;

/// Values by slot.
#[derive(Clone, Debug, Default)]
pub struct Store {
    values: Vec<Option<Value>>,
    cells: u32,
    written: Vec<Slot>,
}

impl Store {
    /// The value of a slot, if it has one.
    pub fn get(&self, slot: Slot) -> Option<&Value> {
        self.values.get(slot as usize)?.as_ref()
    }

    /// Sets a value; gives it back if all values together would hold more than `limits::STORE_CELLS_MAX`.
    pub fn set(&mut self, slot: Slot, value: Value) -> Result<(), Value> {
        if self.set_like(slot, &value) {
            return Ok(());
        }
        let index = slot as usize;
        if index >= self.values.len() {
            if index >= limits::NAMES_MAX {
                return Err(value);
            }
            self.values.resize(index + 1, None);
        }
        let old = self.values[index].as_ref().map_or(0, Value::cells);
        let cells = self.cells.saturating_sub(old).saturating_add(value.cells());
        if cells > limits::STORE_CELLS_MAX {
            return Err(value);
        }
        self.cells = cells;
        self.values[index] = Some(value);
        self.note(slot);
        Ok(())
    }

    /// Sets a number or truth where there is one of the same type, which costs no more than that; whether there was.
    #[inline]
    pub fn set_like(&mut self, slot: Slot, value: &Value) -> bool {
        let place = self.values.get_mut(slot as usize).and_then(Option::as_mut);
        match (value, place) {
            (Value::Int(number), Some(Value::Int(place))) => *place = *number,
            (Value::Float(number), Some(Value::Float(place))) => *place = *number,
            (Value::Bool(truth), Some(Value::Bool(place))) => *place = *truth,
            (Value::Int(_) | Value::Float(_) | Value::Bool(_), Some(_) | None)
            | (Value::Nil | Value::Text(_) | Value::Unset | Value::List(_), _) => return false,
        }
        self.note(slot);
        true
    }

    /// What all values together weigh.
    pub fn cells(&self) -> u32 {
        self.cells
    }

    /// Takes a value away: the variable has none until it is set again.
    pub fn remove(&mut self, slot: Slot) -> Option<Value> {
        let value = self.values.get_mut(slot as usize)?.take();
        if let Some(value) = &value {
            self.cells = self.cells.saturating_sub(value.cells());
        }
        value
    }

    /// Takes all values away.
    pub fn clear(&mut self) {
        self.values.clear();
        self.written.clear();
        self.cells = 0;
    }

    #[inline]
    fn note(&mut self, slot: Slot) {
        if self.written.last() == Some(&slot) {
            return;
        }
        if self.written.len() == REMEMBERED {
            // Where nobody looks it does not matter.
            self.written.clear();
        }
        self.written.push(slot);
    }

    /// Slots written since the last call, oldest first; a slot may come more than once, and the oldest are forgotten
    /// when nobody asks.
    pub fn written(&mut self) -> std::vec::Drain<'_, Slot> {
        self.written.drain(..)
    }
}
