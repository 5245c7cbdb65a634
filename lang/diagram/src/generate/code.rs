//! Expressions and statements between the diagram and the languages: what is computed and told, with types, in no
//! language.
//!
//! Owns the list of everything that a language must be able to say ([`Operation`]); each dialect has a table for each
//! group of it. Words of commands stand in the rows of blocks, and words of readings in those of `readings`.

use super::readings::Reading;
use crate::blocks::act::Phrase;
use crate::program::Node;
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

/// Everything that is said with operands: an operator, a function, a command or a reading.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Operation {
    Number(Number),
    Truth(Truth),
    Conversion(Conversion),
    Function(Function),
    Element(Element),
    Robot(Robot),
    Turn(Turn),
    /// What a device says; its row has the operand.
    Read(&'static Reading),
    /// What the row of a block says.
    Command(Command),
}

/// Operators on numbers: left, right.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Number {
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
}

/// Operators that give a truth: left, right.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Truth {
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
    /// counter, count: whether a loop with a shared counter goes on
    Again,
}

/// From one kind of value to another, and what only texts have.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Conversion {
    /// left, right
    Join,
    Length,
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
}

/// Functions of the language of expressions.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Function {
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
}

/// Elements of tables, and whole tables.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Element {
    /// table, index: nothing beyond the end
    At,
    /// The same in a table of whole numbers.
    AtWhole,
    /// table, index: there is such a whole number
    AtPlain,
    /// table, index, value
    Put,
    Copy,
}

/// What is known of the number that an operation gives.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Wholeness {
    /// It is whole.
    Whole,
    /// It is whole if all operands are.
    LikeOperands,
    /// It may have a fraction, or be no number at all.
    Unknown,
}

/// What the robot is told and no row of a block says.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Robot {
    /// port, percent
    SetPower,
    /// port
    PowerOff,
    /// port, degrees
    Servo,
    /// port
    ResetEncoder,
    /// anything
    Print,
    Redraw,
    /// Everything to rest, at the end of the program.
    Finish,
}

/// Waits, and threads: where another thread may run.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Turn {
    /// ms
    Wait,
    /// whether to wait: the code of any button, or -1
    AnyButton,
    /// whether to wait: a message of another robot, nothing if there is none
    Mail,
    /// name, function
    Start,
    /// name
    Join,
    /// name
    Kill,
    /// name, text
    Send,
    /// Waits.
    Receive,
    /// An empty text if there is none.
    ReceiveNow,
}

macro_rules! operations {
    ($($group:ident)*) => {
        $(impl From<$group> for Operation {
            fn from(operation: $group) -> Self {
                Self::$group(operation)
            }
        })*
    };
}

operations! { Number Truth Conversion Function Element Robot Turn Command }

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
    Do(Operation, Vec<Code>),
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
    /// What follows in the list, until the next of these, says these blocks. It is no word of any language.
    From(Vec<Node>),
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

/// Shows every expression of a list, and of the lists in it.
pub(super) fn each_code(list: &[Statement], seen: &mut dyn FnMut(&Code)) {
    let mut every = |code: &Code| {
        code.has(&mut |part| {
            seen(part);
            false
        });
    };
    for statement in list {
        match statement {
            Statement::Do(code)
            | Statement::If(code, ..)
            | Statement::While { when: code, .. }
            | Statement::DoWhile { when: code, .. }
            | Statement::Switch { on: code, .. }
            | Statement::Repeat { times: code, .. } => every(code),
            Statement::Set(target, value) => {
                every(target);
                every(value);
            }
            Statement::Call { arguments, .. } => arguments.iter().for_each(&mut every),
            Statement::Choice { on, .. } => every(on),
            Statement::From(_)
            | Statement::Comment(_)
            | Statement::Loop { .. }
            | Statement::Break(_)
            | Statement::Continue(_)
            | Statement::Return
            | Statement::Goto(_)
            | Statement::Label(_) => {}
        }
    }
    for part in list.iter().flat_map(Statement::parts) {
        each_code(part, seen);
    }
}

impl Code {
    /// Says something with operands.
    pub(super) fn does(operation: impl Into<Operation>, operands: impl Into<Vec<Code>>) -> Self {
        Self::Do(operation.into(), operands.into())
    }

    /// Whether any part is as asked.
    pub(super) fn has(&self, asked: &mut dyn FnMut(&Code) -> bool) -> bool {
        asked(self)
            || match self {
                Self::Do(_, parts) | Self::List(parts) => parts.iter().any(|part| part.has(asked)),
                Self::Int(_)
                | Self::Float(_)
                | Self::Bool(_)
                | Self::Text(_)
                | Self::Nil
                | Self::Port(_)
                | Self::Variable(_)
                | Self::Own(..)
                | Self::Function(_) => false,
            }
    }

    /// Whether it may give something else when it is computed again at once, or does something.
    pub(super) fn is_fickle(&self) -> bool {
        self.has(&mut |part| matches!(part, Self::Do(operation, _) if operation.is_fickle()))
    }
}

impl Operation {
    fn is_fickle(self) -> bool {
        match self {
            Self::Function(function) => matches!(function, Function::Random | Function::Time),
            Self::Robot(told) => matches!(told, Robot::Print),
            Self::Turn(turn) => matches!(turn, Turn::Mail | Turn::AnyButton | Turn::Receive),
            Self::Read(reading) => reading.is_fickle,
            Self::Number(_)
            | Self::Truth(_)
            | Self::Conversion(_)
            | Self::Element(_)
            | Self::Command(_) => false,
        }
    }

    /// What is known of the number that it gives.
    pub(super) fn wholeness(self) -> Wholeness {
        match self {
            Self::Number(number) => number.wholeness(),
            Self::Conversion(conversion) => match conversion {
                Conversion::Length
                | Conversion::WholeOfFloat
                | Conversion::WholeOfBool
                | Conversion::WholeOfAny => Wholeness::Whole,
                Conversion::Join
                | Conversion::FloatOfInt
                | Conversion::NumberOfAny
                | Conversion::TruthOfAny
                | Conversion::TextOfInt
                | Conversion::TextOfFloat
                | Conversion::TextOfBool
                | Conversion::TextOfAny
                | Conversion::Printed
                | Conversion::ValueOf => Wholeness::Unknown,
            },
            Self::Function(Function::Random | Function::Time)
            | Self::Element(Element::AtPlain)
            | Self::Turn(Turn::AnyButton) => Wholeness::Whole,
            Self::Read(reading) if reading.is_whole() => Wholeness::Whole,
            Self::Truth(_)
            | Self::Function(_)
            | Self::Element(_)
            | Self::Robot(_)
            | Self::Turn(_)
            | Self::Read(_)
            | Self::Command(_) => Wholeness::Unknown,
        }
    }
}

impl Number {
    fn wholeness(self) -> Wholeness {
        match self {
            Self::Add | Self::Subtract | Self::Multiply | Self::Negate => Wholeness::LikeOperands,
            Self::DivideWhole
            | Self::Modulo
            | Self::BitAnd
            | Self::BitOr
            | Self::BitXor
            | Self::BitNot
            | Self::ShiftLeft
            | Self::ShiftRight => Wholeness::Whole,
            Self::Divide | Self::DividePlain | Self::Power | Self::NegateSingle => {
                Wholeness::Unknown
            }
        }
    }
}

impl Truth {
    /// What is true where this is false, with the same operands. Numbers that may be none have no order, so only whole
    /// ones are surely greater where they are not less.
    pub(super) fn opposite(self, is_whole: bool) -> Option<Self> {
        Some(match self {
            Self::Equal => Self::NotEqual,
            Self::NotEqual => Self::Equal,
            Self::EqualText => Self::NotEqualText,
            Self::NotEqualText => Self::EqualText,
            Self::EqualAny => Self::NotEqualAny,
            Self::NotEqualAny => Self::EqualAny,
            Self::Less if is_whole => Self::GreaterEqual,
            Self::Greater if is_whole => Self::LessEqual,
            Self::LessEqual if is_whole => Self::Greater,
            Self::GreaterEqual if is_whole => Self::Less,
            Self::Less
            | Self::Greater
            | Self::LessEqual
            | Self::GreaterEqual
            | Self::Not
            | Self::And
            | Self::Or
            | Self::Again => return None,
        })
    }
}
