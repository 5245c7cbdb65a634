//! Texts as cells of CSV, as RFC 4180 has them.
//!
//! Owns the quotes. A text that a spreadsheet program would take for a formula begins with an apostrophe.

/// What formulas begin with, in narrow and in wide letters.
const FORMULA: [char; 10] = [
    '=', '+', '-', '@', '\t', '\r', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}',
];

/// A text, in quotes if it needs them.
pub(crate) fn text(text: &str) -> String {
    let is_formula = text.trim_start_matches(' ').starts_with(FORMULA);
    let mark = if is_formula { "'" } else { "" };
    let needs_quotes = |c: char| matches!(c, ',' | ';' | '"' | '\t' | '\r' | '\n');
    match is_formula || text.contains(needs_quotes) {
        true => format!("\"{mark}{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn no_text_is_a_formula() {
        for (name, written) in [
            ("anna", "anna"),
            (
                "=HYPERLINK(\"http://x\")",
                "\"'=HYPERLINK(\"\"http://x\"\")\"",
            ),
            (" =1", "\"' =1\""),
            ("-5", "\"'-5\""),
            ("@a", "\"'@a\""),
            ("a,b;c", "\"a,b;c\""),
            ("\u{ff1d}1", "\"'\u{ff1d}1\""),
        ] {
            assert_eq!(super::text(name), written);
        }
    }
}
