//! Tests of registers and absent ports: defaults, sizes, every refusal with its words.

use crate::description::{
    AbsentDescription, I2cBusDescription, I2cDescription, I2cTransfer, SourceDescription,
};
use crate::load::Loader;

fn source(src: &str, more: &str) -> Result<(SourceDescription, usize, u16), String> {
    let text = format!("trikfs = {{ x = {{\nsrc = {src}, {more} }} }}");
    let loaded = Loader::default().load("robot.lua", None, text.as_bytes());
    let node = loaded.map_err(|problem| problem.to_string())?.config.nodes;
    Ok((
        node[0].source.clone(),
        node[0].input_tuple_size,
        node[0].mode,
    ))
}

fn refused(src: &str, more: &str) -> String {
    source(src, more).unwrap_err()
}

#[test]
fn a_register_has_the_defaults_of_the_manual() {
    let word = "i2c{ path = '/dev/i2c-2', address = 0x48, register = 0x25, transfer = 'word' }";
    let expected = I2cDescription {
        path: "/dev/i2c-2".into(),
        address: 0x48,
        register: 0x25,
        register_bytes: 1,
        transfer: I2cTransfer::Word,
        write_transfer: I2cTransfer::Word,
        readable: true,
        once: false,
    };
    assert_eq!(
        source(word, ""),
        Ok((SourceDescription::I2c(expected), 2, 0o644))
    );
    let block = "i2c{ '/dev/i2c-2', address = 0x48, register = 0x30, transfer = 'block', write_transfer = 'byte' }";
    let Ok((SourceDescription::I2c(block), 4, _)) = source(block, "format = 'i32 ticks'") else {
        panic!("{:?}", source(block, "format = 'i32 ticks'"))
    };
    assert_eq!(
        (block.transfer, block.write_transfer),
        (I2cTransfer::Block, I2cTransfer::Byte)
    );
    let raw = "i2c{ path = '/dev/i2c-1', address = 0x33, register = 0x2400, register_bytes = 2, transfer = 'raw', once = true }";
    let Ok((SourceDescription::I2c(raw), 1664, _)) = source(raw, "input_tuple_size = 1664") else {
        panic!("raw")
    };
    assert_eq!(
        (raw.register, raw.register_bytes, raw.once),
        (0x2400, 2, true)
    );
}

const AT: &str = "robot.lua:2: x: ";

fn i2c(rest: &str) -> String {
    format!("i2c{{ path = '/dev/i2c-2', {rest} }}")
}

fn wrong_registers() -> Vec<(String, &'static str)> {
    vec![
        (
            i2c("register = 1, transfer = 'byte'"),
            "i2c: address is missing",
        ),
        (
            i2c("address = 0x48, transfer = 'byte'"),
            "i2c: register is missing",
        ),
        (
            i2c("address = 0x48, register = 1"),
            "i2c: transfer is missing",
        ),
        (
            "i2c{ address = 0x48, register = 1, transfer = 'byte' }".to_owned(),
            "i2c: path is missing",
        ),
        (
            i2c("address = 0x78, register = 1, transfer = 'byte'"),
            "address must be a whole number from 3 to 119, not 120",
        ),
        (
            i2c("address = '0x48', register = 1, transfer = 'byte'"),
            "address must be a number, not a string",
        ),
        (
            i2c("address = 0x48, register = 256, transfer = 'byte'"),
            "register must be a whole number from 0 to 255, not 256",
        ),
        (
            i2c("address = 0x48, register = 1, transfer = 'bytes'"),
            "i2c: transfer must be 'byte', 'word', 'block' or 'raw', not 'bytes', did you mean 'byte'",
        ),
        (
            i2c("address = 0x48, register = 1, register_bytes = 2, transfer = 'word'"),
            "i2c: register_bytes = 2 needs transfer = 'raw'; SMBus registers have one byte",
        ),
        (
            i2c("address = 0x48, register = 1, transfer = 'byte', once = true, readable = false"),
            "i2c: once makes no sense with readable = false: nothing is ever read",
        ),
        (
            i2c("address = 0x48, register = 1, transfer = 'byte', speed = 1"),
            "i2c: unknown key 'speed'",
        ),
        (
            i2c("address = 0x48, register = 1, transfer = 'block', write_transfer = 'word'"),
            "i2c: a tuple has 1 bytes, but write_transfer = 'word' takes at least 2",
        ),
        ("absent{}".to_owned(), "absent: reason is missing: say why"),
        (
            "absent{ reason = 'no', why = 1 }".to_owned(),
            "absent: unknown key 'why'",
        ),
    ]
}

#[test]
fn what_no_bus_can_do_is_refused() {
    for (src, reason) in wrong_registers() {
        let more = if src.contains("block") || src.contains("absent") {
            "input_tuple_size = 1"
        } else {
            ""
        };
        assert_eq!(refused(&src, more), format!("{AT}{reason}"), "{src}");
    }
}

#[test]
fn sizes_that_no_transfer_has_are_refused() {
    let i2c = |rest: &str| format!("i2c{{ path = '/dev/i2c-2', {rest} }}");
    let block = i2c("address = 0x48, register = 1, transfer = 'block'");
    assert_eq!(
        refused(&block, "input_tuple_size = 33"),
        format!("{AT}i2c: a tuple has 33 bytes, but transfer = 'block' takes at most 32")
    );
    let word = i2c("address = 0x48, register = 1, transfer = 'word'");
    assert_eq!(
        refused(&word, "input_tuple_size = 4"),
        format!("{AT}input_tuple_size is 4, but the source gives tuples of 2 bytes")
    );
}

#[test]
fn an_absent_port_is_described_like_one_that_is_there() {
    let absent = source(
        "absent{ reason = 'no such port on this board' }",
        "format = 'i8 power', rest = 0",
    );
    let expected = SourceDescription::Absent(AbsentDescription {
        reason: "no such port on this board".to_owned(),
    });
    assert_eq!(absent, Ok((expected, 1, 0o644)));
}

#[test]
fn a_whole_bus_has_a_path_and_addresses_that_are_out_of_reach() {
    let bus = "i2c_bus{ path = '/dev/i2c-2', reserved = { 0x48, 0x1c } }";
    let expected = I2cBusDescription {
        path: "/dev/i2c-2".into(),
        reserved: vec![0x48, 0x1c],
    };
    assert_eq!(
        source(bus, ""),
        Ok((SourceDescription::I2cBus(expected), 1, 0o644))
    );
    for (bus, reason) in [
        ("i2c_bus{}", "i2c_bus: path is missing"),
        ("i2c_bus{ 'dev/i2c-2' }", "must begin with a slash"),
        ("i2c_bus{ '/d', reserved = 0x48 }", "a list of addresses"),
        ("i2c_bus{ '/d', reserved = { 2 } }", "reserved"),
        ("i2c_bus{ '/d', reserved = { 72.5 } }", "reserved"),
        ("i2c_bus{ '/d', reserve = {} }", "reserve"),
    ] {
        let refusal = refused(bus, "");
        assert!(refusal.contains(reason), "{bus}: {refusal}");
    }
}
