//! Changes of a drawing as JSON: `{"do": "connect", "from": ID, "to": ID}`.
//!
//! Owns their names and forms. What a change does, and which ones can be made, is known in `lang_diagram::edit`.

use crate::failure::Failure;
use crate::limits;
use crate::words;
use lang_diagram::edit::{Change, Drawn, Piece, Wire};
use lang_diagram::ports::Kit;
use lang_diagram::project::{DiagramKind, Parameter};
use serde_json::{Map, Value};

/// An object of JSON of which fields are taken one after the other.
struct Fields(Map<String, Value>);

impl Fields {
    fn of(value: Value) -> Result<Self, Failure> {
        match value {
            Value::Object(map) => Ok(Self(map)),
            Value::Null
            | Value::Bool(_)
            | Value::Number(_)
            | Value::String(_)
            | Value::Array(_) => Err(wrong("")),
        }
    }

    fn maybe_text(&mut self, name: &str) -> Result<Option<String>, Failure> {
        match self.0.remove(name) {
            None | Some(Value::Null) => Ok(None),
            Some(Value::String(text)) => Ok(Some(text)),
            Some(_) => Err(wrong(name)),
        }
    }

    fn text(&mut self, name: &str) -> Result<String, Failure> {
        self.maybe_text(name)?.ok_or_else(|| wrong(name))
    }

    fn list(&mut self, name: &str) -> Result<Vec<Value>, Failure> {
        match self.0.remove(name) {
            None | Some(Value::Null) => Ok(Vec::new()),
            Some(Value::Array(all)) if all.len() <= limits::CHANGED_MAX => Ok(all),
            Some(_) => Err(wrong(name)),
        }
    }

    fn texts(&mut self, name: &str) -> Result<Vec<String>, Failure> {
        let text = |value| match value {
            Value::String(text) => Ok(text),
            _ => Err(wrong(name)),
        };
        self.list(name)?.into_iter().map(text).collect()
    }

    /// Texts by their names.
    fn named(&mut self, name: &str) -> Result<Vec<(String, String)>, Failure> {
        let all = match self.0.remove(name) {
            None | Some(Value::Null) => return Ok(Vec::new()),
            Some(Value::Object(map)) if map.len() <= limits::CHANGED_MAX => map,
            Some(_) => return Err(wrong(name)),
        };
        let text = |(key, value)| match value {
            Value::String(text) => Ok((key, text)),
            _ => Err(wrong(name)),
        };
        all.into_iter().map(text).collect()
    }

    /// Two numbers.
    fn pair(&mut self, name: &str) -> Result<Option<(f64, f64)>, Failure> {
        match self.0.remove(name) {
            None | Some(Value::Null) => Ok(None),
            Some(Value::Array(all)) => match &all[..] {
                [x, y] => match (x.as_f64(), y.as_f64()) {
                    (Some(x), Some(y)) => Ok(Some((x, y))),
                    _ => Err(wrong(name)),
                },
                _ => Err(wrong(name)),
            },
            Some(_) => Err(wrong(name)),
        }
    }

    /// Places of two ports among those of their blocks.
    fn ports(&mut self) -> Result<Option<(u8, u8)>, Failure> {
        let port = |number: f64| match number >= 0.0 && number.fract() == 0.0 {
            // Too large becomes the largest, which no block has.
            true => Ok(number as u8),
            false => Err(wrong("ports")),
        };
        match self.pair("ports")? {
            None => Ok(None),
            Some((from, to)) => Ok(Some((port(from)?, port(to)?))),
        }
    }

    fn index(&mut self, name: &str) -> Result<usize, Failure> {
        let number = self.0.remove(name);
        let number = number.as_ref().and_then(Value::as_u64);
        let number = number.and_then(|number| usize::try_from(number).ok());
        number.ok_or_else(|| wrong(name))
    }

    /// Nothing is left.
    fn end(self) -> Result<(), Failure> {
        match self.0.keys().next() {
            None => Ok(()),
            Some(name) => Err(wrong(name)),
        }
    }
}

fn wrong(name: &str) -> Failure {
    let shown: String = name.chars().take(limits::NAME_BYTES_MAX / 64).collect();
    Failure::Request(words::wrong_change(&shown))
}

/// Reads a change.
///
/// # Errors
/// It is none.
pub fn read(text: &str) -> Result<Change, Failure> {
    let value = sim::judge::json::read(text).map_err(|_| wrong(""))?;
    let mut fields = Fields::of(value)?;
    let name = fields.text("do")?;
    let change = match of_sheet(&name, &mut fields)? {
        Some(change) => change,
        None => of_project(&name, &mut fields)?,
    };
    fields.end()?;
    Ok(change)
}

/// A change of blocks and links; nothing if none has this name.
fn of_sheet(name: &str, fields: &mut Fields) -> Result<Option<Change>, Failure> {
    Ok(Some(match name {
        "add" => Change::Add {
            diagram: fields.text("diagram")?,
            piece: piece(fields)?,
        },
        "insert" => Change::Insert {
            link: fields.text("link")?,
            block: match fields.0.remove("block") {
                Some(block) => drawn(block)?,
                None => return Err(wrong("block")),
            },
            guard: fields.maybe_text("guard")?.unwrap_or_default(),
            ports: fields.ports()?,
        },
        "remove" => Change::Remove {
            ids: fields.texts("ids")?,
        },
        "move" => Change::Move {
            places: places(fields)?,
        },
        "connect" => Change::Connect {
            from: fields.text("from")?,
            to: fields.text("to")?,
            guard: fields.maybe_text("guard")?.unwrap_or_default(),
            ports: fields.ports()?,
        },
        "reconnect" => Change::Reconnect {
            link: fields.text("link")?,
            from: fields.text("from")?,
            to: fields.text("to")?,
            ports: fields.ports()?,
        },
        "set" => Change::Set {
            id: fields.text("id")?,
            property: fields.text("property")?,
            value: fields.text("value")?,
        },
        "argument" => Change::Argument {
            id: fields.text("id")?,
            name: fields.text("name")?,
            value: fields.text("value")?,
        },
        _ => return Ok(None),
    }))
}

/// A change of calls, diagrams, world and kit.
fn of_project(name: &str, fields: &mut Fields) -> Result<Change, Failure> {
    Ok(match name {
        "call" => Change::Call {
            id: fields.text("id")?,
            diagram: fields.text("diagram")?,
        },
        "addDiagram" => Change::AddDiagram {
            kind: match &*fields.text("kind")? {
                "main" => DiagramKind::Main,
                "subprogram" => DiagramKind::Subprogram,
                _ => return Err(wrong("kind")),
            },
            name: fields.text("name")?,
        },
        "rename" => Change::Rename {
            diagram: fields.text("diagram")?,
            name: fields.text("name")?,
        },
        "parameters" => Change::Parameters {
            diagram: fields.text("diagram")?,
            parameters: parameters(fields)?,
        },
        "removeDiagram" => Change::RemoveDiagram {
            diagram: fields.text("diagram")?,
        },
        "world" => Change::World {
            text: fields.maybe_text("text")?,
            images: fields.maybe_text("images")?,
        },
        "kit" => Change::Kit {
            kit: Kit::of_id(&fields.text("kit")?).ok_or_else(|| wrong("kit"))?,
        },
        _ => return Err(wrong("do")),
    })
}

fn piece(fields: &mut Fields) -> Result<Piece, Failure> {
    let mut piece = Piece::default();
    for value in fields.list("blocks")? {
        piece.blocks.push(drawn(value)?);
    }
    for value in fields.list("links")? {
        let mut fields = Fields::of(value)?;
        piece.links.push(Wire {
            from: fields.index("from")?,
            to: fields.index("to")?,
            guard: fields.maybe_text("guard")?.unwrap_or_default(),
            ports: fields.ports()?,
            properties: fields.named("properties")?,
        });
        fields.end()?;
    }
    Ok(piece)
}

/// Where blocks move to.
type Places = Vec<(String, (f64, f64))>;

fn drawn(block: Value) -> Result<Drawn, Failure> {
    let mut fields = Fields::of(block)?;
    let kind = fields.text("kind")?;
    let place = fields.pair("at")?.ok_or_else(|| wrong("at"))?;
    let mut drawn = Drawn::of(&kind, place);
    drawn.name = fields.maybe_text("name")?.unwrap_or_default();
    drawn.properties = fields.named("properties")?;
    drawn.size = fields.pair("size")?;
    drawn.calls = fields.maybe_text("calls")?;
    drawn.arguments = fields.named("arguments")?;
    fields.end()?;
    Ok(drawn)
}

fn places(fields: &mut Fields) -> Result<Places, Failure> {
    let mut places = Vec::new();
    for value in fields.list("places")? {
        let mut fields = Fields::of(value)?;
        let id = fields.text("id")?;
        places.push((id, fields.pair("at")?.ok_or_else(|| wrong("at"))?));
        fields.end()?;
    }
    Ok(places)
}

fn parameters(fields: &mut Fields) -> Result<Vec<Parameter>, Failure> {
    let mut parameters = Vec::new();
    for value in fields.list("parameters")? {
        let mut fields = Fields::of(value)?;
        parameters.push(Parameter {
            name: fields.text("name")?,
            kind: fields.text("kind")?,
            default: fields.maybe_text("default")?.unwrap_or_default(),
        });
        fields.end()?;
    }
    Ok(parameters)
}
