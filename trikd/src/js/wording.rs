//! Messages of errors in the words that TRIK programs have always got, those of the old JavaScriptCore.
//!
//! Pure: from the words of the engine and the line of the program to the old words. What is not known here stays as the
//! engine says it.

use crate::limits;

/// A line of the program and the place in it that the engine names, in characters from 0.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Without its end.
    pub line: &'a str,
    /// Where the last call or operator before the failure begins.
    pub column: usize,
}

fn is_name(character: char) -> bool {
    character.is_alphanumeric() || character == '_' || character == '$'
}

/// Where the expression begins that ends before `end`: names, dots, and whatever stands in brackets.
fn begin_of_expression(line: &[char], end: usize) -> usize {
    let mut at = end;
    // A name or brackets may stand here, not only a dot.
    let mut wants = true;
    while at > 0 {
        let character = line[at - 1];
        if is_name(character) && wants {
            while at > 0 && is_name(line[at - 1]) {
                at -= 1;
            }
            wants = false;
        } else if [')', ']'].contains(&character) && wants {
            let Some(open) = opening(line, at - 1) else {
                break;
            };
            at = open;
            // f(x)[1]: what is called or indexed stands before.
            wants = at > 0 && (is_name(line[at - 1]) || [')', ']'].contains(&line[at - 1]));
        } else if character == '.' && !wants {
            at -= 1;
            wants = true;
        } else {
            break;
        }
    }
    // `return (x).y` is no call of return.
    let text: String = line[at..end].iter().collect();
    let keywords = ["return ", "return", "typeof", "if", "while", "in", "of"];
    match keywords
        .into_iter()
        .find(|word| text.starts_with(&format!("{word}(")))
    {
        Some(word) => at + word.len(),
        None => at,
    }
}

/// The bracket that is closed at `close`; quotes inside are skipped.
fn opening(line: &[char], close: usize) -> Option<usize> {
    let mut depth = 0_usize;
    let mut quote = None;
    for at in (0..=close).rev() {
        let character = line[at];
        match quote {
            Some(open) if character == open => quote = None,
            Some(_) => {}
            None => match character {
                '"' | '\'' | '`' => quote = Some(character),
                ')' | ']' | '}' => depth += 1,
                '(' | '[' | '{' => {
                    depth = depth.checked_sub(1)?;
                    if depth == 0 {
                        return Some(at);
                    }
                }
                _ => {}
            },
        }
    }
    None
}

/// What stands before `.NAME` or `[NAME]`.
fn owner(place: Place<'_>, name: &str) -> Option<String> {
    let line: Vec<char> = place.line.chars().collect();
    let name: Vec<char> = name.chars().collect();
    let is_here = |at: usize| {
        let after = at + 1 + name.len();
        match line[at] {
            '.' => {
                line[at + 1..].starts_with(&name)
                    && line.get(after).is_none_or(|next| !is_name(*next))
            }
            '[' => {
                let quoted = line
                    .get(at + 1)
                    .is_some_and(|next| ['"', '\''].contains(next));
                line[at + 1 + usize::from(quoted)..].starts_with(&name)
            }
            _ => false,
        }
    };
    let found = (place.column.min(line.len())..line.len())
        .chain(0..line.len())
        .find(|at| is_here(*at))?;
    let begin = begin_of_expression(&line, found);
    (begin < found).then(|| line[begin..found].iter().collect())
}

/// What was called: the name at the place, with what stands before it. The other is whether it follows `new`.
fn callee(place: Place<'_>) -> Option<(String, bool)> {
    let line: Vec<char> = place.line.chars().collect();
    // In its first line the engine counts from 0.
    let starts = |at: &usize| line.get(*at).is_some_and(|character| is_name(*character));
    let column = [place.column, place.column + 1].into_iter().find(starts)?;
    let length = |also_dots: bool| {
        let part = |character: &&char| is_name(**character) || also_dots && **character == '.';
        line[column..].iter().take_while(part).count()
    };
    let begin = begin_of_expression(&line, column + length(false));
    let before: String = line[..begin].iter().collect();
    let is_new = before
        .trim_end()
        .strip_suffix("new")
        .is_some_and(|rest| !rest.ends_with(is_name));
    let end = column + length(is_new);
    let after = line[end..]
        .iter()
        .find(|character| !character.is_whitespace());
    (is_new || after.is_some_and(|character| ['(', '?'].contains(character))).then_some(())?;
    Some((line[begin..end].iter().collect(), is_new))
}

/// The message in old words. `value` gives the present value of a global expression such as `a.b`, if it has one that
/// is no function.
pub fn message(
    name: &str,
    message: &str,
    place: Option<Place<'_>>,
    value: impl FnOnce(&str) -> Option<String>,
) -> String {
    let old = match name {
        "ReferenceError" => message
            .strip_suffix(" is not defined")
            .map(|variable| format!("Can't find variable: {variable}")),
        // What our own scripts say of a call is no matter of its text.
        "SyntaxError" if message.starts_with("too few arguments") => None,
        "SyntaxError" if !message.contains("JSON") => Some(format!("Parse error: {message}")),
        "TypeError" => not_an_object(message, place).or_else(|| {
            let place = place.filter(|_| message == "not a function")?;
            let (callee, is_new) = callee(place)?;
            let value = value(&callee).map_or_else(String::new, |value| format!(" [{value}]"));
            let kind = if is_new { "constructor" } else { "function" };
            Some(format!(
                "Result of expression '{callee}'{value} is not a {kind}."
            ))
        }),
        "RangeError" if message.starts_with("Maximum call stack size") => {
            Some("Maximum call stack size exceeded.".to_owned())
        }
        "InternalError" if message == "out of memory" => Some(format!(
            "out of memory: a thread of a program has {} MiB",
            limits::JS_MEMORY_BYTES >> 20
        )),
        _ => None,
    };
    old.unwrap_or_else(|| message.to_owned())
}

/// `cannot read property 'x' of null`.
fn not_an_object(message: &str, place: Option<Place<'_>>) -> Option<String> {
    let rest = ["cannot read property '", "cannot set property '"]
        .into_iter()
        .find_map(|begin| message.strip_prefix(begin))?;
    let (name, value) = rest.rsplit_once("' of ")?;
    let owner = owner(place?, name)?;
    Some(format!(
        "Result of expression '{owner}' [{value}] is not an object."
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn old(message: &str, line: &str, column: usize) -> String {
        super::message("TypeError", message, Some(Place { line, column }), |path| {
            (path == "x").then(|| "5".to_owned())
        })
    }

    #[test]
    fn expressions_are_found_in_the_line() {
        let cases = [
            (
                "setPower",
                "  brick.motor(\"Z9\").setPower(1)",
                8,
                "brick.motor(\"Z9\")",
            ),
            ("y", "x.y", 0, "x"),
            ("b", "o.a.b.c()", 0, "o.a"),
            ("b", "o[\"a\"][\"b\"];", 0, "o[\"a\"]"),
            ("0", "return l[0]", 7, "l"),
            ("y", "print(a.y2, x.y)", 6, "x"),
            (
                "read",
                "if (brick.sensor(\"Q (\").read() > 3)",
                10,
                "brick.sensor(\"Q (\")",
            ),
            ("z", "return(x).z", 0, "(x)"),
            // The place is after the expression when the engine counts otherwise.
            ("y", "\"\u{44f}\u{44f}\" + x.y", 30, "x"),
        ];
        for (name, line, column, owner) in cases {
            assert_eq!(
                old(
                    &format!("cannot read property '{name}' of null"),
                    line,
                    column
                ),
                format!("Result of expression '{owner}' [null] is not an object."),
                "{line}"
            );
        }
    }

    #[test]
    fn what_is_called_is_named_with_its_value_if_that_is_known() {
        let cases = [
            ("brick.foo(1)", 6, "'brick.foo' is not a function."),
            ("  x()", 2, "'x' [5] is not a function."),
            ("x()", 0, "'x' [5] is not a function."),
            ("try { brick.foo(1)", 11, "'brick.foo' is not a function."),
            ("1 + l(2)", 4, "'l' is not a function."),
            ("new o.K()", 4, "'o.K' is not a constructor."),
            ("a(b.c)[1].d(3)", 10, "'a(b.c)[1].d' is not a function."),
        ];
        for (line, column, said) in cases {
            assert_eq!(
                old("not a function", line, column),
                format!("Result of expression {said}"),
                "{line}"
            );
        }
    }

    #[test]
    fn what_cannot_be_found_stays_as_it_is() {
        for (message, line, column) in [
            ("not a function", "", 0),
            ("not a function", "(1, x)(3)", 0),
            ("not a function", "x", 99),
            ("cannot read property 'y' of null", "something else", 0),
            ("cannot read property 'y' of null", ".y", 0),
            ("cannot read property '' of null", "[", 0),
            ("cannot read property 'y' of null", ")].y", 0),
        ] {
            assert_eq!(old(message, line, column), message, "{line}");
        }
        let plain = |name, text| message(name, text, None, |_| None);
        assert_eq!(
            plain("ReferenceError", "foo is not defined"),
            "Can't find variable: foo"
        );
        assert_eq!(
            plain("SyntaxError", "unexpected end of string"),
            "Parse error: unexpected end of string"
        );
    }
}
