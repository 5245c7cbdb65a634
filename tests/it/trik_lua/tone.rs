//! The program behind `sound/tone`: the samples that aplay gets, and what it refuses.

use harness::{Board, tools};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

const TONE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../cross/install/controller/usr/lib/trikfs/tone"
);
const RATE: usize = 16_000;

/// Runs it with an aplay that keeps its arguments and its input.
fn tone(words: &[&str]) -> (i32, String, Vec<u8>) {
    let board = Board::new();
    let script = board.fill_in("#!/bin/sh\necho \"$@\" >$DIR/arguments\ncat >$DIR/samples\n");
    let aplay = board.file("aplay", script);
    std::fs::set_permissions(aplay, std::fs::Permissions::from_mode(0o755)).unwrap();
    let path = std::env::var("PATH").unwrap();
    let mut command = std::process::Command::new(Path::new(TONE));
    command
        .args(words)
        .env("PATH", format!("{}:{path}", board.dir().display()));
    let output = tools::run(&mut command, b"");
    if output.code() != 0 {
        assert!(!board.path("samples").exists(), "{words:?}");
        return (output.code(), output.stderr, Vec::new());
    }
    let arguments = String::from_utf8(board.content("arguments")).unwrap();
    (0, arguments, board.content("samples"))
}

#[test]
fn a_tone_is_a_sine_of_its_frequency_and_length() {
    for (frequency, ms) in [
        (440, 500),
        (1000, 1),
        (20, 10_000),
        (523, 100),
        (6999, 1234),
        (7000, 77),
    ] {
        let (code, arguments, samples) = tone(&[&format!("{frequency} {ms}")]);
        assert_eq!(code, 0);
        assert_eq!(arguments, "-q -t raw -f U8 -r 16000 -c 1\n");
        assert_eq!(samples.len(), RATE * ms / 1000, "{frequency} {ms}");
        // Whole waves in about 800 samples, over and over.
        let waves = frequency / 20;
        let size = (waves * RATE + frequency / 2) / frequency;
        let real_hz = (waves * RATE) as f64 / size as f64;
        assert!(
            (real_hz / frequency as f64 - 1.0).abs() < 0.001,
            "{real_hz}"
        );
        for (at, &sample) in samples.iter().enumerate() {
            let turn = (at * waves % size) as f64 / size as f64;
            let expected = 128.0 + 100.0 * (turn * std::f64::consts::TAU).sin();
            assert!(
                (f64::from(sample) - expected).abs() <= 1.0,
                "{frequency} Hz, sample {at}: {sample} for {expected}"
            );
        }
    }
}

#[test]
fn what_is_no_tone_is_refused_and_runs_nothing() {
    for words in [
        &[][..],
        &[""],
        &["440"],
        &["440 500 1"],
        &["-440 500"],
        &["440 -1"],
        &["19 500"],
        &["7001 500"],
        &["440 0"],
        &["440 10001"],
        &["440 99999999999999999999"],
        &["$(id) 500"],
        &["440.5 500"],
        &["* *"],
    ] {
        let (code, said, _) = tone(words);
        assert_eq!(code, 2, "{words:?}");
        assert!(said.starts_with("usage: tone "), "{words:?}: {said}");
    }
}
