//! Programs that are run as they are, with the tools of their language: which tree they take, and how threads end.

use std::path::Path;
use std::process::Command;

use lang_diagram::generate::{Language, Options, generate};
use lang_diagram::project::Project;
use lang_diagram::sketch::Sketch;

/// Writes a program and gives the command that runs it.
fn ready(project: &Project, language: Language, folder: &Path) -> Command {
    let path = folder.join(format!("program.{}", language.ending()));
    let text = generate(project, language, Options::default())
        .unwrap()
        .text;
    std::fs::write(&path, text).unwrap();
    if language == Language::Lua {
        let mut command = Command::new("luajit");
        command.arg(path);
        return command;
    }
    let out = folder.join("program");
    let mut cc = Command::new("cc");
    cc.args(["-Wall", "-Werror", "-pthread", "-o"]);
    let built = cc.arg(&out).arg(&path).arg("-lm").output().unwrap();
    let told = String::from_utf8_lossy(&built.stderr);
    assert!(built.status.success(), "{told}");
    Command::new(out)
}

fn in_both(test: &str, check: impl Fn(Language, &Path)) {
    for (language, tool) in [(Language::C, "cc"), (Language::Lua, "luajit")] {
        if needs::tool(tool) {
            let folder = crate::scratch(&format!("{test}-{tool}"));
            check(language, &folder);
            let _ = std::fs::remove_dir_all(&folder);
        }
    }
}

#[test]
fn programs_take_the_tree_that_the_environment_names() {
    let mut sketch = Sketch::new();
    let blocks = [
        sketch.block("InitialNode", &[]),
        sketch.block("TrikV6EnginesForward", &[("Ports", "M3"), ("Power", "70")]),
        sketch.block("FinalNode", &[]),
    ];
    sketch.chain(&blocks);
    let project = sketch.project();
    in_both("tree", |language, folder| {
        let named = folder.join("named");
        let given = folder.join("given");
        for tree in [&named, &given] {
            std::fs::create_dir_all(tree.join("motors/M3")).unwrap();
            std::fs::write(tree.join("motors/M3/value"), "").unwrap();
            std::fs::write(tree.join("stop"), "").unwrap();
        }
        let power = |tree: &Path| std::fs::read_to_string(tree.join("motors/M3/value")).unwrap();
        let mut command = ready(&project, language, folder);
        let status = command.env("TRIK_TREE", &named).status().unwrap();
        assert!(status.success(), "{language:?}");
        assert_eq!(
            (&*power(&named), &*power(&given)),
            ("70", ""),
            "{language:?}"
        );
        std::fs::write(named.join("motors/M3/value"), "").unwrap();
        // What the person says goes before it.
        let status = command.arg(&given).status().unwrap();
        assert!(status.success(), "{language:?}");
        assert_eq!(
            (&*power(&named), &*power(&given)),
            ("", "70"),
            "{language:?}"
        );
    });
}

#[test]
fn a_killed_main_thread_ends_and_others_go_on() {
    let mut sketch = Sketch::new();
    let print = |sketch: &mut Sketch, text: &str| {
        sketch.block("Function", &[("Body", &format!("print('{text}')"))])
    };
    let start = sketch.block("InitialNode", &[]);
    let fork = sketch.block("Fork", &[]);
    let long = sketch.block("Timer", &[("Delay", "100000")]);
    let never = print(&mut sketch, "never");
    let end = sketch.block("FinalNode", &[]);
    let short = sketch.block("Timer", &[("Delay", "20")]);
    let before = print(&mut sketch, "before");
    let kill = sketch.block("KillThread", &[("Thread", "main")]);
    let after = print(&mut sketch, "after");
    let done = sketch.block("FinalNode", &[]);
    sketch.link(start, fork);
    sketch.guarded(fork, long, "main");
    sketch.guarded(fork, short, "other");
    sketch.chain(&[long, never, end]);
    sketch.chain(&[short, before, kill, after, done]);
    let project = sketch.project();
    in_both("killed", |language, folder| {
        // It would wait for 100 seconds otherwise, so the end is what is seen.
        let output = ready(&project, language, folder).output().unwrap();
        let told = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{language:?}");
        assert_eq!(told, "before\nafter\n", "{language:?}");
    });
}
