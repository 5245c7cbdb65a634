//! What a running diagram says of its robot and of what it is asked for, in English and Russian.
//!
//! Owns the texts. Mistakes in diagrams are worded where they are found.

use super::robot::Trouble;
use crate::limits;
use lang_text::problem::{Words, of_system};

/// What keeps a device from doing what a block tells it.
pub(super) fn trouble(what: &Trouble) -> Words {
    match what {
        Trouble::NoMotor => Words::new("the robot has no such motor", "такого мотора у робота нет"),
        Trouble::NoCamera => {
            Words::new("the robot has no such camera", "такой камеры у робота нет")
        }
        Trouble::NoEncoder => Words::new(
            "the robot has no such encoder",
            "такого энкодера у робота нет",
        ),
        Trouble::NoDetector => Words::new("the sensor does not run", "датчик не работает"),
        Trouble::ManyCommands => Words::new(
            "too many commands run at once",
            "одновременно выполняется слишком много команд",
        ),
        Trouble::NoFile => Words::new("this is no file", "это не файл"),
        Trouble::LongFile => {
            let most = limits::DIAGRAM_FILE_BYTES >> 20;
            Words::new(
                format!("longer than {most} MiB"),
                format!("длиннее {most} МиБ"),
            )
        }
        Trouble::System(error) => {
            let said = error.to_string();
            let russian = of_system(&said);
            Words::new(said, russian)
        }
        Trouble::Display(why) => why.words(),
    }
}

/// Why a direct command is lost.
pub(super) fn no_direct() -> Words {
    Words::new(
        "a program of blocks takes no direct commands",
        "программа из блоков не принимает отдельных команд",
    )
}

/// Why a save with diagrams of control flow does not replace a data-flow program.
pub(super) fn other_language() -> Words {
    Words::new(
        "its diagrams are of control flow, and a data-flow program runs: end that, and start the new one",
        "это диаграммы с потоком управления, а выполняется потоковая программа: завершите её и запустите новую",
    )
}

/// Why a version that counts so many bytes does not replace what runs.
pub(super) fn long_version(bytes: usize) -> Words {
    let (have, most) = (bytes >> 10, limits::VERSION_BYTES >> 10);
    Words::new(
        format!(
            "its blocks and their texts have {have} KiB, and beside a program that runs {most} KiB can be prepared: end that, and start the new one"
        ),
        format!(
            "в его блоках с их текстами {have} КиБ, а рядом с работающей программой можно подготовить {most} КиБ: завершите её и запустите новую"
        ),
    )
}

/// Why a version whose checks ended their thread does not replace what runs.
pub(super) fn not_prepared() -> Words {
    Words::new(
        "a fault of trikd ended its check; please report it with this file",
        "его проверка прервана ошибкой в самом trikd; сообщите о ней и приложите этот файл",
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display::Unshown;
    use std::io;

    #[test]
    fn what_keeps_a_device_from_its_work_is_said_in_russian() {
        for what in [
            Trouble::NoMotor,
            Trouble::NoCamera,
            Trouble::NoEncoder,
            Trouble::NoDetector,
            Trouble::ManyCommands,
            Trouble::NoFile,
            Trouble::LongFile,
            Trouble::System(io::Error::from_raw_os_error(19)),
            Trouble::Display(Unshown::NoDisplay("display".into())),
        ] {
            let words = trouble(&what);
            assert!(words.english.is_ascii(), "{}", words.english);
            let is_russian = |c: char| ('а'..='я').contains(&c);
            assert!(words.russian.chars().any(is_russian), "{}", words.russian);
        }
    }
}
