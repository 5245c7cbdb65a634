//! What editors are told of texts, whole and half written.

use super::*;
use crate::limits::DCML_EDITOR_PLACES;
use lang_dcml::function::Function;

const DRIVE: &str = "/** Two wheels. */
BEGIN Drive
PACKAGE: robotics.models;
ACTION: u_l [rad/s], /** Right wheel. */ u_r [rad/s] in -2 .. 2;
PARAM: L, r;
CONST: g = -9.5;
CONFIG: x, y, theta in S1, mid;
VAR: v;
v = r / 2 * (u_l + u_r);
d(x) = v * cos(theta);
d(y) = v * sin(theta);
d(theta) = (r / L) * (u_r - u_l) + 0 * g;
mid = (x + y) / 2 * pi;
END;
";

/// A reading, and the place of `|` in its text.
fn marked(text: &str) -> (Reading, u32) {
    let at = text.find('|').expect("a place");
    (
        Reading::of(text.replacen('|', "", 1)),
        u32::try_from(at).unwrap(),
    )
}

/// The same in the model above, at the nth time that a word begins.
fn at(word: &str, nth: usize) -> (Reading, u32) {
    let place = DRIVE.match_indices(word).nth(nth).expect("so often").0;
    (Reading::of(DRIVE.to_owned()), u32::try_from(place).unwrap())
}

fn labels(text: &str) -> Vec<String> {
    let (reading, offset) = marked(text);
    let (all, is_whole) = reading.complete(offset);
    assert!(is_whole);
    all.into_iter().map(|one| one.label).collect()
}

/// The text after edits.
fn edited(reading: &Reading, edits: &[Edit]) -> String {
    let mut text = reading.text().to_owned();
    let mut edits = edits.to_vec();
    edits.sort_by_key(|one| std::cmp::Reverse(one.span.start));
    for edit in edits {
        text.replace_range(edit.span.start as usize..edit.span.end as usize, &edit.text);
    }
    text
}

#[test]
fn the_model_of_these_tests_has_no_errors() {
    assert_eq!(Reading::of(DRIVE.to_owned()).diagnostics(), []);
}

#[test]
fn hovering_tells_kind_unit_documentation_value_and_equation() {
    let hover = |word, nth| {
        let (reading, offset) = at(word, nth);
        reading.hover(offset).unwrap_or_else(|| panic!("{word}"))
    };
    let right = hover("u_r", 1);
    assert_eq!(right.code, "ACTION u_r [rad/s] in -2 .. 2");
    assert_eq!(
        (right.what.as_str(), right.said.trim()),
        ("action", "Right wheel.")
    );
    let theta = hover("theta", 2);
    assert_eq!(theta.code, "CONFIG theta in S1");
    assert!(theta.what.starts_with("state"), "{}", theta.what);
    assert_eq!(theta.more, "d(theta) = (r / L) * (u_r - u_l) + 0 * g;");
    assert!(hover("mid", 0).what.starts_with("output"));
    assert_eq!(hover("g;", 0).code, "CONST g = -9.5");
    assert_eq!(hover("pi", 0).code, "pi = 3.141592653589793");
    assert_eq!(hover("cos", 0).code, "cos(x)");
    assert!(hover("d(", 0).said.contains("derivative"));
    assert!(hover("CONFIG", 0).said.contains("state"));
    let model = hover("Drive", 0);
    assert_eq!(model.said.trim(), "Two wheels.");
    assert!(
        model
            .what
            .contains("robotics.models, 2 actions, 2 parameters, 4 parts"),
        "{}",
        model.what
    );
    for nothing in ["2;", "robotics", " = ("] {
        let (reading, offset) = at(nothing, 0);
        assert_eq!(reading.hover(offset), None, "{nothing}");
    }
}

#[test]
fn a_function_shows_what_it_takes() {
    for function in Function::ALL {
        let text = format!("BEGIN M\nd(x) = {}(|", function.name());
        let (reading, offset) = marked(&text);
        let signature = reading.signature(offset).expect("a call");
        assert_eq!(signature.arguments.len(), function.arguments());
        let names = signature.arguments.iter();
        for span in names {
            assert_eq!(
                &signature.code[span.start as usize..span.end as usize].len(),
                &1
            );
        }
    }
    for (text, active) in [
        ("BEGIN M d(x) = atan2(y, max(1, 2) - |", Some(1)),
        ("BEGIN M d(x) = atan2((a, b), (|", Some(1)),
        ("BEGIN M d(x) = piecewise(a < b, 1, c|", Some(0)),
        ("BEGIN M d(x) = sin(y) + |", None),
        ("BEGIN M d(x) = sin(y; |", None),
        ("BEGIN M d(x) = nosuch(|", None),
    ] {
        let (reading, offset) = marked(text);
        assert_eq!(
            reading.signature(offset).map(|one| one.active),
            active,
            "{text}"
        );
    }
}

#[test]
fn a_name_leads_to_its_declaration_and_to_all_its_places() {
    let (reading, offset) = at("theta", 3);
    let definition = reading.definition(offset).expect("declared");
    assert_eq!(definition.start as usize, DRIVE.find("theta").unwrap());
    let places = reading.references(offset);
    let found: Vec<usize> = places.iter().map(|(span, _)| span.start as usize).collect();
    let wanted: Vec<usize> = DRIVE.match_indices("theta").map(|(at, _)| at).collect();
    assert_eq!(found, wanted);
    assert_eq!(
        places
            .iter()
            .filter(|(_, is_declared)| *is_declared)
            .count(),
        1
    );
    // Declared, and given by an equation.
    assert_eq!(reading.writes(offset).len(), 2);
    let (reading, offset) = at("cos", 0);
    assert_eq!(reading.definition(offset), None);
}

#[test]
fn models_do_not_see_each_others_names() {
    let two = format!("{DRIVE}{}", DRIVE.replace("Drive", "Other"));
    let reading = Reading::of(two.clone());
    let second = u32::try_from(two.rfind("theta").unwrap()).unwrap();
    let places = reading.references(second);
    assert_eq!(places.len(), DRIVE.matches("theta").count());
    assert!(
        places
            .iter()
            .all(|(span, _)| span.start as usize >= DRIVE.len())
    );
}

#[test]
fn renaming_changes_every_place_and_derivatives_and_no_comment() {
    let text = DRIVE.replace("VAR: v;", "VAR: v; // theta");
    let (reading, offset) = (
        Reading::of(text.clone()),
        u32::try_from(text.find("theta").unwrap()).unwrap(),
    );
    let edits = reading.rename(offset, "heading").expect("renamed");
    let wanted = text
        .replace("theta", "heading")
        .replace("// heading", "// theta");
    assert_eq!(edited(&reading, &edits), wanted);
    assert_eq!(Reading::of(wanted).diagnostics(), []);
    let (reading, offset) = at("Drive", 0);
    let edits = reading.rename(offset, "Robot").expect("renamed");
    assert_eq!(edited(&reading, &edits), DRIVE.replace("Drive", "Robot"));
}

#[test]
fn renaming_refuses_what_would_change_the_meaning() {
    let (reading, theta) = at("theta", 0);
    for (new, why) in [
        ("L", "declared"),
        ("pi", "used"),
        ("sin", "function"),
        ("d", "function"),
        ("piecewise", "function"),
        ("END", "word of the language"),
        ("", "no name"),
        ("2x", "no name"),
        ("a b", "no name"),
        (" a", "no name"),
        ("a;", "no name"),
        ("\u{3b8}", "no name"),
        ("a/*", "no name"),
        (&"a".repeat(300), "at most 250 letters"),
    ] {
        let refusal = reading.rename(theta, new).expect_err(new).to_string();
        assert!(refusal.contains(why), "{new}: {refusal}");
    }
    assert_eq!(reading.rename(theta, "theta"), Ok(Vec::new()));
    for (word, why) in [
        ("cos", "belongs to the language"),
        ("pi", "belongs to the language"),
        ("BEGIN", "word of the language"),
        ("S1", "word of the language"),
        ("rad", "units"),
        ("robotics", "packages"),
        ("9.5", "no name"),
        ("Right", "no name"),
    ] {
        let (reading, offset) = at(word, 0);
        let refusal = reading.rename(offset, "free").expect_err(word).to_string();
        assert!(refusal.contains(why), "{word}: {refusal}");
    }
}

#[test]
fn what_is_offered_depends_on_the_place() {
    let has = |text: &str, wanted: &[&str], unwanted: &[&str]| {
        let found = labels(text);
        for word in wanted {
            assert!(
                found.iter().any(|one| one == word),
                "{text}: no {word} in {found:?}"
            );
        }
        for word in unwanted {
            assert!(found.iter().all(|one| one != word), "{text}: {word}");
        }
    };
    let model = "BEGIN M\nACTION: u;\nPARAM: k;\nCONFIG: x, y;\nVAR: a;\nd(x) = u;\n";
    has("|", &["BEGIN", "BEGIN model"], &["ACTION", "sin"]);
    has("BEG|", &["BEGIN model"], &[]);
    has(
        &format!("{model}|"),
        &["d(y)", "y", "a", "END", "VAR"],
        &["d(x)", "sin", "u", "BEGIN"],
    );
    has(
        &format!("{model}a = |"),
        &["u", "k", "x", "sin", "pi", "piecewise"],
        &["ACTION", "d(y)", "m/s"],
    );
    has(
        &format!("{model}a = 2 * k + s|\nEND;"),
        &["sin", "sqrt"],
        &["END"],
    );
    has(&format!("{model}d(|"), &["x", "y"], &["u", "k", "sin"]);
    has(&format!("{model}d(y|) = u; END;"), &["x", "y"], &["u"]);
    has("BEGIN M ACTION: v [|", &["m/s", "rad/s"], &["in", "sin"]);
    has("BEGIN M ACTION: v |", &["in"], &["m"]);
    has("BEGIN M CONFIG: t in |", &["S1"], &["in"]);
    for nothing in [
        "BEGIN |",
        "BEGIN M ACTION: |",
        "BEGIN M PACKAGE: a.|",
        "BEGIN M // d|",
        "BEGIN M /* d| */",
        "BEGIN M /* d|",
    ] {
        assert_eq!(labels(nothing), Vec::<String>::new(), "{nothing}");
    }
    has("BEGIN M // d\n|", &["ACTION"], &[]);
    has("BEGIN M CONST: e = 2; CONFIG: x; d(x) = |", &["e"], &[]);
}

#[test]
fn the_text_of_each_model_that_is_offered_has_no_errors() {
    let (all, _) = Reading::of(String::new()).complete(0);
    let models: Vec<_> = all
        .iter()
        .filter(|one| one.label.starts_with("BEGIN "))
        .collect();
    assert!(models.len() >= 2);
    for one in models {
        let reading = Reading::of(one.insert.clone());
        assert_eq!(reading.diagnostics(), [], "{}", one.insert);
        assert!(
            !one.insert.contains('$')
                && one
                    .snippet
                    .as_deref()
                    .is_some_and(|text| text.contains("${1:"))
        );
    }
}

#[test]
fn a_wrong_word_is_changed_to_the_nearest_one_or_declared() {
    let fixed = |text: &str, title: &str| {
        let reading = Reading::of(text.to_owned());
        let end = u32::try_from(text.len()).unwrap();
        let fixes = reading.fixes(Span { start: 0, end });
        let fix = fixes.iter().find(|one| one.title == title);
        let fix = fix.unwrap_or_else(|| panic!("{title}: {fixes:?}, {:?}", reading.diagnostics()));
        edited(&reading, &fix.edits)
    };
    let wrong = DRIVE.replace("cos(theta)", "cos(thata)");
    assert_eq!(fixed(&wrong, "Change to `theta`"), DRIVE);
    let wrong = DRIVE.replace("cos(theta)", "coss(theta)");
    assert_eq!(fixed(&wrong, "Change to `cos`"), DRIVE);
    let wrong = DRIVE.replace("* cos(theta)", "* cos(theta) * wind");
    let declared = fixed(&wrong, "Declare `wind` as a parameter");
    assert!(declared.contains("PARAM: L, r, wind;"), "{declared}");
    assert_eq!(Reading::of(declared).diagnostics(), []);
    let wrong = "BEGIN M ACTION: u; CONFIG: x; d(x) = u * k; END;";
    let declared = fixed(wrong, "Declare `k` as a parameter");
    assert_eq!(Reading::of(declared).diagnostics(), []);
    let reading = Reading::of(DRIVE.to_owned());
    assert_eq!(
        reading.fixes(Span {
            start: 0,
            end: 1000
        }),
        []
    );
}

#[test]
fn the_outline_has_models_names_and_equations() {
    let symbols = Reading::of(DRIVE.to_owned()).symbols();
    assert_eq!(symbols.len(), 1);
    assert_eq!(
        (symbols[0].name.as_str(), symbols[0].detail.as_str()),
        ("Drive", "robotics.models")
    );
    let names: Vec<&str> = symbols[0]
        .inside
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let wanted = [
        "u_l", "u_r", "L", "r", "g", "x", "y", "theta", "mid", "v", "v", "d(x)", "d(y)",
        "d(theta)", "mid",
    ];
    assert_eq!(names, wanted);
    for one in &symbols[0].inside {
        assert!(one.span.start <= one.selection.start && one.selection.end <= one.span.end);
    }
}

#[test]
fn models_and_comments_of_several_lines_can_be_folded() {
    let text = "// a\n// b\nBEGIN M /* c\n */\nACTION: u,\n  w;\nCONFIG: x; d(x) = u * w; END;";
    let reading = Reading::of(text.to_owned());
    let folds = reading.folds();
    let shown: Vec<(&str, bool)> = folds
        .iter()
        .map(|one| (reading.slice(one.span), one.is_comment))
        .collect();
    assert_eq!(shown.len(), 4, "{shown:?}");
    assert_eq!(shown[0], ("// a\n// b", true));
    assert!(shown[1].0.starts_with("BEGIN M") && shown[1].0.ends_with("END;"));
    assert_eq!(shown[2], ("/* c\n */", true));
    assert_eq!(shown[3], ("ACTION: u,\n  w;", false));
}

#[test]
fn words_have_the_colours_of_what_they_mean() {
    let reading = Reading::of(DRIVE.to_owned());
    let end = u32::try_from(DRIVE.len()).unwrap();
    let painted = reading.colours(Span { start: 0, end });
    let find = |word: &str, nth: usize| {
        let place = DRIVE.match_indices(word).nth(nth).expect("so often").0;
        let found = painted.iter().find(|one| one.span.start as usize == place);
        *found.unwrap_or_else(|| panic!("{word}"))
    };
    let left = find("u_l", 0);
    assert_eq!(
        (left.colour, left.is_declaration, left.is_fixed),
        (Colour::Parameter, true, false)
    );
    let radius = find("r / 2", 0);
    assert_eq!(
        (radius.colour, radius.is_declaration, radius.is_fixed),
        (Colour::Parameter, false, true)
    );
    assert_eq!(find("theta", 3).colour, Colour::Property);
    assert_eq!(find("cos", 0).colour, Colour::Function);
    assert!(find("pi", 0).is_of_language && find("/** T", 0).is_doc);
    // A stretch has its own words only.
    let line = u32::try_from(DRIVE.find("d(x)").unwrap()).unwrap();
    let part = reading.colours(Span {
        start: line,
        end: line + 4,
    });
    assert_eq!(part.len(), 2);
    assert!(
        painted
            .windows(2)
            .all(|pair| pair[0].span.end <= pair[1].span.start)
    );
}

#[test]
fn half_written_texts_keep_the_names_of_what_is_there() {
    for text in [
        "BEGIN M\nACTION: u\nCONFIG: x, yy;\nd(x) = u * |yy",
        "BEGIN M\nACTION: u;\nCONFIG: x, yy;\nd(x) = (((u * |yy;\nEND;",
        "BEGIN M\nACTION: u;\nCONFIG: x, yy;\nd(x) = ;\nd(yy = |yy\nBEGIN N\n",
        "CONFIG: yy;\nBEGIN M\nCONFIG: yy,;\n = |yy",
    ] {
        let (reading, offset) = marked(text);
        let definition = reading
            .definition(offset)
            .unwrap_or_else(|| panic!("{text}"));
        assert_eq!(reading.slice(definition), "yy");
        assert!(!reading.diagnostics().is_empty());
    }
}

#[test]
fn every_question_at_every_place_of_a_broken_text_is_answered() {
    let broken = "\u{feff}/** \u{3b8} */BEGIN\u{1F600} M ACTION: [ , in = S1 CONST: x = = 3 .. d(d(x)) = sin(cos( END BEGIN ; /*";
    for cut in 0..=broken.len() {
        let Some(text) = broken.get(cut..) else {
            continue;
        };
        let reading = Reading::of(text.to_owned());
        let end = u32::try_from(text.len()).unwrap();
        reading.symbols();
        reading.folds();
        reading.fixes(Span { start: 0, end });
        reading.colours(Span { start: 0, end });
        for offset in 0..=end + 2 {
            reading.hover(offset);
            reading.complete(offset);
            reading.signature(offset);
            reading.definition(offset);
            reading.writes(offset);
            assert!(reading.references(offset).len() < DCML_EDITOR_PLACES);
            let _ = reading.rename(offset, "name");
        }
    }
}

#[test]
fn the_edit_between_two_texts_is_no_longer_than_it_must_be() {
    for (old, new) in [
        ("", "a"),
        ("a", ""),
        ("aaa", "aa"),
        ("aa", "aaa"),
        ("a\u{3b8}b", "a\u{3b9}b"),
        ("abc", "xyz"),
        ("\u{1F600}", "\u{1F601}\u{1F600}"),
    ] {
        let edit = difference(old, new).expect("they differ");
        let mut text = old.to_owned();
        text.replace_range(edit.span.start as usize..edit.span.end as usize, &edit.text);
        assert_eq!(text, new);
    }
    assert_eq!(difference("a", "a"), None);
    let edit = difference("d(x)=1; END;", "d(x) = 1; END;").expect("they differ");
    assert_eq!(
        (edit.span, edit.text.as_str()),
        (Span { start: 4, end: 5 }, " = ")
    );
}

#[test]
fn a_text_is_formatted_unless_it_cannot_be_read() {
    let loose = DRIVE.replace("d(x) = v", "d( x )=v");
    let reading = Reading::of(loose);
    let edit = reading
        .formatted()
        .expect("it can be read")
        .expect("it is loose");
    let formatted = edited(&reading, &[edit]);
    assert!(formatted.contains("d(x) = v * cos(theta);"), "{formatted}");
    assert_eq!(Reading::of(formatted).formatted(), Ok(None));
    let refusal = Reading::of("BEGIN M d(x) = (;".to_owned())
        .formatted()
        .expect_err("mistakes")
        .to_string();
    assert!(
        refusal.starts_with("not while there are mistakes: "),
        "{refusal}"
    );
}
