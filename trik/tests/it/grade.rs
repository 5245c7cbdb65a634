//! `trik grade-worker` with a real server of NATS: workers and servers that are killed, and submissions that cannot be judged.
//!
//! Owns the server. What it holds is read by `trik grade-status` and `trik grade-submit --wait`.

use crate::programs::Running;
use crate::rig::{TRIK, loopback};
use harness::{Board, eventually};
use needs::Need;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

const PORT: u16 = 4222;

/// A server that is killed with the test, in a folder that has the tasks too.
struct Server {
    process: Child,
    program: PathBuf,
    ip: String,
    place: Board,
}

impl Server {
    /// None if it is not installed. Has the task `road` of `trik new-task`.
    fn new() -> Option<Self> {
        let paths = std::env::var_os("PATH").unwrap_or_default();
        let places = std::env::split_paths(&paths).chain([Path::new("/usr/sbin").to_owned()]);
        let program = places
            .map(|place| place.join("nats-server"))
            .find(|path| path.is_file());
        let Some(program) = program else {
            Need::Tools.missing("nats-server is not installed");
            return None;
        };
        let place = Board::new();
        let ip = loopback();
        let process = started(&program, &ip, &place);
        let server = Self {
            process,
            program,
            ip,
            place,
        };
        assert!(server.trik(&["new-task", "made"]).0 == 0);
        let of = |name: &str| server.place.path(name);
        fs::create_dir(of("tasks")).unwrap();
        fs::copy(of("made/world.xml"), of("tasks/road.xml")).unwrap();
        Some(server)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(TRIK);
        command.current_dir(self.place.path(".")).args(words);
        if words[0].starts_with("grade-") {
            command.args(["--server", &self.ip]);
        }
        command
    }

    /// The exit status of a command, and what it prints.
    fn trik(&self, words: &[&str]) -> (i32, String) {
        let output = self.command(words).output().expect("trik");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        (output.status.code().unwrap_or(-1), text)
    }

    fn worker(&self, words: &[&str]) -> Running {
        let all = [&["grade-worker", "--tasks", "tasks"], words].concat();
        let worker = Running::new(&mut self.command(&all));
        worker.says("at once: road");
        worker
    }

    /// The counts of `trik grade-status`; None while the server does not answer.
    fn state(&self) -> Option<[u64; 4]> {
        let (code, text) = self.trik(&["grade-status"]);
        let counts = text
            .lines()
            .filter_map(|line| line.rsplit(' ').next()?.parse().ok());
        let counts: Vec<u64> = counts.take(4).collect();
        (code == 0).then(|| counts.try_into().expect("four counts"))
    }

    /// A program that is like no other.
    fn program(&self, name: &str, of: &str, number: usize) -> String {
        let text = fs::read_to_string(self.place.path(of)).unwrap();
        self.place.file(name, format!("{text}\n// {number}\n"));
        name.to_owned()
    }
}

fn started(program: &Path, ip: &str, place: &Board) -> Child {
    let child = Command::new(program)
        .args([
            "--jetstream",
            "--store_dir",
            "kept",
            "-a",
            ip,
            "-p",
            &PORT.to_string(),
        ])
        .current_dir(place.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("nats-server");
    eventually("a server", || TcpStream::connect((ip, PORT)).is_ok());
    child
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn results(text: &str) -> Vec<Value> {
    let lines = text.lines().map(serde_json::from_str);
    lines.collect::<Result<_, _>>().expect("JSON")
}

#[test]
fn a_submission_is_judged_as_by_trik_check_and_once_however_often_it_comes() {
    let Some(server) = Server::new() else { return };
    let good = ["grade-submit", "made/solution.js", "--task", "road"];
    let (code, text) = server.trik(&good);
    assert_eq!((code, text.split(' ').nth(1)), (0, Some("taken")), "{text}");
    let (_, text) = server.trik(&good);
    assert_eq!(text.split(' ').nth(1), Some("waits"), "{text}");
    assert_eq!(server.state(), Some([1, 0, 0, 0]));
    let mut worker = server.worker(&["--name", "here"]);
    let all = [
        "grade-submit",
        "made/solution.js",
        "made/wrong.js",
        "--task",
        "road",
        "--wait",
    ];
    let (code, text) = server.trik(&all);
    assert_eq!(code, 1, "{text}");
    let results = results(&text);
    assert_eq!(results.len(), 2);
    for result in &results {
        let file = result["file"].as_str().unwrap();
        let [run] = &result["runs"].as_array().unwrap()[..] else {
            panic!("{result}");
        };
        let alone = format!("made/{file}");
        let words = [
            "check",
            &alone,
            "--field",
            "tasks/road.xml",
            "--results",
            "-",
        ];
        let alone: Value = serde_json::from_str(&server.trik(&words).1).expect("a row");
        for name in ["verdict", "ms", "points", "messages", "printed"] {
            assert_eq!(run[name], alone[name], "{file}: {name}");
        }
        assert_eq!(
            (&result["worker"], &result["dead"]),
            (&"here".into(), &Value::Null)
        );
        assert_eq!(
            (&run["solution"], &run["field"]),
            (&file.into(), &"road.xml".into())
        );
    }
    assert_eq!(server.state(), Some([0, 0, 2, 0]));
    let (_, text) = server.trik(&good);
    assert_eq!(text.split(' ').nth(1), Some("judged"), "{text}");
    kill(Pid::from_raw(worker.pid() as i32), Signal::SIGINT).unwrap();
    assert_eq!(worker.code(), Some(0));
    assert!(worker.said().ends_with("2 judged\n"), "{}", worker.said());
}

#[test]
fn workers_and_servers_that_are_killed_lose_nothing_and_double_nothing() {
    const COUNT: usize = 120;
    let Some(mut server) = Server::new() else {
        return;
    };
    let files: Vec<String> = (0..COUNT)
        .map(|number| server.program(&format!("{number}.js"), "made/solution.js", number))
        .collect();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let words = [&["grade-submit", "--task", "road"][..], &files].concat();
    let (code, text) = server.trik(&words);
    assert_eq!((code, text.matches(" taken ").count()), (0, COUNT));
    let mut workers = [
        server.worker(&["--jobs", "2"]),
        server.worker(&["--jobs", "2"]),
    ];
    let judged = |server: &Server, count| server.state().is_some_and(|state| state[2] >= count);
    eventually("some are judged", || judged(&server, 10));
    for (round, count) in [30, 50].into_iter().enumerate() {
        kill(Pid::from_raw(workers[round].pid() as i32), Signal::SIGKILL).unwrap();
        workers[round] = server.worker(&["--jobs", "2"]);
        eventually("more are judged", || judged(&server, count));
    }
    server.process.kill().unwrap();
    server.process.wait().unwrap();
    server.process = started(&server.program, &server.ip, &server.place);
    // What a killed worker had comes again after its time.
    let (code, text) = server.trik(&[&words[..], &["--wait"]].concat());
    assert_eq!(code, 0);
    let results = results(&text);
    let ids: BTreeSet<&str> = results
        .iter()
        .map(|one| one["id"].as_str().unwrap())
        .collect();
    assert_eq!((results.len(), ids.len()), (COUNT, COUNT));
    eventually("nothing is left", || {
        server.state() == Some([0, 0, COUNT as u64, 0])
    });
}

#[test]
fn what_nobody_can_judge_is_put_aside_after_three_times_and_told() {
    let Some(server) = Server::new() else { return };
    let worker = server.worker(&["--jobs", "1", "--wall-limit", "0.5"]);
    server.place.file("endless.py", "while True:\n    pass\n");
    let (code, text) = server.trik(&["grade-submit", "endless.py", "--task", "road", "--wait"]);
    assert_eq!(code, 2, "{text}");
    let [result] = &results(&text)[..] else {
        panic!("{text}")
    };
    assert!(
        result["dead"].as_str().unwrap().contains("0.5 s"),
        "{result}"
    );
    assert_eq!(result["runs"][0]["verdict"], "broken");
    assert_eq!(worker.said().matches("tried again, because").count(), 2);
    let (code, text) = server.trik(&[
        "grade-submit",
        "made/solution.js",
        "--task",
        "sea",
        "--wait",
    ]);
    assert_eq!(code, 2, "{text}");
    assert!(text.contains("this worker has no task 'sea'"), "{text}");
    // Where a worker has it is not told.
    server.place.file("none.qrs", "");
    let (code, text) = server.trik(&["grade-submit", "none.qrs", "--task", "road", "--wait"]);
    assert_eq!(
        (code, text.contains("\"message\":\"none.qrs: ")),
        (2, true),
        "{text}"
    );
    // What is no solution is not taken.
    let (code, _) = server.trik(&["grade-submit", "made/README.md", "--task", "road"]);
    assert_eq!((code, server.state()), (2, Some([0, 0, 1, 2])));
    // What was put aside is judged anew when it is handed in once more, by a worker that has the task.
    let tasks = server.place.path("tasks");
    fs::copy(tasks.join("road.xml"), tasks.join("sea.xml")).unwrap();
    drop(worker);
    let _worker = Running::new(&mut server.command(&["grade-worker", "--tasks", "tasks"]));
    let again = [
        "grade-submit",
        "made/solution.js",
        "--task",
        "sea",
        "--wait",
    ];
    let (code, text) = server.trik(&again);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("\"path\":\"made/solution.js\""), "{text}");
    assert_eq!(server.state(), Some([0, 0, 2, 1]));
    // And it goes on.
    let (code, _) = server.trik(&[
        "grade-submit",
        "made/solution.js",
        "--task",
        "road",
        "--wait",
    ]);
    assert_eq!(code, 0);
}

/// The exit status of the script of a grading service, and what it says.
fn grade(place: &Board, server: &str, words: &[&str]) -> (Option<i32>, String) {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../grading/deploy/grade.sh");
    let mut command = Command::new(script);
    command.current_dir(place.path(".")).args(words);
    command.env("TRIK", TRIK).env("TRIK_SERVER", server);
    let output = command.output().expect("bash");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), text)
}

#[test]
fn the_script_of_a_grading_service_gets_the_reports_of_trik_check() {
    let Some(server) = Server::new() else { return };
    let of = |name: &str| server.place.path(name);
    fs::create_dir_all(of("tasks/maze")).unwrap();
    fs::create_dir_all(of("maze/fields")).unwrap();
    for field in ["near.xml", "far.xml"] {
        for folder in ["tasks/maze", "maze/fields"] {
            fs::copy(of("made/world.xml"), of(folder).join(field)).unwrap();
        }
    }
    // Programs read what is beside a field.
    fs::write(of("tasks/maze/far.txt"), "seven\n").unwrap();
    server.place.file("asks.py", "print('read', input())\n");
    let worker = Running::new(&mut server.command(&["grade-worker", "--tasks", "tasks"]));
    worker.says("at once: maze, road");
    assert!(!worker.said().contains("far.txt"), "{}", worker.said());
    for (mode, file) in [
        ("js", "made/solution.js"),
        ("js", "made/wrong.js"),
        ("py", "asks.py"),
    ] {
        let _ = fs::remove_dir_all(of("results"));
        let _ = fs::remove_dir_all(of("alone"));
        fs::create_dir(of("results")).unwrap();
        let words = ["--mode", mode, "--submission-file", file, "--image", "any"];
        let more = [
            "--fields-directory",
            "maze/fields/",
            "--result-directory",
            "results",
        ];
        let (code, text) = grade(&server.place, &server.ip, &[&words[..], &more].concat());
        assert_eq!(code, Some(0), "{text}");
        for field in ["near", "far"] {
            let world = format!("tasks/maze/{field}.xml");
            let alone = format!("alone-{field}.json");
            let mut words = vec![
                "check", file, "--field", &world, "--report", &alone, "--force",
            ];
            if field == "far" {
                words.extend(["--inputs", "tasks/maze/far.txt"]);
            }
            server.trik(&words);
            let expected = fs::read_to_string(of(&alone)).unwrap();
            let report = fs::read_to_string(of(&format!("results/{field}.json"))).unwrap();
            assert_eq!(report, expected, "{file}: {field}");
            assert!(report.starts_with("[\n{\"level\""), "{report}");
        }
    }
    let words = ["grade-submit", "asks.py", "--task", "maze", "--wait"];
    let text = server.trik(&words).1;
    assert!(text.contains("\"printed\":[\"read seven\""), "{text}");
}

#[test]
fn the_script_of_a_grading_service_says_what_is_wrong() {
    let place = Board::new();
    for (words, why) in [
        (&["--mode", "exe"][..], "--mode is qrs, js or py, not 'exe'"),
        (&["--mode"], "--mode needs a value"),
        (&["--colour"], "unknown option --colour"),
        (
            &["--mode", "js", "--submission-file", "none.js"],
            "there is no file 'none.js'",
        ),
    ] {
        let (code, text) = grade(&place, "127.0.0.1", words);
        assert_eq!((code, text.contains(why)), (Some(1), true), "{text}");
    }
}

/// Publishes by the bytes of the protocol what no client would.
struct Hostile(BufReader<TcpStream>);

impl Hostile {
    fn new(server: &Server) -> Self {
        let mut stream = TcpStream::connect((&*server.ip, PORT)).unwrap();
        stream
            .write_all(b"CONNECT {\"verbose\":false,\"headers\":true,\"lang\":\"c\",\"version\":\"1\"}\r\n")
            .unwrap();
        Self(BufReader::new(stream))
    }

    /// A message, which the server has when this is over.
    fn publish(&mut self, subject: &[u8], header: &[u8], payload: &[u8]) {
        let sizes = match header.is_empty() {
            true => format!(" {}\r\n", payload.len()),
            false => format!(" {} {}\r\n", header.len(), header.len() + payload.len()),
        };
        let word: &[u8] = if header.is_empty() { b"PUB " } else { b"HPUB " };
        let parts = [
            word,
            subject,
            sizes.as_bytes(),
            header,
            payload,
            b"\r\nPING\r\n",
        ];
        self.0.get_mut().write_all(&parts.concat()).unwrap();
        loop {
            let mut line = String::new();
            self.0.read_line(&mut line).unwrap();
            assert!(!line.starts_with("-ERR"), "{line}");
            if line.starts_with("PONG") {
                return;
            }
        }
    }
}

const NAMED: &str = "Trik-Task: road\r\nTrik-File: a.js\r\n\r\n";

/// Headers that harm clients, or servers when they are copied.
fn hostile_headers() -> Vec<Vec<u8>> {
    let mut all: Vec<Vec<u8>> = [
        "NATS/1.0 404\r\n",
        "NATS/1.0 408 Request Timeout\r\n",
        "NATS/1.0 409 Message Size Exceeds MaxBytes\r\n",
        "NATS/1.0 100 Idle Heartbeat\r\n",
        "NATS/1.0 503\r\n",
        "NATS/1.0 4x4\r\n",
        "NATS/1.0\n",
        "NATS/1.0\r\nno colon\r\n",
        "NATS/1.0\r\nA: b\nno colon\r\n",
        "HTTP/1.1\r\n",
        "\r\n",
        "NATS/1.0\r\nNats-Expected-Stream: TRIK_GRADE\r\n",
    ]
    .into_iter()
    .map(|begin| format!("{begin}{NAMED}").into_bytes())
    .collect();
    all.push(b"NATS/1.0\r\nTrik-Task: \xff\xfe\r\n\r\n".to_vec());
    all.push(b"no header".to_vec());
    all.push(Vec::new());
    all
}

#[test]
fn what_harms_clients_is_put_aside_and_holds_nobody_up() {
    let Some(server) = Server::new() else { return };
    // The first command makes the streams.
    assert_eq!(server.state(), Some([0, 0, 0, 0]));
    let mut hostile = Hostile::new(&server);
    let headers = hostile_headers();
    for (number, header) in headers.iter().enumerate() {
        let subject = format!("trik.grade.submit.{number}");
        hostile.publish(subject.as_bytes(), header, b"print(1)");
    }
    hostile.publish(b"trik.grade.submit.\xff\xfe", b"", b"x");
    let count = headers.len() as u64 + 1;
    assert_eq!(server.state(), Some([count, 0, 0, 0]));
    let mut files = Vec::new();
    for number in 0..6 {
        files.push(server.program(&format!("{number}.js"), "made/solution.js", number));
    }
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let words = [&["grade-submit", "--task", "road", "--wait"][..], &files].concat();
    let worker = server.worker(&["--jobs", "2"]);
    let (code, text) = server.trik(&words);
    assert_eq!((code, results(&text).len()), (0, 6), "{text}");
    eventually("all are done", || server.state() == Some([0, 0, 6, count]));
    // While it works, in between.
    for (number, header) in headers.iter().enumerate() {
        let subject = format!("trik.grade.submit.again{number}");
        hostile.publish(subject.as_bytes(), header, b"print(1)");
    }
    let more = server.program("more.js", "made/solution.js", 99);
    let words = ["grade-submit", "--task", "road", "--wait", &more];
    let (code, text) = server.trik(&words);
    assert_eq!(code, 0, "{text}");
    let count = count + headers.len() as u64;
    eventually("all are done again", || {
        server.state() == Some([0, 0, 7, count])
    });
    // None was tried again: each was known for what it is.
    assert!(
        !worker.said().contains("tried again, because"),
        "{}",
        worker.said()
    );
    let (_, text) = server.trik(&["grade-status"]);
    assert!(text.contains("a header that no client can read"), "{text}");
    assert!(text.contains("does not end with the id"), "{text}");
    assert!(text.contains("no header Trik-Task"), "{text}");
    assert!(text.contains("and 11 more"), "{text}");
}

#[test]
fn what_somebody_puts_in_the_place_of_a_submission_or_of_its_result_takes_nothing_from_it() {
    let Some(server) = Server::new() else { return };
    fs::copy(
        server.place.path("made/solution.js"),
        server.place.path("b.js"),
    )
    .unwrap();
    let words = ["grade-submit", "b.js", "--task", "road"];
    let (_, text) = server.trik(&words);
    let other = text.split(' ').next().unwrap().to_owned();
    // Somebody else knows it before.
    let mut hostile = Hostile::new(&server);
    hostile.publish(b"$JS.API.STREAM.PURGE.TRIK_GRADE answer", b"", b"");
    assert_eq!(server.state(), Some([0, 0, 0, 0]));
    let subject = format!("trik.grade.submit.{other}");
    let header = format!("NATS/1.0\r\n{NAMED}");
    hostile.publish(subject.as_bytes(), header.as_bytes(), b"print(1)");
    hostile.publish(
        format!("trik.grade.result.{other}").as_bytes(),
        b"",
        b"\x1b[2J no result",
    );
    let (code, text) = server.trik(&words);
    assert_eq!((code, &*text), (2, &*format!("{other} blocked b.js\n")));
    let _worker = server.worker(&[]);
    eventually("it is put aside", || {
        server.state().is_some_and(|state| state[3] == 1)
    });
    let (code, text) = server.trik(&[&words[..], &["--wait"]].concat());
    assert_eq!(code, 0, "{text}");
    let [result] = &results(&text)[..] else {
        panic!("{text}")
    };
    assert_eq!(
        (&result["id"], &result["file"]),
        (&other.into(), &"b.js".into())
    );
}

#[test]
fn the_page_of_the_queue_follows_it_and_a_server_that_is_not_there_is_told() {
    let Some(mut server) = Server::new() else {
        return;
    };
    let page = Running::new(&mut server.command(&["grade-status", "--page", "--port", "0"]));
    page.says("in a browser: ");
    let said = page.said();
    let at = said
        .split("http://")
        .nth(1)
        .and_then(|rest| rest.split('/').next())
        .unwrap();
    let shown = || {
        let mut stream = TcpStream::connect(at).expect("a page");
        stream
            .write_all(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
            .unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        text
    };
    server.trik(&["grade-submit", "made/solution.js", "--task", "road"]);
    eventually("one waits", || shown().contains("waiting</th><td>1</td>"));
    server.process.kill().unwrap();
    server.process.wait().unwrap();
    eventually("the server is gone", || shown().contains("does not answer"));
    let output = server.command(&["grade-status"]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("no NATS server is reached at"), "{text}");
}
