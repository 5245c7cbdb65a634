//! The expressions of real saves, if they are there: each is read, typed in the order of the save, and printed again.

use lang_diagram::blocks::{Content, find};
use lang_diagram::ports::Kit;
use lang_diagram::read::read;
use lang_expr::words::Stage;
use lang_expr::{Compat, Names, Source, Wanted, analyse};
use std::path::PathBuf;

#[test]
fn expressions_of_real_saves_are_read_and_print_the_same() {
    let Some(data) = needs::data() else {
        return;
    };
    let folders = std::fs::read_dir(data).unwrap();
    let inside = |folder: PathBuf| std::fs::read_dir(folder).into_iter().flatten();
    let paths = folders
        .flat_map(|folder| inside(folder.unwrap().path()))
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "qrs"));
    let (mut texts, mut typed) = (0, 0);
    for path in paths {
        let project = read(&std::fs::read(&path).unwrap()).unwrap().project;
        let mut names = Names::new(Kit::default(), Compat::Studio);
        for block in project.diagrams.iter().flat_map(|diagram| &diagram.blocks) {
            let Some(row) = find(&block.kind) else {
                continue;
            };
            for (property, text) in &block.properties {
                let content = row.property(property).map(|property| property.content);
                let is_evaluated =
                    block.properties.get("Evaluate").map(String::as_str) == Some("true");
                let is_expression = matches!(content, Some(Content::Expression(_)))
                    || content == Some(Content::Evaluated) && is_evaluated;
                if !is_expression {
                    continue;
                }
                let mut source = Source::new(text, Wanted::Any);
                let is_typed = analyse(&mut source, &mut names).is_ok();
                let place = format!("{}: {} {property} {text:?}", path.display(), block.kind);
                for fault in source.faults() {
                    let stage = fault.reason.stage();
                    assert!(matches!(stage, Stage::Semantic), "{place}: {fault:?}");
                }
                let printed = source.tree().to_string();
                let again = Source::new(&printed, Wanted::Any);
                assert_eq!(again.tree().to_string(), printed, "{place}");
                texts += 1;
                typed += usize::from(is_typed);
            }
        }
    }
    assert!(texts > 500, "only {texts} texts");
    println!("{texts} texts, {typed} of them typed in the order of the saves");
    // In the order of the save, names are often used before their values come.
    assert!(typed * 10 > texts * 8, "only {typed} of {texts} have types");
}
