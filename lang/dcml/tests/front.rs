//! The front end of DCML on whatever comes: bombs, floods, bytes that are no text, and models with all mistakes at once.

use lang_dcml::diagnostic::{Code, Severity};
use lang_dcml::limits::{DCML_DEPTH, DCML_DIAGNOSTICS, DCML_TEXT_MAX, DCML_TOKENS};
use lang_dcml::{decode, format::format, understand};
use std::path::Path;

/// The codes of all findings of a text, each with its line.
fn codes(text: &str) -> Vec<(usize, &'static str)> {
    let lines = lang_dcml::lines::Lines::of(text);
    let all = understand(text).diagnostics;
    let code = |one: &lang_dcml::diagnostic::Diagnostic| {
        (lines.place(one.span.start).line, one.code.name())
    };
    all.iter().map(code).collect()
}

/// A model with an action `u` and a state `x`.
fn model(inside: &str) -> String {
    format!("BEGIN M ACTION: u; CONFIG: x; {inside}\nEND;\n")
}

#[test]
fn all_mistakes_of_a_document_are_told_and_none_twice() {
    let text = "BEGIN A ACTION: u, w; PARAM: k CONFIG: x, y, theta;
VAR: a, b, k;
d(x) = cos(thet) * u / 0;
d(y) = sine(u) + ln(k) + atan2(1)
d(theta) = (u + 2x;
a = b + 1;
b = 2 * a;
u = 3;
x = 4;
END
BEGIN B CONFIG: z, q; PARAM: p = 2;
VARS: c;
c = z < 1;
d(z) = # 5;
d(c) = 1e999;
BEGIN A ACTION: v; CONFIG: m; d(m) = v; END;";
    let expected = [
        (1, "missing-semicolon"),
        (2, "duplicate-name"),
        (3, "undeclared-name"),
        (3, "division-by-zero"),
        (4, "unknown-function"),
        (4, "unknown-function"),
        (4, "argument-count"),
        (4, "missing-semicolon"),
        (5, "bad-number"),
        (6, "algebraic-loop"),
        (8, "not-assignable"),
        (9, "duplicate-equation"),
        (10, "missing-semicolon"),
        (11, "missing-end"),
        (11, "missing-section"),
        (11, "missing-equation"),
        (11, "unexpected-value"),
        (12, "unknown-section"),
        (13, "misplaced-comparison"),
        (14, "unknown-sign"),
        (15, "not-derivable"),
        (15, "number-range"),
        (16, "duplicate-model"),
    ];
    assert_eq!(codes(text), expected);
}

#[test]
fn a_circle_is_printed_as_it_goes() {
    let text = model("VAR: a, b, c, s; a = b + u; b = c; c = 2 * a; s = s + 1; d(x) = a + s;");
    let all = understand(&text).diagnostics;
    let loops: Vec<&str> = all.iter().map(|one| one.message.as_str()).collect();
    let expected = [
        "values need each other in a circle: a -> b -> c -> a",
        "values need each other in a circle: s -> s",
    ];
    assert_eq!(loops, expected);
    assert!(all.iter().all(|one| one.code == Code::AlgebraicLoop));
    assert_eq!(all[0].notes.len(), 2);
}

#[test]
fn what_hints_say_is_of_use() {
    for (text, hint) in [
        ("d(x) = uu;", "did you mean `u`?"),
        ("d(x) = U;", "did you mean `u`?"),
        ("d(x) = sin * u;", "`sin` is a function: write `sin(...)`"),
        (
            "d(x) = u * d(x);",
            "solve these equations for one of the derivatives by hand",
        ),
        ("d(x) = u + d(u);", "move `u` to `CONFIG`"),
        ("d(x) = u + d(2 * u);", "write `d(x)`"),
        ("d(x) = arctan(u);", "write `atan(x)`"),
        ("d(x) = atn2(u, 1);", "did you mean `atan2`?"),
        ("d(x) = u(3);", "to multiply write `u * (...)`"),
        ("d(x) = u ^ 2;", "write `pow(x, 2)` or `x * x`"),
        ("d(x) = 2u;", "to multiply write `2 * u`"),
        ("der(x) = u;", "a derivative is written `d(x) = ...;`"),
        ("d(x) = u; end;", "reserved words have capital letters only"),
        ("Param: k; d(x) = k * u;", "did you mean `PARAM`?"),
        ("d(x) = u \u{2212} 1;", "write the minus sign `-`"),
    ] {
        let text = model(text);
        let all = understand(&text).diagnostics;
        let hints: Vec<&str> = all.iter().filter_map(|one| one.hint.as_deref()).collect();
        assert!(
            hints.iter().any(|one| one.contains(hint)),
            "{text}: {hints:?}"
        );
    }
}

#[test]
fn mistakes_of_units_are_told_with_both_units_and_only_where_all_are_known() {
    let good = "PARAM: L [m], k; CONST: half [1] = 0.5, conv [rad/deg] = 0.017453, rate [1/s] = 2;
        CONFIG: y [m], t [rad] in S1, h [deg]; ACTION: w [deg/s]; VAR: a [m^2], f;
        a = pow(L, 2) + L * L * half + sqrt(pow(y, 4)); f = L + k;
        d(x) = u * a; d(y) = rate * L * cos(t) * sin(h * conv) * (f / f) + 2 * rate * L;
        d(t) = w * conv + pi * rate / 4; d(h) = w + 0 * abs(w) + max(w, 3);";
    assert_eq!(codes(&model(good)), []);
    for (text, code, first, second) in [
        ("d(x) = u * (l + s);", "unit-mismatch", "[s]", "[m]"),
        ("d(x) = u * (l - c);", "unit-scale", "[0.01 m]", "[m]"),
        ("d(x) = u * sin(g);", "unit-scale", "[0.017453]", ""),
        ("d(x) = u * exp(s);", "unit-mismatch", "[s]", ""),
        ("d(x) = u * pow(2, l);", "unit-mismatch", "[m]", ""),
        ("d(x) = u * atan2(l, s);", "unit-mismatch", "[s]", "[m]"),
        (
            "d(x) = piecewise(l < s, u, 0);",
            "unit-mismatch",
            "[s]",
            "[m]",
        ),
        (
            "d(x) = u * piecewise(u < 1, l, s);",
            "unit-mismatch",
            "[s]",
            "[m]",
        ),
        (
            "CONFIG: y [m]; d(x) = u; d(y) = l;",
            "unit-mismatch",
            "[m]",
            "[m/s]",
        ),
        (
            "VAR: a [cm]; a = l; d(x) = u * a;",
            "unit-scale",
            "[m]",
            "[0.01 m]",
        ),
        (
            "CONFIG: y [m] in S1; d(x) = u; d(y) = u;",
            "unit-mismatch",
            "[m]",
            "",
        ),
    ] {
        let text = model(&format!("PARAM: l [m], s [s], c [cm], g [deg]; {text}"));
        let all = understand(&text).diagnostics;
        let errors: Vec<_> = all
            .iter()
            .filter(|one| one.severity == Severity::Error)
            .collect();
        assert_eq!(
            errors.iter().map(|one| one.code.name()).collect::<Vec<_>>(),
            [code],
            "{text}"
        );
        let other = errors[0]
            .notes
            .first()
            .map_or("", |(_, note)| note.as_str());
        assert_eq!((errors[0].label.as_str(), other), (first, second), "{text}");
    }
}

#[test]
fn bombs_and_floods_end_in_a_message() {
    let deep = DCML_DEPTH + 10;
    let nested = model(&format!(
        "d(x) = {}u{};",
        "(".repeat(deep),
        ")".repeat(deep)
    ));
    let signs = model(&format!("d(x) = {}u;", "-".repeat(deep)));
    let row = model(&format!("d(x) = u{};", " + u".repeat(deep)));
    let calls = model(&format!(
        "d(x) = {}u{};",
        "sin(".repeat(deep),
        ")".repeat(deep)
    ));
    for text in [&nested, &signs, &row, &calls] {
        let all = understand(text).diagnostics;
        assert_eq!(
            all.iter().map(|one| one.code).collect::<Vec<_>>(),
            [Code::TooDeep]
        );
    }
    let fits = DCML_DEPTH - 1;
    for text in [
        model(&format!(
            "d(x) = {}u{};",
            "(".repeat(fits),
            ")".repeat(fits)
        )),
        model(&format!("d(x) = u{};", " + u".repeat(fits))),
        model(&format!(
            "d(x) = {}u{};",
            "sin(".repeat(fits),
            ")".repeat(fits)
        )),
    ] {
        assert_eq!(understand(&text).diagnostics, []);
        assert!(format(&text).is_ok());
    }
    let flood = understand(&model(&"y = ;".repeat(100_000)));
    assert_eq!(flood.diagnostics.len(), DCML_DIAGNOSTICS + 1);
    // And `y` is not declared, and `x` has no equation.
    let last = flood.diagnostics.last().map(|one| one.message.as_str());
    assert_eq!(
        last,
        Some("there is more: 99802 errors and 0 warnings are not shown")
    );
    let many = format!("BEGIN M {}", ";".repeat(DCML_TOKENS));
    let found = understand(&many);
    assert_eq!(found.diagnostics[0].code, Code::TooLong);
    let long = " ".repeat(DCML_TEXT_MAX + 1);
    assert_eq!(understand(&long).diagnostics[0].code, Code::TooLong);
    assert!(format(&long).is_err());
}

#[test]
fn a_great_many_names_are_no_hindrance() {
    let names: Vec<String> = (0..100_000).map(|at| format!("v{at}")).collect();
    let equations: String = (1..names.len())
        .rev()
        .map(|at| format!("v{at} = v{};\n", at - 1))
        .collect();
    let text = model(&format!(
        "VAR: {};\nv0 = u;\n{equations}d(x) = v99999;",
        names.join(", ")
    ));
    let all = understand(&text);
    assert_eq!(all.diagnostics, []);
    assert_eq!(all.models[0].equations.len(), 100_001);
    assert_eq!(all.models[0].states().count(), 1);
    let circle = text.replacen("v0 = u;", "v0 = v99999;", 1);
    let all = understand(&circle).diagnostics;
    let told = all.iter().find(|one| one.code == Code::AlgebraicLoop);
    let message = told.map_or("", |one| one.message.as_str());
    assert!(
        message.contains("(99960 more) -> v0") && message.len() < 1000,
        "{message}"
    );
    // None of them is declared; that `u` is not used is told beside that.
    let unknown = model(
        &names
            .iter()
            .map(|name| format!("x = {name};"))
            .collect::<String>(),
    );
    assert_eq!(understand(&unknown).diagnostics.len(), DCML_DIAGNOSTICS + 2);
}

#[test]
fn marks_line_ends_and_bytes_that_are_no_text_are_understood_or_told_with_their_place() {
    let text = "\u{feff}BEGIN M\r\nACTION: u;\r\nCONFIG: x;\r\nd(x) = uu;\r\nEND;\r\n";
    // The nearest name was meant, and so it is used.
    assert_eq!(codes(text), [(4, "undeclared-name")]);
    assert!(!format(text).unwrap_or_default().contains('\r'));
    assert_eq!(codes("\0\0\0"), [(1, "unknown-sign"), (1, "outside-model")]);
    let error = decode(b"BEGIN M\n\xd0\xb6 \xff".to_vec());
    let expected = "2:3: the byte 0xff is no text in UTF-8: save the file as UTF-8";
    assert_eq!(
        error.map_err(|why| why.to_string()),
        Err(expected.to_owned())
    );
    for number in ["1e999", "1e-999", "123456789e400"] {
        assert_eq!(
            codes(&model(&format!("d(x) = u * {number};"))),
            [(1, "number-range")]
        );
    }
    assert_eq!(codes(&model("d(x) = u * 0e-999 + 0.000;")), []);
}

#[test]
fn whatever_stands_in_a_document_is_understood_within_limits() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/dcml");
    let mut numbers = needs::Random::new(0x9e37_79b9);
    let mut random = move |below: usize| numbers.below(below);
    for name in ["drive.dcml", "bart.dcml", "extensions.dcml", "wrong.dcml"] {
        let seed = std::fs::read(seeds.join(name)).unwrap();
        let is_good = understand(&String::from_utf8_lossy(&seed))
            .diagnostics
            .iter()
            .all(|one| one.severity == Severity::Warning);
        assert_eq!(is_good, name != "wrong.dcml");
        lang_dcml::fuzz::dcml(&seed);
        for _ in 0..400 {
            // Pieces of the seed put elsewhere, and bytes changed: much of it is still a model.
            let mut bytes = seed.clone();
            for _ in 0..=random(3) {
                let (from, to) = (random(bytes.len()), random(bytes.len()));
                let length = random(60).min(bytes.len() - from);
                let piece = bytes[from..from + length].to_vec();
                match random(3) {
                    0 => drop(bytes.splice(to..to, piece)),
                    1 => drop(bytes.drain(from..from + length)),
                    _ => bytes[to] = b"0(;,/*\n x="[random(10)],
                }
                if bytes.is_empty() {
                    break;
                }
            }
            lang_dcml::fuzz::dcml(&bytes);
        }
    }
}
