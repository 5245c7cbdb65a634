//! Programs of data flow that a configuration names: from a save or a text to a chunk of Lua that every state loads.
//!
//! Owns what a name means, and how what is wrong with a program is told. The language is `lang`'s; the global `dataflow`
//! makes a node of what the chunk gives. Without the feature of that name only programs are known that were written as Lua
//! before, so that a controller needs none of it.

/// What a node's converter is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Language {
    /// In Lua, like other converters.
    Lua,
    /// In Lua, and in C beside it as `code`.
    C,
}

/// The program that the global `dataflow` asks for by this name of a chunk, and as what.
pub(crate) fn asked(name: &[u8]) -> Option<(&[u8], Language)> {
    let of = |prefix: &[u8], language| name.strip_prefix(prefix).map(|name| (name, language));
    of(b"dataflow:", Language::Lua).or_else(|| of(b"dataflow-c:", Language::C))
}

/// Whether a name is the program itself: a name has one line.
pub(crate) fn is_text(name: &[u8]) -> bool {
    name.contains(&b'\n')
}

/// Whether a name is that of a program that was written as Lua before.
pub(crate) fn is_written(name: &[u8]) -> bool {
    name.ends_with(b".lua") && !is_text(name)
}

/// The chunk of a program.
///
/// # Errors
/// That this program has no such feature.
#[cfg(not(feature = "dataflow"))]
pub(crate) fn chunk(
    _source: Vec<u8>,
    _name: &[u8],
    shown: &str,
    _language: Language,
) -> Result<String, crate::error::Error> {
    Err(crate::error::Error::Named(format!(
        "{shown}: this trikfs takes programs of data flow as Lua alone: write it on a PC with 'trik gen PROGRAM --lang lua', and name that file"
    )))
}

#[cfg(feature = "dataflow")]
pub(crate) use read::chunk;

#[cfg(feature = "dataflow")]
mod read {
    use super::{Language, is_text};
    use crate::error::Error;
    use crate::limits::MODEL_PROBLEMS_MAX;
    use lang_dataflow::check::check;
    use lang_dataflow::generate::{Target, generate};
    use lang_dataflow::project::Project;
    use lang_dataflow::read::{Language as Of, language, project};
    use lang_dataflow::text;
    use lang_text::problem::{Problem, Severity};

    /// The chunk of a program: it gives a table with `name`, lists `inputs`, `outputs` and `variables` of tables with `name`
    /// and `field`, and `new()`, which begins the program; in C also `code`.
    ///
    /// # Errors
    /// What is wrong with the program, each with its place.
    pub(crate) fn chunk(
        source: Vec<u8>,
        name: &[u8],
        shown: &str,
        wanted: Language,
    ) -> Result<String, Error> {
        let refuse = |problems: Vec<Problem>| told(shown, &problems);
        let opened = opened(source, name, shown)?;
        let checked = check(&opened);
        if checked.has_errors() {
            return Err(refuse(checked.problems));
        }
        let lua = generate(&checked.program, Target::Lua).map_err(refuse)?;
        match wanted {
            Language::Lua => Ok(lua),
            Language::C => {
                let code = generate(&checked.program, Target::C).map_err(refuse)?;
                Ok(format!(
                    "local program = (function()\n{lua}end)()\nprogram.code = {}\nreturn program\n",
                    quoted(&code)
                ))
            }
        }
    }

    fn opened(source: Vec<u8>, name: &[u8], shown: &str) -> Result<Project, Error> {
        let refuse = |problems: Vec<Problem>| told(shown, &problems);
        if is_text(name) || name.ends_with(b".flow") {
            let text = String::from_utf8(source)
                .map_err(|_| Error::Named(format!("{shown} is no text in UTF-8")))?;
            return text::read(&text).map_err(refuse);
        }
        let opened = lang_diagram::read::read(&source).map_err(refuse)?;
        if language(&opened.save) != Of::Dataflow {
            return Err(Error::Named(format!(
                "{shown} has no diagram of data flow; other diagrams cannot be converters"
            )));
        }
        let (project, problems) = project(&opened.save);
        let is_error = |problem: &Problem| problem.severity == Severity::Error;
        match problems.iter().any(is_error) {
            true => Err(refuse(problems)),
            false => Ok(project),
        }
    }

    /// The errors, one in each line.
    fn told(shown: &str, problems: &[Problem]) -> Error {
        let errors = problems
            .iter()
            .filter(|problem| problem.severity == Severity::Error);
        let mut lines: Vec<String> = errors.map(|one| format!("{shown}: {one}")).collect();
        let more = lines.len().saturating_sub(MODEL_PROBLEMS_MAX);
        lines.truncate(MODEL_PROBLEMS_MAX);
        if more > 0 {
            lines.push(format!("and {more} more"));
        }
        Error::Named(lines.join("\n"))
    }

    /// A text in Lua's long brackets, with as many signs as it has not itself.
    fn quoted(text: &str) -> String {
        let mut level = String::from("=");
        while text.contains(&format!("]{level}]")) {
            level.push('=');
        }
        format!("[{level}[\n{text}]{level}]")
    }
}

#[cfg(all(test, feature = "dataflow"))]
mod tests;
