//! Tests of converters and their params: each form as it is read, and every mistake in one.

use super::*;

#[test]
fn params_are_numbers_with_names() {
    let node = node("src = '/d', input_tuple_size = 1, params = { gain = 2.5 }");
    assert_eq!(node.params.get("gain"), Some(&2.5));
    let wrong = |text: &str| {
        refused(&format!(
            "src = '/d', input_tuple_size = 1, params = {text}"
        ))
    };
    assert_eq!(
        wrong("5"),
        "robot.lua:2: x: params must be a table of numbers, not a number"
    );
    assert_eq!(
        wrong("{ a = 'x' }"),
        "robot.lua:2: x: params: 'a' must be a number, not a string"
    );
    assert_eq!(
        wrong("{ a = 1 / 0 }"),
        "robot.lua:2: x: params: 'a' must be finite, not inf"
    );
    assert_eq!(
        wrong("{ 1 }"),
        "robot.lua:2: x: the name of a param is a word of letters, digits and '_'"
    );
}

#[test]
fn converters_of_all_kinds_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lib.so");
    std::fs::write(&path, "").unwrap();
    let source = "trikfs = { x = { src = '/d', input_tuple_size = 1, output_tuple_size = 1,\n converter = { 'lib.so',\n\
        'lib.so#median3', { library = 'lib.so', name = 'low_pass' }, {\n code = [[\nint converter;\n]] },\n\
        function() end } } }";
    let loaded = Loader::default().load("robot.lua", Some(folder.path()), source.as_bytes());
    let stages = loaded.unwrap().config.nodes[0].converter.clone();
    let library = |name: Option<&str>| StageKind::Library {
        path: path.clone(),
        name: name.map(str::to_owned),
    };
    let code = StageKind::InlineC {
        code: "int converter;\n".into(),
    };
    let kinds: Vec<StageKind> = stages.iter().map(|stage| stage.kind.clone()).collect();
    assert_eq!(
        kinds,
        [
            library(None),
            library(Some("median3")),
            library(Some("low_pass")),
            code,
            StageKind::Lua
        ]
    );
    assert_eq!(stages[3].place.to_string(), "robot.lua:5");
    assert_eq!(stages[4].place.to_string(), "robot.lua:7");
}

#[test]
fn converters_that_cannot_be_are_refused() {
    let converter = |text: &str| {
        refused(&format!(
            "src = '/d', input_tuple_size = 1, output_tuple_size = 1,\nconverter = {text}"
        ))
    };
    let kinds =
        "a function, the path of a library, a table with code or library, or a list of these";
    assert_eq!(
        converter("5"),
        format!("robot.lua:3: x: converter must be {kinds}, not a number")
    );
    assert_eq!(
        converter("{}"),
        format!("robot.lua:3: x: converter must be {kinds}")
    );
    assert_eq!(
        converter("{ { {} } }"),
        format!("robot.lua:3: x: converter must be {kinds}")
    );
    assert_eq!(
        converter("math.floor"),
        "robot.lua:3: x: converter must be a function written in lua, not one of the library"
    );
    assert_eq!(
        converter("'none.so'"),
        "robot.lua:3: x: library 'none.so' was not found in any folder: no search path is set"
    );
    assert_eq!(
        converter("'/nowhere/none.so'"),
        "robot.lua:3: x: library '/nowhere/none.so' does not exist"
    );
    assert_eq!(
        converter("'#x'"),
        "robot.lua:3: x: the path of the library is empty"
    );
    assert_eq!(
        converter("'x.so#'"),
        "robot.lua:3: x: the name of a converter in a library has 1 to 64 letters"
    );
    assert_eq!(
        converter("{ code = 5 }"),
        "robot.lua:3: x: code must be a string of C, not a number"
    );
    assert_eq!(converter("{ code = ' ' }"), "robot.lua:3: x: code is empty");
    assert_eq!(
        converter("{ code = 'a\\0' }"),
        "robot.lua:3: x: code contains a zero byte"
    );
    assert_eq!(
        converter("{ code = '\\255' }"),
        "robot.lua:3: x: code is not UTF-8"
    );
    assert_eq!(
        converter("{ code = 'x', lang = 'c' }"),
        "robot.lua:3: x: converter: unknown key 'lang'"
    );
    assert_eq!(
        converter("{ libary = 'x' }"),
        "robot.lua:3: x: converter: unknown key 'libary', did you mean 'library'"
    );
    assert_eq!(
        converter("{ id_create(1), x = 1 }"),
        "robot.lua:3: x: converter mixes a list with names"
    );
    let long = "(function() local t = {} for i = 1, 17 do t[i] = id_create(1) end return t end)()";
    assert_eq!(
        converter(long),
        "robot.lua:3: x: converter has more than 16 stages"
    );
}

#[test]
fn a_library_is_never_taken_from_the_working_directory() {
    let here = std::env::current_dir().unwrap().join("Cargo.toml");
    assert!(here.is_file());
    let source = "trikfs = { x = { src = '/d', input_tuple_size = 1, output_tuple_size = 1, converter = 'Cargo.toml' } }";
    assert!(load(source).is_err());
    let beside = Loader::default().load(
        "robot.lua",
        Some(Path::new(env!("CARGO_MANIFEST_DIR"))),
        source.as_bytes(),
    );
    let PathKind(path) = PathKind::of(&beside.unwrap());
    assert!(path.is_absolute());
}
