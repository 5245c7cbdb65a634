//! The languages' own tools have nothing to say about generated programs.

use std::path::Path;
use std::process::Command;

use lang::diagram::generate::{Language, Options, generate};
use lang::problem::Severity;

/// Generates all projects in a language and gives each file to a tool.
fn check(test: &str, language: Language, tool: &[&str]) {
    let last: &[&str] = if tool[0] == "luajit" {
        &["/dev/null"]
    } else {
        &[]
    };
    if !crate::has_tool(test, tool[0]) {
        return;
    }
    let folder = crate::scratch(test);
    let mut complaints = Vec::new();
    let (mut good, mut refused) = (0, Vec::new());
    for (name, project) in crate::projects(test) {
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
