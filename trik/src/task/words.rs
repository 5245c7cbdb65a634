//! What a new task says, in English and Russian.

use lang_text::problem::{Locale, Words};
use std::fmt::Display;

/// Texts that stand in the files of a task, by their marks.
pub(super) fn texts(locale: Locale) -> [(&'static str, &'static str); 11] {
    match locale {
        Locale::English => [
            ("FINISH", "Finish"),
            ("LEFT", "The robot has left the road"),
            ("HALF", "Half of the way: ${total_score} points"),
            ("GOOD", "Drives to the finish and stops there."),
            (
                "BAD",
                "The right wheel is slower, so the robot leaves the road.",
            ),
            (
                "UNITS",
                "Lengths are in centimetres, x to the right, y down; directions in degrees clockwise, 0 looks to the right.",
            ),
            (
                "ROBOT",
                "position is the upper left corner of the robot, startPosition its centre; it is 17.5 cm long.",
            ),
            ("LIMIT", "Milliseconds that a program may take."),
            ("FAILS", "Fails as soon as it is not true."),
            (
                "POINTS",
                "Points on the way; each event happens once. Rules speak of pixels: 2.857 are 1 cm, and x is that of the corner.",
            ),
            ("DONE", "Done: the robot stands in the finish."),
        ],
        Locale::Russian => [
            ("FINISH", "Финиш"),
            ("LEFT", "Робот покинул дорогу"),
            ("HALF", "Половина пути, баллов: ${total_score}"),
            ("GOOD", "Едет до финиша и останавливается."),
            ("BAD", "Правое колесо медленнее, и робот съезжает с дороги."),
            (
                "UNITS",
                "Длины в сантиметрах, x вправо, y вниз; направления в градусах по часовой стрелке, 0 - вправо.",
            ),
            (
                "ROBOT",
                "position - левый верхний угол робота, startPosition - его центр; длина робота 17,5 см.",
            ),
            ("LIMIT", "Сколько миллисекунд может работать программа."),
            ("FAILS", "Задание провалено, как только это неверно."),
            (
                "POINTS",
                "Баллы в пути; каждое событие происходит один раз. Правила считают в пикселях: 2,857 - это 1 см, а x - координата угла.",
            ),
            ("DONE", "Выполнено: робот стоит на финише."),
        ],
    }
}

/// Written, and what to do next; the last lines are commands.
pub(super) fn written(name: &str, ending: &str, locale: Locale) -> String {
    let head = match locale {
        Locale::English => {
            format!("{name}: a task is there; README.md in it says what to change. Judge it with")
        }
        Locale::Russian => {
            format!("{name}: задание готово; что в нём менять, сказано в README.md. Проверка:")
        }
    };
    format!(
        "{head}\n  trik lint {name}/world.xml\n  trik check {name}/solution.{ending} --field {name}/world.xml\n  trik check {name}/wrong.{ending} --field {name}/world.xml\n"
    )
}

/// A file to be written, or the folder, is a link.
pub(super) fn is_link(name: &str) -> Words {
    Words::new(
        format!("{name} is a link: a task is written into a folder and files of its own"),
        format!("{name} - ссылка: задание пишется только в свою папку и в свои файлы"),
    )
}

/// The folder of a task cannot be made.
pub(super) fn no_folder(name: &str, error: impl Display) -> Words {
    Words::new(
        format!("{name}: this folder cannot be made: {error}"),
        format!("{name}: эту папку не создать: {error}"),
    )
}

/// No name for a task.
pub(super) fn no_name(name: &str) -> Words {
    Words::new(
        format!(
            "'{name}' is no name for a task: a task has a name of letters, digits, '-', '_' and '.', as drive-home"
        ),
        format!(
            "'{name}' не подходит как имя задания: в имени бывают буквы, цифры, '-', '_' и '.', например drive-home"
        ),
    )
}
