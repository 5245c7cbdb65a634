//! Converters of our own through the shims and back: state, faults, panics and hosts that break the rules.

use super::*;
use crate::abi::{Descriptor, Instance, descriptors};
use crate::error::Error;
use std::cell::RefCell;
use std::ffi::CStr;

/// Adds up bytes; misbehaves on request.
struct Sum {
    total: u8,
}

impl Converter for Sum {
    const DESCRIPTION: &'static CStr = c"running sum of one byte";
    const INPUT_SIZE: u32 = 1;

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        match info.param("start") {
            Some(start) if start.is_nan() => panic!("start is not a number"),
            Some(start) if start > 255.0 => Err(Fault::new("sum: start\0must be at most 255")),
            start => {
                info.log(&format!("{} opened {:?}", info.node, info.direction));
                Ok(Self {
                    total: start.unwrap_or(0.0) as u8,
                })
            }
        }
    }

    fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault> {
        match input[0] {
            0 => Ok(Conversion::Consumed),
            254 => Err(Fault::new("sum: 254 is refused")),
            255 => panic!("255 at {}", self.total),
            value => {
                self.total += value;
                output[0] = self.total;
                Ok(Conversion::Produced)
            }
        }
    }
}

/// Panics while it is closed.
struct Stubborn;

impl Converter for Stubborn {
    fn open(_: &OpenInfo<'_>) -> Result<Self, Fault> {
        Ok(Self)
    }

    fn convert(&mut self, _: &[u8], _: &mut [u8]) -> Result<Conversion, Fault> {
        Ok(Conversion::Produced)
    }
}

impl Drop for Stubborn {
    fn drop(&mut self) {
        panic!("not yet");
    }
}

crate::export_converters! { "sum" => Sum, "stubborn" => Stubborn }

fn exported(index: usize) -> Descriptor {
    descriptors(trikfs_library_entry())
        .unwrap()
        .swap_remove(index)
}

fn open_sum(params: &[(&str, f64)], log: &dyn Fn(&str)) -> Result<Instance, Error> {
    let params = params
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value))
        .collect();
    exported(0).open(&OpenInfo {
        direction: Direction::Write,
        input_size: 1,
        output_size: 1,
        node: "a/b",
        params: &params,
        log,
    })
}

#[test]
fn the_entry_lists_what_the_macro_was_given() {
    let descriptors = descriptors(trikfs_library_entry()).unwrap();
    let names: Vec<_> = descriptors
        .iter()
        .map(|d| (d.name(), d.description()))
        .collect();
    assert_eq!(
        names,
        [("sum", "running sum of one byte"), ("stubborn", "")]
    );
}

#[test]
fn each_opening_has_a_state_and_a_fault_keeps_it() {
    let lines = RefCell::new(Vec::new());
    let log = |text: &str| lines.borrow_mut().push(text.to_owned());
    let mut first = open_sum(&[("start", 10.0)], &log).unwrap();
    let mut second = open_sum(&[], &log).unwrap();
    let mut output = [0];
    assert_eq!(first.convert(&[5], &mut output), Ok(Conversion::Produced));
    assert_eq!(output, [15]);
    assert_eq!(second.convert(&[5], &mut output), Ok(Conversion::Produced));
    assert_eq!(output, [5]);
    assert_eq!(first.convert(&[0], &mut output), Ok(Conversion::Consumed));
    assert_eq!(
        first.convert(&[254], &mut output).unwrap_err().text(),
        "sum: 254 is refused"
    );
    assert_eq!(first.convert(&[1], &mut output), Ok(Conversion::Produced));
    assert_eq!(output, [16]);
    drop((first, second));
    assert_eq!(lines.into_inner(), ["a/b opened Write", "a/b opened Write"]);
}

#[test]
fn refusals_and_panics_of_open_arrive_as_texts() {
    let refused = |start| {
        open_sum(&[("start", start)], &|_| ())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(refused(256.0), "sum: start must be at most 255");
    assert_eq!(
        refused(f64::NAN),
        "converter panicked: start is not a number"
    );
}

#[test]
fn a_panic_costs_the_opening_and_nothing_else() {
    let mut instance = open_sum(&[], &|_| ()).unwrap();
    let mut output = [0];
    let panicked = "converter panicked: 255 at 0";
    assert_eq!(
        instance.convert(&[255], &mut output).unwrap_err().text(),
        panicked
    );
    assert_eq!(
        instance.convert(&[1], &mut output).unwrap_err().text(),
        panicked
    );
    assert!(
        open_sum(&[], &|_| ())
            .unwrap()
            .convert(&[1], &mut output)
            .is_ok()
    );
}

#[test]
fn a_panic_of_a_destructor_stops_at_the_boundary() {
    let params = BTreeMap::new();
    let opened = exported(1).open(&OpenInfo {
        direction: Direction::Read,
        input_size: 1,
        output_size: 1,
        node: "n",
        params: &params,
        log: &|_| (),
    });
    drop(opened.unwrap());
}

#[test]
fn a_panic_of_the_hosts_log_stops_at_the_boundary() {
    assert!(open_sum(&[], &|_| panic!("the log is full")).is_ok());
}

/// What `open` says to a host with this information.
fn open_raw(spoil: impl FnOnce(&mut RawOpenInfo)) -> String {
    let mut info = RawOpenInfo {
        size: size_of::<RawOpenInfo>() as u32,
        direction: 0,
        input_size: 1,
        output_size: 1,
        param_count: 0,
        params: ptr::null(),
        node: ptr::null(),
        host: ptr::null_mut(),
        log: None,
    };
    spoil(&mut info);
    let mut state = ptr::null_mut();
    // SAFETY: both pointers are good; the spoilt fields are those that the shim checks.
    let code = unsafe { open::<Sum>(&raw const info, &raw mut state) };
    // SAFETY: `open` left the state.
    let text = unsafe { read_text(explain::<Sum>(state, FAULT), 100) }.unwrap();
    // SAFETY: as above, once.
    unsafe { close::<Sum>(state) };
    format!("{code} {}", one_line(&text))
}

#[test]
fn a_host_that_breaks_the_rules_is_refused() {
    assert_eq!(open_raw(|_| ()), "0 ");
    assert_eq!(
        open_raw(|info| info.size = 8),
        "2 the host's open info is shorter than version 1 demands"
    );
    assert_eq!(
        open_raw(|info| info.direction = 2),
        "2 the host's direction 2 is neither read nor write"
    );
    assert_eq!(
        open_raw(|info| info.param_count = 1),
        "2 the host's 1 parameters cannot be read"
    );
    assert_eq!(
        open_raw(|info| info.input_size = 65_537),
        "2 the host's tuples are larger than 65536 bytes"
    );
    // SAFETY: null is what the shim checks for.
    let codes = unsafe {
        (
            open::<Sum>(ptr::null(), ptr::null_mut()),
            convert::<Sum>(ptr::null_mut(), ptr::null(), 0, ptr::null_mut(), 0),
        )
    };
    assert_eq!(codes, (FAULT, FAULT));
    // SAFETY: null is allowed.
    unsafe { close::<Sum>(ptr::null_mut()) };
}
