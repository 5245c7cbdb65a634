//! Expressions and statements between the diagram and the languages: what is computed and told, with types, in no
//! language.
//!
//! Owns the list of everything that a language must be able to say ([`What`]); each dialect has one row for each, but for
//! commands of blocks, whose words stand in the row of the block.

use crate::blocks::act::Phrase;
use std::rc::Rc;

/// What is known of a value before the program runs.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(super) enum Kind {
    /// Nothing is known.
    Any,
    Bool,
    Int,
    Float,
    Text,
    List(Box<Kind>),
}

impl Kind {
    /// What a variable is that may be both.
    pub(super) fn or(&self, other: &Self) -> Self {
        match (self, other) {
            (one, two) if one == two => one.clone(),
            (Self::Int, Self::Float) | (Self::Float, Self::Int) => Self::Float,
            // An empty table.
            (Self::List(one), Self::List(two)) if **two == Self::Any => Self::List(one.clone()),
            (Self::List(one), Self::List(two)) if **one == Self::Any => Self::List(two.clone()),
            (Self::List(one), Self::List(two)) => Self::List(Box::new(one.or(two))),
            _ => Self::Any,
        }
    }
}

/// A command of a block, as its row has it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct Command {
    /// Its words in each language.
    pub(super) phrase: &'static Phrase,
    /// What messages call the block.
    pub(super) english: &'static str,
    pub(super) russian: &'static str,
    /// Whether a program is still one without it.
    pub(super) is_dispensable: bool,
}

/// Everything that is said with operands; the comment names them.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum What {
    // Numbers: left, right.
    Add,
    Subtract,
    Multiply,
    /// The right one may be 0, which ends the thread.
    Divide,
    /// The right one is not 0.
    DividePlain,
    /// Whole numbers, cut towards 0.
    DivideWhole,
    Modulo,
    Power,
    Negate,
    /// Through a float of 32 bits, as the original does.
    NegateSingle,
    BitAnd,
    BitOr,
    BitXor,
    BitNot,
    ShiftLeft,
    ShiftRight,
    // Truths.
    Not,
    And,
    Or,
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    /// Of numbers or truths.
    Equal,
    NotEqual,
    EqualText,
    NotEqualText,
    /// Of anything.
    EqualAny,
    NotEqualAny,
    // Texts.
    Join,
    Length,
    // Conversions: a value.
    /// A whole number where languages with types want another one.
    FloatOfInt,
    WholeOfFloat,
    WholeOfBool,
    WholeOfAny,
    NumberOfAny,
    TruthOfAny,
    TextOfInt,
    TextOfFloat,
    TextOfBool,
    TextOfAny,
    /// As a label shows it: numbers with at most six decimals.
    Printed,
    /// The text of a message as a value.
    ValueOf,
    // Functions of the language.
    Sin,
    Cos,
    Ln,
    Exp,
    Asin,
    Acos,
    Atan,
    Sqrt,
    Abs,
    Sgn,
    Ceil,
    Floor,
    Min,
    Max,
    Atan2,
    Pi,
    Time,
    /// low, high
    Random,
    // Tables.
    /// table, index: nothing beyond the end
    At,
    /// The same in a table of whole numbers.
    AtWhole,
    /// table, index: there is such a whole number
    AtPlain,
    /// table, index, value
    Put,
    Copy,
    // Readings.
    /// port
    Sensor,
    /// port
    Encoder,
    Gyroscope,
    Accelerometer,
    LineSensor,
    ObjectSensor,
    ColorSensor,
    Lidar,
    /// code
    Button,
    /// The code of any button, or -1.
    AnyButton,
    /// number
    PadButton,
    /// number
    PadX,
    /// number
    PadY,
    /// number
    PadPressed,
    Wheel,
    GamepadConnected,
    /// Nothing if there is none.
    Mail,
    // Commands.
    /// port, percent
    SetPower,
    /// port
    PowerOff,
    /// port, degrees
    Servo,
    /// port
    ResetEncoder,
    /// What the row of its block says.
    Command(Command),
    /// anything
    Print,
    Redraw,
    /// ms
    Wait,
    /// Everything to rest, at the end of the program.
    Finish,
    // Threads.
    /// name, function
    StartThread,
    /// name
    JoinThread,
    /// name
    KillThread,
    /// name, text
    SendThread,
    /// Waits.
    ReceiveThread,
    /// An empty text if there is none.
    ReceiveThreadNow,
    /// counter, count: whether a loop with a shared counter goes on
    Again,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Code {
    Int(i64),
    Float(f64),
    Bool(bool),
    Text(Rc<str>),
    Nil,
    /// A port by its name.
    Port(Rc<str>),
    /// A variable by its number.
    Variable(usize),
    /// A variable of the generator: what it is for, and a number.
    Own(Own, usize),
    /// A function of the program, as a value.
    Function(usize),
    Do(What, Vec<Code>),
    List(Vec<Code>),
}

/// What a variable of the generator is for.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub(super) enum Own {
    /// Counts the rounds of a loop.
    Counter,
    /// Says where the program is.
    State,
    /// A value that is used twice.
    Value,
}

/// An expression and what it gives.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Typed {
    pub(super) code: Code,
    pub(super) kind: Kind,
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Statement {
    Comment(String),
    Do(Code),
    Set(Code, Code),
    /// A function of the program with arguments.
    Call {
        function: usize,
        arguments: Vec<Code>,
    },
    If(Code, Vec<Statement>, Vec<Statement>),
    /// Compares a text with guards.
    Switch {
        on: Code,
        branches: Vec<(Vec<Rc<str>>, Vec<Statement>)>,
        other: Vec<Statement>,
    },
    /// Compares a variable of the generator with numbers.
    Choice {
        on: Code,
        arms: Vec<(usize, Vec<Statement>)>,
    },
    Loop {
        label: usize,
        body: Vec<Statement>,
    },
    While {
        label: usize,
        when: Code,
        body: Vec<Statement>,
    },
    DoWhile {
        label: usize,
        body: Vec<Statement>,
        when: Code,
    },
    /// So many times.
    Repeat {
        label: usize,
        counter: usize,
        times: Code,
        body: Vec<Statement>,
    },
    Break(usize),
    Continue(usize),
    Return,
    Goto(usize),
    Label(usize),
}

impl Code {
    /// Says something with operands.
    pub(super) fn does(what: What, operands: impl Into<Vec<Code>>) -> Self {
        Self::Do(what, operands.into())
    }

    /// Whether any part is as asked.
    pub(super) fn has(&self, asked: &mut dyn FnMut(&Code) -> bool) -> bool {
        asked(self)
            || match self {
                Self::Do(_, parts) | Self::List(parts) => parts.iter().any(|part| part.has(asked)),
                _ => false,
            }
    }

    /// Whether it may give something else when it is computed again at once, or does something.
    pub(super) fn is_fickle(&self) -> bool {
        self.has(&mut |part| {
            use What::{AnyButton, Button, Mail, Print, Random, ReceiveThread, Time};
            matches!(
                part,
                Self::Do(
                    Random | Time | Print | Mail | AnyButton | Button | ReceiveThread,
                    _
                )
            )
        })
    }
}
