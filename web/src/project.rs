//! A project: opened, looked through, shown, written as text.
//!
//! Owns which requests there are about one that does not run. Judging is in `judged`, a run in `run`.

use crate::failure::Failure;
use crate::options::Options;
use crate::words;
use lang_dataflow::generate::Target;
use lang_dataflow::show::{Extent, Looks};
use lang_diagram::generate::{self, Language};
use lang_diagram::show::outline::{self, outline};
use lang_diagram::show::picture::picture;
use lang_text::near::did_you_mean;
use lang_text::problem::{Locale, Problem};
use serde_json::{Value, json};
use std::path::Path;
use studio::findings::Findings;
use studio::lint::{Content, is_world, unread};
use studio::program::{self, Program};

/// A program of blocks, with the world that it is in.
#[derive(Clone, Debug)]
pub struct Project {
    /// The name of its file.
    pub name: String,
    /// What is in it.
    pub program: Program,
}

/// What a request came to, with the language of its messages.
pub type Answer<T> = (Result<T, Failure>, Locale);

/// Everything that is wrong with a file, as `trik lint --json` tells it: a save, a program in its textual form (`NAME.flow`),
/// a world. Options: `locale`.
pub fn lint(name: &str, bytes: Vec<u8>, options: &str) -> Answer<Value> {
    let mut locale = Locale::default();
    let looked = Options::read(options).and_then(|mut options| {
        locale = options.locale()?;
        options.end()?;
        let path = Path::new(name);
        let all = match Content::read(path, bytes) {
            Ok(content) => {
                let mut problems = content.problems();
                let findings = content.findings();
                findings.sort(&mut problems);
                findings.json(name, &problems, locale)
            }
            Err(why) => {
                let mut problems = why.problems();
                let findings = unread(path);
                findings.sort(&mut problems);
                findings.json(name, &problems, locale)
            }
        };
        Ok(Value::Array(all))
    });
    (looked, locale)
}

impl Project {
    /// Opens a save or a program in its textual form. Options: `locale`, and `diagram`, the main diagram that is run if it is
    /// not the first one.
    pub fn open(name: &str, bytes: Vec<u8>, options: &str) -> Answer<Self> {
        let mut locale = Locale::default();
        let opened = Options::read(options).and_then(|mut options| {
            locale = options.locale()?;
            let diagram = options.text("diagram")?;
            options.end()?;
            let path = Path::new(name);
            let is_text = program::is_text(path);
            if !is_text && is_world(&bytes) {
                let why = Problem::error(words::is_world());
                return Err(Failure::Unreadable(vec![why]));
            }
            let program = program::of_bytes(bytes, is_text, diagram.as_deref())?;
            Ok(Self {
                name: name.to_owned(),
                program,
            })
        });
        (opened, locale)
    }

    /// What is known of the places in it.
    pub fn findings(&self) -> Findings<'_> {
        match &self.program {
            Program::Diagram(opened) => Findings::new(Some(&opened.project)),
            Program::Flow(flow, _) | Program::Text(flow) => Findings::of_flow(flow),
        }
    }

    /// What it is: language, diagrams, which one is run, whether it has a world.
    pub fn about(&self) -> Value {
        let project = self.save();
        json!({
            "name": self.name,
            "language": match &self.program {
                Program::Diagram(_) => "diagram",
                Program::Flow(..) | Program::Text(_) => "dataflow",
            },
            "diagrams": self.diagrams(),
            "main": self.main().map(|main| self.diagrams()[main].to_owned()),
            "hasWorld": project.is_some_and(|project| project.world.is_some()),
        })
    }

    /// The project of the save that it is of.
    pub fn save(&self) -> Option<&lang_diagram::project::Project> {
        match &self.program {
            Program::Diagram(opened) | Program::Flow(_, opened) => Some(&opened.project),
            Program::Text(_) => None,
        }
    }

    fn diagrams(&self) -> Vec<&str> {
        match &self.program {
            Program::Diagram(opened) => {
                let all = opened.project.diagrams.iter();
                all.map(|one| &*one.name).collect()
            }
            Program::Flow(flow, _) | Program::Text(flow) => {
                let all = flow.project.diagrams.iter();
                all.map(|one| &*one.name).collect()
            }
        }
    }

    fn main(&self) -> Option<usize> {
        match &self.program {
            Program::Diagram(opened) => opened.project.main,
            Program::Flow(flow, _) | Program::Text(flow) => flow.project.main,
        }
    }

    /// The diagram with a name, or else the main one.
    fn chosen(&self, name: Option<&str>) -> Result<usize, Failure> {
        let all = self.diagrams();
        let Some(name) = name else {
            let main = self.main();
            return main.ok_or_else(|| Failure::Diagram(words::no_diagrams()));
        };
        all.iter().position(|one| *one == name).ok_or_else(|| {
            let near = did_you_mean(name, all);
            Failure::Diagram(words::no_diagram(name, &near))
        })
    }

    /// The program as sentences, as `trik show` prints it, or with `picture` one of its diagrams as SVG. Options: `locale`,
    /// `diagram`, `picture`, and of a data-flow program `all`, which says defaults too, and `source`, which is its textual form,
    /// of all diagrams.
    pub fn show(&self, options: &str) -> Answer<Value> {
        let mut locale = Locale::default();
        let shown = Options::read(options).and_then(|mut options| {
            locale = options.locale()?;
            let name = options.text("diagram")?;
            let is_picture = options.flag("picture")?;
            let with_defaults = options.flag("all")?;
            let is_source = options.flag("source")?;
            options.end()?;
            let at = self.chosen(name.as_deref())?;
            match &self.program {
                Program::Diagram(_) if is_source => Err(Failure::Request(words::no_source())),
                Program::Flow(flow, _) | Program::Text(flow) if is_source => {
                    Ok(lang_dataflow::text::write(&flow.project))
                }
                Program::Diagram(opened) if is_picture => {
                    Ok(picture(&opened.project.diagrams[at], locale))
                }
                Program::Diagram(opened) => {
                    let mut project = opened.project.clone();
                    // The program begins there.
                    project.main = Some(at);
                    outline(&project, locale).map_err(Failure::Program)
                }
                Program::Flow(flow, _) | Program::Text(flow) if is_picture => {
                    let mut looks = Looks::default();
                    let project = &flow.project;
                    Ok(lang_dataflow::show::picture(
                        project, at, locale, &mut looks,
                    ))
                }
                Program::Flow(flow, _) | Program::Text(flow) => {
                    let extent = Extent {
                        with_defaults,
                        from: name.is_some().then_some(at),
                    };
                    let project = &flow.project;
                    Ok(lang_dataflow::show::sentences(project, extent, locale))
                }
            }
        });
        (shown.map(Value::String), locale)
    }

    /// The sentences of `show` line by line, each with the ids of the blocks that it tells of. Options: `locale` and `diagram`.
    pub fn outline(&self, options: &str) -> Answer<Value> {
        let mut locale = Locale::default();
        let shown = Options::read(options).and_then(|mut options| {
            locale = options.locale()?;
            let name = options.text("diagram")?;
            options.end()?;
            let at = self.chosen(name.as_deref())?;
            match &self.program {
                Program::Diagram(opened) => {
                    let mut project = opened.project.clone();
                    // The program begins there.
                    project.main = Some(at);
                    let lines = outline::lines(&project, locale).map_err(Failure::Program)?;
                    let line = |one: &outline::Line| json!({"text": one.text, "blocks": one.blocks});
                    Ok(lines.iter().map(line).collect())
                }
                Program::Flow(flow, _) | Program::Text(flow) => {
                    let extent = Extent {
                        with_defaults: false,
                        from: name.is_some().then_some(at),
                    };
                    let lines = lang_dataflow::show::lines(&flow.project, extent, locale);
                    let line = |one: &lang_dataflow::show::Line| {
                        json!({"text": one.text, "blocks": one.block.as_slice()})
                    };
                    Ok(lines.iter().map(line).collect())
                }
            }
        });
        (shown, locale)
    }

    /// The program in a language with text, as `trik gen` writes it, with notes. Options: `locale` and `goto`.
    pub fn generate(&self, language: &str, options: &str) -> Answer<Value> {
        let mut locale = Locale::default();
        let written = Options::read(options).and_then(|mut options| {
            locale = options.locale()?;
            let goto = options.flag("goto")?;
            options.end()?;
            let named = Language::named(language);
            let language = named.ok_or_else(|| {
                let all = "python, javascript, lua, c, pascal, fsharp";
                Failure::Request(words::wrong_kind(language, all))
            })?;
            if goto && !language.has_goto() {
                return Err(Failure::Request(words::no_goto(language.name())));
            }
            match &self.program {
                Program::Diagram(opened) => {
                    let how = generate::Options {
                        goto,
                        ..generate::Options::default()
                    };
                    let written = generate::generate(&opened.project, language, how);
                    let written = written.map_err(Failure::Program)?;
                    let mut notes = written.notes;
                    let findings = self.findings();
                    findings.sort(&mut notes);
                    let notes = findings.json(&self.name, &notes, locale);
                    Ok(json!({"text": written.text, "notes": notes, "blocks": written.origins}))
                }
                Program::Flow(flow, _) | Program::Text(flow) => {
                    let target = converter(language)?;
                    let program = flow.ready().map_err(Failure::Program)?;
                    let text = lang_dataflow::generate::generate(&program, target);
                    Ok(json!({"text": text.map_err(Failure::Program)?, "notes": [], "blocks": []}))
                }
            }
        });
        (written, locale)
    }
}

/// The language of a converter that a data-flow program becomes.
fn converter(language: Language) -> Result<Target, Failure> {
    match language {
        Language::Lua => Ok(Target::Lua),
        Language::C => Ok(Target::C),
        Language::JavaScript | Language::Python | Language::Pascal | Language::FSharp => {
            Err(Failure::Request(words::no_converter(language.name())))
        }
    }
}
