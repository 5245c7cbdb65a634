//! Statements as lines of a language, by the tables of its dialect.
//!
//! Owns brackets, indentation and names. Knows no language: all words come from the dialect.

use super::code::{
    Code, Conversion, Element, Function, Kind, Number, Operation, Own, Robot, Statement, Truth,
    Turn, each_code,
};
use super::lines::find_named;
use super::names::{Names, Rules};
use super::origins;
use super::plan::Owner;
use super::routines::{Abilities, Routine, Script};
pub(super) use super::row::{
    NONE, Row, Syntax, apart, call, fill, float, infix, postfix, prefix, quote,
};
use super::row::{SUM, is_hidden};
use crate::blocks::act::Phrase;
use crate::program::{Node, Program};

/// The words of a language for each group of operations. Each is a match in full, so that a new operation does not
/// compile until every language has words for it or [`NONE`].
#[derive(Clone, Copy)]
pub(super) struct Tables {
    pub(super) number: fn(Number) -> Row,
    pub(super) truth: fn(Truth) -> Row,
    pub(super) conversion: fn(Conversion) -> Row,
    pub(super) function: fn(Function) -> Row,
    pub(super) element: fn(Element) -> Row,
    pub(super) robot: fn(Robot) -> Row,
    pub(super) turn: fn(Turn) -> Row,
    /// Its words in the row of a block or of a reading.
    pub(super) phrase: fn(&'static Phrase) -> &'static str,
}

impl Tables {
    /// How an operation is said.
    pub(super) fn row(&self, operation: Operation) -> Row {
        match operation {
            Operation::Number(number) => (self.number)(number),
            Operation::Truth(truth) => (self.truth)(truth),
            Operation::Conversion(conversion) => (self.conversion)(conversion),
            Operation::Function(function) => (self.function)(function),
            Operation::Element(element) => (self.element)(element),
            Operation::Robot(robot) => (self.robot)(robot),
            Operation::Turn(turn) => (self.turn)(turn),
            Operation::Read(reading) => call((self.phrase)(&reading.phrase)),
            Operation::Command(command) => call((self.phrase)(command.phrase)),
        }
    }
}

/// A language.
pub(super) struct Dialect {
    pub(super) tables: Tables,
    pub(super) syntax: Syntax,
    pub(super) rules: Rules,
    pub(super) abilities: Abilities,
    pub(super) quote: fn(&str) -> String,
    pub(super) float: fn(f64) -> String,
    pub(super) port: fn(&str) -> String,
    pub(super) truths: [&'static str; 2],
    pub(super) nil: &'static str,
    /// Around the elements of a table.
    pub(super) list: fn(&[String]) -> String,
    /// A variable of the program.
    pub(super) variable: &'static str,
    /// A function of the program as a value.
    pub(super) function: &'static str,
    /// What helpers define, names with spaces between, and how they are written; a helper may use those before it.
    pub(super) helpers: &'static [(&'static str, &'static str)],
    /// Kinds that variables must have: the language wants to know them.
    pub(super) is_typed: bool,
    /// Puts everything together.
    pub(super) assemble: fn(&Printer<'_>) -> String,
}

/// Prints one program.
pub(super) struct Printer<'a> {
    pub(super) dialect: &'a Dialect,
    pub(super) script: &'a Script,
    pub(super) program: &'a Program,
    /// What the file says of itself.
    pub(super) title: String,
    pub(super) variables: Vec<String>,
    pub(super) functions: Vec<String>,
    /// Of the routine that is printed.
    parameters: Vec<usize>,
    /// Loops that are named by breaks and continues from inside of other loops.
    pub(super) named: Vec<usize>,
    pub(super) around: Vec<usize>,
    /// What the statement says that is printed.
    pub(super) from: Vec<Node>,
}

impl<'a> Printer<'a> {
    pub(super) fn new(
        dialect: &'a Dialect,
        script: &'a Script,
        program: &'a Program,
        title: String,
    ) -> Self {
        let mut names = Names::new(dialect.rules);
        for (defined, _) in dialect.helpers {
            for name in defined.split(' ') {
                names.take(name);
            }
        }
        let functions = script.routines.iter().map(|routine| match &routine.owner {
            Owner::Main => names.take("main"),
            Owner::Thread(name, _) => names.take(&format!("TASK_{name}")),
            Owner::Subprogram(diagram) => {
                let sheet = program.diagrams.get(*diagram as usize);
                names.take(sheet.map_or("subprogram", |sheet| &sheet.name))
            }
        });
        let functions: Vec<String> = functions.collect();
        let all = script.variables.all.iter();
        let variables = all.map(|variable| names.take(&variable.name)).collect();
        Self {
            dialect,
            script,
            program,
            title,
            variables,
            functions,
            parameters: Vec::new(),
            named: Vec::new(),
            around: Vec::new(),
            from: Vec::new(),
        }
    }

    /// The whole program, and the blocks that each of its lines says.
    pub(super) fn print(&self) -> (String, Vec<Vec<Node>>) {
        let text = (self.dialect.assemble)(self);
        let mut out = String::with_capacity(text.len());
        let mut origins = Vec::new();
        // One end of line everywhere, no spaces before it, no two empty lines.
        let mut empty = 0;
        for line in text.lines() {
            let (line, nodes) = origins::read(line);
            let line = line.trim_end();
            empty = if line.is_empty() { empty + 1 } else { 0 };
            if empty <= 1 {
                out.push_str(line);
                out.push('\n');
                origins.push(nodes);
            }
        }
        (out, origins)
    }

    /// The helpers that a text uses, in order.
    pub(super) fn helpers(&self, text: &str) -> String {
        let mut used = vec![false; self.dialect.helpers.len()];
        let mut needs = self.without_texts(text);
        for (index, (defined, body)) in self.dialect.helpers.iter().enumerate().rev() {
            if defined.split(' ').any(|name| has_word(&needs, name)) {
                used[index] = true;
                needs.push_str(body);
            }
        }
        let mut out = String::new();
        for (used, (_, body)) in used.into_iter().zip(self.dialect.helpers) {
            if used {
                out.push_str(body.trim_matches('\n'));
                out.push_str("\n\n");
            }
        }
        out
    }

    /// A program without comments and texts in quotes: names in them mean nothing.
    fn without_texts(&self, program: &str) -> String {
        let comment = self.dialect.syntax.comment;
        let comment = comment.split('$').next().unwrap_or_default();
        let escapes = (self.dialect.quote)("\\").contains("\\\\");
        let mut out = String::with_capacity(program.len());
        for line in program.lines() {
            if line.trim_start().starts_with(comment) {
                continue;
            }
            let mut quote = None;
            let mut letters = line.chars();
            while let Some(letter) = letters.next() {
                if quote == Some(letter) {
                    quote = None;
                    continue;
                }
                match quote {
                    None if letter == '"' || letter == '\'' => quote = Some(letter),
                    None => out.push(letter),
                    Some(_) if letter == '\\' && escapes => {
                        letters.next();
                    }
                    Some(_) => {}
                }
            }
            out.push('\n');
        }
        out
    }

    /// A comment in one line.
    pub(super) fn comment(&self, text: &str) -> String {
        let text: String = text
            .chars()
            // What begins a line, or turns the direction of letters so that a reader sees another program.
            .map(|letter| if is_hidden(letter) { ' ' } else { letter })
            // Nothing that ends a comment, or the line with it.
            .filter(|letter| !"\\{}".contains(*letter))
            .collect();
        let text = text.replace("*/", "* /").replace("/*", "/ *");
        fill(self.dialect.syntax.comment, &[&text])
    }

    /// The body of a routine.
    pub(super) fn body(&self, routine: &Routine, depth: usize) -> String {
        let mut named = Vec::new();
        find_named(&routine.body, &mut Vec::new(), &mut named);
        let mut inner = Printer {
            dialect: self.dialect,
            script: self.script,
            program: self.program,
            title: String::new(),
            variables: self.variables.clone(),
            functions: self.functions.clone(),
            parameters: routine.parameters.clone(),
            named,
            around: Vec::new(),
            from: Vec::new(),
        };
        let mut out = String::new();
        inner.list(&routine.body, depth, &mut out);
        out
    }

    /// Whether a variable is seen by more than the function whose parameter it is, or is none.
    pub(super) fn is_global(&self, number: usize) -> bool {
        let routines = &self.script.routines;
        self.script.variables.all[number].kind.is_some()
            && !routines
                .iter()
                .any(|routine| routine.parameters.contains(&number))
    }

    /// How many counters loops share.
    pub(super) fn counters(&self) -> i64 {
        let mut count = 0;
        for routine in &self.script.routines {
            each_code(&routine.body, &mut |code| {
                if let Code::Do(Operation::Truth(Truth::Again), operands) = code
                    && let Some(Code::Int(number)) = operands.first()
                {
                    count = count.max(number + 1);
                }
            });
        }
        count
    }

    /// Names of variables that several threads use and at least one sets.
    pub(super) fn shared(&self) -> Vec<&str> {
        let all = self.script.variables.all.iter().enumerate();
        let shared = all.filter(|(number, _)| {
            let mut users = 0;
            let mut setters = 0;
            for routine in &self.script.routines {
                users += usize::from(uses(&routine.body, *number));
                setters += usize::from(routine.assigned.contains(number));
            }
            users > 1 && setters > 0
        });
        shared.map(|(_, variable)| &*variable.name).collect()
    }

    /// Names and kinds of the generator's variables of a routine, but for those of these uses.
    pub(super) fn locals(&self, routine: &Routine, without: &[Own]) -> Vec<(String, Kind)> {
        let all = routine
            .locals
            .iter()
            .filter(|(_, (own, _))| !without.contains(own));
        all.map(|((_, number), (own, kind))| (own_name(*own, *number), kind.clone()))
            .collect()
    }

    /// An expression that binds at least so strongly.
    pub(super) fn code(&self, code: &Code, least: u8) -> String {
        let dialect = self.dialect;
        match code {
            Code::Int(number) if *number < 0 && least >= SUM => format!("({number})"),
            Code::Int(number) => number.to_string(),
            Code::Float(number) => {
                let text = (dialect.float)(*number);
                if text.starts_with('-') && least >= SUM {
                    format!("({text})")
                } else {
                    text
                }
            }
            Code::Bool(truth) => dialect.truths[usize::from(*truth)].to_owned(),
            Code::Text(text) => (dialect.quote)(text),
            Code::Nil => dialect.nil.to_owned(),
            Code::Port(name) => (dialect.port)(name),
            Code::Variable(number) => {
                let name = &self.variables[*number];
                if self.parameters.contains(number) {
                    name.clone()
                } else {
                    fill(dialect.variable, &[name])
                }
            }
            Code::Own(own, number) => own_name(*own, *number),
            Code::Function(number) => {
                let name = &self.functions[*number];
                fill(dialect.function, &[name])
            }
            Code::List(parts) => {
                let parts: Vec<_> = parts.iter().map(|part| self.code(part, 0)).collect();
                (dialect.list)(&parts)
            }
            // Nothing needs to be said: the operand stands for itself.
            Code::Do(operation, operands)
                if dialect.tables.row(*operation).text == "$1" && operands.len() == 1 =>
            {
                self.code(&operands[0], least)
            }
            Code::Do(operation, operands) => {
                let row = dialect.tables.row(*operation);
                let said = operands.iter().enumerate().map(|(index, operand)| {
                    self.code(operand, row.needs.get(index).copied().unwrap_or(0))
                });
                let said: Vec<String> = said.collect();
                let said: Vec<&str> = said.iter().map(String::as_str).collect();
                let text = fill(row.text, &said);
                if row.binds < least {
                    format!("({text})")
                } else {
                    text
                }
            }
        }
    }
}

/// The name of a variable of the generator.
pub(super) fn own_name(own: Own, number: usize) -> String {
    format!("__{}{}", super::steps::own_name(own), number + 1)
}

/// Whether a text has this name as a whole word.
pub(super) fn has_word(text: &str, word: &str) -> bool {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    text.match_indices(word).any(|(at, _)| {
        let before = text[..at].chars().next_back();
        let behind = text[at + word.len()..].chars().next();
        !before.is_some_and(is_part) && !behind.is_some_and(is_part)
    })
}

/// Whether a variable stands in a list.
fn uses(list: &[Statement], number: usize) -> bool {
    let mut found = false;
    each_code(list, &mut |code| found |= *code == Code::Variable(number));
    found
}
