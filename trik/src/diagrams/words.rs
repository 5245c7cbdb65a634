//! What `trik lint` says itself, in English and Russian.

use super::report::Count;
use lang_text::problem::{Locale, Words};

/// The last line: how many files, and what was found in them.
pub(super) fn summary(files: usize, unreadable: usize, count: Count, locale: Locale) -> String {
    let Count {
        errors,
        warnings,
        notes,
    } = count;
    match locale {
        Locale::English => {
            let many = |count: usize, word: &str| {
                let s = if count == 1 { "" } else { "s" };
                format!("{count} {word}{s}")
            };
            let unread = match unreadable {
                0 => String::new(),
                count => format!(" ({count} unreadable)"),
            };
            format!(
                "{}{unread}: {}, {}, {}",
                many(files, "file"),
                many(errors, "error"),
                many(warnings, "warning"),
                many(notes, "note")
            )
        }
        Locale::Russian => {
            let unread = match unreadable {
                0 => String::new(),
                count => format!(" (не прочитано: {count})"),
            };
            format!(
                "файлов: {files}{unread}; ошибок: {errors}, предупреждений: {warnings}, замечаний: {notes}"
            )
        }
    }
}

/// Blocks and links were put back.
pub(super) fn recovered(count: usize, locale: Locale) -> String {
    match locale {
        Locale::English => format!("written, with {count} lost blocks, links and ends put back"),
        Locale::Russian => {
            format!("записан; возвращено потерянных блоков, связей и их концов: {count}")
        }
    }
}

/// Nothing was lost.
pub(super) fn nothing_to_recover(locale: Locale) -> &'static str {
    match locale {
        Locale::English => "nothing is lost in it, so nothing was written",
        Locale::Russian => "в нём ничего не потеряно, поэтому ничего не записано",
    }
}

/// A file in UTF-16.
pub(super) fn utf_16() -> Words {
    Words::new(
        "this is a text in UTF-16; save it again in UTF-8",
        "это текст в UTF-16; сохраните его снова в UTF-8",
    )
}

/// A program in its textual form that is no text.
pub(super) fn no_text(at: usize) -> Words {
    Words::new(
        format!("byte {at} is not UTF-8, so this is not a program as text"),
        format!("байт {at} не в UTF-8, так что это не программа в виде текста"),
    )
}

/// A byte of a world that is not UTF-8.
pub(super) fn no_utf_8(at: usize) -> Words {
    Words::new(
        format!("byte {at} is not UTF-8; save the world as XML in UTF-8"),
        format!("байт {at} не из UTF-8; сохраните мир как XML в UTF-8"),
    )
}

/// A program where a diagram or a world should be.
pub(super) fn is_program() -> Words {
    Words::new(
        "this is a program, and only diagrams (.qrs) and worlds (.xml) are looked at; 'trik check PROGRAM --field WORLD.xml' runs it",
        "это программа, а проверяются диаграммы (.qrs) и миры (.xml); её запускает 'trik check ПРОГРАММА --field МИР.xml'",
    )
}

/// Why a program as text is not taken where a world is changed.
pub(super) fn only_saves() -> Words {
    Words::new(
        "this is a data-flow program as text, which has no world: only a save (.qrs) can be changed",
        "это потоковая программа в виде текста, и мира у неё нет: изменить можно только файл .qrs",
    )
}
