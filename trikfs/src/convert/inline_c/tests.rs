//! Compiles with the compiler of the machine; without one the tests that need it say so and pass.

use super::*;
use crate::scratch::Scratch;
use std::cell::RefCell;

const COPY: &str = "int converter(int in_s, char *in, int out_s, char *out) {\n\
    for (int i = 0; i < out_s && i < in_s; i++) out[i] = in[i];\n\
    return 0;\n\
}\n";

fn place() -> Place {
    Place {
        file: "robots/my \"robot\".lua".to_owned(),
        line: 40,
    }
}

fn compiler() -> Option<Compiler> {
    let found = Compiler::find();
    if found.is_none() {
        needs::Need::Tools.missing("no C compiler");
    }
    found
}

fn build(code: &str, scratch: &Scratch) -> Option<Result<PathBuf, Problem>> {
    compiler()?;
    Some(Compiler::compile_with_any(
        code,
        &place(),
        &scratch.cache(),
        &|_| {},
    ))
}

fn script(scratch: &Scratch, name: &str, text: &str) -> Compiler {
    let path = scratch.path(name);
    fs::write(&path, format!("#!/bin/sh\n{text}\n")).expect("written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("executable");
    Compiler::new(path, Vec::new())
}

#[test]
fn code_is_compiled_once_wherever_it_stands() {
    let scratch = Scratch::new();
    let Some(compiler) = compiler() else { return };
    let cache = scratch.cache();
    let said = RefCell::new(Vec::new());
    let build = |place: &Place| {
        let note = |line: &str| said.borrow_mut().push(line.to_owned());
        compile_with(
            &compiler,
            COPY,
            place,
            &cache,
            &note,
            Duration::from_secs(30),
        )
        .expect("compiles")
    };
    let first = build(&place());
    let moved = Place {
        file: "elsewhere.lua".to_owned(),
        line: 7,
    };
    assert_eq!(build(&moved), first);
    assert_eq!(
        *said.borrow(),
        ["compiling inline C at robots/my \"robot\".lua:40"]
    );
    let left: Vec<_> = fs::read_dir(cache.dir())
        .expect("read")
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().starts_with("tmp-"))
        .collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn an_error_has_the_line_of_the_configuration() {
    let scratch = Scratch::new();
    let code = "#include \"trikfs_converter.h\"\nint converter(int a, char *b, int c, char *d) {\n  return oops;\n}\n";
    let Some(result) = build(code, &scratch) else {
        return;
    };
    let problem = result.expect_err("refused");
    assert_eq!(problem.line, 42);
    assert_eq!(problem.file, "robots/my \"robot\".lua");
    assert!(
        problem.reason.starts_with("inline C does not compile:\n"),
        "{problem}"
    );
    assert!(problem.reason.contains("oops"), "{problem}");
    assert!(!problem.reason.contains("tmp-"), "{problem}");
}

#[test]
fn a_misspelt_function_is_an_error_with_a_line() {
    let scratch = Scratch::new();
    let code = "int converter(int a, char *b, int c, char *d)\n{ return memcopy(d, b, a); }\n";
    let Some(result) = build(code, &scratch) else {
        return;
    };
    if compiler().is_some_and(|found| found.tiny) {
        return;
    }
    let problem = result.expect_err("refused");
    assert_eq!(problem.line, 41);
    assert!(problem.reason.contains("memcopy"), "{problem}");
}

#[test]
fn a_device_without_end_as_include_ends_within_the_limits() {
    let scratch = Scratch::new();
    let Some(compiler) = compiler() else { return };
    let code = "#include \"/dev/zero\"\n";
    compile_with(
        &compiler,
        code,
        &place(),
        &scratch.cache(),
        &|_| {},
        Duration::from_secs(5),
    )
    .expect_err("refused");
}

#[test]
fn nonsense_is_refused_and_not_remembered() {
    let scratch = Scratch::new();
    for code in [
        "",
        "\0\0\0",
        "}}}}",
        "#error stop here",
        "#include \"/nonexistent.h\"",
        "\u{1f916}",
    ] {
        let Some(first) = build(code, &scratch) else {
            return;
        };
        // Nothing at all is a valid translation unit: it is the loader that misses the symbol.
        if code.is_empty() || code.starts_with('\0') {
            continue;
        }
        let problem = first.expect_err("refused");
        assert!(problem.line >= 40, "{problem}");
        build(code, &scratch)
            .expect("has a compiler")
            .expect_err("refused again");
    }
}

#[test]
fn a_compiler_that_hangs_is_given_up() {
    let scratch = Scratch::new();
    let compiler = script(&scratch, "slow-cc", "sleep 1000");
    let problem = compile_with(
        &compiler,
        COPY,
        &place(),
        &scratch.cache(),
        &|_| {},
        Duration::from_secs(0),
    )
    .expect_err("refused");
    assert!(
        problem
            .reason
            .ends_with("slow-cc did not finish within 0 seconds"),
        "{problem}"
    );
    assert_eq!(problem.line, 40);
}

#[test]
fn a_compiler_that_fails_in_silence_or_makes_nothing_is_named() {
    let scratch = Scratch::new();
    let cases = [
        ("exit 0", "made no library"),
        ("exit 9", "failed without a word: exit status: 9"),
        ("kill -11 $$", "failed without a word: signal: 11 (SIGSEGV)"),
        ("echo lost; exit 1", "inline C does not compile:\nlost"),
    ];
    for (text, expected) in cases {
        let compiler = script(&scratch, "odd-cc", text);
        let problem = compile_with(
            &compiler,
            COPY,
            &place(),
            &scratch.cache(),
            &|_| {},
            Duration::from_secs(30),
        )
        .expect_err("refused");
        assert!(problem.reason.ends_with(expected), "{problem}");
    }
}

#[test]
fn warnings_are_passed_on() {
    let scratch = Scratch::new();
    let Some(compiler) = compiler() else { return };
    if compiler.tiny {
        return;
    }
    let said = RefCell::new(String::new());
    let code = COPY.replace("return 0;", "int unused; return 0;");
    let note = |line: &str| said.borrow_mut().push_str(line);
    compile_with(
        &compiler,
        &code,
        &place(),
        &scratch.cache(),
        &note,
        Duration::from_secs(30),
    )
    .expect("compiles");
    assert!(said.borrow().contains(":42:"), "{}", said.borrow());
}

#[test]
fn a_cut_library_in_the_cache_is_made_again() {
    let scratch = Scratch::new();
    let Some(Ok(path)) = build(COPY, &scratch) else {
        return;
    };
    fs::write(&path, "").expect("cut");
    build(COPY, &scratch)
        .expect("has a compiler")
        .expect("compiles again");
    assert!(looks_compiled(&path));
}

#[test]
fn the_compiler_is_the_variable_or_the_first_on_the_path() {
    let scratch = Scratch::new();
    let bin = scratch.path("bin");
    fs::create_dir(&bin).expect("created");
    script(&scratch, "bin/clang", "");
    script(&scratch, "bin/tcc", "");
    fs::write(bin.join("gcc"), "not executable").expect("written");
    let path = Some(bin.as_os_str());
    let clang = Compiler::find_in(None, path).expect("found");
    assert_eq!((clang.program, clang.tiny), (bin.join("clang"), false));
    let tiny = Compiler::find_in(Some(" tcc  -m32 -v "), path).expect("found");
    assert_eq!(
        (tiny.arguments.as_slice(), tiny.tiny),
        (["-m32".to_owned(), "-v".to_owned()].as_slice(), true)
    );
    assert_eq!(Compiler::find_in(Some("nothing"), path), None);
    assert_eq!(
        Compiler::find_in(Some(""), Some(OsStr::new("relative:"))),
        None
    );
}

#[test]
fn the_line_of_the_first_error_wins_over_warnings_and_other_files() {
    let said = "x.h:3:1: error: a\nr.lua:8:2: warning: b\nr.lua:9:5: error: c\nr.lua:10: error: d";
    assert_eq!(first_error_line(said, "r.lua"), Some(9));
    assert_eq!(first_error_line("r.lua:8:2: warning: b", "r.lua"), Some(8));
    assert_eq!(first_error_line("r.lua:99999999999: error", "r.lua"), None);
    assert_eq!(first_error_line("r.lua: error\nr.lua:", "r.lua"), None);
}

#[test]
fn a_file_name_cannot_break_out_of_the_line_directive() {
    assert_eq!(c_string("a\"\n\\b"), "a\\\"?\\\\b");
}
