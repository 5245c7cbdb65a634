//! What can be wrong with a world model, in words.

use lang_text::problem::{Severity, Words};

pub(super) fn no_world() -> Words {
    Words::new(
        "it is no world model: it has no <root> with a <world> in it; save the field in TRIK Studio again",
        "это не модель мира: в ней нет <root>, а в нём <world>; сохраните поле в TRIK Studio ещё раз",
    )
}

/// A tag, which of its kind, its id, an attribute and its text.
pub(super) fn number(
    tag: &str,
    ordinal: usize,
    id: &str,
    name: &str,
    text: &str,
    severity: Severity,
) -> Words {
    let text: String = text.chars().take(40).collect();
    let id = if id.is_empty() {
        String::new()
    } else {
        format!(" (id {id})")
    };
    if severity == Severity::Error {
        Words::new(
            format!(
                "<{tag}> number {ordinal}{id}: {name}=\"{text}\" is beyond what a field can have; write a number between -1000000 and 1000000"
            ),
            format!(
                "<{tag}> номер {ordinal}{id}: {name}=\"{text}\" больше, чем бывает на поле; напишите число от -1000000 до 1000000"
            ),
        )
    } else {
        Words::new(
            format!(
                "<{tag}> number {ordinal}{id}: {name}=\"{text}\" is no number of this form and counts as 0"
            ),
            format!(
                "<{tag}> номер {ordinal}{id}: {name}=\"{text}\" не число такого вида и считается нулём"
            ),
        )
    }
}

pub(super) fn no_settings() -> Words {
    Words::new(
        "the world has neither settings nor a version, so its numbers are centimetres, as TRIK Studio reads them since 2025; if they were meant as pixels, add <settings/> to its <root>",
        "в мире нет ни settings, ни версии, поэтому числа в нём - сантиметры, как читает TRIK Studio с 2025 года; если это пиксели, добавьте <settings/> в <root>",
    )
}

// Parts that are locked.
pub(super) const WALLS: (&str, &str) = ("walls", "стены");
pub(super) const THINGS: (&str, &str) = ("things", "предметы");
pub(super) const DRAWINGS: (&str, &str) = ("drawings", "рисунки");
pub(super) const PICTURES: (&str, &str) = ("pictures", "картинки");
pub(super) const REGIONS: (&str, &str) = ("regions", "зоны");
pub(super) const SETTINGS: (&str, &str) = ("settings of the simulation", "настройки симуляции");
pub(super) const SENSORS: (&str, &str) = ("sensors", "датчики");
pub(super) const START: (&str, &str) = ("start of the robot", "начальное положение робота");
pub(super) const MOTORS: (&str, &str) = ("motors of the wheels", "моторы колёс");

/// Such a part is not that of the task.
pub(super) fn locked(english: &str, russian: &str) -> Words {
    Words::new(
        format!(
            "the {english} are not those of the task, which locks them: those of the task are taken"
        ),
        format!("{russian} не такие, как в задании, где их менять нельзя: взято из задания"),
    )
}

pub(super) fn same_id(tag: &str, id: &str) -> Words {
    Words::new(
        format!("a <{tag}> before has the id '{id}' too; this one is left out"),
        format!("у <{tag}> раньше тот же id '{id}'; этот элемент пропущен"),
    )
}

pub(super) fn too_many_pushed(count: usize, limit: usize) -> Words {
    Words::new(
        format!(
            "there are {count} balls, skittles and cubes, and realistic physics moves at most {limit}; take some away, or switch realistic physics off"
        ),
        format!(
            "мячей, кеглей и кубиков {count}, а реалистичная физика двигает не больше {limit}; уберите часть или выключите реалистичную физику"
        ),
    )
}

pub(super) fn too_many(limit: usize) -> Words {
    Words::new(
        format!("there are more than {limit} things on the field; nobody needs so many"),
        format!("на поле больше {limit} элементов; столько не нужно никому"),
    )
}

pub(super) fn bad_region(kind: &str) -> Words {
    Words::new(
        format!(
            "a region of the type '{kind}' is left out; there are ellipse, rectangle and bound"
        ),
        format!("область типа '{kind}' пропущена; бывают ellipse, rectangle и bound"),
    )
}

pub(super) fn bad_bound(id: &str) -> Words {
    Words::new(
        format!("a region is bound to '{id}', but no drawn thing has this id; it is left out"),
        format!("область привязана к '{id}', но нарисованного с таким id нет; она пропущена"),
    )
}

pub(super) fn bad_port(text: &str) -> Words {
    Words::new(
        format!(
            "'{text}' is no port of TRIK (it should be as M3###output######); nothing is plugged in there"
        ),
        format!(
            "'{text}' не порт TRIK (должно быть как M3###output######); там ничего не подключено"
        ),
    )
}

pub(super) fn no_contents(id: &str) -> Words {
    Words::new(
        format!(
            "what the picture '{id}' has is no picture: it is not shown, and sensors see nothing of it. Choose another one"
        ),
        format!(
            "в картинке '{id}' не картинка: она не видна ни людям, ни датчикам. Выберите другую"
        ),
    )
}

pub(super) fn no_blob(id: &str) -> Words {
    Words::new(
        format!("the picture '{id}' is not in the project, so nothing is seen in its place"),
        format!("изображения '{id}' нет в проекте, на его месте ничего не видно"),
    )
}
