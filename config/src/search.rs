//! Where a configuration finds its files: included programs, recordings, converter libraries.
//!
//! Owns the rule that nothing outside the search path can be included. Reads files, never device nodes.

use crate::error::Error;
use crate::limits::CONFIG_BYTES_MAX;
use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Component, Path, PathBuf};

/// The folders of one load.
#[derive(Clone, Debug, Default)]
pub(crate) struct Search {
    /// Folder of the configuration file; None for one that came without a file.
    pub(crate) base_dir: Option<PathBuf>,
    /// Folders for `include`.
    pub(crate) include_dirs: Vec<PathBuf>,
    /// Folders for libraries, after `base_dir`.
    pub(crate) library_dirs: Vec<PathBuf>,
}

impl Search {
    /// Reads an included file: `name`, or `name.lua`, in the first folder that has it. Gives the name that the file has
    /// there and its bytes.
    ///
    /// # Errors
    /// A name that leads outside, a file that is none, too large or unreadable, or nothing found.
    pub(crate) fn include(&self, name: &[u8]) -> Result<(String, Vec<u8>), Error> {
        self.read(name, &["", ".lua"])
    }

    /// Reads a file inside one of the include folders.
    fn read(&self, name: &[u8], endings: &[&str]) -> Result<(String, Vec<u8>), Error> {
        let (path, ending) = self.inside(name, endings)?;
        let shown = String::from_utf8_lossy(name);
        let mut source = Vec::new();
        let file = open_regular(&path)
            .map_err(|reason| Error::Named(format!("'{shown}' cannot be read: {reason}")))?;
        let limit = u64::try_from(CONFIG_BYTES_MAX).unwrap_or(u64::MAX) + 1;
        file.take(limit)
            .read_to_end(&mut source)
            .map_err(|error| Error::Named(format!("'{shown}' cannot be read: {error}")))?;
        if source.len() > CONFIG_BYTES_MAX {
            return Err(Error::Named(format!(
                "'{shown}' has more than {CONFIG_BYTES_MAX} bytes"
            )));
        }
        Ok((format!("{shown}{ending}"), source))
    }

    /// Reads a file beside the configuration, or in the folders for includes. Gives the name that it has there and its bytes.
    ///
    /// # Errors
    /// As `include`.
    pub(crate) fn beside(&self, name: &[u8], endings: &[&str]) -> Result<(String, Vec<u8>), Error> {
        let mut dirs: Vec<PathBuf> = self.base_dir.iter().cloned().collect();
        dirs.extend_from_slice(&self.include_dirs);
        let all = Self {
            include_dirs: dirs,
            ..Self::default()
        };
        all.read(name, endings)
    }

    /// Reads a model in DCML: `name`, or `name.dcml`, beside the configuration and then in the folders for includes; then a
    /// shipped model of that name. Gives the name that it has there and its bytes.
    ///
    /// # Errors
    /// As `include`.
    pub(crate) fn model(&self, name: &[u8]) -> Result<(String, Vec<u8>), Error> {
        match self.beside(name, &["", ".dcml"]) {
            Ok(found) => Ok(found),
            Err(reason) => {
                let name = String::from_utf8_lossy(name);
                let shipped = name.strip_suffix(".dcml").unwrap_or(&name);
                match lang_dcml::models::named(shipped) {
                    Some(found) => Ok((shipped.to_owned(), found.text.as_bytes().to_vec())),
                    None => Err(Error::Named(format!(
                        "model {reason}; {}",
                        lang_dcml::models::advice(shipped)
                    ))),
                }
            }
        }
    }

    /// The path of a recording: an absolute one as it is, any other like an include.
    ///
    /// # Errors
    /// As `include`.
    pub(crate) fn recording(&self, name: &[u8]) -> Result<PathBuf, Error> {
        if name.first() == Some(&b'/') {
            return Ok(path_of(name));
        }
        self.inside(name, &[""]).map(|(path, _)| path)
    }

    /// The absolute path of a library: beside the configuration, then in the library folders; never in the working
    /// directory.
    ///
    /// # Errors
    /// Nothing found, with the folders that were looked at.
    pub(crate) fn library(&self, name: &[u8]) -> Result<PathBuf, Error> {
        let shown = String::from_utf8_lossy(name);
        let wanted = path_of(name);
        let folders: Vec<&PathBuf> = self.base_dir.iter().chain(&self.library_dirs).collect();
        let candidates: Vec<PathBuf> = if wanted.is_absolute() {
            vec![wanted]
        } else {
            folders.iter().map(|folder| folder.join(&wanted)).collect()
        };
        for path in &candidates {
            if path.is_file() {
                return std::path::absolute(path)
                    .map_err(|error| Error::Named(format!("library '{shown}': {error}")));
            }
        }
        if name.first() == Some(&b'/') {
            return Err(Error::Named(format!("library '{shown}' does not exist")));
        }
        let folders: Vec<String> = folders.iter().map(|folder| shown_folder(folder)).collect();
        Err(Error::Named(format!(
            "library '{shown}' was not found in {}",
            list(&folders)
        )))
    }

    /// A file inside one of the include folders, and which of the endings it has.
    fn inside<'e>(&self, name: &[u8], endings: &[&'e str]) -> Result<(PathBuf, &'e str), Error> {
        let shown = String::from_utf8_lossy(name);
        let wanted = path_of(name);
        let plain = wanted
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        if name.is_empty() || name.contains(&0) || !plain {
            return Err(Error::Named(format!(
                "'{shown}' leads outside the search path"
            )));
        }
        for folder in &self.include_dirs {
            for ending in endings {
                let mut file = name.to_vec();
                file.extend_from_slice(ending.as_bytes());
                let path = folder.join(path_of(&file));
                let (Ok(real), Ok(root)) = (path.canonicalize(), folder.canonicalize()) else {
                    continue;
                };
                if !real.starts_with(&root) {
                    return Err(Error::Named(format!(
                        "'{shown}' is a link that leads outside the search path"
                    )));
                }
                if real.is_file() {
                    return Ok((real, ending));
                }
            }
        }
        let folders: Vec<String> = self
            .include_dirs
            .iter()
            .map(|folder| shown_folder(folder))
            .collect();
        Err(Error::Named(format!(
            "'{shown}' was not found in {}",
            list(&folders)
        )))
    }
}

/// A folder for a message; the working directory has an empty path here.
fn shown_folder(folder: &Path) -> String {
    if folder.as_os_str().is_empty() {
        ".".to_owned()
    } else {
        folder.display().to_string()
    }
}

/// A path of any bytes.
pub(crate) fn path_of(bytes: &[u8]) -> PathBuf {
    PathBuf::from(std::ffi::OsStr::from_bytes(bytes))
}

/// Opens a regular file without waiting, whatever has taken its place since it was looked at.
fn open_regular(path: &Path) -> io::Result<File> {
    let flags = libc::O_NONBLOCK | libc::O_CLOEXEC | libc::O_NOCTTY;
    let file = OpenOptions::new()
        .read(true)
        .custom_flags(flags)
        .open(path)?;
    if file.metadata()?.is_file() {
        Ok(file)
    } else {
        Err(io::Error::other("not a regular file"))
    }
}

fn list(folders: &[String]) -> String {
    if folders.is_empty() {
        "any folder: no search path is set".into()
    } else {
        folders.join(", ")
    }
}

#[cfg(test)]
mod tests;
