//! What can be wrong with a program as text, in words.
//!
//! Owns the texts in both languages. Where something is wrong is known to who finds it.

use super::lexer::{Sign, Token, Wrong};
use crate::limits::REPEATED_MAX;
use lang_text::near::did_you_mean;
use lang_text::problem::Words;

/// The beginning of a text that may be very long, in one line.
fn short(text: &str) -> String {
    let mut letters = text.chars();
    let shown = letters.by_ref().take(REPEATED_MAX);
    let mut shown: String = shown
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if letters.next().is_some() {
        shown.push_str("...");
    }
    shown
}

/// A message that ends with the name that was perhaps meant.
fn with_near<'a>(words: Words, name: &str, known: impl IntoIterator<Item = &'a str>) -> Words {
    let near = did_you_mean(name, known);
    Words::new(words.english + &near.english, words.russian + &near.russian)
}

/// What a place in a line needs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// A word or a text.
    Name,
    /// The name of a block.
    Block,
    /// An id in quotes.
    Text,
    /// The value of a property.
    Value,
    /// A coordinate.
    Coordinate,
    /// A whole number.
    Whole,
    /// A label, or `nowhere`.
    End,
    /// The name or number of a port.
    Port,
    /// This sign.
    Sign(&'static str),
    /// Another property, or the end of the list.
    Comma,
    /// The word `nothing`.
    Nothing,
}

impl Wanted {
    fn words(self) -> (String, String) {
        let (english, russian) = match self {
            Self::Name => ("a name", "имя"),
            Self::Block => ("the name of a block", "название блока"),
            Self::Text => ("a text in quotes", "текст в кавычках"),
            Self::Value => (
                "a value (a word, a number, or a text in quotes or backticks)",
                "значение (слово, число или текст в кавычках)",
            ),
            Self::Coordinate => ("a number", "число"),
            Self::Whole => ("a whole number", "целое число"),
            Self::End => ("a label or nowhere", "метка или nowhere"),
            Self::Port => ("the name or the number of a port", "имя или номер порта"),
            Self::Sign(sign) => return (format!("'{sign}'"), format!("'{sign}'")),
            Self::Comma => ("',' or ')'", "',' или ')'"),
            Self::Nothing => ("'nothing'", "'nothing'"),
        };
        (english.to_owned(), russian.to_owned())
    }
}

fn found(token: &Token<'_>) -> (String, String) {
    let (english, russian) = match token {
        Token::Word(text) | Token::Number(text) => {
            let text = format!("'{}'", short(text));
            return (text.clone(), text);
        }
        Token::Sign(sign) => {
            let text = format!("'{}'", sign.text());
            return (text.clone(), text);
        }
        Token::Text(_) | Token::Wrong(_) => ("a text", "текст"),
        Token::Line => ("the end of the line", "конец строки"),
        Token::End => ("the end of the text", "конец текста"),
    };
    (english.to_owned(), russian.to_owned())
}

pub(super) fn expected(wanted: Wanted, token: &Token<'_>) -> Words {
    let (wanted, found) = (wanted.words(), found(token));
    Words::new(
        format!("{} is expected here, not {}", wanted.0, found.0),
        format!("здесь ожидается {}, а не {}", wanted.1, found.1),
    )
}

pub(super) fn wrong(wrong: Wrong) -> Words {
    match wrong {
        // Comments of other languages begin with these.
        Wrong::Stray('/' | '-') => Words::new(
            "this sign means nothing here: a comment begins with #, an edge is ->, and a value with signs stands in quotes \
             or backticks",
            "этот знак здесь ничего не значит: комментарий начинается с #, связь — это ->, а значение со знаками пишут в \
             кавычках",
        ),
        Wrong::Stray(sign) => {
            let sign = sign.escape_debug();
            Words::new(
                format!(
                    "'{sign}' means nothing here; a value with it stands in quotes or backticks"
                ),
                format!("'{sign}' здесь ничего не значит; значение с ним пишут в кавычках"),
            )
        }
        Wrong::Quotes => Words::new(
            "this text has no closing quote in its line",
            "у этого текста нет закрывающей кавычки в той же строке",
        ),
        Wrong::Backticks => Words::new(
            "this text has no closing backtick",
            "у этого текста нет закрывающего обратного апострофа",
        ),
        Wrong::Escape => Words::new(
            r#"a backslash in quotes stands only in \" \\ \n \r \t and \u{HEX}"#,
            r#"обратная косая черта в кавычках бывает только в \" \\ \n \r \t и \u{HEX}"#,
        ),
    }
}

pub(super) fn no_line<'a>(token: &Token<'_>, known: impl IntoIterator<Item = &'a str>) -> Words {
    let found = found(token);
    let words = Words::new(
        format!(
            "a line begins with a label and ':' or '.', or with a word such as diagram, not with {}",
            found.0
        ),
        format!(
            "строка начинается с метки и ':' или '.', либо со слова, например diagram, а не с: {}",
            found.1
        ),
    );
    match token {
        Token::Word(word) => with_near(words, word, known),
        Token::Number(_)
        | Token::Text(_)
        | Token::Sign(_)
        | Token::Line
        | Token::End
        | Token::Wrong(_) => words,
    }
}

pub(super) fn long_label() -> Words {
    Words::new(
        "a label is one word of letters, digits and _, such as left_motor",
        "метка — одно слово из букв, цифр и _, например left_motor",
    )
}

pub(super) fn surplus(token: &Token<'_>, known: &[&'static str]) -> Words {
    if *token == Token::Sign(Sign::Arrow) {
        return Words::new(
            "an edge has two ends: what goes on from here is a line of its own",
            "у связи два конца: продолжение пишут отдельной строкой",
        );
    }
    let found = found(token);
    let all = known.join(", ");
    let words = Words::new(
        format!("the line may go on with {all}, not with {}", found.0),
        format!("дальше в строке могут быть: {all}, но не {}", found.1),
    );
    match token {
        Token::Word(word) => with_near(words, word, known.iter().copied()),
        Token::Number(_)
        | Token::Text(_)
        | Token::Sign(_)
        | Token::Line
        | Token::End
        | Token::Wrong(_) => words,
    }
}

pub(super) fn nothing_more(token: &Token<'_>) -> Words {
    let found = found(token);
    Words::new(
        format!("the line ends before {}", found.0),
        format!("строка кончается раньше, здесь лишнее: {}", found.1),
    )
}

pub(super) fn too_long(limit: usize) -> Words {
    Words::new(
        format!("the text is too long: at most {limit} bytes"),
        format!("текст слишком длинный: не больше {limit} байтов"),
    )
}

pub(super) fn too_many_blocks(limit: usize) -> Words {
    Words::new(
        format!("too many blocks: at most {limit}"),
        format!("слишком много блоков: не больше {limit}"),
    )
}

pub(super) fn too_many_edges(limit: usize) -> Words {
    Words::new(
        format!("too many edges: at most {limit}"),
        format!("слишком много связей: не больше {limit}"),
    )
}

pub(super) fn too_many_properties(limit: usize) -> Words {
    Words::new(
        format!("too many properties and keys: at most {limit}"),
        format!("слишком много свойств и ключей: не больше {limit}"),
    )
}

pub(super) fn too_many_diagrams(limit: usize) -> Words {
    Words::new(
        format!("too many diagrams: at most {limit}"),
        format!("слишком много диаграмм: не больше {limit}"),
    )
}

pub(super) fn no_diagram() -> Words {
    Words::new(
        "blocks and edges stand below a line such as diagram \"Name\"",
        "блоки и связи пишут после строки вида diagram \"Имя\"",
    )
}

pub(super) fn twice(word: &str) -> Words {
    Words::new(
        format!("'{word}' is there twice"),
        format!("'{word}' здесь во второй раз"),
    )
}

pub(super) fn key_twice(key: &str) -> Words {
    let key = short(key);
    Words::new(
        format!("the key '{key}' has a value already"),
        format!("у ключа '{key}' уже есть значение"),
    )
}

pub(super) fn run_twice() -> Words {
    Words::new(
        "only one diagram is run, and another line chose already",
        "выполняется только одна диаграмма, и её уже выбрала другая строка",
    )
}

pub(super) fn unknown_block<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Words {
    let shown = short(name);
    let words = Words::new(
        format!("there is no block '{shown}'"),
        format!("блока '{shown}' нет"),
    );
    let known: Vec<_> = known.collect();
    // One of the words of a longer name.
    let has_word = |one: &&&str| {
        one.contains(' ') && one.split(' ').any(|word| word.eq_ignore_ascii_case(name))
    };
    match known.iter().find(has_word) {
        Some(one) => Words::new(
            words.english + &format!("; did you mean \"{one}\"?"),
            words.russian + &format!("; может быть, \"{one}\"?"),
        ),
        None => with_near(words, name, known.iter().copied()),
    }
}

pub(super) fn needs_quotes(name: &str) -> Words {
    Words::new(
        format!("a name of several words stands in quotes: \"{name}\""),
        format!("название из нескольких слов пишут в кавычках: \"{name}\""),
    )
}

pub(super) fn unknown_property(block: &str, name: &str, known: &[&'static str]) -> Words {
    let shown = short(name);
    let (english, russian) = match known {
        [] => ("no properties".to_owned(), "свойств нет".to_owned()),
        _ => (known.join(", "), format!("есть {}", known.join(", "))),
    };
    let words = Words::new(
        format!("'{block}' has no property '{shown}', it has {english}"),
        format!("у блока '{block}' нет свойства '{shown}', {russian}"),
    );
    with_near(words, name, known.iter().copied())
}

pub(super) fn shown_property(shown: &str, name: &str) -> Words {
    Words::new(
        format!("the property that the editor shows as '{shown}' is called '{name}' here"),
        format!("свойство, которое редактор показывает как '{shown}', здесь называется '{name}'"),
    )
}

pub(super) fn property_twice(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!("the property '{name}' has a value already"),
        format!("у свойства '{name}' уже есть значение"),
    )
}

pub(super) fn no_port(label: &str) -> Words {
    let label = short(label);
    Words::new(
        format!("an edge says its port: {label}.PORT"),
        format!("у связи указывают порт: {label}.PORT"),
    )
}

pub(super) fn unknown_port(block: &str, name: &str, ports: &[&'static str]) -> Words {
    let shown = short(name);
    let all = ports.join(", ");
    let words = Words::new(
        format!("'{block}' has no port '{shown}', it has {all}"),
        format!("у блока '{block}' нет порта '{shown}', есть {all}"),
    );
    with_near(words, name, ports.iter().copied())
}

pub(super) fn port_without_row(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!("ports of an unknown block have numbers only, not '{name}'"),
        format!("у неизвестного блока порты только по номерам, а не '{name}'"),
    )
}

pub(super) fn unknown_label<'a>(label: &str, known: impl IntoIterator<Item = &'a str>) -> Words {
    let shown = short(label);
    let words = Words::new(
        format!("no block of this diagram has the label '{shown}'"),
        format!("на этой диаграмме нет блока с меткой '{shown}'"),
    );
    with_near(words, label, known)
}

pub(super) fn label_twice(label: &str) -> Words {
    let label = short(label);
    Words::new(
        format!("another block of this diagram has the label '{label}' already"),
        format!("метка '{label}' на этой диаграмме уже занята"),
    )
}

pub(super) fn unknown_diagram<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Words {
    let shown = short(name);
    let words = Words::new(
        format!("there is no diagram '{shown}'"),
        format!("диаграммы '{shown}' нет"),
    );
    with_near(words, name, known)
}

pub(super) fn several_diagrams(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!("several diagrams are called '{name}'; say which by: of id \"...\""),
        format!("диаграмм '{name}' несколько; укажите нужную: of id \"...\""),
    )
}

pub(super) fn bad_number(text: &str) -> Words {
    let text = short(text);
    Words::new(
        format!("the number {text} is not whole, or too large"),
        format!("число {text} не целое или слишком большое"),
    )
}

pub(super) fn far_number(text: &str) -> Words {
    let text = short(text);
    Words::new(
        format!("the number {text} is too large"),
        format!("число {text} слишком большое"),
    )
}

pub(super) fn bad_id(id: &str) -> Words {
    let id = short(id);
    Words::new(
        format!("'{id}' cannot be an id, as the name of a file it would leave the save"),
        format!(
            "'{id}' не может быть идентификатором: как имя файла он выйдет за пределы сохранения"
        ),
    )
}

pub(super) fn id_twice(id: &str) -> Words {
    let id = short(id);
    Words::new(
        format!("the id {id} is that of something else already; without one, a new id is made"),
        format!("идентификатор {id} уже занят; если его не указывать, будет создан новый"),
    )
}
