//! Arbitrary bytes as a person who draws: changes, taken back and made again: [`edits`].
//!
//! Owns the small language of bytes that says changes, so that nearly all bytes mean one.

use super::choices::Choices;
use crate::blocks;
use crate::edit::{Change, Drawn, Editor, Piece, Wire};
use crate::objects::Object;
use crate::project::{DiagramKind, Parameter};
use crate::read::read;
use crate::save::Save;
use lang_expr::Kit;
use lang_text::problem::{Locale, Problem};
use std::collections::BTreeMap;

/// How many changes one input may say.
const CHANGES: usize = 200;
/// Texts that are written into blocks, and names.
const TEXTS: [&str; 9] = [
    "",
    "1",
    "x",
    "M3, M4",
    "turn",
    "<&\">'",
    "\u{1}",
    "\u{44f}",
    "x = x + 1",
];

/// Ids of diagrams, blocks and links.
struct Ids {
    diagrams: Vec<String>,
    blocks: Vec<String>,
    links: Vec<String>,
}

/// Those that a person sees: what no diagram lists is not among them.
fn ids(save: &Save) -> Ids {
    let (project, _) = save.project();
    let diagrams = project.diagrams.iter();
    let blocks = diagrams.clone().flat_map(|one| &one.blocks);
    let links = diagrams.clone().flat_map(|one| &one.links);
    Ids {
        diagrams: diagrams.map(|one| one.id.clone()).collect(),
        blocks: blocks.map(|one| one.id.clone()).collect(),
        links: links.map(|one| one.id.clone()).collect(),
    }
}

fn piece(choices: &mut Choices<'_>) -> Piece {
    let kinds: Vec<&str> = blocks::table().map(|row| row.kind).collect();
    let count = choices.below(5);
    let block = |choices: &mut Choices<'_>| {
        let kind = match choices.below(9) {
            0 => "Subprogram",
            1 => "Strange_1",
            2 => "ControlFlow",
            _ => kinds[choices.below(kinds.len())],
        };
        let mut drawn = Drawn::of(kind, choices.place());
        if choices.below(3) == 0 {
            drawn.calls = Some(choices.text());
            drawn.arguments.push((choices.text(), choices.text()));
        }
        if choices.below(3) == 0 {
            drawn.properties.push(("Power".into(), choices.text()));
        }
        drawn
    };
    let blocks = (0..count).map(|_| block(choices)).collect();
    let links = (0..choices.below(4)).map(|_| Wire {
        from: choices.below(count + 1),
        to: choices.below(count),
        guard: choices.text(),
        ..Wire::default()
    });
    let links = links.collect();
    Piece { blocks, links }
}

fn change(choices: &mut Choices<'_>, editor: &Editor) -> Change {
    let ids = ids(editor.save());
    match choices.below(15) {
        13 => Change::Insert {
            link: choices.id(&ids.links),
            block: Drawn::of("Timer", choices.place()),
            guard: String::new(),
            ports: None,
        },
        kind @ 0..=7 => of_sheet(choices, &ids, kind),
        kind => of_project(choices, &ids, kind),
    }
}

/// A change of blocks and links.
fn of_sheet(choices: &mut Choices<'_>, ids: &Ids, kind: usize) -> Change {
    match kind {
        0 | 1 => Change::Add {
            diagram: choices.id(&ids.diagrams),
            piece: piece(choices),
        },
        2 => {
            let all = [&ids.blocks[..], &ids.links[..]].concat();
            let count = choices.below(4);
            let ids = (0..count).map(|_| choices.id(&all)).collect();
            Change::Remove { ids }
        }
        3 => {
            let count = choices.below(4);
            let one = |choices: &mut Choices<'_>| (choices.id(&ids.blocks), choices.place());
            let places = (0..count).map(|_| one(choices)).collect();
            Change::Move { places }
        }
        4 => Change::Connect {
            from: choices.id(&ids.blocks),
            to: choices.id(&ids.blocks),
            guard: choices.text(),
            ports: None,
        },
        5 => Change::Reconnect {
            link: choices.id(&ids.links),
            from: choices.id(&ids.blocks),
            to: choices.id(&ids.blocks),
            ports: None,
        },
        6 => Change::Set {
            id: choices.id(&[&ids.blocks[..], &ids.links[..]].concat()),
            property: ["Power", "Guard", "Delay", "from", "name"][choices.below(5)].into(),
            value: choices.text(),
        },
        _ => Change::Argument {
            id: choices.id(&ids.blocks),
            name: choices.text(),
            value: choices.text(),
        },
    }
}

/// A change of diagrams, calls and the world.
fn of_project(choices: &mut Choices<'_>, ids: &Ids, kind: usize) -> Change {
    match kind {
        8 => Change::AddDiagram {
            kind: [DiagramKind::Subprogram, DiagramKind::Main][choices.below(2)],
            name: choices.text(),
        },
        9 => Change::Rename {
            diagram: choices.id(&ids.diagrams),
            name: choices.text(),
        },
        10 => Change::Parameters {
            diagram: choices.id(&ids.diagrams),
            parameters: (0..choices.below(3))
                .map(|_| Parameter {
                    name: choices.text(),
                    kind: ["int", "string", "colour"][choices.below(3)].into(),
                    default: choices.text(),
                })
                .collect(),
        },
        12 => Change::Call {
            id: choices.id(&ids.blocks),
            diagram: choices.id(&ids.diagrams),
        },
        11 => Change::RemoveDiagram {
            diagram: choices.id(&ids.diagrams),
        },
        _ => match choices.below(3) {
            0 => Change::World {
                text: Some("<root/>".into()),
                images: [None, Some("<blobs/>"), Some("")][choices.below(3)].map(str::to_owned),
            },
            1 => Change::World {
                text: None,
                images: None,
            },
            _ => Change::Kit {
                kit: [Kit::V6, Kit::V62][choices.below(2)],
            },
        },
    }
}

/// Whether two saves have the same objects, in whichever order, and say the same of themselves.
fn is_same(one: &Save, other: &Save) -> bool {
    let state = |save: &'_ Save| format!("{:?} {}", save.meta(), save.is_edited);
    objects(one) == objects(other) && state(one) == state(other)
}

fn objects(save: &Save) -> BTreeMap<&str, &Object> {
    let objects = save.objects().iter();
    objects.map(|one| (&*one.id, one)).collect()
}

/// Bytes as changes of a project that begins empty.
pub fn edits(bytes: &[u8]) {
    let (seed, rest) = bytes.split_first().unwrap_or((&0, &[]));
    edits_of(
        Editor::blank(Kit::V62, Locale::Russian, u128::from(*seed)),
        rest,
    );
}

/// Bytes as changes of a project: each is whole or not at all, is taken back and made again without a trace, and leaves a
/// save that is written and read as the same.
pub fn edits_of(mut editor: Editor, bytes: &[u8]) {
    let mut choices = Choices::new(bytes, &TEXTS);
    let problems = editor.save().project().1;
    let first = editor.save().clone();
    for _ in 0..CHANGES {
        if choices.is_over() {
            break;
        }
        match choices.below(16) {
            0 => _ = editor.undo(),
            1 => _ = editor.redo(),
            2 => {
                let ids = ids(editor.save());
                let count = choices.below(5);
                let some: Vec<String> = (0..count).map(|_| choices.id(&ids.blocks)).collect();
                let piece = editor.copy(&some);
                let diagram = choices.id(&ids.diagrams);
                attempt(&mut editor, &Change::Add { diagram, piece });
            }
            _ => {
                let change = change(&mut choices, &editor);
                attempt(&mut editor, &change);
            }
        }
    }
    let (project, found) = editor.save().project();
    // The block may have got another name, and what is about many objects names any of them.
    let same = |one: &Problem, other: &Problem| {
        let is_one = one.place.block.is_some();
        one.words == other.words && (!is_one || one.place.object == other.place.object)
    };
    let is_new = |one: &&Problem| !problems.iter().any(|other| same(one, other));
    let new = found.iter().find(is_new);
    assert_eq!(new, None, "before: {problems:?}");
    if let Ok(written) = editor.save().write() {
        let again = read(&written).expect("what was written is read");
        assert_eq!(again.project, project);
    }
    let stored = editor.save().write_stored();
    if let Ok(stored) = stored {
        let again = read(&stored).expect("what was stored is read");
        assert_eq!(again.project, project);
    }
    let last = editor.save().clone();
    let changes = editor.undo_count();
    while editor.undo() {}
    assert!(is_same(editor.save(), &first), "something stays");
    for _ in 0..changes {
        assert!(editor.redo());
    }
    assert!(is_same(editor.save(), &last), "something is lost");
}

fn attempt(editor: &mut Editor, change: &Change) {
    let before = editor.save().clone();
    let undone = editor.undo_count();
    match editor.apply(change) {
        Ok(_) if editor.undo_count() > undone => {
            let after = editor.save().clone();
            assert!(editor.undo());
            assert!(is_same(editor.save(), &before), "{change:?}");
            assert!(editor.redo());
            assert!(is_same(editor.save(), &after), "{change:?}");
        }
        // Nothing to do, or the memory of changes is full.
        Ok(_) => {}
        Err(_) => assert!(is_same(editor.save(), &before), "{change:?}"),
    }
}
