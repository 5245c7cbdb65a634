//! What is said of requests that cannot be, in English and Russian.

use lang_text::problem::Words;

/// An option that there is not.
pub(crate) fn no_option(name: &str) -> Words {
    Words::new(
        format!("there is no option '{name}'"),
        format!("параметра '{name}' нет"),
    )
}

/// What an option has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wanted {
    /// Yes or no.
    Flag,
    /// A text.
    Text,
    /// Several texts.
    Texts,
    /// A number from the first to the second one.
    Number(f64, f64),
    /// A language of messages.
    Locale,
}

/// An option with a value of another kind.
pub(crate) fn wrong_option(name: &str, wanted: Wanted) -> Words {
    let (english, russian) = match wanted {
        Wanted::Flag => ("true or false".to_owned(), "true или false".to_owned()),
        Wanted::Text => ("a text".to_owned(), "текст".to_owned()),
        Wanted::Texts => ("a list of texts".to_owned(), "список текстов".to_owned()),
        Wanted::Number(least, most) => (
            format!("a number from {least} to {most}"),
            format!("число от {least} до {most}"),
        ),
        Wanted::Locale => ("'en' or 'ru'".to_owned(), "'en' или 'ru'".to_owned()),
    };
    Words::new(
        format!("the option '{name}' is {english}"),
        format!("параметр '{name}' - {russian}"),
    )
}

/// A line of what a person does that means nothing.
pub(crate) fn wrong_gamepad(why: &str) -> Words {
    Words::new(
        format!("the option 'gamepad': {why}"),
        format!("параметр 'gamepad': {why}"),
    )
}

/// Options that are no object.
pub(crate) fn no_options() -> Words {
    Words::new(
        "options are an object with their names",
        "параметры - это объект с их именами",
    )
}

/// Something that is too long.
pub(crate) fn too_long(what: &str, bytes: usize, most: usize) -> Words {
    Words::new(
        format!("{what} has {bytes} bytes, and {most} are allowed"),
        format!("{what}: байт {bytes}, а разрешено {most}"),
    )
}

/// Something of another kind than it has to be.
pub(crate) fn wrong_kind(what: &str, wanted: &str) -> Words {
    Words::new(
        format!("{what} is no {wanted}"),
        format!("{what}: нужен {wanted}"),
    )
}

/// A diagram that the project has not.
pub(crate) fn no_diagram(name: &str, near: &Words) -> Words {
    Words::new(
        format!(
            "there is no diagram '{name}' in this project{}",
            near.english
        ),
        format!("в проекте нет диаграммы '{name}'{}", near.russian),
    )
}

/// A project without any.
pub(crate) fn no_diagrams() -> Words {
    Words::new(
        "there is no diagram in this project",
        "в проекте нет диаграмм",
    )
}

/// A file with a world where a program should be.
pub(crate) fn is_world() -> Words {
    Words::new(
        "this is a world, and a program is needed: a diagram (.qrs) or a data-flow program as text (.flow)",
        "это мир, а нужна программа: диаграмма (.qrs) или потоковая программа в виде текста (.flow)",
    )
}

/// A language in which a data-flow program cannot be written.
pub(crate) fn no_converter(language: &str) -> Words {
    Words::new(
        format!("a data-flow program is written in lua or c, not in {language}"),
        format!("потоковая программа записывается на lua или c, а не на {language}"),
    )
}

/// Jumps in a language that has none.
pub(crate) fn no_goto(language: &str) -> Words {
    Words::new(
        format!("{language} has no goto"),
        format!("в языке {language} нет goto"),
    )
}

/// A run without a debugger.
pub(crate) fn no_debugger() -> Words {
    Words::new(
        "this run has no debugger: begin it with the option 'debug'",
        "у этого запуска нет отладчика: начните его с параметром 'debug'",
    )
}

/// A language of drawings that there is not.
pub(crate) fn no_language() -> Words {
    Words::new(
        "the option 'language' is 'diagram' or 'dataflow'",
        "параметр 'language' - 'diagram' или 'dataflow'",
    )
}

/// The text of a program that has none.
pub(crate) fn no_source() -> Words {
    Words::new(
        "only a program of data flow has a textual form; take a language to generate",
        "текстовая форма есть только у потоковой программы; выберите язык",
    )
}

/// A kit that there is not.
pub(crate) fn no_kit() -> Words {
    Words::new(
        "the option 'kit' is 'trikV62Kit' or 'trikV6Kit'",
        "параметр 'kit' - 'trikV62Kit' или 'trikV6Kit'",
    )
}

/// A change that is none, by the field that is wrong.
pub(crate) fn wrong_change(field: &str) -> Words {
    match field {
        "" => Words::new(
            "a change is an object with its name in 'do'",
            "изменение - это объект с именем в поле 'do'",
        ),
        field => Words::new(
            format!("the field '{field}' of the change is missing, strange, or of another kind"),
            format!("поля '{field}' нет в изменении, или оно лишнее или другого вида"),
        ),
    }
}

/// A new version of a program that has ended.
pub(crate) fn run_is_over() -> Words {
    Words::new("the run is over", "запуск закончен")
}

/// A new version in another language.
pub(crate) fn other_language() -> Words {
    Words::new(
        "a diagram cannot take the place of a program of data flow, nor the other way round",
        "диаграмма не может заменить потоковую программу, и наоборот",
    )
}

/// A program with text in none of the languages that have an engine in a browser.
pub(crate) fn no_script() -> Words {
    Words::new(
        "programs with text are files NAME.py and NAME.js",
        "программы в виде текста - это файлы ИМЯ.py и ИМЯ.js",
    )
}
