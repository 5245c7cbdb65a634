//! What can be wrong with an object file, in words.

use crate::limits;
use lang_text::problem::Words;

pub(super) fn no_text() -> Words {
    Words::new(
        "it is not text in UTF-8; take another copy of the project",
        "это не текст в UTF-8; возьмите другую копию проекта",
    )
}

pub(super) fn no_object(tag: &str) -> Words {
    Words::new(
        format!("it must have the tag <object>, not <{tag}>"),
        format!("в нём должен быть тег <object>, а не <{tag}>"),
    )
}

pub(super) fn no_id() -> Words {
    Words::new(
        "the object has no id of the form qrm:/RobotsMetamodel/RobotsDiagram/...",
        "у объекта нет идентификатора вида qrm:/RobotsMetamodel/RobotsDiagram/...",
    )
}

pub(super) fn unknown_tag(tag: &str) -> Words {
    Words::new(
        format!("the tag <{tag}> is not known and was left out"),
        format!("тег <{tag}> неизвестен и пропущен"),
    )
}

pub(super) fn too_many_references() -> Words {
    Words::new(
        format!(
            "the lists of this save name more than {} objects",
            limits::REFERENCES
        ),
        format!(
            "списки этого сохранения называют больше {} объектов",
            limits::REFERENCES
        ),
    )
}
