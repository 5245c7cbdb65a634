//! Texts of programs in JavaScript before they are evaluated: the rule about `main`.
//!
//! Pure. Knows as much of JavaScript as this rule needs, which is very little.

const CALL: &str = "main();";

/// Without comments and texts at the places where a name may stand: `main` in a comment is no function.
fn without_comments(text: &str) -> String {
    let mut rest = text;
    let mut kept = String::with_capacity(text.len());
    while let Some(at) = rest.find(['/', '"', '\'', '`']) {
        kept.push_str(&rest[..at]);
        rest = &rest[at..];
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with('/') {
            kept.push('/');
            1
        } else {
            text_length(rest)
        };
        kept.push(' ');
        rest = &rest[length..];
    }
    kept.push_str(rest);
    kept
}

/// Bytes of the text that stands in quotes at the beginning.
fn text_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut index = 1;
    while index < bytes.len() {
        match bytes[index] {
            b'\\' => index += 1,
            // A quote that is not closed ends with its line, as in a regular expression.
            b'\n' if bytes[0] != b'`' => return index,
            byte if byte == bytes[0] => return index + 1,
            _ => {}
        }
        index += 1;
    }
    text.len()
}

/// Whether the text makes a variable `main` of a function.
fn has_main(text: &str) -> bool {
    let text = without_comments(text);
    text.match_indices("main").any(|(at, name)| {
        let before = text[..at].trim_end();
        let declared = ["var", "let", "const"].iter().any(|word| {
            before.strip_suffix(word).is_some_and(|rest| {
                rest.len() + word.len() < at
                    && !rest.ends_with(|character: char| {
                        character.is_alphanumeric() || "_$.".contains(character)
                    })
            })
        });
        let value = text[at + name.len()..]
            .trim_start()
            .strip_prefix('=')
            .map(str::trim_start);
        declared && value.is_some_and(is_function)
    })
}

fn is_function(value: &str) -> bool {
    let value = value.strip_prefix("async").map_or(value, str::trim_start);
    let Some(rest) = value.strip_prefix("function") else {
        // () => ...
        return value.starts_with("()") && value[2..].trim_start().starts_with("=>");
    };
    rest.trim_start_matches('*')
        .trim_start()
        .starts_with(|character: char| {
            character == '(' || character.is_alphanumeric() || "_$".contains(character)
        })
}

/// The text as it is run: what makes `var main = function()` and does not end in `main();` gets that call. A plain
/// `function main()` does not, as on the original robots.
pub fn with_call_of_main(text: String) -> String {
    if has_main(&text) && !text.trim_end().ends_with(CALL) {
        text + "\n" + CALL
    } else {
        text
    }
}

/// The text as a new thread evaluates it: without the call of `main` at its end.
pub fn without_call_of_main(text: &str) -> &str {
    let trimmed = text.trim_end();
    match trimmed.strip_suffix(CALL) {
        Some(rest)
            if !rest.ends_with(|character: char| {
                character.is_alphanumeric() || "_$.".contains(character)
            }) =>
        {
            rest
        }
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn main_is_called_when_it_is_a_variable_and_nobody_calls_it() {
        let called = [
            "var main = function() {}",
            "var x;\nvar  main=function ()\n{\n\treturn;\n}\n",
            "var main = function start() {}",
            "const main = () => { print(1) }",
            "let main = async function() {}",
            "var s = 'it''s'; var main = function() {}",
            "var r = /\"/; \n var main = function() {}",
        ];
        for text in called {
            let run = with_call_of_main(text.to_owned());
            assert_eq!(run, format!("{text}\nmain();"), "{text}");
            assert_eq!(without_call_of_main(&run), format!("{text}\n"));
        }
        let left = [
            "function main() {}",
            "var main = function() {}; main();  \n",
            "// var main = function() {}",
            "/* var main = function() {} */",
            "print('var main = function() {}')",
            "var domain = function() {}",
            "main = function() {}",
            "x.var main = 1",
            "var main = 5",
            "var mainly = function() {}",
            "",
            "\u{e9}'\u{e9}",
        ];
        for text in left {
            assert_eq!(with_call_of_main(text.to_owned()), text);
        }
        assert_eq!(without_call_of_main("domain();"), "domain();");
    }
}
