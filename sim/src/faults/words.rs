//! Why a device is not broken as somebody wants it, in Russian.
//!
//! Owns the texts. The English ones stand with the errors.

use super::{NAMES, Refusal};

/// The sentence.
pub(super) fn russian(why: &Refusal) -> String {
    match why {
        Refusal::NoText => "это не короткий текст".to_owned(),
        Refusal::NoDevice(name) => format!(
            "устройства '{name}' на этой плате нет; есть {}",
            NAMES.join(" ")
        ),
        Refusal::TooManyWords(line) => {
            format!("в '{line}' слишком много слов; напишите вид поломки и не больше одного числа")
        }
        Refusal::NoKind(kind, kinds) => {
            format!("поломки '{kind}' здесь нет; возможны {}", kinds.join(", "))
        }
        Refusal::NeedsNumber(kind, most) => format!("для '{kind}' нужно число от 0 до {most}"),
        Refusal::HasNoNumber(kind) => format!("для '{kind}' число не нужно"),
        Refusal::NotNumber(word) => format!("'{word}' - не число"),
        Refusal::OutOfRange(kind, word, most) => {
            format!("{kind} {word} - не между 0 и {most}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn why_a_device_is_not_broken_is_said_in_russian() {
        let text = || "x".to_owned();
        for why in [
            Refusal::NoText,
            Refusal::NoDevice(text()),
            Refusal::TooManyWords(text()),
            Refusal::NoKind(text(), &["unplug"]),
            Refusal::NeedsNumber(text(), 1.0),
            Refusal::HasNoNumber(text()),
            Refusal::NotNumber(text()),
            Refusal::OutOfRange(text(), text(), 1.0),
        ] {
            let words = why.words();
            assert!(words.english.is_ascii(), "{}", words.english);
            let is_russian = |c: char| ('а'..='я').contains(&c);
            assert!(words.russian.chars().any(is_russian), "{}", words.russian);
        }
    }
}
