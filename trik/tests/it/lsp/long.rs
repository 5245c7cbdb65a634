//! Long documents and many changes: bounded, whatever they are.

use super::{DRIVE, Server, URI, modern};
use serde_json::{Value, json};

/// A model of so many lines.
fn lines(count: usize) -> String {
    let mut text = "BEGIN Long\nACTION: u;\nPARAM: k;\nCONFIG: x;\nVAR: v0".to_owned();
    for at in 1..count {
        text.push_str(&format!(", v{at}"));
    }
    text.push_str(";\nv0 = u;\n");
    for at in 1..count {
        text.push_str(&format!("v{at} = k / 2 * (v{} + u) * cos(x);\n", at - 1));
    }
    text.push_str(&format!("d(x) = v{};\nEND;\n", count - 1));
    text
}

#[test]
fn ten_thousand_changes_at_once_are_put_in() {
    let text = lines(10_000);
    let (mut server, told) = Server::with(&text, &modern());
    assert_eq!(told, json!([]));
    let change = |line: usize| {
        let at = json!({"line": line, "character": 0});
        json!({"range": {"start": at, "end": at}, "text": "/**/ "})
    };
    let changes: Vec<Value> = (0..10_000).map(|at| change(5 + at)).collect();
    server.change(2, &json!(changes));
    assert_eq!(server.diagnostics(2), json!([]));
    let params = json!({"textDocument": {"uri": URI}, "position": {"line": 9000, "character": 6}});
    let hover = server.result("textDocument/hover", &params);
    assert_eq!(hover["range"]["start"]["character"], 5, "{hover}");
    server.goodbye();
}

#[test]
fn a_document_of_thirty_megabytes_is_served_and_a_longer_one_is_refused() {
    let one = DRIVE.replace("theta in S1", "theta");
    let text = format!("/* {} */\n{one}", "x".repeat(30 << 20));
    let (mut server, told) = Server::with(&text, &modern());
    assert_eq!(told, json!([]));
    let end = json!({"line": 9, "character": 0});
    server.change(
        2,
        &json!([{"range": {"start": end, "end": end}, "text": "nonsense\n"}]),
    );
    assert_ne!(server.diagnostics(2), json!([]));
    // Only what is wrong is known of a text of this length.
    let params = json!({"textDocument": {"uri": URI}});
    assert_eq!(
        server.result("textDocument/semanticTokens/full", &params)["data"],
        json!([])
    );
    server.change(
        3,
        &json!([{"range": {"start": end, "end": end}, "text": "x".repeat(3 << 20)}]),
    );
    let told = server.diagnostics(3);
    assert_eq!(told[0]["code"], "too-long", "{told}");
    server.change(4, &json!([{"text": DRIVE}]));
    assert_eq!(server.diagnostics(4), json!([]));
    server.goodbye();
}
