//! A save to the pieces of a zip: changed objects into their documents, changed texts into their files.

use super::Save;
use crate::archive::Entry;
use crate::objects::{self, Object};
use crate::read::{BLOBS_FILE, META_FILE, Meta, TEMPLATES, WORLD_FILE};
use lang_text::problem::Problem;
use lang_text::xml::{self, Element, Node};
use std::collections::{BTreeMap, HashMap};

/// Spaces for a level in object files, and in others.
const OBJECT_INDENT: usize = 2;
const META_INDENT: usize = 4;

/// The files of a save.
pub(super) fn entries(save: &Save) -> Result<Vec<Entry>, Problem> {
    if !save.is_edited {
        return Ok(save.archive.entries.clone());
    }
    let mut entries = Vec::with_capacity(save.archive.entries.len());
    let kept: HashMap<usize, &Object> = save
        .objects
        .iter()
        .filter_map(|object| Some((object.entry?, object)))
        .collect();
    for (at, entry) in save.archive.entries.iter().enumerate() {
        if !objects::is_object_file(&entry.name) {
            entries.push(entry.clone());
        } else if let Some(object) = kept.get(&at) {
            entries.push(changed(entry, at, object)?);
        }
    }
    let new = save.objects.iter().filter(|object| object.entry.is_none());
    let mut new: Vec<&Object> = new.collect();
    // The same objects make the same file, however they came to be.
    new.sort_by(|one, other| one.id.cmp(&other.id));
    for object in new {
        let document = Element::new("object");
        entries.push(filed(object, document, path(object)));
    }
    write_meta(save, &mut entries)?;
    Ok(entries)
}

/// The file of an object: as it came if the object is as it came.
fn changed(entry: &Entry, at: usize, object: &Object) -> Result<Entry, Problem> {
    let text = std::str::from_utf8(&entry.bytes).unwrap_or_default();
    let document = xml::parse(text)?;
    let old = Object::from_document(&document, &mut 0, &mut Vec::new())?;
    let old = Object {
        entry: Some(at),
        ..old
    };
    if old == *object {
        return Ok(entry.clone());
    }
    let name = match old.id == object.id {
        true => entry.name.clone(),
        false => path(object),
    };
    Ok(filed(object, document, name))
}

/// Where an object's file belongs.
fn path(object: &Object) -> String {
    let model = match object.is_graphical() {
        true => "graphical",
        false => "logical",
    };
    let id = object.id.strip_prefix(objects::NOTHING);
    format!("tree/{model}/{}", id.unwrap_or_default())
}

fn filed(object: &Object, mut document: Element<'_>, name: String) -> Entry {
    document.set("parent", &object.parent);
    document.set("id", &object.id);
    match &object.logical {
        Some(logical) => document.set("logicalId", logical),
        None => _ = document.take("logicalId"),
    }
    document.child_mut("children").nodes = references(&object.children);
    let properties = document.child_mut("properties");
    let is_new = properties.nodes.is_empty();
    properties.nodes.retain_mut(|node| match node {
        Node::Element(tag) => keep(tag, object),
        Node::Text(_) | Node::Comment(_) => true,
    });
    add_new(properties, object);
    if is_new {
        // Qt keeps properties by name.
        properties
            .nodes
            .sort_by(|one, other| key(one).cmp(key(other)));
    }
    Entry {
        name,
        bytes: xml::write(&document, OBJECT_INDENT).into_bytes(),
    }
}

/// Brings the tag of a property up to date; `false` if the object has it no longer.
fn keep(tag: &mut Element<'_>, object: &Object) -> bool {
    if is_list(tag) {
        let list = object.lists.iter().find(|(name, _)| *name == tag.name);
        if let Some((_, ids)) = list {
            tag.nodes = references(ids);
        }
        return list.is_some();
    }
    if !objects::is_known(&tag.name) {
        return true;
    }
    let Some(key) = tag.attribute("key") else {
        return true;
    };
    let value = object.property(key).map(str::to_owned);
    if let Some(value) = &value
        && tag.attribute("value") != Some(value)
    {
        tag.set("value", value);
    }
    value.is_some()
}

/// Adds tags for properties that have none yet.
fn add_new(properties: &mut Element<'_>, object: &Object) {
    for property in &object.properties {
        let is_there = |tag: &Element<'_>| {
            !is_list(tag)
                && objects::is_known(&tag.name)
                && tag.attribute("key") == Some(&property.key)
        };
        if !properties.elements().any(is_there) {
            let tag = Element::new(property.kind.tag())
                .with("key", property.key.clone())
                .with("value", property.value.clone());
            properties.nodes.push(Node::Element(tag));
        }
    }
    for (name, ids) in &object.lists {
        let is_there = |tag: &Element<'_>| is_list(tag) && tag.name == *name;
        if !properties.elements().any(is_there) {
            let mut tag = Element::new(name.clone()).with("type", "qReal::IdList");
            tag.nodes = references(ids);
            properties.nodes.push(Node::Element(tag));
        }
    }
}

fn is_list(tag: &Element<'_>) -> bool {
    tag.attribute("type") == Some(objects::ID_LIST)
}

fn key<'a>(node: &'a Node<'_>) -> &'a str {
    match node {
        Node::Element(tag) => tag.attribute("key").unwrap_or(&tag.name),
        Node::Text(_) | Node::Comment(_) => "",
    }
}

fn references<'a>(ids: &[String]) -> Vec<Node<'a>> {
    let reference = |id: &String| Node::Element(Element::new("object").with("id", id.clone()));
    ids.iter().map(reference).collect()
}

/// Brings the texts of the save up to date, and the keys that were kept before they had files of their own.
fn write_meta(save: &Save, entries: &mut Vec<Entry>) -> Result<(), Problem> {
    let old = Meta::read(&save.archive, &mut Vec::new());
    let mut gone = Vec::new();
    if old.world != save.meta.world {
        put(entries, WORLD_FILE, save.meta.world.as_deref());
        gone.push("worldModel".to_owned());
    }
    if old.blobs != save.meta.blobs {
        put(entries, BLOBS_FILE, save.meta.blobs.as_deref());
        gone.push("blobs".to_owned());
    }
    let (old_templates, new_templates) = (&old.templates, &save.meta.templates);
    let names: BTreeMap<&String, ()> = old_templates
        .keys()
        .chain(new_templates.keys())
        .map(|name| (name, ()))
        .collect();
    for name in names.into_keys() {
        let text = new_templates.get(name);
        if old_templates.get(name) != text {
            put(
                entries,
                &format!("{TEMPLATES}{name}"),
                text.map(String::as_str),
            );
            gone.push(format!("templates.{}", name.trim_end_matches(".xml")));
        }
    }
    let place = entries.iter().position(|entry| entry.name == META_FILE);
    if place.is_some() && gone.is_empty() && old.keys == save.meta.keys {
        return Ok(());
    }
    let text = place
        .map(|at| entries[at].bytes.clone())
        .unwrap_or_default();
    let text = String::from_utf8(text).unwrap_or_default();
    let document = match text.is_empty() {
        true => Element::new("metaInformation"),
        false => xml::parse(&text)?,
    };
    let text = keys(document, &save.meta, &gone);
    put(entries, META_FILE, Some(&text));
    Ok(())
}

/// The document of the keys, with new values; what is no key of ours stays.
fn keys(mut document: Element<'_>, meta: &Meta, gone: &[String]) -> String {
    document.nodes.retain_mut(|node| {
        let Node::Element(info) = node else {
            return true;
        };
        let Some(key) = info.attribute("key").filter(|_| info.name == "info") else {
            return true;
        };
        if Meta::has_place(key) {
            return !gone.iter().any(|gone| gone == key);
        }
        let value = meta.keys.get(key).cloned();
        if let Some(value) = &value {
            info.set("value", value);
        }
        value.is_some()
    });
    for (key, value) in &meta.keys {
        let is_there = |info: &Element<'_>| info.attribute("key") == Some(key);
        if !document.elements().any(is_there) {
            let is_truth = value == "true" || value == "false";
            let info = Element::new("info")
                .with("key", key.clone())
                .with("value", value.clone())
                .with("type", if is_truth { "bool" } else { "QString" });
            document.nodes.push(Node::Element(info));
        }
    }
    xml::write(&document, META_INDENT)
}

/// Gives a file a text, or takes it away.
fn put(entries: &mut Vec<Entry>, name: &str, text: Option<&str>) {
    let place = entries.iter().position(|entry| entry.name == name);
    match (place, text) {
        (Some(at), Some(text)) => entries[at].bytes = text.as_bytes().to_vec(),
        (Some(at), None) => _ = entries.remove(at),
        (None, Some(text)) => entries.push(Entry {
            name: name.to_owned(),
            bytes: text.as_bytes().to_vec(),
        }),
        (None, None) => {}
    }
}
