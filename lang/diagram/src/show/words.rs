//! Words of outlines, in English and Russian.

use lang_text::problem::Locale;

/// Words between blocks.
#[derive(Clone, Copy, Debug)]
pub enum Word {
    /// The main program.
    Program,
    /// A subprogram.
    Subprogram,
    /// A thread.
    Thread,
    /// Before a condition.
    If,
    /// The other branch.
    Otherwise,
    /// Before the expression of a switch.
    Depending,
    /// Before a guard.
    Case,
    /// A loop without end.
    Forever,
    /// Before the condition of a loop.
    While,
    /// Before how often.
    Times,
    /// Before the condition at the foot of a loop.
    Until,
    /// Before what is repeated at least once.
    Repeat,
    /// Leaves a loop.
    Leave,
    /// Begins a loop anew.
    Again,
    /// The end.
    End,
    /// Between conditions.
    And,
    /// Between conditions.
    Or,
    /// Before a condition.
    Not,
    /// Before a number of the analysis.
    Place,
    /// Begins a thread.
    Begin,
    /// Before a question to a person.
    Answered,
}

impl Word {
    /// The word.
    pub fn text(self, locale: Locale) -> &'static str {
        let (english, russian) = match self {
            Self::Program => ("Program", "Программа"),
            Self::Subprogram => ("Subprogram", "Подпрограмма"),
            Self::Thread => ("Thread", "Поток"),
            Self::If => ("If", "Если"),
            Self::Otherwise => ("Otherwise", "Иначе"),
            Self::Depending => ("Depending on", "В зависимости от"),
            Self::Case => ("if it is", "если это"),
            Self::Forever => ("For ever", "Всегда"),
            Self::While => ("While", "Пока"),
            Self::Times => ("Repeat, times:", "Повторить, раз:"),
            Self::Until => ("and again while", "и снова, пока"),
            Self::Repeat => ("Repeat", "Повторять"),
            Self::Leave => ("Leave the loop", "Выйти из цикла"),
            Self::Again => ("Begin the loop anew", "Начать цикл снова"),
            Self::End => ("End", "Конец"),
            Self::And => ("and", "и"),
            Self::Or => ("or", "или"),
            Self::Not => ("not", "не"),
            Self::Place => ("place", "место"),
            Self::Begin => ("Begin the thread", "Запустить поток"),
            Self::Answered => ("there is an answer to", "есть ответ на"),
        };
        match locale {
            Locale::English => english,
            Locale::Russian => russian,
        }
    }
}
