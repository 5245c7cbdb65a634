//! Programs as text: examples, what is said of mistakes, and what is lost (nothing).

mod mistakes;
mod places;
mod round;

use super::{read, write};
use crate::blocks;
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Policy, Project};
use lang_diagram::objects::Object;

/// The wall follower of the specification, 12.1.
pub(crate) const FOLLOWER: &str = "\
kit trikV62Kit

diagram \"Wall follower\"
  A: Sensor(VarName = sensorA1)
  D: Sensor(VarName = sensorD1)
  F: \"Text programming\"(
    IO0 = `u = max(0-30, min(30, 2*(I0-20)))`,
    IO1 = `50 - u`,
    IO2 = `50 + u`,
  )
  C: If(condition = `data < 25`)
  E: \"Text programming\"(IO0 = 60, IO1 = `0 - 60`)
  SL: \"Flow replacer\"(time = 100)
  SR: \"Flow replacer\"(time = 100)
  M: Motors
  A.OUT -> F.I0
  D.OUT -> C.DATA
  F.O1 -> SL.DATA
  F.O2 -> SR.DATA
  C.TRUE -> E.I0
  E.O0 -> SL.REPLACE_DATA
  E.O1 -> SR.REPLACE_DATA
  SL.OUT -> M.M3 latest
  SR.OUT -> M.M4 latest
";

pub(crate) fn project(text: &str) -> Project {
    read(text).unwrap_or_else(|problems| {
        let all: Vec<String> = problems.iter().map(ToString::to_string).collect();
        panic!("{}\n{text}", all.join("\n"))
    })
}

/// All of a project in one text, a row by its name. A field that is forgotten does not compile.
pub(super) fn whole(project: &Project) -> String {
    let Project {
        diagrams,
        main,
        meta,
        world,
    } = project;
    let mut out = format!("{main:?} {meta:?} {world:?}\n");
    for diagram in diagrams {
        let Diagram {
            id,
            logical,
            kind,
            name,
            blocks,
            edges,
        } = diagram;
        out += &format!("{kind:?} {name:?} {id:?} {logical:?}\n");
        for block in blocks {
            let Block {
                id,
                logical,
                row,
                element,
                name,
                properties,
                position,
                calls,
            } = block;
            let row = row.map(|row| row.element);
            out += &format!(
                "{row:?} {element:?} {name:?} {position:?} {calls:?} {id:?} {logical:?} {properties:?}\n"
            );
        }
        for edge in edges {
            out += &format!("{edge:?}\n");
        }
    }
    out
}

#[test]
fn a_program_of_the_specification_is_read_and_written_as_people_wrote_it() {
    let project = project(FOLLOWER);
    assert_eq!(project.main, Some(0));
    assert_eq!(project.meta["lastKitId"], "trikV62Kit");
    let diagram = &project.diagrams[0];
    assert_eq!(
        (diagram.kind, diagram.name.as_str()),
        (DiagramKind::Main, "Wall follower")
    );
    let f = &diagram.blocks[2];
    assert_eq!(f.element, "DFFunctionBlock");
    assert!(std::ptr::eq(
        f.row.unwrap(),
        blocks::find("DFFunctionBlock").unwrap()
    ));
    assert_eq!(
        (f.name.as_str(), f.properties["IO1"].as_str()),
        ("F", "50 - u")
    );
    assert!(!f.properties.contains_key("synch"));
    let Edge {
        from,
        to,
        policy,
        capacity,
        ..
    } = &diagram.edges[2];
    assert_eq!(*from, Some(End { block: 2, port: 5 }));
    assert_eq!(*to, Some(End { block: 5, port: 1 }));
    assert_eq!((*policy, *capacity), (None, None));
    assert_eq!(diagram.edges[7].policy, Some(Policy::Latest));
    assert_eq!(write(&project), FOLLOWER);
}

#[test]
fn ids_are_made_of_names_and_labels() {
    let project = project(FOLLOWER);
    let diagram = &project.diagrams[0];
    let beginning = "qrm:/RobotsDataFlowMetamodel/RobotsDataFlowDiagram";
    assert_eq!(
        diagram.id,
        format!("{beginning}/RobotsBehaviourDiagram/Wall-20-follower")
    );
    let block = &diagram.blocks[5];
    let id = format!("{beginning}/DFSupressorBlock/Wall-20-follower.SL");
    assert_eq!((&block.logical, &block.id), (&format!("{id}.logical"), &id));
    assert_eq!(
        diagram.edges[5].id,
        format!("{beginning}/Edge/Wall-20-follower.E.3.SL.0")
    );
}

#[test]
fn what_stands_nowhere_is_placed_by_its_distance_from_the_start() {
    let project = project(FOLLOWER);
    let all = &project.diagrams[0].blocks;
    let places: Vec<(f64, f64)> = all.iter().map(|block| block.position).collect();
    assert_eq!(
        places,
        [
            (0.0, 0.0),
            (0.0, 195.0),
            (200.0, 0.0),
            (200.0, 390.0),
            (560.0, 0.0),
            (560.0, 390.0),
            (560.0, 570.0),
            (920.0, 0.0),
        ]
    );
    // Beside blocks that have a place, others stand below.
    let text = "diagram a\nX: If at 5, -7.25\nY: Led\nZ: Led\nY.CF_OUT -> Z.CF_IN\n";
    let places: Vec<_> = self::project(text).diagrams[0]
        .blocks
        .iter()
        .map(|block| block.position)
        .collect();
    assert_eq!(places, [(5.0, -7.25), (0.0, 173.0), (200.0, 173.0)]);
}

/// Everything that a line can say.
const ALL: &str = "\
kit trikV62Kit
meta \"a key\" = \"a \\\"value\\\"\\n\\u{202e}\"
meta version = 1.0

diagram first
  wait1: \"Wait and send\"(time = 5, \"later\" = true) named \"Two words\" at 0.1, -1e300
  block1: unknown \"Future block\"(x = `a \"b\"`) of id \"gone\" named \"\" at 0, 0 id \"qrm:/a/b/c/d\" logical \"qrm:/a/b/c/e\"
  loop1: Loop at 1, 2 element \"Old\"
  wait1.OUT -> block1.-1 fifo 16 via 1, 2; 3.5, -4
  block1.7 -> nowhere capacity 3
  nowhere -> wait1.DATA error id \"edge 1\"
  wait1.CF_OUT -> loop1.99

diagram \"second\" run
  call: \"User block\" of \"inner\"

subprogram \"inner\" logical \"\"
  Text: \"Text programming\"(
    IO0 = `x = 1
y = 2`,
    IO1 = \"blank \",
    IO2 = \"\",
  )
  Text.O0 -> Text.I0
  Text.O0 -> Text.I0
";

#[test]
fn all_that_a_line_can_say_stays() {
    let project = project(ALL);
    assert_eq!(project.main, Some(1));
    assert_eq!(project.meta["a key"], "a \"value\"\n\u{202e}");
    let first = &project.diagrams[0];
    assert_eq!(first.blocks[0].name, "Two words");
    assert_eq!(first.blocks[0].properties["later"], "true");
    assert_eq!(first.blocks[0].position, (0.1, -1e300));
    let unknown = &first.blocks[1];
    assert!(unknown.row.is_none());
    assert_eq!(
        (unknown.element.as_str(), unknown.name.as_str()),
        ("Future block", "")
    );
    assert_eq!(unknown.calls.as_deref(), Some("gone"));
    assert_eq!(
        (unknown.id.as_str(), unknown.logical.as_str()),
        ("qrm:/a/b/c/d", "qrm:/a/b/c/e")
    );
    assert_eq!(first.blocks[2].element, "Old");
    assert_eq!(first.edges[0].path, [(1.0, 2.0), (3.5, -4.0)]);
    assert_eq!(first.edges[0].to, Some(End { block: 1, port: -1 }));
    assert_eq!(
        (first.edges[0].policy, first.edges[0].capacity),
        (Some(Policy::Fifo), Some(16))
    );
    assert_eq!(
        (first.edges[1].from, first.edges[1].to),
        (Some(End { block: 1, port: 7 }), None)
    );
    assert_eq!(first.edges[2].id, "edge 1");
    let inner = &project.diagrams[2];
    assert_eq!(project.diagrams[1].blocks[0].calls.as_deref(), Some(""));
    assert_eq!(inner.blocks[0].properties["IO0"], "x = 1\ny = 2");
    assert_ne!(inner.edges[0].id, inner.edges[1].id);
    let text = write(&project);
    assert_eq!(whole(&self::project(&text)), whole(&project));
    // Names that are words may lack their quotes.
    let quoted = ALL.replace("diagram first", "diagram \"first\"");
    assert_eq!(text, quoted);
}

#[test]
fn words_of_the_grammar_can_be_labels_and_blocks_have_names_in_two_languages() {
    let text = "diagram a # a comment\r\n\u{feff}";
    assert!(
        read(text).is_err(),
        "a mark of the byte order stands at the beginning only"
    );
    let russian = blocks::find("DFIfBlock").unwrap().russian;
    let text = format!(
        "\u{feff}diagram a # comment\r\n diagram: If\r\n at: DFIfBlock at 1,2\r\n nowhere:{russian}\r\n\
         kit: If\r\n at.TRUE\u{2192}nowhere.DATA\r\n kit.TRUE -> nowhere"
    );
    let project = project(&text);
    let diagram = &project.diagrams[0];
    assert!(
        diagram
            .blocks
            .iter()
            .all(|block| block.element == "DFIfBlock")
    );
    let names: Vec<&str> = diagram
        .blocks
        .iter()
        .map(|block| block.name.as_str())
        .collect();
    assert_eq!(names, ["diagram", "at", "nowhere", "kit"]);
    assert_eq!(diagram.edges[0].to, Some(End { block: 2, port: 1 }));
    assert_eq!(diagram.edges[1].to, None);
    assert_eq!(whole(&self::project(&write(&project))), whole(&project));
}

#[test]
fn labels_come_from_captions_and_outlive_other_captions() {
    let mut project =
        project("diagram a\n left: Motors\n Motors: Motors\n x: Motors named Motors\n");
    let blocks = &mut project.diagrams[0].blocks;
    blocks[0].name = "Left wheel".to_owned();
    for block in &mut blocks[1..] {
        let name = format!("{{{}}}", block.id.len());
        block.id = format!("qrm:/a/b/{}/{name}", block.element);
        block.logical = format!("qrm:/a/b/{}/{name}l", block.element);
    }
    let text = write(&project);
    let labels: Vec<&str> = text
        .lines()
        .filter_map(|line| line.trim().split_once(": Motors"))
        .map(|(label, _)| label)
        .collect();
    assert_eq!(labels, ["left", "Motors", "motors1"]);
    assert!(
        text.contains("left: Motors named \"Left wheel\"\n"),
        "{text}"
    );
}

#[test]
fn nothing_is_a_project_and_nothing_may_be_run() {
    assert_eq!(write(&Project::default()), "");
    assert!(read("\n# nothing\n").unwrap().diagrams.is_empty());
    let text = "run nothing\n\ndiagram \"a\"\n";
    assert_eq!(project(text).main, None);
    assert_eq!(write(&project(text)), text);
    assert_eq!(project("subprogram a").main, None);
    assert_eq!(project("subprogram a run").main, Some(0));
}

#[test]
fn ids_that_are_taken_are_not_made_again() {
    let made = project("diagram a\n A: If\n").diagrams[0].blocks[0]
        .id
        .clone();
    let text = format!(
        "diagram a\n A: If\n B: If id \"{made}\" logical \"{made}.logical\"\ndiagram a\n A: If\n"
    );
    let project = project(&text);
    let (first, second) = (&project.diagrams[0], &project.diagrams[1]);
    assert_eq!(first.blocks[0].id, format!("{made}.x1"));
    assert_eq!(first.blocks[1].id, made);
    assert!(second.id.ends_with("/a.2"), "{}", second.id);
    assert!(second.blocks[0].id.ends_with("/a.2.A"));
    assert_eq!(whole(&self::project(&write(&project))), whole(&project));
}

#[test]
fn ids_that_cannot_stay_are_made_anew_and_all_others_stay() {
    let mut project = project("diagram a\n A: If\n B: If\n C: If\n A.TRUE -> B.DATA\n");
    let diagram = &mut project.diagrams[0];
    let good = diagram.blocks[2].id.clone();
    diagram.blocks[0].id = "qrm:/a/../../../etc/passwd".to_owned();
    diagram.blocks[1].id = diagram.id.clone();
    let back = self::project(&write(&project));
    let diagram = &back.diagrams[0];
    assert_eq!(diagram.blocks[2].id, good);
    assert!(
        diagram.blocks[0].id.ends_with("/a.A"),
        "{}",
        diagram.blocks[0].id
    );
    assert_eq!(
        (
            diagram.blocks[0].name.as_str(),
            diagram.blocks[1].name.as_str()
        ),
        ("A", "B")
    );
}

#[test]
fn ids_that_are_made_can_be_those_of_a_save_whatever_the_names_are() {
    let long = "x".repeat(400);
    let odd = [
        "",
        ".",
        "..",
        "a/../b",
        "a\\\\b",
        "qrm:/",
        "C:",
        "\\n",
        "-",
        "\u{434}\u{430}",
        &long,
    ];
    for name in odd {
        let wide = "\u{434}".repeat(300);
        let text = format!(
            "diagram \"{name}\"\n A: unknown \"{name}\"\n {wide}: If element \"{name}\"\n A.1 -> {wide}.DATA\n A.1 -> nowhere\n\
             subprogram \"{name}\"\n A: unknown \"{name}\"\n A.2147483647 -> A.-2147483648\n"
        );
        let project = project(&text);
        let mut seen = std::collections::HashSet::new();
        for diagram in &project.diagrams {
            let blocks = diagram
                .blocks
                .iter()
                .flat_map(|block| [&block.id, &block.logical]);
            let edges = diagram.edges.iter().map(|edge| &edge.id);
            for id in [&diagram.id, &diagram.logical]
                .into_iter()
                .chain(blocks)
                .chain(edges)
            {
                assert!(seen.insert(id.as_str()), "{id}");
                let document = lang_text::xml::Element::new("object").with("id", id.as_str());
                let object = Object::from_document(&document, &mut 0, &mut Vec::new());
                let object = object.unwrap_or_else(|problem| panic!("{name}: {id}: {problem}"));
                assert_eq!(id.split('/').count(), 5, "{id}");
                assert!(!object.element().is_empty());
            }
        }
        assert_eq!(whole(&self::project(&write(&project))), whole(&project));
    }
}
