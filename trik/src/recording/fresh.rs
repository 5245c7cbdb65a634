//! A file that is written beside its place and put there when it is whole.
//!
//! Owns that nothing half written is ever seen under the name, and that what could not be finished is taken away again.

use crate::error::Error;
use crate::output::{Output, settled};
use crate::refusal::Refusal;
use lang_text::problem::Locale;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// The file, until it is in its place.
pub(crate) struct Fresh {
    /// Where it is written.
    beside: PathBuf,
    /// Its place.
    place: PathBuf,
    file: File,
    replaces: bool,
}

impl Fresh {
    /// A new file for this place; one that is there stays until then.
    ///
    /// # Errors
    /// There is one and it is not to be replaced, it is no file or the one that is read, or none can be made.
    pub(crate) fn new(place: &Path, source: &Path, force: bool) -> Result<Self, Refusal> {
        let output = Output {
            path: Some(place),
            force,
            source,
            locale: Locale::English,
        };
        output.refuse_no_file()?;
        output.refuse_present()?;
        Ok(Self::beside(place, force)?)
    }

    /// A file that takes the place of the one that is read.
    ///
    /// # Errors
    /// It is no file, or none can be made beside it.
    pub(crate) fn over(source: &Path) -> Result<Self, Error> {
        if source.metadata().is_ok_and(|there| !there.is_file()) {
            let why = "it is no file, and only a file is replaced: name another one with -o";
            return Err(Error::file(source, why));
        }
        Self::beside(source, true)
    }

    fn beside(place: &Path, replaces: bool) -> Result<Self, Error> {
        let place = settled(place);
        let mut beside = place.clone().into_os_string();
        beside.push(format!(".{}.new", std::process::id()));
        let beside = PathBuf::from(beside);
        let file = File::create_new(&beside).map_err(|error| Error::file(&place, error))?;
        Ok(Self {
            beside,
            place,
            file,
            replaces,
        })
    }

    /// What is written.
    ///
    /// # Errors
    /// The system has no more open files.
    pub(crate) fn file(&self) -> Result<File, Error> {
        (self.file.try_clone()).map_err(|error| Error::file(&self.place, error))
    }

    /// Puts it into its place, where it survives a power cut.
    ///
    /// # Errors
    /// The disk takes no more, or there is another file by now.
    pub(crate) fn place(self) -> Result<(), Error> {
        self.put().map_err(|error| Error::file(&self.place, error))
    }

    fn put(&self) -> io::Result<()> {
        self.file.sync_all()?;
        if self.replaces {
            // A recording that only its owner may read stays so.
            if let Ok(there) = self.place.metadata() {
                self.file.set_permissions(there.permissions())?;
            }
            return fs::rename(&self.beside, &self.place);
        }
        // Unlike a renaming this never replaces what came in the meantime.
        match fs::hard_link(&self.beside, &self.place) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                // A disk without links, as those of cameras.
                match self.place.symlink_metadata() {
                    Ok(_) => Err(io::ErrorKind::AlreadyExists.into()),
                    Err(_) => fs::rename(&self.beside, &self.place),
                }
            }
            linked => linked,
        }
    }
}

impl Drop for Fresh {
    fn drop(&mut self) {
        // In its place it has another name, or this one is gone.
        let _ = fs::remove_file(&self.beside);
    }
}
