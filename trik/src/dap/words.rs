//! What an editor shows of a debugged program, in English and Russian.

use lang_text::problem::Locale;

/// The groups of values: variables, sensors, ports.
pub(super) fn scopes(locale: Locale) -> [&'static str; 3] {
    match locale {
        Locale::English => ["Variables", "Sensors", "Ports"],
        Locale::Russian => ["Переменные", "Датчики", "Порты"],
    }
}
