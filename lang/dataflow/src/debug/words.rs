//! What a debugger of data flow cannot do, in words.
//!
//! Owns the texts in both languages.

use lang_text::problem::Words;

pub(super) fn no_threads() -> Words {
    Words::new(
        "a data-flow program has no threads: it stops and steps as a whole",
        "в потоковой программе нет задач: она останавливается и шагает целиком",
    )
}

pub(super) fn errors_end() -> Words {
    Words::new(
        "an error ends a data-flow program: stop before the block that it names, with a condition on data",
        "ошибка завершает потоковую программу: остановитесь перед названным блоком, с условием на data",
    )
}
