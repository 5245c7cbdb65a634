//! What can be wrong with a change of a drawing, in words.

use lang_text::problem::{Locale, Words};

/// The name of every link, as the editor gives it.
pub(super) const LINK_NAME: &str = "Link";

/// The name of a new main diagram, as the editor gives it.
pub(super) fn main_name(locale: Locale) -> &'static str {
    match locale {
        Locale::English => "Robot's Behaviour Diagram",
        Locale::Russian => "Диаграмма поведения робота",
    }
}

pub(super) fn no_block() -> Words {
    Words::new(
        "there is no such block in the project: was it removed meanwhile?",
        "такого блока в проекте нет: может быть, его уже удалили?",
    )
}

pub(super) fn no_link() -> Words {
    Words::new(
        "there is no such link in the project: was it removed meanwhile?",
        "такой связи в проекте нет: может быть, её уже удалили?",
    )
}

pub(super) fn no_diagram() -> Words {
    Words::new(
        "there is no such diagram in the project",
        "такой диаграммы в проекте нет",
    )
}

pub(super) fn other_diagram() -> Words {
    Words::new(
        "a link joins blocks of one diagram, and these are in two",
        "связь соединяет блоки одной диаграммы, а эти - в разных",
    )
}

pub(super) fn far_away() -> Words {
    Words::new(
        "a block cannot be put there: it is too far away, or no place",
        "туда нельзя поместить блок: это слишком далеко или не место",
    )
}

pub(super) fn no_name() -> Words {
    Words::new("a name is missing", "нужно имя")
}

pub(super) fn long_text(bytes: usize, most: usize) -> Words {
    Words::new(
        format!("the text has {bytes} bytes, and {most} are allowed"),
        format!("в тексте байт: {bytes}, а разрешено {most}"),
    )
}

pub(super) fn no_property(name: &str) -> Words {
    Words::new(
        format!("the block has no property '{name}' that can be written"),
        format!("у блока нет свойства '{name}', которое можно записать"),
    )
}

pub(super) fn no_parameters_here() -> Words {
    Words::new(
        "subprograms of this language have no parameters: tokens come in by their ports",
        "у подпрограмм этого языка нет параметров: данные приходят в них через порты",
    )
}

pub(super) fn no_ports() -> Words {
    Words::new(
        "blocks of this language have no ports",
        "у блоков этого языка нет портов",
    )
}

pub(super) fn which_port() -> Words {
    Words::new(
        "a link leads from an output to an input: say which ones",
        "связь идёт от выхода к входу: укажите, от какого к какому",
    )
}

pub(super) fn no_port() -> Words {
    Words::new("the block has no such port", "такого порта у блока нет")
}

pub(super) fn no_output() -> Words {
    Words::new(
        "a link begins at an output, and this is an input: draw it the other way round",
        "связь начинается у выхода, а это вход: нарисуйте её наоборот",
    )
}

pub(super) fn no_input() -> Words {
    Words::new(
        "a link ends at an input, and this is an output",
        "связь кончается у входа, а это выход",
    )
}

pub(super) fn no_parameters() -> Words {
    Words::new(
        "only a subprogram has parameters",
        "параметры есть только у подпрограммы",
    )
}

pub(super) fn no_type() -> Words {
    Words::new(
        "the type of a parameter is int, float, bool or string",
        "тип параметра - int, float, bool или string",
    )
}

pub(super) fn same_parameter(name: &str) -> Words {
    Words::new(
        format!("two parameters are called '{name}'"),
        format!("два параметра называются '{name}'"),
    )
}

pub(super) fn last_main() -> Words {
    Words::new(
        "this is the only main diagram: a program begins there",
        "это единственная главная диаграмма: с неё начинается программа",
    )
}

pub(super) fn no_kind() -> Words {
    Words::new("there is no block of this type", "блока такого типа нет")
}

pub(super) fn no_end() -> Words {
    Words::new(
        "a link of what is added ends at none of its blocks",
        "связь в добавляемом не оканчивается ни у одного из его блоков",
    )
}

pub(super) fn too_many(most: usize) -> Words {
    Words::new(
        format!("a project has at most {most} blocks and links together"),
        format!("в проекте не больше {most} блоков и связей вместе"),
    )
}

pub(super) fn same_subprogram(name: &str) -> Words {
    Words::new(
        format!("another subprogram is called '{name}'"),
        format!("другая подпрограмма называется '{name}'"),
    )
}

pub(super) fn no_subprogram() -> Words {
    Words::new(
        "only a subprogram can be called",
        "вызвать можно только подпрограмму",
    )
}

pub(super) fn no_call() -> Words {
    Words::new(
        "this block calls no subprogram",
        "этот блок не вызывает подпрограмму",
    )
}
