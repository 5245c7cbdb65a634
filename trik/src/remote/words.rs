//! What commands that speak with a robot say, in Russian, beside what the robot says itself.
//!
//! Owns the Russian of sentences that [`crate::error::Error`] carries in English, and of those that all clients of a robot hear
//! in English. `debug::target::words` finds them.

/// The Russian of a sentence that is always the same.
pub(crate) fn whole(text: &str) -> Option<&'static str> {
    Some(match text {
        "it does not say why" => "почему, он не говорит",
        "the robot has closed it" => "робот его закрыл",
        "no program was running; everything rests" => "программа не выполнялась; всё в покое",
        "was told to stop, and does not say whether it has" => {
            "получил распоряжение остановиться и не говорит, остановился ли"
        }
        "no program in JavaScript runs there: say the file of the program that runs to join it" => {
            "там выполняется программа не на JavaScript: назовите её файл, чтобы подключиться"
        }
        super::target::UNKNOWN => {
            "там смонтировано дерево, но где его робот принимает программы, неизвестно: его смонтировал не trik up, \
             или папка trik в XDG_RUNTIME_DIR (а без неё /tmp/trik-UID) удалена или здесь другая; назовите робота по адресу, \
             который напечатал trik up, или завершите и запустите его снова"
        }
        super::target::NOT_MOUNTED => {
            "там не смонтирован ни один ваш виртуальный робот; у роботов в сети есть имена и адреса"
        }
        "the stop key" => "кнопка робота",
        "a direct command" => "отдельная команда",
        "the end of trikd" => "завершение trikd",
        "the end of its debugger" => "завершение отладки",
        _ => return None,
    })
}

/// Sentences with names and numbers, which stand for `{}`, in English and Russian; the first that fits counts.
pub(crate) const TEMPLATES: [[&str; 2]; 24] = [
    [
        "{} does not say that {} has started: if its software is older than trikd, the program may run, and trik stop ends it",
        "{} не говорит, что {} запущена: если его программы старше trikd, она, возможно, выполняется, и trik stop её остановит",
    ],
    [
        "the virtual robot at {} has no trikd, which takes programs: it told why when it started, or was started with --no-trikd",
        "у виртуального робота в {} нет trikd, который принимает программы: почему, сказано при запуске, или он запущен с --no-trikd",
    ],
    [
        "{} does not know the question: its software is older than trikd",
        "{} не понимает вопроса: его программы старше trikd",
    ],
    [
        "{} robots: at most {} at once",
        "роботов {}, а одновременно можно не больше {}",
    ],
    ["no connection to {}: {}", "соединения с {} нет: {}"],
    ["it has been silent for {} s", "он молчит уже {} с"],
    [
        "it does not speak as robots do, {}",
        "там говорят не так, как роботы: {}",
    ],
    ["waiting for {}: {}", "ожидание {}: {}"],
    ["{}: {} in its answer", "{}: {} в его ответе"],
    ["a port for debugpy: {}", "порт для debugpy: {}"],
    [
        "the connection of the program to debugpy: {}",
        "соединение программы с debugpy: {}",
    ],
    ["signals: {}", "сигналы: {}"],
    ["standard output: {}", "стандартный вывод: {}"],
    ["the upload failed: {}", "файл не принят: {}"],
    ["{} cannot be started: {}", "{} не запускается: {}"],
    [
        "it had {} processes, and {} are allowed",
        "у неё было процессов {}, а можно {}",
    ],
    [
        "its process {} stood still (SIGSTOP)",
        "её процесс {} стоял (SIGSTOP)",
    ],
    [
        "there is no tree at {}: start it with `trikfs mount`",
        "дерева в {} нет: запустите его командой `trikfs mount`",
    ],
    [
        "the tree at {} is gone: its guardian brings the motors to rest",
        "дерева в {} больше нет: его хранитель останавливает моторы",
    ],
    [
        "not everything is at rest: {}: {}",
        "не всё в покое: {}: {}",
    ],
    [
        "the tree has not brought the motors to rest within {} ms",
        "дерево не остановило моторы за {} мс",
    ],
    [
        "{} messages were left out: this computer reads more slowly than the robot writes",
        "сообщений пропущено {}: этот компьютер читает медленнее, чем робот пишет",
    ],
    [
        "{} messages of the program were left out: it says more than {} a second",
        "сообщений программы пропущено {}: она говорит больше {} в секунду",
    ],
    [
        "{} does not rest at a stop, and is told again to: {}",
        "{} при остановке не приходит в покой и получает распоряжение снова: {}",
    ],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The sources that have these sentences.
    const SOURCES: [&str; 13] = [
        include_str!("link.rs"),
        include_str!("target.rs"),
        include_str!("upload.rs"),
        include_str!("fleet.rs"),
        include_str!("run.rs"),
        include_str!("debugged.rs"),
        include_str!("../output.rs"),
        include_str!("../../../trikd/src/connection.rs"),
        include_str!("../../../trikd/src/program.rs"),
        include_str!("../../../trikd/src/program/says.rs"),
        include_str!("../../../trikd/src/program/rest.rs"),
        include_str!("../../../trikd/src/protocol/news.rs"),
        include_str!("../../../trikd/src/js/debug/motors.rs"),
    ];

    #[test]
    fn every_piece_of_a_sentence_is_one_that_is_said() {
        let mut missing = Vec::new();
        for [english, _] in TEMPLATES {
            let parts = english.split("{}").flat_map(|part| part.split(':'));
            for part in parts.map(str::trim).filter(|part| part.len() > 6) {
                if !SOURCES.iter().any(|source| source.contains(part)) {
                    missing.push(part);
                }
            }
        }
        assert!(missing.is_empty(), "{missing:?}");
    }
}
