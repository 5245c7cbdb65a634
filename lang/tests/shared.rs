//! Real projects, if they are there: each is read and gives diagrams, blocks and links.

use lang::diagram::read::read;
use std::path::{Path, PathBuf};

fn saves() -> Vec<PathBuf> {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let Ok(folders) = std::fs::read_dir(data) else {
        return Vec::new();
    };
    let mut found: Vec<PathBuf> = folders
        .flat_map(|folder| {
            std::fs::read_dir(folder.unwrap().path())
                .into_iter()
                .flatten()
        })
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "qrs"))
        .collect();
    found.sort();
    found
}

#[test]
fn real_projects_are_read() {
    if saves().is_empty() {
        println!("skipped real_projects_are_read: no ../shared");
        return;
    }
    for path in saves() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let opened = read(&std::fs::read(&path).unwrap())
            .unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
        let project = opened.project;
        assert!(project.main.is_some(), "{name}: no diagram");
        assert!(
            project.world.is_some() || name.starts_with("smile"),
            "{name}: no world"
        );
        let main = &project.diagrams[0];
        assert!(
            main.blocks.iter().any(|block| block.kind == "InitialNode"),
            "{name}"
        );
        let wired = |link: &lang::diagram::project::Link| link.from.is_some() && link.to.is_some();
        assert!(main.links.iter().any(wired), "{name}: nothing is wired");
    }
}
