//! What is said of rules before any run, in English and Russian.

use lang_text::problem::Words;

pub(super) fn never_set_up(id: &str) -> Words {
    let (english, russian) = match id {
        "" => (String::new(), String::new()),
        _ => (format!(" '{id}'"), format!(" '{id}'")),
    };
    Words::new(
        format!(
            "the event{english} is never checked: nothing sets it up; write settedUpInitially=\"true\", or <setUp id=\"...\"/> in an event that can happen"
        ),
        format!(
            "событие{russian} никогда не проверяется: его ничто не взводит; напишите settedUpInitially=\"true\" или <setUp id=\"...\"/> в событии, которое может произойти"
        ),
    )
}

pub(super) fn no_success() -> Words {
    Words::new(
        "no rule that can be reached has <success/>, so every solution fails; add an event with <success/>, or <success deferred=\"true\"/> for a program that ends by itself",
        "нет достижимого правила с <success/>, поэтому не пройдёт ни одно решение; добавьте событие с <success/> или с <success deferred=\"true\"/> для программы, которая завершается сама",
    )
}

pub(super) fn short_limit(ms: u32) -> Words {
    Words::new(
        format!(
            "the time limit is {ms} ms, in which no robot does anything: timelimit is in milliseconds"
        ),
        format!(
            "ограничение времени {ms} мс, за которое робот не успеет ничего: timelimit задаётся в миллисекундах"
        ),
    )
}

pub(super) fn late_timer(ms: i32, limit_ms: u32) -> Words {
    Words::new(
        format!("this timer of {ms} ms never ends: the time limit of {limit_ms} ms is over before"),
        format!(
            "этот таймер в {ms} мс никогда не сработает: раньше истечёт ограничение времени {limit_ms} мс"
        ),
    )
}

pub(super) fn never_set(name: &str) -> Words {
    Words::new(
        format!(
            "no rule gives the variable '{name}' a value, so it equals nothing; add a <setter>, as in <init>"
        ),
        format!(
            "ни одно правило не задаёт переменную '{name}', поэтому она ничему не равна; добавьте <setter>, например в <init>"
        ),
    )
}

pub(super) fn never_read(name: &str) -> Words {
    Words::new(
        format!("the variable '{name}' gets a value that no rule reads"),
        format!("переменной '{name}' присваивается значение, которое не читает ни одно правило"),
    )
}

pub(super) fn not_yet(name: &str) -> Words {
    Words::new(
        format!(
            "nothing is on the port of '{name}' in this world, and unless the program plugs it in the rule is an error; give the robot this sensor"
        ),
        format!(
            "на порту '{name}' в этом мире ничего нет, и если программа его не подключит, правило даст ошибку; дайте роботу этот датчик"
        ),
    )
}

pub(super) fn no_class(name: &str) -> Words {
    Words::new(
        format!(
            "'{name}' is the class of nothing that a robot of TRIK or a field has, so this comparison is always the same"
        ),
        format!(
            "класса '{name}' нет ни у чего на роботе ТРИК и на поле, поэтому результат сравнения всегда один"
        ),
    )
}

/// One message after another.
pub(crate) fn and(one: &Words, other: &Words) -> Words {
    Words::new(
        format!("{}{}", one.english, other.english),
        format!("{}{}", one.russian, other.russian),
    )
}

/// A tag or a template that was meant by one that is not there.
pub(crate) fn meant(known: &str) -> Words {
    Words::new(
        format!("Did you mean \"{known}\"?"),
        format!("Может быть, \"{known}\"?"),
    )
}

/// What to do about two rules with one id.
pub(crate) fn rename() -> Words {
    Words::new(
        "A rule before has this id too: give one of them another id",
        "У правила выше тот же id: дайте одному из них другой",
    )
}

/// A constraint that is broken before the program can do anything.
pub(super) fn broken_at_start(object: &str, region: &str, is_inside: bool) -> Words {
    match is_inside {
        false => Words::new(
            format!(
                "every solution fails at once: '{object}' begins outside the region '{region}', and this constraint needs it inside; move one of them, or check objectPoint"
            ),
            format!(
                "любое решение сразу провалится: '{object}' в начале вне области '{region}', а это ограничение требует быть внутри; передвиньте что-то из них или проверьте objectPoint"
            ),
        ),
        true => Words::new(
            format!(
                "every solution fails at once: '{object}' begins in the region '{region}', and this constraint needs it outside; move one of them, or check objectPoint"
            ),
            format!(
                "любое решение сразу провалится: '{object}' в начале в области '{region}', а это ограничение требует быть снаружи; передвиньте что-то из них или проверьте objectPoint"
            ),
        ),
    }
}

/// A variable that looks like that of the score, which nothing sets.
pub(super) fn like_score(name: &str, score: &str) -> Words {
    Words::new(
        format!(
            "the variable '{name}' is not the score, and no rule sets that: points are counted in '{score}'; did you mean it?"
        ),
        format!(
            "переменная '{name}' - не счёт, а счёт не задаёт ни одно правило: баллы считаются в '{score}'; может быть, это она?"
        ),
    )
}
