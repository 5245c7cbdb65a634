//! Why a program is not kept or not run, in Russian.
//!
//! Owns the texts. The English ones stand with the errors, and clients know how they begin: with the name.

use super::{BadName, Refusal};

/// The sentence.
pub(super) fn russian(why: &Refusal) -> String {
    match why {
        Refusal::Name(name, why) => {
            format!("'{name}' не может быть именем программы: {}", bad(*why))
        }
        Refusal::LinkedFolder(name) => {
            format!("'{name}' не сохранена: одна из папок в имени - ссылка")
        }
        Refusal::Folder(name) => format!("'{name}' не сохранена: есть папка с таким именем"),
        Refusal::Disk(name, os) => {
            let hint = match os.errno {
                Some(libc::ENOSPC | libc::EDQUOT) => "; удалите что-нибудь на роботе",
                Some(_) | None => "",
            };
            format!("'{name}' не сохранена: {}{hint}", os.russian())
        }
        Refusal::Missing(name, folder) => format!(
            "программы '{name}' нет в {}: сначала отправьте её",
            folder.display()
        ),
        Refusal::Linked(name, folder) => format!(
            "'{name}' - ссылка: выполняются только программы из {}",
            folder.display()
        ),
    }
}

fn bad(why: BadName) -> &'static str {
    match why {
        BadName::NoUtf8 => "это не UTF-8",
        BadName::Empty => "оно пустое",
        BadName::Long => "оно слишком длинное",
        BadName::Control => "в нём есть управляющие символы",
        BadName::Deep => "в нём слишком много папок",
        BadName::Dot => "одна из его частей начинается с точки",
        BadName::Here => "в нём есть '.'",
        BadName::Outside => "оно ведёт за пределы папки программ",
        BadName::Absolute => "это абсолютный путь",
        BadName::Folder => "это папка",
    }
}
