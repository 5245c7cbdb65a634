//! What is said of constraints, in English and Russian.
//!
//! Owns the words. Where the original program has a text, the English one is that text.

use crate::limits;
use lang_text::problem::{Problem, Words};

pub(super) fn accomplished(seconds: &str) -> Words {
    Words::new(
        format!("The task was accomplished in {seconds} sec!"),
        format!("Задание выполнено за {seconds} сек!"),
    )
}

pub(super) fn unfinished() -> Words {
    Words::new(
        "Program has finished, but the task is not accomplished.",
        "Программа отработала, но задание не выполнено.",
    )
}

pub(super) fn too_long() -> Words {
    Words::new(
        "Program worked for too long time",
        "Программа работала слишком долго",
    )
}

pub(super) fn in_checker(what: &Words) -> Words {
    Words::new(
        format!("Error in checker: {}", what.english),
        format!("Ошибка в проверяющей программе: {}", what.russian),
    )
}

pub(super) fn no_object(name: &str) -> Words {
    Words::new(
        format!("No such object: {name}"),
        format!("Нет такого объекта: {name}"),
    )
}

pub(super) fn no_region(name: &str) -> Words {
    Words::new(
        format!("No such region: {name}"),
        format!("Нет такого региона: {name}"),
    )
}

pub(super) fn not_a_region(name: &str) -> Words {
    Words::new(
        format!("{name} is not a region"),
        format!("{name} - не регион"),
    )
}

pub(super) fn not_matched(name: &str) -> Words {
    Words::new(
        format!("{name} has incorrect type for matching it with region"),
        format!("{name} не имеет места на поле, и о зоне его спросить нельзя"),
    )
}

pub(super) fn no_event(id: &str) -> Words {
    Words::new(
        format!("No such event: {id}"),
        format!("Нет такого события: {id}"),
    )
}

pub(super) fn no_property(object: &str, property: &str) -> Words {
    Words::new(
        format!("Object \"{object}\" has no property \"{property}\""),
        format!("У объекта \"{object}\" нет свойства \"{property}\""),
    )
}

pub(super) fn no_type(object: &str) -> Words {
    Words::new(
        format!("Unknown type of object \"{object}\""),
        format!("Неизвестный тип объекта \"{object}\""),
    )
}

pub(super) fn no_name(name: &str) -> Words {
    Words::new(
        format!("The name {name} is not a valid variable name or property chain for an object"),
        format!("{name} - не имя переменной и не цепочка свойств объекта"),
    )
}

pub(super) fn no_state(type_name: &str) -> Words {
    Words::new(
        format!("Invalid <setState> object type {type_name}"),
        format!("Неверный тип объекта в <setState>: {type_name}"),
    )
}

pub(super) fn no_settable(type_name: &str, property: &str) -> Words {
    Words::new(
        format!("Object {type_name} has no property {property}"),
        format!("Объект {type_name} не имеет свойства {property}"),
    )
}

pub(super) fn message_too_long() -> Words {
    let most = limits::CONSTRAINT_MESSAGE_BYTES;
    Words::new(
        format!("a message is longer than {most} bytes with its places filled"),
        format!("сообщение с подставленными значениями длиннее {most} байт"),
    )
}

pub(super) fn too_many_messages() -> Words {
    let most = limits::CONSTRAINT_ENTRIES_MAX;
    let mib = limits::CONSTRAINT_ENTRIES_BYTES >> 20;
    Words::new(
        format!(
            "more than {most} messages, or {mib} MiB of them: the rest is left out, look for an event without dropsOnFire"
        ),
        format!(
            "больше {most} сообщений или {mib} МиБ: остальные опущены, ищите событие без dropsOnFire"
        ),
    )
}

pub(super) fn not_constraints() -> Words {
    Words::new(
        "Root element must be \"constraints\" tag",
        "Корневым тегом должен быть \"constraints\"",
    )
}

pub(super) fn no_time_limit() -> Words {
    Words::new(
        "There must be a \"timelimit\" constraint.",
        "Должен иметься тэг \"timelimit\".",
    )
}

pub(super) fn two_time_limits() -> Words {
    Words::new(
        "There must be only one \"timelimit\" tag.",
        "Тэг \"timelimit\" может быть только один.",
    )
}

pub(super) fn unknown_tag(tag: &str) -> Words {
    Words::new(
        format!("Unknown tag \"{tag}\"."),
        format!("Неизвестный тэг \"{tag}\"."),
    )
}

pub(super) fn unknown_value(tag: &str) -> Words {
    Words::new(
        format!("Unknown value \"{tag}\"."),
        format!("Неизвестное значение \"{tag}\"."),
    )
}

pub(super) fn children(tag: &str, count: usize) -> Words {
    Words::new(
        format!("{tag} tag must have exactly {count} child tag(s)"),
        format!("У тэга \"{tag}\" должно быть ровно {count} дочерних(ий) тэг(а)"),
    )
}

pub(super) fn comment_counts(tag: &str) -> Words {
    Words::new(
        format!("a comment counts as a child of the tag {tag}: put it outside"),
        format!("комментарий считается за дочерний тег в теге {tag}: вынесите его наружу"),
    )
}

pub(super) fn more_children(tag: &str, count: usize) -> Words {
    Words::new(
        format!("{tag} tag must have at least {count} child tag(s)"),
        format!("У тэга \"{tag}\" должно быть как минимум {count} дочерних(ий) тэг(а)"),
    )
}

pub(super) fn stray(tag: &str) -> Words {
    Words::new(
        format!("text stands in the tag {tag}: remove it, only tags mean something here"),
        format!("в теге {tag} стоит текст: уберите его, здесь значат что-то только теги"),
    )
}

pub(super) fn operands(tag: &str, count: usize, found: usize) -> Words {
    Words::new(
        format!(
            "When using the extended form for the {tag} tag, the number of arguments starting with _ must be {count}, {found} was provided"
        ),
        format!(
            "При использовании расширенной формы для тега {tag} ожидаемое количество аргументов, начинающихся с _, \u{2014} {count}, было предоставлено {found}"
        ),
    )
}

pub(super) fn no_condition(found: &str) -> Words {
    Words::new(
        format!(
            "Event tag must have \"condition\" or \"conditions\" child tag. \"{found}\" found instead."
        ),
        format!(
            "Тег \"event\" должен иметь дочерний тэг \"condition\" или \"conditions\". Вместо этого найдено \"{found}\"."
        ),
    )
}

pub(super) fn no_trigger(found: &str) -> Words {
    Words::new(
        format!(
            "Event tag must have \"trigger\" or \"triggers\" child tag. \"{found}\" found instead."
        ),
        format!(
            "Тег \"event\" должен иметь дочерний тэг \"trigger\" или \"triggers\". Вместо этого найдено \"{found}\"."
        ),
    )
}

pub(super) fn no_attribute(tag: &str, attribute: &str) -> Words {
    Words::new(
        format!("\"{tag}\" tag must have \"{attribute}\" attribute."),
        format!("У тэга \"{tag}\" должен быть аттрибут \"{attribute}\"."),
    )
}

/// The words for the tag and the attribute stand in each other's place, as in the original; the place says which is which.
pub(super) fn empty_attribute(tag: &str, attribute: &str) -> Words {
    Words::new(
        format!("Attribute \"{tag}\" of the tag \"{attribute}\" must not be empty."),
        format!("Атрибут \"{tag}\" тэга \"{attribute}\" не может быть пустым."),
    )
}

pub(super) fn not_whole(value: &str) -> Words {
    Words::new(
        format!("Invalid integer value \"{value}\""),
        format!("\"{value}\" - не целое число"),
    )
}

pub(super) fn not_a_number(value: &str) -> Words {
    Words::new(
        format!("Invalid floating point value \"{value}\""),
        format!("Неверное дробное число \"{value}\""),
    )
}

pub(super) fn not_yes_or_no(value: &str) -> Words {
    Words::new(
        format!("Invalid boolean value \"{value}\" (expected \"true\" or \"false\")"),
        format!("\"{value}\" - не логическое значение (ожидалось \"true\" или \"false\")"),
    )
}

pub(super) fn negative(value: i32) -> Words {
    Words::new(
        format!("the time limit is {value} ms: it must not be below 0"),
        format!("ограничение времени {value} мс: оно не должно быть меньше 0"),
    )
}

pub(super) fn glue() -> Words {
    Words::new(
        "\"Glue\" attribute must have value \"and\" or \"or\".",
        "Аттрибут \"glue\" должен иметь значение \"and\" или \"or\".",
    )
}

pub(super) fn two_returns() -> Words {
    Words::new(
        "There must be only one tag \"return\" in \"using\" expression.",
        "Тэг \"return\" может быть только один.",
    )
}

pub(super) fn no_return() -> Words {
    Words::new(
        "There must be \"return\" tag in \"using\" expression.",
        "В выражении \"using\" должен иметься тэг \"return\".",
    )
}

pub(super) fn duplicate(id: &str) -> Words {
    Words::new(
        format!("Duplicate id: \"{id}\""),
        format!("Переобъявление события \"{id}\""),
    )
}

pub(super) fn object_point(value: &str) -> Words {
    Words::new(
        format!(
            "objectPoint=\"{value}\" is unknown, and \"center\" is taken; write \"center\", \"all\" or \"any\""
        ),
        format!(
            "objectPoint=\"{value}\" неизвестно, и берётся \"center\"; напишите \"center\", \"all\" или \"any\""
        ),
    )
}

pub(super) fn one_condition() -> Words {
    Words::new(
        "there is one condition in \"conditions\": write \"condition\", or was something forgotten?",
        "в \"conditions\" одно условие: напишите \"condition\", или что-то забыто?",
    )
}

pub(super) fn strange_attribute(tag: &str, attribute: &str, known: Option<&str>) -> Words {
    let (english, russian) = match known {
        Some(known) => (
            format!("did you mean \"{known}\"?"),
            format!("может быть, \"{known}\"?"),
        ),
        None => (
            "it means nothing".to_owned(),
            "он не значит ничего".to_owned(),
        ),
    };
    Words::new(
        format!("the tag \"{tag}\" knows no attribute \"{attribute}\": {english}"),
        format!("тег \"{tag}\" не знает атрибута \"{attribute}\": {russian}"),
    )
}

pub(super) fn check_once(value: &str) -> Words {
    Words::new(
        format!("checkOnce is \"{value}\", and is taken for \"false\""),
        format!("checkOnce=\"{value}\" понимается как \"false\""),
    )
}

pub(super) fn something_in(tag: &str) -> Words {
    Words::new(
        format!("what stands in the tag \"{tag}\" means nothing: it has only attributes"),
        format!("то, что стоит внутри тега \"{tag}\", ничего не значит: у него только атрибуты"),
    )
}

pub(super) fn empty_path() -> Words {
    Words::new("Object path is empty!", "Путь до объекта пуст!")
}

pub(super) fn two_inits() -> Words {
    Words::new("Duplicate id: \"\"", "Переобъявление события \"\"")
}

pub(super) fn too_deep() -> Words {
    let most = limits::CONSTRAINT_DEPTH_MAX;
    Words::new(
        format!("tags nest deeper than {most}"),
        format!("теги вложены глубже {most}"),
    )
}

pub(super) fn too_many_tags() -> Words {
    let most = limits::CONSTRAINT_TAGS_MAX;
    Words::new(
        format!("more than {most} tags, with templates put in"),
        format!("больше {most} тегов, считая подставленные шаблоны"),
    )
}

pub(super) fn too_much_text() -> Words {
    let most = limits::TEMPLATE_TEXT_MAX;
    Words::new(
        format!("templates have grown to more than {most} bytes"),
        format!("шаблоны разрослись больше чем на {most} байт"),
    )
}

pub(super) fn too_many_events() -> Words {
    let most = limits::CONSTRAINT_EVENTS_MAX;
    Words::new(
        format!("more than {most} events and constraints"),
        format!("больше {most} событий и ограничений"),
    )
}

/// Something is wrong with rules.
pub(super) fn in_rules(words: &Words) -> Words {
    Words::new(
        format!("Error while parsing constraints: {}", words.english),
        format!("Ошибка чтения ограничений: {}", words.russian),
    )
}

/// Something is wrong with the use of a template.
pub(super) fn in_substitution(words: &Words) -> Words {
    Words::new(
        format!("Error while template substitution: {}", words.english),
        format!("Ошибка при подстановке шаблона: {}", words.russian),
    )
}

/// Something is wrong with the declaration of a template.
pub(super) fn in_template(words: &Words) -> Words {
    Words::new(
        format!("Error while parsing template: {}", words.english),
        format!("Ошибка при разборе шаблона: {}", words.russian),
    )
}

pub(super) fn line(words: &Words, line: usize) -> Words {
    Words::new(
        format!("{} line {line}", words.english),
        format!("{} строка {line}", words.russian),
    )
}

pub(super) fn line_of_template(words: &Words, line: usize, name: &str) -> Words {
    Words::new(
        format!("{} line {line} template {name}", words.english),
        format!("{} строка {line} шаблон {name}", words.russian),
    )
}

pub(super) fn in_constraints_line(words: &Words, line: usize) -> Words {
    Words::new(
        format!(
            "{} line {line} relative the beginning of the &lt;constraints&gt; tag",
            words.english
        ),
        format!(
            "{} строка {line} относительно начала тега &lt;constraints&gt;",
            words.russian
        ),
    )
}

pub(super) fn in_body_line(words: &Words, line: usize, name: &str) -> Words {
    Words::new(
        format!(
            "{} line {line} relative to the beginning of the {name} template body",
            words.english
        ),
        format!(
            "{} строка {line} относительно начала тела шаблона {name}",
            words.russian
        ),
    )
}

/// A text that is no XML, in the words of the original where it ends before its tags do.
pub fn unread(mut problem: Problem) -> Problem {
    if lang_text::xml::is_cut_short(&problem)
        && let Some(at) = problem.place.position.take()
    {
        let words = format!("{}:{}: unexpected end of file", at.line, at.column);
        problem.words = Words::new(words.clone(), words);
    }
    problem
}

pub(super) fn nameless_template() -> Words {
    Words::new(
        "The &lt;template&gt; tag was provided, but the required \"name\" attribute was missing.",
        "У тега &lt;template&gt; нет обязательного атрибута \"name\".",
    )
}

pub(super) fn template_twice(name: &str) -> Words {
    Words::new(
        format!("Redefinition a template {name} that already exists"),
        format!("Переопределение уже существующего шаблона {name}"),
    )
}

pub(super) fn not_a_template(tag: &str) -> Words {
    Words::new(
        format!(
            "the &lt;templates&gt; tag can only contain the &lt;template&gt; tag as a child tag, actual {tag}"
        ),
        format!("в теге <templates> могут быть только теги <template>, а найден {tag}"),
    )
}

pub(super) fn not_a_param(template: &str, tag: &str) -> Words {
    Words::new(
        format!(
            "the &lt;params&gt; tag can only contain the &lt;param&gt; tag as a child tag for template {template}, actual tag is &lt;{tag}&gt;"
        ),
        format!(
            "в теге <params> шаблона {template} могут быть только теги <param>, а найден <{tag}>"
        ),
    )
}

pub(super) fn nameless_param(template: &str) -> Words {
    Words::new(
        format!(
            "The &lt;param&gt; tag of template {template} was provided, but the required \"name\" attribute was missing."
        ),
        format!("У тега <param> шаблона {template} нет обязательного атрибута \"name\"."),
    )
}

pub(super) fn no_content(template: &str) -> Words {
    Words::new(
        format!(
            "The &lt;template&gt; of template {template} tag was provided, but the required child tag &lt;content&gt; was missing"
        ),
        format!("В шаблоне {template} нет обязательного тега <content>"),
    )
}

pub(super) fn undeclared(template: &str, param: &str, offset: usize) -> Words {
    Words::new(
        format!(
            "When defining the template {template}, the syntax #{{{param}}} was used to substitute an offset {offset} for an undeclared parameter {param}."
        ),
        format!(
            "При определении шаблона {template} использован синтаксис #{{{param}}} для подстановки смещения {offset} для необъявленного параметра {param}."
        ),
    )
}

pub(super) fn no_text(template: &str) -> Words {
    Words::new(
        format!(
            "Currently, this method of setting &lt;content&gt; tag for the template {template} is not supported."
        ),
        format!(
            "В настоящее время данный способ задания тега &lt;content&gt; для шаблона {template} не поддерживается."
        ),
    )
}

pub(super) fn nameless_use() -> Words {
    Words::new(
        "The &lt;use&gt; tag must contain a \"template\" attribute",
        "У тега <use> должен быть атрибут \"template\"",
    )
}

pub(super) fn no_template(name: &str) -> Words {
    Words::new(
        format!(
            "The &lt;use&gt; tag contains a template={name} attribute that is not the name of a declared template"
        ),
        format!(
            "Тег &lt;use&gt; содержит атрибут template={name}, который не соответствует имени объявленного шаблона"
        ),
    )
}

pub(super) fn not_with() -> Words {
    Words::new(
        "The &lt;use&gt; tag can only contain a child tag &lt;with&gt;",
        "Тег &lt;use&gt; может содержать только дочерний тег &lt;with&gt;",
    )
}

pub(super) fn unknown_param(template: &str, param: &str) -> Words {
    Words::new(
        format!("The using an undeclared parameter {param} for template {template}"),
        format!("Использование необъявленного параметра {param} в шаблоне {template}"),
    )
}

pub(super) fn missing_param(template: &str, param: &str) -> Words {
    Words::new(
        format!(
            "The parameter {param} of template {template} has no default value and was not explicitly specified by the user"
        ),
        format!(
            "Параметр {param} шаблона {template} не имеет значения по умолчанию и не был задан пользователем явно"
        ),
    )
}

pub(super) fn recursive(chain: &str) -> Words {
    Words::new(
        format!("Recursive template expansion detected: {chain}"),
        format!("Обнаружено рекурсивное раскрытие шаблона: {chain}"),
    )
}

pub(super) fn not_xml(template: &str) -> Words {
    Words::new(
        format!(
            "After substituting the parameters for the template {template}, it did not become a valid xml node error occurred while parsing element"
        ),
        format!(
            "После подстановки параметров в шаблон {template} он не сформировал допустимый XML-узел error occurred while parsing element"
        ),
    )
}

pub(super) fn chain(chain: &str) -> Words {
    Words::new(
        format!("Substitution chain: {chain}."),
        format!("Цепочка подстановки: {chain}."),
    )
}
