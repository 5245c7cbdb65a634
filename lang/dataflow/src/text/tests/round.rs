//! Round trips of any project, and texts that are none.

use super::super::{read, write};
use super::{ALL, FOLLOWER, whole};
use crate::blocks;
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Policy, Project};
use proptest::prelude::*;
use std::collections::HashSet;

/// Texts that people and machines write, and some that nobody should.
fn odd() -> impl Strategy<Value = String> {
    prop_oneof![
        4 => "[a-z]{1,3}",
        1 => Just(String::new()),
        1 => "-?[0-9]{1,3}(\\.[0-9]{1,2})?(e[0-9])?",
        2 => "[ -~]{0,12}",
        1 => "[\"`\\\\ \n\r\t#():;=.,>-]{0,8}",
        1 => any::<String>(),
        1 => prop::sample::select(vec![
            "nowhere", "at", "id", "inf", "-inf", "NaN", "Motors", "\u{202e}x", "\u{feff}", "\u{434}\u{430}", "a\nb", "a \nb",
            "a\r\nb", "\u{0}", "\\u{41}", "`", "\"", "->", "#", "1e5", "-1", "--1", "motors1", "if1",
        ]).prop_map(str::to_owned),
    ]
}

/// Numbers of the canvas, with those that are hard to write.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (-2000..2000_i32).prop_map(f64::from),
        2 => any::<f64>(),
        1 => prop::sample::select(vec![0.0, -0.0, 0.1, 1e300, 5e-324, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]),
    ]
}

fn point() -> impl Strategy<Value = (f64, f64)> {
    (number(), number())
}

/// An id: one that is made, one of a save, or one that nobody makes. Numbers keep them apart.
fn id() -> impl Strategy<Value = Option<String>> {
    prop_oneof![
        2 => Just(None),
        2 => "[a-z]{1,4}".prop_map(|name| Some(format!("qrm:/RobotsDataFlowMetamodel/RobotsDataFlowDiagram/DFIfBlock/{{{name}}}"))),
        1 => "[ -,0-Z^-~]{1,8}".prop_map(Some),
    ]
}

fn block() -> impl Strategy<Value = Block> {
    let row = 0..blocks::table().count() + 2;
    let properties =
        prop::collection::btree_map(prop_oneof![Just("time".to_owned()), odd()], odd(), 0..3);
    let all = (row, odd(), properties, prop::collection::vec(odd(), 0..14));
    let rest = (
        point(),
        prop::option::weighted(0.2, odd()),
        id(),
        id(),
        odd(),
        0..4_u8,
    );
    (all, rest).prop_map(
        |((row, name, mut properties, texts), (position, calls, id, logical, element, which))| {
            let row = blocks::table().nth(row);
            for (property, text) in row.map_or(&[][..], |row| row.properties).iter().zip(texts) {
                if text != "a" {
                    properties.insert(property.name.to_owned(), text);
                }
            }
            let element = match row.filter(|_| which > 0) {
                Some(row) => row.element.to_owned(),
                None => element,
            };
            Block {
                id: id.unwrap_or_default(),
                logical: logical.unwrap_or_default(),
                row,
                element,
                name,
                properties,
                position,
                calls,
            }
        },
    )
}

fn edge() -> impl Strategy<Value = Edge> {
    let port = || prop_oneof![8 => -1..16_i32, 1 => any::<i32>()];
    let end = move || {
        prop::option::weighted(
            0.9,
            (0..8_usize, port()).prop_map(|(block, port)| End { block, port }),
        )
    };
    let policy = prop::option::of(prop::sample::select(Policy::ALL.to_vec()));
    let rest = (
        policy,
        prop::option::of(any::<u16>()),
        prop::collection::vec(point(), 0..4),
        id(),
    );
    (end(), end(), rest).prop_map(|(from, to, (policy, capacity, path, id))| Edge {
        id: id.unwrap_or_default(),
        from,
        to,
        policy,
        capacity,
        path,
        gone: None,
    })
}

fn diagram() -> impl Strategy<Value = Diagram> {
    let parts = (
        prop::collection::vec(block(), 0..8),
        prop::collection::vec(edge(), 0..8),
    );
    (
        any::<bool>(),
        prop_oneof![Just("one".to_owned()), odd()],
        id(),
        id(),
        parts,
    )
        .prop_map(|(is_main, name, id, logical, (blocks, mut edges))| {
            for end in edges
                .iter_mut()
                .flat_map(|edge| [&mut edge.from, &mut edge.to])
            {
                *end = end.filter(|end| end.block < blocks.len());
            }
            Diagram {
                id: id.unwrap_or_default(),
                logical: logical.unwrap_or_default(),
                kind: if is_main {
                    DiagramKind::Main
                } else {
                    DiagramKind::Subprogram
                },
                name,
                blocks,
                edges,
            }
        })
}

prop_compose! {
    /// A project whose graphical ids are unique and can be ids, as those of any save.
    fn any_project()(
        diagrams in prop::collection::vec(diagram(), 0..4),
        main in 0..5_usize,
        meta in prop::collection::btree_map(prop_oneof![Just("lastKitId".to_owned()), odd()], odd(), 0..3),
        calls in prop::collection::vec((0..4_usize, 0..4_usize, 0..8_usize), 0..4),
    ) -> Project {
        let mut project = Project { main: (main < diagrams.len()).then_some(main), diagrams, meta, world: None };
        let mut seen = HashSet::new();
        let mut count = 0;
        for diagram in &mut project.diagrams {
            let blocks = diagram.blocks.iter_mut().map(|block| &mut block.id);
            let edges = diagram.edges.iter_mut().map(|edge| &mut edge.id);
            for id in std::iter::once(&mut diagram.id).chain(blocks).chain(edges) {
                count += 1;
                if !super::super::ids::can_be(id) || !seen.insert(id.clone()) {
                    *id = format!("qrm:/a/b/c/{count}");
                }
            }
        }
        for (target, diagram, block) in calls {
            let logical = project.diagrams.get(target).map(|target| target.logical.clone());
            let block = project.diagrams.get_mut(diagram).and_then(|diagram| diagram.blocks.get_mut(block));
            if let Some(block) = block {
                block.calls = logical;
            }
        }
        project
    }
}

/// A line that is near to the grammar.
fn line() -> impl Strategy<Value = String> {
    let words = vec![
        "diagram",
        "subprogram",
        "run",
        "nothing",
        "kit",
        "meta",
        "a",
        "b",
        "A",
        ":",
        ":",
        ".",
        "->",
        "(",
        ")",
        ",",
        ";",
        "=",
        "If",
        "Motors",
        "unknown",
        "\"x\"",
        "`y`",
        "\"",
        "`",
        "of",
        "named",
        "at",
        "1",
        "-1",
        "2.5",
        "id",
        "logical",
        "element",
        "fifo",
        "via",
        "capacity",
        "nowhere",
        "OUT",
        "M3",
        "\n",
        "\n",
        "#",
        "%",
        "inf",
        "\u{434}",
    ];
    let word = prop_oneof![8 => prop::sample::select(words).prop_map(str::to_owned), 1 => odd()];
    prop::collection::vec(word, 0..60).prop_map(|words| words.join(" "))
}

/// Whether a reading ends, with what is bounded; what is read is written and read again.
fn survives(text: &str) -> Result<(), TestCaseError> {
    match read(text) {
        Ok(project) => {
            let written = write(&project);
            let again = read(&written);
            let again = again
                .map_err(|problems| TestCaseError::fail(format!("{problems:?}\n{written}")))?;
            prop_assert_eq!(whole(&project), whole(&again), "{}", written);
            prop_assert_eq!(write(&again), written);
        }
        Err(problems) => {
            prop_assert!(!problems.is_empty() && problems.len() <= lang_text::limits::PROBLEMS);
            prop_assert!(problems.iter().all(|one| one.place.position.is_some()));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_project_comes_back_from_its_text(project in any_project()) {
        let text = write(&project);
        let back = read(&text);
        let back = back.map_err(|problems| TestCaseError::fail(format!("{problems:#?}\n{text}")))?;
        prop_assert_eq!(whole(&project), whole(&back), "{}", &text);
        prop_assert_eq!(write(&back), text);
    }

    #[test]
    fn a_project_with_any_ids_and_ends_is_written_and_read(mut project in any_project(), wild in prop::collection::vec((odd(), any::<usize>()), 1..6)) {
        project.main = Some(wild.len());
        for (at, (id, end)) in wild.into_iter().enumerate() {
            let Some(diagram) = project.diagrams.get_mut(at % 2) else { continue };
            if at % 3 == 0 {
                diagram.id.clone_from(&id);
            }
            if let Some(block) = diagram.blocks.get_mut(at) {
                block.logical.clone_from(&id);
                block.id = id;
            }
            if let Some(edge) = diagram.edges.get_mut(at) {
                edge.from = Some(End { block: end, port: 1 });
            }
        }
        let text = write(&project);
        let back = read(&text);
        let back = back.map_err(|problems| TestCaseError::fail(format!("{problems:#?}\n{text}")))?;
        prop_assert_eq!(project.diagrams.len(), back.diagrams.len());
        survives(&text)?;
    }

    #[test]
    fn ids_that_were_made_outlive_changes(
        mut project in any_project(),
        changes in prop::collection::vec((0..7_u8, 0..4_usize, 0..8_usize, 0..8_usize, odd()), 0..8),
    ) {
        // Without ids, so that all of them are made.
        for diagram in &mut project.diagrams {
            diagram.id.clear();
            let blocks = diagram.blocks.iter_mut().map(|block| &mut block.id);
            let edges = diagram.edges.iter_mut().map(|edge| &mut edge.id);
            blocks.chain(edges).for_each(String::clear);
        }
        let read = |text: &str| {
            read(text).map_err(|problems| TestCaseError::fail(format!("{problems:#?}\n{text}")))
        };
        let text = write(&project);
        let mut project = read(&text)?;
        for (how, diagram, one, two, text) in changes {
            let Some(diagram) = project.diagrams.get_mut(diagram) else { continue };
            let is_block = one < diagram.blocks.len() && two < diagram.blocks.len();
            let is_edge = one < diagram.edges.len() && two < diagram.edges.len();
            match how {
                0 => diagram.name = text,
                1 if is_block => diagram.blocks[one].name = text,
                2 if is_block && one != two => {
                    let other = diagram.blocks[two].id.clone();
                    diagram.blocks[two].id = std::mem::replace(&mut diagram.blocks[one].id, other);
                }
                3 if is_block => diagram.blocks.swap(one, two),
                4 if is_block => diagram.blocks[one].logical = diagram.blocks[two].logical.clone(),
                5 if is_edge => diagram.edges.swap(one, two),
                6 if is_edge => drop(diagram.edges.remove(one)),
                _ => {}
            }
        }
        let text = write(&project);
        let back = read(&text)?;
        prop_assert_eq!(whole(&project), whole(&back), "{}", &text);
        prop_assert_eq!(write(&back), text);
    }

    #[test]
    fn any_text_is_read_or_refused(text in any::<String>(), bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        survives(&text)?;
        survives(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn what_is_near_the_grammar_is_read_or_refused(text in line()) {
        survives(&text)?;
        survives(&format!("diagram a\n{text}"))?;
    }

    #[test]
    fn a_program_with_changed_signs_is_read_or_refused(
        is_all in any::<bool>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..3_u8, any::<prop::sample::Index>()), 1..6),
    ) {
        let mut letters: Vec<char> = if is_all { ALL } else { FOLLOWER }.chars().collect();
        let signs: Vec<char> = "\"`\\\n#():;=.,->aA1 \u{434}".chars().collect();
        for (at, how, sign) in changes {
            let (at, sign) = (at.index(letters.len()), signs[sign.index(signs.len())]);
            match how {
                0 => letters[at] = sign,
                1 => letters.insert(at, sign),
                _ => drop(letters.remove(at)),
            }
        }
        survives(&letters.iter().collect::<String>())?;
    }
}

/// Every row with every port and property.
#[test]
fn all_rows_come_back() {
    use std::fmt::Write as _;
    let mut text = "diagram all\n".to_owned();
    for (at, row) in blocks::table().enumerate() {
        let values = row
            .properties
            .iter()
            .map(|one| format!("{} = \"{} 1\"", one.name, one.default.replace('"', "")));
        let values: Vec<String> = values.collect();
        let _ = writeln!(text, "b{at}: \"{}\"({})", row.shown, values.join(", "));
        for port in row.ports {
            let _ = writeln!(text, "b{at}.{} -> b{at}.{}", port.name, port.name);
        }
    }
    let project = super::project(&text);
    let diagram = &project.diagrams[0];
    assert_eq!(diagram.blocks.len(), blocks::table().count());
    let ports: usize = blocks::table().map(|row| row.ports.len()).sum();
    assert_eq!(diagram.edges.len(), ports);
    let written = write(&project);
    assert_eq!(whole(&super::project(&written)), whole(&project));
    assert!(
        !written.contains(" id ") && !written.contains(" at "),
        "{written}"
    );
}

#[test]
fn a_large_program_takes_time_in_proportion() {
    use std::fmt::Write as _;
    let mut text = "diagram large\n".to_owned();
    for at in 0..20_000 {
        let _ = writeln!(text, "b{at}: If named If");
    }
    for at in 0..20_000 {
        let _ = writeln!(text, "b{at}.TRUE -> b{}.DATA", (at * 7 + 1) % 20_000);
    }
    for at in 0..3000 {
        let _ = writeln!(text, "subprogram same\n c{at}: \"User block\" of large");
    }
    let project = super::project(&text);
    let written = write(&project);
    assert_eq!(write(&super::project(&written)), written);
}
