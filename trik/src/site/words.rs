//! What `trik site` says, in English and Russian.

use lang_text::problem::Words;
use std::fmt::Display;

pub(super) fn no_studio() -> Words {
    Words::new(
        "the studio is not built: run web/site.sh target/web/site in the sources, or name its folder with --studio",
        "студия не собрана: запустите web/site.sh target/web/site в исходном коде или назовите её папку в --studio",
    )
}

pub(super) fn no_studio_in(folder: &str) -> Words {
    Words::new(
        format!("{folder} has no built studio: web/site.sh makes one"),
        format!("в {folder} нет собранной студии: её делает web/site.sh"),
    )
}

pub(super) fn broken_studio(folder: &str, file: &str) -> Words {
    Words::new(
        format!(
            "{folder} is no whole studio: {file} is missing or damaged; web/site.sh makes a new one"
        ),
        format!(
            "студия в {folder} неполная: файла {file} нет или он повреждён; новую делает web/site.sh"
        ),
    )
}

pub(super) fn no_world(task: &str) -> Words {
    Words::new(
        format!("{task} has no world, so it is no task"),
        format!("в {task} нет мира, поэтому это не задание"),
    )
}

pub(super) fn no_folder(folder: &str, error: impl Display) -> Words {
    Words::new(
        format!("{folder} cannot be made: {error}"),
        format!("{folder} нельзя создать: {error}"),
    )
}

pub(super) fn written(folder: &str, has_task: bool) -> Words {
    let (english, russian) = match has_task {
        true => (" with the task", " с заданием"),
        false => ("", ""),
    };
    Words::new(
        format!(
            "The studio{english} is in {folder}. Put it on a web server, or look at it here:\n  python3 -m http.server --directory {folder}\n"
        ),
        format!(
            "Студия{russian} - в {folder}. Поместите её на веб-сервер или посмотрите здесь:\n  python3 -m http.server --directory {folder}\n"
        ),
    )
}
