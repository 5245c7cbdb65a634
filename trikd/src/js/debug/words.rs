//! What a debugger of JavaScript says to a person, in English and Russian.

use crate::protocol::news;
use lang_text::problem::Words;

/// Why most orders are refused.
pub(super) fn never() -> Words {
    Words::new(
        news::NOT_IN_JAVASCRIPT,
        "программу на JavaScript можно только приостановить, продолжить и остановить на ошибке: точек останова, \
         шагов и просмотра переменных нет; пусть программа их печатает",
    )
}
