//! Words of sentences about data-flow programs, in English and Russian.

use lang_text::problem::{Locale, Words};

/// Why a project has no pictures: it is too large for a person to look at.
pub fn too_many(name: &str, count: usize, most: usize) -> Words {
    Words::new(
        format!("{name} has {count} blocks and diagrams: at most {most} are drawn"),
        format!("{name}: блоков и диаграмм {count}, а рисуется не больше {most}"),
    )
}

/// The same, because of its edges.
pub fn too_many_edges(name: &str, count: usize, most: usize) -> Words {
    Words::new(
        format!("{name} has {count} edges: at most {most} are drawn"),
        format!("{name}: связей {count}, а рисуется не больше {most}"),
    )
}

/// Words between blocks.
#[derive(Clone, Copy, Debug)]
pub(super) enum Word {
    /// A main diagram.
    Program,
    /// A subprogram.
    Subprogram,
    /// A main diagram that is not run.
    NotRun,
    /// A subprogram that is never called.
    NotCalled,
    /// A block that no row knows.
    Unknown,
    /// What a call runs.
    Runs,
    /// A diagram that is not in the project.
    NotThere,
    /// The end of an edge that leads to no block.
    Nowhere,
    /// The beginning of an edge that comes from no block.
    FromNowhere,
    /// A full queue drops its oldest token.
    Fifo,
    /// A queue of one token.
    Latest,
    /// A full queue ends the program.
    Error,
    /// Before how many tokens wait at most.
    AtMost,
    /// A flag that is set.
    Yes,
    /// A flag that is not set.
    No,
    /// A text of no letters.
    Empty,
}

impl Word {
    /// The word.
    pub fn text(self, locale: Locale) -> &'static str {
        let (english, russian) = match self {
            Self::Program => ("Program", "Программа"),
            Self::Subprogram => ("Subprogram", "Подпрограмма"),
            Self::NotRun => ("not run", "не выполняется"),
            Self::NotCalled => ("not called", "не вызывается"),
            Self::Unknown => ("unknown block", "неизвестный блок"),
            Self::Runs => ("runs", "выполняет"),
            Self::NotThere => (
                "a subprogram that is not there",
                "подпрограмму, которой нет",
            ),
            Self::Nowhere => ("nowhere", "никуда"),
            Self::FromNowhere => ("nowhere", "ниоткуда"),
            Self::Fifo => (
                "when full, the oldest is dropped",
                "когда мест нет, пропадает самое старое",
            ),
            Self::Latest => ("only the newest waits", "ждёт только самое новое"),
            Self::Error => (
                "when full, the program ends",
                "когда мест нет, программа заканчивается",
            ),
            Self::AtMost => ("places", "мест"),
            Self::Yes => ("yes", "да"),
            Self::No => ("no", "нет"),
            Self::Empty => ("nothing", "ничего"),
        };
        match locale {
            Locale::English => english,
            Locale::Russian => russian,
        }
    }
}
