//! Tests: texts and values that mean harm, and laws over random texts.

use crate::limits;
use crate::reserved::SensorIndex;
use crate::tree::{Binary, Id, Node, Tree, Unary};
use crate::types::{Element, Possible, Type, Types};
use crate::{Compat, Kit, Names, Outside, Source, Store, Value, Wanted, analyse, evaluate, parser};
use crate::{escape, unescape};
use lang_text::problem::Problem;
use proptest::prelude::*;

/// A robot with nothing to say.
struct Nobody;

impl Outside for Nobody {
    fn sensor(&mut self, _: SensorIndex) -> Value {
        Value::ints(&[1, 2, 3])
    }

    fn time(&mut self) -> i32 {
        i32::MAX
    }

    fn print(&mut self, _: &str) {}

    fn random(&mut self, below: i32) -> i32 {
        below - 1
    }
}

/// The first message about a text.
fn message(text: &str) -> String {
    let all = messages(text);
    all.split(" | ").next().unwrap_or_default().to_owned()
}

/// All messages about a text.
fn messages(text: &str) -> String {
    let mut names = Names::new(Kit::V62, Compat::Studio);
    let mut source = Source::new(text, Wanted::Any);
    match analyse(&mut source, &mut names) {
        Err(problems) => {
            assert!(problems.len() <= limits::EXPRESSION_PROBLEMS_MAX);
            let told: Vec<String> = problems.iter().map(Problem::to_string).collect();
            told.join(" | ")
        }
        Ok(()) => {
            let mut store = Store::default();
            evaluate(&source, &names, &mut store, &mut Nobody).unwrap_err()[0].to_string()
        }
    }
}

#[test]
fn deep_nesting_is_refused_where_it_begins() {
    let depth = 100_000 / 2;
    let closed = "(".repeat(250) + "1" + &")".repeat(250);
    for text in [
        closed,
        "(".repeat(depth),
        "-".to_owned() + &"~".repeat(depth),
        "{".repeat(depth),
        "f(".repeat(depth / 2),
        "a[".repeat(depth / 2),
        "not ".repeat(depth / 4) + "x",
        "2^".repeat(depth / 2) + "2",
        "1".to_owned() + &"+1".repeat(depth / 2),
        "a".to_owned() + &"[0]".repeat(depth / 3),
        "f".to_owned() + &"()".repeat(depth / 2),
    ] {
        let told = messages(&text);
        assert!(
            told.contains("The expression is nested too deeply: at most 200 levels"),
            "{}: {told}",
            &text[..10]
        );
        assert!(!told.contains(" | "), "{}: {told}", &text[..10]);
    }
}

#[test]
fn a_hundred_levels_are_no_problem() {
    let text = "(".repeat(90) + "1" + &")".repeat(90);
    let mut names = Names::new(Kit::V62, Compat::Studio);
    let mut source = Source::new(&text, Wanted::Int);
    analyse(&mut source, &mut names).unwrap();
    let value = evaluate(&source, &names, &mut Store::default(), &mut Nobody).unwrap();
    assert!(matches!(value, Value::Int(1)));
}

#[test]
fn ten_megabytes_are_refused_at_once() {
    let text = "x = 1\n".repeat(10 << 20 >> 1);
    let told = message(&text);
    assert_eq!(
        told,
        "10923:5 The text is too long: at most 65536 bytes; divide it among several blocks."
    );
}

#[test]
fn odd_characters_are_told_in_their_places() {
    for (text, wanted) in [
        ("\0", "1:1 Unknown sequence of symbols: \0"),
        (
            "x = \u{1f916}1 + 2",
            "1:5 Unknown sequence of symbols: \u{1f916}1",
        ),
        (
            "'unterminated\n",
            "1:1 Unknown sequence of symbols: 'unterminated. Is the closing quote missing?",
        ),
        (
            "\"ends with \\",
            "1:1 Unknown sequence of symbols: \"ends. Is the closing quote missing?",
        ),
        ("\u{feff}x", "1:1 Unknown sequence of symbols: \u{feff}x"),
    ] {
        assert_eq!(message(text), wanted);
    }
    let many = "@ ".repeat(30_000);
    assert_eq!(message(&many), "1:1 Unknown sequence of symbols: @");
}

#[test]
fn values_cannot_grow_without_end() {
    let grow = |first: &str, again: &str| -> String {
        let mut names = Names::new(Kit::V62, Compat::Studio);
        let (mut store, mut first) = (Store::default(), Source::new(first, Wanted::Any));
        analyse(&mut first, &mut names).unwrap();
        evaluate(&first, &names, &mut store, &mut Nobody).unwrap();
        let mut again = Source::new(again, Wanted::Any);
        for _ in 0..2_000_000 {
            if let Err(problems) = analyse(&mut again, &mut names) {
                return problems[0].to_string();
            }
            if let Err(problems) = evaluate(&again, &names, &mut store, &mut Nobody) {
                return problems[0].to_string();
            }
        }
        "grows".into()
    };
    let too_long = "1:5 The value is too long: a table has at most 100000 elements, a text at most 1048576 bytes.";
    assert_eq!(grow("t = 'ab'", "t = t .. t"), too_long);
    assert_eq!(
        grow("a = {} i = 0", "a[i] = 1 i = i + 1"),
        too_long.replace("1:5", "1:1")
    );
    assert_eq!(
        grow("a = {}", "a[2000000000] = 1"),
        too_long.replace("1:5", "1:1")
    );
    let doubled = grow("a = {} b = {}", "b = {} b[0] = a b[1] = a a = b");
    assert!(doubled.contains("The value is too long"), "{doubled}");
    // Through two variables the types see nothing of the tables in tables.
    assert_eq!(
        grow("a = {} b = {}", "b = {} b[0] = a a = b"),
        "1:8 Too many tables in tables: at most 32."
    );
    let many: String = (0..20).map(|one| format!("a{one}[90000] = 1\n")).collect();
    let mut names = Names::new(Kit::V62, Compat::Studio);
    let mut source = Source::new(&many, Wanted::Any);
    analyse(&mut source, &mut names).unwrap();
    let told = evaluate(&source, &names, &mut Store::default(), &mut Nobody).unwrap_err();
    assert!(
        told[0].to_string().contains("The variables hold too much"),
        "{}",
        told[0]
    );
}

#[test]
fn one_text_cannot_make_much_work() {
    for (setup, text) in [
        ("a = {} a[90000] = 1 b = {} b[90000] = 1", "x = a == b "),
        ("a = {} a[90000] = 1", "b = a a[0] = 1 "),
        (
            "a = {} b = {} b[90000] = 1 a[0] = b",
            "c = a[0] a[0][0] = 1 ",
        ),
        (
            "t = 'abcdefghijklmnop' t = t..t..t..t t = t..t..t..t t = t..t..t..t t = t..t..t..t \
             t = t..t..t..t t = t..t..t..t t = t..t u = t .. ''",
            "x = t == u ",
        ),
        (
            "t = 'abcdefghijklmnop' t = t..t..t..t t = t..t..t..t t = t..t..t..t t = t..t..t..t \
             t = t..t..t..t t = t..t..t..t t = t..t",
            "x = #t ",
        ),
    ] {
        let mut names = Names::new(Kit::V62, Compat::Studio);
        let mut store = Store::default();
        let mut setup = Source::new(setup, Wanted::Any);
        analyse(&mut setup, &mut names).unwrap();
        evaluate(&setup, &names, &mut store, &mut Nobody).unwrap();
        let mut source = Source::new(&text.repeat(2_000), Wanted::Any);
        analyse(&mut source, &mut names).unwrap();
        let told = evaluate(&source, &names, &mut store, &mut Nobody).unwrap_err();
        assert!(
            told[0].to_string().contains("makes too much work"),
            "{text}: {}",
            told[0]
        );
    }
}

#[test]
fn a_long_text_is_no_number() {
    let digits = "1".repeat(limits::NUMBER_TEXT_MAX + 1);
    assert_eq!(Value::text(digits.as_str()).to_float(), 0.0);
    assert_eq!(Value::text(digits.as_str()).to_int(), 0);
    assert!(Value::text(&digits[1..]).to_float() > 1e300);
}

#[test]
fn names_cannot_grow_without_end() {
    let mut names = Names::new(Kit::V62, Compat::Studio);
    let mut told = None;
    for round in 0..100 {
        let text: String = (0..100)
            .map(|one| format!("v{round}_{one} = 1\n"))
            .collect();
        let mut source = Source::new(&text, Wanted::Any);
        if let Err(problems) = analyse(&mut source, &mut names) {
            told = Some(problems[0].words.english.clone());
            break;
        }
    }
    assert_eq!(
        told.as_deref(),
        Some("Too many different names: at most 4096 in a project.")
    );
    assert_eq!(names.len(), limits::NAMES_MAX);
}

#[test]
fn open_types_cannot_grow_without_end() {
    let mut names = Names::new(Kit::V62, Compat::Studio);
    let before = names.types.variables();
    for _ in 0..limits::OPEN_TYPES_MAX + limits::NAMES_MAX {
        let mut source = Source::new("x = 1 x[0] = 1", Wanted::Any);
        let _ = analyse(&mut source, &mut names);
    }
    assert!(names.types.variables() - before <= limits::OPEN_TYPES_MAX + limits::NAMES_MAX);
}

/// Text of a random expression that the grammar has.
#[test]
fn two_tables_that_are_elements_of_themselves_are_compared_in_bounded_time() {
    let mut types = Types::new(true);
    let [one, two] = [0, 1].map(|_| {
        let element = types.variable(Possible::one(Type::Open));
        let table = types.table(Element::Variable(element));
        types.set(element, Possible::one(table));
        table
    });
    assert_ne!(one, two);
    assert!(types.stands_for(one, two) && types.stands_for(two, one));
    let plain = types.table(Element::Settled(Type::Text));
    assert!(!types.stands_for(one, plain));
}

fn expression() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("nil".to_owned()),
        Just("true".to_owned()),
        (0u32..3_000_000_000).prop_map(|number| number.to_string()),
        (0f64..1e6).prop_map(|number| format!("{number:.3}")),
        "[a-c]".prop_map(|name| name),
        "[ -!#-&(-~]{0,5}".prop_map(|text| format!("\"{}\"", escape(&text))),
        Just("sensorA1".to_owned()),
        Just("gyroscope[1]".to_owned()),
    ];
    let signs: Vec<&'static str> = vec![
        "or", "and", "<", ">", "<=", ">=", "~=", "==", "|", "~", "&", "<<", ">>", "..", "+", "-",
        "*", "/", "//", "%", "^", "||", "&&", "!=",
    ];
    leaf.prop_recursive(6, 60, 4, move |inner| {
        prop_oneof![
            (
                inner.clone(),
                prop::sample::select(signs.clone()),
                inner.clone()
            )
                .prop_map(|(left, sign, right)| format!("{left} {sign} {right}")),
            (
                prop::sample::select(vec!["- ", "not ", "#", "~"]),
                inner.clone()
            )
                .prop_map(|(sign, operand)| format!("{sign}{operand}")),
            inner.clone().prop_map(|inner| format!("({inner})")),
            (inner.clone(), inner.clone()).prop_map(|(one, two)| format!("{{{one}, [1] = {two}}}")),
            (inner.clone(), inner.clone()).prop_map(|(one, two)| format!("a[{one}][{two}]")),
            inner.clone().prop_map(|index| format!("b[{index}]")),
            (
                prop::sample::select(vec!["sin", "print", "random", "floor", "sensor", "foo"]),
                inner.clone()
            )
                .prop_map(|(name, argument)| format!("{name}({argument})")),
            (inner.clone(), inner).prop_map(|(one, two)| format!("max({one}, {two})")),
        ]
    })
}

fn program() -> impl Strategy<Value = String> {
    let statement = prop_oneof![
        expression(),
        ("[a-c]", expression()).prop_map(|(name, value)| format!("{name} = {value}")),
        (0u8..9, expression()).prop_map(|(index, value)| format!("a[{index}] = {value}")),
        (expression(), expression()).prop_map(|(one, two)| format!("{one}, {two}")),
        (expression(), expression()).prop_map(|(one, two)| format!("a, b = {one}, {two}")),
    ];
    prop::collection::vec(statement, 1..5).prop_map(|statements| statements.join("; "))
}

/// A tree with brackets around everything, whatever the numbers of its nodes are.
fn shape(tree: &Tree, id: Option<Id>) -> String {
    let Some(id) = id else {
        return String::new();
    };
    let own = match tree.node(id) {
        Node::Unary(operator, _) => format!("{operator:?}"),
        Node::Binary(operator, ..) => format!("{operator:?}"),
        Node::Table { fields, bare } => {
            let keys: Vec<_> = fields.iter().map(|field| field.key.is_some()).collect();
            format!("Table {keys:?} {bare}")
        }
        Node::Index { .. } => "Index".into(),
        Node::Call { .. } => "Call".into(),
        Node::Method { .. } => "Method".into(),
        Node::Assign { .. } => "Assign".into(),
        Node::Block(_) => "Block".into(),
        leaf @ (Node::Nil
        | Node::Bool(_)
        | Node::Int(_)
        | Node::Float(_)
        | Node::Text(_)
        | Node::RawText(_)
        | Node::Name(_)) => format!("{leaf:?}"),
    };
    let mut text = format!("({own}");
    tree.children(id, |child| {
        text.push(' ');
        text.push_str(&shape(tree, Some(child)));
    });
    text.push(')');
    text
}

fn runs(texts: &[String], compat: Compat, wanted: Wanted) {
    let mut names = Names::new(Kit::V62, compat);
    let mut store = Store::default();
    let mut sources: Vec<_> = texts.iter().map(|text| Source::new(text, wanted)).collect();
    for _ in 0..3 {
        for source in &mut sources {
            if analyse(source, &mut names).is_ok() {
                let at = names.epoch();
                let _ =
                    evaluate(source, &names, &mut store, &mut Nobody).map(|value| value.printed());
                // Nothing has changed, and so it is still right.
                assert_eq!(analyse(source, &mut names), Ok(()));
                assert_eq!(names.epoch(), at);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn what_is_printed_reads_back_the_same(text in program()) {
        let (tree, faults) = parser::parse(&text);
        prop_assert!(faults.is_empty(), "{}: {:?}", text, faults);
        let printed = tree.to_string();
        let (again, faults) = parser::parse(&printed);
        prop_assert!(faults.is_empty(), "{} -> {}: {:?}", text, printed, faults);
        prop_assert_eq!(shape(&tree, tree.root), shape(&again, again.root), "{} -> {}", text, printed);
        prop_assert_eq!(again.to_string(), printed);
    }

    #[test]
    fn programs_never_panic(texts in prop::collection::vec(program(), 1..4), fixed: bool) {
        let compat = if fixed { Compat::Fixed } else { Compat::Studio };
        for wanted in [Wanted::Any, Wanted::Bool, Wanted::Int, Wanted::Float, Wanted::Text, Wanted::List] {
            runs(&texts, compat, wanted);
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,80}") {
        runs(&[text], Compat::Studio, Wanted::Any);
    }

    #[test]
    fn escapes_come_back(text in "\\PC{0,40}") {
        prop_assert_eq!(unescape(&escape(&text)), text);
    }
}

#[test]
fn what_the_fuzzer_feeds_does_no_harm() {
    let seeds: [&[u8]; 4] = [
        b"\x00a = {1, 2.5}\0a[0] = a[1] .. 'x'\0#a[0]",
        b"\x01x = x + 1; y = -2 ^ 3 // 2 % 5",
        b"\x8cM3, M4\0sensor('A1') < 5 and not nil or gyroscope[1] << 3",
        b"\xff\xffprint \"\\n\" random(6) max(1, 2) f{[1]=2}:g() ...",
    ];
    let mut numbers = needs::Random::new(1);
    let mut random = |below: usize| numbers.below(below);
    for seed in seeds {
        crate::fuzz::expression(seed);
        for _ in 0..2_000 {
            let mut bytes = seed.to_vec();
            for _ in 0..=random(4) {
                let at = random(bytes.len());
                match random(3) {
                    0 => bytes[at] = random(256) as u8,
                    1 => bytes.insert(at, b"()[]{}+-*/.'\"=~^#,;"[random(19)]),
                    _ if bytes.len() > 1 => {
                        bytes.remove(at);
                    }
                    _ => {}
                }
            }
            crate::fuzz::expression(&bytes);
        }
    }
}

#[test]
fn operators_are_found_by_their_signs() {
    for sign in ["or", "||", "and", "&&", "~=", "!=", "..", "^"] {
        let operator = Binary::of(sign).unwrap();
        assert_eq!(Binary::of(operator.sign()), Some(operator));
    }
    assert_eq!(Unary::Not.sign(), "not ");
    let (tree, _) = parser::parse("1 ~ ~2");
    assert!(matches!(
        tree.node(tree.root.unwrap()),
        Node::Binary(Binary::BitXor, 0, 2)
    ));
}

#[test]
fn a_message_never_names_the_same_token_twice() {
    for (text, wanted) in [
        ("((1)", "1:4 Expected \")\", got the end of the text"),
        ("f(1,,2)", "1:5 Unexpected token. \",\" cannot stand here."),
        ("(1 2)", "1:4 Expected \")\", got \"integer literal\""),
        ("a.", "1:2 Expected \"identifier\", got the end of the text"),
        (
            "f(",
            "1:2 Unexpected end of input. Something is missing after this.",
        ),
        (
            "x => 2",
            "1:4 Unexpected token. \">\" cannot stand here. Did you mean '>='?",
        ),
        (
            "x = 1 = 2",
            "1:7 Unexpected token. \"=\" cannot stand here. Did you mean '=='?",
        ),
        (
            "x = 1 )'b'",
            "1:7 Unexpected token. \")\" cannot stand here.",
        ),
    ] {
        // What follows from the first mistake is told after it, as the real program does.
        assert_eq!(messages(text).split(" | ").next(), Some(wanted), "{text}");
    }
}

#[test]
fn a_block_gets_the_end_of_the_range_and_never_the_low_bits() {
    let number = |text: &str| {
        let mut names = Names::new(Kit::V62, Compat::Studio);
        let mut source = Source::new(text, Wanted::Int);
        analyse(&mut source, &mut names).unwrap();
        let is_told = source.out_of_range().is_some();
        let (mut store, mut nobody) = (Store::default(), Nobody);
        let value = evaluate(&source, &names, &mut store, &mut nobody).unwrap();
        let whole = crate::evaluate_int(&source, &names, &mut store, &mut nobody).unwrap();
        assert!(matches!(value, Value::Int(same) if same == whole), "{text}");
        (whole, is_told)
    };
    for (text, whole, is_told) in [
        ("1e10", i32::MAX, true),
        ("0 - 1e10", i32::MIN, true),
        ("-1e300", i32::MIN, true),
        ("3000000000.0", i32::MAX, true),
        ("60 * 60 * 1000 * 1000", i32::MAX, true),
        ("2147483647.4", i32::MAX, false),
        ("x = 1e10 x", i32::MAX, false),
        ("x = 3 x", 3, false),
        ("'10000000000'", i32::MAX, false),
        ("max(1e10, 1)", i32::MAX, false),
        ("65536 * 65536 // 1", 0, false),
        ("2.5", 3, false),
        ("0 - 2.5", -2, false),
    ] {
        assert_eq!(number(text), (whole, is_told), "{text}");
    }
}

#[test]
fn a_block_of_a_judged_program_gets_what_the_real_program_cuts_off() {
    let mut names = Names::new(Kit::V62, Compat::Studio).with_low_bits();
    for (text, whole) in [
        ("1e10", 1_410_065_408),
        ("x = 1e10 x", 1_410_065_408),
        ("7.5", 8),
    ] {
        let mut source = Source::new(text, Wanted::Int);
        analyse(&mut source, &mut names).unwrap();
        let (mut store, mut nobody) = (Store::default(), Nobody);
        let found = crate::evaluate_int(&source, &names, &mut store, &mut nobody);
        assert_eq!(found, Ok(whole), "{text}");
    }
}
