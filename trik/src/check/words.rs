//! What `trik check` says itself, in English and Russian.

use super::row::Verdict;
use lang_text::problem::{Locale, Words};

fn choose(locale: Locale, english: &'static str, russian: &'static str) -> &'static str {
    match locale {
        Locale::English => english,
        Locale::Russian => russian,
    }
}

/// How messages begin that tell seconds and not points: those of TRIK Studio for a success, those of the judge for limits.
pub(super) const TIMES: [&str; 6] = [
    "The task was accomplished in ",
    "Задание выполнено за ",
    "The program was stopped after ",
    "Программа остановлена после ",
    "The run took more than ",
    "Запуск длился больше ",
];

/// How a run ended.
pub(super) fn verdict(verdict: Verdict, locale: Locale) -> &'static str {
    match verdict {
        Verdict::Accomplished => choose(locale, "accomplished", "выполнено"),
        Verdict::Ended => choose(locale, "ended (no rules)", "завершено (без правил)"),
        Verdict::Failed => choose(locale, "not accomplished", "не выполнено"),
        Verdict::Broken => choose(locale, "could not be run", "не запущено"),
    }
}

/// The level of what is strange in a world or in its rules.
pub(super) const WARNING: &str = "warning";

/// A level of a message.
pub(super) fn level(name: &str, locale: Locale) -> &'static str {
    match name {
        "info" => choose(locale, "info", "сообщение"),
        "log" => choose(locale, "log", "журнал"),
        WARNING => choose(locale, "warning", "предупреждение"),
        _ => choose(locale, "error", "ошибка"),
    }
}

/// The solution's own world.
pub(super) fn own(locale: Locale) -> &'static str {
    choose(locale, "own", "своё")
}

/// Names of the columns.
pub(super) fn heading(locale: Locale) -> [&'static str; 6] {
    match locale {
        Locale::English => ["solution", "field", "verdict", "time", "score", "why"],
        Locale::Russian => ["решение", "поле", "вердикт", "время", "баллы", "почему"],
    }
}

/// Model time.
pub(super) fn seconds(ms: u32, locale: Locale) -> String {
    let unit = choose(locale, "s", "с");
    format!("{}.{:02} {unit}", ms / 1000, ms % 1000 / 10)
}

/// Messages that are left out.
pub(super) fn more(count: usize, locale: Locale) -> String {
    match locale {
        Locale::English => format!("and {count} more messages"),
        Locale::Russian => format!("и ещё сообщений: {count}"),
    }
}

/// The last line of a table.
pub(super) fn summary(counts: [usize; 4], locale: Locale) -> String {
    let [accomplished, ended, failed, broken] = counts;
    let all: usize = counts.iter().sum();
    match locale {
        Locale::English => {
            let s = if all == 1 { "" } else { "s" };
            let ended = match ended {
                0 => String::new(),
                _ => format!(", {ended} ended without rules"),
            };
            format!(
                "{all} run{s}: {accomplished} accomplished{ended}, {failed} not accomplished, {broken} could not be run"
            )
        }
        Locale::Russian => {
            let ended = match ended {
                0 => String::new(),
                _ => format!(", завершено без правил: {ended}"),
            };
            format!(
                "запусков: {all}; выполнено: {accomplished}{ended}, не выполнено: {failed}, не запущено: {broken}"
            )
        }
    }
}

/// Files took too long to be read or written.
pub(super) fn hung() -> Words {
    Words::new(
        "reading or writing the files of this run took too much real time, and it was stopped",
        "чтение или запись файлов этого запуска заняли слишком много времени, и он остановлен",
    )
}

/// Programs in a directory were passed over.
pub(super) fn left_out(count: usize, locale: Locale) -> String {
    match locale {
        Locale::English => format!(
            "trik: programs *.js and *.py are left out, {count} here: they have no world of their own, --field gives them one"
        ),
        Locale::Russian => format!(
            "trik: программы *.js и *.py пропущены ({count}): у них нет своего мира, --field даст его"
        ),
    }
}

/// A world where a solution should be.
pub(super) fn is_world(locale: Locale) -> &'static str {
    choose(
        locale,
        "this is a world and no solution: run one in it with --field",
        "это мир, а не решение: запустите решение в нём с --field",
    )
}

/// How far it is.
pub(super) fn progress(done: usize, all: usize, locale: Locale) -> String {
    match locale {
        Locale::English => format!("{done} of {all}"),
        Locale::Russian => format!("{done} из {all}"),
    }
}
