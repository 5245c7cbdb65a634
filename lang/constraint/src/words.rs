//! What is said of constraints, in English and Russian.
//!
//! Owns the words. Where the original program has a text, the English one is that text.

use crate::limits;
use lang_text::problem::Words;

pub(super) fn accomplished(seconds: &str) -> Words {
    Words::new(
        format!("The task was accomplished in {seconds} sec!"),
        format!("Задание выполнено за {seconds} с!"),
    )
}

pub(super) fn unfinished() -> Words {
    Words::new(
        "Program has finished, but the task is not accomplished.",
        "Программа закончилась, но задание не выполнено.",
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
        format!("Ошибка в проверке: {}", what.russian),
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
        format!("Нет такой зоны: {name}"),
    )
}

pub(super) fn not_a_region(name: &str) -> Words {
    Words::new(
        format!("{name} is not a region"),
        format!("{name} - не зона"),
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
        format!("Неизвестен тип объекта \"{object}\""),
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
        format!("У объекта {type_name} нет свойства {property}"),
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
    Words::new(
        format!(
            "more than {most} messages: the rest is left out, look for an event without dropsOnFire"
        ),
        format!("больше {most} сообщений: остальные опущены, ищите событие без dropsOnFire"),
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
        "Должно быть ограничение времени \"timelimit\".",
    )
}

pub(super) fn two_time_limits() -> Words {
    Words::new(
        "There must be only one \"timelimit\" tag.",
        "Тег \"timelimit\" должен быть только один.",
    )
}

pub(super) fn unknown_tag(tag: &str) -> Words {
    Words::new(
        format!("Unknown tag \"{tag}\"."),
        format!("Неизвестный тег \"{tag}\"."),
    )
}

pub(super) fn unknown_value(tag: &str) -> Words {
    Words::new(
        format!("Unknown value \"{tag}\"."),
        format!("Неизвестное значение \"{tag}\"."),
    )
}

pub(super) fn children(tag: &str, count: usize, has_comment: bool, has_text: bool) -> Words {
    also(
        has_comment,
        has_text,
        format!("{tag} tag must have exactly {count} child tag(s)"),
        format!("В теге {tag} должно быть ровно вложенных тегов: {count}"),
    )
}

pub(super) fn more_children(tag: &str, count: usize) -> Words {
    Words::new(
        format!("{tag} tag must have at least {count} child tag(s)"),
        format!("В теге {tag} должно быть вложенных тегов не меньше: {count}"),
    )
}

pub(super) fn stray(tag: &str) -> Words {
    Words::new(
        format!("text stands in the tag {tag}: remove it, only tags mean something here"),
        format!("в теге {tag} стоит текст: уберите его, здесь значат что-то только теги"),
    )
}

fn also(has_comment: bool, has_text: bool, mut english: String, mut russian: String) -> Words {
    if has_comment {
        english.push_str("; a comment counts as one, put it outside of this tag");
        russian.push_str("; комментарий считается за тег, вынесите его наружу");
    }
    if has_text {
        english.push_str("; text counts as one, remove it");
        russian.push_str("; текст считается за тег, уберите его");
    }
    Words::new(english, russian)
}

pub(super) fn operands(tag: &str, count: usize, found: usize) -> Words {
    let attributes = if count == 1 { "_1" } else { "_1 and _2" };
    let russian = if count == 1 { "_1" } else { "_1 и _2" };
    Words::new(
        format!(
            "{tag} tag must have exactly {count} child tag(s), or attributes {attributes} instead of them; {found} found"
        ),
        format!(
            "В теге {tag} должно быть ровно вложенных тегов: {count}, или вместо них атрибуты {russian}; найдено {found}"
        ),
    )
}

pub(super) fn no_condition(found: &str) -> Words {
    Words::new(
        format!(
            "Event tag must have \"condition\" or \"conditions\" child tag. \"{found}\" found instead."
        ),
        format!(
            "В теге event должен быть тег \"condition\" или \"conditions\", а найден \"{found}\"."
        ),
    )
}

pub(super) fn no_trigger(found: &str) -> Words {
    Words::new(
        format!(
            "Event tag must have \"trigger\" or \"triggers\" child tag. \"{found}\" found instead."
        ),
        format!("В теге event должен быть тег \"trigger\" или \"triggers\", а найден \"{found}\"."),
    )
}

pub(super) fn no_attribute(tag: &str, attribute: &str) -> Words {
    Words::new(
        format!("\"{tag}\" tag must have \"{attribute}\" attribute."),
        format!("У тега \"{tag}\" должен быть атрибут \"{attribute}\"."),
    )
}

pub(super) fn empty_attribute(tag: &str, attribute: &str) -> Words {
    Words::new(
        format!("Attribute \"{attribute}\" of the tag \"{tag}\" must not be empty."),
        format!("Атрибут \"{attribute}\" тега \"{tag}\" не должен быть пустым."),
    )
}

pub(super) fn not_whole(value: &str) -> Words {
    Words::new(
        format!("Invalid integer value \"{value}\""),
        format!("Неверное целое число \"{value}\""),
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
        format!("Неверное логическое значение \"{value}\" (нужно \"true\" или \"false\")"),
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
        "Атрибут \"glue\" должен быть \"and\" или \"or\".",
    )
}

pub(super) fn two_returns() -> Words {
    Words::new(
        "There must be only one tag \"return\" in \"using\" expression.",
        "В выражении \"using\" должен быть только один тег \"return\".",
    )
}

pub(super) fn no_return() -> Words {
    Words::new(
        "There must be \"return\" tag in \"using\" expression.",
        "В выражении \"using\" должен быть тег \"return\".",
    )
}

pub(super) fn duplicate(id: &str) -> Words {
    Words::new(
        format!("Duplicate id: \"{id}\""),
        format!("Два события с одним id: \"{id}\""),
    )
}

pub(super) fn object_point(value: &str) -> Words {
    Words::new(
        format!(
            "objectPoint is \"{value}\", and is taken for \"center\": \"all\" and \"any\" are the others"
        ),
        format!("objectPoint=\"{value}\" понимается как \"center\": ещё бывают \"all\" и \"any\""),
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
    Words::new("Object path is empty!", "Путь к объекту пуст!")
}

pub(super) fn two_inits() -> Words {
    Words::new(
        "Duplicate id: \"\": there can be only one \"init\"",
        "Два события с одним id: \"\": тег \"init\" может быть только один",
    )
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

pub(super) fn nameless_template() -> Words {
    Words::new(
        "The <template> tag was provided, but the required \"name\" attribute was missing.",
        "У тега <template> нет обязательного атрибута \"name\".",
    )
}

pub(super) fn template_twice(name: &str) -> Words {
    Words::new(
        format!("Redefinition a template {name} that already exists"),
        format!("Шаблон {name} уже есть"),
    )
}

pub(super) fn not_a_template(tag: &str) -> Words {
    Words::new(
        format!(
            "the <templates> tag can only contain the <template> tag as a child tag, actual {tag}"
        ),
        format!("в теге <templates> могут быть только теги <template>, а найден {tag}"),
    )
}

pub(super) fn not_a_param(template: &str, tag: &str) -> Words {
    Words::new(
        format!(
            "the <params> tag can only contain the <param> tag as a child tag for template {template}, actual tag is <{tag}>"
        ),
        format!(
            "в теге <params> шаблона {template} могут быть только теги <param>, а найден <{tag}>"
        ),
    )
}

pub(super) fn nameless_param(template: &str) -> Words {
    Words::new(
        format!(
            "The <param> tag of template {template} was provided, but the required \"name\" attribute was missing."
        ),
        format!("У тега <param> шаблона {template} нет обязательного атрибута \"name\"."),
    )
}

pub(super) fn no_content(template: &str) -> Words {
    Words::new(
        format!(
            "The <template> of template {template} tag was provided, but the required child tag <content> was missing"
        ),
        format!("В шаблоне {template} нет обязательного тега <content>"),
    )
}

pub(super) fn undeclared(template: &str, param: &str) -> Words {
    Words::new(
        format!(
            "When defining the template {template}, the syntax #{{{param}}} was used for an undeclared parameter {param}."
        ),
        format!("В шаблоне {template} стоит #{{{param}}}, а параметр {param} не описан."),
    )
}

pub(super) fn nameless_use() -> Words {
    Words::new(
        "The <use> tag must contain a \"template\" attribute",
        "У тега <use> должен быть атрибут \"template\"",
    )
}

pub(super) fn no_template(name: &str) -> Words {
    Words::new(
        format!(
            "The <use> tag contains a template={name} attribute that is not the name of a declared template"
        ),
        format!("В теге <use> указан template={name}, а такого шаблона нет"),
    )
}

pub(super) fn not_with() -> Words {
    Words::new(
        "The <use> tag can only contain a child tag <with>",
        "В теге <use> могут быть только теги <with>",
    )
}

pub(super) fn unknown_param(template: &str, param: &str) -> Words {
    Words::new(
        format!("The using an undeclared parameter {param} for template {template}"),
        format!("У шаблона {template} нет параметра {param}"),
    )
}

pub(super) fn missing_param(template: &str, param: &str) -> Words {
    Words::new(
        format!(
            "The parameter {param} of template {template} has no default value and was not explicitly specified by the user"
        ),
        format!("Параметр {param} шаблона {template} не задан, а значения по умолчанию у него нет"),
    )
}

pub(super) fn recursive(chain: &str) -> Words {
    Words::new(
        format!("Recursive template expansion detected: {chain}"),
        format!("Шаблон подставляет сам себя: {chain}"),
    )
}

pub(super) fn not_xml(template: &str, why: &Words) -> Words {
    Words::new(
        format!(
            "After substituting the parameters for the template {template}, it did not become a valid xml node: {}",
            why.english
        ),
        format!(
            "Шаблон {template} с подставленными параметрами перестал быть XML: {}",
            why.russian
        ),
    )
}

pub(super) fn chain(what: &Words, chain: &str) -> Words {
    Words::new(
        format!("{} Substitution chain: {chain}.", what.english),
        format!("{} Цепочка подстановок: {chain}.", what.russian),
    )
}
