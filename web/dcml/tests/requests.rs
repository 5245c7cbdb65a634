//! What a page asks of a text with models: answers, and refusals of rubbish.

use serde_json::{Value, json};
use web_dcml::course::solve;
use web_dcml::failure::Failure;
use web_dcml::limits;
use web_dcml::text::{Text, shipped};

const CART: &str = "/* A cart on a line: \u{1f916}. */\nBEGIN cart\nACTION: v [m/s];\nPARAM: r;\nCONFIG: x [m];\nd(x) = v * r;\nEND;\n";

fn read(text: &str) -> Text {
    Text::read(text.to_owned()).expect("a text")
}

/// The place of the last letters like these, as JavaScript counts.
fn place(text: &str, word: &str) -> u32 {
    let at = text.rfind(word).expect("the word");
    text[..at].encode_utf16().count() as u32
}

#[test]
fn a_model_is_understood_written_and_solved() {
    let text = read(CART);
    assert_eq!(text.diagnostics(false), json!([]));
    let models = text.models();
    assert_eq!(models[0]["name"], "cart");
    assert_eq!(
        models[0]["names"][0],
        json!({"name": "v", "kind": "action", "unit": "m/s"})
    );
    let code = text.generate("python", None, false).expect("a text");
    assert!(code.contains("def "), "{code}");
    let options = json!({
        "params": {"r": 0.5},
        "start": {"x": 1},
        "actions": [{"at": 0, "v": 2}, {"at": 3, "v": -4}],
        "seconds": 4,
        "every": 1,
    });
    let solved = solve(&text, &options.to_string()).expect("a solution");
    assert_eq!(solved["columns"][1], json!({"name": "x", "unit": "m"}));
    let xs: Vec<f64> = (solved["rows"].as_array().unwrap().iter())
        .map(|row| row[1].as_f64().unwrap())
        .collect();
    assert_eq!(xs.len(), 5);
    for (x, wanted) in xs.iter().zip([1.0, 2.0, 3.0, 4.0, 2.0]) {
        assert!((x - wanted).abs() < 1e-6, "{xs:?}");
    }
}

#[test]
fn an_editor_is_told_of_words_in_units_of_javascript() {
    let text = read(CART);
    let use_of_r = place(CART, "r;");
    let declared = place(CART, "r;\nCONFIG:");
    assert_eq!(text.definition(use_of_r), json!([declared, declared + 1]));
    assert_eq!(text.references(use_of_r).as_array().unwrap().len(), 2);
    let hover = text.hover(use_of_r);
    assert!(hover["code"].as_str().unwrap().contains("r"), "{hover}");
    let edits = text.rename(use_of_r, "radius").expect("edits");
    assert_eq!(edits.as_array().unwrap().len(), 2);
    assert_eq!(
        edits[1],
        json!({"at": [use_of_r, use_of_r + 1], "text": "radius"})
    );
    assert!(matches!(
        text.rename(use_of_r, "1r"),
        Err(Failure::Refused(_))
    ));
    let offers = text.complete(use_of_r);
    assert!(
        offers["offers"]
            .as_array()
            .unwrap()
            .iter()
            .any(|one| one["label"] == "r")
    );
    assert_eq!(text.symbols()[0]["name"], "cart");
    let words = text.colours(0, u32::MAX);
    assert!(
        words
            .as_array()
            .unwrap()
            .iter()
            .any(|one| one["is"] == "comment")
    );
    assert_eq!(text.hover(u32::MAX), Value::Null);
}

#[test]
fn mistakes_have_places_and_mends() {
    let wrong = CART.replace("v * r", "v * rr");
    let text = read(&wrong);
    let found = text.diagnostics(false);
    let at = place(&wrong, "rr");
    assert_eq!(found[0]["at"], json!([at, at + 2]), "{found}");
    assert_eq!(
        (&found[0]["severity"], &found[0]["line"]),
        (&json!("error"), &json!(6))
    );
    assert!(!text.fixes(at, at + 1).as_array().unwrap().is_empty());
    assert_eq!(text.generate("c", None, false), Err(Failure::Mistakes));
    // Units are not in the published language.
    assert!(!read(CART).diagnostics(true).as_array().unwrap().is_empty());
}

#[test]
fn what_cannot_be_asked_is_refused_in_words() {
    let text = read(CART);
    assert!(matches!(
        text.generate("cobol", None, false),
        Err(Failure::Language(_))
    ));
    assert!(matches!(
        text.model(Some("boat")),
        Err(Failure::NoModel(..))
    ));
    assert!(matches!(read("").model(None), Err(Failure::NoModel(..))));
    let twice = format!("{CART}{}", CART.replace("cart", "boat"));
    assert!(matches!(read(&twice).model(None), Err(Failure::Several(names)) if names.len() == 2));
    for (options, words) in [
        ("", "options"),
        ("[]", "options"),
        ("{}", "seconds"),
        (r#"{"seconds": -1}"#, "seconds"),
        (r#"{"seconds": 1, "every": 1e-9}"#, "every"),
        (r#"{"seconds": 1, "frob": 1}"#, "frob"),
        (r#"{"seconds": 1}"#, "r is missing"),
        (r#"{"seconds": 1, "params": {"r": "1"}}"#, "r is no number"),
        (r#"{"seconds": 1, "params": {"r": 1, "q": 1}}"#, "no \"q\""),
        (
            r#"{"seconds": 1, "params": {"r": 1}, "method": "rk9"}"#,
            "rk45",
        ),
        (
            r#"{"seconds": 1, "params": {"r": 1}, "actions": [{"v": 1}]}"#,
            "actions",
        ),
        (
            r#"{"seconds": 1, "params": {"r": 1}, "actions": [{"at": 1}, {"at": 1}]}"#,
            "later",
        ),
    ] {
        let refused = solve(&text, options).expect_err(options);
        assert_eq!(refused.kind(), "request", "{options}");
        assert!(
            refused.sentence().contains(words),
            "{options}: {}",
            refused.sentence()
        );
    }
    let long = format!(
        "{{\"seconds\": 1, \"x\": \"{}\"}}",
        "x".repeat(limits::OPTIONS_BYTES_MAX)
    );
    assert!(matches!(solve(&text, &long), Err(Failure::Request(_))));
    let steps = r#"{"seconds": 1e9, "params": {"r": 1}, "method": "euler", "step": 1e-6}"#;
    assert!(matches!(solve(&text, steps), Err(Failure::Solution(_))));
}

#[test]
fn shipped_models_are_right() {
    let all = shipped();
    let all = all.as_array().expect("models");
    assert!(all.len() > 5);
    for one in all {
        let text = read(one["text"].as_str().expect("a text"));
        let errors = text.diagnostics(false);
        let errors = errors.as_array().expect("findings");
        assert!(
            errors.iter().all(|one| one["severity"] != "error"),
            "{errors:?}"
        );
        assert_eq!(
            text.format().expect("a layout"),
            Value::Null,
            "{}",
            one["name"]
        );
    }
}
