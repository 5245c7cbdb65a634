//! What is said of files that are nothing that can be looked at, in English and Russian.

use lang_text::problem::Words;

/// A file in UTF-16.
pub fn utf_16() -> Words {
    Words::new(
        "this is a text in UTF-16; save it again in UTF-8",
        "это текст в UTF-16; сохраните его снова в UTF-8",
    )
}

/// A program in its textual form that is no text.
pub fn no_text(at: usize) -> Words {
    Words::new(
        format!("byte {at} is not UTF-8, so this is not a program as text"),
        format!("байт {at} не в UTF-8, так что это не программа в виде текста"),
    )
}

/// A byte of a world that is not UTF-8.
pub fn no_utf_8(at: usize) -> Words {
    Words::new(
        format!("byte {at} is not UTF-8; save the world as XML in UTF-8"),
        format!("байт {at} не из UTF-8; сохраните мир как XML в UTF-8"),
    )
}

/// A program where a diagram or a world should be.
pub fn is_program() -> Words {
    Words::new(
        "this is a program, and only diagrams (.qrs) and worlds (.xml) are looked at; 'trik check PROGRAM --field WORLD.xml' runs it",
        "это программа, а проверяются диаграммы (.qrs) и миры (.xml); её запускает 'trik check ПРОГРАММА --field МИР.xml'",
    )
}
