//! The C ABI as Rust sees it: the structs of `include/trikfs_converter.h`, the validation of a foreign library, and calls into it.
//!
//! Owns every unsafe step between the filesystem and a loaded library except finding its symbols. Knows nothing of dlopen.
//!
//! A loader does this:
//! 1. Load the library and never unload it.
//! 2. Look up [`ENTRY_SYMBOL`]; call it as [`Entry`] and give the result to [`read_library`]. Without that symbol look up
//!    [`PLAIN_SYMBOL`] and give it, as [`Plain`], to [`Descriptor::plain`].
//! 3. Choose a [`Descriptor`] by name.
//! 4. For every open file call [`Descriptor::open`]; call [`Instance::convert`] for each tuple; drop the instance to close it.
//!
//! Steps 3 and 4 are safe code.

mod instance;
mod validate;

#[cfg(test)]
mod tests;

pub use instance::Instance;
pub use validate::fuzz_library;
pub(crate) use validate::is_name_byte;

use crate::error::{Error, LibraryFault, Part, Side};
use crate::{Conversion, OpenInfo, limits};
use std::ffi::{c_char, c_int, c_void};
use validate::{ConverterFields, Header};

/// Version of the ABI that this crate describes; a library must have the same.
pub const VERSION: u32 = 1;
/// Symbol of the versioned form, of type [`Entry`].
pub const ENTRY_SYMBOL: &str = "trikfs_library_entry";
/// Symbol of the plain form, of type [`Plain`].
pub const PLAIN_SYMBOL: &str = "converter";
/// `TRIKFS_OK` of the header.
pub const OK: c_int = 0;
/// `TRIKFS_CONSUMED` of the header.
pub const CONSUMED: c_int = 1;
/// `TRIKFS_READ` of the header.
pub const READ: u32 = 0;
/// `TRIKFS_WRITE` of the header.
pub const WRITE: u32 = 1;

/// The function behind [`ENTRY_SYMBOL`].
pub type Entry = unsafe extern "C" fn() -> *const RawLibrary;
/// The function behind [`PLAIN_SYMBOL`]: sizes and arrays of input and output, 0 for success.
pub type Plain = unsafe extern "C" fn(c_int, *mut c_char, c_int, *mut c_char) -> c_int;
/// `open` of `trikfs_converter`.
pub type RawOpen = unsafe extern "C" fn(*const RawOpenInfo, *mut *mut c_void) -> c_int;
/// `convert` of `trikfs_converter`.
pub type RawConvert = unsafe extern "C" fn(*mut c_void, *const u8, u32, *mut u8, u32) -> c_int;
/// `close` of `trikfs_converter`.
pub type RawClose = unsafe extern "C" fn(*mut c_void);
/// `explain` of `trikfs_converter`.
pub type RawExplain = unsafe extern "C" fn(*mut c_void, c_int) -> *const c_char;
/// `log` of `trikfs_open_info`.
pub type RawLog = unsafe extern "C" fn(*mut c_void, *const c_char);

/// `trikfs_param`.
#[repr(C)]
pub struct RawParam {
    pub(crate) name: *const c_char,
    pub(crate) value: f64,
}

/// `trikfs_open_info`.
#[repr(C)]
pub struct RawOpenInfo {
    pub(crate) size: u32,
    pub(crate) direction: u32,
    pub(crate) input_size: u32,
    pub(crate) output_size: u32,
    pub(crate) param_count: u32,
    pub(crate) params: *const RawParam,
    pub(crate) node: *const c_char,
    pub(crate) host: *mut c_void,
    pub(crate) log: Option<RawLog>,
}

/// `trikfs_converter`. The fields are private so that a value made by safe code is always sound to read.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct RawConverter {
    pub(crate) abi_version: u32,
    pub(crate) size: u32,
    pub(crate) name: *const c_char,
    pub(crate) description: *const c_char,
    pub(crate) input_size: u32,
    pub(crate) output_size: u32,
    pub(crate) open: Option<RawOpen>,
    pub(crate) convert: Option<RawConvert>,
    pub(crate) close: Option<RawClose>,
    pub(crate) explain: Option<RawExplain>,
}

/// `trikfs_library`. The fields are private for the same reason.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct RawLibrary {
    pub(crate) abi_version: u32,
    pub(crate) size: u32,
    pub(crate) count: u32,
    pub(crate) converters: *const *const RawConverter,
}

// SAFETY: the pointers lead to constants (`export::descriptor` makes them from 'static references) that are never written.
unsafe impl Sync for RawConverter {}
// SAFETY: as above; `export::library` takes a 'static slice.
unsafe impl Sync for RawLibrary {}

/// One converter of a library, checked and copied out of it.
#[derive(Clone, Debug)]
pub struct Descriptor {
    name: String,
    description: String,
    input_size: u32,
    output_size: u32,
    code: Code,
}

/// The functions of one converter. They stay callable because libraries are never unloaded.
#[derive(Clone, Copy, Debug)]
enum Code {
    Versioned {
        open: Option<RawOpen>,
        convert: RawConvert,
        close: Option<RawClose>,
        explain: Option<RawExplain>,
    },
    Plain(Plain),
}

impl Descriptor {
    /// A library of the plain form; `name` is for messages.
    ///
    /// # Safety
    /// `function` has the signature and obeys the rules that the header states, and its library is never unloaded.
    pub unsafe fn plain(name: &str, function: Plain) -> Self {
        Self {
            name: name.to_owned(),
            description: String::new(),
            input_size: 0,
            output_size: 0,
            code: Code::Plain(function),
        }
    }

    /// Name within the library.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// One sentence, possibly empty.
    pub fn description(&self) -> &str {
        &self.description
    }

    /// Checks the tuple sizes of a configuration against those that the converter insists on, without calling it.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn check_sizes(&self, input_size: usize, output_size: usize) -> Result<(), Error> {
        for (side, wanted, given) in [
            (Side::Input, self.input_size, input_size),
            (Side::Output, self.output_size, output_size),
        ] {
            let refused = |wanted| Error::Size {
                converter: self.name.clone(),
                side,
                wanted,
                given,
            };
            if given == 0 || given > limits::TUPLE_BYTES_MAX {
                return Err(refused(None));
            }
            if wanted != 0 && wanted as usize != given {
                return Err(refused(Some(wanted)));
            }
        }
        Ok(())
    }

    /// Makes the state of one open file.
    ///
    /// # Errors
    /// Sizes that [`Descriptor::check_sizes`] refuses, names that C cannot hold, or the converter's own refusal.
    pub fn open(&self, info: &OpenInfo<'_>) -> Result<Instance, Error> {
        self.check_sizes(info.input_size, info.output_size)?;
        Ok(Instance::open(self, info)?)
    }
}

/// Checks what a library's entry returned and copies every descriptor out of it.
///
/// # Errors
/// What is wrong with the library.
///
/// # Safety
/// `library` is null or the value that the entry of a loaded library returned, and that library is never unloaded.
/// Every field is checked, but no check can tell a wild pointer from a good one: a library is trusted code.
pub unsafe fn read_library(library: *const RawLibrary) -> Result<Vec<Descriptor>, LibraryFault> {
    if library.is_null() || !library.is_aligned() {
        return Err(LibraryFault::Nothing);
    }
    // SAFETY: the caller vouches for the pointer; only the two fields that every version begins with are read.
    let header = unsafe { read_header(library.cast()) };
    header.check(Part::Library, size_of::<RawLibrary>())?;
    // SAFETY: `Header::check` saw that the library's struct is at least as long as ours.
    let raw = unsafe { library.read() };
    validate::check_count(
        raw.count,
        !raw.converters.is_null() && raw.converters.is_aligned(),
    )?;
    let mut descriptors = Vec::with_capacity(raw.count as usize);
    for index in 0..raw.count as usize {
        // SAFETY: `validate::check_count` saw an array; the library says that it has `count` pointers.
        let converter = unsafe { raw.converters.add(index).read() };
        // SAFETY: the pointer comes from the library's own table, for which the caller vouches.
        descriptors.push(unsafe { read_converter(index, converter) }?);
    }
    validate::check_unique(descriptors.iter().map(Descriptor::name))?;
    Ok(descriptors)
}

/// The same for a library that is linked into this program, as [`crate::export_converters!`] makes it.
///
/// # Errors
/// As [`read_library`], though a library made by the macro has no reason to fail.
pub fn descriptors(library: &'static RawLibrary) -> Result<Vec<Descriptor>, LibraryFault> {
    // SAFETY: the fields are private, so `export::library` made the value, from 'static parts.
    unsafe { read_library(library) }
}

/// Checks and copies one descriptor.
///
/// # Safety
/// As for [`read_library`].
unsafe fn read_converter(
    index: usize,
    converter: *const RawConverter,
) -> Result<Descriptor, LibraryFault> {
    let part = Part::Converter(index);
    if converter.is_null() || !converter.is_aligned() {
        return Err(LibraryFault::Missing(index));
    }
    // SAFETY: the caller vouches for the pointer; only the two fields that every version begins with are read.
    let header = unsafe { read_header(converter.cast()) };
    header.check(part, size_of::<RawConverter>())?;
    // SAFETY: `Header::check` saw that the struct is at least as long as ours.
    let raw = unsafe { converter.read() };
    // SAFETY: texts of a descriptor end with a zero byte, says the header; no more than the limit is looked at.
    let name = unsafe { read_text(raw.name, limits::NAME_BYTES_MAX + 1) };
    // SAFETY: as above.
    let description = unsafe { read_text(raw.description, limits::TEXT_BYTES_MAX) };
    let fields = ConverterFields {
        name: name.as_deref(),
        input_size: raw.input_size,
        output_size: raw.output_size,
        has_convert: raw.convert.is_some(),
    };
    let name = fields.check(part)?;
    let Some(convert) = raw.convert else {
        return Err(LibraryFault::NoConvert(name));
    };
    Ok(Descriptor {
        name,
        description: one_line(description.as_deref().unwrap_or_default()),
        input_size: raw.input_size,
        output_size: raw.output_size,
        code: Code::Versioned {
            open: raw.open,
            convert,
            close: raw.close,
            explain: raw.explain,
        },
    })
}

/// Reads `abi_version` and `size`, which every struct of every version begins with.
///
/// # Safety
/// At least eight aligned bytes can be read.
unsafe fn read_header(start: *const u32) -> Header {
    // SAFETY: the caller.
    let (abi_version, size) = unsafe { (start.read(), start.add(1).read()) };
    Header { abi_version, size }
}

/// Copies the bytes of a C text up to its zero byte or up to `limit`; absent for a null pointer.
///
/// # Safety
/// `text` is null or can be read up to its zero byte.
pub(crate) unsafe fn read_text(text: *const c_char, limit: usize) -> Option<Vec<u8>> {
    if text.is_null() {
        return None;
    }
    let mut bytes = Vec::new();
    while bytes.len() < limit {
        // SAFETY: no zero byte came before this one, so the text goes on at least up to here.
        let byte = unsafe { text.add(bytes.len()).cast::<u8>().read() };
        if byte == 0 {
            break;
        }
        bytes.push(byte);
    }
    Some(bytes)
}

/// A foreign text made fit for one line of a `fault` file or a log.
pub(crate) fn one_line(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let text: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    text.trim().to_owned()
}

/// A return value of `convert` as a [`Conversion`]; absent for a fault.
fn conversion(code: c_int) -> Option<Conversion> {
    match code {
        OK => Some(Conversion::Produced),
        CONSUMED => Some(Conversion::Consumed),
        _ => None,
    }
}
