//! Why a file is not sent to a robot, in English and Russian.

use lang_text::problem::{Words, of_system};
use std::io;

pub(super) fn no_name() -> Words {
    Words::new(
        "its name is no text that a robot understands",
        "имя этого файла - не текст, понятный роботу",
    )
}

pub(super) fn colon() -> Words {
    Words::new(
        "a program with ':' in its name cannot be sent",
        "программу с ':' в имени отправить нельзя",
    )
}

pub(super) fn no_file() -> Words {
    Words::new("not a file", "это не файл")
}

/// The system does not read it; without its number for that.
pub(super) fn unread(error: &io::Error) -> Words {
    let said = error.to_string();
    let russian = of_system(&said);
    match error.kind() == io::ErrorKind::NotFound {
        true => Words::new("there is no such file", russian),
        false => Words::new(said, russian),
    }
}

/// It has so many bytes, and so many can be sent.
pub(super) fn too_long(length: u64, most: u64) -> Words {
    let mib = most.div_ceil(1 << 20);
    Words::new(
        format!(
            "{length} bytes long, and a robot takes at most {most} in one message (about {mib} MiB)"
        ),
        format!(
            "длина {length} байт, а робот принимает одним сообщением не больше {most} (около {mib} МиБ)"
        ),
    )
}

pub(super) fn no_diagram() -> Words {
    Words::new(
        "--diagram is for diagrams (NAME.qrs, NAME.flow), and this is another program",
        "--diagram - для диаграмм (NAME.qrs, NAME.flow), а это другая программа",
    )
}
