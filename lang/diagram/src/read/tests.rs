//! Saves that are strange, and what is told of them.

use super::*;
use crate::archive::Entry;
use crate::sketch::Sketch;
use lang_text::problem::Locale;

fn entries() -> Vec<Entry> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wait = sketch.block("Timer", &[("Delay", "1")]);
    sketch.link(start, wait);
    let bytes = sketch.qrs().unwrap();
    archive::open(&bytes, &mut Vec::new()).unwrap().entries
}

/// Changes the text of the one file whose name has all parts.
fn change(entries: &mut [Entry], parts: &[&str], change: impl Fn(&str) -> String) {
    let entry = entries
        .iter_mut()
        .find(|entry| !entry.is_folder() && parts.iter().all(|part| entry.name.contains(part)))
        .unwrap();
    let text = String::from_utf8(entry.bytes.clone()).unwrap();
    let changed = change(&text);
    assert_ne!(text, changed, "{}: nothing to change in {text}", entry.name);
    entry.bytes = changed.into_bytes();
}

fn opened(entries: &[Entry]) -> (Project, Vec<String>) {
    let opened = read(&archive::pack(entries).unwrap());
    let opened = opened.unwrap_or_else(|problems| panic!("{problems:?}"));
    let told = opened.problems.iter().map(Problem::to_string).collect();
    (opened.project, told)
}

fn refused(entries: &[Entry]) -> Vec<String> {
    let problems = read(&archive::pack(entries).unwrap()).unwrap_err();
    problems.iter().map(Problem::to_string).collect()
}

#[test]
fn a_save_without_its_root_is_refused() {
    let mut entries = entries();
    entries.retain(|entry| !entry.name.contains("ROOT_ID/ROOT_ID/ROOT_ID/ROOT_ID"));
    assert!(refused(&entries)[0].starts_with("the save has no root object"));
}

#[test]
fn objects_that_are_no_objects_are_refused_by_file_and_all_at_once() {
    let mut entries = entries();
    change(&mut entries, &["logical", "Timer"], |text| {
        text.replace("</object>", "")
    });
    change(&mut entries, &["graphical", "Timer"], |text| {
        text.replace("<object", "<thing")
            .replace("</object>", "</thing>")
    });
    change(&mut entries, &["logical", "InitialNode"], |text| {
        text.replace(
            "qrm:/RobotsMetamodel/RobotsDiagram/InitialNode/{",
            "qrm:/../../{",
        )
    });
    let told = refused(&entries);
    assert_eq!(told.len(), 3, "{told:?}");
    assert!(told.iter().all(|line| line.starts_with("tree/")));
    let has = |part: &str| told.iter().any(|line| line.contains(part));
    assert!(
        has("cut short") && has("not <thing>") && has("has no id"),
        "{told:?}"
    );
}

#[test]
fn a_child_without_a_file_is_told() {
    let mut entries = entries();
    entries.retain(|entry| !(entry.name.contains("graphical") && entry.name.contains("Timer/{")));
    let (project, told) = opened(&entries);
    assert_eq!(project.diagrams[0].blocks.len(), 1);
    assert_eq!(project.diagrams[0].links[0].to, None);
    assert_eq!(
        told,
        [
            "main: Timer: the diagram lists this Timer, but its file is not in the save",
            "main: Link (ControlFlow): it leads to a block (Timer) that is not in the diagram any more: connect it again"
        ]
    );
}

#[test]
fn a_block_without_its_logical_object_has_no_properties() {
    let mut entries = entries();
    entries.retain(|entry| !(entry.name.contains("logical") && entry.name.contains("Timer/{")));
    let (project, told) = opened(&entries);
    assert!(project.diagrams[0].blocks[1].properties.is_empty());
    assert!(
        told[0].starts_with("main: Timer (Timer): its logical object is missing"),
        "{told:?}"
    );
}

#[test]
fn a_link_that_a_block_does_not_list_is_not_seen() {
    let mut entries = entries();
    change(&mut entries, &["graphical", "InitialNode"], |text| {
        let (before, rest) = text.split_once("<links").unwrap();
        let (_, after) = rest.split_once("</links>").unwrap();
        format!("{before}{after}")
    });
    let (project, told) = opened(&entries);
    assert_eq!(project.diagrams[0].blocks[0].outgoing, []);
    assert_eq!(project.diagrams[0].blocks[1].incoming, [0]);
    assert_eq!(
        told,
        [
            "main: Link (ControlFlow): the block InitialNode (InitialNode) does not list this link, so it is as if it were not there: draw it again"
        ]
    );
}

#[test]
fn what_is_listed_twice_is_in_one_diagram() {
    let mut entries = entries();
    change(&mut entries, &["graphical", "RobotsDiagramNode"], |text| {
        let (_, list) = text.split_once("<children>").unwrap();
        let (list, _) = list.split_once("</children>").unwrap();
        text.replace("</children>", &format!("{list}</children>"))
    });
    let (project, told) = opened(&entries);
    assert_eq!(project.diagrams[0].blocks.len(), 2);
    assert_eq!(told.len(), 3);
    assert!(told[0].contains("it is listed twice"));
}

#[test]
fn two_files_with_one_id_are_told() {
    let mut entries = entries();
    let timer = entries
        .iter()
        .find(|entry| entry.name.contains("logical") && entry.name.contains("Timer/{"))
        .unwrap();
    let mut twin = timer.clone();
    twin.name.push('2');
    twin.bytes = String::from_utf8(twin.bytes)
        .unwrap()
        .replace("value=\"1\"", "value=\"2\"")
        .into_bytes();
    entries.push(twin);
    let (project, told) = opened(&entries);
    assert_eq!(project.diagrams[0].blocks[1].properties["Delay"], "1");
    assert!(
        told[0].contains("another object of the save has the same id"),
        "{told:?}"
    );
}

#[test]
fn self_links_and_calls_of_oneself_are_read() {
    let mut sketch = Sketch::new();
    let sheet = sketch.subprogram("again", &[]);
    let start = sketch.block("InitialNode", &[]);
    let call = sketch.call(sheet, &[]);
    sketch.chain(&[start, call]);
    sketch.link(call, call);
    let opened = read(&sketch.qrs().unwrap()).unwrap();
    let diagram = &opened.project.diagrams[1];
    assert_eq!(
        (
            diagram.blocks[1].outgoing.as_slice(),
            diagram.blocks[1].incoming.as_slice()
        ),
        (&[1][..], &[0, 1][..])
    );
    assert_eq!(
        opened
            .project
            .called(diagram.blocks[1].calls.as_deref().unwrap()),
        Some(1)
    );
}

#[test]
fn broken_arguments_are_told_at_the_property() {
    let mut sketch = Sketch::new();
    let sheet = sketch.subprogram("drive", &[("x", "int", "1")]);
    sketch.draw_on(sketch.main());
    sketch.call(sheet, &["2"]);
    let mut entries = archive::open(&sketch.qrs().unwrap(), &mut Vec::new())
        .unwrap()
        .entries;
    change(&mut entries, &["logical", "/Subprogram/"], |text| {
        text.replace("&lt;/properties&gt;", "")
    });
    change(&mut entries, &["logical", "/SubprogramDiagram/"], |text| {
        text.replace("&lt;/labels&gt;", "")
    });
    let (project, told) = opened(&entries);
    assert_eq!(project.diagrams[0].blocks[0].arguments, []);
    assert!(
        told[0]
            .starts_with("main: Subprogram (Subprogram): 'dynamicProperties', 2:1 the text ends"),
        "{told:?}"
    );
    assert!(told[1].contains("'labels'"), "{told:?}");
}

#[test]
fn no_save_tells_more_problems_than_a_person_reads() {
    let mut sketch = Sketch::new();
    for _ in 0..1000 {
        sketch.block("Timer", &[]);
    }
    let mut entries = archive::open(&sketch.qrs().unwrap(), &mut Vec::new())
        .unwrap()
        .entries;
    entries.retain(|entry| !(entry.name.contains("logical") && entry.name.contains("Timer/{")));
    let (_, told) = opened(&entries);
    assert_eq!(told.len(), lang_text::limits::PROBLEMS + 1);
    assert_eq!(
        told[lang_text::limits::PROBLEMS],
        "and at least 800 problems more"
    );
}

#[test]
fn a_flood_of_unknown_tags_keeps_nothing_from_being_read() {
    let mut entries = entries();
    change(&mut entries, &["logical", "InitialNode"], |text| {
        let tags = "<odd/>".repeat(lang_text::limits::PROBLEMS_KEPT * 2);
        text.replace("</properties>", &format!("{tags}</properties>"))
    });
    let (project, told) = opened(&entries);
    assert_eq!(project.diagrams[0].blocks[1].properties["Delay"], "1");
    assert_eq!(told.len(), lang_text::limits::PROBLEMS + 1);
    change(&mut entries, &["graphical", "Timer"], |text| {
        text.replace("</object>", "")
    });
    assert!(refused(&entries)[0].contains("cut short"));
}

#[test]
fn a_link_that_is_named_many_times_is_there_once_and_costs_no_time() {
    let mut sketch = Sketch::new();
    let start = sketch.block("Fork", &[]);
    let end = sketch.block("FinalNode", &[]);
    for _ in 0..2000 {
        sketch.link(start, end);
    }
    let mut entries = archive::open(&sketch.qrs().unwrap(), &mut Vec::new())
        .unwrap()
        .entries;
    change(&mut entries, &["graphical", "Fork"], |text| {
        let (before, rest) = text.split_once("<links type=\"qReal::IdList\">").unwrap();
        let (list, after) = rest.split_once("</links>").unwrap();
        let list = list.repeat(40);
        format!("{before}<links type=\"qReal::IdList\">{list}</links>{after}")
    });
    let (project, _) = opened(&entries);
    let fork = &project.diagrams[0].blocks[0];
    assert_eq!(fork.outgoing, (0..2000).collect::<Vec<_>>());
}

#[test]
fn problems_are_told_in_both_languages() {
    let mut entries = entries();
    entries.retain(|entry| !(entry.name.contains("logical") && entry.name.contains("Timer/{")));
    let opened = read(&archive::pack(&entries).unwrap()).unwrap();
    let russian = opened.problems[0].in_locale(Locale::Russian);
    assert!(
        russian.starts_with("main: Timer (Timer): ") && !russian.is_ascii(),
        "{russian}"
    );
}
