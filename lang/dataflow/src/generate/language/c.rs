//! Words of C, as a library with the contract of `trikfs_converter.h`.
//!
//! Owns how things are said; what the helpers do is in `file/run.c`. Nothing is known of types before the program runs: a value
//! says what it is, as in the machine, and expressions ask for numbers where they compute.

use super::Word;
use lang_diagram::generate::row::{Row, apart, call, infix, prefix};
use lang_expr::reserved::Function;

pub(super) fn row(word: Word) -> Row {
    match word {
        // With a form of its own: no name of a program is that of a macro or of another field.
        Word::Field => call("s->v_$1"),
        Word::Now => call("s->now"),
        Word::Unit => call("unit()"),
        Word::Yes => call("1"),
        Word::No => call("0"),
        Word::Add => infix("$1 + $2", 12),
        Word::Subtract => infix("$1 - $2", 12),
        Word::Multiply => infix("$1 * $2", 13),
        Word::Divide => call("divide(s, $1, $2)"),
        Word::Power => call("pow($1, $2)"),
        Word::Minus => prefix("0 - $1", 12),
        Word::DivideWhole => call("divideWhole(s, $1, $2)"),
        Word::Modulo => call("modulo(s, $1, $2)"),
        Word::BitAnd => call("bitAnd($1, $2)"),
        Word::BitOr => call("bitOr($1, $2)"),
        Word::BitXor => call("bitXor($1, $2)"),
        Word::BitNot => call("bitNot($1)"),
        Word::ShiftLeft => call("shiftLeft($1, $2)"),
        Word::ShiftRight => call("shiftRight($1, $2)"),
        Word::Not => prefix("!$1", 15),
        // Compilers warn where the brackets of one in the other are missing.
        Word::And => apart("$1 && $2", 5),
        Word::Or => apart("$1 || $2", 5),
        Word::Less => apart("$1 < $2", 10),
        Word::Greater => apart("$1 > $2", 10),
        Word::LessEqual => apart("$1 <= $2", 10),
        Word::GreaterEqual => apart("$1 >= $2", 10),
        Word::EqualNumbers => apart("$1 == $2", 9),
        Word::Same => call("same($1, $2)"),
        Word::Number => call("number(s, $1)"),
        Word::NumberOfAny => call("numberOfAny(s, $1)"),
        Word::NumberOfItem => call("numberOfItem(s, $1, $2)"),
        Word::Demand => call("demand(s, $1)"),
        Word::Whole => call("whole($1)"),
        Word::Truth => call("truth($1)"),
        Word::NumberOfTruth => call("(double)($1)"),
        Word::ValueOfNumber => call("numberValue($1)"),
        Word::ValueOfTruth => call("truthValue($1)"),
        Word::Item => call("item(s, $1, $2)"),
        Word::Put => call("put(s, $1, $2, $3)"),
        Word::Length => call("length(s, $1)"),
        Word::Ignore => call("ignore($1)"),
        Word::Math(function) => call(math(function)),
        Word::Post => call("post(s, $1, $2)"),
        Word::Fail => call("fail(s, $1)"),
        Word::Stop => call("fail(s, \"ENODEV: the program has ended\")"),
        Word::Count => call("count(s)"),
        Word::AsWhole => call("asWhole(s, $1)"),
        Word::Clamp => call("clamp($1, $2)"),
        Word::NeedsValue => call("needsValue(s, $1)"),
        Word::NeedsItems => call("needsItems(s, $1, $2)"),
        Word::NeedsPair => call("needsItems(s, $1, 2)"),
        Word::RoundUp => call("roundUp($1)"),
        Word::SetTimer => call("setTimer(s, $1, $2)"),
        Word::Cancel => call("cancelTimer(s, $1)"),
        Word::Repeat => call("repeatTimer(s, $1, $2, $3)"),
        Word::IsOver => call("isOver($1, $2, $3)"),
        Word::Push => call("waits(s, &$1, $2, $3, $4)"),
        Word::Has => call("$1.count > 0"),
        Word::Take => call("takeWaiting(s, &$1)"),
    }
}

fn math(function: Function) -> &'static str {
    match function {
        Function::Time => "s->now",
        Function::Sin => "sin($1)",
        Function::Cos => "cos($1)",
        Function::Ln => "log($1)",
        Function::Exp => "exp($1)",
        Function::Asin => "asin($1)",
        Function::Acos => "acos($1)",
        Function::Atan => "atan($1)",
        Function::Sgn => "sign($1)",
        Function::Sqrt => "sqrt($1)",
        Function::Abs => "fabs($1)",
        Function::Ceil => "cut(ceil($1))",
        Function::Floor => "cut(floor($1))",
        Function::Min => "least($1, $2)",
        Function::Max => "most($1, $2)",
        Function::Atan2 => "atan2($1, $2)",
        // Refused where they are called.
        Function::Random | Function::Print | Function::Sensor => "",
    }
}

pub(super) fn list(items: &[String]) -> String {
    match items.len() {
        0 => "listOf(s, 0, NULL)".to_owned(),
        count => format!(
            "listOf(s, {count}, (const struct value[]){{ {} }})",
            items.join(", ")
        ),
    }
}
