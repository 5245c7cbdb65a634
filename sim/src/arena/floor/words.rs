//! What can be wrong with pictures and colours on a floor, in words.

use super::picture::Lack;
use lang_text::problem::Words;

pub(super) fn no_colour(text: &str) -> Words {
    let text: String = text.chars().take(40).collect();
    Words::new(
        format!(
            "'{text}' is no colour; sensors see black there. Write a name as red, #rrggbb or #aarrggbb"
        ),
        format!(
            "'{text}' не цвет; датчики видят там чёрный. Напишите имя, например red, #rrggbb или #aarrggbb"
        ),
    )
}

pub(super) fn no_picture(id: &str) -> Words {
    Words::new(
        format!(
            "the picture {id} is not in the project, so sensors do not see it; put it onto the field again"
        ),
        format!(
            "картинки {id} нет в проекте, поэтому датчики её не видят; положите её на поле ещё раз"
        ),
    )
}

pub(super) fn outside(path: &str) -> Words {
    Words::new(
        format!(
            "the picture is not in the project but in the file {path}, so sensors do not see it; let the project keep it"
        ),
        format!(
            "картинка хранится не в проекте, а в файле {path}, поэтому датчики её не видят; сохраните её в проекте"
        ),
    )
}

pub(super) fn bad_picture(id: &str, why: &Words) -> Words {
    Words::new(
        format!("sensors do not see the picture {id}: {}", why.english),
        format!("датчики не видят картинку {id}: {}", why.russian),
    )
}

pub(super) fn lacks(what: Lack) -> Words {
    let [english, russian] = match what {
        Lack::Text => ["text", "текст"],
        Lack::Damaged => [
            "a picture inside that is damaged",
            "повреждённая картинка внутри",
        ],
        Lack::Other => [
            "a picture inside that is neither PNG nor JPEG",
            "картинка внутри, которая не PNG и не JPEG",
        ],
        Lack::Pattern => ["a pattern", "узор"],
    };
    Words::new(
        format!("the picture has something that sensors see otherwise or not at all: {english}"),
        format!("в картинке есть то, что датчики видят иначе или не видят совсем: {russian}"),
    )
}

pub(super) fn too_much() -> Words {
    let limit = crate::limits::FLOOR_STEPS;
    Words::new(
        format!(
            "more than {limit} lines are drawn on the field; sensors do not see the last ones. Make a PNG of them"
        ),
        format!(
            "на поле нарисовано больше {limit} линий; последних датчики не видят. Сделайте из них PNG"
        ),
    )
}
