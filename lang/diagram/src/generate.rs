//! Programs as text: a project in another language, with the same behaviour.
//!
//! Owns the way from a project to a file: functions are planned, texts understood, graphs structured, statements
//! printed. A language is a file of tables in `dialects`; a block is an arm in `steps`, and what a
//! device says a row in `readings`. Knows no files.

mod build;
mod code;
mod commands;
mod dialects;
mod lines;
pub mod names;
mod origins;
pub(super) mod plan;
mod print;
mod readings;
mod routines;
pub mod row;
mod steps;
mod texts;
mod ticks;
mod words;

#[cfg(test)]
mod tests;

use super::lower::{World, lower};
use super::program::Node;
use super::project::Project;
use super::structure::{Jumps, Manner};
use code::{Code, Kind, Operation, Robot, each_code};
use lang_expr::value::Compat;
use lang_text::problem::{Problem, Severity};
use names::Names;
use print::{Dialect, Printer};
use routines::Abilities;
use row::Syntax;
use texts::Texts;

/// A language that programs are written in.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub enum Language {
    /// For the script engine of TRIK.
    JavaScript,
    /// For the module `trik`.
    Python,
    /// Over the files of the tree.
    Lua,
    /// Over the files of the tree.
    C,
    /// PascalABC.NET in the style of TRIK's library.
    Pascal,
    /// F# in the style of TRIK's library.
    FSharp,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::JavaScript,
        Self::Python,
        Self::Lua,
        Self::C,
        Self::Pascal,
        Self::FSharp,
    ];

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::JavaScript => "JavaScript",
            Self::Python => "Python",
            Self::Lua => "Lua",
            Self::C => "C",
            Self::Pascal => "PascalABC.NET",
            Self::FSharp => "F#",
        }
    }

    /// The ending of its files, without a point.
    pub fn ending(self) -> &'static str {
        match self {
            Self::JavaScript => "js",
            Self::Python => "py",
            Self::Lua => "lua",
            Self::C => "c",
            Self::Pascal => "pas",
            Self::FSharp => "fs",
        }
    }

    /// The language with a name, as a person types it: its name or the ending of its files, in any case.
    pub fn named(name: &str) -> Option<Self> {
        let name = name.to_lowercase();
        let is_it = |language: &Self| {
            language.name().to_lowercase() == name
                || language.ending() == name
                || (*language == Self::Pascal && ["pascal", "pascalabc"].contains(&name.as_str()))
                || (*language == Self::FSharp && name == "fsharp")
        };
        Self::ALL.into_iter().find(is_it)
    }

    /// Whether programs in it may jump: [`Options::goto`] changes nothing in others.
    pub fn has_goto(self) -> bool {
        self.dialect().abilities.jumps == Jumps::Goto
    }

    /// How statements look in it, for other generators.
    pub fn syntax(self) -> &'static Syntax {
        &self.dialect().syntax
    }

    /// No names yet but the words that it has itself, for other generators.
    pub fn names(self) -> Names {
        Names::new(self.dialect().rules)
    }

    fn dialect(self) -> &'static Dialect {
        match self {
            Self::JavaScript => &dialects::javascript::JAVASCRIPT,
            Self::Python => &dialects::python::PYTHON,
            Self::Lua => &dialects::lua::LUA,
            Self::C => &dialects::c::C,
            Self::Pascal => &dialects::pascal::PASCAL,
            Self::FSharp => &dialects::fsharp::FSHARP,
        }
    }
}

/// How a program is written.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Where it runs: some blocks do nothing in some places.
    pub world: World,
    /// Whether the oddities of the original are kept.
    pub compat: Compat,
    /// Whether jumps may be written as `goto`, in languages that have it, where arrows cross.
    pub goto: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            world: World::Robot,
            compat: Compat::Studio,
            goto: false,
        }
    }
}

/// A program as text.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The whole file, in UTF-8.
    pub text: String,
    /// What a person should know of it: warnings.
    pub notes: Vec<Problem>,
    /// Of each line the ids of the blocks that it says; none of one that is there for others.
    pub origins: Vec<Vec<String>>,
}

/// Writes a project in a language.
///
/// # Errors
/// All reasons why the project cannot be run, or cannot be written in this language, with the blocks.
pub fn generate(
    project: &Project,
    language: Language,
    options: Options,
) -> Result<Generated, Vec<Problem>> {
    let lowered = lower(project, options.world).map_err(|problem| vec![problem])?;
    let program = &lowered.program;
    let plan = plan::plan(program, plan::For::Generator(language.name()))?;
    let texts = Texts::new(program, &plan, options.compat)?;
    let dialect = language.dialect();
    let jumps = match (dialect.abilities.jumps, options.goto) {
        (Jumps::Goto, false) => Jumps::Plain,
        (jumps, _) => jumps,
    };
    let abilities = Abilities {
        jumps,
        ..dialect.abilities
    };
    let script = routines::routines(program, &plan, texts, abilities)?;
    let main = program
        .main
        .and_then(|main| program.diagrams.get(main as usize));
    let title = main.map_or("A diagram", |sheet| &sheet.name).to_owned();
    let title = format!("{title}: written from a diagram of TRIK Studio.");
    let mut printer = Printer::new(dialect, &script, program, title.clone());
    if language == Language::JavaScript && script.has_threads && !printer.shared().is_empty() {
        let dialect = &dialects::javascript::turns::TURNS;
        printer = Printer::new(dialect, &script, program, title);
    } else if language == Language::Python && script.names_threads {
        let dialect = &dialects::python::turns::TURNS;
        printer = Printer::new(dialect, &script, program, title);
    }
    let mut notes: Vec<Problem> = lowered.problems;
    notes.retain(|problem| problem.severity != Severity::Error);
    let problems = refusals(&printer, language);
    if !problems.is_empty() {
        return Err(problems);
    }
    notes.extend(remarks(&printer, language));
    let (text, lines) = printer.print();
    let blocks = |nodes: Vec<Node>| {
        let ids = nodes.into_iter().filter_map(|node| program.id(node));
        ids.map(str::to_owned).collect()
    };
    Ok(Generated {
        text,
        notes,
        origins: lines.into_iter().map(blocks).collect(),
    })
}

/// What the language cannot say.
fn refusals(printer: &Printer<'_>, language: Language) -> Vec<Problem> {
    let mut problems = Vec::new();
    if printer.dialect.is_typed {
        for variable in &printer.script.variables.all {
            let is_known = match &variable.kind {
                None | Some(Kind::Any) => false,
                Some(Kind::List(element)) => {
                    matches!(**element, Kind::Int | Kind::Float | Kind::Any)
                }
                Some(_) => true,
            };
            if !is_known && variable.kind.is_some() {
                let words = words::no_such_kind(&variable.name, language.name());
                problems.push(Problem::error(words));
            }
        }
    }
    let missing = missing(printer)
        .into_iter()
        .filter(|operation| !may_be_left_out(*operation));
    told_once(&mut problems, missing, |operation| {
        Problem::error(words::cannot(operation, language.name()))
    });
    problems
}

/// One problem for each thing, though a program may say it in several ways.
fn told_once(
    problems: &mut Vec<Problem>,
    operations: impl Iterator<Item = Operation>,
    tell: impl Fn(Operation) -> Problem,
) {
    for operation in operations {
        let problem = tell(operation);
        if !problems.iter().any(|known| known.words == problem.words) {
            problems.push(problem);
        }
    }
}

/// Things that a program uses and the language has no words for.
fn missing(printer: &Printer<'_>) -> Vec<Operation> {
    let mut missing = Vec::new();
    for routine in &printer.script.routines {
        each_code(&routine.body, &mut |code| {
            if let Code::Do(operation, _) = code
                && printer.dialect.tables.row(*operation).text.is_empty()
                && !missing.contains(operation)
            {
                missing.push(*operation);
            }
        });
    }
    missing
}

/// Whether a program is still one without this.
fn may_be_left_out(operation: Operation) -> bool {
    match operation {
        Operation::Command(command) => command.is_dispensable,
        Operation::Robot(Robot::Redraw | Robot::Finish) => true,
        Operation::Number(_)
        | Operation::Truth(_)
        | Operation::Conversion(_)
        | Operation::Function(_)
        | Operation::Element(_)
        | Operation::Robot(_)
        | Operation::Turn(_)
        | Operation::Read(_) => false,
    }
}

/// What a person should know.
fn remarks(printer: &Printer<'_>, language: Language) -> Vec<Problem> {
    let mut remarks = Vec::new();
    for (index, routine) in printer.script.routines.iter().enumerate() {
        let name = &printer.functions[index];
        match routine.manner {
            Manner::Exact => {}
            Manner::Copied => remarks.push(Problem::warning(words::copied_blocks(name))),
            Manner::States => remarks.push(Problem::warning(words::by_states(name))),
        }
    }
    // What is drawn is told by its block.
    let missing = missing(printer)
        .into_iter()
        .filter(|operation| !matches!(operation, Operation::Robot(_)));
    told_once(&mut remarks, missing, |operation| {
        Problem::warning(words::left_out(operation, language.name()))
    });
    if language == Language::JavaScript && printer.script.has_threads {
        let shared = printer.shared();
        if !shared.is_empty() {
            remarks.push(Problem::warning(words::shared_variables(
                &shared.join(", "),
            )));
        }
    }
    remarks
}
