//! What a new task says, in English and Russian.

use lang_text::problem::Locale;

/// Texts that stand in the files of a task, by their marks.
pub(super) fn texts(locale: Locale) -> [(&'static str, &'static str); 5] {
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
        ],
        Locale::Russian => [
            ("FINISH", "Финиш"),
            ("LEFT", "Робот покинул дорогу"),
            ("HALF", "Половина пути, баллов: ${total_score}"),
            ("GOOD", "Едет до финиша и останавливается."),
            ("BAD", "Правое колесо медленнее, и робот съезжает с дороги."),
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
