//! The words in conditions and values that an explanation tells, in English and Russian.

use lang_text::problem::Locale;

/// The words of a language. Signs, and names of objects, variables and functions of rules, are the same in all.
pub(super) struct Wording {
    pub inside: &'static str,
    pub all: &'static str,
    pub any: &'static str,
    pub set_up: &'static str,
    pub dropped: &'static str,
    pub timer: &'static str,
    pub ms: &'static str,
    pub yes: &'static str,
    pub no: &'static str,
    pub nothing: &'static str,
    pub list: &'static str,
    pub figure: &'static str,
    pub object: &'static str,
    pub distance: &'static str,
}

/// Those of a locale.
pub(super) fn told(locale: Locale) -> &'static Wording {
    match locale {
        Locale::English => &Wording {
            inside: "inside",
            all: "all",
            any: "any",
            set_up: "settedUp",
            dropped: "dropped",
            timer: "timer",
            ms: "ms",
            yes: "true",
            no: "false",
            nothing: "nothing",
            list: "list of",
            figure: "figure",
            object: "object",
            distance: "distance",
        },
        Locale::Russian => &Wording {
            inside: "внутри",
            all: "целиком",
            any: "хотя бы часть",
            set_up: "взведено",
            dropped: "снято",
            timer: "таймер",
            ms: "мс",
            yes: "да",
            no: "нет",
            nothing: "ничего",
            list: "список, длина",
            figure: "фигура",
            object: "объект",
            distance: "расстояние",
        },
    }
}
