//! What is said of programs that cannot be converters, in two languages.

use lang_text::problem::Words;

pub(super) fn not_in_a_converter(shown: &str) -> Words {
    Words::new(
        format!(
            "'{shown}' does something beside computing: a converter has sensors, functions, motors and servos alone"
        ),
        format!(
            "'{shown}' делает что-то кроме вычислений: в преобразователе могут быть только датчики, функции, моторы и сервомоторы"
        ),
    )
}

pub(super) fn no_chance() -> Words {
    Words::new(
        "random numbers have no place in a converter: the same readings give the same values",
        "случайным числам не место в преобразователе: одинаковые показания дают одинаковые значения",
    )
}

pub(super) fn no_keeping() -> Words {
    Words::new(
        "a wait that keeps what comes meanwhile has no place in a converter: switch 'keep' off",
        "ожиданию, которое хранит пришедшее, не место в преобразователе: выключите 'keep'",
    )
}

pub(super) fn no_texts() -> Words {
    Words::new(
        "texts have no place in a converter, which knows numbers, truths and lists of numbers",
        "строкам не место в преобразователе: он знает числа, логические значения и списки чисел",
    )
}

pub(super) fn no_nested_lists() -> Words {
    Words::new(
        "lists in lists have no place in a converter",
        "спискам внутри списков не место в преобразователе",
    )
}

pub(super) fn no_such_text() -> Words {
    Words::new(
        "this cannot be written in another language",
        "это нельзя записать на другом языке",
    )
}

pub(super) fn too_deep(limit: usize) -> Words {
    Words::new(
        format!("the expression is nested more than {limit} deep"),
        format!("вложенность выражения больше {limit}"),
    )
}

pub(super) fn list_too_long(limit: usize) -> Words {
    Words::new(
        format!("a list in this language has at most {limit} items"),
        format!("на этом языке в списке может быть не больше {limit} элементов"),
    )
}

pub(super) fn no_inputs() -> Words {
    Words::new(
        "the program reads no sensor, so there is nothing to convert",
        "программа не читает ни одного датчика, поэтому преобразовывать нечего",
    )
}

pub(super) fn no_outputs() -> Words {
    Words::new(
        "the program drives no motor and has no variable, so there is nothing to show",
        "программа не управляет моторами и не имеет переменных, поэтому показывать нечего",
    )
}

pub(super) fn too_large(limit: usize) -> Words {
    Words::new(
        format!("a converter has at most {limit} blocks, those of each call counted"),
        format!(
            "в преобразователе может быть не больше {limit} блоков, считая блоки каждого вызова"
        ),
    )
}
