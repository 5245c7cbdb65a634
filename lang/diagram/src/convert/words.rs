//! What there is to say about the version of a save, in words.

use lang_text::problem::Words;

pub(super) fn no_version() -> Words {
    Words::new(
        "the save does not tell its version; it is read as one of today, but TRIK Studio will refuse it as too old",
        "в сохранении нет версии; оно читается как нынешнее, но TRIK Studio откажется от него как от слишком старого",
    )
}

pub(super) fn strange_version(version: &str) -> Words {
    Words::new(
        format!("'{version}' is no version; the save is read as one of today"),
        format!("'{version}' не версия; сохранение читается как нынешнее"),
    )
}

pub(super) fn newer(saved: &str, known: &str) -> Words {
    Words::new(
        format!(
            "the project was saved by version {saved}, which is newer than {known}, the newest that is known here: update this program, or save the project in an older TRIK Studio"
        ),
        format!(
            "проект сохранён версией {saved}, она новее {known}, последней известной здесь: обновите эту программу или сохраните проект в более старой TRIK Studio"
        ),
    )
}

pub(super) fn too_old(saved: &str) -> Words {
    Words::new(
        format!(
            "the project was saved by version {saved}, which is too old: open it in TRIK Studio 3 and save it again"
        ),
        format!(
            "проект сохранён версией {saved}, она слишком стара: откройте его в TRIK Studio 3 и сохраните ещё раз"
        ),
    )
}

pub(super) fn converted(saved: &str, now: &str) -> Words {
    Words::new(
        format!("the project was converted from version {saved} to {now}"),
        format!("проект преобразован из версии {saved} в {now}"),
    )
}
