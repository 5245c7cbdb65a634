//! Lists in expressions: what is written as one, its items, and their places.
//!
//! Owns that an index is any value that counts as a number: a truth is 1 or 0 there, as in [`lang_expr`].

use super::{Phrase, Refused, Word, Writer};
use crate::generate::language;
use crate::generate::words;
use lang_expr::tree::{Field, Id, Node};
use lang_expr::{Compat, literal};

/// How long lists in C can become at least where an index is computed.
const COMPUTED_ROOM: i32 = 32;

impl Writer<'_, '_> {
    /// A list gets an item at an index.
    pub(super) fn makes_room(&mut self, index: Id) {
        let room = if let Node::Int(text) = self.source.tree().node(index) {
            let index = literal::whole(text, Compat::Fixed).to_int();
            index.saturating_add(1)
        } else {
            COMPUTED_ROOM
        };
        let room = usize::try_from(room)
            .unwrap_or(0)
            .min(self.plan.items_max());
        self.plan.longest = self.plan.longest.max(room);
    }

    /// An item of a list.
    pub(super) fn item(
        &mut self,
        id: Id,
        (table, index): (Id, Id),
        word: Word,
        depth: usize,
    ) -> Result<Phrase, Refused> {
        let Node::Name(name) = self.source.tree().node(table).clone() else {
            return Err(self.refuse(id, words::no_nested_lists()));
        };
        let table = self.name(id, &name)?;
        let index = self.index(index, depth)?;
        Ok(self.say(word, &[table, index]))
    }

    /// An index: any value that counts as a number.
    pub(super) fn index(&mut self, id: Id, depth: usize) -> Result<Phrase, Refused> {
        let part = self.source.tree().node(id);
        let is_name = matches!(part, Node::Name(_)) && self.constant(id).is_none();
        if !is_name && !matches!(part, Node::Index { .. }) {
            return self.whole(id, depth);
        }
        let value = self.value(id, depth)?;
        let number = self.say(Word::NumberOfAny, &[value]);
        Ok(self.say(Word::Whole, &[number]))
    }

    /// A list that is written down.
    pub(super) fn table(
        &mut self,
        id: Id,
        fields: &[Field],
        depth: usize,
    ) -> Result<Phrase, Refused> {
        let limit = self.plan.items_max();
        if fields.len() > limit {
            return Err(self.refuse(id, words::list_too_long(limit)));
        }
        let mut items = Vec::with_capacity(fields.len());
        for field in fields {
            if field.key.is_some() {
                return Err(self.refuse(id, words::no_such_text()));
            }
            if let Node::Table { .. } = self.source.tree().node(field.value) {
                return Err(self.refuse(field.value, words::no_nested_lists()));
            }
            items.push(self.value(field.value, depth)?.text);
        }
        self.plan.longest = self.plan.longest.max(items.len());
        Ok(Phrase::atom(language::list(self.plan.target, &items)))
    }
}
