//! The objects of a save as they are kept: pairs of a logical and a graphical one, with properties and lists of ids.
//!
//! Owns what an object file says. Knows neither what a diagram is nor what a block does; the graph is made in
//! [`super::read`].

use super::archive::Entry;
use crate::limits;
use lang_text::problem::{Problem, keep};
use lang_text::xml::{self, Element};
use std::collections::HashMap;
use std::collections::hash_map::Entry as Slot;

mod words;

/// Id of the object in which all others are.
pub const ROOT: &str = "qrm:/ROOT_ID/ROOT_ID/ROOT_ID/ROOT_ID";
/// Type of a property that is a list of ids.
pub const ID_LIST: &str = "qReal::IdList";
/// Id of nothing.
pub const NOTHING: &str = "qrm:/";

/// How the value of a property is written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Kind {
    /// `QString`.
    Text,
    /// `int`, `uint`, `double` or `char`.
    Number(&'static str),
    /// `bool`.
    Truth,
    /// `QStringList`: joined by commas.
    Texts,
    /// `QPointF`, `QSize`, `QSizeF`, `QPoint`, `QPolygon`, `QPolygonF`: numbers of the canvas.
    Shape(&'static str),
    /// `qReal::Id`.
    Id,
}

impl Kind {
    /// All tags that there are, with what they mean.
    const ALL: [(&'static str, Kind); 14] = [
        ("QString", Kind::Text),
        ("qReal::Id", Kind::Id),
        ("int", Kind::Number("int")),
        ("double", Kind::Number("double")),
        ("QPointF", Kind::Shape("QPointF")),
        ("QPolygon", Kind::Shape("QPolygon")),
        ("bool", Kind::Truth),
        ("QStringList", Kind::Texts),
        ("uint", Kind::Number("uint")),
        ("char", Kind::Number("char")),
        ("QPoint", Kind::Shape("QPoint")),
        ("QSize", Kind::Shape("QSize")),
        ("QSizeF", Kind::Shape("QSizeF")),
        ("QPolygonF", Kind::Shape("QPolygonF")),
    ];

    fn of(tag: &str) -> Option<Kind> {
        Self::ALL
            .iter()
            .find(|(name, _)| *name == tag)
            .map(|(_, kind)| *kind)
    }

    /// The tag in the file.
    pub fn tag(self) -> &'static str {
        match self {
            Kind::Text => "QString",
            Kind::Number(tag) | Kind::Shape(tag) => tag,
            Kind::Truth => "bool",
            Kind::Texts => "QStringList",
            Kind::Id => "qReal::Id",
        }
    }
}

/// A property with one value.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Property {
    /// How the value is written.
    pub kind: Kind,
    /// Its name.
    pub key: String,
    /// Its value as written.
    pub value: String,
}

/// One object of a save.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Object {
    /// Its id.
    pub id: String,
    /// Id of the object in which it is.
    pub parent: String,
    /// Id of its logical object, if it is a graphical one.
    pub logical: Option<String>,
    /// Ids of what is in it, in order.
    pub children: Vec<String>,
    /// Properties with one value, in the order of the file.
    pub properties: Vec<Property>,
    /// Properties that are lists of ids.
    pub lists: Vec<(String, Vec<String>)>,
    /// Which entry of the save it came from.
    pub entry: Option<usize>,
}

/// The third part of an id: what it is an object of, as `ControlFlow`.
pub fn element(id: &str) -> &str {
    let parts = id.strip_prefix(NOTHING).unwrap_or_default();
    parts.split('/').nth(2).unwrap_or_default()
}

/// Whether a text can be the id of an object: it is a path in the save too, so it must not lead out of it.
fn is_id(text: &str) -> bool {
    let is_part = |part: &str| !part.is_empty() && !part.starts_with('.');
    let parts = text.strip_prefix(NOTHING).filter(|parts| {
        parts.len() <= limits::ENTRY_NAME_BYTES / 2
            && !parts.contains(|c: char| c.is_control() || c == '\\')
    });
    parts.is_some_and(|parts| parts.split('/').all(is_part))
}

/// Whether the tag of a property is one that [`Kind`] knows.
pub fn is_known(tag: &str) -> bool {
    Kind::of(tag).is_some()
}

/// Whether an id names an object: neither nothing nor the root, which unconnected ends name.
pub fn is_object(id: &str) -> bool {
    !id.is_empty() && id != NOTHING && id != ROOT
}

impl Object {
    /// What it is, as `ControlFlow`.
    pub fn element(&self) -> &str {
        element(&self.id)
    }

    /// Whether it has a place on the canvas.
    pub fn is_graphical(&self) -> bool {
        self.logical.is_some()
    }

    /// Value of a property.
    pub fn property(&self, key: &str) -> Option<&str> {
        self.properties
            .iter()
            .find(|property| property.key == key)
            .map(|property| property.value.as_str())
    }

    /// Gives a property a value; a new one gets its kind and stands where the names' order has it, as Qt sorts them.
    pub fn set(&mut self, kind: Kind, key: &str, value: &str) {
        match self.properties.iter_mut().find(|one| one.key == key) {
            Some(old) => value.clone_into(&mut old.value),
            None => {
                let at = self
                    .properties
                    .partition_point(|one| one.key.as_str() < key);
                let (key, value) = (key.to_owned(), value.to_owned());
                self.properties.insert(at, Property { kind, key, value });
            }
        }
    }

    /// A list of ids; empty if there is none.
    pub fn list(&self, key: &str) -> &[String] {
        self.lists
            .iter()
            .find(|(name, _)| name == key)
            .map_or(&[], |(_, ids)| ids)
    }

    /// A list of ids, to be changed; made if it is not there.
    pub fn list_mut(&mut self, key: &str) -> &mut Vec<String> {
        let at = match self.lists.iter().position(|(name, _)| name == key) {
            Some(at) => at,
            None => {
                self.lists.push((key.to_owned(), Vec::new()));
                self.lists.len() - 1
            }
        };
        &mut self.lists[at].1
    }
}

/// All objects of a save.
#[derive(Clone, Debug, Default)]
pub struct Objects {
    list: Vec<Object>,
    places: HashMap<String, usize>,
}

impl Objects {
    /// The object with an id.
    pub fn get(&self, id: &str) -> Option<&Object> {
        self.places.get(id).map(|&at| &self.list[at])
    }

    /// The object with an id, to be changed. Its id must stay.
    pub fn get_mut(&mut self, id: &str) -> Option<&mut Object> {
        self.places.get(id).map(|&at| &mut self.list[at])
    }

    /// All objects, in the order of the save.
    pub fn iter(&self) -> impl Iterator<Item = &Object> {
        self.list.iter()
    }

    /// All objects, in the order of the save, to be changed. Their ids must stay.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Object> {
        self.list.iter_mut()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Takes an object in.
    ///
    /// # Errors
    /// The object itself, if another one has its id.
    pub fn add(&mut self, object: Object) -> Result<(), Object> {
        match self.places.entry(object.id.clone()) {
            Slot::Occupied(_) => Err(object),
            Slot::Vacant(slot) => {
                slot.insert(self.list.len());
                self.list.push(object);
                Ok(())
            }
        }
    }

    /// Gives ids new values wherever they stand: as an object's own, as another's end, parent or child, in lists.
    pub fn replace_ids<'a>(&mut self, new: impl Fn(&str) -> Option<&'a str>) {
        let replace = |id: &mut String| {
            if let Some(new) = new(id) {
                new.clone_into(id);
            }
        };
        for object in &mut self.list {
            replace(&mut object.id);
            replace(&mut object.parent);
            object.logical.iter_mut().for_each(replace);
            object.children.iter_mut().for_each(replace);
            for property in &mut object.properties {
                if property.kind == Kind::Id {
                    replace(&mut property.value);
                }
            }
            for (_, ids) in &mut object.lists {
                ids.iter_mut().for_each(replace);
            }
        }
        self.retain(|_| true);
    }

    /// Takes an object out; another one gets its place in the order.
    pub fn take(&mut self, id: &str) -> Option<Object> {
        let at = self.places.remove(id)?;
        let taken = self.list.swap_remove(at);
        if let Some(moved) = self.list.get(at)
            && let Some(place) = self.places.get_mut(&moved.id)
        {
            *place = at;
        }
        Some(taken)
    }

    /// Keeps the objects that a condition holds for.
    pub fn retain(&mut self, keep: impl Fn(&Object) -> bool) {
        self.list.retain(keep);
        let places = self.list.iter().enumerate();
        self.places = places.map(|(at, one)| (one.id.clone(), at)).collect();
    }
}

/// A new pair of objects, graphical and logical, that are wired to nothing yet, with the properties that the editor gives each.
pub fn pair(graphical: String, logical: String, parent: &str, name: &str) -> (Object, Object) {
    let mut graphical = Object {
        id: graphical,
        parent: parent.to_owned(),
        logical: Some(logical.clone()),
        ..Object::default()
    };
    let mut logical = Object {
        id: logical,
        parent: ROOT.to_owned(),
        ..Object::default()
    };
    for object in [&mut graphical, &mut logical] {
        object.set(Kind::Text, "name", name);
        object.set(Kind::Id, "from", ROOT);
        object.set(Kind::Id, "to", ROOT);
        object.list_mut("links");
    }
    graphical.set(Kind::Shape("QPointF"), "position", "0, 0");
    graphical.set(Kind::Shape("QPolygon"), "configuration", "");
    graphical.set(Kind::Number("double"), "fromPort", "0");
    graphical.set(Kind::Number("double"), "toPort", "0");
    logical.set(Kind::Id, "outgoingExplosion", NOTHING);
    logical.set(Kind::Number("int"), "linkShape", "0");
    logical.list_mut("incomingExplosions");
    (graphical, logical)
}

/// Whether an entry of a save is an object.
pub fn is_object_file(name: &str) -> bool {
    !name.ends_with('/')
        && (name.starts_with("tree/logical/") || name.starts_with("tree/graphical/"))
}

/// Reads one object file; what it does not know it reports and leaves out.
///
/// # Errors
/// What is no XML, no `object`, or has no id.
pub fn parse(
    entry: &Entry,
    references: &mut usize,
    problems: &mut Vec<Problem>,
) -> Result<Object, Problem> {
    let text = std::str::from_utf8(&entry.bytes).map_err(|_| Problem::error(words::no_text()))?;
    Object::from_document(&xml::parse(text)?, references, problems)
}

impl Object {
    /// The object that a document describes; the number of ids in its lists is added to `references`.
    ///
    /// # Errors
    /// A document that is no `object`, has no id, or names too many others.
    pub fn from_document(
        document: &Element<'_>,
        references: &mut usize,
        problems: &mut Vec<Problem>,
    ) -> Result<Self, Problem> {
        if document.name != "object" {
            return Err(Problem::error(words::no_object(&document.name)));
        }
        let id = document.attribute("id").unwrap_or_default();
        if !is_id(id) {
            return Err(Problem::error(words::no_id()));
        }
        let logical = document.attribute("logicalId");
        let mut object = Self {
            id: id.to_owned(),
            parent: document.attribute("parent").unwrap_or_default().to_owned(),
            logical: logical
                .filter(|id| !id.is_empty() && *id != NOTHING)
                .map(str::to_owned),
            ..Self::default()
        };
        for part in document.elements() {
            match part.name.as_ref() {
                "children" => object.children.extend(ids(part, references)?),
                "properties" => properties(part, &mut object, references, problems)?,
                // Where labels were dragged.
                "graphicalParts" => {}
                other => keep(problems, unknown(&object, other)),
            }
        }
        Ok(object)
    }
}

fn properties(
    part: &Element<'_>,
    object: &mut Object,
    references: &mut usize,
    problems: &mut Vec<Problem>,
) -> Result<(), Problem> {
    let tags = part.elements().count();
    object.properties.reserve_exact(tags);
    for tag in part.elements() {
        if tag.attribute("type") == Some(ID_LIST) {
            let list = (tag.name.clone().into_owned(), ids(tag, references)?);
            object.lists.push(list);
            continue;
        }
        let (Some(kind), Some(key)) = (Kind::of(&tag.name), tag.attribute("key")) else {
            keep(problems, unknown(object, &tag.name));
            continue;
        };
        object.properties.push(Property {
            kind,
            key: key.to_owned(),
            value: tag.attribute("value").unwrap_or_default().to_owned(),
        });
    }
    Ok(())
}

fn ids(list: &Element<'_>, references: &mut usize) -> Result<Vec<String>, Problem> {
    let ids: Vec<String> = list
        .elements()
        .filter_map(|one| one.attribute("id").map(str::to_owned))
        .collect();
    *references += ids.len();
    if *references > limits::REFERENCES {
        return Err(Problem::error(words::too_many_references()));
    }
    Ok(ids)
}

fn unknown(object: &Object, tag: &str) -> Problem {
    let mut problem = Problem::warning(words::unknown_tag(tag));
    problem.place.object = Some(object.id.clone());
    problem.place.block = Some(object.element().to_owned());
    problem
}
