//! F# with TRIK's library for .NET.
//!
//! Owns words of one language. It has no way out of the middle of a loop, so such programs become loops over states.
//! There is no compiler for it here: what is printed has only been read.

use super::super::code::{Conversion, Element, Function, Kind, Number, Truth, Turn};
use super::super::names::Rules;
use super::super::plan::Owner;
use super::super::print::{
    Dialect, NONE, Printer, Row, Syntax, Tables, apart, call, float, infix, postfix, quote,
};
use super::super::routines::{Abilities, Routine};
use super::library;
use crate::structure::Jumps;

/// The language.
pub(in super::super) const FSHARP: Dialect = Dialect {
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
        indent: "    ",
        comment: "// $1",
        statement: "$1",
        set: "$1 <- $2",
        if_: "if $1 then",
        else_if: "elif $1 then",
        else_: "else",
        end: "",
        forever: "while running do",
        while_: "while running && ($1) do",
        do_while: Some((
            "let mutable again_ = true\nwhile running && again_ do",
            "    again_ <- $1",
        )),
        repeat: "for $2 in 1 .. $1 do",
        repeat_plain: "for $2 in 1 .. $1 do",
        end_loop: "",
        break_: "",
        continue_: "",
        break_to: "",
        continue_to: "",
        continue_label: "",
        name_loop: "",
        return_: "running <- false",
        goto: "",
        label: "",
        empty: "()",
        call: "$1 ($2)",
    },
    rules: Rules {
        cyrillic: true,
        caseless: false,
        reserved: RESERVED,
        taken: "",
        underscores: true,
    },
    abilities: Abilities {
        jumps: Jumps::Plain,
        leaves: false,
    },
    quote: |text| quote(text, |code| format!("\\u{code:04x}")),
    float,
    port: |name| format!("\"{name}\""),
    truths: ["false", "true"],
    nil: "0",
    list: |parts| {
        format!(
            "ResizeArray<float> [{}]",
            parts
                .iter()
                .map(|part| format!("float ({part})"))
                .collect::<Vec<_>>()
                .join("; ")
        )
    },
    variable: "$1",
    function: "$1",
    helpers: library::FSHARP,
    is_typed: true,
    assemble,
};

const RESERVED: &[&str] = &[
    "_",
    "abstract",
    "and",
    "as",
    "asr",
    "assert",
    "base",
    "begin",
    "bool",
    "class",
    "component",
    "const",
    "constraint",
    "default",
    "delegate",
    "do",
    "done",
    "downcast",
    "downto",
    "elif",
    "else",
    "end",
    "event",
    "exception",
    "extern",
    "external",
    "false",
    "finally",
    "fixed",
    "float",
    "for",
    "fun",
    "function",
    "global",
    "if",
    "in",
    "include",
    "inherit",
    "inline",
    "int",
    "interface",
    "internal",
    "land",
    "lazy",
    "let",
    "lor",
    "lsl",
    "lsr",
    "lxor",
    "match",
    "member",
    "mixin",
    "mod",
    "model",
    "module",
    "mutable",
    "namespace",
    "new",
    "not",
    "null",
    "of",
    "open",
    "or",
    "override",
    "parallel",
    "private",
    "process",
    "protected",
    "public",
    "pure",
    "rec",
    "return",
    "running",
    "sealed",
    "sig",
    "started",
    "static",
    "string",
    "struct",
    "tailcall",
    "then",
    "to",
    "trait",
    "true",
    "try",
    "type",
    "upcast",
    "use",
    "val",
    "virtual",
    "void",
    "when",
    "while",
    "with",
    "yield",
    "abs",
    "acos",
    "again_",
    "asin",
    "atan",
    "atan2",
    "ceil",
    "cos",
    "exp",
    "floor",
    "log",
    "max",
    "min",
    "pown",
    "printfn",
    "sign",
    "sin",
    "single",
    "sqrt",
    "round",
    "truncate",
    "atomic",
    "break",
    "checked",
    "constructor",
    "continue",
    "method",
    "object",
    "select",
    "threads",
    "volatile",
];

fn number(number: Number) -> Row {
    use Number::*;
    match number {
        Add => call("($1 + $2)"),
        Subtract => call("($1 - $2)"),
        Multiply => call("($1 * $2)"),
        Divide | DividePlain => call("divide ($1) ($2)"),
        // Both cut towards 0, and both refuse 0.
        DivideWhole => infix("$1 / $2", 13),
        Modulo => infix("$1 % $2", 13),
        Power => call("(($1) ** ($2))"),
        Negate => call("(-$1)"),
        NegateSingle => call("float (-(float32 ($1)))"),
        BitAnd => call("($1 &&& $2)"),
        BitOr => call("($1 ||| $2)"),
        BitXor => call("($1 ^^^ $2)"),
        BitNot => call("(~~~$1)"),
        ShiftLeft => call("($1 <<< $2)"),
        ShiftRight => call("($1 >>> $2)"),
    }
}

fn truth(truth: Truth) -> Row {
    use Truth::*;
    match truth {
        Not => call("not ($1)"),
        And => infix("$1 && $2", 2),
        Or => infix("$1 || $2", 1),
        Less => apart("$1 < $2", 3),
        Greater => apart("$1 > $2", 3),
        LessEqual => apart("$1 <= $2", 3),
        GreaterEqual => apart("$1 >= $2", 3),
        Equal | EqualText => apart("$1 = $2", 3),
        NotEqual | NotEqualText => apart("$1 <> $2", 3),
        Again => call("again ($1, $2)"),
        EqualAny | NotEqualAny => NONE,
    }
}

fn conversion(conversion: Conversion) -> Row {
    use Conversion::*;
    match conversion {
        Join => infix("$1 + $2", 12),
        Length => postfix("$1.Length"),
        FloatOfInt => call("float ($1)"),
        WholeOfFloat => call("toWhole ($1)"),
        WholeOfBool => call("(if $1 then 1 else 0)"),
        WholeOfAny => call("toWhole (toNumber ($1))"),
        NumberOfAny => call("toNumber ($1)"),
        TruthOfAny => call("toTruth ($1)"),
        TextOfInt => call("string ($1)"),
        TextOfFloat | TextOfAny => call("toText ($1)"),
        TextOfBool => call("(if $1 then \"true\" else \"false\")"),
        Printed => call("toPrinted ($1)"),
        ValueOf => NONE,
    }
}

fn function(function: Function) -> Row {
    use Function::*;
    match function {
        Sin => call("sin ($1)"),
        Cos => call("cos ($1)"),
        Ln => call("log ($1)"),
        Exp => call("exp ($1)"),
        Asin => call("asin ($1)"),
        Acos => call("acos ($1)"),
        Atan => call("atan ($1)"),
        Sqrt => call("sqrt ($1)"),
        Abs => call("abs ($1)"),
        Sgn => call("sign ($1)"),
        Ceil => call("int (ceil ($1))"),
        Floor => call("int (floor ($1))"),
        Min => call("min ($1) ($2)"),
        Max => call("max ($1) ($2)"),
        Atan2 => call("atan2 ($1) ($2)"),
        Pi => call("System.Math.PI"),
        Time => infix("milliseconds () - started", 12),
        Random => call("randomWhole (int ($1), int ($2))"),
    }
}

fn element(element: Element) -> Row {
    use Element::*;
    match element {
        At => call("item ($1, $2)"),
        AtWhole => call("int (item ($1, $2))"),
        AtPlain => call("int ($1.[$2])"),
        Put => call("put ($1, $2, float ($3))"),
        Copy => call("ResizeArray<float> ($1)"),
    }
}

fn turn(turn: Turn) -> Row {
    use Turn::*;
    match turn {
        Wait => call("wait($1)"),
        AnyButton => call("anyButton($1)"),
        Start => call("startThread ($1, $2)"),
        Join => call("joinThread ($1)"),
        Kill => call("killThread ($1)"),
        Mail | Send | Receive | ReceiveNow => NONE,
    }
}

fn type_of(kind: &Kind) -> (&'static str, &'static str) {
    match kind {
        Kind::Int => ("int", "0"),
        Kind::Bool => ("bool", "false"),
        Kind::Text => ("string", "\"\""),
        Kind::List(_) => ("ResizeArray<float>", "ResizeArray<float> ()"),
        Kind::Float | Kind::Any => ("float", "0.0"),
    }
}

fn head(printer: &Printer<'_>, index: usize, routine: &Routine) -> String {
    let parameters = routine.parameters.iter().map(|&number| {
        let kind = printer.script.variables.all[number].kind.clone();
        let kind = kind.unwrap_or(Kind::Float);
        format!("{}: {}", printer.variables[number], type_of(&kind).0)
    });
    let parameters = parameters.collect::<Vec<_>>().join(", ");
    format!("{} ({parameters})", printer.functions[index])
}

fn assemble(printer: &Printer<'_>) -> String {
    let script = printer.script;
    let mut functions = String::new();
    let mut word = "let rec";
    for (index, routine) in script.routines.iter().enumerate().rev() {
        if let Owner::Thread(thread, _) = &routine.owner {
            let comment = printer.comment(&format!("The thread {thread}."));
            functions.push_str(&format!("{comment}\n"));
        }
        functions.push_str(&format!(
            "{word} {} : unit =\n",
            head(printer, index, routine)
        ));
        word = "and";
        functions.push_str("    let mutable running = true\n");
        // What is assigned to needs a variable of its own.
        for &number in routine
            .parameters
            .iter()
            .filter(|number| routine.assigned.contains(number))
        {
            let name = &printer.variables[number];
            functions.push_str(&format!("    let mutable {name} = {name}\n"));
        }
        let counters = [super::super::code::Own::Counter];
        for (name, kind) in printer.locals(routine, &counters) {
            functions.push_str(&format!("    let mutable {name} = {}\n", type_of(&kind).1));
        }
        functions.push_str(&printer.body(routine, 1));
        functions.push('\n');
    }
    let mut variables = String::new();
    for (number, variable) in script.variables.all.iter().enumerate() {
        if printer.is_global(number) {
            let kind = variable.kind.clone().unwrap_or(Kind::Float);
            let (of, start) = type_of(&kind);
            let name = &printer.variables[number];
            variables.push_str(&format!("let mutable {name} : {of} = {start}\n"));
        }
    }
    let begin = if script.names_threads {
        "    threads.[\"main\"] <- Thread.CurrentThread\n"
    } else {
        ""
    };
    let helpers = printer.helpers(&format!("{functions}{begin}"));
    let title = printer.comment(&printer.title);
    format!(
        "{title}\nmodule Program\n\nopen System\nopen System.Threading\nopen Trik\n\nlet model = new Model ()\nlet mutable started = 0\n{variables}\n{helpers}{functions}[<EntryPoint>]\nlet entry _ =\n    started <- Environment.TickCount\n{begin}    main ()\n    0\n"
    )
}
