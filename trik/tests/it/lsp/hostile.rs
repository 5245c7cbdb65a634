//! Frames and messages that no editor sends.

use super::{DRIVE, Server, URI, modern};
use serde_json::{Value, json};

/// The server still answers.
fn lives(server: &mut Server) {
    let answer = server.ask("nobody/knows", &json!({}));
    assert_eq!(answer["error"]["code"], -32601, "{answer}");
}

#[test]
fn frames_that_lie_cost_a_message_and_never_the_server() {
    let mut server = Server::ready(&modern());
    let header = format!("X-Long: {}\r\n", "x".repeat(1 << 20));
    let deep = "[".repeat(500_000);
    let framed = |body: &str| format!("Content-Length: {}\r\n\r\n{body}", body.len());
    for (bytes, code) in [
        ("Content-Length: minus\r\n\r\n{}".to_owned(), -32600),
        (
            "Content-Length: 99999999999999\r\n\r\n{}".to_owned(),
            -32600,
        ),
        ("Content-Length: -5\r\n\r\n".to_owned(), -32600),
        ("hello\r\n".to_owned(), -32600),
        (header, -32600),
        (framed("{"), -32700),
        (framed(&deep), -32700),
        (framed("\u{0}"), -32700),
        (framed("null"), -32600),
        (framed("[]"), -32600),
        (framed("{\"jsonrpc\":\"1.0\",\"method\":\"x\"}"), -32600),
    ] {
        server.raw(bytes.as_bytes());
        let short: String = bytes.chars().take(60).collect();
        let answer =
            server.wait(|message| message.get("method").is_none() && message["id"].is_null());
        assert_eq!(answer["error"]["code"], code, "{short}: {answer}");
        assert!(
            answer["error"]["message"]
                .as_str()
                .is_some_and(|why| why.len() > 10)
        );
        lives(&mut server);
    }
    // One byte too few: the rest is passed over up to the next header, which serves.
    let body = json!({"jsonrpc": "2.0", "method": "x"}).to_string();
    server.raw(format!("Content-Length: {}\r\n\r\n{body}", body.len() - 1).as_bytes());
    lives(&mut server);
    let said = server.goodbye();
    assert!(said.contains("a bad message: "), "{said}");
}

#[test]
fn a_message_that_is_cut_off_ends_the_talk() {
    let mut server = Server::ready(&modern());
    server.raw(b"Content-Length: 1000\r\n\r\n{\"jsonrpc\"");
    assert_eq!(server.end().0, Some(1));
}

#[test]
fn parameters_of_any_shape_are_refused_or_answered() {
    let (mut server, _) = Server::with(DRIVE, &modern());
    let documents = [
        json!(null),
        json!({}),
        json!({"uri": 7}),
        json!({"uri": URI}),
        json!({"uri": "file:///other"}),
    ];
    let positions = [
        json!(null),
        json!({"line": -1, "character": 0}),
        json!({"line": 1.5, "character": 0}),
        json!({"line": 1e300, "character": "x"}),
        json!({"line": u64::MAX, "character": u64::MAX}),
        json!({"line": 0, "character": u64::MAX}),
        json!({"line": 6, "character": 4}),
    ];
    let methods = [
        "hover",
        "completion",
        "signatureHelp",
        "definition",
        "references",
        "documentHighlight",
        "prepareRename",
        "rename",
        "documentSymbol",
        "foldingRange",
        "formatting",
        "codeAction",
        "semanticTokens/full",
        "semanticTokens/range",
    ];
    let mut asked = Vec::new();
    for method in methods {
        for document in &documents {
            for position in &positions {
                let params = json!({
                    "textDocument": document, "position": position, "newName": "name",
                    "range": {"start": position, "end": {"line": 0, "character": 0}},
                    "context": position,
                });
                asked.push(server.request(&format!("textDocument/{method}"), &params));
            }
        }
        for params in [
            json!(null),
            json!([1, 2]),
            json!("x"),
            json!({"textDocument": [], "position": [[]]}),
        ] {
            asked.push(server.request(&format!("textDocument/{method}"), &params));
        }
    }
    for id in asked {
        let answer = server.answer(&json!(id));
        let code = &answer["error"]["code"];
        assert!(
            answer.get("result").is_some() || code == -32602 || code == -32803,
            "{answer}"
        );
    }
    lives(&mut server);
    server.goodbye();
}

#[test]
fn changes_of_any_place_are_put_in_as_editors_do() {
    let (mut server, _) = Server::with(DRIVE, &modern());
    let range = |from: [u64; 2], to: [u64; 2]| json!({"start": {"line": from[0], "character": from[1]}, "end": {"line": to[0], "character": to[1]}});
    // Behind everything, from back to front, inside a pair of surrogates: what is put in there is a comment.
    server.change(
        2,
        &json!([
            {"range": range([u64::MAX, 0], [u64::MAX, u64::MAX]), "text": "// end"},
            {"range": range([1, 0], [0, u64::MAX]), "text": " more\n"},
            {"range": range([6, 4], [6, 4]), "text": "x"},
            {"range": range([0, 0], [0, 0]), "rangeLength": 99, "text": "// begin\n"},
        ]),
    );
    assert_eq!(server.diagnostics(2), json!([]));
    // A change that is none: nothing is said of the document any more, until all of it comes.
    server.change(3, &json!([{"range": 7, "text": "x"}]));
    let told = server.diagnostics(3);
    assert!(
        told[0]["message"]
            .as_str()
            .unwrap()
            .contains("open it again"),
        "{told}"
    );
    let params = json!({"textDocument": {"uri": URI}});
    assert_eq!(
        server.result("textDocument/documentSymbol", &params),
        Value::Null
    );
    server.change(4, &json!([{"text": DRIVE}]));
    assert_eq!(server.diagnostics(4), json!([]));
    let other = json!({"uri": "file:///other", "version": 9});
    server.notify(
        "textDocument/didChange",
        &json!({"textDocument": other, "contentChanges": []}),
    );
    server.notify("textDocument/didClose", &json!({"textDocument": other}));
    server.notify(
        "textDocument/didOpen",
        &json!({"textDocument": {"uri": "x".repeat(100_000), "text": ""}}),
    );
    lives(&mut server);
    let said = server.goodbye();
    assert!(
        said.contains("the document file:///other is not open"),
        "{said}"
    );
    assert!(said.len() < 2000, "{said}");
}

#[test]
fn talks_of_any_bytes_do_no_harm() {
    let seeds: &[&[u8]] = &[
        include_bytes!("../../../../fuzz/seeds/lsp/places"),
        include_bytes!("../../../../fuzz/seeds/lsp/offers"),
        include_bytes!("../../../../fuzz/seeds/lsp/whole"),
        include_bytes!("../../../../fuzz/seeds/lsp/changes"),
        include_bytes!("../../../../fuzz/seeds/lsp/bytes"),
        include_bytes!("../../../../fuzz/seeds/lsp/early"),
    ];
    harness::fuzz::run("lsp", trik::fuzz::lsp, seeds);
}
