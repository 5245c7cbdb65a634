//! Builds the templates and small C programs with the commands that the documents give. For tests only.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A directory for what is built here, beside the test program and so below the target directory.
fn build_directory(name: &str) -> PathBuf {
    let program = std::env::current_exe().unwrap();
    let directory = program.with_file_name("converter-templates").join(name);
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// The root of this crate.
fn crate_root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Runs a command that must succeed and returns what it printed.
fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// A compiler with every warning an error and the folder of the header; `cc` is `$CC` if that is set, for tests that
/// run on another processor than the compiler.
fn compiler(name: &str) -> Command {
    let mine = std::env::var("CC").ok().filter(|_| name == "cc");
    let mut command = Command::new(mine.as_deref().unwrap_or(name));
    command
        .args(["-O2", "-Wall", "-Wextra", "-Werror", "-pedantic", "-I"])
        .arg(crate_root().join("include"));
    command
}

/// Builds `templates/FOLDER/NAME.c` and returns the library.
pub(crate) fn build_c(folder: &str, name: &str) -> PathBuf {
    let library = build_directory(name).join(format!("lib{name}.so"));
    let source = crate_root().join(format!("templates/{folder}/{name}.c"));
    run(compiler("cc")
        .args(["-std=c99", "-fPIC", "-shared", "-o"])
        .arg(&library)
        .arg(source));
    library
}

/// Builds `templates/rust` and returns the library.
pub(crate) fn build_rust() -> PathBuf {
    let target = build_directory("rust");
    let manifest = crate_root().join("templates/rust/Cargo.toml");
    // In a copy, with this crate instead of the one that `trikfs new-converter` writes beside it.
    let copy = target.join("project");
    fs::create_dir_all(copy.join("src")).unwrap();
    let text = fs::read_to_string(manifest).unwrap();
    let path = format!("path = \"{}\"", crate_root().display());
    fs::write(
        copy.join("Cargo.toml"),
        text.replace("path = \"converter\"", &path),
    )
    .unwrap();
    fs::copy(
        crate_root().join("templates/rust/src/lib.rs"),
        copy.join("src/lib.rs"),
    )
    .unwrap();
    run(Command::new(env!("CARGO"))
        .args([
            "build",
            "--release",
            "--offline",
            "--quiet",
            "--manifest-path",
        ])
        .arg(copy.join("Cargo.toml"))
        .env("CARGO_TARGET_DIR", target.join("target"))
        .env_remove("RUSTFLAGS"));
    target.join("target/release/libbattery_mean.so")
}

/// Compiles a C program and returns what it prints.
pub(crate) fn run_c(name: &str, program: &str) -> String {
    let directory = build_directory(name);
    let (source, binary) = (directory.join("main.c"), directory.join("main"));
    fs::write(&source, program).unwrap();
    run(compiler("cc")
        .arg("-std=c99")
        .arg("-o")
        .arg(&binary)
        .arg(&source));
    run(&mut Command::new(binary))
}

#[test]
fn the_header_compiles_as_c99_and_as_cpp() {
    let program = "#include \"trikfs_converter.h\"\nint main() { return TRIKFS_OK; }\n";
    let directory = build_directory("header");
    for (name, standard, file) in [
        ("cc", "-std=c99", "main.c"),
        ("c++", "-std=c++11", "main.cpp"),
    ] {
        let source = directory.join(file);
        fs::write(
            &source,
            program.replace("main()", if name == "cc" { "main(void)" } else { "main()" }),
        )
        .unwrap();
        if Command::new(name).arg("--version").output().is_err() {
            needs::Need::Tools.missing(format_args!("no {name}"));
            continue;
        }
        run(compiler(name)
            .arg(standard)
            .arg("-fsyntax-only")
            .arg(source));
    }
}
