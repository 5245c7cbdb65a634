//! What the judge says itself, in English and Russian.

use super::track::Group;
use lang_diagram::devices::Sensor;
use lang_text::problem::{Locale, Words};

/// Names of what can be moved on a page, and of its lists: time, speed, messages, state.
pub(super) fn page(locale: Locale) -> [&'static str; 4] {
    match locale {
        Locale::English => ["time", "speed", "messages", "robot and program"],
        Locale::Russian => ["время", "скорость", "сообщения", "робот и программа"],
    }
}

/// What the button of a page does.
pub(super) fn play(locale: Locale) -> &'static str {
    match locale {
        Locale::English => "play or pause",
        Locale::Russian => "пуск или пауза",
    }
}

/// The short name of a second.
pub(super) fn second(locale: Locale) -> &'static str {
    match locale {
        Locale::English => "s",
        Locale::Russian => "с",
    }
}

/// Keys of a page.
pub(super) fn keys(locale: Locale) -> &'static str {
    match locale {
        Locale::English => "Space: play or pause; arrows: 0.1 s, with Shift 1 s; Home, End",
        Locale::Russian => "Пробел: пуск или пауза; стрелки: 0,1 с, с Shift 1 с; Home, End",
    }
}

/// What a page calls a group of values.
pub(super) fn group(group: Group, locale: Locale) -> &'static str {
    let [english, russian] = match group {
        Group::Block => ["Blocks and lines", "Блоки и строки"],
        Group::Motor => ["Motors", "Моторы"],
        Group::Sensor => ["Sensors, as read last", "Датчики, последние показания"],
        Group::Variable => ["Variables", "Переменные"],
    };
    match locale {
        Locale::English => english,
        Locale::Russian => russian,
    }
}

/// The run is longer than its limit of model time.
pub(super) fn too_long(seconds: f64) -> Words {
    Words::new(
        format!(
            "The program was stopped after {seconds} s of model time: --time-limit allows more"
        ),
        format!(
            "Программа остановлена после {seconds} с модельного времени: --time-limit разрешит больше"
        ),
    )
}

/// A run that was seen is longer than the limit of model time.
pub(super) fn seen_too_long(seconds: f64) -> Words {
    Words::new(
        format!("The recorded run is longer than {seconds} s: --time-limit allows more"),
        format!("Записанный запуск длиннее {seconds} с: --time-limit разрешит больше"),
    )
}

/// A rule would change something that nothing has changed while the run was seen.
pub(super) fn not_changed(rule: &str, text: &str) -> Words {
    Words::new(
        format!("{rule} sets {text}: nothing did that while this was recorded"),
        format!("{rule} задаёт {text}: во время записи этого никто не делал"),
    )
}

/// The run takes too much real time.
pub fn too_slow(seconds: f64) -> Words {
    Words::new(
        format!("The run took more than {seconds} s of real time: --wall-limit allows more"),
        format!("Запуск длился больше {seconds} с реального времени: --wall-limit разрешит больше"),
    )
}

/// The record of a run says nothing of the robot.
pub(super) fn nothing_recorded() -> Words {
    Words::new(
        "The recorded trajectory has no poses: TRIK Studio writes them only with --console",
        "В записанной траектории нет положений робота: TRIK Studio пишет их только с --console",
    )
}

/// No robot of a record is in the world.
pub(super) fn nobody_known(names: &[String]) -> Words {
    let quoted: Vec<String> = names.iter().map(|name| format!("'{name}'")).collect();
    let names = quoted.join(", ");
    Words::new(
        format!("The recorded trajectory is of {names}, and this world has none of them"),
        format!("Записанная траектория принадлежит роботам {names}, а в этом мире таких нет"),
    )
}

/// A robot of a record is not in the world.
pub(super) fn robot_unknown(name: &str) -> Words {
    Words::new(
        format!(
            "the record has a robot '{name}' that is not in this world; what it did is left out"
        ),
        format!("в записи есть робот '{name}', которого нет в этом мире; его действия пропущены"),
    )
}

/// The only robot of a record has another name than that of the world.
pub(super) fn robot_renamed(name: &str, own: &str) -> Words {
    Words::new(
        format!("the record is of a robot '{name}'; it is judged as '{own}' of this world"),
        format!("запись принадлежит роботу '{name}'; он проверяется как '{own}' этого мира"),
    )
}

/// A sensor was put onto an empty port because blocks wait for it.
pub(super) fn configured(sensor: Sensor, port: &str) -> Words {
    let [english, russian] = match sensor {
        Sensor::Infrared => ["Infrared Sensor", "Датчик расстояния ИК"],
        Sensor::Sonar => ["Sonic Sensor", "Датчик расстояния УЗ"],
        Sensor::Light => ["Light sensor", "Датчик света"],
        Sensor::Touch => ["Touch sensor", "Датчик касания"],
        Sensor::Other => ["Gyroscope", "Гироскоп"],
    };
    Words::new(
        format!("{english} has been auto configured to port {port}"),
        // So the original writes it.
        format!("{russian} был автоматически сгонфигурирован на порту {port}"),
    )
}
