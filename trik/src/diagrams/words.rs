//! What `trik lint` says itself, in English and Russian.

use super::report::Count;
use lang_text::problem::{Severity, Tongue};

/// How bad a problem is.
pub(super) fn severity(severity: Severity, tongue: Tongue) -> &'static str {
    let (english, russian) = match severity {
        Severity::Error => ("error", "ошибка"),
        Severity::Warning => ("warning", "предупреждение"),
        Severity::Note => ("note", "замечание"),
    };
    match tongue {
        Tongue::English => english,
        Tongue::Russian => russian,
    }
}

/// The last line: how many files, and what was found in them.
pub(super) fn summary(files: usize, unreadable: usize, count: Count, tongue: Tongue) -> String {
    let Count {
        errors,
        warnings,
        notes,
    } = count;
    match tongue {
        Tongue::English => {
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
        Tongue::Russian => {
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
pub(super) fn recovered(count: usize, tongue: Tongue) -> String {
    match tongue {
        Tongue::English => format!("written, with {count} lost blocks, links and ends put back"),
        Tongue::Russian => {
            format!("записан; возвращено потерянных блоков, связей и их концов: {count}")
        }
    }
}

/// Nothing was lost.
pub(super) fn nothing_to_recover(tongue: Tongue) -> &'static str {
    match tongue {
        Tongue::English => "nothing is lost in it, so nothing was written",
        Tongue::Russian => "в нём ничего не потеряно, поэтому ничего не записано",
    }
}
