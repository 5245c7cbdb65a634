//! What a program of 200 blocks costs in the machine, against the same program as a converter in C, in one run.
//!
//! `cargo bench -p lang-dataflow --bench converter`; needs gcc. The best of many short runs counts, and both count instants:
//! a poll of twenty sensors through all blocks.
//! `... --bench converter -- --count INSTANTS` only runs so many instants in the machine, for a tool that counts
//! instructions: the difference of two counts is free of everything else, and does not depend on what else the computer
//! does. That needs no gcc.

use lang_dataflow::check::check;
use lang_dataflow::generate::{Target, generate};
use lang_dataflow::machine::trace::Deaf;
use lang_dataflow::machine::{Machine, POLL_MS};
use lang_dataflow::program::Program;
use lang_dataflow::text;
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::Status;
use lang_diagram::ports::Port;
use std::fmt::Write;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command as Run;
use std::rc::Rc;
use std::time::Instant;

const POLLS: u32 = 200;
const WARM: u32 = 3;
const RUNS: u32 = 10;
const TURNS: u32 = 40;
const ROWS: usize = 20;
const IN_ROW: usize = 9;

struct Robot(i32);

impl Brick for Robot {
    fn command(&mut self, command: Command<'_>) {
        black_box(&command);
    }

    fn scalar(&mut self, _port: Port) -> Option<i32> {
        self.0 = (self.0 + 1) % 100;
        Some(self.0)
    }

    fn vector(&mut self, _port: Port, _into: &mut Vec<i32>) -> bool {
        false
    }

    fn random(&mut self, low: i32, _high: i32) -> i32 {
        low
    }
}

/// Rows of a sensor, a gate, a window, a choice and functions: 200 blocks.
fn program() -> String {
    let mut text = "diagram \"rows\"\n  M: Motors\n".to_owned();
    for row in 0..ROWS {
        let _ = writeln!(text, "  A{row}: Sensor(VarName = sensorA{})", 1 + row % 6);
        let _ = writeln!(text, "  W{row}: \"Flow replacer\"(time = 30)");
        let _ = writeln!(text, "  C{row}: If(condition = `data > 2`)");
        for at in 0..IN_ROW - 2 {
            let _ = writeln!(
                text,
                "  F{row}x{at}: \"Text programming\"(IO0 = `u = 0.5 * (I0 - {at}); max(0-50, min(50, u + 3))`)"
            );
        }
    }
    for row in 0..ROWS {
        let _ = writeln!(
            text,
            "  A{row}.OUT -> W{row}.DATA\n  W{row}.OUT -> C{row}.DATA"
        );
        let _ = writeln!(
            text,
            "  C{row}.TRUE -> F{row}x0.I0\n  C{row}.FALSE -> F{row}x0.I0"
        );
        for at in 1..IN_ROW - 2 {
            let _ = writeln!(text, "  F{row}x{}.O0 -> F{row}x{at}.I0", at - 1);
        }
        let _ = writeln!(text, "  F{row}x{}.O0 -> M.M{}", IN_ROW - 3, 1 + row % 4);
    }
    text
}

/// Seconds of so many instants in the machine, after a few that tell the types of the texts.
fn instants(program: &Rc<Program>, polls: u32) -> f64 {
    let mut machine = Machine::new(program.clone());
    let mut robot = Robot(0);
    for poll in 0..WARM {
        machine.step(POLL_MS * poll, &mut robot, &mut Deaf);
    }
    let begin = Instant::now();
    for poll in WARM..WARM + polls {
        let status = machine.step(POLL_MS * poll, &mut robot, &mut Deaf);
        assert_eq!(status, Status::Running);
    }
    begin.elapsed().as_secs_f64()
}

/// Nanoseconds of an instant in the machine.
fn machine(program: &Rc<Program>) -> f64 {
    let runs = (0..RUNS).map(|_| instants(program, POLLS));
    let best = runs.fold(f64::INFINITY, f64::min);
    best * 1e9 / f64::from(POLLS)
}

/// The same program as a converter, compiled into this folder.
fn converter(program: &Program, folder: &Path) -> PathBuf {
    let code = generate(program, Target::C).expect("a converter");
    let main = format!(
        "\n#include <time.h>\nint main(void)\n{{\n    double best = 1e18;\n    int run;\n    for (run = 0; run < {RUNS}; run++) {{\n        struct state *s = calloc(1, sizeof *s);\n        struct timespec from, to;\n        uint8_t in[INPUT_SIZE], out[OUTPUT_SIZE];\n        int32_t number = 0, poll;\n        uint32_t us = 0;\n        restart(s);\n        for (poll = 0; poll < {WARM} + {POLLS}; poll++) {{\n            if (poll == {WARM})\n                clock_gettime(CLOCK_MONOTONIC, &from);\n            size_t at;\n            for (at = 0; at + 4 < INPUT_SIZE; at += 4) {{\n                number = (number + 1) % 100;\n                memcpy(in + at, &number, 4);\n            }}\n            memcpy(in + at, &us, 4);\n            us = 20000;\n            if (convert(s, in, INPUT_SIZE, out, OUTPUT_SIZE) > 1) {{\n                puts(s->text);\n                return 1;\n            }}\n        }}\n        clock_gettime(CLOCK_MONOTONIC, &to);\n        closed(s);\n        {{\n            double took = (to.tv_sec - from.tv_sec) * 1e9 + (to.tv_nsec - from.tv_nsec);\n            best = took < best ? took : best;\n        }}\n    }}\n    printf(\"%f\\n\", best / {POLLS});\n    return 0;\n}}\n"
    );
    std::fs::write(folder.join("program.c"), code + &main).expect("a program");
    let header = concat!(env!("CARGO_MANIFEST_DIR"), "/../../converter/include");
    let compiled = Run::new("gcc")
        .args([
            "-std=gnu99",
            "-O2",
            "-I",
            header,
            "-o",
            "program",
            "program.c",
            "-lm",
        ])
        .current_dir(folder)
        .status();
    assert!(compiled.is_ok_and(|status| status.success()), "gcc");
    folder.join("program")
}

/// Nanoseconds of an instant in the converter.
fn compiled(program: &Path) -> f64 {
    let output = Run::new(program).output().expect("the program");
    let text = String::from_utf8_lossy(&output.stdout);
    text.trim().parse().expect(&text)
}

fn main() {
    let project = text::read(&program()).expect("a program");
    let checked = check(&project);
    assert!(!checked.has_errors(), "{:?}", checked.problems);
    let program = Rc::new(checked.program);
    let words: Vec<String> = std::env::args().collect();
    if let Some(flag) = words.iter().position(|word| word == "--count") {
        let count = words.get(flag + 1).and_then(|word| word.parse().ok());
        instants(&program, count.expect("--count INSTANTS"));
        return;
    }
    let blocks = program.nodes.len();
    let scratch = tempfile::tempdir().expect("a folder");
    let converter = converter(&program, scratch.path());
    // In turns, so that both have the same chance of a quiet moment.
    let (mut machine_ns, mut converter_ns) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..TURNS {
        machine_ns = machine_ns.min(machine(&program));
        converter_ns = converter_ns.min(compiled(&converter));
    }
    println!(
        "{blocks} blocks in the machine   {:8.1} us an instant",
        machine_ns / 1e3
    );
    println!(
        "the same as C             {:8.1} us an instant",
        converter_ns / 1e3
    );
    println!(
        "ratio                     {:8.2} (goal <= 3)",
        machine_ns / converter_ns
    );
}
