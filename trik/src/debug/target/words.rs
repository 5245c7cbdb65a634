//! What a robot answers to clients, in English and Russian.
//!
//! Owns the Russian of sentences that a robot has in English alone, because clients of other kinds know them: a sentence
//! that is not known stays as it is. Those of diagrams come in the language of the robot already.

use lang_text::problem::{Locale, Words};
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
        news::NOT_PAIRED => {
            "этот компьютер не сопряжён с роботом: нажмите на роботе Enter и попробуйте ещё раз в течение 30 с"
        }
        _ => return None,
    })
}

/// Of sentences with names and numbers.
fn partly(text: &str) -> Option<String> {
    if let Some(who) = text.strip_suffix(" is in control") {
        return Some(match who {
            "nobody" => "никто не управляет".to_owned(),
            who => format!("управляет {who}"),
        });
    }
    if let Some((name, _)) = text.split_once(" runs; a new version has the name") {
        return Some(format!(
            "выполняется {name}; у новой версии имя той диаграммы, которая выполняется"
        ));
    }
    patched(text)
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
    let ended = match number(" threads ended") {
        Some(ended) => format!(", потоков завершено {ended}"),
        None => String::new(),
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

pub(crate) fn lines_need_file() -> Words {
    Words::new(
        "lines and labels are those of --file FILE",
        "строки и метки - из --file FILE",
    )
}

/// With the label that may be meant.
pub(crate) fn no_such_block(near: Option<Words>) -> Words {
    let (english, russian) =
        near.map_or_else(Default::default, |near| (near.english, near.russian));
    Words::new(
        format!("the program has no such block{english}"),
        format!("в программе нет такого блока{russian}"),
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
    fn what_a_robot_answers_is_russian_for_who_wants_it() {
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
            // A newer robot may say more.
            ("many blocks kept", "many blocks kept"),
            ("something else", "something else"),
        ] {
            let heard = told(text, Locale::Russian);
            assert!(heard.starts_with(russian), "{heard}");
            assert_eq!(told(text, Locale::English), text);
        }
    }
}
