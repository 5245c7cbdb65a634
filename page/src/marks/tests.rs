//! The page of marks as viewers see it, over a table that these tests fill.

use super::*;
use crate::client::{Socket, get};
use lang_text::problem::Words;
use serde_json::Value;
use std::io::Write;
use std::net::TcpStream;
use std::time::Duration;

/// Two pupils, one task.
fn sheet() -> MarkTable {
    MarkTable {
        name: "class".to_owned(),
        pupils: vec!["anna".to_owned(), "<script>".to_owned()],
        columns: vec![Column {
            name: "line".to_owned(),
            weight: 2.0,
        }],
        runs: 2,
        rows: vec![waiting(), waiting()],
        left_out: (vec!["x.txt is left out".to_owned()], 3),
        ..MarkTable::default()
    }
}

fn page() -> MarksPage {
    MarksPage::start("127.0.0.1:0".parse().unwrap(), sheet(), None).unwrap()
}

fn waiting() -> Row {
    Row {
        cells: vec![Cell {
            waiting: 1,
            mark: None,
        }],
        ..Row::default()
    }
}

/// One run that was judged.
fn judged(run: usize, replay: Option<&std::path::Path>) -> Row {
    let mark = Mark {
        run,
        tone: Tone::Good,
        verdict: Words::new("accomplished", "[accomplished]"),
        points: Some(5.0),
        ms: Some(1020),
        solution: "anna/line.qrs".to_owned(),
        why: String::new(),
        replay: replay.map(std::path::Path::to_owned),
    };
    Row {
        cells: vec![Cell {
            waiting: 0,
            mark: Some(mark),
        }],
        sum: 10.0,
        passed: None,
    }
}

fn cookie(page: &MarksPage) -> String {
    let answer = get(page.address(), page.path(), "");
    let line = answer
        .lines()
        .find_map(|line| line.strip_prefix("set-cookie: "));
    line.unwrap().split(';').next().unwrap().to_owned()
}

fn viewer(page: &MarksPage, language: &str) -> Socket {
    viewer_of(page, "marks", language)
}

fn viewer_of(page: &MarksPage, what: &str, language: &str) -> Socket {
    let (at, cookie) = (page.address(), cookie(page));
    let mut stream = TcpStream::connect(at).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(60)))
        .unwrap();
    let request = format!(
        "GET /socket/{what}?language={language} HTTP/1.1\r\nHost: {at}\r\nCookie: {cookie}\r\nConnection: Upgrade\r\n\
         Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
    );
    stream.write_all(request.as_bytes()).unwrap();
    let mut socket = Socket { stream };
    let head = socket.head();
    assert!(head.starts_with("HTTP/1.1 101 "), "{head}");
    socket
}

#[test]
fn marks_are_told_as_they_come_and_to_those_who_come_later_all_at_once() {
    let page = page();
    let mut early = viewer(&page, "en");
    let hello: Value = serde_json::from_str(&early.until("\"hello\"")).unwrap();
    assert_eq!(hello["pupils"][1], "<script>");
    assert_eq!(
        (&hello["columns"][0]["weight"], &hello["leftOutCount"]),
        (&2.0.into(), &3.into())
    );
    early.until("\"waiting\":1");
    page.row(0, judged(0, None));
    page.done(1);
    let row: Value = serde_json::from_str(&early.until("\"accomplished\"")).unwrap();
    assert_eq!((&row["id"], &row["sum"]), (&0.into(), &10.0.into()));
    assert!(row["cells"][0]["mark"]["replay"].is_null(), "{row}");
    // A row that the table does not have is none.
    page.row(9, judged(9, None));
    page.row(1, judged(1, None));
    page.done(2);
    page.over();
    early.until("\"over\":true");
    let mut late = viewer(&page, "ru");
    late.until_all(&["\"id\":0", "\"id\":1", "[accomplished]", "\"over\":true"]);
}

#[test]
fn a_replay_is_given_in_a_place_of_its_own_and_only_if_it_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("line.html");
    std::fs::write(&file, "<script>run()</script>").unwrap();
    let page = page();
    page.row(0, judged(7, Some(&file)));
    let at = page.address();
    let cookie = format!("Cookie: {}\r\n", cookie(&page));
    let answer = get(at, "/replay/7", &cookie);
    assert!(answer.starts_with("HTTP/1.1 200 "), "{answer}");
    assert!(answer.ends_with("<script>run()</script>"), "{answer}");
    let policy = "content-security-policy: sandbox allow-scripts; default-src 'none'";
    assert_eq!(answer.matches("content-security-policy").count(), 1);
    assert!(answer.contains(policy), "{answer}");
    for path in [
        "/replay/0",
        "/replay/8",
        "/replay/x",
        "/replay/-1",
        "/replay/../7",
    ] {
        let answer = get(at, path, &cookie);
        assert!(answer.starts_with("HTTP/1.1 404 "), "{path}: {answer}");
    }
    assert!(get(at, "/replay/7", "").starts_with("HTTP/1.1 403 "));
    std::fs::remove_file(&file).unwrap();
    let answer = get(at, "/replay/7", &cookie);
    assert!(answer.starts_with("HTTP/1.1 404 "), "{answer}");
    // What is larger than a page can be is not read.
    let large = std::fs::File::create(&file).unwrap();
    large.set_len(limits::REPLAY_BYTES_MAX + 1).unwrap();
    let answer = get(at, "/replay/7", &cookie);
    assert!(answer.starts_with("HTTP/1.1 422 "), "{answer}");
}

#[test]
fn nothing_is_given_to_pages_of_others() {
    let page = page();
    let at = page.address();
    assert!(get(at, "/", "").starts_with("HTTP/1.1 307 "));
    for (path, headers) in [
        ("/socket/marks", ""),
        ("/replay/0", "Cookie: trik=guessed\r\n"),
        ("/marks", "Origin: http://evil.example\r\n"),
    ] {
        let answer = get(at, path, headers);
        assert!(answer.starts_with("HTTP/1.1 403 "), "{path}: {answer}");
        assert!(!answer.contains("set-cookie"), "{answer}");
    }
    let answer = get(at, "/marks", "");
    let policy = "content-security-policy: default-src 'none'; script-src 'self'";
    assert!(answer.contains(policy), "{answer}");
}

#[test]
fn with_a_class_the_robots_are_on_the_same_page_and_marks_alone_on_their_own() {
    let class = |name: &str| ClassSettings {
        name: name.to_owned(),
        robots: Vec::new(),
        guests: Arc::new(Everybody),
    };
    let at = "127.0.0.1:0".parse().unwrap();
    let page = MarksPage::start(at, sheet(), Some(class("room"))).unwrap();
    assert_eq!(page.path(), "/class");
    let root = get(page.address(), "/", "");
    assert!(root.contains("location: /class\r\n"), "{root}");
    let hello = viewer_of(&page, "class", "en").until("\"hello\"");
    let hello: Value = serde_json::from_str(&hello).unwrap();
    assert_eq!(
        (&hello["name"], &hello["marks"]),
        (&"room".into(), &true.into())
    );
    viewer_of(&page, "marks", "en").until("\"waiting\":1");
    let alone = get(page.address(), "/marks", "");
    assert!(alone.contains("set-cookie: "), "{alone}");
    // Marks without robots have no page of robots.
    let other = self::page();
    assert!(get(other.address(), "/class", "").starts_with("HTTP/1.1 404 "));
}
