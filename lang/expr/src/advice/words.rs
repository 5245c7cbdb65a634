//! Words of advice: which name was meant, which type a variable keeps.
//!
//! Owns advice that needs more than the fault itself. What is wrong is in the words of the crate.

use crate::names::written;
use crate::words::{Clash, kinds_in_russian, short};
use lang_text::problem::Words;

/// The name that was meant.
pub(super) fn did_you_mean(known: &str) -> Words {
    let known = short(written(known));
    Words::new(
        format!("Did you mean '{known}'?"),
        format!("Может быть, '{known}'?"),
    )
}

/// What a variable is and what it was given.
pub(super) fn keeps_type(clash: &Clash) -> Words {
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
pub(super) fn gives_no_value(name: &str, meant: Option<&str>) -> Words {
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
