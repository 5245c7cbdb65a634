//! What can be wrong with a document, in words.

use crate::limits;
use crate::problem::Words;

pub(super) fn entity(name: &str) -> Words {
    Words::new(
        format!("'&{name}' stands for nothing here: write &amp; for the sign itself"),
        format!("'&{name}' здесь ничего не значит: сам знак пишется как &amp;"),
    )
}

pub(super) fn document_type() -> Words {
    Words::new(
        "a document type (<!DOCTYPE>) is not read, because it can name files and make texts grow: remove it",
        "описание типа (<!DOCTYPE>) не читается, потому что может называть файлы и раздувать тексты: удалите его",
    )
}

pub(super) fn strange(found: char) -> Words {
    let shown = found.escape_default();
    Words::new(
        format!("'{shown}' cannot stand here: this is not XML"),
        format!("'{shown}' не может стоять здесь: это не XML"),
    )
}

pub(super) fn no_value(name: &str) -> Words {
    Words::new(
        format!("the attribute '{name}' needs a value in quotes"),
        format!("атрибуту '{name}' нужно значение в кавычках"),
    )
}

pub(super) fn angle_in_value(name: &str) -> Words {
    Words::new(
        format!("'<' cannot stand in the value of '{name}': write &lt;"),
        format!("'<' не может стоять в значении '{name}': напишите &lt;"),
    )
}

pub(super) fn attribute_twice(name: &str) -> Words {
    Words::new(
        format!("the attribute '{name}' is there twice"),
        format!("атрибут '{name}' указан дважды"),
    )
}

pub(super) fn wrong_end(found: &str, open: &str) -> Words {
    Words::new(
        format!("</{found}> stands where </{open}> should"),
        format!("</{found}> стоит там, где должен быть </{open}>"),
    )
}

pub(super) fn end_of_nothing(found: &str) -> Words {
    Words::new(
        format!("</{found}> ends a tag that did not begin"),
        format!("</{found}> закрывает тег, который не открыт"),
    )
}

pub(super) fn unfinished() -> Words {
    Words::new(
        "the text ends before its tags do: the file is cut short",
        "текст кончается раньше, чем закрыты теги: файл обрезан",
    )
}

pub(super) fn two_roots() -> Words {
    Words::new(
        "a second document begins after the end of the first",
        "после конца документа начинается второй",
    )
}

pub(super) fn text_outside() -> Words {
    Words::new("text stands outside of all tags", "текст стоит вне тегов")
}

pub(super) fn too_deep() -> Words {
    Words::new(
        format!("tags are nested deeper than {}", limits::XML_DEPTH),
        format!("теги вложены глубже {}", limits::XML_DEPTH),
    )
}

pub(super) fn too_many_tags() -> Words {
    Words::new(
        format!("more than {} tags in one document", limits::XML_TAGS),
        format!("в документе больше {} тегов", limits::XML_TAGS),
    )
}

pub(super) fn too_many_attributes() -> Words {
    Words::new(
        format!("more than {} attributes in one tag", limits::XML_ATTRIBUTES),
        format!("в теге больше {} атрибутов", limits::XML_ATTRIBUTES),
    )
}
