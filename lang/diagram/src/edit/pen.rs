//! What changes objects of a save and remembers what they were.
//!
//! Owns the two sides of each change, and the wiring that one change of a person means in both objects of a pair: lists of
//! links, children, calls. Knows no change.

use super::notation::{Notation, Port};
use super::words;
use crate::limits;
use crate::objects::{self, Kind, NOTHING, Object, ROOT};
use crate::project::DiagramKind;
use crate::read::Meta;
use crate::save::{Save, is_link};
use lang_text::problem::Problem;
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// The other side of a change: what the objects were that it touched, or will be.
#[derive(Clone, Debug)]
pub(super) struct Step {
    objects: BTreeMap<String, Option<Object>>,
    meta: Option<Meta>,
    /// Whether the save had been changed before.
    is_edited: bool,
    /// About how much memory it takes.
    pub(super) bytes: usize,
}

impl Step {
    /// Makes the save what is remembered, and remembers what it was.
    pub(super) fn swap(&mut self, save: &mut Save) {
        for (id, side) in &mut self.objects {
            let now = save.objects.take(id);
            if let Some(object) = side.take() {
                // What had the id has just gone.
                let _ = save.objects.add(object);
            }
            *side = now;
        }
        if let Some(meta) = &mut self.meta {
            std::mem::swap(meta, &mut save.meta);
        }
        std::mem::swap(&mut self.is_edited, &mut save.is_edited);
    }

    /// Whether nothing was touched.
    pub(super) fn is_empty(&self) -> bool {
        self.objects.is_empty() && self.meta.is_none()
    }
}

fn size(object: &Object) -> usize {
    let texts = |all: &[String]| all.iter().map(|one| one.len() + 24).sum::<usize>();
    let properties = object.properties.iter();
    let properties = properties.map(|one| one.key.len() + one.value.len() + 64);
    let lists = object
        .lists
        .iter()
        .map(|(name, ids)| name.len() + texts(ids));
    200 + texts(&object.children) + properties.sum::<usize>() + lists.sum::<usize>()
}

/// Images are counted only if another change has let go of them.
fn size_of_meta(meta: &Meta, now: &Meta) -> usize {
    let blobs = match (&meta.blobs, &now.blobs) {
        (Some(old), Some(new)) if Arc::ptr_eq(old, new) => 0,
        (Some(old), _) => old.len(),
        (None, _) => 0,
    };
    let keys = meta.keys.iter().chain(&meta.templates);
    meta.world.as_ref().map_or(0, String::len)
        + blobs
        + keys.map(|(key, one)| key.len() + one.len()).sum::<usize>()
}

/// Ids that nothing has yet.
#[derive(Clone, Debug)]
pub(super) struct Ids {
    seed: u128,
    made: u64,
}

impl Ids {
    pub(super) fn new(seed: u128) -> Self {
        Self { seed, made: 0 }
    }

    /// The id of an object of this kind: a random UUID as far as the seed is random (RFC 9562, version 4).
    fn next(&mut self, path: &str, kind: &str) -> String {
        self.made += 1;
        // Another id of the same seed differs in its last digits.
        let number = self.seed.wrapping_add(u128::from(self.made));
        let number = number & !(0xf << 76) | 4 << 76;
        let number = number & !(0x3 << 62) | 2 << 62;
        let digits = format!("{number:032x}");
        let (a, b, c) = (&digits[..8], &digits[8..12], &digits[12..16]);
        let (d, e) = (&digits[16..20], &digits[20..]);
        format!("qrm:/{path}/{kind}/{{{a}-{b}-{c}-{d}-{e}}}")
    }
}

/// A save while one change is made.
pub(super) struct Pen<'a> {
    /// The language that is drawn.
    pub(super) notation: &'static dyn Notation,
    save: &'a mut Save,
    ids: &'a mut Ids,
    before: BTreeMap<String, Option<Object>>,
    meta: Option<Meta>,
}

impl<'a> Pen<'a> {
    pub(super) fn new(
        notation: &'static dyn Notation,
        save: &'a mut Save,
        ids: &'a mut Ids,
    ) -> Self {
        Self {
            notation,
            save,
            ids,
            before: BTreeMap::new(),
            meta: None,
        }
    }

    /// The way back.
    pub(super) fn finish(self) -> Step {
        let objects = self.before.iter();
        let objects = objects.map(|(id, one)| id.len() + one.as_ref().map_or(0, size));
        let meta = self.meta.as_ref();
        let meta = meta.map_or(0, |old| size_of_meta(old, &self.save.meta));
        let step = Step {
            bytes: objects.sum::<usize>() + meta,
            objects: self.before,
            meta: self.meta,
            is_edited: self.save.is_edited,
        };
        if !step.is_empty() {
            self.save.is_edited = true;
        }
        step
    }

    pub(super) fn get(&self, id: &str) -> Option<&Object> {
        self.save.objects.get(id)
    }

    pub(super) fn get_mut(&mut self, id: &str) -> Option<&mut Object> {
        let now = self.save.objects.get_mut(id)?;
        if !self.before.contains_key(id) {
            self.before.insert(id.to_owned(), Some(now.clone()));
        }
        Some(now)
    }

    pub(super) fn meta(&mut self) -> &mut Meta {
        if self.meta.is_none() {
            self.meta = Some(self.save.meta.clone());
        }
        &mut self.save.meta
    }

    /// The logical object of a graphical one.
    pub(super) fn logical(&self, id: &str) -> Option<&Object> {
        self.get(self.get(id)?.logical.as_deref()?)
    }

    pub(super) fn logical_id(&self, id: &str) -> Option<String> {
        self.get(id)?.logical.clone()
    }

    /// Gives the logical object of a graphical one a text.
    pub(super) fn set_logical(&mut self, id: &str, key: &str, value: &str) {
        let logical = self.logical_id(id);
        if let Some(object) = logical.and_then(|logical| self.get_mut(&logical)) {
            object.set(Kind::Text, key, value);
        }
    }

    /// Takes a text of it away.
    pub(super) fn clear_logical(&mut self, id: &str, key: &str) {
        let logical = self.logical_id(id);
        if let Some(object) = logical.and_then(|logical| self.get_mut(&logical)) {
            object.properties.retain(|one| one.key != key);
        }
    }

    /// Gives it an id.
    pub(super) fn set_logical_id(&mut self, id: &str, key: &str, value: &str) {
        let logical = self.logical_id(id);
        if let Some(object) = logical.and_then(|logical| self.get_mut(&logical)) {
            object.set(Kind::Id, key, value);
        }
    }

    /// Gives both objects of a pair a name.
    pub(super) fn rename(&mut self, id: &str, name: &str) {
        self.set_logical(id, "name", name);
        if let Some(object) = self.get_mut(id) {
            object.set(Kind::Text, "name", name);
        }
    }

    /// Which diagram an object is; nothing if it is none of the language that is drawn.
    pub(super) fn kind_of(&self, object: &Object) -> Option<DiagramKind> {
        let elements = self.notation.elements();
        let is_diagram = object.is_graphical() && object.parent == ROOT;
        match object.element() {
            main if is_diagram && main == elements.main => Some(DiagramKind::Main),
            sub if is_diagram && sub == elements.subprogram => Some(DiagramKind::Subprogram),
            _ => None,
        }
    }

    /// The ports of a block; nothing if the language has none.
    pub(super) fn ports(&self, id: &str) -> Option<Vec<Port>> {
        let kind = objects::element(id);
        self.notation.ports(kind, self.logical(id))
    }

    /// Ids of all diagrams of the language, in the order of the save.
    pub(super) fn diagrams(&self) -> Vec<String> {
        let root = self.get(ROOT).map_or(&[][..], |root| &root.children);
        let is_one = |id: &&String| self.get(id).and_then(|one| self.kind_of(one)).is_some();
        root.iter().filter(is_one).cloned().collect()
    }

    /// Ids of the calls of a diagram.
    pub(super) fn calls_of(&self, diagram: &str) -> Vec<String> {
        let Some(callee) = self.logical_id(diagram) else {
            return Vec::new();
        };
        let objects = self.save.objects.iter();
        let calls = objects.filter(|object| {
            let calls = self
                .logical(&object.id)
                .and_then(|one| one.property("outgoingExplosion"));
            calls == Some(&callee)
        });
        let mut calls: Vec<String> = calls.map(|object| object.id.clone()).collect();
        calls.sort();
        calls
    }

    fn add(&mut self, object: Object) {
        self.before.entry(object.id.clone()).or_insert(None);
        // Its id was looked for before.
        let _ = self.save.objects.add(object);
    }

    /// A diagram without blocks.
    pub(super) fn diagram(&mut self, kind: DiagramKind, name: &str) -> Result<String, Problem> {
        let elements = self.notation.elements();
        let element = match kind {
            DiagramKind::Main => elements.main,
            DiagramKind::Subprogram => elements.subprogram,
        };
        let id = self.pair(element, ROOT, name)?;
        if !elements.has_parameters {
            return Ok(id);
        }
        match kind {
            DiagramKind::Main => self.set_logical(&id, "devicesConfiguration", ""),
            DiagramKind::Subprogram => self.set_logical(&id, "shape", ""),
        }
        Ok(id)
    }

    /// A new pair, listed where it belongs. The id of the graphical one.
    pub(super) fn pair(&mut self, kind: &str, parent: &str, name: &str) -> Result<String, Problem> {
        if self.save.objects.len() + 2 > limits::EDIT_OBJECTS_MAX {
            let most = limits::EDIT_OBJECTS_MAX / 2;
            return Err(Problem::error(words::too_many(most)));
        }
        let (graphical, logical) = (self.fresh(kind), self.fresh(kind));
        let (graphical, logical) = objects::pair(graphical, logical, parent, name);
        let id = graphical.id.clone();
        let is_diagram = self.kind_of(&graphical).is_some();
        if let Some(root) = self.get_mut(ROOT) {
            root.children.push(logical.id.clone());
            if is_diagram {
                root.children.push(id.clone());
            }
        }
        if !is_diagram && let Some(parent) = self.get_mut(parent) {
            parent.children.push(id.clone());
        }
        self.add(graphical);
        self.add(logical);
        Ok(id)
    }

    fn fresh(&mut self, kind: &str) -> String {
        loop {
            let id = self.ids.next(self.notation.elements().path, kind);
            // What was taken back may come again.
            if self.get(&id).is_none() && !self.before.contains_key(&id) {
                return id;
            }
        }
    }

    /// An end of a link at a block, in both objects of both.
    pub(super) fn attach(&mut self, link: &str, key: &str, block: &str) {
        let (logical_link, logical_block) = (self.logical_id(link), self.logical_id(block));
        let pairs = [
            (Some(link.to_owned()), Some(block.to_owned())),
            (logical_link, logical_block),
        ];
        for (link, block) in pairs {
            let (Some(link), Some(block)) = (link, block) else {
                continue;
            };
            if let Some(object) = self.get_mut(&link) {
                object.set(Kind::Id, key, &block);
            }
            if let Some(object) = self.get_mut(&block) {
                let links = object.list_mut("links");
                if !links.contains(&link) {
                    links.push(link);
                }
            }
        }
    }

    /// Both ends of a link hang loose.
    pub(super) fn detach(&mut self, link: &str) {
        self.detach_ends(link, &["from", "to"]);
    }

    /// Some of the ends of a link hang loose.
    pub(super) fn detach_ends(&mut self, link: &str, ends: &[&str]) {
        let both = [Some(link.to_owned()), self.logical_id(link)];
        for link in both.into_iter().flatten() {
            for key in ends {
                let end = self.get(&link).and_then(|one| one.property(key));
                let Some(end) = end.map(str::to_owned) else {
                    continue;
                };
                if let Some(object) = self.get_mut(&end).filter(|_| objects::is_object(&end)) {
                    object.list_mut("links").retain(|one| *one != link);
                }
                if let Some(object) = self.get_mut(&link) {
                    object.set(Kind::Id, key, ROOT);
                }
            }
        }
    }

    /// Takes graphical objects away, links before the blocks at their ends, and logical ones that are of no other.
    pub(super) fn remove_pairs(&mut self, ids: &[String]) {
        for id in ids {
            if self.get(id).is_some_and(is_link) {
                self.detach(id);
            }
        }
        let gone: HashSet<&str> = ids.iter().map(String::as_str).collect();
        let mut parents = HashSet::from([ROOT.to_owned()]);
        let mut logical = HashSet::new();
        for object in ids.iter().filter_map(|id| self.get(id)) {
            parents.insert(object.parent.clone());
            logical.extend(object.logical.clone());
        }
        for object in self.save.objects.iter() {
            if let Some(used) = &object.logical
                && !gone.contains(&*object.id)
            {
                logical.remove(used);
            }
        }
        for id in &logical {
            self.forget_call(id);
        }
        for parent in parents {
            if let Some(parent) = self.get_mut(&parent) {
                let stays = |child: &String| !gone.contains(&**child) && !logical.contains(child);
                parent.children.retain(stays);
            }
        }
        for id in ids.iter().chain(&logical) {
            self.take(id);
        }
    }

    /// A subprogram is called by a logical object no longer.
    pub(super) fn forget_call(&mut self, caller: &str) {
        let callee = self
            .get(caller)
            .and_then(|one| one.property("outgoingExplosion"));
        let callee = callee.filter(|id| *id != NOTHING).map(str::to_owned);
        if let Some(callee) = callee.and_then(|callee| self.get_mut(&callee)) {
            let calls = callee.list_mut("incomingExplosions");
            calls.retain(|one| one != caller);
        }
    }

    fn take(&mut self, id: &str) {
        if let Some(object) = self.save.objects.take(id) {
            self.before.entry(id.to_owned()).or_insert(Some(object));
        }
    }
}
