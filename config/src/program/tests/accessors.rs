//! Tests of byte arrays: places outside, values that are no numbers, both byte orders, and who may touch what.

use super::*;

#[test]
fn bytes_outside_an_array_are_a_fault() {
    assert_eq!(
        fault("ba.get(a, 4)"),
        "test.lua:1: position 4 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.get(a, -1)"),
        "test.lua:1: position -1 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.set(b, 7, 1)"),
        "test.lua:1: position 7 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.get(a, 0.5)"),
        "test.lua:1: position 0.5 is not a whole number"
    );
    assert_eq!(
        fault("ba.get(a, 0 / 0)"),
        "test.lua:1: position nan is not a whole number"
    );
    assert_eq!(
        fault("ba.get(a, 1e300)"),
        "test.lua:1: position 1e+300 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.get(a, 1 / 0)"),
        "test.lua:1: position inf is not a whole number"
    );
    assert_eq!(
        fault("ba.get(a, '0')"),
        "test.lua:1: a position is a number, not a string"
    );
    assert_eq!(
        fault("ba.get(a)"),
        "test.lua:1: a position is a number, not a nil"
    );
    assert_eq!(
        fault("ba.get(true, 0)"),
        "test.lua:1: not a byte array: true"
    );
    assert_eq!(fault("ba.get(nil, 0)"), "test.lua:1: not a byte array: nil");
    assert_eq!(fault("ba.len(7)"), "test.lua:1: not a byte array: 7");
    assert_eq!(
        fault("ba.i32(a, 1)"),
        "test.lua:1: 4 bytes at position 1 are outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.i16_be(a, -1)"),
        "test.lua:1: 2 bytes at position -1 are outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.f64(b, 0, 1)"),
        "test.lua:1: 8 bytes at position 0 are outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.u8(b, 4, 1)"),
        "test.lua:1: 1 bytes at position 4 are outside the array of 4 bytes"
    );
}

#[test]
fn a_value_that_is_no_number_is_a_fault() {
    assert_eq!(
        fault("ba.set(b, 0, 0 / 0)"),
        "test.lua:1: the value nan is not finite"
    );
    assert_eq!(
        fault("ba.set(b, 0, 1 / 0)"),
        "test.lua:1: the value inf is not finite"
    );
    assert_eq!(
        fault("ba.set(b, 0)"),
        "test.lua:1: a value is a number, not a nil"
    );
    assert_eq!(
        fault("ba.set(b, 0, '1')"),
        "test.lua:1: a value is a number, not a string"
    );
    assert_eq!(
        fault("ba.i16(b, 0, nil)"),
        "test.lua:1: a value is a number, not a nil"
    );
    assert_eq!(
        fault("ba.f32(b, 0, nil)"),
        "test.lua:1: a value is a number, not a nil"
    );
    assert_eq!(
        fault("ba.u32(b, 0, -1 / 0)"),
        "test.lua:1: the value -inf is not finite"
    );
}

#[test]
fn set_takes_the_low_bits() {
    let set = |value: &str| {
        converted(
            &format!("function(_, a, _, b) ba.set(b, 0, {value}) end"),
            &[0],
            1,
        )
        .unwrap()[0]
    };
    assert_eq!(set("256"), 0);
    assert_eq!(set("-1"), 255);
    assert_eq!(set("3.7"), 3);
    assert_eq!(set("-3.7"), 253);
    assert_eq!(set("2 ^ 31 + 5"), 5);
    assert_eq!(set("2 ^ 53 + 2"), 2);
    assert_eq!(set("-2 ^ 31 - 1"), 255);
    let typed =
        |call: &str| converted(&format!("function(_, a, _, b) ba.{call} end"), &[0; 4], 4).unwrap();
    assert_eq!(typed("u32(b, 0, 2 ^ 32 - 1)"), [255; 4]);
    assert_eq!(typed("u32(b, 0, -1)"), [255; 4]);
    assert_eq!(typed("i32(b, 0, 2 ^ 31)"), [0, 0, 0, 0x80]);
    assert_eq!(typed("i16_be(b, 1, 0x12345)"), [0, 0x23, 0x45, 0]);
    assert_eq!(typed("u8(b, 3, 511)"), [0, 0, 0, 255]);
}

#[test]
fn typed_accessors_read_and_write_both_byte_orders() {
    let bytes: Vec<u8> = (0x81..0x89).collect();
    for (name, value) in [
        ("i8", -127.0),
        ("u8", 129.0),
        ("i8_be", -127.0),
        ("i16", f64::from(i16::from_le_bytes([0x81, 0x82]))),
        ("i16_be", f64::from(i16::from_be_bytes([0x81, 0x82]))),
        ("u16", f64::from(u16::from_le_bytes([0x81, 0x82]))),
        ("u16_be", f64::from(u16::from_be_bytes([0x81, 0x82]))),
        (
            "i32",
            f64::from(i32::from_le_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "i32_be",
            f64::from(i32::from_be_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "u32",
            f64::from(u32::from_le_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "u32_be",
            f64::from(u32::from_be_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "f32",
            f64::from(f32::from_le_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "f32_be",
            f64::from(f32::from_be_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "f64",
            f64::from_le_bytes([0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88]),
        ),
        (
            "f64_be",
            f64::from_be_bytes([0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88]),
        ),
    ] {
        let copy = format!(
            "function(_, a, _, b) local v = ba.{name}(a, 0) ba.{name}(b, 0, v) ba.f64(b, 8, v) end"
        );
        let output = converted(&copy, &bytes, 16).unwrap();
        let size = output.iter().take(8).take_while(|byte| **byte != 0).count();
        assert_eq!(output[..size], bytes[..size], "{name}");
        assert_eq!(
            f64::from_le_bytes(output[8..].try_into().unwrap()),
            value,
            "{name}"
        );
    }
    assert_eq!(evaluated("ba.i15"), "nil");
    assert_eq!(evaluated("rawget(ba, 'i16') or type(ba.i16)"), "function");
}

#[test]
fn no_bits_of_a_float_become_anything_but_a_number() {
    // In a loop, so that compiled code is seen as well; a table, a string or nil would be told by `type`.
    let is_number = |name: &str, bytes: &[u8]| {
        let look = format!(
            "function(_, a, _, b) for i = 1, 300 do local v = ba.{name}(a, 0)
               if type(v) ~= 'number' or v == v then error('it is a ' .. type(v), 0) end end ba.u8(b, 0, 1) end"
        );
        assert_eq!(converted(&look, bytes, 1), Ok(vec![1]), "{name} {bytes:x?}");
    };
    for low in [0_u64, 1, 0x4141_4141_4141, 0xffff_ffff_ffff] {
        for high in 0xfff8..=0xffff_u64 {
            let bits = high << 48 | low;
            is_number("f64", &bits.to_le_bytes());
            is_number("f64_be", &bits.to_be_bytes());
        }
        for high in (0xff81..=0xffff_u32).step_by(9).chain([0xffff, 0x7fc1]) {
            let bits = high << 16 | low as u32 & 0xffff;
            is_number("f32", &bits.to_le_bytes());
            if high & 3 == 0 {
                is_number("f32_be", &bits.to_be_bytes());
            }
        }
    }
}

#[test]
fn two_arrays_of_a_stage_and_two_stages_do_not_mix() {
    let source = "trikfs = { x = { src = '/dev/null', converter = {
        function(n, a, m, b) for i = 0, n - 1 do ba.set(b, i, ba.get(a, i) + 1) end end,
        { converter = function(n, a, m, b) ba.set(b, 0, ba.get(a, 0) * 2) end, output_tuple_size = 1 } } } }";
    let mut vm = program(source).open("x").unwrap();
    let first = vm.bind("x", Direction::Read, 0, 2, 2).unwrap();
    let second = vm.bind("x", Direction::Write, 1, 2, 1).unwrap();
    let (mut middle, mut output) = ([0; 2], [0]);
    for i in 0..200 {
        vm.convert(first, &[i, i], &mut middle).unwrap();
        assert_eq!(middle, [i + 1, i + 1]);
        vm.convert(second, &middle, &mut output).unwrap();
        assert_eq!(output, [(i + 1).wrapping_mul(2)]);
    }
    let error = vm.convert(first, &[1], &mut [0; 2]).unwrap_err();
    let error = error.to_string();
    assert_eq!(error, "the stage takes 2 bytes and gives 2, not 1 and 2");
}

#[test]
fn a_byte_array_is_opaque() {
    assert_eq!(
        fault("a[0] = 1"),
        "test.lua:1: use ba.set to write a byte array"
    );
    assert_eq!(fault("error(tostring(getmetatable(a)), 0)"), "false");
    assert_eq!(
        fault("setmetatable(a, {})"),
        "test.lua:1: cannot change a protected metatable"
    );
    assert_eq!(fault("error(tostring(next(a)), 0)"), "nil");
    assert_eq!(fault("error(ba.len(a) + #a, 0)"), "4");
}
