//! Transcripts of docs/protocol.md, byte for byte.
//!
//! A block `wire PORT` is one fresh robot. `> ` sends bytes as they stand, `< ` expects exactly these bytes next; both
//! know `\n`, `\0` and `\xNN`. `...` at the end of an expected frame stands for any rest of it.

use crate::rig::{Client, robot};
use harness::documents::examples;

fn bytes(text: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'\\' {
            out.push(byte);
            continue;
        }
        match rest.next() {
            Some(b'n') => out.push(b'\n'),
            Some(b'0') => out.push(0),
            Some(b'x') => {
                let digits = [rest.next().expect("a digit"), rest.next().expect("a digit")];
                let digits = std::str::from_utf8(&digits).expect("digits");
                out.push(u8::from_str_radix(digits, 16).expect("a number"));
            }
            other => panic!("unknown escape {other:?} in {text}"),
        }
    }
    out
}

/// Comes whenever nothing else did for a while, which no transcript waits for.
const KEEPALIVE: &[u8] = b"9:keepalive";

/// The next bytes, without what keeps the connection alive unless that is wanted.
fn exactly(client: &mut Client, wanted: &[u8]) -> Vec<u8> {
    let mut got = client.exactly(wanted.len());
    while got.starts_with(KEEPALIVE) && !wanted.starts_with(KEEPALIVE) {
        got.drain(..KEEPALIVE.len());
        got.extend(client.exactly(KEEPALIVE.len()));
    }
    got
}

fn expect(client: &mut Client, text: &str, place: &str) {
    if text == "(end)" {
        assert_eq!(client.exactly(1), b"", "{place}");
        return;
    }
    if let Some(start) = text.strip_suffix("...") {
        let mut told = client.next().unwrap_or_default();
        while told == "keepalive" {
            told = client.next().unwrap_or_default();
        }
        assert!(
            told.as_bytes().starts_with(&bytes(start)),
            "{place}: {told}"
        );
        return;
    }
    let wanted = bytes(text);
    let got = exactly(client, &wanted);
    assert_eq!(
        got.escape_ascii().to_string(),
        wanted.escape_ascii().to_string(),
        "{place}"
    );
}

#[test]
fn every_transcript_happens_as_it_is_written() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/protocol.md");
    let text = std::fs::read_to_string(path).expect("docs/protocol.md");
    let mut count = 0;
    for example in examples(&text) {
        let Some(port) = example.info.strip_prefix("wire ") else {
            continue;
        };
        count += 1;
        let robot = robot(&[]);
        let mut client = robot.client(port);
        for (index, line) in example.text.lines().enumerate() {
            let place = format!("docs/protocol.md:{}", example.line + 1 + index);
            match line.split_at_checked(2) {
                Some(("> ", sent)) => client.raw(bytes(sent)),
                Some(("< ", wanted)) => expect(&mut client, wanted, &place),
                _ => panic!("{place}: neither '> ' nor '< '"),
            }
        }
    }
    assert!(count >= 8, "only {count} transcripts");
}

#[test]
fn every_order_to_a_debugger_has_its_row() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/protocol.md");
    let text = std::fs::read_to_string(path).expect("docs/protocol.md");
    let section = text.split("## Debugging").nth(1).expect("a section");
    let rows = section.lines().filter_map(|line| line.strip_prefix("| "));
    let heads: Vec<&str> = rows.filter_map(|row| row.split(" | ").next()).collect();
    for word in lang_diagram::debug::order::WORDS.split(", ") {
        let is_there = heads.iter().any(|head| {
            let orders = head.split(['`', ',']).map(str::trim);
            orders
                .into_iter()
                .any(|order| order.split(' ').next() == Some(word))
        });
        assert!(is_there, "docs/protocol.md has no row of '{word}'");
    }
}
