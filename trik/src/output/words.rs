//! Why a file is not written, in English and Russian.

use lang_text::problem::Words;
use std::fmt::Display;

/// It is the file that is read.
pub(super) fn is_source(name: &str) -> Words {
    Words::new(
        format!("{name} is the file that is read: name another one"),
        format!("{name} - это читаемый файл: назовите другой"),
    )
}

/// There is one of this name.
pub(super) fn is_there(name: &str) -> Words {
    Words::new(
        format!("{name} is there already: --force replaces it"),
        format!("{name} уже есть: --force заменит его"),
    )
}

/// It is a directory, a device or a pipe.
pub(super) fn is_no_file(name: &str) -> Words {
    Words::new(
        format!("{name} is no file, and only a file is replaced: name another one"),
        format!("{name} - не файл, а заменяются только файлы: назовите другой"),
    )
}

/// Only a file can hold it.
pub(super) fn needs_file() -> Words {
    Words::new(
        "a recording cannot be written to standard output: name a file",
        "запись нельзя выводить в стандартный вывод: назовите файл",
    )
}

/// It is read or written under another option too.
pub(super) fn is_taken(name: &str) -> Words {
    Words::new(
        format!("{name} is needed for something else here: name another file"),
        format!("{name} уже нужен здесь для другого: назовите другой файл"),
    )
}

/// Its directory is not there.
pub(super) fn no_folder(name: &str) -> Words {
    Words::new(
        format!("{name}: there is no such directory"),
        format!("{name}: нет такой папки"),
    )
}

/// What the system says.
pub(super) fn unwritten(name: &str, error: impl Display) -> Words {
    Words::new(
        format!("{name} cannot be written: {error}"),
        format!("{name} не записывается: {error}"),
    )
}
