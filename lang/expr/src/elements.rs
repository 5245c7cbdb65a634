//! Tables while a text runs: their elements read and assigned, and tables as they are written.
//!
//! Owns the meaning of indices; a table itself is in `value`.

use super::code::{Base, Span};
use super::run::Run;
use super::tree::Id;
use super::value::{List, ListError, Value};
use super::words::Reason;
use crate::limits;
use std::rc::Rc;

impl Run<'_> {
    #[cold]
    fn list_fault(&mut self, error: ListError, id: Id) {
        let reason = match error {
            ListError::Negative => Reason::NegativeIndex,
            ListError::TooLong => Reason::ValueTooLong,
            ListError::TooDeep => Reason::ValueTooDeep,
        };
        self.fault(reason, id);
    }

    fn base(&mut self, base: Base) -> Option<Rc<List>> {
        match base {
            Base::Variable(slot) => self.store.get(slot).and_then(Value::list).cloned(),
            Base::Sensor(sensor) => self.outside.sensor(sensor).into_list(),
            Base::Constant => None,
        }
    }

    pub(super) fn element(&mut self, id: Id, base: Base, index: Id) -> Value {
        let index = self.whole(index);
        if let Base::Variable(slot) = base
            && let Some(Value::List(list)) = self.store.get(slot)
            && let Ok(index) = usize::try_from(index)
        {
            return list.items().get(index).cloned().unwrap_or_default();
        }
        let list = self.base(base);
        self.element_of(id, list.as_deref(), index)
    }

    fn element_of(&mut self, id: Id, list: Option<&List>, index: i32) -> Value {
        let Ok(index) = usize::try_from(index) else {
            self.fault(Reason::NegativeIndex, id);
            return Value::Nil;
        };
        list.and_then(|list| list.items().get(index).cloned())
            .unwrap_or_default()
    }

    /// The indices of an element, computed from the last to the first, as the real program does.
    fn indices(&mut self, ids: &[Id]) -> ([i32; limits::LIST_DEPTH_MAX as usize], usize) {
        let mut path = [0; limits::LIST_DEPTH_MAX as usize];
        for (place, &id) in path.iter_mut().zip(ids).rev() {
            *place = self.whole(id);
        }
        (path, ids.len().min(path.len()))
    }

    pub(super) fn elements(&mut self, id: Id, base: Base, span: Span) -> Value {
        let code = self.code;
        let (path, count) = self.indices(code.operands(span));
        let mut found = self.base(base).map_or(Value::Nil, Value::List);
        for &index in &path[..count] {
            let list = found.into_list();
            if list.is_none() && index >= 0 {
                return Value::Nil;
            }
            if index < 0 {
                self.fault(Reason::NegativeIndex, id);
                return Value::Nil;
            }
            found = self.element_of(id, list.as_deref(), index);
        }
        found
    }

    pub(super) fn assign_element(&mut self, id: Id, base: Base, span: Span) {
        let code = self.code;
        let Some((&value, ids)) = code.operands(span).split_last() else {
            return;
        };
        let value = self.value(value);
        let (path, count) = self.indices(ids);
        let Base::Variable(slot) = base else {
            return;
        };
        let had = self.store.remove(slot).and_then(Value::into_list);
        let mut list = had.unwrap_or_default();
        // A list that somebody else has, too, is copied, and so may be a list in it.
        let may_copy = Rc::strong_count(&list) > 1 || count > 1;
        if may_copy && !self.pay(list.cells(), id) {
            let _ = self.store.set(slot, Value::List(list));
            return;
        }
        let before = list.cells();
        let outcome = Rc::make_mut(&mut list).put_at(&path[..count], value);
        let grown = list.cells().saturating_sub(before);
        if let Err(error) = outcome {
            self.list_fault(error, id);
        }
        self.pay(grown, id);
        if self.store.set(slot, Value::List(list)).is_err() {
            self.fault(Reason::StoreFull, id);
        }
    }

    pub(super) fn table(&mut self, id: Id, span: Span) -> Value {
        let code = self.code;
        let pairs = code.operands(span);
        let mut list = List::default();
        for pair in pairs.chunks_exact(2) {
            let (key, value) = (pair[0], pair[1]);
            let outcome = if key == value {
                let value = self.value(value);
                let end = i32::try_from(list.items().len()).unwrap_or(i32::MAX);
                list.put(end, value, &Value::Nil)
            } else {
                let key = self.whole(key);
                let value = self.value(value);
                if self.is_fixed {
                    list.put(key, value, &Value::Nil)
                } else {
                    // The real program keeps texts here.
                    list.put(key, Value::Text(value.to_text()), &Value::text(""))
                }
            };
            if let Err(error) = outcome {
                self.list_fault(error, id);
                break;
            }
        }
        if !self.pay(list.cells(), id) {
            return Value::Nil;
        }
        Value::List(Rc::new(list))
    }
}
