//! What a debugger in a terminal says of a program, in English and Russian.
//!
//! Owns the words. What can be typed, and its help, are in `debug::words`.

use lang_text::problem::{Locale, Words};

/// A sentence of these words.
pub(crate) fn in_locale(locale: Locale, words: Words) -> String {
    words.in_locale(locale).to_owned()
}

pub(crate) fn greeting() -> Words {
    Words::new(
        "This is trik debug; help shows what can be typed.",
        "Это trik debug; help показывает, что можно ввести.",
    )
}

pub(crate) fn ends_by_quit() -> Words {
    Words::new("type quit to end", "чтобы закончить, введите quit")
}

/// A line that is typed, and left out.
pub(crate) fn too_long(bytes: usize) -> Words {
    Words::new(
        format!("this line is too long and is left out: a line has fewer than {bytes} bytes"),
        format!("эта строка слишком длинная и пропущена: в строке меньше {bytes} байт"),
    )
}

/// Of a question, by its words or the variable that is asked for.
pub(crate) fn nobody_answers(what: &str) -> Words {
    Words::new(
        format!("{what} is asked for, and nobody is there to answer: --inputs FILE has answers"),
        format!("запрошено значение {what}, а ответить некому: ответы можно дать в --inputs ФАЙЛ"),
    )
}

/// Of who answered until now.
pub(crate) fn answers_end() -> Words {
    Words::new(
        "nobody is there to answer any more: what a question proposes counts, or there is no answer",
        "отвечать больше некому: действует то, что предлагает вопрос, или ответа нет",
    )
}

/// After a refusal of a place that is the name of a variable.
pub(crate) fn is_variable(name: &str) -> Words {
    Words::new(
        format!("; {name} is a variable: watch {name} stops after it changes"),
        format!("; {name} - переменная: watch {name} остановит, когда она изменится"),
    )
}

pub(crate) fn scene_unknown() -> Words {
    Words::new(
        "where a robot is can be seen, and is not known here",
        "где робот, видно, а здесь неизвестно",
    )
}

/// Where a robot is at a time in seconds, in pixels and degrees.
pub(crate) fn scene(seconds: f64, [x, y, degrees]: [f64; 3], is_marking: bool) -> Words {
    let (english, russian) = match is_marking {
        true => (", markers draw", ", маркеры рисуют"),
        false => ("", ""),
    };
    Words::new(
        format!(
            "at {seconds:.2} s the robot is at x {x:.1}, y {y:.1} px and looks to {degrees:.1} degrees{english}"
        ),
        format!(
            "в {seconds:.2} с робот в точке x {x:.1}, y {y:.1} px и смотрит на {degrees:.1} градуса{russian}"
        ),
    )
}

pub(crate) fn ended_at(time: &str) -> Words {
    Words::new(
        format!("the program has ended at {time}"),
        format!("программа закончилась в {time}"),
    )
}

pub(crate) fn past_remains() -> Words {
    Words::new(
        "what was can still be looked at: reverse-next, back, print, where",
        "прошлое ещё можно смотреть: reverse-next, back, print, where",
    )
}

pub(crate) fn set_at(number: &str, line: usize, text: &str) -> Words {
    Words::new(
        format!("breakpoint {number} at line {line}: {text}"),
        format!("точка останова {number}, строка {line}: {text}"),
    )
}

pub(crate) fn watches(number: &str, variable: &str) -> Words {
    Words::new(
        format!("breakpoint {number} watches {variable}"),
        format!("точка останова {number} наблюдает за {variable}"),
    )
}

pub(crate) fn changed(what: &str) -> Words {
    Words::new(format!("changed: {what}"), format!("изменено: {what}"))
}

pub(crate) fn goes_on_as_it_was(why: &str) -> Words {
    Words::new(
        format!("{why}\nwhat runs goes on as it was"),
        format!("{why}\nто, что выполняется, не изменилось"),
    )
}

pub(crate) fn begins_anew(why: &str) -> Words {
    Words::new(
        format!("the program begins anew: {why}"),
        format!("программа начинается сначала: {why}"),
    )
}

pub(crate) fn unchanged(why: &str) -> Words {
    Words::new(
        format!("{why}\nnothing is changed"),
        format!("{why}\nничего не изменено"),
    )
}

pub(crate) fn unchanged_unless_anew(why: &str) -> Words {
    Words::new(
        format!("{why}\nnothing is changed; quit and start again to begin anew"),
        format!("{why}\nничего не изменено; чтобы начать сначала, введите quit и запустите снова"),
    )
}

pub(crate) fn lines_there_are(count: usize) -> Words {
    Words::new(
        format!("there are {count} lines"),
        format!("строк всего {count}"),
    )
}

pub(crate) fn no_thread() -> Words {
    Words::new("no thread lives", "ни один поток не выполняется")
}

pub(crate) fn no_threads() -> Words {
    Words::new(
        "a data-flow program has no threads and no calls to return from: it stops and steps as a whole",
        "в потоковой программе нет задач и возвратов из вызова: она останавливается и шагает целиком",
    )
}

pub(crate) fn no_variable() -> Words {
    Words::new(
        "no variable has a value yet",
        "ни у одной переменной ещё нет значения",
    )
}

pub(crate) fn no_breakpoints() -> Words {
    Words::new("there are no breakpoints", "точек останова нет")
}

pub(crate) fn more(count: u64) -> Words {
    Words::new(format!("and {count} more"), format!("и ещё {count}"))
}

pub(crate) fn line() -> Words {
    Words::new("line", "строка")
}

pub(crate) fn watching() -> Words {
    Words::new("watches", "наблюдает за")
}

pub(crate) fn hits() -> Words {
    Words::new("hits", "срабатываний")
}

pub(crate) fn if_() -> Words {
    Words::new("if", "если")
}

pub(crate) fn writes() -> Words {
    Words::new("writes", "пишет")
}

pub(crate) fn disabled() -> Words {
    Words::new("disabled", "выключена")
}

pub(crate) fn last_of_help() -> Words {
    Words::new(
        "an empty line is the line before; Ctrl-C stops a program that runs",
        "пустая строка повторяет предыдущую; Ctrl-C останавливает программу, которая выполняется",
    )
}

/// Words that stand for what is typed in their place, in English and Russian.
const STAND_INS: [[&str; 2]; 7] = [
    ["LINE", "СТРОКА"],
    ["TEXT", "ТЕКСТ"],
    ["EXPRESSION", "ВЫРАЖЕНИЕ"],
    ["THREAD", "ПОТОК"],
    ["NAME", "ИМЯ"],
    ["NUMBER", "НОМЕР"],
    ["MS", "МС"],
];

/// How a command is typed, in the language of a person.
pub(crate) fn typed(english: &str, locale: Locale) -> String {
    let mut typed = english.to_owned();
    match locale {
        Locale::English => {}
        Locale::Russian => {
            for [word, russian] in STAND_INS {
                typed = typed.replace(word, russian);
            }
        }
    }
    typed
}

/// Before where and why.
pub(crate) fn stopped() -> Words {
    Words::new("stopped", "остановлена")
}

pub(crate) fn past() -> Words {
    Words::new("past, ", "прошлое, ")
}

pub(crate) fn is_stopped(why: &str) -> Words {
    Words::new(
        format!("stopped by a debugger: {why}"),
        format!("остановлена отладчиком: {why}"),
    )
}

pub(crate) fn is_past(time: &str, why: &str) -> Words {
    Words::new(
        format!("stopped, and this is its past as it was at {time}: {why}"),
        format!("остановлена, показано её прошлое в {time}: {why}"),
    )
}

pub(crate) fn is_searched() -> Words {
    Words::new(
        "stopped, and a debugger searches its past",
        "остановлена, отладчик ищет в её прошлом",
    )
}

pub(crate) fn thread(name: &str) -> Words {
    Words::new(format!(", thread {name}"), format!(", поток {name}"))
}

pub(crate) fn breakpoint(number: u64) -> Words {
    Words::new(
        format!("breakpoint {number}"),
        format!("точка останова {number}"),
    )
}

pub(crate) fn condition(number: u64, why: &str) -> Words {
    Words::new(
        format!("the condition of breakpoint {number}: {why}"),
        format!("условие точки останова {number}: {why}"),
    )
}

pub(crate) fn nothing() -> Words {
    Words::new("nothing", "ничего")
}

pub(crate) fn was_and_is(variable: &str, was: [&str; 2], is: [&str; 2]) -> Words {
    Words::new(
        format!("{variable} was {} and is {}", was[0], is[0]),
        format!("{variable}: было {}, стало {}", was[1], is[1]),
    )
}

pub(crate) fn by_line(line: usize) -> Words {
    Words::new(format!(", by line {line}"), format!(", строка {line}"))
}

pub(crate) fn error(text: &str) -> Words {
    Words::new(format!("an error: {text}"), format!("ошибка: {text}"))
}

pub(crate) fn oldest() -> Words {
    Words::new("nothing before this is kept", "более раннее не сохранилось")
}

pub(crate) fn first() -> Words {
    Words::new("before the first block", "перед первым блоком")
}

/// A reason by its word in the protocol, which may be of a newer robot.
pub(crate) fn reason(word: &str) -> Words {
    let russian = match word {
        "pause" => "пауза",
        "step" => "шаг",
        "thread ended" => "поток закончился",
        "past" => "этот момент",
        word => word,
    };
    Words::new(word, russian)
}

pub(crate) fn waits_more(left_ms: u64) -> Words {
    Words::new(
        format!("waits {left_ms} ms more"),
        format!("ждёт ещё {left_ms} мс"),
    )
}

/// For a port, or for something by its word in the protocol.
pub(crate) fn waits_for(what: &str) -> Words {
    let russian = match what {
        "button" => "кнопку",
        "mail" => "сообщение робота",
        "answer" => "ответ",
        "message" => "сообщение",
        "threads" => "потоки",
        "step" => "следующий шаг",
        "nothing" => "неизвестно чего",
        what => what,
    };
    Words::new(format!("waits for {what}"), format!("ждёт: {russian}"))
}

/// Of threads by their names, with commas between them.
pub(crate) fn held(names: &str) -> Words {
    Words::new(format!("held: {names}"), format!("задержаны: {names}"))
}

/// By its word in the protocol.
pub(crate) fn activity(word: &str) -> Words {
    let russian = match word {
        "enters" => "входит",
        "gives way" => "уступает",
        "held" => "задержан",
        "failed" => "с ошибкой",
        word => word,
    };
    Words::new(word, russian)
}

/// How a run has ended, and when.
pub(crate) fn ending(what: [&str; 2], seconds: f64) -> Words {
    let [english, russian] = what;
    Words::new(
        format!("{english} at {seconds:.2} s of model time"),
        format!("{russian} в {seconds:.2} с модельного времени"),
    )
}

pub(crate) const ACCOMPLISHED: [&str; 2] = ["the task is accomplished", "задание выполнено"];
pub(crate) const ENDED: [&str; 2] = ["the program has ended", "программа закончилась"];
pub(crate) fn has_ended() -> Words {
    let [english, russian] = ENDED;
    Words::new(english, russian)
}

pub(crate) fn other_language() -> Words {
    Words::new(
        "what runs is a program of the other language of blocks: end it, and start the new one",
        "выполняется программа на другом языке блоков: завершите её и запустите новую",
    )
}

pub(crate) const TIME_IS_OVER: [&str; 2] = [
    "the run was stopped, its model time is over",
    "запуск остановлен, его модельное время вышло",
];
pub(crate) const FAILED: [&str; 2] = ["the program has failed", "в программе ошибка"];
pub(crate) const CANNOT_BEGIN: [&str; 2] =
    ["the program cannot begin", "программа не может начаться"];
pub(crate) const NOT_ACCOMPLISHED: [&str; 2] =
    ["the task is not accomplished", "задание не выполнено"];
pub(crate) const GIVEN_UP: [&str; 2] = ["the run was given up", "запуск прерван"];

pub(crate) fn another_runs(diagram: &str, block: &str) -> Words {
    Words::new(
        format!(">     {diagram}, {block}: this block is not in the file: another diagram runs"),
        format!(">     {diagram}, {block}: этого блока в файле нет: выполняется другая диаграмма"),
    )
}

/// What a port of a data-flow program is about to get.
pub(crate) fn token(port: &str, value: &str) -> Words {
    if value.is_empty() {
        return Words::new(
            format!("      {port} gets a token without a value"),
            format!("      {port} получит сигнал без значения"),
        );
    }
    Words::new(
        format!("      {port} gets {value}"),
        format!("      {port} получит {value}"),
    )
}

/// Tokens that wait at a port, and those that it has lost.
pub(crate) fn waiting(port: &str, count: u64, lost: u64) -> Words {
    Words::new(
        format!("{port}: {count} tokens wait, {lost} lost"),
        format!("{port}: ждёт сигналов {count}, потеряно {lost}"),
    )
}
