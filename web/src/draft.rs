//! A project that a person draws: changes in, sheets and findings out.
//!
//! Owns what a page is told of a drawing. What a change does is known in `lang_diagram::edit`, how it is written in JSON in
//! `change`.

use crate::change;
use crate::failure::Failure;
use crate::flow;
use crate::options::Options;
use crate::project::{self, Answer};
use crate::words;
use lang_dataflow::edit::DataFlow;
use lang_dataflow::read::Language;
use lang_diagram::check;
use lang_diagram::edit::notation::{ControlFlow, Notation};
use lang_diagram::edit::{Editor, Piece};
use lang_diagram::ports::Kit;
use lang_diagram::project::{Block, Diagram, DiagramKind, Link, Project};
use lang_diagram::read::{Opened, Save};
use lang_diagram::show;
use lang_expr::names::{Kind, is_own};
use lang_text::problem::{Locale, Problem};
use serde_json::{Value, json};
use std::cell::OnceCell;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use studio::findings::Findings;
use studio::lint;
use studio::program::{self, Flow, Program};

/// A project while it is drawn.
#[derive(Clone, Debug)]
pub struct Draft {
    /// The name of its file.
    pub name: String,
    language: Language,
    editor: Editor,
    /// What was strange in the file.
    found: Vec<Problem>,
    /// What it means now; made when it is asked for.
    meaning: OnceCell<Meaning>,
}

/// What a drawing means.
#[derive(Clone, Debug)]
struct Meaning {
    /// Its diagrams of control flow, its kit and its world.
    project: Project,
    /// What is strange about these.
    problems: Vec<Problem>,
    /// Its diagrams of data flow, if these are drawn.
    flow: Option<Flow>,
}

impl Draft {
    /// Opens a save to be changed, or a data-flow program in its textual form, which becomes a save: its comments are not
    /// kept. Options: `locale`. `seed` makes ids of what is new unlike those of other projects.
    pub fn open(name: &str, bytes: Vec<u8>, options: &str, seed: u128) -> Answer<Self> {
        let mut locale = Locale::default();
        let opened = Options::read(options).and_then(|mut options| {
            locale = options.locale()?;
            options.end()?;
            let is_text = program::is_text(Path::new(name));
            if !is_text && lint::is_world(&bytes) {
                let why = Problem::error(words::is_world());
                return Err(Failure::Unreadable(vec![why]));
            }
            Ok(match program::of_bytes(bytes, is_text, None)? {
                Program::Diagram(opened) => {
                    Self::of(name, Language::Diagram, opened.save, opened.problems, seed)
                }
                Program::Flow(_, opened) => {
                    Self::of(name, Language::Dataflow, opened.save, opened.problems, seed)
                }
                Program::Text(flow) => {
                    let save = lang_dataflow::save::save(&flow.project);
                    let name = Path::new(name).with_extension("qrs");
                    let name = name.to_string_lossy();
                    Self::of(&name, Language::Dataflow, save, Vec::new(), seed)
                }
            })
        });
        (opened, locale)
    }

    fn of(name: &str, language: Language, save: Save, found: Vec<Problem>, seed: u128) -> Self {
        Self {
            name: name.to_owned(),
            language,
            editor: Editor::of(notation(language), save, seed),
            found,
            meaning: OnceCell::new(),
        }
    }

    /// A new project. Options: `locale`, `kit`, which is `trikV62Kit` or `trikV6Kit`, and `language`, which is `diagram` or
    /// `dataflow`.
    pub fn blank(name: &str, options: &str, seed: u128) -> Answer<Self> {
        let mut locale = Locale::default();
        let made = Options::read(options).and_then(|mut options| {
            locale = options.locale()?;
            let kit = options.text("kit")?;
            let language = options.language()?;
            options.end()?;
            let kit = match kit.as_deref() {
                None => Kit::V62,
                Some(id) => Kit::of_id(id).ok_or_else(|| Failure::Request(words::no_kit()))?,
            };
            Ok(Self {
                name: name.to_owned(),
                language,
                editor: Editor::blank_of(notation(language), kit, locale, seed),
                found: Vec::new(),
                meaning: OnceCell::new(),
            })
        });
        (made, locale)
    }

    fn meaning(&self) -> &Meaning {
        self.meaning.get_or_init(|| {
            let save = self.editor.save();
            let (project, problems) = save.project();
            let flow = match self.language {
                Language::Diagram => None,
                Language::Dataflow => Some(Flow::of_only(save)),
            };
            Meaning {
                project,
                problems,
                flow,
            }
        })
    }

    /// Makes a change, which is an object of JSON: ids of what is new.
    pub fn apply(&mut self, change: &str) -> Result<Value, Failure> {
        let change = change::read(change)?;
        self.meaning.take();
        let new = self.editor.apply(&change);
        new.map(Value::from)
            .map_err(|why| Failure::Program(vec![why]))
    }

    /// Takes the last change back, or with `again` makes it once more. Whether there was one.
    pub fn turn_back(&mut self, again: bool) -> bool {
        self.meaning.take();
        match again {
            false => self.editor.undo(),
            true => self.editor.redo(),
        }
    }

    /// What it is: diagrams with their parameters, what can be taken back.
    pub fn about(&self) -> Value {
        let Meaning { project, flow, .. } = self.meaning();
        let diagram = |one: &Diagram| {
            let parameters = one.parameters.iter();
            json!({
                "id": one.id,
                "name": one.name,
                "kind": match one.kind {
                    DiagramKind::Main => "main",
                    DiagramKind::Subprogram => "subprogram",
                },
                "parameters": parameters.map(|one| json!({
                    "name": one.name, "kind": one.kind, "default": one.default,
                })).collect::<Vec<_>>(),
            })
        };
        let kit = project.meta.get("lastKitId");
        json!({
            "name": self.name,
            "language": match self.language {
                Language::Diagram => "diagram",
                Language::Dataflow => "dataflow",
            },
            "kit": kit.and_then(|id| Kit::of_id(id)).unwrap_or_default().id(),
            "diagrams": match flow {
                None => project.diagrams.iter().map(diagram).collect(),
                Some(flow) => flow::diagrams(&flow.project),
            },
            "undo": self.editor.undo_count(),
            "redo": self.editor.redo_count(),
            "hasWorld": project.world.is_some(),
            "world": number_of(project.world.as_deref()),
        })
    }

    /// The text of its world in XML, if it has one.
    pub fn world(&self) -> Option<&str> {
        self.editor.save().meta().world.as_deref()
    }

    /// The text of the images that its world names in XML, if it has some.
    pub fn images(&self) -> Option<&str> {
        self.editor.save().meta().blobs.as_deref()
    }

    /// A diagram with its blocks and links; null if it has none with this id.
    pub fn sheet(&self, diagram: &str, locale: Locale) -> Value {
        let Meaning { project, flow, .. } = self.meaning();
        if let Some(flow) = flow {
            return flow::sheet(&flow.project, diagram, locale);
        }
        let Some(diagram) = project.diagrams.iter().find(|one| one.id == diagram) else {
            return Value::Null;
        };
        let called = |block: &Block| project.called(block.calls.as_deref()?);
        let blocks = diagram.blocks.iter().map(|one| {
            let callee = called(one).map(|at| &project.diagrams[at]);
            block(one, callee, locale)
        });
        let links = diagram.links.iter().map(|one| link(one, diagram));
        json!({
            "id": diagram.id,
            "blocks": blocks.collect::<Vec<_>>(),
            "links": links.collect::<Vec<_>>(),
        })
    }

    /// Everything that is wrong with it, as `trik lint --json` would find it in the file.
    pub fn lint(&self, locale: Locale) -> Value {
        let Meaning {
            project,
            problems,
            flow,
        } = self.meaning();
        let (mut problems, findings) = match flow {
            None => {
                let found = self.found.iter().chain(problems).cloned().collect();
                let problems = lint::of_project(project, found);
                (problems, Findings::new(Some(project)))
            }
            Some(flow) => {
                let problems = lint::of_flow(flow, project, self.found.clone());
                (problems, Findings::new(None))
            }
        };
        findings.sort(&mut problems);
        Value::Array(findings.json(&self.name, &problems, locale))
    }

    /// Names that can stand in its expressions: variables, sensors, functions, constants.
    pub fn names(&self) -> Value {
        let Meaning { project, flow, .. } = self.meaning();
        let (names, variables) = match flow {
            Some(flow) => flow::names(&flow.project),
            None => {
                let parameters = project.diagrams.iter().flat_map(|one| &one.parameters);
                let parameters = parameters.map(|one| one.name.clone());
                (check::names(project), parameters.collect())
            }
        };
        let mut all = Vec::new();
        for slot in 0..u32::try_from(names.len()).unwrap_or(u32::MAX) {
            let is = match names.kind(slot) {
                Some(Kind::Variable) => "variable",
                Some(Kind::Sensor(_)) => "sensor",
                Some(Kind::Constant(_)) => "constant",
                Some(Kind::Function(_)) => "function",
                None => continue,
            };
            let name = names.name(slot);
            if !is_own(name) {
                all.push(json!({"name": name, "is": is}));
            }
        }
        let known: HashSet<&str> = (0..)
            .map_while(|slot| names.kind(slot).map(|_| names.name(slot)))
            .collect();
        let mut new: Vec<&str> = variables.iter().map(String::as_str).collect();
        new.sort_unstable();
        new.dedup();
        let new = new.into_iter().filter(|name| !known.contains(name));
        all.extend(new.map(|name| json!({"name": name, "is": "variable"})));
        Value::Array(all)
    }

    /// Blocks with these ids, and the links between them: what `add` takes.
    pub fn copy(&self, ids: &[String]) -> Value {
        piece(&self.editor.copy(ids))
    }

    /// It as a file that TRIK Studio opens.
    ///
    /// # Errors
    /// More than a save can have.
    pub fn save(&self) -> Result<Vec<u8>, Failure> {
        let written = self.editor.save().write();
        written.map_err(|why| Failure::Program(vec![why]))
    }

    /// The same file with nothing compressed, to be compressed as a whole: it takes little room then.
    ///
    /// # Errors
    /// As [`Self::save`].
    pub fn stored(&self) -> Result<Vec<u8>, Failure> {
        let written = self.editor.save().write_stored();
        written.map_err(|why| Failure::Program(vec![why]))
    }

    /// It as it is now, to be shown, written as text, judged and run. Options as those of [`Project::open`].
    pub fn project(&self, options: &str) -> Answer<project::Project> {
        let mut locale = Locale::default();
        let opened = Options::read(options).and_then(|mut options| {
            locale = options.locale()?;
            let diagram = options.text("diagram")?;
            options.end()?;
            let mut save = self.editor.save().clone();
            if let Some(diagram) = diagram {
                lang_dataflow::read::choose(&mut save, &diagram).map_err(Failure::Diagram)?;
            }
            let (project, problems) = save.project();
            Ok(project::Project {
                name: self.name.clone(),
                program: program::of_save(Opened {
                    project,
                    problems,
                    save,
                }),
            })
        });
        (opened, locale)
    }
}

/// How an editor draws a language.
fn notation(language: Language) -> &'static dyn Notation {
    match language {
        Language::Diagram => &ControlFlow,
        Language::Dataflow => &DataFlow,
    }
}

/// A number that another text most likely has not.
fn number_of(text: Option<&str>) -> u32 {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    hasher.finish() as u32
}

fn block(block: &Block, callee: Option<&Diagram>, locale: Locale) -> Value {
    let arguments = block.arguments.iter();
    let (x, y) = block.position;
    json!({
        "id": block.id,
        "kind": block.kind,
        "name": block.name,
        "details": show::details(block),
        "at": [x, y],
        "size": [block.size.0, block.size.1],
        "title": match callee {
            Some(callee) => callee.name.clone(),
            None => show::name(block, locale),
        },
        "properties": block.properties,
        "calls": callee.map(|one| one.id.as_str()),
        "arguments": arguments.map(|one| json!({
            "name": one.name, "kind": one.kind, "value": one.value,
        })).collect::<Vec<_>>(),
    })
}

fn link(link: &Link, diagram: &Diagram) -> Value {
    let end = |end: Option<usize>| end.and_then(|at| diagram.blocks.get(at));
    json!({
        "id": link.id,
        "from": end(link.from).map(|one| one.id.as_str()),
        "to": end(link.to).map(|one| one.id.as_str()),
        "guard": link.guard,
        "path": link.path.iter().map(|(x, y)| [*x, *y]).collect::<Vec<_>>(),
    })
}

fn piece(piece: &Piece) -> Value {
    let blocks = piece.blocks.iter().map(|one| {
        let properties: serde_json::Map<String, Value> = one
            .properties
            .iter()
            .map(|(key, value)| (key.clone(), value.as_str().into()))
            .collect();
        let arguments: serde_json::Map<String, Value> = one
            .arguments
            .iter()
            .map(|(key, value)| (key.clone(), value.as_str().into()))
            .collect();
        json!({
            "kind": one.kind,
            "name": one.name,
            "properties": properties,
            "at": [one.place.0, one.place.1],
            "size": one.size.map(|(width, height)| [width, height]),
            "calls": one.calls,
            "arguments": arguments,
        })
    });
    let links = piece.links.iter();
    json!({
        "blocks": blocks.collect::<Vec<_>>(),
        "links": links.map(|one| {
            let written = one.properties.iter();
            let written = written.map(|(key, value)| (key.clone(), value.as_str().into()));
            json!({
                "from": one.from,
                "to": one.to,
                "guard": one.guard,
                "ports": one.ports.map(|(from, to)| [from, to]),
                "properties": written.collect::<serde_json::Map<String, Value>>(),
            })
        }).collect::<Vec<_>>(),
    })
}
