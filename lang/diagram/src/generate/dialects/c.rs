//! C over the files of the tree.
//!
//! Owns words of one language. Texts and tables are values of fixed size, so nothing has to be freed. Nothing is drawn:
//! labels go to the standard output.

mod helpers;
mod taken;
mod threads;

use super::super::code::{Conversion, Element, Function, Kind, Number, Truth, Turn};
use super::super::names::Rules;
use super::super::plan::Owner;
use super::super::print::{
    Dialect, NONE, Printer, Row, Syntax, Tables, apart, call, float, infix, postfix, prefix, quote,
};
use super::super::routines::{Abilities, Routine};
use super::lua;
use crate::structure::Jumps;

/// The language.
pub(in super::super) const C: Dialect = Dialect {
    tables: Tables {
        number,
        truth,
        conversion,
        function,
        element,
        robot: lua::robot,
        turn,
        phrase: |phrase| phrase.c,
    },
    syntax: Syntax {
        indent: "    ",
        comment: "/* $1 */",
        statement: "$1;",
        set: "$1 = $2;",
        if_: "if ($1) {",
        else_if: "} else if ($1) {",
        else_: "} else {",
        end: "}",
        forever: "for (;;) {",
        while_: "while ($1) {",
        do_while: Some(("do {", "} while ($1);")),
        repeat: "for ($2 = 0, $3 = $1; $2 < $3; $2++) {",
        repeat_plain: "for ($2 = 0; $2 < $1; $2++) {",
        end_loop: "}",
        break_: "break;",
        continue_: "continue;",
        break_to: "break;",
        continue_to: "continue;",
        continue_label: "",
        name_loop: "",
        return_: "return;",
        goto: "goto $1;",
        label: "$1:;",
        empty: "",
        call: "$1($2)",
    },
    rules: Rules {
        cyrillic: false,
        caseless: false,
        reserved: RESERVED,
        taken: taken::TAKEN,
        underscores: false,
    },
    abilities: Abilities {
        jumps: Jumps::Goto,
        leaves: true,
    },
    quote: |text| {
        let escape = |code| super::escaped(code, |byte| format!("\\{byte:03o}"));
        // Three signs that C of old takes for others begin with two question marks.
        format!("textOf({})", quote(text, escape).replace("??", "?\\?"))
    },
    float,
    port: |name| format!("\"{name}\""),
    truths: ["0", "1"],
    nil: "0",
    list: |parts| match parts.len() {
        0 => "emptyTable()".to_owned(),
        count => format!("tableOf({count}, (double[]){{{}}})", parts.join(", ")),
    },
    variable: "$1",
    function: "$1",
    helpers: helpers::HELPERS,
    is_typed: true,
    assemble,
};

const RESERVED: &[&str] = &[
    "asm",
    "auto",
    "break",
    "case",
    "char",
    "const",
    "continue",
    "default",
    "do",
    "double",
    "else",
    "enum",
    "extern",
    "float",
    "for",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "register",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "typedef",
    "typeof",
    "union",
    "unsigned",
    "void",
    "volatile",
    "while",
    "Text",
    "Table",
    "Whole",
    "abs",
    "acos",
    "asin",
    "atan",
    "atan2",
    "ceil",
    "clock",
    "close",
    "cos",
    "errno",
    "exit",
    "exp",
    "fabs",
    "floor",
    "fmax",
    "fmin",
    "fmod",
    "free",
    "index",
    "log",
    "malloc",
    "open",
    "poll",
    "pow",
    "printf",
    "rand",
    "read",
    "remove",
    "round",
    "select",
    "sin",
    "sleep",
    "sqrt",
    "started",
    "stdin",
    "stdout",
    "stderr",
    "system",
    "tan",
    "time",
    "tree",
    "trunc",
    "usleep",
    "write",
    "y0",
    "y1",
    "yn",
    "j0",
    "j1",
    "jn",
    "gamma",
    "signal",
    "send",
    "recv",
    "accept",
    "bind",
    "connect",
    "pause",
    "turn",
    "threads",
    "current",
    "counters",
    "pauseFor",
    "ended",
    "after",
    "mayEnd",
    "giveTurn",
    "findTree",
    "getenv",
    "threadCount",
    "runThread",
    "isRunning",
    "beginThreads",
    "endThreads",
    "fail",
    "wait",
    "program",
    "count",
    "arguments",
    "alarm",
    "nice",
    "link",
    "unlink",
    "pipe",
    "dup",
    "kill",
    "wait3",
    "div",
    "linux",
    "unix",
    "random",
    "strlen",
    "memcpy",
    "NULL",
    "EOF",
    "NAN",
    "INFINITY",
];

/// An operator on bits: compilers warn where the brackets of anything but a product in it are missing.
const fn bits(text: &'static str, binds: u8) -> Row {
    Row {
        text,
        binds,
        needs: [13, 13],
    }
}

fn number(number: Number) -> Row {
    use Number::*;
    match number {
        Add => infix("$1 + $2", 12),
        Subtract => infix("$1 - $2", 12),
        Multiply => infix("$1 * $2", 13),
        Divide => call("divide($1, $2)"),
        DividePlain => Row {
            text: "(double)$1 / $2",
            binds: 13,
            needs: [15, 14],
        },
        DivideWhole => call("divideWhole($1, $2)"),
        Modulo => call("modulo($1, $2)"),
        Power => call("pow($1, $2)"),
        Negate => prefix("-$1", 15),
        NegateSingle => prefix("-(float)$1", 15),
        BitAnd => bits("$1 & $2", 8),
        BitOr => bits("$1 | $2", 6),
        BitXor => bits("$1 ^ $2", 7),
        BitNot => prefix("~$1", 15),
        ShiftLeft => call("shiftLeft($1, $2)"),
        ShiftRight => call("shiftRight($1, $2)"),
    }
}

fn truth(truth: Truth) -> Row {
    use Truth::*;
    match truth {
        Not => prefix("!$1", 15),
        // Compilers warn where the brackets of `and` in `or` are missing.
        And => Row {
            text: "$1 && $2",
            binds: 5,
            needs: [5, 6],
        },
        Or => Row {
            text: "$1 || $2",
            binds: 4,
            needs: [6, 6],
        },
        Less => apart("$1 < $2", 10),
        Greater => apart("$1 > $2", 10),
        LessEqual => apart("$1 <= $2", 10),
        GreaterEqual => apart("$1 >= $2", 10),
        Equal => apart("$1 == $2", 9),
        NotEqual => apart("$1 != $2", 9),
        EqualText => call("sameText($1, $2)"),
        NotEqualText => prefix("!sameText($1, $2)", 15),
        EqualAny | NotEqualAny => NONE,
        Again => call("again(&counters[$1], $2)"),
    }
}

fn conversion(conversion: Conversion) -> Row {
    use Conversion::*;
    match conversion {
        Join => call("joinText($1, $2)"),
        Length => call("letters($1)"),
        FloatOfInt => call("$1"),
        WholeOfFloat => call("toWhole($1)"),
        WholeOfBool => call("($1)"),
        WholeOfAny => call("toWhole(toNumber($1))"),
        NumberOfAny => call("toNumber($1)"),
        TruthOfAny => call("toTruth($1)"),
        TextOfInt | TextOfFloat | TextOfAny => call("toText($1)"),
        TextOfBool => call("toTextOfTruth($1)"),
        Printed => call("toPrinted($1)"),
        ValueOf => NONE,
    }
}

fn function(function: Function) -> Row {
    use Function::*;
    match function {
        Sin => call("sin($1)"),
        Cos => call("cos($1)"),
        Ln => call("log($1)"),
        Exp => call("exp($1)"),
        Asin => call("asin($1)"),
        Acos => call("acos($1)"),
        Atan => call("atan($1)"),
        Sqrt => call("sqrt($1)"),
        Abs => call("fabs($1)"),
        Sgn => call("sign($1)"),
        Ceil => call("(Whole)ceil($1)"),
        Floor => call("(Whole)floor($1)"),
        Min => call("fmin($1, $2)"),
        Max => call("fmax($1, $2)"),
        Atan2 => call("atan2($1, $2)"),
        Pi => call("3.14159265358979323846"),
        Time => infix("milliseconds() - started", 12),
        Random => call("randomWhole($1, $2)"),
    }
}

fn element(element: Element) -> Row {
    use Element::*;
    match element {
        At => call("item($1, $2)"),
        AtWhole => call("(Whole)item($1, $2)"),
        AtPlain => postfix("$1.at[$2]"),
        Put => call("put(&$1, $2, $3)"),
        Copy => call("$1"),
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
        Mail | Send | Receive | ReceiveNow => NONE,
    }
}

fn type_of(kind: &Kind) -> &'static str {
    match kind {
        Kind::Int => "Whole",
        Kind::Bool => "int",
        Kind::Text => "Text",
        Kind::List(_) => "Table",
        Kind::Float | Kind::Any => "double",
    }
}

fn head(printer: &Printer<'_>, index: usize, routine: &Routine) -> String {
    let parameters = routine.parameters.iter().map(|&number| {
        let kind = printer.script.variables.all[number].kind.clone();
        let kind = kind.unwrap_or(Kind::Float);
        format!("{} {}", type_of(&kind), printer.variables[number])
    });
    let parameters = parameters.collect::<Vec<_>>().join(", ");
    let parameters = if parameters.is_empty() {
        "void"
    } else {
        &parameters
    };
    let name = match routine.owner {
        Owner::Main => "program",
        Owner::Subprogram(_) | Owner::Thread(..) => &printer.functions[index],
    };
    format!("static void {name}({parameters})")
}

fn assemble(printer: &Printer<'_>) -> String {
    let script = printer.script;
    let mut functions = String::new();
    for (index, routine) in script.routines.iter().enumerate() {
        if routine.owner != Owner::Main {
            functions.push_str(&format!("{};\n", head(printer, index, routine)));
        }
    }
    functions.push('\n');
    for (index, routine) in script.routines.iter().enumerate().rev() {
        if let Owner::Thread(thread, _) = &routine.owner {
            let comment = printer.comment(&format!("The thread {thread}."));
            functions.push_str(&format!("{comment}\n"));
        }
        functions.push_str(&format!("{}\n{{\n", head(printer, index, routine)));
        let body = printer.body(routine, 1);
        for (name, kind) in printer.locals(routine, &[]) {
            functions.push_str(&format!("    {} {name};\n", type_of(&kind)));
            let times = format!("{name}Times");
            if body.contains(&times) {
                functions.push_str(&format!("    Whole {times};\n"));
            }
        }
        functions.push_str(body.strip_suffix("    return;\n").unwrap_or(&body));
        functions.push_str("}\n\n");
    }
    let mut variables = String::new();
    for (number, variable) in script.variables.all.iter().enumerate() {
        if printer.is_global(number) {
            let kind = variable.kind.clone().unwrap_or(Kind::Float);
            variables.push_str(&format!(
                "static {} {};\n",
                type_of(&kind),
                printer.variables[number]
            ));
        }
    }
    let end = if script.names_threads {
        "    endThreads();\n"
    } else {
        ""
    };
    let begin = if script.names_threads {
        "    beginThreads();\n"
    } else {
        ""
    };
    let main = format!(
        "int main(int count, char **arguments)\n{{\n    findTree(count, arguments);\n    started = milliseconds();\n{begin}    program();\n{end}    return 0;\n}}\n"
    );
    let unused = if functions.contains("started") {
        ""
    } else {
        "    (void)started;\n"
    };
    let main = main.replace("    program();\n", &format!("{unused}    program();\n"));
    let loops = format!("counters[{}]", printer.counters());
    let helpers = printer.helpers(&format!("{functions}{variables}{main}"));
    let helpers = helpers.replace("counters[1000]", &loops);
    let title = printer.comment(&printer.title);
    let threads = if script.names_threads {
        " -pthread"
    } else {
        ""
    };
    format!(
        "{title}\n/* cc{threads} -o program FILE.c -lm && ./program [TREE] */\n{}\n{helpers}{variables}\n{functions}{main}",
        helpers::HEAD
    )
}
