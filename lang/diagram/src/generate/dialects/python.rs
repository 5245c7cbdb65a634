//! Python for TRIK: the module `trik` of the controller.
//!
//! Owns words of one language. It has only what the controller's own runtime has, too: programs with threads are in
//! `turns`.

pub(in super::super) mod turns;

use super::super::code::{Conversion, Element, Function, Number, Truth, Turn};
use super::super::names::Rules;
use super::super::plan::Owner;
use super::super::print::{
    Dialect, NONE, Printer, Row, Syntax, Tables, apart, call, float, infix, postfix, prefix, quote,
};
use super::super::routines::Abilities;
use super::javascript;
use crate::structure::Jumps;

/// The language.
pub(in super::super) const PYTHON: Dialect = Dialect {
    tables: Tables {
        number,
        truth,
        conversion,
        function,
        element,
        robot: javascript::robot,
        turn,
        phrase: |phrase| phrase.python,
    },
    syntax: Syntax {
        indent: "  ",
        comment: "# $1",
        statement: "$1",
        set: "$1 = $2",
        if_: "if $1:",
        else_if: "elif $1:",
        else_: "else:",
        end: "",
        forever: "while True:",
        while_: "while $1:",
        do_while: None,
        repeat: "for $2 in range($1):",
        repeat_plain: "for $2 in range($1):",
        end_loop: "",
        break_: "break",
        continue_: "continue",
        break_to: "break",
        continue_to: "continue",
        continue_label: "",
        name_loop: "",
        return_: "return",
        goto: "",
        label: "",
        empty: "pass",
        call: "self.$1($2)",
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
        leaves: true,
    },
    quote: |text| quote(text, |code| format!("\\u{code:04x}")),
    float,
    port: |name| format!("'{name}'"),
    truths: ["False", "True"],
    nil: "None",
    list: |parts| format!("[{}]", parts.join(", ")),
    variable: "self.$1",
    function: "self.$1",
    helpers: HELPERS,
    is_typed: false,
    assemble,
};

const RESERVED: &[&str] = &[
    "False",
    "None",
    "Program",
    "Threading",
    "True",
    "ValueError",
    "abs",
    "and",
    "as",
    "assert",
    "async",
    "await",
    "brick",
    "break",
    "class",
    "continue",
    "def",
    "del",
    "elif",
    "else",
    "except",
    "execMain",
    "finally",
    "float",
    "for",
    "from",
    "gamepad",
    "global",
    "if",
    "import",
    "in",
    "int",
    "is",
    "isinstance",
    "lambda",
    "len",
    "list",
    "mailbox",
    "math",
    "nonlocal",
    "not",
    "or",
    "pass",
    "pi",
    "print",
    "raise",
    "random",
    "range",
    "return",
    "script",
    "self",
    "str",
    "struct",
    "sys",
    "time",
    "try",
    "while",
    "with",
    "yield",
    "Turns",
    "turns",
    "__init__",
    "__class__",
    "__dict__",
];

fn number(number: Number) -> Row {
    use Number::*;
    match number {
        Add => infix("$1 + $2", 12),
        Subtract => infix("$1 - $2", 12),
        Multiply => infix("$1 * $2", 13),
        // Python itself refuses to divide by 0.
        Divide | DividePlain => infix("$1 / $2", 13),
        DivideWhole => call("divide_whole($1, $2)"),
        Modulo => call("modulo($1, $2)"),
        Power => call("math.pow($1, $2)"),
        Negate => prefix("-$1", 15),
        NegateSingle => call("negated($1)"),
        BitAnd => infix("$1 & $2", 9),
        BitOr => infix("$1 | $2", 7),
        BitXor => infix("$1 ^ $2", 8),
        BitNot => prefix("~$1", 15),
        ShiftLeft => call("shift_left($1, $2)"),
        ShiftRight => infix("$1 >> $2", 11),
    }
}

fn truth(truth: Truth) -> Row {
    use Truth::*;
    match truth {
        Not => prefix("not $1", 4),
        And => infix("$1 and $2", 3),
        Or => infix("$1 or $2", 2),
        Less => apart("$1 < $2", 6),
        Greater => apart("$1 > $2", 6),
        LessEqual => apart("$1 <= $2", 6),
        GreaterEqual => apart("$1 >= $2", 6),
        Equal | EqualText => apart("$1 == $2", 6),
        NotEqual | NotEqualText => apart("$1 != $2", 6),
        EqualAny => call("same($1, $2)"),
        NotEqualAny => prefix("not same($1, $2)", 4),
        Again => call("again($1, $2)"),
    }
}

fn conversion(conversion: Conversion) -> Row {
    use Conversion::*;
    match conversion {
        Join => infix("$1 + $2", 12),
        Length => call("len($1)"),
        FloatOfInt => call("$1"),
        WholeOfFloat => call("to_whole($1)"),
        WholeOfBool => call("int($1)"),
        WholeOfAny => call("to_whole(to_number($1))"),
        NumberOfAny => call("to_number($1)"),
        TruthOfAny => call("to_truth($1)"),
        TextOfInt => call("str($1)"),
        TextOfFloat | TextOfBool | TextOfAny => call("to_text($1)"),
        Printed => call("to_printed($1)"),
        ValueOf => call("to_value($1)"),
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
        Abs => call("abs($1)"),
        Sgn => call("sign($1)"),
        Ceil => call("math.ceil($1)"),
        Floor => call("math.floor($1)"),
        Min => call("min($1, $2)"),
        Max => call("max($1, $2)"),
        Atan2 => call("math.atan2($1, $2)"),
        Pi => call("math.pi"),
        Time => call("int(script.time() - self.__interpretation_started_timestamp__)"),
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

fn turn(turn: Turn) -> Row {
    use Turn::*;
    match turn {
        Wait => call("script.wait($1)"),
        AnyButton => call("brick.keys().buttonCode($1)"),
        Mail => call("mailbox.receive($1)"),
        // `turns` has them.
        Start | Join | Kill | Send | Receive | ReceiveNow => NONE,
    }
}

const HELPERS: &[(&str, &str)] = &[
    (
        "to_number",
        "
def to_number(value):
  \"\"\"A value as a number; a text that is none counts as 0.\"\"\"
  if isinstance(value, str):
    try:
      return float(value) if '_' not in value and 'n' not in value.lower() else 0
    except ValueError:
      return 0
  return value if isinstance(value, (int, float)) else 0",
    ),
    (
        "sign",
        "
def sign(number):
  \"\"\"-1, 0 or 1.\"\"\"
  return (number > 0) - (number < 0)",
    ),
    (
        "to_whole",
        "
def to_whole(number):
  \"\"\"The nearest whole number; halves go away from 0.\"\"\"
  whole = math.trunc(number)
  if abs(number - whole) >= 0.5:
    whole += 1 if number > 0 else -1
  return (int(whole) + 2 ** 31) % 2 ** 32 - 2 ** 31",
    ),
    (
        "to_truth",
        "
def to_truth(value):
  \"\"\"Whether a value counts as true.\"\"\"
  if isinstance(value, str):
    return value not in ('', '0') and value.lower() != 'false'
  return to_whole(to_number(value)) != 0",
    ),
    (
        "to_text",
        "
def to_text(value):
  \"\"\"A value as a text; tables and nothing are empty.\"\"\"
  if isinstance(value, bool):
    return 'true' if value else 'false'
  if isinstance(value, float):
    return str(int(value)) if value == math.trunc(value) and abs(value) < 1e15 else repr(value)
  return str(value) if isinstance(value, (int, str)) else ''",
    ),
    (
        "to_printed",
        "
def to_printed(text):
  \"\"\"A text as the display shows it: numbers with at most six digits after the point.\"\"\"
  try:
    number = float(text)
  except ValueError:
    return text
  if '_' in text or 'n' in text.lower():
    return text
  text = '%.6f' % number
  text = text.rstrip('0').rstrip('.')
  return '0' if text == '-0' else text",
    ),
    (
        "to_value",
        "
def to_value(message):
  \"\"\"The value that a message stands for.\"\"\"
  plain = message.strip()
  if len(plain) > 1 and plain[0] in '\"\\'' and plain[-1] == plain[0]:
    return plain[1:-1]
  for kind in (int, float):
    try:
      return kind(plain)
    except ValueError:
      pass
  return {'true': True, 'false': False}.get(plain, message)",
    ),
    (
        "same",
        "
def same(left, right):
  \"\"\"Whether two values are equal; a text is compared as what the other one is.\"\"\"
  if isinstance(left, list) and isinstance(right, list):
    return len(left) == len(right) and all(map(same, left, right))
  if isinstance(left, bool) and isinstance(right, str):
    return left == to_truth(right)
  if isinstance(left, str) and isinstance(right, (bool, int, float)):
    return left == to_text(right)
  if isinstance(left, (int, float)) and isinstance(right, str):
    return to_value(right) == left
  return left == right",
    ),
    (
        "divide_whole",
        "
def divide_whole(left, right):
  \"\"\"A quotient without its fraction.\"\"\"
  return abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)",
    ),
    (
        "modulo",
        "
def modulo(left, right):
  \"\"\"What is left of a division, with the sign of the first number.\"\"\"
  return abs(left) % abs(right) * (-1 if left < 0 else 1)",
    ),
    (
        "negated",
        "
def negated(number):
  \"\"\"The number with the other sign and as many digits as a small float has.\"\"\"
  return -struct.unpack('f', struct.pack('f', number))[0]",
    ),
    (
        "shift_left",
        "
def shift_left(number, bits):
  \"\"\"Within 32 bits.\"\"\"
  return ((number << (bits & 31)) + 2 ** 31) % 2 ** 32 - 2 ** 31",
    ),
    (
        "item",
        "
def item(table, index):
  \"\"\"An element of a table, 0 beyond its end.\"\"\"
  if index < 0:
    raise ValueError('Negative index for a table')
  return table[index] if index < len(table) and table[index] is not None else 0",
    ),
    (
        "put",
        "
def put(table, index, value):
  \"\"\"Sets an element of a table, which grows as needed.\"\"\"
  if index < 0:
    raise ValueError('Negative index for a table')
  table.extend([None] * (index + 1 - len(table)))
  table[index] = value",
    ),
    (
        "copy",
        "
def copy(value):
  \"\"\"A table of its own, so that changing one does not change the other.\"\"\"
  return [copy(part) for part in value] if isinstance(value, list) else value",
    ),
    (
        "again",
        "
_counters = {}


def again(loop, times):
  \"\"\"Whether a loop goes on. Its counter lives as long as the program: leaving part-way does not reset it.\"\"\"
  left = _counters.pop(loop, times) - 1
  if left >= 0:
    _counters[loop] = left
  return left >= 0",
    ),
];

fn assemble(printer: &Printer<'_>) -> String {
    assembled(printer, false)
}

/// The whole program. In one with turns each function is a generator.
fn assembled(printer: &Printer<'_>, has_turns: bool) -> String {
    let script = printer.script;
    let mut functions = String::new();
    for (index, routine) in script.routines.iter().enumerate() {
        let name = match routine.owner {
            Owner::Main => "execMain",
            Owner::Subprogram(_) | Owner::Thread(..) => &printer.functions[index],
        };
        let mut parameters = vec!["self"];
        let names = routine
            .parameters
            .iter()
            .map(|&number| printer.variables[number].as_str());
        parameters.extend(names);
        if let Owner::Thread(thread, _) = &routine.owner {
            functions.push_str(&format!(
                "  {}\n",
                printer.comment(&format!("The thread {thread}."))
            ));
        }
        functions.push_str(&format!("  def {name}({}):\n", parameters.join(", ")));
        if routine.owner == Owner::Main {
            functions.push_str("    self.__interpretation_started_timestamp__ = script.time()\n");
        }
        let is_inside = has_turns && routine.owner == Owner::Main;
        let depth = if is_inside { 3 } else { 2 };
        let indent = PYTHON.syntax.indent.repeat(depth);
        if is_inside {
            functions.push_str("    def body():\n");
        }
        let body = printer.body(routine, depth);
        functions.push_str(&body);
        if has_turns {
            // What makes it a generator, whatever it does.
            functions.push_str(&format!("{indent}if False:\n{indent}  yield\n"));
        } else if body.trim().is_empty() {
            functions.push_str("    pass\n");
        }
        if is_inside {
            functions.push_str("    turns.run(body)\n");
        }
        functions.push('\n');
    }
    let mut variables = String::new();
    for (number, variable) in script.variables.all.iter().enumerate() {
        if printer.is_global(number) {
            let name = &printer.variables[number];
            let kinds = ["0", "False", "''", "[]", "None"];
            let start = super::start_value(variable.kind.as_ref(), kinds);
            variables.push_str(&format!("  {name} = {start}\n"));
        }
    }
    let helpers = printer.helpers(&functions);
    let title = printer.comment(&printer.title);
    let modules = ["math", "random", "struct", "sys", "time"];
    let all = format!("{helpers}{functions}");
    let needed = modules
        .iter()
        .filter(|module| ["sys", "time"].contains(*module) || all.contains(&format!("{module}.")));
    let imports: String = needed.map(|module| format!("import {module}\n")).collect();
    format!(
        "{title}\n\n{imports}\n\n{helpers}class Program():\n  __interpretation_started_timestamp__ = 0\n{variables}\n{functions}\ndef main():\n  program = Program()\n  program.execMain()\n\n\nif __name__ == '__main__':\n  main()\n"
    )
}
