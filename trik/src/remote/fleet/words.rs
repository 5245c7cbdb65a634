//! What is said of several robots at once, in English and Russian.
//!
//! Owns the Russian of a robot's status: its lines have a form, which programs of other people read in English.

use crate::debug::target::words::told;
use lang_text::problem::{Locale, Words};
use trikd::protocol::news;

/// A line of a status.
pub(super) fn status(line: &str, locale: Locale) -> String {
    let russian = match locale {
        Locale::English => None,
        Locale::Russian => russian(line),
    };
    russian.unwrap_or_else(|| line.to_owned())
}

/// A line that is not known stays as it is: a newer robot says more.
fn russian(line: &str) -> Option<String> {
    let (word, rest) = line.split_once(' ')?;
    match word {
        "program" if rest == news::NONE => Some("программа не выполняется".to_owned()),
        "program" => {
            let (program, seconds) = rest.strip_suffix(" s")?.rsplit_once(" for ")?;
            let (name, inside) = program.strip_suffix(')')?.rsplit_once(" (")?;
            let (language, process) = inside.split_once(", process ")?;
            Some(format!(
                "выполняется {name} ({language}, процесс {process}) уже {seconds} с"
            ))
        }
        "programs" => {
            let (started, failed) = rest.strip_suffix(" failed")?.split_once(" started, ")?;
            Some(format!("запущено программ: {started}, с ошибкой: {failed}"))
        }
        "last" => Some(format!("до этого: {}", told(rest, Locale::Russian))),
        "rest" => {
            let (count, times) = rest.strip_prefix("of the last ")?.split_once(" ends: ")?;
            let times = times
                .replace("median", "медиана")
                .replace("most", "наибольшее");
            Some(format!(
                "от остановки до покоя (остановок: {count}): {}",
                times.replace(" us", " мкс")
            ))
        }
        "battery" => {
            let (value, ago) = rest.rsplit_once(", ").unwrap_or((rest, ""));
            let ago = match ago.strip_suffix(" s ago") {
                Some(seconds) => format!(", {seconds} с назад"),
                None => String::new(),
            };
            let value = value.replace(" V", " В");
            Some(format!("батарея {value}{ago}"))
        }
        "control" => Some(format!("управляет {rest}")),
        "debugger" => {
            let who = rest.strip_suffix(" is in control")?;
            Some(format!("отладчиком управляет {who}"))
        }
        _ => None,
    }
}

/// The client that controls a debugger, as a line of a status.
pub(super) fn debugger(who: &str, locale: Locale) -> String {
    let words = Words::new(
        format!("debugger {}", news::in_control(who)),
        format!("отладчиком управляет {who}"),
    );
    words.in_locale(locale).to_owned()
}

/// So many of all robots.
pub(super) fn not_all(failed: usize, all: usize) -> Words {
    Words::new(
        format!("{failed} of {all} robots have not got everything"),
        format!("роботов, получивших не всё: {failed} из {all}"),
    )
}

pub(super) fn twice(name: &str) -> Words {
    Words::new(
        format!("two files are called {name}: on a robot all are in one folder"),
        format!("два файла называются {name}, а на роботе все они в одной папке"),
    )
}

pub(super) fn is_sent(name: &str, count: usize, all: usize) -> Words {
    Words::new(
        format!("{name} is sent, {count} of {all}"),
        format!("файл {name} отправлен, {count} из {all}"),
    )
}

pub(super) fn runs(name: &str) -> Words {
    Words::new(format!("{name} runs"), format!("{name} выполняется"))
}

pub(super) fn sent() -> Words {
    Words::new("sent", "отправлено")
}

pub(super) fn failed(why: &str, locale: Locale) -> String {
    let why = told(why, locale);
    let words = Words::new(format!("FAILED: {why}"), format!("ОШИБКА: {why}"));
    words.in_locale(locale).to_owned()
}

pub(super) fn of(count: usize, all: usize) -> Words {
    Words::new(format!("{count} of {all}"), format!("{count} из {all}"))
}

/// Above the columns of the table.
pub(super) fn columns(locale: Locale) -> [&'static str; 3] {
    match locale {
        Locale::English => ["ROBOT", "FILES", "RESULT"],
        Locale::Russian => ["РОБОТ", "ФАЙЛЫ", "ИТОГ"],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_a_status_is_russian_for_who_wants_it() {
        let last = news::End::Well.describe("a b.js", 1.25);
        for (line, said) in [
            ("program none", "программа не выполняется"),
            (
                "program a (b).py (Python, process 12) for 3 s",
                "выполняется a (b).py (Python, процесс 12) уже 3 с",
            ),
            (
                "programs 5 started, 2 failed",
                "запущено программ: 5, с ошибкой: 2",
            ),
            (
                &format!("last {last}"),
                "до этого: a b.js закончилась через 1.2 с",
            ),
            (
                "rest of the last 2 ends: median 3 us, p99 4 us, most 5 us",
                "от остановки до покоя (остановок: 2): медиана 3 мкс, p99 4 мкс, наибольшее 5 мкс",
            ),
            ("battery 11.87 V, 3 s ago", "батарея 11.87 В, 3 с назад"),
            ("battery 11.87 V", "батарея 11.87 В"),
            ("control 10.0.0.1:5", "управляет 10.0.0.1:5"),
            (
                "debugger 10.0.0.1:5 is in control",
                "отладчиком управляет 10.0.0.1:5",
            ),
            ("", ""),
            ("program", "program"),
            ("program x", "program x"),
            ("something new", "something new"),
        ] {
            assert_eq!(status(line, Locale::Russian), said);
            assert_eq!(status(line, Locale::English), line);
        }
    }
}
