//! What can be wrong with a change to a save, in words.

use lang_text::problem::Words;

pub(super) fn no_such_object() -> Words {
    Words::new(
        "there is no such block or link in the save",
        "такого блока или связи нет в сохранении",
    )
}

pub(super) fn control_character(c: char) -> Words {
    let code = u32::from(c);
    Words::new(
        format!("the text has the control character {code}, which a save cannot carry: remove it"),
        format!(
            "в тексте управляющий символ {code}, который нельзя записать в сохранение: удалите его"
        ),
    )
}
