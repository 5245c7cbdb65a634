//! Texts in markup: the signs of XML, SVG and HTML written so that they stand for themselves.
//!
//! Owns which signs these are. Knows no document; [`crate::xml`] writes whole ones.

/// What a sign is written as between tags and in quotes; None: as itself.
pub fn entity(sign: char) -> Option<&'static str> {
    match sign {
        '<' => Some("&lt;"),
        '>' => Some("&gt;"),
        '&' => Some("&amp;"),
        '"' => Some("&quot;"),
        _ => None,
    }
}

/// A text that is shown: for between tags and for values in double quotes. What XML cannot hold becomes a space.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    push(&mut out, text);
    out
}

/// Adds a text as [`escaped`] gives it.
pub fn push(out: &mut String, text: &str) {
    for sign in text.chars() {
        match entity(sign) {
            Some(entity) => out.push_str(entity),
            None if sign.is_control() || matches!(sign, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            None => out.push(sign),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_can_leave_its_place() {
        let text = "\"/><script>a && b\n\u{7}\u{ffff}\u{44f}";
        assert_eq!(
            escaped(text),
            "&quot;/&gt;&lt;script&gt;a &amp;&amp; b   \u{44f}"
        );
    }
}
