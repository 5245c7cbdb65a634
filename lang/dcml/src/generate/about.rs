//! What a generated text says of its model, in words: the same in all languages.
//!
//! Owns those words and how an author's text is kept from ending the comment that it stands in. What a comment looks like
//! is known to the printer.

use super::plan::Planner;
use crate::model::Symbol;
use crate::syntax::{Doc, Domain};

/// How many letters of a name are told where it is only told.
const NAME_SHOWN: usize = 80;

/// How the element of an array is written: the array's name and the place, which counts from 0.
pub(super) type Element = fn(&str, usize) -> String;

/// A text of the author as lines that end no comment of any language and change no line's direction.
pub(super) fn lines_of(text: &str) -> Vec<String> {
    text.lines().map(|line| harmless(line.trim_end())).collect()
}

/// One line of it.
pub(super) fn harmless(line: &str) -> String {
    let is_bad = |letter: char| {
        letter.is_control()
            || matches!(letter, '\u{2028}' | '\u{2029}' | '\u{feff}')
            || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{061c}')
            || ('\u{202a}'..='\u{202e}').contains(&letter)
            || ('\u{2066}'..='\u{2069}').contains(&letter)
    };
    let mut out = String::with_capacity(line.len());
    for letter in line.chars().map(|one| if is_bad(one) { ' ' } else { one }) {
        // Ends and beginnings of comments, trigraphs of C, escapes of Java, long brackets of Lua.
        let splits = matches!(
            (out.chars().next_back(), letter),
            (Some('*'), '/')
                | (Some('/'), '*')
                | (Some('?'), '?')
                | (Some('\\'), 'u')
                | (Some('['), '[' | '=')
        );
        if splits {
            out.push(' ');
        }
        out.push(letter);
    }
    // A line that ends so goes on in the next one, in C.
    if out.ends_with('\\') {
        out.push('.');
    }
    out
}

/// A name of the model for a reader, of any length and any letters.
pub(super) fn shown(name: &str) -> String {
    let mut cut: String = name.chars().take(NAME_SHOWN).collect();
    if cut.len() < name.len() {
        cut.push_str("...");
    }
    harmless(&cut)
}

fn joined(doc: Option<&Doc>) -> String {
    let lines = doc.map_or_else(Vec::new, |doc| lines_of(&doc.text));
    let words: Vec<&str> = lines.iter().map(|line| line.trim()).collect();
    words.join(" ").trim().to_owned()
}

/// Unit, domain and documentation of a symbol, in one line; nothing if nothing is known.
pub(super) fn symbol(symbol: &Symbol) -> String {
    let mut parts = Vec::new();
    if let Some(unit) = &symbol.unit {
        parts.push(format!("[{}]", harmless(unit)));
    }
    match symbol.domain {
        Some(Domain::Circle) => parts.push("(an angle that wraps)".to_owned()),
        Some(Domain::Range(from, to)) => parts.push(format!("({from:?} to {to:?})")),
        None => {}
    }
    let doc = joined(symbol.doc.as_ref());
    if !doc.is_empty() {
        parts.push(doc);
    }
    parts.join(" ")
}

/// What the model is, where everything stands, and what has another name here. `param` gives the place of a parameter.
pub(super) fn header(
    planner: &Planner<'_, '_>,
    element: Element,
    param: &dyn Fn(usize, &str) -> String,
) -> Vec<String> {
    let scene = planner.scene;
    let model = scene.model;
    let package = model.package.as_ref();
    let of = package.map_or_else(String::new, |name| format!(" of package {}", shown(name)));
    let mut lines = vec![
        format!(
            "The model {}{of}: how its state changes under an action.",
            shown(&model.name)
        ),
        "Written by trik dcml gen; change the model, not this text.".to_owned(),
    ];
    if let Some(doc) = &model.doc {
        lines.push(String::new());
        lines.extend(lines_of(doc.text.trim()));
    }
    let numbered = |array: &'static str| move |at: usize, _: &str| element(array, at);
    group(
        &mut lines,
        planner,
        "State",
        &scene.states,
        &numbered("state"),
    );
    group(
        &mut lines,
        planner,
        "Action",
        &scene.actions,
        &numbered("action"),
    );
    group(&mut lines, planner, "Parameters", &scene.params, param);
    group(
        &mut lines,
        planner,
        "Outputs",
        &scene.outputs,
        &numbered("outputs"),
    );
    let other = |one: &&Symbol| planner.symbol(one) != one.name;
    let renamed: Vec<&Symbol> = model.symbols.iter().filter(other).collect();
    if !renamed.is_empty() {
        lines.push(String::new());
        lines.push("Names that are others in this language:".to_owned());
        let line =
            |one: &&Symbol| format!("  {} is {} here", shown(&one.name), planner.symbol(one));
        lines.extend(renamed.iter().map(line));
    }
    lines
}

fn group(
    lines: &mut Vec<String>,
    planner: &Planner<'_, '_>,
    title: &str,
    symbols: &[&Symbol],
    place: &dyn Fn(usize, &str) -> String,
) {
    if symbols.is_empty() {
        return;
    }
    lines.push(String::new());
    lines.push(format!("{title}:"));
    for (at, one) in symbols.iter().enumerate() {
        let place = place(at, planner.symbol(one));
        let line = format!("  {place}  {} {}", shown(&one.name), symbol(one));
        lines.push(line.trim_end().to_owned());
    }
}

/// Lines of a comment between `/*` and `*/`, or with another first line.
pub(super) fn block(first: &str, lines: &[String], indent: &str) -> String {
    let mut out = format!("{indent}{first}\n");
    for line in lines {
        let line = format!("{indent} * {line}");
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out.push_str(&format!("{indent} */\n"));
    out
}

/// Lines of a comment that begin with a sign each.
pub(super) fn each(sign: &str, lines: &[String]) -> String {
    let mut out = String::new();
    for line in lines {
        out.push_str(format!("{sign} {line}").trim_end());
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_ends_its_comment() {
        for text in [
            "*/ evil();",
            "/* deeper",
            "**/*/",
            "a\r*\r/",
            "*\u{0}/",
            "*\u{202e}/",
            "??/",
            "\\u002a\\u002f",
            "]] --[[ x ]==]",
            "ends \\",
            "*\u{feff}/",
        ] {
            for line in lines_of(text) {
                for bad in ["*/", "/*", "??", "\\u", "[[", "[=", "\n", "\r", "\u{202e}"] {
                    assert!(!line.contains(bad), "{text:?}: {line:?}");
                }
                assert!(!line.ends_with('\\'), "{line:?}");
            }
        }
    }
}
