//! Escapes in quoted texts.

/// A text as it stands between quotes.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        let letter = match c {
            '\\' | '\'' | '"' => c,
            '\u{7}' => 'a',
            '\u{8}' => 'b',
            '\u{c}' => 'f',
            '\n' => 'n',
            '\r' => 'r',
            '\t' => 't',
            '\u{b}' => 'v',
            _ => {
                out.push(c);
                continue;
            }
        };
        out.push('\\');
        out.push(letter);
    }
    out
}

/// What stands between quotes, as text; an escape that nobody knows stays as it is written.
pub fn unescape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        if c != '\\' {
            out.push(c);
            continue;
        }
        let mut ahead = rest.clone();
        let meant = match ahead.next() {
            Some(c @ ('\\' | '\'' | '"' | '?')) => c,
            Some('a') => '\u{7}',
            Some('b') => '\u{8}',
            Some('f') => '\u{c}',
            Some('n') => '\n',
            Some('r') => '\r',
            Some('t') => '\t',
            Some('v') => '\u{b}',
            _ => {
                out.push('\\');
                continue;
            }
        };
        rest = ahead;
        out.push(meant);
    }
    out
}

/// A quoted text without its quotes and escapes.
pub fn unquote(text: &str) -> String {
    let mut inner = text.chars();
    inner.next();
    inner.next_back();
    unescape(inner.as_str())
}
