//! Words of Lua, for LuaJIT.
//!
//! Owns how things are said; what the helpers do is in `file/run.lua`.

use super::Word;
use lang_diagram::generate::row::{Row, apart, call, infix, postfix, prefix};
use lang_expr::reserved::Function;

pub(super) fn row(word: Word) -> Row {
    match word {
        Word::Field => call("s.$1"),
        Word::Now => call("s.now"),
        Word::Unit => call("nil"),
        Word::Yes => call("true"),
        Word::No => call("false"),
        Word::Add => infix("$1 + $2", 12),
        Word::Subtract => infix("$1 - $2", 12),
        Word::Multiply => infix("$1 * $2", 13),
        Word::Divide => call("divide($1, $2)"),
        Word::Power => Row {
            text: "$1 ^ $2",
            binds: 15,
            needs: [16, 15],
        },
        Word::Minus => prefix("0 - $1", 12),
        Word::DivideWhole => call("divideWhole($1, $2)"),
        Word::Modulo => call("modulo($1, $2)"),
        Word::BitAnd => call("band($1, $2)"),
        Word::BitOr => call("bor($1, $2)"),
        Word::BitXor => call("bxor($1, $2)"),
        Word::BitNot => call("bnot($1)"),
        Word::ShiftLeft => call("shiftLeft($1, $2)"),
        Word::ShiftRight => call("shiftRight($1, $2)"),
        Word::Not => prefix("not $1", 14),
        Word::And => infix("$1 and $2", 2),
        Word::Or => infix("$1 or $2", 1),
        Word::Less => apart("$1 < $2", 3),
        Word::Greater => apart("$1 > $2", 3),
        Word::LessEqual => apart("$1 <= $2", 3),
        Word::GreaterEqual => apart("$1 >= $2", 3),
        Word::EqualNumbers => apart("$1 == $2", 3),
        Word::Same => call("same($1, $2)"),
        Word::Number => call("number($1)"),
        Word::NumberOfAny => call("numberOfAny($1)"),
        Word::NumberOfItem => call("numberOfItem($1, $2)"),
        Word::Demand => call("demand($1)"),
        Word::Whole => call("whole($1)"),
        Word::Truth => call("truth($1)"),
        Word::NumberOfTruth => call("numberOfAny($1)"),
        Word::ValueOfNumber | Word::ValueOfTruth => postfix("$1"),
        Word::Item => call("item($1, $2)"),
        Word::Put => call("put($1, $2, $3)"),
        Word::Length => call("length($1)"),
        Word::Ignore => call("ignore($1)"),
        Word::Math(function) => call(math(function)),
        Word::Post => call("post($1, $2)"),
        Word::Fail => call("fail($1)"),
        Word::Stop => call("stop()"),
        Word::Count => call("count()"),
        Word::AsWhole => call("asWhole($1)"),
        Word::Clamp => call("clamp($1, $2)"),
        Word::NeedsValue => call("needsValue($1)"),
        Word::NeedsItems => call("needsItems($1, $2)"),
        Word::NeedsPair => call("needsItems($1, 2)"),
        Word::RoundUp => call("roundUp($1)"),
        Word::SetTimer => call("setTimer($1, $2)"),
        Word::Cancel => call("cancelTimer($1)"),
        Word::Repeat => call("repeatTimer($1, $2, $3)"),
        Word::IsOver => call("isOver($1, $2, $3)"),
        Word::Push => call("push($1, $2, $3, $4)"),
        Word::Has => call("has($1)"),
        Word::Take => call("take($1)"),
    }
}

fn math(function: Function) -> &'static str {
    match function {
        Function::Time => "s.now",
        Function::Sin => "sin($1)",
        Function::Cos => "cos($1)",
        Function::Ln => "log($1)",
        Function::Exp => "exp($1)",
        Function::Asin => "asin($1)",
        Function::Acos => "acos($1)",
        Function::Atan => "atan($1)",
        Function::Sgn => "sign($1)",
        Function::Sqrt => "sqrt($1)",
        Function::Abs => "abs($1)",
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
    match items.split_first() {
        None => "{ n = 0 }".to_owned(),
        Some((first, rest)) => {
            let rest: String = rest.iter().map(|item| format!(", {item}")).collect();
            format!("{{ n = {}, [0] = {first}{rest} }}", items.len())
        }
    }
}
