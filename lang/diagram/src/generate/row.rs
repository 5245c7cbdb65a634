//! How a language says one thing: operators, calls, statements, texts and numbers.
//!
//! Owns the form of rows and their operands. Knows no language and no program: the words are those of a dialect, or of
//! another generator.

/// How one thing is said. `$1` and so on stand for operands.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The words with the places of operands.
    pub text: &'static str,
    /// How strongly the whole binds; [`ATOM`] for calls and names.
    pub binds: u8,
    /// How strongly the first and the second operand must bind.
    pub needs: [u8; 2],
}

/// Binds like a name.
pub const ATOM: u8 = u8::MAX;

/// What a sum asks of its operands, in all dialects: more needs brackets around a negative number.
pub(super) const SUM: u8 = 12;

/// A call, or anything else that keeps its operands apart.
pub const fn call(text: &'static str) -> Row {
    Row {
        text,
        binds: ATOM,
        needs: [0, 0],
    }
}

/// An operator between operands that associates to the left.
pub const fn infix(text: &'static str, binds: u8) -> Row {
    Row {
        text,
        binds,
        needs: [binds, binds + 1],
    }
}

/// An operator whose operands must both bind more strongly, as comparisons.
pub const fn apart(text: &'static str, binds: u8) -> Row {
    Row {
        text,
        binds,
        needs: [binds + 1, binds + 1],
    }
}

/// An operator before its operand.
pub const fn prefix(text: &'static str, binds: u8) -> Row {
    Row {
        text,
        binds,
        needs: [binds + 1, 0],
    }
}

/// An operand before brackets or a point.
pub const fn postfix(text: &'static str) -> Row {
    Row {
        text,
        binds: ATOM,
        needs: [ATOM, 0],
    }
}

/// Nothing: the language has no words for it.
pub const NONE: Row = call("");

/// How statements look.
#[derive(Clone, Copy, Debug)]
pub struct Syntax {
    /// One step to the right.
    pub indent: &'static str,
    /// A comment in a line of its own.
    pub comment: &'static str,
    /// An expression as a statement.
    pub statement: &'static str,
    /// An assignment.
    pub set: &'static str,
    /// The head of a condition.
    pub if_: &'static str,
    pub(super) else_if: &'static str,
    /// The other case.
    pub else_: &'static str,
    /// The end of a condition.
    pub end: &'static str,
    pub(super) forever: &'static str,
    /// The head of a loop with a condition.
    pub while_: &'static str,
    /// Head and foot; without them a loop that is left at its foot.
    pub(super) do_while: Option<(&'static str, &'static str)>,
    /// How often, the variable that counts, and a place for how often.
    pub(super) repeat: &'static str,
    /// The same if how often is a plain number.
    pub(super) repeat_plain: &'static str,
    /// The end of a loop.
    pub end_loop: &'static str,
    pub(super) break_: &'static str,
    pub(super) continue_: &'static str,
    pub(super) break_to: &'static str,
    pub(super) continue_to: &'static str,
    /// At the foot of a loop, for languages where going on is a jump there.
    pub(super) continue_label: &'static str,
    /// Before a loop that is named by a break.
    pub(super) name_loop: &'static str,
    pub(super) return_: &'static str,
    pub(super) goto: &'static str,
    pub(super) label: &'static str,
    /// A body without statements.
    pub(super) empty: &'static str,
    pub(super) call: &'static str,
}

/// Puts operands in their places.
pub fn fill(template: &str, operands: &[&str]) -> String {
    let mut out = String::with_capacity(template.len() + 16);
    let mut rest = template;
    while let Some(at) = rest.find('$') {
        out.push_str(&rest[..at]);
        let digit = rest[at + 1..]
            .chars()
            .next()
            .and_then(|digit| digit.to_digit(10));
        match digit.and_then(|digit| operands.get((digit as usize).wrapping_sub(1))) {
            Some(operand) => {
                out.push_str(operand);
                rest = &rest[at + 2..];
            }
            None => {
                out.push('$');
                rest = &rest[at + 1..];
            }
        }
    }
    out.push_str(rest);
    out
}

/// A text in double quotes with escapes that JavaScript, Python, C and Lua share; what is not plain ASCII stands as it
/// is, but for what ends lines.
pub fn quote(text: &str, unusual: fn(u32) -> String) -> String {
    let mut out = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            letter if is_hidden(letter) => out.push_str(&unusual(letter as u32)),
            letter => out.push(letter),
        }
    }
    out.push('"');
    out
}

/// Whether a letter shows nothing where it stands, or changes how others are shown.
pub(super) fn is_hidden(letter: char) -> bool {
    letter.is_control()
        || matches!(
            letter,
            '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
        )
}

/// A float that is surely one, with a point or an exponent.
pub fn float(number: f64) -> String {
    let text = if number.abs() >= 1e16 || (number != 0.0 && number.abs() < 1e-5) {
        format!("{number:e}")
    } else {
        number.to_string()
    };
    if text.contains(['.', 'e']) {
        text
    } else {
        format!("{text}.0")
    }
}
