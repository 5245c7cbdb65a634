//! Builds the page by npm, and makes a list of its files for `src/files.rs`.
//!
//! Owns where that happens: a copy of `app` in the target directory, so that nothing is written beside the sources, and what npm
//! fetches is fetched once for all profiles. Without npm the list is empty, and says why.

use std::fmt::{self, Write as _};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What of `app` the page is made of.
const SOURCES: [&str; 10] = [
    "src",
    "public",
    "index.html",
    "licences.js",
    "pack.js",
    "package.json",
    "package-lock.json",
    "svelte.config.js",
    "tsconfig.json",
    "vite.config.js",
];

/// How the list of files begins.
const HEAD: &str = "/// All files of the page.\npub const FILES: &[File] = &[\n";
/// How the list of those begins that only the pages of a class and of marks load.
const OF_CLASS: &str =
    "/// Those of the pages of a class and of marks alone.\npub const OF_CLASS: &[File] = &[\n";
/// How the names of these begin.
const CLASS_NAMES: [&str; 2] = ["assets/Class-", "assets/Marks-"];

/// Why there is no page. The person who builds can mend each.
enum NoPage {
    /// Nobody wants it.
    Unwanted,
    /// A program that is not installed.
    Missing(&'static str),
    /// A program has failed, and what it has said.
    Failed(&'static str, String),
    /// A file that cannot be read or written.
    File(PathBuf, io::Error),
}

impl fmt::Display for NoPage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unwanted => f.write_str("TRIK_WITHOUT_PAGE is set"),
            Self::Missing(name) => write!(
                f,
                "there is no {name}: install nodejs and npm, and build again"
            ),
            Self::Failed(name, said) => write!(f, "{name}: {said}"),
            Self::File(path, error) => write!(f, "{}: {error}", path.display()),
        }
    }
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for name in SOURCES {
        println!("cargo::rerun-if-changed=app/{name}");
    }
    println!("cargo::rerun-if-env-changed=TRIK_WITHOUT_PAGE");
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let list = match build(&out) {
        Ok(list) => list,
        Err(why) => {
            println!(
                "cargo::warning=the page for browsers is left out, and a table is shown: {why}"
            );
            let why = why.to_string();
            format!(
                "{HEAD}];\n{OF_CLASS}];\n/// Why there are none.\npub const WHY_NOT: &str = {why:?};\n"
            )
        }
    };
    fs::write(out.join("files.rs"), list).expect("the directory of cargo can be written");
}

/// The list of files as Rust.
fn build(out: &Path) -> Result<String, NoPage> {
    if std::env::var_os("TRIK_WITHOUT_PAGE").is_some() {
        return Err(NoPage::Unwanted);
    }
    let work = target(out).join("page");
    let file = |error: io::Error| NoPage::File(work.clone(), error);
    fs::create_dir_all(&work).map_err(file)?;
    let lock = fs::File::create(work.join("lock")).map_err(file)?;
    lock.lock().map_err(file)?;
    let stamp = work.join("fetched");
    let wanted = fs::read("app/package-lock.json").map_err(file)?;
    for name in SOURCES {
        let (from, to) = (Path::new("app").join(name), work.join(name));
        if to.is_dir() {
            fs::remove_dir_all(&to).map_err(file)?;
        }
        copy(&from, &to).map_err(|error| NoPage::File(from.clone(), error))?;
    }
    if fs::read(&stamp).ok().as_ref() != Some(&wanted) {
        let _ = fs::remove_file(&stamp);
        let mut npm = Command::new("npm");
        npm.args([
            "ci",
            "--omit=dev",
            "--no-audit",
            "--no-fund",
            "--loglevel=error",
            // Where there is no network, that is known soon.
            "--fetch-retries=1",
            "--fetch-timeout=20000",
        ]);
        run(npm.current_dir(&work), "npm")?;
        fs::write(&stamp, &wanted).map_err(file)?;
    }
    let made = out.join("dist");
    let mut vite = Command::new("node");
    vite.args([
        "node_modules/vite/bin/vite.js",
        "build",
        "--logLevel=error",
        "--emptyOutDir",
        "--outDir",
    ]);
    run(vite.arg(&made).current_dir(&work), "node")?;
    let mut pack = Command::new("node");
    run(pack.arg("pack.js").arg(&made).current_dir(&work), "node")?;
    list(&made).map_err(|error| NoPage::File(made.clone(), error))
}

/// The directory of all profiles, which has a mark of cargo.
fn target(out: &Path) -> &Path {
    let is_target = |path: &&Path| path.join("CACHEDIR.TAG").is_file();
    out.ancestors().find(is_target).unwrap_or(out)
}

fn run(command: &mut Command, name: &'static str) -> Result<(), NoPage> {
    let done = command.output().map_err(|error| {
        if error.kind() == io::ErrorKind::NotFound {
            NoPage::Missing(name)
        } else {
            NoPage::File(PathBuf::from(name), error)
        }
    })?;
    if done.status.success() {
        return Ok(());
    }
    let said = [done.stdout, done.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    let lines = said.lines().filter(|line| !line.trim().is_empty());
    Err(NoPage::Failed(
        name,
        lines.take(12).collect::<Vec<_>>().join(" / "),
    ))
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    if !from.is_dir() {
        fs::copy(from, to)?;
        return Ok(());
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

fn list(made: &Path) -> io::Result<String> {
    let mut found = Vec::new();
    let mut folders = vec![made.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "gz") {
                found.push(path);
            }
        }
    }
    found.sort();
    let (mut text, mut of_class) = (HEAD.to_owned(), OF_CLASS.to_owned());
    for path in found {
        let name = path.strip_prefix(made).unwrap_or(&path).with_extension("");
        let name = name.to_string_lossy();
        let kind = kind(&name);
        let list = match CLASS_NAMES.iter().any(|start| name.starts_with(start)) {
            true => &mut of_class,
            false => &mut text,
        };
        let _ = writeln!(
            list,
            "    File {{ path: {name:?}, kind: {kind:?}, bytes: include_bytes!({path:?}) }},"
        );
    }
    text += "];\n";
    text += &of_class;
    text += "];\n/// Why there are none.\npub const WHY_NOT: &str = \"\";\n";
    Ok(text)
}

fn kind(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "txt" => "text/plain; charset=utf-8",
        "webmanifest" => "application/manifest+json",
        _ => "application/octet-stream",
    }
}
