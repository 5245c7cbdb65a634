//! One opened converter of a library: the calls into foreign code.
//!
//! Owns the state pointer and the promise that calls with it never overlap. Knows nothing of how the library was found.

use crate::abi::{
    Code, Descriptor, RawLog, RawOpenInfo, RawParam, conversion, one_line, read_text,
};
use crate::limits::{NAME_BYTES_MAX, PARAMS_MAX, TEXT_BYTES_MAX};
use crate::{Conversion, Direction, Fault, OpenInfo};
use std::ffi::{CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

/// A converter opened for one file and one direction; dropping it closes it.
#[derive(Debug)]
pub struct Instance {
    code: Code,
    state: *mut c_void,
    input_size: u32,
    output_size: u32,
    /// The copy of the input that a plain converter may scribble over; empty for the versioned form.
    scratch: Vec<u8>,
}

// SAFETY: the header lets successive calls with one state come from different threads, and `&mut self` keeps them apart.
unsafe impl Send for Instance {}

impl Instance {
    /// Opens a converter whose sizes [`Descriptor::check_sizes`] has checked.
    pub(crate) fn open(descriptor: &Descriptor, info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let mut instance = Self {
            code: descriptor.code,
            state: ptr::null_mut(),
            // The cast loses nothing: `Descriptor::check_sizes` enforces TUPLE_BYTES_MAX.
            input_size: info.input_size as u32,
            output_size: info.output_size as u32,
            scratch: Vec::new(),
        };
        match descriptor.code {
            Code::Plain(_) => instance.scratch = vec![0; info.input_size],
            Code::Versioned { open: None, .. } => {}
            Code::Versioned {
                open: Some(open), ..
            } => {
                let texts = Texts::new(info)?;
                let params = texts.params(info);
                let log: &dyn Fn(&str) = info.log;
                let raw = RawOpenInfo {
                    size: size_of::<RawOpenInfo>() as u32,
                    direction: match info.direction {
                        Direction::Read => super::READ,
                        Direction::Write => super::WRITE,
                    },
                    input_size: instance.input_size,
                    output_size: instance.output_size,
                    param_count: params.len() as u32,
                    params: if params.is_empty() {
                        ptr::null()
                    } else {
                        params.as_ptr()
                    },
                    node: texts.node.as_ptr(),
                    host: (&raw const log).cast_mut().cast(),
                    log: Some(write_log as RawLog),
                };
                // SAFETY: `read_library` checked the descriptor; `raw` and all that it points to outlive the call.
                let code = unsafe { open(&raw const raw, &raw mut instance.state) };
                if code != super::OK {
                    // The state, if there is one, explains the refusal and is closed by the drop of `instance`.
                    return Err(instance.explain("open", code));
                }
            }
        }
        Ok(instance)
    }

    /// Converts one tuple. The output is zeroed first and counts only if this returns [`Conversion::Produced`].
    ///
    /// # Errors
    /// The converter's fault in its own words, or slices whose lengths are not those of the opening.
    pub fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault> {
        if input.len() != self.input_size as usize || output.len() != self.output_size as usize {
            return Err(Fault::new(format!(
                "converter opened for {} to {} bytes got {} to {}",
                self.input_size,
                self.output_size,
                input.len(),
                output.len()
            )));
        }
        output.fill(0);
        let code = match self.code {
            Code::Versioned { convert, .. } => {
                // SAFETY: `read_library` checked the descriptor, `open` made the state, and the check above the sizes.
                unsafe {
                    convert(
                        self.state,
                        input.as_ptr(),
                        self.input_size,
                        output.as_mut_ptr(),
                        self.output_size,
                    )
                }
            }
            Code::Plain(function) => return self.convert_plain(function, input, output),
        };
        conversion(code).ok_or_else(|| self.explain("convert", code))
    }

    /// The plain form: it gets a copy of the input, for its argument is not const, and anything but 0 is a fault.
    fn convert_plain(
        &mut self,
        function: super::Plain,
        input: &[u8],
        output: &mut [u8],
    ) -> Result<Conversion, Fault> {
        self.scratch.copy_from_slice(input);
        let (from, to) = (
            self.scratch.as_mut_ptr().cast::<c_char>(),
            output.as_mut_ptr().cast::<c_char>(),
        );
        // The casts lose nothing: `Descriptor::check_sizes` enforces TUPLE_BYTES_MAX.
        let (from_size, to_size) = (self.input_size as c_int, self.output_size as c_int);
        // SAFETY: `Descriptor::plain` has the caller's word for the function; `convert` checked the sizes.
        match unsafe { function(from_size, from, to_size, to) } {
            super::OK => Ok(Conversion::Produced),
            code => Err(Fault::new(format!("converter returned {code}"))),
        }
    }

    /// The converter's own text for a code that it has just returned, or a plain one.
    fn explain(&self, call: &str, code: c_int) -> Fault {
        let text = match self.code {
            Code::Versioned {
                explain: Some(explain),
                ..
            } => {
                // SAFETY: `read_library` checked the descriptor and the state is this converter's own, or null.
                let text = unsafe { explain(self.state, code) };
                // SAFETY: the header demands a text with a zero byte that stays valid until the next call.
                unsafe { read_text(text, TEXT_BYTES_MAX) }
            }
            Code::Versioned { explain: None, .. } | Code::Plain(_) => None,
        };
        match text.as_deref().map(one_line) {
            Some(text) if !text.is_empty() => Fault::new(text),
            _ => Fault::new(format!("{call} returned {code}")),
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if let Code::Versioned {
            open: Some(_),
            close: Some(close),
            ..
        } = self.code
            && !self.state.is_null()
        {
            // SAFETY: `open` made this state and nothing is called with it after this.
            unsafe { close(self.state) };
        }
    }
}

/// The texts of an opening as C wants them.
struct Texts {
    node: CString,
    names: Vec<CString>,
}

impl Texts {
    /// Copies the texts; refuses what C cannot hold and what the header rules out.
    fn new(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        if info.params.len() > PARAMS_MAX {
            return Err(Fault::new(format!(
                "{} params, the limit is {PARAMS_MAX}",
                info.params.len()
            )));
        }
        let c_text = |what, text: &str| {
            CString::new(text).map_err(|_| {
                Fault::new(format!("{what} '{}' has a zero byte", text.escape_debug()))
            })
        };
        let mut names = Vec::with_capacity(info.params.len());
        for name in info.params.keys() {
            if name.len() > NAME_BYTES_MAX {
                return Err(Fault::new(format!(
                    "a parameter's name has {} bytes, the limit is {NAME_BYTES_MAX}",
                    name.len()
                )));
            }
            names.push(c_text("parameter", name)?);
        }
        Ok(Self {
            node: c_text("node", info.node)?,
            names,
        })
    }

    /// The array that `trikfs_open_info.params` points to; valid as long as `self`.
    fn params(&self, info: &OpenInfo<'_>) -> Vec<RawParam> {
        let values = info.params.values().copied();
        self.names
            .iter()
            .zip(values)
            .map(|(name, value)| RawParam {
                name: name.as_ptr(),
                value,
            })
            .collect()
    }
}

/// `trikfs_open_info.log`.
///
/// # Safety
/// Called by a converter during its `open`, with the `host` that it was given, as the header demands.
unsafe extern "C" fn write_log(host: *mut c_void, text: *const c_char) {
    // SAFETY: `Instance::open` made the pointer from a reference of this type that outlives the call of `open`.
    let log = unsafe { *host.cast::<&dyn Fn(&str)>() };
    // SAFETY: the header demands a text with a zero byte.
    if let Some(bytes) = unsafe { read_text(text, TEXT_BYTES_MAX) } {
        // A panic must not cross into C. What the host's own log does with its troubles is not the converter's business.
        let _ = catch_unwind(AssertUnwindSafe(|| log(&one_line(&bytes))));
    }
}
