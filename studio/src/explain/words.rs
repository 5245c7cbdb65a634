//! What explanations of runs say, in English and Russian.

use crate::verdict::Verdict;
use lang_constraint::Kind;
use lang_text::problem::{Locale, Words};
use sim::judge::{Running, Spot};

/// One of both.
pub fn choose(locale: Locale, english: &'static str, russian: &'static str) -> &'static str {
    match locale {
        Locale::English => english,
        Locale::Russian => russian,
    }
}

/// A time in seconds, with two digits.
pub fn seconds(ms: u32, locale: Locale) -> String {
    let unit = choose(locale, "s", "с");
    format!("{}.{:02} {unit}", ms / 1000, ms % 1000 / 10)
}

/// Short names of units.
pub(super) struct Units {
    pub ms: &'static str,
    pub px: &'static str,
    pub cm: &'static str,
}

/// See [`Units`].
pub(super) fn units(locale: Locale) -> Units {
    match locale {
        Locale::English => Units {
            ms: "ms",
            px: "px",
            cm: "cm",
        },
        Locale::Russian => Units {
            ms: "мс",
            px: "пикс.",
            cm: "см",
        },
    }
}

/// A rule as people find it: what it is, and its id or its place among its kind.
pub(super) fn rule(kind: Kind, id: &str, number: usize, locale: Locale) -> String {
    let kind = match kind {
        Kind::Event => choose(locale, "event", "событие"),
        Kind::Constraint => choose(locale, "constraint", "ограничение"),
        Kind::TimeLimit => choose(locale, "timelimit", "ограничение времени"),
        Kind::Init => choose(locale, "init", "начальные действия"),
    };
    match (id, locale) {
        ("", Locale::English) => format!("{kind} #{number}"),
        ("", Locale::Russian) => format!("{kind} №{number}"),
        (id, _) => format!("{kind} '{id}'"),
    }
}

/// The first line: what decided, and when.
pub(super) fn why(verdict: Verdict, rule: Option<String>, ms: u32, locale: Locale) -> String {
    let at = seconds(ms, locale);
    let rule = rule.unwrap_or_default();
    match (verdict, &*rule, locale) {
        (Verdict::Program, _, Locale::English) => {
            format!("why: the program has an error; the run ended at {at}")
        }
        (Verdict::Program, _, Locale::Russian) => {
            format!("почему: в программе ошибка; запуск окончен на {at}")
        }
        (Verdict::Structure, _, Locale::English) => "why: the program cannot begin".to_owned(),
        (Verdict::Structure, _, Locale::Russian) => {
            "почему: программа не может начаться".to_owned()
        }
        (Verdict::NotRun, _, Locale::English) => format!("why: the run was cut off at {at}"),
        (Verdict::NotRun, _, Locale::Russian) => format!("почему: запуск прерван на {at}"),
        (Verdict::Ended, _, Locale::English) => {
            format!("why: there are no rules; it ended at {at}")
        }
        (Verdict::Ended, _, Locale::Russian) => format!("почему: правил нет; конец на {at}"),
        (Verdict::ModelTime, "", Locale::English) => {
            format!("why: the longest model time was over at {at}")
        }
        (Verdict::ModelTime, "", Locale::Russian) => {
            format!("почему: наибольшее модельное время вышло на {at}")
        }
        (_, "", Locale::English) => {
            format!("why: the program ended at {at}, and no rule had said that the task is done")
        }
        (_, "", Locale::Russian) => {
            format!("почему: программа окончена на {at}, и ни одно правило не засчитало задание")
        }
        (_, rule, Locale::English) => format!("why: {rule} decided at {at}"),
        (_, rule, Locale::Russian) => format!("почему: решило {rule} на {at}"),
    }
}

/// A rule has fired; what has to hold was broken then.
pub(super) fn fired(kind: Kind, ms: u64, locale: Locale) -> String {
    let at = seconds(u32::try_from(ms).unwrap_or(u32::MAX), locale);
    match (kind, locale) {
        (Kind::Constraint, Locale::English) => format!("broken at {at}"),
        (Kind::Constraint, Locale::Russian) => format!("нарушено на {at}"),
        (Kind::Event | Kind::TimeLimit | Kind::Init, Locale::English) => format!("fired at {at}"),
        (Kind::Event | Kind::TimeLimit | Kind::Init, Locale::Russian) => {
            format!("сработало на {at}")
        }
    }
}

/// A rule was looked at and never fired.
pub(super) fn never_true(locale: Locale) -> String {
    choose(locale, "never fired", "не сработало").to_owned()
}

/// A rule was dropped before it fired.
pub(super) fn dropped(locale: Locale) -> String {
    choose(
        locale,
        "dropped before it fired",
        "снято раньше, чем сработало",
    )
    .to_owned()
}

/// A rule was never set up.
pub(super) fn never_set_up(by: &str, locale: Locale) -> String {
    match (locale, by) {
        (Locale::English, "") => "never set up, and no rule does it".to_owned(),
        (Locale::Russian, "") => "не взведено, и никакое правило его не взводит".to_owned(),
        (Locale::English, by) => format!("never set up, which {by} does"),
        (Locale::Russian, by) => format!("не взведено; его взводит {by}"),
    }
}

/// What stands before a condition that must be false.
pub(super) fn not(locale: Locale) -> &'static str {
    choose(locale, "not ", "не ")
}

/// The head of several conditions.
pub(super) fn head(text: &str, locale: Locale) -> &'static str {
    match text {
        "or" => choose(locale, "one of", "одно из"),
        _ => choose(locale, "all of", "все из"),
    }
}

/// Nobody has asked for a condition.
pub(super) fn not_looked_at(locale: Locale) -> &'static str {
    choose(locale, "not known", "неизвестно")
}

/// Whether it was true.
pub(super) fn holds(holds: bool, locale: Locale) -> &'static str {
    match holds {
        true => choose(locale, "true", "верно"),
        false => choose(locale, "false", "неверно"),
    }
}

/// The values of both sides.
pub(super) fn values(left: &str, right: &str, locale: Locale) -> String {
    match locale {
        Locale::English => format!("{left} and {right}"),
        Locale::Russian => format!("{left} и {right}"),
    }
}

/// How near a condition came.
pub(super) fn nearest(distance: &str, ms: u64, locale: Locale) -> String {
    let at = seconds(u32::try_from(ms).unwrap_or(u32::MAX), locale);
    match locale {
        Locale::English => format!("; nearest {distance} at {at}"),
        Locale::Russian => format!("; ближе всего {distance} на {at}"),
    }
}

/// What is left out.
pub(super) fn more(count: usize, locale: Locale) -> String {
    match locale {
        Locale::English => format!("and {count} more"),
        Locale::Russian => format!("и ещё {count}"),
    }
}

/// Where a thread is.
pub(super) fn running(one: &Running, locale: Locale) -> String {
    let thread = &one.thread;
    let ended = one.ended_ms.map(|ms| seconds(ms, locale));
    match &one.at {
        Spot::Block {
            diagram,
            id,
            kind,
            caption: Words { english, russian },
        } => {
            // The rest of it says of which sort it is.
            let id = id.rsplit('/').next().unwrap_or(id);
            match (locale, ended) {
                (Locale::English, None) => {
                    format!("thread {thread}: at '{english}' ({kind} {id}) of '{diagram}'")
                }
                (Locale::Russian, None) => format!(
                    "поток {thread}: в блоке '{russian}' ({kind} {id}) диаграммы '{diagram}'"
                ),
                (Locale::English, Some(at)) => format!(
                    "thread {thread}: ended at {at} after '{english}' ({kind} {id}) of '{diagram}'"
                ),
                (Locale::Russian, Some(at)) => format!(
                    "поток {thread}: окончен на {at} после блока '{russian}' ({kind} {id}) диаграммы '{diagram}'"
                ),
            }
        }
        Spot::Line { file, line, at_ms } => {
            let last = seconds(*at_ms, locale);
            match (locale, ended) {
                (Locale::English, None) => {
                    format!(
                        "thread {thread}: waits or asked last at line {line} of {file}, since {last}"
                    )
                }
                (Locale::Russian, None) => format!(
                    "поток {thread}: ждёт или спросил последний раз в строке {line} файла {file}, с {last}"
                ),
                (Locale::English, Some(at)) => format!(
                    "thread {thread}: ended at {at}; it waited or asked last at line {line} of {file}, at {last}"
                ),
                (Locale::Russian, Some(at)) => format!(
                    "поток {thread}: окончен на {at}; ждал или спрашивал последний раз в строке {line} файла {file}, на {last}"
                ),
            }
        }
    }
}
