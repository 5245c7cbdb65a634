//! `trik debug` in a terminal: lines that are edited, completed and had again.

use super::{asking, flow};
use crate::rig::TRIK;
use harness::{Board, eventually};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::pty::openpty;
use nix::sys::signal::{Signal, kill};
use nix::sys::termios::{LocalFlags, tcgetattr};
use nix::unistd::Pid;
use std::fs::File;
use std::io::{Read as _, Write as _};
use std::os::fd::AsFd as _;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A person at a terminal in which `trik debug` runs.
struct Person {
    terminal: File,
    debugger: Child,
    seen: String,
}

impl Person {
    fn new(board: &Board, file: &str, kind: &str) -> Self {
        let pair = openpty(None, None).expect("a terminal");
        let also = pair.slave.try_clone().expect("its other end");
        let debugger = Command::new(TRIK)
            .args(["debug", file])
            .current_dir(board.dir())
            .env("TERM", kind)
            .stdin(Stdio::from(pair.slave))
            .stdout(Stdio::from(also))
            .spawn()
            .expect("the debugger");
        let mut person = Self {
            terminal: pair.master.into(),
            debugger,
            seen: String::new(),
        };
        person.sees("(trik) ");
        person
    }

    fn types(&mut self, keys: &str) {
        let typed = self.terminal.write_all(keys.as_bytes());
        typed.expect("a terminal");
    }

    /// Waits for a text, and forgets what came up to its end.
    fn sees(&mut self, text: &str) {
        let deadline = Instant::now() + Duration::from_secs(60);
        loop {
            if let Some(at) = self.seen.find(text) {
                self.seen.drain(..at + text.len());
                return;
            }
            assert!(Instant::now() < deadline, "no {text:?}: {:?}", self.seen);
            let mut output = [PollFd::new(self.terminal.as_fd(), PollFlags::POLLIN)];
            if poll(&mut output, PollTimeout::from(100u8)).expect("a look") == 0 {
                continue;
            }
            let mut bytes = [0; 4096];
            // It is an error once nobody has the other end.
            let count = self.terminal.read(&mut bytes).unwrap_or_default();
            assert!(count > 0, "no {text:?}: {:?}", self.seen);
            self.seen += &String::from_utf8_lossy(&bytes[..count]);
        }
    }

    /// Waits for the end: the exit code, and whether the terminal is as it was.
    fn end(&mut self) -> (Option<i32>, bool) {
        let mut code = None;
        eventually("the end of the debugger", || {
            code = self.debugger.try_wait().expect("a child");
            code.is_some()
        });
        let settings = tcgetattr(&self.terminal).expect("a terminal");
        let wanted = LocalFlags::ICANON | LocalFlags::ECHO;
        let is_as_it_was = settings.local_flags.contains(wanted);
        (code.and_then(|code| code.code()), is_as_it_was)
    }
}

impl Drop for Person {
    fn drop(&mut self) {
        let _ = self.debugger.kill();
        let _ = self.debugger.wait();
    }
}

#[test]
fn a_command_is_completed_edited_and_had_again() {
    let board = flow::board();
    let mut person = Person::new(&board, "count.flow", "xterm");
    person.types("bre\twh\t\r");
    person.sees("breakpoint 1 at line 7");
    person.sees("(trik) ");
    person.types("\x1b[A\r");
    person.sees("breakpoint 2 at line 7");
    person.sees("(trik) ");
    // To the beginning of the line, and to its end.
    person.types("1 + 2\x01p \x05 * 3\r");
    person.sees("\n7\r\n");
    // A line without an end ends somewhere, and is no command.
    person.types(&"x".repeat(3000));
    person.types("\r");
    person.sees("this line is too long and is left out");
    person.sees("(trik) ");
    // What is typed ahead is not lost.
    person.types("p 20 + 1\rp 20 + 2\rp 20 + 3\r");
    for told in ["\n21\r\n", "\n22\r\n", "\n23\r\n"] {
        person.sees(told);
    }
    person.sees("(trik) ");
    person.types("rubbish\x03");
    person.sees("type quit to end");
    person.sees("(trik) ");
    person.types("\x04");
    assert_eq!(person.end(), (Some(0), true));
}

#[test]
fn an_answer_to_a_question_is_a_line_and_the_next_one_a_command() {
    let board = Board::new();
    board.file("ask.qrs", asking("1"));
    let mut person = Person::new(&board, "ask.qrs", "xterm");
    person.types("break 3\rc\r");
    person.sees("How many? [1] ");
    person.types("5\r");
    person.sees("breakpoint 1\r\n");
    person.types("p n * 100\r");
    person.sees("\n500\r\n");
    person.types("q\r");
    assert_eq!(person.end(), (Some(0), true));
}

#[test]
fn a_terminal_is_left_as_it_was_by_who_is_told_to_end() {
    let board = flow::board();
    let mut person = Person::new(&board, "count.flow", "xterm");
    person.types("bre");
    person.sees("bre");
    let process = Pid::from_raw(i32::try_from(person.debugger.id()).expect("a process"));
    kill(process, Signal::SIGTERM).expect("a signal");
    assert_eq!(person.end(), (Some(0), true));
    // One that can move no cursor has lines as they come.
    let mut person = Person::new(&board, "count.flow", "dumb");
    person.types("p 20 + 1\rq\r");
    person.sees("\n21\r\n");
    assert_eq!(person.end(), (Some(0), true));
}
