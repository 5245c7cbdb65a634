//! What a debugger says to a person, in English and Russian: why an order is not carried out.
//!
//! Owns the words. What is wrong with an expression is said by the language of expressions.

use lang_text::problem::Words;

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
        "this is the past: go to the present first",
        "это прошлое: сначала вернитесь в настоящее",
    )
}

pub(super) fn not_attached() -> Words {
    Words::new("attach the debugger first", "сначала подключите отладчик")
}

pub(super) fn not_stopped() -> Words {
    Words::new("the program is not stopped", "программа не остановлена")
}

pub(super) fn ended() -> Words {
    Words::new(
        "the program has ended, and does nothing more: look at its past, where breakpoints stop too, or start it again",
        "программа закончилась и больше ничего не делает: посмотрите её прошлое, где точки останова тоже действуют, или \
         запустите её снова",
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

pub(super) fn held(name: &str) -> Words {
    Words::new(
        format!("the thread '{name}' is held: release it first"),
        format!("поток '{name}' задержан: сначала отпустите его"),
    )
}
