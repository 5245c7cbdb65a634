//! How long the language server has an editor wait: one change of a document of ten thousand lines, up to its diagnostics.
//!
//! `cargo bench -p trik --bench lsp`. The real program over its real streams, in release; what is counted is the time that
//! its threads have had a processor, so that others' work does not count. The goal is 50 ms for a change.

use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
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

/// A server with its streams.
struct Server {
    process: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

impl Server {
    fn start() -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_trik"))
            .args(["dcml", "lsp"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the server");
        Self {
            to: process.stdin.take().expect("its input"),
            from: BufReader::new(process.stdout.take().expect("its output")),
            process,
        }
    }

    fn notify(&mut self, method: &str, params: Value) {
        let message = json!({"jsonrpc": "2.0", "method": method, "params": params});
        send(&mut self.to, &message);
    }

    fn ask(&mut self, method: &str, params: Value) {
        let message = json!({"jsonrpc": "2.0", "id": 1, "method": method, "params": params});
        send(&mut self.to, &message);
        let answer = receive(&mut self.from);
        assert!(answer.get("result").is_some(), "{answer}");
    }
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn changes(server: &mut Server, bytes: usize) {
    let mut worst = (Duration::ZERO, Duration::ZERO);
    let mut sum = Duration::ZERO;
    for version in 1..=CHANGES {
        let place = json!({"line": 100 * version, "character": 0});
        // Every other change is a mistake, as while somebody writes.
        let put = if version % 2 == 1 { "w = 1; " } else { "/**/ " };
        let change = json!({"range": {"start": place, "end": place}, "text": put});
        let params =
            json!({"textDocument": {"uri": URI, "version": version}, "contentChanges": [change]});
        let (begin, clock) = (used(&server.process), Instant::now());
        server.notify("textDocument/didChange", params);
        let told = receive(&mut server.from);
        let (took, waited) = (used(&server.process) - begin, clock.elapsed());
        assert_eq!(told["params"]["version"], version);
        let diagnostics = told["params"]["diagnostics"].as_array();
        assert!(diagnostics.is_some_and(|all| !all.is_empty()));
        sum += took;
        worst = (worst.0.max(took), worst.1.max(waited));
    }
    let mean = ms(sum) / f64::from(CHANGES);
    println!(
        "change of {LINES} lines ({bytes} bytes): mean {mean:.1} ms, worst {:.1} ms of a processor ({:.1} ms by the clock); goal / mean {:.2}",
        ms(worst.0),
        ms(worst.1),
        GOAL_MS / mean
    );
}

fn main() {
    // `cargo test` starts benches too, with nothing to measure.
    if std::env::args().any(|word| word == "--test") {
        return;
    }
    let mut server = Server::start();
    server.ask("initialize", json!({"capabilities": {}}));
    let text = model();
    let document = json!({"uri": URI, "languageId": "dcml", "version": 0, "text": text});
    server.notify("textDocument/didOpen", json!({"textDocument": document}));
    receive(&mut server.from);
    changes(&mut server, text.len());
    let place = json!({"textDocument": {"uri": URI}, "position": {"line": 5000, "character": 1}});
    for method in [
        "hover",
        "completion",
        "references",
        "semanticTokens/full",
        "documentSymbol",
    ] {
        let begin = used(&server.process);
        server.ask(&format!("textDocument/{method}"), place.clone());
        println!("{method}: {:.1} ms", ms(used(&server.process) - begin));
    }
    server.ask("shutdown", Value::Null);
    server.notify("exit", Value::Null);
    assert!(server.process.wait().expect("it ends").success());
}
