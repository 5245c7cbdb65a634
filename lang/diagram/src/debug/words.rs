//! What a debugger says to a person, in English and Russian: why an order is not carried out.
//!
//! Owns the words. What is wrong with an expression is said by the language of expressions.

use super::no_order::{NoOrder, WORDS, Wanted};
use crate::limits;
use lang_text::problem::Words;
use std::fmt;

impl NoOrder {
    /// For a person.
    pub fn words(&self) -> Words {
        no_order(self)
    }
}

impl fmt::Display for NoOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words().english)
    }
}

/// Why a text is no order.
fn no_order(why: &NoOrder) -> Words {
    match why {
        NoOrder::Unknown(word) => Words::new(
            format!("'{word}' is no order; orders are {WORDS}"),
            format!("'{word}' - не распоряжение; распоряжения: {WORDS}"),
        ),
        NoOrder::Lacks(what) => {
            let [english, russian] = wanted(*what);
            Words::new(
                format!("this order needs {english}"),
                format!("в этом распоряжении нужно указать {russian}"),
            )
        }
        NoOrder::Strange(word) => Words::new(
            format!("'{word}' cannot be in this order"),
            format!("в этом распоряжении не может быть '{word}'"),
        ),
        NoOrder::TooLong => {
            let most = limits::ORDER_BYTES_MAX;
            Words::new(
                format!("an order has at most {most} bytes"),
                format!("в распоряжении не больше {most} байт"),
            )
        }
    }
}

fn wanted(what: Wanted) -> [&'static str; 2] {
    match what {
        Wanted::Block => ["the id of a block", "id блока"],
        Wanted::Variable => ["the name of a variable", "имя переменной"],
        Wanted::Thread => ["the name of a thread", "имя потока"],
        Wanted::Number => ["the number of a breakpoint", "номер точки останова"],
        Wanted::Hits => [
            "a number of hits from 1 on after `from`, such as from 5",
            "число срабатываний от 1 после `from`, например from 5",
        ],
        Wanted::Condition => [
            "a condition after `if`, such as if n > 3",
            "условие после `if`, например if n > 3",
        ],
        Wanted::Line => [
            "a text after `log`, such as log n is {n}",
            "текст после `log`, например log n = {n}",
        ],
        Wanted::Time => ["a time in milliseconds", "время в миллисекундах"],
        Wanted::Assignment => ["NAME=EXPRESSION", "ИМЯ=ВЫРАЖЕНИЕ"],
        Wanted::Expression => ["an expression", "выражение"],
    }
}

pub(super) fn no_such_block() -> Words {
    Words::new(
        "the program has no such block",
        "в программе нет такого блока",
    )
}

pub(super) fn too_many_breakpoints(most: usize) -> Words {
    Words::new(
        format!("there are {most} breakpoints already, which is all that can be"),
        format!("точек останова уже {most}, больше нельзя"),
    )
}

pub(super) fn too_many_watches(most: usize) -> Words {
    Words::new(
        format!("{most} variables are watched already, which is all that can be"),
        format!("наблюдаемых переменных уже {most}, больше нельзя"),
    )
}

pub(super) fn condition_too_long(most: usize) -> Words {
    Words::new(
        format!("a condition or a line has at most {most} bytes"),
        format!("в условии и в строке не больше {most} байт"),
    )
}

/// Before what is wrong with it.
pub(super) fn watched() -> Words {
    Words::new("this cannot be watched", "за этим нельзя наблюдать")
}

/// Before what is wrong with it.
pub(super) fn condition() -> Words {
    Words::new("the condition", "условие")
}

/// Before what is wrong with it.
pub(super) fn line() -> Words {
    Words::new("the line", "строка")
}

pub(super) fn not_kept() -> Words {
    Words::new(
        "the past of this program is not kept",
        "прошлое этой программы не сохраняется",
    )
}

pub(super) fn runs() -> Words {
    Words::new(
        "the program runs: pause it first",
        "программа выполняется: сначала остановите её",
    )
}

pub(super) fn at_oldest() -> Words {
    Words::new(
        "this is the first moment that is kept",
        "это самый ранний из сохранённых моментов",
    )
}

pub(super) fn not_yet() -> Words {
    Words::new(
        "the program has not come to that time",
        "до этого времени программа ещё не дошла",
    )
}

pub(super) fn past() -> Words {
    Words::new(
        "a debugger looks at the past: come back to the present first, by `present` or by going on",
        "отладчик показывает прошлое: сначала вернитесь в настоящее командой `present` или продолжите программу",
    )
}

/// What an order answers that needs the debugger.
pub fn not_attached() -> Words {
    Words::new("attach the debugger first", "сначала подключите отладчик")
}

pub(super) fn not_stopped() -> Words {
    Words::new("the program is not stopped", "программа не остановлена")
}

pub(super) fn ended() -> Words {
    Words::new(
        "the program has ended, and does nothing more: look at its past, where breakpoints stop too, or end the debugger and begin anew",
        "программа закончилась и больше ничего не делает: посмотрите её прошлое, где точки останова тоже действуют, или \
         завершите отладчик и начните заново",
    )
}

pub(super) fn no_breakpoint(number: Option<u32>) -> Words {
    match number {
        Some(number) => Words::new(
            format!("there is no breakpoint {number}"),
            format!("точки останова {number} нет"),
        ),
        None => Words::new("there is no breakpoint", "точек останова нет"),
    }
}

pub(super) fn no_thread() -> Words {
    Words::new("no thread lives", "ни один поток не выполняется")
}

pub(super) fn no_such_thread(name: &str, there: &[Box<str>]) -> Words {
    if there.is_empty() {
        return Words::new(
            format!("there is no thread '{name}': no thread lives"),
            format!("потока '{name}' нет: ни один поток не выполняется"),
        );
    }
    let there = there.join(", ");
    Words::new(
        format!("there is no thread '{name}'; threads are {there}"),
        format!("потока '{name}' нет; потоки: {there}"),
    )
}

pub(super) fn not_held(name: &str) -> Words {
    Words::new(
        format!("the thread '{name}' is not held"),
        format!("поток '{name}' не задержан"),
    )
}

pub(super) fn all_held() -> Words {
    Words::new(
        "all threads are held, so none would go on: release one first",
        "все потоки задержаны, ни один не продолжится: сначала отпустите какой-нибудь",
    )
}

pub(super) fn held(name: &str) -> Words {
    Words::new(
        format!("the thread '{name}' is held: release it first"),
        format!("поток '{name}' задержан: сначала отпустите его"),
    )
}
