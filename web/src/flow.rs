//! Drawings of data flow, as a page is told of them: blocks with ports, links from port to port.
//!
//! Owns the JSON of what only this language has. What a change does is known in `lang_diagram::edit`, what blocks there are in
//! `lang_dataflow::blocks`.

use lang_dataflow::blocks::{Content, Direction, GROUPS, Group, Kind, Property, Row};
use lang_dataflow::project::{Block, Diagram, DiagramKind, Edge, End, Project};
use lang_dataflow::{check, show};
use lang_diagram::blocks::find_shown;
use lang_expr::Names;
use lang_text::problem::Locale;
use serde_json::{Value, json};

/// All blocks, by group and in the order of the editor's palette.
pub(crate) fn palette(locale: Locale) -> Value {
    let groups = GROUPS.into_iter();
    let rows = groups.flat_map(|(group, rows)| rows.iter().map(move |one| (group, one)));
    rows.map(|(group, one)| row(group, one, locale)).collect()
}

fn row(group: Group, row: &Row, locale: Locale) -> Value {
    json!({
        "kind": row.element,
        "title": row.shown_in(locale),
        "category": match group {
            Group::Control => "control",
            Group::Streams => "streams",
            Group::Devices => "devices",
            Group::Shell => "shell",
            Group::Drawing => "drawing",
        },
        "kits": ["trikV62Kit", "trikV6Kit"],
        "isOld": false,
        "text": row.text,
        // The block of control flow that does the same has a picture of it.
        "icon": find_shown(row.shown).map_or("", |one| one.icon),
        "size": [row.size.0, row.size.1],
        "ports": row.ports.iter().map(|one| json!({
            "name": one.name,
            "way": match one.way {
                Direction::In => "in",
                Direction::Out => "out",
            },
            "of": of(one.of),
            "at": [one.at.0, one.at.1],
        })).collect::<Vec<_>>(),
        "properties": row.properties.iter().map(property).collect::<Vec<_>>(),
    })
}

/// What tokens of a port are.
fn of(kind: Kind) -> &'static str {
    match kind {
        Kind::Unit => "unit",
        Kind::Truth => "truth",
        Kind::Whole => "whole",
        Kind::Text => "text",
        Kind::List | Kind::Items(_) => "list",
        Kind::Any => "any",
    }
}

fn property(property: &Property) -> Value {
    let (takes, choices): (&str, Option<Vec<&str>>) = match property.content {
        Content::Expression | Content::Variables => ("statements", None),
        Content::Truth | Content::Whole | Content::Evaluated => ("expression", None),
        Content::Raw | Content::Constant => ("text", None),
        Content::Number => ("number", None),
        Content::Flag => ("choice", Some(vec!["true", "false"])),
        Content::Choice(choices) => {
            // The usual one may be written in other letters.
            let is_usual = |word: &&&str| word.eq_ignore_ascii_case(property.default);
            let usual = choices.iter().find(is_usual).map(|_| property.default);
            let others = choices.iter().copied();
            let others = others.filter(|word| !word.eq_ignore_ascii_case(property.default));
            ("choice", Some(usual.into_iter().chain(others).collect()))
        }
        Content::Sensor => ("variable", None),
        Content::Port => ("ports", None),
    };
    json!({
        "name": property.name,
        "title": property.shown.trim_end_matches(['=', ':']),
        "found": property.shown,
        "default": property.default,
        "takes": takes,
        "choices": choices,
        "choiceTitles": null,
    })
}

/// Its diagrams, as `about` has them.
pub(crate) fn diagrams(project: &Project) -> Vec<Value> {
    let diagram = |one: &Diagram| {
        json!({
            "id": one.id,
            "name": one.name,
            "kind": match one.kind {
                DiagramKind::Main => "main",
                DiagramKind::Subprogram => "subprogram",
            },
            "parameters": [],
        })
    };
    project.diagrams.iter().map(diagram).collect()
}

/// A diagram with its blocks and links; null if there is none with this id.
pub(crate) fn sheet(project: &Project, diagram: &str, locale: Locale) -> Value {
    let Some(diagram) = project.diagrams.iter().find(|one| one.id == diagram) else {
        return Value::Null;
    };
    let blocks = diagram.blocks.iter().map(|one| {
        let callee = one.calls.as_deref().and_then(|id| project.called(id));
        block(one, callee.map(|at| &project.diagrams[at]), locale)
    });
    let links = diagram.edges.iter().map(|one| link(one, diagram));
    json!({
        "id": diagram.id,
        "blocks": blocks.collect::<Vec<_>>(),
        "links": links.collect::<Vec<_>>(),
    })
}

fn block(block: &Block, callee: Option<&Diagram>, locale: Locale) -> Value {
    let (x, y) = block.position;
    let (width, height) = block.row.map_or((100, 100), |row| row.size);
    json!({
        "id": block.id,
        // One of an old version is told as what it became.
        "kind": block.row.map_or(&*block.element, |row| row.element),
        "name": block.name,
        "details": show::details(block),
        "at": [x, y],
        "size": [width, height],
        "title": callee.map_or_else(|| show::name(block, locale), |one| one.name.clone()),
        "properties": block.properties,
        "calls": callee.map(|one| one.id.as_str()),
        "arguments": [],
    })
}

fn link(edge: &Edge, diagram: &Diagram) -> Value {
    let id = |end: Option<End>| Some(&*diagram.blocks.get(end?.block)?.id);
    // One that the block has not is none.
    let port = |end: Option<End>| {
        let ports = diagram.blocks.get(end?.block)?.row?.ports;
        let at = usize::try_from(end?.port).ok()?;
        (at < ports.len()).then_some(at)
    };
    json!({
        "id": edge.id,
        "from": id(edge.from),
        "to": id(edge.to),
        "guard": "",
        "ports": port(edge.from).zip(port(edge.to)).map(|(from, to)| [from, to]),
        "policy": edge.policy.map_or("", |one| one.word()),
        "capacity": edge.capacity.map_or_else(String::new, |places| places.to_string()),
        "path": edge.path.iter().map(|(x, y)| [*x, *y]).collect::<Vec<_>>(),
    })
}

/// Names that can stand in its expressions: those of the robot, and its variables.
pub(crate) fn names(project: &Project) -> (Names, Vec<String>) {
    let (names, variables) = check::names(project);
    (names, variables.into_iter().collect())
}
