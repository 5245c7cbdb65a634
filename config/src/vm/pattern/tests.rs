//! Tests of the matcher: the manual of Lua 5.1, and patterns that would take forever.

use super::*;
use proptest::prelude::*;

/// The match and its captures as Lua would give them to `string.match`.
fn matched(subject: &str, pattern: &str) -> Result<Option<Vec<String>>, &'static str> {
    let text = |from: usize, to: usize| subject[from..to].to_owned();
    Ok(
        find(subject.as_bytes(), pattern.as_bytes(), 0, true)?.map(|m| {
            if m.captures().is_empty() {
                return vec![text(m.start, m.end)];
            }
            let capture = |c: &Capture| match *c {
                Capture::Text(from, to) => text(from, to),
                Capture::Position(at) => (at + 1).to_string(),
                Capture::Open(_) => unreachable!(),
            };
            m.captures().iter().map(capture).collect()
        }),
    )
}

fn gives(subject: &str, pattern: &str, expected: &[&str]) {
    let expected = expected.iter().map(|s| (*s).to_owned()).collect();
    assert_eq!(
        matched(subject, pattern),
        Ok(Some(expected)),
        "{subject} against {pattern}"
    );
}

fn fails(subject: &str, pattern: &str) {
    assert_eq!(
        matched(subject, pattern),
        Ok(None),
        "{subject} against {pattern}"
    );
}

#[test]
fn classes_repetitions_and_anchors_work_as_in_the_manual() {
    gives("hello world", "o", &["o"]);
    gives("hello world", "^hello", &["hello"]);
    fails("hello world", "^world");
    gives("hello world", "world$", &["world"]);
    gives("a$b", "a$b", &["a$b"]);
    gives("  x = 12", "(%a+)%s*=%s*(%d+)", &["x", "12"]);
    gives("aaa", "a-", &[""]);
    gives("aaab", "a-b", &["aaab"]);
    gives("aab", "a?ab", &["aab"]);
    gives("ab", "a?ab", &["ab"]);
    gives("x]y", "[]]", &["]"]);
    gives("x^y", "[%^]", &["^"]);
    gives("b-", "[a-]+", &["-"]);
    gives("m", "[^a-l]", &["m"]);
    gives("0x1F", "^0x(%x+)$", &["1F"]);
    gives("a.b", "%.", &["."]);
    gives("\u{e9}", ".+", &["\u{e9}"]);
}

#[test]
fn captures_balances_frontiers_and_back_references_work() {
    gives("THE (quick) fox", "%((%a+)%)", &["quick"]);
    gives("THE (quick) fox", "%f[%a]%a+%f[%A]", &["THE"]);
    gives("f(a(b)c)d", "%b()", &["(a(b)c)"]);
    gives("hello", "()ll()", &["3", "5"]);
    gives("\"it's\"", "([\"'])(.-)%1", &["\"", "it's"]);
    gives("abc", "((a)(b))", &["ab", "a", "b"]);
    gives("a\0b", "%z", &["\0"]);
}

#[test]
fn a_malformed_pattern_is_named_as_in_lua() {
    let error = |pattern: &str| matched("aaa", pattern).unwrap_err();
    assert_eq!(error("%"), "malformed pattern (ends with '%')");
    assert_eq!(error("[a"), "malformed pattern (missing ']')");
    assert_eq!(error("[]"), "malformed pattern (missing ']')");
    assert_eq!(error("[%"), "malformed pattern (ends with '%')");
    assert_eq!(error("(a"), "unfinished capture");
    assert_eq!(error("a)"), "invalid pattern capture");
    assert_eq!(error("%1"), "invalid capture index");
    assert_eq!(error("(%1)"), "invalid capture index");
    assert_eq!(error("%ba"), "unbalanced pattern");
    assert_eq!(error("%fa"), "missing '[' after '%f' in pattern");
    assert_eq!(error(&"(".repeat(40)), "too many captures");
    assert_eq!(error(&"()".repeat(40)), "too many captures");
}

#[test]
fn a_match_that_takes_too_long_is_refused() {
    let subject = "a".repeat(100_000);
    assert_eq!(
        matched(&subject, &format!("{}b", ".-".repeat(10))),
        Err(TOO_LONG)
    );
    assert_eq!(matched(&subject, "%b()x"), Ok(None));
    assert_eq!(
        matched(&subject, &format!("[{}]*$", "b".repeat(100_000))),
        Err(TOO_LONG)
    );
    assert_eq!(
        matched(&subject, &"a?".repeat(300)),
        Err("pattern too complex")
    );
    assert_eq!(
        find_plain(
            subject.as_bytes(),
            format!("{}b", "a".repeat(50_000)).as_bytes(),
            0
        ),
        Err(TOO_LONG)
    );
}

#[test]
fn plain_text_is_found_from_a_position() {
    assert_eq!(find_plain(b"a.b.c", b".", 2), Ok(Some(3)));
    assert_eq!(find_plain(b"abc", b"", 3), Ok(Some(3)));
    assert_eq!(find_plain(b"abc", b"", 4), Ok(None));
    assert_eq!(find_plain(b"abc", b"abcd", 0), Ok(None));
    assert_eq!(find_plain(b"aab", b"ab", 0), Ok(Some(1)));
}

proptest! {
    #[test]
    fn any_bytes_match_or_fail_without_a_panic(
        subject in prop::collection::vec(prop::sample::select(b"ab()[]%-^$.*+?f1\0".to_vec()), 0..40),
        pattern in prop::collection::vec(prop::sample::select(b"ab()[]%-^$.*+?fb1\0".to_vec()), 0..20),
        from in 0usize..50,
    ) {
        if let Ok(Some(found)) = find(&subject, &pattern, from, true) {
            prop_assert!(from <= found.start && found.start <= found.end && found.end <= subject.len());
            for capture in found.captures() {
                let inside = match *capture {
                    Capture::Text(a, b) => a <= b && b <= subject.len(),
                    Capture::Position(at) => at <= subject.len(),
                    Capture::Open(_) => false,
                };
                prop_assert!(inside);
            }
        }
    }
}
