//! What people read where a property takes one of several words.
//!
//! Owns these words in both languages. Ports, keys with a name on them, and numbers read as they are saved.

use lang_text::problem::Locale;

/// A word of saves, and what it is called.
const CALLED: &[(&str, [&str; 2])] = &[
    ("true", ["true", "да"]),
    ("false", ["false", "нет"]),
    ("brake", ["brake", "тормозить"]),
    ("float", ["float", "скользить"]),
    ("off", ["off", "выключен"]),
    ("line", ["line", "линия"]),
    ("object", ["object", "объект"]),
    ("color", ["color", "цвет"]),
    ("greater", ["greater", "больше"]),
    ("less", ["less", "меньше"]),
    ("notLess", ["not less", "не меньше"]),
    ("notGreater", ["not greater", "не больше"]),
    ("equals", ["equals", "равно"]),
    ("Up", ["Up", "Вверх"]),
    ("Down", ["Down", "Вниз"]),
    ("Left", ["Left", "Влево"]),
    ("Right", ["Right", "Вправо"]),
    ("xAxis", ["x axis", "ось x"]),
    ("yAxis", ["y axis", "ось y"]),
    ("zAxis", ["z axis", "ось z"]),
    ("normal", ["normal", "обычный"]),
    ("white", ["white", "белый"]),
    ("black", ["black", "чёрный"]),
    ("red", ["red", "красный"]),
    ("darkRed", ["dark red", "тёмно-красный"]),
    ("green", ["green", "зелёный"]),
    ("darkGreen", ["dark green", "тёмно-зелёный"]),
    ("blue", ["blue", "синий"]),
    ("darkBlue", ["dark blue", "тёмно-синий"]),
    ("orange", ["orange", "оранжевый"]),
    ("cyan", ["cyan", "голубой"]),
    ("darkCyan", ["dark cyan", "тёмно-голубой"]),
    ("magenta", ["magenta", "пурпурный"]),
    ("darkMagenta", ["dark magenta", "тёмно-пурпурный"]),
    ("yellow", ["yellow", "жёлтый"]),
    ("darkYellow", ["dark yellow", "тёмно-жёлтый"]),
    ("gray", ["gray", "серый"]),
    ("darkGray", ["dark gray", "тёмно-серый"]),
    ("lightGray", ["light gray", "светло-серый"]),
];

/// What a word of saves is called.
pub fn called(choice: &str, locale: Locale) -> &str {
    let row = CALLED.iter().find(|(word, _)| *word == choice);
    match (row, locale) {
        (Some((_, [english, _])), Locale::English) => english,
        (Some((_, [_, russian])), Locale::Russian) => russian,
        (None, Locale::English | Locale::Russian) => choice,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocks::{Content, table};

    #[test]
    fn every_word_that_can_be_chosen_is_called_something_and_no_other_one() {
        let chosen = |content: &Content| -> &'static [&'static str] {
            match content {
                Content::Choice(words) | Content::Port(words) => words,
                Content::Flag => &["true", "false"],
                Content::Expression(_)
                | Content::Evaluated
                | Content::Raw
                | Content::Variable
                | Content::Ports
                | Content::Number => &[],
            }
        };
        let properties = table().flat_map(|row| row.properties);
        let all: Vec<&str> = properties
            .flat_map(|one| chosen(&one.content).iter().copied())
            .collect();
        for word in &all {
            let is_plain = ["Enter", "Esc"].contains(word)
                || word.parse::<u32>().is_ok()
                || word.len() == 2 && word.ends_with(|c: char| c.is_ascii_digit());
            let has_row = CALLED.iter().any(|(row, _)| row == word);
            assert!(is_plain != has_row, "{word}");
        }
        for (word, _) in CALLED {
            assert!(all.contains(word), "{word}");
        }
        assert_eq!(called("notLess", Locale::English), "not less");
        assert_eq!(called("A1", Locale::Russian), "A1");
    }
}
