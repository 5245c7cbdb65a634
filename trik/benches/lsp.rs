//! How long the language server has an editor wait: one change of a document of ten thousand lines, up to its diagnostics.
//!
//! `cargo bench -p trik --bench lsp`. The real program over its real streams, in release; what is counted is the time that
//! its threads have had a processor, so that others' work does not count. The goal is 50 ms for a change.

use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const LINES: usize = 10_000;
const CHANGES: u32 = 30;
const GOAL_MS: f64 = 50.0;
const URI: &str = "file:///long.dcml";

/// A model of so many lines.
fn model() -> String {
    let mut text = "BEGIN Long\nACTION: u;\nPARAM: k;\nCONFIG: x;\nVAR: v0".to_owned();
    for at in 1..LINES {
        let _ = write!(text, ", v{at}");
    }
    text.push_str(";\nv0 = u;\n");
    for at in 1..LINES {
        let _ = writeln!(text, "v{at} = k / 2 * (v{} + u) * cos(x);", at - 1);
    }
    let _ = writeln!(text, "d(x) = v{};\nEND;", LINES - 1);
    text
}

/// How long all threads of a process have had a processor.
fn used(process: &Child) -> Duration {
    let tasks = std::fs::read_dir(format!("/proc/{}/task", process.id()))
        .into_iter()
        .flatten();
    let nanos = tasks.flatten().filter_map(|task| {
        let told = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        told.split(' ').next()?.parse::<u64>().ok()
    });
    Duration::from_nanos(nanos.sum())
}

fn send(to: &mut impl Write, message: &Value) {
    let body = message.to_string();
    write!(to, "Content-Length: {}\r\n\r\n{body}", body.len()).expect("it reads");
    to.flush().expect("it reads");
}

fn receive(from: &mut impl BufRead) -> Value {
    let mut header = String::new();
    from.read_line(&mut header).expect("a header");
    let length = header
        .trim()
        .rsplit(' ')
        .next()
        .and_then(|text| text.parse().ok());
    from.read_line(&mut header).expect("its end");
    let mut body = vec![0; length.expect("a length")];
    from.read_exact(&mut body).expect("a body");
    serde_json::from_slice(&body).expect("JSON")
}

fn main() {
    // `cargo test` starts benches too, with nothing to measure.
    if std::env::args().any(|word| word == "--test") {
        return;
    }
    let mut process = Command::new(env!("CARGO_BIN_EXE_trik"))
        .args(["dcml", "lsp"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the server");
    let mut to = process.stdin.take().expect("its input");
    let mut from = BufReader::new(process.stdout.take().expect("its output"));
    let request = |id: u32, method: &str, params: Value| json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params});
    let news =
        |method: &str, params: Value| json!({"jsonrpc": "2.0", "method": method, "params": params});
    send(
        &mut to,
        &request(0, "initialize", json!({"capabilities": {}})),
    );
    receive(&mut from);
    let text = model();
    let opened =
        json!({"textDocument": {"uri": URI, "languageId": "dcml", "version": 0, "text": text}});
    send(&mut to, &news("textDocument/didOpen", opened));
    receive(&mut from);
    let mut worst = (Duration::ZERO, Duration::ZERO);
    let mut sum = Duration::ZERO;
    for version in 1..=CHANGES {
        let place = json!({"line": 100 * version, "character": 0});
        // Every other change is a mistake, as while somebody writes.
        let put = if version % 2 == 1 { "w = 1; " } else { "/**/ " };
        let change = json!({"range": {"start": place, "end": place}, "text": put});
        let params =
            json!({"textDocument": {"uri": URI, "version": version}, "contentChanges": [change]});
        let (begin, clock) = (used(&process), Instant::now());
        send(&mut to, &news("textDocument/didChange", params));
        let told = receive(&mut from);
        let (took, waited) = (used(&process) - begin, clock.elapsed());
        assert_eq!(told["params"]["version"], version);
        assert!(
            !told["params"]["diagnostics"]
                .as_array()
                .expect("a list")
                .is_empty()
        );
        sum += took;
        worst = (worst.0.max(took), worst.1.max(waited));
    }
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    let mean = ms(sum) / f64::from(CHANGES);
    println!(
        "change of {LINES} lines ({} bytes): mean {mean:.1} ms, worst {:.1} ms of a processor ({:.1} ms by the clock); goal / mean {:.2}",
        text.len(),
        ms(worst.0),
        ms(worst.1),
        GOAL_MS / mean
    );
    let document =
        json!({"textDocument": {"uri": URI}, "position": {"line": 5000, "character": 1}});
    for (id, method) in [
        "hover",
        "completion",
        "references",
        "semanticTokens/full",
        "documentSymbol",
    ]
    .iter()
    .enumerate()
    {
        let begin = used(&process);
        let id = u32::try_from(id + 1).expect("few");
        send(
            &mut to,
            &request(id, &format!("textDocument/{method}"), document.clone()),
        );
        let answer = receive(&mut from);
        assert!(answer.get("result").is_some(), "{answer}");
        println!("{method}: {:.1} ms", ms(used(&process) - begin));
    }
    send(&mut to, &request(99, "shutdown", Value::Null));
    receive(&mut from);
    send(&mut to, &news("exit", Value::Null));
    assert!(process.wait().expect("it ends").success());
}
