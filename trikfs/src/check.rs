//! `trikfs check`: a configuration tried without a mount.
//!
//! Owns the reading of configuration files. Makes the same checks as the live node and opens no device.

use crate::convert::shared::Cache;
use crate::convert::shared::copies::Copies;
use crate::convert::{Recipe, Workshop, isolated};
use crate::reload;
use config::description::{Config, Place};
use config::limits::CONFIG_BYTES_MAX;
use config::load::{Loaded, Loader};
use config::problem::Problem;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Where a configuration finds what it names.
pub struct SearchPaths {
    /// Where `include` looks.
    pub include_dirs: Vec<PathBuf>,
    /// Where shared libraries are looked for after the configuration's directory.
    pub library_dirs: Vec<PathBuf>,
    /// Below which all device paths are taken.
    pub device_root: Option<PathBuf>,
    /// Compiled converters.
    pub cache: Cache,
}

/// Reads a configuration file, no more of it than a configuration may have.
pub fn read_config(file: &Path) -> io::Result<Vec<u8>> {
    let opened = std::fs::File::open(file)?;
    let mut bytes = Vec::new();
    opened
        .take(CONFIG_BYTES_MAX as u64 + 1)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Loads a configuration file; libraries are not touched yet.
pub(crate) fn load(file: &Path, paths: &SearchPaths) -> Result<Loaded, Problem> {
    let name = file.display().to_string();
    let bytes =
        read_config(file).map_err(|error| Problem::new(name.clone(), 0, error.to_string()))?;
    load_text(&name, file.parent(), &bytes, paths)
}

/// Loads the text of a configuration; `base` is the folder of its file.
pub(crate) fn load_text(
    name: &str,
    base: Option<&Path>,
    text: &[u8],
    paths: &SearchPaths,
) -> Result<Loaded, Problem> {
    let loader = Loader {
        include_dirs: paths.include_dirs.clone(),
        library_dirs: paths.library_dirs.clone(),
        device_root: paths.device_root.clone(),
    };
    loader.load(name, base, text)
}

/// Makes all the checks that bringing the file into force would make. Returns the warnings.
pub fn check(
    file: &Path,
    paths: &SearchPaths,
    progress: &dyn Fn(&str),
) -> Result<Vec<Problem>, Problem> {
    let loaded = load(file, paths)?;
    isolated::room::admit(reload::all(&loaded.config))?;
    let workshop = Workshop {
        cache: &paths.cache,
        copies: &Copies::default(),
        progress,
        unconfined: RefCell::default(),
    };
    for description in reload::all(&loaded.config) {
        Recipe::prepare(description, &workshop, None)?;
    }
    if let Some(line) = isolated::unconfined_line(&workshop.unconfined.into_inner()) {
        progress(&line);
    }
    let mut warnings = loaded.warnings;
    warnings.extend(missing_devices(&loaded.config));
    Ok(warnings)
}

/// Device paths of a configuration that do not exist, as warnings: one for each bus and each directory, with the first
/// node that needs it. On a PC a description of a robot misses everything at once.
fn missing_devices(config: &Config) -> Vec<Problem> {
    let mut found: Vec<Missing> = Vec::new();
    let mut position: HashMap<PathBuf, usize> = HashMap::new();
    for description in reload::all(config) {
        let paths = description.source.needed_paths();
        for path in paths.into_iter().filter(|path| !path.exists()) {
            let place = missing_place(path);
            let at = *position.entry(place.clone()).or_insert_with(|| {
                found.push(Missing {
                    at: description.place.clone(),
                    first_path: path.to_owned(),
                    first_node: description.path.clone(),
                    place,
                    nodes: BTreeSet::new(),
                    paths: BTreeSet::new(),
                });
                found.len() - 1
            });
            if let Some(missing) = found.get_mut(at) {
                missing.nodes.insert(description.path.clone());
                missing.paths.insert(path.to_owned());
            }
        }
    }
    found.iter().map(Missing::warning).collect()
}

/// What missing devices have in common: the highest directory that is missing; else the directory that they should be
/// in. Those of /dev have little to do with each other, so each stands for itself.
fn missing_place(path: &Path) -> PathBuf {
    let highest = path.ancestors().take_while(|one| !one.exists()).last();
    let highest = highest.unwrap_or(path);
    match path.parent() {
        Some(parent) if highest == path && !parent.ends_with("dev") => parent.to_owned(),
        _ => highest.to_owned(),
    }
}

/// Missing devices that have a place in common.
struct Missing {
    /// Of the first node that needs one.
    at: Place,
    first_path: PathBuf,
    first_node: String,
    place: PathBuf,
    nodes: BTreeSet<String>,
    paths: BTreeSet<PathBuf>,
}

impl Missing {
    fn warning(&self) -> Problem {
        let (node, path) = (&self.first_node, self.first_path.display());
        let (who, opening) = match self.nodes.len() {
            1 => (format!("node {node}"), "opening it will give ENODEV"),
            count => (
                format!("{count} nodes, such as {node}"),
                "opening them will give ENODEV",
            ),
        };
        let what = match self.paths.len() {
            1 => format!("{path} does not exist"),
            2 => format!(
                "{path} does not exist, nor does another one in {}",
                self.place.display()
            ),
            count => format!(
                "{path} does not exist, nor do {} more in {}",
                count - 1,
                self.place.display()
            ),
        };
        let reason = format!("{who}: {what}; {opening}");
        Problem::new(self.at.file.clone(), self.at.line, reason)
    }
}
