//! Native converters: loads shared libraries and opens the converters in them.
//!
//! Owns finding the file, the copy that is really loaded, and the choice of a converter by name. What a library has to
//! look like and how it is called is `converter::abi`'s business; compiling C is `inline_c`'s.
//!
//! **Native code is trusted code.** Loading a library runs its constructors, and a converter can crash the process,
//! hang it or write anywhere. All that this file checks is that the library is what it says.
//!
//! A library is never unloaded: descriptors and functions of it stay valid to the end of the process. So that a new
//! build under the same name is seen when the configuration is loaded again, what is loaded is a copy in the cache,
//! named by its contents: the same contents are loaded once, other contents are another library. The copy has
//! another directory, so a library must not look for others beside itself (`$ORIGIN`).

mod cache;
pub mod copies;
mod elf;
mod refusal;

pub use cache::Cache;
pub use refusal::{CacheError, LibraryError, Wrong};

use crate::errno::{BlameWord, blame_and_reason};
use crate::hash::Hash;
use crate::limits;
use config::nearest::suggestion;
use converter::abi::{self, Descriptor, Instance};
use converter::{Conversion, Direction, Fault};
use libloading::os::unix as dl;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a converter is told when a file is opened.
pub struct OpenInfo<'a> {
    /// Which way this instance converts.
    pub direction: Direction,
    /// Bytes of every input tuple.
    pub input_size: usize,
    /// Bytes of every output tuple.
    pub output_size: usize,
    /// Path of the node in the tree, for messages.
    pub node: &'a str,
    /// The node's `params`.
    pub params: &'a BTreeMap<String, f64>,
    /// Gets what the converter logs while it is opened.
    pub log: Arc<dyn Fn(&str) + Send + Sync>,
}

/// What messages call compiled source.
pub(super) const INLINE: &str = "inline C";

/// What messages call a library: as a whole, and in front of what a converter of it says.
pub(super) fn shown(path: &Path) -> (String, String) {
    let shown = path.display().to_string();
    let short = path
        .file_name()
        .map(|file| file.to_string_lossy().into_owned());
    let short = short.unwrap_or_else(|| shown.clone());
    (shown, short)
}

/// What messages call one of its converters.
pub(super) fn label(short: &str, name: Option<&str>) -> Arc<str> {
    match name {
        Some(name) => format!("{short}#{name}").into(),
        None => short.into(),
    }
}

/// One converter of a loaded library; cheap to clone.
#[derive(Clone, Debug)]
pub struct Library {
    descriptor: Arc<Descriptor>,
    label: Arc<str>,
}

impl Library {
    /// Loads the library at `path`, through its copy in `cache`, and chooses the converter `name` in it. Without a name
    /// it must hold exactly one. A file of the cache itself is loaded as it is.
    ///
    /// The symbol `trikfs_library_entry` is preferred; without it the library must export the plain function `converter`.
    ///
    /// # Errors
    /// What is wrong, with the path and, for a name that is not there, all that are.
    pub fn load(path: &Path, name: Option<&str>, cache: &Cache) -> Result<Self, LibraryError> {
        if cache.holds(path) {
            return Self::load_copy(path, INLINE, INLINE, name);
        }
        Self::load_copy_of(path, &copy(path, cache)?, name)
    }

    /// As [`load`](Self::load), from a copy of the library at `path` that is in the cache already.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn load_copy_of(
        path: &Path,
        copy: &Path,
        name: Option<&str>,
    ) -> Result<Self, LibraryError> {
        let (shown, short) = shown(path);
        Self::load_copy(copy, &shown, &short, name)
    }

    /// From a file of the cache, which the user knows as `shown`, or as `short` in front of a message.
    pub(super) fn load_copy(
        file: &Path,
        shown: &str,
        short: &str,
        name: Option<&str>,
    ) -> Result<Self, LibraryError> {
        let descriptor = open_library(file, shown)
            .and_then(|descriptors| choose(descriptors, name))
            .map_err(|why| LibraryError::Library {
                shown: shown.to_owned(),
                why,
            })?;
        Ok(Self {
            descriptor: Arc::new(descriptor),
            label: label(short, name),
        })
    }

    /// What messages call it: the file's name, with `#name` if one was given; `inline C` for compiled source.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Checks the tuple sizes of a description against those that the converter insists on, without running it.
    ///
    /// # Errors
    /// Names the converter, what it wants and what it would get.
    pub fn check_sizes(&self, input_size: usize, output_size: usize) -> Result<(), Fault> {
        self.descriptor
            .check_sizes(input_size, output_size)
            .map_err(|error| labelled(&self.label, &error))
    }

    /// Makes the converter's state for one open file and direction.
    ///
    /// # Errors
    /// The converter's own refusal (parameters, sizes), in its words.
    pub fn open(&self, info: &OpenInfo<'_>) -> Result<NativeStage, Fault> {
        let raw = converter::OpenInfo {
            direction: info.direction,
            input_size: info.input_size,
            output_size: info.output_size,
            node: info.node,
            params: info.params,
            log: &*info.log,
        };
        let instance = self
            .descriptor
            .open(&raw)
            .map_err(|error| labelled(&self.label, &error))?;
        Ok(NativeStage {
            instance,
            label: Arc::clone(&self.label),
            input_size: info.input_size,
            output_size: info.output_size,
        })
    }
}

/// A native converter opened for one file and direction; dropping it closes it.
#[derive(Debug)]
pub struct NativeStage {
    instance: Instance,
    label: Arc<str>,
    input_size: usize,
    output_size: usize,
}

impl NativeStage {
    /// Converts one tuple; both slices have the sizes of the opening. The output counts only after
    /// [`Conversion::Produced`].
    ///
    /// # Errors
    /// The fault in the converter's words, after the library's name. The tuple is lost; the next call is made as usual.
    pub fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault> {
        self.instance
            .convert(input, output)
            .map_err(|fault| labelled(&self.label, &fault))
    }

    /// Converts whole tuples from the front of `input` to the front of `output` until one of them has no room for
    /// another tuple, or until a fault.
    ///
    /// Gives how many tuples were taken, how many were made, and the fault; the tuple that caused it counts as taken.
    pub fn convert_many(
        &mut self,
        input: &[u8],
        output: &mut [u8],
    ) -> (usize, usize, Option<Fault>) {
        self.convert_watched(input, output, |_| {})
    }

    /// As [`convert_many`](Self::convert_many); `watch` hears of each tuple that is done, and whether another one was made of it.
    #[inline]
    pub(super) fn convert_watched(
        &mut self,
        input: &[u8],
        output: &mut [u8],
        mut watch: impl FnMut(bool),
    ) -> (usize, usize, Option<Fault>) {
        let (mut taken, mut made) = (0, 0);
        let mut room = output.chunks_exact_mut(self.output_size);
        let mut next = room.next();
        for tuple in input.chunks_exact(self.input_size) {
            let Some(slot) = next.as_deref_mut() else {
                break;
            };
            taken += 1;
            match self.instance.convert(tuple, slot) {
                Ok(Conversion::Produced) => {
                    made += 1;
                    next = room.next();
                    watch(true);
                }
                Ok(Conversion::Consumed) => watch(false),
                Err(fault) => return (taken, made, Some(labelled(&self.label, &fault))),
            }
        }
        (taken, made, None)
    }

    /// Bytes of every output tuple.
    pub(super) fn output_size(&self) -> usize {
        self.output_size
    }
}

/// A fault after the name of the library, but a word that blames somebody else stays the first.
fn labelled(label: &str, fault: &dyn std::fmt::Display) -> Fault {
    let text = fault.to_string();
    let (word, reason) = blame_and_reason(&text);
    let word = word.map_or("", BlameWord::text);
    Fault::new(format!("{word}{label}: {reason}"))
}

/// Reads a library and puts its copy into the cache.
fn copy(path: &Path, cache: &Cache) -> Result<PathBuf, LibraryError> {
    let wrong = |why| LibraryError::Library {
        shown: path.display().to_string(),
        why,
    };
    let fail = |error: std::io::Error| {
        wrong(match error.kind() {
            std::io::ErrorKind::NotFound => Wrong::Missing,
            _ => Wrong::Unreadable(error.to_string()),
        })
    };
    // Asked before opening: a FIFO would wait for a writer.
    let found = std::fs::metadata(path).map_err(fail)?;
    if !found.is_file() {
        return Err(wrong(Wrong::NotAFile));
    }
    if found.len() > limits::LIBRARY_BYTES_MAX {
        return Err(wrong(Wrong::TooLarge));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(fail)?;
    file.take(limits::LIBRARY_BYTES_MAX)
        .read_to_end(&mut bytes)
        .map_err(fail)?;
    elf::check(&bytes).map_err(|why| wrong(Wrong::Elf(why)))?;
    Ok(cache.put(&copy_name(&bytes), &bytes)?)
}

/// The name of the copy of a library with these contents.
fn copy_name(contents: &[u8]) -> String {
    format!("lib-{}.so", Hash::of(contents).hex())
}

/// Loads a library for ever and reads what it holds; the user knows it as `shown`.
fn open_library(path: &Path, shown: &str) -> Result<Vec<Descriptor>, Wrong> {
    // SAFETY: constructors of the library run, and native code is trusted (see the head of this file). `copy` and
    // `inline_c` made the file in a directory that `Cache::open` found to be ours alone.
    let library = unsafe { dl::Library::open(Some(path), dl::RTLD_NOW | dl::RTLD_LOCAL) };
    let library = library.map_err(|error| {
        let source = std::error::Error::source(&error);
        let words = source.map_or_else(|| error.to_string(), ToString::to_string);
        explain(&words, path, shown)
    })?;
    // SAFETY: the header gives this symbol this type.
    let entry = unsafe { library.get::<abi::Entry>(abi::ENTRY_SYMBOL) }
        .ok()
        .map(|symbol| *symbol);
    // SAFETY: as above.
    let plain = unsafe { library.get::<abi::Plain>(abi::PLAIN_SYMBOL) }
        .ok()
        .map(|symbol| *symbol);
    // Without a handle nothing can unload it, which is what `abi` demands.
    let _ = library.into_raw();
    if let Some(entry) = entry {
        // SAFETY: the library that holds the function is loaded and stays so.
        let table = unsafe { entry() };
        // SAFETY: this is what the entry of a library returned that is never unloaded.
        return Ok(unsafe { abi::read_library(table) }?);
    }
    match plain {
        // SAFETY: the header gives this symbol this type and these rules; the library is never unloaded.
        Some(function) => Ok(vec![unsafe {
            Descriptor::plain(abi::PLAIN_SYMBOL, function)
        }]),
        None => Err(Wrong::NoSymbol),
    }
}

/// The loader's own words, without the name of the file at their beginning; the one refusal that puzzles everybody is told
/// from the others, for which the loader gives nothing but words.
fn explain(words: &str, path: &Path, shown: &str) -> Wrong {
    let path = path.display().to_string();
    let words = words.strip_prefix(&format!("{path}: ")).unwrap_or(words);
    // The user has never seen the name in the cache.
    let words = words.replace(&path, shown);
    if words.contains("failed to map segment") {
        Wrong::NoExec(words)
    } else {
        Wrong::Linker(words)
    }
}

/// The converter called `name`, or the only one.
fn choose(mut descriptors: Vec<Descriptor>, name: Option<&str>) -> Result<Descriptor, Wrong> {
    let Some(name) = name else {
        return match descriptors.pop() {
            Some(only) if descriptors.is_empty() => Ok(only),
            Some(last) => {
                descriptors.push(last);
                Err(Wrong::Several(names(&descriptors)))
            }
            None => Err(Wrong::Empty),
        };
    };
    if let Some(index) = descriptors
        .iter()
        .position(|descriptor| descriptor.name() == name)
    {
        return Ok(descriptors.swap_remove(index));
    }
    let hint = suggestion(name, descriptors.iter().map(Descriptor::name));
    Err(Wrong::NoConverter {
        name: name.to_owned(),
        hint,
        names: names(&descriptors),
    })
}

fn names(descriptors: &[Descriptor]) -> Vec<String> {
    let names = descriptors.iter().map(Descriptor::name);
    names.map(str::to_owned).collect()
}

#[cfg(test)]
mod tests;
