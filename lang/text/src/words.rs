//! What all languages say, in English and Russian.

use crate::problem::{Severity, Words};

/// How bad a problem is.
pub(crate) fn severity(severity: Severity) -> Words {
    match severity {
        Severity::Error => Words::new("error", "ошибка"),
        Severity::Warning => Words::new("warning", "предупреждение"),
        Severity::Note => Words::new("note", "замечание"),
    }
}

/// What the system says, by its own words; others stay as they are.
const SYSTEM: [(&str, &str); 24] = [
    ("No such file or directory", "такого файла нет"),
    ("Permission denied", "нет прав"),
    ("Operation not permitted", "это не разрешено"),
    ("Invalid argument", "такое значение не принимается"),
    ("Device or resource busy", "занято другой программой"),
    ("Connection timed out", "устройство не ответило вовремя"),
    ("No such device", "устройства нет"),
    (
        "Numerical result out of range",
        "значение вне допустимых пределов",
    ),
    ("Input/output error", "устройство отказало"),
    ("Remote I/O error", "на шине никто не отозвался"),
    ("No space left on device", "на диске нет места"),
    ("Read-only file system", "диск только для чтения"),
    ("Address already in use", "адрес уже занят"),
    ("Connection refused", "там никто не слушает"),
    (
        "Connection reset by peer",
        "соединение оборвано другой стороной",
    ),
    ("Broken pipe", "другая сторона закрыла соединение"),
    ("Network is unreachable", "сеть недоступна"),
    ("No route to host", "пути туда нет"),
    ("Is a directory", "это папка"),
    ("Not a directory", "это не папка"),
    ("File exists", "такой файл уже есть"),
    ("Directory not empty", "папка не пуста"),
    ("Cannot allocate memory", "не хватает памяти"),
    ("Too many open files", "открыто слишком много файлов"),
];

/// What the system said, in Russian as far as that is known; the number of the error is left out.
pub(crate) fn of_system(said: &str) -> String {
    let plain = said.split(" (os error").next().unwrap_or_default();
    let known = SYSTEM.iter().find(|(english, _)| *english == plain);
    known.map_or(plain, |(_, russian)| russian).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_says_is_known_with_its_number_and_without() {
        for said in ["Permission denied (os error 13)", "Permission denied"] {
            assert_eq!(of_system(said), "нет прав");
        }
        assert_eq!(of_system("Protocol error (os error 71)"), "Protocol error");
        assert_eq!(of_system("something else"), "something else");
    }
}
