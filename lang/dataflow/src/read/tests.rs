//! Saves to projects, and projects to saves.

use super::*;
use crate::machine::fixtures::{diagram, project as made};
use crate::save::save;
use lang_diagram::objects::Object;
use lang_diagram::read::read;
use lang_text::problem::Locale;

/// A project as it is after it was written and read again, with what was told.
fn again(project: &Project) -> (Project, Vec<String>) {
    let bytes = save(project).write().expect("a save");
    let opened = read(&bytes).expect("a project");
    assert!(opened.problems.is_empty(), "{:?}", opened.problems);
    assert_eq!(language(&opened.save), Language::Dataflow);
    let (project, problems) = super::project(&opened.save);
    (project, problems.iter().map(ToString::to_string).collect())
}

/// Ids as saves have them.
fn with_ids(mut project: Project) -> Project {
    let long = |id: &str, element: &str, part: &str| {
        let unique: String = id.chars().filter(char::is_ascii_alphanumeric).collect();
        format!("qrm:/RobotsDataFlowMetamodel/RobotsDataFlowDiagram/{element}/{part}{unique}")
    };
    let calls = |id: &str| long(id, SUBPROGRAM, "logical");
    for diagram in &mut project.diagrams {
        let element = match diagram.kind {
            DiagramKind::Main => MAIN,
            DiagramKind::Subprogram => SUBPROGRAM,
        };
        diagram.id = long(&diagram.id, element, "");
        diagram.logical = long(&diagram.logical, element, "logical");
        for block in &mut diagram.blocks {
            block.id = long(&block.id, &block.element, "");
            block.logical = format!("{}-logical", block.id);
            block.calls = block.calls.as_deref().map(calls);
        }
        for edge in &mut diagram.edges {
            edge.id = long(&edge.id, EDGE, "");
        }
    }
    project
}

#[test]
fn what_was_written_is_read_as_it_was() {
    let inner = diagram(
        "inner part",
        DiagramKind::Subprogram,
        "I Input port {identifier=I0}\nO Output port {identifier=O1}\nI.OUT > O.DATA",
    );
    let mut main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor {VarName=sensorD1}\nC User block of inner part\nF Text programming {IO0=I0 < 3 & \"x\"}\nM Motors\nA.OUT > C.I0\nA.OUT > F.I0\nC.O1 > M.M3",
    );
    main.blocks[0].position = (-12.5, 1e6);
    main.edges[0].policy = Some(Policy::Latest);
    main.edges[1].capacity = Some(7);
    main.edges[2].path = vec![(1.0, 2.0), (3.5, 4.0), (5.0, 6.0)];
    main.edges[2].to = None;
    let mut project = with_ids(made(vec![main, inner]));
    project
        .meta
        .insert("lastKitId".to_owned(), "trikV62Kit".to_owned());
    let (read, told) = again(&project);
    assert!(told.is_empty(), "{told:?}");
    project.meta.insert(
        "RobotsDataFlowMetamodelVersion".to_owned(),
        "1.0.0".to_owned(),
    );
    assert_eq!(format!("{project:#?}"), format!("{read:#?}"));
}

/// A save with two main diagrams and a subprogram of this language, and then a diagram of control flow.
fn of_both_languages() -> Save {
    let main = |name| diagram(name, DiagramKind::Main, "S Say");
    let inner = diagram("inner", DiagramKind::Subprogram, "S Say");
    let read = save(&with_ids(made(vec![main("first"), inner, main("second")])));
    let mut objects = read.objects().clone();
    let id = "qrm:/RobotsMetamodel/RobotsDiagram/RobotsDiagramNode/{c}";
    let mut other = Object {
        id: id.to_owned(),
        parent: objects::ROOT.to_owned(),
        logical: Some(format!("{id}-logical")),
        ..Object::default()
    };
    objects.add(other.clone()).expect("a new id");
    other.id = format!("{id}-logical");
    other.logical = None;
    other.set(Kind::Text, "name", "control");
    objects.add(other).expect("a new id");
    let root = objects.get_mut(objects::ROOT).expect("a root");
    root.children.push(id.to_owned());
    Save::made(objects, read.meta().clone())
}

#[test]
fn another_main_diagram_is_run_if_it_is_asked_for() {
    let mut chosen = of_both_languages();
    let run = |save: &Save| {
        let bytes = save.write().expect("a save");
        let opened = read(&bytes).expect("a project");
        match language(&opened.save) {
            Language::Diagram => opened.project.diagrams[0].name.clone(),
            Language::Dataflow => {
                let (project, _) = super::project(&opened.save);
                project.diagrams[project.main.expect("a main diagram")]
                    .name
                    .clone()
            }
        }
    };
    assert_eq!(run(&chosen), "first");
    for name in ["second", "control", "first"] {
        choose(&mut chosen, name).expect("a main diagram");
        assert_eq!(run(&chosen), name);
    }
    for (name, told) in [
        (
            "secnd",
            "there is no diagram 'secnd' that can be run here; there are: first, control, second; did you mean 'second'?",
        ),
        (
            "inner",
            "diagram 'inner' is a subprogram, which runs only where a block calls it",
        ),
    ] {
        let why = choose(&mut chosen, name).expect_err("no main diagram");
        assert_eq!(why.in_locale(Locale::English), told);
        assert_eq!(run(&chosen), "first");
    }
    let mut project = super::project(&chosen).0;
    project.choose("second").expect("a main diagram");
    assert_eq!(project.diagrams[project.main.unwrap()].name, "second");
    assert!(project.choose("control").is_err());
    project.diagrams[0].name = "second".to_owned();
    let why = project.choose("second").expect_err("two of them");
    assert!(
        why.in_locale(Locale::English)
            .starts_with("several diagrams here have the name 'second'")
    );
    let none = Project::default().choose("x").expect_err("nothing there");
    assert!(
        none.in_locale(Locale::English)
            .ends_with("none that can be run")
    );
}

#[test]
fn the_diagram_that_is_run_is_the_first_one_of_a_save() {
    let main = |name| diagram(name, DiagramKind::Main, "S Say");
    let mut project = with_ids(made(vec![main("a"), main("b"), main("c")]));
    project.main = Some(1);
    let (read, _) = again(&project);
    let names: Vec<&str> = read.diagrams.iter().map(|one| one.name.as_str()).collect();
    assert_eq!((names, read.main), (vec!["b", "a", "c"], Some(0)));
}

#[test]
fn former_elements_keep_their_meaning() {
    let mut main = diagram(
        "main",
        DiagramKind::Main,
        "A Sensor\nM Motors\nS Say\nA.OUT > M.M3\nM.CF_OUT > S.CF_IN",
    );
    main.blocks[0].element = "SensorVar".to_owned();
    main.blocks[1].element = "Motors".to_owned();
    // M3 was 3 then, and CF_OUT 2.
    main.edges[0].to = Some(End { block: 1, port: 3 });
    main.edges[1].from = Some(End { block: 1, port: 2 });
    let (read, told) = again(&with_ids(made(vec![main])));
    let ports: Vec<_> = read.diagrams[0]
        .edges
        .iter()
        .map(|edge| (edge.from, edge.to))
        .collect();
    let end = |block, port| Some(End { block, port });
    assert_eq!(ports, [(end(0, 1), end(1, 4)), (end(1, 1), end(2, 0))]);
    assert_eq!(told.len(), 2);
    assert!(
        told[1].contains("'Motors' is the name that 'DFMotorsBlock' had before 2016-07-12"),
        "{told:?}"
    );
    let mut fork = diagram(
        "main",
        DiagramKind::Main,
        "V Value generator\nF Text programming\nS Say\nV.OUT > F.I0\nF.O0 > S.CF_IN",
    );
    fork.blocks[1].element = "ForkNode".to_owned();
    fork.edges[0].to = Some(End { block: 1, port: 0 });
    fork.edges[1].from = Some(End { block: 1, port: 1 });
    let (read, _) = again(&with_ids(made(vec![fork])));
    assert_eq!(read.diagrams[0].edges[0].to, end(1, 0));
    assert_eq!(read.diagrams[0].edges[1].from, end(1, 1));
    let checked = crate::check::check(&read);
    assert!(!checked.has_errors());
    let mut machine = crate::machine::Machine::new(std::rc::Rc::new(checked.program));
    let mut robot = lang_diagram::stand_in::StandIn::default();
    machine.step(0, &mut robot, &mut crate::machine::trace::Deaf);
    assert_eq!(machine.errors(), []);
}

/// A program in which a former block draws this shape, as it is read, and what is told of it.
fn painted(shape: &str, block: &str, list: &str, config: bool) -> (Project, Vec<String>) {
    let text = format!(
        "V Value generator {{varValue={list}}}\nP {block}\nS Say\nV.OUT > P.COORDS\nP.CF_OUT > S.CF_IN"
    );
    let mut main = diagram("main", DiagramKind::Main, &text);
    main.blocks[1].element = "ShapePainter".to_owned();
    let properties = &mut main.blocks[1].properties;
    properties.insert("shapeType".to_owned(), shape.to_owned());
    // CF_OUT was 0 then, CONFIG 1, and SHAPE 2.
    let port = if config { 1 } else { 2 };
    main.edges[0].to = Some(End { block: 1, port });
    main.edges[1].from = Some(End { block: 1, port: 0 });
    again(&with_ids(made(vec![main])))
}

#[test]
fn a_former_painter_is_the_block_of_its_shape_or_says_what_to_draw() {
    for (shape, block, list) in [
        ("point", "Draw pixel", "[1, 2]"),
        ("line", "Draw line", "[1, 2, 3, 4]"),
        ("rectangle", "Draw rectangle", "[1, 2, 3, 4]"),
        ("ellipse", "Draw circle", "[1, 2, 3, 4]"),
        ("Arc", "Draw arc", "[1, 2, 3, 4, 5, 6]"),
    ] {
        let (read, told) = painted(shape, block, list, false);
        assert_eq!(
            read.diagrams[0].blocks[1].row.map(|row| row.shown),
            Some(block)
        );
        let is_named = told.iter().any(|told| told.contains("'ShapePainter'"));
        assert!(is_named, "{told:?}");
        let checked = crate::check::check(&read);
        assert!(!checked.has_errors(), "{shape}: {:?}", checked.problems);
        let mut machine = crate::machine::Machine::new(std::rc::Rc::new(checked.program));
        let mut robot = lang_diagram::stand_in::StandIn::default();
        machine.step(0, &mut robot, &mut crate::machine::trace::Deaf);
        assert_eq!(machine.errors(), [], "{shape}");
        // The list has to be as long as that of the shape.
        let (read, _) = painted(shape, block, "[1, 2, 3]", false);
        assert!(crate::check::check(&read).has_errors(), "{shape}");
    }
    // Each is told once, where it is.
    let told_of = |shape: &str, config: bool| {
        let (read, told) = painted(shape, "Draw line", "[1, 2, 3, 4]", config);
        let named = |one: &String| one.contains("had before 2016-07-12");
        assert!(told.iter().all(named), "{told:?}");
        let checked = crate::check::check(&read);
        assert!(checked.has_errors());
        let problems = checked.problems.iter().map(ToString::to_string);
        let problems: Vec<String> = problems.collect();
        assert_eq!(problems.len(), 1, "{problems:?}");
        problems.concat()
    };
    let told = told_of("star", false);
    for part in [
        "main: ShapePainter 'P': ",
        "'ShapePainter'",
        "'star'",
        "line - 'Draw line'",
        "arc - 'Draw arc'",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    let told = told_of("line", true);
    assert!(
        told.contains("the port CONFIG is of an old version"),
        "{told}"
    );
}

#[test]
fn what_an_editor_has_lost_is_counted_and_put_back() {
    let main = diagram("main", DiagramKind::Main, "A Sensor\nS Say\nA.OUT > S.DATA");
    let whole = save(&with_ids(made(vec![main])));
    let mut objects = whole.objects().clone();
    let is_lost = |id: &String| id.contains("/DFSayBlock/") || id.contains("/Edge/");
    for object in objects.iter_mut() {
        object.children.retain(|id| !is_lost(id));
        for (_, ids) in &mut object.lists {
            ids.retain(|id| !is_lost(id));
        }
    }
    let bytes = Save::made(objects, whole.meta().clone()).write();
    let mut opened = read(&bytes.expect("a save")).expect("a project");
    let told = opened.problems[0].to_string();
    assert!(
        told.contains("1 block and 1 link are in the file"),
        "{told}"
    );
    assert!(opened.save.recover_orphans() > 0);
    let (project, problems) = super::project(&opened.save);
    assert!(problems.is_empty(), "{problems:?}");
    let main = &project.diagrams[0];
    assert_eq!((main.blocks.len(), main.edges.len()), (2, 1));
    assert_eq!(main.edges[0].to.map(|end| end.block), Some(1));
}

#[test]
fn strange_saves_are_told_and_kept() {
    let mut main = diagram("main", DiagramKind::Main, "A Sensor\nS Say\nA.OUT > S.DATA");
    main.blocks[1].element = "DFTeleportBlock".to_owned();
    main.edges[0].to = Some(End { block: 1, port: 99 });
    let (read, told) = again(&with_ids(made(vec![main])));
    assert!(told.is_empty());
    assert!(read.diagrams[0].blocks[1].row.is_none());
    assert_eq!(
        read.diagrams[0].edges[0].to,
        Some(End { block: 1, port: 99 })
    );
    let lowered = crate::lower::lower(&read);
    let words: Vec<String> = lowered.problems.iter().map(ToString::to_string).collect();
    assert!(
        words[0].contains("the data-flow language has no block 'DFTeleportBlock'"),
        "{words:?}"
    );
}

#[test]
fn numbers_of_ports_are_rounded_and_nonsense_is_no_port() {
    for (text, port) in [
        ("1", 1),
        ("1.4", 1),
        ("1.5", 2),
        ("0.5", 1),
        ("-0.2", 0),
        ("-1", -1),
        ("", -1),
        ("nan", -1),
        ("1e300", i32::MAX),
        ("-1e300", i32::MIN),
    ] {
        assert_eq!(number(text), port, "{text}");
    }
}

#[test]
fn the_first_main_diagram_says_which_language_runs() {
    let control = lang_diagram::sketch::Sketch::new().qrs().expect("a save");
    let opened = read(&control).expect("a project");
    assert_eq!(language(&opened.save), Language::Diagram);
    let (project, _) = super::project(&opened.save);
    assert!(project.diagrams.is_empty() && project.main.is_none());
}
