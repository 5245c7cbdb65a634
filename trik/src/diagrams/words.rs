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

/// Why a program as text is not taken where a world is changed.
pub(super) fn only_saves() -> Words {
    Words::new(
        "this is a data-flow program as text, which has no world: only a save (.qrs) can be changed",
        "это потоковая программа в виде текста, и мира у неё нет: изменить можно только файл .qrs",
    )
}
