//! What a judged program in a language with text is told of, in English and Russian.

use lang_text::problem::Locale;

/// A line of the program, or of another file of it.
pub(super) fn line(file: &str, line: u32, locale: Locale) -> String {
    let line = match locale {
        Locale::English => format!("line {line}"),
        Locale::Russian => format!("строка {line}"),
    };
    match file {
        "" => line,
        file => format!("{file}: {line}"),
    }
}
