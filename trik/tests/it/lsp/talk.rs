//! A talk from beginning to end.

use super::{DRIVE, Server, URI, at, edited, modern, place_of};
use serde_json::{Value, json};

#[test]
fn an_editor_opens_changes_asks_and_says_goodbye() {
    let (mut server, told) = Server::with(DRIVE, &modern());
    assert_eq!(told, json!([]));
    // Behind signs of two and of four bytes on the same line.
    let theta = at(DRIVE, "theta", 3);
    assert_eq!(theta["position"]["character"], 12);
    let hover = server.result("textDocument/hover", &theta);
    let shown = hover["contents"]["value"].as_str().unwrap_or_default();
    assert!(
        shown.contains("CONFIG theta in S1") && shown.contains("Heading \u{3b8}."),
        "{hover}"
    );
    assert_eq!(hover["contents"]["kind"], "markdown");
    assert_eq!(hover["range"]["start"], theta["position"]);
    let definition = server.result("textDocument/definition", &theta);
    let declared = place_of(DRIVE, DRIVE.find("theta").unwrap());
    assert_eq!(
        (&definition["range"]["start"], &definition["uri"]),
        (&declared, &json!(URI))
    );
    for (with_declaration, count) in [(true, 4), (false, 3)] {
        let mut params = theta.clone();
        params["context"] = json!({"includeDeclaration": with_declaration});
        let places = server.result("textDocument/references", &params);
        assert_eq!(places.as_array().map(Vec::len), Some(count), "{places}");
    }
    let marks = server.result("textDocument/documentHighlight", &theta);
    let kinds: Vec<&Value> = marks
        .as_array()
        .unwrap()
        .iter()
        .map(|one| &one["kind"])
        .collect();
    assert_eq!(kinds, [3, 2, 2, 3]);
    let range = server.result("textDocument/prepareRename", &theta);
    assert_eq!(range["start"], theta["position"]);
    let mut params = theta.clone();
    params["newName"] = json!("heading");
    let edit = server.result("textDocument/rename", &params);
    let changes = &edit["documentChanges"][0];
    assert_eq!(changes["textDocument"], json!({"uri": URI, "version": 1}));
    assert_eq!(
        edited(DRIVE, &changes["edits"]),
        DRIVE.replace("theta", "heading")
    );
    params["newName"] = json!("sin");
    let refusal = server.ask("textDocument/rename", &params);
    assert_eq!(refusal["error"]["code"], -32803);
    assert!(
        refusal["error"]["message"]
            .as_str()
            .unwrap()
            .contains("`sin`"),
        "{refusal}"
    );
    assert_eq!(server.goodbye(), "");
}

#[test]
fn diagnostics_follow_each_change_with_code_place_and_other_places() {
    let (mut server, _) = Server::with(DRIVE, &modern());
    // Behind the comment of two and of four bytes: the name that is put in begins at unit 9.
    let place = json!({"line": 6, "character": 9});
    server.change(
        2,
        &json!([{"range": {"start": place, "end": place}, "text": "x = thata; "}]),
    );
    let told = server.diagnostics(2);
    let codes: Vec<&str> = told
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["code"].as_str().unwrap())
        .collect();
    assert!(
        codes.contains(&"undeclared-name") && codes.contains(&"duplicate-equation"),
        "{told}"
    );
    for one in told.as_array().unwrap() {
        assert_eq!(
            (&one["source"], &one["severity"]),
            (&json!("dcml"), &json!(1))
        );
        if one["code"] == "undeclared-name" {
            let range =
                json!({"start": {"line": 6, "character": 13}, "end": {"line": 6, "character": 18}});
            assert_eq!(one["range"], range);
            assert!(one["message"].as_str().unwrap().contains("theta"), "{one}");
        } else {
            assert_eq!(
                one["relatedInformation"][0]["location"]["uri"], URI,
                "{one}"
            );
        }
    }
    what_is_offered_mends(&mut server);
    // All of the text, and then closed: nothing is left of it.
    server.change(4, &json!([{"text": DRIVE}]));
    assert_eq!(server.diagnostics(4), json!([]));
    server.change(5, &json!([{"text": "BEGIN"}]));
    assert_ne!(server.diagnostics(5), json!([]));
    let closed = json!({"textDocument": {"uri": URI}});
    server.notify("textDocument/didClose", &closed);
    let last = server.wait(|message| message["method"] == "textDocument/publishDiagnostics");
    assert_eq!(last["params"], json!({"uri": URI, "diagnostics": []}));
    let gone = server.ask("textDocument/documentSymbol", &closed);
    assert_eq!(gone["error"]["code"], -32602);
    server.goodbye();
}

fn what_is_offered_mends(server: &mut Server) {
    // What the editor offers as a fix makes it one error less.
    let range = json!({"start": {"line": 6, "character": 14}, "end": {"line": 6, "character": 14}});
    let params =
        json!({"textDocument": {"uri": URI}, "range": range, "context": {"diagnostics": []}});
    let fixes = server.result("textDocument/codeAction", &params);
    let fix = fixes
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["title"] == "Change to `theta`");
    let fix = fix.unwrap_or_else(|| panic!("{fixes}"));
    assert_eq!(
        (&fix["kind"], &fix["isPreferred"]),
        (&json!("quickfix"), &json!(true))
    );
    let edit = &fix["edit"]["documentChanges"][0]["edits"][0];
    server.change(
        3,
        &json!([{"range": edit["range"], "text": edit["newText"]}]),
    );
    let told = server.diagnostics(3);
    assert!(
        told.as_array()
            .unwrap()
            .iter()
            .all(|one| one["code"] != "undeclared-name"),
        "{told}"
    );
}

#[test]
fn what_is_offered_can_be_put_in() {
    let text = DRIVE.replace("cos(theta)", "");
    let (mut server, _) = Server::with(&text, &modern());
    let mut params = at(&text, ";\nd(y)", 0);
    let offered = server.result("textDocument/completion", &params);
    let items = offered["items"].as_array().unwrap();
    assert_eq!(offered["isIncomplete"], false);
    let find = |label: &str| {
        let mut found = items.iter().filter(|one| one["label"] == label);
        found.next().unwrap_or_else(|| panic!("{label}: {offered}"))
    };
    assert_eq!(find("theta")["detail"], "configuration in S1");
    assert_eq!(
        find("theta")["documentation"].as_str().map(str::trim),
        Some("Heading \u{3b8}.")
    );
    let cosine = find("cos");
    assert_eq!(
        (&cosine["insertTextFormat"], &cosine["kind"]),
        (&json!(2), &json!(3))
    );
    assert_eq!(cosine["textEdit"]["newText"], "cos(${1:x})$0");
    assert_eq!(cosine["textEdit"]["range"]["start"], params["position"]);
    let start = params["position"].clone();
    server.change(
        2,
        &json!([{"range": {"start": start, "end": start}, "text": "atan2(1, "}]),
    );
    params["position"]["character"] = json!(start["character"].as_u64().unwrap() + 9);
    let help = server.result("textDocument/signatureHelp", &params);
    assert_eq!(help["activeParameter"], 1, "{help}");
    assert_eq!(help["signatures"][0]["label"], "atan2(y, x)");
    assert_eq!(
        help["signatures"][0]["parameters"][1]["label"],
        json!([9, 10])
    );
    server.goodbye();
}

#[test]
fn the_outline_folds_and_colours_of_a_document_are_told() {
    let (mut server, _) = Server::with(DRIVE, &modern());
    let document = json!({"textDocument": {"uri": URI}});
    let symbols = server.result("textDocument/documentSymbol", &document);
    assert_eq!(symbols[0]["name"], "Drive");
    assert_eq!(
        symbols[0]["children"].as_array().map(Vec::len),
        Some(10),
        "{symbols}"
    );
    let folds = server.result("textDocument/foldingRange", &document);
    assert_eq!(folds, json!([{"startLine": 0, "endLine": 7}]));
    let tokens = server.result("textDocument/semanticTokens/full", &document);
    let data: Vec<u64> = tokens["data"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one.as_u64().unwrap())
        .collect();
    assert_eq!(data.len() % 5, 0);
    // BEGIN is a keyword, Drive a class that is declared here, then the comment in units of UTF-16.
    assert_eq!(data[..15], [0, 0, 5, 0, 4, 0, 6, 5, 1, 1, 0, 6, 13, 9, 0]);
    let mut params = document.clone();
    params["range"] =
        json!({"start": {"line": 4, "character": 0}, "end": {"line": 5, "character": 0}});
    let part = server.result("textDocument/semanticTokens/range", &params);
    assert_eq!(part["data"][0], 4);
    assert_eq!(part["data"].as_array().map(Vec::len), Some(5 * 8));
    server.goodbye();
}

#[test]
fn a_document_is_formatted_by_edits() {
    let loose = DRIVE.replace("d(x) = ", "d( x )=");
    let (mut server, _) = Server::with(&loose, &modern());
    let params =
        json!({"textDocument": {"uri": URI}, "options": {"tabSize": 2, "insertSpaces": true}});
    let edits = server.result("textDocument/formatting", &params);
    let formatted = edited(&loose, &edits);
    assert!(formatted.contains("d(x) = r / 2"), "{formatted}");
    server.change(2, &json!([{"text": formatted}]));
    assert_eq!(server.diagnostics(2), json!([]));
    assert_eq!(server.result("textDocument/formatting", &params), json!([]));
    server.goodbye();
}

#[test]
fn an_old_editor_gets_plain_texts_lists_and_names() {
    let (mut server, _) = Server::with(DRIVE, &json!({}));
    let hover = server.result("textDocument/hover", &at(DRIVE, "cos", 0));
    assert_eq!(hover["contents"]["kind"], "plaintext");
    let document = json!({"textDocument": {"uri": URI}});
    let symbols = server.result("textDocument/documentSymbol", &document);
    assert_eq!(symbols[1]["containerName"], "Drive");
    assert_eq!(symbols[1]["location"]["uri"], URI);
    let offered = server.result("textDocument/completion", &at(DRIVE, "cos", 0));
    for one in offered["items"].as_array().unwrap() {
        assert_eq!(one["insertTextFormat"], 1, "{one}");
        assert!(
            !one["textEdit"]["newText"].as_str().unwrap().contains('$'),
            "{one}"
        );
    }
    let mut params = at(DRIVE, "theta", 0);
    params["newName"] = json!("heading");
    let edit = server.result("textDocument/rename", &params);
    assert_eq!(
        edited(DRIVE, &edit["changes"][URI]),
        DRIVE.replace("theta", "heading")
    );
    server.goodbye();
}

#[test]
fn columns_are_bytes_if_the_editor_counts_bytes() {
    let capabilities = json!({"general": {"positionEncodings": ["utf-32", "utf-8", "utf-16"]}});
    let mut server = Server::start();
    let begun = server.result("initialize", &json!({"capabilities": capabilities}));
    assert_eq!(begun["capabilities"]["positionEncoding"], "utf-8");
    server.notify("initialized", &json!({}));
    server.open(DRIVE);
    assert_eq!(server.diagnostics(1), json!([]));
    let line = DRIVE.lines().nth(6).unwrap();
    let column = line.find("theta").unwrap();
    let params =
        json!({"textDocument": {"uri": URI}, "position": {"line": 6, "character": column}});
    let hover = server.result("textDocument/hover", &params);
    assert_eq!(hover["range"]["end"]["character"], column + 5);
    server.goodbye();
}

#[test]
fn the_order_of_a_life_is_kept() {
    let mut server = Server::start();
    let early = server.ask("textDocument/hover", &json!({}));
    assert_eq!(early["error"]["code"], -32002);
    // Nobody hears what is told before.
    server.open("BEGIN");
    let begun = server.result("initialize", &json!({"capabilities": {}}));
    assert_eq!(begun["serverInfo"]["name"], "trik dcml lsp");
    assert_eq!(begun["capabilities"]["positionEncoding"], "utf-16");
    assert_eq!(
        server.ask("initialize", &json!({}))["error"]["code"],
        -32600
    );
    assert_eq!(
        server.ask("no/such/thing", &json!({}))["error"]["code"],
        -32601
    );
    assert_eq!(server.ask("$/nosuch", &json!({}))["error"]["code"], -32601);
    server.notify("$/setTrace", &json!({"value": "off"}));
    server.notify(
        "workspace/didChangeConfiguration",
        &json!({"settings": null}),
    );
    assert_eq!(server.result("shutdown", &Value::Null), Value::Null);
    assert_eq!(
        server.ask("shutdown", &Value::Null)["error"]["code"],
        -32600
    );
    server.notify("exit", &Value::Null);
    assert!(server.kept.is_empty(), "{:?}", server.kept);
    assert_eq!(server.end(), (Some(0), String::new()));
    // Without shutdown, and without a word.
    let mut server = Server::ready(&json!({}));
    server.notify("exit", &Value::Null);
    assert_eq!(server.end().0, Some(1));
    assert_eq!(Server::ready(&json!({})).end().0, Some(1));
}

#[test]
fn a_request_that_is_taken_back_or_outrun_is_told_so() {
    // A long document keeps the server busy while the rest comes.
    let long = DRIVE.repeat(2000);
    let mut server = Server::ready(&modern());
    let document = json!({"textDocument": {"uri": URI}});
    let mut bytes = Vec::new();
    let opened = json!({"uri": URI, "languageId": "dcml", "version": 1, "text": long});
    let all = [
        json!({"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"textDocument": opened}}),
        json!({"jsonrpc": "2.0", "id": "keep", "method": "textDocument/documentSymbol", "params": document}),
        json!({"jsonrpc": "2.0", "id": "drop", "method": "textDocument/hover", "params": at(DRIVE, "cos", 0)}),
        json!({"jsonrpc": "2.0", "method": "$/cancelRequest", "params": {"id": "drop"}}),
        json!({"jsonrpc": "2.0", "id": "late", "method": "textDocument/documentSymbol", "params": document}),
        json!({"jsonrpc": "2.0", "method": "textDocument/didChange",
            "params": {"textDocument": {"uri": URI, "version": 2}, "contentChanges": [{"text": DRIVE}]}}),
    ];
    for message in &all {
        bytes.extend(super::framed(message));
    }
    server.raw(&bytes);
    // Both ways to be answered are right, as it is not known how fast the server is; nothing else is.
    for (id, code) in [("keep", -32801), ("drop", -32800), ("late", -32801)] {
        let answer = server.answer(&json!(id));
        let is_done = answer.get("result").is_some();
        assert!(is_done || answer["error"]["code"] == code, "{answer}");
    }
    assert_eq!(server.diagnostics(2), json!([]));
    server.goodbye();
}
