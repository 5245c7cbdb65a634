//! A save as it is kept: what was read, what was changed since, and how it is written again.
//!
//! Owns the way back from objects to files. What was not changed is written as it came, byte for byte, also what nobody
//! here understands. A save of an old version stays as it was until something is changed; then all of it is written as
//! the present version has it.

use super::archive::{self, Archive, Container};
use super::objects::{self, Kind, Object, Objects};
use super::project::Project;
use super::read::{self, Meta};
use lang_text::problem::{Problem, Words};
use lang_text::xml;

mod orphans;
mod words;
mod write;

pub use orphans::Orphan;

/// Key of a text program that belongs to the project.
const CODE_KEY: &str = "activeCode";
/// Key of the file ending of that program's language.
const CODE_LANGUAGE_KEY: &str = "activeCodeLanguageExtension";

/// All of a save, also what nobody here understands.
#[derive(Clone, Debug)]
pub struct Save {
    pub(super) archive: Archive,
    pub(super) objects: Objects,
    pub(super) meta: Meta,
    /// Whether anything was changed but by conversion.
    pub(super) is_edited: bool,
}

impl Save {
    /// A save that is made and not read: all of it is new.
    pub fn made(objects: Objects, meta: Meta) -> Self {
        Self {
            archive: Archive {
                container: Container::Zip,
                entries: Vec::new(),
            },
            objects,
            meta,
            is_edited: true,
        }
    }

    /// How it was kept when it was read.
    pub fn container(&self) -> Container {
        self.archive.container
    }

    /// Its objects, converted to the present version.
    pub fn objects(&self) -> &Objects {
        &self.objects
    }

    /// What it says of itself, converted to the present version.
    pub fn meta(&self) -> &Meta {
        &self.meta
    }

    /// What it means now, with what is strange about it.
    pub fn project(&self) -> (Project, Vec<Problem>) {
        let mut problems = Vec::new();
        let project = read::graph::project(&self.objects, &self.meta, &mut problems);
        (project, read::limited(problems))
    }

    /// Gives a property of a block or link a value. Either id of its pair will do; the logical object gets it, which is
    /// the one that is run.
    ///
    /// # Errors
    /// An id that is not in the save, and control characters that XML cannot carry.
    pub fn set_property(&mut self, id: &str, key: &str, value: &str) -> Result<(), Problem> {
        writable(key)?;
        writable(value)?;
        let named = self.objects.get(id);
        let logical = named.and_then(|object| object.logical.clone());
        let id = logical.as_deref().unwrap_or(id);
        let Some(object) = self.objects.get_mut(id) else {
            return Err(at(id, words::no_such_object()));
        };
        object.set(Kind::Text, key, value);
        self.is_edited = true;
        Ok(())
    }

    /// Replaces the world model, as a teacher does to try a solution on another field.
    ///
    /// # Errors
    /// Text that is no XML.
    pub fn set_world(&mut self, world: &str) -> Result<(), Problem> {
        let file = |mut problem: Problem| {
            problem.place.file = Some(read::WORLD_FILE.to_owned());
            problem
        };
        writable(world).map_err(file)?;
        xml::parse(world).map_err(file)?;
        self.meta.world = Some(world.to_owned());
        self.is_edited = true;
        Ok(())
    }

    /// Gives a key of the save a value, or takes it away.
    ///
    /// # Errors
    /// Control characters that XML cannot carry.
    pub fn set_meta(&mut self, key: &str, value: Option<&str>) -> Result<(), Problem> {
        writable(key)?;
        match value {
            Some(value) => {
                writable(value)?;
                self.meta.keys.insert(key.to_owned(), value.to_owned());
            }
            None => _ = self.meta.keys.remove(key),
        }
        self.is_edited = true;
        Ok(())
    }

    /// Puts an object that the root lists before the others that it lists: the first main diagram is the one that is run.
    pub fn put_first(&mut self, id: &str) {
        let Some(root) = self.objects.get_mut(objects::ROOT) else {
            return;
        };
        if let Some(at) = root.children.iter().position(|child| child == id) {
            root.children[..=at].rotate_right(1);
            self.is_edited = true;
        }
    }

    /// Puts a text program into the save; `ending` is that of its language, `js` or `py`.
    ///
    /// # Errors
    /// Control characters that XML cannot carry.
    pub fn set_code(&mut self, code: &str, ending: &str) -> Result<(), Problem> {
        self.set_meta(CODE_KEY, Some(code))?;
        self.set_meta(CODE_LANGUAGE_KEY, Some(ending))
    }

    /// The save as a zip that TRIK Studio opens.
    ///
    /// # Errors
    /// More files or bytes than a zip can count.
    pub fn write(&self) -> Result<Vec<u8>, Problem> {
        archive::pack(&write::entries(self)?)
    }

    /// The same with nothing compressed, for those who compress it as a whole.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn write_stored(&self) -> Result<Vec<u8>, Problem> {
        archive::pack_stored(&write::entries(self)?)
    }
}

/// Refuses characters that no document may have.
pub(crate) fn writable(text: &str) -> Result<(), Problem> {
    let is_bad = |c: &char| c.is_ascii_control() && !['\n', '\r', '\t'].contains(c);
    match text.chars().find(is_bad) {
        Some(c) => Err(Problem::error(words::control_character(c))),
        None => Ok(()),
    }
}

fn at(id: &str, words: Words) -> Problem {
    let mut problem = Problem::error(words);
    problem.place.object = Some(id.to_owned());
    problem.place.block = Some(objects::element(id).to_owned());
    problem
}

/// Whether an object is a link, of either language.
pub(crate) fn is_link(object: &Object) -> bool {
    ["ControlFlow", "Edge"].contains(&object.element())
}

#[cfg(test)]
mod tests;
