//! Libraries that break the rules, the layout of the structs against the C header, and the templates as a loader sees them.

use super::*;
use crate::{Direction, templates};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::mem::offset_of;
use std::ptr;

/// Opens a descriptor for the given sizes and parameters.
fn open(
    descriptor: &Descriptor,
    sizes: (usize, usize),
    params: &[(&str, f64)],
) -> Result<Instance, Error> {
    let params: BTreeMap<String, f64> = params
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value))
        .collect();
    descriptor.open(&OpenInfo {
        direction: Direction::Read,
        input_size: sizes.0,
        output_size: sizes.1,
        node: "battery",
        params: &params,
        log: &|_| (),
    })
}

/// Loads a library as the steps at the top of `abi.rs` say.
fn load(path: &std::path::Path) -> Result<Vec<Descriptor>, LibraryFault> {
    // SAFETY: the library is a template of this crate, built by the test; it has no initialisers.
    let library = unsafe { libloading::Library::new(path) }.unwrap();
    // A leaked library is never unloaded.
    let library: &'static libloading::Library = Box::leak(Box::new(library));
    // SAFETY: the symbols have these types in the header that the templates were compiled with.
    let symbols = unsafe {
        (
            library.get::<Entry>(ENTRY_SYMBOL),
            library.get::<Plain>(PLAIN_SYMBOL),
        )
    };
    match symbols {
        // SAFETY: this is the entry's result, and the library is leaked.
        (Ok(entry), _) => unsafe { read_library(entry()) },
        // SAFETY: the template obeys the header, and the library is leaked.
        (_, Ok(plain)) => Ok(vec![unsafe { Descriptor::plain("plain", *plain) }]),
        (Err(error), _) => panic!("{error}"),
    }
}

unsafe extern "C" fn convert_ok(_: *mut c_void, _: *const u8, _: u32, _: *mut u8, _: u32) -> c_int {
    OK
}

fn raw_converter() -> RawConverter {
    RawConverter {
        abi_version: 1,
        size: size_of::<RawConverter>() as u32,
        name: c"nothing".as_ptr(),
        description: ptr::null(),
        input_size: 0,
        output_size: 0,
        open: None,
        convert: Some(convert_ok),
        close: None,
        explain: None,
    }
}

/// What `read_library` says of a library with these converters.
fn read(converters: &[*const RawConverter]) -> Result<Vec<Descriptor>, LibraryFault> {
    let library = RawLibrary {
        abi_version: 1,
        size: size_of::<RawLibrary>() as u32,
        count: converters.len() as u32,
        converters: converters.as_ptr(),
    };
    // SAFETY: all pointers are good or null, and nothing is ever unloaded.
    unsafe { read_library(&raw const library) }
}

/// The refusal of a library whose only converter has been spoilt.
fn refusal(spoil: impl FnOnce(&mut RawConverter)) -> String {
    let mut converter = raw_converter();
    spoil(&mut converter);
    read(&[&raw const converter]).unwrap_err().to_string()
}

#[test]
fn a_library_without_state_or_description_is_enough() {
    let converter = raw_converter();
    let descriptors = read(&[&raw const converter]).unwrap();
    assert_eq!(
        (descriptors[0].name(), descriptors[0].description()),
        ("nothing", "")
    );
    let mut instance = open(&descriptors[0], (3, 2), &[]).unwrap();
    let mut output = [7; 2];
    assert_eq!(
        instance.convert(&[1, 2, 3], &mut output),
        Ok(Conversion::Produced)
    );
    assert_eq!(output, [0, 0], "the output is zeroed before each call");
}

#[test]
fn every_broken_rule_is_named() {
    // SAFETY: null is allowed.
    let null = unsafe { read_library(ptr::null()) };
    assert_eq!(
        null.unwrap_err().to_string(),
        "the entry of the library returned no library"
    );
    assert_eq!(
        read(&[]).unwrap_err().to_string(),
        "library has 0 converters, the limit is 1 to 256"
    );
    assert_eq!(
        read(&[ptr::null()]).unwrap_err().to_string(),
        "converter 0 of the library is missing"
    );
    let good = raw_converter();
    let misaligned = (&raw const good).cast::<u8>().wrapping_add(1).cast();
    assert_eq!(
        read(&[&raw const good, misaligned])
            .unwrap_err()
            .to_string(),
        "converter 1 of the library is missing"
    );
    assert_eq!(
        read(&[&raw const good, &raw const good])
            .unwrap_err()
            .to_string(),
        "library has two converters named 'nothing'"
    );
    assert_eq!(
        refusal(|c| c.name = ptr::null()),
        "converter 0 of the library has no name"
    );
    assert_eq!(
        refusal(|c| c.name = c"No!".as_ptr()),
        "converter 0 of the library: byte 0 of its name is not one of a-z 0-9 _"
    );
    assert_eq!(
        refusal(|c| c.convert = None),
        "converter 'nothing' has no convert function"
    );
    assert_eq!(
        refusal(|c| c.abi_version = 2),
        "converter 0 of the library has abi version 2, this trikfs reads version 1"
    );
    assert!(
        refusal(|c| c.size = 8)
            .starts_with("converter 0 of the library says that its descriptor has 8 bytes")
    );
    assert!(
        refusal(|c| c.output_size = 1 << 20)
            .contains("output tuples of 1048576 bytes, the limit is 65536")
    );
}

#[test]
fn a_library_of_another_version_is_not_read_further_than_its_header() {
    #[repr(C, align(8))]
    struct Stub([u32; 2]);
    let library = Stub([2, 8]);
    // SAFETY: the two words of the header can be read, and no more is.
    let refused = unsafe { read_library((&raw const library).cast()) };
    assert_eq!(
        refused.unwrap_err().to_string(),
        "library has abi version 2, this trikfs reads version 1"
    );
}

#[test]
fn sizes_that_the_converter_does_not_take_are_refused_before_it_is_called() {
    let mut converter = raw_converter();
    (converter.input_size, converter.output_size) = (2, 4);
    let descriptors = read(&[&raw const converter]).unwrap();
    let refused = |sizes| open(&descriptors[0], sizes, &[]).unwrap_err().to_string();
    assert_eq!(
        refused((3, 4)),
        "converter 'nothing': input tuples must have 2 bytes, not 3"
    );
    assert_eq!(
        refused((2, 2)),
        "converter 'nothing': output tuples must have 4 bytes, not 2"
    );
    assert_eq!(
        refused((2, 65_537)),
        "converter 'nothing': output tuples of 65537 bytes, the limit is 1 to 65536"
    );
    assert_eq!(
        refused((0, 4)),
        "converter 'nothing': input tuples of 0 bytes, the limit is 1 to 65536"
    );
    let mut instance = open(&descriptors[0], (2, 4), &[]).unwrap();
    assert_eq!(
        instance.convert(&[1], &mut [0; 4]).unwrap_err().text(),
        "converter opened for 2 to 4 bytes got 1 to 4"
    );
}

unsafe extern "C" fn open_logs(info: *const RawOpenInfo, state: *mut *mut c_void) -> c_int {
    // SAFETY: the host obeys the header.
    let info = unsafe { &*info };
    if let Some(log) = info.log {
        // SAFETY: as above.
        unsafe { log(info.host, info.node) };
        // SAFETY: as above; a text that is not UTF-8 and has two lines.
        unsafe { log(info.host, c"two\nlines \xff".as_ptr()) };
    }
    // SAFETY: as above.
    unsafe { *state = 0x10 as *mut c_void };
    9
}

unsafe extern "C" fn explain_pointer(state: *mut c_void, code: c_int) -> *const c_char {
    if state as usize == 0x10 && code == 9 {
        c"not today\n".as_ptr()
    } else {
        ptr::null()
    }
}

#[test]
fn a_refused_opening_is_explained_and_what_it_logged_is_kept() {
    let mut converter = raw_converter();
    converter.open = Some(open_logs);
    converter.explain = Some(explain_pointer);
    let descriptors = read(&[&raw const converter]).unwrap();
    let lines = RefCell::new(Vec::new());
    let refused = descriptors[0].open(&OpenInfo {
        direction: Direction::Write,
        input_size: 1,
        output_size: 1,
        node: "motors/M1",
        params: &BTreeMap::new(),
        log: &|text| lines.borrow_mut().push(text.to_owned()),
    });
    assert_eq!(refused.unwrap_err().to_string(), "not today");
    assert_eq!(lines.into_inner(), ["motors/M1", "two lines \u{fffd}"]);
}

#[test]
fn names_that_c_cannot_hold_are_refused() {
    let mut converter = raw_converter();
    converter.open = Some(open_logs);
    let descriptors = read(&[&raw const converter]).unwrap();
    let refused = |name: &str| {
        open(&descriptors[0], (1, 1), &[(name, 1.0)])
            .unwrap_err()
            .to_string()
    };
    assert_eq!(refused("a\0b"), "parameter 'a\\0b' has a zero byte");
    assert_eq!(
        refused(&"a".repeat(65)),
        "a parameter's name has 65 bytes, the limit is 64"
    );
    assert_eq!(
        refused("count"),
        "open returned 9",
        "a fault without an explanation shows its code"
    );
}

#[test]
fn the_header_and_the_rust_structs_have_the_same_layout() {
    let program = r#"#include "trikfs_converter.h"
#include <stddef.h>
#include <stdio.h>
#define AT(s, m) printf("%u ", (unsigned)offsetof(s, m))
#define END(s) printf("%u\n", (unsigned)sizeof(s))
int main(void) {
  AT(trikfs_param, name); AT(trikfs_param, value); END(trikfs_param);
  AT(trikfs_open_info, size); AT(trikfs_open_info, direction); AT(trikfs_open_info, input_size);
  AT(trikfs_open_info, output_size); AT(trikfs_open_info, param_count); AT(trikfs_open_info, params);
  AT(trikfs_open_info, node); AT(trikfs_open_info, host); AT(trikfs_open_info, log); END(trikfs_open_info);
  AT(trikfs_converter, abi_version); AT(trikfs_converter, size); AT(trikfs_converter, name);
  AT(trikfs_converter, description); AT(trikfs_converter, input_size); AT(trikfs_converter, output_size);
  AT(trikfs_converter, open); AT(trikfs_converter, convert); AT(trikfs_converter, close);
  AT(trikfs_converter, explain); END(trikfs_converter);
  AT(trikfs_library, abi_version); AT(trikfs_library, size); AT(trikfs_library, count);
  AT(trikfs_library, converters); END(trikfs_library);
  return 0;
}"#;
    macro_rules! layout {
        ($type:ty: $($field:ident)+) => {
            format!("{}{}\n", [$(format!("{} ", offset_of!($type, $field))),+].concat(), size_of::<$type>())
        };
    }
    let ours = [
        layout!(RawParam: name value),
        layout!(RawOpenInfo: size direction input_size output_size param_count params node host log),
        layout!(RawConverter: abi_version size name description input_size output_size open convert close explain),
        layout!(RawLibrary: abi_version size count converters),
    ];
    assert_eq!(templates::run_c("layout", program), ours.concat());
}

#[test]
fn the_plain_template_converts_a_battery() {
    let descriptors = load(&templates::build_c("plain", "plain")).unwrap();
    let mut instance = open(&descriptors[0], (2, 4), &[]).unwrap();
    let mut output = [0; 4];
    // By hand: 512 * 13256 / 1023 = 6634.48 mV, 6634 = 0x19ea.
    assert_eq!(
        instance.convert(&[0x00, 0x02], &mut output),
        Ok(Conversion::Produced)
    );
    assert_eq!(output, [0xea, 0x19, 0, 0]);
    let mut wrong = open(&descriptors[0], (3, 4), &[]).unwrap();
    assert_eq!(
        wrong.convert(&[0; 3], &mut output).unwrap_err().text(),
        "converter returned 1"
    );
}

/// What both versioned templates do.
fn check_battery_mean(descriptors: &[Descriptor]) {
    let [battery] = descriptors else {
        panic!("one converter")
    };
    assert_eq!(battery.name(), "battery_mean");
    assert_eq!(
        battery.description(),
        "voltage of the battery in millivolts, mean of `count` samples"
    );
    for count in [0.0, f64::NAN, 1001.0] {
        let refused = open(battery, (2, 4), &[("count", count)]).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "battery_mean: count must be from 1 to 1000"
        );
    }
    let mut output = [0; 4];
    let mut instance = open(battery, (2, 4), &[("count", 2.0), ("other", 1.0)]).unwrap();
    assert_eq!(
        instance.convert(&[0x00, 0x02], &mut output),
        Ok(Conversion::Consumed)
    );
    let silent = instance.convert(&[0xff, 0xff], &mut output).unwrap_err();
    assert_eq!(
        silent.text(),
        "battery_mean: the converter chip does not answer"
    );
    // By hand: the mean of 512 and 514 is 513; 513 * 13256 / 1023 = 6647.44 mV, 6647 = 0x19f7.
    assert_eq!(
        instance.convert(&[0x02, 0x02], &mut output),
        Ok(Conversion::Produced)
    );
    assert_eq!(output, [0xf7, 0x19, 0, 0]);
}

#[test]
fn the_versioned_template_in_c_keeps_a_state_for_each_opening() {
    check_battery_mean(&load(&templates::build_c("c", "battery_mean")).unwrap());
}

#[test]
fn the_rust_template_does_the_same_as_the_one_in_c() {
    check_battery_mean(&load(&templates::build_rust()).unwrap());
}
