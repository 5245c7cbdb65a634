//! What can be wrong with an expression, and the words for it in English and in Russian.
//!
//! English sentences begin as the real program's do, so that its reports can be compared; what to do follows.

use crate::limits;
use crate::names::written;
use crate::value::float_text;
use lang_text::problem::{Place, Position, Problem, Severity, Words};

/// In which step it was found.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Stage {
    /// Characters.
    Lexical,
    /// Grammar.
    Syntax,
    /// Types and names.
    Semantic,
    /// While it ran.
    Runtime,
}

/// What a token that cannot stand in its place may be meant for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Meant {
    /// Nobody knows.
    Unknown,
    /// This sign, of which it is a part.
    Sign(&'static str),
    /// What blocks do, and words of the language elsewhere.
    Block,
}

/// Which types do not fit in an assignment, as far as they are known.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Clash {
    /// The variable that is assigned, or whose element is.
    pub name: String,
    /// Whether it is an element.
    pub is_element: bool,
    /// The types that it has.
    pub had: String,
    /// Those of the value.
    pub given: String,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// Longer than `limits::EXPRESSION_TEXT_MAX`.
    TextTooLong,
    /// Characters that begin nothing.
    UnknownSymbols(String),
    /// A token that cannot stand here, as it is written.
    UnexpectedToken(String, Meant),
    /// The text ends too early.
    UnexpectedEnd,
    /// One token was wanted, another one is there.
    Expected(&'static str, &'static str),
    /// One token was wanted and nothing is there. The real program names the last one that is.
    ExpectedAtEnd(&'static str),
    /// `...`
    NotSupportedYet,
    /// Nesting beyond `limits::EXPRESSION_DEPTH_MAX`.
    TooDeep,
    /// `a, b = 1`
    CountsDiffer,
    /// `f(x) = 1`
    AssignToCall,
    /// Names beyond `limits::NAMES_MAX`.
    TooManyNames,
    /// The name of a function where a variable should be.
    FunctionAsName,
    /// Assigning something that is neither a name nor an element.
    AssignToValue,
    /// Both sides of `=` do not fit.
    Mismatched(Option<Clash>),
    /// In the mode of static languages: a value is made to fit its variable of this type.
    ImplicitCast(String),
    /// An operand or argument of the wrong type.
    TypeMismatch,
    /// The same, told of each expression whose type has become impossible.
    NoType,
    /// More than one type is possible.
    CannotDeduce(String),
    /// A name on a right side that was never assigned.
    Undeclared(String),
    /// A name that cannot be assigned.
    ReadOnly(String),
    /// A call of something that has no name.
    IndirectCall,
    /// A call of an unknown name.
    UnknownFunction,
    /// So many were expected.
    TooManyArguments(usize),
    /// So many were expected.
    TooFewArguments(usize),
    /// The grammar has it, nothing else understands it.
    NotAnalysed,
    /// A whole number that does not fit in 32 bits, or not in its base; it counts as this value.
    OddNumber(String, f64),
    /// A number that a block wants whole, and that does not fit in 32 bits.
    OutOfRange(f64),
    /// `/`, `//` and `%`.
    DivisionByZero,
    /// `random(0)`.
    RandomOfNothing,
    /// A variable without a value.
    Uninitialized(String),
    /// An index below 0.
    NegativeIndex,
    /// What should be a number is none; only where names are strict.
    NoNumber(String),
    /// The index of a table is not known to be a number.
    IndexNotNumber,
    /// Elements of something that has no name.
    IndexOfValue,
    /// The key in `{[key] = value}` is not known to be a number.
    KeyNotNumber,
    /// Nothing can run this.
    NotInterpreted,
    /// A table or text beyond the limits.
    ValueTooLong,
    /// Tables in tables beyond `limits::LIST_DEPTH_MAX`.
    ValueTooDeep,
    /// All variables together beyond `limits::STORE_CELLS_MAX`.
    StoreFull,
    /// More work than one expression may make.
    TooMuchWork,
}

/// What is wrong, in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Why.
    pub reason: Reason,
    /// Where in the text.
    pub at: Position,
}

impl Fault {
    /// Something wrong at a place.
    pub fn new(reason: Reason, at: Position) -> Self {
        Self { reason, at }
    }

    /// As a problem for people; the caller knows block and property.
    pub fn problem(&self) -> Problem {
        Problem {
            severity: self.reason.severity(),
            place: Place {
                position: Some(self.at),
                ..Place::default()
            },
            words: self.reason.words(),
            hint: None,
        }
    }
}

impl Reason {
    /// In which step it is found.
    pub fn stage(&self) -> Stage {
        match self {
            Self::TextTooLong | Self::UnknownSymbols(_) => Stage::Lexical,
            Self::UnexpectedToken(..)
            | Self::UnexpectedEnd
            | Self::Expected(..)
            | Self::ExpectedAtEnd(_)
            | Self::NotSupportedYet
            | Self::TooDeep
            | Self::CountsDiffer
            | Self::AssignToCall => Stage::Syntax,
            Self::TooManyNames
            | Self::FunctionAsName
            | Self::AssignToValue
            | Self::Mismatched(_)
            | Self::ImplicitCast(_)
            | Self::TypeMismatch
            | Self::NoType
            | Self::CannotDeduce(_)
            | Self::Undeclared(_)
            | Self::ReadOnly(_)
            | Self::IndirectCall
            | Self::UnknownFunction
            | Self::TooManyArguments(_)
            | Self::TooFewArguments(_)
            | Self::NotAnalysed
            | Self::OddNumber(..)
            | Self::OutOfRange(_) => Stage::Semantic,
            Self::DivisionByZero
            | Self::RandomOfNothing
            | Self::Uninitialized(_)
            | Self::NegativeIndex
            | Self::NoNumber(_)
            | Self::IndexNotNumber
            | Self::IndexOfValue
            | Self::KeyNotNumber
            | Self::NotInterpreted
            | Self::ValueTooLong
            | Self::ValueTooDeep
            | Self::StoreFull
            | Self::TooMuchWork => Stage::Runtime,
        }
    }

    /// Whether the text can be run all the same.
    pub fn severity(&self) -> Severity {
        if let Self::ImplicitCast(_) | Self::OddNumber(..) = self {
            return Severity::Warning;
        }
        Severity::Error
    }

    /// Its words: those of the real program, where it has any.
    pub fn real(&self) -> String {
        match self {
            Self::TextTooLong => "The text is too long".into(),
            Self::UnknownSymbols(text) => format!("Unknown sequence of symbols: {}", short(text)),
            Self::UnexpectedToken(..) => "Unexpected token".into(),
            Self::UnexpectedEnd => "Unexpected end of input".into(),
            Self::Expected(wanted, got) => format!("Expected \"{wanted}\", got \"{got}\""),
            Self::ExpectedAtEnd(wanted) => {
                format!("Expected \"{wanted}\", got the end of the text")
            }
            Self::NotSupportedYet => "This construction is not supported yet".into(),
            Self::TooDeep => "The expression is nested too deeply".into(),
            Self::CountsDiffer => {
                "Number of variables in assignment shall be equal to the number of assigned values"
                    .into()
            }
            Self::AssignToCall => "Assignment to function call is impossible".into(),
            Self::TooManyNames => "Too many different names".into(),
            Self::FunctionAsName => "Intrinsic function used as an identifier".into(),
            Self::AssignToValue => {
                "Incorrect assignment, only variables and tables can be assigned to.".into()
            }
            Self::Mismatched(_) => "Left and right operand have mismatched types.".into(),
            Self::ImplicitCast(kind) => format!(
                "An attempt will be made to implicitly cast the right operand to the type '{kind}'"
            ),
            Self::TypeMismatch => "Type mismatch.".into(),
            Self::NoType => "Type mismatch".into(),
            Self::CannotDeduce(kinds) => {
                format!("Can not deduce type, expression can be of following types: {kinds}")
            }
            Self::Undeclared(name) => format!("Undeclared identifier: {}", short(written(name))),
            Self::ReadOnly(name) => format!("Variable {} is read-only", short(written(name))),
            Self::IndirectCall => "Indirect function calls are not supported".into(),
            Self::UnknownFunction => "Unknown function".into(),
            Self::TooManyArguments(count) => format!("Too many parameters, {count} expected"),
            Self::TooFewArguments(count) => format!("Not enough parameters, {count} expected"),
            Self::NotAnalysed => "This construction is not supported by semantic analysis".into(),
            Self::OddNumber(text, value) => format!("The number {} counts as {value}", short(text)),
            Self::OutOfRange(number) => out_of_range(*number).english,
            Self::DivisionByZero => "Division by zero".into(),
            Self::RandomOfNothing => "random(0) has no numbers to choose from".into(),
            Self::Uninitialized(name) => {
                format!(
                    "Seems like accessing an uninitialized variable {}",
                    short(written(name))
                )
            }
            Self::NegativeIndex => "Negative index for a table".into(),
            Self::NoNumber(what) => format!("A number is needed, and this is {}", short(what)),
            Self::IndexNotNumber => {
                "Currently interpreter allows only tables denoted by identifier \
                                     and by integer expression index, as in 'a[1 + 2][3]'"
                    .into()
            }
            Self::IndexOfValue => {
                "Tables denoted by something other than identifier (like f(x)[0]) \
                                   are not allowed"
                    .into()
            }
            Self::KeyNotNumber => {
                "Explicit table indexes of non-integer type are not supported".into()
            }
            Self::NotInterpreted => "This construction is not supported by interpreter".into(),
            Self::ValueTooLong => "The value is too long".into(),
            Self::ValueTooDeep => "Too many tables in tables".into(),
            Self::StoreFull => "The variables hold too much".into(),
            Self::TooMuchWork => "The expression makes too much work".into(),
        }
    }

    /// What to do about it, in English; may be empty.
    fn advice(&self) -> String {
        match self {
            Self::TextTooLong => {
                format!(": at most {} bytes; divide it among several blocks.", limits::EXPRESSION_TEXT_MAX)
            }
            Self::UnknownSymbols(text) if text.starts_with(['"', '\'']) => {
                ". Is the closing quote missing?".into()
            }
            Self::UnknownSymbols(text) if text.starts_with('!') => ". Write 'not' instead of '!'.".into(),
            Self::UnexpectedToken(text, may_be) => {
                format!(". {} cannot stand here.{}", quoted(text), meant(*may_be).english)
            }
            Self::UnexpectedEnd => ". Something is missing after this.".into(),
            Self::TooDeep => {
                format!(": at most {} levels; use variables for parts of it.", limits::EXPRESSION_DEPTH_MAX)
            }
            Self::TooManyNames => format!(": at most {} in a project.", limits::NAMES_MAX),
            Self::Undeclared(_) => ". Give it a value first.".into(),
            Self::Uninitialized(_) => ". Give it a value before it is used.".into(),
            Self::UnknownFunction => ". The functions are: abs, acos, asin, atan, atan2, ceil, cos, exp, \
                                      floor, ln, max, min, print, random, sensor, sgn, sin, sqrt, time."
                .into(),
            Self::ReadOnly(_) => ": it belongs to the robot. Choose another name.".into(),
            Self::OddNumber(..) => ". Numbers go up to 2147483647, and a 0 in front means base 8.".into(),
            Self::OutOfRange(_) => format!(": {} to {}.", i32::MIN, i32::MAX),
            Self::RandomOfNothing => ". Give it at least 1.".into(),
            Self::ValueTooLong => format!(
                ": a table has at most {} elements, a text at most {} bytes.",
                limits::LIST_MAX,
                limits::TEXT_MAX
            ),
            Self::ValueTooDeep => format!(": at most {}.", limits::LIST_DEPTH_MAX),
            Self::StoreFull => ". Does a table or text grow without end?".into(),
            Self::TooMuchWork => ". Are very long tables compared or copied?".into(),
            Self::UnknownSymbols(_)
            | Self::Expected(..)
            | Self::ExpectedAtEnd(_)
            | Self::NotSupportedYet
            | Self::CountsDiffer
            | Self::AssignToCall
            | Self::FunctionAsName
            | Self::AssignToValue
            | Self::Mismatched(_)
            | Self::ImplicitCast(_)
            | Self::TypeMismatch
            | Self::NoType
            | Self::CannotDeduce(_)
            | Self::IndirectCall
            | Self::TooManyArguments(_)
            | Self::TooFewArguments(_)
            | Self::NotAnalysed
            | Self::DivisionByZero
            | Self::NegativeIndex
            | Self::NoNumber(_)
            | Self::IndexNotNumber
            | Self::IndexOfValue
            | Self::KeyNotNumber
            | Self::NotInterpreted => String::new(),
        }
    }

    /// In both languages.
    pub fn words(&self) -> Words {
        Words::new(self.real() + &self.advice(), self.russian())
    }

    fn russian(&self) -> String {
        match self {
            Self::TextTooLong => format!(
                "Текст слишком длинный: не больше {} байт; разделите его на несколько блоков.",
                limits::EXPRESSION_TEXT_MAX
            ),
            Self::UnknownSymbols(text) => unknown_in_russian(text),
            Self::UnexpectedToken(text, may_be) => {
                format!("Неожиданная лексема. {} здесь не может стоять.{}", quoted(text), meant(*may_be).russian)
            }
            Self::UnexpectedEnd => "Текст неожиданно кончился: после этого места чего-то не хватает".into(),
            Self::Expected(wanted, got) => {
                format!("Здесь нужно «{}», а стоит «{}»", token(wanted), token(got))
            }
            Self::ExpectedAtEnd(wanted) => {
                format!("Текст кончился, а не хватает «{}»", token(wanted))
            }
            Self::NotSupportedYet | Self::NotAnalysed | Self::NotInterpreted => {
                "Такая запись не поддерживается".into()
            }
            Self::TooDeep => format!(
                "Слишком большая вложенность: не больше {} уровней; вынесите части в переменные.",
                limits::EXPRESSION_DEPTH_MAX
            ),
            Self::CountsDiffer => "Слева и справа от «=» должно быть поровну переменных и значений".into(),
            Self::AssignToCall => "Вызову функции нельзя присвоить значение".into(),
            Self::TooManyNames => {
                format!("Слишком много разных имён: не больше {} на проект.", limits::NAMES_MAX)
            }
            Self::FunctionAsName => "Имя встроенной функции использовано как переменная".into(),
            Self::AssignToValue => "Присваивать можно только переменной или элементу таблицы.".into(),
            Self::Mismatched(_) => "Левый и правый операнд имеют несовпадающие типы.".into(),
            Self::ImplicitCast(kind) => format!("Значение справа будет приведено к типу «{}»", kinds_in_russian(kind)),
            Self::TypeMismatch => "Несоответствие типов".into(),
            Self::NoType => "Неподходящий тип".into(),
            Self::CannotDeduce(kinds) => {
                format!("Не могу вывести тип, это выражение может быть следующих типов: {}", kinds_in_russian(kinds))
            }
            Self::Undeclared(name) => {
                format!("Неизвестная переменная: {}. Сначала дайте ей значение.", short(written(name)))
            }
            Self::ReadOnly(name) => format!(
                "Переменную {} менять нельзя: она принадлежит роботу. Выберите другое имя.",
                short(written(name))
            ),
            Self::IndirectCall => "Вызвать можно только функцию по имени".into(),
            Self::UnknownFunction => "Неизвестная функция. Есть функции abs, acos, asin, atan, atan2, ceil, \
                                      cos, exp, floor, ln, max, min, print, random, sensor, sgn, sin, \
                                      sqrt, time."
                .into(),
            Self::TooManyArguments(count) => format!("Слишком много параметров, нужно: {count}"),
            Self::TooFewArguments(count) => format!("Не хватает параметров, нужно: {count}"),
            Self::OddNumber(text, value) => format!(
                "Число {} будет прочитано как {value}. Наибольшее число 2147483647, а 0 впереди \
                 означает восьмеричную запись.",
                short(text)
            ),
            Self::OutOfRange(number) => out_of_range(*number).russian,
            Self::DivisionByZero
            | Self::RandomOfNothing
            | Self::Uninitialized(_)
            | Self::NegativeIndex
            | Self::NoNumber(_)
            | Self::IndexNotNumber
            | Self::IndexOfValue
            | Self::KeyNotNumber
            | Self::ValueTooLong
            | Self::ValueTooDeep
            | Self::StoreFull
            | Self::TooMuchWork => self.russian_of_running(),
        }
    }

    fn russian_of_running(&self) -> String {
        match self {
            Self::DivisionByZero => "Деление на 0".into(),
            Self::RandomOfNothing => "random(0) не из чего выбирать. Нужно хотя бы 1.".into(),
            Self::Uninitialized(name) => format!(
                "Обращение к неинициализированной переменной {}. Присвойте ей значение до первого использования.",
                short(written(name))
            ),
            Self::NegativeIndex => "Отрицательный номер элемента таблицы".into(),
            Self::NoNumber(what) => format!("Нужно число, а это {}", short(what)),
            Self::IndexNotNumber => {
                "Номер элемента таблицы должен быть числом, как в «a[1 + 2][3]»".into()
            }
            Self::IndexOfValue => {
                "Элемент можно взять только у таблицы с именем, не у «f(x)[0]»".into()
            }
            Self::KeyNotNumber => "Номером элемента таблицы может быть только число".into(),
            Self::ValueTooLong => format!(
                "Слишком длинное значение: в таблице не больше {} элементов, в тексте не больше {} байт.",
                limits::LIST_MAX,
                limits::TEXT_MAX
            ),
            Self::ValueTooDeep => {
                format!(
                    "Слишком много таблиц внутри таблиц: не больше {}.",
                    limits::LIST_DEPTH_MAX
                )
            }
            Self::StoreFull => {
                "Переменные занимают слишком много места. Таблица или текст растёт без конца?"
                    .into()
            }
            Self::TooMuchWork => {
                "Слишком много работы. Сравниваются или копируются очень длинные таблицы?".into()
            }
            // `russian` has the words of these.
            Self::TextTooLong
            | Self::UnknownSymbols(_)
            | Self::UnexpectedToken(..)
            | Self::UnexpectedEnd
            | Self::Expected(..)
            | Self::ExpectedAtEnd(_)
            | Self::NotSupportedYet
            | Self::TooDeep
            | Self::CountsDiffer
            | Self::AssignToCall
            | Self::TooManyNames
            | Self::FunctionAsName
            | Self::AssignToValue
            | Self::Mismatched(_)
            | Self::ImplicitCast(_)
            | Self::TypeMismatch
            | Self::NoType
            | Self::CannotDeduce(_)
            | Self::Undeclared(_)
            | Self::ReadOnly(_)
            | Self::IndirectCall
            | Self::UnknownFunction
            | Self::TooManyArguments(_)
            | Self::TooFewArguments(_)
            | Self::NotAnalysed
            | Self::OddNumber(..)
            | Self::OutOfRange(_)
            | Self::NotInterpreted => String::new(),
        }
    }
}

/// The beginning of a text that may be very long.
pub(super) fn short(text: &str) -> String {
    const SHOWN: usize = 80;
    let mut shown: String = text.chars().take(SHOWN).collect();
    if shown.len() < text.len() {
        shown.push_str("...");
    }
    shown
}

/// A token in quotes, if it has none of its own.
fn quoted(text: &str) -> String {
    match text.starts_with(['"', '\'']) {
        true => short(text),
        false => format!("\"{}\"", short(text)),
    }
}

/// What may be meant, as a sentence after what is wrong.
fn meant(meant: Meant) -> Words {
    match meant {
        Meant::Unknown => Words::new("", ""),
        Meant::Sign(sign) => Words::new(
            format!(" Did you mean '{sign}'?"),
            format!(" Может быть, «{sign}»?"),
        ),
        Meant::Block => Words::new(
            " This word is reserved and stands in no expression: take a block for it, or another name.",
            " Это слово зарезервировано и в выражениях не стоит: возьмите для него блок или другое имя.",
        ),
    }
}

/// A number that no block takes.
fn out_of_range(number: f64) -> Words {
    let number = float_text(number);
    Words::new(
        format!("{number} is beyond the whole numbers that a block takes"),
        format!(
            "{number} не входит в целые числа, которые берёт блок: от {} до {}.",
            i32::MIN,
            i32::MAX
        ),
    )
}

/// Symbols that begin nothing, with what they may be meant for.
fn unknown_in_russian(text: &str) -> String {
    let hint = if text.starts_with(['"', '\'']) {
        ". Нет закрывающей кавычки?"
    } else if text.starts_with('!') {
        ". Вместо «!» пишите «not»."
    } else {
        ""
    };
    format!("Непонятные символы: {}{hint}", short(text))
}

/// A token as Russian messages call it.
fn token(shown: &str) -> &str {
    match shown {
        "identifier" => "имя",
        "integer literal" => "целое число",
        "float literal" => "дробное число",
        "string" => "текст в кавычках",
        other => other,
    }
}

/// Names of types in Russian.
pub(super) fn kinds_in_russian(kinds: &str) -> String {
    let mut text = kinds.to_owned();
    for (english, russian) in [
        ("boolean", "логический"),
        ("integer", "целый"),
        ("float", "вещественный"),
        ("string", "текст"),
        ("table", "таблица"),
        ("function", "функция"),
        ("any", "любой"),
        ("nil", "пусто"),
    ] {
        text = text.replace(english, russian);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_does_not_repeat_a_very_long_name() {
        let words = Reason::Undeclared("x".repeat(10_000)).words();
        assert!(words.english.len() < 200, "{}", words.english);
        assert!(words.russian.len() < 300, "{}", words.russian);
    }

    #[test]
    fn types_have_russian_names() {
        assert_eq!(
            kinds_in_russian("string, table[any]"),
            "текст, таблица[любой]"
        );
    }
}
