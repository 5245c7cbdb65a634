//! Tests of formats: parsing, both directions, ranges, whatever is not finite.

use super::*;
use proptest::prelude::*;

fn rendered(format: &str, tuple: &[u8]) -> Result<String, String> {
    let mut out = String::new();
    Format::parse(format)
        .unwrap()
        .render(tuple, &mut out)
        .map(|()| out)
        .map_err(|error| error.to_string())
}

fn encoded(format: &str, text: &str) -> Result<Vec<u8>, EncodeError> {
    let format = Format::parse(format).unwrap();
    let mut out = vec![0; format.size()];
    format.encode(text, &mut out).map(|()| out)
}

fn syntax(text: &str) -> Result<Vec<u8>, EncodeError> {
    Err(EncodeError::Syntax(text.into()))
}

fn range(text: &str) -> Result<Vec<u8>, EncodeError> {
    Err(EncodeError::Range(text.into()))
}

#[test]
fn a_format_has_a_size_and_a_canonical_text() {
    let format = Format::parse(" i16 x,>i16\ty ,  > u8 flags").unwrap();
    assert_eq!(format.size(), 5);
    assert_eq!(format.len(), 3);
    assert_eq!(format.to_string(), "i16 x, >i16 y, >u8 flags");
    assert_eq!(Format::parse(&format.to_string()).unwrap(), format);
    assert_eq!(format.fields()[1].name, "y");
}

#[test]
fn every_mistake_in_a_format_is_named() {
    let error = |text: &str| Format::parse(text).unwrap_err().to_string();
    assert_eq!(
        error(""),
        "format has an empty field; write for example 'i16 x, i16 y'"
    );
    assert_eq!(
        error("i16 x,"),
        "format has an empty field; write for example 'i16 x, i16 y'"
    );
    assert_eq!(
        error("i17 x"),
        "format has an unknown type 'i17', did you mean 'i16'"
    );
    assert_eq!(error("float x"), "format has an unknown type 'float'");
    assert_eq!(error("i16"), "format has a field 'i16' without a name");
    assert_eq!(error("i16 x i16 y"), "format wants a comma before 'i16'");
    assert_eq!(error("i16 x, u8 x"), "format names the field 'x' twice");
    assert_eq!(error("i16 2x"), "format has a field with the bad name '2x'");
    assert_eq!(
        error("i16 a/b"),
        "format has a field with the bad name 'a/b'"
    );
    assert_eq!(
        error(&"u8 a,".repeat(2)),
        "format names the field 'a' twice"
    );
    let many: Vec<String> = (0..=FIELDS_MAX).map(|i| format!("u8 f{i}")).collect();
    assert_eq!(error(&many.join(",")), "format has more than 1024 fields");
}

#[test]
fn numbers_are_little_endian_unless_marked() {
    assert_eq!(
        rendered("i16 a, >i16 b, u8 c", &[1, 0, 0, 1, 255]),
        Ok("1 1 255".into())
    );
    assert_eq!(
        rendered("i8 a, >u32 b", &[0x80, 0, 0, 1, 2]),
        Ok("-128 258".into())
    );
    assert_eq!(
        encoded("i16 a, >i16 b, u8 c", "-2 -2 7\n"),
        Ok(vec![0xfe, 0xff, 0xff, 0xfe, 7])
    );
}

#[test]
fn sixty_four_bits_are_exact() {
    assert_eq!(
        rendered("u64 a", &[255; 8]),
        Ok("18446744073709551615".into())
    );
    assert_eq!(
        rendered("i64 a", &[0, 0, 0, 0, 0, 0, 0, 0x80]),
        Ok("-9223372036854775808".into())
    );
    assert_eq!(encoded("u64 a", "18446744073709551615"), Ok(vec![255; 8]));
    assert_eq!(
        encoded("i64 a", "-9223372036854775808"),
        Ok(vec![0, 0, 0, 0, 0, 0, 0, 0x80])
    );
    assert_eq!(
        encoded("u64 a", "18446744073709551616"),
        range("field 'a': 18446744073709551616 is outside 0..18446744073709551615")
    );
}

#[test]
fn floating_point_text_is_short_and_exact() {
    assert_eq!(rendered("f32 a", &0.1f32.to_le_bytes()), Ok("0.1".into()));
    assert_eq!(
        rendered("f64 a", &1e300f64.to_le_bytes()),
        Ok("1e300".into())
    );
    assert_eq!(rendered("f64 a", &(-0.0f64).to_le_bytes()), Ok("-0".into()));
    assert_eq!(
        rendered("f64 a", &5e-324f64.to_le_bytes()),
        Ok("5e-324".into())
    );
    assert_eq!(rendered(">f64 a", &2.5f64.to_be_bytes()), Ok("2.5".into()));
}

#[test]
fn a_number_that_is_none_is_an_error() {
    assert_eq!(
        rendered("f32 speed", &f32::NAN.to_le_bytes()),
        Err("field 'speed' is NaN".to_owned())
    );
    assert_eq!(
        rendered("f64 speed", &f64::INFINITY.to_le_bytes()),
        Err("field 'speed' is inf".to_owned())
    );
    assert_eq!(
        encoded("f32 a", "nan"),
        syntax("field 'a': 'nan' is not a number")
    );
    assert_eq!(
        encoded("f64 a", "inf"),
        syntax("field 'a': 'inf' is not a number")
    );
    assert_eq!(
        encoded("f64 a", "1e999"),
        range("field 'a': 1e999 is out of range")
    );
    assert_eq!(
        encoded("f32 a", "1e39"),
        range("field 'a': 1e39 is out of range")
    );
}

#[test]
fn text_that_does_not_fit_is_refused_with_its_reason() {
    assert_eq!(
        encoded("u8 a", "256"),
        range("field 'a': 256 is outside 0..255")
    );
    assert_eq!(
        encoded("u8 a", "-1"),
        range("field 'a': -1 is outside 0..255")
    );
    assert_eq!(
        encoded("i8 a", "-129"),
        range("field 'a': -129 is outside -128..127")
    );
    assert_eq!(
        encoded("u8 a", "1.5"),
        syntax("field 'a': '1.5' is not a whole number")
    );
    assert_eq!(
        encoded("u8 a", "x"),
        syntax("field 'a': 'x' is not a whole number")
    );
    assert_eq!(
        encoded("u8 a", "0x"),
        syntax("field 'a': '0x' is not a whole number")
    );
    assert_eq!(encoded("u8 a", ""), syntax("0 numbers where 1 belong"));
    assert_eq!(
        encoded("u8 a, u8 b", "1"),
        syntax("1 number where 2 belong")
    );
    assert_eq!(encoded("u8 a", "1 2 3"), syntax("3 numbers where 1 belong"));
    assert_eq!(encoded("u8 a", "+0x1F"), Ok(vec![31]));
    let digits = "9".repeat(100_000);
    assert!(matches!(encoded("u8 a", &digits), Err(EncodeError::Range(text)) if text.len() < 100));
}

#[test]
fn no_text_of_a_tuple_is_longer_than_its_bound() {
    let numbers = [
        ("u8", vec![255]),
        ("i8", vec![0x80]),
        ("i16", i16::MIN.to_le_bytes().to_vec()),
        ("u16", u16::MAX.to_le_bytes().to_vec()),
        ("i32", i32::MIN.to_le_bytes().to_vec()),
        ("u32", u32::MAX.to_le_bytes().to_vec()),
        ("i64", i64::MIN.to_le_bytes().to_vec()),
        ("u64", u64::MAX.to_le_bytes().to_vec()),
        ("f32", (-f32::MIN_POSITIVE).to_le_bytes().to_vec()),
        ("f32", (-0.000_012_345_678_f32).to_le_bytes().to_vec()),
        ("f64", (-f64::MIN_POSITIVE).to_le_bytes().to_vec()),
        (
            "f64",
            (-0.000_012_345_678_901_234_567_f64).to_le_bytes().to_vec(),
        ),
    ];
    for (word, bytes) in numbers {
        let format = Format::parse(&format!("{word} a, {word} b")).unwrap();
        let mut out = String::new();
        format.render(&bytes.repeat(2), &mut out).unwrap();
        let most = format.text_bytes_max();
        assert!(
            out.len() < most && most <= out.len() + 8,
            "{word}: {out} of {most}"
        );
    }
    assert_eq!(Format::bytes(3).text_bytes_max(), "255 255 255\n".len());
    assert_eq!(Format::parse("text 9").unwrap().text_bytes_max(), 10);
}

#[test]
fn plain_bytes_have_no_names() {
    let format = Format::bytes(3);
    let mut out = String::new();
    format.render(&[0, 7, 255], &mut out).unwrap();
    assert_eq!(out, "0 7 255");
    assert_eq!(format.to_string(), "u8 x 3");
    assert!(format.fields().is_empty());
    let mut tuple = [0; 3];
    format.encode("1 2 3", &mut tuple).unwrap();
    assert_eq!(tuple, [1, 2, 3]);
    assert_eq!(
        format.encode("1 2 300", &mut tuple),
        Err(EncodeError::Range("byte 2: 300 is outside 0..255".into()))
    );
    assert_eq!(
        format.render(&[1], &mut out),
        Err(RenderError::Size {
            tuple: 1,
            format: 3
        })
    );
}

#[test]
fn one_field_is_read_and_written_alone() {
    let format = Format::parse("u8 a, >u16 b").unwrap();
    let mut tuple = [9, 0, 0];
    format.encode_field(1, "258\n", &mut tuple).unwrap();
    assert_eq!(tuple, [9, 1, 2]);
    let mut out = String::new();
    format.render_field(1, &tuple, &mut out).unwrap();
    assert_eq!(out, "258");
    assert_eq!(
        format.render_field(2, &tuple, &mut out),
        Err(RenderError::NoField {
            index: 2,
            numbers: 2
        })
    );
}

#[test]
fn numbers_become_a_tuple_like_their_text() {
    let mut tuple = [0; 5];
    Format::parse("u8 a, f32 b")
        .unwrap()
        .encode_numbers(&[7.0, 0.5], &mut tuple)
        .unwrap();
    assert_eq!(tuple, [7, 0, 0, 0, 0x3f]);
    let error = Format::bytes(1)
        .encode_numbers(&[0.5], &mut [0])
        .unwrap_err();
    assert_eq!(
        error,
        EncodeError::Syntax("byte 0: '0.5' is not a whole number".into())
    );
}

proptest! {
    #[test]
    fn text_reads_back_as_the_same_bytes(tuple in prop::collection::vec(any::<u8>(), 42)) {
        let format = Format::parse("i8 a, u8 b, i16 c, >u16 d, i32 e, >u32 f, i64 g, >u64 h, f32 i, >f64 j").unwrap();
        let mut text = String::new();
        if format.render(&tuple, &mut text).is_ok() {
            let mut back = vec![0; 42];
            format.encode(&text, &mut back).unwrap();
            prop_assert_eq!(back, tuple);
        }
    }

    #[test]
    fn any_text_is_a_format_or_an_error(text in ".{0,80}") {
        if let Ok(format) = Format::parse(&text) {
            prop_assert_eq!(Format::parse(&format.to_string()).unwrap(), format);
        }
    }
}

#[test]
fn a_text_is_one_line_filled_up_with_zero_bytes() {
    let format = Format::parse("text 8").unwrap();
    assert_eq!(format.to_string(), "text 8");
    assert_eq!(
        (format.size(), format.len(), format.is_text()),
        (8, 0, true)
    );
    let mut tuple = [0xff; 8];
    format.encode("na ja", &mut tuple).unwrap();
    assert_eq!(&tuple, b"na ja\0\0\0");
    let mut text = String::new();
    format.render(&tuple, &mut text).unwrap();
    assert_eq!(text, "na ja");
    format.encode("\u{44d}\u{445}\u{43e}", &mut tuple).unwrap();
    text.clear();
    format.render(&tuple, &mut text).unwrap();
    assert_eq!(text, "\u{44d}\u{445}\u{43e}");
    let too_long = format.encode("123456789", &mut tuple);
    assert_eq!(
        too_long.unwrap_err().to_string(),
        "the text has 9 bytes, at most 8 fit"
    );
    assert!(format.encode("a\nb", &mut tuple).is_err());
    assert!(format.encode_numbers(&[1.0], &mut tuple).is_err());
    assert!(format.encode_field(0, "1", &mut tuple).is_err());
    assert!(format.render(b"a\x1b[2J\0\0\0", &mut text).is_err());
    assert!(format.render(b"\xff\0\0\0\0\0\0\0", &mut text).is_err());
    for wrong in [
        "text 0",
        "text 4194305",
        "text x",
        "text 8, u8 a",
        "text -1",
    ] {
        let reason = Format::parse(wrong).unwrap_err().to_string();
        assert!(
            reason.contains("a text has 1 to 4194304 bytes"),
            "{wrong}: {reason}"
        );
    }
}
