//! The fuzz targets of all crates, each for a moment on random, mutated and truncated bytes.
//!
//! Those of `trikd` are run by its own tests: this program is also built for the controller, which has no `trikd` yet.

use harness::fuzz::run;

#[test]
fn requests_of_a_strange_kernel_do_no_harm() {
    let mut samples = Vec::new();
    // A header and a body for each operation code of linux/fuse.h.
    for opcode in 0u32..54 {
        let mut bytes = vec![0u8; 40 + 64];
        let size = u32::try_from(bytes.len()).unwrap();
        bytes[..4].copy_from_slice(&size.to_ne_bytes());
        bytes[4..8].copy_from_slice(&opcode.to_ne_bytes());
        bytes[8] = 1;
        bytes[16] = 1;
        samples.push(bytes);
    }
    let samples: Vec<&[u8]> = samples.iter().map(Vec::as_slice).collect();
    run("decode", trikfs::transport::native::fuzz_decode, &samples);
}

#[test]
fn libraries_that_lie_about_themselves_do_no_harm() {
    let good: Vec<u8> = [1u32, 24, 1, 1, 72, 0, 0, 0, 0]
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .collect();
    run(
        "library",
        converter::abi::fuzz_library,
        &[&good, &[0; 200], &[0xff; 200]],
    );
}

#[test]
fn configurations_of_any_bytes_do_no_harm() {
    let hello = include_bytes!("../../config/lua/hello.lua");
    let words: &[&[u8]] = &[
        hello,
        b"trikfs = { a = { src = '/dev/zero', input_tuple_size = 4, format = 'i16 x, >u16 y', poll_ms = 5, rest = { 0, 0 } } }",
        b"trikfs = { a = { src = { 'trikfs:b', fake{ data = 'x' } }, input_tuple_size = { 1, 1 } }, b = { src = evdev{ path = 'e', axes = { 'ABS_X' } } } }",
        b"for i = 1, 10 do trikfs = { ['n' .. i] = { src = '/dev/null', input_tuple_size = i, output_tuple_size = i, converter = id_create(i) } } end",
        b"local s = ('x'):rep(100):gsub('(x)(x*)', '%2%1') trikfs = { g = { n = { src = replay{ path = s } } } }",
    ];
    run("load", config_fuzz::fuzz_load, words);
}

#[test]
fn formats_of_any_bytes_do_no_harm() {
    run(
        "format",
        config_fuzz::fuzz_format,
        &[
            b"i16 x, i16 y, u8 flags",
            b">f64 a,u64 b",
            b"u8 a, u8 a",
            b"1 2 3",
            b"-0x1p4 nan 1e400",
        ],
    );
}

#[test]
fn patterns_of_any_bytes_do_no_harm() {
    run(
        "pattern",
        config_fuzz::fuzz_pattern,
        &[
            b"^(%a+)%s*=%s*(.-)$\0name = value",
            b"%b()%f[%w]\0(a(b)c)",
            b"[%a-z^]]*-+?\0aaaa",
            b"%1(x)\0xx",
        ],
    );
}

/// The module of the crate `config`, under a name that is not that of a folder of tests.
use ::config::fuzz as config_fuzz;
