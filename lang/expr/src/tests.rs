//! The oracle table of the real program, and more of its rules.

mod documents;
mod hostile;

use super::reserved::{FUNCTIONS, SENSORS, SensorIndex};
use super::types::Type;
use super::words::Stage;
use super::{Compat, Kit, Names, Outside, Source, Store, Value, Wanted, analyse, evaluate};
use lang_text::problem::Problem;

/// A robot whose sensors show their index, for tests.
#[derive(Default)]
struct Robot {
    printed: Vec<String>,
}

impl Outside for Robot {
    fn sensor(&mut self, sensor: SensorIndex) -> Value {
        if SENSORS[usize::from(sensor)].name == "gyroscope" {
            return Value::ints(&[0, 1, 2, 3, 4, 5, -160_000]);
        }
        if SENSORS[usize::from(sensor)].name == "objectSensorSize" {
            return Value::Unset;
        }
        Value::Int(i32::from(sensor))
    }

    fn time(&mut self) -> i32 {
        30
    }

    fn print(&mut self, text: &str) {
        self.printed.push(text.to_owned());
    }

    fn random(&mut self, below: i32) -> i32 {
        below - 1
    }
}

/// A project: texts run one after another on the same variables.
struct Bench {
    names: Names,
    store: Store,
    robot: Robot,
}

impl Bench {
    fn new(compat: Compat) -> Self {
        Self {
            names: Names::new(Kit::V62, compat),
            store: Store::default(),
            robot: Robot::default(),
        }
    }

    fn run(&mut self, text: &str) -> Result<Value, Vec<Problem>> {
        let mut source = Source::new(text, Wanted::Any);
        analyse(&mut source, &mut self.names)?;
        evaluate(&source, &self.names, &mut self.store, &mut self.robot)
    }

    /// What an evaluating Print Text shows, or the messages with their places.
    fn shown(&mut self, text: &str) -> String {
        match self.run(text) {
            Ok(value) => value.printed().to_string(),
            Err(problems) => {
                let bare = |one: Problem| Problem { hint: None, ..one }.to_string();
                let lines: Vec<_> = problems.into_iter().map(bare).collect();
                lines.join(" | ")
            }
        }
    }
}

/// Texts run in order; what the last one shows.
fn shown(texts: &[&str]) -> String {
    shown_as(Compat::Studio, texts)
}

fn shown_as(compat: Compat, texts: &[&str]) -> String {
    let mut bench = Bench::new(compat);
    texts.iter().map(|text| bench.shown(text)).last().unwrap()
}

/// Texts that run one after another, and what the last one shows or says.
const ORACLE: [(&[&str], &str); 56] = [
    (&["7/2"], "3.5"),
    (&["7//2"], "3"),
    (&["-7//2"], "-3"),
    (&["-7%2"], "-1"),
    (&["7.5//2"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (&["7.5%2"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (&["1/0"], "1:1 Division by zero"),
    (&["-16777217"], "-16777216"),
    (&["0-16777217"], "-16777217"),
    (&["2^3^2"], "512"),
    (&["-2^2"], "-4"),
    (&["1000000*1000000"], "1000000000000"),
    (&["1 << 40"], "256"),
    (&["3==3.0"], "true"),
    (&["\"3\"==3"], "true"),
    (&["\"a\"<\"b\""], "false"),
    (&["\"2\"<\"10\""], "true"),
    (&["0.4 and 1"], "false"),
    (&["\"abc\" and true"], "false"),
    (&["not nil"], "true"),
    (&["not 0"], "true"),
    (&["not 1==2"], "false"),
    (&["1 < 2 < 3"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (&["1 .. 2"], "12"),
    (&["1+2 .. 3*4"], "312"),
    (&["1/3"], "0.333333"),
    (&["2^0.5"], "1.414214"),
    (&["0.1+0.2"], "0.3"),
    (&["#\"abc\""], "3"),
    (
        &["a={1,2,3}", "#a"],
        "1:1 Type mismatch. | 1:2 Type mismatch",
    ),
    (&["~5"], "-6"),
    (&["5 ~ 3"], "6"),
    (&["0x1F"], "31"),
    (&["1e3"], "1000"),
    (&["a={1,2,3}", "a[0]"], "1"),
    (&["a={1,2,3}", "a[3]"], ""),
    (&["a[2]=5", "a[0]"], ""),
    (&["a[2]=5", "a[2]"], "5"),
    (&["a={1,2,3} a[1]=2.5", "a[1]"], "2.5"),
    (&["x=1 x=2.5", "x"], "2.5"),
    (
        &["x=1 x=\"s\""],
        "1:5 Left and right operand have mismatched types. | 1:1 Type mismatch | 1:5 Type mismatch",
    ),
    (
        &["y"],
        "1:1 Seems like accessing an uninitialized variable y",
    ),
    (&["sin(1,2)"], "1:1 Too many parameters, 1 expected"),
    (&["foo(1)"], "1:1 Unknown function"),
    (&["sensorA1=3"], "1:1 Variable sensorA1 is read-only"),
    (&["1 +"], "1:3 Unexpected end of input"),
    (&["a,b=1,2", "a+b"], "3"),
    (
        &["a,b=1"],
        "1:1 Number of variables in assignment shall be equal to the number of assigned values",
    ),
    (&["A1"], "A1"),
    (&["LeftButton"], "105"),
    (&["'it''s'"], "s"),
    (&["\"a\"+1"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (
        &["#f"],
        "1:2 Can not deduce type, expression can be of following types: string, table[any]",
    ),
    (&["x=5 -- c\ny=6", "x+y"], "11"),
    (&["\u{43f}=5", "\u{43f}*2"], "10"),
    (&["a={[2]=5}", "a[2] .. a[1]"], "5"),
];

#[test]
fn the_oracle_table_of_the_real_program_holds() {
    for (texts, wanted) in ORACLE {
        let found = shown(texts);
        // What to do follows the real program's words.
        let is_same = found == wanted
            || found
                .split(" | ")
                .zip(wanted.split(" | "))
                .all(|(found, wanted)| wanted.contains(':') && found.starts_with(wanted))
                && found.split(" | ").count() == wanted.split(" | ").count();
        assert!(is_same, "{texts:?}: {found:?} instead of {wanted:?}");
    }
}

/// Rows of texts and what the last one shows, in both kinds.
fn check(compat: Compat, rows: &[(&[&str], &str)]) {
    for (texts, wanted) in rows {
        assert_eq!(shown_as(compat, texts), *wanted, "{texts:?}");
    }
}

#[test]
fn numbers_become_text_as_qt_writes_them() {
    check(
        Compat::Studio,
        &[
            (&["1000*1000 .. ''"], "1000000"),
            (&["'' .. 1000*1000 .. ' ms'"], "1e+06 ms"),
            (&["'' .. 1000*100 .. ' ms'"], "100000 ms"),
            (&["'' .. 1234567.0 .. ' ms'"], "1234567 ms"),
            (&["'' .. 0.0001 .. ' m'"], "0.0001 m"),
            (&["'' .. 0.00001 .. ' m'"], "1e-05 m"),
            (&["'' .. 1/3 .. ' m'"], "0.3333333333333333 m"),
            (&["'' .. -0.1 .. ' m'"], "-0.10000000149011612 m"),
            (&["'' .. true .. nil .. {1}"], "true"),
            (&["'5.50'"], "5.5"),
            (&["'abc'"], "abc"),
            (&["2.0000004"], "2"),
            (&["123456789.125"], "123456789.125"),
            (&["0.1 + 0.7"], "0.8"),
        ],
    );
}

#[test]
fn values_are_equal_as_variants_are() {
    check(
        Compat::Studio,
        &[
            (&["1.0 == '1'"], "true"),
            (&["1 == '1.0'"], "false"),
            (&["'1.0' == 1"], "false"),
            (&["true == 1"], "true"),
            (&["true == 2"], "false"),
            (&["true == 'yes'"], "true"),
            (&["false == '0'"], "true"),
            (&["nil == nil"], "true"),
            (&["nil == 0"], "false"),
            (&["{1, 2} == {1, 2.0}"], "true"),
            (&["{1, 2} ~= {1, 3}"], "true"),
            (&["{1} == 1"], "false"),
            (&["-0.1 == 0 - 0.1"], "false"),
        ],
    );
}

#[test]
fn a_text_that_nobody_has_set_is_empty_where_it_is_read_and_unset_where_it_is_handed_on() {
    let mut bench = Bench::new(Compat::Studio);
    for text in ["objectSensorSize", "x = objectSensorSize", "x"] {
        let mut source = Source::new(text, Wanted::Text);
        if text.contains('=') {
            source = Source::new(text, Wanted::Statements);
        }
        analyse(&mut source, &mut bench.names).unwrap();
        let value = evaluate(&source, &bench.names, &mut bench.store, &mut bench.robot).unwrap();
        assert!(
            text.contains('=') || matches!(value, Value::Unset),
            "{text}: {value:?}"
        );
    }
    assert_eq!(bench.shown("x .. 'a'"), "a");
    assert_eq!(bench.shown("objectSensorSize .. ''"), "");
    for other in [Value::text(""), Value::Unset, Value::text("a")] {
        let is_equal = other.to_text().is_empty();
        assert_eq!(Value::Unset.equals(&other), is_equal, "{other:?}");
        assert_eq!(other.equals(&Value::Unset), is_equal, "{other:?}");
    }
    assert!(!Value::Unset.to_bool() && Value::Unset.to_int() == 0);
}

#[test]
fn operators_convert_their_operands() {
    check(
        Compat::Studio,
        &[
            (&["'2' < 10"], "true"),
            (&["0.5 or 0"], "true"),
            (&["0.4 or 0"], "false"),
            (&["true and 'true'"], "false"),
            (&["true and '2'"], "true"),
            (&["not 'false'"], "true"),
            (&["not 'x'"], "false"),
            (&["not 0.4"], "true"),
            (&["1 >> 33"], "0"),
            (&["-8 >> 1"], "-4"),
            (&["7 & 12 | 1 ~ 2"], "7"),
            (&["3000000000"], "0"),
            (&["010"], "8"),
            (&["x = 2147483647", "x + 1"], "2147483648"),
            (&["x = 2147483647", "(x + 1) // 1"], "-2147483648"),
            (&["(0 - 5) // 2 * 2 + (0 - 5) % 2"], "-5"),
            (&["2 != 3 && 1 || 0"], "true"),
        ],
    );
}

#[test]
fn both_sides_of_and_and_or_run_only_when_they_must() {
    let mut bench = Bench::new(Compat::Studio);
    assert_eq!(bench.shown("false and print(1)"), "false");
    assert_eq!(bench.shown("true or print(2)"), "true");
    assert_eq!(bench.shown("true and print(3) == 3"), "true");
    assert_eq!(bench.robot.printed, ["3"]);
}

#[test]
fn tables_are_dense_from_zero_and_grow() {
    check(
        Compat::Studio,
        &[
            (&["a={{1,2},{3,4}}", "a[1][0]"], "3"),
            (&["a={{1,2},{3,4}}", "a[0][1]=5", "a[0][1]"], "5"),
            (&["a={{1,2},{3,4}}", "a[2][2]=5", "a[2][2]"], "5"),
            (&["a={{1,2},{3,4}}", "a[2][2]=5", "a[2][0]"], ""),
            (&["a={{1,2},{3,4}}", "a[0]={5,6}", "a[0][1]"], "6"),
            (&["a={{1,2},{3,4}}", "a[7][7]"], ""),
            (&["a={1,2}", "a[0-1]"], "1:1 Negative index for a table"),
            (&["a={1,2}", "a[0-1]=3"], "1:1 Negative index for a table"),
            (&["a={{1}}", "a[0-1][0]"], "1:1 Negative index for a table"),
            (&["a={1,2,3}", "a[1.4]"], "2"),
            (&["a={1,2,3}", "a[1.5]"], "3"),
            (&["a={1,2}", "b=a", "b[0]=9", "a[0]"], "1"),
            (&["a = 1; b = 2; a, b", "a"], "1"),
            (&["gyroscope[6] / 1000"], "-160"),
            (&["gyroscope[9]"], ""),
            (&["a = {[1]=10; [3]=15}", "'<' .. a[2] .. '>'"], "<>"),
            (
                &["a = {x=1}"],
                "1:6 Undeclared identifier: x. Give it a value first.",
            ),
        ],
    );
}

#[test]
fn a_variable_is_widened_once_and_for_all() {
    let mut bench = Bench::new(Compat::Studio);
    let type_of = |bench: &Bench, name: &str| bench.names.type_of(bench.names.find(name).unwrap());
    assert_eq!(bench.shown("x = 1"), "");
    assert_eq!(type_of(&bench, "x"), Type::Int);
    let mut uses_x = Source::new("x % 2", Wanted::Int);
    analyse(&mut uses_x, &mut bench.names).unwrap();
    assert_eq!(bench.shown("x = 2.5"), "");
    assert_eq!(type_of(&bench, "x"), Type::Float);
    // What was right before is not any more.
    let problems = analyse(&mut uses_x, &mut bench.names).unwrap_err();
    assert_eq!(problems[0].to_string(), "1:1 Type mismatch.");
    // And the real program has then forgotten what x is.
    assert!(
        bench
            .shown("x = 1")
            .starts_with("1:1 Left and right operand")
    );
}

#[test]
fn fixed_types_survive_a_mistake_elsewhere() {
    let mut bench = Bench::new(Compat::Fixed);
    assert_eq!(bench.shown("x = 2.5"), "");
    assert_eq!(bench.shown("x % 2"), "1:1 Type mismatch.");
    assert_eq!(bench.shown("x = 1"), "");
    assert_eq!(bench.shown("x"), "1");
}

#[test]
fn a_table_is_widened_with_its_elements() {
    let mut bench = Bench::new(Compat::Studio);
    assert_eq!(bench.shown("a = {1, 2}"), "");
    let of = |bench: &Bench| {
        let found = bench.names.type_of(bench.names.find("a").unwrap());
        bench.names.type_name(found)
    };
    assert_eq!(of(&bench), "table[integer]");
    assert_eq!(bench.shown("a[0] = 0.5"), "");
    assert_eq!(of(&bench), "table[float]");
    assert_eq!(bench.shown("b[3] = 1"), "");
    let b = bench.names.type_of(bench.names.find("b").unwrap());
    assert_eq!(bench.names.type_name(b), "table[integer]");
    assert_eq!(bench.names.element_of(b), Type::Int);
}

#[test]
fn static_languages_get_a_warning_instead_of_a_wider_variable() {
    let mut names = Names::with_static_types(Kit::V62, Compat::Studio);
    let mut first = Source::new("x = 1", Wanted::Statements);
    analyse(&mut first, &mut names).unwrap();
    let mut second = Source::new("x = 2.5", Wanted::Statements);
    analyse(&mut second, &mut names).unwrap();
    let warnings = second.warnings();
    assert_eq!(warnings.len(), 1);
    assert_eq!(
        warnings[0].to_string(),
        "1:1 An attempt will be made to implicitly cast the right operand to the type 'integer'"
    );
    assert_eq!(names.type_of(names.find("x").unwrap()), Type::Int);
}

#[test]
fn names_are_judged_as_the_real_program_judges_them() {
    check(
        Compat::Studio,
        &[
            (
                &["x = y"],
                "1:5 Undeclared identifier: y. Give it a value first.",
            ),
            // The second time the name has been seen.
            (
                &["x = y", "x = y"],
                "1:5 Seems like accessing an uninitialized variable y. Give it a value before it is used.",
            ),
            (
                &["x = x + 1"],
                "1:5 Seems like accessing an uninitialized variable x. Give it a value before it is used.",
            ),
            (
                &["y + 1"],
                "1:1 Can not deduce type, expression can be of following types: integer, float",
            ),
            (
                &["a[0]"],
                "1:1 Can not deduce type, expression can be of following types: any",
            ),
            (
                &["#'abc' + 1"],
                "1:1 This construction is not supported by semantic analysis",
            ),
            (
                &["pi = 3"],
                "1:1 Variable pi is read-only: it belongs to the robot. Choose another name.",
            ),
            (&["A1 .. M4 .. \u{410}1"], "A1M4A1"),
            (&["sin"], "1:1 Intrinsic function used as an identifier"),
            (
                &["1 = 2"],
                "1:1 Incorrect assignment, only variables and tables can be assigned to.",
            ),
            (
                &["sin(1) = 2"],
                "1:1 Assignment to function call is impossible",
            ),
            (&["min(1)"], "1:1 Not enough parameters, 2 expected"),
            (&["sin('a')"], "1:5 Type mismatch. | 1:5 Type mismatch"),
            (&["(1)(2)"], "1:2 Indirect function calls are not supported"),
        ],
    );
}

#[test]
fn functions_compute() {
    check(
        Compat::Studio,
        &[
            (&["time()"], "30"),
            (&["sensor('A3')"], "2"),
            (&["sensor(A3)"], "2"),
            (&["sensor('')"], "0"),
            (&["sensorX = 7", "sensor('X')"], "7"),
            (&["abs(0-5) + sqrt(9) + sgn(0-2)"], "7"),
            (&["ceil(1.2) .. floor(1.8) .. floor(0-1.2)"], "21-2"),
            (&["min(1, 2) .. max(1, 2)"], "12"),
            (&["random(6)"], "5"),
            (&["random(0-6)"], "5"),
            (
                &["random(0)"],
                "1:1 random(0) has no numbers to choose from. Give it at least 1.",
            ),
            (&["atan2(1, 1) * 4"], "3.141593"),
            (&["sin(pi / 2) + cos(0) + exp(0) + ln(1)"], "3"),
            (&["asin(1) + acos(1) + atan(0)"], "1.570796"),
        ],
    );
    let mut bench = Bench::new(Compat::Studio);
    bench.shown("print(1 + 1) print('a') print \"b\"");
    assert_eq!(bench.robot.printed, ["2", "a", "\"b\""]);
    assert_eq!(FUNCTIONS.len(), 19);
}

#[test]
fn texts_that_cannot_be_read_say_where() {
    check(
        Compat::Studio,
        &[
            (&["(1"], "1:2 Expected \")\", got the end of the text"),
            (
                &["x = "],
                "1:3 Unexpected end of input. Something is missing after this.",
            ),
            (
                &["x = \"abc"],
                "1:5 Unknown sequence of symbols: \"abc. Is the closing quote missing? | \
                 1:3 Unexpected end of input. Something is missing after this.",
            ),
            (
                &["x = !y"],
                "1:5 Unknown sequence of symbols: !y. Write 'not' instead of '!'. | \
                 1:3 Unexpected end of input. Something is missing after this.",
            ),
            (&["a\r\nb"], "1:2 Unknown sequence of symbols: \r"),
            (
                &["x = 1\n  y = @"],
                "2:7 Unknown sequence of symbols: @ | \
                 2:5 Unexpected end of input. Something is missing after this.",
            ),
            (
                &["if x then"],
                "1:1 Unexpected token. \"if\" cannot stand here. This word is reserved and stands in no expression: take a block for it, or another name.",
            ),
            (&["..."], "1:1 This construction is not supported yet"),
            (
                &["x.5"],
                "1:3 Expected \"identifier\", got \"integer literal\" | 1:3 Unexpected token. \"5\" cannot stand here.",
            ),
        ],
    );
}

#[test]
fn an_error_counts_as_zero_and_what_is_behind_it_runs() {
    let mut bench = Bench::new(Compat::Studio);
    let told = bench.shown("x = 1/0; y = 7; z = 1 // 0");
    assert_eq!(told, "1:5 Division by zero | 1:21 Division by zero");
    assert_eq!(bench.shown("x .. '/' .. y"), "0/7");
}

#[test]
fn blocks_get_what_they_ask_for() {
    let mut bench = Bench::new(Compat::Studio);
    let mut ask = |text: &str, wanted: Wanted| {
        let mut source = Source::new(text, wanted);
        analyse(&mut source, &mut bench.names).unwrap();
        evaluate(&source, &bench.names, &mut bench.store, &mut bench.robot).unwrap()
    };
    assert!(matches!(ask("2.5", Wanted::Int), Value::Int(3)));
    assert!(matches!(ask("0 - 2.5", Wanted::Int), Value::Int(-2)));
    assert!(matches!(ask("'12'", Wanted::Int), Value::Int(12)));
    assert!(matches!(ask("'1.5'", Wanted::Int), Value::Int(0)));
    assert!(matches!(ask("0.4", Wanted::Bool), Value::Bool(false)));
    assert!(matches!(ask("1 + 1", Wanted::Float), Value::Float(2.0)));
    assert!(matches!(ask("", Wanted::Any), Value::Nil));
    let Value::List(ports) = ask("M3, M4", Wanted::List) else {
        panic!("no list");
    };
    let ports: Vec<String> = ports
        .items()
        .iter()
        .map(|port| port.to_text().to_string())
        .collect();
    assert_eq!(ports, ["M3", "M4"]);
    let Value::List(ports) = ask("M3", Wanted::List) else {
        panic!("no list");
    };
    assert_eq!(ports.items().len(), 1);
}

#[test]
fn fixed_mends_the_oddities() {
    check(
        Compat::Fixed,
        &[
            (&["-16777217"], "-16777217"),
            (&["'' .. -0.1"], "-0.1"),
            (&["-0"], "0"),
            (&["-7 // 2"], "-4"),
            (&["-7 % 2"], "1"),
            (&["1 << 40"], "0"),
            (&["0.4 and 1"], "true"),
            (&["'abc' and true"], "true"),
            (&["'a' < 'b'"], "true"),
            (&["'10' < '9'"], "true"),
            (&["a = {1,2,3}", "#a"], "3"),
            (&["#'abc' + 1"], "4"),
            (&["a[2] = 5", "a = {1}", "a[0]"], "1"),
            (&["a = {[2]=5}", "a[2] == 5"], "true"),
            (&["3000000000"], "3000000000"),
            (&["010"], "10"),
            (&["0x1p4 + 0x0.8"], "16.5"),
            (&["'' .. 1000*1000 .. ' ms'"], "1000000 ms"),
            (&["7.5 // 2"], "1:1 Type mismatch."),
        ],
    );
    let mut bench = Bench::new(Compat::Fixed);
    bench.shown("print \"b\\n\"");
    assert_eq!(bench.robot.printed, ["b\n"]);
}

#[test]
fn numbers_that_are_not_what_they_look_like_are_told() {
    let mut names = Names::new(Kit::V62, Compat::Studio);
    let mut source = Source::new("x = 3000000000 + 010 + 0x1p4 + 1e", Wanted::Statements);
    analyse(&mut source, &mut names).unwrap();
    let told: Vec<_> = source
        .warnings()
        .iter()
        .map(|one| one.to_string())
        .collect();
    assert_eq!(told.len(), 4, "{told:?}");
    assert!(
        told[1].starts_with("1:18 The number 010 counts as 8."),
        "{told:?}"
    );
}

#[test]
fn steps_have_names_and_russian_words() {
    for (text, stage) in [
        ("@", Stage::Lexical),
        ("1 +", Stage::Syntax),
        ("1 + 'a'", Stage::Semantic),
    ] {
        let mut source = Source::new(text, Wanted::Any);
        let problems = analyse(&mut source, &mut Names::new(Kit::V62, Compat::Studio)).unwrap_err();
        assert_eq!(source.faults()[0].reason.stage(), stage, "{text}");
        assert!(!problems[0].words.russian.is_ascii(), "{text}");
    }
}
