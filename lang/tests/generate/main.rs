//! Generated programs: all real projects in all languages, checked by the languages' own tools, and run against the
//! machine.

mod equal;
mod host;
mod syntax;

use std::path::{Path, PathBuf};

use lang::diagram::project::Project;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// All real projects with names; none, and a word of it, where there is no such folder.
fn projects(test: &str) -> Vec<(String, Project)> {
    let data = root().join("../shared/data");
    if !data.is_dir() {
        println!("skipped {test}: no ../shared");
        return Vec::new();
    }
    let mut paths: Vec<PathBuf> = ["course", "examples", "grading", "structure"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(data.join(folder)).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "qrs"))
        .collect();
    paths.sort();
    assert!(paths.len() > 25, "{paths:?}");
    let open = |path: PathBuf| {
        let bytes = std::fs::read(&path).unwrap();
        let opened = lang::diagram::read::read(&bytes).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        (name, opened.project)
    };
    paths.into_iter().map(open).collect()
}

/// A new empty folder for the files of one test.
fn scratch(test: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("lang-{test}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}
