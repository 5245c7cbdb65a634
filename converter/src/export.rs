//! A Rust converter as a C one: the shims behind [`crate::export_converters!`].
//!
//! Owns the boundary: pointers from C become slices here, panics and faults become codes with a text. Knows no converter.

use crate::abi::{RawConverter, RawLibrary, RawOpenInfo, VERSION, one_line, read_text};
use crate::limits::{NAME_BYTES_MAX, PARAMS_MAX, TEXT_BYTES_MAX, TUPLE_BYTES_MAX};
use crate::{Conversion, Converter, Direction, Fault, OpenInfo, abi};
use std::any::Any;
use std::collections::BTreeMap;
use std::ffi::{CString, c_char, c_int, c_void};
use std::mem;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::slice;

#[cfg(test)]
mod tests;

/// Makes a shared library of Rust converters: `export_converters! { "double" => Double, "half" => Half }`.
///
/// Expands to the versioned entry that `include/trikfs_converter.h` describes; use it once in a crate, at its root.
/// Names have 1 to 64 bytes of `a-z 0-9 _`; any other name does not compile. The crate type must be `cdylib`, and the
/// profile must not be `panic = "abort"` if a panic is to cost one tuple instead of the filesystem.
#[macro_export]
macro_rules! export_converters {
    ($($name:literal => $converter:ty),+ $(,)?) => {
        /// The versioned entry of this library, called by the filesystem.
        #[unsafe(no_mangle)]
        pub extern "C" fn trikfs_library_entry() -> &'static $crate::abi::RawLibrary {
            static CONVERTERS: &[&$crate::abi::RawConverter] =
                &[$(&$crate::export::descriptor::<$converter>(concat!($name, "\0"))),+];
            static LIBRARY: $crate::abi::RawLibrary = $crate::export::library(CONVERTERS);
            &LIBRARY
        }
    };
}

/// Code of a fault whose text `explain` returns.
const FAULT: c_int = 2;

/// The state behind the `void *` of one open file.
struct Opened<T> {
    /// Absent after a refused opening and after a panic.
    converter: Option<T>,
    input_size: usize,
    output_size: usize,
    /// Text of the last fault.
    explanation: CString,
}

/// The table that the entry returns.
pub const fn library(converters: &'static [&'static RawConverter]) -> RawLibrary {
    assert!(!converters.is_empty() && converters.len() <= crate::limits::CONVERTERS_MAX);
    RawLibrary {
        abi_version: VERSION,
        size: size_of::<RawLibrary>() as u32,
        count: converters.len() as u32,
        // A reference to a sized type is a pointer to it, so the array of the one is an array of the other.
        converters: converters.as_ptr().cast(),
    }
}

/// The C descriptor of a Rust converter. `name` ends with a zero byte.
///
/// # Panics
/// At compile time, for a name that the header rules out.
pub const fn descriptor<T: Converter>(name: &'static str) -> RawConverter {
    let bytes = name.as_bytes();
    let length = bytes.len() - 1;
    assert!(bytes[length] == 0, "the name must end with a zero byte");
    assert!(
        length >= 1 && length <= NAME_BYTES_MAX,
        "a converter's name has 1 to 64 bytes"
    );
    let mut at = 0;
    while at < length {
        assert!(
            abi::is_name_byte(bytes[at]),
            "a converter's name is made of a-z 0-9 _"
        );
        at += 1;
    }
    assert!(
        T::INPUT_SIZE as usize <= TUPLE_BYTES_MAX && T::OUTPUT_SIZE as usize <= TUPLE_BYTES_MAX
    );
    RawConverter {
        abi_version: VERSION,
        size: size_of::<RawConverter>() as u32,
        name: bytes.as_ptr().cast(),
        description: T::DESCRIPTION.as_ptr(),
        input_size: T::INPUT_SIZE,
        output_size: T::OUTPUT_SIZE,
        open: Some(open::<T>),
        convert: Some(convert::<T>),
        close: Some(close::<T>),
        explain: Some(explain::<T>),
    }
}

/// `open` of the header. A refusal leaves a state that holds nothing but the text.
///
/// # Safety
/// `info` and `state` obey the header.
unsafe extern "C" fn open<T: Converter>(
    info: *const RawOpenInfo,
    state: *mut *mut c_void,
) -> c_int {
    if info.is_null() || state.is_null() {
        return FAULT;
    }
    // SAFETY: the header says that `info` is valid during the call, and its first field how long it is.
    let size = unsafe { (*info).size } as usize;
    let opened = if size < size_of::<RawOpenInfo>() {
        Err(Fault::new(
            "the host's open info is shorter than version 1 demands",
        ))
    } else {
        // SAFETY: it is as long as ours.
        unsafe { open_converter::<T>(&*info) }
    };
    let (code, opened) = match opened {
        Ok(opened) => (abi::OK, opened),
        Err(fault) => (
            FAULT,
            Opened {
                converter: None,
                input_size: 0,
                output_size: 0,
                explanation: c_text(fault.text()),
            },
        ),
    };
    // SAFETY: the header says that `state` can be written.
    unsafe { *state = Box::into_raw(Box::new(opened)).cast() };
    code
}

/// Opens the converter with what C says, in Rust's words.
///
/// # Safety
/// The pointers in `raw` obey the header.
unsafe fn open_converter<T: Converter>(raw: &RawOpenInfo) -> Result<Opened<T>, Fault> {
    let (input_size, output_size) = (raw.input_size as usize, raw.output_size as usize);
    if input_size > TUPLE_BYTES_MAX || output_size > TUPLE_BYTES_MAX {
        return Err(Fault::new("the host's tuples are larger than 65536 bytes"));
    }
    // SAFETY: the caller.
    let params = unsafe { read_params(raw) }?;
    // SAFETY: the header demands a text that ends with a zero byte.
    let node = unsafe { read_text(raw.node, TEXT_BYTES_MAX) }.unwrap_or_default();
    let log = |text: &str| {
        if let Some(log) = raw.log {
            let text = c_text(text);
            // SAFETY: the header gives `log` with its `host` for the time of this call.
            unsafe { log(raw.host, text.as_ptr()) };
        }
    };
    let info = OpenInfo {
        direction: match raw.direction {
            abi::READ => Direction::Read,
            abi::WRITE => Direction::Write,
            other => {
                return Err(Fault::new(format!(
                    "the host's direction {other} is neither read nor write"
                )));
            }
        },
        input_size,
        output_size,
        node: &one_line(&node),
        params: &params,
        log: &log,
    };
    let converter = fenced(|| T::open(&info))?;
    Ok(Opened {
        converter: Some(converter),
        input_size,
        output_size,
        explanation: CString::default(),
    })
}

/// Copies the parameters.
///
/// # Safety
/// `raw.params` points to `raw.param_count` parameters.
unsafe fn read_params(raw: &RawOpenInfo) -> Result<BTreeMap<String, f64>, Fault> {
    let count = raw.param_count as usize;
    if count == 0 {
        return Ok(BTreeMap::new());
    }
    if count > PARAMS_MAX || raw.params.is_null() || !raw.params.is_aligned() {
        return Err(Fault::new(format!(
            "the host's {count} parameters cannot be read"
        )));
    }
    // SAFETY: the caller; null, misaligned and absurdly many are excluded above.
    let params = unsafe { slice::from_raw_parts(raw.params, count) };
    let mut map = BTreeMap::new();
    for param in params {
        // SAFETY: the header demands a text that ends with a zero byte.
        let name = unsafe { read_text(param.name, NAME_BYTES_MAX) };
        let name = name.and_then(|bytes| String::from_utf8(bytes).ok());
        map.insert(
            name.ok_or(Fault::new("a parameter of the host has no proper name"))?,
            param.value,
        );
    }
    Ok(map)
}

/// `convert` of the header.
///
/// # Safety
/// `state` is what `open::<T>` left, the arrays obey the header.
unsafe extern "C" fn convert<T: Converter>(
    state: *mut c_void,
    input: *const u8,
    input_size: u32,
    output: *mut u8,
    output_size: u32,
) -> c_int {
    // SAFETY: `open::<T>` made the state; the header forbids two calls at the same time.
    let Some(opened) = (unsafe { state.cast::<Opened<T>>().as_mut() }) else {
        return FAULT;
    };
    if input_size as usize != opened.input_size || output_size as usize != opened.output_size {
        opened.explanation = c_text("the host gave other sizes than at open");
        return FAULT;
    }
    // SAFETY: the sizes are those of the opening, so the host has arrays of that length, and the two do not overlap.
    let (input, output) = unsafe {
        (
            bytes(input, opened.input_size),
            bytes_mut(output, opened.output_size),
        )
    };
    let result = match opened.converter.as_mut() {
        Some(converter) => catch_unwind(AssertUnwindSafe(|| converter.convert(input, output))),
        None => return FAULT,
    };
    match result {
        Ok(Ok(Conversion::Produced)) => abi::OK,
        Ok(Ok(Conversion::Consumed)) => abi::CONSUMED,
        Ok(Err(fault)) => {
            opened.explanation = c_text(fault.text());
            FAULT
        }
        Err(payload) => {
            opened.explanation = c_text(panic_fault(payload.as_ref()).text());
            // What a panic leaves behind is not trusted again, not even to be dropped.
            mem::forget(opened.converter.take());
            FAULT
        }
    }
}

/// `close` of the header.
///
/// # Safety
/// `state` is what `open::<T>` left, or null, and is not used again.
unsafe extern "C" fn close<T: Converter>(state: *mut c_void) {
    if !state.is_null() {
        // SAFETY: `open::<T>` made it with Box::into_raw and the header promises a single close.
        let opened = unsafe { Box::from_raw(state.cast::<Opened<T>>()) };
        // A panic in a destructor can no longer be reported; the hook has printed it.
        let _ = catch_unwind(AssertUnwindSafe(move || drop(opened)));
    }
}

/// `explain` of the header.
///
/// # Safety
/// `state` is what `open::<T>` left, or null.
unsafe extern "C" fn explain<T: Converter>(state: *mut c_void, code: c_int) -> *const c_char {
    // SAFETY: `open::<T>` made the state.
    match unsafe { state.cast::<Opened<T>>().as_ref() } {
        Some(opened) if code == FAULT => opened.explanation.as_ptr(),
        _ => ptr::null(),
    }
}

/// Runs foreign-facing code so that a panic becomes a fault.
fn fenced<R>(call: impl FnOnce() -> Result<R, Fault>) -> Result<R, Fault> {
    catch_unwind(AssertUnwindSafe(call))
        .unwrap_or_else(|payload| Err(panic_fault(payload.as_ref())))
}

/// The fault for a panic, with its message if it has one.
fn panic_fault(payload: &(dyn Any + Send)) -> Fault {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    match text {
        Some(text) => Fault::new(format!("converter panicked: {text}")),
        None => Fault::new("converter panicked"),
    }
}

/// A text for C; a zero byte inside becomes a space, since C would end there.
fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// An input array of C as a slice; C may give null for an empty one.
///
/// # Safety
/// `size` bytes can be read.
unsafe fn bytes<'a>(start: *const u8, size: usize) -> &'a [u8] {
    if size == 0 || start.is_null() {
        return &[];
    }
    // SAFETY: the caller.
    unsafe { slice::from_raw_parts(start, size) }
}

/// An output array of C as a slice.
///
/// # Safety
/// `size` bytes can be written, and nothing else accesses them.
unsafe fn bytes_mut<'a>(start: *mut u8, size: usize) -> &'a mut [u8] {
    if size == 0 || start.is_null() {
        return &mut [];
    }
    // SAFETY: the caller.
    unsafe { slice::from_raw_parts_mut(start, size) }
}
