//! Tests of the checks on a foreign library: every rule with what breaks it, and any bytes.

use super::*;

const C: Part = Part::Converter(0);

fn fields(name: &[u8]) -> ConverterFields<'_> {
    ConverterFields {
        name: Some(name),
        input_size: 4,
        output_size: 0,
        has_convert: true,
    }
}

#[test]
fn a_newer_minor_with_a_longer_struct_is_accepted_and_a_shorter_one_refused() {
    let header = |abi_version, size| Header { abi_version, size }.check(Part::Library, 24);
    assert_eq!(header(1, 24), Ok(()));
    assert_eq!(header(1, u32::MAX), Ok(()));
    assert_eq!(
        header(1, 23).unwrap_err().to_string(),
        "library says that its descriptor has 23 bytes, version 1 has 24"
    );
    assert_eq!(
        header(0, 24).unwrap_err().to_string(),
        "library has abi version 0, this trikfs reads version 1"
    );
    assert_eq!(
        header(2, 64).unwrap_err().to_string(),
        "library has abi version 2, this trikfs reads version 1"
    );
}

#[test]
fn the_number_of_converters_has_a_limit() {
    assert_eq!(check_count(1, true), Ok(()));
    assert_eq!(check_count(256, true), Ok(()));
    assert_eq!(
        check_count(0, true).unwrap_err().to_string(),
        "library has 0 converters, the limit is 1 to 256"
    );
    assert_eq!(
        check_count(257, true).unwrap_err().to_string(),
        "library has 257 converters, the limit is 1 to 256"
    );
    assert_eq!(
        check_count(1, false).unwrap_err().to_string(),
        "library has no array of converters"
    );
}

#[test]
fn names_are_short_and_plain() {
    assert_eq!(fields(b"low_pass_f32").check(C).unwrap(), "low_pass_f32");
    assert_eq!(fields(&[b'a'; 64]).check(C).unwrap().len(), 64);
    assert_eq!(
        fields(&[b'a'; 65]).check(C).unwrap_err().to_string(),
        "converter 0 of the library: its name must have 1 to 64 bytes"
    );
    assert_eq!(
        fields(b"").check(C).unwrap_err().to_string(),
        "converter 0 of the library: its name must have 1 to 64 bytes"
    );
    for bad in [
        &b"Median"[..],
        b"a b",
        b"a/b",
        b"\xff",
        b"a\n",
        "\u{44f}".as_bytes(),
    ] {
        assert!(
            fields(bad)
                .check(C)
                .unwrap_err()
                .to_string()
                .contains("is not one of a-z 0-9 _")
        );
    }
    let nameless = ConverterFields {
        name: None,
        ..fields(b"")
    };
    assert_eq!(
        nameless.check(C).unwrap_err().to_string(),
        "converter 0 of the library has no name"
    );
}

#[test]
fn sizes_have_a_limit_and_convert_must_exist() {
    let big = ConverterFields {
        input_size: 65_537,
        ..fields(b"a")
    };
    assert_eq!(
        big.check(C).unwrap_err().to_string(),
        "converter 'a' wants input tuples of 65537 bytes, the limit is 65536"
    );
    let big = ConverterFields {
        output_size: u32::MAX,
        ..fields(b"a")
    };
    assert!(
        big.check(C)
            .unwrap_err()
            .to_string()
            .contains("output tuples of 4294967295 bytes")
    );
    let most = ConverterFields {
        input_size: 65_536,
        output_size: 65_536,
        ..fields(b"a")
    };
    assert!(most.check(C).is_ok());
    let empty = ConverterFields {
        has_convert: false,
        ..fields(b"a")
    };
    assert_eq!(
        empty.check(C).unwrap_err().to_string(),
        "converter 'a' has no convert function"
    );
}

#[test]
fn two_converters_of_one_name_are_refused() {
    assert_eq!(check_unique(["a", "b"].into_iter()), Ok(()));
    assert_eq!(
        check_unique(["a", "b", "a"].into_iter())
            .unwrap_err()
            .to_string(),
        "library has two converters named 'a'"
    );
}

#[test]
fn no_bytes_pass_that_break_a_rule() {
    let seed = std::process::id();
    println!("seed {seed}");
    let mut numbers = needs::Random::new(seed);
    let mut random = || numbers.bits();
    for _ in 0..20_000 {
        let mut bytes = Vec::new();
        for plausible in [1, 4096, 1, 4096, 2, 8, 8] {
            let value = if random() % 8 == 0 {
                random()
            } else {
                plausible
            };
            bytes.extend(value.to_le_bytes());
        }
        for _ in 0..random() % 80 {
            bytes.push(b"ab_0\0\0Z\xff"[random() as usize % 8]);
        }
        bytes.truncate(random() as usize % 200);
        fuzz_library(&bytes);
    }
}
