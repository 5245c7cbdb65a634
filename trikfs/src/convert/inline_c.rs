//! Inline C: source text of a configuration in, a shared library in the cache out.
//!
//! Owns the choice of the compiler, its arguments, and the translation of what it says into a problem at a
//! line of the configuration. Runs it through `command`, which owns the limits. Loads nothing: the
//! library goes to `shared` like any other. Compiled code is native code and trusted as such; the
//! compiler itself is kept within time, memory and output, because `#include "/dev/zero"` is a line of C.

use super::shared::{Cache, CacheError};
use crate::command::{self, Ended, Limits};
use crate::hash::Hash;
use crate::limits;
use config::description::Place;
use config::problem::Problem;

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::Read;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The header that inline C may include as `trikfs_converter.h`.
const HEADER: &str = include_str!("../../../converter/include/trikfs_converter.h");
/// Its name in the cache's include directory.
const HEADER_NAME: &str = "trikfs_converter.h";
/// Raised when the way of compiling changes, so that nothing compiled the old way is found again.
const RECIPE: &[u8] = b"1";

/// The names that are looked for on PATH when `CC` is not set.
const NAMES: [&str; 4] = ["cc", "gcc", "clang", "tcc"];

/// A C compiler of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Compiler {
    program: PathBuf,
    arguments: Vec<String>,
    /// The Tiny C Compiler, which knows fewer options.
    tiny: bool,
}

impl Compiler {
    /// `$CC` (which may hold arguments), else the first of cc, gcc, clang and tcc on PATH.
    pub fn find() -> Option<Self> {
        Self::find_in(
            std::env::var("CC").ok().as_deref(),
            std::env::var_os("PATH").as_deref(),
        )
    }

    /// Compiles the C text `code`, whose first line stands at `place`, to a library in `cache` and gives its path. The
    /// same text compiled by the same compiler is found in the cache, wherever it stands.
    ///
    /// `progress` gets one line before the compiler runs, and its warnings if it succeeds.
    /// Takes 30 seconds at most.
    ///
    /// # Errors
    /// All that the compiler said, at the line of its first error; or what to install if there is no compiler.
    pub fn compile_with_any(
        code: &str,
        place: &Place,
        cache: &Cache,
        progress: &dyn Fn(&str),
    ) -> Result<PathBuf, Problem> {
        let compiler =
            Self::find().ok_or_else(|| Problem::new(&place.file, place.line, no_compiler()))?;
        let limit = Duration::from_secs(limits::COMPILE_SECONDS_MAX.into());
        compile_with(&compiler, code, place, cache, progress, limit)
    }

    fn find_in(cc: Option<&str>, path: Option<&OsStr>) -> Option<Self> {
        let mut words = cc.unwrap_or_default().split_ascii_whitespace();
        if let Some(program) = words.next() {
            return Some(Self::new(
                executable(program, path)?,
                words.map(str::to_owned).collect(),
            ));
        }
        let program = NAMES.iter().find_map(|name| executable(name, path))?;
        Some(Self::new(program, Vec::new()))
    }

    fn new(program: PathBuf, arguments: Vec<String>) -> Self {
        // `cc` may be a link to any of them; what it leads to says which options it knows.
        let real = fs::canonicalize(&program).unwrap_or_else(|_| program.clone());
        let tiny = [&program, &real].iter().any(|path| {
            path.file_name()
                .is_some_and(|name| name.as_encoded_bytes().ends_with(b"tcc"))
        });
        Self {
            program,
            arguments,
            tiny,
        }
    }

    fn flags(&self) -> &'static [&'static str] {
        if self.tiny {
            &["-shared", "-Wall"]
        } else {
            &[
                "-shared",
                "-fPIC",
                "-O2",
                "-std=gnu99",
                "-Wall",
                // Without it a misspelt function is found out at loading, where no line is known.
                "-Werror=implicit-function-declaration",
            ]
        }
    }

    /// What a compiled library depends on besides its source: another compiler, or another version of it.
    fn identity(&self) -> Hash {
        let mut hash = Hash::new().part(self.program.as_os_str().as_encoded_bytes());
        if let Ok(found) = fs::metadata(&self.program) {
            for number in [found.len(), found.mtime().cast_unsigned()] {
                hash = hash.bytes(&number.to_le_bytes());
            }
        }
        for argument in self
            .arguments
            .iter()
            .map(String::as_str)
            .chain(self.flags().iter().copied())
        {
            hash = hash.part(argument.as_bytes());
        }
        hash.part(HEADER.as_bytes()).part(RECIPE)
    }

    fn command(&self, cache: &Cache, source: &Path, output: &Path) -> Command {
        let mut command = command::confined(
            &self.program,
            limits::COMPILE_MEMORY_KB_MAX,
            u32::try_from(limits::LIBRARY_BYTES_MAX >> 10).unwrap_or(u32::MAX),
        );
        command
            .args(&self.arguments)
            .args(self.flags())
            .arg("-I")
            .arg(include_dir(cache))
            .arg("-o")
            .args([output, source])
            .arg("-lm")
            .current_dir(cache.dir())
            // Messages are searched for places, and the sources of this project are ASCII.
            .env("LC_ALL", "C");
        command
    }
}

fn compile_with(
    compiler: &Compiler,
    code: &str,
    place: &Place,
    cache: &Cache,
    progress: &dyn Fn(&str),
    limit: Duration,
) -> Result<PathBuf, Problem> {
    let problem = |line: u32, reason: String| Problem::new(&place.file, line, reason);
    let uncached = |error: CacheError| problem(place.line, error.to_string());
    let name = format!("c-{}.so", compiler.identity().part(code.as_bytes()).hex());
    let ready = cache.path(&name);
    if looks_compiled(&ready) {
        cache.touch(&ready);
        return Ok(ready);
    }
    progress(&format!(
        "compiling inline C at {}:{}",
        place.file, place.line
    ));
    let source = cache.temporary(".c");
    let output = cache.temporary(".so");
    let ended = write_sources(cache, &source, code, place)
        .map_err(uncached)
        .and_then(|()| {
            let limits = Limits {
                groups: None,
                time: limit,
                output_bytes: limits::COMPILE_OUTPUT_BYTES_MAX,
            };
            command::run(compiler.command(cache, &source, &output), &limits).map_err(|error| {
                problem(
                    place.line,
                    format!("c compiler {}: {error}", compiler.program.display()),
                )
            })
        });
    let _ = fs::remove_file(&source);
    let result = ended.and_then(|ended| judge(&ended, compiler, &output, limit, place));
    match result {
        Ok(warnings) => {
            if !warnings.is_empty() {
                progress(&warnings);
            }
            cache.adopt(&output, &name).map_err(uncached)
        }
        Err(refusal) => {
            let _ = fs::remove_file(&output);
            Err(refusal)
        }
    }
}

/// The compiler's warnings, or the problem that it found.
fn judge(
    ended: &Ended,
    compiler: &Compiler,
    output: &Path,
    limit: Duration,
    place: &Place,
) -> Result<String, Problem> {
    let shown = compiler.program.display();
    // tcc takes the name in #line for one beside the source.
    let beside = output.with_file_name("").join(shown_name(&place.file));
    let said = ended
        .output
        .replace(&beside.display().to_string(), &shown_name(&place.file));
    let said = said.trim();
    let Some(status) = ended.status else {
        let reason = format!(
            "c compiler {shown} did not finish within {} seconds",
            limit.as_secs()
        );
        return Err(Problem::new(&place.file, place.line, reason));
    };
    if status.success() && looks_compiled(output) {
        return Ok(said.to_owned());
    }
    let line = first_error_line(said, &place.file).unwrap_or(place.line);
    let reason = match (said, status.success()) {
        ("", true) => format!("c compiler {shown} made no library"),
        ("", false) => format!("c compiler {shown} failed without a word: {status}"),
        _ => format!("inline C does not compile:\n{said}"),
    };
    Err(Problem::new(&place.file, line, reason))
}

/// The include directory with the header, and the source with the line numbers of the configuration.
fn write_sources(
    cache: &Cache,
    source: &Path,
    code: &str,
    place: &Place,
) -> Result<(), CacheError> {
    let dir = include_dir(cache);
    let fail = |error: std::io::Error| CacheError::system(cache.dir(), &error);
    fs::create_dir_all(&dir).map_err(fail)?;
    let header = dir.join(HEADER_NAME);
    if fs::read(&header).map_or(true, |found| found != HEADER.as_bytes()) {
        // Beside the directory first: another compiler may be reading the old one.
        let temporary = cache.temporary(".h");
        fs::write(&temporary, HEADER)
            .and_then(|()| fs::rename(&temporary, &header))
            .map_err(fail)?;
    }
    let text = format!(
        "#line {} \"{}\"\n{code}\n",
        place.line.max(1),
        c_string(&place.file)
    );
    fs::write(source, text).map_err(fail)
}

fn include_dir(cache: &Cache) -> PathBuf {
    cache.path("include")
}

/// A file name as the compiler will show it: bytes that could end a line are replaced.
fn shown_name(file: &str) -> String {
    file.chars()
        .map(|character| {
            if character.is_control() {
                '?'
            } else {
                character
            }
        })
        .collect()
}

/// The same as the contents of a C string literal.
fn c_string(file: &str) -> String {
    shown_name(file).replace('\\', "\\\\").replace('"', "\\\"")
}

/// The line of the first error that the compiler placed in `file`: `file:LINE:` followed by the word error,
/// or the first place in it at all.
fn first_error_line(said: &str, file: &str) -> Option<u32> {
    let prefix = format!("{}:", shown_name(file));
    let places = said.lines().filter_map(|line| {
        let rest = line.strip_prefix(&prefix)?;
        let end = rest.find(|character: char| !character.is_ascii_digit())?;
        let number: u32 = rest.get(..end)?.parse().ok()?;
        Some((number, rest.contains("error")))
    });
    let mut first = None;
    for (line, error) in places {
        if error {
            return Some(line);
        }
        first = first.or(Some(line));
    }
    first
}

/// True for a file that begins like an ELF file: what a power cut left behind does not.
fn looks_compiled(path: &Path) -> bool {
    let mut magic = [0; 4];
    fs::File::open(path)
        .and_then(|mut file| file.read_exact(&mut magic))
        .is_ok()
        && magic == *b"\x7fELF"
}

fn no_compiler() -> String {
    let wanted = match std::env::var("CC") {
        Ok(cc) if !cc.trim().is_empty() => format!("$CC names {}, which is not there", cc.trim()),
        _ => format!("none of {} is on PATH", NAMES.join(", ")),
    };
    format!("inline C needs a C compiler: {wanted}; install gcc, clang or tcc, or set CC")
}

/// The executable that `name` means, as a shell would find it.
fn executable(name: &str, path: Option<&OsStr>) -> Option<PathBuf> {
    let runs = |candidate: &PathBuf| {
        fs::metadata(candidate)
            .is_ok_and(|found| found.is_file() && found.permissions().mode() & 0o111 != 0)
    };
    if name.contains('/') {
        // The compiler runs in the cache directory, so a relative path has to be made absolute here.
        return std::path::absolute(name).ok().filter(runs);
    }
    let path: OsString = path.map_or_else(|| OsString::from("/usr/bin:/bin"), OsStr::to_owned);
    std::env::split_paths(&path)
        .filter(|dir| dir.is_absolute())
        .map(|dir| dir.join(name))
        .find(runs)
}

#[cfg(test)]
mod tests;
