//! Arbitrary bytes as a person who draws a data-flow program: changes, taken back and made again.
//!
//! Owns the small language of bytes that says changes, so that nearly all bytes mean one.

use crate::blocks;
use crate::edit::{CALL, DataFlow};
use crate::project::Project;
use crate::{read, text};
use lang_diagram::edit::{Change, Drawn, Editor, Piece, Wire};
use lang_diagram::fuzz::Choices;
use lang_diagram::objects::Object;
use lang_diagram::project::DiagramKind;
use lang_diagram::read::{Meta, Save};
use lang_expr::Kit;
use lang_text::problem::Locale;
use std::collections::BTreeMap;

/// How many changes one input may say.
const CHANGES: usize = 200;
/// Texts that are written into blocks and at links, and names.
const TEXTS: [&str; 9] = [
    "", "1", "latest", "16", "turn", "<&\">'", "\u{1}", "\u{44f}", "I0 + 1",
];

/// Ids of diagrams, blocks and links.
#[derive(Default)]
struct Ids {
    diagrams: Vec<String>,
    blocks: Vec<String>,
    links: Vec<String>,
}

fn ids(project: &Project) -> Ids {
    let mut ids = Ids::default();
    for diagram in &project.diagrams {
        ids.diagrams.push(diagram.id.clone());
        ids.blocks
            .extend(diagram.blocks.iter().map(|one| one.id.clone()));
        ids.links
            .extend(diagram.edges.iter().map(|one| one.id.clone()));
    }
    ids
}

fn piece(choices: &mut Choices<'_>) -> Piece {
    let kinds: Vec<&str> = blocks::table().map(|row| row.element).collect();
    let count = choices.below(5);
    let block = |choices: &mut Choices<'_>| {
        let kind = match choices.below(9) {
            0 => CALL,
            1 => "Motors",
            2 => "Edge",
            _ => kinds[choices.below(kinds.len())],
        };
        let mut drawn = Drawn::of(kind, choices.place());
        if choices.below(3) == 0 {
            drawn.calls = Some(choices.text());
        }
        if choices.below(3) == 0 {
            drawn.properties.push(("time".into(), choices.text()));
        }
        drawn
    };
    let blocks = (0..count).map(|_| block(choices)).collect();
    let links = (0..choices.below(4)).map(|_| Wire {
        from: choices.below(count + 1),
        to: choices.below(count),
        ports: choices.ports(),
        properties: vec![("Policy".into(), choices.text())],
        ..Wire::default()
    });
    let links = links.collect();
    Piece { blocks, links }
}

fn change(choices: &mut Choices<'_>, ids: &Ids) -> Change {
    let both = || [&ids.blocks[..], &ids.links[..]].concat();
    match choices.below(14) {
        0 | 1 => Change::Add {
            diagram: choices.id(&ids.diagrams),
            piece: piece(choices),
        },
        2 => Change::Remove {
            ids: (0..choices.below(4)).map(|_| choices.id(&both())).collect(),
        },
        3 => Change::Move {
            places: (0..choices.below(4))
                .map(|_| (choices.id(&ids.blocks), choices.place()))
                .collect(),
        },
        4..=6 => Change::Connect {
            from: choices.id(&ids.blocks),
            to: choices.id(&ids.blocks),
            guard: String::new(),
            ports: choices.ports(),
        },
        7 => Change::Reconnect {
            link: choices.id(&ids.links),
            from: choices.id(&ids.blocks),
            to: choices.id(&ids.blocks),
            ports: choices.ports(),
        },
        8 => Change::Set {
            id: choices.id(&both()),
            property: ["time", "Policy", "IO0", "Capacity", "name"][choices.below(5)].into(),
            value: choices.text(),
        },
        9 => Change::Insert {
            link: choices.id(&ids.links),
            block: Drawn::of("DFWaitBlock", choices.place()),
            guard: String::new(),
            ports: choices.ports(),
        },
        10 => Change::Call {
            id: choices.id(&ids.blocks),
            diagram: choices.id(&ids.diagrams),
        },
        11 => Change::AddDiagram {
            kind: [DiagramKind::Subprogram, DiagramKind::Main][choices.below(2)],
            name: choices.text(),
        },
        12 => Change::Rename {
            diagram: choices.id(&ids.diagrams),
            name: choices.text(),
        },
        _ => Change::RemoveDiagram {
            diagram: choices.id(&ids.diagrams),
        },
    }
}

/// All that a save says.
fn state(save: &Save) -> (BTreeMap<&str, &Object>, &Meta) {
    let objects = save.objects().iter();
    (objects.map(|one| (&*one.id, one)).collect(), save.meta())
}

fn assert_same(one: &Save, other: &Save, what: &str) {
    let (one, other) = (state(one), state(other));
    assert_eq!(one.0, other.0, "{what}");
    assert_eq!(format!("{:?}", one.1), format!("{:?}", other.1), "{what}");
}

/// Bytes as changes of a project that begins empty.
pub fn edits(bytes: &[u8]) {
    let (seed, rest) = bytes.split_first().unwrap_or((&0, &[]));
    let seed = u128::from(*seed);
    let editor = Editor::blank_of(&DataFlow, Kit::V62, Locale::Russian, seed);
    edits_of(editor, rest);
}

/// Bytes as changes of a project: each is whole or not at all, is taken back and made again without a trace, and leaves a
/// save that is written and read as the same.
pub fn edits_of(mut editor: Editor, bytes: &[u8]) {
    let mut choices = Choices::new(bytes, &TEXTS);
    let first = editor.save().clone();
    for _ in 0..CHANGES {
        if choices.is_over() {
            break;
        }
        let ids = ids(&read::project(editor.save()).0);
        match choices.below(16) {
            0 => _ = editor.undo(),
            1 => _ = editor.redo(),
            2 => {
                let some: Vec<String> = (0..choices.below(5))
                    .map(|_| choices.id(&ids.blocks))
                    .collect();
                let piece = editor.copy(&some);
                let diagram = choices.id(&ids.diagrams);
                attempt(&mut editor, &Change::Add { diagram, piece });
            }
            _ => attempt(&mut editor, &change(&mut choices, &ids)),
        }
    }
    let (project, _) = read::project(editor.save());
    if let Ok(written) = editor.save().write() {
        let again = lang_diagram::read::read(&written).expect("what was written is read");
        let (again, _) = read::project(&again.save);
        assert_eq!(text::write(&again), text::write(&project));
    }
    let last = editor.save().clone();
    let changes = editor.undo_count();
    while editor.undo() {}
    assert_same(editor.save(), &first, "something stays");
    for _ in 0..changes {
        assert!(editor.redo());
    }
    assert_same(editor.save(), &last, "something is lost");
}

fn attempt(editor: &mut Editor, change: &Change) {
    let before = editor.save().clone();
    let undone = editor.undo_count();
    match editor.apply(change) {
        Ok(_) if editor.undo_count() > undone => {
            let after = editor.save().clone();
            assert!(editor.undo());
            assert_same(editor.save(), &before, &format!("{change:?}"));
            assert!(editor.redo());
            assert_same(editor.save(), &after, &format!("{change:?}"));
        }
        // Nothing to do.
        Ok(_) => {}
        Err(_) => assert_same(editor.save(), &before, &format!("{change:?}")),
    }
}
