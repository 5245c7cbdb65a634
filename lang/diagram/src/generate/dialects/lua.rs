//! Lua over the files of the tree, for LuaJIT.
//!
//! Owns words of one language. Nothing is drawn: labels go to the standard output.

mod helpers;

use super::super::code::{Conversion, Element, Function, Number, Own, Robot, Truth, Turn};
use super::super::names::Rules;
use super::super::plan::Owner;
use super::super::print::{
    Dialect, NONE, Printer, Row, Syntax, Tables, apart, call, float, infix, postfix, prefix, quote,
};
use super::super::routines::Abilities;
use crate::structure::Jumps;

/// The language.
pub(in super::super) const LUA: Dialect = Dialect {
    tables: Tables {
        number,
        truth,
        conversion,
        function,
        element,
        robot,
        turn,
        phrase: |phrase| phrase.lua,
    },
    syntax: Syntax {
        indent: "  ",
        comment: "-- $1",
        statement: "$1",
        set: "$1 = $2",
        if_: "if $1 then",
        else_if: "elseif $1 then",
        else_: "else",
        end: "end",
        forever: "while true do",
        while_: "while $1 do",
        do_while: Some(("repeat", "until not ($1)")),
        repeat: "for $2 = 1, $1 do",
        repeat_plain: "for $2 = 1, $1 do",
        end_loop: "end",
        break_: "break",
        continue_: "",
        break_to: "break",
        continue_to: "goto $1",
        continue_label: "::$1::",
        name_loop: "",
        // A plain one may stand only at the end of a block.
        return_: "do return end",
        goto: "goto $1",
        label: "::$1::",
        empty: "",
        call: "$1($2)",
    },
    rules: Rules {
        cyrillic: false,
        caseless: false,
        reserved: RESERVED,
        taken: "",
        underscores: true,
    },
    abilities: Abilities {
        jumps: Jumps::Goto,
        leaves: true,
    },
    quote: |text| {
        quote(text, |code| {
            super::escaped(code, |byte| format!("\\{byte:03}"))
        })
    },
    float,
    port: |name| format!("\"{name}\""),
    truths: ["false", "true"],
    nil: "nil",
    list: super::zero_based,
    variable: "$1",
    function: "$1",
    helpers: helpers::HELPERS,
    is_typed: false,
    assemble,
};

const RESERVED: &[&str] = &[
    "and",
    "arg",
    "assert",
    "bit",
    "break",
    "coroutine",
    "do",
    "else",
    "elseif",
    "end",
    "error",
    "false",
    "for",
    "function",
    "goto",
    "if",
    "in",
    "io",
    "ipairs",
    "local",
    "math",
    "next",
    "nil",
    "not",
    "or",
    "os",
    "pairs",
    "print",
    "repeat",
    "require",
    "return",
    "select",
    "setmetatable",
    "started",
    "string",
    "table",
    "then",
    "tonumber",
    "tostring",
    "true",
    "type",
    "until",
    "while",
    "_G",
    "_VERSION",
    "current",
    "counters",
    "ffi",
    "find",
    "keys",
    "mayEnd",
    "opened",
    "order",
    "pcall",
    "step",
    "threads",
];

fn number(number: Number) -> Row {
    use Number::*;
    match number {
        Add => infix("$1 + $2", 12),
        Subtract => infix("$1 - $2", 12),
        Multiply => infix("$1 * $2", 13),
        Divide => call("divide($1, $2)"),
        DividePlain => infix("$1 / $2", 13),
        DivideWhole => call("divideWhole($1, $2)"),
        Modulo => call("modulo($1, $2)"),
        Power => Row {
            text: "$1 ^ $2",
            binds: 15,
            needs: [16, 15],
        },
        Negate => prefix("-$1", 14),
        NegateSingle => call("negated($1)"),
        BitAnd => call("bit.band($1, $2)"),
        BitOr => call("bit.bor($1, $2)"),
        BitXor => call("bit.bxor($1, $2)"),
        BitNot => call("bit.bnot($1)"),
        ShiftLeft => call("bit.lshift($1, $2)"),
        ShiftRight => call("bit.arshift($1, $2)"),
    }
}

fn truth(truth: Truth) -> Row {
    use Truth::*;
    match truth {
        Not => prefix("not $1", 14),
        And => infix("$1 and $2", 2),
        Or => infix("$1 or $2", 1),
        Less => apart("$1 < $2", 3),
        Greater => apart("$1 > $2", 3),
        LessEqual => apart("$1 <= $2", 3),
        GreaterEqual => apart("$1 >= $2", 3),
        Equal | EqualText => apart("$1 == $2", 3),
        NotEqual | NotEqualText => apart("$1 ~= $2", 3),
        EqualAny => call("same($1, $2)"),
        NotEqualAny => prefix("not same($1, $2)", 14),
        Again => call("again($1, $2)"),
    }
}

fn conversion(conversion: Conversion) -> Row {
    use Conversion::*;
    match conversion {
        Join => infix("$1 .. $2", 11),
        Length => call("letters($1)"),
        FloatOfInt => call("$1"),
        WholeOfFloat => call("toWhole($1)"),
        WholeOfBool => call("toNumber($1)"),
        WholeOfAny => call("toWhole(toNumber($1))"),
        NumberOfAny => call("toNumber($1)"),
        TruthOfAny => call("toTruth($1)"),
        TextOfInt | TextOfBool => call("tostring($1)"),
        TextOfFloat | TextOfAny => call("toText($1)"),
        Printed => call("toPrinted($1)"),
        ValueOf => call("toValue($1)"),
    }
}

fn function(function: Function) -> Row {
    use Function::*;
    match function {
        Sin => call("math.sin($1)"),
        Cos => call("math.cos($1)"),
        Ln => call("math.log($1)"),
        Exp => call("math.exp($1)"),
        Asin => call("math.asin($1)"),
        Acos => call("math.acos($1)"),
        Atan => call("math.atan($1)"),
        Sqrt => call("math.sqrt($1)"),
        Abs => call("math.abs($1)"),
        Sgn => call("sign($1)"),
        Ceil => call("math.ceil($1)"),
        Floor => call("math.floor($1)"),
        Min => call("math.min($1, $2)"),
        Max => call("math.max($1, $2)"),
        Atan2 => call("math.atan2($1, $2)"),
        Pi => call("math.pi"),
        Time => infix("milliseconds() - started", 12),
        Random => call("random($1, $2)"),
    }
}

fn element(element: Element) -> Row {
    use Element::*;
    match element {
        At => call("item($1, $2)"),
        AtWhole => call("item($1, $2)"),
        AtPlain => postfix("$1[$2]"),
        Put => call("put($1, $2, $3)"),
        Copy => call("copy($1)"),
    }
}

/// What the robot is told: functions that Lua and C share.
pub(super) fn robot(robot: Robot) -> Row {
    use Robot::*;
    match robot {
        SetPower => call("setPower($1, $2)"),
        PowerOff => call("powerOff($1)"),
        Servo => call("setServo($1, $2)"),
        ResetEncoder => call("resetEncoder($1)"),
        Print => call("say_text($1)"),
        Finish => call("rest()"),
        Redraw => NONE,
    }
}

fn turn(turn: Turn) -> Row {
    use Turn::*;
    match turn {
        Wait => call("wait($1)"),
        AnyButton => call("anyButton($1)"),
        Start => call("startThread($1, $2)"),
        Join => call("joinThread($1)"),
        Kill => call("killThread($1)"),
        Send => call("sendMessage($1, $2)"),
        Receive => call("receiveMessage(true)"),
        ReceiveNow => call("receiveMessage(false)"),
        Mail => NONE,
    }
}

fn assemble(printer: &Printer<'_>) -> String {
    let script = printer.script;
    let mut functions = String::new();
    for (index, routine) in script.routines.iter().enumerate().rev() {
        let name = &printer.functions[index];
        let parameters = routine.parameters.iter();
        let parameters = parameters.map(|&number| printer.variables[number].as_str());
        let parameters = parameters.collect::<Vec<_>>().join(", ");
        if let Owner::Thread(thread, _) = &routine.owner {
            let comment = printer.comment(&format!("The thread {thread}."));
            functions.push_str(&format!("{comment}\n"));
        }
        functions.push_str(&format!("function {name}({parameters})\n"));
        let locals = printer.locals(routine, &[Own::Counter]);
        if !locals.is_empty() {
            let names: Vec<_> = locals.into_iter().map(|(name, _)| name).collect();
            functions.push_str(&format!("  local {}\n", names.join(", ")));
        }
        let body = printer.body(routine, 1);
        functions.push_str(body.strip_suffix("  do return end\n").unwrap_or(&body));
        functions.push_str("end\n\n");
    }
    let mut variables = String::new();
    for (number, variable) in script.variables.all.iter().enumerate() {
        if printer.is_global(number) {
            let kinds = ["0", "false", "\"\"", "{}", "nil"];
            let start = super::start_value(variable.kind.as_ref(), kinds);
            variables.push_str(&format!("{} = {start}\n", printer.variables[number]));
        }
    }
    let start = if script.names_threads {
        "runThreads(main)\n"
    } else {
        "main()\n"
    };
    let needs = format!("{functions}{start} milliseconds");
    let helpers = printer.helpers(&needs);
    let title = printer.comment(&printer.title);
    format!(
        "{title}\n-- For LuaJIT: luajit FILE [TREE]\n\n{helpers}{variables}\n{functions}started = milliseconds()\n{start}"
    )
}
