//! Fuzz targets as plain functions: any bytes may come in, nothing but time and memory within limits may go.
//!
//! Run by the integration tests of the project with a printed seed, and by anybody's fuzzer.

use crate::protocol::program::mailbox::Question;
use crate::protocol::program::{FromProgram, ToProgram};
use crate::protocol::{control, dns, gamepad, http, mail, telemetry};
use crate::{limits, program::output, scripts};
use frame::{Decoder, encode};
use std::path::Path;

/// All frames of a stream in pieces of `step` bytes, and whether it can be followed.
fn frames(bytes: &[u8], step: usize) -> (Vec<Vec<u8>>, bool) {
    let mut decoder = Decoder::new(limits::SMALL_FRAME_BYTES);
    let mut found = Vec::new();
    for piece in bytes.chunks(step) {
        decoder.feed(piece);
        loop {
            match decoder.next() {
                Ok(Some(frame)) => found.push(frame.to_vec()),
                Ok(None) => break,
                Err(_) => return (found, false),
            }
        }
        assert!(decoder.buffered() <= limits::SMALL_FRAME_BYTES + frame::limits::HEADER_BYTES);
    }
    (found, true)
}

/// A stream of frames must give the same however it is torn, and each frame must survive being sent again.
pub fn fuzz_frames(bytes: &[u8]) {
    let whole = frames(bytes, bytes.len().max(1));
    for step in [1, 3] {
        assert_eq!(frames(bytes, step), whole);
    }
    for frame in whole.0.iter().filter(|frame| !frame.is_empty()) {
        assert_eq!(frames(&encode(frame), 2), (vec![frame.clone()], true));
    }
}

/// What stands in frames and lines.
pub fn fuzz_messages(bytes: &[u8]) {
    if let control::Request::File { name, .. } | control::Request::Run(name) =
        control::Request::parse(bytes)
        && let Ok(path) = scripts::locate(Path::new("/scripts"), name)
    {
        let inside = path.strip_prefix("/scripts").is_ok_and(|rest| {
            rest.components()
                .all(|part| matches!(part, std::path::Component::Normal(_)))
        });
        assert!(inside, "{}", path.display());
    }
    if let telemetry::Request::Sensor(name) = telemetry::Request::parse(bytes) {
        assert!(
            telemetry::Snapshot::default()
                .sensor(name)
                .starts_with("sensor:")
        );
    }
    let message = mail::Message::parse(bytes);
    if message != mail::Message::Unknown {
        assert_eq!(
            mail::Message::parse(message.to_string().as_bytes()),
            message
        );
    }
    if let gamepad::Line::Command(text) = gamepad::Line::parse(bytes) {
        assert!(!text.contains('\n'));
    }
}

/// What a program and its daemon tell each other: a meaning is kept when it is sent again.
pub fn fuzz_channel(bytes: &[u8]) {
    let payload = String::from_utf8_lossy(bytes);
    if let Some(message) = ToProgram::parse(&payload) {
        let again = String::from_utf8_lossy(&message.encode()).into_owned();
        assert_eq!(ToProgram::parse(&again), Some(message));
    }
    if let Some(message) = FromProgram::parse(&payload) {
        let again = String::from_utf8_lossy(&message.encode()).into_owned();
        assert_eq!(FromProgram::parse(&again), Some(message));
    }
    // Without an address there are no fields to find it among.
    if let Some(question) = Question::parse(&payload)
        && !matches!(question, Question::Join { address: "", .. })
    {
        let words = question.to_string();
        assert_eq!(
            Question::parse(&words).map(|again| again.to_string()),
            Some(words)
        );
    }
}

/// Streams of lines, however they are torn.
pub fn fuzz_lines(bytes: &[u8]) {
    let lines = |step: usize| {
        let (mut pads, mut output) = (
            gamepad::Lines::new(limits::GAMEPAD_LINE_BYTES),
            output::Lines::default(),
        );
        let mut found = (Vec::new(), String::new());
        for piece in bytes.chunks(step) {
            pads.feed(piece, |line| found.0.push(line.to_vec()));
            output.feed(piece, |line| found.1.push_str(line));
        }
        output.finish(|line| found.1.push_str(line));
        found
    };
    let whole = lines(bytes.len().max(1));
    assert_eq!(lines(1), whole);
}

/// Messages of strangers over HTTP and DNS.
pub fn fuzz_strangers(bytes: &[u8]) {
    let _ = http::parse(bytes);
    if let Some((number, questions)) = dns::questions(bytes) {
        let robot = dns::Robot {
            name: "trik".to_owned(),
            ip: [192, 168, 77, 1].into(),
            port: 8888,
            about: Vec::new(),
        };
        // An answer is never taken for a question.
        if let Some(answer) = robot.answer(number, &questions) {
            assert_eq!(dns::questions(&answer), None);
        }
    }
}
