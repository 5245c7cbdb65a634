//! The languages' own tools have nothing to say about generated programs.

use std::path::Path;
use std::process::Command;

use lang_diagram::generate::{Language, Options, generate};
use lang_text::problem::Severity;

/// Generates all projects in a language and gives each file to a tool.
fn check(test: &str, language: Language, tool: &[&str]) {
    let last: &[&str] = if tool[0] == "luajit" {
        &["/dev/null"]
    } else {
        &[]
    };
    if !needs::tool(tool[0]) {
        return;
    }
    let folder = crate::scratch(test);
    let mut complaints = Vec::new();
    let (mut good, mut refused) = (0, Vec::new());
    for (name, project) in crate::projects() {
        let generated = match generate(&project, language, Options::default()) {
            Ok(generated) => generated,
            Err(problems) => {
                assert!(
                    problems
                        .iter()
                        .any(|problem| problem.severity == Severity::Error),
                    "{name}"
                );
                refused.push(format!("{name}: {}", problems[0]));
                continue;
            }
        };
        if let Ok(keep) = std::env::var("KEEP_GENERATED") {
            let kept = Path::new(&keep).join(format!("{name}.{}", language.ending()));
            std::fs::write(kept, &generated.text).unwrap();
        }
        let path = folder.join(format!("program.{}", language.ending()));
        std::fs::write(&path, &generated.text).unwrap();
        let output = Command::new(tool[0])
            .args(&tool[1..])
            .arg(&path)
            .args(last)
            .current_dir(&folder)
            .output()
            .unwrap();
        if output.status.success() && output.stderr.is_empty() {
            good += 1;
        } else {
            complaints.push(format!(
                "{name}: {}",
                String::from_utf8_lossy(&output.stderr)
            ));
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    println!(
        "{}: {good} good, refused:\n{}",
        language.name(),
        refused.join("\n")
    );
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn javascript_is_taken_by_node() {
    check("javascript", Language::JavaScript, &["node", "--check"]);
}

#[test]
fn python_is_compiled() {
    check("python", Language::Python, &["python3", "-m", "py_compile"]);
}

#[test]
fn lua_is_compiled() {
    check("lua", Language::Lua, &["luajit", "-b", "-t", "raw"]);
}

#[test]
fn c_is_compiled_without_warnings() {
    let flags = ["cc", "-Wall", "-Werror", "-pthread", "-fsyntax-only"];
    check("c", Language::C, &flags);
}

/// All at once, because the compiler takes seconds to begin.
#[test]
fn fsharp_is_taken_by_its_compiler() {
    let Some(modules) = std::env::var_os("TRIK_FABLE") else {
        needs::Need::Tools.missing("TRIK_FABLE names no node_modules with fable-standalone");
        return;
    };
    let folder = crate::scratch("fsharp");
    let here = crate::root().join("lang/diagram/tests/generate");
    let mut command = Command::new("node");
    command.arg(here.join("fsharp.cjs"));
    command.arg(modules).arg(here.join("stub.fs"));
    let mut count = 0;
    let hurting = crate::names::projects();
    let each = crate::each::projects();
    let all = crate::projects().into_iter().chain(hurting).chain(each);
    for (at, (_, project)) in all.enumerate() {
        if let Ok(generated) = generate(&project, Language::FSharp, Options::default()) {
            let path = folder.join(format!("{at}.fs"));
            std::fs::write(&path, generated.text).unwrap();
            command.arg(path);
            count += 1;
        }
    }
    let output = command.output().unwrap();
    println!("{count} programs in F#");
    assert!(count > 100, "{count}");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && told.is_empty(), "{told}");
    let _ = std::fs::remove_dir_all(&folder);
}
