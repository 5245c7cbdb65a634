//! Fuzz targets as plain functions: any bytes may come in, nothing but time and memory within limits may go.
//!
//! Run by the integration tests of the project with a printed seed, and by anybody's fuzzer.

use crate::format::Format;
use crate::limits::{FUZZ_MEMORY_BYTES, FUZZ_TIME_MS};
use crate::load::Loader;
use crate::vm::pattern;

/// Loads the bytes as a configuration; if it is good, makes a state for each node and converts a tuple with each of its Lua stages.
pub fn fuzz_load(bytes: &[u8]) {
    use converter::Direction;
    let Ok(loaded) =
        Loader::default().load_within("fuzz.lua", None, bytes, FUZZ_TIME_MS, FUZZ_MEMORY_BYTES)
    else {
        return;
    };
    for node in &loaded.config.nodes {
        let Ok(mut vm) = loaded.program.open(&node.path) else {
            continue;
        };
        vm.limit(1024, 1_000);
        for (position, stage) in node.converter.iter().enumerate() {
            let (input_size, output_size) = (stage.input_size, stage.output_size);
            let Ok(id) = vm.bind(
                &node.path,
                Direction::Read,
                position,
                input_size,
                output_size,
            ) else {
                continue;
            };
            // A fault is as good as a result.
            let _ = vm.convert(id, &vec![0; input_size], &mut vec![0; output_size]);
        }
    }
}

/// Parses the bytes as a format; what is one must read back from its own text, and render what it encoded.
pub fn fuzz_format(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(format) = Format::parse(&text) else {
        return;
    };
    assert_eq!(Format::parse(&format.to_string()).as_ref(), Ok(&format));
    let mut tuple: Vec<u8> = bytes.iter().copied().cycle().take(format.size()).collect();
    let mut rendered = String::new();
    if format.render(&tuple, &mut rendered).is_ok() {
        let before = tuple.clone();
        assert_eq!(format.encode(&rendered, &mut tuple), Ok(()));
        assert_eq!(tuple, before);
    }
}

/// Splits the bytes at the first zero byte into a pattern and a subject, and matches.
pub fn fuzz_pattern(bytes: &[u8]) {
    let mut parts = bytes.splitn(2, |byte| *byte == 0);
    let (wanted, subject) = (
        parts.next().unwrap_or_default(),
        parts.next().unwrap_or_default(),
    );
    for from in [0, subject.len() / 2, subject.len(), subject.len() + 1] {
        if let Ok(Some(found)) = pattern::find(subject, wanted, from, true) {
            assert!(from <= found.start && found.start <= found.end && found.end <= subject.len());
        }
        // Too many steps is an answer, too.
        let _ = pattern::find_plain(subject, wanted, from);
    }
}
