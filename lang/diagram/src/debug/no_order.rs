//! Why a text is no order to a debugger.
//!
//! Owns the words with which orders begin, and what an order may lack. What a person is told of it is said by `words`.

/// Why a text is no order.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NoOrder {
    /// No order begins with this word.
    Unknown(Box<str>),
    /// The order lacks something.
    Lacks(Wanted),
    /// This word cannot be there.
    Strange(Box<str>),
    /// It is longer than an order may be.
    TooLong,
}

/// What an order may lack.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Wanted {
    /// The id of a block.
    Block,
    /// The name of a variable.
    Variable,
    /// The name of a thread.
    Thread,
    /// The number of a breakpoint.
    Number,
    /// How many hits a breakpoint lets pass.
    Hits,
    /// What a breakpoint stops on.
    Condition,
    /// What a breakpoint says.
    Line,
    /// A time of the program.
    Time,
    /// A variable and its value.
    Assignment,
    /// An expression.
    Expression,
}

/// All words with which orders begin.
pub const WORDS: &str = "attach, detach, look, pause, continue, step, until, back, present, hold, release, break, watch, \
    clear, enable, disable, breakpoints, errors, motors, set, evaluate";
