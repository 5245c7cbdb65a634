//! Tests of loading: programs that fail, never end, take all memory or try to get out.

use super::*;
use converter::Direction;
use std::fs;
use std::time::{Duration, Instant};
use tempfile::TempDir;

fn load(source: &str) -> Result<Loaded, Problem> {
    Loader::default().load("robot.lua", None, source.as_bytes())
}

fn refused(source: &str) -> String {
    load(source).unwrap_err().to_string()
}

/// A folder of this test, removed with the value.
struct Folder(TempDir);

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (file, text) in files {
            fs::write(folder.path().join(file), text).unwrap();
        }
        Self(folder)
    }

    fn load(&self, source: &str) -> Result<Loaded, Problem> {
        let loader = Loader {
            include_dirs: vec![self.0.path().to_owned()],
            ..Loader::default()
        };
        loader.load("robot.lua", Some(self.0.path()), source.as_bytes())
    }
}

#[test]
fn a_program_that_is_none_is_refused_with_its_line() {
    assert_eq!(
        refused("trikfs = {\n x = }"),
        "robot.lua:2: unexpected symbol near '}'"
    );
    assert_eq!(refused("x = 1\nerror('no board')"), "robot.lua:2: no board");
    assert_eq!(
        refused("local x = nil\n\nx.y = 1"),
        "robot.lua:3: attempt to index local 'x' (a nil value)"
    );
    assert_eq!(
        refused("error({})"),
        "robot.lua:1: the error is not a text but a table"
    );
    assert_eq!(
        refused("\u{1b}LJ"),
        "robot.lua:1: bytecode is not loaded, only text"
    );
    assert_eq!(
        refused("x = 1\n\0"),
        "robot.lua:2: the file contains a zero byte and is no text"
    );
    let junk = Loader::default()
        .load("robot.lua", None, &[0xff; 64])
        .unwrap_err()
        .to_string();
    assert_eq!(junk, "robot.lua:1: '=' expected near '<eof>'");
    let large = vec![b' '; CONFIG_BYTES_MAX + 1];
    let large = Loader::default()
        .load("robot.lua", None, &large)
        .unwrap_err()
        .to_string();
    assert_eq!(
        large,
        "robot.lua: the configuration has more than 1048576 bytes"
    );
}

#[test]
fn a_program_without_the_table_is_refused() {
    assert_eq!(
        refused(""),
        "robot.lua:1: the program must leave a global table 'trikfs'"
    );
    assert_eq!(
        refused("local trikfs = {}"),
        "robot.lua:1: the program must leave a global table 'trikfs'"
    );
    assert_eq!(
        refused("\ntrikfs = 5"),
        "robot.lua:2: 'trikfs' must be a table, not a number"
    );
    assert_eq!(
        refused("trikfs = print"),
        "robot.lua:1: 'trikfs' must be a table, not a function"
    );
    assert!(load("trikfs = {}").unwrap().config.nodes.is_empty());
}

#[test]
fn programs_without_end_or_bound_are_ended() {
    let within = |source: &str| {
        let start = Instant::now();
        let problem = Loader::default()
            .load_within("robot.lua", None, source.as_bytes(), 50, 4 << 20)
            .unwrap_err();
        assert!(start.elapsed() < Duration::from_secs(20));
        problem.to_string()
    };
    assert_eq!(
        within("x = 1\nwhile true do end"),
        "robot.lua:2: time budget spent (50000 us)"
    );
    assert_eq!(
        within("while true do pcall(error) end"),
        "robot.lua:1: time budget spent (50000 us)"
    );
    assert_eq!(
        within("local s = ('x'):rep(1e7) trikfs = { [s] = s }"),
        "robot.lua:1: not enough memory"
    );
    assert_eq!(
        refused("local s = ('x'):rep(1e9)"),
        "robot.lua:1: a string of 1000000000 bytes is too long"
    );
    assert_eq!(
        refused("local s = 'x' while true do s = s .. s end"),
        "robot.lua:1: not enough memory"
    );
    assert_eq!(
        refused("local function f() return 1 + f() end f()"),
        "robot.lua:1: stack overflow"
    );
    assert!(load("local function f(n) if n > 0 then return 1 + f(n - 1) end return 0 end f(10000) trikfs = {}").is_ok());
}

#[test]
fn tables_that_are_no_tree_are_refused() {
    assert_eq!(
        refused("trikfs = {}\ntrikfs.x = { y = trikfs }"),
        "robot.lua:2: x/y: the table holds itself"
    );
    let deep = "trikfs = {} local t = trikfs for i = 1, 100 do t.n = {} t = t.n end";
    assert!(
        refused(deep).ends_with("tables are nested too deeply"),
        "{}",
        refused(deep)
    );
    let deep = "local t = { src = '/dev/x', input_tuple_size = 1 } for i = 1, 18 do t = { g = t } end trikfs = t";
    assert!(
        refused(deep).ends_with(": groups are nested more than 16 deep"),
        "{}",
        refused(deep)
    );
    let shared = "local t = {} for i = 1, 18 do t = { t, t } end trikfs = t";
    assert!(
        refused(shared).ends_with("the configuration has too many values"),
        "{}",
        refused(shared)
    );
    let many = "trikfs = {} for i = 1, 5000 do trikfs['n' .. i] = { src = '/dev/x', input_tuple_size = 1 } end";
    assert!(
        refused(many).ends_with(": more than 4096 nodes and attributes"),
        "{}",
        refused(many)
    );
}

#[test]
fn all_nodes_of_a_program_are_found() {
    let loaded = load(
        "trikfs = {\n random = { src = '/dev/urandom', input_tuple_size = 3, output_tuple_size = 3,\n  converter = function() end },\n\
         motors = { M1 = { src = '/dev/m1', input_tuple_size = 2,\n  attributes = { speed = { src = '/dev/s1', format = 'i16 v' } } } } }",
    )
    .unwrap();
    let paths: Vec<&str> = loaded
        .config
        .nodes
        .iter()
        .map(|node| node.path.as_str())
        .collect();
    assert_eq!(paths, ["motors/M1", "random"]);
    assert_eq!(loaded.config.nodes[0].attributes[0].path, "motors/M1/speed");
    assert_eq!(loaded.config.nodes[0].place.to_string(), "robot.lua:4");
    assert_eq!(
        loaded.config.nodes[1].converter[0].place.to_string(),
        "robot.lua:3"
    );
    assert!(loaded.config.nodes[1].uses_lua() && !loaded.config.nodes[0].uses_lua());
}

#[test]
fn an_included_file_is_part_of_the_program() {
    let folder = Folder::new(&[
        (
            "board.lua",
            "function port(n)\n return { src = '/dev/port' .. n, input_tuple_size = 1, output_tuple_size = 1,\n converter = function(_, a, _, b) ba.set(b, 0, n) end } end return 7",
        ),
        ("bad.lua", "x = 1\ny = = 2"),
        ("fails.lua", "\nerror('no port')"),
        ("self.lua", "include 'self' x = 1"),
        ("zero.lua", "x = 1 \0"),
    ]);
    let loaded = folder
        .load("assert(include 'board' == 7) include('board.lua')\ntrikfs = { a = port(5) }")
        .unwrap();
    assert_eq!(
        loaded.config.nodes[0].converter[0].place.to_string(),
        "board.lua:3"
    );
    let mut vm = loaded.program.open("a").unwrap();
    let stage = vm.bind("a", Direction::Read, 0, 1, 1).unwrap();
    let mut output = [0];
    vm.convert(stage, &[0], &mut output).unwrap();
    assert_eq!(output, [5]);
    let refused = |source: &str| folder.load(source).unwrap_err().to_string();
    assert_eq!(
        refused("\ninclude 'bad'"),
        "bad.lua:2: unexpected symbol near '=' (included at robot.lua:2)"
    );
    assert_eq!(refused("include 'fails'"), "fails.lua:2: no port");
    assert!(
        refused("include 'self'").ends_with("stack overflow"),
        "{}",
        refused("include 'self'")
    );
    assert_eq!(
        refused("include 'zero'"),
        "zero.lua:1: the file contains a zero byte and is no text (included at robot.lua:1)"
    );
    assert_eq!(
        refused("\ninclude '../x'"),
        "robot.lua:2: '../x' leads outside the search path"
    );
    assert_eq!(
        refused("include '/etc/passwd'"),
        "robot.lua:1: '/etc/passwd' leads outside the search path"
    );
    assert_eq!(
        refused("include(5)"),
        "robot.lua:1: include wants the name of a file"
    );
    assert!(refused("include 'none'").starts_with("robot.lua:1: 'none' was not found in /"));
}

#[test]
fn too_many_included_files_are_refused() {
    let names: Vec<String> = (0..70).map(|i| format!("f{i}.lua")).collect();
    let files: Vec<(&str, &str)> = names
        .iter()
        .map(|name| (name.as_str(), "return 1"))
        .collect();
    let folder = Folder::new(&files);
    let error = folder
        .load("for i = 0, 69 do include('f' .. i) end")
        .unwrap_err()
        .to_string();
    assert_eq!(error, "robot.lua:1: more than 64 files are included");
    assert!(
        folder
            .load("for i = 1, 1000 do include 'f1' end trikfs = {}")
            .is_ok()
    );
}

#[test]
fn the_program_runs_again_with_the_files_of_the_load() {
    let folder = Folder::new(&[("n.lua", "return 1")]);
    let source = "local n = include 'n' trikfs = { x = { src = '/dev/x', input_tuple_size = 1, output_tuple_size = 1,
        converter = function(_, a, _, b) ba.set(b, 0, n) end } }";
    let loaded = folder.load(source).unwrap();
    fs::write(folder.0.path().join("n.lua"), "return 2").unwrap();
    let mut vm = loaded.program.open("x").unwrap();
    let stage = vm.bind("x", Direction::Read, 0, 1, 1).unwrap();
    let mut output = [0];
    vm.convert(stage, &[0], &mut output).unwrap();
    assert_eq!(output, [1]);
    let reloaded = folder.load(source).unwrap();
    assert_ne!(
        reloaded.config.nodes[0].fingerprint,
        loaded.config.nodes[0].fingerprint
    );
}

#[test]
fn the_log_of_the_first_run_is_kept_and_later_runs_are_silent() {
    let loaded = load("trikfs_log('hello', 5) print(nil) trikfs = {}").unwrap();
    assert_eq!(loaded.log, ["hello\t5", "nil"]);
    let loaded = load("for i = 1, 5000 do print(i) end trikfs = {}").unwrap();
    assert_eq!(loaded.log.len(), 1000);
    loaded.program.run_anew().unwrap();
}

fn fingerprint(source: &str) -> u128 {
    load(source).unwrap().config.nodes[0].fingerprint
}

const NODE: &str = "src = '/dev/x', input_tuple_size = 1, output_tuple_size = 1";

#[test]
fn a_fingerprint_changes_with_everything_that_the_converter_does() {
    let base = fingerprint(&format!(
        "trikfs = {{ x = {{ {NODE}, converter = function(n, a, m, b) ba.set(b, 0, 1) end }} }}"
    ));
    let same = [
        format!(
            "-- moved\n\n trikfs = {{ y = {{ src = '/z', input_tuple_size = 1 }}, x = {{ {NODE},\n\n converter = function(n, a, m, b)\n ba.set(b, 0, 1) end }} }}"
        ),
        format!(
            "local t = {{}} t.x = {{ {NODE}, converter = function(one, two, three, four) ba.set(four, 0, 1) end }} trikfs = t unused = 5"
        ),
    ];
    for source in &same {
        assert_eq!(fingerprint(source), base, "{source}");
    }
    let other = [
        format!(
            "trikfs = {{ x = {{ {NODE}, converter = function(n, a, m, b) ba.set(b, 0, 2) end }} }}"
        ),
        format!(
            "trikfs = {{ x = {{ {NODE}, poll_ms = 5, converter = function(n, a, m, b) ba.set(b, 0, 1) end }} }}"
        ),
        format!(
            "trikfs = {{ x = {{ {NODE}, mode = 0600, converter = function(n, a, m, b) ba.set(b, 0, 1) end }} }}"
        ),
        format!(
            "trikfs = {{ x = {{ {NODE}, params = {{ k = 1 }}, converter = function(n, a, m, b) ba.set(b, 0, 1) end }} }}"
        ),
        format!("trikfs = {{ x = {{ {NODE} }} }}"),
    ];
    for source in &other {
        assert_ne!(fingerprint(source), base, "{source}");
    }
}

#[test]
fn a_fingerprint_sees_upvalues_tables_and_globals() {
    let pairs = [
        (
            "local k = 1 trikfs = { x = { NODE, converter = function() return k end } }",
            "k = 1",
            "k = 2",
        ),
        (
            "local t = { a = { 1, 2 }, b = 3 } trikfs = { x = { NODE, converter = function() return t end } }",
            "1, 2",
            "1, 3",
        ),
        (
            "local function h() return 1 end trikfs = { x = { NODE, converter = function() return h() end } }",
            "return 1",
            "return 2",
        ),
        (
            "function h() return 1 end trikfs = { x = { NODE, converter = function() return h() end } }",
            "return 1",
            "return 2",
        ),
        (
            "k = 1 function h() return k end trikfs = { x = { NODE, converter = function() return function() return h() end end } }",
            "k = 1",
            "k = 2",
        ),
        (
            "local t = {} t.t = t t.k = 1 trikfs = { x = { NODE, converter = function() return t end } }",
            "k = 1",
            "k = 2",
        ),
        (
            "local f = math.floor trikfs = { x = { NODE, converter = function() return f(1.5) end } }",
            "math.floor",
            "math.ceil",
        ),
        (
            "local m = setmetatable({}, { __index = { k = 1 } }) trikfs = { x = { NODE, converter = function() return m.k end } }",
            "k = 1",
            "k = 2",
        ),
        (
            "trikfs = { x = { NODE, converter = id_create(1) } }",
            "id_create(1)",
            "id_create(0)",
        ),
        (
            "print = function() return 1 end trikfs = { x = { NODE, converter = function() print() end } }",
            "return 1",
            "return 2",
        ),
    ];
    for (source, old, new) in pairs {
        let source = source.replace("NODE", NODE);
        assert_eq!(fingerprint(&source), fingerprint(&source), "{source}");
        assert_ne!(
            fingerprint(&source),
            fingerprint(&source.replace(old, new)),
            "{source}"
        );
    }
}

#[test]
fn a_fingerprint_does_not_see_what_the_converter_cannot_reach() {
    let one = format!(
        "local x = ba.i16 trikfs = {{ x = {{ {NODE}, converter = function(_, a) return ba.get(a, 0) end }} }}"
    );
    let two = format!(
        "k = 5 trikfs = {{ x = {{ {NODE}, converter = function(_, a) return ba.get(a, 0) end }} }} local m = math"
    );
    assert_eq!(fingerprint(&one), fingerprint(&two));
}

#[test]
fn a_fingerprint_of_very_much_depends_on_the_text() {
    let source = format!(
        "local t = {{}} for i = 1, 200000 do t[i] = ('x'):rep(30) .. i end trikfs = {{ x = {{ {NODE}, memory_kb = 65536, converter = function() return t end }} }}"
    );
    assert_eq!(fingerprint(&source), fingerprint(&source));
    assert_ne!(fingerprint(&source), fingerprint(&format!("{source} ")));
    let long = format!(
        "local t for i = 1, 50000 do t = {{ t }} end trikfs = {{ x = {{ {NODE}, memory_kb = 65536, converter = function() return t end }} }}"
    );
    assert_eq!(fingerprint(&long), fingerprint(&long));
}

#[test]
fn a_program_that_leaves_its_converters_no_memory_is_refused() {
    let source = format!(
        "local held = {{}} for i = 1, 1e5 do held[i] = {{ i }} end trikfs = {{ x = {{ {NODE}, converter = function() return held end }} }}"
    );
    let reason = load(&source).unwrap_err().reason;
    assert!(
        reason.starts_with("node x: what its converters hold takes ")
            && reason
                .ends_with(" KiB in each open file's lua state, memory_kb = 1024 leaves no room"),
        "{reason}"
    );
    let garbage = format!(
        "for i = 1, 1e5 do local t = {{ i }} end trikfs = {{ x = {{ {NODE}, converter = function() end }} }}"
    );
    assert!(load(&garbage).is_ok());
}

#[test]
fn a_global_that_nobody_defined_is_a_warning_at_its_line() {
    let loaded = load(&format!(
        "trikfs = {{\n x = {{ {NODE},\n converter = my_convrter }} }}"
    ))
    .unwrap();
    let warnings: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        warnings,
        ["robot.lua:3: there is no global 'my_convrter', so it is nil here"]
    );
}

#[test]
fn the_examples_that_are_shipped_load() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("lua");
    let filters = "trikfs = { x = { src = '/dev/x', input_tuple_size = 4, output_tuple_size = 4, converter = filter.median3{} } }";
    let loaded = Loader::default()
        .load("filters", Some(&folder), filters.as_bytes())
        .unwrap();
    let mut vm = loaded.program.open("x").unwrap();
    let stage = vm.bind("x", Direction::Read, 0, 4, 4).unwrap();
    let mut output = [0; 4];
    for (input, expected) in [(5i32, 5i32), (100, 5), (6, 6)] {
        vm.convert(stage, &input.to_le_bytes(), &mut output)
            .unwrap();
        assert_eq!(i32::from_le_bytes(output), expected);
    }
}
