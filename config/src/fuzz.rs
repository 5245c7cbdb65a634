//! Fuzz targets as plain functions: any bytes may come in, nothing but time and memory within limits may go.
//!
//! Run by unit tests with a printed seed, and by anybody's fuzzer.

use crate::format::Format;
use crate::load::Loader;
use crate::vm::pattern;

/// Milliseconds for one configuration.
const TIME_MS: u32 = 50;
/// Bytes of Lua memory for one configuration.
const MEMORY_BYTES: usize = 4 << 20;

/// Loads the bytes as a configuration; if it is good, prepares a state and converts a tuple with each Lua stage.
pub fn fuzz_load(bytes: &[u8]) {
    use converter::Direction;
    let Ok(loaded) = Loader::default().load_within("fuzz.lua", None, bytes, TIME_MS, MEMORY_BYTES)
    else {
        return;
    };
    let Ok(mut vm) = loaded.program.prepare() else {
        return;
    };
    vm.limit(1024, 1_000);
    for node in &loaded.config.nodes {
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant, SystemTime};

    /// A small generator (xorshift, Marsaglia 2003): tests must be able to repeat what they printed.
    struct Random(u32);

    impl Random {
        fn new(name: &str) -> Self {
            let now = SystemTime::now()
                .duration_since(SystemTime::UNIX_EPOCH)
                .map_or(1, |t| t.subsec_nanos());
            let fixed = std::env::var("TRIKFS_FUZZ_SEED")
                .ok()
                .and_then(|seed| seed.parse().ok());
            let seed = fixed.unwrap_or(now).max(1);
            println!("{name}: TRIKFS_FUZZ_SEED={seed}");
            Self(seed)
        }

        fn below(&mut self, limit: usize) -> usize {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 17;
            self.0 ^= self.0 << 5;
            usize::try_from(self.0).unwrap_or(0) % limit.max(1)
        }
    }

    /// Mutates the seeds for a while: bytes changed, removed, doubled, pieces of others put in.
    fn run(name: &str, seeds: &[&[u8]], target: fn(&[u8])) {
        let mut random = Random::new(name);
        let end = Instant::now() + Duration::from_millis(700);
        while Instant::now() < end {
            let mut bytes = seeds[random.below(seeds.len())].to_vec();
            for _ in 0..random.below(6) {
                let at = random.below(bytes.len());
                match random.below(4) {
                    0 if !bytes.is_empty() => bytes[at] = random.below(256) as u8,
                    1 if !bytes.is_empty() => drop(bytes.remove(at)),
                    2 => {
                        let other = seeds[random.below(seeds.len())];
                        let from = random.below(other.len());
                        let to = from + random.below(other.len() - from);
                        bytes.splice(at..at, other[from..to].iter().copied());
                    }
                    _ => {
                        let piece = bytes[at..bytes.len().min(at + 8)].to_vec();
                        bytes.splice(at..at, piece);
                    }
                }
            }
            target(&bytes);
        }
    }

    #[test]
    fn any_bytes_are_a_configuration_or_a_problem() {
        let seeds: [&[u8]; 5] = [
            b"trikfs = { x = { src = '/dev/x', input_tuple_size = 4, output_tuple_size = 4, converter = id_create(4) } }",
            b"trikfs = { m = { l = { src = fake{ data = 'abcd' }, format = 'i16 x, >u16 y', poll_ms = 5, mode = 0644 } } }",
            b"trikfs = { a = { src = { 'trikfs:b', '/dev/c' }, input_tuple_size = { 2, 2 }, output_tuple_size = 1, converter = function(n, a, m, b) ba.set(b, 0, ba.u16(a, 0)) return false end }, b = { src = '/dev/d', input_tuple_size = 2 } }",
            b"local t = {} for i = 1, 3 do t['n' .. i] = { src = evdev{ path = '/dev/e', axes = { 'ABS_X' } }, attributes = { s = { src = '/x', format = 'f32 v', params = { k = 1 } } } } end trikfs = t",
            b"trikfs = { x = { src = '/dev/x', input_tuple_size = 4, output_tuple_size = 4, converter = { code = [[int converter;]] }, write_converter = { id_create(4), { converter = id_create(2), output_tuple_size = 4 } }, rest = { 0, 0, 0, 0 } } } print(('x'):rep(3), string.find('a.b', '%.'), pcall(error))",
        ];
        run("fuzz_load", &seeds, fuzz_load);
    }

    #[test]
    fn any_bytes_are_a_format_or_an_error() {
        run(
            "fuzz_format",
            &[b"i16 x, >u16 y", b"f32 a,f64 b,i64 c,>u64 d", b"u8 _"],
            fuzz_format,
        );
    }

    #[test]
    fn any_bytes_match_or_do_not() {
        let seeds: [&[u8]; 4] = [
            b"(%a+)=(%d*)\0x=12",
            b"%b()%f[%w]\0(a(b)c)d",
            b"^[^a-z%d]-()$\0ABC",
            b"(.)%1.?\0aab",
        ];
        run("fuzz_pattern", &seeds, fuzz_pattern);
    }
}
