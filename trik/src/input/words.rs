//! Why a file was not read, in English and Russian.

use super::Unread;
use lang_text::problem::Words;
use std::io;

/// What is said of a file of which at most so many bytes are read; `directory` says what to name instead of a directory.
pub(crate) fn why(unread: &Unread, most: u64, directory: [&str; 2]) -> Words {
    let [english, russian] = directory;
    match unread {
        Unread::Missing => Words::new("there is no such file", "такого файла нет"),
        Unread::Directory => Words::new(
            format!("this is a directory: name {english}"),
            format!("это папка: назовите {russian}"),
        ),
        Unread::TooLong if most < 1 << 20 => Words::new(
            format!("longer than {} KiB", most >> 10),
            format!("длиннее {} КиБ", most >> 10),
        ),
        Unread::TooLong => Words::new(
            format!("longer than {} MiB", most >> 20),
            format!("длиннее {} МиБ", most >> 20),
        ),
        Unread::Silent => Words::new(
            "nothing comes out of this FIFO or device: name a file",
            "из этого канала (FIFO) или устройства ничего не приходит: назовите файл",
        ),
        Unread::Failed(error) => Words::new(
            format!("cannot be read: {error}"),
            match error.kind() == io::ErrorKind::PermissionDenied {
                true => "не читается: нет прав на чтение этого файла".to_owned(),
                false => format!("не читается: {error}"),
            },
        ),
    }
}

/// What a directory is told to be replaced with: any file.
pub(crate) const A_FILE: [&str; 2] = ["a file", "файл"];
/// See [`A_FILE`]; a diagram.
pub(crate) const A_DIAGRAM: [&str; 2] = ["a diagram, a file NAME.qrs", "диаграмму, файл NAME.qrs"];

/// See [`A_FILE`]; the robots of a class.
pub(crate) const A_CLASS: [&str; 2] =
    ["a file that names robots", "файл, который называет роботов"];

/// A text that is none in UTF-8.
pub(crate) fn no_text() -> Words {
    Words::new("this is no text in UTF-8", "это не текст в UTF-8")
}
