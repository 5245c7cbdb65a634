//! The fuzz targets of what stands below the tree, each for a moment on random, mutated and truncated bytes.
//!
//! Begins with `fuzz/seeds`, as libFuzzer does. The targets of other crates are run by their own tests: this program is also
//! built for the controller, which has none of them.

use ::config::fuzz as config_fuzz;
use harness::fuzz::run;
use std::path::Path;

/// The inputs of `fuzz/seeds/NAME`, in the order of their names.
fn seeds(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../fuzz/seeds")).join(name);
    let entries = std::fs::read_dir(&folder).expect("a folder of seeds");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("a seed").path()).collect();
    paths.sort();
    let read = |path| std::fs::read(path).expect("a seed");
    paths.into_iter().map(read).collect()
}

fn run_seeds(name: &str, target: fn(&[u8])) {
    let seeds = seeds(name);
    let seeds: Vec<&[u8]> = seeds.iter().map(Vec::as_slice).collect();
    assert!(!seeds.is_empty(), "no seeds for {name}");
    run(name, target, &seeds);
}

#[test]
fn requests_of_a_strange_kernel_do_no_harm() {
    let target = trikfs::transport::native::fuzz_decode;
    run_seeds("decode", target);
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
    run("decode", target, &samples);
}

#[test]
fn libraries_that_lie_about_themselves_do_no_harm() {
    run_seeds("library", converter::abi::fuzz_library);
}

#[test]
fn configurations_of_any_bytes_do_no_harm() {
    run_seeds("load", config_fuzz::fuzz_load);
}

#[test]
fn formats_of_any_bytes_do_no_harm() {
    run_seeds("format", config_fuzz::fuzz_format);
}

#[test]
fn patterns_of_any_bytes_do_no_harm() {
    run_seeds("pattern", config_fuzz::fuzz_pattern);
}
