//! What is said of a world before any solution, in English and Russian.

use lang_text::problem::Words;

/// The limit of time is longer than `trik check` runs by itself.
pub(super) fn long_limit(ms: u32, longest_ms: u32) -> Words {
    let [limit, longest] = [ms, longest_ms].map(|ms| f64::from(ms) / 1000.0);
    Words::new(
        format!(
            "the time limit is {limit} s, and 'trik check' stops a run after {longest} s unless --time-limit allows more"
        ),
        format!(
            "ограничение времени {limit} с, а 'trik check' останавливает запуск через {longest} с, если --time-limit не разрешает больше"
        ),
    )
}

/// A drawn thing that was meant by a name that is nobody's.
pub(super) fn meant(id: &str, known: &str) -> Words {
    Words::new(
        format!("boundItem=\"{id}\": did you mean '{known}'?"),
        format!("boundItem=\"{id}\": может быть, '{known}'?"),
    )
}

/// Nothing can be in a region.
pub(super) fn nowhere(id: &str, is_bound: bool) -> Words {
    match is_bound {
        true => Words::new(
            format!(
                "nothing is ever in the region '{id}': lines, curves and strokes have no inside; bind it to a rectangle or an ellipse"
            ),
            format!(
                "в области '{id}' никогда ничего нет: у линий, кривых и штрихов нет внутренности; привяжите её к прямоугольнику или эллипсу"
            ),
        ),
        false => Words::new(
            format!(
                "nothing is ever in the region '{id}': its width or height is 0; write both, in the unit of the file"
            ),
            format!(
                "в области '{id}' никогда ничего нет: её ширина или высота 0; напишите обе, в единицах файла"
            ),
        ),
    }
}

/// Rules mean something else by this id.
pub(super) fn taken(id: &str) -> Words {
    Words::new(
        format!("rules mean the robot or its trace by '{id}', not this; give it another id"),
        format!("в правилах '{id}' - это робот или его след, а не этот элемент; дайте другой id"),
    )
}

/// Rules mean another thing with the same id.
pub(super) fn same_name(id: &str, other: &str) -> Words {
    Words::new(
        format!(
            "the id '{id}' is that of something in '{other}' too, which rules mean by it; give one of them another id"
        ),
        format!(
            "id '{id}' есть и у элемента '{other}', и правила имеют в виду его; дайте одному из них другой id"
        ),
    )
}

/// No robot of TRIK.
pub(super) fn other_kit() -> Words {
    Words::new(
        "no robot of this world is one of TRIK (id=\"trikKitRobot\"): sensors and wheels of others are left out",
        "в этом мире нет робота ТРИК (id=\"trikKitRobot\"): датчики и колёса других роботов пропускаются",
    )
}

/// Two sensors on one port.
pub(super) fn port_twice(port: &str) -> Words {
    Words::new(
        format!(
            "another sensor is on the port {port} too, and this one takes its place; use another port"
        ),
        format!(
            "на порту {port} уже есть другой датчик, и этот его заменяет; выберите другой порт"
        ),
    )
}

/// A sensor on a port that is none.
pub(super) fn no_port(text: &str) -> Words {
    let text: String = text.chars().take(60).collect();
    Words::new(
        format!(
            "the sensor is on no port of TRIK, so nothing reads it: port=\"{text}\" should be as A1###input######sensorA1"
        ),
        format!(
            "датчик не на порту ТРИК, и его никто не читает: вместо port=\"{text}\" должно быть как A1###input######sensorA1"
        ),
    )
}

/// A type of sensor that was meant by another name.
pub(super) fn sensor_type(name: &str, known: &str) -> Words {
    Words::new(
        format!(
            "no sensor is of the type '{name}', so nothing is on its port; did you mean '{known}'?"
        ),
        format!("датчика типа '{name}' нет, и на порту ничего не будет; может быть, '{known}'?"),
    )
}

/// A tag that means nothing where it stands.
pub(super) fn unknown_tag(tag: &str, outside: &str, near: &Words) -> Words {
    let place = match outside {
        "" => String::new(),
        _ => format!(" in <{outside}>"),
    };
    let place_ru = match outside {
        "" => String::new(),
        _ => format!(" в <{outside}>"),
    };
    Words::new(
        format!(
            "<{tag}>{place} means nothing, and is left out{}",
            near.english
        ),
        format!(
            "<{tag}>{place_ru} ничего не значит и пропускается{}",
            near.russian
        ),
    )
}

/// An attribute that means nothing in its tag.
pub(super) fn unknown_attribute(tag: &str, name: &str, near: Option<&str>) -> Words {
    let (english, russian) = match near {
        Some(near) => (
            format!("; did you mean '{near}'?"),
            format!("; может быть, '{near}'?"),
        ),
        None => (String::new(), String::new()),
    };
    Words::new(
        format!("the attribute '{name}' of <{tag}> means nothing{english}"),
        format!("атрибут '{name}' у <{tag}> ничего не значит{russian}"),
    )
}

/// The beginning of a text of an attribute.
fn brief(text: &str) -> String {
    text.chars().take(40).collect()
}

/// A colour that is none.
pub(super) fn no_colour(name: &str, text: &str) -> Words {
    let text = brief(text);
    let (usual, usual_ru) = match name {
        "backgroundColor" => ("white", "белый"),
        _ => ("black", "чёрный"),
    };
    Words::new(
        format!(
            "{name}=\"{text}\" is no colour, and {usual} is taken; write a name such as red, #rrggbb or #aarrggbb"
        ),
        format!(
            "{name}=\"{text}\" не цвет, и берётся {usual_ru}; напишите имя, например red, #rrggbb или #aarrggbb"
        ),
    )
}

/// A word that is none of those that an attribute knows.
pub(super) fn no_word(
    name: &str,
    text: &str,
    known: &[&str],
    other: &str,
    near: Option<&str>,
) -> Words {
    let (text, known) = (brief(text), known.join(", "));
    let (meant, meant_ru) = match near {
        Some(near) => (
            format!("did you mean \"{near}\"?"),
            format!("может быть, \"{near}\"?"),
        ),
        None => (format!("there are {known}"), format!("бывают {known}")),
    };
    Words::new(
        format!("{name}=\"{text}\" is unknown, and \"{other}\" is taken; {meant}"),
        format!("{name}=\"{text}\" неизвестно, и берётся \"{other}\"; {meant_ru}"),
    )
}

/// A number below 0 where there is no such thing.
pub(super) fn negative(name: &str, text: &str) -> Words {
    let text = brief(text);
    Words::new(
        format!("{name}=\"{text}\" is below 0, which nothing has; write a number from 0 on"),
        format!("{name}=\"{text}\" меньше нуля, чего не бывает; напишите число от 0"),
    )
}

/// A size of nothing or less.
pub(super) fn not_positive(name: &str, text: &str) -> Words {
    let text = brief(text);
    Words::new(
        format!(
            "{name}=\"{text}\" is not above 0, so nothing can have this size; write a number above 0"
        ),
        format!(
            "{name}=\"{text}\" не больше нуля, такого размера не бывает; напишите число больше 0"
        ),
    )
}

/// A width of a ring that is no whole number.
pub(super) fn not_whole(name: &str, text: &str) -> Words {
    let text = brief(text);
    Words::new(
        format!(
            "{name}=\"{text}\" of a region is no whole number from 0 on, and counts as 0: it is the width of the ring, not a colour"
        ),
        format!(
            "{name}=\"{text}\" у области не целое число от 0 и считается нулём: это ширина кольца, а не цвет"
        ),
    )
}

/// One of two attributes that are meant together.
pub(super) fn half(there: &str, missing: &str, is_void: bool) -> Words {
    match is_void {
        true => Words::new(
            format!("'{there}' means nothing without '{missing}'; write both"),
            format!("'{there}' ничего не значит без '{missing}'; напишите оба"),
        ),
        false => Words::new(
            format!("'{there}' is there and '{missing}' is not, so '{missing}' is 0; write both"),
            format!("есть '{there}', но нет '{missing}', и '{missing}' равно 0; напишите оба"),
        ),
    }
}

/// A region takes the place of another one.
pub(super) fn region_twice(id: &str) -> Words {
    Words::new(
        format!(
            "a region before has the id '{id}' too, and this one takes its place; give one of them another id"
        ),
        format!(
            "у другой области выше тот же id '{id}', и эта занимает её место; дайте одной из них другой id"
        ),
    )
}
