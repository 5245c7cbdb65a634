//! Objects that are in a save but in no diagram: what earlier editors left behind when a block was deleted.

use super::{Save, is_link};
use crate::objects::{self, Object, Objects, ROOT};
use std::collections::HashSet;

/// A block or link that no diagram lists.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Orphan {
    /// Id of the graphical object.
    pub id: String,
    /// Its type, as `Timer`.
    pub kind: String,
    /// Its label.
    pub name: String,
}

impl Save {
    /// What is in the save but in no diagram, in the order of the save.
    pub fn orphans(&self) -> Vec<Orphan> {
        let reached = reached(&self.objects);
        let graphical = self.objects.iter().filter(|object| object.is_graphical());
        let orphans = graphical.filter(|object| !reached.contains(&*object.id));
        let orphan = |object: &Object| Orphan {
            id: object.id.clone(),
            kind: object.element().to_owned(),
            name: object.property("name").unwrap_or_default().to_owned(),
        };
        orphans.map(orphan).collect()
    }

    /// Puts orphans back: each object into the list of its parent, each link into the lists of the blocks at its ends.
    /// Gives how many objects and ends were put back. What has no parent any more stays as it is.
    pub fn recover_orphans(&mut self) -> usize {
        let mut recovered = 0;
        let listed: HashSet<String> = self
            .objects
            .iter()
            .flat_map(|object| object.children.iter().cloned())
            .collect();
        let lost: Vec<(String, String)> = self
            .objects
            .iter()
            .filter(|object| object.id != ROOT && !listed.contains(&object.id))
            .map(|object| (object.parent.clone(), object.id.clone()))
            .collect();
        for (parent, id) in lost {
            if let Some(parent) = self.objects.get_mut(&parent) {
                parent.children.push(id);
                recovered += 1;
            }
        }
        let ends: Vec<(String, String)> = self
            .objects
            .iter()
            .filter(|object| is_link(object))
            .flat_map(|link| {
                let ends = ["from", "to"].map(|key| link.property(key).unwrap_or_default());
                ends.map(|end| (end.to_owned(), link.id.clone()))
            })
            .filter(|(end, _)| objects::is_object(end))
            .collect();
        let mut known: HashSet<(String, String)> = HashSet::new();
        for object in self.objects.iter() {
            let links = object.list("links").iter();
            known.extend(links.map(|link| (object.id.clone(), link.clone())));
        }
        for (end, link) in ends {
            if known.contains(&(end.clone(), link.clone())) {
                continue;
            }
            if let Some(block) = self.objects.get_mut(&end) {
                block.list_mut("links").push(link.clone());
                known.insert((end, link));
                recovered += 1;
            }
        }
        self.is_edited |= recovered > 0;
        recovered
    }

    /// Takes orphans out of the save, with the logical objects that only they have, and names of them out of all lists.
    /// Gives how many objects are gone.
    pub fn remove_orphans(&mut self) -> usize {
        let reached = reached(&self.objects);
        let mut kept: HashSet<String> = reached.iter().map(|id| (*id).to_owned()).collect();
        kept.insert(ROOT.to_owned());
        for object in self.objects.iter().filter(|one| reached.contains(&*one.id)) {
            kept.extend(object.logical.clone());
        }
        let before = self.objects.len();
        self.objects.retain(|object| kept.contains(&object.id));
        for object in self.objects.iter_mut() {
            object.children.retain(|id| kept.contains(id));
            for (_, ids) in &mut object.lists {
                ids.retain(|id| kept.contains(id));
            }
        }
        let removed = before - self.objects.len();
        self.is_edited |= removed > 0;
        removed
    }
}

/// Ids of diagrams that the root lists, and of what they list.
fn reached(objects: &Objects) -> HashSet<&str> {
    let mut reached = HashSet::new();
    let children = |id: &str| objects.get(id).map_or(&[][..], |object| &object.children);
    for diagram in children(ROOT).iter().filter_map(|id| objects.get(id)) {
        if diagram.is_graphical() {
            reached.insert(diagram.id.as_str());
            reached.extend(diagram.children.iter().map(String::as_str));
        }
    }
    reached
}
