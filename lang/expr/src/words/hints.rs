//! What may be meant by what is wrong: a sign, a name, a value of another type.
//!
//! Owns the words of advice that needs more than the mistake itself. What is wrong is in `words`.

use super::{kinds_in_russian, short};
use crate::names::written;
use lang_text::problem::Words;

/// What a token that cannot stand in its place may be meant for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Meant {
    /// Nobody knows.
    Unknown,
    /// This sign, of which it is a part.
    Sign(&'static str),
    /// What blocks do, and words of the language elsewhere.
    Block,
}

/// Which types do not fit in an assignment, as far as they are known.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Clash {
    /// The variable that is assigned, or whose element is.
    pub name: String,
    /// Whether it is an element.
    pub is_element: bool,
    /// The types that it has.
    pub had: String,
    /// Those of the value.
    pub given: String,
}

/// The name that was meant.
pub(crate) fn did_you_mean(known: &str) -> Words {
    let known = short(written(known));
    Words::new(
        format!("Did you mean '{known}'?"),
        format!("Может быть, '{known}'?"),
    )
}

/// What a variable is and what it was given.
pub(crate) fn keeps_type(clash: &Clash) -> Words {
    let name = short(written(&clash.name));
    let (english, russian) = match clash.is_element {
        true => (
            format!("An element of '{name}'"),
            format!("Элемент '{name}'"),
        ),
        false => (format!("'{name}'"), format!("'{name}'")),
    };
    let Clash { had, given, .. } = clash;
    let (had_russian, given_russian) = (kinds_in_russian(had), kinds_in_russian(given));
    Words::new(
        format!(
            "{english} is of the type '{had}', and this gives it '{given}': a variable keeps its type until the program starts anew. Give it '{had}', or take another name."
        ),
        format!(
            "{russian} имеет тип «{had_russian}», а получает «{given_russian}»: вид переменной не меняется, пока программа не запущена заново. Дайте значение типа «{had_russian}» или возьмите другое имя."
        ),
    )
}

/// A name that no text has taught a type, and the one that was meant.
pub(crate) fn gives_no_value(name: &str, meant: Option<&str>) -> Words {
    let name = short(written(name));
    let meant = meant.map_or_else(|| Words::new("", ""), did_you_mean);
    let space = if meant.english.is_empty() { "" } else { " " };
    Words::new(
        format!(
            "Nothing has given '{name}' a value.{space}{}",
            meant.english
        ),
        format!(
            "Переменной '{name}' нигде не присвоено значение.{space}{}",
            meant.russian
        ),
    )
}

/// What may be meant, after the name of the token.
pub(super) fn meant_in_russian(meant: Meant) -> String {
    match meant {
        Meant::Unknown => String::new(),
        Meant::Sign(sign) => format!(". Может быть, «{sign}»?"),
        Meant::Block => {
            ". Это слово зарезервировано и в выражениях не стоит: возьмите для него блок или другое имя."
                .into()
        }
    }
}
