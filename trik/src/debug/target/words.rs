//! What a robot answers to clients, in English and Russian.
//!
//! Owns the Russian of sentences that a robot has in English alone, because clients of other kinds know them, and of those
//! that commands which speak with a robot say of it: a sentence that is not known stays as it is. Those of diagrams come in
//! the language of the robot already.

use crate::limits;
use crate::remote::words as remote;
use lang_text::problem::{Locale, Words, of_system};
use trikd::protocol::news;

/// A sentence of a robot for a person with this language.
pub(crate) fn told(text: &str, locale: Locale) -> String {
    both(text).in_locale(locale).to_owned()
}

/// Whether this is that sentence of a robot, as it is told to a person with this language.
pub(crate) fn is(text: &str, sentence: &str, locale: Locale) -> bool {
    text == told(sentence, locale)
}

fn both(text: &str) -> Words {
    // What programs say comes by the same way, and may be anything.
    if text.len() > limits::TRANSLATED_BYTES_MAX {
        return Words::new(text, text);
    }
    let russian = whole(text).map(str::to_owned).or_else(|| partly(text));
    Words::new(text, russian.unwrap_or_else(|| text.to_owned()))
}

/// Of sentences that are always the same.
fn whole(text: &str) -> Option<&'static str> {
    Some(match text {
        news::NO_DIAGRAM => "диаграмма не выполняется",
        news::TOO_MUCH => "сделано ещё не всё, что было раньше; попробуйте ещё раз",
        news::HAS_ENDED => "программа закончилась",
        news::OVERTAKEN => "она была остановлена до начала",
        news::NOT_STARTED => "программу не удалось запустить",
        news::NO_DEBUGGER => "этот отладчик есть только у диаграмм и программ на JavaScript",
        news::ONLY_PYTHON => "под debugpy выполняются только программы на Python",
        news::NO_PORT => "нужны порт, пробел и имя программы",
        news::NO_SECRET => "секрет - это от 1 до 64 букв a-z, A-Z и цифр",
        news::NOT_IN_JAVASCRIPT => {
            "программу на JavaScript можно только приостановить, продолжить и остановить на ошибке: точек останова, \
             шагов и просмотра переменных нет; пусть программа их печатает"
        }
        "a program in JavaScript runs there: say its file NAME.js to join it" => {
            "там выполняется программа на JavaScript: назовите её файл NAME.js, чтобы подключиться"
        }
        "nobody is in control" => "никто не управляет",
        "there is no such file" => "такого файла нет",
        "not a file" => "это не файл",
        news::NOT_PAIRED => {
            "этот компьютер не сопряжён с роботом: нажмите на роботе Enter и попробуйте ещё раз в течение 30 с"
        }
        text => return remote::whole(text),
    })
}

/// Sentences with names and numbers, which stand for `{}`, in English and Russian; the first that fits counts.
const TEMPLATES: [[&str; 2]; 37] = [
    ["{} is not changed: {}", "{} не изменена: {}"],
    ["{} is changed: {}", "{} изменена: {}"],
    ["{} has started", "{} запущена"],
    ["{} has ended after {} s", "{} закончилась через {} с"],
    [
        "{} has failed with exit code {} after {} s",
        "{} закончилась ошибкой с кодом {} через {} с",
    ],
    [
        "{} has failed after {} s",
        "{} закончилась ошибкой через {} с",
    ],
    [
        "{} was killed by SIGKILL after {} s: perhaps the memory was short",
        "{} завершена сигналом SIGKILL через {} с: возможно, не хватило памяти",
    ],
    [
        "{} was killed by signal 9 (SIGKILL) from outside after {} s",
        "{} завершена извне сигналом 9 (SIGKILL) через {} с",
    ],
    [
        "{} was killed by SIGABRT after {} s: perhaps it is too large for the memory of a program, {} MiB",
        "{} завершена сигналом SIGABRT через {} с: возможно, она слишком велика для памяти программы, {} МиБ",
    ],
    [
        "{} was killed by {} after {} s",
        "{} завершена сигналом {} через {} с",
    ],
    [
        "{} was stopped after {} s: {}",
        "{} остановлена через {} с: {}",
    ],
    [
        "{} was stopped by a client after {} s",
        "{} остановлена клиентом через {} с",
    ],
    [
        "{} was stopped by another program after {} s",
        "{} остановлена другой программой через {} с",
    ],
    [
        "{} was stopped by {} after {} s",
        "{} остановлена: {}; через {} с",
    ],
    ["{} is in control", "управляет {}"],
    [
        "{} runs; a new version has the name of the diagram that runs",
        "выполняется {}; у новой версии имя той диаграммы, которая выполняется",
    ],
    [
        "{} asks a person, and nobody is there: trik run {} in a terminal would answer",
        "{} спрашивает человека, а никого нет: ответить может trik run {} в терминале",
    ],
    [
        "{} has not answered for {} s: perhaps its trikd is older than this program",
        "{} не отвечает уже {} с: возможно, его trikd старше этой программы",
    ],
    [
        "{} has not answered for {} s: is it a robot?",
        "{} не отвечает уже {} с: это робот?",
    ],
    [
        "nothing takes programs at {}, port {}: start a virtual robot with trik up",
        "по адресу {}, порт {}, программы никто не принимает: запустите виртуального робота командой trik up",
    ],
    [
        "nothing takes programs at {}, port {}: start trikd on the robot",
        "по адресу {}, порт {}, программы никто не принимает: запустите trikd на роботе",
    ],
    [
        "{} does not answer within {} s: is it switched on, and in the same network?",
        "{} не отвечает {} с: он включён и в той же сети?",
    ],
    [
        "there is no way to {} ({}): is this computer in the network of the robot?",
        "пути к {} нет ({}): этот компьютер в сети робота?",
    ],
    [
        "there is no robot '{}' in this network: take its IP address, which the robot shows in its network settings",
        "робота '{}' в этой сети нет: возьмите его IP-адрес, он есть в настройках сети робота",
    ],
    [
        "several robots run: say which with --robot: {}",
        "роботов несколько: назовите нужного, --robot: {}",
    ],
    [
        "stopping {} on {}; a second Ctrl-C does not wait",
        "{} на {} останавливается; второй Ctrl-C не ждёт",
    ],
    [
        "left; {} may still run on {}: trik stop ends it",
        "выход; {} на {}, возможно, ещё выполняется: trik stop её остановит",
    ],
    [
        "{} does not say that {} has stopped: look at the robot",
        "{} не говорит, что {} остановлена: посмотрите на робота",
    ],
    [
        "{}; {} may still run: trik stop ends it, once the robot can be reached",
        "{}; {}, возможно, ещё выполняется: trik stop её остановит, когда робот будет доступен",
    ],
    ["{} does not run any more", "{} больше не выполняется"],
    ["{} refuses {}: {}", "{} не принимает {}: {}"],
    ["{} does not run {}: {}", "{} не выполняет {}: {}"],
    [
        "{} has closed the connection: {}",
        "{} закрывает соединение: {}",
    ],
    [
        "the connection to {} is lost: {}",
        "соединение с {} потеряно: {}",
    ],
    [
        "{}: its trikd is older than this program, and would let other programs of this computer in: install the one that belongs to it",
        "{}: его trikd старше этой программы и впустил бы другие программы этого компьютера: установите тот, который к ней относится",
    ],
    [
        "{}; what runs goes on as it is",
        "{}; то, что выполняется, идёт дальше",
    ],
    [
        "{}: {} bytes long, and a robot takes at most {} in one message (about {} MiB)",
        "{}: длина {} байт, а в одном сообщении роботу можно передать не больше {} (около {} МиБ)",
    ],
];

/// Of sentences with names and numbers. What stands for `{}` may be a sentence too.
fn partly(text: &str) -> Option<String> {
    let fits = TEMPLATES
        .iter()
        .chain(&remote::TEMPLATES)
        .find_map(|[english, russian]| Some((fitting(text, english)?, russian)));
    if let Some((parts, russian)) = fits {
        return Some(filled(russian, &parts));
    }
    if let Some(patched) = patched(text) {
        return Some(patched);
    }
    // Of whom it is, and what.
    let Some((whose, what)) = text.split_once(": ") else {
        return Some(of_system(text)).filter(|system| system != text);
    };
    let russian = both(what).russian;
    (russian != what).then(|| format!("{whose}: {russian}"))
}

/// What stands for `{}` in a template, if the text is one of it.
fn fitting<'a>(text: &'a str, template: &str) -> Option<Vec<&'a str>> {
    let mut words = template.split("{}");
    let mut rest = text.strip_prefix(words.next()?)?;
    let mut words = words.peekable();
    let mut parts = Vec::new();
    while let Some(word) = words.next() {
        // The last one has all that is left, up to what the template ends with.
        let at = match words.peek() {
            None => rest.strip_suffix(word)?.len(),
            Some(_) => rest.find(word)?,
        };
        parts.push(&rest[..at]);
        rest = &rest[at + word.len()..];
    }
    // The last one may be what is told elsewhere.
    let (_, first) = parts.split_last()?;
    (rest.is_empty() && first.iter().all(|part| !part.is_empty())).then_some(parts)
}

fn filled(template: &str, parts: &[&str]) -> String {
    let mut words = template.split("{}");
    let mut told = words.next().unwrap_or_default().to_owned();
    for (word, part) in words.zip(parts) {
        told.push_str(&both(part).russian);
        told.push_str(word);
    }
    told
}

/// `5 blocks kept, 0 new, 0 gone, 1 threads ended`.
fn patched(text: &str) -> Option<String> {
    let mut parts = text.split(", ");
    let mut number = |suffix| {
        let digits = parts.next()?.strip_suffix(suffix)?;
        digits.parse::<u32>().ok()
    };
    let kept = number(" blocks kept")?;
    let (new, gone) = (number(" new")?, number(" gone")?);
    let ended = match parts.next() {
        None => String::new(),
        Some("1 token lost") => ", сигналов потеряно 1".to_owned(),
        Some(rest) => {
            let number = |suffix| rest.strip_suffix(suffix)?.parse::<u32>().ok();
            match (number(" threads ended"), number(" tokens lost")) {
                (Some(ended), _) => format!(", потоков завершено {ended}"),
                (None, Some(lost)) => format!(", сигналов потеряно {lost}"),
                (None, None) => return None,
            }
        }
    };
    Some(format!(
        "блоков осталось {kept}, новых {new}, удалено {gone}{ended}"
    ))
}

pub(crate) fn ctrl_c_ends() -> Words {
    Words::new("Ctrl-C ends", "Ctrl-C - конец")
}

pub(crate) fn no_such_line() -> Words {
    Words::new(
        "the diagram has no such line",
        "такой строки в диаграмме нет",
    )
}

pub(crate) fn empty_condition() -> Words {
    Words::new(
        "--if needs a condition, such as --if 'n > 3'",
        "для --if нужно условие, например --if 'n > 3'",
    )
}

pub(crate) fn lines_need_file() -> Words {
    Words::new(
        "lines, labels and captions are those of --file FILE",
        "строки, метки и надписи - из --file ФАЙЛ",
    )
}

/// With the name that may be meant.
pub(crate) fn no_such_block(near: &Words) -> Words {
    Words::new(
        format!("the program has no such block{}", near.english),
        format!("в программе нет такого блока{}", near.russian),
    )
}

/// A text means several blocks, and how each of them is said.
pub(crate) fn ambiguous(text: &str, choices: &str) -> Words {
    Words::new(
        format!("'{text}' means several blocks; give the line of one: {choices}"),
        format!("'{text}' - это несколько блоков; назовите строку одного: {choices}"),
    )
}

/// After a refusal of a place that is the name of a variable.
pub(crate) fn is_variable(name: &str) -> Words {
    Words::new(
        format!("; {name} is a variable: trik break {name} --change stops when it has changed"),
        format!("; {name} - переменная: trik break {name} --change остановит, когда она изменится"),
    )
}

pub(crate) fn not_come() -> Words {
    Words::new(
        "it has not come there; the program goes on",
        "туда она не дошла; программа выполняется дальше",
    )
}

/// After a number.
pub(crate) fn seconds() -> Words {
    Words::new("s", "с")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_end_of_a_program_is_russian_for_who_wants_it() {
        use news::End;
        for (end, russian) in [
            (End::Well, "a b.js закончилась через 1.2 с"),
            (End::Failed, "a b.js закончилась ошибкой через 1.2 с"),
            (
                End::Code(3),
                "a b.js закончилась ошибкой с кодом 3 через 1.2 с",
            ),
            (
                End::Starved,
                "a b.js завершена сигналом SIGKILL через 1.2 с: возможно",
            ),
            (
                End::Short(256),
                "a b.js завершена сигналом SIGABRT через 1.2 с: возможно, она слишком велика",
            ),
            (
                End::Killed("SIGKILL"),
                "a b.js завершена извне сигналом 9 (SIGKILL) через 1.2 с",
            ),
            (
                End::Killed("SIGSEGV"),
                "a b.js завершена сигналом SIGSEGV через 1.2 с",
            ),
            (
                End::Stopped("a client"),
                "a b.js остановлена клиентом через 1.2 с",
            ),
            (
                End::Stopped("another program"),
                "a b.js остановлена другой программой через 1.2 с",
            ),
            (
                End::Stopped("a key"),
                "a b.js остановлена: a key; через 1.2 с",
            ),
            (
                End::Greedy("it had 70 processes"),
                "a b.js остановлена через 1.2 с: it had",
            ),
        ] {
            let heard = told(&end.describe("a b.js", 1.2), Locale::Russian);
            assert!(heard.starts_with(russian), "{heard}");
        }
    }

    #[test]
    fn templates_have_as_many_places_in_both_languages_and_fit_themselves() {
        for [english, russian] in TEMPLATES.iter().chain(&remote::TEMPLATES) {
            let count = |text: &str| text.matches("{}").count();
            assert_eq!(count(english), count(russian), "{english}");
            let text = english.replace("{}", "x");
            assert_ne!(both(&text).russian, text, "{english}");
        }
    }

    #[test]
    fn what_a_robot_answers_is_russian_for_who_wants_it() {
        let long = ": ".repeat(100_000);
        let holder = news::has_control("192.168.77.5:1234".parse().unwrap());
        for (text, russian) in [
            (news::NO_DIAGRAM, "диаграмма не выполняется"),
            (&holder, "управляет 192.168.77.5:1234"),
            ("nobody is in control", "никто не управляет"),
            (&news::other_runs("a.qrs"), "выполняется a.qrs; "),
            (
                "12 blocks kept, 1 new, 2 gone",
                "блоков осталось 12, новых 1, удалено 2",
            ),
            (
                "0 blocks kept, 3 new, 9 gone, 1 threads ended",
                "блоков осталось 0, новых 3, удалено 9, потоков завершено 1",
            ),
            (
                "1 blocks kept, 0 new, 0 gone, 1 token lost",
                "блоков осталось 1, новых 0, удалено 0, сигналов потеряно 1",
            ),
            (
                "1 blocks kept, 0 new, 0 gone, 3 tokens lost",
                "блоков осталось 1, новых 0, удалено 0, сигналов потеряно 3",
            ),
            ("a.js: Permission denied (os error 13)", "a.js: нет прав"),
            // A newer robot may say more.
            ("many blocks kept", "many blocks kept"),
            ("something else", "something else"),
            (
                "n is not changed: no diagram runs",
                "n не изменена: диаграмма не выполняется",
            ),
            (
                "a.qrs is changed: 1 blocks kept, 0 new, 0 gone",
                "a.qrs изменена: блоков осталось 1, ",
            ),
            (
                "127.0.0.9: no diagram runs",
                "127.0.0.9: диаграмма не выполняется",
            ),
            (
                "n is not changed: main: 1:3 why",
                "n не изменена: main: 1:3 why",
            ),
            ("n is not changed: ", "n не изменена: "),
            ("has started", "has started"),
            // A program may say what it wants.
            (&long, &long),
        ] {
            let heard = told(text, Locale::Russian);
            assert!(heard.starts_with(russian), "{heard}");
            assert_eq!(told(text, Locale::English), text);
        }
    }
}
