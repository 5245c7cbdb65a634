//! What a virtual robot says of its world and of orders to it, in English and Russian.

use super::world::Unfit;
use crate::debug::target::words::told;
use crate::error::Error;
use lang_text::problem::{Locale, Problem, Words};

/// What a directory is told to be replaced with.
pub(super) const A_WORLD: [&str; 2] = ["a world or a project", "мир или проект"];

pub(super) fn no_world() -> Words {
    Words::new(
        "there is no world in this project; give a world model, FILE.xml",
        "в этом проекте нет мира; дайте модель мира, FILE.xml",
    )
}

/// Why a page does not get the world of a file; of many mistakes one is enough for it.
pub(super) fn unfit(why: &Unfit) -> Words {
    let why = match why {
        Unfit::File(why) => why.clone(),
        Unfit::World(problems) => problems
            .first()
            .map_or_else(|| Words::new("", ""), Problem::in_both),
    };
    Words::new(
        format!("no world can be read from this file: {}", why.english),
        format!("в этом файле не читается мир: {}", why.russian),
    )
}

/// A page names no files of this machine.
pub(super) fn no_files() -> Words {
    Words::new(
        "drop the file of a world on this page instead",
        "перетащите файл мира на эту страницу",
    )
}

/// What the system says to a fault of a device.
pub(super) fn unwritten(error: &Error) -> Words {
    let said = error.to_string();
    let russian = told(&said, Locale::Russian);
    Words::new(said, russian)
}

#[cfg(test)]
mod tests {
    use super::super::world;
    use super::*;

    #[test]
    fn what_is_wrong_with_the_file_of_a_world_is_said_in_russian() {
        let text = |inside: &str| format!("<root><world>{inside}</world></root>").into_bytes();
        for bytes in [
            b"<root><world>".to_vec(),
            b"<root/>".to_vec(),
            b"not a world at all".to_vec(),
            [b"<root>".as_slice(), &[0xff]].concat(),
            text("<walls><wall id='a' begin='1e99:0' end='0:0'/></walls>"),
        ] {
            let shown = String::from_utf8_lossy(&bytes).into_owned();
            let Err(why) = world::of(bytes) else {
                panic!("{shown}: a world");
            };
            let words = unfit(&why);
            assert!(words.english.starts_with("no world can be read"), "{shown}");
            let (_, russian) = words.russian.split_once(": ").expect("why");
            let is_russian = |c: char| ('а'..='я').contains(&c);
            assert!(russian.chars().any(is_russian), "{shown}: {russian}");
        }
    }
}
