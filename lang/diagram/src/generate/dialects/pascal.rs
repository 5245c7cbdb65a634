//! PascalABC.NET with TRIK's library for .NET.
//!
//! Owns words of one language. There is no compiler for it here: what is printed has only been read.

use super::super::code::{Conversion, Element, Function, Kind, Number, Truth, Turn};
use super::super::names::Rules;
use super::super::plan::Owner;
use super::super::print::{
    Dialect, NONE, Printer, Row, Syntax, Tables, apart, call, float, infix, postfix, prefix,
};
use super::super::routines::{Abilities, Routine};
use super::library;
use crate::structure::Jumps;

/// The language.
pub(in super::super) const PASCAL: Dialect = Dialect {
    tables: Tables {
        number,
        truth,
        conversion,
        function,
        element,
        robot: library::robot,
        turn,
        phrase: |phrase| phrase.dotnet,
    },
    syntax: Syntax {
        indent: "  ",
        comment: "// $1",
        statement: "$1;",
        set: "$1 := $2;",
        if_: "if $1 then begin",
        else_if: "end else if $1 then begin",
        else_: "end else begin",
        end: "end;",
        forever: "while true do begin",
        while_: "while $1 do begin",
        do_while: Some(("repeat", "until not ($1);")),
        repeat: "for $2 := 1 to $1 do begin",
        repeat_plain: "for $2 := 1 to $1 do begin",
        end_loop: "end;",
        break_: "break;",
        continue_: "continue;",
        break_to: "break;",
        continue_to: "continue;",
        continue_label: "",
        name_loop: "",
        return_: "exit;",
        goto: "",
        label: "",
        empty: "",
        call: "$1($2)",
    },
    rules: Rules {
        cyrillic: true,
        caseless: true,
        reserved: RESERVED,
        taken: "",
        underscores: true,
    },
    abilities: Abilities {
        jumps: Jumps::Plain,
        leaves: true,
    },
    quote,
    float,
    port: |name| format!("'{name}'"),
    truths: ["false", "true"],
    nil: "0",
    list: |parts| format!("ListOf({})", parts.join(", ")),
    variable: "$1",
    function: "$1",
    helpers: library::PASCAL,
    is_typed: true,
    assemble,
};

const RESERVED: &[&str] = &[
    "abstract",
    "and",
    "array",
    "as",
    "auto",
    "begin",
    "boolean",
    "case",
    "class",
    "const",
    "constructor",
    "destructor",
    "div",
    "do",
    "double",
    "downto",
    "else",
    "end",
    "event",
    "except",
    "exit",
    "extensionmethod",
    "false",
    "file",
    "final",
    "finalization",
    "finally",
    "for",
    "foreach",
    "forward",
    "function",
    "goto",
    "if",
    "implementation",
    "in",
    "inherited",
    "initialization",
    "integer",
    "interface",
    "internal",
    "is",
    "label",
    "lock",
    "loop",
    "match",
    "math",
    "mod",
    "model",
    "namespace",
    "new",
    "nil",
    "not",
    "object",
    "of",
    "on",
    "operator",
    "or",
    "override",
    "params",
    "partial",
    "private",
    "procedure",
    "program",
    "property",
    "protected",
    "public",
    "raise",
    "read",
    "real",
    "record",
    "reintroduce",
    "repeat",
    "result",
    "sealed",
    "sequence",
    "set",
    "shl",
    "shr",
    "sizeof",
    "sleep",
    "started",
    "static",
    "step",
    "string",
    "system",
    "template",
    "then",
    "thread",
    "to",
    "trik",
    "true",
    "try",
    "type",
    "typeof",
    "unit",
    "until",
    "uses",
    "using",
    "var",
    "virtual",
    "when",
    "where",
    "while",
    "with",
    "write",
    "writeln",
    "xor",
    "yield",
    "abs",
    "arctan",
    "ceil",
    "cos",
    "exp",
    "floor",
    "length",
    "ln",
    "max",
    "min",
    "pi",
    "power",
    "random",
    "round",
    "sign",
    "sin",
    "sqrt",
    "str",
    "trunc",
    "val",
];

/// Text in Pascal: quotes are doubled, and what is not plain stands as its code.
fn quote(text: &str) -> String {
    let mut out = String::from("''");
    let mut inside = false;
    for letter in text.chars() {
        let is_plain = !letter.is_control() && !('\u{2028}'..='\u{202e}').contains(&letter);
        if is_plain != inside {
            out.push_str(if is_plain { "+'" } else { "'" });
            inside = is_plain;
        }
        match letter {
            '\'' => out.push_str("''"),
            letter if is_plain => out.push(letter),
            letter => out.push_str(&format!("+char({})", letter as u32)),
        }
    }
    if inside {
        out.push('\'');
    }
    match out.strip_prefix("''+'") {
        // The usual case: one piece.
        Some(rest) => format!("'{rest}"),
        None => out,
    }
}

fn number(number: Number) -> Row {
    use Number::*;
    match number {
        Add => infix("$1 + $2", 12),
        Subtract => infix("$1 - $2", 12),
        Multiply => infix("$1 * $2", 13),
        Divide => call("Divide($1, $2)"),
        DividePlain => infix("$1 / $2", 13),
        // Both cut towards 0, and both refuse 0.
        DivideWhole => infix("$1 div $2", 13),
        Modulo => infix("$1 mod $2", 13),
        Power => call("Power($1, $2)"),
        Negate => call("(-$1)"),
        NegateSingle => call("(-single($1))"),
        BitAnd => infix("$1 and $2", 13),
        BitOr => infix("$1 or $2", 12),
        BitXor => infix("$1 xor $2", 12),
        BitNot => prefix("not $1", 14),
        ShiftLeft => infix("$1 shl $2", 13),
        ShiftRight => infix("$1 shr $2", 13),
    }
}

fn truth(truth: Truth) -> Row {
    use Truth::*;
    match truth {
        Not => call("not ($1)"),
        And => call("($1) and ($2)"),
        Or => call("(($1) or ($2))"),
        Less => apart("$1 < $2", 3),
        Greater => apart("$1 > $2", 3),
        LessEqual => apart("$1 <= $2", 3),
        GreaterEqual => apart("$1 >= $2", 3),
        Equal | EqualText => apart("$1 = $2", 3),
        NotEqual | NotEqualText => apart("$1 <> $2", 3),
        Again => call("Again($1, $2)"),
        EqualAny | NotEqualAny => NONE,
    }
}

fn conversion(conversion: Conversion) -> Row {
    use Conversion::*;
    match conversion {
        Join => infix("$1 + $2", 12),
        Length => postfix("$1.Length"),
        FloatOfInt => call("$1"),
        WholeOfFloat => call("ToWhole($1)"),
        WholeOfBool => call("Ord($1)"),
        WholeOfAny => call("ToWhole(ToNumber($1))"),
        NumberOfAny => call("ToNumber($1)"),
        TruthOfAny => call("ToTruth($1)"),
        TextOfInt => postfix("$1.ToString"),
        TextOfFloat | TextOfAny => call("ToText($1)"),
        TextOfBool => postfix("$1.ToString.ToLower"),
        Printed => call("ToPrinted($1)"),
        ValueOf => NONE,
    }
}

fn function(function: Function) -> Row {
    use Function::*;
    match function {
        Sin => call("Sin($1)"),
        Cos => call("Cos($1)"),
        Ln => call("Ln($1)"),
        Exp => call("Exp($1)"),
        Asin => call("ArcSin($1)"),
        Acos => call("ArcCos($1)"),
        Atan => call("ArcTan($1)"),
        Sqrt => call("Sqrt($1)"),
        Abs => call("Abs($1)"),
        Sgn => call("Sign($1)"),
        Ceil => call("Ceil($1)"),
        Floor => call("Floor($1)"),
        Min => call("Min($1, $2)"),
        Max => call("Max($1, $2)"),
        Atan2 => call("System.Math.Atan2($1, $2)"),
        Pi => call("Pi"),
        Time => infix("Milliseconds - started", 12),
        Random => call("Random($1, $2)"),
    }
}

fn element(element: Element) -> Row {
    use Element::*;
    match element {
        At => call("Item($1, $2)"),
        AtWhole => call("Round(Item($1, $2))"),
        AtPlain => call("Round($1[$2])"),
        Put => call("Put($1, $2, $3)"),
        Copy => postfix("$1.ToList"),
    }
}

fn turn(turn: Turn) -> Row {
    use Turn::*;
    match turn {
        Wait => call("wait($1)"),
        AnyButton => call("anyButton($1)"),
        Start => call("StartThread($1, $2)"),
        Join => call("JoinThread($1)"),
        Kill => call("KillThread($1)"),
        Mail | Send | Receive | ReceiveNow => NONE,
    }
}

fn type_of(kind: &Kind) -> &'static str {
    match kind {
        Kind::Int => "integer",
        Kind::Bool => "boolean",
        Kind::Text => "string",
        Kind::List(_) => "List<real>",
        Kind::Float | Kind::Any => "real",
    }
}

fn head(printer: &Printer<'_>, index: usize, routine: &Routine) -> String {
    let parameters = routine.parameters.iter().map(|&number| {
        let kind = printer.script.variables.all[number].kind.clone();
        let kind = kind.unwrap_or(Kind::Float);
        format!("{}: {}", printer.variables[number], type_of(&kind))
    });
    let parameters = parameters.collect::<Vec<_>>().join("; ");
    let parameters = if parameters.is_empty() {
        parameters
    } else {
        format!("({parameters})")
    };
    let name = match routine.owner {
        Owner::Main => "Main_",
        Owner::Subprogram(_) | Owner::Thread(..) => &printer.functions[index],
    };
    format!("procedure {name}{parameters};")
}

fn assemble(printer: &Printer<'_>) -> String {
    let script = printer.script;
    let mut functions = String::new();
    for (index, routine) in script.routines.iter().enumerate() {
        if routine.owner != Owner::Main {
            functions.push_str(&format!("{} forward;\n", head(printer, index, routine)));
        }
    }
    functions.push('\n');
    for (index, routine) in script.routines.iter().enumerate().rev() {
        if let Owner::Thread(thread, _) = &routine.owner {
            let comment = printer.comment(&format!("The thread {thread}."));
            functions.push_str(&format!("{comment}\n"));
        }
        functions.push_str(&format!("{}\n", head(printer, index, routine)));
        let locals = printer.locals(routine, &[]);
        if !locals.is_empty() {
            functions.push_str("var\n");
            for (name, kind) in locals {
                functions.push_str(&format!("  {name}: {};\n", type_of(&kind)));
            }
        }
        functions.push_str("begin\n");
        let body = printer.body(routine, 1);
        functions.push_str(body.strip_suffix("  exit;\n").unwrap_or(&body));
        functions.push_str("end;\n\n");
    }
    let mut variables = String::new();
    for (number, variable) in script.variables.all.iter().enumerate() {
        if printer.is_global(number) {
            let kind = variable.kind.clone().unwrap_or(Kind::Float);
            let start = match kind {
                Kind::List(_) => " := new List<real>",
                Kind::Text => " := ''",
                Kind::Any | Kind::Bool | Kind::Int | Kind::Float => "",
            };
            let name = &printer.variables[number];
            variables.push_str(&format!("  {name}: {}{start};\n", type_of(&kind)));
        }
    }
    let begin = if script.names_threads {
        "  threads['main'] := Thread.CurrentThread;\n"
    } else {
        ""
    };
    let helpers = printer.helpers(&format!("{functions}{begin}"));
    let title = printer.comment(&printer.title);
    format!(
        "{title}\n{{$reference Trik.Core.dll}}\nuses System, System.Threading, System.Collections.Generic, Trik;\n\nvar\n  model := new Model;\n  started: integer;\n{variables}\n{helpers}{functions}begin\n  started := Environment.TickCount;\n{begin}  Main_;\nend.\n"
    )
}
