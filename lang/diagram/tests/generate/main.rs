//! Generated programs: all real projects in all languages, checked by the languages' own tools, and run against the
//! machine.

mod drawn;
mod each;
mod equal;
mod host;
mod names;
mod running;
mod syntax;
mod timers;

use std::path::{Path, PathBuf};

use lang_diagram::project::Project;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// All real projects with names; none, and a skip, if they are not there.
fn projects() -> Vec<(String, Project)> {
    let Some(data) = needs::data() else {
        return Vec::new();
    };
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
        let opened = lang_diagram::read::read(&bytes).unwrap();
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

/// Examples of the document, by the words after their fence.
fn example(mark: &str) -> String {
    let text = std::fs::read_to_string(root().join("docs/user/generators.md")).unwrap();
    let start = format!("```{mark}\n");
    let (_, rest) = text.split_once(&start).unwrap();
    rest.split_once("```").unwrap().0.to_owned()
}

#[test]
fn the_document_shows_what_is_generated() {
    use lang_diagram::generate::{Language, Options, generate};
    use lang_diagram::sketch::Sketch;

    let mut sketch = Sketch::new();
    let wait = [("Port", "D1"), ("Distance", "20"), ("Sign", "less")];
    let blocks = [
        sketch.block("InitialNode", &[]),
        sketch.block("TrikV6EnginesForward", &[("Ports", "M3"), ("Power", "70")]),
        sketch.block("TrikWaitForSonarDistance", &wait),
        sketch.block("TrikV6EnginesStop", &[("Ports", "M3")]),
        sketch.block("FinalNode", &[]),
    ];
    sketch.chain(&blocks);
    let text = generate(&sketch.project(), Language::JavaScript, Options::default());
    let text = text.unwrap().text;
    let lines: String = example("js generated")
        .lines()
        .map(|line| format!("    {line}\n"))
        .collect();
    assert!(text.contains(&lines), "{text}");

    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let go = sketch.block("TrikV6EnginesForward", &[("Ports", "M3"), ("Power", "70")]);
    let repeat = sketch.block("Loop", &[("Iterations", "3")]);
    let timer = sketch.block("Timer", &[("Delay", "1000")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, go, repeat, end]);
    sketch.guarded(repeat, timer, "iteration");
    sketch.link(timer, repeat);
    let outline = lang_diagram::show::outline::outline(&sketch.project(), Default::default());
    assert_eq!(outline.unwrap(), example("text outline"));
}

#[test]
fn all_real_projects_have_pictures_and_outlines() {
    use lang_diagram::show::{outline::outline, picture::picture};
    use lang_text::problem::Locale;

    for (name, project) in projects() {
        for locale in [Locale::English, Locale::Russian] {
            for diagram in &project.diagrams {
                let svg = picture(diagram, locale);
                let blocks = svg.matches("<rect x=\"-25\"").count();
                assert_eq!(blocks, diagram.blocks.len(), "{name}");
                if let Ok(keep) = std::env::var("KEEP_GENERATED") {
                    let kept = Path::new(&keep).join(format!("{name}.svg"));
                    std::fs::write(kept, &svg).unwrap();
                }
            }
            let text = outline(&project, locale)
                .unwrap_or_else(|problems| panic!("{name}: {}", problems[0]));
            assert!(text.lines().count() > 1, "{name}: {text}");
        }
    }
}
