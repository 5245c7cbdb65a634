//! The fuzz targets of all crates, each for a moment on random, mutated and truncated bytes.
//!
//! The seed is printed; `TRIK_FUZZ_SEED` repeats a run, `TRIK_FUZZ_MS` makes it longer. A target is a plain function
//! that must neither panic nor take long, whatever the bytes.

use std::time::{Duration, Instant};

/// Small numbers that look random (Marsaglia, Xorshift RNGs, 2003).
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    fn below(&mut self, limit: usize) -> usize {
        self.next() as usize % limit.max(1)
    }

    fn byte(&mut self) -> u8 {
        self.next().to_le_bytes()[1]
    }
}

fn seed() -> u32 {
    let given = std::env::var("TRIK_FUZZ_SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    given.unwrap_or_else(|| {
        let now = std::time::SystemTime::now()
            .duration_since(std::time::UNIX_EPOCH)
            .unwrap_or_default();
        now.subsec_nanos() ^ std::process::id()
    })
}

/// Changes some bytes, cuts, repeats or joins pieces of the samples.
fn mutated(random: &mut Random, samples: &[&[u8]]) -> Vec<u8> {
    let mut bytes = samples[random.below(samples.len())].to_vec();
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len());
        match random.below(7) {
            0 => bytes.truncate(at),
            1 => bytes.insert(at, random.byte()),
            2 if !bytes.is_empty() => bytes[at] = random.byte(),
            3 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            4 => {
                let piece = bytes[at..bytes.len().min(at + random.below(40))].to_vec();
                bytes.splice(at..at, piece);
            }
            5 => {
                let other = samples[random.below(samples.len())];
                bytes.extend_from_slice(&other[random.below(other.len())..]);
            }
            _ => bytes = (0..random.below(200)).map(|_| random.byte()).collect(),
        }
    }
    bytes
}

fn run(name: &str, target: impl Fn(&[u8]), samples: &[&[u8]]) {
    let seed = seed().max(1);
    println!("fuzz {name}: TRIK_FUZZ_SEED={seed}");
    let limit = std::env::var("TRIK_FUZZ_MS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(1500);
    let end = Instant::now() + Duration::from_millis(limit);
    let mut random = Random(seed);
    samples.iter().for_each(|sample| target(sample));
    while Instant::now() < end {
        let bytes = mutated(&mut random, samples);
        let start = Instant::now();
        if let Err(panic) =
            std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| target(&bytes)))
        {
            eprintln!("fuzz {name} failed on {}", bytes.escape_ascii());
            std::panic::resume_unwind(panic);
        }
        assert!(
            start.elapsed() < Duration::from_secs(10),
            "{name} took {:?} for {}",
            start.elapsed(),
            bytes.escape_ascii()
        );
    }
}

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

#[test]
fn frames_of_strange_clients_do_no_harm() {
    let samples: &[&[u8]] = &[
        b"7:version13:configVersion9:keepalive",
        b" 7 :version0:-5:abc:+2:ok99999999999:3:a:b",
        b"2147483647:x",
        b"4:data5:ports9:sensor:A1",
    ];
    run("frames", trikd::fuzz::fuzz_frames, samples);
    let messages: &[&[u8]] = &[
        b"file:a/b.js:text",
        b"file:../x:y",
        b"run:a.py",
        b"sensor:GyroscopePortX",
        b"sensor:button:Left",
        b"register:8889:7",
        b"connection:127.0.0.1:8896:9",
        b"connection:fe80::1:8889:-2",
        b"data:a:b",
        b"pad 1 -100 100 ",
        b"btn 3 down",
        b"custom a b",
    ];
    run("messages", trikd::fuzz::fuzz_messages, messages);
}

#[test]
fn lines_and_requests_of_strangers_do_no_harm() {
    let lines: &[&[u8]] = &[b"pad 1 0 0\nwheel 5\n", b"\xd0\xb0\n\xff", &[b'x'; 300]];
    run("lines", trikd::fuzz::fuzz_lines, lines);
    let strangers: &[&[u8]] = &[
        b"GET /?action=stream HTTP/1.1\r\nHost: x\r\n\r\n",
        b"\0\x07\0\0\0\x01\0\0\0\0\0\0\x05_trik\x04_tcp\x05local\0\0\x0c\0\x01",
        b"\0\x07\0\0\0\x02\0\0\0\0\0\0\xc0\x0c\0\x0c\0\x01",
    ];
    run("strangers", trikd::fuzz::fuzz_strangers, strangers);
}

/// The module of the crate `config`, under a name that is not that of a folder of tests.
use ::config::fuzz as config_fuzz;
