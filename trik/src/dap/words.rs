//! What an editor shows of a debugged program, in English and Russian.

use lang_text::problem::{Locale, Words};

/// What runs on a robot has blocks that the file of the editor has not.
pub(super) fn another_runs(file: &str) -> Words {
    Words::new(
        format!(
            "another diagram than {file} runs on the robot: lines and breakpoints of this file mean nothing there"
        ),
        format!(
            "на роботе выполняется не {file}, а другая диаграмма: строки и точки останова этого файла к ней не относятся"
        ),
    )
}

/// The groups of values: variables, sensors, ports.
pub(super) fn scopes(locale: Locale) -> [&'static str; 3] {
    match locale {
        Locale::English => ["Variables", "Sensors", "Ports"],
        Locale::Russian => ["Переменные", "Датчики", "Порты"],
    }
}
