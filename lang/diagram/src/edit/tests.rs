//! Projects that are drawn from nothing.

use super::*;
use crate::check::check;
use crate::lower::World;
use crate::project::Project;
use crate::read::read;
use lang_text::problem::Severity;

fn editor() -> Editor {
    Editor::blank(Kit::V62, Locale::English, 7)
}

fn project(editor: &Editor) -> Project {
    let (project, problems) = editor.save().project();
    assert_eq!(problems, []);
    project
}

fn main_of(editor: &Editor) -> String {
    project(editor).diagrams[0].id.clone()
}

/// Adds a block to the main diagram.
fn add(editor: &mut Editor, kind: &str, place: (f64, f64)) -> String {
    let diagram = main_of(editor);
    let piece = Piece {
        blocks: vec![Drawn::of(kind, place)],
        links: Vec::new(),
    };
    let mut new = editor.apply(&Change::Add { diagram, piece }).unwrap();
    assert_eq!(new.len(), 1);
    new.remove(0)
}

fn connect(editor: &mut Editor, from: &str, to: &str) -> String {
    let change = Change::Connect {
        from: from.to_owned(),
        to: to.to_owned(),
        guard: String::new(),
        ports: None,
    };
    editor.apply(&change).unwrap().remove(0)
}

fn set(editor: &mut Editor, id: &str, property: &str, value: &str) {
    let change = Change::Set {
        id: id.to_owned(),
        property: property.to_owned(),
        value: value.to_owned(),
    };
    editor.apply(&change).unwrap();
}

fn refused(editor: &mut Editor, change: &Change) -> String {
    editor.apply(change).unwrap_err().words.english.to_string()
}

#[test]
fn a_program_is_drawn_from_nothing() {
    let mut editor = editor();
    let blocks = &project(&editor).diagrams[0].blocks;
    let (start, end) = (blocks[0].id.clone(), blocks[1].id.clone());
    let motors = add(&mut editor, "TrikV6EnginesForward", (200.0, 200.0));
    let wait = add(&mut editor, "Timer", (300.0, 200.0));
    set(&mut editor, &wait, "Delay", "500");
    for ends in [&start, &motors, &wait, &end].windows(2) {
        connect(&mut editor, ends[0], ends[1]);
    }
    let opened = read(&editor.save().write().unwrap()).unwrap();
    assert_eq!(opened.problems, []);
    assert_eq!(opened.project, project(&editor));
    let diagram = &opened.project.diagrams[0];
    assert_eq!(diagram.blocks[2].properties["Power"], "100");
    assert_eq!(diagram.blocks[3].properties["Delay"], "500");
    assert_eq!(diagram.links[0].path, [(150.0, 225.0), (200.0, 225.0)]);
    let mistakes = check(&opened.project, World::Robot);
    let mut mistakes = mistakes.iter();
    assert!(
        mistakes.all(|one| one.severity != Severity::Error),
        "{mistakes:?}"
    );
}

#[test]
fn a_block_takes_its_links_with_it_and_brings_them_back() {
    let mut editor = editor();
    let blocks = &project(&editor).diagrams[0].blocks;
    let (start, end) = (blocks[0].id.clone(), blocks[1].id.clone());
    let wait = add(&mut editor, "Timer", (200.0, 200.0));
    connect(&mut editor, &start, &wait);
    connect(&mut editor, &wait, &end);
    let before = project(&editor);
    let ids = vec![wait];
    editor.apply(&Change::Remove { ids }).unwrap();
    let after = project(&editor);
    assert_eq!(
        (
            after.diagrams[0].blocks.len(),
            after.diagrams[0].links.len()
        ),
        (2, 0)
    );
    assert!(
        editor
            .save()
            .objects()
            .get(&start)
            .unwrap()
            .list("links")
            .is_empty()
    );
    assert!(editor.undo());
    assert_eq!(project(&editor), before);
    assert!(editor.redo());
    assert_eq!(project(&editor), after);
    assert!(!editor.redo());
}

#[test]
fn images_come_and_go_with_their_world_and_are_not_copied_by_other_changes() {
    let mut editor = editor();
    let world = |images: Option<&str>| Change::World {
        text: Some(format!("<root n=\"{}\"/>", images.map_or(0, str::len))),
        images: images.map(str::to_owned),
    };
    let images = format!(
        "<blobs><images><image imageId=\"p\" path=\"a.png\">{}</image></images></blobs>",
        "A".repeat(limits::EDIT_HISTORY_BYTES / 8)
    );
    editor.apply(&world(Some(&images))).unwrap();
    let opened = read(&editor.save().write().unwrap()).unwrap();
    assert_eq!(opened.project.blobs.as_deref(), Some(&*images));
    for _ in 0..20 {
        editor.apply(&world(None)).unwrap();
    }
    assert_eq!(project(&editor).blobs.as_deref(), Some(&*images));
    assert_eq!(editor.undo_count(), 21);
    editor.apply(&world(Some(""))).unwrap();
    assert_eq!(project(&editor).blobs, None);
    let opened = read(&editor.save().write().unwrap()).unwrap();
    assert_eq!(opened.project.blobs, None);
    assert!(editor.undo());
    assert_eq!(project(&editor).blobs.as_deref(), Some(&*images));
    let refused = editor.apply(&world(Some("<blobs>"))).unwrap_err();
    assert_eq!(refused.place.file.as_deref(), Some("blobs.xml"));
    assert_eq!(project(&editor).blobs.as_deref(), Some(&*images));
    while editor.undo() {}
    assert_eq!(project(&editor).blobs, None);
}

#[test]
fn links_follow_a_block_that_moves() {
    let mut editor = editor();
    let blocks = &project(&editor).diagrams[0].blocks;
    let (start, end) = (blocks[0].id.clone(), blocks[1].id.clone());
    let link = connect(&mut editor, &start, &end);
    let places = vec![(end, (100.0, 400.0))];
    editor.apply(&Change::Move { places }).unwrap();
    let diagram = &project(&editor).diagrams[0];
    assert_eq!(diagram.links[0].path, [(125.0, 250.0), (125.0, 400.0)]);
    let object = editor.save().objects().get(&link).unwrap();
    assert_eq!(object.property("fromPort"), Some("3.5"));
    assert_eq!(object.property("toPort"), Some("1.5"));
}

#[test]
fn a_call_has_the_parameters_and_the_name_of_its_subprogram() {
    let mut editor = editor();
    let kind = DiagramKind::Subprogram;
    let name = "turn".to_owned();
    let change = Change::AddDiagram { kind, name };
    let diagram = editor.apply(&change).unwrap().remove(0);
    let parameter = |name: &str| Parameter {
        name: name.to_owned(),
        kind: "int".to_owned(),
        default: "90".to_owned(),
    };
    let parameters = vec![parameter("angle"), parameter("speed")];
    let change = Change::Parameters {
        diagram: diagram.clone(),
        parameters,
    };
    editor.apply(&change).unwrap();
    let call = Drawn {
        calls: Some("turn".to_owned()),
        arguments: vec![("angle".to_owned(), "x + 1".to_owned())],
        ..Drawn::of("Subprogram", (0.0, 0.0))
    };
    let piece = Piece {
        blocks: vec![call],
        links: Vec::new(),
    };
    let change = Change::Add {
        diagram: main_of(&editor),
        piece,
    };
    let id = editor.apply(&change).unwrap().remove(0);
    let change = Change::Argument {
        id: id.clone(),
        name: "speed".to_owned(),
        value: "y".to_owned(),
    };
    editor.apply(&change).unwrap();
    let name = "spin".to_owned();
    editor.apply(&Change::Rename { diagram, name }).unwrap();
    let project = project(&editor);
    let block = project.diagrams[0].blocks.last().unwrap();
    assert_eq!(block.name, "spin");
    let arguments = block.arguments.iter().map(|one| (&*one.name, &*one.value));
    assert_eq!(
        arguments.collect::<Vec<_>>(),
        [("angle", "x + 1"), ("speed", "y")]
    );
    assert_eq!(project.called(block.calls.as_deref().unwrap()), Some(1));
    let diagram = project.diagrams[1].id.clone();
    editor.apply(&Change::RemoveDiagram { diagram }).unwrap();
    let project = self::project(&editor);
    assert_eq!(
        (
            project.diagrams.len(),
            &project.diagrams[0].blocks.last().unwrap().calls
        ),
        (1, &None)
    );
}

#[test]
fn a_copy_goes_into_another_project() {
    let mut first = editor();
    let blocks = &project(&first).diagrams[0].blocks;
    let (start, end) = (blocks[0].id.clone(), blocks[1].id.clone());
    let wait = add(&mut first, "Timer", (200.0, 200.0));
    set(&mut first, &wait, "Delay", "70");
    connect(&mut first, &start, &wait);
    connect(&mut first, &wait, &end);
    let piece = first.copy(&[wait, end]);
    assert_eq!((piece.blocks.len(), piece.links.len()), (2, 1));
    let mut second = Editor::blank(Kit::V6, Locale::English, 8);
    let diagram = main_of(&second);
    let new = second.apply(&Change::Add { diagram, piece }).unwrap();
    assert_eq!(new.len(), 3);
    let diagram = &project(&second).diagrams[0];
    assert_eq!(diagram.blocks[2].properties["Delay"], "70");
    assert_eq!(diagram.links[0].from, Some(2));
}

#[test]
fn what_cannot_be_changes_nothing() {
    let mut editor = editor();
    let before = project(&editor);
    let diagram = main_of(&editor);
    let start = before.diagrams[0].blocks[0].id.clone();
    let wrong = refused(
        &mut editor,
        &Change::Remove {
            ids: vec![start.clone(), "x".into()],
        },
    );
    assert!(wrong.contains("no such block"), "{wrong}");
    let wrong = refused(
        &mut editor,
        &Change::RemoveDiagram {
            diagram: diagram.clone(),
        },
    );
    assert!(wrong.contains("only main diagram"), "{wrong}");
    let far = vec![(start.clone(), (1e9, 0.0))];
    let wrong = refused(&mut editor, &Change::Move { places: far });
    assert!(wrong.contains("too far away"), "{wrong}");
    let set = |property: &str, value: String| Change::Set {
        id: start.clone(),
        property: property.to_owned(),
        value,
    };
    let wrong = refused(&mut editor, &set("from", String::new()));
    assert!(wrong.contains("no property 'from'"), "{wrong}");
    let piece = Piece {
        blocks: vec![
            Drawn::of("Timer", (0.0, 0.0)),
            Drawn::of("ControlFlow", (0.0, 0.0)),
        ],
        links: Vec::new(),
    };
    let wrong = refused(
        &mut editor,
        &Change::Add {
            diagram: diagram.clone(),
            piece,
        },
    );
    assert!(wrong.contains("no block of this type"), "{wrong}");
    let wrong = refused(
        &mut editor,
        &Change::Rename {
            diagram,
            name: " ".into(),
        },
    );
    assert!(wrong.contains("name is missing"), "{wrong}");
    assert_eq!(project(&editor), before);
    assert_eq!(editor.undo_count(), 0);
}

/// Adds a subprogram with a parameter.
fn subprogram(editor: &mut Editor, name: &str) -> Result<String, Problem> {
    let kind = DiagramKind::Subprogram;
    let name = name.to_owned();
    let diagram = editor.apply(&Change::AddDiagram { kind, name })?.remove(0);
    let parameters = vec![Parameter {
        name: "far".to_owned(),
        kind: "int".to_owned(),
        default: "1".to_owned(),
    }];
    let change = Change::Parameters {
        diagram: diagram.clone(),
        parameters,
    };
    editor.apply(&change)?;
    Ok(diagram)
}

#[test]
fn a_block_calls_another_subprogram_and_no_two_have_one_name() {
    let mut editor = editor();
    subprogram(&mut editor, "one").unwrap();
    let other = subprogram(&mut editor, "other").unwrap();
    let call = Drawn {
        calls: Some("one".to_owned()),
        arguments: vec![("far".to_owned(), "7".to_owned())],
        ..Drawn::of("Subprogram", (0.0, 0.0))
    };
    let piece = Piece {
        blocks: vec![call],
        links: Vec::new(),
    };
    let diagram = main_of(&editor);
    let id = editor
        .apply(&Change::Add { diagram, piece })
        .unwrap()
        .remove(0);
    let change = Change::Call {
        id: id.clone(),
        diagram: other.clone(),
    };
    editor.apply(&change).unwrap();
    let project = project(&editor);
    let block = project.diagrams[0].blocks.last().unwrap();
    assert_eq!(
        (
            &*block.name,
            project.called(block.calls.as_deref().unwrap())
        ),
        ("other", Some(2))
    );
    assert_eq!(block.arguments[0].value, "7");
    assert!(editor.save().objects().iter().all(|object| {
        object.list("incomingExplosions").is_empty() || object.property("name") == Some("other")
    }));
    let name = "one".to_owned();
    let wrong = refused(
        &mut editor,
        &Change::Rename {
            diagram: other,
            name,
        },
    );
    assert!(
        wrong.contains("another subprogram is called 'one'"),
        "{wrong}"
    );
    assert!(subprogram(&mut editor, "one").is_err());
    let main = main_of(&editor);
    let wrong = refused(&mut editor, &Change::Call { id, diagram: main });
    assert!(wrong.contains("only a subprogram"), "{wrong}");
    let undone = editor.undo_count();
    for _ in 0..undone {
        assert!(editor.undo());
    }
    assert!(editor.save().objects().len() < 8);
}

#[test]
fn a_block_is_put_into_a_link_and_taken_out_of_it_by_one_step() {
    let mut editor = editor();
    let blocks = &project(&editor).diagrams[0].blocks;
    let (start, end) = (blocks[0].id.clone(), blocks[1].id.clone());
    let link = connect(&mut editor, &start, &end);
    set(&mut editor, &link, "Guard", "true");
    let before = project(&editor);
    let block = Drawn::of("Timer", (250.0, 200.0));
    let change = Change::Insert {
        link,
        block,
        guard: String::new(),
        ports: None,
    };
    assert_eq!(editor.apply(&change).unwrap().len(), 2);
    let diagram = &project(&editor).diagrams[0];
    let wires = diagram
        .links
        .iter()
        .map(|one| (one.from, one.to, &*one.guard));
    assert_eq!(
        wires.collect::<Vec<_>>(),
        [(Some(0), Some(2), "true"), (Some(2), Some(1), "")]
    );
    assert!(editor.undo());
    assert_eq!(project(&editor), before);
}
