//! What a save says of itself: keys of metaInfo.xml, and the texts that new saves keep in files of their own.
//!
//! Owns which text is where. Knows nothing of what the texts mean.

use super::words;
use crate::archive::Archive;
use lang_text::problem::Problem;
use lang_text::xml;
use std::collections::BTreeMap;
use std::sync::Arc;

/// File of the keys.
pub const META_FILE: &str = "metaInfo.xml";
/// File of the world model.
pub const WORLD_FILE: &str = "worldModel.xml";
/// File of the images.
pub const BLOBS_FILE: &str = "blobs.xml";
/// Folder of the templates.
pub const TEMPLATES: &str = "templates/";

/// What a save says of itself.
#[derive(Clone, Debug, Default)]
pub struct Meta {
    /// Keys and values that are not one of the other fields.
    pub keys: BTreeMap<String, String>,
    /// XML text of the world model.
    pub world: Option<String>,
    /// XML text of embedded images. It can be long, and whatever keeps a former state of the save shares it.
    pub blobs: Option<Arc<str>>,
    /// Templates of the checker by file name.
    pub templates: BTreeMap<String, String>,
}

impl Meta {
    /// Collects what the entries have.
    pub(crate) fn read(archive: &Archive, problems: &mut Vec<Problem>) -> Self {
        let mut meta = Self::default();
        let mut is_there = false;
        for entry in &archive.entries {
            let (name, bytes) = (entry.name.as_str(), &entry.bytes);
            let template = name.strip_prefix(TEMPLATES);
            let template = template.filter(|file| !file.is_empty() && !entry.is_folder());
            if template.is_none() && ![META_FILE, WORLD_FILE, BLOBS_FILE].contains(&name) {
                continue;
            }
            let Ok(text) = std::str::from_utf8(bytes) else {
                problems.push(in_file(name, Problem::error(words::no_text())));
                continue;
            };
            if let Some(file) = template {
                meta.templates.insert(file.to_owned(), text.to_owned());
            } else if name == META_FILE {
                is_there = true;
                if let Err(problem) = meta.read_keys(text) {
                    problems.push(in_file(name, problem));
                }
            } else if name == WORLD_FILE {
                meta.world = Some(text.to_owned());
            } else {
                meta.blobs = Some(text.into());
            }
        }
        if !is_there {
            problems.push(in_file(META_FILE, Problem::warning(words::no_meta())));
        }
        meta
    }

    /// Whether the value of a key has a field of its own.
    pub(crate) fn has_place(key: &str) -> bool {
        key == "worldModel" || key == "blobs" || key.starts_with("templates.")
    }

    fn read_keys(&mut self, text: &str) -> Result<(), Problem> {
        let document = xml::parse(text)?;
        for info in document.elements().filter(|one| one.name == "info") {
            let Some(key) = info.attribute("key") else {
                continue;
            };
            let value = info.attribute("value").unwrap_or_default().to_owned();
            // A file of its own is newer than a key.
            match key {
                "worldModel" => _ = self.world.get_or_insert(value),
                "blobs" => _ = self.blobs.get_or_insert_with(|| value.into()),
                _ => match key.strip_prefix("templates.") {
                    Some(name) => {
                        let file = format!("{name}.xml");
                        self.templates.entry(file).or_insert(value);
                    }
                    None => _ = self.keys.insert(key.to_owned(), value),
                },
            }
        }
        Ok(())
    }
}

fn in_file(name: &str, mut problem: Problem) -> Problem {
    problem.place.file = Some(name.to_owned());
    problem
}
