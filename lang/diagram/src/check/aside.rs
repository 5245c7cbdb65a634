//! Expressions that a person gives a debugger, checked before they are computed for the first time.
//!
//! Owns what is wrong with one whatever the program does: a text that cannot be read, a name that nothing gives a value,
//! types that never fit, and what would change the run. Computes nothing.

use super::{Flow, Taught, each_node, given, taught};
use crate::program::{Leads, Program};
use crate::words;
use lang_expr::reserved::SENSORS;
use lang_expr::tree::{Node as Part, Tree};
use lang_expr::words::{Fault, Reason};
use lang_expr::{Kind, Names, Source, Wanted};
use lang_text::problem::{Place, Position, Problem, Words, position};
use std::collections::BTreeSet;
use std::rc::Rc;

/// Functions that an expression cannot have that is only looked at.
const ACTIVE: [&str; 2] = ["print", "random"];

/// What a program has come to know while it ran.
pub(crate) struct Known<'a> {
    pub program: &'a Program,
    pub names: &'a Names,
    /// Whether a variable has a value.
    pub has_value: &'a dyn Fn(&str) -> bool,
}

impl Known<'_> {
    fn kind(&self, name: &str) -> Option<&Kind> {
        let slot = self.names.find(name)?;
        self.names.kind(slot)
    }

    /// Whether a name is neither a variable with a value nor something that needs none.
    fn lacks(&self, name: &str) -> bool {
        match self.kind(name) {
            Some(Kind::Sensor(_) | Kind::Constant(_) | Kind::Function(_)) => false,
            Some(Kind::Variable) | None => !(self.has_value)(name),
        }
    }
}

/// What is wrong with an expression; nothing, if it may be good.
pub(crate) fn mistakes(known: &Known<'_>, text: &str) -> Vec<Problem> {
    let mut source = Source::new(text, Wanted::Any);
    let forbidden = forbidden(known, source.tree());
    if !forbidden.is_empty() {
        return forbidden;
    }
    let mut lacking = Vec::new();
    each_node(source.tree(), &mut |tree, part, id| {
        if let Part::Name(name) = part
            && known.lacks(name)
        {
            lacking.push((name.clone(), tree.place(id)));
        }
    });
    if lang_expr::analyse(&mut source, &mut known.names.clone()).is_ok() && lacking.is_empty() {
        return source.odd_numbers();
    }
    // Perhaps the program has not come to what teaches a name.
    let mut names = known.names.clone();
    let flow = Flow::of(known.program);
    let Taught { texts, unknown, .. } = taught(known.program, &flow, &mut names);
    let given = given(known.program, &flow, &texts);
    lacking.retain(|(name, _)| !given.contains(name));
    if !lacking.is_empty() {
        lacking.sort_by_key(|(_, at)| *at);
        let problems = lacking.into_iter().map(|(name, at)| {
            let fault = Fault::new(Reason::Undeclared(name.to_string()), at);
            lang_expr::explained(&fault, source.tree(), &names)
        });
        return problems
            .take(lang_expr::limits::EXPRESSION_PROBLEMS_MAX)
            .collect();
    }
    let mut source = Source::new(text, Wanted::Any);
    let Err(found) = lang_expr::analyse(&mut source, &mut names) else {
        return source.odd_numbers();
    };
    let mut is_known = true;
    each_node(source.tree(), &mut |_, part, _| {
        if let Part::Name(name) = part {
            is_known &= !unknown.contains(&**name);
        }
    });
    // What a message brings is known when it is there.
    let is_certain = is_known || source.tree().root.is_none();
    if is_certain { found } else { Vec::new() }
}

/// Why a person cannot give this variable a value: neither the program's text has it, nor has it a value. Sensors and what
/// never changes are for the language of expressions to refuse.
pub(crate) fn no_assignment(known: &Known<'_>, name: &str) -> Option<Problem> {
    if !known.lacks(name) {
        return None;
    }
    let program = known.program;
    let mut said: BTreeSet<Rc<str>> = BTreeSet::new();
    // Blocks that nothing leads to are text of the program all the same, as are names that are only read.
    for text in &program.sources {
        let source = Source::new(&text.text, text.wanted.wanted());
        said.extend(source.names().map(Rc::from));
    }
    for node in (0..).take(program.len()) {
        if let Some((assignment, _)) = program.given(node) {
            said.insert((&*assignment.variable).into());
        }
        if let Some(Leads::Call(call, _)) = program.leads(node) {
            let arguments = call.arguments.iter();
            said.extend(arguments.map(|argument| Rc::from(&*argument.name)));
        }
    }
    let valued = known.names.variables();
    let valued = valued.filter(|(_, name, _)| (known.has_value)(name));
    said.extend(valued.map(|(_, name, _)| Rc::from(name)));
    said.retain(|name| matches!(known.kind(name), Some(Kind::Variable) | None));
    let all: Vec<&str> = said.iter().map(|name| &**name).collect();
    (!all.contains(&name)).then(|| Problem::error(words::no_variable(name, &all)))
}

/// Whether a statement that gives a variable the answer of a person fights with what the program's texts do with it,
/// whichever of them the program has come to.
pub(crate) fn fights(known: &Known<'_>, variable: &str, statement: &str) -> bool {
    let flow = Flow::of(known.program);
    // Texts that are wrong after this statement, and more than all if it is wrong itself.
    let wrong = |statement: &str| {
        let mut names = known.names.clone();
        let mut source = Source::new(statement, Wanted::Statements);
        if lang_expr::analyse(&mut source, &mut names).is_err() {
            return usize::MAX;
        }
        let Taught { mut texts, .. } = taught(known.program, &flow, &mut names);
        // All names are known by now, and a text teaches none.
        let is_wrong = |text: &mut Source| lang_expr::analyse(text, &mut names).is_err();
        texts
            .values_mut()
            .map(is_wrong)
            .filter(|wrong| *wrong)
            .count()
    };
    let here = wrong(statement);
    // Texts that fight among themselves leave no good answer, which is not the fault of this one.
    let is_better = |text: &str| wrong(&format!("{variable} = {text}")) < here;
    here > 0 && ["0", "''"].into_iter().any(is_better)
}

/// What is wrong with a name as one of a variable or a sensor of the program.
pub(crate) fn no_variable(known: &Known<'_>, name: &str) -> Vec<Problem> {
    match known.kind(name) {
        Some(Kind::Constant(_) | Kind::Function(_)) => {
            vec![Problem::error(words::never_changes(name))]
        }
        Some(Kind::Variable | Kind::Sensor(_)) | None => mistakes(known, name),
    }
}

/// What is wrong with the expressions in the braces of a line, with places in the line.
pub(crate) fn mistakes_of_line(
    line: &str,
    mistakes: impl Fn(&str) -> Vec<Problem>,
) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut rest = line;
    while let Some((before, after)) = rest.split_once('{') {
        let begins = line.len() - rest.len() + before.len() + 1;
        let Some((expression, after_it)) = after.split_once('}') else {
            problems.push(at_column(line, begins - 1, words::open_brace()));
            break;
        };
        if expression.trim().is_empty() {
            problems.push(at_column(line, begins - 1, words::empty_braces()));
        }
        let begins = line[..begins].chars().count() as u32;
        problems.extend(mistakes(expression).into_iter().map(|mut problem| {
            if let Some(at) = problem.place.position.as_mut().filter(|at| at.line == 1) {
                at.column = at.column.saturating_add(begins);
            }
            problem
        }));
        rest = after_it;
    }
    problems.truncate(lang_expr::limits::EXPRESSION_PROBLEMS_MAX);
    problems
}

/// An error at a byte of a line.
fn at_column(line: &str, at: usize, words: Words) -> Problem {
    let mut problem = Problem::error(words);
    problem.place.position = Some(position(line, at));
    problem
}

/// An assignment in a text that is only looked at.
pub fn assignment(text: &str) -> Option<Problem> {
    let source = Source::new(text, Wanted::Any);
    let mut found = None;
    each_node(source.tree(), &mut |tree, part, id| {
        if let Part::Assign { .. } = part {
            let mut problem = Problem::error(words::assigns());
            problem.place.position = Some(tree.place(id));
            found.get_or_insert(problem);
        }
    });
    found
}

/// What would change the run, or is not known to a program that does not ask for it.
fn forbidden(known: &Known<'_>, tree: &Tree) -> Vec<Problem> {
    let mut found: Vec<(Position, Words)> = Vec::new();
    each_node(tree, &mut |tree, part, id| {
        let at = tree.place(id);
        match part {
            Part::Assign { .. } => found.push((at, words::assigns())),
            Part::Call { function, .. } => {
                if let Part::Name(name) = tree.node(*function)
                    && ACTIVE.contains(&&**name)
                {
                    found.push((at, words::only_looked(name)));
                }
            }
            Part::Name(name) => {
                if let Some(Kind::Sensor(index)) = known.kind(name)
                    && !reads(known.program, usize::from(*index))
                {
                    found.push((at, words::not_read(name)));
                }
            }
            Part::Nil
            | Part::Bool(_)
            | Part::Int(_)
            | Part::Float(_)
            | Part::Text(_)
            | Part::RawText(_)
            | Part::Unary(..)
            | Part::Binary(..)
            | Part::Index { .. }
            | Part::Method { .. }
            | Part::Table { .. }
            | Part::Block(_) => {}
        }
    });
    found.sort_by_key(|(at, _)| *at);
    found.truncate(lang_expr::limits::EXPRESSION_PROBLEMS_MAX);
    let problems = found.into_iter().map(|(at, words)| Problem {
        place: Place {
            position: Some(at),
            ..Place::default()
        },
        ..Problem::error(words)
    });
    problems.collect()
}

/// Whether the program asks for a sensor, as far as its texts tell.
fn reads(program: &Program, sensor: usize) -> bool {
    let name = SENSORS.get(sensor).map_or("", |row| row.name);
    let mut sources = program.sources.iter();
    sources.any(|source| source.text.contains(name))
}
