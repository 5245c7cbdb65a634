//! JavaScript for TRIK: the functions of the controller's script engine.
//!
//! Owns words of one language. What they are called is in docs/user/javascript.md.

pub(in super::super) mod turns;

use super::super::code::{Conversion, Element, Function, Number, Own, Robot, Truth, Turn};
use super::super::names::Rules;
use super::super::plan::Owner;
use super::super::print::{
    Dialect, Printer, Row, Syntax, Tables, apart, call, float, infix, postfix, prefix, quote,
};
use super::super::routines::Abilities;
use crate::structure::Jumps;

/// The language.
pub(in super::super) const JAVASCRIPT: Dialect = Dialect {
    tables: Tables {
        number,
        truth,
        conversion,
        function,
        element,
        robot,
        turn,
        phrase: |phrase| phrase.javascript,
    },
    syntax: Syntax {
        indent: "    ",
        comment: "// $1",
        statement: "$1;",
        set: "$1 = $2;",
        if_: "if ($1) {",
        else_if: "} else if ($1) {",
        else_: "} else {",
        end: "}",
        forever: "while (true) {",
        while_: "while ($1) {",
        do_while: Some(("do {", "} while ($1);")),
        repeat: "for (var $2 = 0, $3 = $1; $2 < $3; $2++) {",
        repeat_plain: "for (var $2 = 0; $2 < $1; $2++) {",
        end_loop: "}",
        break_: "break;",
        continue_: "continue;",
        break_to: "break $1;",
        continue_to: "continue $1;",
        continue_label: "",
        name_loop: "$1: ",
        return_: "return;",
        goto: "",
        label: "",
        empty: "",
        call: "$1($2)",
    },
    rules: Rules {
        cyrillic: true,
        caseless: false,
        reserved: RESERVED,
        taken: "",
        underscores: true,
    },
    abilities: Abilities {
        jumps: Jumps::Labelled,
        leaves: true,
    },
    quote: |text| quote(text, |code| format!("\\u{code:04x}")),
    float,
    port: str::to_owned,
    truths: ["false", "true"],
    nil: "null",
    list: |parts| format!("[{}]", parts.join(", ")),
    variable: "$1",
    function: "\"$1\"",
    helpers: HELPERS,
    is_typed: false,
    assemble,
};

const RESERVED: &[&str] = &[
    "A1",
    "A2",
    "A3",
    "A4",
    "A5",
    "A6",
    "D1",
    "D2",
    "D3",
    "E1",
    "E2",
    "E3",
    "E4",
    "Events",
    "KeysEnum",
    "M1",
    "M2",
    "M3",
    "M4",
    "Math",
    "MouseEventCodes",
    "Number",
    "Object",
    "PadEventCodes",
    "S1",
    "S2",
    "S3",
    "S4",
    "S5",
    "S6",
    "String",
    "Threading",
    "__interpretation_started_timestamp__",
    "arguments",
    "await",
    "break",
    "brick",
    "case",
    "catch",
    "class",
    "const",
    "continue",
    "debugger",
    "default",
    "delete",
    "do",
    "else",
    "enum",
    "eval",
    "export",
    "extends",
    "false",
    "finally",
    "for",
    "function",
    "gamepad",
    "getPhoto",
    "if",
    "implements",
    "import",
    "in",
    "include",
    "instanceof",
    "interface",
    "isFinite",
    "let",
    "mailbox",
    "new",
    "null",
    "package",
    "parseFloat",
    "pi",
    "print",
    "private",
    "protected",
    "public",
    "return",
    "script",
    "static",
    "super",
    "switch",
    "this",
    "throw",
    "true",
    "try",
    "typeof",
    "undefined",
    "var",
    "void",
    "web",
    "while",
    "with",
    "yield",
    "NaN",
    "Infinity",
    "Array",
    "Error",
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
        Power => call("Math.pow($1, $2)"),
        Negate => prefix("-$1", 15),
        NegateSingle => prefix("-Math.fround($1)", 15),
        BitAnd => infix("$1 & $2", 8),
        BitOr => infix("$1 | $2", 6),
        BitXor => infix("$1 ^ $2", 7),
        BitNot => prefix("~$1", 15),
        ShiftLeft => infix("$1 << $2", 11),
        ShiftRight => infix("$1 >> $2", 11),
    }
}

fn truth(truth: Truth) -> Row {
    use Truth::*;
    match truth {
        Not => prefix("!$1", 15),
        And => infix("$1 && $2", 5),
        Or => infix("$1 || $2", 4),
        Less => apart("$1 < $2", 10),
        Greater => apart("$1 > $2", 10),
        LessEqual => apart("$1 <= $2", 10),
        GreaterEqual => apart("$1 >= $2", 10),
        Equal | EqualText => apart("$1 == $2", 9),
        NotEqual | NotEqualText => apart("$1 != $2", 9),
        EqualAny => call("same($1, $2)"),
        NotEqualAny => prefix("!same($1, $2)", 15),
        Again => call("again($1, $2)"),
    }
}

fn conversion(conversion: Conversion) -> Row {
    use Conversion::*;
    match conversion {
        Join => infix("$1 + $2", 12),
        Length => postfix("$1.length"),
        FloatOfInt => call("$1"),
        WholeOfFloat => call("toWhole($1)"),
        WholeOfBool => call("Number($1)"),
        WholeOfAny => call("toWhole(toNumber($1))"),
        NumberOfAny => call("toNumber($1)"),
        TruthOfAny => call("toTruth($1)"),
        TextOfInt | TextOfFloat | TextOfBool => call("String($1)"),
        TextOfAny => call("toText($1)"),
        Printed => call("toPrinted($1)"),
        ValueOf => call("toValue($1)"),
    }
}

fn function(function: Function) -> Row {
    use Function::*;
    match function {
        Sin => call("Math.sin($1)"),
        Cos => call("Math.cos($1)"),
        Ln => call("Math.log($1)"),
        Exp => call("Math.exp($1)"),
        Asin => call("Math.asin($1)"),
        Acos => call("Math.acos($1)"),
        Atan => call("Math.atan($1)"),
        Sqrt => call("Math.sqrt($1)"),
        Abs => call("Math.abs($1)"),
        Sgn => call("Math.sign($1)"),
        Ceil => call("Math.ceil($1)"),
        Floor => call("Math.floor($1)"),
        Min => call("Math.min($1, $2)"),
        Max => call("Math.max($1, $2)"),
        Atan2 => call("Math.atan2($1, $2)"),
        Pi => call("Math.PI"),
        Time => infix("script.time() - __interpretation_started_timestamp__", 12),
        Random => call("script.random($1, $2)"),
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

/// What the robot is told: the same words in JavaScript and Python.
pub(super) fn robot(robot: Robot) -> Row {
    use Robot::*;
    match robot {
        SetPower | Servo => call("brick.motor($1).setPower($2)"),
        PowerOff => call("brick.motor($1).powerOff()"),
        ResetEncoder => call("brick.encoder($1).reset()"),
        Print => call("print($1)"),
        Redraw => call("brick.display().redraw()"),
        Finish => call("brick.stop()"),
    }
}

fn turn(turn: Turn) -> Row {
    use Turn::*;
    match turn {
        Wait => call("script.wait($1)"),
        AnyButton => call("brick.keys().buttonCode($1)"),
        Mail => call("mailbox.receive($1)"),
        Start => call("Threading.startThread($1, $2)"),
        Join => call("Threading.joinThread($1)"),
        Kill => call("Threading.killThread($1)"),
        Send => call("Threading.sendMessage($1, $2)"),
        Receive => call("Threading.receiveMessage(true)"),
        ReceiveNow => call("Threading.receiveMessage(false)"),
    }
}

const HELPERS: &[(&str, &str)] = &[
    (
        "toNumber",
        "
// A value as a number; a text that is none counts as 0.
var toNumber = function(value) {
    if (typeof value == \"string\")
        return /^\\s*[+-]?(\\d+\\.?\\d*|\\.\\d+)([eE][+-]?\\d+)?\\s*$/.test(value) ? parseFloat(value) : 0;
    return typeof value == \"number\" ? value : value === true ? 1 : 0;
};",
    ),
    (
        "toWhole",
        "
// The nearest whole number; halves go away from 0.
var toWhole = function(number) {
    var whole = Math.trunc(number);
    return (Math.abs(number - whole) >= 0.5 ? whole + Math.sign(number) : whole) | 0;
};",
    ),
    (
        "toTruth",
        "
// Whether a value counts as true.
var toTruth = function(value) {
    if (typeof value == \"string\")
        return value != \"\" && value != \"0\" && value.toLowerCase() != \"false\";
    return value === true || toWhole(toNumber(value)) != 0;
};",
    ),
    (
        "toText",
        "
// A value as a text; tables and nothing are empty.
var toText = function(value) {
    return value === null || value === undefined || typeof value == \"object\" ? \"\" : String(value);
};",
    ),
    (
        "toPrinted",
        "
// A text as the display shows it: numbers with at most six digits after the point.
var toPrinted = function(text) {
    if (!/^\\s*[+-]?(\\d+\\.?\\d*|\\.\\d+)([eE][+-]?\\d+)?\\s*$/.test(text))
        return text;
    return String(Number(parseFloat(text).toFixed(6)));
};",
    ),
    (
        "toValue",
        "
// The value that a message stands for.
var toValue = function(message) {
    var quoted = /^\\s*([\"'])([^\"']*)\\1\\s*$/.exec(message);
    if (quoted)
        return quoted[2];
    if (/^\\s*[+-]?(\\d+\\.?\\d*|\\.\\d+)([eE][+-]?\\d+)?\\s*$/.test(message))
        return parseFloat(message);
    return message == \"true\" ? true : message == \"false\" ? false : message;
};",
    ),
    (
        "same",
        "
// Whether two values are equal; a text is compared as what the other one is.
var same = function(left, right) {
    if (typeof left == \"object\" && typeof right == \"object\" && left && right)
        return left.length == right.length && left.every(function(value, at) { return same(value, right[at]); });
    if (typeof left == \"boolean\" && typeof right == \"string\")
        return left == toTruth(right);
    if (typeof left == \"string\" && typeof right == \"boolean\")
        return left == String(right);
    if (typeof left == \"string\" && typeof right == \"number\")
        return left == String(right);
    return left == right;
};",
    ),
    (
        "divide",
        "
// A quotient; dividing by 0 is an error.
var divide = function(left, right) {
    if (right == 0)
        throw new Error(\"Division by zero\");
    return left / right;
};",
    ),
    (
        "divideWhole",
        "
// A quotient without its fraction; dividing by 0 is an error.
var divideWhole = function(left, right) {
    if (right == 0)
        throw new Error(\"Division by zero\");
    return Math.trunc(left / right);
};",
    ),
    (
        "modulo",
        "
// What is left of a division, with the sign of the first number; dividing by 0 is an error.
var modulo = function(left, right) {
    if (right == 0)
        throw new Error(\"Division by zero\");
    return left % right;
};",
    ),
    (
        "item",
        "
// An element of a table, nothing beyond its end.
var item = function(table, index) {
    if (index < 0)
        throw new Error(\"Negative index for a table\");
    return table && index < table.length && table[index] !== undefined ? table[index] : null;
};",
    ),
    (
        "put",
        "
// Sets an element of a table, which grows as needed.
var put = function(table, index, value) {
    if (index < 0)
        throw new Error(\"Negative index for a table\");
    table[index] = value;
};",
    ),
    (
        "copy",
        "
// A table of its own, so that changing one does not change the other.
var copy = function(value) {
    return value && typeof value == \"object\" ? value.map(copy) : value;
};",
    ),
    (
        "again",
        "
// Whether a loop goes on. Its counter lives as long as the program: leaving part-way does not reset it.
var __counters = [];
var again = function(loop, times) {
    var left = (__counters[loop] === undefined ? times : __counters[loop]) - 1;
    __counters[loop] = left < 0 ? undefined : left;
    return left >= 0;
};",
    ),
];

fn assemble(printer: &Printer<'_>) -> String {
    assembled(printer, false)
}

/// The whole program. In one with turns each function is a generator.
fn assembled(printer: &Printer<'_>, has_turns: bool) -> String {
    let script = printer.script;
    let mut functions = String::new();
    let star = if has_turns { "*" } else { "" };
    for (index, routine) in script.routines.iter().enumerate().rev() {
        let name = &printer.functions[index];
        let parameters = routine
            .parameters
            .iter()
            .map(|&number| printer.variables[number].as_str());
        let parameters = parameters.collect::<Vec<_>>().join(", ");
        if let Owner::Thread(thread, _) = &routine.owner {
            let comment = printer.comment(&format!("The thread {thread}."));
            functions.push_str(&format!("{comment}\n"));
        }
        let is_inside = has_turns && routine.owner == Owner::Main;
        let (star, depth) = if is_inside { ("", 2) } else { (star, 1) };
        functions.push_str(&format!("var {name} = function{star}({parameters}) {{\n"));
        if routine.owner == Owner::Main {
            functions.push_str("    __interpretation_started_timestamp__ = script.time();\n");
        }
        if is_inside {
            functions.push_str("    turns.run(function*() {\n");
        }
        let locals = printer.locals(routine, &[Own::Counter]);
        if !locals.is_empty() {
            let names: Vec<_> = locals.into_iter().map(|(name, _)| name).collect();
            let indent = "    ".repeat(depth);
            functions.push_str(&format!("{indent}var {};\n", names.join(", ")));
        }
        functions.push_str(&printer.body(routine, depth));
        if is_inside {
            functions.push_str("    });\n");
        }
        functions.push_str("};\n\n");
    }
    let mut variables = String::new();
    for (number, variable) in script.variables.all.iter().enumerate() {
        if printer.is_global(number) {
            let name = &printer.variables[number];
            let start =
                super::start_value(variable.kind.as_ref(), ["0", "false", "\"\"", "[]", "null"]);
            variables.push_str(&format!("var {name} = {start};\n"));
        }
    }
    let helpers = printer.helpers(&functions);
    let title = printer.comment(&printer.title);
    format!(
        "{title}\n\nvar __interpretation_started_timestamp__;\n\n{variables}\n{helpers}{functions}"
    )
}
