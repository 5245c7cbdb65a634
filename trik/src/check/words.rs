//! What `trik check` says itself, in English and Russian.

use super::walk::Reason;
use lang_text::near::did_you_mean;
use lang_text::problem::{Locale, Words};
use std::io;
pub(super) use studio::explain::words::{choose, seconds};
use studio::verdict::{Counts, Verdict};

/// How Russian words begin that mean points.
pub(super) const POINTS_RUSSIAN: [&str; 2] = ["балл", "очк"];
/// Words that stand between a word for points and their number.
pub(super) const BETWEEN_POINTS: [&str; 5] = ["is", "are", "total", "всего", "итого"];
/// Words after which the highest possible number of points comes.
pub(super) const OUT_OF: [&str; 3] = ["of", "из", "out"];

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
        Verdict::Wrong => choose(locale, "not accomplished", "не выполнено"),
        Verdict::ModelTime => choose(locale, "out of time", "время вышло"),
        Verdict::Program => choose(locale, "program error", "ошибка программы"),
        Verdict::Structure => choose(locale, "broken solution", "решение испорчено"),
        Verdict::NotRun => choose(locale, "could not be run", "не запущено"),
    }
}

/// The level of what is strange in a world or in its rules.
pub(super) const WARNING: &str = "warning";

/// What the rules have counted is no number.
pub(super) fn no_score(text: &str) -> Words {
    Words::new(
        format!("total_score is '{text}', which is no number: it counts as none"),
        format!("total_score равен '{text}', это не число: баллов нет"),
    )
}

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
/// Messages that are left out.
pub(super) fn more(count: usize, locale: Locale) -> String {
    match locale {
        Locale::English => format!("and {count} more messages"),
        Locale::Russian => format!("и ещё сообщений: {count}"),
    }
}

/// The last line of a table: how many runs ended in which way. Kinds that are rare are told when there are any.
pub(super) fn summary(counts: Counts, locale: Locale) -> String {
    let all: usize = counts.iter().sum();
    let is_always = |verdict: Verdict| match verdict {
        Verdict::Accomplished | Verdict::Wrong | Verdict::NotRun => true,
        Verdict::Ended | Verdict::ModelTime | Verdict::Program | Verdict::Structure => false,
    };
    let kinds = Verdict::ALL.into_iter().zip(counts);
    let kinds = kinds.filter(|(verdict, count)| *count > 0 || is_always(*verdict));
    let kinds: Vec<String> = kinds
        .map(|(verdict, count)| format!("{count} {}", self::verdict(verdict, locale)))
        .collect();
    let kinds = kinds.join(", ");
    match locale {
        Locale::English => {
            let s = if all == 1 { "" } else { "s" };
            format!("{all} run{s}: {kinds}")
        }
        Locale::Russian => format!("запусков: {all}; {kinds}"),
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

/// A program without diagrams, of which one is to be run.
pub(super) fn diagram_of_no_diagram(locale: Locale) -> &'static str {
    choose(
        locale,
        "--diagram is for diagrams (NAME.qrs, NAME.flow), and this is another program",
        "--diagram есть только у диаграмм (NAME.qrs, NAME.flow), а это другая программа",
    )
}

/// A program with text that has nowhere to run.
pub(super) fn no_world(locale: Locale) -> &'static str {
    choose(
        locale,
        "a program with text has no world of its own: --field WORLD.xml gives one, or --task TASK.qrs, the save that pupils were given",
        "у текстовой программы нет своего мира: его даст --field WORLD.xml или --task TASK.qrs, выданное ученикам сохранение",
    )
}

/// A save that pupils were given and that has no world.
pub(super) fn given_without_world() -> Words {
    Words::new("there is no world in it", "в нём нет мира")
}

/// How far it is.
pub(super) fn progress(done: usize, all: usize, locale: Locale) -> String {
    match locale {
        Locale::English => format!("{done} of {all}"),
        Locale::Russian => format!("{done} из {all}"),
    }
}

/// Titles of the table of a class.
pub(super) struct Titles {
    pub grades: &'static str,
    pub runs: &'static str,
    pub pupil: &'static str,
    pub task: &'static str,
    pub result: &'static str,
    pub points: &'static str,
    pub weight: &'static str,
    pub sum: &'static str,
    pub passed: &'static str,
}

/// See [`Titles`].
pub(super) fn table(locale: Locale) -> Titles {
    match locale {
        Locale::English => Titles {
            grades: "Grades",
            runs: "Runs",
            pupil: "pupil",
            task: "task",
            result: "result",
            points: "points",
            weight: "weight",
            sum: "sum",
            passed: "passed",
        },
        Locale::Russian => Titles {
            grades: "Оценки",
            runs: "Запуски",
            pupil: "ученик",
            task: "задание",
            result: "результат",
            points: "баллы",
            weight: "вес",
            sum: "сумма",
            passed: "зачтено",
        },
    }
}

/// The only task of a class, if nothing says what it is called.
pub(super) fn task(locale: Locale) -> &'static str {
    table(locale).task
}

/// There is no solution.
pub(super) fn missing(locale: Locale) -> &'static str {
    choose(locale, "missing", "нет решения")
}

/// Whether somebody has passed.
pub(super) fn yes_or_no(yes: bool, locale: Locale) -> &'static str {
    match yes {
        true => choose(locale, "yes", "да"),
        false => choose(locale, "no", "нет"),
    }
}

/// The code of a language in a page.
pub(super) fn code(locale: Locale) -> &'static str {
    choose(locale, "en", "ru")
}

/// A table of a class is written: pupils, columns, and how many solutions are missing.
pub(super) fn graded(path: &str, counts: [usize; 3], locale: Locale) -> String {
    let [pupils, columns, missing] = counts;
    match locale {
        Locale::English => {
            format!("{path}: pupils {pupils}, columns {columns}, missing solutions {missing}")
        }
        Locale::Russian => {
            format!("{path}: учеников {pupils}, столбцов {columns}, нет решений {missing}")
        }
    }
}

/// Something in a folder that is not judged, and why.
pub(super) fn passed(path: &str, reason: &Reason, locale: Locale) -> String {
    let why = match reason {
        Reason::Ending => Words::new(
            "it is no solution: those are NAME.qrs, and NAME.js and NAME.py for tasks with a world",
            "это не решение: решения - NAME.qrs, а для заданий с миром и NAME.js и NAME.py",
        ),
        Reason::LinkToFolder => Words::new(
            "it is a link to a folder, and those are not followed; put the folder itself here",
            "это ссылка на папку, по ним не ходят; положите сюда саму папку",
        ),
        Reason::BrokenLink => Words::new(
            "it is a link to nothing",
            "это ссылка, которая никуда не ведёт",
        ),
        Reason::NoFile => Words::new(
            "it is a FIFO, a socket or a device and no file",
            "это канал (FIFO), сокет или устройство, а не файл",
        ),
        Reason::TooDeep => Words::new(
            "folders so deep are not looked into; move it up",
            "так глубоко папки не просматриваются; переместите её выше",
        ),
        Reason::Unreadable(error) => Words::new(
            format!("it cannot be read: {error}"),
            match error.kind() == io::ErrorKind::PermissionDenied {
                true => "нет прав на чтение".to_owned(),
                false => format!("не читается: {error}"),
            },
        ),
        Reason::NoTask(None) => Words::new(
            "its name and its folders name no task; call the file as the task, in a folder of the pupil",
            "ни имя, ни папки не называют задание; назовите файл как задание, в папке ученика",
        ),
        Reason::NoTask(Some(task)) => {
            let task = crate::terminal::harmless(task);
            Words::new(
                format!("its name and its folders name no task; did you mean '{task}'?"),
                format!("ни имя, ни папки не называют задание; может быть, '{task}'?"),
            )
        }
        Reason::NoTaskFile => Words::new(
            "it is no task: those are NAME.xml, NAME.qrs and folders of fields",
            "это не задание: задания - NAME.xml, NAME.qrs и папки с полями",
        ),
        Reason::HasFields => Words::new(
            "fields of this task are there, and they are used",
            "у задания есть поля, берутся они",
        ),
    };
    let why = why.in_locale(locale);
    match locale {
        Locale::English => format!("{path} is left out: {why}"),
        Locale::Russian => format!("{path} - пропущено: {why}"),
    }
}

/// How much is left out, and how much of it is not told one by one.
pub(super) fn passed_count(count: usize, told: usize, locale: Locale) -> String {
    let more = count.saturating_sub(told);
    match (locale, more) {
        (Locale::English, 0) => format!("left out: {count}"),
        (Locale::Russian, 0) => format!("пропущено: {count}"),
        (Locale::English, more) => format!("left out: {count}, of which {more} are not named here"),
        (Locale::Russian, more) => format!("пропущено: {count}, из них не названо здесь: {more}"),
    }
}

/// Somebody has a solution and is not in the list.
pub(super) fn unlisted<'a>(
    name: &str,
    listed: impl Iterator<Item = &'a str>,
    locale: Locale,
) -> String {
    let meant = did_you_mean(name, listed);
    let meant = crate::terminal::harmless(meant.in_locale(locale));
    let name = crate::terminal::harmless(name);
    match locale {
        Locale::English => {
            format!("trik: '{name}' is not in the list of --pupils; the row is added{meant}")
        }
        Locale::Russian => format!("trik: '{name}' нет в списке --pupils; строка добавлена{meant}"),
    }
}

/// There is no directory for the table of a class.
pub(super) fn no_folder(path: &str, locale: Locale) -> String {
    match locale {
        Locale::English => format!("{path}: there is no such directory for the table"),
        Locale::Russian => format!("{path}: нет такой папки для таблицы"),
    }
}

/// Where the marks are shown while they come.
pub(super) fn page_is_served(link: &str, locale: Locale) -> String {
    match locale {
        Locale::English => format!("the marks as they come, in a browser: {link}"),
        Locale::Russian => format!("оценки по мере проверки, в браузере: {link}"),
    }
}

/// All is judged, and the page is still there.
pub(super) fn page_stays(link: &str, locale: Locale) -> String {
    match locale {
        Locale::English => format!("all is judged; the page stays at {link}, Ctrl-C ends it"),
        Locale::Russian => {
            format!("всё проверено; страница остаётся: {link}, её завершит Ctrl-C")
        }
    }
}

/// A table that is too large for a page.
pub(super) fn too_many_marks(count: usize, locale: Locale) -> String {
    let max = crate::limits::MARKS_MAX;
    match locale {
        Locale::English => format!(
            "--page shows {max} marks at most, and these are {count}: judge fewer pupils or tasks at once, or without --page"
        ),
        Locale::Russian => format!(
            "--page показывает не больше {max} оценок, а здесь {count}: проверьте меньше учеников или заданий за раз, или без --page"
        ),
    }
}

/// A class without pupils or without tasks.
pub(super) fn nobody(locale: Locale) -> &'static str {
    choose(
        locale,
        "there are no solutions here and no list of --pupils: there is nothing for a table",
        "здесь нет ни решений, ни списка --pupils: таблица была бы пустой",
    )
}

/// Why several runs are not debugged.
pub(super) fn one_to_debug(count: usize, locale: Locale) -> String {
    let (before, after) = match locale {
        Locale::English => (
            "one diagram in one world is debugged at a time, not",
            "runs",
        ),
        Locale::Russian => ("отлаживается одна диаграмма в одном мире, а запусков", "-"),
    };
    format!("{before} {count} {after}")
        .trim_end_matches(" -")
        .to_owned()
}

#[cfg(test)]
mod tests {
    use crate::check::points::stated;

    #[test]
    fn points_are_told_in_russian_too() {
        for (message, points) in [
            (
                "Успешная остановка в зеленой зоне. Получено баллов: 20",
                Some(20.0),
            ),
            (
                "Робот остановился вне зоны финиша. Задание не выполнено. Набрано баллов: 0",
                Some(0.0),
            ),
            ("12,5 балла", Some(12.5)),
            ("20 баллов из 100", Some(20.0)),
            ("баллов 20 из 100", Some(20.0)),
            ("Итого баллов: всего 7", Some(7.0)),
            ("10 очков за финиш 2", Some(10.0)),
            ("Точка 7", None),
        ] {
            assert_eq!(stated(message), points, "{message}");
        }
    }
}
