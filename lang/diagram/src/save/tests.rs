//! Saves that are changed and written again.

use super::*;
use crate::archive::{self, Entry};
use crate::read::{Opened, VERSION_KEY, read};
use crate::sketch::Sketch;

fn sketch() -> Sketch {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wait = sketch.block("Timer", &[("Delay", "100")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, wait, end]);
    sketch.world("<root/>");
    sketch
}

fn reopened(save: &Save) -> Opened {
    read(&save.write().unwrap()).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn entries(bytes: &[u8]) -> Vec<Entry> {
    archive::open(bytes, &mut Vec::new()).unwrap().entries
}

#[test]
fn a_save_that_was_not_changed_is_written_as_it_came() {
    let bytes = sketch().qrs().unwrap();
    let opened = read(&bytes).unwrap();
    assert_eq!(opened.problems, []);
    assert_eq!(opened.save.write().unwrap(), bytes);
}

#[test]
fn what_is_not_understood_stays_when_something_else_changes() {
    let mut entries = entries(&sketch().qrs().unwrap());
    let timer = entries
        .iter_mut()
        .find(|entry| {
            entry.name.starts_with("tree/logical")
                && entry.name.contains("/Timer/")
                && !entry.is_folder()
        })
        .unwrap();
    let name = timer.name.clone();
    let text = String::from_utf8(timer.bytes.clone()).unwrap();
    let text = text
        .replace("<object ", "<object color=\"red\" ")
        .replace("</properties>", "<QStrange key=\"odd\" value=\"1\"/><QString key=\"z\" value=\"1\" by=\"me\"/></properties><more a=\"1\"/>");
    timer.bytes = text.into_bytes();
    entries.push(Entry {
        name: "notes/".to_owned(),
        bytes: Vec::new(),
    });
    entries.push(Entry {
        name: "notes/teacher.txt".to_owned(),
        bytes: vec![0xff, 0, 1],
    });
    let mut opened = read(&archive::pack(&entries).unwrap()).unwrap();
    let told: Vec<String> = opened.problems.iter().map(Problem::to_string).collect();
    assert_eq!(
        told,
        [
            "Timer: the tag <QStrange> is not known and was left out",
            "Timer: the tag <more> is not known and was left out"
        ]
    );
    let id = opened.project.diagrams[0].blocks[1].id.clone();
    opened
        .save
        .set_property(&id, "Delay", "a < \"b\" && c\n")
        .unwrap();
    let written = self::entries(&opened.save.write().unwrap());
    for (old, new) in entries.iter().zip(&written) {
        assert_eq!(old.name, new.name);
        if old.name != name {
            assert_eq!(old.bytes, new.bytes, "{}", old.name);
        }
    }
    let text = written.iter().find(|entry| entry.name == name).unwrap();
    let text = String::from_utf8(text.bytes.clone()).unwrap();
    for kept in [
        "color=\"red\"",
        "<QStrange key=\"odd\" value=\"1\"/>",
        "by=\"me\"",
        "<more a=\"1\"/>",
    ] {
        assert!(text.contains(kept), "{kept}: {text}");
    }
    let again = reopened(&opened.save).project;
    assert_eq!(
        again.diagrams[0].blocks[1].properties["Delay"],
        "a < \"b\" && c\n"
    );
}

#[test]
fn the_world_of_an_old_save_gets_a_file_of_its_own() {
    let mut old = entries(&sketch().qrs().unwrap());
    old.retain(|entry| entry.name != "worldModel.xml");
    let meta = old
        .iter_mut()
        .find(|entry| entry.name == "metaInfo.xml")
        .unwrap();
    meta.bytes = b"<metaInformation>\n    <info key=\"worldModel\" value=\"&lt;root/>\" type=\"QString\"/>\n    <info key=\"RobotsMetamodelVersion\" value=\"2022.2.0\" type=\"QString\"/>\n    <info key=\"twoDModelWorldReadOnly\" value=\"true\" type=\"bool\"/>\n</metaInformation>\n".to_vec();
    let mut opened = read(&archive::pack(&old).unwrap()).unwrap();
    assert_eq!(opened.project.world.as_deref(), Some("<root/>"));
    opened.save.set_world("<root><world/></root>").unwrap();
    let written = entries(&opened.save.write().unwrap());
    let text = |name: &str| {
        let entry = written.iter().find(|entry| entry.name == name).unwrap();
        String::from_utf8(entry.bytes.clone()).unwrap()
    };
    assert_eq!(text("worldModel.xml"), "<root><world/></root>");
    assert_eq!(
        text("metaInfo.xml"),
        "<metaInformation>\n    <info key=\"RobotsMetamodelVersion\" value=\"2024.1.0\" type=\"QString\"/>\n    <info key=\"twoDModelWorldReadOnly\" value=\"true\" type=\"bool\"/>\n</metaInformation>\n"
    );
    let again = reopened(&opened.save).project;
    assert_eq!(again.world.as_deref(), Some("<root><world/></root>"));
}

#[test]
fn a_converted_save_is_written_as_of_today_once_it_is_changed() {
    let mut sketch = sketch();
    let print = sketch.block("PrintText", &[("PrintText", "x")]);
    let call = sketch.block("FiBlock", &[]);
    sketch.link(print, call);
    sketch.meta(VERSION_KEY, "2020.4.0");
    let bytes = sketch.qrs().unwrap();
    let mut opened = read(&bytes).unwrap();
    assert_eq!(
        opened.save.write().unwrap(),
        bytes,
        "unchanged it stays old"
    );
    opened.save.set_meta("exerciseId", Some("{1}")).unwrap();
    let written = opened.save.write().unwrap();
    let names: Vec<String> = entries(&written)
        .into_iter()
        .map(|entry| entry.name)
        .collect();
    let files = |part: &str| {
        names
            .iter()
            .filter(|name| name.contains(part) && !name.ends_with('/'))
            .count()
    };
    assert_eq!((files("/PrintText/"), files("/TrikPrintText/")), (0, 2));
    let again = read(&written).unwrap();
    assert_eq!(again.problems, []);
    assert_eq!(again.project.diagrams, opened.project.diagrams);
    assert_eq!(again.project.meta["exerciseId"], "{1}");
    assert_eq!(again.project.meta[VERSION_KEY], "2024.1.0");
}

#[test]
fn keys_and_programs_are_set_and_taken_away() {
    let mut save = read(&sketch().qrs().unwrap()).unwrap().save;
    save.set_code("brick.stop()\n", "py").unwrap();
    save.set_meta("twoDModelWorldReadOnly", Some("true"))
        .unwrap();
    let again = reopened(&save);
    assert_eq!(again.project.meta["activeCode"], "brick.stop()\n");
    assert_eq!(again.project.meta["activeCodeLanguageExtension"], "py");
    let mut save = again.save;
    save.set_meta("activeCode", None).unwrap();
    let again = reopened(&save).project;
    assert!(!again.meta.contains_key("activeCode"));
    assert_eq!(again.meta["twoDModelWorldReadOnly"], "true");
}

#[test]
fn changes_that_no_save_can_carry_are_refused() {
    let mut save = read(&sketch().qrs().unwrap()).unwrap().save;
    let world = save.set_world("<root>").unwrap_err().to_string();
    assert!(
        world.starts_with("worldModel.xml: 1:7 the text ends"),
        "{world}"
    );
    let text = save
        .set_meta("activeCode", Some("\u{1}"))
        .unwrap_err()
        .to_string();
    assert!(
        text.starts_with("the text has the control character 1"),
        "{text}"
    );
    let id = "qrm:/RobotsMetamodel/RobotsDiagram/Timer/{no}";
    let block = save.set_property(id, "Delay", "1").unwrap_err().to_string();
    assert_eq!(block, "Timer: there is no such block or link in the save");
}

/// A save in which a block and its links were deleted as old editors did it.
fn with_orphans() -> Vec<u8> {
    let bytes = sketch().qrs().unwrap();
    let mut opened = read(&bytes).unwrap();
    let diagram = opened.project.diagrams[0].clone();
    let mut gone: Vec<String> = diagram.links.iter().map(|link| link.id.clone()).collect();
    gone.push(diagram.blocks[1].id.clone());
    let blocks = [
        diagram.id.clone(),
        diagram.blocks[0].id.clone(),
        diagram.blocks[2].id.clone(),
    ];
    for id in blocks {
        let object = opened.save.objects.get_mut(&id).unwrap();
        object.children.retain(|child| !gone.contains(child));
        object.list_mut("links").clear();
    }
    opened.save.is_edited = true;
    opened.save.write().unwrap()
}

#[test]
fn orphans_are_told_and_not_run() {
    let opened = read(&with_orphans()).unwrap();
    assert_eq!(opened.project.diagrams[0].blocks.len(), 2);
    assert_eq!(opened.problems.len(), 1);
    let told = opened.problems[0].to_string();
    assert!(
        told.contains("1 block and 2 links are in the file but on no sheet"),
        "{told}"
    );
    let kinds: Vec<String> = opened
        .save
        .orphans()
        .into_iter()
        .map(|orphan| orphan.kind)
        .collect();
    assert_eq!(kinds, ["ControlFlow", "ControlFlow", "Timer"]);
}

#[test]
fn orphans_are_recovered_with_their_wiring() {
    let mut opened = read(&with_orphans()).unwrap();
    // Three objects, and two links at the two blocks that forgot them.
    assert_eq!(opened.save.recover_orphans(), 5);
    assert_eq!(opened.save.recover_orphans(), 0);
    let again = reopened(&opened.save);
    assert_eq!(again.problems, []);
    let diagram = &again.project.diagrams[0];
    let timer = diagram
        .blocks
        .iter()
        .position(|block| block.kind == "Timer")
        .unwrap();
    assert_eq!(diagram.blocks[timer].properties["Delay"], "100");
    assert_eq!(diagram.blocks[timer].outgoing.len(), 1);
    let next = diagram.links[diagram.blocks[0].outgoing[0]].to;
    assert_eq!(next, Some(timer));
}

#[test]
fn orphans_are_removed_with_all_their_traces() {
    let bytes = with_orphans();
    let mut opened = read(&bytes).unwrap();
    assert_eq!(opened.save.remove_orphans(), 6);
    let written = opened.save.write().unwrap();
    let again = read(&written).unwrap();
    assert_eq!(again.problems, []);
    assert_eq!(again.project, opened.project);
    assert!(
        entries(&written)
            .iter()
            .all(|entry| !entry.name.contains("Timer/{"))
    );
}
