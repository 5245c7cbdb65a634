//! What is no virtual robot: nothing at all, something strange, and robots in a state that a virtual one does not reach.

use crate::rig::{Home, loopback};
use frame::{Decoder, encode};
use harness::tools;
use std::io::{Read, Write};
use std::net::TcpListener;
use std::sync::{Mutex, PoisonError};

/// Something that listens where a robot does, and answers each frame with these bytes.
fn pretend(ip: &str, answer: impl Fn(&str) -> String + Send + 'static) {
    let listener = TcpListener::bind((ip, 8888)).expect("a port");
    std::thread::spawn(move || {
        for mut stream in listener.incoming().map_while(Result::ok) {
            let mut decoder = Decoder::new(1 << 20);
            let mut piece = [0; 4096];
            while let Ok(size) = stream.read(&mut piece)
                && size > 0
            {
                decoder.feed(&piece[..size]);
                while let Ok(Some(frame)) = decoder.next() {
                    let text = answer(&String::from_utf8_lossy(frame));
                    let _ = stream.write_all(text.as_bytes());
                }
            }
        }
    });
}

fn frames(payloads: &[&str]) -> String {
    let frame = |payload: &&str| String::from_utf8(encode(payload.as_bytes())).expect("UTF-8");
    payloads.iter().map(frame).collect()
}

#[test]
fn the_end_of_a_program_is_known_also_if_its_news_were_lost() {
    let Some(home) = Home::new() else { return };
    home.0.file("x.js", "");
    let note =
        "info: 9 messages were left out: this computer reads more slowly than the robot writes";
    for (last, code, reason) in [
        (
            "status: program none\nlast x.js has ended after 1.0 s",
            0,
            "",
        ),
        (
            "status: program none\nlast x.js has failed with exit code 2 after 1.0 s",
            1,
            "trik: x.js has failed with exit code 2",
        ),
        (
            "status: program none\nlast y.js has ended after 1.0 s",
            1,
            "trik: x.js does not run any more",
        ),
        (
            "status: program y.js (Python, process 1) for 1 s",
            1,
            "trik: x.js does not run any more",
        ),
    ] {
        let ip = loopback();
        let asked = Mutex::new(0);
        pretend(&ip, move |frame| match frame {
            "version" => frames(&["version: 3.1.4"]),
            "run:x.js" => frames(&["info: x.js has started", "error: \x1b[2Jbeware", note]),
            "status" => {
                let mut asked = asked.lock().unwrap_or_else(PoisonError::into_inner);
                *asked += 1;
                let runs = "status: program x.js (JavaScript, process 1) for 0 s";
                frames(&[if *asked == 1 { runs } else { last }])
            }
            _ => String::new(),
        });
        let output = home.run(&["run", "x.js", "--robot", &ip]);
        assert_eq!(output.code(), code, "{last}: {}", output.stderr);
        assert!(output.stderr.contains(reason), "{last}: {}", output.stderr);
        assert!(
            output
                .stderr
                .starts_with("[2Jbeware\n9 messages were left out"),
            "{:?}",
            output.stderr
        );
    }
}

#[test]
fn a_robot_that_cannot_or_will_not_is_a_sentence_with_what_to_do() {
    let Some(home) = Home::new() else { return };
    home.0.file("x.js", "");
    let wary = loopback();
    let unpaired = "error: this computer is not paired with the robot: press Enter on the robot within 30 s, then try again";
    pretend(&wary, move |_| frames(&[unpaired]));
    let strange = loopback();
    pretend(&strange, |_| "999999999:".to_owned());
    for (words, reason) in [
        (vec!["run", "none.js"], "none.js: there is no such file"),
        (
            vec!["run", "x.js", "--robot", &wary],
            "press Enter on the robot within 30 s",
        ),
        (
            vec!["run", "x.js", "--robot", &strange],
            "is lost: it does not speak as robots do",
        ),
        (
            vec!["run", "x.js", "--robot", "127.0.0.1:1"],
            "nothing takes programs at 127.0.0.1, port 1: start a virtual robot with trik up",
        ),
        (
            vec!["run", "x.js", "--robot", "robot.invalid"],
            "there is no robot 'robot.invalid' in this network",
        ),
        (
            vec!["stop", "--robot", "127.0.0.1:1"],
            "nothing takes programs",
        ),
        (
            vec!["run", "x.js", "--robot", "a b"],
            "the name or the IP of a robot",
        ),
        (vec!["run"], "<FILE>"),
    ] {
        let output = tools::run(&mut home.command(&words), b"");
        assert_eq!(output.code(), 2, "{words:?}: {}", output.stderr);
        assert!(
            output.stderr.contains(reason),
            "{words:?}: {}",
            output.stderr
        );
        assert_eq!(output.stdout, "");
    }
    assert!(!home.base().exists());
}
