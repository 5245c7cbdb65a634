//! Data-flow programs that are drawn, and changed as they came.

use super::*;
use crate::{fuzz, save, text};
use lang_diagram::edit::{Change, Editor};
use lang_diagram::objects::{Kind, Objects, ROOT};
use lang_diagram::project::DiagramKind;
use lang_diagram::read::Meta;
use lang_expr::Kit;
use lang_text::problem::Problem;
use proptest::prelude::*;

fn editor() -> Editor {
    Editor::blank_of(&DataFlow, Kit::V62, Locale::English, 7)
}

fn project(editor: &Editor) -> Project {
    let (project, problems) = read::project(editor.save());
    assert_eq!(problems, []);
    project
}

fn add(editor: &mut Editor, kind: &str, properties: &[(&str, &str)]) -> String {
    let diagram = project(editor).diagrams[0].id.clone();
    let properties = properties.iter();
    let block = Drawn {
        properties: properties
            .map(|(a, b)| ((*a).into(), (*b).into()))
            .collect(),
        ..Drawn::of(kind, (200.0, 100.0))
    };
    let piece = Piece {
        blocks: vec![block],
        links: Vec::new(),
    };
    editor
        .apply(&Change::Add { diagram, piece })
        .unwrap()
        .remove(0)
}

/// Connects ports by their names.
fn connect(editor: &mut Editor, from: (&str, &str), to: (&str, &str)) -> Result<String, Problem> {
    let now = project(editor);
    let port = |(id, name): (&str, &str)| {
        let blocks = now.diagrams.iter().flat_map(|one| &one.blocks);
        let block = blocks.into_iter().find(|one| one.id == id).unwrap();
        block.row.unwrap().port(name).unwrap()
    };
    let change = Change::Connect {
        from: from.0.to_owned(),
        to: to.0.to_owned(),
        guard: String::new(),
        ports: Some((port(from), port(to))),
    };
    editor.apply(&change).map(|mut new| new.remove(0))
}

fn said(problem: &Problem) -> String {
    problem.words.english.to_string()
}

#[test]
fn a_program_is_drawn_from_nothing_and_is_the_one_of_its_text() {
    let mut editor = editor();
    let wall = add(&mut editor, "DFSensorVarBlock", &[("VarName", "sensorD1")]);
    let slow = add(&mut editor, "DFFunctionBlock", &[("IO0", "2 * (I0 - 20)")]);
    let wheels = add(&mut editor, "DFMotorsBlock", &[]);
    connect(&mut editor, (&wall, "OUT"), (&slow, "I0")).unwrap();
    connect(&mut editor, (&slow, "O0"), (&wheels, "M3")).unwrap();
    let last = connect(&mut editor, (&slow, "O0"), (&wheels, "M4")).unwrap();
    let opened = lang_diagram::read::read(&editor.save().write().unwrap()).unwrap();
    assert_eq!(read::language(&opened.save), read::Language::Dataflow);
    let (again, problems) = read::project(&opened.save);
    assert_eq!(problems, []);
    assert!(!check::check(&again).has_errors());
    let text = text::write(&again);
    for line in ["Sensor", "O0 -> ", "M4", "VarName = sensorD1"] {
        assert!(text.contains(line), "{line}: {text}");
    }
    // As the editor of the language has it: numbers of ports, places relative to where the link begins.
    let link = opened.save.objects().get(&last).unwrap();
    let (_, of_slow) = (0, blocks::find("DFFunctionBlock").unwrap());
    assert_eq!(
        link.property("fromPort"),
        Some(&*of_slow.port("O0").unwrap().to_string())
    );
    let (x, y) = (200.0 + 260.0, 100.0 + 40.0);
    assert_eq!(link.property("position"), Some(&*format!("{x}, {y}")));
}

#[test]
fn links_lead_from_outputs_to_inputs_of_a_fitting_type() {
    let mut editor = editor();
    let say = add(&mut editor, "DFSayBlock", &[]);
    let zip = add(&mut editor, "DFInterflowingBlock", &[]);
    let motors = add(&mut editor, "DFMotorsBlock", &[]);
    let before = editor.save().clone();
    for (from, to, why) in [
        ((&*say, "DATA"), (&*zip, "DATA1"), "other way round"),
        ((&*zip, "OUT"), (&*zip, "OUT"), "ends at an input"),
        ((&*zip, "OUT"), (&*motors, "M3"), "a list comes here"),
    ] {
        let wrong = connect(&mut editor, from, to).unwrap_err();
        assert!(said(&wrong).contains(why), "{wrong:?}");
    }
    let change = |ports, guard: &str| Change::Connect {
        from: say.clone(),
        to: motors.clone(),
        guard: guard.to_owned(),
        ports,
    };
    let wrong = editor.apply(&change(None, "")).unwrap_err();
    assert!(said(&wrong).contains("say which ones"), "{wrong:?}");
    let wrong = editor.apply(&change(Some((77, 0)), "")).unwrap_err();
    assert!(said(&wrong).contains("no such port"), "{wrong:?}");
    assert!(editor.apply(&change(Some((1, 0)), "true")).is_err());
    assert_eq!(editor.save().objects().len(), before.objects().len());
    assert_eq!(editor.undo_count(), 3);
}

#[test]
fn a_link_keeps_its_place_in_the_order_of_delivery_and_says_what_its_queue_does() {
    let mut editor = editor();
    let wall = add(&mut editor, "DFSensorVarBlock", &[]);
    let zip = add(&mut editor, "DFInterflowingBlock", &[]);
    let first = connect(&mut editor, (&wall, "OUT"), (&zip, "DATA1")).unwrap();
    let second = connect(&mut editor, (&wall, "OUT"), (&zip, "DATA2")).unwrap();
    let ports = Some((1, 2));
    let (from, to) = (wall.clone(), zip.clone());
    let link = first.clone();
    editor
        .apply(&Change::Reconnect {
            link,
            from,
            to,
            ports,
        })
        .unwrap();
    let order = |editor: &Editor| {
        let edges = project(editor).diagrams.remove(0).edges;
        let all = edges.into_iter();
        all.map(|one| (one.id, one.to.unwrap().port))
            .collect::<Vec<_>>()
    };
    assert_eq!(order(&editor), [(first.clone(), 2), (second, 2)]);
    let set = |property: &str, value: &str| Change::Set {
        id: first.clone(),
        property: property.to_owned(),
        value: value.to_owned(),
    };
    editor.apply(&set("Policy", "latest")).unwrap();
    assert!(project(&editor).diagrams[0].edges[0].policy.is_some());
    editor.apply(&set("Policy", "")).unwrap();
    assert!(project(&editor).diagrams[0].edges[0].policy.is_none());
    assert!(editor.apply(&set("Guard", "true")).is_err());
}

#[test]
fn a_subprogram_is_called_renamed_and_has_no_parameters() {
    let mut editor = editor();
    let kind = DiagramKind::Subprogram;
    let name = "PID".to_owned();
    let callee = editor
        .apply(&Change::AddDiagram { kind, name })
        .unwrap()
        .remove(0);
    let call = add(&mut editor, CALL, &[]);
    let (id, diagram) = (call.clone(), callee.clone());
    editor.apply(&Change::Call { id, diagram }).unwrap();
    let (diagram, name) = (callee.clone(), "PD".to_owned());
    editor.apply(&Change::Rename { diagram, name }).unwrap();
    let now = project(&editor);
    let block = &now.diagrams[0].blocks[0];
    let called = block.calls.as_deref().and_then(|id| now.called(id));
    assert_eq!((&*block.name, called), ("PD", Some(1)));
    let piece = editor.copy(std::slice::from_ref(&call));
    assert_eq!(piece.blocks[0].calls.as_deref(), Some("PD"));
    let parameters = Vec::new();
    let wrong = editor.apply(&Change::Parameters {
        diagram: callee,
        parameters,
    });
    assert!(said(&wrong.unwrap_err()).contains("no parameters"));
    let diagram = now.diagrams[0].id.clone();
    let wrong = editor.apply(&Change::RemoveDiagram { diagram });
    assert!(said(&wrong.unwrap_err()).contains("only main diagram"));
}

#[test]
fn a_block_goes_into_a_link_by_two_ports() {
    let mut editor = editor();
    let wall = add(&mut editor, "DFSensorVarBlock", &[]);
    let say = add(&mut editor, "DFSayBlock", &[]);
    let link = connect(&mut editor, (&wall, "OUT"), (&say, "DATA")).unwrap();
    let wait = blocks::find("DFWaitBlock").unwrap();
    let ports = (wait.port("DATA").unwrap(), wait.port("OUT").unwrap());
    let insert = |ports| Change::Insert {
        link: link.clone(),
        block: Drawn::of("DFWaitBlock", (400.0, 0.0)),
        guard: String::new(),
        ports,
    };
    assert!(editor.apply(&insert(None)).is_err());
    editor.apply(&insert(Some(ports))).unwrap();
    let text = text::write(&project(&editor));
    assert_eq!(text.matches(" -> ").count(), 2, "{text}");
    assert!(
        text.contains(".OUT -> ") && text.contains(".DATA"),
        "{text}"
    );
}

/// A save of before 2016-07-12, whose ports had other numbers.
fn former() -> Save {
    let mut objects = Objects::default();
    let id = |element: &str, at: &str| {
        format!("qrm:/RobotsDataFlowMetamodel/RobotsDataFlowDiagram/{element}/{{{at}}}")
    };
    let main = id(MAIN, "0");
    let blocks = [("Motors", "1"), ("SayNode", "2")];
    let mut add = |id: String, parent: &str, logical: Option<String>, children: Vec<String>| {
        let mut object = Object {
            id,
            parent: parent.to_owned(),
            logical,
            children,
            ..Object::default()
        };
        object.set(Kind::Text, "name", "x");
        objects.add(object).unwrap();
    };
    let children = blocks.map(|(kind, at)| id(kind, at)).to_vec();
    add(ROOT.to_owned(), "qrm:/", None, vec![main.clone()]);
    add(main.clone(), ROOT, Some(id(MAIN, "l0")), children);
    add(id(MAIN, "l0"), ROOT, None, Vec::new());
    for (kind, at) in blocks {
        let logical = id(kind, &format!("l{at}"));
        add(id(kind, at), &main, Some(logical.clone()), Vec::new());
        add(logical, ROOT, None, Vec::new());
    }
    Save::made(objects, Meta::default())
}

#[test]
fn blocks_of_an_old_save_are_connected_by_their_old_numbers() {
    let save = former();
    let mut editor = Editor::of(&DataFlow, save, 1);
    let (now, _) = read::project(editor.save());
    let [motors, say] = &now.diagrams[0].blocks[..] else {
        panic!("two blocks");
    };
    let port = |block: &Block, name: &str| block.row.unwrap().port(name).unwrap();
    let change = |from: &Block, to: &Block, ports| Change::Connect {
        from: from.id.clone(),
        to: to.id.clone(),
        guard: String::new(),
        ports: Some(ports),
    };
    let ports = (port(motors, "CF_OUT"), port(say, "DATA"));
    let link = editor.apply(&change(motors, say, ports)).unwrap().remove(0);
    let object = editor.save().objects().get(&link).unwrap();
    assert_eq!(
        (object.property("fromPort"), object.property("toPort")),
        (Some("2"), Some("1"))
    );
    let (again, _) = read::project(editor.save());
    let edge = &again.diagrams[0].edges[0];
    assert_eq!(
        (edge.from.unwrap().port, edge.to.unwrap().port),
        (i32::from(ports.0), i32::from(ports.1))
    );
    // It could not be started by a token then.
    let ports = (port(motors, "CF_OUT"), port(say, "CF_IN"));
    assert!(editor.apply(&change(motors, say, ports)).is_err());
}

/// All programs of the library, as saves.
fn library() -> Vec<Save> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/dataflow");
    let files = std::fs::read_dir(folder).unwrap();
    let files = files.map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "flow"))
        .collect();
    files.sort();
    let made = |path: &std::path::PathBuf| {
        let text = std::fs::read_to_string(path).unwrap();
        let made = save::save(&text::read(&text).unwrap());
        lang_diagram::read::read(&made.write().unwrap())
            .unwrap()
            .save
    };
    files.iter().map(made).collect()
}

#[test]
fn what_a_change_does_not_name_stays_byte_for_byte() {
    let saves = library();
    assert!(saves.len() >= 5);
    for save in saves {
        let before = save.write().unwrap();
        let (now, _) = read::project(&save);
        let ids: Vec<String> = now.diagrams[0]
            .blocks
            .iter()
            .map(|one| one.id.clone())
            .collect();
        let mut editor = Editor::of(&DataFlow, save, 3);
        let diagram = now.diagrams[0].id.clone();
        let piece = editor.copy(&ids);
        assert_eq!(piece.blocks.len(), ids.len());
        assert_eq!(piece.links.len(), now.diagrams[0].edges.len());
        editor.apply(&Change::Add { diagram, piece }).unwrap();
        editor.apply(&Change::Remove { ids }).unwrap();
        assert_ne!(editor.save().write().unwrap(), before);
        while editor.undo() {}
        assert_eq!(editor.save().write().unwrap(), before);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn changes_are_whole_and_taken_back_without_a_trace(
        bytes in proptest::collection::vec(any::<u8>(), 0..600),
        which in 0_usize..6,
    ) {
        match library().into_iter().nth(which) {
            Some(save) => fuzz::edits_of(Editor::of(&DataFlow, save, 26), &bytes),
            None => fuzz::edits(&bytes),
        }
        fuzz::edits_of(Editor::of(&DataFlow, former(), 26), &bytes);
    }
}
