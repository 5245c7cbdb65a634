//! What is wrong, in Russian: the sentences of [`crate::error::Error`] for a browser that speaks it.
//!
//! Owns the texts. The English ones stand with the errors.

use crate::error::{Busy, Error};
use crate::guests::NotPaired;
use lang_text::problem::{Words, of_system};
use std::io;

impl Error {
    /// The sentence in each language.
    pub fn words(&self) -> Words {
        Words::new(self.to_string(), russian(self))
    }
}

/// The sentence in Russian.
fn russian(error: &Error) -> String {
    match error {
        Error::Address(address, why) => format!("страница по адресу {address}: {}", system(why)),
        Error::Thread(why) => format!("поток для страницы: {}", system(why)),
        Error::Path(path) => format!("у этого робота нет исполнительного устройства '{path}'"),
        Error::File(path, why) => format!("{path}: {}", system(why)),
        Error::Words(words) => format!("'{words}' — не распоряжение"),
        Error::Long(bytes, most) => {
            format!("запрос слишком длинный: {bytes} Б, а можно не больше {most}")
        }
        Error::NoWorld => "у настоящего робота нет мира, которым можно распоряжаться".to_owned(),
        Error::NoPlayback => "здесь не воспроизводится никакая запись".to_owned(),
        Error::World(why) => why.russian.clone(),
        // These have been said by others.
        Error::Robot(why)
        | Error::Diagram(why)
        | Error::Change(why)
        | Error::Configuration(why) => why.clone(),
        Error::Busy(what) => busy(*what).to_owned(),
        Error::Large(name, bytes, most) => {
            format!("{name}: {bytes} Б, а здесь можно редактировать не больше {most}")
        }
        Error::Text(name) => format!("{name} — не текст в UTF-8"),
        Error::Fixed => {
            "конфигурацию нельзя заменить с этой страницы; на роботе это разрешает trikd --page-configures"
                .to_owned()
        }
        Error::Taken(who) => format!("роботом управляет {who}; сначала возьмите управление"),
        Error::Unpaired => {
            "с этого компьютера можно только смотреть: нажмите Enter на роботе в течение 30 с и повторите или введите код сопряжения"
                .to_owned()
        }
        Error::Pairing(NotPaired::Code) => {
            "это не код сопряжения робота, или он больше не действует: новый даёт на роботе `trikd pair --code`"
                .to_owned()
        }
        Error::Pairing(NotPaired::Robot(why)) => {
            format!("код верен, но робот не может запомнить этот компьютер: {why}")
        }
        Error::Name(name) => format!("программы '{name}' нет"),
        Error::NewName(name) => format!(
            "'{name}' — не имя для программы: оно слишком длинное, в нём двоеточие, обратная косая черта или управляющие символы, часть его пуста или начинается с точки, или его папки нет"
        ),
        Error::NoFolder => "программы этого робота — на другом компьютере".to_owned(),
    }
}

fn busy(what: Busy) -> &'static str {
    match what {
        Busy::Values => "ждёт слишком много распоряжений: робот не отвечает",
        Busy::Requests => "робот сейчас не принимает программы",
        Busy::Uploads => "роботу отправляются другие файлы: повторите",
        Busy::Files => "читаются или меняются другие файлы: повторите",
        Busy::Worlds => "читаются другие миры: повторите",
        Busy::Configuration => "проверяется другая конфигурация: подождите",
    }
}

fn system(error: &io::Error) -> String {
    of_system(&error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_person_meets_is_said_in_russian() {
        let all = [
            Error::Taken("10.0.0.1".to_owned()),
            Error::Unpaired,
            Error::Pairing(NotPaired::Code),
            Error::Pairing(NotPaired::Robot("full".to_owned())),
            Error::NoFolder,
            Error::NoWorld,
            Error::Fixed,
            Error::Name("a.py".to_owned()),
            Error::NewName("a:b".to_owned()),
            Error::Path("m".to_owned()),
            Error::Busy(Busy::Values),
            Error::File("motors/M1".to_owned(), io::Error::from_raw_os_error(16)),
            Error::File("motors/M1".to_owned(), io::Error::from_raw_os_error(19)),
        ];
        for error in all {
            let words = error.words();
            assert_ne!(words.english, words.russian);
            assert!(words.english.is_ascii(), "{}", words.english);
            let letters = words
                .russian
                .chars()
                .filter(|letter| ('а'..='я').contains(letter));
            assert!(letters.count() >= 8, "{}", words.russian);
        }
        let other = Error::File("m".to_owned(), io::Error::from_raw_os_error(71));
        assert_eq!(other.words().russian, "m: Protocol error");
    }
}
