//! Names and texts that hurt: generated code still compiles, and keeps its meaning.

use crate::models::{equation, symbol};
use lang_dcml::function::Function;
use lang_dcml::generate::{Options, Target, generate};
use lang_dcml::model::{Expr, Model};
use lang_dcml::syntax::{Doc, Domain, Kind, Operator, Span};

/// Words that mean something to some language or to what is generated.
const WORDS: &str = "class double int float end lambda function var let const __proto__ constructor toString prototype \
    self this super yield async await match gen dyn impl fn mod use crate Self None Some Ok Err Params math STATES \
    ACTIONS PARAMS OUTPUTS sin cos tan asin acos atan atan2 sqrt exp log abs fabs pow fmin fmax min max sign floor \
    M_PI M_E y0 y1 j0 j1 yn gamma lgamma signgam NAN INFINITY HUGE_VAL DOMAIN OVERFLOW EOF NULL errno linux unix I \
    complex isnan remainder state action params p t dt derivative outputs jacobian result at i k1 k2 k3 k4 t1 t2 t3 \
    cos_x sin_class t1_2 x_2 x y theta np numpy print len range shape given True False nil not and or repeat until \
    then elseif goto local model huge pi e v _G _ENV _ __ _1 a1b Math String Object Double System Override org java \
    yDot values names expected what package import native transient synchronized enum interface static volatile \
    typedef struct union template typename operator namespace new delete void signed unsigned register inline restrict \
    auto bool true false null undefined Infinity arguments eval module exports require window step wrapped shifted \
    state_jacobian computeDerivatives setAction checkSize getClass wait notify hashCode f64 std core box macro \
    abcd abcD abCd ABCD \u{e9}t\u{e9} \u{3b8}";
/// Texts that hurt wherever a program writes them down.
const TEXTS: [&str; 20] = [
    "*/ int evil; /*",
    "*/*/\n/*/",
    "-- ]] evil ]==]",
    "\"\"\"; evil();//",
    "ends in a backslash \\",
    "\\\\\\",
    "a\nevil()\n",
    "a\r\nevil()\rmore\u{b}evil\u{c}evil",
    "a\u{2028}evil()\u{2029}\u{85}evil",
    "*??/\n/ evil; ??/",
    "\\u002a\\u002f evil(); \\\\u000a evil \\uzzzz",
    "%s%n \\end{align} % \\input{x}",
    "${x}`x`<script></script></pre>&amp; {@link x} @param",
    "*\u{0}/ \u{1}\u{7f}",
    "\u{feff}\u{202e}\u{2066}*\u{200f}/",
    "<!-- #include <x> #{x} -->",
    "#define x y",
    "\u{1f642} \u{416}\u{451} \u{4e2d}",
    "*\u{202e}/ evil",
    "''' ''' '",
];

fn doc(at: usize) -> Option<Doc> {
    Some(Doc {
        text: TEXTS[at % TEXTS.len()].to_owned(),
        span: Span::default(),
    })
}

fn two(operator: Operator, left: Expr, right: Expr) -> Expr {
    Expr::Binary(operator, Box::new(left), Box::new(right))
}

fn of(function: Function, x: usize, y: usize) -> Expr {
    let mut arguments = vec![Expr::Symbol(x), Expr::Symbol(y)];
    arguments.truncate(function.arguments());
    Expr::Call(function, arguments)
}

/// A model with these 12 names, in which every value depends on the one before.
fn model(name: &str, package: &str, words: &[&str], number: usize) -> Model {
    use Kind::{Action, Config, Const, Param, Var};
    let kinds = [
        Config, Config, Config, Action, Action, Param, Param, Const, Var, Var, Var, Var,
    ];
    let mut symbols: Vec<_> = kinds
        .into_iter()
        .zip(words)
        .map(|(kind, name)| symbol(kind, name))
        .collect();
    for (at, symbol) in symbols.iter_mut().enumerate() {
        symbol.doc = doc(number + at);
        symbol.unit = Some(TEXTS[(number + at) % TEXTS.len()].replace('\n', " "));
    }
    symbols[0].domain = Some(Domain::Circle);
    symbols[3].domain = Some(Domain::Range(-1e300, 0.1));
    symbols[7].value = 1.25;
    let functions = Function::ALL;
    let function = |at: usize| functions[(number * 4 + at) % functions.len()];
    let mut equations = Vec::new();
    // The third is an output; what a function makes of numbers out of its domain is the same everywhere.
    for (at, target) in [8, 9, 10, 11, 2].into_iter().enumerate() {
        let before = if at == 0 { 6 } else { 7 + at };
        let value = two(
            Operator::Multiply,
            of(function(at), [0, 1, 3, 4, 5][at], before),
            Expr::Symbol(7),
        );
        let twice = two(Operator::Add, value.clone(), of(Function::Cos, 0, 0));
        equations.push(equation(
            target,
            false,
            two(Operator::Subtract, twice, of(Function::Sin, 5, 5)),
        ));
    }
    for target in [0, 1] {
        let value = two(Operator::Add, Expr::Symbol(11), Expr::Symbol(3 + target));
        equations.push(equation(
            target,
            true,
            two(Operator::Multiply, value, Expr::Symbol(2)),
        ));
    }
    Model {
        name: name.to_owned(),
        package: Some(package.to_owned()),
        doc: doc(number),
        symbols,
        equations,
    }
}

/// All of them: every word is a name of each kind in one model or another, and the name of one model.
pub fn models() -> Vec<Model> {
    let words: Vec<&str> = WORDS.split_whitespace().collect();
    let long: Vec<String> = (0..12)
        .map(|at| format!("{}{at}", "long".repeat(2500)))
        .collect();
    let long: Vec<&str> = long.iter().map(String::as_str).collect();
    let packages = [
        "class.int.enum",
        "java.lang",
        "org.apache",
        "a.2b._.__",
        "q.null.true",
        "..",
        "m\u{e9}.q",
    ];
    let count = words.len();
    let mut models: Vec<Model> = (0..count)
        .step_by(5)
        .enumerate()
        .map(|(number, first)| {
            let chosen: Vec<&str> = (0..12).map(|at| words[(first + at) % count]).collect();
            model(
                words[first],
                packages[number % packages.len()],
                &chosen,
                number,
            )
        })
        .collect();
    models.push(model(long[0], "q.y", &long, 3));
    models
}

#[test]
fn names_that_are_others_are_told_and_no_text_ends_its_comment() {
    for model in models() {
        for target in Target::ALL {
            let text = generate(&model, target, &Options { jacobian: true }).unwrap();
            assert!(!text.contains('\u{202e}') && !text.contains('\r'));
            let again = generate(&model, target, &Options { jacobian: true }).unwrap();
            assert_eq!(text, again, "the same model gives the same text");
            if target == Target::C {
                let told = model
                    .symbols
                    .iter()
                    .filter(|one| one.name == "class")
                    .count();
                let lines = text
                    .lines()
                    .filter(|line| line.contains("class is class_2 here"))
                    .count();
                assert_eq!(told, lines);
            }
        }
    }
}
